//! From the heights of an equivalent line to the pull-off force over the preload, F_a(F_n):
//! pull-off after each of several preloads, from one loading. The example `measured_map` begins
//! with measured heights, which are not an equivalent line.
//!
//! `cargo run --release --example heights`

use asperity::{Contact, Modulus, Move, Profile};

fn main() -> Result<(), asperity::Error> {
    // An equivalent line that is computed here: 64 waves of falling height on 100 µm, with 4096
    // points.
    let spacing = 1.0e-4 / 4096.0; // m
    let wave =
        |x: f64, k: u32| (f64::from(k) * x + f64::from(k * k)).cos() / f64::from(k).powf(1.1);
    let height = |x: f64| 1.0e-7 * (2..66).map(|k| wave(x, k)).sum::<f64>();
    let heights: Vec<f64> = (0..4096)
        .map(|index| height(std::f64::consts::TAU * f64::from(index) / 4096.0))
        .collect();
    let profile = Profile::from_heights(heights, spacing)?;
    let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?)
        .work_of_adhesion(3.0e-5)
        .build()?;
    let preloads = [0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0].map(|preload| 1.0e-6 * preload); // N
    let reversals = contact.reversals(&preloads.map(Move::ToForce), &[])?;
    println!("preload F_n, µN   pull-off force F_a, µN   dissipated energy, fJ");
    let mut before = 0.0;
    for (preload, reversal) in preloads.iter().zip(reversals) {
        let force = reversal.pull_off_force().unwrap_or(0.0);
        let [preload, shown] = [*preload, force].map(|force| 1.0e6 * force);
        println!(
            "{preload:>15.1} {shown:>24.4} {:>23.2}",
            1.0e15 * reversal.dissipated_energy
        );
        // A larger preload brings more of the profile into contact.
        assert!(force >= before);
        before = force;
    }
    Ok(())
}
