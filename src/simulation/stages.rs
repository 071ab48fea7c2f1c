//! Runs the stages of a scene, and only those whose input has changed since the last run.

use super::{LineFacts, Outcome, Plan, RunError, Stage, Timings};
use crate::analysis::{Amplitude, Figures, Governing, Regime, RegimeEvidence, ideal_adhesion_force};
use crate::contact::{
    ContactError, ContactTree, Foundation, GridEdges, HessRule, History, LegRecord, Solver, Stepwise, exact,
    run,
};
use crate::reference::smooth_adhesion_force;
use crate::scene::{Form, Leg, Roughness, Scene, Solver as SolverChoice};
use crate::surface::{Histogram, Line, MeasuredProfile, SelfAffine, UnitRoughness};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Bins of the height histogram.
const HISTOGRAM_BINS: usize = 64;

/// The line, the tree and what they were made from: kept from run to run, so that a changed parameter
/// repeats the stages from the first one it touches and no other.
#[derive(Default)]
pub struct Simulation {
    folder: PathBuf,
    roughness: Option<(RoughnessKey, Rough)>,
    line: Option<(LineKey, Line)>,
    tree: Option<Arc<ContactTree>>,
    /// Whether the tree is that of the line, rather than of one before.
    tree_is_current: bool,
}

/// What the heights of the roughness depend on.
#[derive(Clone, PartialEq)]
enum RoughnessKey {
    SelfAffine { spectrum: SelfAffine, seed: u64, points: usize },
    Measured { file: PathBuf, length: f64, points: usize },
}

/// Heights of the roughness, before they are scaled.
struct Rough {
    heights: Vec<f64>,
    random_phases: u64,
    /// Rms gradient over rms height of the self-affine line on a length of 1 m.
    gradient_per_height: Option<f64>,
    /// Amplitude of a measured profile.
    measured: Option<Amplitude>,
}

/// What the line depends on.
#[derive(Clone, PartialEq)]
struct LineKey {
    roughness: Option<RoughnessKey>,
    scale: f64,
    length: f64,
    points: usize,
    form: Option<Form>,
}

/// Called after each leg with its index, its record and the solver as it then stands; an error stops
/// the run.
pub type AfterLeg<'a> = dyn FnMut(usize, &LegRecord, &dyn Solver) -> Result<(), ContactError> + 'a;

