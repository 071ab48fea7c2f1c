//! Gwyddion Simple Field: a text header and 32-bit heights.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::entries::Entries;
use super::error::{Place, TopographyError, refused};
use super::reading::Reading;

pub(super) const SIGNATURE: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads `key = value` lines up to a zero byte, then XRes × YRes numbers from the next multiple of four bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let end = bytes.iter().position(|byte| *byte == 0).ok_or_else(|| {
        refused(Place::Byte(bytes.len()), "a header without an end", "a header that ends with a zero byte")
    })?;
    let mut header = Entries::default();
    for (index, line) in String::from_utf8_lossy(&bytes[..end]).lines().enumerate().skip(1) {
        header.take(index + 1, line, "key = value")?;
    }
    let count = |key: &str| header.count(key, "XRes and YRes");
    let (columns, rows) = (count("xres")?, count("yres")?);
    let mut data = Bytes::new(bytes, Order::Little);
    data.take((end / 4 + 1) * 4)?;
    let heights = data.numbers(columns.saturating_mul(rows), Number::F32)?;
    let sizes = header.number("xreal")?.zip(header.number("yreal")?);
    let spacing = sizes.map(|(width, height)| [width / columns as f64, height / rows as f64]);
    let unit = |key: &str| header.text(key).map_or(Ok(None), |(value, place)| Unit::stated(value, place));
    let units = [unit("xyunits")?, unit("zunits")?];
    Ok(Reading::even("GSF", heights, columns, spacing, units))
}
