//! A body of revolution from a table of radii and depths, and its equivalent profile.
//!
//! Between two rows the depth is a cubic with limited slopes at the rows. So f′ = a + b s + c s² at
//! the distance s behind a row. The profile g(x) = |x| ∫₀^|x| f′(r)/√(x² − r²) dr is then a sum
//! over the intervals between rows.

use crate::error::{Place, SurfaceError, refused};
use crate::topography::open::{content, parse};
use crate::topography::options::ReadOptions;
use crate::topography::unit::Unit;
use asperity_data::{OutOfMemory, emptied, gauss_nodes_on_quarter_circle};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, LazyLock, OnceLock};

/// Number of points of the interpolation of the rows far inside, with an error of 1e-15.
const NODES: usize = 20;
/// Number of points at which the equivalent profile is searched for its falling part.
const STEPS: usize = 1024;
/// Smallest allowed distance of two rows over the radius of the last row. The digits of a file
/// resolve no smaller one.
const CLOSEST: f64 = 1e-9;

/// Sine of the angle of an interval between rows below which power series are accurate to rounding.
const NARROW: f64 = 0.05;
/// Power series of (arcsin s)/s in s².
const ARCSINE: [f64; 6] = [
    1.0,
    1.0 / 6.0,
    3.0 / 40.0,
    15.0 / 336.0,
    105.0 / 3456.0,
    945.0 / 42240.0,
];
/// Power series of (1 − cos δ)/δ² in δ².
const VERSINE: [f64; 4] = [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0];
/// Power series of (δ − sin δ)/δ³ in δ².
const ANGLE_LESS_SINE: [f64; 4] = [1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362880.0];
/// Power series of ∫ sin² over δ³ in δ².
const SQUARED_SINE: [f64; 4] = [1.0 / 3.0, -1.0 / 15.0, 2.0 / 315.0, -1.0 / 2835.0];
/// Power series of ∫ (1 − cos)² over δ⁵ in δ².
const SQUARED_VERSINE: [f64; 4] = [1.0 / 20.0, -1.0 / 168.0, 1.0 / 2880.0, -17.0 / 1330560.0];
/// Quadrature over the angle of a wider interval, in which f′ is a polynomial of the sine of the
/// angle.
static RULE: LazyLock<[(f64, f64); 9]> = LazyLock::new(gauss_nodes_on_quarter_circle);

/// A body of revolution f(r), given by rows of a radius r and a depth f. The radii ascend from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct FormTable {
    radii: Vec<f64>,
    /// Coefficients of f′ between each row and the next, in powers of the distance from the row.
    slopes: Vec<[f64; 3]>,
}

/// Rows of a [`Form::Table`](crate::Form::Table), empty until its file is read.
#[derive(Clone, Debug, Default)]
pub struct Rows(pub(super) Arc<OnceLock<FormTable>>);

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        self.0
            .get()
            .zip(other.0.get())
            .is_none_or(|(one, other)| one == other)
    }
}

impl FormTable {
    /// Reads a table of two columns in m, unless the file states a unit or `unit` is given.
    pub(super) fn read(path: &Path, unit: Option<Unit>) -> Result<Self, SurfaceError> {
        let convention = Some(Unit::METRE);
        let options = ReadOptions {
            unit,
            convention,
            interpolate: true,
            ..ReadOptions::default()
        };
        let surface = parse(&content(path)?, &options)?;
        if let Some(row) = surface.first_missing() {
            return Err(refused(
                Place::Point(row + 1),
                "the depth is missing",
                "a number in each row",
            ));
        }
        let (radii, depths) = surface.into_profile()?;
        FormTable::new(radii, &depths)
    }

