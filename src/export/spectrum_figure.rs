//! Spectra over the wave number: measured, fitted, and those of the equivalent line.

use crate::draw::{Axis, AxisScale, Chart, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use crate::spectrum::{Analysis, Direction, End};
use crate::surface::EquivalentLine;
use std::f64::consts::TAU;

/// Points of a curve for each decade of wave numbers.
const PER_DECADE: f64 = 20.0;

/// Most decades of the vertical axis: powers far below the others are rounding errors.
const MOST_DECADES: f64 = 18.0;

/// Wave number, rad/m, and power spectral density, m³.
pub type SpectrumPoint = (f64, f64);

/// Spectra of one surface or line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectra {
    /// Measured spectra in bins, with their names.
    pub measured: Vec<(&'static str, Vec<SpectrumPoint>)>,
    /// Spectrum of a cut through the fitted surface.
    pub fit: Vec<SpectrumPoint>,
    /// The same spectrum for the self-affine fit, with its Hurst exponent.
    pub self_affine: Option<(f64, Vec<SpectrumPoint>)>,
    /// Intended spectrum of the equivalent line.
    pub line: Vec<SpectrumPoint>,
    /// Spectrum of the heights of the computed line, in bins.
    pub heights: Vec<SpectrumPoint>,
    /// Roll-off wave number, rad/m.
    pub roll_off: Option<f64>,
    /// Largest measured wave number, rad/m, if the spectrum of the line goes further.
    pub last_resolved: Option<f64>,
    /// Wave number beyond which waves may be artefacts of the tip, rad/m.
    pub reliability_cutoff: Option<f64>,
}

/// Name of a spectrum of a face: the first one, or the opposite one.
pub(super) fn spectrum_name(face: usize, direction: Direction) -> &'static str {
    match (face, direction) {
        (0, Direction::X) => "1D PSD along x",
        (0, Direction::Y) => "1D PSD along y",
        (0, Direction::Radial) => "q/π × 2D PSD",
        (_, Direction::X) => "opposite, 1D PSD along x",
        (_, Direction::Y) => "opposite, 1D PSD along y",
        (_, Direction::Radial) => "opposite, q/π × 2D PSD",
    }
}

/// Logarithmically spaced wave numbers, about `per_decade` in each decade.
pub(super) fn wave_numbers([low, high]: [f64; 2], per_decade: f64) -> impl Iterator<Item = f64> {
    let pieces = (per_decade * (high / low).log10()).ceil().max(1.0);
    (0..=pieces as u32).map(move |piece| (low * (high / low).powf(f64::from(piece) / pieces)).min(high))
}

/// Measured spectra of a face with their names.
fn measured(face: usize, analysis: &Analysis) -> impl Iterator<Item = (&'static str, Vec<SpectrumPoint>)> {
    analysis.spectra.iter().map(move |(direction, bins)| {
        (spectrum_name(face, *direction), bins.iter().map(|bin| (bin.wave_number, bin.power)).collect())
    })
}

impl Spectra {
    /// Spectra of measured surfaces and of their equivalent line.
    #[must_use]
    pub fn of_analysis(analysis: &Analysis) -> Self {
        let isotropic = &analysis.isotropic;
        let range = isotropic.range();
        let over = |spectrum: &dyn Fn(f64) -> f64| {
            wave_numbers(range, PER_DECADE).map(|q| (q, spectrum(q))).collect()
        };
        let fit = analysis.power_law;
        Spectra {
            measured: measured(0, analysis).collect(),
            fit: over(&|q| isotropic.cut(q)),
            self_affine: fit.map(|fit| (fit.hurst.value, over(&|q| fit.cut(q, range)))),
            line: over(&|q| isotropic.line(q)),
            heights: Vec::new(),
            roll_off: fit.and_then(|fit| fit.roll_off).map(|roll_off| roll_off.value),
            last_resolved: match analysis.end {
                End::Ends => None,
                End::Continues(_) => Some(isotropic.last_node()),
            },
            reliability_cutoff: analysis.reliability_cutoff.map(|length| TAU / length),
        }
    }

    /// Spectra of the surfaces of one or both faces: one face with its fit, both with the line of their sum.
    #[must_use]
    pub fn of_faces(faces: &[&Analysis]) -> Self {
        match faces {
            [] => return Spectra::default(),
            [face] => return Spectra::of_analysis(face),
            _ => {}
        }
        let measured = faces.iter().enumerate().flat_map(|(face, analysis)| measured(face, analysis));
        let line = EquivalentLine { faces: faces.iter().map(|face| face.isotropic.clone()).collect() };
        let line = wave_numbers(line.range(), PER_DECADE).map(|q| (q, line.power(q))).collect();
        Spectra { measured: measured.collect(), line, ..Spectra::default() }
    }

