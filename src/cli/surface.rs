//! `asperity surface`: analyses measured surfaces and the equivalent line.

use super::error::CliError;
use super::output::{Origin, OutputArguments, check_file};
use super::progress::ProgressLine;
use super::scene::{MOST_LINES, threads};
use crate::explorer::recognition::no_surface;
use asperity_contact::Move;
use asperity_data::{parse_quantity, path_name, round_to, write_new};
use asperity_report::{Format, MeasuredFace, SurfaceFile, SurfaceReport, named_from};
use asperity_scene::stages::equivalent_springs;
use asperity_scene::{Adhesion, Document, Material, Measured, Numerics, Roughness, Scene};
use asperity_study::trust::MeasuredAdhesion;
use asperity_surface::lines::MeasuredOptions;
use asperity_surface::{EquivalentLine, Unit, analyse, read};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

const EXAMPLES: &str = "\
Examples:
  asperity surface stylus.txt --unit um
  asperity surface stylus.txt --unit um --modulus 2.7MPa --work 50mJ/m^2
  asperity surface afm.gwy --modulus 2.7MPa --work 50mJ/m^2 --preload 1mN --profiles 100
  asperity surface a.x3p b.x3p c.x3p --format json -o surface.json
  asperity surface one.sdf --opposite other.sdf --modulus 2.7MPa --work 50mJ/m^2
  asperity surface profile.csv --unit um -o spectra.csv
  asperity surface afm.gwy --tip-radius 10nm -o spectra.svg
  asperity surface profile.csv --unit um --modulus 2.7MPa --work 50mJ/m^2 --scene rough.ron

Files are profiles or maps: text in columns or as a matrix, SDF, GSF, NumPy, X3P, GWY, SUR,
Nanoscope or NetCDF, also compressed by gzip. Several files are samples of the same roughness. A
profile is a cut through the surface; the contact is computed on its equivalent line.

JSON is one object with statistics, fit, spectra and warnings; tables and pictures hold the spectra.";

/// Number of random profiles for the adhesion force by default.
const LINES: u32 = 16;

/// Arguments of `asperity surface`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SurfaceArguments {
    /// Files of profiles or maps
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Measured surface of the opposite face: the spectra of both faces add
    #[arg(long, value_name = "FILE")]
    pub opposite: Option<PathBuf>,
    /// How files are read.
    #[command(flatten)]
    pub measured: Measured,
    /// Channel by its number, or surface of a container by its name
    #[arg(long, value_name = "NUMBER|NAME")]
    pub channel: Option<String>,
    /// Distance between points where a file states none, such as 0.5um
    ///
    /// Lengths without a unit are in --unit, here and below.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub spacing: Option<Length>,
    /// Continue the spectrum as a power law down to this wavelength
    ///
    /// Default: the spectrum ends at the last resolved wave.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub continue_to: Option<Length>,
    /// Radius of the tip, such as 10nm, for the reliability cut-off
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub tip_radius: Option<Length>,
    /// Effective modulus E*, such as 2.7MPa, for the elastic energy
    #[arg(long, value_name = "PRESSURE", value_parser = |text: &str| positive(text, "Pa"))]
    pub modulus: Option<f64>,
    /// Write a scene with the equivalent line to FILE; needs --modulus
    ///
    /// The scene names the files and contains all options of their reading and analysis.
    #[arg(long, value_name = "FILE", requires = "modulus", group = "written", verbatim_doc_comment)]
    pub scene: Option<PathBuf>,
    /// Work of adhesion, such as 50mJ/m^2, for κ and F_a; needs --modulus
    #[arg(long, value_name = "ENERGY", requires = "modulus", value_parser = |text: &str| positive(text, "J/m²"))]
    pub work: Option<f64>,
    /// Preload, such as 1mN; default: turned at zero force
    #[arg(long, value_name = "FORCE", requires = "modulus", value_parser = |text: &str| positive(text, "N"))]
    pub preload: Option<f64>,
    /// Random profiles of the adhesion force; needs --work
    ///
    /// Each is solved on the fitted spectrum and on one moved within its uncertainty, for the
    /// spread over profiles and the spread by the fit. Default: 16 up to 131 072 springs, else
    /// none.
    #[arg(long = "profiles", value_name = "COUNT", requires = "work", value_parser = clap::value_parser!(u32).range(2..=MOST_LINES), verbatim_doc_comment)]
    pub lines: Option<u32>,
    /// Output file.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// A length as the user types it.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// Number in m, or without a unit in the unit of `--unit`.
    value: f64,
    has_unit: bool,
}

