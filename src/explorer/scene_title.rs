//! The title of the scene on the screen: its name, the sign for unsaved changes, and its notice.

use super::editor::Editor;
use super::text::on_one_line;
use asperity_scene::Document;
use ratatui::text::Span;

/// Sign for unsaved changes, with a blank before it.
const CHANGED: &str = " [changed]";

/// Texts of the title line.
pub struct SceneTitle {
    /// Title of the scene or, if it has none, its name.
    pub name: String,
    /// The longest of the names that the scene can have while only its numbers change.
    longest_name: String,
    pub is_changed: bool,
    /// Notes on the scene; empty if there are none.
    notice: String,
    /// True if the scene has changed since the notice was written, so that it may be wrong now.
    is_notice_hidden: bool,
}

impl SceneTitle {
    /// Returns what the title line shows. If the scene has changed and its notice has not, the
    /// notice is hidden, because it may be wrong now.
    pub fn new(edit: &Editor) -> Self {
        let document = &edit.document;
        let saved = edit.saved.get(document.name());
        let is_changed = edit.is_unsaved();
        let notice = &document.scene().notice;
        let saved_notice = saved.map_or("", |saved| &saved.scene().notice);
        // A change of a built-in scene removes its notice.
        let is_notice_hidden = is_changed && (notice.is_empty() || notice == saved_notice);
        let notice = if is_notice_hidden {
            saved_notice
        } else {
            notice
        };
        SceneTitle {
            name: shown_name(document).to_owned(),
            longest_name: longest_name(document, saved).to_owned(),
            is_changed,
            notice: on_one_line(notice),
            is_notice_hidden,
        }
    }

    /// Returns the sign for unsaved changes, with a blank before it; empty without changes.
    pub fn sign(&self) -> &'static str {
        if self.is_changed { CHANGED } else { "" }
    }

    /// Returns the notice with blanks before it; empty if there is none or if it is hidden.
    pub fn notice_apart(&self) -> String {
        if self.notice.is_empty() || self.is_notice_hidden {
            String::new()
        } else {
            format!("  {}", self.notice)
        }
    }

    /// Returns the number of columns that the title needs on one line, whichever numbers of the
    /// scene change. The sign for unsaved changes and a hidden notice count too: if the first
    /// change of a scene added or removed a line, it would move all panes, and over a slow line its
    /// answer would take twice as long.
    pub fn columns(&self) -> usize {
        let title = format!("{}{CHANGED}  {}", self.longest_name, self.notice);
        Span::raw(title.trim_end()).width()
    }
}

/// Returns the name that the title shows for a scene. The title of a changed built-in scene would
/// say again that the scene has changed.
fn shown_name(document: &Document) -> &str {
    let title = &document.scene().title;
    if title.is_empty() || document.is_changed_built_in() {
        document.name()
    } else {
        title
    }
}

/// Returns the longest of the names that a scene can have while only its numbers change. A built-in
/// scene has two: a change replaces its title by its name, and undo brings its title back.
fn longest_name<'a>(document: &'a Document, saved: Option<&'a Document>) -> &'a str {
    let shown = shown_name(document);
    let other = if document.is_changed_built_in() {
        saved.map_or("", shown_name)
    } else if document.has_built_in_title() {
        document.name()
    } else {
        ""
    };
    if Span::raw(other).width() > Span::raw(shown).width() {
        other
    } else {
        shown
    }
}
