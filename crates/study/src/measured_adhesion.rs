//! Adhesion of a measured surface, and its spread. The spread has two causes: random profiles of
//! one spectrum differ, and the measurement is compatible with several spectra.
//!
//! Each random profile is solved twice with the same phases: once with the fitted spectrum, and
//! once with a slightly different spectrum. This second spectrum is drawn at random from the
//! uncertainty of the fit.

use super::error::StudyError;
use super::profiles::on_threads_received;
use super::quantity::Quantity;
use super::statistics::{RegimeCounts, Statistics};
use asperity_data::{Control, root_mean_square};
use asperity_scene::{CheckedScene, Document, Outcome, Regime, RunError, Simulation};
use asperity_surface::EquivalentLine;
use asperity_surface::lines::{MeasuredRoughness, read_faces};
use serde::Serialize;
use std::sync::Arc;
use std::sync::mpsc::Sender;

/// The spectrum is changed by this share of a change that is drawn at random from the uncertainty
/// of the fit. The errors of the fit are valid to first order, so the change must be small. The
/// longest waves are nearly unknown, and a full drawn change could alter their power by a factor of
/// several powers of ten.
const SHARE: f64 = 1.0 / 32.0;

/// Adhesion of one random profile with the spectrum of a measured surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ProfileAdhesion {
    /// Seed of the random phases of the profile.
    pub seed: u64,
    /// Pull-off force F_a in N for the spectrum that was fitted to the measurement; `None` if the
    /// force of the unloading is never negative.
    pub pull_off_force: Option<f64>,
    /// Change of F_a in N when the spectrum changes at random within the uncertainty of its fit,
    /// computed to first order. The change is limited so that the changed force is between zero and
    /// [`ProfileAdhesion::largest_force`]. `None` if there is no pull-off force before or after the
    /// change.
    pub fit_change: Option<f64>,
    /// Regime of adhesion with the fitted spectrum, which follows from F_a(d=0), the pull-off force
    /// of a loading that turns at first touch. `None` if the regime is unknown.
    pub regime: Option<Regime>,
    /// Regime of adhesion with the fitted spectrum, which follows from F_a(F=0), the pull-off force
    /// of a loading that turns at zero force. `None` if the regime is unknown.
    pub regime_after_zero_force: Option<Regime>,
    /// Ideal pull-off force F_a,max in N: the pull-off force of a flat face as long as the profile.
    /// No rough profile exceeds it. `None` if it is not known.
    #[serde(skip)]
    pub largest_force: Option<f64>,
}

impl ProfileAdhesion {
    /// Computes the adhesion of a scene on the random profile with the given seed. `line` has the
    /// fitted spectrum and its uncertainty.
    ///
    /// # Errors
    /// Returns an error if the profile or its contact cannot be computed, or if `stop` returned
    /// true.
    pub fn solve(
        scene: &CheckedScene,
        line: &EquivalentLine,
        seed: u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Self, RunError> {
        let scene = scene.with_seed(seed).stripped();
        let fitted = run_on(&scene, line.clone(), stop)?;
        let mut scene = scene;
        if let Some(work) = fitted.governing.work_of_adhesion {
            // If the scene states κ or e_el/γ, the work of adhesion follows from the fitted
            // spectrum. The same work of adhesion is used with the changed spectrum.
            scene = scene.with(|scene| {
                scene.adhesion = scene.adhesion.map(|adhesion| adhesion.with_work(work));
            })?;
        }
        let moved = run_on(&scene, line.drawn(seed, SHARE), stop)?;
        let pull_off_force = fitted.figures.pull_off_force;
        let mut fit_change = None;
        if let (Some(before), Some(after)) = (pull_off_force, moved.figures.pull_off_force) {
            let change = (after - before) / SHARE;
            let largest = fitted.ideal_pull_off_force.unwrap_or(f64::INFINITY);
            fit_change = Some(change.max(-before).min((largest - before).max(0.0)));
        }
        Ok(ProfileAdhesion {
            seed,
            pull_off_force,
            fit_change,
            regime: fitted.regime,
            regime_after_zero_force: fitted.regime_after_zero_force,
            largest_force: fitted.ideal_pull_off_force,
        })
    }
}

/// Computes a scene with `line` as the spectrum of its measured surface.
fn run_on(
    scene: &CheckedScene,
    line: EquivalentLine,
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, RunError> {
    let measured = Arc::new(MeasuredRoughness::Equivalent(line));
    let mut simulation = Simulation::default().with_measured(measured);
    simulation.run(scene, stop, &mut |_, _, _| Ok(()))
}

/// Adhesion of several random profiles with the spectrum of one measured surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasuredAdhesion {
    /// Adhesion of each profile, sorted by the seeds of the profiles.
    pub profiles: Vec<ProfileAdhesion>,
    /// True if the uncertainty of the pull-off force due to the spectrum is known. This is so if
    /// the error of the elastic energy of the spectrum is at most as large as the elastic energy.
    pub is_fit_known: bool,
}

impl MeasuredAdhesion {
    /// Creates the adhesion of the spectrum of `line`, without any profile.
    pub fn new(line: &EquivalentLine) -> Self {
        let energy = line.moments().energy_per_modulus;
        MeasuredAdhesion {
            profiles: Vec::new(),
            is_fit_known: energy.error <= energy.value,
        }
    }

