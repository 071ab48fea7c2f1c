//! Direction and end of the motion of a body to a target.

use super::{ContactError, CurvePoint, Direction, Move};
use std::cmp::Ordering;

/// End of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) enum Goal {
    /// An indentation, m.
    Indentation(f64),
    /// A force, N.
    Force(f64),
    /// The loss of the last contact.
    Separation,
}

impl From<Move> for Goal {
    fn from(target: Move) -> Self {
        match target {
            Move::ToIndentation(indentation) => Goal::Indentation(indentation),
            Move::ToTouch => Goal::Indentation(0.0),
            Move::ToForce(force) => Goal::Force(force),
            Move::ToZeroForce => Goal::Force(0.0),
            Move::ToSeparation => Goal::Separation,
        }
    }
}

/// Returns the direction and the end of the motion of a body at `here` to a target; `None` for a body that is there.
///
/// # Errors
/// [`ContactError::NotFinite`], [`ContactError::NothingToPull`].
pub(super) fn plan(target: Move, here: CurvePoint) -> Result<Option<(Direction, Goal)>, ContactError> {
    let separated = here.springs == 0;
    let goal = Goal::from(target);
    let order = match goal {
        Goal::Force(value) | Goal::Indentation(value) if !value.is_finite() => {
            return Err(ContactError::NotFinite { value });
        }
        Goal::Force(force) if separated && force < 0.0 => return Err(ContactError::NothingToPull),
        Goal::Force(_) if separated => Ordering::Greater,
        Goal::Force(force) => order(force, here.force),
        // A separated body at d = 0 has not touched yet.
        Goal::Indentation(end) if separated && end >= 0.0 => Ordering::Greater,
        Goal::Indentation(end) => order(end, here.indentation),
        Goal::Separation if separated => Ordering::Equal,
        Goal::Separation => Ordering::Less,
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
