//! Whole springs from event to event: each rule evaluated anew for every spring it may apply to, in 192 digits. No
//! tree, no pass, no curve, and no rounding that could decide a contact.

use super::wide::{Wide, pi, wide};
use crate::body::Body;

/// A body moved from event to event.
pub struct Events<'a> {
    body: &'a Body,
    /// Largest stretches of a fragment by its number of springs, on closing and on opening.
    closing: Vec<Wide>,
    opening: Vec<Wide>,
    contact: Vec<bool>,
    indentation: Wide,
    springs: usize,
    /// Σ c over the springs in contact.
    gaps: Wide,
}

/// Outcome of a move.
#[derive(Default)]
pub struct Moved {
    pub attached: u64,
    pub detached: u64,
    /// Σ (c − θ)² of the detached springs less that of the attached ones, m².
    pub squares: Wide,
    /// Σ (c − θ)(c + |θ|): the effect of roundings of θ, m².
    pub rounding: f64,
    /// Smallest Σ (d − c) held, m.
    pub smallest: Option<Wide>,
    /// Indentation at which the last spring detached, if it did.
    pub separated_at: Option<Wide>,
}

impl<'a> Events<'a> {
    pub fn new(body: &'a Body) -> Self {
        let stretches = |work: f64| {
            let range = wide(work) / wide(body.foundation.effective_modulus);
            let one = pi() * wide(body.foundation.spacing) * range;
            (0..=body.gaps.len()).map(|springs| (one.clone() * wide(springs as f64)).sqrt()).collect()
        };
        Events {
            body,
            closing: stretches(body.closing_work),
            opening: stretches(body.work),
            contact: vec![false; body.gaps.len()],
            indentation: wide(0.0),
            springs: 0,
            gaps: wide(0.0),
        }
    }

    /// Springs in contact.
    pub fn contact(&self) -> Vec<usize> {
        (0..self.contact.len()).filter(|&spring| self.contact[spring]).collect()
    }

    pub fn springs(&self) -> usize {
        self.springs
    }

    /// Σ (d − c), m.
    pub fn compression(&self) -> Wide {
        wide(self.springs as f64) * self.indentation.clone() - self.gaps.clone()
    }

    pub fn move_to(&mut self, indentation: f64) -> Moved {
        let to = wide(indentation);
        let mut moved = Moved { squares: wide(0.0), ..Moved::default() };
        if self.springs == 0 && to < Wide::ZERO {
            self.indentation = to;
        } else if self.springs == 0 || to > self.indentation {
            if self.springs == 0 {
                // Nothing touches below d = 0.
                self.indentation = self.indentation.clone().max(wide(0.0)).min(to.clone());
            }
            self.press(&to, &mut moved);
        } else {
            self.pull(Some(&to), &mut moved);
        }
        moved
    }

    /// Pulls until nothing touches.
    pub fn separate(&mut self) -> Moved {
        let mut moved = Moved { squares: wide(0.0), ..Moved::default() };
        if self.springs > 0 {
            self.pull(None, &mut moved);
        }
        moved
    }

    /// First spring and number of springs of each fragment.
    fn fragments(&self) -> Vec<(usize, usize)> {
        let mut fragments = Vec::new();
        let mut first = 0;
        while first < self.contact.len() {
            let springs = self.contact[first..].iter().take_while(|&&contact| contact).count();
            if springs > 0 {
                fragments.push((first, springs));
            }
            first += springs + 1;
        }
        fragments
    }

    fn change(&mut self, spring: usize, joins: bool, moved: &mut Moved) {
        let gap = self.body.gaps[spring];
        self.contact[spring] = joins;
        let stretch = wide(gap) - self.indentation.clone();
        if stretch > Wide::ZERO {
            let square = stretch.clone() * stretch.clone();
            let d = self.indentation.to_f64().value();
            moved.rounding += stretch.to_f64().value() * (gap + d.abs());
            moved.squares =
                if joins { moved.squares.clone() - square } else { moved.squares.clone() + square };
        }
        if joins {
            (self.springs, moved.attached) = (self.springs + 1, moved.attached + 1);
            self.gaps = self.gaps.clone() + wide(gap);
        } else {
            (self.springs, moved.detached) = (self.springs - 1, moved.detached + 1);
            self.gaps = self.gaps.clone() - wide(gap);
        }
    }

    fn press(&mut self, to: &Wide, moved: &mut Moved) {
        loop {
            // The next spring to attach, by touch or beside a fragment.
            let touching = (0..self.contact.len()).filter(|&spring| !self.contact[spring]);
            let touching = touching.min_by(|&a, &b| self.body.gaps[a].total_cmp(&self.body.gaps[b]));
            let mut next = touching.map(|spring| (wide(self.body.gaps[spring]), spring));
            for (first, springs) in self.fragments() {
                for beside in [first.checked_sub(1), Some(first + springs)].into_iter().flatten() {
                    if let Some(&gap) = self.body.gaps.get(beside) {
                        let at = wide(gap) - self.closing[springs].clone();
                        if next.as_ref().is_none_or(|(nearest, _)| at < *nearest) {
                            next = Some((at, beside));
                        }
                    }
                }
            }
            match next {
                Some((at, spring)) if at <= *to => {
                    self.indentation = at.max(self.indentation.clone());
                    self.change(spring, true, moved);
                }
                _ => break,
            }
        }
        self.indentation = to.clone();
    }

    fn pull(&mut self, to: Option<&Wide>, moved: &mut Moved) {
        loop {
            // The next spring to detach: the most stretched of its fragment.
            let mut next: Option<(Wide, usize)> = None;
            for (first, springs) in self.fragments() {
                let by_gap = |a: &usize, b: &usize| self.body.gaps[*a].total_cmp(&self.body.gaps[*b]);
                let Some(spring) = (first..first + springs).max_by(by_gap) else { continue };
                let at = wide(self.body.gaps[spring]) - self.opening[springs].clone();
                if next.as_ref().is_none_or(|(nearest, _)| at > *nearest) {
                    next = Some((at, spring));
                }
            }
            let Some((at, spring)) = next else { break };
            if to.is_some_and(|to| at < *to) {
                break;
            }
            if at < self.indentation {
                self.indentation = at;
                // Just before detachment.
                self.look(moved);
            }
            self.change(spring, false, moved);
            if self.springs == 0 {
                moved.separated_at = Some(self.indentation.clone());
            }
        }
        if let Some(to) = to {
            self.indentation = to.clone();
            if self.springs > 0 {
                self.look(moved);
            }
        }
    }

    fn look(&self, moved: &mut Moved) {
        let compression = self.compression();
        if moved.smallest.as_ref().is_none_or(|smallest| compression < *smallest) {
            moved.smallest = Some(compression);
        }
    }
}
