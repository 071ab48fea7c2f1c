//! The force over a whole leg: springs sorted into the intervals of a grid of indentations.

use super::tally::{GapScale, Tally};

/// One spring as a leg sees it: in contact at indentation d exactly when `threshold` ≤ d.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Smallest indentation at which it is in contact, m; −∞ when it was so before a loading leg
    /// began, +∞ when it was not before an unloading leg began.
    pub threshold: f64,
    /// Its gap c, m; never below the threshold.
    pub gap: f64,
    /// What it adds to the gaps that are summed, in quanta of their scale.
    pub quanta: i64,
    /// Contact fragments it adds: 1, 0 or −1.
    pub fragments: i64,
}

/// The springs of a leg, in any fixed order.
pub trait Springs {
    /// Calls `see` once for each spring.
    fn each(&self, see: impl FnMut(Spring));
    /// The same for each spring whose threshold is above `low` and at most `high`, m, in any order; others may
    /// be left out.
    fn each_between(&self, _low: f64, _high: f64, see: impl FnMut(Spring)) {
        self.each(see);
    }
    /// The scale on which the gaps are summed.
    fn scale(&self) -> &GapScale;
}

/// The springs whose thresholds are above an indentation and at most another, m, and perhaps some others.
struct Between<'s, S> {
    low: f64,
    high: f64,
    springs: &'s S,
}

impl<S: Springs> Springs for Between<'_, S> {
    fn each(&self, see: impl FnMut(Spring)) {
        self.springs.each_between(self.low, self.high, see);
    }

    fn scale(&self) -> &GapScale {
        self.springs.scale()
    }
}

/// An evenly spaced grid of indentations, both ends exact.
#[derive(Clone, Debug)]
pub struct Grid {
    points: Vec<f64>,
    intervals_per_metre: f64,
}

impl Grid {
    /// `intervals` equal intervals from `low` to `high`; a single point where they coincide.
    pub fn new(low: f64, high: f64, intervals: usize) -> Self {
        let width = (high - low) / intervals as f64;
        // Also too narrow a range to tell its points apart is one point at each end.
        let even = low + width > low && high - width < high && width.recip().is_finite();
        let mut points: Vec<f64> = if even {
            (0..intervals).map(|k| (low + width * k as f64).min(high)).collect()
        } else {
            vec![low]
        };
        if high > low {
            points.push(high);
        }
        Grid { points, intervals_per_metre: if even { width.recip() } else { 0.0 } }
    }

    pub fn points(&self) -> &[f64] {
        &self.points
    }

    pub fn high(&self) -> f64 {
        self.points[self.points.len() - 1]
    }

    /// Index of the first point that is at least `indentation`, which must not exceed the last.
    #[inline]
    pub fn first_at_least(&self, indentation: f64) -> usize {
        // The guess is off by one at the most where the grid is even; the loops make it exact.
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

/// What is in contact at each point of a grid.
#[derive(Clone, Debug)]
pub struct Ledger {
    pub grid: Grid,
    /// Springs in contact at each grid point.
    pub tallies: Vec<Tally>,
}

/// What the joins of a leg cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SquaredStretch {
    /// Σ (c − threshold)² over the springs whose thresholds lie on the grid, above its lowest point, m².
    pub inside: f64,
    /// The same for the springs whose thresholds are finite and at or below the lowest grid point.
    pub below: f64,
}

impl Ledger {
    /// Sorts `springs` into the intervals of `grid`.
    pub fn new(springs: &impl Springs, grid: Grid) -> Self {
        let mut bins = vec![Tally::default(); grid.points.len()];
        let reached = |threshold| threshold <= grid.high();
        each_run(springs, reached, |run: Run<()>| bins[grid.first_at_least(run.threshold)] += run.joins);
        Ledger { tallies: running_total(bins), grid }
    }

    /// The same, and what the joins cost: about half as much work again.
    pub fn with_stretches(springs: &impl Springs, grid: Grid) -> (Self, SquaredStretch) {
        let mut bins = vec![(Tally::default(), CompensatedSum::default()); grid.points.len()];
        let reached = |threshold| threshold <= grid.high();
        each_run(springs, reached, |run: Run<CompensatedSum>| {
            let (tally, squared_stretch) = &mut bins[grid.first_at_least(run.threshold)];
            *tally += run.joins;
            squared_stretch.add_sum(run.squared_stretch);
        });
        let (mut inside, mut below) = (CompensatedSum::default(), CompensatedSum::default());
        for (index, (_, squared_stretch)) in bins.iter().enumerate() {
            let sum = if index == 0 { &mut below } else { &mut inside };
            sum.add_sum(*squared_stretch);
        }
        let tallies = running_total(bins.into_iter().map(|(tally, _)| tally).collect());
        (Ledger { tallies, grid }, SquaredStretch { inside: inside.total(), below: below.total() })
    }

