//! Comparison of random profiles with random square surfaces in three dimensions that have the same
//! spectrum.
//!
//! A free rigid square surface of the side L on an elastic half-space is compared with a profile of
//! the length L. No constant is fitted. The heights of square surface and profile are drawn
//! independently, so only means over many square surfaces and many profiles are compared. At the
//! same force the contact area of the profile model is 1.1 to 4.2 times the contact area in three
//! dimensions.

use super::compared::Compared;
use super::ensemble::Ensemble;
use super::reference_budget::ReferenceBudget;
use super::shells::ComparedRoughness;
use asperity_contact::Move;
use asperity_data::CountedWarning;
use asperity_scene::Scene;
use serde::Serialize;

/// Options of a [`Reference`], which compares random profiles with random square surfaces in three
/// dimensions. They state how many profiles, square surfaces and grid cells are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ReferenceOptions {
    /// Number of grid cells along the side of a square surface, a power of two.
    pub cells: usize,
    /// Number of random square surfaces in three dimensions.
    pub surfaces: u64,
    /// Number of random profiles, the one-dimensional model of the surfaces.
    pub profiles: u64,
}

/// Number of random profiles for each square surface. A profile takes about a thousandth of the
/// computing time of a square surface.
const PROFILES_PER_SURFACE: u64 = 16;

impl ReferenceOptions {
    /// Returns the usual options for a scene: 64 grid cells along the side of a square surface, and
    /// 16 random profiles for each square surface. `surfaces` is the number of square surfaces.
    /// `None` means 12 square surfaces for a scene with adhesion, and 24 without adhesion.
    pub fn of(scene: &Scene, surfaces: Option<u64>) -> ReferenceOptions {
        let surfaces = surfaces.unwrap_or(if scene.adhesion.is_some() { 12 } else { 24 });
        ReferenceOptions {
            cells: 64,
            surfaces,
            profiles: PROFILES_PER_SURFACE * surfaces,
        }
    }
}

/// Comparison of random profiles with random square surfaces in three dimensions at one force,
/// without adhesion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Loaded {
    /// Force in N on each profile and on each square surface.
    pub force: f64,
    /// Indentation in m at this force, counted from first touch.
    pub indentation: Compared,
    /// Stiffness of the contact in N/m at this force: the change of force divided by the change of
    /// indentation.
    pub stiffness: Compared,
    /// Mean contact area of the square surfaces at this force in m².
    pub area: f64,
    /// Mean number of grid cells of a square surface that are in contact at this force.
    pub cells: f64,
}

impl Loaded {
    /// Profiles and square surfaces are compared at a force only if at least this number of grid
    /// cells of a square surface are in contact, as a mean over the square surfaces.
    pub const LEAST_CELLS: f64 = 20.0;

    /// Returns the relative error that the grid of the square surfaces causes in the indentation or
    /// in the stiffness, whichever error is larger. `None` if one of these errors is unknown.
    pub fn grid(&self) -> Option<f64> {
        Some(self.indentation.grid?.max(self.stiffness.grid?))
    }
}

/// Force at which profiles and square surfaces are not compared because too few grid cells of the
/// square surfaces are in contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Force on each square surface in N.
    pub force: f64,
    /// Mean number of grid cells of a square surface in contact. It is less than the number
    /// [`Loaded::LEAST_CELLS`] that a comparison needs.
    pub cells: f64,
    /// Number of grid cells along the side of a square surface that would bring enough cells into
    /// contact. `None` if the solver does not allow so many cells.
    pub grid: Option<usize>,
}

/// Roughness of the profiles and of the square surfaces that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RoughnessOfBoth {
    /// Roughness of the profiles.
    pub line: ComparedRoughness,
    /// Roughness of the square surfaces in the contacts without adhesion. The square surfaces have
    /// the same rms height as the profiles.
    pub half_space: ComparedRoughness,
    /// Roughness of the square surfaces in the contacts with adhesion. The square surfaces have the
    /// same elastic energy as the profiles. `None` for a scene without adhesion.
    pub adhesive_half_space: Option<ComparedRoughness>,
}

