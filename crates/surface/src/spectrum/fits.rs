//! Fits of spectra to the measured powers of all surfaces together. The module also computes two
//! changes of the results: with other heights at interpolated points, and with shorter waves than
//! the points resolve.

use super::isotropic::IsotropicSpectrum;
use super::isotropic_fit::fit_isotropic;
use super::last_wave::last_significant;
use super::likelihood::Model;
use super::no_maximum;
use super::nodes::{End, WaveRange};
use super::observation::Observation;
use super::options::AnalysisOptions;
use super::powers::Powers;
use super::self_affine_ends::fit_for_ends;
use super::self_affine_fit::SelfAffineFit;
use crate::error::{Place, SurfaceError, refused};
use crate::topography::surface::Topography;

/// If a spectrum ends before the last resolved wave, the self-affine fit leaves out this number of
/// waves before the end.
const BEFORE_END: f64 = 4.0;

/// Ratio of the last wave number of the surface to the last resolved wave number that is assumed to
/// estimate the influence of missing short waves.
const CONTINUED: f64 = 4.0;

/// Fits of several spectra to the same observations, over one range of wave numbers.
#[derive(Clone, Copy)]
pub(super) struct SpectrumFits {
    range: WaveRange,
    end: End,
    /// True if the fitted spectrum ends at a longer wave than the shortest resolved one, because
    /// shorter waves have no significant power.
    pub ends_inside: bool,
    /// Number of the observed scans if they are periodic ([`Powers::periodic_scans`]).
    periodic_scans: Option<f64>,
}

/// Largest changes of the results if the same surfaces are read with other interpolated heights.
#[derive(Default)]
pub(super) struct ReadingChanges {
    /// Magnitudes of the relative changes of the integrals ∫ q^p C2D dq over the spectrum C2D, for
    /// p = 1, 2, 3. The integrals give the mean square height, the elastic energy and the mean
    /// square gradient.
    pub integrals: [f64; 3],
    /// Magnitude of the change of the Hurst exponent.
    pub hurst: f64,
}

impl SpectrumFits {
    /// Prepares the fits: finds the range of wave numbers with significant power. `has_gaps` is
    /// true if heights are interpolated. `end` states whether the spectrum continues beyond this
    /// range. Returns an error if it continues to a wave number that the points already resolve.
    pub fn new(powers: &Powers, has_gaps: bool, end: End) -> Result<Self, SurfaceError> {
        let range = powers.range(|waves| last_significant(waves, has_gaps));
        let resolved = powers.range(|waves| waves.len());
        let last = range.last;
        if let End::Continues(to) = end
            && (to <= last || !to.is_finite())
        {
            let found = format!("the spectrum continues up to q = {to:e} rad/m");
            let allowed = format!("above the last resolved wave, q = {last:e} rad/m, and finite");
            return Err(refused(Place::File, found, allowed));
        }
        Ok(SpectrumFits {
            range,
            end,
            ends_inside: last < resolved.last,
            periodic_scans: powers.periodic_scans(),
        })
    }

    /// Returns the wave number in rad/m of the last wave with significant power.
    pub fn last_wave_number(&self) -> f64 {
        self.range.last
    }

    /// Fits an isotropic spectrum C2D to the observed powers. The fitted spectrum is given by its
    /// values at several wave numbers, the nodes.
    ///
    /// # Errors
    /// Returns an error if the fit does not succeed.
    pub fn isotropic(
        &self,
        observations: &[Observation],
    ) -> Result<IsotropicSpectrum, SurfaceError> {
        let model = Model::new(observations, self.range, self.end);
        fit_isotropic(&model, self.periodic_scans).ok_or_else(no_maximum)
    }

    /// Fits a self-affine spectrum to the observed powers. Returns `None` if the fit does not
    /// succeed.
    pub fn self_affine(&self, observations: &[Observation]) -> Option<SelfAffineFit> {
        // How the spectrum ends affects the powers of the last waves, so these waves are left out.
        let limit = if self.ends_inside {
            self.range.last - BEFORE_END * self.range.first
        } else {
            f64::INFINITY
        };
        let mut before_end = observations.to_vec();
        before_end.retain(|observation| observation.wave_number < limit);
        fit_for_ends(&before_end, self.range, self.end, self.ends_inside)
    }

    /// Repeats the fits with other heights at the interpolated points, or with other heights of a
    /// resampled profile. Returns the largest changes of the results. These changes show how
    /// uncertain the results are because of the interpolation.
    ///
    /// # Errors
    /// Returns an error if the changed heights cannot be analysed.
    pub fn changes_between_readings(
        &self,
        surfaces: &[Topography],
        options: &AnalysisOptions,
        isotropic: &IsotropicSpectrum,
        power_law: Option<SelfAffineFit>,
    ) -> Result<ReadingChanges, SurfaceError> {
        let mut largest = ReadingChanges::default();
        for quarters in 1..=other_readings(surfaces) {
            let powers = Powers::of_reading(surfaces, options, quarters)?;
            let observations = powers.observations(self.range.last);
            let isotropic_again = self.isotropic(&observations)?;
            let changes = isotropic.changes(&isotropic_again);
            for (largest, change) in largest.integrals.iter_mut().zip(changes) {
                *largest = largest.max(change.abs());
            }
            let power_law_again = self.self_affine(&observations);
            if let (Some(again), Some(before)) = (power_law_again, power_law) {
                let change = again.hurst.value - before.hurst.value;
                largest.hurst = largest.hurst.max(change.abs());
            }
        }
        Ok(largest)
    }

    /// Returns the relative changes of the integrals ∫ q^p C2D dq over the spectrum C2D, p = 1, 2,
    /// 3, if the surface has shorter waves than the points resolve. Of the change of the resolved
    /// waves and the change of all waves, the larger one is returned. All changes are infinite if a
    /// fit with shorter waves fails.
    pub fn missing_waves(
        &self,
        observations: &[Observation],
        isotropic: &IsotropicSpectrum,
    ) -> [f64; 3] {
        let last = self.range.last;
        let continued_fits = SpectrumFits {
            end: End::Continues(CONTINUED * last),
            ..*self
        };
        // If this fit fails, the influence of the missing waves is unknown.
        let Ok(continued) = continued_fits.isotropic(observations) else {
            return [f64::INFINITY; 3];
        };
        let mut resolved_part = continued.clone();
        resolved_part.nodes.end = last;

        let resolved_changes = isotropic.changes(&resolved_part);
        let all_changes = isotropic.changes(&continued);
        [0, 1, 2].map(|index| {
            let resolved_change = resolved_changes[index].abs();
            resolved_change.max(all_changes[index].abs())
        })
    }
}

/// Returns how many other readings of the same surfaces are used. Each has another argument
/// `quarters` of [`Topography::copied_heights`]. A resampled profile has only one.
fn other_readings(surfaces: &[Topography]) -> usize {
    if surfaces.iter().any(|surface| surface.interpolated() > 0) {
        3
    } else if surfaces.iter().any(Topography::is_resampled) {
        1
    } else {
        0
    }
}
