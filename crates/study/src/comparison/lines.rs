//! Results of a comparison on random profiles: loops with adhesion, and contacts without adhesion.

use crate::comparison::settings::{Comparison, ROUNDING};
use crate::error::StudyError;
use crate::profiles::{Stop, on_threads_received};
use crate::reference::ReferenceEvent;
use crate::resolved::of_scene;
use crate::spatial::{SquareLoading, Turn};
use asperity_contact::{Branch, Move};
use asperity_data::{Control, mean};
use asperity_scene::{CheckedScene, Outcome, Simulation};
use std::sync::mpsc::Sender;

/// Number of progress events that are reported while the profiles are computed.
const EVENTS_OF_PROFILES: u64 = 100;

/// Result of the loading of the scene on the profile with the seed of the scene.
pub(super) struct OwnLoading {
    /// Condition that ends the pressing of the last loop.
    pub turn: Turn,
    /// Preload in N.
    pub preload: f64,
    /// Distance in m between the indentation at the preload and the indentation at pull-off.
    pub depth: f64,
    /// True if the contact at the turning point extends over the whole profile.
    pub is_full: bool,
}

/// Results of loading one random profile to the preload and back to separation (a loop).
pub(super) struct LineLoop {
    /// Preload in N.
    pub preload: f64,
    /// Distance in m between the indentation at the preload and the indentation at pull-off.
    pub depth: f64,
    pub pull_off_force: Option<f64>,
    pub first_touch_pull_off_force: Option<f64>,
    pub dissipated_energy: Option<f64>,
}

/// Indentation and stiffness of a profile without adhesion at one force.
#[derive(Clone, Copy, Default)]
pub(super) struct PressedLine {
    pub indentation: f64,
    /// Stiffness of the contact in N/m.
    pub stiffness: f64,
}

/// Results on all random profiles.
pub(super) struct Lines {
    /// Loop of each profile; empty if the comparison needs no loops.
    pub loops: Vec<LineLoop>,
    /// For each profile, its states without adhesion at the forces of the comparison.
    pub pressed: Vec<Vec<PressedLine>>,
    /// Loading of the square surfaces that follows from the profiles.
    pub loading: SquareLoading,
    /// Preload in N. It is the mean over the profiles, unless the scene states the preload.
    pub preload: f64,
}

impl LineLoop {
    fn of(outcome: &Outcome) -> LineLoop {
        LineLoop {
            preload: outcome.figures.preload.unwrap_or(0.0),
            depth: depth(outcome),
            pull_off_force: outcome.figures.pull_off_force,
            first_touch_pull_off_force: outcome.first_touch_pull_off_force,
            dissipated_energy: outcome.figures.dissipated_energy,
        }
    }
}

