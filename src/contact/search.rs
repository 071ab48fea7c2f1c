//! Exact extremes and crossings of the force along a leg, whatever the number of curve samples.
//!
//! Between two thresholds the compression F/Δk = n d − Σc rises with slope n; at a threshold, read
//! upwards in d, it falls by the stretch of what joins. So its smallest value lies at a threshold, its
//! largest just before one. From the tallies at the ends of an interval of width h follow bounds
//! inside it, because whatever joins there is stretched or just touching and is compressed by at most
//! h at the end:
//!
//! F_right − n_right h ≤ F(d) ≤ F_left + n_right h.
//!
//! Only intervals whose bounds allow the sought value are looked into: their springs are parted into
//! finer and finer intervals, and only the last few are sorted.

use super::ledger::{Event, Ledger, Springs};
use super::tally::{GapScale, Tally};
use std::ops::ControlFlow;

/// Intervals with at most this many events are sorted and walked through.
const FEW: usize = 48;
/// Parts into which the others are divided.
const PARTS: usize = 32;

/// A value of the compression Σ (d − c) and where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extreme {
    /// Σ (d − c), m.
    pub compression: f64,
    /// d, m.
    pub indentation: f64,
    /// What is in contact there.
    pub tally: Tally,
}

/// Smallest compression on the grid's range, at the smallest indentation where it stands.
pub(crate) fn smallest(ledger: &Ledger, springs: &impl Springs, sorted: &mut u64) -> Extreme {
    let points = 0..ledger.tallies.len();
    let best = points.map(|index| point(ledger, springs.scale(), index));
    let best = best.reduce(|best, next| if next.compression < best.compression { next } else { best });
    let mut goal = Smallest { best: best.unwrap_or(NOTHING) };
    Search { ledger, springs, sorted }.run(&mut goal, Order::Ascending, 0..ledger.intervals());
    goal.best
}

/// Largest compression on the grid's range.
pub(crate) fn largest(ledger: &Ledger, springs: &impl Springs, sorted: &mut u64) -> Extreme {
    let points = (0..ledger.tallies.len()).rev();
    let best = points.map(|index| point(ledger, springs.scale(), index));
    let best = best.reduce(|best, next| if next.compression > best.compression { next } else { best });
    let mut goal = Largest { best: best.unwrap_or(NOTHING) };
    Search { ledger, springs, sorted }.run(&mut goal, Order::Descending, 0..ledger.intervals());
    goal.best
}

/// Smallest indentation of the range at which the compression is at least `wanted`.
pub(crate) fn first_at_least(
    ledger: &Ledger,
    springs: &impl Springs,
    wanted: f64,
    sorted: &mut u64,
) -> Option<f64> {
    let reached = (0..ledger.tallies.len()).find(|&i| ledger.compression(i, springs.scale()) >= wanted);
    let end = reached.unwrap_or(ledger.intervals());
    let mut goal = FirstAtLeast { wanted, found: None };
    Search { ledger, springs, sorted }.run(&mut goal, Order::Ascending, 0..end);
    goal.found.or(reached.map(|index| ledger.grid.points()[index]))
}

/// Largest indentation of the range at which the compression is at most `wanted`.
pub(crate) fn last_at_most(
    ledger: &Ledger,
    springs: &impl Springs,
    wanted: f64,
    sorted: &mut u64,
) -> Option<f64> {
    let reached = (0..ledger.tallies.len()).rev().find(|&i| ledger.compression(i, springs.scale()) <= wanted);
    let start = reached.unwrap_or(0);
    let mut goal = LastAtMost { wanted, found: None };
    Search { ledger, springs, sorted }.run(&mut goal, Order::Descending, start..ledger.intervals());
    goal.found.or(reached.map(|index| ledger.grid.points()[index]))
}

fn point(ledger: &Ledger, scale: &GapScale, index: usize) -> Extreme {
    Extreme {
        compression: ledger.compression(index, scale),
        indentation: ledger.grid.points()[index],
        tally: ledger.tallies[index],
    }
}

const NOTHING: Extreme =
    Extreme { compression: 0.0, indentation: 0.0, tally: Tally { springs: 0, fragments: 0, quanta: 0 } };

