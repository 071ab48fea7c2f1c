//! The stepwise solver against the exact one, and the counted work of each.

use super::solvers::adhesive;
use asperity::contact::{
    Contact, ContactError, Direction, Foundation, HessRule, LegRecord, Solver, Stepwise, Work,
};
use asperity::scene::{Document, Edges, Move};
use asperity::simulation::{Outcome, Simulation};
use asperity::surface::SelfAffine;
use proptest::prelude::*;
use std::f64::consts::PI;

const FOUNDATION: Foundation = Foundation::endless(0.01, 1.0);

/// Gaps of a self-affine line about 1 m deep.
fn rough(points: usize, seed: u64) -> Vec<f64> {
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: points as u64 / 4 };
    let heights = spectrum.heights(seed, points).unwrap();
    let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    heights.iter().map(|height| 0.2 * (summit - height)).collect()
}

fn contact(gaps: &[f64], hess: Option<HessRule>) -> Contact {
    Contact::new(gaps.to_vec(), Edges::Grid, FOUNDATION, hess)
}

fn stepwise(contact: &Contact, step: f64) -> Stepwise<'_> {
    Stepwise::new(contact, step, 64, &|| false).unwrap()
}

/// Runs legs with the stepwise solver and with the exact one.
fn both(gaps: &[f64], work: f64, step: f64, legs: &[Move]) -> [Vec<LegRecord>; 2] {
    let hess = HessRule::new(FOUNDATION, work);
    let mut exact = adhesive(gaps, Edges::Grid, hess, FOUNDATION, 64);
    let contact = contact(gaps, (work > 0.0).then_some(hess));
    let mut stepwise = stepwise(&contact, step);
    let run = |solver: &mut dyn Solver| legs.iter().map(|&leg| solver.advance(leg).unwrap()).collect();
    [run(&mut stepwise), run(&mut exact)]
}

/// Slope of ln(error) over ln(step) by least squares.
fn observed_order(steps: &[f64], errors: &[f64]) -> f64 {
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / steps.len() as f64;
    let x = mean(&mut steps.iter().map(|step| step.ln()));
    let y = mean(&mut errors.iter().map(|error| error.ln()));
    let pairs = || steps.iter().zip(errors).map(|(step, error)| (step.ln() - x, error.ln() - y));
    pairs().map(|(a, b)| a * b).sum::<f64>() / pairs().map(|(a, _)| a * a).sum::<f64>()
}

#[test]
fn pull_off_force_and_energy_converge_with_the_step() {
    // One number of one line converges by leaps; the mean error of several lines, evenly.
    let lines: Vec<Vec<f64>> = (1..=12).map(|seed| rough(128, seed)).collect();
    let legs = [Move::ToIndentation(0.4), Move::ToSeparation];
    let steps: Vec<f64> = (0..7).map(|halvings| 0.02 * 0.5_f64.powi(halvings)).collect();
    let mut force_errors = Vec::new();
    let mut energy_errors = Vec::new();
    for &step in &steps {
        let (mut force_error, mut energy_error) = (0.0, 0.0);
        for gaps in &lines {
            let [found, expected] = both(gaps, 0.05, step, &legs);
            let energy = |legs: &[LegRecord]| legs.iter().map(|leg| leg.released_energy).sum::<f64>();
            let force = |legs: &[LegRecord]| legs[1].smallest.force;
            // A step may miss the smallest force; it cannot find a smaller one.
            assert!(force(&found) >= force(&expected) && force(&expected) < 0.0);
            force_error += (force(&found) / force(&expected) - 1.0).abs() / lines.len() as f64;
            energy_error += (energy(&found) / energy(&expected) - 1.0).abs() / lines.len() as f64;
        }
        force_errors.push(force_error);
        energy_errors.push(energy_error);
    }
    for (what, errors) in [("pull-off force", force_errors), ("dissipated energy", energy_errors)] {
        let order = observed_order(&steps, &errors);
        println!("{what}: errors {errors:?}, order {order:.2}");
        assert!((0.8..=1.2).contains(&order), "{what}: order {order}, errors {errors:?}");
        assert!(errors[steps.len() - 1] < 0.01, "{what}: {errors:?}");
    }
}

/// Contact state of each spring at an indentation of the present leg.
fn held(solver: &dyn Solver, springs: usize, d: f64) -> Vec<bool> {
    let mut held = vec![false; springs];
    for (first, last) in solver.leg().patches(d) {
        held[first..=last].fill(true);
    }
    held
}

