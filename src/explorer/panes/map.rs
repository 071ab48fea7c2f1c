//! The pane of the map. Shades of the map show regimes or values, a mark shows the position of the
//! scene, and a text states the values at the mark.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::map_state::{Live, OpenStudy};
use crate::explorer::panel::{Panel, entries, shades};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled, wrapped};
use crate::explorer::theme::Meaning;
use asperity_data::{AxisScale, counted, format_range, format_rounded, grouped};
use asperity_plot::{Chart, Figure, Ink, Layer, Shape, Sign, shade_of};
use asperity_report::{study_curves, study_figure, study_map};
use asperity_study::StudyError;
use asperity_study::maps::{Grid, GridCell, GridPlace, LiveMap};
use asperity_study::{Axis, Plan, Quantity, Statistics};
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| app.grid().map(|grid| figure(app, grid)),
    report: cells,
    studies: |app, computed| match app.map.shown_study() {
        Some(_) => Vec::new(),
        None => study(app, computed).into_iter().collect(),
    },
    help: &[
        (
            "Map",
            "key m: regime over H and κ, of the majority of four random profiles; █ adhesion without a preload, ▒ only after \
             pressing, · hardly any; ◆ is the scene. Key M: means of a quantity over any two numbers of the scene",
        ),
        (
            "Study",
            "map of a merged study: means over its profiles; ▓ ░ where profiles differ in their regimes",
        ),
    ],
    ..PaneRow::EMPTY
};

/// Values of the regimes on a map of regimes, in the order of the classes of the map.
const VALUES_OF_REGIMES: [f64; 3] = [1.0, 0.5, 0.0];
/// Values of cells in which some profiles are in one regime and some in the next.
const VALUES_BETWEEN_REGIMES: [f64; 2] = [0.75, 0.25];
/// Largest number of springs with which a demo computes a map. With more springs, the hundreds of
/// scenes of a map would take too long.
const MOST_SPRINGS: u64 = 1 << 12;

/// Returns the study (background computation) of the missing cells of the live map; `None` if the
/// scene has no live map.
fn study(app: &App, computed: &SolvedScene) -> Option<Study> {
    let plan = app.map.plan(&computed.scene).ok()?;
    let (key, is_long) = (
        format!("{plan:?}"),
        plan.scene.numerics.points > MOST_SPRINGS,
    );
    let begun = app.studies.value::<Live>().map(|live| live.map.clone());
    Some(Study::new(key, is_long, move |simulation, mut control| {
        let mut map = match begun {
            Some(begun) => begun,
            None => LiveMap::new(plan)?,
        };
        let control_of_map = control.of_part();
        let mut report = |map: &LiveMap| control.report(Live::of(map));
        map.compute(simulation, control_of_map.reporting_to(&mut report));
        Ok::<_, StudyError>(Live::of(&map))
    }))
}

fn cells(app: &App) -> Exported<'_> {
    Some(("asperity".into(), Box::new(app.grid()?.clone())))
}

fn panel(app: &App, size: Size) -> Panel {
    let title = title(app);
    let Some(grid) = app.grid() else {
        return Panel::of_text(title, &nothing_yet(app));
    };
    let foot = below(app, grid, size);
    let Some(mut chart) = map(grid, app.mapped(), app.colour_scale(app.mapped())) else {
        let Some(chart) = curves(app, grid).into_iter().next() else {
            return Panel::of_text(title, "the study has no quantity to draw over its axis");
        };
        let heading = chart.heading.to_string();
        return Panel {
            head: vec![Line::raw(heading)],
            foot,
            ..Panel::of_chart(title, chart)
        };
    };
    let head = legend(app, &chart, size.width.into());
    if let Some((across, Some(up))) = app.place() {
        chart.layers.push(Layer::unnamed(
            Ink::Cursor,
            Shape::signs(vec![(across, up)], Sign::Diamond),
        ));
    }
    Panel {
        head,
        foot,
        ..Panel::of_chart(title, chart)
    }
}

/// Returns the map of the regimes or of another quantity over two axes; `None` if the grid has only
/// one axis. The cells are drawn without the letters of the regimes. In a map of regimes the shades
/// already show them, and in a map of another quantity they would hide the boundary.
fn map(grid: &Grid, mapped: Quantity, scale: Option<AxisScale>) -> Option<Chart> {
    let mut chart = study_map(grid, mapped, true, scale)?;
    if let Some(map) = chart.map_mut() {
        if mapped.is_regime() {
            map.contour = None;
        }
        for class in &mut map.class_names {
            class.letter = None;
        }
    }
    Some(chart)
}

