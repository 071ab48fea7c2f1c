//! The screen in ASCII, for terminals, fonts and files limited to ASCII.

use super::{Glyph, dots, glyphs};
use ratatui::buffer::{Buffer, Cell, CellDiffOption};
use std::sync::LazyLock;

/// ASCII characters and their dots: one letter for each of four rows, from above: `L` left, `R` right,
/// `B` both, `0` none. Of two equally near characters the first is taken: those that draw lines precede
/// those that fill. The marks on a curve, `^`, `v`, `*`, `o` and `@`, are left out.
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

/// The character nearest to each pattern of dots, with the fewest differences.
static NEAREST: LazyLock<[char; 256]> = LazyLock::new(|| {
    let shapes: Vec<(char, u8)> = SHAPES
        .iter()
        .flat_map(|(character, shapes)| shapes.iter().map(|shape| (*character, bits(shape))))
        .collect();
    std::array::from_fn(|pattern| {
        let nearest = shapes.iter().min_by_key(|(_, shape)| (usize::from(*shape) ^ pattern).count_ones());
        nearest.filter(|_| pattern != 0).map_or(' ', |(character, _)| *character)
    })
});

/// The dots of a shape.
fn bits(shape: &str) -> u8 {
    let rows = shape.bytes().map(|row| match row {
        b'L' => 1,
        b'R' => 2,
        b'B' => 3,
        _ => 0,
    });
    rows.rev().fold(0, |bits, row| bits << 2 | row)
}

/// Replacements of characters. Greek letters become letters that look or sound like them.
const ALIKE: [(char, &str); 62] = [
    (' ', "\u{a0}\u{2007}\u{2009}\u{202f}"),
    ('^', "▲△↑⌃"),
    ('v', "▼▽↓⌄νυ▾"),
    ('>', "▸▶►›»→⟩〉≥⇒"),
    ('<', "◂◀◄‹«←⟨〈≤⇐"),
    ('*', "◆★☆•∗⋆"),
    ('o', "○◇◌◦°οθ"),
    ('@', "●◉◎"),
    ('#', "■▓█▉▊"),
    ('+', "▪▫□±┌┐└┘├┤┬┴┼"),
    ('_', "▁▄"),
    ('.', "·…⋅∙"),
    (':', "░¦"),
    ('%', "▒"),
    ('-', "─−–—‐‑‒―⁻₋"),
    ('~', "∓≈≃∼∝≅"),
    ('=', "≡≠₌⁼"),
    ('/', "╱÷⁄∕"),
    ('\\', "╲"),
    ('x', "×╳✕✗ξχ"),
    ('\'', "′‘’ʹ"),
    ('"', "▀″“”"),
    ('(', "⁽₍"),
    (')', "⁾₎"),
    ('|', "│┊▋▌▍▎▏▕∣‖"),
    ('0', "⁰₀"),
    ('1', "¹₁"),
    ('2', "²₂"),
    ('3', "³₃"),
    ('4', "⁴₄"),
    ('5', "⁵₅"),
    ('6', "⁶₆"),
    ('7', "⁷₇"),
    ('8', "⁸₈∞"),
    ('9', "⁹₉"),
    ('V', "∇√"),
    ('D', "Δ"),
    ('d', "δ∂"),
    ('G', "Γ"),
    ('g', "γ"),
    ('S', "Σ∑∫"),
    ('s', "σς"),
    ('P', "ΠΨ"),
    ('p', "πψ"),
    ('O', "ΩΘ"),
    ('w', "ω"),
    ('L', "Λ"),
    ('l', "λℓ"),
    ('F', "Φ"),
    ('f', "φϕ"),
    ('a', "α"),
    ('b', "β"),
    ('e', "εϵ"),
    ('h', "ηℎ"),
    ('i', "ι"),
    ('k', "κϰ"),
    ('n', "ⁿₙ"),
    ('r', "ρ"),
    ('t', "τ"),
    ('u', "µμ"),
    ('z', "ζ"),
    ('X', "Ξ"),
];

