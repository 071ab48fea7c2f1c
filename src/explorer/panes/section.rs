//! Part of the profile with its axes: rigid profile, elastic surface and contact, for the profile
//! pane and the close-up.

use super::row::{Exported, OPEN_COMMAND};
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::text::Part;
use crate::explorer::theme::{Appearance, Meaning};
use asperity_data::format_quantity;
use asperity_plot::{Chart, Figure, Ink, Layer, Shape, Span, Stroke, value_label};
use asperity_report::{Part as LinePart, Report, Section};
use asperity_scene::stages::LineFacts;
use ratatui::text::Span as Text;

/// Panel of a section over the position; `z` is the range of heights, m. Beside its title are the
/// readings of the crosshair.
pub fn panel(
    title: &str,
    snapshot: &ContactSnapshot,
    section: &Section,
    z: Span,
    (look, width): (Appearance, u16),
) -> Panel {
    let mut chart = section.chart(snapshot.line, z).with_symbols();
    // Without colours the stroke separates the surface from the profile.
    if let Some(surface) = chart.layers.first_mut() {
        surface.shape = Shape::line(surface.shape.points(), Stroke::Dotted);
    }
    if let Some(probe) = snapshot.probe {
        let lines = [
            Shape::Upright(position(snapshot.line, probe.spring)),
            Shape::Level(probe.height),
        ];
        // Below the curves, which remain complete.
        chart
            .layers
            .splice(0..0, lines.map(|line| Layer::unnamed(Ink::Cursor, line)));
    }
    let title = format!("{title} {}", chart.y.symbol_with_unit());
    let mut panel = Panel::of_chart(title, chart);
    if snapshot.probe.is_some() {
        panel.show(reading(snapshot, look), width);
    }
    panel
}

/// Chart of the springs of a section for a file, with the range of heights `z` (m); it does not
/// depend on the size of the pane.
pub fn of_springs(
    snapshot: &ContactSnapshot,
    section: &Section,
    z: Span,
    part: fn(usize, usize) -> LinePart,
) -> Option<Chart> {
    Some(
        snapshot
            .section(part(section.first, section.springs))?
            .chart(snapshot.line, z),
    )
}

/// Figure of a chart of springs, with indentation and force.
pub fn figure(app: &App, snapshot: &ContactSnapshot, chart: Chart) -> Figure {
    let point = &snapshot.point;
    let force = value_label("", "F", "N", app.without_rounding(point.force)).then(", ");
    let notes = vec![force.join(&value_label("", "d", "m", point.indentation))];
    Figure {
        notes,
        size: Figure::LOW,
        ..Figure::of_chart(app.edit.document.title(), chart)
    }
}

/// Table of the curves in a chart of springs; `None` while the scene is not computed.
pub fn table(app: &App, chart: Chart) -> Exported<'static> {
    app.is_current().then(|| {
        (
            OPEN_COMMAND.into(),
            Box::new(Figure::of_chart("", chart)) as Box<dyn Report>,
        )
    })
}

/// Range of heights, m: the profile, and over the whole loop the surface, unless it is far above.
pub fn heights(app: &App, snapshot: &ContactSnapshot) -> Span {
    let (low, high) = snapshot.profile.heights;
    let far = high + 0.5 * (high - low);
    let now = snapshot.point.indentation;
    let indentations = app
        .indentations()
        .map_or([now; 2], |(low, high)| [low, high]);
    let level = |indentation: f64| (snapshot.profile.level + now - indentation).min(far);
    let ends = [
        low,
        high,
        level(now),
        level(indentations[0]),
        level(indentations[1]),
    ];
    Span::around(ends.into_iter(), 0.05)
}

/// Position of the middle of a spring, m.
pub fn position(line: LineFacts, spring: usize) -> f64 {
    (line.first + spring) as f64 * line.spacing + 0.5 * line.spacing
}

/// Readings of the crosshair: position, height, and gap or stretch of the spring.
fn reading(snapshot: &ContactSnapshot, look: Appearance) -> Vec<Part> {
    let Some(probe) = snapshot.probe else {
        return Vec::new();
    };
    let length = |value: f64| format_quantity(value, "m");
    let part = |text: String| vec![Text::styled(text, look.theme.style(Meaning::Cursor))];
    let distance = probe.level - probe.height;
    let state = match probe.patch {
        None => format!("gap {}", length(distance)),
        Some(_) if distance > 0.0 => format!("stretched {}", length(distance)),
        Some(_) => format!("compressed {}", length(-distance)),
    };
    let patch = probe
        .patch
        .map(|number| format!("patch {} of {}", number + 1, snapshot.point.fragments));
    let at = [
        format!("x {}", length(position(snapshot.line, probe.spring))),
        format!("z {}", length(probe.height)),
    ];
    at.into_iter()
        .chain([state])
        .chain(patch)
        .map(part)
        .collect()
}
