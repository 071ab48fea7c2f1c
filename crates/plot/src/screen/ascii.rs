//! Converts a screen to ASCII characters, for terminals, fonts and files that have no other
//! characters.

use super::{Glyph, dots, glyphs};
use ratatui::buffer::{Buffer, Cell};
use std::sync::LazyLock;

/// ASCII characters, each with the patterns of 2 × 4 dots that look like the character. A pattern
/// has one letter for each of the four rows, from above: `L` for the left dot, `R` for the right
/// dot, `B` for both, `0` for none. If a pattern resembles two characters equally, the first one is
/// taken, so characters that look like lines come before characters that fill the cell. The
/// characters `^`, `v`, `*`, `o` and `@` are left out, because they are markers on curves.
const SHAPES: [(char, &[&str]); 15] = [
    ('-', &["0B00", "00B0", "0RL0", "0LR0"]),
    ('|', &["LLLL", "RRRR"]),
    ('/', &["RRLL", "RLL0", "0RRL", "RRL0", "0RLL"]),
    ('\\', &["LLRR", "LRR0", "0LLR", "LLR0", "0LRR"]),
    ('_', &["000B", "00BB"]),
    ('"', &["B000", "BB00"]),
    ('.', &["000L", "000R", "00L0", "00R0", "00RL", "00LR"]),
    ('\'', &["0R00", "R000", "0L00", "RR00", "LL00", "RL00"]),
    ('`', &["L000", "LR00"]),
    (',', &["00LL", "00RR"]),
    (':', &["0LL0", "0RR0", "L0L0", "0L0L", "R0R0", "0R0R"]),
    (';', &["0LLL", "0RRR"]),
    ('=', &["0BB0", "B0B0", "0B0B", "B00B"]),
    ('+', &["LBLL", "LLBL", "RBRR", "RRBR", "LBBL", "RBBR"]),
    ('#', &["BBBB", "BBB0", "0BBB"]),
];

/// For each of the 256 patterns of dots, the most similar character.
static NEAREST: LazyLock<[char; 256]> = LazyLock::new(|| {
    let mut nearest = [' '; 256];
    for (pattern, character) in nearest.iter_mut().enumerate().skip(1) {
        *character = nearest_character(pattern);
    }
    nearest
});

/// Returns the character that differs from a pattern in the smallest number of dots. If there are
/// several such characters, returns the first one in [`SHAPES`].
fn nearest_character(pattern: usize) -> char {
    let mut nearest = ' ';
    let mut fewest = u32::MAX;
    for (character, shapes) in SHAPES {
        for shape in shapes {
            let different = (usize::from(bits(shape)) ^ pattern).count_ones();
            if different < fewest {
                nearest = character;
                fewest = different;
            }
        }
    }
    nearest
}

/// Returns a pattern of dots as bits, row by row from the upper left dot.
fn bits(shape: &str) -> u8 {
    let mut bits = 0;
    for row in shape.bytes().rev() {
        let row = match row {
            b'L' => 1,
            b'R' => 2,
            b'B' => 3,
            _ => 0,
        };
        bits = bits << 2 | row;
    }
    bits
}

/// Table of replacements. Each group of characters between blanks begins with an ASCII character,
/// which replaces the other characters of the group. A Greek letter is replaced by a letter that
/// looks or sounds similar, an accented letter by the letter without accent.
const ALIKE: &str = "^▲△↑⌃ v▼▽↓⌄νυ▾ >▸▶►›»→⟩〉≥⇒ <◂◀◄‹«←⟨〈≤⇐ *◆★☆•∗⋆ o○◌◦°οθ↻ @●◉◎ #■█▉▊▇ &▓ +▪□±┌┐└┘├┤┬┴┼ _▁▂ .·⋅∙ :░¦▃▄ %▒ \
    -▫─−–—‐‑‒―⁻₋ ~…∓≈≃∼∝≅ =≡≠₌⁼ /╱÷⁄∕ \\╲ x◇×╳✕✗ξχ '′‘’ʹ \"▀″“” (⁽₍ )⁾₎ |│┊▋▌▍▎▏▕∣‖❚▅▆ 0⁰₀ 1¹₁ 2²₂ 3³₃ 4⁴₄ 5⁵₅ 6⁶₆ 7⁷₇ \
    8⁸₈∞ 9⁹₉ V∇√ DΔ dδ∂ GΓ gγ SΣ∑∫ sσς PΠΨ pπψ OΩΘ wω LΛ lλℓ FΦ fφϕ aα bβ eεϵ hηℎ iι Kκϰ nⁿₙ rρ tτ uµμ zζ XΞ \
    AÀÁÂÃÄÅ CÇ EÈÉÊË IÌÍÎÏ NÑ OÒÓÔÕÖØ UÙÚÛÜ YÝ aàáâãäå cç eèéêë iìíîï nñ oòóôõöø uùúûü yýÿ";

