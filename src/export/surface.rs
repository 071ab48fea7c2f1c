//! Analysed surfaces: text for readers, JSON, and their spectra as a table and as a figure.

use super::report::{Json, Report};
use super::sheet::Sheet;
use super::spectrum_figure::{Spectra, spectrum_name, wave_numbers};
use crate::draw::Figure;
use crate::io::{Kind, Pairs, Table, object};
use crate::scene::{CheckedScene, Move, Scene, format_quantity, format_range};
use crate::spectrum::{Analysis, Bin, Direction, End, Estimate, LineMoments, Moment};
use crate::study::MeasuredAdhesion;
use crate::surface::EquivalentLine;
use crate::text::{grouped, path_name, per_cent, printable};
use crate::topography::Topography;
use serde::Serialize;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, TAU};
use std::path::{Path, PathBuf};

const LINE_PER_DECADE: f64 = 10.0;

/// Share of the squared height in long waves above which it depends on the length of the scan.
const MANY_LONG_WAVES: f64 = 0.3;

/// Number of profiles from which on the moments are as accurate as those of a map.
const MANY_PROFILES: u64 = 100;

/// Least and largest factor by which adhesion near its boundary varies between single profiles, as `docs/surfaces.md` states.
const BOUNDARY_FACTORS: [f64; 2] = [1.4, 3.3];

/// Rms gradient above which slopes are not small, and least ratio of the rms heights of two samples of one roughness: beyond both,
/// a wrong unit is likely.
const LARGEST_GRADIENT: f64 = 1.0;
const FAR_APART: f64 = 30.0;

const LINE: &str = "equivalent line";

/// A surface and its file.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFile {
    pub path: PathBuf,
    /// Name of the measurement in a container; empty for a file of its own.
    pub name: String,
    pub format: &'static str,
    /// Points of a row, and number of rows.
    pub points: [usize; 2],
    /// Lengths along and between rows, m; only the first one for a profile.
    pub lengths: [f64; 2],
    /// Columns and rows without measured points that are left out at the borders; points at the ends of a profile.
    pub cropped: [usize; 2],
    pub interpolated: usize,
}

impl SurfaceFile {
    /// Facts of a surface with evenly spaced points; lengths of others are 0.
    pub fn new(path: PathBuf, surface: &Topography) -> Self {
        let points = [surface.columns, surface.rows()];
        let spacing = surface.spacing().unwrap_or_default();
        let lengths = [0, 1].map(|axis| points[axis] as f64 * spacing[axis]);
        let (name, interpolated) = (surface.name.clone(), surface.interpolated());
        let cropped = surface.cropped.counts();
        SurfaceFile { path, name, format: surface.format, points, lengths, cropped, interpolated }
    }

    /// Name of the file, and of the measurement in a container.
    fn name(&self) -> String {
        let name =
            if self.name.is_empty() { String::new() } else { format!(" {:?}", printable(&self.name)) };
        path_name(&self.path) + &name
    }
}

/// Surfaces of one face: files that are samples of the same roughness, and their analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFace {
    pub files: Vec<SurfaceFile>,
    /// Common analysis of the files.
    pub analysis: Analysis,
}

/// Median, quartiles and range of the adhesion forces of the profiles, and the error by the fit; `None` for fewer than two.
pub fn measured_adhesion_text(computed: &MeasuredAdhesion) -> Option<String> {
    let forces = computed.adhesion_force().filter(|forces| forces.count >= 2)?;
    let fit = computed.fit_interval().map(|fit| format!(", fit error {}", format_range(fit, 2, "N")));
    Some(format!("{} profiles: {}{}", forces.count, forces.words("N"), fit.unwrap_or_default()))
}

/// Analysed surfaces of one or both faces, with the known values of their contact.
#[derive(Clone, Debug)]
pub struct SurfaceReport {
    /// The face, and the opposite one if that is rough too.
    pub faces: Vec<MeasuredFace>,
    /// Equivalent line of the faces.
    pub line: EquivalentLine,
    /// Effective modulus E*, Pa.
    pub modulus: Option<f64>,
    /// Work of adhesion γ, J/m².
    pub work: Option<f64>,
    /// Scene of the equivalent line if its adhesion is asked for, and the random profiles that were solved: none on
    /// many springs without a request.
    pub adhesion: Option<(CheckedScene, Option<MeasuredAdhesion>)>,
}

