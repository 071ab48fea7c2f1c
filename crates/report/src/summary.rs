//! Summary of a computed scene as text.

use crate::ensemble::{headline, rounded};
use crate::sheet::Sheet;
use crate::trust::add_trust;
use crate::warnings::{counted_section, warnings_section};
use asperity_contact::{Move, Work};
use asperity_data::{Warning, Wording, format_quantity, grouped};
use asperity_scene::discretisation::Choice;
use asperity_scene::loading::loading_text;
use asperity_scene::workload::Timings;
use asperity_scene::{Estimate, Outcome, Regime, Scene};
use asperity_study::{Ensemble, Quantity};

/// Largest number of loading stages, or of repeated groups of stages, that the summary lists. Of
/// the other stages, it states only the number.
const MOST_STAGES: usize = 8;

/// Results of a scene that the summary contains.
#[derive(Clone, Copy)]
pub(crate) struct Summary<'a> {
    pub(crate) scene: &'a Scene,
    /// Results on the profile with the seed of the scene.
    pub(crate) outcome: &'a Outcome,
    /// Estimated error of the pull-off force; `None` if it is unknown.
    pub(crate) estimate: Option<&'a Estimate>,
    /// Choice of the number of springs for a tolerance; `None` if no tolerance was given.
    pub(crate) choice: Option<&'a Choice>,
    /// Results over random profiles; `None` if they were not computed.
    pub(crate) ensemble: Option<&'a Ensemble>,
    /// Standard deviation in N of the pull-off force due to the uncertainty of the spectrum of a
    /// measured surface; `None` if it was not computed.
    pub(crate) deviation: Option<f64>,
    pub(crate) wording: Wording,
}

impl Summary<'_> {
    /// Returns the results as plain text of at most 80 columns. The results over random profiles
    /// come first, and then the results on the profile with the seed of the scene.
    pub(crate) fn text(&self) -> String {
        let outcome = self.outcome;
        let mut sheet = Sheet::default();
        sheet.paragraph(&self.scene.title);
        sheet.paragraph(&self.scene.notice);
        match self.ensemble {
            Some(ensemble) => {
                counted_section(&mut sheet, &ensemble.warnings(), ensemble.profiles());
                headline(&mut sheet, ensemble);
            }
            None => {
                warnings_section(&mut sheet, &outcome.warnings);
                if self.scene.seed().is_none() {
                    sheet.heading(Ensemble::FIXED);
                }
            }
        }
        add_line(&mut sheet, outcome);
        add_bodies(&mut sheet, outcome);
        self.add_adhesion(&mut sheet);
        add_trust(
            &mut sheet,
            self.scene,
            outcome,
            self.estimate,
            self.ensemble,
            self.deviation,
            self.wording,
        );
        add_contact(&mut sheet, outcome);
        add_cost(&mut sheet, &outcome.history.work, &outcome.timings);
        if let Some(choice) = self.choice {
            let mut sentence = choice.sentence();
            if outcome.warnings.iter().any(Warning::leaves_errors_unknown) {
                sentence += " It does not include what follows from the warnings above.";
            }
            sheet.heading(&sentence);
        }
        sheet.into_text()
    }

    fn add_adhesion(&self, sheet: &mut Sheet) {
        let outcome = self.outcome;
        let figures = &outcome.figures;
        sheet.heading("Adhesion");
        sheet.row("loading", loading(&self.scene.loading));
        add_deciding_shares(sheet, outcome);
        sheet.quantity("preload F_n", figures.preload, "N");
        sheet.quantity("at indentation", figures.preload_indentation, "m");
        let error = match self.estimate {
            Some(estimate) => format!(", {}", estimate.words()),
            None if figures.pull_off_force.is_some() => ", error unknown".to_owned(),
            None => String::new(),
        };
        sheet.row("pull-off force F_a", pull_off_force(outcome) + &error);
        let steps = outcome.history.step_error();
        sheet.quantity("error of time steps", steps, "N");
        sheet.quantity("pull-off indentation", figures.pull_off_indentation, "m");
        sheet.quantity("coefficient F_a/F_n", figures.adhesion_coefficient, "1");
        let share = outcome
            .adhesion_share()
            .map(|share| rounded(Quantity::AdhesionShare, share, 4));
        sheet.row_of("share F_a/F_a,max", share);
        let at_touch = outcome.first_touch_pull_off_force;
        sheet.quantity("at first touch F_a(d=0)", at_touch, "N");
        let at_zero_force = outcome.zero_force_pull_off_force;
        sheet.quantity("at zero force F_a(F=0)", at_zero_force, "N");
        sheet.quantity("smooth body F_smooth", outcome.smooth_pull_off_force, "N");
        let wave_ratio = outcome.steep_waves.map(|waves| waves.ratio);
        sheet.quantity("λ²/(AR)", wave_ratio, "1");
        sheet.quantity("ideal F_a,max", outcome.ideal_pull_off_force, "N");
        add_dissipated_energy(sheet, outcome);
        if let Some(instrument) = outcome.instrument {
            sheet.quantity("loading stiffness k", instrument.stiffness, "N/m");
            let displacement = instrument.pull_off_displacement;
            sheet.quantity("pull-off displacement", displacement, "m");
            sheet.quantity("loop area ∮F dD", instrument.loop_area, "J");
        }
    }
}

