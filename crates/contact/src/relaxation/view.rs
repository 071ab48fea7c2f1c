//! Points and patches of a state as a caller sees them: of the profile before its division.

use super::division::Division;
use super::patch::StretchedPatch;
use super::state::{Phase, State};
use crate::foundation::Foundation;
use crate::history::{CurvePoint, Patch};

/// Converts states to points and patches.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Foundation of the profile after its division.
    pub foundation: Foundation,
    /// Share of the modulus that remains after a long time.
    pub remaining: f64,
    pub division: Option<&'a Division>,
}

impl View<'_> {
    /// Returns the point of the force curve.
    pub fn point(&self, state: &State) -> CurvePoint {
        let mut point = state.point(self.foundation, self.remaining);
        let Some(division) = self.division else {
            return point;
        };
        // The division has further springs, which do not count.
        point.springs = match &state.phase {
            Phase::Apart => 0,
            Phase::Deepest => division
                .springs_of_approach(state.indentation)
                .unwrap_or(point.springs),
            Phase::Turned(_) => {
                let patches = self.turned_patches(state).unwrap_or_default();
                let springs = patches.iter().map(|patch| patch.springs().len());
                springs.sum::<usize>() as u64
            }
        };
        point
    }

    /// Returns the patches of a body above its largest indentation; otherwise `None`.
    pub fn turned_patches(&self, state: &State) -> Option<Vec<Patch>> {
        let Phase::Turned(turned) = &state.phase else {
            return None;
        };
        let patches = turned.patches.iter().map(StretchedPatch::range);
        Some(self.whole(patches.collect()))
    }

    /// Returns patches of the profile before its division.
    pub fn whole(&self, mut patches: Vec<Patch>) -> Vec<Patch> {
        if let Some(division) = self.division {
            for patch in &mut patches {
                *patch = division.whole(*patch);
            }
        }
        patches
    }
}
