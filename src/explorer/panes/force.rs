//! The curve: the hysteresis loop with its two branches, curves compared with it, and manual loading.

use super::{PaneRow, Place};
use crate::analysis::{LEAST_TABOR_NUMBER, Mark, marks};
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::draw::{CellPlot, Chart, Figure, Ink, Label, Layer, Shape, Sign, Stroke, glyph, legend};
use crate::explorer::app::{App, Ghost};
use crate::explorer::caption::caption;
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::request::ManualMove;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::update::{Effect, movement};
use crate::explorer::view::lines::{draw_lines, draw_reason};
use crate::explorer::view::plot;
use crate::explorer::view::wrap::fitting;
use crate::export::{ForceLoop, LoopQuantities, LoopUnits, loop_chart, sign};
use crate::scene::format_rounded;
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span as Text};

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title,
    draw,
    figure,
    edge,
    place: Place::Own,
    keys: Some(ModeKind::Crosshair),
    press: drag,
    drag,
    help: &[(
        "Curve",
        "F over indentation d: dotted while pressing, solid while pulling; ◇ jump-in, ▲ preload, ▼ pull-off, \
             ◆ now; letters and colours are ghosts, dashes are the path of manual loading",
    )],
    ..PaneRow::EMPTY
};

/// Title of the pane.
fn title(app: &App) -> String {
    let name = match app.view.curve.quantities {
        LoopQuantities::ForceIndentation => "Force",
        LoopQuantities::LengthForce => "Contact length",
        LoopQuantities::FragmentsIndentation => "Fragments",
    };
    // Not every scene has an h or an F_a,max.
    let (x, y) = units(app).symbols();
    let is_normalised = [&x, &y].iter().any(|symbol| symbol.contains('/'));
    let name = if is_normalised { format!("{name} {y} over {x}") } else { format!("{name} {y}({x})") };
    let loss = if app.view.curve.loss && app.view.curve.quantities == LoopQuantities::ForceIndentation {
        match app.solved.as_ref().and_then(|computed| computed.outcome.figures.dissipated_energy) {
            Some(energy) => {
                let number = app.solved.as_ref().and_then(|computed| computed.outcome.tabor_number);
                let number = number.map_or_else(String::new, |number| {
                    let low = if number < LEAST_TABOR_NUMBER {
                        format!(" < {LEAST_TABOR_NUMBER}")
                    } else {
                        String::new()
                    };
                    format!(", μ {}{low}", format_rounded(number, 3, "1"))
                });
                format!(" · loss {}{number}", format_rounded(energy, 3, "J"))
            }
            None => " · loss open".to_owned(),
        }
    } else {
        String::new()
    };
    let event = match caption(app) {
        _ if app.is_computing() => " · computing".to_owned(),
        Some(event) => format!(" · {event}"),
        None => String::new(),
    };
    format!(" {name}{loss}{event} ")
}

/// Units of the axes.
fn units(app: &App) -> LoopUnits {
    let quantities = app.view.curve.quantities;
    match app.solved.as_ref().filter(|_| app.view.curve.normalised) {
        Some(computed) => LoopUnits::of_scene(quantities, &computed.outcome),
        None => LoopUnits::si(quantities),
    }
}

/// Rows of text above the plot.
fn rows_above(app: &App, area: Rect) -> u16 {
    match area.height {
        0..8 => 0,
        8..12 => 1,
        height => 2 + (app.ghosts.len() as u16).min(height / 5),
    }
}

/// The indentation under a column of the pane, m; `None` where that axis is not shown.
pub fn indentation_at(app: &App, area: Rect, column: u16) -> Option<f64> {
    let chart = shown_chart(app)?;
    let at = CellPlot::within(below(area, rows_above(app, area)), &chart).number_at(&chart.x, column);
    units(app).indentation(at)
}

