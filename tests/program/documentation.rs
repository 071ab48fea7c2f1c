//! The documentation matches the program: tables, pictures, examples, links and claims.
//!
//! After a change of the program, `UPDATE_DOCS=1 cargo test --test program -- --include-ignored`
//! writes generated parts anew.

use super::generated::{assert_says, check, compare, pages_in, read, root};
use super::program::{asperity_in, table};
use asperity::data::{format_quantity, format_range};
use asperity::explorer::commands::table::bindings;
use asperity::explorer::config::Config;
use asperity::explorer::pane::Pane;
use asperity::explorer::panes::row;
use asperity::scene::Document;
use asperity::scene::Regime;
use asperity::scene::Simulation;
use asperity::scene::fields::{FIELDS, Field, Range, SPHERE_FIELDS, STAGE_FORCE};
use asperity::study::{Changes, Ensemble, Found, Plan, Quantity, Question, Statistics};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// Longest README, rows.
const LONGEST_README: usize = 200;

/// Pages of the documentation with their groups and contents, in the order of the README's table.
pub const PAGES: [(&str, &str, &str); 18] = [
    (
        "Start",
        "learn.md",
        "the model by hand, from the law of Hertz to five springs; from your tip to a scene",
    ),
    (
        "Start",
        "gallery.md",
        "eleven questions, each with a picture, a command, a line of Python and an answer",
    ),
    (
        "Start",
        "coming-from.md",
        "tamaas, SurfaceTopography, programs for force microscopes, spreadsheets",
    ),
    (
        "Do",
        "scene-file.md",
        "fields of a scene, waves, loading, forms",
    ),
    (
        "Do",
        "keys.md",
        "panes and keys of the explorer, typed values, configuration",
    ),
    ("Do", "results.md", "summary, JSON, tables, figures, jumps"),
    (
        "Do",
        "studies.md",
        "the preload for a wanted result, adhesion against preload, force laws, parameter studies, clusters",
    ),
    (
        "Do",
        "surfaces.md",
        "measured surfaces: use, formats, fields",
    ),
    (
        "Do",
        "surface-estimate.md",
        "how a measured spectrum is estimated, and its errors",
    ),
    (
        "Do",
        "experiment.md",
        "measured force curves: reading, fit of the work of adhesion, errors",
    ),
    (
        "Do",
        "python.md",
        "functions and results of the Python package",
    ),
    (
        "Do",
        "messages.md",
        "when the program says …, do …; exit codes",
    ),
    (
        "Trust",
        "model.md",
        "equations, regimes, other theories, validity",
    ),
    (
        "Trust",
        "three-dimensions.md",
        "the profile against the same contact in three dimensions",
    ),
    (
        "Trust",
        "accuracy.md",
        "rounding, errors, scatter, times, memory, other packages",
    ),
    (
        "Trust",
        "findings.md",
        "results to cite: claims of the paper, boundary of adhesion, stiffness",
    ),
    ("Look up", "terms.md", "symbols, units, signs, names"),
    (
        "Look up",
        "design.md",
        "structure of the program, files of an extension, rules of the code",
    ),
];

/// The first fenced block of a language on a page.
pub fn block(page: &str, language: &str) -> String {
    let text = read(page);
    let start = format!("```{language}\n");
    let (_, rest) = text
        .split_once(&start)
        .unwrap_or_else(|| panic!("{page} has no {start}"));
    rest.split_once("```").unwrap().0.to_owned()
}

