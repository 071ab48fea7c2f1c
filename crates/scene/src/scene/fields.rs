//! The table of all fields of a scene: paths, symbols, units, ranges, steps, defaults, meanings.

use std::f64::consts::FRAC_PI_2;

use super::adhesion::{Adhesion, RoughnessParameter, Strength};
use super::defaults;
use super::field::Step::{Doubling, Integer, Linear, Typed};
use super::field::{
    FILE_NAME, Field, TABLE, read_adhesion, read_form, read_roughness, read_stages, row,
    sphere_field,
};
use super::measured::Measured;
use super::model::{MaterialRelaxation, Roughness, SCENE_VERSION, Solver};
use super::range::Range;
use super::range::Range::{Band, Choice, List, Text, Wavelengths, Whole};
use super::slot::{Place, place};
use super::stages::{MOST_STAGES, STAGES};
use asperity_surface::Form;

/// Largest number of springs that a scene may have.
pub const MOST_POINTS: u64 = 1 << 28;

/// Returns the description of the field at a path; `None` if there is no such field.
///
/// Several choices may have a field at the same path, such as the radius of a sphere and of a
/// punch. `variant` is then the name of the choice. If `variant` is `None`, the first choice that
/// has the field counts. Each sphere of a form has fields of its own, such as `form.1.radius`.
///
/// ```
/// let radius = asperity_scene::fields::field("form.radius", Some("Paraboloid")).unwrap();
/// assert_eq!((radius.unit, radius.allowed().as_str()), ("m", "above 0, at most 1e9 m"));
/// ```
pub fn field(path: &str, variant: Option<&str>) -> Option<&'static Field> {
    FIELDS
        .iter()
        .filter(|field| field.path == path)
        .find(|field| variant.is_none() || field.variant.is_none() || field.variant == variant)
        .or_else(|| sphere_field(path))
}

/// Returns the fields directly inside the group or the variant at a path. An empty path means the
/// whole scene.
pub(super) fn fields_inside(
    path: &str,
    variant: Option<&str>,
) -> impl Iterator<Item = &'static Field> {
    FIELDS
        .iter()
        .filter(move |field| field.parent() == path)
        .filter(move |field| field.variant.is_none() || field.variant == variant)
}

const MATERIALS: Range = Choice(&[
    "(youngs_modulus: 2.0e6, poisson_ratio: 0.5)",
    "(modulus: 2.7e6)",
]);
const RELAXATIONS: Range = Choice(&["(share: 0.2, time: 10.0)"]);
const FORMS: Range = Choice(&[
    "Paraboloid(radius: 1.0e-3)",
    "Cone(angle: 0.1)",
    "Power(coefficient: 1.0e7, exponent: 3.0)",
    "WavySphere(radius: 1.0e-3, amplitude: 1.0e-8, wavelength: 1.0e-5)",
    "RoundedCone(radius: 2.0e-8, angle: 0.35)",
    "Punch(radius: 2.0e-5)",
    "Spheres([(radius: 5.0e-6), (radius: 3.0e-6, behind: 2.0e-7)])",
    "Table(file: \"tip.csv\")",
]);
const ROUGHNESS: Range = Choice(&[
    "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)",
    "Measured(file: \"line.csv\")",
]);
const FURTHER_FILES: Range = List {
    of: &["\"other.txt\""],
    least: 0,
    most: 10_000,
};
const ADHESIONS: Range = Choice(&[
    "(work: 0.05)",
    "(kappa: 2.0)",
    "(elastic_energy_ratio: 0.5)",
]);
const OBSERVERS: Range = List {
    of: &["Patches", "HeightHistogram"],
    least: 0,
    most: 2,
};
const SWITCH: Range = Choice(&["false", "true"]);
const UNIT: Range = Text {
    least: 0,
    most: 20,
    lines: false,
};

/// Makes the `Place` of a number of a form, the field of the variant `$form` in which it is stored.
macro_rules! form {
    ($form:ident, $member:ident) => {
        place!(form, Some(Form::$form { $member, .. }) => $member).of(stringify!($form))
    };
}

/// Makes the `Place` of a value of a self-affine roughness, the field in which it is stored.
macro_rules! self_affine {
    ($member:ident) => {
        place!(roughness, Some(Roughness::SelfAffine { $member, .. }) => $member).of("SelfAffine")
    };
}

