//! The profile: the rigid line, the elastic surface above it, and where they touch.

use super::{histogram, section};
use crate::draw::Span;
use crate::explorer::layout::{inside, split_profile};
use crate::explorer::model::Model;
use crate::explorer::snapshot::Section;
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Title of the pane.
pub fn title(model: &Model) -> String {
    let length = format_quantity(model.document.scene().length, "m");
    let follows = if model.profile.follow { " · follows" } else { "" };
    let Some(moment) = model.moment.as_ref() else { return format!(" Profile z(x), x to {length} ") };
    let shown = &moment.profile;
    if model.profile.share >= 1.0 {
        return format!(" Profile z(x), x to {length}{follows} ");
    }
    let from = (moment.line.first + shown.first) as f64 * moment.line.spacing;
    let to = from + shown.springs as f64 * moment.line.spacing;
    let [from, to] = [from, to].map(|x| format_quantity(short(x), "m"));
    format!(" Profile z(x), x from {from} to {to} of {length}{follows} ")
}

/// Names of what is drawn, for the lower edge of the frame.
pub fn names(model: &Model, area: Rect) -> Option<Line<'static>> {
    let moment = model.moment.as_ref()?;
    let chart = section::chart(&moment.profile, moment.line, heights(&moment.profile));
    let theme = model.appearance.theme;
    let bell = || vec![Text::styled("¦", theme.style(Meaning::Surface)), Text::raw(" normal")];
    let beside = split_profile(inside(area)).1.map(|_| bell());
    Some(section::names(&chart, beside, model.appearance, area.width))
}

/// To four digits: enough to find the place again.
pub fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Share of the shown part of the profile under a column of the pane.
pub fn share_at(model: &Model, area: Rect, column: u16) -> Option<f64> {
    let moment = model.moment.as_ref()?;
    let chart = section::chart(&moment.profile, moment.line, heights(&moment.profile));
    Some(section::share_at(plot_area(split_profile(area).0), &chart, column))
}

/// Area of the plot, above the strip.
fn plot_area(area: Rect) -> Rect {
    Rect { height: area.height - u16::from(area.height >= 5), ..area }
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
    let shown = &moment.profile;
    let z = heights(shown);
    let chart = section::chart(shown, moment.line, z);
    let place = section::draw(frame, plot_area(area), &chart, model.appearance);
    let plot = place.plot;
    if strip_rows > 0 {
        let row = Rect { x: plot.x, width: plot.width, y: area.bottom() - 1, height: 1 };
        contact_strip(frame, row, shown, theme);
    }
    if let (Some(beside), Some(computed)) = (beside, &model.computed) {
        let beside = Rect { y: plot.y, height: plot.height, ..beside };
        histogram::draw(frame, beside, place.numbers(), computed.outcome.histogram.as_ref(), z, theme);
    }
}

/// The axis of heights: the whole line and the surface, though not where it is far away.
fn heights(section: &Section) -> Span {
    let (low, high) = section.heights;
    let far = high + 0.5 * (high - low);
    Span::around([low, high, section.level.min(far)].into_iter(), 0.05)
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
