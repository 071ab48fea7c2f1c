//! The close-up of contact patches.

use super::*;
use asperity::contact::Patch;
use asperity::explorer::snapshot::PatchFacts;

#[test]
fn the_close_up_goes_round_all_patches() {
    let mut driver = Driver::start(rough());
    driver.press(">");
    let count = driver.point().patches as usize;
    assert!(count > 3, "{count} patches");
    for closer in ["", "+ +", "- - - -"] {
        driver.press(closer);
        for key in ["n", "p"] {
            let number = |driver: &Driver| driver.snapshot().close_up.patch.unwrap().number;
            let start = number(&driver);
            let mut seen = Vec::new();
            for _ in 0..count {
                driver.press(key);
                seen.push(number(&driver));
                let expected = format!("Patch {} of {count} ·", number(&driver) + 1);
                assert!(
                    driver.text().contains(&expected),
                    "{expected}: {}",
                    driver.text()
                );
            }
            assert_eq!(number(&driver), start, "{key}: {seen:?}");
            seen.sort_unstable();
            assert_eq!(seen, (0..count).collect::<Vec<_>>(), "{key}");
        }
    }
}

#[test]
fn a_moment_on_its_way_does_not_take_the_chosen_patch_away() {
    let mut driver = pressed("");
    let number = |driver: &Driver| driver.snapshot().close_up.patch.unwrap().number;
    let before = driver.snapshot().clone();
    let first = number(&driver);
    // The patch is requested just after a snapshot requested by the animation.
    let effects = driver.update("next-patch");
    assert_eq!(effects, [Task::Ask]);
    driver.act(Action::Reply(Reply::Shown(before.into())));
    driver.perform(effects);
    assert_eq!(number(&driver), first + 1);
    steps(&mut driver, "Right Left");
    assert_eq!(number(&driver), first + 1);
}

/// Contact patches, from a picture with a column for each spring.
fn patches(driver: &mut Driver) -> Vec<Patch> {
    let (size, pane) = (driver.app.view.size, driver.app.view.pane);
    driver.app.view.pane = Pane::Profile;
    driver.press("z");
    // So wide that each spring has columns of its own.
    driver.resize((1100, 40));
    let section = driver.snapshot().profile.clone();
    driver.press("z");
    driver.app.view.pane = pane;
    driver.resize(size);
    Patch::of_springs((0..section.springs).map(|spring| {
        let column = (spring * section.columns.len()).div_ceil(section.springs);
        section.columns[column].contact.is_some()
    }))
}

#[test]
fn the_close_up_holds_the_whole_patch_and_both_its_ends() {
    for keys in ["", ". . . . . . . .", "> . . ."] {
        let mut driver = pressed(keys);
        let all = patches(&mut driver);
        assert!(all.len() > 3, "{all:?}");
        let (mut seen, mut forces) = (Vec::new(), Vec::new());
        for _ in 0..all.len() {
            driver.press("n");
            let PatchFacts { patch, state, .. } = driver.snapshot().close_up.patch.unwrap();
            let shown = &driver.snapshot().close_up.section;
            let part = shown.first..shown.first + shown.springs;
            assert!(
                part.contains(&patch.first) && part.contains(&patch.last),
                "{patch:?} in {part:?}"
            );
            // It fills a good part of the pane, unless it has few springs.
            assert!(
                5 * patch.springs().len() >= shown.springs || shown.springs <= 32,
                "{patch:?} in {part:?}"
            );
            let ends: Vec<usize> = driver
                .snapshot()
                .close_up
                .boundaries
                .iter()
                .map(|end| end.0)
                .collect();
            assert!(
                ends.contains(&patch.first) && ends.contains(&patch.last),
                "{ends:?}"
            );
            driver.shows(format!("of {}", all.len()));
            seen.push(patch);
            forces.push(state.force);
        }
        seen.sort_by_key(|patch| patch.first);
        assert_eq!(seen, all);
        let (total, force): (f64, f64) = (forces.iter().sum(), driver.point().force);
        assert!(
            (total / force - 1.0).abs() < 1e-9,
            "together they carry all: {total} {force}"
        );
    }
}
