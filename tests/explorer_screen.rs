//! The screen of the explorer: what a user sees after each key, in large windows and small ones, with
//! colours and without.

mod common {
    pub mod deadline;
    pub mod driver;
    pub mod scenes;
    pub mod script;
}

use asperity::contact::{ContactError, ContactTree};
use asperity::explorer::action::{Action, Command, Content, Jump};
use asperity::explorer::keys::{self, BINDINGS};
use asperity::explorer::layout::Layout;
use asperity::explorer::model::{Mode, ModeKind, Model, Notice, Pane};
use asperity::explorer::theme::Theme;
use asperity::explorer::update::{Effect, update};
use asperity::explorer::worker::Engine;
use asperity::scene::{Document, Leg, Scene, format_quantity, open, presets};
use asperity::simulation::{AfterLeg, Outcome, RunError, Simulation};
use asperity::surface::Line;
use common::deadline::within;
use common::driver::{Driver, REFUSED};
use common::scenes::{changed, one_spring, punch, rough, smooth, without_adhesion};
use common::script::{draw, rows};
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use std::path::Path;
use std::sync::Arc;

/// Windows, columns and rows.
const SIZES: [(u16, u16); 5] = [(120, 40), (80, 24), (60, 20), (40, 12), (20, 5)];

/// The scene the explorer opens on.
fn default_scene() -> Document {
    open(asperity::scene::DEFAULT).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Half way through the retraction, paused.
fn mid_retraction(document: Document) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space >");
    driver.elapse(3.0);
    assert_eq!((driver.model.player.leg, driver.model.player.playing), (1, false));
    driver.press(".");
    while driver.model.player.done < 0.5 {
        driver.press(".");
    }
    driver
}

/// The screen in all windows, one below the other. Without colours it says the same.
fn screens(driver: &mut Driver) -> String {
    let mut all = String::new();
    for size in SIZES {
        driver.resize(size);
        driver.model.appearance.theme = Theme::Plain;
        let plain = driver.text();
        driver.model.appearance.theme = Theme::Neutral;
        let coloured = driver.text();
        assert_eq!(plain, coloured, "{size:?}");
        let (columns, rows) = size;
        all += &format!("── {columns} × {rows} ──\n{coloured}\n");
    }
    all
}

macro_rules! screens {
    ($name:ident, $driver:expr) => {
        #[test]
        fn $name() {
            within(30, || {
                let mut driver = $driver;
                insta::assert_snapshot!(stringify!($name), screens(&mut driver));
            });
        }
    };
}

screens!(screen_before_the_first_result, Driver::open(default_scene()));
screens!(screen_mid_retraction, mid_retraction(default_scene()));
screens!(screen_of_a_smooth_scene, mid_retraction(smooth()));
screens!(screen_without_adhesion, mid_retraction(without_adhesion()));
screens!(screen_of_a_punch, mid_retraction(punch()));
screens!(screen_of_one_spring, mid_retraction(one_spring()));
screens!(screen_of_the_help, pressed("?"));
screens!(screen_while_typing, {
    let mut driver = mid_retraction(rough());
    driver.select("adhesion.kappa");
    driver.press("e Backspace Left");
    driver.type_text("5");
    driver
});
screens!(screen_of_a_refused_value, {
    let mut driver = pressed("");
    driver.enter("1.5");
    driver
});
screens!(screen_of_the_save_prompt, pressed("s"));
screens!(screen_of_the_overwrite_question, pressed("s Enter s Enter"));
screens!(screen_of_the_quit_question, pressed("l q"));
screens!(screen_of_the_force, pressed("z"));
screens!(screen_of_the_profile, pressed("Tab z"));
screens!(screen_of_the_parameters, pressed("Tab Tab z"));
screens!(screen_of_the_close_up, pressed("Tab Tab Tab z n"));
screens!(screen_of_a_scene_that_failed, {
    let mut driver = mid_retraction(rough());
    driver.select("loading");
    driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
    driver
});

/// The rough scene half way through its retraction, its Hurst exponent selected, and then some keys.
fn pressed(keys: &str) -> Driver {
    let mut driver = mid_retraction(rough());
    driver.select("roughness.hurst");
    driver.press(keys);
    driver
}

/// Explorers in every mode and pane.
fn everywhere() -> Vec<Driver> {
    let keys = ["", "?", "e", "s", "s Enter s Enter", "l q", "z", "Tab z", "Tab Tab z", "Tab Tab Tab z"];
    let mut all: Vec<Driver> = keys.into_iter().map(pressed).collect();
    all.push(Driver::open(rough()));
    let mut refused = pressed("");
    refused.enter("nothing");
    all.push(refused);
    all
}

/// The cells of a row of the screen that has this text in it.
fn row_with<'a>(screen: &'a Buffer, text: &str) -> &'a [Cell] {
    let number = rows(screen).iter().position(|row| row.contains(text));
    let number = number.unwrap_or_else(|| panic!("{text} in\n{}", rows(screen).join("\n")));
    let width = usize::from(screen.area.width);
    &screen.content[number * width..(number + 1) * width]
}

fn reversed(cells: &[Cell]) -> String {
    cells.iter().filter(|cell| cell.modifier.contains(Modifier::REVERSED)).map(Cell::symbol).collect()
}

