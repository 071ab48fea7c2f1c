//! The intervals of comparisons of specimens with known values hold these values.

use super::find::fit_ensemble;
use super::result::EnsembleOptions;
use super::specimens::{curve, document, scene};
use asperity_scene::{Adhesion, Material, Simulation};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::time::Instant;

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

#[test]
#[ignore = "comparisons of many specimens take minutes"]
fn intervals_of_ensembles_hold_the_truth() {
    let count = number("TEST_EFFORT", 2);
    let lines = number("LINES", 128);
    let most = number("CURVES", 32);
    let which = number("WHICH", 3);
    for name in ["rough-sphere", "pressure-sensitive"] {
        if std::env::var("SCENE").is_ok_and(|one| one != name) {
            continue;
        }
        let base = scene(name);
        let mut rows = vec![(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0); 4];
        for specimen in number("FIRST", 0)..number("FIRST", 0) + count {
            let mut generator = ChaCha8Rng::seed_from_u64(specimen);
            let mut between = |factor: f64| factor.powf(generator.random::<f64>() - 0.5);
            let (work, modulus) = (
                base.adhesion.unwrap().work().unwrap() * between(4.0),
                base.material.effective_modulus() * between(2.0),
            );
            let mut truth = base.clone();
            truth.adhesion = Some(Adhesion::by_work(work));
            truth.material = Material::effective(modulus);
            let mut simulation = Simulation::default();
            let curves: Vec<_> = (0..most)
                .map(|index| {
                    let seed = 1000 * (specimen + 1) + index;
                    (format!("{seed}"), curve(&mut simulation, &truth, seed, 0.01))
                })
                .collect();
            for (row, (places, is_modulus_free)) in
                [(8, false), (most as usize, false), (8, true), (most as usize, true)].into_iter().enumerate()
            {
                if which & (1 << u64::from(is_modulus_free)) == 0 {
                    continue;
                }
                let mut known = base.clone();
                if !is_modulus_free {
                    known.material = Material::effective(modulus);
                }
                let options = EnsembleOptions {
                    lines,
                    is_modulus_free,
                    height_error: None,
                    hurst_error: None,
                    jobs: number("JOBS", 2) as usize,
                };
                let clock = Instant::now();
                let fit = fit_ensemble(&curves[..places], &document(&known), &options, &|| false, &|_| ())
                    .unwrap_or_else(|error| panic!("{name} {specimen}: {error}"));
                let seconds = clock.elapsed().as_secs_f64();
                let holds = |one: super::posterior::Estimate, truth: f64| {
                    f64::from(u8::from(one.low <= truth && truth <= one.high))
                };
                let error = (fit.work.value / work).ln();
                let of = &mut rows[row];
                of.0 += holds(fit.work, work);
                of.1 += fit.work.half_width();
                of.2 += error;
                of.3 += holds(fit.modulus, modulus);
                of.4 += fit.modulus.half_width();
                of.5 += seconds;
                of.6 += f64::from(u8::from(fit.described));
                of.7 += fit.computed as f64;
                of.8 += error * error;
                {
                    println!(
                        "{name} {specimen} {places} {is_modulus_free} error {error:+.4} half {:.4} E {:+.4} half {:.4} scatter {:.2} described {} {:.1}s",
                        fit.work.half_width(),
                        (fit.modulus.value / modulus).ln(),
                        fit.modulus.half_width(),
                        fit.scatter_ratio.unwrap_or(0.0),
                        fit.described,
                        seconds
                    );
                }
                if holds(fit.work, work) == 0.0 {
                    println!(
                        "{name} {specimen} M {places} free {is_modulus_free}: {:?} truth {work:.4} E {modulus:.4e} {:?}, at end {}",
                        fit.work, fit.modulus, fit.at_end_of_table
                    );
                }
            }
        }
        let n = count as f64;
        for (row, label) in rows.iter().zip(["8 known", "M known", "8 free", "M free"]) {
            println!(
                "{name} {label}: γ {:.1} % / {:.4} / bias {:+.4} rms {:.4}; E* {:.1} % / {:.3}; {:.2} s, described {:.2}, {:.0} curves",
                100.0 * row.0 / n,
                row.1 / n,
                row.2 / n,
                (row.8 / n).sqrt(),
                100.0 * row.3 / n,
                row.4 / n,
                row.5 / n,
                row.6 / n,
                row.7 / n
            );
        }
    }
}

#[test]
#[ignore = "debug"]
fn debug_curves() {
    let name = "pressure-sensitive";
    let base = scene(name);
    for specimen in [5_u64] {
        let mut generator = ChaCha8Rng::seed_from_u64(specimen);
        let mut between = |factor: f64| factor.powf(generator.random::<f64>() - 0.5);
        let (work, modulus) = (
            base.adhesion.unwrap().work().unwrap() * between(4.0),
            base.material.effective_modulus() * between(2.0),
        );
        let mut truth = base.clone();
        truth.adhesion = Some(Adhesion::by_work(work));
        truth.material = Material::effective(modulus);
        let mut simulation = Simulation::default();
        for index in 0..32 {
            let seed = 1000 * (specimen + 1) + index;
            let one = curve(&mut simulation, &truth, seed, 0.01);
            let of = super::branches::Branches::of(&one).unwrap();
            let s = super::summary::summaries(&of, 1e-5);
            let turn = one.turns[0];
            println!("{seed} noise {:.3e} preload {:.4e} free {} of {} {} touch {:.3e} turn {turn:.4e} s {:?}", of.noise, of.preload(), of.free, of.approach.len(), of.retraction.len(), one.touch, s.map(|x| (x * 100.0).round() / 100.0));
        }
    }
}
