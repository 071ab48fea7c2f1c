//! Amplitude of a profile with modes A_k cos(q_k x + φ_k), q_k = 2πk/L.

use std::f64::consts::TAU;

/// Roughness amplitude of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitude {
    /// Root mean square height h, m.
    pub rms_height: f64,
    /// Root mean square gradient ⟨∇z⟩.
    pub rms_gradient: f64,
    /// Root mean square curvature, 1/m.
    pub rms_curvature: f64,
    /// Mean wave number Σ q_k A_k²/Σ A_k², rad/m; 0 for a flat profile.
    pub mean_wave_number: f64,
}

impl Amplitude {
    /// Amplitude of heights times a factor.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Amplitude {
            rms_height: factor * self.rms_height,
            rms_gradient: factor * self.rms_gradient,
            rms_curvature: factor * self.rms_curvature,
            ..self
        }
    }

    /// Amplitude of the same modes on a length `times` as large.
    pub(crate) fn stretched(self, times: f64) -> Self {
        Amplitude {
            rms_height: self.rms_height,
            rms_gradient: self.rms_gradient / times,
            rms_curvature: self.rms_curvature / times.powi(2),
            mean_wave_number: self.mean_wave_number / times,
        }
    }

    /// Amplitude of the modes k with these mean squares A_k²/2, m², on a length (m); smallest first for accuracy.
    pub(crate) fn from_modes(squares: impl Iterator<Item = (u64, f64)>, length: f64) -> Self {
        let (mut height, mut slope, mut gradient, mut curvature) = (0.0, 0.0, 0.0, 0.0);
        for (mode, square) in squares {
            let wave_number = TAU * mode as f64 / length;
            height += square;
            slope += square * wave_number;
            gradient += square * wave_number.powi(2);
            curvature += square * wave_number.powi(4);
        }
        let mean_wave_number = if height > 0.0 { slope / height } else { 0.0 };
        Amplitude {
            rms_height: height.sqrt(),
            rms_gradient: gradient.sqrt(),
            rms_curvature: curvature.sqrt(),
            mean_wave_number,
        }
    }

    /// Elastic energy of conformity per area, J/m²: e_el = (E*/8) Σ q_k A_k², the energy of a half-space of
    /// effective modulus E* (Pa) in full contact with an isotropic surface with the rms height, rms gradient and
    /// mean wave number of the profile (Persson and Tosatti, 2001).
    pub(crate) fn elastic_energy(&self, effective_modulus: f64) -> f64 {
        effective_modulus * self.rms_height.powi(2) * self.mean_wave_number / 4.0
    }
}
