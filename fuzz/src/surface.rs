//! Measured surfaces.

use super::assert_message;
use asperity::surface::{AnalysisOptions, analyse};
use asperity::surface::{ReadOptions, SurfaceError, Topography, Unit, parse};

/// Most points of an analysed surface, so that no input takes long.
const MOST_ANALYSED: usize = 128;

/// An accepted surface has finite heights at ascending positions and gives a spectrum or a reason;
/// a refusal has its place and the allowed values, for any statements of the user.
pub fn surface(bytes: &[u8]) {
    let stated = ReadOptions {
        unit: Some(Unit::METRE),
        spacing: Some(1.0e-6),
        interpolate: true,
        ..ReadOptions::default()
    };
    let unstated = ReadOptions {
        interpolate: true,
        ..ReadOptions::default()
    };
    let mut read = Vec::new();
    for options in [
        ReadOptions::default(),
        unstated,
        stated.clone(),
        ReadOptions {
            channel: Some(0),
            resample: true,
            ..stated
        },
    ] {
        match parse(bytes, &options) {
            Ok(surface) => {
                assert_surface(&surface);
                read.push(surface);
            }
            Err(error) => assert_error(&error),
        }
    }
    // Additions of the user change nothing stated by the file.
    if let [first, second, ..] = &read[..] {
        assert_eq!(
            (first.format, first.columns),
            (second.format, second.columns)
        );
    }
    if let Some(surface) = read
        .pop()
        .filter(|surface| surface.heights.len() <= MOST_ANALYSED)
    {
        assert_analysis(surface);
    }
}

fn assert_error(error: &SurfaceError) {
    let message = error.to_string();
    assert_message(&message);
    assert!(
        !matches!(error, SurfaceError::Refused { allowed, .. } if allowed.is_empty()),
        "{message}"
    );
}

fn assert_surface(surface: &Topography) {
    let heights = &surface.heights;
    assert_eq!(heights.len(), surface.columns * surface.rows());
    assert!(heights.len() >= 2 && surface.interpolated() <= heights.len());
    assert!(
        heights.iter().all(|height| height.abs() <= 1e9),
        "{heights:?}"
    );
    if let Ok(spacing) = surface.spacing() {
        assert!(
            spacing.iter().all(|one| *one > 0.0 && one.is_finite()),
            "{spacing:?}"
        );
    }
    if let Ok((positions, _)) = surface.clone().into_profile() {
        assert_eq!(positions.len(), heights.len());
        assert!(
            positions.windows(2).all(|pair| pair[0] < pair[1]),
            "{positions:?}"
        );
    }
}

fn assert_analysis(surface: Topography) {
    match analyse(
        &[surface],
        &AnalysisOptions {
            tip_radius: Some(1e-8),
            ..AnalysisOptions::default()
        },
    ) {
        Ok(analysis) => {
            let line = [
                analysis.line.rms_height,
                analysis.line.rms_gradient,
                analysis.line.energy_per_modulus,
            ];
            assert!(
                line.iter()
                    .all(|estimate| estimate.value > 0.0 && estimate.value.is_finite()),
                "{line:?}"
            );
            assert!(
                line.iter()
                    .all(|estimate| estimate.error >= 0.0 && estimate.error.is_finite()),
                "{line:?}"
            );
            assert!(
                analysis
                    .isotropic
                    .nodes()
                    .all(|node| node.wave_number > 0.0 && node.c2d >= 0.0)
            );
        }
        Err(error) => assert_message(&error.to_string()),
    }
}
