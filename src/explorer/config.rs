//! Configuration file of the explorer: appearance, animation, default scene and keys. Read where it exists, written
//! only on request.

use super::keys::Bindings;
use super::theme::{Appearance, Marker, Theme};
use crate::io::{read_regular_text, write_new};
use crate::scene::{DEFAULT, Text, explain, line_column, read_ron};
use etcetera::{BaseStrategy, choose_base_strategy};
use ron::extensions::Extensions;
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};
use std::io::ErrorKind::NotFound;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

const LONGEST: usize = 1 << 20;
/// File with all fields in comments.
pub const TEMPLATE: &str = r#"// Configuration of the explorer. A field that is left out has its default.
(
    version: 1,
    // theme: Dark,            // Neutral, Dark, Light, HighContrast or Plain; default: by NO_COLOR and COLORFGBG
    // markers: Braille,       // Braille, Octant, HalfBlock or Ascii; default: by the locale and TERM
    // frame_rate: 30,         // frames per second of the animation, from 1 to 60; over SSH at most 12
    // speed: 1.0,             // speed of the animation, from 0.1 to 10
    // repeat: false,          // true: the animation begins again at its end
    // scene: "pressure-sensitive",  // scene that opens where none is named
    // keys: [(action: "toggle-play", keys: ["F5", "F6"])],  // actions: docs/keys.md
)
"#;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    version: u32,
    pub theme: Option<Theme>,
    pub markers: Option<Marker>,
    pub frame_rate: u32,
    /// Speed of the animation; 1 takes six seconds for a loading stage.
    pub speed: f64,
    /// True if the animation begins again at its end.
    pub repeat: bool,
    /// Scene that opens where none is named.
    pub scene: String,
    keys: Vec<KeySetting>,
    /// The file; `None` where no configuration is read or written.
    #[serde(skip)]
    pub path: Option<PathBuf>,
    /// All keys; none before the configuration has been read.
    #[serde(skip)]
    pub bindings: Bindings,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeySetting {
    action: String,
    keys: Vec<String>,
}

impl Default for Config {
    fn default() -> Self {
        Config {
            version: 1,
            theme: None,
            markers: None,
            frame_rate: 30,
            speed: 1.0,
            repeat: false,
            scene: DEFAULT.to_owned(),
            keys: Vec::new(),
            path: None,
            bindings: Bindings::default(),
        }
    }
}

/// Path of this user's file, `asperity/config.ron` in the configuration folder; the file need not exist.
pub fn default_path() -> Option<PathBuf> {
    Some(choose_base_strategy().ok()?.config_dir().join("asperity").join("config.ron"))
}

impl Config {
    pub fn new(bindings: Bindings) -> Config {
        Config { bindings, ..Config::default() }
    }

    /// Reads a file that may change these keys. `is_named`: the user has named it, and a missing file is an error; otherwise a missing file has
    /// the defaults.
    pub fn read(path: &Path, is_named: bool, bindings: Bindings) -> Result<Config, String> {
        // A broken link is a file that cannot be read.
        let is_missing = || path.symlink_metadata().is_err_and(|error| error.kind() == NotFound);
        if !is_named && is_missing() {
            return Ok(Config { path: Some(path.to_path_buf()), ..Config::new(bindings) });
        }
        Config::parse(&text_of(path)?, path, bindings)
    }

    /// Reads the text of a file that may change these keys.
    pub fn parse(text: &str, path: &Path, bindings: Bindings) -> Result<Config, String> {
        let wrong_at = |offset: usize, message: String| {
            let (line, column) = line_column(text, offset);
            format!("{}:{line}:{column}: {message}", path.display())
        };
        let mut config: Config = read_ron(text).map_err(|error| {
            let (offset, error) = explain(text, &error);
            wrong_at(offset, error.what())
        })?;
        config.bindings = bindings;
        let wrong = |field: &str, message: String| {
            let text = Text::new(text).ok();
            let start = text.and_then(|text| Some(text.span(field)?.value.start));
            wrong_at(start.unwrap_or(0), message)
        };
        let check = |field: &str, value: f64, range: RangeInclusive<f64>, allowed: &str| {
            let message = || format!("{field} = {value}: allowed: {allowed}");
            if range.contains(&value) { Ok(()) } else { Err(wrong(field, message())) }
        };
        check("version", config.version.into(), 1.0..=1.0, "1")?;
        check("frame_rate", config.frame_rate.into(), 1.0..=60.0, "from 1 to 60 frames per second")?;
        check("speed", config.speed, 0.1..=10.0, "from 0.1 to 10")?;
        for (number, KeySetting { action, keys }) in config.keys.iter().enumerate() {
            let rebound = config.bindings.rebind(action, keys);
            rebound.map_err(|(field, message)| wrong(&format!("keys.{number}.{field}"), message))?;
        }
        if let Some((key, one, other)) = config.bindings.conflict() {
            // The setting with the key, or the last one.
            let has = |setting: &KeySetting| setting.action == one || setting.action == other;
            let number = config.keys.iter().rposition(has).unwrap_or_default();
            let message = format!("{key}: bound to {one} and to {other}; allowed: one action for each key");
            return Err(wrong(&format!("keys.{number}.keys"), message));
        }
        Ok(Config { path: Some(path.to_path_buf()), ..config })
    }

