//! Cells of a map as comma-separated values after one header line.

use crate::study::map::MapModel;
use std::io::{self, Write};

/// Writes the computed cells of a map: values of the axes by their paths, profiles, regime, and the mean of each
/// quantity with the ends of its 95 % confidence, in SI units; unknown values are empty. `sections` restricts the
/// cells to one column and one row.
///
/// # Errors
/// Errors of `out`.
pub fn write_map(
    out: &mut (impl Write + ?Sized),
    map: &MapModel,
    sections: Option<(usize, usize)>,
) -> io::Result<()> {
    let axes = [Some(map.across()), map.up()].into_iter().flatten();
    let mut header: Vec<String> = axes.map(|axis| axis.path.clone()).collect();
    header.extend(["lines", "regime"].map(String::from));
    for layer in map.layers() {
        header.extend(["mean", "low", "high"].map(|of| format!("{}_{of}", layer.quantity.name())));
    }
    writeln!(out, "{}", header.join(","))?;
    let (columns, rows) = map.size();
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    for (column, row) in cells.filter(|(column, row)| sections.is_none_or(|(c, r)| *column == c || *row == r))
    {
        let Some(Ok(cell)) = map.computed(column, row) else { continue };
        write!(out, "{:?},", map.across().figure.values[column])?;
        if let Some(up) = map.up() {
            write!(out, "{:?},", up.figure.values[row])?;
        }
        write!(out, "{},{}", cell.lines, cell.regime.map_or("", |regime| regime.name()))?;
        for layer in map.layers() {
            match map.estimate(layer, column, row) {
                // One profile or few have no confidence interval.
                Some(one) if one.low == one.high => write!(out, ",{:?},,", one.mean)?,
                Some(one) => write!(out, ",{:?},{:?},{:?}", one.mean, one.low, one.high)?,
                None => write!(out, ",,,")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
