//! Which way a leg goes from where a body stands, and where it ends.

use super::{ContactError, Direction};
use crate::scene::Leg;

/// Where a body stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// Indentation, m.
    pub indentation: f64,
    /// Force, N.
    pub force: f64,
    /// Whether nothing touches.
    pub separated: bool,
}

/// Where a leg ends.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// At an indentation, m.
    Indentation(f64),
    /// Where Σ (d − c) is so large, m.
    Compression(f64),
    /// Where nothing touches any more.
    Separation,
}

impl Standing {
    /// Which way a leg goes and where it ends; `None` when it ends where the body stands. `stiffness` is
    /// that of one spring, N/m, and `index` the number of the leg.
    ///
    /// # Errors
    /// [`ContactError::NothingToPull`].
    pub fn plan(
        &self,
        leg: Leg,
        stiffness: f64,
        index: usize,
    ) -> Result<Option<(Direction, Target)>, ContactError> {
        match leg {
            Leg::ToIndentation(wanted) => Ok(self.plan_indentation(wanted)),
            Leg::ToTouch => Ok(self.plan_indentation(0.0)),
            Leg::ToForce(force) => self.plan_force(force, stiffness, index),
            Leg::ToZeroForce => self.plan_force(0.0, stiffness, index),
            Leg::ToSeparation if self.separated => Ok(None),
            Leg::ToSeparation => Ok(Some((Direction::Unloading, Target::Separation))),
        }
    }

    fn plan_indentation(&self, wanted: f64) -> Option<(Direction, Target)> {
        // From separation at d = 0 a leg to d = 0 is the touch itself.
        if wanted > self.indentation || (self.separated && wanted >= 0.0) {
            Some((Direction::Loading, Target::Indentation(wanted)))
        } else if wanted < self.indentation {
            Some((Direction::Unloading, Target::Indentation(wanted)))
        } else {
            None
        }
    }

    fn plan_force(
        &self,
        force: f64,
        stiffness: f64,
        index: usize,
    ) -> Result<Option<(Direction, Target)>, ContactError> {
        let target = Target::Compression(force / stiffness);
        if self.separated {
            return if force < 0.0 {
                Err(ContactError::NothingToPull { index, force })
            } else {
                Ok(Some((Direction::Loading, target)))
            };
        }
        // As forces: the division may miss the compression the force came from.
        Ok(match force.partial_cmp(&self.force) {
            Some(std::cmp::Ordering::Greater) => Some((Direction::Loading, target)),
            Some(std::cmp::Ordering::Less) => Some((Direction::Unloading, target)),
            _ => None,
        })
    }
}
