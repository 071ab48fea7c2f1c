//! Macroscopic forms f(r) and their equivalent profiles g(x) by the method of dimensionality
//! reduction.

use super::table::{FormTable, Rows};
use crate::error::{Place, SurfaceError, refused};
use crate::topography::open::content;
use asperity_data::gauss_nodes_on_quarter_circle;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use strum::IntoStaticStr;

/// Macroscopic form of the rigid body: its shape without roughness. The shape is a depth in m as a
/// function of r, the distance from the axis in m. The depth is measured along the axis, from the
/// apex.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Form {
    /// Paraboloid of depth r²/2R, by which Hertz and JKR approximate a sphere.
    Paraboloid {
        /// Radius of curvature R in m.
        radius: f64,
    },
    /// Cone of depth r tan θ.
    Cone {
        /// Angle θ between flank and surface plane in rad.
        angle: f64,
    },
    /// Body whose depth is a power law b rⁿ.
    Power {
        /// Coefficient b in m^(1−n).
        coefficient: f64,
        /// Exponent n of the power law.
        exponent: f64,
    },
    /// Sphere of depth r²/2R with concentric waves A (1 − cos 2πr/λ).
    WavySphere {
        /// Radius of curvature R in m.
        radius: f64,
        /// Amplitude A of the waves in m. From trough to crest the waves are 2A high.
        amplitude: f64,
        /// Wavelength λ in m.
        wavelength: f64,
    },
    /// Cone with a rounded apex. The depth is r²/2R up to the radius b = R tan θ. Beyond b, the
    /// depth is r tan θ − b tan θ/2, a cone that is tangent to the paraboloid.
    RoundedCone {
        /// Radius of curvature R of the apex in m.
        radius: f64,
        /// Angle θ between flank and surface plane in rad.
        angle: f64,
    },
    /// Cylinder with a flat end. Only the flat end can touch.
    Punch {
        /// Radius a of the flat end in m.
        radius: f64,
    },
    /// Spheres side by side on one probe, each above an equal part of the length of the profile.
    /// The contacts of the spheres do not influence each other, and their forces add up.
    Spheres(Vec<Sphere>),
    /// Body of revolution whose radii and depths are in a file.
    Table {
        /// Path of the file, relative to the scene file, or the rows themselves after
        /// [`Form::ROWS_IN_PLACE`], such as `data:,0 0;1e-6 2e-8`.
        file: String,
        /// Unit of the radii and depths if the file states none; empty for m.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        unit: String,
        /// Rows of the table; empty until [`Form::load`] has read the file.
        #[serde(skip)]
        rows: Rows,
    },
}

/// One of several spheres on a probe, as in [`Form::Spheres`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius of curvature R in m.
    pub radius: f64,
    /// Distance in m by which the apex of the sphere lies farther from the elastic body than the
    /// apex of the form. A sphere that is ahead of all others has 0.
    #[serde(default)]
    pub behind: f64,
}

impl Sphere {
    /// Returns the sphere as a paraboloid of revolution about its own axis, without its distance
    /// behind the apex of the form.
    fn paraboloid(self) -> Form {
        Form::Paraboloid {
            radius: self.radius,
        }
    }
}

impl Form {
    /// Prefix of the field `file` of a [`Form::Table`] that contains the rows of the table itself,
    /// in place of the name of a file. The notation is that of addresses of RFC 2397. Each row has
    /// the radius and the depth in m, and `;` separates the rows.
    pub const ROWS_IN_PLACE: &str = "data:,";

    /// Returns the name of the file of a [`Form::Table`], relative to the folder of the scene file.
    /// Returns `None` for other forms, and for a table whose rows are given in place of the name.
    pub fn table_file(&self) -> Option<&str> {
        match self {
            Form::Table { file, .. } if !file.starts_with(Form::ROWS_IN_PLACE) => Some(file),
            _ => None,
        }
    }

