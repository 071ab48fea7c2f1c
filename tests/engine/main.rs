//! The library without the program: closed forms, brute force, laws, exact sums, scenes, and studies
//! on a disk that fails.

mod body;
mod closed_forms;
mod digits;
mod equilibrium;
mod hard_cases;
mod large_lines;
mod laws;
mod levels;
mod numerics;
mod reversals;
mod scene;
#[cfg(unix)]
mod simulated_disk;
mod simulation;
mod stepwise;
mod sums;
