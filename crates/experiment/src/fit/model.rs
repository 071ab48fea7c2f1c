//! Computation of the force at the measured displacements. The force is that of a scene in which
//! the parameters of a fit have given values.

use crate::curve::MeasuredCurve;
use crate::curve::motion::Piece;
use crate::curve::numerics::Extent;
use crate::error::ExperimentError;
use crate::fit::lengths::Lengths;
use crate::fit::parameter::{Parameter, Values};
use crate::fit::scene::pause_of;
use asperity_contact::motion::{MovingBody, RelaxingBody, Stage};
use asperity_contact::{
    Contact, ContactError, CurvePoint, Direction, ForcePoint, Modulus, Move, Relaxation,
    StageRecord,
};
use asperity_data::between;
use asperity_scene::instrument::{DisplacementCurve, DisplacementPoint};
use asperity_scene::{CheckedScene, RunError, Simulation};
use std::ops::Range;

/// Number of points of the computed force curve of each segment, without the points at jumps.
const SAMPLES: usize = 128;
/// Number of points of a force curve that is computed with low accuracy.
const FEW: usize = 64;
/// Largest number of times that a loading is extended if it does not reach its last displacement.
const EXTENSIONS: usize = 8;
/// Number of bisections within the last extension.
const HALVINGS: usize = 5;
/// Smallest jump of the force, in units of the noise, that gets points at both of its ends.
const NOTABLE: f64 = 2.0;
/// Largest error of the forces of a body that relaxes, as a share of the largest force. It
/// determines the steps of the computation. `COARSE_ERROR_OF_STEPS` is the error of forces with low
/// accuracy.
const ERROR_OF_STEPS: f64 = 1e-3;
const COARSE_ERROR_OF_STEPS: f64 = 5e-3;
/// Error of the forces of a body that relaxes, as a share of the noise. It has to be much smaller
/// than the noise, because the errors of neighbouring points are alike and do not average out as
/// noise does.
const OF_NOISE: f64 = 0.1;
/// Smallest error of the forces of a body that relaxes, as a share of the largest force. A smaller
/// error would take more computing time without improving a fit.
const LEAST_ERROR_OF_STEPS: f64 = 1e-5;
/// Number of further points on each side of a fold, a place at which the displacement of the
/// instrument turns back over the indentation. Each point is half as far from the fold as the
/// previous one. A jump of the contact needs no further points, because both of its ends are points
/// already.
const FAN: i32 = 8;

/// Computation of the forces of a scene at the displacements of a measured curve.
pub(crate) struct Model<'a> {
    curve: &'a MeasuredCurve,
    scene: CheckedScene,
    simulation: &'a mut Simulation,
    contact: Option<ContactOfForm>,
    /// Error of the computed forces, in units of the noise of the curve; at least 1.
    pub noise: f64,
    pub evaluations: usize,
}

/// Contact of a scene whose form has these lengths. Springs and tree are reused for all other
/// parameters.
struct ContactOfForm {
    contact: Contact,
    lengths: Lengths,
}

/// Choice of the points at which a force curve is computed, and stiffness of the instrument in N/m.
#[derive(Clone, Copy)]
pub(crate) struct Sampling {
    pub stiffness: f64,
    pub points: usize,
    /// Size in N above which a jump of the force gets a point at each of its ends.
    pub least_jump: f64,
}

/// Motion (stage) of a body in contact, and its indentation in m.
struct BodyOnStage {
    stage: Stage,
    indentation: f64,
}

/// Computed forces of a part of the measured curve.
enum ComputedPart {
    /// Forces of a segment over the displacement, and the measured displacement in m at first
    /// touch.
    Motion(DisplacementCurve, f64),
    /// Points of a rest, each with the time in s since its beginning and the force in N.
    Rest(Vec<[f64; 2]>),
}

impl ComputedPart {
    /// Returns the force in N at a point of the measured curve.
    fn force(&self, curve: &MeasuredCurve, index: usize) -> f64 {
        match self {
            ComputedPart::Motion(segment, offset) => {
                force_at(segment, curve.displacement[index] - offset)
            }
            ComputedPart::Rest(points) => {
                let seconds = curve.seconds_at_rest.get(index).copied().flatten();
                force_at_time(points, seconds.unwrap_or(0.0))
            }
        }
    }
}

