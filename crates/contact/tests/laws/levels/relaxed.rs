//! The rule on the line that runs straight from spring to spring, step by step along the levels: no
//! tree, no threshold, no formula of the solver.

use super::super::body::Foundation;
use crate::body::Body;
use asperity_contact::Patch;

/// Points of a stretch of levels at which the rule is evaluated before bisection.
const POINTS: usize = 24;

/// A patch: the component of {c ≤ level} that holds a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LevelPatch {
    spring: usize,
    level: f64,
}

/// A part of the line, in cells from the first spring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    from: f64,
    to: f64,
    first: usize,
    last: usize,
}

impl Part {
    fn length(&self) -> f64 {
        self.to - self.from
    }
}

/// A body that relaxes level by level.
#[derive(Clone)]
pub struct Relaxed<'a> {
    gaps: &'a [f64],
    /// E* times the length of a cell, N/m.
    stiffness: f64,
    /// m
    spacing: f64,
    /// Largest stretch of a patch one cell long before it grows, m.
    closing: f64,
    /// Largest stretch of a patch one cell long before it recedes, m.
    opening: f64,
    indentation: f64,
    patches: Vec<LevelPatch>,
}

impl<'a> Relaxed<'a> {
    pub fn new(body: &'a Body) -> Self {
        let Foundation {
            spacing, modulus, ..
        } = body.foundation;
        let [closing, opening] = [body.closing_work, body.work]
            .map(|work| (std::f64::consts::PI * spacing * work / modulus).sqrt());
        let stiffness = modulus * spacing;
        let (gaps, patches) = (body.gaps.as_slice(), Vec::new());
        Relaxed {
            gaps,
            stiffness,
            spacing,
            closing,
            opening,
            indentation: 0.0,
            patches,
        }
    }

    /// The component of {c ≤ level} (`closed`) or {c < level} around a spring in it.
    fn part(&self, spring: usize, level: f64, closed: bool) -> Part {
        let is_in = |gap: f64| if closed { gap <= level } else { gap < level };
        let edge = |inside: usize, outside: usize| {
            let (low, high) = (self.gaps[inside], self.gaps[outside]);
            ((level - low) / (high - low)).clamp(0.0, 1.0)
        };
        let (mut first, mut last) = (spring, spring);
        while first > 0 && is_in(self.gaps[first - 1]) {
            first -= 1;
        }
        while last + 1 < self.gaps.len() && is_in(self.gaps[last + 1]) {
            last += 1;
        }
        let from = first as f64
            - if first == 0 {
                0.5
            } else {
                edge(first, first - 1)
            };
        let to = last as f64
            + if last + 1 == self.gaps.len() {
                0.5
            } else {
                edge(last, last + 1)
            };
        Part {
            from,
            to,
            first,
            last,
        }
    }

    /// φ at a level for the stretch of one cell.
    fn rest(&self, stretch: f64, spring: usize, level: f64, closed: bool) -> f64 {
        level - stretch * self.part(spring, level, closed).length().sqrt()
    }

    /// Springs' gaps next above and below a level.
    fn next_gap(&self, level: f64) -> Option<f64> {
        self.gaps
            .iter()
            .copied()
            .filter(|&gap| gap > level)
            .min_by(f64::total_cmp)
    }

    fn last_gap(&self, level: f64, closed: bool) -> f64 {
        let is_in = |gap: f64| if closed { gap <= level } else { gap < level };
        self.gaps
            .iter()
            .copied()
            .filter(|&gap| is_in(gap))
            .max_by(f64::total_cmp)
            .unwrap_or(0.0)
    }

    pub fn move_to(&mut self, indentation: f64) {
        let from = std::mem::replace(&mut self.indentation, indentation);
        if indentation > from || (self.patches.is_empty() && indentation >= 0.0) {
            self.press();
        } else if indentation < from {
            self.pull();
        }
    }

    fn press(&mut self) {
        let d = self.indentation;
        for patch in &mut self.patches {
            patch.level = patch.level.max(d);
        }
        for (spring, &gap) in self.gaps.iter().enumerate() {
            if gap <= d {
                self.patches.push(LevelPatch { spring, level: d });
            }
        }
        self.merge();
        loop {
            let before = self.patches.clone();
            for index in 0..self.patches.len() {
                let LevelPatch { spring, mut level } = self.patches[index];
                while let Some(next) = self.next_gap(level) {
                    let grown = self.grow(spring, level, next);
                    if grown == level {
                        break;
                    }
                    level = grown;
                    if level < next {
                        break;
                    }
                }
                self.patches[index].level = level;
            }
            self.merge();
            if self.patches == before {
                return;
            }
        }
    }

    /// The level to which a patch grows, up to the next spring's gap.
    fn grow(&self, spring: usize, level: f64, next: f64) -> f64 {
        let holds = |at: f64| self.rest(self.closing, spring, at, at < next) <= self.indentation;
        let point = |k: usize| {
            if k == POINTS {
                next
            } else {
                level + (next - level) * k as f64 / POINTS as f64
            }
        };
        let mut reached = level;
        for k in 1..=POINTS {
            let at = point(k).min(next);
            if !holds(at) {
                return bisect(reached, at, |at| !holds(at)).0;
            }
            reached = at;
        }
        next
    }

