//! Recorder of a case: solves its loadings on one profile and reads the recorded quantities.

use super::case_outcome::{CaseOutcome, Exponents, HeightStatistics, ProfileRecord};
use super::height_shape::HeightShape;
use super::plan::{Plan, StiffnessRange};
use super::quantity::Needs;
use crate::analysis::Figures;
use crate::contact::{History, LegRecord};
use crate::scene::{Leg, Roughness, Scene};
use crate::simulation::{Outcome, RunError, Simulation};

/// Curve samples on a leg: all that is recorded is at the ends of legs or an exact extreme.
const SAMPLES: u64 = 2;

/// Values of the recorded quantities, in the order of the plan, for each preload; NaN for a quantity that the case does
/// not have.
pub(crate) type Records = Vec<Vec<f64>>;

/// Recorder of the cases of a plan. Keeps the profile, its tree and the properties of the profile from case to case.
pub(super) struct Recorder<'p> {
    plan: &'p Plan,
    simulation: Simulation,
    /// The properties of the last profile, and the scene without adhesion and loading that they belong to.
    profile: Option<(Scene, ProfileRecord)>,
    stop: &'p dyn Fn() -> bool,
}

impl<'p> Recorder<'p> {
    /// A recorder that gives up within a case as soon as `stop` returns true.
    pub fn new(plan: &'p Plan, simulation: Simulation, stop: &'p dyn Fn() -> bool) -> Self {
        Recorder { plan, simulation, profile: None, stop }
    }

    /// Solves a scene of the plan on the profile of a seed.
    ///
    /// # Errors
    /// When the profile or the contact fails, or when stopped.
    pub fn record(&mut self, scene: &mut Scene, seed: u64) -> Result<Records, RunError> {
        let plan = self.plan;
        scene.set_seed(seed);
        scene.numerics.samples = scene.numerics.samples.min(SAMPLES);
        let profile = self.profile_record(scene)?;
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let unit = governing.force_unit(scene.length);
        let own = std::mem::take(&mut scene.loading);
        let mut loops = Vec::new();
        if plan.records(Needs::Loading) {
            match &plan.preloads {
                Some(preloads) => loops.extend(preloads.values().into_iter().map(|preload| {
                    vec![Leg::ToForce(preload * unit.unwrap_or(f64::NAN)), Leg::ToSeparation]
                })),
                None => loops.push(own.clone()),
            }
        }
        // From separation each loop is the same as by itself.
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
        let mut run = None;
        if !loops.is_empty() {
            scene.loading = loops.concat();
            run = Some(self.run(scene)?);
        }
        let mut each = run.as_mut().map_or_else(Vec::new, |run| divided(run, &loops));
        let mut at_zero_force = (zero_force && !aside).then(|| each.pop()).flatten();
        if aside {
            scene.loading = vec![Leg::ToZeroForce, Leg::ToSeparation];
            at_zero_force = Some(self.run(scene)?.history.legs);
        }
        scene.loading = own;
        let zero_force = at_zero_force.and_then(|legs| figures(legs).0.adhesion_force);
        each.truncate(count);
        each.resize_with(plan.preloads.as_ref().map_or(1, |preloads| preloads.count() as usize), Vec::new);
        let (run, length) = (run.as_ref(), scene.length);
        let values = |legs| {
            let (figures, legs) = figures(legs);
            let case = CaseOutcome { governing, profile, run, zero_force, figures, legs, length };
            plan.record.iter().map(|quantity| quantity.of(&case)).collect()
        };
        Ok(each.into_iter().map(values).collect())
    }

    fn run(&mut self, scene: &Scene) -> Result<Outcome, RunError> {
        self.simulation.run(scene, self.stop, &mut |_, _, _| Ok(()))
    }

    /// Properties of the profile, as far as they are recorded.
    fn profile_record(&mut self, scene: &Scene) -> Result<ProfileRecord, RunError> {
        let (heights, stiffness) = (self.plan.records(Needs::Heights), self.plan.records(Needs::Stiffness));
        if !heights && !stiffness {
            return Ok(ProfileRecord::default());
        }
        let amplitude = self.simulation.make_line(scene)?.2.amplitude;
        let mut nonadhesive = Scene { adhesion: None, loading: Vec::new(), ..scene.clone() };
        if let (Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }), Some(amplitude)) =
            (&mut nonadhesive.roughness, amplitude)
        {
            // The amplitude may follow from the adhesion.
            (*rms_height, *rms_gradient) = (Some(amplitude.rms_height), None);
        }
        if let Some((known, record)) = &self.profile
            && *known == nonadhesive
        {
            return Ok(*record);
        }
        let record = ProfileRecord {
            heights: if heights { Some(self.heights(&nonadhesive)?) } else { None },
            exponents: if stiffness { self.exponents(&nonadhesive)? } else { None },
        };
        self.profile = Some((nonadhesive, record));
        Ok(record)
    }

    /// Statistics of the heights without the form, which is the same on all profiles.
    fn heights(&mut self, scene: &Scene) -> Result<HeightStatistics, RunError> {
        let flat = Scene { form: None, ..scene.clone() };
        let (line, ..) = self.simulation.make_line(&flat)?;
        let count = line.gaps.len() as f64;
        let mean = line.gaps.iter().sum::<f64>() / count;
        // In units of the deepest gap: squares of heights could leave the range of numbers.
        let deepest = line.deepest();
        let square = line.gaps.iter().map(|gap| ((gap - mean) / deepest).powi(2)).sum::<f64>() / count;
        let rms = if deepest > 0.0 { square.sqrt() * deepest } else { 0.0 };
        let shape = HeightShape::of(line.gaps.iter().map(|gap| -gap));
        Ok(HeightStatistics { rms, shape, summit: mean / rms })
    }

    /// Exponents of the contact without adhesion, fitted in logarithms over the plan's range of forces. Without stretched
    /// springs the stiffness is E* times the length in contact.
    fn exponents(&mut self, scene: &Scene) -> Result<Option<Exponents>, RunError> {
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let Some(unit) = governing.force_unit(scene.length) else { return Ok(None) };
        let StiffnessRange { from, to, count } = self.plan.stiffness;
        let step = (to / from).ln() / (count - 1) as f64;
        let force = |index: u64| unit * from * (step * index as f64).exp();
        let loading = (0..count).map(|index| Leg::ToForce(force(index))).collect();
        let outcome = self.run(&Scene { loading, ..scene.clone() })?;
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

/// The legs of an outcome, loop by loop.
fn divided(outcome: &mut Outcome, loops: &[Vec<Leg>]) -> Vec<Vec<LegRecord>> {
    let mut legs = std::mem::take(&mut outcome.history.legs).into_iter();
    loops.iter().map(|one| legs.by_ref().take(one.len()).collect()).collect()
}

fn figures(legs: Vec<LegRecord>) -> (Figures, Vec<LegRecord>) {
    let history = History { legs, ..History::default() };
    (Figures::of(&history), history.legs)
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
