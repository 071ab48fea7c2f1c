//! Computation of a scene. Only those parts are computed whose input has changed since the last
//! computation.

use super::loading::{AfterStage, Loaded, Prepared, check_interruption};
use super::outcome::{LineFacts, Outcome, RunError, Timings};
use super::reach;
use super::roughness::{Rough, RoughnessKey, RoughnessMaker};
use super::workload::{WorkPart, Workload};
use crate::analysis::governing::{Governing, SteepWaves};
use crate::analysis::instrument::InstrumentFigures;
use crate::analysis::regime::Regime;
use crate::scene::checked::CheckedScene;
use crate::scene::model::Scene;
use asperity_contact::motion::ContactTree;
use asperity_contact::{ClosedForm, Contact, ContactError, Edges, Figures, NominalForm, Profile};
use asperity_data::{Warning, check_room, emptied};
use asperity_surface::lines::{Histogram, Line, MeasuredRoughness, Synthesizer};
use asperity_surface::{EquivalentLine, Form, SurfaceError};
use std::mem::take;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

const HISTOGRAM_BINS: usize = 64;
const NOT_MADE: ContactError = ContactError::Internal("the profile of the scene has not been made");
/// Memory that is kept for the next computation is released if it exceeds the needed memory by more
/// than this factor.
const MOST_SPARE: u64 = 4;
// The needed memory is `Workload::peak_bytes` plus 20 bytes for each spring for a Fourier
// transform. Released memory goes to the allocator: glibc keeps released blocks of less than 32 MiB
// for further use, in total at most 64 MiB for each thread.
/// Memory kept for the next computation is not released if it is at most this number of bytes.
const SMALL: u64 = 32 << 20;

/// Computes scenes, one after the other. A simulation computes again only what depends on a changed
/// field of the scene.
///
/// Between two computations a simulation keeps at most 32 MiB or four times the memory that its
/// last scene needed, whichever is larger.
///
/// ```
/// use asperity_scene::{Simulation, open};
///
/// let (mut simulation, sphere) = (Simulation::default(), open("jkr-sphere")?);
/// let mut force = |points: u64| {
///     let scene = sphere.scene().with(|scene| scene.numerics.points = points)?;
///     Ok::<_, asperity_scene::Error>(simulation.compute(&scene)?.figures.pull_off_force)
/// };
/// assert!((force(512)?.unwrap() / force(4096)?.unwrap() - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Default)]
pub struct Simulation {
    /// True if only one scene is computed. Memory for a further profile is then released at once.
    single: bool,
    maker: RoughnessMaker,
    roughness: Option<Rough>,
    line: Option<KeptLine>,
    histogram: Option<Histogram>,
    /// The last profile as a [`Profile`], from which a contact can be made. It has its contact
    /// tree.
    profile: Option<Profile>,
    /// Profile of the form without roughness, for the pull-off force of the smooth body; `None`
    /// until it is needed.
    pub(super) smooth: Option<SmoothProfile>,
    /// Contact tree of a former profile. The next tree uses its memory.
    former_tree: ContactTree,
    /// Memory that is kept from former computations, in bytes.
    kept: u64,
}

/// A profile with its key, which contains everything that determines the profile.
struct KeptLine {
    key: LineKey,
    line: Line,
}

#[derive(Clone, PartialEq)]
struct LineKey {
    roughness: Option<RoughnessKey>,
    scale: f64,
    length: f64,
    points: usize,
    form: Option<Form>,
}

/// Profile of a form without roughness, with everything that determines it.
pub(super) struct SmoothProfile {
    pub form: Form,
    pub length: f64,
    pub points: u64,
    pub profile: Profile,
}

impl Simulation {
    /// Returns a simulation for scenes. Names of measured files in the scenes are relative to
    /// `folder`.
    pub fn new(folder: PathBuf) -> Self {
        Simulation {
            maker: RoughnessMaker {
                folder,
                ..RoughnessMaker::default()
            },
            ..Simulation::default()
        }
    }

    /// Returns this simulation, set up for a single scene. The simulation then needs less memory,
    /// but computes each further profile more slowly.
    pub fn for_one_scene(self) -> Self {
        Simulation {
            single: true,
            ..self
        }
    }

    /// Returns this simulation with a measured roughness in memory. Every scene with a measured
    /// surface uses this roughness instead of the files that the scene names.
    pub fn with_measured(mut self, measured: Arc<MeasuredRoughness>) -> Self {
        self.maker.measured = Some(measured);
        self
    }

