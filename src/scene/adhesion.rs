//! Adhesion by the work of adhesion, or by a dimensionless parameter that compares it with the roughness.

use serde::{Deserialize, Serialize, Serializer};

use super::fields::field;

/// Dimensionless roughness-adhesion parameter, which may replace the work of adhesion.
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

/// Adhesion between the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "AdhesionText")]
pub enum Adhesion {
    /// By the work of adhesion.
    Work {
        /// Work of adhesion γ, J/m².
        work: f64,
        /// Work of adhesion γ₁ on closing, J/m², at most `work`; `None`: equal to `work`.
        closing_work: Option<f64>,
        /// Parameter that specifies the amplitude of the roughness together with `work`, and its value.
        amplitude: Option<(RoughnessParameter, f64)>,
        /// Range z₀ of the attraction, m, for the Tabor number alone; `None`: 0.3 nm.
        range: Option<f64>,
    },
    /// By a parameter: the work of adhesion follows from the roughness.
    Parameter {
        /// The parameter.
        parameter: RoughnessParameter,
        /// Value of the parameter.
        value: f64,
        /// Range z₀ of the attraction, m, as in `Work`.
        range: Option<f64>,
    },
}

const CLOSING_WORK_ALONE: &str = "adhesion.closing_work: closing_work requires adhesion.work, which is missing: κ and \
                                  e_el/γ refer to one work of adhesion";

impl Adhesion {
    /// Adhesion by the work of adhesion, J/m².
    pub fn by_work(work: f64) -> Self {
        Adhesion::Work { work, closing_work: None, amplitude: None, range: None }
    }

    /// Adhesion by a parameter.
    pub fn by_parameter(parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion::Parameter { parameter, value, range: None }
    }

    /// Work of adhesion γ, J/m², if it is given.
    pub fn work(&self) -> Option<f64> {
        if let Adhesion::Work { work, .. } = *self { Some(work) } else { None }
    }

    /// Work of adhesion γ₁ on closing, J/m², if it is given.
    pub fn closing_work(&self) -> Option<f64> {
        if let Adhesion::Work { closing_work, .. } = *self { closing_work } else { None }
    }

    /// The given parameter and its value.
    pub fn parameter(&self) -> Option<(RoughnessParameter, f64)> {
        match *self {
            Adhesion::Work { amplitude, .. } => amplitude,
            Adhesion::Parameter { parameter, value, .. } => Some((parameter, value)),
        }
    }

    /// Range z₀ of the attraction, m, if it is given.
    pub fn range(&self) -> Option<f64> {
        let (Adhesion::Work { range, .. } | Adhesion::Parameter { range, .. }) = *self;
        range
    }

    /// The same adhesion by this work of adhesion, J/m².
    pub fn with_work(self, work: f64) -> Self {
        match self {
            Adhesion::Work { closing_work, amplitude, range, .. } => {
                Adhesion::Work { work, closing_work, amplitude, range }
            }
            Adhesion::Parameter { range, .. } => {
                Adhesion::Work { work, closing_work: None, amplitude: None, range }
            }
        }
    }

    /// The same adhesion by this value of a parameter. A work of adhesion that specifies the amplitude of the roughness
    /// remains.
    ///
    /// # Errors
    /// Adhesion with a work of adhesion on closing.
    pub fn with_parameter(self, parameter: RoughnessParameter, value: f64) -> Result<Self, &'static str> {
        match self {
            Adhesion::Work { work, closing_work, amplitude: Some(_), range } => {
                Ok(Adhesion::Work { work, closing_work, amplitude: Some((parameter, value)), range })
            }
            Adhesion::Work { closing_work: Some(_), .. } => Err(CLOSING_WORK_ALONE),
            _ => Ok(Adhesion::Parameter { parameter, value, range: self.range() }),
        }
    }
}

/// Adhesion as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Adhesion")]
struct AdhesionText {
    work: Option<f64>,
    closing_work: Option<f64>,
    kappa: Option<f64>,
    elastic_energy_ratio: Option<f64>,
    range: Option<f64>,
}

impl TryFrom<AdhesionText> for Adhesion {
    type Error = &'static str;

    fn try_from(text: AdhesionText) -> Result<Adhesion, &'static str> {
        let AdhesionText { work, closing_work, kappa, elastic_energy_ratio, range } = text;
        let amplitude = match (kappa, elastic_energy_ratio) {
            (Some(_), Some(_)) => {
                return Err(
                    "adhesion: kappa and elastic_energy_ratio determine each other: give one of them",
                );
            }
            (Some(value), None) => Some((RoughnessParameter::Kappa, value)),
            (None, value) => value.map(|value| (RoughnessParameter::ElasticEnergyRatio, value)),
        };
        match (work, amplitude) {
            (Some(work), _) => Ok(Adhesion::Work { work, closing_work, amplitude, range }),
            (None, None) => Err("adhesion: give work, kappa or elastic_energy_ratio"),
            (None, Some(_)) if closing_work.is_some() => Err(CLOSING_WORK_ALONE),
            (None, Some((parameter, value))) => Ok(Adhesion::Parameter { parameter, value, range }),
        }
    }
}

impl Serialize for Adhesion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let parameter = self.parameter().map(|(parameter, value)| (parameter.name(), value));
        let [work, closing_work, range] =
            [("work", self.work()), ("closing_work", self.closing_work()), ("range", self.range())]
                .map(|(name, value)| Some((name, value?)));
        serializer.collect_map([work, closing_work, parameter, range].into_iter().flatten())
    }
}
