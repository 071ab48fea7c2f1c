//! Results on random profiles: the main results of a scene as text and JSON, the caption of a
//! figure, and a table of the profiles.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::counted_texts;
use crate::words::percent;
use asperity_data::{Kind, Table, format_range, format_rounded, grouped, one_unit};
use asperity_plot::Label;
use asperity_scene::{Regime, Scene};
use asperity_study::{Ensemble, Quantity, RegimeCounts, Results, Statistics};
use serde::Serialize;
use std::collections::BTreeMap;

/// Names of the quantities [`Ensemble::NUMBERS`] in the text report.
pub(crate) const NAMES: [&str; 5] = [
    "pull-off force F_a",
    "share F_a/F_a,max",
    "at first touch F_a(d=0)",
    "at zero force F_a(F=0)",
    "dissipated energy",
];

/// Returns words for random profiles. `count` is their number, and `first` the seed of the first
/// one: `16 random profiles, seeds 5 to 20`.
pub(crate) fn profiles_named(count: u64, first: u64) -> String {
    if count == 1 {
        return format!("One random profile, seed {first}");
    }
    let last = first.wrapping_add(count - 1);
    let count = grouped(count);
    format!("{count} random profiles, seeds {first} to {last}")
}

/// Returns a value of a quantity as text with this number of digits. The value of a share is
/// written in per cent.
pub(crate) fn rounded(quantity: Quantity, value: f64, digits: usize) -> String {
    if quantity.bounds() == (0.0, 1.0) {
        percent(value, digits)
    } else {
        format_rounded(value, digits, quantity.unit())
    }
}

/// Adds the main results of a scene: median, quartiles and range over its random profiles, and the
/// regimes of the profiles.
pub(crate) fn headline(sheet: &mut Sheet, ensemble: &Ensemble) {
    let seed = ensemble.results().plan().seed;
    sheet.heading(&profiles_named(ensemble.profiles(), seed));
    let mut rows = vec![["", "median", "quartiles", "range", "profiles"].map(String::from)];
    for (name, quantity) in NAMES.iter().zip(Ensemble::NUMBERS) {
        let Some(statistics) = ensemble.statistics(quantity) else {
            continue;
        };
        let [lower, median, upper] = statistics.quartiles;
        let (least, most) = statistics.range;
        rows.push([
            (*name).to_owned(),
            rounded(quantity, median, 3),
            one_unit([lower, upper].map(|quartile| rounded(quantity, quartile, 2))),
            one_unit([least, most].map(|end| rounded(quantity, end, 2))),
            grouped(statistics.count as u64),
        ]);
    }
    if rows.len() > 1 {
        sheet.table(&rows);
    }
    let [from_touch, after_zero_force] = ensemble.regimes();
    sheet.row("regimes, first touch", regimes_in_words(from_touch));
    sheet.row("regimes, zero force", regimes_in_words(after_zero_force));
    if let Some((seed, reason)) = ensemble.failed().next() {
        let failed = ensemble.failed().count();
        sheet.paragraph(&format!(
            "{failed} of them cannot follow the loading: seed {seed}: {reason}."
        ));
    }
}

/// Returns the number of profiles in each regime as text: `pressure-sensitive 12, non-adhesive 4`.
fn regimes_in_words(counts: RegimeCounts) -> String {
    let regimes: Vec<String> = counts
        .present()
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    regimes.join(", ")
}

/// Returns the median and the quartiles of the pull-off force over random profiles, as the caption
/// of a figure; `None` if there is no pull-off force.
pub(crate) fn caption(ensemble: &Ensemble) -> Option<Label> {
    let force = Quantity::PullOffForce;
    let [lower, median, upper] = ensemble.statistics(force)?.quartiles;
    let median = format_rounded(median, 3, force.unit());
    let quartiles = format_range((lower, upper), 2, force.unit());
    let profiles = grouped(ensemble.profiles());
    let seed = ensemble.results().plan().seed;
    let text = format!(
        ": median {median} of {profiles} random profiles, quartiles {quartiles}; curve: seed {seed}"
    );
    Some(Label::symbol(force.symbol()).then(&text))
}

