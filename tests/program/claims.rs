//! What the pages say about the claims of the paper and about the boundary of adhesion, from the
//! plans of the program.

use super::documentation::markdown;
use super::generated::{assert_says, check};
use super::program::{asperity_in, json, rows, table};
use std::path::Path;

/// A table of numbers with names of its columns.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn of(csv: &str) -> Self {
        let names = rows(csv)
            .next()
            .unwrap()
            .split(',')
            .map(String::from)
            .collect();
        Table {
            names,
            rows: table(csv).collect(),
        }
    }

    /// Values of a column in the rows with these values of others, as written.
    fn of_rows(&self, name: &str, at: &[(&str, f64)]) -> Vec<f64> {
        let column = |name: &str| self.names.iter().position(|one| one == name).unwrap();
        let is_at = |row: &&Vec<f64>| {
            at.iter()
                .all(|(name, value)| (row[column(name)] - value).abs() < 1e-9)
        };
        let found: Vec<f64> = self
            .rows
            .iter()
            .filter(is_at)
            .map(|row| row[column(name)])
            .collect();
        assert!(!found.is_empty(), "{name} at {at:?}");
        found
    }

    fn value(&self, name: &str, at: &[(&str, f64)]) -> f64 {
        self.of_rows(name, at)[0]
    }
}

/// Runs a study in a folder of the plan's name, unless that is done; the table of its statistics.
fn summary(folder: &Path, plan: &str) -> Table {
    let name = plan.trim_end_matches(".ron");
    if !folder.join(name).exists() {
        asperity_in(folder, &["sweep", plan, "-o", name]).succeeded();
    }
    Table::of(&std::fs::read_to_string(folder.join(name).join("summary.csv")).unwrap())
}

/// Boundaries of a study in κ or in e_el/γ, for half and a tenth of F_a,max.
fn boundaries(folder: &Path, study: &str, over: &str) -> String {
    let levels = ["--where", "0.5", "--where", "0.1"];
    let command = [
        &["sweep", "boundary", study, "--x", over, "--format", "csv"],
        &levels[..],
    ]
    .concat();
    asperity_in(folder, &command).succeeded()
}

/// The smallest and the largest of values above zero.
fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> (f64, f64) {
    let ends = (f64::INFINITY, 0.0);
    values
        .into_iter()
        .fold(ends, |(low, high): (f64, f64), one| {
            (low.min(*one), high.max(*one))
        })
}

/// Hurst exponents of `equation-15`, and every fourth of those of the figures.
const HURST: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// The four boundaries of each H and bandwidth.
const FOUR: [&str; 4] = ["d=0, 0.5", "d=0, 0.1", "F=0, 0.5", "F=0, 0.1"];

#[test]
#[ignore = "computes five studies and five ensembles, some ten seconds; .ci/run runs it"]
fn boundaries_and_claims_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    check_boundaries(folder.path());
    check_claims(folder.path());
}

