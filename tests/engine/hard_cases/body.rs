//! Bodies on springs, and the engine over them: the only interface between these tests and the engine.

use asperity::contact::{
    self, Contact, ContactError, CurvePoint, Foundation, HessRule, History, LegRecord, Solver, run,
};
use asperity::scene::{Edges, Form, Move};
use asperity::surface::{Line, SelfAffine, phases};
use std::f64::consts::{PI, TAU};

/// E*, Pa, length, m, and rms height, m, of bodies.
pub const MODULUS: f64 = 2.0e6;
pub const LENGTH: f64 = 1.0e-4;
pub const RMS_HEIGHT: f64 = 1.0e-7;

/// Springs under adhesion: gaps, m, the smallest 0; work of adhesion γ, J/m².
#[derive(Clone, Debug)]
pub struct Body {
    pub gaps: Vec<f64>,
    pub foundation: Foundation,
    pub work: f64,
}

impl Body {
    /// Creates a body from gaps or heights of either sign: the highest point becomes gap 0.
    pub fn below(mut heights: Vec<f64>, length: f64, effective_modulus: f64, work: f64) -> Body {
        let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        heights.iter_mut().for_each(|height| *height = summit - *height);
        let foundation = Foundation::endless(length / heights.len() as f64, effective_modulus);
        Body { gaps: heights, foundation, work }
    }

    pub fn rough(spectrum: SelfAffine, seed: u64, points: usize, work: f64) -> Body {
        let rough = spectrum.heights(seed, points).unwrap();
        let line = Line::new(LENGTH, points, None, Some(&rough), RMS_HEIGHT).unwrap();
        Body { foundation: Foundation::endless(line.spacing, MODULUS), gaps: line.gaps.to_vec(), work }
    }

    /// Creates a body of one of several kinds: self-affine, noise, a few levels, a random walk. The adhesion ranges
    /// from almost none to far more than that of full contact; a seed determines the body everywhere.
    pub fn random(seed: u64) -> Body {
        let mut numbers = phases(seed, 1).map(|phase| phase / TAU);
        let mut next = || numbers.next().unwrap();
        let points = 20 + (300.0 * next()) as usize;
        // γ for which the largest stretch of the whole profile is 1e−3 to 3 rms heights.
        let reach = RMS_HEIGHT * 10.0_f64.powf(-3.0 + 3.5 * next());
        let work = reach * reach * MODULUS / (PI * LENGTH);
        let heights = match seed % 4 {
            0 => {
                let spectrum = SelfAffine { hurst: 0.1 + 0.8 * next(), first: 1, last: points as u64 / 2 };
                return Body::rough(spectrum, seed, points, work);
            }
            1 => (0..points).map(|_| RMS_HEIGHT * next()).collect(),
            2 => (0..points).map(|_| 0.25 * RMS_HEIGHT * (5.0 * next()).floor()).collect(),
            _ => {
                let step = RMS_HEIGHT / (points as f64).sqrt();
                let walk = |height: &mut f64, share: f64| {
                    *height += step * (share - 0.5);
                    Some(*height)
                };
                (0..points).map(|_| next()).scan(0.0, walk).collect()
            }
        };
        Body::below(heights, LENGTH, MODULUS, work)
    }

