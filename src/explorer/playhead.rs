//! The loading over which the animation moves, and the position of the animation: over the stages
//! of the scene or, under manual loading, over the path.

use super::app::App;
use super::events::LeastShare;
use super::player::{At, Player};
use super::request::Drive;
use super::snapshot::{ContactSnapshot, FollowedPath};
use asperity_contact::{Events, StageRecord};
use std::sync::Arc;

impl App {
    pub fn drive(&self) -> Drive {
        match (&self.edit.path, self.play_of_path) {
            (None, _) => Drive::Stage(self.play.stage),
            (Some(_), None) => Drive::Manual,
            (Some(_), Some(player)) => Drive::Path(player.stage),
        }
    }

    /// Returns the path of manual loading as the body has followed it before; `None` without manual
    /// loading. It may lack the newest moves, and may belong to an earlier version of the scene.
    pub fn former_path(&self) -> Option<&FollowedPath> {
        self.edit.path.as_ref()?;
        self.snapshot.as_ref()?.followed.as_deref()
    }

    /// Returns the path of manual loading as the body has followed it in the present scene, with
    /// all moves; `None` until it is computed.
    pub fn followed(&self) -> Option<&Arc<FollowedPath>> {
        let snapshot = self.snapshot.as_ref()?;
        let followed = snapshot.followed.as_ref()?;
        let is_present = snapshot.generation == self.edit.generation
            && Some(&followed.path) == self.edit.path.as_ref();
        if is_present { Some(followed) } else { None }
    }

    /// Returns the events of the loading over which the animation moves, or the reason why there
    /// are none; `None` until the solver has listed the events. If the user wants more or fewer
    /// jumps, the former events stay until the solver has listed the new ones.
    pub fn listed_events(&self) -> Option<Result<&Events, &str>> {
        let listed = self.events.as_deref()?;
        let is_present = listed.generation == self.edit.generation && listed.path == self.edit.path;
        if !is_present {
            return None;
        }
        Some(listed.events.as_ref().map_err(String::as_str))
    }

    /// Returns the share with which the events of [`Self::listed_events`] were chosen.
    pub fn listed_share(&self) -> LeastShare {
        let listed = self.events.as_deref();
        listed.map_or(self.view.least_share, |listed| listed.least_share)
    }

    /// Returns the loading stages over which the animation moves: those of the path of manual
    /// loading, otherwise those of the scene.
    pub fn played_stages(&self) -> &[StageRecord] {
        match self.former_path() {
            Some(followed) => &followed.stages,
            None => self.stages(),
        }
    }

    /// Returns the position of the animation over [`Self::played_stages`].
    pub fn playhead(&self) -> Player {
        match (&self.edit.path, self.play_of_path) {
            (None, _) => self.play,
            (Some(_), Some(player)) => player,
            (Some(_), None) => Player {
                stage: self.played_stages().len().saturating_sub(1),
                at: At::End,
                playing: false,
            },
        }
    }

    pub fn set_playhead(&mut self, player: Player) {
        if self.edit.path.is_none() {
            self.play = player;
            return;
        }
        let last = self.played_stages().len().saturating_sub(1);
        let is_at_end = player.stage == last && player.at == At::End;
        self.play_of_path = if is_at_end { None } else { Some(player) };
    }

    /// Returns true while the animation moves.
    pub fn is_playing(&self) -> bool {
        self.playhead().playing && self.is_current()
    }

    /// Returns the newest snapshot, if it shows the present scene and the present kind of loading
    /// (animation or manual); otherwise `None`.
    pub fn present(&self) -> Option<&ContactSnapshot> {
        let snapshot = self.snapshot.as_deref()?;
        let is_present =
            snapshot.generation == self.edit.generation && snapshot.drive == self.drive();
        if is_present { Some(snapshot) } else { None }
    }
}
