//! Directions of the stages of a loading, as far as known without a run.

use crate::contact::Target;
use crate::scene::Leg;

/// Numbers of loading stages of either direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Legs {
    loading: u64,
    unloading: u64,
    /// Stages that move no spring in contact.
    idle: u64,
    unclear: u64,
    /// Loading stages that form the contact.
    from_separation: u64,
}

/// State of the body before a stage, as far as known without a run.
#[derive(Clone, Copy)]
struct BodyState {
    /// True if the body is in contact; `None` if known only after the run.
    touches: Option<bool>,
    force: Option<f64>,
    indentation: Option<f64>,
}

enum Way {
    Loading,
    Unloading,
    Idle,
    Unclear,
}

impl Legs {
    pub fn of(loading: &[Leg]) -> Legs {
        let mut legs = Legs::default();
        let mut state = BodyState { touches: Some(false), force: Some(0.0), indentation: Some(0.0) };
        for leg in loading {
            let way = state.way(leg);
            match way {
                Way::Loading if state.touches == Some(false) => {
                    legs.from_separation += 1;
                    legs.loading += 1;
                }
                Way::Loading => legs.loading += 1,
                Way::Unloading => legs.unloading += 1,
                Way::Idle => legs.idle += 1,
                Way::Unclear => legs.unclear += 1,
            }
            state = state.after(leg);
        }
        legs
    }

    /// Number of all stages.
    pub fn all(self) -> u64 {
        self.loading + self.unloading + self.idle + self.unclear
    }

    /// Number of loading stages, if known for all.
    pub fn loading(self) -> Option<u64> {
        (self.unclear == 0).then_some(self.loading)
    }

    /// Passes over the tree for loading stages, if known: a contact that forms again needs none.
    pub fn loading_passes(self) -> Option<u64> {
        self.loading().map(|loading| loading - self.from_separation.saturating_sub(1))
    }

    /// Number of unloading stages, if known for all.
    pub fn unloading(self) -> Option<u64> {
        (self.unclear == 0).then_some(self.unloading)
    }
}

impl BodyState {
    fn way(self, leg: &Leg) -> Way {
        match (self.touches, Target::from(*leg)) {
            (Some(false), Target::Indentation(wanted)) if wanted < 0.0 => Way::Idle,
            (Some(false), Target::Separation) => Way::Idle,
            (Some(false), _) => Way::Loading,
            (None, _) => Way::Unclear,
            (Some(true), Target::Separation) => Way::Unloading,
            (Some(true), Target::Force(wanted)) => from_to(self.force, wanted),
            (Some(true), Target::Indentation(wanted)) => match (self.force, self.indentation) {
                // A pressing force requires an indentation.
                (Some(force), None) if force > 0.0 && wanted <= 0.0 => Way::Unloading,
                (_, indentation) => from_to(indentation, wanted),
            },
        }
    }

    fn after(self, leg: &Leg) -> BodyState {
        match Target::from(*leg) {
            Target::Force(force) => BodyState { touches: Some(true), force: Some(force), indentation: None },
            Target::Indentation(indentation) => {
                // The highest spring is in contact from d = 0 on; below, adhesion decides.
                let touches =
                    if indentation >= 0.0 { Some(true) } else { self.touches.filter(|touches| !touches) };
                BodyState { touches, force: None, indentation: Some(indentation) }
            }
            Target::Separation => BodyState { touches: Some(false), force: Some(0.0), indentation: None },
        }
    }
}

/// Equal numbers are undecided: rounding decides on which side of its target a stage has ended.
fn from_to(from: Option<f64>, to: f64) -> Way {
    match from {
        Some(from) if to > from => Way::Loading,
        Some(from) if to < from => Way::Unloading,
        _ => Way::Unclear,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Leg::{ToForce, ToIndentation, ToSeparation, ToTouch, ToZeroForce};

    #[test]
    fn legs_are_counted_where_they_are_clear() {
        for (loading, counts) in [
            (&[ToForce(1.0), ToSeparation][..], (Some(1), Some(1))),
            (&[ToZeroForce, ToSeparation], (Some(1), Some(1))),
            (&[ToForce(1.0), ToForce(0.5), ToForce(2.0), ToZeroForce, ToForce(-1.0)], (Some(2), Some(3))),
            (&[ToTouch, ToIndentation(1.0), ToIndentation(-1.0)], (Some(2), Some(1))),
            (&[ToForce(1.0), ToTouch, ToSeparation, ToSeparation], (Some(1), Some(2))),
            (&[ToIndentation(-1.0), ToSeparation, ToTouch], (Some(1), Some(0))),
            (&[ToForce(1.0), ToIndentation(1.0)], (None, None)),
            (&[ToTouch, ToIndentation(-1.0), ToSeparation], (None, None)),
        ] {
            let legs = Legs::of(loading);
            assert_eq!((legs.loading(), legs.unloading()), counts, "{loading:?}");
            assert_eq!(legs.all(), loading.len() as u64);
        }
    }

    #[test]
    fn the_contact_is_formed_each_time_the_body_comes_down() {
        for (loading, formed) in [
            (&[ToForce(1.0), ToSeparation][..], 1),
            (&[ToForce(1.0), ToForce(0.5), ToForce(2.0), ToSeparation], 1),
            (&[ToForce(1.0), ToSeparation, ToForce(2.0), ToSeparation, ToTouch], 3),
            (&[ToSeparation, ToIndentation(-1.0), ToTouch], 1),
            (&[], 0),
        ] {
            let legs = Legs::of(loading);
            assert_eq!(legs.from_separation, formed, "{loading:?}");
        }
    }
}
