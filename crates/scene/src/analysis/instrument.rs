//! Force as a function of the displacement D = d + F/k of a compliant instrument, computed from the
//! force curve of a loading stage.
//!
//! In one stage the contact depends on the indentation d alone.
//!
//! * While D grows, the body is at the smallest d at which the largest value of d + F(d)/k so far
//!   reaches D.
//! * While D falls, the body is at the largest d at which the smallest value of d + F(d)/k so far
//!   reaches D.
//! * Where dF/dd < −k, d + F(d)/k turns back. There the body jumps at constant D to the next d at
//!   which the instrument can hold it.

use asperity_contact::{Branch, Direction, Figures, ForcePoint, History, StageRecord};

/// Point of the force curve of an instrument with the stiffness k: the displacement D = d + F/k,
/// the indentation d and the force F.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacementPoint {
    /// Displacement D of the instrument in m, with D = 0 at first touch.
    pub displacement: f64,
    /// Indentation d in m.
    pub indentation: f64,
    /// Force F = k (D − d) in N, positive in compression.
    pub force: f64,
}

/// Force of one loading stage as a function of the displacement of the instrument. The function is
/// linear between the computed points. Where the instrument cannot hold the body, the body jumps to
/// another indentation while the displacement remains the same.
///
/// ```
/// use asperity_contact::{Direction, ForcePoint};
/// use asperity_scene::instrument::DisplacementCurve;
///
/// let point = |indentation, force| ForcePoint {
///     indentation,
///     force,
///     springs: 1,
/// };
/// let curve =
///     DisplacementCurve::new(Direction::Loading, &[point(0.0, 0.0), point(1.0, 2.0)], 2.0);
/// // D = d + F/k: half of the way is taken by the instrument.
/// assert_eq!(
///     curve.at(1.0).map(|point| (point.indentation, point.force)),
///     Some((0.5, 1.0))
/// );
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementCurve {
    /// Points in the order of the motion. The displacement D never turns back from point to point.
    /// If two neighbouring points have the same D, the body jumps from one to the other.
    points: Vec<DisplacementPoint>,
    /// Sign of the change of D along the stage: 1 if D grows, −1 if D falls.
    sign: f64,
    /// First value: true if the body is separated before the first point. Second value: true if the
    /// body is separated after the last point.
    free: [bool; 2],
}

impl DisplacementCurve {
    /// Computes the curve of a loading stage for an instrument of the stiffness `stiffness` in N/m.
    /// An infinite stiffness means a rigid instrument. `curve` must have at least one point. Its
    /// indentations must grow on loading and fall on unloading.
    pub fn new<'p, P>(direction: Direction, curve: &'p [P], stiffness: f64) -> Self
    where
        ForcePoint: From<&'p P>,
    {
        let sign = sign_of(direction);
        let mut points: Vec<DisplacementPoint> = Vec::with_capacity(curve.len());
        let mut last: Option<DisplacementPoint> = None;
        for point in curve {
            let point = ForcePoint::from(point);
            let next = DisplacementPoint {
                displacement: point.displacement(stiffness),
                indentation: point.indentation,
                force: point.force,
            };
            let (Some(from), Some(&reached)) = (last.replace(next), points.last()) else {
                points.push(next);
                continue;
            };
            // Each of these two distances states how far a displacement lies behind the reached
            // displacement, in the direction of the stage.
            let from_behind = sign * (reached.displacement - from.displacement);
            let next_behind = sign * (reached.displacement - next.displacement);
            if next_behind > 0.0 {
                continue;
            }
            if from_behind > 0.0 {
                let share = from_behind / (from_behind - next_behind);
                let landing = from.towards(&next, share);
                points.push(DisplacementPoint {
                    displacement: reached.displacement,
                    ..landing
                });
            }
            points.push(next);
        }
        let is_free =
            |end: Option<&'p P>| end.is_some_and(|point| ForcePoint::from(point).springs == 0);
        DisplacementCurve {
            points,
            sign,
            free: [is_free(curve.first()), is_free(curve.last())],
        }
    }

    /// Returns the points of the curve in the order of the motion.
    pub fn points(&self) -> &[DisplacementPoint] {
        &self.points
    }

    /// Returns the parts of the curve between the jumps of the body.
    pub fn steady_parts(&self) -> impl Iterator<Item = &[DisplacementPoint]> {
        self.points
            .chunk_by(|one, next| one.displacement != next.displacement)
    }

    /// Returns the two points of each jump of the body: the point before the jump, and the point
    /// after it at the same displacement.
    pub fn jumps(&self) -> impl Iterator<Item = &[DisplacementPoint]> {
        self.points
            .windows(2)
            .filter(|ends| ends[0].displacement == ends[1].displacement)
    }

    /// Returns the point of the curve at a displacement in m. At a jump this is the point before
    /// the jump.
    ///
    /// A displacement beyond an end of the stage has no computed point. If the bodies are separated
    /// at this end, the returned force is zero. If they are in contact there, returns `None`.
    pub fn at(&self, displacement: f64) -> Option<DisplacementPoint> {
        if !displacement.is_finite() {
            return None;
        }
        let wanted = self.sign * displacement;
        let place = self
            .points
            .partition_point(|point| self.sign * point.displacement < wanted);
        let before = place.checked_sub(1).map(|before| self.points[before]);
        let after = self.points.get(place);
        if let Some(point) = after
            && point.displacement == displacement
        {
            return Some(*point);
        }
        if let Some(from) = before
            && let Some(to) = after
        {
            let share = (displacement - from.displacement) / (to.displacement - from.displacement);
            return Some(DisplacementPoint {
                displacement,
                ..from.towards(to, share)
            });
        }
        let [is_free_before, is_free_after] = self.free;
        let is_free = if before.is_some() {
            is_free_after
        } else {
            is_free_before
        };
        is_free.then_some(DisplacementPoint {
            displacement,
            indentation: displacement,
            force: 0.0,
        })
    }
}

