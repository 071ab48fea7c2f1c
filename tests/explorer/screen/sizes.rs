//! The same statements in windows of five sizes: nothing is cut without a sign, and what is asked for is in sight.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::rough;
use super::{SIZES, default_scene, mid_retraction, pressed};
use asperity::explorer::layout::Layout;
use asperity::explorer::model::Pane;
use asperity::scene::{Effect, open};

/// A window in which every message has room.
const WIDE: (u16, u16) = (400, 40);

/// Glyphs of the marks of a curve and of the state shown.
const MARKS: [char; 5] = ['◇', '▲', '▼', '○', '◆'];

/// A Braille character with at least one dot.
fn has_dots(character: char) -> bool {
    ('\u{2801}'..='\u{28ff}').contains(&character)
}

#[test]
fn marks_are_at_their_curve() {
    within(60, || {
        for size in SIZES {
            let mut found = 0;
            for document in [default_scene(), rough()] {
                let mut driver = mid_retraction(document);
                driver.resize(size);
                // The axis of zero force would be beside any mark.
                let rows: Vec<Vec<char>> = driver.rows().iter().map(|row| row.chars().collect()).collect();
                let area = Layout::of(&driver.model).pane(Pane::Force).unwrap();
                let at = |column: usize, row: usize| rows.get(row).and_then(|row| row.get(column)).copied();
                for row in usize::from(area.y) + 3..usize::from(area.bottom()) {
                    for column in usize::from(area.x)..usize::from(area.right()) {
                        let Some(mark) = at(column, row).filter(|here| MARKS.contains(here)) else {
                            continue;
                        };
                        let around = [(0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)];
                        let near = around
                            .into_iter()
                            .filter_map(|(right, down)| at(column + right - 1, row + down - 1));
                        let is_near = near.into_iter().any(|near| has_dots(near) || MARKS.contains(&near));
                        assert!(is_near, "{mark} {size:?}\n{}", driver.text());
                        found += 1;
                    }
                }
            }
            assert!(found >= 2, "{size:?}: {found}");
        }
    });
}

#[test]
fn messages_are_whole_or_end_in_an_ellipsis() {
    within(60, || {
        let scenes: [(&str, &str); 5] = [
            ("d F - 1 Enter", "! the contact detaches before -1; smallest force within reach: -"),
            ("d F 1 e 3 0 Enter", "! "),
            ("e Ctrl+u 1 2 k g Enter", "! "),
            ("e Ctrl+u - 1 Enter", "! roughness.hurst = -1.0: allowed: above 0 and below 1"),
            ("L q", "The scene has unsaved changes. Leave?"),
        ];
        for (keys, begins) in scenes {
            let mut driver = pressed(keys);
            driver.resize(WIDE);
            let whole = driver.status();
            assert!(whole.starts_with(begins) && !whole.ends_with('…'), "{keys}: {whole}");
            for size in SIZES {
                driver.resize(size);
                let status = driver.status();
                let start = status.strip_suffix('…').unwrap_or(&status);
                assert!(whole.starts_with(start), "{size:?} {keys}: {status}");
                let is_whole = status == whole;
                assert!(
                    is_whole || status.ends_with('…') && status.chars().count() >= 8,
                    "{size:?}: {status}"
                );
                assert!(!is_whole || whole.chars().count() <= usize::from(size.0), "{size:?}: {status}");
            }
        }
    });
}

#[test]
fn titles_notices_and_explanations_are_whole_or_end_in_an_ellipsis() {
    within(60, || {
        for size in SIZES {
            for document in [default_scene(), rough()] {
                let notice = document.scene().notice.clone();
                let mut driver = Driver::start(document);
                driver.resize(size);
                let layout = Layout::of(&driver.model);
                let rows = driver.rows();
                if let Some(title) = layout.title {
                    let head = rows[..usize::from(title.height)].join(" ");
                    let end = notice.split_whitespace().last().unwrap();
                    assert!(head.trim_end().ends_with(end) || head.contains('…'), "{size:?}: {head}");
                }
                driver.press("Tab Tab");
                for (pane, area) in Layout::of(&driver.model).panes {
                    let frame: String = driver.rows()[usize::from(area.y)]
                        .chars()
                        .skip(area.x.into())
                        .take(area.width.into())
                        .collect();
                    let is_framed = frame.starts_with('┌');
                    assert!(
                        !is_framed || frame.ends_with("─┐") || frame.ends_with(" ┐") || frame.ends_with("…┐"),
                        "{size:?} {pane:?}: {frame}"
                    );
                }
                driver.select("adhesion");
                driver.model.pane = Pane::Parameters;
                let text = driver.text();
                let is_explained = text.contains("Allowed:") || text.contains('…') || size.1 < 6;
                assert!(is_explained, "{size:?}\n{text}");
            }
        }
    });
}

