//! Springs under random lines of many kinds, and the engine over them.

#![allow(dead_code, reason = "no test uses all of it")]

use asperity_contact::motion::load_body;
use asperity_contact::{
    self as contact, Contact, ContactBuilder, CurvePoint, Edges, History, Modulus, Move, Patch,
    Profile, StageRecord,
};
use proptest::prelude::*;
use proptest::sample::Index;
use std::f64::consts::PI;

/// Springs on a half-space.
#[derive(Clone, Copy, Debug)]
pub struct Foundation {
    /// Δx, m.
    pub spacing: f64,
    /// E*, Pa.
    pub modulus: f64,
}

impl Foundation {
    pub const fn new(spacing: f64, modulus: f64) -> Self {
        Foundation { spacing, modulus }
    }

    /// E* Δx, N/m.
    pub fn spring_stiffness(&self) -> f64 {
        self.modulus * self.spacing
    }

    /// Largest stretch √(π n Δx γ/E*), m, of a patch of n = `springs` springs under a work of
    /// adhesion γ, J/m²; eq. (10).
    pub fn largest_stretch(&self, work: f64, springs: usize) -> f64 {
        (PI * self.spacing * (work / self.modulus)).sqrt() * (springs as f64).sqrt()
    }

    /// The contact of a line with these gaps (m) for works of adhesion on closing and on opening,
    /// J/m².
    pub fn contact(&self, gaps: &[f64], edges: Edges, works: [f64; 2]) -> Contact {
        self.builder(gaps, edges, works).build().unwrap()
    }

    pub fn builder(&self, gaps: &[f64], edges: Edges, works: [f64; 2]) -> ContactBuilder {
        let profile = Profile::from_gaps(gaps.to_vec(), self.spacing).unwrap();
        let contact = Contact::builder(&profile, Modulus::effective(self.modulus).unwrap());
        contact.edges(edges).works_of_adhesion(works)
    }
}

/// Springs under a rigid line with adhesion.
#[derive(Clone, Debug)]
pub struct Body {
    /// m, the smallest 0.
    pub gaps: Vec<f64>,
    pub edges: Edges,
    pub foundation: Foundation,
    /// γ, J/m².
    pub work: f64,
    /// γ₁ on closing, at most γ, J/m².
    pub closing_work: f64,
}

impl Body {
    /// A body with one work of adhesion, J/m².
    pub fn new(gaps: Vec<f64>, edges: Edges, foundation: Foundation, work: f64) -> Self {
        Body {
            gaps,
            edges,
            foundation,
            work,
            closing_work: work,
        }
    }

    /// The same body with both works of adhesion multiplied by a factor.
    pub fn with_more_adhesion(&self, factor: f64) -> Self {
        Body {
            work: factor * self.work,
            closing_work: factor * self.closing_work,
            ..self.clone()
        }
    }

    pub fn contact(&self) -> Contact {
        self.foundation
            .contact(&self.gaps, self.edges, [self.closing_work, self.work])
    }

    /// The contact under an instrument of this stiffness, N/m.
    pub fn under(&self, stiffness: f64) -> Contact {
        let contact =
            self.foundation
                .builder(&self.gaps, self.edges, [self.closing_work, self.work]);
        contact.loading_stiffness(stiffness).build().unwrap()
    }

    /// The separated body in the exact solver.
    pub fn on(&self, samples: usize) -> contact::motion::Body {
        contact::motion::Body::new(&self.contact(), samples)
    }

    /// The separated body in the exact solver, without adhesion.
    pub fn bare(&self, samples: usize) -> contact::motion::Body {
        contact::motion::Body::new(
            &self.foundation.contact(&self.gaps, self.edges, [0.0; 2]),
            samples,
        )
    }

    pub fn history(&self, targets: &[Move], samples: usize) -> History {
        load_body(&mut self.on(samples), targets, |_, _| Ok(())).unwrap()
    }

