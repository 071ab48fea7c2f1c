//! Loops of random squares in three dimensions for comparison with the profile, as far as they are
//! computed.

use super::compared::{Compared, Values};
use super::error::StudyError;
use super::profiles::Stop;
use super::reference::{Reference, ReferenceEvent, ReferenceOptions};
use super::statistics::Statistics;
use asperity_contact::CurvePoint;
use asperity_scene::{CheckedScene, Simulation};

/// Force curves of the random squares of a [`Reference`].
#[derive(Clone, Debug, Default)]
pub struct SquareLoops {
    /// Number of squares that the complete comparison has.
    pub maps: u64,
    /// Force curve of each computed square from first touch on: points with indentation in m and
    /// force in N.
    pub curves: Vec<Vec<(f64, f64)>>,
    /// Adhesion force of each random profile in N, or its indentation at the preload in m if the
    /// scene has no adhesion.
    pub lines: Vec<f64>,
    /// Adhesion force of each computed square in N, or its indentation at the preload in m if the
    /// scene has no adhesion.
    pub squares: Vec<f64>,
    /// Estimated share of the computation of the squares that is done, from 0 to 1.
    pub share: f64,
    /// Comparison of all squares with the random profiles; `None` until all squares are computed.
    pub reference: Option<Reference>,
}

impl SquareLoops {
    /// Computes the force curves of squares for a scene, with the options [`ReferenceOptions::of`].
    /// `simulation` knows the folder of the measured files of the scene, and `jobs` is the number
    /// of threads. `report` receives the curves so far at the beginning, after each hundredth of
    /// the computation, and after each square.
    ///
    /// # Errors
    /// The errors are the same as those of [`Reference::of`].
    pub fn of(
        scene: &CheckedScene,
        simulation: Simulation,
        jobs: usize,
        stop: &Stop<'_>,
        report: &mut dyn FnMut(&SquareLoops),
    ) -> Result<SquareLoops, StudyError> {
        let options = ReferenceOptions::of(scene, None);
        let mut loops = SquareLoops::default();
        let mut take_in = |event| {
            if loops.take(event) {
                report(&loops);
            }
        };
        let reference = Reference::of(scene, options, simulation, jobs, stop, &mut take_in)?;
        Ok(SquareLoops {
            reference: Some(reference),
            share: 1.0,
            ..loops
        })
    }

    /// Takes in an event. Returns true if there is something new to show.
    fn take(&mut self, event: ReferenceEvent) -> bool {
        match event {
            ReferenceEvent::Begins { maps, .. } => self.maps = maps,
            ReferenceEvent::Profiles { .. } => return false,
            ReferenceEvent::ProfilesEnd { lines } => {
                self.lines = lines;
                return false;
            }
            ReferenceEvent::Loaded { share } => {
                let before = (100.0 * self.share).floor();
                // The number of loads is an estimate.
                self.share = (self.share + share).min(0.99);
                return (100.0 * self.share).floor() > before;
            }
            ReferenceEvent::Square { curve, headline } => {
                self.curves.push(curve);
                self.squares.push(headline);
            }
        }
        true
    }

    /// Compares the values [`SquareLoops::lines`] of the profiles with the values
    /// [`SquareLoops::squares`]; `None` before the first square is computed.
    pub fn headline(&self) -> Option<Compared> {
        let values = Values {
            lines: self.lines.clone(),
            squares: self.squares.clone(),
            coarse: Vec::new(),
        };
        values.compared()
    }

    /// Returns the mean and the scatter of the force of the computed squares as a function of the
    /// indentation. There is one band for loading, and a second band for unloading if the scene has
    /// adhesion. A band is three curves: mean force minus standard deviation, mean force, and mean
    /// force plus standard deviation.
    pub fn bands(&self) -> Vec<[Vec<CurvePoint>; 3]> {
        let stages = |curve: &Vec<(f64, f64)>| {
            let deepest = (0..curve.len())
                .max_by(|a, b| curve[*a].0.total_cmp(&curve[*b].0))
                .unwrap_or(0);
            // A separated square has no force, and the first point of a loading is first touch.
            let mut loading = curve[..curve.len().min(deepest + 1)].to_vec();
            if loading.first().is_some_and(|first| first.0 > 0.0) {
                loading.insert(0, (0.0, 0.0));
            }
            [loading, curve.iter().skip(deepest).rev().copied().collect()]
        };
        let stages: Vec<[Vec<(f64, f64)>; 2]> = self.curves.iter().map(stages).collect();
        let band = |stage: usize| {
            let parts: Vec<_> = stages
                .iter()
                .map(|of| &of[stage])
                .filter(|part| part.len() > 1)
                .collect();
            let low = parts.iter().map(|part| part[0].0).min_by(f64::total_cmp)?;
            let high = parts
                .iter()
                .map(|part| part[part.len() - 1].0)
                .min_by(f64::total_cmp)?;
            let mut band = [const { Vec::new() }; 3];
            for at in 0..=BAND_POINTS {
                let indentation = low + (high - low) * at as f64 / BAND_POINTS as f64;
                let forces = parts
                    .iter()
                    .map(|part| force_at(part, indentation))
                    .collect();
                let forces = Statistics::of(forces, (f64::NEG_INFINITY, f64::INFINITY))?;
                let spread = forces
                    .spread
                    .map_or(0.0, |spread| spread.standard_deviation);
                for (curve, sign) in band.iter_mut().zip([-1.0, 0.0, 1.0]) {
                    let force = forces.mean + sign * spread;
                    curve.push(CurvePoint {
                        indentation,
                        force,
                        ..CurvePoint::default()
                    });
                }
            }
            Some(band)
        };
        (0..2).filter_map(band).collect()
    }
}

