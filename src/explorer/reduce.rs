//! Reduces a line with a million springs to the columns of a pane.

use super::snapshot::{Column, Section};

/// The line and its contact at one moment.
#[derive(Clone, Copy)]
pub struct Contact<'a> {
    /// Gaps below the summit, m.
    pub gaps: &'a [f64],
    /// Smallest indentation at which each spring is in contact, m.
    pub thresholds: &'a [f64],
    /// Height of the summit, m.
    pub summit: f64,
    /// Indentation, m.
    pub indentation: f64,
}

impl Contact<'_> {
    /// Whether a spring is in contact.
    #[must_use]
    pub fn touches(&self, spring: usize) -> bool {
        self.thresholds[spring] <= self.indentation
    }

    /// Height of the line at a spring, m.
    #[must_use]
    pub fn height(&self, spring: usize) -> f64 {
        self.summit - self.gaps[spring]
    }

    /// Reduces `springs` springs from `first` on to `columns` columns: the lowest and highest of each.
    /// Where there are more columns than springs, a spring fills several.
    #[must_use]
    pub fn section(&self, first: usize, springs: usize, columns: usize) -> Section {
        let first = first.min(self.gaps.len());
        let springs = springs.min(self.gaps.len() - first);
        let level = self.summit - self.indentation;
        let mut section = Section { first, springs, heights: (level, level), level, columns: Vec::new() };
        if springs == 0 {
            return section;
        }
        let start =
            |column: usize| first + (column as u128 * springs as u128 / columns.max(1) as u128) as usize;
        section.columns = (0..columns)
            .map(|column| {
                let from = start(column);
                let to = start(column + 1).max(from + 1);
                self.column(from, to, level)
            })
            .collect();
        let ends = section.columns.iter().map(|column| column.line);
        section.heights = ends
            .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
            // A pane that is not shown has no columns, and may be shown before its next picture comes.
            .unwrap_or_else(|| self.column(first, first + springs, level).line);
        section
    }

    fn column(&self, from: usize, to: usize, level: f64) -> Column {
        let mut line = (f64::INFINITY, f64::NEG_INFINITY);
        let mut contact = (f64::INFINITY, f64::NEG_INFINITY);
        let mut free = false;
        for (gap, threshold) in self.gaps[from..to].iter().zip(&self.thresholds[from..to]) {
            let height = self.summit - gap;
            line = (line.0.min(height), line.1.max(height));
            if *threshold <= self.indentation {
                contact = (contact.0.min(height), contact.1.max(height));
            } else {
                free = true;
            }
        }
        let touches = contact.0 <= contact.1;
        // Where springs are free the surface stands at its level, where they touch it follows the line.
        let surface = match (touches, free) {
            (true, false) => contact,
            (true, true) => (contact.0.min(level), contact.1.max(level)),
            _ => (level, level),
        };
        Column { line, surface, contact: touches.then_some(contact) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: Contact<'static> = Contact {
        gaps: &[0.0, 1.0, 2.0, 3.0, 2.5, 0.5],
        thresholds: &[0.0, 0.5, f64::INFINITY, f64::INFINITY, f64::INFINITY, 0.2],
        summit: 10.0,
        indentation: 0.5,
    };

    #[test]
    fn columns_hold_the_extremes_of_their_springs() {
        let section = LINE.section(0, 6, 3);
        assert_eq!(section.heights, (7.0, 10.0));
        assert_eq!(section.level, 9.5);
        let free = Column { line: (7.0, 8.0), surface: (9.5, 9.5), contact: None };
        let mixed = Column { line: (7.5, 9.5), surface: (9.5, 9.5), contact: Some((9.5, 9.5)) };
        let held = Column { line: (9.0, 10.0), surface: (9.0, 10.0), contact: Some((9.0, 10.0)) };
        assert_eq!(section.columns, [held, free, mixed]);
    }

    #[test]
    fn a_spring_fills_several_columns_when_there_are_more() {
        let section = LINE.section(4, 99, 5);
        assert_eq!((section.first, section.springs), (4, 2));
        let heights: Vec<f64> = section.columns.iter().map(|column| column.line.0).collect();
        assert_eq!(heights, [7.5, 7.5, 7.5, 9.5, 9.5]);
        assert_eq!(LINE.section(6, 1, 5).columns, []);
    }
}
