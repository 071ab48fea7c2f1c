//! The patches of a relaxing contact at one moment, with their forces and tensions.

use super::drive::Drive;
use super::field::Field;
use super::line::Line;
use super::patch::StretchedPatch;
use super::state::{Load, Phase, State};
use super::turn::Turn;
use crate::detachment::DetachmentRule;
use crate::error::ContactError;
use crate::history::{Direction, Patch};
use crate::stage::PatchState;

impl Drive {
    /// Returns the states of the patches in contact, from left to right.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn patch_states(&self, state: &State) -> Result<Vec<PatchState>, ContactError> {
        match &state.phase {
            Phase::Apart => Ok(Vec::new()),
            Phase::Deepest => {
                let (line, patches) = Turn {
                    stage: &self.approach.stage,
                    relaxation: self.relaxation,
                    history: &self.history,
                    deepest: state.deepest,
                    seconds: state.seconds,
                }
                .memories()?;
                Ok(self.states_of(&line, &patches, state))
            }
            Phase::Turned(turned) => Ok(self.states_of(&turned.line, &turned.patches, state)),
        }
    }

    fn states_of(&self, line: &Line, patches: &[StretchedPatch], state: &State) -> Vec<PatchState> {
        let field = self.field(line, state);
        patches
            .iter()
            .map(|patch| self.state_of(line, patch, &field))
            .collect()
    }

    fn state_of(&self, line: &Line, patch: &StretchedPatch, field: &Field) -> PatchState {
        let contact = &self.contact;
        let load = Load::of_patches(&[*patch], field);
        let left_edge = patch.left.spring as f64 + 0.5 - patch.left.share;
        let right_edge = patch.right.spring as f64 + 0.5 + patch.right.share;
        let opening = contact.rules().rule(Direction::Unloading);
        PatchState {
            springs: Patch {
                first: patch.left.spring,
                last: patch.right.spring,
            },
            edges: [left_edge, right_edge].map(|edge| contact.profile.place(edge)),
            length: contact.foundation.contact_length(load.length),
            force: contact.foundation.spring_stiffness() * load.force(field.remaining),
            largest_stretch: opening.largest_stretch(load.length),
            most_stretched: patch.tension(line, field),
        }
    }
}
