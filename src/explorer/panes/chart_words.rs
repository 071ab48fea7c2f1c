//! Words of the map: its title, its legend, and the values at the mark.

use super::Pane;
use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, VANISHING_SHARE};
use crate::draw::{Chart, Colours, SHADES, key, legend as entries};
use crate::explorer::model::{Model, OpenStudy};
use crate::explorer::theme::Meaning;
use crate::explorer::view::plot;
use crate::explorer::view::wrap::{filled, wrapped};
use crate::scene::{RoughnessParameter, format_rounded};
use crate::study::Quantity;
use crate::study::figure::Estimate;
use crate::study::map::{Charted, Layer, Level, LiveMap, MapAxis, MapModel, Place, ShownCell, Template};
use crate::text::grouped;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};

/// Least height with room to explain the regimes.
const ROOMY: u16 = 24;

/// Title of the pane: the mapped quantity, the axes, and the number of profiles of the mean.
pub fn title(model: &Model) -> String {
    let template = Template::of(model.document.scene());
    let has_hurst = template.as_ref().is_ok_and(Template::has_hurst);
    let (across, up) = model.chart.axes(has_hurst);
    let over =
        up.map_or_else(|| across.symbol().to_owned(), |up| format!("{}, {}", across.symbol(), up.symbol()));
    let quantity = model
        .chart
        .map_model()
        .map_or_else(|| "regime".to_owned(), |map_model| charted_name(map_model, model.chart.charted()));
    let study = model.chart.shown_study().map(|study| (&study.study_map, study.study_map.plan().lines));
    match (study, template) {
        (Some((study_map, count)), _) => {
            format!(" Study {}: {quantity} over {over}, {} ", study_map.name(), profiles(count))
        }
        (None, Ok(template)) => format!(" Map of {quantity} over {over}, {} ", profiles(template.lines())),
        (None, Err(_)) => " Map ".to_owned(),
    }
}

/// The name of the regime or the charted quantity.
fn charted_name(map_model: &MapModel, charted: Charted) -> String {
    match charted {
        Charted::Regime => "regime".to_owned(),
        Charted::Quantity(quantity) => name_of(map_model, quantity),
    }
}

fn profiles(count: u64) -> String {
    if count == 1 { "1 profile".to_owned() } else { format!("{} profiles", grouped(count)) }
}

/// Reason why there is no map.
pub fn nothing_yet(model: &Model) -> String {
    if let Err(why) = Template::of(model.document.scene()) {
        return why.to_string();
    }
    if let Some(why) = model.failures.get(&Pane::Chart) {
        return format!("no map: {why}");
    }
    match (model.is_computing(), model.is_current()) {
        (true, _) => "first the scene itself…".to_owned(),
        (false, false) => "the scene cannot be computed, so there is no map around it".to_owned(),
        _ if !model.shows_times => "a map of so many springs is not computed here".to_owned(),
        _ => "computing the map, from coarse to fine…".to_owned(),
    }
}

/// The name of a quantity: its symbol, where unique on the map.
pub fn name_of(map_model: &MapModel, quantity: Quantity) -> String {
    let symbol = quantity.symbol();
    let is_only = map_model.layers().iter().filter(|layer| layer.quantity.symbol() == symbol).count() == 1;
    if is_only && !symbol.is_empty() { symbol.to_owned() } else { quantity.name().replace('_', " ") }
}

