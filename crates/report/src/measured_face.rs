//! Measured surfaces of one face, as samples of the same roughness, with facts about their files and warnings about their
//! analysis.

use asperity_data::{format_quantity, grouped, path_name, printable};
use asperity_surface::spectra::End;
use asperity_surface::{Analysis, Topography};
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

/// Share of long waves in the squared height, above which the rms height depends on the length of the scan.
const MANY_LONG_WAVES: f64 = 0.3;

/// Share of long waves in the squared height, above which the waves are likely to belong to a body or to a bow of the
/// scanner.
const FORM: f64 = 0.9;

/// Number of profiles whose moments are as accurate as the moments of a map.
const MANY_PROFILES: u64 = 100;

/// Smallest and largest factor by which adhesion near its boundary varies between single profiles, as in
/// `docs/surface-estimate.md`.
const BOUNDARY_FACTORS: [f64; 2] = [1.4, 3.3];

/// Largest rms gradient for which slopes are small, and largest ratio of the rms heights of two samples of one roughness.
/// Above either a wrong unit is likely.
const LARGEST_GRADIENT: f64 = 1.0;
const FAR_APART: f64 = 30.0;

/// Facts about a measured surface and its file. The lists `points`, `lengths` and `cropped` have one number for a profile, and
/// two for a map: along a row, then along a column.
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
    /// Number of points in a row, and for a map the number of rows.
    pub points: Vec<usize>,
    /// Length of a row, and for a map the length of a column, m; 0 if the points are not evenly spaced.
    pub lengths: Vec<f64>,
    /// Numbers of columns and rows without measured heights that were left out at the borders of a map, or number of points
    /// without a height that were left out at the ends of a profile.
    pub cropped: Vec<usize>,
    /// Number of points without a measured height, whose heights were interpolated.
    pub interpolated: usize,
    /// Sentences about unusual properties of the file.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Writes a path. Characters that are not Unicode become U+FFFD.
fn in_unicode<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

impl SurfaceFile {
    /// Collects the facts about a surface that was read from the file `path`.
    pub fn new(path: PathBuf, surface: &Topography) -> Self {
        let mut points = vec![surface.columns, surface.rows()];
        points.truncate(if surface.rows() > 1 { 2 } else { 1 });
        let spacing = surface.spacing().unwrap_or_default();
        SurfaceFile {
            path,
            name: surface.name.clone(),
            format: surface.format,
            lengths: points.iter().zip(spacing).map(|(count, distance)| *count as f64 * distance).collect(),
            cropped: surface.cropped.counts()[..points.len()].to_vec(),
            points,
            interpolated: surface.interpolated(),
            warnings: surface.warnings.clone(),
        }
    }

    /// Returns the name of the file, with the name of the measurement if the file contains several.
    fn name(&self) -> String {
        let name = if self.name.is_empty() { String::new() } else { format!(" {:?}", printable(&self.name)) };
        path_name(&self.path) + &name
    }

    /// Returns these facts about the surface and its file in one line of text.
    pub fn describe(&self) -> String {
        let counts: Vec<String> = self.points.iter().map(|count| grouped(*count as u64)).collect();
        let lengths: Vec<String> = self.lengths.iter().map(|length| format_quantity(*length, "m")).collect();
        let kind = if counts.len() > 1 { "map" } else { "profile" };
        let shape = format!("{kind} of {} points, {}", counts.join(" × "), lengths.join(" × "));
        let points: usize = self.points.iter().product();
        let interpolated = match self.interpolated {
            0 => String::new(),
            some => format!(", {:.2} % interpolated", 100.0 * some as f64 / points as f64),
        };
        let cropped = match self.cropped[..] {
            [0] | [0, 0] => String::new(),
            [points] => format!(", {points} missing at its ends left out"),
            ref counts => {
                let empty = counts.iter().zip(["column", "row"]).filter(|(count, _)| **count > 0);
                let counted = empty.map(|(count, name)| {
                    let plural = if *count == 1 { "" } else { "s" };
                    format!("{count} empty {name}{plural}")
                });
                format!(", without {} at its border", counted.collect::<Vec<_>>().join(" and "))
            }
        };
        format!("{} ({}): {shape}{cropped}{interpolated}", self.name(), self.format)
    }
}

