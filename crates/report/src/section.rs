//! A profile in contact, reduced to the columns of a chart.

use asperity_contact::Patch;
use asperity_data::{AxisScale, quantile};
use asperity_plot::{Chart, ChartAxis, Ink, Layer, Shape, Span, StressFill};
use asperity_scene::workload::LineFacts;
use std::ops::Range;

/// Rigid profile and its contact with the elastic surface at one indentation.
#[derive(Clone, Copy)]
pub struct SectionContact<'a> {
    /// Gap in m at each spring: the depth of the profile at this spring below the highest point of
    /// the profile.
    pub gaps: &'a [f64],
    /// Height in m of the highest point of the profile.
    pub summit: f64,
    /// Indentation in m at which the contact is shown.
    pub indentation: f64,
    /// Patches of springs in contact, from left to right.
    pub patches: &'a [Patch],
}

/// Part of a profile that a chart shows: a range of springs, divided into columns of equal width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// Index, from 0 along the profile, of the first spring that the chart shows.
    pub first: usize,
    /// Number of springs that the chart shows.
    pub springs: usize,
    /// Number of columns of the chart.
    pub columns: usize,
}

/// Largest number of columns with which a profile is drawn in the picture of a file.
const DRAWN: usize = 1200;

/// Lowest and highest point of a profile in each column of a chart. [`SectionContact::section`]
/// stores these points, because its next call often needs them again.
#[derive(Default)]
pub struct LineColumns {
    part: Part,
    heights: Vec<(f64, f64)>,
}

/// Part of a profile and its contact, reduced to the lowest and highest heights in each column of a
/// chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Index, from 0 along the profile, of the first spring that the chart shows.
    pub first: usize,
    /// Number of springs that the chart shows.
    pub springs: usize,
    /// Heights in m of the lowest and the highest point of the shown part of the profile.
    pub heights: (f64, f64),
    /// Height in m of the undeformed elastic surface, on the same scale as the heights of the
    /// profile.
    pub level: f64,
    /// Columns of the chart, from left to right.
    pub columns: Vec<Column>,
}

/// Heights in m of the lowest and the highest point in one column of a chart: of the profile, of
/// the elastic surface and of the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Column {
    /// Heights in m of the lowest and the highest point of the rigid profile.
    pub line: (f64, f64),
    /// Heights in m of the lowest and the highest point of the elastic surface.
    pub surface: (f64, f64),
    /// Heights in m of the lowest and the highest point of those springs of the column that are in
    /// contact; `None` without contact.
    pub contact: Option<(f64, f64)>,
}

impl Section {
    /// Returns the chart of the heights over the position along the profile. `line` has the spring
    /// spacing of the profile and the index of its first spring, and `z` is the range of the
    /// vertical axis in m. `largest_stress` in m is the compression or stretch from which on
    /// springs have the colour of the largest stress.
    pub fn chart(&self, line: LineFacts, z: Span, largest_stress: f64) -> Chart {
        let end = self.first + self.springs.max(1);
        let x = Span {
            low: (line.first + self.first) as f64 * line.spacing,
            high: (line.first + end) as f64 * line.spacing,
        };
        let surface = self.envelope(x, |column| Some(column.surface));
        let profile = self.envelope(x, |column| Some(column.line));
        let level = self.level;
        let pressed = self.envelope(x, |column| column.pressed(level));
        let pulled = self.envelope(x, |column| column.pulled(level));
        let fill = StressFill {
            level,
            full: largest_stress,
        };
        let layers = vec![
            Layer::unnamed(Ink::Body, self.body(x, z)),
            Layer::new("surface".into(), Ink::Surface, surface),
            Layer::new("profile".into(), Ink::Profile, profile),
            Layer::new("pressed".into(), Ink::Press, pressed.filled(fill)),
            Layer::new("pulled".into(), Ink::Pull, pulled.filled(fill)),
        ];
        let x = ChartAxis::new(AxisScale::Linear, x, "position", "x", "m");
        let y = ChartAxis::new(AxisScale::Linear, z, "height", "z", "m");
        Chart::new(x, y, layers)
    }

    /// Returns the area of the rigid body below its profile. `positions` is the range in m of all
    /// columns together.
    fn body(&self, positions: Span, z: Span) -> Shape {
        // The area reaches from the left end of the first to the right end of the last column.
        let width = positions.width() / self.columns.len().saturating_sub(1).max(1) as f64;
        let mut points = Vec::with_capacity(self.columns.len());
        for (index, column) in self.columns.iter().enumerate() {
            let x = positions.low + width * index as f64;
            let (low, high) = column.line;
            points.push((x, z.low, f64::midpoint(low, high)));
        }
        Shape::Band(points)
    }

    /// Returns a shape with the lowest and the highest point of each column. `positions` is the
    /// range in m of all columns together.
    fn envelope(&self, positions: Span, heights: impl Fn(&Column) -> Option<(f64, f64)>) -> Shape {
        Shape::Envelope {
            x: (positions.low, positions.high),
            columns: self.columns.iter().map(heights).collect(),
            fill: None,
        }
    }

    /// Returns the compression or stretch in m that only few springs of the part exceed; `None`
    /// without contact.
    pub fn largest_stress(&self) -> Option<f64> {
        /// Share of the columns in contact whose stress does not exceed the result. A few springs
        /// at the edges of patches have much larger stresses.
        const SHARE: f64 = 0.97;
        let mut stresses = Vec::new();
        for (low, high) in self.columns.iter().filter_map(|column| column.contact) {
            stresses.push((high - self.level).abs().max((low - self.level).abs()));
        }
        stresses.sort_by(f64::total_cmp);
        quantile(&stresses, SHARE).filter(|stress| *stress > 0.0)
    }
}

