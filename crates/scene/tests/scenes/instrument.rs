//! The force over the displacement of a compliant instrument, against a search and against closed
//! forms.

use super::body::{cases, end};
use asperity_contact::ClosedForm;
use asperity_contact::motion::{Body, load_body};
use asperity_contact::{
    Contact, CurvePoint, Direction, Figures, History, Modulus, Move, Profile, StageRecord,
};
use asperity_scene::instrument::{
    DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements,
};
use asperity_surface::Form;
use asperity_surface::lines::Line;
use proptest::prelude::*;

/// A JKR sphere of radius 1 m with E* = γ = 1, and its closed form.
fn sphere(points: usize, stiffness: f64) -> (Contact, ClosedForm) {
    let form = Form::Paraboloid { radius: 1.0 };
    let line = Line::new(12.0, points, Some(&form), None, 0.0).unwrap();
    let profile = Profile::from_gaps(line.gaps, line.spacing).unwrap();
    let modulus = Modulus::effective(1.0).unwrap();
    let contact = Contact::builder(&profile, modulus)
        .work_of_adhesion(1.0)
        .loading_stiffness(stiffness);
    (
        contact.build().unwrap(),
        ClosedForm::sphere(1.0, modulus, 1.0),
    )
}

fn loaded(contact: &Contact, targets: &[Move]) -> History {
    load_body(&mut Body::new(contact, 512), targets, |_, _| Ok(())).unwrap()
}

proptest! {
    #![proptest_config(cases(1500))]

    /// On a random polygon the curve is that of a search from its beginning on.
    #[test]
    fn the_curve_is_that_of_a_search(
        steps in prop::collection::vec((0.0..1.0_f64, -1.0..1.0_f64), 2..40),
        stiffness in 0.05..20.0_f64,
        loads in any::<bool>(),
        wanted in prop::collection::vec(0.0..=1.0_f64, 20),
    ) {
        let sign = if loads { 1.0 } else { -1.0 };
        let mut at = CurvePoint { springs: 1, ..CurvePoint::default() };
        let mut points = vec![at];
        for (wide, force) in steps {
            at = CurvePoint { indentation: at.indentation + sign * wide, force, ..at };
            points.push(at);
        }
        let direction = if loads { Direction::Loading } else { Direction::Unloading };
        let curve = DisplacementCurve::new(direction, &points, stiffness);
        let key = |point: &CurvePoint| sign * point.displacement(stiffness);
        let most = points.iter().map(key).fold(f64::NEG_INFINITY, f64::max);
        let least = key(&points[0]);
        for share in wanted.into_iter().filter(|&share| share > 0.0 && least < most) {
            let target = (least + share * (most - least)).min(most);
            let found = curve.at(sign * target);
            // The first crossing on the way.
            let pair = points.windows(2).find(|pair| key(&pair[1]) >= target).unwrap();
            let part = ((target - key(&pair[0])) / (key(&pair[1]) - key(&pair[0]))).clamp(0.0, 1.0);
            let expected = pair[0].indentation + part * (pair[1].indentation - pair[0].indentation);
            let found = found.unwrap();
            prop_assert!((found.indentation - expected).abs() < 1e-9, "{:?} {}", found, expected);
            let force = stiffness * (found.displacement - found.indentation);
            prop_assert!((found.force - force).abs() < 1e-9);
        }
    }
}

