//! A stage: the contact at all indentations of a motion in one direction.

use super::adhesive::Runs;
use super::adhesive::levels::{EdgeCell, EdgeCells, Edges, Slider, Span};
use super::adhesive::loading::Closing;
use super::adhesive::run::{Ground, HeldPatch, Run};
use super::adhesive::tree::ContactTree;
use super::contact::Contact;
use super::contact_state::ContactState;
use super::detachment::{ContactRule, DetachmentRule, Levels};
use super::error::ContactError;
use super::history::{Direction, Patch, Work};
use super::totals::ContactTotals;
use std::sync::Arc;

/// A motion of a contact in one direction. A stage gives the springs in contact, the force and the
/// energy at each indentation of the motion.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Profile};
/// use asperity_contact::motion::Stage;
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// // Approach, and turn at an indentation of 100 nm: in one piece the contact returns along the
/// // same curve.
/// let loading = Stage::approach(&contact)?;
/// let unloading = loading.turn(1.0e-7)?;
/// let [up, down] = [loading.point(0.5e-7)?, unloading.point(0.5e-7)?];
/// assert!((up.force - down.force).abs() <= 1e-12 * up.force.abs());
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stage {
    contact: Contact,
    direction: Direction,
    patches: Patches,
    end: f64,
    /// Number of springs parallel to the contact that represent the instrument in searches;
    /// otherwise zero. See [`ContactState::beside`].
    instrument: f64,
    /// Number of evaluations of the rule of Hess that were needed to find the patches.
    pub(super) evaluations: u64,
}

#[derive(Clone, Debug)]
enum Patches {
    /// Smallest indentation in m at which each spring is in contact; without adhesion it is the gap
    /// of the spring. Empty if nothing touches.
    Springs(Arc<Vec<f64>>),
    /// Patches of an adhesive contact as runs. A run is a patch over a range of indentations in
    /// which its edges do not jump.
    Runs(Arc<ContactTree>, Arc<Vec<Run>>),
}

/// State of one contact patch at one indentation: its position, length, force and stretch.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// let profile = Profile::from_heights(vec![0.0, -9.0e-8, -1.0e-8], 1.0e-6)?;
/// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).build()?;
/// let patches = contact.load(&[Move::ToIndentation(2.0e-8)])?.patches();
/// // Two patches: the left one ends between its spring and the deep one.
/// assert_eq!((patches.len(), patches[0].springs.first, patches[1].springs.first), (2, 0, 2));
/// let [left, right] = patches[0].edges;
/// assert!(left == 0.0 && 0.5e-6 < right && right < 1.5e-6);
/// assert!((right - left - patches[0].length).abs() < 1e-20);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PatchState {
    /// First and last spring of the patch.
    pub springs: Patch,
    /// Positions of the left and the right edge in m, from the left end of the foundation.
    pub edges: [f64; 2],
    /// Length ℓ of the patch in m.
    pub length: f64,
    /// Force in N of the springs of the patch; compression is positive.
    pub force: f64,
    /// Largest stretch Δl_max in m that a patch of this length bears, eq. (10) of Popov and
    /// Filippov (2012).
    pub largest_stretch: f64,
    /// Stretch in m of the most stretched part of the patch. With [`Edges::SubCell`] the most
    /// stretched parts are the edges of the patch. With [`Edges::Grid`] it is the most stretched
    /// spring.
    pub most_stretched: f64,
}

/// A patch whose edges may be pinned. If they are pinned, `pin` is their height in m above the
/// largest gap of the patch.
#[derive(Clone, Copy)]
struct PinnedPatch {
    springs: Patch,
    pin: Option<f64>,
}

/// Evaluates an expression with the runs of a stage, the patches over ranges of indentations in
/// which their edges do not jump. The place where edges may lie becomes a constant of the compiled
/// code.
macro_rules! along_runs {
    ($stage:expr, $tree:expr, $runs:expr, $along:ident => $value:expr) => {
        match $stage.contact.edges {
            Edges::Grid => {
                let $along = $stage.along::<false>($tree, $runs);
                $value
            }
            Edges::SubCell => {
                let $along = $stage.along::<true>($tree, $runs);
                $value
            }
        }
    };
}

pub(crate) mod forces;
pub(crate) mod jumps;

impl Stage {
    /// Adds the computing work for this stage to the counts in `work`: the pass over the contact
    /// tree and the evaluations of the rule of Hess.
    pub(super) fn count(&self, work: &mut Work) {
        let contact = self.contact();
        if contact.has_adhesion()
            && let Ok(tree) = contact.profile.springs.tree(contact.edges)
        {
            work.tree_nodes = tree.node_count() as u64;
            match self.direction() {
                Direction::Loading => work.loading_passes += 1,
                Direction::Unloading => work.unloading_passes += 1,
            }
            work.hess_evaluations += self.evaluations;
        }
    }

    /// Creates a motion in which the body touches no spring.
    pub fn apart(contact: &Contact, direction: Direction) -> Self {
        Stage {
            contact: contact.clone(),
            direction,
            patches: Patches::Springs(Arc::default()),
            end: 0.0,
            instrument: 0.0,
            evaluations: 0,
        }
    }

