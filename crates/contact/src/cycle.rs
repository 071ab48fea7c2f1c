//! The loading of a contact and its result: force curve, figures and patches.

use super::body::{Body, Reversal};
use super::branches::Branch;
use super::contact::Contact;
use super::error::{ContactError, LARGEST, check};
use super::events::JumpCollector;
use super::figures::Figures;
use super::history::{CurvePoint, History, StageRecord};
use super::moving_body::{MovingBody, load_body};
use super::profile::Profile;
use super::relaxation::body::RelaxingBody;
use super::stage::{PatchState, Stage};
use super::target::Move;
use asperity_data::Warning;

/// Number of points of the force curve of a stage, if the options do not state another number.
const SAMPLES: usize = 512;

/// Options of [`Contact::load_with`]: the number of points of the force curve, further indentations
/// at which forces are computed, and a function that is called before each stage.
///
/// ```
/// use asperity_contact::{Contact, ContactError, LoadOptions, Modulus, Move, Profile};
///
/// let profile = Profile::from_heights(vec![0.0, -4.0e-8, -1.0e-8], 1.0e-6)?;
/// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).build()?;
/// let stages = [Move::ToIndentation(5.0e-8), Move::ToSeparation];
/// // The forces at given indentations, beside a short curve.
/// let cycle = contact.load_with(
///     &stages,
///     LoadOptions::default()
///         .samples(2)
///         .indentations(&[1.0e-8, 2.0e-8]),
/// )?;
/// assert!(cycle.at(0)[1].force > cycle.at(0)[0].force);
/// // Only one stage: then the loading is stopped.
/// let stopped = contact.load_with(
///     &stages,
///     LoadOptions::default().before_stage(&mut |stage| stage == 0),
/// );
/// assert_eq!(stopped.err(), Some(ContactError::Interrupted));
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Default)]
pub struct LoadOptions<'a> {
    samples: Option<u64>,
    indentations: &'a [f64],
    jumps: Option<&'a mut JumpCollector>,
    before_stage: Option<&'a mut dyn FnMut(usize) -> bool>,
}

impl<'a> LoadOptions<'a> {
    /// Sets the number of points at which the force curve of each loading stage is computed, from 2
    /// to a million. The default is 512. The preload and the pull-off force are exact for any
    /// number of points.
    #[must_use]
    pub fn samples(self, samples: u64) -> Self {
        LoadOptions {
            samples: Some(samples),
            ..self
        }
    }

    /// Sets further indentations in m, in ascending order, at which each stage computes points of
    /// the force curve. [`Cycle::at`] returns these points.
    #[must_use]
    pub fn indentations(self, indentations: &'a [f64]) -> Self {
        LoadOptions {
            indentations,
            ..self
        }
    }

    /// Sets a collector of the jumps of all stages, from which
    /// [`JumpCollector::events`](crate::motion::JumpCollector::events) lists the events of the
    /// loading.
    #[must_use]
    pub fn jumps(self, jumps: &'a mut JumpCollector) -> Self {
        LoadOptions {
            jumps: Some(jumps),
            ..self
        }
    }

    /// Sets a function that is called before each stage with the index of the stage, from 0. The
    /// function returns true to continue. If it returns false, the loading ends with
    /// [`ContactError::Interrupted`].
    #[must_use]
    pub fn before_stage(self, proceed: &'a mut dyn FnMut(usize) -> bool) -> Self {
        LoadOptions {
            before_stage: Some(proceed),
            ..self
        }
    }
}

