//! The close-up of a contact patch: its position, the stretches of its springs and its force.

use super::request::{Focus, SnapshotRequest};
use super::snapshot::{CloseUp, PatchFacts};
use asperity_contact::Patch;
use asperity_contact::motion::Stage;
use asperity_report::{LineColumns, Part, SectionContact};
use std::ops::Range;

/// Makes the close-up, which shows a few springs of the profile enlarged. These are the springs
/// that `request` names. The close-up also has the contact patch that is nearest to the middle of
/// these springs.
pub fn close_up(
    contact: &SectionContact<'_>,
    stage: &Stage,
    request: &SnapshotRequest,
    line: &mut LineColumns,
) -> CloseUp {
    let centre = centre(contact, request.focus);
    let number = nearest(contact.patches, centre);
    let patch = number.map(|number| contact.patches[number]);
    let shown = shown(contact.gaps.len(), centre, patch, request.close_up_springs);
    let part = Part {
        first: shown.start,
        springs: shown.len(),
        columns: request.close_up_columns,
    };
    CloseUp {
        section: contact.section(part, line),
        boundaries: boundaries(contact, shown),
        patch: number.and_then(|number| facts(contact, stage, number)),
    }
}

/// Returns the spring at each end of each patch, with its height in m. Springs outside the close-up
/// are left out.
fn boundaries(contact: &SectionContact<'_>, shown: Range<usize>) -> Vec<(usize, f64)> {
    let mut boundaries = Vec::new();
    let first_patch = contact
        .patches
        .partition_point(|patch| patch.last < shown.start);
    for patch in &contact.patches[first_patch..] {
        if patch.first >= shown.end {
            break;
        }
        if shown.contains(&patch.first) {
            boundaries.push((patch.first, contact.height(patch.first)));
        }
        if patch.last > patch.first && shown.contains(&patch.last) {
            boundaries.push((patch.last, contact.height(patch.last)));
        }
    }
    boundaries
}

fn facts(contact: &SectionContact<'_>, stage: &Stage, number: usize) -> Option<PatchFacts> {
    Some(PatchFacts {
        number,
        patch: contact.patches[number],
        state: stage.patch_state(contact.indentation, number)?,
    })
}

/// Smallest number of springs in a close-up of a patch.
const FEWEST: usize = 32;
/// Number of equal parts of a profile that one patch covers; the close-up shows as much as one
/// part.
const PARTS_OF_WHOLE: usize = 4;
/// Number of equal parts into which the profile is divided. If no spring is in contact, the
/// close-up shows one part.
const PARTS: usize = 32;

/// Returns the range of springs in a close-up. If the user has chosen the number of springs, the
/// range has this size and lies around the centre. Otherwise the range contains the whole patch,
/// and its size is a power of two, so that it does not change when the patch grows a little. If the
/// patch covers nearly the whole profile, which has a pane of its own, the range is only a part
/// around the centre.
fn shown(
    count: usize,
    centre: usize,
    patch: Option<Patch>,
    springs: Option<usize>,
) -> Range<usize> {
    let mut middle = centre;
    let springs = if let Some(springs) = springs {
        springs
    } else if let Some(patch) = patch {
        let needed = patch.springs().len() * 5 / 4;
        if needed >= count {
            (count / PARTS_OF_WHOLE).max(FEWEST)
        } else {
            let springs = needed.max(FEWEST).next_power_of_two();
            let step = springs / 16;
            middle = patch.middle() / step * step;
            springs
        }
    } else {
        count / PARTS
    };
    let springs = springs.clamp(1, count.max(1));
    let first = middle.saturating_sub(springs / 2);
    let first = first.min(count.saturating_sub(springs));
    first..first + springs
}

/// Returns the spring at the centre of a close-up.
fn centre(contact: &SectionContact<'_>, focus: Focus) -> usize {
    match focus {
        Focus::Summit => summit(contact),
        Focus::Spring(spring) => spring.min(contact.gaps.len().saturating_sub(1)),
        Focus::After(spring) => {
            let from = spring.unwrap_or_else(|| summit(contact));
            middle_of_neighbour(contact, from, 1)
        }
        Focus::Before(spring) => {
            let from = spring.unwrap_or_else(|| summit(contact));
            middle_of_neighbour(contact, from, contact.patches.len().saturating_sub(1))
        }
    }
}

/// Returns the first spring at the highest point of the profile.
fn summit(contact: &SectionContact<'_>) -> usize {
    let highest = contact.gaps.iter().position(|gap| *gap == 0.0);
    highest.unwrap_or(contact.gaps.len() / 2)
}

/// Starts at the patch nearest to `spring`, goes `steps` patches to the right, and returns the
/// middle of the patch found there. The first patch follows the last one. If there are no patches,
/// it returns `spring`.
fn middle_of_neighbour(contact: &SectionContact<'_>, spring: usize, steps: usize) -> usize {
    match nearest(contact.patches, spring) {
        Some(number) => contact.patches[(number + steps) % contact.patches.len()].middle(),
        None => spring,
    }
}

/// Returns the index of the patch nearest to a spring. If two patches are equally near, returns the
/// index of the first one.
fn nearest(patches: &[Patch], spring: usize) -> Option<usize> {
    let after = patches.partition_point(|patch| patch.last < spring);
    let near = after.saturating_sub(1)..(after + 1).min(patches.len());
    near.min_by_key(|number| distance(patches[*number], spring))
}

/// Returns the distance of a spring from a patch, in springs. The distance is zero if the spring
/// belongs to the patch.
fn distance(patch: Patch, spring: usize) -> usize {
    let before = patch.first.saturating_sub(spring);
    let after = spring.saturating_sub(patch.last);
    before.max(after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_close_up_shows_a_part_of_a_patch_over_the_whole_profile() {
        let patch = |first: usize, last: usize| Some(Patch { first, last });
        assert_eq!(shown(1024, 300, patch(0, 1023), None), 172..428);
        assert_eq!(shown(1024, 0, patch(5, 1000), None), 0..256);
        // A smaller patch is shown as a whole, and the number of springs may be chosen.
        assert_eq!(shown(1024, 300, patch(256, 355), None), 240..368);
        assert_eq!(shown(1024, 300, patch(0, 1023), Some(1024)), 0..1024);
    }
}
