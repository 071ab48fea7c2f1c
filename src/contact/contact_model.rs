//! Interface between the exact solver and a contact model: thresholds, forces and extrema along one leg.

use super::grid::Grid;
use super::totals::ContactTotals;
use super::{ContactError, CurvePoint, Foundation, LegContact, Work};

/// Contact state at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
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

impl ContactState {
    /// Nothing in contact at this indentation, m.
    pub fn free(indentation: f64) -> Self {
        ContactState { indentation, ..ContactState::default() }
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

/// Contact at each point of a grid, at least one.
pub struct Sampled {
    pub grid: Grid,
    /// Totals of the full springs or cells at each point.
    pub totals: Vec<ContactTotals>,
    pub states: Vec<ContactState>,
}

impl Sampled {
    /// The points of both grids, which have none in common.
    pub fn merged(self, other: Sampled) -> Sampled {
        let [mut here, mut there] = [self, other].map(|Sampled { grid, totals, states }| {
            let points = grid.points().to_vec().into_iter();
            points.zip(totals.into_iter().zip(states)).peekable()
        });
        let (mut points, mut totals, mut states) = (Vec::new(), Vec::new(), Vec::new());
        loop {
            let is_first = match (here.peek(), there.peek()) {
                (Some(one), Some(other)) => one.0 <= other.0,
                (None, None) => break,
                (one, _) => one.is_some(),
            };
            if let Some((point, (total, state))) = if is_first { here.next() } else { there.next() } {
                points.push(point);
                totals.push(total);
                states.push(state);
            }
        }
        Sampled { grid: Grid::at(points), totals, states }
    }

    /// State at the lowest indentation.
    pub fn first(&self) -> ContactState {
        self.states[0]
    }

    /// State at the highest indentation.
    pub fn last(&self) -> ContactState {
        self.states[self.states.len() - 1]
    }

    /// The intervals of the grid for which the contact at their ends allows it.
    pub fn choose(&self, may_lie: impl Fn(&ContactState, &ContactState) -> bool) -> Vec<usize> {
        let ends = self.states.windows(2).enumerate();
        ends.filter(|(_, ends)| may_lie(&ends[0], &ends[1])).map(|(index, _)| index).collect()
    }

    /// Contact at the ends of an interval of the grid.
    pub fn ends(&self, interval: usize) -> (&ContactState, &ContactState) {
        (&self.states[interval], &self.states[interval + 1])
    }
}

/// Springs loaded and unloaded leg by leg under one rule of contact.
///
/// A leg begins with [`ContactModel::load`] or [`ContactModel::unload`]; all other functions refer to this leg.
pub trait ContactModel {
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

    /// Begins the unloadings from these turning points of the present leg, which is a loading from separation, m, in
    /// ascending order.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn begin_reversals(&mut self, turns: &[f64]) -> Result<(), ContactError>;

    /// Unloads from the turning point of this number and indentation (m), all in ascending order. Returns the smallest
    /// indentation with contact, m. The loading stays the present leg; the next functions refer to this unloading.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn reverse(&mut self, turn: (usize, f64), work: &mut Work) -> Result<f64, ContactError>;

    /// Contact states along a grid of the unloading from a turning point.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn sample_reversal(&self, grid: Grid) -> Result<Sampled, ContactError>;

    /// The smallest force on the range of a grid of this unloading.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn smallest_of_reversal(&self, grid: &Grid, sorted: &mut u64) -> Result<ContactState, ContactError>;

    /// Σ e² over the springs that attach up to the turning point with a stretch e, and over those that detach from there
    /// on, m².
    fn squared_stretches(&self) -> [f64; 2];

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

    /// The smallest force on the grid's range; `sorted` counts the events it took to find it.
    fn smallest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState;

    /// The largest force on the grid's range.
    fn largest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState;

    /// The smallest indentation of the range at which the compression is at least `wanted`.
    fn first_at_least(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64>;

    /// The largest indentation of the range at which the compression is at most `wanted`.
    fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64>;

    /// Indentation at which the totals alone carry a compression, where nothing else does, m.
    fn straight(&self, totals: ContactTotals, compression: f64) -> Option<f64>;

    /// See [`super::Solver::thresholds_along_line`].
    fn thresholds_along_line(&self, out: &mut Vec<f64>);

    /// See [`super::Solver::copy_leg`].
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError>;

    /// See [`super::Solver::rises`].
    fn rises(&self, indentation: f64) -> Vec<f64>;

    /// See [`super::Solver::fragments`].
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)>;
}
