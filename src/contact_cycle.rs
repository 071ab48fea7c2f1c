//! Loading cycles for programs: a profile, a material and a work of adhesion under any loading history.

use crate::analysis::Figures;
use crate::contact::{
    self, Body, ContactError, CurvePoint, Foundation, HessRule, History, LegRecord, Patch, Reversal, run,
};
use crate::scene::{Edges, Material, Move};
use crate::simulation::RunError;
use crate::{Error, Profile};
use std::sync::Arc;

/// A rigid profile on an elastic half-space, with or without adhesion; the contact of a loading history is exact.
///
/// ```
/// use asperity::{Contact, Material, Move, Profile};
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
    contact: contact::Contact,
    samples: usize,
}

/// Properties of a [`Contact`] to be built.
#[derive(Clone, Debug)]
pub struct ContactBuilder<'p> {
    profile: &'p Profile,
    effective_modulus: f64,
    work: f64,
    closing_work: Option<f64>,
    loading_stiffness: f64,
    edges: Edges,
    samples: usize,
}

/// Result of a loading history that begins separated.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    history: History,
    figures: Figures,
}

impl Contact {
    /// Contact of a profile with a half-space of this material: by default without adhesion, with sub-cell edges
    /// and 512 samples on each loading stage.
    #[must_use]
    pub fn builder(profile: &Profile, material: Material) -> ContactBuilder<'_> {
        let effective_modulus = material.effective_modulus();
        let (edges, loading_stiffness) = (Edges::SubCell, f64::INFINITY);
        let (work, closing_work, samples) = (0.0, None, 512);
        ContactBuilder { profile, effective_modulus, work, closing_work, loading_stiffness, edges, samples }
    }

    /// Loads the separated body, one loading stage after the other.
    ///
    /// # Errors
    /// [`Error::Run`] for a force or an indentation that is not finite or that the contact cannot reach.
    pub fn load(&self, legs: &[Move]) -> Result<Cycle, Error> {
        let history = run(&mut self.body(), legs, |_, _| Ok(())).map_err(RunError::Contact)?;
        Ok(Cycle { figures: Figures::of(&history), history })
    }

    /// Loads the separated body once and unloads it from the ends of these stages, each of which begins at separation:
    /// the results of [`Contact::load`] for each stage followed by [`Move::ToSeparation`], at the cost of a few. A pulling force
    /// is an end as well: where the loading first reaches it, at touch or while adhesion draws the bodies together.
    ///
    /// The reversals have no [`Reversal::forces`].
    ///
    /// # Errors
    /// [`Error::Run`] for an end that is not finite, without contact, or out of reach.
    pub fn reversals(&self, ends: &[Move]) -> Result<Vec<Reversal>, Error> {
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
    /// Work of adhesion γ, J/m²; 0 for a contact without adhesion.
    #[must_use]
    pub fn work_of_adhesion(self, work: f64) -> Self {
        ContactBuilder { work, ..self }
    }

    /// Work of adhesion γ₁ on closing, J/m², at most that of [`ContactBuilder::work_of_adhesion`], which then holds
    /// on opening; by default both are equal.
    #[must_use]
    pub fn closing_work(self, work: f64) -> Self {
        ContactBuilder { closing_work: Some(work), ..self }
    }

    /// Stiffness k of the instrument that moves the body, N/m; by default infinite, a rigid one. Stages
    /// [`Move::ToDisplacement`] then prescribe D = d + F/k; see [`crate::analysis::DisplacementCurve`].
    #[must_use]
    pub fn loading_stiffness(self, stiffness: f64) -> Self {
        ContactBuilder { loading_stiffness: stiffness, ..self }
    }

    /// Edge model of the contact patches.
    #[must_use]
    pub fn edges(self, edges: Edges) -> Self {
        ContactBuilder { edges, ..self }
    }

    /// Samples of the force curve on each loading stage, at least 2; its extremes are exact for any number.
    #[must_use]
    pub fn samples(self, samples: u64) -> Self {
        ContactBuilder { samples: samples as usize, ..self }
    }

    /// Builds the contact.
    ///
    /// # Errors
    /// [`Error::Value`] for a value out of range, [`Error::Run`] without enough memory.
    pub fn build(self) -> Result<Contact, Error> {
        let ContactBuilder { profile, effective_modulus, work, loading_stiffness, edges, samples, .. } = self;
        let closing = self.closing_work.unwrap_or(work);
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let refuse = |name, value, allowed| Err(Error::Value { name, value, allowed });
        if !positive(effective_modulus) {
            return refuse("effective modulus", effective_modulus, "finite and above 0 Pa");
        }
        if !(work == 0.0 || positive(work)) {
            return refuse("work of adhesion", work, "finite and at least 0 J/m²");
        }
        if !(0.0..=work).contains(&closing) {
            return refuse("closing work", closing, "from 0 J/m² to the work of adhesion");
        }
        if loading_stiffness.is_nan() || loading_stiffness <= 0.0 {
            return refuse("loading stiffness", loading_stiffness, "above 0 N/m, infinite: rigid");
        }
        let foundation =
            Foundation { spacing: profile.spacing(), effective_modulus, length: profile.length() };
        let hess = (work > 0.0).then(|| HessRule::from_works(foundation, closing, work));
        let contact = contact::Contact::new(Arc::clone(&profile.line.gaps), edges, foundation, hess)
            .with_loading_stiffness(loading_stiffness);
        if hess.is_some() {
            contact.springs().tree(edges).map_err(|error: ContactError| RunError::Contact(error))?;
        }
        Ok(Contact { contact, samples })
    }
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

    #[test]
    fn reversals_are_those_of_loads_of_their_own() {
        let sphere = Profile::sphere(1e-4, 1e-4, 512).unwrap();
        let ends = [Move::ToForce(2e-4), Move::ToTouch, Move::ToIndentation(1e-6)];
        for (work, edges) in [(0.05, Edges::Grid), (0.05, Edges::SubCell), (0.0, Edges::SubCell)] {
            let contact =
                Contact::builder(&sphere, Material::effective(1e6)).work_of_adhesion(work).edges(edges);
            let contact = contact.build().unwrap();
            let reversals = contact.reversals(&ends).unwrap();
            for (end, reversal) in ends.iter().zip(&reversals) {
                let cycle = contact.load(&[*end, Move::ToSeparation]).unwrap();
                assert_eq!(reversal.adhesion_force(), cycle.pull_off_force());
                assert_eq!(Some(reversal.dissipated_energy), cycle.dissipated_energy());
            }
            assert!(contact.reversals(&[Move::ToSeparation]).is_err());
            assert_eq!(contact.reversals(&[]).unwrap(), []);
        }
    }
}
