//! Optional effects of a scene: form, roughness, adhesion and unloading.

use super::adhesion::{Adhesion, RoughnessParameter};
use super::model::{Roughness, Scene};
use asperity_contact::Move;
use asperity_data::round_to;
use asperity_surface::Form;
use std::cmp::Ordering;

/// Optional part of a scene that can be switched on and off as a whole, with
/// [`Document::with`](crate::scene::document::Document::with) and
/// [`Document::without`](crate::scene::document::Document::without).
///
/// ```
/// use asperity_scene::fields::Effect;
/// use asperity_scene::open;
///
/// let sphere = open("jkr-sphere")?;
/// assert!(Effect::Adhesion.is_on(sphere.scene()) && !Effect::Roughness.is_on(sphere.scene()));
/// assert!(!Effect::Adhesion.is_on(sphere.without(Effect::Adhesion)?.scene()));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Macroscopic form of the body.
    Form,
    /// Roughness of the body.
    Roughness,
    /// Adhesion between the bodies.
    Adhesion,
    /// Unloading: the loading stages after the first stage, which may move the body back.
    Unloading,
}

impl Effect {
    /// All optional parts of a scene, in the order of their fields in a scene file.
    pub const ALL: [Effect; 4] = [
        Effect::Form,
        Effect::Roughness,
        Effect::Adhesion,
        Effect::Unloading,
    ];

    /// Returns the name of this optional part: `form`, `roughness`, `adhesion` or `unloading`.
    pub const fn name(self) -> &'static str {
        match self {
            Effect::Form => "form",
            Effect::Roughness => "roughness",
            Effect::Adhesion => "adhesion",
            Effect::Unloading => "unloading",
        }
    }

    /// Returns the path in a scene of the field of this optional part: `loading` for the unloading,
    /// and the [`name`](Self::name) for any other part.
    pub const fn path(self) -> &'static str {
        if let Effect::Unloading = self {
            "loading"
        } else {
            self.name()
        }
    }

    /// Returns true if the scene has this optional part. A work of adhesion of zero counts as no
    /// adhesion.
    pub fn is_on(self, scene: &Scene) -> bool {
        match self {
            Effect::Form => scene.form.is_some(),
            Effect::Roughness => scene.roughness.is_some(),
            Effect::Adhesion => scene
                .adhesion
                .is_some_and(|adhesion| adhesion.work() != Some(0.0)),
            Effect::Unloading => may_pull(&scene.loading),
        }
    }

    /// Returns the scene with this optional part. The part gets values that suit the rest of the
    /// scene.
    pub(super) fn suited(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            // With this radius R, the depth of the body x²/(2R) at the ends of the profile is an
            // eighth of the length.
            Effect::Form => {
                scene.form = Some(Form::Paraboloid {
                    radius: scene.length,
                })
            }
            Effect::Roughness => {
                // The waves must be long on the scale of a spring. Under a form, they must be short
                // on the scale of the contact.
                let last = (scene.numerics.points / 8).clamp(1, 512);
                let first = if scene.form.is_some() { last.min(4) } else { 1 };
                scene.roughness = Some(Roughness::SelfAffine {
                    hurst: 0.7,
                    rms_height: Some(round_to(scene.length / 500.0, 2)),
                    rms_gradient: None,
                    modes: Some((first, last)),
                    wavelengths: None,
                    roll_off: None,
                    seed: 1,
                });
            }
            Effect::Adhesion => {
                let usual = if scene.roughness.is_some() {
                    Adhesion::by_parameter(RoughnessParameter::Kappa, 2.0)
                } else {
                    Adhesion::by_work(0.05)
                };
                let range = scene.adhesion.and_then(|adhesion| adhesion.range);
                scene.adhesion = Some(Adhesion { range, ..usual });
            }
            Effect::Unloading => scene.loading.push(Move::ToSeparation),
        }
        scene
    }
}

/// Returns true if a loading stage may move the body back. The first stage cannot do so because it
/// begins at separation.
fn may_pull(loading: &[Move]) -> bool {
    let mut deepest = f64::NEG_INFINITY;
    for (index, stage) in loading.iter().enumerate() {
        let (end, pulls) = match *stage {
            Move::ToIndentation(end) => (end, end < deepest),
            Move::ToTouch => (0.0, 0.0 < deepest),
            // The indentation at the end of a stage that ends at a force or a displacement is
            // unknown, so it may be smaller or larger than any other.
            Move::ToForce(_) | Move::ToZeroForce | Move::ToDisplacement(_) => (f64::INFINITY, true),
            Move::ToSeparation => (f64::NEG_INFINITY, true),
            Move::Hold(_) => (deepest, false),
        };
        if index > 0 && pulls {
            return true;
        }
        deepest = deepest.max(end);
    }
    false
}

/// Returns the stage that presses most: the stage with the largest force. If no stage ends at a
/// force, it is the stage with the deepest indentation, and otherwise the first stage.
pub(super) fn pressing(loading: &[Move]) -> Move {
    // `max_by` returns the last of several equal stages, so the stages are reversed to get the
    // first.
    loading
        .iter()
        .rev()
        .max_by(|stage, other| compare_pressure(**stage, **other))
        .copied()
        .unwrap_or(Move::ToZeroForce)
}

/// Compares how much two stages press the body. A stage that ends at a force counts as more than a
/// stage that ends at an indentation.
fn compare_pressure(stage: Move, other: Move) -> Ordering {
    let (rank, size) = pressure(stage);
    let (other_rank, other_size) = pressure(other);
    rank.cmp(&other_rank).then(size.total_cmp(&other_size))
}

/// Returns the rank of a stage among the stages that press the body, and the positive force in N or
/// indentation in m at which the stage ends. A stage that does not press has rank 0.
fn pressure(stage: Move) -> (u8, f64) {
    match stage {
        Move::ToForce(force) if force > 0.0 => (2, force),
        Move::ToIndentation(end) | Move::ToDisplacement(end) if end > 0.0 => (1, end),
        _ => (0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Move::{ToForce, ToIndentation, ToSeparation, ToTouch, ToZeroForce};

    #[test]
    fn the_stage_that_presses_most_is_left() {
        for (loading, left) in [
            (vec![ToForce(1.0), ToSeparation], ToForce(1.0)),
            (vec![ToZeroForce, ToSeparation], ToZeroForce),
            (
                vec![ToForce(1.0), ToForce(2.0), ToForce(0.5), ToZeroForce],
                ToForce(2.0),
            ),
            (
                vec![ToIndentation(-1.0), ToTouch, ToForce(1.0), ToSeparation],
                ToForce(1.0),
            ),
            (
                vec![ToTouch, ToIndentation(1.0), ToIndentation(2.0), ToTouch],
                ToIndentation(2.0),
            ),
            (vec![ToIndentation(-1.0), ToTouch], ToIndentation(-1.0)),
        ] {
            assert_eq!(pressing(&loading), left, "{loading:?}");
        }
    }
}
