//! Spans of neighbouring springs that one patch holds, and their levels. The level of a patch is
//! the gap at which its edges lie. The length of the patch and its edge cells follow from the
//! level.

use asperity_data::CompensatedSum;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Rule for the edges of a contact patch. An edge lies either in the middle between two springs, or
/// anywhere between them.
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
    /// Rule of Popov and Filippov (2012): a patch of n springs has the length n Δx. Its edges lie
    /// in the middle between two springs. Errors of forces and energies are proportional to the
    /// spacing Δx of the springs.
    Grid,
    /// The profile is straight between neighbouring springs, and an edge may lie at any place
    /// between two springs. Errors of forces and energies are proportional to the square of the
    /// spacing Δx of the springs, or to Δx under a flat punch.
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

/// Springs `first..=last` of one patch, and their largest gap in m.
///
/// In equilibrium each patch is a span whose two neighbouring springs have larger gaps than all its
/// own springs. This holds under any loading history. Such a span is a subtree of the max-Cartesian
/// tree of the gaps, in which the leftmost of equal gaps is nearest the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub gap: f64,
    pub first: usize,
    pub last: usize,
}

impl Span {
    /// Extends the span over neighbouring springs with gaps up to `level` in m, but not beyond the
    /// springs of `limits`, the leftmost and the rightmost one.
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

    /// Returns the index of the wall. The wall is the spring with the smaller gap of the two
    /// springs beside the span; it attaches next. `None` if the span fills the profile.
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

    /// Returns this span extended by `wall`, the spring beside it that attaches next.
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

    /// Returns this span extended by its wall, or unchanged if it fills the profile.
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

/// Returns the smaller of two numbers that are not NaN. `f64::min` would check for NaN.
#[inline]
pub fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// Returns the larger of two numbers that are not NaN.
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Length of a patch on one span as a function of its level t in m: `length + growth (t − gap)`
/// cells, for t from `gap` to `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Largest gap of the span in m, the lowest level.
    pub gap: f64,
    /// Length of the patch at the lowest level, in cells.
    pub length: f64,
    /// Growth of the length with the level in cells per metre.
    pub growth: f64,
    /// Highest level in m: the gap of the wall, or infinity where the span fills the profile.
    pub top: f64,
}

/// Returns the growth in 1/m of the share of a cell that fills over this height of the level in m.
/// A cell that fills at once, or too fast for a number, has no growth.
#[inline]
fn growth_over(height: f64) -> f64 {
    let growth = height.recip();
    if growth < f64::INFINITY { growth } else { 0.0 }
}

/// Sums over the two cells at the edges of a patch, which are only partly in contact, at one
/// indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCells {
    /// Length in contact within both cells, in cells.
    pub length: f64,
    /// Compression ∫ (d − c) dx over the length in contact, in cells times metres.
    pub compression: f64,
    /// ∫ (d − c)² dx over the length in contact, in cells times m².
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

/// Part of an edge cell that lies below the level of the edge. The cell reaches from the last
/// spring of a span to the first spring outside.
#[derive(Clone, Copy)]
pub struct EdgeCell {
    /// Gap in m of the first spring outside. It is infinite at the end of the foundation, which
    /// lies half a cell away.
    outside: f64,
    /// Share of the cell that lies at or below the level.
    pub share: f64,
    /// Growth of the share with the level in 1/m; zero where the share is constant or jumps.
    growth: f64,
    /// 2 ∫ (t − c) dx over the part of the cell below the level t, in cells times metres.
    carries: f64,
    /// ∫ (t − c)² dx over the part of the cell below the level t, in cells times m².
    squares: f64,
}

impl EdgeCell {
    /// Returns the left and the right edge cell of a span whose edges lie at `level` in m. The
    /// level is between the largest gap of the span and the gap of its wall.
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

    /// Creates the cell between the last spring of a span with the gap `inside` and the first
    /// spring beside it with the gap `outside`. All values are in m.
    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let height = outside - inside;
        let above = level - inside;
        if height == f64::INFINITY {
            // At the end of the foundation half a cell has the gap of its spring everywhere.
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

    /// Computes ∫ (c − θ)² dx over the part of the cell below the level t = θ + `above` (m), in
    /// cells times m².
    pub fn squares_below(&self, above: f64) -> f64 {
        (above * self.share - self.carries) * above + self.squares
    }
}

impl Levels {
    /// Returns the levels of a span on a profile that is straight between springs, and its two edge
    /// cells at the lowest level.
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

    /// Returns the length in cells at the level `gap + rise` in m.
    #[inline]
    pub fn length_at(&self, rise: f64) -> f64 {
        self.length + self.growth * rise
    }

    /// Returns the height in m of the edges above the largest gap, by the rule of Hess at an
    /// indentation in m. `stretch` is the largest stretch in m of a patch one cell long.
    #[inline]
    pub fn rise(&self, stretch: f64, indentation: f64) -> f64 {
        if self.growth <= 0.0 {
            0.0
        } else {
            self.free_rise(stretch, indentation - self.gap)
        }
    }

