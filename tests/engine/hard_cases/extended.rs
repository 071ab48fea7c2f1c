//! The engine against 192 digits.

use super::body::{Body, end};
use super::events::Events;
use super::wide::{Wide, distance, pi, rounded, wide};
use asperity::scene::{Edges, Move};
use asperity::surface::{MeasuredOptions, MeasuredProfile, SelfAffine, phases};
use asperity::topography::{ReadOptions, Unit};

/// Moves a body through a tour by the exact solver and from event to event; returns the largest errors of
/// forces, smallest forces and losses, each in units of its conditioning, and the partial contacts seen.
fn compare(body: &Body) -> ([f64; 3], usize) {
    let mut events = Events::new(body);
    let stiffness = body.foundation.spring_stiffness();
    let all = body.gaps.len() as f64 * stiffness;
    let mut worst = [0.0_f64; 3];
    let mut partial = 0;
    let seen = body.with(Edges::Grid, 33, |solver| {
        for leg in body.tour() {
            let record = solver.advance(leg)?;
            let moved = match leg {
                Move::ToIndentation(to) => events.move_to(to),
                _ => events.separate(),
            };
            let last = end(&record);
            assert_eq!((record.attached, record.detached), (moved.attached, moved.detached), "{leg:?}");
            assert_eq!(last.springs as usize, events.springs(), "{leg:?}");
            let size = body.deepest() + last.indentation.abs() + body.largest_stretch();
            if last.springs > 0 {
                let mut touching = vec![false; body.gaps.len()];
                solver.leg().patches(last.indentation).iter().for_each(|&(a, b)| touching[a..=b].fill(true));
                assert_eq!(touching, events.contact(), "{leg:?}");
                partial += usize::from(last.fragments > 1);
                let force = events.compression() * wide(stiffness);
                let unit = rounded(&force).abs() + all * body.deepest() / 512.0;
                worst[0] = worst[0].max(distance(last.force, &force) / unit);
            } else if let Some(at) = moved.separated_at.as_ref().filter(|_| leg == Move::ToSeparation) {
                assert!(distance(last.indentation, at) <= 4.0 * f64::EPSILON * size, "{leg:?}");
            }
            // The smallest force is at an event, and moves with the rounding of the event.
            if let Some((smallest, _)) =
                moved.smallest.filter(|_| last.springs > 0 || leg == Move::ToSeparation)
            {
                let smallest = smallest * wide(stiffness);
                worst[1] = worst[1].max(distance(record.smallest.force, &smallest) / (all * size));
            }
            let lost = moved.squares * wide(0.5 * stiffness);
            if moved.rounding > 0.0 {
                let unit = 0.5 * stiffness * moved.rounding;
                worst[2] = worst[2].max(distance(record.released_energy, &lost) / unit);
            } else {
                assert_eq!(record.released_energy, 0.0, "{leg:?}");
            }
        }
        Ok(())
    });
    seen.unwrap();
    (worst, partial)
}

#[test]
fn contact_forces_pull_off_and_losses_are_those_of_exact_events() {
    let mut worst = [0.0_f64; 3];
    let mut partial = 0;
    let take = |body: &Body, what: &str, worst: &mut [f64; 3], partial: &mut usize| {
        let (errors, contacts) = compare(body);
        for (worst, error) in worst.iter_mut().zip(errors) {
            assert!(error <= 1e-15, "{what}: {errors:?}");
            *worst = worst.max(error);
        }
        *partial += contacts;
    };
    for seed in 100..132 {
        let body = Body::random(seed);
        take(&body, &format!("body {seed}"), &mut worst, &mut partial);
        let bare = Body { work: 0.0, ..body };
        take(&bare, &format!("body {seed} without adhesion"), &mut worst, &mut partial);
    }
    let spectrum = SelfAffine { hurst: 0.6, first: 1, last: 200 };
    for work in [2e-6, 2e-5] {
        let body = Body::rough(spectrum, 2, 1201, work);
        take(&body, "1201 springs", &mut worst, &mut partial);
    }
    println!("errors {worst:?}, {partial} partial contacts");
    assert!(partial > 100, "{partial}");
}

