//! The plan of a live map, which is a map of a scene over κ and H that is shown while it is
//! computed.

use super::axis::{Axis, Spacing};
use super::error::StudyError;
use super::place::scene_with;
use super::plan::Plan;
use super::quantity::Quantity;
use asperity_contact::Edges;
use asperity_data::round_to;
use asperity_scene::RoughnessParameter::Kappa;
use asperity_scene::{
    Adhesion, Governing, Numerics, Roughness, SPRINGS_PER_WAVE, Scene, SceneErrors, Solver,
};

/// Quantities recorded in each [cell](crate::Plan) of a [`LiveMap`](crate::maps::LiveMap).
pub const MAP_RECORD: [Quantity; 6] = [
    Quantity::FirstTouchAdhesionShare,
    Quantity::AdhesionCoefficient,
    Quantity::Regime,
    Quantity::ZeroForceAdhesionShare,
    Quantity::RegimeAfterZeroForce,
    Quantity::AdhesionShare,
];
/// Smallest and largest number of springs of a map. Roughness with short waves may need more
/// springs.
const SPRINGS: (u64, u64) = (1 << 10, 1 << 12);
/// Values of κ and H in the scene of the plan. Each cell of the map replaces them by its own
/// values.
const ANY: (f64, f64) = (1.0, 0.5);
/// Work of adhesion in the scene of a plan with an axis of works of adhesion.
const ANY_WORK: f64 = 0.05;

/// Number of values of κ on the map: four for each factor of two, from 1/8 to 32.
const KAPPAS: u32 = 33;
/// Number of values of H on the map, from 0.05 to 0.95.
const HURSTS: u32 = 19;

/// Returns the values of κ, rounded to three digits as the map shows them. A scene in which the
/// user enters a shown value then equals the scene of a cell of the map exactly.
fn kappas() -> Vec<f64> {
    let mut kappas = Vec::new();
    for index in 0..KAPPAS {
        let exact = ((f64::from(index) - 12.0) / 4.0).exp2();
        kappas.push(round_to(exact, 3));
    }
    kappas
}

fn hursts() -> Vec<f64> {
    let mut hursts = Vec::new();
    for index in 1..=HURSTS {
        hursts.push(f64::from(index) * 5.0 / 100.0);
    }
    hursts
}

/// Returns true if neighbouring values have equal ratios, apart from their rounding to a few
/// digits.
fn have_equal_ratios(values: &[f64]) -> bool {
    const ROUNDING: f64 = 0.02;
    let ratios: Vec<f64> = values.windows(2).map(|pair| pair[1] / pair[0]).collect();
    let Some(first) = ratios.first() else {
        return false;
    };
    values[0] > 0.0
        && ratios
            .iter()
            .all(|ratio| (ratio / first - 1.0).abs() < ROUNDING)
}

/// Returns the error of a scene for which no map can be made.
fn refused(found: &str, allowed: &str) -> StudyError {
    StudyError::refused(Some("no map"), found, allowed)
}

impl Plan {
    /// Number of random profiles for each [cell](crate::Plan) of a
    /// [`LiveMap`](crate::maps::LiveMap) of a scene with self-affine roughness.
    pub const PROFILES_OF_MAP: u64 = 4;

