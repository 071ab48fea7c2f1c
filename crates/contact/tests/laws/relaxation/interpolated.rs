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
fn force_at(record: &StageRecord, seconds: f64) -> (f64, f64) {
    let next = record.seconds.partition_point(|time| *time < seconds);
    let next = next.clamp(1, record.seconds.len() - 1);
    let [before, after] = [next - 1, next];
    let step = record.seconds[after] - record.seconds[before];
    let share = if step > 0.0 {
        ((seconds - record.seconds[before]) / step).clamp(0.0, 1.0)
    } else {
        1.0
    };
    let [low, high] = [before, after].map(|index| record.curve[index].force);
    (low + share * (high - low), (high - low).abs())
}

#[test]
fn probe() {
    let mut all = Vec::new();
    for number in 0..60 {
        let coarse = records(number, 1e-3);
        let fine = records(number, 1e-6);
        let forces = fine.iter().flat_map(|record| &record.curve);
        let scale = forces.fold(0.0_f64, |most, point| most.max(point.force.abs()));
        let mut worst = (0.0, 0, 0.0, 0.0, 0.0);
        for (stage, (coarse, fine)) in coarse.iter().zip(&fine).enumerate() {
            if fine.seconds.len() < 2 {
                continue;
            }
            let [first, last] = [fine.seconds[0], fine.seconds[fine.seconds.len() - 1]];
            for k in 0..2000 {
                let at = first + (last - first) * (f64::from(k) + 0.5) / 2000.0;
                let (expected, _) = force_at(fine, at);
                let (found, step) = force_at(coarse, at);
                let deviation = (found - expected).abs() / scale;
                if deviation > worst.0 {
                    let next = coarse.seconds.partition_point(|time| *time < at);
                    let width = (coarse.seconds[next.min(coarse.seconds.len() - 1)]
                        - coarse.seconds[next.saturating_sub(1)])
                        / (last - first);
                    worst = (
                        deviation,
                        stage,
                        (at - first) / (last - first),
                        step / scale,
                        width,
                    );
                }
            }
        }
        println!(
            "{number} {:.1e} stage {} at {:.6} step {:.1e} width {:.1e}",
            worst.0, worst.1, worst.2, worst.3, worst.4
        );
        all.push(worst.0);
    }
    all.sort_by(f64::total_cmp);
    println!(
        "median {:.1e} 90% {:.1e} max {:.1e}",
        all[30], all[54], all[59]
    );
}
