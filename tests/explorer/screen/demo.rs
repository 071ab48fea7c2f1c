//! The demo: always the same frames, in any window, and no more bytes than a slow line carries.

use super::common::driver::APPEARANCE;
use asperity::explorer::demo::Demo;
use asperity::explorer::demo::script::TOUR;
use asperity::explorer::picture;
use asperity::explorer::writing::picture_of;
use asperity::scene::{Document, open, presets};

/// Columns and rows of the large window, and frames in a second, for which the bytes are counted.
const LARGE: (u16, u16) = (120, 40);

fn first() -> Document {
    open(presets()[0].name).unwrap()
}

/// A hash of text, the same everywhere (FNV-1a).
fn hash(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Time and hash of each frame of the tour.
fn frames(size: (u16, u16), frames_per_second: f64) -> Vec<(f64, u64)> {
    let mut demo = Demo::new(first(), TOUR, size, APPEARANCE, frames_per_second);
    std::iter::from_fn(|| {
        let seconds = demo.advance()?;
        Some((seconds, hash(&picture::text(&picture_of(demo.app())))))
    })
    .collect()
}

#[test]
fn the_tour_is_the_same_every_time() {
    let seen = frames(LARGE, 2.0);
    assert_eq!(frames(LARGE, 2.0), seen);
    assert!(seen.len() > 150, "{} frames", seen.len());
    for (number, (seconds, _)) in seen.iter().enumerate() {
        assert!((seconds - number as f64 / 2.0).abs() < 1e-6, "frame {number} at {seconds} s");
    }
    let changes = seen.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
    assert!(10 * changes > 8 * seen.len(), "{changes} of {} frames show something new", seen.len());
}

#[test]
fn the_tour_shows_what_it_is_to_show() {
    let mut demo = Demo::new(first(), TOUR, LARGE, APPEARANCE, 2.0);
    let (mut scenes, mut seen) = (Vec::new(), [false; 5]);
    while demo.advance().is_some() {
        let app = demo.app();
        let name = app.edit.document.name().to_owned();
        if !scenes.contains(&name) {
            scenes.push(name);
        }
        let shown = [
            app.manual.as_ref().is_some_and(|manual| manual.path.len() > 100),
            !app.ghosts.is_empty(),
            app.view.curve.loss,
            app.is_typing_value(),
            app.edit.is_unsaved() && app.edit.document.scene().roughness.is_none(),
        ];
        seen.iter_mut().zip(shown).for_each(|(seen, shown)| *seen |= shown);
        assert!(!app.is_refused() && !app.is_computing(), "{:?}", app.message);
    }
    assert_eq!(seen, [true; 5]);
    let expected = [0, 1, 2, 5, 8].map(|index| presets()[index].name);
    assert_eq!(scenes, expected);
}
