//! Computation of the random profiles of a plan on several threads. The results do not depend on
//! the number of threads.

use super::error::StudyError;
use super::plan::Plan;
use asperity_contact::ContactError;
use asperity_data::{on_this_thread, on_threads};
use asperity_scene::{RunError, Simulation};
use std::panic::resume_unwind;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::Builder;

/// Function that a computation calls again and again. The computation ends as soon as the function
/// returns true.
pub(super) type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// Solves profiles of a plan, given by their indices, on at most `threads` threads, or on fewer if
/// the memory does not suffice. One thread uses the simulation of the caller, and each further
/// thread a new simulation of the same files. `receive` is called on the calling thread with each
/// result and the index of its profile, as soon as the result is known.
///
/// # Errors
/// Returns the error of the first profile that cannot be solved, in the order of `lines`.
pub(super) fn on_profiles<R: Send>(
    plan: &Plan,
    lines: &[u64],
    simulation: &mut Simulation,
    threads: usize,
    solve: impl Fn(&mut Simulation, u64) -> Result<R, RunError> + Sync,
    receive: &mut dyn FnMut(u64, R),
) -> Result<(), StudyError> {
    let threads = threads_within_memory(plan, threads.clamp(1, lines.len().max(1)));
    let solve_line = |simulation: &mut Simulation, line: u64| {
        solve(simulation, line).map_err(|error| failed_profile(plan, line, error))
    };
    if threads == 1 {
        return on_this_thread(|| {
            for &line in lines {
                receive(line, solve_line(simulation, line)?);
            }
            Ok(())
        });
    }
    let mut further: Vec<Simulation> = (1..threads).map(|_| simulation.another()).collect();
    let mut unused: Vec<&mut Simulation> = further.iter_mut().collect();
    unused.push(simulation);
    let unused = Mutex::new(unused);
    let worker = |sender: Sender<(u64, R)>| {
        let mut own = unused.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let solve_line = &solve_line;
        move |number: u64| {
            let line = lines[number as usize];
            let simulation = own.as_deref_mut().ok_or_else(no_simulation)?;
            let solved = solve_line(simulation, line)?;
            // Sending cannot fail, because the receiver exists until all threads have ended.
            let _ = sender.send((line, solved));
            Ok(())
        }
    };
    let count = lines.len() as u64;
    on_threads_received(count, threads, worker, &mut |(line, solved)| {
        receive(line, solved);
    })?;
    Ok(())
}

/// Returns the largest number of threads, at most `most`, for which the memory suffices; 1 if the
/// memory does not even suffice for one thread.
fn threads_within_memory(plan: &Plan, most: usize) -> usize {
    (2..=most)
        .rev()
        .find(|threads| plan.memory(*threads as u64).is_ok())
        .unwrap_or(1)
}

fn failed_profile(plan: &Plan, line: u64, error: RunError) -> StudyError {
    let mut place = String::new();
    if plan.lines > 1 {
        place = format!("seed {}: ", plan.seed_of(line));
    }
    StudyError::at(place, error)
}

fn no_simulation() -> StudyError {
    RunError::from(ContactError::Internal(
        "there are more threads than simulations",
    ))
    .into()
}

/// Calls a worker for each number below `count`, and returns the results. Each of the `threads`
/// threads has its own worker. Workers can send messages; `receive` is called on the calling thread
/// with each message as soon as it is sent.
///
/// # Errors
/// Returns the error of the smallest number for which a worker fails.
pub(super) fn on_threads_received<M: Send, R: Send, W: FnMut(u64) -> Result<R, StudyError>>(
    count: u64,
    threads: usize,
    worker: impl Fn(Sender<M>) -> W + Sync,
    receive: &mut dyn FnMut(M),
) -> Result<Vec<R>, StudyError> {
    let (sender, receiver) = channel();
    let worker = &worker;
    std::thread::scope(|scope| {
        let work = move || on_threads(count, threads, || worker(sender.clone()));
        let computing = Builder::new()
            .spawn_scoped(scope, work)
            .map_err(StudyError::NoThread)?;
        receiver.iter().for_each(receive);
        computing
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))
    })
}
