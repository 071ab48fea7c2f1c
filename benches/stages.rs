//! What each stage of an exact loop costs, in seconds, in nanoseconds for each spring, and in units of
//! one real Fourier transform of the same length measured in the same run: the unit makes runs on
//! different machines comparable.
//!
//! `cargo bench --bench stages` prints the table. After `--`: `--quick` stops at 2^16 springs,
//! `--smallest 20` begins at 2^20, `--largest 18` stops at 2^18, and `--runs 9` repeats each measurement
//! so often, of which the shortest counts. Without `--bench`, as `cargo test --benches` starts it, it only
//! shows that it runs.

use asperity::analysis::ideal_adhesion_force;
use asperity::contact::{ContactTree, Foundation, GridEdges, HessRule, LegRecord, Solver, Work, exact};
use asperity::scene::Leg;
use asperity::surface::{Line, SelfAffine, UnitRoughness};
use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// A whole loop at this length may cost at most so many transforms.
const BAR: (u32, f64) = (20, 10.0);

const SAMPLES: usize = 512;
const LENGTH: f64 = 1.0e-3;
const EFFECTIVE_MODULUS: f64 = 2.0e6;
const RMS_HEIGHT: f64 = 5.0e-7;
const HURST: f64 = 0.7;
/// Under the first, lines as finely rough as these snap into full contact; under the second, part of them
/// stays free, and springs join and leave a few at a time.
const KAPPAS: [f64; 2] = [2.0, 20.0];
/// Load in units of E* L h.
const LOAD: f64 = 0.4;

fn main() {
    let options = Options::from_arguments(std::env::args().skip(1));
    println!(
        "self-affine line, H = {HURST}, modes up to N/4, {SAMPLES} samples on each leg; one thread, shortest \
         of {} runs",
        options.runs
    );
    println!("one FFT: a real transform of N points, planned beforehand, its memory kept\n");
    let mut verdict = Vec::new();
    for exponent in (options.smallest..=options.largest).step_by(2) {
        let rough = Rough::new(exponent);
        let measured = measure(&rough, options.runs);
        measured.print(&rough);
        if exponent == BAR.0 {
            verdict = measured.loops.iter().map(|one| (one.kappa, one.whole / measured.transform)).collect();
        }
    }
    for (kappa, ratio) in verdict {
        let (exponent, most) = BAR;
        let holds = if ratio <= most { "holds" } else { "does NOT hold" };
        println!("whole loop at 2^{exponent}, kappa = {kappa}: {ratio:.2} FFTs; the bar of {most} {holds}");
    }
}

struct Options {
    smallest: u32,
    largest: u32,
    runs: usize,
}

impl Options {
    fn from_arguments(arguments: impl Iterator<Item = String>) -> Self {
        let arguments: Vec<String> = arguments.collect();
        let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
        let number = |flag: &str| {
            let place = arguments.iter().position(|argument| argument == flag)?;
            arguments.get(place + 1)?.parse().ok()
        };
        if has("--test") || !has("--bench") {
            return Options { smallest: 6, largest: 8, runs: 1 };
        }
        let largest = number("--largest").unwrap_or(if has("--quick") { 16 } else { 22 });
        let runs = number("--runs").map_or(if has("--quick") { 5 } else { 9 }, |runs| runs as usize);
        Options { smallest: number("--smallest").unwrap_or(12), largest, runs: runs.max(1) }
    }
}

/// A rough line.
struct Rough {
    spectrum: SelfAffine,
    points: usize,
    line: Line,
    foundation: Foundation,
}

impl Rough {
    fn new(exponent: u32) -> Self {
        let points = 1_usize << exponent;
        let spectrum = SelfAffine { hurst: HURST, first: 1, last: points as u64 / 4 };
        let line = synthesize(spectrum, points);
        let foundation = Foundation { spacing: line.spacing, effective_modulus: EFFECTIVE_MODULUS };
        Rough { spectrum, points, line, foundation }
    }

    /// γ = h⟨∇z⟩E*/κ², eq. (11).
    fn work_of_adhesion(&self, kappa: f64) -> f64 {
        let rms_gradient = RMS_HEIGHT * self.spectrum.gradient_per_height(LENGTH);
        RMS_HEIGHT * rms_gradient * EFFECTIVE_MODULUS / (kappa * kappa)
    }
}

fn synthesize(spectrum: SelfAffine, points: usize) -> Line {
    let rough = UnitRoughness::synthesize(spectrum, 1, points).expect("memory for the line");
    Line::new(LENGTH, points, None, Some(&rough.heights), RMS_HEIGHT).expect("a finite line")
}

/// Shortest seconds of each stage.
struct Measured {
    transform: f64,
    synthesis: f64,
    fresh_tree: f64,
    tree: f64,
    loops: Vec<Loop>,
}

