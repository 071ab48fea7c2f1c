//! Allowed scenes, computed: a valid result, or one error with its place and the allowed values.

use super::*;
use asperity::contact::{ContactError, CurvePoint, Direction, LegRecord};
use asperity::export::{Report, RunReport};
use asperity::scene::{Move, Roughness};
use asperity::simulation::{Outcome, RunError, Simulation};
use asperity::surface::SurfaceError;
use profiles::{FILE, Shape};
use std::time::{Duration, Instant};

/// Number of scenes computed.
const RUNS: u32 = 375;

/// Longest time of a scene with this few springs.
const PATIENCE: Duration = Duration::from_secs(60);

/// Rounding of a sum over the springs, relative to the size of its terms.
const ROUNDING: f64 = 1e-12;

/// Computes a scene and asserts the properties of every scene.
fn compute(document: &Document, folder: &std::path::Path) -> Result<(), TestCaseError> {
    let scene = document.scene();
    let clock = Instant::now();
    let stop = || clock.elapsed() > PATIENCE;
    match Simulation::new(folder.to_path_buf()).run(scene, &stop, &mut |_, _, _| Ok(())) {
        Ok(outcome) => {
            assert_numbers(&outcome)?;
            for (leg, before) in outcome.history.legs.iter().zip(ends(&outcome)) {
                assert_leg(leg, &before, &outcome)?;
            }
            assert_energy(&outcome)?;
            assert_written(scene, &outcome)
        }
        Err(error) => assert_refused(&error, scene),
    }
}

/// Point at the beginning of each leg: the body separated, then the end of the leg before.
fn ends(outcome: &Outcome) -> Vec<CurvePoint> {
    let ends = outcome.history.legs.iter().filter_map(|leg| leg.curve.last().copied());
    std::iter::once(CurvePoint::default()).chain(ends).collect()
}

/// Every number is finite, and counts are consistent.
fn assert_numbers(outcome: &Outcome) -> Result<(), TestCaseError> {
    let all = format!("{outcome:?}");
    for word in ["NaN", "inf"] {
        prop_assert!(!all.contains(word), "{all}");
    }
    prop_assert_eq!(
        outcome.history.legs.iter().map(|leg| leg.attached).sum::<u64>(),
        outcome.history.work.attached
    );
    let springs = outcome.history.work.springs;
    prop_assert!(springs >= 1 && springs <= outcome.line.points as u64);
    if let Some(histogram) = &outcome.histogram {
        prop_assert!(histogram.low <= histogram.high);
    }
    for patches in outcome.fragments.iter().chain([&outcome.history.contacts]) {
        prop_assert!(patches.iter().all(|one| one.first <= one.last && one.last < outcome.line.points));
        prop_assert!(patches.windows(2).all(|pair| pair[0].last < pair[1].first), "{:?}", patches);
    }
    Ok(())
}

/// Size of the forces summed on a leg, N: all springs at the deepest compression and the largest gap.
fn force_scale(leg: &LegRecord, outcome: &Outcome) -> f64 {
    let gap = outcome.line.deepest.max(f64::MIN_POSITIVE);
    let deepest = leg.curve.iter().map(|point| point.indentation.abs()).fold(gap, f64::max);
    outcome.governing.effective_modulus * outcome.line.length * deepest
}

/// Asserts the properties of a leg that begins at a point.
fn assert_leg(leg: &LegRecord, before: &CurvePoint, outcome: &Outcome) -> Result<(), TestCaseError> {
    // L/N is rounded, and N of them may exceed L by that.
    let length = outcome.line.length.max(outcome.line.points as f64 * outcome.line.spacing);
    let loading = leg.direction == Direction::Loading;
    for point in leg.curve.iter().chain([&leg.largest, &leg.smallest]) {
        prop_assert!((0.0..=length).contains(&point.contact_length), "{:?} on {} m", point, length);
        prop_assert!(
            point.springs <= outcome.line.points as u64 && point.fragments <= outcome.line.points as u64
        );
        if point.fragments == 0 {
            prop_assert!(point.force == 0.0 && point.contact_length == 0.0, "{:?}", point);
        }
    }
    for pair in leg.curve.windows(2) {
        let [one, other] = if loading { [pair[0], pair[1]] } else { [pair[1], pair[0]] };
        prop_assert!(one.indentation <= other.indentation, "{:?}", pair);
        // On one way the contact grows with the indentation.
        prop_assert!(one.springs <= other.springs, "{:?}", pair);
        prop_assert!(one.contact_length <= other.contact_length + ROUNDING * length, "{:?}", pair);
    }
    let rounding = ROUNDING * force_scale(leg, outcome);
    // Extremes are those of the contact; outside of contact there is no force.
    for point in leg.curve.iter().filter(|point| point.fragments > 0) {
        prop_assert!(
            !loading || point.force <= leg.largest.force + rounding,
            "{:?} {:?}",
            point,
            leg.largest
        );
        prop_assert!(
            loading || point.force >= leg.smallest.force - rounding,
            "{:?} {:?}",
            point,
            leg.smallest
        );
        if outcome.governing.adhesive_work().is_none() {
            prop_assert!(point.force >= 0.0, "{:?} pulls without adhesion", point);
        }
    }
    let Some(end) = leg.curve.last() else { return Err(TestCaseError::fail("a leg without points")) };
    prop_assert_eq!(before.springs + leg.attached - leg.detached, end.springs);
    assert_target(leg, end, rounding)
}

