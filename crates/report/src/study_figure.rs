//! Figures of studies: a map over two axes, or curves along one axis.

use asperity_data::AxisScale;
use asperity_plot::{
    Chart, ChartAxis, Class, Contour, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Sign,
    Span, Stroke, value_label,
};
use asperity_scene::Regime;
use asperity_study::maps::Grid;
use asperity_study::{Quantity, Statistics};

/// Smallest number of decades of a quantity that gets a second, logarithmic chart.
const DECADES_FOR_SECOND: f64 = 1.5;
/// Largest number of decades of a logarithmic axis and of the colour scale of a map.
const MOST_DECADES: f64 = 12.0;
const MOST_DECADES_OF_MAP: f64 = 6.0;

/// Upper end, in units of the largest mean, above which a confidence interval is not drawn. Few
/// profiles have wide intervals.
const MOST_OF_BAND: f64 = 2.0;

/// Smallest ratio of the ranges of both signs whose colours show the sign.
const LEAST_OF_A_SIGN: f64 = 0.25;

/// Regimes on a map, each with its sign in a picture, letter in a terminal, and ink.
const REGIMES: [(Regime, Sign, char, Ink); 3] = [
    (Regime::PressureInsensitive, Sign::Dot, 'i', Ink::Surface),
    (Regime::PressureSensitive, Sign::Up, 's', Ink::Manual),
    (Regime::NonAdhesive, Sign::Cross, 'n', Ink::Quiet),
];

/// Returns a figure with these charts of a parameter study. Lines below the title give the values
/// on those axes of the study that do not vary in the charts.
pub fn study_figure(title: &str, grid: &Grid, charts: Vec<Chart>) -> Figure {
    let statements = grid.fixed.iter().map(|fixed| Label::statement(fixed));
    let fixed = statements.reduce(|line, statement| line.then(", ").join(&statement));
    let (title, notes) = (title.into(), fixed.into_iter().collect());
    Figure {
        title,
        notes,
        charts,
        size: Figure::SMALL,
        ..Figure::default()
    }
}

/// Returns a heat map with the two axes of `grid`. Its values are means of a quantity over the
/// random profiles. `None` if `grid` has one axis. Markers (in a terminal letters) show the regimes
/// of adhesion. If `whole` is true, a cell that is not computed yet shows the value of a computed
/// cell nearby.
pub fn study_map(grid: &Grid, quantity: Quantity, whole: bool) -> Option<Chart> {
    let (across, up) = (&grid.across, grid.up.as_ref()?);
    let values = means(&grid.statistics(quantity, whole));
    let layer = grid.layer(quantity);
    let scale = layer.map_or(AxisScale::Linear, |layer| layer.scale);
    let ends = layer.map_or(Some((0.0, 1.0)), |layer| layer.range);
    let ends = ends.map_or_else(Vec::new, |(low, high)| vec![low, high]);
    // Both signs of a quantity have colours of their own, unless one of them is rare.
    let (shades, range) = match ends.as_slice() {
        [low, high] if -low > LEAST_OF_A_SIGN * high && *high > -LEAST_OF_A_SIGN * low => (
            Shades::Diverging,
            Span::around([-low, *low, *high, -high].into_iter(), 0.0),
        ),
        _ => (
            Shades::Sequential,
            Span::of_values(scale, ends.into_iter(), MOST_DECADES_OF_MAP),
        ),
    };
    let class =
        |regime: &Option<Regime>| REGIMES.iter().position(|(one, ..)| Some(*one) == *regime);
    // The axis of a regime names its protocol; beside other quantities letters show the regime from
    // first touch.
    let letters_of = match quantity.is_regime() {
        true => String::new(),
        false => format!(" ({})", quantity.short_protocol()),
    };
    let class_names = REGIMES.map(|(regime, sign, letter, ink)| Class {
        sign,
        letter: Some(letter),
        name: format!("{}{letters_of}", regime.name()),
        ink,
    });
    let map = HeatMap {
        columns: across.values.clone(),
        rows: up.values.clone(),
        values,
        key: axis_of(quantity, scale, range),
        shades,
        classes: grid.regimes(quantity, whole).iter().map(class).collect(),
        class_names: class_names.to_vec(),
        contour: vanishing(grid, quantity).map(|share| Contour {
            name: vanishing_label(share),
            field: means(&grid.statistics(share, whole)),
            level: Regime::VANISHING_SHARE,
        }),
    };
    Some(Chart {
        heading: heading(quantity),
        x: axis_over(across, HeatMap::span(across.scale(), &across.values)),
        y: axis_over(up, HeatMap::span(up.scale(), &up.values)),
        layers: vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))],
    })
}

