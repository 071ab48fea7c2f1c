//! Errors of a scene. Each error states its place, the invalid value and the allowed values.

use std::fmt;

use strsim::osa_distance;

use super::text::index::{is_within, line_column};
use asperity_data::shown;

/// Largest number of errors that an error message lists. Further errors are only counted.
pub(super) const MOST_LISTED: usize = 100;

/// Where an invalid value comes from: a file, changes of fields, or a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// A scene file or a built-in scene.
    File {
        /// Name of the file or of the built-in scene.
        name: String,
        /// Line and column, both from 1, of the invalid value; the column is in characters. `None`
        /// if the error concerns the whole file.
        place: Option<(usize, usize)>,
    },
    /// Changes of fields, each as `path=value`.
    Overrides(Vec<String>),
    /// A scene without a text, made by a program.
    #[default]
    Scene,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Origin::File {
                name,
                place: Some((line, column)),
            } => {
                write!(f, "{}:{line}:{column}: ", shown(name))
            }
            Origin::File { name, place: None } if name.is_empty() => f.write_str("\"\": "),
            Origin::File { name, place: None } => write!(f, "{}: ", shown(name)),
            Origin::Overrides(overrides) => {
                let overrides: Vec<String> = overrides.iter().map(|set| shown(set)).collect();
                write!(f, "{}: ", overrides.join(", "))
            }
            Origin::Scene => Ok(()),
        }
    }
}

/// One error of a scene: its place, the invalid value and the allowed values.
///
/// ```
/// use asperity_scene::{Material, Scene};
///
/// let errors = Scene::new(Material::isotropic(1.0e6, 0.7), 1.0e-4).checked().unwrap_err();
/// let error = errors.first();
/// assert_eq!((error.field.as_str(), error.value.as_str()), ("material.poisson_ratio", "0.7"));
/// assert_eq!(error.allowed, "above -1, at most 0.5");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, thiserror::Error)]
#[error("{origin}{}", self.what())]
pub struct SceneError {
    /// Where the invalid value comes from: a file, changes of fields, or a program.
    pub origin: Origin,
    /// Path of the field, such as `roughness.hurst`, or `loading.0` for the first loading stage.
    /// Empty if the error does not concern a single field.
    pub field: String,
    /// Invalid value as text, as it was written; empty if a value is missing.
    pub value: String,
    /// Allowed values of the field in words; empty if `message` states them.
    pub allowed: String,
    /// Reason of the error in words. If the only reason is that the value is not among the values
    /// in `allowed`, this is the name of the field instead.
    pub message: String,
}

impl SceneError {
    /// Returns an error that concerns a file or a scene as a whole.
    pub(super) fn whole(origin: Origin, message: impl Into<String>) -> SceneError {
        SceneError {
            origin,
            message: message.into(),
            ..SceneError::default()
        }
    }

    /// Returns an error about the value of a field. The origin of the error is set later by the
    /// function [`at`](Self::at).
    pub(super) fn of(
        field: &str,
        value: impl Into<String>,
        allowed: impl Into<String>,
        message: &str,
    ) -> SceneError {
        SceneError {
            field: field.into(),
            value: value.into(),
            allowed: allowed.into(),
            ..SceneError::whole(Origin::Scene, message)
        }
    }

    /// Returns the same error with another origin: a file, changes of fields, or a program.
    pub(super) fn at(self, origin: Origin) -> SceneError {
        SceneError { origin, ..self }
    }

    /// Returns the error as text without its origin, such as `roughness.hurst = 1.4: allowed: above
    /// 0 and below 1 (Hurst exponent)`. The text has the field, the value, the allowed values and
    /// the reason.
    pub fn what(&self) -> String {
        let field = shown(&self.field);
        let value = shown(&self.value);
        let subject = match (field.is_empty(), value.is_empty()) {
            (true, true) => String::new(),
            (true, false) => format!("{value}: "),
            (false, true) => format!("{field}: "),
            (false, false) => format!("{field} = {value}: "),
        };
        match (self.allowed.as_str(), self.message.as_str()) {
            ("", message) => format!("{subject}{message}"),
            (allowed, "") => format!("{subject}allowed: {allowed}"),
            (allowed, message) => format!("{subject}allowed: {allowed} ({message})"),
        }
    }
}

/// All errors of a scene, at least one. `Display` writes each error on its own line.
///
/// ```
/// use asperity_scene::{Material, Scene};
///
/// let mut scene = Scene::new(Material::effective(-1.0), 1.0e-4);
/// scene.numerics.points = 0;
/// let errors = scene.checked().unwrap_err();
/// assert_eq!((errors.iter().count(), errors.to_string().lines().count()), (2, 2));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneErrors(pub(super) Vec<SceneError>);

impl SceneErrors {
    /// Returns `Err` with the errors in the list, if there are any. The function `origin` returns
    /// where the value of an error comes from, such as a file. Of a long list only the first
    /// [`MOST_LISTED`] errors remain, and a last error states the number of the others.
    pub(super) fn result(
        mut errors: Vec<SceneError>,
        origin: impl Fn(&SceneError) -> Origin,
    ) -> Result<(), SceneErrors> {
        let more = errors.len().saturating_sub(MOST_LISTED);
        errors.truncate(MOST_LISTED);
        for error in &mut errors {
            error.origin = origin(error);
        }
        if more > 0 {
            errors.push(SceneError::whole(
                Origin::Scene,
                format!("and {more} more errors"),
            ));
        }
        if errors.is_empty() {
            Ok(())
        } else {
            Err(SceneErrors(errors))
        }
    }

