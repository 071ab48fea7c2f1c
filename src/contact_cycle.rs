//! Loading cycles for programs: a profile, a material and a work of adhesion under any loading history.

use crate::analysis::{Figures, Governing};
use crate::contact::{
    AdhesiveMemory, ContactRule, ContactTree, CurvePoint, Exact, Foundation, HessRule, History, LegRecord,
    Reversal, Reversals, run,
};
use crate::scene::{Adhesion, Edges, Leg, Material, Numerics, SCENE_VERSIONS, Scene};
use crate::simulation::RunError;
use crate::{Error, Profile};

/// A rigid profile on an elastic half-space, with or without adhesion; the contact of a loading history is exact.
///
/// ```
/// use asperity::{Contact, Leg, Material, Profile};
///
/// let sphere = Profile::sphere(1.0e-4, 1.0e-4, 4096)?;
/// let mut contact = Contact::builder(&sphere, Material::effective(1.0e6)).work_of_adhesion(0.05).build()?;
/// let cycle = contact.load(&[Leg::ToForce(1.0e-4), Leg::ToSeparation])?;
/// // Johnson, Kendall and Roberts: (3/2)πγR.
/// let expected = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
/// assert!((cycle.pull_off_force().unwrap() / expected - 1.0).abs() < 1e-4);
/// assert!(cycle.dissipated_energy().unwrap() > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contact {
    gaps: Vec<f64>,
    foundation: Foundation,
    /// Rule of Hess and contact tree, with adhesion.
    adhesion: Option<(HessRule, ContactTree)>,
    edges: Edges,
    samples: usize,
    memory: AdhesiveMemory,
    /// Scene of the same contact, for the check of a loading.
    scene: Scene,
}

/// Properties of a [`Contact`] to be built.
#[derive(Clone, Debug)]
pub struct ContactBuilder<'p> {
    profile: &'p Profile,
    scene: Scene,
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
        let scene = Scene {
            version: *SCENE_VERSIONS.end(),
            title: String::new(),
            notice: String::new(),
            material,
            length: profile.length(),
            form: None,
            roughness: None,
            adhesion: None,
            loading: vec![Leg::ToTouch, Leg::ToSeparation],
            numerics: Numerics { points: profile.points() as u64, ..Numerics::default() },
            observe: Vec::new(),
        };
        ContactBuilder { profile, scene }
    }

    /// Loads the separated body, one loading stage after the other.
    ///
    /// # Errors
    /// [`Error::Values`] for a force or an indentation out of range, or for too many loading stages;
    /// [`Error::Run`] for a force that the contact cannot reach.
    pub fn load(&mut self, legs: &[Leg]) -> Result<Cycle, Error> {
        self.scene.loading = legs.to_vec();
        self.scene.check()?;
        let (memory, mut body) = self.body();
        let history = run(&mut body, legs, |_, _| Ok(()));
        body.give_back(memory);
        let history = history.map_err(RunError::Contact)?;
        Ok(Cycle { figures: Figures::of(&history), history })
    }

    /// Loads the separated body once and unloads it from the ends of these stages, each of which begins at separation:
    /// the results of [`Contact::load`] for each stage followed by [`Leg::ToSeparation`], at the cost of a few.
    ///
    /// # Errors
    /// [`Error::Values`] for a force or an indentation out of range, [`Error::Run`] for an end that the contact cannot
    /// reach, or without contact.
    pub fn reversals(&mut self, ends: &[Leg]) -> Result<Vec<Reversal>, Error> {
        for leg in ends {
            self.scene.loading = vec![*leg, Leg::ToSeparation];
            self.scene.check()?;
        }
        let (memory, body) = self.body();
        let mut reversals = Reversals::new(body, ends).map_err(RunError::Contact)?;
        let found = reversals.all();
        reversals.into_body().give_back(memory);
        Ok(found.map_err(RunError::Contact)?)
    }

    /// The separated body and the memory that takes back its arrays.
    fn body(&mut self) -> (&mut AdhesiveMemory, Exact<'_>) {
        let Contact { gaps, foundation, adhesion, edges, samples, memory, .. } = self;
        let rule = match adhesion {
            Some((hess, tree)) => ContactRule::Hess(*hess, tree),
            None => ContactRule::Nonadhesive(*edges),
        };
        let body = Exact::new(memory, gaps, rule, *foundation, *samples);
        (memory, body)
    }
}

