//! Positions of the panes on the screen. A large window shows four panes, a small window fewer.

use super::app::App;
use super::pane::Pane;
use asperity_plot::split;
use ratatui::layout::Rect;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub title: Option<Rect>,
    pub panes: Vec<(Pane, Rect)>,
    /// Lines below the panes, for the main results or for the line that the user is typing.
    pub status: Rect,
    pub footer: Option<Rect>,
}

impl Layout {
    /// Returns the layout for the present size of the window.
    pub fn of(app: &App) -> Self {
        Layout::within(app, app.view.size)
    }

    /// Returns the layout for a window of this size, in columns and rows.
    pub fn within(app: &App, size: (u16, u16)) -> Self {
        let (width, height) = size;
        // In a small window, the lines around the panes are left out first, and panes only if this
        // is not enough.
        let has_footer = height >= 6;
        // A second line of the title is for a notice that does not fit into the first one, also
        // after the scene has changed and the notice is hidden.
        let has_second = height >= 32 && app.title().columns() > width.into();
        let top = if has_second {
            2
        } else {
            u16::from(height >= 8)
        };
        let bottom = 1 + u16::from(has_footer);
        let window = Rect::new(0, 0, width, height);
        let line = Rect::new(0, 0, width, 1);
        let title = Rect {
            height: top,
            ..line.intersection(window)
        };
        let status = Rect {
            y: height.saturating_sub(bottom),
            ..line
        };
        let footer = Rect {
            y: height.saturating_sub(1),
            ..line
        };
        let body = Rect::new(0, top, width, height.saturating_sub(top + bottom));
        Layout {
            title: if top > 0 { Some(title) } else { None },
            panes: panes(app, body),
            status: status.intersection(window),
            footer: if has_footer {
                Some(footer.intersection(window))
            } else {
                None
            },
        }
    }

    pub fn body(&self) -> Rect {
        self.panes
            .iter()
            .map(|(_, area)| *area)
            .reduce(Rect::union)
            .unwrap_or_default()
    }

    /// Returns the area of a pane including its title; `None` if the pane is not shown.
    pub fn pane(&self, wanted: Pane) -> Option<Rect> {
        let mut panes = self.panes.iter();
        let (_, area) = panes.find(|(pane, _)| *pane == wanted)?;
        Some(*area)
    }

    /// Returns the width of the profile in columns, without the histogram of heights beside it.
    pub fn profile_cells(&self) -> usize {
        let Some(area) = self.pane(Pane::Profile) else {
            return 0;
        };
        let (profile, _) = split(inside(area));
        profile.width.into()
    }

    pub fn close_up_cells(&self) -> usize {
        self.pane(Pane::CloseUp)
            .map_or(0, |area| usize::from(inside(area).width))
    }
}

/// Returns the area of a pane for its content: below the title and without the last column, which
/// stays blank. A wide pane that is too low for a title has a blank last column too. If the pane is
/// too small for both, returns the whole `area`.
pub fn inside(area: Rect) -> Rect {
    if !has_title(area) {
        let is_wide = area.width >= WITH_BLANK_COLUMN;
        return Rect {
            width: area.width - u16::from(is_wide),
            ..area
        };
    }
    Rect {
        y: area.y + 1,
        height: area.height - 1,
        width: area.width - 1,
        ..area
    }
}

/// Smallest width in columns of a low pane whose last column stays blank.
const WITH_BLANK_COLUMN: u16 = 40;

/// Returns true if a pane of this size has a title.
pub fn has_title(area: Rect) -> bool {
    area.height >= 5 && area.width >= 16
}

/// Smallest width in columns of a window with the list of parameters at the right side.
const WITH_LIST: u16 = 60;
/// Smallest width in columns of a window with the selected pane of accuracy and the list of
/// parameters.
const WITH_TRUST: u16 = 100;
/// Smallest width in columns of the list of parameters at the side.
const NARROWEST_LIST: u16 = 32;
/// Largest width in columns of the list of parameters at the side.
const WIDEST_LIST: u16 = 54;
/// Smallest height in rows of the area on the left if it has both the residuals of a measured curve
/// and the timeline.
const WITH_BOTH_STRIPS: u16 = 26;
/// Smallest height in rows of the area on the left if it has panes below the main pane.
const WITH_LOWER: u16 = 20;
/// Smallest width in columns of the area on the left if it has two panes below the main pane.
const WITH_CLOSE_UP: u16 = 60;
/// Smallest height in rows of a narrow window that shows several rows of the list of parameters.
const WITH_ROWS: u16 = 16;

/// Returns the panes that the window shows, with their areas. The main pane is the largest: the
/// force curve, unless another pane has taken its place. The list of parameters at the side is as
/// high as the window. As the window becomes smaller, first the close-up is left out, then the
/// profile, and finally the list except for its selected row.
fn panes(app: &App, body: Rect) -> Vec<(Pane, Rect)> {
    if body.is_empty() {
        return Vec::new();
    }
    let selected = app.view.pane;
    // The pane of accuracy has tables and a chart, which need the whole width of a small window.
    let is_whole = selected == Pane::Trust && body.width < WITH_TRUST;
    if app.view.zoomed || is_whole {
        return vec![(selected, body)];
    }
    if body.width < WITH_LIST {
        return panes_of_narrow(app, body);
    }
    let share = (u32::from(body.width) * 35 / 100) as u16;
    let list_width = share.clamp(NARROWEST_LIST, WIDEST_LIST);
    let left = Rect {
        width: body.width - list_width,
        ..body
    };
    let right = Rect {
        x: left.right(),
        width: list_width,
        ..body
    };
    let mut panes = panes_beside_list(app, left);
    panes.extend(panes_of_list(app, right));
    panes
}

