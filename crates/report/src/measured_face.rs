//! Measured surfaces of one body, which are analysed together as samples of the same roughness,
//! with facts about their files and warnings about the analysis.

use asperity_data::{
    NamedHeight, Note, Warning, format_quantity, grouped, path_name, plural, printable,
};
use asperity_surface::spectra::End;
use asperity_surface::{Analysis, Topography};
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

/// Facts about a measured surface and its file. The lists `points`, `lengths` and `cropped` have
/// one number for a profile, and two for a map: along a row, then along a column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceFile {
    /// Path of the file of the surface.
    #[serde(rename = "file", serialize_with = "in_unicode")]
    pub path: PathBuf,
    /// Name of the measurement, if the file contains several; otherwise empty.
    #[serde(rename = "measurement", skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Name of the file format, such as `SDF`.
    pub format: &'static str,
    /// Number of points in a row and, for a map, also the number of rows.
    pub points: Vec<usize>,
    /// Length of a row in m and, for a map, also the length of a column in m. A length is 0 if the
    /// points are not evenly spaced.
    pub lengths: Vec<f64>,
    /// Sizes of the borders without measured heights that were left out. For a map these are a
    /// number of columns and a number of rows, for a profile a number of points.
    pub cropped: Vec<usize>,
    /// Number of points without a measured height, whose heights were interpolated.
    pub interpolated: usize,
    /// Sentences about unusual properties of the file.
    #[serde(skip)]
    pub warnings: Vec<Note>,
}

/// Writes a path as text. Characters that are not Unicode become U+FFFD.
fn in_unicode<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

impl SurfaceFile {
    /// Collects the facts about a surface that was read from the file `path`.
    pub fn new(path: PathBuf, surface: &Topography) -> Self {
        let points = if surface.rows() > 1 {
            vec![surface.columns, surface.rows()]
        } else {
            vec![surface.columns]
        };
        let spacing = surface.spacing().unwrap_or_default();
        SurfaceFile {
            path,
            name: surface.name.clone(),
            format: surface.format,
            lengths: points
                .iter()
                .zip(spacing)
                .map(|(count, distance)| *count as f64 * distance)
                .collect(),
            cropped: surface.cropped.counts()[..points.len()].to_vec(),
            points,
            interpolated: surface.interpolated(),
            warnings: surface.warnings.clone(),
        }
    }

    /// Returns the name of the file. If the file contains several measurements, the name of the
    /// measurement is added.
    fn name(&self) -> String {
        let path = path_name(&self.path);
        if self.name.is_empty() {
            return path;
        }
        format!("{path} {:?}", printable(&self.name))
    }

    /// Returns these facts about the surface and its file in one line of text.
    pub fn describe(&self) -> String {
        let counts: Vec<String> = self
            .points
            .iter()
            .map(|count| grouped(*count as u64))
            .collect();
        let lengths: Vec<String> = self
            .lengths
            .iter()
            .map(|length| format_quantity(*length, "m"))
            .collect();
        let kind = if counts.len() > 1 { "map" } else { "profile" };
        let name = self.name();
        let format = self.format;
        let counts = counts.join(" × ");
        let lengths = lengths.join(" × ");
        let cropped = self.cropped_in_words();
        let interpolated = self.interpolated_in_words();
        format!("{name} ({format}): {kind} of {counts} points, {lengths}{cropped}{interpolated}")
    }

    /// Returns the share of interpolated points as text that begins with a comma; empty if no point
    /// was interpolated.
    fn interpolated_in_words(&self) -> String {
        if self.interpolated == 0 {
            return String::new();
        }
        let points: usize = self.points.iter().product();
        let percent = 100.0 * self.interpolated as f64 / points as f64;
        format!(", {percent:.2} % interpolated")
    }

    /// Returns how many points, columns or rows were left out, as text that begins with a comma;
    /// empty if nothing was left out.
    fn cropped_in_words(&self) -> String {
        match self.cropped[..] {
            [0] | [0, 0] => return String::new(),
            [points] => return format!(", {points} missing at its ends left out"),
            _ => {}
        }
        let mut empty = Vec::new();
        for (&count, noun) in self.cropped.iter().zip(["empty column", "empty row"]) {
            if count > 0 {
                empty.push(format!("{count} {}", plural(noun, count as u64)));
            }
        }
        format!(", without {} at its border", empty.join(" and "))
    }
}

/// Measured surfaces (profiles or maps) of one body, and their common analysis as samples of the
/// same roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFace {
    /// Facts about each surface and its file.
    pub files: Vec<SurfaceFile>,
    /// Spectrum and moments of all surfaces in `files` together, with a fit of the spectrum.
    pub analysis: Analysis,
}

impl MeasuredFace {
    /// Returns a warning if the rms heights of the files differ much, because the files should be
    /// samples of one roughness.
    fn far_apart(&self) -> Option<Warning> {
        let heights = || self.analysis.rms_heights.iter().zip(&self.files);
        let (least, flattest) = heights().min_by(|first, second| first.0.total_cmp(second.0))?;
        let (most, roughest) = heights().max_by(|first, second| first.0.total_cmp(second.0))?;
        let flattest = NamedHeight {
            name: flattest.name(),
            rms_height: *least,
        };
        let roughest = NamedHeight {
            name: roughest.name(),
            rms_height: *most,
        };
        Warning::of_rms_heights(flattest, roughest)
    }

