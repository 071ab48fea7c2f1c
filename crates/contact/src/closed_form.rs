//! Closed-form solutions against which the solvers are checked. They describe the adhesive contact
//! of a body with the depth b rⁿ, of a flat punch and of a flat face. The power law includes the
//! sphere of Johnson, Kendall and Roberts (n = 2) and the cone (n = 1).

use super::modulus::Modulus;
use std::f64::consts::PI;

/// Closed-form solution for a body with the equivalent profile g(x) = c |x|ⁿ on an elastic
/// half-space with adhesion. The solution has the force and the indentation as functions of the
/// contact radius.
///
/// ```
/// use asperity_contact::ClosedForm;
/// use asperity_contact::Modulus;
///
/// let sphere = ClosedForm::sphere(1.0e-4, Modulus::effective(1.0e6)?, 0.05);
/// let (radius, force) = sphere.force_controlled_pull_off();
/// // Johnson, Kendall and Roberts: −(3/2)πγR, and the force is smallest there.
/// assert!((force / (-1.5 * std::f64::consts::PI * 0.05 * 1.0e-4) - 1.0).abs() < 1e-14);
/// assert!(sphere.force(1.01 * radius) > force && sphere.force(0.99 * radius) > force);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedForm {
    /// Coefficient c of the equivalent profile c |x|ⁿ in m^(1−n).
    pub line_coefficient: f64,
    /// Exponent n of the equivalent profile c |x|ⁿ, above 1/2.
    pub exponent: f64,
    /// Effective modulus E* in Pa.
    pub modulus: f64,
    /// Work of adhesion γ in J/m².
    pub work_of_adhesion: f64,
}

impl ClosedForm {
    /// Returns the ideal pull-off force F_a,max = √(πγE*L³) in N of a flat face of length L in m.
    /// Here γ is the work of adhesion in J/m² and E* the effective modulus in Pa. Popov and
    /// Filippov (2012) have this formula as eq. (14), after Kendall (1971).
    pub fn ideal_pull_off_force(work_of_adhesion: f64, modulus: f64, length: f64) -> f64 {
        (PI * work_of_adhesion * modulus * length.powi(3)).sqrt()
    }

    /// Returns the pull-off force √(8π a³ E* γ) in N of a flat punch of radius a (m), after Kendall
    /// (1971). Here E* is the effective modulus in Pa and γ the work of adhesion in J/m².
    ///
    /// ```
    /// use asperity_contact::ClosedForm;
    ///
    /// // A punch as wide as the profile is a flat face: L = 2a.
    /// let [punch, face] = [
    ///     ClosedForm::flat_punch(1.0e-5, 1.0e6, 0.05),
    ///     ClosedForm::ideal_pull_off_force(0.05, 1.0e6, 2.0e-5),
    /// ];
    /// assert!((punch / face - 1.0).abs() < 1e-14);
    /// ```
    pub fn flat_punch(radius: f64, modulus: f64, work_of_adhesion: f64) -> f64 {
        (8.0 * PI * radius.powi(3) * modulus * work_of_adhesion).sqrt()
    }

    /// Creates the closed-form solution of Johnson, Kendall and Roberts for a sphere of the radius
    /// R = `radius` in m. Its equivalent profile is g(x) = x²/R.
    pub fn sphere(radius: f64, modulus: Modulus, work_of_adhesion: f64) -> Self {
        let modulus = modulus.pascals();
        ClosedForm {
            line_coefficient: radius.recip(),
            exponent: 2.0,
            modulus,
            work_of_adhesion,
        }
    }

    /// Creates the closed-form solution for a cone whose flank makes the angle θ = `angle` in rad
    /// with the surface. Its equivalent profile is g(x) = (π/2) |x| tan θ.
    ///
    /// ```
    /// use asperity_contact::ClosedForm;
    /// use asperity_contact::Modulus;
    ///
    /// let cone = ClosedForm::cone(0.1, Modulus::effective(1.0e6)?, 0.05);
    /// // Without adhesion F = π a² E* tan θ / 2 at a contact radius a.
    /// let bare = ClosedForm { work_of_adhesion: 0.0, ..cone };
    /// let expected = 0.5 * std::f64::consts::PI * 1.0e-10 * 1.0e6 * 0.1_f64.tan();
    /// assert!((bare.force(1.0e-5) / expected - 1.0).abs() < 1e-14);
    /// assert!(cone.force(1.0e-5) < bare.force(1.0e-5));
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn cone(angle: f64, modulus: Modulus, work_of_adhesion: f64) -> Self {
        let modulus = modulus.pascals();
        ClosedForm {
            line_coefficient: 0.5 * PI * angle.tan(),
            exponent: 1.0,
            modulus,
            work_of_adhesion,
        }
    }

