//! Intervals of the indentations of a motion, in which extremes and crossings of the force are
//! searched.
//!
//! An interval is divided at its middle event, until the bounds of the force exclude a part or a
//! part has no event inside.

use super::adhesive::levels::{EdgeSum, Slider};
use super::contact_state::{ContactState, Extreme, lower_bound, upper_bound};
use super::totals::{ContactTotals, GapScale};
use std::ops::Range;
use std::rc::Rc;

/// Totals of the whole springs or cells in contact from this indentation up to the next step.
#[derive(Clone, Copy, Debug)]
struct Step {
    threshold: f64,
    totals: ContactTotals,
}

/// Edge cells of a patch over the indentations at which it fills one span.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub slider: Slider,
    pub from: f64,
    pub to: f64,
}

/// Part of a motion between two indentations, with the events inside.
pub struct Interval {
    slides: bool,
    /// The instrument as a number of springs parallel to the contact; see [`ContactState::beside`].
    instrument: f64,
    scale: GapScale,
    /// The contact at the lowest indentation, then the events; sorted by [`Interval::sort`].
    steps: Rc<Vec<Step>>,
    pieces: Vec<Piece>,
    /// Contact at the lowest and at the highest indentation.
    low: ContactState,
    high: ContactState,
}

/// Ascending intervals of a sampled motion in which a force is searched, at least one.
pub struct Intervals(Vec<Interval>);

impl Intervals {
    /// Creates intervals from the contact at both ends of each. `instrument` is a number of springs
    /// parallel to the contact.
    pub fn new(ends: &[[ContactState; 2]], slides: bool, scale: GapScale, instrument: f64) -> Self {
        let of = |&[low, high]: &[ContactState; 2]| {
            let steps = Rc::new(vec![Step {
                threshold: low.indentation,
                totals: low.totals,
            }]);
            Interval {
                slides,
                instrument,
                scale,
                steps,
                pieces: Vec::new(),
                low,
                high,
            }
        };
        Intervals(ends.iter().map(of).collect())
    }

    pub fn ends(&self) -> (f64, f64) {
        (
            self.0[0].low.indentation,
            self.0[self.0.len() - 1].high.indentation,
        )
    }

    /// Returns the index range of the intervals that overlap the indentations from `from` to `to`
    /// in m.
    pub fn between(&self, from: f64, to: f64) -> Range<usize> {
        let first = self
            .0
            .partition_point(|interval| interval.high.indentation < from);
        let end = self
            .0
            .partition_point(|interval| interval.low.indentation < to);
        // A part without extent may end a rounding before it begins.
        first..end.max(first)
    }

    /// Adds springs or cells that are in contact from one indentation up to another in m.
    pub fn add_events(&mut self, from: f64, to: f64, totals: ContactTotals) {
        for (threshold, totals) in [(from, totals), (to, -totals)] {
            // At most one, which does not begin there.
            let range = self.between(threshold, threshold);
            for interval in &mut self.0[range] {
                Rc::make_mut(&mut interval.steps).push(Step { threshold, totals });
            }
        }
    }

    pub fn add_piece(&mut self, piece: Piece) {
        let range = self.between(piece.from, piece.to);
        self.0[range]
            .iter_mut()
            .for_each(|interval| interval.pieces.push(piece));
    }

    /// Returns the intervals with sorted events, and adds the number of events to `sorted`.
    pub fn finish(mut self, sorted: &mut u64) -> Vec<Interval> {
        for interval in &mut self.0 {
            *sorted += interval.steps.len() as u64 - 1;
            interval.sort();
        }
        self.0
    }
}

impl Interval {
    /// Sorts the events; each step then has the totals of all steps up to it.
    fn sort(&mut self) {
        let steps = Rc::make_mut(&mut self.steps);
        steps[1..].sort_unstable_by(|a, b| a.threshold.total_cmp(&b.threshold));
        steps.dedup_by(|next, step| {
            let together = next.threshold == step.threshold;
            if together {
                step.totals += next.totals;
            }
            together
        });
        let mut total = ContactTotals::default();
        for step in steps {
            total += step.totals;
            step.totals = total;
        }
    }

    fn ends(&self) -> (f64, f64) {
        (self.low.indentation, self.high.indentation)
    }

    /// Returns the whole springs or cells in contact at an indentation in m.
    fn totals(&self, indentation: f64) -> ContactTotals {
        let above = self
            .steps
            .partition_point(|step| step.threshold <= indentation);
        self.steps[above.saturating_sub(1)].totals
    }

    fn sliders(&self, indentation: f64) -> impl Iterator<Item = Slider> {
        self.pieces
            .iter()
            .filter(move |piece| piece.is_at(indentation))
            .map(|piece| piece.slider)
    }