    /// Returns the ideal pull-off force F_a,max in N: the pull-off force of a flat face as long as
    /// the profiles. No rough profile exceeds it. `None` if it is not known.
    pub fn largest_force(&self) -> Option<f64> {
        self.profiles.first()?.largest_force
    }

    /// Computes the adhesion of a scene on `count` random profiles with the spectrum of its
    /// measured surface. The first profile has the seed of the scene, and the others have the seeds
    /// that follow. Paths of measured files are relative to the folder of the scene file. `control`
    /// reports the number of computed profiles.
    ///
    /// # Errors
    /// Returns an error if the scene does not make random profiles from a measured surface, if a
    /// file cannot be read, if a profile cannot be computed, or if `control` stops the computation.
    ///
    /// ```
    /// use asperity_data::Control;
    ///
    /// let folder = tempfile::tempdir()?;
    /// let height = |i: u32| {
    ///     (1..60)
    ///         .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
    ///         .sum::<f64>()
    /// };
    /// let rows: String = (0..256)
    ///     .map(|i| format!("{i} {}\n", 30.0 * height(i)))
    ///     .collect();
    /// std::fs::write(
    ///     folder.path().join("line.txt"),
    ///     format!("x [um] z [nm]\n{rows}"),
    /// )?;
    /// let text = r#"(version: 1, material: (modulus: 1.0e6), length: 2.56e-4,
    /// adhesion: (work: 0.05),
    /// roughness: Measured(file: "line.txt"), numerics: (points: 1024),
    /// loading: [ToForce(1.0e-4), ToSeparation])"#;
    /// std::fs::write(folder.path().join("scene.ron"), text)?;
    /// let scene = asperity_scene::open(&folder.path().join("scene.ron").display().to_string())?;
    /// let found = asperity_study::trust::MeasuredAdhesion::of(&scene, 4, Control::default())?;
    /// let (low, high) = found.fit_interval().ok_or("no force")?;
    /// assert!(
    ///     found
    ///         .pull_off_force()
    ///         .is_some_and(|all| low < all.quartiles[1] && all.quartiles[1] < high)
    /// );
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(document: &Document, count: u32, control: Control<'_>) -> Result<Self, StudyError> {
        let scene = document.scene();
        StudyError::check_profiles(scene, u64::from(count))?;
        if scene.measured().is_none() || scene.measured_as_line() {
            let allowed = "roughness: Measured with as_line: false";
            return Err(StudyError::refused(
                None,
                "the scene has no equivalent line",
                allowed,
            ));
        }
        let faces = read_faces(&scene.measured_paths(&document.resolve("")))?;
        let line = EquivalentLine::new(&faces, &scene.measured_options())?;
        MeasuredAdhesion::of_line(scene, &line, count, control)
    }

