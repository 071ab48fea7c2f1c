//! Loading histories: the records of motions with their force curves, the contact patches, the
//! counts of computing work, and the plan of a motion to a target.

use super::error::{ContactError, LARGEST, check};
use super::relaxation::law::Relaxation;
use super::target::Move;
#[cfg(feature = "serde")]
use serde::Serialize;
use std::cmp::Ordering;
use std::ops::Range;

/// Record of one loading stage: the force curve, the extremes of the force and the energies. A
/// loading stage is the motion of a body to one target.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// let [loading, unloading] = cycle.stages() else { panic!("two stages") };
/// assert_eq!(loading.attached, unloading.detached);
/// // The work of adhesion is gained on the way in, and more than that is paid on the way out.
/// assert!(loading.released_energy < 0.0 && unloading.released_energy > -loading.released_energy);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StageRecord {
    /// Target of the motion.
    pub target: Move,
    /// Direction of the motion. It is `Loading` for a stage in which the body stays in place.
    pub direction: Direction,
    /// Points of the force curve, in the order of the motion. A jump into or out of contact has two
    /// points, before and after the jump.
    pub curve: Vec<CurvePoint>,
    /// Point of the largest force on loading, exact to rounding. On unloading it is the first point
    /// of the motion.
    pub largest: CurvePoint,
    /// Point of the smallest force of the motion. On unloading this force is exact to rounding. On
    /// loading it is the smallest force in `curve`.
    pub smallest: CurvePoint,
    /// Number of springs that attached in this stage.
    pub attached: u64,
    /// Number of springs that detached in this stage.
    pub detached: u64,
    /// Energy in J that springs lose when they attach or detach with a stretch: the elastic energy
    /// released on detaching minus the elastic energy gained on attaching. For a closed loop, the
    /// sum over all stages is the dissipated energy.
    pub released_energy: f64,
    /// Energy in J lost where the body jumps because the instrument that moves it is compliant. The
    /// sum of `released_energy` and `jump_energy` over all stages is the loop area ∮F dD of the
    /// history. If a jump begins in one stage and continues in the next stage of the same
    /// direction, each of the two stages has its own part of the energy.
    pub jump_energy: f64,
    /// Energy in J that the foundation dissipates because it relaxes. Zero without
    /// [relaxation](crate::Relaxation).
    pub dashpot_energy: f64,
    /// Time in s since first touch at each point of `curve`. Empty without
    /// [relaxation](crate::Relaxation), because time then has no effect.
    pub seconds: Vec<f64>,
    /// True if an outermost spring of the profile was in contact at any moment of the motion.
    pub reaches_ends: bool,
    /// Point of the smallest force that a further unloading to separation would reach. It is
    /// computed only if this motion is an unloading that ends in contact. `None` for any other
    /// motion, and if the force is not known.
    pub smallest_of_rest: Option<CurvePoint>,
}

/// Target and direction of a motion, and the points before and after it.
pub(super) struct Passage {
    pub target: Move,
    pub direction: Direction,
    pub before: CurvePoint,
    pub after: CurvePoint,
}

/// Points of the smallest and of the largest force of a motion.
pub(super) struct Extremes {
    pub smallest: CurvePoint,
    pub largest: CurvePoint,
}

impl StageRecord {
    /// Largest number of points that [`StageRecord::curve`] has besides its regularly spaced
    /// points: the point of the smallest force, the point at which an instrument loses the contact,
    /// and two points of a jump at the beginning or the end of the motion.
    pub const FURTHER_POINTS: usize = 4;

    /// Returns the times in s since first touch at which the motion begins and ends; `None` without
    /// [relaxation](crate::Relaxation), because time then has no effect.
    pub fn times(&self) -> Option<[f64; 2]> {
        Some([*self.seconds.first()?, *self.seconds.last()?])
    }

