//! The newest ghost beside the scene: its profile and contact when it was kept, the differences of the
//! scenes, and both adhesion forces.

use super::{PaneRow, Place, force, profile, section};
use crate::explorer::app::{App, Ghost};
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::view::lines::{draw_lines, draw_reason};
use crate::export::adhesion_forces;
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    place: Place::CloseUp,
    title,
    draw,
    figure: |app| {
        let (snapshot, ghost) = (app.snapshot.as_deref()?, app.beside()?);
        let (beside, title) = (ghost.snapshot.as_deref()?, ghost.document.title());
        Some(section::figure(title, &beside.profile, beside, profile::heights(app, snapshot)))
    },
    edge: |app, area| {
        let snapshot = app.snapshot.as_deref()?;
        let beside = app.beside()?.snapshot.as_deref()?;
        Some(profile::scene_names(beside, profile::heights(app, snapshot), area, app.view.appearance))
    },
    keys: Some(ModeKind::Crosshair),
    help: &[(
        "Beside",
        "&: profile and contact of the newest ghost when it was kept, heights z on the axis of the profile \
         above; below them both adhesion forces F_a with their ratio, and the changed parameters",
    )],
    ..PaneRow::EMPTY
};

/// Title of the pane.
fn title(app: &App) -> String {
    let Some(ghost) = app.beside() else { return String::new() };
    let scene = ghost.document.scene();
    let name = if scene.title.is_empty() { ghost.document.name() } else { &scene.title };
    let length = format_quantity(scene.length, "m");
    format!(" Profile z(x) of {}: {name}, x to {length} ", force::newest_letter(app))
}

/// Draws the profile of the ghost on the heights of the scene, and compares the two.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let Some(ghost) = app.beside() else { return };
    let text_rows = u16::from(area.height >= 4) + u16::from(area.height >= 8);
    let above = Rect { height: area.height - text_rows, ..area };
    // A small window hides the profile, which then is not drawn.
    let kept = ghost.snapshot.as_deref().filter(|kept| !kept.profile.columns.is_empty());
    let shown = app.snapshot.as_deref().zip(kept);
    if let Some((snapshot, beside)) = shown {
        let histogram = ghost.computed.outcome.histogram.as_ref();
        profile::draw_scene(
            frame,
            above,
            (beside, histogram),
            profile::heights(app, snapshot),
            app.view.appearance,
        );
    } else {
        draw_reason(
            frame,
            above,
            "this loop was kept without a picture of its contact",
            app.view.appearance.theme,
        );
    }
    let changes = Line::raw(format!("{} → this scene: {}", force::newest_letter(app), ghost.changes));
    let lines = [forces(app, ghost), changes];
    draw_lines(frame, Rect { y: above.bottom(), height: text_rows, ..area }, lines);
}

/// Adhesion forces of the ghost and of the scene, and their ratio.
fn forces(app: &App, ghost: &Ghost) -> Line<'static> {
    let force = |computed: &SolvedScene| computed.outcome.figures.adhesion_force;
    let before = force(&ghost.computed);
    Line::raw(match app.current() {
        Some(now) => format!("F_a {}", adhesion_forces([before, force(now)])),
        None => "computing…".to_owned(),
    })
}
