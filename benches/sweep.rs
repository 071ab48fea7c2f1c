//! Cost of a parameter study: cells that share their line against cells one by one, two jobs
//! against one, and a great many small cells, all in one run. Costs are also given in real Fourier
//! transforms of as many points, measured beside.
//!
//! `cargo bench --bench sweep` prints the figures and fails if a bar is missed. After `--`:
//! `--quick` takes fewer lines and cells. Without `--bench`, as started by `cargo test --benches`,
//! it only checks that it runs.

use asperity::contact::Move;
use asperity::data::Control;
use asperity::scene::Simulation;
use asperity::scene::{Adhesion, Roughness, RoughnessParameter, Scene};
use asperity::study::{Changes, Folder, Plan, Shard, merge, run_study};
use asperity_fourier::plan_real_forward;
use std::hint::black_box;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Least ratio of the costs of separate and shared cells.
const SHARING: f64 = 3.0;
/// Least speed-up of two jobs over one.
const TWO_JOBS: f64 = 1.8;
/// Number of cells to which the study of many small cells is scaled up.
const MILLION: f64 = 1.0e6;

struct Size {
    points: u64,
    hurst: u64,
    kappas: u64,
    lines: u64,
    small_cells: u64,
    repeats: usize,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let shows_only = has("--test") || !has("--bench");
    let size = match (shows_only, has("--quick")) {
        (true, _) => Size {
            points: 256,
            hurst: 2,
            kappas: 2,
            lines: 2,
            small_cells: 64,
            repeats: 1,
        },
        (false, true) => Size {
            points: 1 << 16,
            hurst: 2,
            kappas: 33,
            lines: 2,
            small_cells: 10_000,
            repeats: 2,
        },
        (false, false) => Size {
            points: 1 << 16,
            hurst: 3,
            kappas: 33,
            lines: 4,
            small_cells: 50_000,
            repeats: 3,
        },
    };
    let mut kept = true;
    let mut bar = |name: &str, ratio: f64, least: f64| {
        let holds = ratio >= least;
        kept &= holds || shows_only;
        println!(
            "{name}: {ratio:.2}; the bar of {least} {}",
            if holds { "holds" } else { "does NOT hold" }
        );
    };

    let plan = figure(&size);
    let records = plan.records_in_all() as f64;
    let fft = transform(size.points as usize, size.repeats);
    println!(
        "Fig. 5: {} × {} cells of 2^{} springs, 3 preloads, {} lines; one real transform {:.3} ms",
        size.hurst,
        size.kappas,
        size.points.ilog2(),
        size.lines,
        fft * 1e3
    );
    let best = |what: &dyn Fn()| Cost::least(size.repeats, what);
    let shared = best(&|| study(&plan, 1));
    let two = best(&|| study(&plan, 2));
    let by_one = best(&|| one_by_one(&plan));
    let per = |name: &str, cost: Cost| {
        let each = cost.processor / records;
        println!(
            "{name}: {:.3} ms for each record, {:.3} ms of processor time, {:.1} FFTs",
            cost.clock / records * 1e3,
            each * 1e3,
            each / fft
        );
    };
    per("one by one", by_one);
    per("shared, one job", shared);
    per("shared, two jobs", two);
    bar(
        "processor time, one by one over shared",
        by_one.processor / shared.processor,
        SHARING,
    );
    println!(
        "the whole of Fig. 5(b), 17 × 33 × 3 cells on 32 lines, two jobs: {:.0} s",
        two.clock / records * 53_856.0
    );
    // Lines this long have their own two threads here and there, also with one job.
    println!("one job over two: {:.2}", shared.clock / two.clock);
    // Of many lines, since the folder and the tables take several milliseconds.
    let lines = if shows_only {
        size.lines
    } else {
        16 * size.lines
    };
    let shorter = figure(&Size {
        points: size.points.min(1 << 14),
        lines,
        ..size
    });
    let (one, two) = (best(&|| study(&shorter, 1)), best(&|| study(&shorter, 2)));
    bar(
        "one job over two, 2^14 springs",
        one.clock / two.clock,
        TWO_JOBS,
    );

