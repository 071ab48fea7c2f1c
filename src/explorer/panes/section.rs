//! Part of the profile on its axes: rigid profile, elastic surface and contact, for profile and close-up.

use crate::draw::{Chart, Figure, Ink, Layer, Shape, Span, legend, value_label};
use crate::explorer::snapshot::{ContactSnapshot, Section};
use crate::explorer::theme::{Appearance, Meaning, Theme};
use crate::explorer::view::plot;
use crate::scene::format_quantity;
use crate::simulation::LineFacts;
use ratatui::text::{Line, Span as Text};

/// Chart of a section over the position on the screen; heights within `z`.
pub fn chart(section: &Section, line: LineFacts, z: Span) -> Chart {
    section.chart(line, z).with_symbols()
}

/// Figure of a section with its indentation and force, heights within `z`.
pub fn figure(title: &str, section: &Section, snapshot: &ContactSnapshot, z: Span) -> Figure {
    let mut chart = section.chart(snapshot.line, z);
    add_crosshair(&mut chart, snapshot);
    let point = &snapshot.point;
    let force = value_label("", "F", "N", point.force).then(", ");
    let notes = vec![force.join(&value_label("", "d", "m", point.indentation))];
    Figure { notes, size: Figure::LOW, ..Figure::of_chart(title, chart) }
}

/// Position of the middle of a spring, m.
pub fn position(line: LineFacts, spring: usize) -> f64 {
    (line.first + spring) as f64 * line.spacing + 0.5 * line.spacing
}

/// Adds the crosshair to the chart of a section.
pub fn add_crosshair(chart: &mut Chart, snapshot: &ContactSnapshot) {
    let Some(probe) = snapshot.probe else { return };
    let lines = [Shape::Upright(position(snapshot.line, probe.spring)), Shape::Level(probe.height)];
    // Below the curves, which stay whole.
    chart.layers.splice(0..0, lines.map(|line| Layer::unnamed(Ink::Cursor, line)));
}

/// Readings of the crosshair: position, height, and the gap or the stretch of the spring.
fn reading(snapshot: &ContactSnapshot, theme: Theme) -> Vec<Vec<Text<'static>>> {
    let Some(probe) = snapshot.probe else { return Vec::new() };
    let length = |value: f64| format_quantity(value, "m");
    let part = |text: String| vec![Text::styled(text, theme.style(Meaning::Cursor))];
    let distance = probe.level - probe.height;
    let state = match probe.patch {
        None => format!("gap {}", length(distance)),
        Some(_) if distance > 0.0 => format!("stretched {}", length(distance)),
        Some(_) => format!("compressed {}", length(-distance)),
    };
    let patch = probe.patch.map(|number| format!("patch {} of {}", number + 1, snapshot.point.fragments));
    let at = [
        format!("x {}", length(position(snapshot.line, probe.spring))),
        format!("z {}", length(probe.height)),
    ];
    at.into_iter().chain([state]).chain(patch).map(part).collect()
}

/// Readings of the crosshair, or label of the heights, names of the lines and further signs, as far as there is room
/// on the frame.
pub fn names(
    snapshot: &ContactSnapshot,
    chart: &Chart,
    more: impl IntoIterator<Item = Vec<Text<'static>>>,
    appearance: Appearance,
    width: u16,
) -> Line<'static> {
    let mut parts = reading(snapshot, appearance.theme);
    if parts.is_empty() {
        let quiet = appearance.theme.style(Meaning::Quiet);
        parts.push(vec![Text::styled(chart.y.label_with_unit().to_string(), quiet)]);
        parts.extend(plot::in_theme(appearance, |style| legend(std::slice::from_ref(chart), style)));
        parts.extend(more);
    }
    plot::on_frame(parts, width)
}
