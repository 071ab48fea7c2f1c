//! The approach by brute force: from each lowest spring a patch climbs from level to level, by
//! itself. No tree, no formula of the solver.
//!
//! A patch at the level t is the part of the profile around its lowest spring where the gap is at
//! most t. It reaches t at the indentation at which all lower levels are in equilibrium, which is
//! the largest one of t − Δl(ℓ(t)) up to t.

use super::super::levels::relaxed::Relaxed;
use super::brute_force::case;
use super::*;

/// A part of the profile in contact. Positions are in cells from the first spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Gap at the edges, m.
    pub level: f64,
    pub from: f64,
    pub to: f64,
    pub first: usize,
    pub last: usize,
}

/// Range of levels in which a patch has the same springs.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Levels, m.
    low: f64,
    high: f64,
    first: usize,
    last: usize,
    /// Indentation at which the patch reaches the upper level, m.
    needed: f64,
}

/// All climbs over a profile.
pub struct Climbs {
    gaps: Vec<f64>,
    /// Largest stretch of a patch one cell long, m.
    stretch: f64,
    /// The steps from each lowest spring, and its gap in m.
    climbs: Vec<(f64, Vec<Step>)>,
    /// Indentation at which each spring attaches, m.
    pub thresholds: Vec<f64>,
}

impl Climbs {
    pub fn new(body: &Body) -> Self {
        let mut climbs = Climbs {
            gaps: body.gaps.clone(),
            stretch: body.foundation.largest_stretch(body.closing_work, 1),
            climbs: Vec::new(),
            thresholds: vec![f64::INFINITY; body.gaps.len()],
        };
        for spring in 0..body.gaps.len() {
            // Of several neighbouring springs with the same gap, the first one climbs.
            let is_lowest = (spring == 0 || body.gaps[spring - 1] > body.gaps[spring])
                && body
                    .gaps
                    .get(spring + 1)
                    .is_none_or(|&gap| gap >= body.gaps[spring]);
            if is_lowest {
                climbs.climb(spring);
            }
        }
        climbs
    }

    fn climb(&mut self, spring: usize) {
        let count = self.gaps.len();
        let bottom = self.gaps[spring];
        let mut step = Step {
            low: bottom,
            high: bottom,
            first: spring,
            last: spring,
            needed: bottom,
        };
        let mut steps = Vec::new();
        loop {
            while step.first > 0 && self.gaps[step.first - 1] <= step.low {
                step.first -= 1;
            }
            while step.last + 1 < count && self.gaps[step.last + 1] <= step.low {
                step.last += 1;
            }
            for threshold in &mut self.thresholds[step.first..=step.last] {
                *threshold = threshold.min(step.needed);
            }
            let before = step.first.checked_sub(1).map(|spring| self.gaps[spring]);
            let after = self.gaps.get(step.last + 1).copied();
            step.high = before
                .unwrap_or(f64::INFINITY)
                .min(after.unwrap_or(f64::INFINITY));
            if step.high.is_infinite() {
                break;
            }
            step.needed = step.needed.max(self.balance(&step, step.high));
            steps.push(step);
            step.low = step.high;
        }
        self.climbs.push((bottom, steps));
    }

    /// The part in contact at a level of a step.
    fn part(&self, step: &Step, level: f64) -> Part {
        let share = |inside: usize, outside: usize| {
            let [low, high] = [self.gaps[inside], self.gaps[outside]];
            (level - low) / (high - low)
        };
        let Step { first, last, .. } = *step;
        let left = match first {
            0 => 0.5,
            _ => share(first, first - 1),
        };
        let right = if last + 1 == self.gaps.len() {
            0.5
        } else {
            share(last, last + 1)
        };
        Part {
            level,
            from: first as f64 - left,
            to: last as f64 + right,
            first,
            last,
        }
    }

    /// Indentation at which a level of a step is in equilibrium, m.
    fn balance(&self, step: &Step, level: f64) -> f64 {
        let part = self.part(step, level);
        level - self.stretch * (part.to - part.from).sqrt()
    }

    /// The part in contact around the lowest spring of a climb, at an indentation above its gap.
    fn reached(&self, steps: &[Step], indentation: f64) -> Part {
        let passed = steps.partition_point(|step| step.needed <= indentation);
        let Some(step) = steps.get(passed) else {
            // All springs are in contact.
            let whole = Step {
                low: f64::INFINITY,
                high: f64::INFINITY,
                first: 0,
                last: self.gaps.len() - 1,
                needed: indentation,
            };
            return self.part(&whole, f64::INFINITY);
        };
        let [mut low, mut high] = [step.low, step.high];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.balance(step, middle) <= indentation {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.part(step, low)
    }

    /// The parts in contact at an indentation, from left to right.
    pub fn parts(&self, indentation: f64) -> Vec<Part> {
        let touching = self
            .climbs
            .iter()
            .filter(|(bottom, _)| *bottom <= indentation);
        let mut reached: Vec<Part> = touching
            .map(|(_, steps)| self.reached(steps, indentation))
            .collect();
        // Of two patches that overlap, the one with the higher level covers the other.
        reached.sort_by(|part, other| other.level.total_cmp(&part.level));
        let mut parts: Vec<Part> = Vec::new();
        for part in reached {
            let overlaps = |other: &Part| part.first <= other.last && other.first <= part.last;
            if !parts.iter().any(overlaps) {
                parts.push(part);
            }
        }
        parts.sort_by_key(|part| part.first);
        parts
    }
}

#[test]
fn climbs_one_by_one_are_a_loading_level_by_level() {
    for number in 0..20 {
        let (body, _, motion) = case(number);
        let climbs = Climbs::new(&body);
        let mut relaxed = Relaxed::new(&body);
        for k in 0..=10 {
            let d = 0.1 * f64::from(k) * motion.deepest;
            relaxed.move_to(d);
            let mut expected = relaxed.edges();
            expected.sort_by(|(_, edge, _), (_, other, _)| edge.total_cmp(other));
            let found = climbs.parts(d);
            assert_eq!(found.len(), expected.len(), "{number} {d}");
            for (part, (level, from, to)) in found.iter().zip(expected) {
                let is_same = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
                let is_whole = part.level.is_infinite();
                let same_level = is_whole || is_same(part.level, level);
                let same_edges = is_same(part.from, from) && is_same(part.to, to);
                assert!(same_level && same_edges, "{number} {d}: {part:?} {level}");
                let attached = &climbs.thresholds[part.first..=part.last];
                assert!(attached.iter().all(|&threshold| threshold <= d));
            }
            let attached = climbs
                .thresholds
                .iter()
                .filter(|&&threshold| threshold <= d);
            let springs = found.iter().map(|part| part.last + 1 - part.first);
            assert_eq!(attached.count(), springs.sum::<usize>(), "{number} {d}");
        }
    }
}
