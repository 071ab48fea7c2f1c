//! Profiles for programs that use the library: from measured heights, a form or a random spectrum.

use crate::error::Error;
use crate::scene::fields::MOST_POINTS;
use crate::scene::model::SPRINGS_PER_WAVE;
use crate::simulation::outcome::RunError;
use asperity_surface::{Form, Line, SelfAffine};

/// One-dimensional equivalent profile of a rigid body: heights at equally spaced points, positive towards the half-space.
///
/// N points at a spacing Δx cover the length N Δx; each lies in the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub(crate) line: Line,
}

impl Profile {
    /// Creates a profile of measured or computed heights (m) at this spacing (m).
    ///
    /// # Errors
    /// [`Error::Value`] without points, or for a spacing or a height out of its range.
    pub fn from_heights(heights: &[f64], spacing: f64) -> Result<Self, Error> {
        check_points(heights.len())?;
        check_length("spacing", spacing)?;
        let is_allowed = |height: &f64| height.abs() <= LARGEST;
        if let Some(index) = heights.iter().position(|height| !is_allowed(height)) {
            check(&format!("height with index {index}"), heights[index], false, "from -1e50 to 1e50 m")?;
        }
        let length = spacing * heights.len() as f64;
        check_length("spacing times points", length)?;
        let line = Line::new(length, heights.len(), None, Some(heights), 1.0).map_err(RunError::from)?;
        Profile::of(line)
    }

    /// Creates the equivalent profile of a smooth sphere of this radius (m) on `points` points along a length (m).
    ///
    /// The equivalent profile z = −x²/R has half the radius of the sphere, by the method of dimensionality reduction.
    ///
    /// # Errors
    /// [`Error::Value`] for a radius or a length out of its range, or without points.
    pub fn sphere(radius: f64, length: f64, points: usize) -> Result<Self, Error> {
        check_points(points)?;
        check_length("radius", radius)?;
        check_length("length", length)?;
        let form = Form::Paraboloid { radius };
        let line = Line::new(length, points, Some(&form), None, 0.0).map_err(RunError::from)?;
        Profile::of(line)
    }

    /// Creates a random self-affine profile: cosines with amplitudes ∝ k^(−H−1/2) and random phases, scaled to an rms
    /// height (m).
    ///
    /// `spectrum` holds the Hurst exponent, the modes k and the mode of the roll-off, all modes in waves per length. A seed
    /// determines the phases on any machine and for any number of points.
    ///
    /// # Errors
    /// [`Error::Value`] for modes beyond a quarter of the number of points (a resolved wave has four springs), a roll-off
    /// between 0 and 1 wave per length (perhaps a wavelength in m), a Hurst exponent outside (0, 1), or a length out of its
    /// range.
    pub fn self_affine(
        spectrum: SelfAffine,
        rms_height: f64,
        length: f64,
        points: usize,
        seed: u64,
    ) -> Result<Self, Error> {
        check_points(points)?;
        check_length("rms height", rms_height)?;
        check_length("length", length)?;
        let SelfAffine { hurst, first, last, roll_off_mode } = spectrum;
        check("Hurst exponent", hurst, hurst > 0.0 && hurst < 1.0, "above 0 and below 1")?;
        check("first mode", first as f64, first >= 1, "at least 1")?;
        let most = "from the first mode to a quarter of the number of points, for four springs to a wave";
        check("last mode", last as f64, (first..=points as u64 / SPRINGS_PER_WAVE).contains(&last), most)?;
        let is_allowed = roll_off_mode == 0.0 || (1.0..=last as f64).contains(&roll_off_mode);
        let allowed = "0 for none, or from 1 to the last mode, in waves per length";
        check("mode of the roll-off", roll_off_mode, is_allowed, allowed)?;
        let heights = spectrum.heights(seed, points).map_err(RunError::from)?;
        let line = Line::new(length, points, None, Some(&heights), rms_height).map_err(RunError::from)?;
        Profile::of(line)
    }

    fn of(line: Line) -> Result<Self, Error> {
        let deepest = line.deepest;
        check("largest gap of the profile", deepest, deepest <= LARGEST, "at most 1e50 m")?;
        Ok(Profile { line })
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.line.points
    }

    /// Distance between points, m.
    pub fn spacing(&self) -> f64 {
        self.line.spacing
    }

    /// Length, m: the number of points times their distance.
    pub fn length(&self) -> f64 {
        self.line.length
    }

    /// Heights, m.
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.line.heights()
    }

    /// Gaps below the highest point, m, at least 0.
    pub fn gaps(&self) -> &[f64] {
        &self.line.gaps
    }
}

/// Largest value, in SI units, of any quantity of a contact; its inverse is the smallest length, modulus or stiffness.
/// Products of such values are finite.
pub(crate) const LARGEST: f64 = 1e50;

/// Returns true for a positive value within the allowed magnitudes.
pub(crate) fn is_positive(value: f64) -> bool {
    (1e-50..=LARGEST).contains(&value)
}

pub(crate) fn check(name: &str, value: f64, is_allowed: bool, allowed: &'static str) -> Result<(), Error> {
    if is_allowed { Ok(()) } else { Err(Error::Value { name: name.to_owned(), value, allowed }) }
}

const _: () = assert!(MOST_POINTS == 268_435_456);

fn check_points(points: usize) -> Result<(), Error> {
    let is_allowed = (1..=MOST_POINTS as usize).contains(&points);
    check("number of points", points as f64, is_allowed, "from 1 to 268435456")
}

fn check_length(name: &'static str, value: f64) -> Result<(), Error> {
    check(name, value, is_positive(value), "from 1e-50 to 1e50 m")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_values_are_named_with_what_is_allowed() {
        let of = |profile: Result<Profile, Error>| profile.unwrap_err().to_string();
        let self_affine = |last, roll_off_mode| {
            let spectrum = SelfAffine { hurst: 0.7, first: 1, last, roll_off_mode };
            Profile::self_affine(spectrum, 1e-7, 1e-4, 1024, 1)
        };
        for (refused, expected) in [
            (
                of(Profile::from_heights(&[1.0, f64::NAN], 1e-7)),
                "height with index 1 = NaN; allowed: from -1e50 to 1e50 m",
            ),
            (of(Profile::from_heights(&[], 1e-7)), "number of points = 0; allowed: from 1 to 268435456"),
            (of(Profile::from_heights(&[1.0], 1e-100)), "spacing = 1e-100; allowed: from 1e-50 to 1e50 m"),
            (
                of(Profile::sphere(1e-40, 1e40, 64)),
                "largest gap of the profile = 2.5000000000000003e119; allowed: at most 1e50 m",
            ),
            (
                of(self_affine(5000, 0.0)),
                "last mode = 5000; allowed: from the first mode to a quarter of the number of points, for four springs to a wave",
            ),
            (
                of(self_affine(256, 2e-5)),
                "mode of the roll-off = 2e-5; allowed: 0 for none, or from 1 to the last mode, in waves per length",
            ),
        ] {
            assert_eq!(refused, expected);
        }
        assert!(self_affine(256, 0.0).is_ok() && self_affine(256, 4.5).is_ok());
    }
}
