//! State of the animation of the loading, and the indentation that the animation shows now.

use asperity_contact::{Branch, CurvePoint, StageRecord};
use serde::{Deserialize, Serialize};

/// Distance above first touch at which the animation begins, as a share of the range of
/// indentations.
const LIFT: f64 = 0.12;

/// Position of the animation within a loading stage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum At {
    Start,
    /// Indentation in m in a stage without times.
    Indentation(f64),
    /// Time in s since first touch, in a stage of a body that relaxes.
    Seconds(f64),
    /// Point of pull-off, to which the animation returns after it has been played to its end. If
    /// the loading has no pull-off, this is the end of the stage.
    PullOff,
    /// The end of the stage. After a stage to separation, nothing is in contact.
    End,
}

/// The scale along which the animation moves through a loading stage, and its two ends: the time
/// since first touch in s if the body relaxes, otherwise the indentation in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    pub start: f64,
    pub end: f64,
    /// True if the scale is the time.
    pub is_timed: bool,
}

impl Course {
    /// Returns the course of loading stage number `stage`. The animation of the first stage begins
    /// a little above first touch.
    pub fn new(stages: &[StageRecord], stage: usize) -> Self {
        let Some(record) = stages.get(stage) else {
            return Course {
                start: 0.0,
                end: 0.0,
                is_timed: false,
            };
        };
        match record.times() {
            Some([start, end]) => Course {
                start: if stage == 0 { -LIFT * end } else { start },
                end,
                is_timed: true,
            },
            None => Course {
                start: start_of(stages, stage),
                end: record.end(),
                is_timed: false,
            },
        }
    }

    /// Returns the share of the course before a place on its scale, from 0 to 1.
    fn share(&self, place: f64) -> f64 {
        if self.start == self.end {
            return 0.0;
        }
        ((place - self.start) / (self.end - self.start)).clamp(0.0, 1.0)
    }

    /// Returns the position after a share of the course.
    fn at(&self, share: f64) -> At {
        let place = self.start + (self.end - self.start) * share;
        if self.is_timed {
            At::Seconds(place)
        } else {
            At::Indentation(place)
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    pub stage: usize,
    pub at: At,
    pub playing: bool,
}

/// Rest of the animation at a large jump, so that the eye can follow the jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// State just after the jump. If the animation is elsewhere, the rest is over.
    pub player: Player,
    /// Time in s at speed 1 until the animation moves on.
    pub left: f64,
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
            At::Seconds(seconds) => indentation_at(stages, self.stage, seconds),
            At::PullOff => pull_off(stages).map_or(0.0, |(_, point)| point.indentation),
            At::End => stages.get(self.stage).map_or(0.0, StageRecord::end),
        }
    }

    /// Returns the time in s since first touch that the animation shows; `None` if the body does
    /// not relax. Before first touch the time is negative.
    pub fn seconds(&self, stages: &[StageRecord]) -> Option<f64> {
        let record = stages.get(self.stage)?;
        let [_, last] = record.times()?;
        match self.at {
            At::Start => Some(Course::new(stages, self.stage).start),
            At::Seconds(seconds) => Some(seconds),
            At::Indentation(indentation) => record.time_of(&CurvePoint {
                indentation,
                ..CurvePoint::default()
            }),
            At::PullOff => match pull_off(stages) {
                Some((_, point)) => record.time_of(&point),
                None => Some(last),
            },
            At::End => Some(last),
        }
    }

    /// Returns the share of the loading stage that the animation has shown, from 0 to 1.
    pub fn share(&self, stages: &[StageRecord]) -> f64 {
        if stages.get(self.stage).is_none() {
            return 0.0;
        }
        let course = Course::new(stages, self.stage);
        match self.at {
            At::Start => 0.0,
            At::End => 1.0,
            _ => course.share(self.place(stages)),
        }
    }

    /// Returns the place of the animation on the scale of its stage: the time in s if the body
    /// relaxes, otherwise the indentation in m.
    pub fn place(&self, stages: &[StageRecord]) -> f64 {
        match self.seconds(stages) {
            Some(seconds) => seconds,
            None => self.indentation(stages),
        }
    }

    /// Returns the position of the animation after it has moved on by `share` of the loading stage.
    /// The position stays between the ends of the stage.
    pub fn advanced(&self, stages: &[StageRecord], share: f64) -> At {
        let reached = self.share(stages) + share;
        let course = Course::new(stages, self.stage);
        let is_foreign = match self.at {
            At::Indentation(_) => course.is_timed,
            At::Seconds(_) => !course.is_timed,
            _ => false,
        };
        if reached >= 1.0 || course.start == course.end && share > 0.0 {
            At::End
        } else if reached <= 0.0 {
            At::Start
        } else if share == 0.0 && !is_foreign {
            self.at
        } else {
            course.at(reached)
        }
    }
}

/// Returns the indentation in m at a time in s since first touch. Before first touch the body is
/// above the foundation.
fn indentation_at(stages: &[StageRecord], stage: usize, seconds: f64) -> f64 {
    let Some(record) = stages.get(stage) else {
        return 0.0;
    };
    if seconds < 0.0 {
        let course = Course::new(stages, stage);
        return start_of(stages, stage) * (seconds / course.start);
    }
    match record.at_time(seconds) {
        Some(point) => point.indentation,
        None => start_of(stages, stage),
    }
}

/// Returns the loading stage and the point of the pull-off; `None` if the force in the last
/// unloading is never tensile.
fn pull_off(stages: &[StageRecord]) -> Option<(usize, CurvePoint)> {
    Branch::pull_off(stages).filter(|(_, point)| point.force < 0.0)
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
