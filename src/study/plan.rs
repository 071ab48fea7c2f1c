//! The plan of a study: a scene, the axes along which numbers of the scene vary, profiles, and recorded quantities.

use super::axis::Axis;
use super::numbering::places_of;
use super::quantity::{Needs, Quantity};
use super::target::Target;
use crate::scene::{Scene, ron_float};
use serde::{Deserialize, Serialize};

/// File name of the plan in the folder of a study.
pub(super) const PLAN_FILE: &str = "plan.ron";

/// A checked plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Title of the study, one line.
    pub title: String,
    /// Notice for the reader of the results.
    pub notice: String,
    /// The scene whose numbers vary; its files have absolute paths.
    pub scene: Scene,
    /// Axes without the preload, the last one fastest.
    pub axes: Vec<Axis>,
    /// Preloads in units of E* h L, the fastest axis; `None`: the loading of the scene.
    pub preloads: Option<Axis>,
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
            preloads: None,
            lines,
            seed: scene.seed().unwrap_or(0),
            record: record.to_vec(),
            stiffness: StiffnessRange::default(),
            measured_sha256: None,
        }
    }

    /// The scene without the texts, which no cell needs.
    pub(super) fn prototype(&self) -> Scene {
        Scene { title: String::new(), notice: String::new(), observe: Vec::new(), ..self.scene.clone() }
    }

    /// All axes, the preload's last if there are preloads.
    #[must_use]
    pub fn all_axes(&self) -> Vec<&Axis> {
        self.axes.iter().chain(&self.preloads).collect()
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.all_axes().into_iter().map(Axis::count).product()
    }

    /// Number of records: cells times profiles.
    #[must_use]
    pub fn records_in_all(&self) -> u64 {
        self.cells() * self.lines
    }

    /// Values of the axes in a cell, then its preload if there is one.
    #[must_use]
    pub fn values(&self, cell: u64) -> Vec<f64> {
        let axes = self.all_axes();
        let places = places_of(cell, axes.iter().map(|axis| axis.count()));
        axes.iter().zip(places).map(|(axis, place)| axis.value(place)).collect()
    }

    /// Coordinates of a cell for readers.
    #[must_use]
    pub fn coordinates(&self, cell: u64) -> String {
        let one = |(axis, value): (&Axis, f64)| format!("{} = {}", axis.path(), ron_float(value));
        let all: Vec<_> = self.all_axes().into_iter().zip(self.values(cell)).map(one).collect();
        if all.is_empty() { "the scene itself".into() } else { all.join(", ") }
    }

    /// Seed of a profile.
    #[must_use]
    pub fn seed_of(&self, line: u64) -> u64 {
        self.seed.wrapping_add(line)
    }

    pub(super) fn records(&self, needs: Needs) -> bool {
        self.record.iter().any(|quantity| quantity.needs() == needs)
    }
}

/// Quantities that the axes of a plan vary.
pub(super) fn targets(plan: &Plan) -> Vec<Target> {
    plan.axes.iter().filter_map(|axis| Target::of(axis.path()).ok()).collect()
}