/// Jump of the force of a model over the displacement.
struct Jump {
    displacement: f64,
    /// Forces in N before and after the jump.
    forces: [f64; 2],
}

impl<'a> Model<'a> {
    pub fn new(
        curve: &'a MeasuredCurve,
        scene: &CheckedScene,
        simulation: &'a mut Simulation,
    ) -> Self {
        Model {
            curve,
            scene: scene.clone(),
            simulation,
            contact: None,
            noise: 1.0,
            evaluations: 0,
        }
    }

    /// Returns the contact for these values of the parameters.
    fn contact(&mut self, values: &Values) -> Result<Contact, ExperimentError> {
        let lengths = Lengths::of(values);
        let bare = match self.contact.take() {
            Some(made) if made.lengths == lengths => made,
            _ => self.contact_of_form(lengths)?,
        };
        let bare = self.contact.insert(bare);
        let works = [
            values[Parameter::ClosingWork as usize],
            values[Parameter::Work as usize],
        ];
        let modulus = Modulus::effective(values[Parameter::Modulus as usize])?;
        let contact = bare.contact.with(modulus).works_of_adhesion(works);
        let share = values[Parameter::RelaxationShare as usize];
        let Some(speed) = self.scene.loading_speed.filter(|_| share > 0.0) else {
            return Ok(contact.build()?);
        };
        let time = values[Parameter::RelaxationTime as usize];
        let contact = contact
            .relaxation(Relaxation::new(share, time)?)
            .loading_speed(speed)
            .loading_stiffness(values[Parameter::Stiffness as usize]);
        Ok(contact.build()?)
    }

    /// Makes the contact of the scene with other lengths of its form.
    fn contact_of_form(&mut self, lengths: Lengths) -> Result<ContactOfForm, ExperimentError> {
        let scene = self.scene.with(|scene| {
            if let Some(form) = &mut scene.form {
                lengths.put_into(form);
            }
        });
        self.scene = scene.map_err(RunError::from)?;
        let (contact, _) = self.simulation.contact(&self.scene)?;
        Ok(ContactOfForm { contact, lengths })
    }

    /// Computes the forces in N at all points of the measured curve, for the given values of the
    /// parameters. When the curve was read, a drag was subtracted as if the contact began where the
    /// points without contact end. The forces include the difference to the drag for the first
    /// touch in `values`.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow the values, or if its force curve cannot be
    /// computed.
    pub fn forces(&mut self, values: &Values) -> Result<Vec<f64>, ExperimentError> {
        self.evaluations += 1;
        let curve = self.curve;
        let zero = values[Parameter::Zero as usize];
        let mut forces = Vec::with_capacity(curve.force.len());
        self.each_part(values, |part, points| {
            for index in points {
                forces.push(zero + part.force(curve, index));
            }
        })?;
        if let Some(drag) = curve.drag_over_distance {
            let touch = values[Parameter::Offset as usize];
            for (index, force) in forces.iter_mut().enumerate() {
                let is_pulled = curve.segment[index] % 2 == 1;
                *force += drag.growth(curve.displacement[index], is_pulled, touch);
            }
        }
        Ok(forces)
    }

    /// Returns for each point of the curve the range of forces over which the model jumps near the
    /// point, or `None` if it does not jump there. A jump counts if it lies between the previous
    /// and the next point and is at least `least` N. The range is given relative to the force of
    /// the model at the point, in N.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow the values, or if its force curve cannot be
    /// computed.
    pub fn jumps(
        &mut self,
        values: &Values,
        least: f64,
    ) -> Result<Vec<Option<Extent>>, ExperimentError> {
        self.evaluations += 1;
        let curve = self.curve;
        let mut all = vec![None; curve.force.len()];
        self.each_part(values, |part, points| {
            let ComputedPart::Motion(segment, offset) = part else {
                return;
            };
            let mut jumps = jumps_of(segment);
            jumps.retain(|jump| (jump.forces[1] - jump.forces[0]).abs() >= least);
            let place = |index: usize| curve.displacement[index] - offset;
            for index in points.clone() {
                let before = place(index.max(points.start + 1) - 1);
                let after = place((index + 2).min(points.end) - 1);
                let near = before.min(after)..=before.max(after);
                let force = force_at(segment, place(index));
                let changes = jumps
                    .iter()
                    .filter(|jump| near.contains(&jump.displacement))
                    .flat_map(|jump| jump.forces)
                    .map(|end| end - force);
                let extent = Extent::of(changes.chain([0.0]));
                if extent.low < extent.high {
                    all[index] = Some(extent);
                }
            }
        })?;
        Ok(all)
    }

