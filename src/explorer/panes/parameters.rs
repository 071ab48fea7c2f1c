//! The pane with the list of parameters and the meaning of the selected parameter.

use super::row::{PaneRow, outcome};
use crate::explorer::app::{App, Message};
use crate::explorer::commands::target;
use crate::explorer::curve_options;
use crate::explorer::pane::Pane;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::{Prompt, Purpose, Topic};
use crate::explorer::search::{Search, find};
use crate::explorer::text::{filled, fitted, wrapped_within};
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::Meaning;
use crate::explorer::typed;
use asperity_data::{format_quantity, unit_of};
use asperity_scene::Roughness;
use asperity_scene::fields::{FIELDS, Field, Range};
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

/// Smallest width in columns of the text that the user types, beside its label.
const TYPED_COLUMNS: usize = 12;
/// Smallest height in rows at which the pane shows derived values below the list.
const WITH_DERIVED: u16 = 12;
/// Largest height in rows of an explanation. It does not apply to the reason of a refusal.
const MOST_EXPLAINED: u16 = 6;
/// Smallest number of letters to which a name may be shortened.
const FEWEST_LETTERS: usize = 4;

/// Returns the panel: the list of parameters, and below it derived values and some lines of
/// explanation.
fn panel(app: &App, size: Size) -> Panel {
    let List { rows, selected } = list(app);
    let mut foot = if size.height >= WITH_DERIVED {
        derived(app, size.width)
    } else {
        Vec::new()
    };
    // The explanation gets the rows that the list does not need.
    let taken = rows.len() + foot.len();
    let free = usize::from(size.height).saturating_sub(taken) as u16;
    foot.extend(explanation(app, rows.get(selected).copied(), size, free));
    let mut lines = Vec::new();
    for (place, index) in rows.iter().enumerate() {
        let is_selected = place == selected;
        lines.push(parameter_line(app, *index, is_selected, size.width.into()));
    }
    Panel {
        body: Body::Rows {
            rows: lines,
            selected,
        },
        foot,
        ..Panel::of_text("Parameters".to_owned(), "")
    }
}

/// Returns lines that explain the parameter with this index. `index` is `None` if a search finds no
/// parameter in the list; the lines then name a matching field of the scene file. `free` is the
/// number of rows that the list does not need.
fn explanation(app: &App, index: Option<usize>, size: Size, free: u16) -> Vec<Line<'static>> {
    let usual = match size.height {
        0..3 => 0,
        3..9 => 1,
        _ => 3,
    };
    let usual = usual.max(free.min(MOST_EXPLAINED));
    let text = match index {
        Some(index) => meaning_of_parameter(app, index),
        None => Line::styled(not_listed(app), app.style(Meaning::Quiet)),
    };
    let most = usual.max(size.height / 2);
    if let Some(mut lines) = target::answer_lines(app, size.width, most.into()) {
        lines.truncate(most.into());
        lines.resize(lines.len().max(usual.into()), Line::default());
        return lines;
    }
    // Two texts must not be cut, and may therefore take rows of the list: the reason of a refusal,
    // and the statements on the preparation of a measured curve.
    if refusal(app).is_some() {
        return wrapped_within(&text, size.width, most);
    }
    let parameter = index.and_then(|index| app.edit.searchable().nth(index));
    let is_of_curve = parameter.is_some_and(|parameter| parameter.path == curve_options::GROUP);
    let rows = if is_of_curve { most } else { usual };
    let mut lines = wrapped_within(&text, size.width, rows);
    // A shorter explanation is filled with blank rows, so that the list does not move.
    let kept = if is_of_curve {
        lines.len().max(3)
    } else {
        usual.into()
    };
    lines.resize(kept, Line::default());
    lines
}

/// The parameters in the list.
struct List {
    /// Index of each listed parameter among the parameters that a search can find.
    rows: Vec<usize>,
    /// Index of the selected row.
    selected: usize,
}

/// Returns the parameters in the list: all parameters of the scene or, during a search, only the
/// parameters that match the search.
fn list(app: &App) -> List {
    if let Some(Prompt {
        purpose: Purpose::Parameter { .. },
        found,
        selected,
        ..
    }) = &app.prompt
    {
        return List {
            rows: found.clone(),
            selected: *selected,
        };
    }
    List {
        rows: (0..app.edit.parameters.len()).collect(),
        selected: app.edit.selected,
    }
}

/// Returns a sentence for a search that finds no parameter in the list. The sentence names a
/// matching field of the scene file, if there is one.
fn not_listed(app: &App) -> String {
    let typed = app.prompt.as_ref().map_or("", |prompt| prompt.line.text());
    let none = format!("no row is called {}", typed.trim());
    let fields = find(FIELDS.iter().map(searched_texts), typed);
    if let Some(index) = fields.first() {
        let Field { path, meaning, .. } = &FIELDS[*index];
        return format!("{none}; another scene may have {path}: {meaning}");
    }
    let commands: Vec<Topic> = app.config.bindings.listed().map(Topic::of).collect();
    let texts: Vec<_> = commands.iter().map(Topic::texts).collect();
    match Search::new(&texts, typed).found.first() {
        Some(index) => {
            let Topic { name, text, .. } = &commands[*index];
            format!("{none}; key {name}: {text}")
        }
        None => format!("no row and no command is called {}", typed.trim()),
    }
}

