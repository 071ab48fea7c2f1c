//! A body with edges between grid points, in hand.
//!
//! Which springs are in contact changes event by event, as with whole springs; but here the edges of every
//! fragment slide all the time. So a move takes O((k + 1) log N + n) time for k springs that change and n
//! fragments, and one to a force O(n) for each event on its way.

use super::edges::{EdgeSum, Slider, SubCellRule};
use super::level_sets::LevelSets;
use crate::contact::adhesive::{bisect, crossing, last_before};
use crate::contact::fragment_set::{Event, FragmentSet, Joined};
use crate::contact::grid::CompensatedSum;
use crate::contact::hand::{Hand, HandContact};
use crate::contact::law::Standing;
use crate::contact::{ContactError, Foundation, HandError, HessRule};
use std::collections::HashMap;
use std::sync::Arc;

/// Springs with edges between them, in hand.
pub struct BetweenInHand(FragmentSet<SubCellRule>);

/// A body with edges between grid points, held in hand.
pub type SubCellHand = Hand<BetweenInHand>;

impl SubCellHand {
    /// A body over the line of `sets` (smallest gap 0), separated, at d = 0 just before first touch; `hess`
    /// is the rule of Hess, `None` without adhesion.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        sets: Arc<LevelSets>,
        hess: Option<HessRule>,
        foundation: Foundation,
    ) -> Result<Self, ContactError> {
        Ok(Hand::touching(BetweenInHand::new(sets, hess, &[])?, foundation))
    }

    /// A body that stands at `indentation`, m, in the contact given by first and last spring of each
    /// fragment, as [`crate::contact::Incremental::standing`] takes it.
    ///
    /// # Errors
    /// [`HandError::NotFinite`], [`ContactError::OutOfMemory`].
    pub fn standing(
        sets: Arc<LevelSets>,
        hess: Option<HessRule>,
        foundation: Foundation,
        indentation: f64,
        contacts: &[(usize, usize)],
    ) -> Result<Self, HandError> {
        Hand::standing_at(indentation, foundation, || BetweenInHand::new(sets, hess, contacts))
    }
}

impl BetweenInHand {
    fn new(
        sets: Arc<LevelSets>,
        hess: Option<HessRule>,
        contacts: &[(usize, usize)],
    ) -> Result<Self, ContactError> {
        Ok(BetweenInHand(FragmentSet::new(sets.shared_tree(), SubCellRule::new(sets, hess), contacts)?))
    }

    fn edges(&self) -> &SubCellRule {
        self.0.rule()
    }

    fn compression_at(&self, indentation: f64) -> f64 {
        self.standing_at(indentation).compression
    }

    fn stiffness_at(&self, indentation: f64) -> f64 {
        self.0.roots().map(|root| self.edges().slider(root).stiffness(indentation)).sum()
    }
}

impl HandContact for BetweenInHand {
    type Rule = SubCellRule;
    type Notes = Notes;

    fn set(&self) -> &FragmentSet<SubCellRule> {
        &self.0
    }

    fn set_mut(&mut self) -> &mut FragmentSet<SubCellRule> {
        &mut self.0
    }

