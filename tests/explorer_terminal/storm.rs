//! Storms of keys, pastes, mouse and broken sequences: after each burst the next key counts, and
//! the explorer draws a window of another size.
//!
//! `STORM_SEEDS=0..200 cargo test --test explorer_terminal storm` runs other storms.

use crate::common::draws::Draws;
use crate::common::terminal::Terminal;
use crate::driving::{ESCAPE, explorer, paused, place, quit, select};
use portable_pty::ExitStatus;
use std::time::{Duration, Instant};

/// Bursts of a storm.
const BURSTS: usize = 12;

/// Columns by which the window grows after each burst.
const WIDER: usize = 4;

/// Longest time to a frame.
const LIMIT: Duration = Duration::from_secs(5);

/// Keys beside letters, digits and signs: control characters without those that end or stop the
/// explorer, and sequences of keys and of the mouse.
const KEYS: [&str; 24] = [
    "\r", "\x1b", "\t", "\x7f", "\x15", "\x17", "\x01", "\x05", "\x0b", "\x0c", "\x12", "\x1b[A",
    "\x1b[B", "\x1b[C", "\x1b[D", "\x1b[5~", "\x1b[6~", "\x1b[H", "\x1b[3~", "\x1b[Z", "\x1bOP",
    "\x1b[15~", "\x1bx", " ",
];

/// A pasted text without its end.
const UNFINISHED_PASTE: &[u8] = b"\x1b[200~5 mN";

/// Time after which the explorer waits no longer for the rest of a sequence, and of a paste.
const GIVEN_UP: Duration = Duration::from_millis(150);
const PASTE_GIVEN_UP: Duration = Duration::from_millis(1200);

/// Random input of a seed.
struct Random(Draws);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0.below(count)
    }

    /// Keys, a paste, or movements of the mouse. The paste of a binary file has any byte.
    fn burst(&mut self) -> Vec<u8> {
        match self.below(8) {
            0 => {
                let bytes: Vec<u8> = (0..self.below(3000))
                    .map(|_| self.below(256) as u8)
                    .collect();
                [b"\x1b[200~", &bytes[..], b"\x1b[201~"].concat()
            }
            1 => {
                let length = [10, 1000, 20_000][self.below(3)];
                let text: String = (0..length)
                    .map(|_| ['a', '1', 'µ', '\n', '漢', '.', '/'][self.below(7)])
                    .collect();
                format!("\x1b[200~{text}\x1b[201~").into_bytes()
            }
            2 => {
                let gesture = |_| {
                    let button = [0, 2, 32, 64, 65][self.below(5)];
                    let (column, row) = (self.below(130), self.below(45));
                    format!("\x1b[<{button};{column};{row}{}", ["M", "m"][self.below(2)])
                };
                (0..5).map(gesture).collect::<String>().into_bytes()
            }
            3 => self.cut_sequence(),
            _ => (0..1 + self.below(30)).flat_map(|_| self.key()).collect(),
        }
    }

    /// The beginning of a sequence without its end, as a broken line may pass it on.
    fn cut_sequence(&mut self) -> Vec<u8> {
        const WHOLE: [&[u8]; 9] = [
            b"\x1b[<0;30;12M",
            b"\x1b[1;5C",
            b"\x1bOA",
            b"\x1b[M !!",
            b"\x1b[?64;1;2c",
            b"\x1b]11;rgb:ffff/ffff/ffff\x07",
            b"\x1bP1+r636f=383\x1b\\",
            b"\xe6\xbc\xa2",
            UNFINISHED_PASTE,
        ];
        let whole = WHOLE[self.below(WHOLE.len())];
        if whole == UNFINISHED_PASTE {
            return whole.into();
        }
        whole[..1 + self.below(whole.len() - 1)].into()
    }

    fn key(&mut self) -> Vec<u8> {
        match self.below(3) {
            0 => KEYS[self.below(KEYS.len())].into(),
            // All but q, which leaves.
            _ => match b' ' + self.below(95) as u8 {
                b'q' => vec![b'R'],
                sign => vec![sign],
            },
        }
    }
}

