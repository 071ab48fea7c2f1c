//! The answer in a sentence or two: number of springs and time.

use super::{CostTable, Knob, Row};
use crate::scene::format_rounded;
use crate::text::grouped;

/// Relative errors of the answers.
const TARGETS: [(f64, &str); 2] = [(0.01, "1 %"), (0.001, "0.1 %")];

impl CostTable {
    /// Requirements of one per cent and one per mille of the adhesion force, or of the force curve without a
    /// tensile force: one sentence each.
    #[must_use]
    pub fn answer(&self) -> Vec<String> {
        let what =
            if self.reference.adhesion_force.is_some() { "the adhesion force" } else { "the force curve" };
        let needs = |row: &Row| {
            let time = row
                .seconds
                .map_or_else(String::new, |time| format!(", {}", format_rounded(time.minimum, 3, "s")));
            format!("{} springs{time}", grouped(row.springs))
        };
        let sentence = |&(bound, percent): &(f64, &str)| {
            let found = [(Knob::SubCellSprings, "SubCell"), (Knob::GridSprings, "Grid")].map(
                |(knob, edges)| match (self.first_row_within(knob, bound), self.rows_of(knob).next_back()) {
                    (Some(row), _) => format!("{} with edges {edges}", needs(row)),
                    (None, Some(finest)) => {
                        format!("not found up to {} springs with edges {edges}", grouped(finest.springs))
                    }
                    (None, None) => format!("edges {edges} were not affordable"),
                },
            );
            format!("{percent} of {what}: {}.", found.join("; "))
        };
        TARGETS.iter().map(sentence).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::{ErrorFigure, Measures, Reference, Timing};

    fn row(knob: Knob, springs: u64, error: f64) -> Row {
        let figure = Some(ErrorFigure { error, resolved: true, order: None });
        Row {
            knob,
            setting: springs as f64,
            springs,
            seconds: Timing::of(vec![1.0e-6 * springs as f64]),
            transforms: None,
            errors: Measures { adhesion_force: figure, curve: figure, ..Measures::default() },
        }
    }

    #[test]
    fn the_first_row_that_stays_good_answers() {
        let sub_cell =
            [(16, 0.3), (32, 1e-4), (64, 0.02), (128, 0.005), (256, 9e-4), (512, 1e-4), (1024, 1e-5)];
        let grid = [(16, 0.3), (2048, 0.009), (4096, 0.0045), (8192, 0.0009)];
        let rows = |knob, of: &[(u64, f64)]| -> Vec<Row> {
            of.iter().map(|&(springs, error)| row(knob, springs, error)).collect()
        };
        let mut table = CostTable {
            budget: 1.0,
            spent: 0.5,
            transform_seconds: 1e-3,
            reference: Reference {
                springs: 256,
                adhesion_force: Some(1.0),
                closed_form: true,
                errors: Measures::default(),
            },
            rows: [rows(Knob::SubCellSprings, &sub_cell), rows(Knob::GridSprings, &grid)].concat(),
            left_out: Vec::new(),
        };
        assert_eq!(
            table.answer(),
            [
                "1 % of the adhesion force: 128 springs, 128 µs with edges SubCell; 2 048 springs, 2.05 ms with \
                 edges Grid.",
                "0.1 % of the adhesion force: 256 springs, 256 µs with edges SubCell; not found up to 8 192 \
                 springs with edges Grid.",
            ]
        );
        table.reference.adhesion_force = None;
        table.rows.retain(|row| row.knob == Knob::SubCellSprings);
        assert_eq!(
            table.answer()[0],
            "1 % of the force curve: 128 springs, 128 µs with edges SubCell; edges Grid were not affordable."
        );
    }
}
