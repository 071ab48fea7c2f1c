//! Analysed surfaces: text for people, JSON and CSV for programs.

use super::sheet::Sheet;
use super::spectrum_figure::{SpectrumPoint, wave_numbers};
use super::table::{Column, TableFormat, Value, write_table};
use crate::io::{object, write_json_value};
use crate::scene::{Leg, Provenance, Scene, format_quantity};
use crate::spectrum::{Analysis, Bin, Direction, End, Estimate, LineMoments};
use crate::study::MeasuredAdhesion;
use crate::text::{grouped, path_name, per_cent};
use crate::topography::Topography;
use serde_json::json;
use std::io::{self, Write};
use std::path::PathBuf;

/// Points of the equivalent line's spectrum in CSV, for each decade.
const LINE_PER_DECADE: f64 = 10.0;

/// A surface and the file it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFile {
    /// File.
    pub path: PathBuf,
    /// Format.
    pub format: &'static str,
    /// Points of a row, and rows.
    pub points: [usize; 2],
    /// Lengths along and between rows, m; of a profile the first alone.
    pub lengths: [f64; 2],
    /// Points with heights from their neighbours.
    pub interpolated: usize,
}

impl SurfaceFile {
    /// Facts of a surface with points at even distances; lengths of others are 0.
    #[must_use]
    pub fn new(path: PathBuf, surface: &Topography) -> Self {
        let points = [surface.columns(), surface.rows()];
        let spacing = surface.spacing().unwrap_or_default();
        SurfaceFile {
            path,
            format: surface.format().name(),
            points,
            lengths: [0, 1].map(|axis| points[axis] as f64 * spacing[axis]),
            interpolated: surface.interpolated(),
        }
    }

    /// One axis of a profile, two of a map.
    fn axes(&self) -> usize {
        if self.points[1] > 1 { 2 } else { 1 }
    }
}

/// Elastic and adhesive constants of a contact with the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceContact {
    /// Effective modulus E*, Pa.
    pub modulus: f64,
    /// Work of adhesion γ, J/m².
    pub work: Option<f64>,
}

impl SurfaceContact {
    /// Elastic energy of full contact, J/m².
    fn elastic_energy(self, moments: &LineMoments) -> Estimate {
        scaled(moments.energy_per_modulus, self.modulus)
    }

    /// κ = √(h⟨∇z⟩E*/γ), which has half the relative error of h⟨∇z⟩.
    fn kappa(self, moments: &LineMoments) -> Option<Estimate> {
        let product = moments.height_gradient;
        let value = (product.value * self.modulus / self.work?).sqrt();
        Some(Estimate { value, error: 0.5 * value * product.error / product.value })
    }

    /// Elastic energy of full contact over the work of adhesion.
    fn energy_ratio(self, moments: &LineMoments) -> Option<Estimate> {
        Some(scaled(self.elastic_energy(moments), 1.0 / self.work?))
    }
}

fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate { value: factor * estimate.value, error: factor * estimate.error }
}

/// Adhesion force with its spread over random profiles beside that of the fit; `None` for fewer than two forces.
#[must_use]
pub fn measured_adhesion_text(computed: &MeasuredAdhesion) -> Option<String> {
    let force = computed.adhesion_force()?;
    let mean = format_quantity(force.mean, "N");
    let lines = force.count;
    if force.mean <= 0.0 {
        return Some(format!("{mean} on all of {lines} lines"));
    }
    let share = |deviation: f64| per_cent(deviation / force.mean);
    let fit = computed.fit_deviation();
    let fit = fit.map_or_else(String::new, |fit| format!(", ± {} by the fit", share(fit)));
    Some(format!("{mean} ± {} over {lines} lines{fit}", share(force.standard_deviation)))
}

/// Adhesion of the equivalent line.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceAdhesion {
    /// Scene that is computed.
    pub scene: Scene,
    /// Its random profiles; `None` where nobody asked for so many springs.
    pub computed: Option<MeasuredAdhesion>,
}

impl SurfaceAdhesion {
    /// Preload, N; `None` for mere touch.
    fn preload(&self) -> Option<f64> {
        match self.scene.loading.first() {
            Some(Leg::ToForce(force)) => Some(*force),
            _ => None,
        }
    }

    /// Adhesion force with its spread over the profiles beside that by the fit.
    fn force(&self) -> String {
        let Some(computed) = &self.computed else {
            let springs = grouped(self.scene.numerics.points);
            return format!("not computed on {springs} springs; --lines 16 does");
        };
        measured_adhesion_text(computed).unwrap_or_else(|| "none: nothing is pulled".to_owned())
    }

