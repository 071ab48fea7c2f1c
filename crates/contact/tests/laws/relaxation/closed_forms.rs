//! Bodies of revolution with closed forms.

use super::*;

const JKR: f64 = 1.5 * PI;

/// Pull-off force after a preload beyond which the pull-off does not depend on it.
fn pull_off(sphere: &Sphere, dwell: f64) -> f64 {
    let stages = [Move::ToForce(20.0), Move::Hold(dwell), Move::ToSeparation];
    let cycle = sphere.contact().load(&stages).unwrap();
    cycle.pull_off_force().unwrap()
}

#[test]
fn a_fast_loop_pulls_off_as_an_elastic_one() {
    let sphere = Sphere {
        points: 1001,
        work: 1.0,
        share: 0.5,
        time: 1e6,
        speed: 1.0,
        stiffness: f64::INFINITY,
    };
    let found = pull_off(&sphere, 0.0) / JKR;
    assert!((found - 1.0).abs() < 1e-3, "{found}");
}

#[test]
fn after_full_relaxation_the_pull_off_is_larger_by_the_ratio_of_moduli() {
    for share in [0.1, 0.3, 0.5, 0.6] {
        for speed in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let sphere = Sphere {
                points: 1001,
                work: 1.0,
                share,
                time: 1.0,
                speed,
                stiffness: f64::INFINITY,
            };
            let found = pull_off(&sphere, 50.0) / JKR * (1.0 - share);
            assert!((found - 1.0).abs() < 1e-3, "{share} {speed}: {found}");
        }
    }
}

/// ∫ E(t − t′) d(d^(3/2)) from 0 to `end`, with d = `speed` t′, by small steps.
fn hereditary(sphere: &Sphere, seconds: f64, end: f64) -> f64 {
    let steps = 20_000;
    let modulus = |age: f64| 1.0 - sphere.share + sphere.share * (-age / sphere.time).exp();
    let depth = |seconds: f64| (sphere.speed * seconds).powf(1.5);
    let step = end / f64::from(steps);
    let growth = |k: i32| {
        let from = step * f64::from(k);
        modulus(seconds - from - 0.5 * step) * (depth(from + step) - depth(from))
    };
    (0..steps).map(growth).sum()
}

#[test]
fn without_adhesion_the_force_is_that_of_lee_and_radok_and_of_ting() {
    for (share, time) in [(0.3, 0.1), (0.7, 1.0), (0.9, 0.3)] {
        let sphere = Sphere {
            points: 801,
            work: 0.0,
            share,
            time,
            speed: 1.0,
            stiffness: f64::INFINITY,
        };
        let cycle = sphere
            .contact()
            .load(&[Move::ToIndentation(1.0), Move::ToSeparation])
            .unwrap();
        // The line holds x²/R, so that R = 1; F = (4/3) √R ∫ E d(d^(3/2)).
        let scale = 4.0 / 3.0;
        let [loading, unloading] = cycle.stages() else {
            panic!("two stages")
        };
        for (point, &seconds) in loading.curve.iter().zip(&loading.seconds) {
            let expected = scale * hereditary(&sphere, seconds, seconds);
            assert!(
                (point.force - expected).abs() < 1e-3,
                "{} {expected}",
                point.force
            );
        }
        let turn = 1.0;
        for (point, &seconds) in unloading.curve.iter().zip(&unloading.seconds) {
            // ∫ E(t − t′) ḋ dt′ from t₁ to t, which is zero at t₁.
            let relaxed = |age: f64| (1.0 - share) * age - share * time * (-age / time).exp_m1();
            let since = |t1: f64| relaxed(seconds - t1) - 2.0 * relaxed(seconds - turn);
            let [mut low, mut high] = [0.0, turn];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if since(middle) > 0.0 {
                    low = middle
                } else {
                    high = middle
                }
            }
            let expected = scale * hereditary(&sphere, seconds, low);
            let expected = if low == 0.0 { 0.0 } else { expected };
            assert!(
                (point.force - expected).abs() < 1.5e-3,
                "{seconds} {} {expected}",
                point.force
            );
        }
    }
}
