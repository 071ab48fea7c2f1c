//! Median and scatter of a quantity over many curves.

use asperity_data::{format_rounded, format_within, median};
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
    /// Returns the median and the scatter of some values; `None` if there are no values.
    pub fn new(
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

/// Returns a table of quantities for a text.
pub(crate) fn table_of(spreads: &[Spread]) -> Vec<[String; 4]> {
    let mut rows = vec![["", "median", "scatter", "curves"].map(String::from)];
    rows.extend(spreads.iter().map(Spread::cells));
    rows
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
