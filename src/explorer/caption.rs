//! Caption: the name of the event at the shown state of the contact. The events are first contact,
//! spreading, preload, detachment, pull-off and separation.

use super::app::App;
use super::request::Drive;
use asperity_contact::{Branch, Move};
use asperity_data::counted;
use asperity_report::event;

/// Returns the event at the shown state, in words that fit into the title of a pane 34 columns
/// wide. Returns `None` before the first result is computed, and in a stage that does not move the
/// body.
pub fn caption(app: &App) -> Option<String> {
    let snapshot = app.present()?;
    let (stages, index) = match snapshot.drive {
        Drive::Stage(index) => (app.stages(), index),
        Drive::Path(index) => (app.played_stages(), index),
        Drive::Manual => return Some(caption_of_path(app)),
    };
    let branches = Branch::all(stages);
    let mut branches = branches.iter();
    let branch = branches.find(|branch| branch.stages.contains(&index))?;
    let record = stages.get(index)?;
    if record.curve.len() == 1 {
        return None;
    }
    if matches!(record.target, Move::Hold(_)) {
        return Some("rest".to_owned());
    }
    event(stages, branch, snapshot.point).map(str::to_owned)
}

/// Returns the words for the end of the path of manual loading. If the contact cannot follow all
/// moves, they state how many it follows.
fn caption_of_path(app: &App) -> String {
    match app.followed() {
        Some(followed) if followed.stopped.is_some() => {
            let moves = counted(followed.path.moves.len() as u64, "move");
            format!("manual loading, {} of {moves}", followed.count())
        }
        _ => "manual loading".to_owned(),
    }
}
