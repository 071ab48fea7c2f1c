//! `asperity surface`: measured surfaces, their statistics and spectrum, and the equivalent line.

use super::output::command;
use super::scene::{MOST_LINES, threads};
use super::{CliError, Format, OutputArguments};
use crate::export::{
    MeasuredFace, MeasuredHash, Provenance, Spectra, SurfaceAdhesion, SurfaceContact, SurfaceFile,
    SurfaceReport, named_from, write_surface_table,
};
use crate::io::{check_writable, hexadecimal, write_new};
use crate::scene::{
    self, Adhesion, Document, MOST_POINTS, Material, Move, Numerics, Roughness, SCENE_VERSIONS, Scene,
    parse_quantity,
};
use crate::simulation::measured_roughness_options;
use crate::spectrum::{Analysis, Detrend, Options, analyse};
use crate::study::MeasuredAdhesion;
use crate::surface::EquivalentLine;
use crate::text::path_name;
use crate::topography::{Unit, content, parse};
use clap::{Args, ValueEnum};
use sha2::{Digest, Sha256};
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  asperity surface stylus.txt --unit um
  asperity surface stylus.txt --unit um --modulus 2.7MPa --work 50mJ/m^2
  asperity surface afm.gwy --modulus 2.7MPa --work 50mJ/m^2 --preload 1mN --lines 100
  asperity surface a.x3p b.x3p c.x3p --format json -o surface.json
  asperity surface one.sdf --opposite other.sdf --modulus 2.7MPa --work 50mJ/m^2
  asperity surface profile.csv --unit um -o spectra.csv
  asperity surface afm.gwy --tip-radius 10nm -o spectra.svg
  asperity surface profile.csv --unit um --modulus 2.7MPa --work 50mJ/m^2 --scene rough.ron

Files are profiles or maps: text in columns or as a matrix, SDF, GSF, NumPy, X3P, GWY, SUR,
NetCDF, and these in gzip. Several files are samples of the same roughness. A profile is a cut
through the surface; the contact computation needs the equivalent line.";

/// Springs of a written scene per period of its shortest wave: twice the fewest, from where on both edge models agree.
const SPRINGS_PER_WAVE: f64 = 2.0 * scene::SPRINGS_PER_WAVE as f64;

/// Default number of random profiles for the adhesion force, and the largest number of springs for it: some seconds.
const LINES: u32 = 16;
const MOST_SPRINGS: u64 = 1 << 17;

/// Arguments of `surface`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SurfaceArguments {
    /// Files of profiles or maps
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Measured surface of the opposite face: the spectra of both faces add
    #[arg(long, value_name = "FILE")]
    pub opposite: Option<PathBuf>,
    /// Options of the readers.
    #[command(flatten)]
    pub reading: ReadingArguments,
    /// Options of the analysis.
    #[command(flatten)]
    pub analysis: AnalysisArguments,
    /// text, json, csv, npy, svg or png; default: by the extension of FILE
    ///
    /// Text is a summary for a person. JSON is one object with statistics, fit, spectra and
    /// warnings. CSV holds the spectra: spectrum,wave_number,power,waves. npy is the same as a
    /// structured array of NumPy. SVG and PNG are pictures of the spectra.
    #[arg(long, value_parser = Format::parser(FORMATS), hide_possible_values = true, verbatim_doc_comment)]
    pub format: Option<Format>,
    /// Write a scene with the equivalent line to FILE; needs --modulus
    ///
    /// The scene names the files and holds all options of their reading and analysis.
    #[arg(long, value_name = "FILE", requires = "modulus", verbatim_doc_comment)]
    pub scene: Option<PathBuf>,
    /// Work of adhesion, as 50mJ/m^2: gives κ, e_el/γ, F_a; needs --modulus
    #[arg(long, value_name = "ENERGY", requires = "modulus", value_parser = energy)]
    pub work: Option<f64>,
    /// Force that presses before the pull, as 1mN; default: touch alone
    #[arg(long, value_name = "FORCE", requires = "modulus", value_parser = force)]
    pub preload: Option<f64>,
    /// Random profiles of the adhesion force; needs --work
    ///
    /// Each is solved on the fitted spectrum and on one moved within its uncertainty: the spread
    /// over lines beside that of the fit. Default: 16 up to 131 072 springs, else none.
    #[arg(long, value_name = "COUNT", requires = "work", value_parser = clap::value_parser!(u32).range(2..=MOST_LINES), verbatim_doc_comment)]
    pub lines: Option<u32>,
    /// Output file.
    #[command(flatten)]
    pub output: OutputArguments,
    /// Overwrite the scene if it exists
    #[arg(long, requires = "scene")]
    pub force_scene: bool,
}

