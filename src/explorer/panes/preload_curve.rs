//! Adhesion against preload of the scene: the adhesion force of its own profile for many preloads, then the mean over
//! random profiles, coarser in the preload.

use crate::analysis::Figures;
use crate::explorer::snapshot::SolvedScene;
use crate::scene::{Scene, Solver};
use crate::simulation::{RunError, Simulation};
use crate::study::{Preloaded, Preloads, Statistics, preload_statistics, solve_preloads};

/// Number of preloads on the profile of the scene, and step between those on random profiles.
const FINE: usize = 257;
const EVERY: usize = 8;
/// Random profiles of the mean.
pub const PROFILES: usize = 16;
/// Results of the profile of the scene after which the curve is shown anew.
const SHOWN_EVERY: usize = 32;
/// Largest preload in preloads of the scene.
const REACH: f64 = 2.0;

/// Adhesion forces of a scene for many preloads, as far as computed.
#[derive(Clone, Debug, PartialEq)]
pub struct PreloadCurve {
    forces: Vec<f64>,
    /// Results of the profile of the scene, from the smallest preload on.
    pub own: Vec<Preloaded>,
    /// Results of random profiles, that of the scene the first.
    pub profiles: Vec<Vec<Preloaded>>,
    /// Statistics over these profiles at each of their preloads.
    pub statistics: Vec<Option<Statistics>>,
    /// Number of requested profiles.
    pub wanted: usize,
}

impl PreloadCurve {
    /// The curve of a computed scene, still empty.
    ///
    /// # Errors
    /// The reason why the scene has no such curve.
    pub fn new(computed: &SolvedScene) -> Result<Self, &'static str> {
        if computed.scene.numerics.solver != Solver::Exact {
            return Err("many preloads at once need the exact solver");
        }
        if computed.scene.adhesion.is_none() {
            return Err("without adhesion nothing holds the bodies together");
        }
        let Figures { preload, adhesion_force, .. } = computed.outcome.figures;
        let scale = preload.filter(|&force| force > 0.0).or(adhesion_force).filter(|&force| force > 0.0);
        let preloads = scale.and_then(|scale| Preloads::new(0.0, REACH * scale, FINE));
        let forces = preloads.ok_or("no stage presses the bodies together")?.forces();
        let wanted = if computed.scene.seed().is_some() { PROFILES } else { 0 };
        let (own, profiles, statistics) = (Vec::new(), Vec::new(), Vec::new());
        Ok(PreloadCurve { forces, own, profiles, statistics, wanted })
    }

    /// Returns true once all profiles are computed.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.own.len() == self.forces.len() && self.profiles.len() >= self.wanted
    }

    /// The results at the preloads of the statistics.
    #[must_use]
    pub fn coarse(&self) -> &[Preloaded] {
        self.profiles.first().map_or(&[], Vec::as_slice)
    }

    /// Computes the missing part for the scene, its own profile first. `report` receives the curve after each addition.
    ///
    /// # Errors
    /// When a profile or its contact fails, or `stop` interrupts.
    pub fn compute(
        &mut self,
        scene: &Scene,
        simulation: &mut Simulation,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&PreloadCurve),
    ) -> Result<(), RunError> {
        if self.own.len() < self.forces.len() {
            let forces = self.forces.clone();
            self.own.clear();
            solve_preloads(simulation, scene, &forces, stop, &mut |one| {
                self.own.push(one);
                if self.own.len().is_multiple_of(SHOWN_EVERY) {
                    report(self);
                }
            })?;
        }
        let mut scene = scene.clone();
        let first = scene.seed().unwrap_or(0);
        let coarse: Vec<f64> = self.forces.iter().copied().step_by(EVERY).collect();
        while self.profiles.len() < self.wanted {
            let mut found = Vec::with_capacity(coarse.len());
            if self.profiles.is_empty() {
                found.extend(self.own.iter().copied().step_by(EVERY));
            } else {
                scene.set_seed(first.wrapping_add(self.profiles.len() as u64));
                solve_preloads(simulation, &scene, &coarse, stop, &mut |one| found.push(one))?;
            }
            self.profiles.push(found);
            self.statistics = preload_statistics(&self.profiles);
            report(self);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Move, open};
    use std::cell::Cell;
    use std::sync::Arc;

    fn computed(name: &str) -> SolvedScene {
        let mut scene = open(name).unwrap().scene().clone();
        scene.numerics.points = 2048;
        let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        SolvedScene { generation: 1, scene: Arc::new(scene), outcome }
    }

    #[test]
    fn the_curve_grows_and_goes_on_where_it_was_stopped() {
        let computed = computed("pressure-sensitive");
        let mut curve = PreloadCurve::new(&computed).unwrap();
        let reported = Cell::new(0);
        let stop = || reported.get() >= 12;
        let mut sizes = Vec::new();
        let done = curve.compute(&computed.scene, &mut Simulation::default(), &stop, &mut |curve| {
            reported.set(reported.get() + 1);
            sizes.push((curve.own.len(), curve.profiles.len()));
        });
        assert!(done.unwrap_err().is_interruption());
        assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
        assert!(!curve.is_whole() && curve.own.len() == FINE && curve.profiles.len() > 1);
        curve.compute(&computed.scene, &mut Simulation::default(), &|| false, &mut |_| ()).unwrap();
        assert!(curve.is_whole() && curve.profiles.len() == PROFILES);
        assert_eq!(curve.coarse().len(), curve.statistics.len());
        let means: Vec<f64> = curve.statistics.iter().map(|one| one.unwrap().mean).collect();
        assert!(means.windows(2).all(|pair| pair[0] <= pair[1]) && means[0] < 0.2 * means[32], "{means:?}");
        // In the middle is the preload of the scene.
        let preload = computed.outcome.figures.preload.unwrap();
        assert!((curve.own[FINE / 2].preload / preload - 1.0).abs() < 1e-12);
        let force = computed.outcome.figures.adhesion_force.unwrap();
        assert!((curve.own[FINE / 2].adhesion_force.unwrap() / force - 1.0).abs() < 1e-9);
    }

    #[test]
    fn scenes_without_preload_or_exact_solver_have_no_curve() {
        let mut one = computed("jkr-sphere");
        assert_eq!(PreloadCurve::new(&one).unwrap().wanted, 0);
        let mut scene = Scene::clone(&one.scene);
        scene.numerics.solver = Solver::Stepwise { step: 1e-9 };
        one.scene = Arc::new(scene.clone());
        assert!(PreloadCurve::new(&one).unwrap_err().contains("exact solver"));
        scene.numerics.solver = Solver::Exact;
        scene.loading = vec![Move::ToIndentation(-1e-9)];
        one.outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        one.scene = Arc::new(scene.clone());
        assert!(PreloadCurve::new(&one).unwrap_err().contains("presses"));
        scene.adhesion = None;
        one.scene = Arc::new(scene);
        assert!(PreloadCurve::new(&one).unwrap_err().contains("adhesion"));
    }
}
