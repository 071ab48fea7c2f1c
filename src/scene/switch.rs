//! Effects of a document switched off, on and to the next choice.
//!
//! Amplitude of the roughness, work of adhesion and κ or e_el/γ determine each other, so that switching one of them
//! off may require a replacement value. That value follows from the profile, which this module does not know: the
//! caller passes it from the computed scene.

use super::adhesion::{Adhesion, RoughnessParameter};
use super::document::{Document, pair};
use super::effects::{Effect, pressing};
use super::errors::{SceneError, SceneErrors};
use super::field::Field;
use super::model::{Roughness, Scene};
use super::range::{Range, choice_key};
use super::tree::{Tree, differing};
use crate::text::round_to;

/// Values that a scene determines through its profile, known after the computation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Computed {
    /// Work of adhesion γ, J/m².
    pub work_of_adhesion: Option<f64>,
    /// Roughness–adhesion parameter κ.
    pub kappa: Option<f64>,
    /// Elastic energy of conformity over the work of adhesion, e_el/γ.
    pub elastic_energy_ratio: Option<f64>,
    /// Root mean square height h of the roughness, m.
    pub rms_height: Option<f64>,
}

impl Document {
    /// This document without an effect; unchanged if the effect is off.
    ///
    /// Without roughness, adhesion by κ or e_el/γ becomes adhesion by work. Without adhesion, roughness with
    /// an amplitude set by adhesion keeps it as an rms height. `computed` has these values for this scene. Without
    /// unloading, the stage that presses most remains.
    ///
    /// # Errors
    /// A replacement value is not in `computed`, or is invalid.
    pub fn without(&self, effect: Effect, computed: &Computed) -> Result<Document, SceneErrors> {
        let mut scene = Scene::clone(self.scene());
        if !effect.is_on(&scene) {
            return Ok(self.clone());
        }
        let adhesion = scene.adhesion.unwrap_or_default();
        match (effect, &mut scene.roughness) {
            (Effect::Form, _) => scene.form = None,
            (Effect::Roughness, roughness) => {
                *roughness = None;
                if let Some((parameter, _)) = adhesion.parameter() {
                    let what = format!("{} requires roughness, and the work of adhesion", parameter.symbol());
                    let work = self.known(adhesion.work.or(computed.work_of_adhesion), "adhesion", &what)?;
                    let adhesion = Adhesion { kappa: None, elastic_energy_ratio: None, ..adhesion };
                    scene.adhesion = Some(adhesion.with_work(work));
                }
            }
            (Effect::Adhesion, roughness) => {
                if let Some(Roughness::SelfAffine { rms_height: height @ None, rms_gradient: None, .. }) =
                    roughness
                {
                    let what = "adhesion sets its amplitude, and the rms height";
                    *height = Some(self.known(computed.rms_height, "roughness", what)?);
                }
                scene.adhesion = None;
            }
            (Effect::Unloading, _) => scene.loading = vec![pressing(&scene.loading)],
            _ => scene.observe.retain(|other| Some(*other) != effect.observer()),
        }
        let overrides = overrides_to(self.scene(), &scene);
        let mut new = self.set_all(&overrides)?;
        let value = |document: &Document, path| document.value(path).unwrap_or_default().to_owned();
        let values = overrides.iter().map(|(path, _)| [path.clone(), value(self, path), value(&new, path)]);
        let removed = (effect, values.collect());
        new.removed.retain(|(other, _)| *other != effect);
        new.removed.push(removed);
        Ok(new)
    }

    /// This document with an effect; unchanged if the effect is on.
    ///
    /// Restores the values that were removed when the effect was switched off; values changed since stay. If there are
    /// none, or if they are no longer valid, the effect takes values that suit the scene.
    ///
    /// # Errors
    /// The effect is impossible in the scene, such as roughness on a single spring.
    pub fn with(&self, effect: Effect) -> Result<Document, SceneErrors> {
        if effect.is_on(self.scene()) {
            return Ok(self.clone());
        }
        let restored = self.removed.iter().find(|(off, _)| *off == effect).and_then(|(_, values)| {
            let unchanged = values.iter().filter(|[path, _, present]| self.value(path) == Some(present));
            let back: Vec<_> = unchanged.map(|[path, removed, _]| pair(path, removed.as_str())).collect();
            self.set_all(&back).ok().filter(|new| effect.is_on(new.scene()))
        });
        restored.map_or_else(|| self.with_scene(&effect.suited(self.scene())), Ok)
    }

    /// This document with the values of another scene. Of a group whose choices stay, the numbers change one by one.
    ///
    /// # Errors
    /// Invalid values.
    pub fn with_scene(&self, scene: &Scene) -> Result<Document, SceneErrors> {
        self.set_all(&overrides_to(self.scene(), scene))
    }

