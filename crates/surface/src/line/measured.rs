//! Measured surfaces as roughness. The roughness is the profile in a file, used as an equivalent
//! line, or a random equivalent line with the measured spectrum.

use super::spectrum::{Amplitude, ModeSquare};
use crate::error::{Place, SurfaceError, refused};
use crate::spectrum::analysis::{Analysis, analyse};
use crate::spectrum::options::AnalysisOptions;
use crate::topography::open::{content, parse, parse_all};
use crate::topography::options::ReadOptions;
use crate::topography::positions::{UNEVEN, first_uneven, interpolated};
use crate::topography::surface::Detrend;
use asperity_data::{OutOfMemory, check_room, gathered};
use asperity_fourier::plan_real_forward;
use std::path::{Path, PathBuf};

/// Upper bound, in bytes for each point, of the memory for the Fourier transform and its arrays.
/// The bound also holds for an odd number of points, which is transformed at twice its length.
pub(super) const TRANSFORM_BYTES: u64 = 96;

/// Options by which a scene reads and analyses its measured surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredOptions {
    /// Polynomial that is removed from a measured profile if this profile itself is used as the
    /// rigid profile.
    ///
    /// * If a polynomial is given, the profile in the file is already an equivalent line. The rigid
    ///   profile is this profile without the polynomial.
    /// * `None` means that the profile in the file is a cut through a surface. The rigid profile is
    ///   then an equivalent line of this surface: a random profile with the measured spectrum.
    pub as_line: Option<Detrend>,
    /// Options for reading the files of the measured surfaces.
    pub reading: ReadOptions,
    /// Options for the analysis of the measured surfaces, from which the spectrum follows.
    pub spectrum: AnalysisOptions,
}

/// A profile in a file that is used as an equivalent line: the heights of points at ascending
/// positions.
///
/// The profile covers the distance from its first to its last point. If the points are equally
/// spaced, the profile also covers half a spacing beyond each end.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MeasuredProfile {
    /// Positions x in m, ascending; at least two.
    pub positions: Vec<f64>,
    /// Heights z in m, one for each position, after removal of the polynomial that the options may
    /// state.
    pub heights: Vec<f64>,
}

impl MeasuredProfile {
    /// Parses the content of a file with a profile. The file may also have a map; the options then
    /// choose a row or a column of this map. Returns an error if a polynomial has to be removed and
    /// the points are not equally spaced.
    pub fn new(content: &[u8], options: &MeasuredOptions) -> Result<Self, SurfaceError> {
        let mut surface = parse(content, &options.reading)?;
        if let Some(detrend) = options.as_line.filter(|detrend| *detrend != Detrend::None) {
            surface.spacing()?;
            detrend.remove(&mut surface.heights, surface.columns);
        }
        let (positions, heights) = surface.into_profile()?;
        Ok(MeasuredProfile { positions, heights })
    }

    /// Returns the length in m that the profile covers.
    pub fn length(&self) -> f64 {
        match self.cell() {
            Some(cell) => cell * self.positions.len() as f64,
            None => self.span(),
        }
    }

    /// Returns the distance in m from the first to the last point.
    fn span(&self) -> f64 {
        self.positions[self.positions.len() - 1] - self.positions[0]
    }

    /// Returns the distance in m between the points if the points are the centres of equal cells
    /// and the first cell begins at x = 0; `None` for other positions.
    fn cell(&self) -> Option<f64> {
        let cell = self.span() / (self.positions.len() - 1) as f64;
        let is_even = first_uneven(&self.positions, 0.5 * cell, cell).is_none();
        is_even.then_some(cell)
    }

    /// Computes the rms height about the mean and the rms gradient of the polyline through the
    /// measured points.
    fn polyline_moments(&self) -> PolylineMoments {
        let length = self.span();
        let mean = self.pieces().map(|piece| piece.integral()).sum::<f64>() / length;
        let square = self
            .pieces()
            .map(|piece| piece.squared_about(mean))
            .sum::<f64>();
        let gradient = self
            .pieces()
            .map(|piece| piece.squared_gradient())
            .sum::<f64>();
        PolylineMoments {
            rms_height: (square / length).sqrt(),
            rms_gradient: (gradient / length).sqrt(),
        }
    }

