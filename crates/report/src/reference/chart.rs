//! Chart of the loading without adhesion, with profiles and in three dimensions.

use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Layer, Shape, Sign, Span, Stroke};
use asperity_study::Statistics;
use asperity_study::half_space::Loaded;

/// Returns a figure of the loading without adhesion. For both models, the chart shows the mean and
/// the quartiles of the indentation over the force.
pub(super) fn figure_of_loading(title: &str, loading: &[Loaded]) -> Figure {
    let mut forces = Vec::new();
    let mut indentations = Vec::new();
    for loaded in loading {
        forces.push(loaded.force);
        for statistics in [loaded.indentation.line, loaded.indentation.half_space] {
            let [lower, _, upper] = statistics.quartiles;
            indentations.extend([lower, upper, statistics.mean]);
        }
    }
    let x = logarithmic_axis(&forces, "force", "F", "N");
    let y = logarithmic_axis(&indentations, "indentation", "d", "m");
    let line = LayersOfModel {
        name: "profile",
        ink: Ink::Series(0),
        sign: Sign::Dot,
        indentation: |loaded| loaded.indentation.line,
    };
    let square = LayersOfModel {
        name: "three dimensions",
        ink: Ink::Series(1),
        sign: Sign::Diamond,
        indentation: |loaded| loaded.indentation.half_space,
    };
    let mut layers = line.layers(loading);
    layers.extend(square.layers(loading));
    Figure::of_chart(title, Chart::new(x, y, layers))
}

/// Returns a logarithmic axis that contains these values and a margin.
fn logarithmic_axis(values: &[f64], name: &str, symbol: &str, unit: &str) -> ChartAxis {
    let scale = AxisScale::Logarithmic;
    let coordinates = values.iter().map(|value| scale.coordinate(*value));
    ChartAxis::new(scale, Span::around(coordinates, 0.05), name, symbol, unit)
}

/// Style in which the chart shows the indentation of one model over the force.
struct LayersOfModel {
    name: &'static str,
    ink: Ink,
    sign: Sign,
    /// Function that returns the indentation of the model at a force.
    indentation: fn(&Loaded) -> Statistics,
}

impl LayersOfModel {
    /// Returns a band of the quartiles and a curve of the means.
    fn layers(&self, loading: &[Loaded]) -> Vec<Layer> {
        let mut band = Vec::with_capacity(loading.len());
        let mut means = Vec::with_capacity(loading.len());
        for loaded in loading {
            let indentation = (self.indentation)(loaded);
            let [lower, _, upper] = indentation.quartiles;
            band.push((loaded.force, lower, upper));
            means.push((loaded.force, indentation.mean));
        }
        let curve = Shape::Curve {
            points: means,
            stroke: Some(Stroke::Solid),
            sign: Some(self.sign),
        };
        let name = format!("{}, mean and quartiles", self.name);
        vec![
            Layer::unnamed(self.ink, Shape::Band(band)),
            Layer::new(name.as_str().into(), self.ink, curve),
        ]
    }
}
