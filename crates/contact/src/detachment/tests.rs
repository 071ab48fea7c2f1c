//! Tests of the exact solver with rules that have no closed-form results. A power of the length is
//! compared with a plain relaxation by the rules, and the searches are compared with the
//! closed-form results of the rule of Hess.

use super::*;
use crate::adhesive::Runs;
use crate::adhesive::levels::{Edges, Slider, Span};
use crate::adhesive::loading::Closing;
use crate::adhesive::run::{Ground, HeldPatch, Run};
use crate::adhesive::tree::ContactTree;
use crate::contact_state::{ContactState, Extreme, Grid, intervals};
use crate::foundation::Foundation;
use crate::history::Patch;
use crate::interval::Intervals;
use proptest::prelude::*;

/// A rule Δl = s ℓ^p that states only the largest stretch and its slope. The trait computes all
/// other results by searches.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PowerRule {
    stretch: f64,
    exponent: f64,
}

impl DetachmentRule for PowerRule {
    fn largest_stretch(&self, cells: f64) -> f64 {
        self.stretch * cells.powf(self.exponent)
    }

    fn slope(&self, cells: f64) -> f64 {
        self.exponent * self.stretch * cells.powf(self.exponent - 1.0)
    }
}

/// The rule of Hess without its closed-form results, so that the trait computes them by searches.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SearchedHess(HessRule);

impl DetachmentRule for SearchedHess {
    fn largest_stretch(&self, cells: f64) -> f64 {
        self.0.largest_stretch(cells)
    }

    fn slope(&self, cells: f64) -> f64 {
        self.0.slope(cells)
    }
}

/// A motion of a body on a profile, with its runs. A run is a patch over a range of indentations in
/// which its edges do not jump.
struct Stage<'a, const SLIDES: bool, R> {
    ground: Ground<'a, SLIDES, R>,
    runs: Vec<Run>,
}

impl<const SLIDES: bool, R: DetachmentRule> Stage<'_, SLIDES, R> {
    fn along(&self) -> Runs<'_, SLIDES, R> {
        Runs {
            ground: self.ground,
            runs: &self.runs,
        }
    }

    fn patches(&self, indentation: f64) -> Vec<Patch> {
        let held = self.held(indentation, false);
        held.iter().map(HeldPatch::springs).collect()
    }

    fn held(&self, indentation: f64, pins: bool) -> Vec<HeldPatch> {
        self.along().held_at(indentation, pins).collect()
    }

    fn states(&self, indentations: &[f64]) -> Vec<ContactState> {
        let grid = Grid::at(indentations.to_vec());
        self.along().sample(grid).unwrap()
    }
}

/// A profile with its contact tree.
struct Line {
    gaps: Vec<f64>,
    tree: ContactTree,
}

impl Line {
    fn new(gaps: &[f64], edges: Edges) -> Self {
        let deepest = gaps.iter().copied().fold(0.0, f64::max);
        let tree = ContactTree::default().rebuild(gaps, deepest, edges);
        Line {
            gaps: gaps.to_vec(),
            tree: tree.unwrap(),
        }
    }

    fn ground<const SLIDES: bool, R>(&self, rule: R, unloading: bool) -> Ground<'_, SLIDES, R> {
        Ground {
            gaps: &self.gaps,
            tree: &self.tree,
            rule,
            unloading,
        }
    }

    fn loading<const SLIDES: bool, R: DetachmentRule>(
        &self,
        rule: R,
        held: &[HeldPatch],
    ) -> Stage<'_, SLIDES, R> {
        let ground = self.ground(rule, false);
        let closing = Closing::new(&ground).unwrap();
        let runs = closing.list(&ground, held).unwrap().runs;
        Stage { ground, runs }
    }

    fn unloading<const SLIDES: bool, R: DetachmentRule>(
        &self,
        rule: R,
        held: &[HeldPatch],
        from: f64,
    ) -> Stage<'_, SLIDES, R> {
        let ground = self.ground(rule, true);
        let runs = ground.open(held, from).unwrap().runs;
        Stage { ground, runs }
    }
}

