//! A parameter study in memory: the median pull-off force over the Hurst exponent, 16 random
//! profiles of each, on all cores.
//!
//! `cargo run --release --example hurst_study`

use asperity::data::Control;
use asperity::scene::open;
use asperity::study::{Plan, Quantity, compute};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = open("pressure-sensitive")?.set("numerics.points", "4096")?;
    let hursts: Vec<f64> = (1..=9).map(|index| f64::from(index) / 10.0).collect();
    let plan = Plan::new(
        &scene,
        &[("roughness.hurst", &hursts)],
        16,
        &[Quantity::PullOffForce],
    )?;
    let mut report = |records: &u64| {
        if *records == plan.records_in_all() {
            eprintln!("{records} records");
        }
    };
    let results = compute(&plan, Control::default().reporting_to(&mut report))?;
    println!("H     F_a: lower quartile, median, upper quartile, µN");
    for (cell, hurst) in (0..).zip(&hursts) {
        let force = results
            .statistics(cell, Quantity::PullOffForce)
            .ok_or("no profile pulls")?;
        let [low, median, high] = force.quartiles.map(|force| 1.0e6 * force);
        println!("{hurst:.1}   {low:>8.2} {median:>8.2} {high:>8.2}");
        assert!(force.count == 16 && 0.0 < low && low <= median && median <= high);
    }
    Ok(())
}
