//! The summary of a computed scene for a reader.

use crate::ensemble::{headline, rounded};
use crate::sheet::Sheet;
use crate::trust::trust;
use crate::warnings::{counted_section, warnings_section};
use asperity_contact::{Move, Work};
use asperity_data::{Warning, format_quantity, grouped};
use asperity_scene::discretisation::Choice;
use asperity_scene::loading::loading_text;
use asperity_scene::stages::Timings;
use asperity_scene::{Estimate, Outcome, Regime, Scene};
use asperity_study::{Ensemble, Quantity};

/// Largest number of loading stages, or of repeated groups of stages, that are listed. Further ones
/// are counted.
const MOST_STAGES: usize = 8;

/// Returns the results of a scene as plain text of at most 80 columns. Results over random profiles
/// come first, if they are computed. Results on the own profile follow, with the estimated error of
/// the adhesion force and the number of springs for a tolerance, if they are given. `deviation` is
/// the deviation of the adhesion force due to the spectrum of a measured surface, in N.
pub(crate) fn summary(
    scene: &Scene,
    outcome: &Outcome,
    estimate: Option<&Estimate>,
    choice: Option<&Choice>,
    ensemble: Option<&Ensemble>,
    deviation: Option<f64>,
) -> String {
    let mut sheet = Sheet::default();
    sheet.paragraph(&scene.title);
    sheet.paragraph(&scene.notice);
    match ensemble {
        Some(ensemble) => counted_section(&mut sheet, &ensemble.warnings(), ensemble.profiles()),
        None => warnings_section(&mut sheet, &outcome.warnings),
    }
    match ensemble {
        Some(ensemble) => headline(&mut sheet, ensemble),
        None if scene.seed().is_none() => sheet.heading(Ensemble::FIXED),
        None => {}
    }
    line(&mut sheet, outcome);
    bodies(&mut sheet, outcome);
    adhesion(&mut sheet, scene, outcome, estimate);
    trust(&mut sheet, (scene, outcome), estimate, ensemble, deviation);
    contact(&mut sheet, outcome);
    cost(&mut sheet, &outcome.history.work, &outcome.timings);
    if let Some(choice) = choice {
        let mut sentence = choice.sentence();
        if outcome.warnings.iter().any(Warning::leaves_errors_unknown) {
            sentence += " It does not include what follows from the warnings above.";
        }
        sheet.heading(&sentence);
    }
    sheet.into_text()
}

/// Returns the main results of a computed scene as text: title, κ, e_el/γ, regime, preload,
/// adhesion forces and dissipated energy.
pub fn brief_summary(scene: &Scene, outcome: &Outcome) -> String {
    let figures = &outcome.figures;
    let mut sheet = Sheet::default();
    sheet.paragraph(&scene.title);
    sheet.quantity("κ = √(h⟨∇z⟩E*/γ)", outcome.governing.kappa, "1");
    sheet.quantity("e_el/γ", outcome.governing.elastic_energy_ratio, "1");
    sheet.row("regime", regime(outcome));
    sheet.quantity("preload F_n", figures.preload, "N");
    sheet.row("adhesion force F_a", adhesion_force(outcome));
    sheet.quantity(
        "at first touch F_a(d=0)",
        outcome.first_touch_adhesion_force,
        "N",
    );
    dissipated_energy(&mut sheet, outcome);
    warnings_section(&mut sheet, &outcome.warnings);
    sheet.into_text()
}

fn quantity(value: Option<f64>, unit: &str) -> Option<String> {
    value.map(|value| format_quantity(value, unit))
}

fn line(sheet: &mut Sheet, outcome: &Outcome) {
    let (facts, amplitude) = (&outcome.line, outcome.governing.amplitude);
    // The numbers from here on are those of one profile.
    sheet.heading(&facts.seed.map_or("Profile".to_owned(), |seed| {
        format!("Profile of seed {seed}")
    }));
    sheet.row("springs N", grouped(facts.points as u64));
    let under_body = outcome.history.work.springs;
    if under_body != facts.points as u64 {
        sheet.row("below the form", grouped(under_body));
    }
    sheet.quantity("length L", facts.length, "m");
    sheet.quantity("spacing Δx", facts.spacing, "m");
    if let Some((first, last)) = facts.modes {
        sheet.row("modes", format!("{} to {}", first, grouped(last)));
        let [longest, shortest] =
            [first, last].map(|mode| format_quantity(facts.length / mode as f64, "m"));
        sheet.row("waves", format!("{longest} to {shortest}"));
    }
    match amplitude {
        None => sheet.row("roughness", "none"),
        Some(amplitude) => {
            sheet.quantity("rms height h", amplitude.rms_height, "m");
            let dense = facts
                .continuum_rms_gradient
                .filter(|&gradient| gradient > 0.0);
            let dense = quantity(dense, "1").map_or_else(String::new, |gradient| {
                format!(" (by the integrals of eq. 12: {gradient})")
            });
            sheet.row(
                "rms gradient ⟨∇z⟩",
                format_quantity(amplitude.rms_gradient, "1") + &dense,
            );
        }
    }
}

