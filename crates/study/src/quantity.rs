//! Quantities that a study records for each cell (combination of values on the axes) and each
//! profile. A table in this file describes one quantity in each row.

use super::case_outcome::CaseOutcome;
use asperity_scene::Regime;
use asperity_scene::text::did_you_mean;
use serde::{Deserialize, Serialize};

struct Row {
    /// Name of the quantity in plans and in columns of tables.
    name: &'static str,
    /// Symbol of the quantity; empty if the quantity has no symbol.
    symbol: &'static str,
    /// SI unit: `1` for a number without a unit, empty for a regime, which is not a number.
    unit: &'static str,
    meaning: &'static str,
    bounds: (f64, f64),
    needs: Needs,
    of: fn(&CaseOutcome<'_>) -> Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Needs {
    /// The quantity needs the profile and its governing parameters, such as the effective modulus
    /// and the rms height, but no loading.
    Profile,
    /// The quantity needs statistics of the heights of the roughness, without the form of the body.
    Heights,
    /// The quantity needs a loading that turns at first touch, which gives the pull-off force
    /// F_a(d=0).
    Touch,
    /// The quantity needs a loading that turns at zero force, which gives the pull-off force
    /// F_a(F=0).
    ZeroForce,
    /// The quantity needs the loading to the preload or, if the study has no preloads, the loading
    /// of the scene.
    Loading,
    /// The quantity needs the force curve of the contact without adhesion. From it follow the
    /// exponents with which the stiffness grows with the force, and the force with the indentation.
    Stiffness,
}

const ROW: Row = Row {
    name: "",
    symbol: "",
    unit: "1",
    meaning: "",
    bounds: (0.0, f64::INFINITY),
    needs: Needs::Loading,
    of: |_| None,
};

/// Bounds of the values: `ANY` for a quantity that may be positive or negative, and `SHARE` for a
/// share.
const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
const SHARE: (f64, f64) = (0.0, 1.0);

/// Makes the enum of the quantities and the table with a row for each quantity.
macro_rules! quantities {
    ($($variant:ident { name: $name:literal, meaning: $meaning:literal, $($field:ident: $value:expr),* $(,)? })*) => {
        /// Quantity that a study records for each [cell](crate::Plan) on each random profile. The
        /// documentation of each variant begins with the name of the quantity in plans and tables.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Quantity {
            $(#[doc = concat!("`", $name, "`: ", $meaning, ".")] #[serde(rename = $name)] $variant,)*
        }

        const ROWS: &[Row] = &[$(Row { name: $name, meaning: $meaning, $($field: $value,)* ..ROW },)*];

        impl Quantity {
            /// All quantities that a study can record, in the order of the variants.
            pub const ALL: [Quantity; ROWS.len()] = [$(Quantity::$variant,)*];
        }
    };
}

quantities! {
    Kappa {
        name: "kappa", meaning: "roughness-adhesion parameter √(h⟨∇z⟩E*/γ)",
        symbol: "κ", needs: Needs::Profile, of: |case| case.governing.kappa,
    }
    ElasticEnergy {
        name: "elastic_energy", meaning: "elastic energy per area that flattens the roughness",
        symbol: "e_el", unit: "J/m²", needs: Needs::Profile, of: |case| case.governing.elastic_energy(),
    }
    ElasticEnergyRatio {
        name: "elastic_energy_ratio",
        meaning: "elastic energy per area that flattens the roughness, divided by the work of adhesion",
        symbol: "e_el/γ", needs: Needs::Profile, of: |case| case.governing.elastic_energy_ratio,
    }
    WorkOfAdhesion {
        name: "work", meaning: "work of adhesion, the energy per area that opens the interface",
        symbol: "γ", unit: "J/m²", needs: Needs::Profile, of: |case| case.governing.work_of_adhesion,
    }
    IdealPullOffForce {
        name: "ideal_pull_off_force", meaning: "pull-off force √(πγE*L³) of a flat face of length L",
        symbol: "F_a,max", unit: "N", needs: Needs::Profile, of: |case| case.ideal(),
    }
    FirstTouchPullOffForce {
        name: "first_touch_pull_off_force",
        meaning: "pull-off force F_a(d=0) of a loop that turns at first touch",
        symbol: "F_a(d=0)", unit: "N", needs: Needs::Touch, of: |case| case.first_touch,
    }
    FirstTouchAdhesionShare {
        name: "first_touch_adhesion_share",
        meaning: "F_a(d=0) divided by the ideal pull-off force",
        symbol: "F_a(d=0)/F_a,max", bounds: SHARE, needs: Needs::Touch,
        of: |case| case.share(case.first_touch),
    }
    ZeroForcePullOffForce {
        name: "zero_force_pull_off_force",
        meaning: "pull-off force F_a(F=0) of a loop that turns at zero force",
        symbol: "F_a(F=0)", unit: "N", needs: Needs::ZeroForce, of: |case| case.zero_force,
    }
    ZeroForceAdhesionShare {
        name: "zero_force_adhesion_share",
        meaning: "F_a(F=0) divided by the ideal pull-off force",
        symbol: "F_a(F=0)/F_a,max", bounds: SHARE, needs: Needs::ZeroForce,
        of: |case| case.share(case.zero_force),
    }
    PreloadForce {
        name: "preload_force", meaning: "preload, the largest force before the last unloading",
        symbol: "F_n", unit: "N", of: |case| case.loading.figures.preload,
    }
    PreloadIndentation {
        name: "preload_indentation", meaning: "indentation at the preload",
        symbol: "d", unit: "m", bounds: ANY, of: |case| case.loading.figures.preload_indentation,
    }
    PullOffForce {
        name: "pull_off_force", meaning: "pull-off force after the preload",
        symbol: "F_a", unit: "N", of: |case| case.loading.figures.pull_off_force,
    }
    AdhesionShare {
        name: "adhesion_share", meaning: "pull-off force divided by the ideal pull-off force",
        symbol: "F_a/F_a,max", bounds: SHARE, of: |case| case.share(case.loading.figures.pull_off_force),
    }
    AdhesionCoefficient {
        name: "adhesion_coefficient", meaning: "pull-off force divided by the preload",
        symbol: "F_a/F_n", of: |case| case.loading.figures.adhesion_coefficient,
    }
    PullOffIndentation {
        name: "pull_off_indentation",
        meaning: "indentation at the pull-off, the smallest force of the last unloading",
        symbol: "d", unit: "m", bounds: ANY, of: |case| case.loading.figures.pull_off_indentation,
    }
    DissipatedEnergy {
        name: "dissipated_energy", meaning: "energy dissipated in the contact over the whole loop",
        symbol: "ΔW", unit: "J", of: |case| case.loading.figures.dissipated_energy,
    }
    TaborNumber {
        name: "tabor_number", meaning: "Tabor number, small for long-ranged attraction",
        symbol: "μ", of: |case| case.tabor_number(),
    }
    ContactFraction {
        name: "contact_fraction",
        meaning: "largest contact length on the loading, divided by the length L of the profile",
        bounds: SHARE, of: |case| case.contact_fraction(),
    }
    Patches {
        name: "patches", meaning: "number of patches at the preload",
        of: |case| case.loading.preload.map(|point| point.patches as f64),
    }
    Regime {
        name: "regime", meaning: "regime of adhesion that follows from F_a(d=0)",
        unit: "", of: |case| case.regime(case.first_touch),
    }
    RegimeAfterZeroForce {
        name: "regime_after_zero_force", meaning: "regime of adhesion that follows from F_a(F=0)",
        unit: "", of: |case| case.regime(case.zero_force),
    }
    Warnings {
        name: "warnings", meaning: "number of premises of the model that the case does not meet",
        of: |case| Some(case.warnings.len() as f64),
    }
    StiffnessExponent {
        name: "stiffness_exponent",
        meaning: "exponent α of the stiffness k without adhesion, k ∝ F^α",
        symbol: "α", needs: Needs::Stiffness, of: |case| Some(case.profile.exponents?.0),
    }
    ForceExponent {
        name: "force_exponent",
        meaning: "exponent n of the force F without adhesion, F ∝ dⁿ",
        symbol: "n", needs: Needs::Stiffness, of: |case| Some(case.profile.exponents?.1),
    }
    RmsHeight {
        name: "rms_height", meaning: "rms height of the profile without the form",
        symbol: "h", unit: "m", needs: Needs::Heights, of: |case| case.profile.rms_height,
    }
    Skewness {
        name: "skewness", meaning: "skewness of the heights of the profile without the form",
        bounds: ANY, needs: Needs::Heights, of: |case| Some(case.profile.shape?.0),
    }
    ExcessKurtosis {
        name: "excess_kurtosis", meaning: "excess kurtosis of the heights of the profile without the form",
        bounds: ANY, needs: Needs::Heights, of: |case| Some(case.profile.shape?.1),
    }
    SummitHeight {
        name: "summit_height",
        meaning: "height of the highest point above the mean height, divided by the rms height",
        needs: Needs::Heights, of: |case| case.profile.summit,
    }
}

impl Quantity {
    /// Pull-off forces without a preload, divided by the ideal pull-off force F_a,max. The first is
    /// F_a(d=0) of a loading that turns at first touch, the second F_a(F=0) of a loading that turns
    /// at zero force.
    pub const ADHESION_SHARES: [Quantity; 2] = [
        Quantity::FirstTouchAdhesionShare,
        Quantity::ZeroForceAdhesionShare,
    ];