/// What is sought.
trait Goal {
    /// Whether it may lie in an interval with these bounds.
    fn may_lie(&self, bounds: Bounds) -> bool;
    /// Looks at a stretch over which nothing joins; a break ends the search.
    fn look(&mut self, segment: &Segment, scale: &GapScale) -> ControlFlow<()>;
}

/// A stretch of indentations `[from, to)` over which nothing joins: the force is a straight line.
struct Segment {
    from: f64,
    to: f64,
    tally: Tally,
}

/// Bounds of the compression inside an interval, widened by their own rounding.
#[derive(Clone, Copy)]
struct Bounds {
    lower: f64,
    upper: f64,
}

struct Smallest {
    best: Extreme,
}

impl Goal for Smallest {
    fn may_lie(&self, bounds: Bounds) -> bool {
        bounds.lower < self.best.compression
    }

    fn look(&mut self, segment: &Segment, scale: &GapScale) -> ControlFlow<()> {
        let compression = segment.tally.compression(segment.from, scale);
        if compression < self.best.compression {
            self.best = Extreme { compression, indentation: segment.from, tally: segment.tally };
        }
        ControlFlow::Continue(())
    }
}

struct Largest {
    best: Extreme,
}

impl Goal for Largest {
    fn may_lie(&self, bounds: Bounds) -> bool {
        bounds.upper > self.best.compression
    }

    fn look(&mut self, segment: &Segment, scale: &GapScale) -> ControlFlow<()> {
        // The value just before the next threshold, where what joins has not joined yet.
        let compression = segment.tally.compression(segment.to, scale);
        if compression > self.best.compression {
            self.best = Extreme { compression, indentation: segment.to, tally: segment.tally };
        }
        ControlFlow::Continue(())
    }
}

struct FirstAtLeast {
    wanted: f64,
    found: Option<f64>,
}

impl Goal for FirstAtLeast {
    fn may_lie(&self, bounds: Bounds) -> bool {
        bounds.upper >= self.wanted
    }

    fn look(&mut self, segment: &Segment, scale: &GapScale) -> ControlFlow<()> {
        let crossing = segment.tally.indentation(self.wanted, scale).map(|d| d.max(segment.from));
        match crossing.filter(|&crossing| crossing < segment.to) {
            Some(crossing) => {
                self.found = Some(crossing);
                ControlFlow::Break(())
            }
            None => ControlFlow::Continue(()),
        }
    }
}

struct LastAtMost {
    wanted: f64,
    found: Option<f64>,
}

impl Goal for LastAtMost {
    fn may_lie(&self, bounds: Bounds) -> bool {
        bounds.lower <= self.wanted
    }

    fn look(&mut self, segment: &Segment, scale: &GapScale) -> ControlFlow<()> {
        if segment.tally.compression(segment.from, scale) > self.wanted {
            return ControlFlow::Continue(());
        }
        // Without contact the force is zero all along.
        let last = segment.to.next_down().max(segment.from);
        let crossing = segment.tally.indentation(self.wanted, scale).unwrap_or(last);
        self.found = Some(crossing.clamp(segment.from, last));
        ControlFlow::Break(())
    }
}

/// In which order intervals are looked into.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Order {
    Ascending,
    Descending,
}

impl Order {
    /// Calls `visit` for 0 … `count` − 1 in this order until it breaks.
    fn each(self, count: usize, mut visit: impl FnMut(usize) -> ControlFlow<()>) -> ControlFlow<()> {
        (0..count).try_for_each(|k| visit(if self == Order::Ascending { k } else { count - 1 - k }))
    }
}

/// An interval of indentations `(low, high]` and what is in contact at its ends.
#[derive(Clone, Copy)]
struct Interval {
    low: f64,
    high: f64,
    at_low: Tally,
    at_high: Tally,
}

impl Interval {
    fn bounds(&self, scale: &GapScale) -> Bounds {
        let rise = self.at_high.springs as f64 * (self.high - self.low);
        let left = self.at_low.compression(self.low, scale);
        let right = self.at_high.compression(self.high, scale);
        let slack = 8.0 * f64::EPSILON * (left.abs() + right.abs() + rise);
        Bounds { lower: right - rise - slack, upper: left + rise + slack }
    }
}

/// A search through the intervals of a ledger.
struct Search<'a, S> {
    ledger: &'a Ledger,
    springs: &'a S,
    /// Counts the events that had to be sorted.
    sorted: &'a mut u64,
}

