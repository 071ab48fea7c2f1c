//! One interval of indentations of a leg, searched for extremes and crossings of the force.
//!
//! The interval is divided at its middle event until bounds exclude a part or nothing happens inside.

use super::adhesive::{EdgeSum, Slider};
use super::contact_state::{ContactState, Extreme, lower_bound, upper_bound};
use super::crossing::{bisect, crossing, last_before};
use super::totals::{ContactTotals, GapScale};

/// Whole springs or cells in contact from this indentation on, until the next step.
#[derive(Clone, Copy, Debug)]
struct Step {
    threshold: f64,
    totals: ContactTotals,
}

/// A fragment whose edges slide, while it fills one span.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub slider: Slider,
    pub from: f64,
    pub to: f64,
}

/// An interval of indentations and its events.
pub struct Interval {
    slides: bool,
    scale: GapScale,
    /// First its contact at the lowest indentation; then, once sorted, its events.
    steps: Vec<Step>,
    pub pieces: Vec<Piece>,
}

/// Contact at the lowest and at the highest indentation of a part.
pub type Ends<'s> = (&'s ContactState, &'s ContactState);

impl Interval {
    /// An interval with this contact at its lowest indentation, m.
    pub fn new(slides: bool, scale: GapScale, low: f64, totals: ContactTotals) -> Self {
        Interval { slides, scale, steps: vec![Step { threshold: low, totals }], pieces: Vec::new() }
    }

    /// Adds an event at an indentation, m; [`Interval::sort`] follows the last one.
    pub fn add(&mut self, threshold: f64, totals: ContactTotals) {
        self.steps.push(Step { threshold, totals });
    }

    /// Sorts its steps, each with the totals of all before it.
    pub fn sort(&mut self) {
        self.steps[1..].sort_unstable_by(|a, b| a.threshold.total_cmp(&b.threshold));
        self.steps.dedup_by(|next, step| {
            let together = next.threshold == step.threshold;
            if together {
                step.totals += next.totals;
            }
            together
        });
        let mut total = ContactTotals::default();
        for step in &mut self.steps {
            total += step.totals;
            step.totals = total;
        }
    }

    /// Whole springs or cells in contact at an indentation, m.
    pub fn totals(&self, indentation: f64) -> ContactTotals {
        let above = self.steps.partition_point(|step| step.threshold <= indentation);
        self.steps[above.saturating_sub(1)].totals
    }

    /// Contact state at an indentation, m.
    fn at(&self, pieces: &[Piece], indentation: f64) -> ContactState {
        self.steady(pieces, indentation, indentation)
    }

    /// The contact from an indentation on, m, at another one up to the next event: whole springs or cells and the edge
    /// cells of some fragments, none of which jumps, merges or splits. The force is convex in the indentation.
    fn steady(&self, pieces: &[Piece], from: f64, at: f64) -> ContactState {
        let mut edges = EdgeSum::default();
        for piece in pieces.iter().filter(|piece| piece.is_at(from)) {
            edges.add(piece.slider.edge_cells(at));
        }
        ContactState::new(self.slides, at, self.totals(from), edges.total(), &self.scale)
    }

    /// Growth of the compression of a steady contact with the indentation, in cells.
    fn stiffness(&self, pieces: &[Piece], from: f64, at: f64) -> f64 {
        let sliders = pieces.iter().filter(|piece| piece.is_at(from)).map(|piece| piece.slider);
        self.totals(from).whole(self.slides) as f64 + sliders.map(|slider| slider.stiffness(at)).sum::<f64>()
    }

    /// Indentation of the smallest force of a steady contact between two others, m.
    fn flattest(&self, pieces: &[Piece], low: f64, high: f64) -> f64 {
        if self.stiffness(pieces, low, low) >= 0.0 {
            return low;
        }
        if self.stiffness(pieces, low, high) <= 0.0 {
            return high;
        }
        bisect(low, high, |at| self.stiffness(pieces, low, at) >= 0.0)
    }

    /// Indentation of a compression where the force of a steady contact is a straight line, m.
    fn straight(&self, from: f64, compression: f64) -> Option<f64> {
        if self.slides { None } else { self.totals(from).indentation(compression, &self.scale) }
    }

    /// The smallest indentation of a steady contact between two, m, the higher one included, at which the compression is
    /// at least `wanted`; at the lower one it is smaller.
    fn rises_to(&self, pieces: &[Piece], (from, to): (f64, f64), wanted: f64) -> Option<f64> {
        if let Some(straight) = self.straight(from, wanted) {
            return Some(straight.max(from)).filter(|&found| found < to);
        }
        // Convex and below `wanted` at first: one crossing.
        let compression = |at: f64| self.steady(pieces, from, at).compression;
        (compression(to) >= wanted).then(|| crossing(from, to, |at| compression(at) - wanted))
    }