fn generation(driver: &Driver) -> u64 {
    driver.model.generation
}

/// Whether what is shown belongs to the scene as it stands.
fn is_up_to_date(model: &Model) -> bool {
    model.computed.as_ref().is_some_and(|computed| computed.generation == model.generation)
        && model.moment.as_ref().is_some_and(|moment| moment.generation == model.generation)
        && !model.is_computing()
}

#[test]
fn the_plain_theme_has_no_colours_and_the_other_only_the_sixteen() {
    within(60, || {
        let mut used = Vec::new();
        for mut driver in everywhere() {
            for size in SIZES {
                driver.resize(size);
                driver.model.appearance.theme = Theme::Plain;
                let colours = |cell: &Cell| [cell.fg, cell.bg, cell.underline_color];
                for colour in driver.screen().content.iter().flat_map(colours) {
                    assert_eq!(colour, Color::Reset, "{:?}", driver.model.mode);
                }
                driver.model.appearance.theme = Theme::Neutral;
                for colour in driver.screen().content.iter().flat_map(colours) {
                    assert!(!matches!(colour, Color::Rgb(..) | Color::Indexed(_)), "{colour:?}");
                    // Neither white nor black can be read on every background.
                    assert!(!matches!(colour, Color::White | Color::Black | Color::Gray), "{colour:?}");
                    if !used.contains(&colour) {
                        used.push(colour);
                    }
                }
            }
        }
        assert!(used.len() > 4, "{used:?}");
    });
}

#[test]
fn the_selected_row_is_marked_by_a_glyph_and_by_style() {
    within(30, || {
        for theme in [Theme::Plain, Theme::Neutral] {
            let mut driver = pressed("");
            driver.model.appearance.theme = theme;
            for path in ["length", "roughness.hurst", "numerics.samples"] {
                driver.select(path);
                let name = driver.model.parameter().unwrap().field.name;
                let screen = driver.screen();
                let row = row_with(&screen, "›");
                assert!(reversed(row).contains(name), "{name}: {:?}", reversed(row));
                let marks = rows(&screen).iter().filter(|row| row.contains('›')).count();
                assert_eq!(marks, 1, "{}", driver.text());
            }
        }
    });
}

#[test]
fn a_value_that_is_refused_says_so_beside_its_field_and_leaves_the_scene() {
    within(30, || {
        for theme in [Theme::Plain, Theme::Neutral] {
            let mut driver = pressed("");
            driver.model.appearance.theme = theme;
            let before = driver.model.document.clone();
            let of_before = generation(&driver);
            driver.select("roughness.hurst");
            driver.enter("1.5");
            assert_eq!(driver.model.document, before);
            assert_eq!(generation(&driver), of_before);
            assert!(is_up_to_date(&driver.model), "the curve is kept");
            let screen = driver.screen();
            let row = row_with(&screen, "Hurst exponent");
            let text: String = row.iter().map(Cell::symbol).collect();
            assert!(text.contains('!') && text.contains("0.7"), "{text}");
            assert!(driver.text().contains("above 0 and below 1"), "{}", driver.text());
            // It goes when another field is selected, or the value is mended.
            driver.press("j");
            assert!(!driver.text().contains('!'), "{}", driver.text());
            driver.select("roughness.hurst");
            driver.enter("1.5");
            driver.enter("0.6");
            assert!(!driver.text().contains('!'), "{}", driver.text());
            assert!(driver.text().contains("0.6"));
        }
    });
}

#[test]
fn an_unfinished_scene_says_that_it_computes() {
    within(30, || {
        let driver = Driver::open(rough());
        assert!(driver.text().contains("computing"), "{}", driver.text());
        // Later the old curve stays until the new one is there.
        let mut driver = pressed("");
        let document = driver.model.document.set("roughness.seed", "2").unwrap();
        let before = driver.text();
        driver.model.document = document;
        driver.model.generation += 1;
        driver.model.progress = Some(0);
        let text = driver.text();
        assert!(text.contains("computing") && !before.contains("computing"), "{text}");
        let curve = |text: &str| text.chars().filter(|c| ('\u{2801}'..='\u{28ff}').contains(c)).count();
        assert!(2 * curve(&text) > curve(&before), "{text}");
    });
}

#[test]
fn the_headline_is_that_of_the_computed_curve() {
    within(60, || {
        for document in [default_scene(), rough(), smooth(), punch()] {
            let mut driver = mid_retraction(document);
            let outcome = driver.model.computed.clone().unwrap().outcome.clone();
            let force = format_quantity(outcome.figures.adhesion_force.unwrap(), "N");
            for size in &SIZES[..4] {
                driver.resize(*size);
                assert!(driver.text().contains(&format!("F_a {force}")), "{size:?}: {}", driver.text());
            }
            driver.resize(SIZES[0]);
            let point = driver.model.moment.as_ref().unwrap().point;
            for number in [format_quantity(point.force, "N"), point.springs.to_string()] {
                assert!(driver.text().contains(&number), "{number}: {}", driver.text());
            }
            assert!(driver.text().contains(outcome.regime.unwrap().name()), "{}", driver.text());
        }
    });
}

/// The keys that the footer shows, each with its word.
fn footer(driver: &Driver) -> Vec<String> {
    let area = Layout::of(&driver.model).footer.expect("there is a footer");
    let row = &driver.rows()[usize::from(area.y)];
    row.split("  ").map(|one| one.trim().to_owned()).filter(|one| !one.is_empty()).collect()
}

