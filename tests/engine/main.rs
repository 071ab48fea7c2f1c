//! The library without the program: closed forms, brute force, laws, exact sums and scenes.

mod closed_forms;
mod equilibrium;
mod formed;
mod hard_cases;
mod large_lines;
mod laws;
mod numerics;
mod reversals;
mod scene;
mod solvers;
mod stepwise;
mod subcell;
mod sums;
