//! The effective modulus of two bodies in contact.

use super::error::{ContactError, check, is_positive};

/// Effective modulus E* of two bodies in contact, from 1e-50 to 1e50 Pa.
///
/// ```
/// use asperity_contact::Modulus;
///
/// // Rubber under a rigid body: E/(1 − ν²).
/// let rubber = Modulus::isotropic(3.0e6, 0.5)?;
/// assert!((rubber.pascals() / 4.0e6 - 1.0).abs() < 1e-15);
/// let refused = Modulus::isotropic(3.0e6, 0.7).unwrap_err();
/// assert_eq!(refused.to_string(), "Poisson's ratio = 0.7; allowed: above -1 and at most 0.5");
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Modulus(f64);

const PASCALS: &str = "from 1e-50 to 1e50 Pa";

impl Modulus {
    /// Creates an effective modulus from its value E* in Pa.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a value that is not from 1e-50 to 1e50.
    pub fn effective(pascals: f64) -> Result<Self, ContactError> {
        check("effective modulus", pascals, is_positive(pascals), PASCALS)?;
        Ok(Modulus(pascals))
    }

    /// Computes the effective modulus E/(1 − ν²) of an isotropic elastic body against a rigid body.
    /// E is Young's modulus in Pa and ν is Poisson's ratio.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] if Young's modulus is not from 1e-50 to 1e50 Pa. Returns the
    /// same error if Poisson's ratio is −1 or less, or more than 0.5.
    pub fn isotropic(youngs_modulus: f64, poisson_ratio: f64) -> Result<Self, ContactError> {
        let is_allowed = is_positive(youngs_modulus);
        check("Young's modulus", youngs_modulus, is_allowed, PASCALS)?;
        let is_allowed = poisson_ratio > -1.0 && poisson_ratio <= 0.5;
        let allowed = "above -1 and at most 0.5";
        check("Poisson's ratio", poisson_ratio, is_allowed, allowed)?;
        // For ν close to −1, (1 − ν)(1 + ν) is more accurate than 1 − ν².
        Modulus::effective(youngs_modulus / ((1.0 - poisson_ratio) * (1.0 + poisson_ratio)))
    }

    /// Computes the effective modulus E* of two elastic bodies: 1/E* = 1/E₁* + 1/E₂*, eq. (2) of
    /// Popov and Filippov (2012). E₁* and E₂* are the effective moduli of the two bodies, each
    /// against a rigid body.
    ///
    /// ```
    /// use asperity_contact::Modulus;
    ///
    /// let body = Modulus::isotropic(2.0e9, 0.3)?;
    /// assert_eq!(Modulus::pair(body, body)?.pascals(), 0.5 * body.pascals());
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a result below 1e-50 Pa.
    pub fn pair(first: Modulus, second: Modulus) -> Result<Self, ContactError> {
        let softer = first.0.min(second.0);
        let stiffer = first.0.max(second.0);
        Modulus::effective(softer / (1.0 + softer / stiffer))
    }

    /// Returns the effective modulus E* in Pa.
    pub fn pascals(self) -> f64 {
        self.0
    }
}
