//! Profiles for programs: heights from measurements, a form or a random spectrum.

use crate::Error;
use crate::scene::MOST_POINTS;
use crate::simulation::RunError;
use crate::surface::{Form, Line, SelfAffine};

/// One-dimensional equivalent profile of a rigid body: heights of equally spaced points, positive towards the
/// half-space.
///
/// N points at a distance Δx cover the length N Δx; each lies in the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub(crate) line: Line,
}

impl Profile {
    /// Profile of measured or computed heights (m) at a spacing (m).
    ///
    /// # Errors
    /// [`Error::Value`] without points or with a spacing that is not above 0, [`Error::Run`] with a height that is not
    /// finite.
    pub fn from_heights(heights: &[f64], spacing: f64) -> Result<Self, Error> {
        check_points(heights.len())?;
        check_length("spacing", spacing)?;
        let length = spacing * heights.len() as f64;
        check_length("spacing times points", length)?;
        let line = Line::new(length, heights.len(), None, Some(heights), 1.0).map_err(RunError::from)?;
        Ok(Profile { line })
    }

    /// Equivalent profile of a smooth sphere of a radius (m) on a number of points along a length (m).
    ///
    /// The equivalent profile z = −x²/R has half the radius of the sphere (rule of the method of dimensionality
    /// reduction).
    ///
    /// # Errors
    /// [`Error::Value`] for a radius or a length that is not above 0, or without points.
    pub fn sphere(radius: f64, length: f64, points: usize) -> Result<Self, Error> {
        check_points(points)?;
        check_length("radius", radius)?;
        check_length("length", length)?;
        let form = Form::Paraboloid { radius };
        let line = Line::new(length, points, Some(&form), None, 0.0).map_err(RunError::from)?;
        Ok(Profile { line })
    }

    /// Random self-affine profile: cosines with amplitudes ∝ k^(−H−1/2) and random phases, scaled to an rms height (m).
    ///
    /// `spectrum` holds the Hurst exponent, the modes k and the roll-off, in waves per length. A seed determines the phases on
    /// any machine and for any number of points.
    ///
    /// # Errors
    /// [`Error::Value`] for modes beyond half the number of points, a Hurst exponent outside (0, 1), or lengths that are
    /// not above 0.
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
        let SelfAffine { hurst, first, last, roll_off } = spectrum;
        check("Hurst exponent", hurst, hurst > 0.0 && hurst < 1.0, "above 0 and below 1")?;
        check("first mode", first as f64, first >= 1, "at least 1")?;
        let most = "from the first mode to half the number of points";
        check("last mode", last as f64, (first..=points as u64 / 2).contains(&last), most)?;
        let is_allowed = (0.0..=last as f64).contains(&roll_off);
        check("roll-off", roll_off, is_allowed, "from 0, for none, to the last mode")?;
        let heights = spectrum.heights(seed, points).map_err(RunError::from)?;
        let line = Line::new(length, points, None, Some(&heights), rms_height).map_err(RunError::from)?;
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

fn check(name: &'static str, value: f64, is_allowed: bool, allowed: &'static str) -> Result<(), Error> {
    if is_allowed { Ok(()) } else { Err(Error::Value { name, value, allowed }) }
}

const _: () = assert!(MOST_POINTS == 268_435_456);

fn check_points(points: usize) -> Result<(), Error> {
    let is_allowed = (1..=MOST_POINTS as usize).contains(&points);
    check("number of points", points as f64, is_allowed, "from 1 to 268435456")
}

fn check_length(name: &'static str, value: f64) -> Result<(), Error> {
    check(name, value, value > 0.0 && value.is_finite(), "finite and above 0 m")
}
