//! The timeline of a loading: which columns each loading stage takes, where the events and the
//! playhead (the position of the animation) are, and how high the tick of each jump is.

use super::player::{At, Course, Player};
use asperity_contact::{Direction, Event, Mark, StageRecord};
use asperity_data::format_rounded;
use std::ops::Range;

/// Smallest number of columns of a loading stage that moves the body, if there is room.
const LEAST_COLUMNS: usize = 6;

/// Loading stages along the columns of a line. All stages have one scale: the same way |Δd|, or the
/// same time if the body relaxes, takes the same number of columns, unless a stage would be too
/// short to be seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    /// Columns of each loading stage. If there are more stages than columns, some are empty.
    pub stages: Vec<Range<usize>>,
    courses: Vec<Course>,
}

/// Height and direction of the tick in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Height from 0 to 1. Its square is the energy of the largest jump in the column, divided by
    /// the largest energy of all jumps.
    pub height: f64,
    /// True if springs gain energy in the largest jump of the column.
    pub is_gain: bool,
}

impl Timeline {
    /// Distributes the loading stages over a number of columns.
    pub fn new(records: &[StageRecord], columns: usize) -> Self {
        let mut courses = Vec::new();
        let mut lengths = Vec::new();
        for number in 0..records.len() {
            let course = Course::new(records, number);
            lengths.push((course.end - course.start).abs());
            courses.push(course);
        }
        Timeline {
            stages: distributed(&lengths, columns),
            courses,
        }
    }

    /// Returns the column of a position in a loading stage. `share` is the part of the stage before
    /// this position, from 0 to 1.
    pub fn column(&self, stage: usize, share: f64) -> Option<usize> {
        let columns = self.stages.get(stage)?;
        let last = columns.len().saturating_sub(1) as f64;
        Some(columns.start + (share.clamp(0.0, 1.0) * last).round() as usize)
    }

    /// Returns the position in a column: the index of the loading stage, and the part of the stage
    /// before the column, from 0 to 1.
    pub fn position(&self, column: usize) -> Option<(usize, f64)> {
        let shown = |columns: &&Range<usize>| !columns.is_empty();
        let last = self.stages.iter().rfind(shown)?;
        let column = column.min(last.end - 1);
        let stage = self
            .stages
            .iter()
            .position(|columns| columns.contains(&column))?;
        let columns = &self.stages[stage];
        let steps = columns.len() - 1;
        let share = if steps == 0 {
            1.0
        } else {
            (column - columns.start) as f64 / steps as f64
        };
        Some((stage, share))
    }

    /// Returns the column of an event.
    pub fn column_of(&self, event: &Event) -> Option<usize> {
        let course = self.courses.get(event.stage)?;
        let place = event.seconds.unwrap_or(event.indentation);
        let length = course.end - course.start;
        let share = if length == 0.0 {
            1.0
        } else {
            (place - course.start) / length
        };
        self.column(event.stage, share)
    }

    /// Returns the tick of each column; `None` if no jump is in the column.
    pub fn ticks(&self, events: &[Event], columns: usize) -> Vec<Option<Tick>> {
        let mut energies = vec![0.0_f64; columns];
        let mut largest: f64 = 0.0;
        for event in events {
            let (Some(jump), Some(column)) = (event.jump, self.column_of(event)) else {
                continue;
            };
            largest = largest.max(jump.energy.abs());
            if let Some(energy) = energies.get_mut(column)
                && jump.energy.abs() > energy.abs()
            {
                *energy = jump.energy;
            }
        }
        let mut ticks = Vec::new();
        for energy in energies {
            ticks.push((energy != 0.0).then(|| Tick {
                height: (energy.abs() / largest).sqrt(),
                is_gain: energy > 0.0,
            }));
        }
        ticks
    }
}

/// Divides columns among ways of these lengths. Each way takes at least [`LEAST_COLUMNS`] columns,
/// and a way of length zero takes one column, if there is room for all of them.
fn distributed(ways: &[f64], columns: usize) -> Vec<Range<usize>> {
    if ways.is_empty() {
        return Vec::new();
    }
    let room = columns / ways.len();
    let least = |way: f64| {
        let wanted = if way > 0.0 { LEAST_COLUMNS } else { 1 };
        wanted.min(room)
    };
    let taken: usize = ways.iter().map(|&way| least(way)).sum();
    let mut free = (columns - taken) as f64;
    let mut length: f64 = ways.iter().sum();
    let mut widths: Vec<usize> = ways.iter().map(|&way| least(way)).collect();
    for (width, way) in widths.iter_mut().zip(ways) {
        if length > 0.0 {
            let further = (free * way / length).round();
            *width += further as usize;
            free -= further;
            length -= way;
        }
    }
    let mut ranges = Vec::new();
    let mut first = 0;
    for width in widths {
        ranges.push(first..first + width);
        first += width;
    }
    ranges
}

