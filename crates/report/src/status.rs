//! The state and the progress of a parameter study in words.

use crate::sheet::Sheet;
use asperity_data::grouped;
use asperity_study::folders::Status;
use asperity_study::{Plan, StudyProgress};
use std::time::Duration;

/// Largest number of characters of the name of a machine in the table.
const LONGEST_HOST: usize = 20;

/// Returns as text how many results of a parameter study are computed, missing or damaged. There is
/// a result for each combination of values on the axes of the study and for each random profile.
pub fn status_text(plan: &Plan, status: &Status) -> String {
    let mut sheet = Sheet::default();
    sheet.paragraph(&plan.title);
    let done = grouped(status.done);
    let total = grouped(status.total);
    let percent = 100.0 * status.done as f64 / status.total.max(1) as f64;
    let missing = grouped(status.missing);
    sheet.heading(&format!(
        "{done} of {total} records are there, {percent:.1} %; {missing} are missing"
    ));
    if status.failed > 0 {
        let failed = grouped(status.failed);
        sheet.paragraph(&format!(
            "{failed} records cannot be computed; a merge states the reasons."
        ));
    }
    if status.damaged > 0 {
        let damaged = grouped(status.damaged);
        sheet.paragraph(&format!("{damaged} torn or damaged lines are left out."));
    }
    add_shards(&mut sheet, status);
    sheet.into_text()
}

/// Adds a table of the shards (files with results) and of the processes that computed them.
fn add_shards(sheet: &mut Sheet, status: &Status) {
    let header = [
        "shard",
        "there",
        "of",
        "machine",
        "process",
        "wrote",
        "per second",
    ];
    let mut rows = vec![header.map(String::from)];
    for shard in &status.shards {
        for (index, attempt) in shard.attempts.iter().enumerate() {
            // A shard with several processes has several rows. Only the first row has its name and
            // its numbers of records.
            let [name, done, total] = if index == 0 {
                [
                    shard.shard.clone(),
                    grouped(shard.done),
                    grouped(shard.total),
                ]
            } else {
                Default::default()
            };
            let rate = match attempt.rate {
                Some(rate) => format!("{rate:.2}"),
                None => String::new(),
            };
            rows.push([
                name,
                done,
                total,
                attempt.host.chars().take(LONGEST_HOST).collect(),
                attempt.process.to_string(),
                grouped(attempt.records),
                rate,
            ]);
        }
    }
    sheet.table(&rows);
}

/// Returns the progress of a running study in one line: the number of computed results, the number
/// of all results, results per second, and the estimated remaining time.
pub fn progress_text(progress: &StudyProgress) -> String {
    let StudyProgress {
        done,
        before,
        total,
        ..
    } = *progress;
    let percent = if total == 0 {
        100.0
    } else {
        100.0 * done as f64 / total as f64
    };
    let mut text = format!("{done} of {total} records, {percent:.1} %");
    if done > before
        && let Some(rate) = progress.rate()
    {
        let decimals = if rate >= 100.0 { 0 } else { 2 };
        text += &format!(", {rate:.decimals$} per second");
        if done < total
            && let Some(left) = progress.left()
        {
            text += &format!(", {} left", duration(left));
        }
    } else if before > 0 {
        text += " were there before";
    }
    text
}

/// Returns a duration as text: `2 min 5 s`.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    let minutes = seconds / 60;
    let hours = minutes / 60;
    if hours >= 48 {
        format!("{} d {} h", hours / 24, hours % 24)
    } else if hours > 0 {
        format!("{hours} h {} min", minutes % 60)
    } else if minutes > 0 {
        format!("{minutes} min {} s", seconds % 60)
    } else {
        format!("{seconds} s")
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
