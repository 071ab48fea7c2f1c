//! Sources of scenes: the built-in scenes, the user's own folder of scenes, and the working folder.

use std::path::{Component, Path, PathBuf, is_separator};
use std::{fs, io};

use etcetera::{BaseStrategy, choose_base_strategy, home_dir};

use super::document::Document;
use super::errors::{Origin, SceneError, SceneErrors};
use super::text::index::Text;
use super::typed::LONGEST_TEXT;
use asperity_data::{ReadError, path_name, printable, read_regular_text};

/// Name of the built-in scene that the program opens if the user names no other.
pub const DEFAULT: &str = "pressure-sensitive";

/// A built-in scene, or a built-in plan of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name of the scene or plan, as a user types it on the command line.
    pub name: &'static str,
    /// Text of the scene or plan in RON.
    pub text: &'static str,
}

/// Makes a list of [`Preset`]s from files in a folder of the calling crate. The arguments are the
/// path of the folder and the names of the files without the ending `.ron`.
#[macro_export]
macro_rules! built_in {
    ($folder:literal: $($name:literal),* $(,)?) => {
        &[$($crate::Preset {
            name: $name,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/", $folder, $name, ".ron")),
        }),*]
    };
}

const PRESETS: &[Preset] = built_in!["presets/":
    "ideal-adhesion",
    "pressure-sensitive",
    "non-adhesive",
    "profile-hurst-025",
    "profile-hurst-075",
    "patch-closeup",
    "jkr-sphere",
    "rounded-cone",
    "two-spheres",
    "kendall-punch",
    "rough-sphere",
    "million-springs",
    "two-works",
    "wavy-sphere",
    "elastic-energy-below",
    "elastic-energy-above",
];

/// Returns all built-in scenes, in the order in which lists show them.
///
/// ```
/// use asperity_scene::presets;
///
/// assert!(presets().iter().any(|preset| preset.name == "jkr-sphere"));
/// ```
pub fn presets() -> &'static [Preset] {
    PRESETS
}

/// Returns the built-in scene with this name; `None` if there is none.
pub fn find_scene(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}

/// Converts typed text to a path. A leading `~` is replaced by the home folder, if there is one.
pub fn typed_path(text: &str) -> PathBuf {
    let text = text.trim();
    if let Some(inside) = text.strip_prefix('~')
        && (inside.is_empty() || inside.starts_with(is_separator))
        && let Ok(home) = home_dir()
    {
        return home.join(inside.trim_start_matches(is_separator));
    }
    PathBuf::from(text)
}

/// The source of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// Built into the program.
    BuiltIn,
    /// The user's own folder of scenes.
    Own,
    /// The working folder.
    Working,
}

/// Item of the list that [`scenes`] returns. The item is a scene, or a file whose name ends in
/// `.ron` but that has no valid scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name of the scene. The name of a file in the working folder ends in `.ron`. Other names have
    /// no ending.
    pub name: String,
    /// Source of the scene.
    pub origin: Source,
    /// Path of the file; `None` for a built-in scene.
    pub path: Option<PathBuf>,
    /// Text of the file; empty if it cannot be read.
    pub text: String,
    /// The scene, or the errors in its file.
    pub document: Result<Document, SceneErrors>,
}

/// Returns the folder of the user's own scenes, which need not exist. The folder is
/// `asperity/presets` in `$XDG_CONFIG_HOME` or in `~/.config`. On Windows `asperity/presets` is in
/// the folder for roaming application data. Returns `None` if the user has no home folder.
pub fn own_folder() -> Option<PathBuf> {
    let strategy = choose_base_strategy().ok()?;
    Some(strategy.config_dir().join("asperity").join("presets"))
}

/// Returns the path of the file with the scene `name` in the user's own folder `own`; `None` if
/// this file does not exist.
pub(super) fn own_scene(own: &Path, name: &str) -> Option<PathBuf> {
    let mut components = Path::new(name).components();
    let is_name =
        matches!(components.next(), Some(Component::Normal(_))) && components.next().is_none();
    let path = own.join(format!("{name}.ron"));
    (is_name && path.is_file()).then_some(path)
}

/// Returns the names of the scenes in the user's own folder.
pub(super) fn own_names(own: &Path) -> Vec<String> {
    scene_files(own)
        .unwrap_or_default()
        .iter()
        .map(|path| name_of(path, Source::Own))
        .collect()
}

/// Lists all scenes. The built-in scenes come first, then the scenes in the user's folder `own`,
/// then the scenes in the folder `working`. All files whose names end in `.ron` are listed, except
/// for plans of studies. A file that is not a valid scene is listed with its error message.
pub fn scenes(own: Option<&Path>, working: &Path) -> Vec<Entry> {
    let mut entries = Vec::new();
    for preset in presets() {
        let text = Ok(preset.text.into());
        entries.push(Entry::new(preset.name.into(), Source::BuiltIn, None, text));
    }
    let mut own_place = None;
    if let Some(own) = own {
        entries.extend(list_folder(own, Source::Own));
        own_place = own.canonicalize().ok();
    }
    // If `own` and `working` are the same folder, the folder is listed only once.
    if own_place.is_none() || own_place != working.canonicalize().ok() {
        entries.extend(list_folder(working, Source::Working));
    }
    entries
}

