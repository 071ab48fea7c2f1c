//! The list of parameters and the meaning of the selected one.

use super::row::{PaneRow, outcome};
use crate::explorer::app::{App, Message};
use crate::explorer::pane::Pane;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::reading;
use crate::explorer::search::find;
use crate::explorer::text::{filled, fitted, wrapped_within};
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::Meaning;
use crate::explorer::typed;
use asperity_data::{format_quantity, unit_of};
use asperity_scene::Roughness;
use asperity_scene::fields::{Effect, FIELDS, Field, Range};
use ratatui::layout::Size;
use ratatui::text::{Line, Span};

pub static ROW: PaneRow = PaneRow {
    panel,
    report: outcome,
    help: &[(
        "Parameters",
        "fields of the scene in groups; ● effect on, ○ effect off, = computed value",
    )],
    ..PaneRow::EMPTY
};

/// Smallest number of columns for a typed value beside its name.
const TYPED_COLUMNS: usize = 12;
/// Largest number of rows of an explanation, except of a refusal.
const MOST_EXPLAINED: u16 = 6;
/// Smallest number of letters of a shortened name.
const FEWEST_LETTERS: usize = 4;

/// The list of parameters, and below it derived values and some lines of explanation.
fn panel(app: &App, size: Size) -> Panel {
    let quiet = app.view.appearance.theme.style(Meaning::Quiet);
    let (rows, selected) = shown(app);
    let explained = match rows.get(selected) {
        Some(index) => explanation(app, *index),
        None => Line::styled(not_listed(app), quiet),
    };
    let mut foot = if size.height >= 12 {
        derived(app, size.width)
    } else {
        Vec::new()
    };
    let help_rows = if size.height >= 9 {
        3
    } else {
        u16::from(size.height >= 3)
    };
    // Rows that the list does not need are for the explanation.
    let free = usize::from(size.height).saturating_sub(rows.len() + foot.len()) as u16;
    let help_rows = help_rows.max(free.min(MOST_EXPLAINED));
    // The list makes room for the whole reason of a refusal, and for all that was done to a
    // measured curve.
    let is_refused = refusal(app).is_some();
    let is_of_curve = rows
        .get(selected)
        .is_some_and(|index| app.edit.parameters[*index].path == reading::GROUP);
    let help_rows = if is_refused || is_of_curve {
        help_rows.max(size.height / 2)
    } else {
        help_rows
    };
    let mut explained = wrapped_within(&explained, size.width, help_rows);
    // The list keeps its place whatever the explanation.
    if !is_refused {
        let kept = if is_of_curve {
            explained.len().max(3)
        } else {
            help_rows.into()
        };
        explained.resize(kept, Line::default());
    }
    foot.extend(explained);
    let width = usize::from(size.width);
    let lines = rows.iter().enumerate();
    let lines = lines
        .map(|(place, index)| parameter_line(app, *index, place == selected, width))
        .collect();
    let body = Body::Rows {
        rows: lines,
        selected,
    };
    Panel {
        body,
        foot,
        ..Panel::of_text("Parameters".to_owned(), "")
    }
}

/// Indices of the parameters in the list, and the row of the selected one.
fn shown(app: &App) -> (Vec<usize>, usize) {
    if let Some(Prompt {
        purpose: Purpose::Parameter { .. },
        found,
        selected,
        ..
    }) = &app.prompt
    {
        return (found.clone(), *selected);
    }
    ((0..app.edit.parameters.len()).collect(), app.edit.selected)
}

/// What fits the search among the fields of the scene file, which has more of them than the list
/// has rows.
fn not_listed(app: &App) -> String {
    let none = "no parameter of this scene fits".to_owned();
    let typed = app.prompt.as_ref().map_or("", |prompt| prompt.line.text());
    let texts = |field: &Field| {
        vec![
            field.symbol.to_owned(),
            field.path.replace(['.', '_'], " "),
            field.name.to_owned(),
        ]
    };
    let found = find(FIELDS.iter().map(texts), typed)
        .first()
        .map(|index| &FIELDS[*index]);
    found.map_or(none.clone(), |field| {
        format!(
            "{none}; the scene file may have {}: {}",
            field.path, field.meaning
        )
    })
}

fn parameter_line(app: &App, index: usize, selected: bool, width: usize) -> Line<'static> {
    let theme = app.view.appearance.theme;
    let parameter = &app.edit.parameters[index];
    let typed = app
        .prompt
        .as_ref()
        .filter(|_| selected && app.is_typing_value());
    let refused =
        selected && app.is_refused() || typed.is_some_and(|prompt| prompt.refused.is_some());
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
    let value = typed::shown(app, parameter);
    let symbol = parameter.field.symbol;
    let letters = match parameter.field.range {
        // A long text is cut, and not its name.
        Range::Text { .. } => columns(&parameter.name()),
        _ if symbol.is_empty() => FEWEST_LETTERS,
        _ => columns(symbol),
    };
    let least = columns(&lead) + letters + 1;
    let value = cut(&value, width.saturating_sub(least).max(width / 3));
    let room =
        width.saturating_sub(columns(&lead) + usize::from(!value.is_empty()) + columns(&value));
    let name = name_within(parameter, room);
    let gap = width.saturating_sub(columns(&lead) + columns(&name) + columns(&value));
    let style = match (refused, selected) {
        (true, _) => theme.style(Meaning::Error),
        // One pane has the focus: the row that the keys change is marked in the others too, but not
        // as bright.
        (false, true) if has_focus(app) => theme.style(Meaning::Selected),
        (false, true) => theme.style(Meaning::Title),
        (false, false) => theme.style(Meaning::Text),
    };
    Line::styled(format!("{lead}{name}{}{value}", " ".repeat(gap)), style)
}

