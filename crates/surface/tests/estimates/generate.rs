//! Random surfaces with a known spectrum, and surfaces that are not uniform, drawn by a seed.

use crate::draws::Draws;
use asperity_fourier::{Complex64, plan_inverse};
use asperity_surface::Topography;

/// Spectrum of an isotropic surface: constant below a roll-off and a power law above. Wave numbers
/// are in waves on the side of a map.
#[derive(Clone, Copy, Debug)]
pub struct Spectrum {
    pub hurst: f64,
    pub roll_off: f64,
    pub last: f64,
}

impl Spectrum {
    /// Returns the power of a wave up to a constant factor.
    pub fn power(&self, k: f64) -> f64 {
        if k > self.last || k == 0.0 {
            0.0
        } else {
            (k / self.roll_off).max(1.0).powf(-2.0 - 2.0 * self.hurst)
        }
    }
}

/// Square map on a side of 1.
#[derive(Clone, Debug)]
pub struct Map {
    pub points: usize,
    pub heights: Vec<f64>,
}

impl Map {
    /// Makes a random map with a spectrum and an rms height of 1, a quarter of a periodic map, so
    /// that it does not repeat itself.
    pub fn random(points: usize, spectrum: &Spectrum, seed: u64) -> Map {
        let all = 2 * points;
        let mut draws = Draws::new(seed);
        let mut waves = Vec::with_capacity(all * all);
        for index in 0..all * all {
            let x = signed(index % all, all);
            let y = signed(index / all, all);
            let power = spectrum.power(0.5 * x.hypot(y));
            waves.push(draws.complex() * power.sqrt());
        }
        let plan = plan_inverse(all);
        plan.process(&mut waves);
        let mut turned = Vec::with_capacity(all * points);
        for index in 0..all * points {
            turned.push(waves[index % all * all + index / all]);
        }
        plan.process(&mut turned);
        let mut heights = Vec::with_capacity(points * points);
        for row in turned.chunks_exact(all) {
            heights.extend(row[..points].iter().map(|z| z.re));
        }
        let mut map = Map { points, heights };
        map.normalise();
        map
    }

    /// Subtracts the mean and divides by the rms height.
    pub fn normalise(&mut self) {
        let count = self.heights.len() as f64;
        let mean = self.heights.iter().sum::<f64>() / count;
        let square = self.heights.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / count;
        for z in &mut self.heights {
            *z = (*z - mean) / square.sqrt();
        }
    }

    /// Calls a function with each height and its place on the sides, from 0 to 1.
    pub fn change(&mut self, mut height: impl FnMut(f64, f64, f64) -> f64) {
        let points = self.points;
        for (index, z) in self.heights.iter_mut().enumerate() {
            let x = (index % points) as f64 / points as f64;
            let y = (index / points) as f64 / points as f64;
            *z = height(*z, x, y);
        }
    }

    /// Returns the part of a map between two columns and two rows, with heights in nm on a side of
    /// 10 µm.
    pub fn part(&self, columns: [usize; 2], rows: [usize; 2]) -> Topography {
        let mut heights = Vec::new();
        for row in rows[0]..rows[1] {
            let begin = row * self.points;
            let part = &self.heights[begin + columns[0]..begin + columns[1]];
            heights.extend(part.iter().map(|z| 5e-9 * z));
        }
        let spacing = 1e-5 / self.points as f64;
        Topography::from_map(&heights, columns[1] - columns[0], [spacing; 2]).unwrap()
    }

    pub fn whole(&self) -> Topography {
        self.part([0, self.points], [0, self.points])
    }

    /// Returns the two halves along each of both axes.
    pub fn halves(&self) -> [[Topography; 2]; 2] {
        let all = [0, self.points];
        let first = [0, self.points / 2];
        let second = [self.points / 2, self.points];
        [
            [self.part(first, all), self.part(second, all)],
            [self.part(all, first), self.part(all, second)],
        ]
    }
}

fn signed(index: usize, all: usize) -> f64 {
    if 2 * index > all {
        index as f64 - all as f64
    } else {
        index as f64
    }
}

