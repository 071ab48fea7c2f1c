//! Adhesion against preload of the scene: the adhesion force of its own profile for many preloads, then the mean over
//! random profiles, coarser in the preload.

use crate::analysis::Figures;
use crate::explorer::snapshot::SolvedScene;
use crate::scene::Solver;
use crate::simulation::{RunError, Simulation};
use crate::study::{Axis, Results};

/// Number of preloads on the profile of the scene, and step between those on random profiles.
const FINE: usize = 257;
const EVERY: usize = 8;
pub const PROFILES: usize = 16;
/// Largest preload in preloads of the scene.
const REACH: f64 = 2.0;

/// Adhesion forces of a scene for many preloads, as far as computed.
#[derive(Clone, Debug, PartialEq)]
pub struct PreloadCurve {
    pub own: Results,
    /// Random profiles at some of the preloads, that of the scene the first; `None` for a scene with one profile.
    pub random: Option<Results>,
}

impl PreloadCurve {
    /// The curve of a computed scene, still empty.
    pub fn new(computed: &SolvedScene) -> Result<Self, &'static str> {
        if computed.scene.numerics.solver != Solver::Exact {
            return Err("many preloads at once need the exact solver");
        }
        if computed.scene.adhesion.is_none() {
            return Err("without adhesion nothing holds the bodies together");
        }
        let Figures { preload, adhesion_force, .. } = computed.outcome.figures;
        let scale = preload.filter(|&force| force > 0.0).or(adhesion_force).filter(|&force| force > 0.0);
        let fine = scale.and_then(|scale| Axis::of_preloads(0.0, REACH * scale, FINE));
        let fine = fine.ok_or("no stage presses the bodies together")?;
        let mut coarse = fine.clone();
        coarse.values = coarse.values.into_iter().step_by(EVERY).collect();
        let begin = |lines: usize, preloads: &Axis| {
            let results =
                Results::begin(&computed.scene, &Results::OF_PRELOADS, lines as u64, Some(preloads));
            results.map_err(|_| "there is not enough memory for the curve")
        };
        let random = computed.scene.seed().map(|_| begin(PROFILES, &coarse)).transpose()?;
        Ok(PreloadCurve { own: begin(1, &fine)?, random })
    }

    pub fn is_whole(&self) -> bool {
        self.own.is_whole(0) && self.random.as_ref().is_none_or(|random| random.is_whole(0))
    }

    pub fn profiles(&self) -> usize {
        self.random.as_ref().map_or(0, |random| random.records_of(0).count())
    }

    /// Computes the missing part, the profile of the scene first. `report` receives the curve after each addition.
    pub fn compute(
        &mut self,
        simulation: &mut Simulation,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&PreloadCurve),
    ) -> Result<(), RunError> {
        if !self.own.is_whole(0) {
            self.own.extend(simulation, stop, &mut |_| ())?;
            report(self);
        }
        let Some(mut random) = self.random.take() else { return Ok(()) };
        let done = random.extend(simulation, stop, &mut |random| {
            report(&PreloadCurve { own: self.own.clone(), random: Some(random.clone()) });
        });
        self.random = Some(random);
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Move, Scene, open};
    use std::cell::Cell;
    use std::sync::Arc;

    fn computed(name: &str) -> SolvedScene {
        let mut scene = open(name).unwrap().scene().clone();
        scene.numerics.points = 2048;
        let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        SolvedScene { generation: 1, scene: Arc::new(scene), outcome, full_contact: 0.0 }
    }

    #[test]
    fn the_curve_grows_and_goes_on_where_it_was_stopped() {
        let computed = computed("pressure-sensitive");
        let mut curve = PreloadCurve::new(&computed).unwrap();
        let reported = Cell::new(0);
        let stop = || reported.get() >= 4;
        let mut sizes = Vec::new();
        let done = curve.compute(&mut Simulation::default(), &stop, &mut |curve| {
            reported.set(reported.get() + 1);
            sizes.push(curve.profiles());
        });
        assert!(done.unwrap_err().is_interruption());
        assert_eq!((sizes, curve.profiles(), curve.own.is_whole(0)), (vec![0, 1, 2, 3], 3, true));
        curve.compute(&mut Simulation::default(), &|| false, &mut |_| ()).unwrap();
        assert!(curve.is_whole() && curve.profiles() == PROFILES);
        let means = curve.random.as_ref().unwrap().mean_adhesion_forces();
        let means: Vec<f64> = means.iter().map(|(_, one)| one.mean).collect();
        assert!(means.windows(2).all(|pair| pair[0] <= pair[1]) && means[0] < 0.2 * means[32], "{means:?}");
        // In the middle is the preload of the scene.
        let (preload, force) = curve.own.adhesion_forces(0)[FINE / 2];
        assert!((preload / computed.outcome.figures.preload.unwrap() - 1.0).abs() < 1e-12);
        assert!((force / computed.outcome.figures.adhesion_force.unwrap() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn scenes_without_preload_or_exact_solver_have_no_curve() {
        let mut one = computed("jkr-sphere");
        assert_eq!(PreloadCurve::new(&one).unwrap().random, None);
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
