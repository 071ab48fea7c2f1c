//! The text of a plan: reading, including the named scene, and writing.

use super::axis::Axis;
use super::builtin;
use super::plan::{Plan, StiffnessRange};
use super::quantity::Quantity;
use crate::scene::{
    Document, LONGEST_TEXT, Scene, SceneErrors, describe_error, is_file_name, line_column, nearest, open,
    read_file, read_ron, ron_float, ron_string, to_ron,
};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// The only supported version of the plan file.
pub const PLAN_VERSION: u32 = 1;

/// All errors of a plan, one line each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanErrors(pub Vec<String>);

impl fmt::Display for PlanErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl std::error::Error for PlanErrors {}

/// Changes of a plan for one study, in addition to the text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Overrides of the scene: path and value.
    pub set: Vec<(String, String)>,
    /// Number of profiles.
    pub lines: Option<u64>,
}

/// A plan in the form of its file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Plan")]
struct PlanText {
    version: u32,
    #[serde(default)]
    title: String,
    #[serde(default)]
    notice: String,
    #[serde(default)]
    base: Option<String>,
    #[serde(default)]
    scene: Option<Scene>,
    #[serde(default)]
    set: BTreeMap<String, String>,
    #[serde(default)]
    axes: Vec<Axis>,
    #[serde(default)]
    preloads: Vec<f64>,
    #[serde(default)]
    lines: Option<u64>,
    #[serde(default)]
    seed: Option<u64>,
    record: Vec<Quantity>,
    #[serde(default)]
    stiffness: StiffnessRange,
    #[serde(default)]
    measured_sha256: Option<String>,
}

impl Plan {
    /// Opens and checks a plan: a file if one of that name exists or the name looks like a path, else a built-in
    /// plan. Scenes given by a path are relative to its file.
    ///
    /// # Errors
    /// All errors, up to those of the scene of every single cell.
    pub fn open(name_or_path: &str, changes: &Changes) -> Result<Plan, PlanErrors> {
        let path = Path::new(name_or_path);
        if is_file_name(name_or_path) {
            let text = read_file(path).map_err(|error| {
                PlanErrors(vec![format!("{name_or_path}: {}", error.replace("scene", "plan"))])
            })?;
            return Plan::parse(&text, name_or_path, changes);
        }
        if let Some(plan) = builtin::find(name_or_path) {
            return Plan::parse(plan.text, plan.name, changes);
        }
        let names = || builtin::plans().iter().map(|plan| plan.name);
        let near = nearest(name_or_path, names());
        let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
        let names = names().collect::<Vec<_>>().join(", ");
        Err(PlanErrors(vec![format!(
            "{name_or_path}: there is no such file and no such built-in plan{near} (built-in: {names})"
        )]))
    }