    /// Returns the first error.
    pub fn first(&self) -> &SceneError {
        &self.0[0]
    }

    /// Returns an iterator over all errors.
    pub fn iter(&self) -> std::slice::Iter<'_, SceneError> {
        self.0.iter()
    }
}

impl From<SceneError> for SceneErrors {
    fn from(error: SceneError) -> SceneErrors {
        SceneErrors(vec![error])
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.iter().map(SceneError::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for SceneErrors {}

/// Reason why a numerical value of a scene cannot be set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NumberError {
    /// The scene has no numerical value at this path and cannot have one.
    #[error("the scene has no such number")]
    Missing,
    /// The new value contradicts another value of the scene. The string is a text for users that
    /// names both fields.
    #[error("{0}")]
    Contradiction(String),
}

/// Returns the origin of an error at a byte offset of a text: its line and column.
pub(super) fn origin_at(text: &str, name: &str, offset: usize) -> Origin {
    Origin::File {
        name: name.into(),
        place: Some(line_column(text, offset)),
    }
}

/// Returns the changes of fields that may have caused an error: changes of the field of the error,
/// of a group around this field, or of a field inside it. If there are no such changes, returns all
/// changes.
pub(super) fn overrides_behind(error: &SceneError, overrides: &[(String, String)]) -> Origin {
    let mut all = Vec::new();
    let mut behind = Vec::new();
    for (path, value) in overrides {
        let set = format!("{path}={value}");
        if is_within(&error.field, path) || is_within(path, &error.field) {
            behind.push(set.clone());
        }
        all.push(set);
    }
    Origin::Overrides(if behind.is_empty() { all } else { behind })
}

/// Largest length of a name that is compared with other names. A longer name is probably not a
/// misspelt one.
const LONGEST: usize = 64;

/// Returns the name among `names` that is most similar to the misspelt `name`; `None` if no name is
/// similar.
///
/// For a path with dots, the similarity of its last part is enough: the name `hurst` finds
/// `roughness.hurst`.
///
/// ```
/// use asperity_scene::text::nearest;
///
/// assert_eq!(nearest("parabloid", ["Cone", "Paraboloid"]), Some("Paraboloid"));
/// assert_eq!(nearest("sphere", ["Cone", "Paraboloid"]), None);
/// ```
pub fn nearest<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if name.is_empty() || name.len() > LONGEST {
        return None;
    }
    let mut nearest = None;
    let mut least = usize::MAX;
    for candidate in names {
        if let Some(distance) = distance_of_paths(name, candidate)
            && distance < least
        {
            nearest = Some(candidate);
            least = distance;
        }
    }
    nearest
}

/// Returns the distance between two paths: twice the number of differences between the whole paths,
/// or twice the number of differences between their last parts plus 1, whichever is smaller.
/// Returns `None` if the paths differ too much.
fn distance_of_paths(path: &str, other: &str) -> Option<usize> {
    let whole = distance_of_names(&path.to_lowercase(), &other.to_lowercase());
    let end = distance_of_names(&last_part(path), &last_part(other));
    match (whole, end) {
        (Some(whole), Some(end)) => Some((2 * whole).min(2 * end + 1)),
        (Some(whole), None) => Some(2 * whole),
        (None, Some(end)) => Some(2 * end + 1),
        (None, None) => None,
    }
}

fn last_part(path: &str) -> String {
    path.rsplit('.').next().unwrap_or_default().to_lowercase()
}

/// Returns the number of differences between two names. Returns `None` if this number is more than
/// a third of the length of `name`.
fn distance_of_names(name: &str, other: &str) -> Option<usize> {
    let distance = osa_distance(name, other);
    let most = (name.chars().count() / 3).max(1);
    (distance <= most).then_some(distance)
}

/// Returns a question to append to an error message, such as `; did you mean length?`, with the
/// name that is most similar to `name`. The text is empty if no name is similar.
pub fn did_you_mean<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> String {
    nearest(name, names).map_or_else(String::new, |near| format!("; did you mean {near}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_text_neither_floods_nor_controls_the_terminal() {
        assert_eq!(shown("a\u{1b}[2J\nb"), "a\\u{1b}[2J b");
        assert_eq!(shown("a\u{202e}b"), "a\\u{202e}b");
        assert_eq!(shown(&"x".repeat(1000)).chars().count(), 81);
    }

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        let names = [
            "roughness.hurst",
            "adhesion.work",
            "numerics.points",
            "length",
        ];
        for (name, expected) in [
            ("roughness.hurts", Some("roughness.hurst")),
            ("hurst", Some("roughness.hurst")),
            ("adhesion.Work", Some("adhesion.work")),
            ("lenght", Some("length")),
            ("points", Some("numerics.points")),
            ("nothing.like.it", None),
            ("", None),
        ] {
            assert_eq!(nearest(name, names), expected, "{name}");
        }
        assert_eq!(nearest(&"x".repeat(1_000_000), names), None);
    }
}
