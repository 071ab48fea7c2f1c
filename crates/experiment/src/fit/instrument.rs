//! Stiffness of the instrument: its initial value on a hard specimen, and the comparison of the
//! fitted value with the stated one and with the slope of the contact.
//!
//! The displacement of the instrument is the indentation plus the deflection F/k. Its slopes
//! therefore obey 1/s = 1/s_c + 1/k, where s = dF/dD is the slope of the curve, s_c = dF/dd the
//! slope of the contact and k the stiffness. On a hard specimen s is nearly k.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::Extent;
use crate::error::ExperimentError;
use crate::fit::parameter::{Parameter, Values};
use crate::fit::reason::{Reason, slope_when_pressed};
use asperity_contact::motion::Stage;
use asperity_contact::{Contact, Modulus};
use asperity_data::{Note, format_rounded};

/// Ratio of the fitted and the stated stiffness beyond which a wrong unit of the force is more
/// likely than a wrong stiffness. The nominal stiffness of a cantilever may be off by a factor of
/// 3.
const FAR: f64 = 4.0;
/// Smallest difference from 1 of the ratio of the fitted and the stated stiffness that a sentence
/// reports. It is below the error of usual calibrations.
const NOTABLE: f64 = 0.02;
/// Smallest slope of the contact, divided by the stiffness of the instrument, for which the
/// specimen counts as hard. An error of E* by 10 % then changes the stiffness by less than 1 %.
const HARD: f64 = 10.0;
/// Relative error of E* that the sentence about a specimen that is not hard takes as an example.
const ERROR_OF_MODULUS: f64 = 0.1;
/// Exponent of E* in the slope of the contact of a sphere at a given force.
const EXPONENT: f64 = 2.0 / 3.0;
/// Largest slope of a curve, as a share of the slope of the contact, from which the initial
/// stiffness is computed. With a larger slope, the deflection of the instrument is too small a part
/// of the displacement.
const MOST_OF_CONTACT: f64 = 0.9;
/// Smallest and largest indentation in m between which the indentation at a given force is sought.
const INDENTATIONS: (f64, f64) = (1e-15, 1.0);
/// Number of bisections of [`INDENTATIONS`], after which the range is narrower than the rounding.
const BISECTIONS: usize = 60;
/// Relative step of the indentation in the numerical derivative that gives the slope.
const STEP: f64 = 1e-3;

/// Returns the slope dF/dd in N/m of a contact without adhesion at a force in N. `modulus` is the
/// effective modulus in Pa.
pub(crate) fn slope_of_contact(
    contact: &Contact,
    modulus: f64,
    force: f64,
) -> Result<f64, ExperimentError> {
    let contact = contact.with(Modulus::effective(1.0)?).build()?;
    let stage = Stage::approach(&contact)?;
    let (mut low, mut high) = INDENTATIONS;
    for _ in 0..BISECTIONS {
        let middle = (low * high).sqrt();
        if modulus * stage.point(middle)?.force < force {
            low = middle;
        } else {
            high = middle;
        }
    }
    let below = stage.point((1.0 - STEP) * low)?.force;
    let above = stage.point((1.0 + STEP) * low)?.force;
    Ok(modulus * (above - below) / (2.0 * STEP * low))
}

/// Returns the force in N that a body without adhesion bears at the largest force of a curve. By
/// JKR theory, adhesion acts at large forces like a further compression of twice the pull-off
/// force.
pub(crate) fn carried_force(curve: &MeasuredCurve) -> f64 {
    let force = Extent::of(curve.force.iter().copied());
    let pull_off = curve.noise.max(-force.low);
    force.high.max(curve.noise) + 2.0 * pull_off
}

/// Returns the stiffness of the instrument in N/m that follows from the slope of the curve, if the
/// effective modulus `modulus` in Pa is known. Returns `None` if the slope of the curve is nearly
/// that of the contact alone, so that it does not determine the stiffness.
pub(crate) fn stiffness_by_slope(
    curve: &MeasuredCurve,
    contact: &Contact,
    modulus: f64,
) -> Result<Option<f64>, ExperimentError> {
    let slope = slope_when_pressed(curve);
    let of_contact = slope_of_contact(contact, modulus, carried_force(curve))?;
    let is_of_instrument = slope > 0.0 && slope < MOST_OF_CONTACT * of_contact;
    let stiffness = 1.0 / (1.0 / slope - 1.0 / of_contact);
    Ok((is_of_instrument && stiffness.is_finite()).then_some(stiffness))
}

