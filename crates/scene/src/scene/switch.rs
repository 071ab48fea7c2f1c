//! Switching the effects of a document off and on, and stepping through the choices of a field.

use super::adhesion::Adhesion;
use super::document::{Document, LeftChoice, RemovedEffect, RemovedValue, pair};
use super::effects::{Effect, pressing};
use super::errors::SceneErrors;
use super::field::Field;
use super::model::Scene;
use super::range::{Range, choice_key};
use super::text::read_ron;
use super::written::differing;

/// Adhesion in RON that a smooth body gets when its adhesion is switched on.
const BY_WORK: &str = "(work: 0.05)";

impl Document {
    /// Returns this document without an optional part of its scene. If the roughness is removed, a
    /// work of adhesion replaces a parameter that compares adhesion with the roughness (κ or
    /// e_el/γ). If the unloading is removed, one loading stage remains.
    ///
    /// # Errors
    /// Returns an error if the scene is not valid without this part.
    pub fn without(&self, effect: Effect) -> Result<Document, SceneErrors> {
        let mut scene = Scene::clone(self.scene());
        if !effect.is_on(&scene) {
            return Ok(self.clone());
        }
        match effect {
            Effect::Form => scene.form = None,
            Effect::Roughness => {
                scene.roughness = None;
                if scene
                    .adhesion
                    .is_some_and(|adhesion| adhesion.parameter().is_some())
                {
                    scene.adhesion = self.with_choice("adhesion", BY_WORK)?.scene().adhesion;
                }
            }
            Effect::Adhesion => scene.adhesion = None,
            Effect::Unloading => scene.loading = vec![pressing(&scene.loading)],
        }
        let overrides = overrides_to(self.scene(), &scene);
        let mut new = self.set_all(&overrides)?;
        let mut values = Vec::new();
        for (path, _) in overrides {
            values.push(RemovedValue {
                former: self.value(&path).unwrap_or_default().to_owned(),
                present: new.value(&path).unwrap_or_default().to_owned(),
                path,
            });
        }
        new.removed.retain(|removed| removed.effect != effect);
        new.removed.push(RemovedEffect { effect, values });
        Ok(new)
    }

    /// Returns this document with an optional part added to its scene. If [`Self::without`] has
    /// removed the part before, the part gets its former values back. Otherwise it gets values that
    /// suit the scene.
    ///
    /// # Errors
    /// Returns an error if the part is impossible in the scene, such as roughness on a single
    /// spring.
    pub fn with(&self, effect: Effect) -> Result<Document, SceneErrors> {
        if effect.is_on(self.scene()) {
            return Ok(self.clone());
        }
        if let Some(restored) = self.restored(effect) {
            return Ok(restored);
        }
        self.with_scene(&effect.suited(self.scene()))
    }

    /// Returns this document with the values that an optional part had before it was removed.
    /// Values that were changed since then stay as they are. Returns `None` if the part was not
    /// removed, or if the scene does not allow its former values.
    fn restored(&self, effect: Effect) -> Option<Document> {
        let removed = self
            .removed
            .iter()
            .find(|removed| removed.effect == effect)?;
        let mut former = Vec::new();
        for value in &removed.values {
            if self.value(&value.path) == Some(&value.present) {
                former.push(pair(&value.path, value.former.as_str()));
            }
        }
        let restored = self.set_all(&former).ok()?;
        effect.is_on(restored.scene()).then_some(restored)
    }

    /// Returns this document with the values of `scene`. Only the text of values that differ is
    /// replaced.
    ///
    /// # Errors
    /// Returns an error for each invalid value.
    pub fn with_scene(&self, scene: &Scene) -> Result<Document, SceneErrors> {
        self.set_all(&overrides_to(self.scene(), scene))
    }

    /// Returns this document with another adhesion. Only the text of values that differ is
    /// replaced.
    ///
    /// # Errors
    /// Returns an error if a value is invalid.
    pub fn with_adhesion(&self, adhesion: Adhesion) -> Result<Document, SceneErrors> {
        self.with_scene(&Scene {
            adhesion: Some(adhesion),
            ..Scene::clone(self.scene())
        })
    }

    /// Returns this document with the next choice ([`Range::Choice`]) of `field`, or with the
    /// previous choice if `forwards` is false. Choices that the scene does not allow are skipped.
    /// If the field is an optional part ([`Effect`]), a further choice is the RON text `None`,
    /// which removes the part. Returns `None` if there is no other choice.
    ///
    /// # Errors
    /// Returns an error if the scene allows none of the other choices.
    pub fn with_next_choice(
        &self,
        field: &Field,
        forwards: bool,
    ) -> Result<Option<Document>, SceneErrors> {
        let Range::Choice(choices) = field.range else {
            return Ok(None);
        };
        let Some(here) = field.written(self.scene()) else {
            return Ok(None);
        };
        let mut refused = None;
        // The loop tries all choices and `None`. The present choice need not be one of them.
        for distance in 1..=choices.len() as i32 + 1 {
            let steps = if forwards { distance } else { -distance };
            let Some(next) = field.stepped(&here, steps, false) else {
                break;
            };
            if is_same_choice(&next, &here) {
                break;
            }
            match self.with_chosen(field, &next) {
                Ok(mut document) => {
                    document.left = self.left_choices(field, here);
                    return Ok(Some(document));
                }
                Err(errors) => {
                    refused.get_or_insert(errors);
                }
            }
        }
        refused.map_or(Ok(None), Err)
    }

