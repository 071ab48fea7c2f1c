//! Edges between springs on lines of ties, chains and teeth, against the rule followed level by level.

use super::body::{Body, LENGTH, MODULUS, RMS_HEIGHT, end};
use super::level_by_level::Relaxed;
use asperity::scene::{Edges, Move};
use std::f64::consts::PI;

/// Shapes in units of the depth, rare among lines without a pattern.
fn shapes(points: usize) -> Vec<(&'static str, Vec<f64>)> {
    let of = |height: &dyn Fn(usize) -> f64| (0..points).map(height).collect::<Vec<f64>>();
    let share = |index: usize| index as f64 / points as f64;
    vec![
        ("flat", of(&|_| 0.0)),
        ("stairs up", of(&|i| (8 * i / points) as f64 / 8.0)),
        ("stairs up and down", of(&|i| ((8 * i / points) as f64 - 3.5).abs() / 3.5)),
        ("ramp", of(&share)),
        ("parabola", of(&|i| share(i).powi(2))),
        ("teeth of 2", of(&|i| (i % 2) as f64)),
        ("teeth of 3", of(&|i| (i % 3) as f64 / 2.0)),
        ("teeth of 16", of(&|i| (i % 16) as f64 / 15.0)),
        ("leaning teeth", of(&|i| 1.0 - (i % 16) as f64 / 15.0)),
        ("on a table", of(&|i| if i % 8 < 5 { 0.0 } else { 1.0 })),
        ("one needle", of(&|i| if i == points / 3 { 0.0 } else { 1.0 })),
        ("one pit", of(&|i| if i == points / 3 { 1.0 } else { 0.0 })),
    ]
}

#[test]
fn contact_on_ties_and_chains_is_that_of_the_rule() {
    let mut compared = 0;
    let mut skipped = 0;
    for points in [1, 2, 3, 48] {
        for (name, shape) in shapes(points) {
            for reach in [0.0, 1e-3, 0.03, 0.2, 0.7, 3.0] {
                let stretch: f64 = reach * RMS_HEIGHT;
                let work = stretch * stretch * MODULUS / (PI * LENGTH);
                let heights = shape.iter().map(|height| -RMS_HEIGHT * height).collect();
                let body = Body::below(heights, LENGTH, MODULUS, work);
                // With slightly more and slightly less adhesion: where these differ rounding decides.
                let relaxed =
                    |factor: f64| Relaxed::new(&body.gaps, body.foundation, work * factor, work * factor);
                let mut relaxed = [relaxed(1.0), relaxed(1.0 + 1e-11), relaxed(1.0 - 1e-11)];
                let done = body.with(Edges::SubCell, 9, |solver| {
                    for leg in body.tour() {
                        let Move::ToIndentation(to) = leg else { break };
                        let point = end(&solver.advance(leg)?);
                        relaxed.iter_mut().for_each(|one| one.move_to(to));
                        let contacts = relaxed[0].contacts();
                        if relaxed.iter().any(|one| one.contacts() != contacts) {
                            skipped += 1;
                            break;
                        }
                        let found = if point.springs > 0 { solver.leg().patches(to) } else { Vec::new() };
                        assert_eq!(found, contacts, "{name}, {points} springs, {reach}, {leg:?}");
                        let [one, more, less] = &relaxed;
                        let slack = 4.0 * (more.force() - less.force()).abs() + 1e-11 * body.force_scale();
                        assert!(
                            (point.force - one.force()).abs() <= slack,
                            "{name} {point:?} {}",
                            one.force()
                        );
                        let slack = 4.0 * (more.contact_length() - less.contact_length()).abs();
                        let length = (point.contact_length - one.contact_length()).abs();
                        assert!(length <= slack + 1e-11 * LENGTH, "{name}, {points} springs, {point:?}");
                        compared += 1;
                    }
                    Ok(())
                });
                done.unwrap();
            }
        }
    }
    println!("{compared} contacts compared, {skipped} loadings left where rounding decides");
    assert!(compared > 2000 && skipped * 20 < compared, "{compared} {skipped}");
}
