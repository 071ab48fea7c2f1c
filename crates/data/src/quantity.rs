//! Numbers with SI prefixes and units: `2.5 MPa`, `10 µm`, `50 mJ/m²`.

use crate::text::{SI_PREFIXES, shown, si_prefix};

/// Number of significant digits with which quantities are shown to users.
const DIGITS: usize = 4;

/// SI unit, and the texts with which an error message about a wrong unit names it.
struct Dimension {
    unit: &'static str,
    /// Name of the unit in error messages, such as "unit of length".
    name: &'static str,
    /// Units that the error message proposes.
    proposed: &'static str,
}

const fn dimension(unit: &'static str, name: &'static str, proposed: &'static str) -> Dimension {
    Dimension {
        unit,
        name,
        proposed,
    }
}

const DIMENSIONS: &[Dimension] = &[
    dimension("m", "unit of length", "m, mm, µm, nm"),
    dimension("N", "unit of force", "N, mN, µN, nN"),
    dimension("J", "unit of energy", "J, mJ, µJ, nJ"),
    dimension("Pa", "unit of pressure", "Pa, kPa, MPa, GPa"),
    dimension("J/m²", "unit of energy per area", "J/m², mJ/m², N/m, mN/m"),
    dimension("N/m", "unit of stiffness", "N/m, mN/m, kN/m"),
    dimension("rad", "unit of angle", "rad, mrad, °"),
    dimension("s", "unit of time", "s, ms, µs"),
    dimension("1", "prefix of a number", "k, M, G, Ki, Mi, Gi, %"),
];

/// Error for a typed text that is not a number with the expected unit. The field is the whole error
/// message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct QuantityError(pub String);

impl QuantityError {
    fn no_number(typed: &str, unit: &str) -> Self {
        let example = match unit {
            "1" | "" => "0.7, 16k or 1.0e-3".to_string(),
            unit if !has_prefixes(unit) => "0.7 or 1.0e-3".to_string(),
            unit => format!("1.0e-3, 2.5 m{unit} or 2.5k{unit}"),
        };
        QuantityError(match typed.trim() {
            "" => format!("a value is missing, such as {example}"),
            typed => format!("{:?} is not a number, such as {example}", shown(typed)),
        })
    }

    fn wrong_unit(typed: &str, unit: &str) -> Self {
        let typed = shown(typed);
        let unit = if unit.is_empty() { "1" } else { unit };
        let dimension = DIMENSIONS.iter().find(|dimension| dimension.unit == unit);
        QuantityError(match dimension {
            Some(Dimension { name, proposed, .. }) => {
                format!("{typed} is not a {name}: use {proposed}")
            }
            None => format!("{typed} is not the unit {unit}"),
        })
    }

    fn too_large(typed: &str) -> Self {
        QuantityError(format!("{} is too large", shown(typed)))
    }
}

/// Parses a typed number and converts it to the SI unit `unit`. For example, `50m` for J/m² gives
/// 0.05, and `10um` for m gives 1.0e-5.
///
/// * The text may omit the unit.
/// * A single `m` after the number is the prefix milli. If `unit` is `m`, it is the unit metre
///   instead, so `50m` means fifty metres. If `unit` is `1`, `0.7 m` with a blank is refused,
///   because it reads as a length.
/// * An angle may be in degrees, `30°` or `30 deg`.
/// * If `unit` is `1`, the text may end in `%`, or in `Ki`, `Mi` or `Gi` for powers of 1024.
///
/// # Errors
/// Returns an error if the text is not a number, has another unit, or is not finite.
///
/// ```
/// use asperity_data::parse_quantity;
///
/// assert_eq!(parse_quantity("2.5 MPa", "Pa"), Ok(2.5e6));
/// assert_eq!(parse_quantity("80 %", "1"), Ok(0.8));
/// assert!(parse_quantity("3 s", "N").is_err());
/// assert_eq!(parse_quantity("700m", "1"), Ok(0.7));
/// assert!(parse_quantity("0.7 m", "1").is_err());
/// ```
pub fn parse_quantity(text: &str, unit: &str) -> Result<f64, QuantityError> {
    let typed = text.trim();
    let Some(number) = TypedNumber::read(typed) else {
        return Err(QuantityError::no_number(typed, unit));
    };
    let suffix = number.suffix.trim();
    let reads_as_length = suffix == "m" && number.suffix.starts_with(char::is_whitespace);
    if unit == "1" && reads_as_length {
        return Err(QuantityError::wrong_unit(suffix, unit));
    }
    let Some(conversion) = Conversion::to_unit(unit, suffix) else {
        return Err(QuantityError::wrong_unit(suffix, unit));
    };
    number
        .converted(conversion)
        .ok_or_else(|| QuantityError::too_large(typed))
}