/// A table in Markdown, from its header and the cells of its rows.
pub fn markdown<const N: usize>(
    header: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> String {
    let head = format!("| {} |\n|{}\n", header.join(" | "), "---|".repeat(N));
    head + &rows
        .map(|cells| format!("| {} |\n", cells.join(" | ")))
        .collect::<String>()
}

/// Path, variant and symbol of a field, its range and default, and its meaning.
fn row_of_field(field: &Field) -> [String; 3] {
    let of = field
        .variant
        .filter(|one| *one != "Measured")
        .map_or(String::new(), |one| format!(" ({one})"));
    let symbol = if field.symbol.is_empty() {
        String::new()
    } else {
        format!(" {}", escaped(field.symbol))
    };
    let allowed = match field.range {
        Range::Choice(choices) => choices
            .iter()
            .map(|one| format!("`{one}`"))
            .collect::<Vec<_>>()
            .join(", "),
        Range::Text { lines: false, .. } => "text".to_owned(),
        _ => field
            .allowed()
            .replace("a whole number ", "")
            .replace("from ", ""),
    };
    let default = match field.default {
        "" => String::new(),
        "None" => "; optional".to_owned(),
        default => format!("; default `{default}`"),
    };
    [
        format!("`{}`{of}{symbol}", field.path),
        allowed + &default,
        escaped(field.meaning),
    ]
}

/// Text of the program for a page, with escaped asterisks.
fn escaped(text: &str) -> String {
    text.replace('*', "\\*")
}

#[test]
fn tables_are_those_of_the_program() {
    check(
        "docs/keys.md",
        "keys",
        &format!("{}\n", bindings().markdown()),
    );
    let panes = Pane::ALL.iter().flat_map(|pane| row(*pane).help);
    // The help has the signs too.
    let panes = panes.map(|(name, content)| {
        let first = content.split([';', '.']).next().unwrap();
        [(*name).to_owned(), first.trim().replace('|', "\\|")]
    });
    check(
        "docs/keys.md",
        "panes",
        &markdown(["pane", "content"], panes),
    );
    let quantities = Quantity::ALL.iter().map(|one| {
        let unit = [one.symbol(), one.unit()]
            .into_iter()
            .filter(|word| !["", "1"].contains(word));
        let unit = unit.collect::<Vec<_>>().join(", ");
        let unit = if unit.is_empty() {
            unit
        } else {
            format!(" ({unit})")
        };
        format!(
            "* `{}`{}: {}\n",
            one.name(),
            escaped(&unit),
            escaped(one.meaning())
        )
    });
    check(
        "docs/studies.md",
        "quantities",
        &format!("\n{}\n", quantities.collect::<String>()),
    );
    for (page, part, is_measured) in [
        ("docs/scene-file.md", "fields", false),
        ("docs/surfaces.md", "measured fields", true),
    ] {
        let mut fields: Vec<&Field> = FIELDS.iter().collect();
        // The values of spheres have no rows in the table of the scene.
        let after_form = fields
            .iter()
            .position(|field| field.path == "roughness")
            .unwrap();
        fields.splice(after_form..after_form, SPHERE_FIELDS);
        let of = fields
            .into_iter()
            .filter(|field| field.range != Range::Group)
            .filter(|field| (field.variant == Some("Measured")) == is_measured)
            .map(row_of_field);
        check(page, part, &markdown(["field", "allowed", "means"], of));
    }
    let pages = PAGES.iter().map(|(group, page, content)| {
        let link = format!("[docs/{page}](docs/{page})");
        [(*group).to_owned(), link, (*content).to_owned()]
    });
    check(
        "README.md",
        "pages",
        &markdown(["group", "page", "content"], pages),
    );
}

#[test]
fn the_readme_is_short_and_lists_all_pages() {
    let listed = PAGES.map(|(_, page, _)| format!("docs/{page}"));
    assert!(
        pages_in("docs").iter().all(|page| listed.contains(page)),
        "{:?}",
        pages_in("docs")
    );
    let lines = read("README.md").lines().count();
    assert!(
        lines <= LONGEST_README,
        "README.md has {lines} lines; allowed: at most {LONGEST_README}"
    );
    let version = format!("version: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(
        read("CITATION.cff").contains(&version),
        "CITATION.cff lacks {version}"
    );
}

/// Relative errors of the smallest force, −(3/2)πγR, and of its indentation, a²/R − √(2πaγ/E*) with
/// a³ = (9/8)πγR²/E*, of a sphere with γ = E* R on a profile of length 12 R.
fn errors_of_a_sphere(points: u32, edges: &str) -> [f64; 2] {
    let text = format!(
        "(version: 1, material: (modulus: 1.0), length: 6.0, form: Paraboloid(radius: 0.5), \
         adhesion: (work: 0.5), loading: [ToIndentation(0.75), ToSeparation], \
         numerics: (points: {points}, edges: {edges}))"
    );
    let document = Document::parse(&text, "sphere").unwrap();
    let outcome = Simulation::default()
        .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let figures = outcome.figures;
    let a = (9.0 / 8.0 * PI * 0.5 * 0.25).cbrt();
    let force = figures.pull_off_force.unwrap() / (1.5 * PI * 0.25);
    let indentation =
        figures.pull_off_indentation.unwrap() / (a * a / 0.5 - (2.0 * PI * a * 0.5).sqrt());
    [force, indentation].map(|share| (share - 1.0).abs())
}

#[test]
fn errors_of_a_sphere_are_those_of_the_program() {
    let table = |of: usize| {
        let rows = [
            ("SubCell", "edges between springs"),
            ("Grid", "whole springs"),
        ]
        .map(|(edges, words)| {
            let error = |points| format!("{:.1e}", errors_of_a_sphere(points, edges)[of]);
            [
                format!("`edges: {edges}`, {words}"),
                error(100),
                error(300),
                error(1000),
                error(3000),
                error(10_000),
            ]
        });
        markdown(
            ["springs N", "100", "300", "1000", "3000", "10000"],
            rows.into_iter(),
        )
    };
    check("README.md", "sphere", &format!("\n{}\n", table(0)));
    check("docs/accuracy.md", "sphere indentation", &table(1));
}

#[test]
fn pictures_are_those_of_their_commands() {
    let folder = tempfile::tempdir().unwrap();
    for inside in ["docs/learn", "docs/examples", "docs/particles"] {
        std::fs::create_dir_all(folder.path().join(inside)).unwrap();
    }
    for file in [
        "five-springs.ron",
        "five-springs.txt",
        "turned-at-first-touch.ron",
        "turned-at-zero-force.ron",
        "soft-pad.ron",
        "dwell-and-speed.ron",
    ] {
        let file = format!("docs/examples/{file}");
        std::fs::write(folder.path().join(&file), read(&file)).unwrap();
    }
    let sphere =
        "asperity run jkr-sphere --set \"material=(modulus:1e6)\" -o docs/learn/sphere.svg";
    let protocols = "asperity run docs/examples/turned-at-first-touch.ron docs/examples/turned-at-zero-force.ron \
                     -o docs/learn/protocols.svg";
    let of_particles = |scene, file| {
        format!("asperity run {scene} --set numerics.samples=64 -o docs/particles/{file}.csv")
    };
    let sweep = "asperity sweep docs/examples/dwell-and-speed.ron -o time";
    assert!(read("docs/learn.md").contains(sweep));
    succeeded(folder.path(), sweep);
    let time = "asperity sweep plot time --quantity pull_off_force -o docs/learn/time.svg";
    let rest = "asperity run docs/examples/soft-pad.ron --set \"loading=[ToForce(1e-3),Hold(100.0),ToSeparation]\" \
                -o docs/learn/rest.svg";
    let staircase = "asperity run docs/examples/five-springs.ron --preloads 0nN..40nN:41 \
                     -o docs/learn/five-springs.svg";
    for (page, command) in [
        ("docs/learn.md", sphere),
        ("docs/learn.md", staircase),
        (
            "docs/learn.md",
            "asperity run pressure-sensitive -o docs/learn/rough.svg",
        ),
        ("docs/learn.md", protocols),
        ("docs/learn.md", time),
        ("docs/learn.md", rest),
        (
            "README.md",
            "asperity demo pressure-sensitive --at 13 --size 120x36 -o docs/explorer.svg",
        ),
        (
            "docs/studies.md",
            "asperity reversals pressure-sensitive -o docs/reversals.svg",
        ),
        ("docs/studies.md", &of_particles("jkr-sphere", "sphere")),
        (
            "docs/studies.md",
            &of_particles("rough-sphere", "rough-sphere"),
        ),
        ("docs/studies.md", &of_particles("two-works", "two-works")),
    ] {
        assert!(read(page).contains(command), "{page} lacks: {command}");
        succeeded(folder.path(), command);
        let file = command.rsplit(' ').next().unwrap();
        // Metadata name measured files by their whole path.
        let drawn = std::fs::read_to_string(folder.path().join(file)).unwrap();
        compare(
            file,
            &drawn.replace(&format!("{}/", folder.path().display()), ""),
        );
    }
}

/// Runs a command in a folder.
fn succeeded(folder: &Path, command: &str) -> String {
    asperity_in(
        folder,
        &command
            .split(' ')
            .skip(1)
            .map(|word| word.trim_matches('"'))
            .collect::<Vec<_>>(),
    )
    .succeeded()
}

#[test]
fn the_figure_of_the_regimes_shows_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::create_dir(folder.join("docs")).unwrap();
    std::fs::write(folder.join("docs/regimes.ron"), read("docs/regimes.ron")).unwrap();
    let readme = read("README.md");
    let (_, commands) = readme
        .split_once("<!-- regimes command -->\n```sh\n")
        .unwrap();
    commands
        .split("```")
        .next()
        .unwrap()
        .lines()
        .for_each(|command| drop(succeeded(folder, command)));
    compare(
        "docs/regimes.svg",
        &std::fs::read_to_string(folder.join("docs/regimes.svg")).unwrap(),
    );
    // The three sentences below the figure.
    let summary = std::fs::read_to_string(folder.join("regimes/summary.csv")).unwrap();
    let columns: Vec<&str> = summary.lines().next().unwrap().split(',').collect();
    let column = |name: &str| columns.iter().position(|one| *one == name).unwrap();
    let rows: Vec<Vec<f64>> = table(&summary).collect();
    let of = |kappa: f64, name: &str| -> Vec<f64> {
        rows.iter()
            .filter(|row| row[column("adhesion.kappa")] == kappa)
            .map(|row| row[column(name)])
            .collect()
    };
    let shares = |kappa| of(kappa, "adhesion_share_mean");
    assert!(
        shares(1.0).iter().all(|share| (share - 0.94).abs() < 0.005),
        "{:?}",
        shares(1.0)
    );
    assert!(
        of(1.0, "regime_pressure_insensitive")
            .iter()
            .all(|part| *part == 1.0)
    );
    let sensitive = shares(8.0);
    assert!(
        (sensitive[0] - 0.08).abs() < 0.005
            && (sensitive[sensitive.len() - 1] - 0.54).abs() < 0.005
    );
    assert!(of(8.0, "adhesion_share_median")[0] < 1e-4);
    let plan = folder.join("docs/regimes.ron").display().to_string();
    let scene = Plan::open(&plan, &Changes::default()).unwrap().scene;
    let outcome = Simulation::default().compute(&scene.checked().unwrap());
    let warnings = outcome.unwrap().warnings;
    for premise in [
        "rms gradient 1.466 is above 1",
        "fit only once on the length",
    ] {
        let mut sentences = warnings.iter().map(|warning| warning.sentence());
        assert!(
            sentences.any(|sentence| sentence.contains(premise)),
            "{premise}"
        );
    }
    assert!(
        sensitive.is_sorted()
            && of(8.0, "regime_pressure_sensitive")
                .iter()
                .all(|part| *part == 1.0)
    );
    assert!(shares(100.0).iter().all(|share| *share < 1e-6));
    assert!(
        of(100.0, "tabor_number_mean")
            .iter()
            .all(|number| (number - 0.81).abs() < 0.005)
    );
    for (part, preload) in of(100.0, "regime_non_adhesive")
        .into_iter()
        .zip(of(100.0, "preload"))
    {
        assert!(
            part == 1.0 || preload < 1e-4 * (1.0 - 1e-9),
            "{part} under {preload}"
        );
    }
}

