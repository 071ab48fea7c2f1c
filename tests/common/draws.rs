//! Random numbers of tests: the same for each seed, whatever the version of a package.

#![allow(dead_code, reason = "each executable of tests uses a part")]

use asperity_fourier::Complex64;

/// Random numbers of a seed: the generator splitmix64.
pub struct Draws(u64);

impl Draws {
    pub fn new(seed: u64) -> Self {
        Draws(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d)
    }

    /// Returns a number of 64 random bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a whole number below `count`, all equally likely.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// Returns a number from 0 to below 1, all equally likely.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a number between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Returns a number between two positive numbers, with an even distribution of its logarithm.
    pub fn by_factor(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.uniform())
    }

    /// Returns a normal number of mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        2.0_f64.sqrt() * self.complex().re
    }

    /// Returns a complex number with independent normal parts of variance ½ (polar method of
    /// Marsaglia).
    pub fn complex(&mut self) -> Complex64 {
        loop {
            let a = self.between(-1.0, 1.0);
            let b = self.between(-1.0, 1.0);
            let square = a * a + b * b;
            if square > 0.0 && square < 1.0 {
                let scale = (-square.ln() / square).sqrt();
                return Complex64::new(scale * a, scale * b);
            }
        }
    }
}
