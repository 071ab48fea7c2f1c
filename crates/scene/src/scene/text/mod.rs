//! Text in RON: positions of its values by path, and edits that keep the comments. This module does
//! not depend on the fields of a scene.
//!
//! [`Text::span`](index::Text::span) finds a value. [`Text::replace`](index::Text::replace) and
//! [`Text::insert`](index::Text::insert) return a new text.

use asperity_data::is_control;
use ron::error::SpannedError;
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

pub(crate) mod edit;
pub(crate) mod index;
pub(crate) mod scan;

/// Reads a value from RON text. An optional value may be written without `Some`. A variant that
/// holds one struct may be written with only one pair of brackets.
///
/// # Errors
/// Returns an error if the text is not RON or does not have the fields of the value.
pub fn read_ron<T: DeserializeOwned>(text: &str) -> Result<T, SpannedError> {
    let extensions = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES;
    ron::Options::default()
        .with_default_extension(extensions)
        .from_str(text)
}

/// Writes a number in RON with a decimal point. The text is the shortest one that gives the same
/// number when it is read. Numbers whose magnitude is not between 0.001 and 100 000 have an
/// exponent.
pub fn ron_float(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() || size == 0.0 || (size > 1e-3 && size < 1e5) {
        return format!("{value:?}");
    }
    let text = format!("{value:e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0e{exponent}"),
        _ => text,
    }
}

/// Writes a number of a scene in RON. A number that is not finite becomes `NaN`. No valid scene has
/// such a number, and error messages show it as the author wrote it.
pub(in crate::scene) fn real_in_ron(value: f64) -> String {
    ron_float(if value.is_finite() { value } else { f64::NAN })
}

/// Writes text as a RON string in quotes. A character is escaped only if RON does not allow it in a
/// string.
pub fn ron_string(text: &str) -> String {
    let mut string = String::with_capacity(text.len() + 2);
    string.push('"');
    for c in text.chars() {
        match c {
            '"' => string.push_str("\\\""),
            '\\' => string.push_str("\\\\"),
            '\n' => string.push_str("\\n"),
            '\r' => string.push_str("\\r"),
            '\t' => string.push_str("\\t"),
            c if is_control(c) => string.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
            c => string.push(c),
        }
    }
    string.push('"');
    string
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_are_short_and_strings_escaped_only_where_they_must_be() {
        let texts = "2.0e6 1.0e-4 2.5e-7 0.5 -40.0 1.0e-3 0.0011 0.005 99999.0 -99999.5 1.0e5 0.0 -0.0 NaN -inf";
        assert!(
            texts
                .split(' ')
                .all(|text| ron_float(text.parse().unwrap()) == text)
        );
        assert_eq!(
            ron_string("κ \"a\" \\ \n\u{1b}"),
            r#""κ \"a\" \\ \n\u{1b}""#
        );
    }

    proptest! {
        #[test]
        fn all_numbers_survive(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            let read: f64 = ron::from_str(&ron_float(value)).unwrap();
            prop_assert!(read.to_bits() == bits || value.is_nan() && read.is_nan());
        }

        #[test]
        fn all_strings_survive(text in any::<String>()) {
            prop_assert_eq!(ron::from_str::<String>(&ron_string(&text)), Ok(text));
        }
    }
}
