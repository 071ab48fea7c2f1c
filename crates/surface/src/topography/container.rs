//! Containers of the web site contact.engineering. A container is an archive with an index file in
//! JSON or YAML, which lists surfaces and the measurements of each surface.

use super::options::ReadOptions;
use super::reading::Reading;
use super::surface::Detrend;
use super::unit::Unit;
use crate::error::{ChosenBy, Place, SurfaceError, refused};
use asperity_data::{Note, Remedy, shown};
use serde::Deserialize;

/// Names of the index file: in JSON and in YAML.
pub(super) const INDICES: [&str; 2] = ["index.json", "meta.yml"];

/// Largest allowed size of an index file in bytes.
pub(super) const LONGEST_INDEX: usize = 1 << 24;

/// Largest allowed number of measurements in a container.
const MOST_MEASUREMENTS: usize = 10_000;

#[derive(Deserialize)]
struct Index {
    surfaces: Vec<Surface>,
}

#[derive(Deserialize)]
struct Surface {
    #[serde(default)]
    name: String,
    topographies: Vec<Measurement>,
}

/// A measurement of a surface, as the index file describes it: the name of its data file in the
/// archive, and numbers that the data file may omit.
#[derive(Deserialize)]
pub(super) struct Measurement {
    #[serde(default)]
    pub name: String,
    datafile: Files,
    /// Lengths of the map along the rows and across the rows, in the unit of the measurement.
    #[serde(default)]
    size: Vec<f64>,
    unit: Option<String>,
    data_source: Option<u32>,
    height_scale: Option<f64>,
    detrend_mode: Option<Mode>,
    #[serde(default)]
    pub is_periodic: bool,
    fill_undefined_data_mode: Option<String>,
    instrument: Option<Instrument>,
}

#[derive(Deserialize)]
struct Instrument {
    parameters: Option<Parameters>,
}

#[derive(Deserialize)]
struct Parameters {
    tip_radius: Option<Radius>,
}

#[derive(Deserialize)]
struct Radius {
    value: f64,
    unit: String,
}

/// Names of two files: the file as it was measured, and a file with the same heights after scaling
/// and removal of a polynomial.
#[derive(Deserialize)]
struct Files {
    original: Option<String>,
    #[serde(rename = "squeezed-netcdf")]
    squeezed: Option<String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Mode {
    Center,
    #[serde(alias = "slope")]
    Height,
    Curvature,
}

/// Returns measurements that the index file lists: all measurements of the surface called `name`,
/// or the single measurement called `name`. If no name is given, the container must have only one
/// surface, and all measurements of this surface are returned.
pub(super) fn measurements(
    index: &str,
    content: &[u8],
    name: Option<&str>,
) -> Result<Vec<Measurement>, SurfaceError> {
    let surfaces = surfaces(index, content)?;
    let found = chosen(surfaces, name)?;
    if (1..=MOST_MEASUREMENTS).contains(&found.len()) {
        return Ok(found);
    }
    let found = format!("{} measurements of the surface", found.len());
    let allowed = format!("from 1 to {MOST_MEASUREMENTS}");
    Err(refused(Place::File, found, allowed))
}

/// Parses the index file and returns its surfaces.
fn surfaces(index: &str, content: &[u8]) -> Result<Vec<Surface>, SurfaceError> {
    let parsed: Result<Index, String> = if index == INDICES[0] {
        serde_json::from_slice(content).map_err(|error| error.to_string())
    } else {
        serde_saphyr::from_slice(content).map_err(|error| error.to_string())
    };
    match parsed {
        Ok(index) => Ok(index.surfaces),
        Err(error) => {
            let first_line = error.lines().next().unwrap_or_default();
            let allowed = "surfaces with their topographies and datafile";
            Err(refused(Place::Part(index.to_owned()), first_line, allowed))
        }
    }
}

/// Returns all measurements of the surface called `name` or, if there is no such surface, the
/// measurement called `name`. If no name is given, returns the measurements of the only surface.
fn chosen(
    mut surfaces: Vec<Surface>,
    name: Option<&str>,
) -> Result<Vec<Measurement>, SurfaceError> {
    let names: Vec<String> = surfaces
        .iter()
        .map(|surface| format!("{:?}", shown(&surface.name)))
        .collect();
    let undecided = |fault: String| SurfaceError::Channel {
        place: Place::File,
        fault: format!("{fault} in the container"),
        channels: names.clone(),
        allowed: "the name of one of them or of their measurements",
        chosen_by: ChosenBy::SurfaceName,
    };
    let Some(name) = name else {
        if surfaces.len() == 1 {
            return Ok(surfaces.swap_remove(0).topographies);
        }
        return Err(undecided(format!("{} surfaces", surfaces.len())));
    };
    if let Some(place) = surfaces.iter().position(|surface| surface.name == name) {
        return Ok(surfaces.swap_remove(place).topographies);
    }
    let mut measurements = surfaces
        .into_iter()
        .flat_map(|surface| surface.topographies);
    match measurements.find(|measurement| measurement.name == name) {
        Some(measurement) => Ok(vec![measurement]),
        None => Err(undecided(format!("no surface {:?}", shown(name)))),
    }
}

impl Measurement {
    /// Returns the name of the data file of the measurement in the archive. It is the NetCDF file
    /// with the scaled heights or, if there is none, the original file.
    ///
    /// # Errors
    /// Returns an error if the index file names no data file.
    pub fn file(&self) -> Result<&str, SurfaceError> {
        let name = self.datafile.squeezed.as_deref();
        name.or(self.datafile.original.as_deref()).ok_or_else(|| {
            let allowed = "a datafile with original or squeezed-netcdf";
            refused(self.place(), "no file", allowed)
        })
    }