    /// Reads the file of a [`Form::Table`], unless the file has been read already. Does nothing for
    /// other forms. `folder` is the folder of the scene file, and `length` is the length of the
    /// profile in m. Returns an error if the file contains no table, or if the table is too short
    /// for the profile.
    pub fn load(&self, folder: &Path, length: f64) -> Result<(), SurfaceError> {
        let Form::Table { file, unit, rows } = self else {
            return Ok(());
        };
        let path = match self.table_file() {
            Some(file) => folder.join(file),
            None => PathBuf::from("rows of the form"),
        };
        let in_file = |error: SurfaceError| error.in_file_of("form.file", &path);
        if rows.0.get().is_none() {
            let unit = if unit.is_empty() {
                None
            } else {
                Some(unit.parse().map_err(in_file)?)
            };
            let content = match file.strip_prefix(Form::ROWS_IN_PLACE) {
                Some(rows) => Ok(rows.replace(';', "\n").into_bytes()),
                None => content(&path),
            };
            let table = content.and_then(|content| FormTable::parse(&content, unit));
            let table = table.map_err(in_file)?;
            rows.0.get_or_init(|| table);
        }
        let reach = self.table().map_or(0.0, FormTable::reach);
        if 0.5 * length <= reach * (1.0 + 1e-9) {
            return Ok(());
        }
        let found = format!("the table ends at r = {reach:e} m");
        let allowed = format!("length at most {:e} m", 2.0 * reach);
        Err(in_file(refused(Place::File, found, allowed)))
    }

    /// Returns the table of a [`Form::Table`]. Returns `None` if [`Form::load`] has not read the
    /// table yet, and for all other forms.
    pub fn table(&self) -> Option<&FormTable> {
        if let Form::Table { rows, .. } = self {
            rows.0.get()
        } else {
            None
        }
    }

    /// Returns ⌊N/2⌋ for N = `points` springs, the index of the spring on the axis of a body of
    /// revolution. For two forms ⌊N/2⌋ is not the axis: the axis of a punch is in the middle of the
    /// length, which may lie between two springs, and [`Form::Spheres`] has an axis for each
    /// sphere.
    pub fn spring_on_axis(points: u64) -> u64 {
        // If the axis were between two springs, no spring would be under the tip. The errors of the
        // contact would then be proportional to the spring spacing Δx.
        points / 2
    }

    /// Returns the distance from the middle of the length to the axis of the form, in units of the
    /// spring spacing. The distance is ½ for an even number of springs. It is 0 for an odd number
    /// of springs and for a punch.
    pub fn shift(&self, points: u64) -> f64 {
        if points.is_multiple_of(2) && self.flat_end().is_none() {
            0.5
        } else {
            0.0
        }
    }

    /// Returns the range of indices of the springs under the form, for `points` springs on the
    /// length `length` in m. For a punch, these are the springs below its flat end; for every other
    /// form, these are all springs. The width of a punch is its diameter, rounded to a whole number
    /// of spring spacings. The range is empty if the diameter is below half a spacing.
    ///
    /// ```
    /// // A punch of 4 µm on springs of 1 µm.
    /// assert_eq!(asperity_surface::Form::Punch { radius: 2e-6 }.springs_under(1e-5, 10), 3..7);
    /// ```
    pub fn springs_under(&self, length: f64, points: u64) -> Range<u64> {
        let Some(radius) = self.flat_end() else {
            return 0..points;
        };
        let cells = (2.0 * radius / (length / points as f64)).round() as u64;
        let cells = cells.min(points);
        let first = Form::spring_on_axis(points) - cells / 2;
        first..first + cells
    }

    /// Returns the radius in m of the flat end of a punch; `None` for all other forms.
    pub fn flat_end(&self) -> Option<f64> {
        match *self {
            Form::Punch { radius } => Some(radius),
            _ => None,
        }
    }

    /// Returns the paraboloid of a [`Form::WavySphere`], and any other form unchanged.
    pub fn without_waves(&self) -> Form {
        match self {
            &Form::WavySphere { radius, .. } => Form::Paraboloid { radius },
            form => form.clone(),
        }
    }

