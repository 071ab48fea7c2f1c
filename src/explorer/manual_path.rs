//! The path along which the user moves the body under manual loading: where the path starts, and a
//! list of moves. The path is part of the undo history. The solver repeats it exactly whenever the
//! scene changes.

use super::player::{At, Player};
use asperity_contact::{Move, StageRecord};
use asperity_data::format_rounded;
use asperity_scene::loading::loading_text;
use serde::{Deserialize, Serialize};

/// Largest number of moves of a path. Each move has a force curve of its own in memory.
pub const MOST_MOVES: usize = 1000;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManualPath {
    pub start: PathStart,
    /// Targets of the moves, which stay the same when the scene changes.
    pub moves: Vec<Move>,
}

/// State of the scene's own loading at which a path starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathStart {
    /// Index of the loading stage.
    pub stage: usize,
    pub at: At,
}

impl PathStart {
    /// Returns the position of the animation at this start. If the scene has changed, the position
    /// is limited to the loading stages `stages` of the changed scene.
    fn player(self, records: &[StageRecord]) -> Player {
        let player = Player {
            stage: self.stage,
            at: self.at,
            playing: false,
        };
        player.within(records)
    }

    /// Returns the indentation in m at this start.
    pub fn indentation(self, records: &[StageRecord]) -> f64 {
        let player = self.player(records);
        let indentation = player.indentation(records);
        if player.stage == 0 {
            // The animation begins above first touch, but the body begins at first touch.
            indentation.max(0.0)
        } else {
            indentation
        }
    }

    /// Returns the loading stages that lead from separation to this start. `loading` is the loading
    /// of the scene, and `stages` are the records of its stages. The list is empty if the contact
    /// has not begun.
    pub fn stages(self, loading: &[Move], records: &[StageRecord]) -> Vec<Move> {
        let Player { stage, at, .. } = self.player(records);
        let mut stages: Vec<Move> = loading.iter().take(stage).copied().collect();
        let indentation = self.player(records).indentation(records);
        let is_above_touch = stage == 0 && indentation <= 0.0;
        match at {
            At::Start => {}
            At::Indentation(_) | At::Seconds(_) if is_above_touch => {}
            At::Indentation(_) | At::Seconds(_) | At::PullOff => {
                stages.push(Move::ToIndentation(indentation))
            }
            At::End => stages.extend(loading.get(stage)),
        }
        stages
    }
}

impl ManualPath {
    pub fn starting_at(player: Player) -> Self {
        ManualPath {
            start: PathStart {
                stage: player.stage,
                at: player.at,
            },
            moves: Vec::new(),
        }
    }

    /// Returns the first `count` moves of this path, followed by one more move.
    pub fn continued(&self, count: usize, target: Move) -> Self {
        let mut moves: Vec<Move> = self.moves.iter().take(count).copied().collect();
        moves.push(target);
        ManualPath {
            start: self.start,
            moves,
        }
    }

    /// Returns the part of this path that ends at a position of the animation. `stages` are the
    /// records of the path, of which the first `before` lead to its start. Before the first move,
    /// the part is a path without moves that starts at this position.
    pub fn until(&self, player: Player, stages: &[StageRecord], before: usize) -> Self {
        let indentation = player.indentation(stages);
        let Some(moves) = player.stage.checked_sub(before) else {
            // The stages before the start are those of the scene, the last one perhaps in part.
            let is_whole_stage = player.stage < self.start.stage;
            let at = match player.at {
                At::End if !is_whole_stage => self.start.at,
                At::PullOff => At::Indentation(indentation),
                at => at,
            };
            return ManualPath::starting_at(Player { at, ..player });
        };
        let mut kept = moves;
        let last = match player.at {
            At::Start => None,
            At::End => {
                kept += 1;
                None
            }
            At::Indentation(_) | At::Seconds(_) | At::PullOff => {
                Some(Move::ToIndentation(indentation))
            }
        };
        let mut moves: Vec<Move> = self.moves.iter().take(kept).copied().collect();
        moves.extend(last);
        ManualPath {
            start: self.start,
            moves,
        }
    }

    /// Returns the end of the path in words.
    fn end_in_words(&self) -> String {
        match self.moves.last() {
            Some(last) => format!("by hand to {}", in_words(*last)),
            None => "by hand, no move yet".to_owned(),
        }
    }
}

/// Returns the target of a move in words, such as `431 nm` or `separation`.
pub fn in_words(target: Move) -> String {
    loading_text(&[target], |value, unit| format_rounded(value, 3, unit))
}

/// Returns the change from one path to another in words; `None` if the paths are the same.
pub fn change_in_words(
    before: Option<&ManualPath>,
    present: Option<&ManualPath>,
) -> Option<String> {
    if before == present {
        return None;
    }
    Some(match present {
        Some(path) => path.end_in_words(),
        None => "without the path by hand".to_owned(),
    })
}
