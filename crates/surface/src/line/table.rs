//! A body of revolution from a table of radii and depths, and its equivalent profile.
//!
//! Between two rows the depth f is a cubic polynomial. Its slopes at the rows are limited so that f
//! does not overshoot. Therefore f′ = a + b s + c s², where s is the distance from the first of the
//! two rows. The equivalent profile g(x) = |x| ∫₀^|x| f′(r)/√(x² − r²) dr is then a sum over the
//! intervals between rows.

use crate::error::{Place, SurfaceError, refused};
use crate::topography::open::parse;
use crate::topography::options::ReadOptions;
use crate::topography::unit::Unit;
use asperity_data::{OutOfMemory, emptied, gauss_nodes_on_quarter_circle};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use std::sync::{Arc, LazyLock, OnceLock};

/// Number of Chebyshev nodes of the interpolation in [`FarParts`]. With this number the error of
/// the interpolation is 1e-15.
const NODES: usize = 20;

/// Number of steps in which [`FormTable::falls_from`] searches the distance at which the equivalent
/// profile begins to fall.
const STEPS: usize = 1024;

/// Smallest allowed distance between two rows, divided by the radius of the last row. The digits in
/// a file do not resolve smaller distances.
const CLOSEST: f64 = 1e-9;

/// Largest decrease of the depth, divided by the largest depth, that is explained by the rounding
/// of the numbers in the file.
const ROUNDED: f64 = 1e-9;

/// Largest sine of the angle δ of an interval (see [`FormTable::part`]) for which power series are
/// used. Below this limit the power series are accurate to rounding.
const NARROW: f64 = 0.05;

/// Coefficients of the power series of (arcsin s)/s in s².
const ARCSINE: [f64; 6] = [
    1.0,
    1.0 / 6.0,
    3.0 / 40.0,
    15.0 / 336.0,
    105.0 / 3456.0,
    945.0 / 42240.0,
];

/// Coefficients of the power series of (1 − cos δ)/δ² in δ².
const VERSINE: [f64; 4] = [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0];

/// Coefficients of the power series of (δ − sin δ)/δ³ in δ².
const ANGLE_LESS_SINE: [f64; 4] = [1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362880.0];

/// Coefficients of the power series of (∫ sin² t dt)/δ³ in δ², where t goes from 0 to δ.
const SQUARED_SINE: [f64; 4] = [1.0 / 3.0, -1.0 / 15.0, 2.0 / 315.0, -1.0 / 2835.0];

/// Coefficients of the power series of (∫ (1 − cos t)² dt)/δ⁵ in δ², where t goes from 0 to δ.
const SQUARED_VERSINE: [f64; 4] = [1.0 / 20.0, -1.0 / 168.0, 1.0 / 2880.0, -17.0 / 1330560.0];

/// Gauss rule for the integral over the angle of an interval, if the sine of the angle is above
/// [`NARROW`]. A few nodes suffice, because f′ is a polynomial of sines and cosines of the angle.
static RULE: LazyLock<[(f64, f64); 9]> = LazyLock::new(gauss_nodes_on_quarter_circle);

/// A body of revolution whose depth f below the apex is given at several radii r. The radii ascend
/// from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct FormTable {
    radii: Vec<f64>,
    /// The cubic polynomial of the depth between each row and the next.
    cubics: Vec<Cubic>,
}

/// Slope f′ = a + b s + c s² between two rows, where s is the distance from the first row in m. The
/// depth f is therefore a cubic polynomial of s.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cubic {
    a: f64,
    b: f64,
    c: f64,
}

impl Cubic {
    /// Creates the cubic polynomial between two rows at the distance `width`. `secant` is the slope
    /// of the straight line between the rows. `from` and `to` are the slopes of the polynomial at
    /// the rows.
    fn between(width: f64, secant: f64, from: f64, to: f64) -> Self {
        Cubic {
            a: from,
            b: (6.0 * secant - 4.0 * from - 2.0 * to) / width,
            c: 3.0 * (from + to - 2.0 * secant) / width / width,
        }
    }

    /// Returns the depth at a distance from the first row, minus the depth at the first row.
    fn depth(&self, distance: f64) -> f64 {
        distance * (self.a + distance * (self.b / 2.0 + distance * (self.c / 3.0)))
    }

    fn slope(&self, distance: f64) -> f64 {
        self.a + distance * (self.b + distance * self.c)
    }
}

