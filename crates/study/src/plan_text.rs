//! The text of a plan: functions that read a plan and its scene from text, and functions that write
//! a plan as text.

use super::axis::{Axis, AxisText, Spacing};
use super::error::StudyError;
use super::plan::{MOST_AXES, PRELOAD, Plan, StiffnessRange};
use super::quantity::Quantity;
use asperity_data::read_regular_text;
use asperity_scene::library::{is_file_name, is_path};
use asperity_scene::text::{
    LONGEST_TEXT, did_you_mean, explain, line_column, read_ron, ron_float, ron_string, to_ron,
};
use asperity_scene::{Document, Preset, Scene, built_in, open};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Version of the format of plan files. Files of another version cannot be read.
pub const PLAN_VERSION: u32 = 1;

/// Changes that [`Plan::open`] makes to the plan that it has read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Paths of fields of the scene, each with its new value, written as in a scene file.
    pub set: Vec<(String, String)>,
    /// Number of random profiles for each [cell](Plan); `None` keeps the number in the plan.
    pub lines: Option<u64>,
}

#[derive(Default, Deserialize)]
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
    axes: Vec<AxisText>,
    #[serde(default)]
    preloads: Vec<f64>,
    #[serde(default)]
    profiles: Option<u64>,
    #[serde(default)]
    seed: Option<u64>,
    record: Vec<Quantity>,
    #[serde(default)]
    stiffness: StiffnessRange,
    #[serde(default)]
    measured_sha256: Option<String>,
}

impl Plan {
    /// Built-in plans of studies, such as `figure-6`.
    pub const BUILT_IN: &[Preset] = built_in!("plans/":
        "figure-5a",
        "figure-5b",
        "figure-6",
        "equation-15",
        "elastic-energy",
        "stiffness-exponent",
        "self-averaging"
    );