    /// Returns the pieces of the polyline between neighbouring points.
    fn pieces(&self) -> impl Iterator<Item = Piece> {
        // The first height is subtracted: an offset that is far larger than the roughness would
        // increase the rounding errors.
        let level = self.heights[0];
        let positions = self.positions.windows(2);
        positions
            .zip(self.heights.windows(2))
            .map(move |(x, z)| Piece {
                width: x[1] - x[0],
                from: z[0] - level,
                to: z[1] - level,
            })
    }

    /// Computes the rms height, the rms gradient, the rms curvature and the mean wave number of the
    /// profile.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice, or if the Fourier transform fails.
    pub fn amplitude(&self) -> Result<Amplitude, SurfaceError> {
        let moments = self.polyline_moments();
        let points = self.positions.len();
        check_room(TRANSFORM_BYTES * points as u64)?;
        let length = self.length();
        let spacing = length / points as f64;
        let begins = self.begins(length).unwrap_or(self.positions[0]);
        let mut heights = self.heights_from(begins, spacing, points, 0.0)?;
        let rms_curvature = rms_curvature(&heights, spacing);
        join_ends(&mut heights);
        let modes = modes(heights)?;

        let of_modes = Amplitude::from_modes(modes.into_iter(), length);
        let height_ratio = of_modes.rms_height / moments.rms_height;
        let mean = of_modes.mean_wave_number * height_ratio.powi(2);
        Ok(Amplitude {
            rms_height: moments.rms_height,
            rms_gradient: moments.rms_gradient,
            rms_curvature,
            mean_wave_number: if mean.is_finite() { mean } else { 0.0 },
        })
    }

    /// Computes heights of the profile in m at N = `points` equally spaced positions on the length
    /// L = `length` in m, by linear interpolation. Position i is x = (i + ½ − `shift`)L/N, measured
    /// from the beginning of the profile. The same constant may be subtracted from all heights, to
    /// reduce rounding errors.
    ///
    /// # Errors
    /// Returns an error if the profile is shorter than `length`.
    ///
    /// ```
    /// use asperity_surface::lines::{MeasuredOptions, MeasuredProfile};
    ///
    /// let options = MeasuredOptions::default();
    /// let profile = MeasuredProfile::new(b"x [um] z [nm]\n0 10\n1 20\n2 40\n", &options)?;
    /// let heights = profile.sample(2e-6, 2, 0.0)?; // at 0.5 and 1.5 µm
    /// assert!((heights[1] - heights[0] - 15e-9).abs() < 1e-20);
    /// assert!(profile.sample(1e-3, 2, 0.0).is_err(), "the profile is shorter");
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn sample(&self, length: f64, points: usize, shift: f64) -> Result<Vec<f64>, SurfaceError> {
        match self.begins(length) {
            Ok(begins) => Ok(self.heights_from(begins, length / points as f64, points, shift)?),
            Err(covers) => {
                let found = format!("the profile covers {covers:e} m");
                let allowed = format!("at least length = {length:e} m");
                Err(refused(Place::File, found, allowed))
            }
        }
    }

    /// Computes the heights in m at the centres of `points` cells of the width `cell` in m. The
    /// first cell begins at x = `begins` in m, and all centres are displaced by `shift` cells
    /// towards smaller x.
    fn heights_from(
        &self,
        begins: f64,
        cell: f64,
        points: usize,
        shift: f64,
    ) -> Result<Vec<f64>, OutOfMemory> {
        let places = (0..points).map(|index| begins + (index as f64 + 0.5 - shift) * cell);
        let heights = interpolated(&self.positions, &self.heights, self.level(), places);
        gathered(points, heights)
    }

    /// Returns the position in m on the profile at which a line of this length in m begins. If the
    /// profile is too short, the error is the length in m that it covers.
    fn begins(&self, length: f64) -> Result<f64, f64> {
        let points = self.positions.len() as f64;
        let first = self.positions[0];
        let distance = self.span() / (points - 1.0);
        let is_even_from = |first: f64| first_uneven(&self.positions, first, distance).is_none();
        let begins = if is_even_from(0.5 * distance) {
            0.0
        } else if length <= self.span() {
            return Ok(first);
        } else if is_even_from(first) {
            first - 0.5 * distance
        } else {
            return Err(self.span());
        };
        // The end of the profile may be displaced by as much as a point of an even grid may be.
        let covers = points * distance;
        if length <= covers + UNEVEN * distance {
            Ok(begins)
        } else {
            Err(covers)
        }
    }

