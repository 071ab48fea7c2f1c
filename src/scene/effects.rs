//! Effects of a scene beyond the nonadhesive contact of a flat body, and those that a scene has.

use super::model::{Leg, Observer, Scene};

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
            Effect::Fragments => scene.observe.contains(&Observer::Fragments),
            Effect::HeightHistogram => scene.observe.contains(&Observer::HeightHistogram),
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
            // What is passed on the way need not be a leg of its own.
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::fields::field;
    use super::super::model::Adhesion;
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
