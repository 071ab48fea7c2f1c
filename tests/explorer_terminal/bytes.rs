//! Bytes and frames that a key costs over SSH, in 24-bit colours at 120 × 36: one frame with the
//! answer, and one with the results of the random profiles and of the estimated error.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{ASPERITY, paused, select};
use std::time::Duration;

/// Frames of a key: two, and two more on a machine that is busy with other tests.
const MOST_FRAMES: usize = 4;
const MOST_BYTES_OF_EDIT: usize = 4_000;
const MOST_BYTES_OF_PROFILE: usize = 8_000;
const MOST_BYTES_OF_STEP: usize = 2_000;

/// Time without output after the results of all studies.
const REST: Duration = Duration::from_millis(400);

fn remote(theme: &str) -> Terminal {
    let program = Program::new(ASPERITY)
        .argument("pressure-sensitive")
        .argument("--theme")
        .argument(theme)
        .size(120, 36)
        .env("COLORTERM", "truecolor");
    paused(program.env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"))
}

/// Returns the bytes and the frames of a key, with all results that follow it.
#[track_caller]
fn cost_of(terminal: &mut Terminal, key: &str) -> usize {
    terminal.settle_for(REST);
    let (start, first) = (terminal.written().len(), terminal.frames().len());
    terminal.send(key);
    terminal.settle_for(Duration::from_millis(50));
    terminal.wait_without("± …");
    terminal.settle_for(REST);
    let bytes = terminal.written().len() - start;
    let frames = terminal.frames().len() - first;
    println!("{key:?}: {bytes} bytes in {frames} frames");
    assert!(frames <= MOST_FRAMES, "{key:?}: {frames} frames");
    bytes
}

fn assert_keys_cost_little(theme: &str) {
    let mut terminal = remote(theme);
    select(&mut terminal, "Young");
    // The first edit also hides the notice of the scene.
    let mut edits = vec![cost_of(&mut terminal, "l"), cost_of(&mut terminal, "l")];
    for row in ["κ", "rms height"] {
        select(&mut terminal, row);
        edits.push(cost_of(&mut terminal, "l"));
    }
    println!("{theme}: {edits:?}");
    assert!(
        edits.iter().all(|bytes| *bytes <= MOST_BYTES_OF_EDIT),
        "{edits:?}"
    );
    let profile = cost_of(&mut terminal, "R");
    assert!(profile <= MOST_BYTES_OF_PROFILE, "{profile} bytes");
    let step = cost_of(&mut terminal, ";");
    assert!(step <= MOST_BYTES_OF_STEP, "{step} bytes");
}

#[test]
fn a_key_costs_few_bytes_and_frames_on_a_dark_background() {
    assert_keys_cost_little("dark");
}

#[test]
#[ignore = "the same in other colours; .ci/run runs it"]
fn a_key_costs_few_bytes_and_frames_on_a_light_background() {
    assert_keys_cost_little("light");
}
