//! The contact stage of a run: the loading by the solver of the scene and, beside it, F_a(0).

use super::AfterLeg;
use super::plan::Legs;
use super::stages::MANY_SPRINGS;
use crate::analysis::Figures;
use crate::contact::exact::OverTree;
use crate::contact::subcell::{self, LevelSets};
use crate::contact::{
    BodyMemory, ContactError, ContactTree, Exact, Foundation, GridEdges, HessRule, History, LegRecord,
    Solver, Stepwise, Work, exact, run, touch,
};
use crate::parallel::Beside;
use crate::scene::{Leg, Scene, Solver as SolverChoice};
use crate::surface::Line;
use std::mem::take;
use std::sync::Arc;
use std::time::Instant;

/// What the contact of one run depends on.
pub(super) struct ContactStage<'a> {
    pub line: &'a Line,
    pub tree: Option<&'a ContactTree>,
    /// The level sets of the line, where edges lie between springs.
    pub levels: Option<&'a Arc<LevelSets>>,
    pub foundation: Foundation,
    pub hess: Option<HessRule>,
    pub scene: &'a Scene,
    pub stop: &'a dyn Fn() -> bool,
}

/// Memory that one run leaves to the next.
#[derive(Default)]
pub(super) struct ContactMemory {
    body: BodyMemory,
    touch: BodyMemory,
}

impl ContactMemory {
    /// The same with room for what passes over so many springs give, already cleared by the system; with
    /// their fragments if these are `listed`.
    pub fn ready(self, springs: usize, listed: bool) -> Result<Self, ContactError> {
        Ok(ContactMemory { body: self.body.ready(springs, listed)?, ..self })
    }
}

/// What a run gives.
pub(super) struct Contacted {
    pub history: History,
    /// Seconds spent on curves and extremes.
    pub curve_seconds: f64,
    /// F_a(0), N, if it was asked for and the contact of first touch pulls.
    pub zero_load_adhesion_force: Option<f64>,
    /// Seconds the run took longer for it.
    pub zero_load_seconds: f64,
}

/// The contact of first touch pulled off: its smallest force, N, what was done, and the memory it took.
struct PulledOff {
    smallest_force: Result<f64, ContactError>,
    work: Work,
    memory: BodyMemory,
}

impl ContactStage<'_> {
    /// Runs the loading of the scene with its solver, and the touch protocol if F_a(0) is asked for.
    pub fn run(
        &self,
        zero_load: bool,
        memory: &mut ContactMemory,
        after: &mut AfterLeg<'_>,
    ) -> Result<Contacted, ContactError> {
        let gaps = self.line.gaps.as_slice();
        let samples = self.scene.numerics.samples as usize;
        match (self.scene.numerics.solver, self.hess, self.tree) {
            (SolverChoice::Stepwise { step }, hess, _) => {
                let body = |samples| Stepwise::new(gaps, hess, self.foundation, step, samples, self.stop);
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
            (SolverChoice::Exact, Some(hess), Some(tree)) => {
                let thresholds = take(&mut memory.body);
                if let Some(levels) = self.levels {
                    let body =
                        subcell::adhesive_in(thresholds, levels, Some(hess), self.foundation, samples)?;
                    return self.load_over_tree(body, zero_load, memory, after);
                }
                let rule = GridEdges::new(hess);
                let body = exact::adhesive_in(thresholds, tree, rule, self.foundation, samples)?;
                self.load_over_tree(body, zero_load, memory, after)
            }
            (SolverChoice::Exact, _, _) => {
                let edges = self.scene.numerics.edges;
                self.load(&mut exact::nonadhesive(gaps, edges, self.foundation, samples), after)
            }
        }
    }

    /// Runs the loading of an adhesive body.
    fn load_over_tree<'t, C: OverTree<'t>>(
        &self,
        body: Exact<C>,
        zero_load: bool,
        memory: &mut ContactMemory,
        after: &mut AfterLeg<'_>,
    ) -> Result<Contacted, ContactError>
    where
        C::Rule: Clone + Send + Sync,
    {
        let again = Legs::of(&self.scene.loading).comes_down_again();
        let mut body = if again { body.keeping_first_loading() } else { body };
        let contacted = if zero_load {
            self.load_and_touch(&mut body, &mut memory.touch, after)
        } else {
            self.load(&mut body, after)
        };
        memory.body = body.into_memory();
        contacted
    }

    /// Runs the loading of the scene.
    fn load<S: Solver>(&self, body: &mut S, after: &mut AfterLeg<'_>) -> Result<Contacted, ContactError> {
        self.load_watched(body, |leg, record, body| after(leg, record, body))
    }

    fn load_watched<S: Solver>(
        &self,
        body: &mut S,
        mut after: impl FnMut(usize, &LegRecord, &S) -> Result<(), ContactError>,
    ) -> Result<Contacted, ContactError> {
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

    /// Runs the loading of the scene and, as soon as its first touch is known, pulls that contact off on
    /// another thread while the loading goes on.
    fn load_and_touch<'t, C: OverTree<'t>>(
        &self,
        body: &mut Exact<C>,
        memory: &mut BodyMemory,
        after: &mut AfterLeg<'_>,
    ) -> Result<Contacted, ContactError>
    where
        C::Rule: Clone + Send + Sync,
    {
        // Not `self`: `stop` need not be fit for other threads.
        let foundation = self.foundation;
        let (tree, rule) = (body.springs().tree(), body.springs().rule().clone());
        let pull_off = |roots: Vec<usize>, mut memory: BodyMemory| {
            let pulled = touch::smallest_force::<C>(tree, rule.clone(), foundation, roots, &mut memory);
            let (smallest_force, work) = match pulled {
                Ok((force, work)) => (Ok(force), work),
                Err(error) => (Err(error), Work::default()),
            };
            PulledOff { smallest_force, work, memory }
        };
        let pull_off = &pull_off;
        std::thread::scope(|scope| {
            let mut aside = None;
            let mut contacted = self.load_watched(body, |leg, record, body| {
                if aside.is_none() {
                    aside = body.roots_at_touch().map(|roots| {
                        let springs: usize = roots.iter().map(|&root| tree.size(root) as usize).sum();
                        let memory = take(memory);
                        Beside::begin(scope, springs >= MANY_SPRINGS, move || pull_off(roots, memory))
                    });
                }
                after(leg, record, body)
            })?;
            let clock = Instant::now();
            let pulled = match aside {
                Some(aside) => aside.finish(),
                // The loading never touches.
                None => {
                    let (roots, work) = touch::roots(tree, rule.clone(), memory)?;
                    contacted.history.work.add_effort(&work);
                    pull_off(roots, take(memory))
                }
            };
            *memory = pulled.memory;
            contacted.history.work.add_effort(&pulled.work);
            // Not −F: that would make a force of zero negative.
            contacted.zero_load_adhesion_force =
                Some(pulled.smallest_force?).filter(|&force| force <= 0.0).map(|force| 0.0 - force);
            contacted.zero_load_seconds = clock.elapsed().as_secs_f64();
            Ok(contacted)
        })
    }

    /// The fragments in contact where a leg ended.
    pub fn fragments_after(&self, record: &LegRecord, solver: &dyn Solver) -> Vec<(usize, usize)> {
        match record.curve.last() {
            Some(end) if end.springs > 0 => {
                solver.fragments(end.indentation).into_iter().map(|run| self.on_foundation(run)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Springs under the body counted from the first spring of the foundation.
    fn on_foundation(&self, (first, last): (usize, usize)) -> (usize, usize) {
        (first + self.line.first, last + self.line.first)
    }
}