/// Reading of files that leave something open.
#[derive(Args, Debug)]
pub struct ReadingArguments {
    /// Unit of lengths where a file states none: m, cm, mm, um, nm, Å, pm
    #[arg(long)]
    pub unit: Option<Unit>,
    /// Unit of heights where a file states none; default: as --unit
    #[arg(long, value_name = "UNIT")]
    pub height_unit: Option<Unit>,
    /// Distance between points where a file states none, as 0.5um
    ///
    /// Lengths without a unit, here and below, are in --unit.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub spacing: Option<Length>,
    /// Fill missing points from their neighbours
    #[arg(long)]
    pub interpolate: bool,
    /// Resample uneven profiles linearly at their mean distance
    #[arg(long)]
    pub resample: bool,
    /// Number of the channel of files with several
    #[arg(long, value_name = "NUMBER")]
    pub channel: Option<u32>,
    /// Row of maps that is the profile, from 1 on
    #[arg(long, value_name = "NUMBER", conflicts_with = "column", value_parser = clap::value_parser!(u64).range(1..))]
    pub row: Option<u64>,
    /// Column of maps that is the profile, from 1 on
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..))]
    pub column: Option<u64>,
}

/// Analysis of surfaces.
#[derive(Args, Debug)]
pub struct AnalysisArguments {
    /// Part that is removed: none, mean, tilt or curvature
    ///
    /// Default: tilt, or mean with --periodic.
    #[arg(long, value_enum, default_value = "tilt", default_value_if("periodic", "true", "mean"))]
    #[arg(hide_possible_values = true, hide_default_value = true)]
    pub detrend: DetrendArgument,
    /// The surface repeats itself at its borders: no window
    #[arg(long)]
    pub periodic: bool,
    /// Wavelength down to which the spectrum continues as a power law
    ///
    /// Default: the spectrum ends at the last resolved wave.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub continue_to: Option<Length>,
    /// Radius of the tip, as 10nm: gives the reliability cut-off
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub tip_radius: Option<Length>,
    /// Effective modulus E*, as 2.7MPa: gives the elastic energy
    #[arg(long, value_name = "PRESSURE", value_parser = pressure)]
    pub modulus: Option<f64>,
}

/// Detrending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DetrendArgument {
    /// Nothing.
    None,
    /// Mean height.
    Mean,
    /// Mean height and tilt.
    Tilt,
    /// Mean height, tilt and curvature.
    Curvature,
}

/// Formats of the results: text, one object with everything, and the spectra.
const FORMATS: &[Format] = &[Format::Text, Format::Json, Format::Csv, Format::Npy, Format::Svg, Format::Png];

impl AnalysisArguments {
    /// Removed part; `None` for the tilt of a surface that is not periodic, the default.
    fn detrend(&self) -> Option<Detrend> {
        match self.detrend {
            DetrendArgument::None => Some(Detrend::None),
            DetrendArgument::Mean => Some(Detrend::Mean),
            DetrendArgument::Tilt => self.periodic.then_some(Detrend::Tilt),
            DetrendArgument::Curvature => Some(Detrend::Curvature),
        }
    }
}

/// Length as typed.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// Number in m, or in the unit of `--unit`.
    value: f64,
    has_unit: bool,
}

impl Length {
    /// Length, m.
    fn in_metres(self, unit: Option<Unit>) -> f64 {
        unit.filter(|_| !self.has_unit).map_or(self.value, |unit| unit.to_metres(self.value))
    }
}

impl SurfaceArguments {
    fn in_metres(&self, length: Option<Length>) -> Option<f64> {
        length.map(|length| length.in_metres(self.reading.unit))
    }

    /// Refuses a length without a unit, if `--unit` states none either, and a wavelength that no scene may have.
    fn check_lengths(&self) -> Result<(), CliError> {
        let AnalysisArguments { continue_to, tip_radius, .. } = self.analysis;
        let lengths = [
            ("--spacing", self.reading.spacing),
            ("--continue-to", continue_to),
            ("--tip-radius", tip_radius),
        ];
        let has_none = |length: Option<Length>| length.is_some_and(|length| !length.has_unit);
        match lengths.into_iter().find(|(_, length)| self.reading.unit.is_none() && has_none(*length)) {
            Some((name, _)) => {
                Err(CliError::named(name, "a length without a unit; allowed: a unit, as 0.5um, or --unit um"))
            }
            None => match self.in_metres(continue_to).filter(|length| !(1e-15..=10.0).contains(length)) {
                Some(length) => {
                    let fault = format!("--continue-to: {length:e} m");
                    Err(CliError::named(fault, "allowed: from 1e-15 to 10 m"))
                }
                None => Ok(()),
            },
        }
    }