/// How often the mean of 16 log-normal numbers lies in its interval, more often than in that of a
/// quantity without bounds.
#[test]
fn intervals_hold_the_means_of_skewed_values_as_often_as_stated() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut uniform = || random.random::<f64>();
    let mut normal = || (-2.0 * (1.0 - uniform()).ln()).sqrt() * (TAU * uniform()).cos();
    let (samples, any) = (40_000, (f64::NEG_INFINITY, f64::INFINITY));
    let shares = [0.5_f64, 1.0, 2.0].map(|deviation| {
        let (truth, mut held) = ((0.5 * deviation * deviation).exp(), [0; 2]);
        for _ in 0..samples {
            let values: Vec<f64> = (0..16).map(|_| (deviation * normal()).exp()).collect();
            for (held, bounds) in held.iter_mut().zip([(0.0, f64::INFINITY), any]) {
                let (low, high) = Statistics::of(values.clone(), bounds).unwrap().ends();
                *held += u32::from(low <= truth && truth <= high);
            }
        }
        assert!(held[0] > held[1], "{held:?}");
        format!("{:.1}", 100.0 * f64::from(held[0]) / f64::from(samples))
    });
    let [low, middle, high] = shares;
    assert_says(
        "docs/studies.md",
        &format!(
            "in {low} % of the cases if the logarithm has the standard deviation 0.5, in {middle} % for 1 and in {high} % for 2"
        ),
    );
}

