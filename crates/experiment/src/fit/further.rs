//! A further curve of the specimen that a search compares.

use crate::fit::model::Model;
use crate::fit::population::Member;
use crate::fit::space::Space;
use std::ops::Range;

/// Further curve that a search compares, in addition to the curve of its own space.
pub(crate) struct FurtherCurve<'a> {
    /// Coordinates of the parameters of this curve alone. A coordinate is a free parameter on the
    /// scale of the search.
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    pub part: PartOfSearch,
}

impl FurtherCurve<'_> {
    /// Returns the coordinates of this curve from all coordinates `place` of the search.
    pub fn place(&self, place: &[f64]) -> Vec<f64> {
        self.part.place(place)
    }

    /// Returns this curve's member at the coordinates `place` of the search, before the curve is
    /// computed.
    pub fn member(&self, place: &[f64]) -> Member {
        Member {
            place: self.place(place),
            residuals: Vec::new(),
            in_contact: Vec::new(),
        }
    }
}

/// Part of a search that belongs to one curve.
#[derive(Clone, Debug)]
pub(crate) struct PartOfSearch {
    /// For each coordinate of the curve, its index among the coordinates of the search.
    pub coordinates: Vec<usize>,
    /// Indices of the points of the curve among the points of all curves.
    pub points: Range<usize>,
}

impl PartOfSearch {
    /// Returns the coordinates of the curve from all coordinates `place` of the search.
    pub fn place(&self, place: &[f64]) -> Vec<f64> {
        self.coordinates.iter().map(|index| place[*index]).collect()
    }

    /// Returns the coordinates of the curve for several `places`, each of which has all coordinates
    /// of the search.
    pub fn places(&self, places: &[Vec<f64>]) -> Vec<Vec<f64>> {
        places.iter().map(|place| self.place(place)).collect()
    }
}
