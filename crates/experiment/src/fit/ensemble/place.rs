//! The place around which the table is computed, found by a coarse table of few profiles.

use super::computed::Place;
use super::measured::Measured;
use super::scatter::Scatter;
use super::summary::SUMMARIES;
use super::table::{Table, Workers, nodes};
use crate::error::ExperimentError;
use asperity_scene::Governing;

/// Number of random profiles of the coarse table, its steps in ln(γ/E*) and ln E*, and numbers of
/// nodes.
const LINES: u64 = 8;
const STEPS: [f64; 2] = [0.8, 0.7];
const NODES: [usize; 2] = [13, 7];
/// Number of places between two nodes, and number of coarse tables.
const FINE_STEPS: usize = 6;
const MOST_MOVES: usize = 4;
/// Largest κ = √(h⟨∇z⟩E*/γ) of the first table. The smallest is about 1.
const HIGHEST_KAPPA: f64 = 80.0;
/// Smallest standard deviation of a summary.
const LEAST_SCATTER: f64 = 0.1;

/// Finds the place, to about a step of the table, where the computed curves have the mean summaries
/// of the measured curves.
pub(crate) fn placed(
    workers: &Workers<'_>,
    measured: &Measured,
    governing: &Governing,
    known: Option<f64>,
) -> Result<Place, ExperimentError> {
    let target = measured.mean().summaries;
    let of_roughness = governing
        .amplitude
        .map_or(0.0, |of| of.rms_height * of.rms_gradient);
    let largest = of_roughness.max(f64::MIN_POSITIVE).ln();
    let modulus = governing.effective_modulus.ln();
    let width = |index: usize| (NODES[index] - 1) as f64 * STEPS[index];
    let (mut low, mut soft) = (
        largest - HIGHEST_KAPPA.powi(2).ln(),
        modulus - 0.5 * width(1),
    );
    let variance = 1.0 / measured.summaries.len() as f64 + 1.0 / LINES as f64;
    for last in (0..MOST_MOVES).rev() {
        let ranges = nodes(low, STEPS[0], NODES[0]);
        let moduli = known.map_or_else(|| nodes(soft, STEPS[1], NODES[1]), |modulus| vec![modulus]);
        let table = Table::new(workers, LINES, ranges, moduli)?;
        let of_summary =
            |index: usize| Scatter::of(&table, |line, node| [table.lines[line][node][index], 0.0]);
        let scatters: Vec<Scatter> = (0..SUMMARIES).map(of_summary).collect();
        let misfit = |place: Place| {
            let of = |(scatter, target): (&Scatter, f64)| {
                let moments = scatter.at(place);
                let square = moments.covariance[0] + LEAST_SCATTER.powi(2);
                (moments.mean[0] - target).powi(2) / square / variance + square.ln()
            };
            scatters.iter().zip(target).map(of).sum::<f64>()
        };
        let within = |axis: &[f64]| {
            let fine = FINE_STEPS * (axis.len() - 1);
            let (first, last) = (axis[0], axis[axis.len() - 1]);
            (0..=fine)
                .map(move |index| first + (last - first) * index as f64 / fine.max(1) as f64)
                .collect()
        };
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (within(&table.ranges), within(&table.moduli));
        let places = ranges
            .iter()
            .flat_map(|&range| moduli.iter().map(move |&modulus| Place { range, modulus }));
        let misfits = places.map(|place| (misfit(place), place));
        let Some((_, best)) = misfits.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            break;
        };
        let is_at_end = |axis: &[f64], at: f64, step: f64| {
            axis.len() > 1 && (at - axis[0]).min(axis[axis.len() - 1] - at) < 0.5 * step
        };
        let moved = [
            is_at_end(&table.ranges, best.range, STEPS[0]),
            is_at_end(&table.moduli, best.modulus, STEPS[1]),
        ];
        if moved == [false; 2] || last == 0 {
            return Ok(best);
        }
        if moved[0] {
            low = best.range - 0.5 * width(0);
        }
        if moved[1] {
            soft = best.modulus - 0.5 * width(1);
        }
    }
    Ok(Place {
        range: low,
        modulus,
    })
}