impl SurfaceArguments {
    /// The length given with an option, in m.
    fn in_metres(&self, option: &str, length: Option<Length>) -> Result<Option<f64>, CliError> {
        match (length, self.measured.unit.parse::<Unit>().ok()) {
            (Some(Length { value, has_unit: true }), _) => Ok(Some(value)),
            (Some(Length { value, .. }), Some(unit)) => Ok(Some(unit.to_metres(value))),
            (None, _) => Ok(None),
            (Some(_), None) => Err(CliError::named(
                option,
                "a length without a unit; allowed: a unit, such as 0.5um, or --unit um",
            )),
        }
    }

    /// The measured surfaces with all options; the files are named as on the command line.
    fn surfaces(&self) -> Result<Measured, CliError> {
        let continue_to = self.in_metres("--continue-to", self.continue_to)?;
        if let Some(length) = continue_to.filter(|length| !(1e-15..=10.0).contains(length)) {
            return Err(CliError::named(
                format!("--continue-to: {length:e} m"),
                "allowed: from 1e-15 to 10 m",
            ));
        }
        let name = |file: &PathBuf| file.to_string_lossy().into_owned();
        let mut files = self.files.iter().map(name);
        let number = self.channel.as_ref().and_then(|channel| channel.parse::<u32>().ok());
        Ok(Measured {
            channel: number.map(u64::from),
            surface_name: self.channel.clone().filter(|_| number.is_none()),
            file: files.next().unwrap_or_default(),
            further_files: files.collect(),
            opposite: self.opposite.as_ref().map(name),
            spacing: self.in_metres("--spacing", self.spacing)?,
            continue_to,
            ..self.measured.clone()
        })
    }

    /// Returns an error for an output file that is one of the measured files, even with `--force`: it could not be measured
    /// again.
    fn check_outputs(&self) -> Result<(), CliError> {
        let place = |file: &Path| file.canonicalize().ok();
        let outputs: Vec<PathBuf> =
            [self.output.file(), self.scene.as_deref()].into_iter().flatten().filter_map(place).collect();
        let mut files = self.files.iter().chain(&self.opposite);
        match files.find(|file| place(file).is_some_and(|file| outputs.contains(&file))) {
            Some(file) => Err(CliError::named(
                path_name(file),
                "the output would replace this measured file; allowed: another name",
            )),
            None => Ok(()),
        }
    }

    /// Options of reading and analysing the files.
    ///
    /// # Errors
    /// A length without a unit, and a wavelength out of its range.
    pub fn options(&self) -> Result<MeasuredOptions, CliError> {
        let mut options = self.surfaces()?.options();
        options.spectrum.tip_radius = self.in_metres("--tip-radius", self.tip_radius)?;
        Ok(options)
    }

    /// The faces with their files read and analysed: that of the files, and an opposite one.
    ///
    /// # Errors
    /// As for [`SurfaceArguments::options`], and a file that cannot be read or analysed.
    pub fn faces(&self) -> Result<Vec<MeasuredFace>, CliError> {
        let options = self.options()?;
        let opposite = self.opposite.as_ref().map(std::slice::from_ref);
        std::iter::once(&self.files[..]).chain(opposite).map(|files| face(files, &options)).collect()
    }

    /// Creates a scene of the equivalent line over the length of the scan, on a body of this effective modulus, Pa; of two faces
    /// the shorter scan counts.
    ///
    /// # Errors
    /// As for [`SurfaceArguments::options`].
    pub fn scene_of(
        &self,
        modulus: f64,
        faces: &[MeasuredFace],
        line: &EquivalentLine,
    ) -> Result<Scene, CliError> {
        let measured = self.surfaces()?;
        let name = self.files.first().and_then(|file| file.file_name()).unwrap_or_default();
        let length = faces.iter().map(|face| face.analysis.length).fold(f64::INFINITY, f64::min);
        // 100 µm of 1 000 points, not 9.999999999999999e-5 m.
        let length = round_to(length, 12);
        Ok(Scene {
            title: format!("Equivalent line of {}", path_name(Path::new(name))),
            roughness: Some(Roughness::Measured(measured)),
            adhesion: self.work.map(Adhesion::by_work),
            loading: vec![self.preload.map_or(Move::ToZeroForce, Move::ToForce), Move::ToSeparation],
            numerics: Numerics { points: equivalent_springs(line, length), ..Numerics::default() },
            ..Scene::new(Material::effective(modulus), length)
        })
    }
}

