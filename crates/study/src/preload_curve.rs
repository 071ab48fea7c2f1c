//! The adhesion force of a scene as a function of the preload.

use crate::axis::Axis;
use crate::error::StudyError;
use crate::preloads::Staircase;
use crate::profiles::Stop;
use crate::results::Results;
use crate::statistics::Statistics;
use asperity_contact::{Figures, Move};
use asperity_data::AxisScale;
use asperity_scene::{CheckedScene, Outcome, RunError, Simulation, Solver};

/// Number of preloads, and index of the preload of the scene among them. A linear axis extends from
/// the force at first touch to twice this preload. A logarithmic axis extends over six decades, two
/// of them above this preload.
const PRELOADS: usize = 64;
const PLACES: (f64, f64) = (31.0, 42.0);
const DECADES: f64 = 6.0;
/// Relative difference up to which preloads count as equal.
const SAME: f64 = 1e-9;

/// Returns the error of a single profile.
fn failed(error: RunError) -> StudyError {
    StudyError::Run {
        place: String::new(),
        error,
    }
}

/// Adhesion force of a scene as a function of the preload, for the scene's own profile and for
/// further random profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct PreloadCurve {
    /// Preloads in N at which the random profiles are computed, as an axis.
    pub axis: Axis,
    /// Adhesion force of the scene's own profile as a function of the preload.
    pub staircase: Staircase,
    /// Results on random profiles at the preloads of `axis`. The first profile is the scene's own
    /// profile.
    pub results: Results,
}

impl PreloadCurve {
    /// Number of random profiles of a complete curve, including the scene's own profile.
    pub const PROFILES: usize = 16;

    /// Computes the curve of a scene whose outcome is already known. `scale` is the scale of the
    /// preloads, linear or logarithmic. If `begun` is an incomplete curve on the same scale, only
    /// the missing parts are computed. After each part `report` receives the curve so far.
    ///
    /// # Errors
    /// Returns an error if the scene has no adhesion or no stage that presses the bodies together,
    /// or if the solver of the scene is not [`Solver::Exact`]. It is also an error if a profile or
    /// its contact cannot be computed, or if `stop` returned true.
    pub fn compute(
        (scene, outcome): (&CheckedScene, &Outcome),
        scale: AxisScale,
        begun: Option<PreloadCurve>,
        simulation: &mut Simulation,
        stop: &Stop<'_>,
        report: &mut dyn FnMut(&PreloadCurve),
    ) -> Result<PreloadCurve, StudyError> {
        let begun = begun.filter(|begun| begun.axis.scale() == scale && begun.staircase.is_whole());
        let mut curve = begun.map_or_else(
            || Self::begin((scene, outcome), scale, simulation, stop),
            Ok,
        )?;
        if !curve.staircase.is_whole() {
            let axis = curve.axis.clone();
            let found = Staircase::find(scene, &axis, simulation, stop, &mut |part| {
                curve.staircase = part.clone();
                report(&curve);
            });
            found.map_err(failed)?;
        }
        let mut results = curve.results.clone();
        let done = results.extend((std::mem::take(simulation), 1), stop, &mut |part| {
            report(&PreloadCurve {
                results: part.clone(),
                ..curve.clone()
            });
        });
        done?;
        Ok(PreloadCurve { results, ..curve })
    }

    /// Begins the curve of a computed scene without results.
    fn begin(
        (scene, outcome): (&CheckedScene, &Outcome),
        scale: AxisScale,
        simulation: &mut Simulation,
        stop: &Stop<'_>,
    ) -> Result<Self, StudyError> {
        if scene.numerics.solver != Solver::Exact {
            let found = "many preloads at once with the stepwise solver";
            return Err(StudyError::refused(
                Some("numerics.solver"),
                found,
                "the exact solver",
            ));
        }
        if scene.adhesion.is_none() {
            let found = "without adhesion nothing holds the bodies together";
            return Err(StudyError::refused(
                Some("adhesion"),
                found,
                "a scene with adhesion",
            ));
        }
        let Figures {
            preload,
            adhesion_force,
            ..
        } = outcome.figures;
        let preload = preload
            .filter(|&force| force > 0.0)
            .or(adhesion_force)
            .filter(|&force| force > 0.0);
        let preload = preload.ok_or_else(|| {
            let found = "no stage presses the bodies together";
            StudyError::refused(Some("loading"), found, "a stage with a force above 0 N")
        })?;
        let mut touch = 0.0;
        let touched = simulation.reverse(scene, &[Move::ToTouch], &[], stop, &mut |_, reversal| {
            touch = reversal.turn.force;
            Ok(())
        });
        touched.map_err(failed)?;
        let last = (PRELOADS - 1) as f64;
        let (low, high) = match scale {
            AxisScale::Linear => (touch, touch + (preload - touch) * last / PLACES.0),
            AxisScale::Logarithmic => {
                let low = scale.coordinate(preload) - DECADES * PLACES.1 / last;
                (low, low + DECADES)
            }
        };
        let axis = Axis::of_preloads((scale.number(low), scale.number(high)), PRELOADS, scale)?;
        let lines = scene.seed().map_or(1, |_| Self::PROFILES as u64);
        let results = Results::begin(scene, &Results::OF_PRELOADS, lines, Some(&axis));
        Ok(PreloadCurve {
            axis,
            staircase: Staircase::default(),
            results: results?,
        })
    }

