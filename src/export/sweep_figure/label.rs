//! Words and numbers on figures: symbols with indices, SI prefixes.

use crate::study::figure::{FigureAxis, FigureQuantity};
use crate::text::for_picture;

/// Stand around an index in text that is to be typeset. They are no characters of any script.
const INDEX: [char; 2] = ['\u{e000}', '\u{e001}'];
/// The same for an exponent.
const EXPONENT: [char; 2] = ['\u{e002}', '\u{e003}'];
/// The same for a symbol, which is set in italics.
const SYMBOL: [char; 2] = ['\u{e004}', '\u{e005}'];

/// A symbol ready to be typeset: its letters in italics, and what follows a `_` below the line.
pub(super) fn symbol(text: &str) -> String {
    let mut set = String::new();
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        if character == '_' {
            set.push(INDEX[0]);
            // As far as letters go, and beyond a comma when one follows it: `a,max`.
            while let Some(next) = characters.next_if(|next| next.is_alphanumeric() || *next == ',') {
                set.push(next);
            }
            set.push(INDEX[1]);
        } else if character.is_alphabetic() {
            set.extend([SYMBOL[0], character, SYMBOL[1]]);
        } else {
            set.push(if character == '-' { '−' } else { character });
        }
    }
    set
}

/// Statements such as `H = 0.3, κ = 2`, ready to be typeset: what stands before each `=`.
pub(super) fn symbol_before(text: &str) -> String {
    let set = |part: &str| match part.split_once(" = ") {
        Some((before, after)) => format!("{} = {after}", symbol(before)),
        None => part.to_owned(),
    };
    text.split(", ").map(set).collect::<Vec<_>>().join(", ")
}

/// Foreign words ready to be typeset: without the characters that mark symbols, indices and exponents.
pub(super) fn foreign(text: &str) -> String {
    for_picture(text).replace([INDEX, EXPONENT, SYMBOL].as_flattened(), "\u{fffd}")
}

/// A power of ten ready to be typeset.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let exponent = exponent.to_string().replace('-', "−");
    format!("10{}{exponent}{}", EXPONENT[0], EXPONENT[1])
}

/// A picture in which indices, exponents and symbols are typeset.
pub(super) fn typeset(svg: &str) -> String {
    let down = "<tspan dy=\"0.28em\" font-size=\"72%\">";
    let up = "<tspan dy=\"-0.5em\" font-size=\"72%\">";
    // Back to the line, by as much of the larger letters.
    let from_below = "</tspan><tspan dy=\"-0.2016em\">&#8203;</tspan>";
    let from_above = "</tspan><tspan dy=\"0.36em\">&#8203;</tspan>";
    svg.replace(INDEX[0], down)
        .replace(INDEX[1], from_below)
        .replace(EXPONENT[0], up)
        .replace(EXPONENT[1], from_above)
        .replace(SYMBOL[0], "<tspan font-style=\"italic\">")
        .replace(SYMBOL[1], "</tspan>")
}

/// The width of text in units of its size, about: digits are 0.56 wide in the usual fonts.
pub(super) fn width(text: &str) -> f64 {
    let mut share = 1.0;
    let mut width = 0.0;
    for character in text.chars() {
        match character {
            c if c == INDEX[0] || c == EXPONENT[0] => share = 0.72,
            c if c == INDEX[1] || c == EXPONENT[1] => share = 1.0,
            c if SYMBOL.contains(&c) => {}
            'i' | 'j' | 'l' | '.' | ',' | ' ' | 't' | 'f' | '(' | ')' | '/' | '|' => width += 0.33 * share,
            'm' | 'w' | 'M' | 'W' => width += 0.9 * share,
            c if c.is_uppercase() => width += 0.7 * share,
            _ => width += 0.58 * share,
        }
    }
    width
}

/// A unit with the SI prefix that suits numbers up to `largest`, and what numbers are divided by for it.
pub(super) fn prefixed(unit: &str, largest: f64) -> (f64, String) {
    const PREFIXES: [(&str, i32); 9] =
        [("f", -15), ("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9)];
    if matches!(unit, "" | "1") {
        return (1.0, String::new());
    }
    if !(["N", "m", "J", "Pa", "J/m²", "N/m", "s"].contains(&unit) && largest > 0.0 && largest.is_finite()) {
        return (1.0, unit.into());
    }
    // A hair below, so that what is just a thousand by rounding is one of the next.
    let power = (largest * (1.0 + 1e-9)).log10().floor() as i32;
    let (prefix, power) = PREFIXES.into_iter().rfind(|(_, least)| power >= *least).unwrap_or(PREFIXES[0]);
    (10_f64.powi(power), format!("{prefix}{unit}"))
}

/// The parts of a label: name, symbol, unit with its prefix.
fn parts(name: &str, symbol: &str, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    match (name, symbol) {
        ("", symbol) => format!("{symbol}{unit}"),
        (name, "") => format!("{name}{unit}"),
        (name, symbol) => format!("{name} {symbol}{unit}"),
    }
}

/// Label of an axis, to be typeset, with this unit.
pub(super) fn axis_label(axis: &FigureAxis, unit: &str) -> String {
    parts(&axis.name, &symbol(&axis.symbol), unit)
}

/// Label of a quantity, to be typeset, with this unit: its symbol, or its name where it has none.
pub(super) fn quantity_label(quantity: &FigureQuantity, unit: &str) -> String {
    let name = if quantity.symbol.is_empty() { &quantity.name } else { "" };
    parts(name, &symbol(&quantity.symbol), unit)
}

/// What is to be typeset as plain text: `F_a`, `10⁻³`.
pub(super) fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut raised = false;
    for character in text.chars() {
        match character {
            c if c == INDEX[0] => plain.push('_'),
            c if c == EXPONENT[0] => raised = true,
            c if c == EXPONENT[1] => raised = false,
            c if c == INDEX[1] || SYMBOL.contains(&c) => {}
            '−' if raised => plain.push('⁻'),
            c if raised => {
                let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
                plain.push(c.to_digit(10).map_or(c, |digit| digits[digit as usize]));
            }
            c => plain.push(c),
        }
    }
    plain
}

/// A number in its first three digits, as short as that can be.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { value.to_string() };
    }
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let text =
        if (1e-3..1e5).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") };
    text.replace('-', "−")
}

