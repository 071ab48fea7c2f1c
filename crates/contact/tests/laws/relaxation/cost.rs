//! Cost of relaxation compared with the elastic loop. Times are printed; counts are compared with
//! bounds.

use super::*;
use asperity_contact::LoadOptions;
use asperity_contact::motion::RelaxingBody;
use std::time::Instant;

fn rough(points: usize) -> Body {
    let gaps = from_lowest(&self_affine(0.7, 5, points));
    Body::new(
        gaps,
        Edges::SubCell,
        Foundation::new(1.0 / points as f64, 1.0),
        1e-3,
    )
}

#[test]
#[ignore = "slow: prints times"]
fn times() {
    for power in [9, 11, 12, 13, 14, 15, 16] {
        let points = 1 << power;
        let body = rough(points);
        let stages = [
            Move::ToIndentation(0.3 * body.deepest()),
            Move::ToSeparation,
        ];
        let best = |run: &mut dyn FnMut()| {
            (0..5)
                .map(|_| {
                    let clock = Instant::now();
                    run();
                    clock.elapsed().as_secs_f64()
                })
                .fold(f64::INFINITY, f64::min)
                * 1e3
        };
        let elastic = best(&mut || {
            body.contact()
                .load_with(&stages, LoadOptions::default().samples(400))
                .unwrap();
        });
        let mut shown = String::new();
        let relaxing = best(&mut || {
            let contact = body
                .foundation
                .builder(&body.gaps, Edges::SubCell, [body.work; 2])
                .relaxation(Relaxation::new(0.3, 0.1).unwrap())
                .loading_speed(1.0)
                .build()
                .unwrap();
            let mut solver = RelaxingBody::new(&contact).unwrap();
            let a = solver.advance(stages[0]).unwrap();
            let patches = solver.patches().len();
            let steps_a = solver.work().steps;
            let b = solver.advance(stages[1]).unwrap();
            shown = format!(
                "patches {patches} steps {steps_a} {} points {} {}",
                solver.work().steps,
                a.curve.len(),
                b.curve.len()
            );
        });
        println!("rough 2^{power}: elastic {elastic:.2} ms relaxing {relaxing:.2} ms {shown}");
    }
    for points in [400, 1001, 4001, 16385] {
        let sphere = Sphere {
            points,
            work: 1.0,
            share: 0.3,
            time: 1.0,
            speed: 1.0,
            stiffness: f64::INFINITY,
        };
        let (gaps, spacing) = sphere.gaps();
        let body = Body::new(gaps, Edges::SubCell, Foundation::new(spacing, 1.0), 1.0);
        let stages = [Move::ToForce(5.0), Move::ToSeparation];
        let best = |run: &mut dyn FnMut()| {
            (0..9)
                .map(|_| {
                    let clock = Instant::now();
                    run();
                    clock.elapsed().as_secs_f64()
                })
                .fold(f64::INFINITY, f64::min)
                * 1e3
        };
        let elastic = best(&mut || {
            body.contact()
                .load_with(&stages, LoadOptions::default().samples(400))
                .unwrap();
        });
        let mut shown = String::new();
        let relaxing = best(&mut || {
            let contact = sphere.contact();
            let mut solver = RelaxingBody::new(&contact).unwrap();
            let a = solver.advance(stages[0]).unwrap();
            let b = solver.advance(stages[1]).unwrap();
            shown = format!(
                "steps {} points {} {}",
                solver.work().steps,
                a.curve.len(),
                b.curve.len()
            );
        });
        println!("sphere {points}: elastic {elastic:.2} ms relaxing {relaxing:.2} ms {shown}");
    }
}

/// Number of computed steps of a loop.
fn steps(contact: &Contact, stages: &[Move]) -> u64 {
    let mut solver = RelaxingBody::new(contact).unwrap();
    for &stage in stages {
        solver.advance(stage).unwrap();
    }
    solver.work().steps
}

#[test]
fn a_sphere_takes_a_few_hundred_steps_whatever_its_springs() {
    let stages = [Move::ToForce(5.0), Move::ToSeparation];
    for points in [400, 4001] {
        for [stiffness, most] in [[f64::INFINITY, 450.0], [5.0, 3000.0]] {
            let sphere = Sphere {
                points,
                work: 1.0,
                share: 0.3,
                time: 1.0,
                speed: 1.0,
                stiffness,
            };
            let steps = steps(&sphere.contact(), &stages);
            assert!(steps as f64 <= most, "{points} {stiffness}: {steps}");
        }
    }
}

#[test]
fn the_steps_of_a_rough_line_do_not_grow_with_its_springs() {
    for power in [10, 12, 14] {
        let body = rough(1 << power);
        let contact = body
            .foundation
            .builder(&body.gaps, Edges::SubCell, [body.work; 2])
            .relaxation(Relaxation::new(0.3, 0.1).unwrap())
            .loading_speed(1.0)
            .build()
            .unwrap();
        let stages = [
            Move::ToIndentation(0.3 * body.deepest()),
            Move::ToSeparation,
        ];
        let steps = steps(&contact, &stages);
        assert!(steps <= 2500, "2^{power}: {steps}");
    }
}
