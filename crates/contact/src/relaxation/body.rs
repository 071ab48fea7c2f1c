//! A body that moves at a speed over a relaxing foundation, from target to target.

use super::division::Division;
use super::drive::Drive;
use super::loading::Step;
use super::memory::Moment;
use super::patch::StretchedPatch;
use super::recorder::Recorder;
use super::state::{Phase, State};
use crate::contact::Contact;
use crate::detachment::DetachmentRule;
use crate::error::ContactError;
use crate::history::{CurvePoint, Direction, Goal, Patch, StageRecord, Work, check_hold, plan};
use crate::moving_body::MovingBody;
use crate::stage::{PatchState, Stage};
use crate::target::Move;

/// Number of steps of a stage before they are divided.
const STEPS: usize = 48;
/// Largest number of steps of one stage. The length of steps is doubled again and again, so that
/// no target within reach needs as many.
const MOST_STEPS: usize = 1 << 12;
/// Share of the largest force by which forces may deviate because of the steps.
const TOLERANCE: f64 = 1e-3;

/// A body that moves at a constant speed over a foundation with [`Relaxation`].
pub struct RelaxingBody {
    drive: Drive,
    /// Division of a coarse profile, over which the drive moves.
    division: Option<Division>,
    state: State,
    speed: f64,
    tolerance: f64,
    work: Work,
    /// The profile before its division.
    contact: Contact,
    /// The springs in contact on the last stage.
    stage: Stage,
}

/// A motion to a target.
struct Course {
    direction: Direction,
    goal: Goal,
    /// Displacement in m by which the drive moves in a step; negative on unloading.
    step: f64,
}

impl RelaxingBody {
    /// Creates a separated body just before first touch.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] if the contact has no relaxation or no loading speed.
    pub fn new(contact: &Contact) -> Result<Self, ContactError> {
        let Some(relaxing) = contact.relaxing() else {
            return Err(ContactError::Value {
                name: "relaxation share".to_owned(),
                value: 0.0,
                allowed: "above 0 for a relaxing body",
            });
        };
        let (division, drive) = match Division::of(contact)? {
            Some((division, divided)) => {
                let drive = Drive::new(&divided, relaxing.relaxation)?;
                (Some(division), drive)
            }
            None => (None, Drive::new(contact, relaxing.relaxation)?),
        };
        Ok(RelaxingBody {
            drive,
            division,
            state: State::apart(),
            speed: relaxing.speed,
            tolerance: TOLERANCE,
            work: Work {
                springs: contact.gaps().len() as u64,
                ..Work::default()
            },
            contact: contact.clone(),
            stage: Stage::apart(contact, Direction::Unloading),
        })
    }

