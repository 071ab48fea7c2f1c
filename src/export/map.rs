//! Cells of a map as comma-separated values after one header line.

use crate::study::Grid;
use std::io::{self, Write};

/// Writes the computed cells of a map: values of the axes by their paths, profiles, regime, and the mean of each
/// quantity with the ends of its 95 % confidence, in SI units; unknown values are empty.
///
/// # Errors
/// Errors of `out`.
pub fn write_map(out: &mut (impl Write + ?Sized), grid: &Grid) -> io::Result<()> {
    let axes: Vec<_> = [Some(&grid.across), grid.up.as_ref()].into_iter().flatten().collect();
    let mut header: Vec<String> = axes.iter().map(|axis| axis.path.clone()).collect();
    header.extend(["lines", "regime"].map(String::from));
    for layer in &grid.layers {
        header.extend(["mean", "low", "high"].map(|of| format!("{}_{of}", layer.quantity.name())));
    }
    writeln!(out, "{}", header.join(","))?;
    for (index, cell) in grid.cells.iter().enumerate() {
        let Some(Ok(cell)) = cell else { continue };
        let columns = grid.across.values.len();
        for (axis, place) in axes.iter().zip([index % columns, index / columns]) {
            write!(out, "{:?},", axis.values[place])?;
        }
        write!(out, "{},{}", cell.lines, cell.regime.map_or("", |cell| cell.regime.name()))?;
        for estimate in &cell.estimates {
            let mean = estimate.map(|estimate| estimate.mean);
            let interval = estimate.and_then(|estimate| estimate.interval);
            for value in [mean, interval.map(|ends| ends.0), interval.map(|ends| ends.1)] {
                write!(out, ",{}", value.map_or_else(String::new, |value| format!("{value:?}")))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
