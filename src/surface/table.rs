//! A body of revolution from a table of radii and depths, and its MDR transform.
//!
//! Between two rows the depth is a cubic with the slopes of the parabolas through three neighbouring rows, so that f′ is
//! a + b r + c r² there, and g(x) = |x| ∫₀^|x| f′(r)/√(x² − r²) dr a sum over the rows in closed form.

use crate::memory::{OutOfMemory, emptied};
use crate::topography::{Place, ReadOptions, TopographyError, Unit, content, parse, refused};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Points of the interpolation of the rows far inside, of an error of 1e-15.
const NODES: usize = 20;
/// Points of the equivalent profile for its figures.
const STEPS: usize = 1024;

/// A form f(r) of rows (r, f), r ascending from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct FormTable {
    radii: Vec<f64>,
    /// Coefficients of f′ between each row and the next.
    slopes: Vec<[f64; 3]>,
}

/// The rows of a form, once they are read. Forms whose rows are not known are equal.
#[derive(Clone, Debug, Default)]
pub struct Rows(pub(super) Arc<OnceLock<FormTable>>);

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        self.0.get().zip(other.0.get()).is_none_or(|(one, other)| one == other)
    }
}

impl FormTable {
    /// Reads a table of two columns, in m unless the file states a unit, or this one.
    pub(super) fn read(path: &Path, unit: Option<Unit>) -> Result<Self, TopographyError> {
        let convention = Some(Unit::METRE);
        let options = ReadOptions { unit, convention, interpolate: true, ..ReadOptions::default() };
        let surface = parse(&content(path)?, &options)?;
        if let Some(row) = surface.first_missing() {
            return Err(refused(Place::Point(row + 1), "the depth is missing", "a number in each row"));
        }
        let (radii, depths) = surface.into_profile()?;
        if radii[0] != 0.0 {
            let fault = format!("r = {:e} m", radii[0]);
            return Err(refused(Place::Point(1), fault, "r = 0, the axis of the body, in the first row"));
        }
        Ok(FormTable::new(radii, &depths))
    }

    /// A form of depths, m, at two or more radii, m, ascending from 0.
    pub fn new(radii: Vec<f64>, depths: &[f64]) -> Self {
        let widths: Vec<f64> = radii.windows(2).map(|r| r[1] - r[0]).collect();
        let secants: Vec<f64> =
            depths.windows(2).zip(&widths).map(|(f, width)| (f[1] - f[0]) / width).collect();
        // Slope at a row of the parabola through it and the rows of two secants.
        let slope = |row: usize| {
            let one = row.saturating_sub(1).min(secants.len().saturating_sub(2));
            let other = (one + 1).min(secants.len() - 1);
            let middle = |secant: usize| 0.5 * (radii[secant] + radii[secant + 1]);
            let apart = middle(other) - middle(one);
            let rise = if apart > 0.0 { (secants[other] - secants[one]) / apart } else { 0.0 };
            secants[one] + rise * (radii[row] - middle(one))
        };
        let cubic = |row: usize| {
            let (start, width, secant) = (radii[row], widths[row], secants[row]);
            let [from, to] = [slope(row), slope(row + 1)];
            let bend = (6.0 * secant - 4.0 * from - 2.0 * to) / width;
            let twist = 3.0 * (from + to - 2.0 * secant) / width / width;
            [from - (bend - twist * start) * start, bend - 2.0 * twist * start, twist]
        };
        let slopes = (0..widths.len()).map(cubic).collect();
        FormTable { radii, slopes }
    }

    /// Radius of the last row, m.
    pub fn reach(&self) -> f64 {
        self.radii[self.radii.len() - 1]
    }

    /// Curvature at the summit, 1/m, where the form is round or flat there.
    pub(super) fn summit_curvature(&self) -> Option<f64> {
        let [slope, curvature, _] = self.slopes[0];
        let is_round = slope.abs() <= 0.1 * (curvature * self.radii[1]).abs();
        Some(curvature).filter(|curvature| is_round && *curvature >= 0.0)
    }

