//! The neighbourhood of one fragment: its place, its stretches, its force.

use super::request::{Focus, SnapshotRequest};
use super::snapshot::{CloseUp, FragmentFacts};
use crate::contact::{Leg, PatchState};
use crate::draw::section::{Contact, LineColumns, Part};

/// The requested part of the line, and the fragment nearest to its middle.
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
    let begins = contact.fragments.partition_point(|&(_, last)| last < shown.start);
    let boundaries = contact.fragments[begins..]
        .iter()
        .take_while(|(first, _)| *first < shown.end)
        .flat_map(|&(start, end)| if start == end { vec![start] } else { vec![start, end] })
        .filter(|spring| shown.contains(spring))
        .map(|spring| (spring, contact.height(spring)))
        .collect();
    let fragment = nearest(contact.fragments, centre).and_then(|number| {
        let springs = contact.fragments[number];
        let state = leg.patch_state(contact.indentation, number)?;
        let PatchState { length, force, largest_stretch, most_stretched } = state;
        Some(FragmentFacts { number, springs, length, largest_stretch, most_stretched, force })
    });
    CloseUp { section, boundaries, fragment }
}

/// The spring in the middle of the close-up.
fn centre(contact: &Contact<'_>, focus: Focus) -> usize {
    let (count, fragments) = (contact.gaps.len(), contact.fragments);
    let summit = || (0..count).find(|&spring| contact.gaps[spring] == 0.0).unwrap_or(count / 2);
    let middle = |(first, last): (usize, usize)| first + (last - first) / 2;
    let best = |worth: &dyn Fn((usize, usize)) -> f64| {
        // Of equal fragments the first.
        let best = fragments.iter().rev().max_by(|a, b| worth(**a).total_cmp(&worth(**b)));
        best.map_or_else(summit, |&fragment| middle(fragment))
    };
    match focus {
        Focus::Summit => summit(),
        Focus::Spring(spring) => spring.min(count.saturating_sub(1)),
        Focus::After(spring) | Focus::Before(spring) => {
            let from = spring.unwrap_or_else(summit);
            let forward = matches!(focus, Focus::After(_));
            nearest(fragments, from).map_or(from, |number| {
                let next = if forward { number + 1 } else { number + fragments.len() - 1 };
                middle(fragments[next % fragments.len()])
            })
        }
        Focus::Largest => best(&|(first, last)| (last - first) as f64),
        Focus::MostLoaded => best(&|fragment| compression(contact, fragment).abs()),
    }
}

/// Sum of the compressions of a fragment's springs, m.
fn compression(contact: &Contact<'_>, (first, last): (usize, usize)) -> f64 {
    contact.gaps[first..=last].iter().map(|gap| contact.indentation - gap).sum()
}

/// The number of the fragment nearest to a spring.
fn nearest(fragments: &[(usize, usize)], spring: usize) -> Option<usize> {
    let after = fragments.partition_point(|&(_, last)| last < spring);
    let distance = |number: usize| {
        let (first, last) = fragments[number];
        first.saturating_sub(spring).max(spring.saturating_sub(last))
    };
    let near = after.saturating_sub(1)..(after + 1).min(fragments.len());
    near.min_by_key(|&number| distance(number))
}
