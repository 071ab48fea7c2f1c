//! Manual loading: the body moved by steps of any size, either way, at a cost in proportion to the change.
//!
//! The exact solver finds the indentations of all events of a leg; manual loading knows the next event alone. A move
//! proceeds from event to event: a free local minimum of the gap touches, a fragment attaches its wall, with the rest
//! of the subtree where it merges, or a fragment detaches its most stretched spring. Both use the same thresholds of
//! the same spans, so both find the same contact, bit for bit.
//!
//! A move that changes k springs of N in n fragments takes O((k + 1) log N) time with whole springs, and O(n) more
//! where edges slide between springs, as edges always do; there a move to a force takes O(n) for each event on its way.
//! A start takes O(N).

mod dissipation;
mod force;
mod fragments;
mod start;
mod winner_tree;

use super::adhesive::{ContactTree, EdgeModel};
use super::leg_plan::plan;
use super::{ContactError, CurvePoint, Direction, Foundation};
use crate::scene::Leg;
use dissipation::Dissipation;
use fragments::FragmentSet;
use std::collections::HashMap;
use std::sync::Arc;
use thiserror::Error;

/// A body under manual loading, with either edge model.
///
/// An error leaves the body in place.
pub trait ManualLoading {
    /// Presses or pulls to this indentation, m.
    ///
    /// From separation a move to d ≥ 0 touches, also without a change of the indentation.
    ///
    /// # Errors
    /// [`ManualError::NotFinite`].
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, ManualError>;

    /// Presses until the force first reaches `force`, N, or pulls until it falls to `force`; a body at this force
    /// stays.
    ///
    /// # Errors
    /// [`ManualError::NotFinite`], [`ManualError::NothingToPull`], [`ManualError::DetachesBefore`],
    /// [`ManualError::OutOfReach`].
    fn move_to_force(&mut self, force: f64) -> Result<Move, ManualError>;

    /// Checks that [`Self::move_to_force`] reaches a force, N, without moving the body.
    ///
    /// # Errors
    /// Those of the move.
    fn check_force(&mut self, force: f64) -> Result<(), ManualError>;

    /// Pulls just until the bodies separate.
    fn separate(&mut self) -> Move;

    /// Present point of the curve.
    fn point(&self) -> CurvePoint;

    /// First and last spring of each fragment in contact, in ascending order along the line. With n fragments of N
    /// springs this takes O(n log(N/n)) time.
    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_>;

    /// See [`Solver::rises`](super::Solver::rises).
    fn rises(&self) -> Vec<f64>;
}

/// The changes of one move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Move {
    /// Springs that came into contact.
    pub attaches: u64,
    /// Springs that detached.
    pub detaches: u64,
    /// Events: a spring touches alone, a fragment attaches its wall, or a fragment detaches a spring.
    pub events: u64,
    /// Table entries read or changed: a measure of the time, the same on every machine.
    pub touched: u64,
    /// Released elastic energy, J; see [`LegRecord::released_energy`](super::LegRecord::released_energy).
    pub released_energy: f64,
}

/// Reason for which a body could not be moved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ManualError {
    /// Manual loading could not begin.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A number that is no indentation or force.
    #[error("{value} is neither an indentation nor a force: allowed are finite numbers")]
    NotFinite {
        /// The number.
        value: f64,
    },
    /// A pulling force on a separated body.
    #[error("nothing touches that could be pulled with {force:e} N; allowed: at least 0 N")]
    NothingToPull {
        /// Requested force, N.
        force: f64,
    },
    /// The contact detaches before this force.
    #[error("the contact detaches before {force:e} N; allowed: at least {smallest:e} N")]
    DetachesBefore {
        /// Requested force, N.
        force: f64,
        /// Smallest force that the present contact bears when pulled, N.
        smallest: f64,
    },
    /// The force lies beyond all indentations.
    #[error("no finite indentation reaches {force:e} N on this foundation")]
    OutOfReach {
        /// Requested force, N.
        force: f64,
    },
}