/// Makes the `Place` of a value of a measured surface, the field in which it is stored.
macro_rules! measured {
    ($member:ident) => {
        place!(roughness, Some(Roughness::Measured(Measured { $member, .. })) => $member)
            .of("Measured")
    };
}

const WORK: Place = place!(
    adhesion,
    Some(Adhesion { strength: Strength::Work { opening, .. }, .. }) => opening
);
const CLOSING_WORK: Place = place!(
    adhesion,
    Some(Adhesion { strength: Strength::Work { closing, .. }, .. }) => closing
);
const RELAXATION_SHARE: Place =
    place!(material.relaxation, Some(MaterialRelaxation { share, .. }) => share);
const RELAXATION_TIME: Place =
    place!(material.relaxation, Some(MaterialRelaxation { time, .. }) => time);
const KAPPA: Place = place!(
    adhesion,
    Some(Adhesion { strength: Strength::Parameter(RoughnessParameter::Kappa, value), .. }) => value
);
const ELASTIC_ENERGY_RATIO: Place = place!(
    adhesion,
    Some(Adhesion {
        strength: Strength::Parameter(RoughnessParameter::ElasticEnergyRatio, value),
        ..
    }) => value
);
const ATTRACTION_RANGE: Place = place!(adhesion, Some(Adhesion { range, .. }) => range);
const SOLVER_STEP: Place =
    place!(numerics.solver, Solver::Stepwise { step } => step).of("Stepwise");

