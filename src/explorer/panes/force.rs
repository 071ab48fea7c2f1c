//! The curve: the hysteresis loop with its two branches, curves compared with it, and manual loading.

use super::{PaneRow, Place};
use crate::analysis::{LEAST_TABOR_NUMBER, Mark, marks};
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::draw::{
    Axis, AxisScale, CellPlot, Chart, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke, glyph, legend,
};
use crate::explorer::app::{App, Ghost, Quantities};
use crate::explorer::caption::caption;
use crate::explorer::keys::Context;
use crate::explorer::layout::inside;
use crate::explorer::request::ManualMove;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::update::{Effect, movement};
use crate::explorer::view::lines::{draw_lines, draw_reason};
use crate::explorer::view::plot;
use crate::explorer::view::wrap::fitting;
use crate::export::{mark_name, sign};
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
    keys: Some(Context::Crosshair),
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
    let units = app.solved.as_ref().map(|computed| Units::of(app, computed));
    let name = match units.filter(Units::is_normalised) {
        Some(units) => units.title(),
        None => match app.view.curve.quantities {
            Quantities::ForceIndentation => "Force F(d)".to_owned(),
            Quantities::LengthForce => "Contact length l(F)".to_owned(),
            Quantities::FragmentsIndentation => "Fragments n(d)".to_owned(),
        },
    };
    let loss = if app.view.curve.loss && app.view.curve.quantities == Quantities::ForceIndentation {
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

/// Units of the axes: metres and newtons, or parameters of the scene.
#[derive(Clone, Copy)]
struct Units {
    quantities: Quantities,
    indentation: Option<f64>,
    force: Option<f64>,
    /// Contact length of one spring, m.
    spring: f64,
    in_lengths: bool,
}

impl Units {
    fn of(app: &App, computed: &SolvedScene) -> Self {
        let outcome = &computed.outcome;
        let normalised = app.view.curve.normalised;
        let positive = |value: f64| Some(value).filter(|value| normalised && *value > 0.0);
        let height = outcome.governing.amplitude.map(|amplitude| amplitude.rms_height);
        Units {
            quantities: app.view.curve.quantities,
            indentation: height.and_then(positive),
            force: outcome.ideal_adhesion_force.and_then(positive),
            spring: outcome.line.spacing / if normalised { outcome.line.length } else { 1.0 },
            in_lengths: normalised,
        }
    }

    /// Returns true if any axis has other units than SI.
    fn is_normalised(&self) -> bool {
        match self.quantities {
            Quantities::ForceIndentation => self.indentation.is_some() || self.force.is_some(),
            Quantities::LengthForce => self.in_lengths,
            Quantities::FragmentsIndentation => self.indentation.is_some(),
        }
    }

    /// Quantities of the axes with their units: not every scene has an h or an F_a,max.
    fn title(&self) -> String {
        let indentation = if self.indentation.is_some() { "d/h" } else { "d" };
        let force = if self.force.is_some() { "F/F_a,max" } else { "F" };
        match self.quantities {
            Quantities::ForceIndentation => format!("Force {force} over {indentation}"),
            Quantities::LengthForce => format!("Contact length l/L over {force}"),
            Quantities::FragmentsIndentation => format!("Fragments n over {indentation}"),
        }
    }

    fn place(&self, point: &CurvePoint) -> (f64, f64) {
        let indentation = point.indentation / self.indentation.unwrap_or(1.0);
        let force = point.force / self.force.unwrap_or(1.0);
        match self.quantities {
            Quantities::ForceIndentation => (indentation, force),
            Quantities::LengthForce => (force, point.springs as f64 * self.spring),
            Quantities::FragmentsIndentation => (indentation, point.fragments as f64),
        }
    }

    fn axes(&self, x: Span, y: Span) -> (Axis, Axis) {
        let axis = |span, symbol: &str, over: &str, unit: &str, normalised: bool| {
            let (symbol, unit) =
                if normalised { (format!("{symbol}/{over}"), "1") } else { (symbol.to_owned(), unit) };
            Axis::new(AxisScale::Linear, span, "", &symbol, unit)
        };
        let indentation = |span| axis(span, "d", "h", "m", self.indentation.is_some());
        let force = |span| axis(span, "F", "F_a,max", "N", self.force.is_some());
        match self.quantities {
            Quantities::ForceIndentation => (indentation(x), force(y)),
            Quantities::LengthForce => (force(x), axis(y, "l", "L", "m", self.in_lengths)),
            Quantities::FragmentsIndentation => (indentation(x), axis(y, "n", "", "1", false)),
        }
    }
}

/// Ranges of the pane: the curve, kept curves and the path of manual loading.
fn spans(app: &App, units: Units) -> (Span, Span) {
    let ghosts = app.ghosts.iter().flat_map(|ghost| &ghost.computed.outcome.history.legs);
    let tried = app.tried_outcome().into_iter().flat_map(|outcome| &outcome.history.legs);
    let points = app.legs().iter().chain(ghosts).chain(tried).flat_map(|leg| &leg.curve);
    let manual = app.manual.iter().flat_map(|manual| &manual.path);
    let places: Vec<(f64, f64)> = points.chain(manual).map(|point| units.place(point)).collect();
    let x = Span::around(places.iter().map(|place| place.0), 0.06);
    let y = Span::around(places.iter().map(|place| place.1).chain([0.0]), 0.08);
    match units.quantities {
        Quantities::ForceIndentation => (x, y),
        // There is no negative length or number.
        _ => (x, Span { low: 0.0, ..y }),
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
    let computed = app.solved.as_ref()?;
    if app.view.curve.quantities == Quantities::LengthForce || app.indentations().is_none() {
        return None;
    }
    let units = Units::of(app, computed);
    let (x, y) = spans(app, units);
    let (x, y) = units.axes(x, y);
    let chart = Chart::new(x, y, Vec::new());
    let at = CellPlot::within(below(area, rows_above(app, area)), &chart).number_at(&chart.x, column);
    Some(at * units.indentation.unwrap_or(1.0))
}

/// Loading stage and indentation, m, of the point of the curves nearest to a cell.
pub fn stage_at(app: &App, area: Rect, here: Position) -> Option<(usize, f64)> {
    let computed = app.solved.as_ref()?;
    let units = Units::of(app, computed);
    let (x, y) = spans(app, units);
    let (x, y) = units.axes(x, y);
    let chart = Chart::new(x, y, Vec::new());
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
    let computed = app.solved.as_ref().filter(|_| rows_above(app, area) == 0)?;
    app.indentations()?;
    let units = Units::of(app, computed);
    let (x, y) = spans(app, units);
    let (_, y) = units.axes(x, y);
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
    let shown = app.solved.as_ref().filter(|_| app.indentations().is_some());
    let Some(computed) = shown else {
        let text = if app.is_computing() { "computing…" } else { "no curve" };
        return draw_reason(frame, area, text, theme);
    };
    let above = rows_above(app, area);
    let units = Units::of(app, computed);
    let chart = chart(app, units);
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

/// The chart with names for the marks and the compared curves, which the pane writes beside it.
fn figure(app: &App) -> Option<Figure> {
    let computed = app.solved.as_ref().filter(|_| app.indentations().is_some())?;
    let mut chart = chart(app, Units::of(app, computed));
    let mut marks = marks(app.legs()).into_iter();
    for layer in chart.layers.iter_mut().filter(|layer| layer.name.is_empty()) {
        layer.name = match (layer.ink, &layer.shape) {
            (Ink::Compared(number), _) => {
                let ghost = app.ghosts.get(number)?;
                Label::plain(&format!("{}: {}", letter(number), ghost.differs))
            }
            (Ink::Text, Shape::Curve { sign: Some(_), .. }) => {
                let (mark, point) = marks.next()?;
                mark_name(mark, point.force)
            }
            _ => continue,
        };
    }
    Some(Figure::of_chart(app.edit.document.title(), chart))
}

/// The curve, curves compared with it, the path of manual loading, and marks.
fn chart(app: &App, units: Units) -> Chart {
    // A curve of a scene changed since stays in the background until the new one is there.
    let stale = !app.is_current();
    let ink = |ink| if stale { Ink::Quiet } else { ink };
    let legs = app.legs();
    let along =
        |points: &[CurvePoint]| -> Vec<(f64, f64)> { points.iter().map(|p| units.place(p)).collect() };
    let line = Shape::line;
    let point = |at, sign| Shape::signs(vec![at], sign);
    let mut layers = vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))];
    if app.view.curve.loss && units.quantities == Quantities::ForceIndentation {
        let border = legs.iter().flat_map(|leg| along(&leg.curve)).collect();
        layers.push(Layer::unnamed(Ink::Quiet, Shape::Inside(border)));
    }
    for (number, ghost) in app.ghosts.iter().enumerate() {
        // A ghost beside the scene is named with the curves; the others have their letters.
        let is_beside = app.beside().is_some() && number + 1 == app.ghosts.len();
        let name = if is_beside { letter(number).into() } else { Label::default() };
        for leg in &ghost.computed.outcome.history.legs {
            layers.push(Layer::new(
                name.clone(),
                Ink::Compared(number),
                line(along(&leg.curve), Stroke::Sparse),
            ));
        }
    }
    for leg in app.tried_outcome().into_iter().flat_map(|outcome| &outcome.history.legs) {
        layers.push(Layer::new("preview".into(), Ink::Kept, line(along(&leg.curve), Stroke::Dashed)));
    }
    let (x, y) = spans(app, units);
    for (direction, name, of, stroke) in [
        (Direction::Loading, "loading", Ink::Loading, Stroke::Dotted),
        (Direction::Unloading, "unloading", Ink::Unloading, Stroke::Solid),
    ] {
        for leg in legs.iter().filter(|leg| leg.direction == direction) {
            layers.push(Layer::new(name.into(), ink(of), line(along(&leg.curve), stroke)));
        }
    }
    if let Some(manual) = &app.manual {
        layers.push(Layer::new("manual".into(), Ink::Manual, line(along(&manual.path), Stroke::Dashed)));
    }
    let marks = marks(legs).into_iter().filter(|_| !stale);
    layers.extend(marks.map(|(mark, at)| Layer::unnamed(Ink::Text, point(units.place(&at), sign(mark)))));
    if let Some(snapshot) = app.present() {
        let (at, value) = units.place(&snapshot.point);
        let at = (at.clamp(x.low, x.high), value.clamp(y.low, y.high));
        if app.view.crosshair.is_some() {
            let lines = [Shape::Upright(at.0), Shape::Level(at.1)];
            // Below the curves, which stay whole.
            layers.splice(0..0, lines.map(|line| Layer::unnamed(Ink::Cursor, line)));
        }
        let name = if app.manual.is_some() { "manual" } else { "now" };
        layers.push(Layer::new(Label::plain(name), Ink::Cursor, point(at, Sign::Diamond)));
    }
    let (x, y) = units.axes(x, y);
    Chart::new(x, y, layers)
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
fn draw_letters(frame: &mut Frame<'_>, place: &CellPlot, chart: &Chart, app: &App, units: Units) {
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
