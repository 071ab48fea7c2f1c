//! Measured force curves.

use super::assert_message;
use asperity::experiment::{CurveOptions, Drift, MeasuredCurve, Tilt};
use std::path::Path;

/// An accepted curve has finite points in the order of its segments and a noise above 0; a refusal
/// is one line with the allowed values, for any options.
pub fn curve(bytes: &[u8]) {
    let words = |text: &str| text.split(',').map(str::to_owned).collect();
    let lines = CurveOptions {
        drift: Drift::Remove,
        tilt: Tilt::Remove,
        ..CurveOptions::default()
    };
    for options in [
        CurveOptions::default(),
        CurveOptions {
            units: words("nm,3nN"),
            ramp: Some(5e-7),
            ..lines
        },
        CurveOptions {
            columns: words("1,2"),
            units: words("um,nN"),
            instrument: Some(3.0),
            ..CurveOptions::default()
        },
    ] {
        match MeasuredCurve::parse(Path::new("curve"), bytes, &options) {
            Ok(curve) => assert_curve(&curve),
            Err(error) => {
                let message = error.to_string();
                assert_message(&message);
                let is_damaged = message.starts_with("cannot be read: ");
                assert!(message.contains("allowed: ") || is_damaged, "{message}");
            }
        }
    }
}

fn assert_curve(curve: &MeasuredCurve) {
    let count = curve.force.len();
    assert!(
        count > 0 && count <= curve.points,
        "{count} of {}",
        curve.points
    );
    assert_eq!(
        (curve.displacement.len(), curve.segment.len()),
        (count, count)
    );
    assert!(
        curve
            .points()
            .all(|(displacement, force)| displacement.is_finite() && force.is_finite())
    );
    assert!(curve.segment.is_sorted(), "{:?}", curve.segment);
    assert!(
        curve.noise > 0.0 && curve.noise.is_finite() && curve.touch.is_finite(),
        "{}",
        curve.noise
    );
    assert!(curve.pull_off_force().is_none_or(|force| force > 0.0));
    curve
        .statements
        .iter()
        .for_each(|statement| assert_message(&statement.to_string()));
}
