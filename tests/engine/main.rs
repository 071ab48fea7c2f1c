//! The library without the program: closed forms, brute force, laws, exact sums and scenes.

mod body;
mod closed_forms;
mod equilibrium;
mod hard_cases;
mod large_lines;
mod laws;
mod levels;
mod numerics;
mod reversals;
mod scene;
mod simulation;
mod stepwise;
mod sums;
