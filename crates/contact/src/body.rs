//! The exact solver: a body that moves along any loading history. The computing time is linear in
//! the number of springs, and there is no error from finite steps. A reversal is the unloading from
//! one turning point to separation. The reversals from many turning points need only one loading.

use super::adhesive::tree::TWO_THREADS;
use super::contact::Contact;
use super::contact_state::{ContactState, Extreme, Grid};
use super::error::ContactError;
use super::history::{CurvePoint, Direction, Extremes, Goal, Passage, StageRecord, Work, plan};
use super::moving_body::MovingBody;
use super::stage::Stage;
use super::stage::forces::{SEARCH_INTERVALS, SeparatedEnds};
use super::target::Move;
use asperity_data::in_parallel;
use std::time::{Duration, Instant};

/// Rigid body that the exact solver moves. The body stores its present indentation and a [`Stage`]:
/// the contact at all indentations of the present motion.
///
/// ```
/// use asperity_contact::motion::Body;
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let mut body = Body::new(&contact, 2);
/// body.move_to(Move::ToForce(1.0e-5))?;
/// assert!((body.point().force / 1.0e-5 - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone)]
pub struct Body {
    stage: Stage,
    state: ContactState,
    samples: usize,
    /// Extreme compression in m of contact and instrument together, so far on the present motion;
    /// `None` at the beginning of a motion. See [`Stage::jump_energy`].
    extreme: Option<f64>,
    work: Work,
    curve_time: Duration,
}

/// Result of [`Body::move_to`]: the range of indentations that the body passed, and the [`Stage`]
/// of the motion. The stage gives the contact at each indentation of this range.
///
/// ```
/// use asperity_contact::motion::Body;
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let motion = Body::new(&contact, 2).move_to(Move::ToIndentation(1.0e-7))?.expect("a way to go");
/// assert_eq!((motion.low, motion.high), (0.0, 1.0e-7));
/// // The contact anywhere on the way.
/// assert!(motion.stage.point(0.5e-7)?.force < motion.stage.point(1.0e-7)?.force);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Motion {
    /// Contact at each indentation of the motion.
    pub stage: Stage,
    /// Smallest indentation in m that the body passed on the motion.
    pub low: f64,
    /// Largest indentation in m that the body passed on the motion.
    pub high: f64,
    goal: Goal,
}

impl Motion {
    fn loads(&self) -> bool {
        self.stage.direction() == Direction::Loading
    }

    /// Returns true if the motion ends with the detachment of the last patch.
    fn separates(&self) -> bool {
        !self.loads() && matches!(self.goal, Goal::Separation(_))
    }

    /// Returns true if the force at the end of the motion is certainly the largest one. This holds
    /// for a loading to a target force, because the loading ends as soon as it reaches this force.
    fn ends_at_largest(&self) -> bool {
        self.loads() && matches!(self.goal, Goal::Force(_))
    }
}

/// A motion computed on a grid of indentations.
struct SampledMotion {
    /// Contact at the points of the grid, in ascending order of the indentation.
    states: Vec<ContactState>,
    /// Distance, in points of the grid, between two points of the force curve.
    stride: usize,
    /// ∫ (c − θ)² dx in cells times m² over all attachments and detachments, where c is the gap and
    /// θ the indentation at which a spring attaches or detaches.
    squared_stretch: f64,
}

impl SampledMotion {
    fn lowest(&self) -> ContactState {
        self.states[0]
    }

    fn highest(&self) -> ContactState {
        self.states[self.states.len() - 1]
    }
}

impl Body {
    /// Creates a separated body at the indentation d = 0, just before first touch. `samples` is the
    /// number of points, at least 2, at which the force curve of each motion is computed.
    pub fn new(contact: &Contact, samples: usize) -> Self {
        let stage = Stage::apart(contact, Direction::Unloading);
        Self::on(stage, ContactState::free(0.0), samples)
    }

    /// Creates a body in the state that the motion `stage` has at an indentation in m. The body can
    /// continue this motion or turn back.
    ///
    /// # Errors
    /// Returns [`ContactError::Stepwise`] if the motion was computed by the [stepwise
    /// solver](crate::motion::Stepwise).
    pub fn at(stage: &Stage, indentation: f64) -> Result<Self, ContactError> {
        stage.refuse_stepwise()?;
        Ok(Self::on(stage.clone(), stage.state(indentation)?, 2))
    }

