//! Tests of fits of one curve: parameters, intervals, bounds, and the number of computed curves.

use super::*;
use crate::common::{
    Made, fit_from, fitted, gauss, measured, on_rubber, random, read, rubber, rubber_of, truth,
};
use crate::curve::numerics::dot;
use crate::fit::reason::Reason;
use crate::read::options::Drift;
use asperity_contact::Move;
use asperity_data::Remedy;

/// Asserts that the values differ from the truth by at most a few standard errors, and that the
/// residuals are as large as the noise.
fn assert_found(made: &Made, fit: &FitResult) {
    assert!(fit.describes() && fit.misfit < 1.1, "{}", fit.misfit);
    for found in &fit.parameters {
        let truth = truth(made, found.parameter);
        assert!(
            (found.value - truth).abs() < 4.0 * found.noise_error,
            "{found:?}: {truth:e}"
        );
        assert!(found.noise_error < 0.02 * truth, "{found:?}");
    }
}

/// The fit to the curve of a rough sphere, whose force jumps at many displacements, finds the
/// parameters within their errors.
#[test]
fn a_rough_sphere_is_found_within_its_errors() {
    let made = random(13, 1024);
    let curve = measured(&made, 13);
    assert_found(&made, &fitted(&curve, &made, "work,offset"));
}

#[test]
fn a_sphere_is_found_within_its_errors_and_written_into_its_scene() {
    let made = random(4, 512);
    let curve = measured(&made, 4);
    let fit = fitted(&curve, &made, "work,modulus,offset");
    assert_found(&made, &fit);
    // The forces of the model include the zero and the drift of the curve, so the residual is the
    // difference between the forces of the curve and of the model.
    let in_contact = curve.in_contact();
    let squares = curve
        .force
        .iter()
        .zip(&fit.model)
        .zip(&in_contact)
        .filter(|(_, touches)| **touches)
        .map(|((force, model), _)| (force - model).powi(2));
    let residual = (squares.sum::<f64>() / fit.agreement.points as f64).sqrt();
    assert!(
        (residual / fit.residual - 1.0).abs() < 1e-9,
        "{residual} {}",
        fit.residual
    );
    assert!((fit.residual / curve.noise / fit.residual_over_noise - 1.0).abs() < 1e-9);
    let work = fit.parameters[0].value;
    assert_eq!(serde_json::json!(fit)["parameters"]["work"]["value"], work);
    let scene = fit.document.scene();
    assert_eq!(scene.adhesion.unwrap().work(), Some(work));
    assert!(
        matches!(scene.loading[..], [Move::ToDisplacement(at), Move::ToSeparation] if at > 0.0)
    );
}

/// The contact point lies between two points. If the offset is not fitted, its error shifts the
/// modulus beyond its interval, and a sentence says so.
#[test]
fn an_offset_that_is_not_fitted_is_named() {
    let made = random(4, 512);
    let curve = measured(&made, 4);
    let [fixed, free] =
        ["work,modulus", "work,modulus,offset"].map(|free| fitted(&curve, &made, free));
    let truth = truth(&made, Parameter::Modulus);
    let holds = |fit: &FitResult| {
        let (low, high) = fit.parameters[1].interval;
        (low..=high).contains(&truth)
    };
    assert!(holds(&free), "{truth:e} {:?}", free.parameters);
    let width = |fit: &FitResult| {
        let (low, high) = fit.parameters[1].interval;
        (high - low) / truth
    };
    assert!(width(&fixed) < 0.9 * width(&free));
    let value = fixed.parameters[1].value;
    assert!((value / truth - 1.0).abs() < width(&free), "{value:e}");
    let of_offset = |fit: &FitResult| {
        let mut remedies = fit.assumptions.iter().flat_map(Note::remedies);
        remedies.any(|remedy| *remedy == Remedy::Free("offset".to_owned()))
    };
    assert!(
        of_offset(&fixed) && !of_offset(&free),
        "{:?}",
        fixed.assumptions
    );
}

