//! Colours of the terminal as red, green and blue.

use crate::draw::{Palette, Rgb};
use ratatui::style::Color;

/// A colour of a palette; `reset` where the terminal chooses.
pub(super) fn rgb(palette: &Palette, colour: Color, reset: Rgb) -> Rgb {
    let ansi = match colour {
        Color::Reset => return reset,
        Color::Rgb(red, green, blue) => return [red, green, blue],
        Color::Indexed(index) => return indexed(palette, index),
        Color::Black => 0,
        Color::Red => 1,
        Color::Green => 2,
        Color::Yellow => 3,
        Color::Blue => 4,
        Color::Magenta => 5,
        Color::Cyan => 6,
        Color::Gray => 7,
        Color::DarkGray => 8,
        Color::LightRed => 9,
        Color::LightGreen => 10,
        Color::LightYellow => 11,
        Color::LightBlue => 12,
        Color::LightMagenta => 13,
        Color::LightCyan => 14,
        Color::White => 15,
    };
    palette.ansi[ansi]
}

/// One of the 256 colours of xterm: the sixteen, a cube of six steps each way, and 24 grays.
fn indexed(palette: &Palette, index: u8) -> Rgb {
    /// Levels of the cube's steps.
    const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    match index {
        0..16 => palette.ansi[usize::from(index)],
        16..232 => {
            let place = usize::from(index - 16);
            [STEPS[place / 36], STEPS[place / 6 % 6], STEPS[place % 6]]
        }
        232.. => [8 + 10 * (index - 232); 3],
    }
}

/// A colour between two others: a share in percent of the first.
pub(super) fn mixed(one: Rgb, other: Rgb, percent: u8) -> Rgb {
    std::array::from_fn(|channel| {
        let parts = u32::from(one[channel]) * u32::from(percent)
            + u32::from(other[channel]) * u32::from(100 - percent.min(100));
        // At most 255, as both are.
        (parts / 100) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    type Light = [f64; 3];

    fn light(colour: Rgb) -> Light {
        colour.map(|channel| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        })
    }

    fn dot(row: Light, light: Light) -> f64 {
        row.iter().zip(light).map(|(one, other)| one * other).sum()
    }

    /// Contrast ratio of WCAG 2.
    fn contrast(one: Rgb, other: Rgb) -> f64 {
        let [one, other] = [one, other].map(|colour| dot([0.2126, 0.7152, 0.0722], light(colour)) + 0.05);
        one.max(other) / one.min(other)
    }

    /// Colours as seen with three kinds of cones, without the long-wave ones, without the middle-wave ones.
    /// Viénot, Brettel and Mollon, Color Res. Appl. 24, 243 (1999).
    const EYES: [[Light; 3]; 3] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]],
        [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]],
    ];

    /// CIE L*a*b*.
    fn lab(light: Light) -> Light {
        let bend = |value: f64| {
            let value = value.max(0.0);
            if value > 0.008_856 { value.cbrt() } else { 7.787 * value + 16.0 / 116.0 }
        };
        let x = bend(dot([0.4124, 0.3576, 0.1805], light) / 0.9505);
        let y = bend(dot([0.2126, 0.7152, 0.0722], light));
        let z = bend(dot([0.0193, 0.1192, 0.9505], light) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn difference(eye: [Light; 3], one: Rgb, other: Rgb) -> f64 {
        let [one, other] = [one, other].map(|colour| lab(eye.map(|row| dot(row, light(colour)))));
        one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
    }

    const PALETTES: [(&str, Palette); 2] = [("dark", Palette::DARK), ("light", Palette::LIGHT)];

    #[test]
    fn colours_can_be_read() {
        for (name, palette) in PALETTES {
            assert!(contrast(palette.foreground, palette.background) > 12.0, "{name}");
            // Black and white may be those of the ground.
            for (number, colour) in
                palette.ansi.into_iter().enumerate().filter(|(number, _)| number % 15 != 0)
            {
                let contrast = contrast(colour, palette.background);
                assert!(contrast > 4.5, "{name} {number} {contrast:.1}");
            }
        }
    }

    #[test]
    fn colours_of_curves_stay_apart_for_all_eyes() {
        for (name, palette) in PALETTES {
            let curves = [1, 2, 4, 5].map(|number| palette.ansi[number]);
            let mut all = curves.to_vec();
            all.push(palette.foreground);
            for (place, &one) in all.iter().enumerate() {
                for &other in &all[..place] {
                    let differences = EYES.map(|eye| difference(eye, one, other));
                    let apart = differences.iter().all(|difference| *difference > 20.0);
                    assert!(apart, "{name} {one:02x?} {other:02x?} {differences:.0?}");
                }
            }
        }
    }

    #[test]
    fn indices_are_those_of_xterm() {
        let rgb = |index| super::rgb(&Palette::DARK, Color::Indexed(index), [1, 2, 3]);
        assert_eq!(rgb(5), super::rgb(&Palette::DARK, Color::Magenta, [0; 3]));
        assert_eq!([rgb(16), rgb(196), rgb(46), rgb(21)], [[0; 3], [255, 0, 0], [0, 255, 0], [0, 0, 255]]);
        assert_eq!([rgb(67), rgb(231)], [[95, 135, 175], [255; 3]]);
        assert_eq!([rgb(232), rgb(255)], [[8; 3], [238; 3]]);
        assert_eq!(super::rgb(&Palette::DARK, Color::Reset, [1, 2, 3]), [1, 2, 3]);
        assert_eq!(super::rgb(&Palette::DARK, Color::Rgb(4, 5, 6), [1, 2, 3]), [4, 5, 6]);
        assert_eq!(super::rgb(&Palette::LIGHT, Color::White, [0; 3]), Palette::LIGHT.ansi[15]);
    }

    #[test]
    fn mixtures_lie_between() {
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 100), [255, 0, 100]);
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 0), [0, 255, 200]);
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 25), [63, 191, 175]);
    }
}
