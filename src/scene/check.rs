//! What a scene may not say: every field against its range, then the fields against each other.
//!
//! Nothing here allocates in proportion to what a scene asks for, so a scene that asks for too much
//! is refused before anything is built.

use super::agree::check_agreement;
use super::fields::{LEG_FORCE, LEG_INDENTATION, field};
use super::model::{Adhesion, Form, Leg, Material, Roughness, Scene, Solver};
use super::range::Range;
use super::write::{ron_float, ron_string};
use crate::text::is_control;

/// Something a scene says that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Path of the field; a leg is `loading.0`.
    pub field: String,
    /// Its value as it would be written; empty where nothing is written.
    pub value: String,
    /// What is allowed there; empty where `reason` says it all.
    pub allowed: String,
    /// Why, or the field's name.
    pub reason: String,
    /// Other fields that take part, by path: changing one of them may mend it as well.
    pub involves: &'static [&'static str],
}

/// All that is not allowed in a scene, in the order of its fields; empty for a scene that can be
/// computed.
pub fn check(scene: &Scene) -> Vec<Violation> {
    let mut found = Found::default();
    found.whole("version", None, u64::from(scene.version));
    found.text("title", None, &scene.title);
    found.text("notice", None, &scene.notice);
    check_material(&scene.material, &mut found);
    found.number("length", None, scene.length);
    if let Some(form) = &scene.form {
        check_form(form, &mut found);
    }
    if let Some(roughness) = &scene.roughness {
        check_roughness(roughness, &mut found);
    }
    if let Some(Adhesion { work, kappa }) = scene.adhesion {
        found.optional("adhesion.work", None, work);
        found.optional("adhesion.kappa", None, kappa);
    }
    check_loading(&scene.loading, &mut found);
    found.whole("numerics.points", None, scene.numerics.points);
    if let Solver::Stepwise { step } = scene.numerics.solver {
        found.number("numerics.solver.step", Some("Stepwise"), step);
    }
    found.whole("numerics.samples", None, scene.numerics.samples);
    found.count("observe", scene.observe.len());
    check_agreement(scene, &mut found);
    found.violations
}

/// The violations found so far.
#[derive(Default)]
pub(super) struct Found {
    violations: Vec<Violation>,
}

impl Found {
    /// Adds a violation that the fields' own ranges do not tell.
    pub(super) fn add(&mut self, violation: Violation) {
        self.violations.push(violation);
    }

    /// Whether a field, or anything inside it, has been found wrong already.
    pub(super) fn has(&self, path: &str) -> bool {
        self.violations.iter().any(|violation| {
            violation.field.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        })
    }

    fn outside(&mut self, path: &str, variant: Option<&str>, value: String) {
        let (allowed, reason) = field(path, variant)
            .map_or_else(Default::default, |field| (field.allowed(), field.name.to_string()));
        self.add(Violation { field: path.to_string(), value, allowed, reason, involves: &[] });
    }

    fn number(&mut self, path: &str, variant: Option<&str>, value: f64) {
        if !field(path, variant).is_some_and(|field| field.range.contains(value)) {
            self.outside(path, variant, ron_float(value));
        }
    }

    fn optional(&mut self, path: &str, variant: Option<&str>, value: Option<f64>) {
        if let Some(value) = value {
            self.number(path, variant, value);
        }
    }

    fn whole(&mut self, path: &str, variant: Option<&str>, value: u64) {
        if !field(path, variant).is_some_and(|field| field.range.contains_whole(value)) {
            self.outside(path, variant, value.to_string());
        }
    }

    fn text(&mut self, path: &str, variant: Option<&str>, text: &str) {
        let Some(Range::Text { most, lines }) = field(path, variant).map(|field| field.range) else {
            return;
        };
        // Control characters would reach the terminal of whoever opens the scene.
        let forbidden = |c: char| is_control(c) && !(lines && c == '\n');
        if let Some(c) = text.chars().find(|c| forbidden(*c)) {
            let allowed =
                if lines { "no control characters but line breaks" } else { "no control characters" };
            self.add(Violation {
                field: path.to_string(),
                value: format!("text with {:?}", c),
                allowed: allowed.to_string(),
                reason: field(path, variant).map_or_else(String::new, |field| field.name.to_string()),
                involves: &[],
            });
        } else if text.chars().count() > most {
            self.outside(path, variant, format!("{} characters", text.chars().count()));
        }
    }

    fn count(&mut self, path: &str, count: usize) {
        let Some(Range::List { least, most, .. }) = field(path, None).map(|field| field.range) else {
            return;
        };
        if count < least || count > most {
            let value = if count == 0 { "[]".to_string() } else { format!("a list of {count}") };
            self.outside(path, None, value);
        }
    }
}

fn check_material(material: &Material, found: &mut Found) {
    found.optional("material.youngs_modulus", None, material.youngs_modulus);
    found.optional("material.poisson_ratio", None, material.poisson_ratio);
    found.optional("material.effective_modulus", None, material.effective_modulus);
}

fn check_form(form: &Form, found: &mut Found) {
    match *form {
        Form::Paraboloid { radius } => found.number("form.radius", Some("Paraboloid"), radius),
        Form::Cone { angle } => found.number("form.angle", Some("Cone"), angle),
        Form::Power { coefficient, exponent } => {
            found.number("form.coefficient", Some("Power"), coefficient);
            found.number("form.exponent", Some("Power"), exponent);
        }
        Form::Punch { radius } => found.number("form.radius", Some("Punch"), radius),
    }
}

