//! Premises of the model that a result does not meet: the warnings, their conditions and their
//! words.
//!
//! A result that is computed although a premise does not hold has the [`Warning`] of this premise.
//! Every report takes its sentence from this module, so all reports print the same sentence.

use crate::quantity::{format_quantity, format_rounded};
use crate::remedy::{Note, Wording};
use std::fmt::{Display, Formatter, Result};

/// A premise of the model that a result does not meet, with the values that show it. `Display`
/// writes one line: which premise does not hold, what this means for the results, and which step
/// helps.
///
/// ```
/// use asperity_data::Warning;
///
/// assert_eq!(Warning::of_springs_per_wave(4.0), None);
/// let coarse = Warning::of_springs_per_wave(2.5).unwrap();
/// assert_eq!(coarse.name(), "few_springs_per_wave");
/// assert!(coarse.sentence().starts_with("The shortest wave has 2.5 springs, fewer than 4"));
/// assert!(coarse.to_string().ends_with(&coarse.remedy()));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// An outermost spring of the profile of a curved body was in contact during the loading.
    ContactAtEnds {
        /// Length of the profile in m.
        length: f64,
    },
    /// The last unloading ends in contact before its tensile force has reached its largest value.
    EndsInContact {
        /// Largest tensile force in N that a further unloading to separation would reach; `None` if
        /// it is not known.
        further: Option<f64>,
    },
    /// Too few springs were in contact: fewer than [`Warning::LEAST_SPRINGS_IN_CONTACT`] at every
    /// moment of the loading.
    FewSpringsInContact {
        /// Largest number of springs that were in contact at the same time.
        springs: u64,
    },
    /// The steps of the stepwise solver are too coarse for the loading. Either a stage that ends at
    /// a force passes it by more than [`Warning::LARGEST_EXCESS_OF_FORCE`], or the whole loading
    /// has fewer than [`Warning::LEAST_STEPS`] steps from its deepest to its highest place.
    CoarseSteps {
        /// Length of a step in m.
        step: f64,
        /// Number of steps from the deepest to the highest place of the loading.
        steps: f64,
        /// Force in N at which a stage should end, and force at which it ends; `None` if each stage
        /// ends near its force.
        forces: Option<[f64; 2]>,
    },
    /// The shortest wave of the roughness has fewer than [`Warning::LEAST_SPRINGS_PER_WAVE`]
    /// springs.
    FewSpringsPerWave {
        /// Number of springs on the shortest wave.
        springs: f64,
    },
    /// The profile uses another wavelength than the stated one, because its length must be a whole
    /// multiple of each wavelength. The difference exceeds [`Warning::LARGEST_CHANGE_OF_WAVE`].
    RoundedWaves {
        /// Longest and shortest wavelength in m as stated.
        stated: [f64; 2],
        /// Longest and shortest wavelength in m as used.
        used: [f64; 2],
    },
    /// Too few of the longest waves of a random roughness fit on the length of a nominally flat
    /// body: fewer than [`Warning::LEAST_LONG_WAVES`].
    FewLongWaves {
        /// Number of the longest waves that fit on the length of the profile.
        waves: f64,
    },
    /// The rms gradient of the roughness exceeds [`Warning::LARGEST_GRADIENT`].
    SteepRoughness {
        /// Rms gradient of the roughness.
        rms_gradient: f64,
        /// True for a measured surface, whose units may be wrong.
        is_measured: bool,
    },
    /// The slope of the form of the body at the edge of the contact exceeds
    /// [`Warning::LARGEST_GRADIENT`].
    SteepForm {
        /// Slope of the form at the edge of the contact.
        slope: f64,
    },
    /// The Tabor number is below [`Warning::LEAST_TABOR_NUMBER`]: neither the theory of Johnson,
    /// Kendall and Roberts (JKR) nor the rule of Hess applies.
    LongRangedAttraction {
        /// Tabor number.
        tabor_number: f64,
    },
    /// The Tabor number is below [`Warning::JKR_TABOR_NUMBER`]: the energy dissipated in a loop is
    /// overestimated.
    FiniteRangedAttraction {
        /// Tabor number.
        tabor_number: f64,
    },
    /// The heights of a file or an array are used as the equivalent profile, although nobody has
    /// stated that they are the heights of an equivalent profile.
    HeightsAsProfile,
    /// Heights that are used as the equivalent profile look like a cut through a round body: they
    /// are smooth and curved.
    CutLikeHeights {
        /// Radius in m of the sphere whose cut has these heights.
        radius: f64,
    },
    /// A measured surface is longer than the profile, so the profile lacks the longest waves of the
    /// surface. The rms heights of profile and surface differ by more than
    /// [`Warning::LARGEST_CHANGE_OF_HEIGHT`].
    ScanLongerThanLength {
        /// Length of the scan in m.
        scan: f64,
        /// Length of the profile in m.
        length: f64,
        /// Rms heights in m of the surface and of the profile.
        rms_heights: [f64; 2],
    },
    /// A measured surface is shorter than the profile, so the profile lacks its longest waves.
    /// Waves longer than a quarter of the scan contribute more than [`Warning::MANY_LONG_WAVES`] of
    /// the mean squared height.
    ScanShorterThanLength {
        /// Length of the scan in m.
        scan: f64,
        /// Length of the profile in m.
        length: f64,
        /// Share of the mean squared height that waves longer than a quarter of the scan
        /// contribute.
        share: f64,
    },
    /// The waves of a wavy sphere are so steep that the rule of Hess differs from the theory of
    /// Johnson, Kendall and Roberts (JKR).
    SteepWaves {
        /// Ratio λ²/(AR), where λ is the wavelength, A the amplitude and R the radius of the
        /// sphere.
        ratio: f64,
        /// Factor by which the waves raise the pull-off force of the sphere according to the theory
        /// of JKR.
        jkr_factor: f64,
    },
    /// The equivalent profile of a form given by a table falls somewhere, instead of rising
    /// everywhere from the axis outwards. The rule of Hess then differs from the theory of Johnson,
    /// Kendall and Roberts.
    FallingProfile {
        /// Distance from the axis in m at which the profile falls.
        from: f64,
    },
    /// The file of a measured surface has an unusual property.
    MeasuredFile {
        /// Name of the file.
        file: String,
        /// Description of the property, with its place in the file if the property has a place.
        property: Note,
    },
    /// Several measured surfaces of one roughness have very different rms heights.
    SurfacesFarApart {
        /// Name and rms height of the surface with the smallest rms height.
        flattest: NamedHeight,
        /// Name and rms height of the surface with the largest rms height.
        roughest: NamedHeight,
    },
    /// Odd rows of a map are displaced along the even rows. A scan that alternates its direction
    /// may cause this.
    DisplacedRows {
        /// Distance in m by which odd rows are displaced.
        distance: f64,
    },
    /// Waves longer than a quarter of the scan contribute much of the mean squared height.
    LongWavesOfScan {
        /// Share of the mean squared height that these long waves contribute.
        share: f64,
        /// True if the curvature of the heights was removed before this share was computed.
        is_levelled: bool,
        /// Trend of the heights whose removal takes off most of the power of these waves; `None` if
        /// there is none.
        trend: Option<TrendOfScan>,
    },
    /// A surface counts as periodic, but its opposite ends do not meet: the step between them is
    /// more than [`Warning::LARGEST_STEP_OF_ENDS`] times the largest step inside.
    EndsDoNotMeet {
        /// Ratio of the step between opposite ends to the largest step between neighbouring rows or
        /// columns of points.
        ratio: f64,
    },
    /// The parts of one measured surface differ in roughness by more than chance explains.
    PartsDiffer {
        /// Ratio of the largest to the smallest rms gradient of the parts.
        ratio: f64,
    },
    /// Several measured surfaces of one roughness differ more than chance explains.
    SurfacesDiffer {
        /// Ratio of the largest to the smallest rms height of the surfaces, or of their rms
        /// gradients.
        ratio: f64,
    },
    /// The heights of a measured surface are far from normally distributed.
    HeightsNotNormal {
        /// Skewness of the heights; 0 for normal heights.
        skewness: f64,
        /// Kurtosis of the heights; 3 for normal heights.
        kurtosis: f64,
    },
    /// A measured surface is longer or rougher than instruments for roughness can measure. The
    /// stated unit is therefore probably wrong.
    ImprobableLengths {
        /// Name of the file.
        file: String,
        /// Length of the scan in m.
        length: f64,
        /// Rms height in m.
        rms_height: f64,
    },
    /// The table of a form reaches to a radius that is far larger than the profile and than any
    /// measured body. The unit of the table is therefore probably wrong.
    ImprobableForm {
        /// Name of the file.
        file: String,
        /// Largest radius of the table in m.
        reach: f64,
        /// Length of the profile in m.
        length: f64,
    },
    /// The rms height, gradient and curvature of a measured surface come from few profiles: fewer
    /// than [`Warning::MANY_PROFILES`].
    FewMeasuredProfiles {
        /// Number of profiles.
        profiles: u64,
    },
    /// The spectrum of a measured surface continues to shorter waves than the scan resolves.
    UnresolvedSpectrum,
    /// Rows or columns of a map are offset in height against each other, or were levelled one by
    /// one.
    OffsetRows,
    /// Waves along one axis of a map are higher or lower than waves of the same length in
    /// neighbouring directions.
    WavesApart {
        /// Difference between the waves along the axis and the waves beside it, as a share of the
        /// squared gradient.
        share: f64,
    },
    /// Short waves of a scan may be artefacts of the tip.
    TipArtefacts {
        /// Wavelength in m below which waves are unreliable.
        wavelength: f64,
    },
}