    /// Returns the point at a time in s since first touch, by interpolation between the points of
    /// the curve. Returns the nearer end of the curve for a time before or after the motion, and
    /// `None` for a motion without times.
    pub fn at_time(&self, seconds: f64) -> Option<CurvePoint> {
        self.times()?;
        let after = self.seconds.partition_point(|&time| time < seconds);
        let Some(before) = after.checked_sub(1) else {
            return self.curve.first().copied();
        };
        let Some(to) = self.curve.get(after) else {
            return self.curve.last().copied();
        };
        let [start, end] = [self.seconds[before], self.seconds[after]];
        let share = (seconds - start) / (end - start);
        Some(self.curve[before].towards(to, share))
    }

    /// Returns the time in s since first touch at which the motion passes a point of its curve;
    /// `None` for a motion without times. If several points of the curve have the indentation of
    /// this point, the time of the point with the nearest force is returned.
    pub fn time_of(&self, point: &CurvePoint) -> Option<f64> {
        let distance = |recorded: &CurvePoint| {
            let way = (recorded.indentation - point.indentation).abs();
            let force = (recorded.force - point.force).abs();
            [way, force]
        };
        let timed = self.curve.iter().zip(&self.seconds);
        let nearest = timed.min_by(|(one, _), (other, _)| {
            let [way, force] = distance(one);
            let [other_way, other_force] = distance(other);
            way.total_cmp(&other_way)
                .then(force.total_cmp(&other_force))
        });
        nearest.map(|(_, &seconds)| seconds)
    }

    /// Creates the record of a motion in which the body stays in place.
    pub fn still(target: Move, here: CurvePoint) -> Self {
        StageRecord {
            target,
            direction: Direction::Loading,
            curve: vec![here],
            largest: here,
            smallest: here,
            attached: 0,
            detached: 0,
            released_energy: 0.0,
            jump_energy: 0.0,
            dashpot_energy: 0.0,
            seconds: Vec::new(),
            reaches_ends: false,
            smallest_of_rest: None,
        }
    }

    /// Creates the record of a motion on which a separated body touches no spring. The body moves
    /// from the indentation `from` to the indentation `to`, both in m.
    pub fn free(target: Move, from: f64, to: f64) -> Self {
        let end = CurvePoint::free(to);
        let direction = if to > from {
            Direction::Loading
        } else {
            Direction::Unloading
        };
        StageRecord {
            direction,
            curve: vec![CurvePoint::free(from), end],
            ..StageRecord::still(target, end)
        }
    }

    /// Inserts a point into a curve in ascending order of the indentation, unless the curve already
    /// has a point at this indentation.
    pub(super) fn insert(curve: &mut Vec<CurvePoint>, point: CurvePoint) {
        let place = curve.partition_point(|other| other.indentation < point.indentation);
        let next = curve.get(place);
        if next.is_none_or(|next| next.indentation > point.indentation) {
            curve.insert(place, point);
        }
    }

    /// Creates the record of a motion. `curve` has the points of the force curve in ascending order
    /// of the indentation, and `released_energy` is in J.
    pub(super) fn moved(
        passage: Passage,
        mut curve: Vec<CurvePoint>,
        extremes: Extremes,
        released_energy: f64,
    ) -> Self {
        let Passage {
            target,
            direction,
            before,
            after,
        } = passage;
        let changed = after.springs.abs_diff(before.springs);
        let mut attached = 0;
        let mut detached = 0;
        match direction {
            Direction::Loading => attached = changed,
            Direction::Unloading => {
                detached = changed;
                StageRecord::insert(&mut curve, extremes.smallest);
                curve.reverse();
            }
        }
        let start = curve[0];
        let end = curve[curve.len() - 1];
        if before.springs == 0 && start.springs > 0 {
            curve.insert(0, CurvePoint::free(start.indentation));
            if before.indentation < start.indentation {
                curve.insert(0, before);
            }
        }
        if after.springs == 0 && end.springs > 0 {
            curve.push(CurvePoint::free(end.indentation));
            // After the instrument has lost the contact, it relaxes and moves the separated body
            // further.
            if after.indentation < end.indentation {
                curve.push(after);
            }
        }
        StageRecord {
            direction,
            curve,
            largest: extremes.largest,
            smallest: extremes.smallest,
            attached,
            detached,
            released_energy,
            ..StageRecord::still(target, end)
        }
    }