    /// Reads and checks a plan. `name_or_path` is the name of a built-in plan, such as `figure-6`,
    /// or the path of a file. The path of a scene file in the plan is relative to the folder of the
    /// plan. `changes` are made before the plan is checked.
    ///
    /// # Errors
    /// Returns an error if the plan cannot be read, if it has an error, or if the scene of a
    /// [cell](Plan) has an error.
    ///
    /// ```
    /// use asperity_study::{Changes, Plan};
    ///
    /// let few = Changes { lines: Some(2), ..Changes::default() };
    /// let plan = Plan::open("figure-6", &few)?;
    /// assert_eq!(plan.lines, 2);
    /// assert!(Plan::open("figure-7", &few).unwrap_err().to_string().contains("did you mean"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn open(name_or_path: &str, changes: &Changes) -> Result<Plan, StudyError> {
        if is_file_name(name_or_path) {
            let text = read_regular_text(Path::new(name_or_path), LONGEST_TEXT);
            let text =
                text.map_err(|error| StudyError::Plan(vec![format!("{name_or_path}: {error}")]))?;
            return Plan::parse(&text, name_or_path, changes);
        }
        let plan = Plan::built_in(name_or_path)?;
        Plan::parse(plan.text, plan.name, changes)
    }

    /// Makes a plan of a study that varies numbers of a scene. Each element of `axes` is the path
    /// of a number and the values of this number in SI units. For each combination of values, the
    /// quantities in `record` are recorded on `profiles` random profiles.
    ///
    /// # Errors
    /// Returns an error if the plan or the scene of a [cell](Plan) has an error.
    ///
    /// ```
    /// use asperity_study::{Plan, Quantity};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?;
    /// let axes: [(&str, &[f64]); 2] = [
    ///     ("roughness.hurst", &[0.3, 0.7]),
    ///     ("adhesion.kappa", &[2.0, 6.0, 20.0]),
    /// ];
    /// let plan = Plan::new(
    ///     &scene,
    ///     &axes,
    ///     16,
    ///     &[Quantity::PullOffForce, Quantity::Regime],
    /// )?;
    /// assert_eq!((plan.cells(), plan.records_in_all()), (6, 96));
    /// assert_eq!(
    ///     plan.coordinates(4),
    ///     "roughness.hurst = 0.7, adhesion.kappa = 6.0"
    /// );
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        document: &Document,
        axes: &[(&str, &[f64])],
        profiles: u64,
        record: &[Quantity],
    ) -> Result<Plan, StudyError> {
        let mut texts = Vec::with_capacity(axes.len());
        for (path, values) in axes {
            texts.push(AxisText::List {
                path: (*path).to_owned(),
                values: values.to_vec(),
            });
        }
        let read = PlanText {
            axes: texts,
            record: record.to_vec(),
            ..PlanText::default()
        };
        let plan = Plan::of(read, with_absolute_paths(document), Some(profiles))
            .map_err(StudyError::Plan)?;
        plan.check_cells().map_err(StudyError::Plan)?;
        Ok(plan)
    }

    /// Returns the text of the built-in plan with this name.
    ///
    /// # Errors
    /// Returns an error if there is no plan of this name.
    pub fn built_in(name: &str) -> Result<&'static Preset, StudyError> {
        if let Some(plan) = Plan::BUILT_IN.iter().find(|plan| plan.name == name) {
            return Ok(plan);
        }
        let names: Vec<_> = Plan::BUILT_IN.iter().map(|plan| plan.name).collect();
        let near = did_you_mean(name, names.iter().copied());
        let names = names.join(", ");
        let message = "there is no such file and no such built-in plan";
        let message = format!("{name}: {message}{near} (built-in: {names})");
        Err(StudyError::Plan(vec![message]))
    }

    /// Reads and checks the text of a plan. `name` is usually the path of the plan. Error messages
    /// begin with `name`, and the path of a scene file in the plan is relative to the folder of
    /// `name`.
    ///
    /// # Errors
    /// The errors are the same as those of [`Plan::open`].
    pub fn parse(text: &str, name: &str, changes: &Changes) -> Result<Plan, StudyError> {
        let plan = Plan::read(text, name, changes)?;
        plan.check_cells().map_err(|wrong| in_plan(wrong, name))?;
        Ok(plan)
    }

    /// Reads a plan and checks it, but not the scenes of its cells.
    pub(super) fn read(text: &str, name: &str, changes: &Changes) -> Result<Plan, StudyError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.len() > LONGEST_TEXT {
            let wrong = format!("the plan is too long: at most {LONGEST_TEXT} bytes are read");
            return Err(in_plan(vec![wrong], name));
        }
        let read: PlanText = read_ron(text).map_err(|error| {
            let (offset, error) = explain(text, &error);
            let (line, column) = line_column(text, offset);
            StudyError::Plan(vec![format!("{name}:{line}:{column}: {}", error.what())])
        })?;
        if read.version != PLAN_VERSION {
            let wrong = format!(
                "version = {}: allowed: {PLAN_VERSION} (version of the plan file)",
                read.version
            );
            return Err(in_plan(vec![wrong], name));
        }
        let scene = resolved_scene(&read, name, &changes.set)?;
        Plan::of(read, scene, changes.lines).map_err(|wrong| in_plan(wrong, name))
    }

    /// Makes a plan from its text and its scene. `lines` replaces the number of profiles in the
    /// text. If the plan has errors, all of them are returned together.
    fn of(read: PlanText, scene: Scene, lines: Option<u64>) -> Result<Plan, Vec<String>> {
        let PlanText {
            title,
            notice,
            axes,
            preloads,
            record,
            stiffness,
            measured_sha256,
            ..
        } = read;
        if axes.len() > MOST_AXES {
            return Err(vec![format!(
                "{} axes; allowed: at most {MOST_AXES}",
                axes.len()
            )]);
        }
        let mut axes = axes;
        if !preloads.is_empty() {
            axes.push(AxisText::List {
                path: PRELOAD.into(),
                values: preloads,
            });
        }
        let mut wrong = Vec::new();
        let mut read_axes = Vec::new();
        for axis in axes {
            match Axis::of(&axis, &scene) {
                Ok(axis) => read_axes.push(axis),
                Err(error) => wrong.push(error),
            }
        }
        // The preload must change fastest from cell to cell, so its axis is moved to the end.
        read_axes.sort_by_key(Axis::is_of_preloads);
        let plan = Plan {
            title,
            notice,
            axes: read_axes,
            lines: lines.or(read.profiles).unwrap_or(1),
            seed: read.seed.or(scene.seed()).unwrap_or(0),
            record,
            scene,
            stiffness,
            measured_sha256,
        };
        wrong.extend(plan.errors());
        if wrong.is_empty() {
            Ok(plan)
        } else {
            Err(wrong)
        }
    }

    /// Returns the plan as the text of a plan file in RON that contains the scene itself instead of
    /// the path of a scene file.
    ///
    /// ```
    /// use asperity_study::{Changes, Plan};
    ///
    /// let plan = Plan::open("self-averaging", &Changes::default())?;
    /// assert_eq!(Plan::parse(&plan.to_ron(), "again", &Changes::default())?, plan);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_ron(&self) -> String {
        let mut lines = Vec::new();
        for (name, text) in [("title", &self.title), ("notice", &self.notice)] {
            if !text.is_empty() {
                lines.push((name, ron_string(text)));
            }
        }
        let scene = to_ron(&self.scene).trim_end().replace('\n', "\n    ");
        lines.push(("scene", scene));
        let axes: String = self
            .axes
            .iter()
            .map(|axis| format!("        {},\n", in_ron(axis)))
            .collect();
        lines.push(("axes", format!("[\n{axes}    ]")));
        lines.push(("profiles", self.lines.to_string()));
        lines.push(("seed", self.seed.to_string()));
        let names: Vec<_> = self.record.iter().map(|quantity| quantity.name()).collect();
        lines.push(("record", format!("[{}]", names.join(", "))));
        let StiffnessRange { from, to, count } = self.stiffness;
        let from = ron_float(from);
        let to = ron_float(to);
        let stiffness = format!("(from: {from}, to: {to}, count: {count})");
        lines.push(("stiffness", stiffness));
        if let Some(hash) = &self.measured_sha256 {
            lines.push(("measured_sha256", ron_string(hash)));
        }
        let mut text = format!("(\n    version: {PLAN_VERSION},\n");
        for (name, value) in lines {
            text += &format!("    {name}: {value},\n");
        }
        text + ")\n"
    }
}