#[test]
fn contact_sets_on_the_way_converge_with_the_step() {
    let steps: Vec<f64> = (0..7).map(|halvings| 0.02 * 0.5_f64.powi(halvings)).collect();
    let mut differences = vec![0.0; steps.len()];
    for gaps in (1..=12).map(|seed| rough(128, seed)) {
        let hess = HessRule::new(FOUNDATION, 0.05);
        for (&step, differences) in steps.iter().zip(&mut differences) {
            let mut exact = adhesive(&gaps, Edges::Grid, hess, FOUNDATION, 2);
            let contact = contact(&gaps, Some(hess));
            let mut stepwise = stepwise(&contact, step);
            for (leg, from, to) in
                [(Move::ToIndentation(0.6), 0.0, 0.6), (Move::ToIndentation(-0.3), 0.6, -0.3)]
            {
                exact.advance(leg).unwrap();
                stepwise.advance(leg).unwrap();
                for share in (1..1000).map(|k| (f64::from(k) * 0.618_033_988_75).fract()) {
                    let d = from + share * (to - from);
                    let (one, other) = (held(&stepwise, gaps.len(), d), held(&exact, gaps.len(), d));
                    *differences += one.iter().zip(&other).filter(|(one, other)| one != other).count() as f64;
                }
            }
        }
    }
    let order = observed_order(&steps, &differences);
    println!("springs that differ: {differences:?}, order {order:.2}");
    assert!((0.8..=1.2).contains(&order), "order {order}, {differences:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn each_spring_joins_and_leaves_within_one_step_of_its_threshold(
        seed in any::<u64>(),
        points in 1_usize..120,
        range in -5.0..1.0_f64,
        closing in prop_oneof![1 => Just(1.0), 1 => 0.0..1.0_f64],
        step in 0.003..0.1_f64,
        turns in prop::collection::vec(-0.5..1.0_f64, 1..7),
    ) {
        let gaps = rough(points.max(4), seed);
        let work = 10_f64.powf(range);
        let hess = HessRule::from_works(FOUNDATION, closing * work, work);
        let mut exact = adhesive(&gaps, Edges::Grid, hess, FOUNDATION, 2);
        let contact = contact(&gaps, Some(hess));
        let mut stepwise = stepwise(&contact, step);
        for leg in turns.into_iter().map(Move::ToIndentation) {
            let (one, other) = (stepwise.advance(leg).unwrap(), exact.advance(leg).unwrap());
            // The end of a leg does not depend on the step: the same springs and, bit for bit, the same force.
            prop_assert_eq!(one.curve.last(), other.curve.last());
            prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
            prop_assert_eq!(one.direction, other.direction);
            if other.curve.last().unwrap().springs == 0 && other.detached == 0 {
                continue;
            }
            let found = stepwise.leg().thresholds();
            let expected = exact.leg().thresholds();
            let moved = (other.start(), other.end());
            let (low, high) = (moved.0.min(moved.1), moved.0.max(moved.1));
            for (found, expected) in found.iter().zip(&expected) {
                // The stepwise solver has only thresholds passed on the way.
                let on_the_way = low < *expected && *expected <= high;
                if on_the_way && found.is_finite() {
                    let late = found - expected;
                    prop_assert!((-1e-12..=step + 1e-12).contains(&late), "{} after {}", late, expected);
                }
                if other.direction == Direction::Loading {
                    prop_assert_eq!(found.is_finite() || *found < 0.0, *expected <= high);
                }
            }
        }
    }

    #[test]
    fn a_refused_leg_leaves_the_body_at_its_place(
        seed in any::<u64>(),
        range in -4.0..0.0_f64,
        to in 0.0..0.5_f64,
        back in -0.1..0.5_f64,
    ) {
        let gaps = rough(32, seed);
        let hess = HessRule::new(FOUNDATION, 10_f64.powf(range));
        let contact = contact(&gaps, Some(hess));
        let (mut asked, mut spared) = (stepwise(&contact, 0.01), stepwise(&contact, 0.01));
        for leg in [to, back].map(Move::ToIndentation).into_iter().chain([Move::ToSeparation]) {
            let (one, other) = (asked.advance(leg).unwrap(), spared.advance(leg).unwrap());
            prop_assert_eq!(one, other, "{:?} after a refused leg", leg);
            let refused = asked.advance(Move::ToForce(-1e30));
            let because = matches!(
                refused,
                Err(ContactError::DetachesBefore { .. } | ContactError::NothingToPull)
            );
            prop_assert!(because);
        }
    }

    #[test]
    fn legs_without_motion_are_stated_alike(seed in any::<u64>(), to in 0.0..0.5_f64, below in 0.1..1.0_f64) {
        let gaps = rough(32, seed);
        let legs = [
            Move::ToSeparation,
            Move::ToIndentation(-below),
            Move::ToIndentation(-below),
            Move::ToIndentation(-0.5 * below),
            Move::ToIndentation(to),
            Move::ToIndentation(to),
            Move::ToSeparation,
            Move::ToSeparation,
        ];
        let [found, expected] = both(&gaps, 0.01, 0.01, &legs);
        for (index, (one, other)) in found.iter().zip(&expected).enumerate() {
            prop_assert_eq!(one.direction, other.direction, "{} {:?}", index, one.target);
            if ![4, 6].contains(&index) {
                prop_assert_eq!(one.curve.len(), other.curve.len());
                prop_assert_eq!((one.largest.force, one.smallest.force), (other.largest.force, other.smallest.force));
            }
        }
    }
}

