//! The newest ghost beside the scene: its profile and contact when it was kept, the differences of the scenes, and both
//! adhesion forces.

use super::{PaneRow, Place, profile, section};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::SolvedScene;
use crate::export::adhesion_forces;
use crate::scene::{Change, format_quantity};
use ratatui::text::Line;

pub static ROW: PaneRow = PaneRow {
    place: Place::CloseUp,
    panel,
    figure: |app, panel| {
        let ghost = app.beside()?;
        Some(section::figure(ghost.document.title(), ghost.snapshot.as_deref()?, panel.chart()?.clone()))
    },
    keys: Some(Context::Crosshair),
    help: &[(
        "Beside",
        "&: profile and contact of the newest ghost when it was kept, heights z on the axis of the profile \
         above; below them both adhesion forces F_a with their ratio, and the changed parameters",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, _: ratatui::layout::Size) -> Panel {
    let Some(ghost) = app.beside() else { return Panel::of_text(String::new(), "") };
    let scene = ghost.document.scene();
    let name = if scene.title.is_empty() { ghost.document.name() } else { &scene.title };
    let (letter, length) = (app.newest_letter(), format_quantity(scene.length, "m"));
    let title = format!("Profile z(x) of {letter}: {name}, x to {length}");
    // A small window hides the profile, which then is not drawn.
    let kept = ghost.snapshot.as_deref().filter(|kept| !kept.profile.columns.is_empty());
    let panel = match app.snapshot.as_deref().zip(kept) {
        Some((snapshot, kept)) => {
            let (histogram, z) = (ghost.computed.outcome.histogram.as_ref(), section::heights(app, snapshot));
            profile::of_scene(title, kept, histogram, z, app.view.appearance)
        }
        None => Panel::of_text(title, "this loop was kept without a picture of its contact"),
    };
    let force = |computed: &SolvedScene| computed.outcome.figures.adhesion_force;
    let forces = match app.current() {
        Some(now) => format!("F_a {}", adhesion_forces([force(&ghost.computed), force(now)])),
        None => "computing…".to_owned(),
    };
    let changes = ghost.changes(&app.edit.document, Change::to_string);
    let changes = format!("{letter} → this scene: {changes}");
    Panel { foot: [forces, changes].map(Line::raw).to_vec(), ..panel }
}
