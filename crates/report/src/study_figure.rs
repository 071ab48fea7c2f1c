//! Figures of parameter studies: a map over two axes, or curves along one axis.

use asperity_data::AxisScale;
use asperity_plot::{
    Chart, ChartAxis, Class, Contour, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Sign,
    Span, Stroke, value_label,
};
use asperity_scene::Regime;
use asperity_study::maps::{Grid, GridLayer};
use asperity_study::{Axis, Quantity, Statistics};

/// If the values of a quantity extend over at least this number of decades, its chart is followed
/// by a second one with a logarithmic scale.
const DECADES_FOR_SECOND: f64 = 1.5;

/// Largest number of decades of a logarithmic axis.
const MOST_DECADES: f64 = 12.0;

/// Largest number of decades of the colour scale of a map.
const MOST_DECADES_OF_MAP: f64 = 6.0;

/// The axis makes room for a confidence interval only if the upper end of the interval is below
/// this number times the largest mean. With few profiles the intervals may be very wide.
const MOST_OF_BAND: f64 = 2.0;

/// The colours of a map show the sign of its values if the range of values of either sign is at
/// least this share of the range of the other sign.
const LEAST_OF_A_SIGN: f64 = 0.25;

/// Marks of a regime on a map.
struct RegimeMark {
    regime: Regime,
    /// Marker in a picture.
    sign: Sign,
    /// Letter of the regime in a terminal.
    letter: char,
    ink: Ink,
}

const REGIMES: [RegimeMark; 3] = [
    RegimeMark {
        regime: Regime::PressureInsensitive,
        sign: Sign::Dot,
        letter: 'i',
        ink: Ink::Series(0),
    },
    RegimeMark {
        regime: Regime::PressureSensitive,
        sign: Sign::Up,
        letter: 's',
        ink: Ink::Series(3),
    },
    RegimeMark {
        regime: Regime::NonAdhesive,
        sign: Sign::Cross,
        letter: 'n',
        ink: Ink::Quiet,
    },
];

/// Returns a figure with these charts of a parameter study. Lines below the title state the values
/// on those axes of the study that do not vary in the charts.
pub fn study_figure(title: &str, grid: &Grid, charts: Vec<Chart>) -> Figure {
    let statements = grid.fixed.iter().map(|fixed| Label::statement(fixed));
    let note = statements.reduce(|line, statement| line.then(", ").join(&statement));
    Figure {
        title: title.into(),
        notes: note.into_iter().collect(),
        charts,
        size: Figure::SMALL,
        ..Figure::default()
    }
}

/// Returns a heat map with the two axes of `grid`, or `None` if `grid` has one axis. The values are
/// means of a quantity over the random profiles. Markers (letters in a terminal) show the regimes
/// of adhesion. If `whole` is true, a cell that is not computed yet shows the value of a computed
/// cell nearby. With `scale` the colours have this scale instead of the usual one.
pub fn study_map(
    grid: &Grid,
    quantity: Quantity,
    whole: bool,
    scale: Option<AxisScale>,
) -> Option<Chart> {
    let across = &grid.across;
    let up = grid.up.as_ref()?;
    let values = means(&grid.statistics(quantity, whole));
    let mut layer = grid.layer(quantity).copied();
    if let Some(layer) = &mut layer
        && let Some(scale) = scale
        && scale != layer.scale
    {
        *layer = GridLayer::new(quantity, scale, values.iter().flatten());
    }
    let shading = Shading::new(layer);
    let contour = vanishing(grid, quantity).map(|share| Contour {
        name: vanishing_label(share),
        field: means(&grid.statistics(share, whole)),
        level: Regime::VANISHING_SHARE,
    });
    let map = HeatMap {
        columns: across.values.clone(),
        rows: up.values.clone(),
        values,
        key: quantity_axis(quantity, shading.scale, shading.span),
        shades: shading.shades,
        classes: classes(&grid.regimes(quantity, whole)),
        class_names: class_names(quantity),
        contour,
    };
    let layer = Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)));
    Some(Chart {
        heading: heading(quantity),
        x: study_axis(across, HeatMap::span(across.scale(), &across.values)),
        y: study_axis(up, HeatMap::span(up.scale(), &up.values)),
        layers: vec![layer],
    })
}