impl DisplacementPoint {
    /// Interpolates linearly: `share` 0 gives this point and `share` 1 gives the point `to`.
    fn towards(&self, to: &DisplacementPoint, share: f64) -> Self {
        let between = |from: f64, to: f64| from + share * (to - from);
        DisplacementPoint {
            displacement: between(self.displacement, to.displacement),
            indentation: between(self.indentation, to.indentation),
            force: between(self.force, to.force),
        }
    }
}

/// Returns the displacement of the instrument in m for each point of a loading stage. On loading it
/// is the largest value of d + F/k up to this point; on unloading it is the smallest value up to
/// this point. Here d is the indentation, F the force and k the `stiffness` in N/m.
pub fn displacements(stage: &StageRecord, stiffness: f64) -> impl Iterator<Item = f64> {
    let sign = sign_of(stage.direction);
    stage
        .curve
        .iter()
        .scan(f64::NEG_INFINITY, move |reached, point| {
            *reached = reached.max(sign * point.displacement(stiffness));
            Some(sign * *reached)
        })
}

fn sign_of(direction: Direction) -> f64 {
    if direction == Direction::Loading {
        1.0
    } else {
        -1.0
    }
}

/// Pull-off displacement and loop area of a loading by an instrument of finite stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct InstrumentFigures {
    /// Stiffness k of the instrument in N/m.
    pub stiffness: f64,
    /// Displacement in m of the instrument at which the body jumps out of contact in the last
    /// unloading. `None` if there is no pull-off.
    pub pull_off_displacement: Option<f64>,
    /// Area in J of the loop of force over displacement. It is the energy dissipated in the contact
    /// plus the energy lost in jumps of the instrument. `None` if the bodies are not separated at
    /// the end.
    pub loop_area: Option<f64>,
}

impl InstrumentFigures {
    /// Computes the pull-off displacement and the loop area of the instrument. `history` is the
    /// history of a loading, `figures` are its forces and energies, and `stiffness` is in N/m.
    pub fn of(history: &History, figures: &Figures, stiffness: f64) -> Self {
        let jump_energy: f64 = history.stages.iter().map(|stage| stage.jump_energy).sum();
        InstrumentFigures {
            stiffness,
            pull_off_displacement: pull_off_displacement(&history.stages, stiffness),
            loop_area: figures.dissipated_energy.map(|energy| energy + jump_energy),
        }
    }
}

/// Returns the smallest displacement in m of the last unloading at which the body is in contact.
/// Returns `None` if there is no pull-off.
fn pull_off_displacement(stages: &[StageRecord], stiffness: f64) -> Option<f64> {
    Branch::pull_off(stages)?;
    let unloading = Branch::last_unloading(stages)?;
    stages[unloading.stages]
        .iter()
        .flat_map(|stage| &stage.curve)
        .filter(|point| point.springs > 0)
        .map(|point| point.displacement(stiffness))
        .min_by(f64::total_cmp)
}
