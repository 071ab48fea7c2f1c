//! A measured force curve beside the scene, in its place over the displacement.

use super::studies::Findings;
use asperity_contact::CurvePoint;
use asperity_study::{CurveOptions, Fit, Free, MeasuredCurve};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Name of its file.
    pub name: String,
    pub curve: Arc<MeasuredCurve>,
    /// The options of reading, as arguments of a command.
    pub options: String,
    /// Measured displacement at first touch, m.
    pub offset: f64,
}

impl Measured {
    pub fn new(name: String, curve: MeasuredCurve, options: &CurveOptions) -> Self {
        Measured { name, offset: curve.touch, curve: curve.into(), options: options.to_string() }
    }

    /// The points on the curve of a scene with an instrument of this stiffness, N/m.
    pub fn points(&self, stiffness: f64) -> Vec<CurvePoint> {
        let point = |(at, force): (&f64, &f64)| {
            let indentation = at - self.offset - force / stiffness;
            CurvePoint { indentation, force: *force, ..CurvePoint::default() }
        };
        self.curve.displacement.iter().zip(&self.curve.force).map(point).collect()
    }
}

/// Search of parameters that describe the curve.
#[derive(Clone, Debug)]
pub struct Fitting {
    pub free: Vec<Free>,
    /// Number of computed curves.
    pub evaluations: usize,
    pub found: Option<Result<Arc<Fit>, String>>,
}

/// The fit of the present scene, of the place of the curve alone or of further parameters.
pub fn fitted(studies: &Findings) -> Option<&Fit> {
    studies.value::<Arc<Fit>>().map(|fit| &**fit)
}

/// Reason why the scene cannot be compared with the curve.
pub fn failure(studies: &Findings) -> Option<&str> {
    studies.failure::<Arc<Fit>>()
}
