//! Words of the map: its title, its legend, and the values at the mark.

use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, VANISHING_SHARE};
use crate::draw::{Chart, Colours, SHADES, key, legend as entries};
use crate::explorer::app::App;
use crate::explorer::chart::{Live, OpenStudy};
use crate::explorer::theme::Meaning;
use crate::explorer::view::plot;
use crate::explorer::view::wrap::{filled, wrapped};
use crate::scene::{RoughnessParameter, format_rounded};
use crate::study::map::{Level, Template};
use crate::study::{Axis, Cell, Estimate, Grid, Place, Quantity};
use crate::text::grouped;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};

/// Least height with room to explain the regimes.
const ROOMY: u16 = 24;

/// Title of the pane: the mapped quantity, the axes, and the number of profiles of the mean.
pub fn title(app: &App) -> String {
    let template = Template::of(app.edit.document.scene());
    let Some((across, up)) = app.map_axes() else { return " Map ".to_owned() };
    let axes: Vec<&str> =
        [Some(&across), up.as_ref()].into_iter().flatten().map(Axis::symbol_or_name).collect();
    let over = axes.join(", ");
    let charted = app.grid().map(|grid| name_of(grid, app.charted()));
    let quantity = charted.unwrap_or_else(|| "regime".to_owned());
    let study = app.chart.shown_study().map(|study| (&study.study_map, study.study_map.plan().lines));
    match (study, template) {
        (Some((study_map, count)), _) => {
            format!(" Study {}: {quantity} over {over}, {} ", study_map.name(), profiles(count))
        }
        (None, Ok(template)) => format!(" Map of {quantity} over {over}, {} ", profiles(template.lines())),
        (None, Err(_)) => " Map ".to_owned(),
    }
}

fn profiles(count: u64) -> String {
    if count == 1 { "1 profile".to_owned() } else { format!("{} profiles", grouped(count)) }
}

/// Reason why there is no map.
pub fn nothing_yet(app: &App) -> String {
    if let Err(why) = Template::of(app.edit.document.scene()) {
        return why.to_string();
    }
    if let Some(why) = app.studies.failure::<Live>() {
        return format!("no map: {why}");
    }
    match (app.is_computing(), app.is_current()) {
        (true, _) => "first the scene itself…".to_owned(),
        (false, false) => "the scene cannot be computed, so there is no map around it".to_owned(),
        _ if !app.view.shows_times => "a map of so many springs is not computed here".to_owned(),
        _ => "computing the map, from coarse to fine…".to_owned(),
    }
}

/// The name of a quantity: its symbol, where unique on the map.
fn name_of(grid: &Grid, quantity: Quantity) -> String {
    let symbol = quantity.symbol();
    let is_only = grid.layers.iter().filter(|layer| layer.quantity.symbol() == symbol).count() == 1;
    if is_only && !symbol.is_empty() { symbol.to_owned() } else { quantity.name().replace('_', " ") }
}

/// Axes, shades and their values, classes, and the slice of a study.
pub fn legend(app: &App, chart: &Chart, width: u16) -> Vec<Line<'static>> {
    let theme = app.view.appearance.theme;
    let width = usize::from(width);
    let (Some(grid), Some(map)) = (app.grid(), chart.map()) else { return Vec::new() };
    let up = format!("↑ {}", chart.y.label_with_unit());
    let mut parts = vec![vec![Text::styled(up, theme.style(Meaning::Title))]];
    match app.charted() {
        Quantity::Regime => {
            // From the densest: the regimes, and cells whose profiles are in one and the next.
            for (class, shade) in map.class_names.iter().zip(SHADES.iter().rev().step_by(2)) {
                let shade =
                    Text::styled(*shade, plot::in_theme(app.view.appearance, |style| (style.ink)(class.ink)));
                parts.push(vec![shade, Text::raw(format!(" {}", class.name))]);
            }
            if grid.is_split() {
                parts.push(vec![Text::raw(format!("{} {} profiles disagree", SHADES[3], SHADES[1]))]);
            }
        }
        _ => {
            let scale = key(map, width, Colours::None);
            let name = Text::styled(format!("{} ", map.key.label_with_unit()), theme.style(Meaning::Title));
            parts.push(
                std::iter::once(name).chain(scale.into_iter().map(|(text, _)| Text::raw(text))).collect(),
            );
            parts.extend(plot::in_theme(app.view.appearance, |style| {
                entries(std::slice::from_ref(chart), style)
            }));
        }
    }
    let mut lines = app.chart.shown_study().map_or_else(Vec::new, |study| slice(app, study, width));
    lines.extend(filled(parts, "  ", width));
    lines
}

