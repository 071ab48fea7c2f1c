//! Golden screens, for review: the main screen in three windows, and the panes on a whole screen
//! whose text no other test reads. The curves are those of a smooth sphere.

use super::*;
use asperity_plot::screen_text as text;

#[test]
fn the_main_screen() {
    let mut driver = mid_retraction(smooth());
    let mut screens = String::new();
    for size in [SIZES[0], SIZES[1], SIZES[3]] {
        driver.resize(size);
        screens += &format!("── {} × {} ──\n{}", size.0, size.1, text(&driver.screen()));
    }
    insta::assert_snapshot!("the_main_screen", screens);
}

#[test]
fn each_pane() {
    let mut screens = String::new();
    let with = |mut driver: Driver, keys: &str| {
        driver.resize((64, 16));
        driver.press(keys);
        driver
    };
    let sphere = |keys: &str| with(mid_retraction(smooth()), keys);
    for driver in [
        sphere("c z"),
        sphere("Tab Tab Tab z"),
        with(computed_sensitivity(rough()), "z"),
        with(trust::measured(rough()), "z"),
    ] {
        let pane = driver.app.view.pane;
        screens += &format!("── {pane:?} ──\n{}", text(&driver.screen()));
    }
    insta::assert_snapshot!("each_pane", screens);
}
