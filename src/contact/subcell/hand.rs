//! A body with edges between grid points, held in hand.
//!
//! Which springs are in contact changes event by event, as with whole springs; but here the edges of every
//! fragment slide all the time. So a move takes O((k + 1) log N + n) time for k springs that change and n
//! fragments, and one to a force O(n) for each event on its way.

use super::edges::{EdgeSum, Slider, SubCellEdges};
use super::level_sets::LevelSets;
use super::search::{bisect, crossing, last_before};
use crate::contact::fragment_set::{FragmentSet, Joined};
use crate::contact::incremental::finite;
use crate::contact::law::Standing;
use crate::contact::ledger::CompensatedSum;
use crate::contact::{ContactError, CurvePoint, Foundation, HandError, HandHeld, HessRule, Move};
use std::collections::HashMap;
use std::sync::Arc;

/// A body with edges between grid points, held in hand.
pub struct SubCellHand {
    set: FragmentSet<SubCellEdges>,
    foundation: Foundation,
    indentation: f64,
}

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
        let set = FragmentSet::new(sets.shared_tree(), SubCellEdges::new(sets, hess), &[])?;
        Ok(SubCellHand { set, foundation, indentation: 0.0 })
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
        let indentation = finite(indentation)?;
        let set = FragmentSet::new(sets.shared_tree(), SubCellEdges::new(sets, hess), contacts)?;
        Ok(SubCellHand { set, foundation, indentation })
    }

    fn edges(&self) -> &SubCellEdges {
        self.set.rule()
    }

    fn is_separated(&self) -> bool {
        self.set.tally().springs == 0
    }

    /// What is in contact, were it at this indentation.
    fn standing_at(&self, indentation: f64) -> Standing {
        let tally = self.set.tally();
        let mut sum = EdgeSum::default();
        self.set.roots().for_each(|root| sum.add(self.edges().slider(root).edges(indentation)));
        let edges = sum.total();
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.cells() as f64 + edges.length,
            compression: tally.compression_of_cells(indentation, self.set.scale()) + edges.compression,
        }
    }

    fn compression_at(&self, indentation: f64) -> f64 {
        self.standing_at(indentation).compression
    }

    fn stiffness_at(&self, indentation: f64) -> f64 {
        self.set.roots().map(|root| self.edges().slider(root).stiffness(indentation)).sum()
    }

    /// Lets join all that joins up to this indentation.
    fn press(&mut self, course: &mut Course, indentation: f64) {
        while let Some(joins) = self.set.joins_next().filter(|&joins| joins <= indentation) {
            // A fragment can take in nothing before it has formed.
            let level = course.level.max(joins).max(course.from);
            course.level = level;
            let edges = self.set.rule().clone();
            let mut root = None;
            let event = self.set.join_seen(level, |joined| match joined {
                Joined::Fragment(part) => course.take_in(&edges, part),
                Joined::Spring(node) => {
                    root.replace(node).into_iter().for_each(|inner| course.take_in_at_once(&edges, inner));
                    course.take_spring(&edges, node);
                }
            });
            let (Some(event), Some(root)) = (event, root) else { break };
            course.form_below(&edges, root);
            course.count(event.springs);
        }
    }

    /// Lets go, one by one, of the most stretched springs, as long as `lets_go` says so of the indentation to
    /// which the next one is held.
    fn pull(&mut self, course: &mut Course, lets_go: impl Fn(f64) -> bool) {
        while let Some(holds) = self.set.leaves_next().filter(|&holds| lets_go(holds)) {
            // A part can let go of nothing before the whole has.
            course.level = course.level.min(holds);
            let Some(root) = self.set.leaves_from() else { break };
            course.let_go(self.set.rule(), root);
            let Some(event) = self.set.leave(course.level) else { break };
            course.count(event.springs);
        }
    }

    /// Presses until the compression ∫ (d − c) dx is at least `wanted`, and returns the indentation; `None`
    /// when there is no finite one.
    fn press_to_compression(&mut self, course: &mut Course, wanted: f64) -> Option<f64> {
        // Nothing touches below d = 0.
        let mut from = if self.is_separated() { self.indentation.max(0.0) } else { self.indentation };
        self.press(course, from);
        loop {
            if self.compression_at(from) >= wanted {
                return Some(from);
            }
            let Some(to) = self.set.joins_next() else { break };
            // Until the next spring joins the force is convex and below it at first: it gets there once.
            if self.compression_at(to) >= wanted {
                let found = crossing(from, to, |at| self.compression_at(at) - wanted);
                if found < to {
                    return Some(found);
                }
                self.press(course, to);
                return Some(if self.compression_at(to) >= wanted { to } else { to.next_down() });
            }
            from = to;
            self.press(course, from);
        }
        // Everything is in contact, and the force rises with the whole line.
        let end = self.standing_at(from);
        let further = from + (wanted - end.compression) / end.length;
        Some(further).filter(|indentation| indentation.is_finite())
    }

    /// Pulls until the compression ∫ (d − c) dx is at most `wanted`, and returns the indentation, or the
    /// smallest compression on the way when everything lets go before.
    fn pull_to_compression(&mut self, course: &mut Course, wanted: f64) -> Result<f64, f64> {
        let mut to = self.indentation;
        let mut smallest = self.compression_at(to);
        if smallest <= wanted {
            return Ok(to);
        }
        loop {
            // Below `to` only what is held further is in contact.
            self.pull(course, |holds| holds >= to);
            let Some(from) = self.set.leaves_next() else { return Err(smallest) };
            let last = to.next_down().max(from);
            let flat = if self.stiffness_at(from) >= 0.0 {
                from
            } else if self.stiffness_at(last) <= 0.0 {
                last
            } else {
                bisect(from, last, |at| self.stiffness_at(at) >= 0.0)
            };
            let compression = self.compression_at(flat);
            if compression <= wanted {
                let passes = |at: f64| self.compression_at(at) - wanted;
                return Ok(if passes(last) > 0.0 { last_before(flat, last, passes) } else { last });
            }
            smallest = smallest.min(compression);
            to = from;
        }
    }

    /// Ends a move at an indentation.
    fn settle(&mut self, mut course: Course, indentation: f64) -> Move {
        self.indentation = indentation;
        for root in self.set.roots() {
            course.slide_on(self.set.rule(), root, indentation);
        }
        let energy = 0.5 * self.foundation.spring_stiffness() * course.squared_stretch.total();
        let (joins, leaves, dissipated_energy) = if course.presses {
            // Not −0 where nothing joined with a stretch.
            (course.springs, 0, 0.0 - energy)
        } else {
            (0, course.springs, energy)
        };
        let slid = self.set.tally().fragments.unsigned_abs();
        let touched = self.set.touched() - course.touched_before + slid;
        Move { joins, leaves, events: course.events, touched, dissipated_energy }
    }

    fn course(&self, presses: bool) -> Course {
        Course {
            presses,
            from: self.indentation,
            level: if presses { f64::NEG_INFINITY } else { self.indentation },
            formed: HashMap::new(),
            springs: 0,
            events: 0,
            squared_stretch: CompensatedSum::default(),
            touched_before: self.set.touched(),
        }
    }

    fn press_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = self.course(true);
        let wanted = force / self.foundation.spring_stiffness();
        let to = self.press_to_compression(&mut course, wanted).ok_or(HandError::OutOfReach { force })?;
        Ok(self.settle(course, to))
    }

    fn pull_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let mut course = self.course(false);
        let stiffness = self.foundation.spring_stiffness();
        let to = self.pull_to_compression(&mut course, force / stiffness);
        let to = to.map_err(|smallest| HandError::LetsGoBefore { force, smallest: stiffness * smallest })?;
        Ok(self.settle(course, to))
    }
}

