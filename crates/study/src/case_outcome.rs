//! The outcome of one loading on one profile. A study takes all quantities that it records from
//! this outcome.

use asperity_contact::{
    Branch, ClosedForm, CurvePoint, Figures, History, Move, Profile, Reversal, StageRecord,
};
use asperity_data::Warning;
use asperity_scene::{Governing, Regime, Scene};

/// Outcome of one loading on one profile. A result that the loading does not have is `None`.
pub(super) struct CaseOutcome<'o> {
    /// Governing parameters of the computed scene, such as its effective modulus and its rms
    /// height.
    pub governing: Governing,
    /// Statistics of the profile. They are computed only if the study records them.
    pub profile: ProfileRecord,
    /// Scene that was computed. Do not use its field `loading`: a preload of the study may have
    /// replaced this loading.
    pub scene: &'o Scene,
    /// Pull-off force F_a(d=0) in N of a loading that turns at first touch; `None` if this loading
    /// was not computed or has no pull-off force.
    pub first_touch: Option<f64>,
    /// Pull-off force F_a(F=0) in N of a loading that turns at zero force; `None` if this loading
    /// was not computed or has no pull-off force.
    pub zero_force: Option<f64>,
    /// Pull-off force F_smooth in N of the smooth body after the same preload. `None` unless the
    /// study records a regime of adhesion, and without adhesion.
    pub smooth: Option<f64>,
    /// Outcome of the loading.
    pub loading: LoadingOutcome,
    /// Premises of the model that this scene and profile do not meet.
    pub warnings: Vec<Warning>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LoadingOutcome {
    pub figures: Figures,
    /// Largest contact length in m; `None` if the force curve of the loading has no points.
    pub contact_length: Option<f64>,
    /// Point of the force curve at the preload; `None` if the loading has no preload.
    pub preload: Option<CurvePoint>,
    /// Premises of the model that the loading does not meet.
    pub warnings: Vec<Warning>,
}

impl LoadingOutcome {
    /// Collects the outcome of a loading on a profile from the records of its stages.
    pub fn of_stages(stages: Vec<StageRecord>, profile: &Profile) -> Self {
        let lengths = stages
            .iter()
            .flat_map(|stage| &stage.curve)
            .map(|point| point.contact_length);
        let contact_length = lengths.reduce(f64::max);
        let preload = Branch::preload(&stages).map(|(_, point)| point);
        let history = History {
            stages,
            ..History::default()
        };
        let warnings = history.warnings(profile);
        LoadingOutcome {
            figures: Figures::of(&history),
            contact_length,
            preload,
            warnings,
        }
    }

    /// Collects the outcome of a loading that starts and ends in separation. The move `stage`
    /// presses the bodies together up to the turning point, and `reversal` describes the turn and
    /// the unloading.
    pub fn of_reversal(stage: Move, reversal: &Reversal, profile: &Profile) -> Self {
        LoadingOutcome {
            figures: Figures::of_reversal(stage, reversal),
            contact_length: Some(reversal.turn.contact_length),
            preload: Some(reversal.turn),
            warnings: reversal.warnings(profile),
        }
    }
}

/// Properties that depend only on the profile and the elasticity.
#[derive(Clone, Copy, Default)]
pub(super) struct ProfileRecord {
    /// Root mean square of the heights about their mean in m, without the form of the body; `None`
    /// if the study does not record it.
    pub rms_height: Option<f64>,
    /// Skewness ⟨z³⟩ and excess kurtosis ⟨z⁴⟩ − 3 of the heights z about their mean, in units of
    /// the rms height; `None` for a flat profile. Both are zero for a normal distribution.
    pub shape: Option<(f64, f64)>,
    /// Height of the highest point above the mean height, divided by the rms height; `None` if the
    /// study does not record it.
    pub summit: Option<f64>,
    /// Exponents α of the stiffness k ∝ F^α and n of the force F ∝ dⁿ, for the contact without
    /// adhesion, with the indentation d. `None` if the study does not record them, or if they
    /// cannot be fitted.
    pub exponents: Option<(f64, f64)>,
}

impl ProfileRecord {
    /// Computes the statistics of the heights of a profile with these gaps in m. `deepest` is the
    /// largest gap.
    pub fn of_gaps(gaps: &[f64], deepest: f64) -> Self {
        let count = gaps.len() as f64;
        let mean = gaps.iter().sum::<f64>() / count;
        // The deviations of the heights are divided by the largest gap, and later by the rms
        // height, because powers of heights in m could be too small for a number.
        let squares = gaps.iter().map(|gap| ((gap - mean) / deepest).powi(2));
        let square = squares.sum::<f64>() / count;
        let rms = if deepest > 0.0 {
            square.sqrt() * deepest
        } else {
            0.0
        };
        let squares = gaps.iter().map(|gap| (gap - mean).powi(2));
        let unit = (squares.sum::<f64>() / count).sqrt();
        let mut third = -0.0;
        let mut fourth = -0.0;
        for gap in gaps {
            let z = (mean - gap) / unit;
            third += z * z * z;
            fourth += z * z * z * z;
        }
        third /= count;
        fourth /= count;
        let is_known = unit > 0.0 && third.is_finite() && fourth.is_finite();
        ProfileRecord {
            rms_height: Some(rms),
            shape: is_known.then_some((third, fourth - 3.0)),
            summit: Some(mean / rms),
            exponents: None,
        }
    }
}