impl<S: Springs> Search<'_, S> {
    fn run(&mut self, goal: &mut impl Goal, order: Order, intervals: std::ops::Range<usize>) {
        let scale = *self.springs.scale();
        let interval = |index: usize| {
            let points = self.ledger.grid.points();
            let tallies = &self.ledger.tallies;
            Interval {
                low: points[index],
                high: points[index + 1],
                at_low: tallies[index],
                at_high: tallies[index + 1],
            }
        };
        let chosen: Vec<bool> = (0..self.ledger.intervals())
            .map(|index| intervals.contains(&index) && goal.may_lie(interval(index).bounds(&scale)))
            .collect();
        let mut events = self.ledger.events(self.springs, &chosen);
        let chosen: Vec<usize> = (0..chosen.len()).filter(|&index| chosen[index]).collect();
        // Their events stand together, interval by interval.
        let mut ends = Vec::with_capacity(chosen.len());
        for &index in &chosen {
            ends.push(events.partition_point(|event| event.interval <= index));
        }
        let _ = order.each(chosen.len(), |place| {
            let start = if place == 0 { 0 } else { ends[place - 1] };
            self.enter(goal, order, interval(chosen[place]), &mut events[start..ends[place]])
        });
    }

    /// Looks into an interval with these events, unless the goal cannot lie there (any more).
    fn enter(
        &mut self,
        goal: &mut impl Goal,
        order: Order,
        interval: Interval,
        events: &mut [Event],
    ) -> ControlFlow<()> {
        let scale = *self.springs.scale();
        if !goal.may_lie(interval.bounds(&scale)) {
            return ControlFlow::Continue(());
        }
        if events.len() <= FEW {
            return self.walk(goal, order, interval, events);
        }
        let ends =
            |(low, high): (f64, f64), event: &Event| (low.min(event.threshold), high.max(event.threshold));
        let (first, last) = events.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        let width = (last - first) / (PARTS - 2) as f64;
        // Where numbers lie too close to part them they are sorted, however many they are.
        if first + width <= first || last - width >= last {
            return self.walk(goal, order, interval, events);
        }
        // One part up to the first event, one after the last, the others even between them.
        let point = |part: usize| match part {
            0 => interval.low,
            PARTS => interval.high,
            _ if part == PARTS - 1 => last,
            _ => (first + width * (part - 1) as f64).min(last),
        };
        for event in events.iter_mut() {
            let guess = ((event.threshold - first) / width) as usize + 1;
            let mut part = guess.min(PARTS - 2);
            while part > 0 && event.threshold <= point(part) {
                part -= 1;
            }
            while event.threshold > point(part + 1) {
                part += 1;
            }
            event.interval = part;
        }
        events.sort_unstable_by_key(|event| event.interval);
        let mut parts = Vec::with_capacity(PARTS);
        let (mut start, mut at_low) = (0, interval.at_low);
        for part in 0..PARTS {
            let end = start + events[start..].partition_point(|event| event.interval <= part);
            let mut at_high = at_low;
            events[start..end].iter().for_each(|event| at_high += event.joins);
            parts.push((start..end, Interval { low: point(part), high: point(part + 1), at_low, at_high }));
            (start, at_low) = (end, at_high);
        }
        order.each(PARTS, |part| {
            let (range, interval) = parts[part].clone();
            self.enter(goal, order, interval, &mut events[range])
        })
    }

    /// Looks at each segment of an interval.
    fn walk(
        &mut self,
        goal: &mut impl Goal,
        order: Order,
        interval: Interval,
        events: &mut [Event],
    ) -> ControlFlow<()> {
        let scale = *self.springs.scale();
        *self.sorted += events.len() as u64;
        events.sort_unstable_by(|a, b| a.threshold.total_cmp(&b.threshold));
        let mut segments = Vec::with_capacity(events.len() + 1);
        let (mut from, mut tally) = (interval.low, interval.at_low);
        for event in events {
            if event.threshold > from {
                segments.push(Segment { from, to: event.threshold, tally });
                from = event.threshold;
            }
            tally += event.joins;
        }
        if interval.high > from {
            segments.push(Segment { from, to: interval.high, tally });
        }
        order.each(segments.len(), |index| goal.look(&segments[index], &scale))
    }
}
