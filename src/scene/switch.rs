//! Effects of a document switched off and on, and the specifications of adhesion.
//!
//! Amplitude of the roughness, work of adhesion and κ or e_el/γ determine each other, so that switching one of them
//! off may require a replacement value. That value follows from the profile, which this module does not know: the
//! caller passes it from the computed scene. Switching on undoes the edits of switching off.

use super::computed::Computed;
use super::document::{Document, pair};
use super::effects::{Effect, adhesion_as, by_work, pressing};
use super::errors::{Origin, SceneError, SceneErrors};
use super::model::{Adhesion, Observer, Roughness, Scene};
use super::roughness_parameter::RoughnessParameter;
use super::text::{Text, ron_float};

impl Document {
    /// This document without an effect; unchanged if the effect is off.
    ///
    /// Without roughness, adhesion by κ or e_el/γ becomes adhesion by work. Without adhesion, roughness with
    /// an amplitude set by adhesion keeps it as an rms height. `computed` has these values for this scene. Without
    /// unloading, stages that may pull are removed, and those certain to be passed on the way to a larger force.
    ///
    /// # Errors
    ///
    /// A replacement value is not in `computed`, or is invalid.
    pub fn without(&self, effect: Effect, computed: &Computed) -> Result<Document, SceneErrors> {
        let scene = self.scene();
        if !effect.is_on(scene) {
            return Ok(self.clone());
        }
        let overrides = match effect {
            Effect::Roughness => self.without_roughness(computed)?,
            Effect::Adhesion => self.without_adhesion(computed)?,
            Effect::Unloading => vec![self.only("loading", &pressing(&scene.loading))],
            _ => match effect.observer() {
                Some(observer) => vec![self.only("observe", &others(scene, observer))],
                None => vec![pair(effect.path(), "None")],
            },
        };
        self.switch_off(effect, &overrides, computed)
    }

    /// This document with an effect; unchanged if the effect is on.
    ///
    /// Undoes the edits that switched the effect off: the text is as before, but for values changed since, loading
    /// stages among them. If there is no such edit, or the earlier effect is no longer valid, the effect is set to
    /// suit the scene.
    ///
    /// # Errors
    ///
    /// The effect is impossible in the scene, such as roughness on a single spring.
    pub fn with(&self, effect: Effect) -> Result<Document, SceneErrors> {
        if effect.is_on(self.scene()) {
            return Ok(self.clone());
        }
        match self.restored(effect) {
            Some(document) => Ok(document),
            None => self.set(effect.path(), &effect.suited(self.scene())),
        }
    }

    /// This document with adhesion of this work, J/m². Sets the field of adhesion by work; any other
    /// adhesion, and none, becomes adhesion by work.
    ///
    /// # Errors
    ///
    /// An invalid work of adhesion.
    pub fn with_work_of_adhesion(&self, work: f64) -> Result<Document, SceneErrors> {
        match self.scene().adhesion {
            Some(Adhesion { work: Some(_), .. }) => self.set("adhesion.work", &ron_float(work)),
            _ => self.set("adhesion", &by_work(self.scene(), work)),
        }
    }

    /// This document with adhesion of this κ or e_el/γ. Sets the field of adhesion by this parameter; any other
    /// adhesion, and none, becomes adhesion by the parameter. A work of adhesion that sets the amplitude of the
    /// roughness together with the other parameter is kept.
    ///
    /// # Errors
    ///
    /// An invalid value, or a scene without roughness.
    pub fn with_parameter(&self, parameter: RoughnessParameter, value: f64) -> Result<Document, SceneErrors> {
        match self.scene().adhesion.and_then(|adhesion| adhesion.parameter()) {
            Some((given, _)) if given == parameter => self.set(parameter.path(), &ron_float(value)),
            _ => {
                let changed = |adhesion: Adhesion| Adhesion {
                    work: adhesion.work.filter(|_| adhesion.parameter().is_some()),
                    ..adhesion.with_parameter(parameter, value)
                };
                self.set("adhesion", &adhesion_as(self.scene(), changed))
            }
        }
    }