    /// Sets the error of the force that the steps may have, as a share of the largest force.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        RelaxingBody { tolerance, ..self }
    }

    /// Returns the present point of the force curve.
    pub fn point(&self) -> CurvePoint {
        self.point_of(&self.state)
    }

    /// Returns the time in s since first touch.
    pub fn seconds(&self) -> f64 {
        self.state.seconds
    }

    fn point_of(&self, state: &State) -> CurvePoint {
        let foundation = self.drive.contact.foundation;
        let mut point = state.point(foundation, self.drive.remaining());
        let Some(division) = &self.division else {
            return point;
        };
        // The division has further springs, which do not count.
        point.springs = match &state.phase {
            Phase::Apart => 0,
            Phase::Deepest => division
                .springs_of_approach(state.indentation)
                .unwrap_or(point.springs),
            Phase::Turned(turned) => {
                let patches = turned.patches.iter();
                let springs = patches.map(|patch| division.whole(patch.range()).springs().len());
                springs.sum::<usize>() as u64
            }
        };
        point
    }

    fn advance_or_stay(&mut self, target: Move) -> Result<StageRecord, ContactError> {
        let before = self.state.clone();
        let moments = self.drive.history.len();
        let largest_force = self.drive.largest_force;
        let record = self.try_to(target);
        if record.is_err() {
            self.state = before;
            self.drive.forget(moments);
            self.drive.largest_force = largest_force;
        }
        record
    }

    fn try_to(&mut self, target: Move) -> Result<StageRecord, ContactError> {
        if let Move::Hold(seconds) = target {
            return self.hold(target, seconds);
        }
        let stiffness = self.drive.contact.loading_stiffness;
        let Some((direction, goal)) = plan(target, self.point(), stiffness)? else {
            return Ok(StageRecord::still(target, self.point()));
        };
        if direction == Direction::Loading && self.state.has_detached() {
            return Err(ContactError::NotRecovered);
        }
        if let Goal::Indentation(end) = goal
            && self.state.is_separated()
            && end < 0.0
        {
            return Ok(StageRecord::free(target, self.state.indentation, end));
        }
        let mut recorder = Recorder::new(self.contact.gaps().len());
        let mut states = vec![self.state.clone()];
        if self.state.is_separated() {
            self.touch(&mut states)?;
        }
        let step = self.step_of(direction, goal)?;
        let stage = Course {
            direction,
            goal,
            step,
        };
        self.run(&stage, &mut states, &mut recorder)?;
        self.finish(target, direction, states, recorder)
    }

    /// Lets the body touch, at the displacement zero of the drive.
    fn touch(&mut self, states: &mut Vec<State>) -> Result<(), ContactError> {
        self.drive.approach.prepare(0.0)?;
        let apart = State::apart();
        self.drive.history.push(Moment {
            indentation: 0.0,
            seconds: 0.0,
            memory: 0.0,
        });
        let touched = self.drive.driven(&apart, 0.0, 0.0)?;
        self.drive.remember(&apart, &touched);
        let force = self.drive.force(&touched).abs();
        self.drive.largest_force = self.drive.largest_force.max(force);
        states.clear();
        states.push(apart);
        states.push(touched);
        Ok(())
    }

    /// Returns the way of the drive in one step, and prepares the approach for the way.
    fn step_of(&mut self, direction: Direction, goal: Goal) -> Result<f64, ContactError> {
        let contact = &self.drive.contact;
        let spring = contact.foundation.spring_stiffness();
        if direction == Direction::Unloading {
            let rule = contact.rules().rule(direction);
            let load = &self.state.load;
            let pulled = rule.largest_stretch(load.length);
            let tension = load.length * pulled / self.drive.instrument;
            let bent = self.state.drive - self.state.indentation;
            let lowest = match goal {
                Goal::Indentation(end) => end,
                Goal::Displacement(end) => end - bent.max(0.0),
                Goal::Force(_) | Goal::Separation(_) => -pulled,
            };
            let way = (self.state.indentation - lowest) + bent.max(0.0) + tension;
            return Ok(-way / STEPS as f64);
        }
        let from = self.state.indentation.max(0.0);
        let goal_of_elastic = match goal {
            Goal::Displacement(end) if self.drive.instrument.is_infinite() => {
                Goal::Indentation(end)
            }
            goal => goal,
        };
        let leg = &self.drive.approach.stage;
        let (end, _) = leg.reach(goal_of_elastic, from.min(leg.end()), &mut self.work)?;
        let elastic = leg.state(end)?;
        self.drive.approach.prepare(end)?;
        let force = elastic.compression.abs();
        self.drive.largest_force = self.drive.largest_force.max(match goal {
            Goal::Force(force) => force.abs() / spring,
            _ => self.drive.remaining() * force,
        });
        let drive_end = match goal {
            Goal::Displacement(end) => end,
            _ => end + elastic.compression / self.drive.instrument,
        };
        let way = (drive_end - self.state.drive).max(end - self.state.indentation);
        if way > 0.0 {
            return Ok(way / STEPS as f64);
        }
        // The elastic contact is already at the goal, which the relaxed one has yet to reach.
        let scale = self.state.drive.abs().max(self.state.indentation.abs());
        let small = scale.max(contact.profile.deepest()).max(f64::MIN_POSITIVE);
        Ok(small * 1e-3 / STEPS as f64)
    }

    /// Moves the drive until the goal is reached.
    fn run(
        &mut self,
        stage: &Course,
        states: &mut Vec<State>,
        recorder: &mut Recorder,
    ) -> Result<(), ContactError> {
        let remaining = self.drive.remaining();
        let spring = self.drive.contact.foundation.spring_stiffness();
        let sign = match stage.direction {
            Direction::Loading => 1.0,
            Direction::Unloading => -1.0,
        };
        let separates = matches!(stage.goal, Goal::Separation(_));
        let goal_value = move |state: &State| match stage.goal {
            Goal::Force(force) => sign * (state.load.force(remaining) - force / spring),
            Goal::Indentation(end) => sign * (state.indentation - end),
            Goal::Displacement(end) => sign * (state.drive - end),
            Goal::Separation(_) => {
                if state.is_separated() {
                    0.0
                } else {
                    -1.0
                }
            }
        };
        let end_of_drive = self.end_of_drive(stage);
        let mut step = stage.step;
        let mut steps = 0;
        if states.last().is_some_and(|state| goal_value(state) >= 0.0) {
            return Ok(());
        }
        loop {
            let Some(from) = states.last() else {
                return Ok(());
            };
            let mut drive = from.drive + step;
            if let Some(end) = end_of_drive
                && (end - drive) * sign <= 0.25 * step.abs()
            {
                drive = end;
            }
            let seconds = (drive - from.drive).abs() / self.speed;
            let first_new = states.len();
            let tolerance = self.tolerance * self.drive.largest_force;
            let moments = self.drive.history.len();
            self.drive
                .step(states, Step { drive, seconds }, tolerance)?;
            let reached = (first_new..states.len()).find(|&index| {
                let state = &states[index];
                goal_value(state) >= 0.0 || (state.is_separated() && !separates)
            });
            if let Some(index) = reached {
                return self.stop_at(stage, states, index, moments, &goal_value, recorder);
            }
            self.record_all_but_last(states, recorder);
            steps += 1;
            if steps > MOST_STEPS {
                return Err(ContactError::OutOfReach);
            }
            if steps % (STEPS / 2) == 0 && end_of_drive.is_none() {
                step *= 2.0;
            }
        }
    }

    /// Returns the displacement of the drive in m at which the motion certainly ends.
    fn end_of_drive(&self, stage: &Course) -> Option<f64> {
        match stage.goal {
            Goal::Displacement(end) => Some(end),
            Goal::Indentation(end) if self.drive.instrument.is_infinite() => Some(end),
            _ => None,
        }
    }

    /// Ends a motion at the goal, which the state with the index `index` is the first to pass.
    fn stop_at(
        &mut self,
        stage: &Course,
        states: &mut Vec<State>,
        index: usize,
        moments: usize,
        goal_value: &dyn Fn(&State) -> f64,
        recorder: &Recorder,
    ) -> Result<(), ContactError> {
        let reached = states[index].clone();
        states.truncate(index);
        let from = states[index - 1].clone();
        if reached.is_separated() && goal_value(&reached) < 0.0 || is_lost(stage, &reached) {
            if matches!(stage.goal, Goal::Force(_)) {
                let remaining = self.drive.remaining();
                let forces = states.iter().map(|state| state.load.force(remaining));
                let smallest = forces.fold(f64::INFINITY, f64::min);
                let spring = self.drive.contact.foundation.spring_stiffness();
                return Err(ContactError::DetachesBefore {
                    smallest: recorder.smallest_force().min(spring * smallest),
                });
            }
            states.push(reached);
            return Ok(());
        }
        // The moments after the goal are no part of the motion.
        let seconds = from.seconds;
        let mut kept = self.drive.history.len();
        while kept > moments && self.drive.history.time_of(kept - 1) > seconds {
            kept -= 1;
        }
        self.drive.forget(kept);
        let state = if matches!(stage.goal, Goal::Separation(_)) || goal_value(&reached) == 0.0 {
            reached
        } else {
            self.drive.reach(&from, reached, goal_value)?
        };
        let state = match stage.goal {
            // The search ends at the indentation to rounding.
            Goal::Indentation(indentation) => State {
                indentation,
                ..state
            },
            _ => state,
        };
        self.drive.remember(&from, &state);
        states.push(state);
        Ok(())
    }

    /// Keeps the drive in place for a time in s.
    fn hold(&mut self, target: Move, seconds: f64) -> Result<StageRecord, ContactError> {
        check_hold(seconds)?;
        if self.state.is_separated() || seconds == 0.0 {
            return Ok(StageRecord::still(target, self.point()));
        }
        let mut states = vec![self.state.clone()];
        let step = Step {
            drive: self.state.drive,
            seconds: seconds / STEPS as f64,
        };
        let tolerance = self.tolerance * self.drive.largest_force;
        let mut recorder = Recorder::new(self.contact.gaps().len());
        for _ in 0..STEPS {
            self.drive.step(&mut states, step, tolerance)?;
            self.record_all_but_last(&mut states, &mut recorder);
        }
        let falls = states
            .last()
            .is_some_and(|last| last.indentation < self.state.indentation);
        let direction = if falls {
            Direction::Unloading
        } else {
            Direction::Loading
        };
        self.finish(target, direction, states, recorder)
    }

    /// Records all states but the last one, from which the motion goes on.
    fn record_all_but_last(&self, states: &mut Vec<State>, recorder: &mut Recorder) {
        let kept = states.len() - 1;
        for state in states.drain(..kept) {
            self.record(&state, recorder);
        }
    }

    fn record(&self, state: &State, recorder: &mut Recorder) {
        let patches = match &state.phase {
            Phase::Turned(_) => Some(self.patches_of(state)),
            Phase::Apart | Phase::Deepest => None,
        };
        recorder.add(state, self.point_of(state), patches);
    }

    /// Moves the body to the last one of `states`, and returns the record of the stage.
    fn finish(
        &mut self,
        target: Move,
        direction: Direction,
        states: Vec<State>,
        mut recorder: Recorder,
    ) -> Result<StageRecord, ContactError> {
        for state in &states {
            self.record(state, &mut recorder);
        }
        let Some(last) = states.into_iter().next_back() else {
            return Ok(StageRecord::still(target, self.point()));
        };
        self.stage = self.stage_of(direction, &last, &recorder)?;
        let relaxation = self.drive.relaxation;
        let mut record = recorder.record(&self.drive.contact, relaxation, target, direction);
        record.reaches_ends =
            record.most_springs() > 0 && self.drive.approach.stage.reaches_ends(last.deepest);
        self.work.count(&record);
        self.state = last;
        if self.state.is_separated() {
            self.state.indentation = self.state.drive;
        }
        Ok(record)
    }

    /// Returns the springs in contact at each indentation of a stage that ends in the state `last`.
    fn stage_of(
        &self,
        direction: Direction,
        last: &State,
        recorder: &Recorder,
    ) -> Result<Stage, ContactError> {
        let approach = match &self.division {
            Some(division) => division.approach(),
            None => &self.drive.approach.stage,
        };
        let in_contact_before = |threshold: f64| {
            let has_touched = !matches!(self.state.phase, Phase::Apart);
            has_touched && threshold <= self.state.deepest
        };
        let mut thresholds = approach.thresholds();
        let patches_before = Patch::of_ranges(&self.patches(), thresholds.len());
        for (spring, threshold) in thresholds.iter_mut().enumerate() {
            let detached_at = recorder.detached_at()[spring];
            let attached_at = *threshold;
            *threshold = if detached_at < f64::INFINITY {
                detached_at
            } else if patches_before[spring] {
                f64::NEG_INFINITY
            } else if in_contact_before(attached_at) || attached_at > last.deepest {
                f64::INFINITY
            } else {
                attached_at
            };
        }
        let end = last.indentation;
        Ok(Stage::of_thresholds(
            &self.contact,
            direction,
            end,
            thresholds,
        ))
    }

    /// Returns the patches in contact, from left to right.
    pub fn patches(&self) -> Vec<Patch> {
        self.patches_of(&self.state)
    }

    fn patches_of(&self, state: &State) -> Vec<Patch> {
        let mut patches = match &state.phase {
            Phase::Apart => Vec::new(),
            Phase::Deepest => self.drive.approach.stage.patches(state.deepest),
            Phase::Turned(turned) => {
                let patches = turned.patches.iter();
                patches.map(StretchedPatch::range).collect()
            }
        };
        if let Some(division) = &self.division {
            for patch in &mut patches {
                *patch = division.whole(*patch);
            }
        }
        patches
    }

    /// Returns the states of the patches in contact, from left to right. The force and the stretch
    /// of a patch are those with relaxation.
    pub fn patch_states(&self) -> Result<Vec<PatchState>, ContactError> {
        let mut patches = self.drive.patch_states(&self.state)?;
        if let Some(division) = &self.division {
            for patch in &mut patches {
                patch.springs = division.whole(patch.springs);
            }
        }
        Ok(patches)
    }
}

/// Returns true if a motion to a force ends because the contact is lost.
fn is_lost(stage: &Course, reached: &State) -> bool {
    matches!(stage.goal, Goal::Force(_))
        && stage.direction == Direction::Unloading
        && reached.is_separated()
}

impl MovingBody for RelaxingBody {
    /// Moves the body to a target and returns the record of the stage.
    ///
    /// # Errors
    /// Returns an error for a target that the contact cannot reach, and
    /// [`ContactError::NotRecovered`] for a loading after springs have detached. The body then stays
    /// in place.
    fn advance(&mut self, target: Move) -> Result<StageRecord, ContactError> {
        self.advance_or_stay(target)
    }

    /// Returns the springs in contact at each indentation of the last stage. As with the stepwise
    /// solver they are whole springs, and the forces of this [`Stage`] are without relaxation.
    fn stage(&self) -> Stage {
        self.stage.clone()
    }

    fn work(&self) -> Work {
        Work {
            steps: self.drive.steps,
            ..self.work
        }
    }

    fn curve_seconds(&self) -> f64 {
        0.0
    }
}