    /// Returns for each point of the curve the distance in m from a jump of the model, if the point
    /// lies on the wrong side of this jump; otherwise `None`. `residuals` are the measured forces
    /// minus those of the model, in N.
    ///
    /// A point lies on the wrong side if two conditions are met. First, its residual exceeds
    /// `least` N. Second, its measured force lies inside the jump, or nearer to the force of the
    /// model beyond the jump than to the force of the model at the point. All points between such a
    /// point and the jump have to lie on the wrong side too.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow the values, or if its force curve cannot be
    /// computed.
    pub fn distances_from_jumps(
        &mut self,
        values: &Values,
        residuals: &[f64],
        least: f64,
    ) -> Result<Vec<Option<f64>>, ExperimentError> {
        self.evaluations += 1;
        let curve = self.curve;
        let mut distances = vec![None; curve.force.len()];
        self.each_part(values, |part, points| {
            let ComputedPart::Motion(segment, offset) = part else {
                return;
            };
            let place = |index: usize| curve.displacement[index] - offset;
            let number = curve.segment.get(points.start).copied().unwrap_or(0);
            let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
            for jump in jumps_of(segment) {
                let [before, after] = jump.forces;
                if (after - before).abs() < least {
                    continue;
                }
                let is_wrong = |index: usize, other_side: f64| {
                    let force = force_at(segment, place(index)) + residuals[index];
                    let residual = residuals[index].abs();
                    let is_inside = force > before.min(after) && force < before.max(after);
                    residual > least && (is_inside || (force - other_side).abs() < residual)
                };
                let is_past = |index: &usize| sign * (place(*index) - jump.displacement) >= 0.0;
                let first = points.clone().find(is_past).unwrap_or(points.end);
                let past = (first..points.end).take_while(|index| is_wrong(*index, before));
                let ahead = (points.start..first)
                    .rev()
                    .take_while(|index| is_wrong(*index, after));
                for index in past.chain(ahead) {
                    distances[index] = Some((place(index) - jump.displacement).abs());
                }
            }
        })?;
        Ok(distances)
    }

    /// Computes the forces of each part of the curve. Calls `take` with them and with the index
    /// range of the measured points in the part.
    fn each_part(
        &mut self,
        values: &Values,
        mut take: impl FnMut(&ComputedPart, Range<usize>),
    ) -> Result<(), ExperimentError> {
        let contact = self.contact(values)?;
        if contact.relaxation().is_some() {
            return self.each_relaxing_part(&contact, values, take);
        }
        let offset = values[Parameter::Offset as usize];
        let stiffness = values[Parameter::Stiffness as usize];
        let sampling = Sampling {
            stiffness,
            points: if self.noise > 1.0 { FEW } else { SAMPLES },
            least_jump: NOTABLE * self.noise * self.curve.noise,
        };
        let segments = &self.curve.segment;
        let mut begin = 0;
        let mut body: Option<BodyOnStage> = None;
        for (number, turn) in self.curve.turns.iter().enumerate() {
            let presses = number % 2 == 0;
            let to = turn - offset;
            let from = body.as_ref().map(|body| body.indentation);
            let stage = match &body {
                Some(body) => Some(body.stage.turn(body.indentation)?),
                None if presses && *turn > offset => Some(Stage::approach(&contact)?),
                None => None,
            };
            let curve = match &stage {
                Some(stage) if presses => sampling.press(stage, from, to)?,
                Some(stage) => sampling.pull(stage, from.unwrap_or_default())?,
                None => {
                    DisplacementCurve::new(Direction::Loading, &[ForcePoint::default()], stiffness)
                }
            };
            let end = segments.partition_point(|segment| *segment <= number);
            let indentation = nearest(&curve, to).map_or(0.0, |point| point.indentation);
            take(&ComputedPart::Motion(curve, offset), begin..end);
            begin = end;
            body = stage.and_then(|stage| BodyOnStage::new(stage, indentation));
        }
        Ok(())
    }
}