/// A value of an axis with what it is a value of, to be typeset: `H = 0.3`.
pub(super) fn value_label(axis: &FigureAxis, value: f64) -> String {
    let (divisor, unit) = prefixed(&axis.unit, value.abs());
    let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
    // A number of springs is told whole.
    let whole = unit.is_empty() && value.fract() == 0.0 && value.abs() < 1e8;
    let value = if whole { number(value, 1.0) } else { short(value / divisor) };
    if axis.symbol.is_empty() {
        format!("{} {value}{unit}", axis.name)
    } else {
        format!("{} = {value}{unit}", symbol(&axis.symbol))
    }
}

/// A number with as many decimals as `step` has.
pub(super) fn number(value: f64, step: f64) -> String {
    let decimals = (-step.abs().log10() - 1e-9).ceil().clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|digit| matches!(digit, '0' | '.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_stand_below_the_line() {
        let set = typeset(&symbol("F_a(0)/F_a,max"));
        assert_eq!(set.matches("font-size=\"72%\">a</tspan>").count(), 1, "{set}");
        assert_eq!(set.matches("font-size=\"72%\">a,max</tspan>").count(), 1, "{set}");
        assert!(!set.contains('_') && set.matches("italic").count() == 2, "{set}");
        assert_eq!(typeset(&power_of_ten(-3)).matches(">−3</tspan>").count(), 1);
        assert!(!typeset(&symbol("κ")).chars().any(|c| ('\u{e000}'..='\u{e00f}').contains(&c)));
    }

    #[test]
    fn prefixes_suit_the_largest_number() {
        assert_eq!(prefixed("N", 2.5e-5), (1e-6, "µN".into()));
        assert_eq!(prefixed("N", 1e-3), (1e-3, "mN".into()));
        assert_eq!(prefixed("J/m²", 0.05), (1e-3, "mJ/m²".into()));
        assert_eq!(prefixed("Pa", 2e6), (1e6, "MPa".into()));
        assert_eq!(prefixed("N", 1e-18).1, "fN");
        assert_eq!(prefixed("1", 1e-18), (1.0, String::new()));
        assert_eq!(prefixed("rad", 1e-3), (1.0, "rad".into()));
        assert_eq!(prefixed("N", 0.0), (1.0, "N".into()));
    }

    #[test]
    fn plain_text_says_the_same() {
        assert_eq!(plain(&symbol("F_a(0)/F_a,max")), "F_a(0)/F_a,max");
        assert_eq!(plain(&power_of_ten(-12)), "10⁻¹²");
        assert_eq!(
            [0.0, 0.30000000000000004, 12345.6, 1.5e-6, -2.0].map(short),
            ["0", "0.3", "12300", "1.5e−6", "−2"]
        );
    }

    #[test]
    fn values_of_curves_are_told_whole_where_they_are() {
        let axis = |symbol: &str, unit: &str| FigureAxis {
            name: "points".into(),
            symbol: symbol.into(),
            unit: unit.into(),
            scale: crate::study::figure::AxisScale::Linear,
            values: Vec::new(),
        };
        assert_eq!(plain(&value_label(&axis("N", "1"), 65536.0)), "N = 65536");
        assert_eq!(plain(&value_label(&axis("N", "1"), -2.0)), "N = −2");
        assert_eq!(plain(&value_label(&axis("", "N"), 1.25e-5)), "points 12.5 µN");
        assert_eq!(plain(&value_label(&axis("H", ""), 0.12345)), "H = 0.123");
    }

    #[test]
    fn numbers_have_the_decimals_of_their_step() {
        assert_eq!(number(0.30000000000000004, 0.1), "0.3");
        assert_eq!(number(-0.5, 0.05), "−0.50");
        assert_eq!(number(20.0, 10.0), "20");
        assert_eq!(number(-1e-18, 0.2), "0.0");
    }
}
