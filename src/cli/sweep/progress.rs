//! Progress of a study on standard error: on a terminal one line that changes, elsewhere a line now and then.

use crate::study::Progress;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Time between two lines where there is no terminal.
const BETWEEN: Duration = Duration::from_secs(10);

/// Tells progress.
#[derive(Default)]
pub(super) struct Teller {
    last: Option<Instant>,
    drawn: bool,
}

impl Teller {
    pub fn tell(&mut self, progress: &Progress) {
        let mut stderr = io::stderr();
        let text = text(progress);
        // Who cannot be told does without.
        let _ = if stderr.is_terminal() {
            self.drawn = true;
            write!(stderr, "\r\x1b[K{text}").and_then(|()| stderr.flush())
        } else if progress.done == progress.total || self.last.is_none_or(|last| last.elapsed() >= BETWEEN) {
            self.last = Some(Instant::now());
            writeln!(stderr, "{text}")
        } else {
            Ok(())
        };
    }

    pub fn end(&self) {
        if self.drawn {
            let _ = writeln!(io::stderr());
        }
    }
}

fn text(progress: &Progress) -> String {
    let Progress { done, before, total, elapsed: _ } = *progress;
    let share = if total == 0 { 100.0 } else { 100.0 * done as f64 / total as f64 };
    let mut text = format!("{done} of {total} records, {share:.1} %");
    if done > before {
        text.push_str(&format!(", {} per second", Rounded(progress.rate())));
        if let Some(left) = progress.left().filter(|_| done < total) {
            text.push_str(&format!(", {} left", duration(left)));
        }
    } else if before > 0 {
        text.push_str(" were there before");
    }
    text
}

/// A rate with few digits.
struct Rounded(f64);

impl std::fmt::Display for Rounded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = if self.0 >= 100.0 { 0 } else { 2 };
        write!(f, "{:.decimals$}", self.0)
    }
}

fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {} s", seconds % 60),
        (48.., _) => format!("{} d {} h", hours / 24, hours % 24),
        _ => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_is_one_line() {
        let at = |done, before, seconds| {
            let elapsed = Duration::from_secs(seconds);
            text(&Progress { done, before, total: 4000, elapsed })
        };
        assert_eq!(at(0, 0, 0), "0 of 4000 records, 0.0 %");
        assert_eq!(at(1000, 1000, 0), "1000 of 4000 records, 25.0 % were there before");
        assert_eq!(at(2000, 1000, 10), "2000 of 4000 records, 50.0 %, 100 per second, 20 s left");
        assert_eq!(at(1001, 1000, 10), "1001 of 4000 records, 25.0 %, 0.10 per second, 8 h 19 min left");
        assert_eq!(at(4000, 0, 10), "4000 of 4000 records, 100.0 %, 400 per second");
    }
}
