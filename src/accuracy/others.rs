//! The knobs beside the number of springs: steps, samples, precision, profiles.

use super::bench::{Bench, CostError, Rows, Tried};
use super::solution::{Solution, Solved, allowed_points, refined};
use super::{Knob, Measures, Timing};
use crate::contact::{AdhesiveMemory, ContactError, ContactRule, ContactTree, Exact, run};
use crate::scene::{Edges, Scene, Solver, check, format_quantity};
use crate::simulation::{RunError, Simulation};
use crate::study::{Case, Next, Quantity, Records, Sink, Statistics, solve_in_turn};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// Shares of the budget at which each knob ends.
const STEPS_BY: f64 = 0.8;
const SAMPLES_BY: f64 = 0.88;
const LINES_BY: f64 = 1.0;

/// Number of coarse settings of a knob that may use the rest of the budget, so that there are results.
const COARSE: usize = 4;

/// Springs of the stepwise solver, unless the scene needs more.
const STEPWISE_SPRINGS: u64 = 256;
/// Factor of samples for comparing steps over those for comparing springs.
const BLURRED: u64 = 4;
/// Steps of the coarsest run over the range of its indentations.
const FEWEST_STEPS: f64 = 16.0;
/// Most halvings of the step.
const MOST_HALVINGS: u32 = 20;
/// Fewest samples, and the samples of the reference.
const FEWEST_SAMPLES: u64 = 8;
const REFERENCE_SAMPLES: u64 = 1 << 16;
/// Most springs for the test of samples, if the scene has more and fewer suffice.
const MOST_SAMPLED: u64 = 1 << 14;
/// Fewest profiles of a mean, and most that are tried.
const FEWEST_LINES: u64 = 4;
const MOST_LINES: u64 = 1 << 14;

/// Adds the rows of all these knobs; `points` springs reach about one per cent.
pub(super) fn measure(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    steps(bench, rows)?;
    let own = bench.scene.numerics.points.min(MOST_SAMPLED).max(points);
    samples(bench, own, rows)?;
    single_precision(bench, points, rows)?;
    lines(bench, points, rows)
}

/// The step of the stepwise solver, against the exact solver on as many springs.
fn steps(bench: &mut Bench<'_>, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::Step;
    let Some(points) = allowed_points(bench.scene).find(|&points| points >= STEPWISE_SPRINGS) else {
        return Ok(());
    };
    let mut timed = refined(bench.scene, points, Edges::Grid);
    let mut scene = bench.compared(&timed);
    // With few springs each of them is a jump, which samples on either side blur: by up to one distance of samples
    // here, and by up to four where steps are thinned out to samples.
    scene.numerics.samples *= BLURRED;
    let floors =
        Measures { curve: Some((1 + BLURRED) as f64 / scene.numerics.samples as f64), ..Measures::default() };
    let Some(exact) = bench.reference(&scene, knob, "all steps")? else { return Ok(()) };
    let Some((low, high)) = exact.curve.indentations().filter(|(low, high)| low < high) else {
        return Ok(());
    };
    let mut guess = 0.0;
    for halving in 0..MOST_HALVINGS {
        let step = (high - low) / FEWEST_STEPS * (-f64::from(halving)).exp2();
        scene.numerics.solver = Solver::Stepwise { step };
        timed.numerics.solver = scene.numerics.solver;
        if !check(&scene).is_empty() {
            break;
        }
        let named = format_quantity(step, "m");
        let share = if (halving as usize) < COARSE { 1.0 } else { STEPS_BY };
        let out_of_time = bench.budget.left_of(share) <= guess;
        if !out_of_time {
            rows.trying(knob, &named);
        }
        let clock = Instant::now();
        let solved = if out_of_time { Solved::TooMuch } else { bench.solve(&scene)? };
        let Solved::Outcome(outcome) = solved else {
            bench.leave_out(knob, &format!("{named} and less, on {points} springs"));
            break;
        };
        let took = clock.elapsed().as_secs_f64();
        // No second run of one that takes seconds already.
        let seconds = if took < bench.budget.left_of(STEPS_BY) / 4.0 {
            bench.time(&timed)
        } else {
            Timing::of(vec![took])
        };
        guess = 2.0 * took;
        let errors = Solution::of(&outcome).errors(&exact);
        rows.add(bench, Tried { knob, setting: step, springs: points, seconds, errors }, &floors);
    }
    Ok(())
}

/// Samples of the curve, against very many of them: samples change the curve between them, but no figure.
fn samples(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::Samples;
    let legs = bench.scene.loading.len().max(1) as u64;
    let most = REFERENCE_SAMPLES / legs;
    let mut scene = refined(bench.scene, points, Edges::SubCell);
    scene.numerics.samples = most.max(2);
    if most < 8 * FEWEST_SAMPLES {
        bench.leave_out(knob, "all numbers");
        return Ok(());
    }
    let Some(finest) = bench.reference(&scene, knob, "all numbers")? else { return Ok(()) };
    for (index, samples) in
        std::iter::successors(Some(FEWEST_SAMPLES), |samples| Some(4 * samples)).enumerate()
    {
        if samples > most / 8 {
            break;
        }
        let share = if index < COARSE { 1.0 } else { SAMPLES_BY };
        if bench.budget.left_of(share) <= 0.0 {
            bench.leave_out(knob, &format!("{samples} and more"));
            break;
        }
        rows.trying(knob, &samples.to_string());
        scene.numerics.samples = samples;
        let Solved::Outcome(outcome) = bench.solve(&scene)? else { break };
        let curve = Solution::of(&outcome).errors(&finest).curve;
        let seconds = bench.time(&scene);
        let errors = Measures { curve, ..Measures::default() };
        let tried = Tried { knob, setting: samples as f64, springs: points, seconds, errors };
        rows.add(bench, tried, &Measures::default());
    }
    Ok(())
}

