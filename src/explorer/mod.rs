//! The explorer. Threads for the input, the solver and the studies (background computations) send
//! actions through one channel to the main thread. There `update` changes the state, and the views
//! draw it. The main thread computes no contact, and sleeps while there are no actions.

// This module is public only for the tests. Documentation of every item would repeat its name and
// its type.
#![allow(missing_docs)]

pub mod action;
pub mod advice;
pub mod app;
pub mod autosave;
mod caption;
pub mod cell_writer;
mod close_up;
pub mod command_line;
pub mod commands;
mod completion;
pub mod config;
pub mod cursor;
pub mod curve_options;
#[cfg(unix)]
pub mod decoder;
pub mod demo;
pub mod editor;
pub mod events;
pub mod ghost;
pub mod input;
pub mod keys;
pub mod layout;
mod manual_body;
pub mod manual_path;
pub mod map_state;
pub mod measured;
mod mouse;
pub mod openable;
pub mod opening;
mod pacing;
pub mod pane;
pub mod panel;
pub mod panes;
pub mod parameters;
pub mod pen;
pub mod player;
mod playhead;
pub mod profiles;
pub mod prompt;
pub mod recognition;
pub mod request;
pub mod runtime;
pub mod scene_title;
mod search;
pub mod session;
mod shown_ensemble;
mod shown_map;
pub mod signals;
pub mod snapshot;
pub mod solver;
pub mod studies;
mod terminal;
pub mod terminal_input;
mod text;
mod text_line;
pub mod theme;
mod timeline;
mod typed;
pub mod update;
pub mod view;
pub mod writing;
