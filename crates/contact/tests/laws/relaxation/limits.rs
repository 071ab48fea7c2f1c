//! Limits in which the contact is elastic.

use super::brute_force::case;
use super::*;
use asperity_contact::{Cycle, LoadOptions};

/// Mean deviation, over the time, of the forces of a relaxing contact from those of an elastic one,
/// as a share of the largest force. Where the force jumps, the indentation may deviate by `shift`
/// in m. (The mean, because after each jump the force relaxes for a while.)
fn deviation(relaxing: &Cycle, elastic: &Contact, stages: &[Move], shift: f64) -> f64 {
    let mut scale: f64 = 0.0;
    let mut sum = 0.0;
    let mut duration = 0.0;
    for (stage, record) in relaxing.stages().iter().enumerate() {
        let mut before = record.seconds[0];
        for (point, &seconds) in record.curve.iter().zip(&record.seconds) {
            if point.springs == 0 {
                continue;
            }
            scale = scale.max(point.force.abs());
            let places: Vec<f64> = (-4..=4)
                .map(|k| point.indentation + shift * f64::from(k) / 4.0)
                .collect();
            let options = LoadOptions::default().samples(2).indentations(&places);
            let cycle = elastic.load_with(stages, options).unwrap();
            let mut forces: Vec<f64> = cycle.at(stage).iter().map(|point| point.force).collect();
            // Beyond the end of the stage the contact is lost.
            if forces.len() < places.len() {
                forces.push(if stage + 1 == stages.len() {
                    0.0
                } else {
                    point.force
                });
            }
            let low = forces.iter().copied().fold(f64::INFINITY, f64::min);
            let high = forces.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let deviation = (low - point.force).max(point.force - high).max(0.0);
            sum += deviation * (seconds - before);
            duration += seconds - before;
            before = seconds;
        }
    }
    sum / duration / scale
}

fn elastic(body: &Body, modulus: f64, works: [f64; 2]) -> Contact {
    Foundation::new(body.foundation.spacing, modulus).contact(&body.gaps, Edges::SubCell, works)
}

fn relaxing(body: &Body, share: f64, time: f64) -> Contact {
    let works = [body.work; 2];
    body.foundation
        .builder(&body.gaps, Edges::SubCell, works)
        .relaxation(Relaxation::new(share, time).unwrap())
        .loading_speed(1.0)
        .build()
        .unwrap()
}

#[test]
fn a_fast_loop_is_the_elastic_loop() {
    for number in 0..12 {
        let (body, _, motion) = case(number);
        let stages = [Move::ToIndentation(motion.deepest), Move::ToSeparation];
        let contact = elastic(&body, 1.0, [body.work; 2]);
        for ratio in [1e2, 1e4] {
            let time = ratio * body.deepest();
            let cycle = relaxing(&body, motion.share, time).load(&stages).unwrap();
            let shift = (1e-4 + 5.0 / ratio) * body.deepest();
            let found = deviation(&cycle, &contact, &stages, shift);
            println!("fast {number} {ratio}: {found:.1e}");
            assert!(found < 5e-4 + 1.0 / ratio, "{number} {ratio}: {found}");
        }
    }
}

#[test]
fn a_slow_loop_is_the_elastic_loop_of_the_relaxed_modulus_and_of_two_works() {
    for number in 0..12 {
        let (body, _, motion) = case(number);
        let share = motion.share.min(0.6);
        let remaining = 1.0 - share;
        let stages = [Move::ToIndentation(motion.deepest), Move::ToSeparation];
        let works = [body.work * remaining, body.work / remaining];
        let contact = elastic(&body, remaining, works);
        for ratio in [1e3, 1e5] {
            let time = body.deepest() / ratio;
            let cycle = relaxing(&body, share, time).load(&stages).unwrap();
            let shift = (1e-4 + 5.0 / ratio) * body.deepest();
            let found = deviation(&cycle, &contact, &stages, shift);
            println!("slow {number} {ratio}: {found:.1e}");
            assert!(found < 5e-4 + 5.0 / ratio, "{number} {ratio}: {found}");
        }
    }
}

#[test]
fn without_a_share_the_contact_is_elastic_bit_by_bit() {
    for number in 0..12 {
        let (body, _, motion) = case(number);
        let stages = [
            Move::ToIndentation(motion.deepest),
            Move::Hold(3.0),
            Move::ToSeparation,
        ];
        let without = relaxing(&body, 0.0, 1.0);
        let found = without.load(&stages).unwrap();
        let expected = elastic(&body, 1.0, [body.work; 2]).load(&stages).unwrap();
        assert!(without.relaxation().is_none());
        assert_eq!(found.curve(), expected.curve());
        let work = |contact: &Contact| {
            let mut solver = contact::motion::Body::new(contact, 64);
            load_body(&mut solver, &stages, |_, _| Ok(())).unwrap().work
        };
        let fresh = relaxing(&body, 0.0, 1.0);
        assert_eq!(work(&fresh), work(&elastic(&body, 1.0, [body.work; 2])));
        assert!(
            found
                .stages()
                .iter()
                .all(|record| record.seconds.is_empty())
        );
        assert_eq!(found.stages()[1].curve.len(), 1);
    }
}
