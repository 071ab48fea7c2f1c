//! Adhesion, given by the work of adhesion or by a dimensionless parameter that compares roughness with adhesion.

use serde::{Deserialize, Serialize};

use super::fields::field;
use super::text::ron_float;

/// Dimensionless roughness-adhesion parameter, which may be given in place of the work of adhesion.
///
/// ```
/// use asperity_scene::RoughnessParameter;
///
/// let [kappa, energy] = [RoughnessParameter::Kappa, RoughnessParameter::ElasticEnergyRatio];
/// // κ² is the energy h⟨∇z⟩E* over the work of adhesion, e_el/γ the elastic energy itself.
/// assert_eq!((kappa.energy_over_work(6.0), energy.energy_over_work(6.0)), (36.0, 6.0));
/// ```
#[cfg_attr(feature = "clap", derive(clap::ValueEnum), value(rename_all = "snake_case"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RoughnessParameter {
    /// κ = √(h⟨∇z⟩E*/γ), eq. (11).
    #[default]
    Kappa,
    /// e_el/γ, with the elastic energy e_el per area that flattens the roughness.
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

    /// Name of the parameter: of its field within `adhesion`, and in axes and columns.
    pub fn name(self) -> &'static str {
        self.path().trim_start_matches("adhesion.")
    }

    /// Symbol of the parameter in the equations.
    pub fn symbol(self) -> &'static str {
        field(self.path(), None).map_or("", |field| field.symbol)
    }

    /// The parameter with this name, or with this path of its field.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|parameter| [parameter.name(), parameter.path()].contains(&name))
    }

    /// Energy per area over the work of adhesion at this value of the parameter: h⟨∇z⟩E*/γ = κ², or e_el/γ.
    pub fn energy_over_work(self, value: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => value.powi(2),
            RoughnessParameter::ElasticEnergyRatio => value,
        }
    }

    /// Value of the parameter for this ratio of energy per area to work of adhesion.
    pub fn of_energy_over_work(self, ratio: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => ratio.sqrt(),
            RoughnessParameter::ElasticEnergyRatio => ratio,
        }
    }
}

/// Adhesion between the bodies: its strength, given in one of several ways, and the range of the attraction. In a file
/// `(work: 0.05, range: 3.0e-10)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "AdhesionText", into = "AdhesionText")]
pub struct Adhesion {
    /// Strength of the adhesion.
    pub strength: Strength,
    /// Range z₀ of the attraction, m, which only enters the Tabor number; `None`: 0.3 nm.
    pub range: Option<f64>,
}

/// Strength of the adhesion, as it is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Given by works of adhesion.
    Work {
        /// Work of adhesion γ, J/m².
        opening: f64,
        /// Work of adhesion γ₁ on closing, J/m², at most `opening`; `None`: equal to `opening`.
        closing: Option<f64>,
    },
    /// Given by a parameter and its value, which determine the work of adhesion for the roughness of the scene.
    Parameter(RoughnessParameter, f64),
}

impl Adhesion {
    /// Adhesion given by the work of adhesion, J/m².
    ///
    /// ```
    /// use asperity_scene::Adhesion;
    ///
    /// let work = Adhesion::by_work(0.05);
    /// assert_eq!((work.work(), work.closing_work(), work.parameter()), (Some(0.05), None, None));
    /// ```
    pub fn by_work(work: f64) -> Self {
        Adhesion { strength: Strength::Work { opening: work, closing: None }, range: None }
    }

    /// Adhesion given by a parameter and its value.
    ///
    /// ```
    /// use asperity_scene::{Adhesion, RoughnessParameter};
    ///
    /// let given = Adhesion::by_parameter(RoughnessParameter::Kappa, 6.0);
    /// assert_eq!((given.work(), given.parameter()), (None, Some((RoughnessParameter::Kappa, 6.0))));
    /// ```
    pub fn by_parameter(parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion { strength: Strength::Parameter(parameter, value), range: None }
    }

    /// The given work of adhesion γ, J/m²; `None` for adhesion by a parameter.
    pub fn work(&self) -> Option<f64> {
        if let Strength::Work { opening, .. } = self.strength { Some(opening) } else { None }
    }

    /// The given work of adhesion γ₁ on closing, J/m²; `None` where it equals γ.
    pub fn closing_work(&self) -> Option<f64> {
        if let Strength::Work { closing, .. } = self.strength { closing } else { None }
    }

    /// Returns true if a separate work of adhesion on closing is given.
    pub fn has_two_works(&self) -> bool {
        self.closing_work().is_some()
    }

    /// The given parameter and its value; `None` for adhesion by work.
    pub fn parameter(&self) -> Option<(RoughnessParameter, f64)> {
        if let Strength::Parameter(parameter, value) = self.strength {
            Some((parameter, value))
        } else {
            None
        }
    }

    /// The adhesion with this work of adhesion on opening, J/m²; range and work on closing stay.
    pub fn with_work(self, work: f64) -> Self {
        Adhesion { strength: Strength::Work { opening: work, closing: self.closing_work() }, ..self }
    }

    /// The adhesion given by this value of a parameter; the range stays.
    pub fn with_parameter(self, parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion { strength: Strength::Parameter(parameter, value), ..self }
    }
}

/// Adhesion as written in a file, where contradictory fields may be given.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Adhesion")]
struct AdhesionText {
    #[serde(skip_serializing_if = "Option::is_none")]
    work: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    closing_work: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    kappa: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    elastic_energy_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<f64>,
}

impl From<Adhesion> for AdhesionText {
    fn from(Adhesion { strength, range }: Adhesion) -> Self {
        let text = AdhesionText { range, ..AdhesionText::default() };
        match strength {
            Strength::Work { opening, closing } => {
                AdhesionText { work: Some(opening), closing_work: closing, ..text }
            }
            Strength::Parameter(RoughnessParameter::Kappa, value) => {
                AdhesionText { kappa: Some(value), ..text }
            }
            Strength::Parameter(RoughnessParameter::ElasticEnergyRatio, value) => {
                AdhesionText { elastic_energy_ratio: Some(value), ..text }
            }
        }
    }
}

impl TryFrom<AdhesionText> for Adhesion {
    type Error = String;

    fn try_from(text: AdhesionText) -> Result<Self, String> {
        let AdhesionText { work, closing_work: closing, kappa, elastic_energy_ratio: ratio, range } = text;
        let strength = match (work, kappa, ratio) {
            (Some(opening), None, None) => Strength::Work { opening, closing },
            (None, ..) if closing.is_some() => {
                let why = "closing_work requires adhesion.work, which is missing: κ and e_el/γ refer to one work of \
                           adhesion";
                return Err(why.to_owned());
            }
            (None, Some(value), None) => Strength::Parameter(RoughnessParameter::Kappa, value),
            (None, None, Some(value)) => Strength::Parameter(RoughnessParameter::ElasticEnergyRatio, value),
            (None, None, None) => return Err("give work, kappa or elastic_energy_ratio".to_owned()),
            _ => {
                let given = [("work", work), ("kappa", kappa), ("elastic_energy_ratio", ratio)];
                let given = given.into_iter().filter_map(|(name, value)| Some((name, value?)));
                let (names, choices): (Vec<_>, Vec<_>) =
                    given.map(|(name, value)| (name, format!("({name}: {})", ron_float(value)))).unzip();
                let (names, choices) = (names.join(" and "), choices.join(" or "));
                return Err(format!("{names} determine each other: give {choices}"));
            }
        };
        Ok(Adhesion { strength, range })
    }
}