    fn standing_at(&self, indentation: f64) -> Standing {
        let tally = self.0.tally();
        let mut sum = EdgeSum::default();
        self.0.roots().for_each(|root| sum.add(self.edges().slider(root).edges(indentation)));
        let edges = sum.total();
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.cells() as f64 + edges.length,
            compression: tally.compression_of_cells(indentation, self.0.scale()) + edges.compression,
        }
    }

    fn begin(&self, from: f64) -> Notes {
        Notes { from, level: from, formed: HashMap::new(), squared_stretch: CompensatedSum::default() }
    }

    fn join(&mut self, level: f64, notes: &mut Notes) -> Option<Event> {
        notes.level = level;
        let edges = self.0.rule().clone();
        let mut root = None;
        let event = self.0.join_seen(level, |joined| match joined {
            Joined::Fragment(part) => notes.take_in(&edges, part),
            Joined::Spring(node) => {
                root.replace(node).into_iter().for_each(|inner| notes.take_in_at_once(&edges, inner));
                notes.take_spring(&edges, node);
            }
        })?;
        notes.form_below(&edges, root?);
        Some(event)
    }

    fn leave(&mut self, level: f64, notes: &mut Notes) -> Option<Event> {
        notes.level = level;
        notes.let_go(self.0.rule(), self.0.leaves_from()?);
        self.0.leave(level)
    }

    fn end(&self, mut notes: Notes, at: f64) -> (f64, u64) {
        self.0.roots().for_each(|root| notes.slide_on(self.0.rule(), root, at));
        (notes.squared_stretch.total(), self.0.tally().fragments.unsigned_abs())
    }

    /// The force is convex and below it at first: it gets there once.
    fn rises_to(&self, (from, to): (f64, f64), wanted: f64) -> Option<f64> {
        let reaches = self.compression_at(to) >= wanted;
        reaches.then(|| crossing(from, to, |at| self.compression_at(at) - wanted))
    }

    fn falls_to(&self, (from, last): (f64, f64), wanted: f64) -> Result<f64, f64> {
        let flat = if self.stiffness_at(from) >= 0.0 {
            from
        } else if self.stiffness_at(last) <= 0.0 {
            last
        } else {
            bisect(from, last, |at| self.stiffness_at(at) >= 0.0)
        };
        let compression = self.compression_at(flat);
        if compression > wanted {
            return Err(compression);
        }
        let passes = |at: f64| self.compression_at(at) - wanted;
        Ok(if passes(last) > 0.0 { last_before(flat, last, passes) } else { last })
    }

    /// The force rises with the whole line.
    fn beyond(&self, from: f64, wanted: f64) -> f64 {
        let end = self.standing_at(from);
        from + (wanted - end.compression) / end.length
    }
}

/// What a move notes on its way.
pub struct Notes {
    /// Where it began.
    from: f64,
    /// Indentation of the events just now.
    level: f64,
    /// Where the fragments that formed on the way did so.
    formed: HashMap<usize, f64>,
    /// ∫ (c − θ)² dx over what has joined or left, each place at its θ, in cells times m².
    squared_stretch: CompensatedSum,
}

impl Notes {
    /// The edges of a fragment slide from where the move or the fragment began to an indentation.
    fn slide(&mut self, root: usize, slider: &Slider, to: f64) {
        let from = self.formed.remove(&root).unwrap_or(self.from);
        let (low, high) = (slider.level(from.min(to)), slider.level(from.max(to)));
        self.squared_stretch.add(slider.squared_stretch_sliding(low, high));
    }

    fn slide_on(&mut self, edges: &SubCellRule, root: usize, to: f64) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.slide(root, &slider, to);
        }
    }

    /// A larger fragment takes this one in.
    fn take_in(&mut self, edges: &SubCellRule, root: usize) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.slide(root, &slider, self.level);
            self.jump(&slider, slider.level(self.level), slider.top());
        }
    }

    /// What is around the springs of a node, up to those of the next, joins with them.
    fn take_in_at_once(&mut self, edges: &SubCellRule, node: usize) {
        let slider = edges.slider(node);
        if slider.growth() > 0.0 {
            self.jump(&slider, slider.gap(), slider.top());
        }
    }

    /// The spring of a node joins or leaves, with what lies level with it.
    fn take_spring(&mut self, edges: &SubCellRule, node: usize) {
        let length = edges.sets().step(node);
        if length > 0.0 {
            let stretch = edges.slider(node).gap() - self.level;
            self.squared_stretch.add(length * stretch * stretch);
        }
    }

    /// A fragment forms, on the way in, and with it what is around its springs up to its level.
    fn form_below(&mut self, edges: &SubCellRule, root: usize) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.jump(&slider, slider.gap(), slider.level(self.level));
        }
        self.formed.insert(root, self.level);
    }

    /// The fragment lets go of the spring of its root, and its parts shrink to their own levels.
    fn let_go(&mut self, edges: &SubCellRule, root: usize) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.slide(root, &slider, self.level);
            self.jump(&slider, slider.gap(), slider.level(self.level));
        }
        self.take_spring(edges, root);
        let (left, right) = edges.sets().tree().children(root);
        for part in left.into_iter().chain(right) {
            let slider = edges.slider(part);
            if slider.growth() > 0.0 {
                self.jump(&slider, slider.level(self.level), slider.top());
            }
            self.formed.insert(part, self.level);
        }
    }

    fn jump(&mut self, slider: &Slider, from: f64, to: f64) {
        self.squared_stretch.add(slider.squared_stretch_at_once(from, to, self.level));
    }
}