/// Colours of a map: scale, colours along the scale, and range of the values.
struct Shading {
    scale: AxisScale,
    shades: Shades,
    span: Span,
}

impl Shading {
    /// Returns the colours for a layer of a grid; for `None`, the colours for values from 0 to 1.
    fn new(layer: Option<GridLayer>) -> Self {
        let (scale, range) = match layer {
            Some(layer) => (layer.scale, layer.range),
            None => (AxisScale::Linear, Some((0.0, 1.0))),
        };
        // The colours distinguish negative and positive values, unless the values of one sign are
        // small compared with those of the other sign.
        if let Some((low, high)) = range
            && -low > LEAST_OF_A_SIGN * high
            && high > -LEAST_OF_A_SIGN * low
        {
            return Shading {
                scale,
                shades: Shades::Diverging,
                span: Span::around([-low, low, high, -high].into_iter(), 0.0),
            };
        }
        let ends = range.into_iter().flat_map(|(low, high)| [low, high]);
        Shading {
            scale,
            shades: Shades::Sequential,
            span: Span::of_values(scale, ends, MOST_DECADES_OF_MAP),
        }
    }
}

/// Returns for each cell the index of its regime in [`REGIMES`]; `None` for a cell that has no
/// regime.
fn classes(regimes: &[Option<Regime>]) -> Vec<Option<usize>> {
    let mut classes = Vec::with_capacity(regimes.len());
    for regime in regimes {
        classes.push(REGIMES.iter().position(|mark| Some(mark.regime) == *regime));
    }
    classes
}

/// Returns the classes that the legend of a map of a quantity names: the regimes.
fn class_names(quantity: Quantity) -> Vec<Class> {
    // The regime depends on where the loading turns. On a map of regimes, the name of the colour
    // scale states this point. On a map of another quantity, the letters show the regime of a
    // loading turned at first touch, and the legend states this.
    let protocol = if quantity.is_regime() {
        String::new()
    } else {
        format!(" ({})", quantity.short_protocol())
    };
    let mut names = Vec::with_capacity(REGIMES.len());
    for mark in &REGIMES {
        names.push(Class {
            sign: mark.sign,
            letter: Some(mark.letter),
            name: format!("{}{protocol}", mark.regime.name()),
            ink: mark.ink,
        });
    }
    names
}

/// Returns a chart of a quantity over the first axis of `grid`, with a curve for each value of the
/// second axis. If the vertical axis is linear and the largest mean is at least 10^1.5 times the
/// smallest mean above zero, a second chart with a logarithmic vertical axis is added.
pub fn study_curves(grid: &Grid, quantity: Quantity) -> Vec<Chart> {
    let scale = grid
        .layer(quantity)
        .map_or(AxisScale::Linear, |layer| layer.scale);
    let estimates = grid.statistics(quantity, false);
    let curves = Curves {
        grid,
        quantity,
        estimates: &estimates,
    };
    let first = curves.chart(scale);
    if scale != AxisScale::Linear || !spans_decades(&estimates) {
        return vec![first];
    }
    let second = curves.chart(AxisScale::Logarithmic);
    let heading = second.heading.clone().then(", logarithmic scale");
    vec![first, Chart { heading, ..second }]
}

fn means(estimates: &[Option<Statistics>]) -> Vec<Option<f64>> {
    estimates
        .iter()
        .map(|estimate| Some((*estimate)?.mean))
        .collect()
}

fn coordinates(axis: &Axis) -> Vec<f64> {
    let scale = axis.scale();
    axis.values
        .iter()
        .map(|value| scale.coordinate(*value))
        .collect()
}

fn study_axis(axis: &Axis, span: Span) -> ChartAxis {
    ChartAxis::new(axis.scale(), span, &axis.name, axis.symbol, axis.unit)
}

/// Returns the name of a quantity in words. It has hyphens that are missing in the name of the
/// column of the quantity.
fn name(quantity: Quantity) -> String {
    if quantity.is_regime() {
        return format!("regime {}", quantity.protocol());
    }
    quantity
        .name()
        .replace('_', " ")
        .replace("first touch", "first-touch")
        .replace("zero force a", "zero-force a")
        .replace("pull off", "pull-off")
}

