//! Charts of power spectra over the wave number: measured spectra, their fits, and spectra of
//! profiles.

use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use asperity_surface::spectra::{Along, End};
use asperity_surface::{Analysis, EquivalentLine};
use std::f64::consts::TAU;

/// Number of points of a curve per decade of wave numbers.
const PER_DECADE: f64 = 20.0;

/// Largest number of decades of the vertical axis. Smaller powers are only rounding errors.
const MOST_DECADES: f64 = 12.0;

/// Stroke of the self-affine fit. Curves with this stroke have no influence on the range of the
/// axes.
const SELF_AFFINE: Stroke = Stroke::Dotted;

/// Point of a power spectrum along one direction: wave number in rad/m, and power spectral density
/// in m³.
pub type SpectrumPoint = (f64, f64);

/// Power spectra of measured surfaces and of the random profile that replaces them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectra {
    measured: Vec<Layer>,
    /// Spectrum that the profile should have according to the scene or to the measured surfaces;
    /// empty if there is none.
    pub line: Vec<SpectrumPoint>,
    /// Spectrum computed from the heights of the profile, averaged over ranges of wave numbers;
    /// empty if it was not computed.
    pub heights: Vec<SpectrumPoint>,
}

pub(crate) fn spectrum_name(face: usize, direction: Along) -> &'static str {
    match (face, direction) {
        (0, Along::X) => "1D PSD along x",
        (0, Along::Y) => "1D PSD along y",
        (0, Along::Radial) => "q/π × 2D PSD",
        (_, Along::X) => "opposite, 1D PSD along x",
        (_, Along::Y) => "opposite, 1D PSD along y",
        (_, Along::Radial) => "opposite, q/π × 2D PSD",
    }
}

/// Returns wave numbers from the lower to the upper end of a range. Neighbouring wave numbers have
/// equal ratios, and each decade has about `per_decade` wave numbers.
pub(crate) fn wave_numbers(range: [f64; 2], per_decade: f64) -> impl Iterator<Item = f64> {
    let [low, high] = range;
    let pieces = (per_decade * (high / low).log10()).ceil().max(1.0);
    (0..=pieces as u32)
        .map(move |piece| (low * (high / low).powf(f64::from(piece) / pieces)).min(high))
}

/// Returns the points of a spectrum over a range of wave numbers.
fn curve(range: [f64; 2], spectrum: impl Fn(f64) -> f64) -> Vec<SpectrumPoint> {
    wave_numbers(range, PER_DECADE)
        .map(|q| (q, spectrum(q)))
        .collect()
}

/// Returns layers with the measured spectra of all faces (a face is the surface of one body).
fn measured_layers(faces: &[&Analysis]) -> Vec<Layer> {
    let mut layers = Vec::new();
    for (face, analysis) in faces.iter().enumerate() {
        for (direction, bins) in &analysis.spectra {
            let name = format!("measured, {}", spectrum_name(face, *direction));
            let points = bins
                .iter()
                .map(|bin| (bin.wave_number, bin.power))
                .collect();
            let number = layers.len();
            let signs = Shape::signs(points, Sign::of_series(number));
            layers.push(Layer::new(Label::plain(&name), Ink::Series(number), signs));
        }
    }
    layers
}

/// Returns vertical lines at the ends of the range of wave numbers that is used from a measured
/// spectrum.
fn limits(analysis: &Analysis) -> Vec<Layer> {
    let mut limits = Vec::new();
    if let Some(roll_off) = analysis.power_law.and_then(|fit| fit.roll_off) {
        let limit = Shape::Upright(roll_off.value);
        limits.push(Layer::new("roll-off".into(), Ink::Series(0), limit));
    }
    if matches!(analysis.end, End::Continues(_)) {
        let limit = Shape::Upright(analysis.isotropic.last_node());
        limits.push(Layer::new("last resolved wave".into(), Ink::Quiet, limit));
    }
    if let Some(wavelength) = analysis.reliability_cutoff {
        let limit = Shape::Upright(TAU / wavelength);
        limits.push(Layer::new(
            "reliability cut-off".into(),
            Ink::Series(1),
            limit,
        ));
    }
    limits
}

impl Spectra {
    /// Returns the spectra of the measured surfaces of one body, with their fits, and the spectrum
    /// of a profile that replaces these surfaces.
    fn of_analysis(analysis: &Analysis) -> Self {
        let isotropic = &analysis.isotropic;
        let range = isotropic.range();
        let mut layers = limits(analysis);
        layers.extend(measured_layers(&[analysis]));
        let fit = Shape::line(curve(range, |q| isotropic.cut(q)), Stroke::Solid);
        layers.push(Layer::new("fit".into(), Ink::Text, fit));
        if let Some(fit) = analysis.power_law {
            let hurst = fit.hurst.value;
            let name = Label::plain("self-affine fit, ")
                .join(&Label::symbol("H"))
                .then(&format!(" = {hurst:.2}"));
            let line = Shape::line(curve(range, |q| fit.cut(q, range)), SELF_AFFINE);
            layers.push(Layer::new(name, Ink::Text, line));
        }
        Spectra {
            measured: layers,
            line: curve(range, |q| isotropic.line(q)),
            heights: Vec::new(),
        }
    }

