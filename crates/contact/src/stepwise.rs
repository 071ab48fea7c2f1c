//! The stepwise solver, which works as Popov and Filippov (2012) do: it moves by a small step,
//! relaxes to equilibrium and repeats.
//!
//! The error is of the order of the step Δd, and each step costs a few sweeps over the whole
//! profile. This solver shares only the rules and the sums with the exact solver.

use super::adhesive::levels::EdgeCells;
use super::contact::Contact;
use super::contact_state::{ContactState, Grid};
use super::error::{ContactError, STEP_LIMIT};
use super::history::{CurvePoint, Direction, LegRecord, Work};
use super::history::{Goal, plan};
use super::leg::Leg;
use super::moving_body::MovingBody;
use super::target::Move;
use super::totals::ContactTotals;
use asperity_data::resized;

/// The stepwise solver: a body that moves by small steps and relaxes to equilibrium after each
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
    /// Σ e² in m² over the springs detached on the present motion, minus the same sum over the
    /// springs attached.
    squared_stretch: f64,
    /// True for each spring in contact.
    holds: Vec<bool>,
    /// Indentation in m at which each spring last attached or detached.
    thresholds: Vec<f64>,
    work: Work,
}

impl<'a> Stepwise<'a> {
    /// Creates a separated body that moves by steps of `step` in m. Its patches consist of whole
    /// springs, as with [`Edges::Grid`](crate::Edges::Grid). The force curve of each motion has
    /// `samples` points, at least 2. `stop` is called before each step. If `stop` returns true, the
    /// motion ends with [`ContactError::Interrupted`].
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

    /// Attaches or detaches a spring at the indentation `at` in m. A spring that detaches was held
    /// to exactly `at`, because the overshoot of a step is no property of the contact.
    fn change(&mut self, index: usize, attaches: bool, at: f64) {
        let gap = self.contact.gaps()[index];
        self.holds[index] = attaches;
        self.thresholds[index] = at;
        let spring = ContactTotals::of_patch(&[gap], false, self.contact.profile.springs.scale());
        let squared_stretch = (gap - at).max(0.0).powi(2);
        self.totals += if attaches { spring } else { -spring };
        self.squared_stretch += if attaches {
            -squared_stretch
        } else {
            squared_stretch
        };
    }

    /// Sweeps until no spring touches and no patch grows.
    fn relax_loading(&mut self) {
        let (gaps, at) = (self.contact.gaps(), self.indentation);
        loop {
            let before = self.totals.springs;
            self.work.relaxation_sweeps += 1;
            self.work.spring_updates += gaps.len() as u64;
            for (index, &gap) in gaps.iter().enumerate() {
                if !self.holds[index] && gap <= at {
                    self.change(index, true, at);
                }
            }
            if self.contact.hess.is_some() {
                self.grow_fragments();
            }
            if self.totals.springs == before {
                return;
            }
        }
    }

    /// Extends each patch over its neighbours as long as the rule of Hess allows.
    fn grow_fragments(&mut self) {
        let (gaps, at) = (self.contact.gaps(), self.indentation);
        let mut first = 0;
        while let Some(start) = (first..gaps.len()).find(|&index| self.holds[index]) {
            let (mut start, mut end) = (start, start + 1);
            loop {
                end += self.holds[end..].iter().take_while(|&&holds| holds).count();
                start -= self.holds[..start]
                    .iter()
                    .rev()
                    .take_while(|&&holds| holds)
                    .count();
                let stretch = self
                    .contact
                    .rule()
                    .largest_stretch(Direction::Loading, end - start);
                self.work.spring_updates += 2;
                let takes = |index: &usize| gaps.get(*index).is_some_and(|gap| gap - stretch <= at);
                let next = Some(end)
                    .filter(takes)
                    .or_else(|| start.checked_sub(1).filter(takes));
                let Some(next) = next else { break };
                self.change(next, true, at);
            }
            first = end;
        }
    }

