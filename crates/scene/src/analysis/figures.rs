//! The headline figures of a loading history, the marked points of its force curve, and the regime of adhesion (Fig. 4) of
//! one loading.

use super::branches::{Branch, ROUNDING, preload_point, pull_off_point};
use asperity_contact::Move;
use asperity_contact::{CurvePoint, Direction, History, LegRecord, Reversal};
use serde::Serialize;
use strum::IntoStaticStr;

/// Figures of a loading history; `None` for a figure that the history does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Preload F_n: largest force while loading, since the last separation and before the last unloading, N.
    pub preload: Option<f64>,
    /// Indentation at the preload, m.
    pub preload_indentation: Option<f64>,
    /// Adhesion force F_a, N: minus the smallest force of the last unloading, in any number of stages; `None` if that force
    /// is above zero, or if the unloading ends in contact while the force still falls.
    pub adhesion_force: Option<f64>,
    /// Adhesion coefficient F_a/F_n; `None` without a compressive preload.
    pub adhesion_coefficient: Option<f64>,
    /// Indentation at the smallest force of the last unloading, m.
    pub pull_off_indentation: Option<f64>,
    /// Dissipated energy of a history that ends separated, J.
    pub dissipated_energy: Option<f64>,
}

impl Figures {
    /// Computes the figures of a history.
    pub fn of(history: &History) -> Self {
        let legs = &history.legs;
        let ends_separated =
            legs.last().and_then(|leg| leg.curve.last()).is_some_and(|point| point.springs == 0);
        Figures::at(
            preload_point(legs).map(|(stage, point)| (legs[stage].target, point)),
            pull_off_point(legs).map(|(_, point)| point),
            ends_separated.then(|| legs.iter().map(|leg| leg.released_energy).sum::<f64>()),
        )
    }

    /// Computes the figures of a history that loads from separation to `leg`, the turning point of `reversal`, and unloads
    /// to separation.
    pub fn of_reversal(leg: Move, reversal: &Reversal) -> Self {
        let touches = reversal.turn.springs > 0;
        Figures::at(
            touches.then_some((leg, reversal.turn)),
            Some(reversal.smallest).filter(|point| touches && point.force <= 0.0),
            Some(reversal.dissipated_energy),
        )
    }

    /// Figures from the point of the largest force with the target of its stage, the pull-off point, and the released
    /// energy of all stages, J.
    fn at(pressed: Option<(Move, CurvePoint)>, pull_off: Option<CurvePoint>, energy: Option<f64>) -> Self {
        let preload = pressed.map(|(target, point)| without_rounding(target, point).force);
        // Not −F, which would make a force of zero negative.
        let adhesion_force = pull_off.map(|point| 0.0 - point.force);
        Figures {
            preload,
            preload_indentation: pressed.map(|(_, point)| point.indentation),
            adhesion_force,
            adhesion_coefficient: adhesion_force
                .zip(preload.filter(|&force| force > 0.0))
                .map(|(adhesion, preload)| adhesion / preload)
                .filter(|coefficient| coefficient.is_finite()),
            pull_off_indentation: pull_off.map(|point| point.indentation),
            // Changes −0 to 0 without dissipation.
            dissipated_energy: energy.map(|energy| energy + 0.0),
        }
    }
}

/// A marked point of a force curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr)]
#[strum(serialize_all = "kebab-case")]
pub enum Mark {
    /// First contact at a tensile force, where the contact forms in a jump.
    JumpIn,
    /// Point of the preload; see [`preload_point`].
    Preload,
    /// Point of the pull-off at a tensile force; see [`pull_off_point`].
    PullOff,
    /// Last contact of the unloading with the pull-off, if the contact is lost in a jump after the pull-off.
    JumpOut,
}