impl Model<'_> {
    /// Computes the forces of the approach, of the rest and of the retraction if the half-space
    /// relaxes. The instrument moves as the times of the curve state, or else at the speed of the
    /// scene, and rests for as long as the loading of the scene rests.
    fn each_relaxing_part(
        &self,
        contact: &Contact,
        values: &Values,
        mut take: impl FnMut(&ComputedPart, Range<usize>),
    ) -> Result<(), ExperimentError> {
        let offset = values[Parameter::Offset as usize];
        let stiffness = values[Parameter::Stiffness as usize];
        let [approach, rest, retraction] = self.parts_around_rest();
        let motion = |direction, points: &[CurvePoint]| {
            let curve = DisplacementCurve::new(direction, points, stiffness);
            ComputedPart::Motion(curve, offset)
        };
        let deepest = self.curve.turns[0] - offset;
        if deepest <= 0.0 {
            let apart = motion(Direction::Loading, &[CurvePoint::default()]);
            for part in [approach, rest, retraction] {
                take(&apart, part);
            }
            return Ok(());
        }
        let mut body = RelaxingBody::new(contact)?.with_tolerance(self.error_of_steps());
        let [pressed, pulled] = &self.curve.timing.motions;
        let to = |end: f64| {
            if stiffness.is_finite() {
                Move::ToDisplacement(end - offset)
            } else {
                Move::ToIndentation(end - offset)
            }
        };
        let mut points = Points::default();
        for piece in before_last(pressed) {
            if piece.end > offset && piece.end < self.curve.turns[0] {
                body.set_speed(piece.speed)?;
                points.add(&body.advance(to(piece.end))?.curve);
            }
        }
        set_speed_of(&mut body, pressed.last())?;
        points.add(&body.advance(to(self.curve.turns[0]))?.curve);
        take(&motion(Direction::Loading, &points.of_motion), approach);
        let pause = pause_of(&self.scene);
        if pause > 0.0 {
            let record = body.advance(Move::Hold(pause))?;
            take(&ComputedPart::Rest(points_of_rest(&record)), rest);
        }
        let mut points = Points::default();
        for piece in before_last(pulled) {
            if piece.end < self.curve.turns[0] && !points.is_separated() {
                body.set_speed(piece.speed)?;
                points.add(&body.advance(to(piece.end))?.curve);
            }
        }
        if !points.is_separated() {
            set_speed_of(&mut body, pulled.last())?;
            points.add(&body.advance(Move::ToSeparation)?.curve);
        }
        take(&motion(Direction::Unloading, &points.of_motion), retraction);
        Ok(())
    }

    /// Returns the index ranges of the points of the approach, of the rest after it, and of the
    /// retraction.
    fn parts_around_rest(&self) -> [Range<usize>; 3] {
        let segments = &self.curve.segment;
        let end = segments.partition_point(|segment| *segment == 0);
        let rests = |index: &usize| {
            let seconds = self.curve.seconds_at_rest.get(*index);
            seconds.is_some_and(Option::is_some)
        };
        let resting = (0..end).rev().take_while(rests).count();
        [0..end - resting, end - resting..end, end..segments.len()]
    }

    /// Returns the error that the forces of a body that relaxes may have because of the steps, as a
    /// share of the largest force.
    fn error_of_steps(&self) -> f64 {
        if self.noise > 1.0 {
            return COARSE_ERROR_OF_STEPS;
        }
        let force = Extent::of(self.curve.force.iter().copied());
        let largest = force.high.max(-force.low);
        (OF_NOISE * self.curve.noise / largest).clamp(LEAST_ERROR_OF_STEPS, ERROR_OF_STEPS)
    }
}