    fn place(&self) -> Place {
        Place::Part(format!("topography {}", self.name))
    }

    /// Returns a message for the user about the tip radius that the index file states; `None` if it
    /// states none.
    pub fn tip_radius(&self) -> Option<Note> {
        let parameters = self.instrument.as_ref()?.parameters.as_ref()?;
        let radius = parameters.tip_radius.as_ref()?;
        let value = radius.value;
        let unit = radius.unit.parse::<Unit>().ok()?;
        let text = format!("the radius of the tip is {value} {unit}");
        Some(Note::new(text).with(Remedy::TipRadius(format!("{value}{unit}"))))
    }

    /// Returns true if the file contains the heights as they were measured, before scaling.
    fn is_original(&self) -> bool {
        self.datafile.squeezed.is_none()
    }

    /// Returns the polynomial to be removed from the heights, as the index file requests. Returns
    /// `None` if the file requests only the removal of the mean, which is the default of such
    /// containers.
    pub fn detrend(&self) -> Option<Detrend> {
        match self.detrend_mode? {
            Mode::Center => None,
            Mode::Height => Some(Detrend::Tilt),
            Mode::Curvature => Some(Detrend::Curvature),
        }
    }

    /// Returns the options for reading the file of the measurement: the options of the user,
    /// completed by what the index file states.
    ///
    /// # Errors
    /// Returns an error if the index file states a unit that is not a unit of length.
    pub fn options(&self, options: &ReadOptions) -> Result<ReadOptions, SurfaceError> {
        let unit = self.unit.as_deref().unwrap_or_default();
        let stated = Unit::stated(unit, self.place())?;
        let is_filled = match self.fill_undefined_data_mode.as_deref() {
            Some(mode) => mode != "do-not-fill",
            None => false,
        };
        let channel = if self.is_original() {
            options.channel.or(self.data_source)
        } else {
            options.channel
        };
        Ok(ReadOptions {
            convention: stated.or(options.convention),
            channel,
            // The name in the options is that of the surface or the measurement, and not that of a
            // channel in the file.
            surface_name: None,
            interpolate: options.interpolate || is_filled,
            ..options.clone()
        })
    }

