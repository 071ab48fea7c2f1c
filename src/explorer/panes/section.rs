//! Chart of a section. A section is a part of the profile, with the rigid profile, the elastic
//! surface and the contact. The profile pane and the close-up both show such a chart.

use super::row::{Exported, OPEN_COMMAND};
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::{ContactSnapshot, Probe};
use crate::explorer::text::Part;
use crate::explorer::theme::{Appearance, Meaning};
use asperity_data::format_quantity;
use asperity_plot::{Chart, Figure, Ink, Label, Layer, Shape, Span, Stroke, value_label};
use asperity_report::{Part as LinePart, Report, Section};
use asperity_scene::workload::LineFacts;
use ratatui::text::Span as Text;

/// Returns the panel of a section, a part of the profile with its contact. `width` is the width of
/// the pane in columns, and `z` is the range of heights in m. The values at the crosshair are
/// written beside the title.
pub fn panel(
    title: &str,
    snapshot: &ContactSnapshot,
    section: &Section,
    z: Span,
    look: Appearance,
    width: u16,
) -> Panel {
    let largest_stress = largest_stress(snapshot, section);
    let mut chart = section
        .chart(snapshot.line, z, largest_stress)
        .with_symbols();
    // The surface is drawn dotted, so that it differs from the profile even without colours.
    for layer in &mut chart.layers {
        if layer.ink == Ink::Surface {
            layer.shape = Shape::line(layer.shape.points(), Stroke::Dotted);
        }
        // The pane names the pressed and the pulled springs beside its title.
        layer.name = Label::default();
    }
    if let Some(probe) = snapshot.probe {
        // The crosshair is the lowest layer. Drawn later, its lines would hide parts of the curves.
        let upright = Shape::Upright(position(snapshot.line, probe.spring));
        let level = Shape::Level(probe.height);
        let lines = [upright, level].map(|line| Layer::unnamed(Ink::Cursor, line));
        chart.layers.splice(0..0, lines);
    }
    let title = format!("{title} {}", chart.y.symbol_with_unit());
    let mut panel = Panel::of_chart(title, chart);
    if let Some(probe) = snapshot.probe {
        let style = look.style(Meaning::Cursor);
        let mut parts: Vec<Part> = Vec::new();
        for text in at_crosshair(snapshot, probe) {
            parts.push(vec![Text::styled(text, style)]);
        }
        panel.show(parts, width);
    }
    panel
}

/// Returns the chart of a section for an exported file. A section is a part of the profile with its
/// contact. The chart does not depend on the size of the pane. `part` chooses the springs, and `z`
/// is the range of heights in m.
pub fn of_springs(
    snapshot: &ContactSnapshot,
    section: &Section,
    z: Span,
    part: fn(usize, usize) -> LinePart,
) -> Option<Chart> {
    let part = part(section.first, section.springs);
    let whole = snapshot.section(part)?;
    // Equal colours mean equal stresses in the figures of the profile and of a patch too.
    let profile = snapshot.section(LinePart::drawn(0, snapshot.line.points))?;
    let largest_stress = profile.largest_stress().unwrap_or(1.0);
    Some(whole.chart(snapshot.line, z, largest_stress))
}

/// Returns the compression or stretch in m that has the colour of the largest stress on the screen.
/// It is that of the visible profile, so that equal colours in all panes mean equal stresses.
pub fn largest_stress(snapshot: &ContactSnapshot, section: &Section) -> f64 {
    let of_profile = snapshot.profile.largest_stress();
    of_profile.or(section.largest_stress()).unwrap_or(1.0)
}

/// Returns a figure with the chart of a section. The note of the figure states the force and the
/// indentation.
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

/// Returns a table of the curves in the chart of a section; `None` until the scene is computed.
pub fn table(app: &App, chart: Chart) -> Exported<'static> {
    if !app.is_current() {
        return None;
    }
    let figure: Box<dyn Report> = Box::new(Figure::of_chart("", chart));
    Some((OPEN_COMMAND.into(), figure))
}

/// Returns the range of heights in m that the vertical axis of a section shows. It contains the
/// profile, and the elastic surface at all indentations of the loop. A surface that is far above
/// the profile is left out. The range exceeds the profile by whole steps, so that a small change of
/// the surface leaves the profile in its place.
pub fn heights(app: &App, snapshot: &ContactSnapshot) -> Span {
    const STEPS: f64 = 8.0;
    let (low, high) = snapshot.profile.heights;
    let step = (high - low) / STEPS;
    let far = high + 0.5 * (high - low);
    let present = snapshot.point.indentation;
    let (least, most) = app.indentations().unwrap_or((present, present));
    let mut ends = vec![low, high];
    for indentation in [present, least, most] {
        let level = snapshot.profile.level + present - indentation;
        let level = level.min(far);
        ends.push(if level > high && step > 0.0 {
            high + ((level - high) / step).ceil() * step
        } else if level < low && step > 0.0 {
            low - ((low - level) / step).ceil() * step
        } else {
            level
        });
    }
    Span::around(ends.into_iter(), 0.05)
}

/// Returns the position of the middle of spring number `spring` along the profile in m.
pub fn position(line: LineFacts, spring: usize) -> f64 {
    (line.first + spring) as f64 * line.spacing + 0.5 * line.spacing
}

/// Returns the values at the crosshair as texts: position, height, and the gap or the stretch of
/// the spring.
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
    let patches = snapshot.point.patches;
    texts.push(format!("patch {} of {patches}", patch + 1));
    texts
}
