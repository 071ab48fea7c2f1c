//! Springs with memory by brute force: no tree, no prefix sums, no formula of the solver. Each
//! patch is a polygon of gaps and memories that is shortened at its ends or divided.

use super::super::levels::relaxed::Relaxed;
use super::*;

/// Difference of tensions in m that is due to rounding; profiles are about 1 m deep.
const ROUNDING: f64 = 1e-13;

/// A point of the profile in contact.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    /// Position in cells.
    x: f64,
    gap: f64,
    /// Fresh part v of the compression at the end of the loading, minus J at this time, m.
    memory: f64,
}

/// Motion of the body: a loading, a rest and an unloading, all at one speed.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    pub deepest: f64,
    pub dwell: f64,
    pub speed: f64,
    pub share: f64,
    pub time: f64,
}

impl Motion {
    pub fn turn(&self) -> f64 {
        self.deepest / self.speed + self.dwell
    }

    /// J at a time, m.
    fn memory(&self, seconds: f64) -> f64 {
        let loaded = self.deepest / self.speed;
        let steady = self.speed * self.time;
        let rising = |seconds: f64| -steady * (-seconds / self.time).exp_m1();
        if seconds <= loaded {
            return rising(seconds);
        }
        let at_end = rising(loaded);
        if seconds <= self.turn() {
            return at_end * (-(seconds - loaded) / self.time).exp();
        }
        let since = seconds - self.turn();
        at_end * (-(seconds - loaded) / self.time).exp() - rising(since)
    }

    pub fn indentation(&self, seconds: f64) -> f64 {
        let loaded = self.deepest / self.speed;
        if seconds <= loaded {
            self.speed * seconds
        } else if seconds <= self.turn() {
            self.deepest
        } else {
            self.deepest - self.speed * (seconds - self.turn())
        }
    }
}

pub struct Springs<'a> {
    body: &'a Body,
    motion: Motion,
    /// Indentation at which each spring attached, m.
    thresholds: Vec<f64>,
    patches: Vec<Vec<Vertex>>,
    /// Energy that detachment has released, J.
    pub released: f64,
    /// Energy that the dashpots have dissipated, J.
    pub dissipated: f64,
    last: Option<Found>,
}

/// Force and time of one moment.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub seconds: f64,
    pub force: f64,
    /// Stored energy, J.
    pub energy: f64,
    /// Power of the dashpots, W.
    pub power: f64,
}

impl<'a> Springs<'a> {
    pub fn new(body: &'a Body, motion: Motion) -> Self {
        Springs {
            body,
            motion,
            thresholds: vec![f64::INFINITY; body.gaps.len()],
            patches: Vec::new(),
            released: 0.0,
            dissipated: 0.0,
            last: None,
        }
    }

    /// Presses the body to ascending indentations in m, and returns the forces there.
    pub fn press(&mut self, indentations: &[f64]) -> Vec<Found> {
        let mut found = Vec::new();
        let mut relaxed = Relaxed::new(self.body);
        let mut low = 0.0;
        for &d in indentations {
            let before = relaxed.clone();
            relaxed.move_to(d);
            for spring in indices(&relaxed.contacts()) {
                if self.thresholds[spring].is_infinite() {
                    self.thresholds[spring] = attaches(&before, spring, low, d);
                }
            }
            low = d;
            let seconds = d / self.motion.speed;
            self.patches = self.polygons(&relaxed, seconds);
            let here = self.found(seconds);
            self.dissipate(here);
            self.last = Some(here);
            found.push(here);
        }
        found
    }

