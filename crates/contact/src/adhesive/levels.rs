//! Spans, neighbouring springs that one fragment holds, and their levels: length, edges and edge cells as the edges slide.

use asperity_data::CompensatedSum;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Edge model of a contact patch.
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
    /// The rule of the paper: a patch of n springs is n Δx long.
    Grid,
    /// The profile is straight from spring to spring, and a patch ends where the profile crosses the level of the
    /// patch: the error falls with Δx².
    SubCell,
}

impl Edges {
    /// Name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Edges::Grid => "Grid",
            Edges::SubCell => "SubCell",
        }
    }
}

/// Springs `first..=last` of one fragment and their largest gap, m.
///
/// Every fragment in equilibrium under any loading history is a span all of whose neighbours have larger gaps: a
/// subtree of the max-Cartesian tree of the gaps, where of equal gaps the leftmost is nearest the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub gap: f64,
    pub first: usize,
    pub last: usize,
}

impl Span {
    /// The largest span around this one within the springs `lowest..=highest` whose two neighbours have gaps above `level`,
    /// m; this span where they do already.
    #[inline]
    pub fn up_to(&self, gaps: &[f64], level: f64, [lowest, highest]: [u32; 2]) -> Self {
        let Span { gap, mut first, mut last } = *self;
        while first > lowest as usize && gaps[first - 1] < level {
            first -= 1;
        }
        while last < highest as usize && gaps[last + 1] <= level {
            last += 1;
        }
        Span { gap: larger(gap, larger(gaps[first], gaps[last])), first, last }
    }

    /// Index of the wall, the spring beside the span with the smaller gap, which attaches next; `None` if the span fills
    /// the line.
    #[inline]
    pub fn wall(&self, gaps: &[f64]) -> Option<usize> {
        match (self.first.checked_sub(1), gaps.get(self.last + 1)) {
            (Some(left), Some(&right)) => Some(if right <= gaps[left] { self.last + 1 } else { left }),
            (Some(left), None) => Some(left),
            (None, Some(_)) => Some(self.last + 1),
            (None, None) => None,
        }
    }

    /// This span extended by `wall`, the spring beside it that attaches next.
    #[inline]
    pub fn with(&self, gaps: &[f64], wall: usize) -> Self {
        let gap = gaps[wall];
        if wall > self.last { Span { gap, last: wall, ..*self } } else { Span { gap, first: wall, ..*self } }
    }

