//! Tests of the colours: contrast, distances for colour-blind eyes, and the nearest of 256 colours.

use super::*;
use crate::colour::{lab_of_light, light};
use std::collections::BTreeMap;

const DARK_GROUNDS: [Rgb; 4] = [[0; 3], [0x10, 0x13, 0x1a], [0x1e; 3], [0, 0x2b, 0x36]];
const LIGHT_GROUNDS: [Rgb; 2] = [[255; 3], [0xfd, 0xf6, 0xe3]];
const INKS: [ColourRole; 8] = [
    ColourRole::Text,
    ColourRole::Quiet,
    ColourRole::Press,
    ColourRole::Pull,
    ColourRole::Zero,
    ColourRole::Accent,
    ColourRole::Key,
    ColourRole::Error,
];
const GROUNDS: [ColourRole; 4] = [
    ColourRole::LoopGround,
    ColourRole::BodyGround,
    ColourRole::SelectionGround,
    ColourRole::QuartileGround,
];

const UNKNOWN: Palette = Palette {
    colours: Colours::TrueColour,
    background: Background::Unknown,
};

/// Contrast of two colours, from 1 to 21 (WCAG 2.1).
fn contrast(one: Rgb, other: Rgb) -> f64 {
    let luminance = |colour: Rgb| {
        let [red, green, blue] = colour.map(light);
        0.2126 * red + 0.7152 * green + 0.0722 * blue + 0.05
    };
    let (one, other) = (luminance(one), luminance(other));
    one.max(other) / one.min(other)
}

/// Least contrast of a colour on some grounds.
fn least_contrast(colour: Rgb, grounds: &[Rgb]) -> f64 {
    let contrasts = grounds.iter().map(|ground| contrast(colour, *ground));
    contrasts.fold(f64::INFINITY, f64::min)
}

/// Grounds that a terminal of this palette may have.
fn grounds(palette: Palette) -> Vec<Rgb> {
    match palette.background {
        Background::Dark => DARK_GROUNDS.to_vec(),
        Background::Light => LIGHT_GROUNDS.to_vec(),
        Background::Unknown => [&DARK_GROUNDS[..], &LIGHT_GROUNDS].concat(),
    }
}

#[test]
fn every_role_can_be_read_on_its_grounds() {
    for (palette, least) in [
        (Palette::DARK, [11.5, 4.2, 7.4, 6.0, 9.8, 7.4, 10.4, 5.4]),
        (Palette::LIGHT, [14.4, 4.6, 5.0, 5.8, 9.0, 5.2, 5.4, 5.8]),
    ] {
        for (role, least) in INKS.into_iter().zip(least) {
            let found = least_contrast(palette.rgb(role), &grounds(palette));
            assert!(found >= least, "{palette:?} {role:?} {found}");
        }
    }
    for role in [
        ColourRole::Quiet,
        ColourRole::Press,
        ColourRole::Pull,
        ColourRole::Accent,
        ColourRole::Error,
    ] {
        let found = least_contrast(UNKNOWN.rgb(role), &grounds(UNKNOWN));
        assert!(found >= 3.4, "{role:?} {found}");
    }
}

#[test]
fn texts_and_curves_can_be_read_on_coloured_grounds() {
    let ground = Palette::DARK.rgb(ColourRole::LoopGround);
    for (role, least) in [
        (ColourRole::Text, 10.0),
        (ColourRole::Press, 6.4),
        (ColourRole::Pull, 5.2),
        (ColourRole::Quiet, 3.7),
    ] {
        let found = contrast(Palette::DARK.rgb(role), ground);
        assert!(found >= least, "{role:?} {found}");
    }
    let light_grounds = GROUNDS.map(|role| Palette::LIGHT.rgb(role));
    for role in [ColourRole::Text, ColourRole::Press, ColourRole::Pull] {
        let found = least_contrast(Palette::LIGHT.rgb(role), &light_grounds);
        assert!(found >= 3.95, "{role:?} {found}");
    }
}

/// Colour as people with a kind of complete colour blindness see it.
type Vision = [[f64; 3]; 3];

/// Normal vision, and then the three matrices of complete colour blindness of Machado, Oliveira
/// and Fernandes (2009), which apply to the emitted light: protanopia, deuteranopia and
/// tritanopia.
const VISIONS: [Vision; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
];

fn seen(colour: Rgb, vision: Vision) -> Lab {
    let emitted = colour.map(light);
    lab_of_light(vision.map(|row| {
        let channels = row.iter().zip(emitted);
        let share: f64 = channels.map(|(factor, light)| factor * light).sum();
        share.clamp(0.0, 1.0)
    }))
}

