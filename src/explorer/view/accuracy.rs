//! What accuracy costs: errors over times, both logarithmic, what it takes to be good, and what ran.

use super::axes::{Axis, Places};
use super::plot::{Polyline, Span, Stroke};
use super::stages;
use super::wrap::{filled, wrapped};
use crate::accuracy::{CostTable, ErrorFigure, Estimate, Evidence, Knob, Row};
use crate::explorer::model::{Estimated, Model};
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::{Edges, Numerics, Solver, format_quantity};
use crate::text::grouped;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::Canvas;

/// Title of the pane.
pub const TITLE: &str = " Accuracy: error over time, log–log ";

/// Relative errors that are answered for, and looked for in the plot.
const TARGETS: [(f64, &str); 2] = [(0.01, "1 %"), (0.001, "0.1 %")];

/// Errors below this stand in the lowest row.
const LOWEST: f64 = 1e-8;

/// Rows of plot that make it worth drawing.
const FEWEST_PLOT_ROWS: u16 = 4;

/// How a knob is drawn: its glyph, a colour that every theme tells from the others, its line, its short name.
struct Look {
    glyph: &'static str,
    meaning: Meaning,
    stroke: Stroke,
    name: &'static str,
}

fn look(knob: Knob) -> Look {
    let look = |glyph, meaning, stroke, name| Look { glyph, meaning, stroke, name };
    match knob {
        Knob::SubCellSprings => look("●", Meaning::Retraction, Stroke::Solid, "N, SubCell"),
        Knob::GridSprings => look("■", Meaning::Surface, Stroke::Dashed, "N, Grid"),
        Knob::Step => look("▲", Meaning::Hand, Stroke::Dotted, "step"),
        Knob::Samples => look("○", Meaning::Approach, Stroke::Dotted, "samples"),
        Knob::SinglePrecision => look("□", Meaning::Quiet, Stroke::Sparse, "single precision"),
        Knob::Lines => look("+", Meaning::Text, Stroke::Sparse, "lines"),
    }
}

/// A setting in the plot.
struct Point {
    /// Decades of s and of the error.
    at: (f64, f64),
    resolved: bool,
}

fn error_of(row: &Row) -> Option<ErrorFigure> {
    row.errors.adhesion_force.or(row.errors.curve)
}

fn point(row: &Row) -> Option<Point> {
    let ErrorFigure { error, resolved, .. } = error_of(row)?;
    let at = (row.seconds?.minimum.log10(), error.log10());
    (at.0.is_finite() && at.1.is_finite()).then_some(Point { at, resolved })
}

/// The knobs that are plotted, with their points.
fn series(table: &CostTable) -> Vec<(Knob, Vec<Point>)> {
    let of = |knob| (knob, table.rows_of(knob).filter_map(point).collect::<Vec<_>>());
    Knob::ALL.into_iter().map(of).filter(|(_, points)| !points.is_empty()).collect()
}

/// Draws plot, answers and stages, as far as there is room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let table = model.appraisal.costs.table.as_deref();
    let series = table.map(series).unwrap_or_default();
    let legend =
        table.map(|table| legend(table, &series, area.width, model.appearance.theme)).unwrap_or_default();
    let below = texts(model, table, &series, area);
    let room = area.height.saturating_sub(if series.is_empty() { 1 } else { FEWEST_PLOT_ROWS + 1 });
    let above = (legend.len() as u16).min(room);
    let text_rows = (below.len() as u16).min(room - above);
    let lines = |frame: &mut Frame<'_>, y: u16, rows: u16, lines: Vec<Line<'static>>| {
        for (y, line) in (y..y + rows).zip(lines) {
            frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
        }
    };
    let plot = Rect { y: area.y + above, height: area.height - above - text_rows, ..area };
    lines(frame, area.y, above, legend);
    lines(frame, plot.bottom(), text_rows, below);
    match table.filter(|_| !series.is_empty()) {
        Some(table) => draw_plot(frame, plot, model, table, &series),
        None => {
            let text = wrapped(
                &Line::styled(nothing_yet(model), model.appearance.theme.style(Meaning::Quiet)),
                area.width,
            );
            lines(frame, plot.y, plot.height, text);
        }
    }
}

/// Why there is no plot.
fn nothing_yet(model: &Model) -> String {
    let costs = &model.appraisal.costs;
    if model.is_computing() {
        return "first the scene itself…".to_owned();
    }
    match (&costs.ended, model.is_current()) {
        (_, false) => "the scene has no curve to estimate an error of".to_owned(),
        (Some(Err(why)), _) => format!("nothing is measured: {why}"),
        (Some(Ok(())), _) => {
            "nothing to show: no force in this scene whose error depends on springs, steps, samples or lines"
                .to_owned()
        }
        (None, _) if !model.shows_times => {
            "times are not measured here: they differ from run to run".to_owned()
        }
        (None, _) => "measuring: each knob from coarse to fine, as often as 10 s allow…".to_owned(),
    }
}