/// JSON object of an ensemble, in SI units.
#[derive(Serialize)]
pub(crate) struct EnsembleJson<'a> {
    profiles: u64,
    pull_off_force: Option<Statistics>,
    adhesion_share: Option<Statistics>,
    first_touch_pull_off_force: Option<Statistics>,
    zero_force_pull_off_force: Option<Statistics>,
    dissipated_energy: Option<Statistics>,
    warnings: Vec<String>,
    /// Number of profiles in each regime that occurs.
    regimes: BTreeMap<&'static str, usize>,
    regimes_after_zero_force: BTreeMap<&'static str, usize>,
    per_profile: Option<Table<'a>>,
}

impl<'a> EnsembleJson<'a> {
    pub(crate) fn new(ensemble: &'a Ensemble) -> Self {
        let numbers = Ensemble::NUMBERS.map(|quantity| ensemble.statistics(quantity));
        let [force, share, first_touch_force, zero_force_force, energy] = numbers;
        let [from_touch, after_zero_force] = ensemble.regimes();
        EnsembleJson {
            profiles: ensemble.profiles(),
            pull_off_force: force,
            adhesion_share: share,
            first_touch_pull_off_force: first_touch_force,
            zero_force_pull_off_force: zero_force_force,
            dissipated_energy: energy,
            warnings: counted_texts(&ensemble.warnings(), ensemble.profiles()),
            regimes: from_touch.present().collect(),
            regimes_after_zero_force: after_zero_force.present().collect(),
            per_profile: ensemble.table(),
        }
    }
}

/// Report on an ensemble, which is the results of a scene on several random profiles. The table has
/// a row for each profile.
impl Report for Ensemble {
    fn warnings(&self) -> Vec<String> {
        counted_texts(&Ensemble::warnings(self), self.profiles())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(EnsembleJson::new(self)))
    }

    fn table(&self) -> Option<Table<'_>> {
        let results = self.results();
        let plan = results.plan();
        let mut table = Table::of(|| 0..plan.lines).whole("seed", |line| plan.seed_of(*line));
        for quantity in &plan.record {
            let name = quantity.name();
            if quantity.is_regime() {
                table = table.with(name, Kind::Text(Regime::LONGEST_NAME), |line| {
                    let regime = results.regime(0, *line, *quantity);
                    regime.map_or("", Regime::name)
                });
            } else {
                table = table.real(name, |line| results.value(0, *line, *quantity));
            }
        }
        Some(table.done())
    }
}

/// JSON object of a parameter study, in SI units.
#[derive(Serialize)]
struct ResultsJson<'a> {
    scene: &'a Scene,
    /// Values on each axis of the study. Each key is the path of the field that varies along the
    /// axis.
    axes: BTreeMap<&'a str, &'a [f64]>,
    profiles: u64,
    /// Unit of each axis and of each recorded quantity, by its column in the table of records.
    units: BTreeMap<&'a str, &'static str>,
    /// Premises of the model that some of the profiles do not meet, over all cells of the study.
    warnings: Vec<String>,
    records: Table<'a>,
}

/// Report on the results of a parameter study that are in memory. The table has a row for each
/// combination of values on the axes of the study and for each random profile.
impl Report for Results {
    fn warnings(&self) -> Vec<String> {
        counted_texts(&self.all_warnings(), self.plan().lines)
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let plan = self.plan();
        let mut axes = BTreeMap::new();
        let mut units = BTreeMap::new();
        for axis in &plan.axes {
            axes.insert(axis.path.as_str(), axis.values.as_slice());
            units.insert(axis.path.as_str(), axis.unit);
        }
        for quantity in plan.record.iter().filter(|quantity| !quantity.is_regime()) {
            units.insert(quantity.name(), quantity.unit());
        }
        Some(Box::new(ResultsJson {
            scene: &plan.scene,
            axes,
            profiles: plan.lines,
            units,
            warnings: Report::warnings(self),
            records: Results::table(self),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(Results::table(self))
    }
}