    /// Patches as polygons, with memories at a time.
    fn polygons(&self, relaxed: &Relaxed<'_>, seconds: f64) -> Vec<Vec<Vertex>> {
        let gaps = &self.body.gaps;
        let d = self.motion.indentation(seconds);
        let memory_of = |gap: f64, threshold: f64| {
            let attached = threshold / self.motion.speed;
            let fresh = threshold - gap - self.motion.memory(attached);
            fresh * (-(seconds - attached) / self.motion.time).exp()
        };
        let mut polygons = Vec::new();
        for (level, from, to) in relaxed.edges() {
            let first = from.ceil().max(0.0) as usize;
            let last = (to.floor() as usize).min(gaps.len() - 1);
            let at = |x: f64, spring: usize| {
                if x == spring as f64 || spring == 0 && x < 0.0 || x > (gaps.len() - 1) as f64 {
                    let memory = memory_of(gaps[spring], self.thresholds[spring]);
                    return Vertex {
                        x,
                        gap: gaps[spring],
                        memory,
                    };
                }
                Vertex {
                    x,
                    gap: level,
                    memory: memory_of(level, d),
                }
            };
            let mut polygon = vec![at(from, first)];
            polygon.extend((first..=last).map(|spring| at(spring as f64, spring)));
            polygon.push(at(to, last));
            polygons.push(polygon);
        }
        polygons.sort_by(|a: &Vec<Vertex>, b| a[0].x.total_cmp(&b[0].x));
        polygons
    }

    /// Factor by which memories have decayed since the end of the loading.
    fn decay(&self, seconds: f64) -> f64 {
        let age = seconds - self.motion.deepest / self.motion.speed;
        (-age.max(0.0) / self.motion.time).exp()
    }

    /// Force and energy at a time, with the patches as they are.
    pub fn found(&self, seconds: f64) -> Found {
        let d = self.motion.indentation(seconds);
        let stiffness = self.body.foundation.spring_stiffness();
        let decay = self.decay(seconds);
        let common = self.motion.memory(seconds);
        let share = self.motion.share;
        let mut force = 0.0;
        let mut energy = 0.0;
        let mut fresh_squares = 0.0;
        for polygon in &self.patches {
            for pair in polygon.windows(2) {
                let length = pair[1].x - pair[0].x;
                let u = [0, 1].map(|end| d - pair[end].gap);
                let v = [0, 1].map(|end| common + decay * pair[end].memory);
                let mean = |of: [f64; 2]| length * 0.5 * (of[0] + of[1]);
                let square =
                    |of: [f64; 2]| length * (of[0] * of[0] + of[0] * of[1] + of[1] * of[1]) / 3.0;
                force += (1.0 - share) * mean(u) + share * mean(v);
                energy += 0.5 * ((1.0 - share) * square(u) + share * square(v));
                fresh_squares += square(v);
            }
        }
        Found {
            seconds,
            force: stiffness * force,
            energy: stiffness * energy,
            power: stiffness * share * fresh_squares / self.motion.time,
        }
    }

    /// Counts the energy that the dashpots dissipate up to a moment.
    fn dissipate(&mut self, found: Found) {
        if let Some(last) = self.last {
            self.dissipated += 0.5 * (last.power + found.power) * (found.seconds - last.seconds);
        }
    }

    /// Lets springs detach at a time after the turn.
    pub fn pull(&mut self, seconds: f64) -> Found {
        let d = self.motion.indentation(seconds);
        let decay = self.decay(seconds);
        let common = self.motion.memory(seconds);
        let share = self.motion.share;
        let tension = move |vertex: &Vertex| {
            (1.0 - share) * (vertex.gap - d) - share * (common + decay * vertex.memory)
        };
        let one = self.body.foundation.largest_stretch(self.body.work, 1);
        let before = self.found(seconds);
        self.dissipate(before);
        let mut waiting = std::mem::take(&mut self.patches);
        while let Some(polygon) = waiting.pop() {
            waiting.extend(self.shortened(polygon, &tension, one));
        }
        self.patches.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        let after = self.found(seconds);
        self.released += before.energy - after.energy;
        self.last = Some(after);
        after
    }

