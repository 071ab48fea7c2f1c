//! Adhesion, given by the work of adhesion or by a dimensionless parameter that compares roughness
//! and adhesion.

use serde::{Deserialize, Serialize};

use super::errors::NumberError;
use super::text::ron_float;

/// Dimensionless parameter that compares roughness and adhesion. A scene may state such a parameter
/// in place of the work of adhesion γ.
///
/// ```
/// use asperity_scene::RoughnessParameter;
///
/// let [kappa, energy] = [RoughnessParameter::Kappa, RoughnessParameter::ElasticEnergyRatio];
/// // κ² is the energy h⟨∇z⟩E* over the work of adhesion, e_el/γ the elastic energy itself.
/// assert_eq!((kappa.energy_over_work(6.0), energy.energy_over_work(6.0)), (36.0, 6.0));
/// ```
#[cfg_attr(
    feature = "clap",
    derive(clap::ValueEnum),
    value(rename_all = "snake_case")
)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RoughnessParameter {
    /// κ = √(h⟨∇z⟩E*/γ), eq. (11) of Popov and Filippov (2012), with rms height h, rms gradient
    /// ⟨∇z⟩, effective modulus E* and work of adhesion γ.
    #[default]
    Kappa,
    /// e_el/γ: elastic energy e_el per area that flattens the roughness, divided by the work of
    /// adhesion γ.
    ElasticEnergyRatio,
}

impl RoughnessParameter {
    /// Both parameters: κ, and the ratio e_el/γ of elastic energy to work of adhesion.
    pub const ALL: [RoughnessParameter; 2] = [
        RoughnessParameter::Kappa,
        RoughnessParameter::ElasticEnergyRatio,
    ];

    /// Returns the path of the parameter in a scene, such as `adhesion.kappa`.
    pub const fn path(self) -> &'static str {
        match self {
            RoughnessParameter::Kappa => "adhesion.kappa",
            RoughnessParameter::ElasticEnergyRatio => "adhesion.elastic_energy_ratio",
        }
    }

    /// Returns the name of the parameter in scenes, studies and tables, such as `kappa`.
    pub fn name(self) -> &'static str {
        self.path().trim_start_matches("adhesion.")
    }

    /// Returns the symbol of the parameter in the equations, such as `κ`.
    pub const fn symbol(self) -> &'static str {
        match self {
            RoughnessParameter::Kappa => "κ",
            RoughnessParameter::ElasticEnergyRatio => "e_el/γ",
        }
    }

    /// Returns the parameter with this [`name`](Self::name) or [`path`](Self::path); `None` if
    /// there is none.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|parameter| [parameter.name(), parameter.path()].contains(&name))
    }

    /// Returns the energy per area that this parameter compares with the work of adhesion γ,
    /// divided by γ. `value` is the value of this parameter. For κ the energy per area is h⟨∇z⟩E*
    /// (rms height times rms gradient times effective modulus), so that the result is κ². For
    /// e_el/γ it is the elastic energy e_el that flattens the roughness, so that the result is
    /// `value` itself.
    pub fn energy_over_work(self, value: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => value.powi(2),
            RoughnessParameter::ElasticEnergyRatio => value,
        }
    }

    /// Returns the value of this parameter that belongs to `ratio`, an energy per area divided by
    /// the work of adhesion. This function is the inverse of [`Self::energy_over_work`].
    pub fn of_energy_over_work(self, ratio: f64) -> f64 {
        match self {
            RoughnessParameter::Kappa => ratio.sqrt(),
            RoughnessParameter::ElasticEnergyRatio => ratio,
        }
    }
}

/// Adhesion between the bodies: its strength and the range of the attraction. A scene file states
/// adhesion as `(work: 0.05)` or `(kappa: 2.0, range: 3.0e-10)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "AdhesionText", into = "AdhesionText")]
pub struct Adhesion {
    /// Strength of the adhesion: a work of adhesion γ, or a parameter that compares γ with the
    /// roughness ([`RoughnessParameter`]).
    pub strength: Strength,
    /// Range z₀ of the attraction in m; `None` means 0.3 nm. Only the Tabor number depends on z₀.
    pub range: Option<f64>,
}

/// Strength of the adhesion: a work of adhesion, or the value of a [`RoughnessParameter`] from
/// which the work follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Work of adhesion. The energy that is gained where the interface closes may be smaller than
    /// the energy that is spent where the interface opens.
    Work {
        /// Work of adhesion γ in J/m²: energy per area that opens the interface.
        opening: f64,
        /// Energy γ₁ per area in J/m² that is gained where the interface closes, at most `opening`.
        /// `None` if γ₁ equals `opening`.
        closing: Option<f64>,
    },
    /// Value of the roughness parameter κ, or of the ratio e_el/γ of elastic energy to work of
    /// adhesion. The work of adhesion follows from this value.
    Parameter(RoughnessParameter, f64),
}

impl Adhesion {
    /// Returns the range z₀ of the attraction in m. If the scene states no range, returns 0.3 nm,
    /// an interatomic distance.
    pub fn attraction_range(&self) -> f64 {
        self.range.unwrap_or(0.3e-9)
    }

    /// Returns an adhesion with this work of adhesion in J/m².
    ///
    /// ```
    /// use asperity_scene::Adhesion;
    ///
    /// let work = Adhesion::by_work(0.05);
    /// assert_eq!((work.work(), work.closing_work(), work.parameter()), (Some(0.05), None, None));
    /// ```
    pub fn by_work(work: f64) -> Self {
        Adhesion {
            strength: Strength::Work {
                opening: work,
                closing: None,
            },
            range: None,
        }
    }

