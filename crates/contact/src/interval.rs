//! Parts of a motion between two indentations, called intervals, in which extremes and crossings of
//! the force are searched.
//!
//! A search divides an interval at its middle event. An event is an indentation at which springs
//! attach or detach. The division ends where the bounds of the force exclude a part, or where a
//! part has no event inside.

use super::adhesive::levels::{EdgeSum, Slider};
use super::contact_state::{ContactState, Extreme, lower_bound, upper_bound};
use super::crossing::{bisect, crossing, last_before};
use super::detachment::DetachmentRule;
use super::totals::{ContactTotals, GapScale};
use std::ops::Range;
use std::rc::Rc;

/// Totals of all whole springs or cells that are in contact at indentations from `threshold` (m) up
/// to the next step.
#[derive(Clone, Copy, Debug)]
struct Step {
    threshold: f64,
    totals: ContactTotals,
}

/// The edge cells of one patch, and the range of indentations in m in which the patch consists of
/// the same springs. The edge cells lie at the ends of the patch and are only partly in contact.
#[derive(Clone, Copy, Debug)]
pub struct Piece<R> {
    pub slider: Slider<R>,
    pub from: f64,
    pub to: f64,
}

/// Part of a motion between two indentations, with the events inside this part. An event is an
/// indentation at which springs attach or detach.
pub struct Interval<R> {
    slides: bool,
    /// Number of springs parallel to the contact that represent the instrument; see
    /// [`ContactState::beside`].
    instrument: f64,
    scale: GapScale,
    /// Totals at the lowest indentation, followed by the totals after each event. The events are in
    /// ascending order only after [`Interval::sort`].
    steps: Rc<Vec<Step>>,
    pieces: Vec<Piece<R>>,
    /// Contact at the lowest indentation (`low`) and at the highest (`high`).
    low: ContactState,
    high: ContactState,
}

/// Part of a motion that the body passes in a jump because the instrument that moves it is
/// compliant.
#[derive(Clone, Copy, Debug)]
pub struct Jumped {
    /// Lowest and highest indentation in m.
    pub low: f64,
    pub high: f64,
    /// Common compression in m of contact and instrument at which the body jumps. It is the largest
    /// one so far on loading, and the smallest one so far on unloading.
    pub level: f64,
    /// Area in cells times m² between the common compression, as a function of the indentation, and
    /// this level.
    pub area: f64,
}

/// Neighbouring intervals of a motion in ascending order of the indentation, at least one.
pub struct Intervals<R>(Vec<Interval<R>>);

impl<R: DetachmentRule> Intervals<R> {
    /// Creates one interval for each item of `ends`. An item has the contact at the lower end and
    /// the contact at the upper end of the interval. `slides` is true if edges of patches move
    /// between springs. `instrument` is the number of springs parallel to the contact that
    /// represent the instrument.
    pub fn new(ends: &[[ContactState; 2]], slides: bool, scale: GapScale, instrument: f64) -> Self {
        let mut intervals = Vec::with_capacity(ends.len());
        for &[low, high] in ends {
            let first_step = Step {
                threshold: low.indentation,
                totals: low.totals,
            };
            intervals.push(Interval {
                slides,
                instrument,
                scale,
                steps: Rc::new(vec![first_step]),
                pieces: Vec::new(),
                low,
                high,
            });
        }
        Intervals(intervals)
    }

    /// Returns the smallest and the largest indentation of all intervals in m.
    pub fn ends(&self) -> (f64, f64) {
        let low = self.0[0].low.indentation;
        let high = self.0[self.0.len() - 1].high.indentation;
        (low, high)
    }

    /// Returns the indices of the intervals that overlap the range of indentations from `from` to
    /// `to` in m.
    pub fn between(&self, from: f64, to: f64) -> Range<usize> {
        let intervals = &self.0;
        let first = intervals.partition_point(|interval| interval.high.indentation < from);
        let end = intervals.partition_point(|interval| interval.low.indentation < to);
        // Because of rounding, `to` may lie slightly below `from`; the range is then empty.
        first..end.max(first)
    }

