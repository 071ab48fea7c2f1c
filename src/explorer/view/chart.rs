//! The map over κ and H: regimes as glyphs and colours, the mark of the scene, and what stands there.

use super::sections;
use super::wrap::{filled, wrapped};
use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE};
use crate::explorer::model::{Charted, Model};
use crate::explorer::theme::{Meaning, Theme};
use crate::export::sheet::grouped;
use crate::phase::{Basis, Cell, HURSTS, KAPPAS, Level, PhaseMap, hurst, kappa};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Columns for the values of H beside the map.
const GUTTER: u16 = 5;
/// Rows of map that make it worth drawing.
const FEWEST_ROWS: u16 = 4;
/// From this height on there is room to say what the regimes are.
const ROOMY: u16 = 24;

/// Title of the pane: of what the map is the mean.
pub fn title(model: &Model) -> String {
    match Basis::of(model.document.scene()) {
        Ok(basis) => {
            let lines = basis.lines();
            let of = if lines == 1 { "1 line".to_owned() } else { format!("{lines} lines") };
            let over = if basis.has_hurst() { "κ, H" } else { "κ" };
            format!(" Map over {over}: {of} of {} springs ", grouped(basis.springs()))
        }
        Err(_) => " Map over κ, H ".to_owned(),
    }
}

/// The map that belongs to the scene as it stands.
fn map(model: &Model) -> Option<&PhaseMap> {
    model.chart.map.as_deref()
}

/// How a regime is drawn: its colour, which every theme tells from the others or leaves to the glyph.
fn meaning(regime: Regime) -> Meaning {
    match regime {
        Regime::PressureInsensitive => Meaning::Surface,
        Regime::PressureSensitive => Meaning::Hand,
        Regime::NonAdhesive => Meaning::Quiet,
    }
}

fn glyph_of(regime: Regime) -> &'static str {
    match regime {
        Regime::PressureInsensitive => "█",
        Regime::PressureSensitive => "▒",
        Regime::NonAdhesive => "·",
    }
}

/// Glyphs of a quantity, and the least value of each; below the last there is a dot.
type Steps = [(&'static str, f64); 3];
const ZERO_LOAD_STEPS: Steps = [("█", 0.5), ("▒", 0.05), ("░", 0.005)];
const COEFFICIENT_STEPS: Steps = [("█", 1.0), ("▒", 0.1), ("░", NEGLIGIBLE_COEFFICIENT)];

fn step(steps: &Steps, value: f64) -> &'static str {
    steps.iter().find(|(_, least)| value >= *least).map_or("·", |(glyph, _)| glyph)
}

fn glyph(cell: &Cell, quantity: Charted) -> &'static str {
    match quantity {
        Charted::Regime => glyph_of(cell.regime),
        Charted::ZeroLoadAdhesion => step(&ZERO_LOAD_STEPS, cell.zero_load_share()),
        Charted::Coefficient => cell.coefficient().map_or("?", |value| step(&COEFFICIENT_STEPS, value)),
    }
}

/// Where everything stands in the pane.
struct Places {
    legend: Vec<Line<'static>>,
    plot: Rect,
    below: Vec<Line<'static>>,
}

fn places(model: &Model, area: Rect) -> Places {
    let mut legend = legend(model, area.width);
    let mut below = below(model, area);
    // The map comes first, then what the mark says, then the legend.
    let room = usize::from(area.height.saturating_sub(FEWEST_ROWS + 1));
    below.truncate(room.min(usize::from(area.height / 3)));
    legend.truncate(room - below.len());
    let gutter = if area.width >= 30 { GUTTER } else { 0 };
    let axis = u16::from(area.height >= 5);
    let taken = (legend.len() + below.len()) as u16 + axis;
    let plot = Rect {
        x: area.x + gutter,
        y: area.y + legend.len() as u16,
        width: area.width - gutter,
        height: area.height.saturating_sub(taken),
    };
    Places { legend, plot, below }
}

