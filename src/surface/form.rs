//! Macroscopic forms on the equivalent profile: the MDR transform g(x) of a profile f(r).

use super::struve::struve_0;
use crate::scene::Form;
use std::f64::consts::PI;

/// Depth g(|x|) in m of the equivalent profile below its apex, at distance `distance` m from the axis; for a punch
/// that under its flat face ([`Form::springs_under`]).
///
/// g(x) = |x| ∫₀^|x| f′(r)/√(x²−r²) dr: a paraboloid r²/2R becomes x²/R, a cone r tan θ becomes
/// (π/2)|x| tan θ, a power law b rⁿ becomes κₙ b |x|ⁿ ([`power_law_factor`]), and waves A (1 − cos 2πr/λ) become
/// (π²A/λ)|x| H₀(2π|x|/λ) with a Struve function.
#[must_use]
pub fn mdr_profile(form: &Form, distance: f64) -> f64 {
    let x = distance.abs();
    match *form {
        Form::Paraboloid { radius } => x * x / radius,
        Form::Cone { angle } => std::f64::consts::FRAC_PI_2 * x * angle.tan(),
        Form::Power { coefficient, exponent } => power_law_factor(exponent) * coefficient * x.powf(exponent),
        Form::WavySphere { radius, amplitude, wavelength } => {
            x * x / radius + PI * PI * amplitude / wavelength * x * struve_0(2.0 * PI * x / wavelength)
        }
        Form::Punch { .. } => 0.0,
    }
}

/// Coefficient c, m^(1−n), and exponent n of a form with the profile g(x) = c |x|ⁿ; `None` for a punch and for waves.
#[must_use]
pub fn line_power_law(form: &Form) -> Option<(f64, f64)> {
    match *form {
        Form::Paraboloid { radius } => Some((radius.recip(), 2.0)),
        Form::Cone { angle } => Some((std::f64::consts::FRAC_PI_2 * angle.tan(), 1.0)),
        Form::Power { coefficient, exponent } => Some((power_law_factor(exponent) * coefficient, exponent)),
        Form::WavySphere { .. } | Form::Punch { .. } => None,
    }
}

/// κₙ = (√π/2) n Γ(n/2)/Γ((n+1)/2), the factor of a power law rⁿ on the equivalent profile.
#[must_use]
pub fn power_law_factor(exponent: f64) -> f64 {
    // Logarithms of Γ: the quotient remains finite where its parts would overflow.
    let quotient = (libm::lgamma(exponent / 2.0) - libm::lgamma((exponent + 1.0) / 2.0)).exp();
    std::f64::consts::PI.sqrt() / 2.0 * exponent * quotient
}

#[cfg(test)]
mod tests {
    use super::*;

    /// g by its definition: with r = x sin t the integral is x ∫₀^{π/2} f′(x sin t) dt.
    fn by_definition(slope: impl Fn(f64) -> f64, x: f64) -> f64 {
        let steps = 20_000;
        let width = std::f64::consts::FRAC_PI_2 / f64::from(steps);
        (0..steps).map(|k| slope(x * ((f64::from(k) + 0.5) * width).sin())).sum::<f64>() * width * x
    }

    #[test]
    fn transforms_follow_their_definition() {
        let x = 0.7;
        let (radius, angle) = (2.5, 0.3_f64);
        type Slope = Box<dyn Fn(f64) -> f64>;
        let wavy = Form::WavySphere { radius, amplitude: 0.02, wavelength: 0.3 };
        let wave = 2.0 * PI / 0.3;
        let cases: [(Form, Slope); 5] = [
            (Form::Paraboloid { radius }, Box::new(move |r| r / radius)),
            (Form::Cone { angle }, Box::new(move |_| angle.tan())),
            (wavy, Box::new(move |r| r / radius + 0.02 * wave * (wave * r).sin())),
            (Form::Power { coefficient: 0.4, exponent: 3.7 }, Box::new(|r: f64| 0.4 * 3.7 * r.powf(2.7))),
            (Form::Power { coefficient: 0.4, exponent: 60.0 }, Box::new(|r: f64| 24.0 * r.powf(59.0))),
        ];
        for (form, slope) in cases {
            let expected = by_definition(slope, x);
            let found = mdr_profile(&form, -x);
            assert!((found - expected).abs() < 1e-7 * expected, "{form:?}: {found} against {expected}");
        }
        // The special cases of the power law: n = 1 is the cone, n = 2 doubles.
        assert!((power_law_factor(1.0) - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
        assert!((power_law_factor(2.0) - 2.0).abs() < 1e-14);
    }
}
