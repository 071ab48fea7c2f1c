//! Levels of a span: its length, its edges and its edge cells as the edges slide.

use super::span::Span;
use crate::contact::grid::CompensatedSum;

/// Length of a span at level t: `length + growth (t − gap)` cells, from its largest gap up to `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Largest gap of the span, m.
    pub gap: f64,
    /// Length at this level, in cells.
    pub length: f64,
    /// Growth with the level, cells per metre.
    pub growth: f64,
    /// Gap of the wall, m; infinite where the span fills the line.
    pub top: f64,
}

/// Contribution of the two cells at the edges of a fragment, beside its full ones, at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCells {
    /// Their length in contact, in cells.
    pub length: f64,
    /// The compression ∫ (d − c) dx over that, in cells times metres.
    pub compression: f64,
    /// ∫ (d − c)² dx over that, in cells times m².
    pub squares: f64,
}

/// Edge cells of many fragments, summed without loss.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeSum {
    pub length: CompensatedSum,
    pub compression: CompensatedSum,
    pub squares: CompensatedSum,
}

impl EdgeSum {
    /// Adds the edge cells of a fragment.
    #[inline]
    pub fn add(&mut self, cells: EdgeCells) {
        self.length.add(cells.length);
        self.compression.add(cells.compression);
        self.squares.add(cells.squares);
    }

    /// All edge cells.
    pub fn total(&self) -> EdgeCells {
        let EdgeSum { length, compression, squares } = *self;
        EdgeCells { length: length.total(), compression: compression.total(), squares: squares.total() }
    }
}

/// Share of an edge cell at or below a level, m, from the gap inside to the gap outside, m: all of a level cell, which
/// attaches with its spring, and half a cell at the end of the foundation (`None`).
pub fn share_below(inside: f64, outside: Option<f64>, level: f64) -> f64 {
    outside.map_or(0.5, |outside| {
        let (above, height) = (level - inside, outside - inside);
        if above < height { above / height } else { 1.0 }
    })
}

/// The cell in which an edge moves: from the last spring that is held to the first that is not.
#[derive(Clone, Copy)]
struct EdgeCell {
    /// Gap of the first spring that is not held, m; infinite beyond the end of the foundation, half a cell away.
    outside: f64,
    /// Share of the cell at or below the level, which is not below the gap inside.
    share: f64,
    /// Growth of the share with the level, 1/m; zero where it does not grow, or all at once.
    growth: f64,
    /// Twice the compression of the cell at that level and indentation, m.
    carries: f64,
    /// ∫ (t − c)² dx over the part of the cell below the level t, in cells times m².
    squares: f64,
}

impl EdgeCell {
    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let (height, above) = (outside - inside, level - inside);
        let growth = height.recip();
        if !(growth > 0.0 && growth < f64::INFINITY) {
            return EdgeCell::without_growth(outside, height, above);
        }
        let share = if above < height { above * growth } else { 1.0 };
        let carries = above * share;
        EdgeCell { outside, share, growth, carries, squares: carries * above * (1.0 / 3.0) }
    }

    /// Half a cell as level as its spring at the end of the foundation, or a cell too steep or too level to grow.
    #[cold]
    fn without_growth(outside: f64, height: f64, above: f64) -> Self {
        if height == f64::INFINITY {
            return EdgeCell {
                outside,
                share: 0.5,
                growth: 0.0,
                carries: above,
                squares: 0.5 * above * above,
            };
        }
        // 0/0 for a level cell: all of it counts.
        let share = if above < height { above / height } else { 1.0 };
        let carries = above * share;
        EdgeCell { outside, share, growth: 0.0, carries, squares: carries * above * (1.0 / 3.0) }
    }
}

impl Levels {
    /// Levels of a span on a line that is straight between springs, and for its edge cells at the level and the indentation
    /// c of its largest gap ∫ (c − c(x)) dx, in cells times metres, and ∫ (c − c(x))² dx.
    #[inline]
    pub fn between_springs(gaps: &[f64], span: &Span) -> (Self, [f64; 2]) {
        let Span { gap, first, last } = *span;
        let before = if first > 0 { gaps[first - 1] } else { f64::INFINITY };
        let after = gaps.get(last + 1).copied().unwrap_or(f64::INFINITY);
        let [left, right] = [EdgeCell::new(gaps[first], before, gap), EdgeCell::new(gaps[last], after, gap)];
        let length = (last - first) as f64 + (left.share + right.share);
        let (growth, top) = (left.growth + right.growth, left.outside.min(right.outside));
        let sums = [0.5 * (left.carries + right.carries), left.squares + right.squares];
        (Levels { gap, length, growth, top }, sums)
    }

    /// Length at a level of this rise above the gap, in cells.
    #[inline]
    pub fn length_at(&self, rise: f64) -> f64 {
        self.length + self.growth * rise
    }

    /// Height of the level of edges of this stretch (m) at an indentation above the gap, m.
    #[inline]
    pub fn rise(&self, stretch: f64, indentation: f64) -> f64 {
        if self.growth <= 0.0 { 0.0 } else { Slide::new(*self, stretch).rise(indentation - self.gap) }
    }

    /// Indentation at which edges of this stretch (m), pinned at this rise (m), begin to move, and true if they then
    /// slide instead of running away.
    #[inline]
    pub fn release(&self, stretch: f64, rise: f64) -> (f64, bool) {
        let length = self.length_at(rise);
        let root = 0.5 * stretch * self.growth;
        // φ rises with the level where √ℓ exceeds half of stretch × growth.
        ((self.gap + rise) - stretch * length.sqrt(), root * root <= length)
    }