/// Axes, shades and their values, classes, and the slice of a study.
pub fn legend(model: &Model, chart: &Chart, width: u16) -> Vec<Line<'static>> {
    let theme = model.appearance.theme;
    let width = usize::from(width);
    let (Some(map_model), Some(map)) = (model.chart.map_model(), chart.map()) else { return Vec::new() };
    let up = format!("↑ {}", chart.y.label_with_unit());
    let mut parts = vec![vec![Text::styled(up, theme.style(Meaning::Title))]];
    match model.chart.charted() {
        Charted::Regime => {
            // From the densest: the regimes, and cells divided between one and the next.
            for (class, shade) in map.class_names.iter().zip(SHADES.iter().rev().step_by(2)) {
                let shade =
                    Text::styled(*shade, plot::in_theme(model.appearance, |style| (style.ink)(class.ink)));
                parts.push(vec![shade, Text::raw(format!(" {}", class.name))]);
            }
            if map_model.is_split() {
                parts.push(vec![Text::raw(format!("{} {} divided", SHADES[3], SHADES[1]))]);
            }
        }
        Charted::Quantity(_) => {
            let scale = key(map, width, Colours::None);
            let name = Text::styled(format!("{} ", map.key.label_with_unit()), theme.style(Meaning::Title));
            parts.push(
                std::iter::once(name).chain(scale.into_iter().map(|(text, _)| Text::raw(text))).collect(),
            );
            parts.extend(plot::in_theme(model.appearance, |style| {
                entries(std::slice::from_ref(chart), style)
            }));
        }
    }
    let mut lines = model.chart.shown_study().map_or_else(Vec::new, |study| slice(model, study, width));
    lines.extend(filled(parts, "  ", width));
    lines
}

/// Slice of a study with several maps.
fn slice(model: &Model, study: &OpenStudy, width: usize) -> Vec<Line<'static>> {
    let (theme, slices) = (model.appearance.theme, study.study_map.slices());
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
pub fn on_axis(axis: &MapAxis, value: f64) -> String {
    format!("{} {}", axis.symbol(), format_rounded(value, 3, &axis.figure.unit))
}

/// A place with the symbols of the axes.
fn on_axes(map_model: &MapModel, (across, up): Place) -> String {
    let up = map_model.up().zip(up).map(|(axis, value)| on_axis(axis, value));
    let parts: Vec<String> = [on_axis(map_model.across(), across)].into_iter().chain(up).collect();
    parts.join(", ")
}