    /// This document with another adhesion; see [`Document::with_scene`].
    ///
    /// # Errors
    /// An invalid value.
    pub fn with_adhesion(&self, adhesion: Adhesion) -> Result<Document, SceneErrors> {
        self.with_scene(&Scene { adhesion: Some(adhesion), ..Scene::clone(self.scene()) })
    }

    /// This document with the next choice of a field in this direction that the scene allows; `None` if there is no
    /// other.
    ///
    /// Omitting an effect switches it off, and the next choice switches it on again. Adhesion by work, by κ and by
    /// e_el/γ are the same adhesion: `computed` has the values for this scene. Any other choice comes back as it was when
    /// this document or one that led to it left the choice.
    ///
    /// # Errors
    /// No other choice is allowed, or a converted value is not in `computed`.
    pub fn with_next_choice(
        &self,
        field: &Field,
        forwards: bool,
        computed: &Computed,
    ) -> Result<Option<Document>, SceneErrors> {
        let effect = Effect::ALL.into_iter().find(|effect| effect.path() == field.path);
        let is_on = effect.is_some_and(|effect| effect.is_on(self.scene()));
        if effect == Some(Effect::Adhesion) && is_on && self.scene().roughness.is_some() {
            self.known(computed.work_of_adhesion, "adhesion", "the same adhesion given the other way")?;
        }
        let Some(here) = Tree::of(self.scene()).written(field) else { return Ok(None) };
        let mut refused = None;
        let left = self.leaving(field, &here, computed);
        // The circle holds the choices and `None`; the present one need not be among them.
        let Range::Choice(choices) = field.range else { return Ok(None) };
        for distance in 1..=choices.len() as i32 + 1 {
            let next = field.stepped(&here, if forwards { distance } else { -distance }, false);
            let Some(next) = next.filter(|next| choice_key(next) != choice_key(&here)) else { break };
            let chosen = match effect {
                // The removed text where it is this choice: other choices lie on the way around the circle.
                Some(effect) if !is_on => match self.with(effect) {
                    Ok(back) if back.value(field.path).map(choice_key) != Some(choice_key(&next)) => {
                        self.with_choice(field.path, &next)
                    }
                    back => back,
                },
                Some(effect) if next == "None" => self.without(effect, computed),
                Some(Effect::Adhesion) => self.converted(&next, computed),
                _ => self.with_choice(field.path, &next),
            };
            match chosen {
                // Work and a parameter given together are two choices already.
                Ok(document) if document.scene() == self.scene() => {}
                Ok(mut document) => {
                    document.left = left;
                    return Ok(Some(document));
                }
                Err(errors) => refused = refused.or(Some(errors)),
            }
        }
        refused.map_or(Ok(None), Err)
    }

    /// The choices that keys have left and the present one, adhesion in each of its ways.
    fn leaving(&self, field: &Field, here: &str, computed: &Computed) -> Vec<(&'static str, String)> {
        let mut left = self.left.clone();
        let mut leave = |text: String| {
            left.retain(|(path, other)| *path != field.path || choice_key(other) != choice_key(&text));
            left.push((field.path, text));
        };
        if let (Range::Choice(choices), "adhesion", true) = (field.range, field.path, here != "None") {
            let same = choices.iter().filter_map(|choice| self.converted(choice, computed).ok());
            same.filter_map(|same| Some(same.value(field.path)?.to_owned())).for_each(&mut leave);
        }
        if here != "None" {
            leave(here.to_owned());
        }
        left
    }

    /// A choice as it was left, if that is still allowed, else at values that suit the scene or are usual.
    fn with_choice(&self, path: &str, choice: &str) -> Result<Document, SceneErrors> {
        let is_same = |text: &str| choice_key(text) == choice_key(choice);
        let left = self.left.iter().find(|(of, text)| *of == path && is_same(text));
        if let Some(back) = left.and_then(|(_, text)| self.set(path, text).ok()) {
            return Ok(back);
        }
        let effect = Effect::ALL.into_iter().find(|effect| effect.path() == path);
        let suited = effect.and_then(|effect| self.with_scene(&effect.suited(self.scene())).ok());
        let suited = suited.filter(|suited| suited.value(path).is_some_and(is_same));
        suited.map_or_else(|| self.set(path, choice), Ok)
    }

    /// The same adhesion by the next choice, or the usual value of that choice where there is no same one.
    fn converted(&self, next: &str, computed: &Computed) -> Result<Document, SceneErrors> {
        // A typed value comes back from a conversion to another one without digits of rounding.
        let typed =
            |value| if round_to(value, 10) == round_to(value, 14) { round_to(value, 10) } else { value };
        let adhesion = self.scene().adhesion.unwrap_or_default();
        let by = |parameter, value: Option<f64>| Some(adhesion.with_parameter(parameter, typed(value?)));
        let same = match choice_key(next) {
            "(kappa" => by(RoughnessParameter::Kappa, computed.kappa),
            "(elastic_energy_ratio" => {
                by(RoughnessParameter::ElasticEnergyRatio, computed.elastic_energy_ratio)
            }
            _ => computed.work_of_adhesion.map(|work| adhesion.with_work(work)),
        };
        same.map_or_else(|| self.set("adhesion", next), |same| self.with_adhesion(same))
    }

