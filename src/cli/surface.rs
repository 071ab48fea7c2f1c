//! `asperity surface`: analyses measured surfaces, and computes the equivalent line.

use super::advice::option;
use super::error::CliError;
use super::output::{Origin, OutputArguments, check_file};
use super::progress::{ProgressLine, Task, watched};
use super::scene::{MOST_LINES, holds_warnings, threads, warn_of};
use crate::explorer::recognition::no_surface;
use asperity_contact::Move;
use asperity_data::{Control, Remedied, Wording, parse_quantity, path_name, round_to, write_new};
use asperity_report::{Format, MeasuredFace, Report, SurfaceFile, SurfaceReport, named_from};
use asperity_scene::workload::equivalent_springs;
use asperity_scene::{Adhesion, Document, Material, Measured, Numerics, Roughness, Scene};
use asperity_study::trust::MeasuredAdhesion;
use asperity_surface::lines::MeasuredOptions;
use asperity_surface::{EquivalentLine, Unit, analyse, read};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

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
Nanoscope, NetCDF, IBW, JPK, Park TIFF, Zygo DAT or Keyence VK4, also compressed by gzip. Several
files are samples of the same roughness. A profile is a cut through the surface; the contact is
computed on its equivalent line.

JSON is one object with statistics, fit, spectra and warnings; tables and pictures hold the spectra.";

/// Number of random profiles on which the pull-off force is computed, if the user gives none.
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
    /// Channel by its number or name, or surface of a container by its name
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
    #[arg(
        long,
        value_name = "FILE",
        requires = "modulus",
        group = "written",
        verbatim_doc_comment
    )]
    pub scene: Option<PathBuf>,
    /// Work of adhesion, such as 50mJ/m^2, for κ and F_a; needs --modulus
    #[arg(long, value_name = "ENERGY", requires = "modulus", value_parser = |text: &str| positive(text, "J/m²"))]
    pub work: Option<f64>,
    /// Preload, such as 1mN; default: turned at zero force
    #[arg(long, value_name = "FORCE", requires = "modulus", value_parser = |text: &str| positive(text, "N"))]
    pub preload: Option<f64>,
    /// Random profiles of the pull-off force; needs --work
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

/// A length as the user typed it.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// Number in m. If the user typed no unit, it is a number in the unit of `--unit`.
    value: f64,
    has_unit: bool,
}

impl SurfaceArguments {
    /// Returns the length that the user has given with an option, in m.
    fn in_metres(&self, option: &str, length: Option<Length>) -> Result<Option<f64>, CliError> {
        match (length, self.measured.unit.parse::<Unit>().ok()) {
            (
                Some(Length {
                    value,
                    has_unit: true,
                }),
                _,
            ) => Ok(Some(value)),
            (Some(Length { value, .. }), Some(unit)) => Ok(Some(unit.to_metres(value))),
            (None, _) => Ok(None),
            (Some(_), None) => Err(CliError::named(
                option,
                "a length without a unit; allowed: a unit, such as 0.5um, or --unit um",
            )),
        }
    }

    /// Returns the measured surfaces with all options for reading and analysing them. The paths of
    /// the files are those on the command line.
    fn surfaces(&self) -> Result<Measured, CliError> {
        let continue_to = self.in_metres("--continue-to", self.continue_to)?;
        if let Some(length) = continue_to.filter(|length| !(1e-15..=10.0).contains(length)) {
            return Err(CliError::named(
                format!("--continue-to: {length:e} m"),
                "allowed: from 1e-15 to 10 m",
            ));
        }
        let mut files = self.files.iter().map(|file| in_unicode(file));
        let number = self
            .channel
            .as_ref()
            .and_then(|channel| channel.parse::<u32>().ok());
        Ok(Measured {
            channel: number.map(u64::from),
            surface_name: self.channel.clone().filter(|_| number.is_none()),
            file: files.next().unwrap_or_default(),
            further_files: files.collect(),
            opposite: self.opposite.as_deref().map(in_unicode),
            spacing: self.in_metres("--spacing", self.spacing)?,
            continue_to,
            ..self.measured.clone()
        })
    }

    fn task(&self) -> Result<SurfaceTask, CliError> {
        Ok(SurfaceTask {
            measured: self.surfaces()?,
            tip_radius: self.in_metres("--tip-radius", self.tip_radius)?,
            modulus: self.modulus,
            work: self.work,
            preload: self.preload,
            profiles: self.lines,
            jobs: threads(None),
            wording: option,
        })
    }

    /// Returns an error if an output file is one of the measured files. This is refused even with
    /// `--force`, because overwriting would destroy the measurement.
    fn check_outputs(&self) -> Result<(), CliError> {
        let mut outputs = Vec::new();
        for output in [self.output.file(), self.scene.as_deref()] {
            outputs.extend(output.and_then(|output| output.canonicalize().ok()));
        }
        for file in self.files.iter().chain(&self.opposite) {
            if let Ok(place) = file.canonicalize()
                && outputs.contains(&place)
            {
                let fault = "the output would replace this measured file; allowed: another name";
                return Err(CliError::named(path_name(file), fault));
            }
        }
        Ok(())
    }
}

