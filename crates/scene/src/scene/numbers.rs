//! Numerical values of a scene, which studies read and set by their paths.

use super::adhesion::Adhesion;
use super::errors::NumberError;
use super::fields::FIELDS;
use super::model::Scene;
use super::spheres::MEMBERS;

impl Scene {
    /// Returns the numerical value at a path, such as `form.radius`, `roughness.modes.0` or
    /// `loading.1.0`. Returns `None` if the scene has no numerical value at this path.
    ///
    /// ```
    /// let sphere = asperity_scene::open("jkr-sphere")?;
    /// assert_eq!(sphere.scene().number("length"), Some(1.0e-4));
    /// assert_eq!(sphere.scene().number("form.angle"), None);
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn number(&self, path: &str) -> Option<f64> {
        FIELDS
            .iter()
            .find_map(|field| field.value(self)?.number(field.inside_path(path)?))
    }

    /// Returns the paths of all numerical values in lists, such as `form.1.radius` of a sphere or
    /// `loading.0.0` of a stage. The elements of these lists have no fields in [`FIELDS`].
    pub fn paths_in_lists(&self) -> Vec<String> {
        let spheres = self.form.as_ref().map_or(0, |form| form.spheres().len());
        let mut paths = Vec::new();
        for sphere in 0..spheres {
            paths.extend(MEMBERS.map(|member| format!("form.{sphere}.{member}")));
        }
        paths.extend((0..self.loading.len()).map(|stage| format!("loading.{stage}.0")));
        paths
    }

    /// Sets the numerical value at a path without checking its range. If the scene has no such
    /// value yet, the value is added.
    ///
    /// # Errors
    /// Returns an error if the scene cannot have a numerical value at this path, or if the new
    /// value contradicts another value. The scene then stays unchanged.
    ///
    /// ```
    /// use asperity_scene::fields::NumberError;
    ///
    /// let mut scene = asperity_scene::Scene::clone(asperity_scene::open("jkr-sphere")?.scene());
    /// scene.set_number("length", 2.0e-4).unwrap();
    /// assert_eq!(scene.length, 2.0e-4);
    /// assert_eq!(scene.set_number("width", 1.0), Err(NumberError::Missing));
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn set_number(&mut self, path: &str, number: f64) -> Result<(), NumberError> {
        for field in FIELDS {
            let Some(inside) = field.inside_path(path) else {
                continue;
            };
            if let Some(slot) = (field.place.slot_mut)(self)
                && slot.set_number(inside, number)
            {
                return Ok(());
            }
        }
        // A number of the adhesion is set by its own function, because the present values of the
        // adhesion decide which numbers can be set: an adhesion has either a work or a parameter.
        let name = path.strip_prefix("adhesion.").ok_or(NumberError::Missing)?;
        self.adhesion = Some(Adhesion::with_number(self.adhesion, name, number)?);
        Ok(())
    }
}
