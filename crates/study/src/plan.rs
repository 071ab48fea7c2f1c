//! The plan of a study: a scene, the axes along which its numbers vary, random profiles, and
//! recorded quantities.

use super::axis::Axis;
use super::error::ONE_PROFILE;
use super::place::scene_with;
use super::quantity::{Needs, Quantity};
use asperity_scene::text::ron_float;
use asperity_scene::{CheckedScene, Scene, SceneErrors};
use serde::{Deserialize, Serialize};

/// File name of the plan in the folder of a study.
pub(super) const PLAN_FILE: &str = "plan.ron";
pub(super) const PRELOAD: &str = "preload";

/// Largest number of random profiles of a [`Plan`] for each [cell](Plan).
pub const MOST_LINES: u64 = 1_000_000;
/// Largest number of records of a [`Plan`]. A record belongs to one [cell](Plan) and one random
/// profile.
pub const MOST_RECORDS: u64 = 100_000_000;
pub(super) const MOST_AXES: usize = 16;
/// Largest number of scenes in a plan up to which each scene is checked. In larger plans only the
/// scenes at the ends of all axes are checked.
pub(super) const MOST_CHECKED: u64 = 4096;
/// Largest number of cells with invalid scenes that an error message lists. Further cells are only
/// counted.
const MOST_NAMED: usize = 8;
const MOST_FORCES: u64 = 1000;

/// Groups of axes that determine the same quantity. A plan may have at most one axis of each group.
const SAME: [&[&str]; 3] = [
    &[PRELOAD, "preload_in_N"],
    &[
        "springs_per_wave",
        "roughness.modes.1",
        "roughness.wavelengths.1",
    ],
    &[
        "adhesion.work",
        "adhesion.kappa",
        "adhesion.elastic_energy_ratio",
    ],
];

/// Checked plan of a study: a scene, axes along which its numbers vary, random profiles, and
/// quantities to record. A *cell* is one combination of values on the axes. A *record* has the
/// recorded quantities of one cell on one random profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Title of the study in one line of text.
    pub title: String,
    /// Note for readers of the results, such as a limit of the study; may be empty.
    pub notice: String,
    /// Scene whose numbers vary. The paths of its measured files are absolute.
    pub scene: Scene,
    /// Axes of the study. The cells are numbered so that the value on the last axis changes
    /// fastest. An axis of preloads is always the last axis, and its preloads replace the loading
    /// of the scene.
    pub axes: Vec<Axis>,
    /// Number of random profiles for each [cell](Plan).
    pub lines: u64,
    /// Seed of the first random profile. The other profiles have the seeds that follow. All
    /// [cells](Plan) have the same seeds.
    pub seed: u64,
    /// Quantities that are recorded for each [cell](Plan) on each random profile.
    pub record: Vec<Quantity>,
    /// Range of forces at which the contact without adhesion is computed. It is used for
    /// [`Quantity::StiffnessExponent`] and [`Quantity::ForceExponent`].
    pub stiffness: StiffnessRange,
    /// SHA-256 of the content of the measured files as 64 hexadecimal digits. `None` for a scene
    /// without such files, and for a plan that is not in the [`Folder`](crate::Folder) of a study.
    pub measured_sha256: Option<String>,
}

/// Range of forces at which the contact without adhesion is computed for
/// [`Quantity::StiffnessExponent`] and [`Quantity::ForceExponent`]. The unit of force is E* h L,
/// with the effective modulus E*, the rms height h, and the length L of the profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StiffnessRange {
    /// Smallest force of the range, above zero. The unit is E* h L (effective modulus, rms height,
    /// length of the profile).
    pub from: f64,
    /// Largest force of the range. The unit is E* h L (effective modulus, rms height, length of the
    /// profile).
    pub to: f64,
    /// Number of forces in the range, at least 2. Neighbouring forces have equal ratios.
    pub count: u64,
}

impl Default for StiffnessRange {
    /// Returns 17 forces from 10⁻⁴ to 10⁻² in units of E* h L.
    fn default() -> Self {
        StiffnessRange {
            from: 1.0e-4,
            to: 1.0e-2,
            count: 17,
        }
    }
}

impl Plan {
    /// Largest number of [cells](Plan) of a plan.
    pub const MOST_CELLS: u64 = 10_000_000;

