//! The table of what accuracy costs.

use super::Measures;
use serde::Serialize;

/// What buys accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Knob {
    /// Springs N with edges between them.
    SubCellSprings,
    /// Springs N with edges at them, as in the paper.
    GridSprings,
    /// Step Δd of the stepwise solver.
    Step,
    /// Samples of the curve on each leg.
    Samples,
    /// Heights kept in single precision.
    SinglePrecision,
    /// Random lines in a mean.
    Lines,
}

impl Knob {
    /// All of them, in the order of the table.
    pub const ALL: [Knob; 6] = [
        Knob::SubCellSprings,
        Knob::GridSprings,
        Knob::Step,
        Knob::Samples,
        Knob::SinglePrecision,
        Knob::Lines,
    ];

    /// Its name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Knob::SubCellSprings => "springs N, edges SubCell",
            Knob::GridSprings => "springs N, edges Grid",
            Knob::Step => "step Δd of the stepwise solver",
            Knob::Samples => "curve samples",
            Knob::SinglePrecision => "heights in single precision",
            Knob::Lines => "random lines in a mean",
        }
    }

    /// The unit of its setting.
    #[must_use]
    pub fn unit(self) -> &'static str {
        if self == Knob::Step { "m" } else { "" }
    }
}

/// Times of repeated runs after one that does not count, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// The shortest.
    pub minimum: f64,
    /// The median.
    pub median: f64,
    /// Number of runs.
    pub runs: usize,
}

impl Timing {
    /// Of the times of some runs, s; `None` without one.
    #[must_use]
    pub fn of(mut seconds: Vec<f64>) -> Option<Self> {
        seconds.sort_by(f64::total_cmp);
        let runs = seconds.len();
        let (minimum, upper) = (*seconds.first()?, *seconds.get(runs / 2)?);
        let lower = seconds.get((runs - 1) / 2).copied().unwrap_or(upper);
        Some(Timing { minimum, median: f64::midpoint(lower, upper), runs })
    }
}

/// One relative error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorFigure {
    /// The error; where it is not resolved, that of the reference itself.
    pub error: f64,
    /// Whether it is larger than the error of the reference.
    pub resolved: bool,
    /// Observed order of convergence since the row before, where both are resolved.
    pub order: Option<f64>,
}

/// One setting: what it costs and what it gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What is set.
    pub knob: Knob,
    /// To what: a number, or m for a step.
    pub setting: f64,
    /// Springs N.
    pub springs: u64,
    /// Time of a whole run, everything made anew; `None` where time is not what it buys.
    pub seconds: Option<Timing>,
    /// The shortest time in Fourier transforms, see [`CostTable::transform_seconds`].
    pub transforms: Option<f64>,
    /// Relative errors of what the setting changes.
    pub errors: Measures<Option<ErrorFigure>>,
}

/// What errors are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Springs of the finest solution with edges between springs.
    pub springs: u64,
    /// Adhesion force, N.
    pub adhesion_force: Option<f64>,
    /// Whether that is a closed form; everything else is the finest solution's.
    pub closed_form: bool,
    /// Estimated relative errors of the reference itself.
    pub errors: Measures<Option<f64>>,
}

/// What accuracy costs for one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostTable {
    /// Time that was given, s.
    pub budget: f64,
    /// Time that was taken, s.
    pub spent: f64,
    /// The unit of time: the shortest time of one real Fourier transform of 2^20 points, planned beforehand,
    /// s.
    pub transform_seconds: f64,
    /// What errors are counted from.
    pub reference: Reference,
    /// The settings, knob by knob, from coarse to fine.
    pub rows: Vec<Row>,
    /// What was not tried or not reached, and why.
    pub left_out: Vec<String>,
}

impl CostTable {
    /// The rows of one knob.
    pub fn rows_of(&self, knob: Knob) -> impl DoubleEndedIterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.knob == knob)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_a_minimum_and_a_median() {
        let of = |times: &[f64]| Timing::of(times.to_vec());
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[3.0]), Some(Timing { minimum: 3.0, median: 3.0, runs: 1 }));
        assert_eq!(of(&[4.0, 1.0]), Some(Timing { minimum: 1.0, median: 2.5, runs: 2 }));
        assert_eq!(of(&[4.0, 1.0, 2.0]), Some(Timing { minimum: 1.0, median: 2.0, runs: 3 }));
    }
}