impl CaseOutcome<'_> {
    /// Returns the ideal pull-off force F_a,max in N, eq. (14) of Popov and Filippov (2012); `None`
    /// without adhesion.
    pub fn ideal(&self) -> Option<f64> {
        let Governing {
            work_of_adhesion,
            modulus,
            ..
        } = self.governing;
        work_of_adhesion
            .map(|work| ClosedForm::ideal_pull_off_force(work, modulus, self.scene.length))
    }

    /// Returns a force in N divided by the ideal pull-off force F_a,max. Returns `None` if the
    /// force is `None` or if F_a,max is not above zero.
    pub fn share(&self, force: Option<f64>) -> Option<f64> {
        Some(force? / self.ideal().filter(|&ideal| ideal > 0.0)?)
    }

    /// Returns the largest contact length divided by the length of the profile; `None` if the force
    /// curve of the loading has no points.
    pub fn contact_fraction(&self) -> Option<f64> {
        self.loading
            .contact_length
            .map(|longest| longest / self.scene.length)
    }

    /// Returns the Tabor number; `None` without adhesion, and for a body without a radius of
    /// curvature.
    pub fn tabor_number(&self) -> Option<f64> {
        self.governing.tabor_number(self.scene)
    }

    /// Returns the regime of adhesion of this loading as its index in [`Regime::ALL`]; `None` for a
    /// loading without a tensile force. `first_touch` is the pull-off force in N without a preload:
    /// F_a(d=0) of a loading that turns at first touch, or F_a(F=0) of one that turns at zero
    /// force.
    pub fn regime(&self, first_touch: Option<f64>) -> Option<f64> {
        Some(Regime::of_loading(&self.loading.figures, first_touch, self.smooth)? as u8 as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::Edges;
    use asperity_scene::{Simulation, open};

    #[test]
    fn shapes_of_known_heights() {
        // For a sine ⟨sin⁴⟩ = 3/8 and ⟨sin²⟩ = 1/2, so the excess kurtosis is −3/2.
        let sine =
            (0..1000).map(|k| 3e-9 * (std::f64::consts::TAU * f64::from(k) / 1000.0).sin() + 4e-9);
        let of =
            |gaps: &[f64]| ProfileRecord::of_gaps(gaps, gaps.iter().copied().fold(0.0, f64::max));
        let (skewness, kurtosis) = of(&sine.collect::<Vec<_>>()).shape.unwrap();
        assert!(
            skewness.abs() < 1e-12 && (kurtosis + 1.5).abs() < 1e-12,
            "{skewness} {kurtosis}"
        );
        // One of four heights is different. In units of a quarter of this difference the deviations
        // from the mean are −1, −1, −1 and 3.
        let one_high = of(&[4.0, 4.0, 4.0, 0.0]);
        let (skewness, kurtosis) = one_high.shape.unwrap();
        assert!((skewness - 6.0 / 3.0_f64.powf(1.5)).abs() < 1e-12);
        assert!((kurtosis - (21.0 / 9.0 - 3.0)).abs() < 1e-12);
        assert!((one_high.rms_height.unwrap() - 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!((of(&[2.0; 5]).shape, of(&[]).shape), (None, None));
    }

    /// Tests rough, smooth and nonadhesive bodies, with one and two works of adhesion, and with
    /// both rules for the edges of patches of contact.
    #[test]
    fn the_outcome_of_a_reversal_is_that_of_a_run() {
        for name in [
            "pressure-sensitive",
            "rough-sphere",
            "kendall-punch",
            "non-adhesive",
            "two-works",
        ] {
            for edges in [Edges::Grid, Edges::SubCell] {
                let document = open(name).unwrap();
                let scene = document.scene().with(|scene| {
                    (scene.numerics.edges, scene.numerics.samples) = (edges, 2);
                });
                let scene = scene.unwrap();
                let presses = [
                    Move::ToTouch,
                    Move::ToZeroForce,
                    Move::ToForce(0.0),
                    Move::ToForce(1e-6),
                    Move::ToForce(3e-5),
                ];
                let mut reversed = vec![None; presses.len()];
                let mut simulation = Simulation::new(document.resolve(""));
                let profile = simulation.profile(&scene).unwrap();
                let see: &mut dyn FnMut(usize, Reversal) -> _ = &mut |index, reversal| {
                    reversed[index] = Some(LoadingOutcome::of_reversal(
                        presses[index],
                        &reversal,
                        &profile,
                    ));
                    Ok(())
                };
                simulation
                    .reverse(&scene, &presses, &[], &|| false, see)
                    .unwrap();
                for (press, reversed) in presses.into_iter().zip(reversed) {
                    let loading = vec![press, Move::ToSeparation];
                    let scene = scene.with(|scene| scene.loading = loading).unwrap();
                    let run = simulation
                        .run(&scene, &|| false, &mut |_, _, _| Ok(()))
                        .unwrap();
                    let stages = LoadingOutcome::of_stages(run.history.stages, &profile);
                    assert_eq!(reversed, Some(stages), "{name}, {edges:?}, {press:?}");
                }
            }
        }
    }
}