    /// Returns the contact at the indentation `at` (m), if no event lies between `from` and `at`:
    /// no edge jumps, and no patch merges or splits. The force is convex in `at`.
    fn steady(&self, from: f64, at: f64) -> ContactState {
        let mut edges = EdgeSum::default();
        self.sliders(from)
            .for_each(|slider| edges.add(slider.edge_cells(at)));
        ContactState::new(
            self.slides,
            at,
            self.totals(from),
            edges.total(),
            &self.scale,
        )
        .beside(self.instrument)
    }

    /// Returns the derivative of the compression with respect to the indentation, in cells, at `at`
    /// in m, if no event lies between the lower end and `at`.
    fn stiffness(&self, at: f64) -> f64 {
        let from = self.low.indentation;
        let edges: f64 = self.sliders(from).map(|slider| slider.stiffness(at)).sum();
        self.totals(from).whole(self.slides) as f64 + edges + self.instrument
    }

    /// Returns the indentation in m of the smallest force between the lower end and `last`, if no
    /// event lies between.
    fn flattest(&self, last: f64) -> f64 {
        let low = self.low.indentation;
        if self.stiffness(low) >= 0.0 {
            return low;
        }
        if self.stiffness(last) <= 0.0 {
            last
        } else {
            bisect(low, last, |at| self.stiffness(at) >= 0.0)
        }
    }

    /// Returns the contact at the middle event inside; `None` without an event.
    fn middle(&self) -> Option<ContactState> {
        let ((low, high), steps) = (self.ends(), &self.steps);
        let first = steps.partition_point(|step| step.threshold <= low);
        let end = steps.partition_point(|step| step.threshold < high);
        (first < end)
            .then(|| steps[first + (end - first) / 2].threshold)
            .map(|event| self.steady(event, event))
    }

    fn between(&self, low: ContactState, high: ContactState) -> Self {
        let overlaps =
            |piece: &&Piece| piece.from <= high.indentation && piece.to > low.indentation;
        let pieces = self.pieces.iter().filter(overlaps).copied().collect();
        Interval {
            steps: Rc::clone(&self.steps),
            pieces,
            low,
            high,
            ..*self
        }
    }

    /// Replaces `best` by the contact of the extreme force inside, if its force is beyond `best`.
    /// No force at an end is beyond `best`.
    pub fn extreme(&self, extreme: Extreme, best: &mut ContactState) {
        let (from, to) = self.ends();
        if !extreme.may_lie(&self.low, &self.high, best) || from.next_up() >= to {
            return;
        }
        let mut take = |state| {
            if extreme.is_beyond(&state, best) {
                *best = state;
            }
        };
        let Some(middle) = self.middle() else {
            let before = to.next_down();
            let at = match extreme {
                Extreme::Smallest => self.flattest(to).min(before),
                // Where the force falls at once, the largest number before counts.
                Extreme::Largest => before,
            };
            return take(self.steady(from, at));
        };
        take(middle);
        self.between(middle, self.high).extreme(extreme, best);
        self.between(self.low, middle).extreme(extreme, best);
    }

    /// Computes ∫ |C − E| dd over the interval in cells times m², on loading (`loads`) or
    /// unloading. C is the compression of contact and instrument. E is its extreme so far, the
    /// largest on loading and the smallest on unloading. Where C turns back from E the body jumps.
    pub fn jumped(&self, loads: bool, extreme: &mut f64) -> f64 {
        if let Some(middle) = self.middle() {
            let [low, high] = [
                self.between(self.low, middle),
                self.between(middle, self.high),
            ];
            let [first, second] = if loads { [low, high] } else { [high, low] };
            return first.jumped(loads, extreme) + second.jumped(loads, extreme);
        }
        let (from, to) = self.ends();
        let compression = |at: f64| self.steady(from, at).compression;
        // The compression is convex: it falls up to here, and rises beyond.
        let flattest = self.flattest(to);
        if loads {
            let [start, end] = [from, to].map(compression);
            *extreme = extreme.max(start);
            // It is behind up to where it is back at the extreme.
            let level = *extreme;
            *extreme = level.max(end);
            return match () {
                () if flattest <= from && start >= level => 0.0,
                () if end <= level => level * (to - from) - self.work(from, to),
                () => {
                    let back = crossing(from, to, |at| compression(at) - level);
                    level * (back - from) - self.work(from, back)
                }
            };
        }
        let (level, least) = (*extreme, compression(flattest));
        if least >= level {
            return self.work(from, to) - level * (to - from);
        }
        let back = match compression(to) > level {
            true => last_before(flattest, to, |at| compression(at) - level),
            false => to,
        };
        *extreme = least;
        (self.work(back, to) - level * (to - back))
            + (self.work(from, flattest) - least * (flattest - from))
    }

