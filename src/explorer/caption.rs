//! Words for the event at the shown state of the contact: first contact, spreading, preload, detachment, pull-off,
//! separation.

use super::app::App;
use super::snapshot::Drive;
use crate::contact::{CurvePoint, Direction, LegRecord};

/// Share of the indentation range of a stage within which a point is at its end or at its smallest force.
const NEAR: f64 = 0.01;

/// Event at the shown state, short enough for the title of a pane of 34 columns; `None` before the first result and
/// where the body rests.
pub fn caption(app: &App) -> Option<&'static str> {
    let snapshot = app.present()?;
    match snapshot.drive {
        Drive::Manual => Some("manual loading"),
        Drive::Leg(index) => event(app.legs().get(index)?, snapshot.point),
    }
}

fn event(stage: &LegRecord, point: CurvePoint) -> Option<&'static str> {
    let (first, last) = (stage.curve.first()?, stage.curve.last()?);
    let range = (last.indentation - first.indentation).abs();
    let is_near = |other: &CurvePoint| (point.indentation - other.indentation).abs() <= NEAR * range;
    match stage.direction {
        _ if range == 0.0 => None,
        Direction::Loading => Some(match point {
            CurvePoint { springs: 0, .. } => "approach",
            _ if is_near(last) => "turning point",
            _ if stage.curve.iter().find(|point| point.springs > 0).is_some_and(is_near) => "jump-in",
            CurvePoint { force, .. } if force < 0.0 => "spreads under tension",
            _ => "contact spreads",
        }),
        Direction::Unloading => Some(match point {
            CurvePoint { springs: 0, .. } => "separated",
            _ if is_near(first) => "turning point",
            _ if is_near(&stage.smallest) => "pull-off",
            _ if point.indentation < stage.smallest.indentation => "detachment",
            CurvePoint { force, .. } if force < 0.0 => "under tension",
            _ => "contact shrinks",
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::History;
    use crate::scene::open;
    use crate::simulation::Simulation;

    fn history(name: &str) -> History {
        let document = open(name).unwrap();
        Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap().history
    }

    /// Events along a stage in the order of their first occurrence: on a rough profile some recur.
    fn events(stage: &LegRecord) -> Vec<&'static str> {
        let mut events = Vec::new();
        for event in stage.curve.iter().filter_map(|&point| event(stage, point)) {
            if !events.contains(&event) {
                events.push(event);
            }
        }
        events
    }

    #[test]
    fn a_loop_passes_its_events_in_order() {
        let history = history("pressure-sensitive");
        let [loading, unloading] = &history.legs[..] else { panic!("two stages") };
        assert_eq!(
            events(loading),
            ["approach", "jump-in", "spreads under tension", "contact spreads", "turning point"]
        );
        assert_eq!(
            events(unloading),
            ["turning point", "contact shrinks", "under tension", "pull-off", "detachment", "separated"]
        );
    }

    #[test]
    fn the_smallest_force_is_the_pull_off() {
        let history = history("jkr-sphere");
        let stage = &history.legs[1];
        assert_eq!(event(stage, stage.smallest), Some("pull-off"));
        let still = LegRecord { curve: vec![stage.smallest; 2], ..stage.clone() };
        assert_eq!(event(&still, stage.smallest), None);
    }
}
