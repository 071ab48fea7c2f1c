//! Limits of the premises of the model, and the conditions under which a result has a warning.

use crate::warning::{NamedHeight, TrendOfScan, Warning};

/// Limits and conditions of the warnings.
impl Warning {
    /// Smallest number of springs in contact with which a force is accurate.
    pub const LEAST_SPRINGS_IN_CONTACT: u64 = 20;

    /// Largest relative error of the force at the end of a stage for which the steps of the
    /// stepwise solver count as fine. The error is the difference between the reached force and the
    /// target force, divided by the target force.
    pub const LARGEST_EXCESS_OF_FORCE: f64 = 0.01;

    /// Smallest number of steps of the stepwise solver between the deepest and the highest position
    /// of the body in a loading.
    pub const LEAST_STEPS: f64 = 20.0;

    /// Smallest number of springs on the shortest wave. With this number the pull-off force of a
    /// rough profile has an error of about one per cent (docs/accuracy.md).
    pub const LEAST_SPRINGS_PER_WAVE: u64 = 4;

    /// Largest relative change by which a wavelength may be rounded to a whole part of the length
    /// without a warning.
    pub const LARGEST_CHANGE_OF_WAVE: f64 = 0.01;

    /// Largest relative difference, without a warning, between the rms height of a profile and the
    /// rms height of a longer scan.
    pub const LARGEST_CHANGE_OF_HEIGHT: f64 = 0.01;

    /// Largest ratio of the length of a profile to the length of the scan for which there is no
    /// warning that long waves are missing. Up to this ratio the scan lacks only few waves of the
    /// profile.
    pub const LONGEST_PROFILE_OF_SCAN: f64 = 1.1;

    /// Smallest number of the longest waves on the length of a nominally flat body for which the
    /// results of different random profiles are similar (docs/learn.md).
    pub const LEAST_LONG_WAVES: f64 = 4.0;

    /// Largest rms gradient of the roughness, and largest slope of the form of the body, that count
    /// as small. Linear elasticity assumes small slopes.
    pub const LARGEST_GRADIENT: f64 = 1.0;

    /// Tabor number below which neither the theory of Johnson, Kendall and Roberts (JKR) nor the
    /// rule of Hess applies.
    pub const LEAST_TABOR_NUMBER: f64 = 1.0;

    /// Tabor number below which attraction of finite range dissipates less energy than the model
    /// computes.
    pub const JKR_TABOR_NUMBER: f64 = 5.0;

    /// Number of measured profiles from which on the rms height, gradient and curvature are as
    /// accurate as those of a map.
    pub const MANY_PROFILES: u64 = 100;

    /// Share of long waves in the mean squared height of a scan above which the rms height depends
    /// on the length of the scan. Long waves are longer than a quarter of the scan.
    pub const MANY_LONG_WAVES: f64 = 0.3;

    /// Share of long waves in the mean squared height of a scan above which these waves probably
    /// come from the form of the body or from a bow of the scanner. Long waves are longer than a
    /// quarter of the scan.
    pub const FORM_OF_SCAN: f64 = 0.9;

    /// Share of the power of the long waves of a scan. If the removal of a trend reduces this power
    /// by more than this share, a warning advises to remove the trend.
    pub const MOST_OF_LONG_WAVES: f64 = 0.5;

    /// Bound of the step between opposite ends of a periodic surface, divided by the largest step
    /// between neighbouring points inside the surface. Above this ratio, the ends do not meet. On a
    /// truly periodic surface the two steps are of about the same size.
    pub const LARGEST_STEP_OF_ENDS: f64 = 2.0;

    /// Ratio of the rms gradients of parts of one surface above which a warning reports the
    /// difference.
    pub const LARGEST_RATIO_OF_PARTS: f64 = 1.2;

    /// Ratio of the rms heights or rms gradients of several surfaces above which a warning reports
    /// the difference.
    pub const LARGEST_RATIO_OF_SURFACES: f64 = 1.3;