impl Report for SurfaceReport {
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        for (number, MeasuredFace { files, analysis }) in self.faces.iter().enumerate() {
            sheet.heading(if number == 0 { "Measured surface" } else { "Opposite face" });
            files.iter().for_each(|file| sheet.row("file", describe(file)));
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
            Some(Analysis { end: End::Continues(_), .. }) => "continued as a power law",
            Some(Analysis { ends_inside: true, .. }) => "the spectrum ends inside the scan",
            _ => "the last resolved wave; shorter ones are left out",
        };
        sheet.row("wavelengths", format!("{low} to {high} ({end})"));
        let gradient = format_quantity(self.line.moments().rms_gradient.value * FRAC_1_SQRT_2, "1");
        let energy = 100.0 * FRAC_2_PI;
        sheet.row(
            "the profile itself",
            format!("⟨∇z⟩ = {gradient}, {energy:.0} % of e_el if it were the line"),
        );
        if let Some((scene, computed)) = &self.adhesion {
            adhesion(&mut sheet, scene, computed.as_ref());
        }
        let warnings = self.faces.iter().enumerate().flat_map(|(number, face)| {
            let of_face =
                move |warning| if number == 0 { warning } else { format!("opposite face: {warning}") };
            warnings(face).into_iter().map(of_face)
        });
        let warnings: Vec<String> = warnings.collect();
        if !warnings.is_empty() {
            sheet.heading("Warnings");
            warnings.iter().for_each(|warning| sheet.row("", warning));
        }
        Some(sheet.into_text())
    }

    /// The opposite face is an object inside, without equivalent line and adhesion.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let (first, others) = self.faces.split_first()?;
        let line = Pairs(self.moments().map(|(_, key, _, moment)| (key, moment)));
        let adhesion = self.adhesion.as_ref().and_then(|(scene, computed)| Some((scene, computed.as_ref()?)));
        let adhesion = adhesion.map(|(scene, computed)| {
            object! {
                "length": scene.length,
                "springs": scene.numerics.points,
                "preload": preload(scene),
                "adhesion_force": computed.adhesion_force().filter(|forces| forces.spread.is_some()),
                "fit_deviation": computed.fit_deviation(),
                "regimes": computed.regimes()[0],
                "regimes_after_zero_force": computed.regimes()[1],
                "lines": &computed.profiles,
            }
        });
        let opposite = others.first().map(|face| face_json(face, None::<()>, None::<()>, None::<()>));
        Some(Box::new(face_json(first, Some(line), Some(adhesion), opposite)))
    }

    /// Spectra: kind, wave number in rad/m, power in m³, waves averaged (if any).
    fn table(&self) -> Option<Table<'_>> {
        let names = || {
            self.faces.iter().enumerate().flat_map(|(face, MeasuredFace { analysis, .. })| {
                analysis.spectra.iter().map(move |(direction, bins)| (spectrum_name(face, *direction), bins))
            })
        };
        let longest = names().map(|(name, _)| name.chars().count()).fold(LINE.len(), usize::max);
        let rows = move || {
            let row = |name, bin: &Bin| (name, bin.wave_number, bin.power, Some(bin.waves));
            let measured = names().flat_map(move |(name, bins)| bins.iter().map(move |bin| row(name, bin)));
            let line = wave_numbers(self.line.range(), LINE_PER_DECADE);
            measured.chain(line.map(|q| (LINE, q, self.line.power(q), None)))
        };
        let table = Table::of(rows).with("spectrum", Kind::Text(longest), |row| row.0);
        let table = table.real("wave_number", |row| row.1).real("power", |row| row.2);
        Some(table.real("waves", |row| row.3).done())
    }

    fn figure(&self) -> Option<Figure> {
        let files = self.faces.iter().flat_map(|face| &face.files).filter_map(|file| file.path.file_name());
        let names: Vec<String> = files.map(|name| path_name(Path::new(name))).collect();
        let analyses: Vec<&Analysis> = self.faces.iter().map(|face| &face.analysis).collect();
        Some(Figure::of_chart(&names.join(", "), Spectra::of_faces(&analyses).chart()))
    }
}

