//! The table of everything that a scene holds: paths, symbols, units, ranges, meanings, access.
//!
//! Reading and writing, checks of ranges, overrides, steps of the keys, axes of studies, the explorer's list of
//! parameters, random scenes of the tests and the reference in docs/scene-file.md are loops over this table.

use std::f64::consts::FRAC_PI_2;

use super::field::{Field, Step};
use super::model::{Edges, Form, Leg, Roughness, SCENE_VERSIONS, Scene, Solver};
use super::range::Range;
use super::value::{Access, Part, at};

/// Largest number of springs.
pub const MOST_POINTS: u64 = 1 << 28;

/// The field at a path. Where variants of a choice share the name, `variant` decides; with `None`
/// the first of them is returned.
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

const TEXT: Field = Field {
    path: "",
    variant: None,
    name: "",
    symbol: "",
    unit: "",
    range: Range::Group,
    step: Step::Typed,
    default: "",
    meaning: "",
    access: Access::NONE,
};

const NUMBER: Field = Field { unit: "1", ..TEXT };

/// Every field of a scene, in the order in which a scene is written.
pub const FIELDS: &[Field] = &[
    Field {
        path: "version",
        name: "version",
        range: Range::whole(*SCENE_VERSIONS.start() as u64, *SCENE_VERSIONS.end() as u64),
        meaning: "version of the scene file format",
        access: at!(version),
        ..NUMBER
    },
    Field {
        path: "title",
        name: "title",
        range: Range::Text { least: 0, most: 200, lines: false },
        default: "\"\"",
        meaning: "title of the scene, on one line",
        access: at!(title),
        ..TEXT
    },
    Field {
        path: "notice",
        name: "notice",
        range: Range::Text { least: 0, most: 4000, lines: true },
        default: "\"\"",
        meaning: "notes on the scene",
        access: at!(notice),
        ..TEXT
    },
    Field {
        path: "material",
        name: "material",
        range: Range::Choice(&["(youngs_modulus: 2.0e6, poisson_ratio: 0.5)", "(effective_modulus: 2.7e6)"]),
        meaning: "elastic constants: Young's modulus with Poisson's ratio, or the effective modulus",
        access: at!(material),
        ..TEXT
    },
    Field {
        path: "material.youngs_modulus",
        name: "Young's modulus",
        symbol: "E",
        unit: "Pa",
        range: Range::closed(1.0, 1e13),
        step: Step::Logarithmic,
        default: "None",
        meaning: "Young's modulus of the elastic body; requires Poisson's ratio",
        access: at!(material.youngs_modulus),
        ..NUMBER
    },
    Field {
        path: "material.poisson_ratio",
        name: "Poisson's ratio",
        symbol: "ν",
        range: Range::above(-1.0, 0.5),
        step: Step::Linear { fine: 0.01, coarse: 0.1 },
        default: "None",
        meaning: "Poisson's ratio of the elastic body; 0.5 is incompressible, as rubber",
        access: at!(material.poisson_ratio),
        ..NUMBER
    },
    Field {
        path: "material.effective_modulus",
        name: "effective modulus",
        symbol: "E*",
        unit: "Pa",
        range: Range::closed(1.0, 1e13),
        step: Step::Logarithmic,
        default: "None",
        meaning: "effective modulus E/(1 − ν²), in place of E and ν",
        access: at!(material.effective_modulus),
        ..NUMBER
    },
    Field {
        path: "length",
        name: "apparent diameter",
        symbol: "L",
        unit: "m",
        range: Range::closed(1e-9, 10.0),
        step: Step::Logarithmic,
        meaning: "apparent diameter of the contact: length of the profile",
        access: at!(length),
        ..NUMBER
    },
    Field {
        path: "form",
        name: "form",
        range: Range::Choice(&[
            "Paraboloid(radius: 1.0e-3)",
            "Cone(angle: 0.1)",
            "Power(coefficient: 1.0e7, exponent: 3.0)",
            "WavySphere(radius: 1.0e-3, amplitude: 1.0e-8, wavelength: 1.0e-5)",
            "Punch(radius: 2.0e-5)",
        ]),
        step: Step::Choice,
        default: "None",
        meaning: "macroscopic shape of the rigid body; default: nominally flat",
        access: at!(form),
        ..TEXT
    },
    Field {
        path: "form.radius",
        variant: Some("Paraboloid"),
        name: "radius of curvature",
        symbol: "R",
        unit: "m",
        range: Range::above(0.0, 1e9),
        step: Step::Logarithmic,
        meaning: "radius of curvature of the paraboloid at its apex",
        access: at!(form, Some(Form::Paraboloid { radius }) => radius),
        ..NUMBER
    },
    Field {
        path: "form.angle",
        variant: Some("Cone"),
        name: "flank angle",
        symbol: "θ",
        unit: "rad",
        range: Range::between(0.0, FRAC_PI_2),
        step: Step::Linear { fine: 0.01, coarse: 0.1 },
        meaning: "angle between the flank of the cone and the surface; a small angle is blunt",
        access: at!(form, Some(Form::Cone { angle }) => angle),
        ..NUMBER
    },
    Field {
        path: "form.coefficient",
        variant: Some("Power"),
        name: "coefficient",
        symbol: "b",
        unit: "m^(1−n)",
        range: Range::above(0.0, 1e300),
        step: Step::Logarithmic,
        meaning: "coefficient b of the power law b rⁿ",
        access: at!(form, Some(Form::Power { coefficient, .. }) => coefficient),
        ..NUMBER
    },
    Field {
        path: "form.exponent",
        variant: Some("Power"),
        name: "exponent",
        symbol: "n",
        range: Range::above(0.5, 100.0),
        step: Step::Linear { fine: 0.1, coarse: 1.0 },
        meaning: "exponent n of the power law b rⁿ; a large n is flat in the middle and steep outside",
        access: at!(form, Some(Form::Power { exponent, .. }) => exponent),
        ..NUMBER
    },
    Field {
        path: "form.radius",
        variant: Some("WavySphere"),
        name: "sphere radius",
        symbol: "R",
        unit: "m",
        range: Range::above(0.0, 1e9),
        step: Step::Logarithmic,
        meaning: "radius of curvature of the sphere without its waves",
        access: at!(form, Some(Form::WavySphere { radius, .. }) => radius),
        ..NUMBER
    },
    Field {
        path: "form.amplitude",
        variant: Some("WavySphere"),
        name: "wave amplitude",
        symbol: "A",
        unit: "m",
        range: Range::above(0.0, 1e6),
        step: Step::Logarithmic,
        meaning: "amplitude A of the concentric waves A (1 − cos 2πr/λ)",
        access: at!(form, Some(Form::WavySphere { amplitude, .. }) => amplitude),
        ..NUMBER
    },
    Field {
        path: "form.wavelength",
        variant: Some("WavySphere"),
        name: "wavelength",
        symbol: "λ",
        unit: "m",
        range: Range::above(0.0, 1e9),
        step: Step::Logarithmic,
        meaning: "distance λ from crest to crest of the waves, at least four springs",
        access: at!(form, Some(Form::WavySphere { wavelength, .. }) => wavelength),
        ..NUMBER
    },
    Field {
        path: "form.radius",
        variant: Some("Punch"),
        name: "punch radius",
        symbol: "a",
        unit: "m",
        range: Range::above(0.0, 5.0),
        step: Step::Logarithmic,
        meaning: "radius of the flat end; no contact outside",
        access: at!(form, Some(Form::Punch { radius }) => radius),
        ..NUMBER
    },
    Field {
        path: "roughness",
        name: "roughness",
        range: Range::Choice(&[
            "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)",
            "Measured(file: \"line.csv\")",
        ]),
        step: Step::Choice,
        default: "None",
        meaning: "roughness of the rigid profile; default: smooth",
        access: at!(roughness),
        ..TEXT
    },
    Field {
        path: "roughness.hurst",
        variant: Some("SelfAffine"),
        name: "Hurst exponent",
        symbol: "H",
        range: Range::between(0.0, 1.0),
        step: Step::Linear { fine: 0.01, coarse: 0.1 },
        meaning: "decay of the roughness towards short waves: low H is jagged, high H is smooth; fractal dimension 3 − H",
        access: at!(roughness, Some(Roughness::SelfAffine { hurst, .. }) => hurst),
        ..NUMBER
    },
    Field {
        path: "roughness.rms_height",
        variant: Some("SelfAffine"),
        name: "rms height",
        symbol: "h",
        unit: "m",
        range: Range::closed(1e-30, 100.0),
        step: Step::Logarithmic,
        default: "None",
        meaning: "root mean square height of the profile",
        access: at!(roughness, Some(Roughness::SelfAffine { rms_height, .. }) => rms_height),
    },
    Field {
        path: "roughness.rms_gradient",
        variant: Some("SelfAffine"),
        name: "rms gradient",
        symbol: "⟨∇z⟩",
        range: Range::closed(1e-30, 1e9),
        step: Step::Logarithmic,
        default: "None",
        meaning: "root mean square slope of the profile, in place of the rms height",
        access: at!(roughness, Some(Roughness::SelfAffine { rms_gradient, .. }) => rms_gradient),
        ..NUMBER
    },
    Field {
        path: "roughness.modes",
        variant: Some("SelfAffine"),
        name: "modes",
        symbol: "k",
        range: Range::Band { min: 1, max: 1 << 27 },
        step: Step::Band,
        meaning: "first and last mode of the profile, in waves per length; the last is at most points/2",
        access: at!(roughness, Some(Roughness::SelfAffine { modes, .. }) => modes),
        ..NUMBER
    },
    Field {
        path: "roughness.seed",
        variant: Some("SelfAffine"),
        name: "seed",
        range: Range::whole(0, u64::MAX),
        step: Step::Integer { fine: 1, coarse: 100 },
        meaning: "seed of the random phases: the same seed gives the same profile",
        access: at!(roughness, Some(Roughness::SelfAffine { seed, .. }) => seed),
        ..NUMBER
    },
    Field {
        path: "roughness.file",
        variant: Some("Measured"),
        name: "measured surface",
        range: Range::Text { least: 1, most: 4096, lines: false },
        meaning: "file of a measured profile or map (docs/surfaces.md), relative to the scene file",
        access: at!(roughness, Some(Roughness::Measured { file, .. }) => file),
        ..TEXT
    },
    Field {
        path: "roughness.as_line",
        variant: Some("Measured"),
        name: "profile as line",
        range: Range::Choice(&["false", "true"]),
        step: Step::Choice,
        default: "None",
        meaning: "true: the measured profile is the line itself, with 29 % too little slope; false: its equivalent line is, with random phases; default: true in version 1, false in version 2",
        access: at!(roughness, Some(Roughness::Measured { as_line, .. }) => as_line),
        ..TEXT
    },
    Field {
        path: "roughness.opposite",
        variant: Some("Measured"),
        name: "measured surface of the opposite face",
        range: Range::Text { least: 1, most: 4096, lines: false },
        default: "None",
        meaning: "file of the opposite face, relative to the scene file: the spectra of both faces add; default: smooth",
        access: at!(roughness, Some(Roughness::Measured { opposite, .. }) => opposite),
        ..TEXT
    },
    Field {
        path: "roughness.row",
        variant: Some("Measured"),
        name: "row of the map",
        range: Range::whole(1, 1 << 28),
        step: Step::Integer { fine: 1, coarse: 100 },
        default: "None",
        meaning: "row of a map that is the measured profile, from 1 on; default: the whole map",
        access: at!(roughness, Some(Roughness::Measured { row, .. }) => row),
        ..NUMBER
    },
    Field {
        path: "roughness.column",
        variant: Some("Measured"),
        name: "column of the map",
        range: Range::whole(1, 1 << 28),
        step: Step::Integer { fine: 1, coarse: 100 },
        default: "None",
        meaning: "column of a map that is the measured profile, in place of a row",
        access: at!(roughness, Some(Roughness::Measured { column, .. }) => column),
        ..NUMBER
    },
    Field {
        path: "roughness.detrend",
        variant: Some("Measured"),
        name: "detrending",
        range: Range::Choice(&["Nothing", "Mean", "Tilt", "Curvature"]),
        step: Step::Choice,
        default: "None",
        meaning: "part that is removed of the measured heights by least squares; default: Tilt, and Nothing of a profile as line",
        access: at!(roughness, Some(Roughness::Measured { detrend, .. }) => detrend),
        ..TEXT
    },
    Field {
        path: "roughness.periodic",
        variant: Some("Measured"),
        name: "periodic surface",
        range: Range::Choice(&["false", "true"]),
        step: Step::Choice,
        default: "false",
        meaning: "true: the measured surface repeats itself at its borders, and its spectrum is estimated without a window",
        access: at!(roughness, Some(Roughness::Measured { periodic, .. }) => periodic),
        ..TEXT
    },
    Field {
        path: "roughness.unit",
        variant: Some("Measured"),
        name: "unit of the file",
        range: Range::Text { least: 0, most: 20, lines: false },
        default: "\"\"",
        meaning: "unit of lengths where the file states none: m, mm, um, nm; default: none, and m of a profile as line",
        access: at!(roughness, Some(Roughness::Measured { unit, .. }) => unit),
        ..TEXT
    },
    Field {
        path: "roughness.continue_to",
        variant: Some("Measured"),
        name: "shortest wavelength",
        symbol: "λ_s",
        unit: "m",
        range: Range::closed(1e-15, 10.0),
        step: Step::Logarithmic,
        default: "None",
        meaning: "wavelength down to which the spectrum of the equivalent line continues as a power law; default: the last resolved one",
        access: at!(roughness, Some(Roughness::Measured { continue_to, .. }) => continue_to),
    },
    Field {
        path: "roughness.seed",
        variant: Some("Measured"),
        name: "seed of the equivalent line",
        range: Range::whole(0, u64::MAX),
        step: Step::Integer { fine: 1, coarse: 100 },
        default: "1",
        meaning: "seed of the random phases of the equivalent line",
        access: at!(roughness, Some(Roughness::Measured { seed, .. }) => seed),
        ..NUMBER
    },
    Field {
        path: "adhesion",
        name: "adhesion",
        range: Range::Choice(&["(work: 0.05)", "(kappa: 2.0)", "(elastic_energy_ratio: 0.5)"]),
        step: Step::Choice,
        default: "None",
        meaning: "adhesion of the surfaces, by work of adhesion, κ or e_el/γ; default: none",
        access: at!(adhesion),
        ..TEXT
    },
    Field {
        path: "adhesion.work",
        name: "work of adhesion",
        symbol: "γ",
        unit: "J/m²",
        range: Range::closed(0.0, 1e6),
        step: Step::Logarithmic,
        default: "None",
        meaning: "energy per unit area needed to separate the interface",
        access: at!(adhesion?.work),
        ..NUMBER
    },
    Field {
        path: "adhesion.closing_work",
        name: "work of adhesion on closing",
        symbol: "γ₁",
        unit: "J/m²",
        range: Range::closed(0.0, 1e6),
        step: Step::Logarithmic,
        default: "None",
        meaning: "energy per unit area gained where the interface closes, at most adhesion.work; default: the same",
        access: at!(adhesion?.closing_work),
        ..NUMBER
    },
    Field {
        path: "adhesion.kappa",
        name: "roughness parameter",
        symbol: "κ",
        range: Range::closed(1e-6, 1e6),
        step: Step::Logarithmic,
        default: "None",
        meaning: "roughness-adhesion parameter sqrt(h⟨∇z⟩E*/γ): adhesion is strong for small κ",
        access: at!(adhesion?.kappa),
        ..NUMBER
    },
    Field {
        path: "adhesion.elastic_energy_ratio",
        name: "elastic energy ratio",
        symbol: "e_el/γ",
        range: Range::closed(1e-12, 1e12),
        step: Step::Logarithmic,
        default: "None",
        meaning: "elastic energy that pressing the bodies flat takes, over the work of adhesion: adhesion is strong for small e_el/γ",
        access: at!(adhesion?.elastic_energy_ratio),
        ..NUMBER
    },
    Field {
        path: "adhesion.range",
        name: "range of attraction",
        symbol: "z₀",
        unit: "m",
        range: Range::closed(1e-12, 1e-3),
        step: Step::Logarithmic,
        default: "None",
        meaning: "range of the attraction, for the Tabor number alone; default: 0.3 nm",
        access: at!(adhesion?.range),
        ..NUMBER
    },
    Field {
        path: "loading",
        name: "loading",
        range: Range::List {
            of: &["ToForce(1.0e-5)", "ToIndentation(1.0e-7)", "ToTouch", "ToZeroForce", "ToSeparation"],
            least: 1,
            most: 100_000,
        },
        default: "[ToZeroForce, ToSeparation]",
        meaning: "loading stages in their order, from separation",
        access: at!(loading),
        ..TEXT
    },
    Field {
        path: "numerics",
        name: "numerics",
        range: Range::Group,
        default: "()",
        meaning: "resolution and method of the computation",
        access: at!(numerics),
        ..TEXT
    },
    Field {
        path: "numerics.points",
        name: "points",
        symbol: "N",
        range: Range::whole(1, MOST_POINTS),
        step: Step::Doubling,
        default: "16384",
        meaning: "number of springs along the profile",
        access: at!(numerics.points),
        ..NUMBER
    },
    Field {
        path: "numerics.solver",
        name: "solver",
        range: Range::Choice(&["Exact", "Stepwise(step: 1.0e-9)"]),
        step: Step::Choice,
        default: "Exact",
        meaning: "exact solver, or the stepwise relaxation of the paper",
        access: at!(numerics.solver),
        ..TEXT
    },
    Field {
        path: "numerics.solver.step",
        variant: Some("Stepwise"),
        name: "step",
        symbol: "Δd",
        unit: "m",
        range: Range::closed(1e-30, 1e6),
        step: Step::Logarithmic,
        meaning: "displacement of the body between two relaxations",
        access: at!(numerics.solver, Solver::Stepwise { step } => step),
        ..NUMBER
    },
    Field {
        path: "numerics.edges",
        name: "edges",
        range: Range::Choice(&["Grid", "SubCell"]),
        step: Step::Choice,
        default: "SubCell",
        meaning: "edge model of the contact patches: SubCell finds edges between springs, Grid counts whole springs, as the paper and the stepwise solver do",
        access: at!(numerics.edges),
        ..TEXT
    },
    Field {
        path: "numerics.samples",
        name: "samples",
        range: Range::whole(2, 1_000_000),
        step: Step::Doubling,
        default: "512",
        meaning: "points of the force curve on each loading stage",
        access: at!(numerics.samples),
        ..NUMBER
    },
    Field {
        path: "observe",
        name: "observe",
        range: Range::List { of: &["Fragments", "HeightHistogram"], least: 0, most: 2 },
        default: "[]",
        meaning: "observed quantities beside the force curve",
        access: at!(observe),
        ..TEXT
    },
];