/// Comparison of a scene on random profiles with the same scene on random square surfaces in three
/// dimensions. A square surface is a rigid rough body with a square base of the side L, pressed on
/// an elastic half-space.
///
/// A profile and a square surface are loaded in the same way: from separation to the same force or
/// indentation, and back to separation. If the loading of the scene has several such loops, only
/// the last loop is compared. Its turning point is the end of the stage with the largest force.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Numbers of profiles, square surfaces and grid cells with which the comparison was computed.
    #[serde(flatten)]
    pub options: ReferenceOptions,
    /// Longest and shortest wave of the roughness on profiles and square surfaces. Each wave is
    /// given as the number of its periods over the length L. `None` for a smooth body.
    pub waves: Option<(u64, u64)>,
    /// Shortest wave of the scene, given as its number of periods over the length L, if the
    /// comparison omits this wave because the grid of the square surfaces is too coarse. `None` if
    /// no wave is omitted.
    pub omitted: Option<u64>,
    /// Roughness of profiles and square surfaces; `None` for a smooth body.
    pub roughness: Option<RoughnessOfBoth>,
    /// Work of adhesion on opening in J/m², the same for profiles and square surfaces; `None`
    /// without adhesion.
    pub work_of_adhesion: Option<f64>,
    /// Loop in which profiles and square surfaces are compared, as its two stages: loading to the
    /// turning point, and separation.
    pub compared_loading: [Move; 2],
    /// Force in N at the turning point of the loop. If the loop turns at a given indentation or at
    /// a given displacement of the instrument, this is the mean force on the profiles at the
    /// turning point.
    pub preload: f64,
    /// Comparison without adhesion at several forces, from a hundredth of [`Reference::preload`] to
    /// the preload. Forces at which fewer than [`Loaded::LEAST_CELLS`] grid cells of a square
    /// surface are in contact are left out.
    pub loading: Vec<Loaded>,
    /// Forces that are left out of [`Reference::loading`], because fewer than
    /// [`Loaded::LEAST_CELLS`] grid cells of a square surface are in contact.
    pub left_out: Vec<LeftOut>,
    /// Comparison of the pull-off force F_a in N after the preload; `None` for a scene without
    /// adhesion.
    pub pull_off_force: Option<Compared>,
    /// Comparison of the pull-off force F_a(d=0) in N of a loop that turns at first touch; `None`
    /// for a scene without adhesion.
    pub first_touch_pull_off_force: Option<Compared>,
    /// Comparison of the energy in J that the contact loses in the loop to the preload and back;
    /// `None` for a scene without adhesion.
    pub dissipated_energy: Option<Compared>,
    /// True for a smooth body of revolution, for which the method of dimensionality reduction is
    /// exact. Every difference between profile and square surface is then an error of the square
    /// surface.
    pub line_is_exact: bool,
    /// Errors of the comparison, one for each source of errors. They are errors of the pull-off
    /// force, or of the indentation at the preload for a scene without adhesion.
    pub budget: ReferenceBudget,
    /// Premises of the model that profiles of the scene do not meet, each with the number of
    /// profiles that do not meet it. Only the first [`Reference::profiles_for_warnings`] profiles
    /// are checked.
    #[serde(skip)]
    pub warnings: Vec<CountedWarning>,
    /// Number of convolutions that the solver computed for all square surfaces together, as a
    /// measure of the computing work. A convolution extends over all grid cells of a square
    /// surface. Computations on the coarser grid, which show the error of the grid, are not
    /// counted.
    pub convolutions: u64,
    /// Computing times in s: first the time of all profiles together, then the time of all square
    /// surfaces together.
    pub seconds: [f64; 2],
    /// Mean computing time of one square surface in s. The computation of the same surface on the
    /// coarser grid is not included.
    pub seconds_of_square: f64,
}

