//! Bodies of revolution with closed forms.

use super::*;

const JKR: f64 = 1.5 * PI;

fn pull_off(sphere: &Sphere, dwell: f64) -> f64 {
    let stages = [Move::ToForce(3.0), Move::Hold(dwell), Move::ToSeparation];
    let cycle = sphere.contact().load(&stages).unwrap();
    cycle.pull_off_force().unwrap()
}

#[test]
fn a_fast_loop_pulls_off_as_an_elastic_one() {
    let sphere = Sphere { points: 1001, work: 1.0, share: 0.5, time: 1e6, speed: 1.0 };
    let found = pull_off(&sphere, 0.0) / JKR;
    assert!((found - 1.0).abs() < 1e-3, "{found}");
}

#[test]
fn after_full_relaxation_the_pull_off_is_larger_by_the_ratio_of_moduli() {
    for share in [0.1, 0.3, 0.5, 0.6] {
        for speed in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let sphere = Sphere { points: 1001, work: 1.0, share, time: 1.0, speed };
            let found = pull_off(&sphere, 50.0) / JKR * (1.0 - share);
            assert!((found - 1.0).abs() < 2e-3, "{share} {speed}: {found}");
        }
    }
}

#[test]
#[ignore = "debug"]
fn debug_pull_off() {
    for points in [501, 1001, 2001, 4001] {
        for tolerance in [1e-3, 1e-4] {
            for speed in [0.1, 1.0, 10.0] {
                let sphere = Sphere { points, work: 1.0, share: 0.6, time: 1.0, speed };
                let contact = sphere.contact();
                let mut body = contact::motion::RelaxingBody::new(&contact).unwrap().with_tolerance(tolerance);
                let clock = std::time::Instant::now();
                body.advance(Move::ToForce(3.0)).unwrap();
                body.advance(Move::Hold(50.0)).unwrap();
                let record = body.advance(Move::ToSeparation).unwrap();
                println!("{points} {tolerance} {speed}: {} {:?} steps {} a {}", record.smallest.force / JKR * 0.4, clock.elapsed(), body.work().steps, record.curve[0].contact_length / 2.0);
            }
        }
    }
}
