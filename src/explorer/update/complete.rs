//! Completion of the path that is typed, in the prompts of files and in the library.

use super::{Effect, library};
use crate::explorer::completion::Completion;
use crate::explorer::mode::Mode;
use crate::explorer::model::Model;
use crate::explorer::text_line::TextLine;

/// Takes the next candidate, or asks for candidates.
pub fn obey(model: &mut Model) -> Vec<Effect> {
    let next = model.completion.as_mut().and_then(Completion::take_next).map(str::to_owned);
    match (next, model.mode.line_mut()) {
        (Some(path), _) => put(model, &path),
        (None, Some(line)) => vec![Effect::Complete(line.text())],
        (None, None) => Vec::new(),
    }
}

/// Takes in the candidates for what was typed: what they have in common is typed at once, and where that is nothing more
/// they are shown.
pub fn completed(model: &mut Model, typed: &str, paths: Vec<String>) -> Vec<Effect> {
    let takes_paths = matches!(model.mode, Mode::SaveAs { .. } | Mode::Export(_) | Mode::Library(_));
    let Some(line) = model.mode.line_mut().filter(|line| takes_paths && line.text() == typed) else {
        return Vec::new();
    };
    line.go(crate::explorer::action::Motion::End);
    let completion = Completion::new(paths);
    let (common, is_only) = (completion.common_start(), completion.only().is_some());
    model.completion = Some(completion).filter(|_| !is_only);
    // Candidates that have the letters elsewhere have nothing in common with them.
    if common.chars().count() > typed.chars().count() || is_only { put(model, &common) } else { Vec::new() }
}

/// Puts a path in place of what is typed.
fn put(model: &mut Model, path: &str) -> Vec<Effect> {
    if let Some(line) = model.mode.line_mut() {
        *line = TextLine::new(path);
    }
    library::search(model)
}
