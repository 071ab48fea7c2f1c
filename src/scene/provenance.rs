//! Provenance of results: the version, scene and seed behind a table, written into its file.
//!
//! In CSV the text fills the first lines, each after `# `; in `.npy` it is an array after that of the results.

use super::document::LONGEST_TEXT;
use super::measured_hash::MeasuredHash;
use super::model::Scene;
use super::named_file::named_from;
use super::table_content::TableContent;
use super::write::to_ron;
use crate::io::{PROVENANCE, ReadError, into_text, npy, open_regular, read_limited};
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

/// Prefix of a comment in CSV.
const COMMENT: &str = "# ";

/// First line of a provenance, before the version; [`PROVENANCE`] without the comment.
const PROGRAM: &str = "asperity ";

/// Line before the scene.
const SCENE: &str = "scene:\n";

/// Content of a table of spectra, and the line before its arguments, one on each line as a RON string.
const SPECTRA: &str = "spectra";
const ARGUMENTS: &str = "arguments:\n";

/// Version, scene and seed behind a table; for spectra, the arguments of `asperity surface`.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    text: String,
}

impl Provenance {
    /// Provenance of a table of a scene. Files of the scene are relative to `folder`, and the table is written into
    /// `destination`.
    #[must_use]
    pub fn new(content: TableContent, scene: &Scene, folder: &Path, destination: &Path) -> Self {
        let mut scene = scene.clone();
        scene.rename_measured_files(|file| named_from(file, folder, destination));
        let seed = scene.seed().map_or_else(String::new, |seed| format!("seed: {seed}\n"));
        let text = format!("{}{seed}{SCENE}{}", head(&content.name()), to_ron(&scene));
        Provenance { text }
    }

    /// Provenance of the spectra of `asperity surface` with these arguments.
    #[must_use]
    pub fn of_spectra(arguments: &[String]) -> Self {
        let quoted: String = arguments.iter().map(|argument| format!("{argument:?}\n")).collect();
        Provenance { text: format!("{}{ARGUMENTS}{quoted}", head(SPECTRA)) }
    }

    /// The same provenance with the hashes of its measured files.
    #[must_use]
    pub fn with_hashes(mut self, hashes: &[MeasuredHash]) -> Self {
        // After the first line.
        let place = self.text.find('\n').map_or(0, |end| end + 1);
        self.text.insert_str(place, &hashes.iter().map(MeasuredHash::line).collect::<String>());
        self
    }

    /// The text: version, hashes of measured files, content and seed, one line each, and the scene.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text as comments of CSV.
    #[must_use]
    pub fn comments(&self) -> String {
        self.text.lines().map(|line| format!("{COMMENT}{line}\n")).collect()
    }
}

fn head(content: &str) -> String {
    format!("{PROGRAM}{}\ncontent: {content}\n", env!("CARGO_PKG_VERSION"))
}

/// Origin of a table of spectra.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectraTable {
    /// Arguments of `asperity surface`.
    pub arguments: Vec<String>,
    /// Measured files.
    pub measured: Vec<MeasuredHash>,
}

impl SpectraTable {
    /// Origin of the spectra in a regular file; `None` for any other file.
    #[must_use]
    pub fn open(path: &Path) -> Option<Self> {
        let Ok(Raw::Provenance(text)) = Raw::of_file(path) else { return None };
        let (head, arguments) = text.split_once(&format!("\n{ARGUMENTS}"))?;
        let is_of_spectra = head.lines().any(|line| line == format!("content: {SPECTRA}"));
        let arguments = arguments.lines().map(|line| ron::from_str(line).ok());
        let arguments = arguments.collect::<Option<Vec<String>>>().filter(|_| is_of_spectra)?;
        Some(SpectraTable { arguments, measured: MeasuredHash::of_lines(head) })
    }
}

/// Reason why no scene was read.
#[derive(Debug)]
pub(super) enum SceneTextError {
    /// The source cannot be read.
    Unread(ReadError),
    /// A table without a readable provenance.
    NoProvenance(&'static str),
}

impl<E: Into<ReadError>> From<E> for SceneTextError {
    fn from(error: E) -> Self {
        SceneTextError::Unread(error.into())
    }
}

/// Text of a file: that of a scene, or the provenance of a table, which alone is read.
enum Raw {
    Scene(String),
    Provenance(String),
}

impl Raw {
    fn of_file(path: &Path) -> Result<Self, SceneTextError> {
        let mut file = open_regular(path)?;
        let mut start = Vec::new();
        file.by_ref().take(npy::SIGNATURE.len() as u64).read_to_end(&mut start)?;
        if start == npy::SIGNATURE {
            Raw::of_array(file)
        } else {
            Raw::of_stream(Cursor::new(start).chain(file))
        }
    }

