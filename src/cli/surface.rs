//! `asperity surface`: measured surfaces, their statistics and spectrum, and the equivalent line.

use super::scene::{MOST_LINES, threads};
use super::{CliError, Format, OutputArguments};
use crate::export::{
    Spectra, SurfaceAdhesion, SurfaceContact, SurfaceFile, surface_text, write_surface_json,
    write_surface_table,
};
use crate::io::{check_writable, write_new};
use crate::scene::{
    Adhesion, Document, Leg, MOST_POINTS, Material, MeasuredHash, MeasuredHashError, Numerics, Provenance,
    Roughness, SCENE_VERSIONS, Scene, exact_quantity, named_from, parse_quantity,
};
use crate::spectrum::{Analysis, Detrend, End, Options, SpectrumError, analyse};
use crate::study::MeasuredAdhesion;
use crate::surface::EquivalentLine;
use crate::text::path_name;
use crate::topography::{Missing, ReadOptions, Topography, Unit, read};
use clap::{Args, ValueEnum};
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  asperity surface stylus.txt --unit um
  asperity surface stylus.txt --unit um --modulus 2.7MPa --work 50mJ/m^2
  asperity surface afm.gwy --modulus 2.7MPa --work 50mJ/m^2 --preload 1mN --lines 100
  asperity surface a.x3p b.x3p c.x3p --format json -o surface.json
  asperity surface profile.csv --unit um -o spectra.csv
  asperity surface afm.gwy --tip-radius 10nm -o spectra.svg
  asperity surface profile.csv --unit um --modulus 2.7MPa --work 50mJ/m^2 --scene rough.ron

Files are profiles or maps: text in columns or as a matrix, SDF, GSF, NumPy, X3P, GWY, SUR,
NetCDF, and these in gzip. Several files are samples of the same roughness. A profile is a cut
through the surface; the contact computation needs the equivalent line.";

/// Springs of a scene for each of its shortest waves.
const SPRINGS_PER_WAVE: f64 = 8.0;

/// Random profiles of the adhesion force, and springs up to which they are computed unasked: some seconds.
const LINES: u32 = 16;
const MOST_SPRINGS: u64 = 1 << 17;

/// Arguments of `surface`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SurfaceArguments {
    /// Files of profiles or maps
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
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
    /// The scene names the surface and holds --unit, --detrend, --periodic and --continue-to.
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
    /// Folder that the files are relative to.
    #[arg(skip)]
    pub folder: PathBuf,
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
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub spacing: Option<f64>,
    /// Fill missing points from their neighbours
    #[arg(long)]
    pub interpolate: bool,
    /// Resample uneven profiles linearly at their mean distance
    #[arg(long)]
    pub resample: bool,
    /// Number of the channel of files with several
    #[arg(long, value_name = "NUMBER")]
    pub channel: Option<u32>,
}

/// Analysis of surfaces.
#[derive(Args, Debug)]
pub struct AnalysisArguments {
    /// Part that is removed: none, mean, tilt or curvature
    #[arg(long, value_enum, default_value = "tilt", hide_possible_values = true)]
    pub detrend: DetrendArgument,
    /// The surface repeats itself at its borders: no window
    #[arg(long)]
    pub periodic: bool,
    /// Wavelength down to which the spectrum continues as a power law
    ///
    /// Default: the spectrum ends at the last resolved wave.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub continue_to: Option<f64>,
    /// Radius of the tip, as 10nm: gives the reliability cut-off
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub tip_radius: Option<f64>,
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

impl ReadingArguments {
    fn options(&self) -> ReadOptions {
        ReadOptions {
            unit: self.unit,
            height_unit: self.height_unit,
            convention: None,
            spacing: self.spacing,
            missing: if self.interpolate { Missing::Interpolate } else { Missing::Refuse },
            channel: self.channel,
        }
    }

