//! Compares the instructions for 64 unloadings from different turning points with the instructions
//! for one loop to the deepest turning point. The profile is the same, and both counts include the
//! contact tree.

use crate::instructions::callgrind;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{Contact, Modulus, Profile};
use asperity_contact::{Edges, Move};
use asperity_surface::SelfAffine;
use asperity_surface::lines::Line;
use std::hint::black_box;
use std::sync::Arc;

/// Largest allowed ratio of the instructions of all unloadings to the instructions of one loop.
const MOST_LOOPS: f64 = 17.0;

/// Environment variable that states the number of the task of a child process, which runs under
/// callgrind.
const CHILD: &str = "ASPERITY_INSTRUCTIONS_OF_REVERSALS";

const SPRINGS: usize = 1 << 16;
const SAMPLES: usize = 512;
/// Number of turning points. They are at equally spaced forces up to the force `LOAD`, which is in
/// units of E* h L.
const REVERSALS: u32 = 64;
const LOAD: f64 = 0.4;
const LENGTH: f64 = 1.0e-3;
const EFFECTIVE_MODULUS: f64 = 2.0e6;
const RMS_HEIGHT: f64 = 5.0e-7;

/// Values of κ and edge models of the bodies. At a large κ most patches are new at each turning
/// point.
const BODIES: [(f64, Edges); 6] = [
    (2.0, Edges::Grid),
    (2.0, Edges::SubCell),
    (6.0, Edges::Grid),
    (6.0, Edges::SubCell),
    (20.0, Edges::Grid),
    (20.0, Edges::SubCell),
];

/// Part of the computation that a child process does for a body: only the profile, which the other
/// two parts also need; the profile and one loop; or the profile and all unloadings.
#[derive(Clone, Copy)]
enum Part {
    Line,
    Loop,
    Reversals,
}

const PARTS: [Part; 3] = [Part::Line, Part::Loop, Part::Reversals];

/// Performs the task of a child process under callgrind. Returns false if the environment variable
/// states no task, which means that this process is not such a child.
pub fn run_as_child() -> bool {
    let Ok(asked) = std::env::var(CHILD) else {
        return false;
    };
    let task: usize = asked.parse().expect("a number");
    let ((kappa, edges), part) = (BODIES[task / PARTS.len()], PARTS[task % PARTS.len()]);
    let spectrum = SelfAffine {
        hurst: 0.7,
        first: 1,
        last: SPRINGS as u64 / 4,
        roll_off_mode: 0.0,
    };
    let rough = spectrum.heights(1, SPRINGS).expect("memory for the line");
    let line = Line::new(LENGTH, SPRINGS, None, Some(&rough), RMS_HEIGHT).expect("a finite line");
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing).expect("a finite line");
    let rms_gradient = RMS_HEIGHT * spectrum.gradient_per_height(LENGTH);
    let work = RMS_HEIGHT * rms_gradient * EFFECTIVE_MODULUS / (kappa * kappa);
    let modulus = Modulus::effective(EFFECTIVE_MODULUS).expect("a modulus");
    let contact = Contact::builder(&profile, modulus)
        .work_of_adhesion(work)
        .edges(edges)
        .build();
    let contact = contact.expect("a contact");
    let force = LOAD * EFFECTIVE_MODULUS * LENGTH * RMS_HEIGHT;
    let body = || Body::new(&contact, SAMPLES);
    match part {
        Part::Line => drop(black_box(line.gaps.len())),
        Part::Loop => {
            let mut body = body();
            for stage in [Move::ToForce(force), Move::ToSeparation] {
                black_box(body.advance(stage).expect("a reachable stage"));
            }
        }
        Part::Reversals => {
            let turn = |turn: u32| Move::ToForce(force * f64::from(turn) / f64::from(REVERSALS));
            let turns: Vec<Move> = (1..=REVERSALS).map(turn).collect();
            let mut see = |_, reversal| {
                black_box(reversal);
                Ok(())
            };
            body()
                .reversals(&turns, &[], &mut see)
                .expect("reachable turning points");
        }
    }
    true
}

/// Counts the instructions for all bodies. Returns a table, and a message for each body whose ratio
/// exceeds the limit. `arguments` are the arguments of each child process.
pub fn count(arguments: &[&str]) -> (String, Vec<String>) {
    let mut table = format!("{REVERSALS} reversals of {SPRINGS} springs, in loops\n");
    let mut failures = Vec::new();
    for (index, (kappa, edges)) in BODIES.into_iter().enumerate() {
        let counted = |part: Part| {
            let task = (PARTS.len() * index + part as usize).to_string();
            callgrind::profile(arguments, &[(CHILD, &task)]).total()
        };
        let [line, one, all] = PARTS.map(counted);
        let loops = (all - line) as f64 / (one - line) as f64;
        let row = format!("κ = {kappa:>4}, {edges:?}: {loops:.2}");
        if loops > MOST_LOOPS {
            failures.push(format!("{row}, at most {MOST_LOOPS}"));
        }
        table += &format!("{row}\n");
    }
    (table, failures)
}
