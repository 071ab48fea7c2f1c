//! Configuration file of the explorer: appearance, animation, default scene and keys. The explorer
//! only reads this file.

use super::keys::bindings::Bindings;
use super::theme::{Marker, Theme};
use asperity_data::read_regular_text;
use asperity_plot::Colours;
use asperity_scene::library::DEFAULT;
use asperity_scene::text::{Text, explain, line_column, read_ron};
use etcetera::{BaseStrategy, choose_base_strategy};
use serde::Deserialize;
use std::io::ErrorKind::NotFound;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

const LONGEST: usize = 1 << 20;

#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    version: u32,
    pub theme: Option<Theme>,
    pub colours: Option<Colours>,
    pub markers: Option<Marker>,
    pub frame_rate: u32,
    /// Speed of the animation. At a speed of 1, a loading stage takes six seconds.
    pub speed: f64,
    /// True if the animation starts again after its end.
    pub repeat: bool,
    /// True if the explorer receives the mouse. False if the terminal itself receives the mouse,
    /// for example to select text.
    pub mouse: bool,
    /// Name of the scene that the explorer opens if the user names no scene.
    pub scene: String,
    keys: Vec<KeySetting>,
    /// Keys of all commands, with the changes that the configuration file makes. They are empty
    /// until the file has been read.
    #[serde(skip)]
    pub bindings: Bindings,
}

#[derive(Clone, Debug, Deserialize)]
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
            colours: None,
            markers: None,
            frame_rate: 30,
            speed: 1.0,
            repeat: false,
            mouse: true,
            scene: DEFAULT.to_owned(),
            keys: Vec::new(),
            bindings: Bindings::default(),
        }
    }
}

/// Returns the path of the user's configuration file: `asperity/config.ron` in the configuration
/// folder. The file may not exist. Returns `None` if the user has no configuration folder.
pub fn default_path() -> Option<PathBuf> {
    let folder = choose_base_strategy().ok()?.config_dir();
    Some(folder.join("asperity").join("config.ron"))
}

impl Config {
    pub fn new(bindings: Bindings) -> Config {
        Config {
            bindings,
            ..Config::default()
        }
    }

    /// Reads a configuration file. `bindings` are the default keys, which the file may change.
    /// `is_named` is true if the user has named the file. If the file does not exist, the defaults
    /// apply, but a missing file that the user has named is an error.
    pub fn read(path: &Path, is_named: bool, bindings: Bindings) -> Result<Config, String> {
        if !is_named && is_missing(path) {
            return Ok(Config::new(bindings));
        }
        match read_regular_text(path, LONGEST) {
            Ok(text) => Config::parse(&text, path, bindings),
            Err(error) => Err(format!("{}: {error}", path.display())),
        }
    }

    /// Reads the text of a configuration file. `bindings` are the default keys, which the file may
    /// change.
    pub fn parse(text: &str, path: &Path, bindings: Bindings) -> Result<Config, String> {
        let source = Source { text, path };
        let mut config: Config = read_ron(text).map_err(|error| {
            let (offset, error) = explain(text, &error);
            source.wrong_at(offset, error.what())
        })?;
        config.bindings = bindings;
        source.check("version", config.version.into(), 1.0..=1.0, "1")?;
        source.check(
            "frame_rate",
            config.frame_rate.into(),
            1.0..=60.0,
            "from 1 to 60 frames per second",
        )?;
        source.check("speed", config.speed, 0.1..=10.0, "from 0.1 to 10")?;
        for (number, KeySetting { action, keys }) in config.keys.iter().enumerate() {
            if let Err((member, message)) = config.bindings.rebind(action, keys) {
                return Err(source.wrong(&format!("keys.{number}.{member}"), message));
            }
        }
        if let Some((key, action, other)) = config.bindings.conflict() {
            // The same key may come from a setting of `action` or of `other`. The message points to
            // the later of these settings.
            let mut settings = config.keys.iter();
            let number = settings
                .rposition(|setting| setting.action == action || setting.action == other)
                .unwrap_or_default();
            let message = format!(
                "{key}: bound to {action} and to {other}; allowed: one action for each key"
            );
            return Err(source.wrong(&format!("keys.{number}.keys"), message));
        }
        Ok(config)
    }
}

/// Returns true if there is no file at the path. A broken link does not count as missing; reading
/// it is then an error.
fn is_missing(path: &Path) -> bool {
    match path.symlink_metadata() {
        Ok(_) => false,
        Err(error) => error.kind() == NotFound,
    }
}

/// Text and path of a configuration file. Error messages use them to state where a mistake is.
struct Source<'a> {
    text: &'a str,
    path: &'a Path,
}

