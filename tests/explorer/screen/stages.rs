//! The loading by hand and by list: stages by keys and as text, and the path of manual loading.

use super::*;
use asperity::contact::Move;
use asperity::scene::text::to_ron;

/// The rough scene with a loading, the row of one of its stages selected, of the loading as a whole
/// for 0.
fn loaded(loading: &str, stage: usize) -> Driver {
    let mut driver = Driver::start(changed(&rough(), &[("loading", loading)]));
    select(&mut driver, stage);
    driver
}

fn select(driver: &mut Driver, stage: usize) {
    let rows = &driver.app.edit.parameters;
    let is_row =
        |row: Option<usize>, path: &str| row == stage.checked_sub(1) && path.starts_with("loading");
    driver.app.edit.selected = rows
        .iter()
        .position(|one| is_row(one.stage, &one.path))
        .expect("a row");
}

fn loading(app: &App) -> String {
    let text = to_ron(app.edit.document.scene());
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("    loading: "))
        .expect("the loading");
    line.trim_end_matches(',').to_owned()
}

/// Number of the selected stage, from 1.
fn selected(app: &App) -> Option<usize> {
    app.edit
        .parameter()
        .and_then(|one| one.stage)
        .map(|row| row + 1)
}

#[test]
fn keys_edit_the_stages() {
    let two = "[ToForce(2.0e-5), ToSeparation]";
    for (stage, keys, stages, next) in [
        (
            1,
            "Insert Esc",
            "[ToForce(2.0e-5), ToZeroForce, ToSeparation]",
            2,
        ),
        (
            1,
            "P Esc P Esc",
            "[ToForce(2.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
            3,
        ),
        (
            0,
            "P Esc",
            "[ToForce(2.0e-5), ToSeparation, ToForce(2.0e-5)]",
            3,
        ),
        (2, "Backspace", "[ToForce(2.0e-5)]", 1),
        (0, "Backspace", "[ToForce(2.0e-5)]", 1),
        (1, "P Esc Delete", two, 2),
        (
            1,
            "P Esc Shift+Up",
            "[ToZeroForce, ToForce(2.0e-5), ToSeparation]",
            1,
        ),
        (
            1,
            "P Esc K J",
            "[ToForce(2.0e-5), ToZeroForce, ToSeparation]",
            2,
        ),
        (
            1,
            "P Esc J",
            "[ToForce(2.0e-5), ToSeparation, ToZeroForce]",
            3,
        ),
        // Nothing is in contact after a separation: a second one is left out.
        (
            1,
            "P Esc V",
            "[ToForce(2.0e-5), ToForce(2.0e-5), ToSeparation]",
            2,
        ),
        (1, "V V V V V", "[ToForce(2.0e-5), ToSeparation]", 1),
        (1, "V V V", "[ToTouch, ToSeparation]", 1),
        (1, "l", "[ToForce(2.24e-5), ToSeparation]", 1),
    ] {
        let mut driver = loaded(two, stage);
        driver.press(keys);
        assert_eq!(loading(&driver.app), stages, "{keys}");
        assert_eq!(selected(&driver.app), Some(next), "{keys}");
        assert!(is_up_to_date(&driver.app), "{keys}");
        // Each key is one edit; `Esc` closes the editor of an added stage.
        for _ in keys.split(' ').filter(|key| *key != "Esc") {
            driver.press("u");
        }
        assert_eq!(loading(&driver.app), two, "{keys}");
        assert!(driver.app.edit.past.is_empty(), "{keys}");
    }
}

/// A step of an arrow must not make another loading of the scene.
#[test]
fn arrows_leave_a_stage_without_a_number_as_it_is() {
    for key in ["l", "h", "L", "H", "Right", "Left"] {
        for (loading_text, stage) in [
            ("[ToForce(2.0e-5), ToSeparation]", 2),
            ("[ToForce(2.0e-5), ToZeroForce, ToSeparation]", 2),
            ("[ToTouch]", 1),
        ] {
            let mut driver = loaded(loading_text, stage);
            driver.app.view.pane = Pane::Parameters;
            driver.press(key);
            assert_eq!(loading(&driver.app), loading_text, "{key}");
            assert!(driver.app.edit.past.is_empty(), "{key}");
            driver.states("has no number; V changes its kind");
        }
    }
}

