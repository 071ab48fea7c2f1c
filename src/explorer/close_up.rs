//! The close-up of one contact patch: its position, its stretches, its force.

use super::request::{Focus, SnapshotRequest};
use super::snapshot::{CloseUp, PatchFacts};
use asperity_contact::{Leg, Patch};
use asperity_report::{Contact, LineColumns, Part};

/// Makes the close-up of the requested part of the line, with the patch nearest to its middle.
pub fn close_up(
    contact: &Contact<'_>,
    leg: &Leg,
    request: &SnapshotRequest,
    line: &mut LineColumns,
) -> CloseUp {
    let count = contact.gaps.len();
    let centre = centre(contact, request.focus);
    let springs = request.close_up_springs.clamp(1, count.max(1));
    let first = centre.saturating_sub(springs / 2).min(count.saturating_sub(springs));
    let part = Part { first, springs, columns: request.close_up_columns };
    let section = contact.section(part, line);
    let shown = first..first + springs;
    let begins = contact.patches.partition_point(|patch| patch.last < shown.start);
    let boundaries = contact.patches[begins..]
        .iter()
        .take_while(|patch| patch.first < shown.end)
        .flat_map(|patch| [Some(patch.first), Some(patch.last).filter(|last| *last > patch.first)])
        .flatten()
        .filter(|spring| shown.contains(spring))
        .map(|spring| (spring, contact.height(spring)))
        .collect();
    let patch = nearest(contact.patches, centre).and_then(|number| {
        let springs = contact.patches[number];
        Some(PatchFacts { number, patch: springs, state: leg.patch_state(contact.indentation, number)? })
    });
    CloseUp { section, boundaries, patch }
}

fn centre(contact: &Contact<'_>, focus: Focus) -> usize {
    let (count, patches) = (contact.gaps.len(), contact.patches);
    let summit = || (0..count).find(|&spring| contact.gaps[spring] == 0.0).unwrap_or(count / 2);
    let best = |worth: &dyn Fn(Patch) -> f64| {
        // Of equal patches the first.
        let best = patches.iter().rev().max_by(|a, b| worth(**a).total_cmp(&worth(**b)));
        best.map_or_else(summit, |patch| patch.middle())
    };
    match focus {
        Focus::Summit => summit(),
        Focus::Spring(spring) => spring.min(count.saturating_sub(1)),
        Focus::After(spring) | Focus::Before(spring) => {
            let from = spring.unwrap_or_else(summit);
            let forward = matches!(focus, Focus::After(_));
            nearest(patches, from).map_or(from, |number| {
                let next = if forward { number + 1 } else { number + patches.len() - 1 };
                patches[next % patches.len()].middle()
            })
        }
        Focus::Largest => best(&|patch| patch.springs().len() as f64),
        Focus::MostLoaded => best(&|patch| compression(contact, patch).abs()),
    }
}

/// Sum of the compressions of the springs of a patch, m.
fn compression(contact: &Contact<'_>, patch: Patch) -> f64 {
    contact.gaps[patch.springs()].iter().map(|gap| contact.indentation - gap).sum()
}

fn nearest(patches: &[Patch], spring: usize) -> Option<usize> {
    let after = patches.partition_point(|patch| patch.last < spring);
    let distance = |number: usize| {
        let Patch { first, last } = patches[number];
        first.saturating_sub(spring).max(spring.saturating_sub(last))
    };
    let near = after.saturating_sub(1)..(after + 1).min(patches.len());
    near.min_by_key(|&number| distance(number))
}
