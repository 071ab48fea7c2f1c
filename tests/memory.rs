//! Memory of a run: as stated, or a message.
#![cfg(target_os = "linux")]

#[path = "common/allocations.rs"]
mod allocations;
#[path = "common/peak.rs"]
mod peak;

use asperity::contact::motion::{Body, ContactTree};
use asperity::contact::{Contact, Modulus, Profile};
use asperity::contact::{Edges, Move};
use asperity::scene::Simulation;
use asperity::scene::workload::Workload;
use asperity::scene::{Document, open};
use asperity::surface::SelfAffine;
use asperity::surface::lines::{Line, Synthesizer};
use peak::{Changed, arguments, peak};
use std::mem::take;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::Mutex;

const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");

/// Held by tests that take much memory in this process.
static ALONE: Mutex<()> = Mutex::new(());

/// Largest ratio of the stated to the used memory, and of the inverse, apart from differences
/// between builds of the program itself.
const FACTOR: f64 = 1.5;
const OF_BUILDS: u64 = 6 << 20;

/// Scenes that need memory for different purposes.
const SCENES: [Changed<'static>; 10] = [
    ("jkr-sphere", &[("numerics.samples", "5000")]),
    ("jkr-sphere", &[("numerics.samples", "1000000")]),
    (
        "jkr-sphere",
        &[("numerics.samples", "1000000"), ("numerics.edges", "Grid")],
    ),
    (
        "jkr-sphere",
        &[("numerics.samples", "300000"), ("loading", STAGES)],
    ),
    ("million-springs", &[("numerics.samples", "5000")]),
    (
        "million-springs",
        &[("numerics.samples", "5000"), ("numerics.points", "1048583")],
    ),
    (
        "million-springs",
        &[("numerics.samples", "5000"), ("adhesion", "None")],
    ),
    ("jkr-sphere", &[RELAXATION, SPEED]),
    ("million-springs", &[RELAXATION, SPEED]),
    (
        "million-springs",
        &[RELAXATION, SPEED, ("loading_stiffness", "1e4")],
    ),
];
const RELAXATION: (&str, &str) = (
    "material",
    "(modulus: 2.0e6, relaxation: (share: 0.4, time: 1.0))",
);
const SPEED: (&str, &str) = ("loading_speed", "1e-6");
const STAGES: &str = "[ToForce(1e-3), ToSeparation, ToForce(2e-3), ToSeparation]";