fn heading(quantity: Quantity) -> Label {
    Label::quantity(&name(quantity), quantity.symbol())
}

fn quantity_axis(quantity: Quantity, scale: AxisScale, span: Span) -> ChartAxis {
    let name = if quantity.symbol().is_empty() {
        name(quantity)
    } else {
        String::new()
    };
    ChartAxis::new(scale, span, &name, quantity.symbol(), quantity.unit())
}

/// Returns the quantity whose vanishing is marked in a figure of `quantity`. This is a share of
/// F_a,max, such as F_a(d=0)/F_a,max: `quantity` itself if it is such a share, otherwise the first
/// share that the grid contains.
fn vanishing(grid: &Grid, quantity: Quantity) -> Option<Quantity> {
    let shares = Quantity::ADHESION_SHARES;
    if shares.contains(&quantity) {
        return Some(quantity);
    }
    shares
        .into_iter()
        .find(|share| grid.layer(*share).is_some())
}

/// Returns the name in the legend for the boundary at which adhesion vanishes:
/// `F_a(F=0) = 0.05 F_a,max`.
fn vanishing_label(share: Quantity) -> Label {
    let symbol = share.symbol();
    let (force, ideal) = symbol.split_once('/').unwrap_or((symbol, ""));
    Label::symbol(&format!("{force} = {} {ideal}", Regime::VANISHING_SHARE))
}

/// Returns true if the means of a quantity extend over too many decades for a linear scale.
fn spans_decades(estimates: &[Option<Statistics>]) -> bool {
    let mut lowest = f64::INFINITY;
    let mut highest: f64 = 0.0;
    for estimate in estimates.iter().flatten() {
        let mean = estimate.mean;
        if mean > 0.0 {
            lowest = lowest.min(mean);
            highest = highest.max(mean);
        } else if mean != 0.0 {
            // Means that are zero or negative cannot be drawn on a logarithmic scale.
            return false;
        }
    }
    (highest / lowest).log10() >= DECADES_FOR_SECOND
}

/// Estimates of a quantity in all cells of a grid, drawn as curves over the first axis.
struct Curves<'a> {
    grid: &'a Grid,
    quantity: Quantity,
    estimates: &'a [Option<Statistics>],
}

