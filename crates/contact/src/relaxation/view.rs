//! Points and patches of a state as a caller sees them: of the profile before its division.

use super::division::Division;
use super::patch::StretchedPatch;
use super::state::{Phase, State};
use crate::error::ContactError;
use crate::foundation::Foundation;
use crate::history::{CurvePoint, Patch};

/// Converts states of a relaxing contact to points of the force curve and to patches of the profile
/// before its division.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Foundation of the profile after its division.
    pub foundation: Foundation,
    /// Share of the instantaneous modulus that remains after a long time.
    pub remaining: f64,
    pub division: Option<&'a Division>,
}

impl View<'_> {
    /// Returns the point of the force curve. Its number of springs is that of the profile before
    /// the division, unless the memory does not suffice to count them.
    pub fn point(&self, state: &State) -> CurvePoint {
        let mut curve = [self.curve_point(state)];
        if matches!(state.phase, Phase::Deepest) && self.count_springs(&mut curve, vec![0]).is_err()
        {
            return self.curve_point(state);
        }
        curve[0]
    }

    /// Returns the point of the force curve. For a body at its largest indentation, the number of
    /// springs is that of the divided profile, until [`View::count_springs`] corrects it.
    pub fn curve_point(&self, state: &State) -> CurvePoint {
        let mut point = state.point(self.foundation, self.remaining);
        if self.division.is_some()
            && let Some(patches) = self.turned_patches(state)
        {
            // The division has further springs, which do not count.
            let springs = patches.iter().map(|patch| patch.springs().len());
            point.springs = springs.sum::<usize>() as u64;
        }
        point
    }

    /// Sets the numbers of springs to those of the profile before the division. `deepest` are the
    /// indices of the points of `curve` at which the body is at its largest indentation so far;
    /// only these points are changed.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn count_springs(
        &self,
        curve: &mut [CurvePoint],
        mut deepest: Vec<usize>,
    ) -> Result<(), ContactError> {
        let Some(division) = self.division else {
            return Ok(());
        };
        deepest.retain(|&index| curve[index].springs > 0);
        deepest.sort_by(|&point, &other| {
            let indentation = curve[point].indentation;
            indentation.total_cmp(&curve[other].indentation)
        });
        let indentations: Vec<f64> = deepest
            .iter()
            .map(|&index| curve[index].indentation)
            .collect();
        let counts = division.approach().curve(&indentations)?;
        for (index, count) in deepest.into_iter().zip(counts) {
            curve[index].springs = count.springs;
        }
        Ok(())
    }

    /// Returns the patches of a body that is above its largest indentation; `None` for any other
    /// body.
    pub fn turned_patches(&self, state: &State) -> Option<Vec<Patch>> {
        let Phase::Turned(turned) = &state.phase else {
            return None;
        };
        let patches = turned.patches.iter().map(StretchedPatch::range);
        Some(self.whole(patches.collect()))
    }

    /// Converts patches of the divided profile to patches of the profile before its division.
    pub fn whole(&self, mut patches: Vec<Patch>) -> Vec<Patch> {
        if let Some(division) = self.division {
            for patch in &mut patches {
                *patch = division.whole(*patch);
            }
        }
        patches
    }
}
