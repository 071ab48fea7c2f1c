//! Cells of a map as a table.

use crate::report::Report;
use asperity_data::{Kind, Table};
use asperity_scene::Regime;
use asperity_study::maps::{Grid, GridCell};
use asperity_study::{Quantity, Statistics};

impl Report for Grid {
    /// Returns a table with a row for each computed combination of values on the axes of a study. A
    /// row has these values, the number of profiles, the most frequent regime (once for the turn at
    /// first touch, once for the turn at zero force), and the statistics of each quantity over the
    /// profiles, in SI units.
    fn table(&self) -> Option<Table<'_>> {
        let columns = self.across.values.len();
        let mut table = Table::of(move || {
            let cells = self.cells.iter().enumerate();
            cells.filter_map(|(index, cell)| Some((index, cell.as_ref()?.as_ref().ok()?)))
        });
        table = table.with(
            self.across.path.clone(),
            Kind::Real,
            move |(index, _): &(usize, &GridCell)| self.across.values[index % columns],
        );
        if let Some(up) = &self.up {
            table = table.with(up.path.clone(), Kind::Real, move |(index, _)| {
                up.values[index / columns]
            });
        }
        table = table.whole("lines", |(_, cell)| cell.regimes[0].profiles() as u64);
        for of in Quantity::REGIMES {
            table = table.with(
                of.name(),
                Kind::Text(Regime::LONGEST_NAME),
                move |(_, cell)| cell.regimes_of(of).most().map(|(regime, _)| regime.name()),
            );
        }
        for (place, layer) in self.layers.iter().enumerate() {
            for (ending, of) in Statistics::COLUMNS {
                let name = format!("{}_{ending}", layer.quantity.name());
                table = table.with(name, Kind::Real, move |(_, cell)| {
                    cell.statistics[place].as_ref().and_then(of)
                });
            }
        }
        Some(table.done())
    }
}
