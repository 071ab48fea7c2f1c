//! Functions that read the value of a scene on an axis, and that make scenes with other values.

use super::axis::{Axis, Spacing, Target};
use asperity_contact::Move;
use asperity_scene::fields::{FIELDS, Field, NumberError, Range};
use asperity_scene::{
    Adhesion, Document, Governing, RoughnessParameter, Scene, SceneError, SceneErrors,
};

/// Path of the work of adhesion.
const WORK: &str = "adhesion.work";

impl Axis {
    /// Returns the value that the quantity of this axis has in a scene; `None` if the scene does
    /// not determine this value. `computed` are the governing parameters of the computed scene,
    /// such as its rms height. They are needed only if the scene has a measured surface.
    pub fn value_in(&self, scene: &Scene, computed: Option<&Governing>) -> Option<f64> {
        if let Some(parameter) = self.target.parameter() {
            let known = governing(scene).or(computed.copied());
            let stated = scene
                .adhesion?
                .parameter()
                .filter(|(stated, _)| *stated == parameter);
            return known
                .and_then(|known| known.parameter(parameter))
                .or(stated.map(|(_, value)| value));
        }
        match (self.target, scene.loading.first()) {
            (Target::Preload { in_newtons: true }, Some(Move::ToForce(force))) => Some(*force),
            (Target::Preload { .. }, Some(Move::ToForce(force))) => {
                Some(force / force_unit(scene)?)
            }
            (Target::Preload { .. }, _) => None,
            (Target::SpringsPerWave, _) => {
                Some(scene.numerics.points as f64 / scene.spectrum()?.last as f64)
            }
            _ => {
                let stated = scene.number(&self.path);
                stated.or_else(|| self.work_in(scene, computed))
            }
        }
    }

    /// Returns the work of adhesion that follows from κ or e_el/γ, if it is the quantity of this
    /// axis; otherwise `None`.
    fn work_in(&self, scene: &Scene, computed: Option<&Governing>) -> Option<f64> {
        if self.path != WORK {
            return None;
        }
        governing(scene).or(computed.copied())?.work_of_adhesion
    }
}

/// Returns the scene `base` with other values on axes. Numbers of the scene are set first, then
/// quantities that depend on several numbers, then a roughness parameter (κ or e_el/γ), which
/// replaces the work of adhesion. A preload is not part of a scene; it is applied when the contact
/// is computed.
///
/// # Errors
/// Returns an error with the path and the reason if the scene lacks a number.
pub(super) fn scene_with<'a>(
    base: &Scene,
    values: impl Iterator<Item = (&'a Axis, f64)>,
) -> Result<Scene, SceneErrors> {
    let refused = |message| SceneError {
        message,
        ..SceneError::default()
    };
    let mut scene = base.clone();
    let mut by_parameter = None;
    let mut values: Vec<_> = values.collect();
    values.sort_by_key(|(axis, _)| turn(axis));
    for (axis, value) in values {
        if let Some(parameter) = axis.target.parameter() {
            by_parameter = Some((parameter, value));
            continue;
        }
        let (path, value) = match axis.target {
            Target::Preload { .. } => continue,
            Target::SpringsPerWave => shortest_wave(&scene, value),
            Target::Number(_) | Target::Stage(_) => (axis.path.as_str(), value),
        };
        match scene.set_number(path, value) {
            Ok(()) => {}
            Err(NumberError::Contradiction(reason)) => return Err(refused(reason).into()),
            Err(NumberError::Missing) => {
                let counted = counted(base, &axis.path);
                let reason = format!("axis {}: the scene has no {path}{counted}", axis.path);
                return Err(refused(reason).into());
            }
        }
    }
    if let Some((parameter, value)) = by_parameter {
        if scene
            .adhesion
            .is_some_and(|adhesion| adhesion.has_two_works())
        {
            let why = "κ and e_el/γ refer to one work of adhesion, and the scene has another one on closing";
            return Err(refused(format!(
                "axis {}: {why}: vary adhesion.work",
                parameter.path()
            ))
            .into());
        }
        scene.adhesion = Some(with_parameter(&scene, parameter, value));
    }
    Ok(scene)
}