    /// Makes the plan of a checked scene without axes: one cell on `lines` profiles, whose seeds
    /// begin with the seed of the scene.
    pub(super) fn of_scene(scene: &Scene, lines: u64, record: &[Quantity]) -> Plan {
        Plan {
            title: String::new(),
            notice: String::new(),
            scene: scene.clone(),
            axes: Vec::new(),
            lines,
            seed: scene.seed().unwrap_or(0),
            record: record.to_vec(),
            stiffness: StiffnessRange::default(),
            measured_sha256: None,
        }
    }

    /// Returns the axis of the plan on which the preload varies; `None` if the plan has no such
    /// axis.
    pub fn preloads(&self) -> Option<&Axis> {
        self.axes.last().filter(|axis| axis.is_of_preloads())
    }

    /// Returns the axes of the plan without the axis of preloads, [`Plan::preloads`].
    pub fn scene_axes(&self) -> &[Axis] {
        &self.axes[..self.axes.len() - usize::from(self.preloads().is_some())]
    }

    /// Returns the number of [cells](Plan), which is the number of combinations of values on the
    /// axes.
    pub fn cells(&self) -> u64 {
        self.axes.iter().map(Axis::count).product()
    }

    /// Returns how many records the complete study has: one for each [cell](Plan) and each profile.
    pub fn records_in_all(&self) -> u64 {
        self.cells() * self.lines
    }

    pub(super) fn places(&self, cell: u64) -> Vec<usize> {
        self.places_on(0..self.axes.len(), cell)
    }

    /// Returns the index of the value on each axis of the plan for combination `number` of the
    /// values on `axes`. Of these axes the last one varies fastest. On all other axes the index is
    /// 0.
    pub(super) fn places_on(
        &self,
        axes: impl DoubleEndedIterator<Item = usize>,
        number: u64,
    ) -> Vec<usize> {
        let mut places = vec![0; self.axes.len()];
        let mut number = number;
        for axis in axes.rev() {
            let count = self.axes[axis].count();
            places[axis] = (number % count) as usize;
            number /= count;
        }
        places
    }

    pub(super) fn cell_at(&self, places: &[usize]) -> u64 {
        let mut cell = 0;
        for (place, axis) in places.iter().zip(&self.axes) {
            cell = cell * axis.count() + *place as u64;
        }
        cell
    }

    pub(super) fn value(&self, cell: u64, axis: usize) -> f64 {
        let faster: u64 = self.axes[axis + 1..].iter().map(Axis::count).product();
        self.axes[axis].values[(cell / faster % self.axes[axis].count()) as usize]
    }

    /// Returns the values on all axes in [cell](Plan) number `cell`, in the order of the axes.
    pub fn values(&self, cell: u64) -> Vec<f64> {
        (0..self.axes.len())
            .map(|axis| self.value(cell, axis))
            .collect()
    }

    /// Returns the values on all axes in [cell](Plan) number `cell` as text, such as
    /// `adhesion.kappa = 6.0`.
    pub fn coordinates(&self, cell: u64) -> String {
        if self.axes.is_empty() {
            return "the scene itself".to_owned();
        }
        let mut coordinates = Vec::with_capacity(self.axes.len());
        for (axis, value) in self.axes.iter().zip(self.values(cell)) {
            coordinates.push(format!("{} = {}", axis.path, ron_float(value)));
        }
        coordinates.join(", ")
    }

    /// Returns the scene of [cell](Plan) number `cell`, in which the quantities of the axes have
    /// the values of this cell. A preload of the cell is not set: the returned scene still has the
    /// loading of the scene of the plan. The preload replaces this loading when the cell is
    /// computed.
    ///
    /// # Errors
    /// Returns an error if the scene lacks the quantity of an axis, or if a value is out of its
    /// range.
    pub fn scene_of(&self, cell: u64) -> Result<CheckedScene, SceneErrors> {
        scene_with(&self.scene, self.axes.iter().zip(self.values(cell)))?.checked()
    }

    /// Returns the seed of the random profile with the index `line`, which begins at 0.
    pub fn seed_of(&self, line: u64) -> u64 {
        self.seed.wrapping_add(line)
    }

    /// Returns the index of a quantity in [`Plan::record`]; `None` if the quantity is not recorded.
    pub fn column(&self, quantity: Quantity) -> Option<usize> {
        self.record.iter().position(|known| *known == quantity)
    }

    pub(super) fn records(&self, needs: Needs) -> bool {
        self.record.iter().any(|quantity| quantity.needs() == needs)
    }
}

