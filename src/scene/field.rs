//! One field of a scene: path, symbol, unit, range, step, default and meaning.

use super::range::Range;
use crate::contact::Move;

/// One field of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Path from the top of the scene, components joined by dots: `roughness.hurst`.
    pub path: &'static str,
    /// Variant of the enclosing choice that has this field: `Paraboloid` for `form.radius`. `None` if the field
    /// does not depend on a choice.
    pub variant: Option<&'static str>,
    /// Technical name: `Hurst exponent`.
    pub name: &'static str,
    /// Symbol in the equations; empty if there is none.
    pub symbol: &'static str,
    /// SI unit; `1` for numbers without one, empty for other values.
    pub unit: &'static str,
    /// Allowed values.
    pub range: Range,
    /// Steps of the keys.
    pub step: Step,
    /// Value of an omitted field, as written; empty if the field is required.
    pub default: &'static str,
    /// Meaning in one line.
    pub meaning: &'static str,
}

/// Step of a field for a key press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// By addition of the first number, or of the second as the large step; the result is a multiple of the first.
    Linear(f64, f64),
    /// To the next preferred number: twenty to a decade (the Renard series R20) as the small step,
    /// 1–2–5 as the large one.
    Logarithmic,
    /// By addition of the first number to an integer, or of the second as the large step.
    Integer(u64, u64),
    /// To the next power of two; the large step is four of them.
    Doubling,
    /// The last mode of a pair to the next power of two; the large step moves the first mode.
    Band,
    /// To the next choice.
    Choice,
    /// No steps, only typed values.
    Typed,
}

/// A required field, with the usual unit and step of its range; its name is its path.
pub(super) const fn row(path: &'static str, range: Range) -> Field {
    let (step, unit) = match range {
        Range::Real(..) => (Step::Logarithmic, "1"),
        Range::Whole(..) => (Step::Typed, "1"),
        Range::Band(..) => (Step::Band, "1"),
        Range::Choice(_) => (Step::Choice, ""),
        Range::Text { .. } | Range::List { .. } | Range::Group => (Step::Typed, ""),
    };
    Field { path, variant: None, name: path, symbol: "", unit, range, step, default: "", meaning: "" }
}

/// Changes of a row in the table of fields.
impl Field {
    pub(super) const fn of(self, variant: &'static str) -> Field {
        Field { variant: Some(variant), ..self }
    }

    pub(super) const fn name(self, name: &'static str) -> Field {
        Field { name, ..self }
    }

    pub(super) const fn quantity(
        self,
        name: &'static str,
        symbol: &'static str,
        unit: &'static str,
    ) -> Field {
        Field { name, symbol, unit, ..self }
    }

    pub(super) const fn step(self, step: Step) -> Field {
        Field { step, ..self }
    }

    pub(super) const fn default(self, default: &'static str) -> Field {
        Field { default, ..self }
    }

    pub(super) const fn meaning(self, meaning: &'static str) -> Field {
        Field { meaning, ..self }
    }
}

impl Field {
    /// Allowed values with the unit: `from 1 to 1e13 Pa`.
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

/// Fields are equal if path and variant are equal.
impl PartialEq for Field {
    fn eq(&self, other: &Field) -> bool {
        (self.path, self.variant) == (other.path, other.variant)
    }
}

/// Range of file names.
pub(super) const FILE_NAME: Range = Range::Text { least: 1, most: 4096, lines: false };

/// The force of a loading stage [`ToForce`](super::Move::ToForce), at `loading.0.0` for the first stage.
pub const LEG_FORCE: Field = row("loading", Range::closed(-1e30, 1e30))
    .of("ToForce")
    .quantity("force of a stage", "F", "N")
    .meaning("target: the stage ends where the force first reaches this value; compression is positive");

/// The indentation of a loading stage [`ToIndentation`](super::Move::ToIndentation), at `loading.0.0`
/// for the first stage.
pub const LEG_INDENTATION: Field = row("loading", Range::closed(-1e6, 1e6))
    .of("ToIndentation")
    .quantity("indentation of a stage", "d", "m")
    .meaning("target: the stage ends at this indentation; 0 is first touch, positive is deeper");

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
