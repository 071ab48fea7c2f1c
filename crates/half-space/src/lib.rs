#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod adhesive;
mod convolution;
#[cfg(test)]
#[path = "../../../tests/common/effort.rs"]
mod effort;
mod error;
mod half_space;
mod map;
mod operators;
mod press;

pub use adhesive::{AdhesiveSquare, AdhesiveState};
pub use error::HalfSpaceError;
pub use half_space::{HalfSpace, Load, Pressed, Square, check_cells};
pub use map::random_map;
pub use operators::Boundary;
