//! Contacts for programs that use the library: a profile, a material and a work of adhesion under any loading history.

use crate::analysis::figures::Figures;
use crate::error::Error;
use crate::profile::Profile;
use crate::profile::{LARGEST, check, is_positive};
use crate::scene::model::Material;
use crate::simulation::outcome::RunError;
use asperity_contact::{
    Body, ContactError, CurvePoint, Foundation, HessRule, History, LegRecord, Patch, Reversal, run,
};
use asperity_contact::{Edges, Move};
use std::sync::Arc;

/// A rigid profile on an elastic half-space, with or without adhesion. Loading it gives exact forces, without a step error.
///
/// ```
/// use asperity_scene::{Contact, Material, Profile};
/// use asperity_contact::Move;
///
/// let sphere = Profile::sphere(1.0e-4, 1.0e-4, 4096)?;
/// let contact = Contact::builder(&sphere, Material::effective(1.0e6)).work_of_adhesion(0.05).build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// // Johnson, Kendall and Roberts: (3/2)πγR.
/// let expected = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
/// assert!((cycle.pull_off_force().unwrap() / expected - 1.0).abs() < 1e-4);
/// assert!(cycle.dissipated_energy().unwrap() > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contact {
    contact: asperity_contact::Contact,
    samples: usize,
}

/// Properties of a [`Contact`] that is being built.
#[derive(Clone, Debug)]
pub struct ContactBuilder<'p> {
    profile: &'p Profile,
    material: Material,
    work: f64,
    closing_work: Option<f64>,
    loading_stiffness: f64,
    edges: Edges,
    samples: u64,
}

/// Result of a loading history that begins separated.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    history: History,
    figures: Figures,
}

impl Contact {
    /// Begins a contact of a profile with a half-space of this material; by default without adhesion, with edges between
    /// springs, a rigid instrument, and 512 samples on each loading stage.
    #[must_use]
    pub fn builder(profile: &Profile, material: Material) -> ContactBuilder<'_> {
        let (edges, loading_stiffness) = (Edges::SubCell, f64::INFINITY);
        let (work, closing_work, samples) = (0.0, None, 512);
        ContactBuilder { profile, material, work, closing_work, loading_stiffness, edges, samples }
    }

    /// Loads the separated body through these loading stages, one after the other.
    ///
    /// # Errors
    /// [`Error::Value`] for a target that is not between −1e50 and 1e50, [`Error::Run`] for a target that the contact
    /// cannot reach.
    pub fn load(&self, legs: &[Move]) -> Result<Cycle, Error> {
        check_targets(legs)?;
        let history = run(&mut self.body(), legs, |_, _| Ok(())).map_err(RunError::Contact)?;
        Ok(Cycle { figures: Figures::of(&history), history })
    }

    /// Loads the separated body once, and unloads it from the end of each of these stages, every one of which begins at
    /// separation. The results equal [`Contact::load`] of each stage followed by [`Move::ToSeparation`], at the cost of a
    /// few loads. A tensile force is reached where the loading first has it, at touch or while adhesion draws the bodies
    /// together.
    ///
    /// The field [`Reversal::forces`] of the results is empty.
    ///
    /// # Errors
    /// [`Error::Value`] for a target that is not between −1e50 and 1e50, [`Error::Run`] for a target without contact or out
    /// of reach.
    pub fn reversals(&self, ends: &[Move]) -> Result<Vec<Reversal>, Error> {
        check_targets(ends)?;
        let mut found: Vec<(usize, Reversal)> = Vec::with_capacity(ends.len());
        let mut see = |index, reversal| {
            found.push((index, reversal));
            Ok(())
        };
        self.body().reversals(ends, &[], &mut see).map_err(RunError::Contact)?;
        found.sort_by_key(|&(index, _)| index);
        Ok(found.into_iter().map(|(_, reversal)| reversal).collect())
    }

    fn body(&self) -> Body {
        Body::new(&self.contact, self.samples)
    }
}