    /// The largest indentation of a steady contact between two, m, both included, at which the compression is at most
    /// `wanted`.
    fn falls_to(&self, pieces: &[Piece], (from, last): (f64, f64), wanted: f64) -> Option<f64> {
        let compression = |at: f64| self.steady(pieces, from, at).compression;
        let flattest = self.flattest(pieces, from, last);
        if compression(flattest) > wanted {
            return None;
        }
        if let Some(straight) = self.straight(from, wanted) {
            return Some(straight.clamp(from, last));
        }
        // The compression rises from there on: the last number at which it has not passed `wanted`.
        let passes = |at: f64| compression(at) - wanted;
        Some(if passes(last) > 0.0 { last_before(flattest, last, passes) } else { last })
    }

    /// The middle one of all events inside a part.
    fn middle_event(&self, low: f64, high: f64) -> Option<f64> {
        let first = self.steps.partition_point(|step| step.threshold <= low);
        let end = self.steps.partition_point(|step| step.threshold < high);
        (first < end).then(|| self.steps[first + (end - first) / 2].threshold)
    }

    /// The pieces that overlap a part.
    fn part(pieces: &[Piece], low: f64, high: f64) -> Vec<Piece> {
        pieces.iter().copied().filter(|piece| piece.from <= high && piece.to > low).collect()
    }

    /// Makes `best` the extreme force between two ends, already covered by `best`.
    pub fn search(&self, extreme: Extreme, pieces: &[Piece], (low, high): Ends<'_>, best: &mut ContactState) {
        let (from, to) = (low.indentation, high.indentation);
        if !extreme.may_lie(low, high, best) || from.next_up() >= to {
            return;
        }
        let take = |at: f64, best: &mut ContactState| {
            let state = self.at(pieces, at);
            if extreme.is_beyond(&state, best) {
                *best = state;
            }
            state
        };
        let Some(event) = self.middle_event(from, to) else {
            let before = to.next_down();
            take(
                match extreme {
                    Extreme::Smallest => self.flattest(pieces, from, to).min(before),
                    // Where the force falls at once, the largest number before counts.
                    Extreme::Largest => before,
                },
                best,
            );
            return;
        };
        let middle = take(event, best);
        self.search(extreme, &Self::part(pieces, event, to), (&middle, high), best);
        self.search(extreme, &Self::part(pieces, from, event), (low, &middle), best);
    }

    /// The smallest indentation above the lower end, up to the higher one, with at least this compression; at the
    /// lower end it is smaller.
    pub fn first_of(&self, pieces: &[Piece], (low, high): Ends<'_>, wanted: f64) -> Option<f64> {
        if upper_bound(low, high) < wanted {
            return None;
        }
        let (from, to) = (low.indentation, high.indentation);
        match self.middle_event(from, to) {
            None => match self.rises_to(pieces, (from, to), wanted) {
                Some(found) if found < to || high.compression >= wanted => Some(found),
                Some(_) => Some(to.next_down()),
                None => (high.compression >= wanted).then_some(to),
            },
            Some(event) => {
                let middle = self.at(pieces, event);
                let lower = Self::part(pieces, from, event);
                self.first_of(&lower, (low, &middle), wanted)
                    .or_else(|| self.first_of(&Self::part(pieces, event, to), (&middle, high), wanted))
            }
        }
    }

    /// The largest indentation below the higher end, down to the lower one, with at most this compression; at the
    /// higher end it is larger.
    pub fn last_of(&self, pieces: &[Piece], (low, high): Ends<'_>, wanted: f64) -> Option<f64> {
        let (from, to) = (low.indentation, high.indentation);
        if lower_bound(low, high) > wanted || from >= to {
            return None;
        }
        match self.middle_event(from, to) {
            None => {
                let before = to.next_down().max(from);
                let found = self.falls_to(pieces, (from, before), wanted);
                found.or_else(|| (low.compression <= wanted).then_some(from))
            }
            Some(event) => {
                let middle = self.at(pieces, event);
                self.last_of(&Self::part(pieces, event, to), (&middle, high), wanted).or_else(|| {
                    if middle.compression <= wanted {
                        return Some(event);
                    }
                    self.last_of(&Self::part(pieces, from, event), (low, &middle), wanted)
                })
            }
        }
    }
}

impl Piece {
    fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}