fn bodies(sheet: &mut Sheet, outcome: &Outcome) {
    let governing = &outcome.governing;
    sheet.heading("Bodies");
    sheet.quantity("effective modulus E*", governing.effective_modulus, "Pa");
    let work = quantity(governing.work_of_adhesion, "J/m²");
    sheet.row("work of adhesion γ", work.unwrap_or_else(|| "none".into()));
    sheet.quantity("on closing γ₁", governing.closing_work, "J/m²");
    sheet.quantity("elastic energy e_el", governing.elastic_energy(), "J/m²");
    sheet.quantity("κ = √(h⟨∇z⟩E*/γ)", governing.kappa, "1");
    sheet.quantity("e_el/γ", governing.elastic_energy_ratio, "1");
}

fn adhesion(sheet: &mut Sheet, scene: &Scene, outcome: &Outcome, estimate: Option<&Estimate>) {
    let figures = &outcome.figures;
    sheet.heading("Adhesion");
    sheet.row("loading", loading(&scene.loading));
    deciding_shares(sheet, outcome);
    sheet.quantity("preload F_n", figures.preload, "N");
    sheet.quantity("at indentation", figures.preload_indentation, "m");
    let force = figures.adhesion_force.is_some();
    let error = estimate.map_or_else(
        || force.then(|| "error unknown".to_owned()),
        |one| Some(one.words()),
    );
    let error = error.map_or_else(String::new, |error| format!(", {error}"));
    sheet.row("adhesion force F_a", adhesion_force(outcome) + &error);
    sheet.quantity("pull-off indentation", figures.pull_off_indentation, "m");
    sheet.quantity("coefficient F_a/F_n", figures.adhesion_coefficient, "1");
    let share = outcome
        .adhesion_share()
        .map(|share| rounded(Quantity::AdhesionShare, share, 4));
    sheet.row_of("share F_a/F_a,max", share);
    sheet.quantity(
        "at first touch F_a(d=0)",
        outcome.first_touch_adhesion_force,
        "N",
    );
    sheet.quantity(
        "at zero force F_a(F=0)",
        outcome.zero_force_adhesion_force,
        "N",
    );
    sheet.quantity("smooth body F_smooth", outcome.smooth_adhesion_force, "N");
    sheet.quantity("λ²/(AR)", outcome.steep_waves.map(|waves| waves.ratio), "1");
    sheet.quantity("ideal F_a,max", outcome.ideal_adhesion_force, "N");
    dissipated_energy(sheet, outcome);
    if let Some(instrument) = outcome.instrument {
        sheet.quantity("loading stiffness k", instrument.stiffness, "N/m");
        sheet.quantity(
            "pull-off displacement",
            instrument.pull_off_displacement,
            "m",
        );
        sheet.quantity("loop area ∮F dD", instrument.loop_area, "J");
    }
}

fn regime(outcome: &Outcome) -> String {
    let adhesive = outcome.governing.adhesive_work().is_some();
    let Some(regime) = outcome.regime else {
        let why = if adhesive {
            "not known: the loading does not pull the bodies off"
        } else {
            "none: no adhesion"
        };
        return why.to_owned();
    };
    if !adhesive {
        return format!("{}: the scene has no adhesion", regime.name());
    }
    let both = match outcome.regime_after_zero_force {
        Some(other) if other != regime => {
            let share = outcome
                .zero_force_adhesion_force
                .zip(outcome.figures.adhesion_force);
            let percent = share.map_or(100.0, |(part, whole)| (100.0 * part / whole).round());
            let already = if percent < 100.0 {
                format!("{percent} % of F_a")
            } else {
                "full adhesion".to_owned()
            };
            return format!(
                "{} turned at first touch; turned at zero force already at {already}",
                regime.name()
            );
        }
        Some(_) => " and at zero force",
        None => "",
    };
    let meaning = match regime {
        Regime::PressureInsensitive => "adhesion hardly needs a preload",
        Regime::PressureSensitive => "adhesion is small without a preload",
        Regime::NonAdhesive => "almost no adhesion, also after the preload",
    };
    format!("{} turned at first touch{both}: {meaning}", regime.name())
}

