//! The stepwise solver, which works as Popov and Filippov (2012) do: it moves by a small step,
//! waits for equilibrium and repeats.
//!
//! The deviation from the exact solution is of the order of the step Δd, and each step needs a few
//! sweeps over the whole profile. The stepwise solver shares with the exact solver only the rules
//! of detachment and the sums over springs.

use super::adhesive::levels::EdgeCells;
use super::contact::Contact;
use super::contact_state::{ContactState, Grid};
use super::detachment::DetachmentRule;
use super::error::{ContactError, STEP_LIMIT};
use super::history::{CurvePoint, Direction, Extremes, Goal, Passage, StageRecord, Work, plan};
use super::moving_body::MovingBody;
use super::stage::Stage;
use super::target::Move;
use super::totals::ContactTotals;
use asperity_data::resized;
use std::ops::Range;

/// The stepwise solver: a body that moves by small steps and finds equilibrium after each
/// step.
///
/// ```
/// use asperity_contact::motion::{Body, MovingBody, Stepwise};
/// use asperity_contact::{Contact, Edges, Modulus, Move, Profile};
///
/// let profile = Profile::from_heights(&[0.0, -4.0e-8, -1.0e-8, -4.0e-8, -9.0e-8], 1.0e-6)?;
/// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).work_of_adhesion(2.0e-4);
/// let contact = contact.edges(Edges::Grid).build()?;
/// let mut stepwise = Stepwise::new(&contact, 1.0e-10, 16, &|| false)?;
/// let mut exact = Body::new(&contact, 16);
/// for target in [Move::ToIndentation(5.0e-8), Move::ToSeparation] {
///     let [one, other] = [stepwise.advance(target)?, exact.advance(target)?];
///     assert_eq!((one.attached, one.detached), (other.attached, other.detached));
/// }
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone)]
pub struct Stepwise<'a> {
    contact: &'a Contact,
    step: f64,
    samples: usize,
    stop: &'a dyn Fn() -> bool,
    direction: Direction,
    indentation: f64,
    totals: ContactTotals,
    /// Sum in m² of the squared stretches of all springs at their detachment on the present motion,
    /// minus the same sum over all springs at their attachment.
    squared_stretch: f64,
    /// True for each spring in contact.
    holds: Vec<bool>,
    /// Indentation in m at which each spring last attached or detached.
    thresholds: Vec<f64>,
    work: Work,
}

impl<'a> Stepwise<'a> {
    /// Creates a separated body that moves by steps of the length `step` in m. Its patches consist
    /// of whole springs, as with [`Edges::Grid`](crate::Edges::Grid). The force curve of each
    /// motion has `samples` points, at least 2. `stop` is called before each step. If `stop`
    /// returns true, the motion ends with [`ContactError::Interrupted`].
    pub fn new(
        contact: &'a Contact,
        step: f64,
        samples: usize,
        stop: &'a dyn Fn() -> bool,
    ) -> Result<Self, ContactError> {
        let springs = contact.gaps().len();
        Ok(Stepwise {
            contact,
            step,
            samples: samples.max(2),
            stop,
            direction: Direction::Loading,
            indentation: 0.0,
            totals: ContactTotals::default(),
            squared_stretch: 0.0,
            holds: resized(Vec::new(), springs, false)?,
            thresholds: resized(Vec::new(), springs, f64::INFINITY)?,
            work: Work {
                springs: springs as u64,
                ..Work::default()
            },
        })
    }

    /// Attaches or detaches a spring at an indentation in m. The energy of a spring that detaches
    /// is computed at exactly this indentation, so that the energy does not depend on how far the
    /// step goes beyond it.
    fn change(&mut self, index: usize, attaches: bool, indentation: f64) {
        let gap = self.contact.gaps()[index];
        self.holds[index] = attaches;
        self.thresholds[index] = indentation;
        let scale = self.contact.profile.springs.scale();
        let spring = ContactTotals::of_patch(&[gap], false, scale);
        let squared_stretch = (gap - indentation).max(0.0).powi(2);
        if attaches {
            self.totals += spring;
            self.squared_stretch -= squared_stretch;
        } else {
            self.totals += -spring;
            self.squared_stretch += squared_stretch;
        }
    }