    /// Number of intervals between grid points.
    pub fn intervals(&self) -> usize {
        self.tallies.len() - 1
    }

    /// Compression Σ (d − c), m, at grid point `index`.
    pub fn compression(&self, index: usize, scale: &GapScale) -> f64 {
        self.tallies[index].compression(self.grid.points[index], scale)
    }

    /// The springs whose thresholds lie in the chosen intervals (interval k is above point k, up to
    /// and including point k + 1), interval by interval.
    pub fn events(&self, springs: &impl Springs, chosen: &[bool]) -> Vec<Event> {
        let points = self.grid.points();
        let first = chosen.iter().position(|&chosen| chosen);
        let last = chosen.iter().rposition(|&chosen| chosen);
        let (Some(first), Some(last)) = (first, last) else { return Vec::new() };
        let (low, high) = (points[first], points[last + 1]);
        let mut events = Vec::new();
        let within = |threshold: f64| threshold > low && threshold <= high;
        each_run(&Between { low, high, springs }, within, |Run::<()> { threshold, joins, .. }| {
            let interval = self.grid.first_at_least(threshold) - 1;
            if chosen[interval] {
                events.push(Event { threshold, joins, interval });
            }
        });
        events.sort_unstable_by_key(|event| event.interval);
        events
    }
}

/// Each tally with all before it.
fn running_total(mut tallies: Vec<Tally>) -> Vec<Tally> {
    let mut total = Tally::default();
    for tally in &mut tallies {
        total += *tally;
        *tally = total;
    }
    tallies
}

/// Springs that stand together and join or leave together.
struct Run<S> {
    threshold: f64,
    joins: Tally,
    /// Σ (c − threshold)² where the threshold is finite, m², if it is asked for.
    squared_stretch: S,
}

/// A sum over the springs of a run.
trait StretchSum: Default + Copy {
    fn add_stretch(&mut self, stretch: f64);
}

/// Nothing is summed.
impl StretchSum for () {
    #[inline]
    fn add_stretch(&mut self, _: f64) {}
}

/// The squares of finite stretches.
impl StretchSum for CompensatedSum {
    #[inline]
    fn add_stretch(&mut self, stretch: f64) {
        self.add(if stretch < f64::INFINITY { stretch * stretch } else { 0.0 });
    }
}

/// Calls `see` for each run of springs with one threshold that is `wanted`. What joins or leaves as one
/// fragment stands together in the order of the tree, so most runs of an adhesive contact are long.
fn each_run<S: StretchSum>(
    springs: &impl Springs,
    wanted: impl Fn(f64) -> bool,
    mut see: impl FnMut(Run<S>),
) {
    let mut threshold = f64::NAN;
    let mut is_wanted = false;
    let (mut joins, mut squared_stretch) = (Tally::default(), S::default());
    springs.each(|spring| {
        if spring.threshold != threshold {
            if is_wanted {
                see(Run { threshold, joins, squared_stretch });
            }
            threshold = spring.threshold;
            is_wanted = wanted(threshold);
            (joins, squared_stretch) = (Tally::default(), S::default());
        }
        if is_wanted {
            joins.springs += 1;
            joins.fragments += spring.fragments;
            joins.quanta += i128::from(spring.quanta);
            squared_stretch.add_stretch(spring.gap - spring.threshold);
        }
    });
    if is_wanted {
        see(Run { threshold, joins, squared_stretch });
    }
}

/// A run of springs that joins or leaves inside an interval of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    pub threshold: f64,
    /// What it adds to the tally.
    pub joins: Tally,
    /// Number of the interval in which its threshold lies.
    pub interval: usize,
}

/// Sum of non-negative terms that keeps its rounding errors (Neumaier): relative error below
/// 2u + O(n u²).
#[derive(Clone, Copy, Debug, Default)]
pub struct CompensatedSum {
    value: f64,
    error: f64,
}

impl CompensatedSum {
    #[inline]
    pub fn add(&mut self, term: f64) {
        let sum = self.value + term;
        let added = sum - self.value;
        self.error += (self.value - (sum - added)) + (term - added);
        self.value = sum;
    }

    pub fn add_sum(&mut self, other: CompensatedSum) {
        self.add(other.value);
        self.error += other.error;
    }

    pub fn total(self) -> f64 {
        self.value + self.error
    }
}
