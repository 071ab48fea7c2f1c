//! The table of all fields of a scene: paths, symbols, units, ranges, meanings, access.
//!
//! Reading and writing, checks of ranges, overrides, steps of the keys, axes of studies, the explorer's list of
//! parameters, random scenes of the tests and the reference in docs/scene-file.md are loops over this table.

use std::f64::consts::FRAC_PI_2;

use super::field::{Field, Step};
use super::model::{Edges, Move, Roughness, SCENE_VERSIONS, Scene, Solver};
use super::range::Range;
use super::value::{Access, Part, at};
use crate::surface::Form;

/// Largest number of springs.
pub const MOST_POINTS: u64 = 1 << 28;

/// The field at a path. If variants of a choice share the name, `variant` decides; with `None` the
/// first one is returned.
pub fn field(path: &str, variant: Option<&str>) -> Option<&'static Field> {
    FIELDS.iter().find(|field| {
        field.path == path && (variant.is_none() || field.variant.is_none() || field.variant == variant)
    })
}

/// Fields inside the group or choice at a path, with this variant; the top level for an empty path.
pub(super) fn fields_inside(path: &str, variant: Option<&str>) -> impl Iterator<Item = &'static Field> {
    let inside =
        move |field: &&Field| field.parent() == path && (field.variant.is_none() || field.variant == variant);
    FIELDS.iter().filter(inside)
}

/// Range of file names.
pub(super) const FILE_NAME: Range = Range::Text { least: 1, most: 4096, lines: false };

