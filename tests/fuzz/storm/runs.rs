//! Allowed scenes, computed: a valid result, or one error with its place and the allowed values.

use super::*;
use asperity::contact::{ContactError, CurvePoint, Direction, StageRecord};
use asperity::contact::{Edges, Move, Relaxation};
use asperity::scene::Roughness;
use asperity::scene::fields::target_field;
use asperity::scene::workload::BeyondFullContact;
use asperity::scene::{Outcome, RunError, Simulation};
use asperity::surface::Form;
use asperity::surface::{Place, SurfaceError};
use std::time::{Duration, Instant};

/// Longest time of a scene with this few springs.
const PATIENCE: Duration = Duration::from_secs(60);

/// Rounding of a sum over the springs, relative to the size of its terms.
const ROUNDING: f64 = 1e-12;
/// The same for the balance between an instrument and a half-space that relaxes.
const BALANCE: f64 = 2e-11;

/// Computes a scene and asserts the properties of every scene.
fn compute(document: &Document, folder: &std::path::Path) -> Result<(), TestCaseError> {
    let scene = document.scene();
    let clock = Instant::now();
    let stop = || clock.elapsed() > PATIENCE;
    match Simulation::new(folder.to_path_buf()).run(scene, &stop, &mut |_, _, _| Ok(())) {
        Ok(outcome) => {
            assert_numbers(&outcome)?;
            let ends = outcome
                .history
                .stages
                .iter()
                .filter_map(|stage| stage.curve.last().copied());
            let starts = std::iter::once(CurvePoint::default()).chain(ends);
            outcome
                .history
                .stages
                .iter()
                .zip(starts)
                .try_for_each(|(stage, start)| assert_stage(stage, &start, &outcome))?;
            assert_energy(&outcome, scene.numerics.edges)
        }
        Err(RunError::BeyondFullContact(beyond)) => {
            within_reach(document, &beyond).map_or(Ok(()), |document| compute(&document, folder))
        }
        Err(error) => assert_refused(&error, scene),
    }
}

/// The document with the refused stage at the largest target that the refusal names; `None` where
/// the scene does not allow it.
fn within_reach(document: &Document, beyond: &BeyondFullContact) -> Option<Document> {
    let is_refused = |stage: &Move| {
        target_field(*stage)
            .is_some_and(|(field, value)| (field.unit, value) == (beyond.unit, beyond.found))
    };
    let mut stages = document.stages();
    let (_, stage) = stages
        .iter_mut()
        .find(|(_, stage)| is_refused(stage))
        .expect("the refused stage");
    *stage = match *stage {
        Move::ToForce(_) => Move::ToForce(beyond.allowed),
        Move::ToDisplacement(_) => Move::ToDisplacement(beyond.allowed),
        _ => Move::ToIndentation(beyond.allowed),
    };
    document.with_stages(&stages).ok()
}

/// Every number is finite, and counts are consistent.
fn assert_numbers(outcome: &Outcome) -> Result<(), TestCaseError> {
    let all = format!("{outcome:?}");
    prop_assert!(!all.contains("NaN") && !all.contains("inf"), "{}", all);
    let (work, points) = (&outcome.history.work, outcome.line.points);
    prop_assert_eq!(
        outcome
            .history
            .stages
            .iter()
            .map(|stage| stage.attached)
            .sum::<u64>(),
        work.attached
    );
    prop_assert!(work.springs >= 1 && work.springs <= points as u64);
    prop_assert!(
        outcome
            .histogram
            .as_ref()
            .is_none_or(|histogram| histogram.low <= histogram.high)
    );
    for patches in outcome.patches.iter().chain([&outcome.history.contacts]) {
        prop_assert!(
            patches
                .iter()
                .all(|one| one.first <= one.last && one.last < points)
        );
        prop_assert!(
            patches.windows(2).all(|pair| pair[0].last < pair[1].first),
            "{:?}",
            patches
        );
    }
    Ok(())
}

