//! Governing parameters of the scenes of a study.

use crate::analysis::Governing;
use crate::scene::{Roughness, Scene};
use crate::surface::SelfAffine;

/// Governing parameters of a scene with a self-affine profile.
pub(in crate::study) fn governing(scene: &Scene) -> Option<Governing> {
    let Some(Roughness::SelfAffine { hurst, modes: (first, last), .. }) = scene.roughness else {
        return None;
    };
    let wave_numbers = SelfAffine { hurst, first, last }.wave_numbers(scene.length);
    Some(Governing::of(scene, Some(wave_numbers), None))
}
