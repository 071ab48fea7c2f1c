//! Analysis of measured surfaces: statistics of the points, spectra, equivalent line, and the
//! limits of all three.

use super::fit::{Model, SelfAffineFit, fit_power_law};
use super::interlaced;
use super::isotropic::{End, IsotropicSpectrum, LineMoments, Nodes, line_moments};
use super::no_maximum;
use super::observation::{self, Observation};
use super::periodogram::{Along, Bin, MapPower, ProfilePower, bins, square};
use super::statistics::{PointStatistics, Sums, reliability_cutoff};
use crate::error::{Place, SurfaceError, refused};
use crate::topography::surface::{Detrend, Topography};
use std::f64::consts::{PI, TAU};

/// Smallest allowed number of points along a row and of rows of a map.
const LEAST_POINTS: usize = 32;

/// Share of the squared gradient that waves beyond the end of the spectrum may have.
const NEGLIGIBLE: f64 = 1e-4;

/// The last 1/`FLOOR` of the waves give the noise floor of interpolated points. `CHANCE` is the
/// share of the floor that is attributed to chance.
const FLOOR: usize = 8;
const CHANCE: f64 = 0.25;

/// Largest ratio of the power beyond the end of the spectrum to the power of as many waves before
/// it.
const DROP: f64 = 0.03;

/// Smallest ratio of length to width of a map whose longest waves are taken from its rows alone.
const NARROW: f64 = 2.0;

/// Number of waves before an end inside the scan that the self-affine fit leaves out.
const BEFORE_END: f64 = 4.0;

/// Relative difference within which lengths of two scans, or their distances between points, count
/// as equal.
const SAME: f64 = 1e-6;

/// Largest ratio of the wave number up to which a spectrum may be continued to the last resolved
/// wave number.
const CONTINUED: f64 = 4.0;

/// Options of the analysis of measured surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnalysisOptions {
    /// Polynomial removed before the analysis. `Option::None` means the polynomial that the file of
    /// the surface states. If the file states no polynomial, it means [`Detrend::Tilt`], or
    /// [`Detrend::Mean`] for a periodic surface.
    pub detrend: Option<Detrend>,
    /// True for a surface that continues periodically at its borders. The analysis then uses no
    /// window function.
    pub periodic: bool,
    /// Assumption on waves shorter than the shortest wave that the points resolve: whether the
    /// surface has such waves.
    pub end: End,
    /// Radius in m of the tip that measured the surface.
    pub tip_radius: Option<f64>,
}

/// Result of [`analyse`]: statistics, spectra and equivalent line of measured surfaces.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Analysis {
    /// Statistics of the heights of the measured points.
    pub statistics: PointStatistics,
    /// Rms height in m of each surface, after removal of the polynomial of
    /// [`AnalysisOptions::detrend`].
    pub rms_heights: Vec<f64>,
    /// Measured power spectra for each direction of the waves, averaged in bins of the wave number.
    pub spectra: Vec<(Along, Vec<Bin>)>,
    /// Isotropic spectrum fitted to the measured power spectra of all surfaces together.
    pub isotropic: IsotropicSpectrum,
    /// Self-affine spectrum fitted to the same power spectra; `None` if the fit does not converge
    /// or finds no Hurst exponent between 0 and 1.
    pub power_law: Option<SelfAffineFit>,
    /// Moments of the [equivalent line](crate::EquivalentLine) of the surfaces, such as its rms
    /// height.
    pub line: LineMoments,
    /// Shortest wavelength in m that the tip of radius R resolves reliably: no curvature measured
    /// over this length is below −1/(2R). If no length fulfils this, it is half the length of a
    /// row. `None` if no tip radius is given, or if the tip resolves all waves.
    pub reliability_cutoff: Option<f64>,
    /// Number of the analysed surfaces that are profiles.
    pub profiles: u64,
    /// Number of the analysed surfaces that are maps.
    pub maps: u64,
    /// Length in m of the longest row of all surfaces.
    pub length: f64,
    /// [`AnalysisOptions::end`] of this analysis: whether waves continue beyond the last resolved
    /// one.
    pub end: End,
    /// True if the shortest waves that the points resolve have no significant power. The spectrum
    /// then ends before these waves.
    pub ends_inside: bool,
    /// True if the analysis leaves out the waves parallel to one axis of a map. The rows or columns
    /// of such a map are offset against each other, or were levelled one by one.
    pub offsets: bool,
    /// Largest difference between the squared gradient of waves parallel to an axis of a map and
    /// the value expected from waves in neighbouring directions. It is divided by the squared
    /// gradient of the map. The value is 0 if the difference may be chance.
    pub apart: f64,
    /// Distance in m by which odd rows of a map are displaced against even rows, as if they were
    /// from two scans. `None` if no map has such a displacement.
    pub displaced: Option<f64>,
}

