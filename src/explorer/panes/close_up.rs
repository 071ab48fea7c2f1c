//! The close-up of a contact patch. White circles mark the ends of the patches, as in the paper.

use super::row::PaneRow;
use super::section;
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::{ContactSnapshot, PatchFacts};
use asperity_data::{counted, format_rounded};
use asperity_plot::{Chart, Ink, Label, Layer, Shape, Sign, Span};
use asperity_report::{Part as LinePart, Section};
use ratatui::layout::Size;
use ratatui::text::Span as Text;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| {
        let chart = of_springs(app, LinePart::drawn)?;
        Some(section::figure(app, app.snapshot.as_deref()?, chart))
    },
    report: |app| section::table(app, of_springs(app, LinePart::listed)?),
    help: &[(
        "Patch",
        "close-up of one patch; ○ marks its ends. The title has its length ℓ, its force and its largest stretch",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, size: Size) -> Panel {
    let Some(snapshot) = app.snapshot.as_deref() else {
        return Panel::of_text("Contact patch".to_owned(), "");
    };
    let section = &snapshot.close_up.section;
    let patches = snapshot.point.patches;
    let title = match snapshot.close_up.patch {
        Some(patch) => format!("Patch {} of {patches} ·", patch.number + 1),
        None => "Nothing in contact ·".to_owned(),
    };
    let mut panel = section::panel(
        &title,
        snapshot,
        section,
        heights(section),
        app.view.appearance,
        size.width,
    );
    if let Some(patch) = snapshot.close_up.patch
        && snapshot.probe.is_none()
    {
        panel
            .edge
            .extend(describe(app, patch).map(|text| vec![Text::raw(text)]));
    }
    if let Body::Chart(plot) = &mut panel.body {
        plot.chart.layers.push(Layer {
            name: Label::default(),
            ..ends(snapshot)
        });
    }
    panel
}

/// Returns the markers at the ends of the contact patches.
fn ends(snapshot: &ContactSnapshot) -> Layer {
    let mut points = Vec::new();
    for (spring, height) in &snapshot.close_up.boundaries {
        points.push((section::position(snapshot.line, *spring), *height));
    }
    let signs = Shape::signs(points, Sign::Ring);
    Layer::new("patch end".into(), Ink::Text, signs)
}

/// Returns the chart of the springs in the close-up, for an exported file.
fn of_springs(app: &App, part: fn(usize, usize) -> LinePart) -> Option<Chart> {
    let snapshot = app.snapshot.as_deref()?;
    let section = &snapshot.close_up.section;
    let mut chart = section::of_springs(snapshot, section, heights(section), part)?;
    chart.layers.push(ends(snapshot));
    Some(chart)
}

/// Returns the range of heights on the vertical axis. It contains the profile, and also the elastic
/// surface unless the surface is far above or below the profile.
fn heights(section: &Section) -> Span {
    let (low, high) = section.heights;
    let room = 0.4 * (high - low);
    let level = section.level.clamp(low - room, high + room);
    Span::around([low, high, level].into_iter(), 0.05)
}

/// Two stretches count as equal if their relative difference is below this number.
const ROUNDING: f64 = 1e-13;

/// Returns texts that describe a contact patch: its length, its force, the stretch of its most
/// stretched spring, and its number of springs.
fn describe(app: &App, facts: PatchFacts) -> [String; 4] {
    let state = facts.state;
    let limit = state.largest_stretch;
    let stretch = state.most_stretched.max(0.0);
    let is_at_limit = stretch > 0.0 && limit - stretch <= ROUNDING * limit;
    let limit = format_rounded(limit, 3, "m");
    let stretch = if is_at_limit {
        format!("stretch {limit}, its limit")
    } else {
        format!("stretch {} of {limit}", format_rounded(stretch, 3, "m"))
    };
    [
        format!("δx {}", format_rounded(state.length, 3, "m")),
        app.force_in_words(app.without_rounding(state.force)),
        stretch,
        counted(facts.patch.springs().len() as u64, "spring"),
    ]
}
