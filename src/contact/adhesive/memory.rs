//! Memory of an adhesive contact.

use super::loading::Closing;
use super::run::{Held, Run};
use super::unloading::Opening;

/// Memory reused from body to body: fresh memory costs about as much as a pass.
#[derive(Clone, Debug, Default)]
pub struct AdhesiveMemory {
    pub(super) closing: Closing,
    pub(super) opening: Opening,
    /// Runs of the present leg.
    pub(super) runs: Vec<Run>,
    /// Runs of the leg before, or of an unloading beside the present one.
    pub(super) spare: Vec<Run>,
    pub(super) held: Vec<Held>,
}

impl AdhesiveMemory {
    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.closing.bytes() + size_of::<Run>() * (self.runs.capacity() + self.spare.capacity())
    }
}