#[test]
fn the_footer_shows_keys_of_the_table_that_are_valid_now() {
    within(30, || {
        for mut driver in everywhere() {
            let mode = driver.model.mode.kind();
            let known: Vec<String> = keys::valid_in(mode)
                .filter(|row| !row.label.is_empty())
                .map(|row| format!("{} {}", row.keys[0].name(), row.label))
                .collect();
            for size in [(200, 40), (120, 40), (80, 24), (40, 12), (20, 6)] {
                driver.resize(size);
                let shown = footer(&driver);
                assert!(!shown.is_empty(), "{mode:?} {size:?}");
                assert!(shown.iter().all(|one| known.contains(one)), "{shown:?} {known:?}");
                if mode == ModeKind::Explore {
                    assert!(shown.iter().any(|one| one.contains("help")), "{size:?}: {shown:?}");
                    assert!(shown.iter().any(|one| one.contains("quit")), "{size:?}: {shown:?}");
                }
                if size.0 == 200 {
                    assert_eq!(shown.len(), known.len(), "{mode:?}: {shown:?}");
                }
            }
        }
    });
}

#[test]
fn each_mode_has_its_own_footer() {
    within(30, || {
        let mut seen = Vec::new();
        for keys in ["", "?", "e", "s Enter s Enter", "l q"] {
            let shown = footer(&pressed(keys));
            assert!(!seen.contains(&shown), "{shown:?}");
            seen.push(shown);
        }
        assert_eq!(footer(&pressed("e")), footer(&pressed("s")), "both are lines that are typed");
    });
}

/// All that the help says, scrolled to its end.
fn help(size: (u16, u16)) -> Vec<String> {
    let mut driver = pressed("");
    driver.resize(size);
    driver.press("?");
    let mut seen: Vec<String> = Vec::new();
    let mut before = Vec::new();
    while driver.rows() != before {
        before = driver.rows();
        seen.extend(driver.rows());
        driver.press("j");
    }
    seen
}

#[test]
fn the_help_lists_every_binding() {
    within(60, || {
        for size in [(120, 40), (120, 10)] {
            let lines = help(size);
            for row in BINDINGS.iter().filter(|row| !row.help.is_empty()) {
                let keys: Vec<String> = row.keys.iter().map(keys::Key::name).collect();
                let listed = lines.iter().any(|line| {
                    line.contains(row.help) && keys.iter().all(|key| line.contains(key.as_str()))
                });
                assert!(listed, "{keys:?}: {}\n{}", row.help, lines.join("\n"));
            }
            for section in BINDINGS.iter().map(|row| row.section) {
                assert!(lines.iter().any(|line| line.contains(section)), "{section}");
            }
        }
        // Those without a line of their own are spoken of in one beside them.
        let silent: Vec<Command> =
            BINDINGS.iter().filter(|row| row.help.is_empty()).map(|row| row.command).collect();
        assert_eq!(silent, (1..9).map(Command::Preset).collect::<Vec<_>>());
    });
}

#[test]
fn the_help_loses_no_word_in_a_narrow_window() {
    within(60, || {
        let words = |lines: Vec<String>| -> Vec<String> {
            let clean = |word: &str| word.trim_matches(['│', '─', '┌', '┐', '└', '┘']).to_owned();
            let inside = lines.iter().filter(|line| line.starts_with('│'));
            inside.flat_map(|line| line.split_whitespace()).map(clean).collect()
        };
        let narrow = words(help((80, 24)));
        for word in words(help((160, 40))) {
            assert!(narrow.contains(&word), "{word} is not to be read");
        }
    });
}

#[test]
fn the_help_scrolls_to_its_end_and_no_further() {
    within(30, || {
        let mut driver = pressed("");
        driver.resize((80, 24));
        driver.press("?");
        let top = driver.text();
        driver.press("k");
        assert_eq!(driver.text(), top);
        (0..200).for_each(|_| drop(driver.press("j")));
        let end = driver.text();
        assert!(end != top && end.contains("stay"), "{end}");
        driver.press("k");
        assert_ne!(driver.text(), end, "one step up is one step up");
        (0..200).for_each(|_| drop(driver.press("k")));
        assert_eq!(driver.text(), top);
        driver.press("Esc");
        assert_eq!(driver.model.mode, Mode::Explore);
    });
}

#[test]
fn keys_step_a_value_finely_and_coarsely() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("roughness.hurst");
        let mut hurst = |keys: &str| {
            driver.press(keys);
            assert!(is_up_to_date(&driver.model));
            driver.model.document.value("roughness.hurst").unwrap().to_owned()
        };
        for (keys, value) in [
            ("l", "0.71"),
            ("Right", "0.72"),
            ("h", "0.71"),
            ("Left", "0.7"),
            ("L", "0.8"),
            ("Shift+Right", "0.9"),
            ("H", "0.8"),
            ("Shift+Left", "0.7"),
            ("l l l h", "0.72"),
        ] {
            assert_eq!(hurst(keys), value, "{keys}");
        }
    });
}