    /// Keeps a patch, shortens it, or returns its parts.
    fn shortened(
        &mut self,
        mut polygon: Vec<Vertex>,
        tension: &impl Fn(&Vertex) -> f64,
        one: f64,
    ) -> Vec<Vec<Vertex>> {
        let length = |polygon: &[Vertex]| polygon[polygon.len() - 1].x - polygon[0].x;
        let of = |polygon: &[Vertex]| {
            polygon
                .iter()
                .map(tension)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        for round in 0.. {
            assert!(round < 100_000, "{top} {polygon:?}", top = of(&polygon));
            if polygon.len() < 2 || length(&polygon) <= 0.0 {
                return Vec::new();
            }
            let top = of(&polygon);
            if top <= one * length(&polygon).sqrt() + ROUNDING {
                self.patches.push(polygon);
                return Vec::new();
            }
            let last = polygon.len() - 1;
            let ends = tension(&polygon[0]).max(tension(&polygon[last]));
            // A vertex inside is as much in tension as an end.
            if let Some(inner) = (1..last)
                .find(|&at| tension(&polygon[at]) >= top - ROUNDING && ends < top - ROUNDING)
            {
                return vec![polygon[..=inner].to_vec(), polygon[inner..].to_vec()];
            }
            // The highest level below, at which a further point counts.
            let inner = (1..last).map(|at| tension(&polygon[at]));
            let others = [tension(&polygon[0]), tension(&polygon[last])];
            let below = inner
                .chain(others)
                .filter(|&level| level < top - ROUNDING)
                .fold(f64::NEG_INFINITY, f64::max);
            let below = below.max(top - 1e3 * (top.abs() + 1.0));
            let holds = |level: f64| {
                let cut = cut_ends(&polygon, tension, level);
                cut.len() > 1 && level <= one * length(&cut).sqrt()
            };
            // Tension minus what the patch bears is convex in the level, down to the next vertex.
            let excess = |level: f64| {
                let cut = cut_ends(&polygon, tension, level);
                if cut.len() > 1 {
                    level - one * length(&cut).sqrt()
                } else {
                    f64::INFINITY
                }
            };
            let [mut low, mut high] = [below, top];
            for _ in 0..40 {
                let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if excess(a) < excess(b) {
                    high = b
                } else {
                    low = a
                }
            }
            let candidates = [below, low, high];
            let least = candidates
                .into_iter()
                .min_by(|&a, &b| excess(a).total_cmp(&excess(b)));
            let least = least.unwrap_or(below);
            let level = if holds(least) {
                let [mut low, mut high] = [least, top];
                for _ in 0..45 {
                    let middle = 0.5 * (low + high);
                    if holds(middle) {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                low
            } else {
                below
            };
            let cut = cut_ends(&polygon, tension, level);
            if cut.len() == polygon.len() && length(&cut) == length(&polygon) {
                // Nothing is left to cut but a vertex at the level itself.
                if polygon.len() <= 2 {
                    return Vec::new();
                }
                if tension(&polygon[0]) >= level - ROUNDING {
                    polygon.remove(0);
                } else {
                    polygon.pop();
                }
                continue;
            }
            polygon = cut;
        }
        Vec::new()
    }
}

/// A polygon without its ends of a larger tension than `level`.
fn cut_ends(polygon: &[Vertex], tension: &impl Fn(&Vertex) -> f64, level: f64) -> Vec<Vertex> {
    let cut_left = |polygon: &[Vertex]| {
        let Some(first) = polygon
            .iter()
            .position(|vertex| tension(vertex) <= level + ROUNDING)
        else {
            return Vec::new();
        };
        let mut rest = polygon[first..].to_vec();
        if first > 0 {
            let [outer, inner] = [polygon[first - 1], polygon[first]];
            let share = (level - tension(&inner)) / (tension(&outer) - tension(&inner));
            let between = |from: f64, to: f64| from + share * (to - from);
            rest.insert(
                0,
                Vertex {
                    x: between(inner.x, outer.x),
                    gap: between(inner.gap, outer.gap),
                    memory: between(inner.memory, outer.memory),
                },
            );
        }
        rest
    };
    let mut rest = cut_left(polygon);
    rest.reverse();
    let mut rest = cut_left(&rest);
    rest.reverse();
    rest
}

/// The indentation at which a spring attaches, by bisection.
fn attaches(before: &Relaxed<'_>, spring: usize, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        let mut body = before.clone();
        body.move_to(middle);
        if indices(&body.contacts()).contains(&spring) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}
