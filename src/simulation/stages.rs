//! Execution of the stages of a scene whose input has changed since the last run.

use super::cached::Cached;
use super::contact_stage::ContactStage;
use super::roughness::{Rough, RoughnessKey, RoughnessMaker, spectrum};
use super::{LineFacts, Outcome, Plan, RunError, Stage, Timings};
use crate::analysis::{Figures, Governing, Regime, SteepWaves, ideal_adhesion_force, scene_tabor_number};
use crate::contact::{Contact, ContactError, ContactTree, Leg, LegRecord, Springs, Workspace};
use crate::memory::check_room;
use crate::parallel::in_parallel;
use crate::reference::smooth_adhesion_force;
use crate::scene::{Edges, Form, Scene};
use crate::surface::{Histogram, Line, MeasuredRoughness, SurfaceError, Synthesizer};
use std::mem::take;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Bins of the height histogram.
const HISTOGRAM_BINS: usize = 64;
/// Number of springs below which another thread takes longer to start than it saves.
pub(super) const MANY_SPRINGS: usize = 1 << 15;

/// Factor of the springs of the next run above which the memory of the last one is released.
const MOST_SPARE: usize = 4;
/// Error of a stage before its profile.
const NO_PROFILE: ContactError = ContactError::Internal("the profile of the scene has not been made");
/// Bytes that are always kept.
const SMALL: u64 = 32 << 20;

/// The profile, the tree and their inputs: kept from run to run, so that a changed parameter repeats only the
/// stages that depend on it. Repeated stages reuse their memory.
///
/// Between runs at most the memory is kept that a scene with four times the springs of the last one takes
/// ([`Plan::peak_bytes`], and 20 bytes for each spring of a Fourier transform), or 32 MiB. Released memory returns
/// to the allocator; that of glibc keeps blocks of less than 32 MiB, up to 64 MiB for each thread.
#[derive(Default)]
pub struct Simulation {
    /// True for a single scene: memory for another one is released at once.
    single: bool,
    maker: RoughnessMaker,
    roughness: Cached<RoughnessKey, Rough>,
    line: Cached<LineKey, Line>,
    /// Histogram of the heights of the profile, once observed.
    histogram: Option<Histogram>,
    /// Springs of the profile.
    springs: Arc<Springs>,
    /// Memory of the tree of a former profile.
    former_tree: ContactTree,
    memory: Workspace,
    kept: Kept,
}

/// Largest run whose memory is still kept.
#[derive(Clone, Copy, Default)]
struct Kept {
    points: usize,
    bytes: u64,
}

/// Parameters of the profile.
#[derive(Clone, PartialEq)]
struct LineKey {
    roughness: Option<RoughnessKey>,
    scale: f64,
    length: f64,
    points: usize,
    form: Option<Form>,
}

/// Contact of a scene before its stage, with the results of making its profile and tree.
pub(super) struct Prepared<'a> {
    pub contact: ContactStage<'a>,
    pub memory: &'a mut Workspace,
    facts: LineFacts,
    governing: Governing,
    random_phases: u64,
    heights_binned: u64,
    /// Times of profile and tree, s.
    timings: Timings,
}

/// Called after each loading stage with its index, its record and its leg; an error stops the run.
pub type AfterLeg<'a> = dyn FnMut(usize, &LegRecord, &Leg) -> Result<(), ContactError> + 'a;

