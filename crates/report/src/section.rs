//! A profile in contact, reduced to the columns of a chart.

use asperity_contact::Patch;
use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Ink, Layer, Shape, Span};
use asperity_scene::stages::LineFacts;
use std::ops::Range;

/// Rigid profile and its contact with the elastic surface at one indentation.
#[derive(Clone, Copy)]
pub struct SectionContact<'a> {
    /// Gap at each spring, m: depth of the profile at this spring below the highest point of the
    /// profile.
    pub gaps: &'a [f64],
    /// Height of the highest point of the profile, m.
    pub summit: f64,
    /// Indentation at which the contact is shown, m.
    pub indentation: f64,
    /// Patches of springs in contact, from left to right.
    pub patches: &'a [Patch],
}

/// Range of springs that a chart shows, and the number of columns of equal width into which the
/// chart divides this range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// Index, from 0 along the profile, of the first spring of the range.
    pub first: usize,
    /// Number of springs in the range.
    pub springs: usize,
    /// Number of columns of the chart.
    pub columns: usize,
}

/// Largest number of columns of a profile in a picture.
const DRAWN: usize = 1200;

/// Lowest and highest point of a profile in each column of a [`Part`]. [`SectionContact::section`]
/// stores them here for its next call.
#[derive(Default)]
pub struct LineColumns {
    part: Part,
    heights: Vec<(f64, f64)>,
}

/// Part of a profile and its contact, reduced to the lowest and highest heights in each column of a
/// chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Index, from 0 along the profile, of the first spring of the part.
    pub first: usize,
    /// Number of springs of the part.
    pub springs: usize,
    /// Heights of the lowest and the highest point of the profile in this part, m.
    pub heights: (f64, f64),
    /// Height of the undeformed elastic surface on the scale of the heights of the profile, m.
    pub level: f64,
    /// Columns of the chart, from left to right.
    pub columns: Vec<Column>,
}

/// Lowest and highest point of profile, elastic surface and contact in one column of a chart, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Column {
    /// Heights of the lowest and the highest point of the rigid profile, m.
    pub line: (f64, f64),
    /// Heights of the lowest and the highest point of the elastic surface, m.
    pub surface: (f64, f64),
    /// Heights of the lowest and the highest point of those springs of the column that are in
    /// contact, m; `None` without contact.
    pub contact: Option<(f64, f64)>,
}

impl Section {
    /// Returns the chart of the heights over the position. `line` has the spring spacing of the
    /// profile and the index of its first spring, and `z` is the range of the vertical axis in m.
    pub fn chart(&self, line: LineFacts, z: Span) -> Chart {
        let edge = |spring: usize| (line.first + spring) as f64 * line.spacing;
        let x = (edge(self.first), edge(self.first + self.springs.max(1)));
        let layer = |name: &str, ink, ends: fn(&Column) -> Option<(f64, f64)>| {
            let columns = self.columns.iter().map(ends).collect();
            Layer::new(name.into(), ink, Shape::Envelope { x, columns })
        };
        let layers = vec![
            layer("surface", Ink::Surface, |column| Some(column.surface)),
            layer("profile", Ink::Profile, |column| Some(column.line)),
            layer("contact", Ink::Contact, |column| column.contact),
        ];
        let axis = |span, name, symbol| ChartAxis::new(AxisScale::Linear, span, name, symbol, "m");
        let x = Span {
            low: x.0,
            high: x.1,
        };
        Chart::new(axis(x, "position", "x"), axis(z, "height", "z"), layers)
    }
}

impl Part {
    /// Returns the part that begins at the index `first` and has this number of springs, with as
    /// many columns as a picture in a file shows.
    pub fn drawn(first: usize, springs: usize) -> Part {
        Part {
            first,
            springs,
            columns: springs.min(DRAWN),
        }
    }

    /// Returns the part that begins at the index `first` and has this number of springs, with one
    /// column of the chart for each spring.
    pub fn listed(first: usize, springs: usize) -> Part {
        Part {
            first,
            springs,
            columns: springs,
        }
    }

    /// Returns the indices of the springs that the column with this number, from 0, shows.
    pub fn springs_of(self, column: usize) -> Range<usize> {
        let start = |column: usize| {
            self.first
                + (column as u128 * self.springs as u128 / self.columns.max(1) as u128) as usize
        };
        let from = start(column);
        from..start(column + 1).max(from + 1)
    }
}

