//! The contact of a rigid profile with an elastic half-space. A contact combines the properties
//! that remain the same while the body moves: profile, modulus and adhesion.

use super::adhesive::levels::Edges;
use super::adhesive::loading::Closing;
use super::detachment::{ContactRule, Rules};
use super::error::{ContactError, LARGEST, check, is_positive};
use super::foundation::Foundation;
use super::history::{CurvePoint, Patch};
use super::modulus::Modulus;
use super::profile::Profile;
use super::relaxation::law::Relaxation;
use std::sync::{Arc, OnceLock};

/// A rigid profile on an elastic half-space, with or without adhesion.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// // On the line the gaps of a sphere of radius R are x²/R.
/// let gaps: Vec<f64> = (-512..=512)
///     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
///     .collect();
/// let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// // Johnson, Kendall and Roberts: (3/2)πγR.
/// let expected = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
/// assert!((cycle.pull_off_force().unwrap() / expected - 1.0).abs() < 1e-4);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contact {
    pub(super) profile: Profile,
    pub(super) foundation: Foundation,
    pub(super) edges: Edges,
    /// Works of adhesion on closing and on opening, J/m².
    works: [f64; 2],
    /// Rules of attachment and detachment; `None` without adhesion.
    rules: Option<Rules<ContactRule>>,
    /// Stiffness k in N/m of the instrument that moves the body; infinite for a rigid instrument.
    pub(super) loading_stiffness: f64,
    /// Relaxation of the foundation; `None` for an elastic foundation.
    relaxing: Option<Relaxing>,
    closing: Arc<OnceLock<Closing>>,
}

/// Relaxation of the foundation, and the speed at which time passes while the body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relaxing {
    pub relaxation: Relaxation,
    /// Speed in m/s of the drive of the instrument.
    pub speed: f64,
}

/// Builder that sets the properties of a [`Contact`].
///
/// ```
/// use asperity_contact::{Contact, Edges, Modulus, Profile};
///
/// let profile = Profile::from_gaps(vec![0.0, 4.0e-8, 1.0e-8], 1.0e-6)?;
/// let builder = Contact::builder(&profile, Modulus::effective(1.0e6)?);
/// let soft = builder
///     .clone()
///     .works_of_adhesion([1.0e-4, 2.0e-4])
///     .loading_stiffness(50.0)
///     .edges(Edges::Grid);
/// assert!(soft.build()?.has_adhesion());
/// let refused = builder
///     .works_of_adhesion([2.0e-4, 1.0e-4])
///     .build()
///     .unwrap_err();
/// assert_eq!(
///     refused.to_string(),
///     "closing work = 2e-4; allowed: from 0 J/m² to the work of adhesion"
/// );
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContactBuilder {
    profile: Profile,
    modulus: Modulus,
    /// Works of adhesion on closing and on opening, J/m².
    works: [f64; 2],
    loading_stiffness: f64,
    edges: Edges,
    relaxation: Option<Relaxation>,
    loading_speed: Option<f64>,
}

impl ContactBuilder {
    /// Sets the work of adhesion γ in J/m². The default is 0, a contact without adhesion.
    #[must_use]
    pub fn work_of_adhesion(self, work: f64) -> Self {
        self.works_of_adhesion([work; 2])
    }

    /// Sets two works of adhesion `[γ₁, γ]` in J/m². γ₁ is the energy per area that is gained where
    /// the interface closes. γ is the energy per area that is spent where the interface opens. γ₁
    /// must not exceed γ.
    #[must_use]
    pub fn works_of_adhesion(self, works: [f64; 2]) -> Self {
        ContactBuilder { works, ..self }
    }

    /// Sets the stiffness k of the instrument that moves the body, in N/m. The default is infinite,
    /// a rigid instrument.
    #[must_use]
    pub fn loading_stiffness(self, stiffness: f64) -> Self {
        ContactBuilder {
            loading_stiffness: stiffness,
            ..self
        }
    }

    /// Sets the edge model: where the edges of contact patches may lie. The default is
    /// [`Edges::SubCell`], anywhere between springs.
    #[must_use]
    pub fn edges(self, edges: Edges) -> Self {
        ContactBuilder { edges, ..self }
    }

    /// Sets the relaxation of the foundation. The modulus of the contact is then the instantaneous
    /// modulus, before any relaxation. With a share of zero the foundation remains elastic.
    #[must_use]
    pub fn relaxation(self, relaxation: Relaxation) -> Self {
        ContactBuilder {
            relaxation: Some(relaxation),
            ..self
        }
    }

