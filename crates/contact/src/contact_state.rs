//! The contact at one indentation and on a grid of indentations, and bounds of the force between
//! two indentations.

use super::adhesive::levels::{EdgeCells, EdgeSum, Slider};
use super::contact::Contact;
use super::detachment::DetachmentRule;
use super::error::ContactError;
use super::history::{CurvePoint, ForcePoint};
use super::totals::{ContactTotals, GapScale};
use asperity_data::resized;
use std::ops::Range;

/// The contact at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    pub indentation: f64,
    pub totals: ContactTotals,
    /// Contact length in units of the spring spacing.
    pub length: f64,
    /// Compression ∫ (d − c) dx in m, where d is the indentation, c the gap, and x is in units of
    /// the spring spacing. The compression is the force divided by the stiffness of one spring.
    pub compression: f64,
    /// Number of whole springs or cells in contact.
    whole: i64,
    /// Share of the edge cells in [`ContactState::squares`].
    squares_of_edges: f64,
}

impl ContactState {
    /// Computes the contact at an indentation in m. If `slides` is true, the contact consists of
    /// the whole cells in `totals` and of the edge cells; otherwise it consists of the springs in
    /// `totals`.
    #[inline]
    pub fn new(
        slides: bool,
        indentation: f64,
        totals: ContactTotals,
        edges: EdgeCells,
        scale: &GapScale,
    ) -> Self {
        let whole = totals.whole(slides);
        ContactState {
            indentation,
            totals,
            length: whole as f64 + edges.length,
            compression: totals.compression(whole, indentation, scale) + edges.compression,
            whole,
            squares_of_edges: edges.squares,
        }
    }

    /// Computes ∫ (d − c)² dx in m², where d is the indentation, c the gap, and x is in units of
    /// the spring spacing. This integral is twice the stored energy divided by the stiffness of one
    /// spring. It takes about as long as the force, which is often all that is needed.
    pub fn squares(&self, scale: &GapScale) -> f64 {
        let squares = self.totals.squares_of(self.whole, self.indentation, scale);
        // A sum of squares is negative only by rounding.
        (squares + self.squares_of_edges).max(0.0)
    }

    /// Returns the state of a separated body at this indentation in m.
    pub fn free(indentation: f64) -> Self {
        ContactState {
            indentation,
            ..ContactState::default()
        }
    }

    /// Returns the sums over the contact and the instrument together. The instrument is represented
    /// by `springs` springs that lie parallel to the contact and are compressed by the indentation
    /// d. The common force is then F + k d, where F is the force of the contact and k the stiffness
    /// of the instrument. An instrument at the displacement D holds the body where the common force
    /// equals k D.
    #[inline]
    pub fn beside(&self, springs: f64) -> Self {
        if springs == 0.0 {
            return *self;
        }
        let compression = self.compression + springs * self.indentation;
        ContactState {
            compression,
            length: self.length + springs,
            ..*self
        }
    }

    /// Returns the point of the force curve of `contact` in this state.
    pub fn point(&self, contact: &Contact) -> CurvePoint {
        let foundation = contact.foundation;
        let squares = self.squares(&contact.profile.springs.scale());
        CurvePoint {
            indentation: self.indentation,
            force: foundation.spring_stiffness() * self.compression,
            contact_length: foundation.contact_length(self.length),
            springs: counted(self.totals.springs),
            patches: counted(self.totals.patches),
            stored_energy: 0.5 * foundation.spring_stiffness() * squares,
        }
    }

    /// Returns the point of the force curve of `contact` in this state, without the stored energy.
    pub fn force_point(&self, contact: &Contact) -> ForcePoint {
        ForcePoint {
            indentation: self.indentation,
            force: contact.foundation.spring_stiffness() * self.compression,
            springs: counted(self.totals.springs),
        }
    }
}

/// Converts a number of springs or patches in contact to an unsigned number.
///
/// # Panics
/// Panics for a negative number, because a negative number must not appear in a result. Such a
/// number occurs only if the sums have a defect.
pub fn counted(number: i64) -> u64 {
    assert!(
        number >= 0,
        "internal error, please report it: {number} springs or patches in contact"
    );
    number.unsigned_abs()
}

/// Sums of the contact at the points of a grid of indentations. The caller adds the parts of the
/// contact one by one, each with the range of points at which the part is in contact.
pub struct Tally {
    pub grid: Grid,
    /// Change of the totals from each point to the next.
    changes: Vec<ContactTotals>,
    /// Sum of the edge cells at each point. Empty if patches consist of whole springs.
    edges: Vec<EdgeSum>,
}

impl Tally {
    pub fn new(grid: Grid, slides: bool) -> Result<Self, ContactError> {
        let count = grid.points.len();
        let changes = resized(Vec::new(), count + 1, ContactTotals::default())?;
        let count_of_sums = if slides { count } else { 0 };
        let edges = resized(Vec::new(), count_of_sums, EdgeSum::default())?;
        Ok(Tally {
            grid,
            changes,
            edges,
        })
    }

