//! Time of the explorer from a key to the frame with its effect, at 2^20 springs, and bytes written
//! by its animation. The program itself is measured, in a pseudo-terminal of 120 x 40.
//!
//! `cargo bench --bench latency` prints the tables; `-- --quick` repeats each key less often and
//! plays no loop to its end, `-- --runs 100` sets the number of repetitions. Without `--bench`, as
//! started by `cargo test --benches`, it only checks that it runs, on a small scene.

#[cfg(unix)]
#[path = "../tests/common/terminal.rs"]
mod terminal;

#[cfg(unix)]
fn main() {
    measure::main();
}

#[cfg(not(unix))]
fn main() {
    println!("not measured: only a Unix system has the terminals this needs");
}

#[cfg(unix)]
mod measure {
    use super::terminal::{Frame, Program, Terminal};
    use std::time::{Duration, Instant};

    const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");
    const SPRINGS: &str = "million-springs";
    const SMALL: &str = "pressure-sensitive";

    /// Longest times, in milliseconds: a visible reaction to a key; a change that keeps the line;
    /// one that makes it anew.
    const ECHO: f64 = 16.0;
    const EDIT: f64 = 50.0;
    const NEW_LINE: f64 = 150.0;

    /// Pause without output after which the next key is sent.
    const QUIET: Duration = Duration::from_millis(120);

    /// A typed work of adhesion, J/m²: from the third digit on each character gives another curve.
    const VALUE: &str = "0.0123456";

    /// Row that is computed from κ until adhesion is given by work.
    const WORK: &str = "work of adhesion";

    /// A measured edit and its longest time.
    struct Case {
        what: &'static str,
        /// Its row in the list.
        row: &'static str,
        /// Keys of the edit, in turn: the scene walks there and back and seldom meets an earlier
        /// one.
        keys: [&'static str; 2],
        bar: f64,
    }

    const CASES: [Case; 7] = [
        Case {
            what: "E, small step",
            row: "Young's modulus",
            keys: ["l", "h"],
            bar: EDIT,
        },
        Case {
            what: "kappa, small step",
            row: "roughness-adhesion parameter",
            keys: ["h", "l"],
            bar: EDIT,
        },
        Case {
            what: "work of adhesion, small step",
            row: WORK,
            keys: ["l", "h"],
            bar: EDIT,
        },
        Case {
            what: "force of the first stage, small step",
            row: "force of stage",
            keys: ["h", "l"],
            bar: EDIT,
        },
        Case {
            what: "Hurst exponent, small step",
            row: "Hurst exponent",
            keys: ["l", "h"],
            bar: NEW_LINE,
        },
        Case {
            what: "seed, next",
            row: "seed",
            keys: ["l", "h"],
            bar: NEW_LINE,
        },
        Case {
            what: "points N, halved and doubled",
            row: "points",
            keys: ["h", "l"],
            bar: NEW_LINE,
        },
    ];

    struct Options {
        runs: usize,
        plays: bool,
        scene: &'static str,
    }

    impl Options {
        fn from_arguments() -> Self {
            let arguments: Vec<String> = std::env::args().skip(1).collect();
            let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
            if has("--test") || !has("--bench") {
                return Options {
                    runs: 2,
                    plays: false,
                    scene: SMALL,
                };
            }
            let quick = has("--quick");
            let place = arguments.iter().position(|argument| argument == "--runs");
            let runs = place.and_then(|place| arguments.get(place + 1)?.parse().ok());
            let runs: usize = runs.unwrap_or(if quick { 8 } else { 40 });
            Options {
                runs: runs.max(2),
                plays: !quick,
                scene: SPRINGS,
            }
        }
    }

