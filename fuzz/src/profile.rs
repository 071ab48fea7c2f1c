//! Measured profiles.

use super::{assert_message, text};
use asperity::surface::Amplitude;
use asperity::surface::lines::{MeasuredOptions, MeasuredProfile};
use asperity::surface::{ReadOptions, SurfaceError, Unit};

/// An accepted profile has finite points in ascending order and can be sampled; a refusal is one
/// line that states the allowed values.
pub fn profile(bytes: &[u8]) {
    let text = text(bytes);
    let read = parse(&text);
    // Line breaks do not matter.
    assert_eq!(parse(&text.replace('\n', "\r\n")), read);
    match read {
        Ok(profile) => {
            assert_points(&profile);
            assert_samples(&profile);
        }
        Err(error) => {
            let message = error.to_string();
            assert_message(&message);
            assert!(message.contains("allowed: "), "{message}");
            if let Some((number, _)) = message
                .strip_prefix("line ")
                .and_then(|rest| rest.split_once(": "))
            {
                let lines = text.split(['\n', '\r']).count();
                assert!(
                    number
                        .parse()
                        .is_ok_and(|number| (1..=lines).contains(&number)),
                    "{lines}: {message}"
                );
            }
        }
    }
}

fn parse(text: &str) -> Result<MeasuredProfile, SurfaceError> {
    let reading = ReadOptions {
        convention: Some(Unit::METRE),
        ..ReadOptions::default()
    };
    MeasuredProfile::new(
        text.as_bytes(),
        &MeasuredOptions {
            reading,
            ..MeasuredOptions::default()
        },
    )
}

fn assert_points(profile: &MeasuredProfile) {
    let (positions, heights) = (&profile.positions, &profile.heights);
    assert!(positions.len() >= 2 && positions.len() == heights.len());
    assert!(
        positions
            .iter()
            .chain(heights)
            .all(|value| value.is_finite())
    );
    assert!(positions.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(
        profile.length().is_finite() && profile.length() > 0.0,
        "{}",
        profile.length()
    );
    let Amplitude {
        rms_height,
        rms_gradient,
        ..
    } = profile.amplitude().unwrap();
    assert!(rms_height.is_finite() && rms_height >= 0.0, "{rms_height}");
    assert!(
        rms_gradient.is_finite() && rms_gradient >= 0.0,
        "{rms_gradient}"
    );
    let (low, high) = ends(heights);
    assert!(
        rms_height <= (high - low) * (1.0 + 1e-9) + f64::MIN_POSITIVE.sqrt(),
        "{rms_height}"
    );
}

fn assert_samples(profile: &MeasuredProfile) {
    let length = profile.length();
    let (low, high) = ends(&profile.heights);
    let first = profile.heights[0];
    let margin = 4.0 * f64::EPSILON * (high - low);
    for part in [1.0, 0.5, 1e-3] {
        for points in [1, 2, 7, 64] {
            for shift in [0.0, 0.5] {
                let heights = profile.sample(part * length, points, shift);
                let heights = heights.unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(heights.len(), points);
                // As given, or relative to the first height.
                let inside = |level: f64| {
                    let allowed = low - level - margin..=high - level + margin;
                    heights.iter().all(|height| allowed.contains(height))
                };
                assert!(
                    inside(0.0) || inside(first),
                    "{heights:?} from {low} to {high}, the first at {first}"
                );
            }
        }
    }
    // More memory than available, and a longer line than the profile, are refused without a try.
    // Points at even distances cover half a distance more at each end.
    let points = profile.heights.len() as f64;
    let covered = length * (points / (points - 1.0));
    let refused = [
        profile.sample(length, usize::MAX / 4, 0.0),
        profile.sample(1.01 * covered + 1e-300, 2, 0.0),
    ];
    for message in refused.map(|sampled| sampled.map(|_| ()).unwrap_err()) {
        assert_message(&message.to_string());
    }
}

fn ends(values: &[f64]) -> (f64, f64) {
    let wider = |(low, high): (f64, f64), &value: &f64| (low.min(value), high.max(value));
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
}