/// The force of a leg [`ToForce`](super::Leg::ToForce), at `loading.0.0` for the first leg.
pub const LEG_FORCE: Field = Field {
    path: "loading",
    variant: Some("ToForce"),
    name: "force of a stage",
    symbol: "F",
    unit: "N",
    range: Range::closed(-1e30, 1e30),
    step: Step::Logarithmic,
    meaning: "target: the stage ends where the force first reaches this value; compression is positive",
    ..NUMBER
};

/// The indentation of a leg [`ToIndentation`](super::Leg::ToIndentation), at `loading.0.0` for the
/// first leg.
pub const LEG_INDENTATION: Field = Field {
    path: "loading",
    variant: Some("ToIndentation"),
    name: "indentation of a stage",
    symbol: "d",
    unit: "m",
    range: Range::closed(-1e6, 1e6),
    step: Step::Logarithmic,
    meaning: "target: the stage ends at this indentation; 0 is first touch, positive is deeper",
    ..NUMBER
};

impl Field {
    /// Value of the field in a scene that leaves it out, as it would be written; empty where it is required.
    pub fn default_in(&self, scene: &Scene) -> &'static str {
        match (self.path, scene.numerics.solver.usual_edges()) {
            ("numerics.edges", Edges::Grid) => "Grid",
            _ => self.default,
        }
    }
}

