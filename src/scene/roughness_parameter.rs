//! Dimensionless parameters that compare roughness with adhesion and may replace the work of adhesion.

use super::fields::field;
use super::model::Adhesion;

/// Dimensionless roughness-adhesion parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RoughnessParameter {
    /// κ = √(h⟨∇z⟩E*/γ), eq. (11).
    #[default]
    Kappa,
    /// e_el/γ, with the elastic energy of conformity e_el per area.
    ElasticEnergyRatio,
}

impl RoughnessParameter {
    /// All parameters.
    pub const ALL: [RoughnessParameter; 2] =
        [RoughnessParameter::Kappa, RoughnessParameter::ElasticEnergyRatio];

    /// Path of the field in a scene.
    pub const fn path(self) -> &'static str {
        match self {
            RoughnessParameter::Kappa => "adhesion.kappa",
            RoughnessParameter::ElasticEnergyRatio => "adhesion.elastic_energy_ratio",
        }
    }

    /// Name of the field within `adhesion`, of axes and of columns.
    pub fn name(self) -> &'static str {
        self.path().trim_start_matches("adhesion.")
    }

    /// Symbol in the equations.
    pub fn symbol(self) -> &'static str {
        field(self.path(), None).map_or("", |field| field.symbol)
    }

    /// The parameter with this name or path of its field.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|parameter| [parameter.name(), parameter.path()].contains(&name))
    }

    /// Energy per area over the work of adhesion at a value of the parameter: h⟨∇z⟩E*/γ = κ², or e_el/γ.
    pub fn energy_over_work(self, value: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => value.powi(2),
            RoughnessParameter::ElasticEnergyRatio => value,
        }
    }

    /// Value of the parameter for this energy per area over the work of adhesion.
    pub fn of_energy_over_work(self, ratio: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => ratio.sqrt(),
            RoughnessParameter::ElasticEnergyRatio => ratio,
        }
    }
}

impl Adhesion {
    /// The parameter that specifies the adhesion, and its value; the first of two.
    pub fn parameter(&self) -> Option<(RoughnessParameter, f64)> {
        let mut given = RoughnessParameter::ALL.into_iter().zip([self.kappa, self.elastic_energy_ratio]);
        given.find_map(|(parameter, value)| Some((parameter, value?)))
    }

    /// The same adhesion by this value of a parameter instead of the work of adhesion.
    pub fn with_parameter(self, parameter: RoughnessParameter, value: f64) -> Self {
        let mut changed = Adhesion { work: None, kappa: None, elastic_energy_ratio: None, ..self };
        match parameter {
            RoughnessParameter::Kappa => changed.kappa = Some(value),
            RoughnessParameter::ElasticEnergyRatio => changed.elastic_energy_ratio = Some(value),
        }
        changed
    }

    /// The same adhesion by this κ instead of the work of adhesion.
    pub fn with_kappa(self, kappa: f64) -> Self {
        self.with_parameter(RoughnessParameter::Kappa, kappa)
    }
}