    /// Largest gap, m.
    pub fn deepest(&self) -> f64 {
        self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// Largest stretch of a patch as long as the whole line, eq. (10), m.
    pub fn largest_stretch(&self) -> f64 {
        let length = self.gaps.len() as f64 * self.foundation.spacing;
        (PI * length * self.work / self.foundation.modulus).sqrt()
    }

    /// Stiffness of all springs, N/m.
    pub fn stiffness(&self) -> f64 {
        self.gaps.len() as f64 * self.foundation.spring_stiffness()
    }

    /// Order of magnitude of the acting forces, N.
    pub fn force_scale(&self) -> f64 {
        self.stiffness() * (self.deepest() + self.largest_stretch()).max(1e-3)
    }

    /// Largest force at indentations up to 1.3 m, N, and its product with the largest stretch
    /// there.
    pub fn scales(&self) -> [f64; 2] {
        let stretch = 1.3 + self.deepest() + self.largest_stretch();
        [
            self.stiffness() * stretch,
            self.stiffness() * stretch * stretch,
        ]
    }

    /// A drawn target of this body in a solver.
    pub fn target(&self, (target, from_here): Drawn, solver: &contact::motion::Body) -> Move {
        let Move::ToForce(share) = target else {
            return target;
        };
        Move::ToForce(
            share * self.force_scale() + if from_here { solver.point().force } else { 0.0 },
        )
    }

    /// Turning points that cover all states of a body: a first contact, minor loops, below first
    /// touch, full contact and back.
    pub fn tour(&self) -> Vec<Move> {
        let depth = self.deepest() + self.largest_stretch();
        let shares = [
            0.31, 0.123, 0.57, -0.017, 0.71, 0.69, 1.03, 0.43, 0.47, -0.07,
        ];
        let turns = shares
            .iter()
            .map(|share| Move::ToIndentation(share * depth));
        turns.chain([Move::ToSeparation]).collect()
    }
}

/// Gaps from heights of either sign.
pub fn from_lowest(heights: &[f64]) -> Vec<f64> {
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    heights.iter().map(|height| height - lowest).collect()
}

/// Gaps of a random self-affine line about 1 m deep: polygons of ever more pieces with ever smaller
/// heights.
pub fn self_affine(hurst: f64, mut seed: u64, points: usize) -> Vec<f64> {
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut heights = vec![0.0; points];
    let pieces = (0..)
        .map(|power| 1 << power)
        .take_while(|pieces| 4 * pieces <= points);
    for pieces in pieces {
        let corners: Vec<f64> = (0..=pieces)
            .map(|_| 0.6 * random() * (pieces as f64).powf(-hurst))
            .collect();
        for (point, height) in heights.iter_mut().enumerate() {
            let (piece, share) = (point * pieces / points, point * pieces % points);
            *height += corners[piece]
                + (corners[piece + 1] - corners[piece]) * share as f64 / points as f64;
        }
    }
    from_lowest(&heights)
}

/// Gaps about 1 m deep of a line of one of many kinds, of fewer than `most` springs. This strategy
/// and the next ones are boxed, so that the compiler expands them once.
pub fn lines(most: usize) -> BoxedStrategy<Vec<f64>> {
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..most).prop_map(|steps| {
        let rise = |height: &mut f64, step: f64| {
            *height += 0.1 * step;
            Some(*height)
        };
        steps.into_iter().scan(0.0, rise).collect::<Vec<f64>>()
    });
    let noise = prop::collection::vec(0.0..1.0_f64, 1..most);
    let few = prop::collection::vec(0.0..1.0_f64, 1..5);
    let levels = prop::collection::vec(0_u8..6, 1..most).prop_map(|levels| {
        levels
            .iter()
            .map(|&level| 0.25 * f64::from(level))
            .collect()
    });
    let flat_but_one = (1..most, any::<Index>(), -1_i8..=1).prop_map(|(count, at, height)| {
        let mut heights = vec![0.0; count];
        heights[at.index(count)] = f64::from(height);
        heights
    });
    // Of one tread for each spring, or of longer ones: a ramp, stairs, teeth, plateaus.
    let teeth = (1..most, 2..most.max(3), 1_usize..40, 1_i32..3).prop_map(
        |(count, period, treads, power)| {
            let share = |spring: usize| (spring % period * treads / period) as f64 / treads as f64;
            (0..count).map(|spring| share(spring).powi(power)).collect()
        },
    );
    let rough = (0.1..0.9_f64, any::<u64>(), 4..most.max(5))
        .prop_map(|(hurst, seed, points)| self_affine(hurst, seed, points));
    let heights = prop_oneof![
        5 => walk, 3 => noise, 2 => few, 3 => levels, 1 => flat_but_one, 3 => teeth, 2 => rough,
    ];
    (heights, 0..12_u8)
        .prop_map(|(mut heights, kind)| {
            if kind == 0 {
                // With a tie on its other side for each spring.
                heights.truncate(heights.len().div_ceil(2));
                heights.extend_from_within(..);
                let middle = heights.len() / 2;
                heights[middle..].reverse();
            } else if kind < 4 {
                heights.reverse();
            }
            from_lowest(&heights)
        })
        .boxed()
}

