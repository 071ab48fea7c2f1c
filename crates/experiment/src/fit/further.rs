//! A further curve of the specimen that a search compares.

use crate::fit::model::Model;
use crate::fit::population::Member;
use crate::fit::space::Space;
use std::ops::Range;

/// Curve that a search compares beside that of its space.
pub(crate) struct FurtherCurve<'a> {
    /// Coordinates of this curve alone.
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    pub part: PartOfSearch,
}

impl FurtherCurve<'_> {
    /// Returns the coordinates of this curve at a place of the search.
    pub fn place(&self, place: &[f64]) -> Vec<f64> {
        self.part.place(place)
    }

    /// Returns the member of this curve at a place of the search, before a comparison.
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
    /// Index among the coordinates of the search of each coordinate of the curve.
    pub coordinates: Vec<usize>,
    /// Index range of the points of the curve among all points.
    pub points: Range<usize>,
}

impl PartOfSearch {
    /// Returns the coordinates of the curve at a place of the search.
    pub fn place(&self, place: &[f64]) -> Vec<f64> {
        self.coordinates.iter().map(|index| place[*index]).collect()
    }

    /// Returns the coordinates of the curve at several places of the search.
    pub fn places(&self, places: &[Vec<f64>]) -> Vec<Vec<f64>> {
        places.iter().map(|place| self.place(place)).collect()
    }
}
