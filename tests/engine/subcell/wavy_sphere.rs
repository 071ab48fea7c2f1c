//! Adhesive contact of a sphere with concentric waves (Guduru 2007) under the rule of Hess: the simplest smooth
//! body with a hysteresis due to its shape.

use asperity::analysis::SteepWaves;
use asperity::surface::{struve_0, struve_1};
use std::f64::consts::PI;

/// A sphere of radius R with waves A (1 − cos 2πr/λ) about its axis, on a half-space with adhesion.
///
/// The closed form is that of a contact in one piece. The equivalent profile rises everywhere, and the rule of Hess
/// and JKR agree, for λ²/(AR) > 12.391; below that an inner spring may be the most stretched one, and the contact
/// detaches earlier by the rule ([`Self::cycle_by_rule`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavySphere {
    /// R, m.
    pub radius: f64,
    /// A, m.
    pub amplitude: f64,
    /// λ, m.
    pub wavelength: f64,
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
    /// Work of adhesion γ, J/m².
    pub work_of_adhesion: f64,
}

/// Figures of a loop to an indentation and back to separation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavyLoop {
    /// Largest contact radius, m.
    pub contact_radius: f64,
    /// Smallest force during unloading, N.
    pub smallest_force: f64,
    /// Indentation at separation, m.
    pub separation: f64,
    /// Dissipated energy, J.
    pub dissipated_energy: f64,
}

/// Number of contact radii examined per wavelength.
const STEPS_PER_WAVE: f64 = 400.0;

impl WavySphere {
    /// Returns true if the equivalent profile rises everywhere.
    pub fn is_monotone(&self) -> bool {
        self.wavelength.powi(2) > SteepWaves::LEAST_RATIO * self.amplitude * self.radius
    }

    /// Indentation δ(a) = a²/R + (π²A/λ) a H₀(2πa/λ) − √(2πaγ/E*), m, of a contact of radius a.
    pub fn indentation(&self, radius: f64) -> f64 {
        let wave = PI * PI * self.amplitude / self.wavelength * radius * struve_0(self.turns(radius));
        radius * radius / self.radius + wave - self.stretch(radius)
    }

    /// Force, N, of a contact of radius a:
    /// 2E*[2a³/3R + (πAa/2)((2πa/λ) H₀(2πa/λ) − H₁(2πa/λ))] − √(8πE*γa³).
    pub fn force(&self, radius: f64) -> f64 {
        let turns = self.turns(radius);
        let wave = 0.5 * PI * self.amplitude * radius * (turns * struve_0(turns) - struve_1(turns));
        let pressed = 2.0 * radius.powi(3) / (3.0 * self.radius) + wave;
        2.0 * self.effective_modulus * (pressed - radius * self.stretch(radius))
    }

    /// 2πa/λ.
    fn turns(&self, radius: f64) -> f64 {
        2.0 * PI * radius / self.wavelength
    }

    /// Rule of Hess, eq. (3), m.
    fn stretch(&self, radius: f64) -> f64 {
        (2.0 * PI * radius * self.work_of_adhesion / self.effective_modulus).sqrt()
    }

    /// The loop to an indentation δ_m (m) and back: on loading the edge is at the smallest radius at which δ first
    /// exceeds the indentation, on unloading at the largest one at which δ falls below; `widest` bounds the radius, m.
    ///
    /// `None` for a wider contact.
    pub fn cycle(&self, deepest: f64, widest: f64) -> Option<WavyLoop> {
        let stable = self.stable(widest);
        self.cycle_within(deepest, &stable, &stable)
    }

    /// The same loop by the rule of Hess: on unloading the edge is stable only where the equivalent profile is
    /// deeper than anywhere inside the contact, since deeper springs inside are stretched more and detach first;
    /// then only the part inside of them remains in contact.
    ///
    /// `None` for a wider contact.
    pub fn cycle_by_rule(&self, deepest: f64, widest: f64) -> Option<WavyLoop> {
        let stable = self.stable(widest);
        let deepest_edges = stable.iter().filter_map(|&range| self.deepest_edges(range)).collect::<Vec<_>>();
        self.cycle_within(deepest, &stable, &deepest_edges)
    }

