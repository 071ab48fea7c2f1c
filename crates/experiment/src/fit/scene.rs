//! Conversion between a scene and the parameters of a fit: the values in the scene, and the
//! document with the fitted values.

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::lengths::Lengths;
use crate::fit::parameter::{Parameter, Values};
use asperity_contact::Move;
use asperity_data::{format_quantity, round_to};
use asperity_scene::text::ron_float;
use asperity_scene::{Adhesion, Document, Governing, Scene, SceneErrors};
use asperity_surface::Form;

/// Relative difference between the stiffness in the scene and the stiffness in the file above which
/// a sentence reports the difference.
const OTHER: f64 = 0.01;

/// A change of a field of the scene: the path of the field, and its new value in RON.
type Change = (String, String);

fn change(path: &str, value: f64) -> Change {
    (path.to_owned(), ron_float(value))
}

/// Returns the values that the parameters of a fit have in a scene, in SI units. `governing` has
/// the work of adhesion of the scene.
pub(crate) fn values_of(scene: &Scene, governing: &Governing) -> Values {
    let work = governing.work_of_adhesion.unwrap_or(0.0);
    let mut values = [0.0; Parameter::ALL.len()];
    values[Parameter::Work as usize] = work;
    values[Parameter::ClosingWork as usize] = governing.closing_work.unwrap_or(work);
    values[Parameter::Modulus as usize] = governing.modulus;
    values[Parameter::Stiffness as usize] = scene.loading_stiffness.unwrap_or(f64::INFINITY);
    if let Some(relaxation) = scene.material.relaxation {
        values[Parameter::RelaxationShare as usize] = relaxation.share;
        values[Parameter::RelaxationTime as usize] = relaxation.time;
    }
    if let Some(form) = &scene.form {
        Lengths::of_form(form).put_into_values(&mut values);
    }
    values
}

/// Returns the time in s for which the loading of a scene rests. A fit with relaxation assumes this
/// rest between the approach and the retraction of the curve.
pub(crate) fn pause_of(scene: &Scene) -> f64 {
    let mut pause = 0.0;
    for stage in &scene.loading {
        if let Move::Hold(seconds) = stage {
            pause += seconds;
        }
    }
    pause
}

/// Paths, in a scene, of two fields of the second of several spheres: its radius, and the distance
/// of its apex behind the apex of the first sphere.
pub(crate) const SECOND_RADIUS: &str = "form.1.radius";
pub(crate) const SECOND_BEHIND: &str = "form.1.behind";

/// Returns the path of the radius of the form of a scene. If the form has several spheres, this is
/// the path of the radius of the first one.
fn radius_path(scene: &Scene) -> &'static str {
    match scene.form {
        Some(Form::Spheres(_)) => "form.0.radius",
        _ => "form.radius",
    }
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

/// Returns a copy of the document in which works of adhesion replace κ or e_el/γ. If the document
/// has no adhesion, the copy gets the work of adhesion `start` in J/m², if `start` is given.
pub(crate) fn written_out(
    document: &Document,
    governing: &Governing,
    start: Option<f64>,
) -> Result<Document, SceneErrors> {
    let adhesion = document.scene().adhesion;
    let known = governing.adhesive_work();
    let is_by_parameter = adhesion.is_some_and(|adhesion| adhesion.parameter().is_some());
    if known.is_some() && !is_by_parameter {
        return Ok(document.clone());
    }
    let Some(work) = known.or(start) else {
        return Ok(document.clone());
    };
    document.with_adhesion(match adhesion {
        Some(adhesion) => adhesion.with_work(work),
        None => Adhesion::by_work(work),
    })
}

/// Returns a copy of the document with the fitted values and with the loading of the measurement.
pub(crate) fn with_values(
    document: &Document,
    values: &Values,
    is_free: impl Fn(Parameter) -> bool,
    curve: &MeasuredCurve,
) -> Result<Document, ExperimentError> {
    let scene = document.scene();
    let value = |parameter: Parameter| values[parameter as usize];
    let mut changes = Vec::new();
    if is_free(Parameter::Work) {
        changes.push(change("adhesion.work", value(Parameter::Work)));
    }
    // The work on closing in the scene changes with the work of adhesion.
    let has_closing_work = scene
        .adhesion
        .is_some_and(|adhesion| adhesion.closing_work().is_some());
    if is_free(Parameter::ClosingWork) || has_closing_work {
        let closing_work = value(Parameter::ClosingWork);
        changes.push(change("adhesion.closing_work", closing_work));
    }
    if is_free(Parameter::Modulus) {
        changes.push(modulus_change(scene, value(Parameter::Modulus)));
    }
    if is_free(Parameter::Stiffness) {
        changes.push(change("loading_stiffness", value(Parameter::Stiffness)));
    }
    for (parameter, path) in [
        (Parameter::Radius, radius_path(scene)),
        (Parameter::SecondRadius, SECOND_RADIUS),
        (Parameter::Behind, SECOND_BEHIND),
        (Parameter::RelaxationShare, "material.relaxation.share"),
        (Parameter::RelaxationTime, "material.relaxation.time"),
    ] {
        if is_free(parameter) {
            changes.push(change(path, value(parameter)));
        }
    }
    changes.push(curve.loading(value(Parameter::Offset), pause_of(scene)));
    document.set_all(&changes).map_err(wrong)
}

