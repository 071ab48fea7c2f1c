//! The part of the line in the profile pane, and the quantities of the curve.

use super::*;
use asperity::explorer::theme::Theme;
use asperity_plot::Colours;
use ratatui::style::Color;

#[test]
fn the_profile_is_looked_at_from_near_and_moved_along() {
    let mut driver = pressed("Tab Tab");
    driver.shows("Profile z (nm)");
    for (keys, first, springs) in [
        ("", 0, 1024),
        // There is nothing beside the whole line.
        (") (", 0, 1024),
        ("+", 256, 512),
        (")", 384, 512),
        ("( (", 128, 512),
        ("( ( ( (", 0, 512),
        (") ) ) ) ) ) ) )", 512, 512),
        ("+ -", 512, 512),
        ("- + -", 0, 1024),
    ] {
        driver.press(keys);
        let section = &driver.snapshot().profile;
        assert_eq!((section.first, section.springs), (first, springs), "{keys}");
    }
    driver.sees("+", "Profile, 50 µm of 100 µm, z (nm)");
    driver.press(&"+ ".repeat(20));
    assert_eq!(driver.snapshot().profile.springs, 8);
}

/// The text of the pane of the curve on the whole screen.
fn curve(driver: &mut Driver) -> String {
    driver.press("z");
    let text = driver.text();
    driver.press("z");
    text
}

#[test]
fn the_curve_has_three_views_in_two_units() {
    let mut driver = pressed("");
    for [title, x, y] in [
        ["Force F (µN)", "d (nm)", "F (µN)"],
        ["Force F/F_a,max", "d/h", "F/F_a,max"],
        ["Contact length l (µm)", "F (µN)", "l (µm)"],
        ["Contact length l/L", "F/F_a,max", "l/L"],
        ["Contact patches n", "d (nm)", "n"],
        ["Contact patches n", "d/h", "n"],
    ] {
        let text = curve(&mut driver);
        assert!(
            [title, x, y].iter().all(|words| text.contains(words)),
            "{title}, {x}, {y}\n{text}"
        );
        driver.press("N");
        if !driver.app.view.curve.normalised {
            driver.press("v");
        }
    }
    assert!(
        curve(&mut driver).contains("Force F (µN)"),
        "they come round"
    );
    // Without adhesion there is no F_a,max as a unit.
    let mut driver = mid_retraction(without_adhesion());
    driver.press("N");
    let text = curve(&mut driver);
    assert!(text.contains("d/h") && !text.contains("F_a,max"), "{text}");
}

/// The background of the cells of the force pane that lie inside the loop.
fn grounds(driver: &mut Driver) -> usize {
    let screen = driver.screen();
    let cells = screen.content.iter();
    cells
        .filter(|cell| cell.bg == Color::Rgb(38, 48, 72))
        .count()
}

#[test]
fn the_dissipated_energy_is_the_ground_of_the_loop_and_stated_in_it() {
    let mut driver = mid_retraction(smooth());
    driver.app.view.appearance.theme = Theme::Dark;
    driver.app.view.appearance.colours = Colours::TrueColour;
    driver.press("z");
    let energy = driver.outcome().figures.dissipated_energy.unwrap();
    let energy: f64 = format!("{energy:.2e}").parse().unwrap();
    let text = format!("ΔW {}", format_quantity(energy, "J"));
    assert!(driver.text().contains(&text), "{text}\n{}", driver.text());
    assert!(grounds(&mut driver) > 60);
    // A loop that is not closed has no dissipated energy yet.
    let mut driver = Driver::start(rough().set("loading", "[ToForce(1.0e-5)]").unwrap());
    driver.app.view.appearance.theme = Theme::Dark;
    driver.app.view.appearance.colours = Colours::TrueColour;
    assert_eq!(grounds(&mut driver), 0);
}
