//! The documentation matches the program: tables, pictures, messages, examples and links.
//!
//! After a change of the program, `UPDATE_README=1 cargo test --test program readme` writes the generated parts anew.

mod imports;
mod notices;
mod public_items;
pub mod scenes;

use asperity::explorer::demo::{Demo, ONE_SCENE};
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::explorer::{keys, screenshot};
use asperity::scene::Document;
use asperity::simulation::Simulation;
use asperity::study::{Changes, Plan, Quantity};
use scenes::{check, read, root, updating};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Longest README, rows.
const LONGEST_README: usize = 250;

/// Pages of the documentation and their contents, in the order of the README's table.
const PAGES_AND_CONTENTS: [(&str, &str); 14] = [
    ("keys.md", "panes and keys of the explorer, typed values, appearance, recordings"),
    ("scene-file.md", "fields of a scene, loading, measured profiles, results, built-in scenes"),
    ("surfaces.md", "measured surfaces: formats, equivalent line, spectrum, accuracy"),
    ("model.md", "equations, exact solution, regimes, validity"),
    ("reversals.md", "adhesion against preload, reversal curves, Everett map, density, congruency"),
    ("conventions.md", "units, signs, zero points, E\\*, numbers in results"),
    ("glossary.md", "terms and symbols, words to avoid"),
    ("accuracy.md", "errors against closed forms, cost of accuracy, scatter of random profiles"),
    ("hard-cases.md", "catalogue of numerically hard cases and their bounds"),
    ("rounding.md", "digits that do not depend on the direction of rounding"),
    ("performance.md", "times, latency of the explorer, instructions, memory"),
    ("studies.md", "parameter studies, figures, clusters, boundary of adhesion"),
    ("errors.md", "messages, remedies, exit codes"),
    ("mutation.md", "mutation tests and survivors"),
];

/// The first fenced block of a language on a page.
fn block(page: &str, language: &str) -> String {
    let text = read(page);
    let start = format!("```{language}\n");
    let (_, rest) = text.split_once(&start).unwrap_or_else(|| panic!("{page} has no {start}"));
    rest.split_once("```").unwrap().0.to_owned()
}

/// All pages in Markdown: their names from the root.
fn pages() -> Vec<String> {
    let docs = std::fs::read_dir(root().join("docs")).unwrap();
    let mut pages: Vec<String> = docs
        .map(|entry| format!("docs/{}", entry.unwrap().file_name().to_string_lossy()))
        .filter(|name| name.ends_with(".md"))
        .collect();
    pages.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(String::from));
    pages
}

/// A command line of the documentation in a folder, with the program first in the search path.
#[cfg(unix)]
fn shell(command: &str, folder: &Path) -> std::process::Output {
    let program = Path::new(env!("CARGO_BIN_EXE_asperity")).parent().unwrap().to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([program].into_iter().chain(std::env::split_paths(&path))).unwrap();
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(command).current_dir(folder).env("PATH", path);
    shell.env("HOME", "/home/user").env_remove("XDG_CONFIG_HOME").stdin(std::process::Stdio::null());
    shell.output().unwrap()
}

#[test]
fn tables_are_those_of_the_program() {
    check("docs/keys.md", "keys", &keys::markdown());
}

#[test]
fn tables_of_studies_are_those_of_the_program() {
    let mut plans = String::from("| plan | cells | random profiles | title |\n| --- | --- | --- | --- |\n");
    for plan in asperity::study::plans() {
        let read = Plan::open(plan.name, &Changes::default()).unwrap();
        let cells: u64 = read.axes.iter().chain(&read.preloads).map(asperity::study::Axis::count).product();
        writeln!(plans, "| `{}` | {cells} | {} | {} |", plan.name, read.lines, read.title).unwrap();
    }
    check("docs/studies.md", "plans", &plans);
    let mut quantities = String::from("| quantity | symbol | unit | meaning |\n| --- | --- | --- | --- |\n");
    for quantity in Quantity::ALL {
        let (name, symbol, unit) = (quantity.name(), quantity.symbol(), quantity.unit());
        writeln!(quantities, "| `{name}` | {} | {unit} | {} |", starred(symbol), starred(quantity.meaning()))
            .unwrap();
    }
    check("docs/studies.md", "quantities", &quantities);
}

/// Text of the program for a page, with escaped asterisks.
fn starred(text: &str) -> String {
    text.replace('*', "\\*")
}

#[test]
fn errors_of_a_sphere_are_those_of_the_program() {
    let numbers = [100, 300, 1000, 3000, 10_000];
    let mut table = String::from("| springs N |");
    numbers.iter().for_each(|points| write!(table, " {points} |").unwrap());
    table += "\n| --- |";
    table += &" --- |".repeat(numbers.len());
    for (edges, words) in [("SubCell", "edges between springs"), ("Grid", "whole springs")] {
        write!(table, "\n| `edges: {edges}`, {words} |").unwrap();
        for points in numbers {
            write!(table, " {:.1e} |", error_of_a_sphere(points, edges)).unwrap();
        }
    }
    table.push('\n');
    check("README.md", "sphere", &format!("\n{table}\n"));
    check("docs/accuracy.md", "sphere", &table);
}

