//! Table of the summaries of computed curves. The curves belong to random profiles and to the nodes
//! of a grid over ln(γ/E*) and ln E*.

use super::computed::Workers;
use super::summary::Summaries;
use crate::error::ExperimentError;

/// Index of ln γ among the parameters and the axes of a grid.
pub(crate) const WORK: usize = 0;
/// Index of ln E* among the parameters and the axes of a grid.
pub(crate) const MODULUS: usize = 1;

/// A pair of parameters of computed curves: `range` is ln(γ/E*), with γ/E* in m, and `modulus` is
/// ln E*, with E* in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub range: f64,
    pub modulus: f64,
}

impl Place {
    /// Returns ln γ and ln E*, with γ in J/m² and E* in Pa.
    pub fn parameters(self) -> [f64; 2] {
        [self.range + self.modulus, self.modulus]
    }
}

/// Returns `count` evenly spaced nodes that begin at `first`.
pub(crate) fn nodes(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| first + step * index as f64)
        .collect()
}

/// Step and number of the nodes of an axis of a table.
pub(crate) struct Axis {
    pub step: f64,
    pub nodes: usize,
}

impl Axis {
    fn width(&self) -> f64 {
        (self.nodes - 1) as f64 * self.step
    }

    /// Returns the position of the first node of an axis whose middle node is at `centre`.
    pub fn first_around(&self, centre: f64) -> f64 {
        centre - 0.5 * self.width()
    }

    pub fn nodes_from(&self, first: f64) -> Vec<f64> {
        nodes(first, self.step, self.nodes)
    }

    pub fn nodes_around(&self, centre: f64) -> Vec<f64> {
        self.nodes_from(self.first_around(centre))
    }
}

/// Summaries of the curves of all random profiles at the nodes of a grid over ln(γ/E*) and ln E*.
pub(crate) struct Table {
    /// Values of ln(γ/E*), ascending and evenly spaced, with γ/E* in m.
    pub ranges: Vec<f64>,
    /// Values of ln E*, ascending and evenly spaced, with E* in Pa.
    pub moduli: Vec<f64>,
    /// Summaries of the curves of each random profile at all nodes. A node is a pair of a value
    /// ln(γ/E*) and a value ln E*. All moduli of the first range come first.
    pub profiles: Vec<Vec<Summaries>>,
}

/// An end of one of the two axes of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    LowRange,
    HighRange,
    LowModulus,
    HighModulus,
}

impl End {
    /// Returns true for an end of the axis of E*.
    pub fn is_of_modulus(self) -> bool {
        matches!(self, End::LowModulus | End::HighModulus)
    }

    fn is_low(self) -> bool {
        matches!(self, End::LowRange | End::LowModulus)
    }

    /// Returns `count` further nodes beyond this end of an axis.
    fn nodes_beyond(self, axis: &[f64], count: usize) -> Vec<f64> {
        let step = axis[1] - axis[0];
        if self.is_low() {
            nodes(axis[0] - step * count as f64, step, count)
        } else {
            nodes(axis[axis.len() - 1] + step, step, count)
        }
    }

    /// Returns the index in an axis at which further nodes are inserted.
    fn place_in(self, axis: &[f64]) -> usize {
        if self.is_low() { 0 } else { axis.len() }
    }
}

impl Table {
    pub fn new(
        workers: &Workers<'_>,
        profiles: u64,
        ranges: Vec<f64>,
        moduli: Vec<f64>,
    ) -> Result<Self, ExperimentError> {
        let profiles = workers.curves(profiles, &ranges, &moduli)?;
        Ok(Table {
            ranges,
            moduli,
            profiles,
        })
    }

    /// Adds `count` further values beyond one end of an axis of the table, and computes the curves
    /// for them.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the computation is stopped.
    pub fn extend(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        if end.is_of_modulus() {
            self.extend_moduli(workers, end, count)
        } else {
            self.extend_ranges(workers, end, count)
        }
    }

    fn extend_ranges(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let added = end.nodes_beyond(&self.ranges, count);
        let place = end.place_in(&self.ranges);
        let new = workers.curves(self.profiles.len() as u64, &added, &self.moduli)?;
        let start = place * self.moduli.len();
        for (profile, curves) in self.profiles.iter_mut().zip(new) {
            profile.splice(start..start, curves);
        }
        self.ranges.splice(place..place, added);
        Ok(())
    }

    fn extend_moduli(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let added = end.nodes_beyond(&self.moduli, count);
        let place = end.place_in(&self.moduli);
        let new = workers.curves(self.profiles.len() as u64, &self.ranges, &added)?;
        for (profile, curves) in self.profiles.iter_mut().zip(new) {
            let mut extended = Vec::with_capacity(profile.len() + curves.len());
            let rows = profile.chunks(self.moduli.len()).zip(curves.chunks(count));
            for (old, new) in rows {
                extended.extend_from_slice(&old[..place]);
                extended.extend_from_slice(new);
                extended.extend_from_slice(&old[place..]);
            }
            *profile = extended;
        }
        self.moduli.splice(place..place, added);
        Ok(())
    }

    /// Returns the nodes, the pairs of values for which curves were computed, in the order of
    /// [`Self::profiles`].
    pub fn places(&self) -> Vec<Place> {
        places(&self.ranges, &self.moduli)
    }
}

/// Returns all pairs of a range and a modulus. All moduli of the first range come first.
pub(crate) fn places(ranges: &[f64], moduli: &[f64]) -> Vec<Place> {
    let mut places = Vec::with_capacity(ranges.len() * moduli.len());
    for &range in ranges {
        for &modulus in moduli {
            places.push(Place { range, modulus });
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::specimens::{curve, scene};
    use crate::fit::ensemble::computed::Specimen;
    use crate::fit::ensemble::summary::{Branches, Protocol};
    use asperity_scene::Simulation;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// An extended table equals a table that had the larger size from the beginning, for any number
    /// of threads.
    #[test]
    fn extended_tables_are_larger_tables() {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 1024;
        scene.set_seed(3);
        let branches = Branches::of(&curve(&mut Simulation::default(), &scene, 3, 0.01)).unwrap();
        let protocols = [Protocol::of(&branches, branches.preload())];
        let computed = AtomicUsize::new(0);
        let scene = scene.checked().unwrap();
        let simulation = Simulation::default();
        let workers = |jobs| Workers {
            specimen: Specimen {
                scene: &scene,
                stiffness: 200.0,
                closing: 0.5,
                protocols: &protocols,
                stop: &|| false,
            },
            simulation: &simulation,
            jobs,
            computed: &computed,
            report: &|_| (),
        };
        let (one, three) = (workers(1), workers(3));
        let mut grown = Table::new(&one, 3, nodes(-18.0, 0.5, 2), nodes(14.5, 0.5, 2)).unwrap();
        for end in [
            End::LowRange,
            End::HighModulus,
            End::HighRange,
            End::LowModulus,
        ] {
            grown.extend(&three, end, 1).unwrap();
        }
        assert_eq!(computed.load(Ordering::Relaxed), 3 * 16);
        let whole = Table::new(&three, 3, nodes(-18.5, 0.5, 4), nodes(14.0, 0.5, 4)).unwrap();
        assert_eq!(
            (&grown.ranges, &grown.moduli),
            (&whole.ranges, &whole.moduli)
        );
        assert_eq!(grown.profiles, whole.profiles);
        let stopped = Workers {
            specimen: Specimen {
                stop: &|| true,
                ..one.specimen
            },
            ..one
        };
        assert!(stopped.curves(1, &[-18.0], &[14.5]).is_err());
    }
}