/// Returns a chart of a quantity over the first axis of `grid`, with a curve for each value of the
/// second axis. If the vertical axis is linear and the largest mean is at least 10^1.5 times the
/// smallest mean above zero, a second chart with a logarithmic vertical axis follows.
pub fn study_curves(grid: &Grid, quantity: Quantity) -> Vec<Chart> {
    let across = &grid.across;
    let scale = grid
        .layer(quantity)
        .map_or(AxisScale::Linear, |layer| layer.scale);
    let estimates = grid.statistics(quantity, false);
    let places = coordinates(across);
    let layers = layers(grid, quantity, &estimates);
    let is_small = scale == AxisScale::Linear && spans_decades(&estimates);
    let chart = |scale: AxisScale| {
        let x = axis_over(across, Span::around(places.iter().copied(), 0.03));
        let y = axis_of(quantity, scale, range(grid, quantity, &estimates, scale));
        let scale = if is_small && scale == AxisScale::Logarithmic {
            ", logarithmic scale"
        } else {
            ""
        };
        Chart {
            heading: heading(quantity).then(scale),
            ..Chart::new(x, y, layers.clone())
        }
    };
    std::iter::once(chart(scale))
        .chain(is_small.then(|| chart(AxisScale::Logarithmic)))
        .collect()
}

fn means(estimates: &[Option<Statistics>]) -> Vec<Option<f64>> {
    estimates
        .iter()
        .map(|estimate| Some((*estimate)?.mean))
        .collect()
}

fn coordinates(axis: &asperity_study::Axis) -> Vec<f64> {
    axis.values
        .iter()
        .map(|value| axis.scale().coordinate(*value))
        .collect()
}

fn axis_over(axis: &asperity_study::Axis, span: Span) -> ChartAxis {
    ChartAxis::new(axis.scale(), span, &axis.name, axis.symbol, axis.unit)
}

fn name(quantity: Quantity) -> String {
    if quantity.is_regime() {
        return format!("regime {}", quantity.protocol());
    }
    let hyphenated = [
        ("first touch", "first-touch"),
        ("zero force a", "zero-force a"),
        ("pull off", "pull-off"),
    ];
    let name = quantity.name().replace('_', " ");
    hyphenated
        .iter()
        .fold(name, |name, (words, word)| name.replace(words, word))
}

fn heading(quantity: Quantity) -> Label {
    Label::quantity(&name(quantity), quantity.symbol())
}

fn axis_of(quantity: Quantity, scale: AxisScale, span: Span) -> ChartAxis {
    let name = if quantity.symbol().is_empty() {
        name(quantity)
    } else {
        String::new()
    };
    ChartAxis::new(scale, span, &name, quantity.symbol(), quantity.unit())
}

/// Returns the recorded F_a(d=0)/F_a,max whose vanishing is drawn in a figure of this quantity. It
/// is the quantity itself, or the first recorded one.
fn vanishing(grid: &Grid, quantity: Quantity) -> Option<Quantity> {
    let shares = Quantity::ADHESION_SHARES;
    let own = shares.contains(&quantity).then_some(quantity);
    own.or_else(|| {
        shares
            .into_iter()
            .find(|share| grid.layer(*share).is_some())
    })
}

