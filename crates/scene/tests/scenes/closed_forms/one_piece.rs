//! Closed forms of smooth bodies of revolution that touch in one piece, by the rule of Hess and by
//! JKR, with one or two works of adhesion: a sphere, a cone, a power law, or a sphere with
//! concentric waves (Guduru 2007), the simplest smooth body with a hysteresis due to its shape.

use crate::numerics::{integral, invert};
use asperity_surface::Form;
use asperity_surface::lines::{power_law_factor, struve_0};
use std::f64::consts::PI;

/// A body on a half-space with adhesion. With the equivalent profile g(a), of area G(a) from 0 to
/// a, its contact of radius a is in equilibrium at the indentation d(a) = g(a) − √(2πaγ/E*), stable
/// where d rises, under F(a) = 2E*(a d − G).
///
/// Where the profile does not rise everywhere, for waves with λ²/(AR) < 12.391, an inner spring may
/// be the most stretched one, and the contact detaches earlier by the rule than by JKR
/// ([`OnePiece::by_rule`]).
#[derive(Clone, Debug)]
pub struct OnePiece {
    /// Neither a punch nor a flat face.
    pub form: Form,
    /// E*, Pa.
    pub modulus: f64,
    /// γ, J/m².
    pub work: f64,
    /// No contact is wider, m.
    pub widest: f64,
    /// An edge on unloading stays only where the profile is deeper than anywhere inside.
    pub by_rule: bool,
}

/// Radii from one to another over which an edge moves without a jump, m.
pub type Ranges = Vec<(f64, f64)>;

impl OnePiece {
    pub fn new(form: Form, modulus: f64, work: f64, widest: f64) -> Self {
        OnePiece {
            form,
            modulus,
            work,
            widest,
            by_rule: false,
        }
    }

    /// g, dg/da and G at a radius.
    fn profile(&self, a: f64) -> [f64; 3] {
        let power = |c: f64, n: f64| {
            let g = c * a.powf(n);
            [g, n * c * a.powf(n - 1.0), g * a / (n + 1.0)]
        };
        match self.form {
            Form::Paraboloid { radius } => power(1.0 / radius, 2.0),
            Form::Cone { angle } => power(0.5 * PI * angle.tan(), 1.0),
            Form::Power {
                coefficient,
                exponent,
            } => power(power_law_factor(exponent) * coefficient, exponent),
            Form::WavySphere {
                radius,
                amplitude,
                wavelength,
            } => {
                let [g, slope, area] = power(1.0 / radius, 2.0);
                let (turns, scale) = (2.0 * PI * a / wavelength, 0.5 * PI * amplitude);
                let h0 = struve_0(turns);
                let difference = |step: f64| struve_0(turns + step) - struve_0(turns - step);
                let derivative = (8.0 * difference(1e-3) - difference(2e-3)) / 12e-3;
                // ∫ z H₀ dz = z H₁ with H₁ = 2/π − dH₀/dz.
                let rise = 2.0 * PI / wavelength * (h0 + turns * derivative);
                [
                    g + scale * turns * h0,
                    slope + scale * rise,
                    area + scale * a * (2.0 / PI - derivative),
                ]
            }
            Form::RoundedCone { radius, angle } => {
                let slope = angle.tan();
                let b = radius * slope;
                if a <= b {
                    return power(1.0 / radius, 2.0);
                }
                // The four terms are the integrals of x², x √(x² − b²) and x arccos(b/x).
                let root = (a * a - b * b).sqrt();
                let arc = (b / a).acos();
                let squares = (a.powi(3) - b.powi(3) - root.powi(3)) / (3.0 * b);
                let arcs = 0.5 * (a * a * arc - b * root);
                [
                    a * slope * ((a - root) / b + arc),
                    slope * (2.0 * (a - root) / b + arc),
                    b.powi(3) / (3.0 * radius) + slope * (squares + arcs),
                ]
            }
            Form::Punch { .. } | Form::Spheres(_) | Form::Table { .. } => {
                unreachable!("not in one piece with a smooth edge")
            }
        }
    }

    /// Rule of Hess, eq. (3), m.
    fn stretch(&self, a: f64) -> f64 {
        (2.0 * PI * a * self.work / self.modulus).sqrt()
    }

