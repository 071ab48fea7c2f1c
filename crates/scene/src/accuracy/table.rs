//! Table of the errors and computing times of a scene, from coarse to fine.

use crate::accuracy::solution::has_loads;
use crate::scene::model::{Numerics, Scene, Solver};
use asperity_contact::Edges;
use asperity_data::{counted, format_rounded, median, slope};
use serde::{Serialize, Serializer};
use strum::IntoStaticStr;

/// Number of finer solutions that must confirm that an error is within a bound.
pub(super) const REFINEMENTS: usize = 2;

/// Relative errors for which [`CostTable::answer`] states numbers of springs and times.
const TARGETS: [(f64, &str); 2] = [(0.01, "1 %"), (0.001, "0.1 %")];

/// Setting that is varied in the rows of a [`CostTable`]: the number of springs, with one of the
/// two kinds of [`Edges`], or the step of the stepwise [`Solver`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr, Serialize)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Knob {
    /// Number of springs N of the exact solver. The edge of a contact patch may lie anywhere
    /// between two springs ([`Edges::SubCell`]).
    SubCellSprings,
    /// Number of springs N of the exact solver. Contact patches consist of whole springs, as in
    /// Popov and Filippov (2012) ([`Edges::Grid`]).
    GridSprings,
    /// Step Δd of the indentation in m, by which the stepwise [`Solver`] moves the body.
    Step,
}

impl Knob {
    /// All settings that can be varied, in the order in which [`CostTable::rows`] has them.
    pub const ALL: [Knob; 3] = [Knob::SubCellSprings, Knob::GridSprings, Knob::Step];

    /// Returns the name of the setting for users, such as `whole springs N`.
    pub fn name(self) -> &'static str {
        match self {
            Knob::SubCellSprings => "springs N, edges between springs",
            Knob::GridSprings => "whole springs N",
            Knob::Step => "step Δd of the stepwise solver",
        }
    }
}

/// Computing times of a scene, from several computations with the same setting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Shortest of the measured computing times, in s.
    pub minimum: f64,
    /// Median of the measured computing times, in s.
    pub median: f64,
    /// Number of timed computations.
    pub runs: usize,
}

impl Timing {
    /// Computes the shortest and the median time from the times of several computations in s.
    /// Returns `None` for an empty list.
    pub fn of(mut seconds: Vec<f64>) -> Option<Self> {
        let minimum = seconds.iter().copied().reduce(f64::min)?;
        Some(Timing {
            minimum,
            median: median(&mut seconds)?,
            runs: seconds.len(),
        })
    }
}

/// Relative error of a quantity in a [`Row`], and whether the error is large enough to be measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorFigure {
    /// Relative error. If `resolved` is false, this is the smallest error that can be measured.
    pub error: f64,
    /// True if the error is larger than the smallest error that can be measured. When the number of
    /// springs is varied, the smallest error is the estimated error of the reference solution
    /// ([`CostReference::errors`]).
    pub resolved: bool,
    /// Order of convergence p from the previous row to this row: if the setting becomes r times
    /// finer, the error becomes r^p times smaller. `None` unless the errors of both rows are large
    /// enough to be measured (`resolved`).
    pub order: Option<f64>,
}

/// Row of a [`CostTable`]: one value of the varied setting, with the computing times and the errors
/// of the solution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Setting that is varied in this row.
    pub knob: Knob,
    /// Value of the setting: a number of springs, or a step in m.
    pub setting: f64,
    /// Number of springs N of the solution.
    pub springs: u64,
    /// Times of complete computations, which start without earlier results. `None` if no
    /// computation was timed.
    pub seconds: Option<Timing>,
    /// Shortest time of `seconds` divided by the time of one Fourier transform
    /// ([`CostTable::transform_seconds`]); `None` if no computation was timed.
    pub transforms: Option<f64>,
    /// Relative errors of the pull-off force, the force curve, the dissipated energy and the
    /// largest contact length, in this order ([`CostTable::QUANTITIES`]). `None` for a quantity
    /// whose error is unknown.
    #[serde(serialize_with = "by_name")]
    pub errors: [Option<ErrorFigure>; 4],
}

