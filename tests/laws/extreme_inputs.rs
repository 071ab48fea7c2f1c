//! Numbers at the ends of what is allowed: no NaN, no infinity, and books that balance.

use super::*;
use asperity::contact::{ContactError, Direction, Stepwise};
use asperity::scene::{
    Adhesion, Edges, Form, Material, Numerics, Observer, Range, Roughness, Scene, Solver as Choice, check,
    field,
};
use asperity::simulation::{RunError, Simulation};

fn power_of_ten(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10_f64.powf(power))
}

/// A number of either sign, or zero.
fn signed(low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => power_of_ten(low, high),
        4 => power_of_ten(low, high).prop_map(|value| -value),
        1 => Just(0.0),
    ]
}

/// Gaps from 1e−15 to 1e15 m, all sizes at once or each line of one size.
fn extreme_gaps() -> impl Strategy<Value = Vec<f64>> {
    let mixed = prop::collection::vec(power_of_ten(-15.0, 15.0), 0..40);
    let alike = (power_of_ten(-15.0, 15.0), prop::collection::vec(0.0..1.0_f64, 0..40))
        .prop_map(|(size, gaps)| gaps.iter().map(|gap| size * gap).collect::<Vec<f64>>());
    (prop_oneof![mixed, alike], any::<prop::sample::Index>()).prop_map(|(mut gaps, place)| {
        gaps.insert(place.index(gaps.len() + 1), 0.0);
        gaps
    })
}

fn extreme_leg() -> impl Strategy<Value = Leg> {
    prop_oneof![
        4 => signed(-20.0, 15.0).prop_map(Leg::ToIndentation),
        4 => signed(-40.0, 30.0).prop_map(Leg::ToForce),
        1 => Just(Leg::ToTouch),
        1 => Just(Leg::ToZeroForce),
        1 => Just(Leg::ToSeparation),
    ]
}

