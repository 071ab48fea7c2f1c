//! Pull-off force of a rough profile against the preload: the effect of pressing on adhesion.
//!
//! `cargo run --release --example adhesion_against_preload`

use asperity::{Contact, Modulus, Move, ProfileBuilder};

fn main() -> Result<(), asperity::Error> {
    let rough =
        ProfileBuilder::new(1.0e-4, 1 << 14).self_affine(0.6).rms_height(2.0e-7).modes(2, 4096).seed(7);
    let contact =
        Contact::builder(&rough.build()?, Modulus::effective(1.0e6)?).work_of_adhesion(1.0e-3).build()?;
    println!("preload, µN   pull-off force, µN");
    let mut before = 0.0;
    let preloads = [0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 6.0];
    let reversals = contact.reversals(&preloads.map(|preload| Move::ToForce(1.0e-6 * preload)), &[])?;
    for (preload, reversal) in preloads.iter().zip(reversals) {
        let pull_off = reversal.adhesion_force().unwrap_or(0.0);
        println!("{preload:>11}   {:.4}", 1.0e6 * pull_off);
        // A larger preload brings more of the profile into contact.
        assert!(pull_off >= before);
        before = pull_off;
    }
    Ok(())
}