/// A leg ends at its target.
fn assert_target(leg: &LegRecord, end: &CurvePoint, rounding: f64) -> Result<(), TestCaseError> {
    let force = |target: f64| {
        let error = (end.force - target).abs();
        prop_assert!(
            error <= rounding + ROUNDING * target.abs(),
            "{:?} ends at {:?}, {:e} off",
            leg.target,
            end,
            error
        );
        Ok(())
    };
    match leg.target {
        Move::ToForce(target) => force(target)?,
        Move::ToZeroForce => force(0.0)?,
        Move::ToIndentation(target) => prop_assert_eq!(end.indentation, target),
        Move::ToTouch => prop_assert_eq!(end.indentation, 0.0),
        Move::ToSeparation => prop_assert_eq!((end.springs, end.fragments), (0, 0)),
    }
    Ok(())
}

/// From separation to separation energy is dissipated, never gained; without adhesion none is dissipated.
fn assert_energy(outcome: &Outcome) -> Result<(), TestCaseError> {
    let legs = outcome.history.legs.iter().map(|leg| leg.released_energy);
    let size = legs.clone().map(f64::abs).sum::<f64>();
    let (mut sum, mut least) = (0.0, f64::INFINITY);
    for (energy, leg) in legs.zip(&outcome.history.legs) {
        sum += energy;
        if leg.curve.last().is_some_and(|point| point.springs == 0 && point.fragments == 0) {
            least = least.min(sum);
        }
    }
    // Springs stretched by less than a rounding of the gaps attach and detach at a place decided by rounding.
    let place = 2.0 * f64::EPSILON * outcome.line.deepest;
    let rounded = 0.5 * outcome.governing.effective_modulus * outcome.line.length * place * place;
    prop_assert!(least >= -ROUNDING * size - rounded, "{:e} J won of {:e}", -least, size);
    prop_assert!(outcome.governing.adhesive_work().is_some() || size == 0.0, "{:e} J without adhesion", size);
    Ok(())
}

/// The written curve reads back bit for bit.
fn assert_written(scene: &Scene, outcome: &Outcome) -> Result<(), TestCaseError> {
    let mut table = Vec::new();
    let report = RunReport { title: "", scene, outcome, choice: None, estimate: None };
    let curve = report.table().ok_or_else(|| TestCaseError::fail("no table"))?;
    curve
        .write_csv(&mut table, "asperity run drawn")
        .map_err(|error| TestCaseError::fail(error.to_string()))?;
    let table = String::from_utf8_lossy(&table);
    let read = table.lines().filter(|row| !row.starts_with('#')).skip(1).map(|row| {
        let numbers: Vec<f64> = row.split(',').filter_map(|column| column.parse().ok()).collect();
        numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>()
    });
    let legs = outcome.history.legs.iter().enumerate();
    let points = legs.flat_map(|(index, leg)| leg.curve.iter().map(move |point| (index, point)));
    let computed = points.map(|(index, point)| {
        let CurvePoint { indentation, force, contact_length, fragments, stored_energy, springs: _ } = *point;
        [index as f64, indentation, force, contact_length, fragments as f64, stored_energy]
            .map(f64::to_bits)
            .to_vec()
    });
    prop_assert!(read.eq(computed), "{}", table);
    Ok(())
}

/// An error names a leg, a field or the excessive size, and a refused force comes with the allowed ones.
fn assert_refused(error: &RunError, scene: &Scene) -> Result<(), TestCaseError> {
    let message = error.to_string();
    prop_assert_eq!(message.lines().count(), 1);
    match error {
        RunError::Contact(ContactError::Stage { index, target, reason }) => {
            prop_assert!(message.starts_with(&format!("loading.{index} = ")), "{}", message);
            if **reason != ContactError::OutOfReach {
                prop_assert!(message.contains("; allowed"), "{}", message);
                return Ok(());
            }
            // Without adhesion every pressing force has its indentation, unless that exceeds all numbers.
            let presses = matches!(target, Move::ToForce(force) if *force > 0.0);
            let stiffness = scene.material.effective_modulus() * scene.length;
            let reaches = matches!(target, Move::ToForce(force) if (force / stiffness).is_finite());
            prop_assert!(scene.adhesion.is_some() || !presses || !reaches, "{}", message);
        }
        RunError::Surface(SurfaceError::NotFinite { .. }) => {
            prop_assert!(message.contains("form and roughness"), "{}", message);
        }
        RunError::Surface(SurfaceError::Measured { file, .. }) => {
            let measured = matches!(scene.roughness, Some(Roughness::Measured { .. }));
            prop_assert!(measured, "{}", message);
            // Signs that are not printed are written as their numbers.
            prop_assert!(message.contains(&format!("{file:?}")), "{}", message);
        }
        other => return Err(TestCaseError::fail(other.to_string())),
    }
    Ok(())
}

#[test]
fn scenes_over_whole_ranges() {
    let folder = tempfile::tempdir().unwrap();
    let heights = (-30.0..5.0_f64).prop_map(f64::exp);
    let scenes = (quick().documents(), profiles::shapes(), heights);
    proptest!(draws(RUNS), |((document, shape, height) in scenes)| {
        write_profile(&document, &shape, height, folder.path());
        compute(&document, folder.path())?;
    });
}

/// Writes the profile named by a scene: a little longer than the line.
fn write_profile(document: &Document, shape: &Shape, height: f64, folder: &std::path::Path) {
    if matches!(document.scene().roughness, Some(Roughness::Measured { .. })) {
        let text = shape.text(document.scene().length * (1.0 + 1e-9), height);
        std::fs::write(folder.join(FILE), text).unwrap();
    }
}
