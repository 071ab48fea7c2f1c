//! The timeline, the list of events, and the results beside them.

use super::*;
use asperity::explorer::events::MOST_LISTED;
use asperity::explorer::player::{At, Player};
use asperity::explorer::theme::Marker;
use asperity_contact::{Direction, Event, Mark, StageRecord};

fn listed(driver: &Driver) -> Vec<Event> {
    match driver.app.listed_events() {
        Some(Ok(listed)) => listed.list.clone(),
        other => panic!("{other:?}"),
    }
}

/// A driver whose playhead is at the beginning of the loading.
fn at_beginning(document: Document) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space");
    steps(&mut driver, "Home");
    driver
}

#[test]
fn keys_visit_all_events_in_the_order_of_the_motion() {
    for document in [rough(), smooth(), open("pressure-sensitive").unwrap()] {
        let mut driver = at_beginning(document);
        let events = listed(&driver);
        assert!(events.len() > 2);
        for event in &events {
            driver.press(";");
            let point = driver.point();
            let distance = (point.indentation - event.indentation).abs();
            assert!(
                distance <= 1e-9 * event.indentation.abs() + f64::MIN_POSITIVE
                    || point.springs == 0,
                "{event:?}: {point:?}"
            );
            assert_eq!(driver.app.play.stage, event.stage);
            if let Some(jump) = event.jump {
                let [before, after] = event.forces;
                let scale = before.abs().max(after.abs()).max(1e-12);
                assert!(
                    (point.force - after).abs() <= 1e-6 * scale,
                    "{event:?}: {point:?}"
                );
                assert_eq!(point.patches, jump.patches[1], "{event:?}");
            }
        }
        driver.press(";");
        driver.states("this was the last event");
        for event in events.iter().rev().skip(1) {
            driver.press(",");
            let indentation = driver.point().indentation;
            assert!((indentation - event.indentation).abs() <= 1e-9 * event.indentation.abs());
        }
        driver.press(",");
        driver.states("this was the first event");
    }
}

#[test]
fn loadings_without_events_say_so() {
    let still = rough().set("loading", "[ToIndentation(-1e-9)]").unwrap();
    let stepwise = rough()
        .set("numerics.solver", "Stepwise(step: 1e-8)")
        .unwrap();
    for (document, words) in [
        (still, "there is no jump and no mark on this loading"),
        (stepwise, "stepwise"),
    ] {
        let mut driver = Driver::start(document);
        driver.press("Space ;");
        assert!(driver.text().contains(words), "{}", driver.text());
        driver.press("e");
        driver.press("Down Up Home End PageDown");
    }
}

#[test]
fn windows_show_the_timeline_if_they_have_room() {
    for (size, rows) in [
        ((160, 45), 4),
        ((120, 36), 4),
        ((100, 30), 3),
        ((80, 24), 2),
        ((40, 12), 0),
    ] {
        let mut driver = at_beginning(open("pressure-sensitive").unwrap());
        driver.resize(size);
        driver.press("; ;");
        let text = driver.text();
        let shown = if rows == 0 {
            0
        } else {
            usize::from(driver.area(Pane::Timeline).height)
        };
        assert_eq!(shown, rows, "{text}");
        assert_eq!(text.contains("Timeline"), rows >= 3, "{text}");
        assert_eq!(text.contains("├"), rows > 0, "{text}");
        if size.0 >= 120 {
            driver.shows_all(["1 press to 10 µN", "2 pull to separation", " of "]);
        }
    }
}

#[test]
fn a_click_on_a_tick_goes_to_its_jump() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.resize((120, 36));
    let events = listed(&driver);
    let largest = |direction: Direction, stages: &[StageRecord]| {
        let mut jumps: Vec<&Event> = events.iter().filter(|event| event.jump.is_some()).collect();
        jumps.retain(|event| stages[event.stage].direction == direction);
        let energy = |event: &&Event| event.jump.map_or(0.0, |jump| jump.energy.abs());
        **jumps
            .iter()
            .max_by(|event, other| energy(event).total_cmp(&energy(other)))
            .unwrap()
    };
    let stages = driver.outcome().history.stages.clone();
    let area = driver.area(Pane::Timeline);
    for direction in [Direction::Loading, Direction::Unloading] {
        let wanted = largest(direction, &stages);
        let mut reached = false;
        for column in area.left()..area.right() {
            driver.mouse(column, area.bottom() - 2, Gesture::Press);
            let indentation = driver.point().indentation;
            reached |= (indentation - wanted.indentation).abs() <= 1e-9 * wanted.indentation.abs();
        }
        assert!(reached, "{wanted:?}");
    }
    driver.mouse(area.right() - 1, area.bottom() - 1, Gesture::Press);
    assert_eq!(driver.app.play.stage, 1);
}

