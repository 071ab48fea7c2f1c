//! The interface of programs: what is refused and why, that nothing else than finite numbers
//! leaves, and that columns, points at given indentations, reversals and patches agree with the
//! stages they are taken from.

use super::*;
use asperity_contact::{Cycle, LoadOptions, Modulus, Profile};
use std::sync::Arc;

fn modulus(pascals: f64) -> Modulus {
    Modulus::effective(pascals).unwrap()
}

#[test]
fn wrong_values_are_named_with_what_is_allowed() {
    let flat = Profile::from_gaps(vec![0.0; 3], 1e-6).unwrap();
    let of = |error: ContactError| error.to_string();
    let pascals = "allowed: from 1e-50 to 1e50 Pa";
    let built = |works, stiffness| {
        let contact = Contact::builder(&flat, modulus(1e6)).works_of_adhesion(works);
        of(contact.loading_stiffness(stiffness).build().unwrap_err())
    };
    let profile =
        |heights: &[f64], spacing| of(Profile::from_heights(heights, spacing).unwrap_err());
    let gaps = |gaps: &[f64]| of(Profile::from_gaps(gaps.to_vec(), 1e-6).unwrap_err());
    for (refused, expected) in [
        (of(Modulus::effective(f64::NAN).unwrap_err()), format!("effective modulus = NaN; {pascals}")),
        (of(Modulus::isotropic(-1.0, 0.5).unwrap_err()), format!("Young's modulus = -1; {pascals}")),
        (
            of(Modulus::isotropic(1e6, -1.0).unwrap_err()),
            "Poisson's ratio = -1; allowed: above -1 and at most 0.5".to_owned(),
        ),
        (
            of(Modulus::pair(modulus(1e-50), modulus(1e-50)).unwrap_err()),
            format!("effective modulus = 5e-51; {pascals}"),
        ),
        (
            built([1e100; 2], f64::INFINITY),
            "work of adhesion = 1e100; allowed: from 0 to 1e50 J/m²".to_owned(),
        ),
        (
            built([f64::NAN; 2], f64::INFINITY),
            "work of adhesion = NaN; allowed: from 0 to 1e50 J/m²".to_owned(),
        ),
        (
            built([2.0, 1.0], f64::INFINITY),
            "closing work = 2; allowed: from 0 J/m² to the work of adhesion".to_owned(),
        ),
        (
            built([0.0; 2], -2.0),
            "loading stiffness = -2; allowed: from 1e-50 to 1e50 N/m, or infinite: rigid".to_owned(),
        ),
        (
            profile(&[1.0, f64::NAN], 1e-7),
            "height with index 1 = NaN; allowed: from -1e50 to 1e50 m".to_owned(),
        ),
        (profile(&[], 1e-7), "number of points = 0; allowed: from 1 to 268435456".to_owned()),
        (profile(&[1.0], 1e-100), "spacing = 1e-100; allowed: from 1e-50 to 1e50 m".to_owned()),
        (
            profile(&[1e50, -1e50], 1.0),
            "largest gap of the profile = 2e50; allowed: at most 1e50 m".to_owned(),
        ),
        (gaps(&[0.0, f64::INFINITY]), "gap with index 1 = inf; allowed: from 0 to 1e50 m".to_owned()),
        (
            of(flat.clone().on_foundation(1e-6, 0).unwrap_err()),
            "length of the foundation = 1e-6; allowed: at least the end of the profile, at most 1e50 m"
                .to_owned(),
        ),
        (
            of(flat.clone().with_summit(f64::NAN).unwrap_err()),
            "height of the highest point = NaN; allowed: from -1e50 to 1e50 m".to_owned(),
        ),
        (
            gaps(&[1.0, 2.0]),
            "smallest gap of the profile = 1; allowed: 0: the highest point has no gap".to_owned(),
        ),
    ] {
        assert_eq!(refused, expected);
    }
}

