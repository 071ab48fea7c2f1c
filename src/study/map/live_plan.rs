//! The plan of the live map of a scene.

use super::levels::{COLUMNS, HURSTS, hurst, parameter_value};
use crate::scene::{
    Adhesion, Edges, Numerics, Roughness, RoughnessParameter, SPRINGS_PER_WAVE, Scene, Solver,
};
use crate::study::axis::{Axis, Spacing};
use crate::study::plan::Plan;
use crate::study::quantity::Quantity;
use crate::study::target::strip;
use thiserror::Error;

/// Random profiles of each cell.
pub const LINES: u64 = 4;
/// Quantities of each cell.
pub const RECORD: [Quantity; 3] =
    [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient, Quantity::Regime];
/// Fewest and most springs of a map; a scene with fewer keeps its own number, shorter waves need more.
const SPRINGS: (u64, u64) = (1 << 10, 1 << 12);
/// Representatives of all κ or e_el/γ and all H.
const ANY: (f64, f64) = (1.0, 0.5);

/// Reason why a scene has no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoMap {
    /// The scene has no adhesion.
    #[error("no map: the scene has no adhesion, so no κ; switch adhesion on with t in its row")]
    NoAdhesion,
    /// Two works of adhesion.
    #[error("no map: κ is defined by one work of adhesion; leave adhesion.closing_work out")]
    TwoWorks,
    /// The scene has no roughness.
    #[error("no map: a smooth body has neither κ nor H; switch roughness on with t in its row")]
    Smooth,
}

/// The study of all cells of the live map of a checked scene: H, if its roughness has one, and κ or e_el/γ. Scenes that
/// differ only in these or in the resolution of their curve have the same.
///
/// # Errors
/// When the scene has no κ.
pub fn live_plan(scene: &Scene, parameter: RoughnessParameter) -> Result<Plan, NoMap> {
    let adhesion = scene.adhesion.ok_or(NoMap::NoAdhesion)?;
    if adhesion.closing_work.is_some() {
        return Err(NoMap::TwoWorks);
    }
    // Without a given amplitude the amplitude follows from γ and κ. The range of the attraction changes no map.
    let adhesion = Adhesion { range: None, ..adhesion.with_parameter(parameter, ANY.0) };
    let mut scene = scene.clone();
    let (points, has_hurst) = match &mut scene.roughness {
        None => return Err(NoMap::Smooth),
        Some(Roughness::SelfAffine { hurst, modes, .. }) => {
            *hurst = ANY.1;
            let wanted = modes.1.saturating_mul(SPRINGS_PER_WAVE).clamp(SPRINGS.0, SPRINGS.1);
            (wanted.max(modes.1.saturating_mul(2)), true)
        }
        Some(Roughness::Measured { .. }) => (SPRINGS.1, false),
    };
    scene.adhesion = Some(adhesion);
    strip(&mut scene);
    let points = points.min(scene.numerics.points);
    // Edges between springs: a map of few springs is then as accurate as one of very many.
    scene.numerics = Numerics { points, solver: Solver::Exact, edges: Edges::SubCell, ..scene.numerics };
    let hursts = has_hurst.then(|| ("roughness.hurst", Spacing::Linear, (0..HURSTS).map(hurst).collect()));
    let parameters = (0..COLUMNS).map(|column| parameter_value(parameter, column)).collect();
    let axes = hursts.into_iter().chain([(parameter.name(), Spacing::Logarithmic, parameters)]);
    // Both are quantities of a scene.
    let axes = axes.filter_map(|(path, spacing, values)| Axis::new(path, spacing, values, &scene).ok());
    let lines = if has_hurst { LINES } else { 1 };
    Ok(Plan { axes: axes.collect(), ..Plan::of_scene(&scene, lines, &RECORD) })
}

#[cfg(test)]
mod tests {
    use super::super::Level;
    use super::*;
    use crate::scene::RoughnessParameter::Kappa;
    use crate::scene::{Document, open};
    use crate::study::target::governing;

    fn document() -> Document {
        open("pressure-sensitive").unwrap().set("numerics.points", "2048").unwrap()
    }

    #[test]
    fn a_map_is_that_of_all_kappa_and_hurst() {
        let document = document();
        let of = |document: &Document| live_plan(document.scene(), Kappa);
        let plan = of(&document).unwrap();
        assert_eq!((plan.scene.numerics.points, plan.axes.len(), plan.lines), (2048, 2, LINES));
        for (path, value) in [
            ("adhesion.kappa", "2.0"),
            ("roughness.hurst", "0.2"),
            ("title", "\"another\""),
            ("numerics.samples", "64"),
            ("numerics.points", "65536"),
            ("numerics.edges", "Grid"),
            ("adhesion", "(work: 0.05)"),
        ] {
            assert_eq!(of(&document.set(path, value).unwrap()).unwrap(), plan, "{path}");
        }
        for (path, value) in [
            ("roughness.seed", "2"),
            ("roughness.rms_height", "1.0e-7"),
            ("loading", "[ToForce(2.0e-5), ToSeparation]"),
            ("material.youngs_modulus", "1.0e6"),
            ("numerics.points", "1024"),
        ] {
            assert_ne!(of(&document.set(path, value).unwrap()).unwrap(), plan, "{path}");
        }
        // Short waves get enough springs, and very many springs fewer cells.
        let short = [("numerics.points", "1048576"), ("roughness.modes", "(1, 131072)")];
        let short = short.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let short = of(&document.set_all(&short).unwrap()).unwrap();
        let finest = [short, plan].map(|plan| Level::finest(plan.scene.numerics.points));
        assert_eq!(finest, [Level::Medium, Level::Whole]);
        assert_eq!(of(&document.set("adhesion", "None").unwrap()), Err(NoMap::NoAdhesion));
        assert_eq!(of(&open("jkr-sphere").unwrap()), Err(NoMap::Smooth));
    }

    #[test]
    fn the_scenes_of_all_cells_are_sound() {
        for parameter in RoughnessParameter::ALL {
            let plan = live_plan(document().scene(), parameter).unwrap();
            assert_eq!(plan.check_cells(), Ok(()));
            for cell in 0..plan.cells() {
                let scene = plan.scene_of(cell).unwrap();
                let known = governing(&scene).unwrap().parameter(parameter);
                assert_eq!(known, Some(parameter_value(parameter, cell as usize % COLUMNS)));
                assert_eq!(plan.value(cell, 0), hurst(cell as usize / COLUMNS));
            }
            assert_eq!((plan.cells() as usize, plan.seed_of(3)), (HURSTS * COLUMNS, 8));
        }
    }
}
