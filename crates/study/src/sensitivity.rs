//! The sensitivity of the results of a scene: how the medians over random profiles change when each
//! number of the scene changes by a tenth.

use super::axis::{Axis, Shapes, Spacing};
use super::cells::Streak;
use super::coordinates::Allowed;
use super::ensemble::Ensemble;
use super::error::StudyError;
use super::place::{numbers, scene_with};
use super::plan::Plan;
use super::premises::warnings_on_profiles;
use super::profiles::{Stop, on_profiles};
use super::quantity::Quantity;
use super::recorder::with_recorder;
use asperity_data::{Control, CountedWarning, median};
use asperity_scene::{CheckedScene, RunError, Scene, SceneErrors, Simulation};
use std::cmp::Reverse;

/// Values of the results in SI units, in the order of [`Sensitivity::RESULTS`]; `None` for a result
/// that the scene does not have.
type Values = [Option<f64>; 3];

/// Results of a scene in which one number is changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Changed {
    /// Medians of the results over the random profiles in SI units, in the order of
    /// [`Sensitivity::RESULTS`].
    pub medians: Values,
    /// Range over the profiles of the relative change of each result. Each element is the smallest
    /// and the largest change of one result, in the order of [`Sensitivity::RESULTS`]. `None` if
    /// the profile of the scene is fixed.
    pub range: [Option<(f64, f64)>; 3],
}

/// Influence of one number of a scene: the results for a smaller and for a larger value of this
/// number.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Path, name and unit of the number. The axis has no values.
    pub axis: Axis,
    /// Value of the number in the unchanged scene, in the SI unit of [`Influence::axis`]. A
    /// wavelength is rounded so that a whole number of waves fits on the length, as in the computed
    /// profile.
    pub value: f64,
    /// Smaller and larger value of the number, each with the results for this value. The results
    /// are `None` if the scene does not allow the value. The values usually differ from
    /// [`Influence::value`] by the share [`Sensitivity::STEP`]. A wavelength or a whole number may
    /// differ by another share.
    pub sides: [(f64, Option<Changed>); 2],
}

impl Influence {
    /// Returns the change of the number of the scene, divided by the magnitude of its unchanged
    /// value. `side` is 0 for the smaller value and 1 for the larger value.
    pub fn step(&self, side: usize) -> f64 {
        (self.sides[side].0 - self.value) / self.value.abs()
    }
}

/// Sensitivity of the results of a scene to its numbers. Each number of the scene is changed by a
/// tenth in turn, and the results are computed again.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Number of random profiles computed so far. The first profile has the seed of the scene.
    pub profiles: u64,
    /// Medians of the results of the unchanged scene over the profiles, in SI units and in the
    /// order of [`Sensitivity::RESULTS`].
    pub present: Values,
    /// Smallest and largest results of the unchanged scene among the profiles, in SI units: first
    /// all smallest values, then all largest values, both in the order of [`Sensitivity::RESULTS`].
    /// `None` if the profile of the scene is fixed.
    pub range: Option<[Values; 2]>,
    /// Results for changes of each number of the scene. Numbers that are zero, and counts such as
    /// the number of springs, are left out.
    pub influences: Vec<Influence>,
    /// Premises of the model that the unchanged scene does not meet, each with the number of
    /// profiles that do not meet it. The list is empty until all profiles are computed.
    pub warnings: Vec<CountedWarning>,
}

/// Results on one profile for each scene in [`Neighbourhood::variants`]; NaN for a missing result.
type Solved = Vec<[f64; 3]>;

/// Plan (without axes) of the unchanged scene, or of the scene with one changed number.
struct Variant {
    plan: Plan,
    shapes: Shapes,
    is_changed: bool,
}

/// A scene, and all scenes that differ from it in one number.
struct Neighbourhood {
    /// Numbers of the scene. Their results are filled in after all variants are computed.
    influences: Vec<Influence>,
    /// The unchanged scene, followed by each changed scene that is allowed, in the order of
    /// `influences`.
    variants: Vec<Variant>,
    /// Indices of the variants in the order in which they are computed on a profile.
    order: Vec<usize>,
}

