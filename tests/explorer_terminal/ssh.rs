//! The explorer over SSH, which it knows by the variables of the connection: frames and bytes of
//! the animation and of a held key are few enough for a slow line.

use crate::common::terminal::{Frame, Program, Terminal};
use crate::driving::{ASPERITY, headline, paused, quit, select, wait_for_another};
use std::time::{Duration, Instant};

/// Most bytes in a second on a slow connection.
const MOST_BYTES: f64 = 20_000.0;
/// Most frames in a second.
const MOST_FRAMES: f64 = 12.0;

/// The explorer on a built-in scene behind a connection, paused.
fn remote() -> Terminal {
    let program = Program::new(ASPERITY)
        .argument("pressure-sensitive")
        .argument("--set")
        .argument("loading.0.0=2e-6");
    paused(program.env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"))
}

/// Frames in the fullest second.
fn fullest_second(frames: &[Frame]) -> usize {
    let within = |start: &Frame| {
        let later = frames
            .iter()
            .skip_while(|frame| frame.arrived < start.arrived);
        later
            .take_while(|frame| frame.arrived - start.arrived < Duration::from_secs(1))
            .count()
    };
    frames.iter().map(within).max().unwrap_or(0)
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn a_whole_loop_is_played_over_a_slow_line() {
    let mut terminal = remote();
    // Approach and retraction, from the start to the end: twelve seconds.
    let (start, first) = (terminal.written().len(), terminal.frames().len());
    let begun = Instant::now();
    terminal.send(" ");
    // Until a pause longer than between any two frames.
    terminal.settle_for(Duration::from_millis(1500));
    let frames = &terminal.frames()[first..];
    let seconds = frames
        .last()
        .unwrap()
        .arrived
        .duration_since(begun)
        .as_secs_f64();
    let bytes = terminal.written().len() - start;
    let rate = bytes as f64 / seconds;
    println!(
        "{bytes} bytes in {} frames and {seconds:.2} s: {rate:.0} B/s",
        frames.len()
    );
    assert!(seconds > 11.0, "a stage takes six seconds: {seconds} s");
    assert!(rate < MOST_BYTES, "{rate} B/s");
    assert!(frames.len() > 60, "it plays: {} frames", frames.len());
    assert!(
        frames.len() as f64 <= MOST_FRAMES * seconds + 2.0,
        "{} frames in {seconds} s",
        frames.len()
    );
    assert!(
        fullest_second(frames) <= 14,
        "{} frames in a second",
        fullest_second(frames)
    );
    quit(&mut terminal);
}

#[test]
fn a_held_key_does_not_flood_a_slow_line() {
    let mut terminal = remote();
    let (start, first) = (terminal.written().len(), terminal.frames().len());
    let begun = Instant::now();
    terminal.send("d");
    // As from a keyboard that repeats a held key: thirty in a second, for three seconds.
    for key in 1..=90 {
        terminal.send("l");
        terminal.take_until(begun + Duration::from_secs(key) / 30);
    }
    let frames = terminal.frames().len() - first;
    let bytes = terminal.written().len() - start;
    println!("{bytes} bytes in {frames} frames in 3 s of a held key");
    assert!(
        frames as f64 <= 3.0 * MOST_FRAMES + 4.0,
        "{frames} frames in 3 s"
    );
    assert!(bytes as f64 / 3.0 < MOST_BYTES, "{bytes} bytes in 3 s");
    // The last key also has its effect at once.
    terminal.settle();
    assert!(
        terminal.text().contains("manual loading"),
        "{}",
        terminal.text()
    );
    quit(&mut terminal);
}

/// A frame without the answer of the solver would hold the answer back until the next frame is due.
#[test]
fn the_frame_after_a_key_has_the_new_curve() {
    const KEYS: usize = 5;
    let mut terminal = remote();
    select(&mut terminal, "κ");
    let mut frames = 0;
    for _ in 0..KEYS {
        // The profiles of the former scene may still be computed.
        terminal.settle_for(Duration::from_millis(500));
        let before = headline(&terminal.rows()).expect("a force is shown");
        let first = terminal.frames().len();
        terminal.send("h");
        wait_for_another(&mut terminal, &before);
        frames += terminal.frames().len() - first;
    }
    println!("{frames} frames for the answers to {KEYS} keys");
    // One for each key. Without the waiting half of the keys need two; on a busy machine an answer
    // may take longer than the frame waits.
    assert!(frames <= KEYS + 2, "{frames} frames for {KEYS} keys");
    quit_without_saving(&mut terminal);
}

fn quit_without_saving(terminal: &mut Terminal) {
    terminal.send("q");
    terminal.wait_for("unsaved changes");
    quit(terminal);
}
