//! A scene together with the text it came from, changed field by field without losing a comment.

use std::path::{Path, PathBuf};

use super::check::{Violation, check};
use super::errors::{Origin, SceneError, SceneErrors};
use super::locate::{Outline, line_column};
use super::model::Scene;
use super::read::{Unread, read, wrong_version};
use super::splice;
use super::write::to_ron;

/// Longer texts are refused before they are read; scenes are a few hundred bytes.
pub const LONGEST_TEXT: usize = 1 << 20;

/// More errors than this are counted, not told one by one.
const MOST_TOLD: usize = 100;

/// A checked scene, its text, and what was overridden in it. Changing it gives a new document;
/// where the change is refused, the old one stands as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    name: String,
    opened: String,
    text: String,
    scene: Scene,
    overrides: Vec<(String, String)>,
}

impl Document {
    /// Reads and checks a scene. `name` is the file's or the built-in scene's; errors carry it.
    ///
    /// # Errors
    ///
    /// The first place where the text is not a scene, or all values that are not allowed, each with
    /// line and column. A wrong version is told first, whatever else is wrong.
    pub fn parse(text: &str, name: &str) -> Result<Document, SceneErrors> {
        // Some editors put a byte order mark before the text.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        check_length(text).map_err(|message| {
            SceneErrors::from(SceneError::whole(Origin::File { name: name.into() }, message))
        })?;
        let scene = read(text).map_err(|unread| {
            let tell = |unread: Unread| {
                let origin = place(text, name, unread.offset);
                unread.told(origin)
            };
            let mut errors: Vec<_> = wrong_version(text).into_iter().chain([unread]).map(tell).collect();
            errors.dedup_by(|second, first| second.field == "version" && first.field == "version");
            all_of(errors)
        })?;
        let violations = check(&scene);
        if violations.is_empty() {
            let (name, text) = (name.to_string(), text.to_string());
            return Ok(Document { name, opened: text.clone(), text, scene, overrides: Vec::new() });
        }
        let outline = Outline::of(text).ok();
        let locate = |field: &str| {
            let offset = outline.as_ref().map_or(0, |outline| nearest_place(outline, field));
            place(text, name, offset)
        };
        Err(told(violations, |violation| locate(&violation.field)))
    }

    /// A document for a scene that was made in the program, written in canonical form.
    ///
    /// # Errors
    ///
    /// All values that are not allowed.
    pub fn of_scene(scene: &Scene, name: &str) -> Result<Document, SceneErrors> {
        let violations = check(scene);
        if violations.is_empty() {
            Document::parse(&to_ron(scene), name)
        } else {
            Err(told(violations, |_| Origin::Scene))
        }
    }

    /// This document with one field overridden; see [`Document::set_all`].
    ///
    /// # Errors
    ///
    /// As [`Document::set_all`].
    pub fn set(&self, path: &str, value: &str) -> Result<Document, SceneErrors> {
        self.set_all(&[(path.to_string(), value.to_string())])
    }

    /// This document with fields overridden, one after the other. Values are written in RON.
    ///
    /// A field that is not in the text is inserted there, with its group; `None` takes an optional
    /// part away. Ranges are checked once, at the end, so overrides that are allowed only together
    /// may be given in any order.
    ///
    /// # Errors
    ///
    /// Everything that is wrong, each error naming the overrides that caused it.
    pub fn set_all(&self, overrides: &[(String, String)]) -> Result<Document, SceneErrors> {
        let mut new = self.clone();
        let mut errors = Vec::new();
        for (path, value) in overrides {
            match new.splice(path, value) {
                Ok(()) => remember(&mut new.overrides, path, value),
                Err(error) => errors.push(error),
            }
        }
        if let Some(errors) = SceneErrors::of(errors) {
            return Err(errors);
        }
        let violations = check(&new.scene);
        if violations.is_empty() {
            Ok(new)
        } else {
            Err(told(violations, |violation| blamed(violation, overrides)))
        }
    }

    /// Changes text and scene, leaving both as they are where that fails.
    fn splice(&mut self, path: &str, value: &str) -> Result<(), SceneError> {
        let origin = Origin::Overrides(vec![format!("{path}={value}")]);
        let text = splice::set(&self.text, path, value)
            .and_then(|text| check_length(&text).map(|()| text))
            .map_err(|message| SceneError::whole(origin.clone(), message))?;
        self.scene = read(&text).map_err(|unread| unread.told(origin))?;
        self.text = text;
        Ok(())
    }

    /// The text as it stands now, with all comments.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The scene, checked.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Name of the file or of the built-in scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The overrides since the text was opened that still matter, in the order given: applied to
    /// the opened text they give this document's scene.
    pub fn overrides(&self) -> &[(String, String)] {
        &self.overrides
    }

    /// Whether the text differs from the one that was opened.
    pub fn is_changed(&self) -> bool {
        self.text != self.opened
    }

    /// The file a scene names, which is relative to the scene's own.
    pub fn resolve(&self, file: &str) -> PathBuf {
        Path::new(&self.name).parent().unwrap_or(Path::new("")).join(file)
    }
}

impl Unread {
    fn told(self, origin: Origin) -> SceneError {
        let Unread { field, value, allowed, message, .. } = self;
        SceneError { origin, field, value, allowed, message }
    }
}

fn check_length(text: &str) -> Result<(), String> {
    if text.len() > LONGEST_TEXT {
        return Err(format!("the scene is {} bytes long, at most {LONGEST_TEXT} are read", text.len()));
    }
    Ok(())
}

fn place(text: &str, name: &str, offset: usize) -> Origin {
    let (line, column) = line_column(text, offset);
    Origin::Place { name: name.into(), line, column }
}

/// Where a field's value starts, or that of the group nearest around it.
fn nearest_place(outline: &Outline, field: &str) -> usize {
    let mut path = field;
    loop {
        if let Some(place) = outline.find(path) {
            return place.value.start;
        }
        match path.rsplit_once('.') {
            Some((parent, _)) => path = parent,
            None => return outline.body("").map_or(0, |body| outline.inside(body).start.saturating_sub(1)),
        }
    }
}

/// The errors of violations, of which there is at least one.
fn told(violations: Vec<Violation>, origin: impl Fn(&Violation) -> Origin) -> SceneErrors {
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

fn all_of(errors: Vec<SceneError>) -> SceneErrors {
    SceneErrors::of(errors)
        .unwrap_or_else(|| SceneErrors::from(SceneError::whole(Origin::Scene, "the scene was refused")))
}

/// The overrides that caused a violation: those of its field, else those of the fields that take
/// part in it, else all of them.
fn blamed(violation: &Violation, overrides: &[(String, String)]) -> Origin {
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
fn remember(overrides: &mut Vec<(String, String)>, path: &str, value: &str) {
    overrides.retain(|(earlier, _)| !within(earlier, path));
    overrides.push((path.to_string(), value.to_string()));
}

/// Whether a path is another path or inside it.
fn within(path: &str, other: &str) -> bool {
    path.strip_prefix(other).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
