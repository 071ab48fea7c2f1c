//! Numbers with twice the digits: the reference of forces.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// An unevaluated sum of two numbers, of about 106 binary digits.
///
/// Each operation errs by a few units of 2⁻¹⁰⁴ (Joldes, Muller and Popescu 2017), within the range in which
/// products of two numbers keep all their digits: about 1e−290 to 1e300.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Extended {
    high: f64,
    low: f64,
}

impl Extended {
    /// π.
    pub const PI: Extended = Extended { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

    /// The nearest double.
    #[must_use]
    pub fn rounded(self) -> f64 {
        self.high + self.low
    }

    /// Magnitude.
    #[must_use]
    pub fn abs(self) -> Extended {
        if self.high < 0.0 { -self } else { self }
    }

    /// Square root; zero for numbers that are not positive.
    #[must_use]
    pub fn sqrt(self) -> Extended {
        if self.high <= 0.0 {
            return Extended::default();
        }
        // One step of Newton's method doubles the digits.
        let root = self.high.sqrt();
        let left = self - exact_product(root, root);
        quick_sum(root, left.high / (2.0 * root))
    }

    /// Sum of numbers.
    #[must_use]
    pub fn sum(values: impl IntoIterator<Item = f64>) -> Extended {
        values.into_iter().fold(Extended::default(), |sum, value| sum + Extended::from(value))
    }
}

impl From<f64> for Extended {
    fn from(value: f64) -> Self {
        Extended { high: value, low: 0.0 }
    }
}

/// a + b and its rounding error, in any order of magnitudes (Knuth).
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let added = sum - a;
    (sum, (a - (sum - added)) + (b - added))
}

/// The same where |a| ≥ |b| (Dekker).
fn quick_sum(a: f64, b: f64) -> Extended {
    let sum = a + b;
    Extended { high: sum, low: b - (sum - a) }
}

fn exact_product(a: f64, b: f64) -> Extended {
    let product = a * b;
    Extended { high: product, low: a.mul_add(b, -product) }
}

impl Neg for Extended {
    type Output = Extended;
    fn neg(self) -> Extended {
        Extended { high: -self.high, low: -self.low }
    }
}

impl Add for Extended {
    type Output = Extended;
    fn add(self, other: Extended) -> Extended {
        let (high, error) = exact_sum(self.high, other.high);
        let (low, lost) = exact_sum(self.low, other.low);
        let sum = quick_sum(high, error + low);
        quick_sum(sum.high, sum.low + lost)
    }
}

impl AddAssign for Extended {
    fn add_assign(&mut self, other: Extended) {
        *self = *self + other;
    }
}

impl Sub for Extended {
    type Output = Extended;
    fn sub(self, other: Extended) -> Extended {
        self + -other
    }
}

impl Mul for Extended {
    type Output = Extended;
    fn mul(self, other: Extended) -> Extended {
        let product = exact_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Extended {
    type Output = Extended;
    fn div(self, other: Extended) -> Extended {
        let first = self.high / other.high;
        let left = self - other * Extended::from(first);
        let second = left.high / other.high;
        let left = left - other * Extended::from(second);
        quick_sum(first, second) + Extended::from(left.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_tiny(error: Extended, size: f64) -> bool {
        error.abs().rounded() <= 2.0_f64.powi(-101) * size
    }

    #[test]
    fn nothing_is_lost_where_a_plain_sum_loses_all() {
        let sum = Extended::sum([1e16, 1.0, -1e16, 2.0_f64.powi(-60)]);
        assert_eq!(sum.high, 1.0);
        assert_eq!(sum.low, 2.0_f64.powi(-60));
    }

    #[test]
    fn operations_undo_each_other() {
        for (a, b) in [(1.0, 3.0), (2.5e-20, 7.0e11), (-1.1, 0.9), (1e150, 1e-150)] {
            let (a, b) = (Extended::from(a) + Extended::from(1e-17 * a), Extended::from(b));
            assert!(is_tiny(a / b * b - a, a.high.abs()));
            assert!(is_tiny(a - b + b - a, a.high.abs().max(b.high)));
            let root = a.abs().sqrt();
            assert!(is_tiny(root * root - a.abs(), a.high.abs()));
        }
        assert_eq!(Extended::from(0.0).sqrt().rounded(), 0.0);
        assert_eq!(Extended::from(-1.0).sqrt().rounded(), 0.0);
    }
}
