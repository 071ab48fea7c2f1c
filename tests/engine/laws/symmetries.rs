//! Contact without adhesion is reversible; scales of height and of stress only scale; a mirror only mirrors.

use super::*;

/// All numbers of a leg, bit for bit; energies of 0 and −0 are the same.
fn leg_bits(record: &LegRecord) -> Vec<u64> {
    let points = record.curve.iter().chain([&record.largest, &record.smallest]);
    let energy = (record.released_energy + 0.0).to_bits();
    points.flat_map(bits).chain([record.attached, record.detached, energy]).collect()
}

fn scaled(point: &CurvePoint, length: f64, force: f64) -> [u64; 4] {
    bits(&CurvePoint { indentation: point.indentation * length, force: point.force * force, ..*point })
}

/// The legs with lengths and forces scaled.
fn scaled_legs(legs: &[Move], length: f64, force: f64) -> Vec<Move> {
    let scale = |leg: &Move| match *leg {
        Move::ToIndentation(to) => Move::ToIndentation(to * length),
        Move::ToForce(to) => Move::ToForce(to * force),
        other => other,
    };
    legs.iter().map(scale).collect()
}

/// A history possible for every body.
fn legs(body: &Body, turns: &[f64], force: f64) -> Vec<Move> {
    let mut legs = vec![Move::ToForce(force * body.force_scale())];
    legs.extend(to_indentations(turns));
    legs.extend([Move::ToZeroForce, Move::ToSeparation]);
    legs
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn without_adhesion_approach_and_retraction_are_one_curve(
        body in bare_body(),
        deepest in 0.0..1.5_f64,
        samples in 2_usize..700,
    ) {
        let legs = [Move::ToIndentation(deepest), Move::ToSeparation];
        let adhesive = body.history(&legs, samples);
        let bare = run(&mut nonadhesive(&body.gaps, Edges::Grid, body.foundation, samples), &legs, |_, _| Ok(())).unwrap();
        for history in [adhesive, bare] {
            let mut back = curve_bits(&history.legs[1]);
            back.reverse();
            prop_assert_eq!(curve_bits(&history.legs[0]), back);
            prop_assert_eq!(history.legs[0].released_energy, 0.0);
            prop_assert_eq!(history.legs[1].released_energy, 0.0);
        }
    }

    #[test]
    fn without_adhesion_the_past_leaves_no_trace(
        body in bare_body(),
        turns in indentations(8),
        force in 0.0..1.0_f64,
    ) {
        let legs = legs(&body, &turns, force);
        let mut adhesive = body.on(33);
        let mut bare = nonadhesive(&body.gaps, Edges::Grid, body.foundation, 33);
        for leg in legs {
            let (a, b) = (adhesive.advance(leg).unwrap(), bare.advance(leg).unwrap());
            prop_assert_eq!(leg_bits(&a), leg_bits(&b), "the two solvers, {:?}", leg);
            prop_assert_eq!(a.released_energy, 0.0);
            let end = *a.curve.last().unwrap();
            if end.springs > 0 {
                let at_once = body.history(&[Move::ToIndentation(end.indentation)], 2);
                prop_assert_eq!(bits(&end), bits(&super::end(&at_once)), "{:?} against going there", leg);
                prop_assert_eq!(adhesive.leg().patches(end.indentation), at_once.contacts.clone());
                prop_assert_eq!(bare.leg().patches(end.indentation), at_once.contacts);
            }
        }
    }

    #[test]
    fn a_power_of_two_in_height_scales_bit_for_bit(
        body in body(),
        turns in indentations(6),
        force in 0.0..1.0_f64,
        exponent in -60_i32..60,
    ) {
        // z → λz and γ → λ²γ: d → λd and F → λF, energies → λ² times.
        let lambda = 2_f64.powi(exponent);
        let larger = Body {
            gaps: body.gaps.iter().map(|gap| lambda * gap).collect(),
            work: lambda * lambda * body.work,
            ..body
        };
        let legs = legs(&body, &turns, force);
        let (history, of_larger) =
            (body.history(&legs, 65), larger.history(&scaled_legs(&legs, lambda, lambda), 65));
        for (one, other) in history.legs.iter().zip(&of_larger.legs) {
            let expected: Vec<_> = one.curve.iter().map(|point| scaled(point, lambda, lambda)).collect();
            prop_assert_eq!(expected, curve_bits(other));
            prop_assert_eq!(scaled(&one.largest, lambda, lambda), bits(&other.largest));
            prop_assert_eq!(scaled(&one.smallest, lambda, lambda), bits(&other.smallest));
            prop_assert_eq!(one.released_energy * lambda * lambda, other.released_energy);
        }
        prop_assert_eq!(history.work, of_larger.work);
    }

    #[test]
    fn modulus_and_work_of_adhesion_scaled_alike_leave_contact_unchanged(
        body in body(),
        turns in indentations(6),
        force in 0.0..1.0_f64,
        exponent in -60_i32..60,
    ) {
        let factor = 2_f64.powi(exponent);
        let Foundation { spacing, effective_modulus, .. } = body.foundation;
        let stiffer = Body {
            foundation: Foundation::endless(spacing, factor * effective_modulus),
            work: factor * body.work,
            ..body.clone()
        };
        let legs = legs(&body, &turns, force);
        let (history, of_stiffer) =
            (body.history(&legs, 65), stiffer.history(&scaled_legs(&legs, 1.0, factor), 65));
        for (one, other) in history.legs.iter().zip(&of_stiffer.legs) {
            let expected: Vec<_> = one.curve.iter().map(|point| scaled(point, 1.0, factor)).collect();
            prop_assert_eq!(expected, curve_bits(other));
            prop_assert_eq!(one.released_energy * factor, other.released_energy);
        }
        prop_assert_eq!(history.work, of_stiffer.work);
    }

    #[test]
    fn a_mirror_changes_nothing_but_left_and_right(
        body in body(),
        turns in indentations(6),
        force in 0.0..1.0_f64,
        probes in prop::collection::vec(0.0..1.0_f64, 4),
    ) {
        let mirrored = Body { gaps: body.gaps.iter().rev().copied().collect(), ..body.clone() };
        let last = body.gaps.len() - 1;
        let (mut solver, mut mirrored) = (body.on(33), mirrored.on(33));
        let mut energy = 0.0;
        for leg in legs(&body, &turns, force) {
            let (one, other) = (solver.advance(leg).unwrap(), mirrored.advance(leg).unwrap());
            // Also the forces: sums of gaps do not depend on their order.
            prop_assert_eq!(curve_bits(&one), curve_bits(&other));
            prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
            energy += one.released_energy.abs();
            prop_assert!((one.released_energy - other.released_energy).abs() <= 1e-14 * energy);
            for probe in probes.iter().chain(&[0.0, 1.0]) {
                let d = one.start() + probe * (one.end() - one.start());
                let turn = |&(first, end): &(usize, usize)| (last - end, last - first);
                let turned: Vec<_> = mirrored.leg().patches(d).iter().rev().map(turn).collect();
                prop_assert_eq!(solver.leg().patches(d), turned, "at {} of {:?}", d, leg);
            }
        }
    }
}
