//! The engine, and the heights and statistics of lines, against arithmetic of 192 binary digits.

mod events;
mod wide;

use super::body::*;
use asperity::contact::{Move, Solver};
use asperity::surface::{MeasuredOptions, MeasuredProfile, SelfAffine, phases};
use asperity::topography::{ReadOptions, Unit};
use events::Events;
use proptest::prelude::*;
use wide::{Wide, distance, pi, rounded, wide};

proptest! {
    #![proptest_config(cases(80))]

    #[test]
    fn contact_forces_pull_off_and_losses_are_those_of_exact_events(body in whole_springs(250)) {
        prop_assume!(body.deepest() + body.largest_stretch() > 0.0);
        let mut solver = body.on(33);
        let mut events = Events::new(&body);
        let (stiffness, all) = (body.foundation.spring_stiffness(), body.stiffness());
        let within = |what: &str, found: f64, expected: &Wide, unit: f64| {
            let error = distance(found, expected) / unit;
            prop_assert!(error <= 1e-15, "{} {} is wrong by {}", what, found, error);
            Ok(())
        };
        for target in body.tour() {
            let record = solver.advance(target).unwrap();
            let moved = match target {
                Move::ToIndentation(to) => events.move_to(to),
                _ => events.separate(),
            };
            let last = end(&record);
            prop_assert_eq!((record.attached, record.detached), (moved.attached, moved.detached), "{:?}", target);
            prop_assert_eq!(last.springs as usize, events.springs(), "{:?}", target);
            let size = body.deepest() + last.indentation.abs() + body.largest_stretch();
            let separates = target == Move::ToSeparation;
            if last.springs > 0 {
                let found = indices(&solver.leg().patches(last.indentation));
                prop_assert_eq!(found, events.contact(), "{:?}", target);
                let force = events.compression() * wide(stiffness);
                let unit = rounded(&force).abs() + all * body.deepest() / 512.0;
                if unit > 0.0 {
                    within("force", last.force, &force, unit)?;
                }
            } else if let Some(at) = moved.separated_at.as_ref().filter(|_| separates) {
                prop_assert!(distance(last.indentation, at) <= 4.0 * f64::EPSILON * size, "{:?}", target);
            }
            // The smallest force is at an event, and moves with the rounding of the event.
            if let Some(smallest) = moved.smallest.filter(|_| last.springs > 0 || separates) {
                let unit = (all * size).max(f64::MIN_POSITIVE);
                within("smallest force", record.smallest.force, &(smallest * wide(stiffness)), unit)?;
            }
            if moved.rounding > 0.0 {
                let lost = moved.squares * wide(0.5 * stiffness);
                // Squares of stretches far below the gaps are in units of 2⁻⁹⁶ of those of the gaps.
                let squares = 1e-13 * body.gaps.len() as f64 * body.deepest().powi(2);
                within("loss", record.released_energy, &lost, 0.5 * stiffness * (moved.rounding + squares))?;
            } else {
                prop_assert_eq!(record.released_energy, 0.0, "{:?}", target);
            }
        }
    }
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
