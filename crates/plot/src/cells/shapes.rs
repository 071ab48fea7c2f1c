//! Draws the layers of a chart as Braille dots, on a canvas with coordinates from 0 to 1.

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

/// Column and row of a Braille dot on the canvas.
type Dot = (usize, usize);

impl LayerShape<'_> {
    fn axes(&self) -> Axes<'_> {
        Axes {
            x: &self.chart.x,
            y: &self.chart.y,
        }
    }

    fn paint(&self, painter: &mut Painter<'_, '_>, dot: Dot) {
        let (x, y) = dot;
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

    /// Shades the area inside a closed line: paints every dot that is inside the line and for which
    /// [`Self::is_shaded`] returns true. A dot is inside if the line crosses the column an odd
    /// number of times below the dot.
    fn inside(&self, painter: &mut Painter<'_, '_>, border: &[(f64, f64)]) {
        let Some((last, _)) = painter.get_point(1.0, 0.0) else {
            return;
        };
        let mut shares: Vec<Share> = Vec::new();
        for (x, y) in border {
            // Zero on a logarithmic axis has no finite position, so the point is placed far below
            // the chart.
            let up = self.chart.y.share(*y).clamp(-9.0, 9.0);
            shares.push((self.chart.x.share(*x), up));
        }
        for column in 0..=last {
            let x = column as f64 / last.max(1) as f64;
            for pair in crossings(&shares, x).chunks_exact(2) {
                let row = |y: f64| painter.get_point(x, y.clamp(0.0, 1.0)).map(|(_, row)| row);
                let (Some(low), Some(high)) = (row(pair[0]), row(pair[1])) else {
                    continue;
                };
                for row in high..=low {
                    if self.is_shaded(column, row) {
                        self.paint(painter, (column, row));
                    }
                }
            }
        }
    }

    /// Returns true for the dots that shade an area: every second dot or, for [`Ink::Quiet`], every
    /// eighth dot.
    fn is_shaded(&self, column: usize, row: usize) -> bool {
        if self.ink == Ink::Quiet {
            column.is_multiple_of(2) && (column / 2 + row).is_multiple_of(4)
        } else {
            (column + row).is_multiple_of(2)
        }
    }

    fn filled_box(&self, painter: &mut Painter<'_, '_>, x: (f64, f64), y: (f64, f64)) {
        let (left, right) = x;
        let (low, high) = y;
        let dot = |point| {
            let (across, up) = self.axes().place(point)?;
            painter.get_point(across, up)
        };
        let (Some(from), Some(to)) = (dot((left, high)), dot((right, low))) else {
            return;
        };
        for row in from.1..=to.1 {
            for column in from.0..=to.0 {
                self.paint(painter, (column, row));
            }
        }
    }
}

/// Returns the heights at which a closed line crosses the vertical line at x, in ascending order.
fn crossings(line: &[Share], x: f64) -> Vec<f64> {
    let mut crossings = Vec::new();
    for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
        if (a.0 <= x) == (b.0 <= x) {
            continue;
        }
        let y = a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0);
        if y.is_finite() {
            crossings.push(y);
        }
    }
    crossings.sort_unstable_by(f64::total_cmp);
    crossings
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
                for (x, y) in boxes {
                    self.filled_box(painter, *x, *y);
                }
            }
            Shape::Upright(number) | Shape::Level(number) => {
                let is_vertical = matches!(self.shape, Shape::Upright(_));
                if let Some(ends) = self.axes().guide(*number, is_vertical) {
                    self.lines(painter, &[Vec::from(ends)], Stroke::Sparse);
                }
            }
            Shape::Curve { stroke: None, .. } | Shape::Map(_) => {}
        }
    }
}

/// Returns true if a line with this stroke has a dot at the place `dot`, counted along the line.
/// The strokes differ in their gaps, so that lines can be distinguished without colours.
fn paints(stroke: Stroke, dot: usize) -> bool {
    match stroke {
        Stroke::Solid => true,
        Stroke::Dashed => dot % 8 < 6,
        Stroke::Dotted => dot % 4 < 2,
        Stroke::DashDotted => !matches!(dot % 10, 6 | 7 | 9),
        Stroke::Sparse => dot.is_multiple_of(4),
    }
}

/// Returns the dots on the straight line between two dots, without the dot `from`. If the two dots
/// are the same, returns this dot.
fn between(from: Dot, to: Dot) -> impl Iterator<Item = Dot> {
    let dx = to.0 as f64 - from.0 as f64;
    let dy = to.1 as f64 - from.1 as f64;
    let steps = dx.abs().max(dy.abs()).max(1.0) as usize;
    (1..=steps).map(move |step| {
        let share = step as f64 / steps as f64;
        (
            (from.0 as f64 + dx * share).round() as usize,
            (from.1 as f64 + dy * share).round() as usize,
        )
    })
}
