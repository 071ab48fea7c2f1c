//! Analysed surfaces as text and JSON, and their spectra as a table and a figure.

use crate::measured_face::{MeasuredFace, SurfaceFile};
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::spectrum_figure::{Spectra, spectrum_name, wave_numbers};
use crate::warnings::{sentences_section, warning_texts};
use asperity_contact::Move;
use asperity_data::{
    Kind, Table, Warning, format_quantity, format_range, grouped, path_name, per_cent,
};
use asperity_plot::Figure;
use asperity_scene::{CheckedScene, Governing, Scene};
use asperity_study::RegimeCounts;
use asperity_study::trust::{MeasuredAdhesion, ProfileAdhesion};
use asperity_surface::spectra::{Along, Bin, End, Node};
use asperity_surface::{
    Analysis, EquivalentLine, LineMoments, Moment, PointStatistics, ValueWithError,
};
use serde::{Serialize, Serializer};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, TAU};
use std::path::Path;

const LINE_PER_DECADE: f64 = 10.0;

const LINE: &str = "equivalent line";

/// Returns in words the median, quartiles and range of the adhesion force over random profiles that
/// replace a measured surface. Returns `None` for fewer than two profiles.
pub fn measured_adhesion_text(computed: &MeasuredAdhesion) -> Option<String> {
    let forces = computed
        .adhesion_force()
        .filter(|forces| forces.count >= 2)?;
    let fit = computed
        .fit_interval()
        .map(|fit| format!(", fit error {}", format_range(fit, 2, "N")));
    Some(format!(
        "{} profiles: {}{}",
        forces.count,
        forces.words("N"),
        fit.unwrap_or_default()
    ))
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
    /// Effective modulus E*, Pa; `None` if it is not given.
    pub modulus: Option<f64>,
    /// Work of adhesion γ, J/m²; `None` if it is not given.
    pub work: Option<f64>,
    /// Scene with the random profiles of [`Self::line`], and the adhesion computed on them. The
    /// whole is `None` if no adhesion was requested, and the second value is `None` if it was not
    /// computed.
    pub adhesion: Option<(CheckedScene, Option<MeasuredAdhesion>)>,
}

impl SurfaceReport {
    /// Returns a warning if attraction has too long a range for the summits of the surface; `None`
    /// without a modulus and a work of adhesion.
    fn of_tabor_number(&self) -> Option<Warning> {
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
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        for (number, MeasuredFace { files, analysis }) in self.faces.iter().enumerate() {
            sheet.heading(if number == 0 {
                "Measured surface"
            } else {
                "Opposite face"
            });
            files
                .iter()
                .for_each(|file| sheet.row("file", file.describe()));
            measured(&mut sheet, analysis);
            sheet.heading("Self-affine fit");
            self_affine(&mut sheet, analysis);
        }
        sheet.heading("Equivalent line");
        moments(&mut sheet, self);
        let [low, high] = self.line.range().map(|q| format_quantity(TAU / q, "m"));
        let last = |analysis: &Analysis| analysis.isotropic.range()[1];
        let analyses = self.faces.iter().map(|face| &face.analysis);
        let end = match analyses.max_by(|one, other| last(one).total_cmp(&last(other))) {
            Some(Analysis {
                end: End::Continues(_),
                ..
            }) => "continued as a power law",
            Some(Analysis {
                ends_inside: true, ..
            }) => "the spectrum ends inside the scan",
            _ => "the last resolved wave; shorter ones are left out",
        };
        sheet.row("wavelengths", format!("{low} to {high} ({end})"));
        let gradient = format_quantity(self.line.moments().rms_gradient.value * FRAC_1_SQRT_2, "1");
        let energy = 100.0 * FRAC_2_PI;
        sheet.row(
            "the profile itself",
            format!("⟨∇z⟩ = {gradient}, {energy:.0} % of e_el if used unchanged"),
        );
        if let Some((scene, computed)) = &self.adhesion {
            adhesion(&mut sheet, scene, computed.as_ref());
        }
        let mut warnings = Vec::new();
        for (number, face) in self.faces.iter().enumerate() {
            let whose = if number == 0 { "" } else { "opposite face: " };
            warnings.extend(
                face.warnings()
                    .iter()
                    .map(|warning| format!("{whose}{warning}")),
            );
        }
        warnings.extend(self.of_tabor_number().iter().map(Warning::to_string));
        sentences_section(&mut sheet, &warnings);
        Some(sheet.into_text())
    }

