//! Complete small worlds: every order of few gaps, ties included, against the definitions of the thresholds, and every
//! history of a few springs against blind relaxation.

use super::equilibrium::{Blind, Order};
use super::solvers::adhesive;
use asperity::contact::{Foundation, HessRule, Solver};
use asperity::scene::Edges;
use asperity::scene::Move;

const SPACING: f64 = 0.01;
/// Gaps of the levels, m: no difference of two is a largest stretch.
const LEVELS: [f64; 8] = [0.0, 0.13, 0.31, 0.37, 0.59, 0.71, 0.83, 1.0];
/// γ/E*, m: largest stretches from 0.03 to 1.4 m.
const RANGES: [f64; 3] = [0.03, 0.7, 8.0];

/// Calls `see` with every weak order of this number of gaps: every line over the lowest levels that leaves none out.
fn each_weak_order(count: usize, mut see: impl FnMut(&[usize])) -> u64 {
    let (mut levels, mut seen) = (vec![0; count], 0);
    loop {
        let highest = levels.iter().copied().max().unwrap_or(0);
        if (0..highest).all(|level| levels.contains(&level)) {
            see(&levels);
            seen += 1;
        }
        let Some(place) = levels.iter().rposition(|&level| level + 1 < count) else { return seen };
        levels[place] += 1;
        levels[place + 1..].fill(0);
    }
}

/// Thresholds by definition, over the max-Cartesian tree of the gaps.
struct Definition<'a> {
    gaps: &'a [f64],
    /// Largest stretch of a patch of one cell, m.
    stretch: f64,
    sub_cell: bool,
}

impl Definition<'_> {
    /// The largest of these gaps, the leftmost of equals.
    fn root(&self, first: usize, last: usize) -> usize {
        (first..=last).rev().max_by(|&one, &other| self.gaps[one].total_cmp(&self.gaps[other])).unwrap()
    }

    /// Length of a patch over these springs, in cells, with its edges at the level of a spring next to it.
    fn length(&self, first: usize, last: usize, level: f64) -> f64 {
        if !self.sub_cell {
            return (last + 1 - first) as f64;
        }
        let share = |inside: usize, outside: Option<usize>| match outside.map(|at| self.gaps[at]) {
            None => 0.5,
            Some(gap) if gap == self.gaps[inside] => 1.0,
            Some(gap) => ((level - self.gaps[inside]) / (gap - self.gaps[inside])).min(1.0),
        };
        let right = Some(last + 1).filter(|&after| after < self.gaps.len());
        (last - first) as f64 + share(first, first.checked_sub(1)) + share(last, right)
    }

    /// Indentation at which all of a subtree is one patch on loading, and the thresholds of its springs so far.
    fn close(&self, first: usize, last: usize, out: &mut [f64]) -> f64 {
        let root = self.root(first, last);
        let gap = self.gaps[root];
        let parts = [(root > first).then(|| (first, root - 1)), (root < last).then(|| (root + 1, last))];
        let taken = parts.into_iter().flatten().map(|(first, last)| {
            let closes = self.close(first, last, out);
            closes.max(gap - self.stretch * self.length(first, last, gap).sqrt())
        });
        let closes = taken.fold(gap, f64::min);
        out[first..=last].iter_mut().for_each(|threshold| *threshold = threshold.min(closes));
        closes
    }

    /// Thresholds of springs on the way back from full contact, under a subtree that opens at `opens`, m.
    fn open(&self, first: usize, last: usize, opens: f64, out: &mut [f64]) {
        let root = self.root(first, last);
        let holds = self.gaps[root] - self.stretch * ((last + 1 - first) as f64).sqrt();
        let opens = opens.min(holds).min(self.gaps[root]);
        out[root] = opens;
        if root > first {
            self.open(first, root - 1, opens, out);
        }
        if root < last {
            self.open(root + 1, last, opens, out);
        }
    }
}

