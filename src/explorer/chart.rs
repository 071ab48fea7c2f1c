//! State of the shown map, over H and κ or e_el/γ or over the axes of a study, and its part still to be computed.

use crate::scene::{RoughnessParameter, Scene};
use crate::study::map::{LiveMap, NoMap, StudyMap, live_plan};
use crate::study::{Axis, Grid, Quantity};
use std::sync::Arc;

/// State of the pane of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Quantity of the glyphs, where the map has it.
    pub quantity: Quantity,
    /// Parameter of the live map, beside H.
    parameter: RoughnessParameter,
    /// The live map so far, shown or not. Kept while its parameter and H change.
    pub map: Option<Arc<LiveMap>>,
    /// The live map as shown.
    live: Option<Arc<Grid>>,
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
    /// Its maps.
    pub study_map: Arc<StudyMap>,
    /// Number of the shown map.
    pub slice: u64,
    grid: Arc<Grid>,
}

impl Default for Chart {
    fn default() -> Self {
        Chart {
            quantity: Quantity::Regime,
            parameter: RoughnessParameter::default(),
            map: None,
            live: None,
            study: None,
            of_study: false,
            moving: false,
        }
    }
}

impl OpenStudy {
    /// Number of the map `steps` after this one; the first follows the last.
    #[must_use]
    pub fn stepped(&self, steps: i32) -> u64 {
        let slices = i128::from(self.study_map.slices().max(1));
        (i128::from(self.slice) + i128::from(steps)).rem_euclid(slices) as u64
    }
}

impl Chart {
    /// The shown map, if any.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        match self.shown_study() {
            Some(study) => Some(&study.grid),
            None => self.live.as_deref(),
        }
    }

    /// The study whose map is shown.
    #[must_use]
    pub fn shown_study(&self) -> Option<&OpenStudy> {
        self.study.as_ref().filter(|_| self.of_study)
    }

    /// Opens one map of a study.
    pub fn open_study(&mut self, study_map: Arc<StudyMap>, slice: u64) {
        let grid = Arc::new(study_map.grid(slice));
        self.study = Some(OpenStudy { study_map, slice, grid });
    }

    /// Parameter of the live map, beside H.
    #[must_use]
    pub fn parameter(&self) -> RoughnessParameter {
        self.parameter
    }

    /// Maps over the other parameter of roughness: e_el/γ in place of κ, or the reverse.
    pub fn next_parameter(&mut self) {
        self.parameter = match self.parameter {
            RoughnessParameter::Kappa => RoughnessParameter::ElasticEnergyRatio,
            RoughnessParameter::ElasticEnergyRatio => RoughnessParameter::Kappa,
        };
        (self.map, self.live, self.moving) = (None, None, false);
    }

    /// Axes across and up of the shown map or, before there is one, of the live map of a scene.
    #[must_use]
    pub fn axes(&self, scene: &Scene) -> Option<(Axis, Option<Axis>)> {
        if let Some(grid) = self.grid() {
            return Some((grid.across.clone(), grid.up.clone()));
        }
        let mut axes = live_plan(scene, self.parameter).ok()?.axes.into_iter();
        Some((axes.next()?, axes.next()))
    }

    /// Quantity of the glyphs: the chosen one, where the map has it.
    #[must_use]
    pub fn charted(&self) -> Quantity {
        let all = self.grid().map(Grid::quantities).unwrap_or_default();
        let chosen = all.iter().find(|one| **one == self.quantity);
        *chosen.or(all.first()).unwrap_or(&self.quantity)
    }

    /// Next quantity of the glyphs.
    #[must_use]
    pub fn next_charted(&self) -> Quantity {
        let all = self.grid().map(Grid::quantities).unwrap_or_default();
        let now = self.charted();
        let place = all.iter().position(|one| *one == now).map_or(0, |place| place + 1);
        all.get(place).or(all.first()).copied().unwrap_or(now)
    }

    /// Stores the live map computed so far.
    pub fn take_in(&mut self, map: Arc<LiveMap>) {
        self.live = Some(Arc::new(map.grid()));
        self.map = Some(map);
    }

    /// Drops the live map unless a changed scene has the same.
    pub fn renew(&mut self, scene: &Scene) {
        self.moving = false;
        let plan = live_plan(scene, self.parameter);
        self.map = self.map.take().filter(|map| plan.as_ref() == Ok(map.plan()));
        self.live = self.live.take().filter(|_| self.map.is_some());
    }

    /// The live map to be continued for a scene; `None` once whole.
    ///
    /// # Errors
    /// When the scene has none.
    pub fn wanted(&self, scene: &Scene) -> Result<Option<Arc<LiveMap>>, NoMap> {
        let plan = live_plan(scene, self.parameter)?;
        let known = self.map.as_ref().filter(|map| *map.plan() == plan).cloned();
        let map = known.or_else(|| LiveMap::new(plan).ok().map(Arc::new));
        Ok(map.filter(|map| !map.is_whole()))
    }
}
