//! What is said of the map over κ and H: its title, what the glyphs tell, and what stands at the mark.

use super::regimes::{STEPS, glyph_between, glyph_of, meaning};
use super::wrap::{filled, wrapped};
use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE};
use crate::explorer::model::{Model, OpenStudy};
use crate::explorer::theme::Meaning;
use crate::scene::format_quantity;
use crate::study::Quantity;
use crate::study::figure::Estimate;
use crate::study::map::{Charted, Layer, Level, LiveMap, MapModel, Place, Template};
use crate::text::grouped;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};

/// From this height on there is room to say what the regimes are.
const ROOMY: u16 = 24;

/// Title of the pane: of what the map is the mean.
pub fn title(model: &Model) -> String {
    if let Some(study) = model.chart.shown_study() {
        let plan = study.study_map.plan();
        let (columns, rows) = model.chart.map_model().map(MapModel::size).unwrap_or_default();
        return format!(
            " Study {}: {columns} × {rows} cells, {} ",
            study.study_map.name(),
            lines(plan.lines)
        );
    }
    match Template::of(model.document.scene()) {
        Ok(template) => {
            let over = if template.has_hurst() { "κ, H" } else { "κ" };
            format!(
                " Map over {over}: {} of {} springs ",
                lines(template.lines()),
                grouped(template.springs())
            )
        }
        Err(_) => " Map over κ, H ".to_owned(),
    }
}

fn lines(count: u64) -> String {
    if count == 1 { "1 line".to_owned() } else { format!("{} lines", grouped(count)) }
}

/// Why there is no map.
pub fn nothing_yet(model: &Model) -> String {
    if let Err(why) = Template::of(model.document.scene()) {
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

/// The name of a quantity: its symbol, where no other quantity of the map has the same.
pub fn name_of(map_model: &MapModel, quantity: Quantity) -> String {
    let symbol = quantity.symbol();
    let is_only = map_model.layers().iter().filter(|layer| layer.quantity.symbol() == symbol).count() == 1;
    if is_only && !symbol.is_empty() { symbol.to_owned() } else { quantity.name().replace('_', " ") }
}

/// What the glyphs tell, and which map of a study it is.
pub fn legend(model: &Model, width: u16) -> Vec<Line<'static>> {
    let theme = model.appearance.theme;
    let width = usize::from(width);
    let Some(map_model) = model.chart.map_model() else { return Vec::new() };
    let mut parts: Vec<Vec<Text<'static>>> = Vec::new();
    match model.chart.charted() {
        Charted::Regime => {
            for regime in [Regime::PressureInsensitive, Regime::PressureSensitive, Regime::NonAdhesive] {
                let glyph = Text::styled(glyph_of(regime), theme.style(meaning(regime)));
                parts.push(vec![glyph, Text::raw(format!(" {}", regime.name()))]);
            }
            if map_model.is_split() {
                let glyphs = [Regime::PressureInsensitive, Regime::NonAdhesive]
                    .map(|regime| glyph_between(regime, Regime::PressureSensitive));
                parts.push(vec![Text::raw(format!("{} divided", glyphs.join(" ")))]);
            }
        }
        Charted::Quantity(quantity) => {
            parts.push(vec![Text::styled(name_of(map_model, quantity), theme.style(Meaning::Title))]);
            let steps = map_model.layer(quantity).map(|layer| layer.steps).unwrap_or_default();
            for (glyph, least) in STEPS.into_iter().zip(steps) {
                let least = format_quantity(least, quantity.unit());
                parts.push(vec![Text::raw(glyph), Text::raw(format!(" ≥ {least}"))]);
            }
        }
    }
    let mut lines = model.chart.shown_study().map_or_else(Vec::new, |study| slice(model, study, width));
    lines.extend(filled(parts, "  ", width));
    lines
}

/// Which map of a study it is, where it has several.
fn slice(model: &Model, study: &OpenStudy, width: usize) -> Vec<Line<'static>> {
    let (theme, slices) = (model.appearance.theme, study.study_map.slices());
    if slices == 1 {
        // Axes of one value.
        let at = study.study_map.stands_at(0).into_iter();
        return filled(
            at.map(|at| vec![Text::styled(at, theme.style(Meaning::Title))]).collect(),
            "  ",
            width,
        );
    }
    let at = study.study_map.stands_at(study.slice).into_iter();
    let which = Text::styled(
        format!("{} of {}, P: the next", grouped(study.slice + 1), grouped(slices)),
        theme.style(Meaning::Key),
    );
    let at = at.map(|at| vec![Text::styled(at, theme.style(Meaning::Title))]);
    filled(at.chain([vec![which]]).collect(), "  ", width)
}

/// A number to two digits.
fn short(value: f64, unit: &str) -> String {
    format_quantity(format!("{value:.1e}").parse().unwrap_or(value), unit)
}

/// A number to three digits.
pub fn number(value: f64) -> String {
    format_quantity(format!("{value:.2e}").parse().unwrap_or(value), "1")
}

