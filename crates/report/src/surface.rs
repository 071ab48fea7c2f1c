//! Results of the analysis of measured surfaces as text and JSON, and their spectra as a table and
//! a figure.

use crate::measured_face::{MeasuredFace, SurfaceFile};
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::spectrum_figure::{Spectra, spectrum_name, wave_numbers};
use crate::warnings::sentences_section;
use crate::words::whole_percent;
use asperity_contact::Move;
use asperity_data::{
    Kind, Remedy, Table, Warning, Wording, counted, format_quantity, format_range, path_name,
    per_cent,
};
use asperity_plot::Figure;
use asperity_scene::{CheckedScene, Governing, Scene};
use asperity_study::RegimeCounts;
use asperity_study::trust::{MeasuredAdhesion, ProfileAdhesion};
use asperity_surface::spectra::{Bin, End, Node};
use asperity_surface::{Analysis, EquivalentLine, Moment, PointStatistics, ValueWithError};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, TAU};
use std::path::Path;

/// Number of points per decade of wave numbers for the equivalent line, in the table of spectra.
const LINE_PER_DECADE: f64 = 10.0;

/// Name of the spectrum of the equivalent line in the table of spectra.
const LINE: &str = "equivalent line";

/// Returns in words the median, quartiles and range of the pull-off force over random profiles with
/// the spectrum of a measured surface. Returns `None` for fewer than two profiles.
pub fn measured_adhesion_text(computed: &MeasuredAdhesion) -> Option<String> {
    let forces = computed
        .pull_off_force()
        .filter(|forces| forces.count >= 2)?;
    let fit = match computed.fit_interval() {
        Some(interval) => format!(
            "standard error of the fit {}",
            format_range(interval, 2, "N")
        ),
        None => "standard error of the fit not known".to_owned(),
    };
    let profiles = forces.count;
    let words = forces.words("N");
    Some(format!("{profiles} profiles: {words}, {fit}"))
}