    pub fn deepest(&self) -> f64 {
        self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// Largest stretch of a patch as long as the whole profile, eq. (10), m.
    pub fn largest_stretch(&self) -> f64 {
        let length = self.gaps.len() as f64 * self.foundation.spacing;
        (PI * length * self.work / self.foundation.effective_modulus).sqrt()
    }

    /// A force of the order of the acting ones, N.
    pub fn force_scale(&self) -> f64 {
        let stiffness = self.gaps.len() as f64 * self.foundation.spring_stiffness();
        stiffness * (self.deepest() + self.largest_stretch())
    }

    /// Calls `act` with a solver over this separated body.
    pub fn with<T>(
        &self,
        edges: Edges,
        samples: usize,
        act: impl FnOnce(&mut dyn Solver) -> Result<T, ContactError>,
    ) -> Result<T, ContactError> {
        let hess = (self.work > 0.0).then(|| HessRule::new(self.foundation, self.work));
        let contact = Contact::new(self.gaps.clone(), edges, self.foundation, hess);
        act(&mut contact::Body::new(&contact, samples))
    }

    pub fn history(&self, edges: Edges, legs: &[Move], samples: usize) -> Result<History, ContactError> {
        self.with(edges, samples, |solver| run(solver, legs, |_, _| Ok(())))
    }

    /// Turning points that cover all states of a body: a first contact, minor loops, below first touch, full contact
    /// and back.
    pub fn tour(&self) -> Vec<Move> {
        let depth = self.deepest() + self.largest_stretch();
        let shares = [0.31, 0.123, 0.57, -0.017, 0.71, 0.69, 1.03, 0.43, 0.47, -0.07];
        let turns = shares.iter().map(|share| Move::ToIndentation(share * depth));
        turns.chain([Move::ToSeparation]).collect()
    }
}

/// End of a loading stage; separated at d = 0 if the stage has no point.
pub fn end(record: &LegRecord) -> CurvePoint {
    record.curve.last().copied().unwrap_or_default()
}

/// The same straight pieces with `factor`, odd, times as many springs.
fn refined(body: &Body, factor: usize) -> Body {
    let count = body.gaps.len();
    let gaps = (0..factor * count).map(|index| {
        let (cell, part) = (index / factor, index % factor);
        let beside = if part < factor / 2 { cell.checked_sub(1) } else { Some(cell + 1) };
        let here = body.gaps[cell];
        // Beyond the first and the last spring the profile is level.
        let there = beside.and_then(|beside| body.gaps.get(beside)).copied().unwrap_or(here);
        here + (there - here) * (part.abs_diff(factor / 2) as f64 / factor as f64)
    });
    let foundation = Foundation { spacing: body.foundation.spacing / factor as f64, ..body.foundation };
    Body { gaps: gaps.collect(), foundation, work: body.work }
}

#[test]
fn more_springs_on_the_same_straight_pieces_change_nothing() {
    for seed in 0..48 {
        let body = Body::random(seed);
        let coarse = body.history(Edges::SubCell, &body.tour(), 17).unwrap();
        for factor in [3, 5] {
            let fine = refined(&body, factor).history(Edges::SubCell, &body.tour(), 17).unwrap();
            for (one, other) in coarse.legs.iter().zip(&fine.legs) {
                let of_end = (end(one).force - end(other).force).abs();
                let error = of_end.max((one.smallest.force - other.smallest.force).abs());
                assert!(error <= 1e-14 * body.force_scale(), "body {seed}, {factor}: {error:e}");
            }
        }
    }
}

#[test]
fn vanishing_adhesion_pulls_no_more_than_its_longest_stretch() {
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: 256 };
    for edges in [Edges::Grid, Edges::SubCell] {
        let force = |work: f64| {
            let body = Body::rough(spectrum, 1, 1024, work);
            let deep = [Move::ToIndentation(0.6 * body.deepest())];
            (end(&body.history(edges, &deep, 2).unwrap().legs[0]).force, body.largest_stretch())
        };
        let without = force(0.0).0;
        for power in [-280, -200, -100, -50, -30, -20, -12, -9, -7, -6, -5, -4, -3] {
            let (with, stretch) = force(10.0_f64.powi(power));
            let most = MODULUS * LENGTH * stretch + 1e-14 * without;
            assert!((-1e-14 * most..=most).contains(&(without - with)), "γ = 1e{power}: {with:e} N");
        }
    }
}

#[test]
fn under_far_loads_the_contact_only_grows() {
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: 128 };
    let sphere = Form::Paraboloid { radius: 1.0e-4 };
    let sphere = Line::new(LENGTH, 257, Some(&sphere), None, 0.0).unwrap().gaps.to_vec();
    for (edges, work) in
        [(Edges::Grid, 0.0), (Edges::Grid, 2e-5), (Edges::SubCell, 0.0), (Edges::SubCell, 2e-5)]
    {
        let rough = Body::rough(spectrum, 1, 257, work);
        for body in [Body { gaps: sphere.clone(), ..rough.clone() }, rough] {
            for power in 0..=30 {
                let far = Move::ToIndentation(10.0_f64.powi(power) * body.deepest());
                let legs =
                    body.history(edges, &[far, Move::ToIndentation(0.5 * body.deepest())], 17).unwrap().legs;
                let force = end(&legs[0]).force;
                let again = body.history(edges, &[Move::ToForce(force)], 17).unwrap().legs;
                for leg in legs.iter().chain(&again) {
                    let mut curve = leg.curve.clone();
                    curve.sort_by(|a, b| a.indentation.total_cmp(&b.indentation));
                    let grows = curve.windows(2).all(|pair| pair[0].contact_length <= pair[1].contact_length);
                    let whole = LENGTH * (1.0 + 2.0 * f64::EPSILON);
                    let inside = curve.iter().all(|point| (0.0..=whole).contains(&point.contact_length));
                    assert!(grows && inside, "{edges:?}, 1e{power} times the depth: {curve:?}");
                }
                let sum: f64 = body.gaps.iter().map(|gap| end(&legs[0]).indentation - gap).sum();
                let expected = body.foundation.spring_stiffness() * sum;
                assert!(
                    (force / expected - 1.0).abs() <= 1e-13,
                    "{edges:?}, 1e{power}: {force:e} {expected:e}"
                );
                assert!((end(&again[0]).force / force - 1.0).abs() <= 1e-14, "{edges:?}, 1e{power}");
            }
        }
    }
}
