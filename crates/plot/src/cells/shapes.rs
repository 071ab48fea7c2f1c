//! Layers of a chart as Braille dots on a canvas with coordinates from 0 to 1.

use crate::axis::{Axes, Share};
use crate::chart::{Chart, Shape, Sign, Stroke};
use crate::colour::Ink;
use ratatui::style::Color;
use ratatui::widgets::canvas::{Painter, Shape as CanvasShape};

pub(super) struct LayerShape<'a> {
    pub chart: &'a Chart,
    pub shape: &'a Shape,
    pub ink: Ink,
    pub colour: Color,
}

/// Column and row of a dot.
type Dot = (usize, usize);

impl LayerShape<'_> {
    fn axes(&self) -> Axes<'_> {
        Axes {
            x: &self.chart.x,
            y: &self.chart.y,
        }
    }

    fn paint(&self, painter: &mut Painter<'_, '_>, (x, y): Dot) {
        painter.paint(x, y, self.colour);
    }

    fn lines(&self, painter: &mut Painter<'_, '_>, runs: &[Vec<Share>], stroke: Stroke) {
        let mut painted = 0_usize;
        for run in runs {
            let dots: Vec<Dot> = run
                .iter()
                .filter_map(|(x, y)| painter.get_point(*x, *y))
                .collect();
            for (index, dot) in dots.iter().enumerate() {
                for dot in between(dots[index.saturating_sub(1)], *dot) {
                    if paints(stroke, painted) {
                        self.paint(painter, dot);
                    }
                    painted += 1;
                }
            }
        }
    }

    /// Paints one dot for each point.
    fn points(&self, painter: &mut Painter<'_, '_>, points: &[(f64, f64)]) {
        for (x, y) in points.iter().filter_map(|point| self.axes().place(*point)) {
            if let Some(dot) = painter.get_point(x, y) {
                self.paint(painter, dot);
            }
        }
    }

    /// Returns the dots of the area inside a closed line: every other dot, or one of eight in the
    /// quiet ink. A dot is inside if the line crosses the column below it an odd number of times.
    fn inside(&self, painter: &mut Painter<'_, '_>, border: &[(f64, f64)]) {
        let is_shaded = |column: usize, row: usize| match self.ink {
            Ink::Quiet => column.is_multiple_of(2) && (column / 2 + row).is_multiple_of(4),
            _ => (column + row).is_multiple_of(2),
        };
        let Some((last, _)) = painter.get_point(1.0, 0.0) else {
            return;
        };
        // A zero on a logarithmic axis is far below the chart.
        let share = |(x, y): &(f64, f64)| {
            (
                self.chart.x.share(*x),
                self.chart.y.share(*y).clamp(-9.0, 9.0),
            )
        };
        let shares: Vec<(f64, f64)> = border.iter().map(share).collect();
        let ends = || shares.iter().zip(shares.iter().cycle().skip(1));
        for column in 0..=last {
            let x = column as f64 / last.max(1) as f64;
            let mut crossings: Vec<f64> = ends()
                .filter(|(a, b)| (a.0 <= x) != (b.0 <= x))
                .map(|(a, b)| a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0))
                .filter(|y| y.is_finite())
                .collect();
            crossings.sort_unstable_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let row = |y: f64| painter.get_point(x, y.clamp(0.0, 1.0)).map(|(_, row)| row);
                let (Some(low), Some(high)) = (row(pair[0]), row(pair[1])) else {
                    continue;
                };
                (high..=low)
                    .filter(|y| is_shaded(column, *y))
                    .for_each(|y| self.paint(painter, (column, y)));
            }
        }
    }
}

impl CanvasShape for LayerShape<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        match self.shape {
            Shape::Curve {
                points,
                stroke: None,
                sign: Some(Sign::Point),
            } => self.points(painter, points),
            Shape::Curve {
                points,
                stroke: Some(stroke),
                ..
            } => {
                self.lines(painter, &self.axes().runs(points.iter().copied()), *stroke);
            }
            Shape::Band(points) => {
                let upper = points.iter().rev().map(|(x, _, high)| (*x, *high));
                let border: Vec<_> = points
                    .iter()
                    .map(|(x, low, _)| (*x, *low))
                    .chain(upper)
                    .collect();
                self.inside(painter, &border);
            }
            Shape::Envelope { x, columns } => {
                self.lines(painter, &self.axes().envelope(*x, columns), Stroke::Solid);
            }
            Shape::Inside(border) => self.inside(painter, border),
            Shape::Boxes(boxes) => {
                for ((left, right), (low, high)) in boxes {
                    let dot = |point| {
                        self.axes()
                            .place(point)
                            .and_then(|(x, y)| painter.get_point(x, y))
                    };
                    let (Some(from), Some(to)) = (dot((*left, *high)), dot((*right, *low))) else {
                        continue;
                    };
                    for y in from.1..=to.1 {
                        (from.0..=to.0).for_each(|x| self.paint(painter, (x, y)));
                    }
                }
            }
            Shape::Upright(at) | Shape::Level(at) => {
                let ends = self
                    .axes()
                    .guide(*at, matches!(self.shape, Shape::Upright(_)));
                let runs = ends.map(Vec::from);
                self.lines(painter, runs.as_slice(), Stroke::Sparse);
            }
            Shape::Curve { stroke: None, .. } | Shape::Map(_) => {}
        }
    }
}

/// Returns true if a stroke paints its dot with this number, so that lines differ without colours.
fn paints(stroke: Stroke, dot: usize) -> bool {
    match stroke {
        Stroke::Solid => true,
        Stroke::Dashed => dot % 8 < 6,
        Stroke::Dotted => dot % 4 < 2,
        Stroke::DashDotted => !matches!(dot % 10, 6 | 7 | 9),
        Stroke::Sparse => dot.is_multiple_of(4),
    }
}

/// Returns the dots on the straight line from one dot to another without the first, unless both are
/// the same.
fn between(from: Dot, to: Dot) -> impl Iterator<Item = Dot> {
    let (dx, dy) = (to.0 as f64 - from.0 as f64, to.1 as f64 - from.1 as f64);
    let steps = dx.abs().max(dy.abs()).max(1.0) as usize;
    (1..=steps).map(move |step| {
        let share = step as f64 / steps as f64;
        (
            (from.0 as f64 + dx * share).round() as usize,
            (from.1 as f64 + dy * share).round() as usize,
        )
    })
}
