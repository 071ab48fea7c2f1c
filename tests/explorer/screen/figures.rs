//! The force pane and the figure of the same scene: the same marks at the same values.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{rough, smooth, without_adhesion};
use super::{default_scene, mid_retraction};
use asperity::explorer::layout::{Layout, inside};
use asperity::explorer::model::Pane;
use asperity::explorer::panes::indentation_at;
use asperity::export::force_figure;
use asperity::scene::parse_quantity;

/// Glyphs of the screen with the names of their marks.
const MARKS: [(char, &str); 4] = [('◇', "jump-in"), ('▲', "preload"), ('▼', "pull-off"), ('○', "jump-out")];

/// Half the size of a sign in the figure, px.
const SIGN: f64 = 2.7;

/// An element of a figure: the attributes of its tag, and its text without markup.
struct Element {
    tag: String,
    text: String,
}

impl Element {
    fn attribute(&self, name: &str) -> &str {
        let value = self.tag.split(&format!("{name}=\"")[..]).nth(1);
        value.and_then(|rest| rest.split('"').next()).unwrap_or_default()
    }

    fn number(&self, name: &str) -> f64 {
        self.attribute(name).parse().unwrap_or(f64::NAN)
    }

    fn points(&self) -> Vec<(f64, f64)> {
        let place =
            |point: &str| point.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()));
        self.attribute("points").split(' ').filter_map(place).collect()
    }
}

/// Elements of a kind, in their order.
fn elements(svg: &str, kind: &str) -> Vec<Element> {
    let element = |rest: &str| {
        let (tag, behind) = rest.split_once('>').unwrap();
        let inside = behind.split(&format!("</{kind}>")[..]).next().unwrap();
        let text =
            inside.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect();
        Element { tag: format!(" {tag}"), text }
    };
    svg.split(&format!("<{kind} ")[..]).skip(1).map(element).collect()
}

fn number(text: &str) -> Option<f64> {
    text.trim().replace('−', "-").parse().ok()
}

/// Value on a line through two labelled places.
fn between(ticks: &[(f64, f64)], at: f64) -> f64 {
    let ((a, low), (b, high)) = (ticks[0], ticks[ticks.len() - 1]);
    low + (high - low) * (at - a) / (b - a)
}

/// Value of the unit in a label such as `force F (µN)`.
fn unit(label: &str, base: &str) -> f64 {
    let name = label.split_once('(').and_then(|(_, rest)| rest.split(')').next()).unwrap();
    parse_quantity(&format!("1 {name}"), base).unwrap()
}

/// Indentation, m, and force, N, of the marks in a figure.
fn marks_of_figure(svg: &str) -> Vec<(char, f64, f64)> {
    let texts = elements(svg, "text");
    let ticks = |anchor: &str, side: &str| -> Vec<(f64, f64)> {
        let labels = texts.iter().filter(|text| text.attribute("text-anchor") == anchor);
        labels.filter_map(|text| Some((text.number(side), number(&text.text)?))).collect()
    };
    let (across, up) = (ticks("middle", " x"), ticks("end", " y"));
    let label = |name: &str| texts.iter().find(|text| text.text.starts_with(name)).unwrap().text.clone();
    let (metre, newton) = (unit(&label("indentation"), "m"), unit(&label("force"), "N"));
    // The base lines of numbers lie below the tick.
    let size: f64 =
        texts.iter().find(|text| text.attribute("text-anchor") == "end").unwrap().number("font-size");
    let value =
        |glyph, x: f64, y: f64| (glyph, metre * between(&across, x), newton * between(&up, y + 0.35 * size));
    let mut marks: Vec<(char, f64, f64)> = Vec::new();
    let mut add = |mark: (char, f64, f64)| {
        // The legend repeats them below.
        if marks.iter().all(|(glyph, ..)| *glyph != mark.0) {
            marks.push(mark);
        }
    };
    for polygon in elements(svg, "polygon") {
        match polygon.points()[..] {
            [(x, y), (_, base), _] if base > y => add(value('▲', x, y + 1.2 * SIGN)),
            [(x, y), (..), _] => add(value('▼', x, y - 1.2 * SIGN)),
            [(x, y), ..] => add(value('◇', x, y + 1.3 * SIGN)),
            [] => {}
        }
    }
    for circle in elements(svg, "circle") {
        add(value('○', circle.number("cx"), circle.number("cy")));
    }
    marks
}

