//! A minor loop: pulled back to a fifth of the preload and pressed again, a rough contact returns
//! along another branch. On each stage the work of the force is the change of the stored energy and
//! the released energy.
//!
//! `cargo run --release --example minor_loop`

use asperity::contact::CurvePoint;
use asperity::{Contact, Modulus, Move, ProfileBuilder};

fn main() -> Result<(), asperity::Error> {
    let rough = ProfileBuilder::new(1.0e-4, 1 << 14)
        .self_affine(0.7)
        .rms_height(1.0e-7)
        .modes(1, 1024);
    let modulus = Modulus::effective(1.0e6)?;
    let contact = Contact::builder(&rough.build()?, modulus)
        .work_of_adhesion(2.0e-5)
        .build()?;
    let [high, low] = [4.0e-6, 0.8e-6].map(Move::ToForce); // N
    let cycle = contact.load(&[high, low, high, low, high, Move::ToSeparation])?;
    println!(
        "stage   force at its end, µN   indentation, nm   work, fJ   stored, fJ   released, fJ"
    );
    for (index, stage) in cycle.stages().iter().enumerate() {
        let area = |ends: &[CurvePoint]| {
            0.5 * (ends[0].force + ends[1].force) * (ends[1].indentation - ends[0].indentation)
        };
        let work: f64 = stage.curve.windows(2).map(area).sum();
        let ends = [stage.curve.first(), stage.curve.last()];
        let [start, end] = ends.map(|point| point.copied().unwrap_or_default());
        let (stored, released) = (
            end.stored_energy - start.stored_energy,
            stage.released_energy,
        );
        let [force, indentation] = [1.0e6 * end.force, 1.0e9 * stage.end()];
        let [a, b, c] = [work, stored, released].map(|energy| 1.0e15 * energy);
        println!("{index:>5} {force:>22.3} {indentation:>17.2} {a:>10.3} {b:>12.3} {c:>14.3}");
        // The trapezia of a curve with jumps are the work to the width of a sample.
        assert!((work - stored - released).abs() <= 0.02 * work.abs().max(released.abs()));
    }
    println!(
        "dissipated in all: {:.3} fJ",
        1.0e15 * cycle.dissipated_energy().unwrap_or(0.0)
    );
    // The second turn follows the first: the contact remembers its turning points.
    let [first, second] = [&cycle.stages()[2], &cycle.stages()[4]];
    assert!((first.end() - second.end()).abs() <= 1.0e-12 * first.end().abs());
    Ok(())
}