/// Result of [`Contact::load`], which loads a separated body through several stages: the force
/// curve, figures such as the pull-off force, and the patches in contact at the end.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// let gaps: Vec<f64> = (-512..=512)
///     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
///     .collect();
/// let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// assert!((cycle.preload().unwrap() / 1.0e-4 - 1.0).abs() < 1e-12);
/// // The loss in the jumps into and out of contact is the area of the loop.
/// let curve = cycle.curve();
/// let area: f64 = (1..curve.force.len())
///     .map(|i| {
///         0.5 * (curve.force[i] + curve.force[i - 1])
///             * (curve.indentation[i] - curve.indentation[i - 1])
///     })
///     .sum();
/// assert!((area / cycle.dissipated_energy().unwrap() - 1.0).abs() < 0.01);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cycle {
    history: History,
    figures: Figures,
    /// Points of the force curve of each stage at the additional indentations of [`LoadOptions`].
    points: Vec<Vec<CurvePoint>>,
    /// Stage of the last stage. If there are no stages, the stage of the separated body. With
    /// relaxation it is the elastic approach.
    stage: Stage,
    /// Patches at the end of a loading with relaxation. `None` without relaxation: the patches then
    /// follow from the stage.
    relaxed_patches: Option<Vec<PatchState>>,
}

/// Force curve of all loading stages. Each field is a column with one value for each point of the
/// curve. The points are in the order of the motion.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let curve = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?.curve();
/// let least = curve.force.iter().copied().fold(f64::INFINITY, f64::min);
/// assert!((least / (-1.5 * std::f64::consts::PI * 0.05 * 1.0e-4) - 1.0).abs() < 1e-4);
/// assert_eq!((curve.stage.first(), curve.stage.last()), (Some(&0), Some(&1)));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Curve {
    /// Index of the loading stage to which each point belongs, from 0.
    pub stage: Vec<usize>,
    /// Indentation d in m of each point.
    pub indentation: Vec<f64>,
    /// Force F in N at each point; compression is positive.
    pub force: Vec<f64>,
    /// Displacement D = d + F/k in m at each point: the position of the drive of the instrument. k
    /// is the stiffness of the instrument in N/m.
    pub displacement: Vec<f64>,
    /// Contact length in m at each point: the sum of the lengths of all contact patches.
    pub contact_length: Vec<f64>,
    /// Number of contact patches at each point.
    pub patches: Vec<u64>,
    /// Elastic energy in J that is stored in the springs at each point.
    pub stored_energy: Vec<f64>,
}

impl Contact {
    /// Starts with a separated body and moves it to the targets of the loading stages, one after
    /// the other.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a target that is not between −1e50 and 1e50, and
    /// [`ContactError::Stage`] for a target that the contact cannot reach.
    pub fn load(&self, stages: &[Move]) -> Result<Cycle, ContactError> {
        self.load_with(stages, LoadOptions::default())
    }

    /// Loads the body as [`Contact::load`] does, but with [`LoadOptions`] such as the number of
    /// points of the force curve.
    ///
    /// # Errors
    /// Returns the errors of [`Contact::load`], and [`ContactError::Value`] for an option out of
    /// its range. Returns [`ContactError::Interrupted`] if the function of
    /// [`LoadOptions::before_stage`] returned false.
    ///
    /// ```
    /// use asperity_contact::{Contact, LoadOptions, Modulus, Move, Profile};
    ///
    /// # let gaps: Vec<f64> = (-512..=512)
    /// #     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
    /// #     .collect();
    /// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
    /// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
    /// #     .work_of_adhesion(0.05)
    /// #     .build()?;
    /// let stages = [Move::ToForce(1.0e-4), Move::ToSeparation];
    /// let coarse = contact.load_with(&stages, LoadOptions::default().samples(2))?;
    /// // The pull-off force is exact for any number of samples.
    /// let fine = contact.load(&stages)?;
    /// assert!(
    ///     (coarse.pull_off_force().unwrap() / fine.pull_off_force().unwrap() - 1.0).abs() < 1e-12
    /// );
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn load_with(
        &self,
        stages: &[Move],
        options: LoadOptions<'_>,
    ) -> Result<Cycle, ContactError> {
        let LoadOptions {
            samples,
            indentations,
            mut jumps,
            mut before_stage,
        } = options;
        check_targets(stages)?;
        check_ascending(indentations)?;
        let samples = samples.unwrap_or(SAMPLES as u64);
        let is_allowed = (2..=1_000_000).contains(&samples);
        check("samples", samples as f64, is_allowed, "from 2 to 1000000")?;
        let mut may_begin = |stage| match &mut before_stage {
            Some(proceed) => proceed(stage),
            None => true,
        };
        if !stages.is_empty() && !may_begin(0) {
            return Err(ContactError::Interrupted);
        }
        if self.relaxing().is_some() {
            return self.load_relaxing(stages, indentations, &mut may_begin);
        }
        let mut body = Body::new(self, samples as usize);
        let mut points = Vec::with_capacity(stages.len());
        let history = load_body(&mut body, stages, |record, motion| {
            points.push(points_between(record, motion, indentations)?);
            if let Some(jumps) = &mut jumps {
                jumps.observe(record, motion)?;
            }
            if points.len() < stages.len() && !may_begin(points.len()) {
                return Err(ContactError::Interrupted);
            }
            Ok(())
        })?;
        Ok(Cycle {
            figures: Figures::of(&history),
            history,
            points,
            stage: body.stage(),
            relaxed_patches: None,
        })
    }

