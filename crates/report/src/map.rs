//! Table of the cells of a map.

use crate::report::Report;
use asperity_data::{Kind, Table};
use asperity_scene::Regime;
use asperity_study::maps::{Grid, GridCell};
use asperity_study::{Quantity, Statistics};

/// Cell of a grid that has been computed.
struct ComputedCell<'a> {
    /// Index of the cell in the grid, row by row.
    index: usize,
    cell: &'a GridCell,
}

impl Report for Grid {
    /// Returns a table with a row for each cell of the map that has been computed. A row has the
    /// values on the axes, the number of profiles, the most frequent regime (once for the turn at
    /// first touch, once for the turn at zero force), and the statistics of each quantity over the
    /// profiles, in SI units.
    fn table(&self) -> Option<Table<'_>> {
        let columns = self.across.values.len();
        let mut table = Table::of(|| {
            let cells = self.cells.iter().enumerate();
            cells.filter_map(|(index, cell)| {
                let cell = cell.as_ref()?.as_ref().ok()?;
                Some(ComputedCell { index, cell })
            })
        });
        table = table.with(self.across.path.clone(), Kind::Real, move |computed| {
            self.across.values[computed.index % columns]
        });
        if let Some(up) = &self.up {
            table = table.with(up.path.clone(), Kind::Real, move |computed| {
                up.values[computed.index / columns]
            });
        }
        table = table.whole("profiles", |computed| {
            computed.cell.regimes[0].profiles() as u64
        });
        for quantity in Quantity::REGIMES {
            let name = quantity.name();
            table = table.with(name, Kind::Text(Regime::LONGEST_NAME), move |computed| {
                let most_frequent = computed.cell.regimes_of(quantity).most();
                most_frequent.map(|(regime, _)| regime.name())
            });
        }
        for (place, layer) in self.layers.iter().enumerate() {
            for (ending, value) in Statistics::COLUMNS {
                let name = format!("{}_{ending}", layer.quantity.name());
                table = table.with(name, Kind::Real, move |computed| {
                    computed.cell.statistics[place].as_ref().and_then(value)
                });
            }
        }
        Some(table.done())
    }
}
