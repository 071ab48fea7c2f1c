//! Loops with relaxation, in units of the elastic loop of the same body in the same run.

use super::{EFFECTIVE_MODULUS, HURST, LENGTH, RMS_HEIGHT, Rough, seconds_since};
use asperity::contact::{Contact, LoadOptions, Modulus, Move, Profile, Relaxation};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Points of each stage of the elastic loop.
const SAMPLES: u64 = 400;
/// An odd number, so that the lowest point has a spring.
const SPHERE_SPRINGS: u32 = 401;
/// Half of the length of the profile of a sphere in m.
const HALF: f64 = 4.0e-5;
/// m
const RADIUS: f64 = 1.0e-4;
/// J/m²
const WORK: f64 = 0.05;
const SHARE: f64 = 0.3;
/// Largest ratio to the elastic loop, of a sphere and of a rough line.
const BARS: [f64; 2] = [3.0, 10.0];

/// A loop to a turning point and to separation.
struct Loop {
    name: String,
    profile: Profile,
    work: f64,
    /// Stiffness of the instrument in N/m; infinite for a rigid one.
    stiffness: f64,
    turn: Move,
    /// Relaxation time in s at a speed of 1 m/s.
    time: f64,
    bar: f64,
}

impl Loop {
    fn sphere(stiffness: f64) -> Self {
        let middle = f64::from(SPHERE_SPRINGS / 2);
        let spacing = HALF / middle;
        let gaps: Vec<f64> = (0..SPHERE_SPRINGS)
            .map(|spring| {
                let x = (f64::from(spring) - middle) * spacing;
                x * x / RADIUS
            })
            .collect();
        Loop {
            name: format!("sphere of {SPHERE_SPRINGS} springs, k = {stiffness} N/m"),
            profile: Profile::from_gaps(gaps, spacing).expect("a finite line"),
            work: WORK,
            stiffness,
            turn: Move::ToForce(1.0e-4),
            time: 1.0e-6,
            bar: BARS[0],
        }
    }

    fn rough(exponent: u32, kappa: f64) -> Self {
        let rough = Rough::new(exponent, HURST, [kappa; 2]);
        let gaps = Arc::clone(&rough.line.gaps);
        Loop {
            name: format!("rough line of 2^{exponent} springs, kappa = {kappa}"),
            profile: Profile::from_gaps(gaps, rough.line.spacing).expect("a finite line"),
            work: rough.work_of_adhesion(kappa),
            stiffness: f64::INFINITY,
            turn: Move::ToForce(0.4 * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT),
            time: RMS_HEIGHT,
            bar: BARS[1],
        }
    }

    /// Seconds of the loop, from the profile on.
    fn seconds(&self, relaxes: bool) -> f64 {
        let modulus = Modulus::effective(EFFECTIVE_MODULUS).expect("a modulus");
        // The tree is built anew for each loop.
        let gaps = self.profile.gaps().to_vec();
        let clock = Instant::now();
        let profile = Profile::from_gaps(gaps, self.profile.spacing()).expect("a finite line");
        let mut contact = Contact::builder(&profile, modulus)
            .work_of_adhesion(self.work)
            .loading_stiffness(self.stiffness);
        if relaxes {
            let relaxation = Relaxation::new(SHARE, self.time).expect("a relaxation");
            contact = contact.relaxation(relaxation).loading_speed(1.0);
        }
        let contact = contact.build().expect("a contact");
        let options = LoadOptions::default().samples(SAMPLES);
        let cycle = contact.load_with(&[self.turn, Move::ToSeparation], options);
        black_box(cycle.expect("a reachable stage"));
        seconds_since(clock)
    }

    fn print(&self, runs: usize) {
        let mut best = [f64::INFINITY; 2];
        for _ in 0..runs {
            for (relaxes, best) in [false, true].into_iter().zip(&mut best) {
                *best = best.min(self.seconds(relaxes));
            }
        }
        let [elastic, relaxing] = best;
        let ratio = relaxing / elastic;
        let holds = if ratio <= self.bar {
            "holds"
        } else {
            "does NOT hold"
        };
        println!(
            "  {:<48} {:>8.3} {:>8.3} ms  {ratio:>6.2}; the bar of {} {holds}",
            self.name,
            1e3 * elastic,
            1e3 * relaxing,
            self.bar
        );
    }
}

/// Prints the times of elastic and of relaxing loops. `largest` is the largest number of springs as
/// a power of two.
pub fn print(runs: usize, largest: u32) {
    println!("loops without and with relaxation, {SAMPLES} samples on each elastic stage");
    let mut loops = vec![
        Loop::sphere(f64::INFINITY),
        Loop::sphere(100.0),
        Loop::sphere(10.0),
    ];
    for exponent in (10..=largest.min(16)).step_by(2) {
        for kappa in [2.0, 20.0] {
            loops.push(Loop::rough(exponent, kappa));
        }
    }
    for relaxing in loops {
        relaxing.print(5 * runs);
    }
    println!();
}