/// Returns the position of the animation that shows an event. A jump is shown by the state just
/// after it. On loading, this is the state at the indentation of the jump, because a spring is in
/// contact at its own threshold; on unloading, it is the state at the next smaller number.
pub fn position_of(records: &[StageRecord], event: &Event) -> Player {
    let is_unloading = records
        .get(event.stage)
        .is_some_and(|record| record.direction == Direction::Unloading);
    let end = records.get(event.stage).map(StageRecord::end);
    let at = match event.jump {
        Some(_) if is_unloading => {
            let after = event.indentation.next_down();
            if end.is_some_and(|end| after < end) {
                At::End
            } else {
                At::Indentation(after)
            }
        }
        _ => match event.seconds {
            Some(seconds) => At::Seconds(seconds),
            None => At::Indentation(event.indentation),
        },
    };
    Player {
        stage: event.stage,
        at,
        playing: false,
    }
}

/// Returns the number of events that the animation has passed at a position. Events are in the
/// order of the motion.
pub fn passed(records: &[StageRecord], events: &[Event], player: Player) -> usize {
    events.partition_point(|event| has_passed(records, event, player))
}

fn has_passed(records: &[StageRecord], event: &Event, player: Player) -> bool {
    if event.stage != player.stage {
        return event.stage < player.stage;
    }
    match player.at {
        At::Start => return false,
        At::End => return true,
        At::Indentation(_) | At::Seconds(_) | At::PullOff => {}
    }
    if let (Some(seconds), Some(shown)) = (event.seconds, player.seconds(records)) {
        return seconds <= shown;
    }
    let indentation = player.indentation(records);
    let is_unloading = records
        .get(event.stage)
        .is_some_and(|record| record.direction == Direction::Unloading);
    match (is_unloading, event.jump) {
        (false, _) => event.indentation <= indentation,
        (true, Some(_)) => event.indentation > indentation,
        (true, None) => event.indentation >= indentation,
    }
}

/// Returns the index of the event that the list selects at a position of the animation: the last
/// event passed or, at the pull-off, the event with its mark, although the jump of this event comes
/// after the shown state.
pub fn selected(records: &[StageRecord], events: &[Event], player: Player) -> Option<usize> {
    if player.at == At::PullOff {
        let pull_off = events
            .iter()
            .position(|event| event.stage == player.stage && event.mark == Some(Mark::PullOff));
        if pull_off.is_some() {
            return pull_off;
        }
    }
    passed(records, events, player).checked_sub(1)
}

/// Returns the index of the next event after a position of the animation.
pub fn next(records: &[StageRecord], events: &[Event], player: Player) -> Option<usize> {
    let next = passed(records, events, player);
    if next < events.len() {
        Some(next)
    } else {
        None
    }
}

/// Returns the index of the event before a position of the animation. If the position shows an
/// event, the event before it is returned.
pub fn previous(records: &[StageRecord], events: &[Event], player: Player) -> Option<usize> {
    let before = passed(records, events, player).checked_sub(1)?;
    let shown = position_of(records, &events[before]);
    let is_shown = shown.stage == player.stage
        && (shown.at == player.at || shown.place(records) == player.place(records));
    if is_shown {
        before.checked_sub(1)
    } else {
        Some(before)
    }
}

/// Returns the speed of the animation in words, such as `2×`.
pub fn speed_in_words(speed: f64) -> String {
    format!("{}×", format_rounded(speed, 2, "1"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_share_the_columns_by_their_ways() {
        let widths = |ways: &[f64], columns| -> Vec<usize> {
            let ranges = distributed(ways, columns);
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert!(ranges.last().is_none_or(|last| last.end <= columns));
            ranges.iter().map(Range::len).collect()
        };
        assert_eq!(widths(&[], 40), [0; 0]);
        assert_eq!(widths(&[1.0], 40), [40]);
        assert_eq!(widths(&[1.0, 1.0], 40), [20, 20]);
        assert_eq!(widths(&[1.0, 0.0, 1.0], 41), [20, 1, 20]);
        // A short stage keeps its least number of columns.
        assert_eq!(widths(&[1e-6, 1.0], 40), [6, 34]);
        assert_eq!(widths(&[0.0], 40), [1]);
        // More stages than columns: some stages have none.
        assert_eq!(widths(&[1.0; 100], 40).iter().sum::<usize>(), 40);
        assert_eq!(widths(&[1.0; 20], 40), [2; 20]);
    }

    #[test]
    fn each_column_has_the_position_whose_column_it_is() {
        for ways in [&[1.0][..], &[1.0, 2.0], &[1.0, 0.0, 3.0], &[1.0; 9]] {
            let timeline = Timeline {
                stages: distributed(ways, 60),
                courses: Vec::new(),
            };
            let last = timeline.stages.last().unwrap().end;
            for column in 0..last {
                let (stage, share) = timeline.position(column).unwrap();
                assert_eq!(timeline.column(stage, share), Some(column), "{ways:?}");
            }
            assert_eq!(timeline.position(1000), timeline.position(last - 1));
        }
        assert_eq!(Timeline::new(&[], 60).position(0), None);
    }
}