/// Power spectra of all surfaces; profiles with equal points are summed.
#[derive(Default)]
struct Powers {
    profiles: Vec<ProfilePower>,
    maps: Vec<MapPower>,
    /// Power spectra along long and narrow maps. Each has the wave number in rad/m below which it
    /// replaces the spectrum of the map.
    strips: Vec<(ProfilePower, f64)>,
    /// Power spectra along the rows and along the columns of maps, for display.
    axes: [Vec<ProfilePower>; 2],
}

/// Analyses surfaces as samples of the same isotropic roughness.
///
/// # Errors
/// Returns an error for a surface with uneven points, with too few points or without roughness.
/// Also returns an error if [`AnalysisOptions::end`] is [`End::Continues`] with a wave number that
/// the points resolve already.
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
    let mut sums = Sums::default();
    // Only the longest scans hold the height of the line, and only the finest ones its gradient.
    let (mut of_longest, mut of_finest) = ((0.0, Sums::default()), (0.0, Sums::default()));
    let (mut reliability, mut displaced): (Option<f64>, Option<f64>) = (None, None);
    let mut rms_heights = Vec::new();
    let powers = Powers::of(surfaces, options, 0, |surface, heights, distances| {
        let columns = surface.columns;
        check_rough(&surface.heights, heights)?;
        sums.add(heights, columns, distances);
        let mut alone = Sums::default();
        alone.add(heights, columns, distances);
        rms_heights.push(alone.statistics().rms_height);
        let points = interlaced::displacement(heights, columns).map(|points| points * distances[0]);
        displaced = displaced.into_iter().chain(points).reduce(f64::max);
        let scan = columns as f64 * distances[0];
        for ((most, sums), size) in [
            (&mut of_longest, scan),
            (&mut of_finest, 1.0 / distances[0]),
        ] {
            if size > *most * (1.0 + SAME) {
                (*most, *sums) = (size, Sums::default());
            }
            if size >= *most * (1.0 - SAME) {
                sums.add(heights, columns, distances);
            }
        }
        if let Some(radius) = options.tip_radius {
            let cutoff = reliability_cutoff(heights, columns, distances[0], radius);
            reliability = reliability.into_iter().chain(cutoff).reduce(f64::max);
        }
        Ok(())
    })?;
    let has_gaps = surfaces.iter().any(|surface| surface.interpolated() > 0);
    let range = powers.range(|waves| last_significant(waves, has_gaps));
    let resolved = powers.range(|waves| waves.len())[1];
    let ends_inside = range[1] < resolved;
    let observations = powers.observations(range[1]);
    if let End::Continues(to) = options.end
        && (to <= range[1] || to.is_nan())
    {
        let found = format!("the spectrum continues up to q = {to:e} rad/m");
        let allowed = format!("above the last resolved wave, q = {:e} rad/m", range[1]);
        return Err(refused(Place::File, found, allowed));
    }
    let fitted = |observations: &[Observation], end: End| {
        Model::new(observations, range, end)
            .fit()
            .ok_or_else(no_maximum)
    };
    let self_affine = |observations: &[Observation], spectrum: &IsotropicSpectrum| {
        // The powers of the last waves depend on how the spectrum ends.
        let last = if ends_inside {
            range[1] - BEFORE_END * range[0]
        } else {
            f64::INFINITY
        };
        let before: Vec<_> = observations
            .iter()
            .filter(|one| one.wave_number < last)
            .cloned()
            .collect();
        fit_power_law(&Model::new(&before, range, options.end), spectrum)
    };
    let mut isotropic = fitted(&observations, options.end)?;
    let apart = powers.maps.iter().map(|map| map.apart).fold(0.0, f64::max);
    let mut power_law = self_affine(&observations, &isotropic).filter(|_| apart == 0.0);
    let mut largest = [0.0_f64; 4];
    let is_resampled = surfaces.iter().any(Topography::is_resampled);
    let places = 1..if has_gaps {
        4
    } else {
        1 + usize::from(is_resampled)
    };
    for quarters in places {
        let powers = Powers::of(surfaces, options, quarters, |_, _, _| Ok(()))?;
        let observations = powers.observations(range[1]);
        let again = fitted(&observations, options.end)?;
        let hurst = self_affine(&observations, &again).zip(power_law);
        let change = hurst.map_or(0.0, |(again, before)| {
            again.hurst.value - before.hurst.value
        });
        let changes = isotropic.changes(&again).into_iter().chain([change]);
        largest
            .iter_mut()
            .zip(changes)
            .for_each(|(largest, change)| *largest = largest.max(change.abs()));
    }
    if let Some(fit) = &mut power_law {
        fit.hurst.error = fit.hurst.error.hypot(largest[3]);
    }
    for (error, change) in isotropic.method.iter_mut().zip(largest) {
        *error = error.hypot(change).hypot(apart);
    }
    if options.end == End::Ends && !ends_inside {
        // Without such a fit nothing is known of the missing waves.
        let change = |longer: IsotropicSpectrum| {
            let within = Nodes {
                end: range[1],
                ..longer.nodes
            };
            let within = IsotropicSpectrum {
                nodes: within,
                ..longer.clone()
            };
            let (within, all) = (isotropic.changes(&within), isotropic.changes(&longer));
            [0, 1, 2].map(|index| within[index].abs().max(all[index].abs()))
        };
        let longer = fitted(&observations, End::Continues(CONTINUED * range[1]));
        isotropic.missing = longer.map_or([f64::INFINITY; 3], change);
    }
    if options.end == End::Ends {
        // Levelling takes height from the rows.
        let is_levelled = surfaces.iter().any(|surface| surface.aligned);
        let height = Some(of_longest.1.statistics().rms_height).filter(|_| !is_levelled);
        isotropic.check_identities(height, &of_finest.1.statistics());
    }
    let line = line_moments(std::slice::from_ref(&isotropic));
    let values = [line.rms_height, line.rms_gradient, line.energy_per_modulus];
    if values
        .iter()
        .any(|estimate| !(estimate.value.is_finite() && estimate.error.is_finite()))
    {
        return Err(no_maximum());
    }
    Ok(Analysis {
        statistics: sums.statistics(),
        rms_heights,
        spectra: powers.spectra(),
        power_law,
        isotropic,
        line,
        reliability_cutoff: reliability,
        profiles: powers.profiles.iter().map(|power| power.profiles).sum(),
        maps: powers.maps.len() as u64,
        length: of_longest.0,
        end: options.end,
        ends_inside,
        offsets: powers.maps.iter().any(|map| map.offsets),
        apart,
        displaced,
    })
}

