//! Test: the intervals of γ and E* hold the known values of bodies, seeds and noise that are not
//! those of the fit.

use crate::common::bodies::{Body, Specimen};
use asperity_experiment::IntervalEstimate;

/// Number of specimens of each body, and least number of their intervals that hold the truth.
const SPECIMENS: u64 = 60;
const LEAST_HELD: usize = 55;

/// Numbers of intervals that hold the truth, and sums of the errors and half-widths of logarithms.
#[derive(Default)]
struct Tally {
    held: usize,
    errors: Vec<f64>,
    half_widths: f64,
}

impl Tally {
    fn add(&mut self, found: IntervalEstimate, truth: f64) {
        self.held += usize::from(found.low <= truth && truth <= found.high);
        self.errors.push((found.value / truth).ln());
        self.half_widths += found.half_width();
    }

    fn text(&self) -> String {
        let count = self.errors.len() as f64;
        let mean = self.errors.iter().sum::<f64>() / count;
        let square = self
            .errors
            .iter()
            .map(|error| (error - mean).powi(2))
            .sum::<f64>();
        let error = (square / (count - 1.0) / count).sqrt();
        let half_width = self.half_widths / count;
        let held = self.held;
        format!("{held} of {count}, half-width {half_width:.4}, mean error {mean:+.4} ± {error:.4}")
    }
}

/// Fits specimens of a body, each with its number of curves, and asserts that nearly all intervals
/// hold the truth.
fn check(body: Body) {
    let effort = std::env::var("TEST_EFFORT")
        .ok()
        .and_then(|effort| effort.parse().ok());
    let count = effort.unwrap_or(4).clamp(4, SPECIMENS);
    let mut tallies = [Tally::default(), Tally::default()];
    for number in 0..count {
        let specimen = Specimen::new(body, number);
        let fit = specimen.fit(number, 64);
        assert!(
            fit.work.low < fit.work.value && fit.work.value < fit.work.high,
            "{:?}",
            fit.work
        );
        assert!(fit.modulus.low < fit.modulus.value && fit.modulus.value < fit.modulus.high);
        tallies[0].add(fit.work, specimen.work());
        tallies[1].add(fit.modulus, specimen.modulus());
        println!(
            "{body:?} {number}, {} curves, γ {:.4}, E* {:.0}, noise {:.4}: ln γ {:+.4} ± {:.4}, ln E* {:+.4} ± {:.4}, \
             described {}",
            specimen.curves,
            specimen.work(),
            specimen.modulus(),
            specimen.noise,
            tallies[0].errors[number as usize],
            fit.work.half_width(),
            tallies[1].errors[number as usize],
            fit.modulus.half_width(),
            fit.described,
        );
    }
    for (tally, name) in tallies.iter().zip(["γ", "E*"]) {
        println!("{body:?}, {name}: {}", tally.text());
        assert!(
            count < SPECIMENS || tally.held >= LEAST_HELD,
            "{name}: {}",
            tally.text()
        );
    }
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_cones() {
    check(Body::Cone);
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_spheres() {
    check(Body::Sphere);
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_flat_bodies() {
    check(Body::Flat);
}

/// One specimen of each body: intervals of some width hold the truth, by few profiles.
#[test]
fn both_intervals_hold_the_truth_of_three_bodies() {
    for body in [Body::Cone, Body::Sphere, Body::Flat] {
        let specimen = Specimen::new(body, 0);
        let fit = specimen.fit(0, 32);
        for (found, truth) in [
            (fit.work, specimen.work()),
            (fit.modulus, specimen.modulus()),
        ] {
            let IntervalEstimate { value, low, high } = found;
            assert!(low < truth && truth < high, "{body:?}: {found:?} {truth:e}");
            assert!(
                low < value && value < high && high / low > 1.004,
                "{body:?}: {found:?}"
            );
        }
    }
}