    /// Attaches springs, in sweeps over the profile, until no further spring touches and no patch
    /// grows.
    fn attach_to_equilibrium(&mut self) {
        let gaps = self.contact.gaps();
        let indentation = self.indentation;
        loop {
            let before = self.totals.springs;
            self.work.equilibrium_sweeps += 1;
            self.work.spring_updates += gaps.len() as u64;
            for (index, &gap) in gaps.iter().enumerate() {
                if !self.holds[index] && gap <= indentation {
                    self.change(index, true, indentation);
                }
            }
            if self.contact.has_adhesion() {
                self.grow_patches();
            }
            if self.totals.springs == before {
                return;
            }
        }
    }

    /// Extends each patch by neighbouring springs as long as the rule of detachment allows.
    fn grow_patches(&mut self) {
        let rule = self.contact.rules().rule(Direction::Loading);
        let springs = self.holds.len();
        let mut first = 0;
        while let Some(start) = (first..springs).find(|&index| self.holds[index]) {
            let mut patch = start..start + 1;
            loop {
                patch = self.whole_patch(patch);
                let stretch = rule.largest_stretch(patch.len() as f64);
                self.work.spring_updates += 2;
                let Some(next) = self.next_to_attach(&patch, stretch) else {
                    break;
                };
                self.change(next, true, self.indentation);
            }
            first = patch.end;
        }
    }

    /// Returns the whole patch that contains `part`, a range of springs in contact.
    fn whole_patch(&self, part: Range<usize>) -> Range<usize> {
        let (before, from) = self.holds.split_at(part.start);
        let on_the_left = before.iter().rev().take_while(|&&holds| holds).count();
        let from_the_start = from.iter().take_while(|&&holds| holds).count();
        part.start - on_the_left..part.start + from_the_start
    }

    /// Returns the spring beside a patch that attaches if the patch bears a stretch of `stretch` in
    /// m; `None` if neither spring attaches. If both springs attach, returns the right one.
    fn next_to_attach(&self, patch: &Range<usize>, stretch: f64) -> Option<usize> {
        let gaps = self.contact.gaps();
        let attaches = |index: usize| gaps[index] - stretch <= self.indentation;
        if patch.end < gaps.len() && attaches(patch.end) {
            return Some(patch.end);
        }
        let left = patch.start.checked_sub(1)?;
        attaches(left).then_some(left)
    }

    /// Detaches springs, in sweeps over the profile, until every patch bears the stretch of its
    /// most stretched spring. The springs that detach were in contact up to the indentation
    /// `held_until` in m.
    fn detach_to_equilibrium(&mut self, held_until: f64) {
        let gaps = self.contact.gaps();
        let indentation = self.indentation;
        let rule = self.contact.rules().rule(Direction::Unloading);
        loop {
            let held = self.totals.springs;
            self.work.equilibrium_sweeps += 1;
            let mut first = 0;
            while first < gaps.len() {
                let in_contact = self.holds[first..].iter().take_while(|&&holds| holds);
                let end = first + in_contact.count();
                self.work.spring_updates += 2 * (end - first) as u64 + 1;
                let stretch = rule.largest_stretch((end - first) as f64);
                for (place, &gap) in gaps[first..end].iter().enumerate() {
                    // If a patch cannot bear the stretch of this spring, the smaller patches into
                    // which the patch splits cannot bear this stretch either. The spring therefore
                    // detaches at once.
                    if indentation <= gap - stretch && indentation < gap {
                        self.change(first + place, false, held_until);
                    }
                }
                first = end + 1;
            }
            if self.totals.springs == held {
                return;
            }
        }
    }

