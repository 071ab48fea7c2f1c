//! From a measured map to the spread of the pull-off force, over random profiles and by the
//! uncertainty of the spectrum.
//!
//! `cargo run --release --example measured_map`

use asperity::study::{Quantity, Statistics};
use asperity::surface::{AnalysisOptions, EquivalentLine, Topography, analyse};
use asperity::{Contact, Modulus, Move, Profile};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In place of a measurement: a map of 128 × 128 heights with waves in many directions.
    let wave = |n: i32, x: f64, y: f64| {
        let (k, (sin, cos)) = (3.0 * 1.01_f64.powi(n), (2.4 * f64::from(n)).sin_cos());
        (k * (x * cos + y * sin) + f64::from(n * n)).cos() / k.powf(0.8)
    };
    let height = |x: f64, y: f64| 1.0e-8 * (0..280).map(|n| wave(n, x, y)).sum::<f64>();
    let place = |index: u32| {
        height(
            0.049 * f64::from(index % 128),
            0.049 * f64::from(index / 128),
        )
    };
    let heights: Vec<f64> = (0..128 * 128).map(place).collect();
    let length = 1.0e-5; // m
    let map = [Topography::from_map(&heights, 128, [length / 128.0; 2])?];
    let analysis = analyse(&map, &AnalysisOptions::default())?;
    let asperity::surface::Moment { value, error, .. } = analysis.line.rms_gradient;
    println!("rms gradient {value:.3} ± {error:.3}");
    let force = |line: &EquivalentLine, seed: u64| -> Result<f64, Box<dyn std::error::Error>> {
        let profile = Profile::from_heights(line.heights(length, 4096, seed)?, length / 4096.0)?;
        let contact = Contact::builder(&profile, Modulus::effective(1.0e7)?).work_of_adhesion(0.05);
        let cycle = contact
            .build()?
            .load(&[Move::ToForce(1.0e-6), Move::ToSeparation])?;
        Ok(cycle.pull_off_force().unwrap_or(0.0))
    };
    let (line, mut forces, mut changes) = (EquivalentLine::from(&analysis), Vec::new(), 0.0);
    for seed in 1..=16 {
        forces.push(force(&line, seed)?);
        // To first order: a small step of the spectrum, drawn from the errors of the fit.
        changes += (32.0
            * (force(&line.drawn(seed, 1.0 / 32.0), seed)? - forces[forces.len() - 1]))
            .powi(2);
    }
    let all = Statistics::of(forces, Quantity::PullOffForce.bounds()).ok_or("no profile pulls")?;
    let by_fit = 1.0e6 * (changes / 16.0_f64).sqrt();
    println!(
        "pull-off force: {}; standard deviation by the fit {by_fit:.1} µN",
        all.words("N")
    );
    assert!(all.range.0 > 0.0 && changes > 0.0);
    Ok(())
}
