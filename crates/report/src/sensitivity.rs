//! The sensitivity of a scene as text, JSON and a table, and the chart of the explorer.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::{counted_section, counted_texts};
use asperity_data::{
    AxisScale, Kind, Table, format_quantity, format_rounded, grouped, object, one_unit,
};
use asperity_plot::{Chart, ChartAxis, Ink, Label, Layer, Shape, Sign, Span};
use asperity_scene::{Adhesion, Scene};
use asperity_study::{Changed, Ensemble, Influence, Sensitivity};

/// Smallest relative change that is written as a factor.
const LARGE: f64 = 2.0;
/// Smallest end of the axis of a chart in per cent.
const LEAST: f64 = 1.0;
/// Half the height of a bar, divided by the distance of bars.
const HALF: f64 = 0.35;

/// Report on how much the results of a scene change if one of its numbers is changed by +10 % or
/// −10 %, for each number in turn. A whole number changes by at least 1, and a wavelength by at
/// least one wave on the length.
#[derive(Clone, Copy, Debug)]
pub struct SensitivityReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene whose numbers are changed.
    pub scene: &'a Scene,
    /// Changes of the results, such as the adhesion force, for each changed number.
    pub sensitivity: &'a Sensitivity,
}

/// Writes a relative change: `+12 %`, `×4.2`.
fn change_text(change: f64) -> String {
    let percent = 100.0 * change;
    let digits = if percent.abs() < 9.95 { 1 } else { 0 };
    match change {
        _ if percent.abs() < 0.05 => "0 %".to_owned(),
        LARGE.. => format!("×{}", format_rounded(1.0 + change, 3, "1")),
        _ => format!("{percent:+.digits$} %"),
    }
}

/// Writes the relative change of a number to two digits: `+10 %`, `-11 %`.
fn step_text(step: f64) -> String {
    let sign = if step < 0.0 { "-" } else { "+" };
    format!("{sign}{} %", format_rounded(100.0 * step.abs(), 2, "1"))
}

/// Text in place of the range of changes, if the scene does not allow the number.
const NOT_ALLOWED: &str = "not allowed";
const PROFILES: &str = "profiles";

/// Changes of the results for one changed number, or for one end of the range over the profiles.
struct Side<'a> {
    /// Influence of the changed number; `None` for the profiles.
    influence: Option<&'a Influence>,
    /// 0 for the smaller number or the smallest result, otherwise 1.
    side: usize,
    /// Relative changes of the medians; `None` for a number that is not allowed.
    changes: Option<[Option<f64>; 3]>,
    /// Smallest and largest relative change of F_a on single profiles.
    range: Option<(f64, f64)>,
}

impl Side<'_> {
    fn name(&self) -> Label {
        let Some(Influence { axis, .. }) = self.influence else {
            return PROFILES.into();
        };
        let short = axis
            .name
            .replace("force of ", "")
            .replace("indentation of ", "");
        Label::symbol_or_name(axis.symbol, &short)
    }

    /// Returns the change of the number in words: in per cent, or as a difference for a whole
    /// number.
    fn step(&self) -> String {
        match self.influence {
            None => ["least", "most"][self.side].to_owned(),
            Some(one) if one.axis.is_whole() => format!("{:+}", one.sides[self.side].0 - one.value),
            Some(one) => step_text(one.step(self.side)),
        }
    }

    fn text(&self, result: usize) -> String {
        let change = self.changes.and_then(|changes| changes[result]);
        change.map_or_else(|| "-".to_owned(), change_text)
    }
}

/// Returns both changes of at most `most` numbers, with the largest influence on a result first.
/// The range over the profiles follows.
fn sides(sensitivity: &Sensitivity, result: usize, most: usize) -> Vec<Side<'_>> {
    let numbers = sensitivity
        .ordered(result)
        .into_iter()
        .take(most)
        .flat_map(|influence| {
            [0, 1].map(|side| {
                let changed = &influence.sides[side].1;
                let changes = changed
                    .as_ref()
                    .map(|changed| sensitivity.changes(&changed.medians));
                let range = changed.as_ref().and_then(|changed| changed.range[0]);
                Side {
                    influence: Some(influence),
                    side,
                    changes,
                    range,
                }
            })
        });
    let profiles = sensitivity.range.iter().flat_map(|ends| {
        let changes = |side: usize| Some(sensitivity.changes(&ends[side]));
        [0, 1].map(|side| Side {
            influence: None,
            side,
            changes: changes(side),
            range: None,
        })
    });
    numbers.chain(profiles).collect()
}

