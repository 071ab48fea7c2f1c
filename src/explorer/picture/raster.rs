//! The shapes of characters that represent dots or parts of a cell.

use ratatui::symbols::pixel::{OCTANTS, QUADRANTS, SEXTANTS};

/// Squares across a cell, divisible into halves and eighths.
pub const COLUMNS: u32 = 8;
/// Squares down a cell, divisible into halves, thirds, quarters and eighths.
pub const ROWS: usize = 24;

/// The part of a cell that a character fills, row by row; bit `i` is column `i` from the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Raster(pub [u8; ROWS]);

impl Raster {
    /// The whole cell.
    pub const FULL: Raster = Raster([u8::MAX; ROWS]);

    /// A part made of blocks, two across and `rows` down, bits row by row from the upper left.
    fn of_blocks(bits: usize, rows: usize) -> Self {
        Raster(std::array::from_fn(|row| {
            let pair = bits >> (2 * (row * rows / ROWS));
            [0, 0x0f, 0xf0, 0xff][pair & 3]
        }))
    }

    /// So many eighths of the cell, from above.
    fn upper(eighths: usize) -> Self {
        Raster(std::array::from_fn(|row| if row * 8 < eighths * ROWS { u8::MAX } else { 0 }))
    }

    /// So many eighths of the cell, from the left.
    fn left(eighths: u32) -> Self {
        Raster([u8::MAX.checked_shr(COLUMNS - eighths).unwrap_or(0); ROWS])
    }

    /// The rest of the cell.
    fn rest(self) -> Self {
        Raster(self.0.map(|row| !row))
    }

    /// The dots of the raster, in the order of [`dots`]: those half covered or more; without such, those
    /// covered most.
    pub fn dots(self) -> u8 {
        let covered: [u32; 8] = std::array::from_fn(|dot| {
            let half = if dot % 2 == 0 { 0x0f } else { 0xf0 };
            self.0.iter().skip(dot / 2 * ROWS / 4).take(ROWS / 4).map(|row| (row & half).count_ones()).sum()
        });
        let half = COLUMNS / 2 * ROWS as u32 / 8;
        let most = covered.iter().copied().max().unwrap_or(0);
        let least = most.min(half).max(1);
        (0..8).filter(|&dot| covered[dot] >= least).fold(0, |bits, dot| bits | 1 << dot)
    }
}

/// The dots of a Braille pattern, two across and four down, bits row by row from the upper left.
pub fn dots(character: char) -> Option<u8> {
    /// Braille numbers three dots down each side; the lowest row came later.
    const PLACES: [u8; 8] = [0, 2, 4, 1, 3, 5, 6, 7];
    let pattern = u32::from(character).checked_sub(0x2800).and_then(|bits| u8::try_from(bits).ok())?;
    let dots = PLACES.iter().enumerate().filter(|(bit, _)| pattern >> bit & 1 == 1);
    Some(dots.fold(0, |bits, (_, place)| bits | 1 << place))
}

/// The part of a cell that a block character fills.
pub fn blocks(character: char) -> Option<Raster> {
    /// Eighths of the characters that Unicode added later, beside the halves.
    const LATER: [u8; 5] = [2, 3, 5, 6, 7];
    let place = |first: char| (u32::from(character) - u32::from(first)) as usize;
    let among = |all: &[char]| all.iter().position(|&other| other == character);
    Some(match character {
        '▀' => Raster::upper(4),
        '▁'..='▇' => Raster::upper(7 - place('▁')).rest(),
        '█' => Raster::FULL,
        '▉'..='▏' => Raster::left(7 - place('▉') as u32),
        '▐' => Raster::left(4).rest(),
        '▔' => Raster::upper(1),
        '▕' => Raster::left(7).rest(),
        '\u{1fb82}'..='\u{1fb86}' => Raster::upper(LATER[place('\u{1fb82}')].into()),
        '\u{1fb87}'..='\u{1fb8b}' => Raster::left(8 - u32::from(LATER[place('\u{1fb87}')])).rest(),
        '▖'..='▟' => Raster::of_blocks(among(&QUADRANTS)?, 2),
        '\u{1fb00}'..='\u{1fb3b}' => Raster::of_blocks(among(&SEXTANTS)?, 3),
        // Octants fill gaps between other blocks of characters.
        '\u{10000}'.. => Raster::of_blocks(among(&OCTANTS)?, 4),
        _ => return None,
    })
}

