//! The one table of everything a scene can say: paths, symbols, units, ranges, meanings.
//!
//! The checks, the names an override may use, the explorer's list of parameters and the reference
//! in docs/scene-file.md all read this table, so they cannot disagree.

use std::f64::consts::FRAC_PI_2;

use super::model::SCENE_VERSION;
use super::range::Range;
use super::step::Step;

/// Largest number of springs.
pub const MOST_POINTS: u64 = 1 << 28;

/// One field of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Path from the top of the scene, components joined by dots: `roughness.hurst`.
    pub path: &'static str,
    /// The variant of the enclosing choice that has this field: `Paraboloid` for `form.radius`.
    /// `None` where the field does not depend on a choice.
    pub variant: Option<&'static str>,
    /// Its name in the terms of the field: `Hurst exponent`.
    pub name: &'static str,
    /// Its symbol in the equations, empty where it has none.
    pub symbol: &'static str,
    /// SI unit; `1` for numbers without one, empty for what is not a number.
    pub unit: &'static str,
    /// What is allowed.
    pub range: Range,
    /// How a key steps it.
    pub step: Step,
    /// What stands where the field is left out, as it would be written; empty where it may not be
    /// left out.
    pub default: &'static str,
    /// What it does, in one plain line.
    pub meaning: &'static str,
}

impl Field {
    /// What is allowed, with the unit: `from 1 to 1e13 Pa`.
    pub fn allowed(&self) -> String {
        match self.unit {
            "" | "1" => self.range.to_string(),
            unit => format!("{} {unit}", self.range),
        }
    }

    /// Path of the enclosing group; empty at the top of the scene.
    pub fn parent(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(parent, _)| parent)
    }

    /// The last component of the path.
    pub fn last(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, last)| last)
    }
}

/// The field at a path. Where variants of a choice share the name, `variant` decides; with `None`
/// the first of them is returned.
pub fn field(path: &str, variant: Option<&str>) -> Option<&'static Field> {
    FIELDS.iter().find(|field| {
        field.path == path && (variant.is_none() || field.variant.is_none() || field.variant == variant)
    })
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
};

const NUMBER: Field = Field { unit: "1", ..TEXT };

/// Every field of a scene, in the order in which a scene is written.
pub const FIELDS: &[Field] = &[
    Field {
        path: "version",
        name: "version",
        range: Range::whole(SCENE_VERSION as u64, SCENE_VERSION as u64),
        meaning: "version of the scene file format",
        ..NUMBER
    },
    Field {
        path: "title",
        name: "title",
        range: Range::Text { most: 200, lines: false },
        default: "\"\"",
        meaning: "title of the scene, on one line",
        ..TEXT
    },
    Field {
        path: "notice",
        name: "notice",
        range: Range::Text { most: 4000, lines: true },
        default: "\"\"",
        meaning: "notes on the scene",
        ..TEXT
    },
    Field {
        path: "material",
        name: "material",
        range: Range::Choice(&["(youngs_modulus: 2.0e6, poisson_ratio: 0.5)", "(effective_modulus: 2.7e6)"]),
        meaning: "elastic constants: Young's modulus with Poisson's ratio, or the effective modulus",
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
        ..NUMBER
    },
    Field {
        path: "form",
        name: "form",
        range: Range::Choice(&[
            "Paraboloid(radius: 1.0e-3)",
            "Cone(angle: 0.1)",
            "Power(coefficient: 1.0e7, exponent: 3.0)",
            "Punch(radius: 2.0e-5)",
        ]),
        step: Step::Choice,
        default: "None",
        meaning: "macroscopic shape of the rigid body; default: nominally flat",
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
        ..NUMBER
    },
    Field {
        path: "roughness.seed",
        variant: Some("SelfAffine"),
        name: "seed",
        range: Range::whole(0, u64::MAX),
        step: Step::Integer { fine: 1, coarse: 100 },
        meaning: "seed of the random phases: the same seed gives the same profile",
        ..NUMBER
    },
    Field {
        path: "roughness.file",
        variant: Some("Measured"),
        name: "measured profile",
        range: Range::Text { most: 4096, lines: false },
        meaning: "text file with the columns x and z in m, relative to the scene file",
        ..TEXT
    },
    Field {
        path: "adhesion",
        name: "adhesion",
        range: Range::Choice(&["(work: 0.05)", "(kappa: 2.0)"]),
        step: Step::Choice,
        default: "None",
        meaning: "adhesion of the surfaces, by work of adhesion or by κ; default: none",
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
        ..TEXT
    },
    Field {
        path: "numerics",
        name: "numerics",
        range: Range::Group,
        default: "()",
        meaning: "resolution and method of the computation",
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
        ..NUMBER
    },
    Field {
        path: "numerics.solver",
        name: "solver",
        range: Range::Choice(&["Exact", "Stepwise(step: 1.0e-9)"]),
        step: Step::Choice,
        default: "Exact",
        meaning: "exact solver, or the stepwise relaxation of the paper",
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
        ..NUMBER
    },
    Field {
        path: "numerics.edges",
        name: "edges",
        range: Range::Choice(&["Grid", "SubCell"]),
        step: Step::Choice,
        default: "SubCell",
        meaning: "edge model of the contact patches: SubCell finds edges between springs, Grid counts whole springs, as the paper and the stepwise solver do",
        ..TEXT
    },
    Field {
        path: "numerics.samples",
        name: "samples",
        range: Range::whole(2, 1_000_000),
        step: Step::Doubling,
        default: "512",
        meaning: "points of the force curve on each loading stage",
        ..NUMBER
    },
    Field {
        path: "observe",
        name: "observe",
        range: Range::List { of: &["Fragments", "HeightHistogram"], least: 0, most: 2 },
        default: "[]",
        meaning: "observed quantities beside the force curve",
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

#[cfg(test)]
mod tests {
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

    #[test]
    fn units_go_with_numbers_and_steps_with_ranges() {
        for field in all() {
            let number = field.range.min().is_some();
            assert_eq!(field.unit.is_empty(), !number, "{}: {:?}", field.path, field.unit);
            let suits = match (field.range, field.step) {
                (Range::Whole { min, max }, Step::Typed) => min == max,
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
