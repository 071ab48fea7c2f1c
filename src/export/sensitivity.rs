//! Sensitivity of a scene as text, JSON, a table and a figure.

use super::report::{Json, Report};
use super::sheet::Sheet;
use crate::draw::{Axis, AxisScale, Chart, Figure, Ink, Label, Layer, Shape, Span};
use crate::io::{Table, object};
use crate::scene::{Adhesion, Scene, format_quantity, format_rounded};
use crate::study::{Influence, OTHER_SEEDS, STEP, Sensitivity};
use crate::text::grouped;

/// Changes from here on are stated as a factor.
const LARGE: f64 = 2.0;
/// Smallest end of the axis of a chart, percent.
const LEAST: f64 = 1.0;
/// Half the height of a bar, in distances of bars.
const HALF: f64 = 0.35;

/// Sensitivity of a scene.
#[derive(Clone, Copy, Debug)]
pub struct SensitivityReport<'a> {
    pub title: &'a str,
    pub scene: &'a Scene,
    pub sensitivity: &'a Sensitivity,
}

/// A relative change in words: `+12 %`, `×4.2`.
fn change_text(change: f64) -> String {
    let percent = 100.0 * change;
    let digits = if percent.abs() < 9.95 { 1 } else { 0 };
    match change {
        _ if percent.abs() < 0.05 => "0 %".to_owned(),
        LARGE.. => format!("×{}", format_rounded(1.0 + change, 3, "1")),
        _ => format!("{percent:+.digits$} %"),
    }
}

/// Changes towards both sides in words: `-8.1 to +12 %`.
fn changes_text(sides: [Option<f64>; 2]) -> String {
    let [low, high] = sides.map(|side| side.map_or_else(|| "-".to_owned(), change_text));
    let short = if high.ends_with(" %") { low.trim_end_matches(" %") } else { &low };
    if low == high { low } else { format!("{short} to {high}") }
}

/// Name of the row of random phases.
const OTHERS: &str = "other seeds";

/// The results of the scene and their changes in words, the largest influence on the adhesion force first: a heading,
/// then names, values in the scene, and one column for each result.
pub fn sensitivity_table(sensitivity: &Sensitivity) -> Vec<[String; 5]> {
    let results = Sensitivity::RESULTS;
    let [adhesion, zero_load, loss] = results.map(|result| result.symbol().to_owned());
    let present = |result: usize| {
        let value = sensitivity.present[result];
        value.map_or_else(|| "-".to_owned(), |value| format_quantity(value, results[result].unit()))
    };
    let row = |name: String, value, text: &dyn Fn(usize) -> String| [name, value, text(0), text(1), text(2)];
    let head = ["number".to_owned(), "value".to_owned(), adhesion, zero_load, loss];
    let scene = row("this scene".to_owned(), String::new(), &present);
    let influences = sensitivity.ordered(0).into_iter().map(|influence| {
        let value = format_quantity(influence.value, influence.axis.unit);
        // Whole numbers change by whole steps.
        let step = influence.sides.iter().flatten().map(|side| (side.0 - influence.value).abs()).next();
        let is_usual = |step: &f64| (step / influence.value.abs() - STEP).abs() < 1e-9;
        let step = step.filter(|step| !is_usual(step)).map_or_else(String::new, |step| format!(" ± {step}"));
        let value = value + &step;
        row(influence.axis.symbol_or_name().to_owned(), value, &|result| {
            changes_text(sensitivity.changes(influence, result))
        })
    });
    let seeds = sensitivity.seeds.map(|_| {
        row(OTHERS.to_owned(), String::new(), &|result| changes_text(sensitivity.changes_of_seeds(result)))
    });
    [head, scene].into_iter().chain(influences).chain(seeds).collect()
}

