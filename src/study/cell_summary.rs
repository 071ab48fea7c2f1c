//! Summary of one cell over its profiles: computed here, written by a merge, read back and shown on maps.

use super::figure::Estimate;
use super::quantity::Quantity;
use super::statistics::{Statistics, StudentT};
use crate::analysis::CellRegime;

/// Summary of one cell over its profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSummary {
    /// Index of the cell.
    pub cell: u64,
    /// Number of profiles.
    pub lines: u64,
    /// For each recorded quantity, in the order of the plan; `None` for the regime.
    pub quantities: Vec<Option<Spread>>,
    /// Share of profiles in each regime, in the order of [`crate::analysis::Regime::ALL`]; `None` if unknown.
    pub regimes: Option<[f64; 3]>,
}

/// Mean and spread of a quantity over the profiles of a cell, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation; `None` for one profile.
    pub standard_deviation: Option<f64>,
    /// 95 % confidence interval of the mean; `None` for one profile.
    pub confidence_interval: Option<(f64, f64)>,
}

impl CellSummary {
    /// Summary of the values of a cell, one slice for each profile, in the order of `record`; NaN does not count.
    pub(super) fn new(cell: u64, record: &[Quantity], lines: &[&[f64]], quantiles: &mut StudentT) -> Self {
        let mut regimes = None;
        let mut quantities = Vec::with_capacity(record.len());
        for (column, quantity) in record.iter().enumerate() {
            let values = lines.iter().map(|line| line[column]).filter(|value| !value.is_nan());
            let values: Vec<f64> = values.collect();
            if *quantity == Quantity::Regime {
                let share = |place: usize| {
                    values.iter().filter(|value| **value as usize == place).count() as f64
                        / values.len() as f64
                };
                regimes = (!values.is_empty()).then(|| [0, 1, 2].map(share));
                quantities.push(None);
                continue;
            }
            let statistics = Statistics::with(&values, quantiles);
            quantities.push(values.first().map(|first| Spread {
                mean: statistics.map_or(*first, |all| all.mean),
                standard_deviation: statistics.map(|all| all.standard_deviation),
                confidence_interval: statistics.map(|all| all.confidence_interval),
            }));
        }
        CellSummary { cell, lines: lines.len() as u64, quantities, regimes }
    }

    /// The same without spreads, for too few profiles to state a confidence.
    pub(super) fn of_means(mut self) -> Self {
        for spread in self.quantities.iter_mut().flatten() {
            *spread = Spread { standard_deviation: None, confidence_interval: None, ..*spread };
        }
        self
    }

    /// Mean of a quantity with its confidence interval, by its place among the recorded; `None` where not finite.
    pub(crate) fn estimate(&self, column: usize) -> Option<Estimate> {
        let Spread { mean, confidence_interval, .. } = (*self.quantities.get(column)?)?;
        let (low, high) = confidence_interval.unwrap_or((mean, mean));
        mean.is_finite().then_some(Estimate { mean, low, high })
    }

    /// Regime of the cell and of its profiles; `None` if not recorded.
    #[must_use]
    pub fn regime(&self) -> Option<CellRegime> {
        CellRegime::from_shares(self.regimes?)
    }
}
