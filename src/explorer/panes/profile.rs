//! The profile: the rigid line, the elastic surface above it, and their contact.

use super::position::zoom_at;
use super::{PaneRow, Place, histogram, section};
use crate::draw::{CellPlot, Chart, Span};
use crate::explorer::app::App;
use crate::explorer::layout::{inside, split_profile};
use crate::explorer::mode::ModeKind;
use crate::explorer::snapshot::{ContactSnapshot, Section};
use crate::explorer::theme::{Appearance, Meaning, Theme};
use crate::explorer::view::lines::draw_reason;
use crate::explorer::view::plot;
use crate::scene::format_quantity;
use crate::surface::Histogram;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title,
    draw,
    figure: |app| {
        let snapshot = app.snapshot.as_deref()?;
        Some(section::figure(app.edit.document.title(), &snapshot.profile, snapshot, heights(app, snapshot)))
    },
    edge: names,
    place: Place::Own,
    keys: Some(ModeKind::Crosshair),
    section: Some(section_at),
    wheel: zoom_at,
    help: &[(
        "Profile",
        "rigid profile below, elastic surface above; ■ marks contact. Beside it the histogram of heights, and ¦ the \
         normal distribution of the same rms height",
    )],
    ..PaneRow::EMPTY
};

/// Title of the pane.
fn title(app: &App) -> String {
    let length = format_quantity(app.edit.document.scene().length, "m");
    if app.beside().is_some() {
        return format!(" Profile z(x) of this scene, x to {length} ");
    }
    let follows = if app.view.profile.follow { " · follows" } else { "" };
    let Some(snapshot) = app.snapshot.as_ref() else { return format!(" Profile z(x), x to {length} ") };
    let shown = &snapshot.profile;
    if app.view.profile.share >= 1.0 {
        return format!(" Profile z(x), x to {length}{follows} ");
    }
    let from = (snapshot.line.first + shown.first) as f64 * snapshot.line.spacing;
    let to = from + shown.springs as f64 * snapshot.line.spacing;
    let [from, to] = [from, to].map(|x| format_quantity(x, "m"));
    format!(" Profile z(x), x from {from} to {to} of {length}{follows} ")
}

/// Names of the lines and signs, for the lower edge of the frame.
fn names(app: &App, area: Rect) -> Option<Line<'static>> {
    let snapshot = app.snapshot.as_ref()?;
    Some(scene_names(snapshot, heights(app, snapshot), area, app.view.appearance))
}

/// Names of the lines and signs of a scene at one snapshot, heights within `z`.
pub fn scene_names(snapshot: &ContactSnapshot, z: Span, area: Rect, appearance: Appearance) -> Line<'static> {
    let chart = section::chart(&snapshot.profile, snapshot.line, z);
    let bell = || vec![Text::styled("¦", appearance.theme.style(Meaning::Surface)), Text::raw(" normal")];
    let beside = split_profile(inside(area)).1.map(|_| bell());
    section::names(snapshot, &chart, beside, appearance, area.width)
}

/// The shown part of the profile, with its chart and place.
fn section_at(app: &App, area: Rect) -> Option<(&Section, Chart, CellPlot)> {
    let snapshot = app.snapshot.as_deref()?;
    let (chart, place) = placed(snapshot, area, heights(app, snapshot));
    Some((&snapshot.profile, chart, place))
}

/// Draws the profile with the histogram of its heights on the same axis.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let Some(snapshot) = app.snapshot.as_ref() else {
        return draw_reason(frame, area, "…", app.view.appearance.theme);
    };
    let histogram = app.solved.as_ref().and_then(|computed| computed.outcome.histogram.as_ref());
    draw_scene(frame, area, (snapshot, histogram), heights(app, snapshot), app.view.appearance);
}

/// Draws the profile of a scene at one snapshot with its histogram, heights within `z`.
pub fn draw_scene(
    frame: &mut Frame<'_>,
    area: Rect,
    (snapshot, histogram): (&ContactSnapshot, Option<&Histogram>),
    z: Span,
    appearance: Appearance,
) {
    let (chart, place) = placed(snapshot, area, z);
    plot::in_theme(appearance, |style| place.draw(frame.buffer_mut(), &chart, style));
    let (area, beside) = split_profile(area);
    let plot = place.plot;
    if strip_rows(area) > 0 {
        let row = Rect { x: plot.x, width: plot.width, y: area.bottom() - 1, height: 1 };
        contact_strip(frame, row, &snapshot.profile, appearance.theme);
    }
    if let Some(beside) = beside {
        let beside = Rect { y: plot.y, height: plot.height, ..beside };
        histogram::draw(frame, beside, place.numbers(), histogram, z, appearance.theme);
    }
}

/// Rows of the contact strip below the plot.
fn strip_rows(area: Rect) -> u16 {
    u16::from(area.height >= 5)
}

/// The chart of the profile, heights within `z`, and its place in the pane.
fn placed(snapshot: &ContactSnapshot, area: Rect, z: Span) -> (Chart, CellPlot) {
    let (area, _) = split_profile(area);
    let mut chart = section::chart(&snapshot.profile, snapshot.line, z);
    section::add_crosshair(&mut chart, snapshot);
    let place = CellPlot::within(Rect { height: area.height - strip_rows(area), ..area }, &chart);
    (chart, place)
}

/// The axis of heights: the whole line, and the surface unless far away. Two scenes side by side share the axis.
pub fn heights(app: &App, snapshot: &ContactSnapshot) -> Span {
    let ends = |section: &Section| {
        let (low, high) = section.heights;
        let far = high + 0.5 * (high - low);
        [low, high, section.level.min(far)]
    };
    let beside = app.beside().and_then(|ghost| ghost.snapshot.as_deref());
    let beside = beside.into_iter().flat_map(|beside| ends(&beside.profile));
    Span::around(ends(&snapshot.profile).into_iter().chain(beside), 0.05)
}

/// Draws one row of glyphs for the contact along the section.
fn contact_strip(frame: &mut Frame<'_>, row: Rect, section: &Section, theme: Theme) {
    let (count, cells) = (section.columns.len(), usize::from(row.width));
    if count == 0 {
        return;
    }
    let glyphs: String = (0..cells)
        .map(|cell| {
            let from = cell * count / cells;
            let part = &section.columns[from..((cell + 1) * count / cells).max(from + 1)];
            match part.iter().filter(|column| column.contact.is_some()).count() {
                0 => '·',
                held if held < part.len() => '▪',
                _ => '■',
            }
        })
        .collect();
    frame.render_widget(Paragraph::new(Line::styled(glyphs, theme.style(Meaning::Contact))), row);
}
