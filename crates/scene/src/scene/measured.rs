//! A measured surface as the roughness of a scene: its files, and the options for reading and
//! analysing them.

use super::defaults::{MEASURED_SEED, read_default};
use asperity_surface::lines::MeasuredOptions;
use asperity_surface::spectra::End;
use asperity_surface::{AnalysisOptions, Cut, Detrend, ReadOptions, Unit};
use serde::de::value::{Error as ValueError, MapDeserializer};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::iter;
use std::ops::Not;

/// A measured surface, profile or map, as the roughness of a scene. Many fields of this type are
/// also options of `asperity surface`.
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Name of the measured file, relative to the scene file.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub file: String,
    /// Names of files with further measurements of the same surface. The spectrum is estimated from
    /// all files together.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further_files: Vec<String>,
    /// True if the heights of the file are used, unchanged, as the profile, because they already
    /// are the heights of an equivalent line. False if random profiles get the spectrum of the
    /// measured surface. A measured profile is a cut through the surface, not an equivalent line.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub as_line: bool,
    /// Name of the file of the opposite surface, relative to the scene file; `None` if that surface
    /// is smooth. The profile gets the sum of the spectra of the two surfaces.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opposite: Option<String>,
    /// Unit of lengths where a file states none: m, cm, mm, um, nm, Å, pm
    #[cfg_attr(feature = "clap", arg(long, default_value = "", hide_default_value = true, value_parser = unit_name))]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Unit of heights where a file states none, if not the unit of lengths
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "UNIT", default_value = "", hide_default_value = true, value_parser = unit_name)
    )]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub height_unit: String,
    /// Distance between the measured points in m, for a file that states none.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Fill missing points by heights interpolated from their neighbours
    #[cfg_attr(feature = "clap", arg(long))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub interpolate: bool,
    /// Resample profiles of uneven spacing linearly at their mean spacing
    #[cfg_attr(feature = "clap", arg(long))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub resample: bool,
    /// Subtract the median height of each row of a map from that row
    #[cfg_attr(feature = "clap", arg(long))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub align_rows: bool,
    /// Replace outliers, such as spikes, by heights from their neighbours
    #[cfg_attr(feature = "clap", arg(long))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub robust: bool,
    /// Name of the surface or measurement to read from a file that contains several surfaces or
    /// measurements.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_name: Option<String>,
    /// Number of the channel to read from a file with several channels, counted from 0.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<u64>,
    /// Row of a map to use as the profile, counted from 1
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NUMBER", conflicts_with = "column", value_parser = clap::value_parser!(u64).range(1..))
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub row: Option<u64>,
    /// Column of a map to use as the profile, counted from 1
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<u64>,
    /// Part of the heights to remove: none, mean, tilt or curvature
    ///
    /// Default: tilt, or mean if the surface is periodic.
    #[cfg_attr(feature = "clap", arg(long, value_enum, hide_possible_values = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detrend: Option<Detrend>,
    /// Treat the surface as periodic: no window acts on its ends
    #[cfg_attr(feature = "clap", arg(long))]
    #[serde(default, skip_serializing_if = "Not::not")]
    pub periodic: bool,
    /// Wavelength in m down to which the measured spectrum continues as a power law; `None` if the
    /// spectrum ends at its shortest resolved wave.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continue_to: Option<f64>,
    /// Seed of the random phases of profiles with the measured spectrum.
    #[cfg_attr(feature = "clap", arg(skip = default_seed()))]
    #[serde(default = "default_seed", skip_serializing_if = "is_default_seed")]
    pub seed: u64,
}

impl Measured {
    /// Creates the description of a measured surface in one file. All options have their defaults.
    pub fn of_file(file: &str) -> Self {
        let stated = MapDeserializer::<_, ValueError>::new(iter::once(("file", file)));
        Measured::deserialize(stated).expect("defaults of all fields but the file")
    }
}

fn default_seed() -> u64 {
    read_default(MEASURED_SEED)
}

fn is_default_seed(seed: &u64) -> bool {
    *seed == default_seed()
}

/// Returns the usual name of a unit that a user has typed. Empty text stays empty.
#[cfg(feature = "clap")]
fn unit_name(text: &str) -> Result<String, asperity_surface::SurfaceError> {
    if text.is_empty() {
        Ok(String::new())
    } else {
        text.parse().map(|unit: Unit| unit.name().to_owned())
    }
}

impl Measured {
    /// Returns the names of the files of each face of the contact: first the rough body, then the
    /// opposite body if the scene names its file.
    pub(super) fn faces(&self) -> Vec<Vec<&str>> {
        let mut face = vec![self.file.as_str()];
        face.extend(self.further_files.iter().map(String::as_str));
        let mut faces = vec![face];
        faces.extend(self.opposite.iter().map(|file| vec![file.as_str()]));
        faces
    }

    /// Returns the options for reading and analysing the files of this surface. The fields of this
    /// type must be valid.
    pub fn options(&self) -> MeasuredOptions {
        MeasuredOptions {
            as_line: self.as_line.then(|| self.detrend.unwrap_or(Detrend::None)),
            reading: ReadOptions {
                unit: self.unit.parse().ok(),
                height_unit: self.height_unit.parse().ok(),
                convention: self.as_line.then_some(Unit::METRE),
                spacing: self.spacing,
                interpolate: self.interpolate,
                channel: self.channel.and_then(|channel| channel.try_into().ok()),
                cut: self.row.map(Cut::Row).or(self.column.map(Cut::Column)),
                resample: self.resample,
                align_rows: self.align_rows,
                robust: self.robust,
                surface_name: self.surface_name.clone(),
            },
            spectrum: AnalysisOptions {
                detrend: self.detrend,
                periodic: self.periodic,
                end: self
                    .continue_to
                    .map_or(End::Ends, |wavelength| End::Continues(TAU / wavelength)),
                tip_radius: None,
            },
        }
    }
}