/// Returns the name of the boundary in the legend: `F_a(F=0) = 0.05 F_a,max`.
fn vanishing_label(share: Quantity) -> Label {
    let (force, ideal) = share
        .symbol()
        .split_once('/')
        .unwrap_or((share.symbol(), ""));
    Label::symbol(&format!("{force} = {} {ideal}", Regime::VANISHING_SHARE))
}

fn range(
    grid: &Grid,
    quantity: Quantity,
    estimates: &[Option<Statistics>],
    scale: AxisScale,
) -> Span {
    let known = || estimates.iter().flatten();
    let from = Span::of_values(scale, known().map(|estimate| estimate.mean), MOST_DECADES);
    let ends = known().flat_map(|one| {
        let ((low, high), [lower, _, upper]) = (one.ends(), one.quartiles);
        let shown = if grid.up.is_none() { 5 } else { 3 };
        [one.mean, low, high, lower, upper].into_iter().take(shown)
    });
    let all = Span::around(ends.map(|end| scale.coordinate(end)), 0.0);
    match scale {
        AxisScale::Linear if quantity.bounds().0 == 0.0 && from.low == 0.0 => {
            let high = all.high.min(MOST_OF_BAND * from.high);
            Span {
                low: -0.03 * high,
                high: 1.05 * high,
            }
        }
        AxisScale::Linear => all.widened(0.05),
        AxisScale::Logarithmic => {
            let most = from.high + MOST_OF_BAND.log10();
            Span {
                high: all.high.clamp(from.high, most),
                ..from
            }
            .widened(0.05)
        }
    }
}

/// Returns true if a quantity falls over too many decades for a linear scale.
fn spans_decades(estimates: &[Option<Statistics>]) -> bool {
    let means = || estimates.iter().flatten().map(|estimate| estimate.mean);
    let above = means().filter(|mean| *mean > 0.0);
    let lowest = above.clone().fold(f64::INFINITY, f64::min);
    let highest = above.fold(0.0, f64::max);
    means().all(|mean| mean >= 0.0) && (highest / lowest).log10() >= DECADES_FOR_SECOND
}

/// Returns layers of the curves with their confidence intervals, and for a single curve also median
/// and quartiles of the profiles. Vertical lines mark where adhesion without a preload vanishes.
fn layers(grid: &Grid, quantity: Quantity, estimates: &[Option<Statistics>]) -> Vec<Layer> {
    let places = &grid.across.values;
    let curves: Vec<_> = estimates.chunks(places.len().max(1)).collect();
    let mut layers = Vec::new();
    let mut add = |name: Label, ink: Ink, sign: Sign, estimates: &[Option<Statistics>]| {
        let known = || places.iter().copied().zip(estimates);
        if estimates
            .iter()
            .flatten()
            .any(|one| one.ends().0 < one.ends().1)
        {
            let ends =
                |one: &Option<Statistics>| one.map_or((f64::NAN, f64::NAN), |one| one.ends());
            let band = known()
                .map(|(x, one)| (x, ends(one).0, ends(one).1))
                .collect();
            layers.push(Layer::new(
                "95 % confidence of the mean".into(),
                ink,
                Shape::Band(band),
            ));
        }
        let points = |of: fn(&Statistics) -> f64| {
            known()
                .map(move |(x, one)| (x, one.as_ref().map_or(f64::NAN, of)))
                .collect::<Vec<_>>()
        };
        if grid.up.is_none() && estimates.iter().flatten().any(|one| one.count > 1) {
            let band = points(|one| one.quartiles[0])
                .into_iter()
                .zip(points(|one| one.quartiles[2]));
            let band = band
                .map(|((x, lower), (_, upper))| (x, lower, upper))
                .collect();
            layers.push(Layer::new(
                "quartiles of the profiles".into(),
                Ink::Quiet,
                Shape::Band(band),
            ));
            let median = Shape::line(points(|one| one.quartiles[1]), Stroke::Dashed);
            layers.push(Layer::new("median".into(), Ink::Quiet, median));
        }
        let (points, stroke) = (points(|one| one.mean), Some(Stroke::Solid));
        layers.push(Layer::new(
            name,
            ink,
            Shape::Curve {
                points,
                stroke,
                sign: Some(sign),
            },
        ));
    };
    match (&grid.up, curves.first()) {
        // Curves that are equal to the last bit do not depend on the axis up.
        (Some(up), Some(first)) if curves.iter().all(|curve| curve == first) => {
            let symbol = Label::symbol_or_name(up.symbol, &up.name);
            add(
                Label::plain("any ").join(&symbol),
                Ink::Quiet,
                Sign::Dot,
                first,
            );
        }
        (Some(up), _) => {
            for (number, (curve, value)) in curves.iter().zip(&up.values).enumerate() {
                let name = value_label(&up.name, up.symbol, up.unit, *value);
                add(name, Ink::Series(number), Sign::of_series(number), curve);
            }
        }
        (None, first) => {
            first
                .into_iter()
                .for_each(|curve| add("mean".into(), Ink::Series(0), Sign::Dot, curve));
        }
    }
    layers.extend(vanishing(grid, quantity).into_iter().flat_map(|share| {
        let at = |crossing| Shape::Upright(grid.across.scale().number(crossing));
        crossings(grid, share)
            .into_iter()
            .map(move |crossing| Layer::new(vanishing_label(share), Ink::Quiet, at(crossing)))
    }));
    layers
}

