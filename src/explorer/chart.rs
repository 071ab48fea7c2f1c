//! State of the shown map, over H and κ or e_el/γ or over the axes of a study, and its part still to be computed.

use crate::scene::{RoughnessParameter, Scene};
use crate::study::map::{
    Charted, LiveMap, MapAxis, MapModel, NoMap, StudyMap, Template, hursts, parameter_values,
};
use std::sync::Arc;

/// State of the pane of the map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Quantity of the glyphs, where the map has it.
    pub quantity: Charted,
    /// True if the sections through the mark replace the map.
    pub sections: bool,
    /// True if columns and rows are exchanged: κ or e_el/γ across.
    transposed: bool,
    /// Parameter of the live map, beside H.
    parameter: RoughnessParameter,
    /// The live map so far, shown or not. Kept while its parameter and H change.
    pub map: Option<Arc<LiveMap>>,
    /// The live map as shown.
    live: Option<Arc<MapModel>>,
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
    map_model: Arc<MapModel>,
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
    pub fn map_model(&self) -> Option<&MapModel> {
        match self.shown_study() {
            Some(study) => Some(&study.map_model),
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
        let map_model = self.placed(study_map.model(slice));
        self.study = Some(OpenStudy { study_map, slice, map_model });
    }

    /// Exchanges columns and rows.
    pub fn transpose(&mut self) {
        self.transposed = !self.transposed;
        let study = self.study.as_mut().map(|study| &mut study.map_model);
        for map_model in self.live.as_mut().into_iter().chain(study) {
            *map_model = Arc::new(map_model.transposed());
        }
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

    fn placed(&self, map_model: MapModel) -> Arc<MapModel> {
        Arc::new(if self.transposed { map_model.transposed() } else { map_model })
    }

    /// Axes of the shown map or, before there is one, of the live map of a scene with H or without.
    #[must_use]
    pub fn axes(&self, has_hurst: bool) -> (MapAxis, Option<MapAxis>) {
        match (self.map_model(), has_hurst, self.transposed) {
            (Some(map_model), ..) => (map_model.across().clone(), map_model.up().cloned()),
            (None, true, false) => (hursts(), Some(parameter_values(self.parameter))),
            (None, true, true) => (parameter_values(self.parameter), Some(hursts())),
            (None, false, _) => (parameter_values(self.parameter), None),
        }
    }

    /// Quantity of the glyphs: the chosen one, where the map has it.
    #[must_use]
    pub fn charted(&self) -> Charted {
        let all = self.map_model().map(MapModel::charted).unwrap_or_default();
        let chosen = all.iter().find(|one| **one == self.quantity);
        *chosen.or(all.first()).unwrap_or(&self.quantity)
    }

    /// Next quantity of the glyphs.
    #[must_use]
    pub fn next_charted(&self) -> Charted {
        let all = self.map_model().map(MapModel::charted).unwrap_or_default();
        let now = self.charted();
        let place = all.iter().position(|one| *one == now).map_or(0, |place| place + 1);
        all.get(place).or(all.first()).copied().unwrap_or(now)
    }

    /// Stores the live map computed so far.
    pub fn take_in(&mut self, map: Arc<LiveMap>) {
        self.live = Some(self.placed(map.model()));
        self.map = Some(map);
    }

    /// Drops the live map unless a changed scene has the same.
    pub fn renew(&mut self, scene: &Scene) {
        self.moving = false;
        let template = Template::of(scene).ok().map(|template| template.over(self.parameter));
        self.map = self.map.take().filter(|map| Some(map.template().as_ref()) == template.as_ref());
        self.live = self.live.take().filter(|_| self.map.is_some());
    }

    /// The live map to be continued for a scene; `None` once whole.
    ///
    /// # Errors
    /// When the scene has none.
    pub fn wanted(&self, scene: &Scene) -> Result<Option<Arc<LiveMap>>, NoMap> {
        let template = Template::of(scene)?.over(self.parameter);
        let map = match &self.map {
            Some(map) if **map.template() == template => Arc::clone(map),
            _ => Arc::new(LiveMap::new(Arc::new(template))),
        };
        Ok(Some(map).filter(|map| !map.is_whole()))
    }
}
