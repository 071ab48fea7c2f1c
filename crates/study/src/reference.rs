//! The same contact as a profile and in three dimensions: means over random profiles and random squares with one spectrum.
//!
//! A free rigid square of the side L is compared with a profile (line) of the length L, without a fit. Line and square are
//! independent draws, so only their means are compared. At the same force the line has 1.1 to 4.2 times the area of contact in
//! three dimensions.

use super::error::StudyError;
use super::profiles::{Stop, on_threads_received};
use super::quantity::Quantity;
use super::reference_time::{LEAST_CELLS, LONGEST, check_time, seconds_of_square};
use super::resolved::{Resolved, of_scene};
use super::spatial::{Loads, Pressing, Pulling};
use super::statistics::Statistics;
use asperity_contact::{CurvePoint, Move};
use asperity_data::{check_room, memory_size, on_threads};
use asperity_scene::{CheckedScene, Outcome, Scene, Simulation};
use serde::Serialize;
use std::sync::mpsc::Sender;
use std::time::Instant;

/// Forces of the comparison without adhesion, as shares of the preload.
const SHARES: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.6, 1.0];
/// Number of steps of the indentation from the preload to pull-off.
const STEPS: f64 = 40.0;
/// Options of a [`Reference`]: numbers of random profiles, of random squares, and of grid cells along the side of a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ReferenceOptions {
    /// Number of grid cells along the side of a square, a power of two.
    pub cells: usize,
    /// Number of random squares.
    pub maps: u64,
    /// Number of random profiles.
    pub lines: u64,
}

/// Number of random profiles for each square. A profile takes a thousandth of the time.
const LINES_PER_MAP: u64 = 16;

impl ReferenceOptions {
    /// Returns the usual options for a scene: 64 grid cells along the side of a square, and 16 random profiles for each square.
    /// `maps` is the number of squares. `None` means 12 squares for a scene with adhesion, and 24 without adhesion.
    pub fn of(scene: &Scene, maps: Option<u64>) -> ReferenceOptions {
        let maps = maps.unwrap_or(if scene.adhesion.is_some() { 12 } else { 24 });
        ReferenceOptions { cells: 64, maps, lines: LINES_PER_MAP * maps }
    }
}

/// Comparison of one quantity between random profiles and random squares in three dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Statistics of the quantity over the random profiles.
    pub line: Statistics,
    /// Statistics of the quantity over the random squares in three dimensions.
    pub half_space: Statistics,
    /// Mean of the quantity over the profiles divided by its mean over the squares.
    pub ratio: f64,
    /// Half the width of the 95 % confidence interval of [`Compared::ratio`]; `None` for fewer than two profiles or squares.
    pub error: Option<f64>,
}

/// Comparison of random profiles with random squares in three dimensions under one force, without adhesion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Loaded {
    /// Force on each profile and on each square, N.
    pub force: f64,
    /// Indentation in m at this force, counted from first touch.
    pub indentation: Compared,
    /// Stiffness of the contact in N/m at this force: the change of force divided by the change of indentation.
    pub stiffness: Compared,
    /// Mean area of contact of the squares at this force, m².
    pub area: f64,
}

/// Comparison of a scene on random profiles with the same scene on random squares in three dimensions. A square is a rigid rough
/// body of the side L on an elastic half-space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Numbers of profiles, squares and grid cells with which the comparison was computed.
    #[serde(flatten)]
    pub options: ReferenceOptions,
    /// Longest and shortest wave of the roughness on profiles and squares, each as its number of periods over the length L;
    /// `None` for a smooth body.
    pub waves: Option<(u64, u64)>,
    /// Number of periods over L of the shortest wave of the scene, if the comparison omits this wave because the grid of the
    /// squares is too coarse; otherwise `None`.
    pub omitted: Option<u64>,
    /// Preload in N of the scene on the profile with the seed of the scene. The squares are pressed to this force.
    pub preload: f64,
    /// Comparison without adhesion at several forces, from a hundredth of the preload to the preload.
    pub loading: Vec<Loaded>,
    /// Comparison of the adhesion force F_a in N after the preload; `None` for a scene without adhesion.
    pub adhesion_force: Option<Compared>,
    /// Comparison of the adhesion force F_a(d=0) in N of loops that turn at first touch; `None` for a scene without adhesion.
    pub first_touch_adhesion_force: Option<Compared>,
    /// Comparison of the energy in J that the contact loses in the loop to the preload and back; `None` for a scene without
    /// adhesion.
    pub dissipated_energy: Option<Compared>,
    /// Errors of the comparison of adhesion forces, or of indentations for a scene without adhesion, one for each source.
    pub budget: ReferenceBudget,
    /// Number of convolutions over the grid of a square that the solver computed for all squares together, a measure of the
    /// computing work.
    pub convolutions: u64,
    /// Computing time in s: first of all profiles together, then of all squares together.
    pub seconds: [f64; 2],
    /// Mean computing time of one square, s.
    pub seconds_of_square: f64,
}

