//! Extremes and crossings of the force inside one interval of a grid, where edges lie between springs.
//!
//! Between two events the force is convex; at an event, read upwards in d, it falls or stays. An interval is
//! parted at its middle event until the bounds of a part tell that what is sought cannot lie there, or nothing
//! happens inside it.

use super::between::Piece;
use super::edges::EdgeSum;
use crate::contact::law::Standing;
use crate::contact::tally::{GapScale, Tally};

/// Halvings of an interval in which a crossing or a flat place is looked for: enough for any two numbers.
const HALVINGS: usize = 1200;
/// Guesses by interpolation before a crossing is halved down to neighbouring numbers.
const GUESSES: usize = 20;

/// From this indentation on so much is in contact, until the next step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub threshold: f64,
    pub tally: Tally,
}

/// What happens in an interval of indentations.
pub struct Interval<P> {
    scale: GapScale,
    /// The first one at its lowest indentation; then, once they are sorted, its events.
    steps: Vec<Step>,
    /// Pieces that are one anywhere in it.
    pub pieces: Vec<P>,
}

/// What is in contact at the lowest and the highest indentation of a part.
type Ends<'s> = (&'s Standing, &'s Standing);
/// A bound of the force between two ends.
type Bound<'s> = &'s dyn Fn(&Standing, &Standing) -> f64;

impl<P: Piece> Interval<P> {
    /// An interval that begins with this step.
    pub fn new(scale: GapScale, first: Step) -> Self {
        Interval { scale, steps: vec![first], pieces: Vec::new() }
    }

    /// Springs join inside it.
    pub fn joins(&mut self, threshold: f64, joins: Tally) {
        self.steps.push(Step { threshold, tally: joins });
    }

    /// Sorts what has joined: each step then has the tally of all before it and of what joins with it.
    pub fn sort(&mut self) {
        self.steps[1..].sort_unstable_by(|a, b| a.threshold.total_cmp(&b.threshold));
        self.steps.dedup_by(|next, step| {
            let together = next.threshold == step.threshold;
            if together {
                step.tally += next.tally;
            }
            together
        });
        let mut total = Tally::default();
        for step in &mut self.steps {
            total += step.tally;
            step.tally = total;
        }
    }

    fn tally(&self, indentation: f64) -> Tally {
        let above = self.steps.partition_point(|step| step.threshold <= indentation);
        self.steps[above.saturating_sub(1)].tally
    }

    /// What is in contact at an indentation.
    fn at(&self, pieces: &[P], indentation: f64) -> Standing {
        self.standing(pieces, indentation, indentation)
    }

    /// What is in contact at `contact` as it stands at another indentation.
    fn standing(&self, pieces: &[P], contact: f64, indentation: f64) -> Standing {
        let tally = self.tally(contact);
        let mut sum = EdgeSum::default();
        pieces
            .iter()
            .filter(|piece| piece.is_at(contact))
            .for_each(|piece| sum.add(piece.edges(indentation)));
        Standing::of_cells(indentation, tally, sum.total(), &self.scale)
    }

    /// The compression just below `indentation`, as that of what is in contact at `low`.
    fn below(&self, pieces: &[P], low: f64, indentation: f64) -> f64 {
        self.standing(pieces, low, indentation).compression
    }

    /// By how much the compression grows with the indentation, for what is in contact at `low`.
    fn stiffness(&self, pieces: &[P], low: f64, indentation: f64) -> f64 {
        let standing = pieces.iter().filter(|piece| piece.is_at(low));
        self.tally(low).cells() as f64 + standing.map(|piece| piece.stiffness(indentation)).sum::<f64>()
    }

    /// An event inside a part of it, the middle one of all.
    fn middle_event(&self, low: f64, high: f64) -> Option<f64> {
        let first = self.steps.partition_point(|step| step.threshold <= low);
        let end = self.steps.partition_point(|step| step.threshold < high);
        (first < end).then(|| self.steps[first + (end - first) / 2].threshold)
    }

    /// The pieces that matter on a part of it.
    fn part(pieces: &[P], low: f64, high: f64) -> Vec<P> {
        pieces.iter().copied().filter(|piece| piece.from() <= high && piece.to() > low).collect()
    }

    /// Where between `low` and `high` the convex force of what is in contact at `low` is smallest.
    fn flat(&self, pieces: &[P], low: f64, high: f64) -> f64 {
        if self.stiffness(pieces, low, low) >= 0.0 {
            return low;
        }
        if self.stiffness(pieces, low, high) <= 0.0 {
            return high;
        }
        bisect(low, high, |at| self.stiffness(pieces, low, at) >= 0.0)
    }

    /// Makes `best` the smallest force between two ends, both of which it knows already.
    pub fn smallest(&self, ends: Ends<'_>, bound: Bound<'_>, best: &mut Standing) {
        self.smallest_of(&self.pieces, ends, bound, best);
    }

    fn smallest_of(&self, pieces: &[P], (low, high): Ends<'_>, bound: Bound<'_>, best: &mut Standing) {
        let (from, to) = (low.indentation, high.indentation);
        if bound(low, high) >= best.compression || from.next_up() >= to {
            return;
        }
        match self.middle_event(from, to) {
            None => {
                let at = self.flat(pieces, from, to).min(to.next_down());
                self.take(pieces, at, best, |a, b| a < b);
            }
            Some(event) => {
                let middle = self.take(pieces, event, best, |a, b| a < b);
                self.smallest_of(&Self::part(pieces, event, to), (&middle, high), bound, best);
                self.smallest_of(&Self::part(pieces, from, event), (low, &middle), bound, best);
            }
        }
    }