    /// Refuses to write over a measured file, also with `--force`: it could not be measured again.
    fn check_outputs(&self) -> Result<(), CliError> {
        let place = |file: &Path| file.canonicalize().ok();
        let outputs: Vec<PathBuf> =
            [self.output.file(), self.scene.as_deref()].into_iter().flatten().filter_map(place).collect();
        let files = self.files.iter().chain(&self.opposite);
        match files.into_iter().find(|file| place(file).is_some_and(|file| outputs.contains(&file))) {
            Some(file) => Err(CliError::named(
                path_name(file),
                "the output would replace this measured file; allowed: another name",
            )),
            None => Ok(()),
        }
    }

    /// Name of a file in a table in the destination of the results.
    fn in_table(&self, file: &Path) -> String {
        named_from(&file.to_string_lossy(), Path::new(""), self.output.folder())
    }

    /// Roughness of a scene in a file, with the surfaces named from the folder of that file.
    fn roughness(&self, scene: &Path) -> Roughness {
        let beside = |file: &Path| std::path::absolute(file).ok()?.parent().map(Path::to_path_buf);
        let named = |file: &Path| {
            let path = match file.file_name() {
                Some(name) if beside(file) == beside(scene) => PathBuf::from(name),
                _ => std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf()),
            };
            path.to_string_lossy().into_owned()
        };
        let (reading, analysis) = (&self.reading, &self.analysis);
        let unit = |unit: Option<Unit>| unit.map_or_else(String::new, |unit| unit.name().to_owned());
        let mut files = self.files.iter().map(|file| named(file));
        Roughness::Measured {
            file: files.next().unwrap_or_default(),
            further_files: files.collect(),
            as_line: None,
            opposite: self.opposite.as_deref().map(named),
            row: reading.row,
            column: reading.column,
            detrend: analysis.detrend(),
            periodic: analysis.periodic,
            unit: unit(reading.unit),
            height_unit: unit(reading.height_unit),
            spacing: self.in_metres(reading.spacing),
            interpolate: reading.interpolate,
            resample: reading.resample,
            channel: reading.channel.map(u64::from),
            continue_to: self.in_metres(analysis.continue_to),
            seed: 1,
        }
    }

    /// Error of the equivalent line, named by the first file.
    fn failed(&self, error: impl Into<Box<dyn Error + Send + Sync>>) -> CliError {
        let file = self.files.first().map(|file| path_name(file));
        CliError::named(file.unwrap_or_default(), error)
    }

    /// Reads and analyses the files of a face. Adds the hashes of the files if requested.
    fn face(
        &self,
        files: &[PathBuf],
        hashes: &mut Option<Vec<MeasuredHash>>,
    ) -> Result<MeasuredFace, CliError> {
        let options = measured_roughness_options(&self.roughness(Path::new("")), false);
        let (mut surfaces, mut facts) = (Vec::new(), Vec::new());
        for file in files {
            let failed = |error| CliError::named(path_name(file), error);
            let bytes = content(file).map_err(failed)?;
            let surface = parse(&bytes, &options.reading).map_err(failed)?;
            if let Some(hashes) = hashes {
                let sha256 = hexadecimal(Sha256::new_with_prefix(bytes));
                hashes.push(MeasuredHash { file: self.in_table(file), sha256 });
            }
            facts.push(SurfaceFile::new(file.clone(), &surface));
            surfaces.push(surface);
        }
        let options = Options { tip_radius: self.in_metres(self.analysis.tip_radius), ..options.spectrum };
        let analysis = analyse(&surfaces, &options).map_err(|error| {
            let file = facts.get(error.surface().unwrap_or(0)).map(|file| path_name(&file.path));
            CliError::named(file.unwrap_or_default(), error)
        })?;
        Ok(MeasuredFace { files: facts, analysis })
    }
}