/// κ and H under a place on the screen.
pub fn place_at(model: &Model, area: Rect, here: Position) -> Option<(f64, f64)> {
    if model.chart.sections || !map(model)?.basis().has_hurst() {
        return None;
    }
    let plot = places(model, area).plot;
    let inside = plot.contains(here);
    inside.then(|| {
        let column = index(here.x - plot.x, plot.width, KAPPAS);
        let row = index(plot.bottom() - 1 - here.y, plot.height, HURSTS);
        (kappa(column), hurst(row))
    })
}

/// The cell of the map that a cell of the screen shows.
fn index(at: u16, of: u16, count: usize) -> usize {
    usize::from(at) * count / usize::from(of.max(1))
}

/// The cell of the screen that shows a place on the map, and whether it is on it at all.
fn screen(at: f64, of: u16, count: usize) -> (u16, bool) {
    let place = ((at + 0.5) * f64::from(of) / count as f64).floor();
    let last = f64::from(of.max(1) - 1);
    (place.clamp(0.0, last) as u16, (-0.5..count as f64 - 0.5).contains(&at))
}

/// Draws legend, map, and what stands at the mark, as far as there is room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let Some(map) = map(model) else {
        let text = wrapped(&Line::styled(nothing_yet(model), theme.style(Meaning::Quiet)), area.width);
        return write(frame, area, text);
    };
    if model.chart.sections || !map.basis().has_hurst() {
        let below = below(model, area);
        let rows = (below.len() as u16).min(area.height.saturating_sub(FEWEST_ROWS));
        let plots = Rect { height: area.height - rows, ..area };
        sections::draw(frame, plots, model, map);
        return write(frame, Rect { y: plots.bottom(), height: rows, ..area }, below);
    }
    let Places { legend, plot, below } = places(model, area);
    write(frame, Rect { height: legend.len() as u16, ..area }, legend);
    let rows = (below.len() as u16).min(area.height);
    write(frame, Rect { y: area.bottom() - rows, height: rows, ..area }, below);
    cells(frame, plot, model, map);
    axes(frame, area, plot, theme);
    mark(frame, area, plot, model);
}

fn write(frame: &mut Frame<'_>, area: Rect, lines: Vec<Line<'static>>) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
}

fn cells(frame: &mut Frame<'_>, plot: Rect, model: &Model, map: &PhaseMap) {
    let theme = model.appearance.theme;
    for y in 0..plot.height {
        let row = index(plot.height - 1 - y, plot.height, HURSTS);
        let spans = (0..plot.width).map(|x| match map.stand_in(index(x, plot.width, KAPPAS), row) {
            Some((.., Ok(cell))) => {
                Text::styled(glyph(cell, model.chart.quantity), theme.style(meaning(cell.regime)))
            }
            Some((.., Err(_))) => Text::styled("×", theme.style(Meaning::Error)),
            None => Text::raw(" "),
        });
        let line = Line::from_iter(spans);
        frame.render_widget(Paragraph::new(line), Rect { y: plot.y + y, height: 1, ..plot });
    }
}

/// Values of κ that are written below the map, and of H beside it.
const KAPPA_LABELS: [usize; 5] = [0, 8, 16, 24, 32];
const HURST_LABELS: [usize; 5] = [1, 5, 9, 13, 17];

