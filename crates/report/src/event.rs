//! Names of the events at points of a loading history, such as first contact, preload, pull-off or
//! separation.

use asperity_contact::{Branch, CurvePoint, Direction, StageRecord};

/// A point counts as an end of a loading or unloading, or as the point with its smallest force, if
/// the distance between the two indentations is at most this share of the range of indentations.
const NEAR: f64 = 0.01;

/// Returns in a few words what happens at `point` of the force curve, such as `pull-off` or
/// `contact spreads`. The point lies on `branch`, a loading or unloading among the stages `stages`.
/// Returns `None` if the body does not move on this branch.
pub fn event(records: &[StageRecord], branch: &Branch, point: CurvePoint) -> Option<&'static str> {
    let stages = &records[branch.stages.clone()];
    let first = stages.first()?.curve.first()?;
    let last = stages.last()?.curve.last()?;
    let range = (last.indentation - first.indentation).abs();
    if range == 0.0 {
        return None;
    }
    let is_near =
        |other: &CurvePoint| (point.indentation - other.indentation).abs() <= NEAR * range;
    let is_under_tension = point.force < 0.0;
    let event = match branch.direction {
        Direction::Loading => {
            let mut points = stages.iter().flat_map(|stage| &stage.curve);
            let first_in_contact = points.find(|point| point.springs > 0);
            if point.springs == 0 {
                "approach"
            } else if is_near(last) {
                "turning point"
            } else if first_in_contact.is_some_and(is_near) {
                "jump-in"
            } else if is_under_tension {
                "spreads under tension"
            } else {
                "contact spreads"
            }
        }
        Direction::Unloading => {
            let smallest = branch.smallest(records).map_or(*last, |(_, point)| point);
            if point.springs == 0 {
                "separated"
            } else if is_near(first) {
                "turning point"
            } else if point.indentation < smallest.indentation {
                // The pull-off is the point with the smallest force, and not the state after the
                // jump that begins there.
                "detachment"
            } else if is_near(&smallest) {
                "pull-off"
            } else if is_under_tension {
                "under tension"
            } else {
                "contact shrinks"
            }
        }
    };
    Some(event)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::History;
    use asperity_scene::{Simulation, open};

    fn history(name: &str, loading: Option<&str>) -> History {
        let mut document = open(name).unwrap();
        if let Some(loading) = loading {
            document = document.set("loading", loading).unwrap();
        }
        Simulation::default()
            .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
            .unwrap()
            .history
    }

    /// Returns the events along a branch, each once, in the order in which they first occur. On a
    /// rough profile some events occur several times.
    fn events(records: &[StageRecord], branch: &Branch) -> Vec<&'static str> {
        let mut events = Vec::new();
        let points = records[branch.stages.clone()]
            .iter()
            .flat_map(|record| &record.curve);
        for event in points.filter_map(|&point| event(records, branch, point)) {
            if !events.contains(&event) {
                events.push(event);
            }
        }
        events
    }

    #[test]
    fn a_loop_passes_its_events_in_order() {
        let cut = "[ToTouch, ToForce(1.0e-5), ToForce(5.0e-6), ToForce(-1.0e-5), ToSeparation]";
        for loading in [None, Some(cut)] {
            let records = history("pressure-sensitive", loading).stages;
            let [loading, unloading] = &Branch::all(&records)[..] else {
                panic!("two branches")
            };
            assert_eq!(
                events(&records, loading),
                [
                    "approach",
                    "jump-in",
                    "spreads under tension",
                    "contact spreads",
                    "turning point"
                ]
            );
            assert_eq!(
                events(&records, unloading),
                [
                    "turning point",
                    "contact shrinks",
                    "under tension",
                    "pull-off",
                    "detachment",
                    "separated"
                ]
            );
        }
    }

    #[test]
    fn the_smallest_force_is_the_pull_off() {
        let records = history("jkr-sphere", None).stages;
        let unloading = Branch::last_unloading(&records).unwrap();
        let smallest = records[1].smallest;
        assert_eq!(event(&records, &unloading, smallest), Some("pull-off"));
        let after = CurvePoint {
            indentation: smallest.indentation.next_down(),
            ..smallest
        };
        assert_eq!(event(&records, &unloading, after), Some("detachment"));
        let still = [StageRecord {
            curve: vec![smallest; 2],
            ..records[1].clone()
        }];
        assert_eq!(
            event(
                &still,
                &Branch {
                    stages: 0..1,
                    ..unloading
                },
                smallest
            ),
            None
        );
    }
}