    /// Largest number of springs of a scene for which [`MeasuredAdhesion::quick_deviation`] returns
    /// a result.
    pub const MOST_SPRINGS: u64 = 1 << 17;

    /// Returns the standard deviation of the pull-off force in N due to the uncertainty of the
    /// measured spectrum, computed on `count` random profiles of a scene. `None` if the scene has
    /// more than [`MeasuredAdhesion::MOST_SPRINGS`] springs, does not make random profiles from a
    /// measured surface, or cannot be computed.
    ///
    /// # Errors
    /// Returns an error if `control` stops the computation.
    pub fn quick_deviation(
        document: &Document,
        count: u64,
        control: Control<'_>,
    ) -> Result<Option<f64>, StudyError> {
        if document.scene().numerics.points > MeasuredAdhesion::MOST_SPRINGS {
            return Ok(None);
        }
        match MeasuredAdhesion::of(document, count as u32, control) {
            Ok(adhesion) => Ok(adhesion.fit_deviation()),
            Err(error) if error.is_interruption() => Err(error),
            Err(_) => Ok(None),
        }
    }

    /// Computes the adhesion of a scene on `count` random profiles with the spectrum of `line`. The
    /// first profile has the seed of the scene, and the others have the seeds that follow.
    /// `control` reports the number of computed profiles.
    ///
    /// # Errors
    /// Returns an error if a profile cannot be computed, or if `control` stops the computation.
    pub fn of_line(
        scene: &CheckedScene,
        line: &EquivalentLine,
        count: u32,
        mut control: Control<'_>,
    ) -> Result<Self, StudyError> {
        let stop = control.stop();
        let worker = |sender: Sender<()>| {
            move |number: u64| {
                let seed = scene.seed().unwrap_or(0).wrapping_add(number);
                let solved = ProfileAdhesion::solve(scene, line, seed, stop);
                // Sending cannot fail, because the receiver exists until all threads have ended.
                let _ = sender.send(());
                solved.map_err(|error| StudyError::at(format!("seed {seed}: "), error))
            }
        };
        let threads = control.threads();
        let mut computed = 0;
        let profiles = on_threads_received(u64::from(count), threads, worker, &mut |()| {
            computed += 1;
            control.report(computed);
        })?;
        Ok(MeasuredAdhesion {
            profiles,
            ..MeasuredAdhesion::new(line)
        })
    }

    /// Returns the statistics of the pull-off force in N over the profiles, for the fitted
    /// spectrum; `None` if no profile has a pull-off force.
    pub fn pull_off_force(&self) -> Option<Statistics> {
        let forces = self
            .profiles
            .iter()
            .filter_map(|profile| profile.pull_off_force)
            .collect();
        Statistics::of(forces, Quantity::PullOffForce.bounds())
    }

    /// Returns the standard deviation of the pull-off force in N due to the uncertainty of the
    /// spectrum. It is the root mean square of [`ProfileAdhesion::fit_change`] over the profiles.
    /// `None` for fewer than two profiles, or if [the uncertainty is unknown](Self::is_fit_known).
    pub fn fit_deviation(&self) -> Option<f64> {
        if !self.is_fit_known {
            return None;
        }
        let changes = self.profiles.iter().map(|profile| profile.fit_change);
        rms(changes.flatten())
    }

    /// Returns the interval of the median pull-off force in N: the median minus and plus the
    /// standard deviation due to the uncertainty of the spectrum,
    /// [`MeasuredAdhesion::fit_deviation`]. Both ends are limited to the range from zero to
    /// [`MeasuredAdhesion::largest_force`]. `None` if the deviation is unknown.
    pub fn fit_interval(&self) -> Option<(f64, f64)> {
        let deviation = self.fit_deviation()?;
        let median = self.pull_off_force()?.quartiles[1];
        let largest = self.largest_force().unwrap_or(f64::INFINITY).max(median);
        let low = (median - deviation).max(0.0);
        let high = (median + deviation).min(largest);
        Some((low, high))
    }