/// Checks that the heights without the removed polynomial exceed the rounding errors of the
/// original heights.
fn check_rough(before: &[f64], after: &[f64]) -> Result<(), SurfaceError> {
    let largest = |heights: &[f64]| {
        heights
            .iter()
            .fold(0.0_f64, |largest, z| largest.max(z.abs()))
    };
    let left = largest(after);
    if left > 1e-12 * largest(before) && left > 1e-100 {
        return Ok(());
    }
    Err(refused(
        Place::File,
        "no roughness is left after detrending",
        "heights that differ",
    ))
}

impl Powers {
    /// Computes the power spectra of surfaces after removal of a polynomial. The heights are from
    /// [`Topography::copied_heights`]. `check` receives them with the distances between the points
    /// in m.
    fn of(
        surfaces: &[Topography],
        options: &AnalysisOptions,
        quarters: usize,
        mut check: impl FnMut(&Topography, &[f64], [f64; 2]) -> Result<(), SurfaceError>,
    ) -> Result<Powers, SurfaceError> {
        let mut powers = Powers::default();
        for (index, surface) in surfaces.iter().enumerate() {
            let within = |error: SurfaceError| error.within(|place| Place::Surface(index, place));
            let (columns, rows) = (surface.columns, surface.rows());
            let distances = surface.spacing().map_err(within)?;
            let points = if rows > 1 { columns.min(rows) } else { columns };
            if points < LEAST_POINTS {
                let fault = format!("{points} points along an axis");
                let allowed = format!("at least {LEAST_POINTS}");
                return Err(within(refused(Place::File, fault, allowed)));
            }
            let mut heights = surface.copied_heights(quarters).map_err(within)?;
            let periodic = options.periodic || surface.periodic;
            let default = if periodic {
                Detrend::Mean
            } else {
                Detrend::Tilt
            };
            options
                .detrend
                .or(surface.detrend)
                .unwrap_or(default)
                .remove(&mut heights, columns);
            check(surface, &heights, distances)?;
            powers.add(
                &heights,
                [columns, rows],
                distances,
                !periodic,
                surface.aligned,
            )?;
        }
        Ok(powers)
    }