#[test]
fn a_plan_states_the_memory_that_a_run_takes() {
    let mut wrong = Vec::new();
    for changed in SCENES {
        let fields: Vec<_> = changed
            .1
            .iter()
            .map(|&(path, value)| (path.into(), value.into()))
            .collect();
        let document = open(changed.0).unwrap().set_all(&fields).unwrap();
        let (stated, taken) = (
            Workload::of(document.scene()).resident_bytes,
            peak(ASPERITY, changed),
        );
        let is_at_most = |one: u64, other: u64| one as f64 <= FACTOR * (other + OF_BUILDS) as f64;
        let row = format!(
            "{changed:?}: {} MiB stated, {} MiB taken",
            stated >> 20,
            taken >> 20
        );
        println!("{row}");
        if !(is_at_most(stated, taken) && is_at_most(taken, stated)) {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Bound of the README: bytes for each spring beside those of the program.
const PER_SPRING: u64 = 48;
const OF_PROGRAM: u64 = 10 << 20;

#[test]
fn a_spring_takes_at_most_48_bytes() {
    for edges in ["SubCell", "Grid"] {
        let fields = [
            ("numerics.samples", "5000"),
            ("numerics.points", "1048576"),
            ("numerics.edges", edges),
        ];
        // The curves of 5000 samples take the rest.
        let taken = peak(ASPERITY, ("million-springs", &fields));
        let most = OF_PROGRAM + OF_BUILDS + (PER_SPRING << 20);
        assert!(
            taken <= most,
            "{edges}: {taken} bytes taken, at most {most}"
        );
    }
}

/// Memory kept by a simulation after a run, bytes; other tests here hold next to nothing.
fn kept_after(simulation: &mut Simulation, document: &Document, before: usize) -> usize {
    simulation
        .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    allocations::held().saturating_sub(before)
}

#[test]
fn memory_of_a_large_scene_is_given_back_when_a_much_smaller_one_is_computed() {
    let _alone = ALONE.lock();
    let before = allocations::held();
    let mut simulation = Simulation::default();
    let large = open("million-springs").unwrap();
    let small = open("jkr-sphere").unwrap();
    // Twice: a transform that is used again keeps its lines as well.
    for _ in 0..2 {
        for seed in ["1", "2"] {
            let large = large.set("roughness.seed", seed).unwrap();
            let kept = kept_after(&mut simulation, &large, before);
            // As stated by `Simulation`, beside the memory of other tests.
            let most =
                (Workload::of(large.scene()).peak_bytes + 20 * (1 << 20)) as usize + (1 << 20);
            assert!(
                kept > 24 << 20 && kept <= most,
                "{kept} bytes kept; at most {most}"
            );
        }
        let kept = kept_after(&mut simulation, &small, before);
        assert!(
            kept <= 4 << 20,
            "{kept} bytes kept of a scene that takes little"
        );
    }
    // A slightly smaller scene finds its memory there.
    kept_after(&mut simulation, &large, before);
    let half = large.set("numerics.points", "524288").unwrap();
    assert!(kept_after(&mut simulation, &half, before) > 24 << 20);
}

#[test]
fn a_line_of_a_new_seed_takes_the_memory_and_the_transform_of_the_one_before() {
    let _alone = ALONE.lock();
    let spectrum = SelfAffine {
        hurst: 0.7,
        first: 1,
        last: 1 << 14,
        roll_off_mode: 0.0,
    };
    for points in [1 << 16, (1 << 16) + 1] {
        let (mut synthesizer, mut heights, mut gaps) =
            (Synthesizer::default(), Vec::new(), Vec::new());
        for seed in 1..4 {
            let (line, largest) = allocations::largest(|| {
                heights = synthesizer
                    .synthesize(spectrum, seed, points, 0.0, take(&mut heights))
                    .unwrap();
                gaps.clone_from(&heights);
                Line::from_roughness(take(&mut gaps), 1.0, None, 1.0).unwrap()
            });
            gaps = Arc::into_inner(line.gaps).unwrap();
            // A plan requests its table of sines at once.
            assert_eq!(
                largest < 1 << 10,
                seed > 1,
                "{points} springs, seed {seed}: {largest} bytes at once"
            );
        }
    }
}

/// Standard error of a run with this address space; `None` if the run succeeds.
fn refusal(arguments: &[String], kibibytes: u64) -> Option<String> {
    let mut limited = Command::new("/bin/sh");
    limited
        .args([
            "-c",
            &format!("ulimit -v {kibibytes}; exec \"$@\""),
            "sh",
            ASPERITY,
        ])
        .args(arguments);
    let output = limited
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.code() {
        Some(0) => None,
        Some(1) => Some(message),
        _ => panic!(
            "{arguments:?} in {kibibytes} KiB: {:?}\n{message}",
            output.status
        ),
    }
}

/// Address space in which a small scene is computed and refused, KiB.
const LITTLE: u64 = 100_000;

#[test]
fn a_scene_that_does_not_fit_is_refused_and_never_an_abort() {
    for changed in [
        ("jkr-sphere", &[("numerics.samples", "1000000")][..]),
        ("million-springs", &[("numerics.points", "1048583")]),
        ("million-springs", &[("numerics.points", "268435456")]),
        ("million-springs", &[("numerics.points", "4194304")]),
    ] {
        let arguments = arguments(changed);
        let mut refused = 0;
        let mut limit = LITTLE;
        // Up to a sufficient limit, in steps too small for an unseen request.
        while let Some(message) = refusal(&arguments, limit) {
            assert!(
                message.contains("not enough memory") && message.lines().count() == 1,
                "{message}"
            );
            refused += 1;
            limit += 20_000;
            if limit > 1_000_000 {
                break;
            }
        }
        assert!(refused > 0, "{changed:?}");
    }
}

/// Bound of the documentation: bytes for each spring beside gaps and tree, and for each turning
/// point.
const REVERSALS_PER_SPRING: usize = 16;
const REVERSALS_PER_TURN: usize = 256;
/// Memory of tests that run processes meanwhile, bytes.
const OF_OTHERS: usize = 1 << 17;

#[test]
fn memory_of_512_reversals_is_that_of_a_few() {
    let _alone = ALONE.lock();
    let springs = 1 << 14;
    let spectrum = SelfAffine {
        hurst: 0.7,
        first: 1,
        last: springs as u64 / 4,
        roll_off_mode: 0.0,
    };
    let rough = spectrum.heights(1, springs).unwrap();
    let line = Line::new(1e-3, springs, None, Some(&rough), 5e-7).unwrap();
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing).unwrap();
    let contact = || Contact::builder(&profile, Modulus::effective(2e6).unwrap());
    let rms_gradient = 5e-7 * spectrum.gradient_per_height(1e-3);
    for kappa in [2.0_f64, 20.0] {
        let work = 5e-7 * rms_gradient * 2e6 / (kappa * kappa);
        for closing in [work, 0.25 * work] {
            let contact = contact()
                .works_of_adhesion([closing, work])
                .build()
                .unwrap();
            profile
                .build_tree(Edges::SubCell, ContactTree::default())
                .unwrap();
            let most = |count: u32| {
                let deepest = 0.4 * 2e6 * 1e-3 * 5e-7;
                let turn = |turn: u32| Move::ToForce(deepest * f64::from(turn) / f64::from(count));
                let turns: Vec<Move> = (1..=count).map(turn).collect();
                let of = || {
                    Body::new(&contact, 512)
                        .reversals(&turns, &[], &mut |_, _| Ok(()))
                        .unwrap();
                };
                allocations::most_held(of).1
            };
            let [few, many] = [8, 512].map(most);
            println!(
                "κ = {kappa}, γ₁/γ = {}: {few} bytes for 8, {many} for 512",
                closing / work
            );
            assert!(
                many <= REVERSALS_PER_SPRING * springs + 512 * REVERSALS_PER_TURN + OF_OTHERS,
                "κ = {kappa}: {many} bytes"
            );
            assert!(
                many <= few + few / 4 + 512 * REVERSALS_PER_TURN + OF_OTHERS,
                "κ = {kappa}: {few}, {many} bytes"
            );
        }
    }
}

/// Bytes per spring that a study counts for several preloads, where nearly every spring is an
/// event.
const PRELOADS_PER_SPRING: usize = 192;

#[test]
fn preloads_of_a_line_of_events_take_what_a_study_counts() {
    let _alone = ALONE.lock();
    let springs = 1 << 15;
    let spectrum = SelfAffine {
        hurst: 0.1,
        first: 1,
        last: springs as u64 / 2,
        roll_off_mode: 0.0,
    };
    let rough = spectrum.heights(1, springs).unwrap();
    let line = Line::new(1e-3, springs, None, Some(&rough), 5e-7).unwrap();
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing).unwrap();
    let contact = || Contact::builder(&profile, Modulus::effective(2e6).unwrap());
    let work = 5e-7 * 5e-7 * spectrum.gradient_per_height(1e-3) * 2e6 / 1e6;
    let contact = contact().work_of_adhesion(work).build().unwrap();
    profile
        .build_tree(Edges::SubCell, ContactTree::default())
        .unwrap();
    let turns = [0.01, 0.1, 1.0].map(|share| Move::ToForce(share * 2e6 * 1e-3 * 5e-7));
    let held = allocations::most_held(|| {
        Body::new(&contact, 2)
            .reversals(&turns, &[], &mut |_, _| Ok(()))
            .unwrap();
    })
    .1;
    println!("{} bytes per spring", held / springs);
    assert!(
        held <= PRELOADS_PER_SPRING * springs + OF_OTHERS,
        "{} bytes per spring",
        held / springs
    );
    assert!(
        held >= PRELOADS_PER_SPRING * springs / 4,
        "{} bytes per spring: few events",
        held / springs
    );
}

/// Most memory that a run of a scene holds, bytes.
fn held_by_run(document: &Document) -> usize {
    let before = allocations::held();
    let mut simulation = Simulation::default();
    // The second run has the room of the first one, so that it reserves none to see whether there
    // is enough. Another seed makes another profile.
    let former = document.set("roughness.seed", "77");
    let former = former.unwrap_or_else(|_| document.clone());
    kept_after(&mut simulation, &former, before);
    let kept = allocations::held() - before;
    let mut run = || kept_after(&mut simulation, document, before);
    kept + allocations::most_held(&mut run).1
}

/// Returns a loading of so many stages that goes back and forth, and is pulled off at its end.
fn back_and_forth(stages: usize) -> String {
    let loops = (stages - 2) / 2;
    format!("100 µN, {loops} loops 20 µN to 50 µN, separation")
}

/// Returns a loading that is pulled off so many times.
fn pulled_off(times: usize) -> String {
    format!("[{}]", "ToForce(1.0e-4), ToSeparation, ".repeat(times))
}

/// The memory that is checked before a run is at least what the run holds, with few and with many
/// stages, samples and patches, with and without an instrument.
#[test]
fn a_run_holds_at_most_the_memory_that_is_stated() {
    let _alone = ALONE.lock();
    let loadings = [
        ("[ToForce(1.0e-4)]".to_owned(), 2),
        ("[ToForce(1.0e-4)]".to_owned(), 512),
        (pulled_off(1), 20_000),
        (pulled_off(40), 2),
        (pulled_off(40), 512),
        (back_and_forth(4), 2),
        (back_and_forth(4), 512),
        (back_and_forth(100), 64),
        (back_and_forth(40), 2000),
        (back_and_forth(500), 2),
        (back_and_forth(500), 512),
        // All springs touch.
        ("[ToForce(1.0e-2)]".to_owned(), 2),
        ("[ToForce(1.0e-2), ToSeparation]".to_owned(), 2),
        ("[ToForce(1.0e-2), ToSeparation]".to_owned(), 512),
    ];
    let mut wrong = Vec::new();
    for (name, points, adhesion) in [
        ("pressure-sensitive", "1024", "(kappa: 8)"),
        ("pressure-sensitive", "16384", "(kappa: 8)"),
        ("pressure-sensitive", "16384", "(kappa: 40)"),
        ("pressure-sensitive", "16384", "None"),
        ("jkr-sphere", "16384", "None"),
        ("jkr-sphere", "1024", "(work: 0.05)"),
        ("rough-sphere", "4096", "(work: 0.05)"),
    ] {
        for (loading, samples) in &loadings {
            for instrument in ["None", "1000.0"] {
                let fields = [
                    ("numerics.points", points.to_owned()),
                    ("numerics.samples", samples.to_string()),
                    ("adhesion", adhesion.to_owned()),
                    ("loading", loading.clone()),
                    ("loading_stiffness", instrument.to_owned()),
                ];
                let fields = fields.map(|(path, value)| (path.to_owned(), value));
                let document = open(name).unwrap().set_all(&fields).unwrap();
                let stages = document.scene().loading.len();
                // The curves of many stages need the same memory on few springs, in less time.
                let curve_points = stages as u64 * samples;
                if points.len() > 4 && curve_points > 4_000 && stages > 2 {
                    continue;
                }
                // So does the instrument.
                if points.len() > 4 && instrument != "None" {
                    continue;
                }
                let stated = Workload::of(document.scene()).peak_bytes as usize;
                let held = held_by_run(&document);
                let row = format!(
                    "{name} {points} {adhesion}, {stages} stages of {samples}, instrument \
                     {instrument}: {held} held, {stated} stated, {:.2}",
                    held as f64 / stated as f64
                );
                println!("{row}");
                if held > stated {
                    wrong.push(row);
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