/// Appends `unit` to a typed number that has no unit. For example, `50` with the unit `mJ/m²`
/// becomes `50 mJ/m²`. A text that is not a number without a unit remains unchanged.
pub fn in_unit(typed: &str, unit: &str) -> String {
    let number = typed.trim();
    let has_no_unit =
        TypedNumber::read(number).is_some_and(|number| number.suffix.trim().is_empty());
    if has_no_unit && !unit.is_empty() {
        format!("{number} {unit}")
    } else {
        typed.to_owned()
    }
}

/// Returns the unit of a formatted quantity, including its prefix: `mJ/m²` for `50 mJ/m²`. Returns
/// an empty text if there is no unit.
pub fn unit_of(shown: &str) -> &str {
    shown
        .trim_start_matches(['=', ' '])
        .split_once(' ')
        .map_or("", |(_, unit)| unit)
}

/// Parts of a typed number with a unit, such as `2.5e3 MPa`.
struct TypedNumber<'a> {
    /// Sign, digits and decimal point, such as `2.5`.
    digits: &'a str,
    /// Exponent of ten, such as 3 for `e3`.
    exponent: i32,
    /// The rest of the text, such as ` MPa`.
    suffix: &'a str,
}

impl<'a> TypedNumber<'a> {
    /// Splits a text that begins with a number into digits, exponent and suffix. Returns `None` for
    /// any other text.
    fn read(text: &'a str) -> Option<Self> {
        let signless = text.trim_start_matches(['+', '-', '−']);
        let sign = &text[..text.len() - signless.len()];
        if sign.chars().count() > 1 || sign == "−" {
            return None;
        }
        let end = signless
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(signless.len());
        let number = &signless[..end];
        if !number.contains(|c: char| c.is_ascii_digit()) || number.matches('.').count() > 1 {
            return None;
        }
        let (digits, after_digits) = text.split_at(sign.len() + end);
        let (exponent, suffix) = split_exponent(after_digits).unwrap_or((0, after_digits));
        Some(TypedNumber {
            digits,
            exponent,
            suffix,
        })
    }

    /// Returns the value after the conversion; `None` if the value is too large.
    fn converted(&self, conversion: Conversion) -> Option<f64> {
        // The prefix changes the decimal exponent before the text is parsed. Therefore 100 nm gives
        // exactly the same value as 1.0e-7 m.
        let exponent = self.exponent.checked_add(conversion.power_of_ten)?;
        let scaled: f64 = format!("{}e{exponent}", self.digits).parse().ok()?;
        let value = scaled * conversion.factor;
        value.is_finite().then_some(value)
    }
}

/// Splits a text such as `e3 MPa` into its exponent and the rest. Returns `None` if the text does
/// not begin with an exponent: the `e` of an exponent has digits after it, whereas an `E` without
/// digits is the prefix exa.
fn split_exponent(text: &str) -> Option<(i32, &str)> {
    let signed = text.strip_prefix(['e', 'E'])?;
    let unsigned = signed.strip_prefix(['+', '-']).unwrap_or(signed);
    let digits = unsigned
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(unsigned.len());
    if digits == 0 {
        return None;
    }
    let (exponent, rest) = signed.split_at(signed.len() - unsigned.len() + digits);
    // If the exponent has too many digits for an integer, the number is zero or too large.
    let beyond = if signed.starts_with('-') {
        i32::MIN / 2
    } else {
        i32::MAX / 2
    };
    Some((exponent.parse().unwrap_or(beyond), rest))
}

