//! The plan of a study: a scene, what is varied in it, on how many lines, and what is recorded.

use super::axis::Axis;
use super::builtin;
use super::cells::Cells;
use super::measured::is_hash;
use super::quantity::{Needs, Quantity};
use super::target::Target;
use crate::scene::{
    Document, LONGEST_TEXT, Roughness, Scene, SceneErrors, Violation, check, line_column, nearest, open,
    read_file, ron_float, ron_string, to_ron, told_otherwise,
};
use ron::extensions::Extensions;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// The only version of the plan file this program reads.
pub const PLAN_VERSION: u32 = 1;
/// Most cells of a plan.
pub const MOST_CELLS: u64 = 10_000_000;
/// Most lines of a plan.
pub const MOST_LINES: u64 = 1_000_000;
/// Most records, cells times lines, of a plan.
pub const MOST_RECORDS: u64 = 100_000_000;
/// Most axes of a plan.
const MOST_AXES: usize = 16;
/// Cells with invalid scenes that are named; the rest is counted.
const MOST_NAMED: usize = 8;

/// A checked plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// One line naming the study.
    pub title: String,
    /// What to look at.
    pub notice: String,
    /// The scene in which numbers are varied. Files it names are named from the root.
    pub scene: Scene,
    /// What is varied, the last fastest; without the preload.
    pub axes: Vec<Axis>,
    /// Preloads in units of E* h L, the fastest axis of all; none: the loading of the scene.
    pub preloads: Option<Axis>,
    /// Random lines of each cell.
    pub lines: u64,
    /// Seed of the first line; those that follow have the next, the same in all cells.
    pub seed: u64,
    /// What is recorded.
    pub record: Vec<Quantity>,
    /// Forces between which exponents are fitted.
    pub stiffness: StiffnessRange,
    /// SHA-256 of the measured file's content, in 64 hexadecimal digits; the folder of a study has it.
    pub measured_sha256: Option<String>,
}

/// Forces between which exponents of the contact without adhesion are fitted, in units of E* h L.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StiffnessRange {
    /// Smallest force, above zero.
    pub from: f64,
    /// Largest force.
    pub to: f64,
    /// Forces at equal ratios, at least 2.
    pub count: u64,
}

impl Default for StiffnessRange {
    /// Between what a few waves carry and what flattens the long ones.
    fn default() -> Self {
        StiffnessRange { from: 1.0e-4, to: 1.0e-2, count: 17 }
    }
}

/// Axes of which the first sets what the second does.
const SAME: [(&str, &str); 3] =
    [("springs_per_wave", "roughness.modes.1"), ("kappa", "adhesion.kappa"), ("kappa", "adhesion.work")];
/// Most forces of a [`StiffnessRange`].
const MOST_FORCES: u64 = 1000;

/// All that is wrong with a plan, each a line of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanErrors(pub Vec<String>);

impl fmt::Display for PlanErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl std::error::Error for PlanErrors {}

/// What is changed in a plan for one study, beside the text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Overrides of the scene: path and value.
    pub set: Vec<(String, String)>,
    /// Number of lines.
    pub lines: Option<u64>,
}

