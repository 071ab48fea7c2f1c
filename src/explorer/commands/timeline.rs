//! Commands of the timeline and of the list of events: steps from event to event, moves of the
//! playhead (the position of the animation), and the speed of the animation.

use crate::explorer::app::App;
use crate::explorer::keys::key::direction;
use crate::explorer::pane::Pane;
use crate::explorer::player::{At, Player};
use crate::explorer::request::Focus;
use crate::explorer::timeline::{Timeline, next, passed, position_of, previous, speed_in_words};
use asperity_contact::Event;
use crossterm::event::{KeyCode, KeyEvent};

/// Parts of a loading stage over which the playhead moves by a small and by a large step.
const SMALL_STEP: f64 = 1.0 / 120.0;
const LARGE_STEP: f64 = 1.0 / 12.0;
/// Slowest and fastest speed of the animation that the keys reach.
const SPEEDS: [f64; 2] = [0.25, 8.0];
/// Number of columns on each side of a click in which the click selects a jump.
const NEAR_TICK: usize = 1;

/// Moves the animation to the next event, or to the event before if `forwards` is false.
pub fn go_to_event(app: &mut App, forwards: bool) {
    let Some(list) = listed(app) else {
        return;
    };
    let stages = app.played_stages();
    let player = app.playhead();
    let found = if forwards {
        next(stages, &list, player)
    } else {
        previous(stages, &list, player)
    };
    match found {
        Some(index) => show(app, &list[index]),
        None if list.is_empty() => app.set_done("there is no jump and no mark on this loading"),
        None if forwards => app.set_done("this was the last event"),
        None => app.set_done("this was the first event"),
    }
}

/// Returns the listed events. If there are none yet or if they cannot be listed, a message states
/// it.
fn listed(app: &mut App) -> Option<Vec<Event>> {
    let found = match app.listed_events() {
        Some(Ok(listed)) => Ok(listed.list.clone()),
        Some(Err(why)) => Err(why.to_owned()),
        None => Err("the jumps are being listed…".to_owned()),
    };
    match found {
        Ok(list) => Some(list),
        Err(why) => {
            app.set_done(why);
            None
        }
    }
}

/// Moves the animation to an event. The close-up shows the patch that changes.
fn show(app: &mut App, event: &Event) {
    let player = position_of(app.played_stages(), event);
    if let Some(jump) = event.jump
        && let Some(patch) = jump.after.or(jump.before)
    {
        app.view.close_up.focus = Focus::Spring(patch.middle());
    }
    app.set_playhead(player);
}

/// Selects another event in the list, by the pressed key, and moves the animation there.
pub fn select_event(app: &mut App, key: &KeyEvent) {
    let Some(list) = listed(app) else {
        return;
    };
    let Some(last) = list.len().checked_sub(1) else {
        return;
    };
    let present = passed(app.played_stages(), &list, app.playhead()).saturating_sub(1);
    let page = 10;
    let index = match key.code {
        KeyCode::Up | KeyCode::Char('k') => return go_to_event(app, false),
        KeyCode::Down | KeyCode::Char('j') => return go_to_event(app, true),
        KeyCode::PageUp => present.saturating_sub(page),
        KeyCode::PageDown => (present + page).min(last),
        KeyCode::Home | KeyCode::Char('g') => 0,
        _ => last,
    };
    show(app, &list[index]);
}

/// Moves the animation to the event in a row of the list.
pub fn select_row(app: &mut App, row: usize) {
    if let Some(list) = listed(app)
        && let Some(event) = list.get(row)
    {
        show(app, event);
    }
}