    /// Part of g(x)/x of the change of f′ at a row below x.
    fn part(&self, row: usize, x: f64) -> f64 {
        let (r, [from, to]) = (self.radii[row], [self.slopes[row - 1], self.slopes[row]]);
        // Of a point on the row, rounding may leave x below r.
        let (angle, root) = ((r / x).min(1.0).asin(), ((x - r).max(0.0) * (x + r)).sqrt());
        let [a, b, c] = [0, 1, 2].map(|power| to[power] - from[power]);
        a * angle - b * root + 0.5 * c * (x * x * angle - r * root)
    }

    /// Depth g, m, at x, m, in a gap between rows, given the sum of the parts of all rows below.
    fn depth(&self, gap: usize, x: f64, parts: f64) -> f64 {
        let [a, _, c] = self.slopes[gap];
        x * (FRAC_PI_2 * (a + 0.5 * c * x * x) + self.slopes[0][1] * x - parts)
    }

    /// Depth g, m, of the equivalent profile at a distance from the axis, m.
    pub(super) fn mdr_profile(&self, x: f64) -> f64 {
        let gap = self.radii[1..self.slopes.len()].partition_point(|&r| r <= x);
        self.depth(gap, x, (1..=gap).map(|row| self.part(row, x)).sum())
    }

    /// Depths g, m, at `count` multiples of a distance from the axis, m, from 0 on.
    ///
    /// One depth takes an arcsine for each row below. Between two rows with many of the points, rows at least that gap
    /// away are interpolated there by a polynomial.
    pub fn depths(&self, spacing: f64, count: usize) -> Result<Vec<f64>, OutOfMemory> {
        let mut depths = emptied(Vec::new(), count)?;
        for gap in 0..self.slopes.len() {
            let (low, high) = (self.radii[gap], self.radii[gap + 1]);
            let is_last = gap + 1 == self.slopes.len();
            let end = if is_last { count } else { ((high / spacing).ceil() as usize).min(count) };
            let points = depths.len()..end.max(depths.len());
            let mut near = 1;
            let mut series = [0.0; NODES];
            if points.len() > 2 * NODES {
                near = self.radii[..=gap].partition_point(|&r| r <= low - (high - low)).max(1);
                let angle = |node: usize| (node as f64 + 0.5) * PI / NODES as f64;
                for node in 0..NODES {
                    let x = 0.5 * (low + high) + 0.5 * (high - low) * angle(node).cos();
                    let far: f64 = (1..near).map(|row| self.part(row, x)).sum();
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
                self.depth(gap, x, far + (near..=gap).map(|row| self.part(row, x)).sum::<f64>())
            }));
        }
        Ok(depths)
    }

    /// Adhesion force by the theory of Johnson, Kendall and Roberts, N, of the body up to a radius, m.
    pub fn adhesion_force(&self, radius: f64, effective_modulus: f64, work: f64) -> Option<f64> {
        let step = radius / STEPS as f64;
        let depths = self.depths(step, STEPS + 1).ok()?;
        let mut area = 0.0;
        let forces = depths.windows(2).zip(1_u32..).map(|(pair, count)| {
            let a = f64::from(count) * step;
            area += 0.5 * (pair[0] + pair[1]) * step;
            2.0 * effective_modulus * (a * pair[1] - area)
                - (8.0 * PI * a.powi(3) * effective_modulus * work).sqrt()
        });
        forces.min_by(f64::total_cmp).map(|least| 0.0 - least)
    }

    /// Distance from the axis, m, from which on the equivalent profile falls, within a radius, m.
    pub fn falls_from(&self, radius: f64) -> Option<f64> {
        let step = radius / STEPS as f64;
        let depths = self.depths(step, STEPS + 1).ok()?;
        // Rounded numbers of a file.
        let slack = 1e-9 * depths.iter().copied().fold(0.0, f64::max);
        depths.windows(2).position(|pair| pair[1] < pair[0] - slack).map(|place| place as f64 * step)
    }
}