/// Rms height of a surface that has a name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedHeight {
    /// Name of the surface.
    pub name: String,
    /// Rms height in m.
    pub rms_height: f64,
}

/// Polynomial that describes a trend of the heights of a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// A plane, or a straight line.
    Tilt,
    /// A tilted paraboloid, or a parabola.
    Curvature,
}

/// A trend of the heights of a scan, and how much it contributes to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrendOfScan {
    /// The trend.
    pub trend: Trend,
    /// Share of the mean squared height of the points that removal of the trend takes off.
    pub share: f64,
}

/// Limits and conditions of the warnings.
impl Warning {
    /// Smallest number of springs in contact with which a force is accurate.
    pub const LEAST_SPRINGS_IN_CONTACT: u64 = 20;

    /// Largest difference between the force at the end of a stage and the force where it should
    /// end, as a share of the latter, for which the steps of the stepwise solver count as fine.
    pub const LARGEST_EXCESS_OF_FORCE: f64 = 0.01;

    /// Smallest number of steps of the stepwise solver between the deepest and the highest place of
    /// a loading.
    pub const LEAST_STEPS: f64 = 20.0;

    /// Smallest number of springs on the shortest wave. With this number the adhesion force of a
    /// rough profile has an error of about one per cent (docs/accuracy.md).
    pub const LEAST_SPRINGS_PER_WAVE: u64 = 4;