impl Entry {
    /// Creates the entry of a scene from its text, or from the reason why its file could not be
    /// read.
    fn new(
        name: String,
        origin: Source,
        path: Option<PathBuf>,
        text: Result<String, String>,
    ) -> Entry {
        let file = path
            .as_ref()
            .map_or_else(|| name.clone(), |path| path.display().to_string());
        let document = match &text {
            Ok(text) => Document::parse(text, &file),
            Err(error) => Err(SceneError::whole(
                Origin::File {
                    name: file,
                    place: None,
                },
                error.as_str(),
            )
            .into()),
        };
        Entry {
            name,
            origin,
            path,
            text: text.unwrap_or_default(),
            document,
        }
    }

    /// Returns the title of the scene; empty if it has none.
    pub fn title(&self) -> &str {
        self.document
            .as_ref()
            .map_or("", |document| &document.scene().title)
    }

    /// Returns the notes on the scene; empty if it has none.
    pub fn notice(&self) -> &str {
        self.document
            .as_ref()
            .map_or("", |document| &document.scene().notice)
    }

    /// Returns the first error of the file on one line, with its position and the number of further
    /// errors. Returns `None` for a valid scene.
    pub fn error(&self) -> Option<String> {
        let errors = self.document.as_ref().err()?;
        let first = errors.first();
        let more = errors.iter().count() - 1;
        let place = match &first.origin {
            Origin::File {
                place: Some((line, column)),
                ..
            } => format!("line {line}, column {column}: "),
            _ => String::new(),
        };
        let more = if more > 0 {
            format!(" (and {more} more)")
        } else {
            String::new()
        };
        Some(format!("{place}{}{more}", first.what()))
    }
}

/// Lists the scenes of a folder, sorted by name. If the folder does not exist, the list is empty.
fn list_folder(folder: &Path, origin: Source) -> Vec<Entry> {
    let mut paths = match scene_files(folder) {
        Ok(paths) => paths,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Vec::new(),
        Err(error) => {
            let error = format!("cannot be read: {error}");
            return vec![Entry::new(
                path_name(folder),
                origin,
                Some(folder.to_path_buf()),
                Err(error),
            )];
        }
    };
    paths.sort_by_cached_key(|path| name_of(path, origin));
    let mut entries = Vec::new();
    for path in paths {
        let name = printable(&name_of(&path, origin)).into_owned();
        let text = read_regular_text(&path, LONGEST_TEXT).map_err(describe);
        let entry = Entry::new(name, origin, Some(path), text);
        if entry.document.is_ok() || !is_plan(&entry.text) {
            entries.push(entry);
        }
    }
    entries
}

/// Returns true if a text is the plan of a study, which contains a scene as its part `scene`.
pub fn is_plan(text: &str) -> bool {
    Text::new(text).is_ok_and(|text| text.span("scene").is_some())
}

/// Lists the files of a folder whose names end in `.ron`, without reading the files.
fn scene_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let Ok(entry) = entry else {
            continue;
        };
        let path = entry.path();
        // `is_dir` follows links. A link without a target is not a folder, so the link is listed,
        // and its entry has an error message.
        if path.extension().is_some_and(|ending| ending == "ron") && !path.is_dir() {
            paths.push(path);
        }
    }
    Ok(paths)
}