/// Returns the charts of quantities over the only axis of the grid, with the mark of the scene.
fn curves(app: &App, grid: &Grid) -> Vec<Chart> {
    let mut charts = Vec::new();
    for quantity in shown_quantities(app.mapped(), grid) {
        if quantity.is_regime() {
            continue;
        }
        let Some(mut chart) = study_curves(grid, quantity).into_iter().next() else {
            continue;
        };
        if let Some((mark, _)) = app.place() {
            let top = chart.y.scale.number(chart.y.span.high);
            let sign = Shape::signs(vec![(mark, top)], Sign::Diamond);
            let upright = Shape::Upright(mark);
            chart.layers.push(Layer::unnamed(Ink::Cursor, upright));
            chart.layers.push(Layer::unnamed(Ink::Cursor, sign));
        }
        charts.push(chart);
    }
    charts
}

/// Returns the figure of the pane. If the grid has two axes, the figure contains the map. In place
/// of a map of regimes, it contains maps of the quantities that decide the regime; markers on these
/// maps show the regimes. If the grid has one axis, the figure contains curves.
fn figure(app: &App, grid: &Grid) -> Figure {
    let charts = match grid.up {
        None => curves(app, grid),
        Some(_) => shown_quantities(app.mapped(), grid)
            .into_iter()
            .filter_map(|quantity| study_map(grid, quantity, false, app.colour_scale(quantity)))
            .collect(),
    };
    let title = match app.map.shown_study() {
        Some(study) => &study.study_map.plan().title,
        None => &app.edit.document.scene().title,
    };
    study_figure(title, grid, charts)
}

/// Returns the title of the pane: the quantity, the axes, and the number of random profiles over
/// which the mean is taken.
fn title(app: &App) -> String {
    let Some((across, up)) = app.map_axes() else {
        return "Map".to_owned();
    };
    let mut over = across.symbol_or_name().to_owned();
    if let Some(up) = &up {
        over = format!("{over}, {}", up.symbol_or_name());
    }
    let mapped = match app.grid() {
        Some(grid) => name_of(grid, app.mapped()),
        None => "regime".to_owned(),
    };
    let (name, profiles) = match app.map.shown_study() {
        Some(OpenStudy { study_map, .. }) => (
            format!("Study {}: {mapped}", study_map.name()),
            study_map.plan().lines,
        ),
        None => (format!("Map of {mapped}"), profiles_of_live_map(app)),
    };
    let profiles = counted(profiles, "profile");
    format!("{name} over {over}, {profiles}")
}

/// Number of random profiles in each cell of the live map.
fn profiles_of_live_map(app: &App) -> u64 {
    match app.studies.value::<Live>() {
        Some(live) => live.map.plan().lines,
        None => Plan::PROFILES_OF_MAP,
    }
}

fn nothing_yet(app: &App) -> String {
    if let Err(why) = app.map.plan(app.edit.document.scene()) {
        return why.to_string();
    }
    match app.studies.failure::<Live>() {
        Some(why) => format!("no map: {why}"),
        None if app.is_computing() => "the scene is still being computed…".to_owned(),
        None if !app.is_current() => {
            "the scene cannot be computed, so there is no map around it".to_owned()
        }
        None if !app.view.shows_times => {
            "a demo computes no map of a scene with this many springs".to_owned()
        }
        None => "computing the map, from coarse to fine…".to_owned(),
    }
}

/// Returns a short name of a quantity: its symbol, if no other quantity of the map has the same
/// symbol, otherwise its name.
fn name_of(grid: &Grid, quantity: Quantity) -> String {
    if quantity.is_regime() {
        return format!("regime ({})", quantity.short_protocol());
    }
    let symbol = quantity.symbol();
    let symbols = grid.layers.iter().map(|layer| layer.quantity.symbol());
    let is_only = symbols.filter(|other| *other == symbol).count() == 1;
    if is_only && !symbol.is_empty() {
        symbol.to_owned()
    } else {
        quantity.name().replace('_', " ")
    }
}

/// Returns the legend. It contains the values that distinguish the shown map from other maps of the
/// study, the label of the vertical axis, and the shades with their meaning.
fn legend(app: &App, chart: &Chart, width: usize) -> Vec<Line<'static>> {
    let Some(grid) = app.grid() else {
        return Vec::new();
    };
    let mut lines = match app.map.shown_study() {
        Some(study) => filled(parts_of_slice(app, study, grid), "  ", width),
        None => Vec::new(),
    };
    lines.extend(filled(parts_of_shades(app, chart, width), "  ", width));
    lines
}

