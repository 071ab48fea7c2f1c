//! Force over the displacement of a compliant instrument, D = d + F/k, from the curve of a loading stage.
//!
//! On one stage the contact depends on d alone. While D grows, d(D) is the smallest d at which the running maximum of
//! d + F(d)/k reaches D; while D falls, the largest d at which the running minimum reaches D. Where d + F(d)/k turns
//! back, dF/dd < −k, the body jumps at a fixed D to the next d at which the instrument can hold it.

use super::branches::{Branch, pull_off_point};
use super::figures::Figures;
use asperity_contact::{CurvePoint, Direction, History, LegRecord};

/// A point of a force curve over the displacement of the instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacementPoint {
    /// Displacement D of the instrument, m; 0 at first touch.
    pub displacement: f64,
    /// Indentation d, m.
    pub indentation: f64,
    /// Force F = k (D − d), N; compression positive.
    pub force: f64,
}

/// The force curve of one loading stage over the displacement of the instrument, straight between its points. It is
/// exact at the points of the stage and made in a time proportional to their number.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementCurve {
    /// In the order of the stage: D never turns back. Two neighbours at one D are the ends of a jump.
    points: Vec<DisplacementPoint>,
    /// 1 where D grows, −1 where it falls.
    sign: f64,
    /// True for a body that is separated before the first and after the last point.
    free: [bool; 2],
}

impl DisplacementCurve {
    /// The curve of a stage, at least one point in the order of its `direction`, with an instrument of this stiffness k,
    /// N/m; infinite: rigid.
    ///
    /// A stage that ends where the instrument would have jumped on ends at the beginning of that jump.
    pub fn new(direction: Direction, curve: &[CurvePoint], stiffness: f64) -> Self {
        let sign = sign_of(direction);
        let mut points: Vec<DisplacementPoint> = Vec::with_capacity(curve.len());
        let mut last: Option<DisplacementPoint> = None;
        for point in curve {
            let CurvePoint { indentation, force, .. } = *point;
            let next = DisplacementPoint { displacement: point.displacement(stiffness), indentation, force };
            let (Some(from), Some(&reached)) = (last.replace(next), points.last()) else {
                points.push(next);
                continue;
            };
            let behind = [from, next].map(|one| sign * (reached.displacement - one.displacement));
            if behind[1] > 0.0 {
                continue;
            }
            if behind[0] > 0.0 {
                let share = behind[0] / (behind[0] - behind[1]);
                let landing = from.towards(&next, share);
                points.push(DisplacementPoint { displacement: reached.displacement, ..landing });
            }
            points.push(next);
        }
        let free = [curve.first(), curve.last()].map(|end| end.is_some_and(|point| point.springs == 0));
        DisplacementCurve { points, sign, free }
    }

    /// Points in the order of the stage, the displacement of which never turns back.
    pub fn points(&self) -> &[DisplacementPoint] {
        &self.points
    }

    /// Parts of the curve without a jump.
    pub fn steady_parts(&self) -> impl Iterator<Item = &[DisplacementPoint]> {
        self.points.chunk_by(|one, next| one.displacement != next.displacement)
    }

    /// First and last point of each jump.
    pub fn jumps(&self) -> impl Iterator<Item = &[DisplacementPoint]> {
        self.points.windows(2).filter(|ends| ends[0].displacement == ends[1].displacement)
    }

    /// The point at a displacement, m; at a jump, the point before it. `None` beyond the ends of the stage, unless
    /// the body is separated there.
    pub fn at(&self, displacement: f64) -> Option<DisplacementPoint> {
        if !displacement.is_finite() {
            return None;
        }
        let wanted = self.sign * displacement;
        let place = self.points.partition_point(|point| self.sign * point.displacement < wanted);
        let before = place.checked_sub(1).map(|before| self.points[before]);
        let free = DisplacementPoint { displacement, indentation: displacement, force: 0.0 };
        match (before, self.points.get(place)) {
            (_, Some(point)) if point.displacement == displacement => Some(*point),
            (Some(from), Some(to)) => {
                let share = (displacement - from.displacement) / (to.displacement - from.displacement);
                Some(DisplacementPoint { displacement, ..from.towards(to, share) })
            }
            (before, _) => Some(free).filter(|_| self.free[usize::from(before.is_some())]),
        }
    }
}

impl DisplacementPoint {
    /// The point at this share of the way to another one.
    fn towards(&self, to: &DisplacementPoint, share: f64) -> Self {
        let between = |from: f64, to: f64| from + share * (to - from);
        DisplacementPoint {
            displacement: between(self.displacement, to.displacement),
            indentation: between(self.indentation, to.indentation),
            force: between(self.force, to.force),
        }
    }
}

/// Displacement of an instrument of this stiffness, N/m, at which the body is at each point of a stage, or passes the point in
/// a jump, m: the running extremum of d + F/k.
pub fn displacements(leg: &LegRecord, stiffness: f64) -> impl Iterator<Item = f64> {
    let sign = sign_of(leg.direction);
    leg.curve.iter().scan(f64::NEG_INFINITY, move |reached, point| {
        *reached = reached.max(sign * point.displacement(stiffness));
        Some(sign * *reached)
    })
}

fn sign_of(direction: Direction) -> f64 {
    if direction == Direction::Loading { 1.0 } else { -1.0 }
}

/// Figures of a loading history under a compliant instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstrumentFigures {
    /// Loading stiffness k, N/m.
    pub stiffness: f64,
    /// Smallest displacement of the instrument in contact on the unloading of the pull-off, m: where the body jumps off.
    pub pull_off_displacement: Option<f64>,
    /// Area of the loop of force over displacement, J: the energy dissipated in the contact and that lost in jumps of
    /// the instrument, of a history that ends separated.
    pub loop_area: Option<f64>,
}

impl InstrumentFigures {
    /// Figures of a history with its own figures, under an instrument of this stiffness, N/m.
    pub fn of(history: &History, figures: &Figures, stiffness: f64) -> Self {
        let legs = &history.legs;
        let smallest = |unloading: Branch| {
            let points = legs[unloading.stages].iter().flat_map(|leg| &leg.curve);
            let touching = points.filter(|point| point.springs > 0);
            touching.map(|point| point.displacement(stiffness)).min_by(f64::total_cmp)
        };
        InstrumentFigures {
            stiffness,
            pull_off_displacement: pull_off_point(legs).and_then(|_| smallest(Branch::last_unloading(legs)?)),
            loop_area: figures
                .dissipated_energy
                .map(|energy| energy + legs.iter().map(|leg| leg.jump_energy).sum::<f64>()),
        }
    }
}