impl Simulation {
    /// A simulation that looks for measured profiles in `folder`.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Simulation { folder, ..Simulation::default() }
    }

    /// The line of the last scene made.
    #[must_use]
    pub fn line(&self) -> Option<&Line> {
        self.line.as_ref().map(|(_, line)| line)
    }

    /// The tree of that line, where its scene called for one.
    #[must_use]
    pub fn tree(&self) -> Option<&Arc<ContactTree>> {
        self.tree.as_ref().filter(|_| self.tree_is_current)
    }

    /// Makes the line of a checked scene, unless the last one was the same, and tells what is known
    /// of it.
    ///
    /// # Errors
    /// When it does not fit into memory or a measured profile cannot be read.
    pub fn make_line(&mut self, scene: &Scene) -> Result<(&Line, LineFacts, Governing), RunError> {
        let points = scene.numerics.points as usize;
        let spectrum = spectrum(scene);
        let key = self.roughness_key(scene, spectrum, points);
        if self.roughness.as_ref().map(|(key, _)| key) != key.as_ref() {
            self.roughness = None;
            if let Some(key) = &key {
                self.roughness = Some((key.clone(), make_roughness(key)?));
            }
        }
        let rough = self.roughness.as_ref().map(|(_, rough)| rough);
        let ratio = rough.and_then(|rough| rough.gradient_per_height).map(|ratio| ratio / scene.length);
        let governing = Governing::of(scene, ratio, rough.and_then(|rough| rough.measured));
        let scale = match &key {
            // Measured heights are metres already.
            Some(RoughnessKey::Measured { .. }) => 1.0,
            _ => governing.amplitude.map_or(0.0, |amplitude| amplitude.rms_height),
        };
        let key = LineKey { roughness: key, scale, length: scene.length, points, form: scene.form };
        let kept = self.line.take().filter(|(kept, _)| *kept == key);
        let (key, line) = match kept {
            Some(line) => line,
            None => {
                self.tree_is_current = false;
                let heights = rough.map(|rough| rough.heights.as_slice());
                let line = Line::new(scene.length, points, scene.form.as_ref(), heights, scale)?;
                (key, line)
            }
        };
        let facts = LineFacts {
            points,
            length: scene.length,
            spacing: line.spacing,
            first: line.first,
            summit: line.summit,
            deepest: line.deepest(),
            modes: spectrum.map(|(spectrum, _)| (spectrum.first, spectrum.last)),
            seed: spectrum.map(|(_, seed)| seed),
            continuum_rms_gradient: spectrum.zip(governing.amplitude).map(|((spectrum, _), amplitude)| {
                amplitude.rms_height * spectrum.continuum_gradient_per_height(scene.length)
            }),
        };
        let (_, line) = self.line.insert((key, line));
        Ok((line, facts, governing))
    }

    fn roughness_key(
        &self,
        scene: &Scene,
        spectrum: Option<(SelfAffine, u64)>,
        points: usize,
    ) -> Option<RoughnessKey> {
        if let Some((spectrum, seed)) = spectrum {
            return Some(RoughnessKey::SelfAffine { spectrum, seed, points });
        }
        match &scene.roughness {
            Some(Roughness::Measured { file }) => Some(RoughnessKey::Measured {
                file: self.folder.join(Path::new(file)),
                length: scene.length,
                points,
            }),
            _ => None,
        }
    }

    /// Runs a checked scene by its plan. `stop` is asked now and then whether to give up; `after` sees
    /// each leg of the scene's own loading.
    ///
    /// # Errors
    /// When a stage fails or `stop` says so; what was made before is kept for the next run.
    pub fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        let plan = Plan::of(scene);
        let mut timings = Timings::default();
        let interrupted = || if stop() { Err(ContactError::Interrupted) } else { Ok(()) };

        let had_roughness = self.roughness.as_ref().map(|(key, _)| key.clone());
        let clock = Instant::now();
        let (_, facts, governing) = self.make_line(scene)?;
        timings.line = clock.elapsed().as_secs_f64();
        interrupted()?;
        let made_roughness = self.roughness.as_ref().filter(|(key, _)| Some(key) != had_roughness.as_ref());
        let random_phases = made_roughness.map_or(0, |(_, rough)| rough.random_phases);

        let Some((_, line)) = &self.line else { return Err(ContactError::Interrupted.into()) };
        let clock = Instant::now();
        if plan.runs(Stage::Tree) && !self.tree_is_current {
            self.tree = Some(Arc::new(match self.tree.take().and_then(Arc::into_inner) {
                Some(before) => before.rebuild(&line.gaps)?,
                None => ContactTree::build(&line.gaps)?,
            }));
            self.tree_is_current = true;
        }
        timings.tree = clock.elapsed().as_secs_f64();
        interrupted()?;

        let foundation = Foundation { spacing: line.spacing, effective_modulus: governing.effective_modulus };
        let hess = governing
            .adhesive_work()
            .filter(|_| plan.runs(Stage::RuleOfHess))
            .map(|work| HessRule::new(foundation, work));
        let contact = ContactStage { line, tree: self.tree.as_deref(), foundation, hess, scene, stop };

        let clock = Instant::now();
        let mut fragments = Vec::new();
        let mut observe = |leg: usize, record: &LegRecord, solver: &dyn Solver| {
            if plan.runs(Stage::Fragments) {
                fragments.push(contact.fragments_after(record, solver));
            }
            after(leg, record, solver)
        };
        let (mut history, curve) =
            contact.run(&scene.loading, scene.numerics.samples as usize, &mut observe)?;
        timings.curve = curve;
        timings.passes = (clock.elapsed().as_secs_f64() - curve).max(0.0);
        history.work.random_phases = random_phases;
        history.work.transforms = u64::from(random_phases > 0);

        let figures = Figures::of(&history);
        let clock = Instant::now();
        let zero_load_adhesion_force = if plan.runs(Stage::ZeroLoadAdhesion) {
            let legs = [Leg::ToTouch, Leg::ToSeparation];
            let (touch, _) = contact.run(&legs, 2, &mut |_, _, _| Ok(()))?;
            Figures::of(&touch).adhesion_force
        } else {
            figures.adhesion_force.filter(|_| hess.is_some() && Figures::is_touch_protocol(scene))
        };
        timings.zero_load = clock.elapsed().as_secs_f64();

        let form = scene.form.as_ref();
        let modulus = governing.effective_modulus;
        let work = governing.adhesive_work();
        let smooth = work.map(|work| smooth_adhesion_force(form, scene.length, modulus, work));
        let regime = match (figures.adhesion_force, zero_load_adhesion_force, smooth) {
            (Some(_), None, None) => Some(Regime::NonAdhesive),
            (Some(adhesion), Some(zero_load_adhesion), Some(smooth_adhesion)) => {
                let preload = figures.preload.unwrap_or(0.0);
                Some(RegimeEvidence { zero_load_adhesion, adhesion, preload, smooth_adhesion }.regime())
            }
            _ => None,
        };
        let histogram = plan.runs(Stage::HeightHistogram).then(|| {
            history.work.heights_binned = line.gaps.len() as u64;
            let low = line.summit - facts.deepest;
            Histogram::new(line.heights(), low, line.summit, HISTOGRAM_BINS)
        });
        Ok(Outcome {
            line: facts,
            governing,
            ideal_adhesion_force: work.map(|work| ideal_adhesion_force(work, modulus, scene.length)),
            smooth_adhesion_force: smooth,
            zero_load_adhesion_force,
            regime,
            figures,
            history,
            fragments,
            histogram,
            timings,
        })
    }
}