    fn of_stream(mut stream: impl Read) -> Result<Self, SceneTextError> {
        let mut start = Vec::new();
        stream.by_ref().take(PROVENANCE.len() as u64).read_to_end(&mut start)?;
        let is_table = start == PROVENANCE.as_bytes();
        let whole = Cursor::new(start).chain(stream);
        if !is_table {
            return Ok(Raw::Scene(into_text(read_limited(whole, LONGEST_TEXT)?)?));
        }
        // Comments of a scene of the greatest length, with a line for each byte.
        let most = (LONGEST_TEXT * (1 + COMMENT.len())) as u64;
        let mut lines = BufReader::new(whole.take(most));
        let mut text = Vec::new();
        let mut line = Vec::new();
        while lines.read_until(b'\n', &mut line)? > 0 {
            let Some(content) = line.strip_prefix(b"#") else { break };
            text.extend_from_slice(content.strip_prefix(b" ").unwrap_or(content));
            line.clear();
        }
        Ok(Raw::Provenance(into_text(text)?.replace("\r\n", "\n")))
    }

    fn of_array(mut file: File) -> Result<Self, SceneTextError> {
        let most = npy::most_appended(LONGEST_TEXT) as u64;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(most)))?;
        let tail = read_limited(file, most as usize)?;
        let text = npy::appended_text(&tail).ok_or(SceneTextError::NoProvenance(
            "an array without a scene; allowed: a scene, or an array that asperity has written",
        ))?;
        Ok(Raw::Provenance(text.to_owned()))
    }
}

/// Text of a scene, and the content of its table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SceneText {
    pub text: String,
    pub content: Option<TableContent>,
    pub measured: Vec<MeasuredHash>,
}

impl SceneText {
    /// Reads a scene file or the provenance of a table.
    pub fn of_file(path: &Path) -> Result<Self, SceneTextError> {
        SceneText::of_raw(Raw::of_file(path)?)
    }

    /// Reads the text of a scene, or CSV that contains one.
    pub fn of_stream(stream: impl Read) -> Result<Self, SceneTextError> {
        SceneText::of_raw(Raw::of_stream(stream)?)
    }

    fn of_raw(raw: Raw) -> Result<Self, SceneTextError> {
        let text = match raw {
            Raw::Scene(text) => return Ok(SceneText { text, content: None, measured: Vec::new() }),
            Raw::Provenance(text) => text,
        };
        let split = text.split_once(&format!("\n{SCENE}")).filter(|(head, _)| head.starts_with(PROGRAM));
        let (head, scene) = split.ok_or(SceneTextError::NoProvenance(
            "a table whose first comments hold no scene; allowed: `asperity VERSION`, `content:` and `scene:`",
        ))?;
        let content = head.lines().find_map(|line| TableContent::from_name(line.strip_prefix("content: ")?));
        let content = content.ok_or(SceneTextError::NoProvenance(
            "a table without its content; allowed: `content: force curve`, `profile`, `COUNT random profiles`, `COUNT preloads from FORCE to FORCE N` or `COUNT reversals`",
        ))?;
        let measured = MeasuredHash::of_lines(head);
        Ok(SceneText { text: scene.to_owned(), content: Some(content), measured })
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::Document;
    use super::super::model::Roughness;
    use super::super::preloads::Preloads;
    use super::super::strategies::sound_scenes;
    use super::super::table_content::ReversalContent;
    use super::*;
    use proptest::prelude::*;

    fn read(bytes: &[u8]) -> Result<SceneText, SceneTextError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table");
        std::fs::write(&path, bytes).unwrap();
        SceneText::of_file(&path)
    }

