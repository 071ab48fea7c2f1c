//! Spans and levels of contact patches. A span is a range of neighbouring springs that one patch
//! contains. The level of a patch is the gap at which the edges of the patch lie. From the level
//! follow the length of the patch and the edge cells: the cells at the ends of the patch that are
//! partly in contact.

use crate::detachment::{DetachmentRule, Levels};
use asperity_data::CompensatedSum;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Edge model: where an edge of a contact patch may lie. An edge lies either only in the middle
/// between two springs, or anywhere between two springs.
///
/// ```
/// use asperity_contact::{Contact, Edges, Modulus, Move, Profile};
///
/// // A flat face of eight springs: the length in contact is the same with both edge models.
/// let flat = Profile::from_gaps(vec![0.0; 8], 1.0e-6)?;
/// for edges in [Edges::Grid, Edges::SubCell] {
///     let contact = Contact::builder(&flat, Modulus::effective(1.0e6)?).edges(edges).build()?;
///     let pressed = contact.load(&[Move::ToIndentation(1.0e-9)])?;
///     assert_eq!(pressed.curve().contact_length.last(), Some(&flat.length()));
/// }
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Edges {
    /// Rule of Popov and Filippov (2012): a patch of n springs has the length n Δx, where Δx is the
    /// spacing of the springs. The edges of the patch lie in the middle between two springs.
    /// Deviations of forces and energies from a continuous profile are proportional to Δx.
    Grid,
    /// The profile is straight between neighbouring springs, and an edge may lie anywhere between
    /// two springs. Deviations of forces and energies from a continuous profile are proportional to
    /// the square of the spacing Δx of the springs. Under a flat punch these deviations are
    /// proportional to Δx.
    SubCell,
}

impl Edges {
    /// Returns the name of the edge model in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Edges::Grid => "Grid",
            Edges::SubCell => "SubCell",
        }
    }
}

/// A span: the springs `first..=last` of one patch, and the largest gap of these springs in m.
///
/// In equilibrium the two springs beside each patch have larger gaps than all springs of the patch,
/// under any loading history. Each span is therefore a subtree of the max-Cartesian tree of the
/// gaps. If gaps are equal, the leftmost one is nearest the root of that tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub gap: f64,
    pub first: usize,
    pub last: usize,
}

impl Span {
    /// Returns the span extended by all neighbouring springs whose gaps are at most `level` in m.
    /// `limits` are the leftmost and the rightmost spring that the extended span may contain.
    #[inline]
    pub fn up_to(&self, gaps: &[f64], level: f64, limits: [u32; 2]) -> Self {
        let [leftmost, rightmost] = limits;
        let mut span = *self;
        while span.first > leftmost as usize && gaps[span.first - 1] < level {
            span.first -= 1;
        }
        while span.last < rightmost as usize && gaps[span.last + 1] <= level {
            span.last += 1;
        }
        span.gap = larger(span.gap, larger(gaps[span.first], gaps[span.last]));
        span
    }

    /// Returns the index of the spring that attaches next, called the wall. Of the two springs
    /// beside the span, the wall is the one with the smaller gap. Returns `None` if the span fills
    /// the profile.
    #[inline]
    pub fn wall(&self, gaps: &[f64]) -> Option<usize> {
        let left = self.first.checked_sub(1);
        let right = self.last + 1;
        match (left, gaps.get(right)) {
            (Some(left), Some(&right_gap)) if gaps[left] < right_gap => Some(left),
            (_, Some(_)) => Some(right),
            (left, None) => left,
        }
    }

    /// Returns this span extended by the neighbouring spring with the index `wall`, which attaches
    /// next.
    #[inline]
    pub fn with(&self, gaps: &[f64], wall: usize) -> Self {
        let mut span = *self;
        span.gap = gaps[wall];
        if wall > self.last {
            span.last = wall;
        } else {
            span.first = wall;
        }
        span
    }