/// Returns the texts of a field in which a search looks for words.
fn searched_texts(field: &Field) -> Vec<String> {
    vec![
        field.symbol.to_owned(),
        field.path.replace(['.', '_'], " "),
        field.name.to_owned(),
        field.words.to_owned(),
    ]
}

fn parameter_line(app: &App, index: usize, is_selected: bool, width: usize) -> Line<'static> {
    let Some(parameter) = app.edit.searchable().nth(index) else {
        return Line::default();
    };
    let typed = match &app.prompt {
        Some(prompt) if is_selected && app.is_typing_value() => Some(prompt),
        _ => None,
    };
    let is_typed_refused = typed.is_some_and(|prompt| prompt.refused.is_some());
    let is_refused = is_typed_refused || is_selected && app.is_refused();
    let mark = if is_refused {
        "!"
    } else if is_selected {
        "›"
    } else {
        " "
    };
    let lead = format!("{mark}{}", lead(app, parameter));
    if let Some(prompt) = typed {
        return editor(app, parameter, &prompt.line, &lead, width);
    }
    let text = row_text(app, parameter, &lead, width);
    let meaning = if is_refused {
        Meaning::Error
    } else if is_selected && has_focus(app) {
        Meaning::Selected
    } else if is_selected {
        // The selected row is also marked if another pane receives the keys, but less brightly.
        Meaning::Title
    } else if parameter.is_head() {
        Meaning::Heading
    } else {
        Meaning::Text
    };
    Line::styled(text, app.style(meaning))
}

/// Returns a row of the list: marks, name and value. If there is not enough room, the name is
/// shortened, because the value is more important.
fn row_text(app: &App, parameter: &Parameter, lead: &str, width: usize) -> String {
    let symbol = parameter.field.symbol;
    let letters = match parameter.field.range {
        // For a long text, the text and not the name is shortened.
        Range::Text { .. } => columns(&parameter.name()),
        _ if symbol.is_empty() => FEWEST_LETTERS,
        _ => columns(symbol),
    };
    let least = columns(lead) + letters + 1;
    let value = typed::shown(app, parameter);
    let value = cut(&value, width.saturating_sub(least).max(width / 3));
    let blank = usize::from(!value.is_empty());
    let room = width.saturating_sub(columns(lead) + blank + columns(&value));
    let name = name_within(parameter, room);
    let taken = columns(lead) + columns(&name) + columns(&value);
    let gap = " ".repeat(width.saturating_sub(taken));
    format!("{lead}{name}{gap}{value}")
}

/// Returns true if the list receives the keys, or if the user searches for a parameter.
fn has_focus(app: &App) -> bool {
    let is_searched = match &app.prompt {
        Some(prompt) => matches!(prompt.purpose, Purpose::Parameter { .. }),
        None => false,
    };
    app.view.pane == Pane::Parameters || is_searched
}

/// Returns the sign before a name. It distinguishes the first row of a group from the other rows,
/// which are indented. For an effect, it shows whether the effect is on or off.
fn lead(app: &App, parameter: &Parameter) -> String {
    if !parameter.is_head() {
        return "  ".to_owned();
    }
    let mark = match parameter.effect {
        Some(effect) if effect.is_on(app.edit.document.scene()) => "●",
        Some(_) => "○",
        None => " ",
    };
    format!("─{mark}")
}

/// Returns the row of a parameter whose value the user is typing: a label as long as possible, the
/// typed text, and the meaning of this text.
fn editor(
    app: &App,
    parameter: &Parameter,
    line: &TextLine,
    lead: &str,
    width: usize,
) -> Line<'static> {
    let meaning = typed::understood(app).map_or_else(String::new, |text| format!("→ {text}"));
    let meaning = Span::styled(meaning, app.style(Meaning::Title));
    let taken = columns(line.text()) + 1 + meaning.width();
    let labels = labels_of_editor(app, parameter, lead);
    let mut fitting = labels.iter();
    let label = fitting.find(|label| columns(label) + TYPED_COLUMNS.max(taken) <= width);
    let label = Span::raw(label.unwrap_or(&labels[labels.len() - 1]).clone());
    let has_meaning = label.width() + taken <= width;
    let meaning = if has_meaning {
        meaning
    } else {
        Span::styled("", app.style(Meaning::Title))
    };
    let room = width.saturating_sub(label.width() + meaning.width());
    let mut spans = vec![label];
    spans.extend(line.spans(room, app.view.appearance));
    spans.push(meaning);
    Line::from(spans)
}