/// Points of a motion that is computed in pieces.
#[derive(Default)]
struct Points {
    of_motion: Vec<CurvePoint>,
}

impl Points {
    /// Adds the points of a piece, whose first point is the last point of the piece before.
    fn add(&mut self, piece: &[CurvePoint]) {
        let repeated = usize::from(!self.of_motion.is_empty()).min(piece.len());
        self.of_motion.extend_from_slice(&piece[repeated..]);
    }

    /// Returns true if the body has separated.
    fn is_separated(&self) -> bool {
        self.of_motion
            .last()
            .is_some_and(|point| point.patches == 0)
    }
}

/// Returns the pieces of a motion before the last one.
fn before_last(pieces: &[Piece]) -> &[Piece] {
    pieces.split_last().map_or(&[], |(_, before)| before)
}

/// Sets the speed of the last piece of a motion. Without times the speed is that of the scene.
fn set_speed_of(body: &mut RelaxingBody<'_>, piece: Option<&Piece>) -> Result<(), ContactError> {
    match piece {
        Some(piece) => body.set_speed(piece.speed),
        None => Ok(()),
    }
}

/// Returns the time in s since the beginning of a rest and the force in N at each point of the
/// record of the rest. The record of a body without contact has no times.
fn points_of_rest(record: &StageRecord) -> Vec<[f64; 2]> {
    let begin = record.seconds.first().copied().unwrap_or(0.0);
    let mut points = Vec::with_capacity(record.curve.len());
    for (index, point) in record.curve.iter().enumerate() {
        let seconds = record.seconds.get(index).copied().unwrap_or(begin);
        points.push([seconds - begin, point.force]);
    }
    points
}

/// Returns the force in N at a time in s, by interpolation between points of a rest.
fn force_at_time(points: &[[f64; 2]], seconds: f64) -> f64 {
    let next = points.partition_point(|point| point[0] < seconds);
    let (Some(before), Some(after)) = (points.get(next.max(1) - 1), points.get(next)) else {
        return points.last().map_or(0.0, |point| point[1]);
    };
    let step = after[0] - before[0];
    if step <= 0.0 {
        return after[1];
    }
    let share = ((seconds - before[0]) / step).clamp(0.0, 1.0);
    between(before[1], after[1], share)
}

impl BodyOnStage {
    /// Creates a body in contact. Returns `None` if the body is separated at this indentation in m.
    fn new(stage: Stage, indentation: f64) -> Option<Self> {
        let is_apart = stage.direction() == Direction::Unloading && indentation < stage.end();
        (!is_apart).then_some(BodyOnStage { stage, indentation })
    }
}

/// Returns the jumps of a segment. An end of the segment beyond which the body is separated is a
/// jump too.
fn jumps_of(segment: &DisplacementCurve) -> Vec<Jump> {
    let mut jumps = Vec::new();
    for ends in segment.jumps() {
        jumps.push(Jump {
            displacement: ends[0].displacement,
            forces: [ends[0].force, ends[1].force],
        });
    }
    let ends = [segment.points().first(), segment.points().last()];
    for end in ends.into_iter().flatten() {
        let above = segment.at(end.displacement.next_up());
        let below = segment.at(end.displacement.next_down());
        let is_separated = [above, below]
            .into_iter()
            .flatten()
            .any(|point| point.force == 0.0);
        jumps.push(Jump {
            displacement: end.displacement,
            forces: [end.force, if is_separated { 0.0 } else { end.force }],
        });
    }
    jumps
}

/// Returns the point of a segment at a displacement in m. If the displacement lies beyond the
/// segment, because of noise, returns the nearer end of the segment.
fn nearest(segment: &DisplacementCurve, displacement: f64) -> Option<DisplacementPoint> {
    if let Some(point) = segment.at(displacement) {
        return Some(point);
    }
    let first = segment.points().first()?;
    let last = segment.points().last()?;
    let distance = |point: &DisplacementPoint| (point.displacement - displacement).abs();
    if distance(last).total_cmp(&distance(first)).is_lt() {
        Some(*last)
    } else {
        Some(*first)
    }
}

