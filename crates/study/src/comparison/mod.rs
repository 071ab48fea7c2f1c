//! Computation of a comparison with three dimensions: first on random profiles, then on random
//! square surfaces, with the same loading.

mod gather;
mod lines;
mod settings;
mod squares;
#[cfg(test)]
mod tests;

use self::settings::Comparison;
use super::error::StudyError;
use super::premises::warnings_on_profiles;
use super::reference::{Reference, ReferenceEvent, ReferenceOptions};
use super::resolved::Resolved;
use asperity_data::Control;
use asperity_scene::{CheckedScene, Simulation};
use std::time::Instant;

impl Reference {
    /// Compares the contact of a checked scene on random profiles with its contact on random square
    /// surfaces in three dimensions. `simulation` finds the measured files of the scene in their
    /// folder. `control` receives each event. The number of threads changes only the computing
    /// times, not the results.
    ///
    /// # Errors
    /// Returns an error if zero threads are requested, if the scene has no body in three dimensions
    /// or no preload above zero, if the number of grid cells is not allowed, or if the memory does
    /// not suffice. It is also an error if the square surfaces would take more than a day, if too
    /// few grid cells are in contact for any comparison, or if `control` stops the computation.
    pub fn of(
        scene: &CheckedScene,
        options: ReferenceOptions,
        simulation: &mut Simulation,
        mut control: Control<'_, ReferenceEvent>,
    ) -> Result<Reference, StudyError> {
        StudyError::check_threads(control.threads())?;
        if options.surfaces == 0 || options.profiles == 0 {
            return Err(StudyError::refused(None, "no profiles", "at least one"));
        }
        let resolved = Resolved::of(scene, options.cells, simulation)?;
        let seed = scene.seed();
        let options = match seed {
            Some(_) => options,
            None => ReferenceOptions {
                surfaces: 1,
                profiles: 1,
                ..options
            },
        };
        let comparison = Comparison {
            resolved,
            options,
            seed: seed.unwrap_or(0),
            threads: control.threads(),
            stop: control.stop(),
        };
        let mut reference = comparison.run(&mut control)?;
        let profiles = reference.profiles_for_warnings();
        let control = control.of_part();
        reference.warnings = warnings_on_profiles(scene, profiles, simulation, control)?;
        Ok(reference)
    }
}

impl Comparison<'_> {
    fn run(&self, control: &mut Control<'_, ReferenceEvent>) -> Result<Reference, StudyError> {
        let threads = self.threads_for_squares()?;
        let begun = Instant::now();
        let own = self.own_loading()?;
        let time = self.estimate(&own, threads)?;
        let bytes = self.bytes_of_square() * threads as u64;
        let seconds = time.of_squares(self.options.surfaces, threads);
        control.report(ReferenceEvent::Begins {
            surfaces: self.options.surfaces,
            threads,
            bytes,
            seconds,
        });

        let lines = self.lines(&own, control)?;
        let seconds_of_lines = begun.elapsed().as_secs_f64();
        control.report(ReferenceEvent::ProfilesEnd {
            lines: self.headlines(&lines),
        });

        let begun = Instant::now();
        let squares = self.squares(&lines.loading, threads, &time, control)?;
        let seconds_of_squares = begun.elapsed().as_secs_f64();
        self.gather(
            &own,
            &lines,
            &squares,
            [seconds_of_lines, seconds_of_squares],
        )
    }
}