#[test]
fn a_rigid_instrument_controls_the_indentation_and_a_soft_one_the_force() {
    let turns = [0.8, -0.2, 1.5];
    let (rigid, _) = sphere(4096, 1e13);
    let by_indentation = loaded(&rigid, &turns.map(Move::ToIndentation));
    let by_displacement = loaded(&rigid, &turns.map(Move::ToDisplacement));
    let soft = 1e-12;
    let (contact, _) = sphere(4096, soft);
    let forces = [3.0, -4.0, 5.0];
    let by_force = loaded(&contact, &forces.map(Move::ToForce));
    let pulled = loaded(
        &contact,
        &forces.map(|force| Move::ToDisplacement(force / soft)),
    );
    for (one, other) in [(by_indentation, by_displacement), (by_force, pulled)] {
        for (one, other) in one.stages.iter().zip(&other.stages) {
            let [one, other] = [one, other].map(end);
            assert!((one.force - other.force).abs() < 1e-9, "{one:?} {other:?}");
            assert!(
                (one.indentation - other.indentation).abs() < 1e-9,
                "{one:?} {other:?}"
            );
        }
    }
    // Without a stiffness D is the indentation, to the last bit.
    let (bare, _) = sphere(512, f64::INFINITY);
    let [one, other] = [
        turns.map(Move::ToIndentation),
        turns.map(Move::ToDisplacement),
    ]
    .map(|turns| {
        let stages: Vec<StageRecord> = loaded(&bare, &turns).stages;
        stages
            .into_iter()
            .map(|stage| stage.curve)
            .collect::<Vec<_>>()
    });
    assert_eq!(one, other);
}

/// The pull-off force of a sphere does not depend on the instrument; the displacement at which the
/// sphere jumps off does.
#[test]
fn a_sphere_jumps_off_where_the_closed_form_does() {
    let targets = [Move::ToDisplacement(2.0), Move::ToDisplacement(-40.0)];
    let (rigid, jkr) = sphere(1 << 14, f64::INFINITY);
    let under = |stiffness| sphere(1 << 14, stiffness).0;
    let reference = loaded(&rigid, &[Move::ToIndentation(1.0), Move::ToSeparation]);
    let mut areas = vec![];
    for stiffness in [0.2, 1.0, 5.0, 100.0] {
        let history = loaded(&under(stiffness), &targets);
        let unloading = &history.stages[1];
        let smallest = reference.stages[1].smallest.force;
        assert!((unloading.smallest.force / smallest - 1.0).abs() < 1e-12);
        let figures = Figures::of(&history);
        let found = InstrumentFigures::of(&history, &figures, stiffness);
        let displacement = |a: f64| jkr.indentation(a) + jkr.force(a) / stiffness;
        let closed = (1..200_000)
            .map(|k| displacement(f64::from(k) * 2e-5))
            .fold(f64::INFINITY, f64::min);
        let pull_off = found.pull_off_displacement.unwrap();
        assert!(
            (pull_off / closed - 1.0).abs() < 2e-6,
            "{stiffness}: {pull_off} {closed}"
        );
        // The free body follows the instrument, and to separation it ends where it jumps off.
        assert_eq!(
            (end(unloading).indentation, end(unloading).springs),
            (-40.0, 0)
        );
        let mut last = [targets[0], Move::ToSeparation];
        let separated = loaded(&under(stiffness), &last);
        assert_eq!(end(&separated.stages[1]).indentation, pull_off);
        last[1] = Move::ToDisplacement(pull_off.next_down());
        assert_eq!(end(&loaded(&under(stiffness), &last).stages[1]).springs, 0);
        // ∮F dD: the energy lost in the contact and in the instrument.
        let area: f64 = history
            .stages
            .iter()
            .map(|stage| {
                let curve = DisplacementCurve::new(stage.direction, &stage.curve, stiffness);
                let work = |pair: &[_]| {
                    let [one, next]: [DisplacementPoint; 2] = [pair[0], pair[1]];
                    0.5 * (one.force + next.force) * (next.displacement - one.displacement)
                };
                curve.points().windows(2).map(work).sum::<f64>()
            })
            .sum();
        assert!(
            (found.loop_area.unwrap() / area - 1.0).abs() < 1e-4,
            "{:?} {area}",
            found.loop_area
        );
        assert!(found.loop_area > figures.dissipated_energy);
        areas.push(found.loop_area.unwrap());
        for stage in &history.stages {
            let sign = if stage.direction == Direction::Loading {
                1.0
            } else {
                -1.0
            };
            assert!(
                displacements(stage, stiffness)
                    .map(|at| sign * at)
                    .is_sorted()
            );
        }
    }
    assert!(areas.is_sorted_by(|soft, stiff| soft > stiff), "{areas:?}");
}