    fn on(stage: Stage, state: ContactState, samples: usize) -> Self {
        let work = Work {
            springs: stage.contact().gaps().len() as u64,
            ..Work::default()
        };
        Body {
            stage,
            state,
            samples: samples.max(2),
            extreme: None,
            work,
            curve_time: Duration::ZERO,
        }
    }

    /// Returns the present point of the force curve: indentation, force, contact and energy of the
    /// body.
    pub fn point(&self) -> CurvePoint {
        self.point_of(self.state)
    }

    /// Moves the body to a target without recording a force curve. Returns the range of
    /// indentations that the body passed and the stage of the motion; `None` if the body is at the
    /// target already.
    ///
    /// # Errors
    /// Returns an error for a target that the contact cannot reach. The body then stays in place.
    pub fn move_to(&mut self, target: Move) -> Result<Option<Motion>, ContactError> {
        let Some(motion) = self.plan(target)? else {
            return Ok(None);
        };
        let state = match (motion.stage.direction(), motion.goal) {
            (Direction::Unloading, Goal::Separation(indentation)) => {
                ContactState::free(indentation.unwrap_or(motion.low))
            }
            (Direction::Unloading, _) => motion.stage.state(motion.low)?,
            (Direction::Loading, _) => motion.stage.state(motion.high)?,
        };
        self.extreme = None;
        self.stage = motion.stage.clone();
        if state.totals.springs == 0 {
            self.stage = Stage::apart(motion.stage.contact(), Direction::Unloading);
        }
        self.state = state;
        Ok(Some(motion))
    }

    fn is_separated(&self) -> bool {
        self.state.totals.springs == 0
    }

    fn point_of(&self, state: ContactState) -> CurvePoint {
        state.point(self.stage.contact())
    }

    /// Returns the stage of a motion in this direction: the present stage if it has this direction,
    /// otherwise a new stage that begins at the present indentation.
    fn stage_in(&mut self, direction: Direction) -> Result<Stage, ContactError> {
        let approaches = self.is_separated() && direction == Direction::Loading;
        if self.stage.direction() == direction && !approaches {
            return Ok(self.stage.clone());
        }
        let stage = if approaches {
            Stage::approach(self.stage.contact())?
        } else {
            self.stage.turn(self.state.indentation)?
        };
        stage.count(&mut self.work);
        Ok(stage)
    }

    /// Finds the stage of the motion to a target and the indentations between which the motion
    /// lies. Returns `None` if the body is already at the target.
    fn plan(&mut self, target: Move) -> Result<Option<Motion>, ContactError> {
        let stiffness = self.stage.contact().loading_stiffness;
        let Some((direction, goal)) = plan(target, self.point(), stiffness)? else {
            return Ok(None);
        };
        let start = self.state.indentation;
        if let Goal::Indentation(end) = goal
            && self.is_separated()
            && end < 0.0
        {
            let direction = if end > start {
                Direction::Loading
            } else {
                Direction::Unloading
            };
            return Ok(Some(Motion {
                stage: Stage::apart(self.stage.contact(), direction),
                low: start.min(end),
                high: start.max(end),
                goal,
            }));
        }
        let stage = self.stage_in(direction)?;
        // A separated body touches nothing below d = 0.
        let from = if self.is_separated() {
            start.max(0.0)
        } else {
            start
        };
        let (end, goal) = stage.reach(goal, from, &mut self.work)?;
        let (low, high) = match direction {
            Direction::Loading => (from, end),
            Direction::Unloading => (end, from),
        };
        Ok(Some(Motion {
            stage,
            low,
            high,
            goal,
        }))
    }

    /// Returns the grid of indentations on which extremes of a motion are searched, and the stride:
    /// every `stride`-th point of the grid is also a point of the force curve.
    fn grid(&self, low: f64, high: f64) -> (Grid, usize) {
        let intervals = self.samples - 1;
        let stride = SEARCH_INTERVALS.div_ceil(intervals);
        (Grid::new(low, high, intervals * stride), stride)
    }

