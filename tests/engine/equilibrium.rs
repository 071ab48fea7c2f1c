//! The exact solver against blind relaxation of the rules, independent of the library.

use super::solvers::adhesive;
use asperity::contact::{ContactError, Foundation, HessRule, Solver};
use asperity::scene::{Edges, Move};
use proptest::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

const SPACING: f64 = 0.01;

/// Far above the rounding of a threshold, far below the distance between two, m.
const ROUNDING: f64 = 1e-9;

/// A foundation that knows only the rules: it tries any spring in any order until no rule applies.
#[derive(Clone)]
pub struct Blind<'a> {
    gaps: &'a [f64],
    /// γ/E* on closing and on opening, m.
    ranges: [f64; 2],
    contact: Vec<bool>,
    order: Order,
    /// The springs in the order of a round; shuffled anew for each round by `Order::Shuffled`.
    springs: Vec<usize>,
}

/// The order in which blind relaxation tries the springs.
#[derive(Clone, Copy, Debug)]
pub enum Order {
    LeftToRight,
    RightToLeft,
    /// From both ends to the middle.
    Inwards,
    /// Steps of this many springs, around and around.
    Stride(usize),
    /// Shuffled anew for each round.
    Shuffled(u64),
}

impl Order {
    /// The springs of a round, each once, before any shuffling.
    fn springs(self, count: usize) -> Vec<usize> {
        let mut springs: Vec<usize> = (0..count).collect();
        match self {
            Order::LeftToRight | Order::Shuffled(_) => {}
            Order::RightToLeft => springs.reverse(),
            Order::Inwards => springs.sort_by_key(|index| (*index).min(count - 1 - index)),
            Order::Stride(stride) => springs.sort_by_key(|index| (index % stride, *index)),
        }
        springs
    }

    /// Shuffles the springs for a round, if the order requires it.
    fn shuffle(&mut self, springs: &mut [usize]) {
        let Order::Shuffled(state) = self else { return };
        for last in (1..springs.len()).rev() {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            springs.swap(last, (*state >> 33) as usize % (last + 1));
        }
    }
}

impl<'a> Blind<'a> {
    /// Separated springs.
    pub fn new(gaps: &'a [f64], ranges: [f64; 2], order: Order) -> Self {
        Blind { gaps, ranges, contact: vec![false; gaps.len()], order, springs: order.springs(gaps.len()) }
    }

    fn stretch(springs: usize, range: f64) -> f64 {
        (std::f64::consts::PI * springs as f64 * SPACING * range).sqrt()
    }

    /// Springs in the run of contact to the left and to the right of a spring.
    fn beside(&self, index: usize) -> (usize, usize) {
        let left = self.contact[..index].iter().rev().take_while(|&&c| c).count();
        let right = self.contact[index + 1..].iter().take_while(|&&c| c).count();
        (left, right)
    }

    /// Applies a rule to this spring; returns false if none applies.
    fn apply(&mut self, index: usize, d: f64) -> bool {
        let gap = self.gaps[index];
        let [closing, opening] = self.ranges;
        let applies = if self.contact[index] {
            gap > d && {
                let (left, right) = self.beside(index);
                let run = &self.gaps[index - left..=index + right];
                gap - d >= Self::stretch(run.len(), opening) && run.iter().all(|other| *other <= gap)
            }
        } else {
            gap <= d || {
                let (left, right) = self.beside(index);
                let grows = |n: usize| n > 0 && gap - d <= Self::stretch(n, closing);
                grows(left) || grows(right)
            }
        };
        self.contact[index] ^= applies;
        applies
    }

    /// Relaxes at indentation d.
    pub fn relax(&mut self, d: f64) {
        let mut springs = std::mem::take(&mut self.springs);
        let unshuffled = matches!(self.order, Order::Shuffled(_)).then(|| springs.clone());
        loop {
            let mut quiet = true;
            if let Some(unshuffled) = &unshuffled {
                springs.clone_from(unshuffled);
                self.order.shuffle(&mut springs);
            }
            for &index in &springs {
                quiet &= !self.apply(index, d);
            }
            if quiet {
                break;
            }
        }
        self.springs = unshuffled.unwrap_or(springs);
    }

    fn relaxed(&self, d: f64) -> Self {
        let mut there = self.clone();
        there.relax(d);
        there
    }

    pub fn fragments(&self) -> Vec<(usize, usize)> {
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

/// Gaps (smallest 0) of a line of up to `most` springs of one of several kinds: noise, random walk,
/// few levels, staircase, flat.
fn line(most: usize) -> impl Strategy<Value = Vec<f64>> {
    let noise = prop::collection::vec(0.0..1.0_f64, 1..=most);
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..=most).prop_map(|steps| {
        steps
            .iter()
            .scan(0.0, |z, s| {
                *z += 0.1 * s;
                Some(*z)
            })
            .collect::<Vec<f64>>()
    });
    let levels = prop::collection::vec(0_u8..6, 1..=most)
        .prop_map(|levels| levels.iter().map(|&l| f64::from(l) * 0.25).collect());
    let monotone = (1..=most, any::<bool>())
        .prop_map(|(n, up)| (0..n).map(|i| 0.01 * (if up { i } else { n - i }) as f64).collect());
    let flat = (1..=most).prop_map(|n| vec![0.0; n]);
    prop_oneof![4 => noise, 6 => walk, 3 => levels, 1 => monotone, 1 => flat].prop_map(|heights: Vec<f64>| {
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        heights.iter().map(|z| z - lowest).collect()
    })
}

/// γ/E* from none to far beyond full adhesion.
fn range() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 9 => (-7.0..3.0_f64).prop_map(|p| 10_f64.powf(p))]
}