/// Event that [`Reference::of`] reports while it compares profiles with square surfaces.
#[derive(Clone, Debug)]
pub enum ReferenceEvent {
    /// The computation of the profiles begins. Memory and computing time of the square surfaces are
    /// estimated.
    Begins {
        /// Number of square surfaces. It is 1 for a body without random roughness.
        surfaces: u64,
        /// Number of threads that share the square surfaces.
        threads: usize,
        /// Memory in bytes that all threads need together.
        bytes: u64,
        /// Computing time of all square surfaces in s, estimated from surfaces with fewer grid
        /// cells.
        seconds: f64,
    },
    /// Some more profiles are computed, about a hundredth of all profiles.
    Profiles {
        /// Number of profiles computed since the last event of this kind.
        count: u64,
        /// Total number of computations of profiles. A profile counts twice if it is computed both
        /// in the loop with adhesion and in a loading without adhesion.
        lines: u64,
    },
    /// All profiles are computed, and the computation of the square surfaces begins.
    ProfilesEnd {
        /// Pull-off force of each profile in N, or its indentation at the preload in m if the scene
        /// has no adhesion.
        lines: Vec<f64>,
    },
    /// The contact of a square surface has been computed at one more force or indentation.
    Loaded {
        /// Share of this computation in the work on all square surfaces, from 0 to 1. It is
        /// estimated from surfaces with fewer grid cells.
        share: f64,
    },
    /// The computation of a square surface is finished.
    Square {
        /// Points of the force curve of the square surface, each with indentation in m and force in
        /// N.
        curve: Vec<(f64, f64)>,
        /// Pull-off force of the square surface in N, or its indentation at the preload in m if the
        /// scene has no adhesion.
        headline: f64,
    },
}

impl Reference {
    /// Returns the number of profiles on which the premises of the model were checked. These are
    /// the first profiles of the comparison, at most [`Ensemble::PROFILES`].
    pub fn profiles_for_warnings(&self) -> u64 {
        self.options.profiles.min(Ensemble::PROFILES)
    }

