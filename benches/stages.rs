//! Cost of each stage of an exact loop, and of a whole edit of a scene: in milliseconds, in
//! nanoseconds for each spring, and in units of one real Fourier transform of the same length
//! measured in the same run, which makes runs on different machines comparable. Loops with
//! relaxation are compared with elastic ones.
//!
//! `cargo bench --bench stages` prints the table. After `--`: `--quick` stops at 2^16 springs,
//! `--smallest 20` begins at 2^20, `--largest 18` stops at 2^18, and `--runs 9` sets the number of
//! repetitions, of which the shortest counts; `--hurst 0.2` and `--kappa 100` take other lines and
//! another adhesion, with ten times this κ beside it. Without `--bench`, as started by
//! `cargo test --benches`, it only checks that it runs.

use asperity::contact::ClosedForm;
use asperity::contact::motion::{Body, ContactTree, MovingBody, Stage};
use asperity::contact::{Contact, Edges, Modulus, Move, Profile, StageRecord, Work};
use asperity::scene::Simulation;
use asperity::scene::{Adhesion, CheckedScene, Document, RoughnessParameter};
use asperity::surface::SelfAffine;
use asperity::surface::lines::{Line, Synthesizer};
use asperity_fourier::{Complex64, RealToComplex, plan_real_forward};
use std::hint::black_box;
use std::mem::take;
use std::sync::Arc;
use std::time::Instant;

#[path = "stages/relaxing.rs"]
mod relaxing;

/// Largest cost of a whole loop at this length, in transforms, under either κ.
const BAR: (u32, [f64; 2]) = (20, [1.6, 2.6]);

const SAMPLES: usize = 512;
/// Turning points at equal forces up to the load.
const REVERSALS: u32 = 64;
const LENGTH: f64 = 1.0e-3;
const EFFECTIVE_MODULUS: f64 = 2.0e6;
const RMS_HEIGHT: f64 = 5.0e-7;
const HURST: f64 = 0.7;
/// Under this κ, lines as finely rough as these snap into full contact; under ten times as much,
/// part of them stays free, and springs attach and detach a few at a time.
const KAPPA: f64 = 2.0;
/// Both kinds of edges.
const EDGES: [Edges; 2] = [Edges::Grid, Edges::SubCell];
/// Load in units of E* L h.
const LOAD: f64 = 0.4;

fn main() {
    let options = Options::from_arguments(std::env::args().skip(1));
    println!(
        "self-affine line, H = {}, modes up to N/4, {SAMPLES} samples on each stage; shortest of {} runs",
        options.hurst, options.runs
    );
    println!(
        "Memory is kept from run to run, also that of the transform, which is planned beforehand. All but the"
    );
    println!("line and its histogram of heights takes one thread.\n");
    relaxing::print(options.runs, options.largest);
    let mut verdict = Vec::new();
    for exponent in (options.smallest..=options.largest).step_by(2) {
        let rough = Rough::new(exponent, options.hurst, options.kappas);
        let measured = measure(&rough, options.runs);
        measured.print(&rough);
        if exponent == BAR.0 {
            let ratios = |one: &Loop| {
                one.edges
                    .each_ref()
                    .map(|edges| edges.whole / measured.transform)
            };
            verdict = measured
                .loops
                .iter()
                .zip(BAR.1)
                .map(|(one, most)| (one.kappa, ratios(one), most))
                .collect();
        }
    }
    for (kappa, ratios, most) in verdict {
        for (edges, ratio) in EDGES.into_iter().zip(ratios) {
            let holds = if ratio <= most {
                "holds"
            } else {
                "does NOT hold"
            };
            println!(
                "whole loop at 2^{}, kappa = {kappa}, {edges:?}: {ratio:.2} FFTs; the bar of {most} {holds}",
                BAR.0
            );
        }
    }
}

struct Options {
    smallest: u32,
    largest: u32,
    runs: usize,
    hurst: f64,
    kappas: [f64; 2],
}

impl Options {
    fn from_arguments(arguments: impl Iterator<Item = String>) -> Self {
        let arguments: Vec<String> = arguments.collect();
        let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
        let value = |flag: &str| {
            let place = arguments.iter().position(|argument| argument == flag)?;
            arguments.get(place + 1)
        };
        let number = |flag: &str| value(flag)?.parse().ok();
        let real = |flag: &str, usual: f64| {
            value(flag)
                .and_then(|text| text.parse().ok())
                .unwrap_or(usual)
        };
        let (hurst, kappa) = (real("--hurst", HURST), real("--kappa", KAPPA));
        let kappas = [kappa, 10.0 * kappa];
        if has("--test") || !has("--bench") {
            return Options {
                smallest: 6,
                largest: 8,
                runs: 1,
                hurst,
                kappas,
            };
        }
        let largest = number("--largest").unwrap_or(if has("--quick") { 16 } else { 22 });
        let runs =
            number("--runs").map_or(if has("--quick") { 5 } else { 9 }, |runs| runs as usize);
        Options {
            smallest: number("--smallest").unwrap_or(12),
            largest,
            runs: runs.max(1),
            hurst,
            kappas,
        }
    }
}