    /// Largest absolute skewness of heights that count as nearly normal.
    pub const LARGEST_SKEWNESS: f64 = 1.0;

    /// Smallest and largest kurtosis of heights that count as nearly normal.
    pub const KURTOSIS: [f64; 2] = [1.5, 6.0];

    /// Smallest length of a scan in m for which the unit of lengths is probably wrong.
    pub const IMPROBABLE_LENGTH: f64 = 1.0;

    /// Rms height of a surface in m above which the unit of heights is probably wrong.
    pub const IMPROBABLE_HEIGHT: f64 = 1e-3;

    /// Bound for tables of forms that are longer than any measured body: the largest radius of the
    /// table, divided by the length of the profile. Above this ratio, the unit of the table is
    /// probably wrong.
    pub const LARGEST_REACH_OF_FORM: f64 = 100.0;

    /// Largest ratio of the rms heights of two surfaces that can be samples of one roughness.
    pub const LARGEST_RATIO_OF_HEIGHTS: f64 = 30.0;

    /// Smallest and largest factor by which the adhesion near the limit of adhesion varies between
    /// single measured profiles (docs/surface-estimate.md).
    pub const BOUNDARY_FACTORS: [f64; 2] = [1.4, 3.3];

    /// Ratio λ²/(AR) of a wavy sphere with the wavelength λ, the amplitude A of the waves and the
    /// radius R. Below this ratio, the equivalent profile falls somewhere with the distance from
    /// the axis.
    pub const LEAST_WAVE_RATIO: f64 = 12.391;

    /// Returns a warning if a body has few springs in contact. `springs` is the largest number of
    /// springs in contact during the loading. A body that never touches has zero springs and gets
    /// no warning.
    pub fn of_springs_in_contact(springs: u64) -> Option<Warning> {
        let is_few = (1..Self::LEAST_SPRINGS_IN_CONTACT).contains(&springs);
        is_few.then_some(Warning::FewSpringsInContact { springs })
    }

    /// Returns a warning if the steps of the stepwise solver are too coarse. `step` is the length
    /// of a step in m, and `way` is the distance in m between the deepest and the highest position
    /// of the body in the loading. `forces` has an element for each stage that ends at a force: the
    /// target force, and the force at the end of the stage, both in N.
    pub fn of_steps(step: f64, way: f64, forces: &[[f64; 2]]) -> Option<Warning> {
        let excess = |[target, end]: &[f64; 2]| (end - target).abs() / target.abs();
        let farthest = forces
            .iter()
            .filter(|pair| excess(pair) > Self::LARGEST_EXCESS_OF_FORCE)
            .max_by(|one, other| excess(one).total_cmp(&excess(other)));
        let steps = way / step;
        let is_coarse = farthest.is_some() || steps < Self::LEAST_STEPS;
        is_coarse.then_some(Warning::CoarseSteps {
            step,
            steps,
            forces: farthest.copied(),
        })
    }

    /// Returns a warning if the shortest wave of the roughness has few springs. `springs` is the
    /// number of springs on this wave.
    pub fn of_springs_per_wave(springs: f64) -> Option<Warning> {
        let is_few = springs < Self::LEAST_SPRINGS_PER_WAVE as f64;
        is_few.then_some(Warning::FewSpringsPerWave { springs })
    }

    /// Returns a warning if the wavelengths that a profile uses differ from the stated wavelengths.
    /// Both arguments are the longest and the shortest wavelength in m.
    pub fn of_waves(stated: [f64; 2], used: [f64; 2]) -> Option<Warning> {
        let change = |stated: f64, used: f64| (used / stated - 1.0).abs();
        let largest = change(stated[0], used[0]).max(change(stated[1], used[1]));
        (largest > Self::LARGEST_CHANGE_OF_WAVE).then_some(Warning::RoundedWaves { stated, used })
    }

