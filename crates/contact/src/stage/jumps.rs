//! Jumps of a stage: which patches change, how many springs attach or detach, and which elastic
//! energy the springs gain or release.

use super::{Patches, Stage};
use crate::adhesive::jumps::{Boundary, PatchJump};
use crate::adhesive::levels::Edges;
use crate::detachment::DetachmentRule;
use crate::error::ContactError;
use crate::history::{Direction, Patch, StageRecord};

/// A jump of the contact: at one indentation, several springs of a patch attach or detach together.
///
/// The elastic energy that the springs gain or release at this fixed indentation is known for each
/// jump, but a dissipated energy is not: only over a closed loop the sum of all gained and released
/// energies is the energy that is lost.
///
/// ```
/// use asperity_contact::motion::{Body, Jump, JumpKind};
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// // A flat face with a groove that is 1 µm deep and four springs wide.
/// let mut heights = vec![0.0; 20];
/// heights[8..12].fill(-1.0e-6);
/// let profile = Profile::from_heights(heights, 1.0e-6)?;
/// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let mut body = Body::new(&contact, 2);
/// let loading = body.move_to(Move::ToIndentation(1.0e-6))?.expect("a way to go");
/// let jumps = loading.stage.jumps(f64::NEG_INFINITY, loading.high)?;
/// // Under so much adhesion the first touch is full contact.
/// assert_eq!((jumps.len(), jumps[0].kind, jumps[0].springs), (1, JumpKind::Touches, 20));
/// // The springs have 1 N/m, and ∫ c² dx over the groove and its two sides is 3 + 2/3 µm².
/// let energy = 0.5 * (3.0 + 2.0 / 3.0) * 1.0e-12;
/// assert!((jumps[0].energy / energy - 1.0).abs() < 1e-9);
/// assert_eq!(loading.stage.forces_at_jumps(&jumps)?[0][0], 0.0);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Jump {
    /// Indentation in m at which the springs attach or detach.
    pub indentation: f64,
    /// Kind of the change: whether the patch appears, grows, merges, shrinks, splits or disappears.
    pub kind: JumpKind,
    /// Number of springs that attach (positive) or detach (negative).
    pub springs: i64,
    /// Elastic energy in J that springs gain (positive) or release (negative), at the fixed
    /// indentation.
    pub energy: f64,
    /// Number of patches of the whole contact before and after the jump.
    pub patches: [u64; 2],
    /// Number of the patch from the left, from 0. If patches merge, the number is that of their
    /// leftmost one, and so of the merged patch. If a patch splits, its leftmost part has the same
    /// number.
    pub number: u64,
    /// Springs of the patch before the jump, counted from the first spring under the body. If
    /// several patches merge, these are all springs from the first one to the last one of the
    /// patches. `None` if the patch appears.
    pub before: Option<Patch>,
    /// Springs of the patch after the jump, counted as in `before`. If the patch splits, these are
    /// all springs from the first one to the last one of the parts. `None` if the patch disappears.
    pub after: Option<Patch>,
}

/// Kind of the change of a patch in a [`Jump`].
///
/// ```
/// use asperity_contact::motion::JumpKind;
///
/// assert_eq!(JumpKind::Merges { patches: 2 }.name(), "merges");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JumpKind {
    /// A new patch appears where nothing was in contact.
    Touches,
    /// One patch becomes longer.
    Spreads,
    /// Several patches become one.
    Merges {
        /// Number of patches before the jump, at least 2.
        patches: u64,
    },
    /// One patch becomes shorter.
    Shrinks,
    /// A patch becomes several ones.
    Splits {
        /// Number of parts after the jump, at least 2.
        parts: u64,
    },
    /// A patch disappears.
    Detaches,
    /// Several patches jump at the same indentation, as on a profile with equal summits.
    /// [`Jump::number`] and the springs of the patch are those of the patch that changes most.
    Several {
        /// Number of patches that jump, at least 2.
        changes: u64,
    },
}

impl JumpKind {
    /// Returns the name of the kind as in result files.
    pub fn name(self) -> &'static str {
        match self {
            JumpKind::Touches => "touches",
            JumpKind::Spreads => "spreads",
            JumpKind::Merges { .. } => "merges",
            JumpKind::Shrinks => "shrinks",
            JumpKind::Splits { .. } => "splits",
            JumpKind::Detaches => "detaches",
            JumpKind::Several { .. } => "several",
        }
    }

    /// Returns the kind of a jump in which `parts` smaller patches change to a larger one on
    /// loading, or a larger one to smaller ones on unloading. `jumping` is the number of patches
    /// that jump at the same indentation.
    fn new(direction: Direction, parts: u64, jumping: u64) -> Self {
        if jumping > 1 {
            return JumpKind::Several { changes: jumping };
        }
        match (direction, parts) {
            (Direction::Loading, 0) => JumpKind::Touches,
            (Direction::Loading, 1) => JumpKind::Spreads,
            (Direction::Loading, patches) => JumpKind::Merges { patches },
            (Direction::Unloading, 0) => JumpKind::Detaches,
            (Direction::Unloading, 1) => JumpKind::Shrinks,
            (Direction::Unloading, parts) => JumpKind::Splits { parts },
        }
    }
}