    /// Rows of the text.
    fn rows(&self, sheet: &mut Sheet) {
        sheet.heading("Adhesion of the equivalent line");
        let loading = self.preload().map_or_else(
            || "touch without force, then pull (--preload presses before)".to_owned(),
            |force| format!("to {}, then pull", format_quantity(force, "N")),
        );
        sheet.row("loading", loading);
        let springs = grouped(self.scene.numerics.points);
        sheet.row("length L", format!("{} on {springs} springs", format_quantity(self.scene.length, "m")));
        sheet.row("adhesion force F_a", self.force());
        let regimes = self.computed.as_ref().map(|computed| {
            let count = computed.profiles.len();
            let each =
                computed.regimes().present().map(|(name, lines)| format!("{name} on {lines} of {count}"));
            each.collect::<Vec<_>>().join(", ")
        });
        sheet.row_of("regime", regimes.map(|regimes| regimes + " lines"));
    }

    /// Object of JSON.
    fn json(&self) -> Option<serde_json::Value> {
        let computed = self.computed.as_ref()?;
        Some(json!({
            "length": self.scene.length, "springs": self.scene.numerics.points, "preload": self.preload(),
            "adhesion_force": computed.adhesion_force(), "fit_deviation": computed.fit_deviation(),
            "regimes": computed.regimes(), "lines": computed.profiles,
        }))
    }
}

/// Analysed surfaces in plain text, with the constants of a contact and its adhesion where they are known.
#[must_use]
pub fn surface_text(
    files: &[SurfaceFile],
    analysis: &Analysis,
    contact: Option<SurfaceContact>,
    adhesion: Option<&SurfaceAdhesion>,
) -> String {
    let mut sheet = Sheet::default();
    sheet.heading("Measured surface");
    for file in files {
        sheet.row("file", describe(file));
    }
    measured(&mut sheet, analysis);
    sheet.heading("Self-affine fit");
    match &analysis.power_law {
        None => sheet.row("fit", "none converges"),
        Some(fit) => {
            sheet.row("Hurst exponent H", with_error(fit.hurst, "1"));
            let wavelength = fit.roll_off.map(|roll_off| {
                let length = std::f64::consts::TAU / roll_off.value;
                let error = length * roll_off.error / roll_off.value;
                with_error(Estimate { value: length, error }, "m")
            });
            sheet.row(
                "roll-off wavelength",
                wavelength.unwrap_or_else(|| "none found inside the scan".to_owned()),
            );
        }
    }
    sheet.heading("Equivalent line");
    line(&mut sheet, &analysis.line, contact);
    let [low, high] = analysis.isotropic.range();
    let wave = |q: f64| format_quantity(std::f64::consts::TAU / q, "m");
    let end = match analysis.end {
        End::Ends => "the last resolved wave; shorter ones are left out",
        End::Continues(_) => "continued as a power law",
    };
    sheet.row("wavelengths", format!("{} to {} ({end})", wave(low), wave(high)));
    sheet.row("accuracy", analysis.promise());
    let cut = analysis.line.of_cut();
    let energy = 100.0 * cut.energy_per_modulus.value / analysis.line.energy_per_modulus.value;
    let gradient = format_quantity(cut.rms_gradient.value, "1");
    sheet.row("a profile as the line", format!("⟨∇z⟩ = {gradient} and {energy:.0} % of the elastic energy"));
    if let Some(adhesion) = adhesion {
        adhesion.rows(&mut sheet);
    }
    let warnings = analysis.warnings();
    if !warnings.is_empty() {
        sheet.heading("Warnings");
        warnings.iter().for_each(|warning| sheet.row("", warning));
    }
    sheet.into_text()
}

fn describe(file: &SurfaceFile) -> String {
    let [columns, rows] = file.points;
    let length = |axis: usize| format_quantity(file.lengths[axis], "m");
    let shape = if rows > 1 {
        format!(
            "map of {} × {} points, {} × {}",
            grouped(columns as u64),
            grouped(rows as u64),
            length(0),
            length(1)
        )
    } else {
        format!("profile of {} points, {}", grouped(columns as u64), length(0))
    };
    let interpolated = match file.interpolated {
        0 => String::new(),
        some => format!(", {:.2} % interpolated", 100.0 * some as f64 / (columns * rows) as f64),
    };
    format!("{} ({}): {shape}{interpolated}", path_name(&file.path), file.format)
}

fn measured(sheet: &mut Sheet, analysis: &Analysis) {
    let statistics = &analysis.statistics;
    sheet.quantity("rms height Rq, Sq", statistics.rms_height, "m");
    sheet.quantity("rms slope RΔq", statistics.rms_slope, "1");
    sheet.quantity("rms gradient Sdq", statistics.rms_gradient, "1");
    sheet.quantity("skewness", statistics.skewness, "1");
    sheet.row("kurtosis", format!("{} (3: normal)", format_quantity(statistics.kurtosis, "1")));
    sheet.quantity("reliability cut-off", analysis.reliability_cutoff, "m");
}

