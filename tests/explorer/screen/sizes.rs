//! The same statements in windows of five sizes: every cut has a sign, and requested parts are visible.

use super::accuracy::measured;
use super::chart::charted;
use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::rough;
use super::crosshair::read;
use super::preloads::computed_preloads;
use super::{SIZES, default_scene, mid_retraction, pressed};
use asperity::explorer::action::{Action, Gesture, Mouse};
use asperity::explorer::app::Pane;
use asperity::explorer::layout::{Layout, inside, is_framed};
use asperity::explorer::theme::{Marker, Theme};
use asperity::scene::{format_quantity, open};
use std::collections::BTreeSet;

/// A window with room for every message.
const WIDE: (u16, u16) = (400, 40);

/// Glyphs of the marks of a curve and of the shown state.
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
                // The axis of zero force would lie beside any mark.
                let rows: Vec<Vec<char>> = driver.rows().iter().map(|row| row.chars().collect()).collect();
                let area = Layout::of(&driver.app).pane(Pane::Force).unwrap();
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
                let layout = Layout::of(&driver.app);
                let rows = driver.rows();
                if let Some(title) = layout.title {
                    let head = rows[..usize::from(title.height)].join(" ");
                    let end = notice.split_whitespace().last().unwrap();
                    assert!(head.trim_end().ends_with(end) || head.contains('…'), "{size:?}: {head}");
                }
                driver.press("Tab Tab");
                for (pane, area) in Layout::of(&driver.app).panes {
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
                driver.app.view.pane = Pane::Parameters;
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
            let notice = driver.app.edit.document.scene().notice.clone();
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
            driver.app.view.pane = Pane::CloseUp;
            driver.resize(size);
            driver.elapse(30.0);
            let close_up = &driver.app.snapshot.as_ref().unwrap().close_up;
            assert!(close_up.boundaries.len() >= 2, "{size:?}: {:?}", close_up.boundaries);
            let area = Layout::of(&driver.app).pane(Pane::CloseUp).unwrap();
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
fn keys_of_the_footer_are_apart_from_what_the_connection_carries() {
    within(60, || {
        for size in &SIZES[..4] {
            for keys in ["", "e", "d", "m", "s", "/", ":", "Tab Tab Tab", "q"] {
                let mut driver = pressed(keys);
                driver.resize(*size);
                let area = Layout::of(&driver.app).footer.unwrap();
                let footer = |driver: &Driver| driver.rows()[usize::from(area.y)].clone();
                let alone = footer(&driver);
                driver.app.view.traffic =
                    Some(asperity::explorer::action::Traffic { frames: 12, bytes: 4321 });
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
            for (keys, is_path) in [("e", false), ("s", true), ("E", true), ("o", true)] {
                let mut driver = pressed(keys);
                driver.resize(*size);
                let area = Layout::of(&driver.app).footer.unwrap();
                let footer = driver.rows()[usize::from(area.y)].clone();
                let offers = footer.contains("Tab complete");
                assert!(offers == is_path || is_path && size.0 < 60, "{size:?} {keys}: {footer}");
            }
        }
    });
}

/// The pane alone in the window, with a whole profile behind it.
fn zoomed(pane: Pane, size: (u16, u16)) -> Driver {
    let mut driver = match pane {
        Pane::Chart => charted(rough()),
        Pane::Accuracy => measured(rough()),
        Pane::Preloads => computed_preloads(rough()),
        Pane::Everett | Pane::Density => super::reversals::reversed(rough()),
        Pane::Lengths => pressed("D"),
        Pane::Spectrum => pressed("Q"),
        Pane::Beside => pressed("c & Tab Tab"),
        _ => pressed(""),
    };
    driver.app.view.pane = pane;
    driver.app.view.zoomed = true;
    driver.resize(size);
    driver.press(".");
    driver
}

#[test]
fn axes_have_numbers_quantities_and_units_in_every_pane() {
    within(120, || {
        for size in SIZES {
            for (pane, across, up) in [
                (Pane::Force, "d (", "F ("),
                (Pane::Profile, "x (", "z ("),
                (Pane::CloseUp, "x (", "z ("),
                (Pane::Beside, "x (", "z ("),
                (Pane::Lengths, "δx (", "○ n"),
                (Pane::Spectrum, "q (", "C ("),
                (Pane::Preloads, "F_n (", "F_a ("),
                (Pane::Everett, "d (", "d_r ("),
                (Pane::Density, "d (", "d_r ("),
                (Pane::Accuracy, "t (", "error"),
                (Pane::Chart, " H", "κ"),
            ] {
                let driver = zoomed(pane, size);
                let area = Layout::of(&driver.app).pane(pane).unwrap();
                if !is_framed(area) {
                    continue;
                }
                let rows = driver.rows()[usize::from(area.y)..usize::from(area.bottom())].join("\n");
                assert!(rows.contains(across) && rows.contains(up), "{size:?} {pane:?}\n{rows}");
                let has_numbers = rows.lines().filter(|row| row.contains('┤')).count() >= 2;
                assert!(has_numbers || area.height < 12, "{size:?} {pane:?}\n{rows}");
            }
        }
    });
}

#[test]
fn the_force_axis_has_its_unit_wherever_it_is_drawn() {
    within(60, || {
        for size in SIZES {
            for keys in ["", "z", "N", "v", "v v"] {
                let mut driver = pressed(keys);
                driver.app.view.pane = Pane::Force;
                driver.resize(size);
                let area = Layout::of(&driver.app).pane(Pane::Force).unwrap();
                let rows: Vec<String> = driver.rows()[usize::from(area.y)..usize::from(area.bottom())]
                    .iter()
                    .map(|row| row.chars().skip(area.x.into()).take(area.width.into()).collect())
                    .collect();
                let text = rows.join("\n");
                let label = match keys {
                    "N" => "F/F_a,max",
                    "v" => "l (",
                    "v v" => "n",
                    _ => "F (µN)",
                };
                assert!(text.contains(label) || !is_framed(area), "{size:?} {keys}\n{text}");
            }
        }
    });
}

#[test]
fn the_crosshair_reads_the_curve() {
    within(60, || {
        for size in SIZES {
            let mut driver = pressed("*");
            driver.app.view.pane = Pane::Force;
            driver.resize(size);
            let point = |driver: &Driver| driver.app.snapshot.as_ref().unwrap().point;
            let before = point(&driver);
            driver.press("Right Right");
            assert_ne!(point(&driver).indentation, before.indentation, "{size:?}");
            let read = format!("d {}", read(point(&driver).indentation, 2, "m"));
            let has_edge = is_framed(Layout::of(&driver.app).pane(Pane::Force).unwrap());
            assert!(!has_edge || driver.text().contains(&read), "{size:?} {read}\n{}", driver.text());
        }
    });
}

#[test]
fn the_map_has_hurst_exponents_across_and_is_exported() {
    within(120, || {
        for size in SIZES {
            let mut driver = charted(rough());
            driver.resize(size);
            let scene = |driver: &Driver| {
                let hurst =
                    driver.app.edit.document.value("roughness.hurst").unwrap().parse::<f64>().unwrap();
                let kappa = driver.app.governing().unwrap().kappa.unwrap();
                (hurst, Some(kappa))
            };
            let near = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-9;
            let (hurst, kappa) = driver.app.place().unwrap();
            assert!(near(hurst, scene(&driver).0) && near(kappa.unwrap(), scene(&driver).1.unwrap()));
            driver.press("Right");
            assert!(scene(&driver).0 > hurst && near(scene(&driver).1.unwrap(), kappa.unwrap()), "{size:?}");
            let marks = driver.rows().iter().filter(|row| row.contains('◆')).count();
            assert!(marks >= 1, "{size:?}\n{}", driver.text());
            driver.press("E");
            let prompt = driver.status();
            assert!(prompt.starts_with("Export"), "{size:?}: {prompt}");
            driver.press("Ctrl+u");
            driver.type_text("map.csv");
            driver.press("Enter");
            assert!(driver.file("map.csv").lines().count() > 9, "{size:?}");
        }
    });
}

#[test]
fn ghosts_have_letters_and_forces_and_titles_name_quantities() {
    within(60, || {
        for size in SIZES {
            let mut driver = pressed("c");
            driver.select("adhesion.work");
            driver.press("L");
            driver.app.view.pane = Pane::Force;
            driver.resize(size);
            let area = Layout::of(&driver.app).pane(Pane::Force).unwrap();
            let rows = &driver.rows()[usize::from(area.y)..usize::from(area.bottom())];
            let cell =
                |row: &str| -> String { row.chars().skip(area.x.into()).take(area.width.into()).collect() };
            let rows: Vec<String> = rows.iter().map(|row| cell(row)).collect();
            let is_framed = is_framed(area);
            assert!(!is_framed || rows[0].contains("Force F"), "{size:?}: {}", rows[0]);
            let inner = &rows[usize::from(is_framed)..];
            assert!(inner.iter().any(|row| row.contains('A')), "{size:?}\n{}", driver.text());
            if area.height >= 14 {
                assert!(inner.iter().any(|row| row.contains("A: F_a ") && row.contains('(')), "{inner:?}");
            }
        }
    });
}

#[test]
fn the_wheel_zooms_at_the_pointer_and_strong_contrast_keeps_profile_and_surface_apart() {
    within(60, || {
        for size in SIZES {
            let mut driver = pressed("");
            driver.app.view.pane = Pane::Profile;
            driver.app.view.appearance.theme = Theme::HighContrast;
            driver.resize(size);
            let area = inside(Layout::of(&driver.app).pane(Pane::Profile).unwrap());
            let screen = driver.screen();
            let inks: BTreeSet<String> = (area.y..area.bottom())
                .flat_map(|row| (area.x..area.right()).map(move |column| (column, row)))
                .filter(|cell| screen[*cell].symbol().chars().all(has_dots))
                .map(|cell| format!("{:?}", screen[cell].fg))
                .collect();
            assert!(inks.len() >= 2, "{size:?}: {inks:?}\n{}", driver.text());
            let shown = |driver: &Driver| {
                let section = &driver.app.snapshot.as_ref().unwrap().profile;
                (section.first, section.springs)
            };
            let (first, all) = shown(&driver);
            let column = area.x + area.width / 4;
            driver.act(Action::Mouse(Mouse { column, row: area.y + 1, gesture: Gesture::Wheel(2) }));
            let (from, springs) = shown(&driver);
            assert!(springs < all, "{size:?}: {springs} of {all}");
            // The spring under the pointer remains there: nearer to the left end than to the right one.
            assert!(from - first < first + all - (from + springs), "{size:?}: {from} {springs} of {all}");
        }
    });
}

#[test]
fn a_digit_on_a_choice_says_how_choices_are_changed() {
    within(60, || {
        for size in [SIZES[0], SIZES[4]] {
            let switch = |driver: &Driver| {
                let switches = driver.app.edit.parameters.iter().find(|one| one.path.starts_with("observe."));
                switches.map(|one| (one.path.clone(), format!("{} is a switch: t changes it", one.name())))
            };
            let (switch, says_of_switch) = switch(&pressed("")).unwrap();
            for (path, expected) in [
                ("adhesion", "adhesion is a choice: ← → change it"),
                ("numerics.edges", "edges is a choice: ← → change it"),
                ("material", "material is not a number: Enter types it"),
                ("loading", "loading is not a number: Enter types it"),
                ("numerics", "numerics is a group: Enter folds it"),
                (&switch, &says_of_switch),
            ] {
                let mut driver = pressed("");
                driver.app.edit.selected =
                    driver.app.edit.parameters.iter().position(|one| one.path == path).unwrap();
                driver.app.view.pane = Pane::Parameters;
                driver.resize(size);
                let before = driver.app.edit.document.text().to_owned();
                driver.press("2");
                let status = driver.status();
                let start = status.split("  ").next().unwrap_or_default();
                let start = start.strip_suffix('…').unwrap_or(start);
                assert!(expected.starts_with(start) && start.len() > 8, "{size:?} {path}: {status}");
                assert_eq!((driver.app.prompt.is_none(), driver.app.edit.document.text()), (true, &*before));
            }
        }
    });
}

#[test]
fn every_pane_has_its_paragraph_in_the_help() {
    for pane in Pane::ALL {
        let help = pane.row().help;
        assert!(
            !help.is_empty() && help.iter().all(|(name, text)| !name.is_empty() && text.len() > 40),
            "{pane:?}"
        );
    }
}

#[test]
fn indentation_and_force_are_in_the_status_line() {
    within(60, || {
        for size in &SIZES[..4] {
            for keys in ["", "d ]"] {
                let mut driver = pressed(keys);
                driver.resize(*size);
                let point = driver.app.snapshot.as_ref().unwrap().point;
                let [d, force] = [(point.indentation, "m"), (point.force, "N")]
                    .map(|(value, unit)| format_quantity(value, unit));
                assert!(
                    driver.status().contains(&format!("d {d} F {force}")),
                    "{size:?} {keys}: {}",
                    driver.status()
                );
            }
        }
    });
}

#[test]
fn a_key_of_a_pane_shows_the_pane() {
    within(60, || {
        for size in SIZES {
            for (keys, pane) in [
                ("D", Pane::Lengths),
                ("&", Pane::Beside),
                ("Q", Pane::Spectrum),
                ("i", Pane::Preloads),
                ("A", Pane::Accuracy),
                ("m", Pane::Chart),
            ] {
                let mut driver = pressed("");
                driver.app.view.pane = Pane::Force;
                driver.resize(size);
                let is_shown = |driver: &Driver| Layout::of(&driver.app).pane(pane).is_some();
                assert!(!is_shown(&driver));
                driver.press(keys);
                assert!(is_shown(&driver), "{size:?} {keys}\n{}", driver.text());
                driver.press(keys);
                assert!(!is_shown(&driver), "{size:?} {keys}\n{}", driver.text());
            }
        }
    });
}

#[test]
fn ascii_has_a_sign_for_plus_or_minus() {
    within(60, || {
        for size in SIZES {
            let mut driver = measured(rough());
            driver.press("A");
            driver.resize(size);
            let has_error = driver.text().contains("± ");
            driver.app.view.appearance.marker = Marker::Ascii;
            let text = driver.text();
            assert!(text.is_ascii() && !text.replace("? help", "").contains('?'), "{size:?}\n{text}");
            assert_eq!(text.contains(" +-"), has_error, "{size:?}\n{text}");
            assert!(has_error || size.0 < 48, "{size:?}\n{text}");
        }
    });
}

#[test]
fn a_force_of_rounding_is_zero() {
    within(60, || {
        let document = rough().set("loading", "[ToZeroForce, ToSeparation]").unwrap();
        let mut driver = Driver::start(document);
        let history = &driver.app.solved.as_ref().unwrap().outcome.history;
        assert!(history.legs[0].curve.last().unwrap().force.abs() < 1e-15);
        for size in &SIZES[..3] {
            driver.resize(*size);
            assert!(!driver.text().contains("yN"), "{size:?}\n{}", driver.text());
        }
        driver.resize(SIZES[0]);
        assert!(driver.text().contains("▲ 0 N"), "{}", driver.text());
    });
}
