//! The curve: the hysteresis loop with its two branches, what is compared with it, and the hand.

use super::axes::{Axis, Places};
use super::plot::{Inside, Polyline, Span, Stroke};
use super::wrap::fitting;
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::explorer::model::{Ghost, Model, Quantities};
use crate::explorer::snapshot::Loop;
use crate::explorer::theme::{Marker, Meaning, Theme};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::Canvas;

/// Title of the pane.
pub fn title(model: &Model) -> String {
    let units = model.computed.as_ref().map(|computed| Units::of(model, computed));
    let name = match units.filter(Units::is_normalised) {
        Some(units) => units.title(),
        None => match model.curve.quantities {
            Quantities::ForceIndentation => "Force F(d)".to_owned(),
            Quantities::LengthForce => "Contact length l(F)".to_owned(),
            Quantities::FragmentsIndentation => "Fragments n(d)".to_owned(),
        },
    };
    let loss = if model.curve.loss && model.curve.quantities == Quantities::ForceIndentation {
        match model.computed.as_ref().and_then(|computed| computed.outcome.figures.dissipated_energy) {
            Some(energy) => format!(" · loss {}", format_quantity(short(energy), "J")),
            None => " · loss open".to_owned(),
        }
    } else {
        String::new()
    };
    let computing = if model.is_computing() { " · computing" } else { "" };
    format!(" {name}{loss}{computing} ")
}

/// In what the axes count: metres and newtons, or what governs the scene.
#[derive(Clone, Copy)]
struct Units {
    quantities: Quantities,
    indentation: Option<f64>,
    force: Option<f64>,
    /// Contact length of one spring.
    spring: f64,
    in_lengths: bool,
}

impl Units {
    fn of(model: &Model, computed: &Loop) -> Self {
        let outcome = &computed.outcome;
        let normalised = model.curve.normalised;
        let positive = |value: f64| Some(value).filter(|value| normalised && *value > 0.0);
        let height = outcome.governing.amplitude.map(|amplitude| amplitude.rms_height);
        Units {
            quantities: model.curve.quantities,
            indentation: height.and_then(positive),
            force: outcome.ideal_adhesion_force.and_then(positive),
            spring: outcome.line.spacing / if normalised { outcome.line.length } else { 1.0 },
            in_lengths: normalised,
        }
    }

    /// Whether any axis counts in other units than SI.
    fn is_normalised(&self) -> bool {
        match self.quantities {
            Quantities::ForceIndentation => self.indentation.is_some() || self.force.is_some(),
            Quantities::LengthForce => self.in_lengths,
            Quantities::FragmentsIndentation => self.indentation.is_some(),
        }
    }

    /// What stands over what, each in the unit it counts in: not every scene has an h or an F_a,max.
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
        let axis = |span, symbol, unit, normalised: bool| Axis {
            span,
            symbol,
            unit: if normalised { "1" } else { unit },
        };
        let indentation = |span| axis(span, "d", "m", self.indentation.is_some());
        let force = |span| axis(span, "F", "N", self.force.is_some());
        match self.quantities {
            Quantities::ForceIndentation => (indentation(x), force(y)),
            Quantities::LengthForce => (force(x), axis(y, "l", "m", self.in_lengths)),
            Quantities::FragmentsIndentation => (indentation(x), axis(y, "n", "1", false)),
        }
    }
}

/// What the pane spans: the curve, its ghosts and the way of the hand.
fn spans(model: &Model, units: Units) -> (Span, Span) {
    let ghosts = model.ghosts.iter().flat_map(|ghost| &ghost.computed.outcome.history.legs);
    let points = model.legs().iter().chain(ghosts).flat_map(|leg| &leg.curve);
    let hand = model.hand.iter().flat_map(|hand| &hand.path);
    let places: Vec<(f64, f64)> = points.chain(hand).map(|point| units.place(point)).collect();
    let x = Span::around(places.iter().map(|place| place.0), 0.06);
    let y = Span::around(places.iter().map(|place| place.1).chain([0.0]), 0.08);
    match units.quantities {
        Quantities::ForceIndentation => (x, y),
        // There is no negative length or number.
        Quantities::LengthForce | Quantities::FragmentsIndentation => (x, Span { low: 0.0, ..y }),
    }
}

/// Rows of text above the plot.
fn rows_above(model: &Model, area: Rect) -> u16 {
    match area.height {
        0..8 => 0,
        8..12 => 1,
        height => 2 + (model.ghosts.len() as u16).min(height / 5),
    }
}

/// The indentation under a column of the pane, m; `None` where that axis is not shown.
pub fn indentation_at(model: &Model, area: Rect, column: u16) -> Option<f64> {
    let computed = model.computed.as_ref()?;
    if model.curve.quantities == Quantities::LengthForce || model.indentations().is_none() {
        return None;
    }
    let units = Units::of(model, computed);
    let plot = Places::within(area, rows_above(model, area)).plot;
    let (x, _) = spans(model, units);
    let along = (f64::from(column) + 0.5 - f64::from(plot.x)) / f64::from(plot.width.max(1));
    let at = x.low + along.clamp(0.0, 1.0) * (x.high - x.low);
    Some(at * units.indentation.unwrap_or(1.0))
}