    /// Sweeps until every patch holds its most stretched spring.
    fn relax_unloading(&mut self, held_until: f64) {
        let (gaps, at) = (self.contact.gaps(), self.indentation);
        loop {
            let held = self.totals.springs;
            self.work.relaxation_sweeps += 1;
            let mut first = 0;
            while first < gaps.len() {
                let end = first
                    + self.holds[first..]
                        .iter()
                        .take_while(|&&holds| holds)
                        .count();
                self.work.spring_updates += 2 * (end - first) as u64 + 1;
                let stretch = self
                    .contact
                    .rule()
                    .largest_stretch(Direction::Unloading, end - first);
                for (place, &gap) in gaps[first..end].iter().enumerate() {
                    // A spring stretched too far here is stretched too far in each part of the
                    // fragment as well.
                    if at <= gap - stretch && at < gap {
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
        let fragments = self
            .holds
            .chunk_by(PartialEq::eq)
            .filter(|run| run[0])
            .count();
        let totals = ContactTotals {
            fragments: fragments as i64,
            ..self.totals
        };
        let edges = EdgeCells::default();
        let state = ContactState::new(
            false,
            self.indentation,
            totals,
            edges,
            &self.contact.profile.springs.scale(),
        );
        state.point(self.contact.foundation)
    }

    /// Returns an error, before the first step, for a motion that certainly needs more steps than
    /// allowed.
    fn check_steps(&self, direction: Direction, goal: Goal) -> Result<(), ContactError> {
        let start = self.indentation;
        let end = match goal {
            Goal::Indentation(end) => end,
            // No spring is compressed by more than the indentation, and any patch holds the highest
            // point to the stretch of one spring.
            Goal::Force(force) if direction == Direction::Loading => {
                force / (self.contact.foundation.spring_stiffness() * self.holds.len() as f64)
            }
            Goal::Force(_) | Goal::Displacement(_) => start,
            Goal::Separation(_) => -self.contact.rule().stretch(Direction::Unloading),
        };
        if !end.is_finite() {
            return Err(ContactError::OutOfReach);
        }
        // From separation the first step is the touch.
        let start = if self.totals.springs == 0 {
            start.max(0.0)
        } else {
            start
        };
        let way = if direction == Direction::Loading {
            end - start
        } else {
            start - end
        };
        if way / self.step > STEP_LIMIT as f64 {
            Err(ContactError::TooManySteps(self.step))
        } else {
            Ok(())
        }
    }

    fn walk(
        &mut self,
        target: Move,
        direction: Direction,
        goal: Goal,
    ) -> Result<LegRecord, ContactError> {
        for (threshold, &holds) in self.thresholds.iter_mut().zip(&self.holds) {
            *threshold = if holds {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
        }
        (self.direction, self.squared_stretch) = (direction, 0.0);
        let here = self.point();
        let [mut smallest, mut largest] = [here; 2];
        let loads = direction == Direction::Loading;
        // From separation the first step is the touch.
        let touches = here.springs == 0 && loads;
        let origin = if touches {
            here.indentation.max(0.0)
        } else {
            here.indentation
        };
        for steps in u64::from(!touches).. {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            if steps > STEP_LIMIT {
                return Err(ContactError::TooManySteps(self.step));
            }
            let held_until = self.indentation;
            let moved = steps as f64 * self.step;
            let wanted = if loads {
                origin + moved
            } else {
                origin - moved
            };
            self.indentation = match goal {
                Goal::Indentation(end) if loads => wanted.min(end),
                Goal::Indentation(end) => wanted.max(end),
                _ => wanted,
            };
            self.work.steps += 1;
            if loads {
                self.relax_loading()
            } else {
                self.relax_unloading(held_until)
            }
            let point = self.point();
            largest = if point.force > largest.force {
                point
            } else {
                largest
            };
            smallest = if point.force < smallest.force {
                point
            } else {
                smallest
            };
            let holds = point.springs > 0;
            let reached = match goal {
                Goal::Indentation(end) => point.indentation == end,
                Goal::Force(force) if loads => point.force >= force,
                Goal::Force(_) if !holds => {
                    return Err(ContactError::DetachesBefore {
                        smallest: smallest.force,
                    });
                }
                Goal::Force(force) => point.force <= force,
                Goal::Separation(_) | Goal::Displacement(_) => !holds,
            };
            if reached {
                break;
            }
        }
        // The sum counts detachments.
        let squared = if loads {
            -self.squared_stretch
        } else {
            self.squared_stretch
        };
        let (leg, end) = (self.leg(), self.point());
        let (low, high) = (origin.min(end.indentation), origin.max(end.indentation));
        let curve = leg.curve(&Grid::new(low, high, self.samples - 1).points)?;
        let record = LegRecord::moved(
            (target, leg.direction()),
            curve,
            [smallest, largest],
            [here, end],
            leg.energy(squared),
        );
        let reaches_ends = leg.reaches_ends(high);
        let record = LegRecord {
            reaches_ends,
            ..record
        };
        self.work.count(&record);
        Ok(record)
    }
}

impl Stepwise<'_> {
    /// Returns the point of the smallest force on the rest of an unloading, on which a copy of the
    /// body walks to separation. Returns `None` for a loading, for a separated body, and if the
    /// copy takes too many steps.
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
    fn advance(&mut self, target: Move) -> Result<LegRecord, ContactError> {
        let here = self.point();
        // Its instrument is rigid: no goal is a displacement.
        match plan(target, here, f64::INFINITY)? {
            None => Ok(LegRecord::still(target, here)),
            Some((_, Goal::Indentation(end))) if here.springs == 0 && end < 0.0 => {
                self.indentation = end;
                Ok(LegRecord::free(target, here.indentation, end))
            }
            Some((direction, goal)) => {
                self.check_steps(direction, goal)?;
                let before = self.clone();
                match self.walk(target, direction, goal) {
                    Ok(record) => Ok(LegRecord {
                        smallest_of_rest: self.rest(direction)?,
                        ..record
                    }),
                    Err(error) => {
                        *self = Stepwise {
                            work: self.work,
                            ..before
                        };
                        Err(error)
                    }
                }
            }
        }
    }

    fn leg(&self) -> Leg {
        Leg::of_thresholds(
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
        // Each step adds its own point to the curve.
        0.0
    }
}