    /// g at a radius, m: without the derivative of waves, which takes most of the time of
    /// [`OnePiece::profile`].
    fn depth(&self, a: f64) -> f64 {
        let Form::WavySphere {
            radius,
            amplitude,
            wavelength,
        } = self.form
        else {
            return self.profile(a)[0];
        };
        let turns = 2.0 * PI * a / wavelength;
        a * a / radius + 0.5 * PI * amplitude * turns * struve_0(turns)
    }

    pub fn indentation(&self, a: f64) -> f64 {
        self.depth(a) - self.stretch(a)
    }

    /// dd/da.
    fn slope(&self, a: f64) -> f64 {
        self.profile(a)[1] - self.stretch(a) / (2.0 * a)
    }

    pub fn force(&self, a: f64) -> f64 {
        let [g, _, area] = self.profile(a);
        2.0 * self.modulus * (a * (g - self.stretch(a)) - area)
    }

    /// Evenly spaced radii, 400 for each wave.
    fn radii(&self, to: f64) -> Vec<f64> {
        let wave = if let Form::WavySphere { wavelength, .. } = self.form {
            wavelength
        } else {
            to
        };
        let steps = (400.0 * (to / wave).max(1.0)).ceil() as u32;
        (1..=steps)
            .map(|k| to * f64::from(k) / f64::from(steps))
            .collect()
    }

    /// Ranges over which d rises.
    fn stable(&self) -> Ranges {
        let radii = self.radii(self.widest);
        let mut ends: Vec<f64> = if self.slope(radii[0]) > 0.0 {
            vec![0.0]
        } else {
            Vec::new()
        };
        for pair in radii.windows(2) {
            let sign = self.slope(pair[1]).signum();
            if self.slope(pair[0]).signum() != sign {
                ends.push(invert(|a| sign * self.slope(a), 0.0, pair[0], pair[1]));
            }
        }
        ends.push(self.widest);
        ends.chunks_exact(2)
            .map(|ends| (ends[0], ends[1]))
            .collect()
    }

    /// Part of a range over which d rises in which the profile is deeper than anywhere inside.
    fn deepest_edges(&self, (low, high): (f64, f64)) -> Option<(f64, f64)> {
        let crest = |pair: &[f64]| {
            let slopes = [pair[0], pair[1]].map(|a| self.profile(a)[1]);
            (slopes[0] > 0.0 && slopes[1] <= 0.0)
                .then(|| self.depth(invert(|a| -self.profile(a)[1], 0.0, pair[0], pair[1])))
        };
        let inside = self
            .radii(low)
            .windows(2)
            .filter_map(crest)
            .fold(0.0, f64::max);
        let deepest = |range| invert(|a| self.depth(a), inside, range, high);
        if self.depth(low) >= inside {
            Some((low, high))
        } else {
            (self.depth(high) > inside).then(|| (deepest(low), high))
        }
    }

    /// Range of radii of a range between two indentations.
    fn between(&self, from: f64, to: f64, (low, high): (f64, f64)) -> (f64, f64) {
        (
            invert(|a| self.indentation(a), from, low, high),
            invert(|a| self.indentation(a), to, low, high),
        )
    }

    /// The ranges of a loading from one indentation to another: the edge is at the smallest radius
    /// at which d first exceeds the indentation.
    pub fn loading(&self, from: f64, deepest: f64) -> Ranges {
        let (mut path, mut level) = (Vec::new(), from);
        for range in self.stable() {
            let end = self.indentation(range.1).min(deepest);
            if end > level {
                path.push(self.between(level, end, range));
                level = end;
            }
        }
        assert!(level >= deepest, "{self:?} is wider at {deepest} m");
        path
    }

    /// The ranges of an unloading from a radius to separation, the largest first: the edge is at
    /// the largest radius below which d falls under the indentation.
    pub fn unloading(&self, turn: f64) -> Ranges {
        let (mut path, mut level) = (Vec::new(), f64::INFINITY);
        let stable = self
            .stable()
            .into_iter()
            .rev()
            .filter(|range| range.0 < turn);
        let ranges = stable.filter_map(|range| {
            if self.by_rule {
                self.deepest_edges(range)
            } else {
                Some(range)
            }
        });
        for (low, high) in ranges {
            if path.is_empty() {
                path.push((low, turn));
            } else if self.indentation(low) < level {
                path.push(self.between(self.indentation(low), level, (low, high)));
            } else {
                continue;
            }
            level = self.indentation(low);
        }
        path
    }