    /// Returns the index of the first point of the grid that is at least `indentation` in m. If
    /// there is no such point, returns the number of points.
    #[inline]
    pub fn place(&self, indentation: f64) -> usize {
        if indentation > self.grid.high() {
            self.grid.points.len()
        } else {
            self.grid.first_at_least(indentation)
        }
    }

    /// Returns the range of indentations in m for which [`Tally::place`] returns the index `place`.
    /// The range is given by its two ends. The lower end does not belong to the range; the upper
    /// end does.
    pub fn ends_before(&self, place: usize) -> (f64, f64) {
        let points = &self.grid.points;
        let below = match place {
            0 => f64::NEG_INFINITY,
            _ => points[place - 1],
        };
        let at_most = points.get(place).copied().unwrap_or(f64::INFINITY);
        (below, at_most)
    }

    /// Adds whole springs or cells that are in contact at the point with the index `place` and at
    /// all later points of the grid.
    #[inline]
    pub fn begin(&mut self, place: usize, totals: ContactTotals) {
        self.changes[place] += totals;
    }

    /// Adds whole springs or cells that are in contact at the points of the grid with the indices
    /// `carries`.
    #[inline]
    pub fn add(&mut self, carries: Range<usize>, totals: ContactTotals) {
        self.changes[carries.start] += totals;
        self.changes[carries.end] += -totals;
    }

    /// Adds the edge cells of a patch: the cells at the ends of the patch that are only partly in
    /// contact. The edge cells bear load at the points of the grid with the indices `carries`. They
    /// are computed at each of these points, because their lengths and compressions differ from
    /// point to point.
    #[inline]
    pub fn slide<R: DetachmentRule>(&mut self, carries: Range<usize>, slider: &Slider<R>) {
        let points = &self.grid.points[carries.clone()];
        for (sums, &point) in self.edges[carries].iter_mut().zip(points) {
            sums.add(slider.edge_cells(point));
        }
    }

    /// Returns the contact at each point of the grid.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn finish(self, scale: &GapScale) -> Result<Vec<ContactState>, ContactError> {
        let points = &self.grid.points;
        let slides = !self.edges.is_empty();
        let mut states = resized(Vec::new(), points.len(), ContactState::default())?;
        let mut totals = ContactTotals::default();
        for (index, (state, &point)) in states.iter_mut().zip(points).enumerate() {
            totals += self.changes[index];
            let cells = self.edges.get(index).copied().unwrap_or_default().total();
            *state = ContactState::new(slides, point, totals, cells, scale);
        }
        Ok(states)
    }
}

/// Returns those intervals between neighbouring points of a sampled motion in which a searched
/// point may lie. Each interval is returned as the contacts at its two ends. The function `may_lie`
/// decides from these contacts.
pub fn intervals(
    stage: &[ContactState],
    may_lie: impl Fn(&ContactState, &ContactState) -> bool,
) -> Vec<[ContactState; 2]> {
    let pairs = stage.windows(2).map(|ends| [ends[0], ends[1]]);
    pairs.filter(|[low, high]| may_lie(low, high)).collect()
}

/// The extreme of the force that a search finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extreme {
    Smallest,
    Largest,
}

impl Extreme {
    /// Returns true if the force of `state` is more extreme than the force of `best`. In a search
    /// for the smallest force, this means a smaller force, or an equal force at a smaller
    /// indentation. In a search for the largest force, this means a larger force, or an equal force
    /// at a larger indentation. The indentations decide so that the result of a search does not
    /// depend on the order of its steps.
    pub fn is_beyond(self, state: &ContactState, best: &ContactState) -> bool {
        let order = (state.compression, state.indentation);
        let order_of_best = (best.compression, best.indentation);
        match self {
            Extreme::Smallest => order < order_of_best,
            Extreme::Largest => order_of_best < order,
        }
    }

    /// Returns the contact with the extreme force among the points of a sampled motion. The motion
    /// must have at least one point.
    pub fn among(self, stage: &[ContactState]) -> ContactState {
        let mut best = stage[0];
        for state in stage {
            if self.is_beyond(state, &best) {
                best = *state;
            }
        }
        best
    }

    /// Returns true if a force more extreme than the force of `best` may lie between the
    /// indentations of `low` and `high`. Bounds of the force between the two indentations decide
    /// this.
    pub fn may_lie(self, low: &ContactState, high: &ContactState, best: &ContactState) -> bool {
        match self {
            Extreme::Smallest => lower_bound(low, high) < best.compression,
            Extreme::Largest => upper_bound(low, high) > best.compression,
        }
    }
}

/// Returns a lower bound, in m, of the compression at all indentations between those of `low` and
/// `high`. The compression is the force divided by the stiffness of one spring.
pub fn lower_bound(low: &ContactState, high: &ContactState) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    high.compression - rise - slack(low, high, rise)
}

