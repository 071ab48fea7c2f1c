//! Reversals: the unloadings from many turning points of one loading.

use super::body::Body;
use super::contact_state::ContactState;
use super::goal::{Goal, plan};
use super::leg::Leg;
use super::{ContactError, CurvePoint, Direction};
use crate::contact::Move;

/// The unloading from one turning point to separation, exact to rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct Reversal {
    /// Turning point.
    pub turn: CurvePoint,
    /// Smallest force on the way back.
    pub smallest: CurvePoint,
    /// Indentation at which the last patch detaches, m.
    pub separation: f64,
    /// Energy dissipated from separation to separation, J.
    pub dissipated_energy: f64,
    /// Forces at the requested points, up to the turning point, N.
    pub forces: Vec<f64>,
}

impl Reversal {
    /// Adhesion force F_a, N: minus the smallest force; `None` where the body does not pull.
    pub fn adhesion_force(&self) -> Option<f64> {
        // Not −F: that would make a force of zero negative.
        Some(0.0 - self.smallest.force).filter(|_| self.smallest.force <= 0.0)
    }
}

impl Body {
    /// Loads this separated body once and unloads it from each of these targets, which begin separated at d = 0. A force is
    /// reached where the loading is first at least as large: a pulling one at first touch, or while the bodies are still
    /// drawn together. Calls `see` with the index of the target and its reversal, from the shallowest on; the forces are
    /// those at `points`, ascending indentations in m. The body stays separated.
    ///
    /// # Errors
    /// A target out of reach or without contact, [`ContactError::OutOfMemory`]; the first error of `see`.
    pub fn reversals(
        &mut self,
        targets: &[Move],
        points: &[f64],
        see: &mut dyn FnMut(usize, Reversal) -> Result<(), ContactError>,
    ) -> Result<(), ContactError> {
        let loading = self.leg_in(Direction::Loading)?;
        let mut turns = Vec::with_capacity(targets.len());
        for (index, &target) in targets.iter().enumerate() {
            let approach = match Goal::from(target) {
                // A pulling force as well: while the bodies are drawn together.
                goal @ Goal::Force(force) if force < 0.0 && force.is_finite() => {
                    Ok(Some((Direction::Loading, goal)))
                }
                _ => plan(target, CurvePoint::default(), loading.contact().loading_stiffness),
            };
            let at = match approach {
                Ok(Some((Direction::Loading, goal))) => {
                    loading.reach(goal, 0.0, &mut self.work).map(|(at, _)| at)
                }
                Ok(_) => Err(ContactError::NoContact),
                Err(reason) => Err(reason),
            };
            turns.push((index, at.map_err(|reason| reason.in_stage(index, target))?));
        }
        turns.sort_by(|one, other| one.1.total_cmp(&other.1));
        for (index, at) in turns {
            see(index, self.reverse(&loading, loading.state(at)?, points)?)?;
        }
        Ok(())
    }

    /// Returns the adhesion forces after a turn at first touch and after one where the force is back at zero, N; `None` where
    /// the contact does not pull, or never reaches zero force. Both turns begin separated; the body stays in place.
    pub fn zero_load_adhesion(&mut self) -> Result<[Option<f64>; 2], ContactError> {
        let before = self.work;
        let loading = Leg::approach(self.leg.contact())?;
        loading.count(&mut self.work);
        let balanced = loading.reach(Goal::Force(0.0), 0.0, &mut self.work);
        let mut adhesion = |at| {
            let reversal = self.reverse(&loading, loading.state(at)?, &[]);
            reversal.map(|reversal| reversal.adhesion_force())
        };
        let at_touch = adhesion(0.0)?;
        let at_zero_force = match balanced {
            Err(ContactError::OutOfReach) => None,
            at => adhesion(at?.0)?,
        };
        // The passes for F_a(0) count separately.
        let work = &mut self.work;
        (work.loading_passes, work.unloading_passes) = (before.loading_passes, before.unloading_passes);
        work.zero_load_passes += 2;
        Ok([at_touch, at_zero_force])
    }

    /// Unloads from a turning point of a loading.
    fn reverse(
        &mut self,
        loading: &Leg,
        turn: ContactState,
        points: &[f64],
    ) -> Result<Reversal, ContactError> {
        let high = turn.indentation;
        let unloading = loading.turn(high)?;
        unloading.count(&mut self.work);
        let separation = unloading.end().min(high);
        let (grid, _) = self.grid(separation, high);
        let smallest = unloading.smallest(&grid, &mut self.work)?;
        let below = &points[..points.partition_point(|&point| point <= high)];
        let apart = below.partition_point(|&point| point < separation);
        let mut forces = vec![0.0; apart];
        forces.extend(unloading.curve(&below[apart..])?.iter().map(|point| point.force));
        let released = [loading, &unloading].map(|leg| leg.released_energy(f64::NEG_INFINITY, high));
        Ok(Reversal {
            turn: self.point_of(turn),
            smallest: self.point_of(smallest),
            separation,
            dissipated_energy: released[0] + released[1] + 0.0,
            forces,
        })
    }
}
