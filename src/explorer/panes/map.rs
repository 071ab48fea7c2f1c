//! The map: shades in the colours of the regimes, the mark of the scene, and the values at the
//! mark.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::map::{Live, OpenStudy};
use crate::explorer::panel::{Panel, entries, in_theme, shades};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled, wrapped};
use crate::explorer::theme::Meaning;
use asperity_data::{format_range, format_rounded, grouped};
use asperity_plot::{Chart, Figure, Ink, Layer, SHADES, Shape, Sign};
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
             pressing, · hardly any; ◆ is the scene",
        ),
        (
            "Study",
            "map of a merged study: means over its profiles; ▓ ░ where profiles differ in their regimes",
        ),
    ],
};

/// Largest number of springs for a map in a demo, since it takes hundreds of scenes.
const MOST_SPRINGS: u64 = 1 << 12;

/// Computes the missing cells of the live map; `None` for a scene without a map.
fn study(app: &App, computed: &SolvedScene) -> Option<Study> {
    let plan = app.map.plan(&computed.scene)?;
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
    let foot = below(app, grid, size.width);
    let Some(mut chart) = map(grid, app.mapped()) else {
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

/// Map of the regimes or of a quantity over two axes; `None` for a grid along one axis.
fn map(grid: &Grid, mapped: Quantity) -> Option<Chart> {
    let mut chart = study_map(grid, mapped, true)?;
    if let Some(map) = chart.map_mut() {
        // The shades show the regimes; in a map of another quantity letters would hide the
        // boundary.
        map.contour = map.contour.take().filter(|_| !mapped.is_regime());
        map.class_names
            .iter_mut()
            .for_each(|class| class.letter = None);
    }
    Some(chart)
}

/// Curves over the only axis of a map, with the mark of the scene.
fn curves(app: &App, grid: &Grid) -> Vec<Chart> {
    let quantities = shown_quantities(app.mapped(), grid);
    let curves = quantities
        .into_iter()
        .filter(|quantity| !quantity.is_regime());
    let mark = app.place().map(|(across, _)| across);
    let chart = |quantity| {
        let mut chart = study_curves(grid, quantity).into_iter().next()?;
        if let Some(mark) = mark {
            let top = chart.y.scale.number(chart.y.span.high);
            chart
                .layers
                .push(Layer::unnamed(Ink::Cursor, Shape::Upright(mark)));
            chart.layers.push(Layer::unnamed(
                Ink::Cursor,
                Shape::signs(vec![(mark, top)], Sign::Diamond),
            ));
        }
        Some(chart)
    };
    curves.filter_map(chart).collect()
}

/// Figure of the pane: the map, together with the quantities that decide the regimes if these are
/// shown; or curves over the only axis.
fn figure(app: &App, grid: &Grid) -> Figure {
    let charts = match grid.up {
        None => curves(app, grid),
        Some(_) => {
            let shown = shown_quantities(app.mapped(), grid).into_iter();
            shown
                .filter_map(|quantity| study_map(grid, quantity, false))
                .collect()
        }
    };
    let study = app.map.shown_study();
    let title = study.map_or(&app.edit.document.scene().title, |study| {
        &study.study_map.plan().title
    });
    study_figure(title, grid, charts)
}

/// Title of the pane: the quantity, the axes, and the number of profiles of the mean.
fn title(app: &App) -> String {
    let Some((across, up)) = app.map_axes() else {
        return "Map".to_owned();
    };
    let over = [Some(&across), up.as_ref()]
        .into_iter()
        .flatten()
        .map(Axis::symbol_or_name);
    let over = over.collect::<Vec<_>>().join(", ");
    let mapped = app
        .grid()
        .map_or_else(|| "regime".to_owned(), |grid| name_of(grid, app.mapped()));
    let (name, lines) = match app.map.shown_study() {
        Some(OpenStudy { study_map, .. }) => (
            format!("Study {}: {mapped}", study_map.name()),
            study_map.plan().lines,
        ),
        None => {
            let lines = app
                .studies
                .value::<Live>()
                .map_or(Plan::PROFILES_OF_MAP, |live| live.map.plan().lines);
            (format!("Map of {mapped}"), lines)
        }
    };
    let profiles = if lines == 1 {
        "1 profile".to_owned()
    } else {
        format!("{} profiles", grouped(lines))
    };
    format!("{name} over {over}, {profiles}")
}

fn nothing_yet(app: &App) -> String {
    if let Err(why) = Plan::of_map(app.edit.document.scene()) {
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

/// Short name of a quantity: its symbol, if no other quantity of the map has the same.
fn name_of(grid: &Grid, quantity: Quantity) -> String {
    if quantity.is_regime() {
        return format!("regime ({})", quantity.short_protocol());
    }
    let symbol = quantity.symbol();
    let is_only = grid
        .layers
        .iter()
        .filter(|layer| layer.quantity.symbol() == symbol)
        .count()
        == 1;
    if is_only && !symbol.is_empty() {
        symbol.to_owned()
    } else {
        quantity.name().replace('_', " ")
    }
}

/// Legend: label of the vertical axis, shades with their meaning, classes, and which map of the
/// study is shown.
fn legend(app: &App, chart: &Chart, width: usize) -> Vec<Line<'static>> {
    let (Some(grid), Some(map)) = (app.grid(), chart.map()) else {
        return Vec::new();
    };
    let look = app.view.appearance;
    let title = |text: String| Text::styled(text, look.theme.style(Meaning::Title));
    let mut parts = shades(chart, look, width);
    if app.mapped().is_regime() {
        parts.truncate(1);
        // From the densest: the regimes, and cells whose profiles are in one and the next.
        for (class, shade) in map.class_names.iter().zip(SHADES.iter().rev().step_by(2)) {
            let shade = Text::styled(*shade, in_theme(look, |style| (style.ink)(class.ink)));
            parts.push(vec![shade, Text::raw(format!(" {}", class.name))]);
        }
        if grid.is_split(app.mapped()) {
            parts.push(vec![Text::raw(format!(
                "{} {} profiles disagree",
                SHADES[3], SHADES[1]
            ))]);
        }
    } else {
        // The last name belongs to the boundary.
        parts.extend(entries(chart, look).pop().filter(|_| map.contour.is_some()));
    }
    let Some(study) = app.map.shown_study() else {
        return filled(parts, "  ", width);
    };
    let slices = study.study_map.slices();
    let mut slice: Vec<Part> = grid
        .fixed
        .iter()
        .map(|at| vec![title(at.clone())])
        .collect();
    if slices > 1 {
        let which = format!(
            "{} of {}, P: the next",
            grouped(study.slice + 1),
            grouped(slices)
        );
        slice.push(vec![Text::styled(which, look.theme.style(Meaning::Key))]);
    }
    let mut lines = filled(slice, "  ", width);
    lines.extend(filled(parts, "  ", width));
    lines
}

fn on_axes(grid: &Grid, (across, up): GridPlace) -> String {
    let on_axis = |axis: &Axis, value| {
        format!(
            "{} {}",
            axis.symbol_or_name(),
            format_rounded(value, 3, axis.unit)
        )
    };
    let up = grid
        .up
        .as_ref()
        .zip(up)
        .map(|(axis, value)| on_axis(axis, value));
    let parts: Vec<String> = [on_axis(&grid.across, across)]
        .into_iter()
        .chain(up)
        .collect();
    parts.join(", ")
}

/// Lines below the map: the position of the scene with the values of the nearest cell, and why the
/// map is incomplete or not that of the scene.
fn below(app: &App, grid: &Grid, width: u16) -> Vec<Line<'static>> {
    let study = app.map.shown_study();
    let is_of_scene = study.is_none_or(|study| {
        study
            .study_map
            .is_of(study.slice, app.edit.document.scene())
    });
    let mark = match app.place() {
        Some(place) => {
            let outside = if grid.contains(place) {
                ""
            } else {
                ", outside the map"
            };
            let cell = grid.nearest(place).map_or_else(
                || "not computed".to_owned(),
                |near| cell_values(app, grid, place, near),
            );
            format!("◆ {}{outside}: {cell}", on_axes(grid, place))
        }
        None => "no mark: the scene lacks a quantity of the axes".to_owned(),
    };
    let missing = match (study, app.studies.failure::<Live>()) {
        _ if !is_of_scene => Some(
            "the scene no longer belongs to the study: it differs in more than the quantities of the axes"
                .to_owned(),
        ),
        (None, Some(why)) => Some(format!("map incomplete: {why}")),
        (None, None) if app.studies.value::<Live>().is_some_and(|live| !live.map.is_whole()) => {
            Some("computing further cells…".to_owned())
        }
        _ => None,
    };
    let key = app.view.appearance.theme.style(Meaning::Key);
    let lines = [
        Some(Line::raw(mark)),
        missing.map(|missing| Line::styled(missing, key)),
    ];
    lines
        .into_iter()
        .flatten()
        .flat_map(|line| wrapped(&line, width))
        .collect()
}

fn deciding(regime: Quantity) -> [Quantity; 2] {
    let after_zero_force = usize::from(regime == Quantity::RegimeAfterZeroForce);
    [
        Quantity::ADHESION_SHARES[after_zero_force],
        Quantity::AdhesionCoefficient,
    ]
}

/// Quantities that are shown together: with a regime the quantities that decide it, if there are
/// any.
fn shown_quantities(mapped: Quantity, grid: &Grid) -> Vec<Quantity> {
    if !mapped.is_regime() {
        return vec![mapped];
    }
    let both: Vec<_> = deciding(mapped)
        .into_iter()
        .filter(|one| grid.layer(*one).is_some())
        .collect();
    let first = || grid.quantities().into_iter().find(|one| !one.is_regime());
    if both.is_empty() {
        vec![first().unwrap_or(mapped)]
    } else {
        both
    }
}

/// Values of the cell nearest to the mark, and its position unless the mark is there.
fn cell_values(
    app: &App,
    grid: &Grid,
    mark: GridPlace,
    (cell, column, row): (&Result<GridCell, String>, usize, usize),
) -> String {
    let place = (
        grid.across.values[column],
        grid.up.as_ref().map(|up| up.values[row]),
    );
    let at = on_axes(grid, place);
    let at = if at == on_axes(grid, mark) {
        String::new()
    } else {
        format!("at {at} ")
    };
    let cell = match cell {
        Ok(cell) => cell,
        Err(why) => return format!("{at}{why}"),
    };
    // Quantities of a regime are shown together, so that the map keeps its place.
    let mapped = app.mapped();
    let regime = Quantity::REGIMES
        .into_iter()
        .find(|regime| deciding(*regime).contains(&mapped));
    let mapped = regime.unwrap_or(mapped);
    let regimes = cell.regimes_of(mapped);
    let regime = regimes.most().map(|(regime, count)| {
        let lines = regimes.profiles() as u64;
        let share = if lines == 1 {
            String::new()
        } else {
            format!(
                " ({} of {} profiles)",
                grouped(count as u64),
                grouped(lines)
            )
        };
        format!("{} {}{share}", regime.name(), mapped.protocol())
    });
    let shown = shown_quantities(mapped, grid);
    let known = grid
        .layers
        .iter()
        .zip(&cell.statistics)
        .filter(|(layer, _)| shown.contains(&layer.quantity));
    let values = known.filter_map(|(layer, all)| {
        let quantity = layer.quantity;
        Some(format!(
            "{} {}",
            name_of(grid, quantity),
            value((*all)?, quantity.unit())
        ))
    });
    format!(
        "{at}{}",
        regime
            .into_iter()
            .chain(values)
            .collect::<Vec<_>>()
            .join(", ")
    )
}

/// A mean in words, with median and range if the profiles differ.
fn value(all: Statistics, unit: &str) -> String {
    let [mean, median] = [all.mean, all.quartiles[1]].map(|value| format_rounded(value, 2, unit));
    match all.range {
        (least, most) if least == most => mean,
        range => format!("{mean} (median {median}, {})", format_range(range, 2, unit)),
    }
}
