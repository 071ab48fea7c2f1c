//! Runs independent computations on several threads. No result depends on the number of threads.

use std::cell::Cell;
use std::io;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, Scope, ScopedJoinHandle, scope};

thread_local! {
    /// True on a thread that works together with others. New threads would be of no use there,
    /// because these threads already keep all cores busy.
    static ONE_OF_MANY: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` on the present thread. If `work` calls functions of this module, these functions
/// start no further threads.
pub fn on_this_thread<A>(work: impl FnOnce() -> A) -> A {
    let before = ONE_OF_MANY.replace(true);
    let result = work();
    ONE_OF_MANY.set(before);
    result
}

/// Runs `work` on each of `count` new threads. The threads end with `scope`, a scope of the
/// standard library. If the system refuses some threads, `work` runs on fewer threads. Inside
/// `work`, the functions of this module start no further threads.
///
/// # Errors
/// Returns the error of the system if `count` is at least 1 and no thread could be started.
pub(crate) fn begin_threads<'scope>(
    scope: &'scope Scope<'scope, '_>,
    count: usize,
    work: impl FnOnce() + Clone + Send + 'scope,
) -> io::Result<()> {
    let mut is_begun = false;
    let mut first_error = None;
    for _ in 0..count {
        let work = work.clone();
        match Builder::new().spawn_scoped(scope, || on_this_thread(work)) {
            Ok(_) => is_begun = true,
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    match first_error {
        Some(error) if !is_begun => Err(error),
        _ => Ok(()),
    }
}

/// Computes a result for each number from 0 to `count` − 1 on `jobs` threads, and returns the
/// results in the order of the numbers. Each thread calls `worker` once. The function that `worker`
/// returns then computes the results of the thread.
///
/// # Errors
/// Returns an error if the computation of a result returns an error. If there are several errors,
/// returns the error for the smallest number.
///
/// ```
/// use asperity_data::on_threads;
///
/// let squares = on_threads(5, 2, || |number: u64| Ok::<u64, String>(number * number))?;
/// assert_eq!(squares, [0, 1, 4, 9, 16]);
/// # Ok::<(), String>(())
/// ```
pub fn on_threads<R: Send, E: Send, W: FnMut(u64) -> Result<R, E>>(
    count: u64,
    jobs: usize,
    worker: impl Fn() -> W + Sync,
) -> Result<Vec<R>, E> {
    let next = AtomicU64::new(0);
    let found = Mutex::new(Vec::new());
    let work = &|| {
        let mut worker = worker();
        loop {
            let number = next.fetch_add(1, Ordering::SeqCst);
            if number >= count {
                return;
            }
            let result = worker(number);
            if result.is_err() {
                // After an error, results for higher numbers are no longer needed. Results for
                // lower numbers are already computed, or are being computed.
                next.store(count, Ordering::SeqCst);
            }
            found
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push((number, result));
        }
    };
    let threads = jobs.min(usize::try_from(count).unwrap_or(usize::MAX));
    scope(|scope| {
        // If no further thread can be started, this thread does all the work.
        let _ = begin_threads(scope, threads.saturating_sub(1), work);
        on_this_thread(work);
    });
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, result)| result).collect()
}

/// Returns the number of threads for a computation: the number of cores of the processor. The
/// number is 1 inside [`on_this_thread`] and on threads that this module has started.
pub fn threads() -> usize {
    if ONE_OF_MANY.get() {
        return 1;
    }
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Runs the functions `first` and `second`, and returns their results. If `is_worth` is true, a
/// second thread runs `first` while the present thread runs `second`. If `is_worth` is false, or if
/// no second thread can be started, the present thread runs both functions, one after the other.
pub fn in_parallel<A: Send, B>(
    is_worth: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B,
) -> (A, B) {
    if !is_worth || ONE_OF_MANY.get() {
        return (first(), second());
    }
    let task = Mutex::new(Some(first));
    let take = || task.lock().unwrap_or_else(PoisonError::into_inner).take();
    scope(|scope| {
        let thread = Builder::new()
            .spawn_scoped(scope, || take().map(|task| task()))
            .ok();
        let second_result = second();
        // If the second thread has not begun `first` yet, or could not be started, the present
        // thread runs `first`.
        if let Some(task) = take() {
            return (task(), second_result);
        }
        match thread.map(ScopedJoinHandle::join) {
            Some(Ok(Some(first_result))) => (first_result, second_result),
            Some(Err(panic)) => resume_unwind(panic),
            Some(Ok(None)) | None => {
                unreachable!("a task that is gone has been taken by its thread")
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread::current;
    use std::time::{Duration, Instant};

    #[test]
    fn both_are_done_once() {
        for worth in [false, true] {
            let mut sum = 0;
            let mut calls = 0;
            let results = in_parallel(worth, || (0..1000).for_each(|k| sum += k), || calls += 1);
            assert_eq!((results, sum, calls), (((), ()), 499_500, 1));
        }
    }

    #[test]
    fn one_of_many_threads_stays_alone() {
        let on_two_threads = || {
            let begun = AtomicBool::new(false);
            let first = || {
                begun.store(true, Ordering::SeqCst);
                current().id()
            };
            let second = || {
                // The second function waits until the first one has begun, because otherwise this
                // thread could run both functions before the second thread starts.
                let clock = Instant::now();
                while !begun.load(Ordering::SeqCst) && clock.elapsed() < Duration::from_secs(30) {
                    std::thread::yield_now();
                }
                current().id()
            };
            let (first, second) = in_parallel(true, first, second);
            first != second
        };
        assert_eq!(
            (
                on_two_threads(),
                on_this_thread(on_two_threads),
                on_two_threads()
            ),
            (true, false, true)
        );
    }

    #[test]
    fn a_panic_comes_through() {
        for worth in [false, true] {
            let result = std::panic::catch_unwind(|| in_parallel(worth, || panic!("one"), || ()));
            assert_eq!(result.unwrap_err().downcast_ref::<&str>(), Some(&"one"));
        }
    }
}
