//! A body held in hand: moved by steps of any size, either way, at the cost of what changes.
//!
//! Where the exact solver asks for a whole leg when each spring joins or leaves, this one knows only what
//! happens next. A move goes from event to event: a free leaf of the tree touches, a fragment takes in the
//! spring of its parent and with it the rest of that subtree, or it lets its most stretched spring go and
//! its two parts remain. Which springs are in contact after a move follows from the same thresholds (see
//! the exact solver), so both stand in the same contact, bit for bit.
//!
//! A move that changes k springs of N takes O((k + 1) log N) time, whatever its length and its direction;
//! taking in hand takes O(N).

use super::fragment_set::{Event, FragmentSet};
use super::ledger::CompensatedSum;
use super::{ContactError, ContactTree, CurvePoint, EdgeRule, Foundation};
use std::sync::Arc;
use thiserror::Error;

/// A body that is held in hand, whatever the rule for its edges.
///
/// An error leaves it where it stood.
pub trait HandHeld {
    /// Presses or pulls to this indentation, m.
    ///
    /// From separation a move to d ≥ 0 touches, also where it has no length.
    ///
    /// # Errors
    /// [`HandError::NotFinite`].
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, HandError>;

    /// Presses until the force, N, is at least this for the first time, or pulls until it is at most
    /// this, if it is not this already.
    ///
    /// # Errors
    /// [`HandError::NotFinite`], [`HandError::NothingToPull`], [`HandError::LetsGoBefore`],
    /// [`HandError::OutOfReach`].
    fn move_to_force(&mut self, force: f64) -> Result<Move, HandError>;

    /// Pulls just until nothing touches any more.
    fn separate(&mut self) -> Move;

    /// Where the body stands.
    fn point(&self) -> CurvePoint;

    /// First and last spring of each fragment in contact, in ascending order along the line. With n
    /// fragments of N springs this takes O(n log(N/n)) time.
    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_>;
}

/// What one move did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Move {
    /// Springs that came into contact.
    pub joins: u64,
    /// Springs that left.
    pub leaves: u64,
    /// Events: fragments that formed, grew by the spring of their parent, or let a spring go.
    pub events: u64,
    /// Entries of all tables looked at or changed: a measure of the time taken, the same on every machine.
    pub touched: u64,
    /// Energy lost, J: ½ Δk Σ e² over the springs that left with a stretch e, less the same over those
    /// that joined.
    pub dissipated_energy: f64,
}

/// Why a body in hand could not be moved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HandError {
    /// It could not be taken in hand.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A number that is no indentation or force.
    #[error("{value} is neither an indentation nor a force: allowed are finite numbers")]
    NotFinite {
        /// The number.
        value: f64,
    },
    /// Nothing touches that could be pulled.
    #[error("nothing touches that could be pulled with {force:e} N; allowed: at least 0 N")]
    NothingToPull {
        /// Force asked for, N.
        force: f64,
    },
    /// The contact lets go before this force.
    #[error("the contact lets go before {force:e} N; allowed: at least {smallest:e} N")]
    LetsGoBefore {
        /// Force asked for, N.
        force: f64,
        /// Smallest force the contact bears when it is pulled from where it stands, N.
        smallest: f64,
    },
    /// The force lies beyond what indentations can reach.
    #[error("no finite indentation reaches {force:e} N on this foundation")]
    OutOfReach {
        /// Force asked for, N.
        force: f64,
    },
}

/// A body on its foundation, held in hand.
pub struct Incremental<R> {
    set: FragmentSet<R>,
    foundation: Foundation,
    indentation: f64,
}