#[test]
fn the_list_follows_the_playhead_and_moves_it() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.resize((160, 45));
    driver.press("e");
    assert_eq!(driver.app.view.pane, Pane::Events);
    let events = listed(&driver);
    driver.press("Down Down");
    let third = driver.point().indentation;
    assert!((third - events[1].indentation).abs() <= 1e-9 * third.abs());
    driver.press("End");
    assert!(driver.app.play.stage == 1);
    driver.press("Home");
    let area = driver.area(Pane::Events);
    driver.mouse(area.x + 3, area.y + 2, Gesture::Press);
    let indentation = driver.point().indentation;
    assert!(
        (indentation - events[2].indentation).abs() < 1e-15,
        "{indentation}: {}",
        driver.text()
    );
    driver.press("e");
    assert!(!driver.app.view.lists_events);
}

#[test]
fn keys_list_more_or_fewer_jumps() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.resize((160, 45));
    let close_up = driver.app.view.close_up;
    let jumps = |driver: &Driver| listed(driver).iter().filter_map(|event| event.jump).count();
    let usual = jumps(&driver);
    driver.press("e");
    driver.shows_all(["Events · from 1 %", "more/fewer"]);
    let mut counts = vec![usual];
    for title in ["from 0.1 %", "all jumps"] {
        driver.press("+");
        driver.shows_all([&*format!("Events · {title}")]);
        counts.push(jumps(&driver));
    }
    assert!(counts.is_sorted() && counts[0] < counts[2], "{counts:?}");
    let Some(Ok(events)) = driver.app.listed_events() else {
        panic!("no events");
    };
    assert_eq!(counts[2], events.jumps.min(MOST_LISTED));
    driver.press("=");
    driver.states("all jumps are listed already");
    driver.press("E Ctrl+u `events.csv` Enter");
    let text = driver.file("events.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#')).count();
    assert_eq!(rows, 1 + listed(&driver).len());
    driver.press("- -");
    assert_eq!(jumps(&driver), usual);
    driver.press("-");
    driver.shows_all(["Events · from 10 %"]);
    let fewest = jumps(&driver);
    assert!(0 < fewest && fewest < usual, "{fewest} of {usual}");
    driver.press("-");
    driver.states("the fewest");
    // The list of a path by hand has the same share, and other panes still zoom.
    driver.press("d L H");
    driver.shows_all(["Events · from 10 %"]);
    assert_eq!(driver.app.view.close_up, close_up);
    driver.app.view.pane = Pane::CloseUp;
    driver.press("+");
    driver.shows_all(["Events · from 10 %"]);
    assert_ne!(driver.app.view.close_up, close_up);
}

#[test]
fn a_path_by_hand_has_its_own_stages_and_events() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.resize((120, 36));
    steps(&mut driver, "End");
    driver.press("< d L L L L H H H H H H");
    let followed = driver.app.followed().expect("a path").clone();
    assert!(followed.moves().len() >= 2);
    let events = listed(&driver);
    assert!(
        events
            .iter()
            .all(|event| event.stage < followed.stages.len())
    );
    assert!(driver.text().contains("press to"), "{}", driver.text());
    driver.press("d");
    assert!(driver.app.edit.path.is_none());
    assert_eq!(driver.app.events.as_ref().unwrap().path, None);
    // The events are those of the scene with this loading: no jump of a move that was replaced is
    // left.
    assert_eq!(listed(&driver), events);
    driver.press("u Esc");
    assert!(driver.app.edit.path.is_none());
}

#[test]
fn keys_change_the_speed_and_repeat() {
    let mut driver = at_beginning(smooth());
    driver.resize((120, 36));
    driver.press("Tab = +");
    assert_eq!(driver.app.config.speed, 4.0);
    driver.states("speed 4×");
    driver.press("- - - - - -");
    assert_eq!(driver.app.config.speed, 0.25);
    driver.press("r");
    driver.states("the animation repeats");
    assert!(driver.text().contains('↻'), "{}", driver.text());
    assert_eq!(driver.app.play.at, At::Start);
}

#[test]
fn the_panes_of_the_loading_are_exported() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.press("e E Ctrl+u `events.csv` Enter");
    let text = driver.file("events.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#')).count();
    assert_eq!(rows, 1 + listed(&driver).len(), "{text}");
    for (pane, name) in [
        (Pane::Timeline, "timeline.csv"),
        (Pane::Timeline, "timeline.svg"),
        (Pane::Events, "events.svg"),
        (Pane::Result, "result.json"),
    ] {
        driver.app.view.pane = pane;
        driver.press(&format!("E Ctrl+u `{name}` Enter"));
        assert!(!driver.file(name).is_empty());
    }
}

