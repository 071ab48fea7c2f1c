//! The points of a curve in the order of time, with signs such that pressing is positive.

use crate::curve::numerics::ends;
use crate::curve::segments::Segments;
use crate::error::{ExperimentError, refused};
use crate::read::options::Negate;
use asperity_data::{format_quantity, mean};
use std::ops::Range;

/// Points in the order of time. If there are many, each is the mean of several points of the file.
pub(crate) struct Points {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    pub segment: Vec<usize>,
    pub is_still: Vec<bool>,
    /// Number of points of the file that each point averages.
    pub counts: Vec<usize>,
}

impl Points {
    pub fn averaged(
        displacement: &[f64],
        force: &[f64],
        segments: &Segments,
        count: usize,
    ) -> Points {
        let (mut ranges, mut start): (Vec<Range<usize>>, _) = (Vec::new(), 0);
        let kinds: Vec<_> = segments.numbers.iter().zip(&segments.is_still).collect();
        for chunk in kinds
            .chunk_by(|one, next| one == next)
            .flat_map(|part| part.chunks(count))
        {
            ranges.push(start..start + chunk.len());
            start += chunk.len();
        }
        let means = |values: &[f64]| {
            ranges
                .iter()
                .map(|range| mean(&values[range.clone()]))
                .collect()
        };
        Points {
            displacement: means(displacement),
            force: means(force),
            segment: ranges
                .iter()
                .map(|range| segments.numbers[range.start])
                .collect(),
            is_still: ranges
                .iter()
                .map(|range| segments.is_still[range.start])
                .collect(),
            counts: ranges.iter().map(Range::len).collect(),
        }
    }

    /// Returns the index range of the points of a segment.
    pub fn of(&self, number: usize) -> Range<usize> {
        self.segment.partition_point(|one| *one < number)
            ..self.segment.partition_point(|one| *one <= number)
    }

    /// Returns the index range of the points of a segment without the pause at its turning point.
    pub fn moving(&self, number: usize) -> Range<usize> {
        let of = self.of(number);
        let Range { mut start, mut end } = of.clone();
        let pause = |index: &usize| self.is_still[*index];
        if number % 2 == 1 {
            start += of.clone().take_while(pause).count();
        } else {
            end -= of.rev().take_while(pause).count();
        }
        start..end
    }

    /// Reverses displacement and force so that pressing is positive: as `asked`, or else according
    /// to the first segment.
    pub fn reverse(&mut self, asked: Option<Negate>) -> Result<Negate, ExperimentError> {
        let first = self.of(self.segment[0]);
        let is_wrong = |displacement: &[f64]| {
            let moved = displacement[first.end - 1] - displacement[0];
            if self.segment[0] == 0 {
                moved < 0.0
            } else {
                moved > 0.0
            }
        };
        let by_itself = if is_wrong(&self.displacement) {
            Negate::Displacement
        } else {
            Negate::None
        };
        let negate = asked.unwrap_or(by_itself);
        if matches!(negate, Negate::Displacement | Negate::Both)
            != (by_itself == Negate::Displacement)
        {
            let away = if self.segment[0] == 0 {
                "away"
            } else {
                "closer"
            };
            let found =
                format!("the body moves {away} in the first segment with --negate {negate}");
            return refused(
                found,
                "an approach first; --negate displacement for a distance between the bodies",
            );
        }
        for (values, one) in [
            (&mut self.displacement, Negate::Displacement),
            (&mut self.force, Negate::Force),
        ] {
            if negate == one || negate == Negate::Both {
                values.iter_mut().for_each(|value| *value = -*value);
            }
        }
        Ok(negate)
    }

    /// Adds the deflection of an instrument of this stiffness in N/m to the displacement of the
    /// body, which the column `name` contains. Returns a sentence that says so.
    pub fn put_on_spring(&mut self, name: &str, stiffness: f64) -> String {
        self.displacement
            .iter_mut()
            .zip(&self.force)
            .for_each(|(at, force)| *at += force / stiffness);
        let stiffness = format_quantity(stiffness, "N/m");
        format!(
            "{name} is a displacement of the body: the deflection of an instrument of {stiffness} was added."
        )
    }

    /// Returns the displacements in m at which the segments up to number `last` end. A single
    /// retraction begins at the largest displacement.
    pub fn turns(&self, last: usize) -> Vec<f64> {
        let all = ends(self.displacement.iter().copied());
        let end = |number: usize| {
            let of = self.of(number);
            let (low, high) = if of.is_empty() {
                all
            } else {
                ends(self.displacement[of].iter().copied())
            };
            if number.is_multiple_of(2) { high } else { low }
        };
        (0..=last).map(end).collect()
    }
}
