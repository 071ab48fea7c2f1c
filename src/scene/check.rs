//! Values that a scene may not have: every field against its range, then the fields against each other.
//!
//! Nothing here allocates in proportion to what a scene asks for, so a scene that asks for too much is refused before
//! anything is built.

use super::consistency::check_consistency;
use super::fields::FIELDS;
use super::model::Scene;
use super::violation::{Found, Violation};

/// Everything that is not allowed in a scene, in the order of its fields; empty for a scene that can be computed.
pub fn check(scene: &Scene) -> Vec<Violation> {
    let mut found = Found::default();
    for field in FIELDS {
        if let Some(value) = field.get(scene) {
            found.check(field, value);
        }
    }
    check_consistency(scene, &mut found);
    found.into_violations()
}

#[cfg(test)]
mod tests {
    use super::super::model::Leg;
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