/// A rough line, and a scene with this line.
struct Rough {
    spectrum: SelfAffine,
    points: usize,
    line: Line,
    rms_gradient: f64,
    scene: CheckedScene,
    kappas: [f64; 2],
}

impl Rough {
    fn new(exponent: u32, hurst: f64, kappas: [f64; 2]) -> Self {
        let points = 1_usize << exponent;
        let spectrum = SelfAffine {
            hurst,
            first: 1,
            last: points as u64 / 4,
            roll_off_mode: 0.0,
        };
        let line = synthesize(spectrum, points);
        let last = spectrum.last;
        let force = LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT;
        let scene = format!(
            "(version: 1, material: (youngs_modulus: {:e}, poisson_ratio: 0.5), length: {LENGTH:e}, \
             roughness: SelfAffine(hurst: {hurst}, rms_height: {RMS_HEIGHT:e}, modes: (1, {last}), seed: 1), \
             adhesion: (kappa: {}), loading: [ToForce({force:e}), ToSeparation], \
             numerics: (points: {points}, samples: {SAMPLES}), observe: [HeightHistogram])",
            0.75 * EFFECTIVE_MODULUS,
            kappas[0],
        );
        let scene = Document::parse(&scene, "bench")
            .expect("a valid scene")
            .scene()
            .clone();
        let rms_gradient = RMS_HEIGHT * spectrum.gradient_per_height(LENGTH);
        Rough {
            spectrum,
            points,
            line,
            rms_gradient,
            scene,
            kappas,
        }
    }

    /// γ = h⟨∇z⟩E*/κ², eq. (11).
    fn work_of_adhesion(&self, kappa: f64) -> f64 {
        RMS_HEIGHT * self.rms_gradient * EFFECTIVE_MODULUS / (kappa * kappa)
    }
}

fn synthesize(spectrum: SelfAffine, points: usize) -> Line {
    let rough = spectrum.heights(1, points).expect("memory for the line");
    Line::new(LENGTH, points, None, Some(&rough), RMS_HEIGHT).expect("a finite line")
}

/// Shortest seconds of each stage.
struct Measured {
    transform: f64,
    synthesis: f64,
    next_line: f64,
    fresh_tree: f64,
    loops: Vec<Loop>,
    edits: Edits,
}

/// Whole loops under one κ, with either kind of edges.
struct Loop {
    kappa: f64,
    edges: [Timed; 2],
}

/// Shortest seconds of a whole loop and of its parts, and its outcome.
#[derive(Default)]
struct Timed {
    tree: f64,
    passes: f64,
    curves: f64,
    whole: f64,
    /// All reversals from one tree and one loading.
    reversals: f64,
    records: Vec<StageRecord>,
    work: Work,
}

/// Measures all stages in turn, round after round: other load of the machine then affects all of
/// them alike.
fn measure(rough: &Rough, runs: usize) -> Measured {
    let gaps = &rough.line.gaps;
    let mut transform = Transform::planned(rough.points);
    let never = f64::INFINITY;
    let loops = rough.kappas.map(Loop::under).into();
    let edits = Edits::of(rough);
    let mut best = Measured {
        transform: never,
        synthesis: never,
        next_line: never,
        fresh_tree: never,
        loops,
        edits,
    };
    let mut lines = Lines::default();
    lines.seconds(rough, 0);
    // The memory of the tree is kept from run to run, like the buffers of the transform and as in a
    // simulation.
    let mut tree = ContactTree::default();
    for run in 0..runs {
        // The unit is a transform with its memory in the caches as far as it fits.
        for _ in 0..2 {
            best.transform = best.transform.min(transform.seconds(gaps));
        }

        let clock = Instant::now();
        black_box(synthesize(black_box(rough.spectrum), rough.points));
        best.synthesis = best.synthesis.min(seconds_since(clock));

        best.next_line = best.next_line.min(lines.seconds(rough, 1 + run as u64));

        let clock = Instant::now();
        let profile =
            Profile::from_gaps(Arc::clone(gaps), rough.line.spacing).expect("a finite line");
        profile
            .build_tree(Edges::SubCell, ContactTree::default())
            .expect("memory for the tree");
        black_box(profile);
        best.fresh_tree = best.fresh_tree.min(seconds_since(clock));

        for one in &mut best.loops {
            let work = rough.work_of_adhesion(one.kappa);
            for (edges, timed) in EDGES.into_iter().zip(&mut one.edges) {
                tree = timed.measure(tree, edges, work, rough);
            }
        }
        best.edits.measure(rough, run);
    }
    best
}

