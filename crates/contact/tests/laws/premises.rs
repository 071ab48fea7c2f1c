//! Premises of the model: a body that is pulled off, a contact that ends inside the profile,
//! heights of a curved body.

use super::*;
use asperity_contact::{Branch, Figures, History, Modulus, NominalForm, Profile};
use asperity_data::Warning;

/// Targets of a history that presses the body and ends on a way back.
fn partial_loadings() -> impl Strategy<Value = (Vec<f64>, f64)> {
    (prop::collection::vec(0.0..1.2_f64, 1..4), 0.0..1.0_f64)
}

/// Force of the pull-off of a history that is continued to separation, in N.
fn pull_off_after_separation(body: &Body, targets: &[Move]) -> f64 {
    let whole = body.history(&[targets, &[Move::ToSeparation]].concat(), 2);
    Figures::of(&whole).pull_off_force.unwrap_or(0.0)
}

fn warning_of(history: &History, body: &Body) -> Option<Warning> {
    let warnings = history.warnings(body.contact().profile());
    warnings
        .into_iter()
        .find(|warning| warning.name() == "ends_in_contact")
}

proptest! {
    #![proptest_config(cases(4000))]

    /// A pull-off force is that of the unloading to separation, wherever the loading ends on the
    /// way. Where it would not be, there is none, and the warning states the pull of the rest.
    #[test]
    fn a_pull_off_force_does_not_depend_on_where_the_unloading_ends(
        body in bodies(200),
        (depths, share) in partial_loadings(),
    ) {
        let mut targets = to_indentations(&depths);
        let from = *depths.last().unwrap();
        targets.push(Move::ToIndentation(from - share * (from + body.largest_stretch())));
        let history = body.history(&targets, 2);
        let found = Figures::of(&history).pull_off_force;
        let whole = pull_off_after_separation(&body, &targets);
        let slack = 1e-8 * body.force_scale();
        match (found, warning_of(&history, &body)) {
            (Some(force), None) => prop_assert!((force - whole).abs() <= slack, "{force} {whole}"),
            (None, Some(Warning::EndsInContact { further })) => {
                let further = further.expect("the exact solver knows the rest");
                prop_assert!(further > 0.0 && (further - whole).abs() <= slack, "{further} {whole}");
                prop_assert!(history.stages.last().unwrap().end_in_contact().is_some());
            }
            // The body is not pulled, the end is the pull-off itself, or nothing is known of a
            // further unloading.
            (None, None) => {
                let least = Branch::last_unloading(&history.stages).and_then(|last| last.smallest(&history.stages));
                let force = least.map_or(0.0, |(_, point)| point.force);
                prop_assert!(whole <= slack || (force + whole).abs() <= slack || least.is_none());
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }

    /// A stage reaches the ends of the profile exactly if one of its states holds an outermost
    /// spring.
    #[test]
    fn outermost_springs_are_found(body in bodies(200), depths in indentations(6)) {
        let last = body.gaps.len() - 1;
        let mut solver = body.on(2);
        for depth in depths {
            let record = solver.advance(Move::ToIndentation(depth)).unwrap();
            let stage = solver.stage();
            let mut holds_end = false;
            for step in 0..=16 {
                let between = record.start() + (record.end() - record.start()) * f64::from(step) / 16.0;
                let at = if step == 16 { record.end() } else { between };
                let patches = stage.patches(at);
                let is_held = patches.iter().any(|patch| patch.first == 0 || patch.last == last);
                prop_assert_eq!(stage.reaches_ends(at), is_held, "{}", at);
                let touches = record.curve.iter().any(|point| point.springs > 0);
                holds_end |= is_held && touches;
            }
            let moves = record.start() != record.end();
            prop_assert!(!moves || record.reaches_ends == holds_end, "{:?}", record);
        }
    }
}

/// Gaps of a body with the depth |x|ⁿ on `points` points, with noise of this share of its depth.
fn body_of_power(exponent: f64, noise: f64, off_centre: f64, seed: u64, points: usize) -> Vec<f64> {
    let roughness = body::self_affine(0.7, seed, points);
    let heights: Vec<f64> = (0..points)
        .map(|index| {
            let x = 2.0 * (index as f64 + 0.5) / points as f64 - 1.0 - off_centre;
            x.abs().powf(exponent) + noise * roughness[index]
        })
        .collect();
    body::from_lowest(&heights)
}

/// Heights decide whether a body of which nobody has stated the form is curved.
#[test]
fn heights_show_whether_a_body_is_curved() {
    let is_curved = |gaps: Vec<f64>| Profile::from_gaps(gaps, 1e-6).unwrap().is_curved();
    for (seed, exponent) in (0..300).map(|seed| (seed, 1.0 + 0.01 * seed as f64)) {
        let off_centre = 0.3 * (seed as f64).sin();
        assert!(
            is_curved(body_of_power(exponent, 0.0, off_centre, seed, 1000)),
            "{exponent}"
        );
        assert!(
            is_curved(body_of_power(exponent, 0.01, off_centre, seed, 1000)),
            "{exponent}"
        );
    }
    // One long wave, with its crest in the middle or elsewhere.
    for shift in 0..20 {
        let wave = |index: u32| {
            1.0 - (2.0 * PI * (f64::from(index) / 1000.0 + 0.05 * f64::from(shift))).cos()
        };
        assert!(
            !is_curved(body::from_lowest(
                &(0..1000).map(wave).collect::<Vec<f64>>()
            )),
            "{shift}"
        );
    }
    let rough = (0..2000)
        .filter(|seed| is_curved(body::self_affine(0.1 + 0.0004 * *seed as f64, *seed, 1024)));
    let taken_for_curved = rough.count();
    println!("{taken_for_curved} of 2000 rough profiles are taken for curved bodies");
    assert!(taken_for_curved <= 20, "{taken_for_curved} of 2000");
}

/// Smooth curved heights are doubted to be a cut, with the radius of the sphere; rough ones and
/// stated forms are not.
#[test]
fn a_cut_through_a_sphere_is_doubted() {
    for (radius, spacing) in [(2e-4, 5e-8), (1.0, 1e-3), (3e-9, 1e-12)] {
        for off_centre in [0.0, 100.0, -311.5] {
            let depth = |index: u32| {
                let x = spacing * (f64::from(index) - 500.0 - off_centre);
                -x * x / (2.0 * radius)
            };
            let heights: Vec<f64> = (0..1001).map(depth).collect();
            let profile = Profile::from_heights(heights, spacing).unwrap();
            let Some(Warning::CutLikeHeights { radius: found }) = profile.doubt() else {
                panic!("{:?}", profile.doubt())
            };
            assert!((found / radius - 1.0).abs() < 1e-6, "{found} {radius}");
            assert_eq!(
                profile
                    .clone()
                    .with_nominal_form(NominalForm::Curved)
                    .doubt(),
                None
            );
            assert_eq!(profile.with_nominal_form(NominalForm::Flat).doubt(), None);
        }
    }
    let rough = Profile::from_gaps(body::self_affine(0.7, 3, 1024), 1e-6).unwrap();
    assert_eq!(rough.doubt(), Some(Warning::HeightsAsProfile));
    for few in 1..6 {
        let gaps: Vec<f64> = (0..few).map(|index| f64::from(index) * 1e-9).collect();
        assert_eq!(
            Profile::from_gaps(gaps, 1e-6).unwrap().doubt().is_some(),
            few > 1
        );
    }
    // A flat profile is its own equivalent.
    assert_eq!(
        Profile::from_gaps(vec![0.0; 64], 1e-6).unwrap().doubt(),
        None
    );
}

/// The contact of a curved body must end inside its profile, that of a flat one need not.
#[test]
fn a_contact_at_the_ends_of_a_curved_body_is_named() {
    let gaps: Vec<f64> = (-600..=600)
        .map(|index| (f64::from(index) * 1e-7).powi(2) / 1e-4)
        .collect();
    let names = |form: NominalForm, force: f64| {
        let profile = Profile::from_gaps(gaps.clone(), 1e-7)
            .unwrap()
            .with_nominal_form(form);
        let contact =
            Contact::builder(&profile, Modulus::effective(1e6).unwrap()).work_of_adhesion(0.05);
        let cycle = contact
            .build()
            .unwrap()
            .load(&[Move::ToForce(force), Move::ToSeparation])
            .unwrap();
        cycle
            .warnings()
            .iter()
            .map(|warning| warning.name().to_owned())
            .collect::<Vec<_>>()
    };
    let (light, heavy) = (1e-4, 1e-2);
    assert_eq!(names(NominalForm::Curved, light), [""; 0]);
    assert_eq!(names(NominalForm::Curved, heavy), ["contact_at_ends"]);
    assert_eq!(names(NominalForm::Flat, heavy), [""; 0]);
    assert_eq!(names(NominalForm::Unstated, light), ["cut_like_heights"]);
    assert_eq!(
        names(NominalForm::Unstated, heavy),
        ["contact_at_ends", "cut_like_heights"]
    );
}
