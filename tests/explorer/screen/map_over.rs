//! A map of any quantity over any two rows, and the study that begins with it.

use super::*;
use asperity::explorer::map_state::Live;
use asperity::study::{Changes, Plan, Quantity};

/// The explorer on a scene, with its maps.
fn with_maps(document: Document) -> Driver {
    let mut driver = Driver::open_with(document, Simulation::run, |study| study.is::<Live>());
    driver.perform(vec![Task::Ask]);
    driver.press("Space");
    driver
}

fn typed(driver: &Driver) -> &str {
    driver.app.prompt.as_ref().unwrap().line.text()
}

#[test]
fn a_map_has_the_selected_row_and_the_row_edited_before() {
    let mut driver = with_maps(rough());
    driver.select("material.youngs_modulus");
    driver.press("Right");
    driver.select("roughness.rms_height");
    driver.press("M");
    assert_eq!(typed(&driver), "F_a/F_a,max over h × E");
    driver.states("Map F_a/F_a,max over h × E");
    driver.shows_all(["9 × 9 cells, 4 profiles", "Enter"]);
    driver.press("Enter");
    assert_eq!(driver.app.view.pane, Pane::Map);
    driver.shows_all(["Map of F_a/F_a,max over h, E, 4 profiles", "◆ h "]);
    let grid = driver.app.grid().unwrap();
    assert_eq!(grid.size(), (9, 9));
    assert!(
        grid.cells.iter().flatten().all(Result::is_ok),
        "all cells are computed"
    );
    let before = grid.clone();
    // The colours have the scale that suits the values, or the other one.
    let usual = driver.text();
    driver.press("X");
    assert_ne!(driver.text(), usual);
    driver.press("X");
    assert_eq!(driver.text(), usual);
    // Another quantity begins with its own scale.
    driver.press("X V");
    assert_eq!(driver.app.map.scale, None);
    driver.app.map.quantity = Quantity::AdhesionShare;
    assert_eq!(driver.text(), usual);
    // The arrow keys move the scene over the map, which stays.
    let height = |driver: &Driver| driver.document().scene().number("roughness.rms_height");
    let present = height(&driver);
    driver.press("Right");
    assert!(height(&driver) > present, "{:?}", height(&driver));
    assert_eq!(driver.app.grid(), Some(&before));
    // The plan has the same cells on the springs of the scene and the profiles of the explorer.
    driver.press("s");
    driver.states("Save the plan of this map as: rough-line-map.ron");
    driver.press("Enter");
    driver.states("plan saved to rough-line-map.ron");
    let plan = Plan::parse(
        &driver.file("rough-line-map.ron"),
        "plan",
        &Changes::default(),
    )
    .unwrap();
    assert_eq!(
        (plan.cells(), plan.lines, plan.scene.numerics.points),
        (81, 16, 1024)
    );
    // It records what the map shows, and the figure of the study has the same axis across.
    assert_eq!(plan.record, [Quantity::AdhesionShare]);
    let axes: Vec<&str> = plan.axes.iter().map(|axis| axis.path.as_str()).collect();
    assert_eq!(axes, ["roughness.rms_height", "material.youngs_modulus"]);
    // Its scene is the present one, to which an opened study returns.
    let scene = driver.document().scene();
    assert_eq!(plan.scene.title, scene.title);
    assert_eq!(plan.scene.numerics.samples, scene.numerics.samples);
    for path in axes {
        assert_eq!(plan.scene.number(path), scene.number(path), "{path}");
    }
    driver.press("y");
    assert_eq!(
        driver.copied,
        ["asperity sweep rough-line-map.ron -o rough-line-map"]
    );
    // Back to the map over H and κ.
    driver.sees("W", "over H, κ");
}

#[test]
fn the_rows_and_the_quantity_of_a_map_are_typed() {
    let mut driver = with_maps(rough());
    for (typed, title) in [
        ("F_a over F_n × γ", "Map of F_a over force of stage 1, γ"),
        ("dissipated_energy over hurst, length", "over H, L"),
        ("contact_fraction over ν x k", "over ν, k"),
        (
            "F_a/F_n over points * force of stage 1",
            "Map of F_a/F_n over N,",
        ),
        ("F_a over Young's modulus and κ", "over E, κ"),
    ] {
        driver.press("M Ctrl+u");
        driver.type_text(typed);
        driver.press("Enter");
        assert!(
            driver.app.prompt.is_none(),
            "{typed}: {:?}",
            driver.refusal()
        );
        driver.shows(title);
        let grid = driver.app.grid().unwrap_or_else(|| panic!("{typed}"));
        let computed = grid
            .cells
            .iter()
            .flatten()
            .filter(|cell| cell.is_ok())
            .count();
        assert!(computed > grid.cells.len() / 2, "{typed}: {computed}");
    }
    // The mark moves along works of adhesion of a scene that states κ.
    driver.press("M Ctrl+u `F_a over L × γ` Enter Up");
    assert!(
        driver.document().scene().adhesion.unwrap().work().is_some(),
        "{}",
        driver.text()
    );
    driver.press("u");
    for (typed, why) in [
        ("F_a", "two rows"),
        ("F_b over E × h", "no quantity"),
        ("F_a over E × E", "same number"),
        ("F_a over κ × γ", "same number"),
        ("F_a over title × h", "title"),
        ("F_a over qqq × h", "no row with a number is called qqq"),
        ("F_a over  × h", "no row with a number is called"),
    ] {
        driver.press("M Ctrl+u");
        driver.type_text(typed);
        driver.press("Enter");
        assert!(
            driver.refusal().is_some_and(|said| said.contains(why)),
            "{typed}: {:?}",
            driver.refusal()
        );
        driver.press("Esc");
    }
}

#[test]
fn the_next_row_is_chosen_by_a_key() {
    let mut driver = with_maps(rough());
    driver.select("roughness.rms_height");
    driver.press("M");
    let first = typed(&driver).to_owned();
    let mut seen = vec![first.clone()];
    for _ in 0..40 {
        driver.press("Tab");
        let text = typed(&driver).to_owned();
        assert!(
            text.starts_with("F_a/F_a,max over h × ") && !text.ends_with("× h"),
            "{text}"
        );
        seen.push(text);
    }
    assert!(seen[1..].contains(&first), "the rows come again: {seen:?}");
}

#[test]
fn scenes_without_roughness_adhesion_or_force_have_maps_as_well() {
    for document in [smooth(), without_adhesion(), punch()] {
        let mut driver = with_maps(document);
        driver.press("M");
        let text = typed(&driver).to_owned();
        driver.press("Enter");
        assert!(
            driver.app.prompt.is_none(),
            "{text}: {:?}",
            driver.refusal()
        );
        let grid = driver
            .app
            .grid()
            .unwrap_or_else(|| panic!("{text}\n{}", driver.text()));
        assert!(grid.cells.iter().flatten().any(Result::is_ok), "{text}");
    }
    // A row that is a text is not proposed.
    let mut driver = with_maps(rough());
    driver.select("title");
    driver.press("M");
    assert!(!typed(&driver).contains("title"));
}

#[test]
fn a_scene_without_the_numbers_of_a_map_closes_it() {
    let mut driver = with_maps(rough());
    driver.press("M Ctrl+u `F_a over H × h` Enter");
    assert!(driver.app.is_shown(Pane::Map));
    driver.press("o `jkr-sphere` Enter");
    assert_eq!(driver.document().name(), "jkr-sphere");
    assert!(!driver.app.is_shown(Pane::Map), "{}", driver.text());
    driver.hides("no map");
}
