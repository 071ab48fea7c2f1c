//! The library without the program: closed forms, brute force, laws, exact sums and scenes.

#[path = "../common"]
mod common {
    pub mod effort;
}
mod body;
mod branches;
mod closed_forms;
mod equilibrium;
mod exhaustive;
mod hard_cases;
mod instrument;
mod large_lines;
mod laws;
mod levels;
mod numerics;
mod reversals;
mod scene;
mod simulation;
mod smooth;
mod stepwise;
mod sums;
mod table;
