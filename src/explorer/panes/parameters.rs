//! The list of parameters and the meaning of the selected one.

use super::{PaneRow, Place};
use crate::explorer::app::{App, Mode, Pane};
use crate::explorer::layout::{Layout, inside};
use crate::explorer::mode::ModeKind;
use crate::explorer::parameters::{Parameter, Setting, spelled};
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::search::letters_found;
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::Meaning;
use crate::explorer::update::{Effect, begin, edit};
use crate::explorer::view::lines::marked;
use crate::explorer::view::typed::typed;
use crate::explorer::view::wrap::{clipped, filled, wrapped_within};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Scrollbar, ScrollbarOrientation, ScrollbarState};

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title: |_| " Parameters ".to_owned(),
    place: Place::Own,
    draw,
    keys: Some(ModeKind::Parameters),
    press,
    wheel: |app, _, _, turns| {
        begin(app);
        edit::move_selection(app, -turns)
    },
    help: &[(
        "Parameters",
        "fields of the scene by use, in groups; ● marks an effect that is on, ▸ a folded group, = a derived value",
    )],
    ..PaneRow::EMPTY
};

/// Columns for a typed value beside its name.
const TYPED_COLUMNS: usize = 12;
/// Fewest letters of a shortened name.
const FEWEST_LETTERS: usize = 4;

/// Areas of the list, the derived values and the explanation, and the first visible row of the list.
struct Places {
    list: Rect,
    derived: Rect,
    help: Rect,
    /// Indices of the parameters in the list, and the place of the selected one.
    rows: Vec<usize>,
    selected: usize,
    first: usize,
}

impl Places {
    fn within(area: Rect, app: &App) -> Self {
        let help_rows = if area.height >= 9 { 3 } else { u16::from(area.height >= 3) };
        let derived_rows = if area.height >= 12 { derived(app, area.width).len() as u16 } else { 0 };
        let list = Rect { height: area.height - help_rows - derived_rows, ..area };
        let (rows, selected, first) = match &app.mode {
            Mode::Prompt(Prompt { purpose: Purpose::Parameter { .. }, found, selected, .. }) => {
                (found.clone(), *selected, 0)
            }
            _ => {
                let rows = app.listed();
                let selected = rows.iter().position(|index| *index == app.edit.selected).unwrap_or(0);
                (rows, selected, app.view.first_listed)
            }
        };
        // A row above and one below the selected row are visible, if any.
        let height = usize::from(list.height);
        let margin = usize::from(height >= 5);
        let lowest = (selected + 1 + margin).saturating_sub(height);
        let first =
            first.min(selected.saturating_sub(margin)).max(lowest).min(rows.len().saturating_sub(height));
        let derived = Rect { y: list.bottom(), height: derived_rows, ..area };
        let help = Rect { y: derived.bottom(), height: help_rows, ..area };
        Places { list, derived, help, rows, selected, first }
    }

    /// Returns true if rows are hidden.
    fn is_scrolled(&self) -> bool {
        self.rows.len() > usize::from(self.list.height)
    }
}

/// Place of the first visible row; the list scrolls no further than the selected row needs.
pub fn first_listed(app: &App) -> usize {
    let pane = Layout::of(app).pane(Pane::Parameters);
    pane.map_or(app.view.first_listed, |area| Places::within(inside(area), app).first)
}

/// Selects the parameter under the mouse. A second press on the first row of a group folds the group.
fn press(app: &mut App, area: Rect, here: Position) -> Vec<Effect> {
    if let Some(row) = parameter_at(app, area, here.y) {
        let again = row == app.edit.selected && app.edit.parameters[row].is_head();
        edit::select(app, row);
        if again {
            return edit::toggle_fold(app);
        }
    }
    vec![Effect::Ask]
}

/// The parameter in a row of the screen.
fn parameter_at(app: &App, area: Rect, row: u16) -> Option<usize> {
    let Places { list, first, rows, .. } = Places::within(area, app);
    let below = row.checked_sub(list.y).filter(|below| *below < list.height)?;
    rows.get(first + usize::from(below)).copied()
}

