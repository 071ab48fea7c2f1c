//! The close-up of contact patches, with their boundary points as white circles as in the paper, and a strip of the whole
//! contact.

use super::row::PaneRow;
use super::section;
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::{ContactSnapshot, PatchFacts};
use crate::explorer::theme::{Meaning, Theme};
use asperity_data::format_quantity;
use asperity_plot::{Chart, Ink, Layer, Shape, Sign, Span};
use asperity_report::{Part as LinePart, Section};
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| {
        let chart = of_springs(app, LinePart::drawn)?;
        Some(section::figure(app, app.snapshot.as_deref()?, chart))
    },
    report: |app| section::table(app, of_springs(app, LinePart::listed)?),
    help: &[(
        "Contact patches",
        "close-up of a contact patch; ○ marks its edges. Below it the whole contact, [ ] around the close-up",
    )],
    ..PaneRow::EMPTY
};

/// Smallest number of rows with the strip of the whole contact.
const WITH_STRIP: u16 = 9;

fn panel(app: &App, size: Size) -> Panel {
    let Some(snapshot) = app.snapshot.as_deref() else {
        return Panel::of_text("Contact patches".to_owned(), "");
    };
    let (section, theme) = (&snapshot.close_up.section, app.view.appearance.theme);
    let from = (snapshot.line.first + section.first) as f64 * snapshot.line.spacing;
    let to = from + section.springs as f64 * snapshot.line.spacing;
    let [from, to] = [from, to].map(|x| format_quantity(x, "m"));
    let title = format!("Contact patches, x {from} to {to}");
    let mut panel = section::panel(title, snapshot, section, heights(section), app.view.appearance);
    if snapshot.probe.is_none() {
        let ring = Text::styled("○", theme.style(Meaning::Contact));
        panel.edge.push(vec![ring, Text::raw(" patch end")]);
    }
    if let Body::Chart(plot) = &mut panel.body {
        plot.chart.layers.push(ends(snapshot));
    }
    if size.height >= WITH_STRIP {
        let springs = app.solved.as_ref().map_or(1, |computed| computed.outcome.history.work.springs);
        panel.foot.push(strip(&snapshot.strip, section, springs as usize, theme));
    }
    panel.foot.extend(describe(app, snapshot.close_up.patch, snapshot.point.fragments).map(Line::raw));
    panel
}

/// The signs at the ends of the contact patches.
fn ends(snapshot: &ContactSnapshot) -> Layer {
    let ends = snapshot.close_up.boundaries.iter();
    let ends = ends.map(|&(spring, height)| (section::position(snapshot.line, spring), height)).collect();
    Layer::new("patch end".into(), Ink::Contact, Shape::signs(ends, Sign::Ring))
}

/// Chart of the springs in the pane, for a file.
fn of_springs(app: &App, part: fn(usize, usize) -> LinePart) -> Option<Chart> {
    let snapshot = app.snapshot.as_deref()?;
    let section = &snapshot.close_up.section;
    let mut chart = section::of_springs(snapshot, section, heights(section), part)?;
    chart.layers.push(ends(snapshot));
    Some(chart)
}

/// Range of heights: the profile, and the surface unless it is far above or below.
fn heights(section: &Section) -> Span {
    let (low, high) = section.heights;
    let room = 0.4 * (high - low);
    Span::around([low, high, section.level.clamp(low - room, high + room)].into_iter(), 0.05)
}

/// The whole contact in one row; brackets enclose the part in the close-up.
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

/// Share of a stretch below which a difference counts as rounding.
const ROUNDING: f64 = 1e-13;

/// The contact patch in words: its place and force, and the stretch of its most stretched spring.
fn describe(app: &App, patch: Option<PatchFacts>, patches: u64) -> [String; 2] {
    let Some(PatchFacts { number, patch, state }) = patch else {
        return ["○ nothing is in contact".to_owned(), String::new()];
    };
    let springs = patch.springs().len();
    let plural = if springs == 1 { "" } else { "s" };
    let (length, force) = (state.length, app.without_rounding(state.force));
    let (length, force) = (format_quantity(length, "m"), format_quantity(force, "N"));
    let number = number + 1;
    let first = format!("○ patch {number} of {patches}: {springs} spring{plural}, δx {length}, F {force}");
    let (largest, stretch) = (state.largest_stretch, state.most_stretched.max(0.0));
    let is_at_limit = stretch > 0.0 && largest - stretch <= ROUNDING * largest;
    let limit = if is_at_limit { " (at its limit)" } else { "" };
    let [stretch, largest] = [stretch, largest].map(|value| format_quantity(value, "m"));
    [first, format!("  edge stretch {stretch} of at most {largest}{limit}")]
}
