//! The next choice of a field for a key press.

use super::computed::Computed;
use super::document::{Document, pair};
use super::effects::{Effect, by_parameter, by_work};
use super::errors::SceneErrors;
use super::field::Field;
use super::range::choice_key;
use super::roughness_parameter::RoughnessParameter;

/// Significant digits that survive the conversion of adhesion from one specification to another and back.
const DIGITS: usize = 14;
/// Most significant digits of a typed value.
const TYPED_DIGITS: usize = 10;

/// A converted value: the earlier typed one, or all digits, so that converting back returns the typed one.
fn converted_value(value: f64) -> f64 {
    let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    let typed: f64 = format!("{value:.*e}", TYPED_DIGITS - 1).parse().unwrap_or(value);
    if typed == rounded { typed } else { value }
}

impl Document {
    /// This document with the next choice of a field in this direction that the scene allows; `None` if there is no
    /// other.
    ///
    /// Omitting an effect switches it off, and the next choice switches it on as before or as suits the scene.
    /// Adhesion by work, by κ and by e_el/γ are the same adhesion: `computed` has the values for this scene.
    ///
    /// # Errors
    ///
    /// No other choice is allowed, or a converted value is not in `computed`.
    pub fn with_next_choice(
        &self,
        field: &Field,
        forwards: bool,
        computed: &Computed,
    ) -> Result<Option<Document>, SceneErrors> {
        let Some(here) = field.written(self.scene()) else { return Ok(None) };
        let mut refused = None;
        for distance in 1.. {
            let next = field.stepped(&here, if forwards { distance } else { -distance }, false);
            let Some(next) = next.filter(|next| choice_key(next) != choice_key(&here)) else { break };
            if let Some(converted) = self.converted(field, &next, computed) {
                return converted.map(Some);
            }
            match self.chosen(field, &next, computed) {
                Ok(document) => return Ok(Some(document)),
                Err(errors) => refused = refused.or(Some(errors)),
            }
        }
        refused.map_or(Ok(None), Err)
    }

    fn chosen(&self, field: &Field, next: &str, computed: &Computed) -> Result<Document, SceneErrors> {
        let Some(effect) = Effect::ALL.into_iter().find(|effect| effect.path() == field.path) else {
            return self.set(field.path, next);
        };
        if next == "None" {
            return self.without(effect, computed);
        }
        if effect.is_on(self.scene()) {
            return self.set(field.path, next);
        }
        // Any specification of adhesion counts as the next choice, since each follows from the other.
        let is_next = |document: &Document| {
            let written = field.written(document.scene()).unwrap_or_default();
            effect == Effect::Adhesion || choice_key(&written) == choice_key(next)
        };
        let before = self.with(effect)?;
        if is_next(&before) {
            return Ok(before);
        }
        let suited = self.set(field.path, &effect.suited(self.scene()))?;
        if is_next(&suited) { Ok(suited) } else { self.set(field.path, next) }
    }

