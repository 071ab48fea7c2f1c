//! The place of a scene on the axes of a map, and scenes moved to another place.

use crate::analysis::Governing;
use crate::scene::{Document, Move, Scene, SceneErrors, Tree, ron_float};
use crate::study::axis::Axis;
use crate::study::target::{Target, governing};

/// Smallest relative difference of two values of an axis; a smaller one is rounding.
const APART: f64 = 1e-6;

impl Axis {
    /// Value of the quantity in a scene; `None` where the scene has none. `computed` are the governing parameters
    /// of a scene whose file has to be read to obtain them.
    pub fn value_in(&self, scene: &Scene, computed: Option<&Governing>) -> Option<f64> {
        if let Some(parameter) = self.target.parameter() {
            let known = governing(scene).or(computed.copied());
            let stated = scene.adhesion?.parameter().filter(|(stated, _)| *stated == parameter);
            return known.and_then(|known| known.parameter(parameter)).or(stated.map(|(_, value)| value));
        }
        let number = |path: &str| Tree::of(scene).get(path);
        match (self.target, scene.loading.first()) {
            (Target::Preload, Some(Move::ToForce(force))) => Some(force / force_unit(scene)?),
            (Target::Preload, _) => None,
            (Target::SpringsPerWave, _) => Some(scene.numerics.points as f64 / number("roughness.modes.1")?),
            _ => number(&self.path),
        }
    }

    /// The value so many steps above `value`, or below, on an ascending axis; the first or last value beyond the ends,
    /// and `None` where `value` is already there.
    pub fn next_beyond(&self, value: f64, steps: i32) -> Option<f64> {
        let (values, apart) = (&self.values, APART * value.abs());
        let further = steps.unsigned_abs().checked_sub(1)? as usize;
        let index = if steps > 0 {
            let first = values.iter().position(|one| *one > value + apart)?;
            first.saturating_add(further).min(values.len() - 1)
        } else {
            values.iter().rposition(|one| *one < value - apart)?.saturating_sub(further)
        };
        Some(values[index])
    }
}

/// Unit of preloads, E* h L, of a scene with a self-affine profile, N.
pub(super) fn force_unit(scene: &Scene) -> Option<f64> {
    governing(scene)?.force_unit(scene.length)
}

/// Document with other values of the quantities of axes. κ or e_el/γ changes the work of adhesion of a scene that
/// specifies it, and a preload replaces the loading; both are set last, since they depend on the others.
///
/// # Errors
/// A value that is not allowed.
pub fn moved(document: &Document, values: &[(&Axis, f64)]) -> Result<Document, SceneErrors> {
    let (mut fields, mut parameter, mut preload, mut springs) = (Vec::new(), None, None, None);
    for &(axis, value) in values {
        match axis.target {
            target if target.parameter().is_some() => parameter = target.parameter().zip(Some(value)),
            Target::Preload => preload = Some(value),
            Target::SpringsPerWave => springs = Some(value),
            _ => {
                let text = if axis.is_whole() { format!("{value:.0}") } else { ron_float(value) };
                fields.push((axis.path.clone(), text));
            }
        }
    }
    let mut moved = document.set_all(&fields)?;
    if let Some(springs) = springs {
        let last = (moved.scene().numerics.points as f64 / springs).round();
        moved = moved.set("roughness.modes.1", &format!("{last:.0}"))?;
    }
    if let Some((parameter, value)) = parameter {
        let adhesion = moved.scene().adhesion.unwrap_or_default();
        let by_work = adhesion.work.is_some() && !adhesion.sets_amplitude();
        let work = governing(moved.scene()).and_then(|governing| governing.work_for(parameter, value));
        moved = moved.with_adhesion(match work.filter(|_| by_work) {
            Some(work) => adhesion.with_work(work),
            None => adhesion.with_parameter(parameter, value),
        })?;
    }
    match preload.zip(force_unit(moved.scene())) {
        Some((preload, unit)) => {
            moved.set("loading", &format!("[ToForce({}), ToSeparation]", ron_float(preload * unit)))
        }
        None => Ok(moved),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{RoughnessParameter, open};
    use crate::simulation::Simulation;
    use crate::study::map::live_plan;

    #[test]
    fn steps_go_to_the_next_value_of_the_axis_and_end_with_it() {
        let scene = open("pressure-sensitive").unwrap().scene().clone();
        let axes = live_plan(&scene, RoughnessParameter::Kappa).unwrap().axes;
        let to = |value, steps| axes[1].next_beyond(value, steps);
        assert_eq!((to(6.0, 1), to(6.0, -1), to(6.0, 4)), (Some(6.73), Some(5.66), Some(11.3)));
        // A value of the axis but for rounding.
        assert_eq!((to(1.0 + 1e-12, 1), to(1.0 - 1e-12, -1)), (Some(1.19), Some(0.841)));
        assert_eq!((to(31.0, 100), to(32.0, 1), to(0.125, -1)), (Some(32.0), None, None));
        assert_eq!((to(100.0, -1), to(100.0, 1), to(1e-3, 1)), (Some(32.0), None, Some(0.125)));
        assert_eq!((to(6.0, 0), to(6.0, i32::MIN), to(6.0, i32::MAX)), (None, Some(0.125), Some(32.0)));
    }

    #[test]
    fn a_document_is_moved_in_its_own_terms() {
        let by_kappa = open("pressure-sensitive").unwrap().set("numerics.points", "2048").unwrap();
        let both = by_kappa.set_all(&[
            ("roughness".to_owned(), "SelfAffine(hurst: 0.7, modes: (1, 512), seed: 1)".to_owned()),
            ("adhesion".to_owned(), "(work: 0.05, kappa: 2.0)".to_owned()),
        ]);
        let by_work = by_kappa.set("adhesion", "(work: 0.05)").unwrap();
        let axes = live_plan(by_kappa.scene(), RoughnessParameter::Kappa).unwrap().axes;
        for document in [by_kappa.clone(), both.unwrap(), by_work] {
            let moved = moved(&document, &[(&axes[0], 0.4), (&axes[1], 3.0)]).unwrap();
            let (before, after) = (document.scene().adhesion.unwrap(), moved.scene().adhesion.unwrap());
            assert_eq!(before.work.is_some(), after.work.is_some());
            assert_eq!(before.parameter().is_some(), after.parameter().is_some());
            let [hurst, kappa] = [0, 1].map(|axis| axes[axis].value_in(moved.scene(), None).unwrap());
            assert!((kappa / 3.0 - 1.0).abs() < 1e-12 && hurst == 0.4, "{kappa} {hurst}");
            let governing = Simulation::default().make_line(moved.scene()).map(|(_, _, governing)| governing);
            assert!((governing.unwrap().kappa.unwrap() / 3.0 - 1.0).abs() < 1e-9);
        }
        assert!(moved(&by_kappa, &[(&axes[1], f64::NAN)]).is_err());
    }
}
