//! State of the shown map, over H and κ or e_el/γ or over the axes of a study.

use super::app::App;
use super::snapshot::SolvedScene;
use super::studies::Study;
use crate::scene::{RoughnessParameter, Scene};
use crate::study::{Axis, Grid, LiveMap, Plan, Quantity, StudyMap, live_plan};
use std::sync::Arc;

/// Most springs for the map of a demo, of hundreds of scenes.
const MOST_SPRINGS: u64 = 1 << 12;

/// State of the pane of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapState {
    /// Quantity of the glyphs, where the map has it.
    pub quantity: Quantity,
    /// Parameter of the live map, beside H.
    pub parameter: RoughnessParameter,
    /// A finished study, kept until another one is opened.
    pub study: Option<OpenStudy>,
    /// True if the map of the study replaces the live map.
    pub of_study: bool,
    /// True if the last edit was a move of the mark: the next move belongs to the same edit.
    pub moving: bool,
}

/// A finished study and its shown map.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenStudy {
    pub study_map: Arc<StudyMap>,
    /// Number of the shown map.
    pub slice: u64,
    grid: Arc<Grid>,
}

/// The live map so far.
#[derive(Debug)]
pub struct Live {
    pub map: LiveMap,
    /// The estimates in the cells of the map, for the pane.
    pub grid: Grid,
}

impl Default for MapState {
    fn default() -> Self {
        MapState {
            quantity: Quantity::Regime,
            parameter: RoughnessParameter::default(),
            study: None,
            of_study: false,
            moving: false,
        }
    }
}

impl OpenStudy {
    /// Number of the map `steps` after this one; the first follows the last.
    pub fn stepped(&self, steps: i32) -> u64 {
        let slices = i128::from(self.study_map.slices().max(1));
        (i128::from(self.slice) + i128::from(steps)).rem_euclid(slices) as u64
    }
}

impl Live {
    /// The cells of a map so far.
    pub fn of(map: &LiveMap) -> Self {
        Live { map: map.clone(), grid: map.grid() }
    }
}

impl MapState {
    /// The study whose map is shown.
    pub fn shown_study(&self) -> Option<&OpenStudy> {
        self.study.as_ref().filter(|_| self.of_study)
    }

    pub fn open_study(&mut self, study_map: Arc<StudyMap>, slice: u64) {
        let grid = Arc::new(study_map.grid(slice));
        self.study = Some(OpenStudy { study_map, slice, grid });
    }

    /// Plan of the live map of a scene.
    fn plan(&self, scene: &Scene) -> Option<Plan> {
        live_plan(scene, self.parameter).ok()
    }

    /// Key of the live map of a scene: kept while the parameter of the map and H change.
    pub fn key(&self, scene: &Scene) -> Option<String> {
        self.plan(scene).map(|plan| format!("{plan:?}"))
    }
}

/// Computes the missing cells of the live map; `None` for a scene without a map.
pub fn study(app: &App, computed: &SolvedScene) -> Option<Study> {
    let plan = app.map.plan(&computed.scene)?;
    let (key, is_long) = (format!("{plan:?}"), plan.scene.numerics.points > MOST_SPRINGS);
    let begun = app.studies.value::<Live>().map(|live| live.map.clone());
    Some(Study::new(key, is_long, move |_, stop, report| {
        let mut map = begun.map_or_else(|| LiveMap::new(plan), Ok).map_err(|error| error.to_string())?;
        map.compute(stop, &mut |map| report(Live::of(map)));
        Ok(Live::of(&map))
    }))
}

impl App {
    /// The shown map, if any.
    pub fn grid(&self) -> Option<&Grid> {
        match self.map.shown_study() {
            Some(study) => Some(&study.grid),
            None => Some(&self.studies.value::<Live>()?.grid),
        }
    }

    /// Axes across and up of the shown map or, before there is one, of the live map.
    pub fn map_axes(&self) -> Option<(Axis, Option<Axis>)> {
        if let Some(grid) = self.grid() {
            return Some((grid.across.clone(), grid.up.clone()));
        }
        let mut axes = self.map.plan(self.edit.document.scene())?.axes.into_iter().rev();
        Some((axes.next()?, axes.next()))
    }

    /// Quantity of the glyphs: the chosen one, where the map has it.
    pub fn mapped(&self) -> Quantity {
        let all = self.grid().map(Grid::quantities).unwrap_or_default();
        let chosen = all.iter().find(|one| **one == self.map.quantity);
        *chosen.or(all.first()).unwrap_or(&self.map.quantity)
    }

    /// Next quantity of the glyphs.
    pub fn next_mapped(&self) -> Quantity {
        let all = self.grid().map(Grid::quantities).unwrap_or_default();
        let now = self.mapped();
        let place = all.iter().position(|one| *one == now).map_or(0, |place| place + 1);
        all.get(place).or(all.first()).copied().unwrap_or(now)
    }
}
