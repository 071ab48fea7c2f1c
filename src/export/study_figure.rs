//! Figures of studies: a map over two axes, or sections along one.

use crate::analysis::Regime;
use crate::draw::{
    Axis, AxisScale, Chart, Class, Contour, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Sign, Span,
    Stroke, value_label,
};
use crate::study::figure::{Estimate, Figure as Study, FigureAxis, Panel};

/// Fewest decades of a quantity with a logarithmic inset.
const DECADES_FOR_INSET: f64 = 1.5;
/// Most decades of a logarithmic axis, and of the colour scale of a map.
const MOST_DECADES: f64 = 12.0;
const MOST_DECADES_OF_MAP: f64 = 6.0;

/// Regimes of a map: sign, letter, ink.
const REGIMES: [(Regime, Sign, char, Ink); 3] = [
    (Regime::PressureInsensitive, Sign::Dot, 'i', Ink::Surface),
    (Regime::PressureSensitive, Sign::Up, 's', Ink::Manual),
    (Regime::NonAdhesive, Sign::Cross, 'n', Ink::Quiet),
];

/// A figure of a study.
#[must_use]
pub fn study_figure(study: &Study) -> Figure {
    let statements = study.fixed.iter().map(|fixed| Label::statement(fixed));
    let fixed = statements.reduce(|line, statement| line.then(", ").join(&statement));
    let chart = |panel: &Panel| match &study.up {
        Some(up) => map(study, up, panel),
        None => sections(study, panel),
    };
    Figure {
        title: study.title.clone(),
        notes: fixed.into_iter().collect(),
        charts: study.panels.iter().map(chart).collect(),
        size: Figure::SMALL,
    }
}

fn axis_over(axis: &FigureAxis, span: Span) -> Axis {
    Axis::new(axis.scale, span, &axis.name, &axis.symbol, &axis.unit)
}

/// Name and symbol of the quantity of a panel.
fn heading(panel: &Panel) -> Label {
    Label::quantity(&panel.quantity.name, &panel.quantity.symbol)
}

/// Axis of a quantity: its symbol, or its name if it has none.
fn axis_of(panel: &Panel, scale: AxisScale, span: Span) -> Axis {
    let quantity = &panel.quantity;
    let name = if quantity.symbol.is_empty() { quantity.name.as_str() } else { "" };
    Axis::new(scale, span, name, &quantity.symbol, &quantity.unit)
}

fn map(study: &Study, up: &FigureAxis, panel: &Panel) -> Chart {
    let across = &study.across;
    let means = panel.estimates.iter().map(|estimate| estimate.map(|estimate| estimate.mean));
    let values: Vec<Option<f64>> = means.collect();
    let ends = panel.range.map(|(low, high)| vec![low, high]);
    let ends = ends.unwrap_or_else(|| values.iter().flatten().copied().collect());
    let range = Span::of_values(panel.scale, ends.into_iter(), MOST_DECADES_OF_MAP);
    let class = |regime: &Option<Regime>| REGIMES.iter().position(|(one, ..)| Some(*one) == *regime);
    let map = HeatMap {
        columns: across.values.clone(),
        rows: up.values.clone(),
        values,
        key: axis_of(panel, panel.scale, range),
        shades: Shades::Sequential,
        classes: study.regimes.iter().map(class).collect(),
        class_names: REGIMES
            .map(|(regime, sign, letter, ink)| Class {
                sign,
                letter: Some(letter),
                name: regime.name().to_owned(),
                ink,
            })
            .to_vec(),
        contour: study.boundary_of(panel).map(|boundary| Contour {
            name: Label::symbol(&boundary.label),
            field: boundary.values,
            level: boundary.level,
        }),
    };
    Chart {
        heading: heading(panel),
        x: axis_over(across, HeatMap::span(across.scale, &across.values)),
        y: axis_over(up, HeatMap::span(up.scale, &up.values)),
        layers: vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))],
        inset: None,
    }
}

