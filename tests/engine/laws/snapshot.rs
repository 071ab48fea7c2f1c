//! A contact by itself: the fragments at a point of a curve reproduce that point.

use super::*;
use asperity::contact::{EdgeModel, Snapshot, SubCellEdges};

/// Moves a body along legs and compares points of each curve with snapshots of the fragments there.
fn looked_at<E: EdgeModel>(body: &Body, hess: HessRule, edges: E, legs: &[Leg]) -> Result<(), TestCaseError> {
    let tree = ContactTree::build(&body.gaps, E::EDGES).unwrap();
    let mut solver = exact::adhesive(&body.gaps, &tree, edges, body.foundation, 12);
    let snapshot = Snapshot::new(&body.gaps, body.deepest(), E::EDGES, Some(hess));
    let tolerance = 1e-9 * body.force_scale();
    for &leg in legs {
        let record = solver.advance(leg).unwrap();
        // At a point where part of the contact jumps, either side is right.
        for point in &record.curve {
            let fragments = solver.fragments(point.indentation);
            let rises = solver.rises(point.indentation);
            let springs: u64 = fragments.iter().map(|&(first, last)| (last - first + 1) as u64).sum();
            if springs != point.springs {
                continue;
            }
            let seen = snapshot.point(body.foundation, point.indentation, &fragments, &rises);
            prop_assert_eq!((seen.springs, seen.fragments), (point.springs, point.fragments));
            prop_assert_eq!(seen.indentation, point.indentation);
            prop_assert!((seen.force - point.force).abs() <= tolerance, "{:?} {:?}", seen, point);
            let spread = 1e-9 * body.foundation.spacing * body.gaps.len() as f64;
            prop_assert!(
                (seen.contact_length - point.contact_length).abs() <= spread,
                "{:?} {:?}",
                seen,
                point
            );
            // The parts sum to the whole, and none is stretched beyond its limit.
            let parts: Vec<_> = fragments
                .iter()
                .enumerate()
                .map(|(index, &ends)| snapshot.fragment(point.indentation, ends, rises.get(index).copied()))
                .collect();
            let sum = |of: fn(&asperity::contact::FragmentState) -> f64| parts.iter().map(of).sum::<f64>();
            let force = body.foundation.spring_stiffness() * sum(|part| part.compression);
            prop_assert!((force - point.force).abs() <= tolerance);
            let length = body.foundation.spacing * sum(|part| part.length);
            prop_assert!((length - point.contact_length).abs() <= spread);
            for (part, &(first, last)) in parts.iter().zip(&fragments) {
                prop_assert!(part.most_stretched <= part.largest_stretch * (1.0 + 1e-6) + 1e-9, "{:?}", part);
                let largest = std::f64::consts::PI * part.length * body.foundation.spacing * body.work
                    / body.foundation.effective_modulus;
                prop_assert!((part.largest_stretch / largest.sqrt() - 1.0).abs() < 1e-12);
                if E::EDGES == Edges::Grid {
                    let highest = body.gaps[first..=last].iter().copied().fold(0.0, f64::max);
                    prop_assert_eq!(part.most_stretched, highest - point.indentation);
                    prop_assert_eq!(part.length, (last - first + 1) as f64);
                }
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn a_look_at_a_contact_is_the_point_of_its_curve(
        body in body(), turns in indentations(5), closing in 0.0..1.0_f64,
    ) {
        let hess = HessRule::new(body.foundation, body.work);
        let two_works = HessRule::from_works(body.foundation, closing * body.work, body.work);
        for hess in [hess, two_works] {
            looked_at(&body, hess, GridEdges::new(hess), &to_indentations(&turns))?;
            looked_at(&body, hess, SubCellEdges::new(hess), &to_indentations(&turns))?;
        }
    }

    /// A history ends with as many contacts as its last point has fragments: none after separation.
    #[test]
    fn a_history_ends_with_the_contacts_of_its_last_point(body in body(), turns in indentations(5), apart: bool) {
        let mut legs = to_indentations(&turns);
        if apart {
            legs.push(Leg::ToSeparation);
        }
        let history = body.history(&legs, 8);
        prop_assert_eq!(history.contacts.len() as u64, end(&history).fragments);
        prop_assert_eq!(indices(&history.contacts).len() as u64, end(&history).springs);
    }
}