/// A contact of whole springs that finds its state by plain sweeps over all springs. Each sweep
/// applies the rules of attachment and detachment.
struct Relaxed<'a> {
    gaps: &'a [f64],
    holds: Vec<bool>,
}

impl Relaxed<'_> {
    fn patches(&self) -> Vec<Patch> {
        Patch::of_springs(self.holds.iter().copied())
    }

    fn press(&mut self, rule: PowerRule, indentation: f64) {
        loop {
            let before = self.holds.clone();
            for (spring, &gap) in self.gaps.iter().enumerate() {
                self.holds[spring] |= gap <= indentation;
            }
            for patch in self.patches() {
                let stretch = rule.largest_stretch(patch.springs().len() as f64);
                let beside = [patch.first.checked_sub(1), Some(patch.last + 1)];
                for spring in beside.into_iter().flatten() {
                    let gap = self.gaps.get(spring);
                    if gap.is_some_and(|gap| indentation >= gap - stretch) {
                        self.holds[spring] = true;
                    }
                }
            }
            if self.holds == before {
                return;
            }
        }
    }

    fn pull(&mut self, rule: PowerRule, indentation: f64) {
        loop {
            let before = self.holds.clone();
            for patch in self.patches() {
                let stretch = rule.largest_stretch(patch.springs().len() as f64);
                for spring in patch.springs() {
                    let gap = self.gaps[spring];
                    if indentation <= gap - stretch && indentation < gap {
                        self.holds[spring] = false;
                    }
                }
            }
            if self.holds == before {
                return;
            }
        }
    }
}

/// Step of the level, in m, by which a patch is moved.
const STEP: f64 = 1e-4;

/// A part of the profile that lies below one level. The profile is straight between springs.
#[derive(Clone, Copy, Debug)]
struct Part {
    first: usize,
    last: usize,
    level: f64,
}

/// A profile that is straight between springs. Its patches are moved along levels by small steps.
struct Stepped<'a> {
    gaps: &'a [f64],
}

impl Stepped<'_> {
    /// Returns the parts of the profile that lie below a level, among the springs `first..=last`.
    fn parts(&self, first: usize, last: usize, level: f64) -> Vec<Part> {
        let is_below = self.gaps[first..=last].iter().map(|&gap| gap <= level);
        let patches = Patch::of_springs(is_below);
        let part = |patch: Patch| Part {
            first: first + patch.first,
            last: first + patch.last,
            level,
        };
        patches.into_iter().map(part).collect()
    }

    fn length(&self, part: Part) -> f64 {
        let share = |inside: usize, outside: Option<usize>| {
            let Some(&outside) = outside.and_then(|spring| self.gaps.get(spring)) else {
                return 0.5;
            };
            let inside = self.gaps[inside];
            ((part.level - inside) / (outside - inside)).min(1.0)
        };
        let left = share(part.first, part.first.checked_sub(1));
        let right = share(part.last, Some(part.last + 1));
        (part.last - part.first) as f64 + left + right
    }

    fn equilibrium(&self, rule: PowerRule, part: Part) -> f64 {
        part.level - rule.largest_stretch(self.length(part))
    }

    /// Returns the parts in contact at an indentation of a loading from separation.
    fn pressed(&self, rule: PowerRule, indentation: f64) -> Vec<Part> {
        let mut whole: Vec<Part> = Vec::new();
        let last_spring = self.gaps.len() - 1;
        for part in self.parts(0, last_spring, indentation) {
            let mut grown = part;
            loop {
                let level = grown.level + STEP;
                let parts = self.parts(0, last_spring, level);
                let around = parts.into_iter().find(|wide| wide.last >= grown.first);
                let next = around.unwrap();
                if self.equilibrium(rule, next) > indentation || level > 4.0 {
                    break;
                }
                grown = next;
            }
            // If a patch lies inside a larger one, both are the same patch.
            let is_within =
                |inner: &Part, outer: &Part| outer.first <= inner.first && inner.last <= outer.last;
            if !whole.iter().any(|other| is_within(&grown, other)) {
                whole.retain(|other| !is_within(other, &grown));
                whole.push(grown);
            }
        }
        whole
    }

    /// Returns the parts that are still in contact at an indentation of an unloading. `held` are
    /// the patches at the beginning of the unloading.
    fn pulled(&self, rule: PowerRule, indentation: f64, held: &[Part]) -> Vec<Part> {
        let mut waiting = held.to_vec();
        let mut patches = Vec::new();
        while let Some(part) = waiting.pop() {
            if self.equilibrium(rule, part) < indentation {
                patches.push(part);
            } else {
                waiting.extend(self.parts(part.first, part.last, part.level - STEP));
            }
        }
        patches
    }

    fn total_length(&self, parts: &[Part]) -> f64 {
        parts.iter().map(|part| self.length(*part)).sum()
    }
}

