//! A measured force curve, placed over the displacement of the instrument beside the scene.

use super::studies::Findings;
use crate::explorer::advice;
use asperity_contact::CurvePoint;
use asperity_data::path_name;
use asperity_experiment::{CurveOptions, ExperimentError, FitResult, Free, MeasuredCurve};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Path of the file without control characters, for the screen.
    pub name: String,
    pub path: PathBuf,
    pub curve: Arc<MeasuredCurve>,
    /// Options with which the curve was read.
    pub options: CurveOptions,
    /// Measured displacement at first touch, m.
    pub offset: f64,
}

impl Measured {
    /// Reads a curve from a file.
    ///
    /// # Errors
    /// The reason why the file is not read with these options.
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

    /// The curve as read with other options. First touch stays where it was found if the
    /// displacements are the same.
    pub fn read_again(&self, options: CurveOptions) -> Result<Self, ExperimentError> {
        let mut measured = Measured::read(&self.path, options)?;
        if measured.curve.displacement == self.curve.displacement {
            measured.offset = self.offset;
        }
        Ok(measured)
    }

    /// The sentences on the curve, with the rows that change what they state.
    pub fn statements(&self) -> String {
        let notes = self.curve.statements.iter();
        let sentences: Vec<String> = notes.map(|note| note.in_words(advice::row)).collect();
        sentences.join(" ")
    }

    /// The measured points as points of a force curve, for an instrument of this stiffness, N/m.
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

    /// Differences of the measured forces from the forces of a model, N, in units of the noise.
    pub fn residuals(&self, model: &[f64]) -> Vec<f64> {
        let forces = self.curve.force.iter().zip(model);
        forces
            .map(|(measured, computed)| (measured - computed) / self.curve.noise)
            .collect()
    }
}

/// A fit of parameters to the curve, while it is computed.
#[derive(Clone, Debug)]
pub struct Fitting {
    pub free: Vec<Free>,
    pub evaluations: u64,
    pub found: Option<Result<Arc<FitResult>, String>>,
}

/// The fit to the present scene, of the position of the curve only, or of parameters too; `None` if
/// not known yet.
pub fn fitted(studies: &Findings) -> Option<&FitResult> {
    studies.value::<Arc<FitResult>>().map(|fit| &**fit)
}

/// Reason why the scene cannot be compared with the curve, if it cannot.
pub fn failure(studies: &Findings) -> Option<&str> {
    studies.failure::<Arc<FitResult>>()
}
