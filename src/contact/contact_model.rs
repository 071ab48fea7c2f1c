//! Interface between the exact solver and a contact model: thresholds, forces and extrema along one leg.

use super::contact_state::{ContactState, Extreme, Sampled};
use super::grid::Grid;
use super::totals::ContactTotals;
use super::{AdhesiveMemory, ContactError, LegView, Work};

/// Intervals in which extremes are searched when the curve has fewer samples: each fragment is evaluated at each of
/// their ends.
pub const SEARCH_INTERVALS: usize = 256;

/// An unloading from a turning point of a loading.
#[derive(Clone, Copy, Debug)]
pub struct Reversed {
    /// Smallest indentation with contact, m.
    pub separates: f64,
    /// Σ e² over the springs that attach up to the turning point with a stretch e, and over those that detach from there
    /// on, m².
    pub squared_stretches: [f64; 2],
}

/// Springs loaded and unloaded leg by leg under one rule of contact.
///
/// A leg begins with [`ContactModel::load`] or [`ContactModel::unload`]; all other functions refer to this leg.
pub trait ContactModel {
    /// Springs, in contact or not.
    fn count(&self) -> u64;

    /// Begins a loading leg from this indentation, or from separation, and returns the smallest indentation of full
    /// contact, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the contact is then unchanged.
    fn load(&mut self, from: Option<f64>, work: &mut Work) -> Result<f64, ContactError>;

    /// Begins an unloading leg from this indentation and returns the smallest one with contact, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the contact is then unchanged.
    fn unload(&mut self, from: f64, work: &mut Work) -> Result<f64, ContactError>;

    /// Unloads from this indentation of the present leg, m, which is a loading from separation. The loading stays the
    /// present leg; the next functions refer to this unloading.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn reverse(&mut self, at: f64, work: &mut Work) -> Result<Reversed, ContactError>;

    /// Contact states along a grid of the unloading from a turning point.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_reversal(&self, grid: Grid) -> Result<Sampled, ContactError>;

    /// The smallest force on the range of a grid of this unloading, from separation to the turning point with the given
    /// contact.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn smallest_of_reversal(
        &self,
        grid: &Grid,
        turn: ContactState,
        sorted: &mut u64,
    ) -> Result<ContactState, ContactError>;

    /// Contact states along a grid.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample(&self, grid: Grid) -> Result<Sampled, ContactError>;

    /// Contact states along a grid, and Σ e² over the springs that attach or detach there with a stretch e, m²; those that
    /// do so at its lowest point count only for a body that is `separated` beyond.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_changes(&self, grid: Grid, separated: bool) -> Result<(Sampled, f64), ContactError>;

    /// The extreme force on the grid's range; `sorted` counts the events of the search.
    fn extreme(&self, extreme: Extreme, leg: &Sampled, sorted: &mut u64) -> ContactState;

    /// Contact states at those points of a grid from which [`ContactModel::first_at_least`] proceeds, its ends among
    /// them.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_coarsely(&self, grid: &Grid) -> Result<Sampled, ContactError>;

    /// The smallest indentation of a grid at which the compression is at least `wanted`.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn first_at_least(
        &self,
        grid: &Grid,
        coarse: &Sampled,
        wanted: f64,
        sorted: &mut u64,
    ) -> Result<Option<f64>, ContactError>;

    /// The largest indentation of the range at which the compression is at most `wanted`.
    fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64>;

    /// Indentation at which the totals alone carry a compression, m; `None` if edge cells carry too.
    fn straight(&self, totals: ContactTotals, compression: f64) -> Option<f64>;

    /// Contact at all indentations of the leg.
    fn leg(&self) -> LegView<'_>;

    /// Smallest compression of the unloading from first touch, m, and the work counts of the search.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn pull_off_at_touch(&mut self) -> Result<(f64, Work), ContactError>;

    /// Leaves its memory to the next contact.
    fn give_back(self: Box<Self>, memory: &mut AdhesiveMemory);
}
