//! Gives the terminal back when the process ends without doing so: killed, out of memory, or while the terminal
//! takes nothing.
//!
//! No code of a process that is killed runs any more, so another one waits for its end: a shell, which is there
//! wherever terminals are, and which costs some milliseconds at the start. It has a process group of its own
//! and ignores the signals of the terminal, so that it may set a terminal that a shell has taken back meanwhile.

/// Sequence that ends an incomplete frame and resets all modes of the terminal.
#[cfg(unix)]
const RESTORE: &str =
    "\x18\x1b[?2026l\x1b[0m\x1b[?1006l\x1b[?1002l\x1b[?1000l\x1b[?2004l\x1b[?1049l\x1b[?25h";

/// Keeps the attributes of the terminal, reads one state after the other, and restores where the last one says
/// that the terminal is taken.
#[cfg(unix)]
const SCRIPT: &str = r#"trap '' HUP INT QUIT TERM TSTP TTIN TTOU
saved=$(stty -g <&2) || exit 1
echo ready
exec >&-
state=
while read -r line; do state=$line; done
[ "$state" = taken ] || exit 0
stty "$saved" <&2
printf '%s' "$1" >&2"#;

/// A process that waits for the end of this one.
#[cfg(unix)]
pub struct Rescue {
    child: std::process::Child,
    states: Option<std::process::ChildStdin>,
}

#[cfg(unix)]
impl Rescue {
    /// Starts the process, before anything about the terminal is changed; `None` where that is not possible, and
    /// nothing gives the terminal back then.
    pub fn start() -> Option<Rescue> {
        use rustix::event::{PollFd, PollFlags, Timespec, poll};
        use std::io::Read;
        use std::os::fd::AsFd;
        use std::os::unix::process::CommandExt;
        use std::process::{Command, Stdio};
        /// Longest time until it is ready: on a machine that is that slow it is done without.
        const PATIENCE: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };
        let terminal = std::io::stdout().as_fd().try_clone_to_owned().ok()?;
        let mut child = Command::new("/bin/sh")
            .args(["-c", SCRIPT, "asperity", RESTORE])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(terminal)
            .process_group(0)
            .spawn()
            .ok()?;
        let states = child.stdin.take();
        let answer = child.stdout.take();
        let rescue = Rescue { child, states };
        let mut answer = answer?;
        let mut waited = [PollFd::new(&answer, PollFlags::IN)];
        let is_ready = poll(&mut waited, Some(&PATIENCE)).is_ok_and(|ready| ready > 0);
        (is_ready && answer.read(&mut [0; 16]).is_ok_and(|bytes| bytes > 0)).then_some(rescue)
    }

    /// Notes whether the terminal is taken.
    pub fn note(&mut self, is_taken: bool) {
        use std::io::Write;
        let state: &[u8] = if is_taken { b"taken\n" } else { b"given back\n" };
        if let Some(states) = &mut self.states {
            // Where the process is gone it is done without.
            let _ = states.write_all(state);
        }
    }
}

#[cfg(unix)]
impl Drop for Rescue {
    fn drop(&mut self) {
        self.states = None;
        let _ = self.child.wait();
    }
}

/// Elsewhere there is none.
#[cfg(not(unix))]
pub struct Rescue;

#[cfg(not(unix))]
impl Rescue {
    /// None.
    pub fn start() -> Option<Rescue> {
        None
    }

    /// Nothing.
    pub fn note(&mut self, _: bool) {}
}
