//! Fields against each other: what over- or under-determines a scene, and what one field makes
//! impossible in another.

use super::fields::{FIELDS, LEG_INDENTATION, field};
use super::model::{Adhesion, Edges, Form, Leg, Material, Roughness, Scene, Solver};
use super::text::{ron_float, ron_string};
use super::violation::{Found, Violation};
use crate::topography::{Unit, UnitError};

/// Most samples of all legs together; a curve of this size still fits the memory of a small machine.
const MOST_SAMPLES: u64 = 1 << 24;

/// Fewest springs of a wave about the axis of a form.
const SPRINGS_PER_WAVE: f64 = 4.0;

pub(super) fn check_consistency(scene: &Scene, found: &mut Found) {
    check_material(&scene.material, found);
    check_form(scene, found);
    check_modes(scene, found);
    check_unit(scene, found);
    check_measured(scene, found);
    check_closing_work(scene, found);
    check_amplitude(scene, found);
    check_loading(scene, found);
    check_edges(scene, found);
}

fn check_edges(scene: &Scene, found: &mut Found) {
    if matches!(scene.numerics.solver, Solver::Stepwise { .. }) && scene.numerics.edges == Edges::SubCell {
        let reason = "the stepwise solver moves whole springs: edges: Grid";
        found.add(inconsistency("numerics.edges", "SubCell", reason, &["numerics.solver"]));
    }
}

fn inconsistency(
    field: &str,
    value: impl Into<String>,
    reason: impl Into<String>,
    involves: &'static [&'static str],
) -> Violation {
    let (field, value, reason) = (field.to_string(), value.into(), reason.into());
    Violation { field, value, allowed: String::new(), reason, involves }
}

fn check_material(material: &Material, found: &mut Found) {
    let reason = match (material.effective_modulus, material.youngs_modulus, material.poisson_ratio) {
        (Some(_), None, None) => return,
        (None, Some(_), Some(_)) => {
            let modulus = material.effective_modulus();
            let range = field("material.effective_modulus", None).map(|field| field.range);
            if !found.has("material") && !range.is_some_and(|range| range.contains(modulus)) {
                found.add(Violation {
                    field: "material".into(),
                    value: format!("E* = {}", ron_float(modulus)),
                    allowed: field("material.effective_modulus", None)
                        .map_or_else(String::new, |field| field.allowed()),
                    reason: "effective modulus E/(1 − ν²)".into(),
                    involves: &["material.youngs_modulus", "material.poisson_ratio"],
                });
            }
            return;
        }
        (Some(_), ..) => "effective_modulus replaces youngs_modulus and poisson_ratio: give one or the other",
        (None, Some(_), None) => "youngs_modulus goes with poisson_ratio, which is missing",
        (None, None, Some(_)) => "poisson_ratio goes with youngs_modulus, which is missing",
        (None, None, None) => "give youngs_modulus with poisson_ratio, or effective_modulus",
    };
    let involves = &["material.effective_modulus", "material.youngs_modulus", "material.poisson_ratio"];
    found.add(inconsistency("material", "", reason, involves));
}

fn check_form(scene: &Scene, found: &mut Found) {
    let Some(form) = scene.form else {
        return;
    };
    if found.has("form") || found.has("length") {
        return;
    }
    if let Form::Punch { radius } = form {
        return check_punch(scene, radius, found);
    }
    if let Form::WavySphere { wavelength, .. } = form
        && !found.has("numerics.points")
        && wavelength < SPRINGS_PER_WAVE * scene.spacing()
    {
        found.add(Violation {
            field: "form.wavelength".into(),
            value: ron_float(wavelength),
            allowed: format!("at least {} m", ron_float(SPRINGS_PER_WAVE * scene.spacing())),
            reason: format!("a wave has at least {SPRINGS_PER_WAVE} springs: more points or longer waves"),
            involves: &["numerics.points", "length"],
        });
        return;
    }
    // The line carries the transformed profile, which is at most this many times higher.
    let rise = 20.0 * rise_at_end(form, scene.length / 2.0);
    if !LEG_INDENTATION.range.contains(rise) {
        let reason = format!(
            "the body rises too steeply: at the ends of the line it is higher than the {} m an indentation can reach",
            LEG_INDENTATION.range.max().unwrap_or_default()
        );
        // The first number of a form is its size; waves may be higher than their sphere.
        let is_by_waves = 2.0 * wave_rise(form, scene.length / 2.0) > rise_at_end(form, scene.length / 2.0);
        let size = FIELDS.iter().find(|field| {
            let is_size = !is_by_waves || field.path == "form.amplitude";
            field.parent() == "form" && is_size && field.get(scene).is_some()
        });
        let (path, value) = size.map_or(("form", None), |field| (field.path, field.written(scene)));
        found.add(inconsistency(
            path,
            value.unwrap_or_default(),
            reason,
            &["form", "form.exponent", "form.amplitude", "length"],
        ));
    }
}

