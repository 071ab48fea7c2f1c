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
//! Only intervals whose bounds allow the sought value are opened and their springs sorted; with some
//! thousand intervals these are few.

use super::ledger::{Event, Ledger, Springs};
use super::tally::{GapScale, Tally};

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

/// Bounds of the compression inside one interval, widened by their own rounding.
struct Bounds {
    lower: f64,
    upper: f64,
}

fn bounds(ledger: &Ledger, scale: &GapScale, interval: usize) -> Bounds {
    let points = ledger.grid.points();
    let width = points[interval + 1] - points[interval];
    let rise = ledger.tallies[interval + 1].springs as f64 * width;
    let (left, right) = (ledger.compression(interval, scale), ledger.compression(interval + 1, scale));
    let slack = 8.0 * f64::EPSILON * (left.abs() + right.abs() + rise);
    Bounds { lower: right - rise - slack, upper: left + rise + slack }
}

fn choose(ledger: &Ledger, scale: &GapScale, wanted: impl Fn(usize, Bounds) -> bool) -> Vec<bool> {
    (0..ledger.intervals()).map(|interval| wanted(interval, bounds(ledger, scale, interval))).collect()
}

/// A stretch of indentations `[from, to)` over which nothing joins: the force is a straight line.
struct Segment {
    from: f64,
    to: f64,
    tally: Tally,
}

/// Cuts the chosen intervals into segments, in ascending order.
fn segments<'a>(ledger: &'a Ledger, chosen: &'a [bool], events: &'a [Event]) -> Vec<Segment> {
    let points = ledger.grid.points();
    let mut segments = Vec::with_capacity(events.len() + chosen.len());
    let mut next = 0;
    for interval in (0..ledger.intervals()).filter(|&interval| chosen[interval]) {
        let mut tally = ledger.tallies[interval];
        let mut from = points[interval];
        while let Some(event) = events.get(next).filter(|event| event.interval == interval) {
            if event.threshold > from {
                segments.push(Segment { from, to: event.threshold, tally });
                from = event.threshold;
            }
            tally += event.joins;
            next += 1;
        }
        if points[interval + 1] > from {
            segments.push(Segment { from, to: points[interval + 1], tally });
        }
    }
    segments
}

fn opened(ledger: &Ledger, springs: &impl Springs, chosen: &[bool], sorted: &mut u64) -> Vec<Segment> {
    if !chosen.contains(&true) {
        return Vec::new();
    }
    let events = ledger.events(springs, chosen);
    *sorted += events.len() as u64;
    segments(ledger, chosen, &events)
}

/// Smallest compression on the grid's range, at the smallest indentation where it stands.
pub(crate) fn smallest(ledger: &Ledger, springs: &impl Springs, sorted: &mut u64) -> Extreme {
    let scale = springs.scale();
    let at = |index: usize| ledger.compression(index, scale);
    let mut best = point(ledger, scale, 0);
    for index in 1..ledger.tallies.len() {
        if at(index) < best.compression {
            best = point(ledger, scale, index);
        }
    }
    let chosen = choose(ledger, scale, |_, bounds| bounds.lower < best.compression);
    for segment in opened(ledger, springs, &chosen, sorted) {
        let compression = segment.tally.compression(segment.from, scale);
        if compression < best.compression {
            best = Extreme { compression, indentation: segment.from, tally: segment.tally };
        }
    }
    best
}

/// Largest compression on the grid's range.
pub(crate) fn largest(ledger: &Ledger, springs: &impl Springs, sorted: &mut u64) -> Extreme {
    let scale = springs.scale();
    let mut best = point(ledger, scale, ledger.intervals());
    for index in (0..ledger.intervals()).rev() {
        if ledger.compression(index, scale) > best.compression {
            best = point(ledger, scale, index);
        }
    }
    let chosen = choose(ledger, scale, |_, bounds| bounds.upper > best.compression);
    for segment in opened(ledger, springs, &chosen, sorted) {
        // The value just before the next threshold, where what joins has not joined yet.
        let compression = segment.tally.compression(segment.to, scale);
        if compression > best.compression {
            best = Extreme { compression, indentation: segment.to, tally: segment.tally };
        }
    }
    best
}

fn point(ledger: &Ledger, scale: &GapScale, index: usize) -> Extreme {
    Extreme {
        compression: ledger.compression(index, scale),
        indentation: ledger.grid.points()[index],
        tally: ledger.tallies[index],
    }
}

/// Smallest indentation of the range at which the compression is at least `wanted`.
pub(crate) fn first_at_least(
    ledger: &Ledger,
    springs: &impl Springs,
    wanted: f64,
    sorted: &mut u64,
) -> Option<f64> {
    let scale = springs.scale();
    if ledger.compression(0, scale) >= wanted {
        return Some(ledger.grid.low());
    }
    let reached = (1..ledger.tallies.len()).find(|&index| ledger.compression(index, scale) >= wanted);
    let last = reached.unwrap_or(ledger.intervals());
    let chosen = choose(ledger, scale, |interval, bounds| interval < last && bounds.upper >= wanted);
    opened(ledger, springs, &chosen, sorted)
        .iter()
        .find_map(|segment| {
            let crossing = segment.tally.indentation(wanted, scale)?.max(segment.from);
            (crossing < segment.to).then_some(crossing)
        })
        .or(reached.map(|index| ledger.grid.points()[index]))
}

/// Largest indentation of the range at which the compression is at most `wanted`.
pub(crate) fn last_at_most(
    ledger: &Ledger,
    springs: &impl Springs,
    wanted: f64,
    sorted: &mut u64,
) -> Option<f64> {
    let scale = springs.scale();
    let end = ledger.intervals();
    if ledger.compression(end, scale) <= wanted {
        return Some(ledger.grid.high());
    }
    let reached = (0..end).rev().find(|&index| ledger.compression(index, scale) <= wanted);
    let first = reached.unwrap_or(0);
    let chosen = choose(ledger, scale, |interval, bounds| interval >= first && bounds.lower <= wanted);
    opened(ledger, springs, &chosen, sorted)
        .iter()
        .rev()
        .find_map(|segment| {
            if segment.tally.compression(segment.from, scale) > wanted {
                return None;
            }
            let crossing = segment.tally.indentation(wanted, scale).unwrap_or(segment.to.next_down());
            Some(crossing.clamp(segment.from, segment.to.next_down()))
        })
        .or(reached.map(|index| ledger.grid.points()[index]))
}
