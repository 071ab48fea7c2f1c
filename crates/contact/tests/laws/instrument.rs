//! A compliant instrument: stages to a displacement, and the energy of jumps, against running
//! extrema by brute force.

use super::*;

fn on(body: &Body, stiffness: f64) -> contact::motion::Body {
    contact::motion::Body::new(&body.under(stiffness), 33)
}

/// ∫ |D − running extremum of D| dd along a polygon of indentations and displacements D that `sign`
/// makes grow, m².
fn behind(curve: &[(f64, f64)], sign: f64) -> f64 {
    let (mut reached, mut area) = (f64::NEG_INFINITY, 0.0);
    for pair in curve.windows(2) {
        reached = f64::max(reached, sign * pair[0].1);
        let behind = [0, 1].map(|end| reached - sign * pair[end].1);
        let share = if behind[1] >= 0.0 {
            1.0
        } else {
            behind[0] / (behind[0] - behind[1])
        };
        area += 0.5 * (behind[0] + behind[1].max(0.0)) * share * (pair[1].0 - pair[0].0).abs();
    }
    area
}

proptest! {
    #![proptest_config(cases(750))]

    /// Each stage ends at the first indentation at which the running extremum of d + F/k reaches
    /// its target.
    #[test]
    fn stages_end_where_the_running_extremum_reaches_the_displacement(
        body in bodies(120),
        power in -3.0..3.0_f64,
        turns in prop::collection::vec(-0.6..1.3_f64, 1..7),
    ) {
        let stiffness = 10.0_f64.powf(power) * body.stiffness();
        let most = 1.3 + body.force_scale() / stiffness;
        let slack = 1e-12 * (most + body.largest_stretch());
        let mut solver = on(&body, stiffness);
        for turn in turns {
            let to = if turn > 0.0 { turn * most } else { turn };
            let before = solver.point();
            let record = solver.advance(Move::ToDisplacement(to)).unwrap();
            let (after, stage) = (end(&record), solver.stage());
            let loads = record.direction == Direction::Loading;
            let sign = if loads { 1.0 } else { -1.0 };
            if after.springs == 0 {
                prop_assert_eq!(after.indentation, to);
            } else {
                prop_assert!((after.displacement(stiffness) - to) * sign >= -slack, "{:?} {}", after, to);
            }
            if before.springs == 0 && after.springs == 0 {
                continue;
            }
            let from = if before.springs == 0 { 0.0 } else { before.indentation };
            let (low, high) = (from.min(after.indentation), from.max(after.indentation));
            let even = (0..200).map(|k| low + (high - low) * f64::from(k) / 200.0);
            let events = stage.thresholds().into_iter().flat_map(|at| [at.next_down(), at]);
            let mut probes: Vec<f64> = even.chain(events).filter(|&at| low < at && at < high).collect();
            probes.sort_by(f64::total_cmp);
            for point in stage.curve(&probes).unwrap() {
                let reached = point.displacement(stiffness);
                prop_assert!((to - reached) * sign >= -slack, "{:?} passes {} before {:?}", point, to, after);
            }
        }
    }

    /// The energy of the jumps is that between the curve and its running extremum, for any number
    /// of samples and of stages.
    #[test]
    fn the_energy_of_jumps_is_exact(
        body in bodies(120),
        power in -3.0..3.0_f64,
        turns in prop::collection::vec((-0.6..1.3_f64, 0.0..1.0_f64), 1..5),
        ends_separated in any::<bool>(),
    ) {
        let stiffness = 10.0_f64.powf(power) * body.stiffness();
        let most = 1.3 + body.force_scale() / stiffness;
        let mut targets: Vec<(Move, f64)> = turns
            .into_iter()
            .map(|(turn, share)| (Move::ToDisplacement(if turn > 0.0 { turn * most } else { turn }), share))
            .collect();
        targets.extend(ends_separated.then_some((Move::ToSeparation, 0.5)));
        let energy = |stages: &[StageRecord]| stages.iter().map(|stage| stage.jump_energy).sum::<f64>();
        let contact = body.under(stiffness);
        let (mut few, mut cut) = (contact::motion::Body::new(&contact, 2), contact::motion::Body::new(&contact, 300));
        let scale = body.scales()[1] + most * most * stiffness;
        for (target, share) in targets {
            let from = few.point();
            let record = few.advance(target).unwrap();
            let stage = few.stage();
            let loads = record.direction == Direction::Loading;
            let sign = if loads { 1.0 } else { -1.0 };
            // The same stage in two, cut at a displacement on the way.
            let [start, stop] = [from, end(&record)].map(|point| point.displacement(stiffness));
            let on_way = start + share * (stop - start);
            let mut parts = Vec::new();
            if (if loads { on_way > 0.0 || from.springs > 0 } else { from.springs > 0 }) && target != Move::ToSeparation {
                parts.push(cut.advance(Move::ToDisplacement(on_way)).unwrap());
            }
            parts.push(cut.advance(target).unwrap());
            let difference = (record.jump_energy - energy(&parts)).abs();
            prop_assert!(difference <= 1e-11 * scale, "{:?}: {} in {}", target, difference, scale);
            prop_assert!(record.jump_energy >= -1e-13 * scale, "{}", record.jump_energy);
            if stage.thresholds().iter().all(|at| at.is_infinite()) {
                continue;
            }
            let ends = [record.start(), record.end()];
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let low = if loads && from.springs == 0 { low.max(0.0) } else { low };
            let count = if body.edges == Edges::Grid { 0 } else { 4000 };
            let even = (0..=count).map(|k| low + (high - low) * f64::from(k) / f64::from(count.max(1)));
            let events = stage.thresholds().into_iter().flat_map(|at| [at.next_down(), at]);
            let mut probes: Vec<f64> = even.chain(events).filter(|&at| low <= at && at <= high).chain([low, high]).collect();
            probes.sort_by(f64::total_cmp);
            let mut curve: Vec<(f64, f64)> = stage.curve(&probes).unwrap().iter().map(|at| (at.indentation, at.displacement(stiffness))).collect();
            if loads && from.springs == 0 {
                curve.insert(0, (low, low));
            }
            if !loads {
                curve.reverse();
                let end = end(&record);
                curve.extend((end.springs == 0).then_some((end.indentation, end.indentation)));
            }
            let expected = stiffness * behind(&curve, sign);
            let allowed = if body.edges == Edges::Grid { 1e-9 } else { 1e-5 };
            prop_assert!((record.jump_energy - expected).abs() <= allowed * scale, "{:?}: {} {}", target, record.jump_energy, expected);
        }
    }
}
