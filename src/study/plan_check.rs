//! Checks of a plan. Those of the plan itself come first and are quick; the scene of every cell is checked when a plan is
//! opened for a study, not when the folder of a study is opened again.

use super::axis::Axis;
use super::plan::{ONE_PROFILE, PRELOAD, Plan, StiffnessRange};
use super::quantity::Needs;
use crate::scene::{Scene, SceneError, check};

/// Most cells of a plan.
pub const MOST_CELLS: u64 = 10_000_000;
/// Most profiles of a plan.
pub const MOST_LINES: u64 = 1_000_000;
/// Most records of a plan: cells times profiles.
pub const MOST_RECORDS: u64 = 100_000_000;
/// Most axes of a plan.
pub(super) const MOST_AXES: usize = 16;
/// Most cells with invalid scenes that are named; the rest is counted.
const MOST_NAMED: usize = 8;
/// Most forces of a [`StiffnessRange`].
const MOST_FORCES: u64 = 1000;

/// Axes that set the same quantity, of which a plan may have one.
const SAME: [&[&str]; 2] = [
    &["springs_per_wave", "roughness.modes.1"],
    &["kappa", "elastic_energy_ratio", "adhesion.kappa", "adhesion.work", "adhesion.elastic_energy_ratio"],
];

impl Plan {
    /// Errors of the plan itself.
    pub(super) fn errors(&self) -> Vec<String> {
        let mut wrong = self.errors_of_texts();
        let paths: Vec<&str> = self.axes.iter().map(|axis| axis.path.as_str()).collect();
        for (index, path) in paths.iter().enumerate() {
            let before = &paths[..index];
            if before.contains(path) {
                wrong.push(format!("axis {path}: given twice"));
            }
            let same = SAME.iter().find(|same| same.contains(path));
            let other =
                before.iter().find(|other| same.is_some_and(|same| same.contains(other)) && *other != path);
            wrong.extend(
                other.map(|other| format!("axis {path}: {other} sets it as well; allowed: one of them")),
            );
        }
        if !(1..=MOST_LINES).contains(&self.lines) {
            wrong.push(format!("lines = {}: allowed: from 1 to {MOST_LINES}", self.lines));
        }
        if self.lines > 1 && self.scene.seed().is_none() {
            wrong.push(format!("lines = {}: {}", self.lines, ONE_PROFILE));
        }
        if self.record.is_empty() {
            wrong.push("record = []: allowed: at least one quantity".into());
        }
        for (index, quantity) in self.record.iter().enumerate() {
            if self.record[..index].contains(quantity) {
                wrong.push(format!("record: {} is given twice", quantity.name()));
            }
        }
        let preloads = self.axes.iter().find(|axis| axis.path == PRELOAD);
        if let Some(value) = preloads.and_then(|axis| axis.values.iter().find(|value| **value <= 0.0)) {
            wrong.push(format!("preload {value:?}: allowed: above 0, in units of E* h L"));
        }
        let StiffnessRange { from, to, count } = self.stiffness;
        if !(from > 0.0 && from < to && to.is_finite() && (2..=MOST_FORCES).contains(&count)) {
            wrong.push(format!(
                "stiffness = (from: {from:?}, to: {to:?}, count: {count}): allowed: 0 < from < to, count from 2 \
                 to {MOST_FORCES}"
            ));
        }
        if self.scene.roughness.is_none() && (preloads.is_some() || self.records(Needs::Stiffness)) {
            wrong.push(
                "preloads and exponents count forces in units of E* h L, and this scene is smooth; \
                 allowed: an axis loading.0.0, in N"
                    .into(),
            );
        }
        let cells = self.axes.iter().map(Axis::count).try_fold(1_u64, u64::checked_mul);
        let counts = || self.axes.iter().map(|axis| axis.count().to_string()).collect::<Vec<_>>().join(" × ");
        match cells.filter(|cells| *cells <= MOST_CELLS) {
            None => wrong.push(format!("{} cells; allowed: at most {MOST_CELLS}", counts())),
            Some(cells) if cells.saturating_mul(self.lines) > MOST_RECORDS => wrong.push(format!(
                "{} cells on {} profiles; allowed: at most {MOST_RECORDS} together",
                counts(),
                self.lines
            )),
            Some(_) => {}
        }
        wrong
    }

    /// Errors of title and notice, by the rules of a scene, and of the hash without a measured file.
    fn errors_of_texts(&self) -> Vec<String> {
        let (title, notice) = (self.title.clone(), self.notice.clone());
        let texts = Scene { title, notice, ..self.scene.clone() };
        let is_text = |error: &&SceneError| ["title", "notice"].contains(&error.field.as_str());
        let mut wrong: Vec<String> =
            check(&texts).iter().filter(is_text).map(SceneError::to_string).collect();
        if self.measured_sha256.is_some() && self.scene.measured().is_none() {
            wrong.push(
                "measured_sha256: allowed with roughness: Measured; this scene has no such file".into(),
            );
        }
        wrong
    }

    /// Checks the scene of every cell.
    pub(super) fn check_cells(&self) -> Result<(), Vec<String>> {
        let (mut wrong, mut more) = (Vec::new(), 0_u64);
        for cell in self.loadings() {
            let checked = self.scene_of(cell).map(|scene| check(&scene).first().map(SceneError::to_string));
            let Some(reason) = checked.unwrap_or_else(Some) else { continue };
            if wrong.len() < MOST_NAMED {
                wrong.push(format!("cell {cell} ({}): {reason}", self.coordinates(cell)));
            } else {
                more += 1;
            }
        }
        if more > 0 {
            wrong.push(format!("and {more} more cells are not allowed"));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// The first of all cells that differ in the preload alone, for each combination of the other axes.
    pub(super) fn loadings(&self) -> impl Iterator<Item = u64> + use<> {
        let preloads = self.preloads().map_or(1, Axis::count);
        (0..self.cells()).step_by(preloads as usize)
    }
}
