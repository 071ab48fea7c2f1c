//! Forces between the points of a record.

use super::brute_force::{case, relaxing};
use super::*;
use asperity_contact::motion::RelaxingBody;

fn records(number: u64, tolerance: f64) -> [StageRecord; 3] {
    let (body, _, motion) = case(number);
    let contact = relaxing(&body, &motion);
    let mut solver = RelaxingBody::new(&contact)
        .unwrap()
        .with_tolerance(tolerance);
    [
        Move::ToIndentation(motion.deepest),
        Move::Hold(motion.dwell),
        Move::ToSeparation,
    ]
    .map(|stage| solver.advance(stage).unwrap())
}

/// Force at a time by interpolation between the points of a record.
fn force_at(record: &StageRecord, seconds: f64) -> f64 {
    let next = record.seconds.partition_point(|time| *time < seconds);
    let next = next.clamp(1, record.seconds.len() - 1);
    let [before, after] = [next - 1, next].map(|index| record.curve[index].force);
    let step = record.seconds[next] - record.seconds[next - 1];
    if step <= 0.0 {
        return after;
    }
    let share = ((seconds - record.seconds[next - 1]) / step).clamp(0.0, 1.0);
    before + share * (after - before)
}

/// Share of the duration of a stage up to which the moment of a jump may deviate.
const MOMENT: f64 = 3e-4;

/// A record has both sides of each jump, so that forces between its points deviate by no more than
/// the steps do. The reference is a record of steps that are a thousand times as accurate.
#[test]
fn forces_between_the_points_of_a_record_are_accurate_beside_jumps_too() {
    let mut worst = 0.0_f64;
    let mut jumps = 0;
    for number in 0..60 {
        let coarse = records(number, 1e-3);
        let fine = records(number, 1e-6);
        let forces = fine.iter().flat_map(|record| &record.curve);
        let scale = forces.fold(0.0_f64, |most, point| most.max(point.force.abs()));
        for (coarse, fine) in coarse.iter().zip(&fine) {
            if fine.seconds.len() < 2 {
                continue;
            }
            let first = fine.seconds[0];
            let duration = fine.seconds[fine.seconds.len() - 1] - first;
            for (index, pair) in coarse.curve.windows(2).enumerate() {
                let is_jump = (pair[1].force - pair[0].force).abs() > 0.05 * scale;
                let step = coarse.seconds[index + 1] - coarse.seconds[index];
                if is_jump && step < MOMENT * duration {
                    assert_eq!(step, 0.0, "{number}: a jump takes time");
                    jumps += 1;
                }
            }
            for k in 0..2000 {
                let seconds = first + duration * (f64::from(k) + 0.5) / 2000.0;
                let found = force_at(coarse, seconds);
                let near =
                    [-1.0, 0.0, 1.0].map(|side| force_at(fine, seconds + side * MOMENT * duration));
                let low = near.into_iter().fold(f64::INFINITY, f64::min);
                let high = near.into_iter().fold(f64::NEG_INFINITY, f64::max);
                worst = worst.max((low - found).max(found - high) / scale);
            }
        }
    }
    println!("{jumps} jumps, largest deviation {worst:.1e}");
    assert!(jumps > 20, "{jumps}");
    assert!(worst < 2e-3, "{worst}");
}

fn smallest_force(record: &StageRecord) -> f64 {
    let forces = record.curve.iter().map(|point| point.force);
    forces.fold(f64::INFINITY, f64::min)
}

/// Force at an indentation of an unloading by interpolation between the points of its record. At a
/// jump there are several forces, of which the last one is returned.
fn force_at_indentation(record: &StageRecord, indentation: f64) -> f64 {
    let below = record
        .curve
        .iter()
        .rposition(|point| point.indentation >= indentation)
        .unwrap_or(0);
    let points = &record.curve[below..(below + 2).min(record.curve.len())];
    let [from, to] = [points[0], points[points.len() - 1]];
    let way = to.indentation - from.indentation;
    if way == 0.0 {
        return to.force;
    }
    from.force + (indentation - from.indentation) / way * (to.force - from.force)
}