#[test]
fn heights_are_sums_of_cosines_of_192_digits() {
    for (hurst, points, first, last) in [
        (1e-300, 64, 1, 32),
        (1e-9, 97, 2, 48),
        (0.5, 100, 7, 7),
        (0.5, 64, 32, 32),
        (0.999_999, 101, 1, 50),
        (1.0_f64.next_down(), 128, 1, 64),
    ] {
        let rough = SelfAffine { hurst, first, last }.heights(3, points).unwrap();
        let amplitude = |mode: u64| (-(wide(hurst) + wide(0.5)) * wide(mode as f64).ln()).exp();
        let amplitudes: Vec<Wide> = (first..=last).map(amplitude).collect();
        let squares = amplitudes.iter().fold(wide(0.0), |sum, a| sum + a.clone() * a.clone());
        let rms = (squares / wide(2.0)).sqrt();
        let phases: Vec<Wide> = phases(3, first).take(amplitudes.len()).map(wide).collect();
        let mut worst = 0.0_f64;
        for (index, &height) in rough.iter().enumerate() {
            let mut sum = wide(0.0);
            for ((mode, amplitude), phase) in (first..).zip(&amplitudes).zip(&phases) {
                let turns = mode * (2 * index as u64 + 1) % (2 * points as u64);
                let angle = pi() * wide(turns as f64) / wide(points as f64) + phase.clone();
                sum += amplitude.clone() * angle.cos();
            }
            worst = worst.max(distance(height, &(sum / rms.clone())));
        }
        println!("H = {hurst:e}, N = {points}: {worst:.1e} rms heights");
        assert!(worst <= 1e-14, "H = {hurst:e}, N = {points}: {worst:e}");
    }
}

#[test]
fn statistics_on_an_offset_are_those_of_192_digits() {
    let points = 3000;
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: 1000 };
    let rough = spectrum.heights(9, points).unwrap();
    for offset in [0.0, 1e3, 1e9, -1e9] {
        let heights: Vec<f64> = rough.iter().map(|height| 1e-7 * (offset + height)).collect();
        let positions: Vec<f64> = (0..points).map(|index| 3.0 + 1e-7 * index as f64).collect();
        let lines = positions.iter().zip(&heights).map(|(x, z)| format!("{x:e} {z:e}\n"));
        let reading = ReadOptions { unit: Some(Unit::METRE), ..ReadOptions::default() };
        let options = MeasuredOptions { reading, ..MeasuredOptions::default() };
        let profile = MeasuredProfile::new(lines.collect::<String>().as_bytes(), &options).unwrap();
        let (mut area, mut square, mut slope) = (wide(0.0), wide(0.0), wide(0.0));
        let pieces = || positions.windows(2).zip(heights.windows(2));
        for (x, z) in pieces() {
            area += (wide(x[1]) - wide(x[0])) * (wide(z[0]) + wide(z[1])) / wide(2.0);
        }
        let length = wide(positions[points - 1]) - wide(positions[0]);
        let mean = area / length.clone();
        for (x, z) in pieces() {
            let dx = wide(x[1]) - wide(x[0]);
            let (a, b) = (wide(z[0]) - mean.clone(), wide(z[1]) - mean.clone());
            let squares = a.clone() * a.clone() + a.clone() * b.clone() + b.clone() * b.clone();
            square += dx.clone() * squares / wide(3.0);
            let rise = wide(z[1]) - wide(z[0]);
            slope += rise.clone() * rise / dx;
        }
        let amplitude = profile.amplitude().unwrap();
        let (height, gradient) = (amplitude.rms_height, amplitude.rms_gradient);
        for (found, expected) in [(height, square / length.clone()), (gradient, slope / length)] {
            let expected = expected.sqrt();
            let error = distance(found, &expected) / rounded(&expected);
            println!("offset {offset:e}: {error:.1e}");
            assert!(error <= 1e-13, "offset {offset:e}: {found:e}, error {error:e}");
        }
    }
}
