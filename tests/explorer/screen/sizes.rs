//! One walk over every mode and pane in windows of five sizes, in all themes and markers; and what
//! has to be visible in each window.

use super::common::script::rows;
use super::*;
use asperity::explorer::layout::has_title;
use asperity::explorer::theme::{Cycle, Marker, Theme};
use asperity_plot::Colours;
use clap::ValueEnum;
use ratatui::buffer::Buffer;
use ratatui::style::Color;

/// Colours that cannot be read on the background of a theme.
fn unreadable(theme: Theme) -> &'static [Color] {
    use Color::{Black, Blue, Gray, LightCyan, LightGreen, LightYellow, White, Yellow};
    match theme {
        // Neither white nor black can be read on every background.
        Theme::Neutral => &[White, Black, Gray, Yellow, LightYellow],
        Theme::Dark => &[Black, Blue],
        Theme::Light => &[White, Gray, Yellow, LightYellow, LightGreen, LightCyan],
    }
}

/// Colours of all cells of a screen.
fn colours_of(screen: &Buffer) -> impl Iterator<Item = Color> {
    let cells = screen.content.iter();
    cells.flat_map(|cell| [cell.fg, cell.bg, cell.underline_color])
}

#[test]
fn every_screen_is_readable_in_all_windows_themes_and_markers() {
    for mut driver in everywhere() {
        let before = driver.screen();
        for size in SIZES
            .into_iter()
            .chain([(300, 40), (20, 6), (1, 1), (0, 0)])
        {
            driver.resize(size);
            // Colours depend on the panes, which are all shown in two of the windows.
            let themes = match size {
                (120, 40) | (80, 24) => Theme::value_variants(),
                _ => &[],
            };
            let text = driver.text();
            for theme in themes {
                driver.app.view.appearance.theme = *theme;
                let screen = driver.screen();
                assert_eq!(rows(&screen).join("\n"), text, "{theme:?}");
                for colour in colours_of(&screen) {
                    let is_free = matches!(colour, Color::Rgb(..) | Color::Indexed(_));
                    assert!(
                        !is_free && !unreadable(*theme).contains(&colour),
                        "{theme:?} {colour}"
                    );
                }
            }
            let looks: &[(Theme, Colours)] = if themes.is_empty() {
                &[(Theme::Dark, Colours::TrueColour)]
            } else {
                &[
                    (Theme::Neutral, Colours::Plain),
                    (Theme::Light, Colours::Ansi256),
                    (Theme::Dark, Colours::TrueColour),
                ]
            };
            for &(theme, colours) in looks {
                driver.app.view.appearance.theme = theme;
                driver.app.view.appearance.colours = colours;
                for colour in colours_of(&driver.screen()) {
                    let is_right = match colour {
                        Color::Reset => true,
                        Color::Indexed(_) => colours == Colours::Ansi256,
                        Color::Rgb(..) => colours == Colours::TrueColour,
                        _ => false,
                    };
                    assert!(is_right, "{colours:?} {colour}");
                }
            }
            driver.app.view.appearance.marker = Marker::Ascii;
            let is_printable =
                |symbol: &str| symbol.len() == 1 && matches!(symbol.as_bytes()[0], b' '..=b'~');
            let screen = driver.screen();
            assert!(
                screen
                    .content
                    .iter()
                    .all(|cell| is_printable(cell.symbol())),
                "{size:?}\n{}",
                driver.text()
            );
            driver.app.view.appearance = APPEARANCE;
        }
        driver.resize((120, 40));
        assert_eq!(
            driver.screen(),
            before,
            "a window that grows back shows what it showed"
        );
    }
}

#[test]
fn a_key_changes_the_colours_and_says_so() {
    let mut driver = pressed("");
    for theme in [Theme::Dark, Theme::Light, Theme::Neutral] {
        driver.press("T");
        assert_eq!(driver.app.view.appearance.theme, theme);
        driver.states(theme.name());
    }
}

#[test]
fn no_number_of_the_status_is_cut() {
    let mut driver = pressed("d Shift+Left");
    driver.resize((200, 40));
    let whole = driver.status();
    for columns in 12..200 {
        driver.resize((columns, 40));
        let status = driver.status();
        // Each fact is shown in full.
        let facts =
            |status: &str| -> Vec<String> { status.split(" · ").map(str::to_owned).collect() };
        let all = facts(&whole);
        let has_error = all[0].starts_with(&facts(&status)[0]);
        assert!(
            has_error && facts(&status)[1..].iter().all(|fact| all.contains(fact)),
            "{status}|{whole}"
        );
    }
}

