//! The points of a curve in the order of time, with displacements and forces that grow when the
//! body is pressed.

use crate::curve::numerics::Extent;
use crate::curve::segments::Segments;
use crate::error::{ExperimentError, refused_with};
use crate::read::options::Negate;
use crate::read::points::Columns;
use asperity_data::{Remedy, format_quantity, mean};
use std::ops::Range;

/// Points of a curve in the order of time. If the file has many points, each point here is the mean
/// of several neighbouring points of the file.
pub(crate) struct Points {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    pub segment: Vec<usize>,
    pub is_still: Vec<bool>,
    /// Time of each point in s; empty if it is not known.
    pub seconds: Vec<f64>,
    /// For each point, the number of points of the file whose mean it is.
    pub counts: Vec<usize>,
}

impl Points {
    /// Creates points, each of which is the mean of up to `count` neighbouring points.
    pub fn averaged(columns: &Columns, segments: &Segments, count: usize) -> Points {
        let mut points = Points {
            displacement: Vec::new(),
            force: Vec::new(),
            segment: Vec::new(),
            is_still: Vec::new(),
            seconds: Vec::new(),
            counts: Vec::new(),
        };
        for range in like_neighbours(segments, count) {
            points.segment.push(segments.numbers[range.start]);
            points.is_still.push(segments.is_still[range.start]);
            points.counts.push(range.len());
            let displacement = mean(&columns.displacement[range.clone()]);
            points.displacement.push(displacement);
            points.force.push(mean(&columns.force[range.clone()]));
            if let Some(seconds) = columns.seconds.get(range) {
                points.seconds.push(mean(seconds));
            }
        }
        points
    }

    pub fn begins_with_approach(&self) -> bool {
        self.segment[0] == 0
    }

    pub fn last_segment(&self) -> usize {
        self.segment[self.segment.len() - 1]
    }

    /// Returns the range of indices of the points in segment number `number`.
    pub fn range_of(&self, number: usize) -> Range<usize> {
        let start = self.segment.partition_point(|segment| *segment < number);
        let end = self.segment.partition_point(|segment| *segment <= number);
        start..end
    }

    /// Returns the range of indices of the points in segment number `number`, without the pause at
    /// the turning point.
    pub fn moving(&self, number: usize) -> Range<usize> {
        let range = self.range_of(number);
        let is_still = |index: &usize| self.is_still[*index];
        if number % 2 == 1 {
            let pause = range.clone().take_while(is_still).count();
            return range.start + pause..range.end;
        }
        let pause = range.clone().rev().take_while(is_still).count();
        range.start..range.end - pause
    }

    /// Reverses the signs of displacement and force so that both grow when the body is pressed. If
    /// `asked` is given, the signs of the quantities in `asked` are reversed. Otherwise the first
    /// segment shows which signs have to be reversed. Returns the quantities whose signs were
    /// reversed.
    ///
    /// # Errors
    /// Returns an error if the body does not approach first when the signs in `asked` are reversed.
    pub fn reverse(&mut self, asked: Option<Negate>) -> Result<Negate, ExperimentError> {
        let first = self.range_of(self.segment[0]);
        let moved = self.displacement[first.end - 1] - self.displacement[0];
        let is_reversed = if self.begins_with_approach() {
            moved < 0.0
        } else {
            moved > 0.0
        };
        let negate = match asked {
            Some(negate) => negate,
            None if is_reversed => Negate::Displacement,
            None => Negate::None,
        };
        let negates_displacement = matches!(negate, Negate::Displacement | Negate::Both);
        if negates_displacement != is_reversed {
            let direction = if self.begins_with_approach() {
                "away"
            } else {
                "closer"
            };
            let found = format!(
                "the body moves {direction} in the first segment where the sign of {negate} is reversed"
            );
            let allowed = "an approach first; the reversed sign of a distance between the bodies";
            return refused_with(found, allowed, [Remedy::NegateDisplacement]);
        }
        if negates_displacement {
            reverse_signs(&mut self.displacement);
        }
        if matches!(negate, Negate::Force | Negate::Both) {
            reverse_signs(&mut self.force);
        }
        Ok(negate)
    }

    /// Converts the displacement of the body to the displacement of the instrument, by adding the
    /// deflection of the instrument. `name` is the name of the column of displacements in the file,
    /// and `stiffness` is the stiffness of the instrument in N/m. Returns a sentence about this
    /// conversion.
    pub fn add_deflection(&mut self, name: &str, stiffness: f64) -> String {
        for (displacement, force) in self.displacement.iter_mut().zip(&self.force) {
            *displacement += force / stiffness;
        }
        let stiffness = format_quantity(stiffness, "N/m");
        format!(
            "{name} is a displacement of the body: the deflection of an instrument of {stiffness} was added."
        )
    }

    /// Returns the displacement in m at the end of each segment, from the first segment to segment
    /// number `last`. If the curve is a retraction alone, the approach before the retraction is
    /// assumed to end at the largest displacement.
    pub fn turns(&self, last: usize) -> Vec<f64> {
        let mut turns = Vec::with_capacity(last + 1);
        for number in 0..=last {
            let range = self.range_of(number);
            let displacements = if range.is_empty() {
                &self.displacement[..]
            } else {
                &self.displacement[range]
            };
            let extent = Extent::of(displacements.iter().copied());
            turns.push(if number.is_multiple_of(2) {
                extent.high
            } else {
                extent.low
            });
        }
        turns
    }
}

fn reverse_signs(values: &mut [f64]) {
    for value in values {
        *value = -*value;
    }
}

/// Returns index ranges of up to `count` neighbouring points. All points of a range belong to the
/// same segment. Either all of them belong to a pause, or none does.
fn like_neighbours(segments: &Segments, count: usize) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for (index, number) in segments.numbers.iter().enumerate() {
        let is_still = segments.is_still[index];
        match ranges.last_mut() {
            Some(range)
                if range.len() < count
                    && segments.numbers[range.start] == *number
                    && segments.is_still[range.start] == is_still =>
            {
                range.end = index + 1;
            }
            _ => ranges.push(index..index + 1),
        }
    }
    ranges
}
