//! The table of all fields of a scene: paths, symbols, units, ranges, steps, defaults, meanings.

use serde::de::DeserializeOwned;
use std::f64::consts::FRAC_PI_2;

use super::field::Step::{Doubling, Integer, Linear, Typed};
use super::field::{FILE_NAME, Field, read_adhesion, read_form, read_roughness, read_stages, row};
use super::range::Range;
use super::range::Range::{Band, Choice, List, Text, Wavelengths, Whole};
use super::stages::{MOST_STAGES, STAGES};
use super::text::read_ron;

/// Version of the format of scene files.
pub const SCENE_VERSION: u32 = 1;

/// Largest number of springs that a scene may have.
pub const MOST_POINTS: u64 = 1 << 28;

/// Returns the description of the field at a path. Several choices may have a field at the same
/// path, such as the radius of a sphere and of a punch. Then `variant` is the name of the choice;
/// `None` means the first choice that has the field.
///
/// ```
/// let radius = asperity_scene::fields::field("form.radius", Some("Paraboloid")).unwrap();
/// assert_eq!((radius.unit, radius.allowed().as_str()), ("m", "above 0, at most 1e9 m"));
/// ```
pub fn field(path: &str, variant: Option<&str>) -> Option<&'static Field> {
    let is_of =
        |field: &Field| variant.is_none() || field.variant.is_none() || field.variant == variant;
    FIELDS
        .iter()
        .find(|field| field.path == path && is_of(field))
}

/// Returns the default value of a field.
pub(super) fn default_of<T: DeserializeOwned>(path: &str) -> T {
    let row = FIELDS
        .iter()
        .find(|field| field.path == path && !field.default.is_empty());
    row.and_then(|row| read_ron(row.default).ok())
        .expect("a row of the table with a default of this type")
}

/// Returns the fields directly inside the group or the variant at a path; an empty path is the
/// whole scene.
pub(super) fn fields_inside(
    path: &str,
    variant: Option<&str>,
) -> impl Iterator<Item = &'static Field> {
    let is_of = move |field: &Field| field.variant.is_none() || field.variant == variant;
    FIELDS
        .iter()
        .filter(move |field| field.parent() == path && is_of(field))
}

const MATERIALS: Range = Choice(&[
    "(youngs_modulus: 2.0e6, poisson_ratio: 0.5)",
    "(effective_modulus: 2.7e6)",
]);
const FORMS: Range = Choice(&[
    "Paraboloid(radius: 1.0e-3)",
    "Cone(angle: 0.1)",
    "Power(coefficient: 1.0e7, exponent: 3.0)",
    "WavySphere(radius: 1.0e-3, amplitude: 1.0e-8, wavelength: 1.0e-5)",
    "Punch(radius: 2.0e-5)",
    "Table(file: \"tip.csv\")",
]);
const ROUGHNESS: Range = Choice(&[
    "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)",
    "Measured(file: \"line.csv\")",
]);
const SWITCH: Range = Choice(&["false", "true"]);
const UNIT: Range = Text {
    least: 0,
    most: 20,
    lines: false,
};