    /// Sets the speed in m/s at which the drive of the instrument moves. If the instrument is
    /// rigid, this is the speed of the body. A contact with relaxation needs a speed. Without
    /// relaxation the speed has no effect.
    #[must_use]
    pub fn loading_speed(self, speed: f64) -> Self {
        ContactBuilder {
            loading_speed: Some(speed),
            ..self
        }
    }

    /// Builds the contact. Each property that the caller has not set has its default value.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a value out of its range.
    pub fn build(self) -> Result<Contact, ContactError> {
        let ContactBuilder {
            profile,
            modulus,
            works: [closing, work],
            loading_stiffness,
            edges,
            relaxation,
            loading_speed,
        } = self;
        let is_allowed = (0.0..=LARGEST).contains(&work);
        let allowed = "from 0 to 1e50 J/m²";
        check("work of adhesion", work, is_allowed, allowed)?;
        let is_allowed = (0.0..=work).contains(&closing);
        let allowed = "from 0 J/m² to the work of adhesion";
        check("closing work", closing, is_allowed, allowed)?;
        let is_allowed = loading_stiffness == f64::INFINITY || is_positive(loading_stiffness);
        let allowed = "from 1e-50 to 1e50 N/m, or infinite: rigid";
        check("loading stiffness", loading_stiffness, is_allowed, allowed)?;
        let relaxing = relaxing(relaxation, loading_speed, edges)?;
        let foundation = Foundation {
            spacing: profile.spacing,
            modulus: modulus.pascals(),
            length: profile.length,
        };
        let rules =
            (work > 0.0).then(|| Rules::<ContactRule>::from_works(foundation, closing, work));
        Ok(Contact {
            profile,
            foundation,
            edges,
            works: [closing, work],
            rules,
            loading_stiffness,
            relaxing,
            closing: Arc::default(),
        })
    }
}

impl Contact {
    /// Creates a builder for the contact of a profile with a half-space of this modulus.
    #[must_use]
    pub fn builder(profile: &Profile, modulus: Modulus) -> ContactBuilder {
        ContactBuilder {
            profile: profile.clone(),
            modulus,
            works: [0.0; 2],
            loading_stiffness: f64::INFINITY,
            edges: Edges::SubCell,
            relaxation: None,
            loading_speed: None,
        }
    }

    /// Returns a copy of the contact for the stepwise solver. In the copy, patches consist of whole
    /// springs, and the instrument is rigid.
    pub(super) fn of_whole_springs(&self) -> Self {
        Contact {
            edges: Edges::Grid,
            loading_stiffness: f64::INFINITY,
            relaxing: None,
            closing: Arc::default(),
            ..self.clone()
        }
    }

    /// Returns this contact with another profile.
    pub(super) fn with_profile(&self, profile: Profile) -> Self {
        let foundation = Foundation {
            spacing: profile.spacing,
            length: profile.length,
            ..self.foundation
        };
        let [closing, work] = self.works;
        let rules = self
            .rules
            .map(|_| Rules::<ContactRule>::from_works(foundation, closing, work));
        Contact {
            profile,
            foundation,
            rules,
            closing: Arc::default(),
            ..self.clone()
        }
    }

    /// Creates a builder for a contact with the profile and the edge model of this contact, but
    /// with another modulus. The edge model states where the edges of contact patches may lie. The
    /// new contact has no adhesion and a rigid instrument unless the builder sets them.
    ///
    /// ```
    /// use asperity_contact::{Contact, Modulus, Move, Profile};
    ///
    /// # let gaps: Vec<f64> = (-512..=512)
    /// #     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
    /// #     .collect();
    /// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
    /// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
    /// #     .work_of_adhesion(0.05)
    /// #     .build()?;
    /// let stiffer = contact
    ///     .with(Modulus::effective(1.0e7)?)
    ///     .work_of_adhesion(0.05)
    ///     .build()?;
    /// let pull_off = |contact: &Contact| contact.reversals(&[Move::ToForce(1.0e-4)], &[]);
    /// // The pull-off force of a sphere does not depend on its modulus.
    /// let [soft, hard] =
    ///     [pull_off(&contact)?, pull_off(&stiffer)?].map(|found| found[0].smallest.force);
    /// assert!((soft / hard - 1.0).abs() < 1e-3);
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    #[must_use]
    pub fn with(&self, modulus: Modulus) -> ContactBuilder {
        Contact::builder(&self.profile, modulus).edges(self.edges)
    }

