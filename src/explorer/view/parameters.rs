//! The list of parameters and what the selected one means.

use super::typed::typed;
use super::wrap::wrapped;
use crate::explorer::model::{Mode, Model};
use crate::explorer::theme::Meaning;
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Draws the list, scrolled so that the selected row shows, derived values, and a line or two of
/// explanation below.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let help_rows = if area.height >= 9 { 3 } else { u16::from(area.height >= 3) };
    let derived = derived(model);
    let derived_rows = if area.height >= 12 { derived.len() as u16 } else { 0 };
    let list = Rect { height: area.height - help_rows - derived_rows, ..area };
    let visible = usize::from(list.height);
    let first = (model.selected + 1).saturating_sub(visible);
    for (row, index) in (list.y..list.bottom()).zip(first..model.parameters.len()) {
        let line = parameter_line(model, index, usize::from(list.width));
        frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..list });
    }
    let rows = list.bottom()..area.bottom() - help_rows;
    for (row, (name, value)) in rows.zip(derived.into_iter().take(usize::from(derived_rows))) {
        let gap = usize::from(area.width).saturating_sub(4 + name.chars().count() + value.chars().count());
        let text = format!("  {name}{}= {value}", " ".repeat(gap));
        let line = Line::styled(text, model.theme.style(Meaning::Quiet));
        frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..area });
    }
    let help = Rect { y: area.bottom() - help_rows, height: help_rows, ..area };
    frame.render_widget(Paragraph::new(wrapped(&explanation(model), help.width)), help);
}

fn parameter_line(model: &Model, index: usize, width: usize) -> Line<'static> {
    let parameter = &model.parameters[index];
    let selected = index == model.selected;
    let refused = model.refused.as_ref().is_some_and(|(row, _)| *row == index);
    let mark = match (refused, selected) {
        (true, _) => "!",
        (false, true) => "›",
        (false, false) => " ",
    };
    let symbol = if parameter.field.symbol.is_empty() {
        String::new()
    } else {
        format!(" {}", parameter.field.symbol)
    };
    // Groups and choices stand out, what belongs to them is set in.
    let indent = if parameter.field.parent().is_empty() && parameter.leg.is_none() { "" } else { " " };
    let name = format!("{mark} {indent}{}{symbol}", parameter.name());
    if let (true, Mode::Edit(line)) = (selected, &model.mode) {
        let mark = Span::raw(format!("{mark} "));
        let room = width.saturating_sub(mark.width());
        return Line::from_iter([mark].into_iter().chain(typed(line, room, model.theme)));
    }
    let value = &parameter.shown;
    let room = width.saturating_sub(name.chars().count() + 1);
    let value: String = if value.chars().count() > room {
        value.chars().take(room.saturating_sub(1)).chain(['…']).collect()
    } else {
        value.clone()
    };
    let gap = width.saturating_sub(name.chars().count() + value.chars().count());
    let text = format!("{name}{}{value}", " ".repeat(gap));
    let style = match (refused, selected) {
        (true, _) => model.theme.style(Meaning::Error),
        (false, true) => model.theme.style(Meaning::Selected),
        (false, false) => model.theme.style(Meaning::Text),
    };
    Line::styled(text, style)
}

/// What follows from the parameters.
fn derived(model: &Model) -> Vec<(&'static str, String)> {
    let Some(computed) = &model.computed else { return Vec::new() };
    let outcome = &computed.outcome;
    let governing = &outcome.governing;
    let mut rows = Vec::new();
    if let Some(kappa) = governing.kappa {
        rows.push(("κ", format_quantity(kappa, "1")));
    }
    if let Some(work) = governing.work_of_adhesion {
        rows.push(("γ", format_quantity(work, "J/m²")));
    }
    if let Some(amplitude) = governing.amplitude {
        let gradient = format_quantity(amplitude.rms_gradient, "1");
        rows.push(("h, ⟨∇z⟩", format!("{}, {gradient}", format_quantity(amplitude.rms_height, "m"))));
    }
    if let Some(force) = outcome.ideal_adhesion_force {
        rows.push(("F_a,max", format_quantity(force, "N")));
    }
    rows
}

/// What is wrong with the selected value, or what it means and what is allowed.
fn explanation(model: &Model) -> Line<'static> {
    if let Some((_, error)) = &model.refused {
        return Line::styled(format!("! {error}"), model.theme.style(Meaning::Error));
    }
    let Some(parameter) = model.parameter() else { return Line::default() };
    let text = format!("{}. Allowed: {}", parameter.field.meaning, parameter.field.allowed());
    Line::styled(text, model.theme.style(Meaning::Quiet))
}