/// Lines of one seed after the other, each in the memory of the previous one.
#[derive(Default)]
struct Lines {
    synthesizer: Synthesizer,
    heights: Vec<f64>,
    gaps: Vec<f64>,
}

impl Lines {
    /// Seconds from a seed to the gaps of its line.
    fn seconds(&mut self, rough: &Rough, seed: u64) -> f64 {
        let clock = Instant::now();
        let heights = take(&mut self.heights);
        let unit = self.synthesizer.synthesize(
            rough.spectrum,
            black_box(seed),
            rough.points,
            0.0,
            heights,
        );
        self.heights = unit.expect("memory for the line");
        self.gaps.clone_from(&self.heights);
        let line = Line::from_roughness(take(&mut self.gaps), LENGTH, None, RMS_HEIGHT);
        self.gaps =
            Arc::into_inner(black_box(line.expect("a finite line")).gaps).unwrap_or_default();
        seconds_since(clock)
    }
}

/// A simulation whose scene is edited as in the explorer: with the histogram of heights, and with
/// the stages kept.
struct Edits {
    simulation: Simulation,
    stages: Vec<Stage>,
    /// Shortest seconds from an edit to the outcome: under each κ with the line kept, and for
    /// another seed under each κ.
    kappa: [f64; 2],
    seed: [f64; 2],
}

impl Edits {
    fn of(rough: &Rough) -> Self {
        let (kappa, seed) = ([f64::INFINITY; 2], [f64::INFINITY; 2]);
        let mut edits = Edits {
            simulation: Simulation::default(),
            stages: Vec::new(),
            kappa,
            seed,
        };
        edits.seconds(&rough.scene);
        edits
    }

    fn measure(&mut self, rough: &Rough, run: usize) {
        for (index, kappa) in rough.kappas.into_iter().enumerate() {
            let adhesion = Some(Adhesion::by_parameter(RoughnessParameter::Kappa, kappa));
            let scene = rough
                .scene
                .with(|scene| scene.adhesion = adhesion)
                .expect("a valid scene");
            let scene = scene.with_seed(2 + (2 * run + index) as u64);
            self.seed[index] = self.seed[index].min(self.seconds(&scene));
        }
        // The line of the last seed is kept.
        for (index, kappa) in rough.kappas.into_iter().enumerate() {
            let adhesion = Some(Adhesion::by_parameter(RoughnessParameter::Kappa, kappa));
            let scene = rough
                .scene
                .with(|scene| scene.adhesion = adhesion)
                .expect("a valid scene");
            let scene = scene.with_seed(3 + 2 * run as u64);
            self.kappa[index] = self.kappa[index].min(self.seconds(&scene));
        }
    }

    fn seconds(&mut self, scene: &CheckedScene) -> f64 {
        let clock = Instant::now();
        self.stages.clear();
        let stages = &mut self.stages;
        let outcome = self.simulation.run(scene, &|| false, &mut |_, _, stage| {
            stages.push(stage.clone());
            Ok(())
        });
        black_box(outcome.expect("a scene that can be computed"));
        seconds_since(clock)
    }
}

impl Loop {
    /// Loops not yet measured.
    fn under(kappa: f64) -> Self {
        Loop {
            kappa,
            edges: [Timed::new(), Timed::new()],
        }
    }
}

impl Timed {
    fn new() -> Self {
        let never = f64::INFINITY;
        Timed {
            tree: never,
            passes: never,
            curves: never,
            whole: never,
            reversals: never,
            ..Timed::default()
        }
    }

    /// Builds the tree in the memory of another, loads to a force and pulls off.
    fn measure(
        &mut self,
        tree: ContactTree,
        edges: Edges,
        work: f64,
        rough: &Rough,
    ) -> ContactTree {
        let whole = Instant::now();
        let contact = contact(tree, edges, work, rough);
        self.tree = self.tree.min(seconds_since(whole));
        let mut solver = Body::new(&contact, SAMPLES);
        let stages = [
            Move::ToForce(LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT),
            Move::ToSeparation,
        ];
        let clock = Instant::now();
        self.records = stages
            .map(|stage| solver.advance(stage).expect("a reachable stage"))
            .into();
        let stages_seconds = seconds_since(clock);
        self.whole = self.whole.min(seconds_since(whole));
        self.curves = self.curves.min(solver.curve_seconds());
        self.passes = self.passes.min(stages_seconds - solver.curve_seconds());
        self.work = solver.work();
        drop(solver);
        self.measure_reversals(tree_of(contact), edges, work, rough)
    }

