//! Random bytes of a terminal, among them sequences and pastes without their ends: the explorer
//! does not panic, it draws after each event, and the next key counts.

use super::common::draws::Draws;
use super::common::effort::cases;
use super::random::{Explorer, scenes};
use asperity::explorer::action::{Action, Task, WriteFailure};
use asperity::explorer::decoder::Decoder;
use asperity::explorer::input::action_of;
use asperity::explorer::terminal_input::Input;
use std::time::Duration;

/// Events in a quick run and in a slow one. With `TEST_EFFORT=8` the slow run has 200 000.
const QUICK: usize = 1_500;
const SLOW: u32 = 25_000;

/// Events for which one explorer is used.
const LIFE: usize = 500;

/// Key that draws the whole screen, in every context.
const REDRAW: &[u8] = b"\x0c";

/// Whole sequences of keys and of the mouse, answers of the terminal, and a paste. Each is also cut
/// at a random place.
const SEQUENCES: [&[u8]; 28] = [
    b"\r",
    b"\x1b",
    b"\t",
    b"\x7f",
    b"\x15",
    b"\x17",
    b"\x01",
    b"\x12",
    b"\x1b[A",
    b"\x1b[B",
    b"\x1b[C",
    b"\x1b[D",
    b"\x1b[1;2C",
    b"\x1b[1;2D",
    b"\x1b[5~",
    b"\x1b[6~",
    b"\x1b[H",
    b"\x1b[F",
    b"\x1b[3~",
    b"\x1b[Z",
    b"\x1bOP",
    b"\x1b[<0;30;12M",
    b"\x1b[<32;70;25M",
    b"\x1b[<65;90;20M",
    b"\x1b]11;rgb:ffff/ffff/ffff\x1b\\",
    b"\x1bP1+r636f=383\x1b\\",
    b"\xe6\xbc\xa2",
    b"\x1b[200~5 mN\x1b[201~",
];

/// Random input of a seed.
struct Random(Draws);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0.below(count)
    }

    /// Bytes that arrive together.
    fn bytes(&mut self) -> Vec<u8> {
        match self.below(16) {
            0..=9 => vec![b' ' + self.below(95) as u8],
            10..=13 => SEQUENCES[self.below(SEQUENCES.len())].to_vec(),
            14 => {
                let whole = SEQUENCES[self.below(SEQUENCES.len())];
                whole[..1 + self.below(whole.len())].to_vec()
            }
            _ => (0..self.below(12)).map(|_| self.below(256) as u8).collect(),
        }
    }
}

/// Passes the decoded events on. Files outside the folder of the test are not written.
fn act(explorer: &mut Explorer, decoded: Vec<Input>) {
    for input in decoded {
        if let Input::Event(event) = input
            && let Some(action) = action_of(event)
        {
            explorer.act(action);
        }
    }
    let mut refused = Vec::new();
    explorer.waiting.retain(|task| match task {
        Task::Write(file) if !file.path.is_relative() || file.path.starts_with("~") => {
            refused.push(file.clone());
            false
        }
        _ => true,
    });
    for file in refused {
        let why = WriteFailure::Refused("not in a test".to_owned());
        explorer.act(Action::Written(file, Err(why)));
    }
}

/// Presses a key after the pause that ends an unfinished sequence, and asserts that it counts.
fn assert_answers(explorer: &mut Explorer, decoder: &mut Decoder, seed: u64) {
    act(explorer, decoder.give_up());
    explorer.waiting.retain(|task| *task != Task::Redraw);
    act(explorer, decoder.read(REDRAW));
    assert!(
        explorer.waiting.contains(&Task::Redraw),
        "seed {seed}: no answer in {:?}",
        explorer.driver.app.keys()
    );
    explorer.waiting.retain(|task| *task != Task::Redraw);
}

fn assert_survives(events: usize) {
    let folder = tempfile::tempdir().unwrap();
    super::common::study::merged(folder.path(), super::common::study::PLAN);
    let scenes = scenes(folder.path());
    let mut happened = 0;
    for seed in 0.. {
        if happened >= events {
            break;
        }
        let mut random = Random(Draws::new(seed));
        let opening = scenes[random.below(scenes.len())].clone();
        let mut explorer = Explorer::new(opening, folder.path());
        let mut decoder = Decoder::default();
        for _ in 0..LIFE {
            happened += 1;
            match random.below(12) {
                0 => explorer.act(Action::Resize(
                    random.below(130) as u16,
                    random.below(45) as u16,
                )),
                1 => explorer.act(Action::Elapse(Duration::from_millis(
                    random.below(900) as u64
                ))),
                2..=4 => explorer.answer(),
                5 => assert_answers(&mut explorer, &mut decoder, seed),
                _ => act(&mut explorer, decoder.read(&random.bytes())),
            }
            if explorer.driver.app.finished {
                break;
            }
        }
        assert_answers(&mut explorer, &mut decoder, seed);
        explorer.settle();
    }
}

#[test]
fn no_bytes_of_a_terminal_make_it_panic_or_silent() {
    assert_survives(QUICK);
}

#[test]
#[ignore = "takes minutes; .ci/run runs it"]
fn no_bytes_of_a_terminal_make_it_panic_or_silent_in_many_events() {
    assert_survives(cases(SLOW) as usize);
}