    pub fn main() {
        let options = Options::from_arguments();
        println!(
            "{}, 120 x 40, paused; {} keys each; ms from the key to the end of the frame",
            options.scene, options.runs
        );
        println!(
            "{:<36} {:>8} {:>8} {:>8} {:>6}",
            "key", "p50", "p99", "max", "bar"
        );
        let mut terminal = opened(options.scene);
        report(
            "selecting: the key is seen",
            &echoes(&mut terminal, options.runs),
            ECHO,
        );
        report(
            "typing a value: the digit is seen",
            &digits(&mut terminal, options.runs),
            ECHO,
        );
        for case in &CASES {
            let (echo, done) = edits(&mut terminal, case, options.runs);
            report(case.what, &done, case.bar);
            report("  the key is seen", &echo, ECHO);
        }
        terminal.send("q");
        terminal.wait_for("unsaved changes");
        terminal.send("q");
        terminal.wait_end();
        if options.plays {
            println!();
            play(None);
            play(Some(("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22")));
        }
    }

    /// The explorer after it has computed a scene, with its animation paused.
    fn opened(scene: &str) -> Terminal {
        let mut terminal = Program::new(ASPERITY).argument(scene).start();
        terminal.wait_for("F_a ");
        terminal.send(".");
        terminal.settle_for(2 * QUIET);
        terminal
    }

    /// Times from a key of selection to the frame with the new selection, ms.
    fn echoes(terminal: &mut Terminal, runs: usize) -> Vec<f64> {
        let mut times = Vec::new();
        for run in 0..runs {
            let before = selected(&terminal.rows());
            let key = if run / 10 % 2 == 0 { "j" } else { "k" };
            times.push(time(terminal, key, |rows| selected(rows) != before));
            terminal.settle_for(QUIET);
        }
        times
    }

    /// Times from a digit of a value to the frame with it, ms, while curves of the values typed so
    /// far are computed.
    fn digits(terminal: &mut Terminal, runs: usize) -> Vec<f64> {
        select(terminal, "work of adhesion");
        let mut times = Vec::new();
        while times.len() < runs {
            terminal.send("e");
            terminal.settle_for(QUIET);
            let mut typed = ": ".to_owned();
            for digit in VALUE.split_inclusive(|_: char| true) {
                typed.push_str(digit);
                times.push(time(terminal, digit, |rows| {
                    selected(rows).is_some_and(|row| row.contains(&typed))
                }));
            }
            terminal.send("\x1b");
            terminal.settle_for(QUIET);
        }
        times
    }

    /// Times from a key of an edit to the first frame after it, and to the one with the new loop,
    /// ms.
    fn edits(terminal: &mut Terminal, case: &Case, runs: usize) -> (Vec<f64>, Vec<f64>) {
        if case.row == WORK {
            select(terminal, "adhesion");
            terminal.send("h");
            terminal.wait_for("by work of adhesion");
            terminal.settle_for(QUIET);
        }
        select(terminal, case.row);
        let (mut echo, mut done) = (Vec::new(), Vec::new());
        for run in 0..runs {
            // N is set back at once: far from it the line is another.
            let leaves = if case.row == "points" {
                run % 2 == 0
            } else {
                run < runs / 2
            };
            let key = case.keys[usize::from(!leaves)];
            let before = terminal.rows();
            let frames = terminal.frames().len();
            let start = Instant::now();
            let time = time(terminal, key, |rows| {
                // The same line with other springs has the same figures, or nearly so.
                let is_recomputed = case.row == "points" || headline(rows) != headline(&before);
                is_recomputed && selected(rows) != selected(&before) && !is_computing(rows)
            });
            echo.push(milliseconds(start, terminal.frames()[frames].arrived));
            done.push(time);
            terminal.settle_for(QUIET);
        }
        (echo, done)
    }

    /// Milliseconds from a key to the end of the first frame that satisfies a condition.
    fn time(terminal: &mut Terminal, key: &str, is_there: impl Fn(&[String]) -> bool) -> f64 {
        let start = Instant::now();
        terminal.send(key);
        terminal.wait("outcome of a key", is_there);
        milliseconds(start, terminal.arrived())
    }

