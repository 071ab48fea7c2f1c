//! The body under manual loading, in which the user moves the body step by step, and the force
//! curve since manual loading began.

use super::request::ManualMove;
use super::snapshot::ManualPath;
use asperity_contact::motion::{Body, Leg, Motion, MovingBody};
use asperity_contact::{CurvePoint, Direction, Move};
use asperity_data::round_to;
use asperity_scene::stages::Reach;

/// Number of points that a move adds to the force curve.
const POINTS: u32 = 16;
/// Largest number of points that a move to separation adds to the force curve.
const MOST_POINTS: u32 = 512;

/// State of the contact at which manual loading begins.
pub struct ManualBegin {
    /// Indentation in m at which manual loading begins.
    pub indentation: f64,
    /// True if the contact is already separated.
    pub is_separated: bool,
    /// Distance in m between neighbouring points of the force curve when the body is pulled off.
    pub step: f64,
    /// Loading stages after which manual loading begins.
    pub loading: Vec<Move>,
    /// Direction of the last stage in [`ManualBegin::loading`]; `None` if there are no stages.
    pub direction: Option<Direction>,
}

pub struct ManualBody {
    body: Body,
    travel: ManualPath,
    /// Distance in m between the points of the curve when the body is pulled off. It is a small
    /// part of the range of indentations.
    step: f64,
    reach: Reach,
    /// Direction of the last stage of the loading so far.
    direction: Option<Direction>,
}

impl ManualBody {
    /// Begins manual loading of a body that has moved along `leg`, a motion in one direction.
    /// Returns `None` if there is not enough memory.
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

    /// Returns the path along which the body has moved since this function was last called.
    pub fn travel(&mut self) -> ManualPath {
        let further = ManualPath {
            released_energy: self.travel.released_energy,
            loading: self.travel.loading.clone(),
            ..ManualPath::default()
        };
        std::mem::replace(&mut self.travel, further)
    }

    /// Moves the body by a manual move. If the move is refused, the body stays where it is.
    pub fn follow(&mut self, order: ManualMove) {
        let from = self.body.point();
        let target = match order {
            ManualMove::Take { .. } => return,
            // The target has few digits, because the path may become the loading of the scene.
            ManualMove::To(indentation) => Move::ToIndentation(round_to(indentation, 10)),
            ManualMove::By(distance) => {
                Move::ToIndentation(round_to(from.indentation + distance, 10))
            }
            ManualMove::ToForce(force) => Move::ToForce(force),
            ManualMove::Separate => Move::ToSeparation,
        };
        self.travel.refused = self.go(from, target).err();
    }

    /// Moves the body to a target, or returns the reason why the move is refused.
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
        // If the direction has not changed, this motion and the last one are one stage, which ends
        // at the new target.
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
        // If the motion begins or ends without contact, all springs attach or detach. The range of
        // indentations then has no lower end, so that no spring is left out of the sum.
        let passes_separation = from.springs == 0 || to.springs == 0;
        let below = if passes_separation {
            f64::NEG_INFINITY
        } else {
            low
        };
        self.travel.released_energy += leg.released_energy(below, high);
        Ok(())
    }

    /// Returns the points of the force curve of a motion, without its two ends. `distance` is the
    /// change of the indentation in m. If the target is separation, the points are `self.step`
    /// apart.
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
