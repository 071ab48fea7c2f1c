//! The plan of a study: a scene, the axes along which numbers of the scene vary, profiles, and recorded quantities.

use super::axis::Axis;
use super::quantity::{Needs, Quantity};
use super::target::scene_with;
use crate::scene::{Scene, ron_float};
use serde::{Deserialize, Serialize};

/// File name of the plan in the folder of a study.
pub(super) const PLAN_FILE: &str = "plan.ron";
/// Path of the axis of preloads.
pub(super) const PRELOAD: &str = "preload";

/// Reason why a scene has a single profile.
pub(super) const ONE_PROFILE: &str = "more than one profile needs random roughness (SelfAffine, or an equivalent \
                                      line); the profile of this scene is fixed";

/// A checked plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Title of the study, one line.
    pub title: String,
    /// Notice for the reader of the results.
    pub notice: String,
    /// The scene whose numbers vary; its files have absolute paths.
    pub scene: Scene,
    /// Axes, the last one fastest. That of preloads, in units of E* h L, is the last; without preloads the loading is
    /// that of the scene.
    pub axes: Vec<Axis>,
    /// Random profiles of each cell.
    pub lines: u64,
    /// Seed of the first profile; the next ones follow consecutively, the same in all cells.
    pub seed: u64,
    /// Recorded quantities.
    pub record: Vec<Quantity>,
    /// Forces between which the exponents are fitted.
    pub stiffness: StiffnessRange,
    /// SHA-256 of the content of the measured file, 64 hexadecimal digits; set in the folder of a study.
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
    /// Number of forces at equal ratios, at least 2.
    pub count: u64,
}

impl Default for StiffnessRange {
    /// Between the forces carried by a few waves and those that flatten the long waves.
    fn default() -> Self {
        StiffnessRange { from: 1.0e-4, to: 1.0e-2, count: 17 }
    }
}

impl Plan {
    /// The plan of a checked scene without axes: one cell on so many profiles, starting at the seed of the scene.
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

    /// The axis of preloads.
    pub fn preloads(&self) -> Option<&Axis> {
        self.axes.last().filter(|axis| axis.path == PRELOAD)
    }

    /// The axes of numbers of the scene: all but that of preloads.
    pub fn scene_axes(&self) -> &[Axis] {
        &self.axes[..self.axes.len() - usize::from(self.preloads().is_some())]
    }

    /// Number of cells.
    pub fn cells(&self) -> u64 {
        self.axes.iter().map(Axis::count).product()
    }

    /// Number of records: cells times profiles.
    pub fn records_in_all(&self) -> u64 {
        self.cells() * self.lines
    }

    /// Places of a cell on the axes.
    pub(super) fn places(&self, cell: u64) -> Vec<usize> {
        self.places_on(0..self.axes.len(), cell)
    }

    /// Places of a number among all combinations of values of these axes, the last one fastest; 0 on the other axes.
    pub(super) fn places_on(&self, axes: impl DoubleEndedIterator<Item = usize>, number: u64) -> Vec<usize> {
        let (mut rest, mut places) = (number, vec![0; self.axes.len()]);
        for axis in axes.rev() {
            let count = self.axes[axis].count();
            places[axis] = (rest % count) as usize;
            rest /= count;
        }
        places
    }

    /// Number of the cell at places on the axes.
    pub(super) fn cell_at(&self, places: &[usize]) -> u64 {
        places.iter().zip(&self.axes).fold(0, |cell, (place, axis)| cell * axis.count() + *place as u64)
    }

    /// Value of an axis, by its number, in a cell.
    pub(super) fn value(&self, cell: u64, axis: usize) -> f64 {
        let faster: u64 = self.axes[axis + 1..].iter().map(Axis::count).product();
        self.axes[axis].values[(cell / faster % self.axes[axis].count()) as usize]
    }

    /// Values of the axes in a cell.
    pub fn values(&self, cell: u64) -> Vec<f64> {
        (0..self.axes.len()).map(|axis| self.value(cell, axis)).collect()
    }

    /// Coordinates of a cell for readers.
    pub fn coordinates(&self, cell: u64) -> String {
        let one = |(axis, value): (&Axis, f64)| format!("{} = {}", axis.path, ron_float(value));
        let all: Vec<_> = self.axes.iter().zip(self.values(cell)).map(one).collect();
        if all.is_empty() { "the scene itself".into() } else { all.join(", ") }
    }

    /// The scene of a cell; its loading is that of the plan's scene, whatever the preload.
    ///
    /// # Errors
    /// The path of an axis over a number that the scene does not have.
    pub fn scene_of(&self, cell: u64) -> Result<Scene, String> {
        scene_with(&self.scene, self.axes.iter().zip(self.values(cell)))
    }

    /// Seed of a profile.
    pub fn seed_of(&self, line: u64) -> u64 {
        self.seed.wrapping_add(line)
    }

    /// Place of a quantity among the recorded ones.
    pub fn column(&self, quantity: Quantity) -> Option<usize> {
        self.record.iter().position(|one| *one == quantity)
    }

    pub(super) fn records(&self, needs: Needs) -> bool {
        self.record.iter().any(|quantity| quantity.needs() == needs)
    }
}
