//! Sizes of printed figures: lengths that the user states, and the pixels that they are.

use asperity_data::parse_quantity;

/// Smallest width in mm of a printed figure.
pub const LEAST_WIDTH: u32 = 50;
/// Smallest height in mm of a printed figure.
pub const LEAST_HEIGHT: u32 = 30;
/// Largest width, and also largest height, in mm of a printed figure.
const MOST: u32 = 500;
/// Number of px (1/96 inch) in a metre of a printed figure.
const PX: f64 = 96.0 / 0.0254;

/// Parses a length of a printed figure, such as `85mm`, and returns it in m. The length must be
/// from `least` mm to 500 mm.
///
/// # Errors
/// Returns a message with the allowed lengths.
pub fn parse_printed_length(text: &str, least: u32) -> Result<f64, String> {
    let length = parse_quantity(text, "m").map_err(|error| error.to_string())?;
    let range = 1e-3 * f64::from(least)..=1e-3 * f64::from(MOST);
    if range.contains(&length) {
        Ok(length)
    } else {
        Err(format!("allowed: from {least}mm to {MOST}mm"))
    }
}

/// Returns the number of px of a printed length in m.
pub fn printed_pixels(length: f64) -> f64 {
    PX * length
}