/// Returns the end of an error message about a path in a list, which says how many elements the
/// list has; empty for a path outside lists.
fn counted(scene: &Scene, path: &str) -> String {
    let spheres = scene.form.as_ref().map_or(0, |form| form.spheres().len());
    if path.starts_with("loading.") {
        let stages = scene.loading.len();
        format!("; its {stages} loading stages are counted from 0")
    } else if path.starts_with("form.") && spheres > 0 {
        format!("; its {spheres} spheres are counted from 0")
    } else {
        String::new()
    }
}

/// Returns the position of an axis in the order in which quantities are set in a scene; 0 comes
/// first. Quantities with the same position are set in the order of the axes.
fn turn(axis: &Axis) -> usize {
    match (axis.target, axis.path.as_str()) {
        // The number of springs per wave comes after the number of springs, because the last mode
        // depends on both.
        (Target::SpringsPerWave, _) => 1,
        // The work of adhesion comes before the other numbers of the adhesion, because a scene
        // cannot have these numbers without a work of adhesion.
        (_, WORK) => 2,
        (_, "adhesion.closing_work") => 3,
        (_, "adhesion.range") => 4,
        _ => 0,
    }
}

/// Returns the adhesion that has the value of κ or e_el/γ. The range of the attraction is kept.
fn with_parameter(scene: &Scene, parameter: RoughnessParameter, value: f64) -> Adhesion {
    let by_parameter = Adhesion::by_parameter(parameter, value);
    scene.adhesion.map_or(by_parameter, |adhesion| {
        adhesion.with_parameter(parameter, value)
    })
}

/// Returns the path and the value with which the shortest wave has the given number of springs. The
/// value is a wavelength if the scene states wavelengths, otherwise a mode.
fn shortest_wave(scene: &Scene, springs: f64) -> (&'static str, f64) {
    let points = scene.numerics.points as f64;
    match scene.number("roughness.wavelengths.1") {
        Some(_) => ("roughness.wavelengths.1", springs * scene.length / points),
        None => ("roughness.modes.1", (points / springs).round()),
    }
}

/// Returns the physical numbers of a scene. Each number is given as an axis without values, and its
/// value. Counts, such as the number of springs, and numbers that are zero are left out.
pub(super) fn numbers(scene: &Scene) -> Vec<(Axis, f64)> {
    let is_physical =
        |field: &&Field| field.parent() != "numerics" && !matches!(field.range, Range::Whole(..));
    let fields = FIELDS.iter().filter(is_physical);
    let paths = fields.flat_map(|field| ["", ".0", ".1"].map(|end| format!("{}{end}", field.path)));
    let mut numbers: Vec<(Axis, f64)> = Vec::new();
    for path in paths.chain(scene.paths_in_lists()) {
        let axis = Axis::new(&path, Spacing::List, Vec::new(), scene).ok();
        let number = axis.zip(scene.number(&path).filter(|value| *value != 0.0));
        // Variants of one field may have the same path. Each path is returned only once.
        numbers.extend(number.filter(|_| numbers.iter().all(|(axis, _)| axis.path != path)));
    }
    numbers
}

pub(super) fn governing(scene: &Scene) -> Option<Governing> {
    let unit = scene.spectrum()?.unit_amplitude(scene.length);
    Some(Governing::of(scene, Some(unit), None))
}

/// Returns the unit E* h L of preloads in N, for a scene with a self-affine profile.
fn force_unit(scene: &Scene) -> Option<f64> {
    governing(scene)?.force_unit(scene.length)
}

/// Replaces the loading of a scene by a loading to a preload, followed by separation. `preload` is
/// in the unit of `axis`. If the scene does not determine this unit, the scene is not changed.
pub(super) fn press(scene: &mut Scene, axis: &Axis, preload: f64) {
    let unit = if axis.unit == "N" {
        Some(1.0)
    } else {
        force_unit(scene)
    };
    if let Some(unit) = unit {
        scene.loading = vec![Move::ToForce(preload * unit), Move::ToSeparation];
    }
}