    fn read(&self, file: &Path) -> Result<Topography, CliError> {
        let refused = |error| CliError::named(path_name(file), error);
        let surface = read(file, &self.options()).map_err(refused)?;
        if self.resample { surface.resampled().map_err(refused) } else { Ok(surface) }
    }
}

impl AnalysisArguments {
    fn options(&self) -> Options {
        Options {
            detrend: match self.detrend {
                DetrendArgument::None => Detrend::None,
                DetrendArgument::Mean => Detrend::Mean,
                DetrendArgument::Tilt => Detrend::Tilt,
                DetrendArgument::Curvature => Detrend::Curvature,
            },
            periodic: self.periodic,
            end: self.continue_to.map_or(End::Ends, |length| End::Continues(std::f64::consts::TAU / length)),
            tip_radius: self.tip_radius,
        }
    }
}

impl SurfaceArguments {
    /// Arguments that decide the spectra, for their table.
    fn deciding(&self) -> Vec<String> {
        let (reading, analysis) = (&self.reading, &self.analysis);
        let length = |value: Option<f64>| value.map(|value| exact_quantity(value, "m"));
        let unit = |unit: Option<Unit>| unit.map(|unit| unit.name().to_owned());
        let detrend = analysis.detrend.to_possible_value().map(|value| value.get_name().to_owned());
        let options = [
            ("--unit", unit(reading.unit)),
            ("--height-unit", unit(reading.height_unit)),
            ("--spacing", length(reading.spacing)),
            ("--channel", reading.channel.map(|channel| channel.to_string())),
            ("--detrend", detrend),
            ("--continue-to", length(analysis.continue_to)),
        ];
        let flags = [
            ("--interpolate", reading.interpolate),
            ("--resample", reading.resample),
            ("--periodic", analysis.periodic),
        ];
        let options =
            options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?])).flatten();
        let flags = flags.into_iter().filter(|(_, is_given)| *is_given).map(|(name, _)| name.to_owned());
        let destination = self.output.folder();
        let file = |file: &PathBuf| named_from(&file.to_string_lossy(), &self.folder, destination);
        options.chain(flags).chain(["--".to_owned()]).chain(self.files.iter().map(file)).collect()
    }

    /// Hashes of the files for a table.
    fn hashes(&self) -> Result<Vec<MeasuredHash>, MeasuredHashError> {
        let files: Vec<_> = self.files.iter().map(|file| file.to_string_lossy()).collect();
        let names = files.iter().map(|file| &**file);
        MeasuredHash::of_files(names, &self.folder, self.output.folder())
    }

    /// Files as they are opened.
    fn paths(&self) -> impl Iterator<Item = PathBuf> + '_ {
        self.files.iter().map(|file| self.folder.join(file))
    }
}

/// Reads and analyses the files and writes the results.
pub(super) fn surface(arguments: &SurfaceArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(arguments.format, FORMATS, Format::Text)?;
    arguments.output.check()?;
    if let Some(scene) = &arguments.scene {
        check_scene(arguments)?;
        check_writable(scene, arguments.force_scene)?;
    }
    let (mut surfaces, mut files) = (Vec::new(), Vec::new());
    for file in arguments.paths() {
        let surface = arguments.reading.read(&file)?;
        files.push(SurfaceFile::new(file, &surface));
        surfaces.push(surface);
    }
    let analysis = analysed(arguments, &surfaces)?;
    let modulus = arguments.analysis.modulus;
    let contact = modulus.map(|modulus| SurfaceContact { modulus, work: arguments.work });
    if let (Some(path), Some(modulus)) = (&arguments.scene, modulus) {
        let scene = scene(arguments, path, &analysis, modulus)?;
        let document = Document::from_scene(&scene, &path_name(path))?;
        write_new(path, arguments.force_scene, |out| out.write_all(document.text().as_bytes()))?;
    }
    if format.picture().is_some() {
        let names: Vec<String> = files.iter().map(|file| path_name(&file.path)).collect();
        let figure = Spectra::of_analysis(&analysis).figure(&names.join(", "));
        return arguments.output.write_figure(stdout, &figure, format);
    }
    if let Some(format) = format.table() {
        let provenance = Provenance::of_spectra(&arguments.deciding()).with_hashes(&arguments.hashes()?);
        let write = |out: &mut dyn Write| write_surface_table(out, format, &provenance, &analysis);
        return arguments.output.write(stdout, write);
    }
    let adhesion = match modulus.filter(|_| arguments.work.is_some()) {
        Some(modulus) => Some(adhesion(arguments, &analysis, modulus)?),
        None => None,
    };
    let adhesion = adhesion.as_ref();
    arguments.output.write(stdout, |out| match format {
        Format::Json => write_surface_json(out, &files, &analysis, contact, adhesion),
        _ => out.write_all(surface_text(&files, &analysis, contact, adhesion).as_bytes()),
    })
}

