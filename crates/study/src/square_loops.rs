//! Force curves of random square surfaces in three dimensions, for comparison with the force curves
//! of profiles. The results can be shown while they are computed.

use super::compared::{Compared, Values};
use super::error::StudyError;
use super::reference::{Reference, ReferenceEvent, ReferenceOptions};
use super::statistics::Statistics;
use asperity_contact::CurvePoint;
use asperity_data::Control;
use asperity_scene::{CheckedScene, Simulation};

/// Force curves of random square surfaces, and their comparison with random profiles, a
/// [`Reference`]. A square surface is a rough body in three dimensions with a square base.
#[derive(Clone, Debug, Default)]
pub struct SquareLoops {
    /// Number of square surfaces in the complete comparison.
    pub surfaces: u64,
    /// Force curve of each computed square surface from first touch on: points with indentation in
    /// m and force in N.
    pub curves: Vec<Vec<(f64, f64)>>,
    /// Pull-off force of each random profile in N, or its indentation at the preload in m if the
    /// scene has no adhesion.
    pub lines: Vec<f64>,
    /// Pull-off force of each computed square surface in N, or its indentation at the preload in m
    /// if the scene has no adhesion.
    pub squares: Vec<f64>,
    /// Estimated share of the computation of the square surfaces that is done, from 0 to 1.
    pub share: f64,
    /// Comparison of all square surfaces with the random profiles; `None` until all square surfaces
    /// are computed.
    pub reference: Option<Reference>,
}

impl SquareLoops {
    /// Computes the force curves of square surfaces for a scene, with the usual options
    /// [`ReferenceOptions::of`]. `simulation` knows the folder of the measured files of the scene.
    /// `control` receives the curves computed so far: at the beginning, after each hundredth of the
    /// computation, and after each square surface.
    ///
    /// # Errors
    /// The errors are the same as those of [`Reference::of`].
    pub fn of(
        scene: &CheckedScene,
        simulation: &mut Simulation,
        mut control: Control<'_, SquareLoops>,
    ) -> Result<SquareLoops, StudyError> {
        let options = ReferenceOptions::of(scene, None);
        let mut loops = SquareLoops::default();
        let reference_control = control.of_part();
        let mut report = |event: &ReferenceEvent| {
            if loops.take_in(event) {
                control.report(&loops);
            }
        };
        let reference_control = reference_control.reporting_to(&mut report);
        let reference = Reference::of(scene, options, simulation, reference_control)?;
        loops.reference = Some(reference);
        loops.share = 1.0;
        Ok(loops)
    }

    /// Adds the data of an event. Returns true if the loops on the screen have to be drawn again.
    fn take_in(&mut self, event: &ReferenceEvent) -> bool {
        match event {
            ReferenceEvent::Begins { surfaces, .. } => self.surfaces = *surfaces,
            ReferenceEvent::Profiles { .. } => return false,
            ReferenceEvent::ProfilesEnd { lines } => {
                self.lines.clone_from(lines);
                return false;
            }
            ReferenceEvent::Loaded { share } => {
                let before = (100.0 * self.share).floor();
                // The number of loads is only an estimate, so the sum of the shares may reach 1 too
                // early. It is therefore limited.
                self.share = (self.share + share).min(0.99);
                return (100.0 * self.share).floor() > before;
            }
            ReferenceEvent::Square { curve, headline } => {
                self.curves.push(curve.clone());
                self.squares.push(*headline);
            }
        }
        true
    }

    /// Returns the comparison of the pull-off force on profiles with the pull-off force on square
    /// surfaces. If the scene has no adhesion, the indentations at the preload are compared. `None`
    /// before the first square surface is computed.
    pub fn headline(&self) -> Option<Compared> {
        let values = Values {
            lines: self.lines.clone(),
            squares: self.squares.clone(),
            coarse: Vec::new(),
        };
        values.compared()
    }

    /// Returns bands that show the force of the computed square surfaces as a function of the
    /// indentation. There is one band for loading, and a second band for unloading if the scene has
    /// adhesion. A band is three curves: the mean force minus the standard deviation, the mean
    /// force, and the mean force plus the standard deviation. Mean and standard deviation are those
    /// over the surfaces.
    pub fn bands(&self) -> Vec<[Vec<CurvePoint>; 3]> {
        let loadings: Vec<Curve> = self.curves.iter().map(|curve| loading_of(curve)).collect();
        let unloadings: Vec<Curve> = self
            .curves
            .iter()
            .map(|curve| unloading_of(curve))
            .collect();
        [loadings, unloadings]
            .iter()
            .filter_map(|curves| band(curves))
            .collect()
    }
}