#[test]
fn a_step_beyond_the_range_says_what_is_allowed() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("material.poisson_ratio");
        let before = driver.model.document.clone();
        assert!(driver.press("l").is_empty());
        assert_eq!(driver.model.document, before);
        assert!(driver.text().contains("0.5"), "{}", driver.text());
        let (row, error) = driver.model.refused.clone().expect("it is refused");
        assert_eq!(row, driver.model.selected);
        assert!(error.contains("allowed"), "{error}");
    });
}

#[test]
fn values_are_typed_with_prefix_and_unit() {
    within(30, || {
        let document =
            changed(&rough(), &[("adhesion", "(work: 0.05)"), ("form", "Paraboloid(radius: 1.0e-3)")]);
        let mut driver = Driver::start(document);
        for (path, typed, value) in [
            ("adhesion.work", "50m", 0.05),
            ("adhesion.work", "40 mJ/m²", 0.04),
            ("material.youngs_modulus", "2.5 MPa", 2.5e6),
            ("material.youngs_modulus", "3e6", 3e6),
            ("form.radius", "10 µm", 1e-5),
            ("form.radius", "20um", 2e-5),
            ("length", "0.2 mm", 2e-4),
        ] {
            driver.select(path);
            driver.enter(typed);
            let written: f64 = driver.model.document.value(path).unwrap().parse().unwrap();
            assert_eq!(written, value, "{path}: {typed}");
            assert!(is_up_to_date(&driver.model));
        }
        driver.select("numerics.points");
        driver.enter("2Ki");
        assert_eq!(driver.model.document.scene().numerics.points, 2048);
        // The force of a leg is a parameter as well.
        driver.select("loading");
        driver.press("j");
        driver.enter("30 µN");
        assert_eq!(driver.model.document.scene().loading, [Leg::ToForce(3e-5), Leg::ToSeparation]);
    });
}

#[test]
fn what_is_typed_can_be_edited_pasted_and_left() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("length");
        driver.press("e Home Delete");
        driver.type_text("3");
        driver.press("End");
        driver.act(Action::Paste("\n".to_owned()));
        driver.press("Enter");
        assert_eq!(driver.model.document.scene().length, 3e-4);
        let before = driver.model.document.clone();
        driver.press("e Ctrl+u 7 Esc");
        assert_eq!((&driver.model.document, driver.model.mode.kind()), (&before, ModeKind::Explore));
        // While a value is typed, letters are letters.
        driver.press("e Ctrl+u q u");
        assert_eq!(driver.model.mode.kind(), ModeKind::Edit);
        assert!(driver.text().contains("qu"), "{}", driver.text());
        driver.press("Ctrl+c");
        assert_eq!((&driver.model.document, driver.model.mode.kind()), (&before, ModeKind::Explore));
        // Typing the value it has changes nothing of it.
        driver.press("e Enter");
        assert_eq!(driver.model.document.scene(), before.scene());
    });
}

#[test]
fn what_is_chosen_and_typed_is_seen_in_the_smallest_window() {
    within(30, || {
        for size in SIZES {
            for pane in ["", "Tab", "Tab Tab", "Tab Tab Tab"] {
                for zoom in ["", "z"] {
                    let mut driver = pressed(pane);
                    driver.resize(size);
                    driver.press(zoom);
                    driver.press("j");
                    assert!(driver.text().contains('›'), "{size:?} {pane} {zoom}\n{}", driver.text());
                    driver.press("Tab e Ctrl+u");
                    driver.type_text("31415");
                    assert!(driver.text().contains("31415"), "{size:?} {pane} {zoom}\n{}", driver.text());
                }
            }
        }
    });
}

#[test]
fn the_cursor_of_what_is_typed_is_on_the_screen() {
    within(30, || {
        let long =
            "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToZeroForce, ToForce(3.0e-5), ToSeparation]";
        for size in SIZES {
            let mut driver = pressed("Tab Tab");
            driver.resize(size);
            driver.select("loading");
            driver.press("e Ctrl+u");
            driver.type_text(long);
            for keys in ["", "Home", "End", "Left Left Left"] {
                driver.press(keys);
                let screen = driver.screen();
                assert_eq!(
                    reversed(&screen.content).chars().count(),
                    1,
                    "{size:?} {keys}\n{}",
                    driver.text()
                );
            }
            driver.press("Esc s");
            driver.type_text(
                "/a/folder/with/a/name/that/is/longer/than/many/windows/are/wide/and/then/some/more.ron",
            );
            let screen = driver.screen();
            let status = Layout::of(&driver.model).status;
            let from = usize::from(status.y) * usize::from(status.width);
            let status = &screen.content[from..from + usize::from(status.width)];
            assert_eq!(reversed(status).chars().count(), 1, "{size:?}\n{}", driver.text());
        }
    });
}