    /// This span extended by its wall; unchanged if it fills the line.
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

/// The smaller of two numbers, neither of which is NaN: `f64::min` would check for NaN.
#[inline]
pub fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger of two numbers, neither of which is NaN.
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Length of a span at level t: `length + growth (t − gap)` cells, from its largest gap up to `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Largest gap of the span, m.
    pub gap: f64,
    /// Length at this level, in cells.
    pub length: f64,
    /// Growth of the length with the level, cells per metre.
    pub growth: f64,
    /// Gap of the wall, m; infinite where the span fills the line.
    pub top: f64,
}

/// Contribution of the two cells at the edges of a fragment, beside its full ones, at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCells {
    /// Length of both cells in contact, in cells.
    pub length: f64,
    /// Compression ∫ (d − c) dx over the length in contact, in cells times metres.
    pub compression: f64,
    /// ∫ (d − c)² dx over the length in contact, in cells times m².
    pub squares: f64,
}

/// Compensated sum of the edge cells of many fragments.
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
        let EdgeSum { length, compression, squares } = *self;
        EdgeCells { length: length.total(), compression: compression.total(), squares: squares.total() }
    }
}

/// Part of a cell below the level of an edge: from the last spring of a span to the first one outside.
#[derive(Clone, Copy)]
pub struct EdgeCell {
    /// Gap of the first spring outside, m; infinite beyond the end of the foundation, half a cell away.
    outside: f64,
    /// Share of the cell at or below the level.
    pub share: f64,
    /// Growth of the share with the level, 1/m; zero where the share is constant or jumps.
    growth: f64,
    /// 2 ∫ (t − c) dx over the part of the cell below the level t, in cells times metres.
    carries: f64,
    /// ∫ (t − c)² dx over the part of the cell below the level t, in cells times m².
    squares: f64,
}

impl EdgeCell {
    /// Left and right edge cell of a span with its edges at `level`, m, between the largest gap of the span and the gap of
    /// its wall.
    #[inline]
    pub fn of(gaps: &[f64], &Span { first, last, .. }: &Span, level: f64) -> [Self; 2] {
        let before = if first > 0 { gaps[first - 1] } else { f64::INFINITY };
        let after = gaps.get(last + 1).copied().unwrap_or(f64::INFINITY);
        [EdgeCell::new(gaps[first], before, level), EdgeCell::new(gaps[last], after, level)]
    }

    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let (height, above) = (outside - inside, level - inside);
        if height == f64::INFINITY {
            // Half a cell as level as its spring at the end of the foundation.
            return EdgeCell {
                outside,
                share: 0.5,
                growth: 0.0,
                carries: above,
                squares: 0.5 * above * above,
            };
        }
        // Level cells count at once, and cells too steep for a growth have none.
        let growth = Some(height.recip()).filter(|&growth| growth < f64::INFINITY).unwrap_or(0.0);
        let (share, above) = match above < height {
            true if growth > 0.0 => (above * growth, above),
            true => (above / height, above),
            false => (1.0, height),
        };
        let carries = above * share;
        EdgeCell { outside, share, growth, carries, squares: carries * above * (1.0 / 3.0) }
    }

    /// ∫ (c − θ)² dx over the part of the cell below the level t = θ + `above` (m), in cells times m².
    pub fn squares_below(&self, above: f64) -> f64 {
        (above * self.share - self.carries) * above + self.squares
    }
}

impl Levels {
    /// Levels of a span on a line that is straight between springs, and its two edge cells at the level of its largest gap.
    #[inline]
    pub fn between_springs(gaps: &[f64], span: &Span) -> (Self, [EdgeCell; 2]) {
        let cells = EdgeCell::of(gaps, span, span.gap);
        let [left, right] = cells;
        let length = (span.last - span.first) as f64 + (left.share + right.share);
        let (growth, top) = (left.growth + right.growth, left.outside.min(right.outside));
        (Levels { gap: span.gap, length, growth, top }, cells)
    }

    /// Length at the level `gap + rise` (m), in cells.
    #[inline]
    pub fn length_at(&self, rise: f64) -> f64 {
        self.length + self.growth * rise
    }

    /// Height above the largest gap, m, at which edges under the rule of Hess with this stretch of a unit fragment (m) lie
    /// at an indentation, m.
    #[inline]
    pub fn rise(&self, stretch: f64, indentation: f64) -> f64 {
        if self.growth <= 0.0 { 0.0 } else { self.free_rise(stretch, indentation - self.gap) }
    }

    /// √ℓ of a fragment with free edges, for the stretch of a unit fragment (m) and an indentation `above` the gap (m).
    ///
    /// With y = √ℓ the level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic in y.
    #[inline]
    fn root(&self, stretch: f64, above: f64) -> f64 {
        let half = 0.5 * stretch * self.growth;
        let square = (half * half + self.length) + self.growth * above;
        // A square that is not a number results from growth without bound; then only `half` counts.
        half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }

    /// Height of free edges above the gap, m, limited to the range of the span.
    #[inline]
    fn free_rise(&self, stretch: f64, above: f64) -> f64 {
        let rise = above + stretch * self.root(stretch, above);
        let most = self.top - self.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }

    /// Indentation at which edges pinned at this rise (m) begin to move, m, and true if they then slide rather than jump.
    /// `stretch` is the largest stretch of a unit fragment, m.
    #[inline]
    pub fn release(&self, stretch: f64, rise: f64) -> (f64, bool) {
        let length = self.length_at(rise);
        let root = 0.5 * stretch * self.growth;
        // φ rises with the level where √ℓ exceeds half of stretch × growth.
        ((self.gap + rise) - stretch * length.sqrt(), root * root <= length)
    }
}

/// The edge cells of a span as they slide with the indentation, or pinned.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    levels: Levels,
    /// Largest stretch of a fragment one cell long, m.
    stretch: f64,
    /// Number of whole cells between the springs of the span.
    cells: f64,
    /// Length of the edge cells in contact at the level of the largest gap, in cells.
    edges: f64,
    /// Compression and squared compression of the edge cells at the level and the indentation of the largest gap, in cells
    /// times m and cells times m².
    compression: f64,
    squares: f64,
}

impl Slider {
    /// The edge cells of a span. `stretch` is the largest stretch of a fragment one cell long, m; `pin` is the height above
    /// the gap, m, at which the edges are pinned, or `None` if they slide.
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

    /// A cell between two springs with these gaps, m, without adhesion: it fills from the smaller gap to the larger one.
    #[inline]
    pub fn of_cell(one: f64, other: f64) -> Self {
        let (gap, top) = if one < other { (one, other) } else { (other, one) };
        let growth = Some((top - gap).recip()).filter(|growth| growth.is_finite()).unwrap_or(0.0);
        Self::without_adhesion(Levels { gap, length: 0.0, growth, top })
    }

    /// Half cell at an end of the foundation, without adhesion. Its gap, m, is constant: the gap of the last spring.
    pub fn half_cell(gap: f64) -> Self {
        Self::without_adhesion(Levels { gap, length: 0.5, growth: 0.0, top: f64::INFINITY })
    }

    #[inline]
    fn without_adhesion(levels: Levels) -> Self {
        Slider { levels, stretch: 0.0, cells: 0.0, edges: levels.length, compression: 0.0, squares: 0.0 }
    }

    /// Contribution of the edge cells at an indentation, m.
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

    /// Twice the surface energy of the fragment at an indentation (m) over the stiffness of a spring, in cells times m²: ½
    /// (stretch ℓ)², the sum of the squared stretches with which springs attached as its edges moved.
    pub fn surface(&self, indentation: f64) -> f64 {
        let length = self.stretch * (self.cells + self.edge_cells(indentation).length);
        0.5 * length * length
    }

    /// Derivative of the compression of the edge cells with respect to the indentation (m), in cells.
    ///
    /// It is ℓ (2y − 3k)/(2y − k) less the whole cells, with y = √ℓ and k = stretch × growth, since the edges move with the
    /// indentation. It only grows with the indentation: between events the force is convex.
    pub fn stiffness(&self, indentation: f64) -> f64 {
        let (levels, above) = (self.levels, indentation - self.levels.gap);
        let (rise, fall) = (levels.free_rise(self.stretch, above), self.stretch * levels.growth);
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
            // Edges of a fragment about to detach run away at once.
            f64::NEG_INFINITY
        }
    }
}