/// Points with indentation in m and force in N.
type Curve = Vec<(f64, f64)>;

/// Returns the index of the last point with the largest indentation.
fn deepest(curve: &[(f64, f64)]) -> usize {
    (0..curve.len())
        .max_by(|first, second| curve[*first].0.total_cmp(&curve[*second].0))
        .unwrap_or(0)
}

/// Returns the points of the loading in ascending order of their indentations.
fn loading_of(curve: &[(f64, f64)]) -> Curve {
    let mut loading = curve[..curve.len().min(deepest(curve) + 1)].to_vec();
    // Only a loading without adhesion lacks a point at zero indentation, where the force is zero. A
    // loading with adhesion begins at first touch, at zero indentation.
    if loading.first().is_some_and(|first| first.0 > 0.0) {
        loading.insert(0, (0.0, 0.0));
    }
    loading
}

/// Returns the points of the unloading in ascending order of their indentations.
fn unloading_of(curve: &[(f64, f64)]) -> Curve {
    curve.iter().skip(deepest(curve)).rev().copied().collect()
}

/// Returns the mean and the scatter of several curves. The band extends from the smallest
/// indentation of any curve to the largest indentation that all curves reach. Returns `None` if no
/// curve has two points.
fn band(curves: &[Curve]) -> Option<[Vec<CurvePoint>; 3]> {
    let curves: Vec<&Curve> = curves.iter().filter(|curve| curve.len() > 1).collect();
    let beginnings = curves.iter().map(|curve| curve[0].0);
    let ends = curves.iter().map(|curve| curve[curve.len() - 1].0);
    let low = beginnings.min_by(f64::total_cmp)?;
    let high = ends.min_by(f64::total_cmp)?;
    let mut band = [const { Vec::new() }; 3];
    for step in 0..=BAND_POINTS {
        let indentation = low + (high - low) * step as f64 / BAND_POINTS as f64;
        let forces = curves.iter().map(|curve| force_at(curve, indentation));
        let forces = Statistics::of(forces.collect(), (f64::NEG_INFINITY, f64::INFINITY))?;
        let deviation = forces
            .spread
            .map_or(0.0, |spread| spread.standard_deviation);
        for (curve, sign) in band.iter_mut().zip([-1.0, 0.0, 1.0]) {
            let force = forces.mean + sign * deviation;
            curve.push(CurvePoint {
                indentation,
                force,
                ..CurvePoint::default()
            });
        }
    }
    Some(band)
}

/// Number of steps of the indentation in a band.
const BAND_POINTS: usize = 100;

/// Returns the force in N at an indentation in m, interpolated between points. The indentations of
/// the points ascend.
fn force_at(points: &[(f64, f64)], indentation: f64) -> f64 {
    let after = points
        .partition_point(|point| point.0 < indentation)
        .clamp(1, points.len() - 1);
    let (left, left_force) = points[after - 1];
    let (right, right_force) = points[after];
    let share = ((indentation - left) / (right - left)).clamp(0.0, 1.0);
    if share.is_nan() {
        left_force
    } else {
        left_force + share * (right_force - left_force)
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
            counts.push((loops.surfaces, loops.curves.len()));
            shares.push(loops.share);
        };
        let control = Control::default().on_threads(1).reporting_to(&mut report);
        let loops = SquareLoops::of(scene.scene(), &mut Simulation::default(), control).unwrap();
        // The progress is reported before the only square surface is finished.
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
        let compared = loops.reference.as_ref().unwrap().pull_off_force;
        let ratio = compared.unwrap().ratio;
        assert_eq!(Some(ratio), loops.headline().map(|headline| headline.ratio));
        assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
        assert_eq!(loops.bands().len(), 2);
        let control = Control::default().stopped_by(&|| true);
        let stopped = SquareLoops::of(scene.scene(), &mut Simulation::default(), control);
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
        // Without adhesion there is only one band, for the loading. It begins at first touch.
        let pressed = SquareLoops {
            curves: vec![vec![(1.0, 2.0), (2.0, 4.0)]],
            ..SquareLoops::default()
        };
        let bands = pressed.bands();
        assert_eq!((bands.len(), at(&bands[0], 25)), (1, (0.5, 1.0, 0.0, 0.0)));
        assert!(SquareLoops::default().bands().is_empty());
    }
}