/// Comparison of the fitted stiffness of the instrument with the stated one.
pub(crate) struct FittedStiffness<'a> {
    pub curve: &'a MeasuredCurve,
    pub values: &'a Values,
    pub free: &'a [Parameter],
    /// Stiffness in N/m that the scene or the file states; `None` if neither states one.
    pub stated: Option<f64>,
}

impl FittedStiffness<'_> {
    fn found(&self) -> Option<f64> {
        let is_free = self.free.contains(&Parameter::Stiffness);
        is_free.then_some(self.values[Parameter::Stiffness as usize])
    }

    /// Returns the reason to doubt a fitted stiffness: it is far from the stated stiffness. Returns
    /// `None` otherwise.
    pub fn far_from_stated(&self) -> Option<Reason> {
        let found = self.found()?;
        let stated = self.stated?;
        let ratio = found / stated;
        let is_far = !(1.0 / FAR..=FAR).contains(&ratio);
        is_far.then_some(Reason::StiffnessFarFromStated { found, stated })
    }

    /// Returns sentences on a stiffness of the instrument that was fitted while the modulus was
    /// known. If the specimen is hard, the sentences state what the stiffness means for the
    /// sensitivity of the instrument. Otherwise they state that the specimen is not hard enough to
    /// find the stiffness.
    ///
    /// # Errors
    /// Returns an error if the elastic contact of the specimen cannot be computed.
    pub fn sentences(&self, contact: &Contact) -> Result<Vec<Note>, ExperimentError> {
        let Some(found) = self.found() else {
            return Ok(Vec::new());
        };
        if self.free.contains(&Parameter::Modulus) {
            return Ok(Vec::new());
        }
        let modulus = self.values[Parameter::Modulus as usize];
        let slope = slope_of_contact(contact, modulus, carried_force(self.curve))?;
        let hardness = slope / found;
        let slope = format_rounded(slope, 2, "N/m");
        let times = format_rounded(hardness, 2, "1");
        if hardness < HARD {
            let change = EXPONENT * ERROR_OF_MODULUS / hardness;
            let change = format_rounded(100.0 * change, 1, "1");
            return Ok(vec![Note::new(format!(
                "The specimen is not hard enough to find k without E*: at the largest force the slope of the contact is {slope}, \
                 {times} times k, and an E* that is {} % too small makes k about {change} % too large. A specimen counts as hard \
                 from {HARD} times on.",
                100.0 * ERROR_OF_MODULUS
            ))]);
        }
        let mut sentence = format!(
            "The specimen is hard: at the largest force the slope of the contact is {slope}, {times} times k, so that k hardly \
             depends on E*."
        );
        if let Some(stated) = self.stated
            && (found / stated - 1.0).abs() > NOTABLE
        {
            let ratio = format_rounded(found / stated, 3, "1");
            let stated = format_rounded(stated, 3, "N/m");
            sentence += &format!(
                " k is {ratio} times the stated {stated}. If the force was computed as the deflection times the stated \
                 stiffness, the sensitivity in m/V is {ratio} times the true one, and the stated stiffness may be right."
            );
        }
        Ok(vec![Note::new(sentence)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::on_rubber;
    use asperity_scene::Simulation;

    /// The slope of the contact of a sphere is 2 E* a, and its contact radius obeys
    /// a³ = 3 F R/(4 E*) (Hertz).
    #[test]
    fn the_slope_of_the_contact_of_a_sphere_is_that_of_hertz() {
        let document = on_rubber(0.05, 2e6);
        let mut simulation = Simulation::default();
        let (contact, _) = simulation.contact(document.scene()).unwrap();
        for (modulus, force) in [(2e6, 1e-6), (2e6, 2e-5), (1e8, 1e-4)] {
            let found = slope_of_contact(&contact, modulus, force).unwrap();
            let radius = (0.75 * force * 7.5e-6 / modulus).cbrt();
            let expected = 2.0 * modulus * radius;
            assert!(
                (found / expected - 1.0).abs() < 0.02,
                "{found:e} {expected:e}"
            );
        }
    }
}
