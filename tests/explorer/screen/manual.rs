//! Manual loading: begun at the present indentation, pressed and pulled by keys, ended.

use super::*;
use asperity::explorer::request::Drive;
use asperity::explorer::snapshot::ManualState;

fn manual(driver: &Driver) -> &ManualState {
    driver.app.manual.as_ref().expect("manual loading")
}

/// Types a target force.
fn go(driver: &mut Driver, force: &str) {
    // A refused force stays in the prompt.
    driver.press(&format!("Esc F `{force}` Enter"));
}

#[test]
fn the_body_is_taken_at_its_place() {
    for document in [rough(), smooth(), without_adhesion()] {
        let mut driver = mid_retraction(document);
        for keys in ["", ". . . .", "<", "<"] {
            driver.press(keys);
            let at_first = driver.point();
            driver.press("d");
            assert_eq!(driver.snapshot().drive, Drive::Manual);
            assert_eq!(driver.point(), at_first, "{}", driver.document().name());
            assert_eq!(manual(&driver).path, [at_first]);
            driver.press("d");
            assert!(driver.app.manual.is_none());
            assert_eq!(driver.point(), at_first, "and given back there");
        }
    }
}

#[test]
fn a_body_of_the_stepwise_solver_is_moved_by_the_exact_one() {
    let stepwise = |step: &str| {
        changed(
            &rough(),
            &[("numerics.edges", "Grid"), ("numerics.solver", step)],
        )
    };
    let mut ends = Vec::new();
    for document in [stepwise("Exact"), stepwise("Stepwise(step: 1.0e-9)")] {
        let mut driver = mid_retraction(document);
        driver.press("d S");
        let apart = driver.point();
        assert_eq!((apart.springs, apart.force), (0, 0.0));
        go(&mut driver, "1 µN");
        assert!((driver.point().force - 1e-6).abs() < 1e-15);
        ends.push((apart.indentation, driver.point()));
    }
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn small_and_large_steps_press_and_pull() {
    let mut driver = pressed("d");
    let (low, high) = driver.app.indentations().unwrap();
    for (keys, share) in [
        ("]", 1.0 / 400.0),
        ("[", -1.0 / 400.0),
        ("}", 1.0 / 40.0),
        ("{", -1.0 / 40.0),
    ] {
        let before = driver.point().indentation;
        driver.press(keys);
        let way = (driver.point().indentation - before) / (high - low);
        assert!((way - share).abs() < 1e-9, "{keys}: {way}");
        assert_eq!(
            manual(&driver).path.last(),
            Some(&driver.point()),
            "{keys}: the way ends there"
        );
    }
    // These keys begin manual loading.
    for keys in ["]", "[", "}", "{", "S"] {
        let mut driver = pressed(keys);
        assert!(driver.app.manual.is_some(), "{keys}");
        driver.press("d");
        assert!(driver.app.manual.is_none(), "{keys}");
    }
}

#[test]
fn pulled_off_by_hand_it_loses_what_the_leg_loses() {
    let mut driver = mid_retraction(rough());
    driver.press("< d S");
    let leg = &driver.app.legs()[1];
    let (lost, expected) = (manual(&driver).released_energy, leg.released_energy);
    assert!(
        expected > 0.0 && (lost / expected - 1.0).abs() < 1e-9,
        "{lost}, not {expected}"
    );
    assert_eq!((driver.point().springs, driver.point().force), (0, 0.0));
    let smallest = leg.smallest.force;
    let path = &manual(&driver).path;
    assert!(path.len() > 20, "the way down is seen");
    let pulled = path
        .iter()
        .map(|point| point.force)
        .fold(f64::INFINITY, f64::min);
    assert!(
        pulled >= smallest && pulled < 0.5 * smallest,
        "{pulled} {smallest}"
    );
    // From there the body does not touch before the foundation is reached again.
    while driver.point().springs == 0 {
        assert!(driver.point().indentation < 0.0);
        driver.press("}");
    }
    assert!(driver.point().indentation >= 0.0);
}

#[test]
fn a_force_out_of_reach_is_stated_and_nothing_is_lost() {
    let mut driver = pressed("d");
    let before = driver.point();
    for (typed, force) in [("-1 N", "-1 N"), ("-1e6 µN", "-1 N"), ("-3 mN", "-3 mN")] {
        go(&mut driver, typed);
        let expected =
            format!("the contact detaches before {force}; smallest force within reach: -");
        assert!(
            driver.refusal().is_some_and(|why| why.contains(&expected)),
            "{typed}: {}",
            driver.status()
        );
        assert_eq!(driver.point(), before, "a refused force moves nothing");
    }
    // The named force can be reached, and one smaller in its last digit cannot.
    let refusal = driver.refusal().unwrap().to_owned();
    let (least, unit) = refusal
        .rsplit("reach: ")
        .next()
        .unwrap()
        .split_once(' ')
        .unwrap();
    let (least, digits): (f64, usize) = (
        least.parse().unwrap(),
        least.split('.').nth(1).map_or(0, str::len),
    );
    let beyond = least - 10.0_f64.powi(-(digits as i32)) * 2.0;
    go(&mut driver, &format!("{beyond:.digits$} {unit}"));
    driver.states("the contact detaches before");
    go(&mut driver, &format!("{least} {unit}"));
    assert!(driver.app.prompt.is_none(), "{:?}", driver.refusal());
    let after = driver.point();
    assert!(
        driver.app.manual.is_some() && after.springs > 0,
        "{after:?}"
    );
    let newtons = asperity::data::parse_quantity(&format!("{least} {unit}"), "N").unwrap();
    assert!(
        after.force <= newtons * (1.0 - 1e-9),
        "{} {newtons}",
        after.force
    );
    driver.press("d d");
    // The body can be moved as before.
    let after = driver.point();
    driver.press("]");
    assert!(driver.app.message.is_none());
    assert!(driver.point().indentation > after.indentation);
    driver.press("S");
    go(&mut driver, "-1 µN");
    driver.states("needs a contact");
    driver.press("Esc");
    for nonsense in ["", "strong", "1 kg", "NaN"] {
        let at_first = driver.point();
        go(&mut driver, nonsense);
        assert!(
            driver
                .refusal()
                .is_some_and(|why| why.contains("for example 10 µN")),
            "{nonsense}"
        );
        assert_eq!(driver.point(), at_first);
        driver.press("Esc");
    }
}

#[test]
fn a_force_far_beyond_full_contact_is_refused() {
    for document in [rough(), smooth(), without_adhesion()] {
        let mut driver = mid_retraction(document);
        driver.press("d");
        let before = driver.point();
        go(&mut driver, "1e30 N");
        let refusal = driver.refusal().unwrap_or_default().to_owned();
        assert!(
            refusal.contains("N is far beyond full contact at "),
            "{refusal}"
        );
        assert_eq!(driver.point(), before);
        // The bound itself is allowed, and there all springs are in contact.
        let largest = refusal.rsplit("at most ").next().unwrap();
        go(&mut driver, largest);
        assert!(
            driver.app.prompt.is_none(),
            "{largest}: {:?}",
            driver.refusal()
        );
        let springs = driver.outcome().line.points as u64;
        assert_eq!(driver.point().springs, springs);
    }
}

#[test]
fn an_edit_puts_the_body_back_and_says_so() {
    for keys in ["l", "u", "R"] {
        let mut driver = pressed("l d { [");
        driver.press(keys);
        assert!(driver.app.manual.is_none(), "{keys}");
        assert!(is_up_to_date(&driver.app));
        assert_eq!(driver.app.drive(), Drive::Leg(1), "{keys}");
        assert!(
            driver.status().contains("the body is back"),
            "{keys}: {}",
            driver.status()
        );
    }
    // A change of the view alone does not.
    let mut driver = pressed("d {");
    let at_first = driver.point();
    driver.press("j n v N a T z Tab +");
    assert!(driver.app.manual.is_some());
    assert_eq!(driver.point(), at_first);
}

#[test]
fn playing_gives_it_back() {
    for keys in ["Space", ".", ",", "r", ">", "<"] {
        let mut driver = pressed("d { [");
        assert_eq!(driver.press(keys), [Task::Ask], "{keys}");
        assert!(driver.app.manual.is_none(), "{keys}");
        assert!(matches!(driver.snapshot().drive, Drive::Leg(_)), "{keys}");
    }
}
