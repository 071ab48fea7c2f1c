//! Surfaces with known spectra, generated, cut and estimated: biases and spreads as stated in `docs/surfaces.md`.

mod command;
mod generate;

use super::readme::scenes;
use asperity::spectrum::{Analysis, End, Options, PowerLaw, analyse};
use asperity::topography::Topography;
use generate::{Profiles, Spectrum, cut, map};
use std::fmt::Write;

/// Waves of the finest resolved wavelength on the length of a surface, and points.
const LAST: f64 = 256.0;
const POINTS: usize = 512;

/// Ratio of estimates to known values: mean − 1, standard deviation, mean of the stated standard errors.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    bias: f64,
    spread: f64,
    stated: f64,
}

impl Ratio {
    fn new(ratios: &[(f64, f64)]) -> Self {
        let count = ratios.len() as f64;
        let mean = ratios.iter().map(|(ratio, _)| ratio).sum::<f64>() / count;
        let square = ratios.iter().map(|(ratio, _)| (ratio - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let stated = ratios.iter().map(|(_, error)| error).sum::<f64>() / count;
        Ratio { bias: mean - 1.0, spread: square.sqrt(), stated }
    }

    fn text(&self) -> String {
        format!("{:+.1} ± {:.1} ({:.1})", 100.0 * self.bias, 100.0 * self.spread, 100.0 * self.stated)
    }
}

/// Ratios of rms height, rms gradient and elastic energy of the equivalent line to those of the generated surface.
fn ratios(spectrum: &Spectrum, found: &[Analysis]) -> [Ratio; 3] {
    let exact = spectrum.line();
    [0, 1, 2].map(|moment| {
        let each = found.iter().map(|analysis| {
            let line = &analysis.line;
            let estimate = [line.rms_height, line.rms_gradient, line.energy_per_modulus][moment];
            (estimate.value / exact[moment], estimate.error / estimate.value)
        });
        Ratio::new(&each.collect::<Vec<_>>())
    })
}

fn estimated(surfaces: &[Topography]) -> Analysis {
    analyse(surfaces, &Options::default()).unwrap()
}

/// Kinds of surfaces with the analyses of several samples.
fn samples(spectrum: &Spectrum) -> [(&'static str, Vec<Analysis>); 3] {
    let profiles = Profiles::new(spectrum, POINTS);
    let many = |seed: u64| (0..100).map(|i| profiles.profile(1000 + 100 * seed + i)).collect::<Vec<_>>();
    [
        ("map", (0..6).map(|seed| estimated(&[map(spectrum, POINTS, seed)])).collect()),
        ("100 profiles", (0..6).map(|seed| estimated(&many(seed))).collect()),
        ("1 profile", (0..60).map(|seed| estimated(&[profiles.profile(seed)])).collect()),
    ]
}

/// Largest bias and spread of rms height, rms gradient and elastic energy.
fn bounds(kind: &str, has_roll_off: bool) -> [(f64, f64); 3] {
    match (kind, has_roll_off) {
        ("1 profile", true) => [(0.06, 0.17), (0.02, 0.07), (0.05, 0.19)],
        ("1 profile", false) => [(0.15, 0.50), (0.02, 0.09), (0.20, 0.70)],
        (_, true) => [(0.02, 0.02), (0.01, 0.01), (0.02, 0.03)],
        (_, false) => [(0.25, 0.25), (0.02, 0.03), (0.25, 0.30)],
    }
}

fn assert_fit(fit: PowerLaw, spectrum: &Spectrum, has_roll_off: bool) {
    assert!((fit.hurst.value - spectrum.hurst).abs() < 0.02, "H = {}: {fit:?}", spectrum.hurst);
    assert!(fit.hurst.error > 0.001 && fit.hurst.error < 0.02, "{fit:?}");
    let expected = std::f64::consts::TAU * spectrum.roll_off;
    match fit.roll_off {
        Some(found) if has_roll_off => assert!((found.value / expected - 1.0).abs() < 0.08, "{fit:?}"),
        found => assert!(found.is_none() && !has_roll_off, "{fit:?}"),
    }
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn the_equivalent_line_of_generated_surfaces_is_theirs() {
    let mut table = String::from(
        "| roll-off | H | measured | h, % | ⟨∇z⟩, % | e_el, % |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for roll_off in [16.0, 1.0] {
        let has_roll_off = roll_off > 1.0;
        for hurst in [0.3, 0.5, 0.8] {
            let spectrum = Spectrum { hurst, roll_off, last: LAST };
            for (kind, found) in samples(&spectrum) {
                let ratios = ratios(&spectrum, &found);
                for (ratio, (bias, spread)) in ratios.iter().zip(bounds(kind, has_roll_off)) {
                    let inside = ratio.bias.abs() <= bias && ratio.spread <= spread;
                    assert!(inside, "{kind}, H = {hurst}, roll-off {roll_off}: {ratios:?}");
                    // The stated error is neither much too small nor much too large.
                    let stated = ratio.stated / ratio.spread.max(ratio.bias.abs());
                    assert!((0.4..8.0).contains(&stated), "{kind}, H = {hurst}: {ratios:?}");
                }
                if kind != "1 profile" {
                    found.iter().for_each(|analysis| {
                        assert_fit(analysis.power_law.unwrap(), &spectrum, has_roll_off)
                    });
                }
                let roll_off = if has_roll_off { "16 per length" } else { "none" };
                let cells = ratios.map(|ratio| ratio.text()).join(" | ");
                writeln!(table, "| {roll_off} | {hurst} | {kind} | {cells} |").unwrap();
            }
        }
    }
    scenes::check("docs/surfaces.md", "biases", &table);
}

/// Mean of w⁴ of a Hann window w with a mean of w² of 1: factor by which the window reduces the independent waves.
const HANN: f64 = 35.0 / 18.0;

/// Number of independent waves that carry ∫ k^power C_cut dk of one windowed profile: the power of each wave has a standard
/// deviation as large as its mean.
fn independent_waves(spectrum: &Spectrum, power: i32) -> f64 {
    let waves = (1..=LAST as u32).map(f64::from).map(|k| k.powi(power) * cut(spectrum, k));
    let (sum, squares) = waves.fold((0.0, 0.0), |(sum, squares), wave| (sum + wave, squares + wave * wave));
    sum * sum / squares / HANN
}

/// A profile holds few waves, and no estimate can exceed their information: the spread follows from their number.
#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn the_spread_of_an_estimate_is_that_of_the_waves_in_its_profiles() {
    const SETS: u64 = 48;
    let mut table = String::from(
        "| H | quantity | independent waves | least spread, % | 1 profile, % | 4 profiles, % | 16 profiles, % |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for hurst in [0.3, 0.5, 0.8] {
        let spectrum = Spectrum { hurst, roll_off: 16.0, last: LAST };
        let profiles = Profiles::new(&spectrum, POINTS);
        let spreads = [1, 4, 16].map(|count| {
            let set = |set: u64| {
                let seeds = (0..count).map(|i| 10_000 * (count + 1) + set * count + i);
                estimated(&seeds.map(|seed| profiles.profile(seed)).collect::<Vec<_>>())
            };
            let found: Vec<Analysis> = (0..SETS).map(set).collect();
            ratios(&spectrum, &found).map(|ratio| ratio.spread)
        });
        // The relative error of a root is half as large.
        for (index, (name, power, share)) in
            [("h", 0, 0.5), ("⟨∇z⟩", 2, 0.5), ("e_el", 1, 1.0)].into_iter().enumerate()
        {
            let waves = independent_waves(&spectrum, power);
            let least = share / waves.sqrt();
            let spreads = spreads.map(|spread| spread[index]);
            for (spread, count) in spreads.iter().zip([1.0_f64, 4.0, 16.0]) {
                // 48 samples determine a standard deviation within 10 %.
                let ratio = spread * count.sqrt() / least;
                assert!((0.7..1.5).contains(&ratio), "H = {hurst}, {name}, {count} profiles: {ratio}");
            }
            let per_cent = |value: f64| format!("{:.1}", 100.0 * value);
            let cells = spreads.map(per_cent).join(" | ");
            writeln!(table, "| {hurst} | {name} | {waves:.0} | {} | {cells} |", per_cent(least)).unwrap();
        }
    }
    scenes::check("docs/surfaces.md", "profiles", &table);
}

/// Waves of a rough surface beyond the distance between points.
#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn a_spectrum_that_continues_keeps_the_gradient_of_point_samples() {
    let mut table = String::from("| H | `Ends`, % | continued, % |\n| --- | --- | --- |\n");
    for hurst in [0.3, 0.5, 0.8] {
        let spectrum = Spectrum { hurst, roll_off: 16.0, last: 4.0 * LAST };
        let profiles = Profiles::new(&spectrum, POINTS);
        let samples: Vec<Topography> = (0..60).map(|seed| profiles.profile(seed)).collect();
        let gradient = |end: End| {
            let options = Options { end, ..Options::default() };
            let found: Vec<Analysis> = samples
                .iter()
                .map(|profile| analyse(std::slice::from_ref(profile), &options).unwrap())
                .collect();
            ratios(&spectrum, &found)[1]
        };
        let ends = gradient(End::Ends);
        let continues = gradient(End::Continues(std::f64::consts::TAU * spectrum.last));
        assert!(ends.bias < -0.1 && continues.bias.abs() < 0.4 * ends.bias.abs(), "{ends:?} {continues:?}");
        writeln!(table, "| {hurst} | {} | {} |", ends.text(), continues.text()).unwrap();
    }
    scenes::check("docs/surfaces.md", "ends", &table);
}