/// Moves the playhead along the loading by a small or a large step or to an end, depending on the
/// pressed key.
pub fn step(app: &mut App, key: &KeyEvent) {
    let Some(direction) = direction(key) else {
        return go_to_end(app, matches!(key.code, KeyCode::End | KeyCode::Char('G')));
    };
    let size = if direction.is_coarse {
        LARGE_STEP
    } else {
        SMALL_STEP
    };
    let share = f64::from(direction.columns) * size;
    let stages = app.played_stages();
    let player = Player {
        playing: false,
        ..app.playhead()
    };
    let reached = player.share(stages) + share;
    let moved = if reached > 1.0 && player.stage + 1 < stages.len() {
        Player {
            stage: player.stage + 1,
            at: At::Start,
            ..player
        }
    } else if reached < 0.0 && player.stage > 0 {
        Player {
            stage: player.stage - 1,
            at: At::End,
            ..player
        }
    } else {
        Player {
            at: player.advanced(stages, share),
            ..player
        }
    };
    app.set_playhead(moved);
}

/// Moves the playhead to the beginning of the loading or, if `forwards` is true, to its end.
fn go_to_end(app: &mut App, forwards: bool) {
    let player = if forwards {
        Player {
            stage: app.played_stages().len().saturating_sub(1),
            at: At::End,
            playing: false,
        }
    } else {
        Player {
            playing: false,
            ..Player::START
        }
    };
    app.set_playhead(player);
}

/// Doubles or halves the speed of the animation.
pub fn change_speed(app: &mut App, key: &KeyEvent) {
    let factor = if key.code == KeyCode::Char('-') {
        0.5
    } else {
        2.0
    };
    let [slowest, fastest] = SPEEDS;
    app.config.speed = (app.config.speed * factor).clamp(slowest, fastest);
    // In a low window, the timeline has no title with the speed.
    app.set_done(format!("speed {}", speed_in_words(app.config.speed)));
}

/// Repeats the animation from its beginning when it has reached its end, or stops it there.
pub fn toggle_repeat(app: &mut App) {
    app.config.repeat ^= true;
    let text = if app.config.repeat {
        "the animation repeats"
    } else {
        "the animation stops at its end"
    };
    app.set_done(text);
}

/// Lists smaller jumps as well or, if `more` is false, only larger ones.
pub fn change_listed(app: &mut App, more: bool) {
    let share = app.view.least_share;
    let changed = if more {
        share.smaller()
    } else {
        share.larger()
    };
    match changed {
        Some(changed) => app.view.least_share = changed,
        None if more => app.set_done("all jumps are listed already"),
        None => app.set_done("the jumps from 10 % of the largest energy are the fewest"),
    }
}

/// Shows the list of events in place of the results, or the results again.
pub fn toggle_events(app: &mut App) {
    let shows = app.view.pane == Pane::Events || app.view.lists_events;
    app.view.lists_events = !shows;
    app.view.pane = if shows { Pane::Force } else { Pane::Events };
}

/// Moves the playhead to a column of the timeline, which is `columns` wide. If a tick is at or
/// beside the column, the playhead moves to the largest jump of this tick.
pub fn go_to_column(app: &mut App, column: usize, columns: usize) {
    let stages = app.played_stages();
    let timeline = Timeline::new(stages, columns);
    if let Some(Ok(events)) = app.listed_events()
        && let Some(event) = jump_near(&timeline, &events.list, column)
    {
        return show(app, &event);
    }
    if let Some((stage, share)) = timeline.position(column) {
        let player = Player {
            stage,
            at: At::Start,
            playing: false,
        };
        let at = player.advanced(stages, share);
        app.set_playhead(Player { at, ..player });
    }
}

/// Returns the largest jump whose tick is at or beside a column. A tick in the column itself comes
/// first.
fn jump_near(timeline: &Timeline, events: &[Event], column: usize) -> Option<Event> {
    let mut found: Option<(usize, f64, Event)> = None;
    for event in events {
        let (Some(jump), Some(place)) = (event.jump, timeline.column_of(event)) else {
            continue;
        };
        let distance = place.abs_diff(column);
        if distance > NEAR_TICK {
            continue;
        }
        let energy = jump.energy.abs();
        let is_better = found
            .as_ref()
            .is_none_or(|(nearest, largest, _)| (distance, -energy) < (*nearest, -largest));
        if is_better {
            found = Some((distance, energy, *event));
        }
    }
    found.map(|(_, _, event)| event)
}