/// Returns the coordinates on the horizontal axis at which F_a(d=0)/F_a,max vanishes.
fn crossings(grid: &Grid, share: Quantity) -> Vec<f64> {
    let shares = means(&grid.statistics(share, false));
    let places = coordinates(&grid.across);
    // Without a preload all curves are equal; curves that differ have no single crossing.
    let mut curves = shares.chunks(places.len().max(1));
    let first = curves.next();
    if curves.any(|curve| Some(curve) != first) {
        return Vec::new();
    }
    let ends = places.windows(2).zip(first.unwrap_or_default().windows(2));
    ends.filter_map(|(x, value)| {
        let (first, second) = (
            value[0]? - Regime::VANISHING_SHARE,
            value[1]? - Regime::VANISHING_SHARE,
        );
        let crosses = (first < 0.0) != (second < 0.0);
        crosses.then(|| x[0] + (x[1] - x[0]) * first / (first - second))
    })
    .collect()
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
            ..Statistics::of(vec![mean], Quantity::AdhesionForce.bounds()).unwrap()
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

    /// A map of two quantities over H and κ, with gaps.
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

    /// Curves of both quantities at H = 0.3, with a gap.
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
        let map = |quantity| study_map(grid, quantity, false);
        let charts =
            |quantity| map(quantity).map_or_else(|| study_curves(grid, quantity), |map| vec![map]);
        study_figure(title, grid, [SHARE, COEFFICIENT].map(charts).concat())
    }

    /// Estimates of a quantity in all cells.
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
        // Numbers that differ only in late digits.
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
        // A quantity other than a share of F_a(d=0) shows where F_a(d=0) vanishes.
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
        // Recorded alone, the share after zero force bounds the other quantities.
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
        use asperity_plot::{Colours, figure_text};
        let mut foreign = phase_map();
        foreign.title = "\u{1b}]52;c;eA==\u{7} a\u{202e}b \u{9b}2J".into();
        for study in [phase_map(), sections(), foreign] {
            for columns in [40, 80, 200] {
                let text = figure_text(&figure(&study), columns, Colours::None);
                let widest = text.lines().map(|line| line.chars().count()).max();
                assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
                assert!(
                    text.chars()
                        .all(|c| c == '\n' || !asperity_data::is_control(c)),
                    "{text}"
                );
            }
        }
        assert!(figure_text(&figure(&phase_map()), 80, Colours::All).contains("\x1b[38;2;"));
        insta::assert_snapshot!(
            "study_map",
            figure_text(&figure(&phase_map()), 80, Colours::None)
        );
    }
}