/// Descriptions of all fields of a scene, in the order of a scene file.
// A row has its path, place and range on the first line, then name, step and default, then meaning.
#[rustfmt::skip]
pub const FIELDS: &[Field] = &[
    row("version", place!(version), Whole(SCENE_VERSION as u64, SCENE_VERSION as u64))
        .meaning("version of the scene file format"),
    row("title", place!(title), Text { least: 0, most: 200, lines: false })
        .default("\"\"")
        .words("name heading")
        .meaning("title of the scene"),
    row("notice", place!(notice), Text { least: 0, most: 4000, lines: true })
        .default("\"\"")
        .words("notes comment description remark")
        .meaning("notes on the scene"),
    row("material", place!(material), MATERIALS)
        .step(Typed)
        .words("elastic elasticity stiffness rubber elastomer PDMS gel")
        .meaning("elastic constants"),
    row("material.youngs_modulus", place!(material.youngs_modulus), Range::closed(1.0, 1e13))
        .quantity("Young's modulus", "E", "Pa").default("None")
        .words("stiffness elasticity elastic hardness softness")
        .meaning("Young's modulus, with Poisson's ratio"),
    row("material.poisson_ratio", place!(material.poisson_ratio), Range::above(-1.0, 0.5))
        .quantity("Poisson's ratio", "ν", "1").step(Linear(0.01, 0.1)).default("None")
        .words("incompressible compressibility rubber")
        .meaning("Poisson's ratio; 0.5 is incompressible, as rubber"),
    row("material.modulus", place!(material.modulus), Range::closed(1.0, 1e13))
        .quantity("effective modulus", "E*", "Pa").default("None")
        .words("reduced modulus stiffness")
        .meaning("effective modulus E/(1 − ν²), in place of E and ν"),
    row("material.relaxation", place!(material.relaxation), RELAXATIONS)
        .name("relaxation").default("None")
        .words("viscoelastic viscoelasticity creep time dependent standard linear solid Maxwell dashpot rate")
        .meaning("fall of the modulus with time; elastic if left out"),
    row("material.relaxation.share", RELAXATION_SHARE, Range::closed(0.0, 0.99))
        .quantity("share that relaxes", "s", "1").step(Linear(0.01, 0.1))
        .meaning("share of the modulus that relaxes: E* falls to E* (1 − s) after a long time"),
    row("material.relaxation.time", RELAXATION_TIME, Range::closed(1e-12, 1e12))
        .quantity("relaxation time", "τ", "s")
        .meaning("time in which the relaxing part of the modulus falls to 1/e"),
    row("length", place!(length), Range::closed(1e-9, 10.0))
        .quantity("apparent diameter", "L", "m")
        .words("size width patch diameter domain system scan sample")
        .meaning("width of the real contact: above a tip's contact diameter; of a pad its \
                  width, which raises F_a/F_a,max"),
    row("form", place!(form), FORMS)
        .default("None").read(read_form)
        .words("shape geometry tip probe indenter sphere cone punch flat")
        .meaning("macroscopic shape of the rigid body; nominally flat if left out"),
    row("form.radius", form!(Paraboloid, radius), Range::above(0.0, 1e9))
        .quantity("radius of curvature", "R", "m")
        .meaning("radius of curvature at the apex"),
    row("form.angle", form!(Cone, angle), Range::between(0.0, FRAC_PI_2))
        .quantity("flank angle", "θ", "rad").step(Linear(0.01, 0.1))
        .meaning("angle between flank and surface; a small angle is blunt"),
    row("form.coefficient", form!(Power, coefficient), Range::above(0.0, 1e300))
        .quantity("coefficient", "b", "m^(1−n)")
        .meaning("coefficient b of the power law b rⁿ"),
    row("form.exponent", form!(Power, exponent), Range::above(0.5, 100.0))
        .quantity("exponent", "n", "1").step(Linear(0.1, 1.0))
        .meaning("exponent n of the power law b rⁿ"),
    row("form.radius", form!(WavySphere, radius), Range::above(0.0, 1e9))
        .quantity("sphere radius", "R", "m")
        .meaning("radius of curvature of the sphere without its waves"),
    row("form.amplitude", form!(WavySphere, amplitude), Range::above(0.0, 1e6))
        .quantity("wave amplitude", "A", "m")
        .meaning("amplitude A of the concentric waves A (1 − cos 2πr/λ)"),
    row("form.wavelength", form!(WavySphere, wavelength), Range::above(0.0, 1e9))
        .quantity("wavelength", "λ", "m")
        .meaning("distance λ between crests, at least four springs"),
    row("form.radius", form!(RoundedCone, radius), Range::above(0.0, 1e9))
        .quantity("apex radius", "R", "m")
        .meaning("radius of curvature of the rounded apex, which is tangent to the cone"),
    row("form.angle", form!(RoundedCone, angle), Range::between(0.0, FRAC_PI_2))
        .quantity("flank angle of the rounded cone", "θ", "rad").step(Linear(0.01, 0.1))
        .meaning("angle between flank and surface; of a pyramid that of the cone with the same \
                  cross section"),
    row("form.radius", form!(Punch, radius), Range::above(0.0, 5.0))
        .quantity("punch radius", "a", "m")
        .meaning("radius of the flat end; no contact outside"),
    row("form.file", form!(Table, file), TABLE)
        .name("table of the form")
        .meaning("file with two columns: ascending radii r from 0, and depths f of a body of \
                  revolution; or the rows in place of a name, data:,0 0;1e-6 2e-8"),
    row("form.unit", form!(Table, unit), UNIT)
        .name("unit of the table").default("\"\"")
        .meaning("unit of the lengths if the table states none; m if empty"),
    row("roughness", place!(roughness), ROUGHNESS)
        .default("None").read(read_roughness)
        .words("topography texture asperities measured surface file AFM profilometer")
        .meaning("roughness of the rigid body; smooth if left out"),
    row("roughness.hurst", self_affine!(hurst), Range::between(0.0, 1.0))
        .quantity("Hurst exponent", "H", "1").step(Linear(0.01, 0.1))
        .words("fractal dimension self-affine")
        .meaning("decay of the roughness towards short waves: a low H is jagged, a high H is \
                  smooth"),
    row("roughness.rms_height", self_affine!(rms_height), Range::closed(1e-30, 100.0))
        .quantity("rms height", "h", "m").default("None")
        .words("Rq Sq RMS roughness amplitude standard deviation")
        .meaning("root mean square height of the profile"),
    row("roughness.rms_gradient", self_affine!(rms_gradient), Range::closed(1e-30, 1e9))
        .quantity("rms gradient", "⟨∇z⟩", "1").default("None")
        .words("slope steepness Rdq Sdq")
        .meaning("root mean square slope, in place of the rms height"),
    row("roughness.modes", self_affine!(modes), Band(1, 1 << 27))
        .quantity("modes", "k", "1").default("None")
        .words("wave numbers bandwidth cutoff cut-off frequency")
        .meaning("first and last mode, in waves per length; the last is at most points/2"),
    row("roughness.wavelengths", self_affine!(wavelengths), Wavelengths(1e-15, 10.0))
        .quantity("wavelengths", "λ", "m").default("None")
        .words("waves bandwidth cutoff cut-off shortest longest")
        .meaning("longest and shortest wave, in place of the modes"),
    row("roughness.roll_off", self_affine!(roll_off), Range::closed(1e-15, 10.0))
        .quantity("roll-off wavelength", "λ_r", "m").default("None")
        .words("plateau corner cutoff cut-off")
        .meaning("wavelength above which the spectrum of the surface is flat"),
    row("roughness.seed", self_affine!(seed), Whole(0, u64::MAX))
        .name("seed").step(Integer(1, 100))
        .words("random realisation realization noise phases number")
        .meaning("seed of the random phases"),
    row("roughness.file", measured!(file), FILE_NAME)
        .name("measured surface")
        .meaning("file of a measured profile or map"),
    row("roughness.further_files", measured!(further_files), FURTHER_FILES)
        .name("further files of the surface").default("[]")
        .meaning("further measurements of the same face"),
    row("roughness.as_line", measured!(as_line), SWITCH)
        .name("profile as line").default("false")
        .meaning("true: use the heights unchanged, as an equivalent line, which a measured cut \
                  is not; false: generate random profiles with the measured spectrum"),
    row("roughness.opposite", measured!(opposite), FILE_NAME)
        .name("measured surface of the opposite face").default("None")
        .meaning("file of the opposite face, whose spectrum is added"),
    row("roughness.row", measured!(row), Whole(1, 1 << 28))
        .name("row of the map").step(Integer(1, 100)).default("None")
        .meaning("number of the row of a map that is used alone; the whole map if left out"),
    row("roughness.column", measured!(column), Whole(1, 1 << 28))
        .name("column of the map").step(Integer(1, 100)).default("None")
        .meaning("number of the column of a map, in place of a row"),
    row("roughness.detrend", measured!(detrend), Choice(&["Nothing", "Mean", "Tilt", "Curvature"]))
        .name("detrending").default("None")
        .words("levelling form removal tilt")
        .meaning("what is subtracted from the heights; by default Tilt, for a periodic surface \
                  Mean, with as_line Nothing"),
    row("roughness.periodic", measured!(periodic), SWITCH)
        .name("periodic surface").default("false")
        .meaning("true: the surface repeats itself at its borders, so no window is used"),
    row("roughness.unit", measured!(unit), UNIT)
        .name("unit of the file").default("\"\"")
        .meaning("unit of the lengths if the file states none; m if empty and as_line is true"),
    row("roughness.height_unit", measured!(height_unit), UNIT)
        .name("unit of heights of the file").default("\"\"")
        .meaning("unit of the heights if the file states none; roughness.unit if empty"),
    row("roughness.spacing", measured!(spacing), Range::closed(1e-18, 1e9))
        .quantity("distance between points of the file", "", "m").default("None")
        .meaning("distance between points if the file states none"),
    row("roughness.interpolate", measured!(interpolate), SWITCH)
        .name("interpolation of missing points").default("false")
        .meaning("true: missing points get heights from their neighbours; false: they are refused"),
    row("roughness.resample", measured!(resample), SWITCH)
        .name("resampling of uneven profiles").default("false")
        .meaning("true: points at uneven distances are resampled linearly"),
    row("roughness.align_rows", measured!(align_rows), SWITCH)
        .name("levelling of rows").default("false")
        .meaning("true: the median of each row is subtracted"),
    row("roughness.robust", measured!(robust), SWITCH)
        .name("replacement of outliers").default("false")
        .words("spikes noise filter")
        .meaning("true: outliers such as spikes get heights from their neighbours"),
    row("roughness.surface_name", measured!(surface_name), FILE_NAME)
        .name("channel or surface by its name").default("None")
        .meaning("name of a channel or column of the file, or of a surface or measurement in a container"),
    row("roughness.channel", measured!(channel), Whole(0, u32::MAX as u64))
        .name("channel of the file").step(Integer(1, 10)).default("None")
        .meaning("number of the channel of the file, from 0"),
    row("roughness.continue_to", measured!(continue_to), Range::closed(1e-15, 10.0))
        .quantity("shortest wavelength", "λ_s", "m").default("None")
        .meaning("wavelength down to which the spectrum continues as a power law; by default \
                  the shortest resolved wavelength"),
    row("roughness.seed", measured!(seed), Whole(0, u64::MAX))
        .name("seed of the equivalent line").step(Integer(1, 100)).default(defaults::MEASURED_SEED)
        .words("random realisation realization noise phases number")
        .meaning("seed of the random phases of the measured spectrum"),
    row("adhesion", place!(adhesion), ADHESIONS)
        .default("None").read(read_adhesion)
        .words("stick sticky stickiness tack attraction van der Waals")
        .meaning("adhesion of the surfaces, by γ, κ or e_el/γ"),
    row("adhesion.work", WORK, Range::closed(0.0, 1e6))
        .quantity("work of adhesion", "γ", "J/m²").default("None")
        .words("surface energy interfacial energy Dupré tack sticky stickiness")
        .meaning("energy per area that opens the interface"),
    row("adhesion.closing_work", CLOSING_WORK, Range::closed(0.0, 1e6))
        .quantity("work of adhesion on closing", "γ₁", "J/m²").default("None")
        .words("adhesion hysteresis")
        .meaning("energy per area gained where the interface closes, at most adhesion.work, \
                  which is the default"),
    row("adhesion.kappa", KAPPA, Range::closed(1e-6, 1e6))
        .quantity("roughness-adhesion parameter", RoughnessParameter::Kappa.symbol(), "1")
        .default("None")
        .meaning("√(h⟨∇z⟩E*/γ): adhesion is strong for small κ"),
    row("adhesion.elastic_energy_ratio", ELASTIC_ENERGY_RATIO, Range::closed(1e-12, 1e12))
        .quantity("elastic energy ratio", RoughnessParameter::ElasticEnergyRatio.symbol(), "1")
        .default("None")
        .meaning("elastic energy that flattens the roughness over γ: adhesion is strong for \
                  small e_el/γ"),
    row("adhesion.range", ATTRACTION_RANGE, Range::closed(1e-12, 1e-3))
        .quantity("range of attraction", "z₀", "m").default("None")
        .words("Tabor Maugis van der Waals decay length cohesive zone")
        .meaning("range of the attraction, for the Tabor number; by default 0.3 nm"),
    row("loading_stiffness", place!(loading_stiffness), Range::closed(1e-12, 1e12))
        .quantity("loading stiffness", "k", "N/m").default("None")
        .words("cantilever spring constant compliance instrument machine AFM load cell")
        .meaning("stiffness of the instrument that moves the body; rigid if left out"),
    row("loading_speed", place!(loading_speed), Range::closed(1e-15, 1e6))
        .quantity("loading speed", "v", "m/s").default("None")
        .words("velocity rate piezo drive")
        .meaning("speed of the instrument, or of the body if it is rigid; matters with relaxation"),
    row("loading", place!(loading), List { of: &STAGES, least: 1, most: MOST_STAGES })
        .default(defaults::LOADING).read(read_stages)
        .words("preload load force cycle history protocol dwell hold pause waiting contact time")
        .meaning("stages in their order; the body starts separated"),
    row("numerics", place!(numerics), Range::Group)
        .default("()")
        .words("resolution accuracy method")
        .meaning("resolution and method of the computation"),
    row("numerics.points", place!(numerics.points), Whole(1, MOST_POINTS))
        .quantity("points", "N", "1").step(Doubling).default(defaults::POINTS)
        .words("resolution grid mesh nodes elements discretisation number of springs")
        .meaning("number of springs along the profile"),
    row("numerics.solver", place!(numerics.solver), Choice(&["Exact", "Stepwise(step: 1.0e-9)"]))
        .name("solver").default(defaults::SOLVER)
        .words("method algorithm equilibrium stepwise")
        .meaning("exact solver, or equilibrium step by step, as Popov and Filippov (2012) find it"),
    row("numerics.solver.step", SOLVER_STEP, Range::closed(1e-30, 1e6))
        .quantity("step", "Δd", "m")
        .meaning("displacement after which the stepwise solver finds equilibrium again"),
    row("numerics.edges", place!(numerics.edges), Choice(&["Grid", "SubCell"]))
        .name("edges").default(defaults::EDGES)
        .words("crack front discretisation")
        .meaning("SubCell: the edge of a patch may lie between two springs; Grid: a patch is a \
                  number of whole springs"),
    row("numerics.samples", place!(numerics.samples), Whole(2, 1_000_000))
        .name("samples").step(Doubling).default(defaults::SAMPLES)
        .words("points of the curve")
        .meaning("points of the force curve on each stage; with relaxation the steps set them"),
    row("observe", place!(observe), OBSERVERS)
        .default("[]")
        .meaning("quantities that are recorded beside the force curve"),
];

#[cfg(test)]
mod tests {
    use super::super::field::{SPHERE_FIELDS, STAGE_FIELDS};
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
        FIELDS.iter().chain(STAGE_FIELDS).chain(SPHERE_FIELDS)
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