    fn add(
        &mut self,
        heights: &[f64],
        points: [usize; 2],
        distances: [f64; 2],
        windowed: bool,
        aligned: bool,
    ) -> Result<(), SurfaceError> {
        let [columns, rows] = points;
        // Rows, or columns.
        let lines = |axis: usize| {
            let (first, step) = [(columns, 1), (1, columns)][axis];
            let line = move |line: usize| {
                heights
                    .iter()
                    .skip(line * first)
                    .step_by(step)
                    .take(points[axis])
            };
            (0..points[1 - axis]).map(move |number| line(number).copied())
        };
        if rows == 1 {
            return group(&mut self.profiles, columns, distances[0], windowed).add(lines(0));
        }
        for (axis, powers) in self.axes.iter_mut().enumerate() {
            group(powers, points[axis], distances[axis], windowed).add(lines(axis))?;
        }
        let map = MapPower::new(heights, columns, distances, windowed, aligned)?;
        // Columns of levelled rows have lost their long waves.
        let is_long = |axis: &usize| map.steps[1 - axis] >= NARROW * map.steps[*axis];
        let long = (0..if aligned { 1 } else { 2 }).find(|axis| windowed && is_long(axis));
        if let Some(axis) = long {
            let mut power = ProfilePower::new(points[axis], distances[axis], windowed);
            power.add(lines(axis))?;
            self.strips.push((power, observation::least_of_map(&map)));
        }
        self.maps.push(map);
        Ok(())
    }

    fn observations(&self, last: f64) -> Vec<Observation> {
        let profiles = self
            .profiles
            .iter()
            .flat_map(|power| observation::of_profiles(power, last));
        let strips = self.strips.iter().flat_map(|(power, end)| {
            // Neighbouring rows are nearly equal in waves that long: they count as one.
            let one = |of: Observation| Observation {
                waves: of.waves / power.profiles as f64,
                ..of
            };
            observation::of_profiles(power, *end).into_iter().map(one)
        });
        profiles
            .chain(strips)
            .chain(
                self.maps
                    .iter()
                    .flat_map(|power| observation::of_map(power, last)),
            )
            .collect()
    }