/// Every field of a scene, in the order of a scene file.
pub const FIELDS: &[Field] = &[
    at!(version)
        .range(Range::whole(*SCENE_VERSIONS.start() as u64, *SCENE_VERSIONS.end() as u64))
        .meaning("version of the scene file format"),
    at!(title)
        .range(Range::Text { least: 0, most: 200, lines: false })
        .default("\"\"")
        .meaning("title of the scene, on one line"),
    at!(notice)
        .range(Range::Text { least: 0, most: 4000, lines: true })
        .default("\"\"")
        .meaning("notes on the scene"),
    at!(material)
        .range(Range::Choice(&["(youngs_modulus: 2.0e6, poisson_ratio: 0.5)", "(effective_modulus: 2.7e6)"]))
        .step(Step::Typed)
        .meaning("elastic constants: Young's modulus with Poisson's ratio, or the effective modulus"),
    at!(material.youngs_modulus)
        .quantity("Young's modulus", "E", "Pa")
        .range(Range::closed(1.0, 1e13))
        .default("None")
        .meaning("Young's modulus of the elastic body; requires Poisson's ratio"),
    at!(material.poisson_ratio)
        .quantity("Poisson's ratio", "ν", "1")
        .range(Range::above(-1.0, 0.5))
        .step(Step::Linear { fine: 0.01, coarse: 0.1 })
        .default("None")
        .meaning("Poisson's ratio of the elastic body; 0.5 is incompressible, as rubber"),
    at!(material.effective_modulus)
        .quantity("effective modulus", "E*", "Pa")
        .range(Range::closed(1.0, 1e13))
        .default("None")
        .meaning("effective modulus E/(1 − ν²), in place of E and ν"),
    at!(length)
        .quantity("apparent diameter", "L", "m")
        .range(Range::closed(1e-9, 10.0))
        .meaning("apparent diameter of the contact: length of the profile"),
    at!(form)
        .range(Range::Choice(&[
            "Paraboloid(radius: 1.0e-3)",
            "Cone(angle: 0.1)",
            "Power(coefficient: 1.0e7, exponent: 3.0)",
            "WavySphere(radius: 1.0e-3, amplitude: 1.0e-8, wavelength: 1.0e-5)",
            "Punch(radius: 2.0e-5)",
        ]))
        .default("None")
        .meaning("macroscopic shape of the rigid body; default: nominally flat"),
    at!(form?, Form::Paraboloid.radius)
        .quantity("radius of curvature", "R", "m")
        .range(Range::above(0.0, 1e9))
        .meaning("radius of curvature of the paraboloid at its apex"),
    at!(form?, Form::Cone.angle)
        .quantity("flank angle", "θ", "rad")
        .range(Range::between(0.0, FRAC_PI_2))
        .step(Step::Linear { fine: 0.01, coarse: 0.1 })
        .meaning("angle between the flank of the cone and the surface; a small angle is blunt"),
    at!(form?, Form::Power.coefficient)
        .quantity("coefficient", "b", "m^(1−n)")
        .range(Range::above(0.0, 1e300))
        .meaning("coefficient b of the power law b rⁿ"),
    at!(form?, Form::Power.exponent)
        .quantity("exponent", "n", "1")
        .range(Range::above(0.5, 100.0))
        .step(Step::Linear { fine: 0.1, coarse: 1.0 })
        .meaning("exponent n of the power law b rⁿ; a large n is flat in the middle and steep outside"),
    at!(form?, Form::WavySphere.radius)
        .quantity("sphere radius", "R", "m")
        .range(Range::above(0.0, 1e9))
        .meaning("radius of curvature of the sphere without its waves"),
    at!(form?, Form::WavySphere.amplitude)
        .quantity("wave amplitude", "A", "m")
        .range(Range::above(0.0, 1e6))
        .meaning("amplitude A of the concentric waves A (1 − cos 2πr/λ)"),
    at!(form?, Form::WavySphere.wavelength)
        .quantity("wavelength", "λ", "m")
        .range(Range::above(0.0, 1e9))
        .meaning("distance λ from crest to crest of the waves, at least four springs"),
    at!(form?, Form::Punch.radius)
        .quantity("punch radius", "a", "m")
        .range(Range::above(0.0, 5.0))
        .meaning("radius of the flat end; no contact outside"),
    at!(roughness)
        .range(Range::Choice(&[
            "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)",
            "Measured(file: \"line.csv\")",
        ]))
        .default("None")
        .meaning("roughness of the rigid profile; default: smooth"),
    at!(roughness?, Roughness::SelfAffine.hurst)
        .quantity("Hurst exponent", "H", "1")
        .range(Range::between(0.0, 1.0))
        .step(Step::Linear { fine: 0.01, coarse: 0.1 })
        .meaning("decay of the roughness towards short waves: low H is jagged, high H is smooth; fractal dimension 3 − H"),
    at!(roughness?, Roughness::SelfAffine.rms_height)
        .quantity("rms height", "h", "m")
        .range(Range::closed(1e-30, 100.0))
        .default("None")
        .meaning("root mean square height of the profile"),
    at!(roughness?, Roughness::SelfAffine.rms_gradient)
        .quantity("rms gradient", "⟨∇z⟩", "1")
        .range(Range::closed(1e-30, 1e9))
        .default("None")
        .meaning("root mean square slope of the profile, in place of the rms height"),
    at!(roughness?, Roughness::SelfAffine.modes)
        .quantity("modes", "k", "1")
        .range(Range::Band { min: 1, max: 1 << 27 })
        .meaning("first and last mode of the profile, in waves per length; the last is at most points/2"),
    at!(roughness?, Roughness::SelfAffine.seed)
        .name("seed")
        .range(Range::whole(0, u64::MAX))
        .step(Step::Integer { fine: 1, coarse: 100 })
        .meaning("seed of the random phases: the same seed gives the same profile"),
    at!(roughness?, Roughness::Measured.file)
        .name("measured surface")
        .range(FILE_NAME)
        .meaning("file of a measured profile or map (docs/surfaces.md), relative to the scene file"),
    at!(roughness?, Roughness::Measured.further_files)
        .name("further files of the surface")
        .range(Range::List { of: &["\"other.txt\""], least: 0, most: 10_000 })
        .default("[]")
        .meaning("further files of the same face, samples of one roughness: the spectrum is estimated from all of them"),
    at!(roughness?, Roughness::Measured.as_line)
        .name("profile as line")
        .range(Range::Choice(&["false", "true"]))
        .default("None")
        .meaning("true: the measured profile is the line itself, with 29 % too little slope; false: its equivalent line is, with random phases; default: true in version 1, false in version 2"),
    at!(roughness?, Roughness::Measured.opposite)
        .name("measured surface of the opposite face")
        .range(FILE_NAME)
        .default("None")
        .meaning("file of the opposite face, relative to the scene file: the spectra of both faces add; default: smooth"),
    at!(roughness?, Roughness::Measured.row)
        .name("row of the map")
        .range(Range::whole(1, 1 << 28))
        .step(Step::Integer { fine: 1, coarse: 100 })
        .default("None")
        .meaning("row of a map that is the measured profile, from 1 on; default: the whole map"),
    at!(roughness?, Roughness::Measured.column)
        .name("column of the map")
        .range(Range::whole(1, 1 << 28))
        .step(Step::Integer { fine: 1, coarse: 100 })
        .default("None")
        .meaning("column of a map that is the measured profile, in place of a row"),
    at!(roughness?, Roughness::Measured.detrend)
        .name("detrending")
        .range(Range::Choice(&["Nothing", "Mean", "Tilt", "Curvature"]))
        .default("None")
        .meaning("part that is removed of the measured heights by least squares; default: Tilt, Mean of a periodic surface, Nothing of a profile as line"),
    at!(roughness?, Roughness::Measured.periodic)
        .name("periodic surface")
        .range(Range::Choice(&["false", "true"]))
        .default("false")
        .meaning("true: the measured surface repeats itself at its borders, and its spectrum is estimated without a window"),
    at!(roughness?, Roughness::Measured.unit)
        .name("unit of the file")
        .range(Range::Text { least: 0, most: 20, lines: false })
        .default("\"\"")
        .meaning("unit of lengths where the file states none: m, mm, um, nm; default: none, and m of a profile as line"),
    at!(roughness?, Roughness::Measured.height_unit)
        .name("unit of heights of the file")
        .range(Range::Text { least: 0, most: 20, lines: false })
        .default("\"\"")
        .meaning("unit of heights where the file states none; default: as roughness.unit"),
    at!(roughness?, Roughness::Measured.spacing)
        .quantity("distance between points of the file", "", "m")
        .range(Range::closed(1e-18, 1e9))
        .default("None")
        .meaning("distance between points where the file states none"),
    at!(roughness?, Roughness::Measured.interpolate)
        .name("interpolation of missing points")
        .range(Range::Choice(&["false", "true"]))
        .default("false")
        .meaning("true: missing points of the file get heights from their neighbours; false: they are refused"),
    at!(roughness?, Roughness::Measured.resample)
        .name("resampling of uneven profiles")
        .range(Range::Choice(&["false", "true"]))
        .default("false")
        .meaning("true: profiles with points at uneven distances are resampled linearly at the mean distance"),
    at!(roughness?, Roughness::Measured.channel)
        .name("channel of the file")
        .range(Range::whole(0, u32::MAX as u64))
        .step(Step::Integer { fine: 1, coarse: 10 })
        .default("None")
        .meaning("number of the channel of a file that has several"),
    at!(roughness?, Roughness::Measured.continue_to)
        .quantity("shortest wavelength", "λ_s", "m")
        .range(Range::closed(1e-15, 10.0))
        .default("None")
        .meaning("wavelength down to which the spectrum of the equivalent line continues as a power law; default: the last resolved one"),
    at!(roughness?, Roughness::Measured.seed)
        .name("seed of the equivalent line")
        .range(Range::whole(0, u64::MAX))
        .step(Step::Integer { fine: 1, coarse: 100 })
        .default("1")
        .meaning("seed of the random phases of the equivalent line"),
    at!(adhesion)
        .range(Range::Choice(&["(work: 0.05)", "(kappa: 2.0)", "(elastic_energy_ratio: 0.5)"]))
        .default("None")
        .meaning("adhesion of the surfaces, by work of adhesion, κ or e_el/γ; default: none"),
    at!(adhesion?.work)
        .quantity("work of adhesion", "γ", "J/m²")
        .range(Range::closed(0.0, 1e6))
        .default("None")
        .meaning("energy per unit area needed to separate the interface"),
    at!(adhesion?.closing_work)
        .quantity("work of adhesion on closing", "γ₁", "J/m²")
        .range(Range::closed(0.0, 1e6))
        .default("None")
        .meaning("energy per unit area gained where the interface closes, at most adhesion.work; default: the same"),
    at!(adhesion?.kappa)
        .quantity("roughness parameter", "κ", "1")
        .range(Range::closed(1e-6, 1e6))
        .default("None")
        .meaning("roughness-adhesion parameter sqrt(h⟨∇z⟩E*/γ): adhesion is strong for small κ"),
    at!(adhesion?.elastic_energy_ratio)
        .quantity("elastic energy ratio", "e_el/γ", "1")
        .range(Range::closed(1e-12, 1e12))
        .default("None")
        .meaning("elastic energy that pressing the bodies flat takes, over the work of adhesion: adhesion is strong for small e_el/γ"),
    at!(adhesion?.range)
        .quantity("range of attraction", "z₀", "m")
        .range(Range::closed(1e-12, 1e-3))
        .default("None")
        .meaning("range of the attraction, for the Tabor number alone; default: 0.3 nm"),
    at!(loading)
        .range(Range::List {
            of: &["ToForce(1.0e-5)", "ToIndentation(1.0e-7)", "ToTouch", "ToZeroForce", "ToSeparation"],
            least: 1,
            most: 100_000,
        })
        .default("[ToZeroForce, ToSeparation]")
        .meaning("loading stages in their order, from separation"),
    at!(numerics)
        .default("()")
        .meaning("resolution and method of the computation"),
    at!(numerics.points)
        .quantity("points", "N", "1")
        .range(Range::whole(1, MOST_POINTS))
        .step(Step::Doubling)
        .default("16384")
        .meaning("number of springs along the profile"),
    at!(numerics.solver)
        .name("solver")
        .range(Range::Choice(&["Exact", "Stepwise(step: 1.0e-9)"]))
        .default("Exact")
        .meaning("exact solver, or the stepwise relaxation of the paper"),
    at!(numerics.solver, Solver::Stepwise.step)
        .quantity("step", "Δd", "m")
        .range(Range::closed(1e-30, 1e6))
        .meaning("displacement of the body between two relaxations"),
    at!(numerics.edges)
        .name("edges")
        .range(Range::Choice(&["Grid", "SubCell"]))
        .default("SubCell")
        .meaning("edge model of the contact patches: SubCell finds edges between springs, Grid counts whole springs, as the paper and the stepwise solver do"),
    at!(numerics.samples)
        .name("samples")
        .range(Range::whole(2, 1_000_000))
        .step(Step::Doubling)
        .default("512")
        .meaning("points of the force curve on each loading stage"),
    at!(observe)
        .range(Range::List { of: &["Fragments", "HeightHistogram"], least: 0, most: 2 })
        .default("[]")
        .meaning("observed quantities beside the force curve"),
];