    /// Creates a form from depths in m at two or more radii in m. The radii ascend from 0.
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
        let (rows, reach) = (radii.len(), radii.last().copied().unwrap_or(0.0));
        let row = |index: usize| Place::Point(index + 1);
        if rows < 2 || depths.len() != rows {
            let fault = format!("{rows} radii and {} depths", depths.len());
            return Err(refused(
                Place::File,
                fault,
                "two or more rows of a radius and a depth",
            ));
        }
        let is_finite = |index: &usize| radii[*index].is_finite() && depths[*index].is_finite();
        if let Some(index) = (0..rows).find(|index| !is_finite(index)) {
            return Err(refused(
                row(index),
                "a number that is not finite",
                "finite numbers",
            ));
        }
        if radii[0] != 0.0 {
            let fault = format!("r = {:e} m", radii[0]);
            return Err(refused(
                row(0),
                fault,
                "r = 0, the axis of the body, in the first row",
            ));
        }
        let widths: Vec<f64> = radii.windows(2).map(|r| r[1] - r[0]).collect();
        let least = CLOSEST * reach;
        if let Some(index) = widths
            .iter()
            .position(|&width| !(width >= least && width > 0.0))
        {
            let fault = format!("r = {:e} m after {:e} m", radii[index + 1], radii[index]);
            let allowed = format!(
                "ascending radii at least {least:e} m, a billionth of the last one, beyond each other"
            );
            return Err(refused(row(index + 1), fault, allowed));
        }
        let secants: Vec<f64> = depths
            .windows(2)
            .zip(&widths)
            .map(|(f, width)| (f[1] - f[0]) / width)
            .collect();
        let slope = |row: usize| limited_slope(&radii, &secants, row);
        let cubic = |row: usize| {
            let (width, secant) = (widths[row], secants[row]);
            let [from, to] = [slope(row), slope(row + 1)];
            let bend = (6.0 * secant - 4.0 * from - 2.0 * to) / width;
            [from, bend, 3.0 * (from + to - 2.0 * secant) / width / width]
        };
        let slopes = (0..widths.len()).map(cubic).collect();
        Ok(FormTable { radii, slopes })
    }

    /// Returns the radius in m of the last row, the largest radius of the table.
    pub fn reach(&self) -> f64 {
        self.radii[self.radii.len() - 1]
    }

    /// Returns the depth f(r) in m at a radius in m. Beyond the last row the body goes on with its
    /// last slope.
    pub(super) fn depth(&self, radius: f64) -> f64 {
        let along = |row: usize, distance: f64| {
            let [a, b, c] = self.slopes[row];
            distance * (a + distance * (b / 2.0 + distance * (c / 3.0)))
        };
        let last = self.slopes.len() - 1;
        let row = self
            .radii
            .partition_point(|start| *start <= radius)
            .clamp(1, last + 1)
            - 1;
        let before: f64 = (0..row)
            .map(|row| along(row, self.radii[row + 1] - self.radii[row]))
            .sum();
        let beyond = (radius - self.reach()).max(0.0);
        let width = radius - beyond - self.radii[row];
        let [a, b, c] = self.slopes[row];
        before + along(row, width) + beyond * (a + width * (b + width * c))
    }

    /// Returns the curvature at the summit in 1/m; `None` for a pointed tip.
    pub(super) fn summit_curvature(&self) -> Option<f64> {
        let [slope, curvature, _] = self.slopes[0];
        let is_round = slope.abs() <= 0.1 * (curvature * self.radii[1]).abs();
        Some(curvature).filter(|curvature| is_round && *curvature >= 0.0)
    }

    /// Computes the contribution of the interval after a row to g(x)/x: ∫ f′(r)/√(x² − r²) dr up to
    /// the radius `end` (m) in the interval, which is at most x.
    ///
    /// Let δ be the difference of the angles arcsin(r/x) of r and of the row. Then r = u + c sin δ
    /// − u (1 − cos δ), where u is the radius of the row and c = √(x² − u²). No term cancels,
    /// however close the rows.
    fn part(&self, row: usize, x: f64, end: f64) -> f64 {
        let (u, [a, b, c]) = (self.radii[row], self.slopes[row]);
        // Of a point on the row, rounding may leave x below u.
        if end <= u {
            return 0.0;
        }
        let root = |r: f64| ((x - r).max(0.0) * (x + r)).sqrt();
        let [from, to] = [root(u), root(end)];
        let sine = (end - u) * (end + u) / (end * from + u * to);
        if sine < NARROW {
            let series =
                |terms: &[f64], z: f64| terms.iter().rev().fold(0.0, |sum, term| sum * z + term);
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

    /// Computes the contribution of the intervals after these rows to g(x)/x. All of them end at x
    /// or below, in m.
    fn parts(&self, rows: Range<usize>, x: f64) -> f64 {
        rows.map(|row| self.part(row, x, self.radii[row + 1])).sum()
    }

    /// Returns the depth g in m of the equivalent profile at a distance from the axis in m.
    pub(super) fn mdr_profile(&self, x: f64) -> f64 {
        let gap = self.radii[1..self.slopes.len()].partition_point(|&r| r <= x);
        x * (self.parts(0..gap, x) + self.part(gap, x, x))
    }

    /// Returns `count` depths g of the equivalent profile in m. They are at multiples of `spacing`
    /// (m) from the axis, the first on the axis.
    pub fn depths(&self, spacing: f64, count: usize) -> Result<Vec<f64>, OutOfMemory> {
        // One depth takes a square root for each row nearer the axis. If many depths lie between
        // two rows, the contributions of rows at least one interval away are therefore interpolated
        // by a polynomial.
        let mut depths = emptied(Vec::new(), count)?;
        for gap in 0..self.slopes.len() {
            let (low, high) = (self.radii[gap], self.radii[gap + 1]);
            let is_last = gap + 1 == self.slopes.len();
            let end = if is_last {
                count
            } else {
                ((high / spacing).ceil() as usize).min(count)
            };
            let points = depths.len()..end.max(depths.len());
            let mut near = 0;
            let mut series = [0.0; NODES];
            if points.len() > 2 * NODES {
                near = self.radii[1..=gap].partition_point(|&r| r <= low - (high - low));
                let angle = |node: usize| (node as f64 + 0.5) * PI / NODES as f64;
                for node in 0..NODES {
                    let x = 0.5 * (low + high) + 0.5 * (high - low) * angle(node).cos();
                    let far = self.parts(0..near, x);
                    let term = |(order, sum): (usize, &mut f64)| {
                        *sum += 2.0 / NODES as f64 * far * (order as f64 * angle(node)).cos();
                    };
                    series.iter_mut().enumerate().for_each(term);
                }
            }
            depths.extend(points.map(|point| {
                let x = point as f64 * spacing;
                let at = 2.0 * (2.0 * x - low - high) / (high - low);
                // Clenshaw's sum of Chebyshev polynomials.
                let (one, two) = series[1..]
                    .iter()
                    .rev()
                    .fold((0.0, 0.0), |(one, two), term| (term + at * one - two, one));
                let far = 0.5 * series[0] + 0.5 * at * one - two;
                x * (far + self.parts(near..gap, x) + self.part(gap, x, x))
            }));
        }
        Ok(depths)
    }

    /// Finds the smallest distance from the axis in m beyond which the depth g of the equivalent
    /// profile decreases. The search ends at the distance `radius` in m. Returns `None` if the
    /// depth does not decrease up to this distance.
    pub fn falls_from(&self, radius: f64) -> Option<f64> {
        let step = radius / STEPS as f64;
        let depths = self.depths(step, STEPS + 1).ok()?;
        // Rounded numbers of a file.
        let slack = 1e-9 * depths.iter().copied().fold(0.0, f64::max);
        depths
            .windows(2)
            .position(|pair| pair[1] < pair[0] - slack)
            .map(|place| place as f64 * step)
    }
}

/// Returns the slope of the form at a row, from the secants between rows. It is the slope of the
/// parabola through three rows, at most three times the smaller secant beside the row, and zero
/// where the secants differ in sign. Between two rows the cubic then stays between their depths.
/// Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238.
fn limited_slope(radii: &[f64], secants: &[f64], row: usize) -> f64 {
    let last = secants.len() - 1;
    let one = row.saturating_sub(1).min(last.saturating_sub(1));
    let other = (one + 1).min(last);
    let middle = |secant: usize| 0.5 * (radii[secant] + radii[secant + 1]);
    let apart = middle(other) - middle(one);
    let rise = if apart > 0.0 {
        (secants[other] - secants[one]) / apart
    } else {
        0.0
    };
    let parabola = secants[one] + rise * (radii[row] - middle(one));
    let beside = [secants[row.saturating_sub(1)], secants[row.min(last)]];
    let most = 3.0 * beside[0].abs().min(beside[1].abs());
    let agree = beside
        .iter()
        .all(|secant| (*secant > 0.0) == (parabola > 0.0));
    if agree {
        parabola.clamp(-most, most)
    } else {
        0.0
    }
}
