//! Sequences of keys that a slow line splits, and sequences that a broken line never finishes.

use crate::common::terminal::Terminal;
use crate::driving::{INTERRUPT, assert_given_back, explorer, paused, quit};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest time from a key to its effect: a pause in a paste, and a frame of a busy machine.
const ANSWER: Duration = Duration::from_secs(4);

/// Beginnings of sequences and of a paste, without their ends.
fn unfinished() -> Vec<String> {
    let short = [
        "\x1b",
        "\x1b[",
        "\x1b[?",
        "\x1b[?1",
        "\x1b[<",
        "\x1b[<5",
        "\x1b[<0;3;",
        "\x1b[M",
        "\x1b[M!",
        "\x1b[[",
        "\x1b[1;",
        "\x1bO",
        "\x1b]",
        "\x1b]11;rgb:",
        "\x1bP",
        "\x1b_",
        "\x1b[200~abc",
        "\x1b[200~abc\x1b[20",
    ];
    let digits = "5".repeat(200_000);
    short
        .iter()
        .map(ToString::to_string)
        .chain([format!("\x1b[?{digits}"), format!("\x1b[{digits}")])
        .collect()
}

/// Presses `?` until the help is shown, and closes it again. The first key may still belong to what
/// was cut.
#[track_caller]
fn assert_answers(terminal: &mut Terminal, after: &str) {
    const HELP: &str = "What you see";
    let begun = Instant::now();
    terminal.send("?");
    while !terminal.text().contains(HELP) {
        assert!(
            begun.elapsed() < ANSWER,
            "no answer after {:?}:\n{}",
            &after[..after.len().min(40)],
            terminal.text()
        );
        terminal.is_silent_for(Duration::from_millis(20));
    }
    terminal.send("?");
    terminal.wait_without(HELP);
}

#[test]
fn keys_count_after_each_sequence_that_never_ends() {
    let sequences = unfinished();
    std::thread::scope(|scope| {
        for cuts in sequences.chunks(5) {
            scope.spawn(move || {
                let (program, _folder) = explorer();
                let mut terminal = paused(program);
                for cut in cuts {
                    assert_counts_after(&mut terminal, cut);
                }
                quit(&mut terminal);
            });
        }
    });
}

/// Sends the beginning of a sequence, waits until it is given up, and presses a key.
fn assert_counts_after(terminal: &mut Terminal, cut: &str) {
    terminal.send(cut);
    // A paste is given up after a longer pause.
    let pause = if cut.starts_with("\x1b[200~") {
        1300
    } else {
        300
    };
    sleep(Duration::from_millis(pause));
    assert_answers(terminal, cut);
}

#[test]
fn ctrl_c_ends_the_explorer_at_once_within_each_of_them() {
    std::thread::scope(|scope| {
        for cut in unfinished() {
            scope.spawn(move || {
                let (program, _folder) = explorer();
                let mut terminal = paused(program);
                terminal.send(&cut);
                sleep(Duration::from_millis(20));
                terminal.send(INTERRUPT);
                assert!(
                    terminal.wait_end().success(),
                    "{:?}",
                    &cut[..cut.len().min(40)]
                );
                assert_given_back(&terminal);
            });
        }
    });
}

/// Longest time between two pieces of a key for which the test judges the explorer and not the load
/// of the machine.
const LONGEST_BETWEEN_PIECES: Duration = Duration::from_millis(60);

#[test]
fn a_key_that_arrives_in_two_pieces_is_one_key() {
    let is_judged = (0..10).any(|_| pieces_are_joined());
    assert!(
        is_judged,
        "the machine is too slow to send the pieces of a key in time"
    );
}

/// Sends arrow keys in two pieces. Returns false if the machine was too slow to send two pieces in
/// time.
fn pieces_are_joined() -> bool {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    let marked = |rows: &[String]| rows.iter().position(|row| row.contains('›'));
    terminal.send("g");
    terminal.settle();
    let first = marked(&terminal.rows()).expect("a row is selected");
    let mut expected = first;
    for (key, change) in [
        ("\x1b[B", 1),
        ("\x1bOB", 1),
        ("\x1b[B", 1),
        ("\x1b[A", -1),
        ("\x1bOA", -1),
    ] {
        for split in 1..key.len() {
            let begun = Instant::now();
            terminal.send(&key[..split]);
            sleep(Duration::from_millis(30));
            terminal.send(&key[split..]);
            if begun.elapsed() > LONGEST_BETWEEN_PIECES {
                return false;
            }
            expected = expected.checked_add_signed(change).expect("a row");
            // Any other key than the arrow would move the mark elsewhere or open something.
            terminal.wait("next row selected", |rows| marked(rows) == Some(expected));
        }
    }
    terminal.settle();
    assert_eq!(
        marked(&terminal.rows()),
        Some(expected),
        "{}",
        terminal.text()
    );
    assert_eq!(expected, first + 2);
    quit(&mut terminal);
    true
}

#[test]
fn a_paste_without_its_end_is_not_lost() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    terminal.send("d");
    terminal.wait_for("manual loading");
    terminal.send("\r");
    terminal.wait_for("Press or pull to (");
    terminal.send("\x1b[200~1 mN");
    terminal.wait_for("): 1 mN");
    // A pause shorter than the longest one does not divide a text, as its letters would be keys.
    terminal.send("\x15\x1b[200~2 ");
    sleep(Duration::from_millis(300));
    terminal.send("mN\x1b[201~");
    terminal.wait_for("): 2 mN");
    terminal.send("\x1b");
    terminal.wait_without("Press or pull to (");
    quit(&mut terminal);
}