/// Draws the curve with its axes.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let shown = model.computed.as_ref().filter(|_| model.indentations().is_some());
    let Some(computed) = shown else {
        let text = if model.is_computing() { "computing…" } else { "no curve" };
        frame.render_widget(Paragraph::new(text).style(theme.style(Meaning::Quiet)), area);
        return;
    };
    let legs = model.legs();
    let above = rows_above(model, area);
    let places = Places::within(area, above);
    let units = Units::of(model, computed);
    let (x, y) = spans(model, units);
    let stale = !model.is_current();
    // A curve of a scene that has been changed since stands back until the new one is there.
    let colour = |meaning| theme.colour(if stale { Meaning::Quiet } else { meaning });
    let along =
        |points: &[CurvePoint]| -> Vec<(f64, f64)> { points.iter().map(|p| units.place(p)).collect() };
    let canvas = Canvas::default()
        .marker(model.appearance.marker.symbols())
        .x_bounds(x.bounds())
        .y_bounds(y.bounds())
        .paint(|ctx| {
            let zero = [(x.low, 0.0), (x.high, 0.0)];
            ctx.draw(&Polyline {
                points: &zero,
                colour: theme.colour(Meaning::Quiet),
                stroke: Stroke::Dotted,
            });
            if model.curve.loss && units.quantities == Quantities::ForceIndentation {
                let border: Vec<_> = legs.iter().flat_map(|leg| along(&leg.curve)).collect();
                ctx.draw(&Inside { border: &border, colour: theme.colour(Meaning::Quiet) });
            }
            for ghost in &model.ghosts {
                for leg in &ghost.computed.outcome.history.legs {
                    let points = along(&leg.curve);
                    ctx.draw(&Polyline {
                        points: &points,
                        colour: theme.colour(Meaning::Ghost),
                        stroke: Stroke::Sparse,
                    });
                }
            }
            for (direction, meaning, stroke) in [
                (Direction::Loading, Meaning::Approach, Stroke::Dotted),
                (Direction::Unloading, Meaning::Retraction, Stroke::Solid),
            ] {
                ctx.layer();
                for leg in legs.iter().filter(|leg| leg.direction == direction) {
                    ctx.draw(&Polyline { points: &along(&leg.curve), colour: colour(meaning), stroke });
                }
            }
            if let Some(hand) = &model.hand {
                ctx.layer();
                let colour = theme.colour(Meaning::Hand);
                ctx.draw(&Polyline { points: &along(&hand.path), colour, stroke: Stroke::Dashed });
            }
            let mut glyphs = Vec::new();
            if !stale {
                let title = theme.style(Meaning::Title);
                glyphs
                    .extend(marks(legs).iter().map(|(point, glyph, _)| (units.place(point), *glyph, title)));
            }
            if let Some(moment) = model.present() {
                let (at, value) = units.place(&moment.point);
                let at = (at.clamp(x.low, x.high), value.clamp(y.low, y.high));
                glyphs.push((at, "◆", theme.style(Meaning::Cursor)));
            }
            let mut cells = Cells { x, y, plot: places.plot, taken: Vec::new() };
            glyphs.iter().for_each(|&(at, ..)| cells.take(at));
            for (number, ghost) in model.ghosts.iter().enumerate() {
                if let Some(point) = marked(ghost) {
                    let at = cells.take_free(units.place(&point));
                    ctx.print(at.0, at.1, Line::styled(letter(number), theme.style(Meaning::Ghost)));
                }
            }
            for ((at, value), glyph, style) in glyphs {
                ctx.print(at, value, Line::styled(glyph, style));
            }
        });
    frame.render_widget(canvas, places.plot);
    let rows = [legend(model, area.width, &colour)];
    let rows = rows.into_iter().chain((!stale).then(|| values(legs, area.width, theme)));
    let ghosts = model.ghosts.iter().enumerate().rev().map(|(number, ghost)| {
        Line::styled(format!("{} {}", letter(number), ghost.differs), theme.style(Meaning::Ghost))
    });
    for (y, line) in (area.y..area.y + above).zip(rows.chain(ghosts)) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
    let (x, y) = units.axes(x, y);
    places.draw(frame, x, y, theme);
}

