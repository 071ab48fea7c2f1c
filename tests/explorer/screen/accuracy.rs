//! The cost of accuracy, the error in the status line, springs for a tolerance.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{changed, rough, without_adhesion};
use super::is_up_to_date;
use super::stand_in::StandIn;
use asperity::accuracy::{
    Choice, ChoiceError, CostTable, ErrorFigure, Estimate, Evidence, Knob, Reference, Row, Target, Timing,
};
use asperity::explorer::action::Action;
use asperity::explorer::app::{Estimated, Message, Pane};
use asperity::explorer::panes::Costs;
use asperity::explorer::runtime::Studies;
use asperity::explorer::study::{Finding, Found, PaneData, Study, Task};
use asperity::explorer::update::Effect;
use asperity::scene::{Document, Edges, Scene};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Springs of 4e-4 at best.
fn choose(tolerance: f64, trying: &mut dyn FnMut(u64)) -> Result<Choice, ChoiceError> {
    trying(2048);
    let choice = Choice {
        tolerance,
        target: Target::AdhesionForce,
        points: 2048,
        edges: Edges::SubCell,
        error: 4e-4,
        closed_form: false,
        finest: 8192,
    };
    if tolerance >= choice.error {
        return Ok(choice);
    }
    Err(ChoiceError::Unreached { tolerance, best: Some(Box::new(choice)) })
}

/// Measures a table of costs in steps.
fn measuring(measured: Result<CostTable, String>) -> StandIn {
    StandIn::new(move |data, _, report| {
        let PaneData::Costs(scene, mut costs) = data else { return Ok(data) };
        costs.trying = Some("sub-cell springs: 32 springs".to_owned());
        report(PaneData::Costs(Arc::clone(&scene), costs.clone()));
        costs.table = measured.clone().ok().map(Arc::new);
        report(PaneData::Costs(Arc::clone(&scene), costs.clone()));
        let table = measured.clone()?;
        Ok(PaneData::Costs(scene, measured_costs(table)))
    })
}

fn measured_costs(table: CostTable) -> Costs {
    Costs { table: Some(Arc::new(table)), trying: None, is_whole: true }
}

/// A row whose error falls with a power of its setting, and whose time grows with it.
fn row(knob: Knob, setting: f64, error: f64) -> Row {
    let figure = ErrorFigure { error: error.max(1e-5), resolved: error > 1e-5, order: None };
    let seconds = if knob == Knob::Step { 2e-12 / setting } else { 1e-7 * setting };
    Row {
        knob,
        setting,
        springs: if knob == Knob::Step { 1024 } else { setting as u64 },
        seconds: Timing::of(vec![seconds]),
        transforms: None,
        errors: [Some(figure), None, None, None],
    }
}

fn table() -> CostTable {
    let springs = || (9..15).map(|power| f64::from(1 << power));
    let mut rows: Vec<Row> = springs().map(|n| row(Knob::SubCellSprings, n, (64.0 / n).powi(2))).collect();
    rows.extend(springs().map(|n| row(Knob::GridSprings, n, 20.0 / n)));
    rows.extend((0..6).map(|k| 1e-8 * 0.5_f64.powi(k)).map(|step| row(Knob::Step, step, 2e6 * step)));
    let reference = Reference {
        springs: 16384,
        adhesion_force: Some(1e-5),
        closed_form: false,
        errors: [Some(1e-5), None, None, None],
    };
    CostTable { budget: 10.0, spent: 1.0, transform_seconds: 1e-2, reference, rows, left_out: Vec::new() }
}

fn estimate(error: f64) -> Option<Estimate> {
    let evidence = Evidence::Solutions(vec![512, 2048]);
    Some(Estimate { target: Target::AdhesionForce, error, near_step: error > 1.0, evidence })
}

fn driver_with(document: Document, estimate: Option<Estimate>, table: Result<CostTable, String>) -> Driver {
    let mut driver = Driver::open(document);
    driver.studies = Studies::Inline(Box::new(StandIn { estimate, choose, ..measuring(table) }));
    driver.perform(vec![Effect::Ask]);
    driver.press("Space");
    driver
}

/// The explorer with everything measured, and shown.
pub fn measured(document: Document) -> Driver {
    let mut driver = driver_with(document, estimate(0.0042), Ok(table()));
    driver.press("A");
    driver
}

#[test]
fn what_accuracy_costs_is_shown_beside_what_can_be_changed() {
    within(60, || {
        let mut driver = measured(changed(&rough(), &[("numerics.edges", "Grid")]));
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            for stated in [
                "order 2.0",
                "order 1.0",
                "1 %: edges between springs: 1 024",
                "whole springs: 2 048",
                "ran 0 s:",
                "◆ 1 024 whole springs",
            ] {
                assert!(driver.text().contains(stated), "{stated} at {size:?}:\n{}", driver.text());
            }
        }
        driver.press("A");
        assert_eq!((driver.app.view.large, driver.app.view.pane), (None, Pane::Force));
        assert!(driver.text().contains("Profile"), "{}", driver.text());
        // Costs are not measured twice.
        assert!(driver.app.studies.appraisal.costs.is_whole);
        assert_eq!(driver.press("A"), [Effect::Study, Effect::Ask]);
        assert!(driver.text().contains("order 2.0"));
    });
}