/// What must hold of a leg that began with so many springs in contact.
fn check_leg(record: &LegRecord, before: u64, springs: u64) -> Result<(), TestCaseError> {
    prop_assert!(record.dissipated_energy.is_finite(), "{:?}", record.dissipated_energy);
    for point in record.curve.iter().chain([&record.largest, &record.smallest]) {
        prop_assert!(point.indentation.is_finite() && point.force.is_finite(), "{:?}", point);
        prop_assert!(point.springs <= springs && point.fragments <= point.springs, "{:?}", point);
        prop_assert_eq!(point.springs == 0, point.fragments == 0);
    }
    for pair in record.curve.windows(2) {
        let [before, after] = [pair[0].indentation, pair[1].indentation];
        let ordered = if record.direction == Direction::Loading { before <= after } else { before >= after };
        prop_assert!(ordered, "{} before {}", before, after);
    }
    let after = record.curve.last().unwrap().springs;
    prop_assert_eq!(before + record.joins - record.leaves, after);
    if record.direction == Direction::Unloading {
        let least = record.curve.iter().map(|point| point.force).fold(f64::INFINITY, f64::min);
        prop_assert!(
            record.smallest.force <= least || record.curve.len() < 3,
            "{:?} {}",
            record.smallest,
            least
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn every_number_is_finite(
        gaps in extreme_gaps(),
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        spacing in power_of_ten(-18.0, 1.0),
        effective_modulus in power_of_ten(0.0, 13.0),
        legs in prop::collection::vec(extreme_leg(), 1..8),
        samples in 2_usize..300,
    ) {
        let work = range * effective_modulus;
        let body = Body { gaps, foundation: Foundation::endless(spacing, effective_modulus), work };
        let springs = body.gaps.len() as u64;
        let tree = body.tree();
        let adhesive: Box<dyn Solver> = Box::new(body.on(&tree, samples));
        let bare: Box<dyn Solver> = Box::new(exact::nonadhesive(&body.gaps, Edges::Grid, body.foundation, samples));
        for mut solver in [adhesive, bare] {
            let mut thresholds = Vec::new();
            let mut held = 0;
            for &leg in &legs {
                match solver.advance(leg) {
                    Ok(record) => {
                        check_leg(&record, held, springs)?;
                        let end = record.curve.last().unwrap();
                        held = end.springs;
                        if held > 0 {
                            let fragments = solver.fragments(end.indentation);
                            prop_assert_eq!(fragments.len() as u64, end.fragments);
                            prop_assert_eq!(indices(&fragments).len() as u64, held);
                        }
                    }
                    Err(ContactError::LetsGoBefore { smallest, .. }) => prop_assert!(smallest.is_finite()),
                    Err(ContactError::NothingToPull { .. } | ContactError::OutOfReach { .. }) => {}
                    Err(error) => return Err(TestCaseError::fail(error.to_string())),
                }
                solver.thresholds_along_line(&mut thresholds);
                prop_assert!(!thresholds.iter().any(|threshold| threshold.is_nan()));
            }
        }
    }

    #[test]
    fn stepwise_as_well(
        gaps in extreme_gaps(),
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        step in power_of_ten(-15.0, 15.0),
        to in -50_i32..50,
    ) {
        let foundation = Foundation::endless(0.01, 1.0);
        let hess = (range > 0.0).then(|| HessRule::new(foundation, range));
        let mut solver = Stepwise::new(&gaps, hess, foundation, step, 9, &|| false).unwrap();
        let mut held = 0;
        for leg in [0.0, f64::from(to) * step, 0.5 * f64::from(to) * step].map(Leg::ToIndentation) {
            let record = solver.advance(leg).unwrap();
            check_leg(&record, held, gaps.len() as u64)?;
            held = record.curve.last().unwrap().springs;
        }
    }
}

/// A number from the range of a field of the scene, all orders of magnitude alike, its ends included.
fn within(path: &str, variant: Option<&str>) -> BoxedStrategy<f64> {
    let Some(Range::Real { min, max }) = field(path, variant).map(|field| field.range) else {
        panic!("{path} is no number")
    };
    let (min, max) = (min.value(), max.value());
    let least = if min > 0.0 { min } else { 1e-300_f64.min(max * 1e-3) };
    prop_oneof![
        1 => Just(min),
        1 => Just(max),
        2 => (0.0..1.0_f64).prop_map(move |share| min + share * (max - min)),
        6 => (least.ln()..max.ln()).prop_map(move |log| log.exp().clamp(min, max)),
    ]
    .boxed()
}

fn extreme_form() -> impl Strategy<Value = Option<Form>> {
    prop_oneof![
        Just(None),
        within("form.radius", Some("Paraboloid")).prop_map(|radius| Some(Form::Paraboloid { radius })),
        within("form.angle", Some("Cone")).prop_map(|angle| Some(Form::Cone { angle })),
        (within("form.coefficient", Some("Power")), within("form.exponent", Some("Power")))
            .prop_map(|(coefficient, exponent)| Some(Form::Power { coefficient, exponent })),
        within("form.radius", Some("Punch")).prop_map(|radius| Some(Form::Punch { radius })),
    ]
}

fn extreme_roughness() -> impl Strategy<Value = Option<Roughness>> {
    let amplitude = prop_oneof![
        within("roughness.rms_height", Some("SelfAffine")).prop_map(|height| (Some(height), None)),
        within("roughness.rms_gradient", Some("SelfAffine")).prop_map(|gradient| (None, Some(gradient))),
        Just((None, None)),
    ];
    let line = (within("roughness.hurst", Some("SelfAffine")), amplitude, 1_u64..9, 0_u64..9, any::<u64>());
    prop_oneof![
        1 => Just(None),
        3 => line.prop_map(|(hurst, (rms_height, rms_gradient), first, more, seed)| {
            let modes = (first, first + more);
            Some(Roughness::SelfAffine { hurst, rms_height, rms_gradient, modes, seed })
        }),
    ]
}

fn extreme_adhesion() -> impl Strategy<Value = Option<Adhesion>> {
    let work = within("adhesion.work", None).prop_map(Some).boxed();
    let kappa = within("adhesion.kappa", None).prop_map(Some).boxed();
    prop_oneof![
        Just((None, None)).boxed(),
        work.clone().prop_map(|work| (work, None)).boxed(),
        kappa.clone().prop_map(|kappa| (None, kappa)).boxed(),
        (work, kappa).boxed(),
    ]
    .prop_map(|(work, kappa)| (work.is_some() || kappa.is_some()).then_some(Adhesion { work, kappa }))
}

fn extreme_scene() -> impl Strategy<Value = Scene> {
    let leg = prop_oneof![
        signed(-30.0, 30.0).prop_map(Leg::ToForce),
        signed(-30.0, 6.0).prop_map(Leg::ToIndentation),
        Just(Leg::ToTouch),
        Just(Leg::ToZeroForce),
        Just(Leg::ToSeparation),
    ];
    let loading = prop_oneof![
        2 => prop::collection::vec(leg.clone(), 1..5),
        1 => leg.prop_map(|leg| vec![leg, Leg::ToSeparation]),
    ];
    (
        within("material.effective_modulus", None),
        within("length", None),
        extreme_form(),
        extreme_roughness(),
        extreme_adhesion(),
        loading,
        1_u64..64,
        2_u64..40,
    )
        .prop_map(|(modulus, length, form, roughness, adhesion, loading, points, samples)| Scene {
            version: 1,
            title: String::new(),
            notice: String::new(),
            material: Material {
                youngs_modulus: None,
                poisson_ratio: None,
                effective_modulus: Some(modulus),
            },
            length,
            form,
            roughness,
            adhesion,
            loading,
            numerics: Numerics { points, solver: Choice::Exact, edges: Edges::Grid, samples },
            observe: vec![Observer::Fragments, Observer::HeightHistogram],
        })
        .prop_filter("a scene that is allowed", |scene| check(scene).is_empty())
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 100_000, ..cases(3000) })]

    #[test]
    fn no_scene_that_is_allowed_gives_nan(scene in extreme_scene()) {
        match Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())) {
            Ok(outcome) => {
                for leg in &outcome.history.legs {
                    prop_assert!(leg.curve.iter().all(|point| point.force.is_finite()), "{:?}", leg);
                }
                let all = format!("{outcome:?}");
                prop_assert!(!all.contains("NaN"), "{}", all);
                prop_assert!(!all.contains("inf"), "{}", all);
            }
            Err(RunError::Surface(_)) => {}
            Err(RunError::Contact(
                ContactError::LetsGoBefore { .. }
                | ContactError::NothingToPull { .. }
                | ContactError::OutOfReach { .. },
            )) => {}
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        }
    }
}