    /// Returns warnings about files whose lengths or heights are larger than an instrument can
    /// measure.
    fn improbable_lengths(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        for (file, rms_height) in self.files.iter().zip(&self.analysis.rms_heights) {
            let length = file.lengths.iter().copied().fold(0.0, f64::max);
            warnings.extend(Warning::of_lengths(&file.name(), length, *rms_height));
        }
        warnings
    }

    /// Returns warnings: unusual properties of each file, and reasons why results of the analysis
    /// may be unreliable.
    pub fn warnings(&self) -> Vec<Warning> {
        let analysis = &self.analysis;
        let mut warnings = Vec::new();
        for file in &self.files {
            for property in &file.warnings {
                warnings.push(Warning::MeasuredFile {
                    file: file.name(),
                    property: property.clone(),
                });
            }
        }
        warnings.extend(self.improbable_lengths());
        warnings.extend(Warning::of_gradient(analysis.line.rms_gradient.value, true));
        match self.far_apart() {
            Some(warning) => warnings.push(warning),
            None => warnings.extend(Warning::of_surfaces(analysis.ratio_of_surfaces)),
        }
        warnings.extend(Warning::of_parts(analysis.ratio_of_parts));
        let statistics = &analysis.statistics;
        warnings.extend(Warning::of_distribution(
            statistics.skewness,
            statistics.kurtosis,
        ));
        if let Some(distance) = analysis.displaced {
            warnings.push(Warning::DisplacedRows { distance });
        }
        warnings.extend(Warning::of_long_waves_of_scan(
            analysis.long_wave_share(),
            analysis.is_levelled,
            &analysis.trends,
        ));
        warnings.extend(Warning::of_ends(analysis.step_of_ends));
        if analysis.maps == 0 {
            warnings.extend(Warning::of_measured_profiles(analysis.profiles));
        }
        if analysis.end == End::Ends && !analysis.ends_inside {
            warnings.push(Warning::UnresolvedSpectrum);
        }
        if analysis.offsets {
            warnings.push(Warning::OffsetRows);
        }
        if analysis.apart > 0.0 {
            warnings.push(Warning::WavesApart {
                share: analysis.apart,
            });
        }
        if let Some(wavelength) = analysis.reliability_cutoff {
            warnings.push(Warning::TipArtefacts { wavelength });
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_surface::{AnalysisOptions, analyse};

    /// Returns the names of the warnings for a map with these heights in m. Each row of the map has
    /// `columns` points, at the distance `spacing` in m.
    fn names(heights: &[f64], columns: usize, spacing: f64) -> Vec<&'static str> {
        let surface = Topography::from_map(heights, columns, [spacing; 2]).unwrap();
        let options = AnalysisOptions::default();
        let face = MeasuredFace {
            files: vec![SurfaceFile::new(PathBuf::from("a.x3p"), &surface)],
            analysis: analyse(&[surface], &options).unwrap(),
        };
        face.warnings().iter().map(Warning::name).collect()
    }

    /// Returns the heights of a sum of many waves in all directions, on 64 × 64 points.
    fn waves() -> Vec<f64> {
        let mut heights = vec![0.0; 64 * 64];
        for wave in 1..200_u32 {
            let direction = 2.4 * f64::from(wave);
            let wave_number = 0.4 + 0.004 * f64::from(wave);
            let phase = f64::from(wave * wave);
            for (index, z) in heights.iter_mut().enumerate() {
                let x = (index % 64) as f64;
                let y = (index / 64) as f64;
                let along = x * direction.cos() + y * direction.sin();
                *z += 1e-9 * (wave_number * along + phase).sin();
            }
        }
        heights
    }

    #[test]
    fn lengths_that_no_instrument_measures_are_named() {
        let heights = waves();
        assert!(!names(&heights, 64, 1e-7).contains(&"improbable_lengths"));
        // The heights in µm are taken as heights in m, and the map is 6.4 m long.
        let in_metres: Vec<f64> = heights.iter().map(|z| 1e6 * z).collect();
        assert!(names(&in_metres, 64, 0.1).contains(&"improbable_lengths"));
        // The rms height is about 10 mm on a map of 6.4 cm.
        assert!(names(&in_metres, 64, 1e-3).contains(&"improbable_lengths"));
    }

    #[test]
    fn removing_a_curvature_is_not_advised_twice() {
        let remedy = |is_levelled: bool| {
            let warning = Warning::of_long_waves_of_scan(0.95, is_levelled, &[]).unwrap();
            warning.remedy()
        };
        assert!(remedy(false).contains("Curvature") && !remedy(true).contains("Curvature"));
    }

    #[test]
    fn heights_far_from_normal_are_named() {
        let heights = waves();
        assert!(!names(&heights, 64, 1e-7).contains(&"heights_not_normal"));
        let mut particles: Vec<f64> = heights.iter().map(|z| 0.1 * z).collect();
        for place in [700, 1500, 1533, 2900, 3100] {
            for index in [place, place + 1, place + 64, place + 65] {
                particles[index] += 1e-7;
            }
        }
        assert!(names(&particles, 64, 1e-7).contains(&"heights_not_normal"));
    }

    #[test]
    fn warnings_promise_what_the_documentation_states() {
        let [low, high] = Warning::BOUNDARY_FACTORS;
        let stated = format!("within a factor of {low} to {high}");
        let page = include_str!("../../../docs/surface-estimate.md");
        let words: Vec<&str> = page.split_whitespace().collect();
        assert!(words.join(" ").contains(&stated), "{stated}");
    }
}
