//! A measured force curve, placed over the displacement of the instrument beside the scene.

use super::studies::Findings;
use asperity_contact::CurvePoint;
use asperity_experiment::{CurveOptions, Fit, Free, MeasuredCurve};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    pub name: String,
    pub curve: Arc<MeasuredCurve>,
    /// Options with which the curve was read, as arguments of a command.
    pub options: String,
    /// Measured displacement at first touch, m.
    pub offset: f64,
}

impl Measured {
    pub fn new(name: String, curve: MeasuredCurve, options: &CurveOptions) -> Self {
        Measured { name, offset: curve.touch, curve: curve.into(), options: options.to_string() }
    }

    /// The measured points as points of a force curve, for an instrument of this stiffness, N/m.
    pub fn points(&self, stiffness: f64) -> Vec<CurvePoint> {
        let point = |(at, force): (&f64, &f64)| {
            let indentation = at - self.offset - force / stiffness;
            CurvePoint { indentation, force: *force, ..CurvePoint::default() }
        };
        self.curve.displacement.iter().zip(&self.curve.force).map(point).collect()
    }
}

/// A fit of parameters to the curve, while it is computed.
#[derive(Clone, Debug)]
pub struct Fitting {
    pub free: Vec<Free>,
    pub evaluations: usize,
    pub found: Option<Result<Arc<Fit>, String>>,
}

/// The fit to the present scene, either of the position of the curve alone or also of parameters; `None` if not known yet.
pub fn fitted(studies: &Findings) -> Option<&Fit> {
    studies.value::<Arc<Fit>>().map(|fit| &**fit)
}

/// Reason why the scene cannot be compared with the curve, if it cannot.
pub fn failure(studies: &Findings) -> Option<&str> {
    studies.failure::<Arc<Fit>>()
}