/// The table of docs/findings.md is of 2^19 springs; 2^13 have its values within their spread.
#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn the_stiffness_without_adhesion_has_the_exponent_of_theory() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plan = succeeded(folder, "asperity sweep plans stiffness-exponent");
    std::fs::write(
        folder.join("plan.ron"),
        plan.replace("[8192, 65536, 524288]", "[8192]"),
    )
    .unwrap();
    succeeded(folder, "asperity sweep plan.ron -o stiffness");
    let summary = std::fs::read_to_string(folder.join("stiffness/summary.csv")).unwrap();
    let fitted: Vec<f64> = table(&summary).map(|row| row[6]).collect();
    let stated = [0.844, 0.0, 0.772, 0.719, 0.668, 0.624, 0.588, 0.553, 0.522];
    let is_stated = |(fitted, stated): (&f64, f64)| stated == 0.0 || (fitted - stated).abs() < 0.02;
    assert!(
        fitted.len() == 9 && fitted.iter().zip(stated).all(is_stated),
        "{fitted:?}"
    );
}

/// The first step of the tour: the keys are those of the explorer, the numbers those of the answer.
#[test]
fn the_tour_begins_with_the_question() {
    let scene = asperity::scene::open(asperity::scene::library::DEFAULT).unwrap();
    let condition = asperity::study::Question::parse_condition("F_a/F_a,max = 20 %").unwrap();
    let mut simulation = Simulation::default();
    let question = Question::new(
        scene.scene(),
        "preload",
        condition,
        Ensemble::PROFILES,
        &mut simulation,
    );
    let control = asperity_data::Control::default().on_threads(2);
    let found = Found::of(question.unwrap(), &mut simulation, control).unwrap();
    let [low, median, high] = [0.25, 0.5, 0.75].map(|share| found.quantile(share).unwrap());
    let (median, range) = (
        format_quantity(median, "N"),
        format_range((low, high), 3, "N"),
    );
    let says = format!("{median}, the median of 16 random profiles, with quartiles from {range}");
    assert_says("README.md", &says);
}