fn force_at(segment: &DisplacementCurve, displacement: f64) -> f64 {
    nearest(segment, displacement).map_or(0.0, |point| point.force)
}

impl Sampling {
    /// Returns the curve of a loading up to the displacement `to` in m. The loading begins at the
    /// indentation `from` in m, or at first touch for `None`.
    fn press(
        self,
        stage: &Stage,
        from: Option<f64>,
        to: f64,
    ) -> Result<DisplacementCurve, ContactError> {
        let free = from.is_none().then(ForcePoint::default);
        let from = from.unwrap_or_default();
        let displacement = |indentation: f64| -> Result<f64, ContactError> {
            Ok(stage.force(indentation)?.displacement(self.stiffness))
        };
        // The indentation at which the displacement reaches `to` is sought between `low` and
        // `high`. It differs from the displacement by the deflection of the instrument, which
        // adhesion may pull further.
        let mut low = from;
        let mut high = to.max(from);
        for _ in 0..EXTENSIONS {
            let reached = displacement(high)?;
            if reached >= to {
                break;
            }
            low = high;
            high += 2.0 * (to - reached);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if displacement(middle)? < to {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.over(stage, [from, high], 1, free)
    }

    /// Returns the force curve of an unloading from the indentation `from` in m to separation.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn pull(self, stage: &Stage, from: f64) -> Result<DisplacementCurve, ContactError> {
        let end = stage.end().min(from);
        let separated = ForcePoint {
            indentation: end,
            ..ForcePoint::default()
        };
        // The points are dense near separation, where the force may change like the square root of
        // the distance from it.
        self.over(stage, [end, from], 2, Some(separated))
    }

    /// Returns the force of a stage as a function of the displacement, between the two indentations
    /// `range` in m. A stage is one motion of the body. A larger `power` makes the points denser
    /// near the lower indentation. The points include both ends of each jump of at least
    /// [`Self::least_jump`], and the point `free` without contact.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn over(
        self,
        stage: &Stage,
        range: [f64; 2],
        power: i32,
        free: Option<ForcePoint>,
    ) -> Result<DisplacementCurve, ContactError> {
        let mut points = stage.forces(&self.indentations(stage, range, power))?;
        let folds = self.indentations_at_folds(&points, stage.direction());
        if !folds.is_empty() {
            points.extend(stage.forces(&folds)?);
            points.sort_by(|point, next| point.indentation.total_cmp(&next.indentation));
        }
        let points: Vec<ForcePoint> = match stage.direction() {
            Direction::Loading => free.into_iter().chain(points).collect(),
            Direction::Unloading => points.into_iter().rev().chain(free).collect(),
        };
        Ok(DisplacementCurve::new(
            stage.direction(),
            &points,
            self.stiffness,
        ))
    }

    /// Returns ascending indentations in m between two ends, including both ends of the jumps of
    /// the contact.
    fn indentations(self, stage: &Stage, range: [f64; 2], power: i32) -> Vec<f64> {
        let [low, high] = range;
        let mut indentations = Vec::with_capacity(self.points);
        for index in 0..self.points {
            let share = (index as f64 / (self.points - 1) as f64).powi(power);
            indentations.push((low + (high - low) * share).min(high));
        }
        for jump in stage.force_jumps(low, high, self.least_jump) {
            indentations.push(jump.next_down());
            indentations.push(jump);
        }
        indentations.sort_by(f64::total_cmp);
        indentations
    }

    /// Returns the ascending indentations in m of further points near folds. At a fold the
    /// displacement turns back, so that the body becomes unstable on the instrument. A fold may lie
    /// shortly before a jump of the contact. `points` ascend in indentation.
    fn indentations_at_folds(self, points: &[ForcePoint], direction: Direction) -> Vec<f64> {
        let mut in_time = points.to_vec();
        let sign = match direction {
            Direction::Loading => 1.0,
            Direction::Unloading => {
                in_time.reverse();
                -1.0
            }
        };
        let mut folds = Vec::new();
        // Largest displacement of all points before `fold`, in the direction of the motion.
        let mut reached = f64::NEG_INFINITY;
        for neighbours in in_time.windows(3) {
            let [before, fold, after] = [neighbours[0], neighbours[1], neighbours[2]];
            let displacement = |point: ForcePoint| sign * point.displacement(self.stiffness);
            reached = reached.max(displacement(before));
            let at_fold = displacement(fold);
            if at_fold > reached && displacement(after) < at_fold {
                fan_out(fold.indentation, before.indentation, &mut folds);
                fan_out(fold.indentation, after.indentation, &mut folds);
            }
        }
        folds.sort_by(f64::total_cmp);
        folds
    }
}

