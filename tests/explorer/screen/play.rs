//! The animation of the loading.

use super::*;
use asperity::explorer::config::Config;
use asperity::explorer::player::{At, Player};
use asperity_contact::Event;

#[test]
fn the_animation_is_paused_stepped_and_begun_again() {
    let mut driver = Driver::start(rough());
    driver.elapse(1.0);
    let before = driver.app.play;
    assert_ne!(before.at, At::Start);
    driver.press("Space");
    assert!(
        driver.elapse(1.0).is_empty(),
        "nothing moves while it is paused"
    );
    assert_eq!(driver.app.play.at, before.at);
    let here = driver.point().indentation;
    driver.press("Tab");
    assert_eq!(driver.app.view.pane, Pane::Timeline);
    driver.press("Right");
    assert!(driver.point().indentation > here);
    driver.press("Left");
    assert!((driver.point().indentation - here).abs() < 1e-15);
    driver.press("Space Right");
    assert!(!driver.app.play.playing, "a step pauses");
    for (keys, stage, at) in [
        ("> >", 1, At::Start),
        ("<", 0, At::Start),
        // First to the start of this stage, and nothing is before.
        ("Right Right <", 0, At::Start),
        ("Left", 0, At::Start),
        // Steps go from stage to stage in both directions.
        ("> Left", 0, At::End),
        ("Right Left", 0, At::End),
        ("Shift+Right End", 1, At::End),
        ("Home", 0, At::Start),
        // Play begins again at the end.
        ("G Space", 0, At::Start),
    ] {
        driver.press(keys);
        assert_eq!(
            (driver.app.play.stage, driver.app.play.at),
            (stage, at),
            "{keys}"
        );
    }
    assert!(driver.app.play.playing);
}

#[test]
fn the_status_line_names_marks_and_rests_while_the_animation_plays() {
    let mut driver = Driver::start(relaxing());
    let mut named: Vec<String> = Vec::new();
    for _ in 0..200 {
        driver.elapse(0.1);
        let status = driver.status();
        if let Some(event) = status.strip_prefix("▶ ") {
            let event = event.split(" · ").next().unwrap_or_default().to_owned();
            if named.last() != Some(&event) {
                named.push(event);
            }
        }
    }
    for event in [
        "passed jump-in",
        "rest for 2 s",
        "passed preload",
        "passed pull-off",
    ] {
        assert!(named.iter().any(|name| name == event), "{event}: {named:?}");
    }
    assert!(!driver.app.play.playing);
    assert!(!driver.status().contains('▶'), "{}", driver.status());
}

/// The pull-off is the state with the smallest force. The state after its jump has another name.
#[test]
fn the_state_after_the_jump_at_the_pull_off_is_not_called_pull_off() {
    let mut driver = Driver::start(default_scene());
    let title = |driver: &Driver| driver.pane(Pane::Force)[0].clone();
    driver.press("!");
    assert!(title(&driver).contains(" · pull-off"), "{}", title(&driver));
    driver.press(";");
    let text = driver.text();
    assert!(text.contains("after pull-off · "), "{text}");
    assert!(!title(&driver).contains("pull-off"), "{text}");
}

#[test]
fn a_key_goes_to_the_pull_off_of_the_loading() {
    let twice = "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]";
    // The pull-off is that of the last unloading, as everywhere, though an earlier one pulls with a
    // larger force.
    let again = "[ToForce(2.0e-5), ToSeparation, ToTouch, ToSeparation]";
    let [twice, again] = [twice, again].map(|loading| rough().set("loading", loading).unwrap());
    let scenes = [rough(), smooth(), twice, again];
    for (document, size) in scenes
        .into_iter()
        .flat_map(|one| [(one.clone(), (120, 40)), (one, (80, 24))])
    {
        let mut driver = Driver::start(document);
        driver.resize(size);
        driver.press("d Right Esc !");
        let expected = -driver.outcome().figures.pull_off_force.unwrap();
        let point = driver.point();
        assert!(
            expected < 0.0 && (point.force / expected - 1.0).abs() < 1e-9,
            "{point:?}, {expected} N"
        );
        assert!(driver.app.edit.path.is_none() && !driver.app.play.playing);
    }
}

#[test]
fn an_edit_keeps_the_place_of_the_animation() {
    let mut driver = pressed("");
    let before = driver.app.play;
    driver.select("roughness.hurst");
    driver.press("l");
    assert_eq!(driver.app.play, before);
    // Unless the stage is gone.
    driver.set("loading", "[ToForce(2.0e-5)]");
    assert_eq!((driver.app.play.stage, driver.app.play.playing), (0, false));
    assert!(is_up_to_date(&driver.app));
}