#[test]
fn the_pane_and_the_figure_have_the_same_marks_at_the_same_values() {
    within(60, || {
        let mut compared = 0;
        for document in [default_scene(), rough(), smooth(), without_adhesion()] {
            let mut driver: Driver = mid_retraction(document);
            driver.press("z");
            let outcome = driver.model.computed.as_ref().unwrap().outcome.clone();
            let svg = force_figure(&[("", &outcome)]).svg();
            let figure = marks_of_figure(&svg);
            let legend: Vec<String> = elements(&svg, "text").into_iter().map(|text| text.text).collect();
            for size in [(120, 40), (80, 24)] {
                driver.resize(size);
                let rows: Vec<Vec<char>> = driver.rows().iter().map(|row| row.chars().collect()).collect();
                let area = inside(Layout::of(&driver.model).pane(Pane::Force).unwrap());
                let text = |row: u16| -> String { rows[usize::from(row)].iter().collect() };
                let first = (area.y..area.bottom()).find(|row| text(*row).contains(" ┤")).unwrap();
                let newton = unit(&text(area.y), "N");
                let scale: Vec<(f64, f64)> = (first..area.bottom())
                    .filter_map(|row| {
                        let (label, _) =
                            text(row).split_once(" ┤").map(|(a, b)| (a.to_owned(), b.to_owned()))?;
                        Some((f64::from(row), number(label.trim_start_matches('│'))?))
                    })
                    .collect();
                let row_height = newton * (between(&scale, 0.0) - between(&scale, 1.0)).abs();
                let at = |column: u16| indentation_at(&driver.model, area, column).unwrap();
                let column_width = at(area.right() - 10) - at(area.right() - 11);
                for (glyph, name) in MARKS {
                    let drawn = figure.iter().find(|(other, ..)| *other == glyph);
                    let words = rows[..usize::from(first)].iter().map(|row| row.iter().collect::<String>());
                    let head = format!("{glyph} {name} ");
                    let printed = words
                        .into_iter()
                        .find_map(|row| row.split_once(&head).map(|(_, rest)| rest.to_owned()));
                    assert_eq!(drawn.is_some(), printed.is_some(), "{glyph} {size:?}\n{}", driver.text());
                    let (Some(&(_, d, force)), Some(printed)) = (drawn, printed) else { continue };
                    // In words: three digits here, as many there; F_a has the other sign.
                    let value = |text: &str| parse_quantity(&text.replace('−', "-"), "N").unwrap();
                    let here = value(printed.split("  ").next().unwrap().replace('│', " ").trim());
                    let there = legend.iter().find(|text| text.starts_with(name)).unwrap();
                    let there = value(there.split_once(" = ").unwrap().1);
                    assert!((here.abs() / there.abs() - 1.0).abs() < 6e-3, "{glyph}: {here} {there}");
                    assert!((here - force).abs() < row_height, "{glyph}: {here} {force}");
                    // In place: within a cell.
                    let cells = (first..area.bottom())
                        .flat_map(|row| (area.x..area.right()).map(move |column| (column, row)));
                    let mut found = cells.filter(|(column, row)| {
                        rows[usize::from(*row)].get(usize::from(*column)) == Some(&glyph)
                    });
                    // The present state may hide a mark.
                    let Some((column, row)) = found.next() else { continue };
                    assert!(
                        (at(column) - d).abs() < 1.6 * column_width,
                        "{glyph} {size:?}: {} {d}",
                        at(column)
                    );
                    let force_here = newton * between(&scale, f64::from(row));
                    assert!((force_here - force).abs() < 1.6 * row_height, "{glyph}: {force_here} {force}");
                    compared += 1;
                }
            }
        }
        assert!(compared >= 16, "{compared}");
    });
}
