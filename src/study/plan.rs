//! The plan of a study: a scene, the axes along which numbers of the scene vary, profiles, and recorded quantities.

use super::axis::Axis;
use super::numbering::places_of;
use super::quantity::{Needs, Quantity};
use super::target::Target;
use crate::scene::{Scene, ron_float};
use serde::{Deserialize, Serialize};

/// Name of the plan's file in the folder of a study.
pub(super) const PLAN_FILE: &str = "plan.ron";

/// A checked plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// One line naming the study.
    pub title: String,
    /// Notice for the reader of the results.
    pub notice: String,
    /// The scene in which numbers are varied. Files it names are named from the root.
    pub scene: Scene,
    /// Axes, the last fastest; without the preload.
    pub axes: Vec<Axis>,
    /// Preloads in units of E* h L, the fastest axis of all; none: the loading of the scene.
    pub preloads: Option<Axis>,
    /// Random lines of each cell.
    pub lines: u64,
    /// Seed of the first line; those that follow have the next, the same in all cells.
    pub seed: u64,
    /// Recorded quantities.
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

impl Plan {
    /// The plan of a checked scene without axes: one cell on so many profiles, from the seed of the scene on.
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

    /// The scene without the texts that no cell needs.
    pub(super) fn prototype(&self) -> Scene {
        Scene { title: String::new(), notice: String::new(), observe: Vec::new(), ..self.scene.clone() }
    }

    /// All axes, the preload's last where there are preloads.
    #[must_use]
    pub fn all_axes(&self) -> Vec<&Axis> {
        self.axes.iter().chain(&self.preloads).collect()
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.all_axes().into_iter().map(Axis::count).product()
    }

    /// Number of records: cells times lines.
    #[must_use]
    pub fn records_in_all(&self) -> u64 {
        self.cells() * self.lines
    }

    /// Values of the axes in a cell, and after them its preload where there is one.
    #[must_use]
    pub fn values(&self, cell: u64) -> Vec<f64> {
        let axes = self.all_axes();
        let places = places_of(cell, axes.iter().map(|axis| axis.count()));
        axes.iter().zip(places).map(|(axis, place)| axis.value(place)).collect()
    }

    /// A cell's coordinates as people read them.
    #[must_use]
    pub fn coordinates(&self, cell: u64) -> String {
        let one = |(axis, value): (&Axis, f64)| format!("{} = {}", axis.path(), ron_float(value));
        let all: Vec<_> = self.all_axes().into_iter().zip(self.values(cell)).map(one).collect();
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
}

/// Quantities that the axes of a plan vary.
pub(super) fn targets(plan: &Plan) -> Vec<Target> {
    plan.axes.iter().filter_map(|axis| Target::of(axis.path()).ok()).collect()
}
