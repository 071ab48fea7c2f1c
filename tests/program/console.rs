//! Console blocks of the documentation and of `tests/program/commands` are what the program prints.
//!
//! The commands of a page run one after the other in a folder of their own, by a shell with the
//! program first in its search path. A line `? N` after a command is an exit code other than 0,
//! `[..]` is any text, for what changes from run to run, `> ` continues a command. `<!-- setup`
//! begins commands that no reader needs, up to `-->`. Blocks of `sh` that begin with the program
//! must succeed, unless a comment is directly above them.
//!
//! `UPDATE_DOCS=1 cargo test --test program console` writes all blocks anew.

use super::generated::{alone, pages_in, read, root, updating};
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;

/// Runs a script in a folder.
fn shell(script: &str, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_asperity"))
        .parent()
        .unwrap()
        .to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths([program].into_iter().chain(std::env::split_paths(&path))).unwrap();
    let mut shell = Command::new("sh");
    shell
        .args(["-c", script])
        .current_dir(folder)
        .stdin(Stdio::null())
        .env("PATH", path);
    shell
        .env("ROOT", root())
        .env("HOME", "/home/user")
        .env("LC_ALL", "C.UTF-8");
    shell
        .env_remove("XDG_CONFIG_HOME")
        .env_remove("COLUMNS")
        .output()
        .unwrap()
}

/// Output and messages of a script in their order, after its exit code where that is not 0.
fn printed(script: &str, folder: &Path) -> String {
    let output = shell(&format!("exec 2>&1\n{script}"), folder);
    let text = String::from_utf8(output.stdout).unwrap();
    let text = if text.is_empty() || text.ends_with('\n') {
        text
    } else {
        text + "\n"
    };
    match output.status.code() {
        Some(0) => text,
        code => format!(
            "? {}\n{text}",
            code.map_or("killed".to_owned(), |code| code.to_string())
        ),
    }
}

/// True if a line is as stated, with any text in place of `[..]`.
fn is_like(stated: &str, line: &str) -> bool {
    let mut parts = stated.split("[..]");
    let Some(mut rest) = line.strip_prefix(parts.next().unwrap_or_default()) else {
        return false;
    };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else {
        return rest.is_empty();
    };
    for part in parts {
        let Some((_, after)) = rest.split_once(part) else {
            return false;
        };
        rest = after;
    }
    rest.ends_with(last)
}

/// The output with the stated lines in place of those that are like them.
fn with_placeholders(output: &str, stated: &[&str]) -> String {
    let of = |line: &str| match stated.iter().find(|stated| is_like(stated, line)) {
        Some(placeholder) if !stated.contains(&line) => format!("{placeholder}\n"),
        _ => format!("{line}\n"),
    };
    output.lines().map(of).collect()
}

/// Commands of a console block, each with its stated output.
fn commands(block: &str) -> Vec<(String, Vec<&str>)> {
    let mut commands: Vec<(String, Vec<&str>)> = Vec::new();
    for line in block.lines() {
        match (
            line.strip_prefix("$ "),
            line.strip_prefix("> "),
            commands.last_mut(),
        ) {
            (Some(command), ..) => commands.push((command.to_owned(), Vec::new())),
            (_, Some(more), Some((command, stated))) if stated.is_empty() => {
                *command += &format!("\n{more}")
            }
            (_, _, Some((_, stated))) => stated.push(line),
            (_, _, None) => panic!("{line:?} is above the first command"),
        }
    }
    commands
}

/// The page as its commands print it.
fn run_page(page: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let must_succeed = |script: &str| {
        let output = shell(&format!("set -e\n{script}"), folder.path());
        assert!(
            output.status.success(),
            "{page}: {script}\n{}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    let (text, mut written) = (read(page), String::new());
    let mut lines = text.split_inclusive('\n');
    let mut above = "";
    while let Some(line) = lines.next() {
        written += line;
        let is_setup = line == "<!-- setup\n";
        if is_setup || line.starts_with("```") {
            let block: String = lines
                .by_ref()
                .take_while(|line| !line.starts_with(if is_setup { "-->" } else { "```" }))
                .collect();
            let is_checked_elsewhere = above.starts_with("<!-- ") && above.ends_with("-->\n");
            if line == "```console\n" {
                for (command, stated) in commands(&block) {
                    let found = with_placeholders(&printed(&command, folder.path()), &stated);
                    write!(written, "$ {}\n{found}", command.replace('\n', "\n> ")).unwrap();
                }
            } else {
                if is_setup
                    || line == "```sh\n" && block.starts_with("asperity") && !is_checked_elsewhere
                {
                    must_succeed(&block);
                }
                written += &block;
            }
            written += if is_setup { "-->\n" } else { "```\n" };
        }
        above = line;
    }
    written
}

#[test]
fn consoles_print_what_the_program_prints() {
    let _alone = updating().then(alone);
    let pages = [
        pages_in("docs"),
        pages_in("tests/program/commands"),
        vec!["README.md".to_owned()],
    ]
    .concat();
    let check = |page: &String| {
        let (text, written) = (read(page), run_page(page));
        if updating() {
            std::fs::write(root().join(page), written).unwrap();
            return String::new();
        }
        let first = text
            .lines()
            .zip(written.lines())
            .position(|(one, other)| one != other);
        let from = first.unwrap_or(text.lines().count().min(written.lines().count()));
        let part = |text: &str| {
            text.lines()
                .skip(from.saturating_sub(3))
                .take(8)
                .collect::<Vec<_>>()
                .join("\n")
        };
        let differs = || {
            format!(
                "{page}:{}\nstates\n{}\nis\n{}\n",
                from + 1,
                part(&text),
                part(&written)
            )
        };
        if text == written {
            String::new()
        } else {
            differs()
        }
    };
    let (next, differences) = (Mutex::new(pages.iter()), Mutex::new(String::new()));
    let take = || next.lock().unwrap().next();
    let work = || {
        while let Some(page) = take() {
            // The lock is not taken while a page is checked.
            let found = check(page);
            *differences.lock().unwrap() += &found;
        }
    };
    std::thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(work))));
    let differences = differences.into_inner().unwrap();
    assert!(
        differences.is_empty(),
        "UPDATE_DOCS=1 writes the blocks anew\n{differences}"
    );
}
