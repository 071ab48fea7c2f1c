//! The solver against springs with memory by brute force, on random rough lines.

use super::springs::{Found, Motion, Springs};
use super::*;
use asperity_contact::motion::RelaxingBody;

/// Deviation that is allowed, as a share of the largest force, or of the largest indentation where
/// the force jumps.
const ALLOWED: f64 = 1e-3;

/// Deviation of an energy that is allowed, as a share of the work of the loop.
const ALLOWED_OF_ENERGY: f64 = 0.01;

/// Number of springs of the brute force. With 800 springs its largest deviation of a force among
/// 200 lines is 1.2e-3 of the largest force, with 12 800 springs 3e-5.
const FINE: usize = 1600;

pub fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// A rough line and a motion of the case with this number, and the same line with each cell
/// divided.
pub fn case(number: u64) -> (Body, Body, Motion) {
    let mut seed = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1;
    random(&mut seed);
    let points = 20 + (180.0 * random(&mut seed)) as usize;
    let hurst = 0.2 + 0.7 * random(&mut seed);
    let gaps = from_lowest(&self_affine(hurst, number + 77, points));
    let divided = FINE.div_ceil(points) | 1;
    let fine = subdivided(&gaps, divided);
    let foundation = Foundation::new(1.0 / points as f64, 1.0);
    let fine_foundation = Foundation::new(1.0 / fine.len() as f64, 1.0);
    let work = 10.0_f64.powf(-4.0 + 3.5 * random(&mut seed));
    let body = Body::new(gaps, Edges::SubCell, foundation, work);
    let fine = Body::new(fine, Edges::SubCell, fine_foundation, work);
    let deepest = body.deepest() * (0.1 + 0.8 * random(&mut seed));
    let speed = 1.0;
    let share = 0.05 + 0.75 * random(&mut seed);
    let time = deepest * 10.0_f64.powf(-2.0 + 4.0 * random(&mut seed));
    let dwell = if random(&mut seed) < 0.5 {
        0.0
    } else {
        deepest * random(&mut seed)
    };
    (
        body,
        fine,
        Motion {
            deepest,
            dwell,
            speed,
            share,
            time,
        },
    )
}

fn subdivided(gaps: &[f64], parts: usize) -> Vec<f64> {
    let place = |point: usize| (point as f64 - (parts / 2) as f64) / parts as f64;
    let at = |x: f64| {
        let x = x.clamp(0.0, (gaps.len() - 1) as f64);
        let cell = (x as usize).min(gaps.len().saturating_sub(2));
        gaps[cell] + (x - cell as f64) * (gaps[cell + 1] - gaps[cell])
    };
    (0..parts * gaps.len())
        .map(|point| at(place(point)).max(0.0))
        .collect()
}

pub fn relaxing(body: &Body, motion: &Motion) -> Contact {
    body.foundation
        .builder(&body.gaps, Edges::SubCell, [body.closing_work, body.work])
        .relaxation(Relaxation::new(motion.share, motion.time).unwrap())
        .loading_speed(motion.speed)
        .build()
        .unwrap()
}

/// Solver and brute force along the motion of one case.
struct Compared {
    records: [StageRecord; 3],
    found: Vec<Found>,
    springs_released: f64,
    springs_dissipated: f64,
    /// Energy that the springs gain on the approach, J.
    gained: f64,
    scale: f64,
}

