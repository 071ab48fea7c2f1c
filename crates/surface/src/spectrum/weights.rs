//! Factors for measured powers, with which all parts of a surface have the same weight.

/// Factors by which the powers of a surface are multiplied, one factor for each octave of the wave
/// number (a range up to twice its first wave number).
pub(super) struct EqualWeights {
    /// Wave number in rad/m at which the first octave begins.
    pub first: f64,
    /// Natural logarithm of the factor of each octave.
    pub logarithms: Vec<f64>,
}

impl EqualWeights {
    /// Returns factors of 1, which change no power.
    pub fn none() -> Self {
        EqualWeights {
            first: 1.0,
            logarithms: Vec::new(),
        }
    }

    /// Returns the factor for a wave with this wave number in rad/m. The factor is interpolated
    /// between the middles of the octaves.
    pub fn factor(&self, wave_number: f64) -> f64 {
        let Some(last) = self.logarithms.len().checked_sub(1) else {
            return 1.0;
        };
        let place = ((wave_number / self.first).log2() - 0.5).clamp(0.0, last as f64);
        let below = place as usize;
        let above = (below + 1).min(last);
        let share = place - below as f64;
        ((1.0 - share) * self.logarithms[below] + share * self.logarithms[above]).exp()
    }
}