/// Latin letters with marks, and the letters under the marks.
const MARKED: [(&str, &str); 2] = [
    ("ÀÁÂÃÄÅÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝ", "AAAAAACEEEEIIIINOOOOOOUUUUY"),
    ("àáâãäåçèéêëìíîïñòóôõöøùúûüýÿ", "aaaaaaceeeeiiiinoooooouuuuyy"),
];

/// Replaces all symbols by printable ASCII. Every cell stays in place: behind the replacement of a wide
/// character is a blank. Curves of dots become the characters with the nearest shapes, and no dot is lost
/// altogether. `±` before a blank becomes `+-`; a symbol without a substitute becomes `?`.
pub fn to_ascii(buffer: &mut Buffer) {
    let of_two = |(sign, next): (&Cell, &Cell)| sign.symbol() == "±" && next.symbol() == " ";
    let width = usize::from(buffer.area.width);
    let pairs = buffer.content.iter().zip(buffer.content.iter().skip(1)).enumerate();
    let on_one_row = pairs.filter(|(index, pair)| (index + 1) % width.max(1) != 0 && of_two(*pair));
    let behind: Vec<usize> = on_one_row.map(|(index, _)| index + 1).collect();
    behind.into_iter().for_each(|index| {
        buffer.content[index].set_char('-');
    });
    let changes: Vec<(u16, u16, u16, char)> = glyphs(buffer)
        .filter(|glyph| glyph.cell.symbol().as_bytes() != [b' '] && needs_change(glyph))
        .map(|glyph| (buffer.area.x + glyph.column, buffer.area.y + glyph.row, glyph.width, of_glyph(&glyph)))
        .collect();
    for (x, y, width, character) in changes {
        let Some(cell) = buffer.cell_mut((x, y)) else { continue };
        cell.set_char(character);
        if matches!(cell.diff_option, CellDiffOption::ForcedWidth(_)) {
            cell.set_diff_option(CellDiffOption::None);
        }
        let mut blank = cell.clone();
        blank.set_char(' ');
        for x in x + 1..x + width {
            if let Some(cell) = buffer.cell_mut((x, y)) {
                cell.clone_from(&blank);
            }
        }
    }
}

/// Returns true if a symbol is anything but one printable ASCII character in one cell.
fn needs_change(glyph: &Glyph<'_>) -> bool {
    let symbol = glyph.cell.symbol();
    symbol.len() != 1 || glyph.width != 1 || symbol.bytes().any(|byte| byte.is_ascii_control())
}

/// ASCII substitute of a symbol. Marks over a letter vanish.
fn of_glyph(glyph: &Glyph<'_>) -> char {
    match glyph.symbol().chars().next() {
        // A narrow substitute would not fill the cells of a wide character.
        Some(character) if glyph.width == 1 || character == ' ' => of_character(character),
        _ => '?',
    }
}

/// ASCII substitute of a character.
fn of_character(character: char) -> char {
    if matches!(character, ' '..='~') {
        return character;
    }
    if let Some(dots) = dots(character) {
        return NEAREST[usize::from(dots)];
    }
    let alike = ALIKE.iter().find(|(_, characters)| characters.contains(character));
    let marked = || {
        let plain = |(marked, plain): &(&str, &str)| {
            let place = marked.chars().position(|other| other == character)?;
            plain.chars().nth(place)
        };
        MARKED.iter().find_map(plain)
    };
    alike.map(|(plain, _)| *plain).or_else(marked).unwrap_or('?')
}

#[cfg(test)]
mod tests {
    use super::super::text::text;
    use super::*;
    use proptest::prelude::*;
    use ratatui::layout::Rect;
    use ratatui::style::{Color, Style};
    use ratatui::symbols::braille::BRAILLE;
    use std::num::NonZeroU16;

    fn ascii(rows: &str) -> String {
        let mut buffer = Buffer::with_lines(rows.lines());
        to_ascii(&mut buffer);
        text(&buffer)
    }