impl Curves<'_> {
    /// Returns the chart of all curves with the given scale of the vertical axis.
    fn chart(&self, scale: AxisScale) -> Chart {
        let across = &self.grid.across;
        let places = coordinates(across);
        let x = study_axis(across, Span::around(places.into_iter(), 0.03));
        let y = quantity_axis(self.quantity, scale, self.span(scale));
        Chart {
            heading: heading(self.quantity),
            ..Chart::new(x, y, self.layers())
        }
    }

    /// Returns the range of the vertical axis. It contains the means, the confidence intervals
    /// unless they are very wide and, for a single curve, the quartiles.
    fn span(&self, scale: AxisScale) -> Span {
        let known = || self.estimates.iter().flatten();
        let of_means = known().map(|estimate| estimate.mean);
        let means = Span::of_values(scale, of_means, MOST_DECADES);
        let mut ends = Vec::new();
        for estimate in known() {
            let (low, high) = estimate.ends();
            ends.extend([estimate.mean, low, high]);
            if self.is_single() {
                let [lower, _, upper] = estimate.quartiles;
                ends.extend([lower, upper]);
            }
        }
        let all = Span::around(ends.into_iter().map(|end| scale.coordinate(end)), 0.0);
        if scale == AxisScale::Logarithmic {
            let most = means.high + MOST_OF_BAND.log10();
            let high = all.high.clamp(means.high, most);
            return Span { high, ..means }.widened(0.05);
        }
        let (least, _) = self.quantity.bounds();
        if least == 0.0 && means.low == 0.0 {
            let high = all.high.min(MOST_OF_BAND * means.high);
            return Span {
                low: -0.03 * high,
                high: 1.05 * high,
            };
        }
        all.widened(0.05)
    }

    /// Returns true if there is a single curve. The quartiles over the profiles are then drawn as
    /// well.
    fn is_single(&self) -> bool {
        self.grid.up.is_none()
    }

    /// Returns layers of the curves with their confidence intervals and, for a single curve, of the
    /// median and the quartiles over the profiles. Vertical lines mark where adhesion without a
    /// preload vanishes.
    fn layers(&self) -> Vec<Layer> {
        let places = self.grid.across.values.len();
        let curves: Vec<_> = self.estimates.chunks(places.max(1)).collect();
        let mut layers = Vec::new();
        match (&self.grid.up, curves.first()) {
            // If all curves are exactly equal, the quantity does not depend on the second axis, and
            // only one curve is drawn.
            (Some(up), Some(first)) if curves.iter().all(|curve| curve == first) => {
                let symbol = Label::symbol_or_name(up.symbol, &up.name);
                let name = Label::plain("any ").join(&symbol);
                self.add_curve(&mut layers, name, Ink::Quiet, Sign::Dot, first);
            }
            (Some(up), _) => {
                for (number, (curve, value)) in curves.iter().zip(&up.values).enumerate() {
                    let name = value_label(&up.name, up.symbol, up.unit, *value);
                    let ink = Ink::Series(number);
                    let sign = Sign::of_series(number);
                    self.add_curve(&mut layers, name, ink, sign, curve);
                }
            }
            (None, Some(curve)) => {
                self.add_curve(&mut layers, "mean".into(), Ink::Series(0), Sign::Dot, curve);
            }
            (None, None) => {}
        }
        if let Some(share) = vanishing(self.grid, self.quantity) {
            for crossing in crossings(self.grid, share) {
                let place = Shape::Upright(self.grid.across.scale().number(crossing));
                layers.push(Layer::new(vanishing_label(share), Ink::Quiet, place));
            }
        }
        layers
    }

    /// Adds the layers of one curve. At a cell without an estimate, the curve has a gap.
    fn add_curve(
        &self,
        layers: &mut Vec<Layer>,
        name: Label,
        ink: Ink,
        sign: Sign,
        estimates: &[Option<Statistics>],
    ) {
        let known = || estimates.iter().flatten();
        let has_interval = known().any(|estimate| estimate.ends().0 < estimate.ends().1);
        if has_interval {
            let band = self.band(estimates, Statistics::ends);
            let name = "95 % confidence of the mean".into();
            layers.push(Layer::new(name, ink, band));
        }
        if self.is_single() && known().any(|estimate| estimate.count > 1) {
            let quartiles = self.band(estimates, |estimate| {
                let [lower, _, upper] = estimate.quartiles;
                (lower, upper)
            });
            let name = "quartiles of the profiles".into();
            layers.push(Layer::new(name, Ink::Quiet, quartiles));
            let median = self.points(estimates, |estimate| estimate.quartiles[1]);
            let median = Shape::line(median, Stroke::Dashed);
            layers.push(Layer::new("median".into(), Ink::Quiet, median));
        }
        let mean = Shape::Curve {
            points: self.points(estimates, |estimate| estimate.mean),
            stroke: Some(Stroke::Solid),
            sign: Some(sign),
        };
        layers.push(Layer::new(name, ink, mean));
    }

    /// Returns the points of a curve over the first axis. `number` takes the value from an
    /// estimate. The value is NaN where there is no estimate.
    fn points(
        &self,
        estimates: &[Option<Statistics>],
        number: fn(&Statistics) -> f64,
    ) -> Vec<(f64, f64)> {
        let mut points = Vec::with_capacity(estimates.len());
        for (place, estimate) in self.grid.across.values.iter().zip(estimates) {
            points.push((*place, estimate.as_ref().map_or(f64::NAN, number)));
        }
        points
    }

    /// Returns a band over the first axis. `ends` takes the lower and upper end of the band from an
    /// estimate. The ends are NaN where there is no estimate.
    fn band(&self, estimates: &[Option<Statistics>], ends: fn(&Statistics) -> (f64, f64)) -> Shape {
        let mut band = Vec::with_capacity(estimates.len());
        for (place, estimate) in self.grid.across.values.iter().zip(estimates) {
            let (low, high) = estimate.as_ref().map_or((f64::NAN, f64::NAN), ends);
            band.push((*place, low, high));
        }
        Shape::Band(band)
    }
}

