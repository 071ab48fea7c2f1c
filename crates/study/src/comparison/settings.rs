//! Settings of a comparison between random profiles and random square surfaces.

use crate::profiles::Stop;
use crate::reference::ReferenceOptions;
use crate::resolved::Resolved;
use crate::spatial::{SquareLoading, Turn};

/// Forces at which the bodies without adhesion are compared, as shares of the preload.
pub(super) const SHARES: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.6, 1.0];
/// Number of steps of the indentation of a square surface from the preload to pull-off.
const STEPS: f64 = 40.0;
/// Largest difference between two lengths or two numbers of cells, as a share of them, that counts
/// as a rounding error.
pub(super) const ROUNDING: f64 = 1e-9;

/// Settings of a comparison between profiles and square surfaces.
pub(super) struct Comparison<'a> {
    pub resolved: Resolved,
    pub options: ReferenceOptions,
    /// Seed of the first profile and of the first square surface.
    pub seed: u64,
    /// Number of threads that share the profiles.
    pub threads: usize,
    pub stop: &'a Stop<'a>,
}

impl Comparison<'_> {
    pub fn is_adhesive(&self) -> bool {
        self.resolved.body.works.is_some()
    }

    /// Returns the loading of a square surface. `preload` is in N, and `depth` is the distance in m
    /// between the indentations at the preload and at pull-off.
    pub fn square_loading(&self, turn: Turn, preload: f64, depth: f64) -> SquareLoading {
        SquareLoading {
            forces: SHARES.map(|share| share * preload).to_vec(),
            turn,
            step: depth / STEPS,
        }
    }
}