impl ContactBuilder<'_> {
    /// Sets the work of adhesion γ, J/m²; 0 for a contact without adhesion.
    #[must_use]
    pub fn work_of_adhesion(self, work: f64) -> Self {
        ContactBuilder { work, ..self }
    }

    /// Sets the work of adhesion γ₁ on closing, J/m², at most the [`ContactBuilder::work_of_adhesion`], which then holds on
    /// opening; by default both are equal.
    #[must_use]
    pub fn closing_work(self, work: f64) -> Self {
        ContactBuilder { closing_work: Some(work), ..self }
    }

    /// Sets the stiffness k of the instrument that moves the body, N/m; by default infinite, a rigid instrument. Stages
    /// [`Move::ToDisplacement`] then prescribe D = d + F/k; see [`crate::analysis::instrument::DisplacementCurve`].
    #[must_use]
    pub fn loading_stiffness(self, stiffness: f64) -> Self {
        ContactBuilder { loading_stiffness: stiffness, ..self }
    }

    /// Sets the edge model of the contact patches.
    #[must_use]
    pub fn edges(self, edges: Edges) -> Self {
        ContactBuilder { edges, ..self }
    }

    /// Sets the number of samples of the force curve on each loading stage, from 2 to a million; extremes of the force are
    /// exact for any number.
    #[must_use]
    pub fn samples(self, samples: u64) -> Self {
        ContactBuilder { samples, ..self }
    }

    /// Builds the contact.
    ///
    /// # Errors
    /// [`Error::Value`] for a value out of range, [`Error::Run`] for lack of memory.
    pub fn build(self) -> Result<Contact, Error> {
        let ContactBuilder { profile, work, loading_stiffness, edges, samples, .. } = self;
        let effective_modulus = checked_modulus(self.material)?;
        let closing = self.closing_work.unwrap_or(work);
        check("work of adhesion", work, (0.0..=LARGEST).contains(&work), "from 0 to 1e50 J/m²")?;
        let is_allowed = (0.0..=work).contains(&closing);
        check("closing work", closing, is_allowed, "from 0 J/m² to the work of adhesion")?;
        let is_allowed = loading_stiffness == f64::INFINITY || is_positive(loading_stiffness);
        check(
            "loading stiffness",
            loading_stiffness,
            is_allowed,
            "from 1e-50 to 1e50 N/m, or infinite: rigid",
        )?;
        check("samples", samples as f64, (2..=1_000_000).contains(&samples), "from 2 to 1000000")?;
        let foundation =
            Foundation { spacing: profile.spacing(), effective_modulus, length: profile.length() };
        let hess = (work > 0.0).then(|| HessRule::from_works(foundation, closing, work));
        let contact = asperity_contact::Contact::new(Arc::clone(&profile.line.gaps), edges, foundation, hess)
            .with_loading_stiffness(loading_stiffness);
        if hess.is_some() {
            contact.springs().tree(edges).map_err(|error: ContactError| RunError::Contact(error))?;
        }
        Ok(Contact { contact, samples: samples as usize })
    }
}

/// Effective modulus E* of a material, Pa, given as E* or as E and ν.
fn checked_modulus(material: Material) -> Result<f64, Error> {
    let Material { youngs_modulus, poisson_ratio, effective_modulus } = material;
    let pascals = "from 1e-50 to 1e50 Pa";
    if let Some(modulus) = effective_modulus {
        let is_alone = youngs_modulus.is_none() && poisson_ratio.is_none();
        let allowed = "alone: it replaces Young's modulus and Poisson's ratio";
        check("effective modulus", modulus, is_alone, allowed)?;
        check("effective modulus", modulus, is_positive(modulus), pascals)?;
        return Ok(modulus);
    }
    let [modulus, ratio] = [youngs_modulus, poisson_ratio].map(|value| value.unwrap_or(f64::NAN));
    check("Young's modulus", modulus, is_positive(modulus), pascals)?;
    check("Poisson's ratio", ratio, ratio > -1.0 && ratio <= 0.5, "above -1 and at most 0.5")?;
    Ok(material.effective_modulus())
}

/// Returns an error for a target with which a result might not be a finite number.
fn check_targets(targets: &[Move]) -> Result<(), Error> {
    for (index, target) in targets.iter().enumerate() {
        if let Move::ToForce(value) | Move::ToIndentation(value) | Move::ToDisplacement(value) = *target {
            let name = format!("target of stage {}", index + 1);
            check(&name, value, value.abs() <= LARGEST, "from -1e50 to 1e50")?;
        }
    }
    Ok(())
}

impl Cycle {
    /// Pull-off force, N: minus the smallest force of the last unloading, which may take several stages. `None` if that force
    /// is above zero, or if the unloading ends in contact while the force still falls.
    #[must_use]
    pub fn pull_off_force(&self) -> Option<f64> {
        self.figures.adhesion_force
    }

    /// Indentation at the pull-off force, m.
    #[must_use]
    pub fn pull_off_indentation(&self) -> Option<f64> {
        self.figures.pull_off_indentation
    }

