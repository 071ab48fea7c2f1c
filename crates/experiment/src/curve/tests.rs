//! Tests of reading and preparing a measured curve: choice of points, refusals, pull-off.

use crate::common::{from_text, lines, of_spring, text_of_spring};
use crate::curve::ordered::MOST_POINTS;
use crate::read::options::{CurveOptions, Negate};

#[test]
fn many_points_are_averaged_and_missing_ones_counted() {
    let text = text_of_spring(
        "displacement [nm],force [nN]\nNaN,1\n0,\n",
        100_000,
        |d, f| format!("{d},{f}"),
    );
    let curve = from_text(&text, &CurveOptions::default()).unwrap();
    assert_eq!((curve.missing, curve.points), (2, 100_000));
    assert!(
        curve.force.len() <= MOST_POINTS && curve.statements.len() == 3,
        "{:?}",
        curve.statements
    );
    let said = "2 left out since a value is missing; means of 25 points each, 4 000 of them.";
    assert!(
        curve.statements[0].to_string().ends_with(said),
        "{:?}",
        curve.statements
    );
    assert!(
        (curve.force[2000] / 1e-7 - 1.0).abs() < 0.01,
        "{:e}",
        curve.force[2000]
    );
    // The option counts points of the file, and not the means that replace them.
    let options = CurveOptions {
        free_points: Some(2700),
        ..CurveOptions::default()
    };
    let curve = from_text(&lines(of_spring(9000)), &options).unwrap();
    assert_eq!((curve.force.len(), curve.free), (3000, 900));
}

/// The zero offset of the force and the contact point follow from the approach if the file has
/// one, even if only a retraction is chosen. In a file with a retraction alone, they follow
/// from the end of the retraction.
#[test]
fn chosen_segments_are_used_without_pauses() {
    let read = |points: &[(f64, f64)], segments: &[usize]| {
        let options = CurveOptions {
            segments: segments.to_vec(),
            ..CurveOptions::default()
        };
        from_text(&lines(points.iter().copied()), &options).unwrap()
    };
    let mut all = of_spring(600);
    let (whole, retraction) = (read(&all, &[]), read(&all, &[2]));
    assert_eq!(
        (retraction.points, retraction.free, retraction.segment[0]),
        (300, 0, 1)
    );
    assert_eq!(
        (&retraction.force[..], retraction.touch),
        (&whole.force[300..], whole.touch)
    );
    assert_eq!(retraction.turns, whole.turns);
    let alone = read(&all[300..], &[]);
    assert_eq!(
        (alone.points, alone.segment[0], alone.turns.len()),
        (300, 1, 2)
    );
    assert!(
        alone
            .force
            .iter()
            .zip(&retraction.force)
            .all(|(first, second)| (first - second).abs() < 5e-11)
    );
    assert!(
        (alone.touch - whole.touch).abs() < 2e-9,
        "{} {}",
        alone.touch,
        whole.touch
    );
    let approach = read(&all[..300], &[1]);
    assert_eq!(
        (&approach.force[..], approach.turns.len()),
        (&whole.force[..300], 2)
    );
    all.splice(
        300..300,
        (0..200).map(|index| (50.0, 101.0 - 0.02 * f64::from(index))),
    );
    let (moving, retraction) = (read(&all, &[]), read(&all, &[2]));
    assert!((590..=600).contains(&moving.points), "{}", moving.points);
    assert!(
        (290..=300).contains(&retraction.points),
        "{}",
        retraction.points
    );
}

