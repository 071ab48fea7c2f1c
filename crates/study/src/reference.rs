//! The same contact as a line and in three dimensions: means over random profiles and random squares with one spectrum.
//!
//! A free rigid square of the side L is compared with a line of the length L, without a fit. Line and square are independent
//! draws, so only their means compare. The area of contact does not: at the same force the line has 1.1 to 4.2 times
//! the area of three dimensions.

use super::error::StudyError;
use super::profiles::Stop;
use super::quantity::Quantity;
use super::spatial::{Body, Pressing, Pulling};
use super::statistics::Statistics;
use asperity_contact::{CurvePoint, Move};
use asperity_data::on_threads;
use asperity_scene::{CheckedScene, Outcome, Roughness, Scene, Simulation};

use serde::Serialize;
use std::time::Instant;

/// Cells for the shortest wave of a square.
const CELLS_PER_WAVE: u64 = 8;
/// Springs for the shortest wave of a line.
const SPRINGS_PER_WAVE: u64 = 64;
const LEAST_SPRINGS: u64 = 4096;
/// Forces of the comparison without adhesion, as shares of the preload.
const SHARES: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.6, 1.0];
/// Steps of the indentation from the preload to pull-off.
const STEPS: f64 = 40.0;
/// Fewest cells of a square, and of the coarser one that is compared with it.
const LEAST_CELLS: usize = 32;

/// Numbers of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ReferenceOptions {
    /// Cells along the side of a square: a power of two.
    pub cells: usize,
    /// Number of random squares.
    pub maps: u64,
    /// Number of random lines.
    pub lines: u64,
}

/// A number of both models.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// On the lines.
    pub line: Statistics,
    /// On the squares.
    pub half_space: Statistics,
    /// Mean of the lines over mean of the squares.
    pub ratio: f64,
    /// Half the width of the interval that holds the ratio in about 95 of 100 cases, by the standard errors of both means;
    /// `None` for fewer than two of either.
    pub error: Option<f64>,
}

/// Both models at one force, without adhesion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Loaded {
    /// Force, N.
    pub force: f64,
    /// Indentation from first touch, m.
    pub indentation: Compared,
    /// Stiffness dF/dd, N/m.
    pub stiffness: Compared,
    /// Mean area of contact in three dimensions, m².
    pub area: f64,
}

/// Comparison of a scene as a line and in three dimensions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Numbers of the comparison.
    #[serde(flatten)]
    pub options: ReferenceOptions,
    /// First and last wave of both models, in waves over the length; `None` for a smooth body.
    pub waves: Option<(u64, u64)>,
    /// Last wave of the scene where squares do not resolve it and both models leave out the waves beyond `waves`.
    pub omitted: Option<u64>,
    /// Preload, N.
    pub preload: f64,
    /// Loading without adhesion.
    pub loading: Vec<Loaded>,
    /// Adhesion force after the preload, N.
    pub adhesion_force: Option<Compared>,
    /// Adhesion force after a turn at first touch, N.
    pub zero_load_adhesion_force: Option<Compared>,
    /// Dissipated energy, J.
    pub dissipated_energy: Option<Compared>,
    /// Errors of the line by their sources.
    pub budget: ReferenceBudget,
    /// Convolutions on the squares.
    pub convolutions: u64,
    /// Time of the lines and of the squares, s.
    pub seconds: [f64; 2],
}

/// Errors by their sources, as shares of the adhesion force, or without adhesion of the indentation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReferenceBudget {
    /// Largest residual of the contacts without adhesion, in rms heights.
    pub solver: f64,
    /// Difference of the means on squares of half as many cells; `None` where half of the cells are too few.
    pub grid: Option<f64>,
    /// Half the width of the interval of the ratio, by the finite number of squares and lines.
    pub sample: Option<f64>,
    /// Difference of the ratio of both models from 1.
    pub model: f64,
    /// Name of the largest.
    pub largest: &'static str,
}

