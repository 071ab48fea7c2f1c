//! Values of a computed scene, as replacements of others in the scene.

use super::roughness_parameter::RoughnessParameter;

/// Values that a scene determines through its profile, known after the computation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Computed {
    /// Work of adhesion γ, J/m².
    pub work_of_adhesion: Option<f64>,
    /// Roughness–adhesion parameter κ.
    pub kappa: Option<f64>,
    /// Elastic energy of conformity over the work of adhesion, e_el/γ.
    pub elastic_energy_ratio: Option<f64>,
    /// Root mean square height h of the roughness, m.
    pub rms_height: Option<f64>,
}

impl Computed {
    /// Values of this scene, with unknown ones replaced by those of another scene.
    pub(super) fn or(self, other: Computed) -> Computed {
        Computed {
            work_of_adhesion: self.work_of_adhesion.or(other.work_of_adhesion),
            kappa: self.kappa.or(other.kappa),
            elastic_energy_ratio: self.elastic_energy_ratio.or(other.elastic_energy_ratio),
            rms_height: self.rms_height.or(other.rms_height),
        }
    }

    /// Value of a roughness-adhesion parameter.
    pub(super) fn parameter(&self, parameter: RoughnessParameter) -> Option<f64> {
        match parameter {
            RoughnessParameter::Kappa => self.kappa,
            RoughnessParameter::ElasticEnergyRatio => self.elastic_energy_ratio,
        }
    }
}
