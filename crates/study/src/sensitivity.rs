//! Sensitivity of the results of a scene: how they change with each number of the scene, by a tenth, and with the random
//! phases.

use super::axis::Axis;
use super::error::StudyError;
use super::place::{numbers, scene_with};
use super::quantity::Quantity;
use super::results::Results;
use asperity_scene::Scene;
use asperity_scene::Simulation;

/// Share by which a number is made smaller and larger.
pub const STEP: f64 = 0.1;
/// Number of random profiles besides the profile of the scene.
pub const OTHER_SEEDS: u64 = 7;

/// Values of the results in SI units, in the order of [`Sensitivity::RESULTS`].
pub type Values = [Option<f64>; 3];

/// Results for a smaller and a larger value of one number of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Path, name and unit of the number.
    pub axis: Axis,
    /// The number in the scene.
    pub value: f64,
    /// The smaller and the larger number, each with the results; `None` for a number that the scene does not allow.
    pub sides: [(f64, Option<Values>); 2],
}

/// Results of a scene, and of scenes with one number changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Results of the scene itself.
    pub present: Values,
    /// Influence of each number of the scene that is not a count, as far as computed.
    pub influences: Vec<Influence>,
    /// Smallest and largest results over the profile of the scene and the profiles of the [`OTHER_SEEDS`] following seeds;
    /// `None` for a scene without random phases.
    pub seeds: Option<[Values; 2]>,
}

impl Sensitivity {
    /// The results that are compared.
    pub const RESULTS: [Quantity; 3] =
        [Quantity::AdhesionForce, Quantity::ZeroLoadAdhesionForce, Quantity::DissipatedEnergy];

    /// Computes a checked scene, and scenes with one number changed. All other numbers stay: if κ is given, the work of
    /// adhesion follows from κ. `report` receives the influences so far after each.
    ///
    /// # Errors
    /// A profile or its contact fails, or `stop` returned true.
    pub fn of(
        scene: &Scene,
        simulation: &mut Simulation,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&Sensitivity),
    ) -> Result<Sensitivity, StudyError> {
        let mut solve = |scene: &Scene, lines| -> Result<Vec<Values>, StudyError> {
            let mut results = Results::begin(scene, &Self::RESULTS, lines, None)?;
            let failed = |error| StudyError::Run { place: String::new(), error };
            results.extend(simulation, stop, &mut |_| ()).map_err(failed)?;
            Ok((0..lines).map(|line| Self::RESULTS.map(|of| results.value(0, line, of))).collect())
        };
        let lines = solve(scene, if scene.seed().is_some() { 1 + OTHER_SEEDS } else { 1 })?;
        let seeds = (lines.len() > 1).then(|| {
            [f64::min, f64::max].map(|end: fn(f64, f64) -> f64| {
                [0, 1, 2].map(|of| lines.iter().filter_map(|line| line[of]).reduce(end))
            })
        });
        let mut all = Sensitivity { present: lines[0], influences: Vec::new(), seeds };
        for (axis, value) in numbers(scene) {
            let mut sides = [-1.0, 1.0].map(|sign| (changed(&axis, value, sign), None));
            for (changed, results) in &mut sides {
                let neighbour = scene_with(scene, std::iter::once((&axis, *changed)));
                if let Some(neighbour) = neighbour.ok().and_then(|scene| scene.checked().ok()) {
                    *results = Some(solve(&neighbour, 1)?[0]);
                }
            }
            all.influences.push(Influence { axis, value, sides });
            report(&all);
        }
        Ok(all)
    }

    /// Relative changes from the results of the scene to these values; `None` if either is missing or the result of the
    /// scene is zero.
    pub fn changes(&self, values: &Values) -> Values {
        [0, 1, 2].map(|of| Some(values[of]? / self.present[of].filter(|present| *present != 0.0)? - 1.0))
    }

    /// The reason, in words, why no change of the adhesion force is known; `None` if there is an adhesion force.
    pub fn missing(&self) -> Option<&'static str> {
        let is_known = self.present[0].is_some_and(|force| force != 0.0);
        (!is_known)
            .then_some("The scene has no pull-off: there is no adhesion force that a number could change.")
    }

    /// The influences, with the largest change of a result first; `result` is the index of the result.
    pub fn ordered(&self, result: usize) -> Vec<&Influence> {
        let mut ordered: Vec<&Influence> = self.influences.iter().collect();
        let size = |influence: &&Influence| {
            let sides =
                influence.sides.iter().filter_map(|(_, values)| self.changes(values.as_ref()?)[result]);
            sides.fold(0.0, |most: f64, one| most.max(one.abs()))
        };
        ordered.sort_by(|one, other| size(other).total_cmp(&size(one)));
        ordered
    }
}

/// A number changed by the share [`STEP`] up or down; a whole number by at least 1.
fn changed(axis: &Axis, value: f64, sign: f64) -> f64 {
    let step = STEP * value.abs();
    if axis.is_whole() { value + sign * step.round().max(1.0) } else { value + sign * step }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    fn sensitivity(name: &str) -> Sensitivity {
        let scene = open(name).unwrap().scene().with(|scene| scene.numerics.points = 1 << 14).unwrap();
        let mut reported = 0;
        let found = Sensitivity::of(&scene, &mut Simulation::default(), &|| false, &mut |part| {
            reported += 1;
            assert_eq!(part.influences.len(), reported);
        });
        let found = found.unwrap();
        assert_eq!(found.influences.len(), reported);
        found
    }

    /// F_a = (3/2)πγR of a sphere changes in proportion to γ and R, and with nothing else.
    #[test]
    fn a_sphere_follows_its_radius_and_the_work_of_adhesion() {
        let found = sensitivity("jkr-sphere");
        assert_eq!(found.seeds, None);
        for influence in &found.influences {
            let expected = if matches!(influence.axis.symbol, "R" | "γ") { STEP } else { 0.0 };
            for ((_, values), sign) in influence.sides.iter().zip([-1.0, 1.0]) {
                let Some(change) = values.and_then(|values| found.changes(&values)[0]) else {
                    assert_eq!((influence.axis.symbol, sign), ("ν", 1.0), "only ν cannot grow");
                    continue;
                };
                assert!((change - sign * expected).abs() < 1e-3, "{influence:?}: {change}");
            }
        }
        let first = found.ordered(0)[0];
        assert!(matches!(first.axis.symbol, "R" | "γ"), "{first:?}");
    }

    #[test]
    fn a_rough_scene_has_its_numbers_and_its_seeds() {
        let found = sensitivity("pressure-sensitive");
        let paths: Vec<&str> =
            found.influences.iter().map(|influence| influence.axis.path.as_str()).collect();
        for path in ["roughness.hurst", "roughness.rms_height", "roughness.modes.1", "loading.0.0", "length"]
        {
            assert!(paths.contains(&path), "{path}: {paths:?}");
        }
        assert!(
            paths.iter().all(|path| !path.starts_with("numerics") && !path.contains("seed")),
            "{paths:?}"
        );
        let [low, high] = found.seeds.unwrap();
        assert!(low[0] <= found.present[0] && found.present[0] <= high[0] && low[0] < high[0]);
    }
}