/// γ/E* on closing and on opening: equal, none on closing, hardly less, or any share.
fn ranges() -> impl Strategy<Value = [f64; 2]> {
    let share = prop_oneof![3 => Just(1.0), 1 => Just(0.0), 1 => Just(1.0 - 1e-5), 3 => 0.0..1.0_f64];
    (range(), share).prop_map(|(range, share)| [share * range, range])
}

fn order() -> impl Strategy<Value = Order> {
    prop_oneof![
        Just(Order::LeftToRight),
        Just(Order::RightToLeft),
        Just(Order::Inwards),
        (2_usize..50).prop_map(Order::Stride),
        any::<u64>().prop_map(Order::Shuffled),
    ]
}

/// A leg as drawn.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// To an indentation, m.
    To(f64),
    Touch,
    ZeroForce,
    /// To the present force plus this, N.
    ForceBy(f64),
    /// To this share of the present force.
    ForceShare(f64),
    Separation,
}

/// Lines are about 1 m deep; on those with few levels, some indentations hit a level exactly.
fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        6 => (-1.5..1.5_f64).prop_map(Step::To),
        2 => (-4_i8..8).prop_map(|l| Step::To(f64::from(l) * 0.25)),
        1 => Just(Step::Touch),
        1 => Just(Step::ZeroForce),
        2 => ((-4.0..0.5_f64), any::<bool>()).prop_map(|(p, up)| {
            Step::ForceBy(if up { 10_f64.powf(p) } else { -10_f64.powf(p) })
        }),
        2 => (-2.0..2.0_f64).prop_map(Step::ForceShare),
        1 => Just(Step::Separation),
    ]
}

/// Legs, each with probes on its way as shares of it.
fn steps() -> impl Strategy<Value = Vec<(Step, Vec<f64>)>> {
    prop::collection::vec((step(), prop::collection::vec(0.001..1.0_f64, 0..8)), 1..=8)
}

/// Counts of comparisons so far.
struct Compared {
    /// Whole contact states.
    states: AtomicU64,
    /// States of single springs.
    springs: AtomicU64,
    /// Legs that were refused.
    refused: AtomicU64,
    /// Whole contact states of each kind of case, and under each order of rules.
    of_kinds: [AtomicU64; KINDS.len()],
}

/// Kinds of cases required among those compared.
const KINDS: [&str; 9] = [
    "gaps alike",
    "γ₁ = 0 < γ₂",
    "0 < γ₁ < γ₂",
    "γ₁ = γ₂ > 0",
    "left to right",
    "right to left",
    "inwards",
    "strides",
    "shuffled",
];

impl Compared {
    const fn nothing() -> Compared {
        Compared {
            states: AtomicU64::new(0),
            springs: AtomicU64::new(0),
            refused: AtomicU64::new(0),
            of_kinds: [const { AtomicU64::new(0) }; KINDS.len()],
        }
    }