impl<R: EdgeRule> Incremental<R> {
    /// A body over the springs of this tree (smallest gap 0), separated, at d = 0 just before first touch.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<ContactTree>, rule: R, foundation: Foundation) -> Result<Self, ContactError> {
        Ok(Incremental { set: FragmentSet::new(tree, rule, &[])?, foundation, indentation: 0.0 })
    }

    /// A body that stands at `indentation`, m, in the contact given by first and last spring of each
    /// fragment, as [`super::Solver::fragments`] and [`HandHeld::fragments`] give it.
    ///
    /// Of a run that is not a whole subtree, as no fragment in equilibrium can be, the largest whole
    /// subtrees inside it are taken. A contact that is not in equilibrium relaxes with the next move.
    ///
    /// # Errors
    /// [`HandError::NotFinite`], [`ContactError::OutOfMemory`].
    pub fn standing(
        tree: Arc<ContactTree>,
        rule: R,
        foundation: Foundation,
        indentation: f64,
        contacts: &[(usize, usize)],
    ) -> Result<Self, HandError> {
        let indentation = finite(indentation)?;
        Ok(Incremental { set: FragmentSet::new(tree, rule, contacts)?, foundation, indentation })
    }

    fn is_separated(&self) -> bool {
        self.set.tally().springs == 0
    }

    /// Σ (d − c), m, of what is in contact, were it at this indentation.
    fn compression_at(&self, indentation: f64) -> f64 {
        self.set.tally().compression(indentation, self.set.scale())
    }

    /// Indentation at which what is in contact carries this compression Σ (d − c), m.
    fn indentation_of(&self, compression: f64) -> Option<f64> {
        self.set.tally().indentation(compression, self.set.scale())
    }

    /// Lets join all that joins up to this indentation.
    fn press(&mut self, course: &mut Course, indentation: f64) {
        while let Some(joins) = self.set.joins_next().filter(|&joins| joins <= indentation) {
            // A fragment can take in nothing before it has formed.
            course.level = course.level.max(joins);
            let Some(event) = self.set.join(course.level) else { break };
            course.count(event);
        }
    }

    /// Lets go, one by one, of the most stretched springs, as long as `lets_go` says so of the indentation to
    /// which the next one is held.
    fn pull(&mut self, course: &mut Course, lets_go: impl Fn(f64) -> bool) {
        while let Some(holds) = self.set.leaves_next().filter(|&holds| lets_go(holds)) {
            // A part can let go of nothing before the whole has.
            course.level = course.level.min(holds);
            let Some(event) = self.set.leave(course.level) else { break };
            course.count(event);
        }
    }

    /// Presses until the compression Σ (d − c), m, is at least `wanted`, and returns the indentation;
    /// `None` when there is no finite one.
    fn press_to_compression(&mut self, course: &mut Course, wanted: f64) -> Option<f64> {
        // Nothing touches below d = 0.
        let mut from = if self.is_separated() { self.indentation.max(0.0) } else { self.indentation };
        self.press(course, from);
        if self.compression_at(from) >= wanted {
            return Some(from);
        }
        // Until the next spring joins, the force rises with the springs there are.
        while let Some(to) = self.set.joins_next() {
            let crossing = self.indentation_of(wanted).map(|crossing| crossing.max(from));
            if crossing.is_some_and(|crossing| crossing < to) {
                return crossing;
            }
            from = to;
            self.press(course, from);
        }
        // Everything is in contact.
        if self.compression_at(from) >= wanted {
            return Some(from);
        }
        let crossing = self.indentation_of(wanted).filter(|crossing| crossing.is_finite());
        crossing.map(|crossing| crossing.max(from))
    }

    /// Pulls until the compression Σ (d − c), m, is at most `wanted`, and returns the indentation, or the
    /// smallest compression on the way when everything lets go before.
    fn pull_to_compression(&mut self, course: &mut Course, wanted: f64) -> Result<f64, f64> {
        let mut to = self.indentation;
        let mut smallest = self.compression_at(to);
        if smallest <= wanted {
            return Ok(to);
        }
        loop {
            // Below `to` only what is held further is in contact.
            self.pull(course, |holds| holds >= to);
            let Some(from) = self.set.leaves_next() else { return Err(smallest) };
            let compression = self.compression_at(from);
            if compression <= wanted {
                let last = to.next_down().max(from);
                return Ok(self.indentation_of(wanted).unwrap_or(last).clamp(from, last));
            }
            smallest = smallest.min(compression);
            to = from;
        }
    }

    /// Presses until the force is at least this.
    fn press_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = Course::pressing(&self.set);
        let wanted = force / self.foundation.spring_stiffness();
        let to = self.press_to_compression(&mut course, wanted);
        self.indentation = to.ok_or(HandError::OutOfReach { force })?;
        Ok(self.pressed(&course))
    }

    /// Pulls until the force is at most this.
    fn pull_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = Course::pulling(&self.set, self.indentation);
        let stiffness = self.foundation.spring_stiffness();
        let to = self.pull_to_compression(&mut course, force / stiffness);
        self.indentation = to.map_err(|smallest| {
            // As a force: what the body bears at least.
            HandError::LetsGoBefore { force, smallest: stiffness * smallest }
        })?;
        Ok(self.pulled(&course))
    }

    fn pressed(&self, course: &Course) -> Move {
        // Not −0 where nothing joined with a stretch.
        let dissipated_energy = 0.0 - self.energy(course);
        Move { joins: course.springs, dissipated_energy, ..self.still(course) }
    }

    fn pulled(&self, course: &Course) -> Move {
        let dissipated_energy = self.energy(course);
        Move { leaves: course.springs, dissipated_energy, ..self.still(course) }
    }

    /// What is the same both ways.
    fn still(&self, course: &Course) -> Move {
        let touched = self.set.touched() - course.touched_before;
        Move { events: course.events, touched, ..Move::default() }
    }

    /// Energy in J of the springs that joined or left.
    fn energy(&self, course: &Course) -> f64 {
        0.5 * self.foundation.spring_stiffness() * course.squared_stretch.total()
    }
}

