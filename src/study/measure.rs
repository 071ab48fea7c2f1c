//! One run on one line: what it gives in each of its cells.

use super::plan::{Plan, StiffnessRange};
use super::quantity::{Needs, Quantity};
use crate::analysis::{Figures, Governing, Regime};
use crate::contact::{Direction, History, LegRecord};
use crate::scene::{Leg, Roughness, Scene};
use crate::simulation::{Outcome, RunError, Simulation};
use crate::study::HeightShape;
use crate::surface::MeasuredRoughness;
use std::path::PathBuf;
use std::sync::Arc;

/// Curve samples on a leg: what is recorded stands at its ends, and extremes are exact without more.
const SAMPLES: u64 = 2;

/// Measures one run after the other, and keeps the line, its tree and what depends on the line alone.
pub(super) struct Measurer<'p> {
    plan: &'p Plan,
    simulation: Simulation,
    of_line: Option<(LineKey, OfLine)>,
}

/// What the line depends on, and the elasticity that scales forces on it.
#[derive(PartialEq)]
struct LineKey {
    scene: Scene,
}

/// What depends on the line alone.
#[derive(Clone, Copy, Default)]
struct OfLine {
    heights: Option<Heights>,
    exponents: Option<Exponents>,
}

#[derive(Clone, Copy)]
struct Heights {
    rms: f64,
    shape: Option<HeightShape>,
    summit: f64,
}

#[derive(Clone, Copy)]
struct Exponents {
    stiffness: f64,
    force: f64,
}

impl<'p> Measurer<'p> {
    /// `profile` is that of the plan's measured file, where it has one.
    pub fn new(plan: &'p Plan, profile: Option<&Arc<MeasuredRoughness>>) -> Self {
        let simulation = Simulation::new(PathBuf::new());
        let simulation = match profile {
            Some(profile) => simulation.with_measured(Arc::clone(profile)),
            None => simulation,
        };
        Measurer { plan, simulation, of_line: None }
    }

    /// Runs a scene of the plan on the line of a seed and appends, for each preload, what is recorded; NaN
    /// stands for what there is not. The regime is its place in [`Regime::ALL`].
    ///
    /// # Errors
    /// When the line or the contact fails.
    pub fn run(&mut self, scene: &mut Scene, seed: u64, into: &mut Vec<Vec<f64>>) -> Result<(), RunError> {
        let plan = self.plan;
        scene.set_seed(seed);
        scene.numerics.samples = scene.numerics.samples.min(SAMPLES);
        let of_line = self.of_line(scene)?;
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let unit = unit_of_force(&governing, scene.length);
        let own = std::mem::take(&mut scene.loading);
        let mut loops = Vec::new();
        if plan.records(Needs::Loop) {
            match &plan.preloads {
                Some(preloads) => loops.extend(preloads.values().into_iter().map(|preload| {
                    vec![Leg::ToForce(preload * unit.unwrap_or(f64::NAN)), Leg::ToSeparation]
                })),
                None => loops.push(own.clone()),
            }
        }
        // From separation each loop is what it would be by itself.
        let ends_apart = loops.iter().all(|legs| legs.last() == Some(&Leg::ToSeparation));
        let zero_force = plan.records(Needs::ZeroForce);
        let aside = zero_force && !ends_apart;
        let count = loops.len();
        if zero_force && !aside {
            loops.push(vec![Leg::ToZeroForce, Leg::ToSeparation]);
        }
        if loops.is_empty() && plan.records(Needs::Touch) {
            loops.push(vec![Leg::ToTouch, Leg::ToSeparation]);
        }
        let mut outcome = None;
        if !loops.is_empty() {
            scene.loading = loops.concat();
            outcome = Some(self.simulation.run(scene, &|| false, &mut |_, _, _| Ok(()))?);
        }
        let mut each = outcome.as_mut().map_or_else(Vec::new, |outcome| divided(outcome, &loops));
        let mut at_zero_force = (zero_force && !aside).then(|| each.pop()).flatten();
        if aside {
            scene.loading = vec![Leg::ToZeroForce, Leg::ToSeparation];
            let outcome = self.simulation.run(scene, &|| false, &mut |_, _, _| Ok(()))?;
            at_zero_force = Some(outcome.history.legs);
        }
        scene.loading = own;
        let zero_force = at_zero_force.and_then(|legs| of_legs(legs).0.adhesion_force);
        each.truncate(count);
        each.resize_with(plan.preloads.as_ref().map_or(1, |preloads| preloads.count() as usize), Vec::new);
        for legs in each {
            let run = Run { governing, of_line, outcome: outcome.as_ref(), zero_force, length: scene.length };
            let (figures, legs) = of_legs(legs);
            let value = |quantity: &Quantity| run.value(*quantity, &figures, &legs).unwrap_or(f64::NAN);
            into.push(plan.record.iter().map(value).collect());
        }
        Ok(())
    }