/// Returns labels for the row of the value that the user is typing, the longest first. The longest
/// label consists of the name, the symbol and the unit.
fn labels_of_editor(app: &App, parameter: &Parameter, lead: &str) -> [String; 3] {
    let symbol = parameter.field.symbol;
    let named = if symbol.is_empty() {
        parameter.name()
    } else {
        format!("{} {symbol}", parameter.name())
    };
    let shown = typed::shown(app, parameter);
    let unit = match parameter.field.unit {
        "" | "1" => String::new(),
        // The label shows the unit with the same prefix as the shown value, such as `mJ`.
        usual => match unit_of(&shown) {
            "" => format!(" ({usual})"),
            prefixed => format!(" ({prefixed})"),
        },
    };
    let mark = lead.chars().next().unwrap_or(' ');
    [
        format!("{lead}{named}{unit}: "),
        format!("{mark} {symbol}{unit}: "),
        format!("{mark} "),
    ]
}

/// Returns the name and the symbol of a parameter in at most `room` columns. If necessary, the name
/// is shortened, or left out if too few letters would remain.
fn name_within(parameter: &Parameter, room: usize) -> String {
    let name = parameter.name();
    let symbol = parameter.field.symbol;
    if symbol.is_empty() {
        return cut(&name, room);
    }
    let whole = format!("{name} {symbol}");
    if columns(&whole) <= room {
        return whole;
    }
    let left = room.saturating_sub(columns(symbol) + 1);
    if left > FEWEST_LETTERS {
        format!("{} {symbol}", cut(&name, left))
    } else {
        cut(symbol, room)
    }
}

fn columns(text: &str) -> usize {
    Span::raw(text).width()
}

/// Returns a text in at most `room` columns. If the text is longer, its end is replaced by `…`.
fn cut(text: &str, room: usize) -> String {
    fitted(Line::raw(text.to_owned()), room as u16).to_string()
}

/// Returns the derived values of the scene, in as many lines as needed.
fn derived(app: &App, width: u16) -> Vec<Line<'static>> {
    let mut parts = Vec::new();
    for (name, value) in derived_values(app) {
        let text = format!("{name} = {value}");
        parts.push(vec![Span::styled(text, app.style(Meaning::Quiet))]);
    }
    filled(parts, "  ", width.into())
}

/// Returns the names and the values of quantities that follow from the scene.
fn derived_values(app: &App) -> Vec<(&'static str, String)> {
    let Some(outcome) = app.outcome() else {
        return Vec::new();
    };
    let governing = app.governing().unwrap_or(outcome.governing);
    let mut values = vec![("E*", format_quantity(governing.modulus, "Pa"))];
    // A measured surface has no rows for its amplitude, so the amplitude is shown here. Random
    // roughness has such rows.
    let roughness = &app.edit.document.scene().roughness;
    if let Some(Roughness::Measured(_)) = roughness
        && let Some(amplitude) = governing.amplitude
    {
        values.push(("h", format_quantity(amplitude.rms_height, "m")));
        values.push(("⟨∇z⟩", format_quantity(amplitude.rms_gradient, "1")));
    }
    // If the computation of the scene has failed, further values are unknown.
    let has_failed = !app.is_current() && !app.is_computing();
    if has_failed {
        return values;
    }
    if let Some(force) = outcome.ideal_pull_off_force {
        values.push(("F_a,max", format_quantity(force, "N")));
    }
    values
}

/// Returns the reason why the typed value is refused; `None` if it is not refused.
fn refusal(app: &App) -> Option<&String> {
    if let Some(Message::Refused(why)) = &app.message {
        return Some(why);
    }
    if !app.is_typing_value() {
        return None;
    }
    app.prompt.as_ref()?.refused.as_ref()
}

/// Returns the reason why the value of a parameter is refused. If it is not refused, returns the
/// meaning and the allowed range of the parameter.
fn meaning_of_parameter(app: &App, index: usize) -> Line<'static> {
    if let Some(error) = refusal(app) {
        return Line::styled(format!("! {error}"), app.style(Meaning::Error));
    }
    let Some(parameter) = app.edit.searchable().nth(index) else {
        return Line::default();
    };
    let text = match parameter.setting {
        _ if parameter.path == "loading" => format!(
            "{}: 10 µN, 3 loops 0 N to 10 µN, separation; a number without a unit is a force in N; there is no time, so a pause changes nothing",
            parameter.field.meaning
        ),
        Setting::Heading if parameter.path == curve_options::GROUP => statements(app),
        Setting::Heading => parameter.field.meaning.to_owned(),
        Setting::CurveOption(index) => curve_options::OPTIONS[index].explanation(),
        _ => format!(
            "{}. Allowed: {}",
            parameter.field.meaning,
            parameter.field.allowed()
        ),
    };
    Line::styled(text, app.style(Meaning::Quiet))
}

/// Returns sentences on what the program did to the measured curve when it read the curve.
fn statements(app: &App) -> String {
    match &app.edit.measured {
        Some(measured) => measured.statements(),
        None => String::new(),
    }
}
