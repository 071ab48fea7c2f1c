//! Analysis of measured surfaces: statistics of the points, spectra, the equivalent line, and the
//! limits within which these results are valid.

use super::differences::Differences;
use super::fits::SpectrumFits;
use super::isotropic::IsotropicSpectrum;
use super::levelled::LevelledSurface;
use super::moments::{LineMoments, line_moments};
use super::no_maximum;
use super::nodes::End;
use super::options::AnalysisOptions;
use super::parts::Blocks;
use super::periodogram::{Along, Bin};
use super::point_results::PointResults;
use super::powers::Powers;
use super::self_affine_fit::SelfAffineFit;
use super::statistics::PointStatistics;
use super::trends::{TrendSums, step_of_ends};
use crate::error::{Place, SurfaceError, refused};
use crate::topography::surface::{Detrend, Topography};
use asperity_data::TrendOfScan;
use std::f64::consts::TAU;

/// Result of [`analyse`]: statistics, spectra and equivalent line of measured surfaces.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Analysis {
    /// Statistics of the heights of the measured points.
    pub statistics: PointStatistics,
    /// Rms height in m of each surface after the polynomial chosen by [`AnalysisOptions::detrend`]
    /// was removed.
    pub rms_heights: Vec<f64>,
    /// Measured power spectra, averaged in bins of the wave number. There is one spectrum for each
    /// direction of the waves.
    pub spectra: Vec<(Along, Vec<Bin>)>,
    /// Isotropic spectrum fitted to the measured power spectra of all surfaces together.
    pub isotropic: IsotropicSpectrum,
    /// Self-affine spectrum fitted to the measured power spectra of all surfaces together. `None`
    /// if the fit does not converge or finds no Hurst exponent between 0 and 1.
    pub power_law: Option<SelfAffineFit>,
    /// Rms height, gradient and other moments of the [equivalent line](crate::EquivalentLine) of
    /// the surfaces.
    pub line: LineMoments,
    /// Reliability cut-off: the shortest wavelength in m that a tip of the radius R measures
    /// reliably. It is the smallest length over which no measured curvature is below −1/(2R), or
    /// half the length of a row if there is no such length. `None` if no tip radius is given, or if
    /// the tip resolves all waves.
    pub reliability_cutoff: Option<f64>,
    /// Number of the analysed surfaces that are profiles.
    pub profiles: u64,
    /// Number of the analysed surfaces that are maps.
    pub maps: u64,
    /// Length in m of the longest row of all surfaces.
    pub length: f64,
    /// Whether this analysis assumes that the surfaces have shorter waves than the points resolve
    /// ([`AnalysisOptions::end`]).
    pub end: End,
    /// True if the fitted spectrum ends at a longer wave than the shortest resolved wave. The
    /// reason is that shorter waves have no significant power.
    pub ends_inside: bool,
    /// True if the analysis leaves out short waves parallel to one axis of a map, because whole
    /// rows or columns are offset against each other.
    pub offsets: bool,
    /// Difference between the waves parallel to an axis of a map and the waves in neighbouring
    /// directions. It is the difference between the squared gradient of the waves parallel to the
    /// axis and the squared gradient that the neighbouring directions lead to expect, as a share of
    /// the squared gradient of the map. The largest difference of all maps is given. It is 0 if it
    /// is negligible, or if chance or offsets of whole rows or columns explain it.
    pub apart: f64,
    /// Distance in m by which the odd rows of a map are displaced against the even rows, in the
    /// direction of the rows. Such a displacement occurs in a file that alternates between trace
    /// and retrace. `None` if no map has a displacement.
    pub displaced: Option<f64>,
    /// True if the curvature of each surface was removed before the analysis, as
    /// [`AnalysisOptions::detrend`] can request.
    pub is_levelled: bool,
    /// Trends of the heights that were not removed, such as a tilt, the simplest one first. Each
    /// trend has the share by which its removal would reduce the mean squared height of the points.
    pub trends: Vec<TrendOfScan>,
    /// Ratio of the rms step between opposite ends of a periodic surface to the largest rms step
    /// between neighbouring rows or columns of points. The largest ratio of all surfaces and of
    /// both axes of a map is given; 0 if no surface is periodic.
    pub step_of_ends: f64,
    /// Ratio of the largest to the smallest rms gradient among the parts of a surface. The parts
    /// are the four quarters of a map or the two halves of a profile. The largest ratio of all
    /// surfaces is given; 1 if chance explains the differences between the parts.
    pub ratio_of_parts: f64,
    /// Ratio of the largest to the smallest rms height among several surfaces, or the same ratio of
    /// the rms gradients if it is larger. Surfaces with different numbers or distances of points
    /// have different waves. The rms values of such surfaces are therefore first divided by the
    /// values that the fitted spectrum has over the waves of the surface. The ratio is 1 for a
    /// single surface, and if chance explains the differences.
    pub ratio_of_surfaces: f64,
}