    /// The list at a path reduced to these elements, as written.
    fn only(&self, path: &str, elements: &[usize]) -> (String, String) {
        let list = self.value(path).unwrap_or_default();
        let all = Text::new(list).ok().and_then(|text| text.elements()).unwrap_or_default();
        let kept: Vec<&str> = elements.iter().filter_map(|index| all.get(*index).copied()).collect();
        pair(path, format!("[{}]", kept.join(", ")))
    }

    fn without_roughness(&self, computed: &Computed) -> Result<Vec<(String, String)>, SceneErrors> {
        let adhesion = self.scene().adhesion;
        let parameter = adhesion.and_then(|adhesion| adhesion.parameter()).map(|(parameter, _)| parameter);
        let adhesion = match (adhesion.and_then(|adhesion| adhesion.work), parameter) {
            (Some(_), Some(parameter)) => vec![pair(parameter.path(), "None")],
            (None, Some(parameter)) => {
                let work = computed.work_of_adhesion.ok_or_else(|| {
                    let symbol = parameter.symbol();
                    let reason =
                        format!("{symbol} requires roughness, and the work of adhesion is not known yet");
                    self.unknown("adhesion", &reason)
                })?;
                vec![pair("adhesion", by_work(self.scene(), work))]
            }
            _ => Vec::new(),
        };
        Ok(adhesion.into_iter().chain([pair("roughness", "None")]).collect())
    }

    fn without_adhesion(&self, computed: &Computed) -> Result<Vec<(String, String)>, SceneErrors> {
        let height = self.height_in_place_of_adhesion(computed)?;
        Ok(height.into_iter().chain([pair("adhesion", "None")]).collect())
    }

    /// The rms height of roughness whose amplitude follows from work of adhesion and κ.
    pub(super) fn height_in_place_of_adhesion(
        &self,
        computed: &Computed,
    ) -> Result<Option<(String, String)>, SceneErrors> {
        if self.scene().roughness.as_ref().is_none_or(Roughness::has_amplitude) {
            return Ok(None);
        }
        let height = computed.rms_height.ok_or_else(|| {
            self.unknown("roughness", "adhesion sets its amplitude, and the rms height is not known yet")
        })?;
        Ok(Some(pair("roughness.rms_height", ron_float(height))))
    }

    pub(super) fn unknown(&self, field: &str, message: &str) -> SceneErrors {
        let value = self.value(field).unwrap_or_default().to_string();
        let error = SceneError::whole(Origin::Scene, format!("{message}: compute the scene first"));
        SceneError { field: field.to_string(), value, ..error }.into()
    }
}