/// Measured surfaces (profiles or maps) of one body, and their common analysis as samples of the same roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFace {
    /// Facts about each surface and its file.
    pub files: Vec<SurfaceFile>,
    /// Spectrum and moments of all these surfaces together, with a fit of the spectrum.
    pub analysis: Analysis,
}

pub(crate) fn steep(rms_gradient: f64) -> Option<String> {
    (rms_gradient > LARGEST_GRADIENT).then(|| {
        format!(
            "the rms gradient {} is above {LARGEST_GRADIENT}, where the theory of small slopes does not hold: is the unit of \
             positions or of heights wrong? --unit and --height-unit, in a scene roughness.unit and roughness.height_unit, \
             state them",
            format_quantity(rms_gradient, "1")
        )
    })
}

impl MeasuredFace {
    /// Returns a warning for files whose rms heights differ much, although the files are samples of one roughness.
    fn far_apart(&self) -> Option<String> {
        let MeasuredFace { files, analysis } = self;
        let heights = || analysis.rms_heights.iter().zip(files);
        let (least, flat) = heights().min_by(|one, other| one.0.total_cmp(other.0))?;
        let (most, rough) = heights().max_by(|one, other| one.0.total_cmp(other.0))?;
        (most / least > FAR_APART).then(|| {
            format!(
                "the rms heights of {} ({}) and {} ({}) are {}-fold apart: is the unit of one of them wrong, or are they no samples \
                 of the same roughness?",
                flat.name(),
                format_quantity(*least, "m"),
                rough.name(),
                format_quantity(*most, "m"),
                format_quantity(most / least, "1"),
            )
        })
    }

    /// Returns warnings: unusual properties of each file, and reasons why results of the analysis may be unreliable.
    pub fn warnings(&self) -> Vec<String> {
        let analysis = &self.analysis;
        let of_file = |file: &SurfaceFile| {
            let name = file.name();
            file.warnings.iter().map(|warning| format!("{name}: {warning}")).collect::<Vec<_>>()
        };
        let mut warnings: Vec<String> = self.files.iter().flat_map(of_file).collect();
        warnings.extend([steep(analysis.line.rms_gradient.value), self.far_apart()].into_iter().flatten());
        if let Some(distance) = analysis.displaced {
            warnings.push(format!(
                "odd rows are displaced by {} along even ones, as trace and retrace are: the gradient is too large; give the rows \
                 of one direction",
                format_quantity(distance, "m")
            ));
        }
        let long = analysis.long_wave_share();
        if long > MANY_LONG_WAVES {
            let form = if long > FORM {
                "; where they are the form of a curved body or a bow of the scanner, --detrend curvature, in a scene \
                 roughness.detrend, removes it"
            } else {
                ""
            };
            warnings.push(format!(
                "waves longer than a quarter of the scan carry {:.0} % of the squared height: rms height and elastic \
                 energy depend on the length of the scan{form}",
                100.0 * long
            ));
        }
        if analysis.maps == 0 && analysis.profiles < MANY_PROFILES {
            let [low, high] = BOUNDARY_FACTORS;
            warnings.push(format!(
                "from few profiles adhesion near its boundary is known only within a factor of {low} to {high}; \
                 {MANY_PROFILES} profiles or a map are better"
            ));
        }
        if analysis.end == End::Ends && !analysis.ends_inside {
            warnings.push(
                "the spectrum does not end inside the scan: shorter waves may be missing, and in samples of points add \
                 to the longer ones; --continue-to, in a scene roughness.continue_to, continues it as a power law"
                    .to_owned(),
            );
        }
        if analysis.offsets {
            warnings.push(
                "rows or columns are offset against each other, or were levelled one by one: waves along that axis \
                 are left out of the fit"
                    .to_owned(),
            );
        }
        if analysis.apart > 0.0 {
            warnings.push(format!(
                "waves along one axis differ from their neighbours by {:.0} % of the squared gradient: rows or columns \
                 are offset against each other, or the surface has a lay; level the rows before, or choose one by --row",
                100.0 * analysis.apart
            ));
        }
        if let Some(cutoff) = analysis.reliability_cutoff {
            warnings.push(format!("waves below {cutoff:.3e} m may be artefacts of the tip"));
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_promise_what_the_documentation_states() {
        let [low, high] = BOUNDARY_FACTORS;
        let stated = format!("within a factor of {low} to {high}");
        assert!(include_str!("../../../docs/surface-estimate.md").contains(&stated), "{stated}");
    }
}
