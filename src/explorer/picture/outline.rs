//! Parts of a picture gathered cell by cell and written as the data of one path: adjacent parts are joined.

use super::raster::{COLUMNS, ROWS, Raster};
use super::strokes::{Strokes, Weight};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Write as _};

/// Width of a cell.
pub const WIDTH: u32 = 8;
/// Height of a cell.
pub const HEIGHT: u32 = 16;

/// A length with at most two decimals, without trailing zeros.
pub struct Short(pub f64);

impl Display for Short {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.2}", self.0);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        let (sign, digits) = text.strip_prefix('-').map_or(("", text), |digits| ("-", digits));
        match digits.strip_prefix('0') {
            Some("") => formatter.write_str("0"),
            Some(fraction) => write!(formatter, "{sign}{fraction}"),
            None => formatter.write_str(text),
        }
    }
}

/// Filled parts of cells.
#[derive(Default)]
pub struct Area {
    /// Row of squares, first column and the one behind the last.
    spans: Vec<(u32, u32, u32)>,
}

impl Area {
    /// Fills a part of a cell.
    pub fn fill(&mut self, column: u16, row: u16, raster: Raster) {
        let left = u32::from(column) * COLUMNS;
        let top = u32::from(row) * ROWS as u32;
        for (y, bits) in (top..).zip(raster.0) {
            let mut x = 0;
            while x < COLUMNS {
                let blank = (bits >> x).trailing_zeros();
                x += blank;
                if x < COLUMNS {
                    let filled = (bits >> x).trailing_ones();
                    self.spans.push((y, left + x, left + x + filled));
                    x += filled;
                }
            }
        }
    }

    /// Rectangles that cover the area: left, top, right, bottom. Few, since they extend over cells.
    fn rectangles(mut self) -> Vec<(u32, u32, u32, u32)> {
        self.spans.sort_unstable();
        let mut rows: Vec<(u32, u32, u32)> = Vec::new();
        for (y, left, right) in self.spans {
            match rows.last_mut() {
                Some(last) if last.0 == y && last.2 >= left => last.2 = last.2.max(right),
                _ => rows.push((y, left, right)),
            }
        }
        // Rectangles that reach the last row, by their sides: top and bottom.
        let mut open: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
        let mut done = Vec::new();
        for (y, left, right) in rows {
            let sides = open.entry((left, right)).or_insert((y, y));
            if sides.1 != y {
                done.push((sides.0, left, right, sides.1));
                *sides = (y, y);
            }
            sides.1 = y + 1;
        }
        done.extend(open.into_iter().map(|((left, right), (top, bottom))| (top, left, right, bottom)));
        done.sort_unstable();
        done.into_iter().map(|(top, left, right, bottom)| (left, top, right, bottom)).collect()
    }

    /// The data of the path.
    pub fn path(self) -> String {
        let x = |columns: u32| Short(f64::from(columns * WIDTH) / f64::from(COLUMNS));
        let y = |rows: u32| Short(f64::from(rows * HEIGHT) / ROWS as f64);
        let mut path = String::new();
        for (left, top, right, bottom) in self.rectangles() {
            // Writing to a string does not fail.
            let _ = write!(path, "M{} {}H{}V{}H{}z", x(left), y(top), x(right), y(bottom), x(left));
        }
        path
    }
}

/// Dots, by row and column of dots, two across and four down a cell.
#[derive(Default)]
pub struct Dots(Vec<(u32, u32)>);

impl Dots {
    /// Adds the dots of a Braille pattern.
    pub fn add(&mut self, column: u16, row: u16, dots: u8) {
        for dot in (0..8).filter(|dot| dots >> dot & 1 == 1) {
            self.0.push((u32::from(row) * 4 + dot / 2, u32::from(column) * 2 + dot % 2));
        }
    }