impl Axis {
    /// Returns a copy of a scene file in which the quantity of each axis has the given value. If an
    /// axis is a roughness parameter (κ or e_el/γ) and the scene has a work of adhesion, the copy
    /// gets the work of adhesion with which the parameter has the given value. If an axis is the
    /// preload, the copy is loaded to this preload and then to separation.
    ///
    /// # Errors
    /// Returns an error if the scene lacks the quantity of an axis, or if the scene does not allow
    /// a value.
    ///
    /// ```
    /// use asperity_study::{Axis, Spacing};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?;
    /// let axis = Axis::new("adhesion.kappa", Spacing::List, Vec::new(), scene.scene())?;
    /// let other = Axis::set_all(&scene, &[(&axis, 3.5)])?;
    /// assert_eq!(axis.value_in(other.scene(), None), Some(3.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_all(document: &Document, values: &[(&Axis, f64)]) -> Result<Document, SceneErrors> {
        let mut base = Scene::clone(document.scene());
        if let Some((_, work)) = values.iter().find(|(axis, _)| axis.path == WORK)
            && let Some(adhesion) = base.adhesion
            && adhesion.parameter().is_some()
        {
            base.adhesion = Some(adhesion.with_work(*work));
        }
        let mut scene = scene_with(&base, values.iter().copied())?;
        let moves_parameter = values
            .iter()
            .any(|(axis, _)| axis.target.parameter().is_some());
        let by_work = document
            .scene()
            .adhesion
            .filter(|adhesion| moves_parameter && adhesion.parameter().is_none());
        if let Some(adhesion) = by_work {
            let work = governing(&scene).and_then(|known| known.work_of_adhesion);
            scene.adhesion = work.map(|work| adhesion.with_work(work)).or(scene.adhesion);
        }
        if let Some((axis, preload)) = values.iter().find(|(axis, _)| axis.is_of_preloads()) {
            press(&mut scene, axis, *preload);
        }
        document.with_scene(&scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Spacing;
    use crate::plan::Plan;
    use asperity_scene::{Simulation, open};

    fn with(base: &Scene, path: &str, value: f64) -> Result<Scene, SceneErrors> {
        let axis = Axis::new(path, Spacing::List, vec![value], base).unwrap();
        scene_with(base, std::iter::once((&axis, value)))
    }

    /// A scene that states κ has a work of adhesion as well, and gets another one.
    #[test]
    fn a_work_of_adhesion_replaces_kappa() {
        let scene = open("pressure-sensitive").unwrap();
        let scene = scene.set("adhesion", "(kappa: 6.0)").unwrap();
        let axis = Axis::new(WORK, Spacing::List, Vec::new(), scene.scene()).unwrap();
        let work = axis.value_in(scene.scene(), None).unwrap();
        assert_eq!(
            Some(work),
            governing(scene.scene()).unwrap().work_of_adhesion
        );
        let twice = Axis::set_all(&scene, &[(&axis, 2.0 * work)]).unwrap();
        assert_eq!(axis.value_in(twice.scene(), None), Some(2.0 * work));
    }

    #[test]
    fn numbers_are_set_as_by_overrides() {
        for (base, path, value, overrides) in [
            (
                "rough-sphere",
                "roughness.hurst",
                0.55,
                ("roughness.hurst", "0.55"),
            ),
            (
                "rough-sphere",
                "roughness.modes.1",
                64.0,
                ("roughness.modes.1", "64"),
            ),
            (
                "rough-sphere",
                "numerics.points",
                8192.0,
                ("numerics.points", "8192"),
            ),
            (
                "rough-sphere",
                "loading.0.0",
                2.5e-5,
                ("loading.0.0", "2.5e-5"),
            ),
            (
                "rough-sphere",
                "adhesion.kappa",
                1.5,
                ("adhesion", "(kappa: 1.5)"),
            ),
            (
                "rough-sphere",
                "adhesion.elastic_energy_ratio",
                0.5,
                ("adhesion", "(elastic_energy_ratio: 0.5)"),
            ),
            (
                "rough-sphere",
                "adhesion.work",
                0.015,
                ("adhesion.work", "0.015"),
            ),
            (
                "rough-sphere",
                "springs_per_wave",
                8.0,
                ("roughness.modes.1", "2048"),
            ),
            (
                "kendall-punch",
                "form.radius",
                2.5e-5,
                ("form.radius", "2.5e-5"),
            ),
        ] {
            let document = open(base).unwrap();
            let mut scene = with(document.scene(), path, value).unwrap();
            let changed = document.set(overrides.0, overrides.1).unwrap();
            // A built-in scene that is changed loses its title and its notice, so they are copied
            // for the comparison.
            scene.title = changed.scene().title.clone();
            scene.notice = changed.scene().notice.clone();
            assert_eq!(&scene, &**changed.scene(), "{path}");
        }
    }

    #[test]
    fn axes_move_waves_in_metres() {
        let waves = [
            ("roughness.modes", "None"),
            ("roughness.wavelengths", "25 µm, 0.2 µm"),
        ];
        let waves = waves.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = open("pressure-sensitive").unwrap().set_all(&waves).unwrap();
        for (path, value, set) in [
            (
                "roughness.wavelengths.0",
                5e-5,
                ("roughness.wavelengths.0", "50 µm"),
            ),
            (
                "roughness.wavelengths.1",
                4e-7,
                ("roughness.wavelengths", "(2.5e-5, 4e-7)"),
            ),
            ("roughness.roll_off", 1e-5, ("roughness.roll_off", "10 µm")),
            (
                "springs_per_wave",
                16.0,
                ("roughness.wavelengths.1", "9.765625e-8"),
            ),
        ] {
            let axis = Axis::new(path, Spacing::List, vec![value], document.scene()).unwrap();
            let scene = with(document.scene(), path, value).unwrap();
            assert_eq!(
                &scene,
                &**document.set(set.0, set.1).unwrap().scene(),
                "{path}"
            );
            assert_eq!(
                &scene,
                &**Axis::set_all(&document, &[(&axis, value)]).unwrap().scene(),
                "{path}"
            );
            assert_eq!(axis.value_in(&scene, None), Some(value), "{path}");
        }
        // On a longer profile with the same wavelengths, more waves fit.
        let modes = |document: &Document| {
            document
                .scene()
                .spectrum()
                .map(|spectrum| (spectrum.first, spectrum.last))
        };
        for (length, nearest) in [
            ("100 µm", (4, 500)),
            ("120 µm", (5, 600)),
            ("250 µm", (10, 1250)),
        ] {
            assert_eq!(
                modes(&document.set("length", length).unwrap()),
                Some(nearest),
                "{length}"
            );
        }
        let as_modes = [
            ("roughness.modes", "(4, 500)"),
            ("roughness.wavelengths", "None"),
        ];
        let as_modes =
            document.set_all(&as_modes.map(|(path, value)| (path.to_owned(), value.to_owned())));
        let gaps = |document: &Document| {
            let mut simulation = Simulation::default();
            simulation
                .make_line(document.scene())
                .unwrap()
                .0
                .gaps
                .clone()
        };
        assert_eq!(gaps(&document), gaps(&as_modes.unwrap()));
    }

    #[test]
    fn a_document_is_moved_in_its_own_terms() {
        let by_kappa = open("pressure-sensitive")
            .unwrap()
            .set("numerics.points", "2048")
            .unwrap();
        let by_work = by_kappa.set("adhesion", "(work: 0.05)").unwrap();
        let axes = Plan::of_map(by_kappa.scene()).unwrap().axes;
        for document in [by_kappa.clone(), by_work] {
            let moved = Axis::set_all(&document, &[(&axes[1], 0.4), (&axes[0], 3.0)]).unwrap();
            let (before, after) = (
                document.scene().adhesion.unwrap(),
                moved.scene().adhesion.unwrap(),
            );
            assert_eq!(before.work().is_some(), after.work().is_some());
            let [kappa, hurst] =
                [0, 1].map(|axis| axes[axis].value_in(moved.scene(), None).unwrap());
            assert!(
                (kappa / 3.0 - 1.0).abs() < 1e-12 && hurst == 0.4,
                "{kappa} {hurst}"
            );
            let governing = Simulation::default()
                .make_line(moved.scene())
                .map(|(_, _, governing)| governing);
            assert!((governing.unwrap().kappa.unwrap() / 3.0 - 1.0).abs() < 1e-9);
        }
        assert!(Axis::set_all(&by_kappa, &[(&axes[0], f64::NAN)]).is_err());
    }
}
