//! A case of the catalogue of checks, and random rough bodies on which some cases are computed.

use asperity_contact::{Contact, Cycle, Edges, LoadOptions, Modulus, Move, Profile};
use asperity_scene::{CheckedScene, Document, Outcome, Simulation};
use asperity_surface::SelfAffine;
use asperity_surface::lines::{Line, phases};
use std::error::Error;
use std::f64::consts::{PI, TAU};

pub(super) const CLOSED_FORM: &str = "closed form";
pub(super) const INDEPENDENT: &str = "independent computation";
pub(super) const SELF_CONSISTENCY: &str = "self-consistency";

/// What a case computes (a scene, or random bodies), with the function that measures the error.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject {
    /// Scene, given as the text of a scene file, and the function that measures the error.
    Scene(&'static str, fn(&CheckedScene) -> Measured),
    /// Function that measures the error on a random body. It is called for several bodies:
    /// self-affine profiles, noise, and profiles with few different heights. The error of the case
    /// is the largest of the returned errors.
    Bodies(fn(&Body) -> Measured),
}

/// Computation with a known result, on which the program is tested.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the case, such as `jkr-sphere`.
    pub name: &'static str,
    /// Family of the case: `closed-forms` for bodies with a known force curve, `laws` for laws that
    /// hold for every body, or `hard-cases` for extreme input, such as nearly equal gaps or very
    /// large loads.
    pub family: &'static str,
    /// Statement about the result of the case that must be true, as a sentence.
    pub holds: &'static str,
    /// Source of the correct result of the case: `closed form`, `independent computation` or
    /// `self-consistency`.
    pub evidence: &'static str,
    /// Name of the quantity whose error is measured, such as the pull-off force. The error must not
    /// exceed the bound of a [`Check`](crate::checks::Check).
    pub error_of: &'static str,
    pub(super) bounds: &'static [(Edges, f64)],
    pub(super) subject: Subject,
}