    /// Reads and checks a plan; `name` is that of its file, for errors.
    ///
    /// # Errors
    /// As [`Plan::open`].
    pub fn parse(text: &str, name: &str, changes: &Changes) -> Result<Plan, PlanErrors> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let refused = |what: String| PlanErrors(vec![format!("{name}: {what}")]);
        if text.len() > LONGEST_TEXT {
            return Err(refused(format!("the plan is too long: at most {LONGEST_TEXT} bytes are read")));
        }
        let read: PlanText = read_ron(text).map_err(|error| {
            let (offset, what) = describe_error(text, &error);
            let (line, column) = line_column(text, offset);
            PlanErrors(vec![format!("{name}:{line}:{column}: {what}")])
        })?;
        if read.version != PLAN_VERSION {
            return Err(refused(format!(
                "version = {}: allowed: {PLAN_VERSION} (version of the plan file)",
                read.version
            )));
        }
        let scene = resolved_scene(&read, name, &changes.set)?;
        let plan = Plan::of(read, scene, changes.lines).map_err(|wrong| in_plan(wrong, name))?;
        plan.check().map_err(|wrong| in_plan(wrong, name))?;
        Ok(plan)
    }

    fn of(read: PlanText, scene: Scene, lines: Option<u64>) -> Result<Plan, Vec<String>> {
        let PlanText { title, notice, mut axes, preloads, record, stiffness, measured_sha256, .. } = read;
        let by_axis = axes.iter().position(|axis| axis.path() == "preload");
        let preloads = match (by_axis, preloads.is_empty()) {
            (Some(_), false) => {
                return Err(vec!["preloads are given twice: by `preloads` and by an axis".into()]);
            }
            (Some(place), true) => Some(axes.remove(place)),
            (None, false) => Some(Axis::List { path: "preload".into(), values: preloads }),
            (None, true) => None,
        };
        let seed = read.seed.or(scene.seed()).unwrap_or(0);
        let lines = lines.or(read.lines).unwrap_or(1);
        Ok(Plan { title, notice, scene, axes, preloads, lines, seed, record, stiffness, measured_sha256 })
    }

    /// The plan as canonical text including its scene; parsing the text returns the same plan.
    #[must_use]
    pub fn to_ron(&self) -> String {
        let mut lines = vec![format!("    version: {PLAN_VERSION},\n")];
        let mut line = |name: &str, value: String| lines.push(format!("    {name}: {value},\n"));
        for (name, text) in [("title", &self.title), ("notice", &self.notice)] {
            if !text.is_empty() {
                line(name, ron_string(text));
            }
        }
        line("scene", to_ron(&self.scene).trim_end().replace('\n', "\n    "));
        let list =
            |values: &[f64]| values.iter().map(|value| ron_float(*value)).collect::<Vec<_>>().join(", ");
        let axis = |axis: &Axis| match axis {
            Axis::Linear { path, from, to, count } => ends("Linear", path, *from, *to, *count),
            Axis::Logarithmic { path, from, to, count } => ends("Logarithmic", path, *from, *to, *count),
            Axis::List { path, values } => {
                format!("        List(path: {}, values: [{}]),\n", ron_string(path), list(values))
            }
        };
        let axes: String = self.all_axes().into_iter().map(axis).collect();
        line("axes", format!("[\n{axes}    ]"));
        line("lines", self.lines.to_string());
        line("seed", self.seed.to_string());
        let names: Vec<_> = self.record.iter().map(|quantity| quantity.name()).collect();
        line("record", format!("[{}]", names.join(", ")));
        let StiffnessRange { from, to, count } = self.stiffness;
        line("stiffness", format!("(from: {}, to: {}, count: {count})", ron_float(from), ron_float(to)));
        if let Some(hash) = &self.measured_sha256 {
            line("measured_sha256", ron_string(hash));
        }
        format!("(\n{})\n", lines.concat())
    }
}

fn ends(kind: &str, path: &str, from: f64, to: f64, count: u64) -> String {
    let (path, from, to) = (ron_string(path), ron_float(from), ron_float(to));
    format!("        {kind}(path: {path}, from: {from}, to: {to}, count: {count}),\n")
}

fn in_plan(wrong: Vec<String>, name: &str) -> PlanErrors {
    PlanErrors(wrong.into_iter().map(|wrong| format!("{name}: {wrong}")).collect())
}

/// The scene of a plan with all overrides; its paths are made absolute.
fn resolved_scene(read: &PlanText, name: &str, set: &[(String, String)]) -> Result<Scene, PlanErrors> {
    let in_scene = |errors: SceneErrors| {
        let lines = errors.to_string();
        in_plan(lines.lines().map(str::to_owned).collect(), name)
    };
    let document = match (&read.base, &read.scene) {
        (Some(_), Some(_)) => {
            return Err(PlanErrors(vec![format!(
                "{name}: `base` and `scene` are given; allowed: one of them"
            )]));
        }
        (None, None) => {
            return Err(PlanErrors(vec![format!(
                "{name}: neither `base` nor `scene` is given; allowed: one of them"
            )]));
        }
        (None, Some(scene)) => Document::from_scene(scene, name).map_err(in_scene)?,
        (Some(base), None) => {
            let beside = Path::new(name).parent().unwrap_or(Path::new("")).join(base);
            let beside = beside.to_string_lossy();
            let is_file = base.ends_with(".ron") || Path::new(&*beside).is_file();
            open(if is_file { &beside } else { base }).map_err(in_scene)?
        }
    };
    let set: Vec<_> = read
        .set
        .iter()
        .map(|(path, value)| (path.clone(), value.clone()))
        .chain(set.iter().cloned())
        .collect();
    let document = document.set_all(&set).map_err(in_scene)?;
    let mut scene = document.scene().clone();
    scene.rename_measured_files(|file| {
        let path = document.resolve(file);
        std::path::absolute(&path).unwrap_or(path).display().to_string()
    });
    Ok(scene)
}
