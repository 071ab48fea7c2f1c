//! Caption: the name of the event at the shown state of the contact. The events are first contact,
//! spreading, preload, detachment, pull-off and separation.

use super::app::App;
use super::request::Drive;
use asperity_contact::Branch;
use asperity_report::event;

/// Returns the event at the shown state, in words that fit into the title of a pane 34 columns
/// wide. Returns `None` before the first result is computed, and in a stage that does not move the
/// body.
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
