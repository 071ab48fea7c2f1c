//! Sentences that state which premise of the model does not hold.

use crate::quantity::{format_quantity, format_rounded};
use crate::warning::Warning;

impl Warning {
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
                 {}: the bodies are not pulled off, so there is no pull-off force F_a, no regime \
                 and no dissipated energy.",
                format_quantity(*force, "N")
            ),
            Warning::EndsInContact { further: None } => {
                "The loading ends in contact before the bodies are pulled off, so there is no \
                 pull-off force F_a, no regime and no dissipated energy."
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
            Warning::RestWithoutRelaxation { seconds } => format!(
                "The loading rests for {}, but the body is elastic: the rest changes nothing.",
                format_rounded(*seconds, 3, "s")
            ),
            Warning::FewSpringsPerWave { springs } => format!(
                "The shortest wave has {} springs, fewer than {}: the pull-off force of a rough \
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

    /// Returns the sentence of a warning about the measurement of a surface; an empty text for any
    /// other warning.
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
}

fn metres(value: f64) -> String {
    format_quantity(value, "m")
}

/// Returns in words how many times a wave fits on a length: `once`, `2.5 times`.
fn times(waves: f64) -> String {
    if waves == 1.0 {
        "once".to_owned()
    } else {
        format!("{} times", format_rounded(waves, 2, "1"))
    }
}