impl SectionContact<'_> {
    /// Returns the height of the rigid profile at a spring, m.
    pub fn height(&self, spring: usize) -> f64 {
        self.summit - self.gaps[spring]
    }

    /// Returns the height of the undeformed elastic surface, m: the highest point of the profile
    /// minus the indentation.
    pub fn level(&self) -> f64 {
        self.summit - self.indentation
    }

    /// Returns the index ranges of neighbouring springs in contact within the range `springs`.
    pub fn within(&self, springs: Range<usize>) -> impl Iterator<Item = Range<usize>> {
        let begun = self
            .patches
            .partition_point(|patch| patch.last < springs.start);
        let touching = self.patches[begun..]
            .iter()
            .take_while(move |patch| patch.first < springs.end);
        touching
            .map(move |patch| patch.first.max(springs.start)..patch.springs().end.min(springs.end))
    }

    /// Reduces a part of the profile and its contact to the columns of a chart. Each profile needs
    /// its own `line`, which stores heights for the next call.
    pub fn section(&self, part: Part, line: &mut LineColumns) -> Section {
        let Part {
            first,
            springs,
            columns,
        } = part;
        if line.part != part {
            let heights = (0..columns).map(|column| self.heights(part.springs_of(column)));
            *line = LineColumns {
                part,
                heights: heights.collect(),
            };
        }
        let of = |(column, &heights)| self.column(part.springs_of(column), heights);
        let columns = line.heights.iter().enumerate().map(of).collect();
        // A hidden chart has no columns.
        let heights = line.heights.iter().copied().reduce(wider);
        let heights = heights.unwrap_or_else(|| self.heights(first..first + springs));
        Section {
            first,
            springs,
            heights,
            level: self.level(),
            columns,
        }
    }

    /// Returns the lowest and the highest point of a range of springs, m.
    fn heights(&self, springs: Range<usize>) -> (f64, f64) {
        let height = |gap: &f64| (self.summit - gap, self.summit - gap);
        self.gaps[springs]
            .iter()
            .map(height)
            .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
    }

    fn column(&self, springs: Range<usize>, line: (f64, f64)) -> Column {
        let (mut free, mut contact) = (springs.len(), None);
        for touching in self.within(springs.clone()) {
            free -= touching.len();
            let heights = if touching == springs {
                line
            } else {
                self.heights(touching)
            };
            contact = Some(contact.map_or(heights, |contact| wider(contact, heights)));
        }
        let level = (self.level(), self.level());
        let surface = match contact {
            Some(contact) if free == 0 => contact,
            Some(contact) => wider(contact, level),
            None => level,
        };
        Column {
            line,
            surface,
            contact,
        }
    }
}

fn wider(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    (one.0.min(other.0), one.1.max(other.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_section_is_what_its_springs_are(
            touching in prop::collection::vec(any::<bool>(), 1..40),
            first in 0_usize..40,
            springs in 1_usize..40,
            columns in 1_usize..20,
        ) {
            let gaps: Vec<f64> = (0..touching.len()).map(|i| ((i * 37) % 11) as f64).collect();
            let first = first % gaps.len();
            let part = Part { first, springs: springs.min(gaps.len() - first), columns };
            let patches = Patch::of_springs(touching.iter().copied());
            let contact = SectionContact { gaps: &gaps, summit: 20.0, indentation: 3.0, patches: &patches };
            let section = contact.section(part, &mut LineColumns::default());
            for (column, found) in section.columns.iter().enumerate() {
                let heights = |springs: Vec<usize>| {
                    springs.into_iter().map(|spring| (20.0 - gaps[spring], 20.0 - gaps[spring])).reduce(wider)
                };
                let held = part.springs_of(column).filter(|&spring| touching[spring]).collect();
                prop_assert_eq!(Some(found.line), heights(part.springs_of(column).collect()));
                prop_assert_eq!(found.contact, heights(held));
                // Beside the contact the surface lies at the summit less the indentation.
                let surface = |spring: usize| if touching[spring] { 20.0 - gaps[spring] } else { 17.0 };
                let surfaces = part.springs_of(column).map(|spring| (surface(spring), surface(spring)));
                prop_assert_eq!(Some(found.surface), surfaces.reduce(wider));
            }
        }
    }
}