/// The force of a loading stage [`ToForce`](super::Move::ToForce), at `loading.0.0` for the first stage.
pub const LEG_FORCE: Field = Field::new("loading", Some("ToForce"), Access::NONE)
    .quantity("force of a stage", "F", "N")
    .range(Range::closed(-1e30, 1e30))
    .meaning("target: the stage ends where the force first reaches this value; compression is positive");

/// The indentation of a loading stage [`ToIndentation`](super::Move::ToIndentation), at `loading.0.0`
/// for the first stage.
pub const LEG_INDENTATION: Field = Field::new("loading", Some("ToIndentation"), Access::NONE)
    .quantity("indentation of a stage", "d", "m")
    .range(Range::closed(-1e6, 1e6))
    .meaning("target: the stage ends at this indentation; 0 is first touch, positive is deeper");

impl Field {
    /// Default of the field in a scene, as written; empty if the field is required.
    pub fn default_in(&self, scene: &Scene) -> &'static str {
        match (self.path, scene.numerics.solver.usual_edges()) {
            ("numerics.edges", Edges::Grid) => "Grid",
            _ => self.default,
        }
    }
}

impl Move {
    /// Field and value of the target, if the stage has a numeric target.
    pub fn field(&self) -> Option<(&'static Field, f64)> {
        match *self {
            Move::ToForce(force) => Some((&LEG_FORCE, force)),
            Move::ToIndentation(indentation) => Some((&LEG_INDENTATION, indentation)),
            Move::ToTouch | Move::ToZeroForce | Move::ToSeparation => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::document::Document;
    use super::super::model::Observer;
    use super::super::strategies::{sound, sound_scenes};
    use super::super::value::Value;
    use super::*;

    fn all() -> impl Iterator<Item = &'static Field> {
        FIELDS.iter().chain([&LEG_FORCE, &LEG_INDENTATION])
    }

    #[test]
    fn every_field_has_a_name_of_its_own_and_a_meaning() {
        let mut names: Vec<_> = all().map(|field| field.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all().count());
        for field in all() {
            assert!(!field.name.is_empty() && !field.meaning.is_empty(), "{}", field.path);
        }
    }

    static UNUSUAL: [String; 7] = [const { String::new() }; 7];

    /// A value of the field's kind that no scene has by chance.
    fn unusual(field: &Field) -> Option<Value<'static>> {
        Some(match field.range {
            Range::Real { .. } => Value::Real(0.123),
            Range::Whole { .. } => Value::Whole(12_345),
            Range::Band { .. } => Value::Band(123, 1234),
            Range::Text { .. } => Value::Text("unusual"),
            Range::List { .. } if field.path == "loading" => Value::Legs(&[Move::ToTouch; 7]),
            Range::List { .. } if field.path == "observe" => Value::Observers(&[Observer::Fragments; 7]),
            Range::List { .. } => Value::Texts(&UNUSUAL),
            Range::Choice(_) | Range::Group => return None,
        })
    }

