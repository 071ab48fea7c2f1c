//! The contact stage of a run: the loading by the solver of the scene and F_a(0).

use super::AfterLeg;
use crate::analysis::Figures;
use crate::contact::{
    AdhesiveMemory, ContactError, ContactRule, ContactTree, Exact, Foundation, HessRule, History, LegRecord,
    Solver, Stepwise, run,
};
use crate::scene::{Leg, Scene, Solver as SolverChoice};
use crate::surface::Line;
use std::time::Instant;

/// Parameters of the contact of one run.
pub(super) struct ContactStage<'a> {
    pub line: &'a Line,
    pub tree: Option<&'a ContactTree>,
    pub foundation: Foundation,
    pub hess: Option<HessRule>,
    pub scene: &'a Scene,
    pub stop: &'a dyn Fn() -> bool,
}

/// Memory reused from run to run.
pub(super) type ContactMemory = AdhesiveMemory;

/// Result of the contact stage.
pub(super) struct Contacted {
    pub history: History,
    /// Seconds spent on curves and extremes.
    pub curve_seconds: f64,
    /// F_a(0), N, if requested and if the contact of first touch pulls.
    pub zero_load_adhesion_force: Option<f64>,
    /// Additional seconds of the run for F_a(0).
    pub zero_load_seconds: f64,
}

impl ContactStage<'_> {
    /// Runs the loading of the scene with its solver, and the touch protocol if F_a(0) is requested.
    pub fn run(
        &self,
        zero_load: bool,
        memory: &mut ContactMemory,
        after: &mut AfterLeg<'_>,
    ) -> Result<Contacted, ContactError> {
        let gaps = self.line.gaps.as_slice();
        let samples = self.scene.numerics.samples as usize;
        match self.scene.numerics.solver {
            SolverChoice::Stepwise { step } => {
                let body =
                    |samples| Stepwise::new(gaps, self.hess, self.foundation, step, samples, self.stop);
                let mut contacted = self.load(&mut body(samples)?, after)?;
                if zero_load {
                    let clock = Instant::now();
                    let touch = run(&mut body(2)?, &[Leg::ToTouch, Leg::ToSeparation], |_, _| Ok(()))?;
                    contacted.zero_load_adhesion_force = Figures::of(&touch).adhesion_force;
                    contacted.history.work.add_effort(&touch.work);
                    contacted.zero_load_seconds = clock.elapsed().as_secs_f64();
                }
                Ok(contacted)
            }
            SolverChoice::Exact => {
                let mut body = self.body(memory)?;
                let contacted = self.load(&mut body, after).and_then(|mut contacted| {
                    if zero_load && self.hess.is_some() {
                        let clock = Instant::now();
                        let (force, work) = body.pull_off_at_touch()?;
                        contacted.history.work.add_effort(&work);
                        // Not −F, which would make a force of zero negative.
                        contacted.zero_load_adhesion_force =
                            Some(force).filter(|&force| force <= 0.0).map(|force| 0.0 - force);
                        contacted.zero_load_seconds = clock.elapsed().as_secs_f64();
                    }
                    Ok(contacted)
                });
                body.give_back(memory);
                contacted
            }
        }
    }

    /// The separated body of the exact solver; with adhesion it works in this memory.
    ///
    /// # Errors
    /// [`ContactError::Internal`] for adhesion without the tree of the scene.
    pub fn body(&self, memory: &mut ContactMemory) -> Result<Exact<'_>, ContactError> {
        let numerics = &self.scene.numerics;
        let rule = match (self.hess, self.tree) {
            (None, _) => ContactRule::Nonadhesive(numerics.edges),
            (Some(hess), Some(tree)) if tree.edges() == numerics.edges => ContactRule::Hess(hess, tree),
            _ => return Err(ContactError::Internal("adhesion without the tree of the profile")),
        };
        Ok(Exact::new(memory, &self.line.gaps, rule, self.foundation, numerics.samples as usize))
    }

    /// Runs the loading of the scene.
    fn load<S: Solver>(&self, body: &mut S, after: &mut AfterLeg<'_>) -> Result<Contacted, ContactError> {
        let mut leg = 0;
        let mut history = run(body, &self.scene.loading, |record, body| {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            after(leg, record, body)?;
            leg += 1;
            Ok(())
        })?;
        for contact in &mut history.contacts {
            *contact = self.on_foundation(*contact);
        }
        Ok(Contacted {
            history,
            curve_seconds: body.curve_seconds(),
            zero_load_adhesion_force: None,
            zero_load_seconds: 0.0,
        })
    }

    /// The fragments in contact at the end of a loading stage.
    pub fn fragments_after(&self, record: &LegRecord, solver: &dyn Solver) -> Vec<(usize, usize)> {
        match record.curve.last() {
            Some(end) if end.springs > 0 => {
                solver.fragments(end.indentation).into_iter().map(|run| self.on_foundation(run)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Springs under the body, numbered from the first spring of the foundation.
    fn on_foundation(&self, (first, last): (usize, usize)) -> (usize, usize) {
        (first + self.line.first, last + self.line.first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Governing;
    use crate::scene::{Edges, open};
    use crate::simulation::Simulation;

    #[test]
    fn adhesion_is_refused_without_the_tree_of_its_edges() {
        let document = open("jkr-sphere").unwrap();
        let scene = document.scene();
        let mut simulation = Simulation::default();
        let (line, _, governing): (&Line, _, Governing) = simulation.make_line(scene).unwrap();
        let foundation = governing.foundation(line);
        let other = ContactTree::build(&line.gaps, Edges::Grid).unwrap();
        assert_eq!(scene.numerics.edges, Edges::SubCell);
        for tree in [None, Some(&other)] {
            let hess = governing.hess_rule(foundation);
            let stage = ContactStage { line, tree, foundation, hess, scene, stop: &|| false };
            let error = stage.body(&mut ContactMemory::default()).err();
            assert!(matches!(error, Some(ContactError::Internal(_))), "{error:?}");
        }
    }
}