/// Checks of a plan. The scenes of its cells are checked when a study begins, but not again when
/// the folder of the study is opened.
impl Plan {
    pub(super) fn errors(&self) -> Vec<String> {
        let mut wrong = self.errors_of_texts();
        wrong.extend(self.errors_of_paths());
        wrong.extend(self.errors_of_profiles());
        wrong.extend(self.errors_of_record());
        wrong.extend(self.errors_of_forces());
        wrong.extend(self.error_of_size());
        wrong
    }

    fn errors_of_paths(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        let paths: Vec<&str> = self.axes.iter().map(|axis| axis.path.as_str()).collect();
        for (index, path) in paths.iter().enumerate() {
            let before = &paths[..index];
            if before.contains(path) {
                wrong.push(format!("axis {path}: given twice"));
            }
            let Some(same) = SAME.iter().find(|same| same.contains(path)) else {
                continue;
            };
            let twin = before
                .iter()
                .find(|other| same.contains(other) && *other != path);
            if let Some(twin) = twin {
                wrong.push(format!(
                    "axis {path}: {twin} sets it as well; allowed: one of them"
                ));
            }
        }
        wrong
    }

    fn errors_of_profiles(&self) -> Vec<String> {
        let lines = self.lines;
        let mut wrong = Vec::new();
        if !(1..=MOST_LINES).contains(&lines) {
            wrong.push(format!(
                "profiles = {lines}: allowed: from 1 to {MOST_LINES}"
            ));
        }
        if lines > 1 && self.scene.seed().is_none() {
            let (found, allowed) = ONE_PROFILE;
            wrong.push(format!("profiles = {lines}: {found}; allowed: {allowed}"));
        }
        wrong
    }

    fn errors_of_record(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        if self.record.is_empty() {
            wrong.push("record = []: allowed: at least one quantity".into());
        }
        for (index, quantity) in self.record.iter().enumerate() {
            if self.record[..index].contains(quantity) {
                wrong.push(format!("record: {} is given twice", quantity.name()));
            }
        }
        wrong
    }

    /// Returns the errors of the preloads, and of the forces at which the exponents of the
    /// stiffness are computed.
    fn errors_of_forces(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        let preloads = self.axes.iter().find(|axis| axis.is_of_preloads());
        let pull = preloads.and_then(|axis| axis.values.iter().find(|preload| **preload <= 0.0));
        if let Some(value) = pull {
            wrong.push(format!("preload {value:?}: allowed: above 0"));
        }
        let StiffnessRange { from, to, count } = self.stiffness;
        if !(from > 0.0 && from < to && to.is_finite() && (2..=MOST_FORCES).contains(&count)) {
            wrong.push(format!(
                "stiffness = (from: {from:?}, to: {to:?}, count: {count}): allowed: 0 < from < to, count from 2 \
                 to {MOST_FORCES}"
            ));
        }
        let by_roughness =
            preloads.is_some_and(|axis| axis.unit != "N") || self.records(Needs::Stiffness);
        if self.scene.roughness.is_none() && by_roughness {
            wrong.push(
                "preloads and exponents count forces in units of E* h L, and this scene is smooth; \
                 allowed: an axis preload_in_N"
                    .into(),
            );
        }
        wrong
    }

    /// Returns the error of a plan with too many cells or records.
    fn error_of_size(&self) -> Option<String> {
        let cells = self
            .axes
            .iter()
            .map(Axis::count)
            .try_fold(1_u64, u64::checked_mul);
        let cells = cells.filter(|cells| *cells <= Plan::MOST_CELLS);
        if cells.is_some_and(|cells| cells.saturating_mul(self.lines) <= MOST_RECORDS) {
            return None;
        }
        let counts: Vec<String> = self
            .axes
            .iter()
            .map(|axis| axis.count().to_string())
            .collect();
        let counts = counts.join(" × ");
        Some(match cells {
            None => format!("{counts} cells; allowed: at most {}", Plan::MOST_CELLS),
            Some(_) => format!(
                "{counts} cells on {} profiles; allowed: at most {MOST_RECORDS} together",
                self.lines
            ),
        })
    }

    /// Returns the errors of the title and the notice, which follow the same rules as those of a
    /// scene. Also returns an error if a plan without a measured file has a hash.
    fn errors_of_texts(&self) -> Vec<String> {
        let texts = Scene {
            title: self.title.clone(),
            notice: self.notice.clone(),
            ..self.scene.clone()
        };
        let mut wrong = Vec::new();
        if let Err(errors) = texts.checked() {
            for error in errors.iter() {
                if ["title", "notice"].contains(&error.field.as_str()) {
                    wrong.push(error.to_string());
                }
            }
        }
        if self.measured_sha256.is_some() && self.scene.measured_files().is_empty() {
            wrong.push(
                "measured_sha256: allowed with roughness: Measured and form: Table; this scene has no such file".into(),
            );
        }
        wrong
    }