impl Sensitivity {
    /// Relative change by which each number of the scene is made smaller and larger. A whole number
    /// changes by at least 1. A wavelength changes so much that the number of waves on the length
    /// changes by at least one. [`Influence::step`] returns the actual change.
    pub const STEP: f64 = 0.1;

    /// Results whose changes are computed: the pull-off force F_a, the pull-off force F_a(d=0)
    /// after first touch, and the dissipated energy.
    pub const RESULTS: [Quantity; 3] = [
        Quantity::PullOffForce,
        Quantity::FirstTouchPullOffForce,
        Quantity::DissipatedEnergy,
    ];

    /// Computes a checked scene, and the scenes with one of its numbers changed, on the same random
    /// profiles. The number of profiles is the usual one, [`Ensemble::profiles_of`]. A scene that
    /// states the roughness parameter κ instead of a work of adhesion keeps κ when another number
    /// changes. If the length changes, the same numbers of waves fit on it, so the wavelengths
    /// change in proportion.
    ///
    /// `control` reports the sensitivity over the profiles computed so far after each profile.
    ///
    /// # Errors
    /// Returns an error if zero threads are requested, if a profile or its contact cannot be
    /// computed, or if `control` stops the computation.
    ///
    /// ```
    /// use asperity_data::Control;
    /// use asperity_scene::{Simulation, open};
    /// use asperity_study::Sensitivity;
    ///
    /// // F_a = (3/2)πγR of a sphere is in proportion to γ.
    /// let scene = open("jkr-sphere")?.set("numerics.points", "1024")?;
    /// let simulation = &mut Simulation::default();
    /// let found = Sensitivity::of(scene.scene(), simulation, Control::default())?;
    /// let work = found
    ///     .influences
    ///     .iter()
    ///     .find(|influence| influence.axis.path == "adhesion.work")
    ///     .ok_or("no work")?;
    /// let larger = work.sides[1].1.ok_or("refused")?.medians[0].ok_or("no force")?;
    /// assert!((larger / found.present[0].ok_or("no force")? - 1.1).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        scene: &CheckedScene,
        simulation: &mut Simulation,
        mut control: Control<'_, Sensitivity>,
    ) -> Result<Sensitivity, StudyError> {
        StudyError::check_threads(control.threads())?;
        let profiles = Ensemble::profiles_of(scene);
        let neighbourhood = Neighbourhood::of(scene, profiles);
        let mut sensitivity = Sensitivity {
            profiles: 0,
            present: [None; 3],
            range: None,
            influences: neighbourhood.influences.clone(),
            warnings: Vec::new(),
        };
        let stop = control.stop();
        let mut solved = vec![None; profiles as usize];
        let lines: Vec<u64> = (0..profiles).collect();
        on_profiles(
            &neighbourhood.variants[0].plan,
            &lines,
            simulation,
            control.threads(),
            |simulation, line| neighbourhood.solve(simulation, line, stop),
            &mut |line, results| {
                solved[line as usize] = Some(results);
                let known: Vec<&Solved> = solved.iter().flatten().collect();
                sensitivity.summarise(&known);
                control.report(&sensitivity);
            },
        )?;
        let control = control.of_part();
        sensitivity.warnings = warnings_on_profiles(scene, profiles, simulation, control)?;
        Ok(sensitivity)
    }

    /// Sets the medians and ranges of all results. `profiles` has the results on each computed
    /// profile.
    fn summarise(&mut self, profiles: &[&Solved]) {
        let several = profiles.len() > 1;
        self.profiles = profiles.len() as u64;
        self.present = medians(profiles, 0);
        self.range = None;
        if several {
            let smallest = RESULTS.map(|result| values(profiles, 0, result).reduce(f64::min));
            let largest = RESULTS.map(|result| values(profiles, 0, result).reduce(f64::max));
            self.range = Some([smallest, largest]);
        }
        let mut variant = 0;
        for influence in &mut self.influences {
            for (_, changed) in &mut influence.sides {
                let Some(changed) = changed else { continue };
                variant += 1;
                changed.medians = medians(profiles, variant);
                changed.range = [None; 3];
                if several {
                    changed.range =
                        RESULTS.map(|result| range_of_change(profiles, variant, result));
                }
            }
        }
    }

    /// Returns the relative change of each result from the unchanged scene
    /// ([`Sensitivity::present`]) to `values`. A change is `None` if a value is missing, or if the
    /// result of the unchanged scene is zero.
    pub fn changes(&self, values: &Values) -> Values {
        RESULTS.map(|result| {
            let present = self.present[result].filter(|present| *present != 0.0)?;
            Some(values[result]? / present - 1.0)
        })
    }

    /// Returns a sentence with the reason why no changes of the pull-off force are known; `None` if
    /// the scene has a pull-off force.
    pub fn missing(&self) -> Option<&'static str> {
        let is_known = self.present[0].is_some_and(|force| force != 0.0);
        (!is_known).then_some(
            "The scene has no pull-off: there is no pull-off force that a number could change.",
        )
    }

    /// Returns the numbers of the scene sorted by the relative change that they cause in one
    /// result, the largest change first. `result` is the index of the result in
    /// [`Sensitivity::RESULTS`].
    pub fn ordered(&self, result: usize) -> Vec<&Influence> {
        let mut ordered: Vec<&Influence> = self.influences.iter().collect();
        ordered.sort_by(|first, second| {
            let change = self.largest_change(first, result);
            self.largest_change(second, result).total_cmp(&change)
        });
        ordered
    }

    /// Returns the larger of two relative changes of a result, without their signs: the changes for
    /// the smaller and for the larger value of the number. Returns 0 if neither change is known.
    fn largest_change(&self, influence: &Influence, result: usize) -> f64 {
        let mut largest: f64 = 0.0;
        for (_, changed) in &influence.sides {
            let Some(changed) = changed else { continue };
            if let Some(change) = self.changes(&changed.medians)[result] {
                largest = largest.max(change.abs());
            }
        }
        largest
    }
}

