//! Number of threads, stop and progress of a long computation.

use crate::parallel;
use std::borrow::Borrow;

/// Settings of a long computation: the number of threads, a function that stops it, and a
/// function that receives its progress. With the default settings, the computation uses all cores,
/// is never stopped and reports no progress.
///
/// `P` is the type of the progress, such as the number of finished parts or the result so far.
///
/// ```
/// use asperity_data::Control;
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// let stopped = AtomicBool::new(false);
/// let stop = || stopped.load(Ordering::Relaxed);
/// let mut last = 0;
/// let mut report = |done: &u64| last = *done;
/// let mut control = Control::default().on_threads(2).stopped_by(&stop).reporting_to(&mut report);
/// control.report(7);
/// assert!(!control.is_stopped() && control.threads() == 2);
/// assert_eq!(last, 7);
/// ```
pub struct Control<'a, P = u64> {
    threads: usize,
    stop: &'a (dyn Fn() -> bool + Sync),
    report: Option<&'a mut (dyn FnMut(&P) + 'a)>,
}

impl<P> Default for Control<'_, P> {
    fn default() -> Self {
        Control {
            threads: parallel::threads(),
            stop: &|| false,
            report: None,
        }
    }
}

impl<'a, P> Control<'a, P> {
    /// Sets the number of threads, at least 1. The number of threads does not change a single bit
    /// of the result.
    #[must_use]
    pub fn on_threads(self, threads: usize) -> Self {
        Control { threads, ..self }
    }

    /// Sets the function that stops the computation. Soon after `stop` returns true, the
    /// computation ends with an error.
    #[must_use]
    pub fn stopped_by(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Control { stop, ..self }
    }

    /// Sets the function that receives the progress. It is called on the thread that started the
    /// computation.
    #[must_use]
    pub fn reporting_to(self, report: &'a mut (dyn FnMut(&P) + 'a)) -> Self {
        Control {
            report: Some(report),
            ..self
        }
    }

    /// Returns settings for a part of this computation. The part has the same number of threads and
    /// the same stop function, but its progress may have another type. At first, no function
    /// receives the progress of the part.
    pub fn of_part<'part, Q>(&self) -> Control<'part, Q>
    where
        'a: 'part,
    {
        Control {
            threads: self.threads,
            stop: self.stop,
            report: None,
        }
    }

    /// Returns the number of threads on which the computation runs.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Returns the stop function: as soon as this function returns true, the computation has to
    /// stop.
    pub fn stop(&self) -> &'a (dyn Fn() -> bool + Sync) {
        self.stop
    }

    /// Returns true if the function set by [`stopped_by`](Control::stopped_by) returns true now.
    pub fn is_stopped(&self) -> bool {
        (self.stop)()
    }

    /// Reports the progress, given as a value or a reference, to the function set by
    /// [`reporting_to`](Control::reporting_to). Does nothing if no such function is set.
    pub fn report(&mut self, progress: impl Borrow<P>) {
        if let Some(report) = &mut self.report {
            report(progress.borrow());
        }
    }
}
