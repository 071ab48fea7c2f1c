//! The cost of accuracy, the error in the status line, springs for a tolerance.

use super::*;
use asperity::contact::Edges;
use asperity::explorer::commands::accuracy::Choosing;
use asperity::explorer::panes::trust::Costs;
use asperity::scene::Estimate;
use asperity::scene::discretisation::{
    Choice, ChoiceError, CostReference, CostTable, ErrorFigure, Evidence, Knob, Row, Target, Timing,
};

/// Springs of 4e-4 at best, as found by a search.
fn chosen(tolerance: f64) -> Result<Choosing, String> {
    let choice = Choice {
        tolerance,
        target: Target::PullOffForce,
        points: 2048,
        edges: Edges::SubCell,
        error: 4e-4,
        closed_form: false,
        finest: 8192,
    };
    let is_reached = tolerance >= choice.error;
    let unreached = || ChoiceError::Unreached {
        tolerance,
        best: Some(Box::new(choice.clone())),
    };
    let found = Some(if is_reached {
        Ok(choice.clone())
    } else {
        Err(unreached())
    });
    Ok(Choosing {
        tolerance,
        tried: None,
        found,
    })
}

fn costs(table: CostTable) -> Costs {
    Costs {
        table: Some(table),
        trying: None,
    }
}

/// A row whose error falls with a power of its setting, and whose time grows with it.
fn row(knob: Knob, setting: f64, error: f64) -> Row {
    let figure = ErrorFigure {
        error: error.max(1e-5),
        resolved: error > 1e-5,
        order: None,
    };
    let seconds = if knob == Knob::Step {
        2e-12 / setting
    } else {
        1e-7 * setting
    };
    Row {
        knob,
        setting,
        springs: if knob == Knob::Step {
            1024
        } else {
            setting as u64
        },
        seconds: Timing::of(vec![seconds]),
        transforms: None,
        errors: [Some(figure), None, None, None],
    }
}

fn table() -> CostTable {
    let springs = || (9..15).map(|power| f64::from(1 << power));
    let mut rows: Vec<Row> = springs()
        .map(|n| row(Knob::SubCellSprings, n, (64.0 / n).powi(2)))
        .collect();
    rows.extend(springs().map(|n| row(Knob::GridSprings, n, 20.0 / n)));
    rows.extend(
        (0..6)
            .map(|k| 1e-8 * 0.5_f64.powi(k))
            .map(|step| row(Knob::Step, step, 2e6 * step)),
    );
    let reference = CostReference {
        springs: 16384,
        pull_off_force: Some(1e-5),
        closed_form: false,
        errors: [Some(1e-5), None, None, None],
    };
    CostTable {
        budget: 10.0,
        spent: 1.0,
        transform_seconds: 1e-2,
        reference,
        rows,
        left_out: Vec::new(),
    }
}

fn estimate(error: f64) -> Option<Estimate> {
    let evidence = Evidence::Solutions(vec![512, 2048]);
    Some(Estimate {
        target: Target::PullOffForce,
        error,
        near_step: error > 1.0,
        evidence,
    })
}

fn driver_with(
    document: Document,
    estimate: Option<Estimate>,
    table: Result<CostTable, String>,
) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space");
    driver.find(estimate.ok_or_else(String::new));
    driver.find(table.map(costs));
    driver
}

/// The explorer with everything measured, and shown.
pub fn measured(document: Document) -> Driver {
    let mut driver = driver_with(document, estimate(0.0042), Ok(table()));
    driver.press("A");
    driver
}

#[test]
fn a_scene_with_nothing_to_show_says_so() {
    let empty = CostTable {
        rows: Vec::new(),
        ..table()
    };
    let mut driver = driver_with(without_adhesion(), None, Ok(empty));
    driver.press("A");
    for size in [(120, 40), (80, 24)] {
        driver.resize(size);
        driver.shows("nothing to show");
    }
    let short = "the budget of 10 s is spent".to_owned();
    let mut driver = driver_with(rough(), None, Err(short));
    driver.sees("A", "nothing is measured: the budget of 10 s");
    driver.shows("error unknown");
}

#[test]
fn an_edit_forgets_what_was_found_out() {
    let mut driver = measured(rough());
    driver.select("roughness.hurst");
    assert_eq!(driver.press("l"), [Task::Ask]);
    assert!(driver.app.is_shown(Pane::Trust));
    assert!(driver.app.studies.value::<Estimate>().is_none());
    assert!(driver.app.studies.value::<Costs>().is_none());
    driver.states("± …");
    driver.shows("measuring");
    let setting = |setting: &str| Costs {
        table: None,
        trying: Some(setting.to_owned()),
    };
    let generation = driver.app.edit.generation;
    driver
        .app
        .studies
        .set(generation, setting("grid springs: 64 springs"), false);
    driver.shows("trying grid springs: 64 springs…");
}

#[test]
fn the_headline_has_its_error() {
    let stated = |error: Option<f64>| driver_with(rough(), error.and_then(estimate), Ok(table()));
    let mut driver = stated(Some(0.0042));
    for size in [(120, 40), (80, 24), (60, 20)] {
        driver.resize(size);
        driver.states("N, grid ± 0.4 %");
    }
    // Reproducible pictures wait for nothing.
    driver.app.studies.forget::<Estimate>();
    driver.states("± …");
    driver.app.view.shows_times = false;
    assert!(!driver.status().contains('±'), "{}", driver.status());
    assert!(
        stated(None).status().contains("N, error unknown"),
        "{}",
        stated(None).status()
    );
    let near_step = stated(Some(1.4));
    near_step.states("N, near a step of F_a(F_n)");
    // Without a pulling force: the largest force, and the error of its curve.
    let curve = Estimate {
        target: Target::Curve,
        ..estimate(0.02).unwrap()
    };
    let driver = driver_with(without_adhesion(), Some(curve), Ok(table()));
    assert!(
        driver
            .status()
            .starts_with("F_max 20 µN, grid ± 2 % of the curve"),
        "{}",
        driver.status()
    );
}

