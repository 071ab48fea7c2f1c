//! A scene with its text. If a field is changed, the comments of the text stay.
//!
//! A change is made in the text, and the scene is read again from the text, because the author of
//! the scene sees and saves the text. The scene alone is not enough for three reasons:
//!
//! * it does not have the notation of the numbers;
//! * it does not know which fields the text leaves out, and the default of such a field may depend
//!   on other fields;
//! * between two changes that belong together, the scene would contradict itself.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::checked::CheckedScene;
use super::effects::Effect;
use super::errors::{Origin, SceneError, SceneErrors, origin_at, overrides_behind};
use super::field::Field;
use super::fields::{FIELDS, field as known};
use super::model::Scene;
use super::read::read;
use super::stages::{stage_in_ron, stages_in_ron};
use super::text::index::{Text, is_within, line_column};
use super::typed::{check_length, with_typed};
use super::written::to_ron;
use asperity_contact::Move;

/// A checked scene with its text in RON (Rusty Object Notation) and the changes of its fields. A
/// change returns a new document and leaves this document unchanged.
///
/// ```
/// use asperity_scene::Document;
///
/// let text = "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4) // flat";
/// let flat = Document::parse(text, "flat.ron")?;
/// // Edits keep comments.
/// let longer = flat.set("length", "2 mm")?;
/// assert!(longer.scene().length == 2.0e-3 && longer.text().ends_with("// flat"));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    name: String,
    opened: String,
    text: Text,
    scene: CheckedScene,
    overrides: Vec<(String, String)>,
    table_head: String,
    /// Optional parts of the scene that were switched off, with the values that changed at the same
    /// time.
    pub(super) removed: Vec<RemovedEffect>,
    /// Choices that a key of the explorer has replaced by other choices.
    pub(super) left: Vec<LeftChoice>,
}

/// An optional part of the scene that was switched off, with the values that changed at the same
/// time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RemovedEffect {
    pub(super) effect: Effect,
    pub(super) values: Vec<RemovedValue>,
}

/// A value that changed when an optional part was switched off: its text before and after.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RemovedValue {
    pub(super) path: String,
    pub(super) former: String,
    pub(super) present: String,
}

/// A choice that a key of the explorer has replaced: the path of its field, and the text that the
/// choice had last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LeftChoice {
    pub(super) path: &'static str,
    pub(super) text: String,
}

impl Document {
    /// Reads and checks the text of a scene. Error messages begin with `name`, the name of the file
    /// or built-in scene.
    ///
    /// # Errors
    /// Returns the first syntax error, or an error for each invalid value, with line and column.
    ///
    /// ```
    /// use asperity_scene::Document;
    ///
    /// let text = "(version: 1, material: (modulus: 1.0e6), length: -1.0)";
    /// let errors = Document::parse(text, "my.ron").unwrap_err();
    /// assert_eq!(
    ///     errors.to_string(),
    ///     "my.ron:1:50: length = -1.0: allowed: from 1e-9 to 10 m (apparent diameter)"
    /// );
    /// ```
    pub fn parse(source: &str, name: &str) -> Result<Document, SceneErrors> {
        // Some editors write a byte order mark before the text.
        let source = source.strip_prefix('\u{feff}').unwrap_or(source);
        check_length(source).map_err(|message| {
            SceneError::whole(
                Origin::File {
                    name: name.into(),
                    place: None,
                },
                message,
            )
        })?;
        let origin = |offset| origin_at(source, name, offset);
        let scene = read(source, origin)?;
        let text = Text::new(source).map_err(|unreadable| {
            SceneError::whole(origin(unreadable.offset), unreadable.reason)
        })?;
        let scene = CheckedScene::of(scene, Some(&text), |error| {
            origin(text.nearest_value(&error.field))
        })?;
        Ok(Document {
            name: name.to_owned(),
            opened: source.to_owned(),
            text,
            scene,
            overrides: Vec::new(),
            table_head: String::new(),
            removed: Vec::new(),
            left: Vec::new(),
        })
    }