impl Case {
    pub(super) const fn row(
        kind: [&'static str; 2],
        texts: [&'static str; 3],
        bounds: &'static [(Edges, f64)],
        subject: Subject,
    ) -> Case {
        let [family, evidence] = kind;
        let [name, holds, error_of] = texts;
        Case {
            name,
            family,
            holds,
            evidence,
            error_of,
            bounds,
            subject,
        }
    }
}

/// Returns the bounds of the error of a case, one for each rule for the edges of contact patches.
/// `grid` is the bound for edges at springs, and `sub_cell` is the bound for edges between springs.
pub(super) const fn both(grid: f64, sub_cell: f64) -> [(Edges, f64); 2] {
    [(Edges::Grid, grid), (Edges::SubCell, sub_cell)]
}

pub(super) fn with(scene: &CheckedScene, path: &str, value: f64) -> Measured<CheckedScene> {
    Ok(Document::from_scene(scene, "check")?
        .set(path, &format!("{value:e}"))?
        .scene()
        .clone())
}

pub(super) fn outcome(scene: &CheckedScene) -> Measured<Outcome> {
    Ok(Simulation::default().run(scene, &|| false, &mut |_, _, _| Ok(()))?)
}

pub(super) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Measured<()> {
    if holds { Ok(()) } else { Err(what().into()) }
}

pub(super) fn relative_error(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

pub(super) fn relative_errors<const N: usize>(pairs: [(f64, f64); N]) -> Measured {
    largest(pairs.map(|(found, expected)| Ok(relative_error(found, expected))))
}

/// Returns the largest error. An error that is NaN counts as infinite.
pub(super) fn largest(errors: impl IntoIterator<Item = Measured>) -> Measured {
    errors.into_iter().try_fold(0.0, |most: f64, error| {
        let error = error?;
        Ok(if error.is_nan() {
            f64::INFINITY
        } else {
            most.max(error)
        })
    })
}

/// Error of a case, or the reason why it cannot be measured.
pub type Measured<T = f64> = Result<T, Box<dyn Error>>;

pub const RANDOM: u64 = 48;

/// Effective modulus E* of random bodies in Pa. `LENGTH` is their length in m, and `HEIGHT` is
/// their rms height or largest height in m.
const MODULUS: f64 = 2.0e6;
const LENGTH: f64 = 1.0e-4;
const HEIGHT: f64 = 1.0e-7;

/// Rigid rough profile on an adhesive elastic foundation: heights in m, length in m, effective
/// modulus E* in Pa, work of adhesion γ in J/m².
#[derive(Clone, Debug)]
pub struct Body {
    pub heights: Vec<f64>,
    pub length: f64,
    pub modulus: f64,
    pub work: f64,
    pub edges: Edges,
}

impl Body {
    /// Creates a random body. `seed` determines the kind of its profile and its heights. The same
    /// seed gives the same body on every machine.
    pub fn random(seed: u64, edges: Edges) -> Measured<Body> {
        let mut numbers = phases(seed, 1).map(|phase| phase / TAU);
        let mut next = || numbers.next().unwrap_or(0.0);
        let points = 20 + (300.0 * next()) as usize;
        // The work of adhesion is chosen so that springs at the edges of a contact patch as long as
        // the profile stretch by 1e−3 to 3 times `HEIGHT`.
        let reach = HEIGHT * 10.0_f64.powf(-3.0 + 3.5 * next());
        let work = reach * reach * MODULUS / (PI * LENGTH);
        let heights = match seed % 3 {
            0 => {
                let spectrum = SelfAffine {
                    hurst: 0.1 + 0.8 * next(),
                    first: 1,
                    last: points as u64 / 2,
                    roll_off_mode: 0.0,
                };
                let heights = spectrum.heights(seed, points)?;
                Line::new(LENGTH, points, None, Some(&heights), HEIGHT)?
                    .heights()
                    .collect()
            }
            1 => (0..points).map(|_| HEIGHT * next()).collect(),
            _ => (0..points)
                .map(|_| 0.25 * HEIGHT * (5.0 * next()).floor())
                .collect(),
        };
        Ok(Body {
            heights,
            length: LENGTH,
            modulus: MODULUS,
            work,
            edges,
        })
    }

    /// Returns the height difference in m between the lowest and the highest point of the profile.
    pub fn depth(&self) -> f64 {
        let mut least = f64::INFINITY;
        let mut most = f64::NEG_INFINITY;
        for height in &self.heights {
            least = height.min(least);
            most = height.max(most);
        }
        most - least
    }

    /// Returns the largest stretch of the springs in m, by eq. (10) of Popov and Filippov (2012). A
    /// spring has this stretch at the edge of a contact patch that is as long as the whole profile.
    pub fn stretch(&self) -> f64 {
        (PI * self.length * self.work / self.modulus).sqrt()
    }

    /// Returns a force in N that is of the same order of magnitude as the forces on the body.
    pub fn force_unit(&self) -> f64 {
        self.modulus * self.length * (self.depth() + self.stretch())
    }

    /// Returns `COUNT` random indentations in m, between just before separation and full contact. A
    /// loading turns at each of them.
    pub fn turns<const COUNT: usize>(&self, seed: u64) -> [f64; COUNT] {
        let low = -0.9 * self.stretch();
        let high = 1.1 * self.depth() + 1e-3 * self.stretch();
        let mut turns = phases(seed, 1).map(|phase| low + (high - low) * phase / TAU);
        std::array::from_fn(|_| turns.next().unwrap_or(low))
    }

    /// Computes a loading that begins with the body in separation and goes to each indentation of
    /// `turns` in m, in this order. If `separates` is true, the loading ends in separation.
    /// `samples` is the number of points of the force curve in each move.
    pub fn load(&self, turns: &[f64], separates: bool, samples: u64) -> Measured<Cycle> {
        let turns = turns.iter().map(|&turn| Move::ToIndentation(turn));
        let stages: Vec<Move> = turns
            .chain(separates.then_some(Move::ToSeparation))
            .collect();
        let profile = Profile::from_heights(
            self.heights.as_slice(),
            self.length / self.heights.len() as f64,
        )?;
        let contact = Contact::builder(&profile, Modulus::effective(self.modulus)?);
        let contact = contact
            .work_of_adhesion(self.work)
            .edges(self.edges)
            .build()?;
        Ok(contact.load_with(&stages, LoadOptions::default().samples(samples))?)
    }
}
