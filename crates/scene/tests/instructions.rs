//! A scene takes the instructions of its own effects, and no others: within 2 % of a kernel written
//! for it.
//!
//! Counted by callgrind at the optimisation of the test profile; without valgrind only the results
//! of the kernels are compared with the program. Instructions are attributed to effects by the line
//! tables that Cargo.toml asks for.
//! `cargo bench --bench instructions` prints the table, fully optimised.

#[path = "../benches/instructions/mod.rs"]
mod instructions;

use instructions::{Case, Report, callgrind};

/// Task of a process under callgrind; does nothing otherwise.
#[test]
fn child_process() {
    instructions::run_as_child();
}

#[test]
fn kernels_compute_what_the_program_does() {
    Case::all().iter().for_each(instructions::assert_agree);
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn only_what_a_scene_calls_for_is_executed() {
    if !callgrind::is_there() {
        eprintln!("SKIPPED: valgrind is not installed, instructions are not counted");
        return;
    }
    let reports = instructions::count(
        &Case::all(),
        &["--exact", "child_process", "--test-threads=1"],
    );
    println!("{}", Report::table(&reports));
    assert!(
        reports.iter().all(Report::has_line_tables),
        "line tables of the crates contact, fourier, scene and surface are missing"
    );
    let failures: Vec<String> = reports.iter().flat_map(Report::failures).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