/// Lines below the map, the most important first.
pub fn below(model: &Model, area: Rect) -> Vec<Line<'static>> {
    let Some(map_model) = model.chart.map_model() else { return Vec::new() };
    let theme = model.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    let study = model.chart.shown_study();
    match model.place() {
        Some(place) => {
            say(here(model, map_model, place));
            if let Some(shown) = map_model.nearest(place) {
                say(Line::raw(there(model, map_model, place, &shown)));
            } else if study.is_some() {
                say(Line::raw("the study was merged without this cell"));
            }
        }
        None if study.is_some() => {
            let why = Template::of(model.document.scene()).err();
            let no_mark = "no mark: the scene lacks a quantity of the axes".to_owned();
            let why = why.map_or(no_mark, |why| why.to_string().replacen("no map", "no mark", 1));
            say(Line::styled(why, theme.style(Meaning::Quiet)));
        }
        None => {}
    }
    match study {
        Some(study) if !study.study_map.is_of(study.slice, model.document.scene()) => say(Line::styled(
            "the scene is no longer that of the study: more differs than the quantities of the axes",
            theme.style(Meaning::Key),
        )),
        Some(_) => {}
        None => computed_so_far(model, &mut say),
    }
    if area.height >= ROOMY {
        let note = study.map_or_else(|| note_of_computed(model), |study| note_of_study(study, map_model));
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// Progress of the live map.
fn computed_so_far(model: &Model, say: &mut impl FnMut(Line<'static>)) {
    let Some(map) = &model.chart.map else { return };
    let theme = model.appearance.theme;
    let sides = |level: Level| format!("{} × {} cells", level.columns().count(), map.rows_of(level).len());
    match (map.level(), model.failures.get(&Pane::Chart)) {
        (_, Some(why)) => say(Line::styled(format!("the map ends here: {why}"), theme.style(Meaning::Error))),
        (Some(_), None) if LiveMap::is_whole(map) => {}
        (Some(level), None) => {
            say(Line::styled(format!("{} so far…", sides(level)), theme.style(Meaning::Key)))
        }
        (None, None) => say(Line::styled("the coarse map first…", theme.style(Meaning::Key))),
    }
}

fn note_of_computed(model: &Model) -> String {
    let cells = Template::of(model.document.scene()).map_or_else(
        |_| String::new(),
        |template| {
            format!("Each cell: {} of {} springs. ", profiles(template.lines()), grouped(template.springs()))
        },
    );
    let parameter = match model.chart.parameter() {
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

fn note_of_study(study: &OpenStudy, map_model: &MapModel) -> String {
    let regimes = if map_model.charted().contains(&Charted::Regime) {
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
fn here(model: &Model, map_model: &MapModel, place: Place) -> Line<'static> {
    let outside = if map_model.contains(place) { "" } else { ", outside the map" };
    let regime = model.current();
    let regime = regime.and_then(|computed| computed.outcome.regime);
    let regime = regime.map_or_else(String::new, |regime| format!(": {}", regime.name()));
    Line::from(vec![
        Text::styled("◆ ", model.appearance.theme.style(Meaning::Cursor)),
        Text::raw(format!("{}{outside}{regime}", on_axes(map_model, place))),
    ])
}

/// Quantities shown with the regime.
const WITH_REGIME: [Quantity; 2] = [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient];

/// Layers shown together: with the regime those that decide the regime, if any; else the layer of the
/// glyphs.
pub fn shown_layers(charted: Charted, map_model: &MapModel) -> Vec<&Layer> {
    match charted {
        Charted::Quantity(quantity) => map_model.layer(quantity).into_iter().collect(),
        Charted::Regime => {
            let both: Vec<_> = WITH_REGIME.into_iter().filter_map(|one| map_model.layer(one)).collect();
            if both.is_empty() { map_model.layers().first().into_iter().collect() } else { both }
        }
    }
}

/// Values of the map at a cell, with its place unless the cell is at the mark.
fn there(model: &Model, map_model: &MapModel, mark: Place, place: &ShownCell<'_>) -> String {
    let whose = if model.chart.shown_study().is_some() { "study" } else { "map" };
    let on = |axis: &MapAxis, index: usize| axis.figure.values.get(index).copied();
    let across = on(map_model.across(), place.column).unwrap_or(mark.0);
    let at = on_axes(map_model, (across, map_model.up().and_then(|up| on(up, place.row))));
    let at = if at == on_axes(map_model, mark) { whose.to_owned() } else { format!("{whose} at {at}") };
    let map_cell = match place.cell {
        Ok(map_cell) => map_cell,
        Err(why) => return format!("{at}: {why}"),
    };
    let agree = if map_cell.lines == 1 {
        String::new()
    } else {
        format!(" ({} of {} profiles)", grouped(map_cell.agreeing), grouped(map_cell.lines))
    };
    let regime = map_cell.regime.map(|regime| format!("{}{agree}", regime.name()));
    // Quantities of the regime are shown together, so that the map keeps its place.
    let charted = match model.chart.charted() {
        Charted::Quantity(one) if WITH_REGIME.contains(&one) => Charted::Regime,
        other => other,
    };
    let values = shown_layers(charted, map_model).into_iter().filter_map(|layer| {
        let estimate = map_model.estimate(layer, place.column, place.row)?;
        let value = value(estimate, layer.quantity.unit());
        Some(format!("{} {value}", name_of(map_model, layer.quantity)))
    });
    format!("{at}: {}", regime.into_iter().chain(values).collect::<Vec<_>>().join(", "))
}

/// A mean, with its confidence where known.
fn value(Estimate { mean, low, high }: Estimate, unit: &str) -> String {
    if low == high {
        return format_rounded(mean, 2, unit);
    }
    format!("{} ± {}", format_rounded(mean, 2, unit), format_rounded((high - low) / 2.0, 2, unit))
}