/// The numbers of one random square, and those of the coarser one.
struct OfSquare {
    pressings: Vec<Pressing>,
    pulling: Option<Pulling>,
    coarser: Option<(f64, Option<Pulling>)>,
    convolutions: u64,
}

impl Reference {
    /// Compares a checked scene with squares. `jobs` threads share the lines and the squares; no bit but the seconds depends
    /// on their number. `report` receives the number of squares that are done.
    ///
    /// # Errors
    /// The scene has no body in three dimensions or no preload above zero, the number of cells is not allowed, too little
    /// memory, or `stop` returned true.
    pub fn of(
        scene: &CheckedScene,
        options: ReferenceOptions,
        jobs: usize,
        stop: &Stop<'_>,
        report: &(dyn Fn() + Sync),
    ) -> Result<Reference, StudyError> {
        if options.maps == 0 || options.lines == 0 {
            return Err(StudyError::refused(None, "no profiles", "at least one"));
        }
        let mut simulation = Simulation::default();
        let failed = |error| StudyError::Run { place: String::new(), error };
        let (_, _, governing) = simulation.make_line(scene).map_err(failed)?;
        let cut = Cut::of(scene, &governing, options.cells)?;
        let (seed, is_random) = (scene.seed().unwrap_or(0), scene.seed().is_some());
        let number = |wanted: u64| if is_random { wanted } else { 1 };
        let options =
            ReferenceOptions { maps: number(options.maps), lines: number(options.lines), ..options };

        let begun = Instant::now();
        let own = run(&cut.line, &mut simulation, stop)?;
        let preload = own.figures.preload.filter(|preload| *preload > 0.0).ok_or_else(|| {
            let allowed = "a loading to a force or an indentation before the separation";
            StudyError::refused(None, "the loading has no preload above 0 N", allowed)
        })?;
        let bare = cut.line.with(|scene| {
            scene.adhesion = None;
            scene.loading = vec![Move::ToForce(preload)];
        });
        let bare = bare.map_err(|errors| StudyError::Run { place: String::new(), error: errors.into() })?;
        let forces = SHARES.map(|share| share * preload);
        let lines = on_threads(options.lines, jobs, || {
            let mut simulation = Simulation::default();
            let (cut, bare) = (&cut, &bare);
            move |line: u64| {
                let seed = seed.wrapping_add(line);
                let pressed = run(&bare.with_seed(seed), &mut simulation, stop)?;
                let outcome = run(&cut.line.with_seed(seed), &mut simulation, stop)?;
                Ok::<_, StudyError>((forces.map(|force| at_force(&pressed, force)), outcome))
            }
        })?;
        let of_lines = begun.elapsed().as_secs_f64();

        let begun = Instant::now();
        let depth =
            own.figures.preload_indentation.unwrap_or(0.0) - own.figures.pull_off_indentation.unwrap_or(0.0);
        let step = depth.abs() / STEPS;
        let squares = on_threads(options.maps, jobs, || {
            let (body, stop) = (&cut.body, || stop());
            move |map: u64| {
                let found = of_square(body, (options.cells, seed.wrapping_add(map)), (&forces, step), &stop)?;
                report();
                Ok::<_, StudyError>(found)
            }
        })?;
        let of_squares = begun.elapsed().as_secs_f64();
        Ok(Reference::gather(options, &cut, preload, &lines, &squares, [of_lines, of_squares]))
    }

