//! Evaluation of a search: the result of a fit, with the bounds and reasons that follow from the
//! curve.

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::agreement::MISFIT;
use crate::fit::instrument::FittedStiffness;
use crate::fit::parameter::Parameter;
use crate::fit::posterior::Posterior;
use crate::fit::reason::{Reason, reason, steeper_slope};
use crate::fit::result::{FitResult, FittedParameter, RangeEnd};
use crate::fit::scene::with_values;
use crate::fit::searched::Searched;
use crate::fit::space::Space;
use asperity_scene::{CheckedScene, Document, Simulation};
use std::f64::consts::PI;

/// Allowance for noise, in standard deviations, in the bound of the work of adhesion that follows
/// from the pull-off force.
const ALLOWED_NOISE: f64 = 3.0;

/// Returns the result of a fit. Its assumptions lack the sentences on what was assumed before the
/// search. `searched` is the result of the search.
pub(crate) fn fit_result(
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    searched: Searched,
) -> Result<FitResult, ExperimentError> {
    let curve = space.curve;
    let free = space.parameters();
    let has_other_profile = searched.misfit > MISFIT && document.scene().seed().is_some();
    let posterior = Posterior::new(space, &searched.result, has_other_profile);
    let best = &posterior.best;
    let is_free = |parameter| free.contains(&parameter);
    let fitted = with_values(document, best, is_free, curve)?;
    let scene = fitted.scene();
    let slope = steeper_slope(curve, best, &free);
    let mut parameters = posterior.parameters();
    let most_work = most_work_by_pull_off(curve, scene);
    limit_parameters(&mut parameters, most_work, slope.is_some());
    let work_at_most = posterior.work_at_most(&parameters);
    let tabor = match work_at_most {
        // The fitted work of adhesion is noise, and so would be its Tabor number.
        Some(_) => None,
        None => tabor_number(scene, simulation)?,
    };
    let stiffness = FittedStiffness {
        curve,
        values: best,
        free: &free,
        stated: document.scene().loading_stiffness,
    };
    let far_from_stated = stiffness.far_from_stated();
    let assumptions = match far_from_stated {
        Some(_) => Vec::new(),
        None => stiffness.sentences(&simulation.contact(scene)?.0)?,
    };
    let line_remains = curve.remaining[..2].iter().any(|change| *change != 0.0);
    let mut reason_of_misfit = None;
    if let Some(slope) = slope {
        let stiffness = best[Parameter::Stiffness as usize];
        reason_of_misfit = Some(Reason::Stiffness(slope, stiffness));
    } else if far_from_stated.is_some() {
        reason_of_misfit = far_from_stated;
    } else if searched.misfit > MISFIT || line_remains {
        let residuals = &searched.residuals;
        let found = reason(curve, scene, simulation, best, residuals, &free, tabor)?;
        reason_of_misfit = Some(found);
    }
    let comparison = searched.compared(curve).comparison();
    let has_reason = reason_of_misfit.is_some();
    let grade = comparison.agreement.grade(searched.misfit, has_reason);
    Ok(FitResult {
        work_at_most,
        relaxed_modulus: posterior.relaxed_modulus(),
        parameters,
        residual: comparison.agreement.residual,
        misfit: searched.misfit,
        residual_over_noise: comparison.residual_over_noise,
        beyond_five_sigma: comparison.beyond_five_sigma,
        grade,
        agreement: comparison.agreement,
        tabor,
        reason: reason_of_misfit,
        warnings: simulation.compute(scene)?.warnings,
        correlations: posterior.correlations(),
        not_distinguished: posterior.not_distinguished(),
        assumptions,
        evaluations: searched.evaluations,
        model: searched.model_forces(curve),
        document: fitted,
    })
}

/// Returns the largest work of adhesion in J/m² that agrees with the largest tension of the curve
/// of a smooth sphere, by F = 1.5 π R γ (Johnson, Kendall and Roberts). The noise and the
/// difference to the previous point are added to the tension, because the true tension may exceed
/// the measured one by this amount. Returns `None` for another body, and for a curve that does not
/// show the pull-off.
fn most_work_by_pull_off(curve: &MeasuredCurve, scene: &CheckedScene) -> Option<f64> {
    let radius = scene.form.as_ref()?.sphere_radius()?;
    if scene.roughness.is_some() || !curve.detaches {
        return None;
    }
    let is_pulled = |index: &usize| curve.segment[*index] % 2 == 1;
    let lowest = (0..curve.force.len())
        .filter(is_pulled)
        .min_by(|index, next| curve.force[*index].total_cmp(&curve.force[*next]))?;
    let tension = -curve.force[lowest];
    let before = curve.force[lowest.saturating_sub(1)];
    let tension = tension.max(0.0) + (before + tension).abs() + ALLOWED_NOISE * curve.noise;
    Some(tension / (1.5 * PI * radius))
}

/// Returns the Tabor number of a scene with the found parameters; `None` without adhesion.
fn tabor_number(
    scene: &CheckedScene,
    simulation: &mut Simulation,
) -> Result<Option<f64>, ExperimentError> {
    let (_, governing) = simulation.contact(scene)?;
    Ok(governing.tabor_number(scene))
}

/// Limits the work of adhesion to `most_work` in J/m², the largest work that agrees with the
/// pull-off. If `is_steep` is true, the loading is steeper than the instrument, so the modulus has
/// only a bound.
fn limit_parameters(parameters: &mut [FittedParameter], most_work: Option<f64>, is_steep: bool) {
    for fitted in parameters {
        match fitted.parameter {
            Parameter::Work => limit_work(fitted, most_work),
            Parameter::Modulus if is_steep => fitted.set_at_end(RangeEnd::High),
            _ => {}
        }
    }
}

/// Ends the interval of the work of adhesion at `most` in J/m², the largest work that agrees with
/// the pull-off.
fn limit_work(work: &mut FittedParameter, most: Option<f64>) {
    let Some(most) = most else {
        return;
    };
    if work.interval.1 > most && work.value <= most {
        work.interval.1 = most;
        work.noise_error = work.noise_error.min(most - work.interval.0);
    }
}