    /// Returns the last point of the force curve; `None` if the body is separated at this point.
    pub fn end_in_contact(&self) -> Option<CurvePoint> {
        self.curve.last().copied().filter(|point| point.springs > 0)
    }

    /// Returns the largest number of springs in contact at any moment of the motion.
    pub fn most_springs(&self) -> u64 {
        // A motion in one direction either only attaches or only detaches springs, so the largest
        // number is at a point of the curve.
        let springs = self.curve.iter().map(|point| point.springs);
        springs.max().unwrap_or(0)
    }

    /// Returns points of the force curve at ascending indentations in m, by interpolation between
    /// the points of the curve. Indentations that the stage does not pass are left out.
    pub(super) fn points_at(&self, indentations: &[f64]) -> Vec<CurvePoint> {
        let mut found = Vec::new();
        for &indentation in indentations {
            let passes = |pair: &&[CurvePoint]| {
                let low = pair[0].indentation.min(pair[1].indentation);
                let high = pair[0].indentation.max(pair[1].indentation);
                low <= indentation && indentation <= high
            };
            if let Some(pair) = self.curve.windows(2).find(passes) {
                found.push(pair[0].between(&pair[1], indentation));
            }
        }
        found
    }

    /// Returns the energy in J that the contact dissipates in this stage: the released energy, and
    /// the energy that relaxation dissipates.
    pub fn dissipated_energy(&self) -> f64 {
        self.released_energy + self.dashpot_energy
    }

    /// Returns the indentation in m at the beginning of the motion.
    pub fn start(&self) -> f64 {
        self.curve.first().map_or(0.0, |point| point.indentation)
    }

    /// Returns the indentation in m at the end of the motion.
    pub fn end(&self) -> f64 {
        self.curve.last().map_or(0.0, |point| point.indentation)
    }
}

/// Result of [`load_body`](crate::motion::load_body): the records of all stages, the patches at the
/// end and the computing work.
///
/// ```
/// use asperity_contact::motion::{Body, load_body};
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let history = load_body(
///     &mut Body::new(&contact, 64),
///     &[Move::ToForce(1.0e-4)],
///     |_, _| Ok(()),
/// )?;
/// assert_eq!(
///     (
///         history.stages.len(),
///         history.contacts.len(),
///         history.work.loading_passes
///     ),
///     (1, 1, 1)
/// );
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// One record for each loading stage, in the order of the stages.
    pub stages: Vec<StageRecord>,
    /// Patches in contact after the last stage, from left to right.
    pub contacts: Vec<Patch>,
    /// Counts of the computing work of the solver for all stages together.
    pub work: Work,
}

impl History {
    /// Returns the largest error in N that the finite steps in time may cause in a force of a
    /// relaxing body. Returns `None` without [`Relaxation`], where there are no steps in time.
    pub fn step_error(&self) -> Option<f64> {
        let mut largest = None;
        for stage in self.stages.iter().filter(|stage| !stage.seconds.is_empty()) {
            let force = stage.largest.force.abs().max(stage.smallest.force.abs());
            largest = Some(force.max(largest.unwrap_or(0.0)));
        }
        largest.map(|force| Relaxation::STEP_ERROR * force)
    }
}