#[test]
fn a_stage_of_another_kind_has_the_state_at_its_end() {
    let mut driver = loaded("[ToForce(2.0e-5), ToSeparation]", 1);
    let end = driver.app.stages()[0].end();
    let preload = driver.outcome().figures.pull_off_force;
    driver.press("V");
    let Move::ToIndentation(to) = driver.document().scene().loading[0] else {
        panic!("an indentation")
    };
    assert!((to / end - 1.0).abs() < 1e-3, "{to} {end}");
    assert_eq!(selected(&driver.app), Some(1));
    // The turning point is nearly the same.
    assert!(preload.is_some() && driver.outcome().figures.pull_off_force.is_some());
    // Back to a force by the text of one.
    driver.enter("20 µN");
    assert_eq!(loading(&driver.app), "[ToForce(2.0e-5), ToSeparation]");
    assert_eq!(selected(&driver.app), Some(1));
    driver.enter("touch");
    assert_eq!(loading(&driver.app), "[ToTouch, ToSeparation]");
    driver.app.view.pane = Pane::Parameters;
    driver.press("2 Space n m Enter");
    assert_eq!(
        loading(&driver.app),
        "[ToIndentation(2.0e-9), ToSeparation]"
    );
}

#[test]
fn what_cannot_be_loaded_is_refused_in_one_line() {
    let (one, two) = ("[ToForce(2.0e-5)]", "[ToForce(2.0e-5), ToSeparation]");
    let mut driver = loaded(one, 1);
    driver.answers("Backspace", "loading = []: allowed: a list of 1 to 100000");
    assert_eq!(loading(&driver.app), one);
    // At the end of the list there is nothing to exchange.
    let mut driver = loaded(two, 2);
    driver.press("J");
    assert!(driver.app.edit.past.is_empty() && selected(&driver.app) == Some(2));
    // What was typed stays in the editor.
    for (stage, typed, why) in [
        (0, "separation", "cannot pull before contact"),
        (0, "10 µN, pull", "\"pull\" is not a stage, such as"),
        (1, "separation", "cannot pull before contact"),
        (1, "1 kN", "is far beyond full contact at "),
        (
            0,
            "2 loops 0 N to 1 kN, separation",
            "is far beyond full contact at ",
        ),
    ] {
        select(&mut driver, stage);
        driver.press(&format!("Enter `{typed}` Enter"));
        let refusal = driver.refusal().unwrap_or_default();
        assert!(refusal.contains(why), "{typed}: {refusal}");
        assert_eq!(driver.app.prompt.as_ref().unwrap().line.text(), typed);
        driver.press("Esc");
    }
    // A pull beyond adhesion is refused once its preview is computed; the stated force is within
    // reach.
    select(&mut driver, 0);
    driver.enter("20 µN, -1 N, separation");
    let refusal = driver.refusal().expect("a refusal").to_owned();
    let (before, least) = refusal
        .split_once("smallest force within reach: ")
        .expect("a reachable value");
    assert!(
        before.contains("stage 2: the contact detaches before -1 N"),
        "{refusal}"
    );
    let least = least.split("N").next().unwrap().to_owned() + "N";
    driver.press("Esc");
    driver.enter(&format!("20 µN, {least}, separation"));
    assert!(is_up_to_date(&driver.app), "{}", driver.status());
}

#[test]
fn the_path_of_manual_loading_becomes_the_loading() {
    for (scene, keys) in [
        (rough(), "d H H L L L"),
        (rough(), "< d L H H H S"),
        (rough(), "d Enter `15 uN` Enter h h Enter `10 uN` Enter"),
        (smooth(), "> d L H L l"),
        (without_adhesion(), "d L L H L"),
        (open("jkr-sphere").unwrap(), "d H H L S"),
    ] {
        let mut driver = Driver::start(scene.clone());
        driver.press("Space >");
        steps(&mut driver, &"Right ".repeat(10));
        driver.press(keys);
        let followed = driver.app.followed().expect("a path").clone();
        let point = driver.point();
        driver.press("d");
        driver.states("the path is the loading, ");
        assert!(driver.app.edit.path.is_none());
        assert_eq!(driver.document().scene().loading, followed.loading());
        assert_eq!(driver.outcome().history.stages, followed.stages, "{keys}");
        // The body stays where it is.
        assert_eq!(driver.point().indentation, point.indentation, "{keys}");
        assert_eq!(driver.point().springs, point.springs, "{keys}");
        // One undo reverts both.
        driver.press("u");
        assert_eq!(driver.document().text(), scene.text());
        assert_eq!(driver.app.followed().unwrap().stages, followed.stages);
        assert_eq!(driver.point(), point);
    }
}