    /// Returns this span extended by the spring that attaches next. A span that fills the profile
    /// is returned unchanged.
    #[inline]
    pub fn grown(&self, gaps: &[f64]) -> Self {
        self.wall(gaps).map_or(*self, |wall| self.with(gaps, wall))
    }

    #[inline]
    pub fn springs(&self) -> usize {
        self.last + 1 - self.first
    }

    #[inline]
    pub fn ends(&self) -> [u32; 2] {
        [self.first as u32, self.last as u32]
    }
}

/// Returns the smaller of two numbers, neither of which may be NaN. This function is faster than
/// `f64::min`, which checks for NaN.
#[inline]
pub fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// Returns the larger of two numbers, neither of which may be NaN.
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Returns the rate, in 1/m, at which the share of a cell that is in contact grows while the level
/// rises. `height` in m is the rise of the level that brings the whole cell into contact. If
/// `height` is so small that its inverse is infinite, returns zero.
#[inline]
fn growth_over(height: f64) -> f64 {
    let growth = height.recip();
    if growth < f64::INFINITY { growth } else { 0.0 }
}

/// Sums over the two edge cells of a patch at one indentation. The edge cells are the cells at the
/// two ends of the patch, which are only partly in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCells {
    /// Length in contact of both cells together, in cells.
    pub length: f64,
    /// Compression ∫ (d − c) dx over the length in contact, in cells times m. d is the indentation,
    /// c the gap, and x the position in cells.
    pub compression: f64,
    /// ∫ (d − c)² dx over the length in contact, in cells times m². d is the indentation, c the
    /// gap, and x the position in cells.
    pub squares: f64,
}

/// Compensated sum of the [`EdgeCells`] of many patches.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeSum {
    pub length: CompensatedSum,
    pub compression: CompensatedSum,
    pub squares: CompensatedSum,
}

impl EdgeSum {
    #[inline]
    pub fn add(&mut self, cells: EdgeCells) {
        self.length.add(cells.length);
        self.compression.add(cells.compression);
        self.squares.add(cells.squares);
    }

    pub fn total(&self) -> EdgeCells {
        EdgeCells {
            length: self.length.total(),
            compression: self.compression.total(),
            squares: self.squares.total(),
        }
    }
}

/// An edge cell of a patch: the cell between the outermost spring of the patch and the first spring
/// outside. The fields describe the part of the cell below the level of the edge, which is the gap
/// at which the edge lies.
#[derive(Clone, Copy)]
pub struct EdgeCell {
    /// Gap in m of the first spring outside. It is infinite if the patch reaches the end of the
    /// foundation, which is half a cell away from the last spring.
    outside: f64,
    /// Share of the cell, from 0 to 1, on which the gap is at most the level of the edge.
    pub share: f64,
    /// Growth of the share with the level in 1/m. It is zero if the share is constant or jumps.
    growth: f64,
    /// 2 ∫ (t − c) dx over the part of the cell below the level t, in cells times metres, where c
    /// is the gap.
    carries: f64,
    /// ∫ (t − c)² dx over the part of the cell below the level t, in cells times m², where c is the
    /// gap.
    squares: f64,
}

impl EdgeCell {
    /// Returns the left and the right edge cell of a patch with the springs of `span`. The edges of
    /// the patch lie at the gap `level` in m. The level must be at least the largest gap of the
    /// patch and at most the gap of the spring that attaches next.
    #[inline]
    pub fn of_span(gaps: &[f64], span: &Span, level: f64) -> [Self; 2] {
        let before = if span.first > 0 {
            gaps[span.first - 1]
        } else {
            f64::INFINITY
        };
        let after = gaps.get(span.last + 1).copied().unwrap_or(f64::INFINITY);
        [
            EdgeCell::new(gaps[span.first], before, level),
            EdgeCell::new(gaps[span.last], after, level),
        ]
    }

