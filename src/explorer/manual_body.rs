//! The body under manual loading, with the path of its force curve.

use super::request::ManualMove;
use super::snapshot::ManualPath;
use asperity_contact::motion::{Body, Leg, Motion, MovingBody};
use asperity_contact::{CurvePoint, Direction, Move};
use asperity_data::round_to;
use asperity_scene::stages::Reach;

/// Number of points of the curve for one move.
const POINTS: u32 = 16;
const MOST_POINTS: u32 = 512;

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
    /// Begins manual loading at an indentation of a leg, m, or in separation if the contact is
    /// separated there. `step` is the distance of the points of a pull, m; `loading` are the stages
    /// so far and `direction` the direction of the last stage. `None` without enough memory.
    pub fn take(
        leg: &Leg,
        (indentation, is_separated): (f64, bool),
        step: f64,
        (loading, direction): (Vec<Move>, Option<Direction>),
    ) -> Option<Self> {
        let mut body = Body::at(leg, indentation).ok()?;
        if is_separated {
            body.move_to(Move::ToSeparation).ok()?;
        }
        let reach = Reach::of(leg.contact());
        let travel = ManualPath {
            loading,
            ..ManualPath::default()
        };
        Some(ManualBody {
            body,
            travel,
            step,
            reach,
            direction,
        })
    }

    pub fn point(&self) -> CurvePoint {
        self.body.point()
    }

    pub fn leg(&self) -> Leg {
        self.body.leg()
    }

    pub fn travel(&mut self) -> ManualPath {
        let (released_energy, loading) = (self.travel.released_energy, self.travel.loading.clone());
        std::mem::replace(
            &mut self.travel,
            ManualPath {
                released_energy,
                loading,
                ..ManualPath::default()
            },
        )
    }

    /// Moves the body; a refused move leaves it where it is.
    pub fn follow(&mut self, order: ManualMove) {
        let from = self.body.point();
        let target = match order {
            ManualMove::Take { .. } => return,
            // Few digits, since the path may become the loading of the scene.
            ManualMove::To(indentation) => Move::ToIndentation(round_to(indentation, 10)),
            ManualMove::By(way) => Move::ToIndentation(round_to(from.indentation + way, 10)),
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
        let moved = self
            .body
            .move_to(target)
            .map_err(|error| error.in_words(target))?;
        let Some(Motion { leg, low, high, .. }) = moved else {
            return Ok(());
        };
        let to = self.body.point();
        let way = to.indentation - from.indentation;
        let points = match target {
            Move::ToSeparation => ((-way / self.step) as u32).min(MOST_POINTS),
            _ => POINTS - 1,
        };
        let step = match target {
            Move::ToSeparation => -self.step,
            _ => way / f64::from(POINTS),
        };
        let mut at: Vec<f64> = (1..=points)
            .map(|k| from.indentation + step * f64::from(k))
            .collect();
        at.sort_by(f64::total_cmp);
        let mut path = leg.curve(&at).map_err(|error| error.to_string())?;
        if way < 0.0 {
            path.reverse();
        }
        // All springs attach or detach between contact and separation.
        let passes_separation = from.springs == 0 || to.springs == 0;
        let below = if passes_separation {
            f64::NEG_INFINITY
        } else {
            low
        };
        // Motions in one direction are one stage, to the last target.
        let direction = Some(leg.direction());
        if std::mem::replace(&mut self.direction, direction) == direction {
            self.travel.loading.pop();
        }
        let stage = self.travel.loading.len();
        self.travel.loading.push(target);
        self.travel
            .path
            .extend(path.into_iter().chain([to]).map(|point| (stage, point)));
        self.travel.changed += to.springs.abs_diff(from.springs);
        self.travel.released_energy += leg.released_energy(below, high);
        Ok(())
    }
}
