//! Computation of a plan on several threads, and of a whole plan in memory. The results do not
//! depend on the number of threads.

use super::cells::{Cells, Streak};
use super::error::StudyError;
use super::measured::profile;
use super::part::StudyPart;
use super::plan::Plan;
use super::recorder::{Recorded, Recorder};
use super::results::Results;
use asperity_contact::ContactError;
use asperity_data::{Control, Warning, on_threads};
use asperity_scene::{RunError, Simulation};
use asperity_surface::lines::MeasuredRoughness;
use std::ops::Range;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::thread::Builder;

/// Results of a computed streak. A streak consists of all cells that differ only in the preload,
/// and is computed with a single loading.
pub(super) struct SolvedStreak {
    pub streak: Streak,
    pub records: Vec<Recorded>,
    /// Warnings of the streak, one for each cell that does not meet all premises of the model. Each
    /// has the number of the cell and the premises that the cell does not meet.
    pub warnings: Vec<(u64, Vec<Warning>)>,
}

/// Streaks of a plan, with the data that are needed to compute the missing streaks. A streak
/// consists of all cells that differ only in the preload.
pub(super) struct Streaks<'a> {
    pub cells: &'a Cells<'a>,
    /// Numbers of the units that are to be computed. A unit is a part of the plan that one thread
    /// computes, on one random profile.
    pub units: &'a [u64],
    /// Function that returns true if at least one record of a streak is missing. The streak is
    /// computed only in this case. A streak consists of all cells that differ only in the preload.
    pub is_missing: &'a (dyn Fn(&Streak) -> bool + Sync),
    /// Measured roughness of the plan; `None` if its roughness is not measured. The files are read
    /// once, so that all threads compute from the same bytes.
    pub profile: Option<&'a Arc<MeasuredRoughness>>,
}

impl Streaks<'_> {
    /// Computes the missing streaks on `threads` threads. A streak consists of all cells that
    /// differ only in the preload, on one profile. `receive` is called with each computed streak,
    /// on the thread that computed the streak. The computation ends early if `stop` returns true
    /// after a streak, or if `receive` returns false.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice for a record.
    pub fn compute(
        &self,
        plan: &Plan,
        threads: usize,
        stop: &(dyn Fn() -> bool + Sync),
        receive: &(dyn Fn(SolvedStreak) -> bool + Sync),
    ) -> Result<(), StudyError> {
        let ended = &AtomicBool::new(false);
        let worker = || {
            let simulation = Simulation::new(PathBuf::new());
            let simulation = match self.profile {
                Some(profile) => simulation.with_measured(Arc::clone(profile)),
                None => simulation,
            };
            let mut recorder = Recorder::new(plan, simulation, &|| false);
            move |number: u64| -> Result<(), StudyError> {
                for streak in self.cells.streaks(self.units[number as usize]) {
                    if !(self.is_missing)(&streak) {
                        continue;
                    }
                    if stop() || ended.load(Ordering::SeqCst) {
                        break;
                    }
                    let records = recorder.record_each(&streak).map_err(|error| {
                        ended.store(true, Ordering::SeqCst);
                        let cell = streak.cells.start;
                        let seed = plan.seed_of(streak.line);
                        let place =
                            format!("cell {cell} ({}), seed {seed}: ", plan.coordinates(cell));
                        StudyError::at(place, error)
                    })?;
                    let warnings = recorder.take_warnings();
                    let solved = SolvedStreak {
                        streak,
                        records,
                        warnings,
                    };
                    ended.fetch_or(!receive(solved), Ordering::SeqCst);
                }
                Ok(())
            }
        };
        on_threads(self.units.len() as u64, threads, worker).map(drop)
    }
}

/// Computes a plan in memory. The recorded quantities are computed for each combination of values
/// on the axes, a [cell](Plan), on each random profile. If a cell cannot be computed on a profile,
/// [`Results::failed`] has the reason. `control` reports how many pairs of a cell and a profile are
/// computed.
///
/// # Errors
/// Returns an error if a measured file cannot be read, if the memory does not suffice, or if
/// `control` stops the computation. It is also an error if `control` allows zero threads, or if the
/// system cannot start a thread.
///
/// ```
/// use asperity_data::Control;
/// use asperity_study::{Plan, Quantity, compute};
///
/// let scene = asperity_scene::open("pressure-sensitive")?.set("numerics.points", "1024")?;
/// let plan = Plan::new(
///     &scene,
///     &[("adhesion.kappa", &[1.0, 8.0, 40.0])],
///     4,
///     &[Quantity::AdhesionShare],
/// )?;
/// let results = compute(&plan, Control::default())?;
/// let median = |cell| {
///     results
///         .statistics(cell, Quantity::AdhesionShare)
///         .map(|one| one.quartiles[1])
/// };
/// assert!(median(0) > median(1) && median(1) > median(2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compute(plan: &Plan, control: Control<'_>) -> Result<Results, StudyError> {
    check(plan, &control)?;
    let measured = profile(plan, Path::new(""))?;
    compute_on(plan, measured, control)
}