    /// Returns the number of profiles in each regime of adhesion, as two counts. In the first
    /// count, the regime follows from F_a(d=0), the pull-off force of a loading that turns at first
    /// touch ([`Quantity::Regime`]). In the second count, it follows from F_a(F=0), the pull-off
    /// force of a loading that turns at zero force ([`Quantity::RegimeAfterZeroForce`]).
    pub fn regimes(&self) -> [RegimeCounts; 2] {
        let after_touch = self.profiles.iter().map(|profile| profile.regime);
        let after_zero_force = self
            .profiles
            .iter()
            .map(|profile| profile.regime_after_zero_force);
        [
            RegimeCounts::of(after_touch),
            RegimeCounts::of(after_zero_force),
        ]
    }
}

/// Returns the root mean square of at least two numbers; `None` for fewer.
fn rms(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let numbers: Vec<f64> = numbers.collect();
    (numbers.len() >= 2)
        .then(|| root_mean_square(numbers))
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::Scene;

    fn scene_and_line(adhesion: &str) -> (CheckedScene, EquivalentLine) {
        let text = format!(
            "(version: 1, material: (modulus: 1.0e6), length: 2.56e-4, adhesion: {adhesion}, \
             roughness: Measured(file: \"none.txt\", seed: 5), numerics: (points: 1024), \
             loading: [ToForce(1.0e-4), ToSeparation])"
        );
        let scene = Document::parse(&text, "test").unwrap().scene().clone();
        let height = |i: u32| {
            (1..60)
                .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
                .sum::<f64>()
        };
        let rows: String = (0..256)
            .map(|i| format!("{i} {}\n", 30.0 * height(i)))
            .collect();
        let face = vec![("".into(), format!("x [um] z [nm]\n{rows}").into_bytes())];
        let line = EquivalentLine::new(&[face], &scene.measured_options()).unwrap();
        (scene, line)
    }

    #[test]
    fn both_spreads_are_those_of_separate_runs() {
        let (scene, line) = scene_and_line("(work: 0.05)");
        let found =
            MeasuredAdhesion::of_line(&scene, &line, 6, Control::default().on_threads(1)).unwrap();
        assert_eq!(
            MeasuredAdhesion::of_line(&scene, &line, 6, Control::default().on_threads(3)).unwrap(),
            found
        );
        let force = |line: EquivalentLine, seed: u64| {
            let scene = scene.with_seed(seed);
            let measured = Arc::new(MeasuredRoughness::Equivalent(line));
            let mut simulation = Simulation::default().with_measured(measured);
            simulation
                .run(&scene, &|| false, &mut |_, _, _| Ok(()))
                .unwrap()
                .figures
                .pull_off_force
                .unwrap()
        };
        let (mut fitted, mut square) = (Vec::new(), 0.0);
        for (profile, seed) in found.profiles.iter().zip(5..) {
            let (one, other) = (
                force(line.clone(), seed),
                force(line.drawn(seed, SHARE), seed),
            );
            assert_eq!((profile.seed, profile.pull_off_force), (seed, Some(one)));
            let change = (other - one) / SHARE;
            assert_eq!(profile.fit_change, Some(change));
            // The change is computed to first order: half the change of the spectrum changes the
            // force by about half as much.
            let half = 2.0 * (force(line.drawn(seed, 0.5 * SHARE), seed) - one) / SHARE;
            assert!(
                (half - change).abs() < 0.2 * change.abs() + 1e-3 * one,
                "{seed}: {half} {change}"
            );
            fitted.push(one);
            square += change.powi(2) / 6.0;
        }
        assert_eq!(
            found.pull_off_force(),
            Statistics::of(fitted, (0.0, f64::INFINITY))
        );
        let deviation = found.fit_deviation().unwrap();
        assert!(
            (deviation / square.sqrt() - 1.0).abs() < 1e-12 && deviation > 0.0,
            "{deviation}"
        );
        assert_eq!(
            found
                .regimes()
                .map(|counts| counts.present().map(|(_, count)| count).sum::<usize>()),
            [6; 2]
        );
    }

    /// The measured file is read with the options in the scene, here with and without `periodic:
    /// true`.
    #[test]
    fn the_options_are_those_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let rows: String = (0..128)
            .map(|i| format!("{i} {}\n", 30.0 * (f64::from(i * i) * 0.37).sin()))
            .collect();
        std::fs::write(
            folder.path().join("line.txt"),
            format!("x [um] z [nm]\n{rows}"),
        )
        .unwrap();
        for periodic in [true, false] {
            let text = format!(
                "(version: 1, material: (modulus: 1.0e6), length: 1.28e-4, adhesion: (work: 0.05), roughness: \
                 Measured(file: \"line.txt\", periodic: {periodic}), numerics: (points: 512), loading: [ToTouch, \
                 ToSeparation])"
            );
            let document = Document::parse(
                &text,
                &folder.path().join("scene.ron").display().to_string(),
            )
            .unwrap();
            let found = MeasuredAdhesion::of(&document, 1, Control::default()).unwrap();
            let outcome = asperity_scene::run(&document).unwrap();
            assert_eq!(
                found.profiles[0].pull_off_force, outcome.figures.pull_off_force,
                "{periodic}"
            );
        }
        assert!(
            MeasuredAdhesion::of(
                &asperity_scene::open("jkr-sphere").unwrap(),
                1,
                Control::default()
            )
            .is_err()
        );
    }

