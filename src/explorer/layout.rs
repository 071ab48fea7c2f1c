//! Positions of the panes on the screen: all four in a large window, fewer in a small one.

use super::app::App;
use super::pane::Pane;
use asperity_plot::split;
use ratatui::layout::Rect;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub title: Option<Rect>,
    pub panes: Vec<(Pane, Rect)>,
    /// Lines with the headline figures, or with the typed text.
    pub status: Rect,
    pub footer: Option<Rect>,
}

impl Layout {
    /// The layout of the explorer's state in its own window.
    pub fn of(app: &App) -> Self {
        Layout::within(app, app.view.size)
    }

    /// The layout in a window of this width and height, in cells.
    pub fn within(app: &App, (width, height): (u16, u16)) -> Self {
        let row = |y: u16| Rect::new(0, y, width, 1).intersection(Rect::new(0, 0, width, height));
        // The lines around the panes give way before the panes.
        let footer = height >= 6;
        let top = if height >= 32 {
            2
        } else {
            u16::from(height >= 8)
        };
        let bottom = 1 + u16::from(footer);
        let body = Rect::new(0, top, width, height.saturating_sub(top + bottom));
        Layout {
            title: (top > 0).then(|| Rect {
                height: top,
                ..row(0)
            }),
            panes: panes(app, body),
            status: row(height.saturating_sub(bottom)),
            footer: footer.then(|| row(height - 1)),
        }
    }

    pub fn body(&self) -> Rect {
        self.panes
            .iter()
            .map(|(_, area)| *area)
            .reduce(Rect::union)
            .unwrap_or_default()
    }

    /// The area of a pane with its title; `None` for a pane that is not shown.
    pub fn pane(&self, wanted: Pane) -> Option<Rect> {
        self.panes
            .iter()
            .find(|(pane, _)| *pane == wanted)
            .map(|(_, area)| *area)
    }

    /// Width of the profile in cells, without its histogram.
    pub fn profile_cells(&self) -> usize {
        self.pane(Pane::Profile)
            .map_or(0, |area| usize::from(split(inside(area)).0.width))
    }

    pub fn close_up_cells(&self) -> usize {
        self.pane(Pane::CloseUp)
            .map_or(0, |area| usize::from(inside(area).width))
    }
}

/// The area below the title of a pane, without a blank column on the right; a pane too small for a
/// title has none.
pub fn inside(area: Rect) -> Rect {
    if !has_title(area) {
        return area;
    }
    Rect {
        y: area.y + 1,
        height: area.height - 1,
        width: area.width - 1,
        ..area
    }
}

/// Returns true if a pane is large enough for a title.
pub fn has_title(area: Rect) -> bool {
    area.height >= 5 && area.width >= 16
}

/// Smallest window, columns, with the list of parameters at the side, and the least and the largest
/// width of the list.
const WITH_LIST: u16 = 60;
const LIST: (u16, u16) = (32, 48);
/// Smallest number of rows with panes below the main pane, and of columns with two panes there.
const WITH_LOWER: u16 = 20;
const WITH_CLOSE_UP: u16 = 60;
/// Smallest number of rows of a narrow window with several rows of the list.
const WITH_ROWS: u16 = 16;

/// The main pane, which is the force curve unless another one takes its place, has the most room;
/// the list of parameters has the height of the window. Small windows give up the close-up, the
/// profile and the list, but for its selected row.
fn panes(app: &App, body: Rect) -> Vec<(Pane, Rect)> {
    if body.is_empty() {
        return Vec::new();
    }
    let selected = app.view.pane;
    if app.view.zoomed {
        return vec![(selected, body)];
    }
    let main = app.view.large.unwrap_or(Pane::Force);
    let is_list = selected == Pane::Parameters;
    let only = if is_list { main } else { selected };
    if body.width < WITH_LIST {
        let rows = match body.height {
            0..3 => return vec![(selected, body)],
            _ if is_list => return vec![(selected, body)],
            WITH_ROWS.. => 2 * body.height / 5,
            _ => 1,
        };
        let height = body.height - rows;
        let list = Rect {
            y: body.y + height,
            height: rows,
            ..body
        };
        return vec![(only, Rect { height, ..body }), (Pane::Parameters, list)];
    }
    let list = (u32::from(body.width) * 35 / 100).clamp(LIST.0.into(), LIST.1.into()) as u16;
    let left = Rect {
        width: body.width - list,
        ..body
    };
    let list = (
        Pane::Parameters,
        Rect {
            x: left.right(),
            width: list,
            ..body
        },
    );
    // All that it states needs the height of the window.
    let is_alone = main == Pane::Trust && selected != Pane::Force;
    if body.height < WITH_LOWER || is_alone {
        return vec![(only, left), list];
    }
    let upper = Rect {
        height: (u32::from(body.height) * 62 / 100) as u16,
        ..left
    };
    let lower = Rect {
        y: upper.bottom(),
        height: left.height - upper.height,
        ..left
    };
    let below = match app.view.large {
        Some(_) => vec![(Pane::Force, lower)],
        None if left.width >= WITH_CLOSE_UP => {
            let profile = Rect {
                width: lower.width * 3 / 5,
                ..lower
            };
            let close_up = Rect {
                x: profile.right(),
                width: lower.width - profile.width,
                ..lower
            };
            vec![(Pane::Profile, profile), (Pane::CloseUp, close_up)]
        }
        None if selected == Pane::CloseUp => vec![(Pane::CloseUp, lower)],
        None => vec![(Pane::Profile, lower)],
    };
    [(main, upper)]
        .into_iter()
        .chain(below)
        .chain([list])
        .collect()
}