    /// Computes ∫ C dd over a range of indentations in m without an event inside, where C is the
    /// compression. The integral is half of the growth of ∫ (d − c)² dx minus the squared stretch
    /// with which springs attach at the sliding edges.
    fn work(&self, low: f64, high: f64) -> f64 {
        let from = self.low.indentation;
        let surface = |at: f64| {
            self.sliders(from)
                .map(|slider| slider.surface(at))
                .sum::<f64>()
        };
        let squares = self.steady(from, high).squares - self.steady(from, low).squares;
        0.5 * (squares - (surface(high) - surface(low))
            + self.instrument * (high - low) * (high + low))
    }

    /// Returns the smallest indentation in the interval with at least this compression. The
    /// compression at the lower end is smaller.
    pub fn first_at_least(&self, wanted: f64) -> Option<f64> {
        if upper_bound(&self.low, &self.high) < wanted {
            return None;
        }
        if let Some(middle) = self.middle() {
            let lower = self.between(self.low, middle).first_at_least(wanted);
            return lower.or_else(|| self.between(middle, self.high).first_at_least(wanted));
        }
        // Convex and below `wanted` at first: one crossing.
        let (from, to) = self.ends();
        let passes = |at: f64| self.steady(from, at).compression - wanted;
        let found = (passes(to) >= 0.0)
            .then(|| crossing(from, to, passes))
            .filter(|&found| found < to);
        found.or_else(|| (self.high.compression >= wanted).then_some(to))
    }

    /// Returns the largest indentation in the interval with at most this compression. The
    /// compression at the upper end is larger.
    pub fn last_at_most(&self, wanted: f64) -> Option<f64> {
        let (from, to) = self.ends();
        if lower_bound(&self.low, &self.high) > wanted || from >= to {
            return None;
        }
        if let Some(middle) = self.middle() {
            let upper = self.between(middle, self.high).last_at_most(wanted);
            return upper.or_else(|| {
                let at_middle = (middle.compression <= wanted).then_some(middle.indentation);
                at_middle.or_else(|| self.between(self.low, middle).last_at_most(wanted))
            });
        }
        let last = to.next_down().max(from);
        let passes = |at: f64| self.steady(from, at).compression - wanted;
        let flattest = self.flattest(last);
        if passes(flattest) > 0.0 {
            return (self.low.compression <= wanted).then_some(from);
        }
        // The compression rises from there on: the last number at which it has not passed `wanted`.
        Some(if passes(last) > 0.0 {
            last_before(flattest, last, passes)
        } else {
            last
        })
    }
}

impl Piece {
    fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}

/// Largest number of halvings of an interval in a search, more than any two floating-point numbers
/// need.
const HALVINGS: usize = 2200;
/// Number of guesses by interpolation before a crossing is searched by halving alone.
const GUESSES: usize = 20;

/// Finds the smallest number in (low, high] for which `is_past` is true; `is_past(high)` is true.
pub fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}

/// Finds the smallest number in (low, high] at which `value` is at least zero. `value` rises
/// through zero once; at `low` it is negative.
pub fn crossing(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = enclose(low, high, &value, |value| value >= 0.0);
    bisect(low, high, |at| value(at) >= 0.0)
}

/// Finds the largest number in \[low, high) at which `value` is at most zero. `value` rises through
/// zero once; at `high` it is positive.
pub fn last_before(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (from, to) = enclose(low, high, &value, |value| value > 0.0);
    bisect(from, to, |at| value(at) > 0.0).next_down().max(low)
}

/// Narrows an interval around a crossing by interpolation. Its lower end stays before the crossing,
/// its upper end past it.
///
/// The value at an end that stays is halved (the Illinois rule), so that both ends move. An
/// interval that narrows slowly is halved as well.
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
        let at = if guess % 4 != 3 && between > low && between < high {
            between
        } else {
            middle
        };
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Zeros are found to the last place, in far fewer evaluations in total than the fifty-odd of
    /// halving.
    #[test]
    fn a_rising_zero_is_found_in_few_evaluations() {
        let evaluations = Cell::new(0);
        let mut zeros = 0;
        for root in (1..100).map(|k| f64::from(k) / 100.0) {
            for bend in [0.0, 1.0, 10.0] {
                let value = |at: f64| {
                    evaluations.set(evaluations.get() + 1);
                    (at - root) * (1.0 + bend * (at + 0.5))
                };
                let found = crossing(-0.5, 1.0, value);
                assert!(value(found) >= 0.0 && value(found.next_down()) < 0.0);
                let before = last_before(-0.5, 1.0, value);
                assert!(value(before) <= 0.0 && value(before.next_up()) > 0.0);
                zeros += 2;
            }
        }
        assert!(
            evaluations.get() <= 40 * zeros,
            "{} evaluations for {zeros} zeros",
            evaluations.get()
        );
    }
}