/// Conversion of a number to an SI unit: multiplication by a power of ten and by another factor.
#[derive(Clone, Copy)]
struct Conversion {
    power_of_ten: i32,
    factor: f64,
}

impl Conversion {
    /// Returns the conversion to the SI unit `unit` for a number with a suffix such as `MPa`.
    /// Returns `None` if the suffix belongs to another unit.
    fn to_unit(unit: &str, suffix: &str) -> Option<Self> {
        let suffix = canonical(suffix);
        let unit = canonical(unit);
        if suffix.is_empty() || suffix == unit {
            return Some(Conversion::by_factor(1.0));
        }
        let is_number = is_unit_of_numbers(&unit);
        match suffix.as_str() {
            "°" | "deg" if unit == "rad" => {
                return Some(Conversion::by_factor(std::f64::consts::PI / 180.0));
            }
            "%" if is_number => return Some(Conversion::by_power_of_ten(-2)),
            "Ki" if is_number => return Some(Conversion::by_factor(f64::from(1 << 10))),
            "Mi" if is_number => return Some(Conversion::by_factor(f64::from(1 << 20))),
            "Gi" if is_number => return Some(Conversion::by_factor(f64::from(1 << 30))),
            _ => {}
        }
        if unit == "J/m2" && suffix.ends_with("N/m") {
            return Conversion::to_unit("J/m2", &suffix.replace("N/m", "J/m2"));
        }
        if !has_prefixes(&unit) && !is_number {
            return None;
        }
        for (prefix, power) in SI_PREFIXES {
            let Some(rest) = suffix.strip_prefix(prefix) else {
                continue;
            };
            let rest = rest.trim_start();
            if rest.is_empty() || (!is_number && rest == unit) {
                return Some(Conversion::by_power_of_ten(*power));
            }
        }
        None
    }

    fn by_factor(factor: f64) -> Self {
        Conversion {
            power_of_ten: 0,
            factor,
        }
    }

    fn by_power_of_ten(power_of_ten: i32) -> Self {
        Conversion {
            power_of_ten,
            factor: 1.0,
        }
    }
}

/// Returns true for the unit of plain numbers, which is `1` or empty.
fn is_unit_of_numbers(unit: &str) -> bool {
    unit == "1" || unit.is_empty()
}

/// Returns a unit in a common spelling. For example, `J/m²`, `J/m^2` and `J / m2` all become
/// `J/m2`.
fn canonical(unit: &str) -> String {
    unit.replace('²', "2").replace(['^', ' '], "")
}

/// Returns true if a unit may have an SI prefix. Powers of a metre such as m² may not, because the
/// power would apply to the prefix too.
fn has_prefixes(unit: &str) -> bool {
    !unit.contains(['−', '(', '³', '⁴']) && !matches!(unit, "m²" | "1/m")
}

/// Formats a value with its unit, to four significant digits: `2.67 MPa`, `100 nm`, `50 mJ/m²`,
/// `0.7`.
///
/// ```
/// assert_eq!(asperity_data::format_quantity(2.356e-5, "N"), "23.56 µN");
/// assert_eq!(asperity_data::format_quantity(2.7e-10, "m²"), "2.7e-10 m²");
/// ```
pub fn format_quantity(value: f64, unit: &str) -> String {
    format_rounded(value, DIGITS, unit)
}

/// Absolute value, in the SI unit, below which a quantity with a unit is written as zero. It is far
/// below the smallest prefix, so that only rounding errors are smaller.
const ROUNDING: f64 = 1e-36;

/// Formats a value with its unit, rounded to `digits` significant digits, from 1 to 4.
pub fn format_rounded(value: f64, digits: usize, unit: &str) -> String {
    // Plain numbers are written as zero only below the smallest normal number. A number next to
    // zero may mark the state just after a jump at zero.
    let least = if is_unit_of_numbers(unit) {
        f64::MIN_POSITIVE
    } else {
        ROUNDING
    };
    let value = if value.abs() < least { 0.0 } else { value };
    // The value is rounded before its prefix is chosen, so that 999.99 nm becomes 1 µm.
    let decimals = digits.clamp(1, DIGITS) - 1;
    with_unit(value, &format!("{value:.decimals$e}"), unit)
}