#[test]
fn the_animation_is_as_far_however_often_it_is_drawn() {
    let three = "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5)]";
    // Without adhesion there are no large jumps, at which the animation rests.
    for (document, is_even) in [(without_adhesion(), true), (rough(), false)] {
        assert_as_far(&document.set("loading", three).unwrap(), is_even);
    }
}

#[track_caller]
fn assert_as_far(document: &Document, is_even: bool) {
    let place = |steps: u32, seconds: f64| {
        let mut driver = Driver::start(document.clone());
        (0..steps).for_each(|_| drop(driver.elapse(seconds / f64::from(steps))));
        let player = driver.app.play;
        (player, player.share(driver.app.stages()), driver.point())
    };
    for seconds in [1.0, 5.9, 6.3, 11.0, 13.0, 17.9, 18.1, 100.0] {
        let (player, share, point) = place(1, seconds);
        if seconds > 18.0 {
            // There is no pull-off after the last of the three stages, which presses.
            assert_eq!(player.at, At::End);
        }
        let expected = (seconds / 6.0).min(3.0);
        let reached = player.stage as f64 + share;
        // With rests, each stage takes the same time.
        assert!(
            (reached - expected).abs() < if is_even { 1e-9 } else { 0.26 },
            "{seconds}: {player:?}"
        );
        assert_eq!(reached.floor(), expected.floor(), "{seconds}: {player:?}");
        for steps in [3, 70, 211] {
            let (other, _, there) = place(steps, seconds);
            assert_eq!(
                (other.stage, other.playing),
                (player.stage, player.playing),
                "{seconds}, {steps}"
            );
            assert!(
                (there.indentation - point.indentation).abs() < 5e-14,
                "{seconds}, {steps}"
            );
        }
    }
}

#[test]
fn the_configuration_sets_speed_and_end() {
    let config = |text: &str| Config::parse(text, Path::new("config.ron"), bindings()).unwrap();
    let place = |config: Config, seconds: u32| {
        // Without adhesion the animation moves evenly.
        let mut driver = Driver::start(without_adhesion());
        driver.app.config = config;
        driver.app.play = Player::START;
        (0..10 * seconds).for_each(|_| drop(driver.elapse(0.1)));
        let player = driver.app.play;
        (
            player.stage,
            (10.0 * player.share(driver.app.stages())).round(),
            player.playing,
        )
    };
    assert_eq!(place(Config::new(bindings()), 3), (0, 5.0, true));
    assert_eq!(
        place(config("(version: 1, speed: 2.0)"), 3),
        (0, 10.0, true)
    );
    // It ends at the pull-off, and the next play begins anew.
    let mut driver = Driver::start(rough());
    (0..200).for_each(|_| drop(driver.elapse(0.1)));
    let expected = -driver.outcome().figures.pull_off_force.unwrap();
    assert!((driver.point().force / expected - 1.0).abs() < 1e-9 && !driver.app.play.playing);
    driver.shows("· pull-off");
    driver.shows("■ 1× · end, at the pull-off");
    // An edit shows its own pull-off.
    driver.select("roughness.hurst");
    driver.press("l");
    let expected = -driver.outcome().figures.pull_off_force.unwrap();
    assert!(
        (driver.point().force / expected - 1.0).abs() < 1e-9,
        "{:?}",
        driver.point()
    );
    driver.press("Space");
    assert_eq!(driver.app.play, Player::START);
    driver.shows("▶ 1×");
    let (stage, _, playing) = place(config("(version: 1, repeat: true)"), 14);
    assert!(stage == 0 && playing, "it begins again");
}

#[test]
fn the_animation_rests_at_large_jumps() {
    let mut driver = Driver::start(open("pressure-sensitive").unwrap());
    let events = match driver.app.listed_events() {
        Some(Ok(listed)) => listed.list.clone(),
        other => panic!("{other:?}"),
    };
    let energy = |event: &Event| event.jump.map_or(0.0, |jump| jump.energy.abs());
    let largest = events.iter().map(energy).fold(0.0, f64::max);
    let mut large: Vec<f64> = Vec::new();
    for event in events.iter().filter(|event| energy(event) >= 0.1 * largest) {
        large.push(event.indentation);
    }
    // States in which the animation is at two frames of 50 in a second.
    let mut rested: Vec<f64> = Vec::new();
    let mut before = f64::NAN;
    while driver.app.play.playing {
        driver.elapse(0.02);
        let indentation = driver.app.indentation();
        let is_new = rested.last() != Some(&indentation);
        if indentation == before && is_new && driver.app.play.playing {
            rested.push(indentation);
        }
        before = indentation;
    }
    assert_eq!(rested.len(), large.len());
    for (rested, large) in rested.iter().zip(&large) {
        assert!(
            (rested - large).abs() <= 1e-9 * large.abs(),
            "{rested} {large}"
        );
    }
}