    /// Returns √ℓ of a patch whose edges are free to move. `stretch` is the largest stretch in m of
    /// a patch one cell long, and `above` the indentation minus the largest gap in m.
    ///
    /// With y = √ℓ the level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic
    /// in y.
    #[inline]
    fn root(&self, stretch: f64, above: f64) -> f64 {
        let half = 0.5 * stretch * self.growth;
        let square = (half * half + self.length) + self.growth * above;
        // A square that is not a number results from growth without bound; then only `half` counts.
        half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }

    /// Returns the height in m of free edges above the largest gap, limited to the levels of the
    /// span.
    #[inline]
    fn free_rise(&self, stretch: f64, above: f64) -> f64 {
        let rise = above + stretch * self.root(stretch, above);
        let most = self.top - self.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }

    /// Returns the indentation in m at which edges that are pinned at the height `rise` (m) begin
    /// to move. The second value is true if the edges then slide, and false if they jump. `stretch`
    /// is the largest stretch in m of a patch one cell long.
    #[inline]
    pub fn release(&self, stretch: f64, rise: f64) -> (f64, bool) {
        let length = self.length_at(rise);
        let root = 0.5 * stretch * self.growth;
        let released = (self.gap + rise) - stretch * length.sqrt();
        // φ rises with the level where √ℓ exceeds half of stretch × growth.
        let slides = root * root <= length;
        (released, slides)
    }
}

/// The two edge cells of a span. Their edges slide with the indentation, or are pinned at one
/// level.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    levels: Levels,
    /// Largest stretch in m of a patch one cell long.
    stretch: f64,
    /// Number of whole cells between the springs of the span.
    cells: f64,
    /// Length of the edge cells in contact at the level of the largest gap, in cells.
    edges: f64,
    /// Compression of the edge cells in cells times m, where the level and the indentation equal
    /// the largest gap.
    compression: f64,
    /// Squared compression of the edge cells in cells times m², also there.
    squares: f64,
}

impl Slider {
    /// Creates the edge cells of a span. `stretch` is the largest stretch in m of a patch one cell
    /// long. `pin` is the height in m above the largest gap at which the edges are pinned, or
    /// `None` if they slide.
    #[inline]
    pub fn new(gaps: &[f64], span: &Span, stretch: f64, pin: Option<f64>) -> Self {
        let (levels, [left, right]) = Levels::between_springs(gaps, span);
        let cells = span.springs() as f64 - 1.0;
        let mut slider = Slider {
            levels,
            stretch,
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

    /// Creates the cell between two springs with these gaps in m, without adhesion. It fills from
    /// the smaller gap to the larger one.
    #[inline]
    pub fn of_cell(left: f64, right: f64) -> Self {
        let gap = smaller(right, left);
        let top = larger(left, right);
        Self::without_adhesion(Levels {
            gap,
            length: 0.0,
            growth: growth_over(top - gap),
            top,
        })
    }

    /// Creates the half cell at an end of the foundation, without adhesion. It has the gap of the
    /// last spring, in m, everywhere.
    pub fn half_cell(gap: f64) -> Self {
        Self::without_adhesion(Levels {
            gap,
            length: 0.5,
            growth: 0.0,
            top: f64::INFINITY,
        })
    }

    #[inline]
    fn without_adhesion(levels: Levels) -> Self {
        Slider {
            levels,
            stretch: 0.0,
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
        let rise = self.levels.free_rise(self.stretch, above);
        let grown = self.levels.growth * rise;
        EdgeCells {
            length: self.edges + grown,
            compression: (self.edges * above + self.compression) + grown * (above - 0.5 * rise),
            squares: (self.edges * above + 2.0 * self.compression) * above
                + self.squares
                + grown * (above * (above - rise) + rise * rise * (1.0 / 3.0)),
        }
    }

    /// Returns ½ (stretch ℓ)² in cells times m², at an indentation in m. It is the sum of the
    /// squared stretches with which springs attached as the edges moved. It equals twice the
    /// surface energy of the patch over the stiffness of a spring.
    pub fn surface(&self, indentation: f64) -> f64 {
        let length = self.stretch * (self.cells + self.edge_cells(indentation).length);
        0.5 * length * length
    }

    /// Returns the derivative of the compression of the edge cells with respect to the indentation
    /// (m), in cells.
    ///
    /// The edges move with the indentation. The derivative is therefore ℓ (2y − 3k)/(2y − k) minus
    /// the number of whole cells, with y = √ℓ and k = stretch × growth. The derivative only grows
    /// with the indentation, so the force is convex between events.
    pub fn stiffness(&self, indentation: f64) -> f64 {
        let levels = self.levels;
        let above = indentation - levels.gap;
        let rise = levels.free_rise(self.stretch, above);
        // k of the formula above.
        let fall = self.stretch * levels.growth;
        if fall <= 0.0 {
            // Edges that do not move, or that bear no stretch.
            return self.edges + levels.growth * rise;
        }
        // The edges also slide at the ends of their levels, to one side at least.
        let root = levels.root(self.stretch, above);
        let rises = 2.0 * root - fall;
        if rises > 0.0 {
            levels.length_at(rise) * (2.0 * root - 3.0 * fall) / rises - self.cells
        } else {
            // The edges of a patch that is about to detach recede without bound.
            f64::NEG_INFINITY
        }
    }
}
