//! The close-up of contact fragments, with their boundary points as the paper's white circles, and a strip
//! of the whole contact.

use super::position::zoom_at;
use super::{PaneRow, Place, section};
use crate::draw::{CellPlot, Chart, Ink, Layer, Shape, Sign, Span};
use crate::explorer::app::App;
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::snapshot::{ContactSnapshot, FragmentFacts, Section};
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::view::lines::draw_lines;
use crate::explorer::view::plot;
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    place: Place::CloseUp,
    title,
    draw,
    figure: |app| {
        let snapshot = app.snapshot.as_deref()?;
        let shown = &snapshot.close_up.section;
        let mut figure = section::figure(app.edit.document.title(), shown, snapshot, heights(shown));
        let ends = Shape::signs(patch_ends(snapshot).collect(), Sign::Ring);
        figure.charts[0].layers.push(Layer::new("patch end".into(), Ink::Contact, ends));
        Some(figure)
    },
    edge: names,
    keys: Some(ModeKind::Crosshair),
    section: Some(section_at),
    wheel: zoom_at,
    help: &[(
        "Fragments",
        "close-up of a contact patch; ○ marks its edges. Below it the whole contact, [ ] around the close-up",
    )],
    ..PaneRow::EMPTY
};

/// Title of the pane.
fn title(app: &App) -> String {
    let Some(snapshot) = app.snapshot.as_ref() else { return " Fragments ".to_owned() };
    let shown = &snapshot.close_up.section;
    let from = (snapshot.line.first + shown.first) as f64 * snapshot.line.spacing;
    let width = shown.springs as f64 * snapshot.line.spacing;
    let [width, from] = [width, from].map(|x| format_quantity(x, "m"));
    format!(" Fragments, {width} from x = {from} ")
}

/// Names of the lines and signs, for the lower edge of the frame.
fn names(app: &App, area: Rect) -> Option<Line<'static>> {
    let snapshot = app.snapshot.as_ref()?;
    let shown = &snapshot.close_up.section;
    let chart = section::chart(shown, snapshot.line, heights(shown));
    let ring = Text::styled("○", app.view.appearance.theme.style(Meaning::Contact));
    let ring = vec![ring, Text::raw(" patch end")];
    Some(section::names(snapshot, &chart, [ring], app.view.appearance, area.width))
}

/// The section in the close-up, with its chart and place.
fn section_at(app: &App, area: Rect) -> Option<(&Section, Chart, CellPlot)> {
    let snapshot = app.snapshot.as_deref()?;
    let (chart, place) = placed(snapshot, area);
    Some((&snapshot.close_up.section, chart, place))
}

/// Draws the close-up and the values of its fragment.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let Some(snapshot) = app.snapshot.as_ref() else { return };
    let theme = app.view.appearance.theme;
    let close_up = &snapshot.close_up;
    let section = &close_up.section;
    let (strip_rows, text_rows) = rows_below(area);
    let (chart, place) = placed(snapshot, area);
    plot::in_theme(app.view.appearance, |style| place.draw(frame.buffer_mut(), &chart, style));
    for at in patch_ends(snapshot) {
        if let Some(cell) = place.cell(&chart, app.view.appearance.marker.symbols(), at) {
            frame.buffer_mut()[cell].set_symbol("○").set_style(theme.style(Meaning::Contact));
        }
    }
    if strip_rows > 0 {
        let springs = app.solved.as_ref().map_or(1, |computed| computed.outcome.history.work.springs);
        let line = strip(&snapshot.strip, section, springs as usize, theme);
        frame.render_widget(
            Paragraph::new(line),
            Rect { y: area.bottom() - text_rows - strip_rows, height: 1, ..area },
        );
    }
    let lines = describe(close_up.fragment, snapshot.point.fragments, area.width);
    draw_lines(frame, Rect { y: area.bottom() - text_rows, height: text_rows, ..area }, lines);
}

/// Positions and heights of the ends of contact patches, m.
fn patch_ends(snapshot: &ContactSnapshot) -> impl Iterator<Item = (f64, f64)> {
    let ends = snapshot.close_up.boundaries.iter();
    ends.map(|&(spring, height)| (section::position(snapshot.line, spring), height))
}

/// Rows below the plot: those of the whole contact and those of the text.
fn rows_below(area: Rect) -> (u16, u16) {
    (u16::from(area.height >= 9), u16::from(area.height >= 4) + u16::from(area.height >= 7))
}

/// The chart of the close-up and its place in the pane.
fn placed(snapshot: &ContactSnapshot, area: Rect) -> (Chart, CellPlot) {
    let (strip, text) = rows_below(area);
    let shown = &snapshot.close_up.section;
    let mut chart = section::chart(shown, snapshot.line, heights(shown));
    section::add_crosshair(&mut chart, snapshot);
    let place = CellPlot::within(Rect { height: area.height - strip - text, ..area }, &chart);
    (chart, place)
}

/// The axis of heights: the line, and the surface unless that is far above or below.
fn heights(section: &Section) -> Span {
    let (low, high) = section.heights;
    let room = 0.4 * (high - low);
    Span::around([low, high, section.level.clamp(low - room, high + room)].into_iter(), 0.05)
}

/// The whole contact in one row; the brackets enclose the close-up.
fn strip(strip: &str, section: &Section, springs: usize, theme: Theme) -> Line<'static> {
    let (count, springs) = (strip.chars().count(), springs.max(1));
    if count < 4 {
        return Line::default();
    }
    let cell = |spring: usize| (spring * count / springs).min(count - 1);
    let open = cell(section.first).min(count - 2);
    let close = cell((section.first + section.springs).saturating_sub(1)).max(open + 1);
    let part = |from: usize, to: usize| -> Text<'static> {
        let glyphs: String = strip.chars().take(to).skip(from).collect();
        Text::styled(glyphs, theme.style(Meaning::Contact))
    };
    let bracket = |text: &'static str| Text::styled(text, theme.style(Meaning::Title));
    Line::from(vec![part(0, open), bracket("["), part(open + 1, close), bracket("]"), part(close + 1, count)])
}

/// Share of a stretch below which a difference is rounding.
const ROUNDING: f64 = 1e-13;

/// The fragment in words: its place, its force, and the margin of its most stretched spring before
/// detachment.
fn describe(fragment: Option<FragmentFacts>, fragments: u64, width: u16) -> [Line<'static>; 2] {
    let Some(facts) = fragment else { return [Line::raw("○ nothing is in contact"), Line::default()] };
    let length = format_quantity(facts.length, "m");
    let springs = facts.patch.springs().len();
    let plural = if springs == 1 { "" } else { "s" };
    let mut first =
        format!("○ fragment {} of {fragments}: {springs} spring{plural}, δx {length}", facts.number + 1);
    let force = format!(", F {}", format_quantity(facts.force, "N"));
    if first.chars().count() + force.chars().count() <= usize::from(width) {
        first += &force;
    }
    let margin = facts.largest_stretch - facts.most_stretched;
    // At the very edge of detachment the margin is rounding.
    let margin = if margin.abs() <= ROUNDING * facts.largest_stretch { 0.0 } else { margin };
    let [bears, stretched, margin] =
        [facts.largest_stretch, facts.most_stretched, margin].map(|value| format_quantity(value, "m"));
    let second = if width >= 60 {
        format!("  Δl_max {bears} · most stretched {stretched} · margin {margin}")
    } else {
        format!("  Δl {stretched} of Δl_max {bears}")
    };
    [Line::raw(first), Line::raw(second)]
}
