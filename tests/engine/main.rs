//! The library without the program: closed forms, brute force, laws, exact sums, scenes, and studies
//! on a disk that fails.

mod closed_forms;
mod equilibrium;
mod formed;
mod hard_cases;
mod large_lines;
mod laws;
mod numerics;
mod reversals;
mod scene;
#[cfg(unix)]
mod simulated_disk;
mod solvers;
mod stepwise;
mod subcell;
mod sums;