    /// Returns the height in m that is subtracted from all heights before they are interpolated. It
    /// is the first height if all differences from it are exact in floating-point arithmetic,
    /// otherwise 0.
    fn level(&self) -> f64 {
        let first = self.heights[0];
        // By the lemma of Sterbenz the difference of two numbers is exact if neither is more than
        // twice the other.
        let exact = 0.5 * first.abs()..=2.0 * first.abs();
        let is_exact = |height: &f64| exact.contains(&(height * first.signum()));
        if self.heights.iter().all(is_exact) {
            first
        } else {
            0.0
        }
    }
}

/// Moments of the polyline through the points of a profile.
struct PolylineMoments {
    /// Root mean square height in m about the mean.
    rms_height: f64,
    rms_gradient: f64,
}

/// A piece of the polyline through the points of a profile. Lengths are in m.
struct Piece {
    width: f64,
    /// Height at the first end of the piece. `to` is the height at its other end.
    from: f64,
    to: f64,
}

impl Piece {
    fn integral(&self) -> f64 {
        self.width * (self.from + self.to) / 2.0
    }

    /// Returns the integral, over the piece, of the squared height about the mean height `mean`.
    fn squared_about(&self, mean: f64) -> f64 {
        let from = self.from - mean;
        let to = self.to - mean;
        self.width * (from * from + from * to + to * to) / 3.0
    }

    /// Returns the integral of the squared gradient over the piece.
    fn squared_gradient(&self) -> f64 {
        let rise = self.to - self.from;
        rise * rise / self.width
    }
}

/// Returns the mean square height of each mode of a periodic profile, from its heights at evenly
/// spaced points.
fn modes(mut heights: Vec<f64>) -> Result<Vec<ModeSquare>, SurfaceError> {
    let points = heights.len();
    let plan = plan_real_forward(points);
    let mut coefficients = plan.make_output_vec();
    plan.process(&mut heights, &mut coefficients)
        .map_err(|error| SurfaceError::Transform(error.to_string()))?;
    let modes = (1_u64..)
        .zip(&coefficients[1..])
        .map(|(mode, coefficient)| {
            // A cosine wave is a sum of two exponentials with opposite wave numbers. Its mean
            // square is therefore distributed over two coefficients. Only for the wave with a
            // wavelength of two points, both exponentials are in one coefficient.
            let exponentials = if 2 * mode == points as u64 { 1.0 } else { 2.0 };
            ModeSquare {
                mode,
                square: exponentials * (coefficient / points as f64).norm_sqr(),
            }
        });
    Ok(modes.collect())
}

/// Computes the rms curvature in 1/m from second differences of heights, which have this spacing in
/// m.
fn rms_curvature(heights: &[f64], spacing: f64) -> f64 {
    let squares = heights
        .windows(3)
        .map(|z| ((z[0] - z[1]) + (z[2] - z[1])).powi(2))
        .sum::<f64>();
    let count = heights.len().saturating_sub(2).max(1);
    (squares / count as f64).sqrt() / spacing.powi(2)
}

/// Subtracts a straight line so that the profile can be continued periodically without a jump.
/// After that, the step from the last height to the first height equals the mean of the first and
/// the last step between neighbouring heights.
fn join_ends(heights: &mut [f64]) {
    let last = heights.len() - 1;
    let beside = 0.5 * ((heights[1] - heights[0]) + (heights[last] - heights[last - 1]));
    let slope = (beside - (heights[0] - heights[last])) / heights.len() as f64;
    for (index, height) in (0_u32..).zip(heights) {
        *height -= slope * f64::from(index);
    }
}

/// The measured files of one face, each with its path and its content. A face is one of the two
/// surfaces that touch each other.
pub type Face = Vec<(PathBuf, Vec<u8>)>;

/// Reads the measured files of several faces into memory. `faces` has the paths of the files of
/// each [`Face`], which is one of the two surfaces that touch each other.
///
/// # Errors
/// Returns an error if a file cannot be read or is larger than 1 GiB.
pub fn read_faces(faces: &[Vec<PathBuf>]) -> Result<Vec<Face>, SurfaceError> {
    faces.iter().map(|face| read_face(face)).collect()
}

fn read_face(paths: &[PathBuf]) -> Result<Face, SurfaceError> {
    let mut face = Vec::new();
    for path in paths {
        let content = content(path).map_err(|error| error.in_measured(path))?;
        face.push((path.clone(), content));
    }
    Ok(face)
}