    /// Chart with logarithmic axes.
    #[must_use]
    pub fn chart(&self) -> Chart {
        let curve =
            |points: &[SpectrumPoint], stroke, sign| Shape::Curve { points: points.to_vec(), stroke, sign };
        let mut layers = Vec::new();
        for (wave_number, name, ink) in [
            (self.roll_off, "roll-off", Ink::Surface),
            (self.last_resolved, "last resolved wave", Ink::Quiet),
            (self.reliability_cutoff, "reliability cut-off", Ink::Contact),
        ] {
            layers.extend(wave_number.map(|q| Layer::new(name.into(), ink, Shape::Upright(q))));
        }
        for (number, (name, points)) in self.measured.iter().enumerate() {
            let shape = curve(points, None, Some(Sign::of_series(number)));
            layers.push(Layer::new(Label::plain(&format!("measured, {name}")), Ink::Series(number), shape));
        }
        let mut line = |name: Label, ink, points: &[SpectrumPoint], stroke| {
            if !points.is_empty() {
                layers.push(Layer::new(name, ink, curve(points, Some(stroke), None)));
            }
        };
        line("fit".into(), Ink::Text, &self.fit, Stroke::Solid);
        if let Some((hurst, points)) = &self.self_affine {
            let name = Label::plain("self-affine fit, ").join(&Label::symbol("H"));
            line(name.then(&format!(" = {hurst:.2}")), Ink::Text, points, Stroke::Dotted);
        }
        line("line".into(), Ink::Loading, &self.line, Stroke::Solid);
        if !self.heights.is_empty() {
            let shape = curve(&self.heights, None, Some(Sign::Cross));
            layers.push(Layer::new("heights of the line".into(), Ink::Manual, shape));
        }
        // Besides the waves of the line, heights contain only rounding errors.
        let without_heights = Spectra { heights: Vec::new(), ..self.clone() };
        let shown = if without_heights.points().next().is_some() { &without_heights } else { self };
        let powers: Vec<f64> = shown.points().map(|(_, power)| power).collect();
        let x = Span::around(self.points().map(|(q, _)| q.log10()), 0.03);
        let y = Span::of_values(AxisScale::Logarithmic, powers.into_iter(), MOST_DECADES).widened(0.04);
        let axis = |span, name, symbol, unit| Axis::new(AxisScale::Logarithmic, span, name, symbol, unit);
        Chart::new(axis(x, "wave number", "q", "rad/m"), axis(y, "power spectral density", "C", "m³"), layers)
    }

    /// Figure of the chart.
    #[must_use]
    pub fn figure(&self, title: &str) -> Figure {
        Figure::of_chart(title, self.chart())
    }

    /// Points of all spectra.
    fn points(&self) -> impl Iterator<Item = SpectrumPoint> {
        let measured = self.measured.iter().flat_map(|(_, points)| points);
        measured.chain(&self.fit).chain(&self.line).chain(&self.heights).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Estimate, Options, PowerLaw, analyse};
    use crate::topography::{ReadOptions, parse};

    fn analysis(end: End) -> Analysis {
        let height = |i: u32| (1..60).map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k)).sum::<f64>();
        let rows: String = (0..256).map(|i| format!("{i} {}\n", height(i))).collect();
        let surface = parse(format!("x [um] z [nm]\n{rows}").as_bytes(), &ReadOptions::default()).unwrap();
        analyse(&[surface], &Options { end, tip_radius: Some(1e-3), ..Options::default() }).unwrap()
    }

    #[test]
    fn a_chart_names_all_that_it_shows() {
        let mut analysis = analysis(End::Continues(1e7));
        let half = Estimate { value: 0.5, error: 0.1 };
        let level = Estimate { value: analysis.isotropic.c2d(1e5), error: 0.0 };
        analysis.power_law = Some(PowerLaw { hurst: half, roll_off: None, level });
        let spectra = Spectra { heights: vec![(1e5, 1e-22)], ..Spectra::of_analysis(&analysis) };
        let figure = spectra.figure("a & b");
        let legend: Vec<String> = figure.legend().iter().map(|entry| entry.name.to_string()).collect();
        for name in [
            "measured, 1D PSD along x",
            "fit",
            "self-affine fit, H = 0.50",
            "line",
            "heights of the line",
            "last resolved wave",
        ] {
            assert!(legend.iter().any(|entry| entry == name), "{name}: {legend:?}");
        }
        assert_eq!(legend.contains(&"reliability cut-off".to_owned()), analysis.reliability_cutoff.is_some());
        let svg = figure.svg();
        assert!(svg.contains("a &amp; b") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        let empty = Spectra::default().figure("").svg();
        assert!(!empty.contains("NaN") && !empty.contains("inf"), "{empty}");
    }

    #[test]
    fn the_fit_goes_through_the_measured_powers() {
        let analysis = analysis(End::Ends);
        let spectra = Spectra::of_analysis(&analysis);
        // At the largest likelihood the mean over the waves of powers over their means is 1; wave 1 is not fitted.
        let bins = &analysis.spectra[0].1[2..];
        let fit = |q: f64| analysis.isotropic.cut(q);
        let sum: f64 = bins.iter().map(|bin| bin.waves as f64 * bin.power / fit(bin.wave_number)).sum();
        let waves: u64 = bins.iter().map(|bin| bin.waves).sum();
        assert!((0.8..1.25).contains(&(sum / waves as f64)), "{}", sum / waves as f64);
        assert!(spectra.fit.iter().all(|(q, power)| *power == fit(*q)));
        assert!(spectra.last_resolved.is_none());
    }
}