    /// Returns the measured spectrum in use. It is the spectrum given to [`Self::with_measured`]
    /// or, if none was given, the last spectrum that was estimated from files. Returns `None` if
    /// there is no spectrum.
    pub fn equivalent_line(&self) -> Option<&EquivalentLine> {
        let surface = match (&self.maker.measured, &self.maker.equivalent) {
            (Some(measured), _) => measured,
            (None, Some(kept)) => &kept.surface,
            (None, None) => return None,
        };
        match &**surface {
            MeasuredRoughness::Equivalent(line) => Some(line),
            MeasuredRoughness::Profile(_) => None,
        }
    }

    /// Returns a new simulation with the same folder and the same measured surface.
    pub fn another(&self) -> Simulation {
        Simulation {
            single: self.single,
            maker: RoughnessMaker {
                folder: self.maker.folder.clone(),
                measured: self.maker.measured.clone(),
                ..RoughnessMaker::default()
            },
            ..Simulation::default()
        }
    }

    /// Returns the profile that was computed last; `None` before the first profile.
    pub fn line(&self) -> Option<&Line> {
        self.line.as_ref().map(|kept| &kept.line)
    }

    /// Returns the profile of a scene, the facts about the profile, and the governing parameters.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory, or if a measured file or a form cannot be
    /// used.
    pub fn make_line(
        &mut self,
        scene: &CheckedScene,
    ) -> Result<(&Line, LineFacts, Governing), RunError> {
        self.line_of(scene)
    }

    fn line_of(&mut self, scene: &Scene) -> Result<(&Line, LineFacts, Governing), RunError> {
        let points = scene.numerics.points as usize;
        let length = scene.length;
        let roughness = self.maker.key(scene);
        if self.roughness.as_ref().map(|rough| &rough.key) != roughness.as_ref() {
            let before = self.roughness.take().map(|rough| rough.heights);
            if let Some(key) = &roughness {
                self.roughen(scene, key, before.unwrap_or_default())?;
            }
        }
        let rough = self.roughness.as_ref();
        let unit = rough
            .and_then(|rough| rough.unit)
            .map(|unit| unit.stretched(length));
        let measured = rough.and_then(|rough| rough.measured);
        let governing = Governing::of(scene, unit, measured);
        let rms_height = governing
            .amplitude
            .map_or(0.0, |amplitude| amplitude.rms_height);
        // The heights of a measured surface are already in metres. Other heights are scaled to the
        // rms height.
        let scale = if measured.is_some() { 1.0 } else { rms_height };
        let modes = rough
            .and_then(|rough| rough.modes)
            .map(|modes| (modes.first, modes.last));
        if let Some(form) = &scene.form {
            form.load(&self.maker.folder, length)?;
        }
        let key = LineKey {
            roughness,
            scale,
            length,
            points,
            form: scene.form.clone(),
        };
        if self.line.as_ref().is_none_or(|kept| kept.key != key) {
            let line = self.lay_line(scene, &key)?;
            self.profile = Some(profile_of(&line, nominal_form(scene))?);
            self.line = Some(KeptLine { key, line });
        }
        let line = self.line().ok_or(NOT_MADE)?;
        let facts = LineFacts {
            points,
            length,
            spacing: line.spacing,
            first: line.first,
            summit: line.summit,
            deepest: line.deepest,
            modes,
            seed: scene.seed(),
            continuum_rms_gradient: scene
                .spectrum()
                .map(|spectrum| rms_height * spectrum.continuum_gradient_per_height(length)),
        };
        Ok((line, facts, governing))
    }

    /// Returns the profile of a scene as a [`Profile`], from which a [`Contact`] can be made.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::make_line`].
    pub fn profile(&mut self, scene: &CheckedScene) -> Result<Profile, RunError> {
        self.line_of(scene)?;
        Ok(self.made()?.clone())
    }

    /// Returns the profile that was made last.
    fn made(&self) -> Result<&Profile, ContactError> {
        self.profile.as_ref().ok_or(NOT_MADE)
    }

    /// Makes a profile from its roughness and its form.
    fn lay_line(&mut self, scene: &Scene, key: &LineKey) -> Result<Line, RunError> {
        let LineKey {
            scale,
            length,
            points,
            ..
        } = *key;
        self.histogram = None;
        // If a caller has kept a stage, the last profile is still in use. Otherwise the memory of
        // its contact tree can be used for the next tree.
        if let Some(profile) = self.profile.take() {
            self.former_tree = profile.into_tree();
        }
        let mut memory = self
            .line
            .take()
            .and_then(|kept| Arc::into_inner(kept.line.gaps))
            .unwrap_or_default();
        if let Some(roughness) = &key.roughness
            && let Some(rough) = &self.roughness
            && rough.heights.is_empty()
        {
            self.roughen(scene, roughness, take(&mut memory))?;
        }
        if self.single
            && let Some(rough) = &mut self.roughness
        {
            memory = take(&mut rough.heights);
        } else {
            memory = emptied(memory, points).map_err(SurfaceError::of_springs)?;
            if let Some(rough) = &self.roughness {
                memory.extend_from_slice(&rough.heights);
            }
            memory.resize(points, 0.0);
        }
        Ok(Line::from_roughness(
            memory,
            length,
            scene.form.as_ref(),
            scale,
        )?)
    }

