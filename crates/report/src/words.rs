//! Numbers in words: shares in per cent, and letters of scenes.

use asperity_data::format_rounded;

/// Returns a share in per cent, rounded to a number of significant digits: `0.34 %`. For errors,
/// use [`asperity_data::per_cent`], which chooses the number of digits.
pub fn percent(share: f64, digits: usize) -> String {
    format!("{} %", format_rounded(100.0 * share, digits, "1"))
}

/// Returns a share in whole per cent: `12 %`.
pub(crate) fn whole_percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Returns the letter that names a scene in tables and legends, such as `A` for the number 0. From
/// the number 26 on, the names are `S26`, `S27` and so on.
pub fn letter(number: usize) -> String {
    match u8::try_from(number) {
        Ok(place) if place < 26 => char::from(b'A' + place).to_string(),
        _ => format!("S{number}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_words() {
        assert_eq!(percent(0.0034, 2), "0.34 %");
        assert_eq!(percent(0.8, 4), "80 %");
        assert_eq!(whole_percent(0.126), "13 %");
        assert_eq!([0, 25, 26, 300].map(letter), ["A", "Z", "S26", "S300"]);
    }
}