    /// Returns the spectra of one rough body or of the two bodies in contact. `faces` has an
    /// [`Analysis`] for each body. [`Self::line`] is the sum of the spectra of the bodies.
    pub fn of_faces(faces: &[&Analysis]) -> Self {
        match faces {
            [] => return Spectra::default(),
            [face] => return Spectra::of_analysis(face),
            _ => {}
        }
        let line = EquivalentLine {
            faces: faces.iter().map(|face| face.isotropic.clone()).collect(),
        };
        Spectra {
            measured: measured_layers(faces),
            line: curve(line.range(), |q| line.power(q)),
            heights: Vec::new(),
        }
    }

    /// Returns the chart of all spectra over the wave number.
    pub fn chart(&self) -> Chart {
        let mut layers = self.measured.clone();
        if !self.line.is_empty() {
            let line = Shape::line(self.line.clone(), Stroke::Solid);
            layers.push(Layer::new("profile".into(), Ink::Series(3), line));
        }
        if !self.heights.is_empty() {
            let signs = Shape::signs(self.heights.clone(), Sign::Cross);
            let name = "heights of the profile".into();
            layers.push(Layer::new(name, Ink::Series(1), signs));
        }

        let mut points = self.measured_points();
        points.extend(&self.line);
        let without_heights = points.len();
        points.extend(&self.heights);
        let x = Span::around(points.iter().map(|(q, _)| q.log10()), 0.03);
        // At wave numbers that the profile does not have, the spectrum of the heights consists of
        // rounding errors.
        if without_heights > 0 {
            points.truncate(without_heights);
        }
        let powers = points.iter().map(|(_, power)| *power);
        let y = Span::of_values(AxisScale::Logarithmic, powers, MOST_DECADES).widened(0.04);
        let scale = AxisScale::Logarithmic;
        Chart::new(
            ChartAxis::new(scale, x, "wave number", "q", "rad/m"),
            ChartAxis::new(scale, y, "power spectral density", "C", "m³"),
            layers,
        )
    }

    /// Returns the points of the measured spectra and of their fits. The self-affine fit is left
    /// out.
    fn measured_points(&self) -> Vec<SpectrumPoint> {
        let mut points = Vec::new();
        for layer in &self.measured {
            if let Shape::Curve {
                points: of_layer,
                stroke,
                ..
            } = &layer.shape
                && *stroke != Some(SELF_AFFINE)
            {
                points.extend(of_layer);
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_plot::Figure;
    use asperity_plot::judge::check_picture;
    use asperity_surface::{
        AnalysisOptions, ReadOptions, SelfAffineFit, ValueWithError, analyse, parse,
    };

    fn analysis(end: End) -> Analysis {
        let height = |i: u32| {
            (1..60)
                .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
                .sum::<f64>()
        };
        let rows: String = (0..256).map(|i| format!("{i} {}\n", height(i))).collect();
        let surface = parse(
            format!("x [um] z [nm]\n{rows}").as_bytes(),
            &ReadOptions::default(),
        )
        .unwrap();
        analyse(
            &[surface],
            &AnalysisOptions {
                end,
                tip_radius: Some(1e-3),
                ..AnalysisOptions::default()
            },
        )
        .unwrap()
    }

    #[test]
    fn a_chart_names_all_that_it_shows() {
        let mut analysis = analysis(End::Continues(1e7));
        let half = ValueWithError {
            value: 0.5,
            error: 0.1,
        };
        let level = ValueWithError {
            value: analysis.isotropic.c2d(1e5),
            error: 0.0,
        };
        analysis.power_law = Some(SelfAffineFit {
            hurst: half,
            roll_off: None,
            level,
        });
        let spectra = Spectra {
            heights: vec![(1e5, 1e-22)],
            ..Spectra::of_analysis(&analysis)
        };
        let figure = Figure::of_chart("a & b", spectra.chart());
        let legend: Vec<String> = figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        for name in [
            "measured, 1D PSD along x",
            "fit",
            "self-affine fit, H = 0.50",
            "profile",
            "heights of the profile",
            "last resolved wave",
        ] {
            assert!(
                legend.iter().any(|entry| entry == name),
                "{name}: {legend:?}"
            );
        }
        assert_eq!(
            legend.contains(&"reliability cut-off".to_owned()),
            analysis.reliability_cutoff.is_some()
        );
        check_picture(&figure.svg());
        check_picture(&Figure::of_chart("", Spectra::default().chart()).svg());
    }

    #[test]
    fn the_fit_goes_through_the_measured_powers() {
        let analysis = analysis(End::Ends);
        // At the largest likelihood, the mean over the waves of measured power divided by fitted
        // power is 1. The fit does not include wave 1.
        let bins = &analysis.spectra[0].1[2..];
        let fit = |q: f64| analysis.isotropic.cut(q);
        let sum: f64 = bins
            .iter()
            .map(|bin| bin.waves as f64 * bin.power / fit(bin.wave_number))
            .sum();
        let waves: u64 = bins.iter().map(|bin| bin.waves).sum();
        assert!(
            (0.8..1.25).contains(&(sum / waves as f64)),
            "{}",
            sum / waves as f64
        );
    }
}