    /// A scene for every variant of every choice.
    fn scenes_of_all_variants() -> Vec<Scene> {
        let base = Document::from_scene(&sound(), "base").unwrap();
        let all = |path: &'static str| match field(path, None).map(|field| field.range) {
            Some(Range::Choice(of)) => of.iter().map(|value| base.set(path, value).unwrap()).collect(),
            _ => Vec::new(),
        };
        let documents = ["form", "roughness", "numerics.solver"].into_iter().flat_map(all);
        documents.map(|document| document.scene().clone()).collect()
    }

    #[test]
    fn each_field_is_a_member_of_its_own() {
        let mut met = Vec::new();
        for scene in scenes_of_all_variants() {
            for field in FIELDS {
                let (Some(value), Some(before)) = (unusual(field), field.get(&scene)) else { continue };
                let mut changed = scene.clone();
                assert!(field.set(&mut changed, value) && field.get(&changed) == Some(value), "{field:?}");
                let mut others = FIELDS.iter().filter(|other| *other != field);
                assert!(others.all(|other| other.get(&changed) == other.get(&scene)), "{field:?}");
                assert!(field.set(&mut changed, before) && changed == scene, "{field:?}");
                assert!(!field.set(&mut changed, Value::Choice("Cone")) && changed == scene, "{field:?}");
                met.push((field.path, field.variant));
            }
        }
        let unmet = |field: &&Field| unusual(field).is_some() && !met.contains(&(field.path, field.variant));
        assert_eq!(FIELDS.iter().find(unmet), None);
    }

    proptest! {
        #[test]
        fn fields_together_are_the_scene(scene in sound_scenes(), other in sound_scenes()) {
            // The choices of one scene, with all other fields shared by both taken from the other.
            let mut mixed = scene.clone();
            for field in FIELDS {
                if let (Some(_), Some(value)) = (unusual(field), field.get(&other))
                    && field.get(&mixed).is_some()
                {
                    prop_assert!(field.set(&mut mixed, value), "{}", field.path);
                    prop_assert_eq!(field.get(&mixed), Some(value));
                }
            }
            for field in FIELDS {
                match field.get(&scene) {
                    Some(Value::Choice(_)) | None => {}
                    Some(value) => prop_assert!(field.set(&mut mixed, value), "{}", field.path),
                }
            }
            prop_assert_eq!(mixed, scene);
        }
    }

    #[test]
    fn units_go_with_numbers_and_steps_with_ranges() {
        for field in all() {
            let number = field.range.min().is_some();
            assert_eq!(field.unit.is_empty(), !number, "{}: {:?}", field.path, field.unit);
            let suits = match (field.range, field.step) {
                (Range::Whole { .. }, Step::Typed) => field.path == "version",
                (Range::Real { .. }, Step::Linear { fine, coarse }) => fine > 0.0 && fine < coarse,
                (Range::Real { .. }, Step::Logarithmic)
                | (Range::Whole { .. }, Step::Doubling)
                | (Range::Band { .. }, Step::Band) => true,
                (Range::Whole { .. }, Step::Integer { fine, coarse }) => fine > 0 && fine < coarse,
                // The material is no list of shapes: its two choices are the same body.
                (Range::Choice(_), Step::Choice) => field.path != "material",
                (Range::Choice(_), Step::Typed) => field.path == "material",
                (Range::Text { .. } | Range::List { .. } | Range::Group, Step::Typed) => true,
                _ => false,
            };
            assert!(suits, "{}: {:?} by {:?}", field.path, field.range, field.step);
        }
    }
}