    /// Returns a warning if too few of the longest waves of a nominally flat random roughness fit
    /// on the profile. `waves` is the number of these waves on the length of the profile.
    pub fn of_long_waves(waves: f64) -> Option<Warning> {
        (waves < Self::LEAST_LONG_WAVES).then_some(Warning::FewLongWaves { waves })
    }

    /// Returns a warning if the slopes of a roughness are not small. `rms_gradient` is the rms
    /// gradient of the roughness. `is_measured` is true for a measured surface.
    pub fn of_gradient(rms_gradient: f64, is_measured: bool) -> Option<Warning> {
        let is_steep = rms_gradient > Self::LARGEST_GRADIENT;
        is_steep.then_some(Warning::SteepRoughness {
            rms_gradient,
            is_measured,
        })
    }

    /// Returns a warning if the form of a body is steep at the edge of the contact. `slope` is the
    /// slope of the form there.
    pub fn of_slope_of_form(slope: f64) -> Option<Warning> {
        (slope > Self::LARGEST_GRADIENT).then_some(Warning::SteepForm { slope })
    }

    /// Returns a warning if the range of the attraction is too long for the model. A small Tabor
    /// number means a long range.
    pub fn of_tabor_number(tabor_number: f64) -> Option<Warning> {
        if tabor_number < Self::LEAST_TABOR_NUMBER {
            return Some(Warning::LongRangedAttraction { tabor_number });
        }
        let has_finite_range = tabor_number < Self::JKR_TABOR_NUMBER;
        has_finite_range.then_some(Warning::FiniteRangedAttraction { tabor_number })
    }

    /// Returns a warning if a scan is longer than the profile, so that the profile has a smaller
    /// rms height than the surface. `scan` and `length` are the lengths of the scan and of the
    /// profile in m. `rms_heights` are the rms heights in m of the surface and of the profile.
    pub fn of_scan(scan: f64, length: f64, rms_heights: [f64; 2]) -> Option<Warning> {
        // A profile as long as the scan has the same waves as the scan.
        let is_longer = scan > length * (1.0 + 1e-9);
        let [surface, profile] = rms_heights;
        let has_other_height = (profile / surface - 1.0).abs() > Self::LARGEST_CHANGE_OF_HEIGHT;
        (is_longer && has_other_height).then_some(Warning::ScanLongerThanLength {
            scan,
            length,
            rms_heights,
        })
    }

    /// Returns a warning if a profile is longer than the scan of its surface, and if the missing
    /// long waves matter. `scan` and `length` are the lengths of the scan and of the profile in m.
    /// `share` is the share of waves longer than a quarter of the scan in the mean squared height.
    pub fn of_short_scan(scan: f64, length: f64, share: f64) -> Option<Warning> {
        let is_shorter = length > Self::LONGEST_PROFILE_OF_SCAN * scan;
        let lacks_waves = is_shorter && share > Self::MANY_LONG_WAVES;
        lacks_waves.then_some(Warning::ScanShorterThanLength {
            scan,
            length,
            share,
        })
    }

    /// Returns a warning if the waves of a wavy sphere are steep. `ratio` is λ²/(AR), with the
    /// wavelength λ, the amplitude A and the radius R of the sphere. `jkr_factor` is the factor by
    /// which the waves raise the pull-off force according to the theory of Johnson, Kendall and
    /// Roberts (JKR).
    pub fn of_wave_ratio(ratio: f64, jkr_factor: f64) -> Option<Warning> {
        (ratio < Self::LEAST_WAVE_RATIO).then_some(Warning::SteepWaves { ratio, jkr_factor })
    }

    /// Returns a warning if the rms heights of two surfaces differ too much for samples of the same
    /// roughness. The two surfaces are the one with the smallest and the one with the largest rms
    /// height.
    pub fn of_rms_heights(flattest: NamedHeight, roughest: NamedHeight) -> Option<Warning> {
        let ratio = roughest.rms_height / flattest.rms_height;
        (ratio > Self::LARGEST_RATIO_OF_HEIGHTS)
            .then_some(Warning::SurfacesFarApart { flattest, roughest })
    }