impl SurfaceReport {
    /// Moments of the equivalent line and what follows from them: label, key, unit, and value if it is known.
    fn moments(&self) -> [(&'static str, &'static str, &'static str, Option<Moment>); 6] {
        let LineMoments { rms_height, rms_gradient, height_gradient, energy_per_modulus } =
            self.line.moments();
        let stiff = |moment: Moment| Some(moment.scaled(self.modulus?));
        let over_work = |moment: Moment| Some(moment.scaled(1.0 / self.work?));
        let energy = stiff(energy_per_modulus);
        [
            ("rms height h", "rms_height", "m", Some(rms_height)),
            ("rms gradient ⟨∇z⟩", "rms_gradient", "1", Some(rms_gradient)),
            ("e_el/E*", "energy_per_modulus", "m", Some(energy_per_modulus)),
            ("elastic energy e_el", "elastic_energy", "J/m²", energy),
            // κ has half the relative error of h⟨∇z⟩.
            ("κ", "kappa", "1", stiff(height_gradient).and_then(over_work).map(Moment::root)),
            ("e_el/γ", "elastic_energy_ratio", "1", energy.and_then(over_work)),
        ]
    }
}

/// Preload of the scene of an equivalent line, N; `None` for touch alone.
fn preload(scene: &Scene) -> Option<f64> {
    match scene.loading.first() {
        Some(Move::ToForce(force)) => Some(*force),
        _ => None,
    }
}

fn adhesion(sheet: &mut Sheet, scene: &Scene, computed: Option<&MeasuredAdhesion>) {
    sheet.heading("Adhesion of the equivalent line");
    let loading = preload(scene).map_or_else(
        || "touch without force, then pull (--preload presses before)".to_owned(),
        |force| format!("to {}, then pull", format_quantity(force, "N")),
    );
    sheet.row("loading", loading);
    let springs = grouped(scene.numerics.points);
    sheet.row("length L", format!("{} on {springs} springs", format_quantity(scene.length, "m")));
    let Some(computed) = computed else {
        return sheet
            .row("adhesion force F_a", format!("not computed on {springs} springs; --lines 16 does"));
    };
    let force = measured_adhesion_text(computed);
    sheet.row("adhesion force F_a", force.unwrap_or_else(|| "none: nothing is pulled".to_owned()));
    let forces = computed.adhesion_force();
    forces.and_then(|forces| forces.warning("F_a")).iter().for_each(|warning| sheet.row("", warning));
    let count = computed.profiles.len();
    let labels = ["regime from first touch", "regime after zero force"];
    for (label, regimes) in labels.into_iter().zip(computed.regimes()) {
        let each = regimes.present().map(|(name, some)| format!("{name} on {some} of {count}"));
        sheet.row(label, each.collect::<Vec<_>>().join(", ") + " profiles");
    }
}

fn self_affine(sheet: &mut Sheet, analysis: &Analysis) {
    let Some(fit) = &analysis.power_law else { return sheet.row("fit", "none with 0 < H < 1") };
    sheet.row("Hurst exponent H", with_error(fit.hurst, "1"));
    let wavelength = fit.roll_off.map(|roll_off| {
        let length = TAU / roll_off.value;
        let error = length * roll_off.error / roll_off.value;
        with_error(Estimate { value: length, error }, "m")
    });
    sheet.row("roll-off wavelength", wavelength.unwrap_or_else(|| "none found inside the scan".to_owned()));
}

fn describe(file: &SurfaceFile) -> String {
    let [columns, rows] = file.points;
    let length = |axis: usize| format_quantity(file.lengths[axis], "m");
    let shape = if rows > 1 {
        let (columns, rows) = (grouped(columns as u64), grouped(rows as u64));
        format!("map of {columns} × {rows} points, {} × {}", length(0), length(1))
    } else {
        format!("profile of {} points, {}", grouped(columns as u64), length(0))
    };
    let interpolated = match file.interpolated {
        0 => String::new(),
        some => format!(", {:.2} % interpolated", 100.0 * some as f64 / (columns * rows) as f64),
    };
    let counted = |(count, name): (usize, &str)| match count {
        0 => None,
        1 => Some(format!("1 {name}")),
        _ => Some(format!("{count} {name}s")),
    };
    let names = if rows > 1 { ["column", "row"] } else { ["point", ""] };
    let parts: Vec<String> = file.cropped.into_iter().zip(names).filter_map(counted).collect();
    let cropped = match &parts[..] {
        [] => String::new(),
        parts => format!(", {} without measured points left out at the border", parts.join(" and ")),
    };
    format!("{} ({}): {shape}{cropped}{interpolated}", file.name(), file.format)
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

/// Moments with their errors, a column for each kind; without e_el/E* if e_el is known.
fn moments(sheet: &mut Sheet, report: &SurfaceReport) {
    let mut rows = vec![["", "value", "statistical", "method", "missing short waves"].map(str::to_owned)];
    for (label, key, unit, moment) in report.moments() {
        let Some(moment) = moment.filter(|_| key != "energy_per_modulus" || report.modulus.is_none()) else {
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

/// Warning of an rms gradient that is not small.
pub(super) fn steep(rms_gradient: f64) -> Option<String> {
    (rms_gradient > LARGEST_GRADIENT).then(|| {
        format!(
            "the rms gradient {} is above {LARGEST_GRADIENT}, where the theory of small slopes does not hold: is the unit of \
             positions or of heights wrong? --unit and --height-unit, in a scene roughness.unit and roughness.height_unit, \
             state them",
            format_quantity(rms_gradient, "1")
        )
    })
}

/// Warning of files whose rms heights are far apart, although they are samples of one roughness.
fn far_apart(MeasuredFace { files, analysis }: &MeasuredFace) -> Option<String> {
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

/// Limits of an analysis that affect the user.
fn warnings(face: &MeasuredFace) -> Vec<String> {
    let analysis = &face.analysis;
    let mut warnings: Vec<String> =
        [steep(analysis.line.rms_gradient.value), far_apart(face)].into_iter().flatten().collect();
    if let Some(distance) = analysis.displaced {
        warnings.push(format!(
            "odd rows are displaced by {} along even ones, as trace and retrace are: the gradient is too large; give the rows \
             of one direction",
            format_quantity(distance, "m")
        ));
    }
    let long = analysis.long_wave_share();
    if long > MANY_LONG_WAVES {
        warnings.push(format!(
            "waves longer than a quarter of the scan carry {:.0} % of the squared height: rms height and elastic \
             energy depend on the length of the scan",
            100.0 * long
        ));
    }
    if analysis.maps == 0 && analysis.profiles < MANY_PROFILES {
        let [low, high] = BOUNDARY_FACTORS;
        warnings.push(format!(
            "from few profiles adhesion near its boundary is uncertain by a factor from {low} to {high}, up or down; \
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
             alone are left out of the fit"
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

fn with_error(estimate: Estimate, unit: &str) -> String {
    let error = per_cent(estimate.error / estimate.value.abs());
    format!("{} ± {error}", format_quantity(estimate.value, unit))
}

/// JSON object of the surfaces of a face in SI units. That of the first face holds the results of both faces
/// together, and the object of the opposite face.
fn face_json<'a>(
    face: &'a MeasuredFace,
    equivalent_line: Option<impl Serialize + 'a>,
    adhesion: Option<impl Serialize + 'a>,
    opposite: Option<impl Serialize + 'a>,
) -> impl Serialize + 'a {
    let MeasuredFace { files, analysis } = face;
    let (statistics, fit) = (&analysis.statistics, analysis.power_law);
    let file = |file: &'a SurfaceFile| {
        let axes = if file.points[1] > 1 { 2 } else { 1 };
        object! {
            "file": file.path.to_string_lossy(),
            "measurement"?: Some(&file.name).filter(|name| !name.is_empty()),
            "format": file.format,
            "points": &file.points[..axes],
            "lengths": &file.lengths[..axes],
            "cropped": &file.cropped[..axes],
            "interpolated": file.interpolated,
        }
    };
    let estimate = |estimate: Option<Estimate>| {
        estimate.map(|Estimate { value, error }| object! { "value": value, "error": error })
    };
    let node = |(wave_number, c2d, error)| {
        let line = analysis.isotropic.line(wave_number);
        object! { "wave_number": wave_number, "c2d": c2d, "relative_error": error, "line": line }
    };
    let spectrum = |(direction, bins): &'a (Direction, Vec<Bin>)| {
        let bin =
            |bin: &Bin| object! { "wave_number": bin.wave_number, "power": bin.power, "waves": bin.waves };
        object! { "name": spectrum_name(0, *direction), "bins": bins.iter().map(bin).collect::<Vec<_>>() }
    };
    object! {
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
        "equivalent_line"?: equivalent_line,
        "adhesion"?: adhesion,
        "spectrum": analysis.isotropic.nodes().map(node).collect::<Vec<_>>(),
        "profile_spectra": analysis.spectra.iter().map(spectrum).collect::<Vec<_>>(),
        "ends_inside_scan": analysis.ends_inside,
        "warnings": warnings(face),
        "opposite"?: opposite,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_promise_what_the_documentation_states() {
        let [low, high] = BOUNDARY_FACTORS;
        let stated = format!("by a factor from {low} to {high} either way");
        assert!(include_str!("../../docs/surfaces.md").contains(&stated), "{stated}");
    }
}