    /// Preload, N: largest force while loading, since the last separation and before the last unloading.
    #[must_use]
    pub fn preload(&self) -> Option<f64> {
        self.figures.preload
    }

    /// Dissipated energy of a history that ends separated, J.
    #[must_use]
    pub fn dissipated_energy(&self) -> Option<f64> {
        self.figures.dissipated_energy
    }

    /// Force curve of all loading stages in their order.
    pub fn curve(&self) -> impl Iterator<Item = &CurvePoint> {
        self.history.legs.iter().flat_map(|leg| &leg.curve)
    }

    /// Loading stages with their curves, exact extremes and dissipated energies.
    #[must_use]
    pub fn legs(&self) -> &[LegRecord] {
        &self.history.legs
    }

    /// Contact patches at the end, from left to right.
    #[must_use]
    pub fn patches(&self) -> &[Patch] {
        &self.history.contacts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_surface::phases;
    use std::f64::consts::TAU;

    #[test]
    fn wrong_values_are_named_with_what_is_allowed() {
        let sphere = Profile::sphere(1e-4, 1e-4, 64).unwrap();
        let builder = |material| Contact::builder(&sphere, material);
        let (soft, pascals) = (Material::effective(1e6), "allowed: from 1e-50 to 1e50 Pa");
        let refused = |builder: ContactBuilder<'_>| builder.build().unwrap_err().to_string();
        for (message, expected) in [
            (
                refused(builder(Material::isotropic(1e6, 0.7))),
                "Poisson's ratio = 0.7; allowed: above -1 and at most 0.5",
            ),
            (
                refused(builder(Material { youngs_modulus: Some(1e6), ..soft })),
                "effective modulus = 1000000; allowed: alone: it replaces Young's modulus and Poisson's ratio",
            ),
            (refused(builder(Material::default())), &format!("Young's modulus = NaN; {pascals}")),
            (refused(builder(Material::effective(1e100))), &format!("effective modulus = 1e100; {pascals}")),
            (
                refused(builder(soft).work_of_adhesion(1e100)),
                "work of adhesion = 1e100; allowed: from 0 to 1e50 J/m²",
            ),
            (refused(builder(soft).samples(0)), "samples = 0; allowed: from 2 to 1000000"),
            (
                refused(builder(soft).samples(u64::MAX)),
                "samples = 1.8446744073709552e19; allowed: from 2 to 1000000",
            ),
        ] {
            assert_eq!(message, expected);
        }
        let contact = builder(soft).build().unwrap();
        for target in [1e100, f64::NAN] {
            let refused = contact.load(&[Move::ToTouch, Move::ToForce(target)]).unwrap_err().to_string();
            assert!(refused.starts_with("target of stage 2 = "), "{refused}");
        }
    }

    /// Every accepted value, of any allowed magnitude, gives finite results.
    #[test]
    fn no_result_is_other_than_a_finite_number() {
        for seed in 0..600 {
            let mut numbers = phases(seed, 1).map(|phase| phase / TAU);
            let mut next = || numbers.next().unwrap_or(0.5);
            let mut size = |least: f64| 10.0_f64.powf(least + (50.0 - least) * next());
            let (height, spacing, modulus, work) = (size(-300.0), size(-50.0), size(-50.0), size(-300.0));
            let targets = [size(-300.0), size(-50.0)];
            let heights: Vec<f64> = (0..5).map(|_| height * next()).collect();
            let Ok(profile) = Profile::from_heights(&heights, spacing) else { continue };
            let edges = if next() < 0.5 { Edges::Grid } else { Edges::SubCell };
            let contact = Contact::builder(&profile, Material::effective(modulus)).edges(edges).samples(4);
            let contact = contact.work_of_adhesion(if next() < 0.1 { 0.0 } else { work }).build().unwrap();
            let press =
                if next() < 0.5 { Move::ToForce(targets[0]) } else { Move::ToIndentation(targets[1]) };
            for first in [press, Move::ToTouch, Move::ToZeroForce] {
                let found = format!("{:?}", contact.load(&[first, Move::ToSeparation]));
                assert!(!found.contains("NaN") && !found.contains("inf"), "{seed}: {heights:?} {found}");
                let found = format!("{:?}", contact.reversals(&[first]));
                assert!(!found.contains("NaN") && !found.contains("inf"), "{seed}: {heights:?} {found}");
            }
        }
    }
}