impl<R: EdgeRule> HandHeld for Incremental<R> {
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, HandError> {
        let from = std::mem::replace(&mut self.indentation, finite(indentation)?);
        if indentation > from || (self.is_separated() && indentation >= 0.0) {
            let mut course = Course::pressing(&self.set);
            self.press(&mut course, indentation);
            Ok(self.pressed(&course))
        } else if indentation < from {
            let mut course = Course::pulling(&self.set, from);
            self.pull(&mut course, |holds| holds > indentation);
            Ok(self.pulled(&course))
        } else {
            // Another zero is no other place.
            self.indentation = from;
            Ok(Move::default())
        }
    }

    fn move_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let force = finite(force)?;
        let here = self.point();
        let separated = self.is_separated();
        if separated && force < 0.0 {
            return Err(HandError::NothingToPull { force });
        }
        let before = self.set.tally();
        self.set.keep_journal();
        // As forces: the division by the stiffness may miss the compression the force came from.
        let moved = if separated || force > here.force {
            self.press_to_force(force)
        } else if force < here.force {
            self.pull_to_force(force)
        } else {
            Ok(Move::default())
        };
        if moved.is_err() {
            self.set.take_back(before);
        }
        self.set.drop_journal();
        moved
    }

    fn separate(&mut self) -> Move {
        let mut course = Course::pulling(&self.set, self.indentation);
        self.pull(&mut course, |_| true);
        self.indentation = course.level;
        self.pulled(&course)
    }

    fn point(&self) -> CurvePoint {
        let tally = self.set.tally();
        CurvePoint {
            indentation: self.indentation,
            force: self.foundation.spring_stiffness() * self.compression_at(self.indentation),
            contact_length: tally.springs as f64 * self.foundation.spacing,
            springs: tally.springs.unsigned_abs(),
            fragments: tally.fragments.unsigned_abs(),
        }
    }

    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_> {
        Box::new(self.set.intervals())
    }
}

/// A move while it goes on.
struct Course {
    /// Indentation of the events just now: it never goes back.
    level: f64,
    springs: u64,
    events: u64,
    squared_stretch: CompensatedSum,
    touched_before: u64,
}

impl Course {
    fn pressing<R: EdgeRule>(set: &FragmentSet<R>) -> Self {
        Course::from_level(f64::NEG_INFINITY, set)
    }

    /// Nothing leaves above where the move begins.
    fn pulling<R: EdgeRule>(set: &FragmentSet<R>, from: f64) -> Self {
        Course::from_level(from, set)
    }

    fn from_level<R: EdgeRule>(level: f64, set: &FragmentSet<R>) -> Self {
        let squared_stretch = CompensatedSum::default();
        Course { level, springs: 0, events: 0, squared_stretch, touched_before: set.touched() }
    }

    fn count(&mut self, event: Event) {
        self.springs += event.springs;
        self.events += 1;
        self.squared_stretch.add_sum(event.squared_stretch);
    }
}

pub(super) fn finite(value: f64) -> Result<f64, HandError> {
    if value.is_finite() { Ok(value) } else { Err(HandError::NotFinite { value }) }
}