    /// Adds springs or cells that are in contact at the indentations from `from` to `to` in m.
    /// `totals` are the sums over these springs or cells. Each of the two indentations is an event,
    /// at which the contact changes.
    pub fn add_events(&mut self, from: f64, to: f64, totals: ContactTotals) {
        for (threshold, totals) in [(from, totals), (to, -totals)] {
            // At most one interval contains the threshold, because an event at the lower end of an
            // interval does not belong to this interval.
            let range = self.between(threshold, threshold);
            for interval in &mut self.0[range] {
                Rc::make_mut(&mut interval.steps).push(Step { threshold, totals });
            }
        }
    }

    /// Adds the edge cells of a patch to all intervals in which this patch consists of the same
    /// springs.
    pub fn add_piece(&mut self, piece: Piece<R>) {
        let range = self.between(piece.from, piece.to);
        for interval in &mut self.0[range] {
            interval.pieces.push(piece);
        }
    }

    /// Sorts the events of each interval, and returns the intervals. An event is an indentation at
    /// which springs attach or detach. The number of sorted events is added to `sorted`.
    pub fn finish(mut self, sorted: &mut u64) -> Vec<Interval<R>> {
        for interval in &mut self.0 {
            *sorted += interval.steps.len() as u64 - 1;
            interval.sort();
        }
        self.0
    }
}