impl Neighbourhood {
    fn of(scene: &CheckedScene, profiles: u64) -> Neighbourhood {
        let mut variants = vec![Variant {
            plan: Plan::of_scene(scene, profiles, &Sensitivity::RESULTS),
            shapes: Shapes::Passes,
            is_changed: false,
        }];
        let mut influences = Vec::new();
        for (axis, value) in numbers(scene) {
            let value = computed(Allowed::of(&axis, scene), value);
            let sides = [-1.0, 1.0].map(|sign| {
                let (number, neighbour) = changed(scene, &axis, value, sign);
                let Some(neighbour) = neighbour else {
                    return (number, None);
                };
                variants.push(Variant {
                    plan: Plan::of_scene(&neighbour, profiles, &Sensitivity::RESULTS),
                    shapes: axis.target.shapes(),
                    is_changed: true,
                });
                (number, Some(Changed::default()))
            });
            influences.push(Influence { axis, value, sides });
        }
        // The variants with the profile of the unchanged scene are computed first, so that this
        // profile is made only once.
        let mut order: Vec<usize> = (0..variants.len()).collect();
        order.sort_by_key(|index| Reverse(variants[*index].shapes));
        Neighbourhood {
            influences,
            variants,
            order,
        }
    }

    /// Computes all variants on the profile with the index `line`.
    fn solve(
        &self,
        simulation: &mut Simulation,
        line: u64,
        stop: &Stop<'_>,
    ) -> Result<Solved, RunError> {
        let mut solved = vec![[f64::NAN; 3]; self.variants.len()];
        for &index in &self.order {
            if let Some(results) = self.variants[index].solve(simulation, line, stop)? {
                solved[index] = results;
            }
        }
        Ok(solved)
    }
}

