//! Colours of numbers: a scale that people with any colour vision read, and that stays in order in grey.

use super::canvas::{INK, PAPER};
use crate::study::figure::AxisScale;
use plotters::prelude::RGBColor;

/// Viridis (van der Walt and Smith, 2015) at equal distances: as far apart for people who see no red or no
/// green, and lighter from each to the next.
const COLOURS: [RGBColor; 9] = [
    RGBColor(0x44, 0x01, 0x54),
    RGBColor(0x47, 0x2d, 0x7b),
    RGBColor(0x3b, 0x52, 0x8b),
    RGBColor(0x2c, 0x72, 0x8e),
    RGBColor(0x21, 0x91, 0x8c),
    RGBColor(0x28, 0xae, 0x80),
    RGBColor(0x5e, 0xc9, 0x62),
    RGBColor(0xad, 0xdc, 0x30),
    RGBColor(0xfd, 0xe7, 0x25),
];

/// Most decades a logarithmic scale of colours spans.
const MOST_DECADES: f64 = 6.0;

/// What differs by less, in shares of itself, is one number: a scale would have but marks with the same digits.
pub(super) const NO_SPREAD: f64 = 1e-6;

/// The numbers between which colours change, in the coordinate of the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shades {
    pub scale: AxisScale,
    pub low: f64,
    pub high: f64,
}

impl Shades {
    /// Over these numbers. A linear scale begins at zero where nothing is below it and something near.
    pub(crate) fn over(scale: AxisScale, values: impl Iterator<Item = f64>) -> Shades {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        match scale {
            AxisScale::Linear => {
                let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
                let low = if lowest >= 0.0 && lowest <= 0.3 * highest { 0.0 } else { lowest };
                Shades::between(scale, low, highest)
            }
            AxisScale::Logarithmic => {
                let above = values.into_iter().filter(|value| *value > 0.0);
                let lowest = above.fold(f64::INFINITY, f64::min);
                let high = highest.log10();
                Shades::between(scale, lowest.log10().max(high - MOST_DECADES), high)
            }
        }
    }

    fn between(scale: AxisScale, low: f64, high: f64) -> Shades {
        if !(low.is_finite() && high.is_finite()) {
            return Shades { scale, low: 0.0, high: 1.0 };
        }
        if high - low > NO_SPREAD * high.abs().max(low.abs()) {
            return Shades { scale, low, high };
        }
        // A single number, or what differs from it by rounding.
        let around = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        Shades { scale, low: low - around, high: high + around }
    }

    /// How far along the scale a number is, from 0 to 1.
    pub(crate) fn share(&self, value: f64) -> f64 {
        let coordinate = self.scale.coordinate(value);
        let share = (coordinate - self.low) / (self.high - self.low);
        // The logarithm of zero and of what is below it.
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The colour of a number.
    pub(super) fn colour(&self, value: f64) -> RGBColor {
        shade(self.share(value))
    }
}

/// The colour at a share of the scale.
pub(super) fn shade(share: f64) -> RGBColor {
    let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let index = (place as usize).min(COLOURS.len() - 2);
    let (from, to) = (COLOURS[index], COLOURS[index + 1]);
    let between = |from: u8, to: u8| {
        let (from, to) = (f64::from(from), f64::from(to));
        (from + (to - from) * (place - index as f64)).round() as u8
    };
    RGBColor(between(from.0, to.0), between(from.1, to.1), between(from.2, to.2))
}

/// How light a colour is in grey, from 0 to 1.
pub(super) fn lightness(RGBColor(red, green, blue): RGBColor) -> f64 {
    (0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)) / 255.0
}

/// Ink that is read on a colour.
pub(super) fn ink_on(colour: RGBColor) -> RGBColor {
    if lightness(colour) > 0.5 { INK } else { PAPER }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_keep_their_order_in_grey() {
        let greys: Vec<f64> = (0..=100).map(|percent| lightness(shade(f64::from(percent) / 100.0))).collect();
        assert!(greys.windows(2).all(|pair| pair[0] < pair[1]), "{greys:?}");
        assert!(greys[100] - greys[0] > 0.7, "{greys:?}");
    }

    #[test]
    fn numbers_have_their_place_on_the_scale() {
        let linear = Shades::over(AxisScale::Linear, [0.1, f64::NAN, 2.0].into_iter());
        assert_eq!((linear.low, linear.high), (0.0, 2.0));
        assert_eq!(linear.share(0.5), 0.25);
        let far = Shades::over(AxisScale::Linear, [1.0, 2.0].into_iter());
        assert_eq!(far.share(1.0), 0.0);
        let decades = Shades::over(AxisScale::Logarithmic, [0.0, 1e-2, 1.0].into_iter());
        assert_eq!((decades.share(0.1), decades.share(0.0), decades.share(-1.0)), (0.5, 0.0, 0.0));
        let deep = Shades::over(AxisScale::Logarithmic, [1e-20, 1.0].into_iter());
        assert_eq!(deep.low, -6.0);
        let rounded = Shades::over(AxisScale::Linear, [2.0, 2.0 + 1e-9].into_iter());
        assert!((rounded.low - 1.8).abs() < 1e-6 && (rounded.high - 2.2).abs() < 1e-6, "{rounded:?}");
        for none in [vec![], vec![0.0], vec![3.0, 3.0], vec![-1.0]] {
            for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
                let shades = Shades::over(scale, none.iter().copied());
                assert!(shades.high > shades.low && shades.share(3.0).is_finite(), "{shades:?}");
            }
        }
    }
}
