//! The work of the force is the stored energy and the dissipated one on each stage, and no loop
//! gains energy.

use super::all_segments::Segments;
use super::*;

/// ∫F dd of a stage that was recorded, J: over all segments of whole springs; else over the points
/// of the curve, with a jump anywhere between two of them.
fn work_done(body: &Body, record: &StageRecord, stage: &Stage) -> f64 {
    if body.edges == Edges::SubCell {
        let trapezium = |pair: &[CurvePoint]| {
            0.5 * (pair[0].force + pair[1].force) * (pair[1].indentation - pair[0].indentation)
        };
        return record.curve.windows(2).map(trapezium).sum();
    }
    let segments = Segments::new(&stage.thresholds(), body);
    let (start, end) = (record.start(), record.end());
    if start < end {
        segments.work(start, end)
    } else {
        -segments.work(end, start)
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn the_work_of_each_stage_is_stored_or_dissipated(body in bodies(60), turns in indentations(8)) {
        let (samples, allowed) = if body.edges == Edges::Grid { (2, 1e-14) } else { (20_000, 3e-4) };
        let mut solver = body.on(samples);
        let [_, scale] = body.scales();
        let (mut stored, mut dissipated) = (0.0, 0.0);
        for target in to_indentations(&turns).into_iter().chain([Move::ToSeparation]) {
            let record = solver.advance(target).unwrap();
            let end = end(&record);
            if body.edges == Edges::Grid && end.springs > 0 {
                let expected = Segments::new(&solver.stage().thresholds(), &body).stored_energy(end.indentation);
                prop_assert!((end.stored_energy - expected).abs() <= 1e-14 * scale, "{:?} {}", end, expected);
            }
            let expected = work_done(&body, &record, &solver.stage()) - (end.stored_energy - stored);
            prop_assert!(
                (record.released_energy - expected).abs() <= allowed * scale,
                "{} against {} on {:?}", record.released_energy, expected, target
            );
            (stored, dissipated) = (end.stored_energy, dissipated + record.released_energy);
        }
        // From separation to separation.
        prop_assert!(dissipated >= -1e-14 * scale, "gained {}", -dissipated);
    }

    #[test]
    fn a_stage_divided_at_an_event_loses_no_more(
        body in bodies(200),
        deep in 0.2..1.2_f64,
        springs in prop::array::uniform4(any::<prop::sample::Index>()),
    ) {
        let mut solver = body.on(2);
        let whole = [Move::ToIndentation(deep), Move::ToSeparation].map(|target| {
            let record = solver.advance(target).unwrap();
            let mut thresholds = solver.stage().thresholds();
            thresholds.retain(|threshold| threshold.is_finite());
            (record.released_energy, thresholds, target)
        });
        let [_, scale] = body.scales();
        for spring in springs {
            let mut parts = body.on(2);
            for (released, thresholds, target) in &whole {
                if thresholds.is_empty() {
                    continue;
                }
                let event = Move::ToIndentation(spring.get(thresholds).min(deep));
                let found = [event, *target].map(|target| parts.advance(target).unwrap().released_energy);
                let error = (found[0] + found[1] - released).abs();
                prop_assert!(error <= 1e-14 * scale, "{:?} against {} at {:?}", found, released, event);
            }
        }
    }
}