fn draw_plot(
    frame: &mut Frame<'_>,
    area: Rect,
    model: &Model,
    table: &CostTable,
    series: &[(Knob, Vec<Point>)],
) {
    let theme = model.appearance.theme;
    let all = || series.iter().flat_map(|(_, points)| points);
    let decades = |of: fn(&Point) -> f64| {
        let (low, high) = all()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        Span { low: low.floor(), high: high.ceil().max(low.floor() + 1.0) }
    };
    let (x, mut y) = (decades(|point| point.at.0), decades(|point| point.at.1));
    // Nobody needs to tell smaller errors apart.
    y.low = y.low.max(LOWEST.log10()).min(y.high - 1.0);
    let places = Places::within(area, 0);
    let now = present(&model.document.scene().numerics, table);
    let canvas = Canvas::default()
        .marker(model.appearance.marker.symbols())
        .x_bounds(x.bounds())
        .y_bounds(y.bounds())
        .paint(|ctx| {
            let quiet = theme.colour(Meaning::Quiet);
            for (target, _) in TARGETS {
                let level = target.log10();
                let line = [(x.low, level), (x.high, level)];
                if (y.low..=y.high).contains(&level) {
                    ctx.draw(&Polyline { points: &line, colour: quiet, stroke: Stroke::Sparse });
                }
            }
            for (knob, points) in series {
                let Look { meaning, stroke, .. } = look(*knob);
                let places: Vec<_> = points.iter().map(|point| (point.at.0, point.at.1.max(y.low))).collect();
                ctx.layer();
                ctx.draw(&Polyline { points: &places, colour: theme.colour(meaning), stroke });
            }
            for (target, name) in TARGETS {
                if (y.low..=y.high).contains(&target.log10()) {
                    ctx.print(x.low, target.log10(), Line::styled(name, theme.style(Meaning::Quiet)));
                }
            }
            for (knob, points) in series {
                let Look { glyph, meaning, .. } = look(*knob);
                for point in points {
                    let glyph = if point.resolved { glyph } else { "·" };
                    ctx.print(point.at.0, point.at.1.max(y.low), Line::styled(glyph, theme.style(meaning)));
                }
            }
            if let Some(now) = &now {
                ctx.print(now.at.0, now.at.1.max(y.low), Line::styled("◆", theme.style(Meaning::Cursor)));
            }
        });
    frame.render_widget(canvas, places.plot);
    let ends = |span: Span| Span { low: 10_f64.powf(span.low), high: 10_f64.powf(span.high) };
    places.draw(
        frame,
        Axis { span: ends(x), unit: "s", symbol: "t" },
        Axis { span: ends(y), unit: "1", symbol: "error" },
        theme,
    );
}

/// The knob that a scene has and the setting it has it at.
fn setting_of(numerics: &Numerics) -> (Knob, f64) {
    match (numerics.solver, numerics.edges) {
        (Solver::Stepwise { step }, _) => (Knob::Step, step),
        (Solver::Exact, Edges::Grid) => (Knob::GridSprings, numerics.points as f64),
        (Solver::Exact, Edges::SubCell) => (Knob::SubCellSprings, numerics.points as f64),
    }
}

/// Where the scene itself stands: at the row of its setting, or between those beside it. `None` where it was
/// not tried, and for steps on other springs than they were tried with.
fn present(numerics: &Numerics, table: &CostTable) -> Option<Point> {
    let (knob, setting) = setting_of(numerics);
    let mut rows: Vec<(f64, Point)> = table
        .rows_of(knob)
        .filter(|row| knob != Knob::Step || row.springs == numerics.points)
        .filter_map(|row| Some((row.setting.ln(), point(row)?)))
        .collect();
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    let at = setting.ln();
    let above = rows.iter().position(|(setting, _)| *setting >= at)?;
    let (right, there) = &rows[above];
    if *right == at {
        return Some(Point { at: there.at, resolved: there.resolved });
    }
    let (left, before) = rows.get(above.checked_sub(1)?)?;
    let share = (at - left) / (right - left);
    let between = |one: f64, other: f64| one + share * (other - one);
    let at = (between(before.at.0, there.at.0), between(before.at.1, there.at.1));
    Some(Point { at, resolved: before.resolved && there.resolved })
}

/// Which glyph is which knob, with its observed order.
fn legend(table: &CostTable, series: &[(Knob, Vec<Point>)], width: u16, theme: Theme) -> Vec<Line<'static>> {
    let mut parts: Vec<Vec<Text<'static>>> = Vec::new();
    for (knob, _) in series {
        let Look { glyph, meaning, name, .. } = look(*knob);
        let order = table.order(*knob).map_or_else(String::new, |order| format!(" order {order:.1}"));
        parts.push(vec![
            Text::styled(glyph, theme.style(meaning)),
            Text::raw(format!(" {name}")),
            Text::raw(order),
        ]);
    }
    let single = table.rows_of(Knob::SinglePrecision).next().and_then(error_of);
    if let Some(single) = single.filter(|_| !series.is_empty()) {
        let Look { name, .. } = look(Knob::SinglePrecision);
        parts.push(vec![Text::styled(format!("{name} {:.0e}", single.error), theme.style(Meaning::Quiet))]);
    }
    filled(parts, "  ", usize::from(width))
}

