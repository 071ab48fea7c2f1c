//! A body that moves at a speed over a relaxing foundation, from target to target.

use super::course::{Course, STEPS};
use super::division::Division;
use super::drive::Drive;
use super::law::Relaxation;
use super::loading::Step;
use super::memory::Moment;
use super::recorder::{Recorded, Recorder};
use super::state::{Phase, State};
use super::view::View;
use crate::contact::{Contact, check_speed};
use crate::error::ContactError;
use crate::history::{CurvePoint, Direction, Goal, Patch, StageRecord, Work, check_hold, plan};
use crate::moving_body::MovingBody;
use crate::stage::{PatchState, Stage};
use crate::target::Move;

/// Never stops a motion.
static NEVER: fn() -> bool = || false;

/// A body that moves at a constant speed over a foundation with [`Relaxation`].
pub struct RelaxingBody<'a> {
    drive: Drive,
    /// Returns true if the motion is to be interrupted.
    stop: &'a dyn Fn() -> bool,
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

impl<'a> RelaxingBody<'a> {
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
            tolerance: Relaxation::STEP_ERROR,
            stop: &NEVER,
            work: Work {
                springs: contact.gaps().len() as u64,
                ..Work::default()
            },
            contact: contact.clone(),
            stage: Stage::apart(contact, Direction::Unloading),
        })
    }

    /// Sets the largest error that the finite steps in time may cause in the force, as a share of
    /// the largest force.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        RelaxingBody { tolerance, ..self }
    }

    /// Sets the speed of the drive in m/s from now on.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a speed that is not from 1e-50 to 1e50 m/s.
    pub fn set_speed(&mut self, speed: f64) -> Result<(), ContactError> {
        check_speed(speed)?;
        self.speed = speed;
        Ok(())
    }

    /// Sets a function that interrupts a stage. `stop` is called before each step of the drive. As
    /// soon as it returns true, the stage ends with [`ContactError::Interrupted`].
    #[must_use]
    pub fn with_stop(self, stop: &'a dyn Fn() -> bool) -> Self {
        RelaxingBody { stop, ..self }
    }

    /// Returns the present point of the force curve.
    pub fn point(&self) -> CurvePoint {
        self.view().point(&self.state)
    }

    /// Returns the time in s since first touch.
    pub fn seconds(&self) -> f64 {
        self.state.seconds
    }

    fn view(&self) -> View<'_> {
        View {
            foundation: self.drive.contact.foundation,
            remaining: self.drive.remaining(),
            division: self.division.as_ref(),
        }
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
        let mut states = vec![self.state.at_rest()];
        if self.state.is_separated() {
            self.touch(&mut states)?;
        }
        let view = View {
            foundation: self.drive.contact.foundation,
            remaining: self.drive.remaining(),
            division: self.division.as_ref(),
        };
        let mut recorder = Recorder::new(view, self.contact.gaps().len());
        let drive = &mut self.drive;
        let mut course = Course::new(drive, &self.state, direction, goal, &mut self.work)?;
        course.speed = self.speed;
        course.tolerance = self.tolerance;
        course.stop = self.stop;
        course.run(&mut states, &mut recorder)?;
        let recorded = recorder.finish(&states)?;
        self.finish(target, direction, states, recorded)
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

    /// Keeps the drive in place for a time in s.
    fn hold(&mut self, target: Move, seconds: f64) -> Result<StageRecord, ContactError> {
        check_hold(seconds)?;
        if self.state.is_separated() || seconds == 0.0 {
            return Ok(StageRecord::still(target, self.point()));
        }
        let mut states = vec![self.state.at_rest()];
        let step = Step {
            drive: self.state.drive,
            seconds: seconds / STEPS as f64,
        };
        let tolerance = self.tolerance * self.drive.largest_force;
        let view = View {
            foundation: self.drive.contact.foundation,
            remaining: self.drive.remaining(),
            division: self.division.as_ref(),
        };
        let mut recorder = Recorder::new(view, self.contact.gaps().len());
        for _ in 0..STEPS {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            self.drive.step(&mut states, step, tolerance)?;
            recorder.add_all_but_last(&mut states);
        }
        let recorded = recorder.finish(&states)?;
        let falls = states
            .last()
            .is_some_and(|last| last.indentation < self.state.indentation);
        let direction = if falls {
            Direction::Unloading
        } else {
            Direction::Loading
        };
        self.finish(target, direction, states, recorded)
    }

    /// Moves the body to the last one of `states`, and returns the record of the stage.
    fn finish(
        &mut self,
        target: Move,
        direction: Direction,
        states: Vec<State>,
        recorded: Recorded,
    ) -> Result<StageRecord, ContactError> {
        let Some(last) = states.into_iter().next_back() else {
            return Ok(StageRecord::still(target, self.point()));
        };
        self.stage = self.stage_of(direction, &last, &recorded)?;
        let relaxation = self.drive.relaxation;
        let mut record = recorded.record(&self.drive.contact, relaxation, target, direction);
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
        recorded: &Recorded,
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
            let detached_at = recorded.detached_at()[spring];
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
        let view = self.view();
        match &state.phase {
            Phase::Apart => Vec::new(),
            Phase::Deepest => view.whole(self.drive.approach.stage.patches(state.deepest)),
            Phase::Turned(_) => view.turned_patches(state).unwrap_or_default(),
        }
    }

    /// Returns the states of the patches in contact, from left to right. The force and the stretch
    /// of each patch take account of the relaxation.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
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

impl MovingBody for RelaxingBody<'_> {
    /// Moves the body to a target and returns the record of the stage.
    ///
    /// # Errors
    /// Returns an error for a target that the contact cannot reach. Returns
    /// [`ContactError::NotRecovered`] for a loading after springs have detached. After an error the
    /// body stays in place.
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