/// The contact stage of one run, for any loading.
struct ContactStage<'a> {
    line: &'a Line,
    tree: Option<&'a ContactTree>,
    foundation: Foundation,
    hess: Option<HessRule>,
    scene: &'a Scene,
    stop: &'a dyn Fn() -> bool,
}

impl ContactStage<'_> {
    /// Runs a loading with the solver of the scene; also gives the seconds spent on curves.
    fn run(
        &self,
        loading: &[Leg],
        samples: usize,
        after: &mut AfterLeg<'_>,
    ) -> Result<(History, f64), ContactError> {
        let gaps = self.line.gaps.as_slice();
        let mut solver: Box<dyn Solver + '_> = match (self.scene.numerics.solver, self.hess, self.tree) {
            (SolverChoice::Stepwise { step }, hess, _) => {
                Box::new(Stepwise::new(gaps, hess, self.foundation, step, samples, self.stop)?)
            }
            (SolverChoice::Exact, Some(hess), Some(tree)) => {
                Box::new(exact::adhesive(tree, GridEdges::new(hess), self.foundation, samples)?)
            }
            (SolverChoice::Exact, _, _) => Box::new(exact::bare(gaps, self.foundation, samples)),
        };
        let mut leg = 0;
        let mut history = run(solver.as_mut(), loading, |record, solver| {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            after(leg, record, solver)?;
            leg += 1;
            Ok(())
        })?;
        for contact in &mut history.contacts {
            *contact = self.on_foundation(*contact);
        }
        Ok((history, solver.curve_seconds()))
    }

    /// The fragments in contact where a leg ended.
    fn fragments_after(&self, record: &LegRecord, solver: &dyn Solver) -> Vec<(usize, usize)> {
        match record.curve.last() {
            Some(end) if end.springs > 0 => {
                solver.fragments(end.indentation).into_iter().map(|run| self.on_foundation(run)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Springs under the body counted from the first spring of the foundation.
    fn on_foundation(&self, (first, last): (usize, usize)) -> (usize, usize) {
        (first + self.line.first, last + self.line.first)
    }
}

fn spectrum(scene: &Scene) -> Option<(SelfAffine, u64)> {
    match scene.roughness {
        Some(Roughness::SelfAffine { hurst, modes: (first, last), seed, .. }) => {
            Some((SelfAffine { hurst, first, last }, seed))
        }
        _ => None,
    }
}

fn make_roughness(key: &RoughnessKey) -> Result<Rough, RunError> {
    match key {
        RoughnessKey::SelfAffine { spectrum, seed, points } => {
            let unit = UnitRoughness::synthesize(*spectrum, *seed, *points)?;
            Ok(Rough {
                heights: unit.heights,
                random_phases: unit.random_phases,
                gradient_per_height: Some(spectrum.gradient_per_height(1.0)),
                measured: None,
            })
        }
        RoughnessKey::Measured { file, length, points } => {
            let profile = MeasuredProfile::read(file)?;
            let (rms_height, rms_gradient) = profile.rms_height_and_gradient();
            let heights = profile.sample(*length, *points).map_err(|reason| {
                crate::surface::SurfaceError::Measured { file: file.display().to_string(), reason }
            })?;
            let measured = Some(Amplitude { rms_height, rms_gradient });
            Ok(Rough { heights, random_phases: 0, gradient_per_height: None, measured })
        }
    }
}