    /// Part of a range over which δ rises, in which the profile is deeper than anywhere inside, m.
    fn deepest_edges(&self, (low, high): (f64, f64)) -> Option<(f64, f64)> {
        // Where δ rises, so does the profile: the stretch grows with the radius.
        let depth = |radius: f64| self.indentation(radius) + self.stretch(radius);
        let steps = (STEPS_PER_WAVE * (low / self.wavelength).max(1.0)).ceil() as u32;
        let radius = |k: u32| low * f64::from(k) / f64::from(steps);
        let inside = (1..steps).max_by(|&a, &b| depth(radius(a)).total_cmp(&depth(radius(b))))?;
        let inside = golden(|a| -depth(a), radius(inside - 1), radius(inside + 1));
        let inside = depth(inside).max(0.0);
        if depth(low) >= inside {
            return Some((low, high));
        }
        (depth(high) > inside).then(|| (bisected(depth, inside, (low, high)), high))
    }

    /// The loop with the edge in ranges of the radius over which δ rises, on loading and on unloading, m.
    fn cycle_within(&self, deepest: f64, stable: &[(f64, f64)], unloaded: &[(f64, f64)]) -> Option<WavyLoop> {
        let (mut up, mut level) = (Vec::new(), 0.0);
        for &(low, high) in stable {
            let end = self.indentation(high).min(deepest);
            if end > level {
                up.push((self.radius_at(level, (low, high)), self.radius_at(end, (low, high))));
                level = end;
            }
        }
        let turn = up.last().filter(|_| level >= deepest)?.1;
        let (mut down, mut level) = (Vec::new(), f64::INFINITY);
        for &(low, high) in unloaded.iter().rev().filter(|(low, _)| *low < turn) {
            if level == f64::INFINITY {
                down.push((low, turn));
            } else if self.indentation(low) < level {
                down.push((low, self.radius_at(level, (low, high))));
            } else {
                continue;
            }
            level = self.indentation(low);
        }
        let work = |rises: &[(f64, f64)]| rises.iter().map(|&rise| self.work(rise)).sum::<f64>();
        let smallest = down.iter().map(|&rise| self.smallest_force(rise)).fold(f64::INFINITY, f64::min);
        Some(WavyLoop {
            contact_radius: turn,
            smallest_force: smallest,
            separation: level,
            dissipated_energy: work(&up) - work(&down),
        })
    }

    /// Stable ranges of the contact radius, over which δ rises, m.
    fn stable(&self, widest: f64) -> Vec<(f64, f64)> {
        let steps = (STEPS_PER_WAVE * (widest / self.wavelength).max(1.0)).ceil() as u32;
        let radius = |k: u32| widest * f64::from(k) / f64::from(steps);
        let at: Vec<f64> = (0..=steps).map(|k| self.indentation(radius(k))).collect();
        let mut ranges = Vec::new();
        let mut low = None;
        for k in 1..steps {
            let (before, here, after) = (at[k as usize - 1], at[k as usize], at[k as usize + 1]);
            let extreme = |sign: f64| {
                let at = |radius: f64| sign * self.indentation(radius);
                golden(at, radius(k - 1), radius(k + 1))
            };
            if here <= before && here < after {
                low = Some(extreme(1.0));
            } else if here >= before
                && here > after
                && let Some(low) = low.take()
            {
                ranges.push((low, extreme(-1.0)));
            }
        }
        ranges.extend(low.map(|low| (low, widest)));
        ranges
    }

    /// Contact radius at an indentation within a range over which δ rises, m.
    fn radius_at(&self, indentation: f64, range: (f64, f64)) -> f64 {
        bisected(|radius| self.indentation(radius), indentation, range)
    }

    /// ∫ F dδ over a range of the radius, J: F δ at its ends minus ∫ δ dF.
    fn work(&self, (low, high): (f64, f64)) -> f64 {
        let steps = 2 * (STEPS_PER_WAVE * ((high - low) / self.wavelength).max(1.0)).ceil() as u32;
        let radius = |k: u32| low + (high - low) * f64::from(k) / f64::from(steps);
        // Three points of each interval determine the slope of δ to the same order as the area by Simpson's rule.
        let at = |k: u32| (self.indentation(radius(k)), self.force(radius(k)));
        let pairs = (0..steps).step_by(2).map(|k| {
            let [(d0, f0), (d1, f1), (d2, f2)] = [at(k), at(k + 1), at(k + 2)];
            let [start, middle, end] = [4.0 * d1 - 3.0 * d0 - d2, d2 - d0, 3.0 * d2 + d0 - 4.0 * d1];
            (f0 * start + 4.0 * f1 * middle + f2 * end) / 6.0
        });
        pairs.sum()
    }