impl<R: DetachmentRule> Interval<R> {
    /// Sorts the events and sums their changes, so that each step has the totals after its event.
    fn sort(&mut self) {
        let steps = Rc::make_mut(&mut self.steps);
        steps[1..].sort_unstable_by(|step, other| step.threshold.total_cmp(&other.threshold));
        steps.dedup_by(|next, step| {
            let is_together = next.threshold == step.threshold;
            if is_together {
                step.totals += next.totals;
            }
            is_together
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

    /// Returns the totals of the whole springs or cells in contact at an indentation in m.
    fn totals(&self, indentation: f64) -> ContactTotals {
        let above = self
            .steps
            .partition_point(|step| step.threshold <= indentation);
        self.steps[above.saturating_sub(1)].totals
    }

    fn sliders(&self, indentation: f64) -> impl Iterator<Item = Slider<R>> {
        self.pieces
            .iter()
            .filter(move |piece| piece.is_at(indentation))
            .map(|piece| piece.slider)
    }

    /// Returns the contact at an indentation in m. No event may lie between `from` and this
    /// indentation, so that no edge jumps and no patch merges or splits on the way. The force is
    /// then convex in the indentation.
    fn steady(&self, from: f64, indentation: f64) -> ContactState {
        let mut edges = EdgeSum::default();
        for slider in self.sliders(from) {
            edges.add(slider.edge_cells(indentation));
        }
        let totals = self.totals(from);
        let contact =
            ContactState::new(self.slides, indentation, totals, edges.total(), &self.scale);
        contact.beside(self.instrument)
    }

    /// Returns the compression in m at an indentation in m. No event may lie between the lower end
    /// of the interval and this indentation.
    fn compression(&self, indentation: f64) -> f64 {
        let from = self.low.indentation;
        self.steady(from, indentation).compression
    }

    /// Returns the derivative of the compression with respect to the indentation, in cells, at an
    /// indentation in m. No event may lie between the lower end of the interval and this
    /// indentation.
    fn stiffness(&self, indentation: f64) -> f64 {
        let from = self.low.indentation;
        let mut edges = 0.0;
        for slider in self.sliders(from) {
            edges += slider.stiffness(indentation);
        }
        self.totals(from).whole(self.slides) as f64 + edges + self.instrument
    }

    /// Returns the indentation in m of the smallest force between the lower end of the interval and
    /// `last`. No event may lie between the two.
    fn flattest(&self, last: f64) -> f64 {
        let low = self.low.indentation;
        if self.stiffness(low) >= 0.0 {
            return low;
        }
        if self.stiffness(last) <= 0.0 {
            return last;
        }
        bisect(low, last, |indentation| self.stiffness(indentation) >= 0.0)
    }

    /// Returns the contact at the middle one of the events inside the interval; `None` if no event
    /// is inside.
    fn middle(&self) -> Option<ContactState> {
        let (low, high) = self.ends();
        let steps = &self.steps;
        let first = steps.partition_point(|step| step.threshold <= low);
        let end = steps.partition_point(|step| step.threshold < high);
        if first >= end {
            return None;
        }
        let event = steps[first + (end - first) / 2].threshold;
        Some(self.steady(event, event))
    }

    /// Returns the part of the interval below the contact `middle`.
    fn below(&self, middle: ContactState) -> Self {
        self.between(self.low, middle)
    }

    /// Returns the part of the interval above the contact `middle`.
    fn above(&self, middle: ContactState) -> Self {
        self.between(middle, self.high)
    }

    fn between(&self, low: ContactState, high: ContactState) -> Self {
        let overlaps =
            |piece: &&Piece<R>| piece.from <= high.indentation && piece.to > low.indentation;
        Interval {
            steps: Rc::clone(&self.steps),
            pieces: self.pieces.iter().filter(overlaps).copied().collect(),
            low,
            high,
            ..*self
        }
    }

    /// Searches the interval for a force that is more extreme than the force of `best`. If there is
    /// such a force, replaces `best` by the contact with this force. The forces at both ends of the
    /// interval must not be more extreme than the force of `best`.
    pub fn extreme(&self, extreme: Extreme, best: &mut ContactState) {
        let (from, to) = self.ends();
        if !extreme.may_lie(&self.low, &self.high, best) || from.next_up() >= to {
            return;
        }
        if let Some(middle) = self.middle() {
            if extreme.is_beyond(&middle, best) {
                *best = middle;
            }
            self.above(middle).extreme(extreme, best);
            self.below(middle).extreme(extreme, best);
            return;
        }
        let before = to.next_down();
        let indentation = match extreme {
            Extreme::Smallest => self.flattest(to).min(before),
            // If the force drops in a jump at the upper end, its largest value is just before the
            // jump.
            Extreme::Largest => before,
        };
        let state = self.steady(from, indentation);
        if extreme.is_beyond(&state, best) {
            *best = state;
        }
    }

    /// Finds the parts of the interval that a loading with an instrument passes in jumps, in the
    /// order of the motion, and calls `found` with each. C(d) is the common compression of contact
    /// and instrument in m at the indentation d, and E(d) is the largest C up to d. A loading jumps
    /// where C < E, and the area is ∫ (E − C) dd. `largest` is E at the lower end of the interval,
    /// and is replaced by E at the upper end.
    pub fn jumped_on_loading(&self, largest: &mut f64, found: &mut dyn FnMut(Jumped)) {
        if let Some(middle) = self.middle() {
            self.below(middle).jumped_on_loading(largest, found);
            self.above(middle).jumped_on_loading(largest, found);
            return;
        }
        let (from, to) = self.ends();
        // The compression is convex: it falls up to `flattest` and rises beyond.
        let flattest = self.flattest(to);
        let start = self.compression(from);
        let end = self.compression(to);
        let level = largest.max(start);
        *largest = level.max(end);
        if flattest <= from && start >= level {
            return;
        }
        // The body jumps from the lower end to the indentation at which the compression has
        // returned to its largest value so far.
        let back = if end <= level {
            to
        } else {
            crossing(from, to, |indentation| {
                self.compression(indentation) - level
            })
        };
        found(Jumped {
            low: from,
            high: back,
            level,
            area: level * (back - from) - self.work(from, back),
        });
    }

    /// Finds the parts of the interval that an unloading with an instrument passes in jumps, in the
    /// order of the motion, and calls `found` with each. C(d) is the common compression of contact
    /// and instrument in m at the indentation d, and E(d) is the smallest C on the unloading down
    /// to d. An unloading jumps where C > E, and the area is ∫ (C − E) dd. `smallest` is E at the
    /// upper end of the interval, and is replaced by E at the lower end.
    pub fn jumped_on_unloading(&self, smallest: &mut f64, found: &mut dyn FnMut(Jumped)) {
        if let Some(middle) = self.middle() {
            self.above(middle).jumped_on_unloading(smallest, found);
            self.below(middle).jumped_on_unloading(smallest, found);
            return;
        }
        let (from, to) = self.ends();
        // The compression is convex: it falls up to `flattest` and rises beyond.
        let flattest = self.flattest(to);
        let level = *smallest;
        let least = self.compression(flattest);
        if least >= level {
            return found(Jumped {
                low: from,
                high: to,
                level,
                area: self.work(from, to) - level * (to - from),
            });
        }
        let mut back = to;
        if self.compression(to) > level {
            back = last_before(flattest, to, |indentation| {
                self.compression(indentation) - level
            });
        }
        *smallest = least;
        if back < to {
            found(Jumped {
                low: back,
                high: to,
                level,
                area: self.work(back, to) - level * (to - back),
            });
        }
        if from < flattest {
            found(Jumped {
                low: from,
                high: flattest,
                level: least,
                area: self.work(from, flattest) - least * (flattest - from),
            });
        }
    }

    /// Computes ∫ C dd over the indentation d between two indentations in m without an event
    /// between them, where C is the compression. The integral is half of the growth of (∫ (d − c)²
    /// dx minus the sum of the squared stretches with which springs attach at the moving edges).
    fn work(&self, low: f64, high: f64) -> f64 {
        let from = self.low.indentation;
        let squares_at = |indentation| self.steady(from, indentation).squares(&self.scale);
        let squares = squares_at(high) - squares_at(low);
        let surface = self.surface(high) - self.surface(low);
        let instrument = self.instrument * (high - low) * (high + low);
        0.5 * (squares - surface + instrument)
    }

    /// Returns the sum of [`Slider::surface`] over all patches at an indentation in m. No event may
    /// lie between the lower end of the interval and this indentation.
    fn surface(&self, indentation: f64) -> f64 {
        let sliders = self.sliders(self.low.indentation);
        sliders.map(|slider| slider.surface(indentation)).sum()
    }

    /// Returns the smallest indentation in m in the interval at which the compression is at least
    /// `wanted` in m. Returns `None` if there is no such indentation. The compression is the force
    /// divided by the stiffness of one spring. At the lower end of the interval the compression
    /// must be less than `wanted`.
    pub fn first_at_least(&self, wanted: f64) -> Option<f64> {
        if upper_bound(&self.low, &self.high) < wanted {
            return None;
        }
        if let Some(middle) = self.middle() {
            let lower = self.below(middle).first_at_least(wanted);
            return lower.or_else(|| self.above(middle).first_at_least(wanted));
        }
        // The compression is convex and less than `wanted` at the lower end, so it reaches `wanted`
        // at most once.
        let (from, to) = self.ends();
        let passes = |indentation: f64| self.compression(indentation) - wanted;
        if passes(to) >= 0.0 {
            let first = crossing(from, to, passes);
            if first < to {
                return Some(first);
            }
        }
        (self.high.compression >= wanted).then_some(to)
    }

    /// Returns the largest indentation in m in the interval at which the compression is at most
    /// `wanted` in m. Returns `None` if there is no such indentation. The compression is the force
    /// divided by the stiffness of one spring. At the upper end of the interval the compression
    /// must be more than `wanted`.
    pub fn last_at_most(&self, wanted: f64) -> Option<f64> {
        let (from, to) = self.ends();
        if lower_bound(&self.low, &self.high) > wanted || from >= to {
            return None;
        }
        if let Some(middle) = self.middle() {
            if let Some(upper) = self.above(middle).last_at_most(wanted) {
                return Some(upper);
            }
            if middle.compression <= wanted {
                return Some(middle.indentation);
            }
            return self.below(middle).last_at_most(wanted);
        }
        let last = to.next_down().max(from);
        let passes = |indentation: f64| self.compression(indentation) - wanted;
        let flattest = self.flattest(last);
        if passes(flattest) > 0.0 {
            return (self.low.compression <= wanted).then_some(from);
        }
        if passes(last) > 0.0 {
            // The compression rises at indentations above `flattest`.
            return Some(last_before(flattest, last, passes));
        }
        Some(last)
    }
}

impl<R> Piece<R> {
    fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}