    /// Largest relative change by which a wavelength may be rounded to a whole part of the length
    /// without a warning.
    pub const LARGEST_CHANGE_OF_WAVE: f64 = 0.01;

    /// Largest relative difference of the rms heights of a profile and of a longer scan for which
    /// there is no warning.
    pub const LARGEST_CHANGE_OF_HEIGHT: f64 = 0.01;

    /// Largest length of a profile, divided by the length of the scan, at which the scan lacks only
    /// few waves of the profile.
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

    /// Number of measured profiles from which the rms height, gradient and curvature are as
    /// accurate as from a map.
    pub const MANY_PROFILES: u64 = 100;

    /// Share of long waves in the mean squared height of a scan above which the rms height depends
    /// on the length of the scan. Long waves are longer than a quarter of the scan.
    pub const MANY_LONG_WAVES: f64 = 0.3;

    /// Share of long waves in the mean squared height of a scan above which these waves probably
    /// come from the form of the body or from a bow of the scanner. Long waves are longer than a
    /// quarter of the scan.
    pub const FORM_OF_SCAN: f64 = 0.9;

    /// Smallest share of the power of the long waves of a scan that the removal of a trend takes
    /// off if a warning advises it.
    pub const MOST_OF_LONG_WAVES: f64 = 0.5;

    /// Ratio of the step between opposite ends of a periodic surface to the largest step inside
    /// above which the ends do not meet. On a periodic surface both are alike.
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

    /// Length of a scan in m from which on the unit of lengths is probably wrong.
    pub const IMPROBABLE_LENGTH: f64 = 1.0;

    /// Rms height of a surface in m above which the unit of heights is probably wrong.
    pub const IMPROBABLE_HEIGHT: f64 = 1e-3;

    /// Largest radius of a form table, divided by the length of the profile, at which the unit of
    /// an improbably long table may be right.
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
    /// of a step in m, and `way` is the distance in m between the deepest and the highest place of
    /// the loading. `forces` has, for each stage that ends at a force, this force and the force at
    /// the end of the stage in N.
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