    fn gather(
        options: ReferenceOptions,
        cut: &Cut,
        preload: f64,
        lines: &[([CurvePoint; SHARES.len()], Outcome)],
        squares: &[OfSquare],
        seconds: [f64; 2],
    ) -> Reference {
        let modulus = cut.body.effective_modulus;
        let loading = SHARES.iter().enumerate().filter_map(|(at, share)| {
            let of = |line: &dyn Fn(&CurvePoint) -> f64, square: &dyn Fn(&Pressing) -> f64| {
                compared(
                    lines.iter().map(|(points, _)| line(&points[at])),
                    squares.iter().map(|found| square(&found.pressings[at])),
                )
            };
            Some(Loaded {
                force: share * preload,
                indentation: of(&|point| point.indentation, &|found| found.indentation)?,
                // Without adhesion the stiffness of the springs is E* times their length in contact.
                stiffness: of(&|point| modulus * point.contact_length, &|found| found.stiffness)?,
                area: squares.iter().map(|found| found.pressings[at].area).sum::<f64>()
                    / squares.len() as f64,
            })
        });
        let loading: Vec<Loaded> = loading.collect();
        let of = |line: &dyn Fn(&Outcome) -> Option<f64>, square: &dyn Fn(&Pulling) -> f64| {
            compared(
                lines.iter().filter_map(|(_, outcome)| line(outcome)),
                squares.iter().filter_map(|found| found.pulling.as_ref().map(square)),
            )
        };
        let adhesion_force = of(&|outcome| outcome.figures.adhesion_force, &|found| found.adhesion_force);
        let headline = adhesion_force.or(loading.last().map(|last| last.indentation));
        let budget = budget(headline, squares, adhesion_force.is_some());
        Reference {
            waves: cut.waves,
            omitted: cut.omitted,
            preload,
            adhesion_force,
            zero_load_adhesion_force: of(&|outcome| outcome.zero_load_adhesion_force, &|found| {
                found.at_touch
            }),
            dissipated_energy: of(&|outcome| outcome.figures.dissipated_energy, &|found| {
                found.dissipated_energy
            }),
            loading,
            budget,
            convolutions: squares.iter().map(|found| found.convolutions).sum(),
            seconds,
            options,
        }
    }
}

/// A scene with the waves that squares resolve, as a line and in three dimensions.
struct Cut {
    line: CheckedScene,
    body: Body,
    waves: Option<(u64, u64)>,
    omitted: Option<u64>,
}

impl Cut {
    fn of(
        scene: &CheckedScene,
        governing: &asperity_scene::Governing,
        cells: usize,
    ) -> Result<Cut, StudyError> {
        if scene.measured().is_some() {
            let allowed = "self-affine roughness, and any form: asperity surface states H and the waves of a measured surface";
            return Err(StudyError::refused(None, "the roughness is measured", allowed));
        }
        let mut changed = Scene::clone(scene);
        // The work of adhesion stays where waves are left out.
        if let Some((adhesion, work)) = scene.adhesion.zip(governing.work_of_adhesion) {
            changed.adhesion = Some(adhesion.with_work(work));
        }
        changed.observe.clear();
        let mut body = Body {
            form: scene.form.clone(),
            roughness: None,
            side: scene.length,
            effective_modulus: governing.effective_modulus,
            works: governing.adhesive_works(),
        };
        let (mut waves, mut omitted) = (None, None);
        if let (Some(spectrum), Some(amplitude)) = (scene.spectrum(), governing.amplitude) {
            let last = spectrum.last.min(cells as u64 / CELLS_PER_WAVE);
            if last < spectrum.first {
                let least = (CELLS_PER_WAVE * spectrum.first).next_power_of_two();
                return Err(StudyError::refused(
                    Some(&format!("{cells} cells")),
                    format!("the longest wave of the scene has {} cells", cells as u64 / spectrum.first),
                    format!("at least {least} cells along the side"),
                ));
            }
            let kept = asperity_surface::SelfAffine { last, ..spectrum };
            let first = amplitude.rms_height / spectrum.relative_rms();
            let Some(Roughness::SelfAffine { rms_height, rms_gradient, modes, wavelengths, .. }) =
                &mut changed.roughness
            else {
                unreachable!("a spectrum is that of self-affine roughness")
            };
            (*rms_height, *rms_gradient) = (Some(first * kept.relative_rms()), None);
            (*modes, *wavelengths) = (Some((kept.first, kept.last)), None);
            changed.numerics.points = (SPRINGS_PER_WAVE * last).next_power_of_two().max(LEAST_SPRINGS);
            waves = Some((kept.first, kept.last));
            omitted = (last < spectrum.last).then_some(spectrum.last);
            body.roughness = Some((kept, first));
        }
        let line = changed.checked();
        let line = line.map_err(|errors| StudyError::Run { place: String::new(), error: errors.into() })?;
        Ok(Cut { line, body, waves, omitted })
    }
}