    proptest! {
        #[test]
        fn a_scene_comes_back_from_either_format(scene in sound_scenes(), count in 2_u32..) {
            let here = Path::new("");
            let preloads = Preloads::new(0.0, 1e-5 * f64::from(count), 2 + count as usize % 511).unwrap();
            for content in [
                TableContent::ForceCurve,
                TableContent::Profile,
                TableContent::RandomProfiles(count),
                TableContent::Preloads(preloads, None),
                TableContent::Preloads(preloads, Some(count)),
                TableContent::Reversals(ReversalContent { count: 64, forces: None, map_smoothing: None }),
                TableContent::Reversals(ReversalContent {
                    count: 8,
                    forces: Some(preloads.ends()),
                    map_smoothing: Some(3),
                }),
            ] {
                let hash = MeasuredHash { file: "a\nb.txt".into(), sha256: "0".repeat(64) };
                let provenance =
                    Provenance::new(content, &scene, here, here).with_hashes(std::slice::from_ref(&hash));
                let csv = provenance.comments() + "x,z\n1,2\n";
                let mut array = Vec::new();
                npy::write_header(&mut array, "'<f8'", "1,").unwrap();
                array.extend(1.0_f64.to_le_bytes());
                npy::write_text(&mut array, provenance.text()).unwrap();
                for file in [csv.clone().into_bytes(), csv.replace('\n', "\r\n").into_bytes(), array] {
                    let source = read(&file).unwrap();
                    prop_assert_eq!(source.content, Some(content));
                    prop_assert_eq!(&source.measured, std::slice::from_ref(&hash));
                    let document = Document::parse(&source.text, "table").unwrap();
                    prop_assert_eq!(document.scene(), &scene);
                }
            }
        }
    }

    #[test]
    fn a_measured_file_is_named_from_where_the_table_is() {
        let folder = tempfile::tempdir().unwrap();
        let scene = crate::scene::open("rough-sphere").unwrap().scene().clone();
        let scene = Scene { roughness: Some(Roughness::measured("stylus.txt")), ..scene };
        let file = |destination: &Path| {
            let written = Provenance::new(TableContent::Profile, &scene, folder.path(), destination);
            let scene = SceneText::of_raw(Raw::Provenance(written.text().to_owned())).unwrap().text;
            let document = Document::parse(&scene, "table").unwrap();
            let Some(Roughness::Measured { file, .. }) = &document.scene().roughness else {
                panic!("not measured")
            };
            file.clone()
        };
        assert_eq!(file(folder.path()), "stylus.txt");
        assert_eq!(file(&folder.path().join(".")), "stylus.txt");
        assert_eq!(file(Path::new("/")), folder.path().join("stylus.txt").to_str().unwrap());
    }

    #[test]
    fn arguments_of_spectra_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spectra.csv");
        let arguments = ["--unit", "µm", "a \"b\"\n.txt", "\u{1b}"].map(str::to_owned);
        let hash = MeasuredHash { file: "a".into(), sha256: "1".repeat(64) };
        let provenance = Provenance::of_spectra(&arguments).with_hashes(std::slice::from_ref(&hash));
        std::fs::write(&path, provenance.comments() + "spectrum\n").unwrap();
        let expected = SpectraTable { arguments: arguments.to_vec(), measured: vec![hash] };
        assert_eq!(SpectraTable::open(&path), Some(expected));
        assert!(matches!(SceneText::of_file(&path), Err(SceneTextError::NoProvenance(_))));
        std::fs::write(&path, "()").unwrap();
        assert_eq!(SpectraTable::open(&path), None);
        assert_eq!(SpectraTable::open(folder.path()), None);
    }

    #[test]
    fn tables_without_a_scene_are_refused() {
        let mut array = Vec::new();
        npy::write_header(&mut array, "'<f8'", "0,").unwrap();
        for (file, expected) in [
            (&b"# asperity 0.1.0\nx,z\n"[..], "first comments hold no scene"),
            (b"# asperity 0.1.0\n# content: nothing\n# scene:\n# ()\n", "without its content"),
            (
                b"# asperity 0.1.0\n# content: 9 preloads from 2.0 to 1.0 N\n# scene:\n# ()\n",
                "without its content",
            ),
            (
                b"# asperity 0.1.0\n# content: 999 preloads from 0.0 to 1.0 N\n# scene:\n# ()\n",
                "without its content",
            ),
            (&array, "an array without a scene"),
        ] {
            match read(file) {
                Err(SceneTextError::NoProvenance(why)) => assert!(why.contains(expected), "{why}"),
                other => panic!("{other:?}"),
            }
        }
        let plain = read(b"()").unwrap();
        assert_eq!((plain.text.as_str(), plain.content), ("()", None));
    }
}
