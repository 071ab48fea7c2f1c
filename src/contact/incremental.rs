//! A body of whole springs in hand: it knows what all of them carry without looking at any.
//!
//! A move that changes k springs of N takes O((k + 1) log N) time, whatever its length and its direction;
//! taking in hand takes O(N).

use super::fragment_set::{Event, FragmentSet};
use super::grid::CompensatedSum;
use super::hand::{Hand, HandContact, HandError};
use super::law::Standing;
use super::{ContactError, EdgeRule, Foundation, SpringTree};
use std::sync::Arc;

/// Whole springs in hand.
pub struct WholeInHand<R>(FragmentSet<R>);

/// A body of whole springs, held in hand.
pub type Incremental<R> = Hand<WholeInHand<R>>;

impl<R: EdgeRule> Incremental<R> {
    /// A body over the springs of this tree (smallest gap 0), separated, at d = 0 just before first touch.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<SpringTree>, rule: R, foundation: Foundation) -> Result<Self, ContactError> {
        Ok(Hand::touching(WholeInHand(FragmentSet::new(tree, rule, &[])?), foundation))
    }

    /// A body that stands at `indentation`, m, in the contact given by first and last spring of each
    /// fragment, as [`super::Solver::fragments`] and [`super::HandHeld::fragments`] give it.
    ///
    /// Of a run that is not a whole subtree, as no fragment in equilibrium can be, the largest whole
    /// subtrees inside it are taken. A contact that is not in equilibrium relaxes with the next move.
    ///
    /// # Errors
    /// [`HandError::NotFinite`], [`ContactError::OutOfMemory`].
    pub fn standing(
        tree: Arc<SpringTree>,
        rule: R,
        foundation: Foundation,
        indentation: f64,
        contacts: &[(usize, usize)],
    ) -> Result<Self, HandError> {
        Hand::standing_at(indentation, foundation, || {
            Ok(WholeInHand(FragmentSet::new(tree, rule, contacts)?))
        })
    }
}

impl<R: EdgeRule> WholeInHand<R> {
    /// Indentation at which what is in contact carries this compression Σ (d − c), m.
    fn indentation_of(&self, compression: f64) -> Option<f64> {
        self.0.tally().indentation(compression, self.0.scale())
    }
}

impl<R: EdgeRule> HandContact for WholeInHand<R> {
    type Rule = R;
    /// Σ of the squared stretches of what has joined or left, m².
    type Notes = CompensatedSum;

    fn set(&self) -> &FragmentSet<R> {
        &self.0
    }

    fn set_mut(&mut self) -> &mut FragmentSet<R> {
        &mut self.0
    }

    fn standing_at(&self, indentation: f64) -> Standing {
        let tally = self.0.tally();
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.springs as f64,
            compression: tally.compression(indentation, self.0.scale()),
        }
    }

    fn begin(&self, _: f64) -> CompensatedSum {
        CompensatedSum::default()
    }

    fn join(&mut self, level: f64, squared_stretch: &mut CompensatedSum) -> Option<Event> {
        let event = self.0.join(level)?;
        squared_stretch.add_sum(event.squared_stretch);
        Some(event)
    }

    fn leave(&mut self, level: f64, squared_stretch: &mut CompensatedSum) -> Option<Event> {
        let event = self.0.leave(level)?;
        squared_stretch.add_sum(event.squared_stretch);
        Some(event)
    }

    fn end(&self, squared_stretch: CompensatedSum, _: f64) -> (f64, u64) {
        (squared_stretch.total(), 0)
    }

    /// The force rises with the springs there are.
    fn rises_to(&self, (from, to): (f64, f64), wanted: f64) -> Option<f64> {
        self.indentation_of(wanted).filter(|&crossing| crossing < to).map(|crossing| crossing.max(from))
    }

    fn falls_to(&self, (from, last): (f64, f64), wanted: f64) -> Result<f64, f64> {
        let compression = self.standing_at(from).compression;
        if compression > wanted {
            return Err(compression);
        }
        Ok(self.indentation_of(wanted).unwrap_or(last).clamp(from, last))
    }

    fn beyond(&self, from: f64, wanted: f64) -> f64 {
        self.indentation_of(wanted).map_or(f64::INFINITY, |crossing| crossing.max(from))
    }
}
