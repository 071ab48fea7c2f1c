//! Extremes and crossings of the force along a leg, exact whatever the number of samples.
//!
//! Between two events the force is convex; at an event, read upwards in d, it falls or stays. From the contact at two
//! indentations follow bounds of the force between them: what attaches there is stretched, or just touches and is then
//! compressed by no more than the interval is wide. Only intervals of a grid whose bounds allow it are looked into,
//! and such an interval is parted at its middle event until bounds exclude a part or nothing happens inside.

use super::curve::Sampled;
use super::edge_model::{EdgeCells, EdgeModel};
use super::run::{Ground, Run};
use crate::contact::contact_model::ContactState;
use crate::contact::grid::CompensatedSum;
use crate::contact::totals::{ContactTotals, GapScale};

/// Halvings of an interval in which a crossing or a flat place is looked for: enough for any two numbers.
const HALVINGS: usize = 2200;
/// Guesses by interpolation before a crossing is halved down to neighbouring numbers.
const GUESSES: usize = 20;

/// From this indentation on so much is whole in contact, until the next step.
#[derive(Clone, Copy, Debug)]
struct Step {
    threshold: f64,
    totals: ContactTotals,
}

/// A fragment whose edges slide, while it fills one span.
#[derive(Clone, Copy, Debug)]
struct Piece<S> {
    slider: S,
    from: f64,
    to: f64,
}

/// An interval of indentations and its events.
struct Interval<E: EdgeModel> {
    edges: E,
    scale: GapScale,
    /// The first one at its lowest indentation; then, once they are sorted, its events.
    steps: Vec<Step>,
    pieces: Vec<Piece<E::Slider>>,
}

/// Contact at the lowest and at the highest indentation of a part.
type Ends<'s> = (&'s ContactState, &'s ContactState);

/// A leg that is searched.
pub struct Search<'a, E> {
    pub ground: Ground<'a, E>,
    pub runs: &'a [Run],
    pub unloading: bool,
}

impl<E: EdgeModel> Search<'_, E> {
    /// The smallest force on the range of a grid.
    pub fn smallest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let smaller = |best: ContactState, next: &ContactState| {
            if next.compression < best.compression { *next } else { best }
        };
        let mut best = leg.states.iter().fold(leg.states[0], smaller);
        let chosen = leg.choose(|low, high| lower_bound(low, high) < best.compression);
        for (&index, interval) in chosen.iter().zip(&self.intervals(leg, &chosen, sorted)) {
            interval.smallest(&interval.pieces, leg.ends(index), &mut best);
        }
        best
    }

    /// The largest force on the range of a grid.
    pub fn largest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let last = leg.states[leg.states.len() - 1];
        let larger = |best: ContactState, next: &ContactState| {
            if next.compression > best.compression { *next } else { best }
        };
        let mut best = leg.states.iter().rev().fold(last, larger);
        let chosen = leg.choose(|low, high| upper_bound(low, high) > best.compression);
        for (&index, interval) in chosen.iter().zip(&self.intervals(leg, &chosen, sorted)).rev() {
            interval.largest(&interval.pieces, leg.ends(index), &mut best);
        }
        best
    }

    /// The smallest indentation of a grid, m, at which the compression is at least `wanted`.
    pub fn first_at_least(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        // Behind the first point that has it nothing is sought.
        let reached = leg.states.iter().position(|state| state.compression >= wanted);
        if reached == Some(0) {
            return Some(leg.states[0].indentation);
        }
        let end = reached.map(|index| leg.states[index].indentation);
        let last = end.unwrap_or(f64::INFINITY);
        let chosen = leg.choose(|low, high| high.indentation <= last && upper_bound(low, high) >= wanted);
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals);
        found
            .find_map(|(&index, interval)| interval.first_of(&interval.pieces, leg.ends(index), wanted))
            .or(end)
    }

    /// The largest indentation of a grid, m, at which the compression is at most `wanted`.
    pub fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        let reached = leg.states.iter().rposition(|state| state.compression <= wanted);
        let start = reached.map(|index| leg.states[index].indentation);
        if reached == Some(leg.states.len() - 1) {
            return start;
        }
        let first = start.unwrap_or(f64::NEG_INFINITY);
        let chosen = leg.choose(|low, high| low.indentation >= first && lower_bound(low, high) <= wanted);
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals).rev();
        found
            .find_map(|(&index, interval)| interval.last_of(&interval.pieces, leg.ends(index), wanted))
            .or(start)
    }

    /// Events in each of these ascending intervals.
    fn intervals(&self, leg: &Sampled, chosen: &[usize], sorted: &mut u64) -> Vec<Interval<E>> {
        let points = leg.grid.points();
        let mut marks = vec![None; points.len() - 1];
        let mut intervals: Vec<_> = chosen
            .iter()
            .enumerate()
            .map(|(place, &index)| {
                marks[index] = Some(place);
                let first = Step { threshold: points[index], totals: leg.totals[index] };
                let (edges, scale) = (self.ground.edges, self.ground.tree.scale());
                Interval { edges, scale, steps: vec![first], pieces: Vec::new() }
            })
            .collect();
        let (Some(&first), Some(&last)) = (chosen.first(), chosen.last()) else { return intervals };
        let (low, high) = (points[first], points[last + 1]);
        let above = |value: f64| leg.grid.first_at_least(value.min(high));
        for run in self.runs.iter().filter(|run| run.from <= high && run.to > low) {
            let range = above(run.from).saturating_sub(1).max(first)..above(run.to).min(last + 1);
            if marks[range].iter().all(Option::is_none) {
                continue;
            }
            self.ground.each_span(run, self.unloading, |span, from, to| {
                if from > high || to <= low {
                    return from > high;
                }
                let totals = self.ground.totals(span);
                for (threshold, totals) in [(from, totals), (to, -totals)] {
                    if threshold > low
                        && threshold <= high
                        && let Some(place) = marks[above(threshold) - 1]
                    {
                        intervals[place].steps.push(Step { threshold, totals });
                        *sorted += 1;
                    }
                }
                if E::SLIDES {
                    let piece = Piece { slider: self.ground.edges.slider(self.ground.gaps, span), from, to };
                    // Intervals from below its beginning to above its end.
                    let from = above(from).saturating_sub(1).max(first);
                    for place in marks[from..above(to).min(last + 1)].iter().flatten() {
                        intervals[*place].pieces.push(piece);
                    }
                }
                false
            });
        }
        intervals.iter_mut().for_each(Interval::sort);
        intervals
    }
}