/// Stages end at a jump, just before it and just after it. The next stage then continues the curve
/// of a single stage. If the force jumps past the target of a stage, the stage ends at the jump.
#[test]
fn a_stage_that_ends_at_a_jump_changes_nothing() {
    let mut ends = 0;
    let mut worst = 0.0_f64;
    for number in 0..20 {
        let (body, _, motion) = case(number);
        let contact = relaxing(&body, &motion);
        let [pressed, rested, pulled] = records(number, 1e-3);
        let forces = [&pressed, &rested, &pulled].map(|record| &record.curve);
        let forces = forces.into_iter().flatten().map(|point| point.force);
        let scale = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let whole = smallest_force(&pulled);
        let way = pulled.curve[0].indentation - pulled.curve[pulled.curve.len() - 1].indentation;
        let mut targets = Vec::new();
        for (index, pair) in pulled.curve.windows(2).enumerate() {
            let is_jump = pulled.seconds[index] == pulled.seconds[index + 1];
            if is_jump && (pair[1].force - pair[0].force).abs() > 0.05 * scale {
                for side in [-1e-2, -1e-9, 0.0, 1e-9, 1e-2] {
                    targets.push(Move::ToIndentation(pair[1].indentation + side * way));
                }
                let between = 0.5 * (pair[0].force + pair[1].force);
                // A larger force than at the beginning would be reached by pressing further.
                if between < pulled.curve[0].force {
                    targets.push(Move::ToForce(between));
                }
            }
        }
        for target in targets {
            let mut solver = RelaxingBody::new(&contact).unwrap();
            let stages = [
                Move::ToIndentation(motion.deepest),
                Move::Hold(motion.dwell),
                target,
            ];
            let mut end = None;
            for stage in stages {
                // The force may reach the target earlier, or the body may already be separated.
                match solver.advance(stage) {
                    Ok(record) => end = Some(record),
                    Err(_) => end = None,
                }
            }
            let Some(part) = end else { continue };
            let mut smallest = smallest_force(&part);
            // A body that is already farther away than its separation is not moved back.
            if let Ok(rest) = solver.advance(Move::ToSeparation) {
                smallest = smallest.min(smallest_force(&rest));
            }
            assert!(
                (smallest - whole).abs() < 2e-3 * scale,
                "{number} {target:?}: {smallest} {whole}"
            );
            let last = part.curve[part.curve.len() - 1];
            let near = [-3e-4, 0.0, 3e-4]
                .map(|side| force_at_indentation(&pulled, last.indentation + side * way));
            let low = near.into_iter().fold(f64::INFINITY, f64::min);
            let high = near.into_iter().fold(f64::NEG_INFINITY, f64::max);
            worst = worst.max((low - last.force).max(last.force - high) / scale);
            ends += 1;
        }
    }
    println!("{ends} ends, largest deviation {worst:.1e}");
    assert!(ends > 50, "{ends}");
    assert!(worst < 2e-3, "{worst}");
}

/// A motion reaches its target and takes its time, also if the body separates before. Without
/// adhesion no energy is released.
#[test]
fn targets_are_reached_also_beyond_separation() {
    for number in 0..20 {
        let (body, _, motion) = case(number);
        let adhesive = relaxing(&body, &motion);
        let smooth = Body::new(body.gaps.clone(), Edges::SubCell, body.foundation, 0.0);
        for contact in [adhesive, relaxing(&smooth, &motion)] {
            let force = {
                let mut solver = RelaxingBody::new(&contact).unwrap();
                let pressed = solver.advance(Move::ToIndentation(motion.deepest));
                0.7 * pressed.unwrap().largest.force
            };
            let mut solver = RelaxingBody::new(&contact).unwrap();
            let pressed = solver.advance(Move::ToForce(force)).unwrap();
            let end = pressed.curve[pressed.curve.len() - 1];
            // Modulus and length are 1, so that the depth is the scale of the force.
            let deviation = (end.force - force).abs();
            assert!(deviation <= 1e-10 * motion.deepest, "{number}: {end:?}");
            let target = -50.0 * motion.deepest;
            let pulled = solver.advance(Move::ToIndentation(target)).unwrap();
            let last = pulled.curve[pulled.curve.len() - 1];
            assert_eq!((last.indentation, last.springs), (target, 0), "{number}");
            let seconds = pulled.seconds[pulled.seconds.len() - 1] - pulled.seconds[0];
            let expected = (end.indentation - target) / motion.speed;
            assert!((seconds - expected).abs() < 1e-9 * expected, "{number}");
            if !contact.has_adhesion() {
                assert_eq!([pressed.released_energy, pulled.released_energy], [0.0; 2]);
            }
        }
    }
}
