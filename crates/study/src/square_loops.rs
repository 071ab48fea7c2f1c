//! Loops of random squares in three dimensions for comparison with the profile, as far as they are computed.

use super::error::StudyError;
use super::profiles::Stop;
use super::reference::{Reference, ReferenceEvent, ReferenceOptions};
use asperity_contact::CurvePoint;
use asperity_scene::{CheckedScene, Simulation};

/// Loops of loading and unloading for random squares in three dimensions, as far as they are computed.
#[derive(Clone, Debug, Default)]
pub struct SquareLoops {
    /// Number of squares when all are computed.
    pub maps: u64,
    /// Indentation and force of each computed square, from first touch on.
    pub curves: Vec<Vec<CurvePoint>>,
    /// Adhesion forces of these squares, N; empty without adhesion.
    pub adhesion_forces: Vec<f64>,
    /// Comparison with random profiles; `None` until all squares are computed.
    pub reference: Option<Reference>,
}

impl SquareLoops {
    /// Computes the loops of a scene. After each loop `report` receives the loops so far.
    ///
    /// # Errors
    /// The same as the errors of [`Reference::of`].
    pub fn of(
        scene: &CheckedScene,
        simulation: (Simulation, usize),
        stop: &Stop<'_>,
        report: &mut dyn FnMut(&SquareLoops),
    ) -> Result<SquareLoops, StudyError> {
        let options = ReferenceOptions::of(scene, None);
        let mut loops = SquareLoops::default();
        let mut take_in = |event| {
            match event {
                ReferenceEvent::Begins { maps, .. } => loops.maps = maps,
                ReferenceEvent::Square { curve, adhesion_force } => {
                    let point =
                        |(indentation, force)| CurvePoint { indentation, force, ..CurvePoint::default() };
                    loops.curves.push(curve.into_iter().map(point).collect());
                    loops.adhesion_forces.extend(adhesion_force);
                }
            }
            report(&loops);
        };
        let reference = Reference::of(scene, options, simulation, stop, &mut take_in)?;
        Ok(SquareLoops { reference: Some(reference), ..loops })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    #[test]
    fn loops_are_reported_one_by_one() {
        let scene = open("kendall-punch").unwrap();
        let mut counts = Vec::new();
        let mut report = |loops: &SquareLoops| counts.push((loops.maps, loops.curves.len()));
        let simulation = (Simulation::default(), 1);
        let loops = SquareLoops::of(scene.scene(), simulation, &|| false, &mut report).unwrap();
        assert_eq!(counts, [(1, 0), (1, 1)]);
        let lowest = loops.curves[0].iter().map(|point| -point.force).fold(0.0, f64::max);
        assert_eq!(vec![lowest], loops.adhesion_forces);
        let ratio = loops.reference.unwrap().adhesion_force.unwrap().ratio;
        assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
        let stopped = SquareLoops::of(scene.scene(), (Simulation::default(), 1), &|| true, &mut |_| ());
        assert!(stopped.is_err());
    }
}
