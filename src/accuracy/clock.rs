//! Time: a budget, repeated runs, and the unit of time.

use super::Timing;
use realfft::RealFftPlanner;
use std::time::{Duration, Instant};

/// Points of the transform that is the unit of time.
const TRANSFORM_POINTS: usize = 1 << 20;
/// Most runs of one setting.
const MOST_RUNS: usize = 9;
/// Largest share of a budget for the runs of one setting.
const SHARE_OF_RUNS: f64 = 0.02;

/// A limit of time, which can be ended early.
#[derive(Clone, Copy)]
pub(super) struct Budget<'a> {
    begun: Instant,
    seconds: f64,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> Budget<'a> {
    pub(super) fn begin(budget: Duration, stop: &'a dyn Fn() -> bool) -> Self {
        Budget { begun: Instant::now(), seconds: budget.as_secs_f64(), stop }
    }

    /// Returns true if the budget was ended early.
    pub(super) fn is_stopped(&self) -> bool {
        (self.stop)()
    }

    /// The whole budget, s.
    pub(super) fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Seconds since the beginning.
    pub(super) fn spent(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Seconds until this share of the budget has passed; negative afterwards, and once the budget is stopped.
    pub(super) fn left_of(&self, share: f64) -> f64 {
        if self.is_stopped() { f64::NEG_INFINITY } else { share * self.seconds - self.spent() }
    }

    /// Returns true if the budget is over.
    pub(super) fn is_over(&self) -> bool {
        self.left_of(1.0) <= 0.0
    }

    /// Runs a function a few times, at least once, and returns the times of the runs; `None` for a run that does
    /// not end.
    pub(super) fn time(&self, mut run: impl FnMut() -> bool) -> Option<Timing> {
        let (began, mut seconds) = (Instant::now(), Vec::new());
        while seconds.len() < MOST_RUNS
            && (seconds.is_empty()
                || (began.elapsed().as_secs_f64() < SHARE_OF_RUNS * self.seconds && !self.is_over()))
        {
            let clock = Instant::now();
            if !run() {
                break;
            }
            seconds.push(clock.elapsed().as_secs_f64());
        }
        Timing::of(seconds)
    }

    /// The shortest time of one real Fourier transform of 2^20 points, planned beforehand, s.
    pub(super) fn of_one_transform(&self) -> Option<f64> {
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(TRANSFORM_POINTS);
        let mut points = transform.make_input_vec();
        let (mut modes, mut scratch) = (transform.make_output_vec(), transform.make_scratch_vec());
        let mut run = || {
            for (index, point) in points.iter_mut().enumerate() {
                *point = (index % 17) as f64;
            }
            let clock = Instant::now();
            transform.process_with_scratch(&mut points, &mut modes, &mut scratch).ok()?;
            Some(clock.elapsed().as_secs_f64())
        };
        run()?;
        let times: Option<Vec<f64>> = (0..MOST_RUNS).map(|_| run()).collect();
        Some(Timing::of(times?)?.minimum)
    }
}
