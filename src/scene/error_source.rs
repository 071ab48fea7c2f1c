//! Source of the errors of a scene: a place in its text, or overrides.

use super::errors::{Origin, SceneError, SceneErrors};
use super::text::{Text, is_within, line_column};
use super::violation::Violation;

/// Most errors that are listed; further ones are only counted.
const MOST_LISTED: usize = 100;

/// Line and column of a byte in a scene of this name.
pub(super) fn origin_at(text: &str, name: &str, offset: usize) -> Origin {
    let (line, column) = line_column(text, offset);
    Origin::Place { name: name.into(), line, column }
}

/// First byte of a field's value, or of the nearest group around it.
pub(super) fn nearest_byte(text: &Text, field: &str) -> usize {
    let mut path = field;
    loop {
        if let Some(place) = text.span(path) {
            return place.value.start;
        }
        match path.rsplit_once('.') {
            Some((parent, _)) => path = parent,
            None => return text.opening("").unwrap_or(0),
        }
    }
}

/// Errors of violations, of which there is at least one.
pub(super) fn errors_of(violations: Vec<Violation>, origin: impl Fn(&Violation) -> Origin) -> SceneErrors {
    let count = violations.len();
    let mut errors: Vec<_> = violations
        .into_iter()
        .take(MOST_LISTED)
        .map(|violation| SceneError::new(origin(&violation), violation))
        .collect();
    if count > MOST_LISTED {
        errors.push(SceneError::whole(Origin::Scene, format!("and {} more errors", count - MOST_LISTED)));
    }
    all_errors(errors)
}

/// All errors of a list, of which there is at least one.
pub(super) fn all_errors(errors: Vec<SceneError>) -> SceneErrors {
    SceneErrors::new(errors)
        .unwrap_or_else(|| SceneErrors::from(SceneError::whole(Origin::Scene, "the scene was refused")))
}

/// Overrides that cause a violation: those of its field, else those of the fields that take part, else all of them.
pub(super) fn overrides_behind(violation: &Violation, overrides: &[(String, String)]) -> Origin {
    let naming = |touches: &dyn Fn(&str) -> bool| {
        let touching = overrides.iter().filter(|(path, _)| touches(path));
        touching.map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>()
    };
    let mut source = naming(&|path| is_within(&violation.field, path));
    if source.is_empty() {
        source = naming(&|path| {
            violation.involves.iter().any(|field| is_within(field, path) || is_within(path, field))
        });
    }
    if source.is_empty() {
        source = naming(&|_| true);
    }
    Origin::Overrides(source)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(overrides: &[(&str, &str)]) -> Vec<(String, String)> {
        overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect()
    }

    fn source(field: &str, involves: &'static [&'static str], overrides: &[(&str, &str)]) -> Vec<String> {
        let (value, allowed, reason) = (String::new(), String::new(), String::new());
        let violation = Violation { field: field.into(), value, allowed, reason, involves };
        match overrides_behind(&violation, &pairs(overrides)) {
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
