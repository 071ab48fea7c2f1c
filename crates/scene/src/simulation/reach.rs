//! Loading stages that press the body deeper than the model computes. The error message names the
//! reason and the nearest allowed target.

use crate::scene::field::target_field;
use asperity_contact::{Contact, Move};
use asperity_data::{format_quantity, rounded_up};
use thiserror::Error;

/// Deepest state up to which a loading is computed. The deepest state is one length of the profile
/// deeper than full contact, where the last spring touches.
///
/// ```
/// use asperity_contact::Move;
/// use asperity_scene::{Simulation, open};
///
/// let reach = Simulation::default().reach(open("jkr-sphere")?.scene())?;
/// assert!(
///     reach
///         .refusal(Move::ToForce(2.0 * reach.force))
///         .unwrap()
///         .contains("far beyond full contact")
/// );
/// assert_eq!(reach.refusal(Move::ToForce(0.5 * reach.force)), None);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Force in N and indentation in m at which the last spring touches.
    pub full_contact: (f64, f64),
    /// Largest force in N up to which a loading is computed.
    pub force: f64,
    /// Largest indentation in m up to which a loading is computed.
    pub indentation: f64,
    /// Largest displacement of the instrument in m up to which a loading is computed.
    pub displacement: f64,
}

impl Reach {
    /// Returns the deepest state up to which loadings of this contact are computed.
    pub fn of(contact: &Contact) -> Reach {
        let length = contact.profile().length();
        let full_contact_force = contact.full_contact_force();
        let full_contact_indentation = contact.profile().deepest();
        let force = full_contact_force + force_of_a_length(contact);
        let indentation = full_contact_indentation + length;
        Reach {
            full_contact: (full_contact_force, full_contact_indentation),
            force,
            indentation,
            displacement: contact.displacement(indentation, force),
        }
    }

    /// Returns an error message if the loading stage `stage` ends deeper than loadings are
    /// computed; otherwise `None`.
    pub fn refusal(&self, stage: Move) -> Option<String> {
        self.beyond(stage).map(|beyond| beyond.to_string())
    }

    /// Returns the error of a loading stage that ends beyond the deepest state; otherwise `None`.
    pub fn beyond(&self, stage: Move) -> Option<BeyondFullContact> {
        let (field, found) = target_field(stage)?;
        let (force, indentation) = self.full_contact;
        let (full_contact, most) = match stage {
            Move::ToForce(_) => (force, self.force),
            Move::ToDisplacement(_) => (indentation, self.displacement),
            _ => (indentation, self.indentation),
        };
        (found > most).then_some(BeyondFullContact {
            found,
            full_contact,
            allowed: -rounded_up(-most),
            unit: field.unit,
        })
    }
}

/// Error of a loading stage that presses the body beyond full contact by more than the length of
/// the profile.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "{} is far beyond full contact at {}, deeper by more than the length of the profile; allowed: at most {}",
    format_quantity(*found, unit),
    format_quantity(*full_contact, unit),
    format_quantity(*allowed, unit)
)]
pub struct BeyondFullContact {
    /// Target value of the stage, in `unit`: the force, indentation or displacement that should end
    /// the stage.
    pub found: f64,
    /// Force, indentation or displacement at full contact, in `unit`.
    pub full_contact: f64,
    /// Largest allowed target value, in `unit`, rounded down to four digits.
    pub allowed: f64,
    /// SI unit of the three values, N or m.
    pub unit: &'static str,
}

/// Returns an error if a stage of the loading ends beyond the deepest state.
pub(super) fn check(contact: &Contact, loading: &[Move]) -> Result<(), BeyondFullContact> {
    if loading.iter().all(|stage| is_near(contact, *stage)) {
        return Ok(());
    }
    let reach = Reach::of(contact);
    let deepest = loading
        .iter()
        .filter_map(|stage| reach.beyond(*stage))
        .max_by(|one, other| one.found.total_cmp(&other.found));
    match deepest {
        Some(beyond) => Err(beyond),
        None => Ok(()),
    }
}

/// Returns true if a stage ends before the deepest state even if full contact were already at first
/// touch. The function returns true for most stages, for which the deepest state is then not
/// computed.
fn is_near(contact: &Contact, stage: Move) -> bool {
    match stage {
        Move::ToForce(force) => force <= force_of_a_length(contact),
        Move::ToIndentation(end) | Move::ToDisplacement(end) => end <= contact.profile().length(),
        Move::ToTouch | Move::ToZeroForce | Move::ToSeparation | Move::Hold(_) => true,
    }
}

/// Returns the force in N by which the force grows from full contact to the deepest state, one
/// length of the profile deeper.
fn force_of_a_length(contact: &Contact) -> f64 {
    contact.spring_stiffness() * contact.gaps().len() as f64 * contact.profile().length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::document::Document;
    use crate::scene::open::open;
    use crate::simulation::outcome::{Outcome, RunError};
    use crate::simulation::stages::Simulation;

    fn run(document: &Document, stage: Move) -> Result<Outcome, RunError> {
        let document = document.with_stages(&[(None, stage)]).unwrap();
        Simulation::default().compute(document.scene())
    }

    #[test]
    fn a_body_is_pressed_at_most_its_length_deeper_than_at_full_contact() {
        for (name, field) in [
            ("pressure-sensitive", ("adhesion", "(kappa: 6.0)")),
            ("pressure-sensitive", ("adhesion", "None")),
            ("pressure-sensitive", ("loading_stiffness", "40.0")),
            // With so small a roughness, the force at full contact is only a thousandth of the
            // force that presses the body.
            ("pressure-sensitive", ("roughness.rms_height", "1.0e-12")),
            ("jkr-sphere", ("numerics.edges", "SubCell")),
            ("kendall-punch", ("numerics.edges", "Grid")),
        ] {
            let document = open(name).unwrap().set("numerics.points", "2048").unwrap();
            let document = document.set(field.0, field.1).unwrap();
            let reach = Simulation::default().reach(document.scene()).unwrap();
            let length = document.scene().length;
            assert!((reach.indentation / (reach.full_contact.1 + length) - 1.0).abs() < 1e-12);
            for (stage, most) in [
                (Move::ToForce as fn(f64) -> Move, reach.force),
                (Move::ToIndentation, reach.indentation),
                (Move::ToDisplacement, reach.displacement),
            ] {
                // The deepest state itself is computed, and all kinds of stages lead to the same
                // state.
                let deepest = run(&document, stage(most)).unwrap().history.stages[0].largest;
                assert!(
                    (deepest.force / reach.force - 1.0).abs() < 1e-6,
                    "{name} {field:?} {deepest:?}"
                );
                assert!(
                    (deepest.indentation / reach.indentation - 1.0).abs() < 1e-6,
                    "{name} {field:?}"
                );
                let refused = run(&document, stage(1.001 * most)).unwrap_err().to_string();
                assert!(
                    refused.contains(" is far beyond full contact at ")
                        && refused.contains("; allowed: at most "),
                    "{refused}"
                );
            }
        }
    }
}