impl Variant {
    /// Computes the results on the profile with the index `line`; `None` for a changed scene that
    /// cannot be computed on this profile.
    ///
    /// # Errors
    /// Returns an error if the unchanged scene cannot be computed, or if `stop` returned true.
    fn solve(
        &self,
        simulation: &mut Simulation,
        line: u64,
        stop: &Stop<'_>,
    ) -> Result<Option<[f64; 3]>, RunError> {
        let streak = Streak { cells: 0..1, line };
        let records = with_recorder(&self.plan, simulation, stop, |recorder| {
            if !self.is_changed {
                return recorder.record(&streak);
            }
            let records = recorder.record_each(&streak)?;
            Ok(records.into_iter().flatten().collect())
        })?;
        Ok(records.concat().try_into().ok())
    }
}

/// Indices of the results in [`Sensitivity::RESULTS`].
const RESULTS: [usize; 3] = [0, 1, 2];

/// Returns the values of a result of a variant. Profiles without a value are left out.
fn values(profiles: &[&Solved], variant: usize, result: usize) -> impl Iterator<Item = f64> {
    profiles
        .iter()
        .map(move |solved| solved[variant][result])
        .filter(|value| !value.is_nan())
}

fn medians(profiles: &[&Solved], variant: usize) -> Values {
    RESULTS.map(|result| {
        let mut values: Vec<f64> = values(profiles, variant, result).collect();
        median(&mut values)
    })
}

/// Returns the smallest and the largest relative change of a result among the profiles.
fn range_of_change(profiles: &[&Solved], variant: usize, result: usize) -> Option<(f64, f64)> {
    let mut changes = Vec::with_capacity(profiles.len());
    for solved in profiles {
        let change = solved[variant][result] / solved[0][result] - 1.0;
        if change.is_finite() {
            changes.push(change);
        }
    }
    let smallest = changes.iter().copied().reduce(f64::min)?;
    let largest = changes.iter().copied().reduce(f64::max)?;
    Some((smallest, largest))
}

/// Returns the value of a number with which a scene is really computed: a wavelength is rounded so
/// that a whole number of waves fits on the length.
fn computed(allowed: Allowed, value: f64) -> f64 {
    if matches!(allowed, Allowed::Fractions(_)) {
        allowed.nearest(value)
    } else {
        value
    }
}

/// Returns the number changed by the share [`Sensitivity::STEP`], and the scene with this number.
/// The number becomes larger if `sign` is 1 and smaller if `sign` is −1. If only some numbers are
/// allowed, the next allowed number is used. The scene is `None` if it cannot have the number.
fn changed(scene: &Scene, axis: &Axis, value: f64, sign: f64) -> (f64, Option<CheckedScene>) {
    let step = Sensitivity::STEP * value.abs();
    let number = match Allowed::of(axis, scene) {
        Allowed::Whole => value + sign * step.round().max(1.0),
        allowed @ Allowed::Fractions(_) => {
            let wanted = value + sign * step;
            let Some(number) = allowed.nearest_other(value, wanted) else {
                return (wanted, None);
            };
            number
        }
        // If the number is the length, [`with_number`] changes the wavelengths in proportion to it.
        Allowed::Any | Allowed::Multiples(_) => value + sign * step,
    };
    let neighbour = with_number(scene, axis, number);
    (
        number,
        neighbour.ok().and_then(|scene| scene.checked().ok()),
    )
}