    /// Creates the cell between the outermost spring of a patch, with the gap `inside`, and the
    /// first spring outside, with the gap `outside`. The gaps and the level are in m.
    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let height = outside - inside;
        let above = level - inside;
        if height == f64::INFINITY {
            // An infinite `outside` marks the end of the foundation. The gap of the half cell there
            // is constant, so its share in contact does not grow with the level.
            return EdgeCell {
                outside,
                share: 0.5,
                growth: 0.0,
                carries: above,
                squares: 0.5 * above * above,
            };
        }
        let growth = growth_over(height);
        let mut filled = height;
        let mut share = 1.0;
        if above < height {
            filled = above;
            share = if growth > 0.0 {
                above * growth
            } else {
                above / height
            };
        }
        let carries = filled * share;
        EdgeCell {
            outside,
            share,
            growth,
            carries,
            squares: carries * filled * (1.0 / 3.0),
        }
    }

    /// Computes ∫ (c − θ)² dx in cells times m² over the part of the cell below the level t of the
    /// edge. c is the gap, and θ = t − `above` is an indentation; `above` is in m.
    pub fn squares_below(&self, above: f64) -> f64 {
        (above * self.share - self.carries) * above + self.squares
    }
}

impl Levels {
    /// Returns the length of a patch as a function of its level, and the two edge cells of the
    /// patch at its lowest level. The level is the gap at which the edges of the patch lie. The
    /// profile is straight between springs.
    #[inline]
    pub fn between_springs(gaps: &[f64], span: &Span) -> (Self, [EdgeCell; 2]) {
        let cells = EdgeCell::of_span(gaps, span, span.gap);
        let [left, right] = cells;
        let levels = Levels {
            gap: span.gap,
            length: (span.last - span.first) as f64 + (left.share + right.share),
            growth: left.growth + right.growth,
            top: left.outside.min(right.outside),
        };
        (levels, cells)
    }

    /// Returns the height in m of the edges of a patch above the largest gap of the patch, at an
    /// indentation in m. The edges are free to move.
    #[inline]
    pub fn rise<R: DetachmentRule>(&self, rule: R, indentation: f64) -> f64 {
        if self.growth <= 0.0 {
            0.0
        } else {
            self.free_rise(rule, indentation - self.gap)
        }
    }

    /// Returns the height in m of free edges above the largest gap of the patch. The height is
    /// limited to the levels at which the patch consists of the same springs. `above` is the
    /// indentation minus the largest gap in m.
    #[inline]
    fn free_rise<R: DetachmentRule>(&self, rule: R, above: f64) -> f64 {
        let rise = rule.free_rise(self, above);
        let most = self.top - self.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }

    /// Returns the indentation in m at which pinned edges of a patch begin to move, and how the
    /// edges then move: true if they slide, false if they jump. Pinned edges stay in place although
    /// the body moves. `rise` is the height of the edges in m above the largest gap of the patch.
    #[inline]
    pub fn release<R: DetachmentRule>(&self, rule: R, rise: f64) -> (f64, bool) {
        let length = self.length_at(rise);
        let released = (self.gap + rise) - rule.largest_stretch(length);
        let slides = rule.turning_length(self.growth) <= length;
        (released, slides)
    }
}

/// The two edge cells of a patch at all indentations at which the patch consists of the same
/// springs. As the indentation changes, the edges either slide, or are pinned and stay in place.
#[derive(Clone, Copy, Debug)]
pub struct Slider<R> {
    levels: Levels,
    rule: R,
    /// Number of whole cells between the springs of the patch.
    cells: f64,
    /// Length in contact of both edge cells if the level equals the largest gap, in cells.
    edges: f64,
    /// Compression of the edge cells in cells times m, if the level and the indentation equal the
    /// largest gap.
    compression: f64,
    /// Squared compression of the edge cells in cells times m², if the level and the indentation
    /// equal the largest gap.
    squares: f64,
}