/// Relative error of the smallest force, −(3/2)πγR, of a sphere with γ = E* R on a profile of length 12 R.
fn error_of_a_sphere(points: u32, edges: &str) -> f64 {
    let text = format!(
        "(version: 1, material: (effective_modulus: 1.0), length: 6.0, form: Paraboloid(radius: 0.5), \
         adhesion: (work: 0.5), loading: [ToIndentation(0.75), ToSeparation], \
         numerics: (points: {points}, edges: {edges}))"
    );
    let document = Document::parse(&text, "sphere").unwrap();
    let outcome = Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap();
    let exact = 1.5 * std::f64::consts::PI * 0.5 * 0.5;
    (outcome.figures.adhesion_force.unwrap() / exact - 1.0).abs()
}

#[test]
fn the_picture_is_that_of_the_program() {
    let document = asperity::scene::open("pressure-sensitive").unwrap();
    let appearance = Appearance { theme: Theme::Dark, marker: Marker::Braille };
    let mut demo = Demo::new(document, ONE_SCENE, (120, 36), appearance, 12.0);
    while demo.advance().is_some_and(|seconds| seconds + 1e-9 < 9.0) {}
    compare("docs/explorer.svg", &screenshot(demo.model()));
}

/// Compares a picture with the drawing of the program, or writes it.
fn compare(picture: &str, drawn: &str) {
    if updating() {
        std::fs::write(root().join(picture), drawn).unwrap();
    } else {
        assert!(read(picture) == drawn, "{picture} is not the drawing of the program: see the README");
    }
}

fn asperity(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
#[cfg(unix)]
fn the_figure_of_the_regimes_shows_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("docs")).unwrap();
    std::fs::write(folder.path().join("docs/regimes.ron"), read("docs/regimes.ron")).unwrap();
    let commands = "asperity sweep docs/regimes.ron -o regimes\n\
                    asperity sweep plot regimes --quantity adhesion_share --x preload --scale linear -o docs/regimes.svg\n";
    check("README.md", "regimes command", &format!("```sh\n{commands}```\n"));
    let made = shell(&format!("set -e\n{commands}"), folder.path());
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let drawn = std::fs::read_to_string(folder.path().join("docs/regimes.svg")).unwrap();
    compare("docs/regimes.svg", &drawn);
    // The three sentences below the figure.
    let summary = std::fs::read_to_string(folder.path().join("regimes/summary.csv")).unwrap();
    let mut rows = summary.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let columns = rows.next().unwrap();
    for row in rows {
        let row: BTreeMap<_, _> = columns.iter().copied().zip(row).collect();
        let number = |column: &str| row[column].parse::<f64>().unwrap();
        let share = number("adhesion_share_mean");
        match number("kappa") {
            1.0 => {
                assert_eq!(number("regime_pressure_insensitive"), 1.0);
                assert!((share / number("zero_load_adhesion_share_mean") - 1.0).abs() < 1e-12);
                assert!((share - 0.94).abs() < 0.005);
            }
            8.0 => {
                assert_eq!(number("regime_pressure_sensitive"), 1.0);
                let preload = number("preload");
                assert!(preload > 1.5e-6 || (share - 0.08).abs() < 0.005);
                assert!(preload < 0.09 || (share - 0.54).abs() < 0.005);
            }
            _ => {
                assert!(number("regime_non_adhesive") == 1.0 || number("preload") < 0.99e-4);
                assert!(share < 1e-6);
            }
        }
    }
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn boundaries_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("edge");
    let study = study.to_str().unwrap();
    asperity(&["sweep", "equation-15", "-o", study]);
    let levels = ["--level", "0.5", "--level", "0.1", "--format", "markdown"];
    check("docs/studies.md", "boundaries", &asperity(&[&["sweep", "boundary", study], &levels[..]].concat()));
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn spreads_of_boundaries_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("energy");
    let study = study.to_str().unwrap();
    asperity(&["sweep", "elastic-energy", "-o", study]);
    let arguments =
        ["sweep", "boundary", study, "--spread", "--level", "0.5", "--level", "0.1", "--format", "markdown"];
    check("docs/studies.md", "spreads", &asperity(&arguments));
}

#[test]
fn the_regimes_are_those_of_the_program() {
    use asperity::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, VANISHING_SHARE};
    let model = read("docs/model.md");
    for row in [
        format!(
            "| pressure-insensitive | F_a(0) ≥ {INSENSITIVE_SHARE} F_a and F_a(0) ≥ {VANISHING_SHARE} F_smooth |"
        ),
        format!(
            "| non-adhesive | F_a ≤ {NEGLIGIBLE_COEFFICIENT} F_n; without a preload: F_a < {VANISHING_SHARE} F_smooth |"
        ),
    ] {
        assert!(model.contains(&row), "docs/model.md lacks: {row}");
    }
}