pub(super) fn surface(arguments: &SurfaceArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    arguments.check_outputs()?;
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    if let Some(file) = &arguments.scene {
        check_file(file, "ron", arguments.output.force)?;
    }
    let faces = arguments.faces()?;
    let line = EquivalentLine { faces: faces.iter().map(|face| face.analysis.isotropic.clone()).collect() };
    let modulus = arguments.modulus;
    let scene = modulus.map(|modulus| arguments.scene_of(modulus, &faces, &line)).transpose()?;
    if let (Some(file), Some(scene)) = (&arguments.scene, &scene) {
        write_scene(file, scene.clone(), arguments.output.force)?;
    }
    // Adhesion is computed for text and JSON, if it is asked for or takes seconds.
    let is_asked = arguments.work.is_some() && matches!(format, Format::Text | Format::Json);
    let adhesion = scene.filter(|_| is_asked).map(|scene| {
        let scene = scene.checked()?;
        let unasked = (scene.numerics.points <= MeasuredAdhesion::MOST_SPRINGS).then_some(LINES);
        let progress = Mutex::new(Counted::default());
        let solve = |lines: u32| {
            let report = |computed: u64| count_profiles(&progress, computed, lines);
            let solved = MeasuredAdhesion::of_line(&scene, &line, lines, threads(None), &report);
            progress.lock().unwrap_or_else(PoisonError::into_inner).line.clear();
            solved
        };
        let solved = arguments.lines.or(unasked).map(solve).transpose();
        let solved = solved.map_err(|error| CliError::named(path_name(&arguments.files[0]), error))?;
        Ok::<_, CliError>((scene, solved))
    });
    let adhesion = adhesion.transpose()?;
    let files: Vec<PathBuf> = arguments.files.iter().chain(&arguments.opposite).cloned().collect();
    let report = SurfaceReport { faces, line, modulus, work: arguments.work, adhesion };
    arguments.output.write(stdout, &report, format, Origin::Files(&files))
}

/// Number of computed profiles on the terminal.
#[derive(Default)]
struct Counted {
    line: ProgressLine,
    computed: u64,
}

/// Shows the number of computed profiles, which several threads report.
fn count_profiles(progress: &Mutex<Counted>, computed: u64, lines: u32) {
    let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
    if computed > progress.computed {
        progress.computed = computed;
        progress.line.show(&format!("{computed} of {lines} random profiles"), None);
    }
}

fn face(files: &[PathBuf], options: &MeasuredOptions) -> Result<MeasuredFace, CliError> {
    let (mut surfaces, mut facts) = (Vec::new(), Vec::new());
    for file in files {
        let read = read(file, &options.reading);
        let read = read.map_err(|error| CliError::named(path_name(file), no_surface(file, &error)))?;
        facts.extend(read.iter().map(|surface| SurfaceFile::new(file.clone(), surface)));
        surfaces.extend(read);
    }
    let analysis = analyse(&surfaces, &options.spectrum).map_err(|error| {
        let file = facts.get(error.surface().unwrap_or(0));
        CliError::named(file.map(|file| path_name(&file.path)).unwrap_or_default(), error)
    })?;
    Ok(MeasuredFace { files: facts, analysis })
}

/// Writes a scene, in which the measured files are named relative to its own folder.
fn write_scene(file: &Path, mut scene: Scene, overwrite: bool) -> Result<(), CliError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    scene.rename_measured_files(|measured| {
        let measured = Path::new(measured);
        let name = measured.file_name().unwrap_or_default().to_string_lossy();
        named_from(&name, measured.parent().unwrap_or(Path::new("")), folder)
    });
    let document = Document::from_scene(&scene, &path_name(file))?;
    Ok(write_new(file, overwrite, |out| out.write_all(document.text().as_bytes()))?)
}

fn length(text: &str) -> Result<Length, String> {
    let value = positive(text, "m")?;
    Ok(Length { value, has_unit: text.trim().parse::<f64>().is_err() })
}

/// Parses a value above 0, with its unit.
fn positive(text: &str, unit: &str) -> Result<f64, String> {
    match parse_quantity(text, unit) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("allowed: above 0 {unit}")),
        Err(error) => Err(error.to_string()),
    }
}
