//! What the worker publishes: immutable, stamped with the generation of the scene it belongs to, and
//! already reduced to what a pane can show.

use super::worker::Focus;
use crate::contact::CurvePoint;
use crate::simulation::Outcome;

/// A computed scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Generation of the scene.
    pub generation: u64,
    /// What was computed.
    pub outcome: Outcome,
}

/// The contact at one moment of the animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Generation of the scene.
    pub generation: u64,
    /// Index of the leg.
    pub leg: usize,
    /// Where the close-up was asked to look.
    pub focus: Focus,
    /// Indentation, force, springs in contact and fragments.
    pub point: CurvePoint,
    /// Springs that changed state since the moment before.
    pub changed: u64,
    /// The whole line.
    pub profile: Section,
    /// The neighbourhood of one fragment.
    pub close_up: CloseUp,
}

/// A part of the line, reduced to one column for each column of dots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// First spring shown.
    pub first: usize,
    /// Springs shown.
    pub springs: usize,
    /// Lowest and highest z shown by the line over all springs of the section, m.
    pub heights: (f64, f64),
    /// Height of the undeformed elastic surface, m.
    pub level: f64,
    /// What stands in each column.
    pub columns: Vec<Column>,
}

/// One column of dots: the springs it stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Column {
    /// Lowest and highest point of the rigid line, m.
    pub line: (f64, f64),
    /// Lowest and highest point of the elastic surface, m.
    pub surface: (f64, f64),
    /// Lowest and highest point of the line where it is in contact, m.
    pub contact: Option<(f64, f64)>,
}

/// The neighbourhood of one contact fragment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloseUp {
    /// The springs shown.
    pub section: Section,
    /// Boundary points of the fragments shown: spring and z in m (the white circles of Fig. 3).
    pub boundaries: Vec<(usize, f64)>,
    /// The fragment nearest to the middle.
    pub fragment: Option<FragmentFacts>,
}

/// One contact fragment in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragmentFacts {
    /// Its number along the line, from 0.
    pub number: usize,
    /// Its first and last spring.
    pub springs: (usize, usize),
    /// Its length δx, m.
    pub length: f64,
    /// Largest stretch it bears by the rule of Hess, eq. (10), m; zero without adhesion.
    pub largest_stretch: f64,
    /// Stretch of its most stretched spring, m; negative when all are compressed.
    pub most_stretched: f64,
}

impl FragmentFacts {
    /// The spring in its middle.
    #[must_use]
    pub fn middle(&self) -> usize {
        let (first, last) = self.springs;
        first + (last - first) / 2
    }
}