/// A body on its foundation under manual loading.
///
/// Without adhesion the rule of Hess is that of no work of adhesion: each spring attaches and detaches at its own gap.
pub struct Manual<E> {
    contact: FragmentSet<E>,
    foundation: Foundation,
    /// m
    indentation: f64,
}

impl<E: EdgeModel> Manual<E> {
    /// Returns a separated body over springs of these gaps (m, the smallest 0) and their tree, at d = 0 just before
    /// first touch. The gaps are copied.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        gaps: &[f64],
        tree: Arc<ContactTree>,
        edges: E,
        foundation: Foundation,
    ) -> Result<Self, ContactError> {
        let contact = FragmentSet::new(gaps, tree, edges, &[], |_, _| 0.0)?;
        Ok(Manual { contact, foundation, indentation: 0.0 })
    }

    /// Returns a body at `indentation`, m, in the contact of these fragments (first and last spring of each), as
    /// returned by [`Solver::fragments`](super::Solver::fragments) and [`ManualLoading::fragments`].
    ///
    /// Under two works of adhesion the edges of each fragment are pinned at these `rises`, m, as returned by
    /// [`Solver::rises`](super::Solver::rises); without a rise they lie as after loading. Under one work of adhesion
    /// the edges follow from the indentation.
    ///
    /// Springs that do not form a fragment in equilibrium are reduced to the largest spans inside that do. A contact
    /// that is not in equilibrium relaxes with the next move.
    ///
    /// # Errors
    /// [`ManualError::NotFinite`], [`ContactError::OutOfMemory`].
    pub fn in_contact(
        gaps: &[f64],
        tree: Arc<ContactTree>,
        edges: E,
        foundation: Foundation,
        indentation: f64,
        fragments: &[(usize, usize)],
        rises: &[f64],
    ) -> Result<Self, ManualError> {
        let indentation = finite(indentation)?;
        let known: HashMap<_, _> = fragments.iter().copied().zip(rises.iter().copied()).collect();
        let contact = FragmentSet::new(gaps, tree, edges, fragments, |ground, span| {
            ground.rise(span, known.get(&(span.first, span.last)).copied(), indentation)
        })?;
        Ok(Manual { contact, foundation, indentation })
    }

    fn is_separated(&self) -> bool {
        self.contact.totals().springs == 0
    }

    fn begin(&mut self, direction: Direction) -> Course {
        let touched_before = self.contact.touched();
        self.contact.turn(direction, self.indentation);
        // Without adhesion nothing is stretched.
        let adheres = self.contact.adheres();
        Course {
            direction,
            level: self.indentation,
            springs: 0,
            events: 0,
            touched_before,
            dissipation: adheres.then(|| Dissipation::new(direction, self.indentation)),
        }
    }

    /// Attaches or detaches one spring after the other, as long as `goes_on` is true of the indentation of the next
    /// one, m.
    fn proceed(&mut self, course: &mut Course, goes_on: impl Fn(f64) -> bool) {
        while let Some(next) = self.contact.next_event().filter(|&next| goes_on(next)) {
            // A fragment attaches no spring before its formation, and a part detaches none before its whole has parted.
            course.level = match course.direction {
                Direction::Loading => course.level.max(next),
                Direction::Unloading => course.level.min(next),
            };
            let Some(event) = self.contact.change() else { break };
            course.springs += event.springs;
            course.events += u64::from(event.springs > 0);
            if let Some(dissipation) = &mut course.dissipation {
                dissipation.change(self.contact.ground(), course.level, &event, self.contact.parts());
            }
        }
    }

    /// Ends a move at an indentation.
    fn end(&mut self, mut course: Course, indentation: f64) -> Move {
        self.indentation = indentation;
        let mut touched = self.contact.touched() - course.touched_before;
        if let Some(dissipation) = course.dissipation.as_mut().filter(|_| E::SLIDES) {
            for fragment in self.contact.fragments() {
                touched += 1;
                dissipation.slide(self.contact.ground(), &fragment, indentation);
            }
        }
        let squared_stretch = course.dissipation.map_or(0.0, Dissipation::squared_stretch);
        let energy = 0.5 * self.foundation.spring_stiffness() * squared_stretch;
        let Course { springs, events, .. } = course;
        let (attaches, detaches, released_energy) = match course.direction {
            // Not −0 where nothing attached under a stretch.
            Direction::Loading => (springs, 0, 0.0 - energy),
            Direction::Unloading => (0, springs, energy),
        };
        Move { attaches, detaches, events, touched, released_energy }
    }

    /// Presses until the force is at least `force`, or pulls until it is at most `force`; returns the course up to
    /// there and its indentation, or `None` where the body is at `force` already. The move has not ended.
    fn find_force(&mut self, force: f64) -> Result<Option<(Course, f64)>, ManualError> {
        let stiffness = self.foundation.spring_stiffness();
        let Some(direction) = self.direction(Leg::ToForce(force))? else { return Ok(None) };
        let mut course = self.begin(direction);
        let to = match direction {
            Direction::Loading => {
                let to = self.press_to_compression(&mut course, force / stiffness);
                to.ok_or(ManualError::OutOfReach { force })?
            }
            Direction::Unloading => {
                let to = self.pull_to_compression(&mut course, force / stiffness);
                to.map_err(|smallest| ManualError::DetachesBefore { force, smallest: stiffness * smallest })?
            }
        };
        Ok(Some((course, to)))
    }

    /// Direction of a leg from the present point; `None` where it ends there.
    fn direction(&self, leg: Leg) -> Result<Option<Direction>, ManualError> {
        let planned = plan(leg, self.point(), 0).map_err(|error| match error {
            ContactError::NothingToPull { force, .. } => ManualError::NothingToPull { force },
            other => ManualError::Contact(other),
        })?;
        Ok(planned.map(|(direction, _)| direction))
    }

    /// Moves to a force, or with `stays` only checks that it can be reached.
    fn try_force(&mut self, force: f64, stays: bool) -> Result<Move, ManualError> {
        let force = finite(force)?;
        let before = self.contact.totals();
        self.contact.keep_journal();
        let moved = match self.find_force(force) {
            Ok(Some((course, to))) if !stays => Ok(self.end(course, to)),
            found => {
                self.contact.take_back(before);
                found.map(|_| Move::default())
            }
        };
        self.contact.drop_journal();
        moved
    }
}

