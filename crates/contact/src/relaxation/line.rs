//! The memories of all springs that are in contact when the body turns, and the patches at this
//! moment.

use super::Relaxation;
use super::field::{Field, Spring, Sums};
use super::memory::History;
use super::patch::{Edge, StretchedPatch};
use super::peaks::{Bound, Peak, PeakTree, bound_of};
use crate::error::ContactError;
use crate::history::Patch;
use crate::stage::Stage;
use asperity_data::{gathered, resized};
use std::ops::RangeInclusive;

/// The profile with the memory of each spring that was in contact when the body turned.
#[derive(Debug)]
pub struct Line {
    springs: Vec<Spring>,
    /// Integrals from the first spring to each spring.
    sums: Vec<Sums>,
    peaks: PeakTree,
    /// Share of the modulus that remains after a long time.
    pub remaining: f64,
    /// Time in s of the turn. Memories are those of this time.
    pub turned_at: f64,
}

/// The moment at which the body turns, and how it came there.
#[derive(Clone, Copy)]
pub struct Turn<'a> {
    /// The elastic approach, which the relaxing contact shares.
    pub stage: &'a Stage,
    pub relaxation: Relaxation,
    pub history: &'a History,
    /// Largest indentation in m that the body has reached.
    pub deepest: f64,
    /// Time in s.
    pub seconds: f64,
}

impl Turn<'_> {
    /// Returns a place that attached at the indentation `threshold` in m, with its memory at the
    /// time of the turn.
    fn spring(&self, gap: f64, threshold: f64) -> Spring {
        let attached = self.history.first_at(self.relaxation, threshold);
        let age = (self.seconds - attached.seconds) / self.relaxation.time();
        Spring {
            gap,
            memory: (threshold - gap - attached.memory) * (-age).exp(),
        }
    }

    /// Returns the edge of a patch at the gap `level` in m. `inside` is the outermost spring of the
    /// patch on this side, and `outside` the first spring beyond; `None` at the end of the profile.
    fn edge(&self, line: &Line, inside: usize, outside: Option<usize>, level: f64) -> Edge {
        let inner = line.springs[inside];
        let Some(outside) = outside else {
            return Edge {
                spring: inside,
                share: 0.5,
                outer: inner,
            };
        };
        let gap = self.stage.contact().gaps()[outside];
        let height = gap - inner.gap;
        let share = ((level - inner.gap) / height).clamp(0.0, 1.0);
        if !(share > 0.0) {
            return Edge {
                spring: inside,
                share: 0.0,
                outer: inner,
            };
        }
        let edge = self.spring(level.min(gap), self.deepest);
        // The memory is straight from the spring to the edge, and the first spring beyond the edge
        // is given the memory to which this straight line leads.
        let memory = inner.memory + (edge.memory - inner.memory) / share;
        Edge {
            spring: inside,
            share,
            outer: Spring { gap, memory },
        }
    }
}

impl Line {
    /// Computes the memories of all springs in contact, and lists the patches.
    pub fn new(turn: &Turn<'_>) -> Result<(Self, Vec<StretchedPatch>), ContactError> {
        let gaps = turn.stage.contact().gaps();
        let remaining = turn.relaxation.remaining_share();
        let mut springs = resized(Vec::new(), gaps.len(), Spring::default())?;
        let thresholds = turn.stage.thresholds();
        for (index, spring) in springs.iter_mut().enumerate() {
            let threshold = thresholds[index];
            if threshold <= turn.deepest {
                *spring = turn.spring(gaps[index], threshold);
            } else {
                spring.gap = gaps[index];
            }
        }
        let peaks = PeakTree::new(gaps.len(), |index| {
            if thresholds[index] <= turn.deepest {
                bound_of(springs[index], remaining)
            } else {
                Bound::NONE
            }
        })?;
        let mut line = Line {
            sums: sums_before(&springs)?,
            springs,
            peaks,
            remaining,
            turned_at: turn.seconds,
        };
        let states = turn.stage.patch_states(turn.deepest);
        let mut patches = Vec::with_capacity(states.len());
        for state in &states {
            let Patch { first, last } = state.springs;
            let level = state.most_stretched + turn.deepest;
            let after = Some(last + 1).filter(|&next| next < gaps.len());
            let left = turn.edge(&line, first, first.checked_sub(1), level);
            let right = turn.edge(&line, last, after, level);
            patches.push(StretchedPatch::new(&line, left, right));
        }
        line.springs.shrink_to_fit();
        Ok((line, patches))
    }

    #[inline]
    pub fn spring(&self, index: usize) -> Spring {
        self.springs[index]
    }

    /// Returns the integrals from one spring to another one.
    #[inline]
    pub fn sums_between(&self, first: usize, last: usize) -> Sums {
        self.sums[last].minus(self.sums[first])
    }

    /// Returns the spring with the largest tension among `springs`, and its tension in m apart from
    /// the term that all springs share.
    #[inline]
    pub fn peak(&self, springs: RangeInclusive<usize>, field: &Field) -> Peak {
        self.peaks.largest(springs, field.decay, |index| {
            field.own_tension(self.springs[index])
        })
    }

    /// Returns an upper bound of the tension of the springs of a range at any later moment.
    pub fn bound(&self, first: usize, last: usize) -> Bound {
        let fresh = Field {
            remaining: self.remaining,
            decay: 1.0,
            indentation: 0.0,
            memory: 0.0,
        };
        let relaxed = Field {
            decay: 0.0,
            ..fresh
        };
        Bound {
            fresh: self.peak(first..=last, &fresh).tension,
            relaxed: self.peak(first..=last, &relaxed).tension,
        }
    }
}

fn sums_before(springs: &[Spring]) -> Result<Vec<Sums>, ContactError> {
    let mut sum = Sums::default();
    let sums = springs.iter().enumerate().map(|(index, &spring)| {
        let before = springs[index.saturating_sub(1)];
        let length = if index > 0 { 1.0 } else { 0.0 };
        sum = sum.plus(Sums::of_piece(before, spring, length));
        sum
    });
    Ok(gathered(springs.len(), sums)?)
}