/// Descriptions of all fields of a scene, in the order of a scene file.
// Two or three lines for a row: what it is, and what it means.
#[rustfmt::skip]
pub const FIELDS: &[Field] = &[
    row("version", Whole(SCENE_VERSION as u64, SCENE_VERSION as u64))
        .meaning("version of the scene file format"),
    row("title", Text { least: 0, most: 200, lines: false }).default("\"\"")
        .meaning("title of the scene"),
    row("notice", Text { least: 0, most: 4000, lines: true }).default("\"\"")
        .meaning("notes on the scene"),
    row("material", MATERIALS).step(Typed)
        .meaning("elastic constants"),
    row("material.youngs_modulus", Range::closed(1.0, 1e13)).quantity("Young's modulus", "E", "Pa").default("None")
        .meaning("Young's modulus, with Poisson's ratio"),
    row("material.poisson_ratio", Range::above(-1.0, 0.5)).quantity("Poisson's ratio", "ν", "1")
        .step(Linear(0.01, 0.1)).default("None")
        .meaning("Poisson's ratio; 0.5 is incompressible, as rubber"),
    row("material.effective_modulus", Range::closed(1.0, 1e13)).quantity("effective modulus", "E*", "Pa")
        .default("None").meaning("effective modulus E/(1 − ν²), in place of E and ν"),
    row("length", Range::closed(1e-9, 10.0)).quantity("apparent diameter", "L", "m")
        .meaning("width of the real contact: above a tip's contact diameter; of a pad its width, which raises F_a/F_a,max"),
    row("form", FORMS).default("None").read(read_form)
        .meaning("macroscopic shape of the rigid body; nominally flat if left out"),
    row("form.radius", Range::above(0.0, 1e9)).of("Paraboloid").quantity("radius of curvature", "R", "m")
        .meaning("radius of curvature at the apex"),
    row("form.angle", Range::between(0.0, FRAC_PI_2)).of("Cone").quantity("flank angle", "θ", "rad")
        .step(Linear(0.01, 0.1))
        .meaning("angle between flank and surface; a small angle is blunt"),
    row("form.coefficient", Range::above(0.0, 1e300)).of("Power").quantity("coefficient", "b", "m^(1−n)")
        .meaning("coefficient b of the power law b rⁿ"),
    row("form.exponent", Range::above(0.5, 100.0)).of("Power").quantity("exponent", "n", "1").step(Linear(0.1, 1.0))
        .meaning("exponent n of the power law b rⁿ"),
    row("form.radius", Range::above(0.0, 1e9)).of("WavySphere").quantity("sphere radius", "R", "m")
        .meaning("radius of curvature of the sphere without its waves"),
    row("form.amplitude", Range::above(0.0, 1e6)).of("WavySphere").quantity("wave amplitude", "A", "m")
        .meaning("amplitude A of the concentric waves A (1 − cos 2πr/λ)"),
    row("form.wavelength", Range::above(0.0, 1e9)).of("WavySphere").quantity("wavelength", "λ", "m")
        .meaning("distance λ between crests, at least four springs"),
    row("form.radius", Range::above(0.0, 5.0)).of("Punch").quantity("punch radius", "a", "m")
        .meaning("radius of the flat end; no contact outside"),
    row("form.file", FILE_NAME).of("Table").name("table of the form")
        .meaning("file with two columns: ascending radii r from 0, and depths f of a body of revolution"),
    row("form.unit", UNIT).of("Table").name("unit of the table").default("\"\"")
        .meaning("unit of the lengths if the table states none; m if empty"),
    row("roughness", ROUGHNESS).default("None").read(read_roughness)
        .meaning("roughness of the rigid body; smooth if left out"),
    row("roughness.hurst", Range::between(0.0, 1.0)).of("SelfAffine").quantity("Hurst exponent", "H", "1")
        .step(Linear(0.01, 0.1))
        .meaning("decay of the roughness towards short waves: a low H is jagged, a high H is smooth"),
    row("roughness.rms_height", Range::closed(1e-30, 100.0)).of("SelfAffine").quantity("rms height", "h", "m")
        .default("None").meaning("root mean square height of the profile"),
    row("roughness.rms_gradient", Range::closed(1e-30, 1e9)).of("SelfAffine").quantity("rms gradient", "⟨∇z⟩", "1")
        .default("None").meaning("root mean square slope, in place of the rms height"),
    row("roughness.modes", Band(1, 1 << 27)).of("SelfAffine").quantity("modes", "k", "1").default("None")
        .meaning("first and last mode, in waves per length; the last is at most points/2"),
    row("roughness.wavelengths", Wavelengths(1e-15, 10.0)).of("SelfAffine").quantity("wavelengths", "λ", "m")
        .default("None").meaning("longest and shortest wave, in place of the modes"),
    row("roughness.roll_off", Range::closed(1e-15, 10.0)).of("SelfAffine").quantity("roll-off wavelength", "λ_r", "m")
        .default("None").meaning("wavelength above which the spectrum of the surface is flat"),
    row("roughness.seed", Whole(0, u64::MAX)).of("SelfAffine").name("seed").step(Integer(1, 100))
        .meaning("seed of the random phases"),
    row("roughness.file", FILE_NAME).of("Measured").name("measured surface")
        .meaning("file of a measured profile or map"),
    row("roughness.further_files", List { of: &["\"other.txt\""], least: 0, most: 10_000 }).of("Measured")
        .name("further files of the surface").default("[]")
        .meaning("further measurements of the same face"),
    row("roughness.as_line", SWITCH).of("Measured").name("profile as line").default("false")
        .meaning("true: use the heights unchanged, as an equivalent line, which a measured cut is not; false: generate random profiles with the measured spectrum"),
    row("roughness.opposite", FILE_NAME).of("Measured").name("measured surface of the opposite face")
        .default("None")
        .meaning("file of the opposite face, whose spectrum is added"),
    row("roughness.row", Whole(1, 1 << 28)).of("Measured").name("row of the map")
        .step(Integer(1, 100)).default("None")
        .meaning("number of the row of a map that is used alone; the whole map if left out"),
    row("roughness.column", Whole(1, 1 << 28)).of("Measured").name("column of the map")
        .step(Integer(1, 100)).default("None")
        .meaning("number of the column of a map, in place of a row"),
    row("roughness.detrend", Choice(&["Nothing", "Mean", "Tilt", "Curvature"])).of("Measured")
        .name("detrending").default("None")
        .meaning("what is subtracted from the heights; by default Tilt, for a periodic surface Mean, with as_line Nothing"),
    row("roughness.periodic", SWITCH).of("Measured").name("periodic surface").default("false")
        .meaning("true: the surface repeats itself at its borders, so no window is used"),
    row("roughness.unit", UNIT).of("Measured").name("unit of the file").default("\"\"")
        .meaning("unit of the lengths if the file states none; m if empty and as_line is true"),
    row("roughness.height_unit", UNIT).of("Measured").name("unit of heights of the file").default("\"\"")
        .meaning("unit of the heights if the file states none; roughness.unit if empty"),
    row("roughness.spacing", Range::closed(1e-18, 1e9)).of("Measured").quantity("distance between points of the file", "", "m").default("None")
        .meaning("distance between points if the file states none"),
    row("roughness.interpolate", SWITCH).of("Measured").name("interpolation of missing points")
        .default("false")
        .meaning("true: missing points get heights from their neighbours; false: they are refused"),
    row("roughness.resample", SWITCH).of("Measured").name("resampling of uneven profiles").default("false")
        .meaning("true: points at uneven distances are resampled linearly"),
    row("roughness.align_rows", SWITCH).of("Measured").name("levelling of rows").default("false")
        .meaning("true: the median of each row is subtracted"),
    row("roughness.robust", SWITCH).of("Measured").name("replacement of outliers").default("false")
        .meaning("true: outliers such as spikes get heights from their neighbours"),
    row("roughness.surface_name", FILE_NAME).of("Measured").name("surface of a container").default("None")
        .meaning("name of a surface or measurement in a container"),
    row("roughness.channel", Whole(0, u32::MAX as u64)).of("Measured").name("channel of the file")
        .step(Integer(1, 10)).default("None").meaning("number of the channel of the file, from 0"),
    row("roughness.continue_to", Range::closed(1e-15, 10.0)).of("Measured").quantity("shortest wavelength", "λ_s", "m").default("None")
        .meaning("wavelength down to which the spectrum continues as a power law; by default the shortest resolved wavelength"),
    row("roughness.seed", Whole(0, u64::MAX)).of("Measured").name("seed of the equivalent line")
        .step(Integer(1, 100)).default("1").meaning("seed of the random phases of the measured spectrum"),
    row("adhesion", Choice(&["(work: 0.05)", "(kappa: 2.0)", "(elastic_energy_ratio: 0.5)"])).default("None")
        .read(read_adhesion)
        .meaning("adhesion of the surfaces, by γ, κ or e_el/γ"),
    row("adhesion.work", Range::closed(0.0, 1e6)).quantity("work of adhesion", "γ", "J/m²").default("None")
        .meaning("energy per area that opens the interface"),
    row("adhesion.closing_work", Range::closed(0.0, 1e6)).quantity("work of adhesion on closing", "γ₁", "J/m²")
        .default("None")
        .meaning("energy per area gained where the interface closes, at most adhesion.work, which is the default"),
    row("adhesion.kappa", Range::closed(1e-6, 1e6)).quantity("roughness-adhesion parameter", "κ", "1").default("None")
        .meaning("√(h⟨∇z⟩E*/γ): adhesion is strong for small κ"),
    row("adhesion.elastic_energy_ratio", Range::closed(1e-12, 1e12)).quantity("elastic energy ratio", "e_el/γ", "1")
        .default("None")
        .meaning("elastic energy that flattens the roughness over γ: adhesion is strong for small e_el/γ"),
    row("adhesion.range", Range::closed(1e-12, 1e-3)).quantity("range of attraction", "z₀", "m").default("None")
        .meaning("range of the attraction, for the Tabor number; by default 0.3 nm"),
    row("loading_stiffness", Range::closed(1e-12, 1e12)).quantity("loading stiffness", "k", "N/m").default("None")
        .meaning("stiffness of the instrument that moves the body; rigid if left out"),
    row("loading", List { of: &STAGES, least: 1, most: MOST_STAGES }).default("[ToZeroForce, ToSeparation]")
        .read(read_stages)
        .meaning("stages in their order; the body starts separated"),
    row("numerics", Range::Group).default("()")
        .meaning("resolution and method of the computation"),
    row("numerics.points", Whole(1, MOST_POINTS)).quantity("points", "N", "1").step(Doubling).default("16384")
        .meaning("number of springs along the profile"),
    row("numerics.solver", Choice(&["Exact", "Stepwise(step: 1.0e-9)"])).name("solver").default("Exact")
        .meaning("exact solver, or relaxation step by step, as Popov and Filippov (2012) do"),
    row("numerics.solver.step", Range::closed(1e-30, 1e6)).of("Stepwise").quantity("step", "Δd", "m")
        .meaning("displacement between two relaxations"),
    row("numerics.edges", Choice(&["Grid", "SubCell"])).name("edges").default("SubCell")
        .meaning("SubCell: the edge of a patch may lie between two springs; Grid: a patch is a number of whole springs"),
    row("numerics.samples", Whole(2, 1_000_000)).name("samples").step(Doubling).default("512")
        .meaning("points of the force curve on each stage"),
    row("observe", List { of: &["Fragments", "HeightHistogram"], least: 0, most: 2 }).default("[]")
        .meaning("quantities that are recorded beside the force curve"),
];

#[cfg(test)]
mod tests {
    use super::super::field::LEG_FIELDS;
    use super::*;
    use asperity_data::parse_quantity;

    #[test]
    fn every_number_is_typed_with_its_unit() {
        for field in FIELDS {
            let text = format!("1 {}", if field.unit == "1" { "" } else { field.unit });
            assert_eq!(parse_quantity(&text, field.unit), Ok(1.0), "{}", field.path);
        }
    }

    fn all() -> impl Iterator<Item = &'static Field> {
        FIELDS.iter().chain(LEG_FIELDS)
    }

    #[test]
    fn every_field_has_a_name_of_its_own_and_a_meaning() {
        let mut names: Vec<_> = all().map(|field| field.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all().count());
        assert!(all().all(|field| !field.name.is_empty() && !field.meaning.is_empty()));
    }
}
