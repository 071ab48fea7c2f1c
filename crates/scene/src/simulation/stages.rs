//! Computation of a scene. Only parts whose input has changed since the last run are computed.

use super::outcome::{LineFacts, Outcome, RunError, Timings};
use super::reach;
use super::roughness::{Rough, RoughnessKey, RoughnessMaker};
use super::workload::{Stage, Workload};
use crate::analysis::governing::{Governing, SteepWaves};
use crate::analysis::instrument::InstrumentFigures;
use crate::analysis::regime::Regime;
use crate::scene::checked::CheckedScene;
use crate::scene::model::{Scene, Solver as SolverChoice};
use asperity_contact::motion::{Body, ContactTree, Leg, MovingBody, Stepwise, load_body};
use asperity_contact::{
    ClosedForm, Contact, ContactError, Edges, Figures, History, LegRecord, Move, NominalForm,
    Patch, Profile,
};
use asperity_data::{Warning, check_room, emptied};
use asperity_surface::lines::{Histogram, Line, MeasuredRoughness, Synthesizer};
use asperity_surface::{EquivalentLine, Form, SurfaceError};
use std::mem::take;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

const HISTOGRAM_BINS: usize = 64;
/// Kept memory is released if it exceeds the memory that the next run needs by more than this
/// factor.
const MOST_SPARE: u64 = 4;
// The memory that a run needs is `Workload::peak_bytes` plus 20 bytes per spring for a Fourier
// transform. Released memory goes to the allocator: glibc keeps released blocks of less than 32 MiB
// for reuse, in total at most 64 MiB for each thread.
/// Number of bytes that are always kept.
const SMALL: u64 = 32 << 20;

/// Computes scenes, one after the other. A simulation repeats only the parts of the computation
/// that depend on a changed field of the scene.
///
/// Between runs a simulation keeps at most 32 MiB or four times the memory that its last scene
/// needed, whichever is larger.
///
/// ```
/// use asperity_scene::{Simulation, open};
///
/// let (mut simulation, sphere) = (Simulation::default(), open("jkr-sphere")?);
/// let mut force = |points: u64| {
///     let scene = sphere.scene().with(|scene| scene.numerics.points = points)?;
///     Ok::<_, asperity_scene::Error>(simulation.compute(&scene)?.figures.adhesion_force)
/// };
/// assert!((force(512)?.unwrap() / force(4096)?.unwrap() - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Default)]
pub struct Simulation {
    /// True for a single scene, whose memory for a further profile is released at once.
    single: bool,
    maker: RoughnessMaker,
    roughness: Option<Rough>,
    line: Option<(LineKey, Line)>,
    histogram: Option<Histogram>,
    /// The last profile as the profile of a contact, with its tree.
    profile: Option<Profile>,
    /// Profile of the form without roughness, once F_smooth has needed it.
    pub(super) smooth: Option<SmoothProfile>,
    /// Contact tree of a former profile, whose memory is reused.
    former_tree: ContactTree,
    /// Memory kept from former runs, in bytes.
    kept: u64,
}

#[derive(Clone, PartialEq)]
struct LineKey {
    roughness: Option<RoughnessKey>,
    scale: f64,
    length: f64,
    points: usize,
    form: Option<Form>,
}

/// Profile of a form without roughness, with everything on which it depends.
pub(super) struct SmoothProfile {
    pub form: Form,
    pub length: f64,
    pub points: u64,
    pub profile: Profile,
}

/// Contact of a scene before its loading, with facts about its profile.
pub(super) struct Prepared {
    pub contact: Contact,
    facts: LineFacts,
    governing: Governing,
    random_phases: u64,
    heights_binned: u64,
    /// Times in s for the profile and the tree.
    timings: Timings,
    /// Premises that the scene does not meet, before its loading.
    warnings: Vec<Warning>,
}

/// Function that [`Simulation::run`] calls after each loading stage, with the index of the stage,
/// its force curve ([`LegRecord`]) and the solved stage ([`Leg`]). If the function returns an
/// error, the run ends with this error.
pub type AfterLeg<'a> = dyn FnMut(usize, &LegRecord, &Leg) -> Result<(), ContactError> + 'a;

impl Simulation {
    /// Returns a simulation for scenes whose names of measured files are relative to `folder`.
    pub fn new(folder: PathBuf) -> Self {
        Simulation {
            maker: RoughnessMaker {
                folder,
                ..RoughnessMaker::default()
            },
            ..Simulation::default()
        }
    }

    /// Returns this simulation with a smaller need of memory, for a single scene. Each further
    /// profile takes more time to compute.
    pub fn for_one_scene(self) -> Self {
        Simulation {
            single: true,
            ..self
        }
    }