fn deciding_shares(sheet: &mut Sheet, outcome: &Outcome) {
    sheet.row("regime", regime(outcome));
    if outcome.regime.is_none() {
        return;
    }
    let (first_touch, adhesion) = (
        outcome.first_touch_adhesion_force,
        outcome.figures.adhesion_force,
    );
    let (zero_force, smooth) = (
        outcome.zero_force_adhesion_force,
        outcome.smooth_adhesion_force,
    );
    let preload = outcome.figures.preload;
    let says = ["most of it", "less than half"];
    share(
        sheet,
        "  F_a(d=0)/F_a",
        first_touch,
        adhesion,
        Regime::INSENSITIVE_SHARE,
        says,
    );
    let says = ["adhesion", "vanished"];
    share(
        sheet,
        "  F_a(d=0)/F_smooth",
        first_touch,
        smooth,
        Regime::VANISHING_SHARE,
        says,
    );
    let says = ["most of it", "less than half"];
    share(
        sheet,
        "  F_a(F=0)/F_a",
        zero_force,
        adhesion,
        Regime::INSENSITIVE_SHARE,
        says,
    );
    let says = ["adhesion", "vanished"];
    share(
        sheet,
        "  F_a(F=0)/F_smooth",
        zero_force,
        smooth,
        Regime::VANISHING_SHARE,
        says,
    );
    if preload.is_some_and(|preload| preload <= 0.0) && first_touch != adhesion {
        let says = ["adhesion without a preload", "vanished without a preload"];
        share(
            sheet,
            "  F_a/F_smooth",
            adhesion,
            smooth,
            Regime::VANISHING_SHARE,
            says,
        );
    }
    let says = ["not negligible", "negligible"];
    share(
        sheet,
        "  F_a/F_n",
        adhesion,
        preload,
        Regime::NEGLIGIBLE_COEFFICIENT,
        says,
    );
}

/// Adds a row on the share of `part` in `whole`, with its threshold and the conclusion: `from_on`
/// at or above the threshold, `below` otherwise.
fn share(
    sheet: &mut Sheet,
    label: &str,
    part: Option<f64>,
    whole: Option<f64>,
    threshold: f64,
    [from_on, below]: [&str; 2],
) {
    // A share of zero has no meaning.
    let (Some(part), Some(whole)) = (part, whole.filter(|&whole| whole > 0.0)) else {
        return;
    };
    // Products, as in the comparison of the regime itself.
    let (side, says) = if part >= threshold * whole {
        ("at least", from_on)
    } else {
        ("below", below)
    };
    let share = format_quantity(part / whole, "1");
    sheet.row(label, format!("{share}, {side} {threshold}: {says}"));
}

/// Adds rows with the dissipated energy and the Tabor number, which shows whether the energy is
/// valid.
fn dissipated_energy(sheet: &mut Sheet, outcome: &Outcome) {
    let energy = outcome.figures.dissipated_energy;
    sheet.quantity("dissipated energy", energy, "J");
    // The number shows whether the energy is valid.
    sheet.quantity(
        "Tabor number μ",
        outcome.tabor_number.filter(|_| energy.is_some()),
        "1",
    );
}

fn adhesion_force(outcome: &Outcome) -> String {
    quantity(outcome.figures.adhesion_force, "N")
        .unwrap_or_else(|| "none: the loading does not pull the bodies off".into())
}

fn loading(legs: &[Move]) -> String {
    let text = loading_text(legs, format_quantity);
    match text.match_indices(", ").nth(MOST_STAGES - 1) {
        Some((end, _)) => {
            format!(
                "{} and {} more stages",
                &text[..=end],
                text[end + 1..].split(", ").count()
            )
        }
        None => text,
    }
}

