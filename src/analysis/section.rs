//! A profile and its contact, reduced to the columns of a pane or a picture.

/// A part of the profile, reduced to columns of dots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// First spring shown.
    pub first: usize,
    /// Springs shown.
    pub springs: usize,
    /// Lowest and highest z of the profile over all springs of the section, m.
    pub heights: (f64, f64),
    /// Height of the undeformed elastic surface, m.
    pub level: f64,
    /// Ranges of heights in each column.
    pub columns: Vec<Column>,
}

/// One column of dots: the springs in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Column {
    /// Lowest and highest point of the rigid profile, m.
    pub line: (f64, f64),
    /// Lowest and highest point of the elastic surface, m.
    pub surface: (f64, f64),
    /// Lowest and highest point of the profile in contact, m.
    pub contact: Option<(f64, f64)>,
}

/// Extent of contact of a range of springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// No spring.
    Nothing,
    /// Some springs.
    Something,
    /// All springs.
    Everything,
}

/// Fragments of about one length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthBin {
    /// Shortest length, springs.
    pub from: u64,
    /// The next length after the bin, springs.
    pub to: u64,
    /// Number of fragments of these lengths.
    pub fragments: u64,
}

/// The profile and its contact in one state.
#[derive(Clone, Copy)]
pub struct Contact<'a> {
    /// Gaps below the summit, m.
    pub gaps: &'a [f64],
    /// Height of the summit, m.
    pub summit: f64,
    /// Indentation, m.
    pub indentation: f64,
    /// First and last spring of each fragment in contact, in ascending order.
    pub fragments: &'a [(usize, usize)],
}

/// Lowest and highest point of the profile in each column of a pane: kept from state to state, since
/// only the contact changes.
#[derive(Default)]
pub struct LineColumns {
    part: Part,
    extremes: Vec<(f64, f64)>,
}

/// The springs of a pane, and its number of columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// First spring.
    pub first: usize,
    /// Number of springs.
    pub springs: usize,
    /// Columns of dots.
    pub columns: usize,
}

impl Part {
    /// The part restricted to a profile of `count` springs.
    fn within(self, count: usize) -> Self {
        let first = self.first.min(count);
        Part { first, springs: self.springs.min(count - first), columns: self.columns }
    }

    /// First spring of a column and the one after its last. With more columns than springs, a spring fills several.
    fn springs_of(self, column: usize) -> (usize, usize) {
        let start = |column: usize| {
            self.first + (column as u128 * self.springs as u128 / self.columns.max(1) as u128) as usize
        };
        let from = start(column);
        (from, start(column + 1).max(from + 1))
    }
}

/// Returns the range that covers both.
fn wider(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    (one.0.min(other.0), one.1.max(other.1))
}

fn extremes(heights: impl Iterator<Item = f64>) -> (f64, f64) {
    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |range, height| wider(range, (height, height)))
}

impl Contact<'_> {
    /// Height of the profile at a spring, m.
    #[must_use]
    pub fn height(&self, spring: usize) -> f64 {
        self.summit - self.gaps[spring]
    }

    fn line(&self, from: usize, to: usize) -> (f64, f64) {
        extremes(self.gaps[from..to].iter().map(|gap| self.summit - gap))
    }

    /// Reduces a part of the profile to its columns: the lowest and highest point of each. `line`
    /// caches the part that depends on the profile alone; another profile needs another cache.
    #[must_use]
    pub fn section(&self, part: Part, line: &mut LineColumns) -> Section {
        let part = part.within(self.gaps.len());
        let level = self.summit - self.indentation;
        let Part { first, springs, .. } = part;
        if springs == 0 {
            return Section { first, springs, heights: (level, level), level, columns: Vec::new() };
        }
        if line.part != part {
            line.part = part;
            let of = |(from, to)| self.line(from, to);
            line.extremes = (0..part.columns).map(|column| of(part.springs_of(column))).collect();
        }
        let mut fragments = self.fragments;
        let column = |(column, &line)| {
            let (from, to) = part.springs_of(column);
            fragments = &fragments[fragments.partition_point(|&(_, last)| last < from)..];
            self.column(from, to, line, fragments)
        };
        let columns = line.extremes.iter().enumerate().map(column).collect();
        // A hidden pane has no columns, and may be shown before its next picture is ready.
        let heights = line.extremes.iter().copied().reduce(wider);
        let heights = heights.unwrap_or_else(|| self.line(first, first + springs));
        Section { first, springs, heights, level, columns }
    }

    /// A column from its springs, `line` their extremes, and the fragments that do not end before the column.
    fn column(&self, from: usize, to: usize, line: (f64, f64), fragments: &[(usize, usize)]) -> Column {
        let level = self.summit - self.indentation;
        let mut contact: Option<(f64, f64)> = None;
        let mut held = 0;
        for &(first, last) in fragments.iter().take_while(|(first, _)| *first < to) {
            let (first, end) = (first.max(from), (last + 1).min(to));
            held += end - first;
            let part = if end - first == to - from { line } else { self.line(first, end) };
            contact = Some(contact.map_or(part, |contact| wider(contact, part)));
        }
        // The surface is at its level above free springs and follows the profile in contact.
        let surface = match contact {
            Some(contact) if held == to - from => contact,
            Some(contact) => wider(contact, (level, level)),
            None => (level, level),
        };
        Column { line, surface, contact }
    }
}