#[test]
fn the_tour_shows_a_staircase() {
    let scene = asperity::scene::open("pressure-sensitive").unwrap();
    let mut force = "1.0e-5".to_owned();
    let forces = [0, 1, 2, 3].map(|step| {
        if step > 0 {
            force = STAGE_FORCE.stepped(&force, 1, false).unwrap();
        }
        let pressed = scene.set("loading.0.0", &force).unwrap();
        let outcome = Simulation::default()
            .run(pressed.scene(), &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        (1e6 * outcome.figures.pull_off_force.unwrap()).round()
    });
    assert_eq!(forces, [17.0, 17.0, 17.0, 66.0]);
}

#[test]
fn the_regimes_are_those_of_the_program() {
    let model = read("docs/model.md");
    for row in [
        format!(
            "| pressure-insensitive | F_a(d=0) ≥ {} F_a and F_a(d=0) ≥ {} F_smooth |",
            Regime::INSENSITIVE_SHARE,
            Regime::VANISHING_SHARE
        ),
        format!(
            "| non-adhesive | F_a ≤ {} F_n; without a preload: F_a < {} F_smooth |",
            Regime::NEGLIGIBLE_COEFFICIENT,
            Regime::VANISHING_SHARE
        ),
    ] {
        assert!(model.contains(&row), "docs/model.md lacks: {row}");
    }
}

/// The anchor of a heading on code hosts.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_'))
        .collect()
}

#[test]
fn links_and_paths_lead_somewhere() {
    let others = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "fuzz/README.md",
    ]
    .map(String::from);
    for page in pages_in("docs").into_iter().chain(others) {
        let (text, folder) = (read(&page), Path::new(&page).parent().unwrap());
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            if link.starts_with("http") || link.contains([' ', '\n']) {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target: PathBuf = if file.is_empty() {
                page.clone().into()
            } else {
                folder.join(file)
            };
            assert!(
                root().join(&target).exists(),
                "{page}: {link} leads nowhere"
            );
            let text = if heading.is_empty() {
                String::new()
            } else {
                read(target.to_str().unwrap())
            };
            let mut headings = text.lines().filter_map(|line| line.strip_prefix('#'));
            let found = headings.any(|line| anchor(line.trim_start_matches('#')) == heading);
            assert!(
                heading.is_empty() || found,
                "{page}: {link} has no such heading"
            );
        }
        let code = text.split('`').skip(1).step_by(2);
        for word in code.filter_map(|code| code.split_whitespace().next()) {
            let is_path = ["src/", "crates/", "tests/", "docs/", "fuzz/"]
                .iter()
                .any(|folder| word.starts_with(folder));
            let exists = || root().join(word).exists() || word.contains('*');
            assert!(!is_path || exists(), "{page}: there is no {word}");
        }
    }
}

#[test]
fn examples_of_files_are_allowed() {
    Document::parse(&block("docs/scene-file.md", "ron"), "docs/scene-file.md").unwrap();
    let config = block("docs/keys.md", "ron");
    Config::parse(&config, Path::new("docs/keys.md"), bindings()).unwrap();
    Plan::parse(
        &block("docs/studies.md", "ron"),
        "docs/studies.md",
        &Changes::default(),
    )
    .unwrap();
}
