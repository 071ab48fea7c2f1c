//! Adhesive contact: the exact force curve of a loading history with turning points.
//!
//! The local maxima of the gap form a `ContactTree`. A loading passes over the tree from the leaves
//! to the root and finds where the nodes close. An unloading passes over the tree from the root to
//! the leaves and finds where the nodes open. Both passes list *runs*. A run is a patch over a
//! range of indentations in which the edges of the patch move without a jump. Curves, extremes and
//! energies are sums over the runs. The edge model, which states where edges may lie, decides the
//! length of a patch.

pub(crate) mod jumps;
pub(crate) mod levels;
pub(crate) mod loading;
pub(crate) mod run;
pub(crate) mod tree;
pub(crate) mod unloading;
use levels::Span;
use run::{Ground, HeldPatch, Run, SpanAtLevel};

use crate::contact_state::{ContactState, Grid, Tally};
use crate::detachment::DetachmentRule;
use crate::error::ContactError;
use crate::interval::{Intervals, Piece};
use crate::totals::SquareScale;
use asperity_data::CompensatedSum;
use levels::EdgeCell;

/// The runs of a motion, with the profile, the contact tree and the rule of detachment from which
/// the runs follow. A run is a patch over a range of indentations in which the edges of the patch
/// do not jump.
pub struct Runs<'a, const SLIDES: bool, R> {
    pub ground: Ground<'a, SLIDES, R>,
    pub runs: &'a [Run],
}

impl<const SLIDES: bool, R: DetachmentRule> Runs<'_, SLIDES, R> {
    /// Returns the patches in contact at an indentation in m, from left to right. If `pins` is
    /// true, each patch also has [`HeldPatch::pin`], the height of its edges. The next motion needs
    /// this height if the edges stay in place at its beginning.
    pub fn held_at(&self, indentation: f64, pins: bool) -> impl Iterator<Item = HeldPatch> {
        let runs = self.runs.iter().rev();
        runs.filter(move |run| run.is_at(indentation))
            .map(move |run| self.held(run, indentation, pins))
    }

    fn held(&self, run: &Run, indentation: f64, pins: bool) -> HeldPatch {
        let span = self.ground.span_at(run, indentation);
        let [first, last] = span.ends();
        HeldPatch {
            branch: run.branch,
            first,
            last,
            pin: pins.then(|| self.ground.rise(&span, run.pin(), indentation)),
        }
    }

    /// Returns the springs of the leftmost and of the rightmost patch at an indentation in m.
    /// Returns `None` if no patch is in contact.
    pub fn outermost(&self, indentation: f64) -> Option<[Span; 2]> {
        // In the list of runs, the right one of two separate runs comes first.
        let rightmost = self.runs.iter().find(|run| run.is_at(indentation));
        let leftmost = self.runs.iter().rfind(|run| run.is_at(indentation));
        let outermost = [leftmost?, rightmost?];
        Some(outermost.map(|run| self.ground.span_at(run, indentation)))
    }

    /// Returns one indentation in m for each spring of the profile: the smallest indentation at
    /// which the spring is in contact. It is −∞ for a spring that is always in contact, and +∞ for
    /// a spring that is never in contact.
    pub fn thresholds(&self) -> Vec<f64> {
        let mut thresholds = vec![f64::INFINITY; self.ground.gaps.len()];
        // First and last spring of the patches whose thresholds are known, from left to right. In
        // the list larger patches come before the smaller patches inside them, and patches on the
        // right before patches on the left; the loop goes the other way. Each spring is thus
        // visited once.
        let mut known: Vec<[usize; 2]> = Vec::new();
        for run in self.runs.iter().rev() {
            let bottom = self.ground.bottom(run);
            let mut end = bottom.last + 1;
            while let Some(&[first, last]) = known.last()
                && first >= bottom.first
            {
                thresholds[last + 1..end].fill(run.from);
                end = first;
                known.pop();
            }
            thresholds[bottom.first..end].fill(run.from);
            let mut below = bottom;
            let ground = &self.ground;
            ground.each_span(run, f64::NEG_INFINITY, |span, from, _| {
                thresholds[span.first..below.first].fill(from);
                thresholds[below.last + 1..=span.last].fill(from);
                below = *span;
                false
            });
            known.push([below.first, below.last]);
        }
        thresholds
    }

    /// Computes the contact at each point of a grid of indentations.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let low = grid.points[0];
        let high = grid.high();
        let mut tally = Tally::new(grid, SLIDES)?;
        let ground = &self.ground;
        for run in self.runs_between(low, high) {
            let mut first = tally.place(run.from);
            let end = tally.place(run.to);
            if first >= end {
                continue;
            }
            let mut span = ground.bottom(run);
            while first < end {
                span = ground.filled(run, span, tally.grid.points[first]);
                let next = tally.place(ground.filled_up_to(run, &span)).min(end);
                tally.add(first..next, ground.totals(&span));
                if SLIDES {
                    tally.slide(first..next, &ground.slider(run, &span));
                }
                first = next;
            }
        }
        tally.finish(&ground.tree.scale)
    }

    /// Returns the runs that exist at any indentation above `low` and up to `high` in m.
    #[inline]
    fn runs_between(&self, low: f64, high: f64) -> impl Iterator<Item = &Run> {
        let runs = self.runs.iter();
        runs.filter(move |run| run.from <= high && run.to > low)
    }

    /// Adds the runs of the motion to `intervals`, the parts of the motion in which an extreme or a
    /// crossing of the force is searched. A run is a patch over a range of indentations. Each run
    /// adds two events, at which its patch appears and disappears. If edges move between springs,
    /// each run also adds its edge cells.
    pub fn search(&self, intervals: &mut Intervals<R>) {
        let ground = &self.ground;
        let (low, high) = intervals.ends();
        for run in self.runs {
            if intervals.between(run.from, run.to).is_empty() {
                continue;
            }
            ground.each_span(run, low, |span, from, to| {
                if low < to && from <= high {
                    intervals.add_events(from, to, ground.totals(span));
                    if SLIDES {
                        intervals.add_piece(Piece {
                            slider: ground.slider(run, span),
                            from,
                            to,
                        });
                    }
                }
                from > high
            });
        }
    }
}