    fn point(&self) -> CurvePoint {
        let runs = self.holds.chunk_by(PartialEq::eq);
        let patches = runs.filter(|run| run[0]).count();
        let totals = ContactTotals {
            patches: patches as i64,
            ..self.totals
        };
        let scale = self.contact.profile.springs.scale();
        let edges = EdgeCells::default();
        let state = ContactState::new(false, self.indentation, totals, edges, &scale);
        state.point(&self.contact)
    }

    /// Returns an error if a motion certainly needs more steps than allowed. The solver calls this
    /// function before the first step of the motion.
    fn check_steps(&self, direction: Direction, goal: Goal) -> Result<(), ContactError> {
        let start = self.indentation;
        let end = match goal {
            Goal::Indentation(end) => end,
            // On loading no spring is compressed by more than the indentation. On unloading even a
            // patch of one spring bears some stretch, so the highest point stays in contact at
            // least up to this stretch.
            Goal::Force(force) if direction == Direction::Loading => {
                force / (self.contact.foundation.spring_stiffness() * self.holds.len() as f64)
            }
            Goal::Force(_) | Goal::Displacement(_) => start,
            Goal::Separation(_) => {
                let rule = self.contact.rules().rule(Direction::Unloading);
                -rule.largest_stretch(1.0)
            }
        };
        if !end.is_finite() {
            return Err(ContactError::OutOfReach);
        }
        // A separated body begins its steps at first touch.
        let start = if self.totals.springs == 0 {
            start.max(0.0)
        } else {
            start
        };
        let way = match direction {
            Direction::Loading => end - start,
            Direction::Unloading => start - end,
        };
        if way / self.step > STEP_LIMIT as f64 {
            return Err(ContactError::TooManySteps(self.step));
        }
        Ok(())
    }

    /// Moves the body step by step to a goal.
    fn walk(
        &mut self,
        target: Move,
        direction: Direction,
        goal: Goal,
    ) -> Result<StageRecord, ContactError> {
        self.begin(direction);
        let before = self.point();
        let loads = direction == Direction::Loading;
        // A separated body begins its steps at first touch.
        let touches = before.springs == 0 && loads;
        let origin = if touches {
            before.indentation.max(0.0)
        } else {
            before.indentation
        };
        let mut extremes = Extremes {
            smallest: before,
            largest: before,
        };
        for steps in u64::from(!touches).. {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            if steps > STEP_LIMIT {
                return Err(ContactError::TooManySteps(self.step));
            }
            self.step_to(self.place_of_step(origin, steps, goal));
            let point = self.point();
            if point.force > extremes.largest.force {
                extremes.largest = point;
            }
            if point.force < extremes.smallest.force {
                extremes.smallest = point;
            }
            if self.has_reached(goal, point, extremes.smallest)? {
                break;
            }
        }
        self.record(target, origin, before, extremes)
    }