impl Simulation {
    /// A simulation with measured profiles in `folder`.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Simulation { maker: RoughnessMaker::new(folder, None), ..Simulation::default() }
    }

    /// Frees the memory of the Fourier transform before the contact is solved, and makes the gaps of the profile in
    /// the memory of its heights: less memory for a single scene, more time for each further profile.
    #[must_use]
    pub fn for_one_scene(self) -> Self {
        Simulation { single: true, ..self }
    }

    /// Uses a measured surface in memory instead of the file of any scene.
    #[must_use]
    pub fn with_measured(mut self, measured: Arc<MeasuredRoughness>) -> Self {
        self.maker.measured = Some(measured);
        self
    }

    /// The profile of the last scene.
    #[must_use]
    pub fn line(&self) -> Option<&Line> {
        self.line.value()
    }

    /// Makes the profile of a checked scene, unless unchanged since the last one, and returns its known values.
    ///
    /// # Errors
    /// Insufficient memory or an unreadable measured profile.
    pub fn make_line(&mut self, scene: &Scene) -> Result<(&Line, LineFacts, Governing), RunError> {
        let points = scene.numerics.points as usize;
        let spectrum = spectrum(scene);
        let key = self.maker.key(scene);
        if key.as_ref().is_none_or(|key| self.roughness.get(key).is_none()) {
            let before = self.roughness.take().map(|rough| rough.heights);
            if let Some(key) = &key {
                self.roughen(scene, key, before.unwrap_or_default())?;
            }
        }
        let rough = self.roughness.value();
        let unit = rough.and_then(|rough| rough.unit).map(|unit| unit.stretched(scene.length));
        let governing = Governing::of(scene, unit, rough.and_then(|rough| rough.measured));
        // Measured heights are already in metres.
        let in_metres = key.as_ref().is_some_and(RoughnessKey::is_measured);
        let rms_height = governing.amplitude.map_or(0.0, |amplitude| amplitude.rms_height);
        let scale = if in_metres { 1.0 } else { rms_height };
        let key = LineKey { roughness: key, scale, length: scene.length, points, form: scene.form };
        let modes = rough.and_then(|rough| rough.modes);
        if self.line.get(&key).is_none() {
            let line = self.lay_line(scene, &key)?;
            self.springs = Arc::new(Springs::new(Arc::clone(&line.gaps)));
            self.line.keep(key, line);
        }
        let Some(line) = self.line.value() else { return Err(NO_PROFILE.into()) };
        let facts = LineFacts {
            points,
            length: scene.length,
            spacing: line.spacing,
            first: line.first,
            summit: line.summit,
            deepest: self.springs.deepest(),
            modes,
            seed: scene.seed(),
            continuum_rms_gradient: spectrum.zip(governing.amplitude).map(|((spectrum, _), amplitude)| {
                amplitude.rms_height * spectrum.continuum_gradient_per_height(scene.length)
            }),
        };
        Ok((line, facts, governing))
    }

    /// Makes a profile from the heights of its roughness.
    fn lay_line(&mut self, scene: &Scene, key: &LineKey) -> Result<Line, RunError> {
        let LineKey { scale, length, points, .. } = *key;
        self.histogram = None;
        // Nothing else uses the springs unless a caller has kept a leg.
        if let Some(springs) = Arc::into_inner(take(&mut self.springs)) {
            self.former_tree = springs.into_tree();
        }
        let mut memory = self.line.take().and_then(|line| Arc::into_inner(line.gaps)).unwrap_or_default();
        if let (Some(of), Some(rough)) = (&key.roughness, self.roughness.value())
            && rough.heights.is_empty()
        {
            self.roughen(scene, of, take(&mut memory))?;
        }
        let form = scene.form.as_ref();
        let line = match self.roughness.value_mut() {
            Some(rough) if self.single => Line::from_roughness(take(&mut rough.heights), length, form, scale),
            rough => {
                let heights = rough.map(|rough| rough.heights.as_slice());
                Line::new_in(memory, length, points, form, heights, scale)
            }
        };
        Ok(line?)
    }

    /// Makes the heights of a roughness; synthesised ones in this memory.
    fn roughen(&mut self, scene: &Scene, key: &RoughnessKey, memory: Vec<f64>) -> Result<(), RunError> {
        let points = scene.numerics.points as usize;
        // The transform allocates its own memory, and would end the process on failure.
        check_room(Plan::of(scene).line_bytes()).map_err(|_| SurfaceError::OutOfMemory(points))?;
        self.roughness.keep(key.clone(), self.maker.make(key, memory)?);
        if self.single {
            self.maker.synthesizer = Synthesizer::default();
        }
        Ok(())
    }

    /// Makes the missing parts of the profile required by the plan: its histogram and its tree. Returns the number
    /// of heights sorted into bins.
    fn look_at_line(&mut self, plan: &Plan, edges: Edges) -> Result<u64, ContactError> {
        let Some(line) = self.line.value() else { return Err(NO_PROFILE) };
        let count = plan.runs(Stage::HeightHistogram) && self.histogram.is_none();
        let build = plan.runs(Stage::Tree) && !self.springs.has_tree(edges);
        let (springs, memory) = (&self.springs, take(&mut self.former_tree));
        let aside = || {
            let histogram = || Histogram::new(line.heights(), line.lowest(), line.summit, HISTOGRAM_BINS);
            count.then(histogram)
        };
        let (histogram, built) =
            in_parallel(count && build && line.gaps.len() >= MANY_SPRINGS, aside, || {
                build.then(|| springs.tree_in(memory, edges))
            });
        built.transpose()?;
        self.histogram = histogram.or(self.histogram.take());
        Ok(if count { line.gaps.len() as u64 } else { 0 })
    }

    /// Checks the memory of a run before any allocation: kept memory counts, and is released if it is far too large
    /// or in the way.
    fn make_room(&mut self, plan: &Plan, points: usize) -> Result<(), RunError> {
        let needed = plan.peak_bytes;
        if self.kept.points / MOST_SPARE > points && self.kept.bytes > SMALL {
            self.give_back();
        }
        if check_room(needed.saturating_sub(self.kept.bytes)).is_err() {
            self.give_back();
            check_room(needed).map_err(|_| RunError::OutOfMemory { bytes: needed })?;
        }
        self.kept = Kept { points: self.kept.points.max(points), bytes: self.kept.bytes.max(needed) };
        Ok(())
    }

    /// Releases the memory of earlier runs.
    fn give_back(&mut self) {
        let maker = take(&mut self.maker).emptied();
        *self = Simulation { single: self.single, maker, ..Simulation::default() };
    }

    /// Makes profile and tree of a checked scene for a contact by this plan.
    pub(super) fn prepare<'a>(
        &'a mut self,
        plan: &Plan,
        scene: &'a Scene,
        stop: &'a dyn Fn() -> bool,
    ) -> Result<Prepared<'a>, RunError> {
        let interrupted = || if stop() { Err(ContactError::Interrupted) } else { Ok(()) };
        let mut timings = Timings::default();
        self.make_room(plan, scene.numerics.points as usize)?;

        let drawn_before = self.maker.phases_drawn;
        let clock = Instant::now();
        let (_, facts, governing) = self.make_line(scene)?;
        timings.line = clock.elapsed().as_secs_f64();
        interrupted()?;
        let random_phases = self.maker.phases_drawn - drawn_before;

        let clock = Instant::now();
        let heights_binned = self.look_at_line(plan, scene.numerics.edges)?;
        timings.tree = clock.elapsed().as_secs_f64();
        interrupted()?;

        let Some(line) = self.line.value() else { return Err(NO_PROFILE.into()) };
        let foundation = governing.foundation(line);
        let hess = governing.hess_rule(foundation).filter(|_| plan.runs(Stage::RuleOfHess));
        let (springs, edges) = (Arc::clone(&self.springs), scene.numerics.edges);
        let contact = Contact { springs, foundation, edges, hess };
        let contact = ContactStage { contact, first: line.first, scene, stop };
        let memory = &mut self.memory;
        Ok(Prepared { contact, memory, facts, governing, random_phases, heights_binned, timings })
    }

    /// Runs a checked scene by its plan. `stop` is polled now and then; `after` sees each stage of the scene's own
    /// loading.
    ///
    /// # Errors
    /// A failure of a stage or a stop; earlier results are kept for the next run.
    pub fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        let plan = Plan::of(scene);
        let made = self.prepare(&plan, scene, stop)?;
        let Prepared { contact, memory, facts, governing, random_phases, heights_binned, mut timings } = made;
        let adheres = contact.contact.hess.is_some();

        let clock = Instant::now();
        let mut fragments = Vec::new();
        let mut observe = |stage: usize, record: &LegRecord, leg: &Leg| {
            if plan.runs(Stage::Fragments) {
                fragments.push(contact.fragments_after(record, leg));
            }
            after(stage, record, leg)
        };
        let contacted = contact.run(plan.runs(Stage::ZeroLoadAdhesion), memory, &mut observe)?;
        timings.curve = contacted.curve_seconds;
        timings.zero_load = contacted.zero_load_seconds;
        timings.passes = (clock.elapsed().as_secs_f64() - timings.curve - timings.zero_load).max(0.0);
        let mut history = contacted.history;
        history.work.random_phases = random_phases;
        history.work.transforms = u64::from(random_phases > 0);
        history.work.heights_binned = heights_binned;

        let figures = Figures::of(&history);
        let zero_load_adhesion_force = if plan.runs(Stage::ZeroLoadAdhesion) {
            contacted.zero_load_adhesion_force
        } else {
            figures.adhesion_force.filter(|_| adheres && Figures::is_touch_protocol(scene))
        };

        let form = scene.form.as_ref();
        let modulus = governing.effective_modulus;
        let work = governing.adhesive_work();
        let smooth = work.map(|work| smooth_adhesion_force(form, scene.length, modulus, work));
        let regime = Regime::of_loading(&figures, zero_load_adhesion_force, smooth);
        Ok(Outcome {
            line: facts,
            governing,
            ideal_adhesion_force: work.map(|work| ideal_adhesion_force(work, modulus, scene.length)),
            smooth_adhesion_force: smooth,
            zero_load_adhesion_force,
            tabor_number: scene_tabor_number(scene, &governing),
            steep_waves: SteepWaves::of(scene, &governing),
            regime,
            figures,
            history,
            fragments,
            histogram: self.histogram.as_ref().filter(|_| plan.runs(Stage::HeightHistogram)).cloned(),
            timings,
        })
    }
}