/// Returns the coordinates on the horizontal axis at which the quantity `share`, such as
/// F_a(d=0)/F_a,max, vanishes.
fn crossings(grid: &Grid, share: Quantity) -> Vec<f64> {
    let shares = means(&grid.statistics(share, false));
    let places = coordinates(&grid.across);
    // A loading without a preload has the same share on all curves. If the curves differ, there are
    // no common crossings, and none is marked.
    let mut curves = shares.chunks(places.len().max(1));
    let first = curves.next();
    if curves.any(|curve| Some(curve) != first) {
        return Vec::new();
    }
    let mut crossings = Vec::new();
    let shares = first.unwrap_or_default().windows(2);
    for (place, share) in places.windows(2).zip(shares) {
        let [Some(before), Some(after)] = *share else {
            continue;
        };
        let before = before - Regime::VANISHING_SHARE;
        let after = after - Regime::VANISHING_SHARE;
        if (before < 0.0) != (after < 0.0) {
            let width = place[1] - place[0];
            crossings.push(place[0] + width * before / (before - after));
        }
    }
    crossings
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_plot::judge::check_picture;
    use asperity_scene::open;
    use asperity_study::maps::{GridCell, GridLayer};
    use asperity_study::{Axis, RegimeCounts, Spacing, Spread};

    const SHARE: Quantity = Quantity::FirstTouchAdhesionShare;
    const COEFFICIENT: Quantity = Quantity::AdhesionCoefficient;

    struct Study {
        title: String,
        grid: Grid,
    }

    fn axis(path: &str, spacing: Spacing, values: Vec<f64>) -> Axis {
        Axis::new(
            path,
            spacing,
            values,
            open("pressure-sensitive").unwrap().scene(),
        )
        .unwrap()
    }

    fn kappas() -> Axis {
        let values = (0..17)
            .map(|index| 0.25 * 10_f64.powf(f64::from(index) / 10.0))
            .collect();
        axis("adhesion.kappa", Spacing::Logarithmic, values)
    }

    fn share(kappa: f64, hurst: f64) -> f64 {
        1.0 / (1.0 + (kappa / (1.6 + 0.8 * hurst)).powi(5))
    }

    fn coefficient(kappa: f64, hurst: f64) -> f64 {
        0.9 * (1.0 - share(kappa, hurst)) * (-(kappa - 2.0) / 1.1).exp()
    }

    fn estimate(mean: f64) -> Statistics {
        with_interval(mean, ((mean * 0.85 - 0.004).max(0.0), mean * 1.15 + 0.004))
    }

    fn with_interval(mean: f64, confidence_interval: (f64, f64)) -> Statistics {
        let spread = Spread {
            standard_deviation: 0.0,
            standard_error: 0.0,
            confidence_interval,
        };
        Statistics {
            spread: Some(spread),
            ..Statistics::of(vec![mean], Quantity::PullOffForce.bounds()).unwrap()
        }
    }

    fn cell(kappa: f64, hurst: f64) -> GridCell {
        let values = [share(kappa, hurst), coefficient(kappa, hurst)];
        let regime = match values {
            [share, _] if share > 0.5 => Regime::PressureInsensitive,
            [_, coefficient] if coefficient > 0.01 => Regime::PressureSensitive,
            _ => Regime::NonAdhesive,
        };
        let regimes = RegimeCounts::of([Some(regime); 4].into_iter());
        GridCell {
            statistics: values.map(|value| Some(estimate(value))).to_vec(),
            regimes: [regimes; 2],
        }
    }

    fn study(
        title: &str,
        fixed: &[&str],
        (across, up): (Axis, Option<Axis>),
        cells: Vec<Option<GridCell>>,
    ) -> Study {
        let layer = |quantity| GridLayer {
            quantity,
            scale: AxisScale::Linear,
            range: Some((0.0, 1.0)),
        };
        let cells = cells.into_iter().map(|cell| cell.map(Ok)).collect();
        let fixed = fixed.iter().map(ToString::to_string).collect();
        let grid = Grid::new(
            across,
            up,
            fixed,
            [SHARE, COEFFICIENT].map(layer).to_vec(),
            cells,
        );
        Study {
            title: title.into(),
            grid,
        }
    }

    /// Returns a study with the axes H and κ, so that its results are drawn as a map. Some cells
    /// are missing.
    fn phase_map() -> Study {
        let hursts: Vec<f64> = (0..9).map(|index| f64::from(index + 1) / 10.0).collect();
        let places = kappas().values;
        let places = places
            .iter()
            .flat_map(|kappa| hursts.iter().map(|hurst| (*kappa, *hurst)));
        let cells = places
            .map(|(kappa, hurst)| Some(cell(kappa, hurst)))
            .enumerate();
        let cells = cells
            .map(|(index, cell)| cell.filter(|_| ![3, 40, 41].contains(&index)))
            .collect();
        let axes = (
            axis("roughness.hurst", Spacing::Linear, hursts),
            Some(kappas()),
        );
        study(
            "Phase diagram of adhesion",
            &["F_n/(E* h L) = 0.5"],
            axes,
            cells,
        )
    }

    /// Results at H = 0.3, as curves of two quantities. A cell is missing.
    fn sections() -> Study {
        let places = kappas().values;
        let cells = places
            .iter()
            .map(|kappa| Some(cell(*kappa, 0.3)))
            .enumerate();
        let cells = cells
            .map(|(index, cell)| cell.filter(|_| index != 4))
            .collect();
        study(
            "Sections at H = 0.3",
            &["H = 0.3", "F_n/(E* h L) = 0.5"],
            (kappas(), None),
            cells,
        )
    }

    fn figure(Study { title, grid }: &Study) -> Figure {
        let map = |quantity| study_map(grid, quantity, false, None);
        let charts =
            |quantity| map(quantity).map_or_else(|| study_curves(grid, quantity), |map| vec![map]);
        study_figure(title, grid, [SHARE, COEFFICIENT].map(charts).concat())
    }

    /// Returns the estimates in all cells of the quantity with the index `layer`.
    fn estimates(study: &mut Study, layer: usize) -> impl Iterator<Item = &mut Option<Statistics>> {
        study
            .grid
            .cells
            .iter_mut()
            .flatten()
            .flatten()
            .map(move |cell| &mut cell.statistics[layer])
    }

    #[test]
    fn words_lie_within_the_picture_and_not_on_each_other() {
        let mut large = phase_map();
        large.title = "A title that is a good deal longer than the figure is wide ".repeat(4);
        // The numbers on this axis differ only in their last digits, so that their labels are long.
        let mut long = [phase_map(), sections()];
        for study in &mut long {
            study.grid.layers[0].range = Some((1e5, 1e5 + 1.0));
            for one in estimates(study, 0).flatten() {
                *one = with_interval(1e5 + one.mean, (1e5, 1e5 + 1.0));
            }
        }
        let [long_map, long_sections] = long;
        for study in [large, sections(), phase_map(), long_map, long_sections] {
            check_picture(&figure(&study).svg());
        }
    }

    #[test]
    fn each_protocol_vanishes_at_its_own_place() {
        let upright = |study: &Study, quantity| -> (String, f64) {
            let layers = study_curves(&study.grid, quantity).remove(0).layers;
            let line = |Layer { name, shape, .. }: Layer| match shape {
                Shape::Upright(x) => Some((name.to_string(), x)),
                _ => None,
            };
            let lines: Vec<_> = layers.into_iter().filter_map(line).collect();
            assert_eq!(lines.len(), 1, "{lines:?}");
            lines[0].clone()
        };
        let mut study = sections();
        let own = upright(&study, SHARE);
        assert_eq!(own.0, "F_a(d=0) = 0.05 F_a,max");
        // Figures of other quantities also mark where F_a(d=0) vanishes.
        assert_eq!(upright(&study, COEFFICIENT), own);
        study.grid.layers[1].quantity = Quantity::ZeroForceAdhesionShare;
        let shares: Vec<_> = estimates(&mut study, 0).map(|one| *one).collect();
        for (estimate, share) in estimates(&mut study, 1).zip(shares) {
            *estimate = share.map(|one| Statistics {
                mean: 2.0 * one.mean,
                ..one
            });
        }
        let later = upright(&study, Quantity::ZeroForceAdhesionShare);
        assert!(later.1 > own.1, "{later:?} {own:?}");
        assert_eq!(later.0, "F_a(F=0) = 0.05 F_a,max");
        // If the study has recorded only F_a(F=0)/F_a,max, figures of other quantities mark where
        // F_a(F=0) vanishes.
        study.grid.layers[0].quantity = COEFFICIENT;
        assert_eq!(upright(&study, COEFFICIENT), later);
        let mut map = phase_map();
        map.grid.layers[0].quantity = Quantity::ZeroForceAdhesionShare;
        let legend = figure(&map).legend();
        assert!(
            legend.iter().any(|entry| entry.name.to_string() == later.0),
            "{legend:?}"
        );
    }

    #[test]
    fn equal_curves_are_drawn_once() {
        let one = sections();
        let mut cells = one.grid.cells.clone();
        cells.extend(one.grid.cells.iter().cloned().map(|cell| {
            cell.map(|cell| {
                cell.map(|mut cell| {
                    cell.statistics[1] = cell.statistics[1].map(|one| estimate(0.5 * one.mean));
                    cell
                })
            })
        }));
        let up = axis("loading.0.0", Spacing::List, vec![1e-3, 2e-3]);
        let grid = Grid::new(
            kappas(),
            Some(up),
            Vec::new(),
            one.grid.layers.clone(),
            cells,
        );
        let charts = [SHARE, COEFFICIENT].map(|quantity| study_curves(&grid, quantity));
        let legend = study_figure("", &grid, charts.concat()).legend();
        let names: Vec<String> = legend.iter().map(|entry| entry.name.to_string()).collect();
        let stage = "force of stage 1";
        let [one, two] = ["1 mN", "2 mN"].map(|force| format!("{stage} {force}"));
        let vanishing = "F_a(d=0) = 0.05 F_a,max".to_owned();
        assert_eq!(
            names,
            [
                format!("any {stage}"),
                vanishing,
                one,
                two,
                "95 % confidence of the mean".into()
            ]
        );
    }

    #[test]
    fn figures_of_one_value_or_none_are_drawn() {
        for mut study in [phase_map(), sections()] {
            study.grid.cells.fill(None);
            check_picture(&figure(&study).svg());
            for value in [0.0, -2.0, 1e-300] {
                for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
                    let across = axis(
                        &study.grid.across.path,
                        study.grid.across.spacing,
                        vec![0.5],
                    );
                    let one = Statistics::of(vec![value], SHARE.bounds());
                    let cell = GridCell {
                        statistics: vec![one; 2],
                        regimes: Default::default(),
                    };
                    let rows = study.grid.size().1;
                    let range = Some((value, value));
                    let layers = study.grid.layers.iter().map(|layer| GridLayer {
                        scale,
                        range,
                        ..*layer
                    });
                    let cells = vec![Some(Ok(cell)); rows];
                    let grid = Grid::new(
                        across,
                        study.grid.up.clone(),
                        Vec::new(),
                        layers.collect(),
                        cells,
                    );
                    check_picture(
                        &figure(&Study {
                            title: String::new(),
                            grid,
                        })
                        .svg(),
                    );
                }
            }
        }
    }

    #[test]
    fn figures_as_text_stay_as_they_are() {
        use asperity_plot::{Palette, figure_text};
        let mut foreign = phase_map();
        foreign.title = "\u{1b}]52;c;eA==\u{7} a\u{202e}b \u{9b}2J".into();
        for study in [phase_map(), sections(), foreign] {
            for columns in [40, 80, 200] {
                let text = figure_text(&figure(&study), columns, Palette::PLAIN);
                let widest = text.lines().map(|line| line.chars().count()).max();
                assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
                assert!(
                    text.chars()
                        .all(|c| c == '\n' || !asperity_data::is_control(c)),
                    "{text}"
                );
            }
        }
        assert!(figure_text(&figure(&phase_map()), 80, Palette::DARK).contains("\x1b[38;2;"));
        insta::assert_snapshot!(
            "study_map",
            figure_text(&figure(&phase_map()), 80, Palette::PLAIN)
        );
    }
}