/// The body's own profile f(r) at a radius, m.
fn rise_at_end(form: Form, radius: f64) -> f64 {
    match form {
        Form::Paraboloid { radius: curvature } => radius * radius / (2.0 * curvature),
        Form::Cone { angle } => radius * angle.tan(),
        Form::Power { coefficient, exponent } => coefficient * radius.powf(exponent),
        Form::WavySphere { radius: curvature, .. } => {
            radius * radius / (2.0 * curvature) + wave_rise(form, radius)
        }
        Form::Punch { .. } => 0.0,
    }
}

/// Part of the waves of a form in its rise at a radius, m: on the line they grow to about π A √(r/λ).
fn wave_rise(form: Form, radius: f64) -> f64 {
    match form {
        Form::WavySphere { amplitude, wavelength, .. } => {
            std::f64::consts::PI * amplitude * (radius / wavelength).max(1.0).sqrt()
        }
        _ => 0.0,
    }
}

fn check_punch(scene: &Scene, radius: f64, found: &mut Found) {
    if radius > scene.length / 2.0 {
        let reason = format!(
            "a punch is not wider than the line: at most length/2 = {}",
            ron_float(scene.length / 2.0)
        );
        found.add(inconsistency("form.radius", ron_float(radius), reason, &["length"]));
        return;
    }
    if !found.has("numerics.points") && scene.springs_under_body().is_empty() {
        let reason = format!(
            "no spring lies under the punch: the springs are {} m apart; more points or a larger radius",
            ron_float(scene.spacing())
        );
        found.add(inconsistency("form.radius", ron_float(radius), reason, &["length", "numerics.points"]));
    }
}

fn check_modes(scene: &Scene, found: &mut Found) {
    if let Some(Roughness::SelfAffine { modes: (first, last), .. }) = scene.roughness
        && last > scene.numerics.points / 2
        && !found.has("roughness.modes")
        && !found.has("numerics.points")
    {
        found.add(Violation {
            field: "roughness.modes".into(),
            value: format!("({first}, {last})"),
            allowed: format!("last mode at most points/2 = {}", scene.numerics.points / 2),
            reason: format!("{} springs carry no shorter wave", scene.numerics.points),
            involves: &["numerics.points"],
        });
    }
}

fn check_unit(scene: &Scene, found: &mut Found) {
    if let Some(Roughness::Measured { unit, .. }) = &scene.roughness
        && !unit.is_empty()
        && !found.has("roughness.unit")
        && unit.parse::<Unit>().is_err()
    {
        found.add(Violation {
            field: "roughness.unit".into(),
            value: ron_string(unit),
            allowed: UnitError::ALLOWED.into(),
            reason: "unit of the file".into(),
            involves: &[],
        });
    }
}

/// A profile is one row or one column; two faces have a spectrum together and no profile.
fn check_measured(scene: &Scene, found: &mut Found) {
    let Some(Roughness::Measured { opposite, row, column, .. }) = &scene.roughness else { return };
    if let (Some(_), Some(column)) = (row, column) {
        let reason = "a profile is a row or a column: give one of them";
        found.add(inconsistency("roughness.column", column.to_string(), reason, &["roughness.row"]));
    }
    if let Some(file) = opposite
        && scene.measured_as_line()
    {
        let reason = "spectra of two faces add, their profiles do not: give as_line: false";
        let involves: &[&str] = &["roughness.as_line", "version"];
        found.add(inconsistency("roughness.opposite", ron_string(file), reason, involves));
    }
}

/// A spring that attached with more energy than it detaches with would detach at once.
fn check_closing_work(scene: &Scene, found: &mut Found) {
    let Some(Adhesion { work, closing_work: Some(closing), .. }) = scene.adhesion else { return };
    if found.has("adhesion") {
        return;
    }
    match work {
        Some(work) if closing > work => found.add(Violation {
            field: "adhesion.closing_work".into(),
            value: ron_float(closing),
            allowed: format!("0 to {} J/m²", ron_float(work)),
            reason: "at most adhesion.work".into(),
            involves: &["adhesion.work"],
        }),
        Some(_) => {}
        None => {
            let reason = "closing_work goes with adhesion.work, which is missing: κ and e_el/γ refer to one work of adhesion";
            found.add(inconsistency("adhesion.closing_work", ron_float(closing), reason, &["adhesion.work"]));
        }
    }
}

