//! Map of the first free parameter over the places on the specimen at which curves were measured.

use crate::fits::{FACTS, FitsReport};
use asperity_data::{AxisScale, mean};
use asperity_plot::{Chart, ChartAxis, HeatMap, Ink, Layer, Shades, Shape, Span};

/// Smallest share of the cells of a grid that have a curve. With fewer, the places lie on no grid.
const FILLED: f64 = 0.25;

/// A fitted curve with a known place.
struct Place {
    /// Coordinates, m.
    x: f64,
    y: f64,
    /// Value of the parameter; `None` if the fit gives only a bound.
    value: Option<f64>,
}

impl FitsReport<'_> {
    /// Returns a map of the first free parameter; `None` if the places are unknown or do not lie on
    /// a grid of at least two columns and two rows.
    pub(crate) fn map_chart(&self) -> Option<Chart> {
        let row = self.free.first()?.row();
        let places = self.places()?;
        let columns = lines_of(places.iter().map(|place| place.x).collect());
        let rows = lines_of(places.iter().map(|place| place.y).collect());
        let cells = columns.len() * rows.len();
        let is_grid = columns.len() > 1 && rows.len() > 1;
        if !is_grid || (places.len() as f64) < FILLED * cells as f64 {
            return None;
        }
        let mut in_cells = vec![Vec::new(); cells];
        for place in &places {
            let column = nearest(&columns, place.x)?;
            let row = nearest(&rows, place.y)?;
            in_cells[row * columns.len() + column].extend(place.value);
        }
        let mut values = Vec::with_capacity(cells);
        for found in &in_cells {
            values.push((!found.is_empty()).then(|| mean(found)));
        }
        let span = Span::around(values.iter().copied().flatten(), 0.0);
        let axis = |name, values: &[f64]| {
            let span = HeatMap::span(AxisScale::Linear, values);
            ChartAxis::new(AxisScale::Linear, span, "position", name, "m")
        };
        let (x, y) = (axis("x", &columns), axis("y", &rows));
        let map = HeatMap {
            columns,
            rows,
            values,
            key: ChartAxis::new(AxisScale::Linear, span, row.term, row.symbol, row.unit),
            shades: Shades::Sequential,
            classes: Vec::new(),
            class_names: Vec::new(),
            contour: None,
        };
        let layer = Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)));
        Some(Chart::new(x, y, vec![layer]))
    }

    /// Returns the places of the fitted curves; `None` if no curve with a known place has a value.
    fn places(&self) -> Option<Vec<Place>> {
        let index = |name: &str| FACTS.iter().position(|fact| *fact == name);
        let (x, y) = (index("position_x")?, index("position_y")?);
        let mut places = Vec::new();
        for row in self.rows {
            if let (Some(x), Some(y)) = (row.facts[x], row.facts[y]) {
                let value = row.parameters.first().and_then(|values| values[0]);
                places.push(Place { x, y, value });
            }
        }
        let has_value = places.iter().any(|place| place.value.is_some());
        has_value.then_some(places)
    }
}

/// Returns the coordinates of the columns or rows of a grid, ascending. Coordinates whose distance
/// is below a small share of their range belong to the same line, because instruments state
/// measured places, which deviate a little from a grid.
fn lines_of(mut coordinates: Vec<f64>) -> Vec<f64> {
    coordinates.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (coordinates.first(), coordinates.last()) else {
        return Vec::new();
    };
    let distance = (last - first) / coordinates.len() as f64;
    coordinates
        .chunk_by(|one, next| next - one <= distance)
        .map(mean)
        .collect()
}

/// Returns the index of the line that is nearest to a coordinate.
fn nearest(lines: &[f64], coordinate: f64) -> Option<usize> {
    let distance = |line: &f64| (line - coordinate).abs();
    let lines = lines.iter().enumerate();
    let nearest = lines.min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
    nearest.map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fits::CurveRow;
    use asperity_experiment::Parameter;
    use asperity_scene::open;

    /// Returns the values of the map of curves at these places, with the number of columns.
    fn map(places: &[(f64, f64, Option<f64>)]) -> Option<(usize, Vec<Option<f64>>)> {
        let document = open("jkr-sphere").unwrap();
        let mut rows = Vec::new();
        for (x, y, value) in places {
            let mut row = CurveRow {
                parameters: vec![[*value; 3]],
                ..CurveRow::default()
            };
            row.facts[9] = Some(*x);
            row.facts[10] = Some(*y);
            rows.push(row);
        }
        let report = FitsReport {
            scene: document.scene(),
            free: &[Parameter::Work],
            rows: &rows,
            together: &[],
            wording: |_| String::new(),
        };
        let chart = report.map_chart()?;
        match &chart.layers[0].shape {
            Shape::Map(map) => Some((map.columns.len(), map.values.clone())),
            _ => None,
        }
    }

    #[test]
    fn a_grid_of_curves_is_a_map() {
        let grid = [
            (3.01e-6, 0.0, Some(0.05)),
            (1e-6, 0.01e-6, Some(0.04)),
            (1.01e-6, 2e-6, Some(0.06)),
            (3e-6, 2.02e-6, None),
        ];
        let values = vec![Some(0.04), Some(0.05), Some(0.06), None];
        assert_eq!(map(&grid), Some((2, values)));
    }

    #[test]
    fn places_on_a_line_or_without_values_are_no_map() {
        let on_line = [(1e-6, 0.0, Some(0.05)), (2e-6, 0.0, Some(0.05))];
        assert_eq!(map(&on_line), None);
        assert_eq!(map(&[(1e-6, 0.0, None), (2e-6, 1e-6, None)]), None);
        assert_eq!(map(&[]), None);
        let scattered: Vec<_> = (0..20)
            .map(|index| {
                let share = f64::from(index);
                (share * share, (7.0 * share) % 20.0, Some(0.05))
            })
            .collect();
        assert_eq!(map(&scattered), None);
    }
}
