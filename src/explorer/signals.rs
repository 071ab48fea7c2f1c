//! Signals that the explorer handles; before a signal ends it, the terminal is restored.

use std::io;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemSignal {
    /// Request to end, with the number of the signal.
    End(i32),
    /// Continuation after the process was stopped.
    Continue,
    /// The window has another size.
    Resize,
}

/// Calls `report` when a signal asks the process to end, continues it, or announces another size of
/// the window; `report` returns false once nobody receives.
///
/// If the explorer has not ended some time after the request, for example because the terminal
/// accepts no output, the process ends by the signal, with the attributes of the terminal restored.
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
                        // The explorer has ended, and its caller continues or ends by itself.
                        continue;
                    }
                    let _ = crossterm::terminal::disable_raw_mode();
                }
                end_by(signal);
            }
        })
        .map(drop)
}

/// Other systems have no such signals.
#[cfg(not(unix))]
pub fn watch_for_signals(_: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Ends the process by the default action of a signal, so that its parent sees the signal.
#[cfg(unix)]
pub fn end_by(signal: i32) {
    // Returns only for a signal that ends nothing.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}

#[cfg(not(unix))]
pub fn end_by(_: i32) {}