/// Amplitude of the roughness, work of adhesion and κ or e_el/γ: any two determine the third.
fn check_amplitude(scene: &Scene, found: &mut Found) {
    let adhesion = scene.adhesion.unwrap_or_default();
    let Adhesion { work, kappa, elastic_energy_ratio, .. } = adhesion;
    let given = [work, kappa, elastic_energy_ratio].map(|value| value.is_some());
    let refused = match given {
        [false, false, false] if scene.adhesion.is_some() => "give work, kappa or elastic_energy_ratio",
        [_, true, true] => "kappa and elastic_energy_ratio determine each other: give one of them",
        _ => "",
    };
    if !refused.is_empty() {
        found.add(inconsistency("adhesion", "", refused, &GIVEN_BY));
        return;
    }
    let parameter = adhesion.parameter().map(|(parameter, _)| parameter);
    let amplitude = match scene.roughness {
        None => {
            if let Some(parameter) = parameter {
                let reason = format!(
                    "{} measures adhesion against roughness, and there is none: give roughness, or adhesion by work",
                    parameter.symbol()
                );
                found.add(inconsistency(parameter.path(), "", reason, &["roughness", "adhesion"]));
            }
            return;
        }
        Some(Roughness::Measured { .. }) => true,
        Some(Roughness::SelfAffine { rms_height: Some(_), rms_gradient: Some(_), .. }) => {
            let reason = "rms_height and rms_gradient determine each other: give one of them";
            found.add(inconsistency(
                "roughness",
                "",
                reason,
                &["roughness.rms_height", "roughness.rms_gradient"],
            ));
            return;
        }
        Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }) => {
            rms_height.is_some() || rms_gradient.is_some()
        }
    };
    let (field, reason) = match (amplitude, work, parameter) {
        (true, Some(_), Some(parameter)) => (
            "adhesion",
            format!(
                "roughness amplitude, work and {}: two determine the third, so leave one out or set it to None",
                parameter.name()
            ),
        ),
        (false, Some(0.0), Some(parameter)) => (
            "roughness",
            format!(
                "without work of adhesion {} does not set an amplitude: give rms_height or rms_gradient",
                parameter.symbol()
            ),
        ),
        (false, Some(_), Some(_)) | (true, ..) => return,
        (false, ..) => (
            "roughness",
            "the amplitude is missing: give rms_height or rms_gradient, or adhesion by work and kappa".into(),
        ),
    };
    found.add(inconsistency(field, "", reason, &AMPLITUDE));
}

/// Fields that may give adhesion.
const GIVEN_BY: [&str; 3] = ["adhesion.work", "adhesion.kappa", "adhesion.elastic_energy_ratio"];

/// Fields that determine the amplitude of the roughness.
const AMPLITUDE: [&str; 6] = [
    "roughness",
    "roughness.rms_height",
    "roughness.rms_gradient",
    "adhesion.work",
    "adhesion.kappa",
    "adhesion.elastic_energy_ratio",
];

