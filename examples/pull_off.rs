//! Pull-off force of a sphere with waves of growing height: the decrease of adhesion with roughness.
//!
//! `cargo run --release --example pull_off`

use asperity::{Contact, Material, Move, Profile};

const RADIUS: f64 = 1.0e-4; // m
const LENGTH: f64 = 1.0e-4; // m
const WORK_OF_ADHESION: f64 = 0.05; // J/m²
const POINTS: usize = 1 << 14;

fn main() -> Result<(), asperity::Error> {
    let smooth = Profile::sphere(RADIUS, LENGTH, POINTS)?;
    // Johnson, Kendall and Roberts, N.
    let jkr = 1.5 * std::f64::consts::PI * WORK_OF_ADHESION * RADIUS;
    println!("amplitude, nm   pull-off force over (3/2)πγR");
    for amplitude in [0.0, 2.0e-8, 5.0e-8, 1.0e-7, 2.0e-7] {
        let wave = |index: usize| amplitude * (index as f64 * 0.05).cos();
        let heights: Vec<f64> = smooth.heights().enumerate().map(|(index, z)| z + wave(index)).collect();
        let profile = Profile::from_heights(&heights, smooth.spacing())?;
        let contact = Contact::builder(&profile, Material::effective(1.0e6))
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
