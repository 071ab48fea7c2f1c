//! The rigid profile as the contact needs it: the gaps between its highest point and its surface.

use super::form::Form;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{gathered, resized};
use std::sync::Arc;

/// A rigid profile above a row of springs at the positions x = (i + ½)Δx, i = 0, 1, ….
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Gaps c_i = max z − z_i in m, one for each spring i under the body. z_i is the height of the
    /// profile above spring i, and max z is its highest point. Each gap is at least 0.
    pub gaps: Arc<Vec<f64>>,
    /// Index of the leftmost spring under the body, counted from the left end of the foundation
    /// (the row of all springs). The index is above zero only for a punch.
    pub first: usize,
    /// Number N of all springs of the foundation, including those beside the body.
    pub points: usize,
    /// Length L of the whole foundation in m.
    pub length: f64,
    /// Distance Δx = L/N between springs in m.
    pub spacing: f64,
    /// Height in m of the highest point of the profile, measured from the apex of the form without
    /// roughness.
    pub summit: f64,
    /// Largest gap in m.
    pub deepest: f64,
}

impl Line {
    /// Creates the rigid profile of a form on N = `points` springs, with roughness. If `form` is
    /// `None`, the body is flat; if `roughness` is `None`, it is smooth.
    ///
    /// `roughness` has one height for each spring, in units of `scale` (m). The heights must
    /// already be displaced by [`Form::shift`], so that they fit to the axis of the form. The
    /// profile of a punch has only the springs under its flat end ([`Form::springs_under`]).
    ///
    /// # Errors
    /// Returns an error if the memory is too small, if a height is not finite, or if no spring lies
    /// under a punch.
    ///
    /// ```
    /// use asperity_surface::Form;
    /// use asperity_surface::lines::Line;
    ///
    /// let line = Line::new(1e-4, 101, Some(&Form::Paraboloid { radius: 1e-3 }), None, 0.0)?;
    /// assert_eq!((line.gaps.len(), line.gaps[50]), (101, 0.0));
    /// assert!(Line::new(1e-4, 101, Some(&Form::Punch { radius: 1e-9 }), None, 0.0).is_err());
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn new(
        length: f64,
        points: usize,
        form: Option<&Form>,
        roughness: Option<&[f64]>,
        scale: f64,
    ) -> Result<Self, SurfaceError> {
        let heights = match roughness {
            Some(rough) => gathered(points, rough.iter().copied())?,
            None => resized(Vec::new(), points, 0.0)?,
        };
        Line::from_roughness(heights, length, form, scale)
    }

    /// Creates the same profile as [`Line::new`], but in the memory of the vector `gaps`. At first
    /// this vector has the heights of the roughness in units of `scale` (m), one for each spring.
    /// Afterwards it has the gaps of the profile.
    ///
    /// # Errors
    /// Returns the errors of [`Line::new`].
    pub fn from_roughness(
        mut gaps: Vec<f64>,
        length: f64,
        form: Option<&Form>,
        scale: f64,
    ) -> Result<Self, SurfaceError> {
        let points = gaps.len();
        let spacing = length / points as f64;
        let under = match form {
            Some(form) => form.springs_under(length, points as u64),
            None => 0..points as u64,
        };
        if under.is_empty() {
            return Err(no_springs(spacing));
        }
        let first = under.start as usize;
        gaps.truncate(under.end as usize);
        gaps.drain(..first);
        match form {
            None => gaps.iter_mut().for_each(|height| *height *= scale),
            Some(form) => {
                let depths = Depths::new(form, points, spacing)?;
                for (index, height) in (first..).zip(&mut gaps) {
                    *height = scale * *height - depths.depth(index);
                }
            }
        }

        let not_finite = |index| not_finite(first + index);
        let summit = largest(&gaps).map_err(not_finite)?;
        for height in &mut gaps {
            *height = summit - *height;
        }
        let deepest = largest(&gaps).map_err(not_finite)?;
        Ok(Line {
            gaps: Arc::new(gaps),
            first,
            points,
            length,
            spacing,
            summit,
            deepest,
        })
    }

    /// Returns the heights z in m of the profile at the springs under the body. Heights are
    /// measured from the apex of the form without roughness.
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.gaps.iter().map(|gap| self.height(*gap))
    }

    /// Returns the height in m of a point with this gap in m.
    fn height(&self, gap: f64) -> f64 {
        let height = self.summit - gap;
        // The height is rounded, so its gap may differ from the given gap in the last bit. Then the
        // next larger or the next smaller number has exactly the given gap.
        let nearby = [height, height.next_up(), height.next_down()];
        nearby
            .into_iter()
            .find(|height| self.summit - height == gap)
            .unwrap_or(height)
    }

    /// Returns the position x in m of a spring under the body. `index` is 0 for the leftmost spring
    /// under the body.
    pub fn position(&self, index: usize) -> f64 {
        ((self.first + index) as f64 + 0.5) * self.spacing
    }

    /// Returns the height in m of the lowest point of the profile, measured from the apex of the
    /// form without roughness.
    pub fn lowest(&self) -> f64 {
        self.height(self.deepest)
    }
}