    /// Returns true if edges of this stretch (m) pass from here to the next larger span without a jump.
    #[inline]
    pub fn slide_on(&self, stretch: f64, upper: &Levels) -> bool {
        // φ rises from the lowest level of the upper span on, and that span adds no level cell.
        let root = 0.5 * stretch * upper.growth;
        let reached = self.length_at(self.top - self.gap);
        root * root < upper.length && upper.length - reached < 0.25
    }
}

/// Edges of a span that slide with the indentation.
///
/// With y = √ℓ the level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic in y.
#[derive(Clone, Copy, Debug)]
struct Slide {
    levels: Levels,
    stretch: f64,
    /// ½ stretch × growth.
    half: f64,
    /// half² + length.
    square: f64,
}

impl Slide {
    #[inline]
    fn new(levels: Levels, stretch: f64) -> Self {
        let half = 0.5 * stretch * levels.growth;
        Slide { levels, stretch, half, square: half * half + levels.length }
    }

    /// √ℓ at an indentation `above` the gap.
    #[inline]
    fn root(&self, above: f64) -> f64 {
        let square = self.square + self.levels.growth * above;
        // A square that is not a number results from growth without bound; then only `half` counts.
        self.half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }

    /// Height of the level above the gap.
    #[inline]
    fn rise(&self, above: f64) -> f64 {
        let rise = above + self.stretch * self.root(above);
        let most = self.levels.top - self.levels.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }
}

/// The edge cells of a span as they slide with the indentation, or pinned.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    slide: Slide,
    /// Whole cells between its springs.
    cells: f64,
    /// Part of its edge cells in contact at its lowest level, in cells.
    edges: f64,
    /// Compression of the edge cells there at the indentation of the gap of the span, and their squared compression.
    compression: f64,
    squares: f64,
}

impl Slider {
    /// The edge cells of a span under this stretch (m) of a fragment of one cell, pinned at a rise, m, if there is one.
    #[inline]
    pub fn new(gaps: &[f64], span: &Span, stretch: f64, pin: Option<f64>) -> Self {
        let (levels, [compression, squares]) = Levels::between_springs(gaps, span);
        let cells = span.springs() as f64 - 1.0;
        let (slide, edges) = (Slide::new(levels, stretch), levels.length - cells);
        let mut slider = Slider { slide, cells, edges, compression, squares };
        if let Some(rise) = pin {
            let grown = levels.growth * rise;
            slider.slide.levels.growth = 0.0;
            slider.edges += grown;
            slider.compression -= 0.5 * grown * rise;
            slider.squares += grown * rise * rise * (1.0 / 3.0);
        }
        slider
    }

    /// A cell between two springs that fills from its smaller gap to its larger one without adhesion, m.
    #[inline]
    pub fn of_cell(one: f64, other: f64) -> Self {
        let (gap, top) = if one < other { (one, other) } else { (other, one) };
        let growth = Some((top - gap).recip()).filter(|growth| growth.is_finite()).unwrap_or(0.0);
        Self::without_adhesion(Levels { gap, length: 0.0, growth, top })
    }

    /// Half a cell at the end of the foundation, as level as its spring of this gap, m, without adhesion.
    pub fn half_cell(gap: f64) -> Self {
        Self::without_adhesion(Levels { gap, length: 0.5, growth: 0.0, top: f64::INFINITY })
    }

    #[inline]
    fn without_adhesion(levels: Levels) -> Self {
        let slide = Slide::new(levels, 0.0);
        Slider { slide, cells: 0.0, edges: levels.length, compression: 0.0, squares: 0.0 }
    }

    /// Contribution of the edge cells at an indentation, m.
    #[inline]
    pub fn edge_cells(&self, indentation: f64) -> EdgeCells {
        let levels = self.slide.levels;
        let above = indentation - levels.gap;
        let rise = self.slide.rise(above);
        let grown = levels.growth * rise;
        EdgeCells {
            length: self.edges + grown,
            compression: (self.edges * above + self.compression) + grown * (above - 0.5 * rise),
            squares: (self.edges * above + 2.0 * self.compression) * above
                + self.squares
                + grown * (above * (above - rise) + rise * rise * (1.0 / 3.0)),
        }
    }

    /// Growth of the compression of the edge cells with the indentation, in cells.
    ///
    /// The length times (2y − 3k)/(2y − k) with y = √ℓ and k = stretch × growth, as the edges move with the
    /// indentation, less the whole cells. This stiffness only grows with the indentation: between events the force is
    /// convex.
    pub fn stiffness(&self, indentation: f64) -> f64 {
        let Slide { levels, half, .. } = self.slide;
        let above = indentation - levels.gap;
        if levels.growth * half <= 0.0 {
            // Edges that do not move, or that bear no stretch.
            return self.edges + levels.growth * self.slide.rise(above);
        }
        let length = levels.length_at(self.slide.rise(above));
        // The edges also slide at the ends of their levels, to one side at least.
        let (root, fall) = (self.slide.root(above), 2.0 * half);
        let rises = 2.0 * root - fall;
        // Edges of a fragment about to detach run away at once.
        if rises > 0.0 { length * (2.0 * root - 3.0 * fall) / rises - self.cells } else { f64::NEG_INFINITY }
    }
}