fn in_ron(axis: &Axis) -> String {
    let path = ron_string(&axis.path);
    let kind = match axis.spacing {
        Spacing::List => {
            let values: Vec<_> = axis.values.iter().map(|value| ron_float(*value)).collect();
            return format!("List(path: {path}, values: [{}])", values.join(", "));
        }
        Spacing::Linear => "Linear",
        Spacing::Logarithmic => "Logarithmic",
    };
    let [from, to] =
        [axis.values.first(), axis.values.last()].map(|end| ron_float(*end.unwrap_or(&f64::NAN)));
    format!(
        "{kind}(path: {path}, from: {from}, to: {to}, count: {})",
        axis.count()
    )
}

fn in_plan(wrong: Vec<String>, name: &str) -> StudyError {
    let mut lines = Vec::with_capacity(wrong.len());
    for wrong in wrong {
        lines.push(format!("{name}: {wrong}"));
    }
    StudyError::Plan(lines)
}

/// Returns the scene of a plan after the changes `set` of its fields, with absolute paths of files.
fn resolved_scene(
    read: &PlanText,
    name: &str,
    set: &[(String, String)],
) -> Result<Scene, StudyError> {
    let opened = match (&read.base, &read.scene) {
        (Some(_), Some(_)) => return Err(not_one("`base` and `scene` are given", name)),
        (None, None) => return Err(not_one("neither `base` nor `scene` is given", name)),
        (None, Some(scene)) => Document::from_scene(scene, name),
        (Some(base), None) => {
            let beside = Path::new(name).parent().unwrap_or(Path::new("")).join(base);
            let beside = beside.to_string_lossy();
            let is_file = is_path(base) || Path::new(&*beside).is_file();
            open(if is_file { &beside } else { base })
        }
    };
    let mut all_set: Vec<(String, String)> = read.set.clone().into_iter().collect();
    all_set.extend_from_slice(set);
    match opened.and_then(|document| document.set_all(&all_set)) {
        Ok(document) => Ok(with_absolute_paths(&document)),
        Err(errors) => {
            let lines = errors.to_string();
            Err(in_plan(lines.lines().map(str::to_owned).collect(), name))
        }
    }
}

/// Returns the error of a plan that names a scene file and also contains a scene, or that has
/// neither.
fn not_one(given: &str, name: &str) -> StudyError {
    in_plan(vec![format!("{given}; allowed: one of them")], name)
}

/// Returns the scene of a document with absolute paths, so that its files are found from any
/// folder.
fn with_absolute_paths(document: &Document) -> Scene {
    let mut scene = Scene::clone(document.scene());
    scene.rename_measured_files(|file| {
        let path = document.resolve(file);
        std::path::absolute(&path)
            .unwrap_or(path)
            .display()
            .to_string()
    });
    scene
}
