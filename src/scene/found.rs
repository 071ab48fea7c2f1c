//! Errors found in a scene, and the check of a value against the range of its field.

use super::errors::SceneError;
use super::field::Field;
use super::fields::{FIELDS, FILE_NAME, fields_inside};
use super::model::{Move, Scene};
use super::range::Range;
use super::text::{is_within, ron_float, ron_string};
use super::value::Value;
use crate::text::is_control;

/// The errors found so far in a scene.
pub(super) struct Found<'s> {
    pub(super) scene: &'s Scene,
    pub(super) errors: Vec<SceneError>,
}

impl Found<'_> {
    /// Returns true if an error of this field, or of anything inside it, was found.
    pub(super) fn has(&self, path: &str) -> bool {
        self.errors.iter().any(|error| is_within(&error.field, path))
    }

    /// Refuses the value of a field for a reason other than its range. `allowed` is empty if `message` contains the
    /// allowed values; the value of a group is not repeated.
    pub(super) fn refuse(
        &mut self,
        path: &str,
        allowed: impl Into<String>,
        message: impl Into<String>,
        involves: &'static [&'static str],
    ) {
        let is_here = |field: &&Field| field.path == path && field.get(self.scene).is_some();
        let is_group = |field: &Field| match field.get(self.scene) {
            Some(Value::Choice(variant)) => fields_inside(path, Some(variant)).next().is_some(),
            _ => false,
        };
        let field = FIELDS.iter().find(is_here).filter(|field| !is_group(field));
        let value = field.and_then(|field| field.written(self.scene)).unwrap_or_default();
        self.refuse_value(path, value, allowed, message, involves);
    }

    /// Refuses a value that is only part of a field.
    pub(super) fn refuse_value(
        &mut self,
        path: impl Into<String>,
        value: String,
        allowed: impl Into<String>,
        message: impl Into<String>,
        involves: &'static [&'static str],
    ) {
        let (field, allowed, message) = (path.into(), allowed.into(), message.into());
        self.errors.push(SceneError { field, value, allowed, message, involves, ..SceneError::default() });
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
            Value::Text(text) => self.check_text(field, text, field.range),
            Value::Texts(texts) => {
                self.check_count(field, texts.len());
                texts.iter().for_each(|text| self.check_text(field, text, FILE_NAME));
            }
            Value::Observers(observers) => self.check_count(field, observers.len()),
            Value::Legs(legs) => {
                self.check_count(field, legs.len());
                self.check_targets(legs);
            }
            _ => {}
        }
    }

    fn outside(&mut self, field: &Field, value: String) {
        self.refuse_value(field.path, value, field.allowed(), field.name, &[]);
    }

    fn check_text(&mut self, field: &Field, text: &str, range: Range) {
        let Range::Text { least, most, lines } = range else { return };
        // Control characters would reach the terminal of any reader of the scene.
        let forbidden = |c: &char| is_control(*c) && !(lines && *c == '\n');
        let count = text.chars().count();
        if let Some(c) = text.chars().find(forbidden) {
            let allowed =
                if lines { "no control characters but line breaks" } else { "no control characters" };
            self.refuse_value(field.path, format!("text with {c:?}"), allowed, field.name, &[]);
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

    fn check_targets(&mut self, legs: &[Move]) {
        for (index, leg) in legs.iter().enumerate() {
            if let Some((field, value)) = leg.field()
                && !field.range.contains(value)
            {
                let path = format!("loading.{index}.0");
                self.refuse_value(path, ron_float(value), field.allowed(), field.name, &[]);
            }
        }
    }
}