/// Rows of the table of a [`Form::Table`](crate::Form::Table). There are no rows until the file of
/// the table is read.
#[derive(Clone, Debug, Default)]
pub struct Rows(pub(super) Arc<OnceLock<FormTable>>);

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        match (self.0.get(), other.0.get()) {
            (Some(table), Some(other)) => table == other,
            // If one of two tables has not been read yet, the tables count as equal, because the
            // names of their files are compared as fields of the form.
            _ => true,
        }
    }
}

impl FormTable {
    /// Parses a table with two columns, radius and depth. The numbers are in the unit that the file
    /// states. If the file states no unit, they are in `unit`, or in m if `unit` is `None`.
    pub(super) fn parse(content: &[u8], unit: Option<Unit>) -> Result<Self, SurfaceError> {
        let options = ReadOptions {
            unit,
            convention: Some(Unit::METRE),
            interpolate: true,
            ..ReadOptions::default()
        };
        let surface = parse(content, &options)?;
        if let Some(row) = surface.first_missing() {
            let found = "the depth is missing";
            return Err(refused(
                Place::Point(row + 1),
                found,
                "a number in each row",
            ));
        }
        let (radii, depths) = surface.into_profile()?;
        FormTable::new(radii, &depths)
    }

    /// Creates a body of revolution from its depths in m below the apex at two or more radii in m.
    /// The radii ascend from 0.
    ///
    /// # Errors
    /// Returns an error that names the row at fault and the allowed values.
    ///
    /// ```
    /// let cone = asperity_surface::FormTable::new(vec![0.0, 1e-6, 2e-6], &[0.0, 1e-7, 2e-7])?;
    /// assert_eq!(cone.reach(), 2e-6);
    /// // MDR makes g = (π/2) x tan θ of a cone f = r tan θ.
    /// let depths = cone.depths(1e-6, 2).expect("a few numbers fit into memory");
    /// assert!((depths[1] / (std::f64::consts::FRAC_PI_2 * 1e-7) - 1.0).abs() < 1e-9);
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn new(radii: Vec<f64>, depths: &[f64]) -> Result<Self, SurfaceError> {
        check_rows(&radii, depths)?;
        let rows = radii.len();
        let mut widths = Vec::new();
        let mut secants = Vec::new();
        for row in 1..rows {
            let width = radii[row] - radii[row - 1];
            widths.push(width);
            secants.push((depths[row] - depths[row - 1]) / width);
        }
        let slope = |row: usize| limited_slope(&radii, &secants, row);
        let cubic =
            |row: usize| Cubic::between(widths[row], secants[row], slope(row), slope(row + 1));
        let cubics = (0..rows - 1).map(cubic).collect();
        Ok(FormTable { radii, cubics })
    }

    /// Returns the radius in m of the last row, the largest radius of the table.
    pub fn reach(&self) -> f64 {
        self.radii[self.radii.len() - 1]
    }

    /// Returns the depth f(r) in m at a radius in m. Beyond the last row the depth continues with
    /// the slope at this row.
    pub(super) fn depth(&self, radius: f64) -> f64 {
        let rows_inside = self.radii.partition_point(|start| *start <= radius);
        let row = rows_inside.clamp(1, self.cubics.len()) - 1;
        let before: f64 = (0..row)
            .map(|row| self.cubics[row].depth(self.radii[row + 1] - self.radii[row]))
            .sum();
        let beyond = (radius - self.reach()).max(0.0);
        let width = radius - beyond - self.radii[row];
        let cubic = &self.cubics[row];
        before + cubic.depth(width) + beyond * cubic.slope(width)
    }

    /// Returns the curvature of the body at its summit in 1/m; `None` if the tip is pointed.
    pub(super) fn summit_curvature(&self) -> Option<f64> {
        let Cubic {
            a: slope,
            b: curvature,
            ..
        } = self.cubics[0];
        let is_round = slope.abs() <= 0.1 * (curvature * self.radii[1]).abs();
        (is_round && curvature >= 0.0).then_some(curvature)
    }