#[test]
fn one_spring_has_a_closed_form() {
    // Touches at d = 0 and detaches at d = −√(πΔxγ/E*).
    let work = 0.3;
    let stretch = (PI * FOUNDATION.spacing * work / FOUNDATION.effective_modulus).sqrt();
    let legs = [Move::ToIndentation(0.1), Move::ToSeparation];
    for step in [0.03, 0.003, 0.000_3] {
        let [found, expected] = both(&[0.0], work, step, &legs);
        for (records, allowed) in [(&found, step), (&expected, 1e-15)] {
            assert_eq!(records[0].largest.force, 0.1 * FOUNDATION.spring_stiffness());
            let late = records[1].smallest.indentation + stretch;
            assert!((0.0..=allowed).contains(&late), "step {step}: detached {late} early");
            let smallest = FOUNDATION.spring_stiffness() * records[1].smallest.indentation;
            assert!((records[1].smallest.force - smallest).abs() < 1e-17);
            assert_eq!(records.iter().map(|leg| leg.attached + leg.detached).sum::<u64>(), 2);
            let lost = 0.5 * FOUNDATION.spring_stiffness() * stretch * stretch;
            let slack = FOUNDATION.spring_stiffness() * (stretch + allowed) * allowed;
            assert!((records[1].released_energy - lost).abs() <= slack, "step {step}");
        }
    }
    // Without adhesion nothing is held or lost.
    for records in both(&[0.0], 0.0, 0.003, &legs) {
        assert_eq!((records[1].smallest.force, records[1].released_energy), (0.0, 0.0));
    }
}

#[test]
fn of_equal_forces_the_first_is_the_smallest() {
    let step = 0.003;
    let [records, _] = both(&[0.0], 0.0, step, &[Move::ToIndentation(0.1), Move::ToIndentation(-0.05)]);
    let smallest = records[1].smallest;
    assert_eq!(smallest.force, 0.0);
    assert!((-step..=0.0).contains(&smallest.indentation), "{smallest:?}");
}

#[test]
fn it_gives_up_on_demand_or_when_steps_are_too_many() {
    let gaps = rough(16, 1);
    let stop = || true;
    let rough = contact(&gaps, None);
    let mut solver = Stepwise::new(&rough, 0.01, 9, &stop).unwrap();
    assert_eq!(solver.advance(Move::ToIndentation(1.0)), Err(ContactError::Interrupted));
    let single = contact(&[0.0], None);
    let mut solver = stepwise(&single, 1e-9);
    let refused = solver.advance(Move::ToIndentation(1.0));
    let limit = asperity::contact::stepwise::STEP_LIMIT;
    assert_eq!(refused, Err(ContactError::TooManySteps { step: 1e-9, limit }));
}

#[test]
fn targets_out_of_reach_leave_the_body_in_place() {
    let gaps = rough(64, 3);
    let hess = Some(HessRule::new(FOUNDATION, 1e-3));
    let steps = std::cell::Cell::new(0_u64);
    // Called before each step.
    let stop = || {
        steps.set(steps.get() + 1);
        false
    };
    for (hess, step) in [(None, 1e-3), (hess, 1e-3), (hess, 1e-30)] {
        let contact = contact(&gaps, hess);
        let mut solver = Stepwise::new(&contact, step, 9, &stop).unwrap();
        let limit = asperity::contact::stepwise::STEP_LIMIT;
        let too_many = Err(ContactError::TooManySteps { step, limit });
        // Too many steps are refused before the first one.
        let far = solver.advance(Move::ToForce(1e9));
        assert!(far == too_many.clone(), "{far:?}");
        if step < 1e-3 {
            assert_eq!(solver.advance(Move::ToTouch).unwrap().attached, 1);
            assert_eq!(
                (solver.advance(Move::ToSeparation), solver.advance(Move::ToForce(1e-3))),
                (too_many.clone(), too_many)
            );
            continue;
        }
        solver.advance(Move::ToIndentation(0.3)).unwrap();
        let before = steps.replace(0);
        assert!(before > 300);
        let beyond = solver.advance(Move::ToForce(-1e9));
        let Err(ContactError::DetachesBefore { smallest }) = beyond else { panic!("{beyond:?}") };
        // The body pulled off before it was put back.
        assert!(steps.replace(0) > 300);
        let record = solver.advance(Move::ToSeparation).unwrap();
        assert_eq!(record.smallest.force, smallest);
        steps.set(0);
    }
    assert_eq!(steps.get(), 1);
}

