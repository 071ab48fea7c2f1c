//! Adhesion at first touch, F_a(0): the contact that forms at d = 0 on the way in, pulled off from there.

use super::exact::OverTree;
use super::ledger::Grid;
use super::springs::Thresholds;
use super::springs::{AdhesiveSprings, BodyMemory};
use super::{ContactError, ContactTree, EdgeRule, Foundation, Work};

/// Pulls off the contact of first touch, of which these are the roots of all fragments, and gives the
/// smallest force, N, exact to rounding.
///
/// Only springs in contact are looked at. `memory` holds their thresholds and serves for the next body.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub(crate) fn smallest_force<'a, C: OverTree<'a>>(
    tree: &'a ContactTree,
    rule: C::Rule,
    foundation: Foundation,
    roots: Vec<usize>,
    memory: &mut BodyMemory,
) -> Result<(f64, Work), ContactError> {
    let mut springs = AdhesiveSprings::of(tree, rule, roots, std::mem::take(memory))?;
    let held = springs.open(0.0);
    let contact = C::over(springs);
    let leg = contact.sample(Grid::new(held.separates.min(0.0), 0.0, C::SEARCH_INTERVALS));
    let mut work = Work {
        zero_load_passes: 1,
        hess_evaluations: held.springs,
        springs_tallied: held.springs,
        ..Work::default()
    };
    let smallest = contact.smallest(&leg, &mut work.events_sorted);
    *memory = contact.into_springs().into_memory();
    Ok((foundation.spring_stiffness() * smallest.compression, work))
}

/// Roots of the fragments in contact at first touch, for a loading on which nothing touches.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub(crate) fn roots<R: EdgeRule>(
    tree: &ContactTree,
    rule: R,
    memory: &mut BodyMemory,
) -> Result<(Vec<usize>, Work), ContactError> {
    let mut springs = AdhesiveSprings::new(tree, rule, std::mem::take(memory))?;
    let mut work = Work::default();
    springs.load(None, &mut work);
    let roots = springs.roots_at_touch().unwrap_or_default();
    *memory = springs.into_memory();
    Ok((roots, Work { zero_load_passes: 1, loading_passes: 0, ..work }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::whole::WholeSprings;
    use crate::contact::{GridEdges, HessRule, Solver, exact};
    use crate::scene::Leg;
    use proptest::prelude::*;

    const FOUNDATION: Foundation = Foundation { spacing: 0.01, effective_modulus: 2.0 };

    proptest! {
        #[test]
        fn is_what_the_touch_protocol_gives(
            levels in prop::collection::vec(0_u16..400, 1..120),
            work in 0.0..2.0_f64,
            deep in 0.0..1.0_f64,
        ) {
            let lowest = levels.iter().copied().min().unwrap_or(0);
            let gaps: Vec<f64> = levels.iter().map(|&level| f64::from(level - lowest) / 300.0).collect();
            let tree = ContactTree::build(&gaps).unwrap();
            let rule = GridEdges::new(HessRule::new(FOUNDATION, work));
            let mut protocol = exact::adhesive(&tree, rule, FOUNDATION, 2).unwrap();
            let touch = protocol.advance(Leg::ToTouch).unwrap();
            let back = protocol.advance(Leg::ToSeparation).unwrap();

            let mut body = exact::adhesive(&tree, rule, FOUNDATION, 7).unwrap();
            prop_assert_eq!(body.roots_at_touch(), None);
            body.advance(Leg::ToIndentation(-1.0)).unwrap();
            prop_assert_eq!(body.roots_at_touch(), None);
            body.advance(Leg::ToIndentation(deep)).unwrap();
            let known = body.roots_at_touch().unwrap();
            // What memory holds does not matter.
            let mut memory = BodyMemory::default();
            let (found, effort) = roots(&tree, rule, &mut memory).unwrap();
            prop_assert_eq!(&found, &known);
            prop_assert_eq!(effort.zero_load_passes, 1);
            let (force, effort) = smallest_force::<WholeSprings<_>>(&tree, rule, FOUNDATION, known, &mut memory).unwrap();
            prop_assert_eq!(force.to_bits(), back.smallest.force.to_bits());
            prop_assert_eq!(effort.springs_tallied, touch.joins);
            body.advance(Leg::ToSeparation).unwrap();
            prop_assert_eq!(body.roots_at_touch(), None);
        }
    }
}