fn axes(frame: &mut Frame<'_>, area: Rect, plot: Rect, theme: Theme) {
    let quiet = theme.style(Meaning::Quiet);
    if plot.is_empty() {
        return;
    }
    let mut put = |place: Rect, text: String| {
        frame.render_widget(Paragraph::new(Text::styled(text, quiet)), place.intersection(area));
    };
    let below = Rect { y: plot.bottom(), height: 1, ..plot };
    if below.bottom() <= area.bottom() {
        let mut free = plot.x;
        for column in KAPPA_LABELS {
            let text = if column == 0 { "κ 0.125".to_owned() } else { format!("{}", kappa(column)) };
            let width = text.chars().count() as u16;
            let middle = plot.x + screen(column as f64, plot.width, KAPPAS).0;
            let x = middle
                .saturating_sub(width / 2)
                .clamp(plot.x, plot.right().saturating_sub(width).max(plot.x));
            if x >= free && x + width <= plot.right() {
                put(Rect { x, width, ..below }, text);
                free = x + width + 1;
            }
        }
    }
    if plot.x > area.x {
        let mut free = plot.bottom();
        for row in HURST_LABELS {
            let y = plot.bottom() - 1 - screen(row as f64, plot.height, HURSTS).0;
            if y < free {
                let symbol = if row == HURST_LABELS[4] { "H" } else { " " };
                let label = Rect { x: area.x, y, width: GUTTER, height: 1 };
                put(label, format!("{symbol}{:.1}", hurst(row)));
                free = y;
            }
        }
    }
}

/// The scene as it stands, with a pointer on each axis.
fn mark(frame: &mut Frame<'_>, area: Rect, plot: Rect, model: &Model) {
    let Some((kappa, Some(hurst))) = model.place().filter(|_| !plot.is_empty()) else { return };
    let style = model.appearance.theme.style(Meaning::Cursor);
    let (column, row) = PhaseMap::coordinates(kappa, hurst);
    let ((x, _), (y, _)) = (screen(column, plot.width, KAPPAS), screen(row, plot.height, HURSTS));
    let (x, y) = (plot.x + x, plot.bottom() - 1 - y);
    let mut put = |x: u16, y: u16, text: &'static str| {
        let place = Rect { x, y, width: text.chars().count() as u16, height: 1 };
        frame.render_widget(Paragraph::new(Text::styled(text, style)), place.intersection(area));
    };
    // Its surroundings stand back, so that it is seen without colours.
    if x > plot.x {
        put(x - 1, y, " ");
    }
    if x + 1 < plot.right() {
        put(x + 1, y, " ");
    }
    put(x, y, "◆");
    put(x, plot.bottom(), "▲");
    if plot.x > area.x {
        put(plot.x - 1, y, "▶");
    }
}

/// Why there is no map.
fn nothing_yet(model: &Model) -> String {
    if let Err(why) = Basis::of(model.document.scene()) {
        return why.to_string();
    }
    if let Some(why) = &model.chart.failed {
        return format!("no map: {why}");
    }
    match (model.is_computing(), model.is_current()) {
        (true, _) => "first the scene itself…".to_owned(),
        (false, false) => "the scene cannot be computed, so there is no map around it".to_owned(),
        _ if !model.shows_times => "a map of so many springs is not computed here".to_owned(),
        _ => "computing the map, from coarse to fine…".to_owned(),
    }
}

/// What the glyphs tell.
fn legend(model: &Model, width: u16) -> Vec<Line<'static>> {
    let theme = model.appearance.theme;
    let steps = |name: &'static str, steps: &Steps| {
        let step = |(glyph, least): &(&'static str, f64)| {
            vec![Text::raw(*glyph), Text::raw(format!(" ≥ {}", format_quantity(*least, "1")))]
        };
        let name = vec![Text::styled(name, theme.style(Meaning::Title))];
        std::iter::once(name).chain(steps.iter().map(step)).collect()
    };
    let parts = match model.chart.quantity {
        Charted::Regime => [Regime::PressureInsensitive, Regime::PressureSensitive, Regime::NonAdhesive]
            .map(|regime| {
                let glyph = Text::styled(glyph_of(regime), theme.style(meaning(regime)));
                vec![glyph, Text::raw(format!(" {}", regime.name()))]
            })
            .to_vec(),
        Charted::ZeroLoadAdhesion => steps("F_a(0)/F_a,max", &ZERO_LOAD_STEPS),
        Charted::Coefficient => steps("F_a/F_n", &COEFFICIENT_STEPS),
    };
    filled(parts, "  ", usize::from(width))
}

/// A number to two digits.
fn short(value: f64) -> String {
    format_quantity(format!("{value:.1e}").parse().unwrap_or(value), "1")
}

