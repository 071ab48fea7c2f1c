//! What a scene's errors are owed to: a place in its text, or overrides.

use super::check::Violation;
use super::errors::{Origin, SceneError, SceneErrors};
use super::text::{Text, line_column};

/// More errors than this are counted, not told one by one.
const MOST_TOLD: usize = 100;

pub(super) fn place(text: &str, name: &str, offset: usize) -> Origin {
    let (line, column) = line_column(text, offset);
    Origin::Place { name: name.into(), line, column }
}

/// Where a field's value starts, or that of the group nearest around it.
pub(super) fn nearest_place(text: &Text, field: &str) -> usize {
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

/// The errors of violations, of which there is at least one.
pub(super) fn told(violations: Vec<Violation>, origin: impl Fn(&Violation) -> Origin) -> SceneErrors {
    let count = violations.len();
    let mut errors: Vec<_> = violations
        .into_iter()
        .take(MOST_TOLD)
        .map(|violation| SceneError::of_violation(origin(&violation), violation))
        .collect();
    if count > MOST_TOLD {
        errors.push(SceneError::whole(Origin::Scene, format!("and {} more errors", count - MOST_TOLD)));
    }
    all_of(errors)
}

pub(super) fn all_of(errors: Vec<SceneError>) -> SceneErrors {
    SceneErrors::of(errors)
        .unwrap_or_else(|| SceneErrors::from(SceneError::whole(Origin::Scene, "the scene was refused")))
}

/// The overrides that caused a violation: those of its field, else those of the fields that take
/// part in it, else all of them.
pub(super) fn blamed(violation: &Violation, overrides: &[(String, String)]) -> Origin {
    let naming = |touches: &dyn Fn(&str) -> bool| {
        let touching = overrides.iter().filter(|(path, _)| touches(path));
        touching.map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>()
    };
    let mut blamed = naming(&|path| within(&violation.field, path));
    if blamed.is_empty() {
        blamed =
            naming(&|path| violation.involves.iter().any(|field| within(field, path) || within(path, field)));
    }
    if blamed.is_empty() {
        blamed = naming(&|_| true);
    }
    Origin::Overrides(blamed)
}

/// Adds an override, forgetting earlier ones of the same field or of what is inside it.
pub(super) fn remember(overrides: &mut Vec<(String, String)>, path: &str, value: &str) {
    overrides.retain(|(earlier, _)| !within(earlier, path));
    overrides.push((path.to_string(), value.to_string()));
}

/// Whether a path is another path or inside it.
pub(super) fn within(path: &str, other: &str) -> bool {
    path.strip_prefix(other).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(overrides: &[(&str, &str)]) -> Vec<(String, String)> {
        overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect()
    }

    fn blame(field: &str, involves: &'static [&'static str], overrides: &[(&str, &str)]) -> Vec<String> {
        let (value, allowed, reason) = (String::new(), String::new(), String::new());
        let violation = Violation { field: field.into(), value, allowed, reason, involves };
        match blamed(&violation, &pairs(overrides)) {
            Origin::Overrides(overrides) => overrides,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_nearest_overrides_are_blamed() {
        let overrides = [("roughness", "…"), ("numerics.points", "1"), ("length", "2")];
        for (field, involves, expected) in [
            ("length", &[][..], &["length=2"][..]),
            ("roughness.hurst", &[], &["roughness=…"]),
            ("form.radius", &["length", "numerics"], &["numerics.points=1", "length=2"]),
            ("form", &[], &["roughness=…", "numerics.points=1", "length=2"]),
            ("lengths", &["length"], &["length=2"]),
        ] {
            assert_eq!(blame(field, involves, &overrides), expected, "{field}");
        }
    }

    #[test]
    fn later_overrides_replace_what_they_cover() {
        let mut overrides = pairs(&[("form.radius", "1"), ("form", "2"), ("formal", "3"), ("length", "4")]);
        remember(&mut overrides, "form", "5");
        assert_eq!(overrides, pairs(&[("formal", "3"), ("length", "4"), ("form", "5")]));
        remember(&mut overrides, "form.radius", "6");
        assert_eq!(overrides.len(), 4);
    }
}