    /// Returns the spheres of a [`Form::Spheres`]; an empty list for other forms.
    pub fn spheres(&self) -> &[Sphere] {
        match self {
            Form::Spheres(spheres) => spheres,
            _ => &[],
        }
    }

    /// Returns the number of contacts that a smooth body of this form may have: the number of its
    /// spheres, and 1 for other forms.
    pub fn contacts(&self) -> usize {
        self.spheres().len().max(1)
    }

    /// Returns the sphere that is ahead of all others; `None` for a form that is no
    /// [`Form::Spheres`].
    fn foremost(&self) -> Option<Sphere> {
        let spheres = self.spheres().iter().copied();
        spheres.min_by(|sphere, other| sphere.behind.total_cmp(&other.behind))
    }

    /// Returns a mutable reference to the radius of a form in m: the radius of a sphere, of the
    /// first of several spheres, of a rounded apex or of a punch. Returns `None` for other forms.
    pub fn radius_mut(&mut self) -> Option<&mut f64> {
        match self {
            Form::Paraboloid { radius }
            | Form::WavySphere { radius, .. }
            | Form::RoundedCone { radius, .. }
            | Form::Punch { radius } => Some(radius),
            Form::Spheres(spheres) => spheres.first_mut().map(|sphere| &mut sphere.radius),
            _ => None,
        }
    }

    /// Returns the radius in m of a body that is one sphere without waves; `None` for other forms.
    pub fn sphere_radius(&self) -> Option<f64> {
        match self {
            Form::Paraboloid { radius } => Some(*radius),
            Form::Spheres(spheres) => match spheres[..] {
                [sphere] => Some(sphere.radius),
                _ => None,
            },
            _ => None,
        }
    }

    /// Returns the curvature of the form at its summit in 1/m. For several spheres, returns the
    /// largest curvature. Returns `None` for a cone and a power law. Also returns `None` for a
    /// table that has not been read, or whose curvature at the tip is not finite.
    pub fn summit_curvature(&self) -> Option<f64> {
        match *self {
            Form::Paraboloid { radius } | Form::RoundedCone { radius, .. } => Some(1.0 / radius),
            Form::Spheres(ref spheres) => {
                let radii = spheres.iter().map(|sphere| sphere.radius);
                radii.reduce(f64::min).map(f64::recip)
            }
            Form::WavySphere {
                radius,
                amplitude,
                wavelength,
            } => Some(1.0 / radius + amplitude * (TAU / wavelength).powi(2)),
            Form::Punch { .. } => Some(0.0),
            Form::Cone { .. } | Form::Power { .. } => None,
            Form::Table { .. } => self.table()?.summit_curvature(),
        }
    }

    /// Returns the depth in m of the equivalent profile below its apex, at the position of one
    /// spring. `spring` is the index of this spring from the left end of the profile, `points` is
    /// the number of all springs, and `spacing` is the distance between springs in m.
    ///
    /// ```
    /// use asperity_surface::{Form, Sphere};
    ///
    /// let first = Sphere { radius: 1.0, behind: 0.0 };
    /// let second = Sphere { radius: 0.5, behind: 0.1 };
    /// let spheres = Form::Spheres(vec![first, second]);
    /// let depths: Vec<f64> =
    ///     (0..8).map(|spring| spheres.depth_of_spring(spring, 8, 0.1)).collect();
    /// assert_eq!((depths[2], depths[6]), (0.0, 0.1));
    /// ```
    pub fn depth_of_spring(&self, spring: usize, points: usize, spacing: f64) -> f64 {
        // The distance is a whole number of spacings, computed from integers and therefore exact.
        // The profile is then exactly as symmetric as the form.
        let distance = |axis: usize| spring.abs_diff(axis) as f64 * spacing;
        let spheres = self.spheres();
        if spheres.is_empty() {
            let axis = Form::spring_on_axis(points as u64) as usize;
            return self.mdr_profile(distance(axis));
        }
        // Sphere k has the springs from ⌊kN/n⌋ to ⌊(k + 1)N/n⌋ − 1, for N springs and n spheres.
        // This is the largest k for which kN is below n(spring + 1).
        let index = (spheres.len() * (spring + 1) - 1) / points;
        let first = index * points / spheres.len();
        let end = (index + 1) * points / spheres.len();
        let sphere = spheres[index];
        let axis = first + (end - first) / 2;
        sphere.behind + sphere.paraboloid().mdr_profile(distance(axis))
    }