/// Returns the label of the vertical axis, and the shades with their meaning. In a map of regimes,
/// each shade is a regime. In a map of another quantity, shades are numbers, and the sample of the
/// boundary between regimes is added.
fn parts_of_shades(app: &App, chart: &Chart, width: usize) -> Vec<Part> {
    let (Some(grid), Some(map)) = (app.grid(), chart.map()) else {
        return Vec::new();
    };
    let look = app.view.appearance;
    let mut parts = shades(chart, look, width);
    if !app.mapped().is_regime() {
        // The last entry of the legend describes the boundary.
        let boundary = entries(chart, look).pop();
        if map.contour.is_some() {
            parts.extend(boundary);
        }
        return parts;
    }
    parts.truncate(1);
    let palette = look.palette();
    let sample = |value: f64| {
        let (character, style) = shade_of(map, value, palette);
        Text::styled(character, style)
    };
    for (class, value) in map.class_names.iter().zip(VALUES_OF_REGIMES) {
        let mut shade = sample(value);
        if !palette.has_shades() {
            shade = shade.style(palette.ink(class.ink));
        }
        let name = Text::raw(format!(" {}", class.name));
        parts.push(vec![shade, name]);
    }
    if grid.is_split(app.mapped()) {
        let name = Text::raw(" profiles disagree");
        let [upper, lower] = VALUES_BETWEEN_REGIMES;
        parts.push(vec![sample(upper), Text::raw(" "), sample(lower), name]);
    }
    parts
}

/// Returns the values that are fixed in the shown map of the study, and the number of this map
/// among all maps of the study.
fn parts_of_slice(app: &App, study: &OpenStudy, grid: &Grid) -> Vec<Part> {
    let mut parts = Vec::new();
    for value in &grid.fixed {
        parts.push(vec![Text::styled(value.clone(), app.style(Meaning::Title))]);
    }
    let slices = study.study_map.slices();
    if slices > 1 {
        let number = grouped(study.slice + 1);
        let text = format!("{number} of {}, P: the next", grouped(slices));
        parts.push(vec![Text::styled(text, app.style(Meaning::Key))]);
    }
    parts
}

/// Returns a position on the map as text: `H 0.8, κ 1.5`.
fn on_axes(grid: &Grid, place: GridPlace) -> String {
    let (across, up) = place;
    let mut text = on_axis(&grid.across, across);
    if let Some(axis) = &grid.up
        && let Some(value) = up
    {
        text = format!("{text}, {}", on_axis(axis, value));
    }
    text
}

fn on_axis(axis: &Axis, value: f64) -> String {
    let value = format_rounded(value, 3, axis.unit);
    format!("{} {value}", axis.symbol_or_name())
}

/// Number of rows of the pane for each line of text on the mark. In a lower pane the text has less
/// detail, so that it is not cut and the map keeps most of the rows.
const ROWS_PER_LINE: u16 = 5;

/// Detail of the text on the mark.
#[derive(Clone, Copy, PartialEq)]
enum Detail {
    Every,
    /// Without the medians and ranges over the profiles.
    Means,
    /// Also without the turning point that belongs to the regime, and the number of its profiles.
    Least,
}

impl Detail {
    const ALL: [Detail; 3] = [Detail::Every, Detail::Means, Detail::Least];
}

/// Returns the lines below the map: the position of the scene, the values of the nearest cell and,
/// if necessary, the reason why the map is incomplete or does not belong to the scene.
fn below(app: &App, grid: &Grid, size: Size) -> Vec<Line<'static>> {
    let Size { width, height } = size;
    let most = usize::from((height / ROWS_PER_LINE).max(1));
    let mut lines = Vec::new();
    for detail in Detail::ALL {
        lines = wrapped(&Line::raw(mark_in_words(app, grid, detail)), width);
        if lines.len() <= most {
            break;
        }
    }
    if let Some(missing) = missing(app) {
        let missing = Line::styled(missing, app.style(Meaning::Key));
        lines.extend(wrapped(&missing, width));
    }
    lines
}

/// Returns the position of the scene and the values of the nearest cell as text.
fn mark_in_words(app: &App, grid: &Grid, detail: Detail) -> String {
    let Some(place) = app.place() else {
        return "no mark: the scene lacks a quantity of the axes".to_owned();
    };
    let outside = if grid.contains(place) {
        ""
    } else {
        ", outside the map"
    };
    let values = cell_values(app, grid, place, detail).unwrap_or_else(|| "not computed".to_owned());
    format!("◆ {}{outside}: {values}", on_axes(grid, place))
}

