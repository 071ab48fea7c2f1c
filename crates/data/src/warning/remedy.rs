//! Sentences that state which step restores a premise of the model.

use crate::remedy::{Remedy, Wording};
use crate::warning::{Trend, TrendOfScan, Warning};

/// Beginning of the path of a field of a measured roughness.
const ROUGHNESS: &str = "roughness.";

impl Warning {
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
            Warning::RestWithoutRelaxation { .. } => {
                "With material.relaxation and a loading_speed the force falls during a rest."
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

    /// Returns the sentence of [`Self::remedy`], in which `wording` names the fields of a measured
    /// roughness. A scene has them as `roughness.unit` or, with a value, `roughness.detrend: Tilt`.
    pub(super) fn remedy_in_words(&self, wording: Wording) -> String {
        let remedy = self.remedy();
        let mut words = Vec::new();
        let mut rest = remedy.split(' ');
        while let Some(word) = rest.next() {
            let Some(field) = word.strip_prefix(ROUGHNESS) else {
                words.push(word.to_owned());
                continue;
            };
            let (name, value) = match field.strip_suffix(':') {
                Some(name) => (name, rest.next()),
                None => (field, None),
            };
            let last = value.unwrap_or(name);
            let ending = &last[last.trim_end_matches(['.', ',', ';']).len()..];
            let name = name.trim_end_matches(['.', ',', ';']).to_owned();
            let value = value.map(|value| value.trim_end_matches(['.', ',', ';']).to_owned());
            words.push(wording(&Remedy::RoughnessField(name, value)) + ending);
        }
        words.join(" ")
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
