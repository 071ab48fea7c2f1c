//! Two computations side by side. Neither sees the other, so what they give does not depend on whether they
//! run at the same time.

use std::cell::Cell;
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, Scope, ScopedJoinHandle, scope};

thread_local! {
    /// True if this thread is one of as many as there are cores.
    static ONE_OF_MANY: Cell<bool> = const { Cell::new(false) };
}

/// Does `work` on this thread alone, one thing after the other: for one of many threads that keep all cores busy.
pub(crate) fn on_this_thread<A>(work: impl FnOnce() -> A) -> A {
    let before = ONE_OF_MANY.replace(true);
    let result = work();
    ONE_OF_MANY.set(before);
    result
}

/// Begins `work` on so many threads of a scope, each of which stays alone. Returns the number of threads that the system
/// gave.
pub(crate) fn begin_threads<'scope>(
    scope: &'scope Scope<'scope, '_>,
    count: usize,
    work: impl FnOnce() + Clone + Send + 'scope,
) -> usize {
    let begin = || {
        let work = work.clone();
        Builder::new().spawn_scoped(scope, || on_this_thread(work)).is_ok()
    };
    (0..count).filter(|_| begin()).count()
}

/// Does both, the first on a thread of its own if that is `worth` it and the system gives one.
pub(crate) fn in_parallel<A: Send, B>(
    worth: bool,
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B,
) -> (A, B) {
    if !worth || ONE_OF_MANY.get() {
        return (one(), other());
    }
    scope(|scope| {
        let one = Beside::begin(scope, true, one);
        let other = other();
        (one.finish(), other)
    })
}

/// A computation that another thread may do until its result is asked for.
pub(crate) struct Beside<'scope, A, F> {
    /// Task, until one of the threads takes it.
    task: Task<F>,
    thread: Option<ScopedJoinHandle<'scope, Option<A>>>,
}

/// Whichever thread takes it does it.
struct Task<F>(Arc<Mutex<Option<F>>>);

impl<F> Task<F> {
    fn take(&self) -> Option<F> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl<'scope, A: Send + 'scope, F: FnOnce() -> A + Send + 'scope> Beside<'scope, A, F> {
    /// Begins `task` on a thread of its own if that is `worth` it and the system gives one.
    pub fn begin(scope: &'scope Scope<'scope, '_>, worth: bool, task: F) -> Self {
        let task = Arc::new(Mutex::new(Some(task)));
        let aside = Task(Arc::clone(&task));
        let begin = || Builder::new().spawn_scoped(scope, move || aside.take().map(|task| task())).ok();
        let worth = worth && !ONE_OF_MANY.get();
        Beside { thread: worth.then(begin).flatten(), task: Task(task) }
    }

    /// Its result; does here what no other thread has begun.
    pub fn finish(self) -> A {
        if let Some(task) = self.task.take() {
            return task();
        }
        match self.thread.map(ScopedJoinHandle::join) {
            Some(Ok(Some(result))) => result,
            Some(Err(panic)) => resume_unwind(panic),
            Some(Ok(None)) | None => unreachable!("a task that is gone has been taken by its thread"),
        }
    }
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
            let (mut one, mut other) = (0, 0);
            let results = in_parallel(worth, || (0..1000).for_each(|k| one += k), || other += 1);
            assert_eq!((results, one, other), (((), ()), 499_500, 1));
        }
    }

    #[test]
    fn one_of_many_threads_stays_alone() {
        let on_two_threads = || {
            let begun = AtomicBool::new(false);
            let one = || {
                begun.store(true, Ordering::SeqCst);
                current().id()
            };
            let other = || {
                // Else this thread may do both before the other is there.
                let clock = Instant::now();
                while !begun.load(Ordering::SeqCst) && clock.elapsed() < Duration::from_secs(30) {
                    std::thread::yield_now();
                }
                current().id()
            };
            let (one, other) = in_parallel(true, one, other);
            one != other
        };
        assert_eq!((on_two_threads(), on_this_thread(on_two_threads), on_two_threads()), (true, false, true));
    }

    #[test]
    fn a_panic_comes_through() {
        for worth in [false, true] {
            let result = std::panic::catch_unwind(|| in_parallel(worth, || panic!("one"), || ()));
            assert_eq!(result.unwrap_err().downcast_ref::<&str>(), Some(&"one"));
        }
    }
}