/// Returns the main results of a computed scene as text: title, κ, e_el/γ, regime, preload,
/// pull-off forces and dissipated energy.
pub fn brief_summary(scene: &Scene, outcome: &Outcome) -> String {
    let at_touch = outcome.first_touch_pull_off_force;
    let mut sheet = Sheet::default();
    sheet.paragraph(&scene.title);
    sheet.quantity("κ = √(h⟨∇z⟩E*/γ)", outcome.governing.kappa, "1");
    sheet.quantity("e_el/γ", outcome.governing.elastic_energy_ratio, "1");
    sheet.row("regime", regime(outcome));
    sheet.quantity("preload F_n", outcome.figures.preload, "N");
    sheet.row("pull-off force F_a", pull_off_force(outcome));
    sheet.quantity("at first touch F_a(d=0)", at_touch, "N");
    add_dissipated_energy(&mut sheet, outcome);
    warnings_section(&mut sheet, &outcome.warnings);
    sheet.into_text()
}

fn add_line(sheet: &mut Sheet, outcome: &Outcome) {
    let facts = &outcome.line;
    // All rows from here on describe one profile.
    match facts.seed {
        Some(seed) => sheet.heading(&format!("Profile of seed {seed}")),
        None => sheet.heading("Profile"),
    }
    let springs = facts.points as u64;
    sheet.row("springs N", grouped(springs));
    let springs_under_body = outcome.history.work.springs;
    if springs_under_body != springs {
        sheet.row("below the form", grouped(springs_under_body));
    }
    sheet.quantity("length L", facts.length, "m");
    sheet.quantity("spacing Δx", facts.spacing, "m");
    if let Some((first, last)) = facts.modes {
        sheet.row("modes", format!("{first} to {}", grouped(last)));
        let longest = format_quantity(facts.length / first as f64, "m");
        let shortest = format_quantity(facts.length / last as f64, "m");
        sheet.row("waves", format!("{longest} to {shortest}"));
    }
    let Some(amplitude) = outcome.governing.amplitude else {
        sheet.row("roughness", "none");
        return;
    };
    sheet.quantity("rms height h", amplitude.rms_height, "m");
    let mut gradient = format_quantity(amplitude.rms_gradient, "1");
    if let Some(continuum) = facts.continuum_rms_gradient
        && continuum > 0.0
    {
        let continuum = format_quantity(continuum, "1");
        gradient += &format!(" (by the integrals of eq. 12: {continuum})");
    }
    sheet.row("rms gradient ⟨∇z⟩", gradient);
}

fn add_bodies(sheet: &mut Sheet, outcome: &Outcome) {
    let governing = &outcome.governing;
    sheet.heading("Bodies");
    sheet.quantity("effective modulus E*", governing.modulus, "Pa");
    match governing.work_of_adhesion {
        Some(work) => sheet.quantity("work of adhesion γ", work, "J/m²"),
        None => sheet.row("work of adhesion γ", "none"),
    }
    sheet.quantity("on closing γ₁", governing.closing_work, "J/m²");
    sheet.quantity("elastic energy e_el", governing.elastic_energy(), "J/m²");
    sheet.quantity("κ = √(h⟨∇z⟩E*/γ)", governing.kappa, "1");
    sheet.quantity("e_el/γ", governing.elastic_energy_ratio, "1");
}

