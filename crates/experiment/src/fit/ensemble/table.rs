//! Summaries of computed curves of the same random profiles, at all nodes of a grid over ln(γ/E*)
//! and ln E*.

use super::computed::{Place, Specimen};
use super::summary::Summaries;
use crate::error::ExperimentError;
use asperity_data::on_threads;
use asperity_scene::Simulation;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Threads that compute the curves of a table.
#[derive(Clone, Copy)]
pub(crate) struct Workers<'a> {
    pub specimen: Specimen<'a>,
    /// Folder of the files of the scene.
    pub folder: &'a Path,
    pub jobs: usize,
    /// Number of curves computed so far, and the function that is notified of it.
    pub computed: &'a AtomicUsize,
    pub report: &'a (dyn Fn(usize) + Sync),
}

impl Workers<'_> {
    /// Returns the summaries of the curves of each random profile at all nodes, with all moduli of
    /// one range together.
    pub fn curves(
        &self,
        lines: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Vec<Summaries>>, ExperimentError> {
        let worker = || {
            let mut simulation = Simulation::new(self.folder.to_path_buf());
            move |line: u64| {
                let curves = self
                    .specimen
                    .curves(&mut simulation, line, ranges, moduli)?;
                let before = self.computed.fetch_add(curves.len(), Ordering::Relaxed);
                (self.report)(before + curves.len());
                Ok(curves)
            }
        };
        on_threads(lines, self.jobs, worker)
    }
}

/// Evenly spaced nodes.
pub(crate) fn nodes(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| first + step * index as f64)
        .collect()
}

/// Grid of nodes, each with the summaries of the curves of all random profiles.
pub(crate) struct Table {
    /// ln(γ/E*), ascending and evenly spaced.
    pub ranges: Vec<f64>,
    /// ln E*, ascending and evenly spaced.
    pub moduli: Vec<f64>,
    /// Summaries of each random profile at all nodes, with all moduli of one range together.
    pub lines: Vec<Vec<Summaries>>,
}

/// An end of a table.
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
}

impl Table {
    pub fn new(
        workers: &Workers<'_>,
        lines: u64,
        ranges: Vec<f64>,
        moduli: Vec<f64>,
    ) -> Result<Self, ExperimentError> {
        let lines = workers.curves(lines, &ranges, &moduli)?;
        Ok(Table {
            ranges,
            moduli,
            lines,
        })
    }

    /// Adds `count` nodes at an end.
    pub fn extend(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let axis = match end {
            End::LowRange | End::HighRange => &self.ranges,
            End::LowModulus | End::HighModulus => &self.moduli,
        };
        let (step, last) = (axis[1] - axis[0], axis[axis.len() - 1]);
        let added = match end {
            End::LowRange | End::LowModulus => nodes(axis[0] - step * count as f64, step, count),
            End::HighRange | End::HighModulus => nodes(last + step, step, count),
        };
        let lines = self.lines.len() as u64;
        match end {
            End::LowRange | End::HighRange => {
                let at = if end == End::LowRange {
                    0
                } else {
                    self.ranges.len()
                };
                let new = workers.curves(lines, &added, &self.moduli)?;
                let start = at * self.moduli.len();
                for (line, curves) in self.lines.iter_mut().zip(new) {
                    line.splice(start..start, curves);
                }
                self.ranges.splice(at..at, added);
            }
            End::LowModulus | End::HighModulus => {
                let at = if end == End::LowModulus {
                    0
                } else {
                    self.moduli.len()
                };
                let new = workers.curves(lines, &self.ranges, &added)?;
                for (line, curves) in self.lines.iter_mut().zip(new) {
                    let rows = line.chunks(self.moduli.len()).zip(curves.chunks(count));
                    *line = rows
                        .flat_map(|(old, new)| [&old[..at], new, &old[at..]].concat())
                        .collect();
                }
                self.moduli.splice(at..at, added);
            }
        }
        Ok(())
    }

    /// Nodes in the order of the curves of a line.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        self.ranges.iter().flat_map(|&range| {
            self.moduli
                .iter()
                .map(move |&modulus| Place { range, modulus })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ensemble::branches::Branches;
    use crate::fit::ensemble::computed::Protocol;
    use crate::fit::ensemble::specimens::{curve, scene};

    /// A table that was extended is the larger table from the beginning, by any number of threads.
    #[test]
    fn extended_tables_are_larger_tables() {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 1024;
        scene.set_seed(3);
        let branches = Branches::of(&curve(&mut Simulation::default(), &scene, 3, 0.01)).unwrap();
        let protocols = [Protocol::of(&branches, branches.preload())];
        let computed = AtomicUsize::new(0);
        let scene = scene.checked().unwrap();
        let workers = |jobs| Workers {
            specimen: Specimen {
                scene: &scene,
                stiffness: 200.0,
                closing: 0.5,
                protocols: &protocols,
                stop: &|| false,
            },
            folder: Path::new(""),
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
        assert_eq!(grown.lines, whole.lines);
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
