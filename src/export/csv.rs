//! Curves and lines as comma-separated values, one header line first.

use crate::simulation::Outcome;
use crate::surface::Line;
use std::io::{self, Write};

/// Writes the force curve: the leg counted from 0, indentation in m, force in N, contact length in m
/// and the number of contact fragments.
///
/// # Errors
/// Those of `out`.
pub fn write_curve(out: &mut (impl Write + ?Sized), outcome: &Outcome) -> io::Result<()> {
    writeln!(out, "leg,indentation,force,contact_length,fragments")?;
    for (index, leg) in outcome.history.legs.iter().enumerate() {
        for point in &leg.curve {
            let (indentation, force) = (point.indentation, point.force);
            let contact_length = point.contact_length;
            writeln!(out, "{index},{indentation:?},{force:?},{contact_length:?},{}", point.fragments)?;
        }
    }
    Ok(())
}

/// Writes the line: position x and height z in m of every spring under the body.
///
/// # Errors
/// Those of `out`.
pub fn write_line(out: &mut (impl Write + ?Sized), line: &Line) -> io::Result<()> {
    writeln!(out, "x,z")?;
    for (index, height) in line.heights().enumerate() {
        writeln!(out, "{:?},{height:?}", line.position(index))?;
    }
    Ok(())
}