/// Returns the change of the modulus. It is a change of Young's modulus or of the effective
/// modulus, whichever the scene states.
fn modulus_change(scene: &Scene, modulus: f64) -> Change {
    match scene.material.poisson_ratio {
        Some(ratio) => {
            let youngs_modulus = modulus * (1.0 - ratio) * (1.0 + ratio);
            change("material.youngs_modulus", youngs_modulus)
        }
        None => change("material.modulus", modulus),
    }
}

impl MeasuredCurve {
    /// Returns a copy of a scene that has the stiffness of the instrument. This is the
    /// `loading_stiffness` of the scene or, if the scene has none, the stiffness in the file of
    /// this curve. If the measured displacement is that of the body, the instrument becomes rigid.
    /// The second value is a sentence about the choice of the stiffness. It is `None` if nothing
    /// had to be chosen, because scene and file agree.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow this stiffness.
    pub fn with_instrument(
        &self,
        document: &Document,
    ) -> Result<(Document, Option<String>), SceneErrors> {
        let of_scene = document.scene().loading_stiffness;
        if let Some(name) = &self.of_body {
            return as_body_displacement(document, name);
        }
        let Some((name, stated)) = &self.stiffness else {
            return Ok((document.clone(), None));
        };
        let newtons_per_metre = format_quantity(*stated, "N/m");
        let Some(of_scene) = of_scene else {
            let text = format!("Loading stiffness {newtons_per_metre} by the {name} of the file.");
            let document = with_stiffness(document, ron_float(*stated))?;
            return Ok((document, Some(text)));
        };
        if (stated / of_scene - 1.0).abs() > OTHER {
            let of_scene = format_quantity(of_scene, "N/m");
            let text = format!(
                "Loading stiffness {of_scene} by the scene; the {name} of the file is {newtons_per_metre}."
            );
            return Ok((document.clone(), Some(text)));
        }
        Ok((document.clone(), None))
    }

    /// Returns a copy of a scene in which the stiffness of the instrument is the one that the file
    /// of this curve states. If the file states none, the scene is not changed. The second value is
    /// a sentence about the change, or `None` if nothing has changed.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow this stiffness.
    pub fn with_instrument_of_file(
        &self,
        document: &Document,
    ) -> Result<(Document, Option<String>), SceneErrors> {
        let of_scene = document.scene().loading_stiffness;
        let (Some((name, stated)), Some(of_scene)) = (&self.stiffness, of_scene) else {
            return self.with_instrument(document);
        };
        if self.of_body.is_some() || (stated / of_scene - 1.0).abs() <= OTHER {
            return self.with_instrument(document);
        }
        let stated_text = format_quantity(*stated, "N/m");
        let of_scene = format_quantity(of_scene, "N/m");
        let text = format!(
            "Loading stiffness {stated_text} by the {name} of the file, in place of {of_scene} of the scene."
        );
        let document = with_stiffness(document, ron_float(*stated))?;
        Ok((document, Some(text)))
    }

    /// Returns a copy of a scene with the loading of this measured curve and with the stiffness of
    /// the instrument, which is chosen as in [`Self::with_instrument`]. `offset` is the measured
    /// displacement in m at which the bodies first touch.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow this loading or this stiffness.
    pub fn load(&self, document: &Document, offset: f64) -> Result<Document, SceneErrors> {
        self.with_instrument(document)?
            .0
            .set_all(&[self.loading(offset, pause_of(document.scene()))])
    }

    pub(crate) fn loading(&self, offset: f64, pause: f64) -> Change {
        let last = self.turns.len() - 1;
        let mut stages = String::new();
        for turn in &self.turns[..last] {
            let displacement = ron_float(round_to(turn - offset, 10));
            stages += &format!("ToDisplacement({displacement}), ");
            if pause > 0.0 {
                stages += &format!("Hold({}), ", ron_float(pause));
            }
        }
        ("loading".to_owned(), format!("[{stages}ToSeparation]"))
    }
}