/// docs/findings.md, and the range in README.md.
fn check_boundaries(folder: &Path) {
    let plans = ["equation-15", "elastic-energy", "figure-5a"];
    plans.iter().for_each(|plan| drop(summary(folder, plan)));
    let found: Vec<Vec<f64>> = table(&boundaries(folder, plans[0], "kappa")).collect();
    // The page has the narrowest and the widest band, of three Hurst exponents.
    let is_shown =
        |four: &&[Vec<f64>]| four[0][1] != 128.0 && [0.1, 0.5, 0.9].contains(&four[0][0]);
    let lines = found.chunks(4).filter(is_shown).map(|four| {
        let cell = |one: usize| {
            format!(
                "{:.2} ({:.2}–{:.2})",
                four[one][4], four[one][5], four[one][6]
            )
        };
        [
            four[0][0].to_string(),
            four[0][1].to_string(),
            cell(0),
            cell(1),
            cell(2),
            cell(3),
        ]
    });
    let header = ["H", "k_max", FOUR[0], FOUR[1], FOUR[2], FOUR[3]];
    check("docs/findings.md", "boundaries", &markdown(header, lines));
    // Range of each of the four boundaries in all plans, over κ and over e_el/γ.
    let [kappa, energy] = ["kappa", "elastic_energy_ratio"].map(|over| {
        let values =
            plans.map(|plan| Table::of(&boundaries(folder, plan, over)).of_rows(over, &[]));
        let of = |place: usize| {
            values
                .iter()
                .flat_map(move |plan| plan.iter().skip(place).step_by(4))
        };
        [0, 1, 2, 3].map(|place| range(of(place)))
    });
    let factors = |ranges: &[(f64, f64)]| {
        range(
            &ranges
                .iter()
                .map(|(low, high)| high / low)
                .collect::<Vec<_>>(),
        )
    };
    let (least, most) = factors(&kappa);
    let sentence = format!("the largest κ\\* is {least:.1} to {most:.1} times the smallest κ\\*");
    assert_says("docs/findings.md", &sentence);
    let (least, most) = factors(&energy[..3]);
    let (low, high) = energy[3];
    assert_says(
        "docs/findings.md",
        &format!(
            "F_a(F=0) falls to a tenth of F_a,max at e_el/γ = {low:.1} to {high:.1}, a factor of {:.1}. For each of the \
             other three columns the largest e_el/γ is {least:.1} to {most:.1} times the smallest",
            high / low
        ),
    );
    let [touch, zero_force] =
        [kappa[0], kappa[2]].map(|(low, high)| format!("κ = {low:.2} to {high:.2}"));
    assert_says(
        "docs/findings.md",
        &format!("half of F_a,max at {touch}, and F_a(F=0) at {zero_force}"),
    );
    assert!(
        kappa
            .iter()
            .zip(&energy)
            .all(|(kappa, energy)| energy.1 / energy.0 < kappa.1 / kappa.0)
    );
    let (low, high) = range(kappa.iter().flat_map(|ends| [&ends.0, &ends.1]));
    assert_says("README.md", &format!("between κ = {low:.2} and {high:.1}"));
}

/// Root mean square of the skewness of 32 profiles of this many springs.
fn skewness(exponent: u32) -> f64 {
    let (points, modes) = (1 << exponent, 1 << (exponent - 1));
    let sets = [
        format!("numerics.points={points}"),
        format!("roughness.modes=(1, {modes})"),
    ];
    let run = [
        "run",
        "profile-hurst-075",
        "--profiles",
        "32",
        "--format",
        "json",
        "--set",
        &sets[0],
        "--set",
        &sets[1],
    ];
    let lines = json(&run)["ensemble"]["per_profile"].clone();
    let squares = lines
        .as_array()
        .unwrap()
        .iter()
        .map(|line| line["skewness"].as_f64().unwrap().powi(2));
    (squares.sum::<f64>() / 32.0).sqrt()
}

/// Largest over smallest ratio of the mean pull-off force to the preload, from 0.5 to 40 µN.
fn variation_of_the_coefficient(kappa: u32) -> f64 {
    let set = format!("adhesion.kappa={kappa}");
    let preloads = [
        "--preloads",
        "0.5uN..40uN:80",
        "--profiles",
        "128",
        "--format",
        "json",
    ];
    let run = json(&[&["run", "pressure-sensitive", "--set", &set], &preloads[..]].concat());
    let ratio = |row: &serde_json::Value| {
        row["pull_off_force"]["mean"].as_f64().unwrap() / row["preload"].as_f64().unwrap()
    };
    let (low, high) = range(
        &run["mean"]
            .as_array()
            .unwrap()
            .iter()
            .map(ratio)
            .collect::<Vec<_>>(),
    );
    high / low
}

