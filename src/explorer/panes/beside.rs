//! The newest ghost beside the scene: its profile and contact when it was kept, the differences of the
//! scenes, and both adhesion forces.

use super::{PaneRow, Place, force, profile, section};
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::model::{Ghost, Model};
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
    figure: |model| {
        let (snapshot, ghost) = (model.snapshot.as_deref()?, model.beside()?);
        let (beside, title) = (ghost.snapshot.as_deref()?, ghost.document.title());
        Some(section::figure(title, &beside.profile, beside, profile::heights(model, snapshot)))
    },
    edge: |model, area| {
        let snapshot = model.snapshot.as_deref()?;
        let beside = model.beside()?.snapshot.as_deref()?;
        Some(profile::scene_names(beside, profile::heights(model, snapshot), area, model.appearance))
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
fn title(model: &Model) -> String {
    let Some(ghost) = model.beside() else { return String::new() };
    let scene = ghost.document.scene();
    let name = if scene.title.is_empty() { ghost.document.name() } else { &scene.title };
    let length = format_quantity(scene.length, "m");
    format!(" Profile z(x) of {}: {name}, x to {length} ", force::newest_letter(model))
}

/// Draws the profile of the ghost on the heights of the scene, and compares the two.
fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let area = inside(area);
    let Some(ghost) = model.beside() else { return };
    let text_rows = u16::from(area.height >= 4) + u16::from(area.height >= 8);
    let above = Rect { height: area.height - text_rows, ..area };
    // A small window hides the profile, which then is not drawn.
    let kept = ghost.snapshot.as_deref().filter(|kept| !kept.profile.columns.is_empty());
    let shown = model.snapshot.as_deref().zip(kept);
    if let Some((snapshot, beside)) = shown {
        let histogram = ghost.computed.outcome.histogram.as_ref();
        profile::draw_scene(
            frame,
            above,
            (beside, histogram),
            profile::heights(model, snapshot),
            model.appearance,
        );
    } else {
        draw_reason(
            frame,
            above,
            "this loop was kept without a picture of its contact",
            model.appearance.theme,
        );
    }
    let changes = Line::raw(format!("{} → this scene: {}", force::newest_letter(model), ghost.changes));
    let lines = [forces(model, ghost), changes];
    draw_lines(frame, Rect { y: above.bottom(), height: text_rows, ..area }, lines);
}

/// Adhesion forces of the ghost and of the scene, and their ratio.
fn forces(model: &Model, ghost: &Ghost) -> Line<'static> {
    let force = |computed: &SolvedScene| computed.outcome.figures.adhesion_force;
    let before = force(&ghost.computed);
    Line::raw(match model.current() {
        Some(now) => format!("F_a {}", adhesion_forces([before, force(now)])),
        None => "computing…".to_owned(),
    })
}