    /// Creates a document from a scene that a program has made and that therefore has no text. The
    /// document gets the text that [`to_ron`] writes. `name` is the name with which error messages
    /// begin.
    ///
    /// # Errors
    /// Returns an error for each invalid value.
    pub fn from_scene(scene: &Scene, name: &str) -> Result<Document, SceneErrors> {
        scene.clone().checked()?;
        Document::parse(&to_ron(scene), name)
    }

    /// Returns this document with one field changed. `path` is the path of the field, such as
    /// `length`. `value` is the new value in RON, or a number with a unit, such as `2 mm`.
    ///
    /// # Errors
    /// Returns the same errors as [`Document::set_all`].
    pub fn set(&self, path: &str, value: &str) -> Result<Document, SceneErrors> {
        self.set_all(&[pair(path, value)])
    }

    /// Returns this document with fields changed one after the other. Each pair in `overrides` is
    /// the path of a field and its new value in RON. A number may have an SI prefix and a unit,
    /// such as `50 mJ/m²`. The RON text `None` removes an optional part. The values are checked
    /// once, after all changes.
    ///
    /// If a built-in scene is changed so that its solution differs, its title becomes the name of
    /// the scene with the word *changed*. Its notice, and the comments beside the changed values,
    /// are removed, because they would be false. A title, a notice or comments that the user has
    /// written stay.
    ///
    /// # Errors
    /// Returns an error for each pair that cannot be read, and for each invalid value.
    pub fn set_all(&self, overrides: &[(String, String)]) -> Result<Document, SceneErrors> {
        Ok(self.overridden(overrides)?.with_true_words())
    }

    /// Returns this document with fields changed. Title, notice and comments stay as they are.
    fn overridden(&self, overrides: &[(String, String)]) -> Result<Document, SceneErrors> {
        let mut new = self.clone();
        let mut errors = Vec::new();
        for (path, value) in overrides {
            match with_typed(&new.text, path, value) {
                Ok(text) => {
                    new.text = text;
                    remember(&mut new.overrides, path, value);
                }
                Err(refused) => errors.extend(refused.0),
            }
        }
        let scene = read(new.text.as_str(), |_| Origin::Scene);
        if let Err(unread) = &scene {
            for error in unread.iter() {
                errors.push(error.clone().at(overrides_behind(error, overrides)));
            }
        }
        SceneErrors::result(errors, |error| error.origin.clone())?;
        if let Ok(scene) = scene
            && !overrides.is_empty()
        {
            new.scene = CheckedScene::of(scene, Some(&new.text), |error| {
                overrides_behind(error, overrides)
            })?;
        }
        Ok(new)
    }

    /// Returns this document with only those descriptions (title, notice and comments) that are
    /// true for its values.
    fn with_true_words(mut self) -> Document {
        if let Some(text) = self.text_with_true_words()
            && let Ok(scene) = read(text.as_str(), |_| Origin::Scene)
            && let Ok(scene) = scene.checked()
        {
            self.text = text;
            self.scene = scene;
        }
        if !self.is_changed() {
            self.overrides.clear();
        }
        self
    }

    pub(super) fn indexed_text(&self) -> &Text {
        &self.text
    }

    /// Returns the loading stages of the scene, each with its index in the loading. The list can be
    /// changed and passed to [`Document::with_stages`], where a new stage has the index `None`.
    pub fn stages(&self) -> Vec<(Option<usize>, Move)> {
        self.scene
            .loading
            .iter()
            .enumerate()
            .map(|(place, stage)| (Some(place), *stage))
            .collect()
    }

    /// Returns this document with other loading stages. If a stage has an index, it keeps the text
    /// and the comments of the present stage with this index. A stage without an index is new.
    ///
    /// # Errors
    /// Returns the same errors as [`Document::set`].
    pub fn with_stages(&self, stages: &[(Option<usize>, Move)]) -> Result<Document, SceneErrors> {
        let elements: Vec<_> = stages
            .iter()
            .map(|(place, stage)| (*place, stage_in_ron(stage)))
            .collect();
        let loading: Vec<Move> = stages.iter().map(|(_, stage)| *stage).collect();
        let mut new = self.overridden(&[pair("loading", stages_in_ron(&loading))])?;
        if let Some(arranged) = self.text.arrange("loading", &elements)
            && is_text_of(&arranged, &new.scene)
        {
            new.text = arranged;
        }
        Ok(new.with_true_words())
    }