fn sections(study: &Study, panel: &Panel) -> Chart {
    let across = &study.across;
    let axes = |scale: AxisScale| {
        let x = axis_over(across, Span::around(across.coordinates().into_iter(), 0.03));
        (x, axis_of(panel, scale, range(panel, scale)))
    };
    let layers = layers(study, panel);
    let inset = (panel.scale == AxisScale::Linear && spans_decades(panel)).then(|| {
        let (x, y) = axes(AxisScale::Logarithmic);
        let layers = layers.iter().filter(|layer| !matches!(layer.shape, Shape::Upright(_))).cloned();
        Box::new(Chart::new(x, y, layers.collect()))
    });
    let (x, y) = axes(panel.scale);
    Chart { heading: heading(panel), x, y, layers, inset }
}

/// Range of the vertical axis of sections.
fn range(panel: &Panel, scale: AxisScale) -> Span {
    let estimates = || panel.estimates.iter().flatten();
    let means = || estimates().map(|estimate| estimate.mean);
    let from = Span::of_values(scale, means(), MOST_DECADES);
    let ends = estimates().flat_map(|estimate| [estimate.mean, estimate.low, estimate.high]);
    let all = Span::around(ends.map(|end| scale.coordinate(end)), 0.0);
    match scale {
        // A confidence interval below zero has no meaning for a quantity that is never negative.
        AxisScale::Linear if !panel.quantity.signed && from.low == 0.0 => {
            Span { low: -0.03 * all.high, high: 1.05 * all.high }
        }
        AxisScale::Linear => all.widened(0.05),
        AxisScale::Logarithmic => Span { high: from.high.max(all.high), ..from }.widened(0.05),
    }
}

/// Returns true if a quantity falls too far for a linear scale.
fn spans_decades(panel: &Panel) -> bool {
    let means = || panel.estimates.iter().flatten().map(|estimate| estimate.mean);
    let above = means().filter(|mean| *mean > 0.0);
    let lowest = above.clone().fold(f64::INFINITY, f64::min);
    let highest = above.fold(0.0, f64::max);
    means().all(|mean| mean >= 0.0) && (highest / lowest).log10() >= DECADES_FOR_INSET
}