/// Report on the measured surfaces of one body or of both bodies in contact, and on the adhesion of
/// this contact.
#[derive(Clone, Debug)]
pub struct SurfaceReport {
    /// Measured surfaces: one entry for the first body, and a second entry for the opposite body if
    /// it was measured too.
    pub faces: Vec<MeasuredFace>,
    /// Spectrum of the random profiles that replace the measured surfaces.
    pub line: EquivalentLine,
    /// Effective modulus E* in Pa; `None` if it is not given.
    pub modulus: Option<f64>,
    /// Work of adhesion γ in J/m²; `None` if it is not given.
    pub work: Option<f64>,
    /// Scene with the random profiles of [`Self::line`], and the adhesion computed on these
    /// profiles; `None` if the user has not asked for the adhesion. The second value is `None` if
    /// the adhesion was not computed.
    pub adhesion: Option<(CheckedScene, Option<MeasuredAdhesion>)>,
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

impl SurfaceReport {
    /// Returns a warning if the range of the attraction is too long for the radius of the summits
    /// of the surface. Returns `None` if the modulus or the work of adhesion is not given.
    fn tabor_warning(&self) -> Option<Warning> {
        let (scene, _) = self.adhesion.as_ref()?;
        let modes = self
            .line
            .modes(scene.length, scene.numerics.points as usize)
            .ok()?;
        let amplitude = self.line.amplitude_of_modes(scene.length, modes);
        let governing = Governing::of(scene, None, Some(amplitude));
        governing
            .tabor_number(scene)
            .and_then(Warning::of_tabor_number)
    }
}

impl Report for SurfaceReport {
    /// Returns the warnings about the faces (surfaces of the two bodies) and about the range of the
    /// attraction.
    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for (number, face) in self.faces.iter().enumerate() {
            let whose = if number == 0 { "" } else { "opposite face: " };
            for warning in face.warnings() {
                warnings.push(format!("{whose}{}", warning.in_words(self.wording)));
            }
        }
        warnings.extend(self.tabor_warning().iter().map(Warning::to_string));
        warnings
    }

    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        for (number, face) in self.faces.iter().enumerate() {
            let heading = if number == 0 {
                "Measured surface"
            } else {
                "Opposite face"
            };
            add_face(&mut sheet, heading, face);
        }
        sheet.heading("Equivalent line, with standard errors");
        // The user may have typed the modulus and the work of adhesion without units. Therefore the
        // report states them with their units.
        sheet.quantity("effective modulus E*", self.modulus, "Pa");
        sheet.quantity("work of adhesion γ", self.work, "J/m²");
        self.add_moments(&mut sheet);
        self.add_wavelengths(&mut sheet);
        if let Some((scene, computed)) = &self.adhesion {
            add_adhesion(&mut sheet, scene, computed.as_ref(), self.wording);
        }
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    /// Returns the analysis of the first body as a JSON object. The analysis of the opposite body,
    /// if there is one, is its entry `opposite`.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let (first, others) = self.faces.split_first()?;
        let adhesion = match &self.adhesion {
            Some((scene, Some(computed))) => Some(AdhesionJson::new(scene, computed)),
            _ => None,
        };
        let face = FaceJson::new(first, self.wording);
        let mut warnings = face.warnings;
        warnings.extend(self.tabor_warning().iter().map(Warning::to_string));
        Some(Box::new(FaceJson {
            equivalent_line: Some(self.moments()),
            adhesion: Some(adhesion),
            opposite: others
                .first()
                .map(|face| Box::new(FaceJson::new(face, self.wording))),
            warnings,
            ..face
        }))
    }

    /// Returns a table of the spectra. A row has the name of the spectrum, a wave number in rad/m,
    /// the power spectral density in m³, and the number of averaged waves.
    fn table(&self) -> Option<Table<'_>> {
        let mut longest = LINE.len();
        for (number, face) in self.faces.iter().enumerate() {
            for (direction, _) in &face.analysis.spectra {
                let name = spectrum_name(number, *direction);
                longest = longest.max(name.chars().count());
            }
        }
        let rows = self.spectrum_rows();
        let table = Table::of(move || rows.clone().into_iter())
            .with("spectrum", Kind::Text(longest), |row| row.spectrum)
            .real("wave_number", |row| row.wave_number)
            .real("power", |row| row.power)
            .real("waves", |row| row.waves);
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        let mut names = Vec::new();
        for file in self.faces.iter().flat_map(|face| &face.files) {
            if let Some(name) = file.path.file_name() {
                names.push(path_name(Path::new(name)));
            }
        }
        let analyses: Vec<&Analysis> = self.faces.iter().map(|face| &face.analysis).collect();
        let chart = Spectra::of_faces(&analyses).chart();
        Some(Figure::of_chart(&names.join(", "), chart))
    }
}

impl SurfaceReport {
    /// Returns the moments of the equivalent line, and quantities that follow from them.
    fn moments(&self) -> [MomentRow; 6] {
        let moments = self.line.moments();
        let energy = self.times_modulus(moments.energy_per_modulus);
        let stiff_height_gradient = self.times_modulus(moments.height_gradient);
        // κ is proportional to the square root of h⟨∇z⟩, so that the relative error of κ is half
        // that of h⟨∇z⟩.
        let kappa = self.over_work(stiff_height_gradient).map(Moment::root);
        [
            MomentRow {
                label: "rms height h",
                key: "rms_height",
                unit: "m",
                value: Some(moments.rms_height),
            },
            MomentRow {
                label: "rms gradient ⟨∇z⟩",
                key: "rms_gradient",
                unit: "1",
                value: Some(moments.rms_gradient),
            },
            MomentRow {
                label: "e_el/E*",
                key: "energy_per_modulus",
                unit: "m",
                value: Some(moments.energy_per_modulus),
            },
            MomentRow {
                label: "elastic energy e_el",
                key: "elastic_energy",
                unit: "J/m²",
                value: energy,
            },
            MomentRow {
                label: "κ",
                key: "kappa",
                unit: "1",
                value: kappa,
            },
            MomentRow {
                label: "e_el/γ",
                key: "elastic_energy_ratio",
                unit: "1",
                value: self.over_work(energy),
            },
        ]
    }

    /// Returns a moment multiplied by the effective modulus; `None` if the modulus is not given.
    fn times_modulus(&self, moment: Moment) -> Option<Moment> {
        Some(moment.scaled(self.modulus?))
    }