fn with_stiffness(document: &Document, value: String) -> Result<Document, SceneErrors> {
    document.set_all(&[("loading_stiffness".to_owned(), value)])
}

/// Returns the document with a rigid instrument and a sentence about this change. It is used if the
/// displacement of the curve, from the column `name`, is the displacement of the body.
fn as_body_displacement(
    document: &Document,
    name: &str,
) -> Result<(Document, Option<String>), SceneErrors> {
    let mut text =
        format!("{name} is a displacement of the body, without the deflection of the instrument");
    let Some(stiffness) = document.scene().loading_stiffness else {
        return Ok((document.clone(), Some(text + ".")));
    };
    let stiffness = format_quantity(stiffness, "N/m");
    text += &format!(": the loading_stiffness of {stiffness} is left out.");
    let document = with_stiffness(document, "None".to_owned())?;
    Ok((document, Some(text)))
}

/// Converts the first error of a scene with changed values to an error of the fit.
pub(crate) fn wrong(errors: SceneErrors) -> ExperimentError {
    let error = errors.first();
    let found = format!("{} = {}", error.field, error.value);
    ExperimentError::Refused {
        found,
        allowed: error.allowed.clone(),
        remedies: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{on_rubber, read, rubber};
    use crate::read::options::Drift;
    use asperity_surface::Sphere;

    #[test]
    fn values_found_are_written_where_they_belong() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let document = on_rubber(1e-3, 2e6);
        let values = [0.04, 0.03, 3e6, 2e-6, 0.0, 5.0, 6e-6, 4e-6, 1e-7, 0.2, 10.0];
        let of_sphere =
            |parameter: Parameter| !parameter.is_of_two_spheres() && !parameter.is_of_relaxation();
        let all = with_values(&document, &values, of_sphere, &curve).unwrap();
        let scene = all.scene();
        let adhesion = scene.adhesion.unwrap();
        assert_eq!(
            (adhesion.work(), adhesion.closing_work()),
            (Some(0.04), Some(0.03))
        );
        assert_eq!(
            (scene.material.modulus_in_pascals(), scene.loading_stiffness),
            (3e6, Some(5.0))
        );
        assert_eq!(
            (radius_of(scene), most_on_closing(scene)),
            (Some(6e-6), 0.03)
        );
        // Parameters that are not free remain unchanged.
        let none = with_values(&document, &values, |_| false, &curve).unwrap();
        let scene = none.scene();
        assert_eq!(
            scene
                .adhesion
                .map(|adhesion| (adhesion.work(), adhesion.closing_work())),
            Some((Some(1e-3), None))
        );
        assert_eq!(
            (scene.material.modulus_in_pascals(), scene.loading_stiffness),
            (2e6, Some(3.0))
        );
        assert_eq!(
            (radius_of(scene), most_on_closing(scene)),
            (Some(7.5e-6), f64::INFINITY)
        );
        let two = "Spheres([(radius: 7.5e-6), (radius: 7.5e-6), (radius: 1e-6)])";
        let two = document.set("form", two).unwrap();
        let found = with_values(
            &two,
            &values,
            |parameter| !parameter.is_of_relaxation(),
            &curve,
        )
        .unwrap();
        let sphere = |radius: f64, behind: f64| Sphere { radius, behind };
        let spheres = [sphere(6e-6, 0.0), sphere(4e-6, 1e-7), sphere(1e-6, 0.0)];
        assert_eq!(found.scene().form, Some(Form::Spheres(spheres.to_vec())));
        // The scene states the modulus by Young's modulus and Poisson's ratio.
        let plane = [(
            "material".to_owned(),
            "(youngs_modulus: 1e6, poisson_ratio: 0.5)".to_owned(),
        )];
        let plane = document.set_all(&plane).unwrap();
        let found = with_values(
            &plane,
            &values,
            |parameter| parameter == Parameter::Modulus,
            &curve,
        )
        .unwrap();
        assert!((found.scene().material.modulus_in_pascals() / 3e6 - 1.0).abs() < 1e-12);
        // The work on closing in the scene changes with the work of adhesion.
        let closing = document
            .set_all(&[("adhesion.closing_work".to_owned(), "1e-4".to_owned())])
            .unwrap();
        let found = with_values(
            &closing,
            &values,
            |parameter| parameter == Parameter::Work,
            &curve,
        )
        .unwrap();
        assert_eq!(found.scene().adhesion.unwrap().closing_work(), Some(0.03));
    }
}