    /// The same adhesion specified otherwise; `None` if the next choice is not a specification of adhesion.
    fn converted(
        &self,
        field: &Field,
        next: &str,
        computed: &Computed,
    ) -> Option<Result<Document, SceneErrors>> {
        if field.path != Effect::Adhesion.path() || next == "None" || !Effect::Adhesion.is_on(self.scene()) {
            return None;
        }
        let is_next = |parameter: &RoughnessParameter| {
            choice_key(next) == choice_key(&format!("({}: 1.0)", parameter.name()))
        };
        let parameter = RoughnessParameter::ALL.into_iter().find(is_next);
        if parameter.is_some() && self.scene().roughness.is_none() {
            return None;
        }
        let adhesion = match parameter {
            Some(parameter) => {
                let value = computed.parameter(parameter).map(converted_value);
                value.map(|value| by_parameter(self.scene(), parameter, value))
            }
            None => computed.work_of_adhesion.map(|work| by_work(self.scene(), work)),
        };
        let unknown = || self.unknown("adhesion", "the same adhesion given the other way is not known yet");
        Some(adhesion.ok_or_else(unknown).and_then(|adhesion| {
            let height = self.height_in_place_of_adhesion(computed)?;
            let overrides: Vec<_> = height.into_iter().chain([pair("adhesion", adhesion)]).collect();
            self.set_all(&overrides)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fields::field;
    use super::super::model::{Adhesion, Roughness};
    use super::*;
    use crate::surface::Form;

    const SCENE: &str = "(
    version: 1,
    material: (effective_modulus: 1.0e6),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1), // rough
    adhesion: (kappa: 6.0), // as measured
)
";

    const COMPUTED: Computed = Computed {
        work_of_adhesion: Some(0.0123),
        kappa: Some(6.000_000_000_000_001),
        elastic_energy_ratio: Some(0.9),
        rms_height: Some(1.5e-7),
    };

    fn document() -> Document {
        Document::parse(SCENE, "scene").unwrap()
    }

    fn next(document: &Document, path: &str, forwards: bool) -> Document {
        let field = field(path, None).unwrap();
        document.with_next_choice(field, forwards, &COMPUTED).unwrap().unwrap()
    }

    #[test]
    fn adhesion_given_the_other_way_is_the_same() {
        let work = next(&document(), "adhesion", false);
        assert_eq!(work.scene().adhesion, Some(Adhesion::default().with_work(0.0123)));
        assert_eq!(next(&work, "adhesion", true).text(), SCENE);
        let none = next(&work, "adhesion", false);
        assert_eq!(none.scene().adhesion, None);
        assert_eq!(next(&none, "adhesion", true).text(), work.text());
        let ratio = next(&document(), "adhesion", true);
        assert_eq!(
            ratio.scene().adhesion,
            Some(Adhesion::default().with_parameter(RoughnessParameter::ElasticEnergyRatio, 0.9))
        );
        assert_eq!(next(&ratio, "adhesion", false).text(), SCENE);
        assert_eq!(next(&ratio, "adhesion", true).scene().adhesion, None);
        // Not before the value has been computed.
        let field = field("adhesion", None).unwrap();
        let unknown = document().with_next_choice(field, false, &Computed::default()).unwrap_err();
        assert!(unknown.to_string().contains("compute the scene first"), "{unknown}");
        // A smooth body has no κ.
        let smooth = work.set("roughness", "None").unwrap();
        assert_eq!(next(&smooth, "adhesion", true).scene().adhesion, None);
    }

    #[test]
    fn an_amplitude_that_adhesion_sets_is_kept() {
        let both = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let both = document().set_all(&both).unwrap();
        let kappa = next(&both, "adhesion", true);
        assert_eq!(kappa.scene().adhesion, Some(Adhesion::default().with_kappa(6.0)));
        assert_eq!(kappa.value("roughness.rms_height"), Some("1.5e-7"));
    }

    #[test]
    fn a_choice_that_requires_a_file_is_only_typed() {
        let smooth = next(&document(), "roughness", true);
        assert_eq!(smooth.scene().roughness, None);
        for forwards in [true, false] {
            let rough = next(&smooth, "roughness", forwards);
            assert_eq!(rough.text(), SCENE);
        }
        let measured = document().set("roughness", "Measured(file: \"a.csv\")").unwrap();
        let without = next(&measured, "roughness", false);
        assert!(matches!(without.scene().roughness, Some(Roughness::SelfAffine { .. })));
        let without = measured.without(Effect::Roughness, &COMPUTED).unwrap();
        let rough = next(&without, "roughness", true);
        assert!(matches!(rough.scene().roughness, Some(Roughness::SelfAffine { .. })));
    }

    #[test]
    fn choices_that_the_scene_does_not_allow_are_passed_over() {
        let small = [pair("length", "1.0e-9"), pair("roughness", "None"), pair("adhesion", "None")];
        let small = document().set_all(&small).unwrap();
        let sphere = next(&small, "form", true);
        assert_eq!(sphere.scene().form, Some(Form::Paraboloid { radius: 1e-9 }));
        // The next punch would be wider than the profile.
        let waves = (0..3).fold(sphere, |document, _| next(&document, "form", true));
        assert!(matches!(waves.scene().form, Some(Form::WavySphere { .. })));
        assert_eq!(next(&waves, "form", true).scene().form, None);
        let edges = document().set("numerics.edges", "SubCell").unwrap();
        let field = field("numerics.solver", None).unwrap();
        let refused = edges.with_next_choice(field, true, &COMPUTED).unwrap_err();
        assert!(refused.to_string().contains("edges: Grid"), "{refused}");
    }
}
