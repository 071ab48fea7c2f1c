//! The list of parameters and what the selected one means.

use super::typed::typed;
use super::wrap::wrapped;
use crate::explorer::model::{Mode, Model};
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::theme::Meaning;
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Columns for a typed value beside its name.
const TYPED_COLUMNS: usize = 12;

/// Where the list, the derived values and the explanation go, and the first row of the list that shows.
struct Places {
    list: Rect,
    derived: Rect,
    help: Rect,
    first: usize,
}

impl Places {
    fn within(area: Rect, model: &Model) -> Self {
        let help_rows = if area.height >= 9 { 3 } else { u16::from(area.height >= 3) };
        let derived_rows = if area.height >= 12 { derived(model).len() as u16 } else { 0 };
        let list = Rect { height: area.height - help_rows - derived_rows, ..area };
        let first = (model.selected + 1).saturating_sub(usize::from(list.height));
        let derived = Rect { y: list.bottom(), height: derived_rows, ..area };
        Places { list, derived, help: Rect { y: derived.bottom(), height: help_rows, ..area }, first }
    }
}

/// The parameter in a row of the screen.
pub fn parameter_at(model: &Model, area: Rect, row: u16) -> Option<usize> {
    let Places { list, first, .. } = Places::within(area, model);
    let below = row.checked_sub(list.y).filter(|below| *below < list.height)?;
    Some(first + usize::from(below)).filter(|index| *index < model.parameters.len())
}

/// Draws the list, scrolled so that the selected row shows, derived values, and a line or two of
/// explanation below.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let Places { list, derived: below, help, first } = Places::within(area, model);
    for (row, index) in (list.y..list.bottom()).zip(first..model.parameters.len()) {
        let line = parameter_line(model, index, usize::from(list.width));
        frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..list });
    }
    for (row, (name, value)) in (below.y..below.bottom()).zip(derived(model)) {
        let gap = usize::from(area.width).saturating_sub(4 + name.chars().count() + value.chars().count());
        let text = format!("  {name}{}= {value}", " ".repeat(gap));
        let line = Line::styled(text, model.appearance.theme.style(Meaning::Quiet));
        frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..area });
    }
    frame.render_widget(Paragraph::new(wrapped(&explanation(model), help.width)), help);
}

fn parameter_line(model: &Model, index: usize, width: usize) -> Line<'static> {
    let theme = model.appearance.theme;
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
    // Groups and choices stand out, what belongs to them is set in; an effect says whether it is on.
    let is_head = parameter.field.parent().is_empty() && parameter.leg.is_none();
    let lead = match parameter.effect.filter(|_| is_head) {
        Some(effect) if effect.is_on(model.document.scene()) => "●",
        Some(_) => "○",
        None => " ",
    };
    let name = format!("{mark}{lead}{}{symbol}", parameter.name());
    if let (true, Mode::Edit(line)) = (selected, &model.mode) {
        let short = if parameter.field.symbol.is_empty() { "" } else { parameter.field.symbol };
        let columns = |text: &str| Span::raw(text.to_owned()).width();
        let labels = [format!("{name}: "), format!("{mark} {short}: "), format!("{mark} ")];
        let fits = |label: &&String| columns(label) + TYPED_COLUMNS.max(columns(&line.text()) + 1) <= width;
        let label = Span::raw(labels.iter().find(fits).unwrap_or(&labels[2]).clone());
        let room = width.saturating_sub(label.width());
        return Line::from_iter([label].into_iter().chain(typed(line, room, theme)));
    }
    let value = value(model, parameter);
    let room = width.saturating_sub(name.chars().count() + 1);
    let value: String = if value.chars().count() > room {
        value.chars().take(room.saturating_sub(1)).chain(['…']).collect()
    } else {
        value
    };
    let gap = width.saturating_sub(name.chars().count() + value.chars().count());
    let text = format!("{name}{}{value}", " ".repeat(gap));
    let style = match (refused, selected) {
        (true, _) => theme.style(Meaning::Error),
        (false, true) => theme.style(Meaning::Selected),
        (false, false) => theme.style(Meaning::Text),
    };
    Line::styled(text, style)
}

/// A value as people read it; one that follows from others is marked.
fn value(model: &Model, parameter: &Parameter) -> String {
    if !parameter.shown.is_empty() {
        return parameter.shown.clone();
    }
    let written = model.written(parameter).and_then(|written| written.parse::<f64>().ok());
    match written {
        Some(value) => format!("= {}", quantity(value, parameter.field.unit)),
        // A smooth body has no κ; of a scene that is not computed yet it is not known.
        None if model.governing().is_some() => "none".to_owned(),
        None => "= …".to_owned(),
    }
}

fn quantity(value: f64, unit: &str) -> String {
    format_quantity(format!("{value:.3e}").parse().unwrap_or(value), unit)
}

/// What follows from the parameters.
fn derived(model: &Model) -> Vec<(&'static str, String)> {
    let Some(computed) = &model.computed else { return Vec::new() };
    let outcome = &computed.outcome;
    let governing = model.governing().unwrap_or(outcome.governing);
    let mut rows = vec![("E*", quantity(governing.effective_modulus, "Pa"))];
    if let Some(amplitude) = governing.amplitude {
        let gradient = quantity(amplitude.rms_gradient, "1");
        rows.push(("h, ⟨∇z⟩", format!("{}, {gradient}", quantity(amplitude.rms_height, "m"))));
    }
    // Of a scene that failed nothing more is known.
    if !model.is_current() && !model.is_computing() {
        return rows;
    }
    if let Some(force) = outcome.ideal_adhesion_force {
        rows.push(("F_a,max", quantity(force, "N")));
    }
    if let Some(regime) = outcome.regime {
        rows.push(("regime", regime.name().to_owned()));
    }
    rows
}

/// What is wrong with the selected value, or what it means and what is allowed.
fn explanation(model: &Model) -> Line<'static> {
    if let Some((_, error)) = &model.refused {
        return Line::styled(format!("! {error}"), model.appearance.theme.style(Meaning::Error));
    }
    let Some(parameter) = model.parameter() else { return Line::default() };
    let text = match parameter.setting {
        Setting::Switch(effect) => format!("{}: observed or not; t switches it", effect.name()),
        _ => format!("{}. Allowed: {}", parameter.field.meaning, parameter.field.allowed()),
    };
    Line::styled(text, model.appearance.theme.style(Meaning::Quiet))
}
