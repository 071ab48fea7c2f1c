//! Regimes of adhesion of a loading (Fig. 4 of Popov and Filippov (2012)).

use asperity_contact::Figures;
use serde::Serialize;
use strum::IntoStaticStr;

/// Regime of adhesion of a loading (Fig. 4 of Popov and Filippov (2012)). The regime states how
/// strongly the pull-off force depends on the preload. [`Regime::of_loading`] has the conditions of
/// each regime.
///
/// ```
/// use asperity_contact::Figures;
/// use asperity_scene::Regime;
///
/// // 5 µN after a preload, 1 µN without one, 10 µN of the smooth body.
/// let figures = Figures {
///     preload: Some(1.0e-4),
///     pull_off_force: Some(5.0e-6),
///     ..Figures::default()
/// };
/// let regime = Regime::of_loading(&figures, Some(1.0e-6), Some(1.0e-5));
/// assert_eq!(regime, Some(Regime::PressureSensitive));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr, Serialize)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Regime {
    /// The pull-off force hardly depends on the preload (Fig. 4a).
    PressureInsensitive,
    /// The pull-off force depends on the preload (Fig. 4b).
    PressureSensitive,
    /// There is no adhesion, or the pull-off force is negligible (Fig. 4c).
    NonAdhesive,
}

impl Regime {
    /// Smallest ratio of two pull-off forces for which a loading is pressure-insensitive: the
    /// pull-off force without a preload, divided by the pull-off force after the preload. See
    /// [`Regime::of_loading`].
    pub const INSENSITIVE_SHARE: f64 = 0.5;

    /// Bound for pull-off forces that count as zero, as a share of the pull-off force of the smooth
    /// body: a smaller pull-off force counts as zero. See [`Regime::of_loading`].
    pub const VANISHING_SHARE: f64 = 0.05;
    // The value of `VANISHING_SHARE` has little effect on the limit of the regime. When κ grows by
    // a factor of about three, the pull-off force without a preload falls from one half to one
    // twentieth of the smooth pull-off force.

    /// Largest ratio F_a/F_n of the pull-off force to the preload for which a loading counts as
    /// non-adhesive. A loading that is pressure-insensitive does not count as non-adhesive.
    pub const NEGLIGIBLE_COEFFICIENT: f64 = 0.01;

    /// All regimes: pressure-insensitive, pressure-sensitive and non-adhesive, in this order.
    pub const ALL: [Regime; 3] = [
        Regime::PressureInsensitive,
        Regime::PressureSensitive,
        Regime::NonAdhesive,
    ];

    /// Returns the regime of one loading of one profile; `None` for a loading without a tensile
    /// force.
    ///
    /// `turned` is the pull-off force in N without a preload: F_a(d=0) after a loading that turns
    /// at first touch, or F_a(F=0) after a loading that turns at zero force. `smooth` is the
    /// pull-off force in N of the same body without roughness. `turned` and `smooth` are `None` for
    /// a contact without adhesion, which is non-adhesive.
    ///
    /// F_a is the pull-off force and F_n the preload of this loading. The conditions are, in this
    /// order:
    ///
    /// 1. The regime is pressure-insensitive if `turned` is above zero, at least
    ///    [`Regime::INSENSITIVE_SHARE`] of F_a and at least [`Regime::VANISHING_SHARE`] of
    ///    `smooth`.
    /// 2. The regime is non-adhesive if F_a/F_n is at most [`Regime::NEGLIGIBLE_COEFFICIENT`]. A
    ///    loading without a preload is also non-adhesive if F_a is below
    ///    [`Regime::VANISHING_SHARE`] of `smooth`.
    /// 3. All other loadings are pressure-sensitive.
    pub fn of_loading(figures: &Figures, turned: Option<f64>, smooth: Option<f64>) -> Option<Self> {
        let preload = figures.preload.unwrap_or(0.0);
        match (figures.pull_off_force, turned, smooth) {
            (Some(_), None, None) => Some(Regime::NonAdhesive),
            (Some(adhesion), Some(turned), Some(smooth)) => {
                Some(Regime::of_forces(turned, adhesion, preload, smooth))
            }
            _ => None,
        }
    }