    /// Returns an adhesion whose strength is given by the value of a parameter: the roughness
    /// parameter κ, or the ratio e_el/γ of elastic energy to work of adhesion.
    ///
    /// ```
    /// use asperity_scene::{Adhesion, RoughnessParameter};
    ///
    /// let given = Adhesion::by_parameter(RoughnessParameter::Kappa, 6.0);
    /// assert_eq!(
    ///     (given.work(), given.parameter()),
    ///     (None, Some((RoughnessParameter::Kappa, 6.0)))
    /// );
    /// ```
    pub fn by_parameter(parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion {
            strength: Strength::Parameter(parameter, value),
            range: None,
        }
    }

    /// Returns the work of adhesion γ on opening in J/m² that the scene states. Returns `None` if
    /// the scene instead states a parameter from which γ follows ([`RoughnessParameter`]).
    pub fn work(&self) -> Option<f64> {
        if let Strength::Work { opening, .. } = self.strength {
            Some(opening)
        } else {
            None
        }
    }

    /// Returns the work of adhesion γ₁ on closing in J/m²; `None` if the scene does not state γ₁.
    pub fn closing_work(&self) -> Option<f64> {
        if let Strength::Work { closing, .. } = self.strength {
            closing
        } else {
            None
        }
    }

    /// Returns true if the scene states a work of adhesion on closing besides the work on opening.
    pub fn has_two_works(&self) -> bool {
        self.closing_work().is_some()
    }

    /// Returns the parameter that the scene states, and its value: the roughness parameter κ, or
    /// the ratio e_el/γ of elastic energy to work of adhesion. Returns `None` if the scene states a
    /// work of adhesion instead.
    pub fn parameter(&self) -> Option<(RoughnessParameter, f64)> {
        if let Strength::Parameter(parameter, value) = self.strength {
            Some((parameter, value))
        } else {
            None
        }
    }

    /// Returns this adhesion with another work of adhesion on opening in J/m².
    pub fn with_work(self, work: f64) -> Self {
        Adhesion {
            strength: Strength::Work {
                opening: work,
                closing: self.closing_work(),
            },
            ..self
        }
    }

    /// Returns this adhesion with its strength given by the value of a parameter: the roughness
    /// parameter κ, or the ratio e_el/γ of elastic energy to work of adhesion.
    pub fn with_parameter(self, parameter: RoughnessParameter, value: f64) -> Self {
        Adhesion {
            strength: Strength::Parameter(parameter, value),
            ..self
        }
    }
}

impl Adhesion {
    /// Returns the adhesion with another value of the number `name`, such as `work`. If `adhesion`
    /// is `None`, the new adhesion has only this number.
    pub(super) fn with_number(
        adhesion: Option<Adhesion>,
        name: &str,
        number: f64,
    ) -> Result<Adhesion, NumberError> {
        let mut text = adhesion.map_or_else(AdhesionText::default, AdhesionText::from);
        let slot = match name {
            "work" => &mut text.work,
            "closing_work" => &mut text.closing_work,
            "kappa" => &mut text.kappa,
            "elastic_energy_ratio" => &mut text.elastic_energy_ratio,
            "range" => &mut text.range,
            _ => return Err(NumberError::Missing),
        };
        *slot = Some(number);
        Adhesion::try_from(text).map_err(NumberError::Contradiction)
    }
}

/// Adhesion as written in a file. Its fields may contradict each other.
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
        let text = AdhesionText {
            range,
            ..AdhesionText::default()
        };
        match strength {
            Strength::Work { opening, closing } => AdhesionText {
                work: Some(opening),
                closing_work: closing,
                ..text
            },
            Strength::Parameter(RoughnessParameter::Kappa, value) => AdhesionText {
                kappa: Some(value),
                ..text
            },
            Strength::Parameter(RoughnessParameter::ElasticEnergyRatio, value) => AdhesionText {
                elastic_energy_ratio: Some(value),
                ..text
            },
        }
    }
}

impl TryFrom<AdhesionText> for Adhesion {
    type Error = String;

    fn try_from(text: AdhesionText) -> Result<Self, String> {
        let AdhesionText {
            work,
            closing_work: closing,
            kappa,
            elastic_energy_ratio: ratio,
            range,
        } = text;
        let strength = match (work, kappa, ratio) {
            (Some(opening), None, None) => Strength::Work { opening, closing },
            (None, ..) if closing.is_some() => {
                let why = "closing_work requires adhesion.work, which is missing: κ and e_el/γ refer to one work of \
                           adhesion";
                return Err(why.to_owned());
            }
            (None, Some(value), None) => Strength::Parameter(RoughnessParameter::Kappa, value),
            (None, None, Some(value)) => {
                Strength::Parameter(RoughnessParameter::ElasticEnergyRatio, value)
            }
            (None, None, None) => return Err("give work, kappa or elastic_energy_ratio".to_owned()),
            _ => {
                let mut names = Vec::new();
                let mut choices = Vec::new();
                for (name, value) in [
                    ("work", work),
                    ("kappa", kappa),
                    ("elastic_energy_ratio", ratio),
                ] {
                    if let Some(value) = value {
                        names.push(name);
                        choices.push(format!("({name}: {})", ron_float(value)));
                    }
                }
                return Err(format!(
                    "{} determine each other: give {}",
                    names.join(" and "),
                    choices.join(" or ")
                ));
            }
        };
        Ok(Adhesion { strength, range })
    }
}
