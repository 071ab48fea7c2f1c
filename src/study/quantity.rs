//! What a study records for each cell and line.

use serde::{Deserialize, Serialize};

/// A quantity; its name in a plan is that of its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// κ of eq. (11).
    Kappa,
    /// Work of adhesion γ, J/m².
    WorkOfAdhesion,
    /// Ideal adhesion force F_a,max of eq. (14), N.
    IdealAdhesionForce,
    /// F_a(0) by the touch protocol, N: turned at first touch.
    ZeroLoadAdhesionForce,
    /// The same over F_a,max.
    ZeroLoadAdhesionShare,
    /// F_a(0) by the zero-force protocol, N: turned where the force is back at zero.
    ZeroForceAdhesionForce,
    /// The same over F_a,max.
    ZeroForceAdhesionShare,
    /// Preload F_n, N.
    PreloadForce,
    /// Indentation at the preload, m.
    PreloadIndentation,
    /// Adhesion force F_a(F_n), N.
    AdhesionForce,
    /// The same over F_a,max.
    AdhesionShare,
    /// Adhesion coefficient F_a/F_n.
    AdhesionCoefficient,
    /// Indentation at pull-off, m.
    PullOffIndentation,
    /// Energy lost over the loop, J.
    DissipatedEnergy,
    /// Largest length in contact over L.
    ContactFraction,
    /// Contact fragments at the preload.
    Fragments,
    /// Regime of Fig. 4.
    Regime,
    /// Exponent α of k ∝ F^α without adhesion, over the plan's `stiffness` range of forces.
    StiffnessExponent,
    /// Exponent n of F ∝ d^n without adhesion, over the same range.
    ForceExponent,
    /// Rms height of the line about its mean, m.
    RmsHeight,
    /// ⟨z³⟩/⟨z²⟩^(3/2) of the line.
    Skewness,
    /// ⟨z⁴⟩/⟨z²⟩² − 3 of the line.
    ExcessKurtosis,
    /// Height of the summit above the mean, over the rms height.
    SummitHeight,
}

