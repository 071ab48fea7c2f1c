//! The body under manual loading, with the path of its force curve.

use super::request::ManualMove;
use super::snapshot::ManualPath;
use asperity_contact::motion::{Body, Leg, Motion, MovingBody};
use asperity_contact::{CurvePoint, Direction, Move};
use asperity_data::round_to;
use asperity_scene::stages::Reach;

/// Number of points of the curve for one move.
const POINTS: u32 = 16;
/// Largest number of points of the curve for a motion to separation.
const MOST_POINTS: u32 = 512;

/// Where and how manual loading begins.
pub struct ManualBegin {
    /// Indentation at the begin, m.
    pub indentation: f64,
    /// True if the contact is separated there.
    pub is_separated: bool,
    /// Distance of the points of a pull, m.
    pub step: f64,
    /// Stages of the loading so far.
    pub loading: Vec<Move>,
    /// Direction of the last of these stages.
    pub direction: Option<Direction>,
}

pub struct ManualBody {
    body: Body,
    travel: ManualPath,
    /// Distance of the points of a pull, m: a small part of the range of indentations.
    step: f64,
    reach: Reach,
    /// Direction of the last stage of the path.
    direction: Option<Direction>,
}

impl ManualBody {
    /// Begins manual loading of a body that moves along a leg. `None` without enough memory.
    pub fn take(leg: &Leg, begin: ManualBegin) -> Option<Self> {
        let mut body = Body::at(leg, begin.indentation).ok()?;
        if begin.is_separated {
            body.move_to(Move::ToSeparation).ok()?;
        }
        Some(ManualBody {
            body,
            travel: ManualPath {
                loading: begin.loading,
                ..ManualPath::default()
            },
            step: begin.step,
            reach: Reach::of(leg.contact()),
            direction: begin.direction,
        })
    }

    pub fn point(&self) -> CurvePoint {
        self.body.point()
    }

    pub fn leg(&self) -> Leg {
        self.body.leg()
    }

    /// Takes what the body has travelled since the last call.
    pub fn travel(&mut self) -> ManualPath {
        let further = ManualPath {
            released_energy: self.travel.released_energy,
            loading: self.travel.loading.clone(),
            ..ManualPath::default()
        };
        std::mem::replace(&mut self.travel, further)
    }

    /// Moves the body; a refused move leaves it where it is.
    pub fn follow(&mut self, order: ManualMove) {
        let from = self.body.point();
        let target = match order {
            ManualMove::Take { .. } => return,
            // Few digits, since the path may become the loading of the scene.
            ManualMove::To(indentation) => Move::ToIndentation(round_to(indentation, 10)),
            ManualMove::By(distance) => {
                Move::ToIndentation(round_to(from.indentation + distance, 10))
            }
            ManualMove::ToForce(force) => Move::ToForce(force),
            ManualMove::Separate => Move::ToSeparation,
        };
        self.travel.refused = self.go(from, target).err();
    }

    /// Moves the body to a target, or returns the reason why not.
    fn go(&mut self, from: CurvePoint, target: Move) -> Result<(), String> {
        if let Some(why) = self.reach.refusal(target) {
            return Err(why);
        }
        let moved = self.body.move_to(target);
        let moved = moved.map_err(|error| error.in_words(target))?;
        let Some(Motion { leg, low, high, .. }) = moved else {
            return Ok(());
        };
        let to = self.body.point();
        let distance = to.indentation - from.indentation;
        let mut path = self.points_between(&leg, from, distance, target)?;
        path.push(to);
        // Motions in one direction are one stage, to the last target.
        let direction = Some(leg.direction());
        if self.direction == direction {
            self.travel.loading.pop();
        }
        self.direction = direction;
        let stage = self.travel.loading.len();
        self.travel.loading.push(target);
        for point in path {
            self.travel.path.push((stage, point));
        }
        self.travel.changed += to.springs.abs_diff(from.springs);
        // All springs attach or detach between contact and separation.
        let passes_separation = from.springs == 0 || to.springs == 0;
        let below = if passes_separation {
            f64::NEG_INFINITY
        } else {
            low
        };
        self.travel.released_energy += leg.released_energy(below, high);
        Ok(())
    }

    /// Points of the curve of a motion over a distance, m, without its ends. The points of a
    /// motion to separation have a fixed distance.
    fn points_between(
        &self,
        leg: &Leg,
        from: CurvePoint,
        distance: f64,
        target: Move,
    ) -> Result<Vec<CurvePoint>, String> {
        let (count, step) = if target == Move::ToSeparation {
            let count = ((-distance / self.step) as u32).min(MOST_POINTS);
            (count, -self.step)
        } else {
            (POINTS - 1, distance / f64::from(POINTS))
        };
        let mut indentations = Vec::new();
        for number in 1..=count {
            indentations.push(from.indentation + step * f64::from(number));
        }
        indentations.sort_by(f64::total_cmp);
        let mut points = leg
            .curve(&indentations)
            .map_err(|error| error.to_string())?;
        if distance < 0.0 {
            points.reverse();
        }
        Ok(points)
    }
}