/// Smallest height in rows of the area beside the panes for results below the list of parameters.
const WITH_RESULT: u16 = 20;
/// Height in rows from which both the results and the list of events are below the parameters.
const WITH_BOTH: u16 = 40;

/// Rows of the pane of parameters beside the list: title, derived values and explanation.
const BESIDE_PARAMETERS: u16 = 8;
/// Smallest height in rows of a list of events that is shown because there is room for it.
const FEWEST_EVENT_ROWS: u16 = 6;

/// Returns the list of parameters, and below it the results or the list of events or, in a high
/// window, both. If the parameters leave enough rows free, the list of events is always shown.
fn panes_of_list(app: &App, area: Rect) -> Vec<(Pane, Rect)> {
    if area.height < WITH_RESULT {
        return vec![(Pane::Parameters, area)];
    }
    let result_rows = match area.height {
        32.. => 10,
        26.. => 8,
        _ => 5,
    };
    // Rows that neither the parameters nor the results need.
    let needed = u16::try_from(app.edit.parameters.len()).unwrap_or(u16::MAX);
    let spare = area
        .height
        .saturating_sub(needed.saturating_add(BESIDE_PARAMETERS + result_rows));
    let has_room = spare >= FEWEST_EVENT_ROWS;
    let lists_both = app.view.lists_events && area.height >= WITH_BOTH;
    let mut lower = Vec::new();
    if !app.view.lists_events || lists_both {
        lower.push((Pane::Result, result_rows));
    }
    if lists_both {
        lower.push((Pane::Events, spare.max(12)));
    } else if app.view.lists_events {
        lower.push((Pane::Events, area.height / 2));
    } else if has_room {
        lower.push((Pane::Events, spare));
    }
    let taken: u16 = lower.iter().map(|(_, rows)| rows).sum();
    let mut panes = vec![(
        Pane::Parameters,
        Rect {
            height: area.height - taken,
            ..area
        },
    )];
    let mut y = area.bottom() - taken;
    for (pane, height) in lower {
        panes.push((pane, Rect { y, height, ..area }));
        y += height;
    }
    panes
}

/// Returns the height in rows of the timeline in an area of this height: a row of ticks and the
/// stages; in a higher area also a title and further rows of ticks.
fn timeline_rows(height: u16) -> u16 {
    match height {
        32.. => 4,
        26.. => 3,
        WITH_LOWER.. => 2,
        _ => 0,
    }
}

/// Returns the pane that has the main place.
fn main_pane(app: &App) -> Pane {
    app.view.large.unwrap_or(Pane::Force)
}

/// Returns the pane to show beside the list of parameters if there is room for only one pane.
fn only_pane(app: &App) -> Pane {
    if app.view.pane == Pane::Parameters {
        main_pane(app)
    } else {
        app.view.pane
    }
}

/// Returns the panes of a window that is too narrow for the list of parameters at the side: one
/// pane, and some rows of the list below this pane.
fn panes_of_narrow(app: &App, body: Rect) -> Vec<(Pane, Rect)> {
    let selected = app.view.pane;
    if body.height < 3 || selected == Pane::Parameters {
        return vec![(selected, body)];
    }
    let rows = if body.height >= WITH_ROWS {
        2 * body.height / 5
    } else {
        1
    };
    let upper = Rect {
        height: body.height - rows,
        ..body
    };
    let lower = Rect {
        y: upper.bottom(),
        height: rows,
        ..body
    };
    vec![(only_pane(app), upper), (Pane::Parameters, lower)]
}

/// Returns the panes on the left of the list of parameters: the main pane, and the other panes
/// below it.
fn panes_beside_list(app: &App, left: Rect) -> Vec<(Pane, Rect)> {
    let main = main_pane(app);
    // The pane of accuracy needs the whole height of the window for its lines.
    let is_alone = main == Pane::Trust && app.view.pane != Pane::Force;
    if left.height < WITH_LOWER || is_alone {
        return vec![(only_pane(app), left)];
    }
    // In a low window, the residuals of a measured curve need the rows of the timeline.
    let is_crowded = app.edit.measured.is_some() && left.height < WITH_BOTH_STRIPS;
    let timeline_rows = if app.view.large.is_some() || is_crowded {
        0
    } else {
        timeline_rows(left.height)
    };
    let upper = Rect {
        height: (u32::from(left.height - timeline_rows) * 62 / 100) as u16,
        ..left
    };
    let timeline = Rect {
        y: upper.bottom(),
        height: timeline_rows,
        ..left
    };
    let lower = Rect {
        y: timeline.bottom(),
        height: left.height - upper.height - timeline_rows,
        ..left
    };
    let mut panes = vec![(main, upper)];
    if timeline_rows > 0 {
        panes.push((Pane::Timeline, timeline));
    }
    if app.view.large.is_some() {
        panes.push((Pane::Force, lower));
    } else if left.width >= WITH_CLOSE_UP {
        let profile = Rect {
            width: lower.width * 3 / 5,
            ..lower
        };
        let close_up = Rect {
            x: profile.right(),
            width: lower.width - profile.width,
            ..lower
        };
        panes.push((Pane::Profile, profile));
        panes.push((Pane::CloseUp, close_up));
    } else if app.view.pane == Pane::CloseUp {
        panes.push((Pane::CloseUp, lower));
    } else {
        panes.push((Pane::Profile, lower));
    }
    panes
}
