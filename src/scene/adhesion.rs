//! Adhesion by the work of adhesion, or by a dimensionless parameter that compares it with the roughness.

use serde::{Deserialize, Serialize};

use super::fields::field;

/// Dimensionless roughness-adhesion parameter, which may replace the work of adhesion.
#[cfg_attr(feature = "tui", derive(clap::ValueEnum), value(rename_all = "snake_case"))]
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

/// Adhesion between the bodies, as written: by the work of adhesion or by a parameter; by both if they set the amplitude
/// of the roughness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Work of adhesion γ, J/m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub work: Option<f64>,
    /// Work of adhesion γ₁ on closing, J/m², at most `work`; `None`: equal to `work`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closing_work: Option<f64>,
    /// [`RoughnessParameter::Kappa`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kappa: Option<f64>,
    /// [`RoughnessParameter::ElasticEnergyRatio`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic_energy_ratio: Option<f64>,
    /// Range z₀ of the attraction, m, for the Tabor number alone; `None`: 0.3 nm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<f64>,
}

impl Adhesion {
    /// Adhesion by the work of adhesion, J/m².
    pub fn by_work(work: f64) -> Self {
        Adhesion { work: Some(work), ..Adhesion::default() }
    }

    /// Adhesion by a parameter.
    pub fn by_parameter(parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion::default().with_parameter(parameter, value)
    }

    /// The given parameter and its value.
    pub fn parameter(&self) -> Option<(RoughnessParameter, f64)> {
        let kappa = self.kappa.map(|value| (RoughnessParameter::Kappa, value));
        kappa.or(self.elastic_energy_ratio.map(|value| (RoughnessParameter::ElasticEnergyRatio, value)))
    }

    /// Returns true if work of adhesion and a parameter together set the amplitude of the roughness.
    pub fn sets_amplitude(&self) -> bool {
        self.work.is_some() && self.parameter().is_some()
    }

    /// The same adhesion by this work of adhesion, J/m²; a parameter given without a work of adhesion is left out.
    pub fn with_work(self, work: f64) -> Self {
        let same =
            if self.work.is_some() { self } else { Adhesion { range: self.range, ..Adhesion::default() } };
        Adhesion { work: Some(work), ..same }
    }

    /// The same adhesion by this value of a parameter; a work of adhesion remains if it sets the amplitude of the roughness.
    pub fn with_parameter(self, parameter: RoughnessParameter, value: f64) -> Self {
        let [kappa, elastic_energy_ratio] =
            RoughnessParameter::ALL.map(|one| (one == parameter).then_some(value));
        Adhesion { work: self.work.filter(|_| self.sets_amplitude()), kappa, elastic_energy_ratio, ..self }
    }
}