    /// Computes the contribution to g(x)/x of the interval after a row. It is the integral ∫
    /// f′(r)/√(x² − r²) dr from this row to the radius `end` in m, which lies in the interval and
    /// is at most x.
    ///
    /// Let u be the radius of the row, δ = arcsin(r/x) − arcsin(u/x) and w = √(x² − u²). Then
    /// r = u + w sin δ − u (1 − cos δ), and the integral is taken over δ. In this form no nearly
    /// equal numbers are subtracted, however close the rows are.
    fn part(&self, row: usize, x: f64, end: f64) -> f64 {
        let u = self.radii[row];
        let Cubic { a, b, c } = self.cubics[row];
        // If x equals the radius of the row, rounding may make x smaller than u.
        if end <= u {
            return 0.0;
        }
        let root = |r: f64| ((x - r).max(0.0) * (x + r)).sqrt();
        let from = root(u);
        let to = root(end);
        let sine = (end - u) * (end + u) / (end * from + u * to);
        if sine < NARROW {
            let angle = sine * series(&ARCSINE, sine * sine);
            let z = angle * angle;
            let versine = z * series(&VERSINE, z);
            let along = from * versine - u * angle * z * series(&ANGLE_LESS_SINE, z);
            let square = from * from * angle * z * series(&SQUARED_SINE, z)
                - from * u * versine * versine
                + u * u * angle * z * z * series(&SQUARED_VERSINE, z);
            return a * angle + b * along + c * square;
        }
        let cosine = (u * end + from * to) / (x * x);
        let angle = if sine < cosine {
            sine.asin()
        } else {
            cosine.acos()
        };
        let slope = |&(node, weight): &(f64, f64)| {
            let (sin, cos) = (0.5 * node / FRAC_PI_2 * angle).sin_cos();
            let beyond = 2.0 * sin * (from * cos - u * sin);
            weight / FRAC_PI_2 * (a + (b + c * beyond) * beyond)
        };
        angle * RULE.iter().map(slope).sum::<f64>()
    }

    /// Computes the contribution to g(x)/x of the intervals after the rows `rows`. All these
    /// intervals must end at x (in m) or nearer the axis.
    fn parts(&self, rows: Range<usize>, x: f64) -> f64 {
        rows.map(|row| self.part(row, x, self.radii[row + 1])).sum()
    }

    /// Returns the depth g in m of the equivalent profile at the distance x in m from the axis.
    pub(super) fn mdr_profile(&self, x: f64) -> f64 {
        let gap = self.radii[1..self.cubics.len()].partition_point(|&r| r <= x);
        x * (self.parts(0..gap, x) + self.part(gap, x, x))
    }

    /// Returns `count` depths in m of the equivalent profile below its apex, at the distances 0,
    /// `spacing`, 2 `spacing`, … (m) from the axis.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn depths(&self, spacing: f64, count: usize) -> Result<Vec<f64>, OutOfMemory> {
        let mut depths = emptied(Vec::new(), count)?;
        for gap in 0..self.cubics.len() {
            let is_last = gap + 1 == self.cubics.len();
            let end = if is_last {
                count
            } else {
                let next = self.radii[gap + 1] / spacing;
                (next.ceil() as usize).min(count)
            };
            let points = depths.len()..end.max(depths.len());
            let far = FarParts::new(self, gap, points.len());
            depths.extend(points.map(|point| {
                let x = point as f64 * spacing;
                let near = self.parts(far.rows..gap, x);
                x * (far.sum(x) + near + self.part(gap, x, x))
            }));
        }
        Ok(depths)
    }

    /// Finds the smallest distance in m from the axis at which the depth of the equivalent profile
    /// begins to decrease outwards. The search ends at the distance `radius` in m. Returns `None`
    /// if the depth does not decrease up to this distance.
    pub fn falls_from(&self, radius: f64) -> Option<f64> {
        let step = radius / STEPS as f64;
        let depths = self.depths(step, STEPS + 1).ok()?;
        // The numbers in the file are rounded, so a tiny decrease has no meaning.
        let slack = ROUNDED * depths.iter().copied().fold(0.0, f64::max);
        let mut pairs = depths.windows(2);
        let place = pairs.position(|pair| pair[1] < pair[0] - slack)?;
        Some(place as f64 * step)
    }
}