/// Formats a value with its unit. The value is rounded at the decimal place of the second
/// significant digit of `uncertainty`. For example, 50.0512 mJ/m² with an uncertainty of 0.13 mJ/m²
/// becomes `50.05 mJ/m²`. The uncertainty itself is not written.
///
/// ```
/// assert_eq!(asperity_data::format_within(0.050_123, 0.001, "J/m²"), "50.1 mJ/m²");
/// ```
pub fn format_within(value: f64, uncertainty: f64, unit: &str) -> String {
    if !(uncertainty > 0.0 && uncertainty.is_finite() && value.is_finite()) {
        return format_quantity(value, unit);
    }
    let power_of_value = value.abs().log10().floor();
    let power_of_uncertainty = uncertainty.abs().log10().floor();
    let digits = (power_of_value - power_of_uncertainty + 2.0).clamp(0.0, 17.0) as usize;
    if digits == 0 {
        return with_unit(0.0, "0", unit);
    }
    with_unit(value, &format!("{value:.*e}", digits - 1), unit)
}

/// Formats a range of values with their unit, such as `0.33 to 35 µN`. Both ends are rounded to
/// `digits` significant digits. If the rounded ends are equal, they get up to two more digits, so
/// that a narrow range does not look like a single value.
///
/// ```
/// use asperity_data::format_range;
///
/// assert_eq!(format_range((1.23e-6, 4.56e-6), 2, "N"), "1.2 to 4.6 µN");
/// assert_eq!(format_range((2.31e-3, 2.33e-3), 2, "N"), "2.31 to 2.33 mN");
/// assert_eq!(format_range((2.31e-3, 2.31e-3), 2, "N"), "2.3 mN");
/// ```
pub fn format_range(range: (f64, f64), digits: usize, unit: &str) -> String {
    /// Largest number of further digits.
    const FURTHER: usize = 2;
    let (low, high) = range;
    for digits in digits..=digits + FURTHER {
        let low = format_rounded(low, digits, unit);
        let high = format_rounded(high, digits, unit);
        if low != high {
            return one_unit([low, high]);
        }
    }
    format_rounded(low, digits, unit)
}

/// Joins the two formatted ends of a range to one text, such as `0.33 to 35 µN`. The unit is
/// written only once if it is the same at both ends.
pub fn one_unit(ends: [String; 2]) -> String {
    let [low, high] = ends;
    if low == high {
        return low;
    }
    if let Some((low_number, low_unit)) = low.split_once(' ')
        && let Some((_, high_unit)) = high.split_once(' ')
        && low_unit == high_unit
    {
        return format!("{low_number} to {high}");
    }
    format!("{low} to {high}")
}

/// Formats a value with its unit and with all its digits. If [`parse_quantity`] reads the result,
/// it returns exactly the same value.
pub fn exact_quantity(value: f64, unit: &str) -> String {
    with_unit(value, &format!("{value:e}"), unit)
}

/// Formats a value with the usual prefix of its unit. `scientific` is the value in scientific
/// notation, with the digits to be shown.
fn with_unit(value: f64, scientific: &str, unit: &str) -> String {
    let is_number = is_unit_of_numbers(unit);
    let unit_after = if is_number {
        String::new()
    } else {
        format!(" {unit}")
    };
    if !value.is_finite() || value == 0.0 {
        return format!("{value}{unit_after}");
    }
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let power_of_prefix = 3 * exponent.div_euclid(3);
    if !is_number
        && has_prefixes(unit)
        && let Some(prefix) = si_prefix(power_of_prefix)
    {
        let number = shifted(mantissa, exponent - power_of_prefix);
        return format!("{number} {prefix}{unit}");
    }
    format!("{}{unit_after}", decimal(mantissa, exponent))
}

