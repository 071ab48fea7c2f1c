//! State of the animation of the loading, and the indentation that the animation shows now.

use asperity_contact::{Branch, LegRecord};

/// Distance above first touch at which the animation begins, as a share of the range of
/// indentations.
const LIFT: f64 = 0.12;

/// Position of the animation within a loading stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    Start,
    Indentation(f64),
    /// Point of pull-off, to which the animation returns after it has been played to its end. If
    /// the loading has no pull-off, this is the end of the stage.
    PullOff,
    /// The end of the stage. After a stage to separation, nothing is in contact.
    End,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    pub leg: usize,
    pub at: At,
    pub playing: bool,
}

impl Player {
    pub const START: Player = Player {
        leg: 0,
        at: At::Start,
        playing: true,
    };

    /// Returns the position of the animation after it has been played to its end: the pull-off or,
    /// if there is none, the end of the last loading stage.
    pub fn at_rest(legs: &[LegRecord]) -> Player {
        let (leg, at) = match pull_off(legs) {
            Some((leg, _)) => (leg, At::PullOff),
            None => (legs.len().saturating_sub(1), At::End),
        };
        Player {
            leg,
            at,
            playing: false,
        }
    }

    /// Adapts this position of the animation to loading stages that may have changed. If the stage
    /// of the position no longer exists, the position becomes the end of the last stage. A position
    /// at the pull-off becomes the position of the new pull-off. Any other position is limited to
    /// the range of its stage.
    pub fn within(self, legs: &[LegRecord]) -> Player {
        let Some(last) = legs.len().checked_sub(1) else {
            return self;
        };
        if self.at == At::PullOff {
            return Player::at_rest(legs);
        }
        if self.leg > last {
            return Player {
                leg: last,
                at: At::End,
                playing: false,
            };
        }
        Player {
            at: self.advanced(legs, 0.0),
            ..self
        }
    }

    /// Returns the indentation in m that the animation shows.
    pub fn indentation(&self, legs: &[LegRecord]) -> f64 {
        match self.at {
            At::Start => start_of(legs, self.leg),
            At::Indentation(indentation) => indentation,
            At::PullOff => pull_off(legs).map_or(0.0, |(_, indentation)| indentation),
            At::End => legs.get(self.leg).map_or(0.0, LegRecord::end),
        }
    }

    /// Returns the share of the loading stage that the animation has shown, from 0 to 1.
    pub fn share(&self, legs: &[LegRecord]) -> f64 {
        let Some(end) = legs.get(self.leg).map(LegRecord::end) else {
            return 0.0;
        };
        let start = start_of(legs, self.leg);
        match self.at {
            At::Start => 0.0,
            At::End => 1.0,
            _ if start == end => 0.0,
            _ => ((self.indentation(legs) - start) / (end - start)).clamp(0.0, 1.0),
        }
    }

    /// Returns the position of the animation after it has moved on by `share` of the loading stage.
    /// The position stays between the ends of the stage.
    pub fn advanced(&self, legs: &[LegRecord], share: f64) -> At {
        let reached = self.share(legs) + share;
        let start = start_of(legs, self.leg);
        let end = legs.get(self.leg).map_or(start, LegRecord::end);
        if reached >= 1.0 || start == end && share > 0.0 {
            At::End
        } else if reached <= 0.0 {
            At::Start
        } else if share == 0.0 {
            self.at
        } else {
            At::Indentation(start + (end - start) * reached)
        }
    }
}

/// Returns the loading stage and the indentation in m of the pull-off; `None` if the force in the
/// last unloading is never tensile.
fn pull_off(legs: &[LegRecord]) -> Option<(usize, f64)> {
    let (leg, point) = Branch::pull_off(legs).filter(|(_, point)| point.force < 0.0)?;
    Some((leg, point.indentation))
}

/// Returns the lowest and the highest indentation in m on the curves of the given loading stages;
/// `None` if the curves have no points.
pub fn indentations(legs: &[LegRecord]) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    for point in legs.iter().flat_map(|leg| &leg.curve) {
        let indentation = point.indentation;
        range = Some(match range {
            Some((low, high)) => (low.min(indentation), high.max(indentation)),
            None => (indentation, indentation),
        });
    }
    range
}

/// Returns the indentation in m at which the animation of loading stage number `leg` begins. The
/// animation of the first stage begins a little above first touch.
pub fn start_of(legs: &[LegRecord], leg: usize) -> f64 {
    let start = legs.get(leg).map_or(0.0, LegRecord::start);
    if leg > 0 {
        return start;
    }
    let (low, high) = indentations(legs).unwrap_or((0.0, 0.0));
    start - LIFT * (high - low)
}
