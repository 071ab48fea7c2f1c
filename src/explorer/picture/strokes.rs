//! The lines of box-drawing characters.

/// Weight of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// A thin line.
    Light,
    /// A thick line.
    Heavy,
    /// Two thin lines side by side.
    Double,
}

/// The lines from the middle of a cell to its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strokes {
    /// To the left, the right, up and down.
    pub arms: [Option<Weight>; 4],
    /// Number of pieces of each line through the cell; 1 for a whole line.
    pub pieces: u8,
    /// True if the corner is rounded.
    pub round: bool,
}

/// Arms of U+2500 to U+257F, to the left, the right, up and down: 0 none, 1 light, 2 heavy, 3 double.
/// The diagonals have none.
const ARMS: [&[u8; 4]; 128] = [
    b"1100", b"2200", b"0011", b"0022", b"1100", b"2200", b"0011", b"0022", b"1100", b"2200", b"0011",
    b"0022", b"0101", b"0201", b"0102", b"0202", b"1001", b"2001", b"1002", b"2002", b"0110", b"0210",
    b"0120", b"0220", b"1010", b"2010", b"1020", b"2020", b"0111", b"0211", b"0121", b"0112", b"0122",
    b"0221", b"0212", b"0222", b"1011", b"2011", b"1021", b"1012", b"1022", b"2021", b"2012", b"2022",
    b"1101", b"2101", b"1201", b"2201", b"1102", b"2102", b"1202", b"2202", b"1110", b"2110", b"1210",
    b"2210", b"1120", b"2120", b"1220", b"2220", b"1111", b"2111", b"1211", b"2211", b"1121", b"1112",
    b"1122", b"2121", b"1221", b"2112", b"1212", b"2221", b"2212", b"2122", b"1222", b"2222", b"1100",
    b"2200", b"0011", b"0022", b"3300", b"0033", b"0301", b"0103", b"0303", b"3001", b"1003", b"3003",
    b"0310", b"0130", b"0330", b"3010", b"1030", b"3030", b"0311", b"0133", b"0333", b"3011", b"1033",
    b"3033", b"3301", b"1103", b"3303", b"3310", b"1130", b"3330", b"3311", b"1133", b"3333", b"0101",
    b"1001", b"1010", b"0110", b"0000", b"0000", b"0000", b"1000", b"0010", b"0100", b"0001", b"2000",
    b"0020", b"0200", b"0002", b"1200", b"0012", b"2100", b"0021",
];

/// The lines of a box-drawing character of level and upright lines; `None` for any other.
pub fn strokes(character: char) -> Option<Strokes> {
    let place = usize::try_from(u32::from(character).checked_sub(0x2500)?).ok()?;
    let arms = ARMS.get(place)?.map(|digit| match digit {
        b'1' => Some(Weight::Light),
        b'2' => Some(Weight::Heavy),
        b'3' => Some(Weight::Double),
        _ => None,
    });
    let pieces = match character {
        '╌'..='╏' => 2,
        '┄'..='┇' => 3,
        '┈'..='┋' => 4,
        _ => 1,
    };
    let round = matches!(character, '╭'..='╰');
    arms.iter().any(Option::is_some).then_some(Strokes { arms, pieces, round })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::symbols::merge::MergeStrategy;

    const ALL: std::ops::RangeInclusive<char> = '\u{2500}'..='\u{257f}';

    #[test]
    fn lines_are_those_of_the_characters_laid_over_each_other() {
        // ratatui has its own table, for borders that meet.
        let mut compared = 0;
        for (one, other) in ALL.flat_map(|one| ALL.map(move |other| (one, other))) {
            let (Some(first), Some(second)) = (strokes(one), strokes(other)) else { continue };
            let whole = |strokes: Strokes| strokes.pieces == 1 && !strokes.round;
            let [below, above] = [one, other].map(String::from);
            let merged = MergeStrategy::Exact.merge(&below, &above);
            if !whole(first) || !whole(second) || merged == above {
                continue;
            }
            let mut arms = second.arms;
            arms.iter_mut().zip(first.arms).for_each(|(above, below)| *above = above.or(below));
            assert_eq!(strokes(merged.chars().next().unwrap()).unwrap().arms, arms, "{one} {other}");
            compared += 1;
        }
        assert!(compared > 1000, "{compared}");
    }

    #[test]
    fn only_diagonals_have_no_arms() {
        let without: String = ALL.filter(|&character| strokes(character).is_none()).collect();
        assert_eq!(without, "╱╲╳");
        assert_eq!(['a', '▀', '⠿'].map(strokes), [None; 3]);
    }

    #[test]
    fn dashes_and_arcs_differ() {
        let pieces = |character| strokes(character).unwrap().pieces;
        assert_eq!(['─', '╌', '┄', '┈', '┋', '╏', '┇', '╋'].map(pieces), [1, 2, 3, 4, 4, 2, 3, 1]);
        let round = |character| strokes(character).unwrap().round;
        assert_eq!(['╭', '╮', '╯', '╰', '╬', '╴'].map(round), [true, true, true, true, false, false]);
    }
}