/// Reference to which the errors in a [`CostTable`] are relative. It is the finest solution with
/// edges between springs ([`Edges::SubCell`]). If there is an exact formula for the pull-off force,
/// the force of this formula replaces the pull-off force of the solution. Rows in which the step is
/// varied ([`Knob::Step`]) have another reference: the exact solution with the same number of
/// springs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CostReference {
    /// Number of springs of the finest solution.
    pub springs: u64,
    /// Pull-off force of the reference in N; `None` without a tensile force.
    pub pull_off_force: Option<f64>,
    /// True if `pull_off_force` was computed by an exact formula.
    pub closed_form: bool,
    /// Estimated relative errors of the reference itself: of the pull-off force, the force curve,
    /// the dissipated energy and the largest contact length ([`CostTable::QUANTITIES`]). `None` for
    /// a quantity whose error is unknown.
    #[serde(serialize_with = "by_name")]
    pub errors: [Option<f64>; 4],
}

fn by_name<T: Serialize, S: Serializer>(values: &[T; 4], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(CostTable::QUANTITIES.iter().zip(values))
}

/// Errors and computing times of one scene, returned by
/// [`measure`](crate::discretisation::measure). The table has rows with more and more springs for
/// the exact solver, and rows with smaller and smaller steps for the stepwise solver
/// ([`Solver::Stepwise`]).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CostTable {
    /// Time in s that the measurement was allowed to take.
    pub budget: f64,
    /// Time in s that the measurement has taken.
    pub spent: f64,
    /// Time in s of one real Fourier transform of 2^20 points, the shortest of several
    /// measurements. It is the unit of [`Row::transforms`].
    pub transform_seconds: f64,
    /// Reference solution, to which the errors in the rows are relative.
    pub reference: CostReference,
    /// Rows of the table. All rows in which the same setting ([`Knob`]) is varied follow each
    /// other, from coarse to fine.
    pub rows: Vec<Row>,
    /// Values of settings that were not computed because the time or the memory was not sufficient,
    /// as text such as `512 springs`.
    pub left_out: Vec<String>,
}

impl CostTable {
    /// Names of the quantities whose errors are measured. They are the pull-off force F_a, the
    /// force curve, the dissipated energy and the largest contact length.
    ///
    /// The error of a force curve is its mean absolute difference from the force curve of the
    /// reference at equal indentations, divided by the largest absolute force of the reference
    /// ([`CostReference`]).
    pub const QUANTITIES: [&str; 4] = [
        "pull_off_force",
        "curve",
        "dissipated_energy",
        "contact_length",
    ];

