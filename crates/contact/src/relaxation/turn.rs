//! The turn of the body: the memories of all springs in contact follow from the history of the
//! approach.

use super::field::Spring;
use super::law::Relaxation;
use super::line::Line;
use super::memory::History;
use super::patch::{Edge, StretchedPatch};
use crate::error::ContactError;
use crate::history::Patch;
use crate::stage::Stage;
use asperity_data::resized;

/// The moment at which the body turns from loading to unloading, with the history of the loading.
#[derive(Clone, Copy)]
pub struct Turn<'a> {
    /// Elastic loading with the same springs in contact as the relaxing contact before the turn.
    pub stage: &'a Stage,
    pub relaxation: Relaxation,
    pub history: &'a History,
    /// Largest indentation in m that the body has reached.
    pub deepest: f64,
    /// Time of the turn in s since first touch.
    pub seconds: f64,
}

impl Turn<'_> {
    /// Returns gap and memory at a position that attached at the indentation `threshold` in m. The
    /// memory is that at the time of the turn.
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
        let inner = line.spring(inside);
        let Some(outside) = outside else {
            return Edge {
                spring: inside,
                share: 0.5,
                outer: inner,
            };
        };
        let gap = self.stage.contact().gaps()[outside];
        let height = gap - inner.gap;
        let mut share = 0.0;
        if height > 0.0 {
            share = ((level - inner.gap) / height).clamp(0.0, 1.0);
        }
        if share == 0.0 {
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

    /// Computes the memories of all springs in contact at the turn. Returns the profile with these
    /// memories, and the patches in contact.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn memories(&self) -> Result<(Line, Vec<StretchedPatch>), ContactError> {
        let gaps = self.stage.contact().gaps();
        let thresholds = self.stage.thresholds();
        let mut springs = resized(Vec::new(), gaps.len(), Spring::default())?;
        for (index, spring) in springs.iter_mut().enumerate() {
            let threshold = thresholds[index];
            if threshold <= self.deepest {
                *spring = self.spring(gaps[index], threshold);
            } else {
                spring.gap = gaps[index];
            }
        }
        let line = Line::new(
            springs,
            |index| thresholds[index] <= self.deepest,
            self.relaxation.remaining_share(),
            self.seconds,
        )?;
        let states = self.stage.patch_states(self.deepest);
        let mut patches = Vec::with_capacity(states.len());
        for state in &states {
            let Patch { first, last } = state.springs;
            let level = state.most_stretched + self.deepest;
            let after = Some(last + 1).filter(|&next| next < gaps.len());
            let left = self.edge(&line, first, first.checked_sub(1), level);
            let right = self.edge(&line, last, after, level);
            patches.push(StretchedPatch::new(&line, left, right));
        }
        Ok((line, patches))
    }
}
