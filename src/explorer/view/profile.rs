//! The profile: the rigid line, the elastic surface above it, and where they touch.

use super::histogram;
use super::plot;
use crate::draw::{Axis, AxisScale, CellPlot, Chart, Ink, Layer, Shape, Span};
use crate::explorer::layout::split_profile;
use crate::explorer::model::Model;
use crate::explorer::snapshot::{Column, Section};
use crate::explorer::theme::{Appearance, Meaning, Theme};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// Title of the pane.
pub fn title(model: &Model) -> String {
    let length = format_quantity(model.document.scene().length, "m");
    let follows = if model.profile.follow { " · follows" } else { "" };
    match (model.moment.as_ref(), model.computed.as_ref()) {
        (Some(moment), Some(computed)) if model.profile.share < 1.0 => {
            let facts = computed.outcome.line;
            let section = &moment.profile;
            let from = (facts.first + section.first) as f64 * facts.spacing;
            let to = from + section.springs as f64 * facts.spacing;
            let [from, to] = [from, to].map(|x| format_quantity(short(x), "m"));
            format!(" Profile z(x), x from {from} to {to} of {length}{follows} ")
        }
        _ => format!(" Profile z(x), x to {length}{follows} "),
    }
}

/// To four digits: enough to find the place again.
pub fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Draws the profile with the histogram of its heights on the same axis.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let Some(moment) = model.moment.as_ref() else {
        frame.render_widget(Paragraph::new("…").style(theme.style(Meaning::Quiet)), area);
        return;
    };
    let (area, beside) = split_profile(area);
    let strip_rows = u16::from(area.height >= 5);
    let plot = Rect { height: area.height - strip_rows, ..area };
    let section = &moment.profile;
    let z = heights(section);
    draw_section(frame, plot, section, z, model.appearance);
    if strip_rows > 0 {
        let row = Rect { y: area.bottom() - 1, height: 1, ..area };
        contact_strip(frame, row, section, theme);
    }
    if let (Some(beside), Some(computed)) = (beside, &model.computed) {
        let beside = Rect { height: plot.height, ..beside };
        histogram::draw(frame, beside, computed.outcome.histogram.as_ref(), z, theme);
    }
}

/// The axis of heights: the whole line and the surface, though not where it is far away.
fn heights(section: &Section) -> Span {
    let (low, high) = section.heights;
    let far = high + 0.5 * (high - low);
    Span::around([low, high, section.level.min(far)].into_iter(), 0.05)
}

/// Draws rigid line, elastic surface and contact of a section without scales; x counts springs of the section.
/// Heights are drawn on the returned chart.
pub fn draw_section(
    frame: &mut Frame<'_>,
    area: Rect,
    section: &Section,
    z: Span,
    appearance: Appearance,
) -> (CellPlot, Chart) {
    let x = Span { low: 0.0, high: section.springs.max(1) as f64 };
    let layer = |ink, ends: &dyn Fn(&Column) -> Option<(f64, f64)>| {
        let columns = section.columns.iter().map(ends).collect();
        Layer::unnamed(ink, Shape::Envelope { x: (x.low, x.high), columns })
    };
    let layers = vec![
        layer(Ink::Surface, &|column| Some(column.surface)),
        layer(Ink::Profile, &|column| Some(column.line)),
        layer(Ink::Contact, &|column| column.contact),
    ];
    let axis = |span, symbol, unit| Axis::new(AxisScale::Linear, span, "", symbol, unit);
    let chart = plot::chart(axis(x, "", "1"), axis(z, "z", "m"), layers);
    let place = CellPlot::without_scales(area);
    plot::in_theme(appearance, |style| place.draw(frame.buffer_mut(), &chart, style));
    (place, chart)
}

/// One row that shows by its glyphs where along the section there is contact.
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
