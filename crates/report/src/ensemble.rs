//! Results on random profiles: the main numbers of a scene as text and JSON, a caption of figures,
//! and a table of the profiles.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::counted_texts;
use asperity_data::{Kind, Table, format_range, format_rounded, grouped, object, one_unit};
use asperity_plot::Label;
use asperity_scene::Regime;
use asperity_study::{Ensemble, Plan, Quantity, RegimeCounts, Results, Statistics};
use serde::Serialize;
use std::collections::BTreeMap;

/// Names of the numbers of [`Ensemble::NUMBERS`] in the text.
pub(crate) const NAMES: [&str; 5] = [
    "adhesion force F_a",
    "share F_a/F_a,max",
    "at first touch F_a(d=0)",
    "at zero force F_a(F=0)",
    "dissipated energy",
];

/// Returns random profiles in words, given their number and the seed of the first one:
/// `16 random profiles, seeds 5 to 20`.
pub(crate) fn profiles_named(count: u64, first: u64) -> String {
    match count {
        1 => format!("One random profile, seed {first}"),
        _ => {
            format!(
                "{} random profiles, seeds {first} to {}",
                grouped(count),
                first.wrapping_add(count - 1)
            )
        }
    }
}

/// Writes a value of a quantity to this number of digits; a share in per cent.
pub(crate) fn rounded(quantity: Quantity, value: f64, digits: usize) -> String {
    match quantity.bounds() {
        (0.0, 1.0) => format!("{} %", format_rounded(100.0 * value, digits, "1")),
        _ => format_rounded(value, digits, quantity.unit()),
    }
}

/// Adds the main numbers of a scene: median, quartiles and range over its random profiles, and the
/// regimes of the profiles.
pub(crate) fn headline(sheet: &mut Sheet, ensemble: &Ensemble) {
    sheet.heading(&profiles_named(
        ensemble.profiles(),
        ensemble.results().plan().seed,
    ));
    let mut rows = vec![["", "median", "quartiles", "range", "profiles"].map(String::from)];
    for (name, quantity) in NAMES.iter().zip(Ensemble::NUMBERS) {
        let Some(all) = ensemble.statistics(quantity) else {
            continue;
        };
        let Statistics {
            quartiles: [lower, median, upper],
            range,
            count,
            ..
        } = all;
        let shown = |value, digits| rounded(quantity, value, digits);
        let ends = |(low, high)| one_unit([low, high].map(|end| shown(end, 2)));
        let median = shown(median, 3);
        rows.push([
            (*name).to_owned(),
            median,
            ends((lower, upper)),
            ends(range),
            grouped(count as u64),
        ]);
    }
    if rows.len() > 1 {
        sheet.table(&rows);
    }
    let headings = ["regimes, first touch", "regimes, zero force"];
    for (heading, counts) in headings.into_iter().zip(ensemble.regimes()) {
        sheet.row(heading, regimes_in_words(counts));
    }
    let failed = ensemble.failed().count();
    if let Some((seed, reason)) = ensemble.failed().next() {
        sheet.paragraph(&format!(
            "{failed} of them cannot follow the loading: seed {seed}: {reason}."
        ));
    }
}

/// Returns the numbers of profiles in each regime: `pressure-sensitive 12, non-adhesive 4`.
fn regimes_in_words(counts: RegimeCounts) -> String {
    counts
        .present()
        .map(|(name, count)| format!("{name} {count}"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Returns median and quartiles of the adhesion force over random profiles, as a caption; `None`
/// without an adhesion force.
pub(crate) fn caption(ensemble: &Ensemble) -> Option<Label> {
    let force = Quantity::AdhesionForce;
    let all = ensemble.statistics(force)?;
    let [lower, median, upper] = all.quartiles;
    let median = format_rounded(median, 3, force.unit());
    let quartiles = format_range((lower, upper), 2, force.unit());
    let (profiles, seed) = (grouped(ensemble.profiles()), ensemble.results().plan().seed);
    let text = format!(
        ": median {median} of {profiles} random profiles, quartiles {quartiles}; curve: seed {seed}"
    );
    Some(Label::symbol(force.symbol()).then(&text))
}

/// Returns an ensemble as a JSON value.
pub(crate) fn ensemble_value(ensemble: &Ensemble) -> impl Serialize + '_ {
    let of = |quantity| {
        ensemble.statistics(quantity).map(|all: Statistics| {
            let [lower, median, upper] = all.quartiles;
            object! {
                "count": all.count,
                "median": median,
                "quartiles": [lower, upper],
                "range": all.range,
                "median_interval": all.median_interval,
                "mean": all.mean,
                "standard_deviation": all.spread.map(|spread| spread.standard_deviation),
                "confidence_interval": all.confidence_interval(),
            }
        })
    };
    let regimes = |counts: RegimeCounts| counts.present().collect::<BTreeMap<_, _>>();
    let [from_touch, after_zero_force] = ensemble.regimes().map(regimes);
    let [force, share, touch, zero_force, energy] = Ensemble::NUMBERS.map(of);
    object! {
        "profiles": ensemble.profiles(),
        "adhesion_force": force,
        "adhesion_share": share,
        "first_touch_adhesion_force": touch,
        "zero_force_adhesion_force": zero_force,
        "dissipated_energy": energy,
        "warnings": counted_texts(&ensemble.warnings(), ensemble.profiles()),
        "regimes": from_touch,
        "regimes_after_zero_force": after_zero_force,
        "lines": ensemble.table(),
    }
}

/// An ensemble, the results of a scene on several random profiles. The table has a row for each
/// profile.
impl Report for Ensemble {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(ensemble_value(self)))
    }

    fn table(&self) -> Option<Table<'_>> {
        let (results, plan) = (self.results(), self.results().plan());
        let mut table = Table::of(|| 0..plan.lines).whole("seed", |line| plan.seed_of(*line));
        for quantity in plan.record.iter() {
            let (name, text) = (quantity.name(), Kind::Text(Regime::LONGEST_NAME));
            let regime = |line| results.regime(0, line, *quantity);
            table = match quantity.is_regime() {
                true => table.with(name, text, move |line| {
                    regime(*line).map_or("", Regime::name)
                }),
                false => table.real(name, |line| results.value(0, *line, *quantity)),
            };
        }
        Some(table.done())
    }
}

/// Results of a parameter study, all held in memory. The table has a row for each combination of
/// values on the axes of the study, on each random profile.
impl Report for Results {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let Plan {
            scene, axes, lines, ..
        } = self.plan();
        let axes: BTreeMap<_, _> = axes.iter().map(|axis| (&axis.path, &axis.values)).collect();
        Some(Box::new(
            object! { "scene": scene, "axes": axes, "profiles": lines, "records": self.table() },
        ))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(Results::table(self))
    }
}