    /// Loads a body over a foundation with relaxation. `may_begin` returns false to end the loading
    /// before a stage.
    fn load_relaxing(
        &self,
        stages: &[Move],
        indentations: &[f64],
        may_begin: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Cycle, ContactError> {
        let mut body = RelaxingBody::new(self)?;
        let mut points = Vec::with_capacity(stages.len());
        let history = load_body(&mut body, stages, |record, _| {
            points.push(record.points_at(indentations));
            if points.len() < stages.len() && !may_begin(points.len()) {
                return Err(ContactError::Interrupted);
            }
            Ok(())
        })?;
        Ok(Cycle {
            figures: Figures::of(&history),
            history,
            points,
            stage: body.stage(),
            relaxed_patches: Some(body.patch_states()?),
        })
    }

    /// Computes the unloading to separation from each of several turning points. A turning point is
    /// where a loading from separation reaches one of the targets `ends`.
    ///
    /// [`Reversal::forces`] are computed at `indentations`, which are in m and in ascending order.
    ///
    /// ```
    /// use asperity_contact::{Contact, Edges, Modulus, Move, Profile};
    ///
    /// // Five springs, which attach one after the other.
    /// let profile = Profile::from_heights(&[0.0, -4.0e-8, -1.0e-8, -4.0e-8, -9.0e-8], 1.0e-6)?;
    /// let contact =
    ///     Contact::builder(&profile, Modulus::effective(1.0e6)?).work_of_adhesion(2.0e-4);
    /// let turns = [0.0, 1.0e-8, 5.0e-8].map(Move::ToIndentation);
    /// let found = contact
    ///     .edges(Edges::Grid)
    ///     .build()?
    ///     .reversals(&turns, &[-1.0e-8, 0.0])?;
    /// for (reversal, force) in found.iter().zip([25.07e-9, 40.13e-9, 130.53e-9]) {
    ///     assert!((reversal.pull_off_force().unwrap() - force).abs() < 0.01e-9);
    ///     assert_eq!(reversal.forces.len(), 2);
    /// }
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a target that is not between −1e50 and 1e50, and for
    /// indentations that do not ascend. Returns [`ContactError::Stage`] for a target that the
    /// contact cannot reach, and for a target at which the body is not in contact.
    pub fn reversals(
        &self,
        ends: &[Move],
        indentations: &[f64],
    ) -> Result<Vec<Reversal>, ContactError> {
        if self.relaxing().is_some() {
            return Err(ContactError::NotElastic);
        }
        check_targets(ends)?;
        check_ascending(indentations)?;
        let mut reversals: Vec<(usize, Reversal)> = Vec::with_capacity(ends.len());
        Body::new(self, SAMPLES).reversals(ends, indentations, &mut |index, reversal| {
            reversals.push((index, reversal));
            Ok(())
        })?;
        reversals.sort_by_key(|&(index, _)| index);
        let in_order = reversals.into_iter();
        Ok(in_order.map(|(_, reversal)| reversal).collect())
    }
}

/// Returns the points of a stage at all `indentations` that the stage passes. The indentations are
/// in m and in ascending order, and so are the returned points.
fn points_between(
    record: &StageRecord,
    stage: &Stage,
    indentations: &[f64],
) -> Result<Vec<CurvePoint>, ContactError> {
    let low = record.start().min(record.end());
    let high = record.start().max(record.end());
    let first = indentations.partition_point(|&indentation| indentation < low);
    let end = indentations.partition_point(|&indentation| indentation <= high);
    stage.curve(&indentations[first..end.max(first)])
}

/// Returns an error if a target is so large that a result might not be a finite number.
fn check_targets(targets: &[Move]) -> Result<(), ContactError> {
    for (index, target) in targets.iter().enumerate() {
        if let Move::ToForce(value) | Move::ToIndentation(value) | Move::ToDisplacement(value) =
            *target
        {
            let name = format!("target of stage {}", index + 1);
            check(&name, value, value.abs() <= LARGEST, "from -1e50 to 1e50")?;
        }
    }
    Ok(())
}

/// Returns an error unless all indentations are finite numbers in ascending order.
fn check_ascending(indentations: &[f64]) -> Result<(), ContactError> {
    let mut before = -LARGEST;
    for (index, &indentation) in indentations.iter().enumerate() {
        let name = format!("indentation with index {index}");
        let is_allowed = (before..=LARGEST).contains(&indentation);
        let allowed = "from -1e50 to 1e50 m, ascending";
        check(&name, indentation, is_allowed, allowed)?;
        before = indentation;
    }
    Ok(())
}

impl History {
    /// Returns a warning for each premise of the model that this loading history does not meet.
    /// `profile` is the profile of the contact. The premises are:
    ///
    /// * If the body is curved, its contact ends inside the profile.
    /// * The last unloading reaches separation or passes the smallest force.
    /// * Enough springs are in contact.
    pub fn warnings(&self, profile: &Profile) -> Vec<Warning> {
        let reaches_ends = self.stages.iter().any(|stage| stage.reaches_ends);
        let springs = self.stages.iter().map(StageRecord::most_springs);
        let most_springs = springs.max().unwrap_or(0);
        let mut warnings = warnings_of_contact(profile, reaches_ends, most_springs);
        warnings.extend(Branch::ends_in_contact(&self.stages));
        warnings
    }
}

impl Reversal {
    /// Returns a warning for each premise of the model that the loading to the turning point does
    /// not meet. `profile` is the profile of the contact. The premises are:
    ///
    /// * If the body is curved, its contact ends inside the profile.
    /// * Enough springs are in contact.
    pub fn warnings(&self, profile: &Profile) -> Vec<Warning> {
        warnings_of_contact(profile, self.reaches_ends, self.turn.springs)
    }
}

/// Returns the warnings about the ends of the profile and the number of springs in contact.
/// `reaches_ends` is true if an outermost spring was in contact, and `most_springs` is the largest
/// number of springs in contact.
fn warnings_of_contact(profile: &Profile, reaches_ends: bool, most_springs: u64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if reaches_ends && profile.is_curved() {
        warnings.push(Warning::ContactAtEnds {
            length: profile.length(),
        });
    }
    // If every spring of a profile is in contact, a finer resolution is not possible, so no warning
    // is given.
    if most_springs < profile.points() as u64 {
        warnings.extend(Warning::of_springs_in_contact(most_springs));
    }
    warnings
}

impl Cycle {
    /// Returns the pull-off force in N: the smallest force of the last unloading, with the opposite
    /// sign. Returns `None` if this smallest force is above zero. Also returns `None` if the
    /// unloading ends in contact before it has passed the smallest force.
    #[must_use]
    pub fn pull_off_force(&self) -> Option<f64> {
        self.figures.pull_off_force
    }