fn check_roughness(roughness: &Roughness, found: &mut Found) {
    match roughness {
        Roughness::SelfAffine { hurst, rms_height, rms_gradient, modes: (first, last), seed: _ } => {
            let variant = Some("SelfAffine");
            found.number("roughness.hurst", variant, *hurst);
            found.optional("roughness.rms_height", variant, *rms_height);
            found.optional("roughness.rms_gradient", variant, *rms_gradient);
            let modes = field("roughness.modes", variant).map(|field| field.range);
            let inside = |mode: u64| modes.is_some_and(|modes| modes.contains_whole(mode));
            if first > last || !inside(*first) || !inside(*last) {
                found.outside("roughness.modes", variant, format!("({first}, {last})"));
            }
        }
        Roughness::Measured { file } => {
            found.text("roughness.file", Some("Measured"), file);
            if file.is_empty() {
                found.outside("roughness.file", Some("Measured"), ron_string(file));
            }
        }
    }
}

fn check_loading(loading: &[Leg], found: &mut Found) {
    found.count("loading", loading.len());
    for (index, leg) in loading.iter().enumerate() {
        let (value, field) = match *leg {
            Leg::ToForce(force) => (force, LEG_FORCE),
            Leg::ToIndentation(indentation) => (indentation, LEG_INDENTATION),
            Leg::ToTouch | Leg::ToZeroForce | Leg::ToSeparation => continue,
        };
        if !field.range.contains(value) {
            found.add(Violation {
                field: format!("loading.{index}.0"),
                value: ron_float(value),
                allowed: field.allowed(),
                reason: field.name.to_string(),
                involves: &[],
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::sound;
    use super::*;

    fn fields_of(scene: &Scene) -> Vec<String> {
        check(scene).into_iter().map(|violation| violation.field).collect()
    }

    #[test]
    fn a_sound_scene_has_no_violations() {
        assert_eq!(check(&sound()), vec![]);
    }

    #[test]
    fn all_violations_are_found_together() {
        let mut scene = sound();
        scene.version = 2;
        scene.length = -1.0;
        scene.material.poisson_ratio = Some(0.7);
        scene.numerics.samples = 1;
        scene.loading = vec![];
        assert_eq!(
            fields_of(&scene),
            ["version", "material.poisson_ratio", "length", "loading", "numerics.samples"]
        );
    }

    #[test]
    fn a_violation_says_what_stands_and_what_is_allowed() {
        let mut scene = sound();
        scene.length = 20.0;
        assert_eq!(
            check(&scene),
            [Violation {
                field: "length".into(),
                value: "20.0".into(),
                allowed: "from 1e-9 to 10 m".into(),
                reason: "apparent diameter".into(),
                involves: &[],
            }]
        );
    }

    #[test]
    fn nan_and_infinities_are_refused_everywhere() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut scene = sound();
            scene.length = value;
            assert_eq!(fields_of(&scene), ["length"], "{value}");
            let mut scene = sound();
            scene.material =
                Material { youngs_modulus: None, poisson_ratio: None, effective_modulus: Some(value) };
            assert_eq!(fields_of(&scene), ["material.effective_modulus"], "{value}");
            let mut scene = sound();
            scene.adhesion = Some(Adhesion { work: Some(value), kappa: None });
            assert_eq!(fields_of(&scene), ["adhesion.work"], "{value}");
            let mut scene = sound();
            scene.loading = vec![Leg::ToForce(1.0), Leg::ToIndentation(value), Leg::ToForce(value)];
            assert_eq!(fields_of(&scene), ["loading.1.0", "loading.2.0"], "{value}");
            let mut scene = sound();
            scene.numerics.solver = Solver::Stepwise { step: value };
            assert_eq!(fields_of(&scene), ["numerics.solver.step"], "{value}");
            for form in [
                Form::Paraboloid { radius: value },
                Form::Cone { angle: value },
                Form::Power { coefficient: value, exponent: 2.0 },
                Form::Power { coefficient: 1.0, exponent: value },
                Form::Punch { radius: value },
            ] {
                let mut scene = sound();
                scene.form = Some(form);
                assert_eq!(fields_of(&scene).len(), 1, "{form:?}");
            }
        }
    }

    #[test]
    fn sizes_from_nanometres_to_metres_are_allowed() {
        for length in [1e-9, 1e-6, 1.0, 10.0] {
            for height in [1e-15, 1.0, 10.0] {
                let mut scene = sound();
                scene.length = length;
                if let Some(Roughness::SelfAffine { rms_height, .. }) = &mut scene.roughness {
                    *rms_height = Some(height * length);
                }
                assert_eq!(check(&scene), vec![]);
            }
        }
    }

    #[test]
    fn modes_are_a_band() {
        for (modes, sound) in [((1, 1), true), ((4, 512), true), ((5, 4), false), ((0, 4), false)] {
            let mut scene = sound_scene_with(modes);
            assert_eq!(check(&scene).is_empty(), sound, "{modes:?}");
            scene.numerics.points = 1 << 28;
            assert_eq!(check(&scene).is_empty(), sound, "{modes:?}");
        }
        let scene = sound_scene_with((1, u64::MAX));
        assert_eq!(fields_of(&scene), ["roughness.modes"]);
    }

    fn sound_scene_with(band: (u64, u64)) -> Scene {
        let mut scene = sound();
        if let Some(Roughness::SelfAffine { modes, .. }) = &mut scene.roughness {
            *modes = band;
        }
        scene
    }

    #[test]
    fn control_characters_do_not_reach_the_screen() {
        let mut scene = sound();
        scene.title = "one\ntwo".into();
        scene.notice = "one\ntwo".into();
        assert_eq!(fields_of(&scene), ["title"]);
        scene.title = "one".into();
        scene.notice = "\u{1b}[2J".into();
        assert_eq!(fields_of(&scene), ["notice"]);
    }
}
