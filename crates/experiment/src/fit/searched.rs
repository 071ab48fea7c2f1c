//! Search with a part of the points of a curve or with all of them, and comparison of its result
//! with all points.

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::agreement::Compared;
use crate::fit::model::Model;
use crate::fit::population::WRONG_SIDE;
use crate::fit::scene::pause_of;
use crate::fit::search::{Search, SearchResult};
use crate::fit::space::Space;
use crate::fit::statistics::scale;
use asperity_scene::{Document, Simulation};

/// Number of points that a search uses if the residuals exceed the noise. More points would not
/// reduce the residuals.
pub(crate) const ENOUGH_POINTS: usize = 400;

/// Result of a search, compared with all points of the curve.
pub(crate) struct Searched {
    pub result: SearchResult,
    /// Residuals of all points of the curve, in units of the noise.
    pub residuals: Vec<f64>,
    /// True for each point at which the body is in contact in the measurement or in the model.
    in_contact: Vec<bool>,
    /// Distance in m from the jump of the model, for each point on the wrong side of a jump; `None`
    /// for other points.
    distances_from_jumps: Vec<Option<f64>>,
    /// Robust root mean square of the residuals in contact, in units of the noise.
    pub misfit: f64,
    /// Number of force curves that the search has computed.
    pub evaluations: usize,
}

impl Searched {
    /// Returns the residuals together with the force of the curve, with which they are compared.
    pub fn compared<'a>(&'a self, curve: &'a MeasuredCurve) -> Compared<'a> {
        Compared {
            curve,
            residuals: &self.residuals,
            in_contact: &self.in_contact,
            distances_from_jumps: &self.distances_from_jumps,
        }
    }

    /// Returns the forces of the model in N at the points of the curve.
    pub fn model_forces(&self, curve: &MeasuredCurve) -> Vec<f64> {
        curve
            .force
            .iter()
            .zip(&self.residuals)
            .map(|(measured, residual)| measured - residual * curve.noise)
            .collect()
    }
}

/// Searches the parameters. A first search uses a part of the points. If its residuals exceed the
/// noise, the result comes from this part alone, because further points would not reduce the
/// residuals. `report` receives the number of curves computed so far.
pub(crate) fn search(
    curve: &MeasuredCurve,
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    report: &mut dyn FnMut(usize),
) -> Result<Searched, ExperimentError> {
    if space.relaxes() {
        let with_rest = curve.with_rest(pause_of(document.scene()));
        let space = Space {
            curve: with_rest.as_ref().unwrap_or(curve),
            ..space.clone()
        };
        return search_relaxing(document, simulation, &space, report);
    }
    let of_part = search_part(curve, document, simulation, space, report)?;
    let mut report_all = |evaluations: usize| report(of_part.evaluations + evaluations);
    let model = Model::new(curve, document.scene(), simulation);
    let mut search = Search::of_curve(space, model, &mut report_all);
    let result = match of_part.result {
        Some(result) => result,
        None => search.find()?,
    };
    let mut searched = compared_with_all(&mut search, result)?;
    searched.evaluations += of_part.evaluations;
    Ok(searched)
}

/// Searches the parameters of a half-space that relaxes. The time of this search is that of the
/// curves of the model, so that all points are used from the beginning. The points of a rest count
/// in the search and in the misfit, but not in the residuals that are returned.
fn search_relaxing(
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    report: &mut dyn FnMut(usize),
) -> Result<Searched, ExperimentError> {
    let curve = space.curve;
    let model = Model::new(curve, document.scene(), simulation);
    let mut search = Search::of_curve(space, model, report);
    let result = search.find()?;
    let searched = compared_with_all(&mut search, result)?;
    Ok(without_rest(searched, curve))
}

/// Returns a comparison without the points of the rest of a curve.
pub(crate) fn without_rest(searched: Searched, curve: &MeasuredCurve) -> Searched {
    Searched {
        residuals: curve.without_rest(&searched.residuals),
        in_contact: curve.without_rest(&searched.in_contact),
        distances_from_jumps: curve.without_rest(&searched.distances_from_jumps),
        ..searched
    }
}

/// Result of a search with a part of the points.
struct SearchOfPart {
    /// `None` if the residuals of the part are only noise, so that a search needs all points.
    result: Option<SearchResult>,
    /// Number of force curves that were computed.
    evaluations: usize,
}

/// Searches the parameters with a part of the points. Computes nothing for a curve with few points,
/// which has no such part.
fn search_part(
    curve: &MeasuredCurve,
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    report: &mut dyn FnMut(usize),
) -> Result<SearchOfPart, ExperimentError> {
    let Some(part) = curve.thinned(ENOUGH_POINTS) else {
        return Ok(SearchOfPart {
            result: None,
            evaluations: 0,
        });
    };
    let space = Space {
        curve: &part,
        ..space.clone()
    };
    let model = Model::new(&part, document.scene(), simulation);
    let mut search = Search::of_curve(&space, model, report);
    let (population, generator) = search.first()?;
    let result = if search.is_systematic(&population) {
        Some(search.find_from(population, generator)?)
    } else {
        None
    };
    Ok(SearchOfPart {
        result,
        evaluations: search.evaluations(),
    })
}

/// Compares the curve of the best values that a search has found with all points of the measured
/// curve.
pub(crate) fn compared_with_all(
    search: &mut Search<'_>,
    result: SearchResult,
) -> Result<Searched, ExperimentError> {
    let curve = search.space.curve;
    let best = search.exact(&result.best.place)?;
    let residuals = search.lines.refined(&best.residuals, result.noise);
    let beyond_jumps = search.beyond_jumps(&best.place, &residuals)?;
    let misfit = scale(&best.contact_residuals(&beyond_jumps), WRONG_SIDE);
    let in_newtons: Vec<f64> = residuals
        .iter()
        .map(|residual| residual * curve.noise)
        .collect();
    let values = search.space.values(&best.place);
    let least_jump = WRONG_SIDE * curve.noise;
    let distances_from_jumps =
        search
            .model
            .distances_from_jumps(&values, &in_newtons, least_jump)?;
    Ok(Searched {
        residuals,
        in_contact: best.in_contact,
        distances_from_jumps,
        misfit,
        evaluations: search.evaluations(),
        result,
    })
}
