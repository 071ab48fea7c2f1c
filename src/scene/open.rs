//! Opening a scene by file, by name or from a stream.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use super::document::{Document, LONGEST_TEXT};
use super::errors::{Origin, SceneError, SceneErrors};
use super::library::{Library, describe, printable};
use super::presets::{find, presets};
use super::provenance::{SceneText, SceneTextError};
use super::suggest::nearest;
use crate::io::read_regular_text;

/// Opens a scene: a file if one of that name exists or the name looks like a path (ends in `.ron` or has a path
/// separator), else a built-in scene, else one of the user's own scenes, see [`Library::own_folder`]. Only regular
/// files are read, since a pipe, a terminal or a device would block. A table of results, CSV or `.npy`, opens as
/// its scene.
///
/// # Errors
///
/// No such scene, an unreadable file, or the errors of its scene.
pub fn open(name_or_path: &str) -> Result<Document, SceneErrors> {
    open_in(name_or_path, &Library::of_environment())
}

fn open_in(name_or_path: &str, library: &Library) -> Result<Document, SceneErrors> {
    let path = Path::new(name_or_path);
    let looks_like_file = name_or_path.ends_with(".ron") || name_or_path.chars().any(std::path::is_separator);
    if looks_like_file || path.is_file() {
        return open_file(path, name_or_path);
    }
    if let Some(preset) = find(name_or_path) {
        return Document::parse(preset.text, preset.name);
    }
    if let Some(path) = library.own_scene(name_or_path) {
        return open_file(&path, &path.display().to_string());
    }
    let names: Vec<_> = presets().iter().map(|preset| preset.name).collect();
    let own = library.own_names();
    let near = nearest(name_or_path, names.iter().copied().chain(own.iter().map(String::as_str)));
    let near = near.map_or_else(String::new, |near| format!("; did you mean {}?", printable(near)));
    let no_file = if path.is_dir() { "it is a directory" } else { "there is no such file" };
    let nowhere = match library.own_folder() {
        Some(folder) => {
            let folder = printable(&folder.display().to_string());
            format!(", no such built-in scene and none of this name in {folder}")
        }
        None => " and no such built-in scene".into(),
    };
    let message = format!("{no_file}{nowhere}{near} (built-in scenes: {})", names.join(", "));
    Err(whole(name_or_path, message))
}

/// Opens the scene of a command argument: as [`open`], but also from a stream. `-` is standard input, and a pipe or
/// a device, such as `<(…)` of a shell, is read up to its end.
///
/// Reading a stream waits for its writer, so this function is for commands that an interrupt ends, not for an
/// explorer that has taken over the terminal.
///
/// # Errors
/// As [`open`].
pub fn open_argument(argument: &str) -> Result<Document, SceneErrors> {
    if argument == "-" {
        return open_stream(io::stdin().lock(), "standard input");
    }
    let path = Path::new(argument);
    match path.metadata() {
        Ok(found) if !found.is_file() && !found.is_dir() => {
            let failed = |error| whole(argument, format!("cannot be read: {error}"));
            open_stream(fs::File::open(path).map_err(failed)?, argument)
        }
        _ => open(argument),
    }
}

fn open_stream(stream: impl Read, name: &str) -> Result<Document, SceneErrors> {
    open_source(SceneText::of_stream(stream), name)
}

fn open_file(path: &Path, name: &str) -> Result<Document, SceneErrors> {
    open_source(SceneText::of_file(path), name)
}

fn open_source(source: Result<SceneText, SceneTextError>, name: &str) -> Result<Document, SceneErrors> {
    let refused = |error| match error {
        SceneTextError::Unread(error) => whole(name, describe(error)),
        SceneTextError::NoProvenance(message) => whole(name, message.to_owned()),
    };
    let SceneText { text, content, measured } = source.map_err(refused)?;
    Ok(Document::parse(&text, name)?.with_table(content, measured))
}

