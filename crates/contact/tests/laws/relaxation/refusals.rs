//! Loadings that a contact with relaxation refuses, and loadings that it accepts.

use super::*;
use asperity_contact::ContactError;
use asperity_contact::motion::RelaxingBody;
use std::cell::Cell;

fn sphere(share: f64) -> Sphere {
    Sphere {
        points: 201,
        work: 1.0,
        share,
        time: 1.0,
        speed: 1.0,
        stiffness: f64::INFINITY,
    }
}

#[test]
fn wrong_values_are_named_with_what_is_allowed() {
    let refused = |share, time| Relaxation::new(share, time).unwrap_err().to_string();
    assert_eq!(
        refused(1.0, 1.0),
        "relaxation share = 1; allowed: from 0 to 0.99"
    );
    assert_eq!(
        refused(f64::NAN, 1.0),
        "relaxation share = NaN; allowed: from 0 to 0.99"
    );
    assert_eq!(
        refused(0.5, 0.0),
        "relaxation time = 0; allowed: from 1e-50 to 1e50 s"
    );
    let (gaps, spacing) = sphere(0.5).gaps();
    let profile = Profile::from_gaps(gaps, spacing).unwrap();
    let builder = Contact::builder(&profile, Modulus::effective(1.0).unwrap());
    let relaxing = builder
        .clone()
        .relaxation(Relaxation::new(0.5, 1.0).unwrap());
    let refused = |builder: ContactBuilder| builder.build().unwrap_err().to_string();
    assert_eq!(
        refused(relaxing.clone()),
        "loading speed = 0; allowed: above 0 m/s; relaxation needs a loading speed"
    );
    assert_eq!(
        refused(relaxing.clone().loading_speed(-1.0)),
        "loading speed = -1; allowed: from 1e-50 to 1e50 m/s"
    );
    assert_eq!(
        refused(relaxing.loading_speed(1.0).edges(Edges::Grid)),
        "relaxation share = 0.5; allowed: 0 with Edges::Grid; relaxation needs Edges::SubCell"
    );
    let elastic = builder.relaxation(Relaxation::new(0.0, 1.0).unwrap());
    assert!(elastic.build().unwrap().relaxation().is_none());
}

#[test]
fn wrong_loadings_are_named() {
    let contact = sphere(0.5).contact();
    let refused = |stages: &[Move]| contact.load(stages).unwrap_err();
    let again = [Move::ToForce(1.0), Move::ToSeparation, Move::ToForce(1.0)];
    assert_eq!(refused(&again).stage(), Some(2));
    let words = "stage 3: with relaxation the surface that has detached has not recovered";
    assert!(
        refused(&again).to_string().starts_with(words),
        "{}",
        refused(&again)
    );
    let smallest = refused(&[Move::ToForce(1.0), Move::ToForce(-100.0)]);
    assert!(
        smallest.smallest_force().is_some_and(|force| force < -4.0),
        "{smallest}"
    );
    assert!(contact.load(&[Move::Hold(f64::NAN)]).is_err());
    assert!(contact.load(&[Move::Hold(-1.0)]).is_err());
    assert!(contact.load(&[Move::ToForce(-1.0)]).is_err());
}

#[test]
fn stages_of_any_kind_reach_their_targets() {
    let contact = sphere(0.5).contact();
    let stages = [
        Move::Hold(1.0),
        Move::ToTouch,
        Move::ToZeroForce,
        Move::ToForce(1.0),
        Move::Hold(0.5),
        Move::ToForce(2.0),
        Move::ToIndentation(1.5),
        Move::Hold(0.0),
        Move::ToForce(0.5),
        Move::Hold(2.0),
        Move::ToZeroForce,
        Move::ToSeparation,
        Move::Hold(1.0),
        Move::ToSeparation,
    ];
    let cycle = contact.load(&stages).unwrap();
    let end = |stage: usize| *cycle.stages()[stage].curve.last().unwrap();
    assert_eq!(end(0).springs, 0);
    assert_eq!(end(1).indentation, 0.0);
    for (stage, force) in [(2, 0.0), (3, 1.0), (5, 2.0), (8, 0.5), (10, 0.0)] {
        assert!(
            (end(stage).force - force).abs() < 1e-9,
            "{stage}: {:?}",
            end(stage)
        );
    }
    assert_eq!(end(6).indentation, 1.5);
    assert_eq!(end(12).springs, 0);
    let times: Vec<f64> = cycle
        .stages()
        .iter()
        .flat_map(|stage| stage.seconds.clone())
        .collect();
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]));
    let attached: u64 = cycle.stages().iter().map(|stage| stage.attached).sum();
    let detached: u64 = cycle.stages().iter().map(|stage| stage.detached).sum();
    assert_eq!(attached, detached);
}

proptest! {
    #![proptest_config(cases(200))]

    /// Every accepted value gives finite results.
    #[test]
    fn no_result_is_other_than_a_finite_number(
        body in bodies(60),
        share in 0.0..0.99_f64,
        time in -30.0..30.0_f64,
        speed in -10.0..10.0_f64,
        stiffness in prop_oneof![Just(f64::INFINITY), 1e-3..1e3_f64],
        turn in 0.0..1.3_f64,
    ) {
        let contact = body
            .foundation
            .builder(&body.gaps, Edges::SubCell, [body.closing_work, body.work])
            .relaxation(Relaxation::new(share, 10.0_f64.powf(time)).unwrap())
            .loading_speed(10.0_f64.powf(speed))
            .loading_stiffness(stiffness)
            .build()
            .unwrap();
        let stages = [Move::ToIndentation(turn), Move::Hold(1.0), Move::ToSeparation];
        let cycle = contact.load(&stages);
        let figures = cycle.as_ref().map(|cycle| (cycle.figures(), cycle.curve(), cycle.patches()));
        let found = format!("{figures:?}");
        prop_assert!(!found.contains("NaN") && !found.contains("inf"), "{}", found);
    }
}

#[test]
fn a_stage_stops_on_request_and_leaves_the_body_in_place() {
    let contact = sphere(0.5).contact();
    let calls = Cell::new(0);
    let stop = || {
        calls.set(calls.get() + 1);
        calls.get() == 70
    };
    let mut solver = RelaxingBody::new(&contact).unwrap().with_stop(&stop);
    let pressed = solver.advance(Move::ToForce(5.0)).unwrap();
    let point = solver.point();
    let interrupted = solver.advance(Move::Hold(1.0)).unwrap_err();
    assert_eq!(interrupted, ContactError::Interrupted);
    assert_eq!(solver.point(), point);
    assert_eq!(pressed.curve.last(), Some(&point));
    solver.advance(Move::ToSeparation).unwrap();
}