#[test]
fn the_help_has_the_whole_notice() {
    within(60, || {
        for size in &SIZES[..4] {
            let mut driver = Driver::start(default_scene());
            driver.resize(*size);
            driver.press("?");
            let mut seen = driver.text();
            for _ in 0..12 {
                driver.press("j");
                seen += &driver.text();
            }
            let notice = driver.model.document.scene().notice.clone();
            let missing = notice.split_whitespace().find(|word| !seen.contains(word));
            assert_eq!(missing, None, "{size:?}\n{seen}");
        }
    });
}

#[test]
fn ends_of_contact_patches_are_seen_where_a_scene_observes_them() {
    within(60, || {
        for size in SIZES {
            let mut driver = Driver::start(open("fragment-closeup").unwrap());
            driver.model.pane = Pane::CloseUp;
            driver.resize(size);
            driver.elapse(30.0);
            let close_up = &driver.model.snapshot.as_ref().unwrap().close_up;
            assert!(close_up.boundaries.len() >= 2, "{size:?}: {:?}", close_up.boundaries);
            let area = Layout::of(&driver.model).pane(Pane::CloseUp).unwrap();
            let inside = |row: &String| -> String {
                row.chars().skip(area.x.into()).take(area.width.into()).collect()
            };
            let rows = driver.rows();
            let rows = rows[usize::from(area.y)..usize::from(area.bottom())].iter().map(inside);
            let circles: usize = rows.map(|row| row.matches('○').count()).sum();
            assert!(circles >= 2 || size.1 < 12 && circles >= 1, "{size:?}: {circles}\n{}", driver.text());
        }
    });
}

#[test]
fn an_effect_is_switched_off_and_on_and_its_row_stays_selected() {
    within(60, || {
        for size in SIZES {
            let mut driver = pressed("");
            driver.resize(size);
            let before = driver.model.document.text().to_owned();
            driver.select("roughness.hurst");
            driver.press("t");
            assert!(!Effect::Roughness.is_on(driver.model.document.scene()));
            assert!(driver.rows().iter().any(|row| row.contains("›▾○")), "{size:?}\n{}", driver.text());
            driver.press("t");
            assert_eq!(driver.model.document.text(), before, "{size:?}");
        }
    });
}

#[test]
fn keys_of_the_footer_are_apart_from_what_the_connection_carries() {
    within(60, || {
        for size in &SIZES[..4] {
            for keys in ["", "e", "d", "m", "s", "/", ":", "Tab Tab Tab", "q"] {
                let mut driver = pressed(keys);
                driver.resize(*size);
                let area = Layout::of(&driver.model).footer.unwrap();
                let footer = |driver: &Driver| driver.rows()[usize::from(area.y)].clone();
                let alone = footer(&driver);
                driver.model.traffic = Some(asperity::explorer::action::Traffic { frames: 12, bytes: 4321 });
                let both = footer(&driver);
                let Some((of_keys, _)) = both.split_once("4.3 kB/s") else {
                    assert_eq!(both, alone, "{size:?} {keys}: no room");
                    continue;
                };
                assert!(
                    of_keys.ends_with("  ") && alone.starts_with(of_keys.trim_end()),
                    "{size:?} {keys}: {both}"
                );
            }
        }
    });
}

#[test]
fn completion_is_offered_only_where_a_path_is_typed() {
    within(60, || {
        for size in &SIZES[..4] {
            for (keys, is_path) in [("e", false), ("s", true), ("s Down", false), ("E", true), ("o", true)] {
                let mut driver = pressed(keys);
                driver.resize(*size);
                let area = Layout::of(&driver.model).footer.unwrap();
                let footer = driver.rows()[usize::from(area.y)].clone();
                let offers = footer.contains("Tab complete");
                assert!(offers == is_path || is_path && size.0 < 60, "{size:?} {keys}: {footer}");
            }
        }
    });
}
