//! A body held in hand: moved by steps of any size, either way, at the cost of what changes.
//!
//! Where the exact solver asks for a whole leg when each spring joins or leaves, this one knows only what
//! happens next. A move goes from event to event: a free leaf of the tree touches, a fragment takes in the
//! spring of its parent and with it the rest of that subtree, or it lets its most stretched spring go and
//! its two parts remain. Which springs are in contact after a move follows from the same thresholds (see
//! the exact solver), so both stand in the same contact, bit for bit.
//!
//! How a move goes is the same for whole springs and for edges between them; what they carry between two
//! events is the law of their contact.

use super::fragment_set::{Event, FragmentSet};
use super::law::Standing;
use super::{ContactError, CurvePoint, EdgeRule, Foundation};
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

/// What a body in hand asks of its springs, whichever way the force of a fragment is read.
pub trait HandContact {
    /// The rule for the edges.
    type Rule: EdgeRule;
    /// What a move notes for the energy that it loses.
    type Notes;

    /// What is in contact.
    fn set(&self) -> &FragmentSet<Self::Rule>;

    /// What is in contact, to be changed.
    fn set_mut(&mut self) -> &mut FragmentSet<Self::Rule>;

    /// What is in contact, were it at this indentation.
    fn standing_at(&self, indentation: f64) -> Standing;

    /// A move begins at an indentation.
    fn begin(&self, from: f64) -> Self::Notes;

    /// Lets join what joins next, at indentation `level`.
    fn join(&mut self, level: f64, notes: &mut Self::Notes) -> Option<Event>;

    /// Lets the next spring leave, at indentation `level`.
    fn leave(&mut self, level: f64, notes: &mut Self::Notes) -> Option<Event>;

    /// A move ends: ½ the stiffness of a spring times this is the energy of what has joined or left, and so many
    /// entries were looked at for it.
    fn end(&self, notes: Self::Notes, at: f64) -> (f64, u64);

    /// The smallest indentation between two, neither of them passed by an event, at which the compression is at
    /// least `wanted`; at the lower one it is less.
    fn rises_to(&self, between: (f64, f64), wanted: f64) -> Option<f64>;

    /// The largest indentation between two, from which nothing leaves above the lower one, at which the
    /// compression is at most `wanted`, or the smallest compression there; at the higher one it is more.
    fn falls_to(&self, between: (f64, f64), wanted: f64) -> Result<f64, f64>;

    /// The indentation beyond `from`, where everything is in contact, with this compression.
    fn beyond(&self, from: f64, wanted: f64) -> f64;
}

/// A body on its foundation, held in hand.
pub struct Hand<C> {
    contact: C,
    foundation: Foundation,
    indentation: f64,
}

impl<C: HandContact> Hand<C> {
    /// A body at d = 0.
    pub(super) fn touching(contact: C, foundation: Foundation) -> Self {
        Hand { contact, foundation, indentation: 0.0 }
    }

    /// A body that stands at an indentation, m, if that is one.
    pub(super) fn standing_at(
        indentation: f64,
        foundation: Foundation,
        contact: impl FnOnce() -> Result<C, ContactError>,
    ) -> Result<Self, HandError> {
        let indentation = finite(indentation)?;
        Ok(Hand { contact: contact()?, foundation, indentation })
    }

    fn is_separated(&self) -> bool {
        self.contact.set().tally().springs == 0
    }

    fn compression_at(&self, indentation: f64) -> f64 {
        self.contact.standing_at(indentation).compression
    }

    fn begin(&self, presses: bool) -> Course<C::Notes> {
        Course {
            presses,
            level: self.indentation,
            springs: 0,
            events: 0,
            touched_before: self.contact.set().touched(),
            notes: self.contact.begin(self.indentation),
        }
    }

    /// Lets join all that joins up to this indentation.
    fn press(&mut self, course: &mut Course<C::Notes>, indentation: f64) {
        while let Some(joins) = self.contact.set().joins_next().filter(|&joins| joins <= indentation) {
            // A fragment can take in nothing before it has formed.
            course.level = course.level.max(joins);
            let Some(event) = self.contact.join(course.level, &mut course.notes) else { break };
            course.count(event);
        }
    }

    /// Lets go, one by one, of the most stretched springs, as long as `lets_go` says so of the indentation to
    /// which the next one is held.
    fn pull(&mut self, course: &mut Course<C::Notes>, lets_go: impl Fn(f64) -> bool) {
        while let Some(holds) = self.contact.set().leaves_next().filter(|&holds| lets_go(holds)) {
            // A part can let go of nothing before the whole has.
            course.level = course.level.min(holds);
            let Some(event) = self.contact.leave(course.level, &mut course.notes) else { break };
            course.count(event);
        }
    }