    /// Returns the analysis of the first body as a JSON object. Its entry `opposite` is the
    /// analysis of the opposite body.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let (first, others) = self.faces.split_first()?;
        let adhesion = self
            .adhesion
            .as_ref()
            .and_then(|(scene, computed)| Some((scene, computed.as_ref()?)));
        let adhesion = adhesion.map(|(scene, computed)| {
            let [regimes, regimes_after_zero_force] = computed.regimes();
            AdhesionJson {
                length: scene.length,
                springs: scene.numerics.points,
                preload: preload(scene),
                adhesion_force: computed
                    .adhesion_force()
                    .filter(|forces| forces.spread.is_some()),
                fit_deviation: computed.fit_deviation(),
                regimes,
                regimes_after_zero_force,
                lines: &computed.profiles,
            }
        });
        let of_first = FaceJson::new(first);
        let mut warnings = of_first.warnings;
        warnings.extend(self.of_tabor_number().iter().map(Warning::to_string));
        Some(Box::new(FaceJson {
            equivalent_line: Some(self.moments()),
            adhesion: Some(adhesion),
            opposite: others.first().map(|face| Box::new(FaceJson::new(face))),
            warnings,
            ..of_first
        }))
    }

    /// Returns a table of the spectra. A row has the name of the spectrum, a wave number in rad/m,
    /// the power spectral density in m³, and the number of averaged waves.
    fn table(&self) -> Option<Table<'_>> {
        let names = || {
            self.faces
                .iter()
                .enumerate()
                .flat_map(|(face, MeasuredFace { analysis, .. })| {
                    analysis
                        .spectra
                        .iter()
                        .map(move |(direction, bins)| (spectrum_name(face, *direction), bins))
                })
        };
        let longest = names()
            .map(|(name, _)| name.chars().count())
            .fold(LINE.len(), usize::max);
        let rows = move || {
            let row = |name, bin: &Bin| (name, bin.wave_number, bin.power, Some(bin.waves));
            let measured =
                names().flat_map(move |(name, bins)| bins.iter().map(move |bin| row(name, bin)));
            let line = wave_numbers(self.line.range(), LINE_PER_DECADE);
            measured.chain(line.map(|q| (LINE, q, self.line.power(q), None)))
        };
        let table = Table::of(rows).with("spectrum", Kind::Text(longest), |row| row.0);
        let table = table
            .real("wave_number", |row| row.1)
            .real("power", |row| row.2);
        Some(table.real("waves", |row| row.3).done())
    }

    fn figure(&self) -> Option<Figure> {
        let files = self
            .faces
            .iter()
            .flat_map(|face| &face.files)
            .filter_map(|file| file.path.file_name());
        let names: Vec<String> = files.map(|name| path_name(Path::new(name))).collect();
        let analyses: Vec<&Analysis> = self.faces.iter().map(|face| &face.analysis).collect();
        Some(Figure::of_chart(
            &names.join(", "),
            Spectra::of_faces(&analyses).chart(),
        ))
    }
}

impl SurfaceReport {
    /// Returns the moments of the equivalent line, and quantities that follow from them.
    fn moments(&self) -> [MomentRow; 6] {
        let LineMoments {
            rms_height,
            rms_gradient,
            height_gradient,
            energy_per_modulus,
            ..
        } = self.line.moments();
        let stiff = |moment: Moment| Some(moment.scaled(self.modulus?));
        let over_work = |moment: Moment| Some(moment.scaled(1.0 / self.work?));
        let energy = stiff(energy_per_modulus);
        let row = |label, key, unit, value| MomentRow {
            label,
            key,
            unit,
            value,
        };
        [
            row("rms height h", "rms_height", "m", Some(rms_height)),
            row("rms gradient ⟨∇z⟩", "rms_gradient", "1", Some(rms_gradient)),
            row(
                "e_el/E*",
                "energy_per_modulus",
                "m",
                Some(energy_per_modulus),
            ),
            row("elastic energy e_el", "elastic_energy", "J/m²", energy),
            // κ has half the relative error of h⟨∇z⟩.
            row(
                "κ",
                "kappa",
                "1",
                stiff(height_gradient).and_then(over_work).map(Moment::root),
            ),
            row(
                "e_el/γ",
                "elastic_energy_ratio",
                "1",
                energy.and_then(over_work),
            ),
        ]
    }
}

/// Moment of the equivalent line, or a quantity that follows from moments. The value is `None` if
/// it is unknown.
#[derive(Clone, Copy)]
struct MomentRow {
    label: &'static str,
    key: &'static str,
    unit: &'static str,
    value: Option<Moment>,
}

/// Returns the preload of the scene of an equivalent line in N; `None` if the loading turns at zero
/// force.
fn preload(scene: &Scene) -> Option<f64> {
    match scene.loading.first() {
        Some(Move::ToForce(force)) => Some(*force),
        _ => None,
    }
}

