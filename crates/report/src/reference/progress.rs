//! Progress of a comparison of profiles with three dimensions, in words.

use super::words::{omitted_waves, ratio};
use crate::status::duration;
use crate::words::whole_percent;
use asperity_data::{counted, memory_size, per_cent};
use asperity_study::half_space::{ReferenceEvent, SquareLoops};
use std::time::{Duration, Instant};

/// Smallest estimated time in s of a comparison that is announced as long.
const LONG: f64 = 10.0;

/// Smallest finished share of the computation of the squares from which the remaining time is
/// estimated. With a smaller share, the estimate from the beginning of the comparison is used.
const LEAST_SHARE: f64 = 0.02;

/// Progress, in words, of the comparison of a scene on profiles with the same scene in three
/// dimensions. Such a comparison computes the contact of several random rough squares.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceProgress {
    /// Moment at which the computation of the squares began.
    begun: Instant,
    /// Number of random rough squares.
    surfaces: u64,
    /// Number of finished squares.
    done: u64,
    /// Number of finished random profiles.
    lines_done: u64,
    /// Estimated share of the computation of the squares that is finished.
    share: f64,
    /// Estimated time in s that the computation of all squares takes.
    seconds: f64,
}

impl Default for ReferenceProgress {
    fn default() -> Self {
        ReferenceProgress {
            begun: Instant::now(),
            surfaces: 0,
            done: 0,
            lines_done: 0,
            share: 0.0,
            seconds: 0.0,
        }
    }
}

impl ReferenceProgress {
    /// Returns a line of text on an event of the comparison, such as a finished square. The second
    /// returned value is true if the line announces a comparison that takes at least 10 s.
    pub fn words(&mut self, event: &ReferenceEvent) -> (String, bool) {
        let line = match *event {
            ReferenceEvent::Begins {
                surfaces,
                threads,
                bytes,
                seconds,
            } => {
                *self = ReferenceProgress {
                    surfaces,
                    seconds,
                    ..ReferenceProgress::default()
                };
                let squares = counted(surfaces, "square");
                let threads = counted(threads as u64, "thread");
                let time = in_words(seconds);
                let memory = memory_size(bytes);
                let line = format!("{squares} on {threads}: about {time} and {memory} of memory");
                return (line, seconds >= LONG);
            }
            ReferenceEvent::Profiles { count, lines } => {
                self.lines_done += count;
                format!("profiles: {} %", 100 * self.lines_done / lines.max(1))
            }
            ReferenceEvent::ProfilesEnd { .. } => {
                self.begun = Instant::now();
                self.squares_in_words()
            }
            ReferenceEvent::Loaded { share } => {
                // The number of loads is estimated in advance. Therefore the sum of the shares may
                // exceed 1 before the end.
                self.share = (self.share + share).min(0.99);
                self.squares_in_words()
            }
            ReferenceEvent::Square { .. } => {
                self.done += 1;
                self.squares_in_words()
            }
        };
        (line, false)
    }

    /// Returns in words how many squares are finished, which share of the computation is finished,
    /// and the remaining time.
    fn squares_in_words(&self) -> String {
        let share_of_squares = self.done as f64 / self.surfaces.max(1) as f64;
        let share = self.share.max(share_of_squares);
        let left = if share < LEAST_SHARE {
            self.seconds
        } else {
            self.begun.elapsed().as_secs_f64() * (1.0 - share) / share
        };
        let done = self.done;
        let squares = counted(self.surfaces, "square");
        let share = whole_percent(share);
        let left = in_words(left);
        format!("{done} of {squares}, {share}, {left} left")
    }

    /// Returns in words how many finished squares would be lost if the user stopped the comparison
    /// now.
    pub fn lost(&self) -> String {
        if self.surfaces == 0 {
            return "stopped before the first square".to_owned();
        }
        let squares = counted(self.surfaces, "square");
        format!("stopped after {} of {squares}, which are lost", self.done)
    }
}

fn in_words(seconds: f64) -> String {
    duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

/// Returns in a few words how far the computation of the force loops of random rough squares in
/// three dimensions has come. As soon as there are results, the words also state a ratio: the
/// pull-off force with profiles divided by the pull-off force in three dimensions. If `is_adhesive`
/// is false, the ratio is that of the indentations.
pub fn square_loops_words(loops: &SquareLoops, is_adhesive: bool) -> String {
    let surfaces = loops.surfaces;
    let Some(compared) = loops.headline() else {
        if surfaces == 0 {
            return "three dimensions: begins".to_owned();
        }
        let share = whole_percent(loops.share);
        return format!("three dimensions: 0 of {surfaces} squares, {share}");
    };
    let symbol = if is_adhesive { "F_a" } else { "d" };
    let mut ratio = ratio(&compared);
    // Without random surfaces the ratio has no interval. The error that is left is that of the
    // grid.
    if compared.error.is_none()
        && let Some(reference) = &loops.reference
        && let Some(error) = reference.budget.grid
    {
        ratio = format!("{ratio}, grid ± {}", per_cent(error));
    }
    let squares = match &loops.reference {
        Some(reference) => omitted_waves(reference),
        None => format!(", {} of {surfaces} squares", loops.curves.len()),
    };
    format!("{symbol} profile/three dimensions {ratio}{squares}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Simulation, open};

    /// The profile of a punch is exact, so that the difference from three dimensions is an error of
    /// the grid.
    #[test]
    fn a_ratio_without_an_interval_has_the_error_of_the_grid() {
        let scene = open("kendall-punch").unwrap().scene().clone();
        let loops = SquareLoops::of(&scene, &mut Simulation::default(), Control::default());
        let words = square_loops_words(&loops.unwrap(), true);
        assert!(words.contains(", grid ± 15 %"), "{words}");
    }

    #[test]
    fn there_is_progress_before_the_first_square() {
        let mut progress = ReferenceProgress::default();
        let begins = ReferenceEvent::Begins {
            surfaces: 4,
            threads: 2,
            bytes: 1 << 20,
            seconds: 7200.0,
        };
        let (words, is_long) = progress.words(&begins);
        assert!(
            is_long && words.starts_with("4 squares on 2 threads: about 2 h"),
            "{words}"
        );
        let lines = progress
            .words(&ReferenceEvent::Profiles {
                count: 16,
                lines: 64,
            })
            .0;
        assert_eq!(lines, "profiles: 25 %");
        let begun = progress
            .words(&ReferenceEvent::ProfilesEnd { lines: Vec::new() })
            .0;
        assert!(begun.starts_with("0 of 4 squares, 0 %, 2 h"), "{begun}");
        let loaded = progress.words(&ReferenceEvent::Loaded { share: 0.05 }).0;
        assert!(loaded.starts_with("0 of 4 squares, 5 %, "), "{loaded}");
        let square = ReferenceEvent::Square {
            curve: Vec::new(),
            headline: 1.0,
        };
        assert!(
            progress
                .words(&square)
                .0
                .starts_with("1 of 4 squares, 25 %, ")
        );
        for _ in 0..30 {
            progress.words(&ReferenceEvent::Loaded { share: 0.05 });
        }
        let most = progress.words(&ReferenceEvent::Loaded { share: 0.05 }).0;
        assert!(most.starts_with("1 of 4 squares, 99 %, "), "{most}");
    }
}
