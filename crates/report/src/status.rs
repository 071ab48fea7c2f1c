//! The state and the progress of a study in words.

use crate::sheet::Sheet;
use asperity_data::grouped;
use asperity_study::folders::Status;
use asperity_study::{Plan, StudyProgress};
use std::time::Duration;

/// Largest number of characters of the name of a machine in the table.
const LONGEST_HOST: usize = 20;

/// Returns as text how many results of a parameter study are computed, missing or damaged. There is
/// a result for each combination of values on the axes of the study, on each random profile.
pub fn status_text(plan: &Plan, status: &Status) -> String {
    let mut sheet = Sheet::default();
    sheet.paragraph(&plan.title);
    let share = 100.0 * status.done as f64 / status.total.max(1) as f64;
    sheet.heading(&format!(
        "{} of {} records are there, {share:.1} %; {} are missing",
        grouped(status.done),
        grouped(status.total),
        grouped(status.missing)
    ));
    if status.failed > 0 {
        let failed = grouped(status.failed);
        sheet.paragraph(&format!(
            "{failed} records cannot be computed; a merge states the reasons."
        ));
    }
    if status.damaged > 0 {
        sheet.paragraph(&format!(
            "{} torn or damaged lines are left out.",
            grouped(status.damaged)
        ));
    }
    let mut rows = vec![
        [
            "shard",
            "there",
            "of",
            "machine",
            "process",
            "wrote",
            "per second",
        ]
        .map(String::from),
    ];
    for shard in &status.shards {
        for (index, attempt) in shard.attempts.iter().enumerate() {
            let first = |text: String| if index == 0 { text } else { String::new() };
            rows.push([
                first(shard.shard.clone()),
                first(grouped(shard.done)),
                first(grouped(shard.total)),
                attempt.host.chars().take(LONGEST_HOST).collect(),
                attempt.process.to_string(),
                grouped(attempt.records),
                attempt
                    .rate
                    .map_or_else(String::new, |rate| format!("{rate:.2}")),
            ]);
        }
    }
    sheet.table(&rows);
    sheet.into_text()
}

/// Returns the progress of a running study in one line: results computed so far and in all, results
/// per second, and estimated time left.
pub fn progress_text(progress: &StudyProgress) -> String {
    let StudyProgress {
        done,
        before,
        total,
        ..
    } = *progress;
    let share = if total == 0 {
        100.0
    } else {
        100.0 * done as f64 / total as f64
    };
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

/// Writes a duration: `2 min 5 s`.
pub fn duration(time: Duration) -> String {
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
            progress_text(&StudyProgress {
                done,
                before,
                total: 4000,
                elapsed,
            })
        };
        assert_eq!(at(0, 0, 0), "0 of 4000 records, 0.0 %");
        assert_eq!(
            at(1000, 1000, 0),
            "1000 of 4000 records, 25.0 % were there before"
        );
        assert_eq!(
            at(2000, 1000, 10),
            "2000 of 4000 records, 50.0 %, 100 per second, 20 s left"
        );
        assert_eq!(
            at(1001, 1000, 10),
            "1001 of 4000 records, 25.0 %, 0.10 per second, 8 h 19 min left"
        );
        assert_eq!(
            at(4000, 0, 10),
            "4000 of 4000 records, 100.0 %, 400 per second"
        );
    }
}
