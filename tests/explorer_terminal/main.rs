//! The program in a terminal, as it is used: keys are typed, the screen is read, the window changes its
//! size or goes away, and in the end the terminal is as it was.
//!
//! The engine that panics is the example `panicking_engine`, which is in `examples/` beside the
//! program: `cargo test` builds both, `cargo test --test explorer_terminal` builds the example only
//! after `cargo build --examples`.
#![cfg(target_os = "linux")]

#[path = "../common"]
mod common {
    pub mod deadline;
    pub mod study;
    pub mod terminal;
}
mod appearance;
mod devices;
mod driving;
mod editing;
mod files;
mod ghosts;
mod idle;
mod jobs;
mod keeping;
mod leaving;
mod library;
mod manual;
mod mouse;
mod opening;
mod panics;
mod ssh;
mod study;
mod window;