    fn milliseconds(start: Instant, end: Instant) -> f64 {
        1e3 * end.duration_since(start).as_secs_f64()
    }

    /// The selected row.
    fn selected(rows: &[String]) -> Option<String> {
        rows.iter().find(|row| row.contains('›')).cloned()
    }

    /// True if the screen states that it shows an older loop.
    fn is_computing(rows: &[String]) -> bool {
        rows.iter().any(|row| row.contains("computing"))
    }

    /// Pull-off force of the shown profile and adhesion coefficient in the status line, one of
    /// which each edit changes.
    fn headline(rows: &[String]) -> Option<[String; 2]> {
        let row = rows
            .iter()
            .rev()
            .find(|row| row.contains("F_a ") && row.contains(" · "))?;
        let behind = |name: &str| {
            Some(
                row.split(name)
                    .nth(1)?
                    .split([',', '·'])
                    .next()?
                    .trim()
                    .to_owned(),
            )
        };
        let force = behind("this profile ").or_else(|| behind("F_a "))?;
        Some([force, behind("F_a/F_n ").unwrap_or_default()])
    }

    /// Selects a parameter by its name, by keys.
    fn select(terminal: &mut Terminal, name: &str) {
        terminal.send("g");
        terminal.settle_for(QUIET);
        loop {
            let before = selected(&terminal.rows());
            let label = before
                .as_deref()
                .and_then(|row| row.split('›').nth(1))
                .unwrap_or_default();
            if label.contains(name) {
                return;
            }
            terminal.send("j");
            terminal.wait("other row selected", |rows| selected(rows) != before);
        }
    }

    /// A quantile of times or sizes, of which there is at least one.
    fn quantile(sorted: &[f64], share: f64) -> f64 {
        asperity::data::quantile(sorted, share).unwrap_or_else(|| panic!("nothing was measured"))
    }

    fn sorted(values: &[f64]) -> Vec<f64> {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        values
    }

    fn report(what: &str, times: &[f64], bar: f64) {
        let times = sorted(times);
        let (median, p99, most) = (
            quantile(&times, 0.5),
            quantile(&times, 0.99),
            quantile(&times, 1.0),
        );
        let holds = if p99 <= bar { "holds" } else { "does NOT hold" };
        println!("{what:<36} {median:>8.1} {p99:>8.1} {most:>8.1} {bar:>6.0}  {holds}");
    }

    /// Plays a whole loop of the default scene and prints the bytes written for it.
    fn play(connection: Option<(&str, &str)>) {
        let mut program = Program::new(ASPERITY);
        if let Some((name, value)) = connection {
            program = program.env(name, value);
        }
        let mut terminal = program.start();
        terminal.wait_for("F_a ");
        terminal.send(".");
        terminal.settle_for(2 * QUIET);
        let (start, first) = (terminal.written().len(), terminal.frames().len());
        let begun = Instant::now();
        terminal.send("r");
        terminal.settle_for(Duration::from_millis(1500));
        let frames: Vec<Frame> = terminal.frames()[first..].to_vec();
        let bytes = terminal.written().len() - start;
        terminal.send("q");
        terminal.wait_end();
        let Some(last) = frames.last() else {
            return println!("nothing was played");
        };
        let seconds = last.arrived.duration_since(begun).as_secs_f64();
        let sizes = sorted(
            &frames
                .iter()
                .map(|frame| frame.bytes as f64)
                .collect::<Vec<_>>(),
        );
        println!(
            "approach and retraction of {SMALL}, {}: {} frames in {seconds:.1} s ({:.1}/s); bytes in a frame: \
             median {:.0}, p99 {:.0}, max {:.0}; {:.0} B/s",
            if connection.is_some() {
                "over SSH"
            } else {
                "locally"
            },
            frames.len(),
            frames.len() as f64 / seconds,
            quantile(&sizes, 0.5),
            quantile(&sizes, 0.99),
            quantile(&sizes, 1.0),
            bytes as f64 / seconds
        );
    }
}
