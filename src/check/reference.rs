//! Results of the solvers against the rules alone: contact by relaxation, forces and dissipated energies in
//! arithmetic with twice the digits.

use super::body::end;
use super::relaxation::Relaxation;
use super::{Body, Extended, Fault};
use crate::contact::{CurvePoint, Direction, LegRecord, Solver};
use crate::scene::{Edges, Move};

/// Differences of a solver from the rules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Largest error of a force, in units of [`follow`].
    pub force: f64,
    /// Contact states compared.
    pub states: usize,
    /// Number of these states with some springs in contact, in more than one fragment, and some not.
    pub partial: usize,
    /// Number of these states in which rounding decides about a spring.
    pub undecided: usize,
}

/// Largest relative error of the energy released on a loading stage (whole springs only).
const ENERGY: f64 = 1e-9;

/// Moves a body along loading stages, by the solver and by the rules.
///
/// Whole springs: after each stage the contact must be that of the relaxed rules. Edges between springs: each
/// fragment must be at rest, its level t at t − Δl_max(ℓ(t)) = d, between its own largest gap and the lower of its
/// two walls, and every free spring must be above the surface. The force at that point, and at the minimum of an
/// unloading stage, is then summed from this contact with twice the digits.
///
/// Errors of forces are in units of |F| plus the documented error of the sums: with whole springs 2⁻⁹ of the force
/// that presses every spring by the largest gap, with edges between springs the sum of the forces Σ Δk |d − c| and
/// the change of force by a rounding of the level.
///
/// # Errors
/// [`Fault::Wrong`] if the contact differs, and errors of a loading stage that cannot be computed.
pub fn follow(body: &Body, edges: Edges, legs: &[Move]) -> Result<Agreement, Fault> {
    body.with(edges, 64, |solver| {
        let mut agreement = Agreement::default();
        let mut relaxed = Relaxation::pair(body);
        let mut held = Vec::new();
        for &leg in legs {
            let record = solver.advance(leg)?;
            if edges == Edges::Grid {
                let undecided = same_contact(body, solver, &record, &mut relaxed)?;
                agreement.undecided += usize::from(undecided);
                let error = energy_error(body, solver, &record, &held)?;
                if error > ENERGY {
                    return Err(wrong(end(&record), &format!("the released energy is off by {error:.1e}")));
                }
            }
            let smallest = (record.direction == Direction::Unloading).then_some(record.smallest);
            for point in [end(&record)].into_iter().chain(smallest).filter(|point| point.springs > 0) {
                agreement.force = agreement.force.max(force_error(body, edges, solver, &point)?);
                agreement.states += 1;
                agreement.partial +=
                    usize::from(point.springs < body.gaps.len() as u64 && point.fragments > 1);
            }
            let last = end(&record);
            held = if last.springs > 0 { solver.leg().patches(last.indentation) } else { Vec::new() };
        }
        Ok(agreement)
    })
}