#[test]
fn pressed_pulled_and_free_differ_for_every_eye() {
    for (palette, roles, least) in [
        (
            Palette::DARK,
            [ColourRole::Press, ColourRole::Pull],
            [114.0, 108.0, 117.0, 82.0],
        ),
        (
            Palette::LIGHT,
            [ColourRole::Press, ColourRole::Pull],
            [114.0, 104.0, 117.0, 79.0],
        ),
        (
            Palette::DARK,
            [ColourRole::Press, ColourRole::Zero],
            [70.0, 67.0, 67.0, 48.0],
        ),
        (
            Palette::DARK,
            [ColourRole::Pull, ColourRole::Zero],
            [49.0, 43.0, 52.0, 38.0],
        ),
        (
            Palette::LIGHT,
            [ColourRole::Press, ColourRole::Zero],
            [53.8, 53.8, 53.8, 28.8],
        ),
        (
            Palette::LIGHT,
            [ColourRole::Pull, ColourRole::Zero],
            [53.8, 53.8, 53.8, 28.8],
        ),
    ] {
        for (vision, least) in VISIONS.into_iter().zip(least) {
            let [one, other] = roles.map(|role| seen(palette.rgb(role), vision));
            let found = difference(one, other);
            assert!(found >= least, "{palette:?} {roles:?} {found} {least}");
        }
    }
}

/// Largest difference between a colour and the nearest of the 256 fixed colours.
const INK_ERROR: f64 = 13.0;
const GROUND_ERROR: f64 = 18.1;

#[test]
fn each_number_is_that_of_the_nearest_fixed_colour() {
    for palette in [Palette::DARK, Palette::LIGHT, UNKNOWN] {
        for role in INKS.into_iter().chain(GROUNDS) {
            let Some(Swatch { rgb, index, .. }) = palette.swatch(role) else {
                continue;
            };
            assert_eq!(index, nearest_index(rgb), "{palette:?} {role:?}");
            let error = difference(lab(fixed_colour(index)), lab(rgb));
            let most = if GROUNDS.contains(&role) {
                GROUND_ERROR
            } else {
                INK_ERROR
            };
            assert!(error <= most, "{palette:?} {role:?} {error}");
        }
        let StressIndices { press, pull } = palette.stress_indices();
        for (role, indices) in [(ColourRole::Press, press), (ColourRole::Pull, pull)] {
            for (step, index) in (1..).zip(indices) {
                let rgb = palette.stress_rgb(role, step);
                assert_eq!(index, nearest_index(rgb), "{palette:?} {role:?} {step}");
            }
        }
    }
}

/// On a light background a larger stress is darker, so that a spring without stress is the palest.
#[test]
fn contrast_grows_with_the_stress_on_a_light_background() {
    let grounds = grounds(Palette::LIGHT);
    for role in [ColourRole::Press, ColourRole::Pull] {
        let steps = (1..=STRESS_STEPS).map(|step| Palette::LIGHT.stress_rgb(role, step));
        let contrasts: Vec<f64> = steps.map(|rgb| least_contrast(rgb, &grounds)).collect();
        assert!(contrasts.is_sorted(), "{role:?} {contrasts:?}");
        assert!(contrasts[0] >= 2.0, "{role:?} {contrasts:?}");
    }
}

#[test]
fn stress_has_four_steps_on_each_side() {
    let steps = [0.0, 0.1, 0.2, 0.4, 0.7, 1.0, 5.0].map(stress_step);
    assert_eq!(steps, [1, 1, 2, 3, 4, 4, 4]);
    let palette = Palette::DARK;
    assert_eq!(palette.stress(1.0), palette.colour(ColourRole::Press));
    assert_eq!(palette.stress(-1.0), palette.colour(ColourRole::Pull));
    assert_ne!(palette.stress(0.1), palette.stress(-0.1));
    // Sixteen colours still show the sign of a small stress.
    let sixteen = Palette {
        colours: Colours::Ansi16,
        ..palette
    };
    assert_eq!(sixteen.stress(0.1), Color::LightYellow);
    assert_eq!(Palette::PLAIN.stress(0.1), Color::Reset);
}

#[test]
fn the_terminal_states_its_colours() {
    for (variables, colours) in [
        ("TERM=xterm-256color", Colours::Ansi256),
        ("TERM=screen", Colours::Ansi256),
        ("", Colours::Ansi256),
        ("TERM=linux", Colours::Ansi16),
        ("TERM=vt220", Colours::Ansi16),
        ("TERM=ansi", Colours::Ansi16),
        ("TERM=vte-256color", Colours::Ansi256),
        ("TERM=linux COLORTERM=truecolor", Colours::TrueColour),
        ("TERM=xterm COLORTERM=24bit", Colours::TrueColour),
        ("TERM=xterm COLORTERM=yes", Colours::Ansi256),
        ("TERM=xterm COLORTERM=truecolor NO_COLOR=1", Colours::Plain),
        ("TERM=xterm NO_COLOR=", Colours::Ansi256),
        ("TERM=dumb COLORTERM=truecolor", Colours::Plain),
    ] {
        let values: BTreeMap<&str, &str> = variables
            .split_whitespace()
            .filter_map(|variable| variable.split_once('='))
            .collect();
        let value = |name: &str| values.get(name).map(|value| (*value).to_owned());
        assert_eq!(Colours::of_environment(value), colours, "{variables}");
    }
}
