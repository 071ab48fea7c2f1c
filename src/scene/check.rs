//! Values that a scene may not have: every field against its range, then the fields against each other.
//!
//! Nothing here allocates in proportion to what a scene asks for, so a scene that asks for too much is refused before
//! anything is built.

use super::consistency::check_consistency;
use super::field::Field;
use super::fields::FIELDS;
use super::model::{Leg, Scene};
use super::range::Range;
use super::text::{is_within, ron_float, ron_string};
use super::value::Value;
use crate::text::is_control;

/// A value or combination of values that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Path of the field; a loading stage is `loading.0`.
    pub field: String,
    /// Its value as it would be written; empty where nothing is written.
    pub value: String,
    /// Allowed values; empty where `reason` says it all.
    pub allowed: String,
    /// The reason, or the field's name.
    pub reason: String,
    /// Other fields that take part, by path: changing one of them may mend it as well.
    pub involves: &'static [&'static str],
}

/// Everything that is not allowed in a scene, in the order of its fields; empty for a scene that can be computed.
pub fn check(scene: &Scene) -> Vec<Violation> {
    let mut found = Found::default();
    for field in FIELDS {
        if let Some(value) = field.get(scene) {
            found.check(field, value);
        }
    }
    check_consistency(scene, &mut found);
    found.violations
}

/// The violations found so far.
#[derive(Default)]
pub(super) struct Found {
    violations: Vec<Violation>,
}

impl Found {
    /// Adds a violation that no range of a field expresses.
    pub(super) fn add(&mut self, violation: Violation) {
        self.violations.push(violation);
    }

    /// A violation of this field, or of anything inside it, is among those found.
    pub(super) fn has(&self, path: &str) -> bool {
        self.violations.iter().any(|violation| is_within(&violation.field, path))
    }

    fn check(&mut self, field: &Field, value: Value<'_>) {
        let range = &field.range;
        match value {
            Value::Real(value) if !range.contains(value) => self.outside(field, ron_float(value)),
            Value::Whole(value) if !range.contains_whole(value) => self.outside(field, value.to_string()),
            Value::Band(first, last)
                if first > last || !range.contains_whole(first) || !range.contains_whole(last) =>
            {
                self.outside(field, format!("({first}, {last})"));
            }
            Value::Text(text) => self.check_text(field, text),
            Value::Observers(observers) => self.check_count(field, observers.len()),
            Value::Legs(legs) => {
                self.check_count(field, legs.len());
                self.check_targets(legs);
            }
            _ => {}
        }
    }

    fn outside(&mut self, field: &Field, value: String) {
        let (path, allowed, reason) = (field.path.to_string(), field.allowed(), field.name.to_string());
        self.add(Violation { field: path, value, allowed, reason, involves: &[] });
    }

    fn check_text(&mut self, field: &Field, text: &str) {
        let Range::Text { least, most, lines } = field.range else { return };
        // Control characters would reach the terminal of whoever opens the scene.
        let forbidden = |c: char| is_control(c) && !(lines && c == '\n');
        let count = text.chars().count();
        if let Some(c) = text.chars().find(|c| forbidden(*c)) {
            let allowed =
                if lines { "no control characters but line breaks" } else { "no control characters" };
            self.add(Violation {
                field: field.path.to_string(),
                value: format!("text with {c:?}"),
                allowed: allowed.to_string(),
                reason: field.name.to_string(),
                involves: &[],
            });
        } else if count > most {
            self.outside(field, format!("{count} characters"));
        } else if count < least {
            self.outside(field, ron_string(text));
        }
    }

    fn check_count(&mut self, field: &Field, count: usize) {
        if let Range::List { least, most, .. } = field.range
            && !(least..=most).contains(&count)
        {
            self.outside(field, if count == 0 { "[]".to_string() } else { format!("a list of {count}") });
        }
    }

    fn check_targets(&mut self, legs: &[Leg]) {
        for (index, leg) in legs.iter().enumerate() {
            if let Some((field, value)) = leg.target()
                && !field.range.contains(value)
            {
                self.add(Violation {
                    field: format!("loading.{index}.0"),
                    value: ron_float(value),
                    allowed: field.allowed(),
                    reason: field.name.to_string(),
                    involves: &[],
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::{Adhesion, Form, Material, Roughness, Solver};
    use super::super::strategies::sound;
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
        scene.version = 3;
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
            scene.adhesion = Some(Adhesion::default().with_work(value));
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