fn whole(name: &str, message: String) -> SceneErrors {
    SceneError::whole(Origin::File { name: name.into() }, message).into()
}

/// Text of a regular file, at most as long as a scene can be.
pub(crate) fn read_file(path: &Path) -> Result<String, String> {
    read_regular_text(path, LONGEST_TEXT).map_err(describe)
}

#[cfg(test)]
mod tests {
    use super::super::presets::DEFAULT;
    use super::*;

    #[test]
    fn every_preset_is_a_scene_with_a_title_and_a_notice() {
        for preset in presets() {
            let document = open(preset.name).unwrap_or_else(|errors| panic!("{errors}"));
            assert!(!document.scene().title.is_empty(), "{}", preset.name);
            assert!(!document.scene().notice.is_empty(), "{}", preset.name);
            assert_eq!(document.name(), preset.name);
        }
    }

    #[test]
    fn presets_have_different_names_and_one_is_the_default() {
        let mut names: Vec<_> = presets().iter().map(|preset| preset.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), presets().len());
        assert!(find(DEFAULT).is_some());
        assert_eq!(find("nothing"), None);
    }

    #[test]
    fn unknown_names_get_the_list_and_a_suggestion() {
        let library = Library::of(None, "".into());
        let message = open_in("jkr-spere", &library).unwrap_err().to_string();
        let said = "jkr-spere: there is no such file and no such built-in scene; did you mean jkr-sphere? (";
        assert!(message.starts_with(said) && message.contains("million-springs"), "{message}");
    }

    #[test]
    fn own_scenes_open_by_their_names() {
        let config = tempfile::tempdir().unwrap();
        let library = Library::of(Some(config.path().to_path_buf()), "".into());
        let folder = library.own_folder().unwrap();
        let message = open_in("tape", &library).unwrap_err().to_string();
        let said = format!(
            "tape: there is no such file, no such built-in scene and none of this name in {}",
            folder.display()
        );
        assert!(message.starts_with(&said), "{message}");
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("tape.ron");
        fs::write(&path, presets()[0].text).unwrap();
        fs::write(folder.join("jkr-sphere.ron"), presets()[0].text).unwrap();
        let tape = open_in("tape", &library).unwrap();
        assert_eq!((tape.text(), tape.name()), (presets()[0].text, path.to_str().unwrap()));
        assert_eq!(tape.resolve("line.csv"), folder.join("line.csv"));
        assert_eq!(
            open_in("jkr-sphere", &library).unwrap().name(),
            "jkr-sphere",
            "built-in scenes come first"
        );
        assert!(open_in("tapes", &library).unwrap_err().to_string().contains("did you mean tape?"));
        fs::write(&path, "(version: 3)").unwrap();
        assert!(open_in("tape", &library).unwrap_err().to_string().contains("tape.ron:1:11: version = 3"));
    }

    #[test]
    fn files_are_read_and_their_errors_describe() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name).to_str().unwrap().to_string();
        let message = |name: &str| open(&path(name)).unwrap_err().to_string();
        fs::write(path("good"), presets()[0].text).unwrap();
        assert_eq!(open(&path("good")).unwrap().text(), presets()[0].text);
        fs::write(path("bad.ron"), "(\n  version: 1,\n  lenght: 1,\n)").unwrap();
        assert!(message("bad.ron").contains("bad.ron:3:3: lenght: no such field; did you mean length?"));
        fs::write(path("binary.ron"), [b'(', 0xff]).unwrap();
        assert!(message("binary.ron").ends_with("this is not UTF-8 text: byte 1 is not"));
        fs::write(path("long.ron"), " ".repeat(LONGEST_TEXT + 1)).unwrap();
        assert!(message("long.ron").contains("too long"));
        fs::create_dir(path("folder.ron")).unwrap();
        assert!(message("folder.ron").ends_with("this is a directory, not a scene file"));
        assert!(message("missing.ron").contains("cannot be read"));
    }
}