impl HandHeld for SubCellHand {
    fn move_to_indentation(&mut self, indentation: f64) -> Result<Move, HandError> {
        let indentation = finite(indentation)?;
        if indentation > self.indentation || (self.is_separated() && indentation >= 0.0) {
            let mut course = self.course(true);
            self.press(&mut course, indentation);
            Ok(self.settle(course, indentation))
        } else if indentation < self.indentation {
            let mut course = self.course(false);
            self.pull(&mut course, |holds| holds > indentation);
            Ok(self.settle(course, indentation))
        } else {
            Ok(Move::default())
        }
    }

    fn move_to_force(&mut self, force: f64) -> Result<Move, HandError> {
        let force = finite(force)?;
        let here = self.point();
        let separated = self.is_separated();
        if separated && force < 0.0 {
            return Err(HandError::NothingToPull { force });
        }
        let before = self.set.tally();
        self.set.keep_journal();
        // As forces: the division by the stiffness may miss the compression the force came from.
        let moved = if separated || force > here.force {
            self.press_to_force(force)
        } else if force < here.force {
            self.pull_to_force(force)
        } else {
            Ok(Move::default())
        };
        if moved.is_err() {
            self.set.take_back(before);
        }
        self.set.drop_journal();
        moved
    }

    fn separate(&mut self) -> Move {
        let mut course = self.course(false);
        self.pull(&mut course, |_| true);
        let end = course.level;
        self.settle(course, end)
    }

