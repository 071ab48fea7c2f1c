//! Reversals of one loading against separate loadings and unloadings, bit for bit.

use super::solvers::{adhesive, nonadhesive};
use asperity::analysis::Figures;
use asperity::contact::{Body, ContactError, Foundation, HessRule, History, Reversal, Solver, run};
use asperity::scene::{Edges, Move};
use asperity::surface::{Line, SelfAffine};
use proptest::prelude::*;

/// Springs under adhesion and their reversals.
#[derive(Clone, Debug)]
struct Case {
    /// m, the smallest 0.
    gaps: Vec<f64>,
    foundation: Foundation,
    hess: HessRule,
    samples: usize,
    /// Turning points; forces as shares of the order of the acting ones.
    turns: Vec<Move>,
    /// Indentations of the requested forces, m.
    points: Vec<f64>,
}

/// Gaps of a line of one of several kinds: random walk, noise, waves, a few levels, flat.
fn gaps() -> impl Strategy<Value = Vec<f64>> {
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..200).prop_map(|steps| {
        let mut height = 0.0;
        let rise = |step: &f64| {
            height += 0.1 * step;
            height
        };
        steps.iter().map(rise).collect::<Vec<f64>>()
    });
    let noise = prop::collection::vec(0.0..1.0_f64, 1..100);
    let waves = (prop::collection::vec((0.0..0.3_f64, 0.0..6.3_f64), 1..12), 2_usize..160).prop_map(
        |(waves, springs)| {
            let height = |x: f64| {
                let wave = |(mode, &(amplitude, phase)): (usize, &(f64, f64))| {
                    amplitude * ((mode as f64 + 1.0) * x + phase).cos()
                };
                waves.iter().enumerate().map(wave).sum::<f64>()
            };
            (0..springs)
                .map(|spring| height(spring as f64 * std::f64::consts::TAU / springs as f64))
                .collect()
        },
    );
    let levels = prop::collection::vec(0_u8..5, 1..100)
        .prop_map(|levels| levels.iter().map(|&level| 0.25 * f64::from(level)).collect());
    let flat = (1_usize..50).prop_map(|count| vec![0.0; count]);
    prop_oneof![4 => walk, 2 => noise, 4 => waves, 2 => levels, 1 => flat].prop_map(|heights: Vec<f64>| {
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        heights.iter().map(|height| height - lowest).collect()
    })
}

fn turns() -> impl Strategy<Value = Vec<Move>> {
    let turn = prop_oneof![
        4 => (0.0..1.3_f64).prop_map(Move::ToIndentation),
        // At levels of the line with levels.
        1 => (0_u8..6).prop_map(|level| Move::ToIndentation(0.25 * f64::from(level))),
        4 => (0.0..1.0_f64).prop_map(Move::ToForce),
        1 => Just(Move::ToTouch),
        1 => Just(Move::ToZeroForce),
    ];
    prop::collection::vec(turn, 1..24)
}

/// From no adhesion to far more than full adhesion needs, with the works of closing and opening equal or not.
fn cases() -> impl Strategy<Value = Case> {
    let work = prop_oneof![1 => Just(0.0), 6 => (-5.0..2.0_f64).prop_map(|power| 10.0_f64.powf(power))];
    let share = prop_oneof![2 => Just(1.0), 1 => Just(0.0), 2 => 0.0..1.0_f64];
    let body = (gaps(), work, share, 0.003..0.03_f64, 0.3..3.0_f64);
    let asked =
        (prop_oneof![Just(2_usize), 2_usize..600], turns(), prop::collection::vec(-1.0..1.3_f64, 0..9));
    (body, asked).prop_map(|((gaps, work, share, spacing, modulus), (samples, mut turns, mut points))| {
        let foundation = Foundation::endless(spacing, modulus);
        let hess = HessRule::from_works(foundation, share * work * modulus, work * modulus);
        let deepest = gaps.iter().copied().fold(1e-3, f64::max);
        let force = gaps.len() as f64 * foundation.spring_stiffness() * deepest;
        for turn in &mut turns {
            if let Move::ToForce(share) = turn {
                *share *= force;
            }
        }
        points.sort_by(f64::total_cmp);
        Case { gaps, foundation, hess, samples, turns, points }
    })
}

/// Values on which both ways must agree, bit for bit.
fn bits(turn: [f64; 4], smallest: [f64; 4], rest: &[Option<f64>]) -> Vec<Option<u64>> {
    let points = turn.into_iter().chain(smallest).map(Some);
    points.chain(rest.iter().copied()).map(|value| value.map(f64::to_bits)).collect()
}

fn point(point: &asperity::contact::CurvePoint) -> [f64; 4] {
    [
        point.indentation,
        point.force,
        point.contact_length,
        point.springs as f64 + 1e-3 * point.fragments as f64,
    ]
}