fn check_loading(scene: &Scene, found: &mut Found) {
    let mut separated = true;
    for (index, leg) in scene.loading.iter().enumerate() {
        let pulls = match *leg {
            Leg::ToSeparation => Some("ToSeparation".to_string()),
            Leg::ToForce(force) if force < 0.0 => Some(format!("ToForce({})", ron_float(force))),
            _ => None,
        };
        if let (true, Some(value)) = (separated, pulls) {
            let reason =
                "from separation nothing can pull: press first, with ToTouch, ToForce or ToIndentation";
            found.add(inconsistency(&format!("loading.{index}"), value, reason, &["loading"]));
        }
        separated = *leg == Leg::ToSeparation;
    }
    let samples = (scene.loading.len() as u64).saturating_mul(scene.numerics.samples);
    if samples > MOST_SAMPLES && !found.has("numerics.samples") && !found.has("loading") {
        found.add(Violation {
            field: "numerics.samples".into(),
            value: scene.numerics.samples.to_string(),
            allowed: format!("at most {}", MOST_SAMPLES / (scene.loading.len() as u64).max(1)),
            reason: format!("{} legs have at most {MOST_SAMPLES} samples together", scene.loading.len()),
            involves: &["loading"],
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::RoughnessParameter;
    use super::super::check::check;
    use super::super::strategies::sound;
    use super::*;

    fn only(scene: &Scene) -> (String, String) {
        let violations = check(scene);
        assert_eq!(violations.len(), 1, "{violations:?}");
        (violations[0].field.clone(), violations[0].reason.clone())
    }

    #[test]
    fn a_material_is_determined_once() {
        for (effective_modulus, youngs_modulus, poisson_ratio, said) in [
            (Some(1e6), Some(1e6), Some(0.5), "one or the other"),
            (Some(1e6), Some(1e6), None, "one or the other"),
            (Some(1e6), None, Some(0.5), "one or the other"),
            (None, Some(1e6), None, "poisson_ratio, which is missing"),
            (None, None, Some(0.5), "youngs_modulus, which is missing"),
            (None, None, None, "give youngs_modulus with poisson_ratio, or"),
        ] {
            let mut scene = sound();
            scene.material = Material { youngs_modulus, poisson_ratio, effective_modulus };
            let (field, reason) = only(&scene);
            assert_eq!(field, "material");
            assert!(reason.contains(said), "{reason}");
        }
    }

    #[test]
    fn the_effective_modulus_is_in_its_range_too() {
        let material = |poisson_ratio| Material {
            youngs_modulus: Some(1e6),
            poisson_ratio: Some(poisson_ratio),
            effective_modulus: None,
        };
        let mut scene = sound();
        // Nearly −1: E* is enormous, though E and ν are in their ranges.
        scene.material = material(-1.0 + 1e-9);
        assert_eq!(only(&scene).0, "material");
        scene.material = material(-1.0 + 1e-6);
        assert_eq!(check(&scene), vec![]);
    }

    #[test]
    fn amplitude_work_and_kappa_determine_each_other() {
        let set = |height: bool, gradient: bool, adhesion: Option<(Option<f64>, Option<f64>)>| {
            let mut scene = sound();
            if let Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }) = &mut scene.roughness {
                *rms_height = height.then_some(1e-7);
                *rms_gradient = gradient.then_some(0.1);
            }
            scene.adhesion = adhesion.map(|(work, kappa)| Adhesion {
                work,
                ..kappa.map_or_else(Adhesion::default, |kappa| Adhesion::default().with_kappa(kappa))
            });
            scene
        };
        let (work, kappa) = (Some(0.05), Some(2.0));
        for sound in [
            set(true, false, None),
            set(false, true, Some((work, None))),
            set(true, false, Some((Some(0.0), None))),
            set(true, false, Some((None, kappa))),
            set(false, false, Some((work, kappa))),
        ] {
            assert_eq!(check(&sound), vec![]);
        }
        for (scene, field, said) in [
            (set(true, true, None), "roughness", "determine each other"),
            (set(true, true, Some((work, kappa))), "roughness", "determine each other"),
            (set(true, false, Some((work, kappa))), "adhesion", "determine the third"),
            (set(false, false, None), "roughness", "the amplitude is missing"),
            (set(false, false, Some((work, None))), "roughness", "the amplitude is missing"),
            (set(false, false, Some((None, kappa))), "roughness", "the amplitude is missing"),
            (set(false, false, Some((Some(0.0), kappa))), "roughness", "does not set an amplitude"),
            (set(true, false, Some((None, None))), "adhesion", "give work, kappa or elastic_energy_ratio"),
        ] {
            let (path, reason) = only(&scene);
            assert_eq!(path, field);
            assert!(reason.contains(said), "{reason}");
        }
    }

    #[test]
    fn the_work_of_closing_is_at_most_that_of_opening() {
        let mut scene = sound();
        for (work, closing, said) in [
            (Some(0.05), 0.0, None),
            (Some(0.05), 0.05, None),
            (Some(0.0), 0.0, None),
            (Some(0.05), 0.050_000_1, Some("at most adhesion.work")),
            (Some(0.0), 1e-9, Some("at most adhesion.work")),
            (None, 0.0, Some("goes with adhesion.work")),
        ] {
            let kappa = work.is_none().then_some(2.0);
            scene.adhesion =
                Some(Adhesion { work, closing_work: Some(closing), kappa, ..Adhesion::default() });
            match said {
                None => assert_eq!(check(&scene), vec![]),
                Some(said) => {
                    let (path, reason) = only(&scene);
                    assert_eq!(path, "adhesion.closing_work");
                    assert!(reason.contains(said), "{reason}");
                }
            }
        }
        for closing in [-1e-3, f64::NAN, 2e6] {
            scene.adhesion =
                Some(Adhesion { closing_work: Some(closing), ..Adhesion::default().with_work(0.05) });
            assert!(check(&scene).iter().all(|found| found.field == "adhesion.closing_work"));
            assert!(!check(&scene).is_empty());
        }
    }

    #[test]
    fn parameters_of_roughness_need_roughness_and_exclude_each_other() {
        let smooth = Scene { roughness: None, ..sound() };
        assert_eq!(check(&smooth), vec![]);
        let measured = Scene { roughness: Some(Roughness::measured("line.csv")), ..sound() };
        for parameter in RoughnessParameter::ALL {
            let given = Adhesion::default().with_parameter(parameter, 2.0);
            let with = |scene: &Scene, adhesion| Scene { adhesion: Some(adhesion), ..scene.clone() };
            let (field, reason) = only(&with(&smooth, given));
            assert_eq!(field, parameter.path());
            assert!(reason.starts_with(parameter.symbol()), "{reason}");
            assert_eq!(check(&with(&measured, given)), vec![]);
            let (field, reason) = only(&with(&measured, Adhesion { work: Some(0.05), ..given }));
            assert_eq!(field, "adhesion");
            assert!(reason.contains(parameter.name()), "{reason}");
            let both = Adhesion { kappa: Some(2.0), elastic_energy_ratio: Some(1.0), ..given };
            for scene in [&smooth, &measured] {
                let (field, reason) = only(&with(scene, both));
                assert_eq!(field, "adhesion");
                assert!(reason.contains("give one of them"), "{reason}");
            }
        }
    }

    #[test]
    fn no_wave_is_shorter_than_two_springs() {
        let mut scene = sound();
        for (points, sound) in [(1024, true), (1025, true), (1023, false), (1, false)] {
            scene.numerics.points = points;
            assert_eq!(check(&scene).is_empty(), sound, "{points}");
        }
        scene.numerics.points = 64;
        let violations = check(&scene);
        assert_eq!(violations[0].allowed, "last mode at most points/2 = 32");
        assert_eq!(violations[0].value, "(1, 512)");
    }

    #[test]
    fn a_punch_is_on_the_line_and_over_a_spring() {
        let mut scene = sound();
        scene.roughness = None;
        for points in [1, 2, 3, 4096, 4097] {
            scene.numerics.points = points;
            let spacing = scene.spacing();
            // Below a quarter of the spacing its diameter is nearer to no cell than to one.
            for (radius, sound) in
                [(5e-5, true), (5.1e-5, false), (0.26 * spacing, true), (0.24 * spacing, false)]
            {
                scene.form = Some(Form::Punch { radius });
                assert_eq!(check(&scene).is_empty(), sound, "{radius} on {points} points");
            }
        }
    }

    #[test]
    fn a_body_does_not_rise_beyond_all_indentations() {
        let mut scene = sound();
        scene.length = 10.0;
        for form in [
            Form::Paraboloid { radius: 1e-300 },
            Form::Cone { angle: std::f64::consts::FRAC_PI_2 - 1e-9 },
            Form::Power { coefficient: 1e300, exponent: 100.0 },
        ] {
            scene.form = Some(form);
            assert!(only(&scene).1.contains("rises too steeply"));
        }
        // Waves are named where they are what rises.
        scene.length = 1.0;
        for (radius, amplitude, field) in [(1.0, 1e6, "form.amplitude"), (1e-6, 1e-9, "form.radius")] {
            scene.form = Some(Form::WavySphere { radius, amplitude, wavelength: 0.1 });
            let (named, reason) = only(&scene);
            assert!(named == field && reason.contains("rises too steeply"), "{named}: {reason}");
        }
    }

    #[test]
    fn nothing_is_pulled_that_does_not_touch() {
        use Leg::*;
        let mut scene = sound();
        for (loading, field) in [
            (vec![ToSeparation], "loading.0"),
            (vec![ToForce(-1e-6)], "loading.0"),
            (vec![ToTouch, ToSeparation, ToForce(-1.0)], "loading.2"),
            (vec![ToTouch, ToSeparation, ToSeparation], "loading.2"),
        ] {
            scene.loading = loading;
            assert_eq!(only(&scene).0, field);
        }
        // No force is no pull.
        scene.loading = vec![ToForce(1.0), ToForce(-1e-6), ToTouch, ToSeparation, ToForce(0.0), ToZeroForce];
        assert_eq!(check(&scene), vec![]);
    }

    #[test]
    fn samples_of_all_legs_are_bounded_together() {
        let mut scene = sound();
        scene.loading = vec![Leg::ToTouch; 1 << 14];
        scene.numerics.samples = 1 << 10;
        assert_eq!(check(&scene), vec![]);
        scene.numerics.samples += 1;
        assert_eq!(only(&scene).0, "numerics.samples");
    }
}