#[test]
fn the_timeline_is_legible_in_ascii() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.app.view.appearance.marker = Marker::Ascii;
    driver.resize((120, 36));
    driver.press("; r");
    let area = driver.area(Pane::Timeline);
    for row in &driver.rows()[usize::from(area.y)..usize::from(area.bottom())] {
        let timeline: String = row.chars().take(area.width.into()).collect();
        assert!(timeline.is_ascii() && !timeline.contains('?'), "{timeline}");
    }
}

#[test]
fn the_playhead_hides_no_letter_of_a_stage() {
    let mut driver = at_beginning(open("pressure-sensitive").unwrap());
    driver.resize((120, 36));
    driver.press("Tab");
    // Over all letters of the first name, column by column.
    for _ in 0..48 {
        driver.press("Right");
        let area = driver.area(Pane::Timeline);
        let row = driver.rows()[usize::from(area.bottom()) - 1].replace('◆', " ");
        assert!(row.contains("press to 10 µN"), "{row}");
    }
}

#[test]
fn the_next_pane_is_the_next_on_the_screen() {
    let mut driver = at_beginning(smooth());
    driver.resize((160, 45));
    driver.press("e");
    driver.app.view.pane = Pane::Force;
    let mut before = driver.area(Pane::Force);
    for pane in [
        Pane::Timeline,
        Pane::Profile,
        Pane::CloseUp,
        Pane::Parameters,
        Pane::Events,
    ] {
        driver.press("Tab");
        assert_eq!(driver.app.view.pane, pane);
        let area = driver.area(pane);
        assert!(area.y >= before.bottom() || area.x >= before.right());
        before = area;
    }
    driver.press("Tab");
    assert_eq!(driver.app.view.pane, Pane::Force);
}

/// The stages of a body that relaxes take columns by their times, a rest included. The marks are
/// its events, and the force may be shown over the time.
#[test]
fn a_body_that_relaxes_moves_along_its_time() {
    let mut driver = Driver::start(relaxing());
    driver.resize((120, 36));
    driver.press("Space");
    driver.shows("2 hold 2 s");
    let records = driver.app.stages().to_vec();
    let times: Vec<[f64; 2]> = records
        .iter()
        .map(|record| record.times().unwrap())
        .collect();
    let rows = driver.pane(Pane::Timeline);
    let row = rows.iter().find(|row| row.contains("2 hold 2 s")).unwrap();
    // The rest begins at the preload ▲.
    let column_of = |symbol: char| row.chars().position(|shown| shown == symbol).unwrap() as f64;
    let columns = row.chars().count() as f64;
    let rest = column_of('├') - column_of('▲');
    let expected = columns * (times[1][1] - times[1][0]) / (1.12 * times[2][1]);
    assert!((rest - expected).abs() <= 2.0, "{row}, {times:?}");
    let events = listed(&driver);
    assert!(events.len() >= 2 && events.iter().all(|event| event.jump.is_none()));
    steps(&mut driver, "Home");
    for event in &events {
        driver.press(";");
        let shown = driver.app.snapshot.as_ref().unwrap().seconds.unwrap();
        assert!((shown - event.seconds.unwrap()).abs() <= 1e-9 * times[2][1]);
    }
    // In the middle of the rest.
    let [start, end] = times[1];
    driver.app.set_playhead(Player {
        stage: 1,
        at: At::Seconds(0.5 * (start + end)),
        playing: false,
    });
    driver.press("v");
    driver.shows("t (s)");
    driver.shows("rest");
    let point = driver.point();
    assert!(point.force < records[1].curve[0].force && point.springs > 0);
    // Without relaxation there is no time to show.
    driver.set("material", "(modulus: 2.0e6)");
    driver.hides("t (s)");
    driver.shows("d (");
}

/// While a compliant instrument jumps, its displacement stays, and so does the mark of the present
/// state over the displacement.
#[test]
fn the_mark_stays_at_the_displacement_of_a_jump() {
    let document = changed(&smooth(), &[("loading_stiffness", "10.0")]);
    let mut driver = at_beginning(document);
    driver.resize((120, 36));
    driver.press("v");
    let events = listed(&driver);
    let jump = events
        .iter()
        .filter(|event| event.stage == 1)
        .find_map(|event| event.instrument)
        .unwrap();
    let column_of_mark = |driver: &Driver| {
        let rows = driver.pane(Pane::Force);
        let plot = &rows[1..rows.len() - 2];
        plot.iter()
            .find_map(|row| row.chars().position(|symbol| symbol == '◆'))
    };
    let mut columns = Vec::new();
    for share in [0.02, 0.4, 0.9] {
        driver.app.set_playhead(Player {
            stage: 1,
            at: At::Indentation(jump.from + share * (jump.to - jump.from)),
            playing: false,
        });
        driver.press("Ctrl+l");
        columns.push(column_of_mark(&driver).expect("the mark is shown"));
    }
    let is_near = |column: &usize| column.abs_diff(columns[0]) <= 1;
    assert!(columns.iter().all(is_near), "{columns:?}");
}

