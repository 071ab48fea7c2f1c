//! Computation of the random profiles of a plan on several threads. The results do not depend on
//! the number of threads.

use super::error::StudyError;
use super::plan::Plan;
use asperity_data::{on_this_thread, on_threads};
use asperity_scene::{RunError, Simulation};
use std::panic::resume_unwind;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::Builder;

/// Function that a computation calls repeatedly. Once the function returns true, the computation
/// ends.
pub type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// Solves profiles of a plan, given by their indices, on at most `jobs` threads, or on fewer if the
/// memory does not suffice. Each thread has its own simulation, and the first thread uses this
/// simulation. `receive` gets each result with the index of its profile, on this thread, as soon as
/// the result is known.
///
/// # Errors
/// A profile fails. The error belongs to the first of the profiles that fail.
pub(super) fn on_profiles<R: Send>(
    plan: &Plan,
    lines: &[u64],
    (simulation, jobs): (Simulation, usize),
    solve: impl Fn(&mut Simulation, u64) -> Result<R, RunError> + Sync,
    receive: &mut dyn FnMut(u64, R),
) -> Result<(), StudyError> {
    let most = jobs.clamp(1, lines.len().max(1));
    let jobs = (2..=most)
        .rev()
        .find(|jobs| plan.memory(*jobs as u64).is_ok())
        .unwrap_or(1);
    let solved = |simulation: &mut Simulation, line| {
        solve(simulation, line).map_err(|error| {
            let place = if plan.lines > 1 {
                format!("seed {}: ", plan.seed_of(line))
            } else {
                String::new()
            };
            StudyError::Run { place, error }
        })
    };
    if jobs == 1 {
        let mut simulation = simulation;
        let mut each = |line| solved(&mut simulation, line).map(|solved| receive(line, solved));
        return on_this_thread(|| lines.iter().try_for_each(|line| each(*line)));
    }
    let mut simulations: Vec<Simulation> = (1..jobs).map(|_| simulation.another()).collect();
    simulations.push(simulation);
    let simulations = Mutex::new(simulations);
    let worker = |sender: Sender<(u64, R)>| {
        let own = simulations
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop();
        let (mut simulation, solved) = (own.unwrap_or_default(), &solved);
        move |number: u64| {
            let line = lines[number as usize];
            // The receiver lives until all threads have ended.
            let _ = sender.send((line, solved(&mut simulation, line)?));
            Ok(())
        }
    };
    let count = lines.len() as u64;
    on_threads_received(count, jobs, worker, &mut |(line, solved)| {
        receive(line, solved)
    })
    .map(drop)
}

/// Returns results for the numbers below `count`, computed on `jobs` threads, each with its own
/// `worker`. `receive` gets what the workers send, on this thread, as soon as it is sent.
///
/// # Errors
/// A number fails. The error belongs to the smallest number that fails.
pub(super) fn on_threads_received<M: Send, R: Send, W: FnMut(u64) -> Result<R, StudyError>>(
    count: u64,
    jobs: usize,
    worker: impl Fn(Sender<M>) -> W + Sync,
    receive: &mut dyn FnMut(M),
) -> Result<Vec<R>, StudyError> {
    let (sender, receiver) = channel();
    let worker = &worker;
    std::thread::scope(|scope| {
        let work = move || on_threads(count, jobs, || worker(sender.clone()));
        let threads = Builder::new()
            .spawn_scoped(scope, work)
            .map_err(StudyError::NoThread)?;
        receiver.iter().for_each(receive);
        threads.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}
