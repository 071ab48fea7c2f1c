//! Results of many random profiles as text, JSON and CSV.

use crate::preloads::MEAN_INTERVAL;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::summary::tabor_number;
use asperity_data::grouped;
use asperity_data::root_mean_square;
use asperity_data::{Kind, Table, object};
use asperity_data::{format_range, format_rounded};
use asperity_scene::Choice;
use asperity_scene::Regime;
use asperity_study::{Quantity, Results, Statistics};

/// Results of a scene on random profiles, a study of one cell.
#[derive(Clone, Copy, Debug)]
pub struct LinesReport<'a> {
    /// Choice of springs for a tolerance, if one was requested.
    pub choice: Option<&'a Choice>,
    /// Records with the quantities [`LinesReport::RECORD`].
    pub results: &'a Results,
}

impl LinesReport<'_> {
    /// Quantities that the report needs.
    pub const RECORD: &'static [Quantity] = &[
        Quantity::AdhesionForce,
        Quantity::PreloadIndentation,
        Quantity::DissipatedEnergy,
        Quantity::ContactFraction,
        Quantity::Regime,
        Quantity::RegimeAfterZeroForce,
        Quantity::Skewness,
        Quantity::ExcessKurtosis,
        Quantity::TaborNumber,
    ];

    fn lines(&self) -> std::ops::Range<u64> {
        0..self.results.plan().lines
    }

    /// Statistics of a quantity over the profiles; `None` if fewer than two have a value.
    fn statistics(&self, quantity: Quantity) -> Option<Statistics> {
        self.results.statistics(0, quantity).filter(|all| all.spread.is_some())
    }

    fn regimes(&self, line: u64) -> [Option<Regime>; 2] {
        Quantity::REGIMES.map(|regime| self.results.regime(0, line, regime))
    }

    /// Root mean square of a quantity over the profiles, in its SI unit.
    fn rms(&self, quantity: Quantity) -> Option<f64> {
        root_mean_square(self.results.values(0, quantity))
    }
}

impl Report for LinesReport<'_> {
    fn text(&self) -> Option<String> {
        let plan = self.results.plan();
        let mut sheet = Sheet::default();
        sheet.paragraph(&plan.scene.title);
        let (count, springs) = (grouped(plan.lines), grouped(plan.scene.numerics.points));
        let last = plan.seed_of(plan.lines - 1);
        sheet
            .heading(&format!("{count} random profiles of {springs} springs, seeds {} to {last}", plan.seed));
        let header = ["", "median", "quartiles", "range", "mean", MEAN_INTERVAL, "profiles"];
        let (mut rows, mut warnings) = (vec![header.map(String::from)], Vec::new());
        for (name, quantity) in [
            ("adhesion force F_a", Quantity::AdhesionForce),
            ("preload indentation", Quantity::PreloadIndentation),
            ("dissipated energy", Quantity::DissipatedEnergy),
            ("contact fraction", Quantity::ContactFraction),
        ] {
            let Some(all) = self.statistics(quantity) else { continue };
            let number = |value| format_rounded(value, 3, quantity.unit());
            let range = |ends| format_range(ends, 2, quantity.unit());
            let [lower, median, upper] = all.quartiles;
            let [quartiles, ends, confidence] = [(lower, upper), all.range, all.ends()].map(range);
            let count = grouped(all.count as u64);
            rows.push([name.into(), number(median), quartiles, ends, number(all.mean), confidence, count]);
            warnings.extend(all.warning(name));
        }
        sheet.table(&rows);
        warnings.iter().for_each(|warning| sheet.paragraph(warning));
        // Profiles of one spectrum have one Tabor number, which limits the dissipated energy.
        let value = |line, quantity| self.results.value(0, line, quantity);
        let dissipating = self.lines().filter(|line| value(*line, Quantity::DissipatedEnergy).is_some());
        let number = dissipating.into_iter().find_map(|line| value(line, Quantity::TaborNumber));
        number
            .iter()
            .for_each(|number| sheet.heading(&format!("Tabor number μ = {}", tabor_number(*number))));
        let headings = ["Regimes from first touch", "Regimes after zero net force"];
        for (heading, regimes) in headings.into_iter().zip(self.results.regimes(0)) {
            sheet.heading(heading);
            for (name, count) in regimes.present() {
                sheet.row(name, grouped(count as u64));
            }
        }
        sheet.heading("Heights of single profiles; both would be 0 if they averaged themselves");
        sheet.quantity("rms skewness", self.rms(Quantity::Skewness), "1");
        sheet.quantity("rms excess kurtosis", self.rms(Quantity::ExcessKurtosis), "1");
        if let Some(choice) = self.choice {
            sheet.heading(&choice.sentence());
        }
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let lines = self.lines().map(|line| {
            let value = |quantity| self.results.value(0, line, quantity);
            let heights = value(Quantity::Skewness).zip(value(Quantity::ExcessKurtosis));
            object! {
                "seed": self.results.plan().seed_of(line),
                "adhesion_force": value(Quantity::AdhesionForce),
                "preload_indentation": value(Quantity::PreloadIndentation),
                "dissipated_energy": value(Quantity::DissipatedEnergy),
                "tabor_number": value(Quantity::TaborNumber),
                "contact_fraction": value(Quantity::ContactFraction),
                "regime": self.regimes(line)[0],
                "regime_after_zero_force": self.regimes(line)[1],
                "heights": heights.map(|(skewness, kurtosis)| object! {
                    "skewness": skewness, "excess_kurtosis": kurtosis,
                }),
            }
        });
        Some(Box::new(object! {
            "scene": &self.results.plan().scene,
            "choice"?: self.choice,
            "adhesion_force": self.statistics(Quantity::AdhesionForce),
            "preload_indentation": self.statistics(Quantity::PreloadIndentation),
            "dissipated_energy": self.statistics(Quantity::DissipatedEnergy),
            "contact_fraction": self.statistics(Quantity::ContactFraction),
            "regimes": self.results.regimes(0)[0],
            "regimes_after_zero_force": self.results.regimes(0)[1],
            "rms_skewness": self.rms(Quantity::Skewness),
            "rms_excess_kurtosis": self.rms(Quantity::ExcessKurtosis),
            "lines": lines.collect::<Vec<_>>(),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table = Table::of(|| self.lines()).whole("seed", |line| self.results.plan().seed_of(*line));
        for quantity in Self::RECORD {
            let (name, text) = (quantity.name(), Kind::Text(Regime::LONGEST_NAME));
            let regime = |line| self.results.regime(0, line, *quantity);
            table = match quantity.is_regime() {
                true => table.with(name, text, move |line| regime(*line).map_or("", Regime::name)),
                false => table.real(name, |line| self.results.value(0, *line, *quantity)),
            };
        }
        Some(table.done())
    }
}
