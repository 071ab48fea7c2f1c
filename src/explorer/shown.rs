//! Shown panes, the selected one, and its valid keys and exports.

use super::action::Effect;
use super::app::App;
use super::keys::Context;
use super::layout::Layout;
use super::panes::{Pane, Place};
use super::snapshot::Section;
use crate::draw::Figure;
use crate::study::StudyMap;
use std::sync::Arc;

impl App {
    /// The selectable panes, the most important first.
    pub fn panes(&self) -> Vec<Pane> {
        match self.view.large {
            Some(large) => vec![Pane::Force, large, Pane::Parameters],
            None => vec![Pane::Force, Pane::Profile, Pane::Parameters, self.view.lower],
        }
    }

    /// Returns true if a pane is in its place, as far as the window has room.
    pub fn is_shown(&self, pane: Pane) -> bool {
        self.panes().contains(&pane)
    }

    /// Shows and selects a pane, or hides it again. A pane with other keys than the crosshair's is selected before it is
    /// hidden: a user in another pane wants these keys.
    pub fn toggle(&mut self, pane: Pane) {
        let is_in_use = self.view.pane == pane || matches!(pane.row().keys, None | Some(Context::Crosshair));
        if self.is_shown(pane) && is_in_use { self.hide(pane) } else { self.show(pane) }
    }

    /// Shows a pane in its place. A pane in the place of the close-up is selected where that was or where the pane
    /// would be out of sight, any other always.
    pub fn show(&mut self, pane: Pane) {
        let (is_same_place, large) = (self.view.pane == self.view.lower, self.view.large);
        match pane.row().place {
            Place::Own => {}
            Place::CloseUp => (self.view.large, self.view.lower) = (None, pane),
            Place::Large => self.view.large = Some(pane),
        }
        // A small window has room for the selected pane alone.
        let has_room = Layout::of(self).pane(pane).is_some();
        if pane.row().place != Place::CloseUp || is_same_place || !has_room {
            self.view.pane = pane;
        }
        self.keep_selection(large);
    }

    /// Hides a pane and restores the panes in its place.
    pub fn hide(&mut self, pane: Pane) {
        let large = self.view.large;
        if large == Some(pane) {
            self.view.large = None;
        } else if self.view.lower == pane {
            self.view.lower = Pane::CloseUp;
            self.view.pane = if self.view.pane == pane { Pane::CloseUp } else { self.view.pane };
        }
        self.keep_selection(large);
    }

    /// Selects the force curve where the selected pane is no longer shown. In place of another large pane than before
    /// other data are studied.
    fn keep_selection(&mut self, large: Option<Pane>) {
        if self.view.large != large {
            self.effects.push(Effect::Study);
        }
        if !self.is_shown(self.view.pane) {
            self.view.pane = Pane::Force;
        }
    }

    /// Valid keys: in the map the arrows move its mark, in panes with a crosshair the crosshair; in the list of
    /// parameters digits begin a value.
    pub fn keys(&self) -> Context {
        let of_pane = self.view.pane.row().keys;
        match (&self.prompt, of_pane) {
            (Some(prompt), _) => prompt.context(),
            (None, Some(Context::Crosshair)) if self.view.crosshair.is_none() => Context::Explore,
            (None, of_pane) => of_pane.unwrap_or(Context::Explore),
        }
    }

    /// The part of the profile in the selected pane.
    pub fn section(&self) -> Option<&Section> {
        let snapshot = self.snapshot.as_ref()?;
        match self.view.pane {
            Pane::CloseUp => Some(&snapshot.close_up.section),
            Pane::Profile | Pane::Beside => Some(&snapshot.profile),
            _ => None,
        }
    }

    /// The selected pane as a figure; the force curve while the parameters are selected.
    pub fn figure(&self) -> Option<Figure> {
        let pane = if self.view.pane == Pane::Parameters { Pane::Force } else { self.view.pane };
        pane.figure(self)
    }

    /// Shows the map of a study, the first of them.
    pub fn show_study(&mut self, study_map: Arc<StudyMap>) {
        self.map.open_study(study_map, 0);
        self.map.of_study = true;
        self.show(Pane::Map);
    }
}