/// docs/findings.md: shares of F_a,max in per cent, ratios of F_a to F_n, and boundaries in κ, each
/// from the command beside it.
fn check_claims(folder: &Path) {
    let says = |plan: &str, words: &str| {
        let text = asperity_in(folder, &["sweep", "plans", plan]).succeeded();
        assert!(text.contains(words), "the notice of {plan} lacks: {words}");
        text
    };
    let bare = summary(folder, "figure-5a");
    let share = "first_touch_adhesion_share_mean";
    let (least, most) = range(&bare.of_rows(share, &[("adhesion.kappa", 0.5)]));
    let half = Table::of(&boundaries(folder, "figure-5a", "kappa"));
    let (low, high) = range(&half.of_rows("kappa", &[("level", 0.5)]));
    says(
        "figure-5a",
        &format!("half is left at κ = {low:.1} to {high:.1}"),
    );
    let half = [0.1, 0.45, 0.9]
        .map(|hurst| format!("{:.1}", half.value("kappa", &[("H", hurst)])))
        .join(", ");
    let narrow = Table::of(&boundaries(folder, "equation-15", "kappa"));
    let narrow = range(&HURST.map(|hurst| narrow.value("kappa", &[("H", hurst), ("k_max", 16.0)])));

    // The same plans with fewer cells.
    let plan = asperity_in(folder, &["sweep", "plans", "figure-6"]).succeeded();
    let plan = plan.replace(
        "from: 0.5, to: 48.0, count: 96",
        "from: 2.0, to: 44.0, count: 22",
    );
    std::fs::write(folder.join("section.ron"), plan).unwrap();
    let section = summary(folder, "section.ron");
    assert_eq!(section.rows.len(), 22 * 3);
    let per_cent = |share: &str, kappa: f64| {
        two_digits(100.0 * section.value(share, &[("adhesion.kappa", kappa), ("preload", 1.0)]))
    };
    let touch = [4.0, 6.0, 8.0].map(|kappa| per_cent(share, kappa));
    let zero_force = [4.0, 6.0, 8.0].map(|kappa| per_cent("zero_force_adhesion_share_mean", kappa));
    let coefficient = "adhesion_coefficient_mean";
    let of = |kappa: f64, preload: f64| {
        section.value(
            coefficient,
            &[("adhesion.kappa", kappa), ("preload", preload)],
        )
    };
    let at_two = [1.0, 0.1, 0.01]
        .map(|preload| two_digits(of(2.0, preload)))
        .join(", ");
    let far = [16.0, 32.0, 44.0]
        .map(|kappa| two_digits(of(kappa, 1.0)))
        .join(", ");
    let falls =
        [0.01, 0.1, 1.0].map(|preload| section.of_rows(coefficient, &[("preload", preload)]));
    let slope = (of(16.0, 1.0) / of(8.0, 1.0)).ln() / 8.0;
    says(
        "figure-6",
        &format!("under E* h L about as e^({slope:.2} κ) from κ = 8 to 16"),
    );

    let factors = [(6, 2.0..3.5), (8, 6.0..10.0), (10, 20.0..40.0)].map(|(kappa, allowed)| {
        let factor = variation_of_the_coefficient(kappa);
        assert!(allowed.contains(&factor), "κ = {kappa}: {factor}");
        format!("{factor:.0}")
    });
    let words = format!(
        "a factor of {} at κ = 6, and of {} at κ = 10",
        factors[0], factors[2]
    );
    let plan = says("figure-5b", &words).replace("count: 17", "count: 5");
    let plan = plan.replace(
        "from: 1.25, to: 41.25, count: 33",
        "from: 12.5, to: 25.0, count: 2",
    );
    std::fs::write(folder.join("corner.ron"), plan).unwrap();
    let corner = summary(folder, "corner.ron");
    assert_eq!(corner.rows.len(), 5 * 2 * 3);
    let corner = |kappa: f64, preload: f64| {
        let at = |hurst: f64| {
            [
                ("roughness.hurst", hurst),
                ("adhesion.kappa", kappa),
                ("preload", preload),
            ]
        };
        HURST.map(|hurst| corner.value(coefficient, &at(hurst)))
    };
    let (near, beyond) = (corner(12.5, 1.0), corner(25.0, 0.01));
    assert!(
        near.is_sorted_by(|before, after| before > after)
            && beyond[1..].iter().all(|one| *one > beyond[0])
    );
    let [near, beyond] = [near, beyond].map(|values| [values[0], values[4]].map(two_digits));
    let skewness = [10, 20].map(|exponent| format!("{:.2}", skewness(exponent)));
    assert_says(
        "docs/findings.md",
        &format!(
            "modes up to N/2, the root mean square of the skewness stays {} for each N",
            skewness[0]
        ),
    );

    for share in [share, "zero_force_adhesion_share_mean"] {
        assert!(
            range(&section.of_rows(share, &[])).0 > 0.0,
            "never zero: {share}"
        );
    }
    assert!(least > 0.9 && narrow.1 / narrow.0 < 1.2 && skewness[0] == skewness[1]);
    assert!(
        falls
            .iter()
            .all(|values| values.is_sorted_by(|before, after| before > after))
    );
    let rows = [
        (
            "three regimes (Fig. 4)",
            "holds",
            "F_a stays constant, grows with the preload, or is negligible: `asperity run ideal-adhesion \
             pressure-sensitive non-adhesive --preloads 1e-6..2e-5 -o figure-4.svg`"
                .to_owned(),
        ),
        (
            "F_a → F_a,max for small roughness (14)",
            "holds",
            format!(
                "F_a is {:.0} to {:.0} % of F_a,max at κ = 0.5 for H = 0.1 to 0.9: `figure-5a`",
                100.0 * least,
                100.0 * most
            ),
        ),
        (
            "without a preload, F_a is finite for small roughness and zero for large roughness (Fig. 5a, 6a)",
            "holds",
            format!(
                "turned at first touch, F_a(d=0) is {}, {} and {} % of F_a,max at κ = 4, 6 and 8; turned at zero \
                 force, F_a(F=0) is {}, {} and {} %; neither is ever exactly zero: `figure-6`",
                touch[0], touch[1], touch[2], zero_force[0], zero_force[1], zero_force[2]
            ),
        ),
        (
            "the boundary is κ ≈ 0.6 (15)",
            "does not hold",
            format!(
                "without a preload, F_a falls to half of F_a,max at κ = {low:.1} to {high:.1}: `asperity sweep boundary figure-5a \
                 --where 0.5`"
            ),
        ),
        (
            "H has only slight influence (Fig. 5a)",
            "does not hold",
            format!(
                "F_a(d=0) falls to half of F_a,max at κ = {half} for H = 0.1, 0.45, 0.9 (`figure-5a`), but at \
                 κ = {:.2} to {:.2} for all H if the profile has only 16 waves (`equation-15`)",
                narrow.0, narrow.1
            ),
        ),
        (
            "F_a ∝ F_n in the pressure-sensitive regime",
            "in part",
            format!(
                "the ratio of the mean F_a to F_n varies by a factor of {} at κ = 6, {} at κ = 8, {} at κ = 10: `asperity run \
                 pressure-sensitive --set adhesion.kappa=6 --preloads 0.5uN..40uN:80 --profiles 128`",
                factors[0], factors[1], factors[2]
            ),
        ),
        (
            "F_a/F_n is very large at the boundary and falls with κ (Fig. 5b)",
            "holds",
            format!(
                "F_a/F_n = {at_two} at κ = 2 for F_n = 1, 0.1, 0.01 E\\* h L; the ratio falls as κ grows: `figure-6`"
            ),
        ),
        (
            "after a maximum F_a/F_n falls exponentially (Fig. 6c)",
            "in part",
            format!(
                "there is no maximum; at F_n = E\\* h L F_a/F_n falls about as e^({slope:.2} κ) from κ = 8 to 16, \
                 then faster: {far} at κ = 16, 32, 44: `figure-6`"
            ),
        ),
        (
            "adhesion vanishes in the corner of large κ and H (Fig. 5b)",
            "in part",
            format!(
                "at κ = 12.5 and F_n = E\\* h L, F_a/F_n falls with H, from {} for H = 0.1 to {} for H = 0.9; at κ = 25 and \
                 F_n = 0.01 E\\* h L, F_a/F_n is smallest for H = 0.1, {} against {} for H = 0.9: `figure-5b`",
                near[0], near[1], beyond[0], beyond[1]
            ),
        ),
    ];
    let rows = rows
        .into_iter()
        .map(|(claim, verdict, shown)| [claim.to_owned(), verdict.to_owned(), shown]);
    check(
        "docs/findings.md",
        "claims",
        &markdown(["claim of the paper", "here", "shown by"], rows),
    );
}

/// A number with two significant digits.
fn two_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.1e}").parse().unwrap();
    if (1e-3..1e4).contains(&rounded) {
        rounded.to_string()
    } else {
        format!("{value:.0e}")
    }
}
