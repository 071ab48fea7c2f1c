//! The exact solver against blind relaxation of the rules, written here and independent of the library.

use asperity::contact::{ContactTree, Foundation, GridEdges, HessRule, Solver, exact};
use asperity::scene::Leg;
use proptest::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// A foundation that knows only the rules: it looks at any spring in any order until nothing applies.
struct Blind {
    gaps: Vec<f64>,
    spacing: f64,
    range: f64,
    contact: Vec<bool>,
}

impl Blind {
    fn stretch(&self, springs: usize) -> f64 {
        (std::f64::consts::PI * springs as f64 * self.spacing * self.range).sqrt()
    }

    /// Springs in the run of contact to the left and to the right of a spring.
    fn beside(&self, index: usize) -> (usize, usize) {
        let left = self.contact[..index].iter().rev().take_while(|&&c| c).count();
        let right = self.contact[index + 1..].iter().take_while(|&&c| c).count();
        (left, right)
    }

    /// Whether a rule applies to this spring; if so it is applied.
    fn apply(&mut self, index: usize, d: f64) -> bool {
        let gap = self.gaps[index];
        let (left, right) = self.beside(index);
        if self.contact[index] {
            let n = left + 1 + right;
            let run = &self.gaps[index - left..=index + right];
            let most = run.iter().copied().fold(f64::MIN, f64::max);
            if gap == most && gap > d && gap - d >= self.stretch(n) {
                self.contact[index] = false;
                return true;
            }
        } else {
            let grows = |n: usize| n > 0 && gap - d <= self.stretch(n);
            if gap <= d || grows(left) || grows(right) {
                self.contact[index] = true;
                return true;
            }
        }
        false
    }

    /// Relaxes at indentation d, looking at the springs in the order of a stride that visits all.
    fn relax(&mut self, d: f64, stride: usize) {
        let count = self.gaps.len();
        let stride = (stride..).find(|s| gcd(*s, count) == 1).unwrap();
        let mut quiet = 0;
        let mut index = 0;
        while quiet <= count {
            quiet = if self.apply(index, d) { 0 } else { quiet + 1 };
            index = (index + stride) % count;
        }
    }

    fn fragments(&self) -> Vec<(usize, usize)> {
        let mut fragments = Vec::new();
        let mut start = None;
        for index in 0..=self.contact.len() {
            let contact = index < self.contact.len() && self.contact[index];
            match (contact, start) {
                (true, None) => start = Some(index),
                (false, Some(first)) => {
                    fragments.push((first, index - 1));
                    start = None;
                }
                _ => {}
            }
        }
        fragments
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Gaps of a line (smallest 0) of one of several kinds: noise, random walk, few levels, staircase,
/// flat.
fn line() -> impl Strategy<Value = Vec<f64>> {
    let noise = prop::collection::vec(0.0..1.0_f64, 1..300);
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..300).prop_map(|steps| {
        steps
            .iter()
            .scan(0.0, |z, s| {
                *z += 0.1 * s;
                Some(*z)
            })
            .collect::<Vec<f64>>()
    });
    let levels = prop::collection::vec(0_u8..6, 1..200)
        .prop_map(|levels| levels.iter().map(|&l| f64::from(l) * 0.25).collect());
    let monotone = (1_usize..200, any::<bool>())
        .prop_map(|(n, up)| (0..n).map(|i| 0.01 * (if up { i } else { n - i }) as f64).collect());
    let flat = (1_usize..100).prop_map(|n| vec![0.0; n]);
    prop_oneof![4 => noise, 6 => walk, 3 => levels, 1 => monotone, 1 => flat].prop_map(|heights: Vec<f64>| {
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        heights.iter().map(|z| z - lowest).collect()
    })
}

/// γ/E* from none to far beyond full adhesion.
fn range() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 9 => (-7.0..3.0_f64).prop_map(|p| 10_f64.powf(p))]
}

/// Where the ends of the legs and the probes stand, as fractions of the deepest gap; those on a level
/// of the lines with few levels are hit exactly.
fn indentation() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -1.5..1.5_f64, 1 => (-4_i8..8).prop_map(|l| f64::from(l) * 0.25)]
}

static STATES: AtomicU64 = AtomicU64::new(0);

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, ..ProptestConfig::default() })]

    fn states(
        gaps in line(),
        range in range(),
        legs in prop::collection::vec((indentation(), prop::collection::vec(0.0..1.0_f64, 0..4)), 1..9),
        stride in 1_usize..50,
    ) {
        let spacing = 0.01;
        let foundation = Foundation { spacing, effective_modulus: 1.0 };
        let tree = ContactTree::build(&gaps).unwrap();
        let rule = GridEdges::new(HessRule::new(foundation, range));
        let mut solver = exact::adhesive(&tree, rule, foundation, 2).unwrap();
        let count = gaps.len();
        let mut blind = Blind { gaps, spacing, range, contact: vec![false; count] };
        let mut from: f64 = 0.0;
        for (to, probes) in legs {
            let record = solver.advance(Leg::ToIndentation(to)).unwrap();
            for probe in probes {
                let d = from + probe * (to - from);
                let mut there = Blind { gaps: blind.gaps.clone(), contact: blind.contact.clone(), ..blind };
                there.relax(d, stride);
                prop_assert_eq!(solver.fragments(d), there.fragments(), "at {} on the way to {}", d, to);
                STATES.fetch_add(count as u64, Ordering::Relaxed);
            }
            blind.relax(to, stride);
            prop_assert_eq!(record.curve.last().unwrap().springs as usize,
                blind.contact.iter().filter(|&&c| c).count());
            prop_assert_eq!(record.curve.last().unwrap().fragments as usize, blind.fragments().len());
            if record.curve.last().unwrap().springs > 0 {
                prop_assert_eq!(solver.fragments(to), blind.fragments(), "at the end, {}", to);
            }
            STATES.fetch_add(count as u64, Ordering::Relaxed);
            from = to;
        }
    }
}

#[test]
fn every_state_agrees_with_blind_relaxation() {
    states();
    let states = STATES.load(Ordering::Relaxed);
    println!("{states} states of springs compared");
    assert!(states >= 100_000, "only {states} states compared");
}