/// Counts of computing work. Examples are how often the rule of Hess was evaluated, and how often
/// the solver passed over the [contact tree](crate::motion::ContactTree). Unlike computing times,
/// the counts are the same on every machine.
///
/// ```
/// use asperity_contact::motion::{Body, MovingBody};
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// // A round body has one local minimum of the gap, and no node at which patches merge.
/// let mut body = Body::new(&contact, 64);
/// body.advance(Move::ToForce(1.0e-4))?;
/// assert_eq!((body.work().springs, body.work().tree_nodes), (1025, 0));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
#[non_exhaustive]
pub struct Work {
    /// Number of springs of the profile.
    pub springs: u64,
    /// Number of random phases drawn for the waves of a random profile.
    pub random_phases: u64,
    /// Number of Fourier transforms of the whole profile that were computed.
    pub transforms: u64,
    /// Number of nodes of the [`ContactTree`](crate::motion::ContactTree). A node is a point of the
    /// profile at which two patches can merge.
    pub tree_nodes: u64,
    /// Number of times that the solver passed over the contact tree to compute a loading.
    pub loading_passes: u64,
    /// Number of times that the solver passed over the contact tree to compute an unloading.
    pub unloading_passes: u64,
    /// Number of times that the solver passed over the contact tree to compute the two pull-off
    /// forces of [`Body::adhesion_without_preload`](crate::motion::Body::adhesion_without_preload).
    pub passes_without_preload: u64,
    /// Number of times that the rule of Hess was evaluated for a patch.
    pub hess_evaluations: u64,
    /// Number of events that were sorted by indentation to find extremes of the force. An event is
    /// an indentation at which springs attach or detach.
    pub events_sorted: u64,
    /// Number of springs that attached during the loading history. In result files this field is
    /// `joins`.
    #[cfg_attr(feature = "serde", serde(rename = "joins"))]
    pub attached: u64,
    /// Number of springs that detached during the loading history. In result files this field is
    /// `leaves`.
    #[cfg_attr(feature = "serde", serde(rename = "leaves"))]
    pub detached: u64,
    /// Number of small steps of the indentation by the [stepwise solver](crate::motion::Stepwise).
    pub steps: u64,
    /// Number of times that the stepwise solver swept over all springs to find equilibrium.
    pub equilibrium_sweeps: u64,
    /// Number of springs that the stepwise solver visited. A spring counts again at each visit.
    pub spring_updates: u64,
    /// Number of heights of the profile that were sorted into the bins of a histogram.
    pub heights_binned: u64,
}

impl Work {
    pub(crate) fn count(&mut self, stage: &StageRecord) {
        self.attached += stage.attached;
        self.detached += stage.detached;
    }
}

/// Direction in which a body moves.
///
/// ```
/// use asperity_contact::{Contact, Direction, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-5), Move::ToForce(-1.0e-5)])?;
/// let directions = [Direction::Loading, Direction::Unloading];
/// assert!(cycle.stages().iter().map(|stage| stage.direction).eq(directions));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize), serde(rename_all = "lowercase"))]
pub enum Direction {
    /// The indentation grows.
    Loading,
    /// The indentation falls.
    Unloading,
}

/// One point of a force curve: indentation, force, contact and stored energy.
///
/// ```
/// use asperity_contact::CurvePoint;
///
/// let pressed = CurvePoint { indentation: 1.0e-7, force: 2.0e-6, ..CurvePoint::default() };
/// // A cantilever of 20 N/m is bent by 100 nm.
/// assert!((pressed.displacement(20.0) - 2.0e-7).abs() < 1e-20);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurvePoint {
    /// Indentation d in m; 0 at first touch.
    pub indentation: f64,
    /// Force F in N; compression is positive.
    pub force: f64,
    /// Contact length in m: the sum of the lengths of all contact patches.
    pub contact_length: f64,
    /// Number of springs in contact.
    pub springs: u64,
    /// Number of contact patches.
    pub patches: u64,
    /// Elastic energy in J that is stored in the springs.
    pub stored_energy: f64,
}

impl CurvePoint {
    /// Returns the point of the force curve for a body that touches nothing, at an indentation in
    /// m.
    pub(crate) fn free(indentation: f64) -> Self {
        CurvePoint {
            indentation,
            ..CurvePoint::default()
        }
    }

    /// Returns the point at an indentation in m between this point and `other`, by interpolation.
    pub(crate) fn between(&self, other: &CurvePoint, indentation: f64) -> Self {
        let way = other.indentation - self.indentation;
        if way == 0.0 {
            return *other;
        }
        CurvePoint {
            indentation,
            ..self.towards(other, (indentation - self.indentation) / way)
        }
    }