    /// Returns the rows in which the setting `knob` is varied, from coarse to fine.
    pub fn rows_of(&self, knob: Knob) -> impl DoubleEndedIterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.knob == knob)
    }

    /// Returns the main error of a row: the error of the pull-off force. Without a tensile force,
    /// the main error is that of the force curve. Returns `None` if this error is unknown.
    pub fn main_error(&self, row: &Row) -> Option<ErrorFigure> {
        let [pull_off_force, curve, ..] = row.errors;
        if self.reference.pull_off_force.is_some() {
            pull_off_force
        } else {
            curve
        }
    }

    /// Returns true if each error of the pull-off force in this table is the largest of three
    /// errors: at half the loads, at the loads, and at twice the loads of `scene`. Only rows in
    /// which the number of springs is varied have such errors. `scene` is the scene of this table.
    ///
    /// Returns false if the errors are those at the loads of `scene` alone. There are three such
    /// cases:
    ///
    /// * an exact formula gives the pull-off force, which holds at any load;
    /// * there is no pull-off force;
    /// * the scene has no target forces or indentations.
    pub fn is_over_loads(&self, scene: &Scene) -> bool {
        self.reference.pull_off_force.is_some() && !self.reference.closed_form && has_loads(scene)
    }

    /// Returns the shortest computing time of a row in s, and the [`main_error`](Self::main_error)
    /// of the row. Returns `None` unless the time and the error are known, positive and finite.
    pub fn point(&self, row: &Row) -> Option<(f64, ErrorFigure)> {
        let seconds = row.seconds?.minimum;
        let figure = self.main_error(row)?;
        let is_shown = seconds > 0.0 && figure.error > 0.0 && figure.error.is_finite();
        is_shown.then_some((seconds, figure))
    }

    /// Returns the first row, from coarse to fine, from which on the errors are small. The setting
    /// `knob` is varied in this row. The [main errors](Self::main_error) of this row and of all
    /// finer rows are at most `bound`. Returns `None` if there is no such row with at least two
    /// finer rows.
    pub fn first_row_within(&self, knob: Knob, bound: f64) -> Option<&Row> {
        let rows: Vec<&Row> = self.rows_of(knob).collect();
        let errors = rows.iter().map(|row| Some(self.main_error(row)?.error));
        Some(rows[first_within(errors, bound)?])
    }

    /// Returns the computing time in s and the relative main error of a scene with the settings
    /// `numerics`. Both numbers are interpolated between two rows of the table. Returns `None` if
    /// the number of springs or the step is outside the range of the rows. Also returns `None` if
    /// the rows of the stepwise solver have another number of springs.
    pub fn between_rows(&self, numerics: &Numerics) -> Option<(f64, f64)> {
        let (knob, setting) = match (numerics.solver, numerics.edges) {
            (Solver::Stepwise { step }, _) => (Knob::Step, step),
            (Solver::Exact, Edges::Grid) => (Knob::GridSprings, numerics.points as f64),
            (Solver::Exact, Edges::SubCell) => (Knob::SubCellSprings, numerics.points as f64),
        };
        let mut points = Vec::new();
        for row in self.rows_of(knob) {
            if knob == Knob::Step && row.springs != numerics.points {
                continue;
            }
            if let Some((seconds, figure)) = self.point(row) {
                points.push(CostPoint {
                    logarithm: row.setting.ln(),
                    seconds,
                    error: figure.error,
                });
            }
        }
        points.sort_by(|one, other| one.logarithm.total_cmp(&other.logarithm));
        let logarithm = setting.ln();
        let above = points
            .iter()
            .position(|point| point.logarithm >= logarithm)?;
        let right = &points[above];
        if right.logarithm == logarithm {
            return Some((right.seconds, right.error));
        }
        let left = points.get(above.checked_sub(1)?)?;
        let share = (logarithm - left.logarithm) / (right.logarithm - left.logarithm);
        let between = |left: f64, right: f64| left * (right / left).powf(share);
        Some((
            between(left.seconds, right.seconds),
            between(left.error, right.error),
        ))
    }

    /// Returns the order of convergence of the main error when a setting is varied. It is the
    /// absolute slope of ln(error) as a function of ln(setting), fitted by least squares. Only rows
    /// whose error is large enough to be measured are used; for fewer than three such rows, returns
    /// `None`.
    pub fn order(&self, knob: Knob) -> Option<f64> {
        let mut points = Vec::new();
        for row in self.rows_of(knob) {
            if let Some(figure) = self.main_error(row)
                && figure.resolved
            {
                points.push((row.setting.ln(), figure.error.ln()));
            }
        }
        if points.len() < 3 {
            return None;
        }
        // More springs reduce the error, and so does a smaller step. The slope may therefore have
        // either sign.
        slope(&points).map(f64::abs)
    }

    /// Returns two sentences, for a main error of 1 % and of 0.1 %. Each sentence states how many
    /// springs this error needs and how long the computation takes, for both values of [`Edges`].
    pub fn answer(&self) -> Vec<String> {
        let quantity = if self.reference.pull_off_force.is_some() {
            "the pull-off force"
        } else {
            "the force curve"
        };
        let mut sentences = Vec::new();
        for (bound, percent) in TARGETS {
            let sub_cell = self.springs_within(Knob::SubCellSprings, "SubCell", bound);
            let grid = self.springs_within(Knob::GridSprings, "Grid", bound);
            sentences.push(format!("{percent} of {quantity}: {sub_cell}; {grid}."));
        }
        sentences
    }

    /// Returns a phrase that states how many springs keep the main error within a bound, and their
    /// computing time.
    fn springs_within(&self, knob: Knob, edges: &str, bound: f64) -> String {
        if let Some(row) = self.first_row_within(knob, bound) {
            let springs = counted(row.springs, "spring");
            let time = match row.seconds {
                Some(time) => format!(", {}", format_rounded(time.minimum, 3, "s")),
                None => String::new(),
            };
            return format!("{springs}{time} with edges {edges}");
        }
        match self.rows_of(knob).next_back() {
            Some(finest) => {
                let finest = counted(finest.springs, "spring");
                format!("not found up to {finest} with edges {edges}")
            }
            None => format!("edges {edges} were not affordable"),
        }
    }
}

/// Time and main error of a row, with the logarithm of its setting.
struct CostPoint {
    logarithm: f64,
    seconds: f64,
    error: f64,
}

