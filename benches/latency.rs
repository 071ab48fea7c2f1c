//! Time of the explorer from a key to the frame with its effect, at 2^20 springs; the same on a
//! small scene over SSH beside a local terminal, with the frames of a key; and bytes written by its
//! animation. The program itself is measured, in a pseudo-terminal of 120 x 40.
//!
//! `cargo bench --bench latency` prints the tables; `-- --quick` repeats each key less often and
//! plays no loop to its end, `-- --runs 100` sets the number of repetitions, `-- --program PATH`
//! measures another executable, `-- --ssh` prints only the table over SSH. Without `--bench`, as
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

    /// Executable that is measured unless another one is named.
    const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");
    /// Variable by which the explorer knows a connection over SSH.
    const CONNECTION: (&str, &str) = ("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22");
    const SPRINGS: &str = "million-springs";
    const SMALL: &str = "pressure-sensitive";

    /// Longest times, in milliseconds: a visible reaction to a key; a change that keeps the line;
    /// one that makes it anew.
    const ECHO: f64 = 16.0;
    const EDIT: f64 = 50.0;
    const NEW_LINE: f64 = 150.0;

    /// Longest additional time from a key to its answer over SSH, ms, and most frames of a key: one
    /// with its answer and one with the results of the studies, and two more on a busy machine.
    const MORE_OVER_SSH: f64 = 20.0;
    const MOST_FRAMES: f64 = 4.0;

    /// Pause without output after the last result of the studies.
    const REST: Duration = Duration::from_millis(400);

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
        // The last case, because the scene then adheres so strongly that F_a hardly depends on the
        // numbers above.
        Case {
            what: "work of adhesion, small step",
            row: WORK,
            keys: ["l", "h"],
            bar: EDIT,
        },
    ];

    /// A key whose answers over SSH and in a local terminal are compared.
    struct Compared {
        what: &'static str,
        /// The selected row in the list; empty if the key needs none.
        row: &'static str,
        /// Keys, in turn.
        keys: [&'static str; 2],
        /// Returns the part of the screen that the answer changes.
        shown: fn(&[String]) -> Option<String>,
    }

    const COMPARED: [Compared; 6] = [
        Compared {
            what: "E, small step",
            row: "Young's modulus",
            keys: ["l", "h"],
            shown: force,
        },
        Compared {
            what: "force of the first stage, small step",
            row: "force of stage",
            keys: ["l", "h"],
            shown: force,
        },
        Compared {
            what: "Hurst exponent, small step",
            row: "Hurst exponent",
            keys: ["h", "l"],
            shown: force,
        },
        Compared {
            what: "seed, next",
            row: "seed",
            keys: ["l", "h"],
            shown: force,
        },
        Compared {
            what: "random seed",
            row: "seed",
            keys: ["R", "R"],
            shown: force,
        },
        Compared {
            what: "next jump of the timeline",
            row: "",
            keys: [",", ";"],
            shown: playhead,
        },
    ];

    struct Options {
        program: String,
        runs: usize,
        plays: bool,
        /// True if only keys over SSH are measured, beside the same keys in a local terminal.
        is_over_ssh: bool,
        scene: &'static str,
    }

    impl Options {
        fn from_arguments() -> Self {
            let arguments: Vec<String> = std::env::args().skip(1).collect();
            let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
            let program = value_behind(&arguments, "--program").unwrap_or(ASPERITY);
            let program = program.to_owned();
            if has("--test") || !has("--bench") {
                return Options {
                    program,
                    runs: 2,
                    plays: false,
                    is_over_ssh: false,
                    scene: SMALL,
                };
            }
            let quick = has("--quick");
            let runs = value_behind(&arguments, "--runs").and_then(|runs| runs.parse().ok());
            let runs: usize = runs.unwrap_or(if quick { 8 } else { 40 });
            Options {
                program,
                runs: runs.max(2),
                plays: !quick && !has("--ssh"),
                is_over_ssh: has("--ssh"),
                scene: SPRINGS,
            }
        }
    }

    /// Returns the argument behind a flag.
    fn value_behind<'a>(arguments: &'a [String], flag: &str) -> Option<&'a str> {
        let place = arguments.iter().position(|argument| argument == flag)?;
        Some(arguments.get(place + 1)?)
    }

    pub fn main() {
        let options = Options::from_arguments();
        if !options.is_over_ssh {
            measure_keys(&options);
            println!();
        }
        compare(&options);
        if options.plays {
            println!();
            play(Program::new(&options.program), "locally");
            play(remote(&options.program), "over SSH");
        }
    }

    /// Prints the times from keys to the frames with their effects.
    fn measure_keys(options: &Options) {
        println!(
            "{}, 120 x 40, paused; {} keys each; ms from the key to the end of the frame",
            options.scene, options.runs
        );
        println!(
            "{:<36} {:>8} {:>8} {:>8} {:>6}",
            "key", "p50", "p99", "max", "bar"
        );
        let mut terminal = opened(Program::new(&options.program).argument(options.scene));
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
        leave(terminal);
    }

    fn remote(program: &str) -> Program {
        let (name, value) = CONNECTION;
        Program::new(program).env(name, value)
    }

    /// Leaves an explorer with unsaved changes.
    fn leave(mut terminal: Terminal) {
        terminal.send("q");
        terminal.wait_for("unsaved changes");
        terminal.send("q");
        terminal.wait_end();
    }

    /// Prints the times from keys to their answers over SSH and in a local terminal, and the median
    /// and the largest number of frames of a key over SSH. Both explorers get the same keys in
    /// turn, so that a load of the machine slows down both.
    fn compare(options: &Options) {
        println!(
            "{SMALL}, 120 x 40; {} keys each; ms from the key to the end of the frame with its answer",
            options.runs
        );
        println!(
            "{:<36} {:>17} {:>17} {:>6} {:>13}",
            "", "local terminal", "over SSH", "", "frames of SSH"
        );
        println!(
            "{:<36} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6}",
            "key", "p50", "p90", "p50", "p90", "bar", "p50", "most"
        );
        let mut local = opened(Program::new(&options.program).argument(SMALL));
        let mut over_ssh = opened(remote(&options.program).argument(SMALL));
        for key in &COMPARED {
            let mut times = [Vec::new(), Vec::new()];
            let mut frames = [Vec::new(), Vec::new()];
            for terminal in [&mut local, &mut over_ssh] {
                if !key.row.is_empty() {
                    select(terminal, key.row);
                }
            }
            for run in 0..options.runs {
                let is_back = run >= options.runs / 2;
                let pressed = key.keys[usize::from(is_back)];
                for (place, terminal) in [&mut local, &mut over_ssh].into_iter().enumerate() {
                    terminal.settle_for(REST);
                    let first = terminal.frames().len();
                    let before = (key.shown)(&terminal.rows());
                    times[place].push(time(terminal, pressed, |rows| {
                        (key.shown)(rows) != before && !is_computing(rows)
                    }));
                    terminal.wait_without("± …");
                    terminal.settle_for(REST);
                    frames[place].push((terminal.frames().len() - first) as f64);
                }
            }
            report_compared(key.what, &times, &frames[1]);
        }
        leave(local);
        leave(over_ssh);
    }

    fn report_compared(what: &str, times: &[Vec<f64>; 2], frames: &[f64]) {
        let [local, over_ssh] = times.each_ref().map(|times| sorted(times));
        let frames = sorted(frames);
        let bar = quantile(&local, 0.5) + MORE_OVER_SSH;
        let (median, most) = (quantile(&frames, 0.5), quantile(&frames, 1.0));
        let holds = if quantile(&over_ssh, 0.5) <= bar && most <= MOST_FRAMES {
            "holds"
        } else {
            "does NOT hold"
        };
        println!(
            "{what:<36} {:>8.1} {:>8.1} {:>8.1} {:>8.1} {bar:>6.0} {median:>6.0} {most:>6.0}  {holds}",
            quantile(&local, 0.5),
            quantile(&local, 0.9),
            quantile(&over_ssh, 0.5),
            quantile(&over_ssh, 0.9),
        );
    }

    /// Returns the pull-off force of the shown profile and the preload.
    fn force(rows: &[String]) -> Option<String> {
        headline(rows).map(|texts| texts.concat())
    }

    /// Returns the indentation and the force at the playhead.
    fn playhead(rows: &[String]) -> Option<String> {
        let row = rows.iter().find(|row| row.contains("◆ d "))?;
        Some(row.split_once("◆ d ")?.1.to_owned())
    }

    /// The explorer after it has computed a scene, with its animation paused.
    fn opened(program: Program) -> Terminal {
        let mut terminal = program.start();
        terminal.wait_for("F_a ");
        terminal.send("!");
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
            terminal.send("\r");
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

    /// Pull-off force of the shown profile in the status line, and preload at its mark on the
    /// curve, at least one of which each edit changes.
    fn headline(rows: &[String]) -> Option<[String; 2]> {
        let row = rows
            .iter()
            .rev()
            .find(|row| row.contains("F_a ") && row.contains(" · "))?;
        let force = text_behind(row, "this profile ").or_else(|| text_behind(row, "F_a "))?;
        let preload = rows.iter().find_map(|row| {
            let text = text_behind(row, "preload ")?;
            text.starts_with(|sign: char| sign.is_ascii_digit())
                .then_some(text)
        });
        Some([force, preload.unwrap_or_default()])
    }

    /// Returns the text behind a name in a row, up to the next sign that separates results.
    fn text_behind(row: &str, name: &str) -> Option<String> {
        let (_, text) = row.split_once(name)?;
        let text = text.split([',', '·', '▲']).next()?;
        Some(text.trim().to_owned())
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
    fn play(program: Program, place: &str) {
        let mut terminal = program.start();
        terminal.wait_for("F_a ");
        terminal.send("!");
        terminal.settle_for(2 * QUIET);
        let (start, first) = (terminal.written().len(), terminal.frames().len());
        let begun = Instant::now();
        terminal.send(" ");
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
            "approach and retraction of {SMALL}, {place}: {} frames in {seconds:.1} s ({:.1}/s); bytes in a frame: \
             median {:.0}, p99 {:.0}, max {:.0}; {:.0} B/s",
            frames.len(),
            frames.len() as f64 / seconds,
            quantile(&sizes, 0.5),
            quantile(&sizes, 0.99),
            quantile(&sizes, 1.0),
            bytes as f64 / seconds
        );
    }
}
