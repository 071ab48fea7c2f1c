//! Contact without adhesion is reversible; scales of height and of stress only scale; a mirror only mirrors; stronger
//! adhesion holds more.

use super::*;

/// All numbers of a leg with lengths across the line and forces scaled, bit for bit; energies of 0 and −0 are the same.
fn scaled_bits(record: &LegRecord, height: f64, force: f64) -> Vec<u64> {
    let energy = |joules: f64| height * force * joules + 0.0;
    let scaled = |point: &CurvePoint| {
        // The number next to 0 does not scale.
        let indentation = if point.indentation.abs() < 1e-300 { 0.0 } else { height * point.indentation };
        let stored_energy = energy(point.stored_energy);
        bits(&CurvePoint { indentation, force: force * point.force, stored_energy, ..*point })
    };
    let points = record.curve.iter().chain([&record.largest, &record.smallest]);
    let counts = [record.attached, record.detached, energy(record.released_energy).to_bits()];
    points.flat_map(scaled).chain(counts).collect()
}

/// A history possible for every body. Between springs a force without adhesion vanishes by and by, so that the place of
/// zero force is a matter of rounding.
fn targets(body: &Body, turns: &[f64], force: f64) -> Vec<Move> {
    let first = Move::ToForce(force * body.force_scale());
    let last = [Move::ToZeroForce, Move::ToSeparation];
    let last = last.into_iter().skip(usize::from(body.edges == Edges::SubCell));
    [first].into_iter().chain(to_indentations(turns)).chain(last).collect()
}

/// Springs in contact after a history.
fn springs(body: &Body, turns: &[f64]) -> Vec<usize> {
    indices(&body.history(&to_indentations(turns), 2).contacts)
}

proptest! {
    #![proptest_config(cases(600))]

    /// A contact without adhesion, which has no tree, agrees with a work of adhesion of zero: bit for bit where patches are
    /// whole springs.
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
                prop_assert_eq!(scaled_bits(&one, 1.0, 1.0), scaled_bits(&other, 1.0, 1.0), "{:?}", target);
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
                    let apart = (end.force - super::end(&at_once.legs[0]).force).abs();
                    let allowed = if body.edges == Edges::Grid { 0.0 } else { 1e-12 * scale };
                    prop_assert!(apart <= allowed, "{:?} against going there", target);
                    prop_assert_eq!(solver.leg().patches(end.indentation), at_once.contacts);
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
            prop_assert_eq!((a.springs, a.fragments), (b.springs, b.fragments));
            prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
            prop_assert!((one.released_energy - other.released_energy).abs() <= energy_scale);
            for probe in probes.iter().chain(&[0.0, 1.0]) {
                let d = one.start() + probe * (one.end() - one.start());
                let turned = |patch: &Patch| Patch { first: last - patch.last, last: last - patch.first };
                let turned: Vec<_> = mirrored.leg().patches(d).iter().rev().map(turned).collect();
                prop_assert_eq!(solver.leg().patches(d), turned, "at {} of {:?}", d, target);
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