/// Indices of the observers other than this one.
fn others(scene: &Scene, observer: Observer) -> Vec<usize> {
    let observed = scene.observe.iter().enumerate();
    observed.filter(|(_, other)| **other != observer).map(|(index, _)| index).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::model::Move;
    use super::super::strategies::{Drawn, sound_scenes};
    use super::super::text::is_within;
    use super::super::write::legs;
    use super::*;
    use crate::surface::Form;

    const SCENE: &str = "(
    version: 1, // the first
    material: (effective_modulus: 1.0e6), // soft
    length: 1.0e-4,
    form: Punch(
        radius: 2.0e-5, // flat
    ), // under it
    roughness: SelfAffine(hurst: 0.70, rms_height: 2.0e-7, modes: (1, 512), seed: 1), // rough
    adhesion: (kappa: 6.0), // sticky
    loading: [ToForce(1.0e-5), /* and back */ ToSeparation], // history
    observe: [HeightHistogram, Fragments], // both
)
";

    const COMPUTED: Computed = Computed {
        work_of_adhesion: Some(0.0123),
        kappa: Some(6.0),
        elastic_energy_ratio: Some(0.9),
        rms_height: Some(1.5e-7),
    };

    fn document() -> Document {
        Document::parse(SCENE, "scene").unwrap()
    }

    fn adhesion(document: &Document) -> (Option<f64>, Option<f64>) {
        document.scene().adhesion.map_or((None, None), |adhesion| (adhesion.work, adhesion.kappa))
    }

    fn off(document: &Document, effect: Effect) -> Document {
        document.without(effect, &COMPUTED).unwrap()
    }

    #[test]
    fn an_effect_goes_and_comes_back_as_it_was_written() {
        for effect in Effect::ALL {
            let without = off(&document(), effect);
            assert!(!effect.is_on(without.scene()));
            for comment in
                ["// the first", "// soft", "// under it", "// rough", "// sticky", "// history", "// both"]
            {
                assert!(without.text().contains(comment), "{effect:?}: {comment}");
            }
            assert_eq!(off(&without, effect), without);
            let with = without.with(effect).unwrap();
            assert_eq!(with.text(), SCENE, "{effect:?}");
            assert_eq!(with.with(effect).unwrap(), with);
        }
    }

    #[test]
    fn a_restored_value_is_written_as_it_was() {
        let written = SCENE.replace("modes: (1, 512)", "modes: (1,0512) /* short */");
        let document = Document::parse(&written, "scene").unwrap();
        let restored = off(&document, Effect::Roughness).with(Effect::Roughness).unwrap();
        assert_eq!(restored.text(), written);
    }

    #[test]
    fn effects_come_anew_as_they_suit_the_scene() {
        let bare = Effect::ALL.into_iter().fold(document(), |document, effect| off(&document, effect));
        // A document opened anew has no record of earlier effects.
        let bare = Document::parse(bare.text(), "bare").unwrap();
        let value = |document: &Document, effect: Effect| {
            document.with(effect).unwrap().value(effect.path()).unwrap().to_string()
        };
        assert_eq!(value(&bare, Effect::Form), "Paraboloid(radius: 1.0e-4)");
        let rough = "SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1)";
        assert_eq!(value(&bare, Effect::Roughness), rough);
        assert_eq!(value(&bare, Effect::Adhesion), "(work: 0.05)");
        assert_eq!(value(&bare, Effect::Unloading), "[ToForce(1.0e-5), ToSeparation]");
        assert_eq!(value(&bare, Effect::Fragments), "[Fragments]");
        let observed = bare.with(Effect::HeightHistogram).unwrap();
        assert_eq!(value(&observed, Effect::Fragments), "[Fragments, HeightHistogram]");
        assert_eq!(value(&bare.set("roughness", rough).unwrap(), Effect::Adhesion), "(kappa: 2.0)");
        let sphere = bare.with(Effect::Form).unwrap().set("numerics.points", "40").unwrap();
        assert!(value(&sphere, Effect::Roughness).contains("modes: (4, 5)"));
        // An observer that is listed twice leaves a free place.
        let twice = bare.set("observe", "[Fragments, Fragments]").unwrap();
        assert_eq!(value(&twice, Effect::HeightHistogram), "[Fragments, HeightHistogram]");
        // One spring carries no wave at all.
        let one = bare.set("numerics.points", "1").unwrap().with(Effect::Roughness).unwrap_err();
        assert!(one.to_string().contains("points/2 = 0"), "{one}");
    }

    #[test]
    fn without_roughness_kappa_becomes_its_work() {
        assert_eq!(adhesion(&off(&document(), Effect::Roughness)), (Some(0.0123), None));
        let unknown = document().without(Effect::Roughness, &Computed::default()).unwrap_err();
        assert_eq!(
            unknown.to_string(),
            "adhesion = (kappa: 6.0): κ requires roughness, and the work of adhesion is not known yet: \
             compute the scene first"
        );
        let too_much = Computed { work_of_adhesion: Some(f64::INFINITY), ..Computed::default() };
        assert!(document().without(Effect::Roughness, &too_much).is_err());
        // A given work is used unchanged.
        let both = document().set("roughness.rms_height", "None").unwrap_err();
        assert!(both.to_string().contains("the amplitude is missing"));
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let both = document().set_all(&set).unwrap();
        let smooth = both.without(Effect::Roughness, &Computed::default()).unwrap();
        assert_eq!(adhesion(&smooth), (Some(0.1), None));
        assert_eq!(smooth.with(Effect::Roughness).unwrap().scene(), both.scene());
    }

    #[test]
    fn what_was_changed_meanwhile_stays_changed() {
        let document = document();
        let back = |smooth: &Document| smooth.with(Effect::Roughness).unwrap();
        let smooth = off(&document, Effect::Roughness);
        let stickier = smooth.with_work_of_adhesion(0.2).unwrap();
        assert_eq!(adhesion(&back(&stickier)), (Some(0.2), None));
        let typed = smooth.set("adhesion", "(work: 0.3)").unwrap();
        assert_eq!(adhesion(&back(&typed)), (Some(0.3), None));
        let unrelated = smooth.set("length", "2.0e-4").unwrap();
        assert_eq!(adhesion(&back(&unrelated)), (None, Some(6.0)));
        // If κ had set the amplitude, κ sets it again.
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let both = document.set_all(&set).unwrap();
        let stickier = off(&both, Effect::Roughness).with_work_of_adhesion(0.2).unwrap();
        assert_eq!(adhesion(&back(&stickier)), (Some(0.2), Some(6.0)));
        let none = off(&stickier, Effect::Adhesion);
        let rough = back(&none);
        assert_eq!((adhesion(&rough), rough.value("roughness.rms_height")), ((None, None), Some("1.5e-7")));
        // Other stages that press are kept.
        let held = off(&document, Effect::Unloading).set("loading.0", "ToForce(3.0e-5)").unwrap();
        let pulled = held.with(Effect::Unloading).unwrap();
        assert_eq!(pulled.scene().loading, [Move::ToForce(3e-5), Move::ToSeparation]);
    }

    #[test]
    fn loading_edited_without_unloading_keeps_the_stages_that_pull() {
        let cycles = "[ToForce(1.0e-5), ToZeroForce, /* deeper */ ToForce(2e-5), ToSeparation]";
        let document = document().set("loading", "[ToForce(1.0), ToSeparation]").unwrap();
        let document =
            Document::parse(&document.text().replace("[ToForce(1.0), ToSeparation]", cycles), "cycles")
                .unwrap();
        let pressed = off(&document, Effect::Unloading);
        assert_eq!(pressed.value("loading"), Some("[ToForce(2e-5)]"));
        for (path, value, expected) in [
            ("loading.0.0", "3e-5", cycles.replace("2e-5", "3e-5")),
            ("loading.0", "ToIndentation(1e-7)", cycles.replace("ToForce(2e-5)", "ToIndentation(1e-7)")),
            (
                "loading",
                "[ToTouch, ToIndentation(1e-7)]",
                cycles.replace("ToForce(2e-5)", "ToTouch, ToIndentation(1e-7)"),
            ),
        ] {
            let edited = pressed.set(path, value).unwrap();
            let back = edited.with(Effect::Unloading).unwrap();
            assert_eq!(back.value("loading"), Some(expected.as_str()), "{path}={value}");
        }
    }

    #[test]
    fn effects_come_back_in_any_order() {
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let documents = [document(), document().set_all(&set).unwrap()];
        let pairs = Effect::ALL.into_iter().flat_map(|one| Effect::ALL.map(|other| (one, other)));
        for (first, second) in pairs.filter(|(first, second)| first != second) {
            for document in &documents {
                let without = off(&off(document, first), second);
                for (one, other) in [(first, second), (second, first)] {
                    let back = without.with(one).unwrap();
                    assert!(one.is_on(back.scene()) && !other.is_on(back.scene()), "{one:?} {other:?}");
                    let back = back.with(other).unwrap();
                    assert_eq!(
                        back.scene(),
                        document.scene(),
                        "{first:?} {second:?}, back {one:?} {other:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_no_longer_fits_is_fitted() {
        let coarse = off(&document(), Effect::Roughness).set("numerics.points", "64").unwrap();
        let rough = coarse.with(Effect::Roughness).unwrap();
        assert_eq!(rough.value("roughness.modes"), Some("(1, 32)"));
        assert_eq!((rough.value("roughness.hurst"), adhesion(&rough)), (Some("0.70"), (None, Some(6.0))));
        let short = off(&document(), Effect::Form).set("length", "1.0e-5").unwrap();
        let formed = short.with(Effect::Form).unwrap();
        assert_eq!(formed.scene().form, Some(Form::Paraboloid { radius: 1e-5 }));
        let smooth = off(&document(), Effect::Roughness);
        let sticky = off(&smooth, Effect::Adhesion).with(Effect::Adhesion).unwrap();
        assert_eq!(adhesion(&sticky), (Some(0.0123), None));
        assert_eq!(sticky.with(Effect::Roughness).unwrap().text(), SCENE);
    }

    #[test]
    fn without_adhesion_the_amplitude_it_set_stays() {
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let both = document().set_all(&set).unwrap();
        let unknown = both.without(Effect::Adhesion, &Computed::default()).unwrap_err();
        assert!(unknown.to_string().contains("the rms height is not known yet"), "{unknown}");
        let without = off(&both, Effect::Adhesion);
        assert_eq!(without.value("roughness.rms_height"), Some("1.5e-7"));
        assert_eq!(without.with(Effect::Adhesion).unwrap().scene(), both.scene());
        let other_line = without.set("roughness.seed", "2").unwrap();
        let back = other_line.with(Effect::Adhesion).unwrap();
        assert_eq!(
            (adhesion(&back), back.value("roughness.rms_height")),
            ((Some(0.1), Some(6.0)), Some("None"))
        );
        // A later amplitude is kept, and κ follows from it and from the same work of adhesion.
        let rougher = without.set("roughness.rms_height", "3.0e-7").unwrap();
        let back = rougher.with(Effect::Adhesion).unwrap();
        assert_eq!(
            (adhesion(&back), back.value("roughness.rms_height")),
            ((Some(0.1), None), Some("3.0e-7"))
        );
    }

    #[test]
    fn adhesion_is_given_one_way_or_the_other() {
        let document = document();
        assert_eq!(
            adhesion(&document.with_parameter(RoughnessParameter::Kappa, 3.0).unwrap()),
            (None, Some(3.0))
        );
        let work = document.with_work_of_adhesion(0.1).unwrap();
        assert_eq!(adhesion(&work), (Some(0.1), None));
        assert!(work.text().contains("adhesion: (work: 0.1), // sticky"));
        assert_eq!(
            adhesion(&work.with_parameter(RoughnessParameter::Kappa, 3.0).unwrap()),
            (None, Some(3.0))
        );
        assert_eq!(
            adhesion(&off(&work, Effect::Adhesion).with_parameter(RoughnessParameter::Kappa, 3.0).unwrap()),
            (None, Some(3.0))
        );
        // If both are given, because they set the amplitude, both are kept.
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        let both = document.set_all(&set).unwrap();
        assert_eq!(
            adhesion(&both.with_parameter(RoughnessParameter::Kappa, 3.0).unwrap()),
            (Some(0.1), Some(3.0))
        );
        let ratio = both.with_parameter(RoughnessParameter::ElasticEnergyRatio, 0.7).unwrap();
        assert_eq!(ratio.scene().adhesion.unwrap().work, Some(0.1));
        assert_eq!(ratio.scene().adhesion.unwrap().elastic_energy_ratio, Some(0.7));
        assert_eq!(adhesion(&both.with_work_of_adhesion(0.2).unwrap()), (Some(0.2), Some(6.0)));
        assert!(
            off(&work, Effect::Roughness)
                .with_parameter(RoughnessParameter::Kappa, 3.0)
                .unwrap_err()
                .to_string()
                .contains("there is none")
        );
        assert!(
            document.with_work_of_adhesion(-1.0).is_err()
                && document.with_parameter(RoughnessParameter::Kappa, f64::NAN).is_err()
        );
    }

    proptest! {
        #[test]
        fn every_switch_of_every_scene_goes_both_ways(
            scene in sound_scenes(),
            work in 0.0..1e6,
            rms_height in 1e-30..100.0,
        ) {
            let document = Document::from_scene(&scene, "scene").unwrap();
            let computed = Computed { work_of_adhesion: Some(work), rms_height: Some(rms_height), ..Computed::default() };
            for effect in Effect::ALL {
                let without = document.without(effect, &computed).unwrap();
                prop_assert!(!effect.is_on(without.scene()));
                for also in Effect::ALL.into_iter().filter(|also| *also != effect) {
                    prop_assert!(also.is_on(without.scene()) == also.is_on(&scene) || work == 0.0, "{effect:?} {also:?}");
                }
                let forgotten = Document::parse(without.text(), "forgotten").unwrap();
                match forgotten.with(effect) {
                    Ok(suited) => prop_assert!(effect.is_on(suited.scene())),
                    Err(error) => prop_assert!(effect == Effect::Roughness && scene.numerics.points < 2, "{effect:?}: {error}"),
                }
                if !effect.is_on(&scene) {
                    continue;
                }
                let back = without.with(effect).unwrap();
                prop_assert_eq!(back.text(), document.text(), "{:?}", effect);
                prop_assert!(back.overrides().is_empty() && !back.is_changed());
            }
        }

        /// For the tables of effects and of fields alike: an edit without an effect results, once the effect is on
        /// again, in the scene of the same edit with the effect.
        #[test]
        fn switching_an_effect_on_undoes_that_switch_alone(
            scene in sound_scenes(),
            effect in prop::sample::select(Effect::ALL.to_vec()),
            edits in Drawn::default().overrides(1),
            work in 0.001..10.0,
            rms_height in 1e-9..1e-5,
        ) {
            prop_assume!(effect.is_on(&scene));
            let document = Document::from_scene(&scene, "scene").unwrap();
            let computed = Computed { work_of_adhesion: Some(work), rms_height: Some(rms_height), ..Computed::default() };
            let without = document.without(effect, &computed).unwrap();
            let Ok(edited) = without.set_all(&edits) else { return Ok(()) };
            prop_assume!(!effect.is_on(edited.scene()));
            let Ok(back) = edited.with(effect) else { return Ok(()) };
            prop_assert!(effect.is_on(back.scene()));
            let path = edits[0].0.as_str();
            let is_list = ["loading", "observe"].iter().any(|list| is_within(path, list));
            // Changes by the switch itself are compared below.
            let is_switched = |field: &str| without.value(field) != document.value(field);
            if !is_list && !is_switched(path)
                && let Ok(expected) = document.set_all(&edits)
                && edited.value(path) == expected.value(path)
            {
                prop_assert_eq!(back.scene(), expected.scene(), "{:?} {:?}", effect, edits);
            }
            if !is_list && !is_within(path, effect.path()) {
                prop_assert_eq!(back.value(path), edited.value(path), "{:?} {:?}", effect, edits);
            }
        }

        /// Stages that pull return around those that press, after any change of these.
        #[test]
        fn stages_that_pull_come_back_around_edited_ones(scene in sound_scenes(), other in sound_scenes()) {
            prop_assume!(Effect::Unloading.is_on(&scene));
            let document = Document::from_scene(&scene, "scene").unwrap();
            let without = document.without(Effect::Unloading, &Computed::default()).unwrap();
            let (kept, pressing_others) = (pressing(&scene.loading), pressing(&other.loading));
            let pressed: Vec<Move> =
                kept.iter().enumerate().map(|(at, kept)| match pressing_others.get(at) {
                    Some(index) => other.loading[*index],
                    None => scene.loading[*kept],
                }).collect();
            let Ok(edited) = without.set("loading", &legs(&pressed)) else { return Ok(()) };
            prop_assume!(!Effect::Unloading.is_on(edited.scene()));
            let mut loading = scene.loading.clone();
            kept.iter().zip(&pressed).for_each(|(place, leg)| loading[*place] = *leg);
            let expected = Scene { loading, ..scene };
            if expected.check().is_ok() && Effect::Unloading.is_on(&expected) {
                let back = edited.with(Effect::Unloading).unwrap();
                prop_assert_eq!(&back.scene().loading, &expected.loading);
            }
        }
    }
}