    /// What depends on the line alone, as far as it is recorded.
    fn of_line(&mut self, scene: &Scene) -> Result<OfLine, RunError> {
        let (heights, stiffness) = (self.plan.records(Needs::Heights), self.plan.records(Needs::Stiffness));
        if !heights && !stiffness {
            return Ok(OfLine::default());
        }
        let amplitude = self.simulation.make_line(scene)?.2.amplitude;
        let mut bare = Scene { adhesion: None, loading: Vec::new(), ..scene.clone() };
        if let (Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }), Some(amplitude)) =
            (&mut bare.roughness, amplitude)
        {
            // Adhesion may have a say in it.
            (*rms_height, *rms_gradient) = (Some(amplitude.rms_height), None);
        }
        let key = LineKey { scene: bare };
        if let Some((known, of_line)) = &self.of_line
            && *known == key
        {
            return Ok(*of_line);
        }
        let of_line = OfLine {
            heights: if heights { Some(self.heights(&key.scene)?) } else { None },
            exponents: if stiffness { self.exponents(&key.scene)? } else { None },
        };
        self.of_line = Some((key, of_line));
        Ok(of_line)
    }

    /// Statistics of the heights without the form, which is the same for all lines.
    fn heights(&mut self, scene: &Scene) -> Result<Heights, RunError> {
        let flat = Scene { form: None, ..scene.clone() };
        let (line, ..) = self.simulation.make_line(&flat)?;
        let count = line.gaps.len() as f64;
        let mean = line.gaps.iter().sum::<f64>() / count;
        // In units of the deepest gap: squares of heights could leave the range of numbers.
        let deepest = line.deepest();
        let square = line.gaps.iter().map(|gap| ((gap - mean) / deepest).powi(2)).sum::<f64>() / count;
        let rms = if deepest > 0.0 { square.sqrt() * deepest } else { 0.0 };
        let shape = HeightShape::of(line.gaps.iter().map(|gap| -gap));
        Ok(Heights { rms, shape, summit: mean / rms })
    }

    /// Exponents of the contact without adhesion, fitted in logarithms over the plan's range of forces. Where
    /// nothing is stretched, the stiffness is E* times the length in contact.
    fn exponents(&mut self, scene: &Scene) -> Result<Option<Exponents>, RunError> {
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let Some(unit) = unit_of_force(&governing, scene.length) else { return Ok(None) };
        let StiffnessRange { from, to, count } = self.plan.stiffness;
        let step = (to / from).ln() / (count - 1) as f64;
        let force = |index: u64| unit * from * (step * index as f64).exp();
        let loading = (0..count).map(|index| Leg::ToForce(force(index))).collect();
        let scene = Scene { loading, ..scene.clone() };
        let outcome = self.simulation.run(&scene, &|| false, &mut |_, _, _| Ok(()))?;
        let points = outcome.history.legs.iter().filter_map(|leg| leg.curve.last());
        let points: Vec<_> = points.filter(|point| point.force > 0.0 && point.indentation > 0.0).collect();
        let forces: Vec<f64> = points.iter().map(|point| point.force.ln()).collect();
        let lengths: Vec<f64> = points.iter().map(|point| point.contact_length.ln()).collect();
        let indentations: Vec<f64> = points.iter().map(|point| point.indentation.ln()).collect();
        Ok(slope(&forces, &lengths)
            .zip(slope(&indentations, &forces))
            .map(|(stiffness, force)| Exponents { stiffness, force }))
    }
}

