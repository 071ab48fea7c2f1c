//! A time limit for a test.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// Runs a test, and fails it after this time: a test that hangs is reported.
pub fn within(seconds: u64, test: impl FnOnce() + Send + 'static) {
    let (done, outcome) = channel();
    thread::spawn(move || done.send(catch_unwind(AssertUnwindSafe(test))));
    match outcome.recv_timeout(Duration::from_secs(seconds)) {
        Ok(Ok(())) => {}
        Ok(Err(panic)) => resume_unwind(panic),
        Err(_) => panic!("not done after {seconds} s"),
    }
}