/// Kinds of maps that no spectrum describes alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One normal surface: the control.
    Normal,
    /// Roughness whose amplitude varies over the map.
    Uneven,
    /// Patches, each with a tilt, an offset and a roughness of its own.
    Tilted,
    /// Summits worn off to a level that varies a little, with fine roughness on the plateaus.
    Worn,
    /// Two phases of different roughness and height.
    TwoPhase,
    /// Particles of several sizes on a fine ground, in places crowded.
    Particles,
}

impl Kind {
    pub const UNEVEN: [Kind; 5] = [
        Kind::Uneven,
        Kind::Tilted,
        Kind::Worn,
        Kind::TwoPhase,
        Kind::Particles,
    ];

    /// Draws a map of this kind.
    pub fn draw(self, points: usize, seed: u64) -> Map {
        let number = self as u64 + 10 * seed;
        let mut draws = Draws::new(1_000_003 * number);
        let base = Spectrum {
            hurst: draws.between(0.4, 0.9),
            roll_off: draws.by_factor(4.0, 20.0),
            last: points as f64 * draws.by_factor(0.2, 0.6),
        };
        let ground = Map::random(points, &base, 7919 * number + 1);
        // Smooth field of mean 0 and variance 1, whose longest waves are some parts of the side.
        let spectrum = Spectrum {
            hurst: 1.5,
            roll_off: draws.by_factor(1.0, 8.0),
            last: 40.0,
        };
        let field = Map::random(points, &spectrum, 7919 * number + 2);
        match self {
            Kind::Normal => ground,
            Kind::Uneven => uneven(ground, &field, &mut draws),
            Kind::Tilted => tilted(ground, &mut draws),
            Kind::Worn => worn(ground, &field, &mut draws, number),
            Kind::TwoPhase => two_phase(ground, &field, &mut draws, number),
            Kind::Particles => particles(ground, &field, &mut draws),
        }
    }
}

fn uneven(mut ground: Map, field: &Map, draws: &mut Draws) -> Map {
    let strength = draws.between(0.1, 0.5);
    for (z, level) in ground.heights.iter_mut().zip(&field.heights) {
        *z *= (strength * level).exp();
    }
    ground
}

fn tilted(mut ground: Map, draws: &mut Draws) -> Map {
    struct Patch {
        place: [f64; 2],
        tilt: [f64; 2],
        offset: f64,
        roughness: f64,
    }
    let count = draws.by_factor(8.0, 120.0) as usize;
    let steepness = draws.between(2.0, 8.0);
    let mut patches = Vec::new();
    for _ in 0..count {
        patches.push(Patch {
            place: [draws.uniform(), draws.uniform()],
            tilt: [
                steepness * draws.complex().re,
                steepness * draws.complex().re,
            ],
            offset: draws.complex().re,
            roughness: draws.by_factor(0.1, 0.4),
        });
    }
    ground.change(|z, x, y| {
        let square = |patch: &Patch| (patch.place[0] - x).powi(2) + (patch.place[1] - y).powi(2);
        let nearest = patches
            .iter()
            .min_by(|a, b| square(a).total_cmp(&square(b)))
            .unwrap();
        let [x_tilt, y_tilt] = nearest.tilt;
        let plane = x_tilt * (x - nearest.place[0]) + y_tilt * (y - nearest.place[1]);
        nearest.offset + plane + nearest.roughness * z
    });
    ground
}

fn worn(mut ground: Map, field: &Map, draws: &mut Draws, number: u64) -> Map {
    let level = draws.between(-0.3, 1.0);
    let waviness = draws.between(0.1, 0.5);
    let fine = Spectrum {
        hurst: 0.6,
        roll_off: 20.0,
        last: 0.4 * ground.points as f64,
    };
    let fine = Map::random(ground.points, &fine, 7919 * number + 3);
    let roughness = draws.by_factor(0.01, 0.1);
    for (index, z) in ground.heights.iter_mut().enumerate() {
        let plateau = level + waviness * field.heights[index] + roughness * fine.heights[index];
        *z = z.min(plateau);
    }
    ground
}

