//! Error against time as a picture: a log–log plot in SVG, one line for each knob.

use crate::accuracy::{CostTable, ErrorFigure, Knob, Row};
use std::fmt::Write;

const SIZE: (f64, f64) = (820.0, 480.0);
/// Left, top, right, bottom.
const MARGINS: (f64, f64, f64, f64) = (76.0, 56.0, 270.0, 52.0);
/// Colours that people with any colour vision tell apart on white (Okabe and Ito).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00"];

/// The work–precision plot of a table: relative error over the least time of a run, for each knob that time
/// goes into. The error is that of the adhesion force where the knob has one, else that of the curve.
#[must_use]
pub fn work_precision_svg(title: &str, table: &CostTable) -> String {
    let series: Vec<_> = Knob::ALL
        .into_iter()
        .map(|knob| (knob, table.rows_of(knob).filter_map(point).collect::<Vec<_>>()))
        .filter(|(_, points)| !points.is_empty())
        .collect();
    let all = || series.iter().flat_map(|(_, points)| points);
    let across = Axis::over(all().map(|point| point.seconds), (MARGINS.0, SIZE.0 - MARGINS.2));
    let up = Axis::over(all().map(|point| point.error), (SIZE.1 - MARGINS.3, MARGINS.1));
    let mut svg = String::new();
    // Writing to a string does not fail.
    let _ = draw(&mut svg, title, &series, &across, &up);
    svg
}

struct Point {
    seconds: f64,
    error: f64,
    resolved: bool,
}

fn point(row: &Row) -> Option<Point> {
    let ErrorFigure { error, resolved, .. } = row.errors.adhesion_force.or(row.errors.curve)?;
    let seconds = row.seconds?.minimum;
    (error > 0.0 && seconds > 0.0 && error.is_finite()).then_some(Point { seconds, error, resolved })
}

/// A logarithmic axis of whole decades.
struct Axis {
    first: i32,
    last: i32,
    from: f64,
    to: f64,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, (from, to): (f64, f64)) -> Axis {
        let decades: Vec<f64> = values.map(f64::log10).collect();
        let low = decades.iter().copied().fold(f64::INFINITY, f64::min);
        let high = decades.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low > high {
            return Axis { first: -1, last: 0, from, to };
        }
        let first = low.floor() as i32;
        Axis { first, last: (high.ceil() as i32).max(first + 1), from, to }
    }

    fn at(&self, decade: f64) -> f64 {
        let share = (decade - f64::from(self.first)) / f64::from(self.last - self.first);
        self.from + share * (self.to - self.from)
    }

    fn of(&self, value: f64) -> f64 {
        self.at(value.log10())
    }

    /// Decades that are named: at most about ten.
    fn ticks(&self) -> impl Iterator<Item = i32> {
        let step = usize::try_from((self.last - self.first) / 10 + 1).unwrap_or(1);
        (self.first..=self.last).step_by(step)
    }
}

fn draw(
    svg: &mut String,
    title: &str,
    series: &[(Knob, Vec<Point>)],
    across: &Axis,
    up: &Axis,
) -> std::fmt::Result {
    let (width, height) = SIZE;
    writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">"
    )?;
    writeln!(svg, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>")?;
    let middle = f64::midpoint(across.from, across.to);
    writeln!(
        svg,
        "<text x=\"{middle}\" y=\"28\" text-anchor=\"middle\" font-size=\"15\">{}</text>",
        escaped(title)
    )?;
    for decade in across.ticks() {
        let x = across.at(f64::from(decade));
        grid_line(svg, (x, up.from), (x, up.to))?;
        writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            up.from + 20.0,
            power(decade)
        )?;
    }
    for decade in up.ticks() {
        let y = up.at(f64::from(decade));
        grid_line(svg, (across.from, y), (across.to, y))?;
        writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            across.from - 8.0,
            y + 4.0,
            power(decade)
        )?;
    }
    writeln!(
        svg,
        "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">time of a run, s</text>",
        height - 12.0
    )?;
    let side = f64::midpoint(up.from, up.to);
    writeln!(
        svg,
        "<text x=\"20\" y=\"{side}\" text-anchor=\"middle\" transform=\"rotate(-90 20 {side})\">relative error of F_a, else of the curve</text>"
    )?;
    for (index, (knob, points)) in series.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let places: Vec<_> = points
            .iter()
            .map(|point| format!("{:.1},{:.1}", across.of(point.seconds), up.of(point.error)))
            .collect();
        writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>",
            places.join(" ")
        )?;
        for point in points {
            let (x, y) = (across.of(point.seconds), up.of(point.error));
            // Hollow where the error is not resolved.
            let fill = if point.resolved { colour } else { "#ffffff" };
            writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"{fill}\" stroke=\"{colour}\"/>"
            )?;
        }
        let (x, y) = (across.to + 18.0, up.to + 20.0 * index as f64 + 6.0);
        writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{:.1}\" r=\"3.5\" fill=\"{colour}\"/>", y - 4.0)?;
        writeln!(svg, "<text x=\"{:.1}\" y=\"{y:.1}\">{}</text>", x + 10.0, escaped(knob.name()))?;
    }
    writeln!(svg, "</svg>")
}

fn grid_line(svg: &mut String, from: (f64, f64), to: (f64, f64)) -> std::fmt::Result {
    writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#dddddd\"/>",
        from.0, from.1, to.0, to.1
    )
}

fn power(decade: i32) -> String {
    format!("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", decade.to_string().replace('-', "−"))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::{Measures, Reference, Timing};

    #[test]
    fn points_stand_where_time_and_error_say() {
        let row = |seconds: f64, error: f64, resolved| Row {
            knob: Knob::SubCellSprings,
            setting: 16.0,
            springs: 16,
            seconds: Timing::of(vec![seconds]),
            transforms: None,
            errors: Measures {
                curve: Some(ErrorFigure { error, resolved, order: None }),
                ..Measures::default()
            },
        };
        let reference =
            Reference { springs: 16, adhesion_force: None, closed_form: false, errors: Measures::default() };
        let rows = vec![row(1e-4, 1e-1, true), row(1e-2, 1e-3, false), row(1e-2, 0.0, true)];
        let (transform_seconds, left_out) = (1.0, Vec::new());
        let table = CostTable { budget: 1.0, spent: 1.0, transform_seconds, reference, rows, left_out };
        let svg = work_precision_svg("a < b", &table);
        // Two decades across and two up: the corners of the frame.
        assert!(svg.contains("<polyline points=\"76.0,56.0 550.0,428.0\""), "{svg}");
        assert!(svg.contains("cx=\"550.0\" cy=\"428.0\" r=\"3.5\" fill=\"#ffffff\""), "{svg}");
        assert!(svg.contains("a &lt; b") && svg.trim_end().ends_with("</svg>"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        let empty = work_precision_svg("", &CostTable { rows: Vec::new(), ..table });
        assert!(!empty.contains("NaN") && !empty.contains("<circle"), "{empty}");
    }
}