/// Adds indentations between a neighbouring point and a fold, each half as far from the fold as the
/// previous one.
fn fan_out(fold: f64, neighbour: f64, indentations: &mut Vec<f64>) {
    for power in 1..=FAN {
        let indentation = fold + (neighbour - fold) * 0.5_f64.powi(power);
        if indentation != fold && indentation != neighbour {
            indentations.push(indentation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Made, force_curve, on_rubber, random, read, rubber, stiffness, truth};
    use crate::fit::scene::radius_of;
    use crate::fit::statistics::scale;
    use crate::read::options::Drift;

    /// Returns the residuals of a curve without noise, in units of 1 % of the pull-off force: first
    /// for forces of full accuracy, then for forces of low accuracy.
    fn rests(made: &Made) -> [Vec<f64>; 2] {
        let mut curve = read(force_curve(&made.scene).into_iter(), Drift::Keep);
        curve.noise = made.noise;
        let [work, modulus] =
            [Parameter::Work, Parameter::Modulus].map(|parameter| truth(made, parameter));
        let radius = radius_of(&made.scene).unwrap();
        let stiffness = stiffness(&made.scene);
        let values = [
            work, work, modulus, 0.0, 0.0, stiffness, radius, 0.0, 0.0, 0.0, 0.0,
        ];
        let mut simulation = Simulation::default();
        let mut model = Model::new(
            &curve,
            &made.scene.clone().checked().unwrap(),
            &mut simulation,
        );
        let rests = [1.0, 10.0].map(|noise| {
            model.noise = noise;
            let forces = model.forces(&values).unwrap();
            curve
                .force
                .iter()
                .zip(&forces)
                .map(|(force, model)| (force - model) / curve.noise)
                .collect()
        });
        assert_eq!(model.evaluations, 2);
        rests
    }

    #[test]
    fn forces_are_those_of_the_radius_that_is_asked_for() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let document = on_rubber(1e-3, 2e6);
        let mut simulations = [(); 2].map(|()| Simulation::default());
        let [mut one, mut fresh] = simulations
            .each_mut()
            .map(|simulation| Model::new(&curve, document.scene(), simulation));
        let mut forces = |radius| {
            one.forces(&[1e-3, 1e-3, 2e6, 2e-6, 0.0, 3.0, radius, 0.0, 0.0, 0.0, 0.0])
                .unwrap()
        };
        let [wide, narrow, again] = [7.5e-6, 3e-6, 7.5e-6].map(&mut forces);
        assert!(wide == again && wide != narrow);
        assert_eq!(
            fresh
                .forces(&[1e-3, 1e-3, 2e6, 2e-6, 0.0, 3.0, 3e-6, 0.0, 0.0, 0.0, 0.0])
                .unwrap(),
            narrow
        );
    }

    #[test]
    fn forces_are_those_of_a_fine_curve_with_all_its_jumps() {
        for (seed, points, most) in [
            (4, 512, [0.1, 0.5]),
            (11, 1024, [0.1, 1.0]),
            (14, 512, [0.1, 0.5]),
        ] {
            let found = rests(&random(seed, points)).map(|rests| {
                let beyond = rests.iter().filter(|rest| rest.abs() > 5.0).count();
                (scale(&rests, 5.0), beyond)
            });
            let [exact, coarse] = found;
            assert!(exact.0 < most[0] && exact.1 <= 2, "{seed}: {exact:?}");
            assert!(
                coarse.0 < most[1] && coarse.0 > exact.0 && coarse.1 <= 20,
                "{seed}: {exact:?} {coarse:?}"
            );
        }
    }
}
