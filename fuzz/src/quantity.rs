//! Typed numbers with units.

use super::{assert_message, text};
use asperity::data::{format_quantity, parse_quantity};
use asperity::scene::fields::{FIELDS, STAGE_FORCE, STAGE_INDENTATION};

/// The largest number allowed by any field.
const LARGEST: f64 = 1.0e300;

/// The text is read for each unit of the table of fields.
///
/// An accepted number is finite and equals the number of a plain text; its shown text reads back as
/// the same text.
pub fn quantity(bytes: &[u8]) {
    let text = text(bytes);
    let mut units: Vec<&str> = FIELDS
        .iter()
        .chain([&STAGE_FORCE, &STAGE_INDENTATION])
        .map(|one| one.unit)
        .collect();
    units.sort_unstable();
    units.dedup();
    let plain = text
        .trim()
        .parse()
        .ok()
        .filter(|plain: &f64| plain.is_finite());
    for unit in units {
        let read = parse_quantity(&text, unit);
        if let Some(plain) = plain {
            let same = |read: f64| read.to_bits() == plain.to_bits();
            assert!(
                read.as_ref().is_ok_and(|&read| same(read)),
                "{text:?} {unit}: {read:?}"
            );
        }
        match read {
            Ok(value) => assert_shown(&text, value, unit),
            Err(error) => {
                let message = error.to_string();
                assert_message(&message);
                assert!(message.contains(" is "), "{message}");
            }
        }
    }
}

fn assert_shown(text: &str, value: f64, unit: &str) {
    assert!(value.is_finite(), "{text:?} {unit}: {value}");
    if value.abs() > LARGEST {
        return;
    }
    let shown = format_quantity(value, unit);
    let read = parse_quantity(&shown, unit).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    assert_eq!(
        format_quantity(read, unit),
        shown,
        "{text:?} {unit}: {value} {read}"
    );
    // Four digits; what is far below the smallest prefix is zero.
    let error = (read - value).abs();
    assert!(
        error <= 5.01e-4 * value.abs() + 1e-36,
        "{text:?} {unit}: {value} {read}"
    );
    // The opposite sign gives the opposite number.
    let typed = text.trim();
    if !typed.starts_with(['+', '-']) {
        assert_eq!(
            parse_quantity(&format!("-{typed}"), unit).ok(),
            Some(-value),
            "-{typed:?} {unit}"
        );
    }
}
