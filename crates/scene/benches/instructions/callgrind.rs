//! Running this program again under callgrind, and reading its counts.

use std::collections::{BTreeMap, HashMap};
use std::process::{Command, Stdio};

/// Instructions by file and line.
pub struct Profile {
    lines: HashMap<String, BTreeMap<u64, u64>>,
}

impl Profile {
    /// All instructions, of all threads.
    pub fn total(&self) -> u64 {
        self.lines.values().flat_map(BTreeMap::values).sum()
    }

    /// True if instructions are attributed to lines of this project, which requires line tables.
    pub fn has_line_tables(&self) -> bool {
        self.lines
            .keys()
            .any(|file| file.contains("scene/src/simulation/"))
    }

    /// Files as named by the compiler, with the instructions of their lines.
    pub fn files(&self) -> impl Iterator<Item = (&str, &BTreeMap<u64, u64>)> {
        self.lines
            .iter()
            .map(|(file, lines)| (file.as_str(), lines))
    }

    /// Reads the uncompressed output of callgrind. Inlined code is listed under the file of its
    /// source (`fi`, `fe`); after `calls` follows the cost of the called function, which is counted
    /// there.
    fn parse(text: &str) -> Profile {
        let mut lines: HashMap<String, BTreeMap<u64, u64>> = HashMap::new();
        let mut file = "";
        let mut of_call = false;
        for line in text.lines() {
            if let Some(("fl" | "fi" | "fe", name)) = line.split_once('=') {
                file = name;
            } else if line.starts_with("calls=") {
                of_call = true;
            } else if line.starts_with(|c: char| c.is_ascii_digit()) {
                let mut numbers = line.split(' ').map(|number| number.parse::<u64>());
                if let (false, Some(Ok(number)), Some(Ok(cost))) =
                    (of_call, numbers.next(), numbers.next())
                {
                    *lines
                        .entry(file.to_string())
                        .or_default()
                        .entry(number)
                        .or_default() += cost;
                }
                of_call = false;
            }
        }
        Profile { lines }
    }
}

/// True if valgrind is installed.
pub fn is_there() -> bool {
    let version = Command::new("valgrind")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    version.is_ok_and(|status| status.success())
}

/// Runs this program under callgrind.
pub fn profile(arguments: &[&str], environment: &[(&str, &str)]) -> Profile {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("profile");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--compress-strings=no", "--compress-pos=no", "--dump-line=yes"])
        // Where glibc copies and clears memory by one repeated instruction, each byte would count
        // as an instruction.
        .env(
            "GLIBC_TUNABLES",
            "glibc.cpu.x86_rep_movsb_threshold=1073741824:glibc.cpu.x86_rep_stosb_threshold=1073741824",
        )
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(std::env::current_exe().expect("this program"))
        .args(arguments)
        .envs(environment.iter().copied())
        .output()
        .expect("valgrind");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "valgrind: {message}");
    let text = String::from_utf8_lossy(&std::fs::read(file).expect("a profile")).into_owned();
    let profile = Profile::parse(&text);
    let stated = text
        .lines()
        .find_map(|line| line.strip_prefix("totals: ")?.trim().parse().ok());
    assert_eq!(Some(profile.total()), stated, "all counts are read");
    profile
}