    /// Checks the scenes of the cells that [`Plan::extremes`] chooses.
    pub(super) fn check_cells(&self) -> Result<(), Vec<String>> {
        let mut wrong = Vec::new();
        let mut more = 0;
        for cell in self.extremes(MOST_CHECKED) {
            let Err(errors) = self.scene_of(cell) else {
                continue;
            };
            if wrong.len() < MOST_NAMED {
                wrong.push(format!(
                    "cell {cell} ({}): {}",
                    self.coordinates(cell),
                    errors.first()
                ));
            } else {
                more += 1;
            }
        }
        if more > 0 {
            wrong.push(format!("and {more} more cells are not allowed"));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Returns cells that represent all cells of the plan. If the scenes of these cells are
    /// allowed, the scenes of all cells are allowed; and one of these cells needs the most memory.
    /// The preload affects neither, so only the first cell of each combination of the other values
    /// is returned. If there are more than `most` combinations, only the cells at the ends of all
    /// axes are returned. This suffices because a condition on a number of a scene is always a
    /// lower or an upper bound: if it holds at two values, it holds between them.
    pub(super) fn extremes(&self, most: u64) -> Vec<u64> {
        let preloads = self.preloads().map_or(1, Axis::count);
        if self.cells() / preloads <= most {
            return (0..self.cells()).step_by(preloads as usize).collect();
        }
        let mut cells = vec![Vec::new()];
        for axis in self.scene_axes() {
            let order = axis.order();
            let mut ends = vec![order[0], order[order.len() - 1]];
            ends.dedup();
            let mut longer = Vec::with_capacity(cells.len() * ends.len());
            for cell in &cells {
                for end in &ends {
                    longer.push([&cell[..], &[*end]].concat());
                }
            }
            cells = longer;
        }
        let mut numbers = Vec::with_capacity(cells.len());
        for mut cell in cells {
            cell.resize(self.axes.len(), 0);
            numbers.push(self.cell_at(&cell));
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Spacing;
    use crate::place::numbers;
    use asperity_scene::{open, presets};

    #[test]
    fn scenes_between_allowed_ends_are_allowed() {
        let mut allowed = [0, 0];
        for preset in presets() {
            let document = open(preset.name).unwrap();
            let scene = document.scene();
            let paths = [
                "numerics.points",
                "springs_per_wave",
                "adhesion.kappa",
                "roughness.modes.1",
            ];
            let more = paths.iter().filter_map(|path| {
                let axis = Axis::new(path, Spacing::List, Vec::new(), scene).ok()?;
                Some((axis.clone(), axis.value_in(scene, None)?))
            });
            let axes: Vec<Axis> = numbers(scene)
                .into_iter()
                .chain(more)
                .map(|(axis, value)| {
                    let near = [0.03, 0.3, 0.9, 1.0, 1.1, 3.0, 30.0].map(|factor| factor * value);
                    let values = near
                        .map(|value| {
                            if axis.is_whole() {
                                value.round()
                            } else {
                                value
                            }
                        })
                        .to_vec();
                    Axis { values, ..axis }
                })
                .collect();
            for (index, first) in axes.iter().enumerate() {
                for second in &axes[..index] {
                    // First both axes have all their seven values, and then fewer values around the
                    // values of the scene.
                    for range in [0..7, 1..6, 2..5] {
                        let part = |axis: &Axis| Axis {
                            values: axis.values[range.clone()].to_vec(),
                            ..axis.clone()
                        };
                        let axes = vec![part(first), part(second)];
                        let plan = Plan {
                            axes,
                            ..Plan::of_scene(scene, 1, &[Quantity::Regime])
                        };
                        let is_allowed = |cell| plan.scene_of(cell).is_ok();
                        let ends = plan.extremes(0);
                        assert_eq!(ends.len(), 4);
                        let is_met = ends.into_iter().all(is_allowed);
                        allowed[usize::from(is_met)] += 1;
                        assert_eq!(
                            is_met,
                            (0..plan.cells()).all(is_allowed),
                            "{}: {:?}",
                            preset.name,
                            plan.axes
                        );
                    }
                }
            }
        }
        assert!(allowed[0] > 100 && allowed[1] > 100, "{allowed:?}");
    }
}
