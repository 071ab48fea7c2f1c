//! What a body asks of its springs on a leg, whichever way the force of a fragment is read.

use super::grid::Grid;
use super::{ContactError, CurvePoint, Foundation, LegContact, Work};

/// What is in contact at one indentation, and what it comes to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    /// d, m.
    pub indentation: f64,
    /// Springs in contact.
    pub springs: i64,
    /// Fragments they form.
    pub fragments: i64,
    /// Contact length in units of the distance between springs.
    pub length: f64,
    /// Compression ∫ (d − c) dx in units of that distance, m: the force in units of the stiffness of one spring.
    pub compression: f64,
}

impl Standing {
    /// Nothing in contact at this indentation, m.
    pub fn free(indentation: f64) -> Self {
        Standing { indentation, ..Standing::default() }
    }

    /// The point of the curve on this foundation.
    pub fn point(&self, foundation: Foundation) -> CurvePoint {
        CurvePoint {
            indentation: self.indentation,
            force: foundation.spring_stiffness() * self.compression,
            contact_length: foundation.contact_length(self.length),
            springs: self.springs.unsigned_abs(),
            fragments: self.fragments.unsigned_abs(),
        }
    }
}

/// Springs loaded and unloaded leg by leg under one law for their force.
///
/// A leg begins with [`Contact::load`] or [`Contact::unload`]; what is asked afterwards is about this leg.
pub trait Contact {
    /// What is in contact along an even grid of indentations.
    type Leg;

    /// Intervals in which extremes are searched when the curve has fewer samples.
    const SEARCH_INTERVALS: usize;

    /// Springs, in contact or not.
    fn count(&self) -> u64;

    /// Begins a loading leg from this indentation, or from separation, and returns the indentation from which
    /// on everything is in contact, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the contact is then as it was.
    fn load(&mut self, from: Option<f64>, work: &mut Work) -> Result<f64, ContactError>;

    /// Begins an unloading leg from this indentation and returns the smallest one with contact, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the contact is then as it was.
    fn unload(&mut self, from: f64, work: &mut Work) -> Result<f64, ContactError>;

    /// What is in contact along a grid.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample(&self, grid: Grid) -> Result<Self::Leg, ContactError>;

    /// The same and, in units of half the stiffness of one spring, the energy of what joins on a loading leg up
    /// to the end of the grid: from its lowest point on, or whatever joins if the body was `separated`.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_joins(&self, grid: Grid, separated: bool) -> Result<(Self::Leg, f64), ContactError>;

    /// The same of what leaves on an unloading leg down to the lowest point, with what this holds last if the
    /// body `separates`.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_leaves(&self, grid: Grid, separates: bool) -> Result<(Self::Leg, f64), ContactError>;

    /// The grid of a leg.
    fn grid<'l>(&self, leg: &'l Self::Leg) -> &'l Grid;

    /// What is in contact at a point of the grid.
    fn at(&self, leg: &Self::Leg, index: usize) -> Standing;

    /// The smallest force on the grid's range; `sorted` counts the events it took to find it.
    fn smallest(&self, leg: &Self::Leg, sorted: &mut u64) -> Standing;

    /// The largest force on the grid's range.
    fn largest(&self, leg: &Self::Leg, sorted: &mut u64) -> Standing;

    /// The smallest indentation of the range at which the compression is at least `wanted`.
    fn first_at_least(&self, leg: &Self::Leg, wanted: f64, sorted: &mut u64) -> Option<f64>;

    /// The largest indentation of the range at which the compression is at most `wanted`.
    fn last_at_most(&self, leg: &Self::Leg, wanted: f64, sorted: &mut u64) -> Option<f64>;

    /// The indentation at which the compression is `wanted`, beyond the end of the grid, where everything is in
    /// contact.
    fn beyond(&self, leg: &Self::Leg, wanted: f64) -> Option<f64>;

    /// See [`super::Solver::thresholds_along_line`].
    fn thresholds_along_line(&self, out: &mut Vec<f64>);

    /// See [`super::Solver::copy_leg`].
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError>;

    /// See [`super::Solver::fragments`].
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)>;
}
