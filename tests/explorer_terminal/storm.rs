//! Storms of keys, pastes, mouse and broken sequences: after each burst the explorer draws a window of another size.
//!
//! `STORM_SEEDS=0..200 cargo test --test explorer_terminal storm` runs other storms.

use crate::driving::{ESCAPE, explorer, paused, quit, select};
use portable_pty::ExitStatus;
use std::time::{Duration, Instant};

/// Bursts of a storm.
const BURSTS: usize = 12;

/// Longest time to a frame.
const LIMIT: Duration = Duration::from_secs(5);

/// Keys beside letters, digits and signs: control characters without those that end or stop the explorer, and
/// sequences of keys and of the mouse.
const KEYS: [&str; 24] = [
    "\r", "\x1b", "\t", "\x7f", "\x15", "\x17", "\x01", "\x05", "\x0b", "\x0c", "\x12", "\x1b[A", "\x1b[B",
    "\x1b[C", "\x1b[D", "\x1b[5~", "\x1b[6~", "\x1b[H", "\x1b[3~", "\x1b[Z", "\x1bOP", "\x1b[15~", "\x1bx",
    " ",
];

/// Random numbers of a seed.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((u128::from(z ^ (z >> 31)) * count as u128) >> 64) as usize
    }

    /// Keys, a paste, or movements of the mouse. The paste of a binary file has any byte.
    fn burst(&mut self) -> Vec<u8> {
        match self.below(8) {
            0 => {
                let bytes: Vec<u8> = (0..self.below(3000)).map(|_| self.below(256) as u8).collect();
                [b"\x1b[200~", &bytes[..], b"\x1b[201~"].concat()
            }
            1 => {
                let length = [10, 1000, 20_000][self.below(3)];
                let text: String =
                    (0..length).map(|_| ['a', '1', 'µ', '\n', '漢', '.', '/'][self.below(7)]).collect();
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
            // Without an end, as a broken line may pass it on.
            3 => [&b"\x1b["[..], b"\x1b[1;", b"\x1bO", b"\xe6\xbc", b"\x1b[<0;3", b"\x1b[0;0R"]
                [self.below(6)]
            .into(),
            _ => (0..1 + self.below(30)).flat_map(|_| self.key()).collect(),
        }
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

/// Sends a storm, which may also choose to leave. After each burst a window of another size is drawn.
fn storm(seed: u64) {
    let mut random = Random(seed);
    let (program, _folder) = explorer();
    let mut terminal = program.start();
    terminal.wait_for("F_a ");
    for width in 90..90 + BURSTS {
        let burst = random.burst();
        terminal.send_if_open(&burst);
        let rest = Duration::from_millis(random.below(60) as u64);
        terminal.is_silent_for(rest);
        if terminal.ended().is_some() {
            return;
        }
        terminal.resize(width as u16, 30);
        let until = Instant::now() + LIMIT;
        // Each window is wider than those before.
        while !terminal.rows().iter().any(|row| row.chars().count() == width) {
            if terminal.ended().is_some_and(ExitStatus::success) {
                return;
            }
            let what = burst.escape_ascii();
            assert!(Instant::now() < until, "seed {seed}, nothing drawn after {what}:\n{}", terminal.text());
            terminal.is_silent_for(Duration::from_millis(10));
        }
    }
}

/// Keys that edit faster than their scenes are computed wait in the terminal, and no outcome of an earlier scene is kept.
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
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB")).unwrap();
    let peak: u64 = peak.trim().parse().unwrap();
    assert!(peak < 60_000, "{peak} kB");
}

#[test]
fn every_burst_of_input_is_drawn() {
    let seeds = std::env::var("STORM_SEEDS").unwrap_or("0..6".to_owned());
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
    terminal.send("F");
    terminal.wait_for("Go to the force (");
    terminal.send("\x1b[200~1\r\n mN\x1b[201~");
    terminal.wait_for("! control characters are left out");
    terminal.wait_for("): 1 mN");
    terminal.send("\x7f");
    terminal.wait_without("left out");
    terminal.wait_for("Go to the force (");
    terminal.send(ESCAPE);
    terminal.wait_without("Go to the force (");
    quit(&mut terminal);
}
