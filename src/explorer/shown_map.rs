//! The shown map, live or of a study, and the study that computes the live map.

use super::app::App;
use super::map::Live;
use super::snapshot::SolvedScene;
use super::studies::Study;
use crate::study::{Axis, Grid, LiveMap, Quantity};

/// Most springs for the map of a demo, of hundreds of scenes.
const MOST_SPRINGS: u64 = 1 << 12;

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
