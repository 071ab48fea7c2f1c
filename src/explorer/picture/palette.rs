//! Colours of the terminal as red, green and blue.

use ratatui::style::Color;

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// What the colours that a terminal chooses look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Of text without a colour of its own.
    pub foreground: Rgb,
    /// Behind all.
    pub background: Rgb,
    /// The sixteen colours in the order of ANSI: black, red, green, yellow, blue, magenta, cyan, gray,
    /// and the same again bright.
    pub ansi: [Rgb; 16],
}

impl Palette {
    /// Light on dark. Red, green, blue and magenta stay apart, in brightness too, for those who see two
    /// primary colours.
    pub const DARK: Palette = Palette {
        foreground: [0xe1, 0xe6, 0xeb],
        background: [0x10, 0x15, 0x1b],
        ansi: [
            [0x10, 0x15, 0x1b],
            [0xff, 0x6b, 0x3d],
            [0x1a, 0xb4, 0x85],
            [0xf0, 0xd6, 0x55],
            [0x3b, 0x94, 0xf5],
            [0xee, 0x97, 0xdd],
            [0x5f, 0xd0, 0xe6],
            [0xc4, 0xcb, 0xd2],
            [0x85, 0x8f, 0x9a],
            [0xff, 0x93, 0x70],
            [0x52, 0xd6, 0xac],
            [0xf7, 0xe4, 0x86],
            [0x7a, 0xb8, 0xff],
            [0xf5, 0xc4, 0xea],
            [0x96, 0xe4, 0xf2],
            [0xff, 0xff, 0xff],
        ],
    };

    /// Dark on light, as in [`Palette::DARK`].
    pub const LIGHT: Palette = Palette {
        foreground: [0x1b, 0x20, 0x26],
        background: [0xff, 0xff, 0xff],
        ansi: [
            [0x1b, 0x20, 0x26],
            [0xcc, 0x3f, 0x00],
            [0x00, 0x80, 0x5e],
            [0x7d, 0x63, 0x00],
            [0x00, 0x5c, 0xc2],
            [0x8e, 0x2a, 0x7c],
            [0x00, 0x70, 0x88],
            [0x52, 0x5c, 0x66],
            [0x6a, 0x74, 0x7e],
            [0xb3, 0x38, 0x00],
            [0x00, 0x6b, 0x4f],
            [0x69, 0x53, 0x00],
            [0x00, 0x4b, 0x9e],
            [0x75, 0x1f, 0x66],
            [0x00, 0x5c, 0x70],
            [0xff, 0xff, 0xff],
        ],
    };

    /// A colour; `reset` where the terminal chooses.
    pub(super) fn rgb(&self, colour: Color, reset: Rgb) -> Rgb {
        let ansi = match colour {
            Color::Reset => return reset,
            Color::Rgb(red, green, blue) => return [red, green, blue],
            Color::Indexed(index) => return self.indexed(index),
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
        self.ansi[ansi]
    }

    /// One of the 256 colours of xterm: the sixteen, a cube of six steps each way, and 24 grays.
    fn indexed(&self, index: u8) -> Rgb {
        /// Levels of the cube's steps.
        const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];
        match index {
            0..16 => self.ansi[usize::from(index)],
            16..232 => {
                let place = usize::from(index - 16);
                [STEPS[place / 36], STEPS[place / 6 % 6], STEPS[place % 6]]
            }
            232.. => [8 + 10 * (index - 232); 3],
        }
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

/// A colour as documents for the web write it.
pub(super) fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
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

    /// What eyes see: with three kinds of cones, without the long-wave ones, without the middle-wave ones.
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
        let rgb = |index| Palette::DARK.rgb(Color::Indexed(index), [1, 2, 3]);
        assert_eq!(rgb(5), Palette::DARK.rgb(Color::Magenta, [0; 3]));
        assert_eq!([rgb(16), rgb(196), rgb(46), rgb(21)], [[0; 3], [255, 0, 0], [0, 255, 0], [0, 0, 255]]);
        assert_eq!([rgb(67), rgb(231)], [[95, 135, 175], [255; 3]]);
        assert_eq!([rgb(232), rgb(255)], [[8; 3], [238; 3]]);
        assert_eq!(Palette::DARK.rgb(Color::Reset, [1, 2, 3]), [1, 2, 3]);
        assert_eq!(Palette::DARK.rgb(Color::Rgb(4, 5, 6), [1, 2, 3]), [4, 5, 6]);
        assert_eq!(Palette::LIGHT.rgb(Color::White, [0; 3]), Palette::LIGHT.ansi[15]);
    }

    #[test]
    fn mixtures_lie_between() {
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 100), [255, 0, 100]);
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 0), [0, 255, 200]);
        assert_eq!(mixed([255, 0, 100], [0, 255, 200], 25), [63, 191, 175]);
    }
}
