//! The solver against springs with memory by brute force, on random rough lines.

use super::springs::{Found, Motion, Springs};
use super::*;
use asperity_contact::motion::RelaxingBody;

/// Deviation that is allowed, as a share of the largest force, or of the largest indentation where
/// the force jumps.
const ALLOWED: f64 = 2e-3;

pub fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// A rough line and a motion of the case with this number, and the same line with each cell divided.
pub fn case(number: u64) -> (Body, Body, Motion) {
    let mut seed = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1;
    random(&mut seed);
    let points = 20 + (180.0 * random(&mut seed)) as usize;
    let hurst = 0.2 + 0.7 * random(&mut seed);
    let gaps = from_lowest(&self_affine(hurst, number + 77, points));
    let divided = 400_usize.div_ceil(points) | 1;
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
    let dwell = if random(&mut seed) < 0.5 { 0.0 } else { deepest * random(&mut seed) };
    (body, fine, Motion { deepest, dwell, speed, share, time })
}

fn subdivided(gaps: &[f64], parts: usize) -> Vec<f64> {
    let place = |point: usize| (point as f64 - (parts / 2) as f64) / parts as f64;
    let at = |x: f64| {
        let x = x.clamp(0.0, (gaps.len() - 1) as f64);
        let cell = (x as usize).min(gaps.len().saturating_sub(2));
        gaps[cell] + (x - cell as f64) * (gaps[cell + 1] - gaps[cell])
    };
    (0..parts * gaps.len()).map(|point| at(place(point)).max(0.0)).collect()
}

pub fn relaxing(body: &Body, motion: &Motion) -> Contact {
    body.foundation
        .builder(&body.gaps, Edges::SubCell, [body.closing_work, body.work])
        .relaxation(Relaxation::new(motion.share, motion.time).unwrap())
        .loading_speed(motion.speed)
        .build()
        .unwrap()
}

/// Largest deviation of the solver from brute force, as a share of the largest force.
fn deviation(number: u64) -> f64 {
    let (body, fine, motion) = case(number);
    let contact = relaxing(&body, &motion);
    let clock = std::time::Instant::now();
    if std::env::var("SHOW").is_ok() { println!("{number} begins N {} {motion:?} {}", body.gaps.len(), body.work); }
    let mut solver = RelaxingBody::new(&contact).unwrap();
    let stages = [
        Move::ToIndentation(motion.deepest),
        Move::Hold(motion.dwell),
        Move::ToSeparation,
    ];
    let records = stages.map(|stage| solver.advance(stage).unwrap());
    if std::env::var("SHOW").is_ok() {
        println!("{number} N {} share {:.2} time {:.3} steps {} points {:?} {:?}", body.gaps.len(), motion.share, motion.time/motion.deepest, solver.work().steps, records.each_ref().map(|r| r.curve.len()), clock.elapsed());
    }
    let clock = std::time::Instant::now();
    let mut springs = Springs::new(&fine, motion);
    let even = (0..=100).map(|k| motion.deepest * f64::from(k) / 100.0);
    let points = records[0].curve.iter().map(|point| point.indentation);
    let mut indentations: Vec<f64> = even.chain(points).collect();
    indentations.sort_by(f64::total_cmp);
    indentations.dedup();
    let pressed = springs.press(&indentations);
    if std::env::var("SHOW").is_ok() { println!("pressed {:?}", clock.elapsed()); }
    let mut times: Vec<f64> = records[1].seconds.iter().chain(&records[2].seconds).copied().collect();
    let end = times[times.len() - 1];
    let turn = motion.turn();
    times.extend((0..500).map(|k| turn + (end - turn) * f64::from(k) / 500.0));
    times.retain(|&seconds| seconds > motion.deepest / motion.speed);
    times.sort_by(f64::total_cmp);
    let mut found: Vec<Found> = pressed;
    for seconds in times {
        found.push(springs.pull(seconds));
    }
    if std::env::var("SHOW").is_ok() { println!("pulled {:?}", clock.elapsed()); }
    let scale = found.iter().map(|found| found.force.abs()).fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (stage, record) in records.iter().enumerate() {
        for (point, &seconds) in record.curve.iter().zip(&record.seconds) {
            if point.springs == 0 {
                continue;
            }
            // Within the allowed deviation of the time, the force of brute force covers a range.
            let near = |found: &&Found| (found.seconds - seconds).abs() <= ALLOWED * end;
            let place = found.partition_point(|found| found.seconds < seconds);
            let close = found[place.saturating_sub(1)..(place + 1).min(found.len())].iter();
            let forces = found.iter().filter(near).chain(close).map(|found| found.force);
            let low = forces.clone().fold(f64::INFINITY, f64::min);
            let high = forces.fold(f64::NEG_INFINITY, f64::max);
            let beyond = (low - point.force).max(point.force - high).max(0.0) / scale;
            if beyond > worst {
                worst = beyond;
                if std::env::var("SHOW").is_ok() {
                    println!("{number} stage {stage} t {seconds:.6} d {:.6} {:e} not in {low:e} {high:e} of {scale:e}", point.indentation, point.force);
                }
            }
        }
    }
    worst
}

#[test]
fn a_few_rough_lines_agree_with_brute_force() {
    let mut all = Vec::new();
    for number in (0..40).step_by(1) {
        all.push((deviation(number), number));
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("{:?}", &all[..20]);
    assert!(all[0].0 <= ALLOWED, "{:?}", all[0]);
}

