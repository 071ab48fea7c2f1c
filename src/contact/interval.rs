//! One interval of indentations of a leg, searched for extremes and crossings of the force.
//!
//! The interval is parted at its middle event until bounds exclude a part or nothing happens inside.

use super::adhesive::Slider;
use super::contact_state::{ContactState, Extreme, lower_bound, upper_bound};
use super::steady::{SteadyContact, state};
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

    /// Contact state at an indentation.
    fn at(&self, pieces: &[Piece], indentation: f64) -> ContactState {
        let there = pieces.iter().filter(|piece| piece.is_at(indentation)).map(|piece| piece.slider);
        state(self.slides, &self.scale, self.totals(indentation), there, indentation)
    }

    /// The contact from an indentation up to the next event.
    fn steady(&self, pieces: &[Piece], indentation: f64) -> SteadyContact {
        let there = pieces.iter().filter(|piece| piece.is_at(indentation));
        let (slides, scale, totals) = (self.slides, self.scale, self.totals(indentation));
        SteadyContact { slides, scale, totals, sliders: there.map(|piece| piece.slider).collect() }
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
                    Extreme::Smallest => self.steady(pieces, from).flattest(from, to).min(before),
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
            None => match self.steady(pieces, from).rises_to((from, to), wanted) {
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
                let found = self.steady(pieces, from).falls_to((from, before), wanted);
                found.ok().or_else(|| (low.compression <= wanted).then_some(from))
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