#[test]
fn edits_are_taken_back_and_done_again() {
    within(30, || {
        let mut driver = pressed("");
        let mut texts = vec![driver.model.document.text().to_owned()];
        let first = driver.model.computed.clone().unwrap().outcome.figures;
        driver.select("roughness.hurst");
        for keys in ["l", "L", "h"] {
            driver.press(keys);
            texts.push(driver.model.document.text().to_owned());
        }
        let last = driver.model.computed.clone().unwrap().outcome.figures;
        assert_ne!(first, last);
        for text in texts.iter().rev().skip(1) {
            driver.press("u");
            assert_eq!(driver.model.document.text(), text);
            assert!(is_up_to_date(&driver.model));
        }
        assert!(!driver.model.is_unsaved());
        assert_eq!(driver.model.computed.clone().unwrap().outcome.figures, first);
        driver.press("u");
        assert_eq!(driver.model.document.text(), texts[0], "there is no more to take back");
        for (text, key) in texts.iter().skip(1).zip(["U", "Ctrl+r", "U"]) {
            driver.press(key);
            assert_eq!(driver.model.document.text(), text);
        }
        assert_eq!(driver.model.computed.clone().unwrap().outcome.figures, last);
        // A new edit leaves nothing to do again.
        driver.press("u l");
        let text = driver.model.document.text().to_owned();
        driver.press("U");
        assert_eq!(driver.model.document.text(), text);
        // A refused value is no edit.
        driver.enter("7");
        driver.press("u");
        assert_eq!(driver.model.document.text(), texts[2]);
    });
}

#[test]
fn number_keys_open_the_built_in_scenes() {
    within(60, || {
        let mut driver = Driver::start(rough());
        for (index, preset) in presets().iter().take(9).enumerate() {
            driver.press(&(index + 1).to_string());
            assert_eq!(driver.model.document.text(), preset.text, "{}", preset.name);
            assert!(is_up_to_date(&driver.model));
            let title = &driver.model.document.scene().title;
            assert!(driver.rows()[0].contains(title.as_str()), "{title}: {}", driver.text());
            assert!(!driver.model.is_unsaved());
            assert!(
                driver.model.player.playing && driver.model.player.done == 0.0,
                "it plays from its start"
            );
        }
    });
}

#[test]
fn a_built_in_scene_can_be_taken_back_like_any_edit() {
    within(30, || {
        let mut driver = Driver::start(rough());
        driver.select("roughness.hurst");
        driver.press("l");
        let text = driver.model.document.text().to_owned();
        driver.press("4");
        assert!(matches!(driver.model.notice, Some(Notice::Done(_))), "it is told that the change is kept");
        driver.press("u");
        assert_eq!(driver.model.document.text(), text);
        assert!(driver.model.is_unsaved());
        driver.press("u");
        assert_eq!(driver.model.document.text(), rough().text());
        assert!(!driver.model.is_unsaved(), "the scene is as it was opened");
        driver.press("q");
        assert!(driver.model.finished);
    });
}

#[test]
fn reseeding_gives_another_line_that_can_be_told() {
    within(30, || {
        let mut driver = pressed("");
        let before = driver.model.computed.clone().unwrap();
        driver.seed = 123_456;
        driver.select("roughness.seed");
        assert_eq!(driver.press("R"), [Effect::DrawSeed]);
        assert!(driver.model.document.text().contains("seed: 123456"));
        assert!(driver.text().contains("123456"), "{}", driver.text());
        assert!(is_up_to_date(&driver.model));
        assert_ne!(driver.model.computed.clone().unwrap().outcome.history, before.outcome.history);
        driver.press("u");
        assert_eq!(driver.model.computed.clone().unwrap().outcome.history, before.outcome.history);
    });
}

#[test]
fn a_smooth_scene_has_no_line_to_draw_anew() {
    within(30, || {
        let mut driver = mid_retraction(smooth());
        let before = driver.model.document.clone();
        driver.press("R");
        assert_eq!(driver.model.document, before);
        assert!(is_up_to_date(&driver.model));
        // No other field is to blame for that.
        assert_eq!(driver.model.refused, None);
        let status = Layout::of(&driver.model).status;
        let said = driver.rows()[usize::from(status.y)].clone();
        assert!(said.contains("no random line"), "{said}");
    });
}

#[test]
fn the_selection_stays_on_its_field_when_rows_come_and_go() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("numerics.samples");
        let path = |driver: &Driver| driver.model.parameter().unwrap().field.path;
        let rows = |driver: &Driver| driver.model.parameters.len();
        let before = rows(&driver);
        for (field, value) in [("form", "Cone(angle: 0.1)"), ("adhesion", "None"), ("roughness", "None")] {
            let count = rows(&driver);
            driver.select(field);
            driver.enter(value);
            assert_ne!(rows(&driver), count, "{field}");
            assert_eq!(path(&driver), field);
        }
        driver.select("numerics.samples");
        driver.press("u");
        assert_eq!(path(&driver), "numerics.samples");
        driver.press("u u");
        assert_eq!((path(&driver), rows(&driver)), ("numerics.samples", before));
        driver.press("1");
        assert_eq!(path(&driver), "numerics.samples");
    });
}

#[test]
fn a_field_that_goes_leaves_another_one_selected() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("roughness.seed");
        driver.press("7");
        assert!(driver.model.document.scene().roughness.is_none(), "the seventh scene is smooth");
        assert!(driver.model.selected < driver.model.parameters.len());
        let marked = driver.rows().iter().filter(|row| row.contains('›')).count();
        assert_eq!(marked, 1, "{}", driver.text());
    });
}