    /// Returns the present text of the scene, with all comments.
    pub fn text(&self) -> &str {
        self.text.as_str()
    }

    /// Returns the checked scene.
    pub fn scene(&self) -> &CheckedScene {
        &self.scene
    }

    /// Returns the value of a field as the text states it. If the text omits the field, returns the
    /// default. Returns `None` if this scene cannot have the field, for example the angle of a cone
    /// in a scene with a sphere.
    pub fn value(&self, path: &str) -> Option<&str> {
        if let Some(value) = self.text.value(path) {
            return Some(value);
        }
        let field = FIELDS
            .iter()
            .find(|field| field.path == path && self.has(field));
        let of_sphere = self.scene.number(path).and_then(|_| known(path, None));
        let default = field.or(of_sphere)?.default_in(&self.scene);
        (!default.is_empty()).then_some(default)
    }

    /// Returns the fields that this scene has or may have. A field is left out if it belongs to a
    /// choice that the scene does not have: the angle of a cone, for example, in a scene with a
    /// sphere.
    pub fn fields(&self) -> Vec<&'static Field> {
        FIELDS.iter().filter(|field| self.has(field)).collect()
    }

    fn has(&self, field: &Field) -> bool {
        field.variant.is_none() || field.is_in(&self.scene)
    }

    /// Returns the name of the file or of the built-in scene from which the document was read.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the title of the scene, or the name of its file without folders if the scene has no
    /// title.
    pub fn title(&self) -> &str {
        if self.scene.title.is_empty() {
            self.file_name()
        } else {
            &self.scene.title
        }
    }

    /// Returns the name of the file without folders, or of the built-in scene.
    pub(super) fn file_name(&self) -> &str {
        Path::new(&self.name)
            .file_name()
            .and_then(OsStr::to_str)
            .unwrap_or(&self.name)
    }

    /// Returns the changes since the text was opened. Each change is the path of a field and its
    /// new value.
    pub fn overrides(&self) -> &[(String, String)] {
        &self.overrides
    }

    /// Returns this document with `head`, the lines above the scene in the table of results from
    /// which the document was read.
    pub(super) fn of_table(self, head: &str) -> Document {
        Document {
            table_head: head.to_string(),
            ..self
        }
    }

    /// Returns the lines above the scene in the CSV table of results from which the document was
    /// read. If it was not read from such a table, returns an empty text.
    pub fn table_head(&self) -> &str {
        &self.table_head
    }

    /// Returns the number of comments in the text of the scene.
    pub fn comments(&self) -> usize {
        self.text.comments()
    }

    /// Returns the line and the column of a field in the text, both from 1. For an omitted field,
    /// returns the line and the column of the group to which the field belongs.
    pub fn place(&self, path: &str) -> (usize, usize) {
        line_column(self.text(), self.text.nearest_value(path))
    }

    /// Returns this document with the history of an earlier session of the program. `opened` is the
    /// text with which that session began. `overrides` are the changes of fields since then, each
    /// with the path of the field and its new value.
    pub fn resumed(self, opened: String, overrides: Vec<(String, String)>) -> Document {
        Document {
            opened,
            overrides,
            ..self
        }
    }

    /// Returns the text as it was when the document was opened.
    pub fn opened(&self) -> &str {
        &self.opened
    }

    /// Returns true if the present text differs from [`Self::opened`].
    pub fn is_changed(&self) -> bool {
        self.text.as_str() != self.opened
    }

    /// Returns this document with other names of measured files. `rename` receives each name and
    /// returns the new name. If a name changes, the text loses its comments.
    ///
    /// # Errors
    /// Returns an error for each invalid value.
    pub fn moved_to(&self, rename: impl Fn(&str) -> String) -> Result<Document, SceneErrors> {
        let mut scene = Scene::clone(&self.scene);
        scene.rename_measured_files(rename);
        if scene == *self.scene {
            Ok(self.clone())
        } else {
            Document::from_scene(&scene, &self.name)
        }
    }

    /// Returns the path of the file with the name `file`, which is relative to the folder of the
    /// scene file.
    pub fn resolve(&self, file: &str) -> PathBuf {
        Path::new(&self.name)
            .parent()
            .unwrap_or(Path::new(""))
            .join(file)
    }
}

