//! Counts the instructions of the program and of a hand-written kernel for each scene.

pub mod callgrind;
mod cases;
mod executed;
mod kernels;

pub use cases::Case;

use asperity_contact::{History, Work};
use asperity_scene::{Document, Outcome, Simulation};
use callgrind::Profile;
use executed::EFFECTS;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest allowed ratio of the instructions of the program to the instructions of the kernel.
pub const MOST: f64 = 1.02;

/// Environment variable that states the task of a child process, which runs under callgrind.
const CHILD: &str = "ASPERITY_INSTRUCTIONS";

/// Task of a child process under callgrind, after the process has read its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Does nothing. The count is subtracted from the other two counts, so that starting the
    /// process and reading the scene do not count.
    Nothing,
    /// Computes the scene as the program does.
    Program,
    /// Runs the hand-written kernel for the scene.
    Kernel,
}

impl What {
    const ALL: [What; 3] = [What::Nothing, What::Program, What::Kernel];
}

/// Computes all results of a scene as the program does.
pub fn program(document: &Document) -> Outcome {
    let mut simulation = Simulation::default();
    let outcome = simulation.compute(document.scene());
    outcome.expect("a scene that can be computed")
}

/// Performs the task of a child process under callgrind. Returns false if the environment variable
/// states no task, which means that this process is not such a child.
pub fn run_as_child() -> bool {
    let Ok(asked) = std::env::var(CHILD) else {
        return false;
    };
    let mut words = asked
        .split(' ')
        .map(|word| word.parse::<usize>().expect("an index"));
    let case = Case::all()[words.next().expect("a case")];
    let document = case.document();
    match What::ALL[words.next().expect("what to do")] {
        What::Nothing => drop(std::hint::black_box(document)),
        What::Program => drop(std::hint::black_box(program(&document))),
        What::Kernel => drop(std::hint::black_box(kernels::kernel(&case))),
    }
    true
}

/// Panics unless a kernel has the same results as the program. With other results the kernel would
/// be no measure of the necessary work.
pub fn assert_agree(case: &Case) {
    let (outcome, given) = (program(&case.document()), kernels::kernel(case));
    let what = case.name();
    let forces = |history: &History| -> Vec<u64> {
        history
            .stages
            .iter()
            .flat_map(|stage| &stage.curve)
            .map(|point| point.force.to_bits())
            .collect()
    };
    assert_eq!(forces(&outcome.history), forces(&given.history), "{what}");
    assert_eq!(outcome.history.contacts, given.history.contacts, "{what}");
    let without_preload = [
        outcome.first_touch_pull_off_force,
        outcome.zero_force_pull_off_force,
    ];
    assert_eq!(without_preload, given.without_preload, "{what}");
    assert_eq!(outcome.histogram, given.histogram, "{what}");
    assert_eq!(outcome.patches, given.patches, "{what}");
    assert!(
        outcome
            .history
            .stages
            .iter()
            .all(|stage| stage.curve.iter().any(|point| point.springs > 0)),
        "{what}"
    );
}

/// Numbers of instructions for one scene, and the data for finding violations.
pub struct Report {
    case: Case,
    program: u64,
    kernel: u64,
    /// Instructions by line of the process that ran the program.
    profile: Profile,
    /// Work counts of the program, such as the number of transforms.
    work: Work,
}

/// Counts the instructions of all scenes, with as many processes at a time as the machine has
/// cores. `arguments` are the arguments of each child process.
pub fn count(cases: &[Case], arguments: &[&str]) -> Vec<Report> {
    let next = AtomicUsize::new(0);
    let reports = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let report = Report::of(*case, arguments);
                    reports.lock().expect("no panic").push(report);
                }
            });
        }
    });
    let mut reports = reports.into_inner().expect("no panic");
    reports.sort_by_key(|report| report.case.index());
    reports
}

impl Report {
    fn of(case: Case, arguments: &[&str]) -> Report {
        let profile = |what: What| {
            let asked = format!("{} {}", case.index(), what as usize);
            callgrind::profile(arguments, &[(CHILD, &asked)])
        };
        let [nothing, program, kernel] = What::ALL.map(profile);
        let beyond = |profile: &Profile| profile.total() - nothing.total();
        let (counted, of_kernel) = (beyond(&program), beyond(&kernel));
        let work = self::program(&case.document()).history.work;
        Report {
            case,
            program: counted,
            kernel: of_kernel,
            profile: program,
            work,
        }
    }

    /// Returns the instructions of the program divided by the instructions of the kernel.
    pub fn ratio(&self) -> f64 {
        self.program as f64 / self.kernel as f64
    }

    /// Returns true if executed lines are known, which requires line tables in the program.
    pub fn has_line_tables(&self) -> bool {
        self.profile.has_line_tables()
    }

    /// Returns a message for each limit that the counts of this scene violate.
    pub fn failures(&self) -> Vec<String> {
        let name = self.case.name();
        let mut failures = Vec::new();
        if self.ratio() > MOST || self.kernel == 0 {
            failures.push(format!(
                "{name}: {} instructions are {:.4} times the {} of the kernel",
                self.program,
                self.ratio(),
                self.kernel
            ));
        }
        for effect in EFFECTS {
            let (wanted, instructions) = (
                (effect.called_for)(&self.case),
                effect.executed(&self.profile),
            );
            let counted = (effect.counted)(&self.work);
            if wanted != (instructions > 0) {
                let called = if wanted {
                    "called for"
                } else {
                    "not called for"
                };
                failures.push(format!(
                    "{name}: {} is {called}: {instructions} instructions",
                    effect.name
                ));
            }
            if wanted != (counted > 0) {
                failures.push(format!(
                    "{name}: the program counts {} {counted} times",
                    effect.name
                ));
            }
        }
        failures
    }

    /// Returns a table of all reports, with the effects that each scene executes.
    pub fn table(reports: &[Report]) -> String {
        let mut table = format!(
            "{:<48} {:>14} {:>14} {:>8}  executed\n",
            "scene of 2^16 springs", "program", "kernel", "ratio"
        );
        for report in reports {
            let executed: Vec<&str> = EFFECTS
                .iter()
                .filter(|effect| effect.executed(&report.profile) > 0)
                .map(|effect| effect.name)
                .collect();
            let Report {
                case,
                program,
                kernel,
                ..
            } = report;
            let (name, ratio, executed) = (case.name(), report.ratio(), executed.join(", "));
            let _ = writeln!(
                table,
                "{name:<48} {program:>14} {kernel:>14} {ratio:>8.4}  {executed}"
            );
        }
        table
    }
}
