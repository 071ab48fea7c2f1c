//! Opening scenes and studies.

use super::{Effect, edit};
use crate::explorer::mode::Mode;
use crate::explorer::model::Model;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text_line::TextLine;
use crate::scene::{Entry, typed_path};

/// Opens the list of scenes.
pub fn open(model: &mut Model) -> Vec<Effect> {
    model.ask(Purpose::Scene(Vec::new()), TextLine::default());
    vec![Effect::List]
}

/// Stores the scenes that can be opened.
pub fn listed(model: &mut Model, entries: Vec<Entry>) {
    if let Mode::Prompt(prompt) = &mut model.mode {
        prompt.purpose = Purpose::Scene(entries);
        prompt.search(&model.parameters);
    }
}

/// Opens the selected scene, or the typed path where no scene fits.
pub fn accept(model: &mut Model, prompt: &Prompt) -> Result<Vec<Effect>, String> {
    if let Some(entry) = prompt.scene() {
        return Ok(edit::open_read(model, entry.document()));
    }
    let typed = prompt.line.text().trim().to_owned();
    if typed.is_empty() {
        return Err("type a name or a path".to_owned());
    }
    let path = typed_path(&typed).into_os_string().into_string();
    Ok(vec![Effect::Open(path.unwrap_or(typed))])
}

/// Asks again for a path that could not be opened.
pub fn refused(model: &mut Model, path: &str, why: &str) -> Vec<Effect> {
    let purpose = Purpose::Scene(Vec::new());
    model.mode = Mode::Prompt(Prompt::refused(purpose, path, why, &model.parameters));
    vec![Effect::List]
}