#[test]
fn what_is_no_curve_is_refused() {
    let of = |force: &dyn Fn(f64, f64) -> f64| {
        lines(of_spring(600).into_iter().map(|(d, f)| (d, force(d, f))))
    };
    let all = of_spring(600);
    // An approach of only 17 points is too short.
    let few = (0..42_i32).map(|index| {
        if index < 17 {
            10 * index
        } else {
            170 - 7 * (index - 17)
        }
    });
    for (text, said) in [
        (
            of(&|d, _| if (d as i64) % 2 == 0 { 1.0 } else { 1.1 }),
            "no contact: ",
        ),
        // A curve that begins in contact has no straight part at its beginning, and is refused.
        (
            of(&|d, f| f + (d + 100.0).powi(2)),
            "no part before contact: the force",
        ),
        (of(&|d, f| f + 9.0 * d), "no part before contact: the force"),
        (
            of(&|d, _| 9.0 * d + (d * 7.0).sin()),
            "no contact, or contact from the first",
        ),
        (
            of(&|_, f| -f),
            "the force is negative where the body presses: -9",
        ),
        (
            lines(few.map(|d| (f64::from(d), f64::from((d - 90).max(0))))),
            "18 points in the approach are too few",
        ),
        (
            lines((0..600).map(|index| all[index * 251 % 600])),
            "the displacement goes to and fro",
        ),
        (
            lines(all[..301].iter().copied()),
            "the displacement does not turn",
        ),
        (
            lines([(1.0, 2.0)]),
            "1 points with displacement and force; allowed: at least 40",
        ),
        (String::new(), "0 points"),
    ] {
        let error = from_text(&text, &CurveOptions::default()).expect_err(said);
        assert!(
            error.starts_with(said) && error.contains("allowed: "),
            "{said}: {error}"
        );
    }
}

#[test]
fn options_that_do_not_fit_a_curve_are_refused() {
    let plain = lines(of_spring(600));
    let with = CurveOptions::default;
    for (options, said) in [
        (
            CurveOptions {
                negate: Some(Negate::Displacement),
                ..with()
            },
            "the body moves away",
        ),
        (
            CurveOptions {
                free_points: Some(400),
                ..with()
            },
            "no part before contact: 400 of",
        ),
        (
            CurveOptions {
                noise: Some(-5e-9),
                ..with()
            },
            "a noise of -0.000000005 N",
        ),
        (
            CurveOptions {
                segments: vec![3],
                ..with()
            },
            "segment 3: the curve has no such segment",
        ),
    ] {
        let error = from_text(&plain, &options).expect_err(said);
        assert!(
            error.starts_with(said) && error.contains("allowed: "),
            "{said}: {error}"
        );
    }
}

/// If a retraction ends in tension, it has no pull-off force. If the same retraction continues
/// until the contact is lost, it has one.
#[test]
fn a_curve_that_does_not_detach_has_no_pull_off_force() {
    let adheres = |end: f64| {
        let points = of_spring(600).into_iter().enumerate();
        let pulled = points.filter_map(|(index, (d, f))| match (index < 300, d) {
            (true, _) => Some((d, f)),
            (false, d) if d < end => None,
            (false, d) if d < -30.0 => Some((d, 1.0 + 0.1 * f64::from(index as u32 % 2))),
            (false, d) => Some((d, 1.0 + 2.0 * d)),
        });
        from_text(&lines(pulled), &CurveOptions::default()).unwrap()
    };
    let whole = adheres(-100.0);
    let force = whole.pull_off_force().unwrap();
    assert!(
        whole.detaches && (force / 60e-9 - 1.0).abs() < 0.02,
        "{force:e}"
    );
    let held = adheres(-20.0);
    assert!(!held.detaches && held.pull_off_force().is_none());
}

/// Short steps of a loading count as motions. A slow creep in a part of the file that has no
/// name counts as a pause.
#[test]
fn short_steps_are_used() {
    let spring = |d: f64, part: i32| (d, 2.0 * d.max(0.0) + 0.1 * f64::from(part % 2), part);
    let mut points = Vec::new();
    points.extend((-100..40).map(|d| spring(f64::from(d), 0)));
    points.extend((0..50).map(|index| spring(40.0 + 0.001 * f64::from(index), 1)));
    points.extend((40..44).map(|d| spring(f64::from(d), 2)));
    points.extend((0..50).map(|index| spring(44.0 + 0.001 * f64::from(index), 3)));
    points.extend((-100..44).rev().map(|d| spring(f64::from(d), 4)));
    let text = points.iter().fold(
        "displacement [nm],force [nN],segment\n".to_owned(),
        |text, (d, f, part)| text + &format!("{d},{f},{part}\n"),
    );
    let curve = from_text(&text, &CurveOptions::default()).unwrap();
    assert_eq!(curve.points, 140 + 4 + 144, "{:?}", curve.statements);
}
