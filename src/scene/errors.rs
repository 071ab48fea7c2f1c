//! Errors of a scene: place, value, allowed range.

use std::fmt;

use super::text::{is_within, line_column};
use crate::text::is_control;

/// Most errors listed; further ones are only counted.
const MOST_LISTED: usize = 100;

/// Longest value or name in messages; longer ones are shortened.
const MOST_SHOWN: usize = 80;

/// Origin of an error.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// A place in a scene file.
    Place {
        /// Name of the file or of the built-in scene.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1, counted in characters.
        column: usize,
    },
    /// A scene file as a whole.
    File {
        /// Name of the file.
        name: String,
    },
    /// One or more overrides, as `path=value`.
    Overrides(Vec<String>),
    /// A scene without a text.
    #[default]
    Scene,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Origin::Place { name, line, column } => write!(f, "{}:{line}:{column}: ", shown(name)),
            Origin::File { name } => write!(f, "{}: ", shown(name)),
            Origin::Overrides(overrides) => {
                let all: Vec<_> = overrides.iter().map(|one| format!("--set {}", shown(one))).collect();
                write!(f, "{}: ", all.join(" "))
            }
            Origin::Scene => Ok(()),
        }
    }
}

/// One error of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneError {
    /// Origin.
    pub origin: Origin,
    /// Path of the field, `loading.0` for a loading stage; empty for an error of no single field.
    pub field: String,
    /// The value as written; empty if there is none.
    pub value: String,
    /// Allowed values; empty if `message` contains them.
    pub allowed: String,
    /// Reason, or the name of the field.
    pub message: String,
    /// Paths of other fields involved: changing one of them may also fix the error.
    pub involves: &'static [&'static str],
}

impl SceneError {
    /// An error about a file or scene as a whole.
    pub(super) fn whole(origin: Origin, message: impl Into<String>) -> SceneError {
        SceneError { origin, message: message.into(), ..SceneError::default() }
    }

    /// The same error with another origin.
    pub(super) fn at(self, origin: Origin) -> SceneError {
        SceneError { origin, ..self }
    }

    /// The error without its origin: `roughness.hurst = 1.4: allowed: above 0 and below 1 (Hurst
    /// exponent)`.
    pub fn what(&self) -> impl fmt::Display {
        let mut what = shown(&self.field);
        if !self.field.is_empty() && !self.value.is_empty() {
            what.push_str(" = ");
        }
        what.push_str(&shown(&self.value));
        if !what.is_empty() {
            what.push_str(": ");
        }
        if self.allowed.is_empty() {
            what.push_str(&self.message);
        } else {
            what.push_str("allowed: ");
            what.push_str(&self.allowed);
            if !self.message.is_empty() {
                what.push_str(&format!(" ({})", self.message));
            }
        }
        what
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.origin, self.what())
    }
}

impl std::error::Error for SceneError {}

/// All errors of a scene, at least one, each a line of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneErrors {
    first: Box<SceneError>,
    rest: Vec<SceneError>,
}

impl SceneErrors {
    /// The errors of a list; `None` for an empty list.
    pub fn new(errors: Vec<SceneError>) -> Option<SceneErrors> {
        let mut errors = errors.into_iter();
        Some(SceneErrors { first: Box::new(errors.next()?), rest: errors.collect() })
    }

    /// Returns `Err` for a list of errors that is not empty: the errors with their origins, a long list shortened.
    pub(super) fn result(
        mut errors: Vec<SceneError>,
        origin: impl Fn(&SceneError) -> Origin,
    ) -> Result<(), SceneErrors> {
        let count = errors.len();
        errors.truncate(MOST_LISTED);
        errors.iter_mut().for_each(|error| error.origin = origin(error));
        if count > MOST_LISTED {
            errors.push(SceneError::whole(Origin::Scene, format!("and {} more errors", count - MOST_LISTED)));
        }
        SceneErrors::new(errors).map_or(Ok(()), Err)
    }

    /// These errors and another one.
    pub(super) fn and(mut self, error: SceneError) -> SceneErrors {
        self.rest.push(error);
        self
    }

    /// The first error.
    pub fn first(&self) -> &SceneError {
        &self.first
    }

    /// All errors, in the order of their detection.
    pub fn iter(&self) -> impl Iterator<Item = &SceneError> {
        std::iter::once(&*self.first).chain(&self.rest)
    }
}

