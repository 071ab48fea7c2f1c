//! Derived quantities of a contact from plain numbers in SI units, the only implementation in the program.
//!
//! Adhesion forces of smooth bodies are in [`crate::reference`], the rule of Hess is [`crate::contact::HessRule`], the
//! elastic energy of conformity [`Amplitude::elastic_energy`].

use crate::scene::RoughnessParameter;
use crate::surface::Amplitude;
use std::f64::consts::PI;

/// Ideal adhesion force F_a,max = √(πγE*L³), N, of a flat face of length L, m, with a work of adhesion γ, J/m², and an
/// effective modulus E*, Pa. Popov and Filippov (2012), eq. (14); Kendall (1971).
#[must_use]
pub fn ideal_adhesion_force(work_of_adhesion: f64, effective_modulus: f64, length: f64) -> f64 {
    (PI * work_of_adhesion * effective_modulus * length.powi(3)).sqrt()
}

/// Stiffness E* l, N/m, of a contact of length l, m, whose edges stay in place, under an effective modulus E*, Pa. Moving
/// edges add to the slope of the force curve.
/// Popov and Filippov (2012), eq. (1).
#[must_use]
pub fn contact_stiffness(effective_modulus: f64, contact_length: f64) -> f64 {
    effective_modulus * contact_length
}

/// Mean pressure F/(πa²), Pa, of a force F, N, on a circle of radius a, m; `None` without contact.
#[must_use]
pub fn mean_pressure(force: f64, contact_radius: f64) -> Option<f64> {
    (contact_radius > 0.0).then(|| force / (PI * contact_radius * contact_radius))
}

/// Energy per area of a profile that a parameter compares with the work of adhesion, J/m²: h⟨∇z⟩E* or e_el.
pub(super) fn energy_of(parameter: RoughnessParameter, amplitude: Amplitude, effective_modulus: f64) -> f64 {
    match parameter {
        RoughnessParameter::Kappa => amplitude.rms_height * amplitude.rms_gradient * effective_modulus,
        RoughnessParameter::ElasticEnergyRatio => amplitude.elastic_energy(effective_modulus),
    }
}

/// Value of a parameter at this energy and work of adhesion per area, J/m². `None` if adhesion is so small that the
/// value overflows.
pub(super) fn value_of(parameter: RoughnessParameter, energy: f64, work: f64) -> Option<f64> {
    Some(parameter.of_energy_over_work(energy / work)).filter(|value| work > 0.0 && value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_beyond_all_numbers_is_none() {
        assert_eq!(value_of(RoughnessParameter::Kappa, 1e300, 5e-324), None);
        for (parameter, value) in RoughnessParameter::ALL.into_iter().zip([2.0, 4.0]) {
            assert_eq!(value_of(parameter, 1.0, 0.0), None);
            assert_eq!(value_of(parameter, 8.0, 2.0), Some(value));
        }
    }

    #[test]
    fn quantities_follow_from_plain_numbers() {
        let amplitude =
            Amplitude { rms_height: 3.0, rms_gradient: 6.0, rms_curvature: 15.0, mean_wave_number: 0.5 };
        // h⟨∇z⟩E*/γ = 36 and E* h² q̄/4γ = 2.25.
        let [kappa, ratio] =
            RoughnessParameter::ALL.map(|one| value_of(one, energy_of(one, amplitude, 4.0), 2.0));
        assert_eq!((kappa, ratio), (Some(6.0), Some(2.25)));
        // π γ E* L³ = 750 π.
        let force = ideal_adhesion_force(2.0, 3.0, 5.0);
        assert!((force - (750.0 * PI).sqrt()).abs() < 1e-13, "{force}");
        assert_eq!(contact_stiffness(3.0, 2.0), 6.0);
        assert_eq!((mean_pressure(-PI, 0.5), mean_pressure(1.0, 0.0)), (Some(-4.0), None));
    }
}