/// A window with room for every message.
const WIDE: (u16, u16) = (400, 40);

#[test]
fn messages_are_whole_or_end_in_an_ellipsis() {
    let scenes: [(&str, &str); 3] = [
        ("Enter Ctrl+u 1 2 k g Enter", "! "),
        (
            "Enter Ctrl+u - 1 Enter",
            "! roughness.hurst = -1.0: allowed: above 0 and below 1",
        ),
        ("L q", "The scene has unsaved changes. Leave?"),
    ];
    for (keys, begins) in scenes {
        let mut driver = pressed(keys);
        driver.resize(WIDE);
        let whole = driver.status();
        assert!(
            whole.starts_with(begins) && !whole.ends_with('…'),
            "{keys}: {whole}"
        );
        for size in SIZES {
            driver.resize(size);
            let status = driver.status();
            let start = status.strip_suffix('…').unwrap_or(&status);
            assert!(whole.starts_with(start), "{size:?} {keys}: {status}");
            // In small windows the reason continues in place of the keys.
            let footer = driver.rows().pop().unwrap_or_default();
            let rest = footer.trim_end().trim_end_matches('…');
            let is_whole = status == whole || !rest.is_empty() && whole.contains(rest);
            assert!(
                is_whole || status.ends_with('…') && status.chars().count() >= 8,
                "{size:?}: {status}"
            );
            assert!(
                status != whole || whole.chars().count() <= usize::from(size.0),
                "{size:?}: {status}"
            );
        }
    }
}

/// The pane alone in the window, with a whole profile behind it.
fn zoomed(pane: Pane, size: (u16, u16)) -> Driver {
    let mut driver = match pane {
        Pane::Map => map::mapped(rough()),
        Pane::Trust => trust::measured(rough()),
        Pane::Preloads => computed_preloads(rough()),
        Pane::Spectrum => pressed("Q"),
        _ => pressed(""),
    };
    driver.app.view.pane = pane;
    driver.app.view.zoomed = true;
    driver.resize(size);
    steps(&mut driver, "Right");
    driver
}

#[test]
fn axes_have_numbers_quantities_and_units_in_every_pane() {
    for size in SIZES {
        for (pane, across, up) in [
            (Pane::Force, "d (", "F ("),
            (Pane::Profile, "x (", "z ("),
            (Pane::CloseUp, "x (", "z ("),
            (Pane::Spectrum, "q (", "C ("),
            (Pane::Preloads, "F_n (", "F_a ("),
            (Pane::Trust, "t (", "error"),
            (Pane::Map, " H", "κ"),
        ] {
            let driver = zoomed(pane, size);
            let area = Layout::of(&driver.app).pane(pane).unwrap();
            // A low window has the words of trust and not the chart.
            if !has_title(area) || pane == Pane::Trust && area.height < 30 {
                continue;
            }
            let rows = driver.rows()[usize::from(area.y)..usize::from(area.bottom())].join("\n");
            assert!(
                rows.contains(across) && rows.contains(up),
                "{size:?} {pane:?}\n{rows}"
            );
            let has_numbers = rows.lines().filter(|row| row.contains('┤')).count() >= 2;
            assert!(has_numbers || area.height < 12, "{size:?} {pane:?}\n{rows}");
        }
    }
}

#[test]
fn a_key_of_a_pane_shows_the_pane() {
    for size in SIZES {
        for (keys, pane) in [
            ("Q", Pane::Spectrum),
            ("i", Pane::Preloads),
            ("A", Pane::Trust),
            ("Y", Pane::Sensitivity),
            ("m", Pane::Map),
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
}

#[test]
fn a_high_window_shows_the_events_below_the_results() {
    let mut driver = pressed("");
    for ((columns, rows), is_shown) in [((200, 60), true), ((120, 36), false)] {
        driver.resize((columns, rows));
        let layout = Layout::of(&driver.app);
        assert_eq!(layout.pane(Pane::Events).is_some(), is_shown, "{rows} rows");
        assert!(layout.pane(Pane::Result).is_some());
    }
}
