//! Premises of the model that a result does not meet, with the name of each premise.
//!
//! A result that is computed although a premise does not hold has the [`Warning`] of this premise.
//! Every report takes its words from [`Warning::sentence`] and [`Warning::remedy`], so all reports
//! print the same words.

mod conditions;
mod remedy;
mod sentence;

use crate::remedy::{Note, Wording};
use std::fmt::{Display, Formatter, Result};

/// A premise of the model that a result does not meet, with the values that show it. The model is a
/// rigid profile in contact with a row of independent springs (method of dimensionality reduction).
/// `Display` writes one line: which premise does not hold, what this means for the results, and
/// which step helps.
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
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
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
    /// The steps of the stepwise solver are too coarse for the loading. Either a stage that should
    /// end at a force passes this force by more than [`Warning::LARGEST_EXCESS_OF_FORCE`], or the
    /// whole loading has fewer than [`Warning::LEAST_STEPS`] steps between its deepest and its
    /// highest position.
    CoarseSteps {
        /// Length of a step in m.
        step: f64,
        /// Number of steps from the deepest to the highest place of the loading.
        steps: f64,
        /// Force in N at which a stage should end, and force at which it ends; `None` if each stage
        /// ends near its force.
        forces: Option<[f64; 2]>,
    },
    /// The loading rests on a half-space that does not relax, so that the rest changes nothing.
    RestWithoutRelaxation {
        /// Time in s for which the loading rests.
        seconds: f64,
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
    /// Kendall and Roberts (JKR) nor the rule of Hess, by which springs detach, applies.
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

/// Name and rms height of a surface.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct NamedHeight {
    /// Name of the surface.
    pub name: String,
    /// Rms height in m.
    pub rms_height: f64,
}

/// Polynomial that describes a trend of the heights of a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Trend {
    /// A plane, or a straight line.
    Tilt,
    /// A tilted paraboloid, or a parabola.
    Curvature,
}

/// A trend of the heights of a scan, and how much it contributes to them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct TrendOfScan {
    /// The trend.
    pub trend: Trend,
    /// Share by which the removal of the trend would reduce the mean squared height of the points.
    pub share: f64,
}

/// Name of a warning, its effect on the stated errors of a result, and its text.
impl Warning {
    /// Returns the name of the premise in `snake_case`, for counting warnings and for tables. The
    /// name is the same in every version.
    pub fn name(&self) -> &'static str {
        match self {
            Warning::ContactAtEnds { .. } => "contact_at_ends",
            Warning::EndsInContact { .. } => "ends_in_contact",
            Warning::FewSpringsInContact { .. } => "few_springs_in_contact",
            Warning::CoarseSteps { .. } => "coarse_steps",
            Warning::RestWithoutRelaxation { .. } => "rest_without_relaxation",
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

    /// Returns true if the warning means that the results belong to another body than the stated
    /// one. How large the errors of the results are is then unknown.
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

    /// Returns the text of the warning. `wording` returns the words of one interface, such as the
    /// command line, the explorer or Python, for the steps that help.
    pub fn in_words(&self, wording: Wording) -> String {
        let remedy = self.remedy_in_words(wording);
        match self {
            Warning::MeasuredFile { file, property } => {
                let property = property.in_words(wording);
                format!("{file}: {property}. {remedy}")
            }
            other => format!("{} {remedy}", other.sentence()),
        }
    }
}

impl Display for Warning {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        write!(formatter, "{} {}", self.sentence(), self.remedy())
    }
}
