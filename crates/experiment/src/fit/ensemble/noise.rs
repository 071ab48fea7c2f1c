//! Noise that is added to the force of a computed curve, so that it resembles a measured force.

use super::summary::Protocol;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Normally distributed noise of a computed curve. All nodes of the table have the same noise, so
/// that summaries change smoothly with the parameters. The mean of the noise before contact is
/// subtracted, because it is part of the zero offset that is subtracted from a measured curve.
pub(crate) struct Noise {
    generator: ChaCha8Rng,
    /// Standard deviation in N.
    deviation: f64,
    /// Noise in N at the points for which it has been drawn so far.
    values: Vec<f64>,
    /// Mean in N of the noise at the points before contact.
    zero: f64,
    /// Error in N of the measured preload that comes from noise.
    pub of_preload: f64,
}

impl Noise {
    pub fn new(seed: u64, protocol: &Protocol) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let [of_preload, _] = normal_pair(&mut generator);
        let mut noise = Noise {
            generator,
            deviation: protocol.noise,
            values: Vec::new(),
            zero: 0.0,
            of_preload: protocol.preload_error * of_preload,
        };
        let free = protocol.free.max(1);
        let sum: f64 = (0..free).map(|index| noise.at(index)).sum();
        noise.zero = sum / free as f64;
        noise
    }

    /// Returns the noise in N at the point with this index.
    pub fn at(&mut self, index: usize) -> f64 {
        while self.values.len() <= index {
            let pair = normal_pair(&mut self.generator);
            self.values.extend(pair.map(|value| self.deviation * value));
        }
        self.values[index] - self.zero
    }
}

/// Returns two independent values with the standard normal distribution (Box and Muller).
fn normal_pair(generator: &mut ChaCha8Rng) -> [f64; 2] {
    let [for_radius, for_angle]: [f64; 2] = [generator.random(), generator.random()];
    let radius = (-2.0 * (1.0 - for_radius).ln()).sqrt();
    let (sine, cosine) = (std::f64::consts::TAU * for_angle).sin_cos();
    [radius * cosine, radius * sine]
}
