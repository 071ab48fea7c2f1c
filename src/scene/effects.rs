//! Optional effects of a scene beyond the nonadhesive contact of a flat body.

use super::fields::field;
use super::model::{Adhesion, Move, Observer, Scene};
use super::roughness_parameter::RoughnessParameter;
use super::text::ron_float;
use super::write::{legs, observers};

/// Optional effect of a scene, switched by [`Document::with`](super::Document::with) and
/// [`Document::without`](super::Document::without).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// A macroscopic form; off: nominally flat.
    Form,
    /// Roughness; off: smooth.
    Roughness,
    /// Adhesion; off: the bodies do not attract each other.
    Adhesion,
    /// Loading stages that may pull; off: pressed and held.
    Unloading,
    /// The list of contact patches.
    Fragments,
    /// The histogram of heights.
    HeightHistogram,
}

impl Effect {
    /// All effects, in the order of a scene file.
    pub const ALL: [Effect; 6] = [
        Effect::Form,
        Effect::Roughness,
        Effect::Adhesion,
        Effect::Unloading,
        Effect::Fragments,
        Effect::HeightHistogram,
    ];

    /// Name and path of the effect.
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

    /// Technical name.
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// Path of the effect's [field](super::FIELDS).
    pub const fn path(self) -> &'static str {
        self.row().1
    }

    /// Returns true if the scene has the effect. A work of adhesion of zero is no adhesion.
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

    /// Observed quantity of the effect.
    pub(super) const fn observer(self) -> Option<Observer> {
        match self {
            Effect::Fragments => Some(Observer::Fragments),
            Effect::HeightHistogram => Some(Observer::HeightHistogram),
            _ => None,
        }
    }

    /// Value of the field, in RON, that suits a scene without the effect.
    pub(super) fn suited(self, scene: &Scene) -> String {
        match self {
            // At the ends of the profile its height is an eighth of the length.
            Effect::Form => format!("Paraboloid(radius: {})", ron_float(scene.length)),
            Effect::Roughness => {
                // Smooth on the scale of a spring and, under a form, on that of the contact.
                let last = (scene.numerics.points / 8).clamp(1, 512);
                let first = if scene.form.is_some() { last.min(4) } else { 1 };
                let height = ron_float(suited_height(scene));
                format!("SelfAffine(hurst: 0.7, rms_height: {height}, modes: ({first}, {last}), seed: 1)")
            }
            // κ refers to one work of adhesion: two of them may be left from a scene without adhesion.
            Effect::Adhesion if scene.roughness.is_some() => adhesion_as(scene, |adhesion| {
                Adhesion { range: adhesion.range, ..Adhesion::default() }.with_kappa(2.0)
            }),
            Effect::Adhesion => by_work(scene, 0.05),
            Effect::Unloading => legs(&[&scene.loading[..], &[Move::ToSeparation]].concat()),
            Effect::Fragments | Effect::HeightHistogram => {
                let all = Effect::ALL.into_iter().filter(|effect| *effect == self || effect.is_on(scene));
                observers(&all.filter_map(Effect::observer).collect::<Vec<_>>())
            }
        }
    }
}

/// Returns true for a stage that may pull. A first stage cannot, since it begins at separation.
fn may_pull(loading: &[Move]) -> bool {
    let mut reached = f64::NEG_INFINITY;
    loading.iter().enumerate().any(|(index, leg)| {
        let pulls = index > 0 && goes_back(*leg, reached);
        reached = reached.max(deepest(*leg));
        pulls
    })
}

/// Returns true for a stage that may return from the deepest indentation that earlier stages can reach.
fn goes_back(leg: Move, reached: f64) -> bool {
    match leg {
        Move::ToIndentation(to) => to < reached,
        Move::ToTouch => 0.0 < reached,
        Move::ToForce(_) | Move::ToZeroForce | Move::ToSeparation => true,
    }
}

/// The deepest indentation that a loading stage can reach, m; infinite for a force, whose indentation is unknown.
fn deepest(leg: Move) -> f64 {
    match leg {
        Move::ToIndentation(to) => to,
        Move::ToTouch => 0.0,
        Move::ToForce(_) | Move::ToZeroForce => f64::INFINITY,
        Move::ToSeparation => f64::NEG_INFINITY,
    }
}

/// Indices of the loading stages that remain without those that may pull: the path to the largest force, or the
/// deepest indentation, that certainly leads inwards. Keeps at least the first stage, or one that passes its end.
pub(super) fn pressing(loading: &[Move]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    let mut reached = f64::NEG_INFINITY;
    for (index, leg) in loading.iter().enumerate() {
        let replaces = kept.last().is_some_and(|last| passes(*leg, loading[*last]));
        if replaces {
            // A point passed on the path needs no stage of its own.
            kept.clear();
        } else if !kept.is_empty() && goes_back(*leg, reached) {
            continue;
        }
        kept.push(index);
        reached = reached.max(deepest(*leg));
    }
    kept
}

/// Returns true for a stage that certainly passes the end of another one on its path inwards: a larger force.
fn passes(leg: Move, other: Move) -> bool {
    let Move::ToForce(force) = leg else { return false };
    match other {
        Move::ToForce(before) => force > before,
        // Up to first touch nothing is pressed, so the force is zero or tensile.
        Move::ToZeroForce | Move::ToTouch => force > 0.0,
        Move::ToIndentation(indentation) => indentation <= 0.0 && force > 0.0,
        Move::ToSeparation => false,
    }
}

/// An rms height that suits the length of a scene, to two digits: a five-hundredth of the length.
fn suited_height(scene: &Scene) -> f64 {
    let height = scene.length / 500.0;
    format!("{height:.1e}").parse().unwrap_or(height)
}

/// Adhesion of a scene by this work, in RON.
pub(super) fn by_work(scene: &Scene, work: f64) -> String {
    adhesion_as(scene, |adhesion| adhesion.with_work(work))
}

/// Adhesion of a scene by this value of a parameter, in RON.
pub(super) fn by_parameter(scene: &Scene, parameter: RoughnessParameter, value: f64) -> String {
    adhesion_as(scene, |adhesion| adhesion.with_parameter(parameter, value))
}

/// Adhesion of a scene with a change, in RON.
pub(super) fn adhesion_as(scene: &Scene, change: impl Fn(Adhesion) -> Adhesion) -> String {
    let changed = Scene { adhesion: Some(change(scene.adhesion.unwrap_or_default())), ..scene.clone() };
    field("adhesion", None).and_then(|field| field.written(&changed)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::strategies::{sound, sound_scenes};
    use super::*;
    use Move::{ToForce, ToIndentation, ToSeparation, ToTouch, ToZeroForce};

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

    fn left_of(loading: &[Move]) -> Vec<Move> {
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
            // The force at an indentation is unknown here, so a stage to a force may go back.
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
            // Neither the largest force nor the deepest certain indentation is lost.
            let force = |legs: &[Move]| legs.iter().fold(0.0_f64, |most, leg| match *leg {
                ToForce(force) => most.max(force),
                _ => most,
            });
            if matches!(scene.loading[0], ToForce(_)) {
                prop_assert_eq!(force(&left), force(&scene.loading));
            }
        }
    }
}