/// Types a tolerance.
fn ask(driver: &mut Driver, tolerance: &str) {
    driver.press(&format!("% `{tolerance}` Enter"));
    if let Some(Choosing { tolerance, .. }) = driver.app.studies.value() {
        driver.find(chosen(*tolerance));
    }
}

#[test]
fn a_tolerance_is_an_edit_that_can_be_taken_back() {
    let mut driver = measured(changed(&rough(), &[("numerics.edges", "Grid")]));
    let before = driver.document().scene().numerics;
    ask(&mut driver, "0.1 %");
    let after = driver.document().scene().numerics;
    assert_eq!((after.points, after.edges), (2048, Edges::SubCell));
    assert!(is_up_to_date(&driver.app) && driver.app.studies.value::<Choosing>().is_none());
    driver.states("2 048 springs");
    driver.shows("2 048 springs with edges SubCell: the fewest");
    // The known error is from finer solutions than an estimate.
    assert!(
        driver
            .app
            .studies
            .value::<Estimate>()
            .is_some_and(|known| known.error == 4e-4)
    );
    let generation = driver.app.edit.generation;
    ask(&mut driver, "0.1 %");
    assert_eq!(driver.app.edit.generation, generation, "it is so already");
    driver.states("as it is");
    driver.press("u");
    assert_eq!(driver.document().scene().numerics, before);
}

#[test]
fn a_tolerance_out_of_reach_changes_nothing() {
    let mut driver = measured(rough());
    driver.resize((80, 24));
    let (text, generation) = (
        driver.document().text().to_owned(),
        driver.app.edit.generation,
    );
    ask(&mut driver, "1e-6");
    assert!(matches!(driver.app.message, Some(Message::Error(_))));
    let stated = "a tolerance of 1e-6 is not reached with at most";
    driver.states(stated);
    for wrong in ["", "0", "2", "much", "-1 %"] {
        ask(&mut driver, wrong);
        assert!(
            driver.status().contains("allowed: a relative error"),
            "{wrong}: {}",
            driver.status()
        );
    }
    driver.press("% 1 Esc");
    assert!(driver.app.message.is_none() && driver.app.studies.value::<Choosing>().is_none());
    assert_eq!(
        (driver.document().text(), driver.app.edit.generation),
        (text.as_str(), generation)
    );
    // No choice for a missing scene.
    let mut driver = Driver::open(rough());
    driver.answers("%", "still being computed");
}

#[test]
fn the_first_warning_is_in_the_status_line_and_all_are_in_the_pane() {
    let mut driver = Driver::start(changed(&rough(), &[("roughness.modes", "(2, 400)")]));
    driver.press("Space");
    let warnings = asperity_report::warning_texts(&driver.outcome().warnings);
    let [first, _, ..] = &warnings[..] else {
        panic!("two warnings: {warnings:?}")
    };
    let beginning: String = first.chars().take(12).collect();
    driver.resize((160, 40));
    driver.states(format!("! 1 of {} (A): {beginning}", warnings.len()));
    // Where there is no room for words, their number comes before other facts.
    for size in SIZES.into_iter().filter(|(columns, _)| *columns >= 40) {
        driver.resize(size);
        let status = driver.status();
        let number = warnings.len();
        let has_number = status.contains(&format!("! 1 of {number} (A): "))
            || status.contains(&format!("! {number} warnings (A)"));
        assert!(has_number, "{size:?}: {status}");
    }
    driver.resize((160, 40));
    driver.press("A");
    let shown = driver.pane(Pane::Trust).join(" ");
    let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    for warning in &warnings {
        assert!(shown.contains(warning), "{warning}\n{}", driver.text());
    }
    let driver = Driver::start(smooth());
    assert_eq!(
        driver.status().contains("! "),
        !driver.outcome().warnings.is_empty(),
        "{}",
        driver.status()
    );
}

#[test]
fn a_small_window_shows_the_errors_and_the_cost_on_pages() {
    let mut driver = measured(rough());
    driver.shows_all(["Trust: relative error over time", "sample of profiles"]);
    driver.hides("PageDown");
    driver.resize((80, 24));
    // The pane has the whole width.
    assert!(driver.area(Pane::Trust).width >= 79);
    // The chart and the errors are on the first page, which has no blank rows, and the theories on
    // the second one.
    driver.shows_all([
        "Trust: relative error over time, log–log · 1/2 PageDown",
        "springs",
        "this scene",
        "sample of profiles",
    ]);
    driver.hides("Persson");
    driver.press("PageDown");
    driver.shows_all(["Trust: theories · 2/2", "Persson"]);
    driver.hides("relative error over time");
    driver.press("PageDown PageDown");
    driver.shows("2/2");
    // The figure does not depend on the page.
    driver.press("PageUp");
    driver.shows("1/2");
    driver.press("E Ctrl+u `trust.svg` Enter");
    assert!(driver.file("trust.svg").contains("this scene"));
    // Below a certain height there are more pages, and none is empty.
    driver.resize((60, 12));
    let mut pages = vec![driver.text()];
    for _ in 0..8 {
        driver.press("PageDown");
        pages.push(driver.text());
    }
    pages.dedup();
    assert!(pages.len() > 2, "{pages:#?}");
    assert!(pages.last().unwrap().contains("log–log"), "{pages:#?}");
    // The pane begins on its first page when it is shown again.
    driver.press("A A");
    driver.shows("1/");
}
