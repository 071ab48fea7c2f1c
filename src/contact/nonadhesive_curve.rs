//! Contact without adhesion over the indentation: force, contact length, and the length of the patches that grow.

use super::contact_model::ContactModel;
use super::fragments::runs;
use super::grid::Grid;
use super::{ContactError, Foundation, Nonadhesive};
use crate::scene::Edges;

/// Contact without adhesion at one indentation, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NonadhesivePoint {
    /// Indentation d₁, m.
    pub indentation: f64,
    /// Force F₁, N.
    pub force: f64,
    /// Contact length, m; the stiffness is E* times this length.
    pub contact_length: f64,
    /// Mean length of the contact patches, m, each weighted by the growth of its length with the indentation:
    /// Σ l l′/Σ l′. `None` where no patch grows.
    pub growing_length: Option<f64>,
}

/// Contact without adhesion of springs of these gaps (m, the smallest 0) at ascending indentations, m.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub fn nonadhesive_curve(
    gaps: &[f64],
    edges: Edges,
    foundation: Foundation,
    indentations: &[f64],
) -> Result<Vec<NonadhesivePoint>, ContactError> {
    if indentations.is_empty() {
        return Ok(Vec::new());
    }
    let contact = Nonadhesive::new(gaps, edges);
    let sampled = contact.sample(Grid::at(indentations.to_vec()))?;
    let point = |(index, &indentation): (usize, &f64)| {
        let state = sampled.states[index].point(foundation);
        let (mut products, mut growth) = (0.0, 0.0);
        for (length, grows) in patches(gaps, edges, indentation) {
            products += length * grows;
            growth += grows;
        }
        let mean = Some(products / growth).filter(|mean| mean.is_finite());
        NonadhesivePoint {
            indentation,
            force: state.force,
            contact_length: state.contact_length,
            growing_length: mean.map(|length| foundation.contact_length(length)),
        }
    };
    Ok(indentations.iter().enumerate().map(point).collect())
}

/// Lengths of the contact patches at an indentation, m, and their growth with the indentation, both in units of the
/// distance between springs.
///
/// The growth is that of the straight line from spring to spring, also where only whole springs count.
fn patches(gaps: &[f64], edges: Edges, indentation: f64) -> impl Iterator<Item = (f64, f64)> {
    let spans = runs(gaps.iter().map(move |&gap| gap <= indentation));
    // The part of the cell at an edge that is in contact, and its growth; beyond the last spring the profile is level.
    let edge = move |inner: usize, outer: Option<&f64>| match outer {
        Some(&outer) => ((indentation - gaps[inner]) / (outer - gaps[inner]), (outer - gaps[inner]).recip()),
        None => (0.5, 0.0),
    };
    spans.into_iter().map(move |(first, last)| {
        let outer = first.checked_sub(1).and_then(|before| gaps.get(before));
        let [left, right] = [edge(first, outer), edge(last, gaps.get(last + 1))];
        let length = match edges {
            Edges::Grid => (last + 1 - first) as f64,
            Edges::SubCell => (last - first) as f64 + left.0 + right.0,
        };
        (length, left.1 + right.1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The lengths of the patches sum to the contact length, and their growths to its growth where none attaches.
        #[test]
        fn patches_make_up_the_contact(
            mut gaps in prop::collection::vec(0.0..1.0_f64, 1..60),
            indentation in 0.0..1.2_f64,
            sub_cell in any::<bool>(),
        ) {
            let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            gaps.iter_mut().for_each(|gap| *gap -= least);
            let edges = if sub_cell { Edges::SubCell } else { Edges::Grid };
            let foundation = Foundation::endless(0.5, 3.0);
            let point = |at: f64| nonadhesive_curve(&gaps, edges, foundation, &[at]).unwrap()[0];
            let all: Vec<(f64, f64)> = patches(&gaps, edges, indentation).collect();
            let together = 0.5 * all.iter().map(|patch| patch.0).sum::<f64>();
            let here = point(indentation);
            prop_assert!((together - here.contact_length).abs() < 1e-12 * together, "{together} {here:?}");
            let longest = 0.5 * all.iter().map(|patch| patch.0).fold(0.0, f64::max);
            prop_assert!(here.growing_length.is_none_or(|mean| mean <= longest * (1.0 + 1e-12)));
            let next = gaps.iter().copied().filter(|&gap| gap > indentation).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(here.growing_length.is_some(), next < f64::INFINITY);
            if sub_cell && next < f64::INFINITY {
                let step = 0.25 * (next - indentation);
                let grown = point(indentation + step).contact_length - here.contact_length;
                let expected = 0.5 * step * all.iter().map(|patch| patch.1).sum::<f64>();
                prop_assert!((grown - expected).abs() < 1e-9 * (expected + together), "{grown} {expected}");
            }
        }
    }

    #[test]
    fn patches_count_by_their_growth() {
        // One patch of a single spring between steep flanks, one of two between gentle ones.
        let gaps = [5.0, 0.0, 5.0, 0.0, 0.0, 2.0];
        let foundation = Foundation::endless(1.0, 1.0);
        let mean = |edges| nonadhesive_curve(&gaps, edges, foundation, &[1.0]).unwrap()[0].growing_length;
        let growth = [0.4, 0.7];
        let of =
            |lengths: [f64; 2]| (lengths[0] * growth[0] + lengths[1] * growth[1]) / (growth[0] + growth[1]);
        assert!((mean(Edges::Grid).unwrap() - of([1.0, 2.0])).abs() < 1e-15);
        assert!((mean(Edges::SubCell).unwrap() - of([0.4, 1.7])).abs() < 1e-15);
        assert_eq!(nonadhesive_curve(&gaps, Edges::Grid, foundation, &[]).unwrap(), []);
        assert_eq!(
            nonadhesive_curve(&[0.0; 4], Edges::SubCell, foundation, &[0.0]).unwrap()[0].growing_length,
            None
        );
    }
}