/// Computes a plan in memory, as [`compute`] does, but with a measured roughness that the caller
/// provides. This roughness replaces the measured files that the scene names.
///
/// # Errors
/// Returns the same errors as [`compute`]. It is also an error if an axis varies an option for
/// reading files, such as `roughness.row`, because a measured roughness in memory has no such
/// option.
pub fn compute_with_measured(
    plan: &Plan,
    measured: Arc<MeasuredRoughness>,
    control: Control<'_>,
) -> Result<Results, StudyError> {
    check(plan, &control)?;
    check_axes_in_memory(plan)?;
    compute_on(plan, Some(measured), control)
}

/// Returns an error if an axis varies a field of the roughness, which has no files to be read
/// again.
fn check_axes_in_memory(plan: &Plan) -> Result<(), StudyError> {
    for axis in &plan.axes {
        if axis.path.starts_with("roughness.") {
            let found = format!("an axis {} of a surface in memory", axis.path);
            let allowed = "axes of other fields, or a surface in a file";
            return Err(StudyError::refused(None, found, allowed));
        }
    }
    Ok(())
}

/// Returns an error if the threads or the memory do not suffice.
fn check(plan: &Plan, control: &Control<'_>) -> Result<(), StudyError> {
    let threads = control.threads();
    StudyError::check_threads(threads)?;
    plan.memory(threads as u64)?;
    Ok(())
}

/// Computes a plan in memory. `measured` is the measured roughness of the plan, if it has one.
fn compute_on(
    plan: &Plan,
    measured: Option<Arc<MeasuredRoughness>>,
    control: Control<'_>,
) -> Result<Results, StudyError> {
    let mut results = Results::empty(plan.clone())?;
    compute_profiles(plan, measured, 0..plan.lines, control, &mut |solved| {
        for (cell, record) in solved.streak.cells.zip(solved.records) {
            results.set_record(cell * plan.lines + solved.streak.line, record);
        }
        results.set_warnings(solved.streak.line, solved.warnings);
    })?;
    Ok(results)
}

/// Computes some of the random profiles of a plan, for another process that gathers the parts by
/// [`Results::of_parts`]. `lines` are the indices of the profiles. `measured` is the measured
/// roughness of the plan, if it has one that only exists in memory.
///
/// # Errors
/// Returns the same errors as [`compute`] and [`compute_with_measured`].
///
/// ```
/// use asperity_data::Control;
/// use asperity_study::{Plan, Quantity, Results, compute, compute_part};
///
/// let scene = asperity_scene::open("pressure-sensitive")?.set("numerics.points", "1024")?;
/// let plan = Plan::new(&scene, &[], 5, &[Quantity::PullOffForce])?;
/// let parts = [
///     compute_part(&plan, None, 0..3, Control::default())?,
///     compute_part(&plan, None, 3..5, Control::default())?,
/// ];
/// assert_eq!(Results::of_parts(&plan, parts)?, compute(&plan, Control::default())?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compute_part(
    plan: &Plan,
    measured: Option<Arc<MeasuredRoughness>>,
    lines: Range<u64>,
    control: Control<'_>,
) -> Result<StudyPart, StudyError> {
    check(plan, &control)?;
    let measured = match measured {
        Some(measured) => {
            check_axes_in_memory(plan)?;
            Some(measured)
        }
        None => profile(plan, Path::new(""))?,
    };
    let mut part = StudyPart::default();
    compute_profiles(plan, measured, lines, control, &mut |solved| {
        for (cell, record) in solved.streak.cells.zip(solved.records) {
            part.records.push((cell, solved.streak.line, record));
        }
        for (cell, warnings) in solved.warnings {
            part.warnings.push((cell, solved.streak.line, warnings));
        }
    })?;
    Ok(part)
}

