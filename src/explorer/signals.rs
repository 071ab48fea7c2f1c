//! Signals that the explorer handles. If a signal ends the explorer, the terminal is restored
//! first.

use std::io;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemSignal {
    /// A signal has asked the process to end. The value is the number of the signal.
    End(i32),
    /// The process continues after it was stopped.
    Continue,
    /// The size of the window has changed.
    Resize,
}

/// Calls `report` when a signal asks the process to end, continues it, or announces another size of
/// the window. `report` must return false when nobody receives the signals any more.
///
/// The explorer may be unable to end soon after such a signal, for example if the terminal accepts
/// no output. In this case, the attributes of the terminal are restored, and then the signal ends
/// the process.
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
                        // The explorer has ended in the meantime. Its caller decides whether the
                        // process continues.
                        continue;
                    }
                    let _ = crossterm::terminal::disable_raw_mode();
                }
                end_by(signal);
            }
        })
        .map(drop)
}

/// Other systems do not have these signals.
#[cfg(not(unix))]
pub fn watch_for_signals(_: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Ends the process as the signal does by default, so that the parent process sees the signal.
#[cfg(unix)]
pub fn end_by(signal: i32) {
    // This returns only if the default action of the signal does not end the process.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}

#[cfg(not(unix))]
pub fn end_by(_: i32) {}
