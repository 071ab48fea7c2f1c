//! Direction and end of the motion of a body to a target.

use super::{ContactError, CurvePoint, Direction, Move};
use std::cmp::Ordering;

#[derive(Clone, Copy, Debug)]
pub(super) enum Goal {
    /// An indentation, m.
    Indentation(f64),
    /// A force, N.
    Force(f64),
    /// A displacement of an instrument that is not rigid, m.
    Displacement(f64),
    /// The loss of the last contact, and the indentation of the body after it where it is given, m.
    Separation(Option<f64>),
}

impl From<Move> for Goal {
    fn from(target: Move) -> Self {
        match target {
            Move::ToIndentation(indentation) => Goal::Indentation(indentation),
            Move::ToDisplacement(displacement) => Goal::Displacement(displacement),
            Move::ToTouch => Goal::Indentation(0.0),
            Move::ToForce(force) => Goal::Force(force),
            Move::ToZeroForce => Goal::Force(0.0),
            Move::ToSeparation => Goal::Separation(None),
        }
    }
}

/// Returns the direction and the end of the motion of a body at `here` to a target, with an instrument of this stiffness,
/// N/m; `None` for a body that is there.
pub(super) fn plan(
    target: Move,
    here: CurvePoint,
    stiffness: f64,
) -> Result<Option<(Direction, Goal)>, ContactError> {
    let separated = here.springs == 0;
    let goal = match Goal::from(target) {
        // Nothing deflects a rigid instrument, nor any other before the touch.
        Goal::Displacement(at) if stiffness.is_infinite() || separated && at < 0.0 => Goal::Indentation(at),
        goal => goal,
    };
    let order = match goal {
        Goal::Force(value) | Goal::Indentation(value) | Goal::Displacement(value) if !value.is_finite() => {
            return Err(ContactError::NotFinite(value));
        }
        Goal::Force(force) if separated && force < 0.0 => return Err(ContactError::NothingToPull),
        Goal::Force(_) if separated => Ordering::Greater,
        Goal::Force(force) => order(force, here.force),
        // A separated body at d = 0 has not touched yet.
        Goal::Indentation(end) if separated && end >= 0.0 => Ordering::Greater,
        Goal::Indentation(end) => order(end, here.indentation),
        Goal::Displacement(_) if separated => Ordering::Greater,
        Goal::Displacement(end) => order(end, here.displacement(stiffness)),
        Goal::Separation(_) if separated => Ordering::Equal,
        Goal::Separation(_) => Ordering::Less,
    };
    Ok(match order {
        Ordering::Greater => Some((Direction::Loading, goal)),
        Ordering::Less => Some((Direction::Unloading, goal)),
        Ordering::Equal => None,
    })
}

/// Order of finite numbers, in which −0 equals 0.
fn order(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}
