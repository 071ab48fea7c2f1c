//! Cost of accuracy of one scene: solutions from coarse to fine within a limited time. The
//! solutions form a ladder. Each rung has two solutions by the exact solver: one with contact
//! patches that end anywhere between springs, and one with patches of whole springs. As soon as an
//! exact solution with enough springs is known, each rung also has a solution by the stepwise
//! solver. From rung to rung the number of springs is doubled and the step of the stepwise solver
//! is halved.

use super::estimate::own_errors;
use super::solution::{
    Errors, Runs, Solution, Target, allowed_points, is_spent, is_too_coarse, refined,
};
use super::table::{CostReference, CostTable, ErrorFigure, Knob, Row, Timing};
use crate::scene::checked::CheckedScene;
use crate::scene::errors::SceneErrors;
use crate::scene::model::{Scene, Solver};
use crate::simulation::outcome::RunError;
use asperity_contact::{ContactError, Edges};
use asperity_data::{counted, format_quantity};
use asperity_fourier::plan_real_forward;
use std::path::Path;
use std::time::{Duration, Instant};

/// Smallest ratio of the remaining time to the time of the last rung at which another rung is
/// begun. The next rung takes about twice the time of the last rung. The error estimate of the
/// finest solution takes about the same time as the last rung. The rest is a reserve for a busy
/// machine.
const LATER: f64 = 4.0;
/// Number of points of a force curve that is compared, for all loading stages together. With so
/// many points, the distance of the points does not affect the measured errors.
const COMPARED_POINTS: u64 = 1 << 16;
/// Largest number of points of one loading stage in a compared force curve.
const MOST_COMPARED: u64 = 4096;
/// Relative error below which an error cannot be distinguished from rounding.
const ROUNDING: f64 = 1e-14;
/// Number of springs for the stepwise solver. It is larger if the scene needs more springs.
const STEPWISE_SPRINGS: u64 = 256;
/// Number of steps with which the coarsest solution of the stepwise solver passes the range of
/// indentations.
const FEWEST_STEPS: f64 = 16.0;
/// Two limits for timing one setting: the largest number of computations, and the time in s after
/// which no further computation begins.
const MOST_RUNS: usize = 9;
const ENOUGH_RUNS: f64 = 0.05;
/// Number of points of the Fourier transform that serves as the unit of computing time.
const TRANSFORM_POINTS: usize = 1 << 20;

/// Progress of a measurement of errors and computing times. [`measure`] passes values of this type
/// to its argument `watch`.
pub enum Progress<'a> {
    /// The setting that is varied and, as text such as `512 springs`, the value that is tried next.
    Trying(Knob, &'a str),
    /// Table of the solutions computed so far. The errors in the table are relative to the finest
    /// of these solutions.
    Rows(&'a CostTable),
}

/// Solutions of a scene from coarse to fine, within a limited time.
struct Ladder<'a> {
    scene: &'a CheckedScene,
    folder: &'a Path,
    is_over: &'a dyn Fn() -> bool,
    rungs: Vec<Rung>,
    table: CostTable,
}

/// One value of a setting, and the scene with this value.
struct Setting {
    knob: Knob,
    value: f64,
    scene: CheckedScene,
}

/// One solution and its row of the table. The row states the setting and the times, but no errors
/// yet.
struct Rung {
    row: Row,
    solution: Solution,
}

/// Limits the time of a measurement.
struct Clock<'a> {
    begun: Instant,
    /// Time in s that the whole measurement may take.
    budget: f64,
    stop: &'a dyn Fn() -> bool,
}

impl Clock<'_> {
    /// Returns the remaining time in s; 0 if the caller has stopped the measurement.
    fn left(&self) -> f64 {
        if (self.stop)() {
            0.0
        } else {
            self.budget - self.begun.elapsed().as_secs_f64()
        }
    }
}

