//! The event at the shown state of the contact in words: first contact, spreading, preload,
//! detachment, pull-off, separation.

use super::app::App;
use super::request::Drive;
use asperity_contact::Branch;
use asperity_report::event;

/// Event at the shown state, short enough for the title of a pane of 34 columns; `None` before the
/// first result and while the body does not move.
pub fn caption(app: &App) -> Option<&'static str> {
    let snapshot = app.present()?;
    let Drive::Leg(index) = snapshot.drive else {
        return Some("manual loading");
    };
    let branches = Branch::all(app.legs());
    let mut branches = branches.iter();
    let branch = branches.find(|branch| branch.stages.contains(&index))?;
    let has_motion = app.legs()[index].curve.len() != 1;
    if !has_motion {
        return None;
    }
    event(app.legs(), branch, snapshot.point)
}