#[test]
fn a_scene_with_nothing_to_show_says_so() {
    within(60, || {
        let empty = CostTable { rows: Vec::new(), ..table() };
        let mut driver = driver_with(without_adhesion(), None, Ok(empty));
        driver.press("A");
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            assert!(driver.text().contains("nothing to show"), "{}", driver.text());
            assert!(driver.text().contains("F_a(0) skipped"), "{}", driver.text());
        }
        let short = "the budget of 10 s is spent".to_owned();
        let mut driver = driver_with(rough(), None, Err(short));
        driver.press("A");
        assert!(driver.text().contains("nothing is measured: the budget of 10 s"), "{}", driver.text());
        assert!(driver.text().contains("error unknown"), "{}", driver.text());
    });
}

#[test]
fn an_edit_forgets_what_was_found_out() {
    within(60, || {
        let mut driver = measured(rough());
        let before = driver.app.edit.generation;
        // No answers any more.
        driver.studies = Studies::None;
        driver.select("roughness.hurst");
        assert_eq!(driver.press("l"), [Effect::Ask]);
        assert!(driver.app.is_shown(Pane::Accuracy));
        assert_eq!(driver.app.studies.appraisal.estimated, Estimated::Waiting);
        assert_eq!(driver.app.studies.appraisal.costs, Costs::default());
        assert!(driver.status().contains("± …"), "{}", driver.status());
        assert!(driver.text().contains("measuring"), "{}", driver.text());
        // Late answers change nothing.
        let screen = driver.screen();
        let scene = Arc::new(rough().scene().clone());
        for finding in [
            Finding::Estimated(estimate(0.5)),
            Finding::Extended(trying(&scene, "grid springs: 64 springs")),
            Finding::Extended(PaneData::Costs(Arc::clone(&scene), measured_costs(table()))),
            Finding::NotExtended(Pane::Accuracy, "late".to_owned()),
        ] {
            assert!(driver.act(Action::Found(Found { generation: before, finding })).is_empty());
            assert_eq!(driver.screen(), screen);
        }
    });
}

#[test]
fn the_headline_has_its_error_and_its_time() {
    within(60, || {
        let stated = |error: Option<f64>| driver_with(rough(), error.and_then(estimate), Ok(table()));
        let mut driver = stated(Some(0.0042));
        for size in [(120, 40), (80, 24), (60, 20)] {
            driver.resize(size);
            assert!(driver.status().contains("N grid ± 0.4 %"), "{}", driver.status());
        }
        // Times are shown with the counts, in place of the mechanics.
        driver.resize((200, 40));
        driver.press("I");
        assert!(driver.status().trim_end().ends_with(" 0 s"), "{}", driver.status());
        // Reproducible pictures have no times, and wait for nothing.
        driver.app.view.shows_times = false;
        assert!(driver.status().contains("N grid ± 0.4 % "), "{}", driver.status());
        assert!(!driver.status().trim_end().ends_with(" 0 s"), "{}", driver.status());
        driver.app.studies.appraisal.estimated = Estimated::Waiting;
        assert!(!driver.status().contains('±'), "{}", driver.status());
        driver.app.view.shows_times = true;
        assert!(
            driver.status().contains("± …") && driver.status().trim_end().ends_with(" 0 s"),
            "{}",
            driver.status()
        );
        assert!(stated(None).status().contains("N error unknown"), "{}", stated(None).status());
        let near_step = stated(Some(1.4));
        assert!(near_step.status().contains("N near a step of F_a(F_n)"), "{}", near_step.status());
        // Without a pulling force: the largest force, and the error of its curve.
        let curve = Estimate { target: Target::Curve, ..estimate(0.02).unwrap() };
        let driver = driver_with(without_adhesion(), Some(curve), Ok(table()));
        assert!(driver.status().starts_with("F_max 20 µN curve, grid ± 2 %"), "{}", driver.status());
    });
}

/// Types a tolerance.
fn ask(driver: &mut Driver, tolerance: &str) {
    driver.press("%");
    driver.type_text(tolerance);
    driver.press("Enter");
}

