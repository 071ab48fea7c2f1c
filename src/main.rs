//! The program `asperity`. It runs the command line of the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(asperity::cli::main(std::env::args_os()))
}
