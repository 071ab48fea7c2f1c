//! Isotropic random surfaces with a known spectrum, on maps and along cuts.

use crate::common::draws::Draws;
use asperity::surface::{ReadOptions, Topography, Unit, parse};
use asperity_fourier::{Complex64, ComplexToReal, plan_inverse, plan_real_inverse};
use std::f64::consts::TAU;
use std::sync::Arc;

/// C2D ∝ 1 below the roll-off and q^(−2−2H) above, up to the last wave; wave numbers in waves per
/// unit length.
pub struct Spectrum {
    pub hurst: f64,
    pub roll_off: f64,
    pub last: f64,
}

impl Spectrum {
    /// Power of a wave of wave number k per area of wave numbers: h² is its integral over the
    /// plane.
    pub fn power(&self, k: f64) -> f64 {
        if k > self.last {
            0.0
        } else {
            1e-6 * (k / self.roll_off).max(1.0).powf(-2.0 - 2.0 * self.hurst)
        }
    }

    /// Rms height, rms gradient and e_el/E* of the equivalent line, of the waves from ½ on.
    pub fn line(&self) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let (low, pieces) = (0.5_f64.ln(), 20_000);
        let step = (self.last.ln() - low) / f64::from(pieces);
        for piece in 0..pieces {
            let k = (low + (f64::from(piece) + 0.5) * step).exp();
            // d²k = 2πk dk.
            let power = self.power(k) * TAU * k * k * step;
            let q = TAU * k;
            for (sum, factor) in sums.iter_mut().zip([1.0, q * q, 0.25 * q]) {
                *sum += factor * power;
            }
        }
        [sums[0].sqrt(), sums[1].sqrt(), sums[2]]
    }
}

/// Map of `points` × `points` on a square of side 1, a quarter of a periodic one, so that it does
/// not repeat.
pub fn map(spectrum: &Spectrum, points: usize, seed: u64) -> Topography {
    let (all, length) = (2 * points, 2.0);
    let mut normal = Draws::new(seed);
    let plan = plan_inverse(all);
    let signed = |index: usize| {
        if 2 * index > all {
            index as f64 - all as f64
        } else {
            index as f64
        }
    };
    let wave = |index: usize| {
        let k = signed(index % all).hypot(signed(index / all)) / length;
        // The real part of a sum of independent waves has half their power.
        let power = if index == 0 {
            0.0
        } else {
            2.0 * spectrum.power(k) / (length * length)
        };
        normal.complex() * power.sqrt()
    };
    let mut waves: Vec<Complex64> = (0..all * all).map(wave).collect();
    plan.process(&mut waves);
    let mut turned: Vec<Complex64> = (0..all * points)
        .map(|index| waves[index % all * all + index / all])
        .collect();
    plan.process(&mut turned);
    let heights = turned
        .chunks_exact(all)
        .flat_map(|row| row[..points].iter().map(|z| z.re));
    topography(&heights.collect::<Vec<_>>(), points)
}

/// Profiles on a length: parts of cuts twice as long, so that they do not repeat.
pub struct Profiles {
    amplitudes: Vec<f64>,
    points: usize,
    length: f64,
    stride: usize,
    transform: Arc<dyn ComplexToReal<f64>>,
}

impl Profiles {
    /// Profiles of this number of points. Waves beyond their Nyquist wave number are sampled at
    /// points, as by an instrument.
    pub fn new(spectrum: &Spectrum, points: usize) -> Self {
        Self::on(1.0, spectrum, points)
    }

    /// The same on a length, m.
    pub fn on(length: f64, spectrum: &Spectrum, points: usize) -> Self {
        let stride = (2.0 * spectrum.last * length / points as f64)
            .ceil()
            .max(1.0) as usize;
        let all = 2 * points * stride;
        let power = |wave: usize| cut(spectrum, 0.5 * wave as f64 / length) / length;
        let amplitudes = (0..=all / 2)
            .map(|wave| (0.5 * power(wave)).sqrt())
            .collect();
        Profiles {
            amplitudes,
            points,
            length,
            stride,
            transform: plan_real_inverse(all),
        }
    }

    /// The profile of a seed.
    pub fn profile(&self, seed: u64) -> Topography {
        let mut normal = Draws::new(seed);
        let mut waves: Vec<Complex64> = self
            .amplitudes
            .iter()
            .map(|a| normal.complex() * a)
            .collect();
        let last = waves.len() - 1;
        waves[0].im = 0.0;
        waves[last].im = 0.0;
        let mut heights = self.transform.make_output_vec();
        self.transform.process(&mut waves, &mut heights).unwrap();
        let sampled: Vec<f64> = heights
            .iter()
            .step_by(self.stride)
            .take(self.points)
            .copied()
            .collect();
        read(&sampled, 0, self.length, &ReadOptions::default())
    }
}

/// Two-sided power of a cut per wave number: the integral over waves across.
pub fn cut(spectrum: &Spectrum, k: f64) -> f64 {
    let most = (spectrum.last.powi(2) - k * k).max(0.0).sqrt();
    // t = e^u − 1 resolves the roll-off.
    let pieces = 2000;
    let step = (1.0 + most).ln() / f64::from(pieces);
    let places = (0..pieces).map(|piece| ((f64::from(piece) + 0.5) * step).exp());
    2.0 * step
        * places
            .map(|growth| spectrum.power(k.hypot(growth - 1.0)) * growth)
            .sum::<f64>()
}

/// The heights as read from a NumPy file: a profile (`columns` of 0) or a map on a length of 1 m.
/// Those that are not a number are interpolated.
pub fn topography(heights: &[f64], columns: usize) -> Topography {
    read(heights, columns, 1.0, &ReadOptions::default())
}

/// The same on a length, m, with further options.
pub fn read(heights: &[f64], columns: usize, length: f64, options: &ReadOptions) -> Topography {
    let points = if columns == 0 { heights.len() } else { columns };
    let rows = heights.len().checked_div(columns);
    let shape = rows.map_or(format!("({points},)"), |rows| {
        format!("({rows}, {columns})")
    });
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let size = (header.len() as u16).to_le_bytes();
    let mut bytes = [b"\x93NUMPY\x01\x00", &size[..], header.as_bytes()].concat();
    bytes.extend(heights.iter().flat_map(|z| z.to_le_bytes()));
    let options = ReadOptions {
        unit: Some(Unit::METRE),
        spacing: Some(length / points as f64),
        interpolate: true,
        ..options.clone()
    };
    parse(&bytes, &options).unwrap()
}