/// Returns a table of the changes of the median results: a row of headings, a row of medians of the
/// unchanged scene, then two rows for each of at most `most` numbers. The columns are name, value
/// and change of the number, change of F_a with its range over the profiles, change of F_a(d=0),
/// and change of the dissipated energy.
pub fn sensitivity_table(sensitivity: &Sensitivity, most: usize) -> Vec<[String; 7]> {
    let row = |texts: [&str; 3], range: &str, result: &dyn Fn(usize) -> String| {
        let [name, value, change] = texts.map(str::to_owned);
        [
            name,
            value,
            change,
            result(0),
            range.to_owned(),
            result(1),
            result(2),
        ]
    };
    let results = Sensitivity::RESULTS;
    let several = if sensitivity.range.is_some() {
        "single profiles"
    } else {
        ""
    };
    let head = row(["number", "value", "change"], several, &|result| {
        results[result].symbol().to_owned()
    });
    let scene = row(
        [
            if several.is_empty() {
                "this scene"
            } else {
                "median"
            },
            "",
            "",
        ],
        "",
        &|result| {
            let value = sensitivity.present[result];
            value.map_or_else(
                || "-".to_owned(),
                |value| format_quantity(value, results[result].unit()),
            )
        },
    );
    let changes = sides(sensitivity, 0, most).into_iter().map(|side| {
        let value = side
            .influence
            .map(|one| format_quantity(one.value, one.axis.unit))
            .unwrap_or_default();
        let (name, step) = (side.name().to_string(), side.step());
        let named = if side.side == 0 {
            [name.as_str(), &value]
        } else {
            [""; 2]
        };
        let range = side
            .range
            .map(|(least, most)| one_unit([least, most].map(change_text)));
        let not_allowed = side.changes.is_none().then(|| NOT_ALLOWED.to_owned());
        row(
            [named[0], named[1], &step],
            &range.or(not_allowed).unwrap_or_default(),
            &|of| side.text(of),
        )
    });
    [head, scene].into_iter().chain(changes).collect()
}

/// Returns a bar chart of the changes of one result in per cent, with two bars for each of at most
/// `most` numbers. `result` is an index of [`Sensitivity::RESULTS`].
pub fn sensitivity_chart(sensitivity: &Sensitivity, result: usize, most: usize) -> Chart {
    let shown = sides(sensitivity, result, most);
    let percent = |side: &Side<'_>| Some(100.0 * side.changes?[result]?);
    let numbers = shown.iter().filter(|side| side.influence.is_some());
    let end = 1.05
        * numbers
            .filter_map(percent)
            .map(f64::abs)
            .fold(LEAST, f64::max);
    // Nothing falls by more than all of itself.
    let span = Span {
        low: -end.min(105.0),
        high: end,
    };
    let (mut bars, mut names, mut beyond) = (
        [const { Vec::new() }; 3],
        Vec::new(),
        [const { Vec::new() }; 2],
    );
    // The lowest bar is at 0.
    for (row, side) in (0..).map(f64::from).zip(shown.iter().rev()) {
        names.push(
            side.name()
                .then(&format!(", {}: {}", side.step(), side.text(result))),
        );
        let Some(change) = percent(side) else {
            continue;
        };
        let bar = ((change.min(0.0), change.max(0.0)), (row - HALF, row + HALF));
        bars[side.influence.map_or(2, |_| side.side)].push(bar);
        if change < span.low || change > span.high {
            beyond[usize::from(change > 0.0)].push((change.clamp(span.low, span.high), row));
        }
    }
    let bars = [Ink::Surface, Ink::Contact, Ink::Kept]
        .into_iter()
        .zip(bars.map(Shape::Boxes));
    let ends = beyond.into_iter().zip([Sign::Left, Sign::Right]);
    let ends = ends.map(|(points, sign)| (Ink::Text, Shape::signs(points, sign)));
    let layers = std::iter::once((Ink::Quiet, Shape::Upright(0.0)))
        .chain(bars)
        .chain(ends);
    let layers = layers
        .map(|(ink, shape)| Layer::unnamed(ink, shape))
        .collect();
    let x = ChartAxis::new(
        AxisScale::Linear,
        span,
        "change of",
        Sensitivity::RESULTS[result].symbol(),
        "%",
    );
    Chart::new(x, ChartAxis::of_names(names), layers)
}

