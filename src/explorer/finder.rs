//! A list searched while the query is typed.

use super::fuzzy::{Candidate, find};
use super::text_line::TextLine;

/// Query, rows that fit, and the selected one of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finder {
    /// The query.
    pub query: TextLine,
    /// Indices of the candidates that fit, the best first.
    pub found: Vec<usize>,
    /// Place of the selected candidate among them.
    pub selected: usize,
}

impl Finder {
    /// An empty search, which finds everything.
    #[must_use]
    pub fn new(candidates: usize) -> Self {
        Finder { found: (0..candidates).collect(), ..Finder::default() }
    }

    /// Finds the candidates that fit the query, and selects the best.
    pub fn search(&mut self, candidates: impl IntoIterator<Item = Candidate>) {
        self.found = find(candidates, &self.query.text());
        self.selected = 0;
    }

    /// Moves the selection by so many rows.
    pub fn select(&mut self, rows: i32) {
        let last = self.found.len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(rows as isize).min(last);
    }

    /// Index of the selected candidate.
    #[must_use]
    pub fn choice(&self) -> Option<usize> {
        self.found.get(self.selected).copied()
    }
}
