//! Direction and end of a leg, for every solver.

use super::{ContactError, CurvePoint, Direction};
use crate::scene::Leg;
use std::cmp::Ordering;

/// End of a leg.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// An indentation, m.
    Indentation(f64),
    /// A force, N.
    Force(f64),
    /// The loss of the last contact.
    Separation,
}

impl From<Leg> for Target {
    fn from(leg: Leg) -> Self {
        match leg {
            Leg::ToIndentation(indentation) => Target::Indentation(indentation),
            Leg::ToTouch => Target::Indentation(0.0),
            Leg::ToForce(force) => Target::Force(force),
            Leg::ToZeroForce => Target::Force(0.0),
            Leg::ToSeparation => Target::Separation,
        }
    }
}

/// Direction and end of the leg with this index, of a body at `here`; `None` for a leg that ends where it begins.
///
/// # Errors
/// [`ContactError::NothingToPull`].
pub(super) fn plan(
    leg: Leg,
    here: CurvePoint,
    index: usize,
) -> Result<Option<(Direction, Target)>, ContactError> {
    let separated = here.springs == 0;
    let target = Target::from(leg);
    let order = match target {
        Target::Force(force) if separated && force < 0.0 => {
            return Err(ContactError::NothingToPull { index, force });
        }
        Target::Force(_) if separated => Ordering::Greater,
        Target::Force(force) => order(force, here.force),
        // A separated body at d = 0 has not touched yet.
        Target::Indentation(end) if separated && end >= 0.0 => Ordering::Greater,
        Target::Indentation(end) => order(end, here.indentation),
        Target::Separation if separated => Ordering::Equal,
        Target::Separation => Ordering::Less,
    };
    Ok(match order {
        Ordering::Greater => Some((Direction::Loading, target)),
        Ordering::Less => Some((Direction::Unloading, target)),
        Ordering::Equal => None,
    })
}

/// Order of finite numbers, in which −0 equals 0.
fn order(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}