/// What stands below the plot, the most important first.
fn texts(
    model: &Model,
    table: Option<&CostTable>,
    series: &[(Knob, Vec<Point>)],
    area: Rect,
) -> Vec<Line<'static>> {
    let theme = model.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    if model.is_current() {
        say(now(model, table));
    }
    if let Some(table) = table.filter(|_| !series.is_empty()) {
        for (bound, percent) in TARGETS {
            if let Some(answer) = answer(table, bound, model.appraisal.costs.ended.is_some()) {
                let percent = Text::styled(format!("{percent}: "), theme.style(Meaning::Title));
                say(Line::from(vec![percent, Text::raw(answer)]));
            }
        }
    }
    if let Some((tolerance, trying)) = model.appraisal.choosing {
        let trying = trying.map_or_else(String::new, |points| format!(", {} springs", grouped(points)));
        say(Line::styled(format!("trying for {tolerance:e}{trying}…"), theme.style(Meaning::Key)));
    }
    if let Some(trying) = &model.appraisal.costs.trying {
        say(Line::styled(format!("trying {trying}…"), theme.style(Meaning::Key)));
    }
    if let Some(answer) = &model.appraisal.answer {
        say(Line::raw(answer.clone()));
    }
    let rows = if area.height >= 12 { 2 } else { 1 };
    lines.extend(stages::strip(model, area.width, rows));
    if let Some(table) = table.filter(|_| area.height >= 24 && !series.is_empty()) {
        let from = if table.reference.closed_form {
            "Errors of F_a are counted from its closed form".to_owned()
        } else {
            format!("Errors are counted from {} springs, edges SubCell", grouped(table.reference.springs))
        };
        let steps = table.rows_of(Knob::Step).next().map_or_else(String::new, |row| {
            format!("; of steps, from the exact solver on {} springs", grouped(row.springs))
        });
        let note = format!("{from}{steps}. · is below what they resolve.");
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// The setting of the scene, and how good it is.
fn now(model: &Model, table: Option<&CostTable>) -> Line<'static> {
    let theme = model.appearance.theme;
    let numerics = model.document.scene().numerics;
    let springs = grouped(numerics.points);
    let setting = match setting_of(&numerics) {
        (Knob::Step, step) => format!("{springs} springs, step {}", format_quantity(step, "m")),
        (Knob::GridSprings, _) => format!("{springs} springs, edges Grid"),
        _ => format!("{springs} springs, edges SubCell"),
    };
    let error = match &model.appraisal.estimated {
        Estimated::Waiting if model.shows_times => ", error …".to_owned(),
        Estimated::Waiting => String::new(),
        Estimated::Known(Estimate { error, evidence, .. }) => {
            let from = match evidence {
                Evidence::ClosedForm => " by the closed form".to_owned(),
                Evidence::Solutions(springs) => {
                    let springs: Vec<_> = springs.iter().map(|&springs| grouped(springs)).collect();
                    format!(" by {} springs", springs.join(", "))
                }
            };
            format!(", error {error:.1e}{from}")
        }
        Estimated::Unknown => ", error unknown".to_owned(),
    };
    let absent = table.is_some_and(|table| {
        model.appraisal.costs.ended.is_some() && !table.rows.is_empty() && present(&numerics, table).is_none()
    });
    let absent = if absent { "; not among those tried" } else { "" };
    Line::from(vec![
        Text::styled("◆ ", theme.style(Meaning::Cursor)),
        Text::raw(format!("{setting}{error}{absent}")),
    ])
}

/// What it takes to be within a bound; `None` while nothing can be said.
fn answer(table: &CostTable, bound: f64, finished: bool) -> Option<String> {
    let told = [(Knob::SubCellSprings, "SubCell"), (Knob::GridSprings, "Grid")].into_iter().filter_map(
        |(knob, edges)| {
            let finest = table.rows_of(knob).next_back();
            match (table.first_row_within(knob, bound), finest) {
                (Some(row), _) => {
                    let time = row.seconds.map_or_else(String::new, |time| {
                        let minimum = format!("{:.1e}", time.minimum).parse().unwrap_or(time.minimum);
                        format!(", {}", format_quantity(minimum, "s"))
                    });
                    Some(format!("{edges} {}{time}", grouped(row.springs)))
                }
                (None, Some(finest)) if finished => {
                    Some(format!("{edges} more than {}", grouped(finest.springs)))
                }
                _ => None,
            }
        },
    );
    let told: Vec<_> = told.collect();
    (!told.is_empty()).then(|| told.join("; "))
}