    /// Returns the largest depth in m of the equivalent profile below its apex, on a profile of the
    /// length `length` in m. The waves of a [`Form::WavySphere`] are left out.
    pub fn depth_within(&self, length: f64) -> f64 {
        let half_width = 0.5 * length / self.contacts() as f64;
        let mut deepest = 0.0_f64;
        for sphere in self.spheres() {
            let depth = sphere.behind + sphere.paraboloid().mdr_profile(half_width);
            deepest = deepest.max(depth);
        }
        match self {
            Form::Spheres(_) => deepest,
            _ => self.without_waves().mdr_profile(half_width),
        }
    }

    /// Returns the depth g(x) in m of the equivalent profile below its apex, at a distance x from
    /// the axis in m. The formula is g(x) = |x| ∫₀^|x| f′(r)/√(x²−r²) dr, where f(r) is
    /// [`Form::depth`].
    ///
    /// For a punch the depth is 0. For several spheres the result is the depth of the sphere that
    /// is ahead, alone; [`Form::depth_of_spring`] takes all spheres into account.
    ///
    /// ```
    /// // A sphere f = r²/2R becomes g = x²/R.
    /// let sphere = asperity_surface::Form::Paraboloid { radius: 1e-4 };
    /// assert!((sphere.mdr_profile(1e-5) / 1e-6 - 1.0).abs() < 1e-12);
    /// ```
    pub fn mdr_profile(&self, distance: f64) -> f64 {
        let x = distance.abs();
        match *self {
            Form::Paraboloid { radius } => x * x / radius,
            Form::Spheres(_) => {
                let foremost = self.foremost();
                foremost.map_or(0.0, |sphere| sphere.paraboloid().mdr_profile(x))
            }
            Form::RoundedCone { radius, angle } => {
                let slope = angle.tan();
                let rounded = radius * slope;
                if x <= rounded {
                    return x * x / radius;
                }
                // This term equals the published form (x − √(x² − b²))/b (Popov, Heß and Willert,
                // Handbook of Contact Mechanics, 2019, cone with a rounded tip). It is written in
                // another way to avoid the difference of nearly equal numbers.
                let root = ((x - rounded) * (x + rounded)).sqrt();
                x * slope * (rounded / (x + root) + (rounded / x).acos())
            }
            Form::Cone { angle } => FRAC_PI_2 * x * angle.tan(),
            Form::Power {
                coefficient,
                exponent,
            } => power_law_factor(exponent) * coefficient * x.powf(exponent),
            Form::WavySphere {
                radius,
                amplitude,
                wavelength,
            } => {
                x * x / radius
                    + PI * PI * amplitude / wavelength * x * struve_0(2.0 * PI * x / wavelength)
            }
            Form::Punch { .. } => 0.0,
            Form::Table { .. } => self.table().map_or(0.0, |table| table.mdr_profile(x)),
        }
    }

    /// Returns the depth in m of the body below its apex at the place (x, y). x and y are distances
    /// in m from the middle of a square with the side `side` in m. The axes of n spheres are a
    /// distance `side`/n apart along y = 0. Returns `None` beside a punch, where there is no body.
    pub fn depth_in_square(&self, x: f64, y: f64, side: f64) -> Option<f64> {
        let spheres = self.spheres();
        if spheres.is_empty() {
            return self.depth(x.hypot(y));
        }
        let mut shallowest = f64::INFINITY;
        for (index, sphere) in spheres.iter().enumerate() {
            let share = (index as f64 + 0.5) / spheres.len() as f64;
            let distance = (x - (share - 0.5) * side).hypot(y);
            let depth = sphere.behind + sphere.paraboloid().depth(distance)?;
            shallowest = shallowest.min(depth);
        }
        Some(shallowest)
    }