/// Presses the key that draws the whole screen, and asserts that it counts. Returns false if the
/// storm has left.
fn answers(terminal: &mut Terminal, seed: u64, burst: &[u8]) -> bool {
    const REDRAW: &[u8] = b"\x0c";
    const CLEARED: &[u8] = b"\x1b[2J";
    let before = terminal.written().len();
    terminal.send_if_open(REDRAW);
    let until = Instant::now() + LIMIT;
    while place(&terminal.written()[before..], CLEARED).is_none() {
        if terminal.ended().is_some() {
            return false;
        }
        let what = burst.escape_ascii();
        assert!(
            Instant::now() < until,
            "seed {seed}, no key counts after {what}:\n{}",
            terminal.text()
        );
        terminal.is_silent_for(Duration::from_millis(10));
    }
    true
}

/// Sends a storm, which may also choose to leave. After each burst a window of another size is
/// drawn.
fn storm(seed: u64) {
    let mut random = Random(Draws::new(seed));
    let (program, _folder) = explorer();
    let mut terminal = program.start();
    terminal.wait_for("F_a ");
    for width in (90..).step_by(WIDER).take(BURSTS) {
        let burst = random.burst();
        terminal.send_if_open(&burst);
        let is_paste = burst.starts_with(UNFINISHED_PASTE);
        terminal.take_until(Instant::now() + if is_paste { PASTE_GIVEN_UP } else { GIVEN_UP });
        if !answers(&mut terminal, seed, &burst) {
            return;
        }
        terminal.resize(width as u16, 30);
        let until = Instant::now() + LIMIT;
        // Each window is wider than those before. A row may end a little before the edge.
        while !terminal
            .rows()
            .iter()
            .any(|row| row.chars().count() > width - WIDER)
        {
            if terminal.ended().is_some_and(ExitStatus::success) {
                return;
            }
            let what = burst.escape_ascii();
            assert!(
                Instant::now() < until,
                "seed {seed}, nothing drawn after {what}:\n{}",
                terminal.text()
            );
            terminal.is_silent_for(Duration::from_millis(10));
        }
    }
}

/// Keys that edit faster than their scenes are computed wait in the terminal, and no outcome of an
/// earlier scene is kept.
#[test]
#[ignore = "takes some seconds; .ci/run runs it"]
fn a_burst_of_edits_takes_little_memory() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    select(&mut terminal, "κ");
    terminal.send(&"lh".repeat(5000));
    terminal.send("N");
    terminal.wait_for("F/F_a,max");
    let status = std::fs::read_to_string(format!("/proc/{}/status", terminal.pid())).unwrap();
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB"))
        .unwrap();
    let peak: u64 = peak.trim().parse().unwrap();
    assert!(peak < 60_000, "{peak} kB");
}

#[test]
fn every_burst_of_input_is_drawn() {
    let seeds = std::env::var("STORM_SEEDS").unwrap_or("0..3".to_owned());
    let (from, to) = seeds.split_once("..").expect("a range of seeds");
    let (from, to): (u64, u64) = (from.parse().unwrap(), to.parse().unwrap());
    (from..to).for_each(storm);
}

#[test]
fn a_long_text_is_searched_as_fast_as_it_is_typed() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    for (key, prompt) in [("/", "Find:"), (":", "Esc cancel"), ("o", "Search:")] {
        terminal.send(key);
        terminal.wait_for(prompt);
        let begun = Instant::now();
        // A terminal without bracketed paste sends keys.
        terminal.send(&"ab".repeat(2500));
        terminal.wait_for("at most 4096 characters");
        assert!(begun.elapsed() < LIMIT, "{key}: {:?}", begun.elapsed());
        terminal.send(ESCAPE);
        terminal.wait_without("at most 4096 characters");
    }
    terminal.send("d");
    terminal.wait_for("manual loading");
    terminal.send("\r");
    terminal.wait_for("Press or pull to (");
    terminal.send("\x1b[200~1\r\n mN\x1b[201~");
    terminal.wait_for("! control characters are left out");
    terminal.wait_for("): 1 mN");
    terminal.send("\x7f");
    terminal.wait_without("left out");
    terminal.wait_for("Press or pull to (");
    terminal.send(ESCAPE);
    terminal.wait_without("Press or pull to (");
    quit(&mut terminal);
}