#[test]
fn the_selection_stays_in_the_list() {
    within(30, || {
        let mut driver = pressed("");
        driver.press("g k Up");
        assert_eq!(driver.model.selected, 0);
        driver.press("G j Down");
        assert_eq!(driver.model.selected, driver.model.parameters.len() - 1);
        for size in SIZES {
            driver.resize(size);
            driver.model.pane = Pane::Parameters;
            for _ in 0..driver.model.parameters.len() {
                let name = driver.model.parameter().unwrap().field.name;
                let name: String = name.chars().take(8).collect();
                assert!(
                    driver.rows().iter().any(|row| row.contains('›') && row.contains(&name)),
                    "{}",
                    driver.text()
                );
                driver.press("k");
            }
            driver.press("End");
        }
    });
}

#[test]
fn the_animation_plays_to_its_end_and_stops() {
    within(60, || {
        let mut driver = Driver::start(rough());
        assert!(driver.model.player.playing);
        let ends: Vec<f64> = driver.model.legs().iter().map(|leg| leg.end()).collect();
        let (mut last, mut elapsed) = (f64::NEG_INFINITY, 0);
        while driver.model.player.playing {
            assert_eq!(driver.elapse(0.1), [Effect::Show]);
            let d = driver.model.moment.as_ref().unwrap().point.indentation;
            let forwards = if driver.model.player.leg == 0 { d >= last } else { d <= last };
            assert!(forwards || d == ends[0], "{last} to {d}");
            last = d;
            elapsed += 1;
            assert!(elapsed < 1000, "it never ends");
        }
        assert_eq!(driver.model.player.leg, 1);
        assert!((last - ends[1]).abs() < 1e-12, "{last}");
        // And then nothing happens any more.
        let screen = driver.screen();
        for _ in 0..3 {
            assert!(driver.elapse(1.0).is_empty());
        }
        assert_eq!(driver.screen(), screen);
        // Playing again begins at the beginning.
        driver.press("Space");
        assert!(driver.model.player.playing && driver.model.player.leg == 0);
    });
}

#[test]
fn a_scene_that_ends_in_separation_is_shown_separated() {
    within(30, || {
        let mut driver = pressed("");
        while driver.model.player.done < 1.0 {
            driver.press(".");
        }
        let point = driver.model.moment.as_ref().unwrap().point;
        assert_eq!((point.springs, point.force), (0, 0.0), "{}", driver.text());
    });
}

#[test]
fn nothing_is_played_while_there_is_no_curve() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("loading");
        driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
        driver.press("r");
        for _ in 0..3 {
            assert!(driver.elapse(0.1).is_empty(), "that of another scene is not played");
        }
        driver.press("u");
        assert_eq!(driver.elapse(0.1), [Effect::Show]);
    });
}

#[test]
fn the_animation_is_paused_stepped_and_begun_again() {
    within(30, || {
        let mut driver = Driver::start(rough());
        driver.elapse(1.0);
        let before = driver.model.player;
        assert!(before.done > 0.0);
        driver.press("Space");
        assert!(driver.elapse(1.0).is_empty(), "nothing moves while it is paused");
        assert_eq!(driver.model.player.done, before.done);
        let force = |driver: &Driver| driver.model.moment.as_ref().unwrap().point;
        let here = force(&driver);
        driver.press(".");
        assert!(force(&driver).indentation > here.indentation);
        driver.press(",");
        assert!((force(&driver).indentation - here.indentation).abs() < 1e-15);
        driver.press("Space .");
        assert!(!driver.model.player.playing, "a step pauses");
        driver.press("> >");
        assert_eq!((driver.model.player.leg, driver.model.player.done), (1, 0.0));
        driver.press("<");
        assert_eq!((driver.model.player.leg, driver.model.player.done), (0, 0.0));
        driver.press(". . <");
        assert_eq!(
            (driver.model.player.leg, driver.model.player.done),
            (0, 0.0),
            "first to the start of this leg"
        );
        driver.press(",");
        assert_eq!((driver.model.player.leg, driver.model.player.done), (0, 0.0), "there is nothing before");
        driver.press("> . r");
        assert_eq!((driver.model.player.leg, driver.model.player.done), (0, 0.0));
        assert!(driver.model.player.playing);
        // Steps go from leg to leg in both directions.
        driver.press("> ,");
        assert_eq!((driver.model.player.leg, driver.model.player.done), (0, 1.0));
        driver.press(".");
        assert_eq!(driver.model.player.leg, 1);
    });
}

#[test]
fn an_edit_keeps_the_place_of_the_animation() {
    within(30, || {
        let mut driver = pressed("");
        let before = driver.model.player;
        driver.select("roughness.hurst");
        driver.press("l");
        assert_eq!(driver.model.player, before);
        // Unless the leg is gone.
        driver.select("loading");
        driver.enter("[ToForce(2.0e-5)]");
        assert_eq!((driver.model.player.leg, driver.model.player.playing), (0, false));
        assert!(is_up_to_date(&driver.model));
    });
}

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

#[test]
fn every_pane_can_have_the_whole_screen() {
    within(30, || {
        let mut driver = pressed("");
        let all = Layout::of(&driver.model).panes.len();
        assert_eq!(all, 4);
        for _ in 0..4 {
            driver.press("z");
            assert_eq!(Layout::of(&driver.model).panes.len(), 1);
            assert_eq!(Layout::of(&driver.model).panes[0].0, driver.model.pane);
            driver.press("z Tab");
            assert_eq!(Layout::of(&driver.model).panes.len(), 4);
        }
        assert_eq!(driver.model.pane, Pane::Force);
    });
}