impl MeasuredOptions {
    /// Analyses the surfaces in the files of one face, which is one of the two surfaces that touch
    /// each other. All these surfaces are taken as samples of the same roughness.
    ///
    /// # Errors
    /// Returns an error if a file holds no surface, or if its surface has no spectrum.
    pub fn analyse(&self, face: &Face) -> Result<Analysis, SurfaceError> {
        let mut surfaces = Vec::new();
        // For each surface, the path of its file. A file may contain several surfaces.
        let mut paths: Vec<&Path> = Vec::new();
        for (path, content) in face {
            let of_file = parse_all(content, &self.reading);
            let of_file = of_file.map_err(|error| error.in_measured(path))?;
            paths.resize(paths.len() + of_file.len(), path);
            surfaces.extend(of_file);
        }
        analyse(&surfaces, &self.spectrum).map_err(|error| {
            let index = error.surface().unwrap_or(0);
            let path = paths.get(index).copied();
            error.in_measured(path.unwrap_or(Path::new("")))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::options::ReadOptions;
    use crate::topography::unit::Unit;
    use std::f64::consts::TAU;

    fn parsed(text: &str) -> Result<MeasuredProfile, SurfaceError> {
        let reading = ReadOptions {
            convention: Some(Unit::METRE),
            ..ReadOptions::default()
        };
        MeasuredProfile::new(
            text.as_bytes(),
            &MeasuredOptions {
                reading,
                ..MeasuredOptions::default()
            },
        )
    }

    #[test]
    fn points_that_begin_at_half_their_distance_are_middles_of_cells() {
        let profile = parsed("0.5 3\n1.5 4\n2.5 -1").unwrap();
        assert_eq!(profile.length(), 3.0);
        assert_eq!(profile.sample(3.0, 3, 0.0).unwrap(), [3.0, 4.0, -1.0]);
        // Before the first and beyond the last point, the height is that of this point. Halfway
        // between two points, it is the mean of their heights.
        assert_eq!(
            profile.sample(3.0, 6, 0.5).unwrap(),
            [3.0, 3.0, 3.5, 4.0, 1.5, -1.0]
        );
        assert_eq!(profile.sample(3.0, 12, 0.0).unwrap()[11], -1.0);
        assert_eq!(profile.sample(1.0, 1, 0.0).unwrap(), [3.0]);
        assert!(
            profile
                .sample(3.01, 3, 0.0)
                .unwrap_err()
                .to_string()
                .contains("covers 3e0 m")
        );
        // These positions are rounded to a few digits, as in a file.
        let rounded = parsed("0.1667 3\n0.5 4\n0.8333 -1").unwrap();
        assert!((rounded.length() - 1.0).abs() < 1e-3 && rounded.sample(1.0, 3, 0.0).is_ok());
        // A profile whose points are not the centres of cells covers the distance from its first to
        // its last point.
        for (text, length) in [
            ("0 3\n1 4\n2 -1", 2.0),
            ("0.5 3\n1.5 4\n2.4 -1", 1.9),
            ("1 3\n2 4\n3 -1", 2.0),
        ] {
            let profile = parsed(text).unwrap();
            assert!((profile.length() - length).abs() < 1e-15);
            assert!(profile.sample(length, 3, 0.0).is_ok());
            // Equally spaced points cover half a spacing more at each end.
            let longest = if length == 1.9 { length } else { 3.0 };
            assert!(
                profile.sample(longest, 3, 0.0).is_ok()
                    && profile.sample(1.01 * longest, 3, 0.0).is_err()
            );
        }
        let even = parsed("1 3\n2 4\n3 -1").unwrap();
        assert_eq!(even.sample(3.0, 3, 0.0).unwrap(), [3.0, 4.0, -1.0]);
        assert_eq!(even.sample(2.0, 2, 0.0).unwrap(), [3.5, 1.5]);
    }

    #[test]
    fn an_offset_is_taken_out_where_that_is_exact() {
        let heights = |text: &str| parsed(text).unwrap().sample(2.0, 2, 0.0).unwrap();
        assert_eq!(heights("0.5 1e8\n1.5 100000001"), [0.0, 1.0]);
        assert_eq!(heights("0.5 -3\n1.5 -5"), [0.0, -2.0]);
        assert_eq!(heights("0.5 3\n1.5 7"), [3.0, 7.0]);
        assert_eq!(heights("0.5 -3\n1.5 3"), [-3.0, 3.0]);
        assert_eq!(heights("0.5 0\n1.5 0"), [0.0, 0.0]);
    }

    #[test]
    fn what_a_length_or_a_mean_square_cannot_hold_is_refused() {
        let wrong = |text: &str| parsed(text).unwrap_err().to_string();
        assert!(wrong("0 1").contains("1 points; allowed: from 2 to"));
        let long = wrong(&format!("0 1\n1 {}", "κ".repeat(1000)));
        assert!(long.chars().count() < 160, "{long}");
        assert_eq!(
            wrong("-1e308 0\n1e308 0"),
            "line 1: \"-1e308\"; allowed: a number from -1e9 to 1e9"
        );
        assert!(
            wrong("-1e10 0\n1 0")
                .contains("point 1: a position of -1e10 m; allowed: from -1e9 to 1e9 m")
        );
        assert!(wrong("0 0\n1 -1.1e9").contains("point 2: a height of -1.1e9 m"));
        assert_eq!(
            wrong("0 0\n0.5 1e9\n1 0"),
            "point 2: a slope of 2e9 from the point before; allowed: at most 1e9"
        );
        let steepest = parsed("-1e9 1e9\n-999999998 -1e9\n1e9 1e9").unwrap();
        let PolylineMoments {
            rms_height: height,
            rms_gradient: gradient,
        } = steepest.polyline_moments();
        assert!(height.is_finite() && gradient.is_finite() && steepest.length() == 2e9);
    }

    #[test]
    fn a_wave_has_its_own_wave_number_on_any_grid_and_under_a_tilt() {
        let text = |points: u32, middles: f64, tilt: f64| -> String {
            let place = |i: u32| (f64::from(i) + middles) / f64::from(points);
            let height = |x: f64| tilt * x + 2e-3 * (15.0 * TAU * x + 0.3).cos();
            (0..points)
                .map(|i| format!("{:e} {:e}\n", place(i), height(place(i))))
                .collect()
        };
        for (points, middles) in [(1000, 0.5), (1001, 0.5), (1000, 0.0)] {
            let level = parsed(&text(points, middles, 0.0))
                .unwrap()
                .amplitude()
                .unwrap();
            assert!(
                (level.mean_wave_number / (15.0 * TAU) - 1.0).abs() < 0.01,
                "{level:?}"
            );
            let curvature = 2e-3 * 0.5_f64.sqrt() * (15.0 * TAU).powi(2);
            assert!(
                (level.rms_curvature / curvature - 1.0).abs() < 0.01,
                "{level:?}"
            );
            // A tilt of the profile does not change its elastic energy.
            let tilted = parsed(&text(points, middles, 0.1))
                .unwrap()
                .amplitude()
                .unwrap();
            assert!(tilted.rms_height > 10.0 * level.rms_height);
            let change = tilted.elastic_energy(1.0) / level.elastic_energy(1.0) - 1.0;
            assert!(change.abs() < 0.01, "{change}");
        }
        let flat = parsed("0 1\n1 1\n2 1").unwrap().amplitude().unwrap();
        assert_eq!(
            (flat.mean_wave_number, flat.elastic_energy(1e6)),
            (0.0, 0.0)
        );
    }

    #[test]
    fn statistics_are_those_of_the_straight_pieces() {
        // The first profile is a triangle of the height 1 and the length 2, with the mean 1/2, the
        // variance 1/12 and the slope 1. The second profile has two pieces of different lengths,
        // with the mean 1/2 and the slopes 2 and −2; on the pieces, ∫ (z − 1/2)² dx is 31/12 and
        // 39/4. The third profile has a constant height and no roughness.
        for (text, square, slope) in [
            ("5 0\n6 1\n7 0", 1.0 / 12.0, 1.0),
            ("5 1\n6 3\n9 -3", (31.0 / 12.0 + 39.0 / 4.0) / 4.0, 2.0),
            ("6e-5 5\n1 5\n3 5", 0.0, 0.0),
        ] {
            let PolylineMoments {
                rms_height: height,
                rms_gradient: gradient,
            } = parsed(text).unwrap().polyline_moments();
            assert!(
                (height - f64::sqrt(square)).abs() < 1e-15 && (gradient - slope).abs() < 1e-15,
                "{text}"
            );
            assert!(square > 0.0 || (height, gradient) == (0.0, 0.0), "{text}");
        }
        let level = parsed("0 1e9\n1 1e9").unwrap();
        assert_eq!((&level.heights[..], level.length()), (&[1e9, 1e9][..], 1.0));
    }
}