/// Quarters of its cell that a shade covers.
pub fn shade(character: char) -> Option<u8> {
    match character {
        '░' => Some(1),
        '▒' => Some(2),
        '▓' => Some(3),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::symbols::braille::BRAILLE;
    use ratatui::symbols::{bar, block, half_block};

    #[test]
    fn braille_dots_are_those_that_were_drawn() {
        for (drawn, character) in BRAILLE.into_iter().enumerate() {
            assert_eq!(dots(character), Some(drawn as u8), "{character}");
        }
        assert_eq!((dots('\u{27ff}'), dots('\u{2900}'), dots('x')), (None, None, None));
    }

    #[test]
    fn blocks_fill_what_was_drawn() {
        for (all, rows) in [(&QUADRANTS[..], 2), (&SEXTANTS[..], 3), (&OCTANTS[..], 4)] {
            for (drawn, &character) in all.iter().enumerate().skip(1) {
                let raster = blocks(character).unwrap_or_else(|| panic!("{character:?}"));
                assert_eq!(raster, Raster::of_blocks(drawn, rows), "{character} {drawn:b}");
            }
        }
        for (drawn, &character) in OCTANTS.iter().enumerate().skip(1) {
            assert_eq!(blocks(character).unwrap().dots(), drawn as u8, "{character}");
        }
    }

    #[test]
    fn bars_fill_their_eighths() {
        let area = |symbol: &str| {
            let raster = blocks(symbol.chars().next().unwrap()).unwrap();
            raster.0.iter().map(|row| row.count_ones()).sum::<u32>() / 24
        };
        let up = bar::NINE_LEVELS;
        let across = block::NINE_LEVELS;
        assert_eq!([up.one_eighth, up.one_quarter, up.three_eighths, up.half].map(area), [1, 2, 3, 4]);
        assert_eq!([up.five_eighths, up.three_quarters, up.seven_eighths, up.full].map(area), [5, 6, 7, 8]);
        assert_eq!([across.one_eighth, across.one_quarter, across.three_eighths].map(area), [1, 2, 3]);
        assert_eq!([across.half, across.five_eighths, across.three_quarters].map(area), [4, 5, 6]);
        assert_eq!(["🮂", "🮃", "🮄", "🮅", "🮆"].map(area), [2, 3, 5, 6, 7]);
        assert_eq!(["🮇", "🮈", "🮉", "🮊", "🮋", "▐", "▕", "▔"].map(area), [2, 3, 5, 6, 7, 4, 1, 1]);
        let [upper, lower] = [half_block::UPPER, half_block::LOWER].map(|one| blocks(one).unwrap());
        assert_eq!(upper, lower.rest());
        assert_eq!((blocks('▏').unwrap().0, blocks('▕').unwrap().0), ([1; ROWS], [0x80; ROWS]));
        assert_eq!(blocks('▁').unwrap().0[20..], [0, 0xff, 0xff, 0xff]);
    }

    #[test]
    fn no_part_of_a_cell_is_without_a_dot() {
        let thin = |symbol| blocks(symbol).unwrap().dots();
        assert_eq!(['▏', '▕', '▁', '▔'].map(thin), [0b0101_0101, 0b1010_1010, 0b1100_0000, 0b11]);
        assert_eq!(Raster([0; ROWS]).dots(), 0);
        assert_eq!(Raster::FULL.dots(), 0xff);
    }

    #[test]
    fn other_characters_are_no_blocks() {
        assert_eq!([' ', 'a', '─', '漢', '⠿', '🙂'].map(blocks), [None; 6]);
        assert_eq!(['░', '▒', '▓', '█'].map(shade), [Some(1), Some(2), Some(3), None]);
    }
}