/// Steps of a band.
const BAND_POINTS: usize = 100;

/// Returns the force in N at an indentation in m, between points in the order of their
/// indentations.
fn force_at(points: &[(f64, f64)], indentation: f64) -> f64 {
    let after = points
        .partition_point(|point| point.0 < indentation)
        .clamp(1, points.len() - 1);
    let [one, other] = [points[after - 1], points[after]];
    let share = ((indentation - one.0) / (other.0 - one.0)).clamp(0.0, 1.0);
    if share.is_nan() {
        one.1
    } else {
        one.1 + share * (other.1 - one.1)
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
        let mut shares = Vec::new();
        let mut report = |loops: &SquareLoops| {
            counts.push((loops.maps, loops.curves.len()));
            shares.push(loops.share);
        };
        let loops = SquareLoops::of(
            scene.scene(),
            Simulation::default(),
            1,
            &|| false,
            &mut report,
        )
        .unwrap();
        // There is progress before the only square is finished.
        assert_eq!((counts[0], shares[0]), ((1, 0), 0.0));
        assert_eq!(counts.last(), Some(&(1, 1)));
        assert!(
            counts.iter().filter(|count| **count == (1, 0)).count() > 20,
            "{counts:?}"
        );
        assert!(
            shares.is_sorted() && shares.last() > Some(&0.5) && shares.last() < Some(&1.0),
            "{shares:?}"
        );
        let lowest = loops.curves[0]
            .iter()
            .map(|point| -point.1)
            .fold(0.0, f64::max);
        assert_eq!(vec![lowest], loops.squares);
        let compared = loops.reference.as_ref().unwrap().adhesion_force;
        let ratio = compared.unwrap().ratio;
        assert_eq!(Some(ratio), loops.headline().map(|headline| headline.ratio));
        assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
        assert_eq!(loops.bands().len(), 2);
        let stopped = SquareLoops::of(
            scene.scene(),
            Simulation::default(),
            1,
            &|| true,
            &mut |_| (),
        );
        assert!(stopped.is_err());
    }

    #[test]
    fn a_band_has_the_mean_and_the_standard_deviation() {
        let pulled = |factor: f64| {
            let points = [
                (0.0, -1.0),
                (2.0, 3.0),
                (1.0, 1.0),
                (-1.0, -2.0),
                (-2.0, 0.0),
            ];
            points
                .map(|(indentation, force)| (indentation, factor * force))
                .to_vec()
        };
        let loops = SquareLoops {
            curves: vec![pulled(1.0), pulled(3.0)],
            ..SquareLoops::default()
        };
        let [loading, unloading] = <[_; 2]>::try_from(loops.bands()).unwrap();
        let at = |band: &[Vec<CurvePoint>; 3], index: usize| {
            let [lower, mean, upper] = band.each_ref().map(|curve| curve[index].force);
            (band[1][index].indentation, mean, upper - mean, mean - lower)
        };
        let root = 2.0_f64.sqrt();
        assert_eq!(at(&loading, 0).0, 0.0);
        assert_eq!(at(&loading, 0).1, -2.0);
        assert_eq!(at(&unloading, 100).0, 2.0);
        let (indentation, mean, up, down) = at(&unloading, 25);
        assert_eq!((indentation, mean), (-1.0, -4.0));
        assert!(
            (up - 2.0 * root).abs() < 1e-12 && (down - 2.0 * root).abs() < 1e-12,
            "{up} {down}"
        );
        // Without adhesion there is a loading alone, which begins at first touch.
        let pressed = SquareLoops {
            curves: vec![vec![(1.0, 2.0), (2.0, 4.0)]],
            ..SquareLoops::default()
        };
        let bands = pressed.bands();
        assert_eq!((bands.len(), at(&bands[0], 25)), (1, (0.5, 1.0, 0.0, 0.0)));
        assert!(SquareLoops::default().bands().is_empty());
    }
}
