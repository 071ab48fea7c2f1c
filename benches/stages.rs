//! What each stage of an exact loop costs, in seconds, in nanoseconds for each spring, and in units of
//! one real Fourier transform of the same length measured in the same run: the unit makes runs on
//! different machines comparable.
//!
//! `cargo bench --bench stages` prints the table; `-- --quick` stops at 2^16 springs, `-- --largest 18`
//! at 2^18, `-- --smallest 20` begins at 2^20; `-- --runs 9` repeats each measurement so often, of which the shortest counts. Without
//! `--bench`, as `cargo test --benches` starts it, it only shows that it runs.

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
const KAPPA: f64 = 2.0;

/// The load in units of E* L h: a little less than half of the line is in contact under it.
const LOAD: f64 = 0.4;

fn main() {
    let options = Options::from_arguments(std::env::args().skip(1));
    println!(
        "self-affine line, H = {HURST}, modes up to N/4, kappa = {KAPPA}, {SAMPLES} samples on each leg; \
         shortest of {} runs",
        options.runs
    );
    println!("one FFT: a real transform of N points, planned beforehand; one thread\n");
    let mut verdict = None;
    for exponent in (options.smallest..=options.largest).step_by(2) {
        let rough = Rough::new(exponent);
        let measured = measure(&rough, options.runs);
        measured.print(&rough);
        if exponent == BAR.0 {
            verdict = Some(measured.whole / measured.transform);
        }
    }
    if let Some(ratio) = verdict {
        let holds = if ratio <= BAR.1 { "holds" } else { "does NOT hold" };
        let (exponent, most) = BAR;
        println!("whole loop at 2^{exponent}: {ratio:.2} FFTs; the bar of {most} {holds}");
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

/// A rough line and what acts on it.
struct Rough {
    spectrum: SelfAffine,
    points: usize,
    line: Line,
    foundation: Foundation,
    work_of_adhesion: f64,
}

impl Rough {
    fn new(exponent: u32) -> Self {
        let points = 1_usize << exponent;
        let spectrum = SelfAffine { hurst: HURST, first: 1, last: points as u64 / 4 };
        let line = synthesize(spectrum, points);
        let foundation = Foundation { spacing: line.spacing, effective_modulus: EFFECTIVE_MODULUS };
        let rms_gradient = RMS_HEIGHT * spectrum.gradient_per_height(LENGTH);
        let work_of_adhesion = RMS_HEIGHT * rms_gradient * EFFECTIVE_MODULUS / (KAPPA * KAPPA);
        Rough { spectrum, points, line, foundation, work_of_adhesion }
    }

    fn rule(&self) -> GridEdges {
        GridEdges::new(HessRule::new(self.foundation, self.work_of_adhesion))
    }

    fn legs(&self) -> [Leg; 2] {
        [Leg::ToForce(LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT), Leg::ToSeparation]
    }
}

fn synthesize(spectrum: SelfAffine, points: usize) -> Line {
    let rough = UnitRoughness::synthesize(spectrum, 1, points).expect("memory for the line");
    Line::new(LENGTH, points, None, Some(&rough.heights), RMS_HEIGHT).expect("a finite line")
}

/// Shortest seconds of each stage, and what came out of the loop.
struct Measured {
    transform: f64,
    synthesis: f64,
    tree: f64,
    passes: f64,
    curves: f64,
    whole: f64,
    records: Vec<LegRecord>,
    work: Work,
}

/// Measures all stages in turn, round after round: what else the machine does in the meantime then
/// meets all of them alike.
fn measure(rough: &Rough, runs: usize) -> Measured {
    let mut transform = Transform::planned(rough.points);
    let mut best = Measured {
        transform: f64::INFINITY,
        synthesis: f64::INFINITY,
        tree: f64::INFINITY,
        passes: f64::INFINITY,
        curves: f64::INFINITY,
        whole: f64::INFINITY,
        records: Vec::new(),
        work: Work::default(),
    };
    // The tree's memory is kept from run to run, as the transform's buffers are and as a simulation does.
    let mut tree = ContactTree::build(&[]).expect("memory for nothing");
    for _ in 0..runs {
        best.transform = best.transform.min(transform.seconds(&rough.line.gaps));
        let clock = Instant::now();
        black_box(synthesize(black_box(rough.spectrum), rough.points));
        best.synthesis = best.synthesis.min(seconds_since(clock));

        let clock = Instant::now();
        tree = tree.rebuild(black_box(&rough.line.gaps)).expect("memory for the tree");
        let tree_seconds = seconds_since(clock);
        let mut solver = exact::adhesive(&tree, rough.rule(), rough.foundation, SAMPLES).expect("memory");
        let legs_clock = Instant::now();
        best.records = rough.legs().map(|leg| solver.advance(leg).expect("a reachable leg")).to_vec();
        let legs_seconds = seconds_since(legs_clock);
        best.whole = best.whole.min(seconds_since(clock));
        best.tree = best.tree.min(tree_seconds);
        best.curves = best.curves.min(solver.curve_seconds());
        best.passes = best.passes.min(legs_seconds - solver.curve_seconds());
        best.work = solver.work();
    }
    best
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
        let springs = rough.points as f64;
        println!("N = {} = 2^{}", rough.points, rough.points.ilog2());
        println!("  {:<34} {:>11} {:>10} {:>10}", "stage", "ms", "FFTs", "ns/spring");
        for (name, seconds) in [
            ("one real FFT", self.transform),
            ("line: phases, synthesis, gaps", self.synthesis),
            ("tree", self.tree),
            ("passes, loading and unloading", self.passes),
            ("curves, extremes, force search", self.curves),
            ("whole loop: tree, passes, curves", self.whole),
        ] {
            println!(
                "  {name:<34} {:>11.4} {:>10.2} {:>10.2}",
                1e3 * seconds,
                seconds / self.transform,
                1e9 * seconds / springs
            );
        }
        let work = &self.work;
        println!(
            "  tree nodes {}, rule of Hess {}, springs tallied {}, events sorted {}, joins {}, leaves {}",
            work.tree_nodes,
            work.hess_evaluations,
            work.springs_tallied,
            work.events_sorted,
            work.joins,
            work.leaves
        );
        let [loading, unloading] = &self.records[..] else { return };
        let ideal = ideal_adhesion_force(rough.work_of_adhesion, EFFECTIVE_MODULUS, LENGTH);
        println!(
            "  under load: {:.1} % in contact; adhesion force {:.3} of the load, {:.2e} of the ideal\n",
            1e2 * loading.joins as f64 / springs,
            -unloading.smallest.force / loading.largest.force,
            -unloading.smallest.force / ideal
        );
    }
}
