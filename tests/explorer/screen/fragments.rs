//! The close-up of contact patches.

use super::*;
use asperity::contact::Patch;
use asperity::explorer::snapshot::PatchFacts;

#[test]
fn the_close_up_goes_round_all_fragments() {
    let mut driver = Driver::start(rough());
    driver.press("> f");
    let count = driver.point().fragments as usize;
    assert!(count > 3, "{count} fragments");
    for closer in ["", "+ +", "- - - -"] {
        driver.press(closer);
        for key in ["n", "p"] {
            driver.press("f");
            let number = |driver: &Driver| driver.snapshot().close_up.patch.unwrap().number;
            let start = number(&driver);
            let mut seen = Vec::new();
            for _ in 0..count {
                driver.press(key);
                seen.push(number(&driver));
                let expected = format!("patch {} of {count}", number(&driver) + 1);
                assert!(driver.text().contains(&expected), "{expected}: {}", driver.text());
            }
            assert_eq!(number(&driver), start, "{key}: {seen:?}");
            seen.sort_unstable();
            assert_eq!(seen, (0..count).collect::<Vec<_>>(), "{key}");
        }
    }
}

#[test]
fn a_moment_on_its_way_does_not_take_the_chosen_fragment_away() {
    let mut driver = pressed("f");
    let number = |driver: &Driver| driver.snapshot().close_up.patch.unwrap().number;
    let before = driver.snapshot().clone();
    let first = number(&driver);
    // The fragment is requested just after a snapshot requested by the animation.
    let effects = driver.update("next-patch");
    assert_eq!(effects, [Task::Ask]);
    driver.act(Action::Reply(Reply::Shown(before.into())));
    driver.perform(effects);
    assert_eq!(number(&driver), first + 1);
    driver.press(". ,");
    assert_eq!(number(&driver), first + 1);
}

/// Contact patches, from a picture with a column for each spring.
fn fragments(driver: &mut Driver) -> Vec<Patch> {
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

fn facts(driver: &Driver) -> PatchFacts {
    driver.snapshot().close_up.patch.unwrap()
}

#[test]
fn the_close_up_goes_to_the_longest_and_the_most_loaded() {
    for keys in ["", ". . . . . . . .", "> . . ."] {
        let mut driver = pressed(keys);
        let all = fragments(&mut driver);
        assert!(all.len() > 3, "{all:?}");
        let longest = all.iter().map(|patch| patch.springs().len()).max();
        driver.press("b");
        assert!(all.contains(&facts(&driver).patch), "{:?} of {all:?}", facts(&driver));
        assert_eq!(Some(facts(&driver).patch.springs().len()), longest);
        // The selected fragment is shown with its force.
        let mut forces = Vec::new();
        for _ in 0..all.len() {
            driver.press("n");
            forces.push(facts(&driver).state.force);
        }
        let total: f64 = forces.iter().sum();
        let force = driver.point().force;
        assert!((total / force - 1.0).abs() < 1e-9, "together they carry all: {total} {force}");
        let most = forces.iter().map(|force| force.abs()).fold(0.0, f64::max);
        driver.press("B");
        assert_eq!(facts(&driver).state.force.abs(), most);
        driver.press("f");
        let summit = driver.snapshot().close_up.section.clone();
        let highest = summit.columns.iter().map(|column| column.line.1).fold(f64::MIN, f64::max);
        assert_eq!(highest, driver.snapshot().profile.heights.1);
    }
}
