//! The explorer over a real connection: a server of its own on the loopback, a client in a terminal, and a count of the
//! bytes sent during the animation.
//!
//! Needs `sshd`, `ssh` and `ssh-keygen`; if one of them is missing the tests report so and end.

use crate::common::terminal::{Frame, Program, Terminal};
use crate::driving::{ASPERITY, headline, select};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Most bytes in a second on a slow connection.
const MOST_BYTES: f64 = 20_000.0;
/// Most frames in a second.
const MOST_FRAMES: f64 = 12.0;

/// Reports a skipped test past the test runner, which hides the output of passing tests.
fn report(note: &str) {
    let _ = writeln!(std::io::stderr(), "{note}");
}

/// A program by its name, on the path or in the administrator's folders of Debian.
fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain([PathBuf::from("/usr/sbin"), PathBuf::from("/sbin")]);
    folders.map(|folder| folder.join(name)).find(|file| file.is_absolute() && file.is_file())
}

/// Output of a command that must succeed.
fn output_of(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

/// Runs a program until its input ends: with the process at the other end, however that process ends.
const WHILE_WANTED: &str = r#""$@" & read -r _; kill $!; wait"#;

/// A server that ends with the test, on any outcome.
struct Server {
    sshd: Child,
    ssh: PathBuf,
    port: u16,
    user: String,
    folder: tempfile::TempDir,
    /// Lines of its log.
    log: Receiver<String>,
}

impl Drop for Server {
    fn drop(&mut self) {
        // The end of its input ends the server; wait for that.
        drop(self.sshd.stdin.take());
        let _ = self.sshd.wait();
    }
}

impl Server {
    /// Starts a server; `None`, and a note, if that is impossible here.
    fn start() -> Option<Server> {
        let [sshd, ssh, keygen] = ["sshd", "ssh", "ssh-keygen"].map(|name| {
            let found = program(name);
            if found.is_none() {
                report(&format!("skipped: there is no {name} (Debian: openssh-server, openssh-client)"));
            }
            found
        });
        let (sshd, ssh, keygen) = (sshd?, ssh?, keygen?);
        let user = output_of(Command::new("id").arg("-un"));
        // As root the server drops its rights in an empty folder that must exist.
        let empty = Path::new("/run/sshd");
        if user == "root" && !empty.exists() && fs::create_dir(empty).is_err() {
            report(&format!("skipped: {} is not there and cannot be made", empty.display()));
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        for name in ["host", "user"] {
            let mut keygen = Command::new(&keygen);
            output_of(keygen.args(["-q", "-t", "ed25519", "-N", "", "-C", name, "-f"]).arg(file(name)));
        }
        fs::copy(file("user.pub"), file("authorized")).unwrap();
        // Free now; if another process takes the port first the test fails and can be run again.
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let config = format!(
            "Port {port}\nListenAddress 127.0.0.1\nHostKey {}\nAuthorizedKeysFile {}\nPidFile none\n\
             UsePAM no\nStrictModes no\nPasswordAuthentication no\nKbdInteractiveAuthentication no\n\
             PermitRootLogin prohibit-password\nPrintMotd no\nPrintLastLog no\nUseDNS no\n",
            file("host").display(),
            file("authorized").display()
        );
        fs::write(file("config"), config).unwrap();
        let host = fs::read_to_string(file("host.pub")).unwrap();
        fs::write(file("known"), format!("[127.0.0.1]:{port} {host}")).unwrap();

        let mut command = Command::new("/bin/sh");
        command.args(["-c", WHILE_WANTED, "sh"]).arg(sshd).args(["-D", "-e", "-f"]).arg(file("config"));
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut sshd = command.spawn().unwrap();
        let lines = BufReader::new(sshd.stderr.take().unwrap()).lines();
        let (sender, log) = channel();
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let server = Server { sshd, ssh, port, user, folder, log };
        server.wait_for_log("Server listening");
        server.is_open().then_some(server)
    }

    /// Waits for a line in the log of the server.
    fn wait_for_log(&self, text: &str) {
        let deadline = Instant::now() + Duration::from_secs(20);
        let mut all = String::new();
        while let Ok(line) = self.log.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            if line.contains(text) {
                return;
            }
            all += &format!("{line}\n");
        }
        panic!("sshd does not say {text}:\n{all}");
    }

    /// Arguments of a client that knows only this server.
    fn arguments(&self) -> Vec<String> {
        let file = |name: &str| self.folder.path().join(name).display().to_string();
        let options = [
            "BatchMode=yes".to_owned(),
            "IdentitiesOnly=yes".to_owned(),
            "StrictHostKeyChecking=yes".to_owned(),
            "LogLevel=ERROR".to_owned(),
            format!("IdentityFile={}", file("user")),
            format!("UserKnownHostsFile={}", file("known")),
        ];
        let mut arguments = vec!["-F".to_owned(), "/dev/null".to_owned()];
        arguments.extend(["-p".to_owned(), self.port.to_string()]);
        arguments.extend(options.into_iter().flat_map(|option| ["-o".to_owned(), option]));
        arguments.push(format!("{}@127.0.0.1", self.user));
        arguments
    }

    /// True if this user may log in at all: an account can be locked to everyone.
    fn is_open(&self) -> bool {
        let output = Command::new(&self.ssh).args(self.arguments()).arg("true").output().unwrap();
        if output.status.success() {
            return true;
        }
        let log: Vec<String> = self.log.try_iter().collect();
        if log.iter().any(|line| line.contains("account is locked") || line.contains("not allowed because")) {
            report(&format!("skipped: {} may not log in here", self.user));
            return false;
        }
        panic!("{}\n{}", String::from_utf8_lossy(&output.stderr), log.join("\n"));
    }

    /// The explorer behind a connection, in a terminal. Its process number is written to a file.
    fn explorer(&self, arguments: &str) -> Terminal {
        let pid = self.pid_file();
        // No file of the user is read or written.
        let home = self.folder.path();
        let remote =
            format!("echo $$ > '{}'; HOME='{}' exec '{ASPERITY}' {arguments}", pid.display(), home.display());
        let mut program = Program::new(&self.ssh).argument("-tt");
        for argument in self.arguments() {
            program = program.argument(argument);
        }
        program.argument(remote).start()
    }

    fn pid_file(&self) -> PathBuf {
        self.folder.path().join("pid")
    }
}

/// Frames in the fullest second.
fn fullest_second(frames: &[Frame]) -> usize {
    let within = |start: &Frame| {
        let later = frames.iter().skip_while(|frame| frame.arrived < start.arrived);
        later.take_while(|frame| frame.arrived - start.arrived < Duration::from_secs(1)).count()
    };
    frames.iter().map(within).max().unwrap_or(0)
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn a_whole_loop_is_edited_and_played_over_a_slow_line() {
    let Some(server) = Server::start() else { return };
    let mut terminal = server.explorer("pressure-sensitive");
    terminal.wait_for("F_a ");
    terminal.send(".");
    terminal.settle();

    // An edit: the force of the first leg, from 10 µN to 2 µN.
    let before = headline(&terminal.rows()).unwrap();
    select(&mut terminal, "force of stage");
    terminal.send("e");
    terminal.wait_for("Esc cancel");
    terminal.send("\x152 µN\r");
    terminal.wait("other force", |rows| headline(rows).is_some_and(|now| now != before));
    terminal.settle();

    // Approach and retraction, from the start to the end: twelve seconds.
    let (start, first) = (terminal.written().len(), terminal.frames().len());
    let begun = Instant::now();
    terminal.send("r");
    // Until a pause longer than between any two frames.
    terminal.settle_for(Duration::from_millis(1500));
    let frames = &terminal.frames()[first..];
    let seconds = frames.last().unwrap().arrived.duration_since(begun).as_secs_f64();
    let bytes = terminal.written().len() - start;
    let rate = bytes as f64 / seconds;
    println!("{bytes} bytes in {} frames and {seconds:.2} s: {rate:.0} B/s", frames.len());
    assert!(seconds > 11.0, "a leg takes six seconds: {seconds} s");
    assert!(rate < MOST_BYTES, "{rate} B/s");
    assert!(frames.len() > 60, "it plays: {} frames", frames.len());
    assert!(frames.len() as f64 <= MOST_FRAMES * seconds + 2.0, "{} frames in {seconds} s", frames.len());
    assert!(fullest_second(frames) <= 14, "{} frames in a second", fullest_second(frames));

    terminal.send("q");
    terminal.wait_for("unsaved changes");
    terminal.send("q");
    assert!(terminal.wait_end().success(), "{}", terminal.text());
    assert!(!terminal.screen().alternate_screen() && !terminal.screen().hide_cursor());
    assert!(terminal.text().contains("adhesion force F_a"), "{}", terminal.text());
    assert!(terminal.is_as_before());
}

#[test]
fn a_held_key_does_not_flood_a_slow_line() {
    let Some(server) = Server::start() else { return };
    let mut terminal = server.explorer("pressure-sensitive");
    terminal.wait_for("F_a ");
    terminal.send(".");
    terminal.settle();
    let (start, first) = (terminal.written().len(), terminal.frames().len());
    let begun = Instant::now();
    // As from a keyboard that repeats a held key: thirty in a second, for three seconds.
    for key in 1..=90 {
        terminal.send("]");
        let next = begun + Duration::from_secs(key) / 30;
        terminal.take_until(next);
    }
    let frames = terminal.frames().len() - first;
    let bytes = terminal.written().len() - start;
    println!("{bytes} bytes in {frames} frames in 3 s of a held key");
    assert!(frames as f64 <= 3.0 * MOST_FRAMES + 4.0, "{frames} frames in 3 s");
    assert!(bytes as f64 / 3.0 < MOST_BYTES, "{bytes} bytes in 3 s");
    // The last key also has its effect at once.
    terminal.settle();
    assert!(terminal.text().contains("manual: d "), "{}", terminal.text());
    terminal.send("q");
    assert!(terminal.wait_end().success());
}