/// Returns an upper bound, in m, of the compression at all indentations between those of `low` and
/// `high`. The compression is the force divided by the stiffness of one spring.
pub fn upper_bound(low: &ContactState, high: &ContactState) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    low.compression + rise + slack(low, high, rise)
}

/// Returns a bound, in m, of the rounding errors of both compressions and of the bounds made of
/// them.
fn slack(low: &ContactState, high: &ContactState, rise: f64) -> f64 {
    8.0 * f64::EPSILON * (low.compression.abs() + high.compression.abs() + rise)
}

/// Ascending indentations in m, the points at which a motion is evaluated. The points are either
/// given by the caller, or evenly spaced between two exact ends. Between evenly spaced points the
/// last interval may be shorter than the others.
#[derive(Clone, Debug)]
pub struct Grid {
    pub points: Vec<f64>,
    intervals_per_metre: f64,
}

impl Grid {
    /// Creates a grid of `intervals` equal intervals from `low` to `high` in m. If both ends
    /// coincide, the grid is a single point.
    pub fn new(low: f64, high: f64, intervals: usize) -> Self {
        let width = (high - low) / intervals as f64;
        // A range that is too narrow for different points in between has only its two ends as
        // points.
        let even = low + width > low && high - width < high && width.recip().is_finite();
        let mut points = Vec::new();
        if even {
            points.reserve(intervals + 1);
            for k in 0..intervals {
                points.push((low + width * k as f64).min(high));
            }
        } else {
            points.push(low);
        }
        if high > low {
            points.push(high);
        }
        Grid {
            points,
            intervals_per_metre: if even { width.recip() } else { 0.0 },
        }
    }

    /// Creates a grid at these ascending indentations in m, at least one.
    pub fn at(points: Vec<f64>) -> Self {
        Grid {
            points,
            intervals_per_metre: 0.0,
        }
    }

    /// Returns the grid that consists of every `stride`-th point of this grid, from the first, and
    /// of the last point.
    pub fn coarser(&self, stride: usize) -> Self {
        let last = self.points.len() - 1;
        let points = (0..last)
            .step_by(stride)
            .chain([last])
            .map(|index| self.points[index])
            .collect();
        Grid {
            points,
            intervals_per_metre: self.intervals_per_metre / stride as f64,
        }
    }

    /// Returns true if the points are evenly spaced. Returns false for points given by the caller,
    /// and for a grid that has only its two ends.
    pub fn is_even(&self) -> bool {
        self.intervals_per_metre > 0.0
    }

    pub fn high(&self) -> f64 {
        self.points[self.points.len() - 1]
    }

    /// Returns the index of the first point that is at least `indentation` in m. The indentation
    /// must not exceed the last point.
    #[inline]
    pub fn first_at_least(&self, indentation: f64) -> usize {
        if !self.is_even() {
            return self.points.partition_point(|&point| point < indentation);
        }
        // On an even grid, `guess` differs from the result by at most two. The loops correct this
        // difference.
        let guess = ((indentation - self.points[0]) * self.intervals_per_metre) as usize;
        let mut index = guess.min(self.points.len() - 1);
        while self.points[index] < indentation {
            index += 1;
        }
        while index > 0 && self.points[index - 1] >= indentation {
            index -= 1;
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A grid has the requested number of equal intervals and exact ends. The search finds the
        /// same point as a comparison with each point.
        #[test]
        fn points_are_even_and_found(
            low in -1.0..1.0_f64,
            width in prop_oneof![1e-9..1.0_f64, Just(0.0)],
            intervals in 1_usize..70,
            share in 0.0..=1.0_f64,
        ) {
            let high = low + width;
            let grid = Grid::new(low, high, intervals);
            let points = &grid.points;
            prop_assert_eq!((points[0], grid.high()), (low, high));
            prop_assert_eq!(points.len(), if high > low { intervals + 1 } else { 1 });
            for (k, &point) in points.iter().enumerate() {
                let even = low + (high - low) * (k as f64 / intervals as f64);
                prop_assert!((point - even).abs() <= 4.0 * f64::EPSILON, "{} {}", point, even);
            }
            let wanted = points.iter().copied().chain([(low + share * width).min(high), low - 1.0]);
            for wanted in wanted {
                prop_assert_eq!(grid.first_at_least(wanted), points.partition_point(|&point| point < wanted));
            }
        }
    }

    #[test]
    fn a_range_too_narrow_for_its_points_is_its_two_ends() {
        let high = 1.0 + f64::EPSILON;
        assert_eq!(Grid::new(1.0, high, 8).points, [1.0, high]);
        // Here the range is narrower than the reciprocal of the largest floating-point number.
        let high = f64::from_bits(1 << 14);
        let grid = Grid::new(0.0, high, 4);
        assert_eq!(grid.points, [0.0, high]);
        assert_eq!(
            [0.0, 0.5 * high, high].map(|wanted| grid.first_at_least(wanted)),
            [0, 1, 1]
        );
    }
}
