//! Adhesion against preload: a study in memory over preloads in N, in place of the unit of a plan.

use super::axis::Target;
use super::axis::{Axis, Spacing};
use super::plan::PRELOAD;
use super::quantity::Quantity;
use super::results::Results;
use super::statistics::Statistics;
use std::ops::RangeInclusive;

/// Numbers of preloads.
pub const PRELOADS: RangeInclusive<usize> = 2..=512;

impl Axis {
    /// Equally spaced preloads between two forces, N, the first at least 0 and below the second; `None` for other forces,
    /// or a number outside [`PRELOADS`].
    pub fn of_preloads(from: f64, to: f64, count: usize) -> Option<Axis> {
        let is_allowed = from >= 0.0 && to > from && to.is_finite() && PRELOADS.contains(&count);
        let last = count.saturating_sub(1) as f64;
        let at = |index: usize| (from + (to - from) * (index as f64 / last)).min(to);
        is_allowed.then(|| Axis {
            path: PRELOAD.into(),
            name: "preload".into(),
            symbol: "F_n",
            unit: "N",
            spacing: Spacing::Linear,
            values: (0..count).map(at).collect(),
            target: Target::Preload,
        })
    }
}

impl Results {
    /// Recorded quantities of adhesion against preload.
    pub const OF_PRELOADS: [Quantity; 4] = [
        Quantity::PreloadIndentation,
        Quantity::AdhesionForce,
        Quantity::PullOffIndentation,
        Quantity::DissipatedEnergy,
    ];

    /// Adhesion force of a profile at each preload, N; one without a tensile force counts as 0 N.
    pub fn adhesion_forces(&self, line: u64) -> Vec<(f64, f64)> {
        let at = |cell| (self.plan.value(cell, 0), self.adhesion_force(cell, line));
        (0..self.plan.cells()).map(at).collect()
    }

    fn adhesion_force(&self, cell: u64, line: u64) -> f64 {
        self.value(cell, line, Quantity::AdhesionForce).unwrap_or(0.0)
    }

    /// The adhesion force over the computed profiles at each preload, N, where there are two at least. A profile without a
    /// tensile force counts as 0 N, so that the mean is the mean adhesion force.
    pub fn mean_adhesion_forces(&self) -> Vec<(f64, Statistics)> {
        let mean = |cell| {
            let forces = self.records_of(cell).map(|(line, _)| self.adhesion_force(cell, line)).collect();
            let all = Statistics::of(forces, Quantity::AdhesionForce.bounds())?;
            all.spread.map(|_| (self.plan.value(cell, 0), all))
        };
        (0..self.plan.cells()).filter_map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan::ONE_PROFILE;
    use super::*;
    use crate::scene::{Document, Move, open};
    use crate::simulation::Simulation;

    fn solved(document: &Document, preloads: &Axis, lines: u64, jobs: usize) -> Result<Results, String> {
        let (scene, folder) = (document.scene(), document.resolve(""));
        let results = Results::of_scene(scene, &folder, &Results::OF_PRELOADS, lines, Some(preloads), jobs);
        results.map_err(|error| error.to_string())
    }

    #[test]
    fn adhesion_grows_with_the_preload_over_sixteen_profiles() {
        let document = open("pressure-sensitive").unwrap();
        let preloads = Axis::of_preloads(0.0, 2e-5, 9).unwrap();
        assert_eq!((preloads.values[0], preloads.values[8], preloads.values.len()), (0.0, 2e-5, 9));
        let results = solved(&document, &preloads, 16, 2).unwrap();
        // One profile is the scene itself, loaded to one of the forces.
        let mut scene = document.scene().clone();
        scene.set_seed(results.plan().seed_of(3));
        scene.loading = vec![Move::ToForce(preloads.values[4]), Move::ToSeparation];
        let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        let found = |quantity| results.value(4, 3, quantity);
        assert_eq!(found(Quantity::AdhesionForce), outcome.figures.adhesion_force);
        assert_eq!(found(Quantity::DissipatedEnergy), outcome.figures.dissipated_energy);
        for line in 0..16 {
            let curve = results.adhesion_forces(line);
            assert!(curve.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{curve:?}");
        }
        let means: Vec<f64> = results.mean_adhesion_forces().iter().map(|(_, one)| one.mean).collect();
        assert!(means.windows(2).all(|pair| pair[0] < pair[1]), "{means:?}");
        // Twice the preload about doubles the mean.
        assert!(means[8] > 1.5 * means[4] && means[4] > 1.5 * means[2], "{means:?}");
        assert!(means[0] < 0.1 * means[8], "{means:?}");
        assert_eq!(solved(&document, &preloads, 16, 1), Ok(results));
    }

    #[test]
    fn smooth_bodies_have_but_one_profile() {
        let (smooth, preloads) = (open("jkr-sphere").unwrap(), Axis::of_preloads(0.0, 1e-6, 2).unwrap());
        assert_eq!(solved(&smooth, &preloads, 2, 1), Err(ONE_PROFILE.into()));
        let one = solved(&smooth, &preloads, 1, 1).unwrap();
        assert_eq!((one.adhesion_forces(0).len(), one.mean_adhesion_forces()), (2, Vec::new()));
        let stepwise = smooth.set("numerics.solver", "Stepwise(step: 1e-9)").unwrap();
        let error = solved(&stepwise, &preloads, 1, 1).unwrap_err();
        assert!(error.starts_with("numerics.solver = Stepwise: reversals need the exact solver"), "{error}");
    }
}
