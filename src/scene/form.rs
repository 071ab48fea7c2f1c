//! Macroscopic forms of the rigid body.

use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use strum::IntoStaticStr;

/// Macroscopic form of the rigid body; its axis is on the spring ⌊N/2⌋ ([`Form::spring_on_axis`]).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Form {
    /// Paraboloid r²/2R, the sphere of Hertz and JKR.
    Paraboloid {
        /// Radius of curvature R, m.
        radius: f64,
    },
    /// Cone r tan θ.
    Cone {
        /// Angle θ between flank and surface plane, rad.
        angle: f64,
    },
    /// Power law b rⁿ.
    Power {
        /// Coefficient b, m^(1−n).
        coefficient: f64,
        /// Exponent n.
        exponent: f64,
    },
    /// Sphere r²/2R with concentric waves A (1 − cos 2πr/λ).
    WavySphere {
        /// Radius of curvature R, m.
        radius: f64,
        /// Amplitude A of the waves, m; their height is twice that.
        amplitude: f64,
        /// Wavelength λ, m.
        wavelength: f64,
    },
    /// Flat-ended cylinder; nothing outside its radius touches.
    Punch {
        /// Radius a, m.
        radius: f64,
    },
}

impl Form {
    /// Index of the spring on the axis of every form, ⌊N/2⌋ of N = `points` springs. With the axis between two
    /// springs a form would be blunt by half a cell, an error of first order in force, indentation and energy.
    pub fn spring_on_axis(points: u64) -> u64 {
        points / 2
    }

    /// Displacement of the body along the foundation, in cells, that puts its axis from L/2 onto a spring: ½ for an even
    /// number of springs, 0 for an odd one. Form and roughness are displaced together, so that their relative position
    /// does not depend on the number of springs. A punch has no tip and is not displaced.
    pub fn shift(&self, points: u64) -> f64 {
        if points.is_multiple_of(2) && self.flat_end().is_none() { 0.5 } else { 0.0 }
    }

    /// Indices of the springs under the form, of `points` springs on `length` m: all of them, except under a punch.
    /// A punch covers its diameter rounded to whole cells, centred on the axis to half a cell; below half a cell none.
    pub fn springs_under(&self, length: f64, points: u64) -> Range<u64> {
        let Some(radius) = self.flat_end() else { return 0..points };
        let cells = (2.0 * radius / (length / points as f64)).round() as u64;
        let cells = cells.min(points);
        let first = Form::spring_on_axis(points) - cells / 2;
        first..first + cells
    }

    /// Radius of the flat end, m, outside of which there are no springs; `None` for all forms but a punch.
    pub fn flat_end(&self) -> Option<f64> {
        match *self {
            Form::Punch { radius } => Some(radius),
            _ => None,
        }
    }

    /// The form without its waves.
    pub fn without_waves(self) -> Form {
        match self {
            Form::WavySphere { radius, .. } => Form::Paraboloid { radius },
            form => form,
        }
    }

    /// Curvature at the summit, 1/m; `None` for cones and power laws, which have none or none at their tip.
    pub fn summit_curvature(&self) -> Option<f64> {
        match *self {
            Form::Paraboloid { radius } => Some(1.0 / radius),
            Form::WavySphere { radius, amplitude, wavelength } => {
                Some(1.0 / radius + amplitude * (TAU / wavelength).powi(2))
            }
            Form::Punch { .. } => Some(0.0),
            Form::Cone { .. } | Form::Power { .. } => None,
        }
    }

    /// Depth of the surface below its summit at a distance `distance` from the axis, m, with waves as in
    /// [`Form::wave_depth`].
    pub(super) fn depth(&self, distance: f64) -> f64 {
        match *self {
            Form::Paraboloid { radius } => distance * distance / (2.0 * radius),
            Form::Cone { angle } => distance * angle.tan(),
            Form::Power { coefficient, exponent } => coefficient * distance.powf(exponent),
            Form::WavySphere { radius, .. } => {
                distance * distance / (2.0 * radius) + self.wave_depth(distance)
            }
            Form::Punch { .. } => 0.0,
        }
    }

    /// Part of the waves in the depth at a distance from the axis, m: on the profile it grows to about π A √(r/λ).
    pub(super) fn wave_depth(&self, distance: f64) -> f64 {
        match *self {
            Form::WavySphere { amplitude, wavelength, .. } => {
                PI * amplitude * (distance / wavelength).max(1.0).sqrt()
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_punch_covers_the_nearest_number_of_whole_cells() {
        let under = |radius, points| Form::Punch { radius }.springs_under(1.0, points);
        // Whole cells, also numbers that the axis cannot halve.
        assert_eq!((under(0.2, 10), under(0.25, 10), under(0.3, 10)), (3..7, 3..8, 2..8));
        assert_eq!((under(0.2, 5), under(0.3, 5)), (1..3, 1..4));
        // The minimum is a quarter of a cell on either side of the axis.
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
}
