//! A minor loop: pulled half way back and pressed again, a rough contact returns along another branch and dissipates
//! energy on each turn.
//!
//! `cargo run --release --example minor_loop`

use asperity::{Contact, Material, Move, Profile, SelfAffine};

fn main() -> Result<(), asperity::Error> {
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: 1024 };
    let profile = Profile::self_affine(spectrum, 1.0e-7, 1.0e-4, 1 << 14, 1)?;
    let contact = Contact::builder(&profile, Material::effective(1.0e6)).work_of_adhesion(2.0e-5).build()?;
    let preload = 4.0e-6; // N
    let history = [
        Move::ToForce(preload),
        Move::ToForce(0.2 * preload),
        Move::ToForce(preload),
        Move::ToForce(0.2 * preload),
        Move::ToForce(preload),
        Move::ToSeparation,
    ];
    let cycle = contact.load(&history)?;
    println!("leg   force at its end, µN   indentation, nm   dissipated, fJ");
    for (index, leg) in cycle.legs().iter().enumerate() {
        let force = leg.curve.last().map_or(0.0, |end| end.force);
        let [force, indentation, energy] = [1.0e6 * force, 1.0e9 * leg.end(), 1.0e15 * leg.released_energy];
        println!("{index:>3} {force:>22.3} {indentation:>17.2} {energy:>16.3}");
    }
    println!("all: {:.3} fJ", 1.0e15 * cycle.dissipated_energy().unwrap_or(0.0));
    // The second turn follows the first: the contact remembers its turning points.
    let [first, second] = [&cycle.legs()[2], &cycle.legs()[4]];
    assert!((first.end() - second.end()).abs() <= 1.0e-12 * first.end().abs());
    Ok(())
}
