//! Scenes: their text and their fields, smooth bodies against closed forms, figures of force
//! curves, and what a simulation keeps.

#[path = "../../../contact/tests/laws/body.rs"]
mod body;
mod branches;
mod closed_forms;
#[path = "../../../../tests/common/effort.rs"]
mod effort;
mod instrument;
mod numerics;
mod premises;
mod profiles;
mod relaxation;
mod scene;
mod simulation;
mod smooth;
mod spheres;
mod table;