impl<E: EdgeModel> ManualLoading for Manual<E> {
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, ManualError> {
        let leg = Leg::ToIndentation(finite(indentation)?);
        let Some(direction) = self.direction(leg)? else { return Ok(Move::default()) };
        let mut course = self.begin(direction);
        self.proceed(&mut course, |next| match direction {
            Direction::Loading => next <= indentation,
            Direction::Unloading => next > indentation,
        });
        Ok(self.end(course, indentation))
    }

    fn move_to_force(&mut self, force: f64) -> Result<Move, ManualError> {
        self.try_force(force, false)
    }

    fn check_force(&mut self, force: f64) -> Result<(), ManualError> {
        self.try_force(force, true).map(drop)
    }

    fn separate(&mut self) -> Move {
        let mut course = self.begin(Direction::Unloading);
        self.proceed(&mut course, |_| true);
        let end = course.level;
        self.end(course, end)
    }

    fn point(&self) -> CurvePoint {
        self.steady().state(self.indentation).point(self.foundation)
    }

    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_> {
        Box::new(self.contact.fragments().map(|fragment| (fragment.span.first, fragment.span.last)))
    }

    fn rises(&self) -> Vec<f64> {
        self.contact.rises(self.indentation)
    }
}

/// A move in progress.
struct Course {
    direction: Direction,
    /// Indentation of the last event, m; monotonic.
    level: f64,
    springs: u64,
    events: u64,
    touched_before: u64,
    /// `None` where nothing is stretched.
    dissipation: Option<Dissipation>,
}

fn finite(value: f64) -> Result<f64, ManualError> {
    if value.is_finite() { Ok(value) } else { Err(ManualError::NotFinite { value }) }
}
