//! Neighbouring springs that one fragment holds, and their growth along the line.

/// Springs `first..=last` of one fragment and their largest gap, m.
///
/// Every fragment in equilibrium under any loading history is a span all of whose neighbours have larger gaps: a
/// subtree of the max-Cartesian tree of the gaps, where of equal gaps the leftmost is nearest the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Largest gap, m.
    pub gap: f64,
    /// First spring.
    pub first: usize,
    /// Last spring.
    pub last: usize,
}

impl Span {
    /// The largest span of its branch within these first and last springs whose walls lie above a level, m; itself if its
    /// walls do already.
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

    /// The spring that attaches next, the lower one beside the span; `None` where it fills the line.
    #[inline]
    pub fn wall(&self, gaps: &[f64]) -> Option<usize> {
        match (self.first.checked_sub(1), gaps.get(self.last + 1)) {
            (Some(left), Some(&right)) => Some(if right <= gaps[left] { self.last + 1 } else { left }),
            (Some(left), None) => Some(left),
            (None, Some(_)) => Some(self.last + 1),
            (None, None) => None,
        }
    }

    /// The span extended by the spring beside it that attaches next.
    #[inline]
    pub fn with(&self, gaps: &[f64], wall: usize) -> Self {
        let gap = gaps[wall];
        if wall > self.last { Span { gap, last: wall, ..*self } } else { Span { gap, first: wall, ..*self } }
    }

    /// The next larger span, if there is one.
    #[inline]
    pub fn grown(&self, gaps: &[f64]) -> Self {
        self.wall(gaps).map_or(*self, |wall| self.with(gaps, wall))
    }

    /// Number of springs.
    #[inline]
    pub fn springs(&self) -> usize {
        self.last + 1 - self.first
    }

    /// First and last spring.
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
