//! The close-up of fragments, and how long they are.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::rough;
use super::pressed;
use asperity::explorer::action::{Action, Command, Jump};
use asperity::explorer::update::{Effect, update};

#[test]
fn the_close_up_goes_round_all_fragments() {
    within(60, || {
        let mut driver = Driver::start(rough());
        driver.press("> f");
        let count = driver.model.moment.as_ref().unwrap().point.fragments as usize;
        assert!(count > 3, "{count} fragments");
        for closer in ["", "+ +", "- - - -"] {
            driver.press(closer);
            for key in ["n", "p"] {
                driver.press("f");
                let number =
                    |driver: &Driver| driver.model.moment.as_ref().unwrap().close_up.fragment.unwrap().number;
                let start = number(&driver);
                let mut seen = Vec::new();
                for _ in 0..count {
                    driver.press(key);
                    seen.push(number(&driver));
                    let said = format!("fragment {} of {count}", number(&driver) + 1);
                    assert!(driver.text().contains(&said), "{said}: {}", driver.text());
                }
                assert_eq!(number(&driver), start, "{key}: {seen:?}");
                seen.sort_unstable();
                assert_eq!(seen, (0..count).collect::<Vec<_>>(), "{key}");
            }
        }
    });
}

#[test]
fn a_moment_on_its_way_does_not_take_the_chosen_fragment_away() {
    within(30, || {
        let mut driver = pressed("f");
        let number =
            |driver: &Driver| driver.model.moment.as_ref().unwrap().close_up.fragment.unwrap().number;
        let before = driver.model.moment.clone().unwrap();
        let first = number(&driver);
        // The fragment is asked for while the animation has asked for a moment just before.
        let effects = update(&mut driver.model, Action::Command(Command::Fragment(Jump::Next)));
        assert_eq!(effects, [Effect::Show]);
        driver.act(Action::Shown(before));
        driver.perform(effects);
        assert_eq!(number(&driver), first + 1);
        driver.press(". ,");
        assert_eq!(number(&driver), first + 1);
    });
}

#[test]
fn the_close_up_is_looked_at_from_near_and_from_far() {
    within(30, || {
        let mut driver = pressed("");
        let springs = |driver: &Driver| driver.model.moment.as_ref().unwrap().close_up.section.springs;
        let before = springs(&driver);
        driver.press("+");
        assert_eq!(springs(&driver), before / 2);
        driver.press("- -");
        assert_eq!(springs(&driver), before * 2);
        (0..20).for_each(|_| drop(driver.press("-")));
        assert_eq!(springs(&driver), 1024);
        (0..20).for_each(|_| drop(driver.press("=")));
        assert!((1..=16).contains(&springs(&driver)));
    });
}
