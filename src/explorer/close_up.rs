//! The neighbourhood of one fragment: where it is, what it bears, what it carries.

use super::reduce::{Contact, LineColumns, Part};
use super::snapshot::{CloseUp, FragmentFacts};
use super::worker::{Focus, MomentRequest};
use crate::contact::subcell::SubCellMoment;
use crate::contact::{Foundation, HessRule};

/// How the edges of fragments are read, and what they bear.
#[derive(Clone, Copy)]
pub enum EdgeLaw<'a> {
    /// A fragment of n springs is n cells long.
    WholeSprings(Option<HessRule>),
    /// Its edges lie between springs.
    BetweenSprings(SubCellMoment<'a>),
}

/// What a fragment bears.
struct Bearing {
    /// Its length in cells.
    cells: f64,
    /// Largest stretch, m.
    largest_stretch: f64,
    /// Stretch at its edge, or of its most stretched spring, m.
    most_stretched: f64,
    /// In cells times metres.
    compression: f64,
}

impl EdgeLaw<'_> {
    fn bearing(self, contact: &Contact<'_>, (first, last): (usize, usize)) -> Bearing {
        let deepest = || contact.gaps[first..=last].iter().copied().fold(0.0, f64::max);
        if let EdgeLaw::BetweenSprings(moment) = self {
            let slider = moment.slider((first, last));
            let cells = slider.length(contact.indentation);
            let edges = slider.edges(contact.indentation);
            return Bearing {
                cells,
                largest_stretch: moment.largest_stretch(cells),
                most_stretched: slider.level(contact.indentation) - contact.indentation,
                compression: compression_of_cells(contact, (first, last)) + edges.compression,
            };
        }
        let springs = last + 1 - first;
        let largest_stretch = match self {
            EdgeLaw::WholeSprings(Some(hess)) => hess.largest_stretch(springs as u32),
            _ => 0.0,
        };
        Bearing {
            cells: springs as f64,
            largest_stretch,
            most_stretched: deepest() - contact.indentation,
            compression: compression(contact, (first, last)),
        }
    }
}

/// The part of the line that a request asks to see from near.
pub fn close_up(
    contact: &Contact<'_>,
    request: &MomentRequest,
    foundation: Foundation,
    law: EdgeLaw<'_>,
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
    let fragment = nearest(contact.fragments, centre).map(|number| {
        let springs = contact.fragments[number];
        let Bearing { cells, largest_stretch, most_stretched, compression } = law.bearing(contact, springs);
        FragmentFacts {
            number,
            springs,
            length: foundation.contact_length(cells),
            largest_stretch,
            most_stretched,
            force: foundation.spring_stiffness() * compression,
        }
    });
    CloseUp { section, boundaries, fragment }
}

/// The spring in the middle of the close-up.
fn centre(contact: &Contact<'_>, focus: Focus) -> usize {
    let (count, fragments) = (contact.gaps.len(), contact.fragments);
    let summit = || (0..count).find(|&spring| contact.gaps[spring] == 0.0).unwrap_or(count / 2);
    let middle = |(first, last): (usize, usize)| first + (last - first) / 2;
    let best = |worth: &dyn Fn((usize, usize)) -> f64| {
        // The first of those that are worth as much.
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

/// The same of the whole cells between them.
fn compression_of_cells(contact: &Contact<'_>, (first, last): (usize, usize)) -> f64 {
    let cells = contact.gaps[first..=last].windows(2);
    cells.map(|cell| contact.indentation - 0.5 * (cell[0] + cell[1])).sum()
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