    /// Returns a moment divided by the work of adhesion; `None` if the work of adhesion is not
    /// given.
    fn over_work(&self, moment: Option<Moment>) -> Option<Moment> {
        Some(moment?.scaled(1.0 / self.work?))
    }

    /// Adds a table of the moments, with a column for each kind of error. The row of e_el/E* is
    /// left out if e_el is known.
    fn add_moments(&self, sheet: &mut Sheet) {
        let header = ["", "value", "statistical", "method", "missing short waves"];
        let mut rows = vec![header.map(String::from)];
        for row in self.moments() {
            let Some(moment) = row.value else {
                continue;
            };
            if row.key == "energy_per_modulus" && self.modulus.is_some() {
                continue;
            }
            let missing = if moment.missing_short_waves == 0.0 {
                "none".to_owned()
            } else {
                let share = per_cent(moment.missing_short_waves / moment.value);
                format!("up to {share}")
            };
            let method = if moment.method == 0.0 {
                "none".to_owned()
            } else {
                format!("± {}", per_cent(moment.method / moment.value))
            };
            rows.push([
                // The first column is as wide as the labels of the other rows of the report.
                format!("  {:22}", row.label),
                format_quantity(moment.value, row.unit),
                format!("± {}", per_cent(moment.statistical / moment.value)),
                method,
                missing,
            ]);
        }
        sheet.table(&rows);
    }

    /// Adds the range of the wavelengths of the equivalent line, the reason why the spectrum ends
    /// at short waves, and the gradient of the profile.
    fn add_wavelengths(&self, sheet: &mut Sheet) {
        let [longest, shortest] = self.line.range().map(|q| format_quantity(TAU / q, "m"));
        let end = self.end_in_words();
        sheet.row("wavelengths", format!("{longest} to {shortest} ({end})"));
        let gradient = self.line.moments().rms_gradient.value * FRAC_1_SQRT_2;
        let gradient = format_quantity(gradient, "1");
        let energy = whole_percent(FRAC_2_PI);
        sheet.row(
            "the profile itself",
            format!("⟨∇z⟩ = {gradient}, {energy} of e_el if used unchanged"),
        );
    }

    /// Returns in words how the spectrum ends at its shortest waves or continues beyond them. Of
    /// two faces (surfaces of the two bodies), the face with the shorter waves decides.
    fn end_in_words(&self) -> &'static str {
        let analyses = self.faces.iter().map(|face| &face.analysis);
        let finest = analyses.max_by(|first, second| {
            let [_, last_of_first] = first.isotropic.range();
            let [_, last_of_second] = second.isotropic.range();
            last_of_first.total_cmp(&last_of_second)
        });
        match finest {
            Some(analysis) if matches!(analysis.end, End::Continues(_)) => {
                "continued as a power law"
            }
            Some(analysis) if analysis.ends_inside => "the spectrum ends inside the scan",
            _ => "the last resolved wave; shorter ones are left out",
        }
    }

    /// Returns the rows of the table of spectra. The measured spectra come first, and then the
    /// spectrum of the equivalent line.
    fn spectrum_rows(&self) -> Vec<SpectrumRow> {
        let mut rows = Vec::new();
        for (number, face) in self.faces.iter().enumerate() {
            for (direction, bins) in &face.analysis.spectra {
                let spectrum = spectrum_name(number, *direction);
                for bin in bins {
                    rows.push(SpectrumRow {
                        spectrum,
                        wave_number: bin.wave_number,
                        power: bin.power,
                        waves: Some(bin.waves),
                    });
                }
            }
        }
        for wave_number in wave_numbers(self.line.range(), LINE_PER_DECADE) {
            rows.push(SpectrumRow {
                spectrum: LINE,
                wave_number,
                power: self.line.power(wave_number),
                waves: None,
            });
        }
        rows
    }
}

/// Row of the table of spectra.
#[derive(Clone)]
struct SpectrumRow {
    spectrum: &'static str,
    /// Wave number, rad/m.
    wave_number: f64,
    /// Power spectral density, m³.
    power: f64,
    /// Number of waves that were averaged; `None` for the equivalent line.
    waves: Option<u64>,
}

