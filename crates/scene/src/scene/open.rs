//! Opening a scene by the name of its file, by its own name or from a stream.

use std::fs::File;
use std::io;
use std::io::{BufRead, BufReader, Cursor, Read};
use std::path::Path;

use super::document::Document;
use super::errors::did_you_mean;
use super::errors::{Origin, SceneError, SceneErrors};
use super::library::{describe, find_scene, own_folder, own_names, own_scene, presets};
use super::typed::LONGEST_TEXT;
use asperity_data::{PROVENANCE, ReadError, into_text, npy, open_regular, printable, read_limited};

/// Opens a scene by its name or by the path of its file. A name that ends in `.ron`, contains a
/// path separator or is the name of an existing file is opened as a file. Any other name is
/// searched first among the built-in scenes, then in the user's [`own_folder`]. If the file is a
/// CSV table of results, the scene in the head of the table is opened.
///
/// Returns an error if there is no such scene, if its file cannot be read, or if the scene has
/// invalid values.
///
/// ```
/// assert_eq!(asperity_scene::open("jkr-sphere")?.scene().length, 1.0e-4);
/// let unknown = asperity_scene::open("jkr-spere").unwrap_err().to_string();
/// assert!(unknown.contains("jkr-sphere"), "{unknown}");
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn open(name_or_path: &str) -> Result<Document, SceneErrors> {
    let own = own_folder();
    let path = Path::new(name_or_path);
    if is_file_name(name_or_path) {
        return document_of(text_of_file(path), name_or_path);
    }
    if let Some(preset) = find_scene(name_or_path) {
        return Document::parse(preset.text, preset.name);
    }
    if let Some(path) = own.as_ref().and_then(|own| own_scene(own, name_or_path)) {
        return document_of(text_of_file(&path), &path.display().to_string());
    }
    let names: Vec<_> = presets().iter().map(|preset| preset.name).collect();
    let own_names = own.as_deref().map_or_else(Vec::new, own_names);
    if let Some(own) = &own
        && own_names.iter().any(|name| name == name_or_path)
    {
        // The file exists, but it is not a regular file. The error message of `text_of_file` states
        // this.
        let path = own.join(format!("{name_or_path}.ron"));
        return document_of(text_of_file(&path), &path.display().to_string());
    }
    let near = did_you_mean(
        name_or_path,
        names
            .iter()
            .copied()
            .chain(own_names.iter().map(String::as_str)),
    );
    let no_file = if path.is_dir() {
        "it is a directory"
    } else {
        "there is no such file"
    };
    let nowhere = match own {
        Some(folder) => {
            let folder = folder.display().to_string();
            format!(
                ", no such built-in scene and none of this name in {}",
                printable(&folder)
            )
        }
        None => " and no such built-in scene".into(),
    };
    let message = format!(
        "{no_file}{nowhere}{} (built-in scenes: {})",
        printable(&near),
        names.join(", ")
    );
    Err(whole(name_or_path, message))
}

/// Returns true if `name` means the file of a scene and not a built-in scene: it ends in `.ron`,
/// contains a path separator or is the path of an existing file.
pub fn is_file_name(name: &str) -> bool {
    is_path(name) || Path::new(name).is_file()
}

/// Returns true if a name ends in `.ron` or contains a path separator.
pub fn is_path(name: &str) -> bool {
    name.ends_with(".ron") || name.chars().any(std::path::is_separator)
}

/// Opens the scene that an argument of the command line names. The argument `-` means standard
/// input. Any other argument is the name of a scene or the path of its file, as for [`open`]. A
/// pipe or a device is read to its end, so that the function may wait for another program.
///
/// # Errors
/// Returns the same errors as [`open`].
pub fn open_argument(argument: &str) -> Result<Document, SceneErrors> {
    if argument == "-" {
        return document_of(text_of_stream(io::stdin().lock()), "standard input");
    }
    let path = Path::new(argument);
    match path.metadata() {
        Ok(found) if !found.is_file() && !found.is_dir() => {
            let file = File::open(path)
                .map_err(|error| whole(argument, format!("cannot be read: {error}")))?;
            document_of(text_of_stream(file), argument)
        }
        _ => open(argument),
    }
}