fn analysed(arguments: &SurfaceArguments, surfaces: &[Topography]) -> Result<Analysis, CliError> {
    analyse(surfaces, &arguments.analysis.options()).map_err(|error| {
        let index = match &error {
            SpectrumError::Surface { index, .. } | SpectrumError::TooFew { index, .. } => *index,
            _ => 0,
        };
        let file = arguments.paths().nth(index).map_or_else(String::new, |file| path_name(&file));
        CliError::named(file, error)
    })
}

/// A scene names one file and holds its unit and how its spectrum is estimated; whatever else was chosen would be lost.
fn check_scene(arguments: &SurfaceArguments) -> Result<(), CliError> {
    let reading = &arguments.reading;
    let lost = [
        (arguments.files.len() > 1, "several files"),
        (reading.height_unit.is_some(), "--height-unit"),
        (reading.spacing.is_some(), "--spacing"),
        (reading.interpolate, "--interpolate"),
        (reading.resample, "--resample"),
        (reading.channel.is_some(), "--channel"),
    ];
    match lost.into_iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(CliError::LostInScene { option }),
        None => Ok(()),
    }
}

/// Adhesion of the equivalent line, computed where that was asked for or takes but seconds.
fn adhesion(
    arguments: &SurfaceArguments,
    analysis: &Analysis,
    modulus: f64,
) -> Result<SurfaceAdhesion, CliError> {
    let scene = scene(arguments, Path::new(""), analysis, modulus)?;
    scene.check()?;
    let unasked = (scene.numerics.points <= MOST_SPRINGS).then_some(LINES);
    let failed = |error: Box<dyn Error + Send + Sync>| {
        let file = arguments.paths().next();
        CliError::named(file.map_or_else(String::new, |file| path_name(&file)), error)
    };
    let solve = |lines: u32| {
        let line = EquivalentLine::from_spectra(vec![analysis.isotropic.clone()])?;
        Ok(MeasuredAdhesion::solve(&scene, &line, lines, threads(None))?)
    };
    let computed = arguments.lines.or(unasked).map(solve).transpose().map_err(failed)?;
    Ok(SurfaceAdhesion { scene, computed })
}

/// Scene of the equivalent line over the length of the scan, on springs that resolve its shortest wave.
fn scene(
    arguments: &SurfaceArguments,
    path: &Path,
    analysis: &Analysis,
    modulus: f64,
) -> Result<Scene, CliError> {
    let file = &arguments.files[0];
    let beside = |file: &Path| std::path::absolute(file).ok()?.parent().map(Path::to_path_buf);
    let name = match file.file_name() {
        Some(name) if beside(file) == beside(path) => PathBuf::from(name),
        _ => std::path::absolute(file)?,
    };
    let waves = analysis.length * analysis.isotropic.range()[1] / std::f64::consts::TAU;
    let points = ((SPRINGS_PER_WAVE * waves) as u64).next_power_of_two().clamp(1024, MOST_POINTS);
    Ok(Scene {
        version: *SCENE_VERSIONS.end(),
        title: format!(
            "Equivalent line of {}",
            path_name(&PathBuf::from(file.file_name().unwrap_or_default()))
        ),
        notice: String::new(),
        material: Material::effective(modulus),
        length: analysis.length,
        form: None,
        roughness: Some(Roughness::Measured {
            file: name.to_string_lossy().into_owned(),
            as_line: None,
            opposite: None,
            row: None,
            column: None,
            detrend: Some(arguments.analysis.options().detrend).filter(|detrend| *detrend != Detrend::Tilt),
            periodic: arguments.analysis.periodic,
            unit: arguments.reading.unit.map(|unit| unit.name().to_owned()).unwrap_or_default(),
            continue_to: arguments.analysis.continue_to,
            seed: 1,
        }),
        adhesion: arguments.work.map(|work| Adhesion::default().with_work(work)),
        loading: vec![arguments.preload.map_or(Leg::ToZeroForce, Leg::ToForce), Leg::ToSeparation],
        numerics: Numerics { points, ..Numerics::default() },
        observe: Vec::new(),
    })
}

/// Length above 0, m.
fn length(text: &str) -> Result<f64, String> {
    positive(text, "m")
}

/// Energy per area above 0, J/m².
fn energy(text: &str) -> Result<f64, String> {
    positive(text, "J/m²")
}

/// Force above 0, N.
fn force(text: &str) -> Result<f64, String> {
    positive(text, "N")
}

/// Pressure above 0, Pa.
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