/// Measures the error of heights in single precision.
fn single_precision(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::SinglePrecision;
    if bench.budget.is_over() {
        bench.leave_out(knob, "not tried");
        return Ok(());
    }
    rows.trying(knob, "");
    let scene = bench.compared(&refined(bench.scene, points, Edges::SubCell));
    let errors = match errors_of_single_precision(&scene, bench.folder, &|| bench.budget.is_stopped()) {
        Ok(errors) => errors,
        Err(error) if error.is_interruption() => return Ok(()),
        Err(error) => return Err(error.into()),
    };
    let tried = Tried { knob, setting: 32.0, springs: points, seconds: None, errors };
    rows.add(bench, tried, &Measures::default());
    Ok(())
}

/// Relative errors of a scene with gaps rounded to single precision and then solved in double, against the same
/// scene with gaps in double precision. `stop` is polled between loading stages.
fn errors_of_single_precision(
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
        let memory = &mut AdhesiveMemory::default();
        let nonadhesive = ContactRule::Nonadhesive(Edges::SubCell);
        let rule = hess.zip(tree.as_ref()).map_or(nonadhesive, |(hess, tree)| ContactRule::Hess(hess, tree));
        let mut body = Exact::new(memory, gaps, rule, foundation, samples);
        let history = run(&mut body, &scene.loading, |_, _| goes_on())?;
        Ok(Solution::of_history(&history, scene.numerics.points))
    };
    let double = solve(&line.gaps)?;
    let rounded: Vec<f64> = line.gaps.iter().map(|&gap| f64::from(gap as f32)).collect();
    Ok(solve(&rounded)?.errors(&double))
}

/// Random profiles: standard error of the mean of their adhesion forces, and their time in sequence.
fn lines(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    if bench.scene.seed().is_none() {
        return Ok(());
    }
    let scene = refined(bench.scene, points, Edges::SubCell);
    let simulation = Simulation::new(bench.folder.to_path_buf());
    let budget = bench.budget;
    rows.trying(Knob::Lines, &FEWEST_LINES.to_string());
    let (forces, clock) = (Vec::new(), Instant::now());
    let mut mean =
        MeanOfProfiles { bench, rows, points, forces, seconds: 0.0, clock, next: FEWEST_LINES, error: None };
    let record = [Quantity::AdhesionForce];
    solve_in_turn(&scene, simulation, MOST_LINES, &record, &|| budget.is_over(), &mut mean);
    mean.error.map_or(Ok(()), |error| Err(error.into()))
}

/// Sink of random profiles: a row whenever their number has doubled.
struct MeanOfProfiles<'m, 'b, 'r, 'w> {
    bench: &'m mut Bench<'b>,
    rows: &'m mut Rows<'r, 'w>,
    points: u64,
    /// Adhesion forces so far, N.
    forces: Vec<f64>,
    /// Time of these profiles, s.
    seconds: f64,
    clock: Instant,
    /// Number of profiles of the next row.
    next: u64,
    error: Option<RunError>,
}

impl Sink for MeanOfProfiles<'_, '_, '_, '_> {
    fn next(&mut self, _: Case) -> Next {
        if self.bench.budget.left_of(LINES_BY) <= 0.0 {
            self.bench.leave_out(Knob::Lines, &format!("{} and more", self.next));
            return Next::End;
        }
        self.clock = Instant::now();
        Next::Solve
    }

    fn take(&mut self, _: Case, records: Result<Records, RunError>) -> ControlFlow<()> {
        let force = match records {
            Ok(records) => records.concat().first().copied().filter(|force| !force.is_nan()),
            Err(error) if error.is_interruption() => return ControlFlow::Continue(()),
            Err(error) => {
                self.error = Some(error);
                None
            }
        };
        let Some(force) = force else { return ControlFlow::Break(()) };
        self.seconds += self.clock.elapsed().as_secs_f64();
        self.forces.push(force);
        if (self.forces.len() as u64) < self.next {
            return ControlFlow::Continue(());
        }
        let error = relative_standard_error(&self.forces);
        if error.is_none() {
            return ControlFlow::Break(());
        }
        let errors = Measures { adhesion_force: error, ..Measures::default() };
        let (setting, seconds) = (self.next as f64, Timing::of(vec![self.seconds]));
        let tried = Tried { knob: Knob::Lines, setting, springs: self.points, seconds, errors };
        self.rows.add(self.bench, tried, &Measures::default());
        self.next *= 2;
        if self.next > MOST_LINES {
            return ControlFlow::Break(());
        }
        self.rows.trying(Knob::Lines, &self.next.to_string());
        ControlFlow::Continue(())
    }
}

/// Standard error of the mean of a sample over the mean.
fn relative_standard_error(values: &[f64]) -> Option<f64> {
    let statistics = Statistics::of(values)?;
    Some((statistics.standard_error / statistics.mean).abs()).filter(|error| error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_error_of_a_mean() {
        // Mean 3, sum of squares 2² + 0 + 2² = 8, s² = 4, s/√3 = 2/√3.
        let error = relative_standard_error(&[1.0, 3.0, 5.0]).unwrap();
        assert!((error - 2.0 / 3.0_f64.sqrt() / 3.0).abs() < 1e-15);
        assert_eq!(relative_standard_error(&[0.0, 0.0]), None);
        assert_eq!(relative_standard_error(&[2.0]), None);
        assert_eq!(relative_standard_error(&[2.0, 2.0]), Some(0.0));
    }
}
