//! Manual loading and loading leg by leg find the same contact.

use super::*;
use asperity::contact::{Manual, ManualError, ManualLoading};

/// Target of a move; forces in units of the acting ones.
#[derive(Clone, Copy, Debug)]
enum Goal {
    Indentation(f64),
    Force(f64),
    Separation,
}

fn goals() -> impl Strategy<Value = Vec<Goal>> {
    let goal = prop_oneof![
        6 => (-0.9..1.3_f64).prop_map(Goal::Indentation),
        3 => (-0.5..1.0_f64).prop_map(|force| Goal::Force(force.powi(3))),
        1 => Just(Goal::Separation),
    ];
    prop::collection::vec(goal, 1..12)
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn manual_loading_goes_as_the_legs_do(body in any_body(120), goals in goals()) {
        let tree = Arc::new(body.tree());
        let mut legs = body.on(&tree, 2);
        let mut manual = Manual::new(&body.gaps, Arc::clone(&tree), body.edges(), body.foundation).unwrap();
        let scale = body.gaps.len() as f64 * body.foundation.spring_stiffness();
        let depth = 1.3 + body.largest_stretch();
        for goal in goals {
            let (leg, moved) = match goal {
                Goal::Indentation(to) => (Leg::ToIndentation(to), manual.move_to_indentation(to)),
                Goal::Force(force) => {
                    let force = force * body.force_scale();
                    (Leg::ToForce(force), manual.move_to_force(force))
                }
                Goal::Separation => (Leg::ToSeparation, Ok(manual.separate())),
            };
            let record = match (legs.advance(leg), moved.clone()) {
                (Ok(record), Ok(moved)) => {
                    prop_assert_eq!((record.attached, record.detached), (moved.attaches, moved.detaches), "{:?}", leg);
                    let lost = (record.released_energy, moved.released_energy);
                    let slack = 1e-12 * scale * depth * depth;
                    prop_assert!((lost.0 - lost.1).abs() <= slack, "{:?}: lost {:?}", leg, lost);
                    record
                }
                (Err(ContactError::DetachesBefore { smallest: a, .. }), Err(ManualError::DetachesBefore { smallest: b, .. })) => {
                    prop_assert!((a - b).abs() <= 1e-12 * scale * depth, "{:?}: {} {}", leg, a, b);
                    continue;
                }
                (Err(ContactError::NothingToPull { .. }), Err(ManualError::NothingToPull { .. })) => continue,
                other => panic!("{leg:?}: {other:?}"),
            };
            let (there, here) = (end(&record), manual.point());
            prop_assert!((there.indentation - here.indentation).abs() <= 1e-12 * depth, "{leg:?}: {there:?} {here:?}");
            if there.indentation == here.indentation {
                prop_assert_eq!((there.springs, there.fragments), (here.springs, here.fragments));
                prop_assert!((there.force - here.force).abs() <= 1e-13 * scale * depth, "{leg:?}: {there:?} {here:?}");
                if there.springs > 0 {
                    let contacts: Vec<_> = manual.fragments().collect();
                    prop_assert_eq!(&contacts, &legs.fragments(here.indentation));
                    let (tree, at) = (Arc::clone(&tree), here.indentation);
                    let taken =
                        {
                            let rises = legs.rises(at);
                            Manual::in_contact(&body.gaps, tree, body.edges(), body.foundation, at, &contacts, &rises)
                        };
                    let taken = taken.unwrap().point();
                    prop_assert!((taken.force - here.force).abs() <= 1e-13 * scale * depth, "{taken:?} {here:?}");
                }
            } else {
                // Rounding of a crossing: both go on from the same place.
                manual.move_to_indentation(there.indentation).unwrap();
                prop_assume!(manual.point().springs == there.springs);
            }
        }
    }
}