/// What must be done for a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Needs {
    /// The line and what governs it.
    Line,
    /// Statistics of the heights without the form.
    Heights,
    /// F_a(0) by the touch protocol.
    Touch,
    /// The loop by the zero-force protocol.
    ZeroForce,
    /// The loop to the preload, or the scene's own loading.
    Loop,
    /// The force curve without adhesion.
    Stiffness,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Quantity; 23] = [
        Quantity::Kappa,
        Quantity::WorkOfAdhesion,
        Quantity::IdealAdhesionForce,
        Quantity::ZeroLoadAdhesionForce,
        Quantity::ZeroLoadAdhesionShare,
        Quantity::ZeroForceAdhesionForce,
        Quantity::ZeroForceAdhesionShare,
        Quantity::PreloadForce,
        Quantity::PreloadIndentation,
        Quantity::AdhesionForce,
        Quantity::AdhesionShare,
        Quantity::AdhesionCoefficient,
        Quantity::PullOffIndentation,
        Quantity::DissipatedEnergy,
        Quantity::ContactFraction,
        Quantity::Fragments,
        Quantity::Regime,
        Quantity::StiffnessExponent,
        Quantity::ForceExponent,
        Quantity::RmsHeight,
        Quantity::Skewness,
        Quantity::ExcessKurtosis,
        Quantity::SummitHeight,
    ];

    const fn row(self) -> (&'static str, &'static str, &'static str, &'static str, Needs) {
        match self {
            Quantity::Kappa => ("kappa", "κ", "1", "governing parameter, eq. (11)", Needs::Line),
            Quantity::WorkOfAdhesion => ("work_of_adhesion", "γ", "J/m²", "work of adhesion", Needs::Line),
            Quantity::IdealAdhesionForce => (
                "ideal_adhesion_force",
                "F_a,max",
                "N",
                "adhesion force of a flat face, eq. (14)",
                Needs::Line,
            ),
            Quantity::ZeroLoadAdhesionForce => (
                "zero_load_adhesion_force",
                "F_a(0)",
                "N",
                "adhesion force after turning at first touch",
                Needs::Touch,
            ),
            Quantity::ZeroLoadAdhesionShare => (
                "zero_load_adhesion_share",
                "F_a(0)/F_a,max",
                "1",
                "adhesion force after turning at first touch, over that of a flat face",
                Needs::Touch,
            ),
            Quantity::ZeroForceAdhesionForce => (
                "zero_force_adhesion_force",
                "F_a(0)",
                "N",
                "adhesion force after turning where the force is back at zero",
                Needs::ZeroForce,
            ),
            Quantity::ZeroForceAdhesionShare => (
                "zero_force_adhesion_share",
                "F_a(0)/F_a,max",
                "1",
                "adhesion force after turning where the force is back at zero, over that of a flat face",
                Needs::ZeroForce,
            ),
            Quantity::PreloadForce => {
                ("preload_force", "F_n", "N", "largest force of the loading", Needs::Loop)
            }
            Quantity::PreloadIndentation => {
                ("preload_indentation", "d", "m", "indentation at the preload", Needs::Loop)
            }
            Quantity::AdhesionForce => {
                ("adhesion_force", "F_a", "N", "adhesion force after the preload", Needs::Loop)
            }
            Quantity::AdhesionShare => (
                "adhesion_share",
                "F_a/F_a,max",
                "1",
                "adhesion force after the preload, over that of a flat face",
                Needs::Loop,
            ),
            Quantity::AdhesionCoefficient => {
                ("adhesion_coefficient", "F_a/F_n", "1", "adhesion force over preload", Needs::Loop)
            }
            Quantity::PullOffIndentation => {
                ("pull_off_indentation", "d", "m", "indentation at the smallest force", Needs::Loop)
            }
            Quantity::DissipatedEnergy => {
                ("dissipated_energy", "ΔW", "J", "energy lost over the loop", Needs::Loop)
            }
            Quantity::ContactFraction => {
                ("contact_fraction", "", "1", "largest length in contact over the length", Needs::Loop)
            }
            Quantity::Fragments => ("fragments", "", "1", "contact fragments at the preload", Needs::Loop),
            Quantity::Regime => ("regime", "", "", "regime of adhesion, Fig. 4", Needs::Loop),
            Quantity::StiffnessExponent => (
                "stiffness_exponent",
                "α",
                "1",
                "exponent of the stiffness over the force without adhesion, k ∝ F^α; 1/(1+H) is expected",
                Needs::Stiffness,
            ),
            Quantity::ForceExponent => (
                "force_exponent",
                "n",
                "1",
                "exponent of the force over the indentation without adhesion, F ∝ dⁿ",
                Needs::Stiffness,
            ),
            Quantity::RmsHeight => ("rms_height", "h", "m", "rms height of the line", Needs::Heights),
            Quantity::Skewness => {
                ("skewness", "", "1", "skewness of the heights of the line", Needs::Heights)
            }
            Quantity::ExcessKurtosis => {
                ("excess_kurtosis", "", "1", "excess kurtosis of the heights of the line", Needs::Heights)
            }
            Quantity::SummitHeight => {
                ("summit_height", "", "1", "height of the summit over the rms height", Needs::Heights)
            }
        }
    }

    /// Its name, that of its column.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// Its symbol; empty where it has none.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        self.row().1
    }

    /// SI unit; `1` for numbers without one, empty for the regime, which is no number.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        self.row().2
    }

    /// What it is, in one line.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        self.row().3
    }

    /// Whether it may be below zero.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(
            self,
            Quantity::PreloadIndentation
                | Quantity::PullOffIndentation
                | Quantity::Skewness
                | Quantity::ExcessKurtosis
        )
    }

    pub(super) const fn needs(self) -> Needs {
        self.row().4
    }

    /// The quantity of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Quantity> {
        Quantity::ALL.into_iter().find(|quantity| quantity.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_plan() {
        for quantity in Quantity::ALL {
            assert_eq!(ron::to_string(&quantity).unwrap(), quantity.name());
            assert_eq!(Quantity::named(quantity.name()), Some(quantity));
        }
        assert_eq!(Quantity::named("force"), None);
    }
}