#[test]
fn wrong_loadings_are_named_with_what_is_allowed() {
    let flat = Profile::from_gaps(vec![0.0; 3], 1e-6).unwrap();
    let contact = Contact::builder(&flat, modulus(1e6))
        .work_of_adhesion(0.05)
        .build()
        .unwrap();
    let load = |stages: &[Move], options| contact.load_with(stages, options).unwrap_err();
    for target in [1e100, f64::NAN] {
        let refused = load(
            &[Move::ToTouch, Move::ToForce(target)],
            LoadOptions::default(),
        )
        .to_string();
        assert!(refused.starts_with("target of stage 2 = "), "{refused}");
        assert!(
            contact
                .reversals(&[Move::ToIndentation(target)], &[])
                .is_err()
        );
    }
    for samples in [0, 1, u64::MAX] {
        let refused = load(&[Move::ToTouch], LoadOptions::default().samples(samples)).to_string();
        assert!(
            refused.ends_with("; allowed: from 2 to 1000000"),
            "{refused}"
        );
    }
    for indentations in [&[1.0, 0.5][..], &[0.0, f64::NAN], &[1e100]] {
        let refused = load(
            &[Move::ToTouch],
            LoadOptions::default().indentations(indentations),
        )
        .to_string();
        assert!(
            refused.ends_with("; allowed: from -1e50 to 1e50 m, ascending"),
            "{refused}"
        );
        assert!(contact.reversals(&[Move::ToTouch], indentations).is_err());
    }
    // The stage and the smallest force within reach, as data; at that force the stage is accepted.
    let refused = load(
        &[Move::ToTouch, Move::ToForce(-1.0)],
        LoadOptions::default(),
    );
    let smallest = refused.smallest_force().unwrap();
    assert_eq!(
        (refused.stage(), refused.is_out_of_reach()),
        (Some(1), true)
    );
    assert!(
        contact
            .load(&[Move::ToTouch, Move::ToForce(smallest)])
            .is_ok()
    );
    assert!(
        contact
            .load(&[Move::ToTouch, Move::ToForce(1.001 * smallest)])
            .is_err()
    );
    assert_eq!(ContactError::Interrupted.stage(), None);
}

#[test]
fn gaps_and_heights_keep_their_memory() {
    let heights = vec![0.0, -2.0, -1.0];
    let memory = heights.as_ptr();
    let profile = Profile::from_heights(heights, 0.5).unwrap();
    assert_eq!(
        (profile.gaps().as_ptr(), profile.gaps()),
        (memory, &[0.0, 2.0, 1.0][..])
    );
    let shared = Arc::new(vec![1.0, 0.0]);
    let profile = Profile::from_gaps(Arc::clone(&shared), 0.5).unwrap();
    assert!(Arc::ptr_eq(profile.shared_gaps(), &shared));
    assert!(Arc::ptr_eq(profile.clone().shared_gaps(), &shared));
}

#[test]
fn a_loading_is_stopped_before_a_stage() {
    let flat = Profile::from_gaps(vec![0.0; 3], 1e-6).unwrap();
    let contact = Contact::builder(&flat, modulus(1e6)).build().unwrap();
    let stages = [Move::ToTouch, Move::ToForce(1e-9), Move::ToSeparation];
    for allowed in 0..4 {
        let mut seen = Vec::new();
        let mut proceed = |stage| {
            seen.push(stage);
            stage < allowed
        };
        let cycle = contact.load_with(&stages, LoadOptions::default().before_stage(&mut proceed));
        assert_eq!(
            cycle.err(),
            (allowed < 3).then_some(ContactError::Interrupted)
        );
        assert_eq!(seen, (0..=allowed.min(2)).collect::<Vec<_>>());
    }
    assert!(
        contact
            .load(&[])
            .is_ok_and(|cycle| cycle.curve().force.is_empty() && cycle.patches().is_empty())
    );
}

/// Heights, spacing, modulus and work of any allowed magnitude.
fn any_magnitudes() -> impl Strategy<Value = (Vec<f64>, [f64; 5])> {
    let size = |least: f64| (least..50.0).prop_map(|power| 10.0_f64.powf(power));
    let heights = (size(-300.0), prop::collection::vec(0.0..1.0_f64, 5));
    let heights =
        heights.prop_map(|(height, shares)| shares.iter().map(|share| height * share).collect());
    let work = prop_oneof![9 => size(-300.0), 1 => Just(0.0)];
    (
        heights,
        (size(-50.0), size(-50.0), work, size(-300.0), size(-50.0)),
    )
        .prop_map(|(heights, (a, b, c, d, e))| (heights, [a, b, c, d, e]))
}