/// Measures the errors and the computing times of a scene: with more and more springs for the exact
/// solver, and with smaller and smaller steps for the stepwise [`Solver`]. The measurement ends
/// when the time `budget` is used up. Names of measured files are relative to `folder`. `watch`
/// receives each setting before it is tried, and the table of the solutions so far.
///
/// Returns an error message if the scene cannot be computed, if the budget is too small for two
/// solutions, or if `stop` returned true.
pub fn measure(
    scene: &CheckedScene,
    folder: &Path,
    budget: Duration,
    stop: &dyn Fn() -> bool,
    watch: &mut dyn FnMut(Progress<'_>),
) -> Result<CostTable, String> {
    let clock = Clock {
        begun: Instant::now(),
        budget: budget.as_secs_f64(),
        stop,
    };
    let is_over = || clock.left() <= 0.0;
    let mut ladder = Ladder {
        scene,
        folder,
        is_over: &is_over,
        rungs: Vec::new(),
        table: CostTable {
            budget: clock.budget,
            transform_seconds: time_of_transform().unwrap_or(f64::NAN),
            ..CostTable::default()
        },
    };
    let refused = ladder
        .climb(&clock, watch)
        .map_err(|error| error.to_string())?;
    let own = ladder.own_errors();
    if stop() {
        return Err("the measurement was stopped".to_owned());
    }
    if ladder.count(own) {
        return Ok(CostTable {
            spent: clock.begun.elapsed().as_secs_f64(),
            ..ladder.table
        });
    }
    if let Some(error) = refused
        && ladder.rungs.is_empty()
    {
        return Err(error.to_string());
    }
    let springs = allowed_points(scene)
        .next()
        .unwrap_or(scene.numerics.points);
    Err(format!(
        "the budget of {} s is spent before two solutions could be compared, of which the coarsest has \
         {springs} springs",
        clock.budget
    ))
}

/// Returns the scene with as many points of the force curve as a comparison of curves needs.
fn compared(scene: &CheckedScene) -> Result<CheckedScene, SceneErrors> {
    scene.with(|scene| scene.numerics.samples = compared_samples(scene))
}

fn compared_samples(scene: &Scene) -> u64 {
    let stages = scene.loading.len().max(1) as u64;
    (COMPARED_POINTS / stages).clamp(2, MOST_COMPARED)
}

impl Ladder<'_> {
    /// Adds rungs to the ladder while there is time. If the scene was refused because it had too
    /// few springs, returns this error.
    fn climb(
        &mut self,
        clock: &Clock<'_>,
        watch: &mut dyn FnMut(Progress<'_>),
    ) -> Result<Option<RunError>, RunError> {
        let mut refused = None;
        let mut last_seconds = 0.0;
        // The first number of springs is tried even if no time is left. The computation reads the
        // files of the scene before it checks the time, so its error names a file that cannot be
        // read.
        let mut is_first = true;
        for points in allowed_points(self.scene) {
            let before = clock.left();
            // The first two rungs may take all of the time, because a comparison needs two
            // solutions.
            let needed = if self.finest().is_some() {
                LATER * last_seconds
            } else {
                0.0
            };
            let mut goes_on = before > needed || is_first;
            is_first = false;
            for setting in self.settings(points) {
                let springs = counted(points, "spring");
                let (name, beyond) = match setting.knob {
                    Knob::Step => (format_quantity(setting.value, "m"), "less"),
                    Knob::SubCellSprings | Knob::GridSprings => (springs, "more"),
                };
                if goes_on {
                    watch(Progress::Trying(setting.knob, &name));
                    match self.rung(&setting) {
                        Ok(rung) => self.rungs.push(rung),
                        Err(error) if is_too_coarse(&error) => refused = Some(error),
                        Err(error) if is_spent(&error) => goes_on = false,
                        Err(error) => return Err(error),
                    }
                }
                if !goes_on {
                    let left_out = format!("{}: {name} and {beyond}", setting.knob.name());
                    self.table.left_out.push(left_out);
                }
            }
            if !goes_on {
                break;
            }
            last_seconds = before - clock.left();
            if self.count(None) {
                watch(Progress::Rows(&self.table));
            }
        }
        Ok(refused)
    }

    /// Estimates the errors of the finest solution. Returns `None` if there are fewer than two
    /// solutions.
    fn own_errors(&self) -> Option<Errors> {
        let [finest, _] = self.finest()?;
        let mut runs = Runs::new(self.folder, self.is_over);
        own_errors(&compared(self.scene).ok()?, finest, &mut runs)
    }

    /// Returns the settings of the rung with `points` springs. As soon as the exact solution for
    /// comparison is known, the settings include a step of the stepwise solver, which is halved
    /// from rung to rung.
    fn settings(&self, points: u64) -> Vec<Setting> {
        let mut settings = Vec::new();
        for (knob, edges) in [
            (Knob::SubCellSprings, Edges::SubCell),
            (Knob::GridSprings, Edges::Grid),
        ] {
            if self.scene.relaxes() && edges == Edges::Grid {
                continue;
            }
            if let Ok(scene) = refined(self.scene, points, edges) {
                settings.push(Setting {
                    knob,
                    value: points as f64,
                    scene,
                });
            }
        }
        settings.extend(self.next_step());
        settings
    }

    /// Returns the next step of the stepwise solver. Returns `None` if the exact solution for
    /// comparison is not known yet.
    fn next_step(&self) -> Option<Setting> {
        let exact = self.exact()?;
        let mut lowest = f64::INFINITY;
        let mut highest = f64::NEG_INFINITY;
        for [indentation, _] in exact.curve.iter().flatten() {
            lowest = indentation.min(lowest);
            highest = indentation.max(highest);
        }
        let halvings = self.rungs_of(Knob::Step).count() as i32;
        let step = (highest - lowest) / FEWEST_STEPS * 0.5_f64.powi(halvings);
        let scene = refined(self.scene, exact.points, Edges::Grid)
            .and_then(|scene| scene.with(|scene| scene.numerics.solver = Solver::Stepwise { step }))
            .ok()?;
        (lowest < highest).then_some(Setting {
            knob: Knob::Step,
            value: step,
            scene,
        })
    }

    fn rung(&self, setting: &Setting) -> Result<Rung, RunError> {
        let mut runs = Runs::new(self.folder, self.is_over);
        let compared = compared(&setting.scene)?;
        let solution = if setting.knob == Knob::Step {
            runs.solve(&compared)?
        } else {
            runs.solve_around(&compared)?
        };
        let seconds = self.time(&setting.scene).ok_or(ContactError::Interrupted)?;
        let row = Row {
            knob: setting.knob,
            setting: setting.value,
            springs: solution.points,
            seconds: Some(seconds),
            transforms: Some(seconds.minimum / self.table.transform_seconds),
            errors: [None; 4],
        };
        Ok(Rung { row, solution })
    }

    /// Measures the times of several complete computations of a scene, in which no earlier result
    /// is used again. Returns `None` if not even one computation was possible in the remaining
    /// time.
    fn time(&self, scene: &CheckedScene) -> Option<Timing> {
        let begun = Instant::now();
        let mut seconds = Vec::new();
        while seconds.is_empty()
            || (seconds.len() < MOST_RUNS && begun.elapsed().as_secs_f64() < ENOUGH_RUNS)
        {
            let run_begun = Instant::now();
            let Ok(_) = Runs::new(self.folder, self.is_over).solve(scene) else {
                break;
            };
            seconds.push(run_begun.elapsed().as_secs_f64());
        }
        Timing::of(seconds)
    }

    fn rungs_of(&self, knob: Knob) -> impl DoubleEndedIterator<Item = &Rung> {
        self.rungs.iter().filter(move |rung| rung.row.knob == knob)
    }

    /// Returns the reference for the steps of the stepwise solver: the exact solution with the same
    /// number of springs.
    fn exact(&self) -> Option<&Solution> {
        self.rungs_of(Knob::GridSprings)
            .map(|rung| &rung.solution)
            .find(|solution| solution.points >= STEPWISE_SPRINGS)
    }

    /// Returns the two finest solutions with edges between springs, the finest one first.
    fn finest(&self) -> Option<[&Solution; 2]> {
        let mut rungs = self.rungs_of(Knob::SubCellSprings).rev();
        Some([&rungs.next()?.solution, &rungs.next()?.solution])
    }

    /// Computes the errors of all rows, relative to the closed form or the finest solution. The
    /// errors of steps are relative to the exact solution. `own` has the errors of the reference
    /// itself; if it is `None`, twice the differences between the two finest solutions are used
    /// instead. Returns false if there are fewer than two solutions.
    fn count(&mut self, own: Option<Errors>) -> bool {
        let Some([finest, last]) = self.finest() else {
            return false;
        };
        let mut errors = own.unwrap_or_else(|| {
            let differences = last.errors(finest);
            differences.map(|difference| difference.map(|difference| 2.0 * difference))
        });
        let reference = finest.reference();
        let closed_form = reference.closed_form.is_some();
        if closed_form {
            errors[Target::PullOffForce as usize] = Some(ROUNDING);
        }
        // With few springs, each spring causes a jump of the force. The curve may show a jump late
        // by one distance between points of the curve.
        let mut errors_of_exact: Errors = [None; 4];
        errors_of_exact[Target::Curve as usize] = Some(1.0 / compared_samples(self.scene) as f64);
        let mut rows: Vec<Row> = Vec::new();
        for knob in Knob::ALL {
            // The finest solution has no difference from itself, although its error is not zero.
            // The estimated error of the reference is therefore a lower limit.
            let (reference, floors) = match (knob, self.exact()) {
                (Knob::Step, Some(exact)) => (exact, errors_of_exact),
                _ => (&reference, errors),
            };
            for Rung { row, solution } in self.rungs_of(knob) {
                let coarser = rows.last().filter(|coarser| coarser.knob == knob);
                let errors = resolved(solution.errors(reference), floors, row.setting, coarser);
                rows.push(Row {
                    errors,
                    ..row.clone()
                });
            }
        }
        self.table.reference = CostReference {
            springs: reference.points,
            pull_off_force: reference.pull_off_force,
            closed_form,
            errors,
        };
        self.table.rows = rows;
        true
    }
}

/// Returns the errors of a setting and their orders of convergence relative to the coarser row. An
/// error that does not exceed the error of the reference is marked as not resolved.
fn resolved(
    errors: Errors,
    floors: Errors,
    setting: f64,
    coarser: Option<&Row>,
) -> [Option<ErrorFigure>; 4] {
    let mut figures = [None; 4];
    for (index, figure) in figures.iter_mut().enumerate() {
        let Some(error) = errors[index] else {
            continue;
        };
        let floor = floors[index].unwrap_or(0.0).max(ROUNDING);
        let resolved = error > floor;
        let mut order = None;
        if let Some(row) = coarser
            && let Some(coarse) = row.errors[index]
            && coarse.resolved
            && resolved
        {
            let ratio = (setting / row.setting).max(row.setting / setting);
            order = observed_order(coarse.error, error, ratio);
        }
        *figure = Some(ErrorFigure {
            error: error.max(floor),
            resolved,
            order,
        });
    }
    figures
}

/// Returns the observed order of convergence ln(coarse/fine)/ln(ratio) from two errors. The setting
/// of the second error is `ratio` times as fine as the setting of the first. Returns `None` if the
/// order is not a finite number.
fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// Measures the shortest time in s of one real Fourier transform of 2^20 points. The time to plan
/// the transform does not count.
fn time_of_transform() -> Option<f64> {
    let transform = plan_real_forward(TRANSFORM_POINTS);
    let mut points = transform.make_input_vec();
    let mut modes = transform.make_output_vec();
    let mut scratch = transform.make_scratch_vec();
    let mut shortest = None;
    // The first transform is not timed.
    for run in 0..=MOST_RUNS {
        for (index, point) in points.iter_mut().enumerate() {
            *point = (index % 17) as f64;
        }
        let begun = Instant::now();
        transform
            .process_with_scratch(&mut points, &mut modes, &mut scratch)
            .ok()?;
        let seconds = begun.elapsed().as_secs_f64();
        if run > 0 {
            shortest = Some(shortest.map_or(seconds, |shortest: f64| shortest.min(seconds)));
        }
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open::open;

    fn without_time(scene: &CheckedScene) -> String {
        let folder = Path::new("/");
        measure(scene, folder, Duration::ZERO, &|| false, &mut |_| ()).unwrap_err()
    }

    /// The error names a file that cannot be read, even if a busy machine leaves no time of the
    /// budget.
    #[test]
    fn a_file_that_cannot_be_read_is_named_without_any_time() {
        let smooth = open("jkr-sphere").unwrap();
        let message = without_time(smooth.scene());
        assert!(
            message.starts_with("the budget of 0 s is spent"),
            "{message}"
        );
        for file in ["/dev/zero", "/dev", "/no-such-file.csv"] {
            let roughness = format!("Measured(file: \"{file}\")");
            let scene = smooth.set("roughness", &roughness).unwrap();
            let message = without_time(scene.scene());
            assert!(message.contains(file), "{message}");
            assert!(!message.contains("budget"), "{message}");
        }
    }
}