/// Replaces each symbol on a screen by a similar printable ASCII character in the same cell, or by
/// `?` if there is no similar character.
pub fn to_ascii(buffer: &mut Buffer) {
    let width = usize::from(buffer.area.width).max(1);
    for row in buffer.content.chunks_mut(width) {
        for index in 1..row.len() {
            if row[index - 1].symbol() == "±" && row[index].symbol() == " " {
                row[index].set_char('-');
            }
        }
        for index in 0..row.len() {
            if begins_power_of_ten(row, index) {
                row[index].set_char('e');
            }
        }
    }
    let replaced: Vec<_> = glyphs(buffer)
        .iter()
        .map(|glyph| (glyph.column, glyph.row, glyph.width, of_glyph(glyph)))
        .collect();
    let origin = buffer.area.as_position();
    for (column, row, width, character) in replaced {
        for column in column..column + width {
            buffer[(origin.x + column, origin.y + row)].set_char(' ');
        }
        buffer[(origin.x + column, origin.y + row)].set_char(character);
    }
}

/// Returns true if the cell with the index `zero` is the zero in a power of ten such as `10⁵`. In
/// this case, the zero is replaced by `e`, so that the exponent can be read: `1e5`.
fn begins_power_of_ten(row: &[Cell], zero: usize) -> bool {
    let is = |index: usize, signs: &str| {
        row.get(index)
            .is_some_and(|cell| signs.contains(cell.symbol()))
    };
    if !is(zero, "0") || !is(zero + 1, "⁻⁰¹²³⁴⁵⁶⁷⁸⁹") {
        return false;
    }
    // The 1 before the zero must not be the last digit of a longer number such as 210.
    zero > 0 && is(zero - 1, "1") && (zero == 1 || is(zero - 2, " │┤"))
}

/// Returns the ASCII character for a symbol. Combining marks are dropped.
fn of_glyph(glyph: &Glyph<'_>) -> char {
    match glyph.symbol().chars().next() {
        // A wide character fills two cells. There are no wide ASCII characters, so it becomes `?`.
        Some(character) if glyph.width == 1 || character == ' ' => of_character(character),
        _ => '?',
    }
}

fn of_character(character: char) -> char {
    if matches!(character, ' '..='~') {
        return character;
    }
    if let Some(dots) = dots(character) {
        return NEAREST[usize::from(dots)];
    }
    let alike = ALIKE
        .split_whitespace()
        .find(|alike| alike.contains(character));
    alike.and_then(|alike| alike.chars().next()).unwrap_or('?')
}

#[cfg(test)]
mod tests {

    use super::*;
    use proptest::prelude::*;
    use ratatui::layout::Rect;
    use ratatui::style::{Color, Style};
    use ratatui::symbols::braille::BRAILLE;

    #[test]
    fn no_dot_is_lost() {
        for (place, &character) in BRAILLE.iter().enumerate() {
            let plain = of_character(character);
            assert!(
                plain.is_ascii_graphic() || plain == ' ',
                "{character} {plain:?}"
            );
            assert_eq!(plain == ' ', place == 0, "{character} {plain:?}");
        }
    }

    #[test]
    fn no_character_has_two_meanings() {
        let mut all: Vec<char> = ALIKE
            .split_whitespace()
            .flat_map(|alike| alike.chars().skip(1))
            .collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(
            all.iter()
                .all(|one| dots(*one).is_none() && of_character(*one) != '?')
        );
        assert_eq!(of_character('☃'), '?');
    }

    #[test]
    fn cells_stay_where_they_are() {
        let mut buffer = Buffer::empty(Rect::new(2, 1, 8, 1));
        buffer.set_string(2, 1, "漢e\u{301}字Ａx", Style::new().fg(Color::Red));
        to_ascii(&mut buffer);
        let symbols: Vec<&str> = buffer.content.iter().map(|cell| cell.symbol()).collect();
        assert_eq!(symbols, ["?", " ", "e", "?", " ", "?", " ", "x"]);
        assert_eq!(buffer[(4, 1)].fg, Color::Red);
    }

    #[test]
    fn powers_of_ten_keep_their_exponents() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 24, 1));
        buffer.set_string(0, 0, "10⁻¹⁹ │10⁵ 210⁵ 10 m²", Style::new());
        to_ascii(&mut buffer);
        let text: String = buffer.content.iter().map(|cell| cell.symbol()).collect();
        assert_eq!(text.trim_end(), "1e-19 |1e5 2105 10 m2");
    }

    proptest! {
        #[test]
        fn the_result_is_ascii_and_stays_so(rows in prop::collection::vec("\\PC{0,20}", 1..4)) {
            let mut buffer = Buffer::with_lines(rows.iter().map(String::as_str));
            let before = buffer.clone();
            to_ascii(&mut buffer);
            prop_assert_eq!(buffer.area, before.area);
            for (cell, old) in buffer.content.iter().zip(&before.content) {
                let [byte] = *cell.symbol().as_bytes() else { panic!("{:?}", cell.symbol()) };
                prop_assert!((b' '..=b'~').contains(&byte));
                if old.symbol().len() == 1 && old.symbol() != " " {
                    prop_assert_eq!(cell.symbol(), old.symbol());
                }
            }
            let once = buffer.clone();
            to_ascii(&mut buffer);
            prop_assert_eq!(buffer, once);
        }
    }
}
