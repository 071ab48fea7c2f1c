//! Division of a coarse profile. Memories are straight between neighbouring springs. A profile with
//! few springs is divided into shorter pieces, which does not change its form.

use crate::contact::Contact;
use crate::error::ContactError;
use crate::history::Patch;
use crate::stage::Stage;
use asperity_data::resized;

/// Number of springs from which on a profile is not divided.
const ENOUGH: usize = 1000;

/// A profile whose cells, the parts between two neighbouring springs, are divided into equal parts.
pub struct Division {
    /// Number of parts of a cell, which is odd, so that the ends of the profile stay in place.
    parts: usize,
    springs: usize,
    /// Elastic approach of the profile before the division.
    coarse: Stage,
}

impl Division {
    /// Divides the profile of a contact into more springs. Returns `None` for a profile that
    /// already has enough springs.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn of(contact: &Contact) -> Result<Option<(Self, Contact)>, ContactError> {
        let springs = contact.gaps().len();
        if springs >= ENOUGH {
            return Ok(None);
        }
        let parts = ENOUGH.div_ceil(springs) | 1;
        let mut gaps = resized(Vec::new(), parts * springs, 0.0)?;
        for (index, gap) in gaps.iter_mut().enumerate() {
            *gap = divided_gap(contact.gaps(), parts, index);
        }
        let division = Division {
            parts,
            springs,
            coarse: Stage::approach(contact)?,
        };
        let divided = contact.with_profile(contact.profile.divided(gaps, parts)?);
        Ok(Some((division, divided)))
    }

    /// Returns the elastic loading of the profile before the division.
    pub fn approach(&self) -> &Stage {
        &self.coarse
    }

    /// Converts a patch of the divided profile to the springs of the profile before the division. A
    /// patch that contains none of these springs becomes the spring nearest to it.
    pub fn whole(&self, patch: Patch) -> Patch {
        let half = self.parts / 2;
        let first = (patch.first + self.parts - 1).saturating_sub(half) / self.parts;
        let last = patch.last.saturating_sub(half) / self.parts;
        let last = last.min(self.springs - 1);
        Patch {
            first: first.min(last),
            last,
        }
    }
}

/// Returns the gap in m of a spring of the divided profile.
fn divided_gap(gaps: &[f64], parts: usize, index: usize) -> f64 {
    let half = parts / 2;
    let last = gaps.len() - 1;
    let Some(place) = index.checked_sub(half) else {
        return gaps[0];
    };
    let cell = place / parts;
    let part = place % parts;
    if cell >= last || part == 0 {
        return gaps[cell.min(last)];
    }
    let share = part as f64 / parts as f64;
    (gaps[cell] + share * (gaps[cell + 1] - gaps[cell])).max(0.0)
}