impl Jump {
    /// Smallest number of springs that count as a jump of a patch. An edge of a patch that moves
    /// from one spring to the next changes fewer springs at a time; such a motion is a slide and
    /// not a jump.
    pub const LEAST_SPRINGS: i32 = 4;
}

impl StageRecord {
    /// Returns two indentations in m. All events above the first and up to the second happen on
    /// this motion. The first is −∞ if the body touches or separates on the motion, because this
    /// happens at the lower end of the motion or just below it.
    pub fn passed(&self) -> [f64; 2] {
        let is_separated_at_an_end = [self.curve.first(), self.curve.last()]
            .into_iter()
            .flatten()
            .any(|point| point.springs == 0);
        let low = if is_separated_at_an_end {
            f64::NEG_INFINITY
        } else {
            self.start().min(self.end())
        };
        [low, self.start().max(self.end())]
    }
}

impl Stage {
    /// Returns the jumps of the contact at indentations above `low` and up to `high` (m), in the
    /// order of the motion. In a jump at least [`Jump::LEAST_SPRINGS`] springs of a patch attach or
    /// detach. The list is empty without adhesion, because springs then touch without a stretch.
    ///
    /// # Errors
    /// Returns [`ContactError::Stepwise`] if this motion was computed by the [stepwise
    /// solver](crate::motion::Stepwise), which knows the contact only at its steps.
    pub fn jumps(&self, low: f64, high: f64) -> Result<Vec<Jump>, ContactError> {
        self.refuse_stepwise()?;
        let Patches::Runs(tree, runs) = &self.patches else {
            return Ok(Vec::new());
        };
        if self.rule().bears_no_stretch() {
            return Ok(Vec::new());
        }
        let found = along_runs!(self, tree, runs, along => along
            .patch_jumps(low, high, Jump::LEAST_SPRINGS));
        let mut jumps: Vec<Jump> = found.iter().map(|jump| self.jump(jump)).collect();
        if self.direction == Direction::Unloading {
            jumps.reverse();
        }
        Ok(jumps)
    }

    fn jump(&self, found: &PatchJump) -> Jump {
        let mut jump = Jump {
            indentation: found.indentation,
            kind: JumpKind::new(self.direction, found.parts, found.jumping),
            springs: found.springs,
            // Springs gain energy when they attach, and release it when they detach.
            energy: 0.0 - self.energy(found.squared_stretch),
            patches: [found.patches_below, found.patches_at],
            number: found.to_the_left,
            before: found.smaller,
            after: Some(found.larger),
        };
        if self.direction == Direction::Unloading {
            jump.springs = -jump.springs;
            jump.patches.reverse();
            std::mem::swap(&mut jump.before, &mut jump.after);
        }
        jump
    }

    /// Returns the force of the whole contact in N before and after each of the `jumps` of this
    /// motion.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn forces_at_jumps(&self, jumps: &[Jump]) -> Result<Vec<[f64; 2]>, ContactError> {
        let mut indentations = Vec::with_capacity(2 * jumps.len());
        for jump in jumps {
            indentations.push(jump.indentation.next_down());
            indentations.push(jump.indentation);
        }
        indentations.sort_unstable_by(f64::total_cmp);
        let points = self.curve(&indentations)?;
        let force_at = |indentation: f64| {
            let index = points.partition_point(|point| point.indentation < indentation);
            // Adding 0.0 changes −0 to 0.
            points.get(index).map_or(0.0, |point| point.force + 0.0)
        };
        let mut forces = Vec::with_capacity(jumps.len());
        for jump in jumps {
            let below = force_at(jump.indentation.next_down());
            let at = force_at(jump.indentation);
            forces.push(match self.direction {
                Direction::Loading => [below, at],
                Direction::Unloading => [at, below],
            });
        }
        Ok(forces)
    }

    /// Returns the indentations in m at which the force jumps, in ascending order. Only
    /// indentations above `low` and up to `high` (m) are returned. Jumps smaller than about `least`
    /// (N) are left out. Jumps of any number of springs count.
    pub fn force_jumps(&self, low: f64, high: f64, least: f64) -> Vec<f64> {
        let Patches::Runs(tree, runs) = &self.patches else {
            return Vec::new();
        };
        let boundaries = along_runs!(self, tree, runs, along => along.boundaries(low, high));
        let mut jumps = Vec::new();
        for together in
            boundaries.chunk_by(|boundary, next| boundary.indentation == next.indentation)
        {
            if self.force_jump(together) >= least {
                jumps.push(together[0].indentation);
            }
        }
        jumps
    }

    /// Estimates the jump of the force in N for runs that begin or end at one indentation.
    fn force_jump(&self, together: &[Boundary]) -> f64 {
        let mut most = 0;
        let mut change = 0;
        for boundary in together {
            most = most.max(boundary.springs.abs());
            change += boundary.springs;
        }
        // The stretch of the springs that attach or detach is about Δl_max of the largest patch
        // concerned.
        let stretch = self.rule().largest_stretch(f64::from(most));
        self.contact.foundation.spring_stiffness() * stretch * f64::from(change.abs())
    }
}