/// Returns the index of the first error from which on all errors are at most `bound`. The errors
/// are in the order from coarse to fine. At least two finer errors must also be within the bound,
/// because an error that changes its sign may be small by chance.
pub(super) fn first_within(
    errors: impl DoubleEndedIterator<Item = Option<f64>>,
    bound: f64,
) -> Option<usize> {
    let errors: Vec<_> = errors.collect();
    let above = errors
        .iter()
        .rposition(|error| error.is_none_or(|error| error.is_nan() || error > bound));
    let first = above.map_or(0, |above| above + 1);
    (first + REFINEMENTS < errors.len()).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_met_from_the_first_error_on_that_two_finer_ones_confirm() {
        let first = |errors: &[f64], bound| first_within(errors.iter().copied().map(Some), bound);
        assert_eq!(first(&[0.5, 0.01, 0.2, 0.1, 0.05, 0.02], 0.1), Some(3));
        assert_eq!(first(&[0.5, 0.01, 0.2], 0.1), None, "small by chance");
        assert_eq!(first(&[0.5, 0.01, 0.02], 0.1), None, "one refinement");
        assert_eq!(first(&[0.05, 0.0, 0.0], 0.1), Some(0));
        assert_eq!(first(&[], 0.1), None);
        assert_eq!(first(&[f64::NAN, 0.0, 0.0, 0.0], 0.1), Some(1));
        assert_eq!(
            first_within([Some(0.0), Some(0.0), None].into_iter(), 0.1),
            None
        );
    }

    #[test]
    fn times_have_a_minimum_and_a_median() {
        let of = |times: &[f64]| {
            Timing::of(times.to_vec()).map(|time| (time.minimum, time.median, time.runs))
        };
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[4.0, 1.0]), Some((1.0, 2.5, 2)));
        assert_eq!(of(&[4.0, 1.0, 2.0]), Some((1.0, 2.0, 3)));
    }

    fn rows(knob: Knob, of: &[(f64, f64)]) -> Vec<Row> {
        let row = |&(setting, error): &(f64, f64)| Row {
            knob,
            setting,
            springs: setting as u64,
            seconds: Timing::of(vec![1e-6 * setting]),
            transforms: None,
            errors: [
                Some(ErrorFigure {
                    error,
                    resolved: error > 1e-6,
                    order: None,
                }),
                None,
                None,
                None,
            ],
        };
        of.iter().map(row).collect()
    }

    fn table(rows: &[Vec<Row>]) -> CostTable {
        let reference = CostReference {
            pull_off_force: Some(1.0),
            ..CostReference::default()
        };
        CostTable {
            reference,
            rows: rows.concat(),
            ..CostTable::default()
        }
    }

    #[test]
    fn the_order_is_the_slope_of_resolved_errors() {
        let steps = [(1.0, 1.0), (0.5, 0.25), (0.25, 0.0625), (1e-6, 1e-7)];
        let table = table(&[
            rows(Knob::Step, &steps),
            rows(Knob::GridSprings, &steps[..2]),
        ]);
        assert!((table.order(Knob::Step).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(
            table.order(Knob::GridSprings),
            None,
            "two rows are no order"
        );
    }

    #[test]
    fn the_first_row_within_a_bound_answers() {
        let sub_cell = [
            (16.0, 0.3),
            (32.0, 1e-4),
            (64.0, 0.02),
            (128.0, 0.005),
            (256.0, 9e-4),
            (512.0, 1e-4),
            (1024.0, 1e-5),
        ];
        let grid = [
            (16.0, 0.3),
            (2048.0, 0.009),
            (4096.0, 0.0045),
            (8192.0, 0.0009),
        ];
        let mut table = table(&[
            rows(Knob::SubCellSprings, &sub_cell),
            rows(Knob::GridSprings, &grid),
        ]);
        assert_eq!(
            table.answer(),
            [
                "1 % of the pull-off force: 128 springs, 128 µs with edges SubCell; 2 048 springs, 2.05 ms with \
                 edges Grid.",
                "0.1 % of the pull-off force: 256 springs, 256 µs with edges SubCell; not found up to 8 192 \
                 springs with edges Grid.",
            ]
        );
        table.reference.pull_off_force = None;
        table.rows.retain(|row| row.knob == Knob::SubCellSprings);
        table.rows.iter_mut().for_each(|row| row.errors.swap(0, 1));
        assert_eq!(
            table.answer()[0],
            "1 % of the force curve: 128 springs, 128 µs with edges SubCell; edges Grid were not affordable."
        );
    }
}