    /// Makes the heights of a roughness. Random heights are written into the memory `memory`.
    fn roughen(
        &mut self,
        scene: &Scene,
        key: &RoughnessKey,
        memory: Vec<f64>,
    ) -> Result<(), RunError> {
        // The memory is checked first because the transform allocates memory itself, and a failed
        // allocation would end the process.
        check_room(Workload::of_any(scene).line_bytes()).map_err(SurfaceError::of_springs)?;
        self.roughness = Some(self.maker.make(key.clone(), memory)?);
        if self.single {
            self.maker.synthesizer = Synthesizer::default();
        }
        Ok(())
    }

    /// Makes the histogram and the contact tree of the profile, if the plan requires them and they
    /// do not exist yet. Returns the number of heights that were sorted into bins.
    fn look_at_line(&mut self, plan: &Workload, edges: Edges) -> Result<u64, ContactError> {
        let memory = take(&mut self.former_tree);
        if plan.runs(WorkPart::Tree) {
            self.made()?.build_tree(edges, memory)?;
        }
        if !plan.runs(WorkPart::HeightHistogram) || self.histogram.is_some() {
            return Ok(0);
        }
        let Some(line) = self.line() else {
            return Ok(0);
        };
        let binned = line.gaps.len() as u64;
        self.histogram = Some(Histogram::new(
            line.heights(),
            line.lowest(),
            line.summit,
            HISTOGRAM_BINS,
        ));
        Ok(binned)
    }

    /// Checks that there is enough memory for a computation, before anything is allocated. Memory
    /// from former computations counts as available. This memory is released if it is far larger
    /// than needed or if the remaining memory is too small.
    fn make_room(&mut self, bytes: u64) -> Result<(), RunError> {
        if self.kept / MOST_SPARE > bytes && self.kept > SMALL {
            self.give_back();
        }
        if check_room(bytes.saturating_sub(self.kept)).is_err() {
            self.give_back();
            check_room(bytes).map_err(|_| RunError::OutOfMemory { bytes })?;
        }
        self.kept = self.kept.max(bytes);
        Ok(())
    }

    fn give_back(&mut self) {
        *self = self.another();
    }

    /// Makes the profile and the contact of a checked scene, according to the plan `plan`.
    pub(super) fn prepare(
        &mut self,
        plan: &Workload,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
    ) -> Result<Prepared, RunError> {
        let mut timings = Timings::default();
        self.make_room(plan.peak_bytes)?;

        let drawn_before = self.maker.phases_drawn;
        let begun = Instant::now();
        let (_, facts, governing) = self.line_of(scene)?;
        timings.profile = begun.elapsed().as_secs_f64();
        check_interruption(stop)?;
        let random_phases = self.maker.phases_drawn - drawn_before;

        let edges = scene.numerics.edges;
        let begun = Instant::now();
        let heights_binned = self.look_at_line(plan, edges)?;
        timings.tree = begun.elapsed().as_secs_f64();
        check_interruption(stop)?;

        let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
        let mut contact = governing
            .contact(self.made()?)?
            .edges(edges)
            .loading_stiffness(stiffness);
        if let Some(relaxation) = scene.material.relaxation {
            contact = contact.relaxation(relaxation.relaxation()?);
        }
        if let Some(speed) = scene.loading_speed {
            contact = contact.loading_speed(speed);
        }
        let contact = contact.build()?;
        let warnings = self.warnings_before_loading(scene, &governing)?;
        Ok(Prepared {
            contact,
            facts,
            governing,
            random_phases,
            heights_binned,
            timings,
            warnings,
        })
    }

    /// Returns a warning for each premise of the model that a scene does not meet before its
    /// loading. The warnings concern the fields of the scene, its measured surface and its profile.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::make_line`].
    pub fn warnings(&mut self, scene: &CheckedScene) -> Result<Vec<Warning>, RunError> {
        let (.., governing) = self.line_of(scene)?;
        Ok(self.warnings_before_loading(scene, &governing)?)
    }