    /// Moves the body along a planned motion, and returns the record of the motion.
    fn record(&mut self, target: Move, motion: Motion) -> Result<StageRecord, ContactError> {
        let clock = Instant::now();
        let before = self.point();
        let touches = self.is_separated();
        let stage = &motion.stage;
        let sampled = self.sample(&motion)?;
        let loosest = self.loosest_point(&motion, &sampled)?;
        if touches || self.stage.direction() != stage.direction() {
            self.extreme = None;
        }
        let separated = SeparatedEnds {
            at_begin: touches,
            at_end: motion.separates() || sampled.lowest().totals.springs == 0,
        };
        let jump_energy = stage.jump_energy(&sampled.states, separated, &mut self.extreme);
        self.state = self.end_state(&motion, &sampled, loosest);
        let curve = self.curve_of(&sampled, loosest);
        let extremes = if motion.loads() {
            self.extremes_of_loading(&motion, &sampled, &curve, touches)
        } else {
            self.extremes_of_unloading(&motion, &sampled)?
        };
        let passage = Passage {
            target,
            direction: stage.direction(),
            before,
            after: self.point(),
        };
        let released_energy = stage.energy(sampled.squared_stretch);
        let mut record = StageRecord::moved(passage, curve, extremes, released_energy);
        record.jump_energy = jump_energy;
        record.reaches_ends = stage.reaches_ends(motion.high);
        if !motion.loads() && !self.is_separated() {
            record.smallest_of_rest = Some(self.rest_of(stage, motion.low)?);
        }
        self.work.count(&record);
        self.stage = motion.stage;
        self.curve_time += clock.elapsed();
        Ok(record)
    }

    /// Computes the contact and the released energy along a motion that the body is about to make.
    fn sample(&self, motion: &Motion) -> Result<SampledMotion, ContactError> {
        let Motion {
            stage, low, high, ..
        } = motion;
        let (grid, stride) = if motion.ends_at_largest() {
            (Grid::new(*low, *high, self.samples - 1), 1)
        } else {
            self.grid(*low, *high)
        };
        // If the body is separated at the beginning, the springs of first touch attach exactly at
        // the first point of the motion. If the body separates, the last springs detach just below
        // the last point. The sum of squared stretches must include these events.
        let from = if self.is_separated() || motion.separates() {
            f64::NEG_INFINITY
        } else {
            *low
        };
        let is_long = stage.contact().gaps().len() >= TWO_THREADS;
        let (states, squared_stretch) = in_parallel(
            is_long,
            || stage.sample(grid),
            || stage.squared_stretch(from, *high),
        );
        Ok(SampledMotion {
            states: states?,
            stride,
            squared_stretch,
        })
    }

    /// Returns the point of an unloading at which a compliant instrument loses the contact. Returns
    /// `None` for a loading and for a rigid instrument.
    fn loosest_point(
        &mut self,
        motion: &Motion,
        sampled: &SampledMotion,
    ) -> Result<Option<CurvePoint>, ContactError> {
        let contact = motion.stage.contact();
        if motion.loads() || contact.loading_stiffness.is_infinite() {
            return Ok(None);
        }
        let loosest = motion
            .stage
            .least_displaced(&sampled.states, &mut self.work)?;
        Ok(Some(loosest.point(contact)))
    }

    /// Returns the contact at the end of a motion. If the body separates, the motion ends at the
    /// indentation that the target states, or else where the instrument lost the contact.
    fn end_state(
        &self,
        motion: &Motion,
        sampled: &SampledMotion,
        loosest: Option<CurvePoint>,
    ) -> ContactState {
        if motion.loads() {
            return sampled.highest();
        }
        let Goal::Separation(target) = motion.goal else {
            return sampled.lowest();
        };
        let stiffness = motion.stage.contact().loading_stiffness;
        let indentation = match (target, loosest) {
            (Some(indentation), _) => indentation,
            (None, Some(loosest)) => loosest.displacement(stiffness),
            (None, None) => motion.low,
        };
        ContactState::free(indentation)
    }

    /// Returns the points of the force curve of a sampled motion, in ascending order of the
    /// indentation.
    fn curve_of(&self, sampled: &SampledMotion, loosest: Option<CurvePoint>) -> Vec<CurvePoint> {
        let last = sampled.states.len() - 1;
        let mut curve = Vec::with_capacity(self.samples + StageRecord::FURTHER_POINTS);
        for (index, &state) in sampled.states.iter().enumerate() {
            if index % sampled.stride == 0 || index == last {
                curve.push(self.point_of(state));
            }
        }
        if let Some(point) = loosest {
            StageRecord::insert(&mut curve, point);
        }
        curve
    }

