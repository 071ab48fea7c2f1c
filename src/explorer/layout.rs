//! Positions of the panes on the screen: all four in a large window, fewer in a small one.

use super::app::App;
use super::pane::Pane;
use ratatui::layout::Rect;

/// Width of the histogram beside the profile, columns, with the line of its frame.
const HISTOGRAM_COLUMNS: u16 = 14;

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
        // The frame of the panes gives way before the panes.
        let footer = height >= 6;
        let top = if height >= 32 { 2 } else { u16::from(height >= 8) };
        let bottom = 1 + u16::from(footer);
        let body = Rect::new(0, top, width, height.saturating_sub(top + bottom));
        Layout {
            title: (top > 0).then(|| Rect { height: top, ..row(0) }),
            panes: panes(app, body),
            status: row(height.saturating_sub(bottom)),
            footer: footer.then(|| row(height - 1)),
        }
    }

    pub fn body(&self) -> Rect {
        self.panes.iter().map(|(_, area)| *area).reduce(Rect::union).unwrap_or_default()
    }

    /// The area of a pane with its frame; `None` for a pane that is not shown.
    pub fn pane(&self, wanted: Pane) -> Option<Rect> {
        self.panes.iter().find(|(pane, _)| *pane == wanted).map(|(_, area)| *area)
    }

    /// Width of the profile in cells, without its histogram.
    pub fn profile_cells(&self) -> usize {
        self.pane(Pane::Profile).map_or(0, |area| usize::from(split_profile(inside(area)).0.width))
    }

    pub fn close_up_cells(&self) -> usize {
        self.pane(Pane::CloseUp).map_or(0, |area| usize::from(inside(area).width))
    }
}

/// The area inside the frame of a pane; a pane too small for a frame has none.
pub fn inside(area: Rect) -> Rect {
    if is_framed(area) { area.inner(ratatui::layout::Margin::new(1, 1)) } else { area }
}

/// Returns true if a pane is large enough for a frame.
pub fn is_framed(area: Rect) -> bool {
    area.height >= 6 && area.width >= 16
}

/// Divides the area of the profile pane into the profile and the histogram beside it.
pub fn split_profile(area: Rect) -> (Rect, Option<Rect>) {
    if area.width < 3 * HISTOGRAM_COLUMNS {
        return (area, None);
    }
    let width = area.width - HISTOGRAM_COLUMNS;
    let histogram = Rect { x: area.x + width, width: HISTOGRAM_COLUMNS, ..area };
    (Rect { width, ..area }, Some(histogram))
}

fn panes(app: &App, body: Rect) -> Vec<(Pane, Rect)> {
    if body.is_empty() {
        return Vec::new();
    }
    if app.view.zoomed {
        return vec![(app.view.pane, body)];
    }
    if body.width >= 72 && body.height >= 14 {
        // Beyond 1129 columns the product exceeds 16 bits.
        let left = (u32::from(body.width) * 58 / 100) as u16;
        let upper = body.height / 2;
        let part = |x: u16, y: u16, width: u16, height: u16| Rect::new(body.x + x, body.y + y, width, height);
        if app.view.large == Some(Pane::Force) {
            return vec![
                (Pane::Force, part(0, 0, left, body.height)),
                (Pane::Parameters, part(left, 0, body.width - left, body.height)),
            ];
        }
        if let Some(pane) = app.view.large {
            return vec![
                (pane, part(0, 0, left, body.height)),
                (Pane::Force, part(left, 0, body.width - left, upper)),
                (Pane::Parameters, part(left, upper, body.width - left, body.height - upper)),
            ];
        }
        return vec![
            (Pane::Profile, part(0, 0, left, upper)),
            (Pane::Force, part(left, 0, body.width - left, upper)),
            (Pane::CloseUp, part(0, upper, left, body.height - upper)),
            (Pane::Parameters, part(left, upper, body.width - left, body.height - upper)),
        ];
    }
    // Too small for four: the most important ones, side by side or one above the other.
    let second = match app.view.pane {
        Pane::Force => match app.view.large {
            Some(Pane::Force) => Pane::Parameters,
            large => large.unwrap_or(Pane::Profile),
        },
        chosen => chosen,
    };
    if body.width >= 36 && body.height >= 6 {
        let left = body.width / 2;
        return vec![
            (Pane::Force, Rect { width: left, ..body }),
            (second, Rect { x: body.x + left, width: body.width - left, ..body }),
        ];
    }
    if body.height >= 12 {
        let upper = body.height / 2;
        return vec![
            (Pane::Force, Rect { height: upper, ..body }),
            (second, Rect { y: body.y + upper, height: body.height - upper, ..body }),
        ];
    }
    vec![(app.view.pane, body)]
}
