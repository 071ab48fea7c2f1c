//! Colours of figures and of screens that are saved as pictures.

/// Colour as red, green and blue, each from 0 to 255.
pub type Rgb = [u8; 3];

/// Converts numbers such as `0x440154` to colours.
const fn rgb<const N: usize>(colours: [u32; N]) -> [Rgb; N] {
    let mut found = [[0; 3]; N];
    let mut index = 0;
    while index < N {
        let [_, red, green, blue] = colours[index].to_be_bytes();
        found[index] = [red, green, blue];
        index += 1;
    }
    found
}

/// Colours of a figure, or of a screenshot that [`screen_svg`](crate::screen_svg) draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Colour of text and frames.
    pub foreground: Rgb,
    /// Colour of the paper or the screen.
    pub background: Rgb,
    /// The sixteen ANSI colours of a terminal: black, red, green, yellow, blue, magenta, cyan,
    /// grey, then the bright variant of each.
    pub ansi: [Rgb; 16],
}

impl Palette {
    /// Light colours on a dark background, which people with red-green colour blindness can
    /// distinguish.
    pub const DARK: Palette = Palette {
        foreground: [0xe1, 0xe6, 0xeb],
        background: [0x10, 0x15, 0x1b],
        ansi: rgb([
            0x10151b, 0xff6b3d, 0x1ab485, 0xf0d655, 0x3b94f5, 0xee97dd, 0x5fd0e6, 0xc4cbd2,
            0x858f9a, 0xff9370, 0x52d6ac, 0xf7e486, 0x7ab8ff, 0xf5c4ea, 0x96e4f2, 0xffffff,
        ]),
    };

    /// Dark colours on a white background, which people with red-green colour blindness can
    /// distinguish.
    pub const LIGHT: Palette = Palette {
        foreground: [0x1b, 0x20, 0x26],
        background: [0xff, 0xff, 0xff],
        ansi: rgb([
            0x1b2026, 0xcc3f00, 0x00805e, 0x7d6300, 0x005cc2, 0x8e2a7c, 0x007088, 0x525c66,
            0x6a747e, 0xb33800, 0x006b4f, 0x695300, 0x004b9e, 0x751f66, 0x005c70, 0xffffff,
        ]),
    };
}

/// Meaning of a line, an area or a text in a chart. For example, `Loading` marks the curve of a
/// loading. The meaning determines the colour, which depends on the output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ink {
    /// Text, frames and outlines.
    Text,
    /// Lines and marks in the background, such as a line at zero.
    Quiet,
    /// The rough profile of the rigid body.
    Profile,
    /// The surface of the elastic body.
    Surface,
    /// The springs that are in contact.
    Contact,
    /// Curves of loading stages.
    Loading,
    /// Curves of unloading stages.
    Unloading,
    /// Force curve of a motion by hand: in the explorer, the user moves the body along this curve.
    Manual,
    /// Earlier curve that stays in the background, so that it can be compared with the present
    /// curve.
    Kept,
    /// One of several curves that the user keeps for comparison. The value is the index of this
    /// curve among them, from 0.
    Compared(usize),
    /// The state of the contact that the user selected with the cursor.
    Cursor,
    /// One of several curves in a figure. The value is the index of this curve, from 0.
    Series(usize),
}

impl Ink {
    /// Returns the colour of the ink in a figure with a white background.
    pub fn on_paper(self) -> Rgb {
        let Palette {
            foreground, ansi, ..
        } = Palette::LIGHT;
        match self {
            Ink::Text | Ink::Profile => foreground,
            Ink::Quiet | Ink::Kept => ansi[8],
            Ink::Surface => ansi[4],
            Ink::Contact | Ink::Cursor => ansi[1],
            Ink::Loading => ansi[2],
            Ink::Unloading => ansi[5],
            Ink::Manual => ansi[6],
            Ink::Compared(number) => [ansi[4], ansi[6], ansi[3], ansi[8]][number % 4],
            // Blue, red, black, green, magenta. Neighbouring colours differ in lightness, so that
            // they can be distinguished in a print without colours.
            Ink::Series(number) => [ansi[4], ansi[1], foreground, ansi[2], ansi[5]][number % 5],
        }
    }
}