    fn extremes_of_loading(
        &mut self,
        motion: &Motion,
        sampled: &SampledMotion,
        curve: &[CurvePoint],
        touches: bool,
    ) -> Extremes {
        let largest = if motion.ends_at_largest() {
            sampled.highest()
        } else {
            motion
                .stage
                .extreme(Extreme::Largest, &sampled.states, &mut self.work)
        };
        let largest = self.point_of(largest);
        let points = curve.iter().copied();
        let before_touch = touches.then(|| CurvePoint::free(motion.low));
        let smallest = points
            .chain(before_touch)
            .min_by(|point, other| point.force.total_cmp(&other.force));
        Extremes {
            smallest: smallest.unwrap_or(largest),
            largest,
        }
    }

    fn extremes_of_unloading(
        &mut self,
        motion: &Motion,
        sampled: &SampledMotion,
    ) -> Result<Extremes, ContactError> {
        let stage = &motion.stage;
        let mut smallest = stage.extreme(Extreme::Smallest, &sampled.states, &mut self.work);
        if smallest.totals.springs == 0 {
            // If the unloading has no tensile force, its smallest force is the force of the last
            // contact, and not the zero force of the separated body.
            smallest = stage.state(stage.end().min(motion.high))?;
        }
        Ok(Extremes {
            smallest: self.point_of(smallest),
            largest: self.point_of(sampled.highest()),
        })
    }

    /// Finds the point of the smallest force on the rest of an unloading, from the indentation
    /// `from` in m to separation. The work counts leave this search out because the body does not
    /// make this motion.
    fn rest_of(&self, unloading: &Stage, from: f64) -> Result<CurvePoint, ContactError> {
        let (separation, _) =
            unloading.reach(Goal::Separation(None), from, &mut Work::default())?;
        let (grid, _) = self.grid(separation, from);
        let smallest = unloading.smallest(&grid, &mut Work::default())?;
        Ok(self.point_of(smallest))
    }

    /// Computes the unloading to separation from several turning points. At a turning point, a
    /// loading from separation reaches one of the targets. This body must be separated, and is not
    /// moved.
    ///
    /// `see` is called once for each target, in ascending order of the indentation at the turning
    /// point. The arguments of `see` are the index of the target and the [`Reversal`].
    /// [`Reversal::forces`] are computed at the indentations `points`, in m and in ascending order.
    ///
    /// # Errors
    /// Returns an error for a target that the contact cannot reach, and for a target at which the
    /// body is not in contact. Also returns the first error of `see`.
    pub fn reversals(
        &mut self,
        targets: &[Move],
        points: &[f64],
        see: &mut dyn FnMut(usize, Reversal) -> Result<(), ContactError>,
    ) -> Result<(), ContactError> {
        let loading = self.stage_in(Direction::Loading)?;
        let mut turns = Vec::with_capacity(targets.len());
        for (index, &target) in targets.iter().enumerate() {
            let indentation = self
                .turning_point(&loading, target)
                .map_err(|reason| reason.in_stage(index, target))?;
            turns.push((index, indentation));
        }
        turns.sort_by(|(_, indentation), (_, other)| indentation.total_cmp(other));
        for (index, indentation) in turns {
            let turn = loading.state(indentation)?;
            see(index, self.reverse(&loading, turn, points)?)?;
        }
        Ok(())
    }

    /// Finds the indentation in m at which a loading from separation reaches a target.
    fn turning_point(&mut self, loading: &Stage, target: Move) -> Result<f64, ContactError> {
        let stiffness = loading.contact().loading_stiffness;
        let goal = match target {
            // A tensile force is also a valid target: on the approach, adhesion pulls before the
            // body is pressed.
            Move::ToForce(force) if force < 0.0 && force.is_finite() => Goal::Force(force),
            _ => match plan(target, CurvePoint::default(), stiffness)? {
                Some((Direction::Loading, goal)) => goal,
                _ => return Err(ContactError::NoContact),
            },
        };
        let (indentation, _) = loading.reach(goal, 0.0, &mut self.work)?;
        Ok(indentation)
    }

