//! The screen of the explorer after each key, in large windows and small ones, with colours and
//! without.

mod chrome;
mod compare;
mod crosshair;
mod demo;
mod edit;
mod effects;
mod failures;
mod files;
mod library;
mod look;
mod manual;
mod map;
mod map_over;
mod measured;
mod mouse;
mod palette;
mod panes;
mod parameters;
mod patches;
mod play;
pub mod preloads;
mod profiles;
mod saving;
mod sensitivity;
mod sizes;
mod spectrum;
mod stages;
mod studies;
mod study;
mod target;
mod timeline;
mod tour;
mod trust;
mod typing;

use super::common;
use super::common::driver::{APPEARANCE, Driver, REFUSED};
use super::common::scenes::{
    changed, one_spring, punch, relaxing, rough, smooth, without_adhesion,
};
use asperity::data::format_quantity;
use asperity::explorer::action::{Action, Gesture, Task};
use asperity::explorer::app::{App, Message};
use asperity::explorer::commands::table::bindings;
use asperity::explorer::keys::bindings::Context;
use asperity::explorer::layout::Layout;
use asperity::explorer::opening::Opening;
use asperity::explorer::pane::Pane;
use asperity::explorer::snapshot::Reply;
use asperity::explorer::studies::Study;
use asperity::scene::Simulation;
use asperity::scene::{Document, open, presets};
use preloads::computed_preloads;
use ratatui::buffer::Cell;
use ratatui::style::Modifier;
use sensitivity::computed_sensitivity;
use std::fs;
use std::path::Path;

/// Windows, columns and rows.
const SIZES: [(u16, u16); 5] = [(120, 40), (80, 24), (60, 20), (40, 12), (20, 5)];

/// The scene the explorer opens on.
fn default_scene() -> Document {
    open(asperity::scene::library::DEFAULT).unwrap()
}

/// Half way through the retraction, paused.
fn mid_retraction(document: Document) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space >");
    driver.elapse(3.0);
    assert_eq!((driver.app.play.stage, driver.app.play.playing), (1, false));
    while driver.app.play.share(driver.app.stages()) < 0.5 {
        steps(&mut driver, "Right");
    }
    driver
}

/// The rough scene half way through its retraction, its Hurst exponent selected, and then some
/// keys.
fn pressed(keys: &str) -> Driver {
    let mut driver = mid_retraction(rough());
    driver.select("roughness.hurst");
    driver.press(keys);
    driver
}

/// Moves the playhead by keys of the timeline, whichever pane is selected.
fn steps(driver: &mut Driver, keys: &str) {
    let pane = std::mem::replace(&mut driver.app.view.pane, Pane::Timeline);
    driver.press(keys.trim());
    driver.app.view.pane = pane;
}

/// Explorers in every mode and pane.
fn everywhere() -> Vec<Driver> {
    let keys = ";?;e;Enter;s;s Enter s Enter;l q;z;Tab z;Tab Tab z;Tab Tab Tab z;d 1;E;o;/ h u;: m a p;d Shift+Left Right;c L a v;N;A;A z;\
                Q;Q z;% 1;y;m;m z;i;*;* Tab Right;* v Right;i z";
    let mut all: Vec<Driver> = keys.split(';').map(pressed).collect();
    all.push(Driver::open(rough()));
    all.push(trust::measured(rough()));
    all.push(computed_sensitivity(rough()));
    all.extend(["", "V", "V V", "z"].map(|keys| {
        let mut driver = map::mapped(rough());
        driver.press(keys);
        driver
    }));
    all.extend(["", "V V", "W", "V V V z"].map(|keys| {
        let (_folder, mut driver) = study::opened();
        driver.press(keys);
        driver
    }));
    let mut refused = pressed("");
    refused.enter("nothing");
    all.push(refused);
    all
}

fn reversed(cells: &[Cell]) -> String {
    cells
        .iter()
        .filter(|cell| cell.modifier.contains(Modifier::REVERSED))
        .map(Cell::symbol)
        .collect()
}

/// True if the outcome shown is that of the present scene.
fn is_up_to_date(app: &App) -> bool {
    app.solved
        .as_ref()
        .is_some_and(|computed| computed.generation == app.edit.generation)
        && app
            .snapshot
            .as_ref()
            .is_some_and(|snapshot| snapshot.generation == app.edit.generation)
        && !app.is_computing()
}