/// Curves with their confidence, and upright lines where F_a(0) vanishes.
fn layers(study: &Study, panel: &Panel) -> Vec<Layer> {
    let places = &study.across.values;
    let curves: Vec<_> = panel.estimates.chunks(places.len().max(1)).collect();
    let mut layers = Vec::new();
    let mut add = |name: Label, ink: Ink, sign: Sign, estimates: &[Option<Estimate>]| {
        let known = || places.iter().zip(estimates);
        let of = |figure: fn(&Estimate) -> f64, estimate: &Option<Estimate>| {
            estimate.as_ref().map_or(f64::NAN, figure)
        };
        // A quantity that is never negative has no confidence below zero.
        let least = if panel.quantity.signed { f64::NEG_INFINITY } else { 0.0 };
        let band: Vec<_> = known()
            .map(|(x, estimate)| {
                (*x, of(|one| one.low, estimate).clamp(least, f64::INFINITY), of(|one| one.high, estimate))
            })
            .collect();
        if band.iter().any(|(_, low, high)| high > low) {
            layers.push(Layer::new("95 % confidence of the mean".into(), ink, Shape::Band(band)));
        }
        let points = known().map(|(x, estimate)| (*x, of(|one| one.mean, estimate))).collect();
        layers.push(Layer::new(
            name,
            ink,
            Shape::Curve { points, stroke: Some(Stroke::Solid), sign: Some(sign) },
        ));
    };
    match (&study.series, curves.first()) {
        // Curves that are equal to the last bit do not depend on the axis of the series.
        (Some(series), Some(first)) if curves.iter().all(|curve| curve == first) => {
            let symbol = Label::symbol_or_name(&series.symbol, &series.name);
            add(Label::plain("any ").join(&symbol), Ink::Quiet, Sign::Dot, first);
        }
        (Some(FigureAxis { name, symbol, unit, values, .. }), _) => {
            for (number, (curve, value)) in curves.iter().zip(values).enumerate() {
                let name = value_label(name, symbol, unit, *value);
                add(name, Ink::Series(number), Sign::of_series(number), curve);
            }
        }
        (None, first) => {
            first.into_iter().for_each(|curve| add("mean".into(), Ink::Series(0), Sign::Dot, curve));
        }
    }
    if let Some(boundary) = &study.boundary {
        let name = Label::symbol(&boundary.label);
        layers.extend(study.crossings(panel).into_iter().map(|crossing| {
            Layer::new(name.clone(), Ink::Quiet, Shape::Upright(study.across.scale.number(crossing)))
        }));
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::{attribute, elements, parsed};
    use crate::study::figure::{Boundary, FigureQuantity};

    fn axis(name: &str, symbol: &str, scale: AxisScale, values: Vec<f64>) -> FigureAxis {
        FigureAxis { name: name.into(), symbol: symbol.into(), unit: "1".into(), scale, values }
    }

    /// An axis of preloads without values.
    fn preloads() -> FigureAxis {
        FigureAxis { unit: "N".into(), ..axis("preload", "F_n", AxisScale::Logarithmic, Vec::new()) }
    }

    fn quantity(name: &str, symbol: &str) -> FigureQuantity {
        FigureQuantity { name: name.into(), symbol: symbol.into(), unit: "1".into(), signed: false }
    }

    fn kappas() -> Vec<f64> {
        (0..17).map(|index| 0.25 * 10_f64.powf(f64::from(index) / 10.0)).collect()
    }

    fn share(kappa: f64, hurst: f64) -> f64 {
        1.0 / (1.0 + (kappa / (1.6 + 0.8 * hurst)).powi(5))
    }

    fn coefficient(kappa: f64, hurst: f64) -> f64 {
        let held = 1.0 - share(kappa, hurst);
        0.9 * held * (-(kappa - 2.0) / 1.1).exp()
    }

    fn estimate(mean: f64) -> Option<Estimate> {
        Some(Estimate { mean, low: mean * 0.85 - 0.004, high: mean * 1.15 + 0.004 })
    }

    /// Two quantities in cells (κ, H) with their boundary, without axes; some cells have no value.
    fn study(title: &str, fixed: &[&str], cells: &[(f64, f64)], missing: &[usize]) -> Study {
        let panel = |name: &str, symbol: &str, value: fn(f64, f64) -> f64| {
            let of = |(index, (kappa, hurst)): (usize, &(f64, f64))| {
                estimate(value(*kappa, *hurst)).filter(|_| !missing.contains(&index))
            };
            Panel {
                quantity: quantity(name, symbol),
                estimates: cells.iter().enumerate().map(of).collect(),
                scale: AxisScale::Linear,
                range: None,
                vanishes: name == "zero-load adhesion share",
            }
        };
        Study {
            title: title.into(),
            fixed: fixed.iter().map(ToString::to_string).collect(),
            across: axis("governing parameter", "κ", AxisScale::Logarithmic, kappas()),
            up: None,
            series: None,
            panels: vec![
                panel("zero-load adhesion share", "F_a(0)/F_a,max", share),
                panel("adhesion coefficient", "F_a/F_n", coefficient),
            ],
            boundary: Some(Boundary {
                values: cells.iter().map(|(kappa, hurst)| Some(share(*kappa, *hurst))).collect(),
                level: 0.05,
                label: "F_a(0) = 0.05 F_a,max".into(),
            }),
            regimes: Vec::new(),
        }
    }

    /// A map of two quantities over H and κ, with gaps.
    fn phase_map() -> Study {
        let hursts: Vec<f64> = (0..9).map(|index| f64::from(index + 1) / 10.0).collect();
        let cells: Vec<(f64, f64)> =
            kappas().into_iter().flat_map(|kappa| hursts.iter().map(move |hurst| (kappa, *hurst))).collect();
        let regime = |&(kappa, hurst): &(f64, f64)| {
            Some(match (share(kappa, hurst), coefficient(kappa, hurst)) {
                (share, _) if share > 0.5 => Regime::PressureInsensitive,
                (_, coefficient) if coefficient > 0.01 => Regime::PressureSensitive,
                _ => Regime::NonAdhesive,
            })
        };
        let study = study("Phase diagram of adhesion", &["F_n/(E* h L) = 0.5"], &cells, &[3, 40, 41]);
        Study {
            regimes: cells.iter().map(regime).collect(),
            up: Some(study.across.clone()),
            across: axis("Hurst exponent", "H", AxisScale::Linear, hursts),
            ..study
        }
    }

    /// Sections of both quantities at H = 0.3, with a gap.
    fn sections() -> Study {
        let cells: Vec<(f64, f64)> = kappas().into_iter().map(|kappa| (kappa, 0.3)).collect();
        study("Sections at H = 0.3", &["H = 0.3", "F_n/(E* h L) = 0.5"], &cells, &[4])
    }

    fn drawn(study: &Study) -> String {
        study_figure(study).svg()
    }

    #[test]
    fn figures_name_what_they_show() {
        for (study, words) in [
            (phase_map(), vec!["pressure-sensitive", "non-adhesive", "no value", "Hurst exponent"]),
            (sections(), vec!["95 % confidence of the mean", "mean", "governing parameter"]),
        ] {
            let svg = drawn(&study);
            let text = parsed(&svg).1;
            for word in words {
                assert!(text.contains(word), "{word}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "no number is lost");
        }
    }

    #[test]
    fn foreign_text_neither_breaks_a_picture_nor_controls_a_terminal() {
        let mut study = phase_map();
        study.title = "\u{1b}]52;c;eA==\u{7}<&> \u{ffff} a\u{202e}b \u{9b}2J".into();
        study.fixed = vec!["\u{1b}[2J = <&>".into()];
        study.across.name = "\u{1b}[2J<&>".into();
        let svg = drawn(&study);
        parsed(&svg);
        assert!(svg.chars().all(|c| c == '\n' || !(crate::text::is_control(c) || c == '\u{ffff}')), "{svg}");
        assert!(svg.contains("]52;c;eA==") && svg.contains("&lt;&amp;&gt;"), "{svg}");
    }

    #[test]
    fn each_cell_with_a_value_is_coloured_and_the_others_are_not() {
        let study = phase_map();
        let all: usize = study.panels.iter().map(|panel| panel.estimates.len()).sum();
        let missing: usize =
            study.panels.iter().map(|panel| panel.estimates.iter().filter(|one| one.is_none()).count()).sum();
        let rects = elements(&drawn(&study), "rect");
        let hatched = rects.iter().filter(|rect| rect.contains("#hatched"));
        let area: f64 = hatched.map(|rect| attribute(rect, "width") * attribute(rect, "height")).sum();
        // The cells, all of one size, and a sample of 12 × 12 px in the legend.
        let cell = study.panels.len() as f64 * 330.0 * 270.0 / all as f64;
        assert!((area - 144.0 - missing as f64 * cell).abs() < 5.0, "{area} {missing} {cell}");
    }

    #[test]
    fn words_lie_within_the_picture_and_not_on_each_other() {
        let mut large = phase_map();
        large.title = "A title that is a good deal longer than the figure is wide ".repeat(4);
        // Numbers that differ only in late digits.
        let mut long = [phase_map(), sections()];
        for estimate in long.iter_mut().flat_map(|study| study.panels[0].estimates.iter_mut().flatten()) {
            *estimate = Estimate { mean: 1e5 + estimate.mean, low: 1e5, high: 1e5 + 1.0 };
        }
        let [long_map, long_sections] = long;
        for study in [large, sections(), phase_map(), long_map, long_sections] {
            let svg = drawn(&study);
            let paper = &elements(&svg, "rect")[0];
            let size = (attribute(paper, "width"), attribute(paper, "height"));
            let mut boxes: Vec<(f64, f64, f64, f64)> = Vec::new();
            for (element, rest) in svg.split("<text").skip(1).map(|rest| rest.split_once('>').unwrap()) {
                let words = rest.split("</text>").next().unwrap_or_default();
                let plain: String =
                    words.split('<').map(|part| part.rsplit('>').next().unwrap_or("")).collect();
                let (x, y) = (attribute(element, "x"), attribute(element, "y"));
                let height = attribute(element, "font-size");
                let width = 0.9 * Label::plain(plain.trim()).width() * height;
                let left = match () {
                    () if element.contains("\"middle\"") => x - width / 2.0,
                    () if element.contains("\"end\"") => x - width,
                    () => x,
                };
                let (middle, half) = (y - 0.35 * height, 0.4 * height);
                let place = if element.contains("rotate") {
                    (x - half, middle - width / 2.0, x + half, middle + width / 2.0)
                } else {
                    (left, middle - half, left + width, middle + half)
                };
                assert!(
                    place.0 > 0.0 && place.1 > 0.0 && place.2 < size.0 && place.3 < size.1,
                    "{plain}: {place:?} {size:?}"
                );
                let over = |other: &&(f64, f64, f64, f64)| {
                    place.0 < other.2 && other.0 < place.2 && place.1 < other.3 && other.1 < place.3
                };
                assert_eq!(boxes.iter().find(over), None, "{plain}: {place:?}");
                boxes.push(place);
            }
            assert!(boxes.len() > 20);
        }
    }

    #[test]
    fn each_protocol_vanishes_at_its_own_place() {
        let mut study = sections();
        let upright = |study: &Study, index: usize| -> Vec<f64> {
            let layers = study_figure(study).charts[index].layers.clone();
            let x = |layer: Layer| if let Shape::Upright(x) = layer.shape { Some(x) } else { None };
            layers.into_iter().filter_map(x).collect()
        };
        let own = upright(&study, 0);
        assert_eq!(own.len(), 1, "{own:?}");
        // A quantity other than a share of F_a(0) shows where F_a(0) vanishes.
        assert_eq!(upright(&study, 1), own);
        let shares = study.panels[0].estimates.clone();
        let twice = |estimate: Option<Estimate>| {
            estimate.map(|estimate| Estimate { mean: 2.0 * estimate.mean, ..estimate })
        };
        study.panels[1].estimates = shares.into_iter().map(twice).collect();
        study.panels[1].vanishes = true;
        let later = upright(&study, 1);
        assert!(later.len() == 1 && later[0] > own[0], "{later:?} {own:?}");
    }

    #[test]
    fn curves_that_are_the_same_are_drawn_once() {
        let mut study = sections();
        study.boundary = None;
        study.series = Some(FigureAxis { values: vec![1e-3, 2e-3], ..preloads() });
        let [share, coefficient] = &mut study.panels[..] else { panic!() };
        let same = share.estimates.clone();
        share.estimates.extend(same);
        let half = coefficient.estimates.iter().map(|one| {
            one.map(|one| Estimate { mean: 0.5 * one.mean, low: 0.5 * one.mean, high: 0.5 * one.mean })
        });
        let half: Vec<_> = half.collect();
        coefficient.estimates.extend(half);
        let names: Vec<String> =
            study_figure(&study).legend().iter().map(|entry| entry.name.to_string()).collect();
        assert_eq!(names, ["any F_n", "F_n = 1 mN", "F_n = 2 mN", "95 % confidence of the mean"]);
    }

    #[test]
    fn figures_of_one_value_or_none_are_drawn() {
        for mut study in [phase_map(), sections()] {
            study.panels.iter_mut().for_each(|panel| panel.estimates.fill(None));
            assert!(!drawn(&study).contains("NaN"));
            study.across.values.truncate(1);
            study.boundary = None;
            study.regimes.clear();
            for value in [0.0, -2.0, 1e-300] {
                for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
                    for panel in &mut study.panels {
                        let estimate = Estimate { mean: value, low: value, high: value };
                        panel.estimates =
                            vec![Some(estimate); study.up.as_ref().map_or(1, |up| up.values.len())];
                        panel.scale = scale;
                    }
                    let svg = drawn(&study);
                    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{value} {scale:?}");
                }
            }
        }
    }

    #[cfg(feature = "tui")]
    mod text {
        use super::*;
        use crate::draw::{Colours, figure_text};

        #[test]
        fn text_fits_its_columns_and_has_colours_only_where_it_may() {
            let mut foreign = phase_map();
            foreign.title = "\u{1b}]52;c;eA==\u{7} a\u{202e}b \u{9b}2J".into();
            for study in [phase_map(), sections(), foreign] {
                for columns in [40, 80, 200] {
                    let text = figure_text(&study_figure(&study), columns, Colours::None);
                    let widest = text.lines().map(|line| line.chars().count()).max();
                    assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
                    assert!(text.chars().all(|c| c == '\n' || !crate::text::is_control(c)), "{text}");
                }
            }
            let coloured = figure_text(&study_figure(&phase_map()), 80, Colours::All);
            assert!(coloured.contains("\x1b[38;2;"));
        }

        #[test]
        fn figures_as_text_stay_as_they_are() {
            let text = |study: &Study| figure_text(&study_figure(study), 80, Colours::None);
            insta::assert_snapshot!("study_map", text(&phase_map()));
            insta::assert_snapshot!("study_sections", text(&sections()));
        }
    }
}