    /// Returns this simulation with a measured roughness that every scene with a measured surface
    /// uses, instead of the files that the scene names.
    pub fn with_measured(mut self, measured: Arc<MeasuredRoughness>) -> Self {
        self.maker.measured = Some(measured);
        self
    }

    /// Returns the measured spectrum in use: the one given to [`Self::with_measured`], otherwise
    /// the last one that was estimated from files. Returns `None` if there is no spectrum.
    pub fn equivalent_line(&self) -> Option<&EquivalentLine> {
        let RoughnessMaker {
            measured,
            equivalent,
            ..
        } = &self.maker;
        match &**measured
            .as_ref()
            .or(equivalent.as_ref().map(|(.., surface)| surface))?
        {
            MeasuredRoughness::Equivalent(line) => Some(line),
            MeasuredRoughness::Profile(_) => None,
        }
    }

    /// Returns a new simulation with the same folder and the same measured surface.
    pub fn another(&self) -> Simulation {
        let RoughnessMaker {
            folder, measured, ..
        } = &self.maker;
        let (folder, measured) = (folder.clone(), measured.clone());
        let maker = RoughnessMaker {
            folder,
            measured,
            ..RoughnessMaker::default()
        };
        Simulation {
            single: self.single,
            maker,
            ..Simulation::default()
        }
    }

    /// Returns the profile that was computed last; `None` before the first profile.
    pub fn line(&self) -> Option<&Line> {
        self.line.as_ref().map(|(_, line)| line)
    }

    /// Returns the profile of a scene, the numbers that describe it, and the governing parameters.
    ///
    /// # Errors
    /// Returns an error if the memory is too small, or if a measured file or a form cannot be used.
    pub fn make_line(
        &mut self,
        scene: &CheckedScene,
    ) -> Result<(&Line, LineFacts, Governing), RunError> {
        self.line_of(scene)
    }

