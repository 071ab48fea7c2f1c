//! Unloadings from many turning points of one loading.

use super::loading::Prepared;
use super::outcome::RunError;
use super::reach;
use super::reach::Reach;
use super::stages::Simulation;
use super::workload::Workload;
use crate::analysis::reversal_map::ReversalMap;
use crate::scene::checked::CheckedScene;
use crate::scene::model::FEW_SAMPLES;
use crate::scene::model::{Scene, Solver as SolverChoice};
use asperity_contact::motion::Body;
use asperity_contact::{ContactError, Move, Reversal};

/// Limit for the grid of a map: the number of grid points below the first turning point is at most
/// this factor times the number of turning points.
const MOST_BELOW: usize = 4;

/// Function that receives each computed unloading, with the index of the loading stage after which
/// the unloading begins.
pub type SeeReversal<'a> = dyn FnMut(usize, Reversal) -> Result<(), ContactError> + 'a;

impl Simulation {
    /// Computes unloadings to separation from several turning points, the indentations at which a
    /// loading ends. Each stage in `ends` is a loading from separation to one turning point. These
    /// stages must be in ascending order of the indentation at the turning point. `see` receives
    /// the index in `ends` of each stage, and the unloading after this stage. The forces of an
    /// unloading are computed at the indentations `points` in m, which must be ascending.
    ///
    /// # Errors
    /// Returns an error if the scene has the stepwise solver, if the profile cannot be computed, if
    /// the contact cannot reach the end of a stage, or if `stop` returned true.
    pub fn reverse(
        &mut self,
        scene: &CheckedScene,
        ends: &[Move],
        points: &[f64],
        stop: &dyn Fn() -> bool,
        see: &mut SeeReversal<'_>,
    ) -> Result<(), RunError> {
        needs_exact_solver(scene)?;
        let deepest = ends.last().copied().unwrap_or(Move::ToTouch);
        let plan = Workload::of_any(&Scene {
            loading: vec![deepest, Move::ToSeparation],
            ..Scene::clone(scene)
        });
        let Prepared { contact, .. } = self.prepare(&plan, scene, stop)?;
        reach::check(&contact, ends)?;
        let mut body = Body::new(&contact, scene.numerics.samples as usize);
        body.reversals(ends, points, &mut |index, reversal| {
            see(index, reversal)?;
            if stop() {
                Err(ContactError::Interrupted)
            } else {
                Ok(())
            }
        })?;
        Ok(())
    }

    /// Returns the deepest state up to which a loading of the scene can be computed.
    ///
    /// # Errors
    /// Returns an error if the profile cannot be computed.
    pub fn reach(&mut self, scene: &CheckedScene) -> Result<Reach, RunError> {
        let plan = Workload::of_any(&Scene {
            loading: vec![Move::ToTouch],
            ..Scene::clone(scene)
        });
        Ok(Reach::of(&self.prepare(&plan, scene, &|| false)?.contact))
    }

    /// Computes unloading curves of a scene to separation from `count` turning points (first-order
    /// reversal curves). If `count` is outside [`ReversalMap::TURNING_POINTS`], the nearest allowed
    /// number is used. `preloads` are the forces in N at the first and at the last turning point.
    /// If `preloads` is `None`, the first turning point is at first touch, and the last one at the
    /// preload of the scene.
    ///
    /// # Errors
    /// Returns the same errors as [`Simulation::reverse`]. Also returns an error if the loading
    /// never presses the bodies together.
    ///
    /// ```
    /// use asperity_scene::{Simulation, open};
    ///
    /// let sphere = open("jkr-sphere")?.set("numerics.points", "512")?;
    /// let map = Simulation::default().reversal_map(sphere.scene(), None, 8, &|| false)?;
    /// assert_eq!(map.reversals.len(), 8);
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn reversal_map(
        &mut self,
        scene: &CheckedScene,
        preloads: Option<(f64, f64)>,
        count: usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<ReversalMap, RunError> {
        needs_exact_solver(scene)?;
        let count = count.clamp(
            *ReversalMap::TURNING_POINTS.start(),
            *ReversalMap::TURNING_POINTS.end(),
        );
        let scene = scene.with(|scene| scene.numerics.samples = FEW_SAMPLES)?;
        let ends = if let Some((from, to)) = preloads {
            [Move::ToForce(from), Move::ToForce(to)]
        } else {
            let outcome = self.run(&scene, stop, &mut |_, _, _| Ok(()))?;
            let pressed = outcome
                .figures
                .preload_indentation
                .filter(|&indentation| indentation > 0.0);
            [
                Move::ToIndentation(0.0),
                Move::ToIndentation(pressed.ok_or(RunError::NeverPressed)?),
            ]
        };
        let mut turns = [0.0; 2];
        let mut separations = [0.0; 2];
        self.reverse(&scene, &ends, &[], stop, &mut |index, reversal| {
            turns[index] = reversal.turn.indentation;
            separations[index] = reversal.separation;
            Ok(())
        })?;
        let [low, high] = turns;
        let [_, separation] = separations;
        let step = (high - low) / (count - 1) as f64;
        if !(step > 0.0 && low + step > low) {
            return Err(RunError::NeverPressed);
        }
        let below = (((low - separation) / step).ceil() as usize + 1).min(MOST_BELOW * count);
        let points: Vec<f64> = (0..below + count)
            .map(|index| low + step * (index as f64 - below as f64))
            .collect();
        let ends: Vec<Move> = points[below..]
            .iter()
            .map(|&point| Move::ToIndentation(point))
            .collect();
        let mut reversals = Vec::with_capacity(count);
        self.reverse(&scene, &ends, &points, stop, &mut |_, reversal| {
            reversals.push(reversal);
            Ok(())
        })?;
        Ok(ReversalMap {
            points,
            below,
            reversals,
        })
    }
}

/// Returns an error if the scene has the stepwise solver, or if the half-space relaxes.
fn needs_exact_solver(scene: &Scene) -> Result<(), RunError> {
    if scene.relaxes() {
        return Err(ContactError::NotElastic.into());
    }
    if scene.numerics.solver == SolverChoice::Exact {
        Ok(())
    } else {
        Err(RunError::NeedsExactSolver)
    }
}