    let plan = small(size.small_cells);
    let before = peak();
    let seconds = Cost::least(1, &|| study(&plan, 2)).clock;
    let after = peak();
    let each = seconds / plan.records_in_all() as f64;
    let fft = transform(1 << 10, size.repeats);
    println!(
        "\n{} cells of 2^10 springs, two jobs, merged: {:.1} µs each, {:.1} FFTs; 10^6 of them: {:.0} s",
        plan.cells(),
        each * 1e6,
        each / fft,
        each * MILLION
    );
    if let (Some(before), Some(after)) = (before, after) {
        println!(
            "peak memory {:.1} MiB before, {:.1} MiB after",
            before / 1024.0,
            after / 1024.0
        );
    }
    if kept {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Fig. 5(b), scaled down.
fn figure(size: &Size) -> Plan {
    let text = format!(
        "(version: 1, base: \"ideal-adhesion\", set: {{\"numerics.points\": \"{}\", \"roughness.modes\": \"(1, {})\"}},
         axes: [Linear(path: \"roughness.hurst\", from: 0.1, to: 0.9, count: {}),
                Linear(path: \"adhesion.kappa\", from: 1.25, to: 41.25, count: {})],
         preloads: [0.01, 0.1, 1.0], profiles: {},
         record: [adhesion_coefficient, pull_off_force, first_touch_adhesion_share, regime])",
        size.points,
        size.points / 8,
        size.hurst,
        size.kappas,
        size.lines
    );
    Plan::parse(&text, "figure", &Changes::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Many small cells on one line.
fn small(cells: u64) -> Plan {
    let text = format!(
        "(version: 1, base: \"ideal-adhesion\", set: {{\"numerics.points\": \"1024\", \"roughness.modes\": \"(1, 128)\"}},
         axes: [List(path: \"roughness.hurst\", values: [0.3, 0.7]),
                Linear(path: \"adhesion.kappa\", from: 0.2, to: 6.6, count: {})],
         preloads: [0.1], record: [adhesion_coefficient, pull_off_force])",
        cells / 2
    );
    Plan::parse(&text, "small", &Changes::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Cost, s: by the clock, and of the processors. The second hardly depends on other load of the
/// machine.
#[derive(Clone, Copy)]
struct Cost {
    clock: f64,
    processor: f64,
}

impl Cost {
    /// The least of several repetitions, of each value separately.
    fn least(repeats: usize, what: &dyn Fn()) -> Cost {
        let mut least = Cost {
            clock: f64::INFINITY,
            processor: f64::INFINITY,
        };
        for _ in 0..repeats {
            let (clock, before) = (Instant::now(), processor_time());
            what();
            least.clock = least.clock.min(clock.elapsed().as_secs_f64());
            least.processor = least.processor.min(processor_time() - before);
        }
        least
    }
}

/// Processor time of this process, s; that of the clock if the system does not state it.
fn processor_time() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}

/// A study from an empty folder to its tables.
fn study(plan: &Plan, jobs: usize) {
    let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let done = Folder::create(place.path(), plan).and_then(|folder| {
        run_study(&folder, Shard::WHOLE, Control::default().on_threads(jobs))?;
        merge(&folder)
    });
    done.unwrap_or_else(|error| panic!("{error}"));
}

/// The same cells, each a scene of its own without shared results, as by a script that runs the
/// program for each of them, but without the start of a process and its output.
fn one_by_one(plan: &Plan) {
    for line in 0..plan.lines {
        for cell in 0..plan.cells() {
            let values = plan.values(cell);
            let mut scene: Scene = plan.scene.clone();
            scene.adhesion = Some(Adhesion::by_parameter(RoughnessParameter::Kappa, values[1]));
            let Some(Roughness::SelfAffine {
                hurst,
                seed,
                rms_height,
                ..
            }) = &mut scene.roughness
            else {
                continue;
            };
            (*hurst, *seed) = (values[0], plan.seed_of(line));
            let unit =
                scene.material.modulus_in_pascals() * rms_height.unwrap_or(1.0) * scene.length;
            scene.loading = vec![Move::ToForce(values[2] * unit), Move::ToSeparation];
            let mut simulation = Simulation::new(PathBuf::new());
            let Ok(scene) = scene.checked() else { continue };
            let outcome = simulation.run(&scene, &|| false, &mut |_, _, _| Ok(()));
            black_box(outcome.unwrap_or_else(|error| panic!("{error}")));
        }
    }
}

/// Seconds of one real transform.
fn transform(points: usize, repeats: usize) -> f64 {
    let plan = plan_real_forward(points);
    let mut input: Vec<f64> = (0..points).map(|index| (index as f64).sin()).collect();
    let mut output = plan.make_output_vec();
    let mut scratch = plan.make_scratch_vec();
    (0..10 * repeats)
        .map(|_| {
            let clock = Instant::now();
            let done = plan.process_with_scratch(&mut input, &mut output, &mut scratch);
            let seconds = clock.elapsed().as_secs_f64();
            black_box(done.is_ok());
            seconds
        })
        .fold(f64::INFINITY, f64::min)
}

/// Peak memory of this process, KiB, if the system states it.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