/// Errors of a [`Reference`], one for each source of errors. The errors `grid`, `sample` and `model` are relative errors of the
/// adhesion force, or of the indentation at the preload if the scene has no adhesion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReferenceBudget {
    /// Largest error of the gap between the bodies in the contacts without adhesion, at any grid cell of any square, divided by
    /// the rms height of the square.
    pub solver: f64,
    /// Relative difference between the mean over the squares and the mean over the same squares with half as many grid cells
    /// along the side; `None` if half as many cells are too few.
    pub grid: Option<f64>,
    /// Half the width of the 95 % confidence interval of [`Compared::ratio`], divided by this ratio; `None` for fewer than two
    /// profiles or squares.
    pub sample: Option<f64>,
    /// Difference between [`Compared::ratio`] and 1, without its sign.
    pub model: f64,
    /// Name of the field with the largest error: `solver`, `grid`, `sample` or `model`.
    pub largest: &'static str,
}

/// Event that [`Reference::of`] reports while it compares profiles with squares.
#[derive(Clone, Debug)]
pub enum ReferenceEvent {
    /// All profiles are computed, and the computation of the squares begins.
    Begins {
        /// Number of squares, which is one for a body without random roughness.
        maps: u64,
        /// Number of threads that share the squares.
        threads: usize,
        /// Memory in bytes that all threads need together.
        bytes: u64,
        /// Computing time of all squares in s, estimated from smaller squares.
        seconds: f64,
        /// Adhesion force of each profile in N, or its indentation at the preload in m if the scene has no adhesion.
        lines: Vec<f64>,
    },
    /// The computation of a square is finished.
    Square {
        /// Points of the force curve of the square, each with indentation in m and force in N.
        curve: Vec<(f64, f64)>,
        /// Adhesion force of the square in N, or its indentation at the preload in m if the scene has no adhesion.
        headline: f64,
    },
}

/// A random square, and the coarser square that is compared with it.
struct OfSquare {
    fine: Loads,
    coarse: Option<Loads>,
    /// Computing time of the finer square, s.
    seconds: f64,
}

impl Reference {
    /// Returns the comparison of the adhesion force, or of the indentation at the preload if the scene has no adhesion.
    pub fn headline(&self) -> Option<&Compared> {
        self.adhesion_force.as_ref().or(self.loading.last().map(|last| &last.indentation))
    }