    /// Presses until the compression ∫ (d − c) dx is at least `wanted`, and returns the indentation; `None`
    /// when there is no finite one.
    fn press_to_compression(&mut self, course: &mut Course<C::Notes>, wanted: f64) -> Option<f64> {
        // Nothing touches below d = 0.
        let mut from = if self.is_separated() { self.indentation.max(0.0) } else { self.indentation };
        self.press(course, from);
        loop {
            if self.compression_at(from) >= wanted {
                return Some(from);
            }
            let Some(to) = self.contact.set().joins_next() else { break };
            if let Some(found) = self.contact.rises_to((from, to), wanted) {
                if found < to {
                    return Some(found);
                }
                self.press(course, to);
                return Some(if self.compression_at(to) >= wanted { to } else { to.next_down() });
            }
            from = to;
            self.press(course, from);
        }
        // Everything is in contact.
        Some(self.contact.beyond(from, wanted)).filter(|indentation| indentation.is_finite())
    }

    /// Pulls until the compression ∫ (d − c) dx is at most `wanted`, and returns the indentation, or the
    /// smallest compression on the way when everything lets go before.
    fn pull_to_compression(&mut self, course: &mut Course<C::Notes>, wanted: f64) -> Result<f64, f64> {
        let mut to = self.indentation;
        let mut smallest = self.compression_at(to);
        if smallest <= wanted {
            return Ok(to);
        }
        loop {
            // Below `to` only what is held further is in contact.
            self.pull(course, |holds| holds >= to);
            let Some(from) = self.contact.set().leaves_next() else { return Err(smallest) };
            match self.contact.falls_to((from, to.next_down().max(from)), wanted) {
                Ok(found) => return Ok(found),
                Err(compression) => smallest = smallest.min(compression),
            }
            to = from;
        }
    }

    /// Presses until the force is at least this.
    fn press_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = self.begin(true);
        let wanted = force / self.foundation.spring_stiffness();
        let to = self.press_to_compression(&mut course, wanted).ok_or(HandError::OutOfReach { force })?;
        Ok(self.settle(course, to))
    }

    /// Pulls until the force is at most this.
    fn pull_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = self.begin(false);
        let stiffness = self.foundation.spring_stiffness();
        let to = self.pull_to_compression(&mut course, force / stiffness);
        // As a force: what the body bears at least.
        let to = to.map_err(|smallest| HandError::LetsGoBefore { force, smallest: stiffness * smallest })?;
        Ok(self.settle(course, to))
    }

    /// Ends a move at an indentation.
    fn settle(&mut self, course: Course<C::Notes>, indentation: f64) -> Move {
        self.indentation = indentation;
        let (squared_stretch, looked_at) = self.contact.end(course.notes, indentation);
        let energy = 0.5 * self.foundation.spring_stiffness() * squared_stretch;
        let (joins, leaves, dissipated_energy) = if course.presses {
            // Not −0 where nothing joined with a stretch.
            (course.springs, 0, 0.0 - energy)
        } else {
            (0, course.springs, energy)
        };
        let touched = self.contact.set().touched() - course.touched_before + looked_at;
        Move { joins, leaves, events: course.events, touched, dissipated_energy }
    }
}

impl<C: HandContact> HandHeld for Hand<C> {
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, HandError> {
        let indentation = finite(indentation)?;
        if indentation > self.indentation || (self.is_separated() && indentation >= 0.0) {
            let mut course = self.begin(true);
            self.press(&mut course, indentation);
            Ok(self.settle(course, indentation))
        } else if indentation < self.indentation {
            let mut course = self.begin(false);
            self.pull(&mut course, |holds| holds > indentation);
            Ok(self.settle(course, indentation))
        } else {
            // Another zero is no other place.
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
        let before = self.contact.set().tally();
        self.contact.set_mut().keep_journal();
        // As forces: the division by the stiffness may miss the compression the force came from.
        let moved = if separated || force > here.force {
            self.press_to_force(force)
        } else if force < here.force {
            self.pull_to_force(force)
        } else {
            Ok(Move::default())
        };
        if moved.is_err() {
            self.contact.set_mut().take_back(before);
        }
        self.contact.set_mut().drop_journal();
        moved
    }

    fn separate(&mut self) -> Move {
        let mut course = self.begin(false);
        self.pull(&mut course, |_| true);
        let end = course.level;
        self.settle(course, end)
    }

    fn point(&self) -> CurvePoint {
        self.contact.standing_at(self.indentation).point(self.foundation)
    }

    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_> {
        Box::new(self.contact.set().intervals())
    }
}

/// A move while it goes on.
struct Course<N> {
    presses: bool,
    /// Indentation of the events just now: it never goes back.
    level: f64,
    springs: u64,
    events: u64,
    touched_before: u64,
    notes: N,
}

impl<N> Course<N> {
    fn count(&mut self, event: Event) {
        self.springs += event.springs;
        self.events += 1;
    }
}

fn finite(value: f64) -> Result<f64, HandError> {
    if value.is_finite() { Ok(value) } else { Err(HandError::NotFinite { value }) }
}