/// Loading stage and indentation, m, of the point of the curves nearest to a cell.
pub fn stage_at(app: &App, area: Rect, here: Position) -> Option<(usize, f64)> {
    let (chart, units) = (shown_chart(app)?, units(app));
    let place = CellPlot::within(below(area, rows_above(app, area)), &chart);
    let distance = |point: &CurvePoint| {
        let (column, row) = place.cell(&chart, app.view.appearance.marker.symbols(), units.place(point))?;
        // A row is about as high as two columns are wide.
        let (across, down) = (f64::from(column.abs_diff(here.x)), 2.0 * f64::from(row.abs_diff(here.y)));
        Some(across.hypot(down))
    };
    let points =
        app.legs().iter().enumerate().flat_map(|(leg, record)| record.curve.iter().map(move |at| (leg, at)));
    let near = points.filter_map(|(leg, point)| Some((distance(point)?, leg, point.indentation)));
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((nearest.1, nearest.2))
}

/// Drags the body to the indentation under the mouse.
fn drag(app: &mut App, area: Rect, here: Position) -> Vec<Effect> {
    if indentation_at(app, area, here.x).is_none() {
        return vec![Effect::Ask];
    }
    // Manual loading begins first: its axis may reach further than that of the loading, and the body is to be under
    // the mouse.
    let mut effects = if app.manual.is_none() { movement::take(app, None) } else { Vec::new() };
    effects.retain(|effect| *effect != Effect::Ask);
    if let Some(indentation) = indentation_at(app, area, here.x) {
        effects.extend(movement::take(app, Some(ManualMove::To(indentation))));
    }
    effects
}

/// Lower edge of the frame: readings of the crosshair, or the label of the force axis where no row above the plot
/// has the label.
fn edge(app: &App, area: Rect) -> Option<Line<'static>> {
    let is_read = app.view.crosshair.is_some() && app.present().is_some();
    let line = if is_read { reading(app)? } else { label(app, inside(area))? };
    Some(plot::on_frame(line, area.width))
}

/// Label of the vertical axis with its unit, in a pane without rows of text.
fn label(app: &App, area: Rect) -> Option<Vec<Vec<Text<'static>>>> {
    if rows_above(app, area) > 0 {
        return None;
    }
    let y = shown_chart(app)?.y;
    let style = app.view.appearance.theme.style(Meaning::Quiet);
    Some(vec![vec![Text::styled(y.label_with_unit().to_string(), style)]])
}

/// Readings of the crosshair.
fn reading(app: &App) -> Option<Vec<Vec<Text<'static>>>> {
    let point = app.present()?.point;
    let [d, length] = [point.indentation, point.contact_length].map(|value| format_rounded(value, 3, "m"));
    let mut parts = vec![
        format!("d {d}"),
        format!("F {}", format_rounded(point.force, 3, "N")),
        format!("l {length}"),
        format!("n {}", point.fragments),
    ];
    if app.manual.is_none() {
        parts.push(format!("stage {} of {}", app.play.leg + 1, app.legs().len()));
    }
    let style = app.view.appearance.theme.style(Meaning::Cursor);
    Some(parts.into_iter().map(|text| vec![Text::styled(text, style)]).collect())
}

fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

/// Draws the curve with its axes.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let theme = app.view.appearance.theme;
    let Some(chart) = shown_chart(app) else {
        let text = if app.is_computing() { "computing…" } else { "no curve" };
        return draw_reason(frame, area, text, theme);
    };
    let above = rows_above(app, area);
    let units = units(app);
    let place = plot::draw_chart(frame, below(area, above), &chart, app.view.appearance);
    draw_letters(frame, &place, &chart, app, units);
    if app.is_current() {
        let marks = marks(app.legs());
        let names: Vec<_> = marks.iter().map(|(mark, point)| (units.place(point), mark.name())).collect();
        plot::in_theme(app.view.appearance, |style| {
            place.draw_names(frame.buffer_mut(), &chart, style, &names)
        });
    }
    let legend = plot::in_theme(app.view.appearance, |style| legend(std::slice::from_ref(&chart), style));
    let mut parts =
        vec![vec![Text::styled(chart.y.label_with_unit().to_string(), theme.style(Meaning::Quiet))]];
    parts.extend(legend);
    let rows = [plot::spaced(parts, usize::from(area.width))];
    let values = app.is_current().then(|| values(app.legs(), area.width, theme));
    let ghosts = app.ghosts.iter().enumerate().rev().map(|(number, ghost)| {
        let force = adhesion(app, ghost).map_or_else(String::new, |force| format!(" {force} ·"));
        let style = theme.style(plot::meaning(Ink::Compared(number)));
        Line::styled(format!("{}{force} {}", letter(number), ghost.differs), style)
    });
    let above = Rect { height: above.min(area.height), ..area };
    draw_lines(frame, above, rows.into_iter().chain(values).chain(ghosts));
}