    /// Compares the contact of a checked scene on random profiles with its contact on random squares in three dimensions.
    /// `simulation` knows the folder of the measured files of the scene. `jobs` is the number of threads, on which only the
    /// computing times depend. `report` receives each event.
    ///
    /// # Errors
    /// Returns an error if the scene has no body in three dimensions or no preload above zero, if the number of grid cells is
    /// not allowed, or if the memory does not suffice. It is also an error if the squares would take more than a day, or if
    /// `stop` returned true.
    pub fn of(
        scene: &CheckedScene,
        options: ReferenceOptions,
        (mut simulation, jobs): (Simulation, usize),
        stop: &Stop<'_>,
        report: &mut dyn FnMut(ReferenceEvent),
    ) -> Result<Reference, StudyError> {
        if options.maps == 0 || options.lines == 0 {
            return Err(StudyError::refused(None, "no profiles", "at least one"));
        }
        let resolved = Resolved::of(scene, options.cells, &mut simulation)?;
        let (seed, is_random) = (scene.seed().unwrap_or(0), scene.seed().is_some());
        let number = |wanted: u64| if is_random { wanted } else { 1 };
        let options =
            ReferenceOptions { maps: number(options.maps), lines: number(options.lines), ..options };
        let bytes = resolved.body.bytes(options.cells);
        let threads = jobs.clamp(1, usize::try_from(options.maps).unwrap_or(usize::MAX));
        let fits = |threads: &usize| check_room(bytes.saturating_mul(*threads as u64)).is_ok();
        let threads = (1..=threads).rev().find(fits).ok_or_else(|| {
            let found = format!("not enough memory for the {} of a square", memory_size(bytes));
            StudyError::refused(
                Some(&format!("{} cells", options.cells)),
                found,
                "fewer cells along the side",
            )
        })?;

        let begun = Instant::now();
        let own = run(&resolved.line, &mut resolved.simulation(), stop)?;
        let preload = own.figures.preload.filter(|preload| *preload > 0.0).ok_or_else(|| {
            let allowed = "a loading to a force or an indentation before the separation";
            StudyError::refused(None, "the loading has no preload above 0 N", allowed)
        })?;
        let bare = resolved.line.with(|scene| {
            scene.adhesion = None;
            scene.loading = vec![Move::ToForce(preload)];
        });
        let bare = bare.map_err(|errors| of_scene(errors.into()))?;
        let forces = SHARES.map(|share| share * preload);
        let depth =
            own.figures.preload_indentation.unwrap_or(0.0) - own.figures.pull_off_indentation.unwrap_or(0.0);
        let loads = (&forces[..], depth.abs() / STEPS);
        let of_one = seconds_of_square(&resolved.body, (options.cells, seed), loads, &|| stop())?;
        let seconds = of_one * options.maps.div_ceil(threads as u64) as f64;
        check_time(
            (options.cells, options.maps),
            seconds,
            threads as f64 * LONGEST / of_one,
            resolved.body.works.is_some(),
        )?;
        let lines = on_threads(options.lines, jobs, || {
            let mut simulation = resolved.simulation();
            let (resolved, bare) = (&resolved, &bare);
            move |line: u64| {
                let seed = seed.wrapping_add(line);
                let pressed = run(&bare.with_seed(seed), &mut simulation, stop)?;
                let outcome = run(&resolved.line.with_seed(seed), &mut simulation, stop)?;
                Ok::<_, StudyError>((forces.map(|force| at_force(&pressed, force)), outcome))
            }
        })?;
        let of_lines = begun.elapsed().as_secs_f64();

        let stop = || stop();
        let bytes = bytes * threads as u64;
        let is_adhesive = resolved.body.works.is_some();
        let headline = |(points, outcome): &([CurvePoint; SHARES.len()], Outcome)| match is_adhesive {
            true => outcome.figures.adhesion_force,
            false => points.last().map(|point| point.indentation),
        };
        let headlines = lines.iter().filter_map(headline).collect();
        report(ReferenceEvent::Begins { maps: options.maps, threads, bytes, seconds, lines: headlines });
        let begun = Instant::now();
        let body = &resolved.body;
        let worker = |sender: Sender<ReferenceEvent>| {
            move |map: u64| {
                let (begun, seed) = (Instant::now(), seed.wrapping_add(map));
                let fine = body.load((options.cells, seed), loads, &stop)?;
                let seconds = begun.elapsed().as_secs_f64();
                let coarse = match options.cells / 2 {
                    cells if cells >= LEAST_CELLS => Some(body.load((cells, seed), loads, &stop)?),
                    _ => None,
                };
                let pressed =
                    fine.pressings.iter().zip(loads.0).map(|(found, force)| (found.indentation, *force));
                let pulling = fine.pulling.as_ref();
                let curve = pulling.map_or_else(|| pressed.collect(), |pulling| pulling.curve.clone());
                // The receiver lives until all threads have ended.
                let headline = fine.headline().unwrap_or(f64::NAN);
                let _ = sender.send(ReferenceEvent::Square { curve, headline });
                Ok(OfSquare { fine, coarse, seconds })
            }
        };
        let squares = on_threads_received(options.maps, threads, worker, report)?;
        let of_squares = begun.elapsed().as_secs_f64();
        Ok(Reference::gather(options, &resolved, preload, &lines, &squares, [of_lines, of_squares]))
    }