    /// Returns the depth f(r) in m of the body below its apex, at the distance r = `radius` from
    /// the axis in m. For several spheres it is the depth of the sphere that is ahead, alone;
    /// [`Form::depth_in_square`] takes all spheres into account. Returns `None` beside a punch,
    /// where there is no body.
    ///
    /// ```
    /// assert_eq!(
    ///     asperity_surface::Form::Paraboloid { radius: 2.0 }.depth(0.1),
    ///     Some(0.1 * 0.1 / 4.0)
    /// );
    /// ```
    pub fn depth(&self, radius: f64) -> Option<f64> {
        Some(match *self {
            Form::Paraboloid { radius: curvature } => radius * radius / (2.0 * curvature),
            Form::Spheres(_) => return self.foremost()?.paraboloid().depth(radius),
            Form::RoundedCone {
                radius: curvature,
                angle,
            } => {
                let slope = angle.tan();
                let rounded = curvature * slope;
                if radius <= rounded {
                    radius * radius / (2.0 * curvature)
                } else {
                    (radius - 0.5 * rounded) * slope
                }
            }
            Form::Cone { angle } => radius * angle.tan(),
            Form::Power {
                coefficient,
                exponent,
            } => coefficient * radius.powf(exponent),
            Form::WavySphere {
                radius: curvature,
                amplitude,
                wavelength,
            } => {
                radius * radius / (2.0 * curvature)
                    + amplitude * (1.0 - (TAU * radius / wavelength).cos())
            }
            Form::Punch { radius: end } => return (radius <= end).then_some(0.0),
            Form::Table { .. } => self.table().map_or(0.0, |table| table.depth(radius)),
        })
    }

    /// Returns the coefficient c in m^(1−n) and the exponent n of a form whose equivalent profile
    /// is the power law g(x) = c |x|ⁿ. Returns `None` for all other forms.
    ///
    /// ```
    /// assert_eq!(
    ///     asperity_surface::Form::Paraboloid { radius: 0.5 }.power_law(),
    ///     Some((2.0, 2.0))
    /// );
    /// assert_eq!(
    ///     asperity_surface::Form::Punch { radius: 0.5 }.power_law(),
    ///     None
    /// );
    /// ```
    pub fn power_law(&self) -> Option<(f64, f64)> {
        match *self {
            Form::Paraboloid { radius } => Some((radius.recip(), 2.0)),
            Form::Spheres(_) => Some((self.sphere_radius()?.recip(), 2.0)),
            Form::Cone { angle } => Some((FRAC_PI_2 * angle.tan(), 1.0)),
            Form::Power {
                coefficient,
                exponent,
            } => Some((power_law_factor(exponent) * coefficient, exponent)),
            Form::WavySphere { .. }
            | Form::RoundedCone { .. }
            | Form::Punch { .. }
            | Form::Table { .. } => None,
        }
    }

    /// Returns an upper bound in m of the depth that waves add to the equivalent profile of a
    /// [`Form::WavySphere`], at the distance r in m from the axis. With the amplitude A and the
    /// wavelength λ, the bound is π A √(r/λ), and π A for r < λ. The bound is 0 for all other
    /// forms.
    pub fn wave_depth(&self, distance: f64) -> f64 {
        match *self {
            Form::WavySphere {
                amplitude,
                wavelength,
                ..
            } => PI * amplitude * (distance / wavelength).max(1.0).sqrt(),
            _ => 0.0,
        }
    }
}