#[test]
fn a_narrow_list_of_events_says_what_happens() {
    let mut driver = at_beginning(rough());
    driver.resize((80, 24));
    driver.press("e ; ;");
    let rows = driver.pane(Pane::Events).join("\n");
    assert!(
        rows.contains("spreads") || rows.contains("touches"),
        "{rows}"
    );
}

#[test]
fn at_the_pull_off_the_list_selects_it_and_the_caption_names_the_jump_that_follows() {
    for name in ["pressure-sensitive", "profile-hurst-075"] {
        let mut driver = Driver::start(open(name).unwrap());
        driver.resize((160, 45));
        driver.press("! e");
        let events = listed(&driver);
        let pull_off = events
            .iter()
            .find(|event| event.mark == Some(Mark::PullOff))
            .unwrap();
        driver.shows("end, at the pull-off");
        assert!(pull_off.jump.is_some());
        driver.shows("next: patch");
        let rows = driver.rows();
        let row = rows.iter().find(|row| row.contains("▼ pull-off"));
        assert!(row.is_some_and(|row| row.contains('›')), "{rows:#?}");
        // The next event is this jump, and the one before is that before it.
        let place = events.iter().position(|event| event == pull_off).unwrap();
        driver.press(";");
        driver.shows("after pull-off");
        assert_eq!(driver.point().patches, pull_off.jump.unwrap().patches[1]);
        driver.press("! ,");
        let before = events[place - 1].indentation;
        assert!((driver.point().indentation - before).abs() <= 1e-9 * before.abs());
    }
}

#[test]
fn a_pane_chosen_in_the_list_of_commands_is_shown() {
    for size in [
        (160, 45),
        (120, 36),
        (100, 30),
        (80, 24),
        (60, 20),
        (40, 12),
    ] {
        for large in ["", "Q", "m", "A", "e"] {
            for pane in Pane::ALL {
                let mut driver = pressed(large);
                driver.resize(size);
                driver.app.show(*pane);
                let area = Layout::of(&driver.app).pane(*pane);
                assert!(area.is_some(), "{size:?} {large:?} {pane:?}");
            }
        }
    }
    let mut driver = pressed("");
    driver.resize((120, 36));
    driver.press(": `events` Enter");
    driver.shows("▸ Events");
}

#[test]
fn rows_of_events_are_whole_in_wide_windows_and_state_forces_where_there_is_room() {
    for name in ["two-spheres", "pressure-sensitive"] {
        let mut driver = Driver::start(open(name).unwrap());
        driver.resize((200, 55));
        driver.press("! e");
        let area = driver.area(Pane::Events);
        let mut rows = driver.rows();
        rows.truncate(area.bottom().into());
        let rows: Vec<String> = rows
            .drain(usize::from(area.y)..)
            .map(|row| row.chars().skip(area.x.into()).collect())
            .collect();
        assert!(!rows.iter().any(|row| row.contains('…')), "{rows:#?}");
        assert!(
            rows.iter()
                .any(|row| row.contains("fJ") || row.contains("pJ"))
        );
        driver.press("z");
        driver.shows(" F ");
    }
}

#[test]
fn a_selected_timeline_without_a_title_is_marked() {
    let mut driver = Driver::start(open("pressure-sensitive").unwrap());
    driver.press("!");
    driver.resize((80, 24));
    let row = |driver: &Driver| {
        let area = driver.area(Pane::Timeline);
        driver.rows()[usize::from(area.bottom()) - 1].clone()
    };
    driver.app.view.pane = Pane::Force;
    assert!(row(&driver).starts_with('├'), "{}", row(&driver));
    driver.app.view.pane = Pane::Timeline;
    assert!(row(&driver).starts_with('▸'), "{}", row(&driver));
}

#[test]
fn a_narrow_window_shows_the_force_under_manual_loading() {
    let mut driver = Driver::start(open("pressure-sensitive").unwrap());
    driver.resize((80, 24));
    driver.press("! d Right");
    let title = driver.rows()[usize::from(driver.area(Pane::Force).y) - 1].clone();
    assert!(title.contains("◆ d ") && title.contains(" F -"), "{title}");
}