    fn point(&self) -> CurvePoint {
        self.standing_at(self.indentation).point(self.foundation)
    }

    fn fragments(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_> {
        Box::new(self.set.intervals())
    }
}

/// A move while it goes on.
struct Course {
    presses: bool,
    /// Where it began.
    from: f64,
    /// Indentation of the events just now: it never goes back.
    level: f64,
    /// Where the fragments that formed on the way did so.
    formed: HashMap<usize, f64>,
    springs: u64,
    events: u64,
    /// ∫ (c − θ)² dx over what has joined or left, each place at its θ, in cells times m².
    squared_stretch: CompensatedSum,
    touched_before: u64,
}

impl Course {
    fn count(&mut self, springs: u64) {
        self.springs += springs;
        self.events += 1;
    }

    /// The edges of a fragment slide from where the move or the fragment began to an indentation.
    fn slide(&mut self, root: usize, slider: &Slider, to: f64) {
        let from = self.formed.remove(&root).unwrap_or(self.from);
        let (low, high) = (slider.level(from.min(to)), slider.level(from.max(to)));
        self.squared_stretch.add(slider.squared_stretch_sliding(low, high));
    }

    fn slide_on(&mut self, edges: &SubCellEdges, root: usize, to: f64) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.slide(root, &slider, to);
        }
    }

    /// A larger fragment takes this one in.
    fn take_in(&mut self, edges: &SubCellEdges, root: usize) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.slide(root, &slider, self.level);
            self.jump(&slider, slider.level(self.level), slider.top());
        }
    }

    /// What is around the springs of a node, up to those of the next, joins with them.
    fn take_in_at_once(&mut self, edges: &SubCellEdges, node: usize) {
        let slider = edges.slider(node);
        if slider.growth() > 0.0 {
            self.jump(&slider, slider.gap(), slider.top());
        }
    }

    /// The spring of a node joins or leaves, with what lies level with it.
    fn take_spring(&mut self, edges: &SubCellEdges, node: usize) {
        let length = edges.sets().step(node);
        if length > 0.0 {
            let stretch = edges.slider(node).gap() - self.level;
            self.squared_stretch.add(length * stretch * stretch);
        }
    }

    /// A fragment forms, on the way in, and with it what is around its springs up to its level.
    fn form_below(&mut self, edges: &SubCellEdges, root: usize) {
        let slider = edges.slider(root);
        if slider.growth() > 0.0 {
            self.jump(&slider, slider.gap(), slider.level(self.level));
        }
        self.formed.insert(root, self.level);
    }

    /// The fragment lets go of the spring of its root, and its parts shrink to their own levels.
    fn let_go(&mut self, edges: &SubCellEdges, root: usize) {
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
