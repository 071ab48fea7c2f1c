//! Random loops on random profiles, made of sums, products, quotients and square roots alone: the same bits on every
//! machine.

use asperity::scene::Leg;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::array::from_fn;

/// One loading history of one profile.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Gaps, m, the smallest 0.
    pub gaps: Vec<f64>,
    /// Distance between springs, m.
    pub spacing: f64,
    /// Effective modulus, Pa.
    pub modulus: f64,
    /// Work of adhesion, J/m².
    pub work: f64,
    /// True for edges between springs.
    pub sub_cell: bool,
    /// Samples of each curve.
    pub samples: usize,
    pub legs: Vec<Leg>,
}

/// Terms of the series of sine and cosine.
const TERMS: u32 = 24;

struct Dice(ChaCha8Rng);

impl Dice {
    /// From 0 up to 1.
    fn fraction(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    fn below(&mut self, count: u64) -> u64 {
        self.0.next_u64() % count
    }

    /// A number of any magnitude between two powers of two.
    fn of_magnitude(&mut self, least: i32, most: i32) -> f64 {
        let exponent = least + self.below((most - least) as u64) as i32;
        self.between(1.0, 2.0) * power_of_two(exponent)
    }

    /// Cosine and sine of a random phase.
    fn direction(&mut self) -> [f64; 2] {
        loop {
            let [x, y] = from_fn(|_| self.between(-1.0, 1.0));
            let square = x * x + y * y;
            if (0.01..1.0).contains(&square) {
                return [x / square.sqrt(), y / square.sqrt()];
            }
        }
    }
}

impl Loop {
    /// True for the number of a loop with edges between springs.
    pub fn is_sub_cell(number: u64) -> bool {
        number % 2 == 1
    }

    /// The loop of this number.
    pub fn new(number: u64) -> Self {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(number));
        let most = if dice.below(4) == 0 { 985 } else { 240 };
        let springs = 16 + dice.below(most) as usize;
        let spacing = dice.of_magnitude(-30, -10);
        let modulus = dice.of_magnitude(10, 40);
        let gaps = gaps(&mut dice, springs, spacing);
        let deepest = gaps.iter().copied().fold(0.0, f64::max);
        // Stretch of a single spring against the largest gap: from next to nothing to far beyond full adhesion.
        let stretch = if dice.below(16) == 0 { 0.0 } else { deepest * dice.of_magnitude(-24, 5) };
        let work = stretch * stretch / spacing * modulus / 3.0;
        let depth = deepest * dice.of_magnitude(-6, 2);
        let force = modulus * spacing * springs as f64 * depth;
        let count = dice.below(8);
        let mut legs: Vec<Leg> = (0..count).map(|_| leg(&mut dice, depth, force)).collect();
        legs.push(Leg::ToSeparation);
        let samples = 2 + dice.below(24) as usize;
        Loop { gaps, spacing, modulus, work, sub_cell: Loop::is_sub_cell(number), samples, legs }
    }
}

fn leg(dice: &mut Dice, depth: f64, force: f64) -> Leg {
    match dice.below(8) {
        0 => Leg::ToTouch,
        1 => Leg::ToZeroForce,
        2 => Leg::ToSeparation,
        3 => Leg::ToIndentation(depth * dice.between(-1.0, 0.0)),
        4 | 5 => Leg::ToIndentation(depth * dice.fraction()),
        6 => Leg::ToForce(force * dice.fraction()),
        _ => Leg::ToForce(-force * dice.of_magnitude(-12, -1)),
    }
}

/// Gaps of a self-affine profile of modes up to N/2, N/4 or N/8, on a form in three of ten cases, and with few distinct
/// heights in one of three.
fn gaps(dice: &mut Dice, springs: usize, spacing: f64) -> Vec<f64> {
    let last = (springs >> (1 + dice.below(3))).max(1);
    let first = 1 + dice.below(4.min(last as u64)) as usize;
    // H from 3/32 to 29/32.
    let hurst = 3 + dice.below(27) as u32;
    let roots = roots_of_unity(springs);
    let mut heights = vec![0.0; springs];
    for mode in first..=last {
        let amplitude = thirty_second_power(mode as f64, hurst + 16).recip();
        let [cosine, sine] = dice.direction();
        let mut angle = 0;
        for height in &mut heights {
            let [real, imaginary] = roots[angle];
            *height += amplitude * (cosine * real - sine * imaginary);
            angle += mode;
            angle -= if angle >= springs { springs } else { 0 };
        }
    }
    let scale = spacing * dice.of_magnitude(-8, 4);
    let bend = dice.between(0.0, 8.0);
    let kind = dice.below(10);
    for (index, height) in heights.iter_mut().enumerate() {
        let place = (index as f64 - (springs / 2) as f64) / springs as f64;
        let depth = match kind {
            0 => place.abs(),
            1 | 2 => place * place,
            _ => 0.0,
        };
        *height = scale * (*height - bend * depth);
    }
    let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let gaps = heights.iter().map(|height| summit - height);
    match [4096.0, 40.0, 5.0].get(dice.below(9) as usize) {
        None => gaps.collect(),
        Some(levels) => {
            let deepest = gaps.clone().fold(0.0, f64::max);
            gaps.map(|gap| (gap / deepest * levels).floor() * (deepest / levels)).collect()
        }
    }
}

/// Cosine and sine of all multiples of 2π/`count`.
fn roots_of_unity(count: usize) -> Vec<[f64; 2]> {
    let angle = std::f64::consts::TAU / count as f64;
    let (mut first, mut term) = ([1.0, 0.0], 1.0);
    for order in 1..TERMS {
        term *= angle / f64::from(order);
        let sign = if order % 4 < 2 { 1.0 } else { -1.0 };
        first[order as usize % 2] += sign * term;
    }
    let mut root = [1.0, 0.0];
    (0..count)
        .map(|_| {
            let [real, imaginary] = root;
            root = [real * first[0] - imaginary * first[1], real * first[1] + imaginary * first[0]];
            [real, imaginary]
        })
        .collect()
}

/// Power of a number with an exponent in thirty-seconds, fewer than 64 of them.
fn thirty_second_power(base: f64, thirty_seconds: u32) -> f64 {
    let mut root = base;
    let mut power = if thirty_seconds & 32 > 0 { base } else { 1.0 };
    for bit in (0..5).rev() {
        root = root.sqrt();
        if thirty_seconds >> bit & 1 > 0 {
            power *= root;
        }
    }
    power
}

fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}
