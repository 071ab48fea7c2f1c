//! Meanings of lines and areas, colour scales, and how similar two colours look.

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
    /// Springs in contact, and patches of them.
    Contact,
    /// Loading stages, and springs that are pressed.
    Press,
    /// Unloading stages, and springs that are pulled.
    Pull,
    /// Area inside a loop: the dissipated energy.
    Loop,
    /// The rigid body below its profile.
    Body,
    /// Earlier curve that stays in the background, so that it can be compared with the present
    /// curve.
    Kept,
    /// Curve that the user keeps for comparison. Letters distinguish several of these curves.
    Compared,
    /// State of the contact that the user selected with the cursor.
    Cursor,
    /// One of several curves in a figure. The value is the index of this curve, from 0.
    Series(usize),
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

/// Returns the share of the light of a channel, from 0 to 1, that a screen emits for its number
/// (sRGB, IEC 61966-2-1).
pub(crate) fn light(channel: u8) -> f64 {
    let share = f64::from(channel) / 255.0;
    if share <= 0.04045 {
        share / 12.92
    } else {
        ((share + 0.055) / 1.055).powf(2.4)
    }
}

/// Position of a colour in the space L*a*b*, in which distances are perceived differences.
pub(crate) type Lab = [f64; 3];

pub(crate) fn lab(colour: Rgb) -> Lab {
    lab_of_light(colour.map(light))
}

/// Returns the position of a colour whose channels emit these shares of their light.
pub(crate) fn lab_of_light(light: [f64; 3]) -> Lab {
    let [red, green, blue] = light;
    // Colour of a white screen (illuminant D65).
    const WHITE: [f64; 3] = [0.95047, 1.0, 1.08883];
    let cube_root = |share: f64| {
        if share > 0.008856 {
            share.cbrt()
        } else {
            7.787 * share + 16.0 / 116.0
        }
    };
    let x = 0.4124564 * red + 0.3575761 * green + 0.1804375 * blue;
    let y = 0.2126729 * red + 0.7151522 * green + 0.0721750 * blue;
    let z = 0.0193339 * red + 0.1191920 * green + 0.9503041 * blue;
    let x = cube_root(x / WHITE[0]);
    let y = cube_root(y / WHITE[1]);
    let z = cube_root(z / WHITE[2]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Returns the perceived difference ΔE of two colours (CIE 1976).
pub(crate) fn difference(one: Lab, other: Lab) -> f64 {
    let squares = one
        .iter()
        .zip(other)
        .map(|(one, other)| (one - other).powi(2));
    squares.sum::<f64>().sqrt()
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
