//! Effects of a scene beyond the nonadhesive contact of a flat body, and those that a scene has.

use super::fields::field;
use super::model::{Adhesion, Leg, Observer, Scene};
use super::roughness_parameter::RoughnessParameter;
use super::text::ron_float;
use super::write::{legs, observers};

/// An effect that a scene has or not; [`Document::with`](super::Document::with) and
/// [`Document::without`](super::Document::without) switch it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// A macroscopic form; off: nominally flat.
    Form,
    /// Roughness; off: smooth.
    Roughness,
    /// Adhesion; off: the bodies do not attract each other.
    Adhesion,
    /// Legs of the loading history that pull; off: pressed and held.
    Unloading,
    /// The list of contact fragments.
    Fragments,
    /// The histogram of heights.
    HeightHistogram,
}

impl Effect {
    /// All effects, in the order in which a scene is written.
    pub const ALL: [Effect; 6] = [
        Effect::Form,
        Effect::Roughness,
        Effect::Adhesion,
        Effect::Unloading,
        Effect::Fragments,
        Effect::HeightHistogram,
    ];

    /// Its name and its field.
    const fn row(self) -> (&'static str, &'static str) {
        match self {
            Effect::Form => ("form", "form"),
            Effect::Roughness => ("roughness", "roughness"),
            Effect::Adhesion => ("adhesion", "adhesion"),
            Effect::Unloading => ("unloading", "loading"),
            Effect::Fragments => ("contact fragments", "observe"),
            Effect::HeightHistogram => ("height histogram", "observe"),
        }
    }

    /// Its name in the terms of the field.
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// Path of the [field](super::FIELDS) it lives in.
    pub const fn path(self) -> &'static str {
        self.row().1
    }

    /// The scene has the effect. A work of adhesion of zero is no adhesion.
    pub fn is_on(self, scene: &Scene) -> bool {
        match self {
            Effect::Form => scene.form.is_some(),
            Effect::Roughness => scene.roughness.is_some(),
            Effect::Adhesion => scene.adhesion.is_some_and(|adhesion| adhesion.work != Some(0.0)),
            Effect::Unloading => may_pull(&scene.loading),
            Effect::Fragments | Effect::HeightHistogram => {
                self.observer().is_some_and(|observer| scene.observe.contains(&observer))
            }
        }
    }

    /// The observed quantity that the effect is.
    pub(super) const fn observer(self) -> Option<Observer> {
        match self {
            Effect::Fragments => Some(Observer::Fragments),
            Effect::HeightHistogram => Some(Observer::HeightHistogram),
            _ => None,
        }
    }

    /// Value of the field with the effect, as RON, that suits a scene without the effect.
    pub(super) fn suited(self, scene: &Scene) -> String {
        match self {
            // At the ends of the line it is an eighth of its length high.
            Effect::Form => format!("Paraboloid(radius: {})", ron_float(scene.length)),
            Effect::Roughness => {
                // Smooth on the scale of a spring and, under a form, on that of the contact.
                let last = (scene.numerics.points / 8).clamp(1, 512);
                let first = if scene.form.is_some() { last.min(4) } else { 1 };
                let height = ron_float(suited_height(scene));
                format!("SelfAffine(hurst: 0.7, rms_height: {height}, modes: ({first}, {last}), seed: 1)")
            }
            Effect::Adhesion if scene.roughness.is_some() => {
                by_parameter(scene, RoughnessParameter::Kappa, 2.0)
            }
            Effect::Adhesion => by_work(scene, 0.05),
            Effect::Unloading => legs(&[&scene.loading[..], &[Leg::ToSeparation]].concat()),
            Effect::Fragments | Effect::HeightHistogram => {
                let all = Effect::ALL.into_iter().filter(|effect| *effect == self || effect.is_on(scene));
                observers(&all.filter_map(Effect::observer).collect::<Vec<_>>())
            }
        }
    }
}

/// Any stage may pull. A first stage cannot, since it begins in separation.
fn may_pull(loading: &[Leg]) -> bool {
    let mut reached = f64::NEG_INFINITY;
    loading.iter().enumerate().any(|(index, leg)| {
        let pulls = index > 0 && goes_back(*leg, reached);
        reached = reached.max(deepest(*leg));
        pulls
    })
}

/// A stage may go back from the deepest indentation that can have been reached before it.
fn goes_back(leg: Leg, reached: f64) -> bool {
    match leg {
        Leg::ToIndentation(to) => to < reached,
        Leg::ToTouch => 0.0 < reached,
        Leg::ToForce(_) | Leg::ToZeroForce | Leg::ToSeparation => true,
    }
}

/// The deepest indentation a leg can reach, m; what it takes to reach a force is not known.
fn deepest(leg: Leg) -> f64 {
    match leg {
        Leg::ToIndentation(to) => to,
        Leg::ToTouch => 0.0,
        Leg::ToForce(_) | Leg::ToZeroForce => f64::INFINITY,
        Leg::ToSeparation => f64::NEG_INFINITY,
    }
}

/// Indices of the loading stages that are left without those that may pull: the way to the largest force, or the deepest
/// indentation, that is certain to be a way in. At least the first stage is left, or one that passes its end.
pub(super) fn pressing(loading: &[Leg]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    let mut reached = f64::NEG_INFINITY;
    for (index, leg) in loading.iter().enumerate() {
        let replaces = kept.last().is_some_and(|last| passes(*leg, loading[*last]));
        if replaces {
            // A point passed on the way needs no leg of its own.
            kept.clear();
        } else if !kept.is_empty() && goes_back(*leg, reached) {
            continue;
        }
        kept.push(index);
        reached = reached.max(deepest(*leg));
    }
    kept
}

