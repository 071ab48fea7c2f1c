//! A periodic surface is known completely: its equivalent line has its moments.

use crate::draws::Draws;
use asperity_fourier::{Complex64, plan_inverse};
use asperity_surface::{Analysis, AnalysisOptions, Topography, analyse};
use std::f64::consts::{PI, TAU};

/// Periodic map whose spectrum is constant from `first` to `roll_off` and a power law up to `last`;
/// wave numbers in rad/m.
#[derive(Clone, Copy, Debug)]
struct Periodic {
    points: [usize; 2],
    distances: [f64; 2],
    hurst: f64,
    first: f64,
    roll_off: f64,
    last: f64,
    /// True if the amplitudes of the waves are random, and not only their phases.
    random: bool,
}

/// Heights of a map in m, and its rms height, rms gradient and ∫ q C2D d²q/4, as its waves have
/// them.
struct Drawn {
    heights: Vec<f64>,
    moments: [f64; 3],
}

impl Periodic {
    fn draw(&self, seed: u64) -> Drawn {
        let [columns, rows] = self.points;
        let mut draws = Draws::new(seed);
        let steps = [0, 1].map(|axis| TAU / (self.points[axis] as f64 * self.distances[axis]));
        let wave_number = |column: usize, row: usize| {
            let x = column.min(columns - column) as f64 * steps[0];
            x.hypot(row.min(rows - row) as f64 * steps[1])
        };
        let mut waves = vec![Complex64::ZERO; columns * rows];
        for row in 0..rows {
            for column in 0..columns {
                let draw = draws.complex();
                let q = wave_number(column, row);
                if q < self.first.max(1e-9 * self.last) || q > self.last {
                    continue;
                }
                let power = (q / self.roll_off).max(1.0).powf(-2.0 - 2.0 * self.hurst);
                let size = if self.random { 1.0 } else { draw.norm() };
                let (half, mirror) = (row * columns + column, mirror(column, row, self.points));
                if half < mirror {
                    waves[half] = 1e-8 * power.sqrt() / size * draw;
                    waves[mirror] = waves[half].conj();
                }
            }
        }
        let mut squares = [0.0; 3];
        for (index, wave) in waves.iter().enumerate() {
            let q = wave_number(index % columns, index / columns);
            for (sum, factor) in squares.iter_mut().zip([1.0, q * q, q]) {
                *sum += factor * wave.norm_sqr();
            }
        }
        let mut turned = vec![Complex64::ZERO; columns * rows];
        for (row, waves) in waves.chunks_exact_mut(columns).enumerate() {
            plan_inverse(columns).process(waves);
            for (column, value) in waves.iter().enumerate() {
                turned[column * rows + row] = *value;
            }
        }
        plan_inverse(rows).process(&mut turned);
        let heights = (0..columns * rows)
            .map(|index| turned[index % columns * rows + index / columns].re)
            .collect();
        Drawn {
            heights,
            moments: [squares[0].sqrt(), squares[1].sqrt(), 0.25 * squares[2]],
        }
    }
}

/// Returns the index of the wave that runs in the opposite direction.
fn mirror(column: usize, row: usize, [columns, rows]: [usize; 2]) -> usize {
    (rows - row) % rows * columns + (columns - column) % columns
}

fn analysed(surfaces: &[Topography]) -> Analysis {
    let options = AnalysisOptions {
        periodic: true,
        ..AnalysisOptions::default()
    };
    analyse(surfaces, &options).unwrap()
}

fn moments(analysis: &Analysis) -> [f64; 3] {
    let line = &analysis.line;
    [line.rms_height, line.rms_gradient, line.energy_per_modulus].map(|moment| moment.value)
}

/// Calls a function with maps of even and odd numbers of points, with equal and different
/// distances, with and without long waves, and of several Hurst exponents.
fn for_each(mut check: impl FnMut(Periodic, u64)) {
    let mut seed = 0;
    for (points, distances) in [
        ([128, 128], [1e-7; 2]),
        ([127, 129], [1e-7; 2]),
        ([128, 96], [1e-7, 1.5e-7]),
        ([255, 64], [1e-7; 2]),
    ] {
        let step = TAU / (points[0] as f64 * distances[0]);
        let last = 0.8 * PI / f64::max(distances[0], distances[1]);
        for hurst in [0.3, 0.5, 0.8] {
            for (first, roll_off) in [(0.0, 0.5), (0.0, 8.3), (4.0, 4.0), (6.7, 12.0)] {
                for random in [false, true] {
                    seed += 1;
                    let surface = Periodic {
                        points,
                        distances,
                        hurst,
                        first: first * step,
                        roll_off: roll_off * step,
                        last,
                        random,
                    };
                    check(surface, seed);
                }
            }
        }
    }
}

#[test]
fn the_line_of_a_periodic_map_has_the_moments_of_the_map() {
    for_each(|surface, seed| {
        let drawn = surface.draw(seed);
        let map = Topography::from_map(&drawn.heights, surface.points[0], surface.distances);
        let analysis = analysed(&[map.unwrap()]);
        let rms_height = analysis.rms_heights[0];
        assert!((drawn.moments[0] / rms_height - 1.0).abs() < 1e-9);
        for (found, expected) in moments(&analysis).into_iter().zip(drawn.moments) {
            // The shortest waves count as missing if they have 10⁻⁴ of the squared gradient.
            assert!(
                (found / expected - 1.0).abs() < 1e-4,
                "{surface:?}: {found} {expected}"
            );
        }
    });
}

#[test]
fn the_cut_of_the_line_of_a_periodic_profile_is_the_profile() {
    for_each(|surface, seed| {
        let drawn = surface.draw(seed);
        let row = &drawn.heights[..surface.points[0]];
        let analysis = analysed(&[Topography::from_profile(row, surface.distances[0]).unwrap()]);
        let step = TAU / (surface.points[0] as f64 * surface.distances[0]);
        let waves = 1..=(surface.points[0] / 2) as u32;
        let square: f64 = waves
            .map(|wave| analysis.isotropic.cut(f64::from(wave) * step) * step / PI)
            .sum();
        let ratio = square.sqrt() / analysis.rms_heights[0];
        assert!((ratio - 1.0).abs() < 2e-3, "{surface:?}: {ratio}");
    });
}

#[test]
fn several_periodic_maps_have_their_mean_square() {
    let surface = Periodic {
        points: [64, 64],
        distances: [1e-7; 2],
        hurst: 0.8,
        first: 3.0 * TAU / 6.4e-6,
        roll_off: 3.0 * TAU / 6.4e-6,
        last: 20.0 * TAU / 6.4e-6,
        random: true,
    };
    let drawn: Vec<Drawn> = (1..4).map(|seed| surface.draw(seed)).collect();
    let maps: Vec<Topography> = drawn
        .iter()
        .map(|drawn| Topography::from_map(&drawn.heights, 64, surface.distances).unwrap())
        .collect();
    let square: f64 = drawn.iter().map(|drawn| drawn.moments[0].powi(2)).sum();
    let [height, ..] = moments(&analysed(&maps));
    assert!((height / (square / 3.0).sqrt() - 1.0).abs() < 1e-4);
}