    /// Text of a file with these settings.
    pub fn text(&self) -> Result<String, ron::Error> {
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let layout = PrettyConfig::new().depth_limit(1).separate_tuple_members(false);
        Ok(options.to_string_pretty(self, layout)? + "\n")
    }
}

fn text_of(path: &Path) -> Result<String, String> {
    read_regular_text(path, LONGEST).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes the template to a file that does not exist yet, with the folders around the file.
pub fn write_template(path: &Path) -> Result<(), String> {
    write(path, TEMPLATE, false)
}

/// Writes colours and markers to a file; all else in the file stays, comments included. A missing file is made from the
/// template.
pub fn remember(path: &Path, appearance: Appearance, bindings: Bindings) -> Result<(), String> {
    let exists = path.symlink_metadata().is_ok();
    let mut text = if exists { text_of(path)? } else { TEMPLATE.to_owned() };
    Config::parse(&text, path, bindings)?;
    let Appearance { theme, marker } = appearance;
    for (field, value) in [("theme", format!("{theme:?}")), ("markers", format!("{marker:?}"))] {
        let read = Text::new(text.as_str()).map_err(|error| error.reason.to_owned())?;
        let set = match read.span(field) {
            Some(_) => read.replace(field, &value),
            None => read.insert("", field, &value, &["version", "theme", "markers"]),
        };
        text = set?.as_str().to_owned();
    }
    write(path, &text, exists)
}

fn write(path: &Path, text: &str, overwrite: bool) -> Result<(), String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let made = folder.map_or(Ok(()), std::fs::create_dir_all);
    made.map_err(|error| format!("{}: {error}", path.display()))?;
    write_new(path, overwrite, |file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::keys::bindings;

    fn parse(text: &str) -> Result<Config, String> {
        Config::parse(text, Path::new("config.ron"), bindings())
    }

    /// The template with all its fields.
    fn full() -> String {
        let line = |line: &str| {
            line.strip_prefix("    // ").map_or_else(|| line.to_owned(), |field| format!("    {field}"))
        };
        TEMPLATE.lines().map(|one| line(one) + "\n").collect()
    }

    #[test]
    fn the_template_has_every_field_and_the_defaults() {
        assert_eq!(parse(TEMPLATE).unwrap().text(), Config::new(bindings()).text());
        let config = parse(&full()).unwrap();
        assert_eq!((config.theme, config.markers), (Some(Theme::Dark), Some(Marker::Braille)));
        // A printed configuration has all fields, and can be read.
        let text = config.text().unwrap();
        for field in text.lines().filter_map(|line| line.strip_prefix("    ")?.split_once(':')) {
            assert!(full().contains(&format!("    {}: ", field.0)), "{}", field.0);
        }
        assert_eq!(parse(&text).unwrap().text(), Ok(text));
        let defaults = Config { theme: config.theme, markers: config.markers, ..Config::new(bindings()) };
        assert_eq!(Config { keys: Vec::new(), ..config }.text(), defaults.text());
    }

    #[test]
    fn what_is_wrong_has_its_line_and_column() {
        for (from, to, said) in [
            ("version: 1", "version: 2", "config.ron:3:14: version = 2: allowed: 1"),
            (
                "theme: Dark",
                "theme: Drak",
                "config.ron:4:12: theme = Drak: allowed: Neutral, Dark, Light, HighContrast, Plain (did you mean Dark?)",
            ),
            ("markers: Braille", "marker: Braille", "config.ron:5:5: marker: "),
            (
                "frame_rate: 30",
                "frame_rate: 61",
                "config.ron:6:17: frame_rate = 61: allowed: from 1 to 60 frames per second",
            ),
            ("speed: 1.0", "speed: 0.0", "config.ron:7:12: speed = 0: allowed: from 0.1 to 10"),
            ("speed: 1.0", "speed: NaN", "config.ron:7:12: speed = NaN: allowed"),
            (
                "toggle-play",
                "togle-play",
                "config.ron:10:21: togle-play: there is no such action; did you mean toggle-play? allowed: docs/keys.md lists all",
            ),
            (
                "\"F5\"",
                "\"Pp\"",
                "config.ron:10:42: Pp: there is no such key; allowed: one character, Ctrl+c, Shift+Left",
            ),
            ("\"F5\"", "\"r\"", "config.ron:10:42: r: bound to toggle-play and to restart"),
            ("repeat: false", "repeat: false, repeat: true", "config.ron:8:"),
            ("    keys", "  ] keys", "config.ron:10:"),
        ] {
            let text = full().replace(from, to);
            assert_ne!(text, full(), "{from}");
            let why = parse(&text).unwrap_err();
            assert!(why.starts_with(said), "{why}");
        }
    }

    #[test]
    fn keys_are_exchanged_and_quit_stays_in_reach() {
        let keys = |settings: &str| parse(&format!("(version: 1, keys: [{settings}])"));
        let swapped = keys(r#"(action: "restart", keys: ["R"]), (action: "reseed", keys: ["r"])"#).unwrap();
        let keys_of = |config: &Config, name: &str| {
            let mut rows = config.bindings.rows().filter(|binding| binding.row.name == name);
            rows.next().unwrap().names()
        };
        assert_eq!(
            (keys_of(&swapped, "restart"), keys_of(&swapped, "reseed")),
            ("R".to_owned(), "r".to_owned())
        );
        let config = keys(r#"(action: "quit", keys: ["_"])"#).unwrap();
        assert_eq!(keys_of(&config, "quit"), "_ Ctrl+c");
        assert!(keys(r#"(action: "restart", keys: [])"#).is_ok(), "a key may be taken away");
        let why = keys(r#"(action: "accept", keys: ["y"])"#).unwrap_err();
        assert!(why.contains("accept: there is no such action"), "{why}");
    }

    #[test]
    fn files_are_read_and_written_only_as_asked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("asperity/config.ron");
        let read = |is_named| Config::read(&path, is_named, bindings());
        let missing = read(false).unwrap();
        assert_eq!((missing.path.as_ref(), missing.text()), (Some(&path), Config::new(bindings()).text()));
        assert!(read(true).unwrap_err().contains("config.ron"));
        assert!(!path.exists() && !path.parent().unwrap().exists(), "reading makes nothing");
        write_template(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), TEMPLATE);
        assert!(write_template(&path).unwrap_err().contains("already"));
        // Remembered colours leave all else as it is.
        let mine =
            TEMPLATE.replace("// speed: 1.0, ", "speed: 2.0, ").replace("version: 1,", "version: 1, // mine");
        std::fs::write(&path, &mine).unwrap();
        for theme in [Theme::Light, Theme::Plain] {
            remember(&path, Appearance { theme, marker: Marker::Octant }, bindings()).unwrap();
            let config = read(true).unwrap();
            assert_eq!(
                (config.theme, config.markers, config.speed),
                (Some(theme), Some(Marker::Octant), 2.0)
            );
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(text.contains("// mine") && text.contains("// frame_rate: 30"), "{text}");
        }
        // A missing file is made, a wrong one stays.
        std::fs::remove_file(&path).unwrap();
        remember(&path, Appearance { theme: Theme::Dark, marker: Marker::Ascii }, bindings()).unwrap();
        assert_eq!(read(true).unwrap().markers, Some(Marker::Ascii));
        std::fs::write(&path, "(version: 1, theme: Pink)").unwrap();
        let why = remember(&path, Appearance { theme: Theme::Dark, marker: Marker::Ascii }, bindings())
            .unwrap_err();
        assert!(why.contains("config.ron:1:21: theme = Pink"), "{why}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "(version: 1, theme: Pink)");
    }
}