/// Depths of the equivalent profile of a form at each spring.
struct Depths<'a> {
    form: &'a Form,
    points: usize,
    spacing: f64,
    /// For the form of a table, its depths in m at the springs, from the spring on the axis
    /// outwards; `None` for other forms.
    of_table: Option<Vec<f64>>,
}

impl<'a> Depths<'a> {
    fn new(form: &'a Form, points: usize, spacing: f64) -> Result<Self, SurfaceError> {
        let of_table = match form.table() {
            Some(table) => Some(table.depths(spacing, points / 2 + 1)?),
            None => None,
        };
        Ok(Depths {
            form,
            points,
            spacing,
            of_table,
        })
    }

    fn depth(&self, index: usize) -> f64 {
        match &self.of_table {
            Some(depths) => depths[index.abs_diff(self.points / 2)],
            None => self.form.depth_of_spring(index, self.points, self.spacing),
        }
    }
}

/// Returns the largest value. If a value is not finite, the error is the index of the first such
/// value.
fn largest(values: &[f64]) -> Result<f64, usize> {
    // Eight maxima are computed side by side. With a single maximum, each comparison would have to
    // wait for the previous one.
    let mut largest = [f64::NEG_INFINITY; 8];
    let mut all_finite = true;
    let mut take = |values: &[f64]| {
        for (largest, &value) in largest.iter_mut().zip(values) {
            *largest = if value > *largest { value } else { *largest };
            all_finite &= value.is_finite();
        }
    };
    let (whole, rest) = values.as_chunks::<8>();
    whole.iter().for_each(|eight| take(eight));
    take(rest);
    if !all_finite {
        let index = values.iter().position(|value| !value.is_finite());
        return Err(index.unwrap_or(0));
    }
    Ok(largest.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

/// Histogram of heights: how many heights lie in each of several bins of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Lower end of the first bin in m.
    pub low: f64,
    /// Upper end of the last bin in m.
    pub high: f64,
    /// Number of heights in each bin.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Counts `heights` (m) in `bins` equal bins between `low` and `high` (m). A height equal to
    /// `low` or `high` is counted. Heights outside this range, and heights that are not finite, are
    /// left out.
    ///
    /// ```
    /// let histogram =
    ///     asperity_surface::lines::Histogram::new([0.1, 0.2, 0.9].into_iter(), 0.0, 1.0, 2);
    /// assert_eq!(histogram.counts, [2, 1]);
    /// ```
    pub fn new(heights: impl Iterator<Item = f64>, low: f64, high: f64, bins: usize) -> Self {
        let mut counts = vec![0; bins.max(1)];
        let last = counts.len() - 1;
        let scale = counts.len() as f64 / (high - low);
        for height in heights {
            if (low..=high).contains(&height) {
                // If `low` equals `high`, the product is NaN, and its conversion to an integer
                // gives bin 0.
                let bin = ((height - low) * scale) as usize;
                counts[bin.min(last)] += 1;
            }
        }
        Histogram { low, high, counts }
    }
}

/// Returns the error for a punch that is so narrow that no spring lies under it. The diameter of a
/// punch is rounded to a whole number of spacings, so it is too small if it is below half of
/// `spacing` in m.
fn no_springs(spacing: f64) -> SurfaceError {
    let found = "no spring lies under the punch";
    let allowed = format!("at least a quarter of the spacing, {:e} m", spacing / 4.0);
    refused(Place::Field("form.radius"), found, allowed)
}

/// Returns the error for a height that is not finite, at the spring with this index.
fn not_finite(spring: usize) -> SurfaceError {
    let found = "the line has a height that is not finite";
    let allowed = "a form and roughness whose heights are finite";
    refused(Place::Point(spring + 1), found, allowed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::modes::phases;

    #[test]
    fn a_spring_is_on_the_axis_and_forms_are_symmetric_about_it() {
        for form in [
            Form::Cone { angle: 0.2 },
            Form::Paraboloid { radius: 3.0 },
            Form::Power {
                coefficient: 0.4,
                exponent: 1.5,
            },
        ] {
            for points in 1..30 {
                let line = Line::new(1.0, points, Some(&form), None, 0.0).unwrap();
                let axis = points / 2;
                assert_eq!((line.gaps[axis], line.summit), (0.0, 0.0));
                let middle = line.position(axis) - 0.5;
                assert!((0.0..=0.5 * line.spacing + 1e-15).contains(&middle.abs()));
                let left = line.gaps[..axis].iter().rev();
                assert!(
                    left.zip(&line.gaps[axis + 1..])
                        .all(|(left, right)| left == right)
                );
            }
        }
    }

    #[test]
    fn only_springs_under_a_punch_belong_to_the_line() {
        let line = Line::new(1.0, 10, Some(&Form::Punch { radius: 0.2 }), None, 0.0).unwrap();
        assert_eq!((line.first, line.gaps.len()), (3, 4));
        let none = Line::new(1.0, 10, Some(&Form::Punch { radius: 0.02 }), None, 0.0);
        assert_eq!(none, Err(no_springs(0.1)));
    }

    #[test]
    fn roughness_becomes_the_same_gaps_in_its_own_memory() {
        let rough: Vec<f64> = phases(7, 1).take(40).collect();
        let forms = [
            Form::Paraboloid { radius: 3.0 },
            Form::Cone { angle: 0.2 },
            Form::Punch { radius: 0.2 },
        ];
        for form in forms.iter().map(Some).chain([None]) {
            let expected = Line::new(1.0, 40, form, Some(&rough), 0.3).unwrap();
            let own = rough.clone();
            let memory = own.as_ptr();
            let line = Line::from_roughness(own, 1.0, form, 0.3).unwrap();
            assert_eq!((&line, line.gaps.as_ptr()), (&expected, memory));
        }
        let thin = Form::Punch { radius: 0.002 };
        let error = Line::new(1.0, 40, Some(&thin), Some(&rough), 0.3);
        assert_eq!(Line::from_roughness(rough, 1.0, Some(&thin), 0.3), error);
        let refused = Line::from_roughness(vec![0.0, f64::INFINITY], 1.0, None, 1.0);
        assert_eq!(refused, Err(not_finite(1)));
    }

    #[test]
    fn gaps_follow_from_heights_bit_for_bit() {
        let written = |line: &Line| line.heights().collect::<Vec<f64>>();
        let digit = f64::EPSILON;
        // The exact gap is 1. The rounded height summit − 1 = −1 would give the gap 1 − ε/2.
        let line = Line::new(1.0, 2, None, Some(&[-0.5 * digit, -1.0 - digit]), 1.0).unwrap();
        assert_eq!(
            (line.gaps[1], line.summit - (line.summit - 1.0)),
            (1.0, 1.0 - 0.5 * digit)
        );
        assert_eq!(
            Line::new(1.0, 2, None, Some(&written(&line)), 1.0).unwrap(),
            line
        );
        for seed in 0..200 {
            let rough: Vec<f64> = phases(seed, 1)
                .take(64)
                .map(|phase| phase - 0.1 * seed as f64)
                .collect();
            let form = Form::Paraboloid { radius: 3.0 };
            let line = Line::new(1.0, 64, Some(&form), Some(&rough), 0.3).unwrap();
            assert_eq!(
                Line::new(1.0, 64, None, Some(&written(&line)), 1.0).unwrap(),
                line
            );
            assert_eq!(
                line.lowest(),
                written(&line).into_iter().fold(f64::INFINITY, f64::min)
            );
        }
    }

    #[test]
    fn heights_that_are_not_finite_are_refused() {
        let result = Line::new(1.0, 3, None, Some(&[0.0, 1e300, 0.0]), 1e300);
        assert_eq!(result, Err(not_finite(1)));
        // The punch covers only the springs 1 to 4 of the six. The gap at spring 4 is not finite,
        // so the error must state its index among all springs, which is 4.
        let rough = [0.0, 0.0, 1e308, 0.0, -1e308, 0.0];
        let result = Line::new(
            1.0,
            6,
            Some(&Form::Punch { radius: 0.3 }),
            Some(&rough),
            1.0,
        );
        assert_eq!(result, Err(not_finite(4)));
        for points in 1..40 {
            for bad in 0..points {
                let mut rough: Vec<f64> = (0..points).map(|i| (i * i % 7) as f64).collect();
                let expected = rough.iter().copied().fold(0.0, f64::max);
                let line = Line::new(1.0, points, None, Some(&rough), 1.0).unwrap();
                assert_eq!(
                    (line.summit, line.gaps[bad]),
                    (expected, expected - rough[bad])
                );
                assert_eq!(line.deepest, line.gaps.iter().copied().fold(0.0, f64::max));
                rough[bad..].fill(f64::NAN);
                let result = Line::new(1.0, points, None, Some(&rough), 1.0);
                assert_eq!(result, Err(not_finite(bad)));
            }
        }
    }

    #[test]
    fn counts_every_height_once() {
        let heights = [0.0, 0.1, 0.49, 0.5, 0.99, 1.0];
        let histogram = Histogram::new(heights.into_iter(), 0.0, 1.0, 2);
        assert_eq!(histogram.counts, [3, 3]);
        assert_eq!(
            Histogram::new([2.0; 5].into_iter(), 2.0, 2.0, 3).counts,
            [5, 0, 0]
        );
        assert_eq!(
            Histogram::new([f64::NAN, -1.0].into_iter(), 0.0, 1.0, 3).counts,
            [0; 3]
        );
    }
}
