//! Opening scenes and studies.

use super::{Effect, edit};
use crate::explorer::app::App;
use crate::explorer::mode::Mode;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text_line::TextLine;
use crate::scene::{Entry, typed_path};

/// Opens the list of scenes.
pub fn open(app: &mut App) -> Vec<Effect> {
    app.ask(Purpose::Scene(Vec::new()), TextLine::default());
    vec![Effect::List]
}

/// Stores the scenes that can be opened.
pub fn listed(app: &mut App, entries: Vec<Entry>) {
    if let Mode::Prompt(prompt) = &mut app.mode {
        prompt.purpose = Purpose::Scene(entries);
        prompt.search(&app.edit.parameters);
    }
}

/// Opens the selected scene, or the typed path where no scene fits.
pub fn accept(app: &mut App, prompt: &Prompt) -> Result<Vec<Effect>, String> {
    if let Some(entry) = prompt.scene() {
        return Ok(edit::open_read(app, entry.document.clone()));
    }
    let typed = prompt.line.text().trim().to_owned();
    if typed.is_empty() {
        return Err("type a name or a path".to_owned());
    }
    let path = typed_path(&typed).into_os_string().into_string();
    Ok(vec![Effect::Open(path.unwrap_or(typed))])
}

/// Asks again for a path that could not be opened.
pub fn refused(app: &mut App, path: &str, why: &str) -> Vec<Effect> {
    let purpose = Purpose::Scene(Vec::new());
    app.mode = Mode::Prompt(Prompt::refused(purpose, path, why, &app.edit.parameters));
    vec![Effect::List]
}