/// Returns the factor κₙ = (√π/2) n Γ(n/2)/Γ((n+1)/2) for the exponent n = `exponent`. With this
/// factor, a body of the depth rⁿ has the equivalent profile κₙ |x|ⁿ.
pub fn power_law_factor(exponent: f64) -> f64 {
    // The logarithms of Γ are subtracted, because both values of Γ may be too large for a number.
    let quotient = (libm::lgamma(exponent / 2.0) - libm::lgamma((exponent + 1.0) / 2.0)).exp();
    PI.sqrt() / 2.0 * exponent * quotient
}

/// Value of z above which the asymptotic series of H₀(z) is accurate to rounding. The smallest term
/// of the series is about e^(−z).
const LARGE: f64 = 40.0;

/// Number of nodes of the quadrature for H₀. It is enough for the oscillations of the integrand
/// with arguments up to [`LARGE`].
const NODES: usize = 56;

/// Gauss rule on a quarter circle for the integral of H₀.
static RULE: LazyLock<[(f64, f64); NODES]> = LazyLock::new(gauss_nodes_on_quarter_circle);

/// Computes the Struve function H₀(z) for z ≥ 0.
pub fn struve_0(z: f64) -> f64 {
    if z < LARGE {
        let terms = RULE
            .iter()
            .map(|&(angle, weight)| weight * (z * angle.cos()).sin());
        return FRAC_2_PI * terms.sum::<f64>();
    }
    // Asymptotic series H₀ − Y₀ ~ (2/π) Σ (−1)^k ((2k−1)!!)²/z^(2k+1). The sum ends where the terms
    // begin to grow, or where they are smaller than the rounding error of the sum.
    let mut sum = 0.0;
    let mut term = z.recip();
    for k in 0..LARGE as u32 {
        sum += term;
        let next = -term * ((2.0 * f64::from(k) + 1.0) / z).powi(2);
        if next.abs() >= term.abs() || next.abs() < f64::EPSILON * f64::abs(sum) {
            break;
        }
        term = next;
    }
    libm::y0(z) + FRAC_2_PI * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes g(x) from its definition. With r = x sin t, g(x) is x ∫₀^{π/2} f′(x sin t) dt.
    fn by_definition(slope: impl Fn(f64) -> f64, x: f64) -> f64 {
        let steps = 20_000;
        let width = std::f64::consts::FRAC_PI_2 / f64::from(steps);
        (0..steps)
            .map(|k| slope(x * ((f64::from(k) + 0.5) * width).sin()))
            .sum::<f64>()
            * width
            * x
    }

    #[test]
    fn transforms_follow_their_definition() {
        let x = 0.7;
        let (radius, angle) = (2.5, 0.3_f64);
        type Slope = Box<dyn Fn(f64) -> f64>;
        let wavy = Form::WavySphere {
            radius,
            amplitude: 0.02,
            wavelength: 0.3,
        };
        let wave = 2.0 * PI / 0.3;
        // The rounded apex ends at r = R tan θ. With one of the two radii this end is below x, and
        // with the other above x.
        let apex = |radius: f64| -> (Form, Slope) {
            let rounded = radius * angle.tan();
            let slope = move |r: f64| {
                if r < rounded { r / radius } else { angle.tan() }
            };
            (Form::RoundedCone { radius, angle }, Box::new(slope))
        };
        let cases: [(Form, Slope); 8] = [
            apex(0.1),
            apex(1.0),
            apex(2.5),
            (Form::Paraboloid { radius }, Box::new(move |r| r / radius)),
            (Form::Cone { angle }, Box::new(move |_| angle.tan())),
            (
                wavy,
                Box::new(move |r| r / radius + 0.02 * wave * (wave * r).sin()),
            ),
            (
                Form::Power {
                    coefficient: 0.4,
                    exponent: 3.7,
                },
                Box::new(|r: f64| 0.4 * 3.7 * r.powf(2.7)),
            ),
            (
                Form::Power {
                    coefficient: 0.4,
                    exponent: 60.0,
                },
                Box::new(|r: f64| 24.0 * r.powf(59.0)),
            ),
        ];
        for (form, slope) in cases {
            let expected = by_definition(slope, x);
            let found = form.mdr_profile(-x);
            assert!(
                (found - expected).abs() < 1e-7 * expected,
                "{form:?}: {found} against {expected}"
            );
        }
        // Special cases of the power law: for n = 1 (a cone) g = (π/2) f, and for n = 2 (a
        // paraboloid) g = 2f.
        assert!((power_law_factor(1.0) - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
        assert!((power_law_factor(2.0) - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_rounded_cone_is_a_sphere_inside_and_nearly_a_cone_far_outside() {
        let angle = 0.4_f64;
        let form = Form::RoundedCone { radius: 0.5, angle };
        let sphere = Form::Paraboloid { radius: 0.5 };
        let rounded = 0.5 * angle.tan();
        for share in [0.0, 0.1, 0.999, 1.0] {
            let x = share * rounded;
            assert_eq!(form.mdr_profile(x), sphere.mdr_profile(x));
            assert_eq!(form.depth(x), sphere.depth(x));
        }
        // The profile and its slope are continuous at the edge of the rounded apex.
        let step = 1e-6 * rounded;
        let beyond = form.mdr_profile(rounded + step) - form.mdr_profile(rounded);
        assert!(beyond > 0.0 && beyond < 3.0 * step * rounded / 0.5);
        // Far outside, the depth f = r tan θ − b tan θ/2 is by b tan θ/2 smaller than the depth of
        // a cone.
        let cone = Form::Cone { angle };
        let far = 1e6 * rounded;
        let missing = cone.depth(far).unwrap() - form.depth(far).unwrap();
        assert!((missing / (0.5 * rounded * angle.tan()) - 1.0).abs() < 1e-6);
        assert!((form.mdr_profile(far) / cone.mdr_profile(far) - 1.0).abs() < 1e-5);
    }

    /// Each sphere has its own part of the springs, and each part has its axis in its middle.
    #[test]
    fn spheres_are_above_equal_parts_of_the_length() {
        let spheres: Vec<Sphere> = [(2.0, 0.0), (3.0, 0.25), (0.5, 0.125), (1.0, 0.0)]
            .map(|(radius, behind)| Sphere { radius, behind })
            .to_vec();
        for count in 1..=spheres.len() {
            let form = Form::Spheres(spheres[..count].to_vec());
            for points in (count..40).chain([101, 4096]) {
                let spacing = 1.0 / points as f64;
                let mut widest = 0;
                let mut deepest = 0.0;
                let mut spring = 0;
                for (index, sphere) in spheres[..count].iter().enumerate() {
                    let end = (index + 1) * points / count;
                    let springs = end - spring;
                    widest = widest.max(springs);
                    let axis = spring + springs / 2;
                    while spring < end {
                        let depth = form.depth_of_spring(spring, points, spacing);
                        let distance = spring.abs_diff(axis) as f64 * spacing;
                        assert_eq!(depth, sphere.behind + distance * distance / sphere.radius);
                        deepest = f64::max(deepest, depth);
                        spring += 1;
                    }
                }
                assert_eq!(spring, points);
                // If the springs cannot be divided evenly, some parts have one spring more.
                let wider = (1.0 + 2.0 * count as f64 * spacing).powi(2);
                assert!(deepest <= form.depth_within(1.0) * wider);
                assert!(widest <= points / count + 1);
            }
        }
        // In a square the axes of two spheres are half a side apart. The depth is that of the
        // sphere which is nearer to the elastic body.
        let form = Form::Spheres(spheres[..2].to_vec());
        let square = |x, y| form.depth_in_square(x, y, 1.0).unwrap();
        assert_eq!([square(-0.25, 0.0), square(0.25, 0.0)], [0.0, 0.0625]);
        assert!((square(0.25, 1.0) - 0.3125).abs() < 1e-15);
        assert_eq!(form.summit_curvature(), Some(0.5));
    }

    /// One sphere is a paraboloid in all functions.
    #[test]
    fn one_sphere_of_a_list_is_a_paraboloid() {
        let radius = 1.7;
        let behind = 0.0;
        let list = Form::Spheres(vec![Sphere { radius, behind }]);
        let sphere = Form::Paraboloid { radius };
        for points in [1, 2, 3, 16, 101] {
            let spacing = 1.0 / points as f64;
            for spring in 0..points {
                let depth = list.depth_of_spring(spring, points, spacing);
                assert_eq!(depth, sphere.depth_of_spring(spring, points, spacing));
            }
        }
        for x in [0.0, 0.3, 2.0] {
            assert_eq!(list.mdr_profile(x), sphere.mdr_profile(x));
            assert_eq!(list.depth(x), sphere.depth(x));
            let in_square = list.depth_in_square(x, 0.2, 1.0);
            assert_eq!(in_square, sphere.depth_in_square(x, 0.2, 1.0));
        }
        assert_eq!(list.depth_within(2.0), sphere.depth_within(2.0));
        assert_eq!(list.power_law(), sphere.power_law());
        assert_eq!(list.summit_curvature(), sphere.summit_curvature());
        assert_eq!(list.sphere_radius(), sphere.sphere_radius());
    }

    #[test]
    fn a_punch_covers_the_nearest_number_of_whole_cells() {
        let under = |radius, points| Form::Punch { radius }.springs_under(1.0, points);
        // The width of the punch is a whole number of cells, which may be odd.
        assert_eq!(
            (under(0.2, 10), under(0.25, 10), under(0.3, 10)),
            (3..7, 3..8, 2..8)
        );
        assert_eq!((under(0.2, 5), under(0.3, 5)), (1..3, 1..4));
        // A punch covers a spring only if its radius is at least a quarter of a cell.
        assert_eq!((under(0.026, 10).count(), under(0.024, 10).count()), (1, 0));
        for points in 1..20 {
            assert_eq!(under(0.5, points), 0..points);
            assert_eq!(under(9.0, points), 0..points);
            let sphere = Form::Paraboloid { radius: 1.0 };
            assert_eq!(sphere.springs_under(1.0, points), 0..points);
            for cells in 1..=points {
                let springs = under(0.5 * cells as f64 / points as f64, points);
                assert_eq!(springs.end - springs.start, cells);
                assert!(
                    springs.contains(&Form::spring_on_axis(points)) || cells == 0,
                    "{springs:?} of {points}"
                );
            }
        }
    }

    fn series(z: f64) -> f64 {
        let (mut term, mut sum) = (z, 0.0);
        for k in 1..60 {
            sum += term;
            term *= -z * z / (2.0 * f64::from(k) + 1.0).powi(2);
        }
        FRAC_2_PI * sum
    }

    #[test]
    fn small_arguments_are_those_of_the_power_series() {
        for k in 0..100 {
            let z = 0.05 * f64::from(k);
            let (found, expected) = (struve_0(z), series(z));
            assert!(
                (found - expected).abs() <= 1e-14 * expected.abs().max(0.1),
                "{z}: {found} {expected}"
            );
        }
    }

    #[test]
    fn both_ways_agree_where_they_meet_and_solve_the_equation_of_struve() {
        assert!((struve_0(LARGE.next_down()) - struve_0(LARGE)).abs() < 4e-14);
        // H₀ solves the differential equation z H₀″ + H₀′ + z H₀ = 2/π.
        for z in [0.3, 3.0, 20.0, 39.9, 40.1, 300.0] {
            let step = 1e-3;
            let [below, at, above] = [-step, 0.0, step].map(|by| struve_0(z + by));
            let (slope, bend) = (
                (above - below) / (2.0 * step),
                (above - 2.0 * at + below) / (step * step),
            );
            assert!(
                (z * (bend + at) + slope - FRAC_2_PI).abs() < 2e-7 * z.max(1.0),
                "{z}: {slope} {bend}"
            );
        }
    }
}