/// Draws the list, scrolled so that the selected row shows, derived values, and a line or two of explanation below. A
/// scroll bar in the last column of the frame indicates hidden rows.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let edge = area.right().saturating_sub(1);
    let area = inside(area);
    let places = Places::within(area, app);
    let Places { mut list, derived: below, help, .. } = places;
    if places.is_scrolled() {
        let bar = Rect { x: edge, width: 1, ..list }.intersection(frame.area());
        list.width = list.width.min(edge.saturating_sub(list.x));
        let mut state =
            ScrollbarState::new(places.rows.len() - usize::from(list.height) + 1).position(places.first);
        state = state.viewport_content_length(usize::from(list.height));
        let style = app.view.appearance.theme.style(Meaning::Quiet);
        let scroll_bar = Scrollbar::new(ScrollbarOrientation::VerticalRight).style(style);
        let scroll_bar =
            scroll_bar.begin_symbol(None).end_symbol(None).track_symbol(Some("│")).thumb_symbol("█");
        frame.render_stateful_widget(scroll_bar, bar, &mut state);
    }
    for (row, place) in (list.y..list.bottom()).zip(places.first..places.rows.len()) {
        let (index, selected) = (places.rows[place], place == places.selected);
        let line = parameter_line(app, index, selected, usize::from(list.width));
        frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..list });
    }
    frame.render_widget(Paragraph::new(derived(app, below.width)), below);
    let explained = match places.rows.get(places.selected) {
        Some(index) => explanation(app, *index),
        None => {
            Line::styled("no parameter of this scene fits", app.view.appearance.theme.style(Meaning::Quiet))
        }
    };
    frame.render_widget(Paragraph::new(wrapped_within(&explained, help)), help);
}

fn parameter_line(app: &App, index: usize, selected: bool, width: usize) -> Line<'static> {
    let theme = app.view.appearance.theme;
    let parameter = &app.edit.parameters[index];
    let typed = app.mode.prompt().filter(|prompt| selected && prompt.purpose == Purpose::Value);
    let refused = app.edit.refused.as_ref().is_some_and(|(row, _)| *row == index)
        || typed.is_some_and(|prompt| prompt.refused.is_some());
    let mark = match (refused, selected) {
        (true, _) => "!",
        (false, true) => "›",
        (false, false) => " ",
    };
    let lead = format!("{mark}{}", lead(app, parameter));
    if let Some(prompt) = typed {
        return editor(app, parameter, &prompt.line, &lead, width);
    }
    // The name makes room for the value, which matters more.
    let value = value(app, parameter);
    let symbol = parameter.field.symbol;
    let least = columns(&lead) + if symbol.is_empty() { FEWEST_LETTERS } else { columns(symbol) } + 1;
    let value = cut(&value, width.saturating_sub(least).max(width / 3));
    let room = width.saturating_sub(columns(&lead) + usize::from(!value.is_empty()) + columns(&value));
    let name = format!("{lead}{}", name_within(parameter, room));
    let gap = width.saturating_sub(columns(&name) + columns(&value));
    let rest = format!("{}{value}", " ".repeat(gap));
    let style = match (refused, selected) {
        (true, _) => theme.style(Meaning::Error),
        (false, true) => theme.style(Meaning::Selected),
        (false, false) => theme.style(Meaning::Text),
    };
    let letters = found_in(app, parameter, &name, lead.chars().count());
    let name = marked(&name, &letters, style, theme);
    Line::from_iter(name.into_iter().chain([Span::styled(rest, style)])).style(style)
}

/// Indices of the characters of the shown name and symbol found by the search; `lead` characters come before.
fn found_in(app: &App, parameter: &Parameter, shown: &str, lead: usize) -> Vec<usize> {
    let Mode::Prompt(Prompt { purpose: Purpose::Parameter { .. }, line, .. }) = &app.mode else {
        return Vec::new();
    };
    let (query, name) = (line.text(), parameter.name());
    // The name may be cut.
    let kept = shown.chars().skip(lead).zip(name.chars()).take_while(|(one, other)| one == other).count();
    let in_name = letters_found(&name, &query).into_iter().filter(|index| *index < kept);
    let mut letters: Vec<usize> = in_name.map(|index| index + lead).collect();
    let symbol = parameter.field.symbol;
    if shown.ends_with(symbol) {
        let (all, end) = (symbol.chars().count(), shown.chars().count());
        // A Greek letter is found by its name as a whole.
        let is_spelled = !letters_found(&spelled(symbol), &query).is_empty();
        let in_symbol = letters_found(symbol, &query);
        let in_symbol = if in_symbol.is_empty() && is_spelled { (0..all).collect() } else { in_symbol };
        letters.extend(in_symbol.into_iter().map(|index| index + end - all));
    }
    letters
}

/// Marks before a name: first row of a group folded or not, effect on or off; other rows are indented.
fn lead(app: &App, parameter: &Parameter) -> &'static str {
    let is_on = parameter.effect.map(|effect| effect.is_on(app.edit.document.scene()));
    match parameter.setting {
        Setting::Switch(_) if is_on == Some(true) => return " ●",
        Setting::Switch(_) => return " ○",
        _ if !parameter.is_head() => return "  ",
        _ => {}
    }
    match (app.edit.folded.contains(parameter.group), is_on) {
        (false, None) => "▾",
        (true, None) => "▸",
        (false, Some(true)) => "▾●",
        (true, Some(true)) => "▸●",
        (false, Some(false)) => "▾○",
        (true, Some(false)) => "▸○",
    }
}

