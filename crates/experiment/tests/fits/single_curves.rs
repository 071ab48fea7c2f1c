//! Test: the intervals of many fits hold the known values of their curves.

use crate::common::{cases, first_seed, fitted, free, measured, noise, random, truth};
use asperity_data::on_threads;
use asperity_experiment::{ExperimentError, FitResult, FittedParameter, Parameter};
use std::fmt;

/// Numbers of intervals, and of intervals that hold the truth.
#[derive(Clone, Copy, Default)]
struct Held {
    held: usize,
    all: usize,
}

impl Held {
    fn share(self) -> f64 {
        self.held as f64 / self.all as f64
    }
}

impl fmt::Display for Held {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} of {}", self.held, self.all)
    }
}

/// Even seeds give smooth spheres and odd seeds rough ones: 8 curves, or 200 with
/// `TEST_EFFORT=25`.
#[test]
#[ignore = "fits of many curves take ten seconds or more"]
fn intervals_hold_the_truth_of_most_spheres() {
    let count = cases(8, 200);
    let first = first_seed();
    let worker = || {
        move |index: u64| {
            let seed = first + index;
            let made = random(seed, 4096);
            let curve = measured(&made, seed);
            let clock = std::time::Instant::now();
            let first = fitted(&curve, &made, free(seed));
            let seconds = clock.elapsed().as_secs_f64();
            Ok::<_, ExperimentError>((made, curve, seconds, first))
        }
    };
    let fits = on_threads(
        count,
        std::thread::available_parallelism().map_or(1, usize::from),
        worker,
    )
    .unwrap();
    let mut seconds = Vec::new();
    // Of smooth and of rough spheres by parameter.
    let mut rows = [[Held::default(); Parameter::ALL.len()]; 2];
    for (seed, (made, curve, of_seed, fit)) in (first..).zip(fits) {
        seconds.push(of_seed);
        // The zero of the reading is off by the mean of the noise before contact.
        let is_first_touch = |displacement: &f64| *displacement == curve.touch;
        let before = curve.displacement.iter().position(is_first_touch).unwrap();
        let zero = -noise(&made, seed)[..before].iter().sum::<f64>() / before as f64;
        let count_held = |held: &mut Held, fit: &FitResult, one: &FittedParameter| {
            let truth = if one.parameter == Parameter::Zero {
                zero
            } else {
                truth(&made, one.parameter)
            };
            let holds = one.interval.0 <= truth && truth <= one.interval.1;
            (held.held, held.all) = (held.held + usize::from(holds), held.all + 1);
            if !holds {
                println!("{seed}: {one:?}, truth {truth:e}, misfit {:.3}", fit.misfit);
            }
        };
        for one in &fit.parameters {
            count_held(
                &mut rows[(seed % 2) as usize][one.parameter as usize],
                &fit,
                one,
            );
        }
    }
    let all = rows.map(|row| {
        let sum = |count: fn(&Held) -> usize| row.iter().map(count).sum();
        Held {
            held: sum(|one| one.held),
            all: sum(|one| one.all),
        }
    });
    let percent = |held: Held| format!("{held}, {:.1} %", 100.0 * held.share());
    let row = |parameter: &Parameter| {
        let [smooth, rough] = rows.map(|row| row[*parameter as usize]);
        format!("| {} | {smooth} | {rough} |\n", parameter.row().term)
    };
    let tried = Parameter::ALL
        .into_iter()
        .filter(|one| rows[0][*one as usize].all > 0);
    let table: String = tried.map(|one| row(&one)).collect();
    let table = format!(
        "{table}| all | {} | {} |\n",
        percent(all[0]),
        percent(all[1])
    );
    let (mean, longest) = (
        seconds.iter().sum::<f64>() / seconds.len() as f64,
        seconds.iter().copied().fold(0.0, f64::max),
    );
    println!("{table}{mean:.2} s for a fit, {longest:.2} s at most");
    let both = Held {
        held: all[0].held + all[1].held,
        all: all[0].all + all[1].all,
    };
    assert!(both.share() >= 0.93);
    let docs = include_str!("../../../../docs/experiment.md");
    assert!(count < 200 || first > 0 || docs.contains(&table));
}