    /// The data of a path with a point for each dot, to be drawn with a round pen.
    pub fn path(mut self) -> String {
        const PITCH: (i64, i64) = (WIDTH as i64 / 2, HEIGHT as i64 / 4);
        self.0.sort_unstable();
        let mut path = String::new();
        let mut last = (0, 0);
        for (row, column) in self.0 {
            let (x, y) = (i64::from(column) * PITCH.0, i64::from(row) * PITCH.1);
            let (x, y) = (x + PITCH.0 / 2, y + PITCH.1 / 2);
            // Short but not zero: a line of no length is not drawn everywhere.
            let _ = if path.is_empty() {
                write!(path, "M{x} {y}h.1z")
            } else {
                write!(path, "m{} {}h.1z", x - last.0, y - last.1)
            };
            last = (x, y);
        }
        path
    }
}

/// Units of a line's ends in one unit of length.
const FINE: i32 = 2;
/// Distance from the middle of a double line to either line.
const APART: i32 = 3;

/// Straight lines and rounded corners. Lengths here are counted in halves.
#[derive(Default)]
pub struct Lines {
    /// Height and both ends.
    level: Vec<(i32, i32, i32)>,
    /// Distance from the left and both ends.
    upright: Vec<(i32, i32, i32)>,
    arcs: String,
}

impl Lines {
    /// Adds a line across cells, at a height of so many units within them.
    pub fn across(&mut self, column: u16, row: u16, width: u16, height: i32) {
        let (left, top) = corner(column, row);
        let right = left + i32::from(width) * WIDTH as i32 * FINE;
        self.level.push((top + height * FINE, left, right));
    }

    /// Adds the lines of one weight of a box-drawing character.
    pub fn add(&mut self, column: u16, row: u16, strokes: &Strokes, weight: Weight) {
        let (left, top) = corner(column, row);
        let half = [WIDTH as i32 * FINE / 2, HEIGHT as i32 * FINE / 2];
        let middle = [left + half[0], top + half[1]];
        if strokes.round {
            self.round(middle, half, strokes);
            return;
        }
        for (arm, _) in strokes.arms.iter().enumerate().filter(|(_, one)| **one == Some(weight)) {
            // Axis and direction of the arm; the arms across it, towards lower and higher coordinates.
            let (axis, sign) = (arm / 2, [-1, 1][arm % 2]);
            let beside = [strokes.arms[2 * (1 - axis)], strokes.arms[2 * (1 - axis) + 1]];
            let through = strokes.arms[arm ^ 1].is_some();
            let doubled = beside.map(|one| one == Some(Weight::Double));
            let offsets: &[i32] = if weight == Weight::Double { &[-APART, APART] } else { &[0] };
            for &offset in offsets {
                // A line ends at the nearer or the farther of two lines across.
                let near =
                    if offset == 0 { doubled[0] && doubled[1] } else { doubled[usize::from(offset > 0)] };
                let start = match near {
                    true if offset != 0 || !through => APART,
                    false if !through && (doubled[0] || doubled[1]) => -APART,
                    _ => 0,
                };
                for (from, to) in pieces(start, half[axis], strokes.pieces) {
                    let (from, to) = (middle[axis] + sign * from, middle[axis] + sign * to);
                    let line = (middle[1 - axis] + offset, from.min(to), from.max(to));
                    if axis == 0 { self.level.push(line) } else { self.upright.push(line) }
                }
            }
        }
    }

    /// Adds a quarter of a circle and the rest of the longer arm.
    fn round(&mut self, [x, y]: [i32; 2], [across, down]: [i32; 2], strokes: &Strokes) {
        let right = if strokes.arms[1].is_some() { 1 } else { -1 };
        let below = if strokes.arms[3].is_some() { 1 } else { -1 };
        let unit = |halves: i32| Short(f64::from(halves) / f64::from(FINE));
        let _ = write!(
            self.arcs,
            "M{} {}V{}Q{} {} {} {}",
            unit(x),
            unit(y + below * down),
            unit(y + below * across),
            unit(x),
            unit(y),
            unit(x + right * across),
            unit(y)
        );
    }

    /// The data of the path.
    pub fn path(self) -> String {
        let unit = |halves: i32| Short(f64::from(halves) / f64::from(FINE));
        let mut path = String::new();
        for (y, from, to) in joined(self.level) {
            let _ = write!(path, "M{} {}H{}", unit(from), unit(y), unit(to));
        }
        for (x, from, to) in joined(self.upright) {
            let _ = write!(path, "M{} {}V{}", unit(x), unit(from), unit(to));
        }
        path + &self.arcs
    }
}

