//! Profiles for programs: heights from measurements, a form or a random spectrum.

use crate::scene::{Form, MOST_POINTS};
use crate::surface::{Line, SelfAffine, SurfaceError, UnitRoughness};
use std::sync::Arc;
use thiserror::Error;

/// One-dimensional equivalent profile of a rigid body: heights of equally spaced points, positive towards the
/// half-space.
///
/// N points at a distance Δx cover the length N Δx; each lies in the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    line: Line,
}

/// Reason why a profile is refused.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ProfileError {
    /// The number of points is out of range.
    #[error("{0} points; allowed: from 1 to {MOST_POINTS}")]
    Points(usize),
    /// A length is out of range.
    #[error("{name} = {value:e} m; allowed: finite and above 0 m")]
    Length {
        /// Name of the length.
        name: &'static str,
        /// Length, m.
        value: f64,
    },
    /// The modes do not fit the profile.
    #[error("modes {first} to {last}; allowed: from 1 to {most}, half the number of points")]
    Modes {
        /// First mode.
        first: u64,
        /// Last mode.
        last: u64,
        /// Largest mode of the profile.
        most: u64,
    },
    /// The Hurst exponent is out of range.
    #[error("Hurst exponent {0}; allowed: above 0 and below 1")]
    Hurst(f64),
    /// A height is not finite, or the memory does not suffice.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

impl Profile {
    /// Profile of measured or computed heights (m) at a spacing (m).
    ///
    /// # Errors
    /// [`ProfileError`] without points, with a spacing that is not above 0, or with a height that is not finite.
    pub fn from_heights(heights: &[f64], spacing: f64) -> Result<Self, ProfileError> {
        check_points(heights.len())?;
        check_length("spacing", spacing)?;
        let length = spacing * heights.len() as f64;
        check_length("spacing times points", length)?;
        Ok(Profile { line: Line::new(length, heights.len(), None, Some(heights), 1.0)? })
    }

    /// Equivalent profile of a smooth sphere of a radius (m) on so many points along a length (m).
    ///
    /// The equivalent profile z = −x²/R has half the radius of the sphere (rule of the method of dimensionality
    /// reduction).
    ///
    /// # Errors
    /// [`ProfileError`] for a radius or a length that is not above 0, or without points.
    pub fn sphere(radius: f64, length: f64, points: usize) -> Result<Self, ProfileError> {
        check_points(points)?;
        check_length("radius", radius)?;
        check_length("length", length)?;
        Ok(Profile { line: Line::new(length, points, Some(&Form::Paraboloid { radius }), None, 0.0)? })
    }

    /// Random self-affine profile: cosines with amplitudes ∝ k^(−H−1/2) and random phases, scaled to an rms height (m).
    ///
    /// `spectrum` holds the Hurst exponent and the modes k, in waves per length. A seed determines the phases on
    /// any machine and for any number of points.
    ///
    /// # Errors
    /// [`ProfileError`] for modes beyond half the number of points, a Hurst exponent outside (0, 1), or lengths that are
    /// not above 0.
    pub fn self_affine(
        spectrum: SelfAffine,
        rms_height: f64,
        length: f64,
        points: usize,
        seed: u64,
    ) -> Result<Self, ProfileError> {
        check_points(points)?;
        check_length("rms height", rms_height)?;
        check_length("length", length)?;
        let SelfAffine { hurst, first, last } = spectrum;
        if !(hurst > 0.0 && hurst < 1.0) {
            return Err(ProfileError::Hurst(hurst));
        }
        let most = points as u64 / 2;
        if first < 1 || last < first || last > most {
            return Err(ProfileError::Modes { first, last, most });
        }
        let unit = UnitRoughness::synthesize(spectrum, seed, points)?;
        Ok(Profile { line: Line::new(length, points, None, Some(&unit.heights), rms_height)? })
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.line.points
    }

    /// Distance between points, m.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.line.spacing
    }

    /// Length, m: the number of points times their distance.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.line.length
    }

    /// Heights, m.
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.line.heights()
    }

    /// Gaps below the highest point, m, at least 0.
    #[must_use]
    pub fn gaps(&self) -> &[f64] {
        &self.line.gaps
    }

    /// Gaps to be shared with a contact.
    pub(crate) fn shared_gaps(&self) -> &Arc<Vec<f64>> {
        &self.line.gaps
    }
}

fn check_points(points: usize) -> Result<(), ProfileError> {
    if (1..=MOST_POINTS as usize).contains(&points) { Ok(()) } else { Err(ProfileError::Points(points)) }
}

fn check_length(name: &'static str, value: f64) -> Result<(), ProfileError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ProfileError::Length { name, value }) }
}
