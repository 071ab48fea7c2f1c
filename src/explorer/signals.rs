//! Signals that the explorer handles. If a signal ends the explorer, the explorer restores the
//! terminal first.

use std::io;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemSignal {
    /// The signal with this number asks the process to end.
    End(i32),
    /// The process continues after it was stopped, for example by Ctrl-Z.
    Continue,
    /// The size of the window has changed.
    Resize,
}

/// Calls `report` on a new thread when a signal arrives. The signal asks the process to end,
/// continues the process, or announces another size of the window. `report` returns false if the
/// receiver of the signals has ended.
///
/// After a signal to end, the explorer may not end soon, for example if the terminal accepts no
/// output. The thread then restores the attributes of the terminal, and ends the process by the
/// signal.
#[cfg(unix)]
pub fn watch_for_signals(report: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGWINCH};
    const PATIENCE: std::time::Duration = std::time::Duration::from_millis(800);
    let mut signals =
        signal_hook::iterator::Signals::new([SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGWINCH])?;
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            for signal in signals.forever() {
                if let SIGCONT | SIGWINCH = signal {
                    let is_size = signal == SIGWINCH;
                    report(if is_size {
                        SystemSignal::Resize
                    } else {
                        SystemSignal::Continue
                    });
                    continue;
                }
                if report(SystemSignal::End(signal)) {
                    std::thread::sleep(PATIENCE);
                    if !report(SystemSignal::End(signal)) {
                        // The explorer has ended in the meantime. The code that started it decides
                        // whether the process continues.
                        continue;
                    }
                    let _ = crossterm::terminal::disable_raw_mode();
                }
                end_by(signal);
            }
        })
        .map(drop)
}

/// Does nothing: these signals exist only on Unix, so that there is nothing to watch on other
/// systems.
#[cfg(not(unix))]
pub fn watch_for_signals(_: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Ends the process in the way in which the signal `signal` ends a process by default. The parent
/// process can then see which signal it was.
#[cfg(unix)]
pub fn end_by(signal: i32) {
    // The call returns only if the signal does not end the process by default.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}

#[cfg(not(unix))]
pub fn end_by(_: i32) {}