/// Returns an error unless the radii ascend from 0 and all numbers are finite. The error names the
/// row at fault.
fn check_rows(radii: &[f64], depths: &[f64]) -> Result<(), SurfaceError> {
    let rows = radii.len();
    if rows < 2 || depths.len() != rows {
        let found = format!("{rows} radii and {} depths", depths.len());
        let allowed = "two or more rows of a radius and a depth";
        return Err(refused(Place::File, found, allowed));
    }
    for row in 0..rows {
        if !radii[row].is_finite() || !depths[row].is_finite() {
            let found = "a number that is not finite";
            return Err(refused(Place::Point(row + 1), found, "finite numbers"));
        }
    }
    if radii[0] != 0.0 {
        let found = format!("r = {:e} m", radii[0]);
        let allowed = "r = 0, the axis of the body, in the first row";
        return Err(refused(Place::Point(1), found, allowed));
    }
    let least = CLOSEST * radii[rows - 1];
    for row in 1..rows {
        let width = radii[row] - radii[row - 1];
        if width < least || width <= 0.0 {
            let found = format!("r = {:e} m after {:e} m", radii[row], radii[row - 1]);
            let allowed = format!(
                "ascending radii at least {least:e} m, a billionth of the last one, beyond each other"
            );
            return Err(refused(Place::Point(row + 1), found, allowed));
        }
    }
    Ok(())
}

/// Returns the value of a power series at z, by Horner's rule.
fn series(terms: &[f64], z: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| sum * z + term)
}

/// Contributions to g(x)/x of the rows that are much nearer the axis than x.
///
/// The exact computation of one depth takes a square root for each row nearer the axis. If many
/// depths between two neighbouring rows are needed, a polynomial of x therefore replaces the
/// contributions of all rows that are at least one interval away from these two rows.
struct FarParts {
    /// Number of rows whose contributions are interpolated.
    rows: usize,
    /// Lower end in m of the interval of x. `high` is the upper end in m.
    low: f64,
    high: f64,
    /// Coefficients of the Chebyshev polynomials whose sum is the interpolated contribution.
    coefficients: [f64; NODES],
}

impl FarParts {
    /// Prepares the interpolation for `points` values of x in the interval after row `gap`. If
    /// there are few values, nothing is interpolated.
    fn new(table: &FormTable, gap: usize, points: usize) -> Self {
        let low = table.radii[gap];
        let high = table.radii[gap + 1];
        let mut far = FarParts {
            rows: 0,
            low,
            high,
            coefficients: [0.0; NODES],
        };
        if points <= 2 * NODES {
            return far;
        }
        far.rows = table.radii[1..=gap].partition_point(|&r| r <= low - (high - low));
        for node in 0..NODES {
            let angle = (node as f64 + 0.5) * PI / NODES as f64;
            let x = 0.5 * (low + high) + 0.5 * (high - low) * angle.cos();
            let sum = table.parts(0..far.rows, x);
            for (order, coefficient) in far.coefficients.iter_mut().enumerate() {
                *coefficient += 2.0 / NODES as f64 * sum * (order as f64 * angle).cos();
            }
        }
        far
    }

    /// Returns the sum of the contributions at x in m, computed from the Chebyshev polynomials by
    /// Clenshaw's recurrence.
    fn sum(&self, x: f64) -> f64 {
        let twice_place = 2.0 * (2.0 * x - self.low - self.high) / (self.high - self.low);
        let mut sum = 0.0;
        let mut sum_before = 0.0;
        for coefficient in self.coefficients[1..].iter().rev() {
            let next = coefficient + twice_place * sum - sum_before;
            sum_before = sum;
            sum = next;
        }
        0.5 * self.coefficients[0] + 0.5 * twice_place * sum - sum_before
    }
}

/// Returns the slope of the form at a row. It is the slope of the parabola through three rows,
/// limited in two ways: its magnitude is at most three times the smaller secant beside the row, and
/// it is zero where the two secants differ in sign. The cubic polynomial between two rows then
/// stays between the depths at the rows (Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238).
fn limited_slope(radii: &[f64], secants: &[f64], row: usize) -> f64 {
    let last = secants.len() - 1;
    // Indices of the two secants beside the row. At either end of the table, these are the two
    // secants nearest to the end.
    let inner = row.saturating_sub(1).min(last.saturating_sub(1));
    let outer = (inner + 1).min(last);
    let middle = |secant: usize| 0.5 * (radii[secant] + radii[secant + 1]);
    let distance = middle(outer) - middle(inner);
    let rise = if distance > 0.0 {
        (secants[outer] - secants[inner]) / distance
    } else {
        0.0
    };
    let parabola = secants[inner] + rise * (radii[row] - middle(inner));

    let before = secants[row.saturating_sub(1)];
    let after = secants[row.min(last)];
    let ascends = parabola > 0.0;
    if (before > 0.0) != ascends || (after > 0.0) != ascends {
        return 0.0;
    }
    let most = 3.0 * before.abs().min(after.abs());
    parabola.clamp(-most, most)
}