fn run(scene: &CheckedScene, simulation: &mut Simulation, stop: &Stop<'_>) -> Result<Outcome, StudyError> {
    let outcome = simulation.run(scene, &|| stop(), &mut |_, _, _| Ok(()));
    outcome.map_err(|error| StudyError::Run { place: String::new(), error })
}

/// The point of a loading without adhesion at a force, N, between the samples of its curve.
fn at_force(outcome: &Outcome, force: f64) -> CurvePoint {
    let curve = outcome.history.legs.first().map_or(&[][..], |leg| &leg.curve);
    let after = curve.partition_point(|point| point.force < force).min(curve.len().saturating_sub(1));
    let (Some(one), Some(other)) = (curve.get(after.saturating_sub(1)), curve.get(after)) else {
        return CurvePoint::default();
    };
    let span = other.force - one.force;
    let share = if span > 0.0 { (force - one.force) / span } else { 0.0 };
    CurvePoint {
        force,
        indentation: one.indentation + share * (other.indentation - one.indentation),
        contact_length: one.contact_length + share * (other.contact_length - one.contact_length),
        ..*other
    }
}

fn of_square(
    body: &Body,
    (cells, seed): (usize, u64),
    (forces, step): (&[f64], f64),
    stop: &dyn Fn() -> bool,
) -> Result<OfSquare, StudyError> {
    let preload = forces[forces.len() - 1];
    let heights = body.heights(cells, seed)?;
    let (pressings, mut convolutions) = body.press(&heights, forces, stop)?;
    let pulling = body.pull(&heights, (preload, step), stop)?;
    convolutions += pulling.map_or(0, |(_, count)| count);
    let coarser = if cells / 2 >= LEAST_CELLS {
        let heights = body.heights(cells / 2, seed)?;
        let (pressings, _) = body.press(&heights, &[preload], stop)?;
        let pulling = body.pull(&heights, (preload, step), stop)?;
        Some((pressings[0].indentation, pulling.map(|(figures, _)| figures)))
    } else {
        None
    };
    Ok(OfSquare { pressings, pulling: pulling.map(|(figures, _)| figures), coarser, convolutions })
}

/// Statistics of both models and the ratio of their means; `None` without values.
fn compared(line: impl Iterator<Item = f64>, square: impl Iterator<Item = f64>) -> Option<Compared> {
    let bounds = Quantity::AdhesionForce.bounds();
    let [line, half_space] =
        [Statistics::of(line.collect(), bounds)?, Statistics::of(square.collect(), bounds)?];
    let ratio = line.mean / half_space.mean;
    let relative = |all: &Statistics| all.spread.map(|spread| spread.standard_error / all.mean);
    let error =
        relative(&line).zip(relative(&half_space)).map(|(one, other)| 1.96 * ratio * one.hypot(other));
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    Some(Compared { line, half_space, ratio: finite(ratio)?, error: error.and_then(finite) })
}