    /// Returns true if the curve is complete: the staircase, and all [`PreloadCurve::PROFILES`]
    /// random profiles.
    pub fn is_whole(&self) -> bool {
        self.staircase.is_whole() && self.results.is_whole(0)
    }

    /// Returns the number of random profiles of the curve that are computed so far.
    pub fn profiles(&self) -> usize {
        self.results.records_of(0).count()
    }

    /// Returns the statistics over the computed profiles of the adhesion force in N after a preload
    /// in N. `None` if the preload is not on [`PreloadCurve::axis`], or if fewer than two profiles
    /// are computed.
    pub fn at(&self, preload: f64) -> Option<Statistics> {
        let spread = self.results.spread_of_adhesion().into_iter();
        let at = |one: &(f64, Statistics)| (one.0 - preload).abs() <= SAME * preload.abs();
        spread.into_iter().find(at).map(|(_, all)| all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::Edges;
    use asperity_scene::open;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    const LINEAR: AxisScale = AxisScale::Linear;

    fn computed(name: &str) -> (CheckedScene, Outcome) {
        let scene = open(name)
            .unwrap()
            .scene()
            .with(|scene| scene.numerics.points = 2048)
            .unwrap();
        let outcome = outcome(&scene);
        (scene, outcome)
    }

    fn outcome(scene: &CheckedScene) -> Outcome {
        Simulation::default()
            .run(scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap()
    }

    fn curve(
        (scene, outcome): &(CheckedScene, Outcome),
        scale: AxisScale,
    ) -> Result<PreloadCurve, StudyError> {
        let simulation = &mut Simulation::default();
        PreloadCurve::compute(
            (scene, outcome),
            scale,
            None,
            simulation,
            &|| false,
            &mut |_| (),
        )
    }

    #[test]
    fn the_curve_grows_and_continues_where_it_was_stopped() {
        let computed = computed("pressure-sensitive");
        let (simulation, profiles, parts) = (
            &mut Simulation::default(),
            AtomicUsize::new(0),
            AtomicUsize::new(0),
        );
        let stop = || profiles.load(Relaxed) >= 3;
        let mut last = None;
        let mut see = |curve: &PreloadCurve| {
            profiles.store(curve.profiles(), Relaxed);
            parts.fetch_add(1, Relaxed);
            last = Some(curve.clone());
        };
        let done = PreloadCurve::compute(
            (&computed.0, &computed.1),
            LINEAR,
            None,
            simulation,
            &stop,
            &mut see,
        );
        let begun = last.unwrap();
        assert!(
            done.is_err()
                && begun.staircase.is_whole()
                && begun.profiles() == 3
                && parts.load(Relaxed) > 4
        );
        let mut first = None;
        let mut see = |part: &PreloadCurve| {
            first.get_or_insert(part.profiles());
        };
        let whole = PreloadCurve::compute(
            (&computed.0, &computed.1),
            LINEAR,
            Some(begun),
            simulation,
            &|| false,
            &mut see,
        );
        let whole = whole.unwrap();
        assert_eq!(
            (first, whole.profiles(), whole.is_whole()),
            (Some(4), PreloadCurve::PROFILES, true)
        );
        assert_eq!(curve(&computed, LINEAR).unwrap(), whole);
        // The preload of the scene is among those of the axis, and its adhesion force on the
        // staircase.
        let figures = computed.1.figures;
        let (preload, force) = (figures.preload.unwrap(), figures.adhesion_force.unwrap());
        let at = whole
            .staircase
            .forces
            .iter()
            .find(|at| (at.0 / preload - 1.0).abs() < SAME)
            .unwrap();
        assert!((at.1 / force - 1.0).abs() < 1e-9);
        assert_eq!(
            whole.at(preload).map(|all| all.count),
            Some(PreloadCurve::PROFILES)
        );
        assert_eq!(
            (whole.at(0.7 * preload), whole.axis.values[0]),
            (None, whole.staircase.touch.0)
        );
        // Another axis is another curve.
        let ratios = curve(&computed, AxisScale::Logarithmic).unwrap();
        let (first, last) = (ratios.axis.values[0], ratios.axis.values[PRELOADS - 1]);
        assert!((last / first / 1e6 - 1.0).abs() < 1e-9 && ratios.at(preload).is_some());
    }

    #[test]
    fn scenes_without_preload_or_exact_solver_have_no_curve() {
        let mut one = computed("jkr-sphere");
        assert_eq!(curve(&one, LINEAR).unwrap().profiles(), 1);
        let scene = one.0.clone();
        let steps = scene.with(|scene| {
            (scene.numerics.solver, scene.numerics.edges) =
                (Solver::Stepwise { step: 1e-9 }, Edges::Grid);
        });
        one.0 = steps.unwrap();
        assert!(
            curve(&one, LINEAR)
                .unwrap_err()
                .to_string()
                .contains("exact solver")
        );
        let scene = scene
            .with(|scene| scene.loading = vec![Move::ToIndentation(-1e-9)])
            .unwrap();
        one = (scene.clone(), outcome(&scene));
        assert!(
            curve(&one, LINEAR)
                .unwrap_err()
                .to_string()
                .contains("presses")
        );
        one.0 = scene.with(|scene| scene.adhesion = None).unwrap();
        assert!(
            curve(&one, LINEAR)
                .unwrap_err()
                .to_string()
                .contains("adhesion")
        );
    }
}
