//! Tests of the drawing of charts in terminal cells.

use super::*;
use crate::chart::HeatMap;
use crate::chart::{StressFill, Stroke};
use crate::colour::Shades;
use crate::scale::Span;
use asperity_data::AxisScale;

const SIZES: [(u16, u16); 6] = [(20, 5), (32, 8), (47, 13), (60, 20), (80, 24), (118, 37)];

fn axis(low: f64, high: f64, symbol: &str, unit: &str) -> ChartAxis {
    ChartAxis::new(AxisScale::Linear, Span { low, high }, "", symbol, unit)
}

fn chart(layers: Vec<Layer>) -> Chart {
    let (x, y) = (
        axis(-1.3e-7, 6.4e-7, "d", "m"),
        axis(-2.1e-5, 1.2e-5, "F", "N"),
    );
    Chart::new(x, y, layers)
}

fn drawn(chart: &Chart, (width, height): (u16, u16)) -> (CellPlot, Buffer) {
    let area = Rect::new(3, 2, width, height);
    let (place, mut buffer) = (CellPlot::within(area, chart), Buffer::empty(area));
    place.draw(&mut buffer, chart, Palette::PLAIN);
    (place, buffer)
}

fn curve(points: &[(f64, f64)], sign: Option<Sign>) -> Layer {
    Layer::unnamed(
        Ink::Text,
        Shape::Curve {
            points: points.to_vec(),
            stroke: Some(Stroke::Solid),
            sign,
        },
    )
}

#[test]
fn a_value_of_a_map_is_found_at_its_cell() {
    let columns: Vec<f64> = (1..20).map(|at| 0.05 * f64::from(at)).collect();
    let rows: Vec<f64> = (0..33)
        .map(|at| 0.125 * 2_f64.powf(0.25 * f64::from(at)))
        .collect();
    let span = |scale, values: &[f64]| HeatMap::span(scale, values);
    let map = HeatMap {
        values: vec![Some(1.0); columns.len() * rows.len()],
        key: axis(0.0, 1.0, "", "1"),
        shades: Shades::Sequential,
        classes: Vec::new(),
        class_names: Vec::new(),
        contour: None,
        columns: columns.clone(),
        rows: rows.clone(),
    };
    let chart = Chart::new(
        ChartAxis::new(
            AxisScale::Linear,
            span(AxisScale::Linear, &columns),
            "",
            "H",
            "1",
        ),
        ChartAxis::new(
            AxisScale::Logarithmic,
            span(AxisScale::Logarithmic, &rows),
            "",
            "κ",
            "1",
        ),
        vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))],
    );
    for (width, height) in [(20, 5), (66, 30), (118, 37), (200, 90)] {
        let place = CellPlot::within(Rect::new(3, 2, width, height), &chart);
        for (x, y) in columns
            .iter()
            .flat_map(|x| rows.iter().map(move |y| (*x, *y)))
        {
            let cell = place.cell(&chart, (x, y)).unwrap();
            let (across, up) = place.data_at(&chart, cell).unwrap();
            // If several values share a screen cell, `across` and `up` belong to this cell or
            // to a neighbouring cell.
            let (column, row) = place.cell(&chart, (across, up)).unwrap();
            assert!(
                column.abs_diff(cell.0) <= 1 && row.abs_diff(cell.1) <= 1,
                "{x} {y} {across} {up}"
            );
            let has_room = |cells: u16, values: &[f64]| usize::from(cells) >= values.len();
            assert!(
                !has_room(place.plot.width, &columns) || across == x,
                "{x} {across}"
            );
            assert!(!has_room(place.plot.height, &rows) || up == y, "{y} {up}");
        }
        // A point beyond the map belongs to a cell at the edge of the map. A cell outside the
        // plot belongs to no point.
        let corner = Some((place.plot.right() - 1, place.plot.y));
        assert_eq!(place.cell(&chart, (9.0, 1e9)), corner);
        assert_eq!(
            place.data_at(&chart, (place.plot.right(), place.plot.y)),
            None
        );
    }
}

#[test]
fn ticks_are_beside_the_dots_of_their_values() {
    let mut labelled = 0;
    for size in SIZES {
        let level = chart(vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))]);
        let (place, buffer) = drawn(&level, size);
        let row_of = |row: u16| -> String {
            (buffer.area.x..buffer.area.right())
                .map(|column| buffer[(column, row)].symbol())
                .collect()
        };
        for row in place.plot.y..place.plot.bottom() {
            let text = row_of(row);
            if let Some((number, _)) = text.split_once(" ┤") {
                let is_level =
                    !["", " ", "\u{2800}"].contains(&buffer[(place.plot.x, row)].symbol());
                assert_eq!(number.trim() == "0", is_level, "{size:?}\n{text}");
                labelled += 1;
            }
        }
        if size.1 >= WITH_LINE_BELOW {
            let below: String = (place.plot.bottom() + 1..buffer.area.bottom())
                .map(row_of)
                .collect();
            assert!(
                below.trim_end().ends_with("d (nm)") && below.contains(" 0"),
                "{below}"
            );
        }
    }
    assert!(labelled > 20, "{labelled}");
}

