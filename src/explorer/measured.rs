//! A measured force curve that the explorer compares with the scene. The curve is the force as a
//! function of the displacement of the instrument.

use super::studies::Findings;
use crate::explorer::advice;
use asperity_contact::CurvePoint;
use asperity_data::path_name;
use asperity_experiment::{CurveOptions, ExperimentError, FitResult, Free, MeasuredCurve};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Path of the file without control characters, as it is shown on the screen.
    pub name: String,
    pub path: PathBuf,
    pub curve: Arc<MeasuredCurve>,
    /// Options with which the curve has been read.
    pub options: CurveOptions,
    /// Displacement of the instrument at first touch, m.
    pub offset: f64,
}

impl Measured {
    /// Reads a curve from a file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read with these options.
    pub fn read(path: &Path, options: CurveOptions) -> Result<Self, ExperimentError> {
        let curve = MeasuredCurve::read(path, &options)?;
        Ok(Measured {
            name: path_name(path),
            path: path.to_owned(),
            offset: curve.touch,
            curve: curve.into(),
            options,
        })
    }

    /// Reads the file again with other options. If the displacements do not change, the
    /// displacement at first touch does not change either.
    pub fn read_again(&self, options: CurveOptions) -> Result<Self, ExperimentError> {
        let mut measured = Measured::read(&self.path, options)?;
        if measured.curve.displacement == self.curve.displacement {
            measured.offset = self.offset;
        }
        Ok(measured)
    }

    /// Returns sentences that state how the curve was prepared, for example how its units were
    /// found. Each sentence names the rows of the list of parameters in which the user can change
    /// this.
    pub fn statements(&self) -> String {
        let notes = self.curve.statements.iter();
        let sentences: Vec<String> = notes.map(|note| note.in_words(advice::row)).collect();
        sentences.join(" ")
    }

    /// Returns the measured points as points of a force curve. The indentation follows from the
    /// displacement, the force and the stiffness of the instrument in N/m.
    pub fn points(&self, stiffness: f64) -> Vec<CurvePoint> {
        let mut points = Vec::new();
        for (displacement, force) in self.curve.displacement.iter().zip(&self.curve.force) {
            points.push(CurvePoint {
                indentation: displacement - self.offset - force / stiffness,
                force: *force,
                ..CurvePoint::default()
            });
        }
        points
    }

    /// Returns the residuals: the measured forces minus the forces of a model (in N), divided by
    /// the noise.
    pub fn residuals(&self, model: &[f64]) -> Vec<f64> {
        let forces = self.curve.force.iter().zip(model);
        forces
            .map(|(measured, computed)| (measured - computed) / self.curve.noise)
            .collect()
    }
}

/// Fit of parameters to the measured curve, as far as it is computed.
#[derive(Clone, Debug)]
pub struct Fitting {
    pub free: Vec<Free>,
    pub evaluations: u64,
    pub found: Option<Result<Arc<FitResult>, String>>,
}

/// Returns the fit of the present scene to the measured curve; `None` if the fit is not computed
/// yet. The fit always determines the displacement at first touch. It determines other parameters
/// only if the user has requested this.
pub fn fitted(studies: &Findings) -> Option<&FitResult> {
    studies.value::<Arc<FitResult>>().map(|fit| &**fit)
}

/// Returns the reason why the scene cannot be compared with the measured curve; `None` if the
/// comparison has not failed.
pub fn failure(studies: &Findings) -> Option<&str> {
    studies.failure::<Arc<FitResult>>()
}