impl Mark {
    /// Technical name.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The end of a stage; the force that remains at a target force of zero is rounding.
fn without_rounding(target: Move, end: CurvePoint) -> CurvePoint {
    match target {
        Move::ToForce(0.0) | Move::ToZeroForce => CurvePoint { force: 0.0, ..end },
        _ => end,
    }
}

/// The marked points that a loading history has, in their order.
pub fn marks(legs: &[LegRecord]) -> Vec<(Mark, CurvePoint)> {
    let into_contact = |leg: &LegRecord| {
        let pair = leg.curve.windows(2).find(|pair| pair[0].springs == 0 && pair[1].springs > 0)?;
        Some(pair[1]).filter(|_| leg.direction == Direction::Loading)
    };
    let out_of_contact = |leg: &LegRecord| {
        let pair = leg.curve.windows(2).rfind(|pair| pair[0].springs > 0 && pair[1].springs == 0)?;
        Some(pair[0])
    };
    let jump_in = legs.iter().find_map(into_contact);
    let pull_off = pull_off_point(legs);
    let jump_out = pull_off.and_then(|(_, least)| {
        let unloading = Branch::last_unloading(legs)?;
        let last = legs[unloading.stages].iter().rev().find_map(out_of_contact)?;
        Some(last).filter(|last| last.force > least.force * (1.0 - ROUNDING))
    });
    let found = [
        (Mark::JumpIn, jump_in),
        (
            Mark::Preload,
            preload_point(legs).map(|(stage, point)| without_rounding(legs[stage].target, point)),
        ),
        (Mark::PullOff, pull_off.map(|(_, point)| point)),
        (Mark::JumpOut, jump_out),
    ];
    let found = found.into_iter().filter_map(|(mark, point)| Some((mark, point?)));
    found.filter(|(mark, point)| *mark == Mark::Preload || point.force < 0.0).collect()
}

/// Share of the adhesion force after the preload from which on adhesion without a preload counts as pressure-insensitive:
/// half of the adhesion needs no pressing.
pub const INSENSITIVE_SHARE: f64 = 0.5;

/// Share of the adhesion force of the smooth body below which adhesion without a preload has vanished. The transition from
/// above one half to below one twentieth spans a factor of about three in κ, so the choice has little effect on the boundary.
pub const VANISHING_SHARE: f64 = 0.05;

/// Adhesion coefficient F_a/F_n below which adhesion is negligible: the bodies adhere with less than a
/// hundredth of the force that pressed them together.
pub const NEGLIGIBLE_COEFFICIENT: f64 = 0.01;

/// Regime of adhesion: how adhesion depends on the load, Fig. 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr, Serialize)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Regime {
    /// (a) Adhesion exists at first contact and hardly depends on the preload.
    PressureInsensitive,
    /// (b) Adhesion appears, or grows considerably, only under a preload.
    PressureSensitive,
    /// (c) Almost no adhesion under any preload.
    NonAdhesive,
}

impl Regime {
    /// All regimes in the order of decreasing adhesion.
    pub const ALL: [Regime; 3] =
        [Regime::PressureInsensitive, Regime::PressureSensitive, Regime::NonAdhesive];

    /// Returns the regime of one loading of one profile; `None` for a loading without a tensile force. `zero_load` is the
    /// adhesion force F_a(0) by the touch or the zero-force protocol and `smooth` that of the same body without roughness,
    /// both in N and `None` without adhesion. F_a(0) is larger by the zero-force protocol, so where both protocols give
    /// different regimes, the zero-force one gives the pressure-insensitive regime.
    ///
    /// Pressure-insensitive: F_a(0) is at least [`INSENSITIVE_SHARE`] of F_a(F_n) and at least
    /// [`VANISHING_SHARE`] of the smooth body's. Otherwise non-adhesive if F_a(F_n)/F_n is below
    /// [`NEGLIGIBLE_COEFFICIENT`] or, without a preload, if the adhesion force is below [`VANISHING_SHARE`] of the smooth
    /// body's; pressure-sensitive in all other cases.
    pub fn of_loading(figures: &Figures, zero_load: Option<f64>, smooth: Option<f64>) -> Option<Self> {
        let preload = figures.preload.unwrap_or(0.0);
        match (figures.adhesion_force, zero_load, smooth) {
            (Some(_), None, None) => Some(Regime::NonAdhesive),
            (Some(adhesion), Some(zero_load), Some(smooth)) => {
                Some(Regime::of_forces(zero_load, adhesion, preload, smooth))
            }
            _ => None,
        }
    }

