//! One field of a scene: path, symbol, unit, range, meaning, and access to its value.

use super::model::Scene;
use super::range::Range;
use super::value::{Access, Value};

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
    /// Access to the value.
    pub(super) access: Access,
}

/// Step of a field for a key press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// By addition; the result is a multiple of `fine`.
    Linear {
        /// Small step.
        fine: f64,
        /// Large step.
        coarse: f64,
    },
    /// To the next preferred number: twenty to a decade (the Renard series R20) as the small step,
    /// 1–2–5 as the large one.
    Logarithmic,
    /// By addition to an integer.
    Integer {
        /// Small step.
        fine: u64,
        /// Large step.
        coarse: u64,
    },
    /// To the next power of two; the large step is four of them.
    Doubling,
    /// The last mode of a pair to the next power of two; the large step moves the first mode.
    Band,
    /// To the next choice.
    Choice,
    /// No steps, only typed values.
    Typed,
}

/// The row of a field; see `at!` for the combination of path, variant and access.
impl Field {
    /// Required group of fields; its name is its path.
    pub(super) const fn new(path: &'static str, variant: Option<&'static str>, access: Access) -> Field {
        let (symbol, unit, default, meaning) = ("", "", "", "");
        let (name, range, step) = (path, Range::Group, Step::Typed);
        Field { path, variant, name, symbol, unit, range, step, default, meaning, access }
    }

    pub(super) const fn name(self, name: &'static str) -> Field {
        Field { name, ..self }
    }

    /// Name, symbol and unit.
    pub(super) const fn quantity(
        self,
        name: &'static str,
        symbol: &'static str,
        unit: &'static str,
    ) -> Field {
        Field { name, symbol, unit, ..self }
    }

    /// Range, with the usual step of its kind; a number without a unit has the unit 1.
    pub(super) const fn range(self, range: Range) -> Field {
        let (step, is_number) = match range {
            Range::Real { .. } => (Step::Logarithmic, true),
            Range::Whole { .. } => (Step::Typed, true),
            Range::Band { .. } => (Step::Band, true),
            Range::Choice(_) => (Step::Choice, false),
            Range::Text { .. } | Range::List { .. } | Range::Group => (Step::Typed, false),
        };
        let unit = if is_number && self.unit.is_empty() { "1" } else { self.unit };
        Field { range, step, unit, ..self }
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
    /// Value in a scene; `None` if the field belongs to an unselected choice.
    pub fn get<'s>(&self, scene: &'s Scene) -> Option<Value<'s>> {
        (self.access.get)(scene)
    }

    /// Sets the field to a value, valid or not. A missing optional group is made for it.
    ///
    /// Returns `false`, with the scene unchanged, for a value of another kind, for a field of an unselected choice,
    /// and for a whole choice, which [`Document::set`](super::Document::set) replaces.
    #[must_use]
    pub fn set(&self, scene: &mut Scene, value: Value<'_>) -> bool {
        (self.access.set)(scene, value)
    }

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