    /// Returns a warning for each premise that a scene does not meet before its loading. The
    /// profile must have been made.
    fn warnings_before_loading(
        &self,
        scene: &Scene,
        governing: &Governing,
    ) -> Result<Vec<Warning>, ContactError> {
        let measured = self.roughness.as_ref().and_then(|rough| rough.facts);
        let mut warnings: Vec<Warning> = self.made()?.doubt().into_iter().collect();
        warnings.extend(scene.warnings_of(governing, measured));
        Ok(warnings)
    }

    /// Returns the contact of a scene before its loading, and the governing parameters.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::make_line`]. Also returns an error if a value of the
    /// contact is out of its range.
    pub fn contact(&mut self, scene: &CheckedScene) -> Result<(Contact, Governing), RunError> {
        let made = self.prepare(&Workload::of_any(scene), scene, &|| false)?;
        Ok((made.contact, made.governing))
    }

    /// Computes all results of a scene.
    ///
    /// # Errors
    /// Returns an error if a part of the computation fails.
    pub fn compute(&mut self, scene: &CheckedScene) -> Result<Outcome, RunError> {
        self.run(scene, &|| false, &mut |_, _, _| Ok(()))
    }

    /// Computes all results of a scene. `after` is called after each loading stage. The computation
    /// ends soon after `stop` returns true.
    ///
    /// # Errors
    /// Returns an error if a part of the computation fails or if `stop` returned true.
    pub fn run(
        &mut self,
        scene: &CheckedScene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterStage<'_>,
    ) -> Result<Outcome, RunError> {
        let plan = Workload::of(scene);
        let mut prepared = self.prepare(&plan, scene, stop)?;
        reach::check(&prepared.contact, &scene.loading)?;
        let loaded = prepared.load(scene, &plan, stop, after)?;
        self.outcome(scene, &plan, prepared, loaded)
    }

    /// Derives all results of a scene from its loading.
    fn outcome(
        &mut self,
        scene: &CheckedScene,
        plan: &Workload,
        prepared: Prepared,
        loaded: Loaded,
    ) -> Result<Outcome, RunError> {
        let Prepared {
            contact,
            facts,
            governing,
            timings,
            warnings: warnings_before_loading,
            ..
        } = prepared;
        let Loaded {
            history,
            patches,
            without_preload,
        } = loaded;
        let mut warnings = history.warnings(contact.profile());
        if !warnings.iter().any(Warning::leaves_errors_unknown) {
            warnings.extend(scene.wide_sphere(&history, &governing));
        }
        warnings.extend(scene.coarse_steps(&history));
        warnings.extend(scene.steep_form(&history));
        warnings.extend(warnings_before_loading);
        let figures = Figures::of(&history);
        let ideal = governing
            .adhesive_work()
            .map(|work| ClosedForm::ideal_pull_off_force(work, governing.modulus, scene.length));
        // The smooth body is computed as an elastic one.
        let smooth = if scene.relaxes() {
            None
        } else {
            self.smooth_pull_off_force(scene, &governing, &figures)?
        };
        let [first_touch, zero_force] = without_preload;
        let histogram = if plan.runs(WorkPart::HeightHistogram) {
            self.histogram.clone()
        } else {
            None
        };
        // The regimes compare loops with and without a preload, which take different times.
        let regime_after = |without_preload| {
            if scene.relaxes() {
                return None;
            }
            Regime::of_loading(&figures, without_preload, smooth)
        };
        Ok(Outcome {
            line: facts,
            governing,
            ideal_pull_off_force: ideal,
            smooth_pull_off_force: smooth,
            first_touch_pull_off_force: first_touch,
            zero_force_pull_off_force: zero_force,
            tabor_number: governing.tabor_number(scene),
            steep_waves: SteepWaves::of(scene, &governing),
            regime: regime_after(first_touch),
            regime_after_zero_force: regime_after(zero_force),
            instrument: scene
                .loading_stiffness
                .map(|stiffness| InstrumentFigures::of(&history, &figures, stiffness)),
            figures,
            history,
            patches,
            histogram,
            warnings,
            timings,
        })
    }
}

/// Returns the profile of a contact, made from the rigid line `line` and the form of the body.
pub(crate) fn profile_of(line: &Line, nominal_form: NominalForm) -> Result<Profile, ContactError> {
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing)?;
    let placed = profile
        .on_foundation(line.length, line.first)?
        .with_summit(line.summit)?;
    Ok(placed.with_nominal_form(nominal_form))
}

/// Returns the form of the body that a profile states: flat or curved. If measured heights are used
/// unchanged as the profile, the form is not stated.
pub(crate) fn nominal_form(scene: &Scene) -> NominalForm {
    match &scene.form {
        Some(form) if form.flat_end().is_none() => NominalForm::Curved,
        None if scene.measured_as_line() => NominalForm::Unstated,
        Some(_) | None => NominalForm::Flat,
    }
}
