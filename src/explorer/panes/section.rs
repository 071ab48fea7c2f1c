//! Part of the profile with its axes: rigid profile, elastic surface and contact, for the profile
//! pane and the close-up.

use super::row::{Exported, OPEN_COMMAND};
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::{ContactSnapshot, Probe};
use crate::explorer::text::Part;
use crate::explorer::theme::{Appearance, Meaning};
use asperity_data::format_quantity;
use asperity_plot::{Chart, Figure, Ink, Layer, Shape, Span, Stroke, value_label};
use asperity_report::{Part as LinePart, Report, Section};
use asperity_scene::stages::LineFacts;
use ratatui::text::Span as Text;

/// Panel of a section over the position, in a pane of this width; `z` is the range of heights, m.
/// Beside its title are the readings of the crosshair.
pub fn panel(
    title: &str,
    snapshot: &ContactSnapshot,
    section: &Section,
    z: Span,
    look: Appearance,
    width: u16,
) -> Panel {
    let mut chart = section.chart(snapshot.line, z).with_symbols();
    // Without colours the stroke separates the surface from the profile.
    if let Some(surface) = chart.layers.first_mut() {
        surface.shape = Shape::line(surface.shape.points(), Stroke::Dotted);
    }
    if let Some(probe) = snapshot.probe {
        // The lines are drawn first, so that no curve is interrupted.
        let upright = Shape::Upright(position(snapshot.line, probe.spring));
        let level = Shape::Level(probe.height);
        let lines = [upright, level].map(|line| Layer::unnamed(Ink::Cursor, line));
        chart.layers.splice(0..0, lines);
    }
    let title = format!("{title} {}", chart.y.symbol_with_unit());
    let mut panel = Panel::of_chart(title, chart);
    if let Some(probe) = snapshot.probe {
        let style = look.theme.style(Meaning::Cursor);
        let mut parts: Vec<Part> = Vec::new();
        for text in at_crosshair(snapshot, probe) {
            parts.push(vec![Text::styled(text, style)]);
        }
        panel.show(parts, width);
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
    let part = part(section.first, section.springs);
    let whole = snapshot.section(part)?;
    Some(whole.chart(snapshot.line, z))
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
    if !app.is_current() {
        return None;
    }
    let figure: Box<dyn Report> = Box::new(Figure::of_chart("", chart));
    Some((OPEN_COMMAND.into(), figure))
}

/// Range of heights, m: the profile, and over the whole loop the surface, unless it is far above.
pub fn heights(app: &App, snapshot: &ContactSnapshot) -> Span {
    let (low, high) = snapshot.profile.heights;
    let far = high + 0.5 * (high - low);
    let present = snapshot.point.indentation;
    let (least, most) = app.indentations().unwrap_or((present, present));
    let mut ends = vec![low, high];
    for indentation in [present, least, most] {
        let level = snapshot.profile.level + present - indentation;
        ends.push(level.min(far));
    }
    Span::around(ends.into_iter(), 0.05)
}

/// Position of the middle of a spring, m.
pub fn position(line: LineFacts, spring: usize) -> f64 {
    (line.first + spring) as f64 * line.spacing + 0.5 * line.spacing
}

/// Values at the crosshair: position, height, and gap or stretch of the spring.
fn at_crosshair(snapshot: &ContactSnapshot, probe: Probe) -> Vec<String> {
    let x = format_quantity(position(snapshot.line, probe.spring), "m");
    let z = format_quantity(probe.height, "m");
    let mut texts = vec![format!("x {x}"), format!("z {z}")];
    let distance = probe.level - probe.height;
    let Some(patch) = probe.patch else {
        texts.push(format!("gap {}", format_quantity(distance, "m")));
        return texts;
    };
    texts.push(if distance > 0.0 {
        format!("stretched {}", format_quantity(distance, "m"))
    } else {
        format!("compressed {}", format_quantity(-distance, "m"))
    });
    let patches = snapshot.point.fragments;
    texts.push(format!("patch {} of {patches}", patch + 1));
    texts
}