/// Formats a mantissa times a power of ten. The text has an exponent only if the number is much
/// smaller or larger than one.
fn decimal(mantissa: &str, exponent: i32) -> String {
    match exponent {
        -3..6 => shifted(mantissa, exponent),
        _ => format!("{}e{exponent}", trimmed(mantissa)),
    }
}

/// Formats a mantissa times a power of ten without an exponent and without trailing zeros. The
/// mantissa has one digit before the decimal point.
fn shifted(mantissa: &str, power: i32) -> String {
    let sign = if mantissa.starts_with('-') { "-" } else { "" };
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    // If the decimal point comes before the first digit, zeros are put before the digits. If the
    // decimal point comes after the last digit, zeros are appended.
    let zeros_before = usize::try_from(-power).unwrap_or(0);
    let zeros_after = usize::try_from(power + 1 - digits.len() as i32).unwrap_or(0);
    let digits = "0".repeat(zeros_before) + &digits + &"0".repeat(zeros_after);
    let digits_before_point = usize::try_from(power + 1).unwrap_or(1).max(1);
    let (whole, fraction) = digits.split_at(digits_before_point);
    trimmed(&format!("{sign}{whole}.{fraction}"))
}

/// Removes trailing zeros after a decimal point, and the decimal point if no digits remain after
/// it.
fn trimmed(number: &str) -> String {
    if number.contains('.') {
        number
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_string()
    } else {
        number.to_string()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn an_uncertainty_determines_the_digits_of_a_value() {
        for (value, uncertainty, text) in [
            (50.0512e-3, 0.13e-3, "50.05 mJ/m²"),
            (-7.577_123_456e-6, 4.3e-11, "-7.577123 µm"),
            (5.0, 13.0, "5 m"),
            (0.3, 13.0, "0 m"),
            (0.0, 1.0, "0 m"),
            (99.96, 1.0, "100 m"),
            (1.234_56, 0.0, "1.235 m"),
            (1.234_56, f64::INFINITY, "1.235 m"),
        ] {
            let unit = text
                .split_once(' ')
                .unwrap()
                .1
                .trim_start_matches(['m', 'µ']);
            let unit = if unit.is_empty() { "m" } else { unit };
            assert_eq!(format_within(value, uncertainty, unit), text);
        }
    }

    #[test]
    fn what_people_type_is_read() {
        for (unit, all) in [
            (
                "Pa",
                "2.5 MPa = 2.5e6; 2.5e6 = 2.5e6; 2.5M = 2.5e6; 2 E = 2e18; 2EPa = 2e18; 2E3Pa = 2e3",
            ),
            (
                "m",
                "10 µm = 1e-5; 10um = 1e-5; 10 μm = 1e-5; 5cm = 0.05; 50m = 50; 50 mm = 0.05",
            ),
            ("m", "0e99999999999 km = 0; 1e-99999999999 nm = 0"),
            (
                "J/m²",
                "50m = 0.05; 50 mJ/m2 = 0.05; 50 mJ/m^2 = 0.05; 50 mN/m = 0.05; 1e-3 = 1e-3",
            ),
            ("N", "-20 uN = -20e-6"),
            (
                "1",
                "+3 = 3; .5 = 0.5; 5. = 5; 80 % = 0.8; 0.1% = 0.001; 16k = 16000; 64Ki = 65536; 3Mi = 3145728; 3Gi = 3221225472",
            ),
            ("rad", " 45 °  = 0.7853981633974483; 100 mrad = 0.1"),
            ("m^(1−n)", "3e5 = 3e5; 3 m^(1−n) = 3"),
        ] {
            for (text, value) in all.split("; ").map(|row| row.split_once(" = ").unwrap()) {
                assert_eq!(
                    parse_quantity(text, unit),
                    Ok(value.parse().unwrap()),
                    "{text} {unit}"
                );
            }
        }
    }

    #[test]
    fn a_number_alone_takes_the_unit_that_is_shown() {
        for row in [
            "50|= 4.356 mJ/m²|50 mJ/m²",
            " -5e1 |100 µm|-5e1 µm",
            "50m|4.356 mJ/m²|50m",
            "5 nm|100 µm|5 nm",
            "touch|10 µN|touch",
            "0.8|0.7|0.8",
        ] {
            let [typed, shown, read] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            assert_eq!(in_unit(typed, unit_of(shown)), read, "{row}");
        }
    }

    #[test]
    fn what_is_no_quantity_is_refused() {
        for (unit, texts) in [
            ("m", "|m|1 Pa"),
            ("1", "x|1..2|--1|−1|NaN|inf|1e400|1e99999999999|1 2|1 k1|é1"),
            ("Pa", "1 mpa|1 kk|1e|1e2147483647 k"),
            ("m^(1−n)", "1k"),
        ] {
            assert!(
                texts
                    .split('|')
                    .all(|text| parse_quantity(text, unit).is_err()),
                "{unit}"
            );
        }
        for (text, unit, message) in [
            ("2 kg", "m", "kg is not a unit of length: use m, mm, µm, nm"),
            (
                "1 N/m2",
                "J/m²",
                "N/m2 is not a unit of energy per area: use J/m², mJ/m², N/m, mN/m",
            ),
            (
                "5 ‰",
                "1",
                "‰ is not a prefix of a number: use k, M, G, Ki, Mi, Gi, %",
            ),
            ("1k", "m^(1−n)", "k is not the unit m^(1−n)"),
            (
                "ten",
                "N",
                "\"ten\" is not a number, such as 1.0e-3, 2.5 mN or 2.5kN",
            ),
            ("1e400", "1", "1e400 is too large"),
        ] {
            assert_eq!(parse_quantity(text, unit).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn quantities_are_written_as_people_read_them() {
        for (unit, all) in [
            ("Pa", "2.67e6 = 2.67 MPa; 2.666666e6 = 2.667 MPa"),
            (
                "m",
                "1e-7 = 100 nm; 1e-4 = 100 µm; 999.99e-9 = 1 µm; 1e-30 = 1e-30 m; 1 = 1 m",
            ),
            ("J/m²", "0.05 = 50 mJ/m²"),
            ("N", "0 = 0 N; -2.5e-5 = -25 µN"),
            ("1", "0.7 = 0.7; 16384 = 16380; 1e-6 = 1e-6; 2.5e7 = 2.5e7"),
            ("m^(1−n)", "3e5 = 300000 m^(1−n)"),
        ] {
            for (value, text) in all.split("; ").map(|row| row.split_once(" = ").unwrap()) {
                assert_eq!(format_quantity(value.parse().unwrap(), unit), text);
            }
        }
    }

    proptest! {
        #[test]
        fn all_digits_are_read_back(bits in any::<u64>(), decades in -30..30_i32, size in 1.0..10.0_f64) {
            for value in [f64::from_bits(bits), size * 10_f64.powi(decades), -size].into_iter().filter(|v| v.is_finite()) {
                for unit in ["Pa", "m", "J/m²", "N", "N/m", "rad", "1", "m^(1−n)"] {
                    let text = exact_quantity(value, unit);
                    prop_assert_eq!(parse_quantity(&text, unit), Ok(value), "{}", text);
                }
            }
        }
    }

    #[test]
    fn every_unit_of_the_table_is_understood() {
        for dimension in DIMENSIONS {
            for unit in dimension.proposed.split(", ") {
                let typed = format!("1 {unit}");
                assert!(parse_quantity(&typed, dimension.unit).is_ok(), "{typed}");
            }
        }
    }

    /// The power of ten of each SI prefix is three times its place in the list of prefixes, counted
    /// from the prefix for one (`_`).
    #[test]
    fn prefixes_are_powers_of_a_thousand() {
        for (place, prefix) in "y z a f p n µ m _ k M G T P E".split(' ').enumerate() {
            let prefix = prefix.trim_matches('_');
            let value: f64 = format!("1e{}", 3 * (place as i32 - 8)).parse().unwrap();
            assert_eq!(parse_quantity(&format!("1 {prefix}Pa"), "Pa"), Ok(value));
            assert_eq!(format_quantity(value, "Pa"), format!("1 {prefix}Pa"));
        }
    }
}
