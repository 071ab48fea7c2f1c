//! Pictures of the whole screen in windows of all sizes, for review.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{one_spring, punch, rough, smooth, without_adhesion};
use super::{SIZES, default_scene, keep, mid_retraction, pressed};
use asperity::contact::ContactError;
use asperity::explorer::picture;
use asperity::explorer::theme::{Marker, Theme};
use clap::ValueEnum;

/// The screen in all windows, one below the other. The text is the same in all colours and without any.
fn screens(driver: &mut Driver) -> String {
    let mut all = String::new();
    for size in SIZES {
        driver.resize(size);
        let text = picture::text(&driver.screen());
        for theme in Theme::value_variants() {
            driver.app.view.appearance.theme = *theme;
            assert_eq!(picture::text(&driver.screen()), text, "{size:?} {theme:?}");
        }
        driver.app.view.appearance.theme = Theme::Neutral;
        let (columns, rows) = size;
        all += &format!("── {columns} × {rows} ──\n{text}");
    }
    all
}

macro_rules! screens {
    ($name:ident, $driver:expr) => {
        #[test]
        fn $name() {
            within(30, || {
                let mut driver = $driver;
                keep(stringify!($name), &screens(&mut driver));
            });
        }
    };
}

screens!(
    screen_before_the_first_result,
    Driver::open_with(default_scene(), |_, _, _, _| Err(ContactError::Interrupted.into()), |_| false)
);
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
screens!(screen_of_the_crosshair, pressed("* Left"));
screens!(screen_of_two_scenes, pressed("& L"));
screens!(screen_of_a_scene_that_failed, {
    let mut driver = mid_retraction(rough());
    driver.select("loading");
    driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
    driver
});
screens!(screen_of_manual_loading, pressed("d [ [ [ { { { } [ ]"));
screens!(screen_of_ghosts, {
    let mut driver = pressed("c L L c");
    driver.select("adhesion.kappa");
    driver.press("c L L");
    driver
});
screens!(screen_of_ghosts_over_the_curve, {
    let mut driver = pressed("c L L c z");
    driver.press("h");
    driver
});
screens!(screen_of_the_loss, pressed("a z"));
screens!(screen_of_the_normalised_force, pressed("N z"));
screens!(screen_of_the_contact_length, pressed("v z"));
screens!(screen_of_the_number_of_fragments, pressed("v v z"));
screens!(screen_of_a_part_of_the_profile, pressed("Tab + + ) z"));
screens!(screen_of_the_spectrum, pressed("Q"));
screens!(screen_of_the_fragment_lengths, pressed("D Tab Tab Tab z"));
screens!(screen_of_the_library, pressed("o"));
screens!(screen_of_a_search, {
    let mut driver = pressed("o");
    driver.type_text("sphere");
    driver.press("Down");
    driver
});
screens!(screen_of_the_export_prompt, pressed("E"));
screens!(screen_of_the_force_prompt, {
    let mut driver = pressed("F");
    driver.type_text("-2 µN");
    driver
});
screens!(screen_of_a_copied_command, pressed("l y"));
screens!(screen_in_octants, marked(Marker::Octant));
screens!(screen_in_half_blocks, marked(Marker::HalfBlock));
screens!(screen_in_ascii, marked(Marker::Ascii));

/// The screen with other markers, a ghost in it and manual loading.
fn marked(marker: Marker) -> Driver {
    let mut driver = pressed("c L L d { ] ] ]");
    while driver.app.view.appearance.marker != marker {
        driver.press("M");
    }
    driver.press("j");
    driver
}