/// Share in contact of each of `cells` equal parts of a profile of `count` springs.
#[must_use]
pub fn strip(fragments: &[(usize, usize)], count: usize, cells: usize) -> Vec<Share> {
    let part = Part { first: 0, springs: count, columns: cells };
    let mut rest = fragments;
    (0..if count == 0 { 0 } else { cells })
        .map(|cell| {
            let (from, to) = part.springs_of(cell);
            rest = &rest[rest.partition_point(|&(_, last)| last < from)..];
            let touching = rest.iter().take_while(|(first, _)| *first < to);
            match touching.map(|&(first, last)| (last + 1).min(to) - first.max(from)).sum::<usize>() {
                0 => Share::Nothing,
                held if held == to - from => Share::Everything,
                _ => Share::Something,
            }
        })
        .collect()
}

/// Counts fragments into lengths that grow by a factor √2, from one spring on; ranges without an
/// integer number of springs have no bin.
#[must_use]
pub fn lengths(fragments: &[(usize, usize)]) -> Vec<LengthBin> {
    let mut lengths: Vec<u64> = fragments.iter().map(|&(first, last)| (last - first + 1) as u64).collect();
    lengths.sort_unstable();
    let (mut bins, mut from, mut rest) = (Vec::new(), 1, lengths.as_slice());
    for to in (1..).map(|half| 2_f64.powf(f64::from(half) / 2.0).ceil() as u64) {
        if rest.is_empty() {
            break;
        }
        if to > from {
            let fragments = rest.partition_point(|&length| length < to);
            bins.push(LengthBin { from, to, fragments: fragments as u64 });
            (rest, from) = (&rest[fragments..], to);
        }
    }
    bins
}

