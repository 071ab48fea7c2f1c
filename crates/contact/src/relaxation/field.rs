//! Springs with their memories, and the tension of all springs at one moment.

/// Gap and memory at a position of the profile, which may lie between two springs. The memory is a
/// number that a spring keeps from the moment at which it attached; the module `relaxation` defines
/// it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spring {
    /// Gap in m.
    pub gap: f64,
    /// Memory in m at the moment at which the body turned from loading to unloading.
    pub memory: f64,
}

impl Spring {
    /// Interpolates gap and memory linearly between this position and the position `other`. A
    /// `share` of 0 gives this position, and a `share` of 1 gives `other`.
    #[inline]
    pub fn between(self, other: Spring, share: f64) -> Spring {
        Spring {
            gap: self.gap + share * (other.gap - self.gap),
            memory: self.memory + share * (other.memory - self.memory),
        }
    }
}

/// Those parts of the tension that are the same for all springs at one moment. The tension of a
/// spring is minus its force divided by the instantaneous stiffness of a spring, in m.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Share of the instantaneous modulus that remains after a long time.
    pub remaining: f64,
    /// Factor e^(−t/τ) by which memories have decayed since the body turned.
    pub decay: f64,
    /// Indentation d in m.
    pub indentation: f64,
    /// Common memory J in m, the same number for all springs; the module `relaxation` defines it.
    pub memory: f64,
}

impl Field {
    /// Returns that part of the tension in m at a position of the profile which depends on the gap
    /// and the memory there. The tension is this part minus [`Self::common`].
    #[inline]
    pub fn own_tension(&self, spring: Spring) -> f64 {
        self.remaining * spring.gap - (1.0 - self.remaining) * self.decay * spring.memory
    }

    /// Returns that part of the tension in m which is the same at all positions of the profile.
    #[inline]
    pub fn common(&self) -> f64 {
        self.remaining * self.indentation + (1.0 - self.remaining) * self.memory
    }
}

/// Integrals over the length of a patch. c is the gap and m the memory at the position x, which is
/// in cells.
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
    /// Returns the integrals over a piece of the profile of the length `length` in cells. Gap and
    /// memory are linear functions of the position on this piece.
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
