//! Fields against each other: what over- or under-determines a scene, and what one field makes
//! impossible in another.

use super::check::{Found, Violation};
use super::fields::{LEG_INDENTATION, field};
use super::model::{Adhesion, Form, Leg, Material, Roughness, Scene};
use super::write::ron_float;

/// Most samples of all legs together; a curve of this size still fits the memory of a small machine.
const MOST_SAMPLES: u64 = 1 << 24;

impl Material {
    /// Effective modulus E* of eq. (2), Pa. NaN where the material is not determined, which
    /// [`check`](super::check()) refuses.
    pub fn effective_modulus(&self) -> f64 {
        match (self.effective_modulus, self.youngs_modulus, self.poisson_ratio) {
            (Some(modulus), None, None) => modulus,
            // (1 − ν)(1 + ν) keeps its digits where ν is close to −1; 1 − ν² does not.
            (None, Some(modulus), Some(ratio)) => modulus / ((1.0 - ratio) * (1.0 + ratio)),
            _ => f64::NAN,
        }
    }
}

impl Scene {
    /// Distance Δx = L/N of the springs, m.
    pub fn spacing(&self) -> f64 {
        self.length / self.numerics.points as f64
    }
}

pub(super) fn check_agreement(scene: &Scene, found: &mut Found) {
    check_material(&scene.material, found);
    check_form(scene, found);
    check_modes(scene, found);
    check_amplitude(scene, found);
    check_loading(scene, found);
}

fn disagreement(
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
        (Some(_), ..) => {
            "effective_modulus stands in place of youngs_modulus and poisson_ratio: give one or the other"
        }
        (None, Some(_), None) => "youngs_modulus goes with poisson_ratio, which is missing",
        (None, None, Some(_)) => "poisson_ratio goes with youngs_modulus, which is missing",
        (None, None, None) => "give youngs_modulus with poisson_ratio, or effective_modulus",
    };
    let involves = &["material.effective_modulus", "material.youngs_modulus", "material.poisson_ratio"];
    found.add(disagreement("material", "", reason, involves));
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
    // The line carries the transformed profile, which is at most this many times higher.
    let rise = 20.0 * rise_at_end(form, scene.length / 2.0);
    if !LEG_INDENTATION.contains(rise) {
        let (path, value) = match form {
            Form::Paraboloid { radius } | Form::Punch { radius } => ("form.radius", radius),
            Form::Cone { angle } => ("form.angle", angle),
            Form::Power { coefficient, .. } => ("form.coefficient", coefficient),
        };
        let reason = format!(
            "the body rises too steeply: at the ends of the line it is higher than the {} m an indentation can reach",
            LEG_INDENTATION.max().unwrap_or_default()
        );
        found.add(disagreement(path, ron_float(value), reason, &["form", "form.exponent", "length"]));
    }
}

/// The body's own profile f(r) at a radius, m.
fn rise_at_end(form: Form, radius: f64) -> f64 {
    match form {
        Form::Paraboloid { radius: curvature } => radius * radius / (2.0 * curvature),
        Form::Cone { angle } => radius * angle.tan(),
        Form::Power { coefficient, exponent } => coefficient * radius.powf(exponent),
        Form::Punch { .. } => 0.0,
    }
}

fn check_punch(scene: &Scene, radius: f64, found: &mut Found) {
    if radius > scene.length / 2.0 {
        let reason = format!(
            "a punch is not wider than the line: at most length/2 = {}",
            ron_float(scene.length / 2.0)
        );
        found.add(disagreement("form.radius", ron_float(radius), reason, &["length"]));
        return;
    }
    // The springs next to the axis: one of them is the nearest, whichever way x is rounded.
    let middle = scene.numerics.points / 2;
    let touches = |index: u64| {
        let x = (index as f64 + 0.5) * scene.spacing();
        index < scene.numerics.points && (x - scene.length / 2.0).abs() <= radius
    };
    let touched = (middle.saturating_sub(1)..=middle.saturating_add(1)).any(touches);
    if !touched && !found.has("numerics.points") {
        let reason = format!(
            "no spring stands under the punch: the springs are {} m apart; more points or a larger radius",
            ron_float(scene.spacing())
        );
        found.add(disagreement("form.radius", ron_float(radius), reason, &["length", "numerics.points"]));
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

/// Amplitude of the roughness, work of adhesion and κ: any two determine the third.
fn check_amplitude(scene: &Scene, found: &mut Found) {
    let (work, kappa) = match scene.adhesion {
        Some(Adhesion { work: None, kappa: None }) => {
            found.add(disagreement(
                "adhesion",
                "",
                "give work or kappa",
                &["adhesion.work", "adhesion.kappa"],
            ));
            return;
        }
        Some(Adhesion { work, kappa }) => (work, kappa.is_some()),
        None => (None, false),
    };
    let amplitude = match scene.roughness {
        None if kappa => {
            let reason = "κ measures adhesion against roughness, and there is none: give roughness, or adhesion by work";
            found.add(disagreement("adhesion.kappa", "", reason, &["roughness", "adhesion"]));
            return;
        }
        None => return,
        Some(Roughness::Measured { .. }) => true,
        Some(Roughness::SelfAffine { rms_height: Some(_), rms_gradient: Some(_), .. }) => {
            let reason = "rms_height and rms_gradient determine each other: give one of them";
            found.add(disagreement(
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
    let involves: &[&str] =
        &["roughness", "roughness.rms_height", "roughness.rms_gradient", "adhesion.work", "adhesion.kappa"];
    match (amplitude, work, kappa) {
        (true, Some(_), true) => {
            let reason = "the roughness with work or kappa determines the third: leave one of them out";
            found.add(disagreement("adhesion", "", reason, involves));
        }
        (false, Some(0.0), true) => {
            let reason =
                "without work of adhesion κ does not set an amplitude: give rms_height or rms_gradient";
            found.add(disagreement("roughness", "", reason, involves));
        }
        (false, Some(_), true) | (true, ..) => {}
        (false, ..) => {
            let reason =
                "the amplitude is missing: give rms_height or rms_gradient, or adhesion by work and kappa";
            found.add(disagreement("roughness", "", reason, involves));
        }
    }
}

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
            found.add(disagreement(&format!("loading.{index}"), value, reason, &["loading"]));
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
