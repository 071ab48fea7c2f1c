//! Forces and lengths of given fragments at one indentation: a view of a contact without a new solution.

use super::adhesive::{EdgeModel, GridEdges, Slider, Span, SubCellEdges};
use super::contact_state::ContactState;
use super::steady::state;
use super::totals::{ContactTotals, GapScale};
use super::{CurvePoint, Foundation, HessRule};
use crate::scene::Edges;

/// A line of springs, viewed one contact at a time.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    gaps: &'a [f64],
    scale: GapScale,
    edges: Edges,
    hess: HessRule,
}

/// Length, load and stretch of one fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragmentState {
    /// Length in cells.
    pub length: f64,
    /// Compression ∫ (d − c) dx, in cells times metres: the force in units of the stiffness of one spring.
    pub compression: f64,
    /// Largest stretch Δl_max at this length, m, eq. (10).
    pub largest_stretch: f64,
    /// Stretch of its edges, or of its most stretched spring, m.
    pub most_stretched: f64,
}

impl<'a> Snapshot<'a> {
    /// Returns a line of these gaps, the largest of which is `deepest`, m; `hess` is the rule of Hess, `None` without
    /// adhesion.
    #[must_use]
    pub fn new(gaps: &'a [f64], deepest: f64, edges: Edges, hess: Option<HessRule>) -> Self {
        let hess = hess.unwrap_or(HessRule::NO_ADHESION);
        Snapshot { gaps, scale: GapScale::for_gaps_up_to(deepest), edges, hess }
    }

    /// The point of the curve at an indentation, m, at which these fragments, given by first and last spring, are in
    /// contact; their `rises` are those of [`Solver::rises`](super::Solver::rises). Takes O(springs in contact).
    #[must_use]
    pub fn point(
        &self,
        foundation: Foundation,
        indentation: f64,
        fragments: &[(usize, usize)],
        rises: &[f64],
    ) -> CurvePoint {
        let contact = match self.edges {
            Edges::Grid => self.contact(GridEdges::new(self.hess), indentation, fragments, rises),
            Edges::SubCell => self.contact(SubCellEdges::new(self.hess), indentation, fragments, rises),
        };
        contact.point(foundation)
    }

    /// The fragment with these first and last springs at an indentation, m, and its rise, if any, m.
    #[must_use]
    pub fn fragment(&self, indentation: f64, ends: (usize, usize), rise: Option<f64>) -> FragmentState {
        match self.edges {
            Edges::Grid => self.fragment_under(GridEdges::new(self.hess), indentation, ends, rise),
            Edges::SubCell => self.fragment_under(SubCellEdges::new(self.hess), indentation, ends, rise),
        }
    }

    fn contact<E: EdgeModel>(
        &self,
        edges: E,
        indentation: f64,
        fragments: &[(usize, usize)],
        rises: &[f64],
    ) -> ContactState {
        let mut totals = ContactTotals::default();
        fragments.iter().for_each(|&ends| totals += self.totals(E::EDGES, ends));
        let sliders = fragments.iter().enumerate().map(|(index, &ends)| {
            Slider::new(self.gaps, &self.span(ends), edges.stretch(), rises.get(index).copied())
        });
        state(edges, &self.scale, totals, sliders, indentation)
    }

    fn fragment_under<E: EdgeModel>(
        &self,
        edges: E,
        indentation: f64,
        ends: (usize, usize),
        rise: Option<f64>,
    ) -> FragmentState {
        let ContactState { length, compression, .. } =
            self.contact(edges, indentation, &[ends], rise.as_slice());
        let span = self.span(ends);
        let of_indentation = || edges.rise(&edges.levels(self.gaps, &span), indentation);
        let level = span.gap + rise.unwrap_or_else(of_indentation);
        FragmentState {
            length,
            compression,
            largest_stretch: edges.stretch() * length.sqrt(),
            most_stretched: level - indentation,
        }
    }

    fn span(&self, (first, last): (usize, usize)) -> Span {
        let gap = self.gaps[first..=last].iter().copied().fold(0.0, f64::max);
        Span { gap, first, last }
    }

    /// Whole springs or cells of a fragment.
    fn totals(&self, edges: Edges, (first, last): (usize, usize)) -> ContactTotals {
        let springs = &self.gaps[first..=last];
        let quanta = match edges {
            Edges::Grid => springs.iter().map(|&gap| i128::from(self.scale.quanta(gap))).sum(),
            Edges::SubCell => {
                let cells = springs.windows(2);
                cells.map(|cell| i128::from(self.scale.mean_quanta(cell[0], cell[1]))).sum()
            }
        };
        ContactTotals { springs: springs.len() as i64, fragments: 1, quanta }
    }
}
