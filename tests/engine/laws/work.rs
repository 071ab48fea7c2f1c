//! No more than requested: points of a curve, held memory, and counted work.

use super::*;
use asperity::contact::{Springs, Stepwise};

/// This number of flat punches of `springs` springs at one height, far apart, above springs out of reach.
fn punches(count: usize, springs: usize) -> Body {
    let punch = [vec![0.0; springs], vec![100.0; 3 * springs]].concat();
    Body { gaps: punch.repeat(count), foundation: Foundation::endless(0.01, 1.0), work: 1e-4, closing: 1.0 }
}

proptest! {
    #![proptest_config(cases(200))]

    /// The points of a curve divide the leg evenly; an extreme of the force between them is added.
    #[test]
    fn curves_have_the_samples_asked_for(
        body in body(),
        deep in 0.1..1.2_f64,
        back in 0.0..0.9_f64,
        samples in 2_usize..80,
    ) {
        let mut adhesive = body.on(samples);
        let mut bare = nonadhesive(&body.gaps, Edges::Grid, body.foundation, samples);
        let solvers: [&mut dyn Solver; 2] = [&mut adhesive, &mut bare];
        for solver in solvers {
            solver.advance(Move::ToIndentation(deep)).unwrap();
            for to in [back * deep, deep] {
                let record = solver.advance(Move::ToIndentation(to)).unwrap();
                prop_assert!(record.curve.len() >= samples && record.curve.len() <= samples + 1);
                let step = (record.end() - record.start()) / (samples - 1) as f64;
                let near = |wanted: f64| {
                    let distance = |point: &CurvePoint| (point.indentation - wanted).abs();
                    record.curve.iter().map(distance).fold(f64::INFINITY, f64::min)
                };
                for k in 0..samples {
                    prop_assert!(near(record.start() + step * k as f64) <= 8.0 * f64::EPSILON, "{} of {}", k, samples);
                }
            }
        }
    }
}

#[test]
fn a_leg_takes_memory_as_its_contact_has_parts() {
    let bytes = |body: &mut dyn Solver| {
        assert_eq!(body.leg().bytes(), 0);
        body.advance(Move::ToIndentation(0.1)).unwrap();
        body.leg().bytes()
    };
    let of_punches = |count| {
        let body = punches(count, 8);
        bytes(&mut body.on(2))
    };
    let [ten, hundred, thousand] = [10, 100, 1000].map(of_punches);
    // At least two indentations for each.
    assert!(ten >= 160 && hundred >= 1600);
    // Within the room for growth of a vector.
    assert!(thousand >= 5 * hundred && thousand <= 20 * hundred, "{hundred} {thousand}");
    let body = punches(2, 8);
    let contact = body.contact();
    let mut stepwise = Stepwise::new(&contact, 0.05, 2, &|| false).unwrap();
    stepwise.advance(Move::ToTouch).unwrap();
    assert_eq!(stepwise.leg().bytes(), size_of::<f64>() * body.gaps.len());
    assert_eq!(bytes(&mut nonadhesive(&body.gaps, Edges::Grid, body.foundation, 2)), 0);
}

proptest! {
    #![proptest_config(cases(200))]

    /// F_a(0) takes one pass and visits the springs that touch first and those that these attach.
    #[test]
    fn the_way_back_from_first_touch_looks_at_the_springs_in_contact(body in body()) {
        let back = body.history(&[Move::ToTouch, Move::ToSeparation], 2);
        let mut solver = body.on(2);
        let force = solver.pull_off_at_touch().unwrap();
        let work = solver.work();
        prop_assert_eq!((work.zero_load_passes, work.unloading_passes), (1, 0));
        prop_assert!(work.hess_evaluations > 0);
        let tolerance = 1e-12 * body.force_scale();
        prop_assert!((force - back.legs[1].smallest.force).abs() <= tolerance, "{} {:?}", force, back.legs[1].smallest);
    }

    /// A node for each place inside the line after which the gap no longer rises, in the memory of another tree too.
    #[test]
    fn a_tree_has_a_node_for_each_summit_of_the_gap(gaps in gaps()) {
        let rises = |k: usize| gaps[k + 1] > gaps[k];
        let summits = (1..gaps.len().saturating_sub(1)).filter(|&k| rises(k - 1) && !rises(k)).count();
        let springs = Springs::new(gaps.clone());
        let tree = springs.tree(Edges::Grid).unwrap();
        prop_assert_eq!(tree.node_count(), summits);
        let again = Springs::new(gaps);
        prop_assert_eq!(again.tree_in(springs.into_tree(), Edges::Grid).unwrap().node_count(), summits);
    }
}

#[test]
fn curves_take_some_of_the_time_and_not_more() {
    let gaps: Vec<_> = (0..4000).map(|k| (f64::from(k) * 0.05).sin() + 1.0).collect();
    let lowest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let gaps = gaps.iter().map(|gap| gap - lowest).collect();
    let body = Body { gaps, foundation: Foundation::endless(0.01, 1.0), work: 1e-3, closing: 1.0 };
    let contact = body.contact();
    let clock = std::time::Instant::now();
    let mut exact = body.on(50);
    let mut stepwise = Stepwise::new(&contact, 0.5, 2, &|| false).unwrap();
    for leg in [Move::ToIndentation(1.0), Move::ToSeparation] {
        exact.advance(leg).unwrap();
        stepwise.advance(leg).unwrap();
    }
    let taken = clock.elapsed().as_secs_f64();
    assert!(exact.curve_seconds() > 0.0 && exact.curve_seconds() < taken);
    // Each step adds its own point to the curve.
    assert_eq!(stepwise.curve_seconds(), 0.0);
}