/// How the branches are told apart, as far as there is room.
fn legend(model: &Model, width: u16, colour: &dyn Fn(Meaning) -> ratatui::style::Color) -> Line<'static> {
    let theme = model.appearance.theme;
    let cursor = || Text::styled("◆", theme.style(Meaning::Cursor));
    let branch = |glyphs, meaning| Text::styled(glyphs, Style::new().fg(colour(meaning)));
    // Of what the plot is made of; ASCII is made from dots.
    let [approach, retraction, way] = match model.appearance.marker {
        Marker::Braille | Marker::Ascii => ["⠒ ⠒ ", "⠒⠒⠒ ", "⠒⠂⠒⠂"],
        Marker::Octant | Marker::HalfBlock => ["▄ ▄ ", "▄▄▄ ", "▄▖▄▖"],
    };
    let mut parts = vec![
        vec![branch(approach, Meaning::Approach), Text::raw("approach")],
        vec![branch(retraction, Meaning::Retraction), Text::raw("retraction")],
    ];
    if model.hand.is_some() {
        let way = Text::styled(way, theme.style(Meaning::Hand));
        parts.push(vec![way, cursor(), Text::raw(" manual")]);
    } else {
        parts.push(vec![cursor(), Text::raw(" now")]);
    }
    fitting(parts, "  ", usize::from(width))
}

/// Jump-in, preload and pull-off: where, with which glyph, and what it is called.
fn marks(legs: &[LegRecord]) -> Vec<(CurvePoint, &'static str, &'static str)> {
    let mut marks = Vec::new();
    let loading = || legs.iter().filter(|leg| leg.direction == Direction::Loading);
    let touch = loading().find(|leg| leg.curve.iter().any(|point| point.springs > 0));
    // Where the contact forms at once, under a pull.
    let jump = touch.and_then(|leg| {
        let pairs = leg.curve.windows(2).find(|pair| pair[0].springs == 0 && pair[1].springs > 0)?;
        Some(pairs[1]).filter(|point| point.force < 0.0)
    });
    marks.extend(jump.map(|point| (point, "◇", "jump-in")));
    let preload = loading().map(|leg| leg.largest).max_by(|a, b| a.force.total_cmp(&b.force));
    marks.extend(preload.filter(|point| point.springs > 0).map(|point| (point, "▲", "preload")));
    let unloading = legs.iter().rev().find(|leg| leg.direction == Direction::Unloading);
    let pull_off = unloading.map(|leg| leg.smallest).filter(|point| point.force < 0.0);
    marks.extend(pull_off.map(|point| (point, "▼", "pull-off")));
    marks
}

/// The marked forces with their values, in words where there is room. Where there is none for all, the
/// pull-off force stays longest.
fn values(legs: &[LegRecord], width: u16, theme: Theme) -> Line<'static> {
    let marks = marks(legs);
    let parts = |words: bool, from: usize| -> Vec<Vec<Text<'static>>> {
        let text = |&(point, glyph, name): &(CurvePoint, &'static str, &'static str)| {
            let force = format_quantity(short(point.force), "N");
            let name = if words { format!(" {name}") } else { String::new() };
            vec![Text::styled(glyph, theme.style(Meaning::Title)), Text::raw(format!("{name} {force}"))]
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

/// Where the letter of a ghost stands: at its pull-off force, or where it ends.
fn marked(ghost: &Ghost) -> Option<CurvePoint> {
    let legs = &ghost.computed.outcome.history.legs;
    let at = marks(legs).into_iter().next_back().map(|(point, ..)| point);
    at.or_else(|| legs.last().and_then(|leg| leg.curve.last().copied()))
}

/// Which cells of the plot have a glyph already, so that no letter hides behind one.
struct Cells {
    x: Span,
    y: Span,
    plot: Rect,
    taken: Vec<(i32, i32)>,
}

impl Cells {
    /// Column and row of a place, as the canvas counts them.
    fn cell(&self, (x, y): (f64, f64)) -> (i32, i32) {
        let part = |value: f64, low: f64, high: f64, cells: u16| {
            ((value - low) / (high - low) * f64::from(cells.max(1) - 1)) as i32
        };
        (
            part(x, self.x.low, self.x.high, self.plot.width),
            part(-y, -self.y.high, -self.y.low, self.plot.height),
        )
    }

    fn take(&mut self, at: (f64, f64)) {
        let cell = self.cell(at);
        self.taken.push(cell);
    }

    /// Takes the cell of a place, or the nearest one of its row that is free.
    fn take_free(&mut self, at: (f64, f64)) -> (f64, f64) {
        let (column, row) = self.cell(at);
        let last = i32::from(self.plot.width) - 1;
        let beside = (0..=last).flat_map(|step| [column + step, column - step]);
        let free = beside.filter(|column| (0..=last).contains(column));
        let free = free.map(|column| (column, row)).find(|cell| !self.taken.contains(cell));
        let Some((free, _)) = free.filter(|&(free, _)| free != column) else {
            self.taken.push((column, row));
            return at;
        };
        self.taken.push((free, row));
        // Well inside the cell.
        let share = (f64::from(free) + 0.25) / f64::from(last.max(1));
        ((self.x.low + share * (self.x.high - self.x.low)).min(self.x.high), at.1)
    }
}

fn letter(number: usize) -> &'static str {
    const LETTERS: [&str; 8] = ["A", "B", "C", "D", "E", "F", "G", "H"];
    LETTERS[number % LETTERS.len()]
}

/// The value to three digits.
fn short(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