/// Returns true if the text can be read and gives exactly this scene.
fn is_text_of(text: &Text, scene: &Scene) -> bool {
    check_length(text.as_str()).is_ok()
        && read(text.as_str(), |_| Origin::Scene).is_ok_and(|other| other == *scene)
}

pub(super) fn pair(path: &str, value: impl Into<String>) -> (String, String) {
    (path.to_string(), value.into())
}

/// Adds a change of a field to the list of changes. Earlier changes of the same field and of fields
/// inside it are removed from the list.
fn remember(overrides: &mut Vec<(String, String)>, path: &str, value: &str) {
    overrides.retain(|(earlier, _)| !is_within(earlier, path));
    overrides.push(pair(path, value));
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"(
    version: 1,
    material: (modulus: 1.0e6), // soft
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1),
    loading: [ToForce(1.0e-5), ToSeparation],
)
"#;

    fn document() -> Document {
        Document::parse(SCENE, "a/scene.ron").unwrap()
    }

    fn lines(errors: &SceneErrors) -> Vec<String> {
        errors.to_string().lines().map(str::to_string).collect()
    }

    fn pairs(overrides: &[(&str, &str)]) -> Vec<(String, String)> {
        overrides
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect()
    }

    #[test]
    fn groups_take_prefixes_and_units_inside() {
        let document = document();
        for (path, group, expected) in [
            (
                "form",
                "Cone(angle: 45°)",
                ("form.angle", "0.7853981633974483"),
            ),
            (
                "form",
                "WavySphere(radius: 1 mm, amplitude: 20nm, wavelength: 9µm)",
                ("form.amplitude", "2e-8"),
            ),
            (
                "roughness",
                "SelfAffine(hurst: 0.7, rms_height: 2nm, modes: (1, 512), seed: 1)",
                ("roughness.rms_height", "2e-9"),
            ),
            ("adhesion", "(work: 45 mJ/m2)", ("adhesion.work", "0.045")),
            (
                "material",
                "(youngs_modulus: 2MPa, poisson_ratio: 0)",
                ("material.youngs_modulus", "2000000.0"),
            ),
        ] {
            let set = document.set(path, group).unwrap();
            let same = document
                .set(path, group)
                .and_then(|document| document.set(expected.0, expected.1));
            assert_eq!(set.scene(), same.unwrap().scene(), "{group}");
        }
        let refused = document
            .set("form", "Cone(angle: 3 kg)")
            .unwrap_err()
            .to_string();
        assert!(refused.contains("form"), "{refused}");
    }

    #[test]
    fn several_errors_are_stated_with_their_places() {
        let text = SCENE
            .replace("0.7", "1.4")
            .replace("1.0e-4", "NaN")
            .replace("ToForce(1.0e-5), ", "");
        assert_eq!(
            lines(&Document::parse(&text, "a/scene.ron").unwrap_err()),
            [
                "a/scene.ron:4:13: length = NaN: allowed: from 1e-9 to 10 m (apparent diameter)",
                "a/scene.ron:5:34: roughness.hurst = 1.4: allowed: above 0 and below 1 (Hurst exponent)",
                "a/scene.ron:6:15: loading.0 = ToSeparation: cannot pull before contact: start with \
                 ToTouch, ToForce or ToIndentation",
            ]
        );
    }

    #[test]
    fn a_wrong_version_is_stated_first() {
        let newer = SCENE.replace("version: 1", "version: 2");
        for text in [newer.replace("hurst", "hurts"), newer] {
            let errors = Document::parse(&text, "x").unwrap_err();
            assert_eq!(
                lines(&errors),
                ["x:2:14: version = 2: allowed: 1 (version)"]
            );
        }
        let unknown = Document::parse(&SCENE.replace("version: 1", "version: 3"), "x").unwrap_err();
        assert_eq!(
            lines(&unknown),
            ["x:2:14: version = 3: allowed: 1 (version)"]
        );
        let missing = Document::parse(&SCENE.replace("version: 1,", ""), "x").unwrap_err();
        assert_eq!(missing.first().field, "version");
    }

    #[test]
    fn a_flood_of_errors_is_counted() {
        let text = SCENE.replace("ToForce(1.0e-5), ", &"ToForce(NaN), ".repeat(5_000));
        let errors = Document::parse(&text, "x").unwrap_err();
        assert_eq!(errors.iter().count(), 101);
        assert!(errors.to_string().ends_with("and 4900 more errors"));
    }

    #[test]
    fn overrides_allowed_only_together_are_checked_together() {
        let document = document();
        assert!(document.set("numerics.points", "64").is_err());
        for both in [
            [("numerics.points", "64"), ("roughness.modes", "(1, 32)")],
            [("roughness.modes", "(1, 32)"), ("numerics.points", "64")],
        ] {
            assert_eq!(
                document
                    .set_all(&pairs(&both))
                    .unwrap()
                    .scene()
                    .numerics
                    .points,
                64
            );
        }
    }

    #[test]
    fn errors_name_the_overrides_that_cause_them() {
        let document = document();
        let refused =
            |overrides: &[(&str, &str)]| lines(&document.set_all(&pairs(overrides)).unwrap_err());
        assert_eq!(
            refused(&[("length", "2.0e-4"), ("roughness.hurst", "1.4")]),
            [
                "roughness.hurst=1.4: roughness.hurst = 1.4: allowed: above 0 and below 1 (Hurst exponent)"
            ]
        );
        assert_eq!(
            refused(&[("length", "2.0e-4"), ("numerics.points", "64")]),
            [
                "length=2.0e-4, numerics.points=64: roughness.modes = (1, 512): allowed: last mode at most \
                 points/2 = 32 (64 springs carry no shorter wave)"
            ]
        );
        let errors = refused(&[
            ("roughness.seed", "1.5"),
            ("length", "\"x\""),
            ("nothing", "1"),
        ]);
        assert_eq!(errors.len(), 2);
        assert!(errors[0].starts_with("nothing=1: no such field"));
        assert!(errors[1].starts_with("length=\"x\": length = \"x\": allowed: from 1e-9 to 10 m"));
    }

    #[test]
    fn overrides_that_matter_are_remembered() {
        let mut document = document();
        assert!(!document.is_changed());
        for (path, value) in [
            ("roughness.hurst", "0.6"),
            ("length", "2.0e-4"),
            ("roughness.hurst", "0.5"),
            ("numerics.points", "2048"),
            ("loading.0", "ToTouch"),
            ("loading", "[ToTouch, ToSeparation]"),
        ] {
            document = document.set(path, value).unwrap();
        }
        let expected = [
            ("length", "2.0e-4"),
            ("roughness.hurst", "0.5"),
            ("numerics.points", "2048"),
            ("loading", "[ToTouch, ToSeparation]"),
        ];
        assert_eq!(document.overrides(), pairs(&expected));
        assert!(document.is_changed());
        let again = self::document().set_all(document.overrides()).unwrap();
        assert_eq!(again.scene(), document.scene());
        assert!(document.text().contains("// soft"));
        assert!(
            !self::document()
                .set("length", "1.0e-4")
                .unwrap()
                .is_changed()
        );
    }

    #[test]
    fn values_are_given_as_written_or_as_left_out() {
        let document = document().set("adhesion", "Some(work: Some(0.1))").unwrap();
        for (path, value) in [
            ("length", Some("1.0e-4")),
            ("roughness.hurst", Some("0.7")),
            ("loading.0.0", Some("1.0e-5")),
            ("adhesion.work", Some("0.1")),
            ("adhesion.kappa", Some("None")),
            ("form", Some("None")),
            ("form.radius", None),
            ("numerics.points", Some("16384")),
            ("numerics.solver.step", None),
            ("nothing", None),
        ] {
            assert_eq!(document.value(path), value, "{path}");
        }
        let paths: Vec<_> = document.fields().iter().map(|field| field.path).collect();
        assert!(paths.contains(&"roughness.hurst") && paths.contains(&"material.poisson_ratio"));
        assert!(!paths.contains(&"form.radius") && !paths.contains(&"roughness.file"));
        let punch = document.set("form", "Punch(radius: 1.0e-5)").unwrap();
        let radius = punch
            .fields()
            .into_iter()
            .find(|field| field.path == "form.radius")
            .unwrap();
        assert_eq!(radius.variant, Some("Punch"));
    }
}