impl SensitivityReport<'_> {
    /// Returns sentences on what stays constant while a number changes, and on the profiles.
    fn note(&self) -> String {
        if let Some(missing) = self.sensitivity.missing() {
            return missing.to_owned();
        }
        let profiles = match self.sensitivity.range {
            Some(_) => format!(
                "All are medians over the same {} random profiles; beside them the range of F_a of single profiles.",
                self.sensitivity.profiles
            ),
            None => Ensemble::FIXED.to_owned(),
        };
        let has_wavelengths = self
            .sensitivity
            .influences
            .iter()
            .any(|one| one.axis.path.starts_with("roughness.wavelengths"));
        let waves = if has_wavelengths {
            " A wavelength changes so that whole waves fit on the length. Where the length changes, the numbers of waves on it \
             stay."
        } else {
            ""
        };
        format!("{}{waves} {profiles}", others_stay(self.scene.adhesion))
    }
}

/// Returns a sentence on the numbers of a scene with this adhesion that stay constant while one of
/// them changes.
pub(crate) fn others_stay(adhesion: Option<Adhesion>) -> String {
    let by_parameter = adhesion.is_some_and(|adhesion| adhesion.parameter().is_some());
    let follows = if by_parameter {
        ", and the work of adhesion follows from them"
    } else {
        ""
    };
    format!("All other numbers of the scene stay{follows}.")
}

