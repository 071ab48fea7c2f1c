//! Manual loading: begun at the present indentation, pressed and pulled by keys, kept under edits,
//! undone, dropped, played.

use super::*;
use asperity::contact::{CurvePoint, Move};
use asperity::explorer::manual_path::ManualPath;
use asperity::explorer::player::At;
use asperity::explorer::request::Drive;
use asperity::explorer::snapshot::FollowedPath;

fn path(driver: &Driver) -> &ManualPath {
    driver.app.edit.path.as_deref().expect("manual loading")
}

fn followed(driver: &Driver) -> &FollowedPath {
    driver.app.followed().expect("a followed path")
}

/// Types a target.
fn go(driver: &mut Driver, target: &str) {
    // A refused target stays in the prompt.
    if driver.app.prompt.is_some() {
        driver.press("Esc");
    }
    driver.press(&format!("Enter `{target}` Enter"));
}

/// Edits a parameter, and selects the force curve again.
fn edit(driver: &mut Driver, path: &str, value: &str) {
    driver.app.view.pane = Pane::Parameters;
    driver.set(path, value);
    driver.app.view.pane = Pane::Force;
}

/// True if two points are the same except for the rounding of their sums.
fn near(one: &CurvePoint, other: &CurvePoint) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs()).max(1e-12);
    one.indentation == other.indentation
        && (one.springs, one.patches) == (other.springs, other.patches)
        && same(one.force, other.force)
}

#[test]
fn the_body_is_taken_at_its_place() {
    for document in [rough(), smooth(), without_adhesion()] {
        let mut driver = mid_retraction(document);
        for keys in ["", ". . . .", "<"] {
            driver.press(keys);
            let at_first = driver.point();
            driver.press("d");
            assert_eq!(driver.snapshot().drive, Drive::Manual);
            assert!(near(&driver.point(), &at_first), "{:?}", driver.point());
            assert!(followed(&driver).moves().is_empty());
            driver.press("d");
            assert!(driver.app.edit.path.is_none());
            assert_eq!(driver.point(), at_first, "and given back there");
        }
        // Above first touch the body begins at first touch.
        driver.press("< d");
        assert_eq!(
            (driver.point().indentation, driver.point().springs),
            (0.0, 0)
        );
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
        ("Right", 1.0 / 400.0),
        ("Left", -1.0 / 400.0),
        ("Shift+Right", 1.0 / 40.0),
        ("Shift+Left", -1.0 / 40.0),
        ("l", 1.0 / 400.0),
        ("h", -1.0 / 400.0),
        ("L", 1.0 / 40.0),
        ("H", -1.0 / 40.0),
    ] {
        let before = driver.point().indentation;
        driver.press(keys);
        let way = (driver.point().indentation - before) / (high - low);
        assert!((way - share).abs() < 1e-9, "{keys}: {way}");
        assert_eq!(
            followed(&driver).stages.last().map(|stage| stage.end()),
            Some(driver.point().indentation),
            "{keys}: the way ends there"
        );
    }
    // With another pane selected, the arrows change the value as before.
    let before = path(&driver).clone();
    driver.app.view.pane = Pane::Parameters;
    driver.select("roughness.hurst");
    driver.press("Right");
    assert!(driver.app.edit.is_unsaved());
    assert_eq!(*path(&driver), before);
    // Separation begins manual loading, too.
    let mut driver = pressed("S");
    assert_eq!(path(&driver).moves, [Move::ToSeparation]);
    driver.press("u");
    assert!(driver.app.edit.path.is_none());
}

#[test]
fn every_key_of_manual_loading_is_on_every_keyboard() {
    let bindings = bindings();
    let rows = bindings.valid_in(Context::Manual);
    let by_hand = rows.filter(|binding| binding.row.section.starts_with("Manual"));
    for key in by_hand.flat_map(|binding| &binding.keys) {
        // These characters need AltGr on a German or a French keyboard.
        let is_hard = key
            .name
            .chars()
            .any(|character| r"[]{}\|~@#€`^".contains(character));
        assert!(!is_hard, "{}", key.name);
    }
}

#[test]
fn pulled_off_by_hand_it_loses_what_the_stage_loses() {
    let mut driver = mid_retraction(rough());
    driver.press("< d S");
    let stage = &driver.app.stages()[1];
    assert_eq!(followed(&driver).moves(), std::slice::from_ref(stage));
    assert_eq!((driver.point().springs, driver.point().force), (0, 0.0));
    // From there the body does not touch before the foundation is reached again.
    while driver.point().springs == 0 {
        assert!(driver.point().indentation < 0.0);
        driver.press("L");
    }
    assert!(driver.point().indentation >= 0.0);
}

