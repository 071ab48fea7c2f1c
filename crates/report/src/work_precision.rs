//! The work–precision diagram: error over computing time, for each setting that affects the
//! accuracy.

use crate::reference::omitted_waves;
use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::discretisation::{CostTable, ErrorFigure, Knob};
use asperity_study::half_space::Reference;

/// Returns the figure of relative errors over computing time, with a curve for each kind of
/// setting, such as the number of springs. The error is that of the pull-off force or, if there is
/// no pull-off force, that of the force curve. `reference` is a comparison of the scene with an
/// elastic half-space in three dimensions. If `reference` is given, a horizontal line shows the
/// error of the model that this comparison has found.
pub fn work_precision(title: &str, table: &CostTable, reference: Option<&Reference>) -> Figure {
    let mut points = Vec::new();
    let mut layers = Vec::new();
    let mut series = 0;
    for knob in Knob::ALL {
        let measured: Vec<Measured> = table
            .rows_of(knob)
            .filter_map(|row| table.point(row))
            .map(|(seconds, error)| Measured { seconds, error })
            .collect();
        if measured.is_empty() {
            continue;
        }
        points.extend(measured.iter().map(Measured::point));
        layers.extend(series_layers(table, knob, series, &measured));
        series += 1;
    }
    if let Some(reference) = reference
        && let Some(point) = point_of_squares(reference)
    {
        points.push(point);
        let cells = reference.options.cells;
        let name = format!("three dimensions, {cells} × {cells} cells");
        let sign = Shape::signs(vec![point], Sign::Cross);
        layers.push(Layer::new(Label::plain(&name), Ink::Series(series), sign));
    }
    let model = reference.and_then(error_of_model);
    if let (Some(reference), Some(model)) = (reference, model) {
        let waves = omitted_waves(reference);
        let name = format!("error of the model, which no springs reduce{waves}");
        let level = Layer::new(Label::plain(&name), Ink::Quiet, Shape::Level(model));
        layers.insert(0, level);
    }

    let times = Span::decades(points.iter().map(|(seconds, _)| seconds.log10()));
    let errors = points.iter().map(|(_, error)| *error).chain(model);
    let errors = Span::decades(errors.map(f64::log10));
    let x = logarithmic_axis(times, "time of a run", "t", "s");
    let y = if table.reference.pull_off_force.is_some() {
        logarithmic_axis(errors, "relative error of", "F_a", "1")
    } else {
        logarithmic_axis(errors, "relative error of the curve", "", "1")
    };
    Figure::of_chart(title, Chart::new(x, y, layers))
}

/// Time and error of a run with one setting.
struct Measured {
    /// Computing time, s.
    seconds: f64,
    error: ErrorFigure,
}

impl Measured {
    fn point(&self) -> (f64, f64) {
        (self.seconds, self.error.error)
    }
}

/// Returns a curve for one kind of setting, with markers at its points. An open ring marks an error
/// that is smaller than the error of the reference solution. `number` is the index of the kind of
/// setting.
fn series_layers(
    table: &CostTable,
    knob: Knob,
    number: usize,
    measured: &[Measured],
) -> Vec<Layer> {
    let ink = Ink::Series(number);
    let mut resolved = Vec::new();
    let mut unresolved = Vec::new();
    for run in measured {
        if run.error.resolved {
            resolved.push(run.point());
        } else {
            unresolved.push(run.point());
        }
    }
    let mut name = knob.name().to_owned();
    if let Some(order) = table.order(knob) {
        name += &format!(", order {order:.1}");
    }
    let line = Shape::line(
        measured.iter().map(Measured::point).collect(),
        Stroke::Solid,
    );
    let signs = Shape::signs(resolved, Sign::of_series(number));
    let mut layers = vec![
        Layer::unnamed(ink, line),
        Layer::new(Label::plain(&name), ink, signs),
    ];
    if !unresolved.is_empty() {
        let rings = Shape::signs(unresolved, Sign::Ring);
        let name = "error below the error of the reference".into();
        layers.push(Layer::new(name, ink, rings));
    }
    layers
}

/// Returns the computing time in s of a square (rough square surface on an elastic half-space), and
/// the error due to its grid. `None` if this error is unknown or zero.
fn point_of_squares(reference: &Reference) -> Option<(f64, f64)> {
    let error = reference.budget.grid.filter(|error| *error > 0.0)?;
    Some((reference.seconds_of_square, error))
}

/// Returns the error of the model; `None` if it is unknown or zero.
fn error_of_model(reference: &Reference) -> Option<f64> {
    reference.budget.model.filter(|error| *error > 0.0)
}

fn logarithmic_axis(span: Span, name: &str, symbol: &str, unit: &str) -> ChartAxis {
    ChartAxis::new(AxisScale::Logarithmic, span, name, symbol, unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::discretisation::{CostReference, Row, Timing};

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
            pull_off_force: None,
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