#[test]
#[cfg(unix)]
fn messages_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "(\n    version: 1,\n    material: (effective_modulus: 1.0e6),\n    length: 1.0e-4,\n    \
                 roughnes: None,\n)\n";
    std::fs::write(folder.path().join("scene.ron"), scene).unwrap();
    std::fs::write(folder.path().join("profile.csv"), "x,z\n0,0\n1e-6\n").unwrap();
    let page = "docs/errors.md";
    let text = read(page);
    let mut written = String::new();
    for (index, part) in text.split("```").enumerate() {
        // Every second part is a block.
        let Some(lines) = part.strip_prefix("console\n").filter(|_| index % 2 == 1) else {
            written += &format!("{}{part}", if index > 0 { "```" } else { "" });
            continue;
        };
        written += "```console\n";
        for command in lines.lines().filter_map(|line| line.strip_prefix("$ ")) {
            let output = shell(&format!("exec 2>&1\n{command}"), folder.path());
            written += &format!("$ {command}\n{}", String::from_utf8(output.stdout).unwrap());
        }
    }
    if updating() {
        std::fs::write(root().join(page), written).unwrap();
    } else {
        assert_eq!(text, written, "the messages in {page} are not the program's");
    }
}

#[test]
fn the_readme_is_short_and_lists_all_pages() {
    let mut table = String::from("| page | content |\n| --- | --- |\n");
    for (page, content) in PAGES_AND_CONTENTS {
        writeln!(table, "| [docs/{page}](docs/{page}) | {content} |").unwrap();
    }
    check("README.md", "pages", &table);
    let listed = PAGES_AND_CONTENTS.map(|(page, _)| format!("docs/{page}"));
    for page in pages().iter().filter(|page| page.starts_with("docs/")) {
        assert!(listed.contains(page), "{page} is not in the README's table");
    }
    let lines = read("README.md").lines().count();
    assert!(lines <= LONGEST_README, "README.md has {lines} lines; allowed: at most {LONGEST_README}");
}

/// The anchor of a heading on code hosts.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect()
}

#[test]
fn links_lead_somewhere() {
    for page in pages() {
        let folder = Path::new(&page).parent().unwrap().to_owned();
        for link in read(&page).split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.starts_with("http") || link.contains([' ', '\n']) {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = folder.join(file);
            let exists = file.is_empty() || root().join(&target).exists();
            assert!(exists, "{page}: {link} leads nowhere");
            if !heading.is_empty() {
                let target: PathBuf = if file.is_empty() { page.clone().into() } else { target };
                let text = read(target.to_str().unwrap());
                let mut headings = text.lines().filter_map(|line| line.strip_prefix('#'));
                let found = headings.any(|line| anchor(line.trim_start_matches('#')) == heading);
                assert!(found, "{page}: {link} has no such heading");
            }
        }
    }
}

#[test]
fn files_of_the_contributing_guide_exist() {
    let guide = read("CONTRIBUTING.md");
    let code = guide.split('`').skip(1).step_by(2);
    for word in code.filter_map(|code| code.split_whitespace().next()) {
        let is_path = ["src/", "tests/", "docs/"].iter().any(|folder| word.starts_with(folder));
        assert!(!is_path || root().join(word).exists(), "CONTRIBUTING.md: there is no {word}");
    }
}

#[test]
fn examples_of_files_are_allowed() {
    Document::parse(&block("docs/scene-file.md", "ron"), "docs/scene-file.md").unwrap();
    Plan::parse(&block("docs/studies.md", "ron"), "docs/studies.md", &Changes::default()).unwrap();
}

#[test]
#[cfg(unix)]
fn the_commands_of_the_readme_run() {
    let readme = read("README.md");
    let (_, rest) = readme.split_once("## Without a terminal\n").unwrap();
    let commands = rest.split("```").nth(1).unwrap().strip_prefix("sh\n").unwrap();
    assert_eq!(commands.lines().count(), 8);
    let folder = tempfile::tempdir().unwrap();
    // The catalogue has a test of its own.
    for command in commands.lines().filter(|command| !command.starts_with("asperity check")) {
        let command = command.split('#').next().unwrap();
        let output = shell(command, folder.path());
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
#[cfg(unix)]
fn the_python_example_runs() {
    let folder = tempfile::tempdir().unwrap();
    if !shell("python3 -c ''", folder.path()).status.success() {
        println!("no python3: the example in Python is not tried");
        return;
    }
    std::fs::write(folder.path().join("example.py"), block("README.md", "python")).unwrap();
    let output = shell("python3 example.py", folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8(output.stdout).unwrap();
    let regimes: Vec<_> = printed.lines().filter_map(|line| line.split(' ').next_back()).collect();
    assert_eq!(regimes, ["pressure-insensitive", "pressure-sensitive", "non-adhesive"]);
}

#[test]
fn the_citation_is_of_this_version() {
    let version = format!("version: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(read("CITATION.cff").contains(&version), "CITATION.cff lacks {version}");
}
