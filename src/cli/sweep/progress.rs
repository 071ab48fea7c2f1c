//! Progress of a study: a line of text, printed now and then without a terminal.

use crate::cli::progress::ProgressLine;
use crate::study::Progress;
use std::time::{Duration, Instant};

/// Time between two lines without a terminal.
const BETWEEN: Duration = Duration::from_secs(10);

/// Progress of a study on standard error.
#[derive(Default)]
pub(super) struct StudyProgress {
    line: ProgressLine,
    last: Option<Instant>,
}

impl StudyProgress {
    pub fn show(&mut self, progress: &Progress) {
        let text = text(progress);
        let is_due =
            progress.done == progress.total || self.last.is_none_or(|last| last.elapsed() >= BETWEEN);
        if is_due {
            self.last = Some(Instant::now());
        }
        self.line.show(&text, is_due.then_some(&text));
    }

    pub fn end(&self) {
        self.line.keep();
    }
}

fn text(progress: &Progress) -> String {
    let Progress { done, before, total, elapsed: _ } = *progress;
    let share = if total == 0 { 100.0 } else { 100.0 * done as f64 / total as f64 };
    let mut text = format!("{done} of {total} records, {share:.1} %");
    if let Some(rate) = progress.rate().filter(|_| done > before) {
        let decimals = if rate >= 100.0 { 0 } else { 2 };
        text.push_str(&format!(", {rate:.decimals$} per second"));
        if let Some(left) = progress.left().filter(|_| done < total) {
            text.push_str(&format!(", {} left", duration(left)));
        }
    } else if before > 0 {
        text.push_str(" were there before");
    }
    text
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
