//! Number of instructions that the program takes for a scene, compared with a kernel written by
//! hand for this scene. Callgrind counts the instructions.
//!
//! `cargo bench --bench instructions` prints the table. It fails if the program takes over 2 %
//! more, or if a scene executes code of other effects. It needs valgrind and reports its absence.
//! Without `--bench`, as in `cargo test --benches`, it only checks that program and kernels agree.

#[path = "instructions/mod.rs"]
mod instructions;
#[path = "instructions/reversals.rs"]
mod reversals;

use instructions::{Case, Report, callgrind};
use std::process::ExitCode;

fn main() -> ExitCode {
    if instructions::run_as_child() || reversals::run_as_child() {
        return ExitCode::SUCCESS;
    }
    Case::all().iter().for_each(instructions::assert_agree);
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("program and kernels agree; `cargo bench --bench instructions` counts");
        return ExitCode::SUCCESS;
    }
    if !callgrind::is_there() {
        println!("SKIPPED: valgrind is not installed, instructions are not counted");
        return ExitCode::SUCCESS;
    }
    let reports = instructions::count(&Case::all(), &[]);
    print!("{}", Report::table(&reports));
    let mut failures: Vec<String> = reports.iter().flat_map(Report::failures).collect();
    if !reports.iter().all(Report::has_line_tables) {
        failures.push("no line tables: instructions are not attributed to effects".to_owned());
    }
    let (table, slow) = reversals::count(&[]);
    print!("\n{table}");
    failures.extend(slow);
    failures.iter().for_each(|failure| println!("{failure}"));
    if failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
