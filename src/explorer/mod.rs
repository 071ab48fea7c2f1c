//! The explorer: a blocking input thread and the worker send actions into one channel, `update`
//! changes the model, the views draw it. Nothing is computed on this thread and nothing wakes it while
//! nothing happens.

pub mod action;
pub mod adhesion_spread;
pub mod appraisal;
pub mod approximate;
mod caption;
pub mod chart;
mod close_up;
pub mod command;
mod completion;
pub mod config;
pub mod demo;
pub mod drafts;
mod effect;
pub mod engine;
mod file_job;
pub mod finder;
mod fuzzy;
pub mod headless;
mod input;
pub mod keys;
pub mod layout;
mod manual_body;
pub mod mode;
pub mod model;
mod opening;
mod palette;
pub mod panes;
pub mod parameters;
pub mod picture;
mod playback;
mod player;
pub mod request;
mod rescue;
mod screen;
mod session;
mod shown;
mod signals;
pub mod snapshot;
pub mod study;
mod terminal;
mod text_line;
pub mod theme;
mod unsaved;
pub mod update;
pub mod view;
pub mod worker;
mod writing;

pub use completion::complete;
pub use opening::{Opening, OpeningError};
pub use screen::{FrameBytes, Screen};
pub use session::{Draw, FRAME_RATE, Options, SessionEnd, open, open_with};
pub use signals::end_by;
pub use writing::{picture_of, scene_file, screenshot, write};
