//! The scene of a fit: the values at which a search begins, and the document with the fitted
//! values.

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::parameter::{Parameter, Values};
use asperity_data::{format_quantity, round_to};
use asperity_scene::text::ron_float;
use asperity_scene::{Adhesion, Document, Governing, Scene, SceneErrors};

/// Relative difference of two stiffnesses of one instrument above which the difference is reported.
const OTHER: f64 = 0.01;

/// A change of a field: its path and its value in RON.
type Change = (String, String);

fn change(path: &str, value: f64) -> Change {
    (path.to_owned(), ron_float(value))
}

/// Returns the parameters of a fit as the scene states them. `governing` contains the works of
/// adhesion.
pub(crate) fn values_of(scene: &Scene, governing: &Governing) -> Values {
    let work = governing.work_of_adhesion.unwrap_or(0.0);
    let closing = governing.closing_work.unwrap_or(work);
    let (stiffness, radius) = (
        scene.loading_stiffness.unwrap_or(f64::INFINITY),
        radius_of(scene).unwrap_or(0.0),
    );
    [
        work,
        closing,
        governing.effective_modulus,
        0.0,
        0.0,
        stiffness,
        radius,
    ]
}

/// Returns the radius of the form of a scene in m; `None` for a form without a radius.
pub(crate) fn radius_of(scene: &Scene) -> Option<f64> {
    scene.form.clone()?.radius_mut().copied()
}

/// Returns the largest work of adhesion on closing that a scene allows, in J/m²; infinite if the
/// scene states none.
pub(crate) fn most_on_closing(scene: &Scene) -> f64 {
    scene
        .adhesion
        .and_then(|adhesion| adhesion.closing_work())
        .unwrap_or(f64::INFINITY)
}

/// Returns the document with works of adhesion in place of κ or e_el/γ. A document without adhesion
/// gets the work `start` in J/m², if it is given.
pub(crate) fn written_out(
    document: &Document,
    governing: &Governing,
    start: Option<f64>,
) -> Result<Document, SceneErrors> {
    let (adhesion, known) = (document.scene().adhesion, governing.adhesive_work());
    let is_by_parameter = adhesion.is_some_and(|adhesion| adhesion.parameter().is_some());
    let Some(work) = known
        .or(start)
        .filter(|_| known.is_none() || is_by_parameter)
    else {
        return Ok(document.clone());
    };
    let by_work = Adhesion::by_work(work);
    document.with_adhesion(adhesion.map_or(by_work, |adhesion| adhesion.with_work(work)))
}

/// Returns the document with the fitted values, loaded as the body was in the measurement.
pub(crate) fn with_values(
    document: &Document,
    values: &Values,
    free: impl Fn(Parameter) -> bool,
    curve: &MeasuredCurve,
) -> Result<Document, ExperimentError> {
    let material = document.scene().material;
    let modulus = values[Parameter::Modulus as usize];
    let modulus = match material.poisson_ratio {
        Some(ratio) => change(
            "material.youngs_modulus",
            modulus * (1.0 - ratio) * (1.0 + ratio),
        ),
        None => change("material.effective_modulus", modulus),
    };
    let has_closing = free(Parameter::ClosingWork)
        || document
            .scene()
            .adhesion
            .is_some_and(|of| of.closing_work().is_some());
    let rows = [
        (
            free(Parameter::Work),
            change("adhesion.work", values[Parameter::Work as usize]),
        ),
        (
            has_closing,
            change(
                "adhesion.closing_work",
                values[Parameter::ClosingWork as usize],
            ),
        ),
        (free(Parameter::Modulus), modulus),
        (
            free(Parameter::Stiffness),
            change("loading_stiffness", values[Parameter::Stiffness as usize]),
        ),
        (
            free(Parameter::Radius),
            change("form.radius", values[Parameter::Radius as usize]),
        ),
    ];
    let loading = curve.loading(values[Parameter::Offset as usize]);
    let changes: Vec<Change> = rows
        .into_iter()
        .filter(|row| row.0)
        .map(|row| row.1)
        .chain([loading])
        .collect();
    document.set_all(&changes).map_err(wrong)
}