/// A rough rubber face; each scene of these tests differs from it by its overrides.
const SCENE: &str = r#"(
    version: 1,
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
    adhesion: (kappa: 5.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 1024, solver: Exact, edges: Grid, samples: 64),
)"#;

fn outcome(overrides: &[(&str, &str)]) -> Outcome {
    let overrides: Vec<_> =
        overrides.iter().map(|&(path, value)| (path.to_string(), value.to_string())).collect();
    let document = Document::parse(SCENE, "scene").unwrap().set_all(&overrides).unwrap();
    Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap()
}

fn work(overrides: &[(&str, &str)]) -> Work {
    outcome(overrides).history.work
}

const STEPS: (&str, &str) = ("numerics.solver", "Stepwise(step: 2.0e-9)");
const BARE: (&str, &str) = ("adhesion", "None");

#[test]
fn work_is_what_it_was() {
    let smooth =
        [("roughness", "None"), ("form", "Paraboloid(radius: 1.0e-4)"), ("adhesion", "(work: 0.05)")];
    let scenes: [(&str, &[(&str, &str)]); 8] = [
        ("exact", &[]),
        ("exact, no adhesion", &[BARE]),
        ("exact, loading only", &[("loading", "[ToForce(2.0e-5)]")]),
        ("exact, smooth sphere", &smooth),
        ("exact, minor loops", &[("loading", MINOR_LOOPS)]),
        ("stepwise", &[STEPS]),
        ("stepwise, no adhesion", &[STEPS, BARE]),
        ("stepwise, minor loops", &[STEPS, ("loading", MINOR_LOOPS)]),
    ];
    let works: Vec<_> = scenes.iter().map(|&(name, overrides)| (name, work(overrides))).collect();
    insta::assert_debug_snapshot!(works);
}

const MINOR_LOOPS: &str = "[ToForce(2.0e-5), ToZeroForce, ToForce(1.0e-5), ToIndentation(1.0e-7), ToTouch, \
                           ToForce(3.0e-5), ToSeparation]";

#[test]
fn nothing_is_done_that_a_scene_does_not_call_for() {
    for solver in [("numerics.solver", "Exact"), STEPS] {
        let whole = work(&[solver]);
        assert!(whole.hess_evaluations > 0 || solver == STEPS);
        assert_eq!((whole.random_phases, whole.transforms, whole.heights_binned), (64, 1, 0));

        let bare = work(&[solver, BARE]);
        assert_eq!((bare.hess_evaluations, bare.tree_nodes), (0, 0));
        assert_eq!((bare.loading_passes, bare.unloading_passes, bare.zero_load_passes), (0, 0, 0));
        // A work of zero is no adhesion either.
        assert_eq!(work(&[solver, ("adhesion", "(work: 0.0)")]), bare);

        let loading =
            work(&[solver, ("loading", "[ToForce(1.0e-5), ToForce(2.0e-5), ToIndentation(1.0e-6)]")]);
        assert_eq!((loading.unloading_passes, loading.detached), (0, 0));
        assert!(loading.attached > 0);

        let smooth = [solver, ("roughness", "None"), ("adhesion", "(work: 0.05)")];
        let smooth = work(&smooth);
        assert_eq!((smooth.random_phases, smooth.transforms), (0, 0));

        let observed = outcome(&[solver, ("observe", "[HeightHistogram]")]);
        assert_eq!(observed.history.work, Work { heights_binned: 1024, ..whole });
        assert_eq!(observed.histogram.unwrap().counts.iter().sum::<u64>(), 1024);
    }
    let exact = work(&[]);
    assert_eq!((exact.steps, exact.relaxation_sweeps, exact.spring_updates), (0, 0, 0));
    assert_eq!((exact.loading_passes, exact.unloading_passes), (1, 1));
    // One node for each local maximum of the gap: no more than modes.
    assert!((16..=64).contains(&exact.tree_nodes), "{}", exact.tree_nodes);
    // F_a(0) takes another pass, and none where the loading turns at first touch.
    assert_eq!(exact.zero_load_passes, 1);
    let touch = work(&[("loading", "[ToTouch, ToSeparation]")]);
    assert_eq!((touch.loading_passes, touch.unloading_passes, touch.zero_load_passes), (1, 1, 0));
    let stepwise = work(&[STEPS]);
    assert_eq!((stepwise.tree_nodes, stepwise.loading_passes, stepwise.unloading_passes), (0, 0, 0));
    assert_eq!(stepwise.events_sorted, 0);
}