    /// Returns the plan of a [`LiveMap`](crate::maps::LiveMap) of a checked scene. The axes of the
    /// plan are the parameter κ, which compares the roughness with the adhesion, and, if the
    /// roughness of the scene has a Hurst exponent, also this exponent.
    ///
    /// # Errors
    /// Returns an error with the reason if the scene has no map, for example because the body is
    /// smooth.
    ///
    /// ```
    /// use asperity_study::Plan;
    ///
    /// let plan = Plan::of_map(asperity_scene::open("pressure-sensitive")?.scene())?;
    /// assert_eq!(
    ///     (plan.axes[0].path.as_str(), plan.lines),
    ///     ("adhesion.kappa", Plan::PROFILES_OF_MAP)
    /// );
    /// assert!(
    ///     Plan::of_map(asperity_scene::open("jkr-sphere")?.scene())
    ///         .unwrap_err()
    ///         .to_string()
    ///         .contains("smooth")
    /// );
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_map(scene: &Scene) -> Result<Plan, StudyError> {
        let Some(adhesion) = scene.adhesion else {
            let found = "the scene has no adhesion, so no κ";
            return Err(refused(found, "adhesion, which t in its row switches on"));
        };
        if adhesion.closing_work().is_some() {
            let found = "two works of adhesion, of which none defines κ";
            return Err(refused(found, "no adhesion.closing_work"));
        }
        // The quantities of a map do not depend on the range of the attraction, so the range is
        // left out.
        let adhesion = Adhesion {
            range: None,
            ..adhesion.with_parameter(Kappa, ANY.0)
        };
        let mut scene = scene.clone();
        let last = scene.spectrum().map_or(0, |spectrum| spectrum.last);
        let (points, has_hurst) = match &mut scene.roughness {
            None => {
                let found = "a smooth body has neither κ nor H";
                return Err(refused(found, "roughness, which t in its row switches on"));
            }
            Some(Roughness::SelfAffine { hurst, .. }) => {
                *hurst = ANY.1;
                let wanted = last
                    .saturating_mul(SPRINGS_PER_WAVE)
                    .clamp(SPRINGS.0, SPRINGS.1);
                (wanted.max(last.saturating_mul(2)), true)
            }
            Some(Roughness::Measured { .. }) => (SPRINGS.1, false),
        };
        scene.adhesion = Some(adhesion);
        scene.strip();
        let points = points.min(scene.numerics.points);
        // If the edges of patches may lie between springs, a map of few springs is as accurate as a
        // map of very many springs.
        scene.numerics = Numerics {
            points,
            solver: Solver::Exact,
            edges: Edges::SubCell,
            ..scene.numerics
        };
        // Every scene has κ and H as quantities, so both axes exist.
        let mut axes = Vec::new();
        let logarithmic = Spacing::Logarithmic;
        axes.extend(Axis::new(Kappa.path(), logarithmic, kappas(), &scene));
        if has_hurst {
            let path = "roughness.hurst";
            axes.extend(Axis::new(path, Spacing::Linear, hursts(), &scene));
        }
        let lines = if has_hurst { Plan::PROFILES_OF_MAP } else { 1 };
        Ok(Plan {
            axes,
            ..Plan::of_scene(&scene, lines, &MAP_RECORD)
        })
    }
}

