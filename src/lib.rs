#![forbid(unsafe_code)]
#![warn(missing_docs)]
// Much of the library serves the program alone.
#![cfg_attr(not(feature = "tui"), allow(dead_code, unused_imports))]
//! Adhesion of rough elastic contacts: pull-off force, dissipated energy and the whole hysteretic force curve of a
//! rigid rough profile on an elastic half-space, for any loading history, exactly and in linear time.
//!
//! The model is that of V. L. Popov and A. E. Filippov (Physical Mesomechanics 15, 2012): the method of dimensionality
//! reduction (MDR) with the rule of Hess for adhesion. A three-dimensional contact maps to a one-dimensional
//! equivalent profile on independent springs of stiffness E\* Δx. A contact patch of length l holds springs that are
//! stretched by up to √(π l γ/E\*), with the work of adhesion γ and the effective modulus E\*.
//!
//! # A contact in five lines
//!
//! ```
//! use asperity::{Contact, Material, Move, Profile};
//!
//! let heights: Vec<f64> = (0..1024).map(|i| 1.0e-7 * (0.3 * f64::from(i)).sin()).collect(); // m
//! let profile = Profile::from_heights(&heights, 1.0e-7)?; // spacing, m
//! let contact = Contact::builder(&profile, Material::effective(1.0e6)).work_of_adhesion(0.05).build()?;
//! let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?; // N
//! println!("{:?} N, {:?} J", cycle.pull_off_force(), cycle.dissipated_energy());
//! # assert!(cycle.pull_off_force().unwrap() > 0.0);
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! # A scene
//!
//! A [`scene::Scene`] holds all that a computation needs; the program reads it from RON files and [`scene::open`] finds
//! the built-in ones. Only a checked one is computed ([`Scene::checked`]). [`run`] computes the scene of a file:
//!
//! ```
//! let document = asperity::scene::open("jkr-sphere")?;
//! let outcome = asperity::run(&document)?;
//! // Johnson, Kendall and Roberts: (3/2)πγR.
//! let expected = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
//! assert!((outcome.figures.adhesion_force.unwrap() / expected - 1.0).abs() < 2e-3);
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! [`simulation::Simulation`] computes many scenes and repeats only the stages whose input has changed.
//!
//! # Conventions
//!
//! SI units throughout. Heights are positive towards the half-space; the indentation d is 0 at first touch of the
//! undeformed profile and grows on pressing; compressive forces are positive. N points at a distance Δx cover the
//! length N Δx.
//!
//! # Rooms
//!
//! Data flows one way:
//!
//! | from | by | to |
//! | --- | --- | --- |
//! | a file | [`scene::open`] | [`scene::CheckedScene`] |
//! | measured files | [`topography::read`] and [`spectrum::analyse`] | equivalent line, its moments |
//! | form and roughness | [`surface`] | [`surface::Line`], gaps c at a distance Δx |
//! | gaps | [`contact::Springs`] | merge tree of the local maxima of the gap |
//! | tree, E\*, γ, loading | [`contact::Body`] or [`contact::Stepwise`] | [`contact::History`], legs and curves |
//! | history | [`analysis`] | figures and the regime of adhesion |
//!
//! # Features
//!
//! `tui` (default) adds the program: explorer, command line and figures of studies. Without default features the crate
//! has no terminal packages.

pub mod accuracy;
pub mod analysis;
mod check;
#[cfg(feature = "tui")]
pub mod cli;
pub mod contact;
mod contact_cycle;
mod draw;
pub mod experiment;
#[cfg(feature = "tui")]
pub mod explorer;
#[cfg(feature = "tui")]
pub mod export;
mod io;
mod memory;
mod numerics;
mod parallel;
mod profile;
pub mod reference;
pub mod scene;
pub mod simulation;
pub mod spectrum;
pub mod study;
pub mod surface;
mod text;
pub mod topography;

pub use contact_cycle::{Contact, ContactBuilder, Cycle};
pub use profile::Profile;
pub use scene::{Document, Edges, Material, Move, Scene};
pub use surface::SelfAffine;

use simulation::{Outcome, RunError, Simulation};
use thiserror::Error;

/// Error of the functions at the root of this crate.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Error {
    /// Values out of their ranges: field, value and allowed range of each.
    #[error(transparent)]
    Values(#[from] scene::SceneErrors),
    /// A value of a profile or a contact out of its range.
    #[error("{name} = {}; allowed: {allowed}", shown(*value))]
    Value {
        /// Name of the value.
        name: String,
        /// The value.
        value: f64,
        /// Allowed range.
        allowed: &'static str,
    },
    /// A force out of reach, a file that cannot be read, or not enough memory.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// A value as a user would write it: a count without an exponent.
fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-3..1e10).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}

/// Computes the scene of a document. Its measured files are looked for in the folder of the scene file.
///
/// # Errors
/// [`Error::Run`] for a scene that cannot be computed.
pub fn run(document: &Document) -> Result<Outcome, Error> {
    Ok(Simulation::new(document.resolve("")).run(document.scene(), &|| false, &mut |_, _, _| Ok(()))?)
}

/// The example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
