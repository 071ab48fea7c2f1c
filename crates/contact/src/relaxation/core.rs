//! The largest tension of the springs of a patch while its edges recede.
//!
//! The springs near both edges, the flanks, are compared one by one. The springs between them, the
//! core, have a bound that stays the same while the edges pass the flanks.

use super::field::Field;
use super::line::Line;
use super::peaks::{Bound, Peak, bound_of};

/// Number of springs of a flank.
const FLANK: usize = 16;

/// The springs of a patch far from its edges.
#[derive(Clone, Copy, Debug)]
pub struct Core {
    /// First and last spring. There are none if the patch is short.
    springs: Option<[usize; 2]>,
    bound: Bound,
}

impl Core {
    /// Returns the core of a patch with the springs from `first` to `last`.
    fn of(line: &Line, first: usize, last: usize) -> Self {
        if last - first < 4 * FLANK {
            return Core {
                springs: None,
                bound: Bound::NONE,
            };
        }
        let [first, last] = [first + FLANK, last - FLANK];
        Core {
            springs: Some([first, last]),
            bound: line.bound(first, last),
        }
    }

    /// Returns true if the core lies inside a patch with the springs from `first` to `last`.
    fn is_inside(&self, first: usize, last: usize) -> bool {
        match self.springs {
            Some([from, to]) => {
                first < from && to < last && from - first <= FLANK && last - to <= FLANK
            }
            None => last - first < 4 * FLANK,
        }
    }

    /// Returns the core of a patch with the springs from `first` to `last`. `known` is the core of
    /// the patch before its edges receded, which is returned if it still suits the patch.
    pub fn renewed(known: Option<Core>, line: &Line, first: usize, last: usize) -> Self {
        match known {
            Some(core) if core.is_inside(first, last) => core,
            _ => Core::of(line, first, last),
        }
    }

    /// Returns an upper bound of the tension of the springs from `first` to `last`. All springs of
    /// the core must be among them.
    pub fn bound_with_flanks(&self, line: &Line, first: usize, last: usize) -> Bound {
        let mut bound = self.bound;
        let [from, to] = self.springs.unwrap_or([last + 1, last]);
        for spring in (first..from).chain(to + 1..last + 1) {
            bound.include(bound_of(line.spring(spring), line.remaining));
        }
        bound
    }
}

/// The largest tensions of a patch at one moment.
pub struct Peaks<'a> {
    line: &'a Line,
    field: &'a Field,
    core: Core,
    /// Spring of the core with the largest tension, once it is known.
    peak_of_core: Option<Peak>,
    /// Largest tension from each spring of the left flank to the core.
    left: [Peak; FLANK],
    /// Largest tension from the core to each spring of the right flank.
    right: [Peak; FLANK],
}

impl<'a> Peaks<'a> {
    pub fn new(line: &'a Line, field: &'a Field, core: Core, first: usize, last: usize) -> Self {
        let mut peaks = Peaks {
            line,
            field,
            core,
            peak_of_core: None,
            left: [Peak::NONE; FLANK],
            right: [Peak::NONE; FLANK],
        };
        peaks.compare_flanks(first, last);
        peaks
    }

    pub fn core(&self) -> Core {
        self.core
    }

    fn peak_of(&self, spring: usize) -> Peak {
        Peak {
            spring,
            tension: self.field.own_tension(self.line.spring(spring)),
        }
    }

    fn compare_flanks(&mut self, first: usize, last: usize) {
        let Some([from, to]) = self.core.springs else {
            return;
        };
        let mut best = Peak::NONE;
        for spring in (first..from).rev() {
            best = best.larger(self.peak_of(spring));
            self.left[from - 1 - spring] = best;
        }
        best = Peak::NONE;
        for spring in to + 1..=last {
            best = best.larger(self.peak_of(spring));
            self.right[spring - to - 1] = best;
        }
    }

    /// Returns the spring with the largest tension among the springs from `first` to `last`. The
    /// range may only shrink from call to call.
    pub fn largest(&mut self, first: usize, last: usize) -> Peak {
        if !self.core.is_inside(first, last) {
            self.core = Core::of(self.line, first, last);
            self.peak_of_core = None;
            self.compare_flanks(first, last);
        }
        let Some([from, to]) = self.core.springs else {
            let springs = (first..=last).map(|spring| self.peak_of(spring));
            return springs.fold(Peak::NONE, Peak::larger);
        };
        let best = self.left[from - 1 - first].larger(self.right[last - to - 1]);
        if self.core.bound.at(self.field.decay) <= best.tension {
            return best;
        }
        if let Some(peak) = self.peak_of_core {
            return best.larger(peak);
        }
        let peak = self.line.peak(from..=to, best, self.field);
        if peak.tension > best.tension {
            self.peak_of_core = Some(peak);
        }
        peak
    }
}