/// Asserts the properties of a stage that begins at a point.
fn assert_stage(
    stage: &StageRecord,
    start: &CurvePoint,
    outcome: &Outcome,
) -> Result<(), TestCaseError> {
    let line = &outcome.line;
    // L/N is rounded, and N of them may exceed L by that.
    let length = line.length.max(line.points as f64 * line.spacing);
    let is_loading = stage.direction == Direction::Loading;
    let is_relaxing = !stage.seconds.is_empty();
    for point in stage.curve.iter().chain([&stage.largest, &stage.smallest]) {
        prop_assert!(
            (0.0..=length).contains(&point.contact_length),
            "{:?} on {} m",
            point,
            length
        );
        prop_assert!(
            point.springs.max(point.patches) <= line.points as u64,
            "{:?}",
            point
        );
        let is_free = point.force == 0.0 && point.contact_length == 0.0;
        prop_assert!(point.patches > 0 || is_free, "{:?}", point);
    }
    // All springs at the deepest compression and the largest gap.
    let gap = line.deepest.max(f64::MIN_POSITIVE);
    let deepest = stage
        .curve
        .iter()
        .map(|point| point.indentation.abs())
        .fold(gap, f64::max);
    let rounding = ROUNDING * outcome.governing.modulus * line.length * deepest;
    for pair in stage.curve.windows(2) {
        let [one, other] = if is_loading {
            [pair[0], pair[1]]
        } else {
            [pair[1], pair[0]]
        };
        // On one way the contact grows with the indentation. A half-space that relaxes on a soft
        // instrument also moves by itself, so that only the displacement of the instrument is
        // known.
        if let (true, Some(instrument)) = (is_relaxing, &outcome.instrument) {
            let displacement = |point: &CurvePoint| point.displacement(instrument.stiffness);
            let balance = BALANCE / ROUNDING * rounding / instrument.stiffness;
            let scale = one.indentation.abs().max(other.indentation.abs());
            let error = balance + 50.0 * BALANCE * scale;
            let is_later = displacement(&one) <= displacement(&other) + error;
            prop_assert!(is_later, "{:?}", pair);
            continue;
        }
        let grows = one.indentation <= other.indentation && one.springs <= other.springs;
        prop_assert!(
            grows && one.contact_length <= other.contact_length + ROUNDING * length,
            "{:?}",
            pair
        );
    }
    // Extremes are those of the contact; outside of contact there is no force.
    for point in stage.curve.iter().filter(|point| point.patches > 0) {
        let is_inside = if is_loading {
            point.force <= stage.largest.force + rounding
        } else {
            point.force >= stage.smallest.force - rounding
        };
        let may_pull = outcome.governing.adhesive_work().is_some() || point.force >= 0.0;
        prop_assert!(
            is_inside && may_pull,
            "{:?} {:?} {:?}",
            point,
            stage.largest,
            stage.smallest
        );
    }
    let Some(end) = stage.curve.last() else {
        return Err(TestCaseError::fail("a stage without points"));
    };
    prop_assert_eq!(start.springs + stage.attached - stage.detached, end.springs);
    let share = if is_relaxing && outcome.instrument.is_some() {
        BALANCE
    } else {
        ROUNDING
    };
    let largest = stage.largest.force.abs().max(stage.smallest.force.abs());
    let rounding = rounding.max(share * largest);
    let is_at = |force: f64| (end.force - force).abs() <= rounding + share * force.abs();
    let is_displaced = |at: f64| match outcome.instrument {
        Some(instrument) if end.springs > 0 => {
            let error = (end.displacement(instrument.stiffness) - at).abs();
            let size = at.abs() + end.indentation.abs();
            error <= rounding / instrument.stiffness + share * size
        }
        _ => (end.indentation - at).abs() <= share * gap * f64::from(u8::from(is_relaxing)),
    };
    // A soft instrument jumps into contact at D = 0, and the relaxation follows it in time.
    let follows_jumps = is_relaxing && outcome.instrument.is_some();
    let is_reached = match stage.target {
        Move::ToForce(force) => is_at(force),
        Move::ToZeroForce => is_at(0.0),
        Move::ToIndentation(indentation) => {
            let has_jumped = follows_jumps && is_loading && end.indentation > indentation;
            has_jumped || end.indentation == indentation
        }
        Move::ToDisplacement(at) => is_displaced(at),
        Move::ToTouch => end.indentation == 0.0 || follows_jumps && is_displaced(0.0),
        Move::ToSeparation => (end.springs, end.patches) == (0, 0),
        Move::Hold(_) => true,
    };
    prop_assert!(is_reached, "{:?} ends at {:?}", stage.target, end);
    Ok(())
}