    /// Returns the point at a share from 0 to 1 of the way from this point to `other`, by
    /// interpolation. The numbers of springs and patches are those of the nearer point.
    fn towards(&self, other: &CurvePoint, share: f64) -> Self {
        let between = |from: f64, to: f64| from + share * (to - from);
        let nearest = if share < 0.5 { self } else { other };
        CurvePoint {
            indentation: between(self.indentation, other.indentation),
            force: between(self.force, other.force),
            contact_length: between(self.contact_length, other.contact_length),
            stored_energy: between(self.stored_energy, other.stored_energy),
            ..*nearest
        }
    }

    /// Returns the displacement D = d + F/k in m of the drive of an instrument that holds the body
    /// at this point of the force curve. k = `stiffness` is the stiffness of the instrument in N/m.
    pub fn displacement(&self, stiffness: f64) -> f64 {
        ForcePoint::from(self).displacement(stiffness)
    }
}

/// One point of a force curve without the stored energy.
///
/// ```
/// use asperity_contact::ForcePoint;
///
/// let pressed = ForcePoint { indentation: 1.0e-7, force: 2.0e-6, springs: 1 };
/// // A cantilever of 20 N/m is bent by 100 nm.
/// assert!((pressed.displacement(20.0) - 2.0e-7).abs() < 1e-20);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForcePoint {
    /// Indentation d in m; 0 at first touch.
    pub indentation: f64,
    /// Force F in N; compression is positive.
    pub force: f64,
    /// Number of springs in contact.
    pub springs: u64,
}

impl ForcePoint {
    /// Returns the displacement D = d + F/k in m of the drive of an instrument that holds the body
    /// at this point of the force curve. k = `stiffness` is the stiffness of the instrument in N/m.
    pub fn displacement(&self, stiffness: f64) -> f64 {
        self.indentation + self.force / stiffness
    }
}

impl From<&ForcePoint> for ForcePoint {
    fn from(point: &ForcePoint) -> Self {
        *point
    }
}

impl From<&CurvePoint> for ForcePoint {
    fn from(point: &CurvePoint) -> Self {
        ForcePoint {
            indentation: point.indentation,
            force: point.force,
            springs: point.springs,
        }
    }
}

/// A contact patch: a group of neighbouring springs in contact. In JSON it is the array
/// `[first, last]`.
///
/// ```
/// use asperity_contact::Patch;
///
/// let patches = Patch::of_springs([true, true, false, true].into_iter());
/// assert_eq!(patches, [Patch { first: 0, last: 1 }, Patch { first: 3, last: 3 }]);
/// assert_eq!((patches[0].springs().len(), patches[1].middle()), (2, 3));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(Serialize), serde(into = "(usize, usize)"))]
pub struct Patch {
    /// Index of the leftmost spring of the patch.
    pub first: usize,
    /// Index of the rightmost spring of the patch.
    pub last: usize,
}

impl Patch {
    /// Returns the range of the indices of the springs of the patch, from `first` to `last`.
    pub fn springs(self) -> Range<usize> {
        self.first..self.last + 1
    }

    /// Returns the index of the spring in the middle of the patch. If two springs are in the
    /// middle, returns the left one.
    pub fn middle(self) -> usize {
        self.first + (self.last - self.first) / 2
    }

    /// Returns one value for each of `springs` springs: true if the spring belongs to one of the
    /// patches.
    pub(super) fn of_ranges(patches: &[Patch], springs: usize) -> Vec<bool> {
        let mut contact = vec![false; springs];
        for patch in patches {
            contact[patch.springs()].fill(true);
        }
        contact
    }

