//! The close-up of one contact patch: its position, its stretches, its force.

use super::request::{Focus, SnapshotRequest};
use super::snapshot::{CloseUp, PatchFacts};
use asperity_contact::Patch;
use asperity_contact::motion::Leg;
use asperity_report::{LineColumns, Part, SectionContact};

/// Makes the close-up of the requested part of the line, with the patch nearest to its middle.
pub fn close_up(
    contact: &SectionContact<'_>,
    leg: &Leg,
    request: &SnapshotRequest,
    line: &mut LineColumns,
) -> CloseUp {
    let count = contact.gaps.len();
    let centre = centre(contact, request.focus);
    let number = nearest(contact.patches, centre);
    let (first, springs) = shown(
        count,
        centre,
        number.map(|one| contact.patches[one]),
        request.close_up_springs,
    );
    let part = Part {
        first,
        springs,
        columns: request.close_up_columns,
    };
    let section = contact.section(part, line);
    let shown = first..first + springs;
    let begins = contact
        .patches
        .partition_point(|patch| patch.last < shown.start);
    let boundaries = contact.patches[begins..]
        .iter()
        .take_while(|patch| patch.first < shown.end)
        .flat_map(|patch| {
            [
                Some(patch.first),
                Some(patch.last).filter(|last| *last > patch.first),
            ]
        })
        .flatten()
        .filter(|spring| shown.contains(spring))
        .map(|spring| (spring, contact.height(spring)))
        .collect();
    let patch = number.and_then(|number| {
        let springs = contact.patches[number];
        Some(PatchFacts {
            number,
            patch: springs,
            state: leg.patch_state(contact.indentation, number)?,
        })
    });
    CloseUp {
        section,
        boundaries,
        patch,
    }
}

/// Smallest number of springs around a patch, and the part of the profile that is shown without a
/// contact patch.
const FEWEST: usize = 32;
const PART: usize = 32;

/// First spring and number of springs of a close-up: this many around its centre, or the whole
/// patch in a part whose size is a power of two, so that it stays the same while the patch grows a
/// little.
fn shown(
    count: usize,
    centre: usize,
    patch: Option<Patch>,
    springs: Option<usize>,
) -> (usize, usize) {
    let (middle, springs) = match (springs, patch) {
        (Some(springs), _) => (centre, springs),
        (None, Some(patch)) => {
            let springs = (patch.springs().len() * 5 / 4)
                .max(FEWEST)
                .next_power_of_two();
            let step = springs / 16;
            (patch.middle() / step * step, springs)
        }
        (None, None) => (centre, count / PART),
    };
    let springs = springs.clamp(1, count.max(1));
    (
        middle
            .saturating_sub(springs / 2)
            .min(count.saturating_sub(springs)),
        springs,
    )
}

fn centre(contact: &SectionContact<'_>, focus: Focus) -> usize {
    let (count, patches) = (contact.gaps.len(), contact.patches);
    let summit = || {
        (0..count)
            .find(|&spring| contact.gaps[spring] == 0.0)
            .unwrap_or(count / 2)
    };
    match focus {
        Focus::Summit => summit(),
        Focus::Spring(spring) => spring.min(count.saturating_sub(1)),
        Focus::After(spring) | Focus::Before(spring) => {
            let from = spring.unwrap_or_else(summit);
            let forward = matches!(focus, Focus::After(_));
            nearest(patches, from).map_or(from, |number| {
                let next = if forward {
                    number + 1
                } else {
                    number + patches.len() - 1
                };
                patches[next % patches.len()].middle()
            })
        }
    }
}

fn nearest(patches: &[Patch], spring: usize) -> Option<usize> {
    let after = patches.partition_point(|patch| patch.last < spring);
    let distance = |number: usize| {
        let Patch { first, last } = patches[number];
        first
            .saturating_sub(spring)
            .max(spring.saturating_sub(last))
    };
    let near = after.saturating_sub(1)..(after + 1).min(patches.len());
    near.min_by_key(|&number| distance(number))
}
