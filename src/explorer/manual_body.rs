//! The body under manual loading: moved by small steps at the cost of the springs that change.

use super::request::ManualMove;
use super::snapshot::{ManualPath, Refusal};
use crate::analysis::Governing;
use crate::contact::{
    ContactTree, CurvePoint, GridEdges, HessRule, Manual, ManualError, ManualLoading, Move, SubCellEdges,
};
use crate::scene::Edges;
use crate::surface::Line;
use std::sync::Arc;

/// Points of the curve along the way of one order.
const POINTS: u32 = 16;
/// Most moves of one order.
const MOST_STEPS: u32 = 512;
/// Largest force over that at full contact: beyond full contact the curve is a straight line.
const MOST_OVER_FULL_CONTACT: f64 = 10.0;

/// Body under manual loading.
pub struct ManualBody {
    body: Box<dyn ManualLoading + Send>,
    travel: ManualPath,
    /// A small part of the range of indentations, m.
    step: f64,
    /// Force at which the last spring touches the rigid body, N.
    full_contact: f64,
    /// Largest pressing force, N.
    largest: f64,
}

impl ManualBody {
    /// Begins manual loading at an indentation, m, with these fragments in contact and edges of this kind; `tree` is
    /// that of the line, where there is one. `step` is the distance of the points of a pull, m, and `preload` the
    /// largest force of the scene's loading, N.
    pub fn take(
        line: &Line,
        tree: Option<&Arc<ContactTree>>,
        edges: Edges,
        governing: &Governing,
        (indentation, contact, rises): (f64, &[(usize, usize)], &[f64]),
        (step, preload): (f64, f64),
    ) -> Option<Self> {
        let foundation = governing.foundation(line);
        let hess = governing.hess_rule(foundation).unwrap_or(HessRule::NO_ADHESION);
        let tree = match tree.filter(|tree| tree.edges() == edges) {
            Some(tree) => Arc::clone(tree),
            None => Arc::new(ContactTree::build(&line.gaps, edges).ok()?),
        };
        let gaps = &line.gaps;
        let body: Box<dyn ManualLoading + Send> = match edges {
            Edges::Grid => {
                let edges = GridEdges::new(hess);
                Box::new(Manual::in_contact(gaps, tree, edges, foundation, indentation, contact, rises).ok()?)
            }
            Edges::SubCell => {
                let edges = SubCellEdges::new(hess);
                Box::new(Manual::in_contact(gaps, tree, edges, foundation, indentation, contact, rises).ok()?)
            }
        };
        let deepest = gaps.iter().copied().fold(0.0, f64::max);
        let full_contact = foundation.spring_stiffness() * gaps.iter().map(|gap| deepest - gap).sum::<f64>();
        let largest = MOST_OVER_FULL_CONTACT * full_contact.max(preload);
        Some(ManualBody { body, travel: ManualPath::default(), step, full_contact, largest })
    }

    /// Present state.
    pub fn point(&self) -> CurvePoint {
        self.body.point()
    }

    /// Rise of the edges of each fragment; see [`ManualLoading::rises`].
    pub fn rises(&self) -> Vec<f64> {
        self.body.rises()
    }

    /// First and last spring of each fragment, in ascending order.
    pub fn fragments(&self) -> Vec<(usize, usize)> {
        self.body.fragments().collect()
    }

    /// Path since the last call.
    pub fn travel(&mut self) -> ManualPath {
        let released_energy = self.travel.released_energy;
        std::mem::replace(&mut self.travel, ManualPath { released_energy, ..ManualPath::default() })
    }

    /// Moves the body.
    pub fn obey(&mut self, order: ManualMove) {
        let from = self.body.point();
        let went = match order {
            ManualMove::Take { .. } | ManualMove::Give => Ok(()),
            ManualMove::To(indentation) => self.go(from.indentation, indentation).map_err(Refusal::from),
            ManualMove::By(way) => self.go(from.indentation, from.indentation + way).map_err(Refusal::from),
            ManualMove::ToForce(force) => self.find(force),
            ManualMove::Separate => self.separate().map_err(Refusal::from),
        };
        self.travel.refused = went.err();
    }

    /// Moves the body to an indentation, with one move for each point of the curve.
    fn go(&mut self, from: f64, to: f64) -> Result<(), ManualError> {
        for step in 1..=POINTS {
            let share = f64::from(step) / f64::from(POINTS);
            // The last move ends exactly.
            let at = if step == POINTS { to } else { from + (to - from) * share };
            let moved = self.body.move_to_indentation(at)?;
            self.record(moved);
        }
        Ok(())
    }

    /// Moves the body to a force, with one move for each point of the curve. A force out of reach moves nothing.
    fn find(&mut self, force: f64) -> Result<(), Refusal> {
        let from = self.body.point().force;
        if force > self.largest.max(from) {
            return Err(Refusal::BeyondFullContact {
                full_contact: self.full_contact,
                largest: self.largest,
            });
        }
        self.body.check_force(force)?;
        for step in 1..=POINTS {
            let share = f64::from(step) / f64::from(POINTS);
            let wanted = if step == POINTS { force } else { from + (force - from) * share };
            let moved = self.body.move_to_force(wanted)?;
            self.record(moved);
        }
        Ok(())
    }

    /// Pulls in steps of the curve until nothing touches; after `MOST_STEPS` steps the rest is one step.
    fn separate(&mut self) -> Result<(), ManualError> {
        let start = self.body.point();
        for step in 1..=MOST_STEPS {
            if self.body.point().springs == 0 {
                return Ok(());
            }
            let moved = self.body.move_to_indentation(start.indentation - self.step * f64::from(step))?;
            self.record(moved);
        }
        let moved = self.body.separate();
        self.record(moved);
        Ok(())
    }

    fn record(&mut self, moved: Move) {
        self.travel.path.push(self.body.point());
        self.travel.changed += moved.attaches + moved.detaches;
        self.travel.touched += moved.touched;
        self.travel.released_energy += moved.released_energy;
    }
}