    /// Radius at an indentation along a path.
    pub fn radius(&self, path: &Ranges, d: f64) -> f64 {
        let mut ranges = path.iter().filter(|range| d <= self.indentation(range.1));
        let (low, high) = *ranges
            .find(|range| d >= self.indentation(range.0))
            .unwrap_or(&path[path.len() - 1]);
        invert(|a| self.indentation(a), d, low, high)
    }

    /// ∫F dd over a path, J.
    fn work_along(&self, path: &Ranges) -> f64 {
        let power = |a: f64| {
            if a > 0.0 {
                self.force(a) * self.slope(a)
            } else {
                0.0
            }
        };
        let apex = self.edge_of_apex();
        let mut work = 0.0;
        for &(low, high) in path {
            let inside = apex.clamp(low, high);
            work += integral(power, low, inside);
            // The slope outside grows with the square root of the distance from the apex, which
            // Simpson's rule integrates well over this root alone.
            let begin = (inside - apex).sqrt();
            if inside < high {
                let end = (high - apex).sqrt();
                work += integral(|root| 2.0 * root * power(apex + root * root), begin, end);
            }
        }
        work
    }

    /// Radius at which the rounded apex of a cone ends, m; infinite for other forms.
    fn edge_of_apex(&self) -> f64 {
        match self.form {
            Form::RoundedCone { radius, angle } => radius * angle.tan(),
            _ => f64::INFINITY,
        }
    }
}

/// A loop from separation to an indentation and back, with its edge pinned at the turn until the
/// opening rule releases it.
pub struct Loop {
    pub closing: OnePiece,
    pub opening: OnePiece,
    pub loading: Ranges,
    pub unloading: Ranges,
    /// Indentation of the turn, m, and radius of the contact there, m.
    pub deepest: f64,
    pub radius: f64,
}

impl Loop {
    /// Creates the loop of a body with another work of adhesion on closing, J/m².
    pub fn new(opening: OnePiece, closing_work: f64, deepest: f64) -> Self {
        let closing = OnePiece {
            work: closing_work,
            ..opening.clone()
        };
        let loading = closing.loading(0.0, deepest);
        let radius = loading[loading.len() - 1].1;
        Loop {
            unloading: opening.unloading(radius),
            closing,
            opening,
            loading,
            deepest,
            radius,
        }
    }

    /// Force on loading at an indentation, N.
    pub fn loading_force(&self, d: f64) -> f64 {
        self.closing.force(self.closing.radius(&self.loading, d))
    }

    /// Force on unloading at an indentation, N.
    pub fn unloading_force(&self, d: f64) -> f64 {
        if d >= self.opening.indentation(self.radius) {
            let slope = 2.0 * self.opening.modulus * self.radius;
            return self.closing.force(self.radius) - slope * (self.deepest - d);
        }
        self.opening.force(self.opening.radius(&self.unloading, d))
    }

    /// Indentation and force of pull-off under force control.
    pub fn pull_off(&self) -> (f64, f64) {
        let Loop {
            opening, unloading, ..
        } = self;
        let mut best = (f64::INFINITY, 0.0);
        for &(low, high) in unloading {
            // dF/da = 2E* (a dd/da − stretch) is zero inside, or the smallest force is at the end
            // before a jump.
            let steps = opening.radii(high).len() as u32;
            let radius = |k: u32| low + (high - low) * f64::from(k) / f64::from(steps);
            let change = |a: f64| a * opening.slope(a) - opening.stretch(a);
            let turns =
                (0..steps).filter(|&k| change(radius(k)) < 0.0 && change(radius(k + 1)) >= 0.0);
            let turns = turns.map(|k| invert(change, 0.0, radius(k), radius(k + 1)));
            for a in turns.chain([low, high]) {
                if opening.force(a) < best.0 {
                    best = (opening.force(a), a);
                }
            }
        }
        (opening.indentation(best.1), best.0)
    }

    /// Indentation and force of the last contact.
    pub fn separation(&self) -> (f64, f64) {
        let last = self.unloading[self.unloading.len() - 1].0;
        (self.opening.indentation(last), self.opening.force(last))
    }

    pub fn dissipated_energy(&self) -> f64 {
        let released = self.opening.indentation(self.radius);
        let forces = self.unloading_force(self.deepest) + self.unloading_force(released);
        let pinned = 0.5 * forces * (self.deepest - released);
        self.closing.work_along(&self.loading) - pinned - self.opening.work_along(&self.unloading)
    }
}
