//! Template of a map: a scene without its κ or e_el/γ and H.

use super::levels::{COLUMNS, HURSTS, Level, hurst, parameter_value};
use crate::scene::{
    Adhesion, Edges, Numerics, Roughness, RoughnessParameter, SPRINGS_PER_WAVE, Scene, Solver,
};
use crate::study::axis::{Axis, Spacing};
use crate::study::plan::Plan;
use crate::study::quantity::Quantity;
use crate::study::target::{governing, strip};
use thiserror::Error;

/// Random profiles of each cell.
pub const LINES: u64 = 4;
/// Quantities of each cell.
pub const RECORD: [Quantity; 3] =
    [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient, Quantity::Regime];
/// Fewest and most springs of a map; a scene with fewer keeps its own number, shorter waves need more.
const SPRINGS: (u64, u64) = (1 << 10, 1 << 12);
/// Number of springs above which a map gets fewer cells, and still fewer far above.
const MANY: u64 = 1 << 14;
const VERY_MANY: u64 = 1 << 17;
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

/// Template of a map. Scenes that differ only in κ, H or the resolution of their curve share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    scene: Scene,
    parameter: RoughnessParameter,
}

impl Template {
    /// Template of a checked scene for a map over κ.
    ///
    /// # Errors
    /// When the scene has no κ.
    pub fn of(scene: &Scene) -> Result<Self, NoMap> {
        let adhesion = scene.adhesion.ok_or(NoMap::NoAdhesion)?;
        let (parameter, value) = (RoughnessParameter::Kappa, ANY.0);
        // Without a given amplitude the amplitude follows from γ and κ. The range of the attraction changes no map.
        if adhesion.closing_work.is_some() {
            return Err(NoMap::TwoWorks);
        }
        let adhesion = Adhesion { range: None, ..adhesion.with_parameter(parameter, value) };
        let mut scene = scene.clone();
        let points = match &mut scene.roughness {
            None => return Err(NoMap::Smooth),
            Some(Roughness::SelfAffine { hurst, modes, .. }) => {
                *hurst = ANY.1;
                let last = modes.1;
                last.saturating_mul(SPRINGS_PER_WAVE).clamp(SPRINGS.0, SPRINGS.1).max(last.saturating_mul(2))
            }
            Some(Roughness::Measured { .. }) => SPRINGS.1,
        };
        scene.adhesion = Some(adhesion);
        strip(&mut scene);
        let points = points.min(scene.numerics.points);
        // Edges between springs: a map of few springs is then as accurate as one of very many.
        scene.numerics = Numerics { points, solver: Solver::Exact, edges: Edges::SubCell, ..scene.numerics };
        Ok(Template { scene, parameter: RoughnessParameter::Kappa })
    }

    /// The same template over this parameter.
    pub fn over(mut self, parameter: RoughnessParameter) -> Self {
        let over = |adhesion: Adhesion| adhesion.with_parameter(parameter, ANY.0);
        self.scene.adhesion = self.scene.adhesion.map(over);
        Template { parameter, ..self }
    }

    /// Springs of each profile.
    pub fn springs(&self) -> u64 {
        self.scene.numerics.points
    }

    /// Finest level of the maps: waves that need very many springs have fewer cells.
    pub fn finest(&self) -> Level {
        let springs = self.springs();
        if springs <= MANY {
            Level::Whole
        } else if springs <= VERY_MANY {
            Level::Fine
        } else {
            Level::Medium
        }
    }

    /// Returns true for a roughness with an H; a measured one has none.
    pub fn has_hurst(&self) -> bool {
        matches!(self.scene.roughness, Some(Roughness::SelfAffine { .. }))
    }

    /// Random profiles of each cell.
    pub fn lines(&self) -> u64 {
        if self.has_hurst() { LINES } else { 1 }
    }