    fn of_forces(turned: f64, adhesion: f64, preload: f64, smooth: f64) -> Self {
        let present = turned >= Regime::VANISHING_SHARE * smooth && turned > 0.0;
        if present && turned >= Regime::INSENSITIVE_SHARE * adhesion {
            Regime::PressureInsensitive
        } else if adhesion <= Regime::NEGLIGIBLE_COEFFICIENT * preload
            || (preload <= 0.0 && adhesion < Regime::VANISHING_SHARE * smooth)
        {
            Regime::NonAdhesive
        } else {
            Regime::PressureSensitive
        }
    }

    /// Number of characters of the longest name of a regime.
    pub const LONGEST_NAME: usize = "pressure-insensitive".len();

    /// Returns the name of the regime, such as `pressure-sensitive`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns a text with two regimes of the same body, such as `pressure-sensitive (d=0),
    /// insensitive (F=0)`. `self` follows from the pull-off force after a loading that turns at
    /// first touch (d = 0). `after_zero_force` follows from the pull-off force after a loading that
    /// turns at zero force (F = 0).
    pub fn by_protocols(self, after_zero_force: Option<Regime>) -> String {
        let name = self.name();
        match after_zero_force {
            Some(same) if same == self && self == Regime::NonAdhesive => name.to_owned(),
            Some(same) if same == self => format!("{name} (d=0, F=0)"),
            None => format!("{name} (d=0)"),
            Some(other) => format!(
                "{name} (d=0), {} (F=0)",
                other.name().trim_start_matches("pressure-")
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regime_names_its_protocols() {
        let [insensitive, sensitive, non_adhesive] = Regime::ALL;
        assert_eq!(
            non_adhesive.by_protocols(Some(non_adhesive)),
            "non-adhesive"
        );
        assert_eq!(
            sensitive.by_protocols(Some(sensitive)),
            "pressure-sensitive (d=0, F=0)"
        );
        assert_eq!(
            sensitive.by_protocols(Some(insensitive)),
            "pressure-sensitive (d=0), insensitive (F=0)"
        );
        assert_eq!(sensitive.by_protocols(None), "pressure-sensitive (d=0)");
    }

    #[test]
    fn thresholds_belong_to_the_stronger_regime() {
        let [insensitive, sensitive, non_adhesive] = Regime::ALL;
        for (turned, adhesion, preload, smooth, expected) in [
            // A pull-off force without preload of half of the pull-off force is enough for the
            // pressure-insensitive regime; a slightly smaller one is not.
            (0.5, 1.0, 5.0, 1.0, insensitive),
            (0.5_f64.next_down(), 1.0, 5.0, 1.0, sensitive),
            // A pull-off force without preload of a twentieth of the smooth pull-off force is
            // enough for the pressure-insensitive regime; a slightly smaller one counts as zero.
            (Regime::VANISHING_SHARE, 0.1, 1.0, 1.0, insensitive),
            (
                Regime::VANISHING_SHARE.next_down(),
                0.09,
                1.0,
                1.0,
                sensitive,
            ),
            (0.2, 0.1, 1.0, 4.0, insensitive),
            (0.19, 0.1, 1.0, 4.0, sensitive),
            (0.0, 0.0, 0.0, 0.0, non_adhesive),
            // A pull-off force of a hundredth of the preload is negligible; a slightly larger one
            // is not.
            (0.0, Regime::NEGLIGIBLE_COEFFICIENT, 1.0, 1.0, non_adhesive),
            (
                0.0,
                Regime::NEGLIGIBLE_COEFFICIENT.next_up(),
                1.0,
                1.0,
                sensitive,
            ),
            // Without a preload, a pull-off force below a twentieth of the pull-off force of the
            // smooth body counts as no adhesion.
            (
                0.01,
                Regime::VANISHING_SHARE.next_down(),
                0.0,
                1.0,
                non_adhesive,
            ),
            (
                0.01,
                Regime::VANISHING_SHARE.next_down(),
                -1.0,
                1.0,
                non_adhesive,
            ),
            (0.01, Regime::VANISHING_SHARE, 0.0, 1.0, sensitive),
            (0.3, 1.0, 0.0, 1.0, sensitive),
            (0.3, 1.0, -1.0, 1.0, sensitive),
        ] {
            let found = Regime::of_forces(turned, adhesion, preload, smooth);
            assert_eq!(found, expected, "{turned} {adhesion} {preload} {smooth}");
        }
    }
}
