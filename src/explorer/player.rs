//! State of the animation of the loading, and the indentation that the animation shows now.

use asperity_contact::{Branch, StageRecord};
use serde::{Deserialize, Serialize};

/// Distance above first touch at which the animation begins, as a share of the range of
/// indentations.
const LIFT: f64 = 0.12;

/// Position of the animation within a loading stage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    pub stage: usize,
    pub at: At,
    pub playing: bool,
}

impl Player {
    pub const START: Player = Player {
        stage: 0,
        at: At::Start,
        playing: true,
    };

    /// Returns the position of the animation after it has been played to its end: the pull-off or,
    /// if there is none, the end of the last loading stage.
    pub fn at_rest(stages: &[StageRecord]) -> Player {
        let (stage, at) = match pull_off(stages) {
            Some((stage, _)) => (stage, At::PullOff),
            None => (stages.len().saturating_sub(1), At::End),
        };
        Player {
            stage,
            at,
            playing: false,
        }
    }

    /// Adapts this position of the animation to loading stages that may have changed. If the stage
    /// of the position no longer exists, the position becomes the end of the last stage. A position
    /// at the pull-off becomes the position of the new pull-off. Any other position is limited to
    /// the range of its stage.
    pub fn within(self, stages: &[StageRecord]) -> Player {
        let Some(last) = stages.len().checked_sub(1) else {
            return self;
        };
        if self.at == At::PullOff {
            return Player::at_rest(stages);
        }
        if self.stage > last {
            return Player {
                stage: last,
                at: At::End,
                playing: false,
            };
        }
        Player {
            at: self.advanced(stages, 0.0),
            ..self
        }
    }

    /// Returns the indentation in m that the animation shows.
    pub fn indentation(&self, stages: &[StageRecord]) -> f64 {
        match self.at {
            At::Start => start_of(stages, self.stage),
            At::Indentation(indentation) => indentation,
            At::PullOff => pull_off(stages).map_or(0.0, |(_, indentation)| indentation),
            At::End => stages.get(self.stage).map_or(0.0, StageRecord::end),
        }
    }

    /// Returns the share of the loading stage that the animation has shown, from 0 to 1.
    pub fn share(&self, stages: &[StageRecord]) -> f64 {
        let Some(end) = stages.get(self.stage).map(StageRecord::end) else {
            return 0.0;
        };
        let start = start_of(stages, self.stage);
        match self.at {
            At::Start => 0.0,
            At::End => 1.0,
            _ if start == end => 0.0,
            _ => ((self.indentation(stages) - start) / (end - start)).clamp(0.0, 1.0),
        }
    }

    /// Returns the position of the animation after it has moved on by `share` of the loading stage.
    /// The position stays between the ends of the stage.
    pub fn advanced(&self, stages: &[StageRecord], share: f64) -> At {
        let reached = self.share(stages) + share;
        let start = start_of(stages, self.stage);
        let end = stages.get(self.stage).map_or(start, StageRecord::end);
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
fn pull_off(stages: &[StageRecord]) -> Option<(usize, f64)> {
    let (stage, point) = Branch::pull_off(stages).filter(|(_, point)| point.force < 0.0)?;
    Some((stage, point.indentation))
}

/// Returns the lowest and the highest indentation in m on the curves of the given loading stages;
/// `None` if the curves have no points.
pub fn indentations(stages: &[StageRecord]) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    for point in stages.iter().flat_map(|stage| &stage.curve) {
        let indentation = point.indentation;
        range = Some(match range {
            Some((low, high)) => (low.min(indentation), high.max(indentation)),
            None => (indentation, indentation),
        });
    }
    range
}

/// Returns the indentation in m at which the animation of loading stage number `stage` begins. The
/// animation of the first stage begins a little above first touch.
pub fn start_of(stages: &[StageRecord], stage: usize) -> f64 {
    let start = stages.get(stage).map_or(0.0, StageRecord::start);
    if stage > 0 {
        return start;
    }
    let (low, high) = indentations(stages).unwrap_or((0.0, 0.0));
    start - LIFT * (high - low)
}
