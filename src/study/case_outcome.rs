//! Outcome of one case, the source of all recorded quantities.

use super::height_shape::HeightShape;
use crate::analysis::{Figures, Governing, Regime, ideal_adhesion_force};
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::simulation::Outcome;

/// Outcome of one loading on one profile; a figure that the case does not have is `None`.
pub(super) struct CaseOutcome<'o> {
    /// Governing parameters.
    pub governing: Governing,
    /// Properties of the profile, as far as they are recorded.
    pub profile: ProfileRecord,
    /// Outcome of the run that this loading is a part of, where there was a run.
    pub run: Option<&'o Outcome>,
    /// F_a(0) by the zero-force protocol, N.
    pub zero_force: Option<f64>,
    /// Figures of this loading.
    pub figures: Figures,
    /// Legs of this loading.
    pub legs: Vec<LegRecord>,
    /// Apparent diameter L, m.
    pub length: f64,
}

/// Properties that depend on the profile and the elasticity alone.
#[derive(Clone, Copy, Default)]
pub(super) struct ProfileRecord {
    /// Statistics of the heights without the form.
    pub heights: Option<HeightStatistics>,
    /// Exponents of the contact without adhesion.
    pub exponents: Option<Exponents>,
}

/// Statistics of the heights of a profile.
#[derive(Clone, Copy)]
pub(super) struct HeightStatistics {
    /// Rms height about the mean, m.
    pub rms: f64,
    /// Skewness and kurtosis; `None` for a flat profile.
    pub shape: Option<HeightShape>,
    /// Height of the summit above the mean over the rms height.
    pub summit: f64,
}

/// Exponents of the contact without adhesion.
#[derive(Clone, Copy)]
pub(super) struct Exponents {
    /// α of k ∝ F^α.
    pub stiffness: f64,
    /// n of F ∝ dⁿ.
    pub force: f64,
}

impl CaseOutcome<'_> {
    /// F_a(0) by the touch protocol, N.
    pub fn zero_load(&self) -> Option<f64> {
        self.run?.zero_load_adhesion_force
    }

    /// F_a,max of eq. (14), N.
    pub fn ideal(&self) -> Option<f64> {
        let Governing { work_of_adhesion, effective_modulus, .. } = self.governing;
        work_of_adhesion.map(|work| ideal_adhesion_force(work, effective_modulus, self.length))
    }

    /// A force over F_a,max.
    pub fn share(&self, force: Option<f64>) -> Option<f64> {
        Some(force? / self.run?.ideal_adhesion_force.filter(|&ideal| ideal > 0.0)?)
    }

    /// Largest length in contact over L.
    pub fn contact_fraction(&self) -> Option<f64> {
        let lengths = self.legs.iter().flat_map(|leg| &leg.curve).map(|point| point.contact_length);
        lengths.reduce(f64::max).map(|longest| longest / self.length)
    }

    /// Point of the largest force on a loading leg.
    pub fn preload(&self) -> Option<CurvePoint> {
        let pressing = self.legs.iter().filter(|leg| leg.direction == Direction::Loading);
        pressing.map(|leg| leg.largest).max_by(|a, b| a.force.total_cmp(&b.force))
    }

    /// Regime of this loading.
    pub fn regime(&self) -> Option<Regime> {
        Regime::of_loading(&self.figures, self.zero_load(), self.run?.smooth_adhesion_force)
    }
}