/// The figure of the chart.
fn figure(app: &App) -> Option<Figure> {
    Some(Figure::of_chart(app.edit.document.title(), chart(app)?))
}

/// The chart without names that the pane writes elsewhere: those of marks and ghosts, and those of the axes.
fn shown_chart(app: &App) -> Option<Chart> {
    let mut chart = chart(app)?;
    // A ghost beside the scene is named with the curves; the others have their letters.
    let beside = app.beside().map(|_| app.ghosts.len() - 1);
    for layer in &mut chart.layers {
        layer.name = match layer.ink {
            Ink::Text => Label::default(),
            Ink::Compared(number) if beside == Some(number) => letter(number).into(),
            Ink::Compared(_) => Label::default(),
            _ => continue,
        };
    }
    for axis in [&mut chart.x, &mut chart.y] {
        axis.label = axis.label.without_name();
    }
    Some(chart)
}

/// The curve, curves compared with it, the path of manual loading, and marks.
fn chart(app: &App) -> Option<Chart> {
    app.indentations()?;
    let units = units(app);
    let unmarked = |legs| ForceLoop { marks: Vec::new(), ..ForceLoop::new(legs) };
    let ghosts = app.ghosts.iter().enumerate().map(|(number, ghost)| ForceLoop {
        name: Some(Label::plain(&format!("{}: {}", letter(number), ghost.differs))),
        ink: Some(Ink::Compared(number)),
        stroke: Some(Stroke::Sparse),
        ..unmarked(&ghost.computed.outcome.history.legs)
    });
    let tried = app.tried_outcome().map(|outcome| ForceLoop {
        name: Some("preview".into()),
        ink: Some(Ink::Kept),
        stroke: Some(Stroke::Dashed),
        ..unmarked(&outcome.history.legs)
    });
    let legs = app.legs();
    // A curve of a scene changed since stays in the background until the new one is there.
    let present = match app.is_current() {
        true => ForceLoop::new(legs),
        false => ForceLoop { ink: Some(Ink::Quiet), ..unmarked(legs) },
    };
    let manual = app.manual.as_ref().map(|manual| ForceLoop {
        curves: vec![(Direction::Unloading, &manual.path)],
        name: Some("manual".into()),
        ink: Some(Ink::Manual),
        stroke: Some(Stroke::Dashed),
        ..unmarked(&[])
    });
    let loops: Vec<ForceLoop<'_>> = ghosts.chain(tried).chain([present]).chain(manual).collect();
    let mut chart = loop_chart(&loops, units);
    // Below the curves, which stay whole.
    if app.view.curve.loss && app.view.curve.quantities == LoopQuantities::ForceIndentation {
        let border = legs.iter().flat_map(|leg| &leg.curve).map(|point| units.place(point)).collect();
        chart.layers.insert(1, Layer::unnamed(Ink::Quiet, Shape::Inside(border)));
    }
    if let Some(snapshot) = app.present() {
        let (x, y) = units.place(&snapshot.point);
        let at = (x.clamp(chart.x.span.low, chart.x.span.high), y.clamp(chart.y.span.low, chart.y.span.high));
        if app.view.crosshair.is_some() {
            let lines = [Shape::Upright(at.0), Shape::Level(at.1)];
            chart.layers.splice(0..0, lines.map(|line| Layer::unnamed(Ink::Cursor, line)));
        }
        let name = if app.manual.is_some() { "manual" } else { "now" };
        chart.layers.push(Layer::new(name.into(), Ink::Cursor, Shape::signs(vec![at], Sign::Diamond)));
    }
    Some(chart)
}