impl Leg {
    /// Field and value of the target, where the stage has a number as target.
    pub fn target(&self) -> Option<(&'static Field, f64)> {
        match *self {
            Leg::ToForce(force) => Some((&LEG_FORCE, force)),
            Leg::ToIndentation(indentation) => Some((&LEG_INDENTATION, indentation)),
            Leg::ToTouch | Leg::ToZeroForce | Leg::ToSeparation => None,
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

    /// A value of the field's kind that no scene has by chance.
    fn unusual(field: &Field) -> Option<Value<'static>> {
        Some(match field.range {
            Range::Real { .. } => Value::Real(0.123),
            Range::Whole { .. } => Value::Whole(12_345),
            Range::Band { .. } => Value::Band(123, 1234),
            Range::Text { .. } => Value::Text("unusual"),
            Range::List { .. } if field.path == "loading" => Value::Legs(&[Leg::ToTouch; 7]),
            Range::List { .. } => Value::Observers(&[Observer::Fragments; 7]),
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
            // The choices are those of the one scene, all else that both have is taken from the other.
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
                // The material is no list of shapes to go through: its two choices are the same body.
                (Range::Choice(_), Step::Choice) => field.path != "material",
                (Range::Choice(_), Step::Typed) => field.path == "material",
                (Range::Text { .. } | Range::List { .. } | Range::Group, Step::Typed) => true,
                _ => false,
            };
            assert!(suits, "{}: {:?} by {:?}", field.path, field.range, field.step);
        }
    }
}
