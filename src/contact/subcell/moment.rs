//! What fragments come to at one moment, given where they are: for a look at a contact that is not solved
//! again.

use super::edges::{EdgeSum, Slider};
use crate::contact::tally::GapScale;
use crate::contact::{CurvePoint, Foundation, HessRule, Tally};

/// A line with edges between its springs, looked at one contact at a time.
#[derive(Clone, Copy, Debug)]
pub struct SubCellMoment<'a> {
    gaps: &'a [f64],
    scale: GapScale,
    /// Largest stretch of a fragment of one cell, m.
    stretch: f64,
}

impl<'a> SubCellMoment<'a> {
    /// A line of these gaps, the largest of which is `deepest`, m; `hess` is the rule of Hess, `None` without
    /// adhesion.
    #[must_use]
    pub fn new(gaps: &'a [f64], deepest: f64, hess: Option<HessRule>) -> Self {
        let stretch = hess.map_or(0.0, |hess| hess.largest_stretch(1));
        SubCellMoment { gaps, scale: GapScale::for_gaps_up_to(deepest), stretch }
    }

    /// The point of the curve at an indentation, m, at which these fragments, given by first and last
    /// spring, are in contact. Takes as long as there are springs in contact.
    #[must_use]
    pub fn point(
        &self,
        foundation: Foundation,
        indentation: f64,
        fragments: &[(usize, usize)],
    ) -> CurvePoint {
        let mut tally = Tally::default();
        let mut sum = EdgeSum::default();
        for &(first, last) in fragments {
            tally.springs += (last + 1 - first) as i64;
            tally.fragments += 1;
            let cells = self.gaps[first..=last].windows(2);
            tally.quanta +=
                cells.map(|cell| i128::from(self.scale.mean_quanta(cell[0], cell[1]))).sum::<i128>();
            sum.add(self.slider((first, last)).edges(indentation));
        }
        let edges = sum.total();
        let compression = tally.compression_of_cells(indentation, &self.scale) + edges.compression;
        CurvePoint {
            indentation,
            force: foundation.spring_stiffness() * compression,
            contact_length: foundation.contact_length(tally.cells() as f64 + edges.length),
            springs: tally.springs.unsigned_abs(),
            fragments: tally.fragments.unsigned_abs(),
        }
    }

    /// Largest stretch Δl_max, m, that a fragment of so many cells bears, eq. (10).
    #[must_use]
    pub fn largest_stretch(&self, cells: f64) -> f64 {
        self.stretch * cells.sqrt()
    }

    /// How the fragment with these first and last springs slides.
    #[must_use]
    pub fn slider(&self, fragment: (usize, usize)) -> Slider {
        Slider::of_springs(self.gaps, fragment, self.stretch)
    }
}
