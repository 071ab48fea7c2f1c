//! The headline figures of a loading history.

use crate::contact::{Direction, History};
use crate::scene::{Leg, Scene};

/// Figures of one history; a figure the history does not have is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Preload F_n: largest force on a loading leg, N.
    pub preload: Option<f64>,
    /// Indentation at the preload, m.
    pub preload_indentation: Option<f64>,
    /// Adhesion force F_a: minus the smallest force on the last unloading leg, N; only where that leg
    /// pulls, that is where its smallest force is not above zero.
    pub adhesion_force: Option<f64>,
    /// Adhesion coefficient F_a/F_n; only under a preload.
    pub adhesion_coefficient: Option<f64>,
    /// Indentation at the smallest force, m.
    pub pull_off_indentation: Option<f64>,
    /// Energy lost over a history that ends separated, J.
    pub dissipated_energy: Option<f64>,
}

impl Figures {
    /// The figures of `history`.
    #[must_use]
    pub fn of(history: &History) -> Self {
        // What a separated body does on its way says nothing of the contact.
        let legs = || history.legs.iter().filter(|leg| leg.curve.iter().any(|point| point.springs > 0));
        let pressed = legs()
            .filter(|leg| leg.direction == Direction::Loading)
            .max_by(|a, b| a.largest.force.total_cmp(&b.largest.force));
        let preload = pressed.map(|leg| leg.largest);
        let pull = legs().rfind(|leg| leg.direction == Direction::Unloading);
        let smallest = pull.map(|leg| leg.smallest).filter(|point| point.force <= 0.0);
        // Not −F: that would make a force of zero negative.
        let adhesion_force = smallest.map(|point| 0.0 - point.force);
        let preload_force = preload.map(|point| point.force);
        // Where the force is to come back to zero, what is left of it is rounding.
        let under_load = pressed.is_some_and(|leg| leg.leg != Leg::ToForce(0.0));
        let ends_separated =
            history.legs.last().and_then(|leg| leg.curve.last()).is_some_and(|point| point.springs == 0);
        Figures {
            preload: preload_force,
            preload_indentation: preload.map(|point| point.indentation),
            adhesion_force,
            adhesion_coefficient: adhesion_force
                .zip(preload_force.filter(|&force| force > 0.0 && under_load))
                .map(|(adhesion, preload)| adhesion / preload)
                .filter(|coefficient| coefficient.is_finite()),
            pull_off_indentation: smallest.map(|point| point.indentation),
            // From −0 to 0 where nothing is lost.
            dissipated_energy: ends_separated
                .then(|| history.legs.iter().map(|leg| leg.dissipated_energy).sum::<f64>() + 0.0),
        }
    }

    /// Whether a scene's own loading is that of the touch protocol, so that its adhesion force is
    /// F_a(0).
    #[must_use]
    pub fn is_touch_protocol(scene: &Scene) -> bool {
        scene.loading == [Leg::ToTouch, Leg::ToSeparation]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactTree, Foundation, GridEdges, HessRule, exact, run};

    #[test]
    fn only_a_preload_gives_a_coefficient() {
        let gaps: Vec<f64> = (0..101).map(|index| (f64::from(index - 50) * 0.02).powi(2)).collect();
        let tree = ContactTree::build(&gaps, crate::scene::Edges::Grid).unwrap();
        let foundation = Foundation::endless(0.02, 1.0);
        let rule = GridEdges::new(HessRule::new(foundation, 0.001));
        let figures = |first| {
            let mut body = exact::adhesive(&gaps, &tree, rule, foundation, 16);
            Figures::of(&run(&mut body, &[first, Leg::ToSeparation], |_, _| Ok(())).unwrap())
        };
        let (pressed, returned) = (figures(Leg::ToForce(0.01)), figures(Leg::ToForce(0.0)));
        let adhesion = pressed.adhesion_force.unwrap();
        assert_eq!(pressed.adhesion_coefficient, Some(adhesion / pressed.preload.unwrap()));
        assert!(returned.adhesion_force.unwrap() > 0.0 && returned.preload.is_some());
        assert_eq!(returned.adhesion_coefficient, None);
    }
}
