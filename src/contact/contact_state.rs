//! Contact at one indentation and along a grid of indentations.

use super::grid::Grid;
use super::totals::ContactTotals;
use super::{CurvePoint, Foundation};

/// Contact state at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    /// d, m.
    pub indentation: f64,
    /// Springs in contact.
    pub springs: i64,
    /// Fragments they form.
    pub fragments: i64,
    /// Contact length in units of the distance between springs.
    pub length: f64,
    /// Compression ∫ (d − c) dx in units of that distance, m: the force in units of the stiffness of one spring.
    pub compression: f64,
}

impl ContactState {
    /// Nothing in contact at this indentation, m.
    pub fn free(indentation: f64) -> Self {
        ContactState { indentation, ..ContactState::default() }
    }

    /// The point of the curve on this foundation.
    pub fn point(&self, foundation: Foundation) -> CurvePoint {
        CurvePoint {
            indentation: self.indentation,
            force: foundation.spring_stiffness() * self.compression,
            contact_length: foundation.contact_length(self.length),
            springs: self.springs.unsigned_abs(),
            fragments: self.fragments.unsigned_abs(),
        }
    }
}

/// Contact at each point of a grid, at least one.
pub struct Sampled {
    pub grid: Grid,
    /// Totals of the full springs or cells at each point.
    pub totals: Vec<ContactTotals>,
    pub states: Vec<ContactState>,
}

impl Sampled {
    /// The points of both grids, which have none in common.
    pub fn merged(self, other: Sampled) -> Sampled {
        let both = [self, other].into_iter();
        let mut points: Vec<_> = both.flat_map(|leg| leg.states.into_iter().zip(leg.totals)).collect();
        points.sort_by(|(one, _), (other, _)| one.indentation.total_cmp(&other.indentation));
        let grid = Grid::at(points.iter().map(|(state, _)| state.indentation).collect());
        let (states, totals) = points.into_iter().unzip();
        Sampled { grid, totals, states }
    }

    /// State at the lowest indentation.
    pub fn first(&self) -> ContactState {
        self.states[0]
    }

    /// State at the highest indentation.
    pub fn last(&self) -> ContactState {
        self.states[self.states.len() - 1]
    }

    /// The intervals of the grid for which the contact at their ends allows it.
    pub fn choose(&self, may_lie: impl Fn(&ContactState, &ContactState) -> bool) -> Vec<usize> {
        let ends = self.states.windows(2).enumerate();
        ends.filter(|(_, ends)| may_lie(&ends[0], &ends[1])).map(|(index, _)| index).collect()
    }

    /// Contact at the ends of an interval of the grid.
    pub fn ends(&self, interval: usize) -> (&ContactState, &ContactState) {
        (&self.states[interval], &self.states[interval + 1])
    }
}