fn bits_of(reversal: &Reversal) -> Vec<Option<u64>> {
    let rest = [reversal.adhesion_force(), Some(reversal.dissipated_energy), Some(reversal.separation)];
    bits(point(&reversal.turn), point(&reversal.smallest), &rest)
}

fn bits_of_history(history: &History) -> Vec<Option<u64>> {
    let figures = Figures::of(history);
    let [loading, unloading] = &history.legs[..] else { panic!("{history:?}") };
    let rest = [figures.adhesion_force, figures.dissipated_energy, Some(unloading.end())];
    bits(point(loading.curve.last().unwrap()), point(&unloading.smallest), &rest)
}

/// All reversals in the order of their legs.
fn all(body: &mut Body, turns: &[Move], points: &[f64]) -> Result<Vec<Reversal>, ContactError> {
    let mut found = vec![None; turns.len()];
    let see = &mut |index: usize, reversal| {
        assert!(found[index].replace(reversal).is_none());
        Ok(())
    };
    body.reversals(turns, points, see)?;
    Ok(found.into_iter().map(Option::unwrap).collect())
}

/// Compares all reversals of a case with separate histories, each on a new body.
fn compare(new: impl Fn() -> Body, case: &Case) -> Result<(), TestCaseError> {
    let reversals = all(&mut new(), &case.turns, &case.points).unwrap();
    for (leg, reversal) in case.turns.iter().zip(&reversals) {
        let separate = run(&mut new(), &[*leg, Move::ToSeparation], |_, _| Ok(())).unwrap();
        prop_assert_eq!(bits_of(reversal), bits_of_history(&separate), "{:?}: {:?}", leg, reversal);
        let below: Vec<_> =
            case.points.iter().copied().filter(|&point| point <= reversal.turn.indentation).collect();
        prop_assert_eq!(reversal.forces.len(), below.len());
        for (point, force) in below.iter().zip(&reversal.forces) {
            let to_point = [*leg, Move::ToIndentation(*point)];
            let separate = run(&mut new(), &to_point, |_, _| Ok(())).unwrap();
            let end = separate.legs[1].curve.last().unwrap();
            prop_assert_eq!(force.to_bits(), end.force.to_bits(), "{:?} at {:?}", leg, point);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reversals_are_those_of_separate_runs(case in cases()) {
        for edges in [Edges::Grid, Edges::SubCell] {
            compare(|| adhesive(&case.gaps, edges, case.hess, case.foundation, case.samples), &case)?;
            compare(|| nonadhesive(&case.gaps, edges, case.foundation, case.samples), &case)?;
        }
    }
}

#[test]
fn turning_points_out_of_contact_are_refused() {
    let gaps = [0.0, 0.5, 0.25];
    let body = || nonadhesive(&gaps, Edges::SubCell, Foundation::endless(0.01, 1.0), 2);
    let leg = Move::ToIndentation(-0.1);
    for (turns, index, reason) in [
        (vec![Move::ToTouch, leg], 1, ContactError::NoContact),
        (vec![Move::ToForce(-1.0)], 0, ContactError::NothingToPull),
        (vec![Move::ToSeparation], 0, ContactError::NoContact),
    ] {
        let expected = ContactError::Stage { index, target: turns[index], reason: Box::new(reason) };
        assert_eq!(all(&mut body(), &turns, &[]), Err(expected));
    }
}

/// Evaluations of the rule of Hess measure the walked share of the line: 64 reversals of a rough line together take
/// less than three loops to the deepest turning point, although each such loop walks all of its contact again.
#[test]
fn the_loading_is_passed_once_for_all_reversals() {
    let springs = 1 << 13;
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: springs as u64 / 4 };
    let rough = spectrum.heights(1, springs).unwrap();
    let line = Line::new(1e-3, springs, None, Some(&rough), 5e-7).unwrap();
    let foundation = Foundation::endless(line.spacing, 2e6);
    let rms_gradient = 5e-7 * spectrum.gradient_per_height(1e-3);
    for kappa in [6.0_f64, 20.0] {
        let work = 5e-7 * rms_gradient * 2e6 / (kappa * kappa);
        let mut body = adhesive(&line.gaps, Edges::SubCell, HessRule::new(foundation, work), foundation, 2);
        let deepest = 0.4 * 2e6 * 1e-3 * 5e-7;
        let turn = |share: u32| Move::ToForce(deepest * f64::from(share) / 64.0);
        let turns: Vec<Move> = (1..=64).map(turn).collect();
        body.reversals(&turns, &[], &mut |_, _| Ok(())).unwrap();
        let work = body.work();
        assert_eq!((work.loading_passes, work.unloading_passes), (1, 64));
    }
}