impl From<SceneError> for SceneErrors {
    fn from(error: SceneError) -> SceneErrors {
        SceneErrors { first: Box::new(error), rest: Vec::new() }
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.first)?;
        self.rest.iter().try_for_each(|error| write!(f, "\n{error}"))
    }
}

impl std::error::Error for SceneErrors {}

/// Line and column of a byte in a scene with this name.
pub(super) fn origin_at(text: &str, name: &str, offset: usize) -> Origin {
    let (line, column) = line_column(text, offset);
    Origin::Place { name: name.into(), line, column }
}

/// Overrides that cause an error: those of its field, else those of the involved fields, else all of them.
pub(super) fn overrides_behind(error: &SceneError, overrides: &[(String, String)]) -> Origin {
    let naming = |touches: &dyn Fn(&str) -> bool| {
        let touching = overrides.iter().filter(|(path, _)| touches(path));
        touching.map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>()
    };
    let mut source = naming(&|path| is_within(&error.field, path));
    if source.is_empty() {
        source = naming(&|path| {
            error.involves.iter().any(|field| is_within(field, path) || is_within(path, field))
        });
    }
    if source.is_empty() {
        source = naming(&|_| true);
    }
    Origin::Overrides(source)
}

/// Foreign text for a message: one line, shortened, without control characters.
pub(super) fn shown(text: &str) -> String {
    let mut shown = String::new();
    for (index, c) in text.chars().enumerate() {
        if index == MOST_SHOWN {
            shown.push('…');
            break;
        }
        match c {
            '\n' | '\r' | '\t' => shown.push(' '),
            c if is_control(c) => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error() -> SceneError {
        SceneError {
            origin: Origin::Place { name: "presets/x.ron".into(), line: 7, column: 24 },
            field: "roughness.hurst".into(),
            value: "1.4".into(),
            allowed: "above 0 and below 1".into(),
            message: "Hurst exponent".into(),
            involves: &[],
        }
    }

    #[test]
    fn an_error_is_one_line() {
        assert_eq!(
            error().to_string(),
            "presets/x.ron:7:24: roughness.hurst = 1.4: allowed: above 0 and below 1 (Hurst exponent)"
        );
        let origin = Origin::Overrides(vec!["roughness.hurst=1.4".into()]);
        let error = SceneError { origin, allowed: String::new(), message: "no".into(), ..error() };
        assert_eq!(error.to_string(), "--set roughness.hurst=1.4: roughness.hurst = 1.4: no");
        assert_eq!(error.what().to_string(), "roughness.hurst = 1.4: no");
    }

    #[test]
    fn errors_are_lines() {
        let errors = SceneErrors::new(vec![error(), error()]).unwrap();
        assert_eq!(errors.to_string().lines().count(), 2);
        assert_eq!(errors.iter().count(), 2);
        assert_eq!(SceneErrors::new(vec![]), None);
    }

    #[test]
    fn foreign_text_neither_floods_nor_controls_the_terminal() {
        assert_eq!(shown("a\u{1b}[2J\nb"), "a\\u{1b}[2J b");
        assert_eq!(shown("a\u{202e}b"), "a\\u{202e}b");
        assert_eq!(shown(&"x".repeat(1000)).chars().count(), MOST_SHOWN + 1);
    }

    fn pairs(overrides: &[(&str, &str)]) -> Vec<(String, String)> {
        overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect()
    }

    fn source(field: &str, involves: &'static [&'static str], overrides: &[(&str, &str)]) -> Vec<String> {
        let error = SceneError { field: field.into(), involves, ..SceneError::default() };
        match overrides_behind(&error, &pairs(overrides)) {
            Origin::Overrides(overrides) => overrides,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_nearest_overrides_are_the_source() {
        let overrides = [("roughness", "…"), ("numerics.points", "1"), ("length", "2")];
        for (field, involves, expected) in [
            ("length", &[][..], &["length=2"][..]),
            ("roughness.hurst", &[], &["roughness=…"]),
            ("form.radius", &["length", "numerics"], &["numerics.points=1", "length=2"]),
            ("form", &[], &["roughness=…", "numerics.points=1", "length=2"]),
            ("lengths", &["length"], &["length=2"]),
        ] {
            assert_eq!(source(field, involves, &overrides), expected, "{field}");
        }
    }
}