/// Moment of the equivalent line, or a quantity that follows from moments. If the quantity is not
/// known, its value is `None`.
#[derive(Clone, Copy)]
struct MomentRow {
    label: &'static str,
    key: &'static str,
    unit: &'static str,
    value: Option<Moment>,
}

/// Returns the preload in N of the scene with the equivalent line; `None` if its loading turns at
/// zero force.
fn preload(scene: &Scene) -> Option<f64> {
    let Some(Move::ToForce(force)) = scene.loading.first() else {
        return None;
    };
    Some(*force)
}

/// Adds the files of one face (surface of one body) and the results of their analysis.
fn add_face(sheet: &mut Sheet, heading: &str, face: &MeasuredFace) {
    sheet.heading(heading);
    for file in &face.files {
        sheet.row("file", file.describe());
    }
    let statistics = &face.analysis.statistics;
    sheet.quantity("rms height Pq, Sq", statistics.rms_height, "m");
    sheet.quantity("rms slope PΔq", statistics.rms_slope, "1");
    sheet.quantity("rms gradient Sdq", statistics.rms_gradient, "1");
    sheet.quantity("skewness", statistics.skewness, "1");
    let kurtosis = format_quantity(statistics.kurtosis, "1");
    sheet.row("kurtosis", format!("{kurtosis} (3: normal)"));
    let cutoff = face.analysis.reliability_cutoff;
    sheet.quantity("reliability cut-off", cutoff, "m");
    sheet.heading("Self-affine fit, with standard errors");
    add_self_affine_fit(sheet, &face.analysis);
}

fn add_self_affine_fit(sheet: &mut Sheet, analysis: &Analysis) {
    let Some(fit) = &analysis.power_law else {
        sheet.row("fit", "none with 0 < H < 1");
        return;
    };
    sheet.row("Hurst exponent H", with_error(fit.hurst, "1"));
    let wavelength = match fit.roll_off {
        Some(roll_off) => {
            let value = TAU / roll_off.value;
            let error = value * roll_off.error / roll_off.value;
            with_error(ValueWithError { value, error }, "m")
        }
        None => "none found inside the scan".to_owned(),
    };
    sheet.row("roll-off wavelength", wavelength);
}

/// Number of random profiles in the command that the report proposes for computing the adhesion.
const PROFILES: u64 = 16;

/// Adds the results on adhesion, computed with random profiles that have the spectrum of the
/// equivalent line.
fn add_adhesion(
    sheet: &mut Sheet,
    scene: &Scene,
    computed: Option<&MeasuredAdhesion>,
    wording: Wording,
) {
    sheet.heading("Adhesion of the equivalent line");
    let preload = preload(scene);
    let loading = match preload {
        Some(force) => format!("to {}, then pull", format_quantity(force, "N")),
        None => format!("turned at zero force ({})", wording(&Remedy::Preload)),
    };
    sheet.row("loading", loading);
    let length = format_quantity(scene.length, "m");
    let springs = counted(scene.numerics.points, "spring");
    sheet.row("length L", format!("{length} on {springs}"));
    let label = if preload.is_some() {
        "pull-off force F_a"
    } else {
        "pull-off force F_a(F=0)"
    };
    let Some(computed) = computed else {
        let profiles = wording(&Remedy::Profiles(PROFILES));
        let hint = format!("not computed on {springs}; {profiles} does");
        sheet.row(label, hint);
        return;
    };
    let force = measured_adhesion_text(computed);
    sheet.row(
        label,
        force.unwrap_or_else(|| "none: nothing is pulled".to_owned()),
    );
    let form = wording(&Remedy::FormOfScene);
    sheet.row("", format!("for a flat face; {form}"));
    let forces = computed.pull_off_force();
    if let Some(warning) = forces.and_then(|forces| forces.warning("F_a")) {
        sheet.row("", warning);
    }
    let profiles = computed.profiles.len();
    let [from_touch, after_zero_force] = computed.regimes();
    let regimes = regimes_in_words(from_touch, profiles);
    sheet.row("regimes, first touch", regimes);
    let regimes = regimes_in_words(after_zero_force, profiles);
    sheet.row("regimes, zero force", regimes);
}