/// A plan as it is written.
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
    /// Opens and checks a plan: a file, where one of that name exists or the name looks like one, else a
    /// built-in plan. Scenes it names by a path are relative to its file.
    ///
    /// # Errors
    /// All that is wrong, up to the scene of every single cell.
    pub fn open(name_or_path: &str, changes: &Changes) -> Result<Plan, PlanErrors> {
        let path = Path::new(name_or_path);
        let looks_like_file =
            name_or_path.ends_with(".ron") || name_or_path.chars().any(std::path::is_separator);
        if looks_like_file || path.is_file() {
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

    /// Reads and checks a plan; `name` is its file's, and errors carry it.
    ///
    /// # Errors
    /// As [`Plan::open`].
    pub fn parse(text: &str, name: &str, changes: &Changes) -> Result<Plan, PlanErrors> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let told = |what: String| PlanErrors(vec![format!("{name}: {what}")]);
        if text.len() > LONGEST_TEXT {
            return Err(told(format!("the plan is too long: at most {LONGEST_TEXT} bytes are read")));
        }
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let read: PlanText = options.from_str(text).map_err(|error| {
            let (offset, what) = told_otherwise(text, &error);
            let (line, column) = line_column(text, offset);
            PlanErrors(vec![format!("{name}:{line}:{column}: {what}")])
        })?;
        if read.version != PLAN_VERSION {
            return Err(told(format!(
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

    /// Everything that can be checked before anything runs. Counts come first, so nothing is made in
    /// proportion to what is too large.
    fn check(&self) -> Result<(), Vec<String>> {
        let mut wrong: Vec<String> = Vec::new();
        if self.axes.len() > MOST_AXES {
            wrong.push(format!("{} axes; allowed: at most {MOST_AXES}", self.axes.len()));
        }
        wrong.extend(self.check_texts());
        let all = || self.axes.iter().chain(&self.preloads);
        wrong.extend(all().filter_map(Axis::wrong));
        for (index, axis) in all().enumerate() {
            if all().take(index).any(|other| other.path() == axis.path()) {
                wrong.push(format!("axis {}: given twice", axis.path()));
            }
        }
        for (one, other) in SAME {
            if [one, other].iter().all(|path| self.axes.iter().any(|axis| axis.path() == *path)) {
                wrong.push(format!("axis {other}: {one} sets it as well; allowed: one of them"));
            }
        }
        if !(1..=MOST_LINES).contains(&self.lines) {
            wrong.push(format!("lines = {}: allowed: from 1 to {MOST_LINES}", self.lines));
        }
        if self.lines > 1 && self.scene.seed().is_none() {
            wrong.push(format!(
                "lines = {}: several lines go with random roughness, which has seeds; this scene has one",
                self.lines
            ));
        }
        if self.record.is_empty() {
            wrong.push("record = []: allowed: at least one quantity".into());
        }
        for (index, quantity) in self.record.iter().enumerate() {
            if self.record[..index].contains(quantity) {
                wrong.push(format!("record: {} is given twice", quantity.name()));
            }
        }
        if let Some(preloads) = &self.preloads
            && let Some(value) = least(preloads).filter(|value| *value <= 0.0)
        {
            wrong.push(format!("preload {value:?}: allowed: above 0, in units of E* h L"));
        }
        let StiffnessRange { from, to, count } = self.stiffness;
        if !(from > 0.0 && from < to && to.is_finite() && (2..=MOST_FORCES).contains(&count)) {
            wrong.push(format!(
                "stiffness = (from: {from:?}, to: {to:?}, count: {count}): allowed: 0 < from < to, count from 2 \
                 to {MOST_FORCES}"
            ));
        }
        let smooth = self.scene.roughness.is_none();
        let needs_height = self.preloads.is_some() || self.records(Needs::Stiffness);
        if smooth && needs_height {
            wrong.push(
                "preloads and exponents count forces in units of E* h L, and this scene is smooth; \
                 allowed: an axis loading.0.0, in N"
                    .into(),
            );
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let cells = all().map(Axis::count).try_fold(1_u64, u64::checked_mul);
        let counts = || all().map(|axis| axis.count().to_string()).collect::<Vec<_>>().join(" × ");
        let Some(cells) = cells.filter(|cells| *cells <= MOST_CELLS) else {
            return Err(vec![format!("{} cells; allowed: at most {MOST_CELLS}", counts())]);
        };
        if cells * self.lines > MOST_RECORDS {
            return Err(vec![format!(
                "{} cells on {} lines; allowed: at most {MOST_RECORDS} together",
                counts(),
                self.lines
            )]);
        }
        self.check_cells()
    }

    /// What is wrong with title and notice, which are held to what a scene may have, and with the hash.
    fn check_texts(&self) -> Vec<String> {
        let (title, notice) = (self.title.clone(), self.notice.clone());
        let texts = Scene { title, notice, ..self.scene.clone() };
        let is_text = |violation: &&Violation| ["title", "notice"].contains(&violation.field.as_str());
        let mut wrong: Vec<String> = check(&texts).iter().filter(is_text).map(worded).collect();
        if let Some(hash) = &self.measured_sha256 {
            if !is_hash(hash) {
                wrong.push(format!(
                    "measured_sha256 = {}: allowed: 64 digits from 0 to 9 and a to f",
                    ron_string(hash)
                ));
            }
            if !matches!(self.scene.roughness, Some(Roughness::Measured { .. })) {
                wrong.push(
                    "measured_sha256: goes with roughness: Measured; this scene has no such file".into(),
                );
            }
        }
        wrong
    }

    /// The scene of every cell.
    fn check_cells(&self) -> Result<(), Vec<String>> {
        let cells = Cells::of(self);
        let (mut wrong, mut count) = (Vec::new(), 0_u64);
        let mut scene = self.prototype();
        for run in 0..cells.runs() {
            let reason = match cells.shape(run, &self.scene, &mut scene) {
                Err((axis, reason)) => Some(format!("axis {axis}: {reason}")),
                Ok(()) => check(&scene).first().map(worded),
            };
            let Some(reason) = reason else { continue };
            count += 1;
            if wrong.len() < MOST_NAMED {
                let cell = cells.first_cell(run);
                wrong.push(format!("cell {cell} ({}): {reason}", self.coordinates(cell)));
            }
        }
        if count > wrong.len() as u64 {
            wrong.push(format!("and {} more cells are not allowed", count - wrong.len() as u64));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// The scene without the texts that no cell needs.
    pub(super) fn prototype(&self) -> Scene {
        Scene { title: String::new(), notice: String::new(), observe: Vec::new(), ..self.scene.clone() }
    }

    /// Calls `each` with the scene of every run: of every cell, but that those which differ in the preload
    /// alone are one. Preloads, which need the line, are not in them.
    pub fn each_scene(&self, mut each: impl FnMut(&Scene)) {
        let cells = Cells::of(self);
        let mut scene = self.prototype();
        for run in 0..cells.runs() {
            if cells.shape(run, &self.scene, &mut scene).is_ok() {
                each(&scene);
            }
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.axes.iter().chain(&self.preloads).map(Axis::count).product()
    }

    /// Number of records: cells times lines.
    #[must_use]
    pub fn records_in_all(&self) -> u64 {
        self.cells() * self.lines
    }

    /// Values of the axes in a cell, and after them its preload where there is one.
    #[must_use]
    pub fn values(&self, cell: u64) -> Vec<f64> {
        let mut rest = cell;
        let mut values: Vec<f64> = Vec::with_capacity(self.axes.len() + 1);
        for axis in self.axes.iter().chain(&self.preloads).rev() {
            values.push(axis.value(rest % axis.count()));
            rest /= axis.count();
        }
        values.reverse();
        values
    }

    /// A cell's coordinates as people read them.
    #[must_use]
    pub fn coordinates(&self, cell: u64) -> String {
        let axes = self.axes.iter().chain(&self.preloads);
        let one = |(axis, value): (&Axis, f64)| format!("{} = {}", axis.path(), ron_float(value));
        let all: Vec<_> = axes.zip(self.values(cell)).map(one).collect();
        if all.is_empty() { "the scene itself".into() } else { all.join(", ") }
    }

    /// Seed of a line.
    #[must_use]
    pub fn seed_of(&self, line: u64) -> u64 {
        self.seed.wrapping_add(line)
    }

    pub(super) fn records(&self, needs: Needs) -> bool {
        self.record.iter().any(|quantity| quantity.needs() == needs)
    }

    /// The plan as canonical text with its scene in it; reading it gives the same plan.
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
        let axes: String = self.axes.iter().chain(&self.preloads).map(axis).collect();
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

/// A value that is not allowed, and what is.
fn worded(violation: &Violation) -> String {
    let Violation { field, value, allowed, reason, .. } = violation;
    let allowed = if allowed.is_empty() { reason.clone() } else { format!("allowed: {allowed} ({reason})") };
    format!("{field} = {value}: {allowed}")
}

fn ends(kind: &str, path: &str, from: f64, to: f64, count: u64) -> String {
    let (path, from, to) = (ron_string(path), ron_float(from), ron_float(to));
    format!("        {kind}(path: {path}, from: {from}, to: {to}, count: {count}),\n")
}

fn least(axis: &Axis) -> Option<f64> {
    match axis {
        Axis::Linear { from, .. } | Axis::Logarithmic { from, .. } => Some(*from),
        Axis::List { values, .. } => values.iter().copied().min_by(f64::total_cmp),
    }
}

fn in_plan(wrong: Vec<String>, name: &str) -> PlanErrors {
    PlanErrors(wrong.into_iter().map(|wrong| format!("{name}: {wrong}")).collect())
}

/// The scene of a plan with all overrides; what it names by a path is named from the root.
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
        (None, Some(scene)) => Document::of_scene(scene, name).map_err(in_scene)?,
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
    if let Some(Roughness::Measured { file, .. }) = &mut scene.roughness {
        let path = document.resolve(file);
        *file = std::path::absolute(&path).unwrap_or(path).display().to_string();
    }
    Ok(scene)
}

/// What the axes of a plan vary.
pub(super) fn targets(plan: &Plan) -> Vec<Target> {
    plan.axes.iter().filter_map(|axis| Target::of(axis.path()).ok()).collect()
}