    fn line_of(&mut self, scene: &Scene) -> Result<(&Line, LineFacts, Governing), RunError> {
        let (points, length) = (scene.numerics.points as usize, scene.length);
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
        // Measured heights are already in metres.
        let scale = if measured.is_some() { 1.0 } else { rms_height };
        let modes = rough.and_then(|rough| rough.modes);
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
        if self.line.as_ref().is_none_or(|(of, _)| *of != key) {
            let line = self.lay_line(scene, &key)?;
            self.profile = Some(profile_of(&line, nominal_form(scene))?);
            self.line = Some((key, line));
        }
        let Some((_, line)) = &self.line else {
            return Err(
                ContactError::Internal("the profile of the scene has not been made").into(),
            );
        };
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

    /// Returns the profile of a scene in the type that a [`Contact`] needs.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::make_line`].
    pub fn profile(&mut self, scene: &CheckedScene) -> Result<Profile, RunError> {
        self.line_of(scene)?;
        Ok(self.made()?.clone())
    }

    /// Returns the profile that was made last.
    fn made(&self) -> Result<&Profile, ContactError> {
        self.profile.as_ref().ok_or(ContactError::Internal(
            "the profile of the scene has not been made",
        ))
    }

    /// Makes a profile from the heights of its roughness and its form.
    fn lay_line(&mut self, scene: &Scene, key: &LineKey) -> Result<Line, RunError> {
        let LineKey {
            scale,
            length,
            points,
            ..
        } = *key;
        self.histogram = None;
        // Nothing else uses the springs unless a caller has kept a leg.
        if let Some(profile) = self.profile.take() {
            self.former_tree = profile.into_tree();
        }
        let mut memory = self
            .line
            .take()
            .and_then(|(_, line)| Arc::into_inner(line.gaps))
            .unwrap_or_default();
        if let (Some(of), Some(rough)) = (&key.roughness, &self.roughness)
            && rough.heights.is_empty()
        {
            self.roughen(scene, of, take(&mut memory))?;
        }
        if let Some(rough) = self.roughness.as_mut().filter(|_| self.single) {
            memory = take(&mut rough.heights);
        } else {
            memory = emptied(memory, points).map_err(SurfaceError::of_springs)?;
            let heights = self
                .roughness
                .as_ref()
                .map_or(&[][..], |rough| &rough.heights);
            memory.extend_from_slice(heights);
            memory.resize(points, 0.0);
        }
        Ok(Line::from_roughness(
            memory,
            length,
            scene.form.as_ref(),
            scale,
        )?)
    }

    /// Makes the heights of a roughness. Random heights use the memory `memory`.
    fn roughen(
        &mut self,
        scene: &Scene,
        key: &RoughnessKey,
        memory: Vec<f64>,
    ) -> Result<(), RunError> {
        // The transform allocates its own memory, and would end the process on failure.
        check_room(Workload::of_any(scene).line_bytes()).map_err(SurfaceError::of_springs)?;
        self.roughness = Some(self.maker.make(key.clone(), memory)?);
        if self.single {
            self.maker.synthesizer = Synthesizer::default();
        }
        Ok(())
    }

    /// Makes the histogram and the contact tree of the profile, if the plan requires them and they
    /// are missing. Returns the number of heights sorted into bins.
    fn look_at_line(&mut self, plan: &Workload, edges: Edges) -> Result<u64, ContactError> {
        let memory = take(&mut self.former_tree);
        if plan.runs(Stage::Tree) {
            self.made()?.build_tree(edges, memory)?;
        }
        let line = self
            .line()
            .filter(|_| plan.runs(Stage::HeightHistogram) && self.histogram.is_none());
        let Some(line) = line else { return Ok(0) };
        let binned = line.gaps.len() as u64;
        self.histogram = Some(Histogram::new(
            line.heights(),
            line.lowest(),
            line.summit,
            HISTOGRAM_BINS,
        ));
        Ok(binned)
    }

    /// Checks before any allocation that there is enough memory for a run. Kept memory counts. It
    /// is released if it is far too large or leaves too little room.
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

    /// Makes the profile and the contact of a checked scene, as this plan requires.
    pub(super) fn prepare(
        &mut self,
        plan: &Workload,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
    ) -> Result<Prepared, RunError> {
        let interrupted = || {
            if stop() {
                Err(ContactError::Interrupted)
            } else {
                Ok(())
            }
        };
        let mut timings = Timings::default();
        self.make_room(plan.peak_bytes)?;

        let drawn_before = self.maker.phases_drawn;
        let clock = Instant::now();
        let (_, facts, governing) = self.line_of(scene)?;
        timings.line = clock.elapsed().as_secs_f64();
        interrupted()?;
        let random_phases = self.maker.phases_drawn - drawn_before;

        let (clock, edges) = (Instant::now(), scene.numerics.edges);
        let heights_binned = self.look_at_line(plan, edges)?;
        timings.tree = clock.elapsed().as_secs_f64();
        interrupted()?;

        let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
        let contact = governing
            .contact(self.made()?)?
            .edges(edges)
            .loading_stiffness(stiffness)
            .build()?;
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

    /// Returns the premises of the model that a scene does not meet before its loading: those of
    /// its fields, its measured surface and its profile.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::make_line`].
    pub fn warnings(&mut self, scene: &CheckedScene) -> Result<Vec<Warning>, RunError> {
        let (.., governing) = self.line_of(scene)?;
        Ok(self.warnings_before_loading(scene, &governing)?)
    }

    /// Returns the premises that a scene does not meet before its loading, once its profile is
    /// made.
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

    /// Computes all results of a scene. `after` is called after each loading stage. The run ends
    /// soon after `stop` returns true.
    ///
    /// # Errors
    /// Returns an error if a part of the computation fails or if `stop` returned true.
    pub fn run(
        &mut self,
        scene: &CheckedScene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        let plan = Workload::of(scene);
        let made = self.prepare(&plan, scene, stop)?;
        let Prepared {
            contact,
            facts,
            governing,
            random_phases,
            heights_binned,
            mut timings,
            warnings: of_scene,
        } = made;
        reach::check(&contact, &scene.loading)?;
        let on_foundation = |patch: Patch| Patch {
            first: patch.first + facts.first,
            last: patch.last + facts.first,
        };

        let (clock, mut stage, mut fragments) = (Instant::now(), 0, Vec::new());
        let mut see = |record: &LegRecord, leg: &Leg| {
            if stop() {
                return Err(ContactError::Interrupted);
            }
            if plan.runs(Stage::Fragments) {
                let patches = record
                    .end_in_contact()
                    .map_or_else(Vec::new, |end| leg.patches(end.indentation));
                fragments.push(patches.into_iter().map(on_foundation).collect());
            }
            stage += 1;
            after(stage - 1, record, leg)
        };
        let without_preload = plan.runs(Stage::WithoutPreload);
        let (mut history, without_preload) = load(
            scene,
            &contact,
            without_preload,
            &mut timings,
            stop,
            &mut see,
        )?;
        timings.passes =
            (clock.elapsed().as_secs_f64() - timings.curve - timings.without_preload).max(0.0);
        history
            .contacts
            .iter_mut()
            .for_each(|contact| *contact = on_foundation(*contact));
        let transforms = u64::from(random_phases > 0);
        let work = &mut history.work;
        (work.random_phases, work.transforms, work.heights_binned) =
            (random_phases, transforms, heights_binned);

        let mut warnings = history.warnings(contact.profile());
        warnings.extend(of_scene);
        let figures = Figures::of(&history);
        let [first_touch_adhesion_force, zero_force_adhesion_force] = without_preload;
        let (work, modulus, length) = (
            governing.adhesive_work(),
            governing.effective_modulus,
            scene.length,
        );
        let smooth = self.smooth_adhesion_force(scene, &governing, &figures)?;
        let regime = |without_preload| Regime::of_loading(&figures, without_preload, smooth);
        Ok(Outcome {
            line: facts,
            governing,
            ideal_adhesion_force: work
                .map(|work| ClosedForm::ideal_adhesion_force(work, modulus, length)),
            smooth_adhesion_force: smooth,
            first_touch_adhesion_force,
            zero_force_adhesion_force,
            tabor_number: governing.tabor_number(scene),
            steep_waves: SteepWaves::of(scene, &governing),
            regime: regime(first_touch_adhesion_force),
            regime_after_zero_force: regime(zero_force_adhesion_force),
            instrument: scene
                .loading_stiffness
                .map(|k| InstrumentFigures::of(&history, &figures, k)),
            figures,
            history,
            fragments,
            histogram: self
                .histogram
                .as_ref()
                .filter(|_| plan.runs(Stage::HeightHistogram))
                .cloned(),
            warnings,
            timings,
        })
    }
}

/// Returns the profile of a contact on the springs under a line, with the form of the body.
pub(crate) fn profile_of(line: &Line, nominal_form: NominalForm) -> Result<Profile, ContactError> {
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing)?;
    let placed = profile
        .on_foundation(line.length, line.first)?
        .with_summit(line.summit)?;
    Ok(placed.with_nominal_form(nominal_form))
}

/// Returns the form of the body of a scene. Measured heights that are the profile itself have a
/// form that nobody states.
pub(crate) fn nominal_form(scene: &Scene) -> NominalForm {
    match &scene.form {
        Some(form) if form.flat_end().is_none() => NominalForm::Curved,
        None if scene.measured_as_line() => NominalForm::Unstated,
        Some(_) | None => NominalForm::Flat,
    }
}

/// Loads a contact with the solver of the scene. Returns its history, and F_a(d=0) and F_a(F=0) in
/// N where the contact pulls and `without_preload` is true.
fn load(
    scene: &Scene,
    contact: &Contact,
    without_preload: bool,
    timings: &mut Timings,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&LegRecord, &Leg) -> Result<(), ContactError>,
) -> Result<(History, [Option<f64>; 2]), ContactError> {
    let samples = scene.numerics.samples as usize;
    let mut forces = [None; 2];
    match scene.numerics.solver {
        SolverChoice::Stepwise { step } => {
            let body = |samples| Stepwise::new(contact, step, samples, stop);
            let mut solver = body(samples)?;
            let mut history = load_body(&mut solver, &scene.loading, see)?;
            timings.curve = solver.curve_seconds();
            if without_preload {
                let clock = Instant::now();
                for (force, turn) in forces.iter_mut().zip([Move::ToTouch, Move::ToZeroForce]) {
                    let turned = match load_body(
                        &mut body(2)?,
                        &[turn, Move::ToSeparation],
                        |_, _| Ok(()),
                    ) {
                        Err(ContactError::Interrupted) => return Err(ContactError::Interrupted),
                        // A turn out of reach of the steps has no F_a(d=0).
                        Err(_) => continue,
                        Ok(turned) => turned,
                    };
                    *force = Figures::of(&turned).adhesion_force;
                    let work = &mut history.work;
                    work.steps += turned.work.steps;
                    work.relaxation_sweeps += turned.work.relaxation_sweeps;
                    work.spring_updates += turned.work.spring_updates;
                }
                timings.without_preload = clock.elapsed().as_secs_f64();
            }
            Ok((history, forces))
        }
        SolverChoice::Exact => {
            let mut body = Body::new(contact, samples);
            let mut history = load_body(&mut body, &scene.loading, see)?;
            timings.curve = body.curve_seconds();
            if without_preload && contact.has_adhesion() {
                let clock = Instant::now();
                forces = body.adhesion_without_preload()?;
                history.work = body.work();
                timings.without_preload = clock.elapsed().as_secs_f64();
            }
            Ok((history, forces))
        }
    }
}
