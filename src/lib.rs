#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Asperity: how strongly two rough elastic bodies stick, and whether pressing them together makes
//! them stick more.
//!
//! It implements the model of Popov and Filippov (2012): a rigid self-affine line on a foundation of
//! springs, the method of dimensionality reduction, with the rule of Hess for adhesion. The hysteresis
//! of any loading history is exact and takes time proportional to the number of springs.
//!
//! Data flows one way:
//!
//! | from | by | to |
//! | --- | --- | --- |
//! | a file | [`scene::open`] | [`scene::Scene`], checked |
//! | its form and roughness | [`surface`] | [`surface::Line`], gaps c at a distance Δx |
//! | the gaps | [`contact::ContactTree::build`] | the tree of all fragments there can be |
//! | tree, E\*, γ, loading | [`contact::exact`] or [`contact::stepwise`] | [`contact::History`], legs and curves |
//! | the history | [`analysis`] | figures and the regime |
//!
//! [`simulation::Simulation`] runs these stages, only those a scene calls for, and repeats only those
//! whose input has changed:
//!
//! ```
//! use asperity::{scene, simulation::Simulation};
//!
//! let document = scene::open("jkr-sphere")?;
//! let mut simulation = Simulation::new(document.resolve(""));
//! let outcome = simulation.run(document.scene(), &|| false, &mut |_, _, _| Ok(()))?;
//! // Johnson, Kendall and Roberts: (3/2)πγR.
//! let pull_off = outcome.figures.adhesion_force.ok_or("no leg back")?;
//! assert!((pull_off / (1.5 * std::f64::consts::PI * 0.05 * 1.0e-4) - 1.0).abs() < 2e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod accuracy;
pub mod analysis;
pub mod check;
#[cfg(feature = "tui")]
pub mod cli;
pub mod contact;
pub mod disk;
pub mod ensemble;
#[cfg(feature = "tui")]
pub mod explorer;
pub mod export;
mod io;
mod memory;
mod parallel;
pub mod phase;
pub mod reference;
pub mod scene;
pub mod simulation;
pub mod surface;
pub mod sweep;
mod text;

/// The example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
