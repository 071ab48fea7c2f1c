//! The demo: always the same frames, in any window, and no more bytes than a slow line carries.

use super::*;
use asperity::explorer::demo::Demo;
use asperity::explorer::demo::script::TOUR;

/// Columns and rows of the large window, and frames in a second, for which the bytes are counted.
const LARGE: (u16, u16) = (120, 40);

fn first() -> Document {
    open(presets()[0].name).unwrap()
}

#[test]
fn the_tour_shows_what_it_is_to_show() {
    let mut demo = Demo::new(first(), TOUR, LARGE, APPEARANCE, 2.0);
    let (mut scenes, mut seen) = (Vec::new(), [false; 4]);
    while demo.advance().is_some() {
        let app = demo.app();
        let name = app.edit.document.name().to_owned();
        if !scenes.contains(&name) {
            scenes.push(name);
        }
        let shown = [
            app.followed()
                .is_some_and(|followed| followed.moves().len() == 4),
            !app.ghosts.is_empty(),
            app.is_typing_value(),
            app.edit.is_unsaved() && app.edit.document.scene().roughness.is_none(),
        ];
        seen.iter_mut()
            .zip(shown)
            .for_each(|(seen, shown)| *seen |= shown);
        assert!(
            !app.is_refused() && !app.is_computing(),
            "{:?}",
            app.message
        );
    }
    assert_eq!(seen, [true; 4]);
    assert_eq!(
        scenes,
        [
            "ideal-adhesion",
            "pressure-sensitive",
            "non-adhesive",
            "patch-closeup",
            "rough-sphere",
        ]
    );
}