impl Sampled {
    /// The intervals of the grid for which the contact at their ends allows it.
    fn choose(&self, may_lie: impl Fn(&ContactState, &ContactState) -> bool) -> Vec<usize> {
        let ends = self.states.windows(2).enumerate();
        ends.filter(|(_, ends)| may_lie(&ends[0], &ends[1])).map(|(index, _)| index).collect()
    }

    fn ends(&self, interval: usize) -> Ends<'_> {
        (&self.states[interval], &self.states[interval + 1])
    }
}

/// A bound below any force between two indentations.
fn lower_bound(low: &ContactState, high: &ContactState) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    high.compression - rise - slack(low, high, rise)
}

/// A bound above.
fn upper_bound(low: &ContactState, high: &ContactState) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    low.compression + rise + slack(low, high, rise)
}

/// Bound of the rounding of a bound.
fn slack(low: &ContactState, high: &ContactState, rise: f64) -> f64 {
    8.0 * f64::EPSILON * (low.compression.abs() + high.compression.abs() + rise)
}

impl<E: EdgeModel> Interval<E> {
    /// Sorts its steps, each with the totals of all before it.
    fn sort(&mut self) {
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

    fn totals(&self, indentation: f64) -> ContactTotals {
        let above = self.steps.partition_point(|step| step.threshold <= indentation);
        self.steps[above.saturating_sub(1)].totals
    }

    /// The contact at an indentation.
    fn at(&self, pieces: &[Piece<E::Slider>], indentation: f64) -> ContactState {
        self.state(pieces, indentation, indentation)
    }

    /// The contact at the indentation `contact` as it carries at another one.
    fn state(&self, pieces: &[Piece<E::Slider>], contact: f64, indentation: f64) -> ContactState {
        let (mut length, mut compression) = (CompensatedSum::default(), CompensatedSum::default());
        for piece in pieces.iter().filter(|piece| piece.is_at(contact)) {
            let cells = self.edges.edge_cells(&piece.slider, indentation);
            length.add(cells.length);
            compression.add(cells.compression);
        }
        let cells = EdgeCells { length: length.total(), compression: compression.total() };
        self.edges.state(indentation, self.totals(contact), cells, &self.scale)
    }

    /// The compression just below `indentation`, as that of the contact at `low`.
    fn below(&self, pieces: &[Piece<E::Slider>], low: f64, indentation: f64) -> f64 {
        self.state(pieces, low, indentation).compression
    }

    /// Growth of the compression with the indentation for the contact at `low`.
    fn stiffness(&self, pieces: &[Piece<E::Slider>], low: f64, indentation: f64) -> f64 {
        let there = pieces.iter().filter(|piece| piece.is_at(low));
        let of_edges = there.map(|piece| self.edges.edge_stiffness(&piece.slider, indentation));
        self.edges.stiffness(self.totals(low)) + of_edges.sum::<f64>()
    }

    /// The middle event of all inside a part.
    fn middle_event(&self, low: f64, high: f64) -> Option<f64> {
        let first = self.steps.partition_point(|step| step.threshold <= low);
        let end = self.steps.partition_point(|step| step.threshold < high);
        (first < end).then(|| self.steps[first + (end - first) / 2].threshold)
    }

    /// The pieces that matter on a part.
    fn part(pieces: &[Piece<E::Slider>], low: f64, high: f64) -> Vec<Piece<E::Slider>> {
        pieces.iter().copied().filter(|piece| piece.from <= high && piece.to > low).collect()
    }

    /// Indentation of the smallest force between `low` and `high`, m; the force of the contact at `low` is convex.
    fn flat(&self, pieces: &[Piece<E::Slider>], low: f64, high: f64) -> f64 {
        if self.stiffness(pieces, low, low) >= 0.0 {
            return low;
        }
        if self.stiffness(pieces, low, high) <= 0.0 {
            return high;
        }
        bisect(low, high, |at| self.stiffness(pieces, low, at) >= 0.0)
    }

    /// Makes `best` the smallest force between two ends, both of which it knows already.
    fn smallest(&self, pieces: &[Piece<E::Slider>], (low, high): Ends<'_>, best: &mut ContactState) {
        let (from, to) = (low.indentation, high.indentation);
        if lower_bound(low, high) >= best.compression || from.next_up() >= to {
            return;
        }
        match self.middle_event(from, to) {
            None => {
                let at = self.flat(pieces, from, to).min(to.next_down());
                self.take(pieces, at, best, |a, b| a < b);
            }
            Some(event) => {
                let middle = self.take(pieces, event, best, |a, b| a < b);
                self.smallest(&Self::part(pieces, event, to), (&middle, high), best);
                self.smallest(&Self::part(pieces, from, event), (low, &middle), best);
            }
        }
    }

    /// Makes `best` the largest force between two ends, both of which it knows already. Where the force falls at once,
    /// the largest number before counts.
    fn largest(&self, pieces: &[Piece<E::Slider>], (low, high): Ends<'_>, best: &mut ContactState) {
        let (from, to) = (low.indentation, high.indentation);
        if upper_bound(low, high) <= best.compression || from.next_up() >= to {
            return;
        }
        match self.middle_event(from, to) {
            None => {
                self.take(pieces, to.next_down(), best, |a, b| a > b);
            }
            Some(event) => {
                let middle = self.take(pieces, event, best, |a, b| a > b);
                self.largest(&Self::part(pieces, event, to), (&middle, high), best);
                self.largest(&Self::part(pieces, from, event), (low, &middle), best);
            }
        }
    }

    fn take(
        &self,
        pieces: &[Piece<E::Slider>],
        at: f64,
        best: &mut ContactState,
        is_better: impl Fn(f64, f64) -> bool,
    ) -> ContactState {
        let state = self.at(pieces, at);
        if is_better(state.compression, best.compression) {
            *best = state;
        }
        state
    }

    /// The smallest indentation above the lower end, up to the higher one, with at least this compression; at the
    /// lower end it is smaller.
    fn first_of(&self, pieces: &[Piece<E::Slider>], (low, high): Ends<'_>, wanted: f64) -> Option<f64> {
        if upper_bound(low, high) < wanted {
            return None;
        }
        let (from, to) = (low.indentation, high.indentation);
        match self.middle_event(from, to) {
            None => {
                if let Some(straight) = self.straight(from, wanted) {
                    return if straight < to {
                        Some(straight.max(from))
                    } else {
                        (high.compression >= wanted).then_some(to)
                    };
                }
                if self.below(pieces, from, to) < wanted {
                    return (high.compression >= wanted).then_some(to);
                }
                // Convex and below it at first: it gets there once.
                let found = crossing(from, to, |at| self.below(pieces, from, at) - wanted);
                Some(if found < to || high.compression >= wanted { found } else { to.next_down() })
            }
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
    fn last_of(&self, pieces: &[Piece<E::Slider>], (low, high): Ends<'_>, wanted: f64) -> Option<f64> {
        let (from, to) = (low.indentation, high.indentation);
        if lower_bound(low, high) > wanted || from >= to {
            return None;
        }
        match self.middle_event(from, to) {
            None => {
                let flat = self.flat(pieces, from, to);
                if self.below(pieces, from, flat) > wanted {
                    return (low.compression <= wanted).then_some(from);
                }
                if let Some(straight) = self.straight(from, wanted) {
                    return Some(straight.clamp(from, to.next_down().max(from)));
                }
                // It rises from there on: the last place where it has not passed.
                let passes = |at: f64| self.below(pieces, from, at) - wanted;
                Some(if passes(to) > 0.0 { last_before(flat, to, passes) } else { flat })
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

    /// Indentation of a compression where the force is a straight line, for the contact at `low`.
    fn straight(&self, low: f64, wanted: f64) -> Option<f64> {
        self.edges.indentation_of(self.totals(low), wanted, &self.scale)
    }
}

impl<S> Piece<S> {
    fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Zeros are met to the last place, in far fewer looks on the whole than the fifty-odd that halving takes.
    #[test]
    fn a_rising_zero_is_met_in_few_looks() {
        let looks = Cell::new(0);
        let mut zeros = 0;
        for root in (1..100).map(|k| f64::from(k) / 100.0) {
            for bend in [0.0, 1.0, 10.0] {
                let value = |at: f64| {
                    looks.set(looks.get() + 1);
                    (at - root) * (1.0 + bend * (at + 0.5))
                };
                let found = crossing(-0.5, 1.0, value);
                assert!(value(found) >= 0.0 && value(found.next_down()) < 0.0);
                let before = last_before(-0.5, 1.0, value);
                assert!(value(before) <= 0.0 && value(before.next_up()) > 0.0);
                zeros += 2;
            }
        }
        assert!(looks.get() <= 40 * zeros, "{} looks for {zeros} zeros", looks.get());
    }
}