/// Returns the regime of adhesion in words, with the turning point of the loading for which it
/// holds.
fn regime(outcome: &Outcome) -> String {
    let is_adhesive = outcome.governing.adhesive_work().is_some();
    let Some(regime) = outcome.regime else {
        let reason = if is_adhesive && outcome.figures.pull_off_force.is_some() {
            // Only a half-space that relaxes has a pull-off force and no regime.
            "none: the regimes are those of an elastic half-space"
        } else if is_adhesive {
            "not known: the loading does not pull the bodies off"
        } else {
            "none: no adhesion"
        };
        return reason.to_owned();
    };
    let name = regime.name();
    if !is_adhesive {
        return format!("{name}: the scene has no adhesion");
    }
    let both_protocols = match outcome.regime_after_zero_force {
        Some(other) if other != regime => {
            let already = zero_force_adhesion(outcome);
            return format!(
                "{name} turned at first touch; turned at zero force already at {already}"
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
    format!("{name} turned at first touch{both_protocols}: {meaning}")
}

/// Returns in words how much adhesion remains after a loading turned at zero force: `62 % of F_a`,
/// `full adhesion`.
fn zero_force_adhesion(outcome: &Outcome) -> String {
    let at_zero_force = outcome.zero_force_pull_off_force;
    let percent = match (at_zero_force, outcome.figures.pull_off_force) {
        (Some(part), Some(whole)) => (100.0 * part / whole).round(),
        _ => 100.0,
    };
    if percent < 100.0 {
        format!("{percent} % of F_a")
    } else {
        "full adhesion".to_owned()
    }
}

/// Adds the regime, and the ratios of pull-off forces from which the regime follows.
fn add_deciding_shares(sheet: &mut Sheet, outcome: &Outcome) {
    sheet.row("regime", regime(outcome));
    if outcome.regime.is_none() {
        return;
    }
    let adhesion = outcome.figures.pull_off_force;
    let preload = outcome.figures.preload;
    let first_touch = outcome.first_touch_pull_off_force;
    let zero_force = outcome.zero_force_pull_off_force;
    let smooth = outcome.smooth_pull_off_force;

    let of_whole = Threshold {
        value: Regime::INSENSITIVE_SHARE,
        reached: "most of it",
        below: "less than half",
    };
    let of_smooth = Threshold {
        value: Regime::VANISHING_SHARE,
        reached: "adhesion",
        below: "vanished",
    };
    add_share(sheet, "  F_a(d=0)/F_a", first_touch, adhesion, &of_whole);
    add_share(
        sheet,
        "  F_a(d=0)/F_smooth",
        first_touch,
        smooth,
        &of_smooth,
    );
    add_share(sheet, "  F_a(F=0)/F_a", zero_force, adhesion, &of_whole);
    add_share(sheet, "  F_a(F=0)/F_smooth", zero_force, smooth, &of_smooth);

    let has_no_preload = preload.is_some_and(|preload| preload <= 0.0);
    if has_no_preload && first_touch != adhesion {
        let without_preload = Threshold {
            value: Regime::VANISHING_SHARE,
            reached: "adhesion without a preload",
            below: "vanished without a preload",
        };
        add_share(sheet, "  F_a/F_smooth", adhesion, smooth, &without_preload);
    }
    let of_preload = Threshold {
        value: Regime::NEGLIGIBLE_COEFFICIENT,
        reached: "not negligible",
        below: "negligible",
    };
    add_share(sheet, "  F_a/F_n", adhesion, preload, &of_preload);
}

/// Value with which a ratio is compared, and the two possible conclusions.
struct Threshold {
    value: f64,
    /// Conclusion if the ratio is at least the threshold.
    reached: &'static str,
    /// Conclusion if the ratio is below the threshold.
    below: &'static str,
}

/// Adds a row with the ratio of `part` to `whole`, its threshold and the conclusion.
fn add_share(
    sheet: &mut Sheet,
    label: &str,
    part: Option<f64>,
    whole: Option<f64>,
    threshold: &Threshold,
) {
    let (Some(part), Some(whole)) = (part, whole) else {
        return;
    };
    // A ratio to zero has no meaning.
    if whole.is_nan() || whole <= 0.0 {
        return;
    }
    // The decision of the regime compares the same products and not the ratio, so that rounding
    // cannot lead to another conclusion here.
    let (side, conclusion) = if part >= threshold.value * whole {
        ("at least", threshold.reached)
    } else {
        ("below", threshold.below)
    };
    let share = format_quantity(part / whole, "1");
    let value = threshold.value;
    sheet.row(label, format!("{share}, {side} {value}: {conclusion}"));
}

/// Adds the dissipated energy, and the Tabor number, which shows whether the model gives a valid
/// energy.
fn add_dissipated_energy(sheet: &mut Sheet, outcome: &Outcome) {
    let Some(energy) = outcome.figures.dissipated_energy else {
        return;
    };
    sheet.quantity("dissipated energy", energy, "J");
    sheet.quantity("Tabor number μ", outcome.tabor_number, "1");
}

fn pull_off_force(outcome: &Outcome) -> String {
    match outcome.figures.pull_off_force {
        Some(force) => format_quantity(force, "N"),
        None => "none: the loading does not pull the bodies off".to_owned(),
    }
}

/// Returns the loading in words: the first stages, and the number of the other stages.
fn loading(stages: &[Move]) -> String {
    let text = loading_text(stages, format_quantity);
    let Some((end, _)) = text.match_indices(", ").nth(MOST_STAGES - 1) else {
        return text;
    };
    let listed = &text[..=end];
    let more = text[end + 1..].split(", ").count();
    format!("{listed} and {more} more stages")
}

/// Adds the state of the contact at the end of the loading.
fn add_contact(sheet: &mut Sheet, outcome: &Outcome) {
    let Some(end) = outcome
        .history
        .stages
        .last()
        .and_then(|stage| stage.curve.last())
    else {
        return;
    };
    sheet.heading("At the end");
    sheet.quantity("indentation d", end.indentation, "m");
    if end.springs == 0 {
        sheet.row("contact", "none: separated");
        return;
    }
    sheet.quantity("force F", end.force, "N");
    let length = format_quantity(end.contact_length, "m");
    let percent = format_quantity(100.0 * end.contact_length / outcome.line.length, "1");
    sheet.row("contact length", format!("{length}, {percent} % of L"));
    sheet.row("contact patches", grouped(end.patches));
}

/// Adds the counts of work of the solver, and the computing times of its stages.
fn add_cost(sheet: &mut Sheet, work: &Work, timings: &Timings) {
    sheet.heading("Work");
    for (label, count) in counts(work) {
        if count > 0 {
            sheet.row(label, grouped(count));
        }
    }
    let stages = [
        ("profile", timings.profile),
        ("tree", timings.tree),
        ("loop", timings.passes),
        ("curve", timings.curve),
        ("without preload", timings.without_preload),
    ];
    let stages = stages.map(|(stage, seconds)| {
        let time = format_quantity(seconds, "s");
        format!("{stage} {time}")
    });
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
        ("sweeps to equilibrium", work.equilibrium_sweeps),
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
        // Computing times and counts of work may vary. Fixed numbers replace them, so that the text
        // of the summary is always the same.
        outcome.timings = Timings {
            profile: 1.5e-3,
            ..Timings::default()
        };
        let springs = outcome.history.work.springs;
        outcome.history.work = Work::default();
        let work = &mut outcome.history.work;
        (work.springs, work.tree_nodes, work.attached) = (springs, springs, 1_234_567);
        text(scene, &outcome, None)
    }

    fn text(scene: &Scene, outcome: &Outcome, estimate: Option<&Estimate>) -> String {
        let summary = Summary {
            wording: |remedy| format!("{remedy:?}"),
            scene,
            outcome,
            estimate,
            choice: None,
            ensemble: None,
            deviation: None,
        };
        summary.text()
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
    fn a_pull_off_force_has_its_error() {
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
        let force = format_quantity(outcome.figures.pull_off_force.unwrap(), "N");
        let of_force = with(Target::PullOffForce, 0.0123);
        assert!(
            row(&of_force).ends_with(&format!("{force}, grid ± 1.2 %")),
            "{of_force}"
        );
        let near_step = with(Target::PullOffForce, 1.4);
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
        let whole = with(Target::PullOffForce, 0.01);
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

    /// With a narrow band of long waves, the two turning points give different regimes, so that
    /// each regime is named with its turning point. After a turn at first touch there is little
    /// adhesion, after a turn at zero force full adhesion.
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
            outcome.zero_force_pull_off_force =
                outcome.zero_force_pull_off_force.map(|force| share * force);
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
