//! Completion of the typed path: in the prompts of files, in the library, and in the value of a measured surface.

use super::{Effect, library};
use crate::explorer::completion::Completion;
use crate::explorer::mode::Mode;
use crate::explorer::model::Model;
use crate::explorer::text_line::{Motion, TextLine};

/// Path being typed.
struct TypedPath {
    /// Text of the line before the path.
    before: String,
    /// Folder of a relative path; empty for the working folder.
    folder: String,
    /// The path as typed.
    path: String,
}

impl TypedPath {
    /// Path that ends at the end of the line: the whole line, or in the value of a roughness the text behind an open
    /// quote or a value without brackets.
    fn of(model: &Model) -> Option<Self> {
        let (line, is_value) = match &model.mode {
            // Title and notice of a scene are no paths.
            Mode::SaveAs(form) if form.line == 0 => (form.lines.first()?, false),
            Mode::Export(line) => (line, false),
            Mode::Library(library) => (&library.finder.query, false),
            Mode::Edit(line) if names_files(&model.parameter()?.path) => (line, true),
            _ => return None,
        };
        let text = line.text();
        if !is_value {
            return Some(TypedPath { before: String::new(), folder: String::new(), path: text });
        }
        let quotes = text.matches('"').count();
        let begin = match text.rfind('"') {
            Some(quote) if quotes % 2 == 1 => quote + 1,
            None if !text.contains(['(', '[']) => 0,
            _ => return None,
        };
        let (before, path) = text.split_at(begin);
        let is_absolute = std::path::Path::new(path).is_absolute();
        let folder =
            if is_absolute { String::new() } else { model.document.resolve("").display().to_string() };
        Some(TypedPath { before: before.to_owned(), folder, path: path.to_owned() })
    }

    /// The path from the working folder.
    fn whole(&self) -> String {
        format!("{}{}", self.folder, self.path)
    }

    /// The line with another path from the working folder in place of this one.
    fn line_with(&self, whole: &str) -> TextLine {
        let path = whole.strip_prefix(&self.folder).unwrap_or(whole);
        TextLine::new(&format!("{}{path}", self.before))
    }
}

/// Returns true for the parameters whose values hold names of files.
fn names_files(path: &str) -> bool {
    ["roughness", "roughness.file", "roughness.further_files", "roughness.opposite"].contains(&path)
}

/// Returns true if a path is being typed.
pub fn can_complete(model: &Model) -> bool {
    TypedPath::of(model).is_some()
}

/// Takes the next candidate, or requests candidates.
pub fn next(model: &mut Model) -> Vec<Effect> {
    let Some(typed) = TypedPath::of(model) else { return Vec::new() };
    match model.completion.as_mut().and_then(Completion::take_next).map(str::to_owned) {
        Some(path) => put(model, &typed, &path),
        None => vec![Effect::Complete(typed.whole())],
    }
}

/// Stores the candidates for a typed path: their common start is typed at once; without a longer start they are
/// only shown.
pub fn completed(model: &mut Model, typed: &str, paths: Vec<String>) -> Vec<Effect> {
    let Some(now) = TypedPath::of(model).filter(|now| now.whole() == typed) else { return Vec::new() };
    if let Some(line) = model.mode.line_mut() {
        line.go(Motion::End);
    }
    let completion = Completion::new(typed, paths);
    let (common, is_only) = (completion.common_start(), completion.only().is_some());
    model.completion = Some(completion).filter(|_| !is_only);
    // Candidates with the letters elsewhere have no start in common with the typed path.
    let adds = common.chars().count() > typed.chars().count() || is_only;
    if adds { put(model, &now, &common) } else { Vec::new() }
}

/// Puts a path in place of the typed one.
fn put(model: &mut Model, typed: &TypedPath, path: &str) -> Vec<Effect> {
    if let Some(line) = model.mode.line_mut() {
        *line = typed.line_with(path);
    }
    library::search(model)
}