    fn one_of(&self, blind: &Blind, alike: bool) {
        self.states.fetch_add(1, Ordering::Relaxed);
        self.springs.fetch_add(blind.gaps.len() as u64, Ordering::Relaxed);
        let [closing, opening] = blind.ranges;
        let kinds = [
            alike,
            closing == 0.0 && opening > 0.0,
            closing > 0.0 && closing < opening,
            closing == opening && opening > 0.0,
            matches!(blind.order, Order::LeftToRight),
            matches!(blind.order, Order::RightToLeft),
            matches!(blind.order, Order::Inwards),
            matches!(blind.order, Order::Stride(_)),
            matches!(blind.order, Order::Shuffled(_)),
        ];
        for (count, _) in self.of_kinds.iter().zip(kinds).filter(|(_, is_one)| *is_one) {
            count.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Moves both along the legs and compares them at all probes.
fn compare(
    gaps: &[f64],
    ranges: [f64; 2],
    order: Order,
    legs: &[(Step, Vec<f64>)],
    compared: &Compared,
) -> Result<(), TestCaseError> {
    let foundation = Foundation::endless(SPACING, 1.0);
    let hess = HessRule::from_works(foundation, ranges[0], ranges[1]);
    let mut solver = adhesive(gaps, Edges::Grid, hess, foundation, 2);
    let mut blind = Blind::new(gaps, ranges, order);
    let mut sorted = gaps.to_vec();
    sorted.sort_by(f64::total_cmp);
    let alike = sorted.windows(2).any(|pair| pair[0] == pair[1]);
    let (mut present, mut force) = (0.0, 0.0);
    for &(step, ref probes) in legs {
        let leg = match step {
            Step::To(to) => Move::ToIndentation(to),
            Step::Touch => Move::ToTouch,
            Step::ZeroForce => Move::ToZeroForce,
            Step::ForceBy(by) => Move::ToForce(force + by),
            Step::ForceShare(share) => Move::ToForce(force * share),
            Step::Separation => Move::ToSeparation,
        };
        let record = match solver.advance(leg) {
            Ok(record) => record,
            Err(ContactError::NothingToPull | ContactError::DetachesBefore { .. }) => {
                // The body has not moved. The leg of a separation still has the contact of its end.
                if blind.contact.contains(&true) {
                    let found = solver.leg().patches(present);
                    prop_assert_eq!(found, blind.fragments(), "after {:?} failed", leg);
                    compared.one_of(&blind, alike);
                }
                compared.refused.fetch_add(1, Ordering::Relaxed);
                continue;
            }
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        let end = record.curve.last().unwrap();
        // A separated body that stays may be at d = 0, just before first touch.
        let stays = record.curve.len() == 1;
        let separates = leg == Move::ToSeparation;
        // Separation ends just where the last springs still hold: to rounding, the blind relaxation may be on either
        // side of it. Elsewhere both are at the same number.
        let to = if separates { (end.indentation + ROUNDING).min(present) } else { end.indentation };
        for probe in probes.iter().filter(|_| !stays) {
            let d = present + probe * (to - present);
            let there = blind.relaxed(d);
            prop_assert_eq!(solver.leg().patches(d), there.fragments(), "at {} of {:?}", d, leg);
            compared.one_of(&blind, alike);
        }
        if separates {
            if to < present {
                blind.relax(to);
                prop_assert!(blind.contact.contains(&true), "detached before {}", to);
                prop_assert_eq!(solver.leg().patches(to), blind.fragments(), "before separation at {}", to);
            }
            blind.relax(end.indentation - ROUNDING);
        } else {
            blind.relax(to);
            prop_assert_eq!(solver.leg().patches(to), blind.fragments(), "at {}, the end of {:?}", to, leg);
        }
        prop_assert_eq!(end.springs as usize, blind.contact.iter().filter(|&&c| c).count());
        prop_assert_eq!(end.fragments as usize, blind.fragments().len());
        compared.one_of(&blind, alike);
        (present, force) = (end.indentation, end.force);
    }
    Ok(())
}

static SHORT: Compared = Compared::nothing();
static LONG: Compared = Compared::nothing();

proptest! {
    #![proptest_config(ProptestConfig { cases: 24_000, failure_persistence: None, ..ProptestConfig::default() })]

    fn short_lines(gaps in line(40), ranges in ranges(), order in order(), legs in steps()) {
        compare(&gaps, ranges, order, &legs, &SHORT)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    fn long_lines(gaps in line(300), ranges in ranges(), order in order(), legs in steps()) {
        compare(&gaps, ranges, order, &legs, &LONG)?;
    }
}

#[test]
fn contact_states_of_short_lines_agree_with_blind_relaxation() {
    short_lines();
    let [states, springs, refused] =
        [&SHORT.states, &SHORT.springs, &SHORT.refused].map(|count| count.load(Ordering::Relaxed));
    println!("{states} contact states, {springs} states of springs, {refused} legs refused");
    assert!(states >= 300_000, "only {states} contact states compared");
    assert!(refused >= 1000, "only {refused} legs refused");
    for (kind, count) in KINDS.iter().zip(&SHORT.of_kinds) {
        let count = count.load(Ordering::Relaxed);
        println!("{count} contact states: {kind}");
        assert!(count >= 20_000, "only {count} contact states: {kind}");
    }
}

#[test]
fn spring_states_of_long_lines_agree_with_blind_relaxation() {
    long_lines();
    let [states, springs, refused] =
        [&LONG.states, &LONG.springs, &LONG.refused].map(|count| count.load(Ordering::Relaxed));
    println!("{states} contact states, {springs} states of springs, {refused} legs refused");
    assert!(springs >= 5_000_000, "only {springs} states of springs compared");
}

#[test]
fn few_springs_agree_with_blind_relaxation() {
    let compared = Compared::nothing();
    // Without adhesion the deepest spring touches last, though its neighbours are in contact.
    let gaps = [0.0, 0.718_352_439_046_38, 0.747_622_633_866_587_6];
    compare(&gaps, [0.0; 2], Order::LeftToRight, &[(Step::To(0.75), vec![0.99])], &compared).unwrap();
    // A single spring is held below first touch, then detaches, and must touch to attach again.
    let legs =
        [0.0, -0.183_601_704_731_071_62, -2.344_984_497_776_057e-5, -0.493_355_240_886_346_4, -0.1, 0.0]
            .map(|to| (Step::To(to), vec![0.25, 0.5, 1.0]));
    compare(&[0.0], [1.0; 2], Order::LeftToRight, &legs, &compared).unwrap();
    assert_eq!(compared.states.into_inner(), 26);
}