fn contact(sheet: &mut Sheet, outcome: &Outcome) {
    let Some(end) = outcome.history.legs.last().and_then(|leg| leg.curve.last()) else {
        return;
    };
    sheet.heading("At the end");
    sheet.quantity("indentation d", end.indentation, "m");
    if end.springs == 0 {
        return sheet.row("contact", "none: separated");
    }
    sheet.quantity("force F", end.force, "N");
    let length = end.contact_length;
    let share = format_quantity(100.0 * length / outcome.line.length, "1");
    sheet.row(
        "contact length",
        format!("{}, {share} % of L", format_quantity(length, "m")),
    );
    sheet.row("contact patches", grouped(end.fragments));
}

fn cost(sheet: &mut Sheet, work: &Work, timings: &Timings) {
    sheet.heading("Work");
    for (label, count) in counts(work) {
        sheet.row_of(label, (count > 0).then(|| grouped(count)));
    }
    let Timings {
        line,
        tree,
        passes,
        curve,
        without_preload,
    } = *timings;
    let stages = [
        ("line", line),
        ("tree", tree),
        ("loop", passes),
        ("curve", curve),
        ("without preload", without_preload),
    ];
    let stages =
        stages.map(|(stage, seconds)| format!("{stage} {}", format_quantity(seconds, "s")));
    let total = format_quantity(timings.total(), "s");
    sheet.row("time", format!("{total}: {}", stages.join(", ")));
}

