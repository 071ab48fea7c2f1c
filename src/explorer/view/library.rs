//! The library: scenes to choose from on the left, the selected one on the right.

use super::found::found;
use super::lines::{draw_lines, draw_reason};
use super::plot::draw_chart;
use super::wrap::wrapped;
use crate::explorer::mode::Library;
use crate::explorer::model::Model;
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::Meaning;
use crate::export::force_figure;
use crate::scene::{Entry, Source, format_quantity};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::{Block, Paragraph};

/// Draws the library.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model, library: &Library) {
    let theme = model.appearance.theme;
    let count = library.entries.as_ref().map_or(0, Vec::len);
    let block = Block::bordered()
        .border_style(theme.style(Meaning::Quiet))
        .title(format!(" Scenes, {} of {count} ", library.finder.found.len()));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let beside = inner.width >= 60;
    let list = Rect { width: if beside { inner.width * 2 / 5 } else { inner.width }, ..inner };
    draw_list(frame, list, model, library);
    if beside && let Some(entry) = library.entry() {
        let right = Rect { x: list.right() + 2, width: inner.width - list.width - 2, ..inner };
        draw_entry(frame, right, model, entry, &library.finder.query);
    }
}

fn draw_list(frame: &mut Frame<'_>, area: Rect, model: &Model, library: &Library) {
    let theme = model.appearance.theme;
    let Some(entries) = &library.entries else {
        return draw_reason(frame, area, "reading…", theme);
    };
    if library.finder.found.is_empty() {
        let reason =
            "no scene fits; Enter tries it as a path, such as ./scene.ron or that of a study's folder";
        return draw_reason(frame, area, reason, theme);
    }
    let first = (library.finder.selected + 1).saturating_sub(usize::from(area.height));
    for (row, place) in (area.y..area.bottom()).zip(first..library.finder.found.len()) {
        let Some(entry) = library.finder.found.get(place).and_then(|index| entries.get(*index)) else {
            continue;
        };
        let selected = place == library.finder.selected;
        let mark = match (entry.error(), selected) {
            (Some(_), _) => "!",
            (None, true) => "›",
            (None, false) => " ",
        };
        let style = if selected { Meaning::Selected } else { Meaning::Text };
        let style = theme.style(style);
        let mut line = Line::from(Text::styled(format!("{mark} "), style));
        line.extend(found(
            &Library::candidate(entry),
            &entry.name,
            &library.finder.query.text(),
            style,
            theme,
        ));
        line.push_span(Text::styled(format!("  {}", place_of(entry.origin)), theme.style(Meaning::Quiet)));
        draw_lines(frame, Rect { y: row, height: 1, ..area }, [line]);
    }
}

/// Origin of a scene, in words.
fn place_of(source: Source) -> &'static str {
    match source {
        Source::BuiltIn => "built-in",
        Source::Own => "own",
        Source::Working => "here",
    }
}

/// Title, notice, curve, and text of a scene.
fn draw_entry(frame: &mut Frame<'_>, area: Rect, model: &Model, entry: &Entry, query: &TextLine) {
    let theme = model.appearance.theme;
    let (candidate, query) = (Library::candidate(entry), query.text());
    let mark = |text: &str, meaning| Line::from(found(&candidate, text, &query, theme.style(meaning), theme));
    let mut lines = wrapped(&mark(entry.title(), Meaning::Title), area.width);
    let notice = entry.notice().split_whitespace().collect::<Vec<_>>().join(" ");
    lines.extend(wrapped(&mark(&notice, Meaning::Text), area.width));
    if let Some(error) = &entry.error() {
        lines.extend(wrapped(&Line::styled(format!("! {error}"), theme.style(Meaning::Error)), area.width));
    }
    let rows = (lines.len() as u16).min(area.height);
    frame.render_widget(Paragraph::new(lines), Rect { height: rows, ..area });
    let mut rest = Rect { y: area.y + rows, height: area.height - rows, ..area };
    let curve_rows = if rest.height >= 12 { rest.height / 2 } else { 0 };
    if curve_rows > 0 {
        draw_curve(frame, Rect { height: curve_rows, ..rest }, model, entry);
        rest = Rect { y: rest.y + curve_rows, height: rest.height - curve_rows, ..rest };
    }
    let text = entry.text.lines().map(|line| Line::styled(line.to_owned(), theme.style(Meaning::Quiet)));
    draw_lines(frame, rest, text);
}

fn draw_curve(frame: &mut Frame<'_>, area: Rect, model: &Model, entry: &Entry) {
    let theme = model.appearance.theme;
    let Some(preview) = model.preview.as_ref().filter(|preview| preview.text == entry.text) else { return };
    let outcome = match &preview.outcome {
        Ok(outcome) => outcome,
        Err(error) => {
            let lines = wrapped(&Line::styled(format!("! {error}"), theme.style(Meaning::Error)), area.width);
            return frame.render_widget(Paragraph::new(lines), area);
        }
    };
    let plot = Rect { y: area.y + 1, height: area.height - 2, ..area };
    let figure = force_figure(&[("", outcome)]);
    for chart in &figure.charts {
        let label = chart.y.label_with_unit().to_string();
        draw_lines(frame, area, [Line::styled(label, theme.style(Meaning::Quiet))]);
        draw_chart(frame, plot, chart, model.appearance);
    }
    let mut text = Vec::new();
    if let Some(force) = outcome.figures.adhesion_force {
        text.push(format!("F_a {}", format_quantity(force, "N")));
    }
    text.extend(outcome.regime.map(|regime| regime.by_protocol().to_owned()));
    let row = Rect { y: plot.bottom(), height: 1, ..area };
    frame.render_widget(Paragraph::new(text.join(" · ")).style(theme.style(Meaning::Title)), row);
}
