//! State of the animation, and its indentation.

use crate::contact::LegRecord;

/// Share of the whole range of indentations by which the body is lifted before first touch.
const LIFT: f64 = 0.12;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    pub leg: usize,
    /// Played share, 0 to 1.
    pub done: f64,
    pub playing: bool,
}

impl Player {
    pub const START: Player = Player { leg: 0, done: 0.0, playing: true };

    /// This state on existing loading stages: at the end of the last one where its own stage does not exist.
    pub fn within(self, legs: &[LegRecord]) -> Player {
        match legs.len().checked_sub(1) {
            Some(last) if self.leg > last => Player { leg: last, done: 1.0, playing: false },
            _ => self,
        }
    }

    /// The indentation of the animation of these loading stages, m.
    pub fn indentation(&self, legs: &[LegRecord]) -> f64 {
        let Some(leg) = legs.get(self.leg) else { return 0.0 };
        let start = start_of(legs, self.leg);
        match leg.curve.last() {
            // The contact still holds at this end; below, it is gone.
            Some(end) if self.done >= 1.0 && end.springs == 0 => end.indentation.next_down(),
            _ if self.done >= 1.0 => leg.end(),
            _ => start + (leg.end() - start) * self.done,
        }
    }
}

/// Lowest and highest indentation of the curves of loading stages, m.
pub fn indentations(legs: &[LegRecord]) -> Option<(f64, f64)> {
    let points = legs.iter().flat_map(|leg| &leg.curve).map(|point| point.indentation);
    points.fold(None, |range: Option<(f64, f64)>, d| {
        Some(range.map_or((d, d), |(low, high)| (low.min(d), high.max(d))))
    })
}

/// Indentation at which the animation begins a loading stage, m. The first begins a little above the foundation.
pub fn start_of(legs: &[LegRecord], leg: usize) -> f64 {
    let (low, high) = indentations(legs).unwrap_or((0.0, 0.0));
    let lift = if leg == 0 { LIFT * (high - low) } else { 0.0 };
    legs.get(leg).map_or(0.0, LegRecord::start) - lift
}