fn whole(name: &str, message: String) -> SceneErrors {
    SceneError::whole(
        Origin::File {
            name: name.into(),
            place: None,
        },
        message,
    )
    .into()
}

/// Text with which a table of results begins.
const TABLE_START: &str = "asperity ";
/// Text between the head of a table of results and its scene.
const BEFORE_SCENE: &str = "\nscene:\n";

/// Returns the document of a scene. If the text is a table of results, returns the scene in the
/// table and does not read the other lines.
fn document_of(text: Result<String, ReadError>, name: &str) -> Result<Document, SceneErrors> {
    let text = text.map_err(|error| whole(name, describe(error)))?;
    if !text.starts_with(TABLE_START) {
        return Document::parse(&text, name);
    }
    match text.split_once(BEFORE_SCENE) {
        Some((head, scene)) => Ok(Document::parse(scene, name)?.of_table(head)),
        None => {
            let reason = "a table without a scene; allowed: a scene, or a table that asperity has computed from one";
            Err(whole(name, reason.into()))
        }
    }
}

fn text_of_file(path: &Path) -> Result<String, ReadError> {
    let mut file = open_regular(path)?;
    let mut start = Vec::new();
    file.by_ref()
        .take(npy::SIGNATURE.len() as u64)
        .read_to_end(&mut start)?;
    if start == npy::SIGNATURE {
        Err(ReadError::Array)
    } else {
        text_of_stream(Cursor::new(start).chain(file))
    }
}

fn text_of_stream(mut stream: impl Read) -> Result<String, ReadError> {
    let mut start = Vec::new();
    stream
        .by_ref()
        .take(PROVENANCE.len() as u64)
        .read_to_end(&mut start)?;
    let is_table = start == PROVENANCE.as_bytes();
    let whole = Cursor::new(start).chain(stream);
    if !is_table {
        return into_text(read_limited(whole, LONGEST_TEXT)?);
    }
    // In a table of results, each line of the scene begins with `#`. The limit of three times the
    // greatest length is enough for a scene of which each byte is on its own line.
    let mut lines = BufReader::new(whole.take(3 * LONGEST_TEXT as u64));
    let mut text = Vec::new();
    let mut line = Vec::new();
    while lines.read_until(b'\n', &mut line)? > 0 {
        let Some(content) = line.strip_prefix(b"#") else {
            break;
        };
        text.extend_from_slice(content.strip_prefix(b" ").unwrap_or(content));
        line.clear();
    }
    Ok(into_text(text)?.replace("\r\n", "\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn files_are_read_and_their_errors_describe() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name).to_str().unwrap().to_string();
        let message = |name: &str| open(&path(name)).unwrap_err().to_string();
        fs::write(path("good"), presets()[0].text).unwrap();
        assert_eq!(open(&path("good")).unwrap().text(), presets()[0].text);
        fs::write(path("bad.ron"), "(\n  version: 1,\n  lenght: 1,\n)").unwrap();
        assert!(
            message("bad.ron").contains("bad.ron:3:3: lenght: no such field; did you mean length?")
        );
        fs::write(path("binary.ron"), [b'(', 0xff]).unwrap();
        assert!(message("binary.ron").ends_with("this is not UTF-8 text: byte 1 is not"));
        fs::write(path("long.ron"), " ".repeat(LONGEST_TEXT + 1)).unwrap();
        assert!(message("long.ron").contains("too long"));
        fs::create_dir(path("folder.ron")).unwrap();
        assert!(message("folder.ron").ends_with("this is a directory, not a scene file"));
        assert!(message("missing.ron").contains("cannot be read"));
    }
}
