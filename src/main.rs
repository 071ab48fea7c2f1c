//! The program: command line of the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    asperity::cli::main(std::env::args_os())
}