/// Bars of the changes of a result in percent, at most `most` of them, the largest at the top.
pub fn sensitivity_chart(sensitivity: &Sensitivity, result: usize, most: usize) -> Chart {
    let seeds = sensitivity.seeds.map(|_| sensitivity.changes_of_seeds(result));
    let numbers = most.saturating_sub(seeds.iter().len()).max(1);
    let shown = sensitivity.ordered(result).into_iter().take(numbers);
    let shown: Vec<_> = shown.map(|influence| (influence, sensitivity.changes(influence, result))).collect();
    let sizes = shown.iter().flat_map(|(_, sides)| sides).flatten().map(|change| 100.0 * change.abs());
    let end = 1.05 * sizes.fold(LEAST, f64::max);
    // The lowest bar is at 0.
    let count = shown.len() + seeds.iter().len();
    let bar = |row: usize, change: f64| {
        let (row, change) = ((count - 1 - row) as f64, 100.0 * change);
        ((change.min(0.0), change.max(0.0)), (row - HALF, row + HALF))
    };
    let side = |side: usize, sign: &str, ink| {
        let bars = shown.iter().enumerate().filter_map(|(row, (_, sides))| Some(bar(row, sides[side]?)));
        let name = Label::plain(&format!("{sign}{} %", 100.0 * STEP));
        Layer::new(name, ink, Shape::Boxes(bars.collect()))
    };
    let mut layers = vec![side(0, "-", Ink::Surface), side(1, "+", Ink::Contact)];
    let name = |influence: &Influence| Label::symbol_or_name(influence.axis.symbol, &influence.axis.name);
    let mut names: Vec<Label> =
        shown.iter().map(|(one, sides)| name(one).then(&format!(" {}", changes_text(*sides)))).collect();
    if let Some(ends) = seeds {
        let bars = ends.into_iter().flatten().map(|change| bar(count - 1, change));
        layers.push(Layer::new(OTHERS.into(), Ink::Kept, Shape::Boxes(bars.collect())));
        names.push(Label::plain(&format!("{OTHERS} {}", changes_text(ends))));
    }
    names.reverse();
    layers.push(Layer::unnamed(Ink::Quiet, Shape::Upright(0.0)));
    let (span, symbol) = (Span { low: -end, high: end }, Sensitivity::RESULTS[result].symbol());
    let x = Axis::new(AxisScale::Linear, span, "change of", symbol, "%");
    Chart::new(x, Axis::of_names(names), layers)
}

impl SensitivityReport<'_> {
    /// Sentence on the quantities that stay while a number changes, and on the number of seeds.
    fn note(&self) -> String {
        let follows = match self.scene.adhesion {
            Some(Adhesion { work: None, .. }) => ", and the work of adhesion follows from them",
            _ => "",
        };
        let seeds =
            self.sensitivity.seeds.map(|_| format!(" Other seeds: range over {} profiles.", 1 + OTHER_SEEDS));
        format!("All other numbers of the scene stay{follows}.{}", seeds.unwrap_or_default())
    }
}

impl Report for SensitivityReport<'_> {
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&format!(
            "Changes by {} % less and more of one number at a time, {} springs",
            100.0 * STEP,
            grouped(self.scene.numerics.points)
        ));
        sheet.table(&sensitivity_table(self.sensitivity));
        sheet.heading(&self.note());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let values = |values: [Option<f64>; 3]| {
            object! { "adhesion_force": values[0], "zero_load_adhesion_force": values[1], "dissipated_energy": values[2] }
        };
        let side = move |side: &Option<(f64, [Option<f64>; 3])>| {
            side.map(|(value, results)| object! { "value": value, "results": values(results) })
        };
        let influence = |influence: &Influence| {
            let [smaller, larger] = influence.sides.each_ref().map(side);
            object! {
                "path": influence.axis.path.clone(), "name": influence.axis.name.clone(), "value": influence.value,
                "smaller": smaller, "larger": larger,
            }
        };
        let seeds = self.sensitivity.seeds.map(|[least, most]| {
            object! { "profiles": 1 + OTHER_SEEDS, "least": values(least), "most": values(most) }
        });
        Some(Box::new(object! {
            "scene": self.scene,
            "step": STEP,
            "results": values(self.sensitivity.present),
            "numbers": self.sensitivity.influences.iter().map(influence).collect::<Vec<_>>(),
            "seeds": seeds,
        }))
    }

    /// One row for each side of each number, after a row for the scene.
    fn table(&self) -> Option<Table<'_>> {
        let rows = || {
            let all = self.sensitivity.influences.iter();
            let sides = all.flat_map(|one| {
                one.sides.iter().flatten().map(|side| (one.axis.path.as_str(), Some(side.0), side.1))
            });
            std::iter::once(("", None, self.sensitivity.present)).chain(sides)
        };
        let longest = self.sensitivity.influences.iter().map(|one| one.axis.path.len()).max().unwrap_or(0);
        let mut table = Table::of(rows).with("path", crate::io::Kind::Text(longest), |row| row.0);
        table = table.real("value", |row| row.1);
        for (index, quantity) in Sensitivity::RESULTS.iter().enumerate() {
            table = table.real(quantity.name(), move |row| row.2[index]);
        }
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        let charts = [0, 1, 2].map(|result| sensitivity_chart(self.sensitivity, result, usize::MAX));
        let notes = vec![Label::plain(&self.note())];
        Some(Figure {
            title: self.title.to_owned(),
            notes,
            charts: charts.into(),
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_short() {
        for (sides, text) in [
            ([Some(-0.081), Some(0.123)], "-8.1 to +12 %"),
            ([Some(0.0), Some(1e-5)], "0 %"),
            ([Some(-0.5), Some(3.2)], "-50 % to ×4.2"),
            ([Some(-0.019), None], "-1.9 % to -"),
        ] {
            assert_eq!(changes_text(sides), text);
        }
    }
}