    /// Creates a stage on which each spring has a threshold: the smallest indentation in m at which
    /// the spring is in contact. The threshold is −∞ for a spring that is always in contact, and +∞
    /// for a spring that is never in contact. The stage is known up to the indentation `end` in m.
    pub(super) fn of_thresholds(
        contact: &Contact,
        direction: Direction,
        end: f64,
        thresholds: Vec<f64>,
    ) -> Self {
        Stage {
            patches: Patches::Springs(Arc::new(thresholds)),
            end,
            ..Stage::apart(&contact.of_whole_springs(), direction)
        }
    }

    fn without_adhesion(contact: &Contact, direction: Direction) -> Self {
        let end = match direction {
            Direction::Loading => contact.profile.deepest(),
            Direction::Unloading => 0.0,
        };
        Stage {
            patches: Patches::Springs(Arc::clone(&contact.profile.springs.gaps)),
            end,
            ..Stage::apart(contact, direction)
        }
    }

    /// Computes the loading that begins with a separated body.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn approach(contact: &Contact) -> Result<Self, ContactError> {
        if !contact.has_adhesion() {
            return Ok(Stage::without_adhesion(contact, Direction::Loading));
        }
        let tree = contact.profile.springs.tree(contact.edges)?;
        Stage::apart(contact, Direction::Loading).list(tree, &[], f64::NEG_INFINITY)
    }

    /// Computes the motion in the opposite direction. The new motion begins at `indentation` in m,
    /// at which this motion turns.
    ///
    /// # Errors
    /// Returns [`ContactError::Stepwise`] if this motion was computed by the [stepwise
    /// solver](crate::motion::Stepwise).
    pub fn turn(&self, indentation: f64) -> Result<Self, ContactError> {
        let direction = match self.direction {
            Direction::Loading => Direction::Unloading,
            Direction::Unloading => Direction::Loading,
        };
        self.refuse_stepwise()?;
        match &self.patches {
            Patches::Springs(_) => Ok(Stage::without_adhesion(&self.contact, direction)),
            Patches::Runs(tree, runs) => {
                let held: Vec<HeldPatch> = along_runs!(self, tree, runs, along => along
                    .held_at(indentation, self.pins())
                    .collect());
                Stage::apart(&self.contact, direction).list(tree, &held, indentation)
            }
        }
    }

    /// Lists the runs of this stage. `held` are the patches in contact where the stage begins, at
    /// the indentation `from` in m.
    fn list(
        self,
        tree: &Arc<ContactTree>,
        held: &[HeldPatch],
        from: f64,
    ) -> Result<Self, ContactError> {
        let mut evaluations_of_closing = 0;
        let listed = along_runs!(self, tree, &[], along => match self.direction {
            Direction::Loading => {
                let closing = self.contact.closing(|| {
                    let closing = Closing::new(&along.ground)?;
                    evaluations_of_closing = closing.evaluations;
                    Ok(closing)
                });
                closing?.list(&along.ground, held)?
            }
            Direction::Unloading => along.ground.open(held, from)?,
        });
        Ok(Stage {
            patches: Patches::Runs(Arc::clone(tree), Arc::new(listed.runs)),
            end: listed.end,
            evaluations: evaluations_of_closing + listed.evaluations,
            ..self
        })
    }

    fn is_stepwise(&self) -> bool {
        let Patches::Springs(thresholds) = &self.patches else {
            return false;
        };
        self.contact.has_adhesion() && !thresholds.is_empty()
    }

    /// Returns an error if the stage belongs to the stepwise solver, because such a stage is known
    /// only at its steps.
    pub(super) fn refuse_stepwise(&self) -> Result<(), ContactError> {
        if self.is_stepwise() {
            Err(ContactError::Stepwise)
        } else {
            Ok(())
        }
    }

    /// Returns the contact whose motion this stage describes.
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// Returns the direction of the motion: loading or unloading.
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Returns the indentation in m beyond which the contact does not change further on this
    /// motion:
    ///
    /// * on loading, the smallest indentation with all springs in contact;
    /// * on unloading, the smallest indentation with any spring in contact;
    /// * for a stage of the stepwise solver, the indentation that the solver has reached.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Returns the memory in bytes that this motion uses, without the memory of its contact.
    pub fn bytes(&self) -> usize {
        match &self.patches {
            Patches::Springs(thresholds) if self.is_stepwise() => {
                size_of::<f64>() * thresholds.capacity()
            }
            Patches::Springs(_) => 0,
            Patches::Runs(_, runs) => size_of::<Run>() * runs.capacity(),
        }
    }

    /// Returns the patches in contact at an indentation in m, from left to right.
    pub fn patches(&self, indentation: f64) -> Vec<Patch> {
        match &self.patches {
            Patches::Springs(thresholds) => {
                Patch::of_springs(thresholds.iter().map(|&threshold| threshold <= indentation))
            }
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along
                    .held_at(indentation, false)
                    .map(|held| held.springs())
                    .collect())
            }
        }
    }

    /// Returns true if an outermost spring of the profile is in contact at an indentation in m.
    pub fn reaches_ends(&self, indentation: f64) -> bool {
        match &self.patches {
            Patches::Springs(thresholds) => {
                let outermost = [thresholds.first(), thresholds.last()];
                outermost
                    .into_iter()
                    .flatten()
                    .any(|&threshold| threshold <= indentation)
            }
            Patches::Runs(tree, runs) => {
                let last_spring = self.contact.gaps().len() - 1;
                let outermost =
                    along_runs!(self, tree, runs, along => along.outermost(indentation));
                outermost.is_some_and(|[leftmost, rightmost]| {
                    leftmost.first == 0 || rightmost.last == last_spring
                })
            }
        }
    }

    /// Returns one indentation in m for each spring of the profile: the smallest indentation at
    /// which the spring is in contact. It is −∞ for a spring that is always in contact, and +∞ for
    /// a spring that is never in contact.
    pub fn thresholds(&self) -> Vec<f64> {
        match &self.patches {
            Patches::Springs(thresholds) if thresholds.is_empty() => {
                vec![f64::INFINITY; self.contact.gaps().len()]
            }
            Patches::Springs(thresholds) => thresholds.to_vec(),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, along => along.thresholds()),
        }
    }

    /// Computes the state of one patch at an indentation in m. `number` is the index of the patch,
    /// counted from the left, from 0. Returns `None` if no patch has this index.
    pub fn patch_state(&self, indentation: f64, number: usize) -> Option<PatchState> {
        self.pinned_patches(indentation)
            .get(number)
            .map(|patch| self.state_of(patch, indentation))
    }

    /// Computes the states of all patches in contact at an indentation in m, from left to right.
    pub fn patch_states(&self, indentation: f64) -> Vec<PatchState> {
        let patches = self.pinned_patches(indentation);
        patches
            .iter()
            .map(|patch| self.state_of(patch, indentation))
            .collect()
    }

    /// Returns the patches in contact at an indentation in m, from left to right.
    fn pinned_patches(&self, indentation: f64) -> Vec<PinnedPatch> {
        match &self.patches {
            Patches::Springs(_) => {
                let patches = self.patches(indentation).into_iter();
                patches
                    .map(|springs| PinnedPatch { springs, pin: None })
                    .collect()
            }
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along
                    .held_at(indentation, self.pins())
                    .map(|held| PinnedPatch { springs: held.springs(), pin: held.pin })
                    .collect())
            }
        }
    }

    fn state_of(&self, patch: &PinnedPatch, indentation: f64) -> PatchState {
        let contact = &self.contact;
        let gaps = contact.gaps();
        let scale = contact.profile.springs.scale();
        let slides = contact.edges == Edges::SubCell;
        let rule = self.rule();
        let springs = patch.springs;
        let gaps_of_patch = &gaps[springs.springs()];
        let span = Span {
            gap: gaps_of_patch.iter().copied().fold(0.0, f64::max),
            first: springs.first,
            last: springs.last,
        };

        let totals = ContactTotals::of_patch(gaps_of_patch, slides, scale);
        let mut edge_cells = EdgeCells::default();
        let mut rise = 0.0;
        if slides {
            let slider = Slider::new(gaps, &span, rule, patch.pin);
            edge_cells = slider.edge_cells(indentation);
            let (levels, _) = Levels::between_springs(gaps, &span);
            rise = levels.rise(rule, indentation);
        }
        let level = span.gap + patch.pin.unwrap_or(rise);
        let [left_share, right_share] = if slides {
            EdgeCell::of_span(gaps, &span, level).map(|cell| cell.share)
        } else {
            [0.5; 2]
        };
        let left_edge = springs.first as f64 + 0.5 - left_share;
        let right_edge = springs.last as f64 + 0.5 + right_share;

        let state = ContactState::new(slides, indentation, totals, edge_cells, &scale);
        let point = state.point(contact);
        let opening = contact.rules().rule(Direction::Unloading);
        PatchState {
            springs,
            edges: [left_edge, right_edge].map(|edge| contact.profile.place(edge)),
            length: point.contact_length,
            force: point.force,
            largest_stretch: opening.largest_stretch(state.length),
            most_stretched: level - indentation,
        }
    }

    /// Returns true if the edges of patches stay in place at first when the direction changes. They
    /// do so if the rules of loading and unloading differ and edges lie between springs.
    fn pins(&self) -> bool {
        self.contact.edges == Edges::SubCell && !self.contact.rules().is_one()
    }

    /// Returns the rule that limits the stretch of springs in the direction of this motion.
    fn rule(&self) -> ContactRule {
        self.contact.rules().rule(self.direction)
    }

    fn along<'a, const SLIDES: bool>(
        &'a self,
        tree: &'a ContactTree,
        runs: &'a [Run],
    ) -> Runs<'a, SLIDES, ContactRule> {
        let ground = Ground {
            gaps: self.contact.gaps(),
            tree,
            rule: self.rule(),
            unloading: self.direction == Direction::Unloading,
        };
        Runs { ground, runs }
    }
}
