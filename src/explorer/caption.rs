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
    match snapshot.drive {
        Drive::Manual => Some("manual loading"),
        Drive::Leg(index) => {
            let branches = Branch::all(app.legs());
            let branch = branches
                .iter()
                .find(|branch| branch.stages.contains(&index))?;
            let rests = app.legs()[index].curve.len() == 1;
            event(app.legs(), branch, snapshot.point).filter(|_| !rests)
        }
    }
}