    /// Regimes of adhesion as quantities. The first follows from F_a(d=0), the pull-off force of a
    /// loading that turns at first touch. The second follows from F_a(F=0), the pull-off force of a
    /// loading that turns at zero force.
    pub const REGIMES: [Quantity; 2] = [Quantity::Regime, Quantity::RegimeAfterZeroForce];

    /// Returns words that state at which point the loading turns before the pull-off force is
    /// taken: `turned at zero force` for [`Quantity::RegimeAfterZeroForce`], and `turned at first
    /// touch` for any other quantity.
    pub fn protocol(self) -> &'static str {
        if self == Quantity::RegimeAfterZeroForce {
            "turned at zero force"
        } else {
            "turned at first touch"
        }
    }

    /// Returns the symbol of the point at which the loading turns: `F=0` for zero force, `d=0` for
    /// first touch.
    pub fn short_protocol(self) -> &'static str {
        if self == Quantity::RegimeAfterZeroForce {
            "F=0"
        } else {
            "d=0"
        }
    }

    /// Returns true if the quantity is a regime of adhesion, which is not a number.
    pub fn is_regime(self) -> bool {
        Quantity::REGIMES.contains(&self)
    }

    const fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Returns the name of the quantity in plans and in columns of tables, such as
    /// `pull_off_force`.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns the symbol of the quantity, such as `F_a`; empty if it has none.
    pub const fn symbol(self) -> &'static str {
        self.row().symbol
    }

    /// Returns the SI unit of the quantity; `1` for a number without a unit, empty for a regime.
    pub const fn unit(self) -> &'static str {
        self.row().unit
    }

    /// Returns the symbol of the quantity, or its name if it has no symbol.
    pub const fn symbol_or_name(self) -> &'static str {
        if self.symbol().is_empty() {
            self.name()
        } else {
            self.symbol()
        }
    }

    /// Returns the quantity with this symbol or name. The words of a name may be separated by
    /// blanks, hyphens or `_`.
    ///
    /// # Errors
    /// Returns an error if no quantity has this symbol or name, or if several quantities have this
    /// symbol.
    ///
    /// ```
    /// use asperity_study::Quantity;
    ///
    /// assert_eq!(Quantity::named("dissipated energy"), Ok(Quantity::DissipatedEnergy));
    /// assert_eq!(Quantity::DissipatedEnergy.unit(), "J");
    /// assert!(Quantity::named("F_b").is_err());
    /// ```
    pub fn named(text: &str) -> Result<Quantity, String> {
        let text = text.trim();
        let name = text.to_lowercase().replace([' ', '-'], "_");
        let mut found = Quantity::ALL.to_vec();
        found.retain(|quantity| quantity.symbol() == text || quantity.name() == name);
        match found[..] {
            [quantity] => Ok(quantity),
            [] => {
                let words = Quantity::ALL
                    .into_iter()
                    .flat_map(|quantity| [quantity.name(), quantity.symbol()]);
                // A symbol of one or two letters is close to any wrong name, so only longer names
                // are suggested.
                let near = did_you_mean(&name, words.filter(|word| word.chars().count() > 2));
                if near.is_empty() {
                    let all = Quantity::names(&Quantity::ALL);
                    return Err(format!("{text:?} is no quantity (quantities: {all})"));
                }
                Err(format!("{text:?} is no quantity{near}"))
            }
            ref several => {
                let names = Quantity::names(several);
                Err(format!("{text:?} has several meanings; allowed: {names}"))
            }
        }
    }

    fn names(quantities: &[Quantity]) -> String {
        let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
        names.join(", ")
    }

    /// Returns the meaning of the quantity as one line of text, such as
    /// `pull-off force after the preload`.
    pub const fn meaning(self) -> &'static str {
        self.row().meaning
    }

    /// Returns the smallest and the largest value that the quantity can have, in its SI unit. A
    /// missing bound is −∞ or ∞.
    pub const fn bounds(self) -> (f64, f64) {
        self.row().bounds
    }

    pub(super) const fn needs(self) -> Needs {
        self.row().needs
    }

    /// Returns the value of the quantity in the outcome of a case, in its SI unit; NaN if the
    /// quantity has no value in this case. The value of a regime is its index in
    /// [`asperity_scene::Regime::ALL`].
    pub(super) fn of(self, case: &CaseOutcome<'_>) -> f64 {
        (self.row().of)(case)
            .filter(|value| value.is_finite())
            .unwrap_or(f64::NAN)
    }
}

/// Returns the regime for a recorded value, which is an index or NaN; `None` for NaN.
pub(super) fn regime_of(value: f64) -> Option<Regime> {
    Regime::ALL
        .get(Some(value as usize).filter(|_| !value.is_nan())?)
        .copied()
}