/// From separation to separation energy is dissipated, never gained; without adhesion none is
/// dissipated.
fn assert_energy(outcome: &Outcome, edges: Edges) -> Result<(), TestCaseError> {
    let stages = &outcome.history.stages;
    let size: f64 = stages.iter().map(|stage| stage.released_energy.abs()).sum();
    let (mut sum, mut least) = (0.0, f64::INFINITY);
    for stage in stages {
        sum += stage.released_energy;
        if stage
            .curve
            .last()
            .is_some_and(|point| point.springs == 0 && point.patches == 0)
        {
            least = least.min(sum);
        }
    }
    let deepest = outcome.line.deepest;
    let squares = match edges {
        // Springs stretched by less than a rounding of the gaps attach and detach at a place
        // decided by rounding.
        Edges::Grid => (2.0 * f64::EPSILON * deepest).powi(2),
        // Squares over parts of cells are rounded numbers, of which only differences are released.
        Edges::SubCell => f64::EPSILON * deepest * deepest,
    };
    let mut rounded = 0.5 * outcome.governing.modulus * outcome.line.length * squares;
    // The released energy of a half-space that relaxes is a difference of works, each with the
    // error of the steps in time.
    for stage in stages.iter().filter(|stage| !stage.seconds.is_empty()) {
        let force = stage.largest.force.abs().max(stage.smallest.force.abs());
        let ways = stage.curve.windows(2);
        let way: f64 = ways
            .map(|pair| (pair[1].indentation - pair[0].indentation).abs())
            .sum();
        rounded += Relaxation::STEP_ERROR * force * way;
    }
    prop_assert!(
        least >= -ROUNDING * size - rounded,
        "{:e} J won of {:e}",
        -least,
        size
    );
    prop_assert!(
        outcome.governing.adhesive_work().is_some() || size == 0.0,
        "{:e} J without adhesion",
        size
    );
    Ok(())
}

/// An error names a stage, a field or the excessive size, and a refused force comes with the
/// allowed ones.
fn assert_refused(error: &RunError, scene: &Scene) -> Result<(), TestCaseError> {
    let message = error.to_string();
    prop_assert_eq!(message.lines().count(), 1);
    let is_explained = match error {
        RunError::Contact(ContactError::Stage {
            index,
            target,
            reason,
        }) => {
            // Without adhesion every pressing force has its indentation, unless that exceeds all
            // numbers.
            let stiffness = scene.material.modulus_in_pascals() * scene.length;
            let presses = matches!(target, Move::ToForce(force) if *force > 0.0 && (force / stiffness).is_finite());
            let is_out_of_reach =
                **reason == ContactError::OutOfReach && (scene.adhesion.is_some() || !presses);
            let is_named = message.starts_with(&format!("stage {}: ", index + 1));
            let has_limit = ["; allowed", "within reach: "]
                .iter()
                .any(|words| message.contains(words));
            is_named && (has_limit || is_out_of_reach)
        }
        RunError::Surface(error) if error.field() == Some("form.file") => {
            matches!(scene.form, Some(Form::Table { .. })) && message.starts_with("form.file = ")
        }
        RunError::Surface(SurfaceError::Refused {
            place: Place::Point(_),
            ..
        }) => message.contains("form and roughness"),
        RunError::Surface(error) => error.file().is_some_and(|file| {
            matches!(scene.roughness, Some(Roughness::Measured { .. }))
                && message.contains(&format!("{file:?}"))
        }),
        _ => false,
    };
    prop_assert!(is_explained, "{}", message);
    Ok(())
}

#[test]
fn scenes_over_whole_ranges() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = (
        quick().documents(),
        shapes(),
        (-30.0..5.0_f64).prop_map(f64::exp),
    );
    proptest!(draws(200), |((document, shape, height) in scenes)| {
        // A little longer than the line.
        let profile = text_of(&shape, document.scene().length * (1.0 + 1e-9), height);
        std::fs::write(folder.path().join(FILE), profile).unwrap();
        compute(&document, folder.path())?;
    });
}

/// Gaps so far above all stretches that edges between springs round the released energy to noise.
#[test]
fn gaps_far_above_the_stretches() {
    for (modulus, edges) in [
        ("1.0e5", "Grid"),
        ("1.0e5", "SubCell"),
        ("1.0e13", "SubCell"),
    ] {
        let text = format!(
            "(version: 1, material: (modulus: {modulus}), length: 1.0e-9, form: Paraboloid(radius: 1.0e-3),
            roughness: SelfAffine(hurst: 0.7, rms_height: 100.0, modes: (91, 315), seed: 0),
            adhesion: (work: 1.2563377122730193), loading: [ToForce(1.0e30), ToSeparation],
            numerics: (points: 630, edges: {edges}, samples: 10))"
        );
        let document = Document::parse(&text, "drawn").unwrap();
        compute(&document, std::path::Path::new(""))
            .unwrap_or_else(|error| panic!("{modulus} {edges}: {error}"));
    }
}