/// Returns true if rounding decides about the contact at the end of a stage; an error if the rules yield another.
fn same_contact(
    body: &Body,
    solver: &dyn Solver,
    record: &LegRecord,
    [less, more]: &mut [Relaxation<'_>; 2],
) -> Result<bool, Fault> {
    let last = end(record);
    let flies = record.curve.iter().all(|point| point.springs == 0);
    if flies {
        return if more.is_separated() { Ok(false) } else { Err(wrong(last, "nothing is held")) };
    }
    more.move_to(last.indentation);
    if last.springs == 0 && record.target == Move::ToSeparation {
        // The contact still holds at the last indentation, and not at the next number below.
        let size = last.indentation.abs() + body.deepest() + body.largest_stretch();
        let beyond = (32.0 * f64::EPSILON * size).max(f64::from_bits(1));
        less.move_to(last.indentation - beyond);
        if more.is_separated() || !less.is_separated() {
            return Err(wrong(last, "it separates elsewhere"));
        }
        more.separate();
        return Ok(false);
    }
    less.move_to(last.indentation);
    let mut touching = vec![false; body.gaps.len()];
    if last.springs > 0 {
        for (first, last) in solver.leg().patches(last.indentation) {
            touching[first..=last].fill(true);
        }
    }
    let between = less.contact().iter().zip(&touching).zip(more.contact());
    if between.clone().any(|((&less, &here), &more)| (less && !here) || (here && !more)) {
        return Err(wrong(last, "the contact is not that of the rules"));
    }
    let undecided = less.contact() != more.contact();
    if last.springs == 0 {
        more.separate();
    }
    Ok(undecided)
}

fn wrong(point: CurvePoint, what: &str) -> Fault {
    Fault::Wrong(format!("at d = {:e} m {what}", point.indentation))
}

/// Relative error of the energy of a loading stage that has changed the earlier contact `held`.
fn energy_error(
    body: &Body,
    solver: &dyn Solver,
    record: &LegRecord,
    held: &[(usize, usize)],
) -> Result<f64, Fault> {
    let last = end(record);
    let mut before = vec![false; body.gaps.len()];
    for &(first, last) in held {
        before[first..=last].fill(true);
    }
    let thresholds = solver.leg().thresholds();
    let mut squares = Extended::default();
    for ((&gap, &threshold), &before) in body.gaps.iter().zip(&thresholds).zip(&before) {
        let after = last.springs > 0 && threshold <= last.indentation;
        if before != after {
            let stretch = Extended::from(gap) + -Extended::from(threshold);
            squares += stretch * stretch;
        }
    }
    let half_stiffness =
        Extended::from(0.5 * body.foundation.effective_modulus) * Extended::from(body.foundation.spacing);
    let expected = (half_stiffness * squares).rounded();
    let found = record.released_energy.abs();
    let sign = if record.direction == Direction::Loading { -1.0 } else { 1.0 };
    if sign * record.released_energy < 0.0 {
        return Err(wrong(last, "energy is gained"));
    }
    // Stretches of 1e-8 of the depth and below are near the rounding of an indentation.
    let smallest = 1e-8 * body.deepest();
    let unit = expected + half_stiffness.rounded() * body.gaps.len() as f64 * smallest * smallest;
    Ok(if expected == found { 0.0 } else { (found - expected).abs() / unit })
}

/// Error of the force of a point in contact on the present stage, in units of [`follow`].
pub fn force_error(body: &Body, edges: Edges, solver: &dyn Solver, point: &CurvePoint) -> Result<f64, Fault> {
    let d = point.indentation;
    let fragments = solver.leg().patches(d);
    let springs: usize = fragments.iter().map(|(first, last)| last + 1 - first).sum();
    if (springs as u64, fragments.len() as u64) != (point.springs, point.fragments) {
        return Err(wrong(*point, "springs or fragments are counted otherwise"));
    }
    let stiffness =
        Extended::from(body.foundation.effective_modulus) * Extended::from(body.foundation.spacing);
    let mut sum = Extended::default();
    // In units of the stiffness of one spring.
    let mut allowed = 0.0;
    for &(first, last) in &fragments {
        match edges {
            Edges::Grid => {
                for &gap in &body.gaps[first..=last] {
                    sum += Extended::from(d) - Extended::from(gap);
                }
            }
            Edges::SubCell => {
                let rest = Rest::of(body, d, (first, last))?;
                sum += rest.compression;
                allowed += rest.allowed;
            }
        }
    }
    if edges == Edges::Grid {
        allowed = body.gaps.len() as f64 * body.deepest() * 2.0_f64.powi(-9);
    }
    let expected = stiffness * sum;
    let unit = expected.abs().rounded() + stiffness.rounded() * allowed;
    let error = (Extended::from(point.force) - expected).abs().rounded();
    Ok(if error == 0.0 { 0.0 } else { error / unit })
}

/// A fragment at rest, with edges between springs.
struct Rest {
    /// ∫ (d − c) dx over the fragment, in cells times metres.
    compression: Extended,
    /// Bound on roundings, in cells times metres.
    allowed: f64,
}

/// The cell with an edge: from the last attached spring to a free one or the end of the foundation.
#[derive(Clone, Copy)]
struct Edge {
    inside: f64,
    outside: Option<f64>,
}

impl Edge {
    /// Attached share of the cell at level t: `constant` + `growth` t.
    fn share(self) -> (Extended, Extended) {
        match self.outside {
            None => (Extended::from(0.5), Extended::default()),
            Some(outside) => {
                let inside = Extended::from(self.inside);
                let growth = Extended::from(1.0) / (Extended::from(outside) - inside);
                (-(inside * growth), growth)
            }
        }
    }
}

impl Rest {
    /// Equilibrium of the fragment of these springs at indentation d.
    fn of(body: &Body, d: f64, (first, last): (usize, usize)) -> Result<Rest, Fault> {
        let outside = |spring: Option<usize>| spring.and_then(|spring| body.gaps.get(spring)).copied();
        let ends = [
            Edge { inside: body.gaps[first], outside: outside(first.checked_sub(1)) },
            Edge { inside: body.gaps[last], outside: outside(last.checked_add(1)) },
        ];
        let held = &body.gaps[first..=last];
        let largest = held.iter().copied().fold(0.0, f64::max);
        let wall = ends.iter().filter_map(|end| end.outside).fold(f64::INFINITY, f64::min);
        let unstable = |what| Err(Fault::Wrong(format!("at d = {d:e} m the fragment {first}–{last} {what}")));
        if wall <= largest || wall <= d {
            return unstable("leaves out a spring that touches");
        }
        // ℓ = a + b t in cells, and t = d + s √ℓ: the larger root, where t − s √ℓ rises through d.
        let shares = ends.map(Edge::share);
        let a = Extended::from((last - first) as f64) + shares[0].0 + shares[1].0;
        let b = shares[0].1 + shares[1].1;
        let range = Extended::PI * Extended::from(body.foundation.spacing) * Extended::from(body.work)
            / Extended::from(body.foundation.effective_modulus);
        let s = range.sqrt();
        let half = Extended::from(0.5) * b * s;
        let at_rest = half * half + a + b * Extended::from(d);
        let root = half + at_rest.sqrt();
        let level = Extended::from(d) + s * root;
        // No level inside is at rest, so the nearest one must be, to rounding. At a single indentation, where an
        // edge passes a spring and the rest is about to detach, a fragment may end at the limit of its levels.
        let clamp = |level: Extended| {
            if level.rounded() > wall {
                Extended::from(wall)
            } else if level.rounded() < largest {
                Extended::from(largest)
            } else {
                level
            }
        };
        let level = clamp(level);
        let length = a + b * level;
        let rest = (level - s * length.sqrt() - Extended::from(d)).rounded();
        let scale = largest + d.abs() + level.abs().rounded() + s.rounded() * length.rounded().abs().sqrt();
        if rest > 64.0 * f64::EPSILON * scale {
            return unstable("holds a spring that is stretched too far");
        }
        if rest < -64.0 * f64::EPSILON * scale {
            return unstable("leaves out a spring within its reach");
        }
        let half_of = |sum: Extended| sum * Extended::from(0.5);
        let mut compression = Extended::default();
        let mut magnitude = 0.0;
        for pair in held.windows(2) {
            let mean = half_of(Extended::from(pair[0]) + Extended::from(pair[1]));
            compression += Extended::from(d) - mean;
            magnitude += (d - mean.rounded()).abs();
        }
        for (end, (constant, growth)) in ends.iter().zip(shares) {
            let (share, to) = match end.outside {
                None => (constant, Extended::from(end.inside)),
                Some(_) => (constant + growth * level, level),
            };
            let mean = half_of(Extended::from(end.inside) + to);
            compression += share * (Extended::from(d) - mean);
            magnitude += (share * (Extended::from(d) - mean)).abs().rounded();
        }
        // Distance of the edges for a rounding of the level, and their stretch.
        let edges_move = b.rounded() * (scale + level_slope(&half, &root) * scale);
        let stretched = (level - Extended::from(d)).abs().rounded();
        let springs = (last - first + 1) as f64;
        Ok(Rest { compression, allowed: magnitude + springs * largest + stretched * edges_move })
    }
}

/// Movement of a level in excess of the change of the indentation: 1/(dφ/dt) − 1, where
/// dφ/dt = 1 − half/root.
fn level_slope(half: &Extended, root: &Extended) -> f64 {
    let steep = (*root - *half).rounded();
    if steep > 0.0 { half.rounded() / steep } else { f64::MAX.sqrt() }
}
