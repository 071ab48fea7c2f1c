//! Contact without adhesion is reversible; a mirror only mirrors; stronger adhesion holds more.

use super::*;

/// All numbers of a stage, bit for bit, but for the sign of energies of zero and for the number
/// next to an indentation of zero.
fn stage_bits(record: &StageRecord) -> Vec<u64> {
    let of_point = |point: &CurvePoint| {
        let indentation = if point.indentation.abs() < 1e-300 {
            0.0
        } else {
            point.indentation
        };
        bits(&CurvePoint {
            indentation,
            stored_energy: point.stored_energy + 0.0,
            ..*point
        })
    };
    let points = record
        .curve
        .iter()
        .chain([&record.largest, &record.smallest]);
    points
        .flat_map(of_point)
        .chain([record.attached, record.detached])
        .collect()
}

/// A history possible for every body. Between springs a force without adhesion vanishes by and by,
/// so that the place of zero force is a matter of rounding.
fn targets(body: &Body, turns: &[f64], force: f64) -> Vec<Move> {
    let first = Move::ToForce(force * body.force_scale());
    let last = [Move::ToZeroForce, Move::ToSeparation];
    let last = last
        .into_iter()
        .skip(usize::from(body.edges == Edges::SubCell));
    [first]
        .into_iter()
        .chain(to_indentations(turns))
        .chain(last)
        .collect()
}

/// Springs in contact after a history.
fn springs(body: &Body, turns: &[f64]) -> Vec<usize> {
    indices(&body.history(&to_indentations(turns), 2).contacts)
}

proptest! {
    #![proptest_config(cases(600))]

    /// A contact without adhesion, which has no tree, agrees with a work of adhesion of zero: bit
    /// for bit where patches are whole springs.
    #[test]
    fn without_adhesion_the_past_leaves_no_trace(
        body in bodies(200), turns in indentations(8), force in 0.0..1.0_f64,
    ) {
        let body = body.with_more_adhesion(0.0);
        let (mut tree, mut bare) = (body.on(33), body.bare(33));
        let [scale, _] = body.scales();
        for target in targets(&body, &turns, force) {
            let (one, other) = (tree.advance(target).unwrap(), bare.advance(target).unwrap());
            prop_assert_eq!((one.released_energy, other.released_energy), (0.0, 0.0));
            if body.edges == Edges::Grid {
                prop_assert_eq!(stage_bits(&one), stage_bits(&other), "{:?}", target);
            }
            prop_assert_eq!((one.direction, one.curve.len()), (other.direction, other.curve.len()));
            let extremes = [(&one.largest, &other.largest), (&one.smallest, &other.smallest)];
            for (a, b) in one.curve.iter().zip(&other.curve).chain(extremes) {
                prop_assert!((a.indentation - b.indentation).abs() <= 2e-12, "{:?} {:?}", a, b);
                prop_assert!((a.force - b.force).abs() <= 1e-12 * scale, "{:?} {:?}", a, b);
                prop_assert!((a.contact_length - b.contact_length).abs() <= 1e-10, "{:?} {:?}", a, b);
            }
            for (solver, record) in [(&tree, &one), (&bare, &other)] {
                let end = end(record);
                if end.springs > 0 {
                    let at_once = body.history(&[Move::ToIndentation(end.indentation)], 2);
                    let apart = (end.force - super::end(&at_once.stages[0]).force).abs();
                    let allowed = if body.edges == Edges::Grid { 0.0 } else { 1e-12 * scale };
                    prop_assert!(apart <= allowed, "{:?} against going there", target);
                    prop_assert_eq!(solver.stage().patches(end.indentation), at_once.contacts);
                }
            }
        }
        prop_assert_eq!(bare.work().hess_evaluations, 0);
    }

    #[test]
    fn a_mirror_changes_nothing_but_left_and_right(
        body in bodies(200),
        turns in indentations(6),
        force in 0.0..1.0_f64,
        probes in prop::collection::vec(0.0..1.0_f64, 4),
    ) {
        let mirrored = Body { gaps: body.gaps.iter().rev().copied().collect(), ..body.clone() };
        let last = body.gaps.len() - 1;
        let (mut solver, mut mirrored) = (body.on(33), mirrored.on(33));
        let [scale, energy_scale] = body.scales().map(|scale| 1e-14 * scale);
        for target in targets(&body, &turns, force) {
            let (one, other) = (solver.advance(target).unwrap(), mirrored.advance(target).unwrap());
            // Sums of whole springs do not depend on their order.
            if body.edges == Edges::Grid {
                prop_assert_eq!(curve_bits(&one), curve_bits(&other));
            }
            let (a, b) = (end(&one), end(&other));
            prop_assert!((a.force - b.force).abs() <= 10.0 * scale, "{:?} {:?}", a, b);
            prop_assert_eq!((a.springs, a.patches), (b.springs, b.patches));
            prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
            prop_assert!((one.released_energy - other.released_energy).abs() <= energy_scale);
            for probe in probes.iter().chain(&[0.0, 1.0]) {
                let d = one.start() + probe * (one.end() - one.start());
                let turned = |patch: &Patch| Patch { first: last - patch.last, last: last - patch.first };
                let turned: Vec<_> = mirrored.stage().patches(d).iter().rev().map(turned).collect();
                prop_assert_eq!(solver.stage().patches(d), turned, "at {} of {:?}", d, target);
            }
        }
    }

    #[test]
    fn stronger_adhesion_holds_more(body in bodies(200), turns in indentations(6), factor in 1.0..30.0_f64) {
        let less = springs(&body, &turns);
        let more = springs(&body.with_more_adhesion(factor), &turns);
        prop_assert!(less.iter().all(|spring| more.binary_search(spring).is_ok()));
    }
}