fn budget(headline: Option<Compared>, squares: &[OfSquare], is_adhesive: bool) -> ReferenceBudget {
    let of = |found: &OfSquare| {
        let (indentation, pulling) = found.coarser?;
        let fine = found.pressings.last()?.indentation;
        if is_adhesive {
            Some((pulling?.adhesion_force, found.pulling?.adhesion_force))
        } else {
            Some((indentation, fine))
        }
    };
    let both: Option<Vec<(f64, f64)>> = squares.iter().map(of).collect();
    let grid = both.and_then(|both| {
        let (coarse, fine) = both.iter().fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        Some((coarse / fine - 1.0).abs()).filter(|share| share.is_finite())
    });
    let solver = squares.iter().flat_map(|found| &found.pressings).map(|found| found.residual);
    let solver = solver.fold(0.0, f64::max);
    let model = headline.map_or(0.0, |of| (of.ratio - 1.0).abs());
    let sample = headline.and_then(|of| Some(of.error? / of.ratio));
    let known = [("solver", Some(solver)), ("grid", grid), ("sample", sample), ("model", Some(model))];
    let known = known.into_iter().filter_map(|(name, share)| Some((name, share?)));
    let largest = known.max_by(|one, other| one.1.total_cmp(&other.1)).map_or("model", |(name, _)| name);
    ReferenceBudget { solver, grid, sample, model, largest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    fn reference(
        scene: &CheckedScene,
        cells: usize,
        maps: u64,
        jobs: usize,
    ) -> Result<Reference, StudyError> {
        let options = ReferenceOptions { cells, maps, lines: 16 * maps };
        Reference::of(scene, options, jobs, &|| false, &|| ())
    }

    /// For a sphere the line is exact, so that both models agree to the error of the grid.
    #[test]
    fn a_sphere_is_the_same_in_both_models() {
        let scene = open("jkr-sphere").unwrap();
        let found = reference(scene.scene(), 64, 3, 1).unwrap();
        assert_eq!((found.options.maps, found.options.lines, found.waves), (1, 1, None));
        for loaded in &found.loading[2..] {
            assert!((loaded.indentation.ratio - 1.0).abs() < 0.02, "{loaded:?}");
            assert!((loaded.stiffness.ratio - 1.0).abs() < 0.03, "{loaded:?}");
        }
        let force = found.adhesion_force.unwrap();
        assert!((force.ratio - 1.0).abs() < 0.15, "{force:?}");
    }

    /// The line of a rough body is a model, whose stiffness is of the size of that of squares. No bit but the
    /// times depends on the number of threads.
    #[test]
    fn a_rough_body_is_compared_in_the_mean() {
        let scene = open("pressure-sensitive").unwrap();
        let found = reference(scene.scene(), 64, 2, 2).unwrap();
        assert_eq!((found.waves, found.omitted), (Some((4, 8)), Some(512)));
        for loaded in &found.loading {
            // Two squares scatter by a half.
            assert!((0.4..2.5).contains(&loaded.stiffness.ratio), "{loaded:?}");
        }
        let same = Reference { seconds: found.seconds, ..reference(scene.scene(), 64, 2, 1).unwrap() };
        assert_eq!(same, found);
        assert!(found.budget.solver <= 1e-8 && found.budget.grid.is_some() && found.budget.sample.is_some());
    }

    #[test]
    fn what_has_no_square_is_refused() {
        let scene = open("pressure-sensitive").unwrap();
        let refused = |scene: &CheckedScene, cells| reference(scene, cells, 1, 1).unwrap_err().to_string();
        assert_eq!(
            refused(scene.scene(), 48),
            "48 cells along a side; allowed: a power of two from 32 to 8192"
        );
        let longer = scene.scene().with(|scene| {
            if let Some(Roughness::SelfAffine { modes, .. }) = &mut scene.roughness {
                *modes = Some((16, 512));
            }
        });
        let error = refused(&longer.unwrap(), 64);
        assert!(error.contains("at least 128 cells along the side"), "{error}");
        let touch =
            scene.scene().with(|scene| scene.loading = vec![Move::ToTouch, Move::ToSeparation]).unwrap();
        assert!(refused(&touch, 64).starts_with("the loading has no preload"), "{}", refused(&touch, 64));
    }
}