fn power_rules() -> impl Strategy<Value = PowerRule> {
    let range = (0.05..0.6_f64, 0.2..0.75_f64);
    range.prop_map(|(stretch, exponent)| PowerRule { stretch, exponent })
}

fn gaps(most: usize) -> impl Strategy<Value = Vec<f64>> {
    let gaps = prop::collection::vec(0.0..1.0_f64, 2..most);
    gaps.prop_map(|mut gaps| {
        let smallest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        gaps.iter_mut().for_each(|gap| *gap -= smallest);
        gaps
    })
}

/// Generates gaps that differ so much from each other that steps of the level find each gap.
fn distinct_gaps() -> impl Strategy<Value = Vec<f64>> {
    let order = Just((0..9_usize).collect::<Vec<usize>>()).prop_shuffle();
    (order, prop::collection::vec(0.0..0.06_f64, 9)).prop_map(|(order, shifts)| {
        let gap = |(&place, shift): (&usize, f64)| match place {
            0 => 0.0,
            _ => 0.12 * place as f64 + shift,
        };
        order.iter().zip(shifts).map(gap).collect()
    })
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn hess(stretch: f64) -> HessRule {
    let foundation = Foundation {
        spacing: 1.0,
        modulus: 1.0,
        length: f64::INFINITY,
    };
    HessRule::new(foundation, stretch * stretch / std::f64::consts::PI)
}

proptest! {
    #![proptest_config(cases(150))]

    /// For patches of whole springs, the exact solver and plain sweeps find the same contact on a
    /// loading history of six motions.
    #[test]
    fn a_power_of_the_length_agrees_with_blind_relaxation(
        gaps in gaps(40), rule in power_rules(), more in 1.0..2.0_f64,
        turns in prop::collection::vec(-0.3..1.2_f64, 6),
    ) {
        let line = Line::new(&gaps, Edges::Grid);
        let opening = PowerRule { stretch: rule.stretch * more, ..rule };
        let mut relaxed = Relaxed { gaps: &gaps, holds: vec![false; gaps.len()] };
        let mut held = Vec::new();
        let mut start = 0.0;
        for turn in turns {
            let stage: Stage<'_, false, _> = if turn > start {
                line.loading(rule, &held)
            } else {
                line.unloading(opening, &held, start)
            };
            for step in 1..=8 {
                let indentation = start + (turn - start) * f64::from(step) / 8.0;
                if turn > start {
                    relaxed.press(rule, indentation);
                } else {
                    relaxed.pull(opening, indentation);
                }
                prop_assert_eq!(stage.patches(indentation), relaxed.patches(), "at {}", indentation);
            }
            held = stage.held(turn, false);
            start = turn;
        }
    }

    /// The search finds the smallest force of an unloading also between the points of a coarse
    /// grid.
    #[test]
    fn a_power_of_the_length_has_exact_extremes(gaps in distinct_gaps(), rule in power_rules()) {
        let line = Line::new(&gaps, Edges::SubCell);
        let loading: Stage<'_, true, _> = line.loading(rule, &[]);
        let unloading: Stage<'_, true, _> = line.unloading(rule, &loading.held(1.0, false), 1.0);
        let coarse = unloading.along().sample(Grid::new(-3.0, 1.0, 8)).unwrap();
        let ends = intervals(&coarse, |_, _| true);
        let mut searched = Intervals::new(&ends, true, line.tree.scale, 0.0);
        unloading.along().search(&mut searched);
        let mut best = Extreme::Smallest.among(&coarse);
        for interval in searched.finish(&mut 0) {
            interval.extreme(Extreme::Smallest, &mut best);
        }
        let fine = unloading.along().sample(Grid::new(-3.0, 1.0, 20_000)).unwrap();
        let smallest = Extreme::Smallest.among(&fine);
        let there = unloading.states(&[best.indentation])[0];
        prop_assert!(best.compression <= smallest.compression + 1e-9);
        prop_assert!((best.compression - there.compression).abs() <= 1e-9);
    }

    /// For the rule of Hess, searches find the same values as the closed-form results.
    #[test]
    fn searched_roots_are_the_closed_ones(
        stretch in 0.01..3.0_f64, gap in 0.0..1.0_f64, length in 0.1..40.0_f64, growth in 0.01..30.0_f64,
        height in 0.01..2.0_f64, share in 0.0..1.0_f64,
    ) {
        let closed = hess(stretch);
        let searched = SearchedHess(closed);
        let levels = Levels { gap, length, growth, top: gap + height };
        let turning = closed.turning_length(growth);
        let is_near = |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * (1.0 + expected.abs());
        prop_assert!(is_near(searched.turning_length(growth), turning));
        // `rise` is chosen so that the patch is stable at its level.
        let lowest = ((turning - length) / growth).max(0.0);
        prop_assume!(lowest < height);
        let rise = lowest + share * (height - lowest);
        let above = rise - closed.largest_stretch(levels.length_at(rise));
        let found = [closed.free_rise(&levels, above), searched.free_rise(&levels, above)];
        // Near the turning length, a rounding of the values changes the root by about the square
        // root of this rounding.
        let tolerance = 1e-6;
        prop_assert!((found[0] - rise).abs() <= tolerance && (found[1] - rise).abs() <= tolerance);
        if share > 0.01 {
            let stiffness = closed.stiffness(&levels, above, rise);
            let slow = searched.stiffness(&levels, above, rise);
            prop_assert!((stiffness - slow).abs() <= 1e-6 * (1.0 + stiffness.abs()), "{} {}", stiffness, slow);
        }
        prop_assert!(is_near(searched.squares_up_to(length), closed.squares_up_to(length)));
        let squares = closed.squares_between(share, length + share);
        prop_assert!(is_near(searched.squares_between(share, length + share), squares));
        let patches = closed.squares_of_patches(3.0, 17.0);
        prop_assert!(is_near(searched.squares_of_patches(3.0, 17.0), patches));
        prop_assert_eq!(searched.squares_of_patches(4.0, 3.0), 0.0);
    }

    /// The whole solver finds the same contact and the same energy with searches and with
    /// closed-form results.
    #[test]
    fn the_solver_finds_the_same_with_searched_roots(gaps in gaps(30), stretch in 0.01..0.6_f64, turn in 0.0..1.2_f64) {
        let closed = hess(stretch);
        let line = Line::new(&gaps, Edges::SubCell);
        let loading: Stage<'_, true, _> = line.loading(closed, &[]);
        let searched: Stage<'_, true, _> = line.loading(SearchedHess(closed), &[]);
        let is_near = |found: &[f64], expected: &[f64]| {
            found.iter().zip(expected).all(|(one, other)| one == other || (one - other).abs() < 1e-9)
        };
        prop_assert!(is_near(&searched.along().thresholds(), &loading.along().thresholds()));
        let unloading: Stage<'_, true, _> = line.unloading(closed, &loading.held(turn, false), turn);
        let searched: Stage<'_, true, _> =
            line.unloading(SearchedHess(closed), &searched.held(turn, false), turn);
        prop_assert!(is_near(&searched.along().thresholds(), &unloading.along().thresholds()));
        let squares = [
            searched.along().squared_stretch(-1.0, turn),
            unloading.along().squared_stretch(-1.0, turn),
        ];
        prop_assert!((squares[0] - squares[1]).abs() < 1e-8, "{:?}", squares);
    }
}