    /// Axes of the map: that of H, if the roughness has one, and that of κ or e_el/γ.
    pub fn axes(&self) -> Vec<Axis> {
        let hursts = self.has_hurst().then(|| (0..HURSTS).map(hurst).collect());
        let hursts = hursts.map(|values| ("roughness.hurst", Spacing::Linear, values));
        let parameters = (0..COLUMNS).map(|column| parameter_value(self.parameter, column)).collect();
        let parameters = (self.parameter.name(), Spacing::Logarithmic, parameters);
        let axes = hursts.into_iter().chain([parameters]);
        // Both are quantities of a scene.
        axes.filter_map(|(path, spacing, values)| Axis::new(path, spacing, values, &self.scene).ok())
            .collect()
    }

    /// The study of all cells of the map: number row · [`COLUMNS`] + column.
    pub(super) fn plan(&self) -> Plan {
        Plan { axes: self.axes(), ..Plan::of_scene(&self.scene, self.lines(), &RECORD) }
    }

    /// κ and H of a scene, if stated by the scene itself. Those of a measured profile follow only from its file.
    pub(super) fn place(scene: &Scene) -> Option<(f64, f64)> {
        let Some(Roughness::SelfAffine { hurst, .. }) = scene.roughness else { return None };
        Some((governing(scene)?.kappa?, hurst))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, open};

    fn document() -> Document {
        open("pressure-sensitive").unwrap().set("numerics.points", "2048").unwrap()
    }

    #[test]
    fn a_template_is_that_of_all_kappa_and_hurst() {
        let document = document();
        let of = |document: &Document| Template::of(document.scene()).unwrap();
        let template = of(&document);
        assert_eq!((template.springs(), template.has_hurst(), template.lines()), (2048, true, LINES));
        for (path, value) in [
            ("adhesion.kappa", "2.0"),
            ("roughness.hurst", "0.2"),
            ("title", "\"another\""),
            ("numerics.samples", "64"),
            ("numerics.points", "65536"),
            ("numerics.edges", "Grid"),
            ("adhesion", "(work: 0.05)"),
        ] {
            assert_eq!(of(&document.set(path, value).unwrap()), template, "{path}");
        }
        for (path, value) in [
            ("roughness.seed", "2"),
            ("roughness.rms_height", "1.0e-7"),
            ("loading", "[ToForce(2.0e-5), ToSeparation]"),
            ("material.youngs_modulus", "1.0e6"),
            ("numerics.points", "1024"),
        ] {
            assert_ne!(of(&document.set(path, value).unwrap()), template, "{path}");
        }
        // Short waves get enough springs, and very many springs fewer cells.
        let short = [("numerics.points", "1048576"), ("roughness.modes", "(1, 131072)")];
        let short = short.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let short = of(&document.set_all(&short).unwrap());
        assert_eq!((short.springs(), short.finest()), (1 << 18, Level::Medium));
        assert_eq!(template.finest(), Level::Whole);
        assert_eq!(Template::of(document.set("adhesion", "None").unwrap().scene()), Err(NoMap::NoAdhesion));
        assert_eq!(Template::of(open("jkr-sphere").unwrap().scene()), Err(NoMap::Smooth));
    }

    #[test]
    fn the_scenes_of_all_cells_are_sound() {
        for parameter in RoughnessParameter::ALL {
            let plan = Template::of(document().scene()).unwrap().over(parameter).plan();
            assert_eq!(plan.check_cells(), Ok(()));
            for cell in 0..plan.cells() {
                let scene = plan.scene_of(cell).unwrap();
                let known = governing(&scene).unwrap().parameter(parameter);
                assert_eq!(known, Some(parameter_value(parameter, cell as usize % COLUMNS)));
                assert_eq!(Template::place(&scene).unwrap().1, hurst(cell as usize / COLUMNS));
            }
            assert_eq!((plan.cells() as usize, plan.seed_of(3)), (HURSTS * COLUMNS, 8));
        }
    }
}