/// E* h L, N.
fn unit_of_force(governing: &Governing, length: f64) -> Option<f64> {
    governing.amplitude.map(|amplitude| governing.effective_modulus * amplitude.rms_height * length)
}

/// The legs of an outcome, loop by loop.
fn divided(outcome: &mut Outcome, loops: &[Vec<Leg>]) -> Vec<Vec<LegRecord>> {
    let mut legs = std::mem::take(&mut outcome.history.legs).into_iter();
    loops.iter().map(|one| legs.by_ref().take(one.len()).collect()).collect()
}

fn of_legs(legs: Vec<LegRecord>) -> (Figures, Vec<LegRecord>) {
    let history = History { legs, ..History::default() };
    (Figures::of(&history), history.legs)
}

/// What a run has given, in all its loops.
struct Run<'o> {
    governing: Governing,
    of_line: OfLine,
    outcome: Option<&'o Outcome>,
    /// F_a(0) by the zero-force protocol, N.
    zero_force: Option<f64>,
    length: f64,
}

impl Run<'_> {
    fn value(&self, quantity: Quantity, figures: &Figures, legs: &[LegRecord]) -> Option<f64> {
        let touch = self.outcome.and_then(|outcome| outcome.zero_load_adhesion_force);
        let ideal = || self.outcome?.ideal_adhesion_force.filter(|&force| force > 0.0);
        let heights = self.of_line.heights;
        match quantity {
            Quantity::Kappa => self.governing.kappa,
            Quantity::WorkOfAdhesion => self.governing.work_of_adhesion,
            Quantity::IdealAdhesionForce => self.governing.work_of_adhesion.map(|work| {
                crate::analysis::ideal_adhesion_force(work, self.governing.effective_modulus, self.length)
            }),
            Quantity::ZeroLoadAdhesionForce => touch,
            Quantity::ZeroLoadAdhesionShare => Some(touch? / ideal()?),
            Quantity::ZeroForceAdhesionForce => self.zero_force,
            Quantity::ZeroForceAdhesionShare => Some(self.zero_force? / ideal()?),
            Quantity::PreloadForce => figures.preload,
            Quantity::PreloadIndentation => figures.preload_indentation,
            Quantity::AdhesionForce => figures.adhesion_force,
            Quantity::AdhesionShare => Some(figures.adhesion_force? / ideal()?),
            Quantity::AdhesionCoefficient => figures.adhesion_coefficient,
            Quantity::PullOffIndentation => figures.pull_off_indentation,
            Quantity::DissipatedEnergy => figures.dissipated_energy,
            Quantity::ContactFraction => {
                let lengths = legs.iter().flat_map(|leg| &leg.curve).map(|point| point.contact_length);
                lengths.reduce(f64::max).map(|longest| longest / self.length)
            }
            Quantity::Fragments => legs
                .iter()
                .filter(|leg| leg.direction == Direction::Loading)
                .map(|leg| leg.largest)
                .max_by(|a, b| a.force.total_cmp(&b.force))
                .map(|point| point.fragments as f64),
            Quantity::Regime => {
                let smooth = self.outcome?.smooth_adhesion_force;
                Regime::of_loading(figures, touch, smooth).map(|regime| f64::from(regime as u8))
            }
            Quantity::StiffnessExponent => self.of_line.exponents.map(|exponents| exponents.stiffness),
            Quantity::ForceExponent => self.of_line.exponents.map(|exponents| exponents.force),
            Quantity::RmsHeight => heights.map(|heights| heights.rms),
            Quantity::Skewness => Some(heights?.shape?.skewness),
            Quantity::ExcessKurtosis => Some(heights?.shape?.excess_kurtosis),
            Quantity::SummitHeight => heights.map(|heights| heights.summit),
        }
        .filter(|value| value.is_finite())
    }
}

/// Slope of the straight line of least squares; `None` for fewer than two different points.
fn slope(x: &[f64], y: &[f64]) -> Option<f64> {
    let count = x.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (middle, height) = (mean(x), mean(y));
    let square: f64 = x.iter().map(|x| (x - middle).powi(2)).sum();
    let product: f64 = x.iter().zip(y).map(|(x, y)| (x - middle) * (y - height)).sum();
    Some(product / square).filter(|slope| x.len() >= 2 && slope.is_finite())
}