fn in_unicode(file: &Path) -> String {
    file.to_string_lossy().into_owned()
}

/// Task to analyse a measured surface and, if requested, to compute its adhesion. The adhesion is
/// computed on the equivalent line, a profile that replaces the surface.
#[derive(Clone, Debug)]
pub struct SurfaceTask {
    /// Files of the surface, and the options for reading and analysing them.
    pub measured: Measured,
    /// Radius in m of the tip with which the surface was measured; `None` if it is unknown. It
    /// determines the reliability cut-off, beyond which the tip falsifies the measured spectrum.
    pub tip_radius: Option<f64>,
    /// Effective modulus E* in Pa; `None` if the elastic energy is not requested.
    pub modulus: Option<f64>,
    /// Work of adhesion γ in J/m²; `None` if adhesion is not requested.
    pub work: Option<f64>,
    /// Preload in N; `None` for a loading that turns at zero force.
    pub preload: Option<f64>,
    /// Number of random profiles on which the pull-off force is computed. With `None`, there are 16
    /// profiles if each of them has at most 131 072 springs, otherwise none.
    pub profiles: Option<u32>,
    /// Number of threads. The results do not depend on this number.
    pub jobs: usize,
    /// Function that states in words how the user takes a [`Remedy`](asperity_data::Remedy), a step
    /// that removes the cause of an error or a warning, such as an option of the command line.
    pub wording: Wording,
}

/// Progress of the computation of adhesion, counted in random profiles.
pub struct ComputedProfiles {
    /// Number of computed profiles.
    pub computed: u64,
    /// Number of all profiles.
    pub all: u32,
}

impl SurfaceTask {
    /// Returns the options for reading and analysing the files.
    pub fn options(&self) -> MeasuredOptions {
        let mut options = self.measured.options();
        options.spectrum.tip_radius = self.tip_radius;
        options
    }

    /// Returns the files of the surface, without the file of the opposite face.
    pub fn files(&self) -> Vec<PathBuf> {
        std::iter::once(&self.measured.file)
            .chain(&self.measured.further_files)
            .map(PathBuf::from)
            .collect()
    }

    /// Reads and analyses the files of the surface. If there is a file of the opposite face, it is
    /// read and analysed as well.
    ///
    /// # Errors
    /// Returns an error for a file that cannot be read or analysed.
    pub fn faces(&self) -> Result<Vec<MeasuredFace>, CliError> {
        let mut faces = vec![self.face(&self.files())?];
        faces.extend(self.opposite_face()?);
        Ok(faces)
    }

    /// Reads and analyses the file of the opposite face; `None` if there is no such file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or analysed.
    pub fn opposite_face(&self) -> Result<Option<MeasuredFace>, CliError> {
        let Some(file) = &self.measured.opposite else {
            return Ok(None);
        };
        self.face(&[PathBuf::from(file)]).map(Some)
    }

    /// Reads and analyses the files of one face.
    fn face(&self, files: &[PathBuf]) -> Result<MeasuredFace, CliError> {
        let options = self.options();
        let mut surfaces = Vec::new();
        let mut facts = Vec::new();
        for file in files {
            let read = read(file, &options.reading);
            let read = read.map_err(|error| {
                CliError::named(path_name(file), no_surface(file, &error, self.wording))
            })?;
            facts.extend(
                read.iter()
                    .map(|surface| SurfaceFile::new(file.clone(), surface)),
            );
            surfaces.extend(read);
        }
        let analysis = analyse(&surfaces, &options.spectrum).map_err(|error| {
            let file = facts.get(error.surface().unwrap_or(0));
            let name = file.map(|file| path_name(&file.path));
            CliError::named(name.unwrap_or_default(), error.in_words(self.wording))
        })?;
        Ok(MeasuredFace {
            files: facts,
            analysis,
        })
    }

    /// Creates a scene in which a body with the effective modulus `modulus` (in Pa) has the
    /// equivalent line, a profile that replaces the measured surface. The length of the profile is
    /// the length of the scan, or that of the shorter scan if both faces were measured.
    pub fn scene(&self, modulus: f64, faces: &[MeasuredFace], line: &EquivalentLine) -> Scene {
        let name = Path::new(&self.measured.file)
            .file_name()
            .unwrap_or_default();
        let length = faces
            .iter()
            .map(|face| face.analysis.length)
            .fold(f64::INFINITY, f64::min);
        // Rounding turns 9.999999999999999e-5 m, from 1 000 points, into 100 µm.
        let length = round_to(length, 12);
        Scene {
            title: format!("Equivalent line of {}", path_name(Path::new(name))),
            roughness: Some(Roughness::Measured(self.measured.clone())),
            adhesion: self.work.map(Adhesion::by_work),
            loading: vec![
                self.preload.map_or(Move::ToZeroForce, Move::ToForce),
                Move::ToSeparation,
            ],
            numerics: Numerics {
                points: equivalent_springs(line, length),
                ..Numerics::default()
            },
            ..Scene::new(Material::effective(modulus), length)
        }
    }