#[test]
fn the_chosen_pane_is_marked_by_a_glyph() {
    within(30, || {
        let mut driver = pressed("");
        let mut seen = Vec::new();
        for _ in 0..4 {
            let rows = driver.rows();
            let marked: Vec<_> = rows.iter().filter(|row| row.contains('▸')).collect();
            assert_eq!(marked.len(), 1, "{}", driver.text());
            let title = marked[0].split('▸').nth(1).unwrap().split('─').next().unwrap().to_owned();
            assert!(!seen.contains(&title), "{title}");
            seen.push(title);
            driver.press("Tab");
        }
    });
}

#[test]
fn a_small_window_keeps_the_chosen_pane() {
    within(30, || {
        for size in SIZES {
            let mut driver = pressed("");
            driver.resize(size);
            for _ in 0..4 {
                let layout = Layout::of(&driver.model);
                let shown = layout.pane(driver.model.pane).expect("the chosen pane is shown");
                assert!(shown.width > 0 && shown.height > 0);
                driver.press("Tab");
            }
        }
    });
}

#[test]
fn a_screen_grows_back_to_what_it_was() {
    within(30, || {
        let mut driver = pressed("");
        let before = driver.screen();
        for size in [(40, 12), (20, 5), (1, 1), (0, 0), (300, 100), (120, 40)] {
            driver.resize(size);
            // The moment that fits comes after the first drawing.
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
            // The window grows, and is drawn before the worker has answered.
            driver.model.size = large;
            draw(&driver.model);
            for _ in 0..4 {
                driver.model.pane = Pane::ALL
                    [(Pane::ALL.iter().position(|pane| *pane == driver.model.pane).unwrap() + 1) % 4];
                driver.model.size = small;
                draw(&driver.model);
                driver.model.zoomed = !driver.model.zoomed;
                draw(&driver.model);
            }
        }
    });
}

/// Cells of the pane that has the screen that show anything.
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
            // The scene fails, so that the picture cannot be made anew.
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
                driver.model.size = (120, 40);
                terminal.draw(|frame| asperity::explorer::view::draw(frame, &driver.model)).unwrap();
            }
        }
    });
}

#[test]
fn reports_of_another_scene_change_nothing() {
    within(30, || {
        let mut driver = pressed("");
        let (computed, moment) =
            (driver.model.computed.clone().unwrap(), driver.model.moment.clone().unwrap());
        driver.select("roughness.hurst");
        driver.press("l");
        let screen = driver.screen();
        let generation = computed.generation;
        for action in [
            Action::Computed(computed),
            Action::Shown(moment),
            Action::Progress { generation, legs: 1 },
            Action::Failed { generation, error: "old".to_owned() },
        ] {
            assert!(driver.act(action).is_empty());
            assert_eq!(driver.screen(), screen);
        }
    });
}

#[test]
fn a_scene_that_fails_is_told_and_the_next_edit_mends_it() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("loading");
        driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
        assert!(!driver.model.is_computing());
        let text = driver.text();
        assert!(text.contains("the contact lets go before that force"), "{text}");
        // Its numbers are not those of the scene any more.
        assert!(!text.contains("F_a "), "{text}");
        for keys in ["j", "k", ". .", "Tab", "n", "+"] {
            driver.press(keys);
        }
        assert!(driver.text().contains("the contact lets go before that force"), "{}", driver.text());
        driver.press("u");
        let text = driver.text();
        assert!(text.contains("F_a ") && !text.contains("lets go before"), "{text}");
        assert!(is_up_to_date(&driver.model));
    });
}

/// An engine that panics on the seed 13.
struct Superstitious(Simulation);

impl Engine for Superstitious {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        let unlucky = format!("{:?}", scene.roughness).contains("seed: 13 ");
        assert!(!unlucky, "thirteen");
        self.0.run(scene, stop, after)
    }

    fn line(&self) -> Option<&Line> {
        self.0.line()
    }

    fn tree(&self) -> Option<&Arc<ContactTree>> {
        self.0.tree()
    }
}

#[test]
fn a_panic_of_the_worker_is_a_line_and_the_explorer_goes_on() {
    within(30, || {
        let mut driver = Driver::open_with(rough(), Box::new(Superstitious(Simulation::default())));
        driver.perform(vec![Effect::Compute]);
        driver.select("roughness.seed");
        driver.enter("13");
        assert!(
            driver.text().contains("internal error") && driver.text().contains("thirteen"),
            "{}",
            driver.text()
        );
        for keys in [". ,", "n p f", "z z", "Tab", "Space", "r"] {
            driver.press(keys);
            driver.elapse(0.1);
            driver.screen();
        }
        driver.enter("14");
        assert!(is_up_to_date(&driver.model));
        assert!(driver.text().contains("F_a "), "{}", driver.text());
    });
}

#[test]
fn an_interrupted_run_is_no_failure() {
    assert!(RunError::from(ContactError::Interrupted).is_interruption());
    within(30, || {
        let mut driver = pressed("");
        let of_before = generation(&driver);
        driver.press("l l l");
        assert_eq!(generation(&driver), of_before + 3);
        assert!(driver.model.notice.is_none());
    });
}

