//! All checks of a plan before a run.

use super::axis::Axis;
use super::cells::Cells;
use super::measured::is_hash;
use super::plan::{Plan, StiffnessRange};
use super::quantity::Needs;
use crate::scene::{Roughness, Scene, SceneError, check, ron_string};

/// Most cells of a plan.
pub const MOST_CELLS: u64 = 10_000_000;
/// Most profiles of a plan.
pub const MOST_LINES: u64 = 1_000_000;
/// Most records of a plan: cells times profiles.
pub const MOST_RECORDS: u64 = 100_000_000;
/// Most axes of a plan.
const MOST_AXES: usize = 16;
/// Most cells with invalid scenes that are named; the rest is counted.
const MOST_NAMED: usize = 8;

/// Pairs of axes that set the same quantity.
const SAME: [(&str, &str); 8] = [
    ("springs_per_wave", "roughness.modes.1"),
    ("kappa", "adhesion.kappa"),
    ("kappa", "adhesion.work"),
    ("kappa", "adhesion.elastic_energy_ratio"),
    ("kappa", "elastic_energy_ratio"),
    ("elastic_energy_ratio", "adhesion.elastic_energy_ratio"),
    ("elastic_energy_ratio", "adhesion.work"),
    ("elastic_energy_ratio", "adhesion.kappa"),
];
/// Most forces of a [`StiffnessRange`].
const MOST_FORCES: u64 = 1000;

impl Plan {
    /// Checks the plan before a run. Counts come first, so that no allocation is proportional to an excessive count.
    pub(super) fn check(&self) -> Result<(), Vec<String>> {
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
        let seeds = self.scene.seed().is_some();
        if self.lines > 1 && !seeds {
            wrong.push(format!(
                "lines = {}: several lines go with roughness: SelfAffine or an equivalent line, which have seeds; this scene has but one",
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

    /// Errors of title and notice, by the rules of a scene, and of the hash.
    fn check_texts(&self) -> Vec<String> {
        let (title, notice) = (self.title.clone(), self.notice.clone());
        let texts = Scene { title, notice, ..self.scene.clone() };
        let is_text = |error: &&SceneError| ["title", "notice"].contains(&error.field.as_str());
        let mut wrong: Vec<String> =
            check(&texts).iter().filter(is_text).map(SceneError::to_string).collect();
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

    /// Checks the scene of every cell.
    fn check_cells(&self) -> Result<(), Vec<String>> {
        let cells = Cells::of(self);
        let (mut wrong, mut count) = (Vec::new(), 0_u64);
        let mut scene = self.prototype();
        for run in 0..cells.runs() {
            let reason = match cells.shape(run, &self.scene, &mut scene) {
                Err((axis, reason)) => Some(format!("axis {axis}: {reason}")),
                Ok(()) => check(&scene).first().map(SceneError::to_string),
            };
            let Some(reason) = reason else { continue };
            count += 1;
            if wrong.len() < MOST_NAMED {
                let cell = cells.cells_of(run).start;
                wrong.push(format!("cell {cell} ({}): {reason}", self.coordinates(cell)));
            }
        }
        if count > wrong.len() as u64 {
            wrong.push(format!("and {} more cells are not allowed", count - wrong.len() as u64));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Calls `each` with the scene of every run: one for all cells that differ only in the preload. Preloads depend
    /// on the profile and are not set.
    pub fn each_scene(&self, mut each: impl FnMut(&Scene)) {
        let cells = Cells::of(self);
        let mut scene = self.prototype();
        for run in 0..cells.runs() {
            if cells.shape(run, &self.scene, &mut scene).is_ok() {
                each(&scene);
            }
        }
    }
}

fn least(axis: &Axis) -> Option<f64> {
    match axis {
        Axis::Linear { from, .. } | Axis::Logarithmic { from, .. } => Some(*from),
        Axis::List { values, .. } => values.iter().copied().min_by(f64::total_cmp),
    }
}
