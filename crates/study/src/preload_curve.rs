//! The pull-off force of a scene as a function of the preload.

use crate::axis::Axis;
use crate::error::StudyError;
use crate::missing_profiles::Failures;
use crate::preloads::Staircase;
use crate::profiles::Stop;
use crate::results::Results;
use crate::statistics::Statistics;
use asperity_contact::{Figures, Move};
use asperity_data::{AxisScale, Control};
use asperity_scene::{CheckedScene, Outcome, Simulation, Solver};

/// Number of preloads at which the random profiles are computed.
const PRELOADS: usize = 64;
/// Position of the scene's preload among the preloads of a linear axis, counted from 0. The axis
/// extends from the force at first touch to twice the preload of the scene.
const LINEAR_PLACE: f64 = 31.0;
/// Position of the scene's preload among the preloads of a logarithmic axis, counted from 0. Two of
/// the six decades of the axis lie above this preload.
const LOGARITHMIC_PLACE: f64 = 42.0;
/// Number of decades of a logarithmic axis.
const DECADES: f64 = 6.0;
/// Relative difference up to which two preloads count as equal.
const SAME: f64 = 1e-9;

/// Pull-off force of a scene as a function of the preload, for the scene's own profile and for
/// further random profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct PreloadCurve {
    /// Preloads in N at which the random profiles are computed, as an axis.
    pub axis: Axis,
    /// Pull-off force of the scene's own profile as a function of the preload.
    pub staircase: Staircase,
    /// Results on the computed random profiles, for the preloads of `axis`. The first profile is
    /// the scene's own profile.
    pub results: Results,
}

impl PreloadCurve {
    /// Number of random profiles of a complete curve, including the scene's own profile.
    pub const PROFILES: usize = 16;

    /// Computes the pull-off force of a scene as a function of the preload. `outcome` is the known
    /// outcome of the scene, and `scale` is the scale of the preloads, linear or logarithmic. If
    /// `begun` is an incomplete curve on the same scale, only its missing parts are computed.
    /// `control` receives the curve computed so far after each part.
    ///
    /// # Errors
    /// Returns an error if zero threads are requested, if the scene has no adhesion or no stage
    /// that presses the bodies together, if the solver of the scene is not [`Solver::Exact`], or if
    /// its half-space relaxes. It is also an error if a profile or its contact cannot be computed,
    /// or if `control` stops the computation.
    pub fn of(
        scene: &CheckedScene,
        outcome: &Outcome,
        scale: AxisScale,
        begun: Option<PreloadCurve>,
        simulation: &mut Simulation,
        mut control: Control<'_, PreloadCurve>,
    ) -> Result<PreloadCurve, StudyError> {
        StudyError::check_threads(control.threads())?;
        let stop = control.stop();
        let begun = begun.filter(|begun| begun.axis.scale() == scale && begun.staircase.is_whole());
        let mut curve = match begun {
            Some(begun) => begun,
            None => PreloadCurve::begin(scene, outcome, scale, simulation, stop)?,
        };
        if !curve.staircase.is_whole() {
            let axis = curve.axis.clone();
            let staircase_control = control.of_part();
            let mut report = |staircase: &Staircase| {
                curve.staircase = staircase.clone();
                control.report(&curve);
            };
            let staircase_control = staircase_control.reporting_to(&mut report);
            Staircase::of(scene, &axis, simulation, staircase_control)?;
        }
        let missing = curve.results.missing(Failures::End);
        let threads = control.threads();
        missing.solve(simulation, threads, stop, &mut |solved| {
            curve.results.take_in(solved);
            control.report(&curve);
        })?;
        Ok(curve)
    }

