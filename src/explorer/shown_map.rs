//! The map that is shown, its axes and its quantity, and the place of the scene on it.

use super::app::App;
use super::map_state::Live;
use asperity_data::AxisScale;
use asperity_study::maps::{Grid, GridPlace};
use asperity_study::{Axis, Quantity};

impl App {
    /// Returns the position of the scene on the map, as numbers on the axes. `None` if the scene
    /// lacks the quantity of an axis, or if the value of this quantity is not known yet.
    pub fn place(&self) -> Option<GridPlace> {
        let (across, up) = self.map_axes()?;
        let scene = self.edit.document.scene();
        let governing = self.governing();
        let place_across = across.value_in(scene, governing.as_ref())?;
        let Some(up) = up else {
            return Some((place_across, None));
        };
        let place_up = up.value_in(scene, governing.as_ref())?;
        Some((place_across, Some(place_up)))
    }

    pub fn grid(&self) -> Option<&Grid> {
        match self.map.shown_study() {
            Some(study) => Some(&study.grid),
            None => Some(&self.studies.value::<Live>()?.grid),
        }
    }

    /// Returns the horizontal and the vertical axis of the map that is shown. If no map is computed
    /// yet, returns the axes of the live map, which the explorer will compute for the scene.
    /// Returns `None` if the scene has no live map.
    pub fn map_axes(&self) -> Option<(Axis, Option<Axis>)> {
        if let Some(grid) = self.grid() {
            return Some((grid.across.clone(), grid.up.clone()));
        }
        let mut axes = self
            .map
            .plan(self.edit.document.scene())
            .ok()?
            .axes
            .into_iter()
            .rev();
        Some((axes.next()?, axes.next()))
    }

    /// Returns the quantity that the map shows. This is the quantity that the user has chosen or,
    /// if the map does not contain it, the first quantity of the map.
    pub fn mapped(&self) -> Quantity {
        let chosen = self.map.quantity;
        let quantities = self.mappable();
        if quantities.contains(&chosen) {
            return chosen;
        }
        quantities.first().copied().unwrap_or(chosen)
    }

    /// Returns the scale of the colours of a quantity, if the user has chosen one; `None` for the
    /// scale that suits the quantity.
    pub fn colour_scale(&self, quantity: Quantity) -> Option<AxisScale> {
        self.map.scale.filter(|_| quantity == self.mapped())
    }

    /// Returns the quantities that the map can show. The list is empty before a map is computed.
    fn mappable(&self) -> Vec<Quantity> {
        self.grid().map(Grid::quantities).unwrap_or_default()
    }

    /// Returns the quantity that the map shows next. After the last quantity of the map comes the
    /// first one.
    pub fn next_mapped(&self) -> Quantity {
        let present = self.mapped();
        let quantities = self.mappable();
        let place = quantities.iter().position(|quantity| *quantity == present);
        let next = place.map_or(0, |place| place + 1);
        let next = quantities.get(next).or(quantities.first());
        next.copied().unwrap_or(present)
    }
}