/// Number of springs in exactly one of two contacts, each given by its fragments in ascending order.
#[must_use]
pub fn changed(before: &[(usize, usize)], after: &[(usize, usize)]) -> u64 {
    let springs =
        |fragments: &[(usize, usize)]| fragments.iter().map(|(first, last)| last - first + 1).sum::<usize>();
    let (mut a, mut b, mut common) = (before, after, 0);
    while let ([one, rest_of_a @ ..], [other, rest_of_b @ ..]) = (a, b) {
        common += (one.1.min(other.1) + 1).saturating_sub(one.0.max(other.0));
        if one.1 <= other.1 { a = rest_of_a } else { b = rest_of_b }
    }
    (springs(before) + springs(after) - 2 * common) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LINE: Contact<'static> = Contact {
        gaps: &[0.0, 1.0, 2.0, 3.0, 2.5, 0.5],
        summit: 10.0,
        indentation: 0.5,
        fragments: &[(0, 1), (5, 5)],
    };

    fn section(first: usize, springs: usize, columns: usize) -> Section {
        LINE.section(Part { first, springs, columns }, &mut LineColumns::default())
    }

    #[test]
    fn columns_hold_the_extremes_of_their_springs() {
        let section = section(0, 6, 3);
        assert_eq!(section.heights, (7.0, 10.0));
        assert_eq!(section.level, 9.5);
        let free = Column { line: (7.0, 8.0), surface: (9.5, 9.5), contact: None };
        let mixed = Column { line: (7.5, 9.5), surface: (9.5, 9.5), contact: Some((9.5, 9.5)) };
        let held = Column { line: (9.0, 10.0), surface: (9.0, 10.0), contact: Some((9.0, 10.0)) };
        assert_eq!(section.columns, [held, free, mixed]);
    }

    #[test]
    fn a_spring_fills_several_columns_when_there_are_more() {
        let part = section(4, 99, 5);
        assert_eq!((part.first, part.springs), (4, 2));
        let heights: Vec<f64> = part.columns.iter().map(|column| column.line.0).collect();
        assert_eq!(heights, [7.5, 7.5, 7.5, 9.5, 9.5]);
        assert_eq!(section(6, 1, 5).columns, []);
    }

    #[test]
    fn a_strip_shows_the_contact() {
        use Share::{Everything, Nothing, Something};
        assert_eq!(strip(&[(0, 3), (5, 5)], 8, 4), [Everything, Everything, Something, Nothing]);
        assert_eq!(strip(&[(1, 1)], 2, 4), [Nothing, Nothing, Everything, Everything]);
        assert_eq!(strip(&[], 0, 4), []);
    }

    #[test]
    fn lengths_are_counted_without_gaps() {
        assert_eq!(lengths(&[]), []);
        let bins = lengths(&[(0, 0), (2, 2), (4, 6), (10, 19)]);
        let counts: Vec<_> = bins.iter().map(|bin| (bin.from, bin.to, bin.fragments)).collect();
        assert_eq!(counts, [(1, 2, 2), (2, 3, 0), (3, 4, 1), (4, 6, 0), (6, 8, 0), (8, 12, 1)]);
    }

    proptest! {
        #[test]
        fn a_section_is_what_its_springs_are(
            touching in prop::collection::vec(any::<bool>(), 1..40),
            first in 0_usize..40,
            springs in 1_usize..40,
            columns in 1_usize..20,
        ) {
            let gaps: Vec<f64> = (0..touching.len()).map(|i| ((i * 37) % 11) as f64).collect();
            let fragments = runs(&touching);
            let contact = Contact { gaps: &gaps, summit: 20.0, indentation: 3.0, fragments: &fragments };
            let part = Part { first, springs, columns }.within(gaps.len());
            let section = contact.section(part, &mut LineColumns::default());
            for (column, found) in section.columns.iter().enumerate() {
                let (from, to) = part.springs_of(column);
                let held: Vec<usize> = (from..to).filter(|&spring| touching[spring]).collect();
                let heights = |springs: &[usize]| extremes(springs.iter().map(|&spring| 20.0 - gaps[spring]));
                prop_assert_eq!(found.line, heights(&(from..to).collect::<Vec<_>>()));
                prop_assert_eq!(found.contact, (!held.is_empty()).then(|| heights(&held)));
            }
        }

        #[test]
        fn changed_springs_are_those_of_either_contact_alone(
            states in prop::collection::vec(any::<(bool, bool)>(), 0..60)
        ) {
            let (before, after): (Vec<bool>, Vec<bool>) = states.iter().copied().unzip();
            let expected = states.iter().filter(|(a, b)| a != b).count() as u64;
            prop_assert_eq!(changed(&runs(&before), &runs(&after)), expected);
        }

        #[test]
        fn every_length_is_in_one_bin(springs in prop::collection::vec(1_usize..5000, 1..50)) {
            let fragments: Vec<_> = springs.iter().map(|&count| (0, count - 1)).collect();
            let bins = lengths(&fragments);
            for bin in &bins {
                let inside = springs.iter().filter(|&&count| (bin.from..bin.to).contains(&(count as u64)));
                prop_assert_eq!(bin.fragments, inside.count() as u64);
            }
            prop_assert!(bins.windows(2).all(|pair| pair[0].to == pair[1].from));
            prop_assert_eq!(bins.iter().map(|bin| bin.fragments).sum::<u64>(), springs.len() as u64);
        }
    }

    fn runs(touching: &[bool]) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for spring in (0..touching.len()).filter(|&spring| touching[spring]) {
            match runs.last_mut() {
                Some((_, last)) if *last + 1 == spring => *last = spring,
                _ => runs.push((spring, spring)),
            }
        }
        runs
    }
}
