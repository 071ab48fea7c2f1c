//! Numbers of 192 binary digits.

use dashu_float::{FBig, round::mode::HalfEven};

pub type Wide = FBig<HalfEven, 2>;

const DIGITS: usize = 192;

pub fn wide(value: f64) -> Wide {
    Wide::try_from(value).unwrap().with_precision(DIGITS).value()
}

pub fn pi() -> Wide {
    Wide::pi(DIGITS)
}

fn magnitude(value: Wide) -> Wide {
    if value < Wide::ZERO { -value } else { value }
}

/// The nearest number of single length.
pub fn rounded(value: &Wide) -> f64 {
    value.to_f64().value()
}

/// |found − expected| as a number of single length.
pub fn distance(found: f64, expected: &Wide) -> f64 {
    rounded(&magnitude(wide(found) - expected.clone()))
}
