//! The ensemble of a scene: its results on several random profiles with the same roughness.

use super::error::StudyError;
use super::missing_profiles::Failures;
use super::part::StudyPart;
use super::plan::Plan;
use super::quantity::Quantity;
use super::results::Results;
use super::statistics::{RegimeCounts, Statistics};
use asperity_data::{Control, CountedWarning};
use asperity_scene::{Scene, Simulation, Solver};

/// Results of a scene on several random profiles. The first profile has the seed of the scene, and
/// the others have the seeds that follow. If the profile of the scene is fixed, the ensemble is
/// this profile alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Ensemble {
    results: Results,
}

impl Ensemble {
    /// Number of random profiles that is used unless the caller requests another number.
    pub const PROFILES: u64 = 16;

    /// Sentence that a report shows instead of statistics for a scene with a fixed profile.
    pub const FIXED: &str =
        "The profile of this scene is fixed, so there is no scatter over random profiles.";

    /// Quantities that every ensemble records on each profile.
    pub const NUMBERS: [Quantity; 5] = [
        Quantity::PullOffForce,
        Quantity::AdhesionShare,
        Quantity::FirstTouchPullOffForce,
        Quantity::ZeroForcePullOffForce,
        Quantity::DissipatedEnergy,
    ];

    /// Quantities that are added to a table with one row for each profile. Their columns follow
    /// those of the quantities [`Ensemble::NUMBERS`].
    pub const FURTHER: [Quantity; 5] = [
        Quantity::PreloadIndentation,
        Quantity::ContactFraction,
        Quantity::Skewness,
        Quantity::ExcessKurtosis,
        Quantity::TaborNumber,
    ];

    /// Returns the number of profiles on which a scene is usually computed: 1 if the profile of the
    /// scene is fixed or the solver of the scene is [`Solver::Stepwise`], otherwise
    /// [`Ensemble::PROFILES`].
    pub fn profiles_of(scene: &Scene) -> u64 {
        let several = scene.seed().is_some() && scene.numerics.solver == Solver::Exact;
        if several { Ensemble::PROFILES } else { 1 }
    }