/// Reads and analyses the files and writes the results.
pub(super) fn surface(arguments: &SurfaceArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(arguments.format, FORMATS, Format::Text)?;
    arguments.output.check()?;
    arguments.check_lengths()?;
    arguments.check_outputs()?;
    if let Some(scene) = &arguments.scene {
        check_writable(scene, arguments.force_scene)?;
    }
    let mut hashes = format.table().map(|_| Vec::new());
    let mut faces = vec![arguments.face(&arguments.files, &mut hashes)?];
    if let Some(opposite) = &arguments.opposite {
        faces.push(arguments.face(std::slice::from_ref(opposite), &mut hashes)?);
    }
    let line = EquivalentLine { faces: faces.iter().map(|face| face.analysis.isotropic.clone()).collect() };
    let modulus = arguments.analysis.modulus;
    let contact = modulus.map(|modulus| SurfaceContact { modulus, work: arguments.work });
    if let (Some(path), Some(modulus)) = (&arguments.scene, modulus) {
        let document =
            Document::from_scene(&scene(arguments, path, &faces, &line, modulus), &path_name(path))?;
        write_new(path, arguments.force_scene, |out| out.write_all(document.text().as_bytes()))?;
    }
    if format.picture().is_some() {
        let files = faces.iter().flat_map(|face| &face.files);
        let names = files.filter_map(|file| file.path.file_name());
        let names: Vec<String> = names.map(|name| path_name(Path::new(name))).collect();
        let analyses: Vec<&Analysis> = faces.iter().map(|face| &face.analysis).collect();
        let figure = Spectra::of_faces(&analyses).figure(&names.join(", "));
        return arguments.output.write_figure(stdout, &figure, format);
    }
    if let Some(format) = format.table() {
        let provenance = Provenance::of_files(&command(), &hashes.unwrap_or_default());
        let write = |out: &mut dyn Write| write_surface_table(out, format, &provenance, &faces, &line);
        return arguments.output.write(stdout, write);
    }
    let adhesion = match modulus.filter(|_| arguments.work.is_some()) {
        Some(modulus) => Some(adhesion(arguments, &faces, &line, modulus)?),
        None => None,
    };
    let report = SurfaceReport { faces: &faces, line: &line, contact, adhesion: adhesion.as_ref() };
    arguments.output.write(stdout, |out| match format {
        Format::Json => report.write_json(out),
        _ => out.write_all(report.text().as_bytes()),
    })
}

/// Adhesion of the equivalent line, if requested or computed in seconds.
fn adhesion(
    arguments: &SurfaceArguments,
    faces: &[MeasuredFace],
    line: &EquivalentLine,
    modulus: f64,
) -> Result<SurfaceAdhesion, CliError> {
    let scene = scene(arguments, Path::new(""), faces, line, modulus);
    scene.check()?;
    let unasked = (scene.numerics.points <= MOST_SPRINGS).then_some(LINES);
    let solve = |lines: u32| MeasuredAdhesion::solve(&scene, line, lines, threads(None));
    let computed = arguments.lines.or(unasked).map(solve).transpose();
    let computed = computed.map_err(|error| arguments.failed(error))?;
    Ok(SurfaceAdhesion { scene, computed })
}

/// Scene of the equivalent line over the length of the scan, the shorter one of two faces, on springs that
/// resolve its shortest wave.
fn scene(
    arguments: &SurfaceArguments,
    path: &Path,
    faces: &[MeasuredFace],
    line: &EquivalentLine,
    modulus: f64,
) -> Scene {
    let name = arguments.files.first().and_then(|file| file.file_name()).unwrap_or_default();
    let length = faces.iter().map(|face| face.analysis.length).fold(f64::INFINITY, f64::min);
    let waves = length * line.range()[1] / std::f64::consts::TAU;
    let points = ((SPRINGS_PER_WAVE * waves) as u64).next_power_of_two().clamp(1024, MOST_POINTS);
    Scene {
        version: *SCENE_VERSIONS.end(),
        title: format!("Equivalent line of {}", path_name(&PathBuf::from(name))),
        notice: String::new(),
        material: Material::effective(modulus),
        length,
        form: None,
        roughness: Some(arguments.roughness(path)),
        adhesion: arguments.work.map(Adhesion::by_work),
        loading: vec![arguments.preload.map_or(Move::ToZeroForce, Move::ToForce), Move::ToSeparation],
        numerics: Numerics { points, ..Numerics::default() },
        observe: Vec::new(),
    }
}

/// Parses a length above 0.
fn length(text: &str) -> Result<Length, String> {
    let value = positive(text, "m")?;
    Ok(Length { value, has_unit: text.trim().parse::<f64>().is_err() })
}

/// Parses an energy per area above 0, J/m².
fn energy(text: &str) -> Result<f64, String> {
    positive(text, "J/m²")
}

/// Parses a force above 0, N.
fn force(text: &str) -> Result<f64, String> {
    positive(text, "N")
}

/// Parses a pressure above 0, Pa.
fn pressure(text: &str) -> Result<f64, String> {
    positive(text, "Pa")
}

fn positive(text: &str, unit: &str) -> Result<f64, String> {
    match parse_quantity(text, unit) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("allowed: above 0 {unit}")),
        Err(error) => Err(error.to_string()),
    }
}
