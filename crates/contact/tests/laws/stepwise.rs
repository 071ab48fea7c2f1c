//! The stepwise solver against the exact one.

use super::*;
use asperity_contact::motion::Stepwise;

const FOUNDATION: Foundation = Foundation::new(0.01, 1.0);

fn body(gaps: Vec<f64>, work: f64) -> Body {
    Body::new(gaps, Edges::Grid, FOUNDATION, work)
}

fn rough(points: usize, seed: u64) -> Vec<f64> {
    self_affine(0.7, seed, points)
}

fn stepwise(contact: &Contact, step: f64) -> Stepwise<'_> {
    Stepwise::new(contact, step, 64, &|| false).unwrap()
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn each_spring_changes_within_one_step_of_its_threshold(
        body in whole_springs(120), step in 0.003..0.1_f64, turns in indentations(7),
    ) {
        let contact = body.contact();
        let (mut exact, mut stepwise) = (body.on(2), stepwise(&contact, step));
        for target in to_indentations(&turns) {
            let (one, other) = (stepwise.advance(target).unwrap(), exact.advance(target).unwrap());
            // The end of a stage does not depend on the step: the same springs and, bit for bit,
            // the same force.
            prop_assert_eq!(one.curve.last(), other.curve.last());
            prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
            if other.curve.len() == 1 || end(&other).springs == 0 && other.detached == 0 {
                continue;
            }
            prop_assert_eq!(one.direction, other.direction);
            let (low, high) = (other.start().min(other.end()), other.start().max(other.end()));
            for (found, expected) in stepwise.stage().thresholds().iter().zip(&exact.stage().thresholds()) {
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
}

#[test]
fn it_stops_on_request_and_refuses_too_many_steps() {
    let contact = body(rough(16, 1), 0.0).contact();
    let stop = || true;
    let mut solver = Stepwise::new(&contact, 0.01, 9, &stop).unwrap();
    assert_eq!(
        solver.advance(Move::ToIndentation(1.0)),
        Err(ContactError::Interrupted)
    );
    let refused = stepwise(&contact, 1e-9).advance(Move::ToIndentation(1.0));
    assert_eq!(refused, Err(ContactError::TooManySteps(1e-9)));
}

#[test]
fn targets_out_of_reach_leave_the_body_in_place() {
    let steps = std::cell::Cell::new(0_u64);
    // Called before each step.
    let stop = || {
        steps.set(steps.get() + 1);
        false
    };
    for (work, step) in [(0.0, 1e-3), (1e-3, 1e-3), (1e-3, 1e-30)] {
        let contact = body(rough(64, 3), work).contact();
        let mut solver = Stepwise::new(&contact, step, 9, &stop).unwrap();
        let too_many = Err(ContactError::TooManySteps(step));
        // Too many steps are refused before the first one.
        assert_eq!(solver.advance(Move::ToForce(1e9)), too_many);
        if step < 1e-3 {
            assert!(solver.advance(Move::ToTouch).unwrap().attached > 0);
            assert_eq!(solver.advance(Move::ToSeparation), too_many);
            assert_eq!(solver.advance(Move::ToForce(1e-3)), too_many);
            continue;
        }
        solver.advance(Move::ToIndentation(0.3)).unwrap();
        assert!(steps.replace(0) > 300);
        assert_eq!(
            solver.stage().turn(0.3).err(),
            (work > 0.0).then_some(ContactError::Stepwise)
        );
        let beyond = solver.advance(Move::ToForce(-1e9));
        let Err(ContactError::DetachesBefore { smallest }) = beyond else {
            panic!("{beyond:?}")
        };
        // The body pulled off before it was put back.
        assert!(steps.replace(0) > 300);
        let record = solver.advance(Move::ToSeparation).unwrap();
        assert_eq!(record.smallest.force, smallest);
        steps.set(0);
    }
    assert_eq!(steps.get(), 1);
}