/// A point in the middle of the jump at pull-off changes neither the fit nor the number of
/// computed curves. Points elsewhere that are as far from the model increase the misfit.
#[test]
fn a_point_inside_a_jump_counts_as_described() {
    let made = random(4, 512);
    let curve = measured(&made, 4);
    let clean = fitted(&curve, &made, "work,modulus,offset");
    let rise = |index: &usize| curve.force[*index] - curve.force[index - 1];
    let retraction = curve.segment.partition_point(|segment| *segment == 0) + 1;
    let jump = (retraction..1000)
        .max_by(|first, second| rise(first).total_cmp(&rise(second)))
        .unwrap();
    let half = 0.5 * rise(&jump);
    assert!(half > 10.0 * curve.noise, "{half:e} {:e}", curve.noise);
    let with = |points: &[usize]| {
        let mut curve = curve.clone();
        points.iter().for_each(|index| curve.force[*index] -= half);
        fitted(&curve, &made, "work,modulus,offset")
    };
    let inside = with(&[jump]);
    assert!(
        inside.describes() && inside.misfit < 1.02 * clean.misfit,
        "{} {}",
        inside.misfit,
        clean.misfit
    );
    assert!(
        inside.evaluations < clean.evaluations * 5 / 4,
        "{} {}",
        inside.evaluations,
        clean.evaluations
    );
    let mut before = curve.clone();
    before.force[jump - 1] += half;
    let before = fitted(&before, &made, "work,modulus,offset").agreement;
    let residual = clean.agreement.residual;
    assert!(
        before.at_jumps > 0.0 && before.residual < 1.05 * residual,
        "{before:?} {residual:e}"
    );
    let apart: Vec<usize> = (1..11).map(|step| jump - 10 * step).collect();
    assert!(with(&apart).misfit > 1.2 * clean.misfit);
}

/// The rough sphere has a pull-off force 50 times smaller than that of a smooth sphere.
#[test]
fn a_range_that_ends_below_the_work_of_adhesion_is_extended() {
    let made = random(67, 4096);
    let curve = measured(&made, 67);
    let fit = fitted(&curve, &made, "work,offset");
    let (work, truth) = (fit.parameters[0], truth(&made, Parameter::Work));
    assert!(
        truth > 31.0 * work.start && work.range.1 > 800.0 * work.start,
        "{work:?}"
    );
    let width = work.interval.1 - work.interval.0;
    assert!(
        fit.describes() && (work.value - truth).abs() < width,
        "{work:?} {truth:e}"
    );
    assert!(
        (work.value / truth - 1.0).abs() < 0.02,
        "{work:?} {truth:e}"
    );
    let Free { parameter, .. } = "work".parse().unwrap();
    let given = [
        Free {
            parameter,
            range: Some((0.0, 30.0 * work.start)),
        },
        "offset".parse().unwrap(),
    ];
    let document = Document::from_scene(&made.scene, "made").unwrap();
    let bounded = find(
        &curve,
        &document,
        &given,
        &mut Simulation::default(),
        &|| false,
        &mut |_| (),
    )
    .unwrap();
    assert_eq!(bounded.parameters[0].range, given[0].range.unwrap());
}

/// The profile of the specimen is not the random profile of the scene. Then each interval is the
/// whole range, so that no interval excludes the true value, and the reason of the misfit names the
/// profile.
#[test]
fn another_random_profile_has_the_whole_range_as_interval() {
    let mut made = random(13, 1024);
    let curve = measured(&made, 13);
    made.scene.set_seed(99);
    let fit = fitted(&curve, &made, "work,modulus,offset");
    assert!(
        fit.has_other_profile() && fit.reason == Some(Reason::OtherProfile),
        "{:?}",
        fit.reason
    );
    for found in &fit.parameters[..2] {
        assert_eq!(found.interval, found.range);
        let truth = truth(&made, found.parameter);
        assert!(
            found.interval.0 < truth && truth < found.interval.1,
            "{found:?}"
        );
    }
}

/// For any initial work of adhesion, the upper bound is at most a few times the work of
/// adhesion whose pull-off force equals the noise, γ = noise/(1.5 π R) = 1.1 mJ/m².
#[test]
fn a_curve_without_adhesion_has_an_upper_bound_of_it() {
    for (seed, work) in [(1, 0.05), (2, 1e-6)] {
        let curve = read(rubber(4e-8, seed, |_, _| 1.0).into_iter(), Drift::Keep);
        let fit = fit_from(&curve, &on_rubber(work, 2.7e6), "work,modulus,offset");
        let [work, modulus, _] = fit.parameters[..] else {
            panic!("{:?}", fit.parameters)
        };
        assert!(fit.describes() && work.interval.0 == 0.0, "{fit:?}");
        assert!((2e-4..5e-3).contains(&work.interval.1), "{work:?}");
        assert_eq!(fit.work_at_most, Some(work.interval.1));
        assert_eq!(
            fit.not_distinguished
                .iter()
                .filter(|pair| pair.0 == Parameter::Work)
                .count(),
            1
        );
        assert!(
            modulus.interval.0 < 2e6 && 2e6 < modulus.interval.1,
            "{modulus:?}"
        );
    }
}

/// A tension in contact counts as adhesion if the negative log-likelihood (cost) of a model
/// without adhesion is larger by 1.96²/2 = 1.9. The cost is larger by 2.4 for a tension of one
/// standard deviation of the noise, and by 1.5 for half this tension.
#[test]
fn a_tension_beyond_the_noise_is_adhesion() {
    let bound = |times: f64| {
        let pulled = |(at, force): (f64, f64)| {
            (
                at,
                if at > 2.001e-6 {
                    force - times * 4e-8
                } else {
                    force
                },
            )
        };
        let mut curve = read(
            rubber(4e-8, 1, |_, _| 1.0).into_iter().map(pulled),
            Drift::Keep,
        );
        curve.touch = 2e-6;
        fit_from(&curve, &on_rubber(1e-3, 2e6), "work,offset").work_at_most
    };
    assert!(bound(0.5).is_some() && bound(1.0).is_none());
}