/// In each width, every tick below a plot has its number, and no number is cut or covered.
#[test]
fn every_tick_below_a_plot_has_its_number() {
    let mut between = 0;
    for width in 26..=90 {
        for height in [8, 13, 20] {
            let d = axis(-1.3e-7, 7e-7, "d", "m");
            let named = Chart::new(
                ChartAxis {
                    name: "indentation".to_owned(),
                    ..d
                },
                axis(-2.1e-5, 1.2e-5, "F", "N"),
                Vec::new(),
            );
            let (place, buffer) = drawn(&named, (width, height));
            let scale = place.scale_below(&named);
            let y = place.plot.bottom() + place.between;
            let row: String = (buffer.area.x..buffer.area.right())
                .map(|x| buffer[(x, y)].symbol())
                .collect();
            let words: Vec<&str> = row.split_whitespace().collect();
            for number in &scale.numbers {
                assert!(words.contains(&number.text.as_str()), "{row}");
                assert!(number.text.parse::<f64>().unwrap() % 50.0 == 0.0, "{row}");
            }
            assert!(scale.numbers.len() >= 2, "{width} {height} {row}");
            if place.has_line {
                let line: String = (place.plot.x..place.plot.right())
                    .map(|x| buffer[(x, place.plot.bottom())].symbol())
                    .collect();
                assert_eq!(
                    line.matches('┬').count(),
                    scale.numbers.len(),
                    "{row}\n{line}"
                );
            }
            let last = scale.numbers.last().unwrap();
            between +=
                usize::from(!place.has_label_row && i32::from(scale.label_start) < last.start);
        }
    }
    assert!(between > 0, "a label is before the last number");
}

#[test]
fn names_are_beside_their_points_and_hide_nothing() {
    let points: Vec<(f64, f64)> = (0..40)
        .map(|at| (1.7e-8 * f64::from(at), -2e-5 + 5e-7 * f64::from(at)))
        .collect();
    let chart = chart(vec![curve(&points, None)]);
    let mut found = 0;
    for size in SIZES {
        let (place, before) = drawn(&chart, size);
        let mut after = before.clone();
        let names = [
            (points[9], "preload"),
            (points[30], "pull-off"),
            ((1.0, 0.0), "outside"),
        ];
        for (at, name) in names {
            let name = Name {
                at: vec![at],
                texts: vec![name.to_owned()],
                ink: Ink::Quiet,
            };
            place.draw_name(&mut after, &chart, Palette::PLAIN, &name);
        }
        let rows = after.content.chunks(usize::from(after.area.width));
        let text: String = rows
            .flat_map(|row| row.iter().map(|cell| cell.symbol()).chain(["\n"]))
            .collect();
        let written: Vec<&str> = names
            .iter()
            .map(|(_, name)| *name)
            .filter(|name| text.contains(name))
            .collect();
        assert!(!written.contains(&"outside"));
        found += written.len();
        for (cell, old) in after.content.iter().zip(&before.content) {
            let is_blank = [" ", "\u{2800}"].contains(&old.symbol());
            assert!(cell.symbol() == old.symbol() || is_blank, "{size:?}");
        }
        for (point, name) in names.iter().filter(|(_, name)| written.contains(name)) {
            let (column, row) = place.cell(&chart, *point).unwrap();
            let near = (row.saturating_sub(1).max(after.area.y)
                ..=(row + 1).min(after.area.bottom() - 1))
                .any(|y| {
                    let from = column
                        .saturating_sub(name.len() as u16 + 1)
                        .max(after.area.x);
                    let to = (column + name.len() as u16 + 2).min(after.area.right());
                    let text: String = (from..to).map(|x| after[(x, y)].symbol()).collect();
                    text.contains(name)
                });
            assert!(near, "{size:?} {name}");
        }
    }
    assert!(found > 10, "{found}");
}