    /// Builds the tree and unloads from as many preloads up to that of the loop.
    fn measure_reversals(
        &mut self,
        tree: ContactTree,
        edges: Edges,
        work: f64,
        rough: &Rough,
    ) -> ContactTree {
        let force = LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT / f64::from(REVERSALS);
        let turns: Vec<Move> = (1..=REVERSALS)
            .map(|turn| Move::ToForce(force * f64::from(turn)))
            .collect();
        let clock = Instant::now();
        let contact = contact(tree, edges, work, rough);
        let mut solver = Body::new(&contact, SAMPLES);
        let mut see = |_, reversal| {
            black_box(reversal);
            Ok(())
        };
        solver
            .reversals(&turns, &[], &mut see)
            .expect("reachable turning points");
        self.reversals = self.reversals.min(seconds_since(clock));
        drop(solver);
        tree_of(contact)
    }
}

/// The contact of a line, with its tree in the memory of another one.
fn contact(tree: ContactTree, edges: Edges, work: f64, rough: &Rough) -> Contact {
    let profile = Profile::from_gaps(Arc::clone(&rough.line.gaps), rough.line.spacing)
        .expect("a finite line");
    profile
        .build_tree(edges, tree)
        .expect("memory for the tree");
    let modulus = Modulus::effective(EFFECTIVE_MODULUS).expect("a modulus");
    Contact::builder(&profile, modulus)
        .work_of_adhesion(work)
        .edges(edges)
        .build()
        .expect("a contact")
}

/// The memory of the tree of a contact.
fn tree_of(contact: Contact) -> ContactTree {
    let profile = contact.profile().clone();
    drop(contact);
    profile.into_tree()
}

/// A real Fourier transform, planned, with its buffers.
struct Transform {
    plan: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    output: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Transform {
    fn planned(points: usize) -> Self {
        let plan = plan_real_forward(points);
        let (input, output, scratch) = (
            plan.make_input_vec(),
            plan.make_output_vec(),
            plan.make_scratch_vec(),
        );
        Transform {
            plan,
            input,
            output,
            scratch,
        }
    }

    fn seconds(&mut self, values: &[f64]) -> f64 {
        // The transform destroys its input.
        self.input.copy_from_slice(values);
        let clock = Instant::now();
        self.plan
            .process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch)
            .expect("buffers of its length");
        black_box(&self.output);
        seconds_since(clock)
    }
}

fn seconds_since(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64()
}

impl Measured {
    fn print(&self, rough: &Rough) {
        println!("N = {} = 2^{}", rough.points, rough.points.ilog2());
        println!(
            "  {:<34} {:>11} {:>10} {:>10}",
            "stage", "ms", "FFTs", "ns/spring"
        );
        let row = |name: &str, seconds: f64| {
            let (ffts, each) = (
                seconds / self.transform,
                1e9 * seconds / rough.points as f64,
            );
            println!(
                "  {name:<34} {:>11.4} {ffts:>10.2} {each:>10.2}",
                1e3 * seconds
            );
        };
        row("one real FFT", self.transform);
        row("line, in fresh memory", self.synthesis);
        row("line of a new seed", self.next_line);
        row("tree, in fresh memory", self.fresh_tree);
        for one in &self.loops {
            for (edges, timed) in EDGES.into_iter().zip(&one.edges) {
                println!("  kappa = {}, {edges:?}", one.kappa);
                row("tree", timed.tree);
                row("passes, loading and unloading", timed.passes);
                row("curves, extremes, energies", timed.curves);
                row("whole loop", timed.whole);
                row(
                    &format!("{REVERSALS} reversals, tree included"),
                    timed.reversals,
                );
                println!(
                    "    reversals take {:.2} whole loops",
                    timed.reversals / timed.whole
                );
                timed.print_outcome(rough, one.kappa);
            }
        }
        println!("  edits: the whole outcome with F_a(d=0) and histogram, stages copied");
        for (index, kappa) in rough.kappas.into_iter().enumerate() {
            row(&format!("of kappa, to {kappa}"), self.edits.kappa[index]);
            row(
                &format!("of the seed, kappa = {kappa}"),
                self.edits.seed[index],
            );
        }
        println!();
    }
}

impl Timed {
    fn print_outcome(&self, rough: &Rough, kappa: f64) {
        let work = &self.work;
        println!(
            "    tree nodes {}, rule of Hess {}, events sorted {}, joins {}, leaves {}",
            work.tree_nodes,
            work.hess_evaluations,
            work.events_sorted,
            work.attached,
            work.detached
        );
        let [loading, unloading] = &self.records[..] else {
            return;
        };
        let ideal = ClosedForm::ideal_pull_off_force(
            rough.work_of_adhesion(kappa),
            EFFECTIVE_MODULUS,
            LENGTH,
        );
        println!(
            "    under load {:.1} % in contact; pull-off force {:.2e} of the load, {:.2e} of the ideal",
            1e2 * loading.attached as f64 / rough.points as f64,
            -unloading.smallest.force / loading.largest.force,
            -unloading.smallest.force / ideal
        );
    }
}