    fn of_forces(zero_load: f64, adhesion: f64, preload: f64, smooth: f64) -> Self {
        let present = zero_load >= VANISHING_SHARE * smooth && zero_load > 0.0;
        if present && zero_load >= INSENSITIVE_SHARE * adhesion {
            Regime::PressureInsensitive
        } else if adhesion <= NEGLIGIBLE_COEFFICIENT * preload
            || (preload <= 0.0 && adhesion < VANISHING_SHARE * smooth)
        {
            Regime::NonAdhesive
        } else {
            Regime::PressureSensitive
        }
    }

    /// Number of characters of the longest name of a regime.
    pub const LONGEST_NAME: usize = "pressure-insensitive".len();

    /// Name of the regime in words.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Name of the regime with the protocols for F_a(0) that give it; also the regime after zero net force, if that differs.
    pub fn by_protocols(self, after_zero_force: Option<Regime>) -> String {
        let name = self.name();
        match after_zero_force {
            Some(same) if same == self && self == Regime::NonAdhesive => name.to_owned(),
            Some(same) if same == self => format!("{name} (d=0, F=0)"),
            None => format!("{name} (d=0)"),
            Some(other) => format!("{name} (d=0), {} (F=0)", other.name().trim_start_matches("pressure-")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(indentation: f64, force: f64, springs: u64) -> CurvePoint {
        CurvePoint { indentation, force, springs, ..CurvePoint::default() }
    }

    /// A stage with this curve, of which one point is the extreme, and a released energy of 0.25 J.
    fn leg(target: Move, direction: Direction, curve: &[CurvePoint], extreme: CurvePoint) -> LegRecord {
        let (curve, largest, smallest) = (curve.to_vec(), extreme, extreme);
        let still = LegRecord::still(target, extreme);
        LegRecord { direction, curve, largest, smallest, released_energy: 0.25, ..still }
    }

    fn pressed(force: f64) -> LegRecord {
        let extreme = point(force / 10.0, force, 3);
        leg(Move::ToForce(force), Direction::Loading, &[point(0.0, 0.5, 1), extreme], extreme)
    }

    fn pulled(force: f64, springs: u64) -> LegRecord {
        let extreme = point(-0.3, force, 2);
        leg(Move::ToSeparation, Direction::Unloading, &[extreme, point(-0.3, 0.0, springs)], extreme)
    }

    fn figures(legs: &[LegRecord]) -> Figures {
        Figures::of(&History { legs: legs.to_vec(), ..History::default() })
    }

    #[test]
    fn figures_are_of_the_largest_press_and_the_last_pull() {
        let found = figures(&[pressed(7.0), pulled(-3.0, 1), pressed(5.0), pulled(-2.0, 0)]);
        let expected = Figures {
            preload: Some(7.0),
            preload_indentation: Some(0.7),
            adhesion_force: Some(2.0),
            adhesion_coefficient: Some(2.0 / 7.0),
            pull_off_indentation: Some(-0.3),
            dissipated_energy: Some(1.0),
        };
        assert_eq!(found, expected);
        // No dissipation is 0, not −0.
        let nothing = |leg: LegRecord| LegRecord { released_energy: -0.0, ..leg };
        let lost = figures(&[nothing(pressed(7.0)), nothing(pulled(-3.0, 0))]).dissipated_energy;
        assert!(lost.is_some_and(|lost| lost == 0.0 && lost.is_sign_positive()), "{lost:?}");
        // A body in contact has not completed a loop.
        assert_eq!(figures(&[pressed(7.0), pulled(-3.0, 1)]).dissipated_energy, None);
        assert_eq!(figures(&[]), Figures::default());
    }

    #[test]
    fn only_a_leg_that_pulls_has_an_adhesion_force_and_only_a_preload_a_coefficient() {
        let adhesion = |force| figures(&[pressed(1.0), pulled(force, 0)]).adhesion_force;
        assert_eq!(adhesion(1e-300), None);
        let none = adhesion(0.0);
        assert!(none == Some(0.0) && none.is_some_and(f64::is_sign_positive));
        assert_eq!(adhesion(-1e-300), Some(1e-300));
        // The pull-off is a minimum within the stage: the force rises again after it.
        let ends_at = |force| {
            let mut pulled = pulled(-1.0, 0);
            pulled.curve = vec![pulled.smallest, point(-0.5, force, 1)];
            figures(&[pressed(1.0), pulled]).adhesion_force
        };
        assert_eq!([ends_at(-1.0), ends_at(-1.0 + 1e-12), ends_at(-0.9)], [None, None, Some(1.0)]);
        // A coefficient that overflows is `None`, and so is that of a target force of zero, where a rounding remains.
        for pressed in [pressed(0.0), pressed(1e-320)] {
            assert_eq!(figures(&[pressed, pulled(-1.0, 0)]).adhesion_coefficient, None);
        }
        for target in [Move::ToForce(0.0), Move::ToZeroForce] {
            let found = figures(&[LegRecord { target, ..pressed(1e-18) }, pulled(-1.0, 0)]);
            assert_eq!((found.preload, found.adhesion_coefficient), (Some(0.0), None));
        }
    }

    #[test]
    fn a_loop_has_its_marks_and_a_curve_without_adhesion_only_the_preload() {
        let up = [point(0.0, 0.0, 0), point(0.0, -1.0, 2), point(2.0, 3.0, 9)];
        let down = [up[2], point(-1.0, -2.0, 5), point(-1.5, -0.5, 1), point(-1.5, 0.0, 0)];
        let mut legs = [
            leg(Move::ToForce(3.0), Direction::Loading, &up, up[2]),
            leg(Move::ToSeparation, Direction::Unloading, &down, down[1]),
        ];
        let expected = [
            (Mark::JumpIn, up[1]),
            (Mark::Preload, up[2]),
            (Mark::PullOff, down[1]),
            (Mark::JumpOut, down[2]),
        ];
        assert_eq!(marks(&legs), expected);
        legs[1].curve.remove(2);
        assert_eq!(marks(&legs), expected[..3], "the contact is lost at pull-off");
        assert_eq!(marks(&[pressed(1.0)]).len(), 1);
    }

    #[test]
    fn a_regime_names_its_protocols() {
        let [insensitive, sensitive, non_adhesive] = Regime::ALL;
        assert_eq!(non_adhesive.by_protocols(Some(non_adhesive)), "non-adhesive");
        assert_eq!(sensitive.by_protocols(Some(sensitive)), "pressure-sensitive (d=0, F=0)");
        assert_eq!(sensitive.by_protocols(Some(insensitive)), "pressure-sensitive (d=0), insensitive (F=0)");
        assert_eq!(sensitive.by_protocols(None), "pressure-sensitive (d=0)");
    }

    #[test]
    fn thresholds_belong_to_the_stronger_regime() {
        let [insensitive, sensitive, non_adhesive] = Regime::ALL;
        for (zero_load, adhesion, preload, smooth, expected) in [
            // Half of the adhesion needs no pressing; slightly less does not count.
            (0.5, 1.0, 5.0, 1.0, insensitive),
            (0.5_f64.next_down(), 1.0, 5.0, 1.0, sensitive),
            // A twentieth of the smooth body's adhesion exists; slightly less has vanished.
            (VANISHING_SHARE, 0.1, 1.0, 1.0, insensitive),
            (VANISHING_SHARE.next_down(), 0.09, 1.0, 1.0, sensitive),
            (0.2, 0.1, 1.0, 4.0, insensitive),
            (0.19, 0.1, 1.0, 4.0, sensitive),
            (0.0, 0.0, 0.0, 0.0, non_adhesive),
            // A hundredth of the preload is negligible; slightly more is not.
            (0.0, NEGLIGIBLE_COEFFICIENT, 1.0, 1.0, non_adhesive),
            (0.0, NEGLIGIBLE_COEFFICIENT.next_up(), 1.0, 1.0, sensitive),
            // Without a preload adhesion below a twentieth of the smooth body's is none; a twentieth is some.
            (0.01, VANISHING_SHARE.next_down(), 0.0, 1.0, non_adhesive),
            (0.01, VANISHING_SHARE.next_down(), -1.0, 1.0, non_adhesive),
            (0.01, VANISHING_SHARE, 0.0, 1.0, sensitive),
            (0.3, 1.0, 0.0, 1.0, sensitive),
            (0.3, 1.0, -1.0, 1.0, sensitive),
        ] {
            let found = Regime::of_forces(zero_load, adhesion, preload, smooth);
            assert_eq!(found, expected, "{zero_load} {adhesion} {preload} {smooth}");
        }
    }
}
