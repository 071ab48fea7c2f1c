//! The coordinates in which a scene is fitted, and the parts of the curve beside it.

use super::MeasuredCurve;
use super::parameter::{Coordinate, Parameter, Values};
use super::population::WRONG_SIDE;
use super::statistics::{PARTS, scale};
use std::ops::Range;

/// The coordinates in which a scene is fitted, from these values on.
pub(super) struct Space<'a> {
    pub base: Values,
    pub coordinates: Vec<Coordinate>,
    /// Largest work of adhesion on closing, J/m².
    pub most_on_closing: f64,
    pub curve: &'a MeasuredCurve,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl Space<'_> {
    /// Values of all parameters at these coordinates.
    pub fn values(&self, at: &[f64]) -> Values {
        let mut values = self.base;
        for (coordinate, &at) in self.coordinates.iter().zip(at) {
            values[coordinate.parameter as usize] = coordinate.value(at, &values);
            if coordinate.parameter == Parameter::Work {
                let work = values[Parameter::Work as usize];
                values[Parameter::ClosingWork as usize] = work.min(self.most_on_closing);
            }
        }
        values
    }

    /// Coordinates of the start.
    pub fn start(&self) -> Vec<f64> {
        self.coordinates.iter().map(|one| one.of(one.start, &self.base)).collect()
    }

    /// Consecutive parts of each segment in contact, which depend on each other less than points do.
    pub fn blocks(&self) -> Vec<Range<usize>> {
        let (mut blocks, mut from) = (Vec::new(), self.curve.free);
        for segment in self.curve.segment[from..].chunk_by(|one, next| one == next) {
            let end = |part: usize| from + segment.len() * part / PARTS;
            blocks.extend((0..PARTS).map(|part| end(part)..end(part + 1)));
            from += segment.len();
        }
        blocks
    }

    /// Straight lines of the curve that are refined with each model, see [`MeasuredCurve::lines`].
    pub fn lines(&self) -> Vec<Vec<f64>> {
        let has_zero = self.coordinates.iter().any(|one| one.parameter == Parameter::Zero);
        self.curve.lines(has_zero)
    }

    /// Root mean square residual in contact, in units of the noise; see [`scale`].
    pub fn misfit(&self, rests: &[f64]) -> f64 {
        scale(&rests[self.curve.free..], WRONG_SIDE)
    }
}

#[cfg(test)]
mod tests {
    use super::super::baseline::dot;
    use super::super::made::{read, rubber};
    use super::super::options::Drift;
    use super::*;

    fn space<'a>(curve: &'a MeasuredCurve, parameters: &[Parameter]) -> Space<'a> {
        let coordinate = |&parameter| Coordinate { parameter, start: 2.0, range: (1.0, 4.0), unit: 0.5 };
        Space {
            base: [3.0, 3.0, 5.0, 0.0, 0.0, 7.0, 1.0],
            coordinates: parameters.iter().map(coordinate).collect(),
            most_on_closing: 1.5,
            curve,
            stop: &|| false,
        }
    }

    #[test]
    fn blocks_are_parts_of_the_segments_in_contact() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let blocks = space(&curve, &[]).blocks();
        assert_eq!(blocks.len(), 2 * PARTS);
        assert_eq!(
            (blocks[0].start, blocks[3].end, blocks[4].start, blocks[7].end),
            (curve.free, 100, 100, 200)
        );
        assert!(blocks.windows(2).all(|pair| pair[0].end == pair[1].start));
        assert!(blocks.iter().all(|block| (10..=25).contains(&block.len())), "{blocks:?}");
    }

    #[test]
    fn zero_and_drift_are_lines_at_right_angles() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Remove);
        let [zero, drift] = &space(&curve, &[Parameter::Work]).lines()[..] else { panic!("two lines") };
        for (one, other, product) in [(zero, zero, 1.0), (drift, drift, 1.0), (zero, drift, 0.0)] {
            assert!((dot(one, other) - product).abs() < 1e-12);
        }
        assert!(zero.iter().all(|value| *value == zero[0]));
        let step = drift[1] - drift[0];
        assert!(step > 0.0 && drift.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 1e-12));
        let lines = space(&curve, &[Parameter::Zero]).lines();
        // A zero that is free is no line.
        let [drift] = &lines[..] else { panic!("one line") };
        let step = drift[1] - drift[0];
        assert!(step > 0.0 && drift.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 1e-12));
        let kept = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        assert_eq!(space(&kept, &[Parameter::Work]).lines().len(), 1);
    }

    #[test]
    fn a_work_that_is_found_holds_on_closing_too_up_to_that_of_the_scene() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let space = space(&curve, &[Parameter::Work, Parameter::Modulus]);
        let start = space.start();
        assert_eq!(start, [4.0_f64.asinh(), 2.0_f64.ln()]);
        let values = space.values(&start);
        assert!((values[0] - 2.0).abs() < 1e-12 && values[1] == 1.5 && (values[2] - 2.0).abs() < 1e-12);
        assert!((space.values(&[2.0_f64.asinh(), 0.0])[1] - 1.0).abs() < 1e-12);
        assert_eq!(values[5..], [7.0, 1.0]);
        let mut rests = vec![100.0; curve.force.len()];
        rests[curve.free..].fill(-3.0);
        assert!((space.misfit(&rests) - 3.0).abs() < 1e-12);
    }
}