proptest! {
    #![proptest_config(cases(4800))]

    /// Every accepted value, of any allowed magnitude, gives finite results.
    #[test]
    fn no_result_is_other_than_a_finite_number(
        (heights, [spacing, pascals, work, force, indentation]) in any_magnitudes(), grid in any::<bool>(),
    ) {
        let Ok(profile) = Profile::from_heights(heights, spacing) else { return Ok(()) };
        let edges = if grid { Edges::Grid } else { Edges::SubCell };
        let contact = Contact::builder(&profile, modulus(pascals)).edges(edges).work_of_adhesion(work);
        let contact = contact.build().unwrap();
        for first in [Move::ToForce(force), Move::ToIndentation(indentation), Move::ToTouch, Move::ToZeroForce] {
            let cycle = contact.load_with(&[first, Move::ToSeparation], LoadOptions::default().samples(4));
            let patches = contact.load_with(&[first], LoadOptions::default().samples(4));
            let patches = patches.map(|cycle| cycle.patches());
            let reversals = contact.reversals(&[first], &[-indentation, 0.0]);
            let figures = cycle.as_ref().map(Cycle::figures);
            let curve = cycle.as_ref().map(Cycle::curve);
            let found = format!("{figures:?} {curve:?} {patches:?} {reversals:?}");
            prop_assert!(!found.contains("NaN") && !found.contains("inf"), "{}", found);
        }
    }
}

proptest! {
    #![proptest_config(cases(400))]

    /// Columns are the points of the stages, points at given indentations are those of a stage, and
    /// a reversal equals a loading and an unloading.
    #[test]
    fn columns_points_and_reversals_agree_with_the_stages(
        body in bodies(120), turns in indentations(5), mut at in prop::collection::vec(-0.9..1.3_f64, 0..6),
    ) {
        at.sort_by(f64::total_cmp);
        let contact = body.contact();
        let stages = to_indentations(&turns);
        let cycle = contact.load_with(&stages, LoadOptions::default().samples(9).indentations(&at)).unwrap();
        let history = body.history(&stages, 9);
        prop_assert_eq!(cycle.stages(), &history.stages[..]);
        let curve = cycle.curve();
        let rows = history.stages.iter().enumerate().flat_map(|(stage, record)| record.curve.iter().map(move |p| (stage, p)));
        prop_assert_eq!(rows.clone().count(), curve.stage.len());
        for (row, (stage, point)) in rows.enumerate() {
            prop_assert_eq!((curve.stage[row], curve.patches[row]), (stage, point.patches));
            let columns = [&curve.indentation, &curve.displacement, &curve.force, &curve.contact_length, &curve.stored_energy];
            let CurvePoint { indentation, force, contact_length, stored_energy, .. } = *point;
            let expected = [indentation, indentation, force, contact_length, stored_energy];
            prop_assert_eq!(columns.map(|column| column[row]), expected);
        }
        let mut solver = body.on(9);
        for (stage, target) in stages.iter().enumerate() {
            let record = solver.advance(*target).unwrap();
            let (low, high) = (record.start().min(record.end()), record.start().max(record.end()));
            let inside: Vec<f64> = at.iter().copied().filter(|at| low <= *at && *at <= high).collect();
            prop_assert_eq!(cycle.at(stage), solver.stage().curve(&inside).unwrap());
        }
        let ends: Vec<Move> = turns.iter().map(|turn| Move::ToIndentation(turn.abs())).collect();
        for (end, reversal) in ends.iter().zip(contact.reversals(&ends, &at).unwrap()) {
            let back = contact.load_with(&[*end, Move::ToSeparation], LoadOptions::default().indentations(&at)).unwrap();
            let smallest = back.stages()[1].smallest.force;
            prop_assert!((reversal.smallest.force - smallest).abs() <= 1e-12 * body.force_scale());
            let below = at.partition_point(|at| *at <= reversal.turn.indentation);
            prop_assert_eq!(reversal.forces.len(), below);
            let last = &reversal.forces[below - back.at(1).len()..];
            for (force, point) in last.iter().zip(back.at(1)) {
                prop_assert!((force - point.force).abs() <= 1e-12 * body.force_scale());
            }
        }
    }

    /// The edges of patches are as far apart as the patches are long, in order, and on the
    /// foundation.
    #[test]
    fn edges_of_patches_enclose_their_length(body in bodies(120), turns in indentations(5)) {
        let contact = body.contact();
        let length = contact.profile().length();
        for stages in (1..=turns.len()).map(|count| to_indentations(&turns[..count])) {
            let patches = contact.load_with(&stages, LoadOptions::default().samples(2)).unwrap().patches();
            let mut before = 0.0;
            for patch in patches {
                let [left, right] = patch.edges;
                prop_assert!((right - left - patch.length).abs() <= 1e-12 * length, "{:?}", patch);
                prop_assert!(before <= left + 1e-12 * length && right <= length * (1.0 + 1e-12), "{:?}", patch);
                let middle = contact.profile().position(patch.springs.middle());
                prop_assert!(left <= middle && middle <= right);
                before = right;
            }
        }
    }
}