impl Plan {
    /// Returns the plan of a [`LiveMap`](crate::maps::LiveMap) of a checked scene over numbers of
    /// the scene. Each of the `axes` is the path of a number and its values in SI units. The map
    /// has the first axis upwards and the second axis across. `quantity` is recorded in addition to
    /// `MAP_RECORD`.
    ///
    /// # Errors
    /// Returns an error if the scene has no such number, or if two axes set the same number.
    ///
    /// ```
    /// use asperity_study::{Plan, Quantity};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?;
    /// let axes: [(&str, &[f64]); 2] = [
    ///     ("roughness.rms_height", &[1e-7, 2e-7]),
    ///     ("material.youngs_modulus", &[1e6, 2e6, 4e6]),
    /// ];
    /// let plan = Plan::of_map_over(scene.scene(), &axes, Quantity::DissipatedEnergy)?;
    /// assert_eq!((plan.cells(), plan.lines), (6, Plan::PROFILES_OF_MAP));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_map_over(
        scene: &Scene,
        axes: &[(&str, &[f64])],
        quantity: Quantity,
    ) -> Result<Plan, StudyError> {
        let mut scene = scene.clone();
        scene.strip();
        let is_axis = |path: &str| axes.iter().any(|(of_axis, _)| *of_axis == path);
        if let Some(adhesion) = scene.adhesion
            && adhesion.parameter().is_some()
            && is_axis("adhesion.work")
        {
            scene.adhesion = Some(adhesion.with_work(ANY_WORK));
        }
        if !is_axis("numerics.points") {
            let waves = scene.spectrum().map_or(0, |spectrum| spectrum.last);
            let wanted = waves
                .saturating_mul(SPRINGS_PER_WAVE)
                .clamp(SPRINGS.0, SPRINGS.1);
            let wanted = wanted.max(waves.saturating_mul(2));
            scene.numerics.points = wanted.min(scene.numerics.points);
        }
        scene.numerics.solver = Solver::Exact;
        scene.numerics.edges = Edges::SubCell;
        let mut made = Vec::new();
        for (path, values) in axes {
            let mut axis = Axis::new(path, Spacing::List, values.to_vec(), &scene)?;
            if !axis.is_whole() && have_equal_ratios(values) {
                axis.spacing = Spacing::Logarithmic;
            }
            made.push(axis);
        }
        // The key of a map is its plan. It must not depend on the numbers of the axes, because the
        // user moves along them.
        let first = made
            .iter()
            .filter_map(|axis| Some((axis, *axis.values.first()?)));
        let scene = scene_with(&scene, first)
            .map_err(|error| refused(&error.to_string(), "another number of the scene"))?;
        let lines = if scene.seed().is_some() {
            Plan::PROFILES_OF_MAP
        } else {
            1
        };
        let mut record = MAP_RECORD.to_vec();
        if !record.contains(&quantity) {
            record.push(quantity);
        }
        let plan = Plan {
            axes: made,
            ..Plan::of_scene(&scene, lines, &record)
        };
        let wrong = plan.errors();
        if wrong.is_empty() {
            Ok(plan)
        } else {
            Err(StudyError::Plan(wrong))
        }
    }

    /// Returns this plan of a live map in the form in which it is written to a file. The scene in
    /// the plan of a live map lacks what the map does not show. The scene in the returned plan has
    /// these properties of `scene` again: its values on the axes, its title and notice, its
    /// observers and the number of points of its force curve. `computed` are the governing
    /// parameters of the computed scene, see [`Axis::value_in`].
    ///
    /// # Errors
    /// Returns an error if the scene does not allow a value.
    ///
    /// ```
    /// use asperity_study::Plan;
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?;
    /// let map = Plan::of_map(scene.scene())?;
    /// let plan = map.for_scene(scene.scene(), None)?;
    /// assert_eq!(plan.scene.title, scene.scene().title);
    /// assert_eq!(plan.scene.numerics.samples, scene.scene().numerics.samples);
    /// assert_eq!(plan.axes[0].value_in(&plan.scene, None), Some(6.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn for_scene(
        self,
        scene: &Scene,
        computed: Option<&Governing>,
    ) -> Result<Plan, SceneErrors> {
        let mut values = Vec::new();
        for axis in &self.axes {
            if let Some(value) = axis.value_in(scene, computed) {
                values.push((axis, value));
            }
        }
        let mut own = scene_with(&self.scene, values.iter().copied())?;
        own.title.clone_from(&scene.title);
        own.notice.clone_from(&scene.notice);
        own.observe.clone_from(&scene.observe);
        own.numerics.samples = scene.numerics.samples;
        Ok(Plan { scene: own, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::governing;
    use asperity_scene::{Document, open};

    fn document() -> Document {
        open("pressure-sensitive")
            .unwrap()
            .set("numerics.points", "2048")
            .unwrap()
    }

    #[test]
    fn a_map_is_that_of_all_kappa_and_hurst() {
        let document = document();
        let of = |document: &Document| Plan::of_map(document.scene());
        let plan = of(&document).unwrap();
        assert_eq!(
            (plan.scene.numerics.points, plan.axes.len(), plan.lines),
            (2048, 2, Plan::PROFILES_OF_MAP)
        );
        for (path, value) in [
            ("adhesion.kappa", "2.0"),
            ("roughness.hurst", "0.2"),
            ("title", "\"another\""),
            ("numerics.samples", "64"),
            ("numerics.points", "65536"),
            ("numerics.edges", "Grid"),
            ("adhesion", "(work: 0.05)"),
        ] {
            assert_eq!(
                of(&document.set(path, value).unwrap()).unwrap(),
                plan,
                "{path}"
            );
        }
        for (path, value) in [
            ("roughness.seed", "2"),
            ("roughness.rms_height", "1.0e-7"),
            ("loading", "[ToForce(2.0e-5), ToSeparation]"),
            ("material.youngs_modulus", "1.0e6"),
            ("numerics.points", "1024"),
        ] {
            assert_ne!(
                of(&document.set(path, value).unwrap()).unwrap(),
                plan,
                "{path}"
            );
        }
        // A roughness with short waves gets more springs than other scenes.
        let short = [
            ("numerics.points", "1048576"),
            ("roughness.modes", "(1, 131072)"),
        ];
        let short = short.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let short = of(&document.set_all(&short).unwrap()).unwrap();
        assert!(short.scene.numerics.points > plan.scene.numerics.points);
        assert!(
            of(&document.set("adhesion", "None").unwrap())
                .unwrap_err()
                .to_string()
                .contains("no adhesion")
        );
        assert!(
            of(&open("jkr-sphere").unwrap())
                .unwrap_err()
                .to_string()
                .contains("a smooth body")
        );
    }

    #[test]
    fn the_scenes_of_all_cells_are_sound() {
        let plan = Plan::of_map(document().scene()).unwrap();
        assert_eq!(plan.check_cells(), Ok(()));
        for cell in 0..plan.cells() {
            let known = governing(&plan.scene_of(cell).unwrap()).unwrap().kappa;
            assert_eq!(known, Some(plan.value(cell, 0)));
        }
        assert_eq!(
            (plan.cells(), plan.seed_of(3)),
            (u64::from(HURSTS * KAPPAS), 8)
        );
        assert!(
            [0.05, 0.5, 0.7, 0.95]
                .iter()
                .all(|hurst| plan.axes[1].values.contains(hurst))
        );
    }
}
