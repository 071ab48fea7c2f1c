//! Springs with their memories, and the tension of all springs at one moment.

/// The gap and the memory of a place of the profile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spring {
    /// Gap in m.
    pub gap: f64,
    /// Memory in m, at the moment at which the body turned.
    pub memory: f64,
}

impl Spring {
    /// Returns the place between two places, at the share `share` of the way to `other`.
    #[inline]
    pub fn between(self, other: Spring, share: f64) -> Spring {
        Spring {
            gap: self.gap + share * (other.gap - self.gap),
            memory: self.memory + share * (other.memory - self.memory),
        }
    }
}

/// Part of the force that is the same for all springs at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Share of the modulus that remains after a long time.
    pub remaining: f64,
    /// Factor e^(−t/τ) by which memories have decayed since the body turned.
    pub decay: f64,
    /// Indentation d in m.
    pub indentation: f64,
    /// Common memory J in m.
    pub memory: f64,
}

impl Field {
    /// Returns the tension of a place in m, apart from the term that all places share.
    #[inline]
    pub fn own_tension(&self, spring: Spring) -> f64 {
        self.remaining * spring.gap - (1.0 - self.remaining) * self.decay * spring.memory
    }

    /// Returns the term in m that the tension of each place lacks to its own tension.
    #[inline]
    pub fn common(&self) -> f64 {
        self.remaining * self.indentation + (1.0 - self.remaining) * self.memory
    }
}

/// Integrals over the length of a patch, with lengths in cells.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// Length in cells.
    pub length: f64,
    /// ∫ c dx in cells times m.
    pub gap: f64,
    /// ∫ m dx in cells times m.
    pub memory: f64,
    /// ∫ c² dx in cells times m².
    pub gap_square: f64,
    /// ∫ m² dx in cells times m².
    pub memory_square: f64,
}

impl Sums {
    /// Returns the integrals over a piece of the profile on which gap and memory are straight.
    #[inline]
    pub fn of_piece(from: Spring, to: Spring, length: f64) -> Self {
        let half = 0.5 * length;
        let third = length / 3.0;
        Sums {
            length,
            gap: half * (from.gap + to.gap),
            memory: half * (from.memory + to.memory),
            gap_square: third * mean_square(from.gap, to.gap),
            memory_square: third * mean_square(from.memory, to.memory),
        }
    }

    #[inline]
    pub fn plus(self, other: Sums) -> Self {
        Sums {
            length: self.length + other.length,
            gap: self.gap + other.gap,
            memory: self.memory + other.memory,
            gap_square: self.gap_square + other.gap_square,
            memory_square: self.memory_square + other.memory_square,
        }
    }

    #[inline]
    pub fn minus(self, other: Sums) -> Self {
        Sums {
            length: self.length - other.length,
            gap: self.gap - other.gap,
            memory: self.memory - other.memory,
            gap_square: self.gap_square - other.gap_square,
            memory_square: self.memory_square - other.memory_square,
        }
    }
}

#[inline]
fn mean_square(from: f64, to: f64) -> f64 {
    (from + to) * from + to * to
}
