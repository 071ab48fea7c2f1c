//! A relaxing contact under a compliant instrument.

use super::brute_force::case;
use super::*;
use asperity_contact::motion::RelaxingBody;

/// At each moment the instrument is where its speed has brought it: D = d + F/k = v t.
#[test]
fn the_drive_moves_evenly_and_stays_in_equilibrium() {
    for number in 0..20 {
        let (body, _, motion) = case(number);
        for factor in [0.03, 1.0, 30.0] {
            let stiffness = factor * body.stiffness();
            let contact = body
                .foundation
                .builder(&body.gaps, Edges::SubCell, [body.work; 2])
                .relaxation(Relaxation::new(motion.share, motion.time).unwrap())
                .loading_speed(1.0)
                .loading_stiffness(stiffness)
                .build()
                .unwrap();
            let mut solver = RelaxingBody::new(&contact).unwrap();
            let deepest = 0.5 * body.deepest() * (1.0 + 1.0 / factor);
            let stages = [
                Move::ToDisplacement(deepest),
                Move::Hold(0.3 * deepest),
                Move::ToSeparation,
            ];
            let mut bend: f64 = 0.0;
            for (stage, target) in stages.into_iter().enumerate() {
                let record = solver.advance(target).unwrap();
                for (point, &seconds) in record.curve.iter().zip(&record.seconds) {
                    if point.springs == 0 {
                        continue;
                    }
                    bend = bend.max(point.force.abs() / stiffness);
                    let expected = match stage {
                        0 => seconds,
                        1 => deepest,
                        _ => deepest - (seconds - 1.3 * deepest),
                    };
                    let found = point.displacement(stiffness);
                    let allowed = 1e-4 * (bend + deepest);
                    assert!(
                        (found - expected).abs() < allowed,
                        "{number} {factor} {stage} {seconds}: {found} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_soft_instrument_pulls_off_at_the_force_of_a_rigid_one() {
    for stiffness in [0.5, 5.0, 50.0] {
        let sphere = Sphere {
            points: 1001,
            work: 1.0,
            share: 0.5,
            time: 1.0,
            speed: 1e-2,
            stiffness,
        };
        let stages = [Move::ToForce(20.0), Move::Hold(50.0), Move::ToSeparation];
        let cycle = sphere.contact().load(&stages).unwrap();
        let found = cycle.pull_off_force().unwrap() / (1.5 * PI) * 0.5;
        assert!((found - 1.0).abs() < 2e-3, "{stiffness}: {found}");
    }
}

#[test]
fn a_fast_loop_under_an_instrument_is_the_elastic_loop() {
    for number in 0..12 {
        let (body, _, motion) = case(number);
        let stiffness = body.stiffness();
        let builder = body
            .foundation
            .builder(&body.gaps, Edges::SubCell, [body.work; 2]);
        let builder = builder.loading_stiffness(stiffness);
        let elastic = builder.clone().build().unwrap();
        let relaxing = builder
            .relaxation(Relaxation::new(motion.share, 1e6 * body.deepest()).unwrap())
            .loading_speed(1.0)
            .build()
            .unwrap();
        let force = 0.3 * stiffness * body.deepest();
        let stages = [Move::ToForce(force), Move::ToSeparation];
        let [found, expected] = [&relaxing, &elastic].map(|contact| contact.load(&stages).unwrap());
        let [of_found, of_expected] = [&found, &expected].map(|cycle| cycle.pull_off_force());
        let difference = of_found.unwrap_or(0.0) - of_expected.unwrap_or(0.0);
        assert!(
            difference.abs() < 1e-3 * force,
            "{number}: {of_found:?} {of_expected:?}"
        );
        let [found, expected] = [&found, &expected].map(|cycle| cycle.stages()[0].end());
        assert!(
            (found - expected).abs() < 1e-4 * body.deepest(),
            "{number}: {found} {expected}"
        );
    }
}
