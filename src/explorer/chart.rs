//! What the explorer shows of the map over κ and H, and what is still to be computed of it.

use crate::phase::{Basis, NoMap, PhaseMap};
use crate::scene::Scene;
use std::sync::Arc;

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Whether its pane stands in place of profile and close-up.
    pub shown: bool,
    /// Which quantity the glyphs tell.
    pub quantity: Charted,
    /// Whether the sections through the mark stand in place of the map.
    pub sections: bool,
    /// The map so far. Kept while κ and H change, whether it is shown or not.
    pub map: Option<Arc<PhaseMap>>,
    /// Why the computing of it ended before it was whole.
    pub failed: Option<String>,
    /// Whether the scene has just been edited: somebody who holds a key down wants the machine.
    pub edited: bool,
    /// Whether the last edit was a move of the mark: the next one belongs to it.
    pub moving: bool,
}

/// What the glyphs of the map tell. Colours tell the regime always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Charted {
    /// The regime.
    #[default]
    Regime,
    /// F_a(0)/F_a,max.
    ZeroLoadAdhesion,
    /// F_a/F_n.
    Coefficient,
}

impl Charted {
    /// The next one.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Charted::Regime => Charted::ZeroLoadAdhesion,
            Charted::ZeroLoadAdhesion => Charted::Coefficient,
            Charted::Coefficient => Charted::Regime,
        }
    }
}

impl Chart {
    /// The scene has been changed: a map of another one is of no use.
    pub fn renew(&mut self, scene: &Scene) {
        self.edited = true;
        self.moving = false;
        self.failed = None;
        let basis = Basis::of(scene).ok();
        self.map = self.map.take().filter(|map| Some(map.basis().as_ref()) == basis.as_ref());
    }

    /// The map to be gone on with for a scene, `None` once it is whole.
    ///
    /// # Errors
    /// When the scene has none.
    pub fn wanted(&self, scene: &Scene) -> Result<Option<Arc<PhaseMap>>, NoMap> {
        let basis = Basis::of(scene)?;
        let map = match &self.map {
            Some(map) if **map.basis() == basis => Arc::clone(map),
            _ => Arc::new(PhaseMap::new(Arc::new(basis))),
        };
        Ok(Some(map).filter(|map| !map.is_whole()))
    }
}
