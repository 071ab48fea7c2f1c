//! Times at which the frames of a session are drawn. Over SSH there are fewer frames, because each
//! has to be transmitted.

use std::time::{Duration, Instant};

/// Largest frame rate over SSH in 1/s.
const REMOTE_FRAMES: u32 = 12;

/// Longest time for which a frame over SSH is delayed to include an answer of the solver and the
/// events that the solver lists after it.
const ANSWER_TIME: Duration = Duration::from_millis(30);

/// Shortest time between two frames that show only progress of the studies, and the same over SSH.
/// The last results of the studies are shown without this delay.
const STUDY_TIME: Duration = Duration::from_millis(100);
const REMOTE_STUDY_TIME: Duration = Duration::from_secs(1);

/// Content of the next frame, which decides how soon the frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Only progress of the studies.
    Progress,
    /// A state whose answer was requested from the solver at this time.
    Unanswered(Instant),
    /// A state with its answer, or the last results of the studies.
    Complete,
}

/// The times of the frames of a session.
#[derive(Clone, Debug)]
pub struct Pacing {
    is_remote: bool,
    /// Shortest time between two steps of the animation and, over SSH, mean time between frames in
    /// quick succession.
    frame_time: Duration,
    /// Earliest time of the next frame. Without this limit, a held key or a dragged mouse would
    /// fill a connection over SSH with frames that are outdated before they arrive.
    due: Instant,
    /// Time of the last frame.
    shown: Instant,
}

impl Pacing {
    /// Creates the times for at most `frame_rate` frames in a second. The first frame is drawn at
    /// `first` or later.
    pub fn new(is_remote: bool, frame_rate: u32, first: Instant) -> Self {
        let frame_rate = if is_remote {
            frame_rate.min(REMOTE_FRAMES)
        } else {
            frame_rate
        };
        Pacing {
            is_remote,
            frame_time: Duration::from_secs(1) / frame_rate,
            due: first,
            shown: first,
        }
    }

    /// Returns the shortest time between two steps of the animation.
    pub fn frame_time(&self) -> Duration {
        self.frame_time
    }

    /// Allows the next frame at once.
    pub fn hurry(&mut self, now: Instant) {
        self.due = now;
    }

    /// Notes that a frame was drawn.
    ///
    /// Over SSH, one frame may follow another at once: the answer of the solver may come after the
    /// frame that did not wait for it any longer, and a key soon after the results of the studies.
    /// Further frames are as far apart as the frame rate allows.
    pub fn note_frame(&mut self, now: Instant) {
        self.shown = now;
        if self.is_remote {
            self.due = now.max(self.due + self.frame_time);
        }
    }

    /// Returns the earliest time of the next frame. Over SSH, a frame after a key is delayed a
    /// little to include the answer of the solver: a frame without the answer would cost as many
    /// bytes. Frames that show only the progress of the studies have more time between them.
    pub fn next_frame(&self, content: Content) -> Instant {
        match content {
            Content::Progress if self.is_remote => self.due.max(self.shown + REMOTE_STUDY_TIME),
            Content::Progress => self.due.max(self.shown + STUDY_TIME),
            Content::Unanswered(asked) if self.is_remote => self.due.max(asked + ANSWER_TIME),
            Content::Unanswered(_) | Content::Complete => self.due,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_TIME: Duration = Duration::from_nanos(83_333_333);

    fn milliseconds(time: u64) -> Duration {
        Duration::from_millis(time)
    }

    /// Times of a session over SSH that has shown nothing for a while.
    fn at_rest(start: Instant) -> Pacing {
        let mut pacing = Pacing::new(true, 30, start);
        pacing.note_frame(start);
        pacing
    }

    #[test]
    fn an_answer_after_the_frame_of_its_key_is_shown_at_once() {
        let start = Instant::now();
        let mut pacing = at_rest(start);
        let key = start + milliseconds(500);
        assert_eq!(
            pacing.next_frame(Content::Unanswered(key)),
            key + ANSWER_TIME
        );
        pacing.note_frame(key + ANSWER_TIME);
        let answer = key + milliseconds(45);
        assert!(pacing.next_frame(Content::Complete) <= answer);
        // The frames of keys that follow at once are as rare as the frame rate demands.
        pacing.note_frame(answer);
        let next = pacing.next_frame(Content::Complete);
        assert_eq!(next, key + ANSWER_TIME + FRAME_TIME);
    }

    #[test]
    fn a_key_soon_after_the_results_of_the_studies_is_answered_at_once() {
        let start = Instant::now();
        let mut pacing = at_rest(start);
        pacing.note_frame(start + milliseconds(500));
        let key = start + milliseconds(510);
        assert!(pacing.next_frame(Content::Complete) <= key);
    }

    #[test]
    fn keys_in_quick_succession_cost_no_more_frames_than_the_frame_rate() {
        for answer_time in [1, 20, 45, 200] {
            let start = Instant::now();
            let mut pacing = at_rest(start);
            let mut frames = 0;
            for time in 500..3500 {
                let now = start + milliseconds(time);
                // A key each 33 ms, whose answer takes the same time as all others.
                let since_key = (time - 500) % 33;
                let content = if since_key < answer_time {
                    Content::Unanswered(now - milliseconds(since_key))
                } else {
                    Content::Complete
                };
                if now >= pacing.next_frame(content) {
                    pacing.note_frame(now);
                    frames += 1;
                }
            }
            assert!(frames <= 3 * REMOTE_FRAMES + 2, "{frames} frames");
        }
    }

    #[test]
    fn a_local_terminal_shows_each_change_at_once() {
        let start = Instant::now();
        let mut pacing = Pacing::new(false, 30, start);
        pacing.note_frame(start + milliseconds(500));
        let key = start + milliseconds(501);
        assert!(pacing.next_frame(Content::Unanswered(key)) <= key);
        assert!(pacing.next_frame(Content::Complete) <= key);
        assert!(pacing.next_frame(Content::Progress) > key);
    }
}