/// Share of the largest force below which a force is rounding.
const ROUNDING: f64 = 1e-12;

/// The marked forces with their values, in words where there is room. Without room for all, the
/// pull-off force stays longest.
fn values(legs: &[LegRecord], width: u16, theme: Theme) -> Line<'static> {
    let marks = marks(legs);
    let largest = marks.iter().map(|(_, point)| point.force.abs()).fold(0.0, f64::max);
    let parts = |words: bool, from: usize| -> Vec<Vec<Text<'static>>> {
        let text = |&(mark, point): &(Mark, CurvePoint)| {
            // A stage to zero force ends there but for rounding.
            let is_zero = point.force.abs() < ROUNDING * largest;
            let force = format_rounded(if is_zero { 0.0 } else { point.force }, 3, "N");
            let name = if words { format!(" {}", mark.name()) } else { String::new() };
            vec![
                Text::styled(glyph(sign(mark)), theme.style(Meaning::Title)),
                Text::raw(format!("{name} {force}")),
            ]
        };
        marks.iter().skip(from).map(text).collect()
    };
    let forms = [(true, 0)].into_iter().chain((0..marks.len()).map(|from| (false, from)));
    let width = usize::from(width);
    forms
        .map(|(words, from)| fitting(parts(words, from), "  ", usize::MAX))
        .find(|line| line.width() <= width)
        .unwrap_or_default()
}

/// Point of the letter of a ghost: its pull-off, or its end.
fn marked(ghost: &Ghost) -> Option<CurvePoint> {
    let legs = &ghost.computed.outcome.history.legs;
    let at = marks(legs).into_iter().rev().find(|(mark, _)| *mark != Mark::JumpOut).map(|(_, point)| point);
    at.or_else(|| legs.last().and_then(|leg| leg.curve.last().copied()))
}

/// Adhesion force of a ghost, and its difference from that of the present scene: `F_a 12 µN (+3 µN)`.
fn adhesion(app: &App, ghost: &Ghost) -> Option<String> {
    let of = |computed: &SolvedScene| computed.outcome.figures.adhesion_force;
    let force = of(&ghost.computed)?;
    let present = app.current().and_then(|one| of(one));
    let difference = present.map_or_else(String::new, |present| {
        let sign = if force > present { "+" } else { "" };
        format!(" ({sign}{})", format_rounded(force - present, 3, "N"))
    });
    Some(format!("F_a {}{difference}", format_rounded(force, 3, "N")))
}

/// Draws the letters of ghosts, each in the nearest cell of its row without a sign.
fn draw_letters(frame: &mut Frame<'_>, place: &CellPlot, chart: &Chart, app: &App, units: LoopUnits) {
    let marker = app.view.appearance.marker.symbols();
    let signs = chart.layers.iter().filter_map(|layer| match &layer.shape {
        Shape::Curve { points, sign: Some(_), .. } => points.first(),
        _ => None,
    });
    let mut taken: Vec<(u16, u16)> = signs.filter_map(|at| place.cell(chart, marker, *at)).collect();
    let columns = place.plot.x..place.plot.right();
    for (number, ghost) in app.ghosts.iter().enumerate() {
        let at = marked(ghost).and_then(|point| place.cell(chart, marker, units.place(&point)));
        let Some((column, row)) = at else { continue };
        let beside = (0..place.plot.width).flat_map(|step| [column + step, column.wrapping_sub(step)]);
        let mut free = beside.filter(|column| columns.contains(column)).map(|column| (column, row));
        let cell = free.find(|cell| !taken.contains(cell)).unwrap_or((column, row));
        taken.push(cell);
        let style = app.view.appearance.theme.style(plot::meaning(Ink::Compared(number)));
        frame.buffer_mut()[cell].set_symbol(letter(number)).set_style(style);
    }
}

/// Letter of the newest ghost.
pub fn newest_letter(app: &App) -> &'static str {
    letter(app.ghosts.len().saturating_sub(1))
}

fn letter(number: usize) -> &'static str {
    const LETTERS: [&str; 8] = ["A", "B", "C", "D", "E", "F", "G", "H"];
    LETTERS[number % LETTERS.len()]
}