/// What stands below the map, the most important first.
pub fn below(model: &Model, area: Rect) -> Vec<Line<'static>> {
    let Some(map_model) = model.chart.map_model() else { return Vec::new() };
    let theme = model.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    let study = model.chart.shown_study();
    match model.place() {
        Some((at_kappa, at_hurst)) => {
            say(here(model, map_model, at_kappa, at_hurst));
            if let Some(place) = map_model.nearest(at_kappa, at_hurst) {
                let value = |axis: &[f64], index: usize| axis.get(index).copied().map(number);
                let at_cell = (
                    value(&map_model.across().values, place.column),
                    map_model.up().and_then(|up| value(&up.values, place.row)),
                );
                let elsewhere = at_cell != (Some(number(at_kappa)), at_hurst.map(number));
                say(Line::raw(there(model, map_model, elsewhere.then_some(at_cell), &place)));
            } else if study.is_some() && at_hurst.is_some() {
                say(Line::raw("the study was merged without this cell"));
            }
        }
        None if study.is_some() => {
            let why = Template::of(model.document.scene()).err();
            let why = why.map_or_else(String::new, |why| why.to_string().replacen("no map", "no mark", 1));
            say(Line::styled(why, theme.style(Meaning::Quiet)));
        }
        None => {}
    }
    match study {
        Some(study) if !study.study_map.is_of(study.slice, model.document.scene()) => say(Line::styled(
            "the scene is no longer that of the study: more than κ and H differ",
            theme.style(Meaning::Key),
        )),
        Some(_) => {}
        None => computed_so_far(model, &mut say),
    }
    if area.height >= ROOMY {
        let note = study.map_or_else(note_of_computed, |study| note_of_study(study, map_model));
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// How far the map that is computed here has come.
fn computed_so_far(model: &Model, say: &mut impl FnMut(Line<'static>)) {
    let Some(map) = &model.chart.map else { return };
    let theme = model.appearance.theme;
    let sides = |level: Level| format!("{} × {} cells", level.columns().count(), map.rows_of(level).len());
    match (map.level(), &model.chart.failed) {
        (_, Some(why)) => say(Line::styled(format!("the map ends here: {why}"), theme.style(Meaning::Error))),
        (Some(_), None) if LiveMap::is_whole(map) => {}
        (Some(level), None) => {
            say(Line::styled(format!("{} so far…", sides(level)), theme.style(Meaning::Key)))
        }
        (None, None) => say(Line::styled("the coarse map first…", theme.style(Meaning::Key))),
    }
}

fn note_of_computed() -> String {
    format!(
        "Eq. (15) has the first boundary at κ ≈ 0.6. Pressure-insensitive: F_a(0) is at least {} % of F_a and {} % of that of the smooth body. \
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
        "A finished study of {}, from seed {}. {regimes}± is the 95 % confidence of the mean. ◆ is its scene on the first line; W shows the map that is \
         computed here around it, and this one again.",
        lines(plan.lines),
        plan.seed
    )
}

/// The scene itself.
fn here(model: &Model, map_model: &MapModel, at_kappa: f64, at_hurst: Option<f64>) -> Line<'static> {
    let hurst = at_hurst.map_or_else(String::new, |hurst| format!(", H {}", number(hurst)));
    let outside = if map_model.contains(at_kappa, at_hurst) { "" } else { ", outside the map" };
    let regime = model.computed.as_ref().filter(|_| model.is_current());
    let regime = regime.and_then(|computed| computed.outcome.regime);
    let regime = regime.map_or_else(String::new, |regime| format!(": {}", regime.name()));
    Line::from(vec![
        Text::styled("◆ ", model.appearance.theme.style(Meaning::Cursor)),
        Text::raw(format!("κ {}{hurst}{outside}{regime}", number(at_kappa))),
    ])
}

/// Quantities that go with the regime.
const WITH_REGIME: [Quantity; 2] = [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient];

/// The layers that are told together: with the regime those it follows from, as far as there are any, else the
/// one that the glyphs tell.
pub fn told(charted: Charted, map_model: &MapModel) -> Vec<&Layer> {
    match charted {
        Charted::Quantity(quantity) => map_model.layer(quantity).into_iter().collect(),
        Charted::Regime => {
            let both: Vec<_> = WITH_REGIME.into_iter().filter_map(|one| map_model.layer(one)).collect();
            if both.is_empty() { map_model.layers().first().into_iter().collect() } else { both }
        }
    }
}

/// What the map says there, or where it says it, in case that is not where the mark is.
fn there(
    model: &Model,
    map_model: &MapModel,
    at: Option<(Option<String>, Option<String>)>,
    place: &Place<'_>,
) -> String {
    let whose = if model.chart.shown_study().is_some() { "study" } else { "map" };
    let at = match at {
        Some((Some(kappa), hurst)) => {
            let hurst = hurst.map_or_else(String::new, |hurst| format!(", H {hurst}"));
            format!("{whose} at κ {kappa}{hurst}")
        }
        _ => whose.to_owned(),
    };
    let map_cell = match place.cell {
        Ok(map_cell) => map_cell,
        Err(why) => return format!("{at}: {why}"),
    };
    let agree = if map_cell.lines == 1 {
        String::new()
    } else {
        format!(" ({} of {} lines)", grouped(map_cell.agreeing), grouped(map_cell.lines))
    };
    let regime = map_cell.regime.map(|regime| format!("{}{agree}", regime.name()));
    // What goes with the regime is told together, so that the map keeps its place.
    let charted = match model.chart.charted() {
        Charted::Quantity(one) if WITH_REGIME.contains(&one) => Charted::Regime,
        other => other,
    };
    let values = told(charted, map_model).into_iter().filter_map(|layer| {
        let estimate = map_model.estimate(layer, place.column, place.row)?;
        let value = value(estimate, layer.quantity.unit());
        Some(format!("{} {value}", name_of(map_model, layer.quantity)))
    });
    format!("{at}: {}", regime.into_iter().chain(values).collect::<Vec<_>>().join(", "))
}

/// A mean, and its confidence where that is known.
fn value(Estimate { mean, low, high }: Estimate, unit: &str) -> String {
    if low == high {
        return short(mean, unit);
    }
    format!("{} ± {}", short(mean, unit), short((high - low) / 2.0, unit))
}