fn compared(number: u64, pulls: u32, tolerance: f64) -> Compared {
    let (body, fine, motion) = case(number);
    let contact = relaxing(&body, &motion);
    let mut solver = RelaxingBody::new(&contact)
        .unwrap()
        .with_tolerance(tolerance);
    let stages = [
        Move::ToIndentation(motion.deepest),
        Move::Hold(motion.dwell),
        Move::ToSeparation,
    ];
    let records = stages.map(|stage| solver.advance(stage).unwrap());
    let mut springs = Springs::new(&fine, motion);
    let even = (0..=100).map(|k| motion.deepest * f64::from(k) / 100.0);
    let points = records[0].curve.iter().map(|point| point.indentation);
    let mut indentations: Vec<f64> = even.chain(points).collect();
    indentations.sort_by(f64::total_cmp);
    indentations.dedup();
    let mut found = springs.press(&indentations);
    let after = records[1]
        .seconds
        .iter()
        .chain(&records[2].seconds)
        .copied();
    let mut times: Vec<f64> = after.collect();
    let end = times[times.len() - 1];
    let turn = motion.turn();
    let rest = motion.deepest / motion.speed;
    let pulling = (0..pulls).map(|k| turn + (end - turn) * f64::from(k) / f64::from(pulls));
    times.extend(pulling);
    times.extend((0..100).map(|k| rest + (turn - rest) * f64::from(k) / 100.0));
    times.retain(|&seconds| seconds > rest);
    times.sort_by(f64::total_cmp);
    for seconds in times {
        springs.pull(seconds, &mut found);
    }
    // Whatever is left of the last patch.
    springs.pull(end + 1e-3 * (end - turn), &mut found);
    let scale = found
        .iter()
        .map(|found| found.force.abs())
        .fold(0.0, f64::max);
    Compared {
        records,
        springs_released: springs.released,
        springs_dissipated: springs.dissipated,
        gained: Stage::approach(&contact)
            .unwrap()
            .released_energy(-1.0, motion.deepest),
        scale,
        found,
    }
}

/// Largest deviation of the solver from brute force, as a share of the largest force.
fn deviation(compared: &Compared) -> f64 {
    let Compared { found, scale, .. } = compared;
    let end = found[found.len() - 1].seconds;
    let mut worst: f64 = 0.0;
    for record in &compared.records {
        for (point, &seconds) in record.curve.iter().zip(&record.seconds) {
            if point.springs == 0 {
                continue;
            }
            // Within the allowed deviation of the time, the force of brute force covers a range.
            let near = |found: &&Found| (found.seconds - seconds).abs() <= ALLOWED * end;
            let place = found.partition_point(|found| found.seconds < seconds);
            let close = found[place.saturating_sub(1)..(place + 1).min(found.len())].iter();
            let forces = found
                .iter()
                .filter(near)
                .chain(close)
                .map(|found| found.force);
            let low = forces.clone().fold(f64::INFINITY, f64::min);
            let high = forces.fold(f64::NEG_INFINITY, f64::max);
            let beyond = (low - point.force).max(point.force - high) / scale;
            worst = worst.max(beyond);
        }
    }
    worst
}

/// Deviation of the pull-off force, as a share of the largest force.
fn deviation_of_pull_off(compared: &Compared) -> f64 {
    let smallest = compared.records.iter().map(|record| record.smallest.force);
    let smallest = smallest.fold(f64::INFINITY, f64::min);
    let forces = compared.found.iter().map(|found| found.force);
    let expected = forces.fold(f64::INFINITY, f64::min);
    (smallest - expected).abs() / compared.scale
}

/// Deviations of the energies of dashpots and of detachment, as shares of the work of the loop.
fn energy_deviations(compared: &Compared) -> [f64; 2] {
    let of = |energy: fn(&StageRecord) -> f64| compared.records.iter().map(energy).sum::<f64>();
    let dashpots = of(|record| record.dashpot_energy);
    let released = of(|record| record.released_energy);
    let work = dashpots + released;
    [
        (dashpots - compared.springs_dissipated) / work,
        (released - compared.springs_released - compared.gained) / work,
    ]
}

fn judge(numbers: impl Iterator<Item = u64>) {
    for number in numbers {
        let compared = compared(number, 500, 1e-3);
        let deviation = deviation(&compared);
        let energies = energy_deviations(&compared);
        let [dashpots, released] = energies;
        let pull_off = deviation_of_pull_off(&compared);
        println!("case {number}: {deviation:.1e} {pull_off:.1e} {dashpots:.1e} {released:.1e}");
        assert!(deviation <= ALLOWED, "case {number}: {deviation}");
        assert!(pull_off <= ALLOWED, "case {number}: {pull_off}");
        let is_balanced = energies
            .iter()
            .all(|energy| energy.abs() <= ALLOWED_OF_ENERGY);
        assert!(is_balanced, "case {number}: {energies:?}");
    }
}

#[test]
fn a_few_rough_lines_agree_with_brute_force() {
    judge((0..40).step_by(16));
}

/// Twenty of the 200 lines, times `TEST_EFFORT`; all of them with 10.
#[test]
#[ignore = "slow: lines by brute force, a minute for all"]
fn two_hundred_rough_lines_agree_with_brute_force() {
    let lines = crate::effort::cases(20).min(200) as usize;
    judge((0..200).step_by(200 / lines));
}