    /// Computes a checked scene on `profiles` random profiles. Recorded are the main results
    /// ([`Ensemble::NUMBERS`]), the quantities `further`, and the regimes of adhesion. After each
    /// profile, `control` reports the ensemble of the profiles computed so far.
    ///
    /// # Errors
    /// Returns an error if zero profiles or zero threads are requested, if several profiles are
    /// requested and the profile of the scene is fixed, if the memory does not suffice, or if
    /// `control` stops the computation.
    ///
    /// ```
    /// use asperity_data::Control;
    /// use asperity_scene::Simulation;
    /// use asperity_study::{Ensemble, Quantity};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?.set("numerics.points", "2048")?;
    /// let simulation = &mut Simulation::default();
    /// let found = Ensemble::of(scene.scene(), &[], 8, simulation, Control::default())?;
    /// let force = found.statistics(Quantity::PullOffForce).expect("eight profiles adhere");
    /// assert_eq!(force.count, 8);
    /// assert!(force.quartiles[0] < force.quartiles[1] && force.quartiles[1] < force.quartiles[2]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        scene: &Scene,
        further: &[Quantity],
        profiles: u64,
        simulation: &mut Simulation,
        mut control: Control<'_, Ensemble>,
    ) -> Result<Ensemble, StudyError> {
        let threads = control.threads();
        StudyError::check_threads(threads)?;
        let record = Ensemble::recorded(further);
        let mut ensemble = Ensemble {
            results: Results::begin(scene, &record, profiles, None)?,
        };
        let missing = ensemble.results.missing(Failures::Keep);
        missing.solve(simulation, threads, control.stop(), &mut |solved| {
            ensemble.results.take_in(solved);
            control.report(&ensemble);
        })?;
        Ok(ensemble)
    }

    /// Returns the plan of an ensemble, whose parts [`compute_part`](crate::compute_part) computes
    /// in other processes. The arguments are those of [`Ensemble::of`].
    ///
    /// # Errors
    /// Returns an error if zero profiles are requested, or if several are requested although the
    /// profile of the scene is fixed.
    pub fn plan(scene: &Scene, further: &[Quantity], profiles: u64) -> Result<Plan, StudyError> {
        StudyError::check_profiles(scene, profiles)?;
        let record = Ensemble::recorded(further);
        Ok(Plan::of_scene(scene, profiles, &record))
    }

    /// Gathers an ensemble from the parts of its [plan](Ensemble::plan).
    ///
    /// # Errors
    /// Returns the errors of [`Results::of_parts`].
    pub fn of_parts(
        plan: &Plan,
        parts: impl IntoIterator<Item = StudyPart>,
    ) -> Result<Ensemble, StudyError> {
        let results = Results::of_parts(plan, parts)?;
        Ok(Ensemble { results })
    }

    fn recorded(further: &[Quantity]) -> Vec<Quantity> {
        [&Ensemble::NUMBERS[..], &Quantity::REGIMES, further].concat()
    }

    /// Returns the number of profiles that the ensemble has once all its profiles are computed.
    pub fn profiles(&self) -> u64 {
        self.results.plan().lines
    }

    /// Returns the number of profiles that are computed so far.
    pub fn computed(&self) -> u64 {
        self.results.count()
    }

    /// Returns the profiles that cannot be computed: the seed of each such profile, and the reason
    /// in one line.
    pub fn failed(&self) -> impl Iterator<Item = (u64, &str)> {
        self.results
            .failed()
            .map(|(_, line, reason)| (self.results.plan().seed_of(line), reason))
    }

    /// Returns the recorded values on all profiles as the [`Results`] of a study without axes.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// Returns the statistics of a quantity over the computed profiles; `None` if the quantity has
    /// no value on any profile.
    pub fn statistics(&self, quantity: Quantity) -> Option<Statistics> {
        self.results.statistics(0, quantity)
    }

    /// Returns the values of a quantity on all profiles, sorted by the seeds of the profiles;
    /// `None` for a profile without a value.
    pub fn values(&self, quantity: Quantity) -> Vec<Option<f64>> {
        (0..self.profiles())
            .map(|line| self.results.value(0, line, quantity))
            .collect()
    }

    /// Returns the premises of the model that profiles of the ensemble do not meet, each with the
    /// number of profiles that do not meet it.
    pub fn warnings(&self) -> Vec<CountedWarning> {
        self.results.warnings(0)
    }

    /// Returns the number of profiles in each regime of adhesion, as two counts. In the first
    /// count, the regime follows from F_a(d=0), the pull-off force of a loading that turns at first
    /// touch ([`Quantity::Regime`]). In the second count, it follows from F_a(F=0), the pull-off
    /// force of a loading that turns at zero force ([`Quantity::RegimeAfterZeroForce`]).
    pub fn regimes(&self) -> [RegimeCounts; 2] {
        self.results.regimes(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{CheckedScene, open};
    use std::sync::atomic::{AtomicBool, Ordering};

    fn scene(name: &str) -> CheckedScene {
        open(name)
            .unwrap()
            .scene()
            .with(|scene| scene.numerics.points = 2048)
            .unwrap()
    }

    fn ensemble(scene: &CheckedScene, profiles: u64, jobs: usize) -> Result<Ensemble, StudyError> {
        let control = Control::default().on_threads(jobs);
        Ensemble::of(scene, &[], profiles, &mut Simulation::default(), control)
    }

    /// Each profile is that of the scene with another seed. The results do not depend on the number
    /// of threads.
    #[test]
    fn an_ensemble_is_the_scene_with_the_seeds_that_follow() {
        let scene = scene("pressure-sensitive");
        let found = ensemble(&scene, 6, 2).unwrap();
        assert_eq!(ensemble(&scene, 6, 1).unwrap(), found);
        let outcome = |seed| {
            Simulation::default()
                .run(&scene.with_seed(seed), &|| false, &mut |_, _, _| Ok(()))
                .unwrap()
        };
        let outcomes: Vec<_> = (0..6)
            .map(|line| outcome(scene.seed().unwrap() + line))
            .collect();
        let of = |value: fn(&asperity_scene::Outcome) -> Option<f64>| {
            outcomes.iter().map(value).collect::<Vec<_>>()
        };
        assert_eq!(
            found.values(Quantity::PullOffForce),
            of(|outcome| outcome.figures.pull_off_force)
        );
        assert_eq!(
            found.values(Quantity::FirstTouchPullOffForce),
            of(|outcome| outcome.first_touch_pull_off_force)
        );
        assert_eq!(
            found.values(Quantity::ZeroForcePullOffForce),
            of(|outcome| outcome.zero_force_pull_off_force)
        );
        assert_eq!(
            found.values(Quantity::DissipatedEnergy),
            of(|outcome| outcome.figures.dissipated_energy)
        );
        let share =
            of(|outcome| Some(outcome.figures.pull_off_force? / outcome.ideal_pull_off_force?));
        assert_eq!(found.values(Quantity::AdhesionShare), share);
        let mut shares: Vec<f64> = share.into_iter().flatten().collect();
        shares.sort_by(f64::total_cmp);
        let all = found.statistics(Quantity::AdhesionShare).unwrap();
        assert_eq!(
            (all.range, all.quartiles[1]),
            ((shares[0], shares[5]), f64::midpoint(shares[2], shares[3]))
        );
        let regimes = RegimeCounts::of(outcomes.iter().map(|outcome| outcome.regime));
        assert_eq!(found.regimes()[0], regimes);
    }

    #[test]
    fn an_ensemble_reports_each_profile_and_stops() {
        let scene = scene("rough-sphere");
        let (mut parts, ended) = (Vec::new(), AtomicBool::new(false));
        let mut see = |part: &Ensemble| {
            let computed = part.computed();
            parts.push(computed);
            ended.store(computed == 3, Ordering::Relaxed);
        };
        let stop = || ended.load(Ordering::Relaxed);
        let control = Control::default()
            .on_threads(1)
            .stopped_by(&stop)
            .reporting_to(&mut see);
        let stopped = Ensemble::of(&scene, &[], 400, &mut Simulation::default(), control);
        assert!(matches!(stopped, Err(StudyError::Run { error, .. }) if error.is_interruption()));
        assert!(
            parts.starts_with(&[1, 2, 3]) && parts.len() < 400,
            "{parts:?}"
        );
    }

    #[test]
    fn an_ensemble_of_parts_is_that_of_one_computation() {
        let scene = scene("pressure-sensitive");
        let plan = Ensemble::plan(&scene, &[], 5).unwrap();
        let mut parts = Vec::new();
        for lines in [3..5, 0..3] {
            parts.push(crate::compute_part(&plan, None, lines, Control::default()).unwrap());
        }
        let whole = ensemble(&scene, 5, 2).unwrap();
        assert_eq!(Ensemble::of_parts(&plan, parts.clone()).unwrap(), whole);
        let shorter = Ensemble::plan(&scene, &[], 2).unwrap();
        assert!(Ensemble::of_parts(&shorter, parts).is_err());
    }

    #[test]
    fn a_fixed_profile_is_the_only_one() {
        let smooth = scene("jkr-sphere");
        assert_eq!(Ensemble::profiles_of(&smooth), 1);
        let one = ensemble(&smooth, 1, 2).unwrap();
        assert_eq!((one.profiles(), one.computed()), (1, 1));
        assert!(
            one.statistics(Quantity::PullOffForce)
                .is_some_and(|all| all.spread.is_none())
        );
        assert!(ensemble(&smooth, 2, 1).is_err());
    }
}