    /// Returns the list of choices that keys of the explorer have replaced, with `here`, the
    /// present choice of `field`, added to it.
    fn left_choices(&self, field: &Field, here: String) -> Vec<LeftChoice> {
        let mut left = self.left.clone();
        if here != "None" {
            left.retain(|left| left.path != field.path || !is_same_choice(&left.text, &here));
            left.push(LeftChoice {
                path: field.path,
                text: here,
            });
        }
        left
    }

    /// Returns this document with the choice `choice` of a field, such as the form `Cone`. The
    /// choice may be `None`.
    fn with_chosen(&self, field: &Field, choice: &str) -> Result<Document, SceneErrors> {
        let Some(effect) = effect_at(field.path) else {
            return self.with_choice(field.path, choice);
        };
        if effect.is_on(self.scene()) {
            return if choice == "None" {
                self.without(effect)
            } else {
                self.with_choice(field.path, choice)
            };
        }
        // If the removed part had this choice, its former values come back. Otherwise the user has
        // gone through other choices since the part was removed.
        let back = self.with(effect)?;
        let is_this_choice = back
            .value(field.path)
            .is_some_and(|value| is_same_choice(value, choice));
        if is_this_choice {
            Ok(back)
        } else {
            self.with_choice(field.path, choice)
        }
    }

    /// Returns this document with the choice `choice` for the field at `path`. If the field had
    /// this choice before, its former values come back, provided they are still allowed. Otherwise
    /// the choice gets values that suit the scene, or its usual values.
    fn with_choice(&self, path: &str, choice: &str) -> Result<Document, SceneErrors> {
        let left = self
            .left
            .iter()
            .find(|left| left.path == path && is_same_choice(&left.text, choice));
        if let Some(left) = left
            && let Ok(back) = self.set(path, &left.text)
        {
            return Ok(back);
        }
        if let Some(effect) = effect_at(path)
            && let Ok(suited) = self.with_scene(&effect.suited(self.scene()))
            && let Some(value) = suited.value(path)
            && is_same_choice(value, choice)
        {
            return Ok(suited);
        }
        // If another adhesion is chosen, the range of the attraction stays the same.
        if path == "adhesion"
            && let Some(Adhesion { range, .. }) = self.scene().adhesion
            && let Ok(usual) = read_ron::<Adhesion>(choice)
        {
            return self.with_adhesion(Adhesion { range, ..usual });
        }
        self.set(path, choice)
    }
}

/// Returns the optional part whose field has this path; `None` if there is none.
fn effect_at(path: &str) -> Option<Effect> {
    Effect::ALL.into_iter().find(|effect| effect.path() == path)
}

fn is_same_choice(one: &str, other: &str) -> bool {
    choice_key(one) == choice_key(other)
}