/// Slice of a study with several maps.
fn slice(app: &App, study: &OpenStudy, width: usize) -> Vec<Line<'static>> {
    let (theme, slices) = (app.view.appearance.theme, study.study_map.slices());
    if slices == 1 {
        // Axes of one value.
        let at = study.study_map.fixed_values(0).into_iter();
        return filled(
            at.map(|at| vec![Text::styled(at, theme.style(Meaning::Title))]).collect(),
            "  ",
            width,
        );
    }
    let at = study.study_map.fixed_values(study.slice).into_iter();
    let which = Text::styled(
        format!("{} of {}, P: the next", grouped(study.slice + 1), grouped(slices)),
        theme.style(Meaning::Key),
    );
    let at = at.map(|at| vec![Text::styled(at, theme.style(Meaning::Title))]);
    filled(at.chain([vec![which]]).collect(), "  ", width)
}

/// A value of an axis with its symbol.
fn on_axis(axis: &Axis, value: f64) -> String {
    format!("{} {}", axis.symbol_or_name(), format_rounded(value, 3, axis.unit))
}

/// A place with the symbols of the axes.
fn on_axes(grid: &Grid, (across, up): Place) -> String {
    let up = grid.up.as_ref().zip(up).map(|(axis, value)| on_axis(axis, value));
    let parts: Vec<String> = [on_axis(&grid.across, across)].into_iter().chain(up).collect();
    parts.join(", ")
}