/// Each of thousands of points is painted as a dot. A line that is drawn after the points
/// replaces the dots in its cells.
#[test]
fn points_are_dots_below_a_line() {
    let cloud = (0..2000).map(|at| {
        (
            3e-10 * f64::from(at),
            -1.5e-5 + 2.4e-8 * f64::from(at * 7 % 1000),
        )
    });
    let cloud = Layer::unnamed(Ink::Kept, Shape::signs(cloud.collect(), Sign::Point));
    let line = curve(&[(0.0, 0.0), (6e-7, -1e-5)], None);
    let symbols = |layers: Vec<Layer>| {
        let (_, buffer) = drawn(&chart(layers), (60, 20));
        buffer
            .content
            .iter()
            .map(|cell| cell.symbol().to_owned())
            .collect::<Vec<_>>()
    };
    let (both, alone) = (
        symbols(vec![cloud.clone(), line.clone()]),
        symbols(vec![line]),
    );
    let is_dots = |symbol: &String| {
        symbol
            .chars()
            .all(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
    };
    assert!(
        alone
            .iter()
            .zip(&both)
            .all(|(line, both)| !is_dots(line) || line == both)
    );
    let dots = symbols(vec![cloud])
        .iter()
        .filter(|symbol| is_dots(symbol))
        .count();
    assert!(
        dots > 150 && alone.iter().filter(|symbol| is_dots(symbol)).count() > 20,
        "{dots} cells"
    );
    assert!(!both.iter().any(|symbol| symbol == glyph(Sign::Dot)));
}

/// Springs of a profile that are pressed in the left half and pulled in the right half.
fn stressed() -> Chart {
    let fill = StressFill {
        level: 0.0,
        full: 1e-5,
    };
    let half = |heights: [Option<(f64, f64)>; 2]| {
        Shape::Envelope {
            x: (-1.3e-7, 6.4e-7),
            columns: heights.to_vec(),
            fill: None,
        }
        .filled(fill)
    };
    let pressed = half([Some((1e-5, 1e-5)), None]);
    let pulled = half([None, Some((-1e-5, -1e-5))]);
    chart(vec![
        Layer::unnamed(Ink::Press, pressed),
        Layer::unnamed(Ink::Pull, pulled),
    ])
}

#[test]
fn the_sign_of_a_stress_is_seen_with_and_without_colours() {
    let (place, plain) = drawn(&stressed(), (60, 20));
    let plot = place.plot;
    // Dots and foreground colours of the two halves of the plot.
    let dots = |buffer: &Buffer, columns: std::ops::Range<u16>| {
        let mut dots = 0;
        for x in columns {
            for y in plot.y..plot.bottom() {
                let symbol = buffer[(x, y)].symbol().chars().next().unwrap();
                dots += (u32::from(symbol).wrapping_sub(0x2800) & 0xff).count_ones()
                    * u32::from(('\u{2800}'..='\u{28ff}').contains(&symbol));
            }
        }
        dots
    };
    let middle = plot.x + plot.width / 2;
    let pressed = dots(&plain, plot.x..middle - 1);
    let pulled = dots(&plain, middle + 1..plot.right());
    assert!(
        pulled > 100 && pressed > 3 * pulled / 2,
        "{pressed} {pulled}"
    );

    let mut coloured = Buffer::empty(plain.area);
    place.draw(&mut coloured, &stressed(), Palette::DARK);
    let row = place.cell(&stressed(), (0.0, 9e-6)).unwrap().1;
    assert_eq!(coloured[(middle - 3, row)].fg, Palette::DARK.stress(1.0));
    // Every line above the profile has the colour of pulled springs.
    let row = place.cell(&stressed(), (0.0, -9e-6)).unwrap().1;
    let right = (middle + 1..plot.right()).map(|x| &coloured[(x, row)]);
    let lines: Vec<_> = right.filter(|cell| !is_blank(cell)).collect();
    assert!(lines.len() >= 5, "{}", lines.len());
    for line in lines {
        assert_eq!(line.fg, Palette::DARK.stress(-1.0));
    }
}

#[test]
fn a_chart_is_drawn_like_this() {
    let area = [(0.0, -1.5e-5), (5e-7, -1.5e-5), (5e-7, 0.0)];
    let columns =
        (0..40).map(|at| (at % 9 > 1).then(|| (2e-7 * f64::from(at), 2.4e-7 * f64::from(at))));
    let chart = chart(vec![
        Layer::unnamed(Ink::Quiet, Shape::Inside(area.to_vec())),
        Layer::unnamed(Ink::Quiet, Shape::Upright(1e-7)),
        Layer::unnamed(
            Ink::Contact,
            Shape::Boxes(vec![((5.2e-7, 6e-7), (-1.8e-5, -1e-5))]),
        ),
        Layer::unnamed(
            Ink::Profile,
            Shape::Envelope {
                x: (-1e-7, 6e-7),
                columns: columns.collect(),
                fill: None,
            },
        ),
        curve(
            &[(-1e-7, 0.0), (2e-7, f64::NAN), (3e-7, -5e-6), (6e-7, -2e-5)],
            Some(Sign::Ring),
        ),
    ]);
    let (_, buffer) = drawn(&chart, (64, 18));
    let rows = buffer
        .content
        .chunks(64)
        .map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>());
    insta::assert_snapshot!(
        rows.map(|row| row.trim_end().to_owned())
            .collect::<Vec<_>>()
            .join("\n")
    );
}
