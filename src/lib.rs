#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Adhesion of rough elastic contacts: pull-off force, dissipated energy and the whole hysteretic
//! force curve of a rigid rough profile on an elastic half-space, for any loading history, exactly
//! and in linear time.
//!
//! The model was stated by V. L. Popov and A. E. Filippov (Physical Mesomechanics 15, 2012): the
//! method of dimensionality reduction (MDR) with the rule of Hess for adhesion. A three-dimensional
//! contact maps to a one-dimensional equivalent profile on independent springs of stiffness E\* Δx.
//! A contact patch of length l holds springs that are stretched by up to √(π l γ/E\*), with the
//! work of adhesion γ and the effective modulus E\*.
//!
//! Begin with `docs/learn.md` of the repository, which derives the model by hand. It explains
//! why the springs may be independent, and where the rule of Hess comes from. It also computes the
//! force loop of a sphere, and a profile of five springs whose pull-off force rises in steps with
//! the preload. The examples on this page follow it.
//!
//! # A contact in five lines
//!
//! ```
//! use asperity::{Contact, Modulus, Move, Profile};
//!
//! // A sphere of 100 µm: the heights of its equivalent line are −x²/R, not −x²/(2R) as in a cut.
//! let heights: Vec<f64> = (-512..=512)
//!     .map(|i| -(1.0e-7 * f64::from(i)).powi(2) / 1.0e-4)
//!     .collect(); // m
//! let profile = Profile::from_heights(heights, 1.0e-7)?; // spacing, m
//! let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?)
//!     .work_of_adhesion(0.05)
//!     .build()?;
//! let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?; // N
//! println!(
//!     "{:?} N, {:?} J",
//!     cycle.pull_off_force(),
//!     cycle.dissipated_energy()
//! );
//! # let exact = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
//! # assert!((cycle.pull_off_force().unwrap() / exact - 1.0).abs() < 1e-4);
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! A [`Profile`] holds the heights or gaps of the equivalent line. Heights that are measured along
//! a line on a surface are not an equivalent line but a cut, whose rms gradient is 29 % smaller.
//! Read such heights with [`surface::Topography`]; [`ProfileBuilder::spectrum`] then makes
//! equivalent lines that have the spectrum of the surface.
//!
//! A [`Modulus`] holds the elastic constants. A [`contact::ContactBuilder`] holds the work of
//! adhesion and the stiffness of the instrument. A [`Cycle`] has the results of a loading: the
//! force curve as points and as columns, numbers such as the pull-off force, and the contact
//! patches.
//!
//! # A rough sphere, and its adhesion over the preload
//!
//! ```
//! use asperity::{Contact, Modulus, Move, ProfileBuilder};
//!
//! let rough = ProfileBuilder::new(1.0e-4, 4096).sphere(1.0e-3);
//! let rough = rough
//!     .self_affine(0.7)
//!     .rms_height(1.0e-7)
//!     .wavelengths(1.0e-4, 2.0e-7)
//!     .seed(1);
//! let contact = Contact::builder(&rough.build()?, Modulus::effective(2.0e6)?)
//!     .work_of_adhesion(0.02)
//!     .build()?;
//! let preloads = [0.0, 1.0e-5, 1.0e-4].map(Move::ToForce); // N
//! let forces = contact
//!     .reversals(&preloads, &[])?
//!     .into_iter()
//!     .map(|found| found.pull_off_force());
//! assert!(forces.is_sorted());
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! [`ProfileBuilder::run`] also computes κ, the Tabor number, the ideal pull-off force and the
//! regime of adhesion.
//!
//! # A scene
//!
//! A [`scene::Scene`] holds all data that a computation needs. [`scene::open`] opens a built-in
//! scene by its name, or reads a scene from a RON file. A scene must be checked before it is
//! computed ([`Scene::checked`]). [`run`] computes the scene of a file. If the scene names measured
//! surfaces, [`run`] looks for them in the folder of this file:
//!
//! ```
//! let document = asperity::scene::open("jkr-sphere")?;
//! let outcome = asperity::run(&document)?;
//! // Johnson, Kendall and Roberts: (3/2)πγR.
//! let expected = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
//! assert!((outcome.figures.pull_off_force.unwrap() / expected - 1.0).abs() < 2e-3);
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! A [`scene::Simulation`] computes many scenes one after another, and repeats only those steps of
//! the computation whose input has changed.
//!
//! # Conventions
//!
//! All values are in SI units. Heights are positive towards the half-space. The indentation d is 0
//! at first touch of the undeformed profile, and grows when the body is pressed. Compressive forces
//! are positive. N points at a distance Δx cover the length N Δx.
//!
//! # Crates
//!
//! Each crate computes the data in the column `to` from the data in the column `from`:
//!
//! | crate | from | to |
//! | --- | --- | --- |
//! | [`data`] | text | values with units, tables, files |
//! | [`contact`] | heights or gaps of the equivalent line, E\*, γ, a loading | [`Cycle`] |
//! | [`surface`] | measured files, forms, spectra | moments, equivalent lines |
//! | [`scene`] | a scene file | [`scene::Outcome`] with figures and regime |
//! | [`experiment`] | measured force curves and a scene | fitted values with their errors |
//! | [`study`] | many scenes | tables, statistics |
//!
//! Charts and reports are in further crates. The command line and the explorer are not in a crate
//! of their own, but in the modules [`cli`] and [`explorer`] of this crate.

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
