//! Power spectra of a computed scene: the spectra of its measured surfaces, the spectrum that its
//! profile should have, and the spectrum of the heights of its profile.

use crate::spectrum_figure::{Spectra, SpectrumPoint};
use asperity_data::{check_room, counted};
use asperity_scene::{CheckedScene, Outcome, RunError, Scene, Simulation};
use asperity_surface::lines::{Line, read_faces};
use asperity_surface::spectra::line_spectrum;
use asperity_surface::{Analysis, EquivalentLine, LineMoments};
use std::f64::consts::TAU;
use std::path::Path;

/// Number of modes per decade at which the spectrum of the profile is drawn.
const PER_DECADE: f64 = 20.0;

/// Memory of the Fourier transform in bytes per spring.
const BYTES: u64 = 40;

/// Power spectra of a rough scene, and moments such as the rms height of its random profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpectra {
    /// Spectra of the measured surfaces and of the profile.
    pub spectra: Spectra,
    /// Moments, with their errors, of random profiles with the measured spectrum; `None` if the
    /// scene has no such profiles.
    pub moments: Option<LineMoments>,
    /// Reason why a spectrum could not be computed; `None` if all spectra were computed.
    pub missing: Option<String>,
}

impl SceneSpectra {
    /// Computes the spectra of a scene. The names of its measured files are relative to the working
    /// folder.
    ///
    /// # Errors
    /// Returns an error if the profile of the scene cannot be computed.
    pub fn new(
        scene: &CheckedScene,
        outcome: &Outcome,
        simulation: &mut Simulation,
    ) -> Result<Self, RunError> {
        let (line, ..) = simulation.make_line(scene)?;
        let mut missing = None;
        let analyses = analyses(scene).unwrap_or_else(|error| {
            missing = Some(error);
            Vec::new()
        });
        let faces: Vec<&Analysis> = analyses.iter().collect();
        let equivalent = equivalent_line(&faces);
        let heights = power_of_heights(scene, line).unwrap_or_else(|error| {
            missing.get_or_insert(error);
            Vec::new()
        });
        let mut spectra = Spectra::of_faces(&faces);
        spectra.line = intended_power(scene, outcome, equivalent.as_ref());
        spectra.heights = heights;
        let moments = match equivalent {
            Some(line) if !scene.measured_as_line() => Some(line.moments()),
            _ => None,
        };
        Ok(SceneSpectra {
            spectra,
            moments,
            missing,
        })
    }
}

fn analyses(scene: &Scene) -> Result<Vec<Analysis>, String> {
    let options = scene.measured_options();
    let faces = read_faces(&scene.measured_paths(Path::new("")));
    let analyses = faces.and_then(|faces| faces.iter().map(|face| options.analyse(face)).collect());
    analyses.map_err(|error| error.to_string())
}

/// Returns the line that is equivalent to measured surfaces; `None` if there are no measured
/// surfaces.
fn equivalent_line(faces: &[&Analysis]) -> Option<EquivalentLine> {
    if faces.is_empty() {
        return None;
    }
    Some(EquivalentLine {
        faces: faces.iter().map(|face| face.isotropic.clone()).collect(),
    })
}

/// Returns the spectrum that the scene defines for its profile, at some of the modes. A mode with
/// the amplitude A has the power A²L/4.
fn intended_power(
    scene: &Scene,
    outcome: &Outcome,
    equivalent: Option<&EquivalentLine>,
) -> Vec<SpectrumPoint> {
    let Some((first, last)) = outcome.line.modes else {
        return Vec::new();
    };
    let length = outcome.line.length;
    let modes = drawn_modes(first, last);
    let mut points = Vec::with_capacity(modes.len());
    if let Some(spectrum) = scene.spectrum() {
        let amplitude = outcome.governing.amplitude;
        let height = amplitude.map_or(0.0, |amplitude| amplitude.rms_height);
        let scale = 0.25 * length * (height / spectrum.relative_rms()).powi(2);
        for mode in modes {
            let power = scale * spectrum.relative_amplitude(mode).powi(2);
            points.push((TAU * mode as f64 / length, power));
        }
    } else {
        for mode in modes {
            let wave_number = TAU * mode as f64 / length;
            let power = equivalent.map_or(0.0, |line| line.power(wave_number));
            points.push((wave_number, power));
        }
    }
    points
}