/// Returns the changes of fields that turn one scene into another. If the new scene no longer
/// states a field, the whole group of the field is replaced.
fn overrides_to(from: &Scene, to: &Scene) -> Vec<(String, String)> {
    differing(from, to, |before, after| after || !before)
        .into_iter()
        .map(|field| pair(field.path, field.written(to).unwrap_or_default()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::fields::field;
    use super::*;
    use asperity_contact::Move::{ToForce, ToSeparation};

    const SCENE: &str = "(
    version: 1,
    material: (modulus: 1.0e6),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.70, rms_height: 2.0e-7, modes: (1, 512), seed: 1), // rough
    adhesion: (kappa: 6.0), // as measured
    loading: [ToForce(1.0e-5), /* slowly */ ToSeparation],
)
";

    fn document() -> Document {
        Document::parse(SCENE, "scene").unwrap()
    }

    fn off(document: &Document, effect: Effect) -> Document {
        document.without(effect).unwrap()
    }

    fn adhesion(document: &Document) -> &str {
        document.value("adhesion").unwrap_or_default()
    }

    fn next(document: &Document, path: &str, forwards: bool) -> Document {
        let field = field(path, None).unwrap();
        document.with_next_choice(field, forwards).unwrap().unwrap()
    }

    #[test]
    fn an_effect_that_was_never_on_suits_the_scene() {
        let bare =
            "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4, loading: [ToForce(1.0e-5)])";
        let bare = Document::parse(bare, "scene").unwrap();
        let rough = "SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1)";
        for (effect, value) in [
            (Effect::Form, "Paraboloid(radius: 1.0e-4)"),
            (Effect::Roughness, rough),
            (Effect::Adhesion, "(work: 0.05)"),
            (Effect::Unloading, "[ToForce(1.0e-5), ToSeparation]"),
        ] {
            assert_eq!(bare.with(effect).unwrap().value(effect.path()), Some(value));
        }
        let sticky = bare
            .set("roughness", rough)
            .unwrap()
            .with(Effect::Adhesion)
            .unwrap();
        assert_eq!(adhesion(&sticky), "(kappa: 2.0)");
        // With one spring, roughness is impossible, because no wave fits on the profile.
        let one = bare
            .set("numerics.points", "1")
            .unwrap()
            .with(Effect::Roughness)
            .unwrap_err();
        assert!(one.to_string().contains("points/2 = 0"), "{one}");
    }

    #[test]
    fn what_was_changed_meanwhile_stays_changed() {
        let back = |smooth: &Document| smooth.with(Effect::Roughness).unwrap();
        let smooth = off(&document(), Effect::Roughness);
        let stickier = back(&smooth.with_adhesion(Adhesion::by_work(0.2)).unwrap());
        assert_eq!(
            (adhesion(&stickier), stickier.value("roughness.hurst")),
            ("(work: 0.2)", Some("0.70"))
        );
        let longer = back(&smooth.set("length", "2.0e-4").unwrap());
        assert_eq!(
            (adhesion(&longer), longer.scene().length),
            ("(kappa: 6.0)", 2e-4)
        );
        let held = off(&document(), Effect::Unloading)
            .set("loading.0", "ToForce(3.0e-5)")
            .unwrap();
        let pulled = held.with(Effect::Unloading).unwrap();
        assert_eq!(pulled.scene().loading, [ToForce(3e-5), ToSeparation]);
        // If the removed text is no longer valid, the part gets values that suit the scene.
        let coarse = back(&smooth.set("numerics.points", "64").unwrap());
        assert_eq!(coarse.value("roughness.modes"), Some("(1, 8)"));
    }

    #[test]
    fn a_choice_comes_back_with_its_numbers_once_round() {
        let round = |from: &Document, path: &str| -> Vec<String> {
            let around = std::iter::successors(Some(from.clone()), |document| {
                Some(next(document, path, true))
            });
            around
                .map(|document| document.value(path).unwrap_or("None").to_owned())
                .take(20)
                .collect()
        };
        let flat = document().set("numerics.points", "4096").unwrap();
        let forms = round(&flat, "form");
        let circle = forms
            .iter()
            .skip(1)
            .position(|form| *form == forms[0])
            .unwrap()
            + 1;
        assert!(
            circle > 5 && forms[1] == "Paraboloid(radius: 1.0e-4)",
            "{forms:?}"
        );
        assert!(
            (0..20 - circle).all(|place| forms[place] == forms[place + circle]),
            "{forms:?}"
        );
        // Values that the user has typed come back, whether the keys go forwards or backwards.
        let typed = next(&flat, "form", true)
            .set("form.radius", "3.0e-4")
            .unwrap();
        let away = next(&next(&typed, "form", true), "form", true);
        let back = next(&next(&away, "form", false), "form", false);
        assert_eq!(back.value("form"), Some("Paraboloid(radius: 3.0e-4)"));
        let first = round(&typed, "form");
        assert_eq!(
            (first[0] == first[circle], &first[1..circle]),
            (true, &forms[2..=circle])
        );
        let solver = flat
            .set("numerics.solver", "Stepwise(step: 2.0e-9)")
            .unwrap();
        let circle = round(&solver, "numerics.solver");
        assert_eq!((circle[1].as_str(), &circle[2]), ("Exact", &circle[0]));
        let rough = round(&flat, "roughness");
        assert_eq!((rough[1].as_str(), &rough[2]), ("None", &rough[0]));
    }

    #[test]
    fn each_way_of_giving_the_adhesion_keeps_its_own_numbers() {
        let mut typed = document().set("adhesion.range", "1.0e-9").unwrap();
        let mut around = Vec::new();
        for _ in 0..8 {
            typed = next(&typed, "adhesion", true);
            around.push(adhesion(&typed).to_owned());
        }
        let circle = [
            "(elastic_energy_ratio: 0.5, range: 1.0e-9)",
            "None",
            "(work: 0.05)",
            "(kappa: 6.0, range: 1.0e-9)",
        ];
        assert_eq!(around, [circle, circle].concat());
        let back = next(&next(&document(), "adhesion", true), "adhesion", false);
        assert_eq!(back.text(), SCENE);
        // A smooth body has no κ. Its adhesion is the usual work, or the work that a key has
        // replaced before.
        let smooth = |of: &Document| adhesion(&off(of, Effect::Roughness)).to_owned();
        let sticky = next(&document(), "adhesion", false)
            .set("adhesion.work", "0.3")
            .unwrap();
        assert_eq!(
            [
                smooth(&document()),
                smooth(&next(&sticky, "adhesion", true))
            ],
            ["(work: 0.05)", "(work: 0.3)"]
        );
        let flat = sticky.set("roughness", "None").unwrap();
        assert_eq!(next(&flat, "adhesion", true).scene().adhesion, None);
    }
}
