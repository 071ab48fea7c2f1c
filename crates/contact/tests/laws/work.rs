//! No more than requested: points of a curve, memory of a stage, and counted work.

use super::*;
use asperity_contact::{Modulus, Profile};

proptest! {
    #![proptest_config(cases(200))]

    /// The points of a curve divide the stage evenly; an extreme of the force between them is
    /// added.
    #[test]
    fn curves_have_the_requested_samples(
        body in bodies(200), deep in 0.1..1.2_f64, back in 0.0..0.9_f64, samples in 2_usize..80,
    ) {
        for mut solver in [body.on(samples), body.bare(samples)] {
            solver.advance(Move::ToIndentation(deep)).unwrap();
            for to in [back * deep, deep] {
                let record = solver.advance(Move::ToIndentation(to)).unwrap();
                prop_assert!(record.curve.len() >= samples && record.curve.len() <= samples + 1);
                let step = (record.end() - record.start()) / (samples - 1) as f64;
                for wanted in (0..samples).map(|k| record.start() + step * k as f64) {
                    let is_near = |point: &CurvePoint| (point.indentation - wanted).abs() <= 8.0 * f64::EPSILON;
                    prop_assert!(record.curve.iter().any(is_near), "{} of {}", wanted, samples);
                }
            }
        }
    }

    /// F_a(d=0) takes one pass for each protocol, wherever the body is, and evaluates the rule of
    /// Hess for the springs that touch and those that these attach.
    #[test]
    fn adhesion_without_preload_takes_one_pass_for_each_turn(body in bodies(200), deep in 0.1..1.2_f64) {
        prop_assume!(body.work > 0.0);
        let mut solver = body.on(2);
        solver.advance(Move::ToIndentation(deep)).unwrap();
        let (here, before) = (solver.point(), solver.work());
        let forces = solver.adhesion_without_preload().unwrap();
        let work = solver.work();
        prop_assert_eq!((work.passes_without_preload, work.unloading_passes, work.loading_passes), (2, 0, 1));
        prop_assert!(work.hess_evaluations > before.hess_evaluations && solver.point() == here);
        for (force, turn) in forces.into_iter().zip([Move::ToTouch, Move::ToZeroForce]) {
            let back = body.history(&[turn, Move::ToSeparation], 2);
            let (force, expected) = (force.unwrap(), -back.stages[1].smallest.force);
            prop_assert!((force - expected).abs() <= 1e-12 * body.force_scale(), "{} {}", force, expected);
        }
    }

    /// A node for each place inside the line after which the gap no longer rises, in the memory of
    /// another tree too.
    #[test]
    fn a_tree_has_a_node_for_each_summit_of_the_gap(gaps in lines(200)) {
        let rises = |k: usize| gaps[k + 1] > gaps[k];
        let summits = (1..gaps.len().saturating_sub(1)).filter(|&k| rises(k - 1) && !rises(k)).count();
        let nodes = |profile: &Profile| {
            let contact = Contact::builder(profile, Modulus::effective(1.0).unwrap()).work_of_adhesion(1.0);
            let mut body = contact::motion::Body::new(&contact.edges(Edges::Grid).build().unwrap(), 2);
            body.advance(Move::ToTouch).unwrap();
            body.work().tree_nodes
        };
        let [one, again] = [(); 2].map(|()| Profile::from_gaps(gaps.clone(), 0.01).unwrap());
        prop_assert_eq!(nodes(&one), summits as u64);
        again.build_tree(Edges::Grid, one.into_tree()).unwrap();
        prop_assert_eq!(nodes(&again), summits as u64);
    }
}