/// Sum of squared stretches ∫ (c − θ)² dx in cells times m², where c is the gap and θ the
/// indentation. Whole springs or cells are summed as exact integers, edge cells as floating-point
/// numbers.
struct SquaredStretch {
    scale: SquareScale,
    whole: i128,
    edges: CompensatedSum,
}

impl SquaredStretch {
    /// Creates an empty sum for indentations from `−largest` to `largest` in m.
    fn new<const SLIDES: bool, R: DetachmentRule>(
        ground: &Ground<'_, SLIDES, R>,
        largest: f64,
    ) -> Self {
        let scale = SquareScale::new(ground.tree.scale, largest);
        SquaredStretch {
            scale,
            whole: 0,
            edges: CompensatedSum::default(),
        }
    }

    /// Adds the squared stretches of a patch at an indentation in m if `sign` is 1, and subtracts
    /// them if `sign` is −1.
    fn add<const SLIDES: bool, R: DetachmentRule>(
        &mut self,
        ground: &Ground<'_, SLIDES, R>,
        sign: i8,
        patch: &SpanAtLevel,
        indentation: f64,
    ) {
        let totals = ground.totals(&patch.span);
        let (squares, remainder) = self.scale.at(&totals, totals.whole(SLIDES), indentation);
        let signed_squares = if sign < 0 {
            squares.wrapping_neg()
        } else {
            squares
        };
        // The sum over all runs is as small as the energy, because most terms cancel. The sum over
        // a part of the runs may exceed the range of integers, so the addition wraps around.
        self.whole = self.whole.wrapping_add(signed_squares);
        self.edges.add(f64::from(sign) * remainder);
        if SLIDES {
            let above = patch.level - indentation;
            for cell in EdgeCell::of_span(ground.gaps, &patch.span, patch.level) {
                self.edges.add(f64::from(sign) * cell.squares_below(above));
            }
        }
    }

    fn total(mut self) -> f64 {
        self.edges.add(self.scale.in_metres(self.whole));
        // A sum of squares is negative only by rounding.
        self.edges.total().max(0.0)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    /// Returns the level in m of the edges of a patch with the springs of `span`, at an indentation
    /// in m. This indentation must not be above the end of the run.
    fn level_up_to(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        if let Some(rise) = pin {
            return span.gap + rise;
        }
        let Some(wall) = span.wall(self.gaps) else {
            return span.gap;
        };
        let wall_gap = self.gaps[wall];
        // When the next spring attaches, the level is exactly its gap. The formula for the level
        // would give a rounded value.
        if !self.unloading && indentation >= self.attaches_at(span, wall_gap) {
            return wall_gap;
        }
        self.level(span, None, indentation)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Runs<'_, SLIDES, R> {
    /// Computes ∫ (c − θ)² dx in cells times m² over all parts of the profile that attach or detach
    /// at an indentation θ above `low` and up to `high` (m). c is the gap. The energy that springs
    /// release on detaching, or gain on attaching with a stretch, follows from this integral.
    ///
    /// When a patch forms at an indentation θ, all springs between its edges attach, except springs
    /// that are already in contact in smaller patches. The runs of the smaller patches end at θ.
    /// When a patch splits, the same springs detach. In a sum over runs most terms therefore
    /// cancel. The remaining terms are:
    ///
    /// * the squared stretches at the beginning of each run,
    /// * minus the squared stretches at the end of each run,
    /// * the squared stretches along the moving edges.
    pub fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        let ground = &self.ground;
        if ground.rule.bears_no_stretch() {
            return 0.0;
        }
        let mut sum = SquaredStretch::new(ground, self.largest_event(low, high));
        for run in self.runs_between(low, high) {
            let [smallest, largest] = self.ends_of(run, low, high);
            if run.from > low {
                sum.add(ground, 1, &smallest, run.from);
            }
            if run.to <= high {
                sum.add(ground, -1, &largest, run.to);
            }
            sum.edges.add(ground.passed_squares(&smallest, &largest));
        }
        sum.total()
    }

    /// Returns the largest absolute value, in m, of the indentations at which the runs between
    /// `low` and `high` (m) begin and end. Infinite indentations do not count.
    fn largest_event(&self, low: f64, high: f64) -> f64 {
        let mut largest: f64 = 0.0;
        for run in self.runs_between(low, high) {
            for event in [run.from, run.to] {
                if event.is_finite() {
                    largest = largest.max(event.abs());
                }
            }
        }
        largest
    }

    /// Returns the smallest and the largest patch of a run for indentations in the range
    /// `low..high` in m.
    fn ends_of(&self, run: &Run, low: f64, high: f64) -> [SpanAtLevel; 2] {
        let ground = &self.ground;
        let top = if run.to > high {
            ground.span_at(run, high)
        } else {
            ground.span(run.branch, run.top)
        };
        let bottom = if run.from < low {
            ground.span_at(run, low)
        } else {
            ground.bottom(run)
        };
        let smallest = SpanAtLevel {
            span: bottom,
            level: ground.level(&bottom, run.pin(), run.from.max(low)),
        };
        let largest = SpanAtLevel {
            span: top,
            level: ground.level_up_to(&top, run.pin(), run.to.min(high)),
        };
        [smallest, largest]
    }
}