#[test]
fn a_saved_scene_is_read_back_as_it_stands() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("roughness.hurst");
        driver.press("l s");
        driver.press("Ctrl+u");
        driver.type_text("folder/mine.ron");
        assert_eq!(
            driver.press("Enter"),
            [Effect::Write { path: "folder/mine.ron".into(), content: Content::Scene, overwrite: false }]
        );
        let text = &driver.files[Path::new("folder/mine.ron")];
        let again = Document::parse(text, "mine.ron").unwrap();
        assert_eq!(again.scene(), driver.model.document.scene());
        assert!(text.contains("// soft"), "the comments are kept");
        assert!(driver.text().contains("saved to folder/mine.ron"), "{}", driver.text());
        assert!(!driver.model.is_unsaved());
        driver.press("q");
        assert!(driver.model.finished, "nothing is left to be asked");
    });
}

#[test]
fn a_file_is_overwritten_only_when_asked() {
    within(30, || {
        let mut driver = pressed("s Enter l s Enter");
        let name = driver.files.keys().next().unwrap().clone();
        assert_eq!(name, Path::new("rough-line.ron"), "it is named after its scene");
        assert_eq!(driver.files[&name], rough().text());
        assert!(driver.text().contains("Overwrite"), "{}", driver.text());
        driver.press("n");
        assert_eq!(driver.files[&name], rough().text());
        assert!(driver.model.is_unsaved());
        driver.press("s Enter y");
        assert_eq!(driver.files[&name], driver.model.document.text());
        assert!(!driver.model.is_unsaved());
    });
}

#[test]
fn what_could_not_be_saved_is_told_and_not_forgotten() {
    within(30, || {
        let mut driver = pressed("l s Ctrl+u");
        driver.type_text(REFUSED);
        driver.press("Enter");
        assert!(driver.text().contains("no room"), "{}", driver.text());
        assert!(driver.model.is_unsaved());
        // It goes with the next key, so that the figures can be read again.
        driver.press("j");
        assert!(!driver.text().contains("no room"), "{}", driver.text());
        assert!(driver.text().contains("F_a "), "{}", driver.text());
    });
}

#[test]
fn an_empty_name_saves_nothing() {
    within(30, || {
        let mut driver = pressed("s Ctrl+u");
        assert!(driver.press("Enter").is_empty() && driver.files.is_empty());
        assert_eq!(driver.model.mode.kind(), ModeKind::SaveAs);
        driver.press("Esc");
        assert_eq!(driver.model.mode, Mode::Explore);
    });
}

#[test]
fn an_unchanged_scene_is_left_without_a_question() {
    for key in ["q", "Ctrl+c"] {
        within(30, move || {
            let mut driver = Driver::start(rough());
            driver.press(key);
            assert!(driver.model.finished);
        });
    }
}

#[test]
fn a_changed_scene_asks_before_it_is_left() {
    within(30, || {
        let asked = |keys: &str| {
            let mut driver = pressed("l q");
            assert_eq!(driver.model.mode, Mode::Quit);
            assert!(!driver.model.finished);
            assert!(driver.text().contains("unsaved"), "{}", driver.text());
            assert!(driver.rows()[0].contains("changed"), "{}", driver.text());
            driver.press(keys);
            driver
        };
        for keys in ["n", "Esc"] {
            let driver = asked(keys);
            assert!(!driver.model.finished && driver.model.mode == Mode::Explore, "{keys}");
        }
        for keys in ["q", "y", "Ctrl+c"] {
            let driver = asked(keys);
            assert!(driver.model.finished && driver.files.is_empty(), "{keys}");
        }
        let driver = asked("s Enter");
        assert!(driver.model.finished);
        assert_eq!(driver.files.len(), 1);
        // Whoever turns back from saving does not leave.
        for keys in ["s Esc", "s Ctrl+u Enter Esc"] {
            assert!(!asked(keys).model.finished, "{keys}");
        }
        let mut driver = asked("n");
        driver.files.insert("rough-line.ron".into(), "theirs".to_owned());
        driver.press("q s Enter");
        assert!(!driver.model.finished, "first it is asked about the file");
        driver.press("y");
        assert!(driver.model.finished);
        assert_ne!(driver.files[Path::new("rough-line.ron")], "theirs");
    });
}

#[test]
fn taking_back_all_edits_leaves_nothing_to_save() {
    within(30, || {
        let mut driver = pressed("l l u u q");
        assert!(driver.model.finished);
        driver = pressed("l l u q");
        assert!(!driver.model.finished);
    });
}

#[test]
fn wide_and_combining_characters_are_drawn_in_windows_of_any_width() {
    within(60, || {
        // A mark without a letter to stand on, and words that no window is as wide as.
        let odd = "\u{301}e wörter 漢字 e\u{301}\u{301} a漢字b ".repeat(6) + &"漢".repeat(60);
        let quoted = format!("\"{odd}\"");
        let document = changed(&rough(), &[("title", &quoted), ("notice", &quoted)]);
        let mut driver = mid_retraction(document);
        driver.press("Tab Tab");
        for columns in (1..20).chain([33, 60, 79, 80, 119, 120]) {
            driver.resize((columns, 40));
            driver.press("e Ctrl+u");
            driver.type_text(&odd);
            driver.screen();
            // What is wrong with it is told with the value itself.
            driver.press("Enter");
            assert!(driver.model.refused.is_some());
            driver.screen();
        }
    });
}