    /// Returns a warning if the shortest wave of the roughness has few springs.
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

    /// Returns a warning if the slopes of a roughness are not small. `is_measured` is true for a
    /// measured surface.
    pub fn of_gradient(rms_gradient: f64, is_measured: bool) -> Option<Warning> {
        let is_steep = rms_gradient > Self::LARGEST_GRADIENT;
        is_steep.then_some(Warning::SteepRoughness {
            rms_gradient,
            is_measured,
        })
    }

    /// Returns a warning if the form of a body is steep at the edge of the contact.
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
    /// rms height. `rms_heights` are the rms heights in m of the surface and of the profile.
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
    /// long waves matter. `share` is the share of waves longer than a quarter of the scan in the
    /// mean squared height.
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
    /// roughness.
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
    /// is the ratio of the step between them to the largest step inside.
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

    /// Returns a warning if the heights of a surface are far from normally distributed.
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
    /// height, gradient and curvature.
    pub fn of_measured_profiles(profiles: u64) -> Option<Warning> {
        (profiles < Self::MANY_PROFILES).then_some(Warning::FewMeasuredProfiles { profiles })
    }
}

/// Effects of the warnings on stated errors.
impl Warning {
    /// Returns true if the warning means that the results belong to another body than the stated
    /// one. The errors of the results are then unknown.
    pub fn leaves_errors_unknown(&self) -> bool {
        matches!(self, Warning::ContactAtEnds { .. })
    }

    /// Returns true if the warning means that forces may be wrong by more than the stated errors.
    /// The stated errors are those due to the number of springs, the sample of profiles and the
    /// measured spectrum.
    pub fn exceeds_errors(&self) -> bool {
        matches!(
            self,
            Warning::ContactAtEnds { .. }
                | Warning::CoarseSteps { .. }
                | Warning::SteepRoughness { .. }
                | Warning::SteepForm { .. }
                | Warning::LongRangedAttraction { .. }
                | Warning::HeightsAsProfile
                | Warning::CutLikeHeights { .. }
                | Warning::SteepWaves { .. }
                | Warning::FallingProfile { .. }
                | Warning::ImprobableLengths { .. }
                | Warning::ImprobableForm { .. }
        )
    }
}

