//! Text that has to fit into a number of columns of the screen. It is broken into lines between
//! words, composed of parts that stay whole, or shortened with `…`.
//!
//! ratatui can break lines too. But if a word has wide characters or begins with a combining mark,
//! ratatui writes beyond its area and panics. Titles and typed values may contain such words.

use asperity_data::{belong_together, format_range, format_rounded};
use ratatui::style::Style;
use ratatui::text::{Line, Span, StyledGrapheme};

/// Pieces of styled text that are shown either together or not at all.
pub type Part = Vec<Span<'static>>;

/// Returns a range such as the quartiles as text, with two digits or, if its ends would then be the
/// same, with three.
pub fn range_in_words(range: (f64, f64), unit: &str) -> String {
    let (low, high) = range;
    let is_same = format_rounded(low, 2, unit) == format_rounded(high, 2, unit);
    format_range(range, if is_same { 3 } else { 2 }, unit)
}

/// Breaks a line into lines of at most this number of columns. A word that is wider than a line is
/// broken anywhere. The digits of a number and its unit are kept together unless they are wider
/// than a line.
pub fn wrapped(line: &Line<'_>, columns: u16) -> Vec<Line<'static>> {
    let room = usize::from(columns);
    let graphemes: Vec<_> = line.styled_graphemes(Style::default()).collect();
    let words: Vec<_> = graphemes.split_inclusive(is_blank).collect();
    let mut lines: Vec<Vec<StyledGrapheme<'_>>> = vec![Vec::new()];
    for together in words.chunk_by(|word, next| belong_together(&text_of(word), &text_of(next))) {
        let symbols = together.concat();
        let last = lines.len() - 1;
        // A blank at the end of a line needs no column.
        let blank_end = usize::from(symbols.last().is_some_and(is_blank));
        let needed = width(&symbols).saturating_sub(blank_end);
        if !lines[last].is_empty() && width(&lines[last]) + needed > room {
            lines.push(Vec::new());
        }
        for grapheme in symbols {
            let last = lines.len() - 1;
            let more = width(std::slice::from_ref(&grapheme));
            if more > room {
                continue;
            }
            let is_full = width(&lines[last]) + more > room;
            if is_blank(&grapheme) && (is_full || lines[last].is_empty()) {
                continue;
            }
            if is_full {
                lines.push(vec![grapheme]);
            } else {
                lines[last].push(grapheme);
            }
        }
    }
    lines.retain(|line| !line.is_empty());
    lines.iter().map(|line| styled(line)).collect()
}

fn is_blank(grapheme: &StyledGrapheme<'_>) -> bool {
    grapheme.symbol.trim().is_empty()
}

/// Returns the width of the graphemes in columns.
fn width(graphemes: &[StyledGrapheme<'_>]) -> usize {
    graphemes
        .iter()
        .map(|grapheme| Span::raw(grapheme.symbol).width())
        .sum()
}

/// Returns the text of a word without blanks.
fn text_of(word: &[StyledGrapheme<'_>]) -> String {
    word.iter()
        .filter(|grapheme| !is_blank(grapheme))
        .map(|grapheme| grapheme.symbol)
        .collect()
}

/// Joins graphemes to a line. Successive graphemes of the same style become one span.
fn styled(graphemes: &[StyledGrapheme<'_>]) -> Line<'static> {
    let mut line = Line::default();
    for span in graphemes.chunk_by(|grapheme, next| grapheme.style == next.style) {
        let text: String = span.iter().map(|grapheme| grapheme.symbol).collect();
        line.push_span(Span::styled(text, span[0].style));
    }
    line
}

/// Breaks a line into at most `rows` lines. If the text is longer, its end is replaced by `…`.
pub fn wrapped_within(line: &Line<'_>, columns: u16, rows: u16) -> Vec<Line<'static>> {
    let mut lines = wrapped(line, columns);
    if lines.len() > usize::from(rows) {
        lines.truncate(rows.into());
        if let Some(last) = lines.last_mut() {
            *last = clipped(last, columns);
        }
    }
    lines
}

/// Returns `line` if it is at most `columns` wide. Otherwise returns `line` shortened with `…`.
pub fn fitted(line: Line<'static>, columns: u16) -> Line<'static> {
    if line.width() > usize::from(columns) {
        clipped(&line, columns)
    } else {
        line
    }
}

/// Shortens a line to at most `columns`, including a `…` at its end.
fn clipped(line: &Line<'static>, columns: u16) -> Line<'static> {
    let graphemes: Vec<_> = line.styled_graphemes(Style::default()).collect();
    let mut kept = 0;
    let mut width = Span::raw("…").width();
    for grapheme in &graphemes {
        width += Span::raw(grapheme.symbol).width();
        if width > usize::from(columns) {
            break;
        }
        kept += 1;
    }
    let (beginning, rest) = graphemes.split_at(kept);
    let blanks = beginning.iter().rev().take_while(|last| is_blank(last));
    let mut clipped = styled(&beginning[..kept - blanks.count()]);
    if columns > 0 {
        let style = match rest.first().or(beginning.last()) {
            Some(grapheme) => grapheme.style,
            None => line.style,
        };
        clipped.push_span(Span::styled("…", style));
    }
    clipped.style(line.style)
}

/// Distributes parts over as many lines as needed, each at most `columns` wide. `between` is
/// written between two parts of a line. A part that is wider than a line is left out.
pub fn filled(parts: Vec<Part>, between: &'static str, columns: usize) -> Vec<Line<'static>> {
    let mut lines: Vec<Line<'static>> = Vec::new();
    for part in parts {
        let width: usize = part.iter().map(Span::width).sum();
        let apart = Span::raw(between);
        if let Some(line) = lines.last_mut()
            && line.width() + apart.width() + width <= columns
        {
            line.spans.push(apart);
            line.spans.extend(part);
        } else if width <= columns {
            lines.push(Line::from(part));
        }
    }
    lines
}

/// Returns a text on one line, with one blank between words.
pub fn on_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &'static str, columns: u16) -> Vec<String> {
        wrapped(&Line::raw(text), columns)
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    #[test]
    fn ends_of_a_range_differ_where_three_digits_show_it() {
        assert_eq!(range_in_words((1.23e-3, 4.56e-3), "N"), "1.2 to 4.6 mN");
        assert_eq!(range_in_words((2.31e-3, 2.33e-3), "N"), "2.31 to 2.33 mN");
        assert_eq!(range_in_words((2.31e-3, 2.31e-3), "N"), "2.31 mN");
    }

    #[test]
    fn lines_break_between_words_and_long_words_anywhere() {
        assert_eq!(texts("one two  three", 7), ["one two", "three"]);
        assert_eq!(texts("one two three", 8), ["one two ", "three"]);
        assert_eq!(texts("unbreakable", 4), ["unbr", "eaka", "ble"]);
        assert_eq!(
            texts("by 2 048 springs, 940 µs", 8),
            ["by 2 048", "springs,", "940 µs"]
        );
        assert_eq!(
            texts("1 234 567 springs", 6),
            ["1 234 ", "567 ", "spring", "s"]
        );
        assert_eq!(texts("", 4), Vec::<String>::new());
        assert_eq!(texts("a b", 0), Vec::<String>::new());
    }

    #[test]
    fn no_line_is_wider_than_the_columns() {
        for text in [
            "a漢b 漢 漢漢a",
            "\u{301}a \u{301} bcd\u{301}ef",
            "漢 \u{200b}a",
        ] {
            for columns in 0..8 {
                for line in wrapped(&Line::raw(text), columns) {
                    assert!(
                        line.width() <= usize::from(columns),
                        "{text} {columns}: {line}"
                    );
                }
            }
        }
    }

    #[test]
    fn parts_fill_lines() {
        let filled_lines = |columns| {
            let parts = ["one", "two", "three"]
                .map(|text| vec![Span::raw(text)])
                .to_vec();
            filled(parts, ", ", columns)
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
        };
        assert_eq!(filled_lines(20), ["one, two, three"]);
        assert_eq!(filled_lines(8), ["one, two", "three"]);
        assert_eq!(filled_lines(7), ["one", "two", "three"]);
        assert_eq!(filled_lines(3), ["one", "two"]);
    }

    #[test]
    fn styles_stay_with_their_words() {
        let line = Line::from(vec![
            Span::raw("one "),
            Span::styled("two", Style::new().bold()),
        ]);
        let lines = wrapped(&line, 4);
        assert_eq!(lines[1].spans, [Span::styled("two", Style::new().bold())]);
    }
}
