//! The program in a terminal: keys are typed, the screen is read, the window is resized or closed,
//! and in the end the terminal is as before.
//!
//! The engine that panics is the tool `panicking_engine`, in `tests/tools`, built into `examples/`
//! beside the program: `cargo test` builds both, `cargo test --test explorer_terminal` builds the
//! example only after `cargo build --examples`.
#![cfg(target_os = "linux")]

#[path = "../common"]
mod common {
    pub mod draws;
    pub mod study;
    pub mod terminal;
}
mod appearance;
mod bytes;
mod devices;
mod driving;
mod files;
mod idle;
mod jobs;
mod keeping;
mod leaving;
mod mouse;
mod opening;
mod panics;
mod sequences;
mod ssh;
mod storm;
mod study;
mod window;