impl Report for SensitivityReport<'_> {
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        if self.sensitivity.missing().is_none() {
            let springs = grouped(self.scene.numerics.points);
            let of = if self.sensitivity.range.is_some() {
                "medians"
            } else {
                "results"
            };
            sheet.heading(&format!(
                "Changes of the {of} where one number changes, {springs} springs"
            ));
            sheet.table(&sensitivity_table(self.sensitivity, usize::MAX));
        }
        sheet.heading(&self.note());
        counted_section(
            &mut sheet,
            &self.sensitivity.warnings,
            self.sensitivity.profiles,
        );
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let values = |values: [Option<f64>; 3]| {
            object! { "adhesion_force": values[0], "first_touch_adhesion_force": values[1], "dissipated_energy": values[2] }
        };
        let ends = |range: [Option<(f64, f64)>; 3]| {
            object! { "adhesion_force": range[0], "first_touch_adhesion_force": range[1], "dissipated_energy": range[2] }
        };
        let side = move |influence: &Influence, side: usize| {
            let (value, changed) = influence.sides[side];
            let change = influence.step(side);
            changed.map(|changed| {
                object! {
                    "value": value, "change": change, "results": values(changed.medians),
                    "profile_changes": ends(changed.range),
                }
            })
        };
        let influence = |influence: &Influence| {
            let [smaller, larger] = [side(influence, 0), side(influence, 1)];
            object! {
                "path": influence.axis.path.clone(), "name": influence.axis.name.clone(), "value": influence.value,
                "smaller": smaller, "larger": larger,
            }
        };
        let range = self.sensitivity.range;
        Some(Box::new(object! {
            "scene": self.scene,
            "warnings": counted_texts(&self.sensitivity.warnings, self.sensitivity.profiles),
            "step": Sensitivity::STEP,
            "profiles": self.sensitivity.profiles,
            "results": values(self.sensitivity.present),
            "range": range.map(|[least, most]| object! { "least": values(least), "most": values(most) }),
            "numbers": self.sensitivity.influences.iter().map(influence).collect::<Vec<_>>(),
        }))
    }

    /// Returns a table of the medians of the results: a row for the unchanged scene, then a row for
    /// each number and each change by +10 % or −10 %.
    fn table(&self) -> Option<Table<'_>> {
        let rows = || {
            let all = self.sensitivity.influences.iter();
            let sides = all.flat_map(|one| {
                let row = |side: &(f64, Option<Changed>)| {
                    Some((one.axis.path.as_str(), Some(side.0), side.1?))
                };
                one.sides.iter().filter_map(row).collect::<Vec<_>>()
            });
            let present = Changed {
                medians: self.sensitivity.present,
                ..Changed::default()
            };
            std::iter::once(("", None, present)).chain(sides)
        };
        let longest = self
            .sensitivity
            .influences
            .iter()
            .map(|one| one.axis.path.len())
            .max()
            .unwrap_or(0);
        let mut table = Table::of(rows).with("path", Kind::Text(longest), |row| row.0);
        table = table.real("value", |row| row.1);
        for (index, quantity) in Sensitivity::RESULTS.iter().enumerate() {
            let name = quantity.name();
            table = table.real(name, move |row| row.2.medians[index]);
            let change = |end| format!("{name}_{end}_change");
            table = table.with(change("least"), Kind::Real, move |row| {
                row.2.range[index].map(|ends| ends.0)
            });
            table = table.with(change("most"), Kind::Real, move |row| {
                row.2.range[index].map(|ends| ends.1)
            });
        }
        Some(table.done())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_short() {
        for (change, text) in [
            (-0.081, "-8.1 %"),
            (0.123, "+12 %"),
            (1e-5, "0 %"),
            (3.2, "×4.2"),
            (-0.5, "-50 %"),
        ] {
            assert_eq!(change_text(change), text);
        }
    }

    /// Each change has a row and a bar: a whole number changes by a whole step, what is not allowed
    /// is stated, and a bar beyond the frame has an arrow.
    #[test]
    fn each_change_has_a_row_and_a_bar_of_its_own() {
        let scene = asperity_scene::open("jkr-sphere").unwrap().scene().clone();
        let influence = |path: &str, value: f64, sides| {
            let axis =
                asperity_study::Axis::new(path, asperity_study::Spacing::List, Vec::new(), &scene)
                    .unwrap();
            Influence { axis, value, sides }
        };
        let force = |force: f64| {
            let range = [Some((-0.1, 3.0)), None, None];
            Some(Changed {
                medians: [Some(force), None, Some(1.0)],
                range,
            })
        };
        let sensitivity = Sensitivity {
            present: [Some(2e-6), None, Some(1.0)],
            influences: vec![
                influence(
                    "material.poisson_ratio",
                    0.5,
                    [(0.45, force(1.8e-6)), (0.55, None)],
                ),
                influence(
                    "roughness.modes.0",
                    4.0,
                    [(3.0, force(3e-6)), (5.0, force(2.5e-6))],
                ),
            ],
            profiles: 16,
            range: Some([[Some(1e-6), None, Some(1.0)], [Some(8e-6), None, Some(1.0)]]),
            warnings: Vec::new(),
        };
        let rows = sensitivity_table(&sensitivity, 9)
            .into_iter()
            .map(|row| row.join("|"));
        let expected = [
            "number|value|change|F_a|single profiles|F_a(d=0)|ΔW",
            "median|||2 µN||-|1 J",
            "k_min|4|-1|+50 %|-10 % to ×4|-|0 %",
            "||+1|+25 %|-10 % to ×4|-|0 %",
            "ν|0.5|-10 %|-10 %|-10 % to ×4|-|0 %",
            "||+10 %|-|not allowed|-|-",
            "profiles||least|-50 %||-|0 %",
            "||most|×4||-|0 %",
        ];
        assert_eq!(rows.collect::<Vec<_>>(), expected);
        let chart = sensitivity_chart(&sensitivity, 0, 1);
        let names: Vec<String> = chart.y.names.iter().map(Label::to_string).collect();
        assert_eq!(
            names,
            [
                "profiles, most: ×4",
                "profiles, least: -50 %",
                "k_min, +1: +25 %",
                "k_min, -1: +50 %"
            ]
        );
        let arrows = |sign| {
            let is_arrow = |layer: &&Layer| matches!(&layer.shape, Shape::Curve { sign: Some(one), .. } if *one == sign);
            chart
                .layers
                .iter()
                .find(is_arrow)
                .map(|layer| layer.shape.points().len())
        };
        assert_eq!(
            (arrows(Sign::Right), arrows(Sign::Left)),
            (Some(1), Some(0))
        );
        let none = Sensitivity {
            present: [Some(0.0), None, None],
            ..sensitivity
        };
        let report = SensitivityReport {
            title: "None",
            scene: &scene,
            sensitivity: &none,
        };
        assert!(report.text().unwrap().contains("no pull-off"));
    }
}
