//! The program: the library behind a command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    asperity::cli::main(std::env::args_os())
}
