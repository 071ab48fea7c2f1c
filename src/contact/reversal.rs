//! Reversals: the unloadings from many turning points of one loading.
//!
//! All reversals share the tree, the thresholds of attachment and the list of the loading.

use super::contact_model::Reversed;
use super::contact_state::ContactState;
use super::exact::Exact;
use super::grid::Grid;
use super::leg_plan::{Target, plan};
use super::{ContactError, CurvePoint, Work};
use crate::scene::Leg;

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

/// The reversals of a body that is loaded from separation.
pub struct Reversals<'a> {
    body: Exact<'a>,
    /// Turning points in the order of their depth, and their numbers.
    turns: Vec<(usize, ContactState)>,
}

impl Reversal {
    /// Adhesion force F_a, N: minus the smallest force; `None` where the body does not pull.
    #[must_use]
    pub fn adhesion_force(&self) -> Option<f64> {
        // Not −F: that would make a force of zero negative.
        Some(0.0 - self.smallest.force).filter(|_| self.smallest.force <= 0.0)
    }
}

impl<'a> Reversals<'a> {
    /// Loads a body from separation and finds the turning points: the ends of these legs, each of which begins separated
    /// at d = 0.
    ///
    /// # Errors
    /// For a leg whose end is out of reach, or without enough memory.
    pub fn new(mut body: Exact<'a>, ends: &[Leg]) -> Result<Self, ContactError> {
        let complete = body.begin_loading()?.max(0.0);
        let apart = CurvePoint::default();
        let mut order = Vec::with_capacity(ends.len());
        for (index, &leg) in ends.iter().enumerate() {
            let at = match plan(leg, apart, index)?.map(|(_, target)| target) {
                Some(Target::Force(force)) => {
                    body.load_to_force(leg, force, 0.0, complete).map_err(|error| match error {
                        ContactError::OutOfReach { leg, .. } => ContactError::OutOfReach { index, leg },
                        other => other,
                    })?
                }
                Some(Target::Indentation(indentation)) if indentation >= 0.0 => indentation,
                _ => return Err(ContactError::NoContact { index, leg }),
            };
            order.push((index, at));
        }
        order.sort_by(|one, other| one.1.total_cmp(&other.1));
        let mut points: Vec<f64> = order.iter().map(|&(_, at)| at).collect();
        points.dedup();
        let mut turns = Vec::with_capacity(order.len());
        if !points.is_empty() {
            let states = body.contact().sample(Grid::at(points))?;
            turns.extend(
                order.iter().map(|&(index, at)| (index, states.states[states.grid.first_at_least(at)])),
            );
        }
        Ok(Reversals { body, turns })
    }

    /// Calls `see` with each reversal and the number of its leg, from the shallowest on. `points` are the ascending
    /// indentations of the forces, m.
    ///
    /// # Errors
    /// The first error of `see` ends the work; [`ContactError::OutOfMemory`].
    pub fn each(
        &mut self,
        points: &[f64],
        see: &mut dyn FnMut(usize, Reversal) -> Result<(), ContactError>,
    ) -> Result<(), ContactError> {
        for &(index, turn) in &self.turns {
            see(index, reverse(&mut self.body, turn, points)?)?;
        }
        Ok(())
    }

    /// All reversals in the order of their legs, without forces.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn all(&mut self) -> Result<Vec<Reversal>, ContactError> {
        let mut found: Vec<(usize, Reversal)> = Vec::with_capacity(self.turns.len());
        self.each(&[], &mut |index, reversal| {
            found.push((index, reversal));
            Ok(())
        })?;
        found.sort_by_key(|&(index, _)| index);
        Ok(found.into_iter().map(|(_, reversal)| reversal).collect())
    }

    /// Work counts so far.
    #[must_use]
    pub fn work(&self) -> Work {
        super::Solver::work(&self.body)
    }

    /// The body, for its memory.
    #[must_use]
    pub fn into_body(self) -> Exact<'a> {
        self.body
    }
}

/// Unloads from a turning point.
fn reverse(body: &mut Exact<'_>, turn: ContactState, points: &[f64]) -> Result<Reversal, ContactError> {
    let high = turn.indentation;
    let (contact, work) = body.work_mut();
    let Reversed { separates, squared_stretches: [attached, detached] } = contact.reverse(high, work)?;
    let separation = separates.min(high);
    let (grid, _) = body.grid(separation, high);
    let (contact, work) = body.work_mut();
    let smallest = contact.smallest_of_reversal(&grid, turn, &mut work.events_sorted)?;
    let below = &points[..points.partition_point(|&point| point <= high)];
    let apart = below.partition_point(|&point| point < separation);
    let mut forces = vec![0.0; apart];
    if apart < below.len() {
        let leg = body.contact().sample_reversal(Grid::at(below[apart..].to_vec()))?;
        forces.extend(leg.states.into_iter().map(|state| body.curve_point(state).force));
    }
    Ok(Reversal {
        turn: body.curve_point(turn),
        smallest: body.curve_point(smallest),
        separation,
        dissipated_energy: ((0.0 - body.energy(attached)) + body.energy(detached)) + 0.0,
        forces,
    })
}
