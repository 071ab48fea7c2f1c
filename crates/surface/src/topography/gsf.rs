//! The format Gwyddion Simple Field: a header of lines `key = value`, then heights as 32-bit
//! floating-point numbers.

use super::bytes::{Bytes, Number, Order};
use super::key_values::KeyValues;
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};

pub(super) const SIGNATURE: &[u8] = b"Gwyddion Simple Field 1.0\n";

const REQUIRED: &str = "XRes and YRes";

/// Reads the header up to a zero byte, and the XRes × YRes heights after it. The heights begin at
/// the next multiple of four bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let Some(end) = bytes.iter().position(|byte| *byte == 0) else {
        let found = "a header without an end";
        let allowed = "a header that ends with a zero byte";
        return Err(refused(Place::Byte(bytes.len()), found, allowed));
    };
    let text = String::from_utf8_lossy(&bytes[..end]);
    let mut header = KeyValues::default();
    for (index, line) in text.lines().enumerate().skip(1) {
        header.take(index + 1, line, "key = value")?;
    }
    let columns = header.count("xres", REQUIRED)?;
    let rows = header.count("yres", REQUIRED)?;

    let mut data = Bytes::new(bytes, Order::Little);
    data.take((end / 4 + 1) * 4)?;
    let heights = data.numbers(columns.saturating_mul(rows), Number::F32)?;
    let spacing = match (header.number("xreal")?, header.number("yreal")?) {
        (Some(width), Some(height)) => Some([width / columns as f64, height / rows as f64]),
        _ => None,
    };
    let units = StatedUnits::new(unit(&header, "xyunits")?, unit(&header, "zunits")?);
    Ok(Reading::even("GSF", heights, columns, spacing, units))
}

fn unit(header: &KeyValues, key: &str) -> Result<Option<Unit>, SurfaceError> {
    match header.value(key) {
        Some(value) => Unit::stated(value.text, value.place),
        None => Ok(None),
    }
}
