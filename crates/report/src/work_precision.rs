//! The work–precision diagram: error over computing time for each setting that affects accuracy.

use crate::reference::omitted_waves;
use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::discretisation::{CostTable, Knob};
use asperity_study::half_space::Reference;

/// Returns the figure of relative errors over computing time, with a curve for each kind of
/// setting, such as the number of springs. The error is the error of the adhesion force, or of the
/// force curve if there is no adhesion force. If `reference`, the comparison with three dimensions,
/// is given, the figure also has the error of the model as a level.
pub fn work_precision(title: &str, table: &CostTable, reference: Option<&Reference>) -> Figure {
    let model = reference
        .and_then(|reference| reference.budget.model)
        .filter(|model| *model > 0.0);
    let points = |knob: Knob| {
        table
            .rows_of(knob)
            .filter_map(|row| table.point(row))
            .collect::<Vec<_>>()
    };
    let series: Vec<_> = Knob::ALL
        .into_iter()
        .map(|knob| (knob, points(knob)))
        .collect();
    let series: Vec<_> = series
        .into_iter()
        .filter(|(_, points)| !points.is_empty())
        .collect();
    let squares = reference.and_then(|reference| {
        let grid = reference.budget.grid.filter(|grid| *grid > 0.0)?;
        Some((reference.options.cells, (reference.seconds_of_square, grid)))
    });
    let mut layers = Vec::new();
    for (number, (knob, points)) in series.iter().enumerate() {
        let of = |resolved: bool| {
            let of = points
                .iter()
                .filter(move |(_, figure)| figure.resolved == resolved);
            of.map(|&(seconds, figure)| (seconds, figure.error))
        };
        let (ink, sign) = (Ink::Series(number), Sign::of_series(number));
        let line = points
            .iter()
            .map(|&(seconds, figure)| (seconds, figure.error))
            .collect();
        layers.push(Layer::unnamed(ink, Shape::line(line, Stroke::Solid)));
        let order = table
            .order(*knob)
            .map_or_else(String::new, |order| format!(", order {order:.1}"));
        let name = Label::plain(&format!("{}{order}", knob.name()));
        layers.push(Layer::new(
            name,
            ink,
            Shape::signs(of(true).collect(), sign),
        ));
        if of(false).next().is_some() {
            let rings = Shape::signs(of(false).collect(), Sign::Ring);
            layers.push(Layer::new(
                "error below the error of the reference".into(),
                ink,
                rings,
            ));
        }
    }
    if let Some((cells, at)) = squares {
        let name = format!("three dimensions, {cells} × {cells} cells");
        let shape = Shape::signs(vec![at], Sign::Cross);
        layers.push(Layer::new(
            Label::plain(&name),
            Ink::Series(series.len()),
            shape,
        ));
    }
    if let Some(model) = model {
        let waves = reference.map_or_else(String::new, omitted_waves);
        let name = Label::plain(&format!(
            "error of the model, which no springs reduce{waves}"
        ));
        layers.insert(0, Layer::new(name, Ink::Quiet, Shape::Level(model)));
    }
    let mut all: Vec<(f64, f64)> = Vec::new();
    for (_, points) in &series {
        all.extend(
            points
                .iter()
                .map(|(seconds, figure)| (*seconds, figure.error)),
        );
    }
    all.extend(squares.map(|(_, at)| at));
    let axis = |span: Span, name: &str, symbol: &str, unit: &str| {
        ChartAxis::new(AxisScale::Logarithmic, span, name, symbol, unit)
    };
    let times = Span::decades(all.iter().map(|(seconds, _)| seconds.log10()));
    let errors = all.iter().map(|(_, error)| *error).chain(model);
    let errors = Span::decades(errors.map(f64::log10));
    let of_force = table.reference.adhesion_force.is_some();
    let (name, symbol) = if of_force {
        ("relative error of", "F_a")
    } else {
        ("relative error of the curve", "")
    };
    let x = axis(times, "time of a run", "t", "s");
    Figure::of_chart(
        title,
        Chart::new(x, axis(errors, name, symbol, "1"), layers),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::discretisation::{CostReference, ErrorFigure, Row, Timing};

    #[test]
    fn points_lie_at_time_and_error() {
        let row = |seconds: f64, error: f64, resolved| Row {
            knob: Knob::SubCellSprings,
            setting: 16.0,
            springs: 16,
            seconds: Timing::of(vec![seconds]),
            transforms: None,
            errors: [
                None,
                Some(ErrorFigure {
                    error,
                    resolved,
                    order: None,
                }),
                None,
                None,
            ],
        };
        let reference = CostReference {
            springs: 16,
            adhesion_force: None,
            closed_form: false,
            errors: [None; 4],
        };
        let rows = vec![
            row(1e-4, 1e-1, true),
            row(1e-2, 1e-3, false),
            row(1e-2, 0.0, true),
        ];
        let (transform_seconds, left_out) = (1.0, Vec::new());
        let table = CostTable {
            budget: 1.0,
            spent: 1.0,
            transform_seconds,
            reference,
            rows,
            left_out,
        };
        let figure = work_precision("a < b", &table, None);
        let chart = &figure.charts[0];
        assert_eq!(
            (chart.x.span, chart.y.span),
            (
                Span {
                    low: -4.0,
                    high: -2.0
                },
                Span {
                    low: -3.0,
                    high: -1.0
                }
            )
        );
        assert_eq!(chart.y.name, "relative error of the curve");
        let legend: Vec<String> = figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        assert_eq!(
            legend,
            [
                Knob::SubCellSprings.name(),
                "error below the error of the reference"
            ]
        );
        assert!(figure.svg().contains("a &lt; b"));
        let empty = work_precision(
            "",
            &CostTable {
                rows: Vec::new(),
                ..table
            },
            None,
        )
        .svg();
        assert!(
            !empty.contains("NaN") && !empty.contains("inf") && !empty.contains("<circle"),
            "{empty}"
        );
    }
}
