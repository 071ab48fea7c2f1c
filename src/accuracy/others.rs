//! The knobs beside the number of springs: steps, samples, precision, lines.

use super::measure::{Bench, CostError, Rows, Tried};
use super::single::errors_of_single_precision;
use super::solution::{Solution, Solved, allowed_points, refined};
use super::{Knob, Measures, Timing};
use crate::scene::{Edges, Scene, Solver, check, format_quantity};
use crate::simulation::Simulation;
use std::time::Instant;

/// Shares of the budget by the end of which each has ended.
const STEPS_BY: f64 = 0.8;
const SAMPLES_BY: f64 = 0.88;
const LINES_BY: f64 = 1.0;

/// Coarse settings of a knob that may take what is left of the budget, so that there is something to see.
const COARSE: usize = 4;

/// Springs of the stepwise solver, unless the scene needs more.
const STEPWISE_SPRINGS: u64 = 256;
/// Times as many samples for comparing steps as for comparing springs.
const BLURRED: u64 = 4;
/// Steps that the coarsest run takes over the range of its indentations.
const FEWEST_STEPS: f64 = 16.0;
/// Halvings of the step, at most.
const MOST_HALVINGS: u32 = 20;
/// Fewest samples, and how many of them the reference has.
const FEWEST_SAMPLES: u64 = 8;
const REFERENCE_SAMPLES: u64 = 1 << 16;
/// Springs on which samples are tried, where the scene has more and fewer are good enough.
const MOST_SAMPLED: u64 = 1 << 14;
/// Fewest lines that make a mean, and most that are tried.
const FEWEST_LINES: u64 = 4;
const MOST_LINES: u64 = 1 << 14;

/// Adds the rows of all these knobs; `points` springs are good for about one per cent.
pub(super) fn measure(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    steps(bench, rows)?;
    let own = bench.scene.numerics.points.min(MOST_SAMPLED).max(points);
    samples(bench, own, rows)?;
    single_precision(bench, points, rows)?;
    lines(bench, points, rows)
}

fn left_out(bench: &mut Bench<'_>, knob: Knob, what: &str) {
    bench.left_out.push(format!("{}: {what}", knob.name()));
}

/// The step of the stepwise solver, against the exact solver on as many springs.
fn steps(bench: &mut Bench<'_>, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::Step;
    let Some(points) = allowed_points(bench.scene).find(|&points| points >= STEPWISE_SPRINGS) else {
        return Ok(());
    };
    let mut timed = refined(bench.scene, points, Edges::Grid);
    let mut scene = bench.compared(&timed);
    // With few springs each of them is a jump, which samples on either side of it blur: by up to one distance
    // of samples here, and by up to four where steps are thinned out to samples.
    scene.numerics.samples *= BLURRED;
    let floors =
        Measures { curve: Some((1 + BLURRED) as f64 / scene.numerics.samples as f64), ..Measures::default() };
    if bench.budget.is_over() {
        left_out(bench, knob, "all steps");
        return Ok(());
    }
    let Solved::Outcome(outcome) = bench.solve(&scene)? else {
        left_out(bench, knob, "all steps");
        return Ok(());
    };
    let exact = Solution::of(&outcome);
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
            left_out(bench, knob, &format!("{named} and less, on {points} springs"));
            break;
        };
        let took = clock.elapsed().as_secs_f64();
        // Nothing is gained by another run of one that takes seconds already.
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

/// Samples of the curve, against very many of them: the curve between them is what they change, no figure.
fn samples(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::Samples;
    let legs = bench.scene.loading.len().max(1) as u64;
    let most = REFERENCE_SAMPLES / legs;
    let mut scene = refined(bench.scene, points, Edges::SubCell);
    scene.numerics.samples = most.max(2);
    if bench.budget.is_over() || most < 8 * FEWEST_SAMPLES {
        left_out(bench, knob, "all numbers");
        return Ok(());
    }
    let Solved::Outcome(outcome) = bench.solve(&scene)? else {
        left_out(bench, knob, "all numbers");
        return Ok(());
    };
    let finest = Solution::of(&outcome);
    for (index, samples) in
        std::iter::successors(Some(FEWEST_SAMPLES), |samples| Some(4 * samples)).enumerate()
    {
        if samples > most / 8 {
            break;
        }
        let share = if index < COARSE { 1.0 } else { SAMPLES_BY };
        if bench.budget.left_of(share) <= 0.0 {
            left_out(bench, knob, &format!("{samples} and more"));
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

/// What heights in single precision would lose.
fn single_precision(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::SinglePrecision;
    if bench.budget.is_over() {
        left_out(bench, knob, "not tried");
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

/// Random lines: how well the mean of their adhesion forces is known, and what they take one after the other.
fn lines(bench: &mut Bench<'_>, points: u64, rows: &mut Rows<'_, '_>) -> Result<(), CostError> {
    let knob = Knob::Lines;
    let Some(seed) = bench.scene.seed() else { return Ok(()) };
    let scene = refined(bench.scene, points, Edges::SubCell);
    let mut simulation = Simulation::new(bench.folder.to_path_buf());
    let (mut forces, mut seconds, mut next) = (Vec::new(), 0.0, FEWEST_LINES);
    while next <= MOST_LINES {
        rows.trying(knob, &next.to_string());
        while (forces.len() as u64) < next {
            if bench.budget.left_of(LINES_BY) <= 0.0 {
                left_out(bench, knob, &format!("{next} and more"));
                return Ok(());
            }
            let scene = of_seed(&scene, seed.wrapping_add(forces.len() as u64));
            let clock = Instant::now();
            let outcome = match simulation.run(&scene, &|| bench.budget.is_over(), &mut |_, _, _| Ok(())) {
                Ok(outcome) => outcome,
                Err(error) if error.is_interruption() => continue,
                Err(error) => return Err(error.into()),
            };
            seconds += clock.elapsed().as_secs_f64();
            let Some(force) = outcome.figures.adhesion_force else { return Ok(()) };
            forces.push(force);
        }
        let adhesion_force = relative_standard_error(&forces);
        if adhesion_force.is_none() {
            return Ok(());
        }
        let errors = Measures { adhesion_force, ..Measures::default() };
        let seconds = Timing::of(vec![seconds]);
        let tried = Tried { knob, setting: next as f64, springs: points, seconds, errors };
        rows.add(bench, tried, &Measures::default());
        next *= 2;
    }
    Ok(())
}

/// This scene with another random line.
fn of_seed(scene: &Scene, wanted: u64) -> Scene {
    let mut scene = scene.clone();
    scene.set_seed(wanted);
    scene
}

/// Standard deviation of a sample over the square root of its size and over its mean.
fn relative_standard_error(values: &[f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| ((value - mean) / mean).powi(2)).sum::<f64>();
    let error = (squares / (count - 1.0) / count).sqrt();
    error.is_finite().then_some(error)
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
