//! The cases, family by family, and their shared parts.

pub mod adhesion;
pub mod closed_forms;
pub mod laws;
pub mod lines;
pub mod scales;

use super::case::{CASE, Case, Evidence, Scope};
use super::{Body, Extended, Fault, ensure, follow};
use crate::contact::{CurvePoint, History, LegRecord};
use crate::scene::{Edges, Move};
use crate::surface::SelfAffine;

/// Spectrum of profiles whose spectrum does not matter.
const SPECTRUM: SelfAffine = SelfAffine { hurst: 0.7, first: 1, last: 256 };

/// Work of adhesion in the transition of a profile of [`SPECTRUM`] from adhesive to non-adhesive, J/m².
const WORK: f64 = 2.0e-5;

/// A profile of [`SPECTRUM`].
fn rough(points: usize, work: f64) -> Result<Body, Fault> {
    Body::rough(SelfAffine { last: (points as u64 / 2).min(SPECTRUM.last), ..SPECTRUM }, 1, points, work)
}

/// Shared fields of the cases that compare contact and forces with the rules.
const RULES: Case = Case {
    evidence: &[Evidence::IndependentComputation],
    error_of: "force",
    scope: Scope::BothEdges(1e-15, 1e-15),
    ..CASE
};

/// The largest error; NaN if one of them is NaN.
fn largest(errors: impl IntoIterator<Item = Result<f64, Fault>>) -> Result<f64, Fault> {
    errors.into_iter().try_fold(0.0, |worst: f64, error| {
        let error = error?;
        Ok(if worst.is_nan() || error <= worst { worst } else { error })
    })
}

/// Largest difference of a body from the rules on its tour.
fn on_tour(body: &Body, edges: Edges) -> Result<f64, Fault> {
    Ok(follow(body, edges, &body.tour())?.force)
}

/// Difference of a number from the expected one, over the expected one.
fn relative_error(found: f64, expected: Extended) -> f64 {
    (Extended::from(found) - expected).abs().rounded() / expected.abs().rounded()
}

/// The two loading stages of a history.
fn two_legs(history: &History) -> Result<[&LegRecord; 2], Fault> {
    match &history.legs[..] {
        [loading, unloading] => Ok([loading, unloading]),
        legs => Err(Fault::Wrong(format!("{} legs in place of two", legs.len()))),
    }
}

/// Loading to an indentation, and unloading.
fn press_and_pull(indentation: f64) -> [Move; 2] {
    [Move::ToIndentation(indentation), Move::ToSeparation]
}

/// All points of a loading stage.
fn points(record: &LegRecord) -> impl Iterator<Item = &CurvePoint> {
    record.curve.iter().chain([&record.largest, &record.smallest])
}

/// Checks that a history equals another with indentations, forces and energies multiplied, to the last bit.
fn same_bits(one: &History, other: &History, length: f64, force: f64) -> Result<(), Fault> {
    ensure(one.legs.len() == other.legs.len(), || "another number of legs".into())?;
    for (index, (one, other)) in one.legs.iter().zip(&other.legs).enumerate() {
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a == 0.0 && b == 0.0);
        let points_agree = one.curve.len() == other.curve.len()
            && points(one).zip(points(other)).all(|(a, b)| {
                same(a.indentation * length, b.indentation)
                    && same(a.force * force, b.force)
                    && (a.springs, a.fragments) == (b.springs, b.fragments)
            });
        let same_energy = same(one.released_energy * length * force, other.released_energy);
        ensure(points_agree && same_energy, || {
            format!("leg {index}, lengths times {length:e}, forces times {force:e}: other bits")
        })?;
    }
    Ok(())
}

/// The same spring sets, mirrored or not.
fn indices(fragments: &[(usize, usize)]) -> Vec<usize> {
    fragments.iter().flat_map(|&(first, last)| first..=last).collect()
}
