//! Compares the number of instructions that the program executes for a scene with the number of
//! instructions of a hand-written kernel for the same scene. Callgrind, a tool of valgrind, counts
//! the instructions.
//!
//! `cargo bench --bench instructions` prints the comparison as a table. It fails if the program
//! executes over 2 % more instructions than the kernel, or if a scene executes code of an effect
//! that it does not have. If valgrind is not installed, a message says so. Without `--bench`, as in
//! `cargo test --benches`, only the results of the program and of the kernels are compared.

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