proptest! {
    #![proptest_config(cases(30))]

    /// With edges between springs, the contact length at an indentation lies between the stepped
    /// lengths at slightly smaller and slightly larger indentations.
    #[test]
    fn a_power_of_the_length_agrees_with_steps_of_the_level(
        gaps in distinct_gaps(), rule in power_rules(), more in prop_oneof![Just(1.0), 1.0..2.0_f64],
        turn in 0.0..1.2_f64, shares in prop::collection::vec(0.0..1.0_f64, 4),
    ) {
        let line = Line::new(&gaps, Edges::SubCell);
        let stepped = Stepped { gaps: &gaps };
        let loading: Stage<'_, true, _> = line.loading(rule, &[]);
        let opening = PowerRule { stretch: rule.stretch * more, ..rule };
        let held = loading.held(turn, more > 1.0);
        let unloading: Stage<'_, true, _> = line.unloading(opening, &held, turn);
        // A step of the level moves each edge by less than a cell.
        let slack = 20.0 * gaps.len() as f64 * STEP;
        let near = 3.0 * STEP;
        let is_between = |length: f64, less: &[Part], more: &[Part]| {
            let range = stepped.total_length(less) - slack..=stepped.total_length(more) + slack;
            prop_assert!(range.contains(&length), "{} is not in {:?}", length, range);
            Ok(())
        };
        for share in shares {
            let pressed = share * turn;
            let length = loading.states(&[pressed])[0].length;
            let less = stepped.pressed(rule, pressed - near);
            is_between(length, &less, &stepped.pressed(rule, pressed + near))?;

            let pulled = turn - 1.5 * share;
            let length = unloading.states(&[pulled])[0].length;
            let less = stepped.pulled(opening, pulled - near, &stepped.pressed(rule, turn - near));
            let more = stepped.pulled(opening, pulled + near, &stepped.pressed(rule, turn + near));
            is_between(length, &less, &more)?;
        }
    }

    /// The stored energy is the sum of the work done on the body and of the energy that springs
    /// gain when they attach. The energy released on unloading is not recovered as work.
    #[test]
    fn a_power_of_the_length_keeps_the_energy(gaps in distinct_gaps(), rule in power_rules()) {
        let line = Line::new(&gaps, Edges::SubCell);
        let loading: Stage<'_, true, _> = line.loading(rule, &[]);
        let unloading: Stage<'_, true, _> = line.unloading(rule, &loading.held(1.2, false), 1.2);
        let indentations: Vec<f64> = (0..=40_000).map(|step| -4.0 + 1.3e-4 * f64::from(step)).collect();
        let high = indentations[40_000];
        for stage in [&loading, &unloading] {
            let states = stage.states(&indentations);
            let mut work = 0.0;
            let mut variation = 0.0;
            for pair in states.windows(2) {
                let width = pair[1].indentation - pair[0].indentation;
                work += 0.5 * width * (pair[0].compression + pair[1].compression);
                variation += width * (pair[1].compression - pair[0].compression).abs();
            }
            let end = states[40_000];
            let squared_stretch = stage.along().squared_stretch(indentations[0], high);
            let expected = 0.5 * (end.squares(&line.tree.scale) - squared_stretch);
            prop_assert!((work - expected).abs() <= variation + 1e-9, "{} against {}", work, expected);
        }
    }
}

/// The stated stiffness of the edge cells is the derivative of their compression.
#[test]
fn stiffness_is_the_derivative_of_the_compression() {
    let rule = PowerRule {
        stretch: 0.3,
        exponent: 0.4,
    };
    let gaps = [1.0, 0.2, 0.0, 0.1, 0.9];
    let span = Span {
        gap: 0.2,
        first: 1,
        last: 3,
    };
    let slider = Slider::new(&gaps, &span, rule, None);
    for indentation in [-0.1, 0.0, 0.1, 0.2] {
        let compression = |place: f64| slider.edge_cells(place).compression;
        let difference = compression(indentation + 1e-6) - compression(indentation - 1e-6);
        let found = slider.stiffness(indentation);
        assert!(
            (found - difference / 2e-6).abs() < 1e-5,
            "{found} at {indentation}"
        );
    }
}