    #[test]
    fn no_dot_is_lost() {
        for (place, &character) in BRAILLE.iter().enumerate() {
            let plain = of_character(character);
            assert!(plain.is_ascii_graphic() || plain == ' ', "{character} {plain:?}");
            assert_eq!(plain == ' ', place == 0, "{character} {plain:?}");
        }
    }

    #[test]
    fn shapes_are_their_own_nearest() {
        for (character, shapes) in SHAPES {
            for shape in shapes {
                assert_eq!(NEAREST[usize::from(bits(shape))], character, "{shape}");
            }
        }
        assert_eq!(bits("L0RB"), 0b11_10_00_01);
    }

    #[test]
    fn no_other_shape_is_nearer() {
        let all = || SHAPES.iter().flat_map(|(one, shapes)| shapes.iter().map(|shape| (*one, bits(shape))));
        for pattern in 1..=u8::MAX {
            let far = |bits: u8| (bits ^ pattern).count_ones();
            let taken = NEAREST[usize::from(pattern)];
            let nearest = all().filter(|(one, _)| *one == taken).map(|(_, bits)| far(bits)).min();
            assert_eq!(nearest, all().map(|(_, bits)| far(bits)).min(), "{pattern:08b} {taken}");
        }
    }

    #[test]
    fn curves_read_as_curves() {
        let drawn = "⠒⠒⠒⠒⠒⠒ ⠒ ⠒ ⠒ ⠐⠂⠐⠂\n⣀⣀⣀⡠⠤⠔⠒⠉⠉⠒⠢⢄\n⡇⢸⡇⡜⠎⢣⢱⠆⠰⣿⣶";
        assert_eq!(ascii(drawn), "------ - - - ''''\n___.---\"\"--.\n|||//\\\\::##\n");
    }

    #[test]
    fn frames_marks_and_letters_have_likenesses() {
        let drawn = "┌─┬┐\n│ ┊╱╲╳\n▲▼◆○●■▪·▸›…•\n↑↓←→⟨∇z⟩κγνΔδµμπ²³⁻×−–′\n▏▎▍▌▋▊▉█▁▄▀░▒▓\nnaïve Å";
        assert_eq!(
            ascii(drawn),
            "+-++\n| |/\\x\n^v*o@#+.>>.*\n^v<><Vz>kgvDduup23-x--'\n|||||###__\":%#\nnaive A\n"
        );
    }

    #[test]
    fn no_character_has_two_meanings() {
        let mut all: Vec<char> = ALIKE.iter().flat_map(|(_, characters)| characters.chars()).collect();
        all.extend(MARKED.iter().flat_map(|(marked, _)| marked.chars()));
        for (marked, plain) in MARKED {
            assert_eq!(marked.chars().count(), plain.len());
        }
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        for character in all {
            assert!(dots(character).is_none(), "{character}");
            assert_ne!(of_character(character), '?', "{character}");
        }
        assert_eq!(of_character('☃'), '?');
    }

    #[test]
    fn cells_stay_where_they_are() {
        let mut buffer = Buffer::empty(Rect::new(2, 1, 12, 1));
        buffer.set_string(2, 1, "漢e\u{301}字Ａx", Style::new().fg(Color::Red));
        buffer[(3, 1)].set_symbol("!");
        let two = CellDiffOption::ForcedWidth(NonZeroU16::new(2).unwrap());
        buffer[(10, 1)].set_symbol("\u{1b}[7m").set_diff_option(two);
        buffer[(12, 1)].set_symbol("\u{301}");
        buffer[(13, 1)].set_symbol("\n");
        to_ascii(&mut buffer);
        let symbols: Vec<&str> = buffer.content.iter().map(|cell| cell.symbol()).collect();
        assert_eq!(symbols, ["?", " ", "e", "?", " ", "?", " ", "x", " ", " ", " ", " "]);
        assert!(buffer.content[..8].iter().all(|cell| cell.fg == Color::Red));
        assert_eq!(buffer[(10, 1)].diff_option, CellDiffOption::None);
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