fn counts(work: &Work) -> [(&'static str, u64); 15] {
    [
        ("springs", work.springs),
        ("random phases", work.random_phases),
        ("Fourier transforms", work.transforms),
        ("tree nodes", work.tree_nodes),
        ("loading passes", work.loading_passes),
        ("unloading passes", work.unloading_passes),
        ("passes without preload", work.passes_without_preload),
        ("rule of Hess applied", work.hess_evaluations),
        ("events sorted", work.events_sorted),
        ("springs attached", work.attached),
        ("springs detached", work.detached),
        ("steps", work.steps),
        ("relaxation sweeps", work.relaxation_sweeps),
        ("spring updates", work.spring_updates),
        ("heights binned", work.heights_binned),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{Document, Simulation};

    const ROUGH: &str = r#"(
    version: 1,
    title: "Rough",
    notice: "Look here.",
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1),
    adhesion: (kappa: 3.0),
    loading: [ToForce(1.0e-5), ToSeparation],
    numerics: (points: 4096),
)"#;

    fn summary_of(scene: &str, overrides: &[(&str, &str)]) -> String {
        let overrides: Vec<_> = overrides
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        let document = Document::parse(scene, "test")
            .unwrap()
            .set_all(&overrides)
            .unwrap();
        let scene = document.scene();
        let mut outcome = Simulation::default()
            .run(scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        // Without times and the solver's own counts of work.
        outcome.timings = Timings {
            line: 1.5e-3,
            ..Timings::default()
        };
        let springs = outcome.history.work.springs;
        outcome.history.work = Work::default();
        let work = &mut outcome.history.work;
        (work.springs, work.tree_nodes, work.attached) = (springs, springs, 1_234_567);
        text(scene, &outcome, None)
    }

    fn text(scene: &Scene, outcome: &Outcome, estimate: Option<&Estimate>) -> String {
        summary(scene, outcome, estimate, None, None, None)
    }

    #[test]
    fn summaries_read_as_these() {
        let held = [("loading", "[ToForce(1e-5)]"), ("adhesion", "None")];
        insta::assert_snapshot!(
            "pressed_and_held_without_adhesion",
            summary_of(ROUGH, &held)
        );
    }

    #[test]
    fn all_counts_have_a_row() {
        let fields = serde_json::to_value(Work::default()).unwrap();
        assert_eq!(
            counts(&Work::default()).len(),
            fields.as_object().unwrap().len()
        );
    }

    #[test]
    fn an_adhesion_force_has_its_error() {
        use asperity_scene::discretisation::{Evidence, Target};
        let document = Document::parse(ROUGH, "test").unwrap();
        let outcome = Simulation::default()
            .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let with = |target, error| {
            let estimate = Estimate {
                target,
                error,
                near_step: error > 1.0,
                evidence: Evidence::ClosedForm,
            };
            text(document.scene(), &outcome, Some(&estimate))
        };
        let row = |text: &str| {
            text.lines()
                .find(|line| line.contains("force F_a "))
                .unwrap()
                .to_owned()
        };
        let force = format_quantity(outcome.figures.adhesion_force.unwrap(), "N");
        let of_force = with(Target::AdhesionForce, 0.0123);
        assert!(
            row(&of_force).ends_with(&format!("{force}, grid ± 1.2 %")),
            "{of_force}"
        );
        let near_step = with(Target::AdhesionForce, 1.4);
        assert!(
            row(&near_step).ends_with(&format!("{force}, near a step of F_a(F_n)")),
            "{near_step}"
        );
        let unknown = text(document.scene(), &outcome, None);
        assert!(
            row(&unknown).ends_with(&format!("{force}, error unknown")),
            "{unknown}"
        );
        let of_curve = with(Target::Curve, 2e-3);
        assert!(
            row(&of_curve).ends_with(&format!("{force}, grid ± 0.2 % of the curve")),
            "{of_curve}"
        );
        let brief = brief_summary(document.scene(), &outcome);
        let (brief, warnings) = brief.split_once("\nWarnings").unwrap();
        assert!(
            brief.lines().count() <= 10 && warnings.contains("longest waves"),
            "{brief}{warnings}"
        );
        let whole = with(Target::AdhesionForce, 0.01);
        assert!(
            brief
                .lines()
                .all(|line| whole.lines().any(|other| other.starts_with(line))),
            "{brief}{whole}"
        );
    }

    #[test]
    fn a_regime_is_named_only_where_something_pulls() {
        for (overrides, said) in [
            (
                &[("loading", "[ToTouch]")][..],
                "not known: the loading does not pull the bodies off",
            ),
            (
                &[("adhesion", "None")],
                "non-adhesive: the scene has no adhesion",
            ),
            (
                &[("adhesion", "None"), ("loading", "[ToTouch]")],
                "none: no adhesion",
            ),
            (
                &[("adhesion.kappa", "0.1")],
                "pressure-insensitive turned at first touch and at zero",
            ),
            (
                &[("adhesion.kappa", "100.0")],
                "non-adhesive turned at first touch and at zero",
            ),
        ] {
            let text = summary_of(ROUGH, overrides);
            assert!(text.contains(said), "{said}: {text}");
        }
    }

    /// With a band of few long waves the regimes differ and are named with their protocols: little
    /// adheres at first touch, and everything where the force is back at zero.
    #[test]
    fn regimes_that_differ_name_their_protocols() {
        let scene = [
            ("material", "(youngs_modulus: 5.0e6, poisson_ratio: 0.5)"),
            ("length", "1.0e-3"),
            (
                "roughness",
                "SelfAffine(hurst: 0.8, rms_height: 5.0e-7, modes: (4, 512), seed: 1)",
            ),
            ("loading", "[ToForce(1.0e-2), ToSeparation]"),
        ];
        let scene = scene.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = Document::parse(ROUGH, "test")
            .unwrap()
            .set_all(&scene)
            .unwrap();
        for (work, share, said) in [
            (
                "0.03",
                1.0,
                "pressure-sensitive turned at first touch; turned at zero force already at full",
            ),
            (
                "0.03",
                0.62,
                "pressure-sensitive turned at first touch; turned at zero force already at 62 % of F_a",
            ),
            (
                "0.01",
                1.0,
                "pressure-sensitive turned at first touch and at zero force: adhesion is small",
            ),
        ] {
            let document = document
                .set("adhesion", &format!("(work: {work})"))
                .unwrap();
            let mut outcome = Simulation::default()
                .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
                .unwrap();
            outcome.zero_force_adhesion_force =
                outcome.zero_force_adhesion_force.map(|force| share * force);
            assert!(regime(&outcome).starts_with(said), "{}", regime(&outcome));
        }
    }

    #[test]
    fn long_scenes_stay_within_their_columns() {
        let title = format!("\"{}\"", "title ".repeat(30));
        let notice = format!("\"{}\\n\\n{}\"", "x".repeat(300), "notice ".repeat(60));
        let stages = (1..=20).map(|force| format!("ToForce({force}.2345e-6), ToZeroForce, "));
        let loading = format!("[{}ToSeparation]", stages.collect::<String>());
        let text = summary_of(
            ROUGH,
            &[
                ("title", &title),
                ("notice", &notice),
                ("loading", &loading),
            ],
        );
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        assert!(text.contains("and 33 more stages"), "{text}");
    }
}
