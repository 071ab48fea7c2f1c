//! Colours and markers: everything they show is also shown by glyphs.

use super::common::driver::Driver;
use super::common::script::rows;
use super::{SIZES, everywhere, pressed, reversed, row_with};
use asperity::explorer::layout::Layout;
use asperity::explorer::theme::{Appearance, Choice, Marker, Theme};
use clap::ValueEnum;
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::Color;
use std::collections::HashSet;

/// All colours on a screen, each once.
fn colours(screen: &Buffer) -> Vec<Color> {
    let mut used = Vec::new();
    for colour in screen.content.iter().flat_map(|cell| [cell.fg, cell.bg, cell.underline_color]) {
        if !used.contains(&colour) {
            used.push(colour);
        }
    }
    used
}

/// Colours that cannot be read on the background of a theme.
fn unreadable(theme: Theme) -> Vec<Color> {
    use Color::{Black, Blue, DarkGray, Gray, LightCyan, LightGreen, LightYellow, White, Yellow};
    match theme {
        // Neither white nor black can be read on every background.
        Theme::Neutral | Theme::Plain | Theme::HighContrast => vec![White, Black, Gray, Yellow, LightYellow],
        Theme::Dark => vec![Black, DarkGray, Blue],
        Theme::Light => vec![White, Gray, Yellow, LightYellow, LightGreen, LightCyan],
    }
}

#[test]
fn the_plain_theme_has_no_colours_and_the_others_only_the_sixteen() {
    let mut used = [const { Vec::new() }; 5];
    for mut driver in everywhere() {
        for size in [SIZES[0], SIZES[3]] {
            driver.resize(size);
            for (theme, used) in Theme::value_variants().iter().zip(&mut used) {
                for marker in [Marker::Braille, Marker::HalfBlock] {
                    driver.app.view.appearance = Appearance { theme: *theme, marker };
                    let found = colours(&driver.screen());
                    let sixteen = |colour: &Color| !matches!(colour, Color::Rgb(..) | Color::Indexed(_));
                    assert!(found.iter().all(sixteen), "{theme:?} {marker:?}: {found:?}");
                    used.extend(found);
                }
            }
        }
    }
    for (theme, used) in Theme::value_variants().iter().zip(&used) {
        let many = used.iter().collect::<HashSet<_>>().len();
        match theme {
            Theme::Plain => assert_eq!(many, 1, "{used:?}"),
            Theme::HighContrast => assert_eq!(many, 3, "{used:?}"),
            _ => assert!(many > 5, "{theme:?}: {used:?}"),
        }
        assert!(!unreadable(*theme).iter().any(|colour| used.contains(colour)), "{theme:?}");
    }
}

#[test]
fn screens_are_made_of_the_characters_of_their_marker() {
    let is_braille = |character: char| ('\u{2800}'..='\u{28ff}').contains(&character);
    for mut driver in everywhere() {
        for size in SIZES {
            driver.resize(size);
            driver.app.view.appearance.marker = Marker::Ascii;
            for cell in &driver.screen().content {
                let symbol = cell.symbol();
                let printable = symbol.bytes().all(|byte| (b' '..=b'~').contains(&byte));
                assert!(symbol.len() == 1 && printable, "{symbol} {size:?}\n{}", driver.text());
            }
            driver.app.view.appearance.marker = Marker::Octant;
            assert!(!driver.text().contains(is_braille), "{size:?}\n{}", driver.text());
        }
    }
    for (marker, range) in [
        (Marker::Braille, '\u{2801}'..='\u{28ff}'),
        (Marker::Octant, '\u{1cd00}'..='\u{1cde5}'),
        (Marker::HalfBlock, '▀'..='▄'),
    ] {
        let mut driver = pressed("");
        driver.app.view.appearance.marker = marker;
        let dots = driver.text().chars().filter(|character| range.contains(character)).count();
        assert!(dots > 100, "{marker:?}: {dots}\n{}", driver.text());
    }
}

#[test]
fn half_blocks_lose_no_half_where_two_colours_meet() {
    let mut driver = pressed("c L d {");
    driver.app.view.appearance.marker = Marker::HalfBlock;
    let halves = |driver: &Driver| -> Vec<[bool; 2]> {
        let screen = driver.screen();
        let filled = |cell: &Cell| match cell.symbol() {
            "█" => [true, true],
            "▀" => [true, cell.bg != Color::Reset],
            "▄" => [cell.bg != Color::Reset, true],
            _ => [false, false],
        };
        screen.content.iter().map(filled).collect()
    };
    driver.app.view.appearance.theme = Theme::Plain;
    let plain = halves(&driver);
    for theme in Theme::value_variants() {
        driver.app.view.appearance.theme = *theme;
        assert_eq!(halves(&driver), plain, "{theme:?}");
    }
}

#[test]
fn keys_change_colours_and_markers_and_say_so() {
    let mut driver = pressed("");
    for theme in [Theme::Dark, Theme::Light, Theme::HighContrast, Theme::Plain, Theme::Neutral] {
        driver.press("T");
        assert_eq!(driver.app.view.appearance.theme, theme);
        assert!(driver.status().contains(&theme.name()), "{}", driver.status());
    }
    for marker in [Marker::Octant, Marker::HalfBlock, Marker::Ascii, Marker::Braille] {
        driver.press("M");
        assert_eq!(driver.app.view.appearance.marker, marker);
        assert!(driver.status().contains(&marker.name()), "{}", driver.status());
        // The worker was asked for the present number of columns.
        let cells = Layout::of(&driver.app).profile_cells();
        let columns = driver.snapshot().profile.columns.len();
        assert_eq!(columns, cells * marker.columns());
    }
}

#[test]
fn the_selected_row_is_marked_by_a_glyph_and_by_style() {
    for theme in Theme::value_variants() {
        let mut driver = pressed("Tab Tab");
        driver.app.view.appearance.theme = *theme;
        for path in ["length", "roughness.hurst", "numerics.samples"] {
            driver.select(path);
            let name = driver.app.edit.parameter().unwrap().field.name;
            let screen = driver.screen();
            let row = row_with(&screen, "›");
            assert!(reversed(row).contains(name), "{name}: {:?}", reversed(row));
            let marks = rows(&screen).iter().filter(|row| row.contains('›')).count();
            assert_eq!(marks, 1, "{}", driver.text());
        }
    }
}