impl ContactBuilder<'_> {
    /// Work of adhesion γ, J/m²; 0 for a contact without adhesion.
    #[must_use]
    pub fn work_of_adhesion(mut self, work: f64) -> Self {
        self.scene.adhesion = Some(Adhesion { work: Some(work), ..self.scene.adhesion.unwrap_or_default() });
        self
    }

    /// Work of adhesion γ₁ on closing, J/m², at most that of [`ContactBuilder::work_of_adhesion`], which then holds
    /// on opening; by default both are equal.
    #[must_use]
    pub fn closing_work(mut self, work: f64) -> Self {
        self.scene.adhesion =
            Some(Adhesion { closing_work: Some(work), ..self.scene.adhesion.unwrap_or_default() });
        self
    }

    /// Edge model of the contact patches.
    #[must_use]
    pub fn edges(mut self, edges: Edges) -> Self {
        self.scene.numerics.edges = edges;
        self
    }

    /// Samples of the force curve on each loading stage; its extremes are exact for any number.
    #[must_use]
    pub fn samples(mut self, samples: u64) -> Self {
        self.scene.numerics.samples = samples;
        self
    }

    /// Builds the contact.
    ///
    /// # Errors
    /// [`Error::Values`] for a value out of range, [`Error::Run`] without enough memory.
    pub fn build(self) -> Result<Contact, Error> {
        let ContactBuilder { profile, scene } = self;
        scene.check()?;
        let (edges, samples) = (scene.numerics.edges, scene.numerics.samples as usize);
        let foundation = Foundation {
            spacing: profile.spacing(),
            effective_modulus: scene.material.effective_modulus(),
            length: profile.length(),
        };
        let adhesion = Governing::of(&scene, None, None)
            .hess_rule(foundation)
            .map(|hess| Ok((hess, ContactTree::build(profile.gaps(), edges)?)))
            .transpose()
            .map_err(RunError::Contact)?;
        let gaps = profile.gaps().to_vec();
        Ok(Contact { gaps, foundation, adhesion, edges, samples, memory: AdhesiveMemory::default(), scene })
    }
}

impl Cycle {
    /// Pull-off force, N: minus the smallest force on the last unloading stage; `None` without a tensile force.
    #[must_use]
    pub fn pull_off_force(&self) -> Option<f64> {
        self.figures.adhesion_force
    }

    /// Indentation at the pull-off force, m.
    #[must_use]
    pub fn pull_off_indentation(&self) -> Option<f64> {
        self.figures.pull_off_indentation
    }

    /// Preload, N: largest force of the loading stages.
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

    /// First and last point of each contact patch at the end, from left to right.
    #[must_use]
    pub fn patches(&self) -> &[(usize, usize)] {
        &self.history.contacts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reversals_are_those_of_loads_of_their_own() {
        let sphere = Profile::sphere(1e-4, 1e-4, 512).unwrap();
        let ends = [Leg::ToForce(2e-4), Leg::ToTouch, Leg::ToIndentation(1e-6)];
        for (work, edges) in [(0.05, Edges::Grid), (0.05, Edges::SubCell), (0.0, Edges::SubCell)] {
            let contact =
                Contact::builder(&sphere, Material::effective(1e6)).work_of_adhesion(work).edges(edges);
            let mut contact = contact.build().unwrap();
            let reversals = contact.reversals(&ends).unwrap();
            for (end, reversal) in ends.iter().zip(&reversals) {
                let cycle = contact.load(&[*end, Leg::ToSeparation]).unwrap();
                assert_eq!(reversal.adhesion_force(), cycle.pull_off_force());
                assert_eq!(Some(reversal.dissipated_energy), cycle.dissipated_energy());
            }
            assert!(contact.reversals(&[Leg::ToForce(-1.0)]).is_err());
            assert_eq!(contact.reversals(&[]).unwrap(), []);
        }
    }
}