fn line(sheet: &mut Sheet, moments: &LineMoments, contact: Option<SurfaceContact>) {
    sheet.row("rms height h", with_error(moments.rms_height, "m"));
    sheet.row("rms gradient ⟨∇z⟩", with_error(moments.rms_gradient, "1"));
    match contact {
        None => sheet.row("e_el/E*", with_error(moments.energy_per_modulus, "m")),
        Some(contact) => {
            sheet.row("elastic energy e_el", with_error(contact.elastic_energy(moments), "J/m²"));
            sheet.row_of("κ", contact.kappa(moments).map(|kappa| with_error(kappa, "1")));
            sheet.row_of("e_el/γ", contact.energy_ratio(moments).map(|ratio| with_error(ratio, "1")));
        }
    }
}

fn with_error(estimate: Estimate, unit: &str) -> String {
    let error = per_cent(estimate.error / estimate.value.abs());
    format!("{} ± {error}", format_quantity(estimate.value, unit))
}

/// Writes analysed surfaces as one JSON object in SI units.
///
/// # Errors
/// Those of `out`.
pub fn write_surface_json(
    out: &mut (impl Write + ?Sized),
    files: &[SurfaceFile],
    analysis: &Analysis,
    contact: Option<SurfaceContact>,
    adhesion: Option<&SurfaceAdhesion>,
) -> io::Result<()> {
    let (statistics, fit, moments) = (&analysis.statistics, analysis.power_law, &analysis.line);
    let file = |file: &SurfaceFile| {
        json!({
            "file": file.path.to_string_lossy(), "format": file.format, "points": &file.points[..file.axes()],
            "lengths": &file.lengths[..file.axes()], "interpolated": file.interpolated,
        })
    };
    let node = |(wave_number, c2d, error)| {
        json!({
            "wave_number": wave_number, "c2d": c2d, "relative_error": error,
            "line": analysis.isotropic.line(wave_number),
        })
    };
    let bin = |bin: &Bin| json!({"wave_number": bin.wave_number, "power": bin.power, "waves": bin.waves});
    let spectrum = |(direction, bins): &(Direction, Vec<Bin>)| {
        let bins: Vec<_> = bins.iter().map(bin).collect();
        json!({"name": direction.name(), "bins": bins})
    };
    let report = object! {
        "version": env!("CARGO_PKG_VERSION"),
        "files": files.iter().map(file).collect::<Vec<_>>(),
        "points": statistics.points,
        "rms_height": statistics.rms_height,
        "rms_slope": statistics.rms_slope,
        "rms_gradient": statistics.rms_gradient,
        "skewness": statistics.skewness,
        "kurtosis": statistics.kurtosis,
        "reliability_cutoff": analysis.reliability_cutoff,
        "hurst_exponent": estimate(fit.map(|fit| fit.hurst)),
        "roll_off_wave_number": estimate(fit.and_then(|fit| fit.roll_off)),
        "equivalent_line": json!({
            "rms_height": estimate(Some(moments.rms_height)),
            "rms_gradient": estimate(Some(moments.rms_gradient)),
            "energy_per_modulus": estimate(Some(moments.energy_per_modulus)),
            "elastic_energy": estimate(contact.map(|contact| contact.elastic_energy(moments))),
            "kappa": estimate(contact.and_then(|contact| contact.kappa(moments))),
            "elastic_energy_ratio": estimate(contact.and_then(|contact| contact.energy_ratio(moments))),
        }),
        "adhesion": adhesion.and_then(SurfaceAdhesion::json),
        "spectrum": analysis.isotropic.nodes().map(node).collect::<Vec<_>>(),
        "profile_spectra": analysis.spectra.iter().map(spectrum).collect::<Vec<_>>(),
        "accuracy": analysis.promise(),
        "warnings": analysis.warnings(),
    };
    write_json_value(out, &report)
}

fn estimate(estimate: Option<Estimate>) -> Option<serde_json::Value> {
    estimate.map(|estimate| json!({"value": estimate.value, "error": estimate.error}))
}

/// Writes spectra as a table: kind, wave number in rad/m, power in m³, waves averaged (none for the equivalent line).
///
/// # Errors
/// Those of `out`.
pub fn write_surface_table(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    analysis: &Analysis,
) -> io::Result<()> {
    let measured = analysis.spectra.iter().flat_map(|(direction, bins)| {
        bins.iter().map(|bin| (direction.name(), (bin.wave_number, bin.power), Some(bin.waves)))
    });
    let line = wave_numbers(analysis.isotropic.range(), LINE_PER_DECADE);
    let line = line.map(|q| ("equivalent line", (q, analysis.isotropic.line(q)), None));
    let rows: Vec<_> = measured.chain(line).collect();
    write_table(out, format, provenance, COLUMNS, rows.len(), rows.iter())
}

/// Name of a spectrum, point, waves averaged.
type SpectrumRow = (&'static str, SpectrumPoint, Option<u64>);

const COLUMNS: &[Column<SpectrumRow>] = &[
    Column("spectrum", Value::Word("equivalent line".len(), |(name, ..)| name)),
    Column("wave_number", Value::Real(|(_, point, _)| point.0)),
    Column("power", Value::Real(|(_, point, _)| point.1)),
    Column("waves", Value::Count(|(.., waves)| *waves)),
];