    /// Returns the force in N at which the last spring touches the profile on a loading without
    /// adhesion.
    ///
    /// ```
    /// use asperity_contact::{Contact, Modulus, Profile};
    ///
    /// let profile = Profile::from_gaps(vec![0.0, 2.0e-8], 1.0e-6)?;
    /// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).build()?;
    /// // One spring of 1 N/m is compressed by 20 nm when the other touches.
    /// assert!((contact.full_contact_force() - 2.0e-8).abs() < 1e-20);
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn full_contact_force(&self) -> f64 {
        let deepest = self.profile.deepest();
        let compression: f64 = self.gaps().iter().map(|gap| deepest - gap).sum();
        self.spring_stiffness() * compression
    }

    /// Returns the displacement D = d + F/k in m of the drive of the instrument. d = `indentation`
    /// is in m, F = `force` is in N, and k is the stiffness of the instrument in N/m.
    pub fn displacement(&self, indentation: f64, force: f64) -> f64 {
        indentation + force / self.loading_stiffness
    }

    /// Returns the profile of the rigid body in contact.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Returns the gap of each spring in m: how far the profile at this spring lies below the
    /// highest point of the profile.
    pub fn gaps(&self) -> &[f64] {
        self.profile.gaps()
    }

    /// Returns the edge model: where the edges of contact patches may lie.
    pub fn edges(&self) -> Edges {
        self.edges
    }

    /// Returns the effective modulus E* in Pa.
    pub fn modulus_in_pascals(&self) -> f64 {
        self.foundation.modulus
    }

    /// Returns the stiffness Δk = E* Δx of one spring in N/m, eq. (1) of Popov and Filippov (2012).
    pub fn spring_stiffness(&self) -> f64 {
        self.foundation.spring_stiffness()
    }

    /// Returns the contact radius in m: half the distance between the outermost edges of the
    /// contact. It is zero in separation. `patches` are the contact patches at the point `point` of
    /// the force curve.
    pub fn contact_radius(&self, patches: &[Patch], point: CurvePoint) -> f64 {
        self.foundation.contact_radius(patches, point)
    }

    /// Returns the relaxation of the foundation; `None` for an elastic foundation.
    pub fn relaxation(&self) -> Option<Relaxation> {
        self.relaxing.map(|relaxing| relaxing.relaxation)
    }

    pub(super) fn relaxing(&self) -> Option<Relaxing> {
        self.relaxing
    }

    /// Returns true if the contact has adhesion: its work of adhesion on opening is above zero.
    pub fn has_adhesion(&self) -> bool {
        self.rules.is_some()
    }

    /// Returns the rules of attachment and detachment. Without adhesion, the rules allow no
    /// stretch.
    pub(super) fn rules(&self) -> Rules<ContactRule> {
        self.rules.unwrap_or(Rules::<ContactRule>::NO_ADHESION)
    }

    /// Returns the closing thresholds: the indentations at which the nodes of the contact tree
    /// close on a loading from separation. A node is a local maximum of the gap. The first call
    /// computes the thresholds with `close` and stores them.
    pub(super) fn closing(
        &self,
        close: impl FnOnce() -> Result<Closing, ContactError>,
    ) -> Result<&Closing, ContactError> {
        if let Some(closing) = self.closing.get() {
            return Ok(closing);
        }
        let closing = close()?;
        Ok(self.closing.get_or_init(|| closing))
    }
}

/// Returns an error if the drive of the instrument cannot have this speed in m/s.
pub(crate) fn check_speed(speed: f64) -> Result<(), ContactError> {
    let allowed = "from 1e-50 to 1e50 m/s";
    check("loading speed", speed, is_positive(speed), allowed)
}

/// Checks the relaxation of the foundation and the loading speed. Returns `None` if the foundation
/// is elastic.
fn relaxing(
    relaxation: Option<Relaxation>,
    speed: Option<f64>,
    edges: Edges,
) -> Result<Option<Relaxing>, ContactError> {
    if let Some(speed) = speed {
        check_speed(speed)?;
    }
    let Some(relaxation) = relaxation.filter(|relaxation| relaxation.share() > 0.0) else {
        return Ok(None);
    };
    let allowed = "0 with Edges::Grid; relaxation needs Edges::SubCell";
    check(
        "relaxation share",
        relaxation.share(),
        edges == Edges::SubCell,
        allowed,
    )?;
    let allowed = "above 0 m/s; relaxation needs a loading speed";
    let speed = speed.unwrap_or(0.0);
    check("loading speed", speed, speed > 0.0, allowed)?;
    Ok(Some(Relaxing { relaxation, speed }))
}