/// Returns the scene with another value of a number. If the number is the length, the wavelengths
/// change in proportion, so that the same numbers of waves fit on the length.
fn with_number(scene: &Scene, axis: &Axis, number: f64) -> Result<Scene, SceneErrors> {
    let mut values = vec![(axis.clone(), number)];
    if let Allowed::Multiples(_) = Allowed::of(axis, scene) {
        for path in ["roughness.wavelengths.0", "roughness.wavelengths.1"] {
            let Ok(wave) = Axis::new(path, Spacing::List, Vec::new(), scene) else {
                continue;
            };
            let Some(wavelength) = wave.value_in(scene, None) else {
                continue;
            };
            let count = (scene.length / wavelength).round();
            values.push((wave, number / count));
        }
    }
    scene_with(scene, values.iter().map(|(axis, number)| (axis, *number)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    fn sensitivity(name: &str, jobs: usize) -> Sensitivity {
        let scene = open(name)
            .unwrap()
            .scene()
            .with(|scene| scene.numerics.points = 1 << 12)
            .unwrap();
        let mut reported = 0;
        let mut see = |part: &Sensitivity| {
            reported += 1;
            assert_eq!(part.profiles, reported);
        };
        let control = Control::default().on_threads(jobs).reporting_to(&mut see);
        let found = Sensitivity::of(&scene, &mut Simulation::default(), control).unwrap();
        assert_eq!(
            (found.profiles, reported),
            (Ensemble::profiles_of(&scene), found.profiles)
        );
        found
    }

    /// The pull-off force of a sphere is (3/2)πγR. It is proportional to γ and to R, and depends on
    /// no other number.
    #[test]
    fn a_sphere_follows_its_radius_and_the_work_of_adhesion() {
        let found = sensitivity("jkr-sphere", 1);
        assert_eq!((found.range, found.profiles), (None, 1));
        for influence in &found.influences {
            let expected = if matches!(influence.axis.symbol, "R" | "γ") {
                Sensitivity::STEP
            } else {
                0.0
            };
            for ((_, side), sign) in influence.sides.iter().zip([-1.0, 1.0]) {
                let Some(change) = side.and_then(|side| found.changes(&side.medians)[0]) else {
                    assert_eq!(
                        (influence.axis.symbol, sign),
                        ("ν", 1.0),
                        "only ν cannot grow"
                    );
                    continue;
                };
                assert!(
                    (change - sign * expected).abs() < 1e-3,
                    "{influence:?}: {change}"
                );
            }
        }
        let first = found.ordered(0)[0];
        assert!(matches!(first.axis.symbol, "R" | "γ"), "{first:?}");
    }

    /// A wavelength changes so that one more or one less wave fits on the length. The results are
    /// then those of a scene that states these numbers of waves as modes. If the length changes,
    /// the wavelengths change in proportion.
    #[test]
    fn wavelengths_change_by_whole_waves() {
        let base = open("pressure-sensitive")
            .unwrap()
            .set("numerics.points", "1024")
            .unwrap();
        let with = |document: &asperity_scene::Document, waves: &str, modes: &str| {
            let fields = [("roughness.modes", modes), ("roughness.wavelengths", waves)];
            document.set_all(&fields.map(|(path, value)| (path.to_owned(), value.to_owned())))
        };
        let force = |document: asperity_scene::Document| {
            let run = Simulation::default()
                .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
                .unwrap();
            run.figures.pull_off_force
        };
        for (waves, modes, path, sides) in [
            (
                "(1e-4, 1e-6)",
                [1, 100],
                "roughness.wavelengths.0",
                [Some([2, 100]), None],
            ),
            (
                "(5e-5, 1e-6)",
                [2, 100],
                "roughness.wavelengths.0",
                [Some([3, 100]), Some([1, 100])],
            ),
            // A wavelength of 23 µm is stated, of which no whole number fits on the length. The
            // profile therefore has 4 waves of 25 µm.
            (
                "(2.3e-5, 1e-6)",
                [4, 100],
                "roughness.wavelengths.0",
                [Some([5, 100]), Some([3, 100])],
            ),
            (
                "(1e-4, 1e-6)",
                [1, 100],
                "roughness.wavelengths.1",
                [Some([1, 111]), Some([1, 91])],
            ),
            // Both wavelengths are equal. The longest wave must not become shorter than the
            // shortest wave, so it can change to one side only.
            (
                "(2.5e-5, 2.5e-5)",
                [4, 4],
                "roughness.wavelengths.0",
                [None, Some([3, 4])],
            ),
            (
                "(2.5e-5, 2.5e-5)",
                [4, 4],
                "roughness.wavelengths.1",
                [Some([4, 5]), None],
            ),
        ] {
            let document = with(&base, waves, "None").unwrap();
            let found = Sensitivity::of(
                document.scene(),
                &mut Simulation::default(),
                Control::default(),
            )
            .unwrap();
            let influence = found
                .influences
                .iter()
                .find(|influence| influence.axis.path == path)
                .unwrap();
            let end = usize::from(path.ends_with(".1"));
            assert!(
                (influence.value * modes[end] as f64 / 1e-4 - 1.0).abs() < 1e-12,
                "{influence:?}"
            );
            for (side, modes) in sides.into_iter().enumerate() {
                let (number, changed) = influence.sides[side];
                assert_eq!(changed.is_some(), modes.is_some(), "{waves} {path} {side}");
                let (Some(modes), Some(changed)) = (modes, changed) else {
                    continue;
                };
                assert!(
                    (number * modes[end] as f64 / 1e-4 - 1.0).abs() < 1e-12,
                    "{influence:?}"
                );
                let by_modes =
                    with(&base, "None", &format!("({}, {})", modes[0], modes[1])).unwrap();
                let forces: Vec<f64> = (0..16)
                    .filter_map(|line| {
                        force(
                            by_modes
                                .set("roughness.seed", &(5 + line).to_string())
                                .unwrap(),
                        )
                    })
                    .collect();
                assert_eq!(
                    changed.medians[0],
                    median(&mut forces.clone()),
                    "{waves} {path} {side}"
                );
            }
            // If the length changes, the waves are stretched with it. The results are therefore
            // those of a scene that states its waves as modes (numbers of waves on the length)
            // instead of wavelengths.
            let stretched = found
                .influences
                .iter()
                .find(|influence| influence.axis.path == "length")
                .unwrap();
            let of_modes = with(&base, "None", &format!("({}, {})", modes[0], modes[1])).unwrap();
            let of_modes = Sensitivity::of(
                of_modes.scene(),
                &mut Simulation::default(),
                Control::default(),
            )
            .unwrap();
            let by_modes = of_modes
                .influences
                .iter()
                .find(|influence| influence.axis.path == "length")
                .unwrap();
            assert_eq!(stretched, by_modes, "{waves}");
            assert!((stretched.step(1) - Sensitivity::STEP).abs() < 1e-12);
        }
    }

    /// Medians and ranges agree with those of separate computations with the same seeds.
    #[test]
    fn a_rough_scene_changes_on_the_same_profiles() {
        let found = sensitivity("pressure-sensitive", 2);
        assert_eq!(sensitivity("pressure-sensitive", 1), found);
        let paths: Vec<&str> = found
            .influences
            .iter()
            .map(|influence| influence.axis.path.as_str())
            .collect();
        for path in [
            "roughness.hurst",
            "roughness.rms_height",
            "roughness.modes.1",
            "loading.0.0",
            "length",
        ] {
            assert!(paths.contains(&path), "{path}: {paths:?}");
        }
        assert!(
            paths
                .iter()
                .all(|path| !path.starts_with("numerics") && !path.contains("seed")),
            "{paths:?}"
        );
        let forces = |document: asperity_scene::Document| {
            let scene = document
                .scene()
                .with(|scene| scene.numerics.points = 1 << 12)
                .unwrap();
            let force = |seed| {
                let run =
                    Simulation::default()
                        .run(&scene.with_seed(seed), &|| false, &mut |_, _, _| Ok(()));
                run.unwrap().figures.pull_off_force.unwrap()
            };
            (5..21).map(force).collect::<Vec<f64>>()
        };
        let document = open("pressure-sensitive").unwrap();
        let before = forces(document.clone());
        let at = paths
            .iter()
            .position(|path| *path == "roughness.hurst")
            .unwrap();
        let (number, side) = found.influences[at].sides[1];
        let after = forces(
            document
                .set("roughness.hurst", &number.to_string())
                .unwrap(),
        );
        let changes: Vec<f64> = before
            .iter()
            .zip(&after)
            .map(|(before, after)| after / before - 1.0)
            .collect();
        let ends = [f64::min, f64::max]
            .map(|end: fn(f64, f64) -> f64| changes.iter().copied().reduce(end).unwrap());
        let side = side.unwrap();
        assert_eq!(
            (side.range[0], side.medians[0]),
            (Some((ends[0], ends[1])), median(&mut after.clone()))
        );
        assert_eq!(found.present[0], median(&mut before.clone()));
        let least = before.iter().copied().reduce(f64::min);
        assert_eq!(found.range.map(|[least, _]| least[0]), Some(least));
    }
}