    /// Begins a motion: each spring in contact counts as in contact from the beginning of the
    /// motion, and each other spring as never in contact.
    fn begin(&mut self, direction: Direction) {
        self.direction = direction;
        self.squared_stretch = 0.0;
        for (threshold, &holds) in self.thresholds.iter_mut().zip(&self.holds) {
            *threshold = if holds {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
        }
    }

    /// Returns the indentation in m after `steps` steps from the indentation `origin` in m.
    fn place_of_step(&self, origin: f64, steps: u64, goal: Goal) -> f64 {
        let way = steps as f64 * self.step;
        let place = match self.direction {
            Direction::Loading => origin + way,
            Direction::Unloading => origin - way,
        };
        match (goal, self.direction) {
            (Goal::Indentation(end), Direction::Loading) => place.min(end),
            (Goal::Indentation(end), Direction::Unloading) => place.max(end),
            _ => place,
        }
    }

    /// Moves the body to an indentation in m and finds equilibrium.
    fn step_to(&mut self, indentation: f64) {
        let held_until = self.indentation;
        self.indentation = indentation;
        self.work.steps += 1;
        match self.direction {
            Direction::Loading => self.attach_to_equilibrium(),
            Direction::Unloading => self.detach_to_equilibrium(held_until),
        }
    }

    /// Returns true if the body reaches the goal at the point `point`. `smallest` is the point of
    /// the smallest force of the motion so far.
    fn has_reached(
        &self,
        goal: Goal,
        point: CurvePoint,
        smallest: CurvePoint,
    ) -> Result<bool, ContactError> {
        let is_separated = point.springs == 0;
        match goal {
            Goal::Indentation(end) => Ok(point.indentation == end),
            Goal::Force(force) if self.direction == Direction::Loading => Ok(point.force >= force),
            Goal::Force(_) if is_separated => Err(ContactError::DetachesBefore {
                smallest: smallest.force,
            }),
            Goal::Force(force) => Ok(point.force <= force),
            Goal::Separation(_) | Goal::Displacement(_) => Ok(is_separated),
        }
    }

    /// Records the motion from the indentation `origin` in m to the present indentation.
    fn record(
        &mut self,
        target: Move,
        origin: f64,
        before: CurvePoint,
        extremes: Extremes,
    ) -> Result<StageRecord, ContactError> {
        let stage = self.stage();
        let after = self.point();
        let low = origin.min(after.indentation);
        let high = origin.max(after.indentation);
        let mut curve = stage.curve(&Grid::new(low, high, self.samples - 1).points)?;
        curve.reserve_exact(StageRecord::FURTHER_POINTS);
        // The field `squared_stretch` counts detachments as positive. A stage counts attachments as
        // positive on loading and detachments as positive on unloading.
        let squared_stretch = match self.direction {
            Direction::Loading => -self.squared_stretch,
            Direction::Unloading => self.squared_stretch,
        };
        let passage = Passage {
            target,
            direction: self.direction,
            before,
            after,
        };
        let released_energy = stage.energy(squared_stretch);
        let mut record = StageRecord::moved(passage, curve, extremes, released_energy);
        record.reaches_ends = stage.reaches_ends(high);
        self.work.count(&record);
        Ok(record)
    }
}

impl Stepwise<'_> {
    /// Returns the point of the smallest force on the rest of an unloading. A copy of the body
    /// makes the rest of the motion, up to separation. Returns `None` for a loading, for a
    /// separated body, and if the copy needs too many steps.
    fn rest(&self, direction: Direction) -> Result<Option<CurvePoint>, ContactError> {
        if direction == Direction::Loading || self.totals.springs == 0 {
            return Ok(None);
        }
        let mut copy = self.clone();
        match copy.walk(Move::ToSeparation, direction, Goal::Separation(None)) {
            Ok(record) => Ok(Some(record.smallest)),
            Err(ContactError::Interrupted) => Err(ContactError::Interrupted),
            Err(_) => Ok(None),
        }
    }
}

impl MovingBody for Stepwise<'_> {
    fn advance(&mut self, target: Move) -> Result<StageRecord, ContactError> {
        let here = self.point();
        // The instrument of the stepwise solver is rigid, so no goal is a displacement.
        match plan(target, here, f64::INFINITY)? {
            None => Ok(StageRecord::still(target, here)),
            Some((_, Goal::Indentation(end))) if here.springs == 0 && end < 0.0 => {
                self.indentation = end;
                Ok(StageRecord::free(target, here.indentation, end))
            }
            Some((direction, goal)) => {
                self.check_steps(direction, goal)?;
                let before = self.clone();
                match self.walk(target, direction, goal) {
                    Ok(mut record) => {
                        record.smallest_of_rest = self.rest(direction)?;
                        Ok(record)
                    }
                    Err(error) => {
                        // After an error the body is back at the beginning of the motion, but the
                        // work counts include the steps that were made.
                        let work = self.work;
                        *self = before;
                        self.work = work;
                        Err(error)
                    }
                }
            }
        }
    }

    fn stage(&self) -> Stage {
        Stage::of_thresholds(
            self.contact,
            self.direction,
            self.indentation,
            self.thresholds.clone(),
        )
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        // The stepwise solver does not measure the time for force curves separately.
        0.0
    }
}
