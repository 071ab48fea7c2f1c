//! Violations of the rules of a scene, and their collection.

use super::field::Field;
use super::model::Leg;
use super::range::Range;
use super::text::{is_within, ron_float, ron_string};
use super::value::Value;
use crate::text::is_control;

/// A value or combination of values that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Path of the field; a loading stage is `loading.0`.
    pub field: String,
    /// Its value as it would be written; empty where nothing is written.
    pub value: String,
    /// Allowed values; empty where `reason` says it all.
    pub allowed: String,
    /// The reason, or the field's name.
    pub reason: String,
    /// Other fields that take part, by path: changing one of them may mend it as well.
    pub involves: &'static [&'static str],
}

/// The violations found so far.
#[derive(Default)]
pub(super) struct Found {
    violations: Vec<Violation>,
}

impl Found {
    /// All of them, in the order in which they were found.
    pub(super) fn into_violations(self) -> Vec<Violation> {
        self.violations
    }

    /// Adds a violation that no range of a field expresses.
    pub(super) fn add(&mut self, violation: Violation) {
        self.violations.push(violation);
    }

    /// A violation of this field, or of anything inside it, is among those found.
    pub(super) fn has(&self, path: &str) -> bool {
        self.violations.iter().any(|violation| is_within(&violation.field, path))
    }

    /// Checks a value of a field against its range.
    pub(super) fn check(&mut self, field: &Field, value: Value<'_>) {
        let range = &field.range;
        match value {
            Value::Real(value) if !range.contains(value) => self.outside(field, ron_float(value)),
            Value::Whole(value) if !range.contains_whole(value) => self.outside(field, value.to_string()),
            Value::Band(first, last)
                if first > last || !range.contains_whole(first) || !range.contains_whole(last) =>
            {
                self.outside(field, format!("({first}, {last})"));
            }
            Value::Text(text) => self.check_text(field, text),
            Value::Observers(observers) => self.check_count(field, observers.len()),
            Value::Legs(legs) => {
                self.check_count(field, legs.len());
                self.check_targets(legs);
            }
            _ => {}
        }
    }

    fn outside(&mut self, field: &Field, value: String) {
        let (path, allowed, reason) = (field.path.to_string(), field.allowed(), field.name.to_string());
        self.add(Violation { field: path, value, allowed, reason, involves: &[] });
    }

    fn check_text(&mut self, field: &Field, text: &str) {
        let Range::Text { least, most, lines } = field.range else { return };
        // Control characters would reach the terminal of whoever opens the scene.
        let forbidden = |c: char| is_control(c) && !(lines && c == '\n');
        let count = text.chars().count();
        if let Some(c) = text.chars().find(|c| forbidden(*c)) {
            let allowed =
                if lines { "no control characters but line breaks" } else { "no control characters" };
            self.add(Violation {
                field: field.path.to_string(),
                value: format!("text with {c:?}"),
                allowed: allowed.to_string(),
                reason: field.name.to_string(),
                involves: &[],
            });
        } else if count > most {
            self.outside(field, format!("{count} characters"));
        } else if count < least {
            self.outside(field, ron_string(text));
        }
    }

    fn check_count(&mut self, field: &Field, count: usize) {
        if let Range::List { least, most, .. } = field.range
            && !(least..=most).contains(&count)
        {
            self.outside(field, if count == 0 { "[]".to_string() } else { format!("a list of {count}") });
        }
    }

    fn check_targets(&mut self, legs: &[Leg]) {
        for (index, leg) in legs.iter().enumerate() {
            if let Some((field, value)) = leg.target()
                && !field.range.contains(value)
            {
                self.add(Violation {
                    field: format!("loading.{index}.0"),
                    value: ron_float(value),
                    allowed: field.allowed(),
                    reason: field.name.to_string(),
                    involves: &[],
                });
            }
        }
    }
}
