//! Tables of a scene: its force curve and its profile.

use super::Provenance;
use super::table::{Column, TableFormat, Value, write_table};
use crate::contact::CurvePoint;
use crate::simulation::Outcome;
use crate::surface::Line;
use std::io::{self, Write};

/// Columns of [`write_curve`].
pub(super) const CURVE: &[Column<(usize, CurvePoint)>] = &[
    Column("leg", Value::Whole(|(leg, _)| *leg as u64)),
    Column("indentation", Value::Real(|(_, point)| point.indentation)),
    Column("force", Value::Real(|(_, point)| point.force)),
    Column("contact_length", Value::Real(|(_, point)| point.contact_length)),
    Column("fragments", Value::Whole(|(_, point)| point.fragments)),
    Column("stored_energy", Value::Real(|(_, point)| point.stored_energy)),
];

/// Columns of [`write_line`].
const PROFILE: &[Column<(f64, f64)>] =
    &[Column("x", Value::Real(|point| point.0)), Column("z", Value::Real(|point| point.1))];

/// Points of all loading stages in sequence.
pub(super) fn curve(outcome: &Outcome) -> impl Iterator<Item = (usize, CurvePoint)> {
    let legs = outcome.history.legs.iter().enumerate();
    legs.flat_map(|(leg, record)| record.curve.iter().map(move |point| (leg, *point)))
}

/// Writes the force curve: number of the loading stage from 0, indentation in m, force in N, contact length in m,
/// the number of contact patches and the stored elastic energy in J.
///
/// # Errors
/// Errors of `out`.
pub fn write_curve(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    outcome: &Outcome,
) -> io::Result<()> {
    let points = outcome.history.legs.iter().map(|leg| leg.curve.len()).sum();
    write_table(out, format, provenance, CURVE, points, curve(outcome))
}

/// Writes the profile: position x and height z in m of every spring under the body.
///
/// # Errors
/// Errors of `out`.
pub fn write_line(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    line: &Line,
) -> io::Result<()> {
    let points = line.heights().enumerate().map(|(index, height)| (line.position(index), height));
    write_table(out, format, provenance, PROFILE, line.gaps.len(), points)
}