    /// If hardly anything is known of the spectrum, the uncertainty of the force is unknown. The
    /// reported forces never exceed the force of a flat face.
    #[test]
    fn no_error_of_the_force_is_beyond_the_force_of_a_flat_face() {
        let (scene, line) = scene_and_line("(work: 0.05)");
        let control = || Control::default().on_threads(1);
        let found = MeasuredAdhesion::of_line(&scene, &line, 6, control()).unwrap();
        let largest = found.largest_force().unwrap();
        for profile in &found.profiles {
            let changed = profile.pull_off_force.unwrap() + profile.fit_change.unwrap();
            assert!((0.0..=largest).contains(&changed), "{profile:?}");
        }
        let (low, high) = found.fit_interval().unwrap();
        assert!(0.0 <= low && high <= largest, "{low} {high} {largest}");
        let wide = MeasuredAdhesion {
            profiles: (0..4)
                .map(|seed| ProfileAdhesion {
                    seed,
                    pull_off_force: Some(0.4 * largest),
                    fit_change: Some(0.6 * largest),
                    regime: None,
                    regime_after_zero_force: None,
                    largest_force: Some(largest),
                })
                .collect(),
            ..found.clone()
        };
        assert_eq!(wide.fit_interval(), Some((0.0, largest)));
        let unknown = MeasuredAdhesion {
            is_fit_known: false,
            ..found
        };
        assert_eq!(unknown.fit_interval(), None);
        assert_eq!(unknown.fit_deviation(), None);
    }

    #[test]
    fn a_given_kappa_is_that_of_the_fitted_spectrum() {
        let (scene, line) = scene_and_line("(kappa: 1.5)");
        let by_kappa =
            MeasuredAdhesion::of_line(&scene, &line, 2, Control::default().on_threads(1)).unwrap();
        let measured = Arc::new(MeasuredRoughness::Equivalent(line.clone()));
        let mut simulation = Simulation::default().with_measured(measured);
        let outcome = simulation
            .run(&scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let work = outcome.governing.work_of_adhesion.unwrap();
        let with_work = |scene: &mut Scene| {
            scene.adhesion = scene.adhesion.map(|adhesion| adhesion.with_work(work))
        };
        let scene = scene.with(with_work).unwrap();
        assert_eq!(
            MeasuredAdhesion::of_line(&scene, &line, 2, Control::default().on_threads(1)).unwrap(),
            by_kappa
        );
    }
}