impl Analysis {
    /// Returns the share of long waves in the mean square height of the equivalent line. A wave is
    /// long if it is longer than a quarter of the longest row ([`Analysis::length`]).
    pub fn long_wave_share(&self) -> f64 {
        let [all_waves, _, _] = self.isotropic.integrals();
        let quarter = 4.0 * TAU / self.length;
        let shorter_waves = self.isotropic.integral(1, quarter).value;
        1.0 - shorter_waves / all_waves
    }
}

/// Analyses several surfaces of the same isotropic roughness together.
///
/// # Errors
/// Returns an error for a surface with uneven points, with too few points or without roughness.
/// Also returns an error if [`AnalysisOptions::end`] lets the spectrum continue to a wave number
/// that the points resolve already.
///
/// ```
/// use asperity_surface::{AnalysisOptions, Topography, analyse};
///
/// let height = |i: u32| {
///     (1..60)
///         .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
///         .sum::<f64>()
/// };
/// let heights: Vec<f64> = (0..256).map(|i| 3e-8 * height(i)).collect();
/// let found = analyse(
///     &[Topography::from_profile(&heights, 1e-6)?],
///     &AnalysisOptions::default(),
/// )?;
/// // κ² = E* h⟨∇z⟩/γ with its error, for E* = 1 MPa and γ = 50 mJ/m².
/// let kappa = found.line.height_gradient.scaled(1e6 / 0.05).root();
/// assert!(kappa.value > 0.0 && kappa.error > 0.0 && kappa.error < kappa.value);
/// // The power of the equivalent line is q C2D/2.
/// let [_, high] = found.isotropic.range();
/// assert_eq!(
///     found.isotropic.line(high),
///     0.5 * high * found.isotropic.c2d(high)
/// );
/// # Ok::<(), asperity_surface::SurfaceError>(())
/// ```
pub fn analyse(
    surfaces: &[Topography],
    options: &AnalysisOptions,
) -> Result<Analysis, SurfaceError> {
    if surfaces.is_empty() {
        return Err(refused(Place::File, "no surface", "at least one"));
    }
    let measured = measure(surfaces, options)?;
    let fitted = fit_spectrum(surfaces, options, &measured)?;
    let line = line_moments(std::slice::from_ref(&fitted.isotropic));
    if !is_finite(&line) {
        return Err(no_maximum());
    }
    let Measured { points, powers, .. } = measured;
    Ok(Analysis {
        statistics: points.sums.statistics(),
        rms_heights: points.rms_heights,
        spectra: powers.spectra(),
        power_law: fitted.power_law,
        isotropic: fitted.isotropic,
        line,
        reliability_cutoff: points.reliability_cutoff,
        profiles: powers.profiles.iter().map(|power| power.profiles).sum(),
        maps: powers.maps.len() as u64,
        length: points.longest.size,
        end: options.end,
        ends_inside: fitted.ends_inside,
        offsets: powers.maps.iter().any(|map| map.offsets),
        apart: fitted.apart,
        displaced: points.displaced,
        is_levelled: measured.is_levelled,
        trends: measured.trends.shares(),
        step_of_ends: measured.step_of_ends,
        ratio_of_parts: fitted.ratio_of_parts,
        ratio_of_surfaces: fitted.ratio_of_surfaces,
    })
}

/// Spectra that are fitted to measured surfaces, with all their errors.
struct FittedSpectrum {
    isotropic: IsotropicSpectrum,
    power_law: Option<SelfAffineFit>,
    /// As in [`Analysis::ends_inside`].
    ends_inside: bool,
    /// As in [`Analysis::apart`].
    apart: f64,
    /// As in [`Analysis::ratio_of_parts`].
    ratio_of_parts: f64,
    /// As in [`Analysis::ratio_of_surfaces`].
    ratio_of_surfaces: f64,
}