/// Returns in words the number of profiles in each regime: `non-adhesive on 3 of 4 profiles`.
fn regimes_in_words(regimes: RegimeCounts, profiles: usize) -> String {
    let each: Vec<String> = regimes
        .present()
        .map(|(name, count)| format!("{name} on {count} of {profiles}"))
        .collect();
    each.join(", ") + " profiles"
}

/// Returns a value with its relative error as text: `0.8 ± 5 %`.
fn with_error(estimate: ValueWithError, unit: &str) -> String {
    let value = format_quantity(estimate.value, unit);
    let error = per_cent(estimate.error / estimate.value.abs());
    format!("{value} ± {error}")
}

/// JSON object of the surfaces of one face (surface of one body), in SI units. The object of the
/// first face also has the results of both faces together, and contains the object of the opposite
/// face.
#[derive(Serialize)]
struct FaceJson<'a> {
    version: &'static str,
    files: &'a [SurfaceFile],
    #[serde(flatten)]
    statistics: &'a PointStatistics,
    reliability_cutoff: Option<f64>,
    hurst_exponent: Option<ValueWithError>,
    roll_off_wave_number: Option<ValueWithError>,
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "by_key")]
    equivalent_line: Option<[MomentRow; 6]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    adhesion: Option<Option<AdhesionJson<'a>>>,
    spectrum: Vec<Node>,
    profile_spectra: Vec<SpectrumJson<'a>>,
    ends_inside_scan: bool,
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    opposite: Option<Box<FaceJson<'a>>>,
}

#[derive(Serialize)]
struct SpectrumJson<'a> {
    name: &'static str,
    bins: &'a [Bin],
}

#[derive(Serialize)]
struct AdhesionJson<'a> {
    length: f64,
    springs: u64,
    preload: Option<f64>,
    pull_off_force: Option<asperity_study::Statistics>,
    fit_deviation: Option<f64>,
    /// Number of profiles in each regime that occurs.
    regimes: BTreeMap<&'static str, usize>,
    regimes_after_zero_force: BTreeMap<&'static str, usize>,
    per_profile: &'a [ProfileAdhesion],
}

/// Writes each moment as an entry of a JSON object, with the key of its row.
fn by_key<S: Serializer>(rows: &Option<[MomentRow; 6]>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rows.iter().flatten().map(|row| (row.key, row.value)))
}

impl<'a> AdhesionJson<'a> {
    fn new(scene: &Scene, computed: &'a MeasuredAdhesion) -> Self {
        let [regimes, regimes_after_zero_force] = computed.regimes();
        AdhesionJson {
            length: scene.length,
            springs: scene.numerics.points,
            preload: preload(scene),
            pull_off_force: computed
                .pull_off_force()
                .filter(|forces| forces.spread.is_some()),
            fit_deviation: computed.fit_deviation(),
            regimes: regimes.present().collect(),
            regimes_after_zero_force: regimes_after_zero_force.present().collect(),
            per_profile: &computed.profiles,
        }
    }
}

impl<'a> FaceJson<'a> {
    /// Collects the facts of one face.
    fn new(face: &'a MeasuredFace, wording: Wording) -> Self {
        let MeasuredFace { files, analysis } = face;
        let mut profile_spectra = Vec::with_capacity(analysis.spectra.len());
        for (direction, bins) in &analysis.spectra {
            // Each face has a JSON object of its own, so that the names of its spectra need not
            // state the face.
            let name = spectrum_name(0, *direction);
            profile_spectra.push(SpectrumJson { name, bins });
        }
        FaceJson {
            version: env!("CARGO_PKG_VERSION"),
            files,
            statistics: &analysis.statistics,
            reliability_cutoff: analysis.reliability_cutoff,
            hurst_exponent: analysis.power_law.map(|fit| fit.hurst),
            roll_off_wave_number: analysis.power_law.and_then(|fit| fit.roll_off),
            equivalent_line: None,
            adhesion: None,
            spectrum: analysis.isotropic.nodes().collect(),
            profile_spectra,
            ends_inside_scan: analysis.ends_inside,
            warnings: face
                .warnings()
                .iter()
                .map(|warning| warning.in_words(wording))
                .collect(),
            opposite: None,
        }
    }
}