    /// Returns the range of wave numbers in rad/m, from wave 1 of the longest surface to the last
    /// wave of the finest surface, for profiles half a wave further. `last` returns the number of
    /// the last wave of a spectrum.
    fn range(&self, last: impl Fn(&[(f64, f64)]) -> usize) -> [f64; 2] {
        let profiles = self.profiles.iter().map(|power| {
            let count = last(&power.waves);
            [power.step, (count as f64 + 0.5) * power.step]
        });
        let maps = self.maps.iter().map(|map| {
            let step = map.steps[0].min(map.steps[1]);
            [
                step,
                last(&map.waves)
                    .checked_sub(1)
                    .map_or(step, |index| map.waves[index].0),
            ]
        });
        profiles
            .chain(maps)
            .fold([f64::INFINITY, 0.0], |[low, high], [a, b]| {
                [low.min(a), high.max(b)]
            })
    }

    fn spectra(&self) -> Vec<(Along, Vec<Bin>)> {
        let mean = |powers: &mut dyn Iterator<Item = &ProfilePower>| {
            bins(powers.flat_map(|power| {
                power
                    .waves
                    .iter()
                    .map(|(q, sum)| (*q, sum / power.profiles as f64, power.profiles))
            }))
        };
        let radial = self
            .maps
            .iter()
            .flat_map(|map| map.waves.iter().map(|(q, power)| (*q, q * power / PI, 1)));
        [
            (
                Along::X,
                mean(&mut self.profiles.iter().chain(&self.axes[0])),
            ),
            (Along::Y, mean(&mut self.axes[1].iter())),
            (Along::Radial, bins(radial)),
        ]
        .into_iter()
        .filter(|(_, bins)| !bins.is_empty())
        .collect()
    }
}

/// Finds the end of a spectrum of waves (wave number, power). Returns the number of waves after
/// which the rest has a negligible share of the squared gradient and far smaller power, or the
/// number of all waves if there is no end. With `has_floor` only the power above the level of the
/// last waves counts, because errors of single interpolated points add the same power to all waves.
fn last_significant(waves: &[(f64, f64)], has_floor: bool) -> usize {
    let sum = |waves: &[(f64, f64)]| waves.iter().map(square).sum::<f64>();
    let squares = |waves: &[(f64, f64)]| waves.iter().map(|(q, _)| q * q).sum::<f64>();
    let last = &waves[waves.len() - waves.len() / FLOOR..];
    let floor = if has_floor && !last.is_empty() {
        sum(last) / squares(last)
    } else {
        0.0
    };
    let negligible = NEGLIGIBLE * sum(waves) + CHANCE * floor * squares(waves);
    let (mut end, mut excess) = (waves.len(), 0.0);
    let excess_of = |wave: &(f64, f64)| square(wave) - floor * wave.0 * wave.0;
    while end > 1 && excess + excess_of(&waves[end - 1]) <= negligible {
        end -= 1;
        excess += excess_of(&waves[end]);
    }
    let rest = sum(&waves[end..]);
    let beyond = waves.len() - end;
    let before = beyond.min(end);
    let as_many = sum(&waves[end - before..end]);
    if rest * before as f64 <= DROP * as_many * beyond as f64 {
        end
    } else {
        waves.len()
    }
}

/// Returns the power spectrum of profiles with this number and spacing of points, a new one if
/// there is none yet.
fn group(
    powers: &mut Vec<ProfilePower>,
    points: usize,
    spacing: f64,
    windowed: bool,
) -> &mut ProfilePower {
    let same = |power: &ProfilePower| {
        power.points == points && (power.spacing / spacing - 1.0).abs() < SAME
    };
    let index = powers.iter().position(same).unwrap_or_else(|| {
        powers.push(ProfilePower::new(points, spacing, windowed));
        powers.len() - 1
    });
    &mut powers[index]
}

impl Analysis {
    /// Returns the share of the mean square height of the equivalent line that comes from waves
    /// longer than a quarter of [`Analysis::length`].
    pub fn long_wave_share(&self) -> f64 {
        let all = self.isotropic.integrals()[0];
        1.0 - self.isotropic.moment(1, 4.0 * TAU / self.length).0 / all
    }
}