/// The upper left corner of a cell.
fn corner(column: u16, row: u16) -> (i32, i32) {
    (i32::from(column) * WIDTH as i32 * FINE, i32::from(row) * HEIGHT as i32 * FINE)
}

/// An arm from its start to the edge of the cell, whole or as dashes; dashes are even in number over the
/// whole cell, or one lies on its middle.
fn pieces(start: i32, end: i32, count: u8) -> Vec<(i32, i32)> {
    let dash = |number: i32| {
        let period = 2 * end;
        let [from, to] =
            [4 * number + 1, 4 * number + 3].map(|quarter| quarter * period / (4 * i32::from(count)));
        ((from - end).max(start), to - end)
    };
    if count < 2 {
        return vec![(start, end)];
    }
    (0..i32::from(count)).map(dash).filter(|(from, to)| from < to).collect()
}

/// Lines joined where they overlap or touch, as few as possible.
fn joined(mut lines: Vec<(i32, i32, i32)>) -> Vec<(i32, i32, i32)> {
    lines.sort_unstable();
    let mut all: Vec<(i32, i32, i32)> = Vec::new();
    for (place, from, to) in lines {
        match all.last_mut() {
            Some(last) if last.0 == place && last.2 >= from => last.2 = last.2.max(to),
            _ => all.push((place, from, to)),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::raster::blocks;
    use super::super::strokes::strokes;
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[test]
    fn lengths_are_short() {
        let numbers = [0.0, -0.0, 0.001, -0.001, 0.5, -0.25, 8.0, 120.0, 5.333_333, -12.50];
        let texts = numbers.map(|number| Short(number).to_string());
        assert_eq!(texts, ["0", "0", "0", "0", ".5", "-.25", "8", "120", "5.33", "-12.5"]);
    }

    #[test]
    fn what_touches_becomes_one_rectangle() {
        let mut area = Area::default();
        for (column, row) in [(1, 0), (2, 0), (1, 1), (2, 1)] {
            area.fill(column, row, Raster::FULL);
        }
        area.fill(3, 0, blocks('▌').unwrap());
        area.fill(3, 1, blocks('▌').unwrap());
        area.fill(0, 2, blocks('▂').unwrap());
        assert_eq!(area.path(), "M8 0H28V32H8zM0 44H8V48H0z");
    }

    #[test]
    fn dots_stand_on_a_grid_of_their_own() {
        let mut dots = Dots::default();
        dots.add(1, 1, 0b1000_0001);
        dots.add(0, 0, 0b11);
        assert_eq!(dots.path(), "M2 2h.1zm4 0h.1zm4 16h.1zm4 12h.1z");
    }

    /// The path of characters of one weight.
    fn lines(rows: &[&str], weight: Weight) -> String {
        let mut lines = Lines::default();
        for (row, text) in (0..).zip(rows) {
            for (column, character) in (0..).zip(text.chars()) {
                if let Some(strokes) = strokes(character) {
                    lines.add(column, row, &strokes, weight);
                }
            }
        }
        lines.path()
    }

    #[test]
    fn a_frame_is_four_lines() {
        assert_eq!(lines(&["┌──┐", "│  │", "└──┘"], Weight::Light), "M4 8H28M4 40H28M4 8V40M28 8V40");
        assert_eq!(lines(&["┏━┓", "┗━┛"], Weight::Heavy), "M4 8H20M4 24H20M4 8V24M20 8V24");
        assert_eq!(lines(&["┏━┓", "┗━┛"], Weight::Light), "");
    }

    #[test]
    fn a_double_frame_is_two_frames() {
        let path = lines(&["╔═╗", "╚═╝"], Weight::Double);
        let outer = ["M2.5 6.5H21.5", "M2.5 25.5H21.5", "M2.5 6.5V25.5", "M21.5 6.5V25.5"];
        let inner = ["M5.5 9.5H18.5", "M5.5 22.5H18.5", "M5.5 9.5V22.5", "M18.5 9.5V22.5"];
        let all: BTreeSet<&str> = path.split('M').collect();
        let expected = outer.iter().chain(&inner).map(|line| &line[1..]).chain([""]).collect();
        assert_eq!(all, expected);
        // Nothing crosses the open middle of a double cross, and single lines pass through double ones.
        let cross = "M0 6.5H2.5M5.5 6.5H8M0 9.5H2.5M5.5 9.5H8M2.5 0V6.5M2.5 9.5V16M5.5 0V6.5M5.5 9.5V16";
        assert_eq!(lines(&["╬"], Weight::Double), cross);
        assert_eq!(lines(&["╪"], Weight::Light), "M4 0V16");
        assert_eq!(lines(&["╤"], Weight::Light), "M4 9.5V16");
        assert_eq!(lines(&["╒"], Weight::Light), "M4 6.5V16");
    }

    #[test]
    fn corners_can_be_round_and_lines_dashed() {
        assert_eq!(lines(&["╭╮"], Weight::Light), "M4 16V12Q4 8 8 8M12 16V12Q12 8 8 8");
        assert_eq!(lines(&["╰╯"], Weight::Light), "M4 0V4Q4 8 8 8M12 0V4Q12 8 8 8");
        for (dashed, count) in [("╌", 2), ("┄", 3), ("┈", 4), ("╎", 2), ("┆", 3), ("┊", 4)] {
            assert_eq!(lines(&[dashed], Weight::Light).matches('M').count(), count, "{dashed}");
        }
    }

    proptest! {
        #[test]
        fn rectangles_cover_the_squares_and_no_others(
            parts in prop::collection::vec((0_u16..4, 0_u16..3, prop::array::uniform24(any::<u8>())), 1..8),
        ) {
            let mut area = Area::default();
            let mut squares = BTreeSet::new();
            for &(column, row, bits) in &parts {
                area.fill(column, row, Raster(bits));
                for (y, x) in (0..24).flat_map(|y| (0..8).map(move |x| (y, x))) {
                    if bits[y as usize] >> x & 1 == 1 {
                        squares.insert((u32::from(row) * 24 + y, u32::from(column) * 8 + x));
                    }
                }
            }
            let mut covered = BTreeSet::new();
            for (left, top, right, bottom) in area.rectangles() {
                for square in (top..bottom).flat_map(|y| (left..right).map(move |x| (y, x))) {
                    prop_assert!(covered.insert(square), "twice {square:?}");
                }
            }
            prop_assert_eq!(covered, squares);
        }

        #[test]
        fn lines_go_along_every_arm_and_nowhere_else(
            cells in prop::collection::vec(prop::sample::select("─│┌┐└┘├┤┬┴┼╴╵╶╷ ".chars().collect::<Vec<_>>()), 30),
        ) {
            let mut drawn = Lines::default();
            let mut expected = [BTreeSet::new(), BTreeSet::new()];
            for (place, &character) in (0..).zip(&cells) {
                let (column, row) = (place % 6, place / 6);
                let Some(strokes) = strokes(character) else { continue };
                drawn.add(column, row, &strokes, Weight::Light);
                // Each arm by the place between its ends, in halves of arms.
                let (x, y) = (i32::from(column) * 16 + 8, i32::from(row) * 32 + 16);
                for (arm, towards) in [(0, -1), (1, 1), (2, -1), (3, 1)] {
                    if strokes.arms[arm].is_some() {
                        let along = if arm < 2 { (y, x + 4 * towards) } else { (x, y + 8 * towards) };
                        expected[arm / 2].insert(along);
                    }
                }
            }
            let found = [(drawn.level, 8), (drawn.upright, 16)].map(|(lines, length)| {
                let arms = joined(lines).into_iter().flat_map(|(place, from, to)| {
                    (from..to).step_by(length as usize).map(move |start| (place, start + length / 2))
                });
                arms.collect::<BTreeSet<(i32, i32)>>()
            });
            prop_assert_eq!(found, expected);
        }
    }
}
