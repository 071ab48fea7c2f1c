//! A point of a force curve, and the direction in which a curve is passed.

use serde::Serialize;

/// Direction of a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// The indentation grows.
    Loading,
    /// The indentation falls.
    Unloading,
}

/// One point of a force curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurvePoint {
    /// Indentation d, m; 0 at first touch.
    pub indentation: f64,
    /// Force F, N; compression positive.
    pub force: f64,
    /// Length in contact, m.
    pub contact_length: f64,
    /// Springs in contact.
    pub springs: u64,
    /// Contact fragments.
    pub fragments: u64,
    /// Stored elastic energy, J: ½ Δk Σ (d − c)² over the springs in contact, compressed or stretched.
    pub stored_energy: f64,
}

impl CurvePoint {
    /// Displacement D = d + F/k, m, of an instrument of this stiffness k, N/m, that holds the body here.
    pub fn displacement(&self, stiffness: f64) -> f64 {
        self.indentation + self.force / stiffness
    }
}