impl Column {
    /// Returns the lowest and the highest point above `level` of the springs in contact, which are
    /// pressed; `None` if there are none.
    fn pressed(&self, level: f64) -> Option<(f64, f64)> {
        let (low, high) = self.contact?;
        (high >= level).then(|| (low.max(level), high))
    }

    /// Returns the lowest and the highest point below `level` of the springs in contact, which are
    /// pulled; `None` if there are none.
    fn pulled(&self, level: f64) -> Option<(f64, f64)> {
        let (low, high) = self.contact?;
        (low < level).then(|| (low, high.min(level)))
    }
}

impl Part {
    /// Returns the part of a profile that begins at the spring `first` and consists of `springs`
    /// springs. The number of columns suits a picture in a file.
    pub fn drawn(first: usize, springs: usize) -> Part {
        Part {
            first,
            springs,
            columns: springs.min(DRAWN),
        }
    }

    /// Returns the part of a profile that begins at the spring `first` and consists of `springs`
    /// springs, with one column for each spring.
    pub fn listed(first: usize, springs: usize) -> Part {
        Part {
            first,
            springs,
            columns: springs,
        }
    }

    /// Returns the indices of the springs in a column. Columns are counted from 0.
    pub fn springs_of(self, column: usize) -> Range<usize> {
        let begin = self.begin_of(column);
        let end = self.begin_of(column + 1);
        begin..end.max(begin + 1)
    }

    /// Returns the index of the first spring of a column. The product of the two numbers may exceed
    /// 64 bits, so that it is computed with 128 bits.
    fn begin_of(self, column: usize) -> usize {
        let before = column as u128 * self.springs as u128 / self.columns.max(1) as u128;
        self.first + before as usize
    }
}

impl SectionContact<'_> {
    /// Returns the height in m of the rigid profile at a spring.
    pub fn height(&self, spring: usize) -> f64 {
        self.summit - self.gaps[spring]
    }

    /// Returns the height in m of the undeformed elastic surface: the highest point of the profile
    /// minus the indentation.
    pub fn level(&self) -> f64 {
        self.summit - self.indentation
    }

    /// Returns the contact patches in the range `springs`, each as the range of indices of its
    /// springs. Of a patch that extends beyond `springs`, only the springs inside this range are
    /// returned.
    pub fn within(&self, springs: Range<usize>) -> impl Iterator<Item = Range<usize>> {
        let Range { start, end } = springs;
        let first = self.patches.partition_point(|patch| patch.last < start);
        self.patches[first..]
            .iter()
            .take_while(move |patch| patch.first < end)
            .map(move |patch| patch.first.max(start)..patch.springs().end.min(end))
    }

    /// Reduces a part of the profile and its contact to the columns of a chart. `line` stores the
    /// heights of the profile for the next call, so that each profile needs its own `line`.
    pub fn section(&self, part: Part, line: &mut LineColumns) -> Section {
        if line.part != part {
            let columns = 0..part.columns;
            *line = LineColumns {
                part,
                heights: columns
                    .map(|column| self.heights(part.springs_of(column)))
                    .collect(),
            };
        }
        let mut columns = Vec::with_capacity(line.heights.len());
        for (column, &heights) in line.heights.iter().enumerate() {
            columns.push(self.column(part.springs_of(column), heights));
        }
        let heights = match line.heights.iter().copied().reduce(wider) {
            Some(heights) => heights,
            // A hidden chart has no columns. Then the range of heights is that of all springs of
            // the part.
            None => self.heights(part.first..part.first + part.springs),
        };
        Section {
            first: part.first,
            springs: part.springs,
            heights,
            level: self.level(),
            columns,
        }
    }

    /// Returns the lowest and the highest point of a range of springs, m.
    fn heights(&self, springs: Range<usize>) -> (f64, f64) {
        let mut lowest = f64::INFINITY;
        let mut highest = f64::NEG_INFINITY;
        for gap in &self.gaps[springs] {
            let height = self.summit - gap;
            lowest = lowest.min(height);
            highest = highest.max(height);
        }
        (lowest, highest)
    }

    /// Returns the column for a range of springs. `line` has the lowest and the highest height of
    /// the profile in this range.
    fn column(&self, springs: Range<usize>, line: (f64, f64)) -> Column {
        let mut free = springs.len();
        let mut contact: Option<(f64, f64)> = None;
        for touching in self.within(springs.clone()) {
            free -= touching.len();
            let heights = if touching == springs {
                line
            } else {
                self.heights(touching)
            };
            contact = match contact {
                Some(contact) => Some(wider(contact, heights)),
                None => Some(heights),
            };
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

/// Returns the smallest range that contains two ranges.
fn wider(first: (f64, f64), second: (f64, f64)) -> (f64, f64) {
    (first.0.min(second.0), first.1.max(second.1))
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
                // Outside the contact, the height of the surface is the summit (20) minus the
                // indentation (3).
                let surface = |spring: usize| if touching[spring] { 20.0 - gaps[spring] } else { 17.0 };
                let surfaces = part.springs_of(column).map(|spring| (surface(spring), surface(spring)));
                prop_assert_eq!(Some(found.surface), surfaces.reduce(wider));
            }
        }
    }
}