    /// Completes the contents of the file of the measurement by what the index file states. The
    /// distances between points and the scale of the heights are added if the file of the
    /// measurement does not state them.
    pub fn completed(&self, mut reading: Reading) -> Reading {
        if reading.positions.is_none()
            && reading.spacing.is_none()
            && let Some(&width) = self.size.first()
        {
            let rows = reading.heights.len() / reading.columns.max(1);
            let height = self.size.get(1).copied().unwrap_or(width);
            reading.spacing = Some([width / reading.columns as f64, height / rows as f64]);
        }
        match self.height_scale {
            // If the heights have a unit in their file, they are already scaled.
            Some(scale) if self.is_original() && reading.units.heights.is_none() => {
                reading.scaled(|_| false, scale)
            }
            _ => reading,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::archive::tests::archive;
    use super::super::open::{parse, parse_all};
    use super::super::options::ReadOptions;
    use super::super::surface::Topography;
    use super::*;

    const PROFILE: &str = "0 1\n1 3\n2 2\n";

    const YAML: &str = "surfaces:
- creator: &one
    name: A
  name: \"first: \\xE9\"
  topographies:
  - {creator: *one, datafile: {original: map.txt}, name: map, size: [4.0, 2.0], unit: nm, height_scale: 10.0}
  - datafile:
      original: map.txt
      squeezed-netcdf: profile.txt
    detrend_mode: curvature
    height_scale: 10.0
    is_periodic: true
    name: profile
    size: [2.0]
    unit: \"\\xB5m\"
- name: second
  topographies:
  - datafile: {original: profile.txt}
    name: 7
    unit: um
";

    fn read(index: (&str, &str), name: Option<&str>) -> Result<Vec<Topography>, String> {
        let map = "1 2 3 4\n4 3 2 1\n";
        let files = [index, ("map.txt", map), ("profile.txt", PROFILE)];
        let files = files.map(|(name, text)| (name, text.as_bytes()));
        let options = ReadOptions {
            surface_name: name.map(str::to_owned),
            ..ReadOptions::default()
        };
        parse_all(&archive(&files), &options).map_err(|error| error.to_string())
    }

    #[test]
    fn measurements_of_a_surface_are_read_with_what_the_index_states() {
        let surfaces = read(("meta.yml", YAML), Some("first: \u{e9}")).unwrap();
        let [map, profile] = &surfaces[..] else {
            panic!("{surfaces:?}")
        };
        assert_eq!(
            (&*map.name, map.columns, map.spacing()),
            ("map", 4, Ok([1e-9; 2]))
        );
        assert!((map.heights[3] - 4e-8).abs() < 1e-20 && map.detrend.is_none());
        // The heights in the file with scaled heights are not scaled a second time.
        assert_eq!((&*profile.name, profile.heights[1]), ("profile", 3e-6));
        assert_eq!(
            (profile.detrend, profile.periodic),
            (Some(Detrend::Curvature), true)
        );
        for name in ["second", "7", "profile"] {
            assert_eq!(
                read(("meta.yml", YAML), Some(name)).unwrap().len(),
                1,
                "{name}"
            );
        }
        let json = r#"{"surfaces": [{"name": "s", "topographies": [
            {"name": "p", "datafile": {"original": "profile.txt"}, "size": [2.0], "unit": "nm"}]}]}"#;
        assert_eq!(
            read(("index.json", json), None).unwrap()[0].heights[1],
            3e-9
        );
    }

    #[test]
    fn measurements_that_cannot_be_read_are_left_out_and_named() {
        let yaml = "surfaces:
- name: s
  topographies:
  - {datafile: {original: map.txt}, name: scan, unit: nm}
  - {datafile: {original: map.spm}, name: afm, unit: nm, data_source: 0, height_scale: 7.0,
     instrument: {type: contact, parameters: {tip_radius: {value: 10.0, unit: nm}}}}
";
        let spm = include_bytes!("../../../../fuzz/seeds/surface/map.spm");
        let read = |text: &[u8], spm: &[u8]| {
            let files = [
                ("meta.yml", yaml.as_bytes()),
                ("map.txt", text),
                ("map.spm", spm),
            ];
            parse_all(&archive(&files), &ReadOptions::default()).map_err(|error| error.to_string())
        };
        let found = read(b"AliconaImaging\0", spm).unwrap();
        assert_eq!(
            (
                &*found[0].name,
                found.len(),
                (found[0].heights[0] * 1e14).round()
            ),
            ("afm", 1, 125.0)
        );
        assert_eq!(
            found[0].warnings,
            [
                Note::new("the radius of the tip is 10 nm")
                    .with(Remedy::TipRadius("10nm".to_owned())),
                Note::new(
                    "another measurement is left out: scan: AL3D of Alicona is not read; allowed: the same saved as GWY or \
                     X3P in Gwyddion"
                )
            ]
        );
        // If a distance is missing that an option can supply, the error message requests it.
        assert!(
            read(b"1 2 3 4\n5 6 7 9\n", spm)
                .unwrap_err()
                .starts_with("scan: text matrix without a distance")
        );
        assert!(
            read(b"AliconaImaging\0", b"\0")
                .unwrap_err()
                .starts_with("scan: AL3D")
        );
    }

    #[test]
    fn faults_have_a_place_and_the_allowed_content() {
        let first = "first: \u{e9}";
        let all = |from: &str, to: &str, name: Option<&str>| {
            read(("meta.yml", &YAML.replacen(from, to, 1)), name).unwrap_err()
        };
        for (from, to, name, expected) in [
            (
                "",
                "",
                None,
                "2 surfaces in the container: \"first: \u{e9}\", \"second\"; allowed: the name of one",
            ),
            (
                "",
                "",
                Some("third"),
                "no surface \"third\" in the container: \"first",
            ),
            (
                "map.txt",
                "none.txt",
                Some(first),
                "no file none.txt in the archive",
            ),
            (
                "nm",
                "V",
                Some(first),
                "topography map: \"V\" is not a unit of length; allowed: ",
            ),
            ("curvature", "wavelets", Some(first), "meta.yml: "),
            ("surfaces", "things", None, "meta.yml: "),
            (
                "original: map",
                "other: map",
                Some(first),
                "topography map: no file; allowed: a datafile",
            ),
            ("unit: nm, ", "", Some(first), "map: no unit of "),
            (
                "size: [4.0, 2.0], ",
                "",
                Some(first),
                "map: text matrix without a distance",
            ),
        ] {
            let error = all(from, to, name);
            assert!(
                error.starts_with(expected) && error.contains("; allowed: "),
                "{to}: {error}"
            );
            assert!(!error.contains('\n'), "{error}");
        }
        let both = ReadOptions {
            surface_name: Some(first.to_owned()),
            ..ReadOptions::default()
        };
        let files: [(&str, &[u8]); 3] = [
            ("meta.yml", YAML.as_bytes()),
            ("map.txt", b"1 2 3 4\n4 3 2 1\n"),
            ("profile.txt", PROFILE.as_bytes()),
        ];
        let error = parse(&archive(&files), &both).unwrap_err().to_string();
        assert!(
            error.starts_with("2 measurements of a surface; allowed: one"),
            "{error}"
        );
        // Nested aliases of YAML could expand a small index file to a very large one, which is
        // refused.
        let level = |i: u32| {
            format!(
                "a{i}: &a{i} [*a{0}, *a{0}, *a{0}, *a{0}, *a{0}, *a{0}, *a{0}, *a{0}]\n",
                i - 1
            )
        };
        let bomb: String = (1..12).map(level).collect();
        assert!(
            read(
                ("meta.yml", &format!("a0: &a0 [x, x]\n{bomb}surfaces: []\n")),
                None
            )
            .is_err()
        );
    }
}
