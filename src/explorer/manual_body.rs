//! The body under manual loading, with its path for the curve.

use super::request::ManualMove;
use super::snapshot::ManualPath;
use crate::contact::{Body, ContactError, CurvePoint, Leg, Motion, Solver};
use crate::scene::{Move, format_quantity};
use crate::text::round_to;

/// Points of the curve along the way of one order.
const POINTS: u32 = 16;
const MOST_POINTS: u32 = 512;
/// Largest force over that at full contact: beyond full contact the curve is a straight line.
const MOST_OVER_FULL_CONTACT: f64 = 10.0;

pub struct ManualBody {
    body: Body,
    travel: ManualPath,
    /// A small part of the range of indentations, m.
    step: f64,
    /// Force at which the last spring touches the rigid body, N.
    full_contact: f64,
    /// Largest pressing force, N.
    largest: f64,
}

impl ManualBody {
    /// Begins manual loading at an indentation of a leg, m. `step` is the distance of the points of a pull, m, and
    /// `preload` the largest force of the scene's loading, N; `None` without enough memory.
    pub fn take(leg: &Leg, indentation: f64, (step, preload): (f64, f64)) -> Option<Self> {
        let body = Body::at(leg, indentation).ok()?;
        let full_contact = leg.contact().full_contact_force();
        let largest = MOST_OVER_FULL_CONTACT * full_contact.max(preload);
        Some(ManualBody { body, travel: ManualPath::default(), step, full_contact, largest })
    }

    pub fn point(&self) -> CurvePoint {
        self.body.point()
    }

    pub fn leg(&self) -> Leg {
        self.body.leg()
    }

    pub fn travel(&mut self) -> ManualPath {
        let released_energy = self.travel.released_energy;
        std::mem::replace(&mut self.travel, ManualPath { released_energy, ..ManualPath::default() })
    }

    /// Moves the body; a refused order moves nothing.
    pub fn obey(&mut self, order: ManualMove) {
        let from = self.body.point();
        let target = match order {
            ManualMove::Take { .. } => return,
            ManualMove::To(indentation) => Move::ToIndentation(indentation),
            ManualMove::By(way) => Move::ToIndentation(from.indentation + way),
            ManualMove::ToForce(force) => Move::ToForce(force),
            ManualMove::Separate => Move::ToSeparation,
        };
        self.travel.refused = self.go(from, target).err();
    }

    /// Moves the body, or states why not, with forces rounded into the allowed range.
    fn go(&mut self, from: CurvePoint, target: Move) -> Result<(), String> {
        let newtons = |force| format_quantity(force, "N");
        if let Move::ToForce(force) = target
            && force > self.largest.max(from.force)
        {
            let (full, most) = (newtons(self.full_contact), newtons(-rounded_up(-self.largest)));
            let force = newtons(force);
            return Err(format!("{force} is far beyond full contact at {full}; allowed: at most {most}"));
        }
        let moved = self.body.move_to(target).map_err(|error| match (error, target) {
            (ContactError::DetachesBefore { smallest }, Move::ToForce(force)) => {
                let (force, least) = (newtons(force), newtons(rounded_up(smallest)));
                format!("the contact detaches before {force}; smallest force within reach: {least}")
            }
            (error, _) => error.to_string(),
        })?;
        let Some(Motion { leg, low, high, .. }) = moved else { return Ok(()) };
        let to = self.body.point();
        let way = to.indentation - from.indentation;
        let points = match target {
            Move::ToSeparation => ((-way / self.step) as u32).min(MOST_POINTS),
            _ => POINTS - 1,
        };
        let step = match target {
            Move::ToSeparation => -self.step,
            _ => way / f64::from(POINTS),
        };
        let mut at: Vec<f64> = (1..=points).map(|k| from.indentation + step * f64::from(k)).collect();
        at.sort_by(f64::total_cmp);
        let mut path = leg.curve(&at).map_err(|error| error.to_string())?;
        if way < 0.0 {
            path.reverse();
        }
        // All springs attach or detach between contact and separation.
        let passes_separation = from.springs == 0 || to.springs == 0;
        let below = if passes_separation { f64::NEG_INFINITY } else { low };
        self.travel.path.extend(path);
        self.travel.path.push(to);
        self.travel.changed += to.springs.abs_diff(from.springs);
        self.travel.released_energy += leg.released_energy(below, high);
        Ok(())
    }
}

/// The nearest number of four digits not below a value.
fn rounded_up(value: f64) -> f64 {
    let nearest = round_to(value, 4);
    let last_digit = 10.0_f64.powi((value.abs().log10().floor() as i32).saturating_sub(3));
    if nearest >= value { nearest } else { round_to(value + last_digit, 4) }
}