/// Shortest seconds of a whole loop under one κ, and what came out of it.
struct Loop {
    kappa: f64,
    passes: f64,
    curves: f64,
    whole: f64,
    records: Vec<LegRecord>,
    work: Work,
}

/// Measures all stages in turn, round after round: what else the machine does in the meantime then
/// meets all of them alike.
fn measure(rough: &Rough, runs: usize) -> Measured {
    let gaps = &rough.line.gaps;
    let mut transform = Transform::planned(rough.points);
    // The tree's memory is kept from run to run, as the transform's buffers are and as a simulation does.
    let mut tree = ContactTree::build(gaps).expect("memory for the tree");
    let never = f64::INFINITY;
    let loops = KAPPAS.map(Loop::under).into();
    let mut best = Measured { transform: never, synthesis: never, fresh_tree: never, tree: never, loops };
    for _ in 0..runs {
        best.transform = best.transform.min(transform.seconds(gaps));

        let clock = Instant::now();
        black_box(synthesize(black_box(rough.spectrum), rough.points));
        best.synthesis = best.synthesis.min(seconds_since(clock));

        let clock = Instant::now();
        black_box(ContactTree::build(black_box(gaps)).expect("memory for the tree"));
        best.fresh_tree = best.fresh_tree.min(seconds_since(clock));

        for one in &mut best.loops {
            let clock = Instant::now();
            tree = tree.rebuild(black_box(gaps)).expect("memory for the tree");
            best.tree = best.tree.min(seconds_since(clock));
            one.measure_legs(rough, &tree);
            one.whole = one.whole.min(seconds_since(clock));
        }
    }
    best
}

impl Loop {
    /// A loop not yet measured.
    fn under(kappa: f64) -> Self {
        let [passes, curves, whole] = [f64::INFINITY; 3];
        Loop { kappa, passes, curves, whole, records: Vec::new(), work: Work::default() }
    }

    /// Loads to a force and pulls off.
    fn measure_legs(&mut self, rough: &Rough, tree: &ContactTree) {
        let rule = GridEdges::new(HessRule::new(rough.foundation, rough.work_of_adhesion(self.kappa)));
        let mut solver = exact::adhesive(tree, rule, rough.foundation, SAMPLES).expect("memory");
        let legs = [Leg::ToForce(LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT), Leg::ToSeparation];
        let clock = Instant::now();
        self.records = legs.map(|leg| solver.advance(leg).expect("a reachable leg")).into();
        let legs_seconds = seconds_since(clock);
        self.curves = self.curves.min(solver.curve_seconds());
        self.passes = self.passes.min(legs_seconds - solver.curve_seconds());
        self.work = solver.work();
    }
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
        let plan = RealFftPlanner::<f64>::new().plan_fft_forward(points);
        let (input, output, scratch) =
            (plan.make_input_vec(), plan.make_output_vec(), plan.make_scratch_vec());
        Transform { plan, input, output, scratch }
    }

    fn seconds(&mut self, values: &[f64]) -> f64 {
        // The transform uses its input up.
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
        println!("  {:<34} {:>11} {:>10} {:>10}", "stage", "ms", "FFTs", "ns/spring");
        let row = |name: &str, seconds: f64| {
            let (ffts, each) = (seconds / self.transform, 1e9 * seconds / rough.points as f64);
            println!("  {name:<34} {:>11.4} {ffts:>10.2} {each:>10.2}", 1e3 * seconds);
        };
        row("one real FFT", self.transform);
        row("line: phases, synthesis, gaps", self.synthesis);
        row("tree, in fresh memory", self.fresh_tree);
        row("tree", self.tree);
        for one in &self.loops {
            println!("  kappa = {}", one.kappa);
            row("passes, loading and unloading", one.passes);
            row("curves, extremes, force search", one.curves);
            row("whole loop: tree, passes, curves", one.whole);
            one.print_outcome(rough);
        }
        println!();
    }
}

impl Loop {
    fn print_outcome(&self, rough: &Rough) {
        let work = &self.work;
        println!(
            "    tree nodes {}, rule of Hess {}, springs tallied {}, events sorted {}, joins {}, leaves {}",
            work.tree_nodes,
            work.hess_evaluations,
            work.springs_tallied,
            work.events_sorted,
            work.joins,
            work.leaves
        );
        let [loading, unloading] = &self.records[..] else { return };
        let ideal = ideal_adhesion_force(rough.work_of_adhesion(self.kappa), EFFECTIVE_MODULUS, LENGTH);
        println!(
            "    under load {:.1} % in contact; adhesion force {:.2e} of the load, {:.2e} of the ideal",
            1e2 * loading.joins as f64 / rough.points as f64,
            -unloading.smallest.force / loading.largest.force,
            -unloading.smallest.force / ideal
        );
    }
}