impl<R: DetachmentRule> Slider<R> {
    /// Creates the two edge cells of a patch that consists of the springs of `span`. `pin` is
    /// `None` if the edges slide with the indentation. If the edges stay in place, `pin` is the
    /// height of the edges in m above the largest gap of the patch.
    #[inline]
    pub fn new(gaps: &[f64], span: &Span, rule: R, pin: Option<f64>) -> Self {
        let (levels, [left, right]) = Levels::between_springs(gaps, span);
        let cells = span.springs() as f64 - 1.0;
        let mut slider = Slider {
            levels,
            rule,
            cells,
            edges: levels.length - cells,
            compression: 0.5 * (left.carries + right.carries),
            squares: left.squares + right.squares,
        };
        if let Some(rise) = pin {
            let grown = levels.growth * rise;
            slider.levels.growth = 0.0;
            slider.edges += grown;
            slider.compression -= 0.5 * grown * rise;
            slider.squares += grown * rise * rise * (1.0 / 3.0);
        }
        slider
    }

    /// Creates a cell of a contact without adhesion, between two neighbouring springs with the gaps
    /// `left` and `right` in m. The contact in this cell grows from the smaller gap to the larger
    /// one. `no_stretch` is a rule that allows no stretch.
    #[inline]
    pub fn of_cell(left: f64, right: f64, no_stretch: R) -> Self {
        let gap = smaller(right, left);
        let top = larger(left, right);
        let levels = Levels {
            gap,
            length: 0.0,
            growth: growth_over(top - gap),
            top,
        };
        Self::without_adhesion(levels, no_stretch)
    }

    /// Creates the half cell at an end of the foundation, for a contact without adhesion. The gap
    /// in this half cell is everywhere `gap` in m, the gap of the outermost spring. `no_stretch` is
    /// a rule that allows no stretch.
    pub fn half_cell(gap: f64, no_stretch: R) -> Self {
        let levels = Levels {
            gap,
            length: 0.5,
            growth: 0.0,
            top: f64::INFINITY,
        };
        Self::without_adhesion(levels, no_stretch)
    }

    #[inline]
    fn without_adhesion(levels: Levels, no_stretch: R) -> Self {
        Slider {
            levels,
            rule: no_stretch,
            cells: 0.0,
            edges: levels.length,
            compression: 0.0,
            squares: 0.0,
        }
    }

    /// Returns the sums over both edge cells at an indentation in m.
    #[inline]
    pub fn edge_cells(&self, indentation: f64) -> EdgeCells {
        let above = indentation - self.levels.gap;
        let rise = self.levels.free_rise(self.rule, above);
        let grown = self.levels.growth * rise;
        EdgeCells {
            length: self.edges + grown,
            compression: (self.edges * above + self.compression) + grown * (above - 0.5 * rise),
            squares: (self.edges * above + 2.0 * self.compression) * above
                + self.squares
                + grown * (above * (above - rise) + rise * rise * (1.0 / 3.0)),
        }
    }

    /// Returns ∫ Δl² dℓ in cells times m², from zero to the length of the patch at an indentation
    /// in m. Δl is the largest stretch that a patch of the length ℓ bears. ℓ is given in cells, the
    /// distances between neighbouring springs. The integral is the sum of the squared stretches
    /// with which springs attached at the moving edges. Half the integral times the stiffness of a
    /// spring is the surface energy of the patch.
    pub fn surface(&self, indentation: f64) -> f64 {
        let length = self.cells + self.edge_cells(indentation).length;
        self.rule.squares_up_to(length)
    }

    /// Returns the derivative of the compression of both edge cells with respect to the
    /// indentation, in cells. This derivative never falls while the indentation grows. The force is
    /// therefore convex between two events, the indentations at which springs attach or detach.
    #[inline]
    pub fn stiffness(&self, indentation: f64) -> f64 {
        let levels = self.levels;
        let above = indentation - levels.gap;
        let rise = levels.free_rise(self.rule, above);
        if !self.rule.slides(levels.growth) {
            // The edges do not move, or move without any stretch. In both cases only the
            // compression of the length in contact changes with the indentation.
            return self.edges + levels.growth * rise;
        }
        self.rule.stiffness(&levels, above, rise) - self.cells
    }
}