/// Colour scale for the values of a heat map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Shades {
    /// Colours from dark (lowest value) to light (highest value).
    Sequential,
    /// Colours from blue through white to red, for a range of values with zero in the middle.
    Diverging,
}

/// Nine equidistant colours of the scale Viridis (van der Walt and Smith, 2015). Its lightness
/// increases throughout, and people with red-green colour blindness can read it.
const VIRIDIS: [Rgb; 9] = rgb([
    0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725,
]);

/// Nine colours of the scale RdBu of ColorBrewer (Brewer and Harrower, 2003), in reverse order.
/// People with red-green colour blindness can read this scale.
const BLUE_TO_RED: [Rgb; 9] = rgb([
    0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b,
]);

impl Shades {
    /// Number of bands into which an SVG figure divides a colour scale. Each band has one colour.
    pub const BANDS: usize = 64;

    /// Returns the colour of a band. The colour scale is divided into [`Self::BANDS`] bands. Band 0
    /// has the lowest values.
    pub fn of_band(self, band: usize) -> Rgb {
        self.at((band as f64 + 0.5) / Shades::BANDS as f64)
    }

    /// Returns nine colours at equal distances along the scale, from the lowest to the highest
    /// value.
    pub fn colours(self) -> [Rgb; 9] {
        match self {
            Shades::Sequential => VIRIDIS,
            Shades::Diverging => BLUE_TO_RED,
        }
    }

    /// Returns the colour at a position on the colour scale. The position is 0 for the lowest value
    /// and 1 for the highest value. NaN gives the colour at 0.
    pub fn at(self, share: f64) -> Rgb {
        let colours = self.colours();
        let share = if share.is_nan() {
            0.0
        } else {
            share.clamp(0.0, 1.0)
        };
        let place = share * (colours.len() - 1) as f64;
        let index = (place as usize).min(colours.len() - 2);
        let fraction = place - index as f64;
        std::array::from_fn(|channel| {
            let from = f64::from(colours[index][channel]);
            let to = f64::from(colours[index + 1][channel]);
            (from + (to - from) * fraction).round() as u8
        })
    }
}

/// Returns the lightness of a colour, from 0 to 1.
fn lightness([red, green, blue]: Rgb) -> f64 {
    (0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)) / 255.0
}

/// Returns the colour of text on the background `colour`: black or white, whichever is easier to
/// read.
pub(super) fn ink_on(colour: Rgb) -> Rgb {
    if lightness(colour) > 0.5 {
        [0; 3]
    } else {
        [255; 3]
    }
}

/// Returns a colour in web notation, `#rrggbb`.
pub fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_are_ordered_in_grey_and_ink_is_readable_on_them() {
        let shades =
            |shades: Shades| (0..=100).map(move |percent| shades.at(f64::from(percent) / 100.0));
        let greys = |all| shades(all).map(lightness).collect::<Vec<f64>>();
        let sequential = greys(Shades::Sequential);
        assert!(
            sequential.windows(2).all(|pair| pair[0] < pair[1]),
            "{sequential:?}"
        );
        assert!(sequential[100] - sequential[0] > 0.7, "{sequential:?}");
        let diverging = greys(Shades::Diverging);
        assert!(
            diverging[..=50].is_sorted() && diverging[50..].iter().rev().is_sorted(),
            "{diverging:?}"
        );
        for colour in shades(Shades::Sequential).chain(shades(Shades::Diverging)) {
            assert!(
                (lightness(colour) - lightness(ink_on(colour))).abs() >= 0.5,
                "{colour:?}"
            );
        }
        assert_eq!(
            [f64::NAN, f64::NEG_INFINITY].map(|share| Shades::Sequential.at(share)),
            [VIRIDIS[0]; 2]
        );
        assert_eq!(Shades::Sequential.at(f64::INFINITY), VIRIDIS[8]);
    }

    #[test]
    fn curves_of_a_figure_have_colours_of_their_own() {
        let colours: Vec<Rgb> = (0..5)
            .map(|number| Ink::Series(number).on_paper())
            .collect();
        for (number, colour) in colours.iter().enumerate() {
            assert!(!colours[..number].contains(colour), "{number}");
        }
        assert_eq!(hex([0, 0x5c, 0xc2]), "#005cc2");
    }
}
