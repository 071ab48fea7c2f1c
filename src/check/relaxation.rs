//! The three rules applied until none is applicable: no tree and no threshold.

use super::Body;

/// Relative size of the roundings of a threshold.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Whole springs that relax to equilibrium after each movement.
///
/// With adhesion stronger or weaker by less than the rounding, so that the contact of a solver must lie between
/// those of two relaxations. The order of the rules does not matter, so one step leads to each turning point.
#[derive(Clone, Debug)]
pub struct Relaxation<'a> {
    body: &'a Body,
    slack: f64,
    contact: Vec<bool>,
    indentation: f64,
}

impl<'a> Relaxation<'a> {
    /// Two separated bodies: one with slightly less, one with slightly more adhesion.
    #[must_use]
    pub fn pair(body: &'a Body) -> [Self; 2] {
        // Without adhesion no spring is stretched and nothing is rounded.
        let slack = if body.work > 0.0 { SLACK } else { 0.0 };
        [-slack, slack].map(|slack| Relaxation {
            body,
            slack,
            contact: vec![false; body.gaps.len()],
            indentation: 0.0,
        })
    }

    /// For each spring, true if it is in contact.
    #[must_use]
    pub fn contact(&self) -> &[bool] {
        &self.contact
    }

    /// Returns true if no spring is in contact.
    #[must_use]
    pub fn is_separated(&self) -> bool {
        !self.contact.contains(&true)
    }

    /// Frees all springs.
    pub fn separate(&mut self) {
        self.contact.fill(false);
    }

    /// Moves to an indentation, m, and relaxes there.
    pub fn move_to(&mut self, indentation: f64) {
        let presses = self.is_separated() || indentation > self.indentation;
        self.indentation = indentation;
        if presses { self.press() } else { self.pull() }
    }

    /// Largest stretch of a spring of this gap at the edge of a fragment of this number of springs, m.
    fn most(&self, springs: usize, gap: f64) -> f64 {
        let stretch = self.body.stretch(springs as f64);
        stretch + self.slack * (stretch + gap + self.indentation.abs())
    }

    fn press(&mut self) {
        let d = self.indentation;
        // Touch.
        for (contact, &gap) in self.contact.iter_mut().zip(&self.body.gaps) {
            *contact |= gap <= d;
        }
        // Growth until no spring attaches.
        let count = self.contact.len();
        loop {
            let mut quiet = true;
            let mut first = 0;
            while first < count {
                if !self.contact[first] {
                    first += 1;
                    continue;
                }
                let (mut start, mut end) = (first, first + 1);
                loop {
                    while end < count && self.contact[end] {
                        end += 1;
                    }
                    while start > 0 && self.contact[start - 1] {
                        start -= 1;
                    }
                    let takes = |index: usize| {
                        let gap = self.body.gaps[index];
                        gap - d <= self.most(end - start, gap)
                    };
                    let taken = if end < count && takes(end) {
                        end
                    } else if start > 0 && takes(start - 1) {
                        start - 1
                    } else {
                        break;
                    };
                    self.contact[taken] = true;
                    quiet = false;
                }
                first = end;
            }
            if quiet {
                return;
            }
        }
    }

    fn pull(&mut self) {
        let d = self.indentation;
        loop {
            let mut quiet = true;
            let mut first = 0;
            while first < self.contact.len() {
                let springs = self.contact[first..].iter().take_while(|&&contact| contact).count();
                for index in first..first + springs {
                    let gap = self.body.gaps[index];
                    // Detachment: a spring stretched too far here is so in each part of the fragment as well.
                    if gap > d && gap - d >= self.most(springs, gap) {
                        self.contact[index] = false;
                        quiet = false;
                    }
                }
                first += springs + 1;
            }
            if quiet {
                return;
            }
        }
    }
}
