//! Axes of maps: quantities of a scene that can be read and changed.

use crate::analysis::Governing;
use crate::scene::{Adhesion, Document, Move, RoughnessParameter, Scene, SceneErrors, ron_float};
use crate::study::figure::FigureAxis;
use crate::study::target::{Target, governing};

/// Axis of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapAxis {
    /// Path of the quantity, as in the axes of plans.
    pub path: String,
    /// Name, symbol and values.
    pub figure: FigureAxis,
}

impl MapAxis {
    /// Symbol, or the name of a quantity without one.
    #[must_use]
    pub fn symbol(&self) -> &str {
        if self.figure.symbol.is_empty() { &self.figure.name } else { &self.figure.symbol }
    }

    /// Value of the quantity in a scene; `None` where the scene has none. `computed` are the governing parameters
    /// of a scene whose file has to be read to obtain them.
    #[must_use]
    pub fn value(&self, scene: &Scene, computed: Option<&Governing>) -> Option<f64> {
        let target = Target::of(&self.path).ok()?;
        if let Some(parameter) = parameter_of(target, &self.path) {
            let adhesion = scene.adhesion?;
            let known = governing(scene).or(computed.copied());
            let stated = adhesion.parameter().filter(|(stated, _)| *stated == parameter);
            return known.and_then(|known| known.parameter(parameter)).or(stated.map(|(_, value)| value));
        }
        match (target, scene.loading.first()) {
            (Target::Preload, Some(Move::ToForce(force))) => Some(force / force_unit(scene)?),
            _ => target.get(scene),
        }
    }
}

/// κ or e_el/γ, if the quantity is one of them: a scene may specify it by its work of adhesion.
fn parameter_of(target: Target, path: &str) -> Option<RoughnessParameter> {
    match target {
        Target::RoughnessParameter(parameter) => Some(parameter),
        _ => RoughnessParameter::ALL.into_iter().find(|parameter| parameter.path() == path),
    }
}

/// Unit of preloads, E* h L, of a scene with a self-affine profile, N.
pub(super) fn force_unit(scene: &Scene) -> Option<f64> {
    governing(scene)?.force_unit(scene.length)
}

/// Document with other values of quantities, by their paths. κ or e_el/γ changes the work of adhesion of a scene
/// that specifies it, and a preload replaces the loading; both are set last, since they depend on the others.
///
/// # Errors
/// A value that is not allowed.
pub fn moved(document: &Document, values: &[(&str, f64)]) -> Result<Document, SceneErrors> {
    let (mut fields, mut parameter, mut preload, mut springs) = (Vec::new(), None, None, None);
    for &(path, value) in values {
        let target = Target::of(path);
        if let Some(stated) = target.as_ref().ok().and_then(|&target| parameter_of(target, path)) {
            parameter = Some((stated, value));
            continue;
        }
        match target {
            Ok(Target::Preload) => preload = Some(value),
            Ok(Target::SpringsPerWave) => springs = Some(value),
            target => {
                let is_whole = target.is_ok_and(Target::is_whole);
                let text = if is_whole { format!("{value:.0}") } else { ron_float(value) };
                fields.push((path.to_owned(), text));
            }
        }
    }
    let mut moved = document.set_all(&fields)?;
    if let Some(springs) = springs {
        let last = (moved.scene().numerics.points as f64 / springs).round();
        moved = moved.set("roughness.modes.1", &format!("{last:.0}"))?;
    }
    if let Some((parameter, value)) = parameter {
        let by_work = matches!(moved.scene().adhesion, Some(Adhesion::Work { amplitude: None, .. }));
        let work = governing(moved.scene()).and_then(|governing| governing.work_for(parameter, value));
        moved = match work.filter(|_| by_work) {
            Some(work) => moved.with_work_of_adhesion(work)?,
            None => moved.with_parameter(parameter, value)?,
        };
    }
    match preload.zip(force_unit(moved.scene())) {
        Some((preload, unit)) => {
            moved.set("loading", &format!("[ToForce({}), ToSeparation]", ron_float(preload * unit)))
        }
        None => Ok(moved),
    }
}
