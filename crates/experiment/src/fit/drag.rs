//! Drag of a fluid, which is fitted a second time together with a model of the contact. When the
//! curve is read, the drag in contact is only extrapolated from the points without contact. A later
//! fit of the model refines the parameters of the drag as if the force were linear in them, which
//! is accurate only if they are already near their best values.

use crate::curve::MeasuredCurve;
use crate::curve::drag::{COLUMNS, Drag, ForcesWithDrag};
use crate::error::ExperimentError;
use crate::fit::agreement::MISFIT;
use crate::fit::lines::Lines;
use crate::fit::model::Model;
use crate::fit::parameter::{Free, Parameter};
use crate::fit::population::WRONG_SIDE;
use crate::fit::search::Search;
use crate::fit::searched::ENOUGH_POINTS;
use crate::fit::space::Space;
use crate::fit::statistics::scale;
use asperity_scene::{Document, Simulation};

/// A curve with a drag that was found with a model.
pub(crate) struct CurveWithDrag {
    pub curve: MeasuredCurve,
    /// Number of force curves that were computed.
    pub evaluations: usize,
}

/// Returns the curve with the drag that describes it best together with a model, whose parameters
/// follow from a short search. Returns `None` for a curve without such a drag, and if the model
/// does not describe the curve.
pub(crate) fn with_drag_of_model(
    curve: &MeasuredCurve,
    document: &Document,
    free: &[Free],
    simulation: &mut Simulation,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<CurveWithDrag>, ExperimentError> {
    let Some(drag) = curve.drag_over_distance else {
        return Ok(None);
    };
    let mut elsewhere = curve.subtracted.elsewhere.iter().flatten();
    let has_other_points = elsewhere.any(|product| *product != 0.0);
    if free.is_empty() || has_other_points || !curve.timing.points.is_empty() {
        return Ok(None);
    }
    let mut with_offset = free.to_vec();
    if !free.iter().any(|free| free.parameter == Parameter::Offset) {
        with_offset.push(Parameter::Offset.into());
    }
    let part = curve.thinned(ENOUGH_POINTS);
    let searched = part.as_ref().unwrap_or(curve);
    let (document, space) = Space::of(searched, document, simulation, &with_offset, stop)?;
    if space.relaxes() {
        return Ok(None);
    }
    let mut no_report = |_| {};
    let model = Model::new(searched, document.scene(), simulation);
    let mut search = Search::of_curve(&space, model, &mut no_report);
    let best = search.descended()?;
    let mut evaluations = search.evaluations();
    let residuals = search.lines.refined(&best.residuals, 1.0);
    if scale(&best.contact_residuals(&residuals), WRONG_SIDE) > MISFIT {
        return Ok(None);
    }
    let values = space.values(&best.place);
    let touch = values[Parameter::Offset as usize];
    let mut model = Model::new(curve, document.scene(), simulation);
    let forces = model.forces(&values)?;
    evaluations += model.evaluations;
    let forces = forces_with_drag(curve, &drag, &forces, touch);
    let curve = drag
        .refitted(&forces, touch)
        .map(|refitted| with_other_drag(curve, &drag, refitted));
    Ok(curve.map(|curve| CurveWithDrag { curve, evaluations }))
}

/// Returns the measured forces minus the forces of a model, plus the drag that was subtracted from
/// the curve. Points on the wrong side of a jump are left out.
fn forces_with_drag(
    curve: &MeasuredCurve,
    drag: &Drag,
    model: &[f64],
    touch: f64,
) -> ForcesWithDrag {
    let lines = curve.subtracted.columns.len() - COLUMNS;
    let mut forces = ForcesWithDrag {
        displacements: Vec::new(),
        segments: Vec::new(),
        forces: Vec::new(),
        others: vec![Vec::new(); 1 + lines],
    };
    let residuals: Vec<f64> = curve
        .force
        .iter()
        .zip(model)
        .map(|(force, model)| (force - model) / curve.noise)
        .collect();
    let refined = Lines::new(curve, false).refined(&residuals, 1.0);
    for (index, residual) in residuals.iter().enumerate() {
        if refined[index].abs() > WRONG_SIDE {
            continue;
        }
        let displacement = curve.displacement[index];
        let is_pulled = curve.segment[index] % 2 == 1;
        let of_drag = drag.force(displacement, is_pulled);
        let growth = drag.growth(displacement, is_pulled, touch);
        forces.displacements.push(displacement);
        forces.segments.push(curve.segment[index]);
        let rest = residual * curve.noise;
        forces.forces.push(rest + of_drag + growth);
        forces.others[0].push(1.0);
        for line in 0..lines {
            forces.others[1 + line].push(curve.subtracted.columns[line][index]);
        }
    }
    forces
}

/// Returns a copy of the curve from which the drag `other` is subtracted in place of `drag`.
fn with_other_drag(curve: &MeasuredCurve, drag: &Drag, other: Drag) -> MeasuredCurve {
    let mut changed = curve.clone();
    for (index, force) in changed.force.iter_mut().enumerate() {
        let displacement = curve.displacement[index];
        let is_pulled = curve.segment[index] % 2 == 1;
        *force += drag.force(displacement, is_pulled) - other.force(displacement, is_pulled);
    }
    let columns = &mut changed.subtracted.columns;
    columns.truncate(columns.len() - COLUMNS);
    columns.extend(other.columns(&curve.displacement, &curve.segment));
    changed.drag_over_distance = Some(other);
    changed
}