    fn gather(
        options: ReferenceOptions,
        resolved: &Resolved,
        preload: f64,
        lines: &[([CurvePoint; SHARES.len()], Outcome)],
        squares: &[OfSquare],
        seconds: [f64; 2],
    ) -> Reference {
        let modulus = resolved.body.effective_modulus;
        let loading = SHARES.iter().enumerate().filter_map(|(at, share)| {
            let of = |line: &dyn Fn(&CurvePoint) -> f64, square: &dyn Fn(&Pressing) -> f64| {
                compared(
                    lines.iter().map(|(points, _)| line(&points[at])),
                    squares.iter().map(|found| square(&found.fine.pressings[at])),
                )
            };
            Some(Loaded {
                force: share * preload,
                indentation: of(&|point| point.indentation, &|found| found.indentation)?,
                // Without adhesion the stiffness of the springs is E* times their length in contact.
                stiffness: of(&|point| modulus * point.contact_length, &|found| found.stiffness)?,
                area: squares.iter().map(|found| found.fine.pressings[at].area).sum::<f64>()
                    / squares.len() as f64,
            })
        });
        let loading: Vec<Loaded> = loading.collect();
        let of = |line: &dyn Fn(&Outcome) -> Option<f64>, square: &dyn Fn(&Pulling) -> f64| {
            compared(
                lines.iter().filter_map(|(_, outcome)| line(outcome)),
                squares.iter().filter_map(|found| found.fine.pulling.as_ref().map(square)),
            )
        };
        let adhesion_force = of(&|outcome| outcome.figures.adhesion_force, &|found| found.adhesion_force);
        let headline = adhesion_force.or(loading.last().map(|last| last.indentation));
        let budget = budget(headline, squares);
        Reference {
            waves: resolved.waves,
            omitted: resolved.omitted,
            preload,
            adhesion_force,
            first_touch_adhesion_force: of(&|outcome| outcome.first_touch_adhesion_force, &|found| {
                found.at_touch
            }),
            dissipated_energy: of(&|outcome| outcome.figures.dissipated_energy, &|found| {
                found.dissipated_energy
            }),
            loading,
            budget,
            convolutions: squares.iter().map(|found| found.fine.convolutions).sum(),
            seconds,
            seconds_of_square: squares.iter().map(|found| found.seconds).sum::<f64>() / squares.len() as f64,
            options,
        }
    }
}

fn run(scene: &CheckedScene, simulation: &mut Simulation, stop: &Stop<'_>) -> Result<Outcome, StudyError> {
    simulation.run(scene, &|| stop(), &mut |_, _, _| Ok(())).map_err(of_scene)
}

/// Returns the point of a loading without adhesion at a force in N, between the samples of its curve.
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

/// Returns the statistics of both models and the ratio of their means; `None` without values.
pub(super) fn compared(
    line: impl Iterator<Item = f64>,
    square: impl Iterator<Item = f64>,
) -> Option<Compared> {
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

fn budget(headline: Option<Compared>, squares: &[OfSquare]) -> ReferenceBudget {
    let of = |found: &OfSquare| found.coarse.as_ref()?.headline().zip(found.fine.headline());
    let both: Option<Vec<(f64, f64)>> = squares.iter().map(of).collect();
    let grid = both.and_then(|both| {
        let (coarse, fine) = both.iter().fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        Some((coarse / fine - 1.0).abs()).filter(|share| share.is_finite())
    });
    let solver = squares.iter().flat_map(|found| &found.fine.pressings).map(|found| found.residual);
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
    use asperity_scene::{Roughness, open};

    fn reference(
        scene: &CheckedScene,
        cells: usize,
        maps: u64,
        jobs: usize,
    ) -> Result<Reference, StudyError> {
        let options = ReferenceOptions { cells, maps, lines: 16 * maps };
        Reference::of(scene, options, (Simulation::default(), jobs), &|| false, &mut |_| ())
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
        let (seconds, seconds_of_square) = (found.seconds, found.seconds_of_square);
        let same = Reference { seconds, seconds_of_square, ..reference(scene.scene(), 64, 2, 1).unwrap() };
        assert_eq!(same, found);
        assert!(found.budget.solver <= 1e-8 && found.budget.grid.is_some() && found.budget.sample.is_some());
    }

    /// A row of the table of docs/line-and-three-dimensions.md agrees with fewer squares, within the intervals of both.
    #[test]
    fn the_table_of_the_page_is_that_of_the_squares() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/");
        let page = std::fs::read_to_string(format!("{root}line-and-three-dimensions.md")).unwrap();
        let row = page.lines().find(|line| line.starts_with("| 0.8 | 1.0 |")).unwrap();
        let stated: Vec<(f64, f64)> = row
            .split('|')
            .filter_map(|cell| cell.split_once(" ± "))
            .map(|(ratio, error)| (ratio.trim().parse().unwrap(), error.trim().parse().unwrap()))
            .collect();
        let document = open(&format!("{root}examples/rough-square.ron")).unwrap();
        let found = reference(document.scene(), 64, 3, 2).unwrap();
        let last = found.loading.last().unwrap().indentation;
        let pulled = [found.adhesion_force, found.first_touch_adhesion_force, found.dissipated_energy]
            .map(Option::unwrap);
        assert_eq!(stated.len(), 4);
        for ((ratio, error), found) in stated.into_iter().zip(pulled.into_iter().chain([last])) {
            let off = (found.ratio - ratio).abs();
            assert!(off < error.hypot(found.error.unwrap()), "{ratio} ± {error}: {found:?}");
            // Three squares scatter more than twelve, but no number is another one by a factor of two.
            assert!((0.5..2.0).contains(&(found.ratio / ratio)), "{ratio}: {found:?}");
        }
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