    /// Returns the indentation in m at which the pull-off force acts; `None` if
    /// [`Cycle::pull_off_force`] is `None`.
    #[must_use]
    pub fn pull_off_indentation(&self) -> Option<f64> {
        self.figures.pull_off_indentation
    }

    /// Returns the preload in N: the largest force on loading before the last unloading. Forces
    /// before an earlier separation of the body do not count. Returns `None` if the body is never
    /// in contact on this loading.
    #[must_use]
    pub fn preload(&self) -> Option<f64> {
        self.figures.preload
    }

    /// Returns the energy in J dissipated in the contact during all stages together; `None` if the
    /// last stage ends in contact.
    #[must_use]
    pub fn dissipated_energy(&self) -> Option<f64> {
        self.figures.dissipated_energy
    }

    /// Returns the figures of the loading, such as the preload, the pull-off force and the
    /// dissipated energy.
    #[must_use]
    pub fn figures(&self) -> Figures {
        self.figures
    }

    /// Returns all points of the force curve, stage after stage, in the order of the motion.
    pub fn points(&self) -> impl Iterator<Item = &CurvePoint> {
        self.history.stages.iter().flat_map(|record| &record.curve)
    }

    /// Returns the force curve of all stages as columns, one for each quantity.
    #[must_use]
    pub fn curve(&self) -> Curve {
        let mut curve = Curve::default();
        let stiffness = self.stage.contact().loading_stiffness;
        for (stage, record) in self.history.stages.iter().enumerate() {
            for point in &record.curve {
                curve.stage.push(stage);
                curve.indentation.push(point.indentation);
                curve.force.push(point.force);
                curve.displacement.push(point.displacement(stiffness));
                curve.contact_length.push(point.contact_length);
                curve.patches.push(point.patches);
                curve.stored_energy.push(point.stored_energy);
            }
        }
        curve
    }

