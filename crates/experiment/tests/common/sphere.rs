//! Curves of a smooth sphere by the closed form of Johnson, Kendall and Roberts, with what measured
//! curves have: partial unloadings, pauses, drag, tilt and noise.

use super::gauss;
use std::f64::consts::PI;

/// Sphere on an instrument. All values are in SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub radius: f64,
    pub work: f64,
    pub modulus: f64,
    pub stiffness: f64,
}

impl Sphere {
    pub(crate) fn pull_off(self) -> f64 {
        1.5 * PI * self.work * self.radius
    }

    /// Returns the largest stretch in m at the edge of a contact of this radius.
    pub(crate) fn stretch(self, contact: f64) -> f64 {
        (2.0 * PI * self.work * contact / self.modulus).sqrt()
    }

    /// Returns displacement of the instrument and force at a contact radius.
    fn state(self, contact: f64) -> [f64; 2] {
        let hertz = 4.0 * self.modulus * contact.powi(3) / (3.0 * self.radius);
        let force = hertz - (8.0 * PI * self.work * self.modulus * contact.powi(3)).sqrt();
        let indentation = contact * contact / self.radius - self.stretch(contact);
        [indentation + force / self.stiffness, force]
    }

    /// Contact radius of zero force.
    fn scale(self) -> f64 {
        let cube = 4.5 * PI * self.work * self.radius * self.radius / self.modulus;
        if cube > 0.0 {
            cube.cbrt()
        } else {
            1e-3 * self.radius
        }
    }

    /// Smallest contact radius that the instrument holds.
    fn smallest(self) -> f64 {
        let mut best = 0.0;
        let mut least = f64::INFINITY;
        for index in 0..20_000 {
            let contact = self.scale() * f64::from(index) / 20_000.0;
            let [displacement, _] = self.state(contact);
            if displacement < least {
                least = displacement;
                best = contact;
            }
        }
        best
    }

    /// Displacement below which the body is separated.
    pub(crate) fn separation(self) -> f64 {
        self.state(self.smallest())[0]
    }

    /// Contact radius at a displacement in contact.
    fn contact(self, displacement: f64) -> f64 {
        let mut low = self.smallest();
        let mut high = low + self.scale();
        while self.state(high)[0] < displacement {
            high *= 2.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.state(middle)[0] < displacement {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Contact radius and displacement at a force of compression.
    pub(crate) fn at_force(self, force: f64) -> [f64; 2] {
        let mut high = self.scale();
        while self.state(high)[1] < force {
            high *= 2.0;
        }
        let mut low = self.smallest();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.state(middle)[1] < force {
                low = middle;
            } else {
                high = middle;
            }
        }
        [high, self.state(high)[0]]
    }

    /// Returns the forces along a path of displacements, which begins without contact.
    pub(crate) fn forces(self, path: &[f64]) -> Vec<f64> {
        let separation = self.separation();
        let mut touches = false;
        let mut forces = Vec::with_capacity(path.len());
        for &displacement in path {
            touches = if touches {
                displacement >= separation
            } else {
                displacement > 0.0
            };
            forces.push(if touches {
                self.state(self.contact(displacement))[1]
            } else {
                0.0
            });
        }
        forces
    }
}

/// Path of the instrument with evenly spaced displacements between turning points.
pub(crate) fn path(turns: &[f64], step: f64) -> Vec<f64> {
    let mut path = vec![turns[0]];
    for pair in turns.windows(2) {
        let count = ((pair[1] - pair[0]).abs() / step).ceil().max(1.0);
        for index in 1..=count as usize {
            path.push(pair[0] + (pair[1] - pair[0]) * index as f64 / count);
        }
    }
    path
}

/// Drag offset + c/(h + h₀) against the motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DragOf {
    pub offset: f64,
    pub coefficient: f64,
    pub reach: f64,
}

/// Adds the drag to forces along a path.
pub(crate) fn add_drag(path: &[f64], forces: &mut [f64], drag: DragOf) {
    let mut sign = 1.0;
    for index in 0..path.len() {
        if index > 0 && path[index] != path[index - 1] {
            sign = (path[index] - path[index - 1]).signum();
        }
        let distance = (-path[index]).max(0.0) + drag.reach;
        forces[index] += sign * (drag.offset + drag.coefficient / distance);
    }
}

/// Adds noise of this standard deviation.
pub(crate) fn add_noise(forces: &mut [f64], deviation: f64, seed: u64) {
    for (part, forces) in forces.chunks_mut(1000).enumerate() {
        let noise = gauss(deviation, 1000 * seed + part as u64);
        for (force, noise) in forces.iter_mut().zip(noise) {
            *force += noise;
        }
    }
}
