#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Adhesion of rough elastic contacts: pull-off force, dissipated energy and the whole hysteretic force curve of a
//! rigid rough profile on an elastic half-space, for any loading history, exactly and in linear time.
//!
//! The model was stated by V. L. Popov and A. E. Filippov (Physical Mesomechanics 15, 2012): the method of dimensionality
//! reduction (MDR) with the rule of Hess for adhesion. A three-dimensional contact maps to a one-dimensional
//! equivalent profile on independent springs of stiffness E\* Δx. A contact patch of length l holds springs that are
//! stretched by up to √(π l γ/E\*), with the work of adhesion γ and the effective modulus E\*.
//!
//! # A contact in five lines
//!
//! ```
//! use asperity::{Contact, Modulus, Move, Profile};
//!
//! let heights: Vec<f64> = (0..1024).map(|i| 1.0e-7 * (0.3 * f64::from(i)).sin()).collect(); // m
//! let profile = Profile::from_heights(heights, 1.0e-7)?; // spacing, m
//! let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).work_of_adhesion(0.05).build()?;
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
//! [`scene::Simulation`] computes many scenes and repeats only the stages whose input has changed.
//!
//! # Conventions
//!
//! SI units throughout. Heights are positive towards the half-space; the indentation d is 0 at first touch of the
//! undeformed profile and grows on pressing; compressive forces are positive. N points at a distance Δx cover the
//! length N Δx.
//!
//! # Crates
//!
//! Data flows one way:
//!
//! | crate | from | to |
//! | --- | --- | --- |
//! | [`data`] | text | values with units, tables, files |
//! | [`contact`] | gaps c at a distance Δx, E\*, γ, a loading | [`contact::History`], legs and curves |
//! | [`surface`] | measured files, forms, spectra | moments, equivalent lines |
//! | [`scene`] | a scene file | [`scene::Outcome`] with figures and regime |
//! | [`experiment`] | measured force curves and a scene | fitted values with their errors |
//! | [`study`] | many scenes | tables, statistics |
//!
//! Charts and reports have crates of their own; the command line and the explorer belong only to the program.

pub mod cli;
pub mod explorer;

pub use asperity_contact as contact;
pub use asperity_contact::{Contact, Cycle, Edges, LoadOptions, Modulus, Move, Profile};
pub use asperity_data as data;
pub use asperity_experiment as experiment;
pub use asperity_scene as scene;
pub use asperity_scene::{Document, Error, ProfileBuilder, Scene, run};
pub use asperity_study as study;
pub use asperity_surface as surface;
pub use asperity_surface::SelfAffine;

/// The example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