/// The row of a value being typed: its name, symbol and SI unit, as far as there is room, and the typed text.
fn editor(app: &App, parameter: &Parameter, line: &TextLine, lead: &str, width: usize) -> Line<'static> {
    let (name, symbol) = (parameter.name(), parameter.field.symbol);
    let unit = match parameter.field.unit {
        "" | "1" => String::new(),
        unit => format!(" ({unit})"),
    };
    let named = if symbol.is_empty() { name } else { format!("{name} {symbol}") };
    let mark = lead.chars().next().unwrap_or(' ');
    let labels = [
        format!("{lead}{named}{unit}: "),
        format!("{lead}{named}: "),
        format!("{mark} {symbol}{unit}: "),
        format!("{mark} {symbol}: "),
        format!("{mark} "),
    ];
    let fits = |label: &&String| columns(label) + TYPED_COLUMNS.max(columns(&line.text()) + 1) <= width;
    let label = Span::raw(labels.iter().find(fits).unwrap_or(&labels[labels.len() - 1]).clone());
    let room = width.saturating_sub(label.width());
    Line::from_iter([label].into_iter().chain(typed(line, room, app.view.appearance.theme)))
}

/// Name and symbol in so many columns: the name is cut, or left out where little of it would remain.
fn name_within(parameter: &Parameter, room: usize) -> String {
    let (name, symbol) = (parameter.name(), parameter.field.symbol);
    if symbol.is_empty() {
        return cut(&name, room);
    }
    let whole = format!("{name} {symbol}");
    match room.checked_sub(columns(symbol) + 1) {
        _ if columns(&whole) <= room => whole,
        Some(left) if left > FEWEST_LETTERS => format!("{} {symbol}", cut(&name, left)),
        _ => cut(symbol, room),
    }
}

fn columns(text: &str) -> usize {
    Span::raw(text).width()
}

/// A text in so many columns, with `…` in place of the rest.
fn cut(text: &str, room: usize) -> String {
    if columns(text) <= room {
        return text.to_owned();
    }
    clipped(Line::raw(text.to_owned()), room as u16).to_string()
}

/// A value in the format for people; one that follows from others is marked.
fn value(app: &App, parameter: &Parameter) -> String {
    if !parameter.shown.is_empty() || parameter.setting == Setting::Heading {
        return parameter.shown.clone();
    }
    let written = app.written(parameter).and_then(|written| written.parse::<f64>().ok());
    match written {
        Some(value) => format!("= {}", format_quantity(value, parameter.field.unit)),
        // A smooth body has no κ; before the computation κ is unknown.
        None if app.governing().is_some() => "none".to_owned(),
        None => "= …".to_owned(),
    }
}

/// Derived values, in as many lines as needed.
fn derived(app: &App, width: u16) -> Vec<Line<'static>> {
    let style = app.view.appearance.theme.style(Meaning::Quiet);
    let part = |(name, value): (&str, String)| vec![Span::styled(format!("{name} = {value}"), style)];
    filled(derived_values(app).into_iter().map(part).collect(), "  ", usize::from(width))
}

fn derived_values(app: &App) -> Vec<(&'static str, String)> {
    let Some(computed) = &app.solved else { return Vec::new() };
    let outcome = &computed.outcome;
    let governing = app.governing().unwrap_or(outcome.governing);
    let mut values = vec![("E*", format_quantity(governing.effective_modulus, "Pa"))];
    if let Some(amplitude) = governing.amplitude {
        values.push(("h", format_quantity(amplitude.rms_height, "m")));
        values.push(("⟨∇z⟩", format_quantity(amplitude.rms_gradient, "1")));
    }
    // A failed scene has no further values.
    if !app.is_current() && !app.is_computing() {
        return values;
    }
    if let Some(force) = outcome.ideal_adhesion_force {
        values.push(("F_a,max", format_quantity(force, "N")));
    }
    if let Some(regime) = outcome.regime {
        values.push(("regime", regime.name().to_owned()));
    }
    values
}

/// Error of a value, or its meaning and allowed range.
fn explanation(app: &App, index: usize) -> Line<'static> {
    let typed = app.mode.prompt().filter(|prompt| prompt.purpose == Purpose::Value);
    let typed = typed.and_then(|prompt| prompt.refused.as_ref());
    if let Some(error) = typed.or(app.edit.refused.as_ref().map(|(_, error)| error)) {
        return Line::styled(format!("! {error}"), app.view.appearance.theme.style(Meaning::Error));
    }
    let Some(parameter) = app.edit.parameters.get(index) else { return Line::default() };
    let text = match parameter.setting {
        Setting::Switch(effect) => format!("{}: observed or not; t switches it", effect.name()),
        Setting::Heading => format!("{}; Enter folds the group", parameter.field.meaning),
        _ => format!("{}. Allowed: {}", parameter.field.meaning, parameter.field.allowed()),
    };
    Line::styled(text, app.view.appearance.theme.style(Meaning::Quiet))
}