    /// A value of the computed scene for a field.
    fn known(&self, value: Option<f64>, field: &str, what: &str) -> Result<f64, SceneErrors> {
        value.ok_or_else(|| {
            let message = format!("{what} is not known yet: compute the scene first");
            SceneError::of(field, self.value(field).unwrap_or_default(), "", &message).into()
        })
    }
}

/// Overrides that make one scene another: a field that is no longer given is replaced with its group.
fn overrides_to(from: &Scene, to: &Scene) -> Vec<(String, String)> {
    let [from, to] = [from, to].map(Tree::of);
    let changed = differing([&from, &to], |before, after| after || !before).into_iter();
    changed.map(|field| pair(field.path, to.written(field).unwrap_or_default())).collect()
}

#[cfg(test)]
mod tests {
    use super::super::fields::field;
    use super::super::model::Move::{ToForce, ToSeparation};
    use super::*;

    const SCENE: &str = "(
    version: 1,
    material: (effective_modulus: 1.0e6),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.70, rms_height: 2.0e-7, modes: (1, 512), seed: 1), // rough
    adhesion: (kappa: 6.0), // as measured
    loading: [ToForce(1.0e-5), /* slowly */ ToSeparation],
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

    /// Roughness whose amplitude follows from work of adhesion and κ.
    fn both() -> Document {
        let set = [pair("roughness.rms_height", "None"), pair("adhesion.work", "0.1")];
        document().set_all(&set).unwrap()
    }

    fn off(document: &Document, effect: Effect) -> Document {
        document.without(effect, &COMPUTED).unwrap()
    }

    fn adhesion(document: &Document) -> (Option<f64>, Option<f64>) {
        document
            .scene()
            .adhesion
            .map_or((None, None), |adhesion| (adhesion.work, adhesion.parameter().map(|(_, value)| value)))
    }

    fn next(document: &Document, path: &str, forwards: bool) -> Document {
        let field = field(path, None).unwrap();
        document.with_next_choice(field, forwards, &COMPUTED).unwrap().unwrap()
    }

    #[test]
    fn an_effect_that_was_never_on_suits_the_scene() {
        let bare =
            "(version: 1, material: (effective_modulus: 1.0e6), length: 1.0e-4, loading: [ToForce(1.0e-5)])";
        let bare = Document::parse(bare, "scene").unwrap();
        let rough = "SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1)";
        for (effect, value) in [
            (Effect::Form, "Paraboloid(radius: 1.0e-4)"),
            (Effect::Roughness, rough),
            (Effect::Adhesion, "(work: 0.05)"),
            (Effect::Unloading, "[ToForce(1.0e-5), ToSeparation]"),
            (Effect::Fragments, "[Fragments]"),
        ] {
            assert_eq!(bare.with(effect).unwrap().value(effect.path()), Some(value));
        }
        let observed = bare.with(Effect::HeightHistogram).unwrap().with(Effect::Fragments).unwrap();
        assert_eq!(observed.value("observe"), Some("[Fragments, HeightHistogram]"));
        let sticky = bare.set("roughness", rough).unwrap().with(Effect::Adhesion).unwrap();
        assert_eq!(adhesion(&sticky), (None, Some(2.0)));
        // One spring carries no wave at all.
        let one = bare.set("numerics.points", "1").unwrap().with(Effect::Roughness).unwrap_err();
        assert!(one.to_string().contains("points/2 = 0"), "{one}");
    }

    #[test]
    fn without_adhesion_the_amplitude_it_set_stays() {
        let unknown = both().without(Effect::Adhesion, &Computed::default()).unwrap_err();
        assert!(unknown.to_string().contains("the rms height is not known yet"), "{unknown}");
        let without = off(&both(), Effect::Adhesion);
        assert_eq!(without.value("roughness.rms_height"), Some("1.5e-7"));
        assert_eq!(without.with(Effect::Adhesion).unwrap().scene(), both().scene());
    }

    #[test]
    fn what_was_changed_meanwhile_stays_changed() {
        let back = |smooth: &Document| smooth.with(Effect::Roughness).unwrap();
        let smooth = off(&document(), Effect::Roughness);
        let stickier = back(&smooth.with_adhesion(Adhesion::by_work(0.2)).unwrap());
        assert_eq!(
            (adhesion(&stickier), stickier.value("roughness.hurst")),
            ((Some(0.2), None), Some("0.70"))
        );
        let longer = back(&smooth.set("length", "2.0e-4").unwrap());
        assert_eq!((adhesion(&longer), longer.scene().length), ((None, Some(6.0)), 2e-4));
        let held = off(&document(), Effect::Unloading).set("loading.0", "ToForce(3.0e-5)").unwrap();
        let pulled = held.with(Effect::Unloading).unwrap();
        assert_eq!(pulled.scene().loading, [ToForce(3e-5), ToSeparation]);
        // A removed text that is no longer valid is replaced by values that suit the scene.
        let coarse = back(&smooth.set("numerics.points", "64").unwrap());
        assert_eq!(coarse.value("roughness.modes"), Some("(1, 8)"));
    }

    /// A measured surface is typed, not stepped to; here the other kinds of roughness are refused.
    #[test]
    fn steps_end_where_every_other_choice_is_refused() {
        let fields = [("roughness", "Measured(file: \"surface.txt\")"), ("numerics.points", "1")];
        let measured = document().set_all(&fields.map(|(path, value)| pair(path, value))).unwrap();
        for forwards in [true, false] {
            let field = field("roughness", None).unwrap();
            let refused = measured.with_next_choice(field, forwards, &Computed::default()).unwrap_err();
            assert!(refused.to_string().contains("points/2 = 0"), "{refused}");
        }
    }

    #[test]
    fn a_choice_comes_back_with_its_numbers_once_round() {
        let round = |from: &Document, path: &str| -> Vec<String> {
            let around =
                std::iter::successors(Some(from.clone()), |document| Some(next(document, path, true)));
            around.map(|document| document.value(path).unwrap_or("None").to_owned()).take(20).collect()
        };
        let flat = document().set("numerics.points", "4096").unwrap();
        let forms = round(&flat, "form");
        let circle = forms.iter().skip(1).position(|form| *form == forms[0]).unwrap() + 1;
        assert!(circle > 5 && forms[1] == "Paraboloid(radius: 1.0e-4)", "{forms:?}");
        assert!((0..20 - circle).all(|place| forms[place] == forms[place + circle]), "{forms:?}");
        // Typed values come back, forwards and backwards.
        let typed = next(&flat, "form", true).set("form.radius", "3.0e-4").unwrap();
        let away = next(&next(&typed, "form", true), "form", true);
        let back = next(&next(&away, "form", false), "form", false);
        assert_eq!(back.value("form"), Some("Paraboloid(radius: 3.0e-4)"));
        let first = round(&typed, "form");
        assert_eq!((first[0] == first[circle], &first[1..circle]), (true, &forms[2..=circle]));
        let solver = flat.set("numerics.solver", "Stepwise(step: 2.0e-9)").unwrap();
        let circle = round(&solver, "numerics.solver");
        assert_eq!((circle[1].as_str(), &circle[2]), ("Exact", &circle[0]));
        let rough = round(&flat, "roughness");
        assert_eq!((rough[1].as_str(), &rough[2]), ("None", &rough[0]));
    }

    #[test]
    fn the_next_choice_of_adhesion_is_the_same_adhesion() {
        let work = next(&document(), "adhesion", false);
        assert_eq!(adhesion(&work), (Some(0.0123), None));
        assert_eq!(next(&work, "adhesion", true).text(), SCENE);
        let none = next(&work, "adhesion", false);
        assert_eq!(none.scene().adhesion, None);
        assert_eq!(next(&none, "adhesion", true).text(), work.text());
        let ratio = next(&document(), "adhesion", true);
        assert_eq!(ratio.value("adhesion"), Some("(elastic_energy_ratio: 0.9)"));
        assert_eq!(next(&ratio, "adhesion", true).scene().adhesion, None);
        // Off, each choice is reached again.
        let off = next(&ratio, "adhesion", true);
        let choices = std::iter::successors(Some(off), |document| Some(next(document, "adhesion", true)));
        let choices: Vec<String> =
            choices.skip(1).take(4).map(|one| one.value("adhesion").unwrap_or("-").to_owned()).collect();
        assert_eq!(choices, ["(work: 0.0123)", "(kappa: 6.0)", "(elastic_energy_ratio: 0.9)", "None"]);
        // Not before the value has been computed.
        let field = field("adhesion", None).unwrap();
        let unknown = document().with_next_choice(field, false, &Computed::default()).unwrap_err();
        assert!(unknown.to_string().contains("compute the scene first"), "{unknown}");
        // A smooth body has no κ.
        let smooth = work.set("roughness", "None").unwrap();
        assert_eq!(next(&smooth, "adhesion", true).scene().adhesion, None);
        let ratio = next(&both(), "adhesion", true);
        assert_eq!(ratio.value("adhesion"), Some("(work: 0.1, elastic_energy_ratio: 0.9)"));
    }
}
