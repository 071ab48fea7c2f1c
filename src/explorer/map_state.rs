//! State of the pane of the map. The pane shows the live map, which is computed for the present
//! scene over H and κ, or a map of a study over axes of this study.

use asperity_data::AxisScale;
use asperity_scene::Scene;
use asperity_study::maps::{Grid, LiveMap, StudyMap};
use asperity_study::{Plan, Quantity, StudyError};
use std::path::PathBuf;
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct MapState {
    /// Quantity that the user has chosen. If the map does not contain it, the first quantity of the
    /// map is shown.
    pub quantity: Quantity,
    /// Scale of the colours that the user has chosen; `None` for the scale that suits the values.
    pub scale: Option<AxisScale>,
    /// Axes that the user has chosen for the live map; `None` for a map over H and κ.
    pub chosen: Option<ChosenAxes>,
    /// File to which the plan of the live map was written; `None` if it was not.
    pub plan_file: Option<PathBuf>,
    /// A finished study. It stays open until another study is opened.
    pub study: Option<OpenStudy>,
    /// True if the map of the study is shown instead of the live map, which the explorer computes
    /// for the present scene.
    pub of_study: bool,
    /// True if the last edit moved the mark on the map. If the mark moves again, both moves are one
    /// edit.
    pub moving: bool,
}

/// Two numbers of the scene over which the live map is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenAxes {
    pub across: ChosenAxis,
    pub up: ChosenAxis,
    /// Quantity that the map records in addition to the usual ones.
    pub quantity: Quantity,
}

/// Number of the scene, and the values that it has on an axis of the live map.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenAxis {
    pub path: String,
    pub values: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct OpenStudy {
    pub study_map: Arc<StudyMap>,
    /// Index of the shown map among the maps of the study, from 0.
    pub slice: u64,
    pub grid: Arc<Grid>,
}

#[derive(Clone, Debug)]
pub struct Live {
    pub map: LiveMap,
    pub grid: Grid,
}

impl Default for MapState {
    fn default() -> Self {
        MapState {
            quantity: Quantity::Regime,
            scale: None,
            chosen: None,
            plan_file: None,
            study: None,
            of_study: false,
            moving: false,
        }
    }
}

impl OpenStudy {
    pub fn new(study_map: Arc<StudyMap>, slice: u64) -> Self {
        let grid = Arc::new(study_map.grid(slice));
        OpenStudy {
            study_map,
            slice,
            grid,
        }
    }

    /// Returns true if a scene belongs to the map of the study that is shown. The scene may then
    /// differ from the scene of the study only in the quantities of the axes.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.study_map.is_of(self.slice, scene)
    }

    /// Returns the index of the map that is `steps` maps after the shown map. After the last map
    /// comes the first map.
    pub fn stepped(&self, steps: i32) -> u64 {
        let slices = i128::from(self.study_map.slices().max(1));
        (i128::from(self.slice) + i128::from(steps)).rem_euclid(slices) as u64
    }
}

impl Live {
    pub fn of(map: &LiveMap) -> Self {
        Live {
            map: map.clone(),
            grid: map.grid(),
        }
    }
}

impl MapState {
    pub fn shown_study(&self) -> Option<&OpenStudy> {
        self.study.as_ref().filter(|_| self.of_study)
    }

    /// Returns the plan of the live map of a scene.
    ///
    /// # Errors
    /// Returns the reason if the scene has no live map.
    pub fn plan(&self, scene: &Scene) -> Result<Plan, StudyError> {
        let Some(ChosenAxes {
            across,
            up,
            quantity,
        }) = &self.chosen
        else {
            return Plan::of_map(scene);
        };
        let axes = [up, across].map(|axis| (axis.path.as_str(), &axis.values[..]));
        Plan::of_map_over(scene, &axes, *quantity)
    }

    /// Returns a text that identifies the live map of a scene, which the explorer computes for this
    /// scene. The text does not depend on the roughness parameter κ and the Hurst exponent, because
    /// they are the axes of the map. Returns `None` if the scene has no live map.
    pub fn key(&self, scene: &Scene) -> Option<String> {
        self.plan(scene).ok().map(|plan| format!("{plan:?}"))
    }
}
