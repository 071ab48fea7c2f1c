//! Adhesive contact: the exact force curve of a loading history with turning points.
//!
//! The local maxima of the gap form a `ContactTree`. A pass over the tree for a loading closes its
//! nodes from below, and a pass for an unloading opens them from above. Both passes list *runs*:
//! patches over ranges of indentation in which their edges move without a jump. Curves, extremes
//! and energies are sums over the runs. Only the edge model defines the length of a patch.

pub(crate) mod levels;
pub(crate) mod loading;
pub(crate) mod run;
pub(crate) mod tree;
pub(crate) mod unloading;
use levels::Span;
use run::{Ground, Held, Run};

use crate::contact_state::{ContactState, Grid, Tally};
use crate::error::ContactError;
use crate::interval::{Intervals, Piece};
use crate::totals::SquareScale;
use asperity_data::CompensatedSum;
use levels::EdgeCell;

pub struct Runs<'a, const SLIDES: bool> {
    pub ground: Ground<'a, SLIDES>,
    pub runs: &'a [Run],
}

impl<const SLIDES: bool> Runs<'_, SLIDES> {
    /// Returns the patches in contact at an indentation in m, from left to right. With `pins` each
    /// has the height of its edges, which stay in place at the beginning of the next motion.
    pub fn held_at(&self, indentation: f64, pins: bool) -> impl Iterator<Item = Held> {
        let ground = &self.ground;
        self.runs
            .iter()
            .rev()
            .filter(move |run| run.is_at(indentation))
            .map(move |run| {
                let span = ground.span_at(run, indentation);
                let [first, last] = span.ends();
                let pin = pins.then(|| ground.rise(&span, run.pin(), indentation));
                Held {
                    branch: run.branch,
                    first,
                    last,
                    pin,
                }
            })
    }

    /// Returns the springs of the leftmost and of the rightmost patch at an indentation in m.
    pub fn outermost(&self, indentation: f64) -> [Option<Span>; 2] {
        // Of two separate runs the right one comes first.
        let rightmost = self.runs.iter().find(|run| run.is_at(indentation));
        let leftmost = self.runs.iter().rfind(|run| run.is_at(indentation));
        [leftmost, rightmost].map(|run| run.map(|run| self.ground.span_at(run, indentation)))
    }

    /// Returns for each spring of the profile the smallest indentation in m at which it is in
    /// contact: −∞ for always, +∞ for never.
    pub fn thresholds(&self) -> Vec<f64> {
        let mut thresholds = vec![f64::INFINITY; self.ground.gaps.len()];
        // Larger patches come first; those inside have smaller thresholds.
        for run in self.runs {
            let bottom = self.ground.bottom(run);
            thresholds[bottom.first..=bottom.last].fill(run.from);
            let mut below = bottom;
            self.ground
                .each_span(run, f64::NEG_INFINITY, |span, from, _| {
                    thresholds[span.first..below.first].fill(from);
                    thresholds[below.last + 1..=span.last].fill(from);
                    below = *span;
                    false
                });
        }
        thresholds
    }

    pub fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let (ground, low, high) = (&self.ground, grid.points[0], grid.high());
        let mut tally = Tally::new(grid, SLIDES)?;
        for run in self
            .runs
            .iter()
            .filter(|run| run.from <= high && run.to > low)
        {
            let (mut first, end) = (tally.place(run.from), tally.place(run.to));
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

    /// Adds the events and the sliding edges of the motion to the intervals in which an extreme or
    /// a crossing is searched.
    pub fn search(&self, intervals: &mut Intervals) {
        let (ground, (low, high)) = (&self.ground, intervals.ends());
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

/// Sum of squared stretches ∫ (c − θ)² dx in cells times m². Whole springs or cells are summed as
/// exact integers, edge cells as floating-point numbers.
struct SquaredStretch {
    scale: SquareScale,
    whole: i128,
    edges: CompensatedSum,
}

impl SquaredStretch {
    /// Creates an empty sum for indentations θ between `−largest` and `largest` in m.
    fn new<const SLIDES: bool>(ground: &Ground<'_, SLIDES>, largest: f64) -> Self {
        let scale = SquareScale::new(ground.tree.scale, largest);
        SquaredStretch {
            scale,
            whole: 0,
            edges: CompensatedSum::default(),
        }
    }

    /// Adds (`sign` 1) or subtracts (−1) the squared stretches over a span at the indentation `at`
    /// in m. The edges of the span lie at `level` in m.
    fn add<const SLIDES: bool>(
        &mut self,
        ground: &Ground<'_, SLIDES>,
        sign: i8,
        (span, level): (&Span, f64),
        at: f64,
    ) {
        let totals = ground.totals(span);
        let (squares, remainder) = self.scale.at(&totals, totals.whole(SLIDES), at);
        self.edges.add(f64::from(sign) * remainder);
        // Sums of all runs cancel down to the energy: those in between may pass the range of
        // integers.
        self.whole = self.whole.wrapping_add(if sign < 0 {
            squares.wrapping_neg()
        } else {
            squares
        });
        if SLIDES {
            let cells = EdgeCell::of(ground.gaps, span, level);
            cells.iter().for_each(|cell| {
                self.edges
                    .add(f64::from(sign) * cell.squares_below(level - at))
            });
        }
    }

    fn total(mut self) -> f64 {
        self.edges.add(self.scale.in_metres(self.whole));
        // No sum of squares is below zero, but for rounding.
        self.edges.total().max(0.0)
    }
}

impl<const SLIDES: bool> Ground<'_, SLIDES> {
    /// Returns the level in m of the edges of a span, at an indentation that is not above the end
    /// of its run.
    fn level_up_to(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        if let Some(rise) = pin {
            return span.gap + rise;
        }
        match span.wall(self.gaps).map(|wall| self.gaps[wall]) {
            // At the attachment of the wall the level is that of the wall, also after rounding.
            Some(wall) if !self.unloading && indentation >= self.attaches_at(span, wall) => wall,
            Some(_) => self.level(span, None, indentation),
            None => span.gap,
        }
    }
}

impl<const SLIDES: bool> Runs<'_, SLIDES> {
    /// Computes ∫ (c − θ)² dx in cells times m² over the parts of the profile that attach or detach
    /// at an indentation θ above `low` and up to `high` (m). It measures the energy that springs
    /// release as they detach, and take as they attach under a stretch.
    ///
    /// A patch that forms at an indentation θ attaches all springs between its edges, except the
    /// springs of the patches inside, which end at θ. When a patch splits, the same springs detach.
    /// So most terms cancel in a sum over runs. What remains are the squared stretches at the
    /// beginning of each run, minus those at its end, and the squares along its sliding edges.
    pub fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        let ground = &self.ground;
        if ground.stretch == 0.0 {
            return 0.0;
        }
        let runs = || {
            self.runs
                .iter()
                .filter(|run| run.from <= high && run.to > low)
        };
        let events = runs()
            .flat_map(|run| [run.from, run.to])
            .filter(|at| at.is_finite());
        let mut sum =
            SquaredStretch::new(ground, events.fold(0.0, |most: f64, at| most.max(at.abs())));
        for run in runs() {
            let [(bottom, lower), (top, upper)] = self.ends_of(run, low, high);
            if run.from > low {
                sum.add(ground, 1, (&bottom, lower), run.from);
            }
            if run.to <= high {
                sum.add(ground, -1, (&top, upper), run.to);
            }
            let ends = [(bottom, lower), (top, upper)];
            let half_square = 0.5 * ground.stretch * ground.stretch;
            sum.edges.add(half_square * ground.passed_squares(ends));
        }
        sum.total()
    }

    /// Returns the smallest and the largest span of a run in the range `low..high` of indentations
    /// in m, each with the level in m of its edges there.
    fn ends_of(&self, run: &Run, low: f64, high: f64) -> [(Span, f64); 2] {
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
        let lower = ground.level(&bottom, run.pin(), run.from.max(low));
        let upper = ground.level_up_to(&top, run.pin(), run.to.min(high));
        [(bottom, lower), (top, upper)]
    }
}