/// Texts of the warnings.
impl Warning {
    /// Returns the name of the premise in `snake_case`, for counting warnings and for tables. The
    /// name is the same in every version.
    pub fn name(&self) -> &'static str {
        match self {
            Warning::ContactAtEnds { .. } => "contact_at_ends",
            Warning::EndsInContact { .. } => "ends_in_contact",
            Warning::FewSpringsInContact { .. } => "few_springs_in_contact",
            Warning::CoarseSteps { .. } => "coarse_steps",
            Warning::FewSpringsPerWave { .. } => "few_springs_per_wave",
            Warning::RoundedWaves { .. } => "rounded_waves",
            Warning::FewLongWaves { .. } => "few_long_waves",
            Warning::SteepRoughness { .. } => "steep_roughness",
            Warning::SteepForm { .. } => "steep_form",
            Warning::LongRangedAttraction { .. } => "long_ranged_attraction",
            Warning::FiniteRangedAttraction { .. } => "finite_ranged_attraction",
            Warning::HeightsAsProfile => "heights_as_profile",
            Warning::CutLikeHeights { .. } => "cut_like_heights",
            Warning::ScanLongerThanLength { .. } => "scan_longer_than_length",
            Warning::ScanShorterThanLength { .. } => "scan_shorter_than_length",
            Warning::SteepWaves { .. } => "steep_waves",
            Warning::FallingProfile { .. } => "falling_profile",
            Warning::MeasuredFile { .. } => "measured_file",
            Warning::SurfacesFarApart { .. } => "surfaces_far_apart",
            Warning::DisplacedRows { .. } => "displaced_rows",
            Warning::LongWavesOfScan { .. } => "long_waves_of_scan",
            Warning::EndsDoNotMeet { .. } => "ends_do_not_meet",
            Warning::PartsDiffer { .. } => "parts_differ",
            Warning::SurfacesDiffer { .. } => "surfaces_differ",
            Warning::HeightsNotNormal { .. } => "heights_not_normal",
            Warning::ImprobableLengths { .. } => "improbable_lengths",
            Warning::ImprobableForm { .. } => "improbable_form",
            Warning::FewMeasuredProfiles { .. } => "few_measured_profiles",
            Warning::UnresolvedSpectrum => "unresolved_spectrum",
            Warning::OffsetRows => "offset_rows",
            Warning::WavesApart { .. } => "waves_apart",
            Warning::TipArtefacts { .. } => "tip_artefacts",
        }
    }

    /// Returns the sentences of the warning, with its remedies in the words of an interface.
    pub fn in_words(&self, wording: Wording) -> String {
        match self {
            Warning::MeasuredFile { file, property } => {
                let property = property.in_words(wording);
                format!("{file}: {property}. {}", self.remedy())
            }
            other => other.to_string(),
        }
    }

    /// Returns a sentence that states which premise does not hold, and what this means for the
    /// results.
    pub fn sentence(&self) -> String {
        match self {
            Warning::ContactAtEnds { length } => format!(
                "The contact reaches an end of the profile of {}, beyond which there are no \
                 springs: what the body would touch there is missing in all forces and energies, \
                 and no stated error contains this.",
                metres(*length)
            ),
            Warning::EndsInContact {
                further: Some(force),
            } => format!(
                "The loading ends in contact, and further unloading would still pull with up to \
                 {}: the bodies are not pulled off, so there is no adhesion force F_a, no regime \
                 and no dissipated energy.",
                format_quantity(*force, "N")
            ),
            Warning::EndsInContact { further: None } => {
                "The loading ends in contact before the bodies are pulled off, so there is no \
                 adhesion force F_a, no regime and no dissipated energy."
                    .to_owned()
            }
            Warning::FewSpringsInContact { springs } => format!(
                "The largest number of springs in contact is {springs}, fewer than {}: forces and \
                 energies of so few springs may be wrong by several per cent or more.",
                Self::LEAST_SPRINGS_IN_CONTACT
            ),
            Warning::CoarseSteps {
                step,
                forces: Some([target, end]),
                ..
            } => format!(
                "The steps of {} of the stepwise solver are too coarse: a stage that should end at \
                 {} ends at {}, and forces and energies may be wrong by as much or more.",
                metres(*step),
                format_rounded(*target, 3, "N"),
                format_rounded(*end, 3, "N")
            ),
            Warning::CoarseSteps {
                step,
                steps,
                forces: None,
            } => format!(
                "The steps of {} of the stepwise solver are too coarse: the loading is {} of them \
                 deep, fewer than {}, and forces and energies may be wrong by several per cent or \
                 more.",
                metres(*step),
                format_rounded(*steps, 2, "1"),
                Self::LEAST_STEPS
            ),
            Warning::FewSpringsPerWave { springs } => format!(
                "The shortest wave has {} springs, fewer than {}: the adhesion force of a rough \
                 profile with two springs on its shortest wave is wrong by 2 % as a median, and by \
                 up to 12 %.",
                // The number is rounded down, so that a number slightly below the limit is not
                // shown as the limit.
                (10.0 * springs).floor() / 10.0,
                Self::LEAST_SPRINGS_PER_WAVE
            ),
            Warning::RoundedWaves { stated, used } => format!(
                "A random profile has a whole number of each wave on its length, so the waves from \
                 {} to {} that are stated are computed as waves from {} to {}.",
                metres(stated[0]),
                metres(stated[1]),
                metres(used[0]),
                metres(used[1])
            ),
            Warning::FewLongWaves { waves } => format!(
                "The longest waves of the roughness fit only {} on the length, fewer than {}: \
                 random profiles differ strongly in F_a, and the median of F_a/F_a,max depends on \
                 the length.",
                times(*waves),
                Self::LEAST_LONG_WAVES
            ),
            Warning::SteepRoughness { rms_gradient, .. } => format!(
                "The rms gradient {} is above {}: the theory of small slopes does not hold, and \
                 neither do forces and energies that follow from it.",
                format_quantity(*rms_gradient, "1"),
                Self::LARGEST_GRADIENT
            ),
            Warning::SteepForm { slope } => format!(
                "The slope of the form at the edge of the contact is {}, above {}: the contact is \
                 about as wide as the body is round, so the theory of small slopes does not hold, \
                 and neither do forces and energies that follow from it.",
                format_rounded(*slope, 2, "1"),
                Self::LARGEST_GRADIENT
            ),
            Warning::LongRangedAttraction { tabor_number } => format!(
                "JKR theory and the rule of Hess do not apply: the Tabor number {} is below {}, so \
                 that the attraction reaches beyond the contact. DMT theory applies, by which a \
                 loop dissipates next to nothing.",
                format_rounded(*tabor_number, 2, "1"),
                Self::LEAST_TABOR_NUMBER
            ),
            Warning::FiniteRangedAttraction { tabor_number } => format!(
                "The Tabor number {} is below {}, between the theories of JKR and DMT: attraction \
                 of finite range dissipates less energy in a loop than is computed here.",
                format_rounded(*tabor_number, 2, "1"),
                Self::JKR_TABOR_NUMBER
            ),
            Warning::HeightsAsProfile => {
                "The heights count as the equivalent profile, and nobody has stated that they are \
                 one: heights measured along a line on a rough surface have an rms gradient 29 % \
                 smaller than its equivalent profile, and adhere too well."
                    .to_owned()
            }
            Warning::CutLikeHeights { radius } => format!(
                "The heights count as the equivalent profile, and are smooth and curved like the \
                 cut x²/2R through a sphere of the radius R = {}: if they are this cut, forces are \
                 twice too large, because the equivalent profile of a sphere is x²/R.",
                format_rounded(*radius, 3, "m")
            ),
            Warning::ScanLongerThanLength {
                scan,
                length,
                rms_heights: [surface, profile],
            } => format!(
                "The scan of {} is longer than the profile of {}, which has no waves longer than \
                 itself: its rms height is {} instead of {}.",
                metres(*scan),
                metres(*length),
                format_rounded(*profile, 3, "m"),
                format_rounded(*surface, 3, "m")
            ),
            Warning::ScanShorterThanLength {
                scan,
                length,
                share,
            } => format!(
                "The profile of {} is longer than the scan of {}, which has no waves longer than \
                 itself, although waves longer than a quarter of it carry {:.0} % of the squared \
                 height: the profile is likely to lack the highest waves of the surface.",
                metres(*length),
                metres(*scan),
                100.0 * share
            ),
            Warning::SteepWaves { ratio, jkr_factor } => format!(
                "The waves of the sphere are steep, λ²/(AR) = {}, below {}: by the rule of Hess \
                 inner springs detach first; by the theory of JKR the edge recedes, and waves \
                 short against the contact pull off at {jkr_factor:.2} times the force of the \
                 sphere without waves.",
                format_quantity(*ratio, "1"),
                Self::LEAST_WAVE_RATIO
            ),
            Warning::FallingProfile { from } => format!(
                "The equivalent profile falls at {} from the axis: by the rule of Hess inner \
                 springs detach first; by the theory of JKR the edge recedes.",
                metres(*from)
            ),
            measured => measured.sentence_on_measurement(),
        }
    }

    /// Returns the sentence of a warning about the measurement of a surface.
    fn sentence_on_measurement(&self) -> String {
        match self {
            Warning::MeasuredFile { file, property } => format!("{file}: {property}."),
            Warning::SurfacesFarApart { flattest, roughest } => format!(
                "The rms heights of {} ({}) and {} ({}) are {}-fold apart: the unit of one of them \
                 may be wrong, or they are no samples of the same roughness.",
                flattest.name,
                metres(flattest.rms_height),
                roughest.name,
                metres(roughest.rms_height),
                format_quantity(roughest.rms_height / flattest.rms_height, "1")
            ),
            Warning::DisplacedRows { distance } => format!(
                "Odd rows are displaced by {} along even ones, as trace and retrace are: the \
                 gradient is too large.",
                metres(*distance)
            ),
            Warning::LongWavesOfScan { share, .. } => format!(
                "Waves longer than a quarter of the scan carry {:.0} % of the squared height: rms \
                 height and elastic energy depend on the length of the scan.",
                100.0 * share
            ),
            Warning::EndsDoNotMeet { ratio } => format!(
                "The surface counts as periodic, but its opposite ends do not meet: the step \
                 between them is {} times the largest step inside, and adds waves of all lengths.",
                format_rounded(*ratio, 2, "1")
            ),
            Warning::PartsDiffer { ratio } => format!(
                "Parts of the surface differ: their rms gradients are up to {}-fold apart, more \
                 than chance explains. The stated errors contain these differences.",
                format_rounded(*ratio, 3, "1")
            ),
            Warning::SurfacesDiffer { ratio } => format!(
                "The measured surfaces differ: their rms heights or gradients are up to {}-fold \
                 apart, more than chance explains. The stated errors contain these differences.",
                format_rounded(*ratio, 3, "1")
            ),
            Warning::HeightsNotNormal { skewness, kurtosis } => format!(
                "The heights are far from normal (skewness {}, kurtosis {}; normal heights: 0 and \
                 3), but the random profiles of the equivalent line have normal heights: forces \
                 computed on them leave out what rare summits or pits do.",
                format_rounded(*skewness, 2, "1"),
                format_rounded(*kurtosis, 2, "1")
            ),
            Warning::ImprobableLengths {
                file,
                length,
                rms_height,
            } => format!(
                "{file}: the scan is {} long and its rms height is {}, more than instruments for \
                 roughness measure: its unit is probably wrong.",
                metres(*length),
                metres(*rms_height)
            ),
            Warning::ImprobableForm {
                file,
                reach,
                length,
            } => format!(
                "{file}: the table of the form reaches to a radius of {}, far beyond the profile \
                 of {}: its unit is probably wrong.",
                metres(*reach),
                metres(*length)
            ),
            Warning::FewMeasuredProfiles { profiles } => {
                let [low, high] = Self::BOUNDARY_FACTORS;
                let plural = if *profiles == 1 { "" } else { "s" };
                format!(
                    "The surface is known from {profiles} profile{plural}, fewer than {}: adhesion \
                     near its boundary is known only within a factor of {low} to {high}.",
                    Self::MANY_PROFILES
                )
            }
            Warning::UnresolvedSpectrum => {
                "The spectrum does not end inside the scan: shorter waves may be missing, and in \
                 samples of points add to the longer ones."
                    .to_owned()
            }
            Warning::OffsetRows => {
                "Rows or columns are offset against each other, or were levelled one by one: waves \
                 along that axis are left out of the fit."
                    .to_owned()
            }
            Warning::WavesApart { share } => format!(
                "Waves along one axis differ from their neighbours by {:.0} % of the squared \
                 gradient: rows or columns are offset against each other, or the surface has a \
                 lay.",
                100.0 * share
            ),
            Warning::TipArtefacts { wavelength } => format!(
                "Waves shorter than {} may be artefacts of the tip.",
                format_rounded(*wavelength, 3, "m")
            ),
            _ => String::new(),
        }
    }

    /// Returns a sentence that states which step helps, with the names of the fields of a scene.
    pub fn remedy(&self) -> String {
        if let Warning::LongWavesOfScan {
            trend: Some(trend), ..
        } = self
        {
            return trend.remedy();
        }
        let remedy = match self {
            Warning::ContactAtEnds { .. } => {
                "A larger length helps, with numerics.points in proportion, until the contact ends \
                 inside the profile."
            }
            Warning::EndsInContact { .. } => {
                "The stage ToSeparation at the end of loading pulls the bodies off."
            }
            Warning::FewSpringsInContact { .. } => {
                "More numerics.points help, or a length that is little larger than the contact."
            }
            Warning::CoarseSteps { .. } => {
                "A smaller numerics.solver.step helps, or numerics.solver: Exact, which has no \
                 steps."
            }
            Warning::FewSpringsPerWave { .. } => {
                "More numerics.points help, or a longer shortest wave."
            }
            Warning::RoundedWaves { .. } => {
                "A length that is a multiple of both wavelengths, or roughness.modes, states waves \
                 that are used unchanged."
            }
            Warning::FewLongWaves { .. } => {
                "The length is the width of the real contact; if the contact is so small, report \
                 median and quartiles of many random profiles."
            }
            Warning::SteepRoughness {
                is_measured: false, ..
            } => {
                "A smaller roughness.rms_height or rms_gradient, or a longer shortest wave, has \
                 smaller slopes."
            }
            Warning::SteepRoughness {
                is_measured: true, ..
            } => {
                "If the unit of positions or of heights is wrong, roughness.unit and \
                 roughness.height_unit state it."
            }
            Warning::SteepForm { .. } => {
                "A smaller load, a larger radius or a flatter form has a smaller slope there."
            }
            Warning::LongRangedAttraction { .. } => {
                "Of the results only the force of contact without adhesion is left; a shorter \
                 adhesion.range raises the number."
            }
            Warning::FiniteRangedAttraction { .. } => {
                "The dissipated energy is an upper bound; adhesion.range states the range of the \
                 attraction."
            }
            Warning::HeightsAsProfile => {
                "A measured surface without roughness.as_line, or its spectrum, gives random \
                 profiles that are equivalent to the surface."
            }
            Warning::CutLikeHeights { .. } => {
                "A form, such as Paraboloid, is transformed to its equivalent profile."
            }
            Warning::ScanLongerThanLength { .. } => {
                "A length of at least the scan has all waves; a shorter one is right only if the \
                 contact is that small."
            }
            Warning::ScanShorterThanLength { .. } => {
                "A scan as long as the profile has these waves; a length of the scan is right only \
                 if the contact is that small."
            }
            Warning::SteepWaves { .. } => {
                "A smaller form.amplitude, or a longer form.wavelength, has waves that are not \
                 steep."
            }
            Warning::FallingProfile { .. } => {
                "A smaller length ends where the equivalent profile still rises."
            }
            Warning::MeasuredFile { .. } => "These points of the file need a look.",
            Warning::SurfacesFarApart { .. } => {
                "roughness.unit and roughness.height_unit state the units of a file."
            }
            Warning::DisplacedRows { .. } => "Rows of one direction alone are not displaced.",
            Warning::LongWavesOfScan {
                share,
                is_levelled: false,
                ..
            } if *share > Self::FORM_OF_SCAN => {
                "Where they are the form of a curved body or a bow of the scanner, \
                 roughness.detrend: Curvature removes it."
            }
            Warning::LongWavesOfScan { .. } => {
                "A longer scan, or several, shows how the rms height depends on the length."
            }
            Warning::EndsDoNotMeet { .. } => {
                "A surface that does not repeat itself is analysed without roughness.periodic; if \
                 it repeats itself apart from a tilt, roughness.detrend: Tilt removes the tilt."
            }
            Warning::PartsDiffer { .. } => {
                "More scans at other places show the mean of the surface; a scan of one part alone \
                 describes that part."
            }
            Warning::SurfacesDiffer { .. } => {
                "If they belong to different surfaces, analyse each one by itself; if units are \
                 wrong, roughness.unit and roughness.height_unit state them."
            }
            Warning::HeightsNotNormal { .. } => {
                "What single summits do is computed with a form, such as Paraboloid, that has the \
                 radius of a summit."
            }
            Warning::ImprobableLengths { .. } => {
                "roughness.unit and roughness.height_unit state units where the file has none; a \
                 file that states wrong ones, such as an X3P in µm in place of m, has to be \
                 corrected, or its heights saved as text or .npy."
            }
            Warning::ImprobableForm { .. } => {
                "form.unit states the unit of radii and depths where the file has none."
            }
            Warning::FewMeasuredProfiles { .. } => "100 profiles or a map are better.",
            Warning::UnresolvedSpectrum => "roughness.continue_to continues it as a power law.",
            Warning::OffsetRows => "Rows that are not levelled one by one keep these waves.",
            Warning::WavesApart { .. } => {
                "Where rows are offset, roughness.align_rows subtracts the median of each row; or \
                 choose one row by roughness.row."
            }
            Warning::TipArtefacts { .. } => "A sharper tip resolves these waves.",
        };
        remedy.to_owned()
    }
}

impl TrendOfScan {
    /// Returns a sentence that states how the trend is removed.
    fn remedy(&self) -> String {
        let share = 100.0 * self.share;
        match self.trend {
            Trend::Tilt => format!(
                "A tilt makes up {share:.0} % of the squared height of the points: \
                 roughness.detrend: Tilt removes it."
            ),
            Trend::Curvature => format!(
                "A curvature makes up {share:.0} % of the squared height of the points: where it \
                 is the form of a body or a bow of the scanner, roughness.detrend: Curvature \
                 removes it."
            ),
        }
    }
}

impl Display for Warning {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        write!(formatter, "{} {}", self.sentence(), self.remedy())
    }
}

/// A warning is written as its text.
#[cfg(feature = "files")]
impl serde::Serialize for Warning {
    fn serialize<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

fn metres(value: f64) -> String {
    format_quantity(value, "m")
}

/// Writes how many times a wave fits: `once`, `2.5 times`.
fn times(waves: f64) -> String {
    if waves == 1.0 {
        "once".to_owned()
    } else {
        format!("{} times", format_rounded(waves, 2, "1"))
    }
}