/// A stage is certain to pass the end of another one on its way in: a larger force.
fn passes(leg: Leg, other: Leg) -> bool {
    let Leg::ToForce(force) = leg else { return false };
    match other {
        Leg::ToForce(before) => force > before,
        // Up to first touch nothing is pressed, so the force is zero or pulls.
        Leg::ToZeroForce | Leg::ToTouch => force > 0.0,
        Leg::ToIndentation(indentation) => indentation <= 0.0 && force > 0.0,
        Leg::ToSeparation => false,
    }
}

/// An rms height that suits the length of a scene, to two digits: a five-hundredth of it.
fn suited_height(scene: &Scene) -> f64 {
    let height = scene.length / 500.0;
    format!("{height:.1e}").parse().unwrap_or(height)
}

/// Adhesion of a scene by this work, as RON.
pub(super) fn by_work(scene: &Scene, work: f64) -> String {
    adhesion_as(scene, |adhesion| adhesion.with_work(work))
}

/// Adhesion of a scene by this value of a parameter, as RON.
pub(super) fn by_parameter(scene: &Scene, parameter: RoughnessParameter, value: f64) -> String {
    adhesion_as(scene, |adhesion| adhesion.with_parameter(parameter, value))
}

/// Adhesion of a scene with a change, as RON.
pub(super) fn adhesion_as(scene: &Scene, change: impl Fn(Adhesion) -> Adhesion) -> String {
    let changed = Scene { adhesion: Some(change(scene.adhesion.unwrap_or_default())), ..scene.clone() };
    field("adhesion", None).and_then(|field| field.written(&changed)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::strategies::{sound, sound_scenes};
    use super::*;
    use Leg::{ToForce, ToIndentation, ToSeparation, ToTouch, ToZeroForce};

    #[test]
    fn effects_have_names_of_their_own_and_fields_of_the_table() {
        let mut names: Vec<_> = Effect::ALL.iter().map(|effect| effect.name()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Effect::ALL.len());
        assert!(Effect::ALL.iter().all(|effect| field(effect.path(), None).is_some()));
    }

    #[test]
    fn a_scene_calls_for_what_it_says() {
        let mut scene = sound();
        let on = |scene: &Scene| Effect::ALL.into_iter().filter(|e| e.is_on(scene)).collect::<Vec<_>>();
        assert_eq!(on(&scene), [Effect::Roughness, Effect::Adhesion, Effect::Unloading]);
        scene.adhesion = Some(Adhesion::default().with_work(0.0));
        scene.roughness = None;
        scene.observe = vec![Observer::HeightHistogram];
        scene.loading = vec![ToForce(1e-5)];
        assert_eq!(on(&scene), [Effect::HeightHistogram]);
        scene.adhesion = Some(Adhesion::default().with_kappa(2.0));
        assert_eq!(on(&scene), [Effect::Adhesion, Effect::HeightHistogram]);
    }

    fn left_of(loading: &[Leg]) -> Vec<Leg> {
        pressing(loading).into_iter().map(|index| loading[index]).collect()
    }

    #[test]
    fn only_what_presses_is_left() {
        for (loading, left) in [
            (vec![ToForce(1.0), ToSeparation], vec![ToForce(1.0)]),
            (vec![ToZeroForce, ToSeparation], vec![ToZeroForce]),
            (vec![ToForce(1.0), ToForce(2.0), ToForce(0.5), ToZeroForce], vec![ToForce(2.0)]),
            (vec![ToForce(1.0), ToSeparation, ToForce(3.0), ToSeparation], vec![ToForce(3.0)]),
            (vec![ToForce(2.0), ToForce(-1.0), ToForce(1.0)], vec![ToForce(2.0)]),
            (vec![ToIndentation(-1.0), ToTouch, ToForce(1.0), ToSeparation], vec![ToForce(1.0)]),
            (vec![ToZeroForce, ToForce(1.0)], vec![ToForce(1.0)]),
            (vec![ToIndentation(-1.0), ToForce(1.0)], vec![ToForce(1.0)]),
            (
                vec![ToTouch, ToIndentation(1.0), ToIndentation(0.5), ToIndentation(2.0), ToTouch],
                vec![ToTouch, ToIndentation(1.0), ToIndentation(2.0)],
            ),
            // The force at an indentation is not known here, so the way to a force may go back.
            (vec![ToIndentation(1.0), ToForce(1.0)], vec![ToIndentation(1.0)]),
            (vec![ToForce(1.0), ToIndentation(1.0)], vec![ToForce(1.0)]),
        ] {
            assert_eq!(left_of(&loading), left, "{loading:?}");
        }
    }

    proptest! {
        #[test]
        fn what_is_left_presses_and_was_there(scene in sound_scenes()) {
            let left = left_of(&scene.loading);
            prop_assert!(!left.is_empty() && !may_pull(&left));
            prop_assert_eq!(&left_of(&left), &left);
            if !may_pull(&scene.loading) {
                prop_assert_eq!(&left, &scene.loading);
            }
            // No force that was pressed with and nothing that was surely deeper is lost.
            let force = |legs: &[Leg]| legs.iter().fold(0.0_f64, |most, leg| match *leg {
                ToForce(force) => most.max(force),
                _ => most,
            });
            if matches!(scene.loading[0], ToForce(_)) {
                prop_assert_eq!(force(&left), force(&scene.loading));
            }
        }
    }
}