/// Fits the spectra, and adds to their errors the differences between readings, between parts of
/// the surfaces and between the surfaces.
fn fit_spectrum(
    surfaces: &[Topography],
    options: &AnalysisOptions,
    measured: &Measured,
) -> Result<FittedSpectrum, SurfaceError> {
    let powers = &measured.powers;
    let has_gaps = surfaces.iter().any(|surface| surface.interpolated() > 0);
    let fits = SpectrumFits::new(powers, has_gaps, options.end)?;
    let observations = powers.observations(fits.last_wave_number());
    let mut isotropic = fits.isotropic(&observations)?;
    let apart = powers.apart();
    // If the waves of a surface depend on their direction, its isotropic spectrum is not
    // self-affine.
    let mut power_law = if apart == 0.0 {
        fits.self_affine(&observations)
    } else {
        None
    };

    let changes = fits.changes_between_readings(surfaces, options, &isotropic, power_law)?;
    isotropic.add_method_errors(changes.integrals);
    isotropic.add_method_errors([apart; 3]);
    let unevenness = measured.differences.unevenness();
    let mut ratio_of_surfaces = unevenness.ratio_of_surfaces;
    if surfaces.len() > 1 {
        ratio_of_surfaces = ratio_of_surfaces.max(isotropic.ratio_of_kinds);
    }
    isotropic.add_method_errors(unevenness.errors);
    if let Some(fit) = &mut power_law {
        fit.hurst.error = fit.hurst.error.hypot(changes.hurst);
    }
    if options.end == End::Ends {
        if !fits.ends_inside {
            isotropic.missing = fits.missing_waves(&observations, &isotropic);
        }
        // If the median of each row was subtracted, a part of the rms height of the points is
        // missing, so this height cannot be compared with the spectrum.
        let has_height = !surfaces.iter().any(|surface| surface.aligned);
        measured.points.check_identities(&mut isotropic, has_height);
    }
    Ok(FittedSpectrum {
        isotropic,
        power_law,
        ends_inside: fits.ends_inside,
        apart,
        ratio_of_parts: unevenness.ratio_of_parts,
        ratio_of_surfaces,
    })
}

/// Results that are computed from the surfaces without fitting a spectrum.
#[derive(Default)]
struct Measured {
    points: PointResults,
    powers: Powers,
    differences: Differences,
    /// True if the curvature of each surface was removed before the analysis.
    is_levelled: bool,
    trends: TrendSums,
    /// Largest ratio of the step between opposite ends to the largest step inside
    /// ([`step_of_ends`]), of all periodic surfaces.
    step_of_ends: f64,
}

fn measure(surfaces: &[Topography], options: &AnalysisOptions) -> Result<Measured, SurfaceError> {
    let mut measured = Measured {
        is_levelled: true,
        ..Measured::default()
    };
    for (index, surface) in surfaces.iter().enumerate() {
        let levelled = LevelledSurface::new(index, surface, options, 0)?;
        let within = |error: SurfaceError| error.within(|place| Place::Surface(index, place));
        levelled.check_rough(surface).map_err(within)?;
        measured.is_levelled &= levelled.removed == Detrend::Curvature;
        measured.trends.add(&levelled)?;
        if !levelled.windowed {
            let step = step_of_ends(&levelled.heights, levelled.columns);
            measured.step_of_ends = measured.step_of_ends.max(step);
        }
        measured.points.add(&levelled, options.tip_radius);
        let blocks = Blocks::new(&levelled)?;
        let spread = blocks.spread();
        let weights = blocks.weights(&spread);
        measured.powers.add(&levelled, &weights).map_err(within)?;
        measured.differences.add(&levelled, spread);
    }
    Ok(measured)
}

fn is_finite(line: &LineMoments) -> bool {
    let moments = [line.rms_height, line.rms_gradient, line.energy_per_modulus];
    moments
        .iter()
        .all(|moment| moment.value.is_finite() && moment.error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(height: impl Fn(f64) -> f64) -> Topography {
        let heights: Vec<f64> = (0..256)
            .map(|index| 1e-8 * height(f64::from(index)))
            .collect();
        Topography::from_profile(&heights, 1e-6).unwrap()
    }

    #[test]
    fn an_error_names_the_surface_with_the_fault() {
        let rough = profile(|place| (place * place).sin());
        let straight = profile(|place| place);
        let options = AnalysisOptions::default();
        let error = analyse(&[rough, straight], &options).unwrap_err();
        assert_eq!(error.surface(), Some(1), "{error}");
    }

    #[test]
    fn a_spectrum_continues_up_to_a_finite_wave_number() {
        let rough = profile(|place| (place * place).sin());
        for to in [f64::INFINITY, f64::NAN, f64::NEG_INFINITY, 0.0] {
            let options = AnalysisOptions {
                end: End::Continues(to),
                ..AnalysisOptions::default()
            };
            let error = analyse(std::slice::from_ref(&rough), &options).unwrap_err();
            assert!(error.to_string().contains("and finite"), "{error}");
        }
    }
}
