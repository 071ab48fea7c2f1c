//! The Hurst exponent lies within its error, for surfaces that points sample, for surfaces without
//! shorter waves, and for spectra that begin or end inside the scan.

use crate::effort::cases;
use crate::generate::{Map, Profile, Spectrum};
use asperity_surface::{AnalysisOptions, Topography, analyse};

const EXPONENTS: [f64; 3] = [0.3, 0.5, 0.8];

/// Wave number below all waves of a surface without a roll-off.
const NO_ROLL_OFF: f64 = 0.1;

/// A kind of surfaces with a Hurst exponent.
struct Sampled {
    name: &'static str,
    is_map: bool,
    /// Number of points of the surface for each point that is measured.
    finer: usize,
    roll_off: f64,
    /// Share of the waves that the measured points resolve above which there are no waves; 1 or
    /// more if the surface has all waves of its finer points.
    end: f64,
}

const KINDS: [Sampled; 8] = [
    Sampled::new("sampled profile", false, 4, NO_ROLL_OFF, 1.0),
    Sampled::new("profile", false, 1, NO_ROLL_OFF, 1.0),
    Sampled::new("sampled profile with a roll-off", false, 4, 30.0, 1.0),
    Sampled::new("profile that ends inside", false, 1, 30.0, 0.4),
    Sampled::new("sampled map", true, 4, NO_ROLL_OFF, 1.0),
    Sampled::new("map", true, 1, NO_ROLL_OFF, 1.0),
    Sampled::new("sampled map with a roll-off", true, 4, 8.0, 1.0),
    Sampled::new("map that ends inside", true, 1, 8.0, 0.5),
];

impl Sampled {
    const fn new(
        name: &'static str,
        is_map: bool,
        finer: usize,
        roll_off: f64,
        end: f64,
    ) -> Sampled {
        Sampled {
            name,
            is_map,
            finer,
            roll_off,
            end,
        }
    }

    fn surface(&self, hurst: f64, seed: u64) -> Topography {
        let measured = if self.is_map { 256 } else { 4096 };
        let points = self.finer * measured;
        let spectrum = Spectrum {
            hurst,
            roll_off: self.roll_off,
            last: 0.5 * self.end * points as f64,
        };
        if self.is_map {
            Map::random(points, &spectrum, seed)
                .every(self.finer)
                .whole()
        } else {
            Profile::random(points, &spectrum, seed).every(self.finer)
        }
    }
}

/// Hurst exponents that were found for surfaces of a known one.
#[derive(Default)]
struct Coverage {
    surfaces: u32,
    within: u32,
    sum: f64,
    errors: f64,
}

impl Coverage {
    fn add(&mut self, surface: Topography, hurst: f64) {
        self.surfaces += 1;
        let analysis = analyse(&[surface], &AnalysisOptions::default()).unwrap();
        let Some(fit) = analysis.power_law else {
            return;
        };
        let deviation = fit.hurst.value - hurst;
        self.within += u32::from(deviation.abs() < 2.0 * fit.hurst.error);
        self.sum += deviation;
        self.errors += fit.hurst.error;
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.surfaces)
    }
}

#[test]
fn the_exponent_of_a_few_sampled_surfaces_lies_within_its_error() {
    let mut all = Coverage::default();
    for (index, hurst) in EXPONENTS.into_iter().enumerate() {
        for kind in &KINDS[..4] {
            for seed in 0..2 {
                all.add(kind.surface(hurst, seed + 100 * index as u64), hurst);
            }
        }
        let map = Map::random(
            256,
            &Spectrum {
                hurst,
                roll_off: 0.1,
                last: 128.0,
            },
            3,
        );
        all.add(map.every(2).whole(), hurst);
    }
    // Two thirds would be expected of single standard errors.
    assert!(
        all.within + 3 >= all.surfaces,
        "{} of {}",
        all.within,
        all.surfaces
    );
    assert!(all.mean().abs() < 0.03, "{}", all.mean());
}

#[test]
#[ignore = "takes minutes; TEST_EFFORT multiplies the 4 surfaces of each of 24 kinds"]
fn the_exponent_of_sampled_surfaces_lies_within_its_error() {
    let each = u64::from(cases(4));
    let mut within = 0;
    let mut surfaces = 0;
    for (row, kind) in KINDS.iter().enumerate() {
        for (column, hurst) in EXPONENTS.into_iter().enumerate() {
            let mut coverage = Coverage::default();
            for seed in 0..each {
                let seed = seed + 1000 * (3 * row + column) as u64;
                coverage.add(kind.surface(hurst, seed), hurst);
            }
            println!(
                "{}, H = {hurst}: {} of {}, {:+.3} ± {:.3}",
                kind.name,
                coverage.within,
                coverage.surfaces,
                coverage.mean(),
                coverage.errors / f64::from(coverage.surfaces)
            );
            assert!(
                coverage.mean().abs() < 0.06,
                "{}: {}",
                kind.name,
                coverage.mean()
            );
            within += coverage.within;
            surfaces += coverage.surfaces;
        }
    }
    let share = f64::from(within) / f64::from(surfaces);
    println!("{within} of {surfaces}");
    assert!(share >= 0.93, "{within} of {surfaces}");
}

/// A large map whose spectrum ends at the last wave that its points resolve determines its exponent
/// well.
#[test]
fn a_large_map_without_shorter_waves_has_a_small_error() {
    for (hurst, roll_off) in [(0.3, 16.0), (0.8, 16.0), (0.5, NO_ROLL_OFF)] {
        let spectrum = Spectrum {
            hurst,
            roll_off,
            last: 256.0,
        };
        let surface = Map::random(512, &spectrum, 11).whole();
        let analysis = analyse(&[surface], &AnalysisOptions::default()).unwrap();
        let fit = analysis.power_law.unwrap();
        println!("H = {hurst}, roll-off {roll_off}: {fit:?}");
        assert!((fit.hurst.value - hurst).abs() < 0.02, "{fit:?}");
        assert!(fit.hurst.error < 0.02, "{fit:?}");
    }
}