    /// Smallest force over a range of the radius, N.
    fn smallest_force(&self, (low, high): (f64, f64)) -> f64 {
        let steps = (STEPS_PER_WAVE * ((high - low) / self.wavelength).max(1.0)).ceil() as u32;
        let radius = |k: u32| low + (high - low) * f64::from(k.min(steps)) / f64::from(steps);
        let best = (0..=steps).min_by(|&a, &b| self.force(radius(a)).total_cmp(&self.force(radius(b))));
        let best = best.unwrap_or(0);
        let around = golden(|a| self.force(a), radius(best.saturating_sub(1)), radius(best + 1));
        self.force(around).min(self.force(low)).min(self.force(high))
    }
}

/// Place within a range at which a rising function has a value.
fn bisected(of: impl Fn(f64) -> f64, value: f64, (mut low, mut high): (f64, f64)) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *(if of(middle) < value { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Place of the smallest value of a function with one minimum between two numbers, by golden sections.
fn golden(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    for _ in 0..80 {
        let (a, b) = (high - SECTION * (high - low), low + SECTION * (high - low));
        if of(a) < of(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}

const BODY: WavySphere = WavySphere {
    radius: 1.0,
    amplitude: 2.0e-3,
    wavelength: 0.1,
    effective_modulus: 1.0e6,
    work_of_adhesion: 1.0e3,
};

#[test]
fn without_waves_the_body_is_jkr() {
    let sphere = WavySphere { amplitude: 0.0, ..BODY };
    let found = sphere.cycle(0.02, 0.5).unwrap();
    let scale = PI * 1.0e3;
    assert!((found.smallest_force / (-1.5 * scale) - 1.0).abs() < 1e-12, "{found:?}");
    assert!(found.separation < 0.0 && found.dissipated_energy > 0.0);
}

#[test]
fn rule_and_theory_are_one_until_the_line_has_maxima_inside() {
    let smooth = -1.5 * PI * BODY.radius * BODY.work_of_adhesion;
    let steep = [BODY.cycle(0.06, 0.5), BODY.cycle_by_rule(0.06, 0.5)].map(Option::unwrap);
    assert!(!BODY.is_monotone());
    let [jkr, rule] = steep.map(|cycle| cycle.smallest_force / smooth);
    assert!((jkr - 1.556_549).abs() < 1e-6 && (rule - 1.511_869).abs() < 1e-6, "{jkr} {rule}");
    assert!(steep[1].dissipated_energy < steep[0].dissipated_energy);
    let gentle = WavySphere { amplitude: 5.0e-4, ..BODY };
    assert!(gentle.is_monotone());
    assert_eq!(gentle.cycle(0.06, 0.5), gentle.cycle_by_rule(0.06, 0.5));
}

/// Kesari and Lew (2011): waves short against the contact are equivalent to two works of adhesion, and the
/// dissipated energy per area is A√(8πE*γ/λ). The error falls with λ.
#[test]
fn the_loss_per_area_goes_to_that_of_two_works_of_adhesion() {
    let error = |wavelength: f64| {
        // A²E*/(λγ) is constant, and with it both works of adhesion.
        let amplitude = 1.0e-2 * wavelength.sqrt();
        let body = WavySphere { amplitude, wavelength, ..BODY };
        let [inner, outer] = [0.1, 0.4].map(|deepest| body.cycle(deepest, 0.75).unwrap());
        let area = PI * (outer.contact_radius.powi(2) - inner.contact_radius.powi(2));
        let per_area = (outer.dissipated_energy - inner.dissipated_energy) / area;
        let energies = 8.0 * PI * body.effective_modulus * body.work_of_adhesion / wavelength;
        1.0 - per_area / (amplitude * energies.sqrt())
    };
    let errors = [0.02, 0.01, 0.005].map(error);
    let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
    assert!((errors[2] - 0.095).abs() < 0.002, "{errors:?}");
    assert!(0.8 < orders[0] && orders[0] < orders[1] && orders[1] < 1.0, "{orders:?}");
}

/// With F = 2E* ∫ (δ − g) dx from 0 to a, and the edge stretched by g − δ, is dF/da = 2E* (a dδ/da − (g − δ)).
#[test]
fn force_and_indentation_belong_together() {
    for radius in [0.03, 0.1, 0.17, 0.4] {
        let step = 1e-6;
        let slope = |of: &dyn Fn(f64) -> f64| (of(radius + step) - of(radius - step)) / (2.0 * step);
        let (force, indentation) = (slope(&|a| BODY.force(a)), slope(&|a| BODY.indentation(a)));
        let expected = 2.0e6 * (radius * indentation - BODY.stretch(radius));
        assert!((force / expected - 1.0).abs() < 1e-6, "{radius}: {force} for {expected}");
    }
}