/// Computes the profiles `lines` of a plan. `receive` is called on the calling thread with each
/// streak, which has the cells that differ only in the preload.
fn compute_profiles(
    plan: &Plan,
    measured: Option<Arc<MeasuredRoughness>>,
    lines: Range<u64>,
    mut control: Control<'_>,
    receive: &mut dyn FnMut(SolvedStreak),
) -> Result<(), StudyError> {
    let threads = control.threads();
    let stop = control.stop();
    let cells = Cells::of(plan);
    let units: Vec<u64> = (0..cells.units()).collect();
    let streaks = Streaks {
        cells: &cells,
        units: &units,
        is_missing: &|streak| lines.contains(&streak.line),
        profile: measured.as_ref(),
    };
    let (sender, receiver) = channel();
    let work = move || {
        // Sending fails only if the receiver has been dropped. The value false then ends the
        // computation.
        let send = move |solved| sender.send(solved).is_ok();
        streaks.compute(plan, threads, stop, &send)
    };
    let mut done = 0;
    std::thread::scope(|scope| {
        let computing = Builder::new()
            .spawn_scoped(scope, work)
            .map_err(StudyError::NoThread)?;
        for solved in receiver.iter() {
            done += solved.records.len() as u64;
            receive(solved);
            control.report(done);
        }
        computing
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))
    })?;
    if done < plan.cells() * (lines.end - lines.start) {
        return Err(RunError::from(ContactError::Interrupted).into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Quantity;
    use asperity_scene::open;

    fn plan() -> Plan {
        let document = open("pressure-sensitive")
            .unwrap()
            .set("numerics.points", "1024")
            .unwrap();
        let axes: [(&str, &[f64]); 2] = [
            ("roughness.hurst", &[0.3, 0.7]),
            ("preload", &[0.01, 0.1, 1e9]),
        ];
        Plan::new(
            &document,
            &axes,
            3,
            &[Quantity::PullOffForce, Quantity::Regime],
        )
        .unwrap()
    }

    /// Each record equals that of a separate computation. For a record that cannot be computed the
    /// reason is kept.
    #[test]
    fn a_plan_in_memory_has_the_records_of_single_cells() {
        let plan = plan();
        let mut parts = Vec::new();
        let mut see = |done: &u64| parts.push(*done);
        let found = compute(
            &plan,
            Control::default().on_threads(3).reporting_to(&mut see),
        )
        .unwrap();
        assert_eq!(
            compute(&plan, Control::default().on_threads(1)).unwrap(),
            found
        );
        assert_eq!(parts, [3, 6, 9, 12, 15, 18]);
        for (cell, line) in
            (0..plan.cells()).flat_map(|cell| (0..plan.lines).map(move |line| (cell, line)))
        {
            let mut recorder = Recorder::new(&plan, Simulation::default(), &|| false);
            let one = &recorder
                .record_each(&Streak {
                    cells: cell..cell + 1,
                    line,
                })
                .unwrap()[0];
            let values = plan
                .record
                .iter()
                .map(|quantity| found.value(cell, line, *quantity));
            let expected = plan.record.iter().enumerate().map(|(index, _)| {
                one.as_ref()
                    .ok()
                    .map(|values| values[index])
                    .filter(|value| !value.is_nan())
            });
            assert!(values.eq(expected), "{cell} {line}: {one:?}");
        }
        assert_eq!(found.failed().count(), 6);
    }

    #[test]
    fn a_plan_that_is_stopped_or_without_threads_is_an_error() {
        let plan = plan();
        let stopped = compute(&plan, Control::default().stopped_by(&|| true)).unwrap_err();
        assert!(stopped.is_interruption(), "{stopped}");
        let none = compute(&plan, Control::default().on_threads(0)).unwrap_err();
        assert_eq!(none.to_string(), "0 threads; allowed: at least one");
        let document = open("pressure-sensitive").unwrap();
        for (path, values, said) in [
            (
                "roughness.hurts",
                &[0.3][..],
                "did you mean roughness.hurst?",
            ),
            ("roughness.hurst", &[], "no values; allowed: at least one"),
            ("roughness.hurst", &[f64::NAN], "values must be finite"),
            ("roughness.hurst", &[1.5], "allowed: "),
        ] {
            let error =
                Plan::new(&document, &[(path, values)], 2, &[Quantity::Regime]).unwrap_err();
            assert!(error.to_string().contains(said), "{path}: {error}");
        }
    }
}
