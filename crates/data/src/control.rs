//! Threads, stop and progress of a long computation.

use crate::parallel;

/// Threads, stop and progress of a long computation. By default it takes all cores, never stops early and reports nothing.
///
/// ```
/// use asperity_data::Control;
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// let (stopped, mut last) = (AtomicBool::new(false), 0);
/// let (stop, mut report) = (|| stopped.load(Ordering::Relaxed), |done| last = done);
/// let mut control = Control::default().on_threads(2).stopped_by(&stop).reporting_to(&mut report);
/// control.report(7);
/// assert!(!control.is_stopped() && control.threads() == 2);
/// assert_eq!(last, 7);
/// ```
pub struct Control<'a> {
    threads: usize,
    stop: &'a (dyn Fn() -> bool + Sync),
    report: Option<&'a mut (dyn FnMut(u64) + 'a)>,
}

impl Default for Control<'_> {
    fn default() -> Self {
        Control { threads: parallel::threads(), stop: &|| false, report: None }
    }
}

impl<'a> Control<'a> {
    /// Computes on this number of threads. No bit of a result depends on it; computations refuse 0.
    #[must_use]
    pub fn on_threads(self, threads: usize) -> Self {
        Control { threads, ..self }
    }

    /// Ends the computation with an error as soon as `stop` returns true.
    #[must_use]
    pub fn stopped_by(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Control { stop, ..self }
    }

    /// Passes to `report`, on the calling thread, how much is done so far, in the unit that the computation names: profiles,
    /// records or curves.
    #[must_use]
    pub fn reporting_to(self, report: &'a mut (dyn FnMut(u64) + 'a)) -> Self {
        Control { report: Some(report), ..self }
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Function that returns true once the computation is to end.
    pub fn stop(&self) -> &'a (dyn Fn() -> bool + Sync) {
        self.stop
    }

    /// Returns true once the computation is to end.
    pub fn is_stopped(&self) -> bool {
        (self.stop)()
    }

    /// Reports how much is done so far.
    pub fn report(&mut self, done: u64) {
        if let Some(report) = &mut self.report {
            report(done);
        }
    }
}