    /// Makes a curve that has the axis of preloads, but no results yet.
    fn begin(
        scene: &CheckedScene,
        outcome: &Outcome,
        scale: AxisScale,
        simulation: &mut Simulation,
        stop: &Stop<'_>,
    ) -> Result<Self, StudyError> {
        let preload = preload_of(scene, outcome)?;
        let touch = force_at_touch(scene, simulation, stop)?;
        let last = (PRELOADS - 1) as f64;
        let (low, high) = match scale {
            AxisScale::Linear => (touch, touch + (preload - touch) * last / LINEAR_PLACE),
            AxisScale::Logarithmic => {
                let low = scale.coordinate(preload) - DECADES * LOGARITHMIC_PLACE / last;
                (low, low + DECADES)
            }
        };
        let axis = Axis::of_preloads((scale.number(low), scale.number(high)), PRELOADS, scale)?;
        let lines = scene.seed().map_or(1, |_| Self::PROFILES as u64);
        let results = Results::begin(scene, &Results::OF_PRELOADS, lines, Some(&axis))?;
        Ok(PreloadCurve {
            axis,
            staircase: Staircase::default(),
            results,
        })
    }

    /// Returns true if the curve is complete for the scene's own profile and for all
    /// [`PreloadCurve::PROFILES`] random profiles.
    pub fn is_whole(&self) -> bool {
        self.staircase.is_whole() && self.results.is_whole(0)
    }

    /// Returns the number of random profiles of the curve that are computed so far.
    pub fn profiles(&self) -> usize {
        self.results.records_of(0).count()
    }

    /// Returns the statistics of the pull-off force in N after a preload in N, over the computed
    /// profiles. `None` if the preload is not on [`PreloadCurve::axis`], or if fewer than two
    /// profiles are computed.
    pub fn at(&self, preload: f64) -> Option<Statistics> {
        for (place, statistics) in self.results.spread_of_adhesion() {
            if (place - preload).abs() <= SAME * preload.abs() {
                return Some(statistics);
            }
        }
        None
    }
}

/// Returns the preload of a computed scene in N. If the scene has no preload, its pull-off force is
/// returned.
///
/// # Errors
/// Returns an error if the scene has no such force, no adhesion or a solver that is not exact.
fn preload_of(scene: &CheckedScene, outcome: &Outcome) -> Result<f64, StudyError> {
    if scene.numerics.solver != Solver::Exact {
        let place = Some("numerics.solver");
        let found = "many preloads at once with the stepwise solver";
        return Err(StudyError::refused(place, found, "the exact solver"));
    }
    if scene.adhesion.is_none() {
        let place = Some("adhesion");
        let found = "without adhesion nothing holds the bodies together";
        return Err(StudyError::refused(place, found, "a scene with adhesion"));
    }
    let Figures {
        preload,
        pull_off_force,
        ..
    } = outcome.figures;
    let preload = preload.filter(|force| *force > 0.0).or(pull_off_force);
    preload.filter(|force| *force > 0.0).ok_or_else(|| {
        let found = "no stage presses the bodies together";
        StudyError::refused(Some("loading"), found, "a stage with a force above 0 N")
    })
}

/// Returns the force at first touch in N.
fn force_at_touch(
    scene: &CheckedScene,
    simulation: &mut Simulation,
    stop: &Stop<'_>,
) -> Result<f64, StudyError> {
    let mut force = 0.0;
    simulation.reverse(scene, &[Move::ToTouch], &[], stop, &mut |_, reversal| {
        force = reversal.turn.force;
        Ok(())
    })?;
    Ok(force)
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
        PreloadCurve::of(scene, outcome, scale, None, simulation, Control::default())
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
        let control = Control::default()
            .on_threads(1)
            .stopped_by(&stop)
            .reporting_to(&mut see);
        let (scene, outcome) = &computed;
        let done = PreloadCurve::of(scene, outcome, LINEAR, None, simulation, control);
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
        let control = Control::default().reporting_to(&mut see);
        let whole = PreloadCurve::of(scene, outcome, LINEAR, Some(begun), simulation, control);
        let whole = whole.unwrap();
        assert_eq!(
            (first, whole.profiles(), whole.is_whole()),
            (Some(4), PreloadCurve::PROFILES, true)
        );
        assert_eq!(curve(&computed, LINEAR).unwrap(), whole);
        // The preload of the scene is on the axis, and the pull-off force of the scene lies on the
        // staircase.
        let figures = computed.1.figures;
        let (preload, force) = (figures.preload.unwrap(), figures.pull_off_force.unwrap());
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
        // For another scale, the curve is computed anew.
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
