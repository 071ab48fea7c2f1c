//! Draws the model. Nothing here changes it or computes anything.

mod accuracy;
mod beside;
mod chart;
mod chart_words;
mod chrome;
mod close_up;
mod force;
mod found;
mod help;
mod histogram;
mod lengths;
mod library;
mod palette;
mod parameters;
mod plot;
mod position;
mod preloads;
mod profile;
mod section;
mod sections;
mod spectrum;
mod stages;
mod typed;
mod wrap;

pub use chart::{map_figure, place_at};
pub use force::{indentation_at, stage_at};
pub use parameters::{first_listed, parameter_at};
pub use position::position_at;
pub use sections::section_cell;

use self::wrap::clipped;
use super::layout::{Layout, inside, is_framed};
use super::model::{Mode, Model, Pane};
use super::picture::to_ascii;
use super::theme::{Marker, Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::Line;
use ratatui::widgets::Block;

/// Draws the whole screen.
pub fn draw(frame: &mut Frame<'_>, model: &Model) {
    // The window may have another size by now than the model has been told.
    let area = frame.area();
    let layout = Layout::within(model, (area.width, area.height));
    if let Some(area) = layout.title {
        chrome::title(frame, area, model);
    }
    match &model.mode {
        Mode::Help { scroll } => {
            help::draw(frame, body(&layout), model.appearance.theme, &model.bindings, *scroll)
        }
        Mode::Library(library) => library::draw(frame, body(&layout), model, library),
        _ => {
            for &(pane, area) in &layout.panes {
                draw_pane(frame, area, model, pane);
            }
        }
    }
    if let Mode::Palette(finder) = &model.mode {
        palette::draw(frame, body(&layout), model.appearance.theme, &model.bindings, finder);
    }
    crate::draw::dry(frame.buffer_mut());
    chrome::status(frame, layout.status, model);
    if let Some(area) = layout.footer {
        chrome::footer(frame, area, model);
    }
    if model.appearance.theme == Theme::HighContrast {
        frame.buffer_mut().set_style(area, Modifier::BOLD);
    }
    if model.appearance.marker == Marker::Ascii {
        to_ascii(frame.buffer_mut());
    }
}

/// Share of the part of the profile that a pane shows, under a column of the screen; `None` for a pane without profile.
#[must_use]
pub fn share_at(model: &Model, pane: Pane, area: Rect, column: u16) -> Option<f64> {
    match pane {
        Pane::Profile => profile::share_at(model, area, column),
        Pane::CloseUp if !model.lengths => close_up::share_at(model, area, column),
        _ => None,
    }
}

/// Area of the panes.
fn body(layout: &Layout) -> Rect {
    layout.panes.iter().map(|(_, area)| *area).reduce(Rect::union).unwrap_or_default()
}

/// Lines the help can be scrolled down.
#[must_use]
pub fn help_end(model: &Model) -> u16 {
    help::last_scroll(body(&Layout::of(model)), &model.bindings)
}

fn draw_pane(frame: &mut Frame<'_>, area: Rect, model: &Model, pane: Pane) {
    if is_framed(area) {
        let chosen = model.pane == pane;
        let name = match pane {
            Pane::Force => force::title(model),
            Pane::Profile => profile::title(model),
            Pane::CloseUp if model.lengths => lengths::TITLE.to_owned(),
            Pane::CloseUp if model.side_by_side => beside::title(model),
            Pane::CloseUp => close_up::title(model),
            Pane::Parameters => " Parameters ".to_owned(),
            Pane::Accuracy => accuracy::TITLE.to_owned(),
            Pane::Chart => chart_words::title(model),
            Pane::Spectrum => spectrum::TITLE.to_owned(),
            Pane::Preloads => preloads::TITLE.to_owned(),
        };
        let style = model.appearance.theme.style(if chosen { Meaning::Title } else { Meaning::Quiet });
        let mark = if chosen { "▸" } else { "" };
        let title = Line::styled(format!("{mark}{name}"), style);
        let room = area.width - 2;
        let title = if title.width() > usize::from(room) { clipped(title, room) } else { title };
        let block = Block::bordered().border_style(model.appearance.theme.style(Meaning::Quiet)).title(title);
        let names = match pane {
            Pane::Force => force::reading(model, area),
            Pane::Profile => profile::names(model, area),
            Pane::CloseUp if !model.lengths && !model.side_by_side => close_up::names(model, area),
            _ => None,
        };
        frame.render_widget(names.into_iter().fold(block, Block::title_bottom), area);
    }
    let edge = area.right().saturating_sub(1);
    let area = inside(area);
    match pane {
        Pane::Force => force::draw(frame, area, model),
        Pane::Profile => profile::draw(frame, area, model),
        Pane::CloseUp if model.lengths => lengths::draw(frame, area, model),
        Pane::CloseUp if model.side_by_side => beside::draw(frame, area, model),
        Pane::CloseUp => close_up::draw(frame, area, model),
        Pane::Parameters => parameters::draw(frame, area, edge, model),
        Pane::Accuracy => accuracy::draw(frame, area, model),
        Pane::Chart => chart::draw(frame, area, model),
        Pane::Spectrum => spectrum::draw(frame, area, model),
        Pane::Preloads => preloads::draw(frame, area, model),
    }
}