#[test]
fn a_force_out_of_reach_is_stated_and_nothing_is_lost() {
    let mut driver = pressed("d l u");
    let (before, moves) = (driver.point(), path(&driver).clone());
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
        assert_eq!(*path(&driver), moves);
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
    // What was undone before can still be redone.
    driver.press("Esc U");
    assert_eq!(path(&driver).moves.len(), 1);
    driver.press("u");
    go(&mut driver, &format!("{least} {unit}"));
    assert!(driver.app.prompt.is_none(), "{:?}", driver.refusal());
    let after = driver.point();
    assert!(after.springs > 0, "{after:?}");
    let newtons = asperity::data::parse_quantity(&format!("{least} {unit}"), "N").unwrap();
    assert!(
        after.force <= newtons * (1.0 - 1e-9),
        "{} {newtons}",
        after.force
    );
    // The body can be moved as before.
    driver.press("Right");
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
fn a_target_is_a_force_an_indentation_or_a_share() {
    let mut driver = pressed("d");
    for (typed, expected) in [
        ("12 µN", Move::ToForce(1.2e-5)),
        ("8", Move::ToForce(8e-6)),
        ("-20 nN", Move::ToForce(-2e-8)),
        ("150 nm", Move::ToIndentation(1.5e-7)),
        ("touch", Move::ToTouch),
        ("zero force", Move::ToZeroForce),
        ("separation", Move::ToSeparation),
    ] {
        go(&mut driver, typed);
        assert!(driver.app.prompt.is_none(), "{typed}: {}", driver.status());
        let Some(&found) = path(&driver).moves.last() else {
            panic!("no move")
        };
        match (found, expected) {
            (Move::ToForce(found), Move::ToForce(expected)) => {
                assert!((found / expected - 1.0).abs() < 1e-12, "{typed}: {found}")
            }
            (found, expected) => assert_eq!(found, expected, "{typed}"),
        }
    }
    let ideal = driver.outcome().ideal_pull_off_force.unwrap();
    driver.press("N 0 . 2");
    driver.states("F_a,max, nm): 0.2");
    driver.press("Enter");
    assert_eq!(
        path(&driver).moves.last(),
        Some(&Move::ToForce(0.2 * ideal))
    );
    // A minus begins a pulling force.
    driver.press("N - 1 Space n N");
    driver.states("): -1 nN");
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
fn an_edit_replays_the_path() {
    let mut driver = pressed("d H H H L h");
    let before = followed(&driver).clone();
    assert_eq!(before.path.moves.len(), 3, "one move for each direction");
    edit(&mut driver, "roughness.hurst", "0.75");
    assert!(is_up_to_date(&driver.app));
    assert_eq!(driver.app.drive(), Drive::Manual);
    let after = followed(&driver);
    assert_eq!(*after.path, *before.path);
    assert_ne!(after.stages, before.stages);
    driver.press("u");
    assert_eq!(*followed(&driver), before);
    driver.states("undo: ");
    // The same steps under the edited scene give the same path.
    driver.press("U");
    let replayed = followed(&driver).clone();
    let moves = replayed.path.moves.clone();
    driver.press("u u u u u");
    assert!(driver.app.edit.path.is_none());
    assert!(moves.len() == 3);
    // Of the views none changes the path.
    let mut driver = pressed("d H");
    let at_first = driver.point();
    driver.press("j n v N a T z Tab +");
    assert_eq!(path(&driver).moves.len(), 1);
    assert_eq!(driver.point(), at_first);
}

#[test]
fn a_move_that_an_edited_scene_cannot_follow_waits_for_the_next_edit() {
    let mut driver = pressed("d");
    for typed in ["10 µN", "-20 nN", "15 µN", "2 µN"] {
        go(&mut driver, typed);
    }
    let before = followed(&driver).clone();
    assert_eq!(before.stopped, None);
    // Without adhesion there is no tensile force.
    driver.app.view.pane = Pane::Parameters;
    driver.select("adhesion");
    driver.press("t");
    driver.states("! move 2 of 4: the contact detaches before -20 nN");
    driver.states("; the moves stay");
    driver.shows("manual loading, 1 of 4 moves");
    assert_eq!(followed(&driver).count(), 1);
    assert_eq!(path(&driver).moves, before.path.moves);
    driver.press("u");
    assert_eq!(*followed(&driver), before);
    // A further move takes the place of the moves that cannot be followed.
    driver.press("U");
    driver.app.view.pane = Pane::Force;
    driver.press("L");
    driver.states("the path goes on from here, without 3 moves; u brings back");
    assert_eq!(path(&driver).moves.len(), 2);
    driver.press("u");
    assert_eq!(path(&driver).moves, before.path.moves);
    // As the loading of the scene, the path has the moves that can be followed.
    driver.press("d");
    driver.states("without 3 moves; u undoes");
    assert!(is_up_to_date(&driver.app));
    driver.press("u u");
    assert_eq!(*followed(&driver), before);
}

#[test]
fn moves_and_edits_are_undone_in_their_order() {
    let mut driver = pressed("");
    let text = driver.document().text().to_owned();
    driver.press("d L L H H H");
    edit(&mut driver, "roughness.hurst", "0.75");
    driver.press("h h");
    go(&mut driver, "12 µN");
    let all = path(&driver).moves.clone();
    assert_eq!(all.len(), 4, "{all:?}");
    for (said, count) in [
        ("undo: by hand to ", 3),
        ("undo: by hand to ", 2),
        ("undo: H 0.75 → 0.7", 2),
        ("undo: by hand to ", 1),
        ("undo: by hand, no move yet", 0),
    ] {
        driver.answers("u", said);
        assert_eq!(path(&driver).moves.len(), count, "{said}");
    }
    assert_eq!(driver.document().text(), text);
    driver.answers("u", "undo: without the path by hand");
    driver.answers("u", "nothing to undo");
    driver.press("U U U U U U");
    assert_eq!(path(&driver).moves, all);
    assert!(driver.app.followed().is_some());
    // Undoing a move computes no scene.
    let generation = driver.app.edit.generation;
    driver.press("u u");
    assert_eq!(driver.app.edit.generation, generation);
}

#[test]
fn a_dropped_path_comes_back() {
    let mut driver = pressed("");
    let place = driver.point();
    driver.press("d L H H");
    let before = followed(&driver).clone();
    driver.press("Esc");
    driver.states("the path by hand is dropped; u brings it back");
    assert!(driver.app.edit.path.is_none());
    assert_eq!(driver.point(), place);
    driver.press("u");
    assert_eq!(*followed(&driver), before);
    // Another scene has no path, and the path returns with its own scene.
    driver.act(Action::Opened(
        "smooth".to_owned(),
        Ok(asperity::explorer::opening::Opened::Scene(Box::new(
            Opening::from(smooth()),
        ))),
    ));
    assert!(driver.app.edit.path.is_none());
    driver.press("u");
    assert_eq!(*followed(&driver), before);
}

#[test]
fn the_animation_plays_the_path() {
    let mut driver = pressed("d H H H L L");
    let end = driver.point();
    driver.press("Space");
    assert!(driver.app.is_playing());
    let mut shown = Vec::new();
    for _ in 0..60 {
        driver.elapse(0.25);
        shown.push(driver.point().indentation);
    }
    assert!(!driver.app.is_playing(), "{:?}", driver.app.playhead());
    assert_eq!(driver.point(), end);
    let lowest = shown.iter().copied().fold(f64::INFINITY, f64::min);
    let turn = followed(&driver).stages[followed(&driver).before].end();
    assert!(
        lowest >= turn && lowest < end.indentation,
        "{lowest} {turn}"
    );
    // An edit keeps the place of the animation in the path.
    driver.press("<");
    assert!(matches!(driver.app.drive(), Drive::Path(_)));
    let place = driver.app.playhead();
    assert_eq!(place.at, At::Start);
    edit(&mut driver, "roughness.hurst", "0.75");
    assert_eq!(driver.app.playhead(), place);
    assert!(is_up_to_date(&driver.app) && driver.app.present().is_some());
    // A move goes on from the end of the path.
    driver.press("l");
    assert_eq!(driver.app.drive(), Drive::Manual);
    for keys in ["< . .", ">", "!", "r"] {
        driver.press(keys);
        assert!(driver.app.edit.path.is_some(), "{keys}");
        assert!(driver.app.present().is_some(), "{keys}");
    }
}

#[test]
fn without_a_computed_scene_there_is_no_path() {
    let beyond = rough()
        .set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]")
        .unwrap();
    let mut driver = Driver::start(beyond);
    let why = driver.status();
    assert!(why.contains("detaches"), "{why}");
    for keys in ["d", "S"] {
        driver.press(keys);
        assert_eq!(
            (driver.app.edit.path.is_none(), driver.status()),
            (true, why.clone())
        );
    }
    let mut driver = Driver::open(rough());
    driver.answers("d", "the scene is still being computed");
    assert!(driver.app.edit.path.is_none());
}

#[test]
fn a_path_has_a_largest_number_of_moves() {
    let few = [
        ("roughness.modes", "(2, 16)"),
        ("numerics.points", "64"),
        ("numerics.samples", "16"),
    ];
    let mut driver = mid_retraction(changed(&rough(), &few));
    driver.press("d");
    let path = ManualPath {
        moves: [Move::ToForce(1e-6), Move::ToForce(2e-6)].repeat(500),
        ..path(&driver).clone()
    };
    driver.app.edit.adopt_path(Some(path));
    driver.press("Tab Tab Tab Tab Tab");
    assert_eq!(followed(&driver).count(), 1000);
    driver.answers("h", "the path has 1000 moves, the most");
    go(&mut driver, "3 µN");
    driver.states("the path has 1000 moves, the most");
    assert_eq!(followed(&driver).count(), 1000);
}

/// From an earlier point of the path, the body goes on from what is shown; the rest comes back by
/// undo.
#[test]
fn a_move_continues_from_the_shown_point_of_the_path() {
    let mut driver = Driver::start(rough());
    driver.press("! d");
    go(&mut driver, "12 µN");
    go(&mut driver, "1 µN");
    let whole = path(&driver).clone();
    // Back into the first move, between its ends.
    driver.press(", < <");
    driver.press("Tab Shift+Right Shift+Right Shift+Right Shift+Right");
    driver.app.view.pane = Pane::Force;
    let shown = driver.point();
    driver.press("Right");
    let moves = &path(&driver).moves;
    assert_eq!(moves.len(), 2, "{moves:?}");
    assert_eq!(moves[0], Move::ToIndentation(shown.indentation));
    assert!(driver.point().indentation > shown.indentation);
    driver.states("the path goes on from here, without 1 move; u brings back");
    driver.press("u");
    assert_eq!(path(&driver), &whole);
    // Before the first move, the path starts at what is shown.
    driver.press("Tab Home Shift+Right Shift+Right Shift+Right Shift+Right");
    driver.app.view.pane = Pane::Force;
    let shown = driver.point();
    go(&mut driver, "8 µN");
    assert_eq!(path(&driver).moves, [Move::ToForce(8e-6)]);
    let way = &followed(&driver).stages[followed(&driver).before - 1];
    assert_eq!(way.end(), shown.indentation.max(0.0));
    // A whole stage is kept as it is.
    go(&mut driver, "2 µN");
    driver.press("<");
    go(&mut driver, "3 µN");
    assert_eq!(
        path(&driver).moves,
        [Move::ToForce(8e-6), Move::ToForce(3e-6)]
    );
}

/// The pane of the results names their loading, and the marks of the force are those of the whole
/// path.
#[test]
fn beside_a_path_the_results_are_said_to_be_those_of_the_scene() {
    let mut driver = Driver::start(rough());
    driver.resize((120, 36));
    assert!(!driver.text().contains("Result of the scene's loop"));
    driver.press("! d");
    go(&mut driver, "1 µN");
    assert!(driver.text().contains("Result of the scene's loop"));
    // The path begins at the pull-off, and its last move only presses: the jump-in and the pull-off
    // lie before this move.
    assert!(driver.text().contains("jump-in"), "{}", driver.text());
}

#[test]
fn an_empty_target_is_asked_for() {
    let mut driver = Driver::start(rough());
    driver.press("d Enter Enter");
    driver.states("type a target, for example 10 µN");
}

/// Motions by hand have no speed, so a body that relaxes follows none: each key is answered, and a
/// path from before stays for the next edit.
#[test]
fn a_body_that_relaxes_is_not_moved_by_hand() {
    let mut driver = Driver::start(relaxing());
    driver.press("Space");
    driver.press("d");
    driver.states("a body that relaxes is not moved by hand");
    assert!(driver.app.edit.path.is_none());
    let mut driver = Driver::start(smooth());
    driver.press("Space d Left Left Left");
    let path = driver.app.edit.path.clone();
    let followed = driver.app.followed().unwrap().moves().to_vec();
    driver.app.view.pane = Pane::Parameters;
    driver.set("loading_speed", "1.0e-6");
    driver.set(
        "material",
        "(modulus: 2.0e6, relaxation: (share: 0.4, time: 1.0))",
    );
    driver.states("a body that relaxes is not moved by hand");
    assert!(!driver.app.is_computing());
    assert_eq!(driver.app.edit.path, path);
    driver.press("u");
    assert_eq!(driver.app.followed().unwrap().moves(), followed);
}