impl MeasuredCurve {
    /// Returns the scene with the stiffness of the instrument: the `loading_stiffness` of the
    /// scene, or else the stiffness in the file of the curve. For a measured displacement of the
    /// body the instrument becomes rigid. The second value is a sentence about this choice; `None`
    /// if scene and file do not differ.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow this stiffness.
    pub fn with_instrument(
        &self,
        document: &Document,
    ) -> Result<(Document, Option<String>), SceneErrors> {
        let of_scene = document.scene().loading_stiffness;
        let newtons = |stiffness: f64| format_quantity(stiffness, "N/m");
        let set = |value: String| document.set_all(&[("loading_stiffness".to_owned(), value)]);
        if let Some(name) = &self.of_body {
            let body = format!(
                "{name} is a displacement of the body, without the deflection of the instrument"
            );
            return Ok(match of_scene {
                Some(stiffness) => {
                    let text = format!(
                        "{body}: the loading_stiffness of {} is left out.",
                        newtons(stiffness)
                    );
                    (set("None".to_owned())?, Some(text))
                }
                None => (document.clone(), Some(body + ".")),
            });
        }
        let Some((name, stated)) = &self.stiffness else {
            return Ok((document.clone(), None));
        };
        Ok(match of_scene {
            None => {
                let text = format!(
                    "Loading stiffness {} by the {name} of the file.",
                    newtons(*stated)
                );
                (set(ron_float(*stated))?, Some(text))
            }
            Some(stiffness) if (stated / stiffness - 1.0).abs() > OTHER => {
                let [of_scene, stated] = [stiffness, *stated].map(newtons);
                let text = format!(
                    "Loading stiffness {of_scene} by the scene; the {name} of the file is {stated}."
                );
                (document.clone(), Some(text))
            }
            Some(_) => (document.clone(), None),
        })
    }

    /// Returns the scene with two fields taken from the measured curve: the loading, and the
    /// stiffness of the instrument as in [`Self::with_instrument`]. `offset` is the measured
    /// displacement in m at which the bodies first touch.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow this loading or this stiffness.
    pub fn load(&self, document: &Document, offset: f64) -> Result<Document, SceneErrors> {
        self.with_instrument(document)?
            .0
            .set_all(&[self.loading(offset)])
    }

    fn loading(&self, offset: f64) -> Change {
        let turns = &self.turns;
        let stages: String = turns[..turns.len() - 1]
            .iter()
            .map(|turn| {
                format!(
                    "ToDisplacement({}), ",
                    ron_float(round_to(turn - offset, 10))
                )
            })
            .collect();
        ("loading".to_owned(), format!("[{stages}ToSeparation]"))
    }
}

/// Converts the first error of a scene with other values to an error of the fit.
pub(crate) fn wrong(errors: SceneErrors) -> ExperimentError {
    let error = errors.first();
    let found = format!("{} = {}", error.field, error.value);
    ExperimentError::Refused {
        found,
        allowed: error.allowed.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{on_rubber, read, rubber};
    use crate::read::options::Drift;

    #[test]
    fn values_found_are_written_where_they_belong() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let document = on_rubber(1e-3, 2e6);
        let values = [0.04, 0.03, 3e6, 2e-6, 0.0, 5.0, 6e-6];
        let all = with_values(&document, &values, |_| true, &curve).unwrap();
        let scene = all.scene();
        let adhesion = scene.adhesion.unwrap();
        assert_eq!(
            (adhesion.work(), adhesion.closing_work()),
            (Some(0.04), Some(0.03))
        );
        assert_eq!(
            (scene.material.effective_modulus(), scene.loading_stiffness),
            (3e6, Some(5.0))
        );
        assert_eq!(
            (radius_of(scene), most_on_closing(scene)),
            (Some(6e-6), 0.03)
        );
        // Those that are not free stay.
        let none = with_values(&document, &values, |_| false, &curve).unwrap();
        let scene = none.scene();
        assert_eq!(
            scene
                .adhesion
                .map(|adhesion| (adhesion.work(), adhesion.closing_work())),
            Some((Some(1e-3), None))
        );
        assert_eq!(
            (scene.material.effective_modulus(), scene.loading_stiffness),
            (2e6, Some(3.0))
        );
        assert_eq!(
            (radius_of(scene), most_on_closing(scene)),
            (Some(7.5e-6), f64::INFINITY)
        );
        // The modulus of a material by Young's modulus and Poisson's ratio.
        let plane = [(
            "material".to_owned(),
            "(youngs_modulus: 1e6, poisson_ratio: 0.5)".to_owned(),
        )];
        let plane = document.set_all(&plane).unwrap();
        let found = with_values(&plane, &values, |one| one == Parameter::Modulus, &curve).unwrap();
        assert!((found.scene().material.effective_modulus() / 3e6 - 1.0).abs() < 1e-12);
        // A work on closing that the scene has follows the work of adhesion.
        let closing = document
            .set_all(&[("adhesion.closing_work".to_owned(), "1e-4".to_owned())])
            .unwrap();
        let found = with_values(&closing, &values, |one| one == Parameter::Work, &curve).unwrap();
        assert_eq!(found.scene().adhesion.unwrap().closing_work(), Some(0.03));
    }
}