/// Returns modes between the first and the last mode of a profile, at equal distances on a
/// logarithmic axis.
fn drawn_modes(first: u64, last: u64) -> Vec<u64> {
    let mut modes = Vec::new();
    for step in 0_u32.. {
        let decades = f64::from(step) / PER_DECADE;
        let mode = (first as f64 * 10.0_f64.powf(decades)).round() as u64;
        if mode >= last {
            break;
        }
        modes.push(mode);
    }
    modes.push(last);
    modes.dedup();
    modes
}

/// Returns the spectrum of the heights of the profile without its form. If the profile consists of
/// measured heights, it is not periodic, so that its spectrum is computed in another way.
fn power_of_heights(scene: &Scene, line: &Line) -> Result<Vec<SpectrumPoint>, String> {
    if scene.roughness.is_none() || line.gaps.len() < line.points {
        return Ok(Vec::new());
    }
    if check_room(BYTES * line.points as u64).is_err() {
        let springs = counted(line.points as u64, "spring");
        return Err(format!("not enough memory for the spectrum of {springs}"));
    }
    let mut heights = Vec::with_capacity(line.points);
    for (spring, height) in line.heights().enumerate() {
        let depth = match &scene.form {
            Some(form) => form.depth_of_spring(spring, line.points, line.spacing),
            None => 0.0,
        };
        heights.push(height + depth);
    }
    let bins = line_spectrum(&heights, line.spacing, scene.measured_as_line())
        .map_err(|error| error.to_string())?;
    let points = bins.into_iter().map(|bin| (bin.wave_number, bin.power));
    Ok(points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::Document;

    fn spectra(roughness: &str, form: &str) -> SceneSpectra {
        let text = format!(
            "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4, form: {form}, roughness: {roughness}, \
             loading: [ToTouch], numerics: (points: 1024, samples: 2))"
        );
        let document = Document::parse(&text, "test").unwrap();
        let mut simulation = Simulation::default();
        let outcome = simulation
            .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        SceneSpectra::new(document.scene(), &outcome, &mut simulation).unwrap()
    }

    #[test]
    fn heights_have_the_spectrum_that_the_line_is_to_have() {
        let roughness = "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (2, 200), seed: 3)";
        for form in ["None", "Paraboloid(radius: 1.0e-4)"] {
            let found = spectra(roughness, form).spectra;
            // In the range of small wave numbers, each interval contains only one mode and has the
            // power of the spectrum at this mode.
            let single = |q: f64| {
                found
                    .line
                    .iter()
                    .find(|(at, _)| (at / q - 1.0).abs() < 1e-9)
            };
            let both: Vec<_> = found
                .heights
                .iter()
                .filter_map(|(q, power)| Some((power, single(*q)?.1)))
                .collect();
            assert!(both.len() >= 4, "{:?}", found.heights);
            assert!(
                both[..4]
                    .iter()
                    .all(|(power, expected)| (*power / expected - 1.0).abs() < 1e-6),
                "{both:?}"
            );
            let ends = [found.line[0].0, found.line[found.line.len() - 1].0];
            let modes = ends.map(|q| q * 1e-4 / TAU);
            assert!(
                (modes[0] - 2.0).abs() < 1e-9 && (modes[1] - 200.0).abs() < 1e-9,
                "{modes:?}"
            );
        }
    }

    #[test]
    fn smooth_lines_have_no_spectrum_and_files_that_are_gone_are_named() {
        let smooth = spectra("None", "Paraboloid(radius: 1.0e-4)");
        assert_eq!((smooth.spectra, smooth.missing), (Spectra::default(), None));
        let scene = Document::parse(
            "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4, roughness: Measured(file: \"none.txt\"))",
            "test",
        );
        let error = analyses(scene.unwrap().scene()).unwrap_err();
        assert!(error.contains("none.txt"), "{error}");
    }
}