/// Compares the thresholds of a loading to full contact, and of the way back with whole springs.
fn compare(gaps: &[f64], range: f64, edges: Edges) {
    let foundation = Foundation::endless(SPACING, 1.0);
    let mut solver = adhesive(gaps, edges, HessRule::new(foundation, range), foundation, 2);
    let stretch = (std::f64::consts::PI * SPACING * range).sqrt();
    let definition = Definition { gaps, stretch, sub_cell: edges == Edges::SubCell };
    let check = |solver: &dyn Solver, expected: &[f64]| {
        let found = solver.leg().thresholds();
        let agree = found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-12);
        assert!(agree, "{gaps:?}, γ/E* = {range} m, {edges:?}: {found:?}, not {expected:?}");
    };
    let deepest = gaps.iter().copied().fold(0.0, f64::max) + 0.1;
    solver.advance(Move::ToIndentation(deepest)).unwrap();
    let mut expected = vec![f64::INFINITY; gaps.len()];
    definition.close(0, gaps.len() - 1, &mut expected);
    check(&solver, &expected);
    if edges == Edges::Grid {
        solver.advance(Move::ToIndentation(deepest - 0.05)).unwrap();
        definition.open(0, gaps.len() - 1, deepest, &mut expected);
        check(&solver, &expected);
    }
}

/// Every line of these many springs; `before` far springs on the left move the springs over the ends of blocks.
fn every_order(springs: usize, before: usize) -> u64 {
    let mut gaps = vec![0.0; before + springs];
    for (place, gap) in gaps[..before].iter_mut().enumerate() {
        *gap = 3.0 + (before - place) as f64;
    }
    each_weak_order(springs, |levels| {
        for (gap, &level) in gaps[before..].iter_mut().zip(levels) {
            *gap = LEVELS[level];
        }
        for range in RANGES {
            compare(&gaps, range, Edges::Grid);
            compare(&gaps, range, Edges::SubCell);
        }
    })
}

#[test]
fn every_order_of_few_gaps_has_the_thresholds_of_the_definition() {
    // The numbers of weak orders (Fubini).
    let counts: Vec<u64> = (1..=6).map(|springs| every_order(springs, 0)).collect();
    assert_eq!(counts, [1, 3, 13, 75, 541, 4683]);
    assert!((59..64).all(|before| every_order(4, before) == 75), "across the end of a block");
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn every_order_of_eight_gaps_has_the_thresholds_of_the_definition() {
    assert_eq!([every_order(7, 0), every_order(8, 0)], [47_293, 545_835]);
    assert!((58..64).all(|before| every_order(6, before) == 4683), "across the end of a block");
}

#[test]
fn histories_of_five_springs_agree_with_blind_relaxation() {
    every_history(23);
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn every_history_of_five_springs_agrees_with_blind_relaxation() {
    every_history(1);
}

/// Every history of three turning points on each of `step` lines.
fn every_history(step: usize) {
    let foundation = Foundation::endless(SPACING, 1.0);
    let heights = [0.0, 0.2, 0.35, 0.6, 1.0];
    let turns = [-0.45, -0.2, 0.0, 0.17, 0.35, 0.7, 1.1];
    let mut states = 0_u64;
    let lines = heights.len().pow(5);
    for number in (0..lines).step_by(step) {
        let digits = |number: usize, base: usize| {
            std::iter::successors(Some(number), move |number| Some(number / base))
                .map(move |digit| digit % base)
        };
        let line: Vec<f64> = digits(number, heights.len()).take(5).map(|digit| heights[digit]).collect();
        let summit = line.iter().copied().fold(f64::INFINITY, f64::min);
        let gaps: Vec<f64> = line.iter().map(|gap| gap - summit).collect();
        for [closing, opening] in [[0.7, 0.7], [0.0, 0.7], [0.3, 3.1]] {
            let hess = HessRule::from_works(foundation, closing, opening);
            for history in 0..turns.len().pow(3) {
                let mut solver = adhesive(&gaps, Edges::Grid, hess, foundation, 2);
                let mut blind = Blind::new(&gaps, [closing, opening], Order::LeftToRight);
                for turn in digits(history, turns.len()).take(3).map(|digit| turns[digit]) {
                    solver.advance(Move::ToIndentation(turn)).unwrap();
                    blind.relax(turn);
                    let found = solver.leg().patches(turn);
                    assert_eq!(
                        found,
                        blind.fragments(),
                        "{gaps:?}, {closing} {opening}, {history}: at {turn}"
                    );
                    states += 1;
                }
            }
        }
    }
    let histories = 3 * turns.len().pow(3) as u64;
    assert_eq!(states, lines.div_ceil(step) as u64 * histories * 3);
}
