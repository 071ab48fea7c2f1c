//! Median and scatter, over many curves, of the values that their fits have found.

use crate::fits::{CurveRow, FACTS, FitsReport};
use crate::sheet::Sheet;
use asperity_data::{format_rounded, format_within, median};
use asperity_experiment::Parameter;
use serde::Serialize;

/// Standard deviation of a normal distribution divided by its median absolute deviation.
const OF_NORMAL: f64 = 1.4826;

/// Median and scatter of one quantity over the fitted curves, in the SI unit of the quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Spread {
    /// Name of the column of the quantity in the table of the curves, such as `work`.
    name: &'static str,
    /// Name of the quantity with its symbol, such as `work of adhesion γ`.
    #[serde(skip)]
    term: String,
    unit: &'static str,
    median: f64,
    /// Median absolute deviation from the median times 1.4826; `None` for a single curve. For
    /// values with a normal distribution this is an estimate of the standard deviation, which a few
    /// outliers hardly change.
    scatter: Option<f64>,
    /// Number of curves that have a value of this quantity.
    curves: usize,
}

impl Spread {
    /// Returns median and scatter of some values; `None` if there are no values.
    fn new(
        name: &'static str,
        term: String,
        unit: &'static str,
        mut values: Vec<f64>,
    ) -> Option<Spread> {
        let curves = values.len();
        let middle = median(&mut values)?;
        let mut deviations: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
        let scatter = median(&mut deviations).map(|deviation| OF_NORMAL * deviation);
        Some(Spread {
            name,
            term,
            unit,
            median: middle,
            scatter: scatter.filter(|_| curves > 1),
            curves,
        })
    }

    fn cells(&self) -> [String; 4] {
        let median = format_within(self.median, self.scatter.unwrap_or(0.0), self.unit);
        let scatter = match self.scatter {
            Some(scatter) => format_rounded(scatter, 2, self.unit),
            None => "-".to_owned(),
        };
        [self.term.clone(), median, scatter, self.curves.to_string()]
    }
}

impl FitsReport<'_> {
    /// Returns median and scatter of each free parameter and of the pull-off force over the fitted
    /// curves, whether the model describes them or not. A curve that gives only a bound of a
    /// parameter does not count for it. The displacement at first touch and the force before
    /// contact are left out, because they depend on the instrument.
    pub(crate) fn spreads(&self) -> Vec<Spread> {
        let mut spreads = Vec::new();
        for (index, parameter) in self.free.iter().enumerate() {
            if matches!(parameter, Parameter::Offset | Parameter::Zero) {
                continue;
            }
            let row = parameter.row();
            let term = format!("{} {}", row.term, row.symbol);
            let values = self.values(|curve| *curve.parameters.get(index)?.first()?);
            spreads.extend(Spread::new(row.name, term, row.unit, values));
        }
        let pull_off = "pull_off_force";
        if let Some(index) = FACTS.iter().position(|name| *name == pull_off) {
            let values = self.values(|curve| curve.facts[index]);
            let term = "pull-off force F_a".to_owned();
            spreads.extend(Spread::new(pull_off, term, "N", values));
        }
        spreads
    }

    /// Returns a number of each fitted curve that has it.
    fn values(&self, of: impl Fn(&CurveRow) -> Option<f64>) -> Vec<f64> {
        let fitted = self.rows.iter().filter(|row| row.error.is_empty());
        fitted.filter_map(of).collect()
    }

    /// Adds a table with median and scatter of each quantity, if a curve was fitted.
    pub(crate) fn add_spreads(&self, sheet: &mut Sheet) {
        let spreads = self.spreads();
        if spreads.is_empty() {
            return;
        }
        sheet.heading("Over all fitted curves, described or not:");
        let mut rows = vec![["", "median", "scatter", "curves"].map(String::from)];
        rows.extend(spreads.iter().map(Spread::cells));
        sheet.table(&rows);
        sheet.paragraph(
            "The scatter is 1.4826 times the median distance from the median. For a normal distribution this is the standard \
             deviation.",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(values: &[f64]) -> Option<Spread> {
        Spread::new("work", "work γ".to_owned(), "J/m²", values.to_vec())
    }

    #[test]
    fn an_outlier_hardly_changes_median_and_scatter() {
        let found = spread(&[0.05, 0.049, 0.051, 0.052, 7.0]).unwrap();
        assert_eq!((found.median, found.curves), (0.051, 5));
        assert!((found.scatter.unwrap() - 0.0014826).abs() < 1e-9);
        assert_eq!(
            found.cells(),
            ["work γ", "51 mJ/m²", "1.5 mJ/m²", "5"].map(String::from)
        );
    }

    #[test]
    fn one_curve_has_no_scatter_and_no_curve_no_median() {
        let found = spread(&[0.05]).unwrap();
        assert_eq!((found.median, found.scatter), (0.05, None));
        assert_eq!(found.cells()[2], "-");
        assert_eq!(spread(&[]), None);
        assert_eq!(spread(&[0.05, 0.05]).unwrap().scatter, Some(0.0));
    }
}