    /// Returns the indentation d(a) = c aⁿ − √(2π a γ/E*) in m at the contact radius a in m. The
    /// symbols c, n, E* and γ are the fields of [`ClosedForm`].
    pub fn indentation(&self, radius: f64) -> f64 {
        // Rule of Hess, eq. (3) of Popov and Filippov (2012).
        let stretch = (2.0 * PI * radius * self.work_of_adhesion / self.modulus).sqrt();
        self.line_coefficient * radius.powf(self.exponent) - stretch
    }

    /// Returns the force F(a) = 2E* n c a^(n+1)/(n+1) − √(8π a³ E* γ) in N at the contact radius a
    /// in m. The symbols c, n, E* and γ are the fields of [`ClosedForm`].
    pub fn force(&self, radius: f64) -> f64 {
        let n = self.exponent;
        let scale = 2.0 * self.modulus * n * self.line_coefficient;
        let pressed = scale * radius.powf(n + 1.0) / (n + 1.0);
        pressed - self.detaching(radius)
    }

    /// Returns the contact radius a in m and the force F in N at pull-off under force control.
    /// There the derivative dF/da is zero.
    pub fn force_controlled_pull_off(&self) -> (f64, f64) {
        let n = self.exponent;
        let radius = self.critical_radius(9.0);
        let factor = -(2.0 * n - 1.0) / (2.0 * (n + 1.0));
        (radius, factor * self.detaching(radius))
    }

    /// Returns the contact radius a in m and the force in N at pull-off under displacement control.
    /// There the derivative dd/da of the indentation d is zero.
    pub fn displacement_controlled_pull_off(&self) -> (f64, f64) {
        let n = self.exponent;
        let radius = self.critical_radius(1.0);
        let factor = -(2.0 * n + 1.0) / (2.0 * (n + 1.0));
        (radius, factor * self.detaching(radius))
    }

    /// Returns the contact radius [m π γ/(2n²c²E*)]^(1/(2n−1)) in m, where m = `multiple` and the
    /// other symbols are the fields of [`ClosedForm`].
    fn critical_radius(&self, multiple: f64) -> f64 {
        let n = self.exponent;
        let scale = 2.0 * (n * self.line_coefficient).powi(2) * self.modulus;
        (multiple * PI * self.work_of_adhesion / scale).powf((2.0 * n - 1.0).recip())
    }

    /// Returns the part √(8π a³ E* γ) of the force in N that adhesion contributes at the contact
    /// radius a in m.
    fn detaching(&self, radius: f64) -> f64 {
        ClosedForm::flat_punch(radius, self.modulus, self.work_of_adhesion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_is_jkr() {
        let (radius, work) = (2.0e-3, 0.07);
        let body = ClosedForm::sphere(radius, Modulus::effective(1.5e6).unwrap(), work);
        let scale = PI * work * radius;
        assert!((body.force_controlled_pull_off().1 / (-1.5 * scale) - 1.0).abs() < 1e-14);
        assert!(
            (body.displacement_controlled_pull_off().1 / (-5.0 / 6.0 * scale) - 1.0).abs() < 1e-14
        );
    }

    #[test]
    fn pull_off_radii_are_where_the_derivatives_vanish() {
        for (line_coefficient, exponent) in [(0.5, 1.0), (2.5, 1.5), (0.7, 4.0)] {
            let body = ClosedForm {
                line_coefficient,
                exponent,
                modulus: 3.0,
                work_of_adhesion: 0.5,
            };
            let (a, force) = body.force_controlled_pull_off();
            assert!((body.force(a) / force - 1.0).abs() < 1e-12);
            assert!(body.force(a * 1.001) > force && body.force(a * 0.999) > force);
            let (a, force) = body.displacement_controlled_pull_off();
            assert!((body.force(a) / force - 1.0).abs() < 1e-12);
            let d = body.indentation(a);
            assert!(body.indentation(a * 1.001) > d && body.indentation(a * 0.999) > d);
        }
    }
}
