//! One leg: the contact at all indentations of a motion in one direction.

use super::ContactError;
use super::adhesive::Runs;
use super::adhesive::levels::Edges;
use super::adhesive::levels::{EdgeCells, Levels, Slider, Span};
use super::adhesive::loading::Closing;
use super::adhesive::run::{Ground, Held, Run};
use super::adhesive::tree::ContactTree;
use super::contact_state::ContactState;
use super::history::{Direction, Patch, Work};
use super::springs::Contact;
use super::totals::ContactTotals;
use std::sync::Arc;

/// Contact at all indentations of a motion in one direction.
///
/// A leg is a value: it stays valid after the body has moved on, and its copies share their memory.
#[derive(Clone, Debug)]
pub struct Leg {
    contact: Contact,
    direction: Direction,
    patches: Patches,
    end: f64,
    /// Springs of the instrument beside the contact in searches; see [`ContactState::beside`].
    instrument: f64,
    /// Evaluations of the rule of Hess that its patches took.
    pub(super) evaluations: u64,
}

#[derive(Clone, Debug)]
enum Patches {
    /// Each spring touches at a threshold, m: without adhesion at its gap. Empty where nothing touches.
    Springs(Arc<Vec<f64>>),
    /// The patches of an adhesive contact, each as long as its edges move without a jump.
    Runs(Arc<ContactTree>, Arc<Vec<Run>>),
}

/// Length, load and stretch of one patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchState {
    /// Length, m.
    pub length: f64,
    /// Force, N.
    pub force: f64,
    /// Largest stretch Δl_max at this length, m, eq. (10).
    pub largest_stretch: f64,
    /// Stretch of its edges, or of its most stretched spring, m.
    pub most_stretched: f64,
}

/// Evaluates an expression with the runs of a leg, under the edge model of its contact.
macro_rules! along_runs {
    ($leg:expr, $tree:expr, $runs:expr, $along:ident => $value:expr) => {
        match $leg.contact.edges {
            Edges::Grid => {
                let $along = $leg.along::<false>($tree, $runs);
                $value
            }
            Edges::SubCell => {
                let $along = $leg.along::<true>($tree, $runs);
                $value
            }
        }
    };
}

pub(crate) mod forces;

impl Leg {
    /// Counts the passes of the leg and, with adhesion, its evaluations of the rule of Hess.
    pub(super) fn count(&self, work: &mut Work) {
        let contact = self.contact();
        if contact.has_adhesion()
            && let Ok(tree) = contact.springs.tree(contact.edges)
        {
            work.tree_nodes = tree.node_count() as u64;
            match self.direction() {
                Direction::Loading => work.loading_passes += 1,
                Direction::Unloading => work.unloading_passes += 1,
            }
            work.hess_evaluations += self.evaluations;
        }
    }

    /// Creates the leg of a body that touches nothing.
    pub fn apart(contact: &Contact, direction: Direction) -> Self {
        Leg {
            contact: contact.clone(),
            direction,
            patches: Patches::Springs(Arc::default()),
            end: 0.0,
            instrument: 0.0,
            evaluations: 0,
        }
    }

    /// Creates a leg on which each spring touches at a threshold, m, −∞ always, +∞ never, known up to the indentation
    /// `end`, m.
    pub(super) fn of_thresholds(
        contact: &Contact,
        direction: Direction,
        end: f64,
        thresholds: Vec<f64>,
    ) -> Self {
        let patches = Patches::Springs(Arc::new(thresholds));
        // The stepwise solver moves whole springs.
        let Contact { springs, foundation, hess, .. } = contact.clone();
        let contact = Contact::of(springs, Edges::Grid, foundation, hess);
        Leg { patches, end, ..Leg::apart(&contact, direction) }
    }

    fn without_adhesion(contact: &Contact, direction: Direction) -> Self {
        let patches = Patches::Springs(Arc::clone(&contact.springs.gaps));
        let end = if direction == Direction::Loading { contact.springs.deepest() } else { 0.0 };
        Leg { patches, end, ..Leg::apart(contact, direction) }
    }

    /// Starts a loading from separation.
    pub fn approach(contact: &Contact) -> Result<Self, ContactError> {
        if contact.hess.is_none() {
            return Ok(Leg::without_adhesion(contact, Direction::Loading));
        }
        let tree = contact.springs.tree(contact.edges)?;
        Leg::apart(contact, Direction::Loading).list(tree, &[], f64::NEG_INFINITY)
    }

    /// Starts the motion in the opposite direction at an indentation of this leg, m.
    ///
    /// # Errors
    /// [`ContactError::Stepwise`], [`ContactError::OutOfMemory`].
    pub fn turn(&self, at: f64) -> Result<Self, ContactError> {
        let direction = match self.direction {
            Direction::Loading => Direction::Unloading,
            Direction::Unloading => Direction::Loading,
        };
        self.refuse_stepwise()?;
        match &self.patches {
            Patches::Springs(_) => Ok(Leg::without_adhesion(&self.contact, direction)),
            Patches::Runs(tree, runs) => {
                let held: Vec<Held> =
                    along_runs!(self, tree, runs, along => along.held_at(at, self.pins()).collect());
                Leg::apart(&self.contact, direction).list(tree, &held, at)
            }
        }
    }

    /// Lists the runs of this leg from the patches in contact at an indentation, m.
    fn list(self, tree: &Arc<ContactTree>, held: &[Held], from: f64) -> Result<Self, ContactError> {
        let mut evaluations = 0;
        let listed = along_runs!(self, tree, &[], along => match self.direction {
            Direction::Loading => {
                let closing = self.contact.closing(|| {
                    let closing = Closing::new(&along.ground)?;
                    evaluations = closing.evaluations;
                    Ok(closing)
                });
                closing?.list(&along.ground, held)?
            }
            Direction::Unloading => along.ground.open(held, from)?,
        });
        evaluations += listed.evaluations;
        let patches = Patches::Runs(Arc::clone(tree), Arc::new(listed.runs));
        Ok(Leg { patches, end: listed.end, evaluations, ..self })
    }

