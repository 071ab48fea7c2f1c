//! Windows that grow and shrink, and panes that take the whole of them.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::script::draw;
use super::{SIZES, everywhere, pressed};
use asperity::explorer::app::Pane;
use asperity::explorer::layout::Layout;
use asperity::scene::format_quantity;

#[test]
fn every_pane_can_have_the_whole_screen() {
    within(30, || {
        let mut driver = pressed("");
        let all = Layout::of(&driver.app).panes.len();
        assert_eq!(all, 4);
        for _ in 0..4 {
            driver.press("z");
            assert_eq!(Layout::of(&driver.app).panes.len(), 1);
            assert_eq!(Layout::of(&driver.app).panes[0].0, driver.app.view.pane);
            driver.press("z Tab");
            assert_eq!(Layout::of(&driver.app).panes.len(), 4);
        }
        assert_eq!(driver.app.view.pane, Pane::Force);
    });
}

#[test]
fn a_small_window_keeps_the_chosen_pane() {
    within(30, || {
        for size in SIZES {
            let mut driver = pressed("");
            driver.resize(size);
            for _ in 0..4 {
                let layout = Layout::of(&driver.app);
                let shown = layout.pane(driver.app.view.pane).expect("the chosen pane is shown");
                assert!(shown.width > 0 && shown.height > 0);
                driver.press("Tab");
            }
        }
    });
}

#[test]
fn panes_have_the_same_shares_of_windows_of_any_width() {
    let mut driver = pressed("");
    for columns in [100, 1100, 1200, 3000] {
        driver.app.view.size = (columns, 40);
        let layout = Layout::of(&driver.app);
        assert_eq!(layout.pane(Pane::Profile).map(|area| area.width), Some(columns / 50 * 29), "{columns}");
    }
}

#[test]
fn a_screen_grows_back_to_what_it_was() {
    within(30, || {
        let mut driver = pressed("");
        let before = driver.screen();
        for size in [(40, 12), (20, 5), (1, 1), (0, 0), (300, 100), (120, 40)] {
            driver.resize(size);
            // The matching snapshot arrives after the first drawing.
            driver.screen();
        }
        assert_eq!(driver.screen(), before);
    });
}

#[test]
fn a_pane_that_has_just_come_is_drawn_before_its_picture_is_there() {
    within(30, || {
        for (small, large) in [((40, 12), (120, 40)), ((20, 5), (80, 24)), ((120, 40), (40, 12))] {
            let mut driver = pressed("");
            driver.resize(small);
            // The window grows, and is drawn before the answer of the worker.
            driver.app.view.size = large;
            draw(&driver.app);
            for _ in 0..4 {
                let panes = driver.app.panes();
                let place = panes.iter().position(|pane| *pane == driver.app.view.pane).unwrap();
                driver.app.view.pane = panes[(place + 1) % panes.len()];
                driver.app.view.size = small;
                draw(&driver.app);
                driver.app.view.zoomed = !driver.app.view.zoomed;
                draw(&driver.app);
            }
        }
    });
}

/// True for each cell of the pane across the screen that is not blank.
fn marked(driver: &Driver) -> Vec<bool> {
    driver.screen().content.iter().map(|cell| !cell.symbol().trim().is_empty()).collect()
}

#[test]
fn a_picture_made_for_another_window_is_fitted_into_this_one() {
    within(30, || {
        for (from, to) in [((120, 40), (60, 20)), ((60, 20), (120, 40))] {
            let mut kept = pressed("Tab z");
            kept.resize(from);
            let mut fresh = pressed("Tab z");
            fresh.resize(to);
            // The scene fails, so the picture cannot be drawn anew.
            let failed = |driver: &mut Driver| {
                driver.select("loading");
                driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
            };
            failed(&mut kept);
            failed(&mut fresh);
            kept.resize(to);
            let (kept, fresh) = (marked(&kept), marked(&fresh));
            let differ = kept.iter().zip(&fresh).filter(|(one, other)| one != other).count();
            assert!(6 * differ < fresh.len(), "{differ} of {} cells differ", fresh.len());
        }
    });
}

#[test]
fn a_window_that_has_shrunk_is_drawn_before_the_explorer_knows() {
    within(30, || {
        for mut driver in everywhere() {
            for size in [(80, 24), (40, 12), (20, 5), (1, 1)] {
                let backend = ratatui::backend::TestBackend::new(size.0, size.1);
                let mut terminal = ratatui::Terminal::new(backend).unwrap();
                driver.app.view.size = (120, 40);
                terminal.draw(|frame| asperity::explorer::view::draw(frame, &driver.app)).unwrap();
            }
        }
    });
}

#[test]
fn all_panes_are_seen_in_a_window_of_80_by_24() {
    within(30, || {
        let mut driver = pressed("");
        driver.resize((80, 24));
        let text = driver.text();
        for title in ["Force F(d)", "Profile z(x)", "Contact patches", "Parameters"] {
            assert!(text.contains(title), "{title}\n{text}");
        }
        assert!(Layout::of(&driver.app).footer.is_some());
    });
}

#[test]
fn the_smallest_window_says_what_is_true() {
    within(30, || {
        let mut driver = pressed("");
        driver.resize((20, 5));
        let outcome = driver.app.solved.clone().unwrap().outcome.clone();
        let force = format_quantity(outcome.figures.adhesion_force.unwrap(), "N");
        let assert_shows = |driver: &Driver, text: &str| {
            assert!(driver.text().contains(text), "{text}\n{}", driver.text());
        };
        assert_eq!(driver.status(), format!("F_a {force}"), "and no number that is cut");
        assert_shows(&driver, "◆");
        driver.press("Tab");
        assert_shows(&driver, "⣿");
        driver.press("Tab");
        assert_shows(&driver, "›");
    });
}

#[test]
fn no_number_of_the_status_is_cut() {
    within(60, || {
        let mut driver = pressed("d {");
        driver.resize((200, 40));
        let whole = driver.status();
        for columns in 12..200 {
            driver.resize((columns, 40));
            let status = driver.status();
            // Each fact is shown in full.
            let facts = |status: &str| -> Vec<String> {
                status
                    .replace("manual: ", "")
                    .replace("  ◆ ", " · ")
                    .split(" · ")
                    .map(str::to_owned)
                    .collect()
            };
            let all = facts(&whole);
            let has_error = all[0].starts_with(&facts(&status)[0]);
            assert!(
                has_error && facts(&status)[1..].iter().all(|fact| all.contains(fact)),
                "{status}|{whole}"
            );
        }
    });
}
