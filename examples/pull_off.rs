//! Pull-off force of a sphere with waves of growing height: the decrease of adhesion with roughness.
//!
//! `cargo run --release --example pull_off`

use asperity::{Contact, Modulus, Move, ProfileBuilder};

const RADIUS: f64 = 1.0e-4; // m
const LENGTH: f64 = 1.0e-4; // m
const WORK_OF_ADHESION: f64 = 0.05; // J/m²
const POINTS: usize = 1 << 14;

fn main() -> Result<(), asperity::Error> {
    let sphere = ProfileBuilder::new(LENGTH, POINTS).sphere(RADIUS);
    // Johnson, Kendall and Roberts, N.
    let jkr = 1.5 * std::f64::consts::PI * WORK_OF_ADHESION * RADIUS;
    println!("amplitude, nm   pull-off force over (3/2)πγR");
    for amplitude in [0.0, 2.0e-8, 5.0e-8, 1.0e-7, 2.0e-7] {
        let wave = |index: usize| amplitude * (index as f64 * 0.05).cos();
        let profile = sphere.build_with((0..POINTS).map(wave).collect())?;
        let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?)
            .work_of_adhesion(WORK_OF_ADHESION)
            .build()?;
        let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
        let share = cycle.pull_off_force().unwrap_or(0.0) / jkr;
        println!("{:>13.0}   {share:.4}", 1.0e9 * amplitude);
        if amplitude == 0.0 {
            assert!((share - 1.0).abs() < 1.0e-4, "the smooth sphere is that of JKR");
        }
    }
    Ok(())
}