/// Returns the reason why the map is incomplete or does not belong to the scene; `None` if the map
/// is complete and belongs to the scene.
fn missing(app: &App) -> Option<String> {
    if let Some(study) = app.map.shown_study() {
        let scene = app.edit.document.scene();
        if study.is_of(scene) {
            return None;
        }
        let why = "the scene no longer belongs to the study: it differs in more than the quantities of the axes";
        return Some(why.to_owned());
    }
    if let Some(why) = app.studies.failure::<Live>() {
        return Some(format!("map incomplete: {why}"));
    }
    let live = app.studies.value::<Live>()?;
    if live.map.is_whole() {
        return None;
    }
    Some("computing further cells…".to_owned())
}

/// Returns the two quantities from which a regime follows.
fn deciding(regime: Quantity) -> [Quantity; 2] {
    let [share, share_after_zero_force] = Quantity::ADHESION_SHARES;
    let share = if regime == Quantity::RegimeAfterZeroForce {
        share_after_zero_force
    } else {
        share
    };
    [share, Quantity::AdhesionCoefficient]
}

/// Returns the quantities that are shown together. In place of a regime, these are the quantities
/// that decide the regime or, if the grid contains none of them, its first other quantity. A
/// quantity that is not a regime is shown alone.
fn shown_quantities(mapped: Quantity, grid: &Grid) -> Vec<Quantity> {
    if !mapped.is_regime() {
        return vec![mapped];
    }
    let mut shown = deciding(mapped).to_vec();
    shown.retain(|quantity| grid.layer(*quantity).is_some());
    if shown.is_empty() {
        let mut quantities = grid.quantities().into_iter();
        let first = quantities.find(|quantity| !quantity.is_regime());
        shown.push(first.unwrap_or(mapped));
    }
    shown
}

/// Returns the values of the computed cell nearest to the mark. If the position of this cell
/// differs from the mark, the text begins with the position. `None` if no cell is computed.
fn cell_values(app: &App, grid: &Grid, mark: GridPlace, detail: Detail) -> Option<String> {
    let (cell, column, row) = grid.nearest(mark)?;
    let across = grid.across.values[column];
    let up = grid.up.as_ref().map(|up| up.values[row]);
    let place = on_axes(grid, (across, up));
    let place = if place == on_axes(grid, mark) {
        String::new()
    } else {
        format!("at {place} ")
    };
    let cell = match cell {
        Ok(cell) => cell,
        Err(why) => return Some(format!("{place}{why}")),
    };
    let mapped = app.mapped();
    // If the shown quantity decides a regime, the text contains this regime and both quantities
    // that decide it. The text then does not become longer or shorter when the user switches
    // between these quantities, so that the map does not move on the screen.
    let mut regimes = Quantity::REGIMES.into_iter();
    let decided = regimes.find(|regime| deciding(*regime).contains(&mapped));
    let mapped = decided.unwrap_or(mapped);
    let mut parts = Vec::new();
    parts.extend(regime_in_words(cell, mapped, detail));
    let shown = shown_quantities(mapped, grid);
    for (layer, statistics) in grid.layers.iter().zip(&cell.statistics) {
        if let Some(statistics) = statistics
            && shown.contains(&layer.quantity)
        {
            let name = name_of(grid, layer.quantity);
            let value = value(*statistics, layer.quantity.unit(), detail);
            parts.push(format!("{name} {value}"));
        }
    }
    Some(format!("{place}{}", parts.join(", ")))
}

/// Returns the regime of most profiles of a cell, and the number of these profiles.
fn regime_in_words(cell: &GridCell, mapped: Quantity, detail: Detail) -> Option<String> {
    let regimes = cell.regimes_of(mapped);
    let (regime, count) = regimes.most()?;
    if detail == Detail::Least {
        return Some(regime.name().to_owned());
    }
    let words = format!("{} {}", regime.name(), mapped.protocol());
    let profiles = regimes.profiles() as u64;
    if profiles == 1 {
        return Some(words);
    }
    let count = grouped(count as u64);
    Some(format!(
        "{words} ({count} of {} profiles)",
        grouped(profiles)
    ))
}

/// Returns a mean value as text, with the median and the range if the profiles differ and there is
/// room for every detail.
fn value(statistics: Statistics, unit: &str, detail: Detail) -> String {
    let mean = format_rounded(statistics.mean, 2, unit);
    let (least, most) = statistics.range;
    if least == most || detail != Detail::Every {
        return mean;
    }
    let median = format_rounded(statistics.quartiles[1], 2, unit);
    let range = format_range((least, most), 2, unit);
    format!("{mean} (median {median}, {range})")
}