    /// Returns points of the force curve of one stage at the indentations that
    /// [`LoadOptions::indentations`] has set, in ascending order. Indentations that the stage does
    /// not pass are left out. `stage` is the index of the stage, from 0.
    #[must_use]
    pub fn at(&self, stage: usize) -> &[CurvePoint] {
        self.points.get(stage).map_or(&[], Vec::as_slice)
    }

    /// Returns a [`StageRecord`] for each loading stage, with the force curve and the energies of
    /// the stage.
    #[must_use]
    pub fn stages(&self) -> &[StageRecord] {
        &self.history.stages
    }

    /// Returns a warning for each premise of the model that this loading does not meet. An example
    /// is a curved body whose contact reaches the ends of the profile. The list is empty if the
    /// heights and the loading show no unmet premise.
    ///
    /// ```
    /// use asperity_contact::{Contact, Modulus, Move, Profile};
    ///
    /// // Heights of a scan along a sphere of 200 µm. They are not those of its equivalent profile
    /// // x²/R.
    /// let cut: Vec<f64> = (-512..=512)
    ///     .map(|i| -(f64::from(i) * 1.0e-7).powi(2) / 4.0e-4)
    ///     .collect();
    /// let contact = Contact::builder(
    ///     &Profile::from_heights(cut, 1.0e-7)?,
    ///     Modulus::effective(1.0e6)?,
    /// );
    /// let cycle = contact
    ///     .work_of_adhesion(0.03)
    ///     .build()?
    ///     .load(&[Move::ToForce(5.0e-6), Move::ToSeparation])?;
    /// let names: Vec<&str> = cycle
    ///     .warnings()
    ///     .iter()
    ///     .map(|warning| warning.name())
    ///     .collect();
    /// assert_eq!(names, ["cut_like_heights"]);
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    #[must_use]
    pub fn warnings(&self) -> Vec<Warning> {
        let profile = self.stage.contact().profile();
        let mut warnings = self.history.warnings(profile);
        warnings.extend(profile.doubt());
        warnings
    }

    /// Returns the state of each contact patch at the end of the last stage, such as its force,
    /// from left to right.
    #[must_use]
    pub fn patches(&self) -> Vec<PatchState> {
        if let Some(patches) = &self.relaxed_patches {
            return patches.clone();
        }
        let last_stage = self.history.stages.last();
        match last_stage.and_then(StageRecord::end_in_contact) {
            Some(end) => self.stage.patch_states(end.indentation),
            None => Vec::new(),
        }
    }
}