    fn is_stepwise(&self) -> bool {
        matches!(&self.patches, Patches::Springs(thresholds) if self.contact.hess.is_some() && !thresholds.is_empty())
    }

    /// Refuses a leg of the stepwise solver, which is known at its steps alone.
    pub(super) fn refuse_stepwise(&self) -> Result<(), ContactError> {
        if self.is_stepwise() { Err(ContactError::Stepwise) } else { Ok(()) }
    }

    /// Contact of which this is a leg.
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// Direction of the motion.
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Smallest indentation of full contact of a loading, or the smallest one with contact of an unloading, m; of the
    /// stepwise solver, the indentation that it has reached.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Bytes of its own.
    pub fn bytes(&self) -> usize {
        match &self.patches {
            Patches::Springs(thresholds) if self.is_stepwise() => size_of::<f64>() * thresholds.capacity(),
            Patches::Springs(_) => 0,
            Patches::Runs(_, runs) => size_of::<Run>() * runs.capacity(),
        }
    }

    /// Returns the patches in contact at an indentation, m, from left to right.
    pub fn patches(&self, indentation: f64) -> Vec<Patch> {
        match &self.patches {
            Patches::Springs(thresholds) => {
                Patch::of_springs(thresholds.iter().map(|&threshold| threshold <= indentation))
            }
            Patches::Runs(tree, runs) => {
                let patch = |held: Held| Patch { first: held.first as usize, last: held.last as usize };
                along_runs!(self, tree, runs, along => along.held_at(indentation, false).map(patch).collect())
            }
        }
    }

    /// Returns the indentations in a range, m, at which the force of an adhesive contact jumps by about this force or more, N:
    /// where patches grow or shrink at once, merge or part. Ascending.
    pub fn jumps(&self, low: f64, high: f64, least: f64) -> Vec<f64> {
        let Patches::Runs(_, runs) = &self.patches else { return Vec::new() };
        let springs = |[first, last]: [u32; 2]| f64::from(last - first + 1);
        let ends = runs.iter().flat_map(|run| [(run.from, springs(run.bottom)), (run.to, -springs(run.top))]);
        let mut events: Vec<(f64, f64)> = ends.filter(|(at, _)| low < *at && *at <= high).collect();
        events.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
        // The springs that attach or detach are stretched by about s √n.
        let stretch = self.contact.rule().stretch(self.direction);
        let jump = |events: &[(f64, f64)]| {
            let most = events.iter().fold(0.0_f64, |most, event| most.max(event.1.abs()));
            let change: f64 = events.iter().map(|event| event.1).sum();
            self.contact.foundation.spring_stiffness() * stretch * most.sqrt() * change.abs()
        };
        let together = events.chunk_by(|one, next| one.0 == next.0);
        together.filter(|events| jump(events) >= least).map(|events| events[0].0).collect()
    }

    /// Returns the smallest indentation at which each spring along the line is in contact, m: −∞ always, +∞ never.
    pub fn thresholds(&self) -> Vec<f64> {
        match &self.patches {
            Patches::Springs(thresholds) if thresholds.is_empty() => {
                vec![f64::INFINITY; self.contact.gaps().len()]
            }
            Patches::Springs(thresholds) => thresholds.to_vec(),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, along => along.thresholds()),
        }
    }

    /// Evaluates the patch of this number, from the left, at an indentation, m; `None` without such a patch.
    pub fn patch_state(&self, indentation: f64, number: usize) -> Option<PatchState> {
        let Contact { springs, foundation, edges, .. } = &self.contact;
        let patch = *self.patches(indentation).get(number)?;
        let (rule, gaps, scale) = (self.contact.rule(), springs.gaps(), springs.scale());
        let slides = *edges == Edges::SubCell;
        let stretch = rule.stretch(self.direction);
        let Patch { first, last } = patch;
        let span = Span { gap: gaps[patch.springs()].iter().copied().fold(0.0, f64::max), first, last };
        let pin = match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along.held_at(indentation, self.pins()).nth(number)?.pin)
            }
            _ => None,
        };
        let totals = ContactTotals::of_patch(&gaps[patch.springs()], slides, scale);
        let cells = || Slider::new(gaps, &span, stretch, pin).edge_cells(indentation);
        let cells = if slides { cells() } else { EdgeCells::default() };
        let state = ContactState::new(slides, indentation, totals, cells, &scale);
        let free =
            || if slides { Levels::between_springs(gaps, &span).0.rise(stretch, indentation) } else { 0.0 };
        let point = state.point(*foundation);
        Some(PatchState {
            length: point.contact_length,
            force: point.force,
            largest_stretch: rule.stretch(Direction::Unloading) * state.length.sqrt(),
            most_stretched: span.gap + pin.unwrap_or_else(free) - indentation,
        })
    }

    /// Returns true where the edges of patches keep their place at first when the direction turns, since the rules of
    /// loading and of unloading differ. Between springs alone an edge has a place of its own to keep.
    fn pins(&self) -> bool {
        self.contact.edges == Edges::SubCell && !self.contact.rule().is_one()
    }

    fn along<'a, const SLIDES: bool>(&'a self, tree: &'a ContactTree, runs: &'a [Run]) -> Runs<'a, SLIDES> {
        let ground = Ground {
            gaps: self.contact.gaps(),
            tree,
            stretch: self.contact.rule().stretch(self.direction),
            unloading: self.direction == Direction::Unloading,
        };
        Runs { ground, runs }
    }
}
