//! Median and scatter, over many curves, of the values that their fits have found.

use crate::fits::{CurveRow, FACTS, FitsReport};
use crate::sheet::Sheet;
use crate::spread::{Spread, table_of};
use asperity_experiment::Parameter;

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
        sheet.table(&table_of(&spreads));
        sheet.paragraph(
            "The scatter is 1.4826 times the median distance from the median. For a normal distribution this is the standard \
             deviation.",
        );
    }
}