fn two_phase(mut ground: Map, field: &Map, draws: &mut Draws, number: u64) -> Map {
    let level = draws.between(-0.8, 0.8);
    let step = draws.between(0.0, 2.0);
    let other = Spectrum {
        hurst: draws.between(0.3, 0.9),
        roll_off: draws.by_factor(4.0, 30.0),
        last: 0.4 * ground.points as f64,
    };
    let other = Map::random(ground.points, &other, 7919 * number + 3);
    let roughness = draws.by_factor(0.1, 0.7);
    for (index, z) in ground.heights.iter_mut().enumerate() {
        // The border of a phase is some points wide.
        let share = 0.5 + 0.5 * ((field.heights[index] - level) / 0.05).tanh();
        *z = share * (*z + step) + (1.0 - share) * roughness * other.heights[index];
    }
    ground
}

fn particles(mut ground: Map, field: &Map, draws: &mut Draws) -> Map {
    let points = ground.points;
    let count = draws.by_factor(30.0, 600.0) as usize;
    let mean_radius = draws.between(0.01, 0.03);
    let crowded = draws.between(0.0, 0.6);
    let roughness = draws.by_factor(0.02, 0.2);
    for z in &mut ground.heights {
        *z *= roughness;
    }
    for _ in 0..count {
        let place = loop {
            let x = draws.uniform();
            let y = draws.uniform();
            let index = (y * points as f64) as usize * points + (x * points as f64) as usize;
            if draws.uniform() < (crowded * (field.heights[index] - 2.0)).exp() {
                break [x, y];
            }
        };
        let radius = mean_radius * (0.3 * draws.complex().re).exp();
        let height = 2.0 * radius / mean_radius;
        add_particle(&mut ground, place, radius, height);
    }
    ground
}

/// Raises the points of a map to the cap of a particle, from whose top the cap falls by its height
/// to its border.
fn add_particle(map: &mut Map, place: [f64; 2], radius: f64, height: f64) {
    let points = map.points as f64;
    let range = |place: f64| {
        let low = ((place - radius) * points).max(0.0) as usize;
        let high = ((place + radius) * points).min(points - 1.0) as usize;
        low..=high
    };
    for row in range(place[1]) {
        for column in range(place[0]) {
            let x = column as f64 / points - place[0];
            let y = row as f64 / points - place[1];
            let square = (x * x + y * y) / (radius * radius);
            if square < 1.0 {
                let z = &mut map.heights[row * map.points + column];
                *z = z.max(height * (1.0 - square));
            }
        }
    }
}

impl Map {
    /// Samples the map at points at a multiple of the distance of its points.
    pub fn every(&self, step: usize) -> Map {
        let points = self.points / step;
        let mut heights = Vec::with_capacity(points * points);
        for row in 0..points {
            for column in 0..points {
                heights.push(self.heights[step * (row * self.points + column)]);
            }
        }
        Map { points, heights }
    }
}

/// Profile on a length of 1.
pub struct Profile {
    heights: Vec<f64>,
}

impl Profile {
    /// Makes a random profile whose own spectrum is a power law, half of a periodic one.
    pub fn random(points: usize, spectrum: &Spectrum, seed: u64) -> Profile {
        let all = 2 * points;
        let mut draws = Draws::new(seed);
        let mut waves = vec![Complex64::ZERO; all];
        for (wave, value) in waves.iter_mut().enumerate().take(points).skip(1) {
            let k = 0.5 * wave as f64;
            // A cut of an isotropic surface has a power law with an exponent smaller by one.
            let power = spectrum.power(k) * k.max(spectrum.roll_off);
            *value = draws.complex() * power.sqrt();
        }
        plan_inverse(all).process(&mut waves);
        let heights = waves[..points].iter().map(|z| z.re);
        Profile {
            heights: heights.collect(),
        }
    }

    /// Samples the profile at points at a multiple of the distance of its points.
    pub fn every(&self, step: usize) -> Topography {
        let scale = 5e-9
            / (self.heights.iter().map(|z| z * z).sum::<f64>() / self.heights.len() as f64).sqrt();
        let heights: Vec<f64> = self
            .heights
            .iter()
            .step_by(step)
            .map(|z| scale * z)
            .collect();
        Topography::from_profile(&heights, 1e-4 / heights.len() as f64).unwrap()
    }
}