/// A number to three digits.
fn number(value: f64) -> String {
    format_quantity(format!("{value:.2e}").parse().unwrap_or(value), "1")
}

/// What stands below the map, the most important first.
fn below(model: &Model, area: Rect) -> Vec<Line<'static>> {
    let Some(map) = map(model) else { return Vec::new() };
    let theme = model.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    if let Some((at_kappa, at_hurst)) = model.place() {
        say(here(model, at_kappa, at_hurst));
        if let Some((column, row, cell)) = map.nearest(at_kappa, at_hurst.unwrap_or_default()) {
            let at = (number(kappa(column)), at_hurst.map(|_| number(hurst(row))));
            let elsewhere = at != (number(at_kappa), at_hurst.map(number));
            say(Line::raw(there(map, elsewhere.then_some(at), cell)));
        }
    }
    let sides = |level: Level| format!("{} × {} cells", level.columns().count(), map.rows_of(level).len());
    match (map.level(), &model.chart.failed) {
        (_, Some(why)) => say(Line::styled(format!("the map ends here: {why}"), theme.style(Meaning::Error))),
        (Some(_), None) if map.is_whole() => {}
        (Some(level), None) => {
            say(Line::styled(format!("{} so far…", sides(level)), theme.style(Meaning::Key)))
        }
        (None, None) => say(Line::styled("the coarse map first…", theme.style(Meaning::Key))),
    }
    if area.height >= ROOMY {
        let note = format!(
            "Eq. (15) has the first boundary at κ ≈ 0.6. Pressure-insensitive: F_a(0) is at least {} % of F_a and {} % of that of the smooth body. \
             Non-adhesive: F_a is below {} % of F_n. All forces are means; the lines have the seed of the scene and \
             those after it, exact, with edges between springs.",
            100.0 * INSENSITIVE_SHARE,
            100.0 * VANISHING_SHARE,
            100.0 * NEGLIGIBLE_COEFFICIENT
        );
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// The scene itself.
fn here(model: &Model, at_kappa: f64, at_hurst: Option<f64>) -> Line<'static> {
    let hurst = at_hurst.map_or_else(String::new, |hurst| format!(", H {}", number(hurst)));
    let outside = {
        let (column, row) = PhaseMap::coordinates(at_kappa, at_hurst.unwrap_or(0.5));
        !screen(column, 1, KAPPAS).1 || !screen(row, 1, HURSTS).1
    };
    let outside = if outside { ", outside the map" } else { "" };
    let regime = model.computed.as_ref().filter(|_| model.is_current());
    let regime = regime.and_then(|computed| computed.outcome.regime);
    let regime = regime.map_or_else(String::new, |regime| format!(": {}", regime.name()));
    Line::from(vec![
        Text::styled("◆ ", model.appearance.theme.style(Meaning::Cursor)),
        Text::raw(format!("κ {}{hurst}{outside}{regime}", number(at_kappa))),
    ])
}

/// What the map says there, or where it says it, in case that is not where the mark is.
fn there(map: &PhaseMap, at: Option<(String, Option<String>)>, cell: &Result<Cell, String>) -> String {
    let at = match at {
        None => "map".to_owned(),
        Some((kappa, hurst)) => {
            let hurst = hurst.map_or_else(String::new, |hurst| format!(", H {hurst}"));
            format!("map at κ {kappa}{hurst}")
        }
    };
    let cell = match cell {
        Ok(cell) => cell,
        Err(why) => return format!("{at}: {why}"),
    };
    let lines = map.basis().lines();
    let lines = if lines == 1 { String::new() } else { format!(" ({} of {lines} lines)", cell.agreeing) };
    let coefficient =
        cell.coefficient().map_or_else(String::new, |value| format!(", F_a/F_n {}", short(value)));
    let share = short(cell.zero_load_share());
    format!("{at}: {}{lines}, F_a(0) {share} F_a,max{coefficient}", cell.regime.name())
}
