//! Tables of a scene: its force curve and its profile.

use super::table::{Column, TableFormat, Value, write_table};
use crate::contact::CurvePoint;
use crate::scene::Provenance;
use crate::simulation::Outcome;
use crate::surface::Line;
use std::io::{self, Write};

/// A point of the curve, with its loading stage and its stored elastic energy, J.
pub(super) type CurveRow = (usize, CurvePoint, f64);

/// Columns of [`write_curve`].
pub(super) const CURVE: &[Column<CurveRow>] = &[
    Column("leg", Value::Whole(|(leg, ..)| *leg as u64)),
    Column("indentation", Value::Real(|(_, point, _)| point.indentation)),
    Column("force", Value::Real(|(_, point, _)| point.force)),
    Column("contact_length", Value::Real(|(_, point, _)| point.contact_length)),
    Column("fragments", Value::Whole(|(_, point, _)| point.fragments)),
    Column("stored_energy", Value::Real(|(.., stored)| *stored)),
];

/// Columns of [`write_line`].
const PROFILE: &[Column<(f64, f64)>] =
    &[Column("x", Value::Real(|point| point.0)), Column("z", Value::Real(|point| point.1))];

/// Points of all loading stages in sequence.
pub(super) fn curve(outcome: &Outcome) -> impl Iterator<Item = CurveRow> {
    let legs = outcome.history.legs.iter().enumerate();
    legs.flat_map(|(leg, record)| {
        record.curve.iter().zip(&record.stored_energy).map(move |(point, stored)| (leg, *point, *stored))
    })
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
