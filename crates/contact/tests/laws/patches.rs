//! Patches by themselves add up to the point of the curve, and a body moves between targets as
//! along a recorded stage.

use super::*;

/// Moves a copy of a body.
fn try_move(body: &contact::motion::Body, target: Move) -> Result<(), ContactError> {
    let mut copy = contact::motion::Body::at(&body.stage(), body.point().indentation)?;
    copy.move_to(target).map(drop)
}

/// Moves a body to targets twice: along recorded stages, and without a curve by moves of several
/// parts.
fn moves_alike(
    body: &Body,
    [mut recorded, mut moved]: [contact::motion::Body; 2],
    drawn: &[Drawn],
    parts: &[f64],
) -> Result<(), TestCaseError> {
    let energy_slack = 1e-12 * body.scales()[1];
    for &drawn in drawn {
        let (target, from) = (body.target(drawn, &moved), moved.point());
        let record = match (recorded.advance(target), try_move(&moved, target)) {
            (Ok(record), Ok(())) => record,
            (Err(one), Err(other)) => {
                prop_assert_eq!(one, other);
                prop_assert_eq!(moved.point(), from);
                continue;
            }
            other => return Err(TestCaseError::fail(format!("{target:?}: {other:?}"))),
        };
        let end = end(&record);
        // The rounding of a crossing depends on the indentation from which it is sought.
        let divided =
            from.springs > 0 && matches!(target, Move::ToIndentation(_) | Move::ToSeparation);
        let between = |part: &f64| {
            Move::ToIndentation(from.indentation + part * (end.indentation - from.indentation))
        };
        let (mut released, mut changed) = (0.0, 0);
        for target in parts
            .iter()
            .filter(|_| divided)
            .map(between)
            .chain([target])
        {
            let before = moved.point();
            if let Some(motion) = moved.move_to(target).unwrap() {
                let after = moved.point();
                let low = if before.springs == 0 || after.springs == 0 {
                    f64::NEG_INFINITY
                } else {
                    motion.low
                };
                released += motion.stage.released_energy(low, motion.high);
                changed += after.springs.abs_diff(before.springs);
            }
        }
        prop_assert_eq!(bits(&moved.point()), bits(&end), "{:?}", target);
        prop_assert_eq!(changed, record.attached + record.detached);
        prop_assert!(
            (released - record.released_energy).abs() <= energy_slack,
            "{:?}: {} J",
            target,
            released
        );
        if end.springs > 0 {
            let at = end.indentation;
            prop_assert_eq!(moved.stage().patches(at), recorded.stage().patches(at));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn patches_add_up_to_the_point_of_the_curve(body in bodies(200), turns in indentations(5)) {
        let mut solver = body.on(12);
        let length = body.foundation.spacing * body.gaps.len() as f64;
        let [slack, spread] = [body.force_scale(), length].map(|size| 1e-9 * size);
        for target in to_indentations(&turns) {
            let record = solver.advance(target).unwrap();
            let stage = solver.stage();
            for point in &record.curve {
                let patches = stage.patches(point.indentation);
                // At a point where part of the contact jumps, either side is right.
                if indices(&patches).len() as u64 != point.springs {
                    continue;
                }
                prop_assert_eq!(&stage.point(point.indentation).unwrap(), point);
                let state = |number| stage.patch_state(point.indentation, number);
                let states: Vec<_> = (0..patches.len()).map(|number| state(number).unwrap()).collect();
                prop_assert_eq!(state(patches.len()), None);
                let force: f64 = states.iter().map(|state| state.force).sum();
                let length: f64 = states.iter().map(|state| state.length).sum();
                prop_assert!((force - point.force).abs() <= slack);
                prop_assert!((length - point.contact_length).abs() <= spread);
                for (state, patch) in states.iter().zip(&patches) {
                    let most = state.largest_stretch * (1.0 + 1e-6) + 1e-9;
                    prop_assert!(state.most_stretched <= most, "{:?}", state);
                    let range = body.work / body.foundation.modulus;
                    let largest = (PI * state.length * range).sqrt();
                    prop_assert!((state.largest_stretch - largest).abs() <= 1e-12 * largest);
                    if body.edges == Edges::Grid {
                        let highest = body.gaps[patch.springs()].iter().copied().fold(0.0, f64::max);
                        prop_assert_eq!(state.most_stretched, highest - point.indentation);
                        prop_assert_eq!(state.length, patch.springs().len() as f64 * body.foundation.spacing);
                    }
                }
            }
        }
    }

    #[test]
    fn moves_without_a_curve_equal_recorded_stages(
        body in bodies(200), drawn in targets(14), parts in prop::collection::vec(0.0..1.0_f64, 0..4),
    ) {
        let mut parts = parts;
        parts.sort_by(f64::total_cmp);
        moves_alike(&body, [body.on(2), body.on(2)], &drawn, &parts)?;
        moves_alike(&body, [body.bare(2), body.bare(2)], &drawn, &parts)?;
    }
}