    /// Drops patches within another one.
    fn merge(&mut self) {
        let parts: Vec<Part> = self.parts().map(|(_, part)| part).collect();
        let is_within = |a: usize, b: usize| {
            let (inner, outer) = (parts[a], parts[b]);
            if (inner.first, inner.last) == (outer.first, outer.last) {
                let (inner, outer) = (self.patches[a].level, self.patches[b].level);
                return outer > inner || (outer == inner && b < a);
            }
            outer.first <= inner.first && inner.last <= outer.last
        };
        let stays = |a: usize| !(0..parts.len()).any(|b| a != b && is_within(a, b));
        self.patches = (0..parts.len())
            .filter(|&a| stays(a))
            .map(|a| self.patches[a])
            .collect();
    }

    fn pull(&mut self) {
        // A part that a spring has just left no longer reaches up to the gap of that spring.
        let mut waiting: Vec<_> = self.patches.drain(..).map(|patch| (patch, true)).collect();
        while let Some((LevelPatch { spring, level }, closed)) = waiting.pop() {
            let below = self.last_gap(level, closed);
            let stop = below.max(self.indentation);
            match self.sink(spring, level, stop, closed) {
                Some(level) => self.patches.push(LevelPatch { spring, level }),
                // An unstretched patch stays.
                None if below <= self.indentation => {
                    let part = self.part(spring, level, closed);
                    let held = (part.first..=part.last).find(|&spring| self.gaps[spring] <= stop);
                    self.patches.extend(held.map(|spring| LevelPatch {
                        spring,
                        level: stop,
                    }));
                }
                None => {
                    // Springs of this gap detach, and each lower part goes on by itself.
                    let part = self.part(spring, level, closed);
                    let lower = |spring: usize| self.gaps[spring] < below;
                    let starts = |spring: usize| {
                        lower(spring) && (spring == part.first || !lower(spring - 1))
                    };
                    let starts = (part.first..=part.last).filter(|&spring| starts(spring));
                    waiting.extend(starts.map(|spring| {
                        (
                            LevelPatch {
                                spring,
                                level: below,
                            },
                            false,
                        )
                    }));
                }
            }
        }
    }

    /// The level down to which a patch sinks, above `stop`; `None` if it sinks to `stop`.
    fn sink(&self, spring: usize, level: f64, stop: f64, closed: bool) -> Option<f64> {
        let rest = |at: f64| self.rest(self.opening, spring, at, closed || at < level);
        if rest(level) < self.indentation {
            return Some(level);
        }
        // φ is convex between springs' gaps: its smallest value there.
        let just_above = stop.next_up().min(level);
        let (mut low, mut high) = (just_above, level);
        for _ in 0..200 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if rest(a) < rest(b) { high = b } else { low = a }
        }
        let lowest = [low, high, just_above]
            .into_iter()
            .min_by(|&a, &b| rest(a).total_cmp(&rest(b)))?;
        if rest(lowest) >= self.indentation {
            return None;
        }
        Some(bisect(lowest, level, |at| rest(at) >= self.indentation).0)
    }

    /// First and last spring of each patch.
    pub fn contacts(&self) -> Vec<Patch> {
        let mut contacts: Vec<_> = self
            .parts()
            .map(|(_, part)| Patch {
                first: part.first,
                last: part.last,
            })
            .collect();
        contacts.sort_unstable();
        contacts
    }

    /// Level of each fragment, and the positions of its edges in cells from the first spring.
    pub fn edges(&self) -> Vec<(f64, f64, f64)> {
        self.parts()
            .map(|(level, part)| (level, part.from, part.to))
            .collect()
    }

    fn parts(&self) -> impl Iterator<Item = (f64, Part)> {
        self.patches
            .iter()
            .map(|one| (one.level, self.part(one.spring, one.level, true)))
    }

    /// m
    pub fn contact_length(&self) -> f64 {
        self.parts().map(|(_, part)| part.length()).sum::<f64>() * self.spacing
    }

    /// N
    pub fn force(&self) -> f64 {
        self.stiffness * self.integral(|a, b| 0.5 * (a + b))
    }

    /// J
    pub fn stored_energy(&self) -> f64 {
        0.5 * self.stiffness * self.integral(|a, b| (a * a + a * b + b * b) / 3.0)
    }

    /// Sum over all cells in contact of a mean along them, given the compressions at their ends, in
    /// cells.
    fn integral(&self, mean: impl Fn(f64, f64) -> f64) -> f64 {
        let cell = |a: f64, b: f64| mean(self.indentation - a, self.indentation - b);
        let mut sum = 0.0;
        for (level, part) in self.parts() {
            let edges = [
                (
                    part.first as f64 - part.from,
                    self.gaps[part.first],
                    part.first == 0,
                ),
                (
                    part.to - part.last as f64,
                    self.gaps[part.last],
                    part.last + 1 == self.gaps.len(),
                ),
            ];
            for (share, gap, is_end) in edges {
                sum += share * cell(gap, if is_end { gap } else { level });
            }
            let pairs = self.gaps[part.first..=part.last].windows(2);
            sum += pairs.map(|pair| cell(pair[0], pair[1])).sum::<f64>();
        }
        sum
    }
}

/// Two neighbouring numbers between `low`, for which `is_past` is false, and `high`, for which it
/// is true.
fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> (f64, f64) {
    for _ in 0..200 {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    (low, high)
}
