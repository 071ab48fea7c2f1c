#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Asperity: how strongly two rough elastic bodies stick, and whether pressing them together makes
//! them stick more.

pub mod analysis;
pub mod cli;
pub mod contact;
pub mod explorer;
pub mod export;
pub mod reference;
pub mod scene;
pub mod simulation;
pub mod surface;