    /// Returns two pull-off forces in N of unloadings that no preload precedes:
    ///
    /// * F_a(d=0): the pull-off force of the unloading that begins at first touch.
    /// * F_a(F=0): the pull-off force of the unloading that begins where the force of the loading
    ///   has returned to zero.
    ///
    /// A pull-off force is `None` if the force stays above zero on the unloading. F_a(F=0) is also
    /// `None` if the force of the loading never returns to zero.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn adhesion_without_preload(&mut self) -> Result<[Option<f64>; 2], ContactError> {
        let before = self.work;
        let loading = Stage::approach(self.stage.contact())?;
        loading.count(&mut self.work);
        let balanced = loading.reach(Goal::Force(0.0), 0.0, &mut self.work);
        let at_touch = self.reverse(&loading, loading.state(0.0)?, &[])?;
        let at_zero_force = match balanced {
            Err(ContactError::OutOfReach) => None,
            Err(error) => return Err(error),
            Ok((indentation, _)) => {
                let turn = loading.state(indentation)?;
                self.reverse(&loading, turn, &[])?.pull_off_force()
            }
        };
        // The two motions for F_a(d=0) and F_a(F=0) are counted in their own field of the work
        // counts, and not as passes of the loading history.
        self.work.loading_passes = before.loading_passes;
        self.work.unloading_passes = before.unloading_passes;
        self.work.passes_without_preload += 2;
        Ok([at_touch.pull_off_force(), at_zero_force])
    }

    /// Unloads from a turning point of a loading to separation.
    fn reverse(
        &mut self,
        loading: &Stage,
        turn: ContactState,
        points: &[f64],
    ) -> Result<Reversal, ContactError> {
        let high = turn.indentation;
        let unloading = loading.turn(high)?;
        unloading.count(&mut self.work);
        let separation = unloading.end().min(high);
        let (grid, _) = self.grid(separation, high);
        let smallest = unloading.smallest(&grid, &mut self.work)?;
        let below = &points[..points.partition_point(|&point| point <= high)];
        let count_apart = below.partition_point(|&point| point < separation);
        let mut forces = vec![0.0; count_apart];
        for point in unloading.curve(&below[count_apart..])? {
            forces.push(point.force);
        }
        let released_on_loading = loading.released_energy(f64::NEG_INFINITY, high);
        let released_on_unloading = unloading.released_energy(f64::NEG_INFINITY, high);
        Ok(Reversal {
            turn: self.point_of(turn),
            smallest: self.point_of(smallest),
            separation,
            // Adding 0.0 changes −0 to 0.
            dissipated_energy: released_on_loading + released_on_unloading + 0.0,
            reaches_ends: loading.reaches_ends(high),
            forces,
        })
    }
}

impl MovingBody for Body {
    fn advance(&mut self, target: Move) -> Result<StageRecord, ContactError> {
        let here = self.point();
        match self.plan(target)? {
            None => {
                if here.springs == 0 {
                    self.stage = Stage::apart(self.stage.contact(), self.stage.direction());
                }
                Ok(StageRecord::still(target, here))
            }
            Some(Motion {
                stage,
                goal: Goal::Indentation(end),
                ..
            }) if here.springs == 0 && end < 0.0 => {
                self.stage = stage;
                self.state = ContactState::free(end);
                Ok(StageRecord::free(target, here.indentation, end))
            }
            Some(motion) => self.record(target, motion),
        }
    }

    fn stage(&self) -> Stage {
        self.stage.clone()
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        self.curve_time.as_secs_f64()
    }
}

/// The unloading from one turning point, the end of a loading, to separation.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let found = contact.reversals(&[Move::ToForce(1.0e-5), Move::ToForce(1.0e-4)], &[])?;
/// // A sphere adheres with the same force after any preload.
/// let [one, other] = [0, 1].map(|index| found[index].pull_off_force().unwrap());
/// assert!((one / other - 1.0).abs() < 1e-9 && found[0].turn.force < found[1].turn.force);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Reversal {
    /// Turning point: the point of the force curve at which the unloading begins.
    pub turn: CurvePoint,
    /// Point of the force curve at which the force of the unloading is smallest.
    pub smallest: CurvePoint,
    /// Indentation in m at which the last contact patch detaches on the unloading.
    pub separation: f64,
    /// Energy in J dissipated on the way from separation to the turning point and back to
    /// separation.
    pub dissipated_energy: f64,
    /// True if an outermost spring of the profile was in contact at any moment of the loading.
    pub reaches_ends: bool,
    /// Forces in N on unloading, at the indentations that were passed to [`Contact::reversals`].
    /// Indentations above the turning point are left out. At indentations below `separation` the
    /// force is 0.
    pub forces: Vec<f64>,
}

impl Reversal {
    /// Returns the pull-off force F_a in N: the smallest force of the unloading, with the opposite
    /// sign. Returns `None` if the smallest force is above zero.
    pub fn pull_off_force(&self) -> Option<f64> {
        // 0.0 − F instead of −F, because −F would be −0 for a force of zero.
        let pull_off_force = 0.0 - self.smallest.force;
        (self.smallest.force <= 0.0).then_some(pull_off_force)
    }
}