impl Comparison<'_> {
    /// Computes the loading of the scene on the profile with the seed of the scene, and finds the
    /// last loop of this loading.
    ///
    /// # Errors
    /// Returns an error if the scene cannot be computed, or if its loading has no preload above
    /// zero.
    pub fn own_loading(&self) -> Result<OwnLoading, StudyError> {
        let line = &self.resolved.line;
        let outcome = run(line, &mut self.resolved.simulation(), self.stop)?;
        let preload = outcome.figures.preload.unwrap_or(0.0);
        let turning_point = Branch::preload(&outcome.history.stages);
        let Some((stage, largest)) = turning_point.filter(|_| preload > 0.0) else {
            let found = "the loading has no preload above 0 N";
            let allowed = "a loading to a force or an indentation before the separation";
            return Err(StudyError::refused(None, found, allowed));
        };
        let turn = match (line.loading.get(stage), line.loading_stiffness) {
            (Some(&Move::ToForce(force)), _) => Turn::Force(force),
            (Some(&Move::ToIndentation(indentation)), _) => Turn::Indentation(indentation),
            (Some(&Move::ToDisplacement(displacement)), Some(stiffness)) => Turn::Displacement {
                displacement,
                stiffness,
            },
            // Without an instrument, the displacement of the drive equals the indentation of the
            // body.
            (Some(&Move::ToDisplacement(displacement)), None) => Turn::Indentation(displacement),
            _ => Turn::Force(preload),
        };
        let is_full = largest.contact_length >= line.length * (1.0 - ROUNDING);
        // If the scene states the preload, it is used instead of the computed one, which may have a
        // rounding error.
        let preload = if let Turn::Force(force) = turn {
            force
        } else {
            preload
        };
        Ok(OwnLoading {
            turn,
            preload,
            depth: depth(&outcome),
            is_full,
        })
    }

    /// Computes the profiles. Their loops with adhesion come first, because the loading of the
    /// square surfaces depends on the preload and the depth of these loops, as means over the
    /// profiles. The depth is the distance between the indentations at the preload and at pull-off.
    ///
    /// # Errors
    /// Returns an error if a profile or its contact cannot be computed, if the mean preload of the
    /// profiles is not above zero, or if `control` stops the computation.
    pub fn lines(
        &self,
        own: &OwnLoading,
        control: &mut Control<'_, ReferenceEvent>,
    ) -> Result<Lines, StudyError> {
        let loop_scene = self.resolved.line.with(|scene| {
            scene.loading = vec![own.turn.stage(), Move::ToSeparation];
        });
        let loop_scene = loop_scene.map_err(|errors| of_scene(errors.into()))?;
        let prescribes_force = matches!(own.turn, Turn::Force(_));
        let mut loops = Vec::new();
        if self.is_adhesive() || !prescribes_force {
            loops = self.each_line(&loop_scene, 2, control, |outcome| LineLoop::of(&outcome))?;
        }
        let mut preload = own.preload;
        if !prescribes_force {
            preload = mean(&loops.iter().map(|line| line.preload).collect::<Vec<_>>());
        }
        if preload.is_nan() || preload <= 0.0 {
            let found = format!("the mean preload of the profiles is {preload:e} N");
            return Err(StudyError::refused(
                None,
                found,
                "a loading that presses most profiles",
            ));
        }
        let mut depth = own.depth;
        if !loops.is_empty() {
            depth = mean(&loops.iter().map(|line| line.depth).collect::<Vec<_>>());
        }
        let loading = self.square_loading(own.turn, preload, depth);

        let passes = if loops.is_empty() { 1 } else { 2 };
        let pressed = self.pressed_lines(&loading.forces, passes, control)?;
        Ok(Lines {
            loops,
            pressed,
            loading,
            preload,
        })
    }

    /// Computes all profiles without adhesion, and returns for each profile its states at the
    /// `forces` in N. `passes` is the number of computations of all profiles in the whole
    /// comparison.
    fn pressed_lines(
        &self,
        forces: &[f64],
        passes: u64,
        control: &mut Control<'_, ReferenceEvent>,
    ) -> Result<Vec<Vec<PressedLine>>, StudyError> {
        let bare_scene = self.resolved.line.with(|scene| {
            scene.adhesion = None;
            // Each stage `ToForce` ends exactly at its force, so the curve needs no interpolation.
            scene.loading = forces.iter().map(|force| Move::ToForce(*force)).collect();
        });
        let bare_scene = bare_scene.map_err(|errors| of_scene(errors.into()))?;
        let modulus = self.resolved.body.modulus;
        self.each_line(&bare_scene, passes, control, |outcome| {
            pressed_line(&outcome, modulus)
        })
    }

    /// Computes a scene on all profiles, and returns for each profile the numbers that `figures`
    /// takes from its outcome. `passes` is the number of computations of all profiles in the whole
    /// comparison, from which the reported progress follows.
    fn each_line<F: Send>(
        &self,
        scene: &CheckedScene,
        passes: u64,
        control: &mut Control<'_, ReferenceEvent>,
        figures: impl Fn(Outcome) -> F + Sync,
    ) -> Result<Vec<F>, StudyError> {
        let lines = self.options.profiles;
        let figures = &figures;
        let worker = |sender: Sender<()>| {
            let mut simulation = self.resolved.simulation();
            move |line: u64| {
                let scene = scene.with_seed(self.seed.wrapping_add(line));
                let outcome = run(&scene, &mut simulation, self.stop)?;
                // Sending cannot fail, because the receiver exists until all threads have ended.
                let _ = sender.send(());
                Ok(figures(outcome))
            }
        };
        let group = (lines * passes / EVENTS_OF_PROFILES).max(1);
        let mut count = 0;
        on_threads_received(lines, self.threads, worker, &mut |()| {
            count += 1;
            if count % group == 0 {
                control.report(ReferenceEvent::Profiles {
                    count: group,
                    lines: lines * passes,
                });
            }
        })
    }

    /// Returns one number for each profile: the pull-off force in N or, for a scene without
    /// adhesion, the indentation in m at the preload.
    pub fn headlines(&self, lines: &Lines) -> Vec<f64> {
        if self.is_adhesive() {
            lines
                .loops
                .iter()
                .filter_map(|line| line.pull_off_force)
                .collect()
        } else {
            lines
                .pressed
                .iter()
                .filter_map(|states| Some(states.last()?.indentation))
                .collect()
        }
    }
}

fn run(
    scene: &CheckedScene,
    simulation: &mut Simulation,
    stop: &Stop<'_>,
) -> Result<Outcome, StudyError> {
    simulation
        .run(scene, stop, &mut |_, _, _| Ok(()))
        .map_err(of_scene)
}

/// Returns the distance in m between the indentations at the preload and at pull-off.
fn depth(outcome: &Outcome) -> f64 {
    let deepest = outcome.figures.preload_indentation.unwrap_or(0.0);
    let pull_off = outcome.figures.pull_off_indentation.unwrap_or(0.0);
    (deepest - pull_off).abs()
}

/// Returns the state of a profile at the end of each stage of a loading without adhesion. `modulus`
/// is E* in Pa.
fn pressed_line(outcome: &Outcome, modulus: f64) -> Vec<PressedLine> {
    let mut states = Vec::with_capacity(outcome.history.stages.len());
    for stage in &outcome.history.stages {
        let end = stage.curve.last().copied().unwrap_or_default();
        // Each spring in contact has the stiffness E* Δx, so the stiffness of the contact is E*
        // times the contact length.
        let stiffness = modulus * end.contact_length;
        states.push(PressedLine {
            indentation: end.indentation,
            stiffness,
        });
    }
    states
}