    /// Makes `best` the largest force between two ends, both of which it knows already. Where the force falls
    /// at once, the largest number before counts.
    pub fn largest(&self, ends: Ends<'_>, bound: Bound<'_>, best: &mut Standing) {
        self.largest_of(&self.pieces, ends, bound, best);
    }

    fn largest_of(&self, pieces: &[P], (low, high): Ends<'_>, bound: Bound<'_>, best: &mut Standing) {
        let (from, to) = (low.indentation, high.indentation);
        if bound(low, high) <= best.compression || from.next_up() >= to {
            return;
        }
        match self.middle_event(from, to) {
            None => {
                self.take(pieces, to.next_down(), best, |a, b| a > b);
            }
            Some(event) => {
                let middle = self.take(pieces, event, best, |a, b| a > b);
                self.largest_of(&Self::part(pieces, event, to), (&middle, high), bound, best);
                self.largest_of(&Self::part(pieces, from, event), (low, &middle), bound, best);
            }
        }
    }

    fn take(
        &self,
        pieces: &[P],
        at: f64,
        best: &mut Standing,
        is_better: impl Fn(f64, f64) -> bool,
    ) -> Standing {
        let standing = self.at(pieces, at);
        if is_better(standing.compression, best.compression) {
            *best = standing;
        }
        standing
    }

    /// The smallest indentation above the lower end, up to the higher one, with at least this compression; at
    /// the lower end it is smaller.
    pub fn first_at_least(&self, ends: Ends<'_>, bound: Bound<'_>, wanted: f64) -> Option<f64> {
        self.first_of(&self.pieces, ends, bound, wanted)
    }

    fn first_of(&self, pieces: &[P], (low, high): Ends<'_>, bound: Bound<'_>, wanted: f64) -> Option<f64> {
        if bound(low, high) < wanted {
            return None;
        }
        let (from, to) = (low.indentation, high.indentation);
        match self.middle_event(from, to) {
            None if self.below(pieces, from, to) >= wanted => {
                // Convex and below it at first: it gets there once.
                let found = crossing(from, to, |at| self.below(pieces, from, at) - wanted);
                Some(if found < to || high.compression >= wanted { found } else { to.next_down() })
            }
            None => (high.compression >= wanted).then_some(to),
            Some(event) => {
                let middle = self.at(pieces, event);
                let lower = Self::part(pieces, from, event);
                self.first_of(&lower, (low, &middle), bound, wanted)
                    .or_else(|| self.first_of(&Self::part(pieces, event, to), (&middle, high), bound, wanted))
            }
        }
    }

    /// The largest indentation below the higher end, down to the lower one, with at most this compression; at
    /// the higher end it is larger.
    pub fn last_at_most(&self, ends: Ends<'_>, bound: Bound<'_>, wanted: f64) -> Option<f64> {
        self.last_of(&self.pieces, ends, bound, wanted)
    }

    fn last_of(&self, pieces: &[P], (low, high): Ends<'_>, bound: Bound<'_>, wanted: f64) -> Option<f64> {
        let (from, to) = (low.indentation, high.indentation);
        if bound(low, high) > wanted || from >= to {
            return None;
        }
        match self.middle_event(from, to) {
            None => {
                let flat = self.flat(pieces, from, to);
                if self.below(pieces, from, flat) <= wanted {
                    // It rises from there on: the last place where it has not passed.
                    let passes = |at: f64| self.below(pieces, from, at) - wanted;
                    return Some(if passes(to) > 0.0 { last_before(flat, to, passes) } else { flat });
                }
                (low.compression <= wanted).then_some(from)
            }
            Some(event) => {
                let middle = self.at(pieces, event);
                self.last_of(&Self::part(pieces, event, to), (&middle, high), bound, wanted).or_else(|| {
                    if middle.compression <= wanted {
                        return Some(event);
                    }
                    self.last_of(&Self::part(pieces, from, event), (low, &middle), bound, wanted)
                })
            }
        }
    }
}

/// The smallest number above `low`, up to `high`, of which `is_past` says so; it says so of `high`.
pub fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) { high = middle } else { low = middle }
    }
    high
}

/// The smallest number above `low`, up to `high`, at which `value`, which rises through zero once, is at least
/// zero; at `low` it is below.
pub fn crossing(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = enclose(low, high, &value, |value| value >= 0.0);
    bisect(low, high, |at| value(at) >= 0.0)
}

/// The largest number from `low` on, below `high`, at which `value`, which rises through zero once, is at most
/// zero; at `high` it is above.
pub fn last_before(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (from, to) = enclose(low, high, &value, |value| value > 0.0);
    bisect(from, to, |at| value(at) > 0.0).next_down().max(low)
}

/// Narrows an interval by interpolation: it is still not past at its lower end and past at its higher one.
///
/// The value at an end that has stayed is halved (the Illinois rule), so that both ends move; where this does
/// not narrow the interval fast it is halved as well.
fn enclose(
    mut low: f64,
    mut high: f64,
    value: &impl Fn(f64) -> f64,
    is_past: impl Fn(f64) -> bool,
) -> (f64, f64) {
    let (mut below, mut above) = (value(low), value(high));
    let mut stayed = 0_i32;
    for guess in 0..GUESSES {
        let middle = low + 0.5 * (high - low);
        let between = high - above * ((high - low) / (above - below));
        let at = if guess % 4 != 3 && between > low && between < high { between } else { middle };
        if at <= low || at >= high {
            break;
        }
        let found = value(at);
        if is_past(found) {
            (high, above) = (at, found);
            if stayed > 0 {
                below *= 0.5;
            }
            stayed = 1;
        } else {
            (low, below) = (at, found);
            if stayed < 0 {
                above *= 0.5;
            }
            stayed = -1;
        }
    }
    (low, high)
}
