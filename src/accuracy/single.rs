//! Error of a line kept in single precision.

use super::Measures;
use super::solution::Solution;
use crate::contact::{AdhesiveMemory, ContactError, ContactTree, Exact, run};
use crate::scene::{Edges, Scene};
use crate::simulation::{RunError, Simulation};
use std::path::Path;

/// Relative errors of a scene whose gaps are rounded to single precision and then solved in double, against
/// the same with gaps in double precision. `stop` is asked between legs whether to give up.
pub(super) fn errors_of_single_precision(
    scene: &Scene,
    folder: &Path,
    stop: &dyn Fn() -> bool,
) -> Result<Measures<Option<f64>>, RunError> {
    let mut simulation = Simulation::new(folder.to_path_buf());
    let (line, _, governing) = simulation.make_line(scene)?;
    let foundation = governing.foundation(line);
    let hess = governing.hess_rule(foundation);
    let solve = |gaps: &[f64]| -> Result<Solution, RunError> {
        let goes_on = || if stop() { Err(ContactError::Interrupted) } else { Ok(()) };
        goes_on()?;
        let samples = scene.numerics.samples as usize;
        let tree = hess.map(|_| ContactTree::build(gaps, Edges::SubCell)).transpose()?;
        let (memory, adhesion) = (&mut AdhesiveMemory::default(), hess.zip(tree.as_ref()));
        let mut body = Exact::new(memory, gaps, adhesion, Edges::SubCell, foundation, samples);
        let history = run(&mut body, &scene.loading, |_, _| goes_on())?;
        Ok(Solution::of_history(&history, scene.numerics.points))
    };
    let double = solve(&line.gaps)?;
    let rounded: Vec<f64> = line.gaps.iter().map(|&gap| f64::from(gap as f32)).collect();
    Ok(solve(&rounded)?.errors(&double))
}