/// Bodies about 1 m deep with either kind of edges, from no adhesion to far more than full adhesion
/// needs, with one work of adhesion or with a smaller one on closing.
pub fn bodies(most: usize) -> BoxedStrategy<Body> {
    let power = |powers: std::ops::Range<f64>| powers.prop_map(|power| 10.0_f64.powf(power));
    let range = prop_oneof![8 => power(-5.0..2.0), 1 => power(-32.0..-5.0), 1 => Just(0.0)];
    let closing =
        prop_oneof![4 => Just(1.0), 1 => Just(0.0), 1 => Just(1.0 - 1e-6), 3 => 0.0..1.0_f64];
    let edges = prop_oneof![Just(Edges::Grid), Just(Edges::SubCell)];
    (
        lines(most),
        edges,
        range,
        closing,
        0.003..0.03_f64,
        0.3..3.0_f64,
    )
        .prop_map(|(gaps, edges, range, closing, spacing, modulus)| {
            let work = range * modulus;
            let foundation = Foundation::new(spacing, modulus);
            Body {
                gaps,
                edges,
                foundation,
                work,
                closing_work: closing * work,
            }
        })
        .boxed()
}

/// Bodies whose patches are whole springs.
pub fn whole_springs(most: usize) -> BoxedStrategy<Body> {
    bodies(most)
        .prop_map(|body| Body {
            edges: Edges::Grid,
            ..body
        })
        .boxed()
}

/// Indentations of turning points: some of them repeated, some on a level.
pub fn indentations(most: usize) -> BoxedStrategy<Vec<f64>> {
    let turn =
        prop_oneof![4 => -0.9..1.3_f64, 1 => (-3_i8..6).prop_map(|level| 0.25 * f64::from(level))];
    let turn = (turn, prop::option::weighted(0.2, any::<Index>()));
    prop::collection::vec(turn, 1..most)
        .prop_map(|drawn| {
            let mut turns: Vec<f64> = Vec::new();
            for (turn, again) in drawn {
                turns.push(
                    again
                        .filter(|_| !turns.is_empty())
                        .map_or(turn, |again| *again.get(&turns)),
                );
            }
            turns
        })
        .boxed()
}

/// A target as drawn: a force is a share of those of a body, from the present one on where the flag
/// is set.
pub type Drawn = (Move, bool);

/// Any target, some on a level.
pub fn any_target() -> BoxedStrategy<Drawn> {
    let by = (-4.0..0.0_f64, any::<bool>()).prop_map(|(power, up)| {
        (
            Move::ToForce(if up { 1.0 } else { -1.0 } * 10_f64.powf(power)),
            true,
        )
    });
    let level = (-4_i8..8).prop_map(|level| Move::ToIndentation(0.25 * f64::from(level)));
    let absolute = prop_oneof![
        5 => (-0.9..1.3_f64).prop_map(Move::ToIndentation),
        1 => level,
        3 => (-0.5..1.0_f64).prop_map(Move::ToForce),
        1 => Just(Move::ToTouch),
        1 => Just(Move::ToZeroForce),
        2 => Just(Move::ToSeparation),
    ];
    prop_oneof![4 => absolute.prop_map(|target| (target, false)), 1 => by].boxed()
}

/// Fewer than `most` targets.
pub fn targets(most: usize) -> BoxedStrategy<Vec<Drawn>> {
    prop::collection::vec(any_target(), 1..most).boxed()
}

/// An eighth of this number of cases, times the effort.
pub fn cases(whole: u32) -> ProptestConfig {
    let cases = crate::effort::cases(whole.div_ceil(8));
    ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// End of a stage; separated at d = 0 if the stage has no point.
pub fn end(record: &StageRecord) -> CurvePoint {
    record.curve.last().copied().unwrap_or_default()
}

/// All bits of a point.
pub fn bits(point: &CurvePoint) -> [u64; 6] {
    let CurvePoint {
        indentation,
        force,
        contact_length,
        springs,
        patches,
        stored_energy,
    } = *point;
    let [d, force, length, energy] =
        [indentation, force, contact_length, stored_energy].map(f64::to_bits);
    [d, force, length, energy, springs, patches]
}

pub fn curve_bits(record: &StageRecord) -> Vec<[u64; 6]> {
    record.curve.iter().map(bits).collect()
}

/// Springs of patches.
pub fn indices(patches: &[Patch]) -> Vec<usize> {
    patches.iter().flat_map(|patch| patch.springs()).collect()
}

pub fn to_indentations(indentations: &[f64]) -> Vec<Move> {
    indentations
        .iter()
        .map(|&to| Move::ToIndentation(to))
        .collect()
}