fn adhesion(sheet: &mut Sheet, scene: &Scene, computed: Option<&MeasuredAdhesion>) {
    sheet.heading("Adhesion of the equivalent line");
    let loading = preload(scene).map_or_else(
        || "turned at zero force (--preload presses before)".to_owned(),
        |force| format!("to {}, then pull", format_quantity(force, "N")),
    );
    sheet.row("loading", loading);
    let springs = grouped(scene.numerics.points);
    sheet.row(
        "length L",
        format!(
            "{} on {springs} springs",
            format_quantity(scene.length, "m")
        ),
    );
    let label = if preload(scene).is_some() {
        "adhesion force F_a"
    } else {
        "adhesion force F_a(F=0)"
    };
    let Some(computed) = computed else {
        return sheet.row(
            label,
            format!("not computed on {springs} springs; --profiles 16 does"),
        );
    };
    let force = measured_adhesion_text(computed);
    sheet.row(
        label,
        force.unwrap_or_else(|| "none: nothing is pulled".to_owned()),
    );
    let forces = computed.adhesion_force();
    forces
        .and_then(|forces| forces.warning("F_a"))
        .iter()
        .for_each(|warning| sheet.row("", warning));
    let count = computed.profiles.len();
    let labels = ["regimes, first touch", "regimes, zero force"];
    for (label, regimes) in labels.into_iter().zip(computed.regimes()) {
        let each = regimes
            .present()
            .map(|(name, some)| format!("{name} on {some} of {count}"));
        sheet.row(label, each.collect::<Vec<_>>().join(", ") + " profiles");
    }
}

fn self_affine(sheet: &mut Sheet, analysis: &Analysis) {
    let Some(fit) = &analysis.power_law else {
        return sheet.row("fit", "none with 0 < H < 1");
    };
    sheet.row("Hurst exponent H", with_error(fit.hurst, "1"));
    let wavelength = fit.roll_off.map(|roll_off| {
        let length = TAU / roll_off.value;
        let error = length * roll_off.error / roll_off.value;
        with_error(
            ValueWithError {
                value: length,
                error,
            },
            "m",
        )
    });
    sheet.row(
        "roll-off wavelength",
        wavelength.unwrap_or_else(|| "none found inside the scan".to_owned()),
    );
}

fn measured(sheet: &mut Sheet, analysis: &Analysis) {
    let statistics = &analysis.statistics;
    sheet.quantity("rms height Pq, Sq", statistics.rms_height, "m");
    sheet.quantity("rms slope PΔq", statistics.rms_slope, "1");
    sheet.quantity("rms gradient Sdq", statistics.rms_gradient, "1");
    sheet.quantity("skewness", statistics.skewness, "1");
    sheet.row(
        "kurtosis",
        format!("{} (3: normal)", format_quantity(statistics.kurtosis, "1")),
    );
    sheet.quantity("reliability cut-off", analysis.reliability_cutoff, "m");
}

/// Adds a table of the moments with a column for each kind of error. It omits e_el/E* if e_el is
/// known.
fn moments(sheet: &mut Sheet, report: &SurfaceReport) {
    let mut rows =
        vec![["", "value", "statistical", "method", "missing short waves"].map(str::to_owned)];
    for MomentRow {
        label,
        key,
        unit,
        value,
    } in report.moments()
    {
        let Some(moment) =
            value.filter(|_| key != "energy_per_modulus" || report.modulus.is_none())
        else {
            continue;
        };
        let share = |error: f64| per_cent(error / moment.value);
        let [statistical, method] =
            [moment.statistical, moment.method].map(|error| format!("± {}", share(error)));
        let missing = match moment.missing_short_waves {
            0.0 => "none".to_owned(),
            change => format!("up to {}", share(change)),
        };
        // As wide as the labels of the other rows.
        let (label, value) = (format!("  {label:22}"), format_quantity(moment.value, unit));
        rows.push([label, value, statistical, method, missing]);
    }
    sheet.table(&rows);
}

fn with_error(estimate: ValueWithError, unit: &str) -> String {
    let error = per_cent(estimate.error / estimate.value.abs());
    format!("{} ± {error}", format_quantity(estimate.value, unit))
}

/// JSON object of the surfaces of one face, in SI units. The object of the first face also contains
/// the results of both faces together, and the object of the opposite face.
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
    adhesion_force: Option<asperity_study::Statistics>,
    fit_deviation: Option<f64>,
    regimes: RegimeCounts,
    regimes_after_zero_force: RegimeCounts,
    lines: &'a [ProfileAdhesion],
}

fn by_key<S: Serializer>(rows: &Option<[MomentRow; 6]>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rows.iter().flatten().map(|row| (row.key, row.value)))
}

impl<'a> FaceJson<'a> {
    /// Collects the facts of one face.
    fn new(face: &'a MeasuredFace) -> Self {
        let MeasuredFace { files, analysis } = face;
        let spectrum = |(direction, bins): &'a (Along, Vec<Bin>)| SpectrumJson {
            name: spectrum_name(0, *direction),
            bins,
        };
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
            profile_spectra: analysis.spectra.iter().map(spectrum).collect(),
            ends_inside_scan: analysis.ends_inside,
            warnings: warning_texts(&face.warnings()),
            opposite: None,
        }
    }
}