/// Returns true while the keys of the list act, or a parameter is searched.
fn has_focus(app: &App) -> bool {
    let is_searched = |prompt: &Prompt| matches!(prompt.purpose, Purpose::Parameter { .. });
    app.view.pane == Pane::Parameters || app.prompt.as_ref().is_some_and(is_searched)
}

/// Marks before a name: for the first row of a group, and for an effect that is on or off; other
/// rows are indented.
fn lead(app: &App, parameter: &Parameter) -> String {
    let is_head = parameter.is_head();
    let is_on = |effect: Effect| effect.is_on(app.edit.document.scene());
    let effect = parameter.effect.filter(|_| is_head);
    let mark = effect.map_or(" ", |effect| if is_on(effect) { "●" } else { "○" });
    format!("{}{mark}", if is_head { "─" } else { " " })
}

/// The row of a value being typed: name, symbol and unit of a number as far as there is room, the
/// typed text, and how it will be read.
fn editor(
    app: &App,
    parameter: &Parameter,
    line: &TextLine,
    lead: &str,
    width: usize,
) -> Line<'static> {
    let (name, symbol) = (parameter.name(), parameter.field.symbol);
    let unit = match (parameter.field.unit, unit_of(&typed::shown(app, parameter))) {
        ("" | "1", _) => String::new(),
        (unit, "") | (_, unit) => format!(" ({unit})"),
    };
    let named = if symbol.is_empty() {
        name
    } else {
        format!("{name} {symbol}")
    };
    let mark = lead.chars().next().unwrap_or(' ');
    let labels = [
        format!("{lead}{named}{unit}: "),
        format!("{mark} {symbol}{unit}: "),
        format!("{mark} "),
    ];
    let theme = app.view.appearance.theme;
    let reading = typed::reading(app).map_or_else(String::new, |reading| format!("→ {reading}"));
    let mut reading = Span::styled(reading, theme.style(Meaning::Title));
    let taken = columns(line.text()) + 1 + reading.width();
    let fits = |label: &&String| columns(label) + TYPED_COLUMNS.max(taken) <= width;
    let label = Span::raw(
        labels
            .iter()
            .find(fits)
            .unwrap_or(&labels[labels.len() - 1])
            .clone(),
    );
    if label.width() + taken > width {
        reading.content = "".into();
    }
    let room = width.saturating_sub(label.width() + reading.width());
    Line::from_iter(
        [label]
            .into_iter()
            .chain(line.spans(room, theme))
            .chain([reading]),
    )
}

/// Name and symbol within a number of columns: the name is shortened, or left out if little of it
/// would remain.
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

/// A text within a number of columns; the rest is replaced by `…`.
fn cut(text: &str, room: usize) -> String {
    fitted(Line::raw(text.to_owned()), room as u16).to_string()
}

/// Derived values of the scene, in as many lines as needed.
fn derived(app: &App, width: u16) -> Vec<Line<'static>> {
    let style = app.view.appearance.theme.style(Meaning::Quiet);
    let part =
        |(name, value): (&str, String)| vec![Span::styled(format!("{name} = {value}"), style)];
    filled(
        derived_values(app).into_iter().map(part).collect(),
        "  ",
        usize::from(width),
    )
}

fn derived_values(app: &App) -> Vec<(&'static str, String)> {
    let Some(computed) = &app.solved else {
        return Vec::new();
    };
    let outcome = &computed.outcome;
    let governing = app.governing().unwrap_or(outcome.governing);
    let mut values = vec![("E*", format_quantity(governing.effective_modulus, "Pa"))];
    // The amplitude of random roughness has rows of its own.
    let is_measured = matches!(
        app.edit.document.scene().roughness,
        Some(Roughness::Measured(_))
    );
    if let Some(amplitude) = governing.amplitude.filter(|_| is_measured) {
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
    values
}

/// Reason why the typed value is refused, if it is.
fn refusal(app: &App) -> Option<&String> {
    match &app.message {
        Some(Message::Refused(why)) => Some(why),
        _ => app
            .prompt
            .as_ref()
            .filter(|_| app.is_typing_value())?
            .refused
            .as_ref(),
    }
}

/// Explanation of the selected parameter: why its value is refused, or its meaning and allowed
/// range.
fn explanation(app: &App, index: usize) -> Line<'static> {
    if let Some(error) = refusal(app) {
        return Line::styled(
            format!("! {error}"),
            app.view.appearance.theme.style(Meaning::Error),
        );
    }
    let Some(parameter) = app.edit.parameters.get(index) else {
        return Line::default();
    };
    let text = match parameter.setting {
        _ if parameter.path == "loading" => format!(
            "{}: 10 µN, 3 loops 0 N to 10 µN, separation; a number without a unit is a force in N",
            parameter.field.meaning
        ),
        Setting::Heading if parameter.path == reading::GROUP => statements(app),
        Setting::Heading => parameter.field.meaning.to_owned(),
        Setting::Reading(index) => reading::OPTIONS[index].explanation(),
        _ => format!(
            "{}. Allowed: {}",
            parameter.field.meaning,
            parameter.field.allowed()
        ),
    };
    Line::styled(text, app.view.appearance.theme.style(Meaning::Quiet))
}

/// What was done to the measured curve when it was read.
fn statements(app: &App) -> String {
    app.edit
        .measured
        .as_ref()
        .map_or_else(String::new, |measured| measured.curve.statements.join(" "))
}