    /// Returns a warning if long waves contribute much of the mean squared height of a scan.
    /// `share` is their share, and `is_levelled` is true if the curvature of the heights was
    /// removed before. `trends` are the trends that were not removed, the simplest one first.
    pub fn of_long_waves_of_scan(
        share: f64,
        is_levelled: bool,
        trends: &[TrendOfScan],
    ) -> Option<Warning> {
        let is_most = |trend: &&TrendOfScan| trend.share > Self::MOST_OF_LONG_WAVES * share;
        let is_large = share > Self::MANY_LONG_WAVES;
        is_large.then(|| Warning::LongWavesOfScan {
            share,
            is_levelled,
            trend: trends.iter().find(is_most).copied(),
        })
    }

    /// Returns a warning if opposite ends of a surface that counts as periodic do not meet. `ratio`
    /// is the height of the step between the ends, divided by the largest step inside the surface.
    pub fn of_ends(ratio: f64) -> Option<Warning> {
        (ratio > Self::LARGEST_STEP_OF_ENDS).then_some(Warning::EndsDoNotMeet { ratio })
    }

    /// Returns a warning if the rms gradients of the parts of a surface differ by more than chance
    /// explains. `ratio` is the ratio of the largest to the smallest of these rms gradients.
    pub fn of_parts(ratio: f64) -> Option<Warning> {
        (ratio > Self::LARGEST_RATIO_OF_PARTS).then_some(Warning::PartsDiffer { ratio })
    }

    /// Returns a warning if the rms heights or rms gradients of several surfaces differ by more
    /// than chance explains. `ratio` is the ratio of the largest to the smallest of these values.
    pub fn of_surfaces(ratio: f64) -> Option<Warning> {
        (ratio > Self::LARGEST_RATIO_OF_SURFACES).then_some(Warning::SurfacesDiffer { ratio })
    }

    /// Returns a warning if the heights of a surface are far from normally distributed. `skewness`
    /// and `kurtosis` are those of the heights; for normally distributed heights they are 0 and 3.
    pub fn of_distribution(skewness: f64, kurtosis: f64) -> Option<Warning> {
        let [least, most] = Self::KURTOSIS;
        let is_normal =
            skewness.abs() <= Self::LARGEST_SKEWNESS && (least..=most).contains(&kurtosis);
        (!is_normal).then_some(Warning::HeightsNotNormal { skewness, kurtosis })
    }

    /// Returns a warning if the length or the rms height of a surface is too large for any
    /// instrument that measures roughness. `file` is the name of the file; both lengths are in m.
    pub fn of_lengths(file: &str, length: f64, rms_height: f64) -> Option<Warning> {
        let is_improbable =
            length >= Self::IMPROBABLE_LENGTH || rms_height > Self::IMPROBABLE_HEIGHT;
        is_improbable.then(|| Warning::ImprobableLengths {
            file: file.to_owned(),
            length,
            rms_height,
        })
    }

    /// Returns a warning if the table of a form reaches much farther than the profile and than any
    /// measured body. `file` is the name of the file. `reach` is the largest radius of the table
    /// and `length` the length of the profile, both in m.
    pub fn of_reach(file: &str, reach: f64, length: f64) -> Option<Warning> {
        let is_improbable =
            reach >= Self::IMPROBABLE_LENGTH && reach > Self::LARGEST_REACH_OF_FORM * length;
        is_improbable.then(|| Warning::ImprobableForm {
            file: file.to_owned(),
            reach,
            length,
        })
    }

    /// Returns a warning if the number of measured profiles is too small for an accurate rms
    /// height, gradient and curvature. `profiles` is this number.
    pub fn of_measured_profiles(profiles: u64) -> Option<Warning> {
        (profiles < Self::MANY_PROFILES).then_some(Warning::FewMeasuredProfiles { profiles })
    }
}