#[test]
fn a_tolerance_is_an_edit_that_can_be_taken_back() {
    within(60, || {
        let mut driver = measured(changed(&rough(), &[("numerics.edges", "Grid")]));
        let before = driver.app.edit.document.scene().numerics;
        ask(&mut driver, "0.1 %");
        let after = driver.app.edit.document.scene().numerics;
        assert_eq!((after.points, after.edges), (2048, Edges::SubCell));
        assert!(is_up_to_date(&driver.app) && driver.app.studies.appraisal.choosing.is_none());
        assert!(driver.status().contains("2 048 springs"), "{}", driver.status());
        let answer = driver.app.studies.appraisal.answer.clone().unwrap();
        assert!(answer.contains("the fewest found to keep the adhesion force within 1e-3"), "{answer}");
        assert!(driver.text().contains("2 048 springs with edges SubCell: the fewest"), "{}", driver.text());
        // The known error is from finer solutions than an estimate.
        assert!(
            matches!(&driver.app.studies.appraisal.estimated, Estimated::Known(known) if known.error == 4e-4)
        );
        let generation = driver.app.edit.generation;
        ask(&mut driver, "0.1 %");
        assert_eq!(driver.app.edit.generation, generation, "it is so already");
        assert!(driver.status().contains("as it is"), "{}", driver.status());
        driver.press("u");
        assert_eq!(driver.app.edit.document.scene().numerics, before);
        assert!(driver.app.studies.appraisal.answer.is_none());
    });
}

#[test]
fn a_tolerance_out_of_reach_changes_nothing() {
    within(60, || {
        let mut driver = measured(rough());
        driver.resize((80, 24));
        let (text, generation) = (driver.app.edit.document.text().to_owned(), driver.app.edit.generation);
        ask(&mut driver, "1e-6");
        assert!(matches!(driver.app.message, Some(Message::Error(_))));
        let stated = "1e-6 is out of reach: 4.0e-4 with 2 048 springs, edges SubCell";
        assert!(driver.status().contains(stated), "{}", driver.status());
        for wrong in ["", "0", "2", "much", "-1 %"] {
            ask(&mut driver, wrong);
            assert!(driver.status().contains("allowed: a relative error"), "{wrong}: {}", driver.status());
        }
        driver.press("% 1 Esc");
        assert!(driver.app.message.is_none() && driver.app.studies.appraisal.choosing.is_none());
        assert_eq!(
            (driver.app.edit.document.text(), driver.app.edit.generation),
            (text.as_str(), generation)
        );
        // No choice for a missing scene.
        let mut driver = Driver::open(rough());
        driver.press("%");
        assert!(driver.status().contains("not before"), "{}", driver.status());
    });
}

const PATIENCE: Duration = Duration::from_secs(20);

fn trying(scene: &Arc<Scene>, setting: &str) -> PaneData {
    let costs = Costs { trying: Some(setting.to_owned()), ..Costs::default() };
    PaneData::Costs(Arc::clone(scene), costs)
}

fn measure(scene: &Arc<Scene>) -> Task {
    Task::Extend { data: PaneData::Costs(Arc::clone(scene), Costs::default()), waits: true }
}

fn endless() -> (Study, Receiver<Found>, Receiver<&'static str>) {
    let (sender, events) = channel();
    let (report, reports) = channel();
    let endless = StandIn::endless(sender, |data, report| {
        let PaneData::Costs(scene, _) = data else { return data };
        report(trying(&scene, "grid springs: 32 springs"));
        trying(&scene, "too late")
    });
    let study = Study::start(Box::new(endless), move |found| report.send(found).is_ok()).unwrap();
    (study, reports, events)
}

#[test]
fn what_is_measured_ends_as_soon_as_something_else_is_asked_for() {
    within(60, || {
        let (study, reports, events) = endless();
        let scene = Arc::new(rough().scene().clone());
        let next = || reports.recv_timeout(PATIENCE).expect("a finding");
        for round in 1..=2 {
            study.ask(round, vec![measure(&scene)]);
            assert_eq!(events.recv_timeout(PATIENCE), Ok("begun"));
            assert_eq!(next().finding, Finding::Extended(trying(&scene, "grid springs: 32 springs")));
            // An edit stops the measurement, a tolerance takes its place.
            if round == 1 {
                study.stop();
            } else {
                study.ask(round, vec![Task::Choose(Arc::clone(&scene), 0.1)]);
            }
            assert_eq!(events.recv_timeout(PATIENCE), Ok("stopped"));
        }
        // No message was shown in between.
        let chosen = Finding::Chosen(0.1, Err(ChoiceError::Stepwise));
        assert_eq!(next(), Found { generation: 2, finding: chosen });
        // Leaving the explorer ends the study.
        drop(study);
        assert!(reports.recv_timeout(PATIENCE).is_err());
    });
}

#[test]
fn a_key_held_down_begins_nothing() {
    within(60, || {
        let (study, reports, events) = endless();
        let scene = Arc::new(rough().scene().clone());
        for generation in 1..=50 {
            study.ask(generation, vec![measure(&scene)]);
        }
        assert_eq!(events.recv_timeout(PATIENCE), Ok("begun"));
        assert_eq!(reports.recv_timeout(PATIENCE).map(|found| found.generation), Ok(50));
        assert!(events.try_recv().is_err(), "of fifty only the last was begun");
        study.stop();
        assert_eq!(events.recv_timeout(PATIENCE), Ok("stopped"));
    });
}