/// Lines below the map, the most important first.
pub fn below(app: &App, area: Rect) -> Vec<Line<'static>> {
    let Some(grid) = app.grid() else { return Vec::new() };
    let theme = app.view.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    let study = app.chart.shown_study();
    match app.place() {
        Some(place) => {
            say(here(app, grid, place));
            if let Some((cell, column, row)) = grid.nearest(place) {
                say(Line::raw(there(app, grid, place, (cell, column, row))));
            } else if study.is_some() {
                say(Line::raw("the study was merged without this cell"));
            }
        }
        None if study.is_some() => {
            let why = Template::of(app.edit.document.scene()).err();
            let no_mark = "no mark: the scene lacks a quantity of the axes".to_owned();
            let why = why.map_or(no_mark, |why| why.to_string().replacen("no map", "no mark", 1));
            say(Line::styled(why, theme.style(Meaning::Quiet)));
        }
        None => {}
    }
    match study {
        Some(study) if !study.study_map.is_of(study.slice, app.edit.document.scene()) => say(Line::styled(
            "the scene is no longer that of the study: more differs than the quantities of the axes",
            theme.style(Meaning::Key),
        )),
        Some(_) => {}
        None => computed_so_far(app, &mut say),
    }
    if area.height >= ROOMY {
        let note = study.map_or_else(|| note_of_computed(app), |study| note_of_study(study, grid));
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// Progress of the live map.
fn computed_so_far(app: &App, say: &mut impl FnMut(Line<'static>)) {
    let Some(Live { map, .. }) = app.studies.value() else { return };
    let theme = app.view.appearance.theme;
    let sides = |level: Level| format!("{} × {} cells", level.columns().count(), map.rows_of(level).len());
    match (map.level(), app.studies.failure::<Live>()) {
        (_, Some(why)) => say(Line::styled(format!("the map ends here: {why}"), theme.style(Meaning::Error))),
        (Some(_), None) if map.is_whole() => {}
        (Some(level), None) => {
            say(Line::styled(format!("{} so far…", sides(level)), theme.style(Meaning::Key)))
        }
        (None, None) => say(Line::styled("the coarse map first…", theme.style(Meaning::Key))),
    }
}

fn note_of_computed(app: &App) -> String {
    let cells = Template::of(app.edit.document.scene()).map_or_else(
        |_| String::new(),
        |template| {
            format!("Each cell: {} of {} springs. ", profiles(template.lines()), grouped(template.springs()))
        },
    );
    let parameter = match app.chart.parameter {
        RoughnessParameter::Kappa => {
            "κ ≈ 0.6 is the boundary of eq. (15) in the paper: with smaller κ bodies adhere without a preload, with larger κ \
             only once pressed."
        }
        RoughnessParameter::ElasticEnergyRatio => {
            "e_el/γ is the elastic energy of full conformity over the work of adhesion: with smaller e_el/γ bodies adhere \
             without a preload, with larger e_el/γ only once pressed."
        }
    };
    format!(
        "{cells}{parameter} Pressure-insensitive: F_a(0) is at least {} % of F_a and {} % of that of the smooth body. \
         Non-adhesive: F_a is below {} % of F_n. The regime of a cell is that of most of its profiles, forces are \
         means; profiles have the seed of the scene and the next ones, exact, with sub-cell edges.",
        100.0 * INSENSITIVE_SHARE,
        100.0 * VANISHING_SHARE,
        100.0 * NEGLIGIBLE_COEFFICIENT
    )
}

fn note_of_study(study: &OpenStudy, grid: &Grid) -> String {
    let regimes = if grid.quantities().contains(&Quantity::Regime) {
        "Colours: regime of most profiles; ▓ and ░: fewer than three quarters agree. "
    } else {
        "One colour: no regimes were recorded. "
    };
    let plan = study.study_map.plan();
    format!(
        "A finished study of {}, from seed {}. {regimes}± is the 95 % confidence of the mean. ◆ is its scene with the first profile; W shows the map that is \
         computed here around it, and this one again.",
        profiles(plan.lines),
        plan.seed
    )
}

/// The scene itself.
fn here(app: &App, grid: &Grid, place: Place) -> Line<'static> {
    let outside = if grid.contains(place) { "" } else { ", outside the map" };
    let regime = app.current();
    let regime = regime.and_then(|computed| computed.outcome.regime);
    let regime = regime.map_or_else(String::new, |regime| format!(": {}", regime.name()));
    Line::from(vec![
        Text::styled("◆ ", app.view.appearance.theme.style(Meaning::Cursor)),
        Text::raw(format!("{}{outside}{regime}", on_axes(grid, place))),
    ])
}

/// Quantities shown with the regime.
const WITH_REGIME: [Quantity; 2] = [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient];

/// Quantities shown together: with the regime those that decide the regime, if any.
pub fn shown_quantities(charted: Quantity, grid: &Grid) -> Vec<Quantity> {
    if charted != Quantity::Regime {
        return vec![charted];
    }
    let both: Vec<_> = WITH_REGIME.into_iter().filter(|one| grid.layer(*one).is_some()).collect();
    let first = || grid.quantities().into_iter().find(|one| *one != Quantity::Regime);
    if both.is_empty() { vec![first().unwrap_or(charted)] } else { both }
}

/// Values of the map at a cell, with its place unless the cell is at the mark.
fn there(
    app: &App,
    grid: &Grid,
    mark: Place,
    (cell, column, row): (&Result<Cell, String>, usize, usize),
) -> String {
    let whose = if app.chart.shown_study().is_some() { "study" } else { "map" };
    let place = (grid.across.values[column], grid.up.as_ref().map(|up| up.values[row]));
    let (at, marked) = (on_axes(grid, place), on_axes(grid, mark));
    let at = if at == marked { whose.to_owned() } else { format!("{whose} at {at}") };
    let cell = match cell {
        Ok(cell) => cell,
        Err(why) => return format!("{at}: {why}"),
    };
    let agree = if cell.lines == 1 {
        String::new()
    } else {
        format!(" ({} of {} profiles)", grouped(cell.agreeing()), grouped(cell.lines))
    };
    let regime = cell.regime.map(|cell| format!("{}{agree}", cell.regime.name()));
    // Quantities of the regime are shown together, so that the map keeps its place.
    let charted = app.charted();
    let charted = if WITH_REGIME.contains(&charted) { Quantity::Regime } else { charted };
    let shown = shown_quantities(charted, grid);
    let known = grid.layers.iter().zip(&cell.estimates).filter(|(layer, _)| shown.contains(&layer.quantity));
    let values = known.filter_map(|(layer, estimate)| {
        let quantity = layer.quantity;
        Some(format!("{} {}", name_of(grid, quantity), value((*estimate)?, quantity.unit())))
    });
    format!("{at}: {}", regime.into_iter().chain(values).collect::<Vec<_>>().join(", "))
}

/// A mean, with its confidence where known and the range of the profiles.
fn value(Estimate { mean, interval, range: (least, most) }: Estimate, unit: &str) -> String {
    let shown = |value| format_rounded(value, 2, unit);
    let confidence = interval.filter(|(low, high)| low < high);
    let confidence =
        confidence.map_or_else(String::new, |(low, high)| format!(" ± {}", shown((high - low) / 2.0)));
    let range = if least < most { format!(" ({} to {})", shown(least), shown(most)) } else { String::new() };
    format!("{}{confidence}{range}", shown(mean))
}