/// The contact stiffens and has a hysteresis, which the model does not describe. Parts of one
/// curve nevertheless give overlapping intervals, and the residual is correct.
#[test]
fn parts_of_a_curve_that_is_not_described_have_intervals_that_overlap() {
    let points = rubber(1e-9, 3, |indentation, direction| {
        1.0 + 0.3 * indentation.max(0.0) / 1e-6 + 0.1 * direction
    });
    let fits = [0, 1].map(|part| {
        let curve = read(points.iter().copied().skip(part).step_by(2), Drift::Keep);
        fit_from(&curve, &on_rubber(1e-3, 2.7e6), "work,modulus,offset")
    });
    for fit in &fits {
        assert!(
            !fit.describes() && fit.misfit > 10.0 && fit.beyond_five_sigma > 0.2,
            "{fit:?}"
        );
        assert!(fit.reason.is_some(), "{fit:?}");
        assert!(
            (fit.residual_over_noise / fit.misfit - 0.8).abs() < 0.2,
            "{fit:?}"
        );
    }
    for (one, other) in fits[0].parameters.iter().zip(&fits[1].parameters) {
        let overlap = one.interval.1.min(other.interval.1) - one.interval.0.max(other.interval.0);
        assert!(
            overlap > 0.2 * (one.interval.1 - one.interval.0),
            "{one:?} {other:?}"
        );
    }
    let modulus = fits[0].parameters[1];
    assert!(
        modulus.interval.1 / modulus.interval.0 > 1.02,
        "{modulus:?}"
    );
}

/// Ranges and initial values follow from the curve, so the values of free parameters in the
/// scene do not change a single bit of the result.
#[test]
fn a_start_a_thousand_times_off_changes_nothing() {
    let curve = read(rubber(1e-8, 2, |_, _| 1.0).into_iter(), Drift::Keep);
    let [one, other, stiff] = [(1e-6, 2e3), (50.0, 2e9), (1e-6, 2e3)]
        .map(|(work, modulus)| on_rubber(work, modulus))
        .map(|document| fit_from(&curve, &document, "work,modulus,offset"));
    assert_eq!(
        (&one.parameters, one.evaluations),
        (&other.parameters, other.evaluations)
    );
    assert_eq!(
        (one.document.text(), &one.parameters),
        (other.document.text(), &stiff.parameters)
    );
    let start = one.parameters[1].start;
    assert!((1e6..4e6).contains(&start), "{start:e}");
}

/// If the model does not describe a curve with many points, it is fitted to a part of the
/// points, and the search stops a second population early.
#[test]
fn few_curves_are_computed_where_the_model_does_not_describe_the_curve() {
    let stiffens = |indentation: f64, direction: f64| {
        1.0 + 0.3 * indentation.max(0.0) / 1e-6 + 0.1 * direction
    };
    let curve = read(rubber_of(500, 1e-9, 3, stiffens).into_iter(), Drift::Keep);
    let fit = fit_from(&curve, &on_rubber(1e-3, 2.7e6), "work,modulus,offset");
    assert!(
        fit.reason.is_some() && fit.evaluations < 15_000,
        "{}",
        fit.evaluations
    );
    assert_eq!(fit.model.len(), 1000);
    let described = read(rubber(1e-8, 2, |_, _| 1.0).into_iter(), Drift::Keep);
    let fit = fit_from(&described, &on_rubber(1e-3, 2.7e6), "work,modulus,offset");
    assert!(
        fit.reason.is_none() && fit.evaluations < 7_000,
        "{}",
        fit.evaluations
    );
}

/// A parameter is undetermined if its interval is wider than a factor e on either side.
#[test]
fn a_parameter_is_determined_within_a_factor_e() {
    let plain = read(rubber(1e-9, 1, |_, _| 1.0).into_iter(), Drift::Keep);
    let found = |share: f64| {
        let mut curve = plain.clone();
        curve.noise = share * dot(&curve.force, &curve.force).sqrt();
        let noise = gauss(curve.noise, 4);
        curve
            .force
            .iter_mut()
            .zip(noise)
            .for_each(|(force, noise)| *force += noise);
        fit_from(&curve, &on_rubber(1e-6, 2e6), "modulus=1e5..1e7").not_distinguished
    };
    assert_eq!(found(0.05), []);
    assert_eq!(found(0.2), [(Parameter::Modulus, Parameter::Modulus)]);
}
