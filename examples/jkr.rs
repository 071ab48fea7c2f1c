//! A sphere against the closed form of Johnson, Kendall and Roberts: the pull-off force, and the
//! force at equal contact radius.
//!
//! `cargo run --release --example jkr`

use asperity::contact::ClosedForm;
use asperity::contact::Direction;
use asperity::{Contact, Modulus, Move, ProfileBuilder};

fn main() -> Result<(), asperity::Error> {
    let (radius, work, modulus) = (1.0e-4, 0.05, Modulus::effective(1.0e6)?); // m, J/m², Pa
    let exact = ClosedForm::sphere(radius, modulus, work);
    println!("springs   error of the pull-off force   largest error of the force");
    for points in [256, 1024, 4096, 16384] {
        let profile = ProfileBuilder::new(1.0e-4, points).sphere(radius).build()?;
        let contact = Contact::builder(&profile, modulus)
            .work_of_adhesion(work)
            .build()?;
        let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
        let pull_off = -exact.force_controlled_pull_off().1;
        let error = cycle
            .pull_off_force()
            .map_or(f64::NAN, |force| (force / pull_off - 1.0).abs());
        let unloading = cycle
            .stages()
            .iter()
            .filter(|stage| stage.direction == Direction::Unloading);
        let points_in_contact = unloading
            .flat_map(|stage| &stage.curve)
            .filter(|at| at.contact_length > 0.0);
        let of_force =
            points_in_contact.map(|at| (at.force - exact.force(0.5 * at.contact_length)).abs());
        let largest = of_force.fold(0.0, f64::max) / pull_off;
        println!("{points:>7} {error:>29.1e} {largest:>28.1e}");
        assert!(error < 1.0e-3 && largest < 1.0 / points as f64);
    }
    Ok(())
}