    /// Returns the comparison of the pull-off force, or of the indentation at the preload if the
    /// scene has no adhesion. `None` if the scene has no adhesion and no force is compared, because
    /// too few grid cells are in contact.
    pub fn headline(&self) -> Option<&Compared> {
        self.pull_off_force
            .as_ref()
            .or(self.loading.last().map(|last| &last.indentation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::StudyError;
    use asperity_data::Control;
    use asperity_scene::{CheckedScene, Document, Roughness, Simulation, open};

    const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/");

    fn reference(
        scene: &CheckedScene,
        cells: usize,
        surfaces: u64,
        jobs: usize,
    ) -> Result<Reference, StudyError> {
        let options = ReferenceOptions {
            cells,
            surfaces,
            profiles: 16 * surfaces,
        };
        let control = Control::default().on_threads(jobs);
        Reference::of(scene, options, &mut Simulation::default(), control)
    }

    /// Returns a scene with a rough square that has only the modes 1 to 4, which a coarse grid
    /// resolves.
    fn coarse_square() -> Document {
        let document = open(&format!("{DOCS}examples/rough-square.ron")).unwrap();
        document.set("roughness.modes", "(1, 4)").unwrap()
    }

    /// Compares one coarse square with profiles under another loading. The computing times are set
    /// to zero.
    fn with_loading(document: &Document, loading: &str) -> Reference {
        let document = document.set("loading", loading).unwrap();
        let found = reference(document.scene(), 32, 1, 1).unwrap();
        Reference {
            seconds: [0.0; 2],
            seconds_of_square: 0.0,
            ..found
        }
    }

    /// For a sphere the profile is exact. Both models therefore agree within the error of the grid,
    /// and this error is stated.
    #[test]
    fn a_sphere_is_the_same_in_both_models() {
        let scene = open("jkr-sphere").unwrap();
        let found = reference(scene.scene(), 64, 3, 1).unwrap();
        assert_eq!(
            (found.options.surfaces, found.options.profiles, found.waves),
            (1, 1, None)
        );
        assert!(found.loading.len() >= 3, "{:?}", found.left_out);
        for loaded in &found.loading {
            for compared in [loaded.indentation, loaded.stiffness] {
                assert!(
                    compared.difference().abs() < compared.grid.unwrap() + 0.03,
                    "{loaded:?}"
                );
            }
        }
        let last = found.loading.last().unwrap();
        assert!(last.indentation.difference().abs() < 0.01, "{last:?}");
        assert!(last.stiffness.difference().abs() < 0.03, "{last:?}");
        let force = found.pull_off_force.unwrap();
        assert!((force.ratio - 1.0).abs() < 0.15, "{force:?}");
        let budget = found.budget;
        assert!(found.line_is_exact && found.roughness.is_none());
        assert_eq!(
            (budget.model, budget.sample, budget.largest),
            (Some(0.0), None, "grid")
        );
        assert!(budget.grid >= Some((force.ratio - 1.0).abs()), "{budget:?}");
    }

    /// The profile model is not exact for a flat square, nor for a sphere with steep waves.
    #[test]
    fn only_the_line_of_a_rising_body_is_exact() {
        let sphere = open("jkr-sphere").unwrap();
        let steep = sphere.set(
            "form",
            "WavySphere(radius: 1.0e-4, amplitude: 1.0e-7, wavelength: 1.0e-6)",
        );
        let cut = sphere
            .set("loading", "[ToForce(10.0), ToSeparation]")
            .unwrap();
        let cut = cut.set("length", "1.0e-6");
        let flat = sphere.set("form", "None");
        for document in [steep, cut, flat] {
            let document = document.unwrap();
            let found = reference(document.scene(), 32, 1, 1);
            assert!(
                found.is_err() || !found.unwrap().line_is_exact,
                "{:?}",
                document.scene()
            );
        }
    }

    /// For a rough body, the stiffness of profiles is close to the stiffness of square surfaces,
    /// but not equal. Nothing except the computing times depends on the number of threads.
    #[test]
    fn a_rough_body_is_compared_in_the_mean() {
        let scene = open("pressure-sensitive").unwrap();
        let found = reference(scene.scene(), 64, 2, 2).unwrap();
        assert_eq!((found.waves, found.omitted), (Some((4, 8)), Some(512)));
        for loaded in &found.loading {
            // With only two squares the stiffness scatters by about half its value.
            assert!((0.4..2.5).contains(&loaded.stiffness.ratio), "{loaded:?}");
            assert!(
                loaded.cells >= Loaded::LEAST_CELLS && loaded.grid().is_some(),
                "{loaded:?}"
            );
        }
        assert_eq!(found.loading.len() + found.left_out.len(), 6);
        for left_out in &found.left_out {
            assert!(
                left_out.cells < Loaded::LEAST_CELLS && left_out.grid > Some(64),
                "{left_out:?}"
            );
        }
        let (seconds, seconds_of_square) = (found.seconds, found.seconds_of_square);
        let same = Reference {
            seconds,
            seconds_of_square,
            ..reference(scene.scene(), 64, 2, 1).unwrap()
        };
        assert_eq!(same, found);
        assert!(
            found.budget.solver <= 1e-8
                && found.budget.grid.is_some()
                && found.budget.sample.is_some()
        );
        // In contacts without adhesion the square surfaces have the same rms height as the
        // profiles, and in contacts with adhesion the same elastic energy.
        let roughness = found.roughness.unwrap();
        let line = roughness.line;
        assert!(
            (roughness.half_space.rms_height / line.rms_height - 1.0).abs() < 1e-12,
            "{roughness:?}"
        );
        let adhesive = roughness.adhesive_half_space.unwrap();
        assert!(
            (adhesive.elastic_energy / line.elastic_energy - 1.0).abs() < 1e-12,
            "{roughness:?}"
        );
        assert!(
            (adhesive.rms_height / line.rms_height - 1.0).abs() < 0.035,
            "{roughness:?}"
        );
    }

    /// Only the last loop of the loading is compared. It begins in separation and ends in
    /// separation.
    #[test]
    fn the_last_loop_is_compared() {
        let square = coarse_square();
        let alone = with_loading(&square, "[ToForce(3.0e-5), ToSeparation]");
        assert_eq!(
            alone.compared_loading,
            [Move::ToForce(3.0e-5), Move::ToSeparation]
        );
        for loading in [
            "[ToForce(3.0e-5), ToSeparation, ToForce(3.0e-5), ToSeparation]",
            "[ToForce(9.0e-5), ToSeparation, ToForce(3.0e-5), ToSeparation]",
            "[ToForce(3.0e-5)]",
            "[ToTouch, ToForce(1.0e-5), ToForce(3.0e-5), ToForce(1.0e-5), ToForce(2.0e-5), ToSeparation]",
        ] {
            assert_eq!(with_loading(&square, loading), alone, "{loading}");
        }
        let smaller = with_loading(&square, "[ToForce(1.0e-5), ToSeparation]");
        let [loss, less] = [alone, smaller]
            .map(|found| found.dissipated_energy.map(|energy| energy.half_space.mean));
        assert!(less < loss, "{less:?} {loss:?}");
    }

    /// Square surfaces and profiles turn at the same indentation, even if their forces there
    /// differ.
    #[test]
    fn an_indentation_is_the_same_for_all() {
        let document = coarse_square()
            .set("adhesion.elastic_energy_ratio", "6.0")
            .unwrap();
        let turn = 1.5e-6;
        let mut found = Vec::new();
        for (stage, stiffness) in [("ToIndentation", "None"), ("ToDisplacement", "Some(1e12)")] {
            let document = document
                .set("loading", &format!("[{stage}({turn:e}), ToSeparation]"))
                .unwrap();
            let document = document.set("loading_stiffness", stiffness).unwrap();
            let mut deepest = Vec::new();
            let mut report = |event: &ReferenceEvent| {
                if let ReferenceEvent::Square { curve, .. } = event {
                    deepest.push(curve.iter().map(|point| point.0).fold(0.0, f64::max));
                }
            };
            let options = ReferenceOptions {
                cells: 32,
                surfaces: 3,
                profiles: 48,
            };
            let control = Control::default().on_threads(1).reporting_to(&mut report);
            let reference = Reference::of(
                document.scene(),
                options,
                &mut Simulation::default(),
                control,
            )
            .unwrap();
            assert_eq!(deepest.len(), 3);
            assert!(
                deepest
                    .iter()
                    .all(|deepest| (deepest / turn - 1.0).abs() < 0.02),
                "{deepest:?}"
            );
            if stage == "ToIndentation" {
                assert!(
                    deepest
                        .iter()
                        .all(|deepest| (deepest / turn - 1.0).abs() < 1e-8),
                    "{deepest:?}"
                );
            }
            let last = reference.loading.last().unwrap();
            assert_eq!(last.force, reference.preload);
            found.push(reference);
        }
        // With a very stiff instrument the displacement of the drive is equal to the indentation.
        let [indentation, displacement] = <[_; 2]>::try_from(found).unwrap();
        assert!((indentation.preload / displacement.preload - 1.0).abs() < 1e-3);
        let energy = |found: &Reference| found.dissipated_energy.unwrap();
        let line = energy(&indentation).line.mean / energy(&displacement).line.mean;
        assert!((line - 1.0).abs() < 1e-3, "{line}");
    }

    /// Profiles are computed exactly at the forces of the comparison, so the number of samples of
    /// the force curve has no influence.
    #[test]
    fn samples_of_the_curve_change_nothing() {
        let document = coarse_square().set("numerics.samples", "2").unwrap();
        let few = reference(document.scene(), 32, 1, 1).unwrap();
        let many = reference(coarse_square().scene(), 32, 1, 1).unwrap();
        assert_eq!(
            (few.loading, few.pull_off_force),
            (many.loading, many.pull_off_force)
        );
        assert_eq!(few.dissipated_energy, many.dissipated_energy);
    }

    #[test]
    fn contacts_of_a_few_cells_are_left_out() {
        let light = with_loading(&coarse_square(), "[ToForce(1.0e-9), ToSeparation]");
        assert!(
            light.loading.is_empty() && light.left_out.len() == 6,
            "{light:?}"
        );
        assert!(
            light.pull_off_force.is_some() && light.left_out[5].cells < 4.0,
            "{:?}",
            light.left_out
        );
        assert_eq!(light.left_out[0].grid, Some(256), "{:?}", light.left_out);
        let bare = coarse_square().set("adhesion", "None").unwrap();
        let bare = bare.set("loading", "[ToForce(1.0e-9)]").unwrap();
        let refused = reference(bare.scene(), 32, 1, 1).unwrap_err().to_string();
        let expected =
            "32 cells: at the preload 1 cells of a square are in contact; allowed: at least 20";
        assert!(refused.starts_with(expected), "{refused}");
        assert!(
            refused.ends_with("by a larger preload or 256 cells along the side"),
            "{refused}"
        );
    }

    /// A comparison with three squares agrees with a row of the table in
    /// docs/three-dimensions.md within the confidence intervals of both.
    #[test]
    fn the_table_of_the_page_is_that_of_the_squares() {
        let page = std::fs::read_to_string(format!("{DOCS}three-dimensions.md")).unwrap();
        let row = page
            .lines()
            .find(|line| line.starts_with("| 0.8 | 0.3 |"))
            .unwrap();
        let stated: Vec<(f64, f64)> = row
            .split('|')
            .filter_map(|cell| cell.split_once(" ± "))
            .map(|(ratio, error)| (ratio.trim().parse().unwrap(), error.trim().parse().unwrap()))
            .collect();
        let document = open(&format!("{DOCS}examples/rough-square.ron")).unwrap();
        let document = document
            .set("adhesion.elastic_energy_ratio", "0.3")
            .unwrap();
        let found = reference(document.scene(), 64, 3, 2).unwrap();
        let last = found.loading.last().unwrap().indentation;
        let pulled = [
            found.pull_off_force,
            found.first_touch_pull_off_force,
            found.dissipated_energy,
        ]
        .map(Option::unwrap);
        assert_eq!(stated.len(), 4);
        for ((ratio, error), found) in stated.into_iter().zip(pulled.into_iter().chain([last])) {
            let off = (found.ratio - ratio).abs();
            assert!(
                off < error.hypot(found.error.unwrap()),
                "{ratio} ± {error}: {found:?}"
            );
            // Three squares scatter more than twelve, but no ratio differs by more than a factor of
            // two.
            assert!(
                (0.5..2.0).contains(&(found.ratio / ratio)),
                "{ratio}: {found:?}"
            );
        }
    }

    #[test]
    fn what_has_no_square_is_refused() {
        let scene = open("pressure-sensitive").unwrap();
        let refused =
            |scene: &CheckedScene, cells| reference(scene, cells, 1, 1).unwrap_err().to_string();
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
        assert!(
            error.contains("at least 128 cells along the side"),
            "{error}"
        );
        let loadings = [
            vec![Move::ToTouch, Move::ToSeparation],
            vec![Move::ToZeroForce, Move::ToSeparation],
            vec![Move::ToIndentation(-1e-9), Move::ToSeparation],
        ];
        for loading in loadings {
            let touch = scene.scene().with(|scene| scene.loading = loading).unwrap();
            assert!(
                refused(&touch, 64).starts_with("the loading has no preload"),
                "{}",
                refused(&touch, 64)
            );
        }
    }
}
