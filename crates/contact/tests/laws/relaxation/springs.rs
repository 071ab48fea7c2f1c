//! Springs with memory by brute force: no tree, no prefix sums, no formula of the solver. Each
//! patch is a polygon of gaps and memories that is shortened at its ends or divided.

use super::climb::Climbs;
use super::*;

/// Difference of tensions in m that is due to rounding; profiles are about 1 m deep.
const ROUNDING: f64 = 1e-13;
/// Share of the largest force that detaches in one step at most; a step with more is divided.
const LOST: f64 = 2e-3;
/// Number of times that a step is halved where the force jumps.
const HALVINGS: u32 = 12;

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
    climbs: Climbs,
    patches: Vec<Vec<Vertex>>,
    /// Energy that detachment has released, J.
    pub released: f64,
    /// Energy that the dashpots have dissipated, J.
    pub dissipated: f64,
    last: Option<Found>,
    /// Largest force so far, N.
    largest: f64,
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
            climbs: Climbs::new(body),
            patches: Vec::new(),
            released: 0.0,
            dissipated: 0.0,
            last: None,
            largest: 0.0,
        }
    }

    /// Presses the body to ascending indentations in m, and returns the forces there.
    pub fn press(&mut self, indentations: &[f64]) -> Vec<Found> {
        let mut found = Vec::new();
        for &d in indentations {
            let seconds = d / self.motion.speed;
            self.patches = self.polygons(d, seconds);
            let here = self.found(&self.patches, seconds);
            if let Some(last) = self.last {
                self.dissipated += 0.5 * (last.power + here.power) * (seconds - last.seconds);
            }
            self.remember(here);
            found.push(here);
        }
        found
    }

    fn remember(&mut self, found: Found) {
        self.largest = self.largest.max(found.force.abs());
        self.last = Some(found);
    }

    /// Patches on the approach as polygons, with memories at a time.
    fn polygons(&self, d: f64, seconds: f64) -> Vec<Vec<Vertex>> {
        let gaps = &self.body.gaps;
        let memory_of = |gap: f64, threshold: f64| {
            let attached = threshold / self.motion.speed;
            let fresh = threshold - gap - self.motion.memory(attached);
            fresh * (-(seconds - attached) / self.motion.time).exp()
        };
        let vertex = |x: f64, gap: f64, threshold: f64| Vertex {
            x,
            gap,
            memory: memory_of(gap, threshold),
        };
        let mut polygons = Vec::new();
        for part in self.climbs.parts(d) {
            let spring = |spring: usize| {
                let threshold = self.climbs.thresholds[spring];
                vertex(spring as f64, gaps[spring], threshold)
            };
            let edge = |x: f64, inside: usize, is_end: bool| {
                if is_end {
                    Vertex {
                        x,
                        ..spring(inside)
                    }
                } else {
                    vertex(x, part.level, d)
                }
            };
            let mut polygon = vec![edge(part.from, part.first, part.first == 0)];
            polygon.extend((part.first..=part.last).map(spring));
            polygon.push(edge(part.to, part.last, part.last + 1 == gaps.len()));
            polygons.push(polygon);
        }
        polygons
    }

    /// Factor by which memories have decayed since the end of the loading.
    fn decay(&self, seconds: f64) -> f64 {
        let age = seconds - self.motion.deepest / self.motion.speed;
        (-age.max(0.0) / self.motion.time).exp()
    }

    /// Force and energy of patches at a time.
    fn found(&self, patches: &[Vec<Vertex>], seconds: f64) -> Found {
        let d = self.motion.indentation(seconds);
        let stiffness = self.body.foundation.spring_stiffness();
        let decay = self.decay(seconds);
        let common = self.motion.memory(seconds);
        let share = self.motion.share;
        let mut force = 0.0;
        let mut energy = 0.0;
        let mut fresh_squares = 0.0;
        for polygon in patches {
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

    /// Lets springs detach up to a time after the end of the loading, and adds the forces on the
    /// way to `found`. A step in which much of the force detaches is halved, so that jumps are
    /// located.
    pub fn pull(&mut self, seconds: f64, found: &mut Vec<Found>) {
        if let Some(last) = self.last {
            self.pull_or_divide(last.seconds, seconds, HALVINGS, found);
        }
    }

    fn pull_or_divide(&mut self, from: f64, to: f64, halvings: u32, found: &mut Vec<Found>) {
        let before = self.patches.clone();
        self.detach(to);
        let with = [from, to].map(|seconds| self.found(&before, seconds));
        let without = [from, to].map(|seconds| self.found(&self.patches, seconds));
        let lost = (with[1].force - without[1].force).abs();
        if lost > LOST * self.largest && halvings > 0 {
            self.patches = before;
            let middle = 0.5 * (from + to);
            self.pull_or_divide(from, middle, halvings - 1, found);
            self.pull_or_divide(middle, to, halvings - 1, found);
            return;
        }
        // Each spring detaches at some time between the two.
        let released = [0, 1].map(|end| with[end].energy - without[end].energy);
        self.released += 0.5 * (released[0] + released[1]);
        self.dissipated += 0.5 * (with[0].power + without[1].power) * (to - from);
        self.remember(without[1]);
        found.push(without[1]);
    }

    /// Lets springs detach at a time.
    fn detach(&mut self, seconds: f64) {
        let d = self.motion.indentation(seconds);
        let decay = self.decay(seconds);
        let common = self.motion.memory(seconds);
        let share = self.motion.share;
        let tension = move |vertex: &Vertex| {
            (1.0 - share) * (vertex.gap - d) - share * (common + decay * vertex.memory)
        };
        let one = self.body.foundation.largest_stretch(self.body.work, 1);
        let mut waiting = std::mem::take(&mut self.patches);
        while let Some(polygon) = waiting.pop() {
            waiting.extend(self.shortened(polygon, &tension, one));
        }
        self.patches.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
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
            // Tension minus what the patch bears is convex in the level, down to the next vertex.
            let excess = |level: f64| {
                let [from, to] = ends_at(&polygon, tension, level);
                if from < to {
                    level - one * (to - from).sqrt()
                } else {
                    f64::INFINITY
                }
            };
            let holds = |level: f64| excess(level) <= 0.0;
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

/// The ends, in cells, of a polygon without its ends of a larger tension than `level`.
fn ends_at(polygon: &[Vertex], tension: &impl Fn(&Vertex) -> f64, level: f64) -> [f64; 2] {
    let end = |polygon: &mut dyn Iterator<Item = &Vertex>| {
        let mut outer: Option<&Vertex> = None;
        for vertex in polygon {
            if tension(vertex) <= level + ROUNDING {
                return outer.map_or(vertex.x, |outer| between(vertex, outer, tension, level).x);
            }
            outer = Some(vertex);
        }
        f64::NAN
    };
    [end(&mut polygon.iter()), end(&mut polygon.iter().rev())]
}

/// The place between two vertices at which the tension is `level`.
fn between(
    inner: &Vertex,
    outer: &Vertex,
    tension: &impl Fn(&Vertex) -> f64,
    level: f64,
) -> Vertex {
    let share = (level - tension(inner)) / (tension(outer) - tension(inner));
    let between = |from: f64, to: f64| from + share * (to - from);
    Vertex {
        x: between(inner.x, outer.x),
        gap: between(inner.gap, outer.gap),
        memory: between(inner.memory, outer.memory),
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
            rest.insert(
                0,
                between(&polygon[first], &polygon[first - 1], tension, level),
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