    /// Makes the report on analysed faces. If `computes_adhesion` is true and a work of adhesion is
    /// given, the adhesion is computed too, on random profiles that replace the measured surface.
    ///
    /// # Errors
    /// Returns an error for a value that a scene does not allow, if a profile cannot be computed,
    /// and if `control` stops the computation.
    pub fn report(
        &self,
        faces: Vec<MeasuredFace>,
        computes_adhesion: bool,
        mut control: Control<'_, ComputedProfiles>,
    ) -> Result<SurfaceReport, CliError> {
        let line = EquivalentLine {
            faces: faces
                .iter()
                .map(|face| face.analysis.isotropic.clone())
                .collect(),
        };
        let mut report = SurfaceReport {
            wording: self.wording,
            faces,
            line,
            modulus: self.modulus,
            work: self.work,
            adhesion: None,
        };
        let (true, Some(modulus), Some(_)) = (computes_adhesion, self.modulus, self.work) else {
            return Ok(report);
        };
        let scene = self.scene(modulus, &report.faces, &report.line).checked()?;
        let is_quick = scene.numerics.points <= MeasuredAdhesion::MOST_SPRINGS;
        let profiles = self.profiles.or(is_quick.then_some(LINES));
        let mut solved = None;
        if let Some(count) = profiles {
            let profiles_control = control.of_part().on_threads(self.jobs);
            let mut report_profile = |computed: &u64| {
                control.report(ComputedProfiles {
                    computed: *computed,
                    all: count,
                });
            };
            let profiles_control = profiles_control.reporting_to(&mut report_profile);
            let adhesion = MeasuredAdhesion::of_line(&scene, &report.line, count, profiles_control);
            let file = Path::new(&self.measured.file);
            solved =
                Some(adhesion.map_err(|error| {
                    CliError::named(path_name(file), error.in_words(self.wording))
                })?);
        }
        report.adhesion = Some((scene, solved));
        Ok(report)
    }
}

impl SurfaceTask {
    /// Reads and analyses the files, and makes the report. On a terminal, the progress is shown
    /// meanwhile.
    fn watched_report(&self, computes_adhesion: bool) -> Result<SurfaceReport, CliError> {
        let task = Task {
            name: None,
            threads: self.jobs,
            begins: "reading and analysing the files".to_owned(),
        };
        watched(
            task,
            |profiles: &ComputedProfiles, line: &mut ProgressLine| {
                let ComputedProfiles { computed, all } = profiles;
                line.show(&format!("{computed} of {all} random profiles"), None);
            },
            |control| self.report(self.faces()?, computes_adhesion, control),
        )
    }
}

pub(super) fn surface(
    arguments: &SurfaceArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    arguments.check_outputs()?;
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    if let Some(file) = &arguments.scene {
        check_file(file, "ron", arguments.output.force)?;
    }
    let task = arguments.task()?;
    // Computing the adhesion takes seconds, and only text and JSON contain the result.
    let computes_adhesion = matches!(format, Format::Text | Format::Json);
    let report = task.watched_report(computes_adhesion)?;
    if let (Some(file), Some(modulus)) = (&arguments.scene, task.modulus) {
        let scene = task.scene(modulus, &report.faces, &report.line);
        write_scene(file, scene, arguments.output.force)?;
    }
    if !holds_warnings(format) {
        let file = Path::new(arguments.files[0].file_name().unwrap_or_default());
        for warning in report.warnings() {
            warn_of(&path_name(file), &warning);
        }
    }
    let files: Vec<PathBuf> = arguments
        .files
        .iter()
        .chain(&arguments.opposite)
        .cloned()
        .collect();
    arguments
        .output
        .write(stdout, &report, format, Origin::Files(&files))
}

/// Writes a scene. The paths of its measured files are relative to the folder of the scene file.
fn write_scene(file: &Path, mut scene: Scene, overwrite: bool) -> Result<(), CliError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    scene.rename_measured_files(|measured| {
        let measured = Path::new(measured);
        let name = measured.file_name().unwrap_or_default().to_string_lossy();
        named_from(&name, measured.parent().unwrap_or(Path::new("")), folder)
    });
    let document = Document::from_scene(&scene, &path_name(file))?;
    Ok(write_new(file, overwrite, |out| {
        out.write_all(document.text().as_bytes())
    })?)
}

fn length(text: &str) -> Result<Length, String> {
    let value = positive(text, "m")?;
    Ok(Length {
        value,
        has_unit: text.trim().parse::<f64>().is_err(),
    })
}

/// Parses a positive value with its unit.
fn positive(text: &str, unit: &str) -> Result<f64, String> {
    match parse_quantity(text, unit) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("allowed: above 0 {unit}")),
        Err(error) => Err(error.to_string()),
    }
}