impl Source<'_> {
    fn wrong_at(&self, offset: usize, message: String) -> String {
        let (line, column) = line_column(self.text, offset);
        format!("{}:{line}:{column}: {message}", self.path.display())
    }

    /// Returns the error message about the value of a field, with the place of the value in the
    /// file.
    fn wrong(&self, field: &str, message: String) -> String {
        let start = Text::new(self.text)
            .ok()
            .and_then(|text| Some(text.span(field)?.value.start));
        self.wrong_at(start.unwrap_or(0), message)
    }

    fn check(
        &self,
        field: &str,
        value: f64,
        range: RangeInclusive<f64>,
        allowed: &str,
    ) -> Result<(), String> {
        if range.contains(&value) {
            return Ok(());
        }
        Err(self.wrong(field, format!("{field} = {value}: allowed: {allowed}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::commands::table::bindings;

    fn parse(text: &str) -> Result<Config, String> {
        Config::parse(text, Path::new("config.ron"), bindings())
    }

    const FULL: &str = r#"// Settings
(
    version: 1,
    theme: Dark,
    colours: Ansi256,
    markers: Braille,
    frame_rate: 30,
    speed: 1.0,
    repeat: false,
    scene: "pressure-sensitive",
    keys: [(action: "toggle-play", keys: ["F5", "F6"])],
)
"#;

    #[test]
    fn what_is_wrong_has_its_line_and_column() {
        let config = parse(FULL).unwrap();
        assert_eq!(
            (config.theme, config.colours, config.markers),
            (
                Some(Theme::Dark),
                Some(Colours::Ansi256),
                Some(Marker::Braille)
            )
        );
        for (from, to, said) in [
            (
                "version: 1",
                "version: 2",
                "config.ron:3:14: version = 2: allowed: 1",
            ),
            (
                "theme: Dark",
                "theme: Drak",
                "config.ron:4:12: theme = Drak: allowed: Neutral, Dark, Light",
            ),
            (
                "colours: Ansi256",
                "colours: Many",
                "config.ron:5:14: colours = Many: allowed: Plain, Ansi16, Ansi256, TrueColour",
            ),
            (
                "markers: Braille",
                "marker: Braille",
                "config.ron:6:5: marker: ",
            ),
            (
                "frame_rate: 30",
                "frame_rate: 61",
                "config.ron:7:17: frame_rate = 61: allowed: from 1 to 60",
            ),
            (
                "speed: 1.0",
                "speed: 0.0",
                "config.ron:8:12: speed = 0: allowed: from 0.1 to 10",
            ),
            (
                "speed: 1.0",
                "speed: NaN",
                "config.ron:8:12: speed = NaN: allowed",
            ),
            (
                "toggle-play",
                "togle-play",
                "config.ron:11:21: togle-play: there is no such action; did you",
            ),
            (
                "\"F5\"",
                "\"Pp\"",
                "config.ron:11:42: Pp: there is no such key; allowed: one character, Ctrl+c, Shift+Left",
            ),
            (
                "\"F5\"",
                "\"r\"",
                "config.ron:11:42: r: bound to toggle-play and to toggle-repeat",
            ),
            (
                "repeat: false",
                "repeat: false, repeat: true",
                "config.ron:9:",
            ),
            ("    keys", "  ] keys", "config.ron:11:"),
        ] {
            let text = FULL.replace(from, to);
            assert_ne!(text, FULL, "{from}");
            let why = parse(&text).unwrap_err();
            assert!(why.starts_with(said), "{why}");
        }
    }

    #[test]
    fn keys_are_exchanged_and_quit_stays_in_reach() {
        let keys = |settings: &str| parse(&format!("(version: 1, keys: [{settings}])"));
        let swapped =
            keys(r#"(action: "toggle-repeat", keys: ["R"]), (action: "reseed", keys: ["r"])"#)
                .unwrap();
        let keys_of = |config: &Config, name: &str| {
            let mut rows = config
                .bindings
                .rows()
                .filter(|binding| binding.row.name == name);
            rows.next().unwrap().names()
        };
        assert_eq!(
            (
                keys_of(&swapped, "toggle-repeat"),
                keys_of(&swapped, "reseed")
            ),
            ("R".to_owned(), "r".to_owned())
        );
        let config = keys(r#"(action: "quit", keys: ["_"])"#).unwrap();
        assert_eq!(keys_of(&config, "quit"), "_ Ctrl+c");
        assert!(
            keys(r#"(action: "toggle-repeat", keys: [])"#).is_ok(),
            "a key may be taken away"
        );
        let why = keys(r#"(action: "accept", keys: ["y"])"#).unwrap_err();
        assert!(why.contains("accept: there is no such action"), "{why}");
    }

    #[test]
    fn a_missing_file_has_the_defaults_unless_it_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("asperity/config.ron");
        let read = |is_named| Config::read(&path, is_named, bindings());
        assert_eq!(read(false).unwrap().scene, DEFAULT);
        assert!(read(true).unwrap_err().contains("config.ron"));
        assert!(!path.parent().unwrap().exists(), "reading makes nothing");
    }
}
