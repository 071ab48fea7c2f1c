//! Tables of a scene: its force curve, the approximate one beside it, and its profile.

use super::table::{Cell, Column, TableFormat, write_table};
use crate::analysis::ApproximateJkr;
use crate::contact::NonadhesivePoint;
use crate::scene::Provenance;
use crate::simulation::Outcome;
use crate::surface::Line;
use std::io::{self, Write};

/// Writes the force curve: the leg counted from 0, indentation in m, force in N, contact length in m
/// and the number of contact fragments.
///
/// # Errors
/// Those of `out`.
pub fn write_curve(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    outcome: &Outcome,
) -> io::Result<()> {
    let columns = [
        ("leg", Column::Whole),
        ("indentation", Column::Real),
        ("force", Column::Real),
        ("contact_length", Column::Real),
        ("fragments", Column::Whole),
    ];
    let legs = &outcome.history.legs;
    let points = legs.iter().map(|leg| leg.curve.len()).sum();
    let rows = legs.iter().enumerate().flat_map(|(leg, record)| {
        record.curve.iter().map(move |point| {
            [
                Cell::Whole(leg as u64),
                Cell::Real(point.indentation),
                Cell::Real(point.force),
                Cell::Real(point.contact_length),
                Cell::Whole(point.fragments),
            ]
        })
    });
    write_table(out, format, provenance, columns, points, rows)
}

/// Writes the approximate JKR curve: indentation in m and force in N, and of the contact without adhesion of the same area
/// its indentation in m, force in N, contact length in m and mean length of the growing patches in m.
///
/// # Errors
/// Those of `out`.
pub fn write_approximate_jkr(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    curve: &ApproximateJkr,
) -> io::Result<()> {
    let columns = [
        ("indentation", Column::Real),
        ("force", Column::Real),
        ("nonadhesive_indentation", Column::Real),
        ("nonadhesive_force", Column::Real),
        ("contact_length", Column::Real),
        ("growing_length", Column::Real),
    ];
    let rows = curve.points.iter().map(|point| {
        let NonadhesivePoint { indentation, force, contact_length, growing_length } = point.nonadhesive;
        let [adhesive, nonadhesive] =
            [[point.indentation, point.force], [indentation, force]].map(|point| point.map(Cell::Real));
        let lengths = [Cell::Real(contact_length), growing_length.into()];
        [adhesive[0], adhesive[1], nonadhesive[0], nonadhesive[1], lengths[0], lengths[1]]
    });
    write_table(out, format, provenance, columns, curve.points.len(), rows)
}

/// Writes the line: position x and height z in m of every spring under the body.
///
/// # Errors
/// Those of `out`.
pub fn write_line(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    line: &Line,
) -> io::Result<()> {
    let columns = [("x", Column::Real), ("z", Column::Real)];
    let heights = line.heights().enumerate();
    let rows = heights.map(|(index, height)| [Cell::Real(line.position(index)), Cell::Real(height)]);
    write_table(out, format, provenance, columns, line.gaps.len(), rows)
}