    /// Returns the contact patches from left to right. `contact` has one value for each spring,
    /// from left to right: true if the spring is in contact.
    pub fn of_springs(contact: impl Iterator<Item = bool>) -> Vec<Patch> {
        let mut patches: Vec<Patch> = Vec::new();
        for (spring, is_in_contact) in contact.enumerate() {
            if !is_in_contact {
                continue;
            }
            match patches.last_mut() {
                Some(patch) if patch.last + 1 == spring => patch.last = spring,
                _ => patches.push(Patch {
                    first: spring,
                    last: spring,
                }),
            }
        }
        patches
    }
}

impl From<Patch> for (usize, usize) {
    fn from(patch: Patch) -> (usize, usize) {
        (patch.first, patch.last)
    }
}

/// Condition that ends a motion.
#[derive(Clone, Copy, Debug)]
pub(super) enum Goal {
    /// The body reaches this indentation in m.
    Indentation(f64),
    /// The force reaches this value in N.
    Force(f64),
    /// The drive of an instrument that is not rigid reaches this displacement in m.
    Displacement(f64),
    /// The last patch detaches. The value is the indentation in m to which the body moves
    /// afterwards, if the target states one.
    Separation(Option<f64>),
}

impl Goal {
    /// Returns the goal of a motion to a target; `None` if the target keeps the body in place.
    fn of(target: Move) -> Result<Option<Self>, ContactError> {
        Ok(Some(match target {
            Move::ToIndentation(indentation) => Goal::Indentation(indentation),
            Move::ToDisplacement(displacement) => Goal::Displacement(displacement),
            Move::ToTouch => Goal::Indentation(0.0),
            Move::ToForce(force) => Goal::Force(force),
            Move::ToZeroForce => Goal::Force(0.0),
            Move::ToSeparation => Goal::Separation(None),
            Move::Hold(seconds) => {
                check_hold(seconds)?;
                return Ok(None);
            }
        }))
    }
}

/// Returns the direction and the goal of the motion from the point `here` to a target. `stiffness`
/// is the stiffness of the instrument in N/m. Returns `None` if the body is already at the target.
pub(super) fn plan(
    target: Move,
    here: CurvePoint,
    stiffness: f64,
) -> Result<Option<(Direction, Goal)>, ContactError> {
    let separated = here.springs == 0;
    let Some(goal) = Goal::of(target)? else {
        return Ok(None);
    };
    let goal = match goal {
        // The displacement equals the indentation if the instrument is rigid, or if no force
        // deflects it because the body has not touched yet.
        Goal::Displacement(end) if stiffness.is_infinite() || separated && end < 0.0 => {
            Goal::Indentation(end)
        }
        goal => goal,
    };
    let order = match goal {
        Goal::Force(value) | Goal::Indentation(value) | Goal::Displacement(value)
            if !value.is_finite() =>
        {
            return Err(ContactError::NotFinite(value));
        }
        Goal::Force(force) if separated && force < 0.0 => return Err(ContactError::NothingToPull),
        Goal::Force(_) if separated => Ordering::Greater,
        Goal::Force(force) => order(force, here.force),
        // A separated body at d = 0 has not touched yet.
        Goal::Indentation(end) if separated && end >= 0.0 => Ordering::Greater,
        Goal::Indentation(end) => order(end, here.indentation),
        Goal::Displacement(_) if separated => Ordering::Greater,
        Goal::Displacement(end) => order(end, here.displacement(stiffness)),
        Goal::Separation(_) if separated => Ordering::Equal,
        Goal::Separation(_) => Ordering::Less,
    };
    Ok(match order {
        Ordering::Greater => Some((Direction::Loading, goal)),
        Ordering::Less => Some((Direction::Unloading, goal)),
        Ordering::Equal => None,
    })
}

fn order(end: f64, here: f64) -> Ordering {
    end.partial_cmp(&here).unwrap_or(Ordering::Equal)
}

/// Returns an error unless a body can keep its place for this time in s.
pub(super) fn check_hold(seconds: f64) -> Result<(), ContactError> {
    let is_allowed = (0.0..=LARGEST).contains(&seconds);
    check("time of a hold", seconds, is_allowed, "from 0 to 1e50 s")
}