fn name_of(path: &Path, origin: Source) -> String {
    let name = if origin == Source::Own {
        path.file_stem()
    } else {
        path.file_name()
    };
    name.unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// Returns the reason why the file of a scene was not read, for an error message.
pub(super) fn describe(error: ReadError) -> String {
    match error {
        ReadError::Folder => "this is a directory, not a scene file".into(),
        ReadError::TooLong { limit } => {
            format!("the scene is too long: at most {limit} bytes are read")
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "(version: 1, title: \"A title\", notice: \"A notice\", \
                         material: (modulus: 1.0e6), length: 1.0e-4)";

    fn folders() -> (tempfile::TempDir, PathBuf, PathBuf) {
        let root = tempfile::tempdir().unwrap();
        let [own, working] = ["own", "working"].map(|name| root.path().join(name));
        for folder in [&own, &working] {
            fs::create_dir(folder).unwrap();
        }
        (root, own, working)
    }

    fn listed(own: Option<&Path>, working: &Path) -> Vec<(String, Source)> {
        let entries = scenes(own, working);
        assert!(
            entries[..presets().len()]
                .iter()
                .all(|entry| entry.origin == Source::BuiltIn)
        );
        entries[presets().len()..]
            .iter()
            .map(|entry| (entry.name.clone(), entry.origin))
            .collect()
    }

    fn error_of(working: &Path, name: &str) -> String {
        let entry = scenes(None, working)
            .into_iter()
            .find(|entry| entry.name == name)
            .unwrap();
        let error = entry.error().unwrap();
        assert!(!error.contains('\n'), "{error}");
        let errors = entry.document.unwrap_err().to_string();
        assert!(errors.contains(&entry.path.unwrap().display().to_string()));
        error
    }

    #[test]
    fn scenes_are_listed_where_they_are() {
        let (_root, own, working) = folders();
        assert_eq!(listed(Some(&own), &working), []);
        for name in [
            "b-c.ron",
            "b.ron",
            "a.ron",
            ".hidden.ron",
            "notes.txt",
            "ron",
        ] {
            fs::write(own.join(name), SCENE).unwrap();
            fs::write(working.join(name), SCENE).unwrap();
        }
        fs::create_dir(working.join("folder.ron")).unwrap();
        fs::write(working.join("folder.ron/inside.ron"), SCENE).unwrap();
        let own_names = [".hidden", "a", "b", "b-c"].map(|name| (name.to_string(), Source::Own));
        let names = [".hidden.ron", "a.ron", "b-c.ron", "b.ron"]
            .map(|name| (name.to_string(), Source::Working));
        assert_eq!(listed(Some(&own), &working), [own_names, names].concat());
        let entry = &scenes(Some(&own), &working)[presets().len() + 1];
        assert_eq!(
            (entry.title(), entry.notice(), entry.text.as_str()),
            ("A title", "A notice", SCENE)
        );
        assert_eq!(entry.path, Some(own.join("a.ron")));
        assert_eq!(
            entry.document.as_ref().unwrap().resolve("line.csv"),
            own.join("line.csv")
        );
        // If both folders are the same, the folder is listed once. A missing folder has no entries.
        assert_eq!(listed(Some(&own), &own.join("../own")).len(), 4);
        assert_eq!(listed(None, &own.join("missing")), []);
    }

    #[test]
    fn what_is_no_scene_is_listed_with_its_error() {
        let (_root, _, working) = folders();
        fs::write(working.join("other.ron"), "Config(colour: 1)").unwrap();
        let plan =
            format!("(version: 1, title: \"A study\", scene: {SCENE}, lines: 3, record: [regime])");
        fs::write(working.join("plan.ron"), plan).unwrap();
        assert!(
            scenes(None, &working)
                .iter()
                .all(|entry| entry.name != "plan.ron"),
            "it is no broken scene"
        );
        fs::write(
            working.join("two.ron"),
            SCENE.replace("1.0e6", "0.0").replace("1.0e-4", "0.0"),
        )
        .unwrap();
        fs::write(working.join("empty.ron"), "").unwrap();
        assert!(error_of(&working, "other.ron").starts_with("line 1, column "));
        let two = error_of(&working, "two.ron");
        assert!(
            two.contains("material.modulus = 0.0: allowed") && two.ends_with("(and 1 more)"),
            "{two}"
        );
        let file = working.join("other.ron");
        assert!(error_of(&file, &file.display().to_string()).contains("cannot be read"));
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_opened_but_regular_files() {
        use std::os::unix::fs::symlink;

        let (_root, own, working) = folders();
        let made = std::process::Command::new("mkfifo")
            .arg(working.join("pipe.ron"))
            .status()
            .unwrap();
        assert!(made.success());
        symlink("loop.ron", working.join("loop.ron")).unwrap();
        symlink("missing", working.join("nowhere.ron")).unwrap();
        symlink(".", working.join("self.ron")).unwrap();
        symlink("/dev/zero", working.join("zero.ron")).unwrap();
        symlink(own.join("scene.ron"), working.join("linked.ron")).unwrap();
        fs::write(own.join("scene.ron"), SCENE).unwrap();
        fs::write(working.join("\u{1b}[2J.ron"), SCENE).unwrap();
        let names = [
            "scene",
            "\\u{1b}[2J.ron",
            "linked.ron",
            "loop.ron",
            "nowhere.ron",
            "pipe.ron",
            "zero.ron",
        ];
        assert_eq!(
            listed(Some(&own), &working)
                .into_iter()
                .map(|(name, _)| name)
                .collect::<Vec<_>>(),
            names
        );
        for (name, said) in [
            ("pipe.ron", "not a regular file"),
            ("zero.ron", "not a regular file"),
            ("loop.ron", "cannot be read"),
            ("nowhere.ron", "cannot be read"),
        ] {
            assert!(error_of(&working, name).contains(said), "{name}");
        }
        assert_eq!(own_scene(&own, "scene"), Some(own.join("scene.ron")));
        symlink(working.join("pipe.ron"), own.join("pipe.ron")).unwrap();
        for name in [
            "pipe",
            "missing",
            "",
            ".",
            "..",
            "../presets/scene",
            "/scene",
        ] {
            assert_eq!(own_scene(&own, name), None, "{name}");
        }
    }
}
